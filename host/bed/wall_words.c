/* wall_words.c - a wall in words: its shape, and keys with values. SPDX-License-Identifier: MIT */
#include "bed/wall_words.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/spelling.h"

const char *const wall_plane_names[6] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
const char *const wall_cylinder_names[3] = {"xcylinder", "ycylinder", "cylinder"};

static const struct shape {
    const char *name;
    enum wall_shape shape;
    int number; /* of a plane, 2 axis + upper; of a cylinder, fibrad_wall.cylinder.along */
} shapes[] = {{"xmin", WALL_PLANE, 0},         {"xmax", WALL_PLANE, 1},         {"ymin", WALL_PLANE, 2},
              {"ymax", WALL_PLANE, 3},         {"zmin", WALL_PLANE, 4},         {"zmax", WALL_PLANE, 5},
              {"xlo", WALL_PLANE, 0},          {"xhi", WALL_PLANE, 1},          {"ylo", WALL_PLANE, 2},
              {"yhi", WALL_PLANE, 3},          {"zlo", WALL_PLANE, 4},          {"zhi", WALL_PLANE, 5},
              {"cylinder", WALL_CYLINDER, 2},  {"xcylinder", WALL_CYLINDER, 0}, {"ycylinder", WALL_CYLINDER, 1},
              {"zcylinder", WALL_CYLINDER, 2}, {"mesh", WALL_MESH, 0},          {"box", WALL_BOX, 0},
              {"auto", WALL_AUTO, 0}};
enum { SHAPES = sizeof shapes / sizeof *shapes };

/* What is the value of a key. */
enum value { FLAG, NUMBER, TEXT };

#define OPEN_EXCLUDES (WALL_HEAT | WALL_EMISSIVITY | WALL_ABSORPTIVITY | WALL_CAPACITY | WALL_CONVECTION | WALL_GAS)

static const struct key {
    const char *name, *example; /* of a value */
    unsigned bit, excludes;
    enum wall_shape of; /* the only shape that has the key; WALL_NONE: all have it */
    enum value value;
    double low, high;
    size_t field;
} keys[] = {
    {"at", "0.1", WALL_AT, 0, WALL_PLANE, NUMBER, -FIBRAD_LENGTH_MAX, FIBRAD_LENGTH_MAX,
     offsetof(struct wall_words, wall.plane.at)},
    {"open", NULL, WALL_OPEN, OPEN_EXCLUDES, WALL_PLANE, FLAG, 0, 0, 0},
    {"temperature", "1200", WALL_TEMPERATURE, (WALL_HEAT | WALL_OPEN) & ~WALL_POWER, WALL_NONE, TEXT, 0, 0,
     offsetof(struct wall_words, temperature_text)},
    {"temperatures", "FILE", WALL_TEMPERATURES, WALL_HEAT | WALL_OPEN, WALL_NONE, TEXT, 0, 0,
     offsetof(struct wall_words, temperatures)},
    {"power", "500", WALL_POWER, (WALL_HEAT | WALL_OPEN) & ~WALL_TEMPERATURE, WALL_NONE, NUMBER, -1e30, 1e30,
     offsetof(struct wall_words, power)},
    {"insulated", NULL, WALL_INSULATED, WALL_HEAT | WALL_OPEN, WALL_NONE, FLAG, 0, 0, 0},
    {"emissivity", "0.8", WALL_EMISSIVITY, WALL_OPEN, WALL_NONE, NUMBER, 0, 1, offsetof(struct wall_words, emissivity)},
    {"absorptivity", "0.8", WALL_ABSORPTIVITY, WALL_OPEN, WALL_NONE, NUMBER, 0, 1,
     offsetof(struct wall_words, absorptivity)},
    {"capacity", "500", WALL_CAPACITY, WALL_OPEN, WALL_NONE, NUMBER, 1e-300, 1e300,
     offsetof(struct wall_words, capacity)},
    {"convection", "20", WALL_CONVECTION, WALL_OPEN, WALL_NONE, NUMBER, 0, 1e12,
     offsetof(struct wall_words, convection)},
    {"gas", "300", WALL_GAS, WALL_OPEN, WALL_NONE, NUMBER, -1e9, 1e9, offsetof(struct wall_words, gas)},
    {"name", "lid", WALL_OTHER_NAME, 0, WALL_MESH, TEXT, 0, 0, offsetof(struct wall_words, mesh.name)},
    {"solids", NULL, WALL_SOLIDS, 0, WALL_MESH, FLAG, 0, 0, 0},
    {"scale", "0.001", WALL_SCALE, 0, WALL_MESH, NUMBER, 1e-12, 1e12, offsetof(struct wall_words, mesh.scale)},
    {"auto", NULL, 1 << (12 + SIDES_AUTO), WALL_SIDES, WALL_MESH, FLAG, 0, 0, 0},
    {"normals", NULL, 1 << (12 + SIDES_NORMALS), WALL_SIDES, WALL_MESH, FLAG, 0, 0, 0},
    {"both", NULL, 1 << (12 + SIDES_BOTH), WALL_SIDES, WALL_MESH, FLAG, 0, 0, 0}};
