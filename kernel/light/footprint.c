/* footprint.c - the cross-section of light by where it enters and where it would end. SPDX-License-Identifier: MIT
 *
 * A line towards the light meets at most one plane for each axis. These planes, and which of them is met first, tell
 * whether light comes along the line. Which of two planes is met first depends on the side of a straight line in u and
 * v. So the cross-section of the light that enters by one plane has straight sides. The same holds for light that ends
 * on one plane. */
#include "light/light.h"
#include "base/elementary.h"
#include "base/vector.h"
#include "sample/direction.h"
#include "scene/walls.h"

#define NO_FACE 3u

/* The widest cone [rad] for which FIBRAD_LIGHT_DIRECTIONS_DEFAULT directions do. A wider cone has as many for each
 * solid angle. */
#define NARROW .02

/* The planes that lines meet in one direction: the axes across which they lie, and their places [L]. */
typedef struct ways_out {
    uint32_t count, axis[3];
    double at[3];
} ways_out;

/* The axes across a light, and the direction towards it. */
static void middle_frame(const fibrad_light *light, double frame[9]) {
    double d[3], size = 0;
    for (int a = 0; a < 3; a++) size = fibrad_max(size, fibrad_abs(light->direction[a]));
    for (int a = 0; a < 3; a++) d[a] = light->direction[a] / size;
    const double length = fibrad_sqrt(fibrad_dot(d, d));
    for (int a = 0; a < 3; a++) frame[6 + a] = 0 - d[a] / length;
    fibrad_frame_about(frame + 6, frame, frame + 3);
}

uint32_t fibrad_light_count(const fibrad_light *light) {
    if (!(light->half_angle > 0)) return 1;
    if (light->directions > 0) return light->directions;
    const double wide = fibrad_max(1, light->half_angle / NARROW);
    return (uint32_t)fibrad_min(FIBRAD_LIGHT_DIRECTIONS_DEFAULT * wide * wide, FIBRAD_LIGHT_DIRECTIONS_MAX);
}

/* Direction k of a cone: the disc of its sines is filled evenly, as a sunflower is. So equal parts of what a plane
 * across the axis of the cone receives come from each. Returns the flux across the direction. */
static double light_frame(const fibrad_light *light, uint32_t k, double frame[9]) {
    const uint32_t n = fibrad_light_count(light);
    double middle[9], cosine, sine;
    middle_frame(light, frame);
    if (n == 1) return light->flux;
    fibrad_copy(middle, frame, sizeof middle);
    double s, c;
    fibrad_sincos_turn(light->half_angle / (2 * FIBRAD_PI), &s, &c);
    const double ring = s * fibrad_sqrt((k + .5) / n), up = fibrad_sqrt(1 - ring * ring);
    fibrad_azimuth(k, &cosine, &sine);
    for (int a = 0; a < 3; a++) frame[6 + a] = up * middle[6 + a] + ring * (cosine * middle[a] + sine * middle[3 + a]);
    fibrad_frame_about(frame + 6, frame, frame + 3);
    return light->flux / (n * up);
}

static bool is_within(double x, double low, double high) { return x >= low && x <= high; }

uint32_t fibrad_light_obstacle(const fibrad_scene *scene, const fibrad_light *light) {
    double frame[9];
    uint32_t first = FIBRAD_NONE;
    middle_frame(light, frame);
    for (uint32_t place = 0; place < scene->facts.spheres; place++) {
        const double to[3] = {scene->x[place] - light->centre[0], scene->y[place] - light->centre[1],
                              scene->z[place] - light->centre[2]};
        const double depth = fibrad_dot(to, frame + 6), reach = light->radius + scene->r[place];
        const double aside = fibrad_dot(to, to) - depth * depth;
        if (depth + scene->r[place] * (1 - 1e-9) > 0 && aside < reach * reach && scene->order[place] < first)
            first = scene->order[place];
    }
    return first;
}

