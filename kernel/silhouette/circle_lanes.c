/* circle_lanes.c - follows the circle in which a sphere appears along a line. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "silhouette/circle_lanes.h"
#include "silhouette/discs_lanes.h"
#include "silhouette/pieces_lanes.h"
#include "work/neighbours_lanes.h"

/* Enters a near sphere j as element k. place: relative to the sphere in hand, in radii of that sphere. r: in these
 * radii, too. */
static void take_near(const fibrad_workspace *work, fibrad_circles *c, uint32_t k, uint32_t j, const double place[3],
                      double r) {
    const fibrad_scene *scene = work->scene;
    const double home[3] = {scene->x[j], scene->y[j], scene->z[j]};
    c->near.sphere[k] = j;
    c->near.sum[0][k] = c->near.sum[1][k] = 0;
    c->near.ball[k][3] = scene->r[j] * c->scale;
    c->near.seen[k][3] = (float)r;
    for (int axis = 0; axis < 3; axis++) {
        const double at = place[axis] * work->unit + (work->centre[axis] - home[axis]), period = scene->period[axis];
        const double away = period > 0 ? fibrad_floor(at / period + .5) : 0;
        c->near.ball[k][axis] = (home[axis] - c->origin[axis]) * c->scale;
        c->near.away[k][axis] = away;
        c->near.seen[k][axis] = (float)place[axis];
        c->images = c->images || away != 0;
    }
}

/* Enters the near spheres of the shell. Elements of radius 0 fill the shell up. */
static void take_shell(const fibrad_workspace *work, fibrad_circles *c) {
    const fibrad_near *near = &work->near;
    c->homes = near->end[0];
    for (uint32_t k = 0; k < c->homes; k++) {
        const double place[3] = {near->x[k], near->y[k], near->z[k]};
        if (near->r[k] > 0)
            take_near(work, c, k, near->sphere[k], place, near->r[k]);
        else
            c->near.sum[0][k] = c->near.sum[1][k] = 0;
    }
}

/* Enters the spheres that a walk has found among the near ones. Returns the first of their places. */
static uint32_t take_walked(const fibrad_workspace *work, fibrad_circles *c, const double frame[9]) {
    const fibrad_discs *disc = &work->disc;
    const uint32_t first = c->walked;
    for (uint32_t k = 0; k < disc->count; k++) {
        double place[3];
        for (int axis = 0; axis < 3; axis++)
            place[axis] = disc->u[k] * frame[axis] + disc->v[k] * frame[3 + axis] + disc->depth[k] * frame[6 + axis];
        take_near(work, c, c->walked++, fibrad_work_sphere(work, k), place, disc->r[k]);
    }
    return first;
}

/* Adds what the sphere has exchanged with some near ones since the last call. */
static void add_sums(fibrad_circles *c, uint32_t own, uint32_t from, uint32_t to, fibrad_pair_table *table) {
    for (uint32_t k = from; k < to; k++) {
        if (c->near.sum[0][k] == 0 && c->near.sum[1][k] == 0) continue;
        fibrad_pair_add(table, own, c->near.sphere[k], c->near.sum[0][k], c->near.sum[1][k]);
        c->near.sum[0][k] = c->near.sum[1][k] = 0;
    }
}

/* The part of the beam that a walk must look at. Seen from behind, the second axis of the frame is reversed. */
static fibrad_tube tube_of(const fibrad_circles *c, double sense) {
    const fibrad_circle_stretch *stretch = &c->stretch;
    const double inverse = 1 / c->r;
    if (!(stretch->radius < __builtin_inf())) return (fibrad_tube){.radius = 1};
    return (fibrad_tube){stretch->u * inverse, sense * stretch->v * inverse, stretch->radius * inverse};
}

