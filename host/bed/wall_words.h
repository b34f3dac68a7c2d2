/* wall_words.h - a wall in words: its shape, and keys with values. SPDX-License-Identifier: MIT
 *
 * The program, the driver of LIGGGHTS and Python join the words by colons, and walls by commas:
 * zmin:temperature=1200:emissivity=0.8,cylinder:0,0,0.48:insulated. The fix of LAMMPS has them apart: zmin temperature
 * 1200 emissivity 0.8. The header is valid C++. */
#ifndef WALL_WORDS_H
#define WALL_WORDS_H

#ifdef __cplusplus
extern "C" {
#endif

#include "mesh/meshes.h"

enum wall_shape {
    WALL_NONE,     /* nothing has been read yet */
    WALL_PLANE,    /* xmin ... zmax, or xlo ... zhi */
    WALL_CYLINDER, /* cylinder:X,Y,R, xcylinder:Y,Z,R, ycylinder:X,Z,R */
    WALL_MESH,     /* mesh:FILE */
    WALL_BOX,      /* all six sides */
    WALL_AUTO,     /* the sides of the file's box on open axes */
    WALL_NAMED     /* a word that is none of these, which may be the name of a wall */
};

/* Bits of keys. */
enum {
    WALL_AT = 1 << 0,
    WALL_OPEN = 1 << 1,
    WALL_TEMPERATURE = 1 << 2,
    WALL_TEMPERATURES = 1 << 3,
    WALL_POWER = 1 << 4,
    WALL_INSULATED = 1 << 5,
    WALL_EMISSIVITY = 1 << 6,
    WALL_ABSORPTIVITY = 1 << 7,
    WALL_CAPACITY = 1 << 8,
    WALL_OTHER_NAME = 1 << 9, /* the key `name` */
    WALL_SOLIDS = 1 << 10,
    WALL_SCALE = 1 << 11,
    WALL_SIDES = 7 << 12, /* one bit for each of auto, normals, both */
    WALL_CONVECTION = 1 << 16,
    WALL_GAS = 1 << 17,
    WALL_NAMES_TOO = 1 << 15, /* no key: the shape may be WALL_NAMED */
    WALL_GEOMETRY = WALL_AT | WALL_OPEN | WALL_OTHER_NAME | WALL_SOLIDS | WALL_SCALE | WALL_SIDES,
    WALL_HEAT = WALL_TEMPERATURE | WALL_TEMPERATURES | WALL_POWER | WALL_INSULATED /* a wall has one of these */
};

/* One wall. Begin with zeroes. Texts point into the words. */
struct wall_words {
    enum wall_shape shape;
    const char *word;             /* the first word */
    fibrad_wall wall;             /* of a plane, a cylinder, a mesh; plane.at NaN: not given */
    struct mesh_file mesh;        /* of a mesh */
    unsigned given;               /* bits of the keys that were read */
    const char *temperature_text; /* NULL: not given */
    double temperature;           /* NaN: not given, or the text is no number */
    const char *temperatures;     /* path of a column, one temperature for each triangle; NULL: not given */
    double power;                 /* [W] NaN: not given */
    double emissivity;            /* 0 to 1; 1 if not given */
    double absorptivity;          /* 0 to 1; NaN: not given */
    double capacity;              /* [J/K] 0: not given */
    double convection;            /* heat transfer coefficient to the gas [W/(m2 K)] 0: not given */
    double gas;                   /* temperature of that gas; NaN: not given */
};

/* Room for a sentence that says what is wrong. */
enum { WALL_FAULT = 700 };

/* Reads a wall from `count` words, each key and each value a word, up to the first word that is no key. allowed: bits
 * of keys that the caller has a use for. A wall whose shape is known goes on with more keys, so a caller may read words
 * of its own in between. Returns the number of words that were read. 0: `fault` says what is wrong. */
int wall_words_read(struct wall_words *wall, const char *const *word, int count, unsigned allowed,
                    char fault[WALL_FAULT]);

/* Reads the first wall of a text of joined words, which it divides: its words must last as long as the wall. *text
 * moves to the next wall, or becomes NULL after the last one. False: `fault` says what is wrong. */
bool wall_words_take(struct wall_words *wall, char **text, unsigned allowed, char fault[WALL_FAULT]);

/* Whether a word is a shape. */
bool wall_words_shape(const char *word);

/* Says that a word is no shape, and which shapes there are. Returns false. */
bool wall_words_no_shape(const char *word, char fault[WALL_FAULT]);

/* The names of planes, by 2 axis + upper, and of cylinders, by fibrad_wall.cylinder.along. */
extern const char *const wall_plane_names[6], *const wall_cylinder_names[3];

#ifdef __cplusplus
}
#endif

#endif
