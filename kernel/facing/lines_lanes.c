/* lines_lanes.c - lines of a window and the triangles that they meet first, lines in lanes. Compiled once per
 * instruction set. SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "base/vector.h"
#include "facing/lines_lanes.h"

/* ---- lines ------------------------------------------------------------------------------------------------------- */
/* The line of a point. */
typedef struct point_line {
    double place[2], exit, aside[2];
} point_line;

static point_line line_through(const fibrad_points *points, uint32_t p, uint32_t k, double spread) {
    point_line line = {.place = {points->set.x[p], points->set.y[p]}, .exit = fibrad_point_exit(points, p)};
    if (spread > 0) {
        const uint32_t q = fibrad_points_partner(points->count, p, k);
        line.aside[0] = (float)(points->set.x[q] * spread), line.aside[1] = (float)(points->set.y[q] * spread);
    }
    return line;
}

/* The cell of a line among four by four cells of a square about the window. The cells are numbered row by row, each
 * row in the opposite sense of the last one. */
static uint8_t cell_of_line(const point_line *line, double depth, double over) {
    uint32_t cell[2];
    for (int axis = 0; axis < 2; axis++) {
        const double at = line->place[axis] + line->aside[axis] * (depth - line->exit);
        cell[axis] = (uint32_t)fibrad_max(0, fibrad_min(3, 2 + at * over));
    }
    return (uint8_t)(4 * cell[1] + (cell[1] % 2 == 0 ? cell[0] : 3 - cell[0]));
}

/* Bounds of each block of eight lines. */
static void bound_lines(fibrad_lines *lines) {
    for (int axis = 0; axis < 2; axis++)
        for (uint32_t b = 0; b < lines->count / FIBRAD_LINE_BLOCK; b++) {
            double low = __builtin_inf(), high = -low, least = low, most = high;
            for (uint32_t p = FIBRAD_LINE_BLOCK * b; p < FIBRAD_LINE_BLOCK * (b + 1); p++) {
                const double aside = lines->aside[axis][p];
                const double at = lines->place[axis][p] + aside * (lines->at - lines->exit[p]);
                low = fibrad_min(low, at), high = fibrad_max(high, at);
                least = fibrad_min(least, aside), most = fibrad_max(most, aside);
            }
            lines->low[axis][b] = low, lines->high[axis][b] = high;
            lines->least[axis][b] = least, lines->most[axis][b] = most;
        }
}

static void set_line(fibrad_lines *lines, uint32_t to, uint32_t point, point_line line) {
    for (int axis = 0; axis < 2; axis++)
        lines->place[axis][to] = line.place[axis], lines->aside[axis][to] = line.aside[axis];
    lines->exit[to] = line.exit, lines->point[to] = point;
}

uint32_t LANED(fibrad_lines_spread)(fibrad_met *met, const fibrad_points *points, const uint64_t chosen[4], uint32_t k,
                                    double spread, double at) {
    fibrad_lines *lines = &met->lines;
    const double over = 2 / (1 + spread * at);
    uint32_t start[17] = {0}, count = 0;
    uint8_t cell[FIBRAD_MET_POINTS];
    lines->at = at, lines->parallel = 0;
    for (uint32_t word = 0; word < points->count / 64; word++)
        for (uint64_t rest = chosen[word]; rest != 0; rest &= rest - 1) {
            const point_line line = line_through(points, 64 * word + (uint32_t)__builtin_ctzll(rest), k, spread);
            cell[count] = cell_of_line(&line, at, over);
            start[cell[count++] + 1]++;
        }
    for (uint32_t c = 0; c < 16; c++) start[c + 1] += start[c];
    for (uint32_t word = 0, n = 0; word < points->count / 64; word++)
        for (uint64_t rest = chosen[word]; rest != 0; rest &= rest - 1) {
            const uint32_t p = 64 * word + (uint32_t)__builtin_ctzll(rest);
            set_line(lines, start[cell[n++]]++, p, line_through(points, p, k, spread));
        }
    lines->count = count;
    for (; lines->count % FIBRAD_LINE_BLOCK != 0; lines->count++) {
        const uint32_t p = lines->point[count - 1];
        set_line(lines, lines->count, p, line_through(points, p, k, spread));
    }
    for (uint32_t p = 0; p < lines->count; p++)
        lines->depth[p] = p < count ? __builtin_inf() : -__builtin_inf(), lines->side[p] = -1;
    bound_lines(lines);
    (void)LANED(fibrad_lines_last)(lines);
    return count;
}

