/* wall_option.h - the option --wall: planes, a cylinder and meshes about a bed. SPDX-License-Identifier: MIT */
#ifndef WALL_OPTION_H
#define WALL_OPTION_H

#include <stdbool.h>
#include <stdint.h>

#include "bed/bed.h"
#include "fibrad.h"
#include "mesh/meshes.h"

enum { WALLS_MAX = FIBRAD_BODIES_MAX, PLANES = 6 };

/* Walls in the order given, those of auto and box last: body[k] is j = -2 - k in a matrix. Openings are no walls: what
 * meets them goes to the surroundings. */
struct walls {
    uint32_t count;
    fibrad_body body[WALLS_MAX];
    uint32_t openings;
    fibrad_plane opening[PLANES]; /* at NaN: where the spheres end, as far as the bed is not known */
    struct meshes *meshes;        /* of the option; NULL: none */
    bool moved;                   /* a plane without a place stands where spheres end, not where the file's box does */
};

/* What --wall asks for; several such options add up. Zeroed: no walls; to be freed by walls_free. */
struct wall_options {
    struct walls walls;
    bool placed[WALLS_MAX]; /* whether its place was given */
    bool automatic, box;    /* the words auto and box: which axes are open is known with the bed alone */
};

/* What --help says of it: the row of a table of options, without braces, and more below. */
#define OPTION_WALL                                                                                                    \
    KEY_WALL, "wall", "LIST",                                                                                          \
        "walls: auto, box, xmin, xmax, ymin, ymax, zmin, zmax, cylinder:X,Y,R, mesh:FILE; see below [none]"
#define OPTION_WALL_VTP                                                                                                \
    KEY_WALL_VTP, "wall-vtp", "OUT", "write the triangles of the walls of mesh:FILE, a .vtp for ParaView [none]"
#define WALLS_MORE                                                                                                     \
    "Walls: LIST has one or more of these, separated by commas.\n"                                                     \
    "  auto                   the sides of the file's box on its open axes\n"                                          \
    "  box                    all six sides\n"                                                                         \
    "  xmin                   this side, also xmax to zmax, at the end of the file's box, or else of the spheres\n"    \
    "  xmin=VALUE             this side at a coordinate\n"                                                             \
    "  zmax=open              an opening where the spheres end: the walls end there and the surroundings begin\n"      \
    "  zmax=H:open            an opening at the coordinate H\n"                                                        \
    "  box:open=zmax          a box without a lid\n"                                                                   \
    "  cylinder:X,Y,R         a cylinder parallel to the z axis\n"                                                     \
    "  mesh:FILE              triangles of an STL file, in the bed's unit of length; the wall is named after FILE\n"   \
    "  NAME=mesh:FILE         the same, with a name\n"                                                                 \
    "A side that is named besides auto or box stands where it says. Walls must not form a tube or a corner\n"          \
    "without end. If they do, make the missing side a wall or an opening. Of a mesh, the sides on which\n"             \
    "spheres lie belong to the wall. Other sides must not be seen. mesh:FILE:WORD says more:\n"                        \
    "  both                   both sides belong to the wall\n"                                                         \
    "  normals                the outer sides of the file belong to the wall\n"                                        \
    "  solids                 each solid of the file is a wall\n"                                                      \
    "  scale=S                coordinates are multiplied by S\n"

/* "xmin" ... "zmax", "cylinder", the name of a mesh; of an opening. */
const char *wall_name(const struct walls *walls, uint32_t k);
const char *plane_name(const fibrad_plane *plane);

/* That there is no wall of a name, after an option: what there is, and openings are none. Returns STATUS_USAGE. */
int wall_unknown(const char *option, const struct walls *walls, const char *name, size_t length);

/* Why the library calls walls endless, and what would end them. Returns STATUS_USAGE. */
int walls_refuse_endless(const struct walls *walls, const struct bed *bed);

/* Takes one argument of --wall, and reads its meshes. Status 0, STATUS_USAGE, or as meshes_add. */
int walls_option(const char *text, struct wall_options *options);
void walls_free(struct wall_options *options);

/* Places the walls about a bed whose periods are settled; `file` is its name in messages. Status 0, STATUS_USAGE if
 * walls and periodic axes do not agree, STATUS_INPUT naming the line if a centre lies beyond a plane or cylinder.
 * Sides of meshes are for meshes_face to find. */
int walls_of(const struct wall_options *options, const struct bed *bed, const char *file, struct walls *walls);

/* Whether nothing can escape: each axis is periodic or has both planes, none of them an opening, or the cylinder stands
 * about it; or a mesh of one side encloses the bed. */
bool walls_closed(const struct walls *walls, const struct bed *bed);

/* Whether a wall goes on for ever along an axis. */
bool wall_endless(const struct walls *walls, const struct bed *bed, const fibrad_body *wall);

#endif
