/* plot_slice.c - a slice through a bed with coloured spheres and walls. SPDX-License-Identifier: MIT */
#include "plot/plot_slice.h"

#include <math.h>
#include <string.h>

#include "bed/units.h"
#include "cli/message.h"
#include "cli/options.h"
#include "simple/cylinder.h"

/* A wall is shown if its distance from the bed is at most this part of the bed's length. With farther walls the bed
 * would become too small in the picture. */
#define FAR_WALL 0.3

/* Width over height of a panel with a slice. The range of the shorter side is widened, so that tall and flat beds leave
 * room for tics and titles. */
#define PANEL 1.1

int plot_plane_option(const char *text, void *plane) {
    struct plot_plane *slice = plane;
    const bool axis = *text >= 'x' && *text <= 'z' && (text[1] == 0 || text[1] == '=');
    if (!axis) return message(STATUS_USAGE, "--slice: '%.40s' is none of x=VALUE, y=VALUE and z=VALUE", text);
    slice->axis = *text, slice->placed = text[1] == '=';
    return slice->placed ? options_number("--slice", text + 2, -FIBRAD_LENGTH_MAX, FIBRAD_LENGTH_MAX, &slice->at) : 0;
}

int plot_plane_check(const struct plot_plane *plane, const struct bed *bed) {
    if (!plane->placed) return STATUS_OK;
    const int axis = plane->axis - 'x';
    const double *centre = bed_centres(bed, axis);
    for (uint32_t i = 0; i < bed->n; ++i)
        if (fabs(centre[i] - plane->at) < bed->r[i]) return STATUS_OK;
    return message(STATUS_USAGE, "--slice: no sphere is at %c = %g; spheres are from %g to %g", plane->axis, plane->at,
                   bed_reach(bed, axis, false), bed_reach(bed, axis, true));
}

/* A line of wall k in the slice: the coordinates of both ends to the right and up. */
typedef void line_seen(void *context, double end[2][2], uint32_t k);

static uint32_t walls_shown(const struct plot_slice *slice) { return slice->walls ? slice->walls->count : 0; }

/* A plane is a line through the whole range. */
static void plane_line(const struct plot_slice *slice, const fibrad_plane *plane, uint32_t k, line_seen *seen,
                       void *context) {
    if (plane->axis == slice->across) return;
    const int up = plane->axis == slice->axis[1], other = slice->axis[1 - up];
    double end[2][2];
    end[0][up] = end[1][up] = plane->at;
    end[0][1 - up] = slice->low[other], end[1][1 - up] = slice->high[other];
    seen(context, end, k);
}

/* A cylinder is a circle across its axis, and two lines across the other axes. */
static void cylinder_lines(const struct plot_slice *slice, const fibrad_wall *wall, uint32_t k, line_seen *seen,
                           void *context) {
    enum { CHORDS = 90 };
    const double middle[2] = {wall->cylinder.x, wall->cylinder.y}, radius = wall->cylinder.radius;
    const double pi = 3.14159265358979323846;
    const int along = wall->cylinder.along, up = slice->axis[1] == along,
              second = slice->across == cylinder_across(wall, 1);
    if (slice->across == along) {
        for (int c = 0; c < CHORDS; ++c) {
            double end[2][2];
            for (int e = 0; e < 2; ++e) {
                end[e][0] = middle[0] + radius * cos(2 * pi * (c + e) / CHORDS);
                end[e][1] = middle[1] + radius * sin(2 * pi * (c + e) / CHORDS);
            }
            seen(context, end, k);
        }
        return;
    }
    const double off = slice->at - middle[second], half = sqrt(fmax(radius * radius - off * off, 0));
    for (int side = -1; side < 2 && half > 0; side += 2) {
        double end[2][2];
        end[0][1 - up] = end[1][1 - up] = middle[1 - second] + side * half;
        end[0][up] = slice->low[along], end[1][up] = slice->high[along];
        seen(context, end, k);
    }
}