/* Whether a beam is not wider than the periods along which it is repeated. */
static bool fits_periods(const fibrad_scene *scene, const fibrad_light *light) {
    bool fits = true;
    for (int a = 0; a < 3; a++) {
        const double wide = light->shape == FIBRAD_LIGHT_DISC           ? 2 * light->radius
                            : light->shape == FIBRAD_LIGHT_BOX && a < 2 ? light->high[a] - light->low[a]
                                                                        : 0;
        fits = fits && (scene->period[a] == 0 || wide <= scene->period[a]);
    }
    return fits;
}

int fibrad_light_why(const fibrad_scene *scene, const fibrad_light *light) {
    double size = 0;
    bool valid = is_within(light->flux, 0, FIBRAD_POWER_MAX) &&
                 is_within(light->half_angle, 0, FIBRAD_HALF_ANGLE_MAX) &&
                 light->directions <= FIBRAD_LIGHT_DIRECTIONS_MAX && is_within(light->shape, 0, FIBRAD_LIGHT_BOX);
    for (int a = 0; a < 3; a++) {
        valid = valid && fibrad_finite(light->direction[a]);
        size = fibrad_max(size, fibrad_abs(light->direction[a]));
    }
    if (light->shape == FIBRAD_LIGHT_DISC) {
        valid = valid && light->radius > 0 && light->radius <= FIBRAD_LENGTH_MAX;
        for (int a = 0; a < 3; a++) valid = valid && fibrad_abs(light->centre[a]) <= FIBRAD_LENGTH_MAX;
    }
    if (light->shape == FIBRAD_LIGHT_BOX) {
        valid = valid && light->direction[2] != 0;
        for (int a = 0; a < 2; a++)
            valid = valid && light->low[a] < light->high[a] && fibrad_abs(light->low[a]) <= FIBRAD_LENGTH_MAX &&
                    fibrad_abs(light->high[a]) <= FIBRAD_LENGTH_MAX;
    }
    return valid && size > 0 && fits_periods(scene, light) ? FIBRAD_WHY_UNSAID : FIBRAD_WHY_LIGHT;
}

/* The box about the bed: walls, periods, or else the centres with the largest radius, and the triangles. */
static void find_box(fibrad_footprint *f, const fibrad_scene *scene) {
    const fibrad_container *c = &scene->container;
    const double r = scene->facts.radius_max;
    for (int a = 0; a < 3; a++) {
        f->low[a] = scene->period[a] > 0 ? scene->low[a] : fibrad_finite(c->low[a]) ? c->low[a] : scene->low[a] - r;
        f->high[a] = scene->period[a] > 0        ? scene->low[a] + scene->period[a]
                     : fibrad_finite(c->high[a]) ? c->high[a]
                                                 : scene->high[a] + r;
        if (scene->mesh.triangles > 0 && !(scene->period[a] > 0)) {
            if (!fibrad_finite(c->low[a])) f->low[a] = fibrad_min(f->low[a], scene->mesh.low[a]);
            if (!fibrad_finite(c->high[a])) f->high[a] = fibrad_max(f->high[a], scene->mesh.high[a]);
        }
    }
    for (uint32_t k = 0; k < 2 && fibrad_finite(c->radius); k++) {
        const uint32_t a = fibrad_cylinder_axis(c->turn, k);
        f->low[a] = c->axis[k] - c->radius, f->high[a] = c->axis[k] + c->radius;
    }
    for (int a = 0; a < 3; a++) f->origin[a] = f->low[a] + .5 * (f->high[a] - f->low[a]);
}

double fibrad_footprint_area(const fibrad_footprint *f) {
    double sum = 0;
    for (uint32_t p = 0; p < f->pieces; p++) sum += f->piece[p].sign * f->piece[p].area;
    return sum;
}

void fibrad_footprint_place(const fibrad_footprint *f, const double at[3], double uv[2]) {
    const double to[3] = {at[0] - f->origin[0], at[1] - f->origin[1], at[2] - f->origin[2]};
    uv[0] = fibrad_dot(to, f->frame), uv[1] = fibrad_dot(to, f->frame + 3);
}