/* Lists the near spheres of the shell that overlap the beam of the sphere in hand, by a cull in floats. */
static uint32_t cull_shell(fibrad_workspace *work, const fibrad_circles *c, double sense, uint32_t *place) {
    const double *d = c->frame + 6, w[3] = {sense * d[0], sense * d[1], sense * d[2]};
    const fibrad_sight sight = *LANED(fibrad_near_sight)(&work->near, w);
    const vf wx = vf_set1((float)w[0]), wy = vf_set1((float)w[1]), wz = vf_set1((float)w[2]);
    uint32_t n = 0;
    for (uint32_t j = 0; j < sight.count; j += VF_LANES) {
        vf depth = wx * vf_load(sight.x + j) + wy * vf_load(sight.y + j) + wz * vf_load(sight.z + j);
        n += vn_compress(place + n, vf_lt_bits(vf_load(sight.e + j), depth), sight.near + j);
    }
    return n;
}

/* Keeps, of the known discs of a side, those that are seen somewhere on the stretch. */
static void prune(const fibrad_workspace *work, fibrad_circles *c, uint32_t number) {
    fibrad_circle_side *side = &c->side[number];
    fibrad_circle_discs *seen = &c->seen[number];
    bool met[FIBRAD_CIRCLE_ROOM] = {false};
    LANED(fibrad_discs_see)(work, c, number);
    c->seen[1 - number].count = c->seen[1 - number].number[0] = 0;
    LANED(fibrad_pieces_divide)(c);
    for (uint32_t k = 0; k < c->pieces.count; k++) met[(number == 0 ? c->pieces.first : c->pieces.next)[k]] = true;
    for (uint32_t k = 0, n = 0; k < side->last; k++) {
        const bool listed = n < seen->count && side->slot[k] == seen->slot[n];
        if (!listed || !met[n]) side->outer[k] = 0;
        n += listed;
    }
    LANED(fibrad_discs_leave_touching)(side);
}

/* Adds discs that were just found, as many at a time as there is room for. False: too many discs touch the stretch. */
static bool add_found(const fibrad_workspace *work, fibrad_circles *c, uint32_t number, uint32_t *place,
                      uint32_t count) {
    fibrad_circle_side *side = &c->side[number];
    const bool many = count > 2 * FIBRAD_LANES_MAX;
    fibrad_copy(place + count, c->near.fill, sizeof c->near.fill);
    for (uint32_t k = 0, some; k < count; k += some) {
        uint32_t room = FIBRAD_CIRCLE_DISCS - fibrad_discs_end(side);
        if (room < count - k && room < FIBRAD_CIRCLE_DISCS / 2) {
            prune(work, c, number);
            room = FIBRAD_CIRCLE_DISCS - fibrad_discs_end(side);
            if (room < FIBRAD_CIRCLE_DISCS / 4) return false;
        }
        some = room < count - k ? room : count - k;
        LANED(fibrad_discs_add)(c, side, place + k, some);
        if (many) LANED(fibrad_discs_leave_touching)(side);
    }
    return true;
}

#define SHORTEST 1e-6 /* stretch of a circle */
#define TOO_MANY (-1) /* the error: too many discs touch the stretch, which must be shorter */

/* Finds the discs of the shell on a side. Error: TOO_MANY. */
static int find_in_shell(fibrad_workspace *work, fibrad_circles *c, uint32_t number) {
    uint32_t *place = work->disc.near;
    const double sense = c->side[number].sense;
    const uint32_t count = cull_shell(work, c, sense, place);
    c->side[number].known = work->near.limit[0];
    return add_found(work, c, number, place, count) ? FIBRAD_OK : TOO_MANY;
}

/* Finds the discs of a walk on a side. Error: TOO_MANY. */
static int find_by_walk(fibrad_workspace *work, fibrad_circles *c, uint32_t number) {
    fibrad_circle_side *side = &c->side[number];
    const fibrad_tube tube = tube_of(c, side->sense);
    const double to = fibrad_near_further(work, side->known);
    uint32_t *place = work->disc.near;
    double w[9];
    for (int k = 0; k < 9; k++) w[k] = k < 3 ? c->frame[k] : side->sense * c->frame[k];
    work->disc.count = 0;
    LANED(fibrad_near_walk)(work, w, &tube, side->known, to);
    side->known = to;
    const uint32_t count = work->disc.count;
    if (c->walked + count > c->near.nowhere) return TOO_MANY;
    if (count > work->disc.capacity) return fibrad_work_discs_missed(work);
    const uint32_t first = take_walked(work, c, w);
    for (uint32_t k = 0; k < count; k++) place[k] = first + k;
    return add_found(work, c, number, place, count) ? FIBRAD_OK : TOO_MANY;
}

