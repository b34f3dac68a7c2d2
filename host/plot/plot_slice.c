/* plot_slice.c - a slice through a bed across y with coloured spheres and walls. SPDX-License-Identifier: MIT */
#include "plot/plot_slice.h"

#include <math.h>
#include <string.h>

/* A wall is shown if its distance from the bed is at most this part of the bed's length. With farther walls the bed
 * would become too small in the picture. */
#define FAR_WALL 0.3

/* The least and largest coordinate of spheres along an axis. */
static void bounds(const double *centre, const double *r, uint32_t n, double *low, double *high) {
    *low = INFINITY;
    *high = -INFINITY;
    for (uint32_t i = 0; i < n; ++i) {
        *low = fmin(*low, centre[i] - r[i]);
        *high = fmax(*high, centre[i] + r[i]);
    }
}

/* Finds where the slice meets a plane or a cylinder: coordinates along *axis, 0 or 2. Returns their number, at most 2.
 * A mesh has none. */
static int wall_places(const struct plot_slice *slice, const fibrad_body *wall, int *axis, double place[2]) {
    if (wall->kind == FIBRAD_BODY_MESH) return 0;
    *axis = wall->kind == FIBRAD_BODY_PLANE ? wall->plane.axis : 0;
    if (wall->kind == FIBRAD_BODY_PLANE) {
        place[0] = wall->plane.at;
        return *axis != 1;
    }
    const double off = slice->y - wall->cylinder.y, square = wall->cylinder.radius * wall->cylinder.radius - off * off;
    place[0] = wall->cylinder.x - sqrt(fmax(square, 0));
    place[1] = wall->cylinder.x + sqrt(fmax(square, 0));
    return square > 0 ? 2 : 0;
}

static uint32_t walls_shown(const struct plot_slice *slice) { return slice->walls ? slice->walls->count : 0; }

/* Finds where the slice cuts a triangle: x and z of both ends of the cut. False: nowhere. */
static bool cut_of(const struct plot_slice *slice, const struct surface *surface, uint32_t triangle, double end[2][2]) {
    int ends = 0;
    for (int k = 0; k < 3 && ends < 2; ++k) {
        const double *a = surface_corner(surface, triangle, k), *b = surface_corner(surface, triangle, (k + 1) % 3);
        if ((a[1] < slice->y) == (b[1] < slice->y)) continue;
        const double part = (slice->y - a[1]) / (b[1] - a[1]);
        for (int axis = 0; axis < 2; ++axis) end[ends][axis] = a[2 * axis] + part * (b[2 * axis] - a[2 * axis]);
        ++ends;
    }
    return ends == 2;
}

/* A function that takes the cut of a triangle of wall k. */
typedef void cut_seen(void *context, double end[2][2], uint32_t k);

static void cut_meshes(const struct plot_slice *slice, cut_seen *seen, void *context) {
    const struct meshes *meshes = slice->walls ? slice->walls->meshes : NULL;
    double end[2][2];
    for (uint32_t m = 0; meshes && m < meshes->count; ++m)
        for (uint32_t t = 0; t < meshes->mesh[m].surface.n; ++t)
            if (cut_of(slice, &meshes->mesh[m].surface, t, end)) seen(context, end, mesh_body(&meshes->mesh[m], t));
}

/* A slice whose range is being widened, and its range without walls. */
struct widening {
    struct plot_slice *slice;
    double low[3], high[3];
};

static void include_place(struct widening *widening, int axis, double place) {
    struct plot_slice *slice = widening->slice;
    const double low = widening->low[axis], high = widening->high[axis], away = FAR_WALL * (high - low);
    if (place < low - away || place > high + away) return;
    slice->low[axis] = fmin(slice->low[axis], place);
    slice->high[axis] = fmax(slice->high[axis], place);
}

static void include_cut(void *widening, double end[2][2], uint32_t k) {
    (void)k;
    for (int e = 0; e < 2; ++e)
        for (int axis = 0; axis < 2; ++axis) include_place(widening, 2 * axis, end[e][axis]);
}

/* Widens the range of the slice, so that near walls are shown. */
static void include_walls(struct plot_slice *slice) {
    struct widening widening = {.slice = slice};
    memcpy(widening.low, slice->low, sizeof widening.low);
    memcpy(widening.high, slice->high, sizeof widening.high);
    for (uint32_t k = 0; k < walls_shown(slice); ++k) {
        int axis;
        double place[2];
        const int places = wall_places(slice, &slice->walls->body[k], &axis, place);
        for (int p = 0; p < places; ++p) include_place(&widening, axis, place[p]);
    }
    cut_meshes(slice, include_cut, &widening);
}

