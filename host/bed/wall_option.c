/* wall_option.c - the option --wall: planes and a cylinder about a bed. SPDX-License-Identifier: MIT */
#include "bed/wall_option.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

enum { PLANES = 6, CYLINDER = 6 };

static const char *const names[FIBRAD_WALLS] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax", "cylinder"};

const char *wall_name(uint32_t wall) { return names[wall]; }

static bool is(const char *word, size_t length, const char *name) {
    return strlen(name) == length && strncmp(word, name, length) == 0;
}

static bool named(const struct wall_options *options, uint32_t wall) {
    for (uint32_t k = 0; k < options->count; ++k)
        if (options->wall[k] == wall) return true;
    return false;
}

static int add(struct wall_options *options, uint32_t wall, bool placed, double at) {
    if (named(options, wall)) return message(STATUS_USAGE, "--wall: %s is named twice", names[wall]);
    options->wall[options->count] = wall;
    options->placed[options->count] = placed;
    options->at[options->count++] = at;
    return STATUS_OK;
}

/* One finite number at *text, which moves behind it. */
static bool number(const char **text, double *value) {
    char *end;
    *value = strtod(*text, &end);
    const bool found = end != *text && isfinite(*value);
    *text = end;
    return found;
}

/* X,Y,R; *text moves behind them. */
static int cylinder(const char **text, struct wall_options *options) {
    double *c = options->cylinder;
    bool good = number(text, &c[0]);
    for (int k = 1; k < 3 && good; ++k) good = *(*text)++ == ',' && number(text, &c[k]);
    if (!good || !(c[2] > 0)) return message(STATUS_USAGE, "--wall: a cylinder is cylinder:X,Y,R with a radius R > 0");
    return add(options, CYLINDER, true, 0);
}

static int plane(const char *word, size_t length, const char **text, struct wall_options *options) {
    for (uint32_t wall = 0; wall < PLANES; ++wall) {
        if (!is(word, length, names[wall])) continue;
        double at = 0;
        const bool placed = **text == '=';
        if (!placed) return add(options, wall, false, 0);
        ++*text;
        if (!number(text, &at)) return message(STATUS_USAGE, "--wall: %s= needs a number", names[wall]);
        return add(options, wall, true, at);
    }
    return message(STATUS_USAGE, "--wall: '%.40s' is neither auto, box, xmin ... zmax nor cylinder:X,Y,R", word);
}

int walls_option(const char *text, struct wall_options *options) {
    for (;;) {
        const char *word = text;
        const size_t length = strcspn(word, ",=:");
        int status = STATUS_OK;
        text += length;
        if (is(word, length, "cylinder") && *text == ':') {
            ++text;
            status = cylinder(&text, options);
        } else if (is(word, length, "auto")) {
            options->automatic = true;
        } else if (is(word, length, "box")) {
            options->box = true;
        } else {
            status = plane(word, length, &text, options);
        }
        if (status || *text == 0) return status;
        if (*text++ != ',') return message(STATUS_USAGE, "--wall: '%.40s' is not understood", word);
    }
}

/* The words auto and box, as the planes they stand for but for those named besides. */
static int spell_out(struct wall_options *options, const struct bed *bed, const char *file) {
    if (options->automatic && !(bed->low[0] < bed->high[0]))
        return message_at(STATUS_USAGE, file, 0, "--wall auto needs a box in the file; --wall box takes the spheres'");
    for (uint32_t wall = 0; wall < PLANES; ++wall) {
        const bool periodic = bed->period[wall / 2] > 0;
        if (named(options, wall) || (!options->box && (!options->automatic || periodic))) continue;
        add(options, wall, false, 0);
    }
    return STATUS_OK;
}

/* Where a plane stands whose place was not given. */
static double end_of_bed(const struct bed *bed, uint32_t wall) {
    const uint32_t axis = wall / 2;
    const bool high = wall % 2;
    if (bed->low[axis] < bed->high[axis]) return high ? bed->high[axis] : bed->low[axis];
    const double *c = axis == 0 ? bed->x : axis == 1 ? bed->y : bed->z;
    double end = high ? -INFINITY : INFINITY;
    for (uint32_t i = 0; i < bed->n; ++i) end = high ? fmax(end, c[i] + bed->r[i]) : fmin(end, c[i] - bed->r[i]);
    return end;
}

static int check_axes(const fibrad_walls *walls, const struct bed *bed) {
    for (uint32_t wall = 0; wall < PLANES; ++wall) {
        if (!(walls->planes >> wall & 1)) continue;
        if (bed->period[wall / 2] > 0)
            return message(STATUS_USAGE, "--wall: %s stands across a periodic axis", names[wall]);
        if (walls->cylinder[2] > 0 && wall / 2 < 2)
            return message(STATUS_USAGE, "--wall: %s and a cylinder do not go together", names[wall]);
        if (wall % 2 && walls->planes >> (wall - 1) & 1 && !(walls->at[wall - 1] < walls->at[wall]))
            return message(STATUS_USAGE, "--wall: %s does not lie below %s", names[wall - 1], names[wall]);
    }
    if (walls->cylinder[2] > 0 && (bed->period[0] > 0 || bed->period[1] > 0))
        return message(STATUS_USAGE, "--wall: a cylinder needs x and y axes that are not periodic");
    return STATUS_OK;
}

static int check_centres(const fibrad_walls *walls, const struct bed *bed, const char *file) {
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double centre[3] = {bed->x[i], bed->y[i], bed->z[i]};
        uint32_t beyond = FIBRAD_WALLS;
        for (uint32_t wall = 0; wall < PLANES; ++wall) {
            const double c = centre[wall / 2], at = walls->at[wall];
            if (walls->planes >> wall & 1 && (wall % 2 ? c > at : c < at)) beyond = wall;
        }
        const double *cyl = walls->cylinder;
        if (cyl[2] > 0 && hypot(centre[0] - cyl[0], centre[1] - cyl[1]) > cyl[2]) beyond = CYLINDER;
        if (beyond < FIBRAD_WALLS)
            return message_at(STATUS_INPUT, file, bed->line[i], "the centre of sphere %u lies beyond the wall %s", i,
                              names[beyond]);
    }
    return STATUS_OK;
}

int walls_of(const struct wall_options *options, const struct bed *bed, const char *file, fibrad_walls *walls,
             struct wall_order *order) {
    struct wall_options all = *options;
    *walls = (fibrad_walls){0};
    *order = (struct wall_order){0};
    int status = all.automatic || all.box ? spell_out(&all, bed, file) : STATUS_OK;
    if (status) return status;
    order->count = all.count;
    for (uint32_t k = 0; k < all.count; ++k) {
        const uint32_t wall = order->wall[k] = all.wall[k];
        if (wall == CYLINDER) {
            memcpy(walls->cylinder, all.cylinder, sizeof walls->cylinder);
        } else {
            walls->planes |= 1u << wall;
            walls->at[wall] = all.placed[k] ? all.at[k] : end_of_bed(bed, wall);
        }
    }
    status = check_axes(walls, bed);
    return status ? status : check_centres(walls, bed, file);
}