void LANED(fibrad_lines_parallel)(fibrad_met *met, const fibrad_points *points, const double *depth) {
    static const uint64_t all[4] = {UINT64_MAX, UINT64_MAX, UINT64_MAX, UINT64_MAX};
    fibrad_lines *lines = &met->lines;
    if (lines->parallel != points->count) {
        LANED(fibrad_lines_spread)(met, points, all, 0, 0, 0);
        lines->parallel = points->count;
    }
    for (uint32_t p = 0; p < lines->count; p++) {
        lines->depth[p] = depth != NULL ? depth[lines->point[p]] : __builtin_inf();
        lines->side[p] = -1;
    }
    (void)LANED(fibrad_lines_last)(lines);
}

uint32_t LANED(fibrad_lines_tell)(fibrad_met *met) {
    const fibrad_lines *lines = &met->lines;
    uint32_t meet = 0;
    for (uint32_t p = 0; p < lines->count; p++) {
        if (lines->side[p] < 0) continue;
        const uint32_t point = lines->point[p];
        met->depth[point] = lines->depth[p], met->side[point] = (uint32_t)lines->side[p];
        for (int axis = 0; axis < 2; axis++) met->aside[axis][point] = (float)lines->aside[axis][p];
        meet++;
    }
    return meet;
}

double LANED(fibrad_lines_last)(fibrad_lines *lines) {
    double all = -__builtin_inf();
    for (uint32_t b = 0; b < lines->count / FIBRAD_LINE_BLOCK; b++) {
        double last = -__builtin_inf();
        for (uint32_t p = FIBRAD_LINE_BLOCK * b; p < FIBRAD_LINE_BLOCK * (b + 1); p++)
            last = fibrad_max(last, lines->depth[p]);
        lines->last[b] = last;
        all = fibrad_max(all, last);
    }
    return all;
}

uint32_t LANED(fibrad_lines_deepest)(const fibrad_lines *lines) {
    double deepest = -__builtin_inf();
    uint32_t side = FIBRAD_NO_SIDE;
    for (uint32_t p = 0; p < lines->count; p++)
        if (lines->side[p] >= 0 && lines->depth[p] > deepest)
            deepest = lines->depth[p], side = (uint32_t)lines->side[p];
    return side;
}

/* ---- and triangles ----------------------------------------------------------------------------------------------- */
/* Notes a side in those of the VD_LANES lines from p on that meet it at a smaller `key` than what they have met
 * before. Of equal keys the triangle with the lower number counts. */
FIBRAD_INLINE void note_side(fibrad_workspace *work, uint32_t p, vm meet, vd side, vd key) {
    fibrad_lines *lines = &work->met->lines;
    const vd depth = vd_load(lines->depth + p), before = vd_load(lines->side + p);
    uint32_t equal = vm_bits(meet & vd_le(key, depth) & vd_le(depth, key) & vd_le(vd_set1(0), before));
    const vm nearer = meet & vd_lt(key, depth);
    vd_store(lines->depth + p, vd_select(nearer, key, depth));
    vd_store(lines->side + p, vd_select(nearer, side, before));
    if (equal == 0) return;
    _Alignas(64) double sides[VD_LANES];
    vd_store(sides, side);
    for (; equal != 0; equal &= equal - 1) {
        const fibrad_mesh *mesh = &work->scene->mesh;
        const uint32_t lane = (uint32_t)__builtin_ctz(equal);
        const uint32_t own = (uint32_t)sides[lane], other = (uint32_t)lines->side[p + lane];
        if (fibrad_side_number(mesh, own) < fibrad_side_number(mesh, other)) lines->side[p + lane] = own;
    }
}