static void add_corner(fibrad_light_polygon *p, double u, double v) {
    p->at[p->corners][0] = u, p->at[p->corners][1] = v;
    p->corners++;
}

static void add_place(const fibrad_footprint *f, const double at[3], fibrad_light_polygon *p) {
    double uv[2];
    fibrad_footprint_place(f, at, uv);
    add_corner(p, uv[0], uv[1]);
}

/* Reverses the corners of a polygon if they run clockwise. */
static void turn_polygon(fibrad_light_polygon *p) {
    if (fibrad_light_area(p->at, p->corners) >= 0) return;
    for (uint32_t k = 0; 2 * k + 1 < p->corners; k++)
        for (int a = 0; a < 2; a++) {
            const double moving = p->at[k][a];
            p->at[k][a] = p->at[p->corners - 1 - k][a], p->at[p->corners - 1 - k][a] = moving;
        }
}

/* A disc with two axes in its plane, as a polygon of the same area. */
static void add_disc(const fibrad_footprint *f, const double centre[3], double radius, const double x[3],
                     const double y[3], fibrad_light_polygon *p) {
    double sine, cosine, at[3];
    fibrad_sincos_turn(1. / FIBRAD_LIGHT_SIDES, &sine, &cosine);
    radius *= fibrad_sqrt(2 * FIBRAD_PI / FIBRAD_LIGHT_SIDES / sine);
    for (uint32_t k = 0; k < FIBRAD_LIGHT_SIDES; k++) {
        fibrad_sincos_turn((k + .5) / FIBRAD_LIGHT_SIDES, &sine, &cosine);
        for (int a = 0; a < 3; a++) at[a] = centre[a] + radius * (cosine * x[a] + sine * y[a]);
        add_place(f, at, p);
    }
    turn_polygon(p);
}

/* Whether light is slanted against the axis of the cylinder, if there is one. */
static bool is_slanted(const fibrad_footprint *f, const fibrad_container *c) {
    const double *w = f->frame + 6;
    return fibrad_finite(c->radius) &&
           !(w[fibrad_cylinder_axis(c->turn, 0)] == 0 && w[fibrad_cylinder_axis(c->turn, 1)] == 0);
}

/* The cylinder's circle at some height. */
static void add_circle(const fibrad_footprint *f, const fibrad_container *c, double height, fibrad_light_polygon *p) {
    double centre[3], x[3] = {0, 0, 0}, y[3] = {0, 0, 0};
    fibrad_wall_about(c, 0, 0, centre);
    centre[fibrad_cylinder_axis(c->turn, 2)] = height;
    x[fibrad_cylinder_axis(c->turn, 0)] = y[fibrad_cylinder_axis(c->turn, 1)] = 1;
    p->corners = 0;
    add_disc(f, centre, c->radius, x, y, p);
}

/* The circle of the end of the cylinder by which light enters. */
static void add_end(const fibrad_footprint *f, const fibrad_container *c, fibrad_light_polygon *p) {
    const uint32_t axis = fibrad_cylinder_axis(c->turn, 2);
    add_circle(f, c, f->frame[6 + axis] > 0 ? f->high[axis] : f->low[axis], p);
}

/* The outline of the box as seen along the light, which is convex. Of the two faces across each axis one is lit. The
 * corners of the outline follow from edges along the axes. These are taken in the order of their directions across the
 * light, which turn by half a turn in all. */
