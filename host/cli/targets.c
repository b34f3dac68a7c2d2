/* targets.c - lists of spheres such as 3,7,10-19. SPDX-License-Identifier: MIT */
#include "cli/targets.h"

#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

/* Reads a number at the beginning of *text and moves *text behind it. False: there is none. */
static bool read_name(const char **text, unsigned long long *value) {
    char *end;
    if (!isdigit((unsigned char)**text)) return false;
    errno = 0;
    *value = strtoull(*text, &end, 10);
    *text = end;
    return errno == 0;
}

uint32_t targets_first(const int64_t *id, uint32_t n, unsigned long long name) {
    uint32_t low = 0, high = n;
    if (!id) return name < n ? (uint32_t)name : n;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if ((unsigned long long)id[middle] < name)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static int mark_range(const int64_t *id, uint32_t n, const char *where, unsigned long long first,
                      unsigned long long last, unsigned char *marks) {
    const uint32_t begin = targets_first(id, n, first), end = targets_first(id, n, last + 1);
    const unsigned long long least = id && n ? (unsigned long long)id[0] : 0;
    const unsigned long long most = n == 0 ? 0 : id ? (unsigned long long)id[n - 1] : n - 1;
    if (begin == end || first < least || last > most)
        return message(STATUS_USAGE, "--targets: there is no sphere %llu in %s; its spheres are %llu to %llu",
                       begin == end || first < least ? first : last, where, least, most);
    memset(marks + begin, 1, end - begin);
    return STATUS_OK;
}

int targets_mark(const char *list, const int64_t *id, uint32_t n, const char *where, unsigned char *marks) {
    for (const char *text = list;; ++text) {
        unsigned long long first, last;
        bool good = read_name(&text, &first);
        last = first;
        if (good && *text == '-') {
            ++text;
            good = read_name(&text, &last) && first <= last;
        }
        if (!good || last > INT64_MAX - 1 || (*text && *text != ','))
            return message(STATUS_USAGE, "--targets: '%.60s' is not a list like 3,7,10-19", list);
        const int status = marks ? mark_range(id, n, where, first, last, marks) : STATUS_OK;
        if (status || *text == 0) return status;
    }
}
