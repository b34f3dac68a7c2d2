/* wall_option.h - the option --wall: planes, a cylinder and meshes about a bed. SPDX-License-Identifier: MIT */
#ifndef WALL_OPTION_H
#define WALL_OPTION_H

#include <stdbool.h>
#include <stdint.h>

#include "bed/bed.h"
#include "fibrad.h"
#include "mesh/meshes.h"

enum { WALLS_MAX = FIBRAD_WALLS_MAX, PLANES = 6 };

/* Walls in the order of the option; those of auto and box come last. wall[k] is j = -2 - k in a matrix. Openings are no
 * walls: radiation that meets them goes to the surroundings. */
struct walls {
    uint32_t count;
    fibrad_wall wall[WALLS_MAX];
    uint32_t openings;
    fibrad_plane opening[PLANES]; /* at: NaN if the plane lies at the end of the spheres and the bed is not known yet */
    struct meshes *meshes;        /* owned by the options; NULL: none */
    bool moved; /* some wall lies at the end of the spheres, since the file's box ends within spheres */
};

/* Walls of all options --wall. Begin with zeroes; free with walls_free. */
struct wall_options {
    struct walls walls;
    bool placed[WALLS_MAX]; /* the option gives the coordinate */
    bool automatic, box;    /* the words auto and box; their planes are added when the bed is known */
};

/* A paragraph of --help. */
#define WALLS_MORE                                                                                                     \
    "Walls: LIST has one or more of these, separated by commas.\n"                                                     \
    "  auto                   the sides of the file's box on its open axes\n"                                          \
    "  box                    all six sides\n"                                                                         \
    "  xmin                   this side of the file's box, else of the spheres; also xmax ... zmax\n"                  \
    "  xmin=VALUE             this side at a coordinate\n"                                                             \
    "  zmax=open              an opening where the spheres end: the walls end there and the surroundings begin\n"      \
    "  zmax=H:open            an opening at the coordinate H\n"                                                        \
    "  box:open=zmax          a box without a lid\n"                                                                   \
    "  cylinder:X,Y,R         a cylinder parallel to the z axis; also xcylinder:Y,Z,R and ycylinder:X,Z,R\n"           \
    "  mesh:FILE              triangles of an STL file, in the bed's unit of length; the wall is named after FILE\n"   \
    "  NAME=mesh:FILE         the same, with a name\n"                                                                 \
    "LIST may have auto or box, and also a side with a place of its own, as box,zmin=0.1 has. Walls must not\n"        \
    "form a tube or a corner without end. If they do, make the missing side a wall or an opening. Of a mesh,\n"        \
    "the sides on which spheres lie belong to the wall. Other sides must not be seen. mesh:FILE:WORD says\n"           \
    "more:\n"                                                                                                          \
    "  both                   both sides belong to the wall\n"                                                         \
    "  normals                the outer sides of the file belong to the wall\n"                                        \
    "  solids                 each solid of the file is a wall\n"                                                      \
    "  scale=S                coordinates are multiplied by S\n"

/* The name of a wall, "xmin" ... "zmax", "cylinder", "xcylinder", "ycylinder" or that of a mesh; the name of the side
 * of a plane. */
const char *wall_name(const struct walls *walls, uint32_t k);
const char *plane_name(const fibrad_plane *plane);

/* Prints that there is no wall of a name in an option, and which walls there are. Returns STATUS_USAGE. */
int wall_unknown(const char *option, const struct walls *walls, const char *name, size_t length);

/* Prints that walls are endless, and which openings would end them. Returns STATUS_USAGE. */
int walls_refuse_endless(const struct walls *walls, const struct bed *bed);

/* Reads an argument of --wall, and the files of its meshes. Status 0, STATUS_USAGE, or as meshes_add. */
int walls_option(const char *text, void *wall_options);
void walls_free(struct wall_options *options);

/* Places the walls about a bed whose periods are final. meshes_face finds the sides of meshes later. file: name of the
 * bed in messages. Status 0, STATUS_USAGE if walls and periodic axes contradict each other, or STATUS_INPUT naming the
 * line of a sphere whose centre lies beyond a plane or a cylinder. */
int walls_of(const struct wall_options *options, const struct bed *bed, const char *file, struct walls *walls);

/* Whether no radiation can escape. Either a closed mesh encloses the bed, or there are no openings, and each axis is
 * periodic, has walls at both ends, or lies across the cylinder. */
bool walls_closed(const struct walls *walls, const struct bed *bed);

/* Whether a wall lies across an axis: a plane, or a cylinder along another axis. */
bool wall_across(const fibrad_wall *wall, int axis);

/* Whether a wall is infinite along an axis. */
bool wall_endless(const struct walls *walls, const struct bed *bed, const fibrad_wall *wall);

#endif
