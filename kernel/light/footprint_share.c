/* footprint_share.c - what of the open region of a window lies in a piece of light. SPDX-License-Identifier: MIT
 *
 * By Green's theorem the area of the open region within the piece is half the integral of x dy - y dx along its
 * boundary, about the middle of the window. Arcs are cut by the lines of the piece. Between arcs the boundary goes
 * along these lines. On a line the region begins where its own boundary crosses the line one way, and ends where it
 * crosses the line the other way. The integral along a line up to x is c x/2. c is the distance of the line from the
 * middle, and x is counted along the line. So a line needs no list of crossings, only a sum over them. x is limited to
 * the stretch between the neighbouring lines. */
#include "base/elementary.h"
#include "light/light.h"

/* Where an arc leaves the inner side of a line and where it enters it, each at most once. Places are relative to the
 * arc's centre. */
typedef struct arc_crossings {
    bool leaves, enters; /* whether the arc does so */
    bool begins_inside;
    double out[2], back[2];
} arc_crossings;

static double along(const fibrad_light_line *line, const double x[2]) { return line->n[0] * x[1] - line->n[1] * x[0]; }

static double cross(const double a[2], const double b[2]) { return a[0] * b[1] - a[1] * b[0]; }

/* Whether the point of a circle in direction sign n lies on its arc from p to q. */
static bool arc_holds(const double p[2], const double q[2], const double n[2], double sign) {
    const double to[2] = {sign * n[0], sign * n[1]};
    return cross(p, to) >= 0 && cross(to, q) >= 0;
}

static arc_crossings crossings_of(const fibrad_open_arc *arc, const double p[2], const double q[2],
                                  const fibrad_light_line *line) {
    const double *n = line->n, height = line->c - (n[0] * arc->c[0] + n[1] * arc->c[1]);
    const double root = fibrad_sqrt(fibrad_max(0, arc->r * arc->r - height * height));
    const bool first = n[0] * p[0] + n[1] * p[1] <= height, last = n[0] * q[0] + n[1] * q[1] <= height;
    arc_crossings at = {.begins_inside = first};
    if (first != last)
        at.leaves = first, at.enters = last;
    else if (first ? height < arc->r : height > -arc->r)
        at.leaves = at.enters = arc_holds(p, q, n, first ? 1 : -1);
    /* an arc is counter-clockwise, so it goes outwards at the crossing that comes first along the line */
    for (int a = 0; a < 2; a++) {
        const double t = a == 0 ? -n[1] : n[0];
        at.out[a] = height * n[a] - root * t, at.back[a] = height * n[a] + root * t;
    }
    return at;
}

/* The integral of Green's theorem along the arc from p to q. */
static double arc_integral(const fibrad_open_arc *arc, const double p[2], const double q[2]) {
    const double sine = fibrad_max(0, cross(p, q)), cosine = p[0] * q[0] + p[1] * q[1];
    const double angle =
        cosine >= 0 ? fibrad_quarter_angle(cosine, sine) : FIBRAD_PI - fibrad_quarter_angle(0 - cosine, sine);
    const double chord[2] = {q[0] - p[0], q[1] - p[1]};
    return .5 * (arc->r * arc->r * angle + cross(arc->c, chord));
}

/* Edges that are near the window, and the sum over arcs. */
typedef struct region_sum {
    fibrad_footprint *f;
    uint32_t edges;
    double area;
} region_sum;

/* Notes that the boundary of the region crosses an edge at a place. The region lies to the left of its boundary. */
static void note_crossing(fibrad_light_edge *edge, const double centre[2], const double at[2], int outwards) {
    const double x[2] = {centre[0] + at[0], centre[1] + at[1]};
    const double t = fibrad_max(edge->low, fibrad_min(edge->high, along(&edge->line, x)));
    edge->sum -= outwards * .5 * edge->line.c * t;
    edge->balance += outwards;
}

static void cross_edges(const region_sum *sum, const fibrad_open_arc *arc, int sense) {
    for (uint32_t e = 0; e < sum->edges; e++) {
        fibrad_light_edge *edge = &sum->f->edge[e];
        const arc_crossings at = crossings_of(arc, arc->p, arc->q, &edge->line);
        if (at.leaves) note_crossing(edge, arc->c, at.out, sense);
        if (at.enters) note_crossing(edge, arc->c, at.back, -sense);
    }
}

/* Adds the part of an arc inside all edges, and appends the parts that were cut off to the list. */
static double inside_of_arc(fibrad_footprint *f, const fibrad_open_arc *arc, uint32_t edges, fibrad_light_arc part,
                            uint32_t *parts) {
    for (uint32_t e = part.next; e < edges; e++) {
        const arc_crossings at = crossings_of(arc, part.p, part.q, &f->edge[e].line);
        const bool twice = at.leaves && at.enters;
        if (!at.leaves && !at.enters && !at.begins_inside) return 0;
        if (twice && at.begins_inside)
            f->arc[(*parts)++] = (fibrad_light_arc){{at.back[0], at.back[1]}, {part.q[0], part.q[1]}, e + 1};
        if (at.enters && !(twice && at.begins_inside)) part.p[0] = at.back[0], part.p[1] = at.back[1];
        if (at.leaves) part.q[0] = at.out[0], part.q[1] = at.out[1];
    }
    return arc_integral(arc, part.p, part.q);
}