static void add_outline(const fibrad_footprint *f, fibrad_light_polygon *p) {
    double edge[3][2], at[3];
    int order[3] = {0, 1, 2};
    for (int a = 0; a < 3; a++) {
        const double size = f->high[a] - f->low[a], u = size * f->frame[a], v = size * f->frame[3 + a];
        const double sign = v < 0 || (v == 0 && u < 0) ? -1 : 1;
        edge[a][0] = sign * u, edge[a][1] = sign * v;
        at[a] = sign > 0 ? f->low[a] : f->high[a];
    }
    for (int k = 0; k < 2; k++) /* by the angle of the edge, 0 to half a turn */
        for (int n = 0; n < 2; n++) {
            const double *e = edge[order[n]], *g = edge[order[n + 1]];
            const int moving = order[n];
            const bool none = e[0] == 0 && e[1] == 0; /* an axis along the light */
            if (none || e[0] * g[1] - e[1] * g[0] < 0) order[n] = order[n + 1], order[n + 1] = moving;
        }
    add_place(f, at, p);
    for (int k = 0; k < 5; k++) {
        const double *last = p->at[p->corners - 1], *e = edge[order[k % 3]], sign = k < 3 ? 1 : -1;
        add_corner(p, last[0] + sign * e[0], last[1] + sign * e[1]);
    }
}

/* One period of the strip that is the cross-section of a bed periodic along one axis. */
static void add_strip(const fibrad_footprint *f, int axis, fibrad_light_polygon *p) {
    const double size = f->high[axis] - f->low[axis], along[2] = {size * f->frame[axis], size * f->frame[3 + axis]};
    const double length = fibrad_sqrt(along[0] * along[0] + along[1] * along[1]);
    const double unit[2] = {along[0] / length, along[1] / length};
    double half = 0; /* of the width */
    for (int a = 0; a < 3; a++)
        if (a != axis)
            half += .5 * (f->high[a] - f->low[a]) * fibrad_abs(unit[0] * f->frame[3 + a] - unit[1] * f->frame[a]);
    for (int k = 0; k < 4; k++) {
        const double t = k == 0 || k == 3 ? -.5 : .5, s = k < 2 ? -half : half;
        add_corner(p, t * along[0] - s * unit[1], t * along[1] + s * unit[0]);
    }
}

/* One cell of a bed that is periodic along two axes. */
static void add_cell(const fibrad_footprint *f, const int axis[2], fibrad_light_polygon *p) {
    double edge[2][2];
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < 2; c++) edge[k][c] = (f->high[axis[k]] - f->low[axis[k]]) * f->frame[3 * c + axis[k]];
    for (int k = 0; k < 4; k++) {
        const double s = k == 1 || k == 2 ? .5 : -.5, t = k < 2 ? -.5 : .5;
        add_corner(p, s * edge[0][0] + t * edge[1][0], s * edge[0][1] + t * edge[1][1]);
    }
    turn_polygon(p);
}

/* The rectangle of a beam, at the end of the bed in z. */
static void add_rectangle(const fibrad_footprint *f, const fibrad_light *light, fibrad_light_polygon *p) {
    const double z = f->frame[8] > 0 ? f->high[2] : f->low[2];
    for (int k = 0; k < 4; k++) {
        const double at[3] = {k == 1 || k == 2 ? light->high[0] : light->low[0], k < 2 ? light->low[1] : light->high[1],
                              z};
        add_place(f, at, p);
    }
    turn_polygon(p);
}

/* The planes that lines along the light meet: on the way towards the light if sense is 1, on the way from it if sense
 * is -1. */
static ways_out planes_met(const fibrad_footprint *f, const fibrad_scene *scene, double sense) {
    ways_out out = {0, {0}, {0}};
    for (uint32_t a = 0; a < 3; a++) {
        const double w = sense * f->frame[6 + a], at = w > 0 ? scene->container.high[a] : scene->container.low[a];
        if (scene->period[a] > 0 || w == 0 || !fibrad_finite(at)) continue;
        out.axis[out.count] = a, out.at[out.count++] = at;
    }
    return out;
}

static uint32_t slot_facing(const fibrad_footprint *f, uint32_t axis, double sense) {
    return fibrad_face(axis, sense * f->frame[6 + axis] > 0);
}

/* The line u, v meets a plane at the depth depth[0] u + depth[1] v + depth[2] towards the light. */
static void depth_at_plane(const fibrad_footprint *f, uint32_t axis, double at, double depth[3]) {
    const double w = f->frame[6 + axis];
    depth[0] = 0 - f->frame[axis] / w, depth[1] = 0 - f->frame[3 + axis] / w, depth[2] = (at - f->origin[axis]) / w;
}