/* Eight parallel lines in comparison with face number k. For backs the key is the depth plus one grain, so that
 * fronts come first at edges. */
FIBRAD_INLINE void meet_parallel(fibrad_workspace *work, uint32_t k, uint32_t first, double grain) {
    const fibrad_lines *lines = &work->met->lines;
    const fibrad_faces *faces = &work->met->faces;
    const bool back = fibrad_side_is_back((uint32_t)faces->side[k]);
    const double shift = back ? grain : -grain, more = back ? grain : 0;
    for (uint32_t p = first; p < first + FIBRAD_LINE_BLOCK; p += VD_LANES) {
        const vd u = vd_load(lines->place[0] + p), v = vd_load(lines->place[1] + p), s = vd_load(lines->exit + p);
        vd x[3], y[3];
#pragma GCC unroll 3
        for (int c = 0; c < 3; c++) x[c] = faces->corner[c][0][k] - u, y[c] = faces->corner[c][1][k] - v;
        const vd a = x[1] * y[2] - y[1] * x[2], b = x[2] * y[0] - y[2] * x[0], c = x[0] * y[1] - y[0] * x[1];
        const vm inside = vd_le(vd_set1(0), vd_min(a, vd_min(b, c))) & vd_lt(vd_set1(0), vd_max(a, vd_max(b, c)));
        const vd plane = u * faces->plane[0][k] + v * faces->plane[1][k] + faces->plane[2][k];
        const vd z = vd_min(vd_max(plane, vd_set1(faces->low[k])), vd_set1(faces->high[k]));
        note_side(work, p, inside & vd_lt(s + shift, z), vd_set1(faces->side[k]), z + more);
    }
}

/* The same for lines that spread. Such lines may see the other side of the triangle than the axis of the window
 * does. */
FIBRAD_INLINE void meet_spread(fibrad_workspace *work, uint32_t k, uint32_t first, double grain) {
    const fibrad_lines *lines = &work->met->lines;
    const fibrad_faces *faces = &work->met->faces;
    const double side = faces->side[k], other = 4. * faces->triangle[k] + 1 - side;
    const bool back = other < side;
    const vd zero = vd_set1(0);
    for (uint32_t p = first; p < first + FIBRAD_LINE_BLOCK; p += VD_LANES) {
        const vd u = vd_load(lines->place[0] + p), v = vd_load(lines->place[1] + p), s = vd_load(lines->exit + p);
        vd x[3], y[3];
#pragma GCC unroll 3
        for (int c = 0; c < 3; c++) {
            const vd ahead = faces->corner[c][2][k] - s;
            x[c] = faces->corner[c][0][k] - u - vd_load(lines->aside[0] + p) * ahead;
            y[c] = faces->corner[c][1][k] - v - vd_load(lines->aside[1] + p) * ahead;
        }
        const vd a = x[1] * y[2] - y[1] * x[2], b = x[2] * y[0] - y[2] * x[0], c = x[0] * y[1] - y[0] * x[1];
        const vm none = vd_lt(vd_min(a, vd_min(b, c)), zero), some = vd_lt(zero, vd_max(a, vd_max(b, c)));
        const vm inside =
            (some & vm_not(none)) | (none & vm_not(some)); /* all are >= 0 or all are <= 0, but not all are 0 */
        if (vm_bits(inside) == 0) continue;
        const vd sum = a + b + c,
                 z = (a * faces->corner[0][2][k] + b * faces->corner[1][2][k] + c * faces->corner[2][2][k]) / sum;
        const vm same = vd_lt(zero, sum);
        const vd more = vd_select(same, vd_set1(back ? grain : 0), vd_set1(back ? 0 : grain));
        const vd shift = vd_select(same, vd_set1(back ? grain : -grain), vd_set1(back ? -grain : grain));
        note_side(work, p, inside & vd_lt(s + shift, z) & vd_le(z, vd_set1(1e300)),
                  vd_select(same, vd_set1(side), vd_set1(other)), z + more);
    }
}