static void add_open_arc(region_sum *sum, const fibrad_open_arc *arc) {
    const int sense = arc->circle == 0 ? 1 : -1;
    uint32_t parts = 1;
    cross_edges(sum, arc, sense);
    sum->f->arc[0] = (fibrad_light_arc){{arc->p[0], arc->p[1]}, {arc->q[0], arc->q[1]}, 0};
    while (parts > 0) {
        const fibrad_light_arc part = sum->f->arc[--parts];
        sum->area += sense * inside_of_arc(sum->f, arc, sum->edges, part, &parts);
    }
}

#define PARALLEL 1e-14

/* The stretch of each edge that the others leave. */
static void bound_edges(fibrad_footprint *f, uint32_t edges) {
    for (uint32_t e = 0; e < edges; e++) {
        fibrad_light_edge *edge = &f->edge[e];
        const double *n = edge->line.n;
        edge->low = -__builtin_inf(), edge->high = __builtin_inf();
        edge->sum = 0, edge->balance = 0;
        for (uint32_t k = 0; k < edges; k++) {
            const fibrad_light_line *other = &f->edge[k].line;
            const double rate = cross(n, other->n);
            const double left = other->c - edge->line.c * (n[0] * other->n[0] + n[1] * other->n[1]);
            if (k == e) continue;
            if (fibrad_abs(rate) < PARALLEL) {
                if (left < 0 || (left == 0 && k < e)) edge->low = edge->high = 0; /* it bounds nothing */
                if (left < 0 || (left == 0 && k < e)) break;
            } else if (rate > 0)
                edge->high = fibrad_min(edge->high, left / rate);
            else
                edge->low = fibrad_max(edge->low, left / rate);
        }
        edge->high = fibrad_max(edge->low, edge->high);
    }
}

/* The open area within all edges near the window. Rounding may put the end of an arc on both sides of a line. Then
 * there are not as many crossings outwards as inwards, and the lines are moved a little. */
#define ATTEMPTS 8
#define SHIFT    1e-12
static double area_within(fibrad_footprint *f, const fibrad_areas *areas, uint32_t edges) {
    region_sum sum = {f, edges, 0};
    fibrad_open_arc arc;
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        bool paired = true;
        sum.area = 0;
        bound_edges(f, edges);
        for (uint32_t at = 0; fibrad_areas_next(areas, &at, &arc);) add_open_arc(&sum, &arc);
        for (uint32_t e = 0; e < edges; e++) {
            sum.area += f->edge[e].sum, paired = paired && f->edge[e].balance == 0;
            f->edge[e].line.c += SHIFT;
        }
        if (paired) break;
    }
    return sum.area;
}

/* Lists a line as an edge if it may cut the window. False: the window lies outside. */
static bool list_edge(fibrad_footprint *f, const fibrad_light_line *line, const double uv[2], double r,
                      uint32_t *edges) {
    const double c = (line->c - (line->n[0] * uv[0] + line->n[1] * uv[1])) / r;
    if (c < 1) f->edge[(*edges)++].line = (fibrad_light_line){{line->n[0], line->n[1]}, c};
    return c > -1;
}

/* What a window takes of a piece, in units of its radius squared. p: the polygon of the window that counts; NULL: all
 * of the window. */
static double share_of_piece(fibrad_footprint *f, const fibrad_light_piece *piece, const fibrad_unshadowed_polygon *p,
                             const fibrad_areas *areas, double open, const double uv[2], double r) {
    static const double middle[2] = {0, 0};
    uint32_t edges = 0;
    bool meets = true;
    for (uint32_t k = 0; p != NULL && k < p->sides && meets; k++)
        meets = (p->line[k].n[0] == 0 && p->line[k].n[1] == 0) || list_edge(f, &p->line[k], middle, 1, &edges);
    for (uint32_t k = 0; k < f->common + (piece->far ? f->far : 0) && meets; k++)
        meets = list_edge(f, &f->line[k], uv, r, &edges);
    for (uint32_t k = 0; k < piece->lines && meets; k++) meets = list_edge(f, &piece->line[k], uv, r, &edges);
    if (!meets) return 0;
    if (edges == 0) return open;
    return fibrad_max(0, fibrad_min(open, area_within(f, areas, edges)));
}

void fibrad_footprint_share(fibrad_footprint *f, const fibrad_areas *areas, double open, const double uv[2], double r,
                            double area[FIBRAD_SLOTS]) {
    double at[2];
    const fibrad_unshadowed *unshadowed = &f->unshadowed;
    for (uint32_t image = 0; fibrad_footprint_image(f, uv, image, at); image++)
        for (uint32_t k = 0; k < f->pieces; k++)
            for (uint32_t n = 0; n < (unshadowed->whole ? 1 : unshadowed->count); n++)
                area[f->piece[k].slot] +=
                    f->piece[k].sign * r * r *
                    share_of_piece(f, &f->piece[k], unshadowed->whole ? NULL : &unshadowed->polygon[n], areas, open, at,
                                   r);
}