/* The lines that bound where plane k is the first of the planes that are met. */
static uint32_t add_first(const fibrad_footprint *f, const ways_out *out, uint32_t k, double sense,
                          fibrad_light_line *line) {
    double own[3], other[3];
    uint32_t count = 0;
    depth_at_plane(f, out->axis[k], out->at[k], own);
    for (uint32_t m = 0; m < out->count; m++) {
        if (m == k) continue;
        depth_at_plane(f, out->axis[m], out->at[m], other);
        const double n[2] = {sense * (own[0] - other[0]), sense * (own[1] - other[1])};
        const double size = fibrad_sqrt(n[0] * n[0] + n[1] * n[1]);
        line[count++] = (fibrad_light_line){{n[0] / size, n[1] / size}, sense * (other[2] - own[2]) / size};
    }
    return count;
}

/* The sides of a polygon as lines. */
static uint32_t lines_of(const fibrad_light_polygon *p, fibrad_light_line *line) {
    uint32_t count = 0;
    for (uint32_t k = 0; k < p->corners; k++)
        count += fibrad_light_line_through(p->at[k], p->at[(k + 1) % p->corners], &line[count]);
    return count;
}

/* Cuts off the part of a polygon that lies outside a line. */
static void cut_polygon(fibrad_light_polygon *p, const fibrad_light_line *line, fibrad_light_polygon *scratch) {
    scratch->corners = 0;
    for (uint32_t k = 0; k < p->corners; k++) {
        const double *a = p->at[k], *b = p->at[(k + 1) % p->corners];
        const double fa = fibrad_light_beyond(line, a), fb = fibrad_light_beyond(line, b);
        if (fa <= 0) add_corner(scratch, a[0], a[1]);
        if ((fa <= 0) == (fb <= 0)) continue;
        const double t = fa / (fa - fb);
        add_corner(scratch, a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]));
    }
    fibrad_copy(p->at, scratch->at, scratch->corners * sizeof *p->at);
    p->corners = scratch->corners;
}

/* Finds the polygon of all light. Its sides become lines of all pieces, except sides between one period and the
 * next. */
static void find_outline(fibrad_footprint *f, const fibrad_scene *scene, const fibrad_light *light) {
    const fibrad_container *c = &scene->container;
    const bool round = fibrad_finite(c->radius);
    int periodic[3], periods = 0;
    for (int a = 0; a < 3; a++)
        if (scene->period[a] > 0) periodic[periods++] = a;
    f->start.corners = f->common = f->images = 0;
    if (light->shape == FIBRAD_LIGHT_DISC) {
        double middle[9];
        middle_frame(light, middle);
        add_disc(f, light->centre, light->radius, middle, middle + 3, &f->start);
    } else if (light->shape == FIBRAD_LIGHT_BOX) {
        add_rectangle(f, light, &f->start);
    } else if (round) {
        add_end(f, c, &f->start);
        if (!is_slanted(f, c)) return; /* no line of light cuts the cylinder */
    } else if (periods == 0) {
        add_outline(f, &f->start);
    } else if (periods == 1) {
        add_strip(f, periodic[0], &f->start);
        f->common = lines_of(&f->start, f->line);
        f->line[1] = f->line[2], f->common = 2; /* the sides along the period */
        return;
    } else {
        add_cell(f, periodic, &f->start);
        return;
    }
    f->common = lines_of(&f->start, f->line);
    if (light->shape == FIBRAD_LIGHT_ALL) return;
    for (int k = 0; k < periods; k++, f->images++)
        for (int n = 0; n < 2; n++) f->image[k][n] = scene->period[periodic[k]] * f->frame[3 * n + periodic[k]];
}

/* Adds lines that bound a beam besides its own sides: walls along the light, and the end of the cylinder by which the
 * light enters. */