/* Finds where the slice cuts a triangle. False: nowhere. */
static bool cut_of(const struct plot_slice *slice, const struct surface *surface, uint32_t triangle, double end[2][2]) {
    const int across = slice->across;
    int ends = 0;
    for (int k = 0; k < 3 && ends < 2; ++k) {
        const double *a = surface_corner(surface, triangle, k), *b = surface_corner(surface, triangle, (k + 1) % 3);
        if ((a[across] < slice->at) == (b[across] < slice->at)) continue;
        const double part = (slice->at - a[across]) / (b[across] - a[across]);
        for (int up = 0; up < 2; ++up) {
            const int axis = slice->axis[up];
            end[ends][up] = a[axis] + part * (b[axis] - a[axis]);
        }
        ++ends;
    }
    return ends == 2;
}

/* Hands all lines of walls to a function. */
static void see_walls(const struct plot_slice *slice, line_seen *seen, void *context) {
    const struct meshes *meshes = slice->walls ? slice->walls->meshes : NULL;
    double end[2][2];
    for (uint32_t k = 0; k < walls_shown(slice); ++k) {
        const fibrad_wall *wall = &slice->walls->wall[k];
        if (wall->kind == FIBRAD_WALL_PLANE) plane_line(slice, &wall->plane, k, seen, context);
        if (wall->kind == FIBRAD_WALL_CYLINDER) cylinder_lines(slice, wall, k, seen, context);
    }
    for (uint32_t m = 0; meshes && m < meshes->count; ++m)
        for (uint32_t t = 0; t < meshes->mesh[m].surface.n; ++t)
            if (cut_of(slice, &meshes->mesh[m].surface, t, end)) seen(context, end, mesh_wall(&meshes->mesh[m], t));
}

/* A slice whose range is being widened, and its range without walls. */
struct widening {
    struct plot_slice *slice;
    double low[3], high[3];
};

/* Widens the range of the slice by a line, if that is near. */
static void include_line(void *context, double end[2][2], uint32_t k) {
    struct widening *widening = context;
    struct plot_slice *slice = widening->slice;
    (void)k;
    for (int e = 0; e < 2; ++e)
        for (int up = 0; up < 2; ++up) {
            const int axis = slice->axis[up];
            const double low = widening->low[axis], high = widening->high[axis], away = FAR_WALL * (high - low);
            if (end[e][up] < low - away || end[e][up] > high + away) continue;
            slice->low[axis] = fmin(slice->low[axis], end[e][up]);
            slice->high[axis] = fmax(slice->high[axis], end[e][up]);
        }
}

/* Chooses the unit of the axes. */
static void choose_scale(struct plot_slice *slice) {
    const bool known = slice->bed->metres > 0;
    const double metres = known ? slice->bed->metres : 1;
    double largest = 0;
    for (int up = 0; up < 2; ++up) {
        const int axis = slice->axis[up];
        largest = fmax(largest, fmax(fabs(slice->low[axis]), fabs(slice->high[axis])) * metres);
    }
    const struct prefixed unit = unit_prefixed(largest, known ? "m" : "");
    slice->scale = unit.scale / metres;
    snprintf(slice->unit, sizeof slice->unit, "%s", unit.name);
    const double place = slice->at / slice->scale;
    snprintf(slice->place, sizeof slice->place, "%c = %.4g%s%s", 'x' + slice->across, place + 0.0, /* no -0 */
             known        ? " "
             : *unit.name ? " x "
                          : "",
             slice->unit);
}

void plot_slice_of(struct plot_slice *slice, const struct plot_plane *plane, const struct bed *bed,
                   const struct walls *walls) {
    const int across = plane->axis ? plane->axis - 'x' : 1;
    *slice = (struct plot_slice){.bed = bed, .walls = walls, .across = across, .at = plane->placed ? plane->at : NAN};
    slice->axis[0] = across == 0, slice->axis[1] = across == 2 ? 1 : 2;
    for (int axis = 0; axis < 3; ++axis)
        slice->low[axis] = bed_reach(bed, axis, false), slice->high[axis] = bed_reach(bed, axis, true);
    const double middle = slice->low[across] + (slice->high[across] - slice->low[across]) / 2;
    const double *centre = bed_centres(bed, across);
    for (uint32_t i = 0; i < bed->n && !plane->placed; ++i)
        if (!(fabs(centre[i] - middle) >= fabs(slice->at - middle))) slice->at = centre[i];
    if (fabs(slice->at) < 1e-9 * (slice->high[across] - slice->low[across])) slice->at = 0; /* what rounding leaves */
    struct widening widening = {.slice = slice};
    memcpy(widening.low, slice->low, sizeof widening.low);
    memcpy(widening.high, slice->high, sizeof widening.high);
    see_walls(slice, include_line, &widening);
    choose_scale(slice);
}

