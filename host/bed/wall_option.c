/* wall_option.c - the option --wall: planes, a cylinder and meshes about a bed. SPDX-License-Identifier: MIT */
#include "bed/wall_option.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "cli/options.h"
#include "cli/spelling.h"
#include "simple/cylinder.h"
#include "text/text.h"

static const char *const plane_names[PLANES] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};

/* The plane of a side, whose number is that of its name in plane_names. */
static fibrad_plane plane_at(int number, double at) { return (fibrad_plane){number / 2, number % 2, at}; }

static fibrad_wall wall_at(int number, double at) {
    return (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = plane_at(number, at)};
}

/* By fibrad_wall.cylinder.along. */
static const char *const cylinder_names[] = {"xcylinder", "ycylinder", "cylinder"};

static bool is_cylinder(const fibrad_wall *wall) { return wall->kind == FIBRAD_WALL_CYLINDER; }

static bool is_mesh(const fibrad_wall *wall) { return wall->kind == FIBRAD_WALL_MESH; }

const char *wall_name(const struct walls *walls, uint32_t k) {
    const fibrad_wall *wall = &walls->wall[k];
    if (is_mesh(wall)) return walls->meshes->name[k];
    return is_cylinder(wall) ? cylinder_names[wall->cylinder.along] : plane_name(&wall->plane);
}

bool wall_across(const fibrad_wall *wall, int axis) {
    return is_cylinder(wall) ? axis != wall->cylinder.along : !is_mesh(wall) && axis == wall->plane.axis;
}

static int plane_number(const fibrad_plane *plane) { return 2 * plane->axis + plane->upper; }

const char *plane_name(const fibrad_plane *plane) { return plane_names[plane_number(plane)]; }

static bool is_word(const char *word, size_t length, const char *name) {
    return strlen(name) == length && strncmp(word, name, length) == 0;
}

/* Whether a text begins with `begin`. */
static bool begins_with(const char *text, const char *begin) { return strncmp(text, begin, strlen(begin)) == 0; }

uint32_t wall_index(const struct walls *walls, const char *name, size_t length) {
    uint32_t k = 0;
    while (k < walls->count && !is_word(name, length, wall_name(walls, k))) ++k;
    return k < walls->count ? k : WALLS_MAX;
}

static bool is_there(const struct walls *walls, const char *name) {
    return wall_index(walls, name, strlen(name)) < WALLS_MAX;
}

/* The cylinder. NULL: there is none. */
static const fibrad_wall *cylinder_among(const struct walls *walls) {
    for (uint32_t k = 0; k < walls->count; ++k)
        if (is_cylinder(&walls->wall[k])) return &walls->wall[k];
    return NULL;
}

/* The plane of a side, which may be a wall or an opening. NULL: there is none. */
static const fibrad_plane *plane_of_side(const struct walls *walls, int number) {
    for (uint32_t k = 0; k < walls->count; ++k)
        if (walls->wall[k].kind == FIBRAD_WALL_PLANE && plane_number(&walls->wall[k].plane) == number)
            return &walls->wall[k].plane;
    for (uint32_t k = 0; k < walls->openings; ++k)
        if (plane_number(&walls->opening[k]) == number) return &walls->opening[k];
    return NULL;
}

static int named_twice(const char *name) { return message(STATUS_USAGE, "--wall: %s is named twice", name); }

static int add_wall(struct wall_options *options, fibrad_wall wall, bool placed) {
    struct walls *walls = &options->walls;
    const uint32_t k = walls->count;
    if (k == WALLS_MAX) return message(STATUS_USAGE, "--wall: more than %d walls", WALLS_MAX);
    options->placed[k] = placed;
    walls->wall[k] = wall;
    const char *name = wall_name(walls, k);
    if (is_there(walls, name) || (wall.kind == FIBRAD_WALL_PLANE && plane_of_side(walls, plane_number(&wall.plane))))
        return named_twice(name);
    if (is_cylinder(&wall) && cylinder_among(walls))
        return message(STATUS_USAGE, "--wall: there can be one cylinder, not %s and %s too",
                       wall_name(walls, (uint32_t)(cylinder_among(walls) - walls->wall)), name);
    ++walls->count;
    return STATUS_OK;
}

static int add_opening(struct walls *walls, int number, double at) {
    if (plane_of_side(walls, number)) return named_twice(plane_names[number]);
    walls->opening[walls->openings++] = plane_at(number, at);
    return STATUS_OK;
}

/* Reads a finite number and moves *text behind it. False: there is none. */
static bool take_number(const char **text, double *value) {
    char *end;
    *value = strtod(*text, &end);
    const bool found = end != *text && isfinite(*value);
    *text = end;
    return found;
}