/* Chooses the unit of the axes: a power of 1000, so that the largest coordinate has few digits. */
static void choose_scale(struct plot_slice *slice, double metres) {
    static const char *const prefix[] = {"n", "\302\265", "m", "", "k"};
    const bool known = metres > 0;
    double largest = 0;
    for (int axis = 0; axis < 3; axis += 2)
        largest = fmax(largest, fmax(fabs(slice->low[axis]), fabs(slice->high[axis])) * (known ? metres : 1));
    const bool short_already = !(largest > 0 && (largest < 0.1 || largest >= 1e4));
    const int thousands = short_already ? 0 : (int)floor(log10(largest) / 3);
    slice->scale = pow(1000, thousands) / (known ? metres : 1);
    if (known && thousands >= -3 && thousands <= 1)
        snprintf(slice->unit, sizeof slice->unit, "%sm", prefix[3 + thousands]);
    else if (thousands)
        snprintf(slice->unit, sizeof slice->unit, "10^{%d}%s", 3 * thousands, known ? " m" : "");
    snprintf(slice->place, sizeof slice->place, "%.4g%s%s", slice->y / slice->scale,
             known       ? " "
             : thousands ? " x "
                         : "",
             slice->unit);
}

void plot_slice_of(struct plot_slice *slice, const struct bed *bed, const struct walls *walls, double metres) {
    const double *const centre[] = {bed->x, bed->y, bed->z};
    *slice = (struct plot_slice){.bed = bed, .walls = walls, .y = NAN};
    for (int axis = 0; axis < 3; ++axis) bounds(centre[axis], bed->r, bed->n, &slice->low[axis], &slice->high[axis]);
    const double middle = slice->low[1] + (slice->high[1] - slice->low[1]) / 2;
    for (uint32_t i = 0; i < bed->n; ++i)
        if (!(fabs(bed->y[i] - middle) >= fabs(slice->y - middle))) slice->y = bed->y[i];
    include_walls(slice);
    choose_scale(slice, metres);
}

/* Where and how lines of walls are printed. */
struct wall_lines {
    FILE *script;
    double scale;
    const double *value; /* [walls] for the colour; NULL: none */
};

static void print_end(const struct wall_lines *lines, double x, double z, uint32_t k) {
    fprintf(lines->script, "%.9g %.9g %.6g\n", x / lines->scale, z / lines->scale, lines->value ? lines->value[k] : 0);
}

static void print_cut(void *wall_lines, double end[2][2], uint32_t k) {
    const struct wall_lines *lines = wall_lines;
    for (int e = 0; e < 2; ++e) print_end(lines, end[e][0], end[e][1], k);
    fputs("\n", lines->script);
}

/* Prints the lines of walls: their ends with a value, and an empty line behind each. */
static void print_walls(FILE *script, const struct plot_slice *slice, const double *wall_value) {
    struct wall_lines lines = {script, slice->scale, wall_value};
    fputs("$walls << END\n", script);
    for (uint32_t k = 0; k < walls_shown(slice); ++k) {
        int axis;
        double place[2];
        const int places = wall_places(slice, &slice->walls->body[k], &axis, place);
        for (int p = 0; p < places; ++p) {
            for (int end = 0; end < 2; ++end) {
                double at[3];
                at[axis] = place[p];
                at[2 - axis] = end ? slice->high[2 - axis] : slice->low[2 - axis];
                print_end(&lines, at[0], at[2], k);
            }
            fputs("\n", script);
        }
    }
    cut_meshes(slice, print_cut, &lines);
    fputs("NaN NaN NaN\nEND\n", script); /* gnuplot takes a block without a line as an error */
}

static void print_circles(FILE *script, const struct plot_slice *slice, const double *value,
                          const unsigned char *wanted) {
    const struct bed *bed = slice->bed;
    fputs("$slice << END\n", script);
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double off = fabs(bed->y[i] - slice->y);
        if (off >= bed->r[i] || (wanted && !wanted[i])) continue;
        fprintf(script, "%.6g %.6g %.6g %.6g\n", bed->x[i] / slice->scale, bed->z[i] / slice->scale,
                sqrt(bed->r[i] * bed->r[i] - off * off) / slice->scale, value[i]);
    }
    fputs("NaN NaN NaN NaN\nEND\n", script);
}

void plot_slice_draw(FILE *script, const struct plot_slice *slice, const double *value, const unsigned char *wanted,
                     const double *wall_value) {
    const double *low = slice->low, *high = slice->high, scale = slice->scale;
    const char *begin = slice->unit[0] ? " [" : "", *end = slice->unit[0] ? "]" : "";
    print_circles(script, slice, value, wanted);
    print_walls(script, slice, wall_value);
    fprintf(script,
            "set xlabel 'x%s%s%s'; set ylabel 'z%s%s%s'; set xtics auto; set ytics auto\n"
            "set size ratio -1; set xrange [%.9g:%.9g]; set yrange [%.9g:%.9g]\n"
            "set colorbox; unset key; unset grid\n"
            "plot $slice using 1:2:3:4 with circles fillcolor palette fillstyle solid noborder, $walls using 1:2%s\n"
            "set size noratio; set size nosquare; unset cblabel\n",
            begin, slice->unit, end, begin, slice->unit, end, low[0] / scale, high[0] / scale, low[2] / scale,
            high[2] / scale, wall_value ? ":3 with lines lw 7 lc palette" : " with lines lw 7 lc '#8c8c8c'");
}
