/* write.c - names of walls for all writers. SPDX-License-Identifier: MIT */
#include "write/write.h"

const char *contents_body(const struct contents *what, uint32_t k, char name[BODY_NAME]) {
    if (what->walls->body[k].kind) return wall_name(what->walls, k);
    snprintf(name, BODY_NAME, "wall_%u", k + 1);
    return name;
}