/* Reads X,Y,R and moves *text behind them. axis: as in fibrad_wall.cylinder. */
static int take_cylinder(int axis, const char **text, struct wall_options *options) {
    static const char *const position[] = {"Y,Z", "X,Z", "X,Y"};
    double c[3];
    bool good = take_number(text, &c[0]);
    for (int k = 1; k < 3 && good; ++k) good = *(*text)++ == ',' && take_number(text, &c[k]);
    if (!good || !(c[2] > 0))
        return message(STATUS_USAGE, "--wall: a cylinder is %s:%s,R with a radius R above 0", cylinder_names[axis],
                       position[axis]);
    return add_wall(options, (fibrad_wall){.kind = FIBRAD_WALL_CYLINDER, .cylinder = {c[0], c[1], c[2], axis}}, true);
}

/* Whether *text begins with `begin`. If so, moves *text behind it. */
static bool take_text(const char **text, const char *begin) {
    const bool found = begins_with(*text, begin);
    if (found) *text += strlen(begin);
    return found;
}

/* The number of the side with a name. PLANES: there is none. */
static int side_number(const char *word, size_t length) {
    int k = 0;
    while (k < PLANES && !is_word(word, length, plane_names[k])) ++k;
    return k;
}

static int take_plane(const char *word, size_t length, const char **text, struct wall_options *options) {
    const int k = side_number(word, length);
    double at = 0;
    if (k < PLANES) {
        if (take_text(text, "=open")) return add_opening(&options->walls, k, NAN);
        const bool placed = take_text(text, "=");
        if (placed && !take_number(text, &at))
            return message(STATUS_USAGE, "--wall: %s= needs a number, or the word open", plane_names[k]);
        if (placed && take_text(text, ":open")) return add_opening(&options->walls, k, at);
        return add_wall(options, wall_at(k, at), placed);
    }
    return message(STATUS_USAGE,
                   "--wall: '%.40s' is none of auto, box, xmin ... zmax, cylinder:X,Y,R, xcylinder:Y,Z,R, "
                   "ycylinder:X,Z,R, mesh:FILE and NAME=mesh:FILE",
                   word);
}

/* Takes the word box and its open sides. */
static int take_box(const char **text, struct wall_options *options) {
    int status = STATUS_OK;
    options->box = true;
    while (!status && take_text(text, ":")) {
        const bool open = take_text(text, "open=");
        const size_t length = strcspn(*text, ",:");
        const int k = side_number(*text, length);
        if (!open || k == PLANES)
            return message(STATUS_USAGE, "--wall: a box may have open sides: box:open=zmax, not '%.40s'", *text);
        *text += length;
        status = add_opening(&options->walls, k, NAN);
    }
    return status;
}

/* Takes one of the words behind the file of a mesh. */
static int take_mesh_word(const char *word, struct mesh_file *file) {
    if (strcmp(word, "solids") == 0)
        file->solids = true;
    else if (strcmp(word, "both") == 0)
        file->sides = SIDES_BOTH;
    else if (strcmp(word, "normals") == 0)
        file->sides = SIDES_NORMALS;
    else if (begins_with(word, "scale="))
        return options_number("--wall: scale", word + strlen("scale="), 1e-12, 1e12, &file->scale);
    else if (strcmp(word, "auto") != 0)
        return message(STATUS_USAGE, "--wall: '%.40s' is none of both, normals, auto, solids, scale=S", word);
    return STATUS_OK;
}

/* Reads the file of a mesh and adds its walls. */
static int add_mesh(struct wall_options *options, const struct mesh_file *file) {
    struct walls *walls = &options->walls;
    if (!walls->meshes) walls->meshes = calloc(1, sizeof *walls->meshes);
    if (!walls->meshes) return message_memory();
    int status = meshes_add(walls->meshes, file, walls->count);
    const uint32_t more = walls->meshes->mesh ? walls->meshes->mesh[walls->meshes->count - 1].walls : 0;
    for (uint32_t k = 0; k < more && !status; ++k)
        status = add_wall(options, (fibrad_wall){.kind = FIBRAD_WALL_MESH}, true);
    return status;
}

/* The axis of the cylinder with a name, as in fibrad_wall.cylinder. -1: there is none. */
static int cylinder_named(const char *word, size_t length) {
    int axis = 2;
    while (axis >= 0 && !is_word(word, length, cylinder_names[axis])) --axis;
    return axis;
}

