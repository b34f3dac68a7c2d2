/* mesh_lines_lanes.c - lines of a window and the triangles that they meet first, lines in lanes. Compiled once per
 * instruction set. SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "row/mesh_lines_lanes.h"

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

/* In which of four by four cells of a square about the window a line is, to and fro. */
static uint8_t cell_of_line(const point_line *line, double depth, double over) {
    uint32_t cell[2];
    for (int axis = 0; axis < 2; axis++) {
        const double at = line->place[axis] + line->aside[axis] * (depth - line->exit);
        cell[axis] = (uint32_t)fibrad_max(0, fibrad_min(3, 2 + at * over));
    }
    return (uint8_t)(4 * cell[1] + (cell[1] % 2 == 0 ? cell[0] : 3 - cell[0]));
}

/* Bounds of each eight lines. */
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
        lines->depth[p] = p < count ? __builtin_inf() : -__builtin_inf(), lines->number[p] = __builtin_inf();
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
        lines->number[p] = __builtin_inf();
    }
    (void)LANED(fibrad_lines_last)(lines);
}

uint32_t LANED(fibrad_lines_tell)(fibrad_met *met) {
    const fibrad_lines *lines = &met->lines;
    uint32_t meet = 0;
    for (uint32_t p = 0; p < lines->count; p++) {
        if (!(lines->number[p] < __builtin_inf())) continue;
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
        if (lines->number[p] < __builtin_inf() && lines->depth[p] > deepest)
            deepest = lines->depth[p], side = (uint32_t)lines->side[p];
    return side;
}

/* ---- and a triangle ---------------------------------------------------------------------------------------------- */
/* Notes face number k in those of VD_LANES lines from p on that meet it by `key` no deeper than what they met before;
 * of equals, the lower number stays. */
FIBRAD_INLINE void note_face(fibrad_workspace *work, uint32_t k, uint32_t p, vm meet, vm back, vd key) {
    fibrad_lines *lines = &work->met->lines;
    const uint32_t t = work->met->faces.triangle[k];
    const vd depth = vd_load(lines->depth + p), number = vd_load(lines->number + p);
    const vd own = vd_set1(work->scene->mesh.number[t]), side = vd_select(back, vd_set1(2. * t + 1), vd_set1(2. * t));
    const vm nearer = meet & (vd_lt(key, depth) | (vd_le(key, depth) & vd_lt(own, number)));
    vd_store(lines->depth + p, vd_select(nearer, key, depth));
    vd_store(lines->number + p, vd_select(nearer, own, number));
    vd_store(lines->side + p, vd_select(nearer, side, vd_load(lines->side + p)));
}

/* Eight lines and face number k. Of the depth, a grain more at backs, so that fronts come first at edges. */
FIBRAD_INLINE void meet_block(fibrad_workspace *work, uint32_t k, uint32_t first, double grain, bool spread) {
    const fibrad_lines *lines = &work->met->lines;
    const fibrad_faces *faces = &work->met->faces;
    const vd zero = vd_set1(0), more = vd_set1(grain);
    for (uint32_t p = first; p < first + FIBRAD_LINE_BLOCK; p += VD_LANES) {
        const vd u = vd_load(lines->place[0] + p), v = vd_load(lines->place[1] + p), s = vd_load(lines->exit + p);
        vd x[3], y[3];
#pragma GCC unroll 3
        for (int c = 0; c < 3; c++) {
            x[c] = faces->corner[c][0][k] - u, y[c] = faces->corner[c][1][k] - v;
            if (!spread) continue;
            const vd ahead = faces->corner[c][2][k] - s;
            x[c] = x[c] - vd_load(lines->aside[0] + p) * ahead;
            y[c] = y[c] - vd_load(lines->aside[1] + p) * ahead;
        }
        const vd a = x[1] * y[2] - y[1] * x[2], b = x[2] * y[0] - y[2] * x[0], c = x[0] * y[1] - y[0] * x[1];
        const vm none = vd_lt(vd_min(a, vd_min(b, c)), zero), some = vd_lt(zero, vd_max(a, vd_max(b, c)));
        const vm inside = (some & vm_not(none)) | (none & vm_not(some)); /* all >= 0, or all <= 0, but not all 0 */
        if (vm_bits(inside) == 0) continue;
        const vd sum = a + b + c,
                 z = (a * faces->corner[0][2][k] + b * faces->corner[1][2][k] + c * faces->corner[2][2][k]) / sum;
        const vm back = vd_lt(zero, sum);
        const vd grains = vd_select(back, more, zero), behind = s + vd_select(back, more, zero - more);
        note_face(work, k, p, inside & vd_lt(behind, z) & vd_le(z, vd_set1(1e300)), back, z + grains);
    }
}

/* The eights of parallel lines from b on that all pass face number k on the outer side of one of its edges. */
FIBRAD_INLINE vm blocks_apart(const fibrad_lines *lines, const fibrad_faces *faces, uint32_t k, uint32_t b) {
    vd sum[3];
#pragma GCC unroll 3
    for (int e = 0; e < 3; e++) {
        const double u = faces->edge[e][0][k], v = faces->edge[e][1][k];
        sum[e] = u * vd_load((u > 0 ? lines->high[0] : lines->low[0]) + b) +
                 v * vd_load((v > 0 ? lines->high[1] : lines->low[1]) + b) + faces->edge[e][2][k];
    }
    return vd_lt(vd_min(sum[0], vd_min(sum[1], sum[2])), vd_set1(0));
}

static void meet_parallel(fibrad_workspace *work, uint32_t k, double grain) {
    const fibrad_lines *lines = &work->met->lines;
    const fibrad_faces *faces = &work->met->faces;
    const uint32_t blocks = lines->count / FIBRAD_LINE_BLOCK;
    for (uint32_t b = 0; b < blocks; b += VD_LANES) {
        uint32_t bits = vm_bits(vd_le(vd_set1(faces->low[k]), vd_load(lines->last + b))) & vd_lanes_below(blocks - b);
        if (bits == 0) continue;
        bits &= vm_bits(vm_not(blocks_apart(lines, faces, k, b)));
        for (; bits != 0; bits &= bits - 1)
            meet_block(work, k, (b + (uint32_t)__builtin_ctz(bits)) * FIBRAD_LINE_BLOCK, grain, false);
    }
}

/* Lines that spread: those eights that pass the box about the face. */
static void meet_spread(fibrad_workspace *work, uint32_t k, double grain, double slack) {
    const fibrad_lines *lines = &work->met->lines;
    double low[3], high[3];
    for (int axis = 0; axis < 3; axis++) {
        const double a = work->met->faces.corner[0][axis][k], b = work->met->faces.corner[1][axis][k];
        const double c = work->met->faces.corner[2][axis][k];
        low[axis] = fibrad_min(a, fibrad_min(b, c)) - slack, high[axis] = fibrad_max(a, fibrad_max(b, c)) + slack;
    }
    const uint32_t blocks = lines->count / FIBRAD_LINE_BLOCK;
    const double from = fibrad_max(-1, low[2]) - lines->at, to = fibrad_max(-1, high[2]) - lines->at;
    for (uint32_t b = 0; b < blocks; b += VD_LANES) {
        vm apart = vd_lt(vd_load(lines->last + b), vd_set1(low[2]));
        for (int axis = 0; axis < 2; axis++) {
            const vd least = vd_load(lines->least[axis] + b), most = vd_load(lines->most[axis] + b);
            const vd least_side = vd_min(vd_min(least * from, least * to), vd_min(most * from, most * to));
            const vd most_side = vd_max(vd_max(least * from, least * to), vd_max(most * from, most * to));
            apart = apart | vd_lt(vd_load(lines->high[axis] + b) + most_side, vd_set1(low[axis])) |
                    vd_lt(vd_set1(high[axis]), vd_load(lines->low[axis] + b) + least_side);
        }
        uint32_t bits = vm_bits(vm_not(apart)) & vd_lanes_below(blocks - b);
        for (; bits != 0; bits &= bits - 1)
            meet_block(work, k, (b + (uint32_t)__builtin_ctz(bits)) * FIBRAD_LINE_BLOCK, grain, true);
    }
}

/* Where the surface of sphere i lies beyond a face, as seen from its centre: there lines end at once, before all that
 * others meet, nearest first. */
static void cut_surface(fibrad_workspace *work, uint32_t face) {
    const fibrad_lines *lines = &work->met->lines;
    const vd zero = vd_set1(0), one = vd_set1(1);
    double x[3][3], n[3][3], sum_n[3]; /* corners; of the planes through the centre and each edge; of that of the face */
    for (int k = 0; k < 3; k++)
        for (int axis = 0; axis < 3; axis++) x[k][axis] = work->met->faces.corner[k][axis][face];
    for (int k = 0; k < 3; k++) {
        const int next = (k + 1) % 3, last = (k + 2) % 3;
        for (int axis = 0; axis < 3; axis++) {
            const int a = (axis + 1) % 3, b = (axis + 2) % 3;
            n[k][axis] = x[next][a] * x[last][b] - x[next][b] * x[last][a];
        }
    }
    for (int axis = 0; axis < 3; axis++) sum_n[axis] = n[0][axis] + n[1][axis] + n[2][axis];
    const double volume = x[0][0] * n[0][0] + x[0][1] * n[0][1] + x[0][2] * n[0][2]; /* of six tetrahedra */
    const double square = sum_n[0] * sum_n[0] + sum_n[1] * sum_n[1] + sum_n[2] * sum_n[2];
    if (volume * volume > square * (1 + 1e-9)) return; /* its plane passes the sphere */
    for (uint32_t p = 0; p < lines->count; p += VD_LANES) {
        const vd u = vd_load(lines->place[0] + p), v = vd_load(lines->place[1] + p), s = vd_load(lines->exit + p);
        vd e[3];
        for (int k = 0; k < 3; k++) e[k] = n[k][0] * u + n[k][1] * v + n[k][2] * s;
        const vd least = vd_min(e[0], vd_min(e[1], e[2])), most = vd_max(e[0], vd_max(e[1], e[2]));
        const vm inside = (vd_lt(zero, most) & vd_le(zero, least)) | (vd_lt(least, zero) & vd_le(most, zero));
        const vd sum = e[0] + e[1] + e[2], share = volume / sum; /* of the way from the centre to the surface */
        note_face(work, face, p, inside & vd_lt(zero, share) & vd_lt(share, one), vd_lt(zero, sum), share - 2);
    }
}

void LANED(fibrad_lines_meet)(fibrad_workspace *work, double slack) {
    const fibrad_faces *faces = &work->met->faces;
    const double grain = work->scene->mesh.grain * work->inverse;
    for (uint32_t k = 0; k < faces->count; k++) {
        if (work->met->lines.parallel > 0)
            meet_parallel(work, k, grain);
        else
            meet_spread(work, k, grain, slack);
        if (work->clear_mesh < 1 && faces->low[k] < 1) cut_surface(work, k);
    }
}
