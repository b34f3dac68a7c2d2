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
        "walls: auto (box of the file, open axes), box (all six sides), xmin, xmax ... zmax, cylinder:X,Y,R "          \
        "(axis along z), mesh:FILE (STL); zmax=open: an open side [none]"
#define OPTION_WALL_VTP                                                                                                \
    KEY_WALL_VTP, "wall-vtp", "OUT", "triangles of the walls of mesh:FILE, a .vtp for ParaView [none]"
#define WALLS_MORE                                                                                                     \
    "Walls: a LIST parted by commas. A side is xmin=VALUE, or without =VALUE the end of the file's box, or else of "   \
    "the\n"                                                                                                            \
    "spheres. Sides named besides auto or box stand where they say. A side zmax=open is where the container ends "     \
    "and\n"                                                                                                            \
    "the surroundings begin: at the end of the spheres, or at H, which is the rim of the walls, as zmax=H:open;\n"     \
    "box:open=zmax is a box without a lid. Walls that end nowhere are refused, but for one plane or a pair.\n"         \
    "mesh:FILE or NAME=mesh:FILE is a wall of "                                                                        \
    "triangles,\n"                                                                                                     \
    "called after its file or NAME, in the bed's unit of length. Its sides that spheres are on are the wall; no\n"     \
    "others may be seen. Words behind FILE, parted by colons: both (sides), normals (the file's outer sides),\n"       \
    "solids (a wall of each), scale=S (coordinates times S).\n"

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