enum { KEYS = sizeof keys / sizeof *keys };

/* Writes `NAME: TEXT` of a wall. Returns false. */
__attribute__((format(printf, 3, 4))) static bool refuse(const struct wall_words *wall, char fault[WALL_FAULT],
                                                         const char *format, ...) {
    va_list arguments;
    const bool mesh = wall->mesh.path;
    int length =
        snprintf(fault, WALL_FAULT, "%.40s%s%.200s: ", wall->word, mesh ? ":" : "", mesh ? wall->mesh.path : "");
    va_start(arguments, format);
    vsnprintf(fault + length, WALL_FAULT - (size_t)length, format, arguments);
    va_end(arguments);
    return false;
}

static bool is_number(const char *text, double *value) {
    char *end;
    *value = strtod(text, &end);
    return end != text && *end == 0 && isfinite(*value);
}

bool wall_words_no_shape(const char *word, char fault[WALL_FAULT]) {
    const char *names[SHAPES];
    char hint[HINT_ROOM];
    for (int k = 0; k < SHAPES; ++k) names[k] = shapes[k].name;
    name_hint(hint, "", word, strlen(word), names, SHAPES);
    snprintf(fault, WALL_FAULT,
             "'%.60s' is no wall%s there are box, auto, xmin ... zmax, cylinder:X,Y,R, xcylinder:Y,Z,R, "
             "ycylinder:X,Z,R and mesh:FILE",
             word, hint);
    return false;
}

static int find_shape(const char *word) {
    int k = 0;
    while (k < SHAPES && strcmp(word, shapes[k].name) != 0) ++k;
    return k;
}

bool wall_words_shape(const char *word) { return find_shape(word) < SHAPES; }

static bool begin_wall(struct wall_words *wall, const char *word, unsigned allowed, char fault[WALL_FAULT]) {
    const int k = find_shape(word);
    if (k == SHAPES && !(allowed & WALL_NAMES_TOO)) return wall_words_no_shape(word, fault);
    *wall = (struct wall_words){.shape = k < SHAPES ? shapes[k].shape : WALL_NAMED, .word = word, .emissivity = 1};
    wall->temperature = wall->power = wall->absorptivity = wall->gas = NAN, wall->mesh.scale = 1;
    if (wall->shape == WALL_PLANE)
        wall->wall =
            (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {shapes[k].number / 2, shapes[k].number % 2, NAN}};
    if (wall->shape == WALL_CYLINDER)
        wall->wall = (fibrad_wall){.kind = FIBRAD_WALL_CYLINDER, .cylinder.along = shapes[k].number};
    if (wall->shape == WALL_MESH) wall->wall.kind = FIBRAD_WALL_MESH;
    return true;
}

/* How many words follow the shape. */
static int shape_words(const struct wall_words *wall) {
    return wall->shape == WALL_CYLINDER ? 3 : wall->shape == WALL_MESH ? 1 : 0;
}

/* Takes these words. */
static bool take_shape(struct wall_words *wall, const char *const *word, int count, char fault[WALL_FAULT]) {
    static const char *const position[] = {"Y,Z", "X,Z", "X,Y"};
    const int axis = wall->wall.cylinder.along;
    double c[3] = {0};
    bool good = count >= shape_words(wall);
    if (wall->shape == WALL_MESH) {
        wall->mesh.path = good && *word[0] ? word[0] : NULL;
        return wall->mesh.path || refuse(wall, fault, "a file is missing, mesh:FILE");
    }
    for (int k = 0; k < shape_words(wall) && good; ++k) good = is_number(word[k], &c[k]);
    if (wall->shape == WALL_CYLINDER && !(good && c[2] > 0))
        return refuse(wall, fault, "needs %s,R, a place and a radius above 0", position[axis]);
    if (wall->shape == WALL_CYLINDER)
        wall->wall.cylinder.x = c[0], wall->wall.cylinder.y = c[1], wall->wall.cylinder.radius = c[2];
    return true;
}

static const struct key *find_key(const char *word) {
    for (int k = 0; k < KEYS; ++k)
        if (strcmp(word, keys[k].name) == 0) return &keys[k];
    return NULL;
}

static bool no_key(const struct wall_words *wall, const char *word, unsigned allowed, char fault[WALL_FAULT]) {
    const char *names[KEYS];
    char hint[HINT_ROOM], list[200] = "";
    size_t n = 0;
    for (int k = 0; k < KEYS; ++k)
        if (keys[k].bit & allowed && (keys[k].of == WALL_NONE || keys[k].of == wall->shape)) {
            snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", n ? ", " : "", keys[k].name);
            names[n++] = keys[k].name;
        }
    name_hint(hint, "", word, strlen(word), names, n);
    if (n == 0) return refuse(wall, fault, "'%.60s' is of no use here", word);
    return refuse(wall, fault, "'%.60s' is of no use here%s there are %s", word, hint, list);
}