/* Names that have a meaning of their own in options and outputs. */
static bool is_reserved(const char *name) {
    static const char *const others[] = {"auto", "box", "open", "mesh", "surroundings", "beyond"};
    bool found = cylinder_named(name, strlen(name)) >= 0;
    for (int k = 0; k < PLANES; ++k) found = found || strcmp(name, plane_names[k]) == 0;
    for (size_t k = 0; k < sizeof others / sizeof *others; ++k) found = found || strcmp(name, others[k]) == 0;
    return found;
}

/* Takes FILE:WORD:WORD. Splits `item` at the colons. */
static int take_mesh_words(char *item, struct mesh_file *file) {
    char *next = strchr(item, ':');
    int status = STATUS_OK;
    for (file->path = item; next && !status;) {
        char *word = next + 1;
        *next = 0;
        next = strchr(word, ':');
        if (next) *next = 0;
        status = take_mesh_word(word, file);
    }
    if (!status && *item == 0) status = message(STATUS_USAGE, "--wall: mesh:FILE needs a file");
    return status;
}

/* Takes NAME=mesh:FILE:WORD:WORD up to the next comma. word, length: NAME; word NULL: no name. *text: at FILE; moves
 * behind the item. */
static int take_mesh(const char *word, size_t length, const char **text, struct wall_options *options) {
    char *item = strndup(*text, strcspn(*text, ",")), *name = word ? strndup(word, length) : NULL;
    struct mesh_file file = {.name = name, .scale = 1};
    int status = item && (name || !word) ? STATUS_OK : message_memory();
    *text += strcspn(*text, ",");
    if (!status && name && (!mesh_name(name) || is_reserved(name)))
        status = message(STATUS_USAGE, "--wall: a wall cannot be called '%.40s'", name);
    if (!status) status = take_mesh_words(item, &file);
    if (!status) status = add_mesh(options, &file);
    free(item);
    free(name);
    return status;
}

int walls_option(const char *text, void *wall_options) {
    struct wall_options *options = wall_options;
    for (;;) {
        const char *word = text;
        const size_t length = strcspn(word, ",=:");
        const int cylinder = cylinder_named(word, length);
        int status = STATUS_OK;
        text += length;
        if (cylinder >= 0 && *text == ':') {
            ++text;
            status = take_cylinder(cylinder, &text, options);
        } else if (begins_with(word, "mesh:")) {
            ++text;
            status = take_mesh(NULL, 0, &text, options);
        } else if (begins_with(text, "=mesh:")) {
            text += strlen("=mesh:");
            status = take_mesh(word, length, &text, options);
        } else if (is_word(word, length, "auto")) {
            options->automatic = true;
        } else if (is_word(word, length, "box")) {
            status = take_box(&text, options);
        } else {
            status = take_plane(word, length, &text, options);
        }
        if (status || *text == 0) return status;
        if (*text++ != ',') return message(STATUS_USAGE, "--wall: '%.40s' is not understood", word);
    }
}

/* Adds the planes of the words auto and box. A side that has been named keeps its own plane. */
static int add_planes_of_box(struct wall_options *options, const struct bed *bed, const char *file) {
    if (options->automatic && !(bed->low[0] < bed->high[0]))
        return message_at(STATUS_USAGE, file, 0,
                          "--wall auto needs a box in the file; --wall box takes the ends of the spheres");
    for (int k = 0; k < PLANES; ++k) {
        const bool wanted = options->box || (options->automatic && !(bed->period[k / 2] > 0));
        if (wanted && !plane_of_side(&options->walls, k)) add_wall(options, wall_at(k, 0), false);
    }
    return STATUS_OK;
}

static int check_axes(const struct walls *walls, const struct bed *bed) {
    const fibrad_wall *cylinder = cylinder_among(walls);
    for (int k = 0; k < PLANES; ++k) {
        const fibrad_plane *wall = plane_of_side(walls, k), *lower = NULL;
        if (!wall) continue;
        if (bed->period[k / 2] > 0)
            return message(STATUS_USAGE, "--wall: %s lies across a periodic axis", plane_names[k]);
        if (cylinder && wall_across(cylinder, k / 2))
            return message(STATUS_USAGE, "--wall: %s cannot be combined with a cylinder along %c", plane_names[k],
                           "xyz"[cylinder->cylinder.along]);
        if (k % 2) lower = plane_of_side(walls, k - 1);
        if (lower && !(lower->at < wall->at))
            return message(STATUS_USAGE, "--wall: %s does not lie below %s", plane_names[k - 1], plane_names[k]);
    }
    for (int k = 0; k < 2 && cylinder; ++k)
        if (bed->period[cylinder_across(cylinder, k)] > 0)
            return message(STATUS_USAGE, "--wall: a cylinder along %c needs %c and %c axes that are not periodic",
                           "xyz"[cylinder->cylinder.along], "xyz"[cylinder_across(cylinder, 0)],
                           "xyz"[cylinder_across(cylinder, 1)]);
    return STATUS_OK;
}