static void bound_beam(fibrad_footprint *f, const fibrad_scene *scene) {
    const fibrad_container *c = &scene->container;
    for (int a = 0; a < 3; a++)
        for (int high = 0; high < 2 && f->frame[6 + a] == 0; high++) {
            const double at = high ? c->high[a] : c->low[a], sign = high ? 1 : -1;
            if (!fibrad_finite(at)) continue;
            f->line[f->common++] =
                (fibrad_light_line){{sign * f->frame[a], sign * f->frame[3 + a]}, sign * (at - f->origin[a])};
        }
    if (!fibrad_finite(c->radius)) return;
    add_end(f, c, &f->polygon);
    f->common += lines_of(&f->polygon, f->line + f->common);
}

/* Appends a piece that has its own lines, unless nothing is left of it. */
static void add_piece(fibrad_footprint *f, const fibrad_light_piece *piece) {
    fibrad_light_polygon *p = &f->polygon;
    fibrad_copy(p->at, f->start.at, f->start.corners * sizeof *p->at);
    p->corners = f->start.corners;
    for (uint32_t k = 0; k < f->common + (piece->far ? f->far : 0); k++) cut_polygon(p, &f->line[k], &f->clipped);
    for (uint32_t k = 0; k < piece->lines; k++) cut_polygon(p, &piece->line[k], &f->clipped);
    const double area = fibrad_light_area(p->at, p->corners);
    if (!(area > 0)) return;
    f->piece[f->pieces] = *piece;
    f->piece[f->pieces++].area = area;
}

/* Appends the pieces of light that enters in one way, by where it would end. */
static void add_ends(fibrad_footprint *f, const fibrad_scene *scene, const fibrad_light_piece *entry) {
    const fibrad_container *c = &scene->container;
    const ways_out out = planes_met(f, scene, -1);
    const bool round = is_slanted(f, c);
    fibrad_light_piece piece = *entry;
    piece.slot = round ? FIBRAD_CYLINDER : FIBRAD_ESCAPED;
    if (out.count == 0 || round) add_piece(f, &piece);
    for (uint32_t k = 0; k < out.count; k++) {
        piece = *entry;
        piece.lines += add_first(f, &out, k, -1, piece.line + piece.lines);
        piece.slot = slot_facing(f, out.axis[k], -1);
        if (fibrad_is_opening(c, piece.slot)) piece.slot = FIBRAD_ESCAPED;
        piece.far = round;
        add_piece(f, &piece);
        if (!round) continue;
        piece.slot = FIBRAD_CYLINDER, piece.sign = -1;
        add_piece(f, &piece);
    }
}

static void find_bounds(fibrad_footprint *f) {
    for (int n = 0; n < 2; n++) {
        f->bound_low[n] = f->bound_high[n] = f->start.at[0][n];
        for (uint32_t k = 1; k < f->start.corners; k++) {
            f->bound_low[n] = fibrad_min(f->bound_low[n], f->start.at[k][n]);
            f->bound_high[n] = fibrad_max(f->bound_high[n], f->start.at[k][n]);
        }
    }
}

void fibrad_footprint_make(fibrad_footprint *f, const fibrad_scene *scene, const fibrad_light *light, uint32_t k) {
    const fibrad_container *c = &scene->container;
    f->flux = light_frame(light, k, f->frame);
    f->pieces = f->far = 0;
    f->start.corners = 0;
    fibrad_zero(f->image, sizeof f->image);
    if (scene->period[0] > 0 && scene->period[1] > 0 && scene->period[2] > 0) return;
    find_box(f, scene);
    find_outline(f, scene, light);
    find_bounds(f);
    if (light->shape != FIBRAD_LIGHT_ALL) bound_beam(f, scene);
    const bool slanted = is_slanted(f, c);
    const ways_out in = planes_met(f, scene, 1), out = planes_met(f, scene, -1);
    if (slanted && out.count > 0) {
        add_circle(f, c, out.at[0], &f->polygon);
        f->far = lines_of(&f->polygon, f->line + f->common);
    }
    const fibrad_light_piece anywhere = {.sign = 1, .face = NO_FACE};
    if (in.count == 0 && !slanted) add_ends(f, scene, &anywhere);
    for (uint32_t m = 0; m < in.count; m++) {
        fibrad_light_piece entry = {.sign = 1, .face = in.axis[m], .from = in.at[m]};
        if (!fibrad_is_opening(c, slot_facing(f, in.axis[m], 1))) continue;
        entry.lines = add_first(f, &in, m, 1, entry.line);
        add_ends(f, scene, &entry);
    }
}

