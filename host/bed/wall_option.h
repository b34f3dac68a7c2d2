/* wall_option.h - the option --wall: planes, a cylinder and meshes about a bed. SPDX-License-Identifier: MIT */
#ifndef WALL_OPTION_H
#define WALL_OPTION_H

#include "bed/bed.h"
#include "bed/wall_words.h"

enum { WALLS_MAX = FIBRAD_WALLS_MAX, PLANES = 6 };

/* Walls in the order of the option; sides that auto and box add come last. wall[k] is j = -2 - k in a matrix. Openings
 * are no walls: radiation that meets them goes to the surroundings. */
struct walls {
    uint32_t count;
    fibrad_wall wall[WALLS_MAX];
    struct wall_words said[WALLS_MAX]; /* what the option says of each wall */
    uint32_t openings;
    fibrad_plane opening[PLANES]; /* at: NaN if the plane lies at the end of the spheres and the bed is not known yet */
    struct meshes *meshes;        /* owned by the options; NULL: none */
    bool moved; /* some wall lies at the end of the spheres, since the file's box ends within spheres */
};

/* Arguments of all options --wall. Begin with zeroes and keys; free with walls_free. */
enum { WALL_WORDS_MAX = 2 * WALLS_MAX };
struct wall_options {
    unsigned keys; /* what the command has a use for, beside WALL_GEOMETRY */
    uint32_t count, texts;
    struct wall_words word[WALL_WORDS_MAX]; /* [count] as they were given */
    char *text[WALL_WORDS_MAX];             /* [texts] what they point into */
    struct walls walls;                     /* after walls_settle; planes of auto and box are added for each bed */
};

/* Paragraphs of --help: what all walls have, and what has a meaning for heat alone. */
#define WALLS_MORE                                                                                                     \
    "Walls: LIST has one or more walls, separated by commas. A wall is a shape, and words behind colons. A side\n"     \
    "that comes a second time replaces the first, and goes before box and auto.\n"                                     \
    "  xmin ... zmax          a side of the file's box, else of the spheres; :at=VALUE is another place\n"             \
    "  zmax:open              an opening where the spheres end; zmax:open:at=VALUE is another place\n"                 \
    "  box, auto              all six sides; the sides of the file's box on its open axes\n"                           \
    "  cylinder:X,Y,R         a cylinder parallel to the z axis; also xcylinder:Y,Z,R and ycylinder:X,Z,R\n"           \
    "  mesh:FILE              triangles of an STL file; :scale=S multiplies coordinates, :name=NAME names the wall,\n" \
    "                         :solids makes each solid a wall, :both makes both sides of triangles the wall,\n"        \
    "                         :normals the outer sides of the file [the sides on which spheres lie]\n"                 \
    "  NAME                   more words about the wall NAME, a solid of a mesh for example\n"                         \
    "Walls must not form a tube or a corner without end: make the missing side a wall or an opening.\n"
#define WALLS_OF_EMISSIVITY "All walls but openings may have :emissivity=E, 0 to 1 [1].\n"
#define WALLS_OF_HEAT                                                                                                  \
    "All walls but openings have one of these:\n"                                                                      \
    "  :temperature=T         or :temperatures=FILE, a column with a temperature for each triangle\n"                  \
    "  :power=W               power that the wall gives off; its temperature is found\n"                               \
    "  :insulated             sends back all that arrives\n"                                                           \
    "They may have :emissivity=E, 0 to 1 [1], of light :absorptivity=A [emissivity], and :convection=H with :gas=T.\n" \
    "With --until they may have :capacity=C [J/K]. Such a wall begins at :temperature=T, and :power=W heats it.\n"

/* The name of a wall, "xmin" ... "zmax", "cylinder", "xcylinder", "ycylinder" or that of a mesh; the name of the side
 * of a plane. */
const char *wall_name(const struct walls *walls, uint32_t k);
const char *plane_name(const fibrad_plane *plane);

/* The index of the wall with a name. WALLS_MAX: there is none. */
uint32_t wall_index(const struct walls *walls, const char *name);

/* Prints that walls are endless, and which openings would end them. Returns STATUS_USAGE. */
int walls_refuse_endless(const struct walls *walls, const struct bed *bed);

/* Takes an argument of --wall. Status 0, STATUS_USAGE or STATUS_MEMORY. */
int walls_option(const char *text, void *wall_options);

/* Makes options->walls when all options have been read, and reads the files of meshes. Status 0, STATUS_USAGE, or as
 * meshes_add. */
int walls_settle(struct wall_options *options);

/* Bits of all keys that the options give. */
unsigned walls_keys(const struct wall_options *options);
void walls_free(struct wall_options *options);

/* Places the walls about a bed whose periods are final. meshes_face finds the sides of meshes later. file: name of the
 * bed in messages. Status 0, STATUS_USAGE if walls and periodic axes contradict each other, or STATUS_INPUT naming the
 * line of a sphere whose centre lies beyond a plane or a cylinder. */
int walls_of(const struct wall_options *options, const struct bed *bed, const char *file, struct walls *walls);

/* Whether a period, a plane or the cylinder closes a side, x low 0 to z high 5. */
bool walls_close(const struct walls *walls, const struct bed *bed, int side);

/* Whether no radiation can escape. Either a closed mesh encloses the bed, or there are no openings, and each axis is
 * periodic, has walls at both ends, or lies across the cylinder. */
bool walls_closed(const struct walls *walls, const struct bed *bed);

/* Whether a wall lies across an axis: a plane, or a cylinder along another axis. */
bool wall_across(const fibrad_wall *wall, int axis);

/* Whether a wall is infinite along an axis. */
bool wall_endless(const struct walls *walls, const struct bed *bed, const fibrad_wall *wall);

#endif
