/* unshadowed.c - the part of a window that no triangle hides from the light. SPDX-License-Identifier: MIT */
#include "light/light.h"
#include "base/vector.h"

#define NEXT  1e-12 /* a place is next to a line */
#define TINY  1e-13 /* shorter sides and smaller areas are rounding errors */
#define SHORT 1e-12 /* a side of a face that is shorter than this part of its distance is a rounding error */
#define SHARP 6u    /* corners of a triangle within the planes, at the most */
#define MANY  (FIBRAD_UNSHADOWED_SIDES - SHARP - 1)

/* The visible part of a triangle in the frame of a window. */
typedef struct clipped_face {
    uint32_t corners;
    double at[SHARP][3];
} clipped_face;

/* Cuts off what lies beyond a plane: n.x > c. */
static void clip_face(clipped_face *face, const double n[3], double c) {
    const clipped_face all = *face;
    face->corners = 0;
    for (uint32_t k = 0; k < all.corners; k++) {
        const double *a = all.at[k], *b = all.at[(k + 1) % all.corners];
        const double fa = fibrad_dot(n, a) - c, fb = fibrad_dot(n, b) - c;
        if (fa <= 0 && face->corners < SHARP) fibrad_copy(face->at[face->corners++], a, sizeof all.at[0]);
        if ((fa <= 0) == (fb <= 0) || face->corners == SHARP) continue;
        for (int axis = 0; axis < 3; axis++)
            face->at[face->corners][axis] = a[axis] + fa / (fa - fb) * (b[axis] - a[axis]);
        face->corners++;
    }
}

/* The part of a face that lies within the planes through which the light may come. */
static clipped_face face_inside(const fibrad_workspace *space, const double frame[9], uint32_t number) {
    const fibrad_container *c = &space->scene->container;
    clipped_face face = {.corners = 3};
    for (uint32_t k = 0; k < 3; k++)
        for (int axis = 0; axis < 3; axis++) face.at[k][axis] = space->met->faces.corner[k][axis][number];
    for (int axis = 0; axis < 3; axis++) {
        const double sign = frame[6 + axis] > 0 ? 1 : -1, at = sign > 0 ? c->high[axis] : c->low[axis];
        const double n[3] = {sign * frame[axis], sign * frame[3 + axis], sign * frame[6 + axis]};
        if (frame[6 + axis] == 0 || space->scene->period[axis] > 0 || !fibrad_finite(at)) continue;
        clip_face(&face, n, sign * (at - space->centre[axis]) * space->inverse);
    }
    return face;
}

/* Whether the middle of the window lies on a face. */
static bool holds_middle(const clipped_face *face) {
    bool inside = true;
    for (uint32_t k = 0; k < face->corners; k++) {
        const double *a = face->at[k], *b = face->at[(k + 1) % face->corners];
        inside = inside && a[0] * b[1] - a[1] * b[0] >= 0;
    }
    return inside;
}

/* The place of the edges of a face that is nearest to the middle of the window. */
static void nearest_place(const clipped_face *face, double nearest[3]) {
    double least = __builtin_inf();
    for (uint32_t k = 0; k < face->corners; k++) {
        const double *a = face->at[k], *b = face->at[(k + 1) % face->corners];
        const double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, square = d[0] * d[0] + d[1] * d[1];
        const double t = square > 0 ? fibrad_max(0, fibrad_min(1, 0 - (a[0] * d[0] + a[1] * d[1]) / square)) : 0;
        const double at[3] = {a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]};
        if (!(at[0] * at[0] + at[1] * at[1] < least)) continue;
        least = at[0] * at[0] + at[1] * at[1];
        fibrad_copy(nearest, at, sizeof at);
    }
}

/* Whether a face comes before the sphere. If a face and a sphere do not cut each other, one of them comes first
 * wherever both are seen. So one place decides. Of a sphere that a triangle cuts, the side of the centre decides. */
static bool is_before(const fibrad_workspace *space, const clipped_face *face, uint32_t number) {
    double at[3] = {0, 0, space->met->faces.plane[2][number]};
    if (!holds_middle(face)) nearest_place(face, at);
    return at[0] * at[0] + at[1] * at[1] < 1 && at[2] > 0;
}

static uint32_t lines_of_face(const clipped_face *face, fibrad_light_line line[SHARP]) {
    uint32_t count = 0;
    for (uint32_t k = 0; k < face->corners; k++) {
        const double *a = face->at[k], *b = face->at[(k + 1) % face->corners];
        const double length = fibrad_abs(b[0] - a[0]) + fibrad_abs(b[1] - a[1]);
        if (length > SHORT * (1 + fibrad_abs(a[0]) + fibrad_abs(a[1])))
            count += fibrad_light_line_through(a, b, &line[count]);
    }
    return count;
}

/* Appends a side. If the side before it is too short, the new side takes its place. */
static void add_side(fibrad_unshadowed_polygon *p, double u, double v, const fibrad_light_line *line) {
    const double *last = p->corner[p->sides > 0 ? p->sides - 1 : 0];
    if (p->sides > 0 && fibrad_abs(u - last[0]) + fibrad_abs(v - last[1]) < TINY) p->sides--;
    p->corner[p->sides][0] = u, p->corner[p->sides][1] = v;
    p->line[p->sides++] = *line;
}

/* Cuts off the part of a polygon that lies beyond a line. Corners next to the line count as inside. So a polygon gets
 * no second side along a side that it has. */
