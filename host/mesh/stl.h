/* stl.h - triangles of an STL file, text or binary, packed by gzip or not. SPDX-License-Identifier: MIT */
#ifndef STL_H
#define STL_H

#include <stdbool.h>
#include <stdint.h>

enum { SOLID_NAME = 32 };

/* Triangles as they stand in the file. Normals are not read. */
struct stl {
    uint32_t n, capacity;
    double (*corner)[3][3]; /* [n] */
    uint64_t *place;        /* [n] of text the line of `facet`, else the triangle's number from 0 */
    uint32_t *solid;        /* [n] which one of the file, from 0 */
    bool text;
    uint32_t solids;
    char (*name)[SOLID_NAME]; /* [solids] shortened; "": none */
};

/* Reads a file; to be freed also after an error. Coordinates are finite and within FIBRAD_LENGTH_MAX. Status 0;
 * STATUS_FILE, STATUS_INPUT, STATUS_MEMORY or that of a signal, after a message that names the line or the triangle. */
int stl_read(struct stl *stl, const char *path);
void stl_free(struct stl *stl);

/* "line 7" or "triangle 7", for messages, in `text`, which is returned. */
enum { STL_PLACE = 32 };
const char *stl_place(bool text, uint64_t place, char said[STL_PLACE]);

#endif
