/* targets.c - lists of spheres such as 3,7,10-19. SPDX-License-Identifier: MIT */
#include "cli/targets.h"

#include <ctype.h>
#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>

#include "cli/message.h"

/* A position at the beginning of a text; false if there is none. */
static bool position(const char **text, unsigned long long *value) {
    char *end;
    if (!isdigit((unsigned char)**text)) return false;
    errno = 0;
    *value = strtoull(*text, &end, 10);
    *text = end;
    return errno == 0;
}

int targets_mark(const char *list, uint32_t n, unsigned char *marks) {
    for (const char *text = list;; ++text) {
        unsigned long long first, last;
        bool good = position(&text, &first);
        last = first;
        if (good && *text == '-') {
            ++text;
            good = position(&text, &last) && first <= last;
        }
        if (!good || (*text && *text != ','))
            return message(STATUS_USAGE, "--targets: '%.60s' is no list such as 3,7,10-19", list);
        if (marks && last >= n)
            return message(STATUS_USAGE, "--targets: there is no sphere %llu; the last is %u", last, n - 1);
        for (; marks && first <= last; ++first) marks[first] = 1;
        if (*text == 0) return STATUS_OK;
    }
}
