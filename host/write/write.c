/* write.c - names of walls for all writers. SPDX-License-Identifier: MIT */
#include "write/write.h"

const char *contents_wall(const struct contents *what, uint32_t k, char name[WALL_NAME]) {
    if (what->walls->wall[k].kind) return wall_name(what->walls, k);
    snprintf(name, WALL_NAME, "wall_%u", k + 1);
    return name;
}