static void cut_sides(fibrad_unshadowed_polygon *p, const fibrad_light_line *line) {
    const fibrad_unshadowed_polygon all = *p;
    p->sides = 0;
    for (uint32_t k = 0; k < all.sides; k++) {
        const double *a = all.corner[k], *b = all.corner[(k + 1) % all.sides];
        const double fa = fibrad_light_beyond(line, a), fb = fibrad_light_beyond(line, b), t = fa / (fa - fb);
        if (fa <= NEXT) add_side(p, a[0], a[1], &all.line[k]);
        if ((fa <= NEXT) != (fb <= NEXT))
            add_side(p, a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), fa <= NEXT ? line : &all.line[k]);
    }
    if (p->sides > 0) {
        const double *first = p->corner[0], *last = p->corner[p->sides - 1];
        p->sides -= fibrad_abs(first[0] - last[0]) + fibrad_abs(first[1] - last[1]) < TINY;
    }
}

static bool is_empty(fibrad_unshadowed_polygon *p) { return fibrad_light_area(p->corner, p->sides) < TINY; }

static fibrad_light_line turned(const fibrad_light_line *line) {
    return (fibrad_light_line){{0 - line->n[0], 0 - line->n[1]}, 0 - line->c};
}

/* Divides a polygon that has many sides. False: there is no room. */
static bool divide_polygon(fibrad_unshadowed *unshadowed, uint32_t number) {
    fibrad_unshadowed_polygon *p = &unshadowed->polygon[number];
    fibrad_light_line line;
    if (p->sides <= MANY || !fibrad_light_line_through(p->corner[0], p->corner[p->sides / 2], &line)) return true;
    if (unshadowed->count == unshadowed->room) return false;
    fibrad_unshadowed_polygon *other = &unshadowed->polygon[unshadowed->count++];
    *other = *p;
    cut_sides(p, &line);
    line = turned(&line);
    cut_sides(other, &line);
    return true;
}

/* Whether a polygon lies beyond one of some lines. */
static bool lies_beyond(const fibrad_unshadowed_polygon *p, const fibrad_light_line *line, uint32_t lines) {
    bool beyond = false;
    for (uint32_t k = 0; k < lines && !beyond; k++) {
        beyond = true;
        for (uint32_t s = 0; s < p->sides && beyond; s++) beyond = fibrad_light_beyond(&line[k], p->corner[s]) >= 0;
    }
    return beyond;
}

/* Takes the inside of some lines away from a polygon. What is outside of the first line is a polygon. So is what is
 * inside of the first line and outside of the second one, and so on. False: there is no room. */
static bool hide_in_polygon(fibrad_unshadowed *unshadowed, uint32_t number, const fibrad_light_line *line,
                            uint32_t lines) {
    if (lies_beyond(&unshadowed->polygon[number], line, lines)) return true;
    if (!divide_polygon(unshadowed, number)) return false;
    const uint32_t before = unshadowed->count;
    fibrad_unshadowed_polygon inside = unshadowed->polygon[number];
    for (uint32_t k = 0; k < lines; k++) {
        const fibrad_light_line other = turned(&line[k]);
        fibrad_unshadowed_polygon outside = inside;
        cut_sides(&outside, &other);
        cut_sides(&inside, &line[k]);
        if (is_empty(&inside)) { /* the polygon stays whole */
            unshadowed->count = before;
            return true;
        }
        if (is_empty(&outside)) continue;
        if (unshadowed->count == unshadowed->room) return false;
        unshadowed->polygon[unshadowed->count++] = outside;
    }
    unshadowed->count--;
    if (number < unshadowed->count) unshadowed->polygon[number] = unshadowed->polygon[unshadowed->count];
    return true;
}

int fibrad_unshadowed_missed(fibrad_workspace *space, const fibrad_unshadowed *unshadowed) {
    space->needed.extra =
        space->plan.extra + (unshadowed->room + FIBRAD_UNSHADOWED_FIRST) * sizeof *unshadowed->polygon;
    return FIBRAD_E_WORK;
}

static void begin_with_square(fibrad_unshadowed *unshadowed) {
    fibrad_unshadowed_polygon *square = &unshadowed->polygon[0];
    fibrad_zero(square, sizeof *square);
    square->sides = 4, unshadowed->count = 1, unshadowed->whole = false;
    for (uint32_t k = 0; k < 4; k++)
        square->corner[k][0] = k == 1 || k == 2 ? 1 : -1, square->corner[k][1] = k < 2 ? -1 : 1;
}

bool fibrad_unshadowed_hide(fibrad_unshadowed *unshadowed, const fibrad_workspace *space, const double frame[9],
                            uint32_t face) {
    const clipped_face seen = face_inside(space, frame, face);
    fibrad_light_line line[SHARP];
    if (seen.corners < 3 || !is_before(space, &seen, face)) return true;
    const uint32_t lines = lines_of_face(&seen, line);
    if (unshadowed->whole) begin_with_square(unshadowed);
    for (uint32_t k = unshadowed->count; k-- > 0;)
        if (!hide_in_polygon(unshadowed, k, line, lines)) return false;
    return true;
}

bool fibrad_unshadowed_holds(const fibrad_unshadowed *unshadowed, const double at[2]) {
    bool found = unshadowed->whole;
    for (uint32_t k = 0; k < unshadowed->count && !found && !unshadowed->whole; k++) {
        const fibrad_unshadowed_polygon *p = &unshadowed->polygon[k];
        found = true;
        for (uint32_t s = 0; s < p->sides && found; s++) found = fibrad_light_beyond(&p->line[s], at) <= 0;
    }
    return found;
}
