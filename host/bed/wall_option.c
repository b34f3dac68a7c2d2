/* wall_option.c - the option --wall: planes, a cylinder and meshes about a bed. SPDX-License-Identifier: MIT */
#include "bed/wall_option.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "simple/cylinder.h"

static fibrad_plane plane_at(int number, double at) { return (fibrad_plane){number / 2, number % 2, at}; }

static bool is_cylinder(const fibrad_wall *wall) { return wall->kind == FIBRAD_WALL_CYLINDER; }

static bool is_mesh(const fibrad_wall *wall) { return wall->kind == FIBRAD_WALL_MESH; }

const char *wall_name(const struct walls *walls, uint32_t k) {
    const fibrad_wall *wall = &walls->wall[k];
    if (is_mesh(wall)) return walls->meshes->name[k];
    return is_cylinder(wall) ? wall_cylinder_names[wall->cylinder.along] : plane_name(&wall->plane);
}

bool wall_across(const fibrad_wall *wall, int axis) {
    return is_cylinder(wall) ? axis != wall->cylinder.along : !is_mesh(wall) && axis == wall->plane.axis;
}

static int plane_number(const fibrad_plane *plane) { return 2 * plane->axis + plane->upper; }

const char *plane_name(const fibrad_plane *plane) { return wall_plane_names[plane_number(plane)]; }