/* Finds the discs of the next shell. If there is none, finds those of a walk on each side that is not done. Few
 * circles need more than one shell. Error: TOO_MANY. */
static int find_more(fibrad_workspace *work, fibrad_circles *c, uint32_t shell, const bool done[2]) {
    int status = FIBRAD_OK;
    if (shell == 0 && work->near.shells == 0 && !work->near.full) {
        LANED(fibrad_near_extend)(work);
        if (!work->near.full) take_shell(work, c);
    }
    for (uint32_t side = 0; side < 2 && status == FIBRAD_OK; side++)
        if (shell < work->near.shells)
            status = find_in_shell(work, c, side);
        else if (!done[side])
            status = find_by_walk(work, c, side);
    return status;
}

/* Whether there is no disc deeper than the known ones. */
static bool at_horizon(const fibrad_workspace *work, const fibrad_circle_side *side, const double d[3]) {
    const double w[3] = {side->sense * d[0], side->sense * d[1], side->sense * d[2]};
    return side->known >= work->clear && side->known >= fibrad_near_horizon(work, w);
}

/* Finds what is met on the stretch, and on which sides deeper discs cannot change this. */
static void meet(fibrad_workspace *work, fibrad_circles *c, bool done[2]) {
    bool open = false, closed = true;
    for (int s = 0; s < 2; s++) {
        LANED(fibrad_discs_judge)(&c->side[s]);
        done[s] = c->side[s].closed || at_horizon(work, &c->side[s], c->frame + 6);
        open = open || (!done[s] && c->side[s].open);
        closed = closed && (done[s] || c->side[s].open);
    }
    if (open && closed) return; /* it is known already on which sides to look further */
    for (uint32_t s = 0; s < 2; s++) LANED(fibrad_discs_see)(work, c, s);
    LANED(fibrad_pieces_divide)(c);
    for (int s = 0; s < 2; s++)
        done[s] = done[s] || LANED(fibrad_pieces_deepest)(c, s) <= c->side[s].known * (1 - 1e-12) * c->r;
}

static void begin_line(fibrad_circles *c, const fibrad_line *line, uint32_t number) {
    c->frame = line->frame;
    c->half = number % 2;
    for (uint32_t s = 0; s < 2; s++) {
        c->side[s].nothing = c->apart ? FIBRAD_PAIR_OPEN + 2 * number + 1 - s : FIBRAD_NONE;
        c->near.sphere[c->near.nothing + s] = c->side[s].nothing;
    }
    fibrad_copy(c->across, line->frame, sizeof c->across);
    for (int axis = 0; axis < 3; axis++) {
        const double *a = c->across + 3 * axis;
        c->centre[axis] = a[0] * c->at[0] + a[1] * c->at[1] + a[2] * c->at[2];
        c->centre[axis] = (c->centre[axis] + c->grid) - c->grid;
        for (int k = 0; k < 3; k++) c->shift[axis][k] = (a[k] * c->period[k] + c->grid) - c->grid;
    }
    c->farthest = __builtin_inf();
    for (int axis = 0; axis < 3; axis++)
        if (c->period[axis] > 0 && line->frame[6 + axis] != 0)
            c->farthest = fibrad_min(c->farthest, FIBRAD_PERIODS * c->period[axis] / fibrad_abs(line->frame[6 + axis]));
}

/* A point of the circle. */
static void point_at(double place, double r, double point[2]) {
    const bool far = place > 1;
    const double tangent = far ? place - 2 : place, scale = (far ? -r : r) / (1 + tangent * tangent);
    point[0] = scale * (1 - tangent * tangent), point[1] = scale * 2 * tangent;
}

static double chord_between(const double a[2], const double b[2]) {
    return fibrad_sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]));
}