static void meet_pairs(fibrad_workspace *work, double grain) {
    fibrad_lines *lines = &work->met->lines;
    for (uint32_t at = 0; at < lines->pairs; at++) {
        const uint32_t pair = lines->pair[at], k = pair / FIBRAD_LINE_BLOCKS;
        const uint32_t first = pair % FIBRAD_LINE_BLOCKS * FIBRAD_LINE_BLOCK;
        if (lines->parallel > 0)
            meet_parallel(work, k, first, grain);
        else
            meet_spread(work, k, first, grain);
    }
    lines->pairs = 0;
}

/* Which blocks of parallel lines from b on may meet face number k. Left out are blocks that end before the face, and
 * blocks whose lines all lie outside one of its edges. */
FIBRAD_INLINE vm parallel_before(const fibrad_lines *lines, const fibrad_faces *faces, uint32_t k, uint32_t b) {
    const vd low[2] = {vd_load(lines->low[0] + b), vd_load(lines->low[1] + b)};
    const vd high[2] = {vd_load(lines->high[0] + b), vd_load(lines->high[1] + b)};
    vd sum[3];
#pragma GCC unroll 3
    for (int e = 0; e < 3; e++) {
        const vd u = vd_set1(faces->edge[e][0][k]), v = vd_set1(faces->edge[e][1][k]);
        sum[e] = vd_max(u * low[0], u * high[0]) + vd_max(v * low[1], v * high[1]) + faces->edge[e][2][k];
    }
    return vd_le(vd_set1(0), vd_min(sum[0], vd_min(sum[1], sum[2]))) &
           vd_le(vd_set1(faces->low[k]), vd_load(lines->last + b));
}

/* The same for lines that spread, by the box about the face. */
static vm spread_before(const fibrad_lines *lines, const fibrad_faces *faces, uint32_t k, uint32_t b, double slack) {
    const double from = fibrad_max(-1, faces->low[k]) - lines->at, to = fibrad_max(-1, faces->high[k]) - lines->at;
    vm apart = vd_lt(vd_load(lines->last + b), vd_set1(faces->low[k]));
    for (int axis = 0; axis < 2; axis++) {
        const double x[3] = {faces->corner[0][axis][k], faces->corner[1][axis][k], faces->corner[2][axis][k]};
        const double low = fibrad_min(x[0], fibrad_min(x[1], x[2])) - slack;
        const double high = fibrad_max(x[0], fibrad_max(x[1], x[2])) + slack;
        const vd least = vd_load(lines->least[axis] + b), most = vd_load(lines->most[axis] + b);
        const vd least_side = vd_min(vd_min(least * from, least * to), vd_min(most * from, most * to));
        const vd most_side = vd_max(vd_max(least * from, least * to), vd_max(most * from, most * to));
        apart = apart | vd_lt(vd_load(lines->high[axis] + b) + most_side, vd_set1(low)) |
                vd_lt(vd_set1(high), vd_load(lines->low[axis] + b) + least_side);
    }
    return vm_not(apart);
}

/* Where face number k cuts the surface of sphere i off from its centre, lines end at once. They end before all that
 * other lines meet, the nearest face first. */