/* Puts the value of a key into its field. value NULL: there is none. */
static bool take_key(struct wall_words *wall, const struct key *key, const char *value, unsigned allowed,
                     char fault[WALL_FAULT]) {
    const unsigned earlier = wall->given & (key->bit | key->excludes);
    void *field = (char *)wall + key->field;
    if (!(key->bit & allowed) || (key->of != WALL_NONE && key->of != wall->shape))
        return no_key(wall, key->name, allowed, fault);
    if (earlier) {
        int k = 0;
        while (!(keys[k].bit & earlier)) ++k;
        if (&keys[k] == key) return refuse(wall, fault, "%s is given twice", key->name);
        return refuse(wall, fault, "%s excludes %s%s", keys[k].name, key->name,
                      (key->bit | keys[k].bit) & WALL_OPEN ? "; an opening is as black and as hot as the surroundings"
                                                           : "");
    }
    wall->given |= key->bit;
    if (key->bit & WALL_SIDES)
        for (int k = SIDES_AUTO; k <= SIDES_BOTH; ++k)
            if (key->bit == 1u << (12 + k)) wall->mesh.sides = (enum mesh_sides)k;
    if (key->bit == WALL_SOLIDS) wall->mesh.solids = true;
    if (key->value == FLAG && !value) return true;
    if (key->value == FLAG) return refuse(wall, fault, "%s takes no value, as '%.60s' is", key->name, value);
    if (!value || !*value) return refuse(wall, fault, "%s needs a value, %s for example", key->name, key->example);
    if (key->value == TEXT) {
        *(const char **)field = value;
        if (key->bit == WALL_TEMPERATURE && !is_number(value, &wall->temperature)) wall->temperature = NAN;
        return true;
    }
    if (!is_number(value, field)) return refuse(wall, fault, "%s: '%.60s' is not a number", key->name, value);
    const double number = *(double *)field;
    if (number >= key->low && number <= key->high) return true;
    return refuse(wall, fault, "%s: %.40s is not within %g and %g", key->name, value, key->low, key->high);
}

int wall_words_read(struct wall_words *wall, const char *const *word, int count, unsigned allowed,
                    char fault[WALL_FAULT]) {
    double number;
    int at = 0;
    if (wall->shape == WALL_NONE) {
        if (!begin_wall(wall, count > 0 ? word[0] : "", allowed, fault)) return 0;
        if (!take_shape(wall, word + 1, count - 1, fault)) return 0;
        at = 1 + shape_words(wall);
    }
    while (at < count) {
        const struct key *key = find_key(word[at]);
        if (!key && is_number(word[at], &number)) {
            refuse(wall, fault, "`%.40s` needs a word before it, as in `%.40s temperature 1200 emissivity 0.8`",
                   word[at], wall->word);
            return 0;
        }
        if (!key) return at;
        const char *value = key->value != FLAG && at + 1 < count ? word[at + 1] : NULL;
        if (!take_key(wall, key, value, allowed, fault)) return 0;
        at += 1 + (value != NULL);
    }
    return at;
}

/* ---- words that are joined -------------------------------------------------------------------------------------- */

/* Cuts the first item off a text and moves *text behind the colon or comma. A comma before a number belongs to the
 * item. Returns the item's end: ':', ',' or 0. */
static char cut_item(char **text) {
    char *end = *text + strcspn(*text, ":,");
    while (*end == ',' && strchr("+-.0123456789", end[1]) && end[1]) end += 1 + strcspn(end + 1, ":,");
    const char stop = *end;
    *end = 0;
    *text = end + (stop != 0);
    return stop;
}

bool wall_words_take(struct wall_words *wall, char **text, unsigned allowed, char fault[WALL_FAULT]) {
    char *item = *text, *number[3], stop = cut_item(text);
    if (strchr(item, '=') || (find_key(item) && !wall_words_shape(item))) { /* as before 0.3.0, or behind a comma */
        snprintf(fault, WALL_FAULT,
                 "%.60s is not how a wall is written: zmin:at=VALUE:temperature=T:emissivity=E, zmax:open, "
                 "cylinder:X,Y,R and mesh:FILE:name=NAME are, with colons between the words of a wall",
                 item);
        return false;
    }
    if (!begin_wall(wall, item, allowed, fault)) return false;
    if (shape_words(wall) > 0) {
        int count = stop == ':';
        if (count) number[0] = *text, stop = cut_item(text);
        for (; count > 0 && count < shape_words(wall) && (item = strchr(number[count - 1], ',')); ++count)
            *item = 0, number[count] = item + 1;
        if (!take_shape(wall, (const char *const *)number, count, fault)) return false;
    }
    while (stop == ':') {
        item = *text, stop = cut_item(text);
        char *value = strchr(item, '=');
        if (value) *value++ = 0;
        const struct key *key = find_key(item);
        if (!key && !value && wall->shape == WALL_NAMED) return wall_words_no_shape(wall->word, fault);
        if (!key) return no_key(wall, item, allowed, fault);
        if (!take_key(wall, key, value, allowed, fault)) return false;
    }
    if (stop == 0) *text = NULL;
    if ((wall->given & WALL_CAPACITY) || (~wall->given & (WALL_TEMPERATURE | WALL_POWER))) return true;
    return refuse(wall, fault, "temperature excludes power, unless the wall has a capacity");
}