/* Where and how lines of walls are printed. */
struct wall_lines {
    FILE *script;
    double scale;
    const double *value; /* [walls] for the colour; NULL: none */
};

/* Prints the ends of a line with a value, and an empty line. */
static void print_wall(void *wall_lines, double end[2][2], uint32_t k) {
    const struct wall_lines *lines = wall_lines;
    for (int e = 0; e < 2; ++e)
        fprintf(lines->script, "%.9g %.9g %.6g\n", end[e][0] / lines->scale, end[e][1] / lines->scale,
                lines->value ? lines->value[k] : 0);
    fputs("\n", lines->script);
}

static void print_walls(FILE *script, const struct plot_slice *slice, const double *wall_value) {
    struct wall_lines lines = {script, slice->scale, wall_value};
    fputs("$walls << END\n", script);
    see_walls(slice, print_wall, &lines);
    fputs("NaN NaN NaN\nEND\n", script); /* gnuplot takes a block without a line as an error */
}

static void print_circles(FILE *script, const struct plot_slice *slice, const struct plot_colours *colours) {
    const struct bed *bed = slice->bed;
    const double *right = bed_centres(bed, slice->axis[0]), *up = bed_centres(bed, slice->axis[1]);
    const double *across = bed_centres(bed, slice->across);
    fputs("$slice << END\n", script);
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double off = fabs(across[i] - slice->at);
        if (off >= bed->r[i] || (colours->wanted && !colours->wanted[i])) continue;
        fprintf(script, "%.6g %.6g %.6g %.6g\n", right[i] / slice->scale, up[i] / slice->scale,
                sqrt(bed->r[i] * bed->r[i] - off * off) / slice->scale, colours->value[i] / colours->unit);
    }
    fputs("NaN NaN NaN NaN\nEND\n", script);
}

/* Prints the range of an axis of the picture: that of the slice, or `least` about its middle if that is more. */
static void print_range(FILE *script, const struct plot_slice *slice, int up, double least) {
    const double low = slice->low[slice->axis[up]] / slice->scale, high = slice->high[slice->axis[up]] / slice->scale;
    const double half = fmax(high - low, least) / 2, middle = low + (high - low) / 2;
    fprintf(script, "set %crange [%.9g:%.9g]\nset %clabel '%c%s%s%s'\n", 'x' + up, middle - half, middle + half,
            'x' + up, 'x' + slice->axis[up], slice->unit[0] ? " [" : "", slice->unit, slice->unit[0] ? "]" : "");
}

void plot_slice_draw(FILE *script, const struct plot_slice *slice, const struct plot_colours *colours) {
    double length[2];
    for (int up = 0; up < 2; ++up)
        length[up] = (slice->high[slice->axis[up]] - slice->low[slice->axis[up]]) / slice->scale;
    print_circles(script, slice, colours);
    print_walls(script, slice, colours->wall_value);
    print_range(script, slice, 0, PANEL * length[1]);
    print_range(script, slice, 1, length[0] / PANEL);
    fprintf(script,
            "set xtics auto; set ytics auto; set size ratio -1; set colorbox; unset key; unset grid\n"
            "plot $slice using 1:2:3:4 with circles fillcolor palette fillstyle solid noborder, $walls using 1:2%s\n"
            "set size noratio; set size nosquare; unset cblabel\n",
            colours->wall_value ? ":3 with lines lw 7 lc palette" : " with lines lw 7 lc '#8c8c8c'");
}