uint32_t wall_index(const struct walls *walls, const char *name) {
    uint32_t k = 0;
    while (k < walls->count && strcmp(name, wall_name(walls, k)) != 0) ++k;
    return k < walls->count ? k : WALLS_MAX;
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

/* ---- options ---------------------------------------------------------------------------------------------------- */

/* The wall that takes the place of another: the same side, cylinder, or word. NULL: there is none. */
static struct wall_words *find_same(struct wall_options *options, const struct wall_words *words) {
    for (struct wall_words *w = options->word; w < options->word + options->count; ++w) {
        if (w->shape != words->shape || w->shape == WALL_MESH || w->shape == WALL_NAMED) continue;
        if (w->shape == WALL_PLANE && plane_number(&w->wall.plane) != plane_number(&words->wall.plane)) continue;
        if (w->shape == WALL_CYLINDER && w->wall.cylinder.along != words->wall.cylinder.along) continue;
        return w;
    }
    return NULL;
}

int walls_option(const char *text, void *wall_options) {
    struct wall_options *options = wall_options;
    char fault[WALL_FAULT], *rest;
    if (options->texts == WALL_WORDS_MAX) return message(STATUS_USAGE, "--wall: more than %d options", WALL_WORDS_MAX);
    rest = options->text[options->texts] = strdup(text);
    if (!rest) return message_memory();
    for (++options->texts; rest;) {
        struct wall_words words = {0};
        if (!wall_words_take(&words, &rest, options->keys | WALL_GEOMETRY | WALL_NAMES_TOO, fault))
            return message(STATUS_USAGE, "--wall: %s", fault);
        struct wall_words *same = find_same(options, &words);
        if (!same && options->count == WALL_WORDS_MAX)
            return message(STATUS_USAGE, "--wall: more than %d walls", WALL_WORDS_MAX);
        *(same ? same : &options->word[options->count++]) = words;
    }
    return STATUS_OK;
}

unsigned walls_keys(const struct wall_options *options) {
    unsigned keys = 0;
    for (uint32_t k = 0; k < options->count; ++k) keys |= options->word[k].given;
    return keys;
}

/* Adds a wall. A plane may lie at the end of the bed, at NaN. */
static int add_wall(struct walls *walls, const struct wall_words *words) {
    const uint32_t k = walls->count;
    if (k == WALLS_MAX) return message(STATUS_USAGE, "--wall: more than %d walls", WALLS_MAX);
    walls->wall[k] = words->wall, walls->said[k] = *words;
    if (is_cylinder(&words->wall) && cylinder_among(walls))
        return message(STATUS_USAGE, "--wall: there can be one cylinder, not %s and %s too",
                       wall_cylinder_names[cylinder_among(walls)->cylinder.along], wall_name(walls, k));
    if (wall_index(walls, wall_name(walls, k)) < WALLS_MAX)
        return message(STATUS_USAGE, "--wall: %s is the name of two walls", wall_name(walls, k));
    ++walls->count;
    return STATUS_OK;
}

/* Whether a name has a meaning of its own in options and outputs. */
static bool is_reserved(const char *name) {
    static const char *const others[] = {"open", "surroundings", "beyond"};
    bool found = wall_words_shape(name);
    for (size_t k = 0; k < sizeof others / sizeof *others; ++k) found = found || strcmp(name, others[k]) == 0;
    return found;
}

/* Reads the file of a mesh and adds its walls. */
static int add_mesh(struct walls *walls, const struct wall_words *words) {
    const struct mesh_file *file = &words->mesh;
    if (file->name && (!mesh_name(file->name) || is_reserved(file->name)))
        return message(STATUS_USAGE, "--wall: a wall cannot be called '%.40s'", file->name);
    if (!walls->meshes) walls->meshes = calloc(1, sizeof *walls->meshes);
    if (!walls->meshes) return message_memory();
    int status = meshes_add(walls->meshes, file, walls->count);
    const uint32_t more = status ? 0 : walls->meshes->mesh[walls->meshes->count - 1].walls;
    for (uint32_t k = 0; k < more && !status; ++k) status = add_wall(walls, words);
    return status;
}

/* Takes more words about a wall that is there. */
static int say_more(struct walls *walls, const struct wall_words *words) {
    char fault[WALL_FAULT];
    const uint32_t k = wall_index(walls, words->word);
    struct wall_words *said = &walls->said[k < WALLS_MAX ? k : 0];
    if (k == WALLS_MAX) {
        wall_words_no_shape(words->word, fault);
        return message(STATUS_USAGE, "--wall: %s", fault);
    }
    if (words->given & WALL_HEAT) {
        said->temperature_text = words->temperature_text, said->temperature = words->temperature;
        said->temperatures = words->temperatures, said->power = words->power;
        said->given &= ~(unsigned)WALL_HEAT;
    }
    if (words->given & WALL_EMISSIVITY) said->emissivity = words->emissivity;
    if (words->given & WALL_ABSORPTIVITY) said->absorptivity = words->absorptivity;
    if (words->given & WALL_CAPACITY) said->capacity = words->capacity;
    said->given |= words->given;
    return STATUS_OK;
}

int walls_settle(struct wall_options *options) {
    struct walls *walls = &options->walls;
    int status = STATUS_OK;
    for (uint32_t k = 0; k < options->count && !status; ++k) {
        const struct wall_words *words = &options->word[k];
        const bool open = words->given & WALL_OPEN, round = words->shape == WALL_CYLINDER;
        if (words->shape == WALL_MESH)
            status = add_mesh(walls, words);
        else if (words->shape == WALL_NAMED)
            status = say_more(walls, words);
        else if (words->shape == WALL_PLANE && open)
            walls->opening[walls->openings++] = words->wall.plane;
        else if (words->shape == WALL_PLANE || round)
            status = add_wall(walls, words);
    }
    return status;
}

/* ---- walls about a bed ------------------------------------------------------------------------------------------ */

/* Adds the planes of the words auto and box. A side that has been named keeps its own plane. */
static int add_planes_of_box(const struct wall_options *options, const struct bed *bed, const char *file,
                             struct walls *walls) {
    int status = STATUS_OK;
    for (const struct wall_words *w = options->word; w < options->word + options->count; ++w) {
        const bool automatic = w->shape == WALL_AUTO;
        if (automatic && !(bed->low[0] < bed->high[0]))
            return message_at(STATUS_USAGE, file, 0,
                              "--wall auto needs a box in the file; --wall box takes the ends of the spheres");
        for (int k = 0; k < PLANES && (automatic || w->shape == WALL_BOX) && !status; ++k) {
            struct wall_words side = *w;
            side.wall = (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = plane_at(k, NAN)};
            if (!plane_of_side(walls, k) && !(automatic && bed->period[k / 2] > 0)) status = add_wall(walls, &side);
        }
    }
    return status;
}

static int check_axes(const struct walls *walls, const struct bed *bed) {
    const fibrad_wall *cylinder = cylinder_among(walls);
    for (int k = 0; k < PLANES; ++k) {
        const fibrad_plane *wall = plane_of_side(walls, k), *lower = NULL;
        if (!wall) continue;
        if (bed->period[k / 2] > 0)
            return message(STATUS_USAGE, "--wall: %s lies across a periodic axis", wall_plane_names[k]);
        if (cylinder && wall_across(cylinder, k / 2))
            return message(STATUS_USAGE, "--wall: %s cannot be combined with a cylinder along %c", wall_plane_names[k],
                           "xyz"[cylinder->cylinder.along]);
        if (k % 2) lower = plane_of_side(walls, k - 1);
        if (lower && !(lower->at < wall->at))
            return message(STATUS_USAGE, "--wall: %s does not lie below %s", wall_plane_names[k - 1],
                           wall_plane_names[k]);
    }
    for (int k = 0; k < 2 && cylinder; ++k)
        if (bed->period[cylinder_across(cylinder, k)] > 0)
            return message(STATUS_USAGE, "--wall: a cylinder along %c needs %c and %c axes that are not periodic",
                           "xyz"[cylinder->cylinder.along], "xyz"[cylinder_across(cylinder, 0)],
                           "xyz"[cylinder_across(cylinder, 1)]);
    return STATUS_OK;
}

bool walls_close(const struct walls *walls, const struct bed *bed, int side) {
    const fibrad_wall *cylinder = cylinder_among(walls);
    if (bed->period[side / 2] > 0 || (cylinder && wall_across(cylinder, side / 2))) return true;
    for (uint32_t k = 0; k < walls->count; ++k)
        if (walls->wall[k].kind == FIBRAD_WALL_PLANE && plane_number(&walls->wall[k].plane) == side) return true;
    return false;
}

/* Whether walls or openings end along an axis. */
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
    char missing[PLANES * sizeof "xmin:open,"] = "";
    const char *first = NULL;
    int length = 0;
    for (int k = 0; k < PLANES; ++k) {
        if (is_closed(walls, bed, k / 2) || plane_of_side(walls, k)) continue;
        length += snprintf(missing + length, sizeof missing - (size_t)length, "%s%s:open", first ? "," : "",
                           wall_plane_names[k]);
        if (!first) first = wall_plane_names[k];
    }
    return message(
        STATUS_USAGE,
        "--wall: these walls form a tube or a corner without end; where the bed is open, add %s (%s:open:at=H "
        "if the walls end at H)",
        missing, first ? first : "");
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
    *walls = options->walls;
    int status = add_planes_of_box(options, bed, file, walls);
    for (uint32_t k = 0; k < walls->openings; ++k) {
        fibrad_plane *opening = &walls->opening[k];
        if (isnan(opening->at)) opening->at = bed_reach(bed, opening->axis, opening->upper);
    }
    for (uint32_t k = 0; k < walls->count; ++k) {
        fibrad_plane *plane = &walls->wall[k].plane;
        if (walls->wall[k].kind == FIBRAD_WALL_PLANE && isnan(plane->at))
            plane->at = bed_wall_end(bed, plane->axis, plane->upper, &walls->moved);
    }
    if (!status) status = check_axes(walls, bed);
    return status ? status : check_centres(walls, bed, file);
}

void walls_free(struct wall_options *options) {
    for (uint32_t k = 0; k < options->texts; ++k) free(options->text[k]);
    if (options->walls.meshes) meshes_free(options->walls.meshes);
    free(options->walls.meshes);
}