/* Begins a stretch of the circle between two places. */
static void begin_stretch(fibrad_circles *c, double begin, double end) {
    c->stretch = (fibrad_circle_stretch){.begin = begin, .end = end, .radius = __builtin_inf()};
    c->stretch.sectors = FIBRAD_CIRCLE_SECTORS / (end - begin);
    if (end - begin < FIBRAD_CIRCLE_END - FIBRAD_CIRCLE_BEGIN) {
        double first[2], middle[2], last[2];
        point_at(begin, c->r, first);
        point_at((begin + end) / 2, c->r, middle);
        point_at(end, c->r, last);
        c->stretch.u = middle[0], c->stretch.v = middle[1];
        c->stretch.radius = fibrad_max(chord_between(first, middle), chord_between(middle, last)) + 1e-12 * c->r;
    }
    for (int s = 0; s < 2; s++) {
        c->side[s].last = 0;
        c->side[s].known = -1;
        c->side[s].sense = s == 0 ? -1 : 1;
    }
}

/* Adds the contribution of a stretch of the present sphere's circle along the present line. Error: TOO_MANY. */
static int follow(fibrad_workspace *work, fibrad_circles *c, double begin, double end, fibrad_pair_table *table) {
    bool done[2] = {false, false};
    const uint32_t first_walked = c->walked;
    begin_stretch(c, begin, end);
    for (uint32_t shell = 0; !(done[0] && done[1]); shell++) {
        const int status = find_more(work, c, shell, done);
        if (status != FIBRAD_OK) {
            c->walked = first_walked;
            return status;
        }
        meet(work, c, done);
    }
    LANED(fibrad_pieces_add)(c, table);
    if (c->walked > first_walked) add_sums(c, work->place, first_walked, c->walked, table);
    c->walked = first_walked;
    return FIBRAD_OK;
}

/* Follows the line in hand as long as the table has room. If too many discs touch a stretch, it is made shorter. */
static int follow_line(fibrad_workspace *work, fibrad_circles *c, fibrad_pair_table *table) {
    double step = c->step;
    while (c->next < c->end && fibrad_pair_room(table, FIBRAD_CIRCLE_ENDS)) {
        const double end = c->next + step < c->end - SHORTEST ? c->next + step : c->end;
        const int status = follow(work, c, c->next, end, table);
        if (status == TOO_MANY) {
            step = (end - c->next) / 2;
            if (step < SHORTEST) return FIBRAD_E_UNSUPPORTED;
            continue;
        }
        if (status != FIBRAD_OK) return status;
        c->next = end;
        step = fibrad_min(c->step, 2 * step);
    }
    return FIBRAD_OK;
}

int LANED(fibrad_circle_lines)(fibrad_workspace *work, fibrad_circles *c, uint32_t place, const fibrad_line *line,
                               uint32_t *from, uint32_t to, fibrad_pair_table *table) {
    const fibrad_scene *scene = c->scene;
    const double at[3] = {scene->x[place], scene->y[place], scene->z[place]};
    fibrad_work_begin(work, scene, place, 0, FIBRAD_CIRCLE_STRIDE);
    for (int axis = 0; axis < 3; axis++) c->at[axis] = (at[axis] - c->origin[axis]) * c->scale;
    c->r = scene->r[place] * c->scale;
    c->homes = 0, c->walked = work->near.capacity, c->images = false;
    for (uint32_t k = c->near.nothing; k < c->near.nothing + 2; k++) c->near.sum[0][k] = c->near.sum[1][k] = 0;
    for (; *from < to && fibrad_pair_room(table, FIBRAD_CIRCLE_ENDS); ++*from, c->next = c->begin) {
        begin_line(c, &line[*from], *from);
        const int status = follow_line(work, c, table);
        if (status != FIBRAD_OK) return status;
        if (c->apart) add_sums(c, work->place, c->near.nothing, c->near.nothing + 2, table);
        if (c->next < c->end) break;
    }
    add_sums(c, work->place, 0, c->homes, table);
    add_sums(c, work->place, c->near.nothing, c->near.nothing + 2, table);
    return FIBRAD_OK;
}