/* How many whole periods a place is from the middle of the beam. */
static void periods_from_beam(const fibrad_footprint *f, const double uv[2], double periods[2]) {
    const double *a = f->image[0], *b = f->image[1];
    const double x = uv[0] - .5 * (f->bound_low[0] + f->bound_high[0]),
                 y = uv[1] - .5 * (f->bound_low[1] + f->bound_high[1]);
    periods[0] = periods[1] = 0;
    if (f->images == 1) {
        periods[0] = fibrad_floor((x * a[0] + y * a[1]) / (a[0] * a[0] + a[1] * a[1]) + .5);
    } else if (f->images == 2) {
        const double all = a[0] * b[1] - a[1] * b[0];
        periods[0] = fibrad_floor((x * b[1] - y * b[0]) / all + .5);
        periods[1] = fibrad_floor((y * a[0] - x * a[1]) / all + .5);
    }
}

bool fibrad_footprint_image(const fibrad_footprint *f, const double uv[2], uint32_t image, double at[2]) {
    double periods[2];
    if (image >= (f->images == 2 ? 9u : f->images == 1 ? 3u : 1u)) return false;
    periods_from_beam(f, uv, periods);
    if (f->images > 0) periods[0] += (double)(image % 3) - 1;
    if (f->images > 1) periods[1] += (double)(image / 3) - 1;
    for (int n = 0; n < 2; n++) at[n] = uv[n] - (periods[0] * f->image[0][n] + periods[1] * f->image[1][n]);
    return true;
}

/* Whether all lines of a piece have a place on their inner side. */
static bool piece_holds(const fibrad_footprint *f, const fibrad_light_piece *piece, const double uv[2]) {
    bool inside = true;
    for (uint32_t k = 0; k < piece->lines && inside; k++)
        inside = piece->line[k].n[0] * uv[0] + piece->line[k].n[1] * uv[1] <= piece->line[k].c;
    for (uint32_t k = 0; k < f->common + (piece->far ? f->far : 0) && inside; k++)
        inside = f->line[k].n[0] * uv[0] + f->line[k].n[1] * uv[1] <= f->line[k].c;
    return inside;
}

bool fibrad_footprint_lights(const fibrad_footprint *f, const double uv[2], uint32_t *piece) {
    double at[2];
    for (uint32_t image = 0; fibrad_footprint_image(f, uv, image, at); image++)
        for (uint32_t k = 0; k < f->pieces; k++) {
            if (f->piece[k].sign < 0 || !piece_holds(f, &f->piece[k], at)) continue;
            if (piece != NULL) *piece = k;
            return true;
        }
    return false;
}

void fibrad_footprint_enters(const fibrad_footprint *f, uint32_t piece, const double uv[2], double at[3]) {
    double depth = 0, plane[3];
    if (f->piece[piece].face == NO_FACE) {
        for (int a = 0; a < 3; a++) depth += (f->high[a] - f->low[a]) * fibrad_abs(f->frame[6 + a]);
    } else {
        depth_at_plane(f, f->piece[piece].face, f->piece[piece].from, plane);
        depth = plane[0] * uv[0] + plane[1] * uv[1] + plane[2];
    }
    for (int a = 0; a < 3; a++)
        at[a] = f->origin[a] + uv[0] * f->frame[a] + uv[1] * f->frame[3 + a] + depth * f->frame[6 + a];
}