static void cut_surface(fibrad_workspace *work, uint32_t k) {
    const fibrad_lines *lines = &work->met->lines;
    const fibrad_faces *faces = &work->met->faces;
    const vd zero = vd_set1(0), one = vd_set1(1);
    const vd side = vd_set1(faces->side[k]), other = vd_set1(4. * faces->triangle[k] + 1 - faces->side[k]);
    double x[3][3], n[3][3],
        sum_n[3]; /* corners; normals of the planes through the centre and each edge; normal of the face */
    for (int c = 0; c < 3; c++)
        for (int axis = 0; axis < 3; axis++) x[c][axis] = faces->corner[c][axis][k];
    for (int c = 0; c < 3; c++) fibrad_cross(x[(c + 1) % 3], x[(c + 2) % 3], n[c]);
    for (int axis = 0; axis < 3; axis++) sum_n[axis] = n[0][axis] + n[1][axis] + n[2][axis];
    const double volume = fibrad_dot(x[0], n[0]); /* volume of six tetrahedra */
    const double square = fibrad_dot(sum_n, sum_n);
    if (volume * volume > square * (1 + 1e-9)) return; /* the plane of the face does not meet the sphere */
    for (uint32_t p = 0; p < lines->count; p += VD_LANES) {
        const vd u = vd_load(lines->place[0] + p), v = vd_load(lines->place[1] + p), s = vd_load(lines->exit + p);
        vd e[3];
        for (int c = 0; c < 3; c++) e[c] = n[c][0] * u + n[c][1] * v + n[c][2] * s;
        const vd least = vd_min(e[0], vd_min(e[1], e[2])), most = vd_max(e[0], vd_max(e[1], e[2]));
        const vm inside = (vd_lt(zero, most) & vd_le(zero, least)) | (vd_lt(least, zero) & vd_le(most, zero));
        const vd sum = e[0] + e[1] + e[2], share = volume / sum; /* share of the way from the centre to the surface */
        note_side(work, p, inside & vd_lt(zero, share) & vd_lt(share, one), vd_select(vd_lt(zero, sum), side, other),
                  share - 2);
    }
}

void LANED(fibrad_lines_meet)(fibrad_workspace *work, double slack) {
    const fibrad_faces *faces = &work->met->faces;
    fibrad_lines *lines = &work->met->lines;
    const double grain = work->scene->mesh.grain * work->inverse;
    const uint32_t blocks = lines->count / FIBRAD_LINE_BLOCK;
    lines->pairs = 0;
    for (uint32_t k = 0; k < faces->count; k++) {
        for (uint32_t b = 0; b < blocks; b += VD_LANES) {
            const vm before =
                lines->parallel > 0 ? parallel_before(lines, faces, k, b) : spread_before(lines, faces, k, b, slack);
            const uint32_t bits = vm_bits(before) & vd_lanes_below(blocks - b);
            lines->pairs += vd_compress_places(lines->pair + lines->pairs, bits, k * FIBRAD_LINE_BLOCKS + b);
        }
        if (lines->pairs >= FIBRAD_PAIRS) meet_pairs(work, grain);
        if (work->clear_mesh < 1 && faces->low[k] < 1) cut_surface(work, k);
    }
    meet_pairs(work, grain);
}

void LANED(fibrad_lines_follow)(fibrad_workspace *work, const double frame[9], double from, double deepest) {
    fibrad_lines *lines = &work->met->lines;
    for (uint32_t p = 0; p < lines->count; p++) {
        const double until = fibrad_min(lines->depth[p], deepest), way = from - lines->exit[p];
        double origin[3], w[3], square = 0;
        if (!(until > from)) continue;
        for (int axis = 0; axis < 3; axis++) {
            const double *f = frame + axis;
            w[axis] = f[6] + lines->aside[0][p] * f[0] + lines->aside[1][p] * f[3];
            square += w[axis] * w[axis];
            origin[axis] = lines->place[0][p] * f[0] + lines->place[1][p] * f[3] + lines->exit[p] * f[6];
            origin[axis] = work->centre[axis] + (origin[axis] + way * w[axis]) * work->unit;
        }
        const double length = fibrad_sqrt(square), unit = work->unit * length;
        for (int axis = 0; axis < 3; axis++) w[axis] /= length;
        const fibrad_mesh_hit met =
            fibrad_mesh_first(&work->scene->mesh, origin, w, (until - from) * unit, FIBRAD_NO_SIDE);
        if (met.side == FIBRAD_NO_SIDE) continue;
        lines->depth[p] = from + met.distance / unit, lines->side[p] = met.side;
    }
}