/* Whether walls end along an axis. */
static bool is_closed(const struct walls *walls, const struct bed *bed, int axis) {
    const bool both = plane_of_side(walls, 2 * axis) && plane_of_side(walls, 2 * axis + 1);
    const fibrad_wall *cylinder = cylinder_among(walls);
    return bed->period[axis] > 0 || both || (cylinder && wall_across(cylinder, axis));
}

bool walls_closed(const struct walls *walls, const struct bed *bed) {
    if (walls->meshes && walls->meshes->enclosing > 0) return true;
    return walls->openings == 0 && is_closed(walls, bed, 0) && is_closed(walls, bed, 1) && is_closed(walls, bed, 2);
}

bool wall_endless(const struct walls *walls, const struct bed *bed, const fibrad_wall *wall) {
    for (int axis = 0; axis < 3 && !is_mesh(wall); ++axis)
        if (!wall_across(wall, axis) && !is_closed(walls, bed, axis)) return true;
    return false;
}

int walls_refuse_endless(const struct walls *walls, const struct bed *bed) {
    char missing[PLANES * sizeof "xmin=open,"] = "";
    const char *first = NULL;
    int length = 0;
    for (int k = 0; k < PLANES; ++k) {
        if (is_closed(walls, bed, k / 2) || plane_of_side(walls, k)) continue;
        length +=
            snprintf(missing + length, sizeof missing - (size_t)length, "%s%s=open", first ? "," : "", plane_names[k]);
        if (!first) first = plane_names[k];
    }
    return message(
        STATUS_USAGE,
        "--wall: these walls form a tube or a corner without end; where the bed is open, add %s (%s=H:open if "
        "the walls end at H)",
        missing, first ? first : "");
}

int wall_unknown(const char *option, const struct walls *walls, const char *name, size_t length) {
    for (uint32_t k = 0; k < walls->openings; ++k)
        if (is_word(name, length, plane_name(&walls->opening[k])))
            return message(STATUS_USAGE, "%s: %.*s is an opening; it is as black and as hot as the surroundings",
                           option, (int)length, name);
    const char *names[WALLS_MAX];
    char list[NAMES_LISTED], hint[HINT_ROOM];
    for (uint32_t k = 0; k < walls->count; ++k) names[k] = wall_name(walls, k);
    name_hint(hint, "", name, length, names, walls->count);
    return message(STATUS_USAGE, "%s: there is no wall %.*s%s there are %s", option, length > 40 ? 40 : (int)length,
                   name, hint, names_list(list, names, walls->count));
}

static bool is_beyond(const fibrad_wall *wall, const double centre[3]) {
    if (is_mesh(wall)) return false;
    if (is_cylinder(wall)) return cylinder_distance(wall, centre) > wall->cylinder.radius;
    const double c = centre[wall->plane.axis];
    return wall->plane.upper ? c > wall->plane.at : c < wall->plane.at;
}

static int check_centres(const struct walls *walls, const struct bed *bed, const char *file) {
    for (uint32_t i = 0; i < bed->n; ++i)
        for (uint32_t k = 0; k < walls->count; ++k)
            if (is_beyond(&walls->wall[k], (const double[]){bed->x[i], bed->y[i], bed->z[i]}))
                return message_at(STATUS_INPUT, file, bed->line[i], "the centre of sphere %lld lies beyond the wall %s",
                                  (long long)bed_name(bed, i), wall_name(walls, k));
    return STATUS_OK;
}

int walls_of(const struct wall_options *options, const struct bed *bed, const char *file, struct walls *walls) {
    struct wall_options all = *options;
    int status = all.automatic || all.box ? add_planes_of_box(&all, bed, file) : STATUS_OK;
    if (status) return status;
    *walls = all.walls;
    for (uint32_t k = 0; k < walls->openings; ++k) {
        fibrad_plane *opening = &walls->opening[k];
        if (isnan(opening->at)) opening->at = bed_reach(bed, opening->axis, opening->upper);
    }
    for (uint32_t k = 0; k < walls->count; ++k) {
        fibrad_wall *wall = &walls->wall[k];
        if (!all.placed[k]) wall->plane.at = bed_wall_end(bed, wall->plane.axis, wall->plane.upper, &walls->moved);
    }
    status = check_axes(walls, bed);
    return status ? status : check_centres(walls, bed, file);
}

void walls_free(struct wall_options *options) {
    if (options->walls.meshes) meshes_free(options->walls.meshes);
    free(options->walls.meshes);
}
