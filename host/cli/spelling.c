/* spelling.c - what a misspelt name or a text may have meant. SPDX-License-Identifier: MIT */
#include "cli/spelling.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { NAME_MOST = 40 }; /* longer names are not compared */

/* Small and capital letters are the same, and so are - and _. */
static bool same_letter(char a, char b) {
    return tolower((unsigned char)a) == tolower((unsigned char)b) || ((a == '-' || a == '_') && (b == '-' || b == '_'));
}

static size_t smaller(size_t a, size_t b) { return a < b ? a : b; }

/* The least number of letters of `a` to replace, insert, leave out or exchange with the next one, so that it becomes
 * `b` (optimal string alignment). */
static size_t mistakes(const char *a, size_t m, const char *b, size_t n) {
    size_t row[3][NAME_MOST + 1];
    for (size_t j = 0; j <= n; ++j) row[0][j] = j;
    for (size_t i = 1; i <= m; ++i) {
        size_t *now = row[i % 3], *last = row[(i + 2) % 3], *before = row[(i + 1) % 3];
        now[0] = i;
        for (size_t j = 1; j <= n; ++j) {
            now[j] = smaller(last[j - 1] + !same_letter(a[i - 1], b[j - 1]), smaller(last[j], now[j - 1]) + 1);
            if (i > 1 && j > 1 && same_letter(a[i - 1], b[j - 2]) && same_letter(a[i - 2], b[j - 1]))
                now[j] = smaller(now[j], before[j - 2] + 1);
        }
    }
    return row[m % 3][n];
}

/* The name that is nearest. NULL: none is near. */
static const char *nearest(const char *name, size_t length, const char *const *names, size_t n) {
    const char *found = NULL;
    size_t least = (length + 1) / 3 + 1;
    if (length > NAME_MOST) return NULL;
    for (size_t k = 0; k < n && length >= 3; ++k)
        if (strncmp(names[k], name, length) == 0) return names[k];
    for (size_t k = 0; k < n; ++k) {
        const size_t size = strlen(names[k]);
        const size_t wrong = size > 0 && size <= NAME_MOST ? mistakes(name, length, names[k], size) : least;
        if (wrong < least) found = names[k], least = wrong;
    }
    return found;
}

const char *name_hint(char to[HINT_ROOM], const char *before, const char *name, size_t length, const char *const *names,
                      size_t n) {
    const char *found = nearest(name, length, names, n);
    snprintf(to, HINT_ROOM, found ? "; did you mean %s%.60s?" : ";", before, found);
    return to;
}

const char *table_hint(char to[HINT_ROOM], const char *before, const char *text) {
    char path[60];
    struct stat there;
    const size_t length = strcspn(text, ",");
    *to = 0;
    if (length >= sizeof path) return to;
    memcpy(path, text, length);
    path[length] = 0;
    if (stat(path, &there) == 0 && S_ISREG(there.st_mode))
        snprintf(to, HINT_ROOM, "; if %s is a table, write %s@%s", path, before, path);
    return to;
}
