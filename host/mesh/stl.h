/* stl.h - triangles of an STL file, text or binary, or of an OBJ file; may be packed by gzip.
 * SPDX-License-Identifier: MIT */
#ifndef STL_H
#define STL_H

#include <stdbool.h>
#include <stdint.h>

enum { SOLID_NAME = 32 };

/* Triangles in the order of the file. Normals are not read. */
struct stl {
    uint32_t n;
    double (*corner)[3][3]; /* [n] */
    uint64_t *place;        /* [n] text: the line of `facet` or, in an OBJ file, of `f`; binary: number from 0 */
    uint32_t *solid;        /* [n] number of the solid from 0 */
    bool text;              /* else binary */
    uint32_t solids;
    char (*name)[SOLID_NAME]; /* [solids] at most 31 characters; "": none */
};

/* Reads a file; to be freed also after an error. Coordinates are finite and within FIBRAD_LENGTH_MAX. Status 0;
 * STATUS_FILE, STATUS_INPUT, STATUS_MEMORY or that of a signal, after a message that names the line or the triangle. */
int stl_read(struct stl *stl, const char *path);
void stl_free(struct stl *stl);

/* Writes "line 7" or "triangle 7" for messages. text: of a text file. Returns `to`. */
enum { STL_PLACE = 32 };
const char *stl_place(bool text, uint64_t place, char to[STL_PLACE]);

#endif
