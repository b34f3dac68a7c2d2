/* test_wall_rows.c - rows of walls against closed forms, grey plates and paths that are followed by other means;
 * balances of rows. SPDX-License-Identifier: MIT */
#include "grey_rules.h"
#include "host_owned.h"
#include "rectangles.h"
#include "scenes.h"
#include "suite.h"
#include "meshes.h"

static fibrad_bed_matrix *factors_of(const struct bed *bed, const fibrad_scene_config *config,
                                     const fibrad_exchange_rule *grey, const fibrad_bed_rule *options) {
    const fibrad_spheres spheres = spheres_of(bed);
    fibrad_scene_config whole = *config;
    fibrad_bed_rule with_walls = *options;
    fibrad_bed_matrix *factors;
    memcpy(whole.period, bed->period, sizeof whole.period);
    with_walls.walls = 1;
    const int status = grey ? exchange_of(&whole, &spheres, grey, &with_walls, NULL, &factors)
                            : fibrad_view_factors(&whole, &spheres, &with_walls, NULL, &factors);
    assert_ok(status);
    ck_assert_ptr_nonnull(factors->matrix.wall_wall);
    return factors;
}

static double between(const fibrad_bed_matrix *f, uint32_t b, uint32_t c) {
    return f->matrix.wall_wall[b * f->matrix.walls + c];
}

/* Area times emissivity of a sphere, and of a wall. If the emissivities are NULL, they are 1. */
static double emits(const struct bed *bed, const double *e, uint32_t i) {
    return 4 * PI * bed->r[i] * bed->r[i] * (e ? e[i] : 1);
}

static double wall_emits(const fibrad_bed_matrix *f, const double *e, uint32_t b) {
    return f->wall_area[b] * (e ? e[b] : 1);
}

/* Checks that rows of walls add up to 1 with what they send to spheres, as those of spheres do, and that they are
 * reciprocal. */
static void check_balance(const struct bed *bed, const fibrad_bed_matrix *f, const double *e, const double *wall_e) {
    const fibrad_factors *m = &f->matrix;
    for (uint32_t i = 0; i < m->n; i++)
        if (!e || e[i] > 0) ck_assert_double_eq_tol(matrix_total(m, i), 1, 1e-12);
    for (uint32_t b = 0; b < m->walls; b++) {
        const double emitted = wall_emits(f, wall_e, b);
        if (isinf(emitted)) {
            ck_assert(isnan(between(f, b, 0)) && isnan(m->wall_escaped[b]) && isnan(m->wall_error[b]));
            continue;
        }
        double sum = m->wall_escaped[b];
        for (uint32_t c = 0; c < m->walls; c++) {
            const double there = emitted * between(f, b, c), back = wall_emits(f, wall_e, c) * between(f, c, b);
            ck_assert_double_ge(between(f, b, c), 0);
            if (!isnan(back)) ck_assert_double_le(fabs(there - back), 4e-16 * (there + back));
            sum += between(f, b, c);
        }
        for (uint32_t i = 0; i < m->n && emitted > 0; i++)
            sum += emits(bed, e, i) * m->wall[(size_t)i * m->walls + b] / emitted;
        ck_assert_double_eq_tol(sum, emitted > 0, 1e-12);
    }
}

/* ---- closed forms: J. R. Howell, A catalog of radiation heat transfer configuration factors ---------------------- */

/* The view factor C-41 between discs of radius r at the distance h. */
static double discs(double r, double h) {
    const double x = 2 + h * h / (r * r);
    return (x - sqrt(x * x - 4)) / 2;
}

static const fibrad_beam_rule fine = {.tolerance = 3e-4};

/* The exchange between the sides of a box is known, except for what spheres take. Here spheres take nothing. */
TEST(empty_box) {
    struct bed none = bed_empty();
    const double size[3] = {1, 1.5, .6};
    fibrad_wall wall[6];
    for (int k = 0; k < 6; k++) wall[k] = plane_at(k / 2, k % 2, k % 2 * size[k / 2]);
    OWNED_FACTORS *f =
        factors_of(&none, &(fibrad_scene_config){.wall = wall, .walls = 6}, NULL, &(fibrad_bed_rule){.beam = &fine});
    check_balance(&none, f, NULL, NULL);
    for (uint32_t b = 0; b < 6; b++) {
        const uint32_t axis = b / 2;
        for (uint32_t c = 0; c < 6; c++) {
            const uint32_t along = (6 - axis - c / 2) % 3; /* the axis of the common edge, if there is one */
            const double exact = c == b          ? 0
                                 : c / 2 == axis ? opposite(size[(axis + 1) % 3], size[(axis + 2) % 3], size[axis])
                                                 : adjacent(size[along], size[c / 2], size[axis]);
            ck_assert_double_eq_tol(between(f, b, c), exact, 1e-14);
        }
        ck_assert_double_le(f->matrix.wall_error[b], 1e-14);
        ck_assert_double_eq(f->matrix.wall_escaped[b], 0);
    }
}

TEST(empty_cylinder) {
    const double r = 1.5, h = 2;
    for (int turn = 0; turn < 3; turn++) {
        struct bed none = bed_empty();
        const fibrad_wall wall[3] = {turned_wall(cylinder_at(3, -4, r), turn), turned_wall(plane_at(2, 0, 1), turn),
                                     turned_wall(plane_at(2, 1, 1 + h), turn)};
        OWNED_FACTORS *f = factors_of(&none, &(fibrad_scene_config){.wall = wall, .walls = 3}, NULL,
                                      &(fibrad_bed_rule){.beam = &fine});
        const double end_end = discs(r, h), side_end = r / (2 * h) * (1 - end_end);
        check_balance(&none, f, NULL, NULL);
        ck_assert_double_eq_tol(between(f, 1, 2), end_end, 4e-4);
        ck_assert_double_eq_tol(between(f, 1, 0), 1 - end_end, 4e-4);
        ck_assert_double_eq_tol(between(f, 0, 1), side_end, 4e-4);
        ck_assert_double_eq_tol(between(f, 0, 0), 1 - 2 * side_end, 4e-4);
    }
}

/* If walls are missing, what they would get escapes. With periods the box has no end. Walls without bounds have no
 * row. */
TEST(open_and_periodic) {
    struct bed none = bed_empty();
    const fibrad_wall box[] = {plane_at(0, 0, 0), plane_at(0, 1, 1), plane_at(1, 0, 0), plane_at(1, 1, 1),
                               plane_at(2, 0, 0)};
    const fibrad_plane lid = {2, 1, .6}, below = {2, 0, -1};
    const fibrad_scene_config open = {.wall = box, .walls = 5, .opening = &lid, .openings = 1};
    OWNED_FACTORS *f = factors_of(&none, &open, NULL, &(fibrad_bed_rule){.beam = &fine});
    check_balance(&none, f, NULL, NULL);
    for (uint32_t c = 0; c < 4; c++) ck_assert_double_eq_tol(between(f, 4, c), adjacent(1, 1, .6), 4e-4);
    ck_assert_double_eq_tol(f->matrix.wall_escaped[4], opposite(1, 1, .6), 4e-4);
    ck_assert_double_eq_tol(f->matrix.wall_escaped[0], adjacent(1, .6, 1), 4e-4);
    fibrad_bed_matrix_free(f);

    struct bed duct = bed_empty();
    duct.period[1] = .7;
    const fibrad_wall sides[] = {plane_at(0, 0, 0), plane_at(0, 1, 2), plane_at(2, 1, 1)};
    f = factors_of(&duct, &(fibrad_scene_config){.wall = sides, .walls = 3, .opening = &below, .openings = 1}, NULL,
                   &(fibrad_bed_rule){.beam = &fine});
    check_balance(&duct, f, NULL, NULL);
    ck_assert_double_eq_tol(f->wall_area[2], 1.4, 1e-14);
    ck_assert_double_eq_tol(f->matrix.wall_escaped[2], sqrt(2) - 1, 1e-3); /* crossed strings */
    ck_assert_double_eq_tol(between(f, 2, 0), 1 - sqrt(.5), 1e-3);
    fibrad_bed_matrix_free(f);

    struct bed plates = bed_empty();
    plates.period[0] = 3, plates.period[1] = .7;
    const fibrad_wall two[] = {plane_at(2, 0, 0), plane_at(2, 1, 2)};
    f = factors_of(&plates, &(fibrad_scene_config){.wall = two, .walls = 2}, NULL, &(fibrad_bed_rule){0});
    check_balance(&plates, f, NULL, NULL);
    ck_assert_double_eq_tol(between(f, 1, 0), 1, 1e-13);
    fibrad_bed_matrix_free(f);
    f = factors_of(&plates, &(fibrad_scene_config){.wall = two, .walls = 1}, NULL, &(fibrad_bed_rule){0});
    ck_assert_double_eq_tol(f->matrix.wall_escaped[0], 1, 1e-13);
    ck_assert_double_eq(between(f, 0, 0), 0);
}

/* Between grey plates D_12 = e_2/(1 - (1 - e_1)(1 - e_2)). D_11 is that with e_1 in place of e_2, times what plate 2
 * reflects. */
TEST(grey_plates) {
    struct bed plates = bed_empty();
    plates.period[0] = plates.period[1] = 1;
    const fibrad_wall two[] = {plane_at(2, 0, 0), plane_at(2, 1, 2)};
    const double e[2] = {.3, .6}, all = 1 - .7 * .4;
    const fibrad_exchange_rule rule = {.wall_emissivity = e, .paths = 40000};
    OWNED_FACTORS *f =
        factors_of(&plates, &(fibrad_scene_config){.wall = two, .walls = 2}, &rule, &(fibrad_bed_rule){0});
    check_balance(&plates, f, NULL, e);
    ck_assert_double_eq_tol(between(f, 0, 1), .6 / all, 3e-3);
    ck_assert_double_eq_tol(between(f, 0, 0), .4 * .3 / all, 3e-3);
    ck_assert_double_eq_tol(between(f, 1, 1), .7 * .6 / all, 3e-3);
}

/* ---- paths by other means: nothing of the kernel's --------------------------------------------------------------- */

struct room {
    struct bed bed;
    fibrad_wall wall[6];
    uint32_t walls;
    fibrad_plane opening;
    uint32_t openings;
    double low[3], high[3], radius; /* the cylinder stands about the z axis */
    double e[64], wall_e[6];
};

static void room_free(struct room *room) { bed_free(&room->bed); }

static double draw(uint64_t *state) { /* xorshift64* */
    *state ^= *state >> 12, *state ^= *state << 25, *state ^= *state >> 27;
    return (double)((*state * 0x2545F4914F6CDD1Du) >> 11) * 0x1p-53;
}

/* Makes a room. `kind` 0: box, 1: cylinder with ends, 2: floor and sides, open at the top. */
static struct room make_room(int kind, uint32_t n, uint64_t seed) {
    uint64_t state = 77 + 1000 * seed;
    struct room room = {.bed = bed_empty(), .radius = kind == 1 ? 3 : INFINITY};
    for (int k = 0; k < 20; k++) draw(&state);
    for (int a = 0; a < 3; a++) {
        room.low[a] = kind == 1 && a < 2 ? -3 : -1;
        room.high[a] = kind == 1 && a < 2 ? 3 : 3 + 2 * draw(&state);
    }
    for (int tries = 0; room.bed.n < n && tries < 100000; tries++) {
        double c[3], r = (.3 + .7 * draw(&state)) / (1 + .05 * room.bed.n), far = 0;
        for (int a = 0; a < 3; a++) c[a] = room.low[a] + r + (room.high[a] - room.low[a] - 2 * r) * draw(&state);
        if (kind == 1 && hypot(c[0], c[1]) + r > 3) continue;
        for (uint32_t j = 0; j < room.bed.n; j++) {
            const double d =
                sqrt(pow(c[0] - room.bed.x[j], 2) + pow(c[1] - room.bed.y[j], 2) + pow(c[2] - room.bed.z[j], 2));
            if (d < r + room.bed.r[j]) far = 1;
        }
        if (far == 0) add_sphere(&room.bed, c[0], c[1], c[2], r);
    }
    for (int a = kind == 1 ? 2 : 0; a < 3; a++)
        for (int upper = 0; upper < 2; upper++)
            if (kind != 2 || a < 2 || !upper)
                room.wall[room.walls++] = plane_at(a, upper, upper ? room.high[a] : room.low[a]);
    if (kind == 1) room.wall[room.walls++] = cylinder_at(0, 0, 3);
    if (kind == 2) room.opening = (fibrad_plane){2, 1, room.high[2]}, room.openings = 1;
    for (uint32_t i = 0; i < 64; i++) room.e[i] = .2 + .8 * draw(&state);
    for (uint32_t b = 0; b < 6; b++) room.wall_e[b] = .2 + .8 * draw(&state);
    return room;
}

static void normal_of(const fibrad_wall *wall, const double o[3], double n[3]) {
    n[0] = n[1] = n[2] = 0;
    if (wall->kind == FIBRAD_WALL_CYLINDER)
        n[0] = -o[0] / wall->cylinder.radius, n[1] = -o[1] / wall->cylinder.radius;
    else
        n[wall->plane.axis] = wall->plane.upper ? -1 : 1;
}

/* The wall that a ray meets, and its distance. If the ray meets none: -1 and infinity. */
static int wall_ahead(const struct room *room, const double o[3], const double w[3], double *distance) {
    int met = -1;
    *distance = INFINITY;
    for (uint32_t b = 0; b < room->walls; b++) {
        const fibrad_wall *wall = &room->wall[b];
        const int axis = wall->plane.axis;
        double t = INFINITY;
        if (wall->kind == FIBRAD_WALL_CYLINDER) {
            const double a = w[0] * w[0] + w[1] * w[1], h = o[0] * w[0] + o[1] * w[1];
            t = (sqrt(fmax(0, h * h - a * (o[0] * o[0] + o[1] * o[1] - 9))) - h) / a;
        } else if (w[axis] * (wall->plane.upper ? 1 : -1) > 0) {
            t = fmax(0, (wall->plane.at - o[axis]) / w[axis]);
        }
        if (t < *distance) *distance = t, met = (int)b;
    }
    if (room->openings == 0 || !(w[2] > 0) || (room->high[2] - o[2]) / w[2] > *distance) return met;
    *distance = (room->high[2] - o[2]) / w[2];
    return -1;
}

/* Follows one path from a wall. Adds to got[] what walls absorb, to got[walls] what escapes, and to got[walls + 1] what
 * spheres absorb. */
static void follow(const struct room *room, uint32_t b, uint64_t *state, double *got) {
    const fibrad_wall *from = &room->wall[b];
    double o[3], n[3], w[3];
    const double turn = 2 * PI * draw(state), share = draw(state);
    const double radius = from->kind == FIBRAD_WALL_CYLINDER ? 3 : 3 * sqrt(share);
    for (int a = 0; a < 3; a++) o[a] = room->low[a] + (room->high[a] - room->low[a]) * draw(state);
    if (room->radius < INFINITY) o[0] = radius * cos(turn), o[1] = radius * sin(turn);
    if (from->kind == FIBRAD_WALL_PLANE) o[from->plane.axis] = from->plane.at;
    normal_of(from, o, n);
    for (;;) {
        double square = 0, nearest;
        const double up = 2 * draw(state) - 1, around = 2 * PI * draw(state), ring = sqrt(1 - up * up);
        w[0] = n[0] + ring * cos(around), w[1] = n[1] + ring * sin(around), w[2] = n[2] + up;
        for (int a = 0; a < 3; a++) square += w[a] * w[a];
        for (int a = 0; a < 3; a++) w[a] /= sqrt(square);
        const int wall = wall_ahead(room, o, w, &nearest);
        int sphere = -1;
        for (uint32_t i = 0; i < room->bed.n; i++) {
            const double c[3] = {o[0] - room->bed.x[i], o[1] - room->bed.y[i], o[2] - room->bed.z[i]};
            const double h = c[0] * w[0] + c[1] * w[1] + c[2] * w[2], r = room->bed.r[i];
            const double d = h * h - (c[0] * c[0] + c[1] * c[1] + c[2] * c[2] - r * r);
            if (d > 0 && h < 0 && -h - sqrt(d) > -1e-9 && -h - sqrt(d) < nearest)
                nearest = -h - sqrt(d), sphere = (int)i;
        }
        if (sphere < 0 && wall < 0) {
            got[room->walls]++;
            return;
        }
        if (draw(state) < (sphere >= 0 ? room->e[sphere] : room->wall_e[wall])) {
            got[sphere >= 0 ? room->walls + 1 : (uint32_t)wall]++;
            return;
        }
        for (int a = 0; a < 3; a++) o[a] += nearest * w[a];
        if (sphere >= 0) {
            n[0] = (o[0] - room->bed.x[sphere]) / room->bed.r[sphere];
            n[1] = (o[1] - room->bed.y[sphere]) / room->bed.r[sphere];
            n[2] = (o[2] - room->bed.z[sphere]) / room->bed.r[sphere];
        } else {
            normal_of(&room->wall[wall], o, n);
        }
    }
}

/* Grey rooms have few or many spheres. Rows of walls are those of plain paths within the noise of these and the stated
 * error. The balances hold, and the correction is small. */
LOOP_TEST(against_plain_walls, 6) {
    enum { PATHS = 150000 };
    OWNED_BY(room_free) struct room room = make_room(_i % 3, _i < 3 ? 3 : 25, (uint64_t)_i);
    const bool black = _i % 2 != 0;
    const fibrad_exchange_rule rule = {
        .emissivity = room.e, .wall_emissivity = room.wall_e, .directions = 400, .paths = 4000};
    if (black)
        for (uint32_t k = 0; k < 64; k++) room.e[k] = room.wall_e[k % 6] = 1;
    const fibrad_scene_config config = {
        .wall = room.wall, .walls = room.walls, .opening = &room.opening, .openings = room.openings};
    OWNED_FACTORS *f = factors_of(&room.bed, &config, black ? NULL : &rule, &(fibrad_bed_rule){0});
    const fibrad_factors *m = &f->matrix;
    uint64_t state = 4711;
    check_balance(&room.bed, f, black ? NULL : room.e, black ? NULL : room.wall_e);
    ck_assert_double_lt(m->wall_correction, .02);
    for (uint32_t b = 0; b < room.walls; b++) {
        double got[8] = {0}, square = 0, noise = 0;
        if (isinf(f->wall_area[b])) continue;
        for (int k = 0; k < PATHS; k++) follow(&room, b, &state, got);
        for (uint32_t c = 0; c <= room.walls; c++) {
            const double truth = got[c] / PATHS, d = c < room.walls ? between(f, b, c) : m->wall_escaped[b];
            square += pow(d - truth, 2);
            noise += truth * (1 - truth) / PATHS;
        }
        ck_assert_double_lt(square, 4 * (noise + m->wall_error[b] * m->wall_error[b]));
        ck_assert_double_lt(m->wall_error[b], .01);
    }
}

/* A bed fills the space between black plates. The plates see next to nothing of each other. This cannot be told from
 * the power that spheres leave over. */
TEST(plates_and_a_dense_bed) {
    OWNED_BED bed = packing(400, .5, 1, .55, 4, true);
    const double top = bed.period[2];
    bed.period[2] = 0;
    const fibrad_wall two[] = {plane_at(2, 0, -.5), plane_at(2, 1, top + .5)};
    const fibrad_scene_config config = {.wall = two, .walls = 2};
    OWNED_FACTORS *f = factors_of(&bed, &config, NULL, &(fibrad_bed_rule){0});
    check_balance(&bed, f, NULL, NULL);
    ck_assert_double_lt(between(f, 0, 1), 1e-3);
    ck_assert_double_eq(between(f, 0, 0), 0);
    ck_assert_double_lt(f->matrix.wall_correction, 1e-2); /* plates cut spheres by half a radius at most */
    OWNED_FACTORS *alone = NULL;
    fibrad_scene_config whole = config;
    const fibrad_spheres spheres = spheres_of(&bed);
    memcpy(whole.period, bed.period, sizeof whole.period);
    assert_ok(fibrad_view_factors(&whole, &spheres, NULL, NULL, &alone));
    ck_assert_ptr_null(alone->matrix.wall_wall);
    for (uint32_t i = 0; i < bed.n; i++) { /* the factors between spheres are the same within their error */
        fibrad_row with = matrix_row(&f->matrix, i), without = matrix_row(&alone->matrix, i);
        ck_assert_double_lt(row_distance(&with, &without), 2 * alone->matrix.error[i] + 1e-6);
    }
}

/* The two ends of a flat cylinder see little but each other, and so do plates. The sums still add up. */
TEST(flat_rooms) {
    OWNED_BED bed = BED({1, 2, .02, .015}, {-9, 4, .021, .019});
    const fibrad_wall tube[3] = {cylinder_at(0, 0, 80), plane_at(2, 0, 0), plane_at(2, 1, .04)};
    OWNED_FACTORS *f = factors_of(&bed, &(fibrad_scene_config){.wall = tube, .walls = 3}, NULL, &(fibrad_bed_rule){0});
    check_balance(&bed, f, NULL, NULL);
    ck_assert_double_eq_tol(between(f, 1, 2), discs(80, .04), 1e-4);
    fibrad_bed_matrix_free(f);
    bed.period[0] = 23, bed.period[1] = 16;
    f = factors_of(&bed, &(fibrad_scene_config){.wall = tube + 1, .walls = 2}, NULL, &(fibrad_bed_rule){0});
    check_balance(&bed, f, NULL, NULL);
    ck_assert_double_eq_tol(between(f, 0, 1), 1, 1e-4);
}

/* Reflectors have empty rows, and nothing goes to them. Walls in another order have the same rows but for noise, and
 * so has a room that is laid on its side. */
TEST(other_orders_and_axes) {
    OWNED_BY(room_free) struct room room = make_room(0, 12, 5);
    room.wall_e[3] = 0, room.e[2] = 0;
    const fibrad_exchange_rule rule = {
        .emissivity = room.e, .wall_emissivity = room.wall_e, .directions = 300, .paths = 4000};
    OWNED_FACTORS *f =
        factors_of(&room.bed, &(fibrad_scene_config){.wall = room.wall, .walls = 6}, &rule, &(fibrad_bed_rule){0});
    check_balance(&room.bed, f, room.e, room.wall_e);
    for (uint32_t b = 0; b < 6; b++)
        ck_assert(between(f, 3, b) == 0 && between(f, b, 3) == 0 && f->matrix.wall_escaped[3] == 0);

    OWNED_BED turned = bed_empty();
    fibrad_wall wall[6];
    double wall_e[6];
    for (uint32_t i = 0; i < room.bed.n; i++)
        add_sphere(&turned, room.bed.z[i], room.bed.y[i], room.bed.x[i], room.bed.r[i]);
    for (uint32_t b = 0; b < 6; b++) { /* wall b becomes 5 - b, and x becomes z */
        wall[5 - b] = room.wall[b];
        wall[5 - b].plane.axis = 2 - room.wall[b].plane.axis;
        wall_e[5 - b] = room.wall_e[b];
    }
    const fibrad_exchange_rule turned_rule = {
        .emissivity = room.e, .wall_emissivity = wall_e, .directions = 300, .paths = 4000};
    OWNED_FACTORS *g =
        factors_of(&turned, &(fibrad_scene_config){.wall = wall, .walls = 6}, &turned_rule, &(fibrad_bed_rule){0});
    check_balance(&turned, g, room.e, wall_e);
    for (uint32_t b = 0; b < 6; b++) {
        double square = 0;
        for (uint32_t c = 0; c < 6; c++) square += pow(between(f, b, c) - between(g, 5 - b, 5 - c), 2);
        ck_assert_double_le(sqrt(square), 2 * (f->matrix.wall_error[b] + g->matrix.wall_error[5 - b]));
    }
}

/* A tolerance that is asked for is kept, and raw rows are what the paths say. */
TEST(tolerance_and_raw_rows) {
    OWNED_BY(room_free) struct room room = make_room(0, 6, 9);
    const fibrad_scene_config config = {.wall = room.wall, .walls = 6};
    fibrad_exchange_rule rule = {.emissivity = room.e, .wall_emissivity = room.wall_e, .tolerance = 2e-3};
    OWNED_FACTORS *f = factors_of(&room.bed, &config, &rule, &(fibrad_bed_rule){0});
    rule.tolerance = 0, rule.paths = 6000, rule.directions = 1000, rule.seed = 5;
    OWNED_FACTORS *truth = factors_of(&room.bed, &config, &rule, &(fibrad_bed_rule){0});
    OWNED_FACTORS *raw = factors_of(&room.bed, &config, &rule, &(fibrad_bed_rule){.raw = 1});
    ck_assert_double_eq(raw->matrix.wall_correction, 0);
    for (uint32_t b = 0; b < 6; b++) {
        double square = 0, of_raw = 0;
        for (uint32_t c = 0; c < 6; c++) {
            square += pow(between(f, b, c) - between(truth, b, c), 2);
            of_raw += pow(between(raw, b, c) - between(truth, b, c), 2);
        }
        ck_assert_double_lt(sqrt(square), 4e-3);
        ck_assert_double_lt(sqrt(of_raw), 3 * raw->matrix.wall_error[b] + 1e-3);
        ck_assert_double_lt(raw->matrix.wall_error[b], 5e-3);
    }
}

/* The rows have the same bits for any number of threads and any instruction set. */
TEST(same_bits_of_walls) {
    OWNED_BY(room_free) struct room room = make_room(1, 12, 3);
    const fibrad_exchange_rule rule = {.emissivity = room.e, .wall_emissivity = room.wall_e};
    const fibrad_spheres spheres = spheres_of(&room.bed);
    OWNED_FACTORS *first = NULL;
    const struct isas isas = isas_there();
    for (int k = 0; k < isas.count; k++) {
        const fibrad_scene_config config = {.isa = isas.set[k], .wall = room.wall, .walls = room.walls};
        fibrad_run run = {.threads = 1 + k};
        fibrad_bed_matrix *f;
        assert_ok(exchange_of(&config, &spheres, &rule, &(fibrad_bed_rule){.walls = 1}, &run, &f));
        if (first) {
            ck_assert(matrix_same_bits(&f->matrix, &first->matrix));
            ck_assert_mem_eq(f->matrix.wall_wall, first->matrix.wall_wall, 9 * sizeof(double));
            ck_assert_mem_eq(f->matrix.wall_escaped, first->matrix.wall_escaped, 3 * sizeof(double));
            ck_assert_mem_eq(f->matrix.wall_error, first->matrix.wall_error, 3 * sizeof(double));
            fibrad_bed_matrix_free(f);
        } else {
            first = f;
        }
    }
}

TEST(bad_arguments_of_walls) {
    OWNED_BY(room_free) struct room room = make_room(2, 3, 1);
    const fibrad_scene_config config = {
        .wall = room.wall, .walls = room.walls, .opening = &room.opening, .openings = room.openings};
    OWNED fibrad_scene *scene = scene_with(&room.bed, &config);
    OWNED fibrad_scene *endless = scene_with(&room.bed, &(fibrad_scene_config){.wall = room.wall, .walls = 1});
    OWNED_WORK work = work_growing();
    fibrad_wall_row row, part[FIBRAD_WALL_PARTS];
    memset(part, 0, sizeof part);
    fibrad_wall_rule rule = {.emissivity = room.e, .wall_emissivity = room.wall_e};
    assert_ok(fibrad_exchange_wall(scene, &work, 4, &rule, 0, &row, NULL)); /* the floor */
    ck_assert_double_eq_tol(
        row.spheres + row.escaped + row.wall[0] + row.wall[1] + row.wall[2] + row.wall[3] + row.wall[4], 1, 1e-13);
    row.rays = 7;
    assert_invalid(fibrad_exchange_wall(NULL, &work, 4, &rule, 0, &row, NULL));
    assert_invalid(fibrad_exchange_wall(scene, NULL, 4, &rule, 0, &row, NULL));
    assert_invalid(fibrad_exchange_wall(scene, &work, 4, NULL, 0, &row, NULL));
    assert_invalid(fibrad_exchange_wall(scene, &work, 4, &rule, 0, NULL, NULL));
    assert_invalid(fibrad_exchange_wall(scene, &work, 5, &rule, 0, &row, NULL));
    assert_invalid(fibrad_exchange_wall(scene, &work, 4, &rule, FIBRAD_WALL_PARTS, &row, NULL));
    ck_assert_int_eq(fibrad_exchange_wall(endless, &work, 0, &rule, 0, &row, NULL), FIBRAD_E_UNSUPPORTED);
    room.wall_e[1] = 1.5;
    assert_invalid(fibrad_exchange_wall(scene, &work, 4, &rule, 0, &row, NULL));
    room.wall_e[1] = NAN;
    assert_invalid(fibrad_exchange_wall(scene, &work, 4, &rule, 0, &row, NULL));
    ck_assert_uint_eq(row.rays, 7);
    assert_invalid(fibrad_exchange_wall_mean(NULL, &row));
    assert_invalid(fibrad_exchange_wall_mean(part, NULL));
    fibrad_wall_row walls[5];
    memset(walls, 0, sizeof walls);
    fibrad_matrix_rule how = {.wall_row = walls};
    OWNED_ROWS rows = {.memory = memory_growing()};
    ck_assert_uint_gt(fibrad_matrix_size(scene, &rows, 1, &how), 0);
    walls[4].wall[2] = NAN;
    ck_assert_uint_eq(fibrad_matrix_size(scene, &rows, 1, &how), 0);
    walls[4].wall[2] = 0, walls[4].error = -1;
    ck_assert_uint_eq(fibrad_matrix_size(scene, &rows, 1, &how), 0);
}

/* Paths end in an opening as they do at a black plane. This holds for rows of spheres and walls, and for what is
 * carried. */
TEST(paths_end_in_openings) {
    OWNED_BY(room_free) struct room room = make_room(2, 12, 5);
    room.wall[5] = plane_at(2, 1, room.opening.at), room.wall_e[5] = 1;
    const fibrad_scene_config open = {.wall = room.wall, .walls = 5, .opening = &room.opening, .openings = 1};
    fibrad_scene *scene[2] = {scene_with(&room.bed, &open),
                              scene_with(&room.bed, &(fibrad_scene_config){.wall = room.wall, .walls = 6})};
    const fibrad_exchange_rule rule = {.emissivity = room.e, .wall_emissivity = room.wall_e};
    OWNED_WORK work = work_growing();
    for (uint32_t k = 0; k < 10; k++) {
        const uint32_t b = k / 2;
        const fibrad_wall_rule how = k % 2 ? wall_rule(&rule) : (fibrad_wall_rule){0};
        fibrad_wall_row row[2];
        for (int with = 0; with < 2; with++)
            assert_ok(fibrad_exchange_wall(scene[with], &work, b, &how, b, &row[with], NULL));
        ck_assert_mem_eq(row[0].wall, row[1].wall, 5 * sizeof(double));
        ck_assert(row[0].spheres == row[1].spheres && row[0].rays == row[1].rays);
        ck_assert(row[1].wall[5] > 0);
        ck_assert_double_eq_tol(row[0].escaped, row[1].wall[5], 1e-15);
    }
    for (uint32_t i = 0; i < room.bed.n; i++) {
        fibrad_row row[2] = {row_of(64), row_of(64)};
        fibrad_displacement carried[2];
        for (int k = 0; k < 2; k++) {
            assert_ok(fibrad_exchange_row(scene[k], &work, i, &rule, &row[k], NULL));
            assert_ok(displacement_of(scene[k], &work, i, &rule, &carried[k]));
        }
        ck_assert_mem_eq(&carried[0], &carried[1], sizeof carried[0]);
        ck_assert_double_eq_tol(row[0].escaped, row[1].wall[5], 1e-15);
        ck_assert_mem_eq(row[0].wall, row[1].wall, 5 * sizeof(double));
        ck_assert_double_le(row_distance(&row[0], &row[1]), 0);
        row_free(&row[0]), row_free(&row[1]);
    }
    free(scene[0]), free(scene[1]);
}

/* A sphere stands in a box, and the rows of walls send all to it. But the sphere can give each wall only its share of
 * its own area. So no matrix is reciprocal and closed. Rows of walls stay as they are, and the result says so. */
TEST(rows_that_contradict_each_other) {
    OWNED_BED bed = BED({0, 0, 0, 1});
    fibrad_wall wall[6];
    fibrad_wall_row wall_row[6];
    for (int b = 0; b < 6; b++) wall[b] = plane_at(b / 2, b % 2, b % 2 ? 2 : -2);
    for (int b = 0; b < 6; b++) wall_row[b] = (fibrad_wall_row){.spheres = 1, .error = 1e-3};
    OWNED fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.wall = wall, .walls = 6});
    OWNED_WORK work = work_growing();
    OWNED_ROWS rows = {.memory = memory_growing()};
    fibrad_row row = {.rows = &rows};
    assert_ok(fibrad_beam_row(scene, &work, 0, NULL, &row));
    for (int closed = 0; closed < 2; closed++) { /* walls send each other what is left over, or nothing */
        const fibrad_matrix_rule rule = {.wall_row = wall_row};
        const double left = 1 - 4 * PI / 6 / 16, between = closed ? left / 5 : 0;
        for (int b = 0; b < 36; b++) wall_row[b / 6].wall[b % 6] = b % 7 == 0 ? 0 : between;
        const size_t size = fibrad_matrix_size(scene, &rows, 1, &rule);
        OWNED void *block = malloc(size);
        fibrad_matrix *matrix;
        fibrad_factors f;
        assert_ok(fibrad_matrix_init(&matrix, block, size, scene, &rows, 1, &rule, NULL));
        assert_ok(fibrad_matrix_close(matrix));
        assert_ok(fibrad_matrix_read(matrix, &f));
        ck_assert_double_eq_tol(matrix_total(&f, 0), 1, 1e-12);
        double worst = 0;
        for (int b = 0; b < 6; b++) {
            double sum = f.wall_escaped[b] + 4 * PI * f.wall[b] / 16;
            for (int c = 0; c < 6; c++) sum += f.wall_wall[6 * b + c];
            worst = fmax(worst, fabs(sum - 1));
            for (int c = 0; c < 6 && !closed; c++) ck_assert_double_eq(f.wall_wall[6 * b + c], 0);
        }
        ck_assert_double_eq_tol(f.wall_closure, worst, 1e-12);
        if (!closed) ck_assert_double_eq_tol(worst, left, .01);
        if (closed) ck_assert_double_lt(worst, 1e-12);
        ck_assert_double_ge(f.wall_correction + 1e-12, f.wall_closure);
    }
}

/* A square of two triangles has images above and below it. Each side sees the sides that face it, also that of its own
 * triangle. */
TEST(a_plate_and_its_images) {
    enum { EDGE = 4 };
    OWNED struct mesh *mesh = mesh_new();
    const uint32_t v[4] = {mesh_vertex(mesh, 0, 0, .5), mesh_vertex(mesh, EDGE, 0, .5),
                           mesh_vertex(mesh, EDGE, EDGE, .5), mesh_vertex(mesh, 0, EDGE, .5)};
    mesh_quad(mesh, v, 0, 0);
    OWNED_BED bed = BED({100, 0, 1, 1e-3});
    bed.period[2] = 3;
    const fibrad_scene_config config = {.wall = mesh->wall, .walls = 1, .triangles = &mesh->triangles};
    OWNED_FACTORS *f =
        factors_of(&bed, &config, NULL, &(fibrad_bed_rule){.beam = &(fibrad_beam_rule){.directions = 1000}});
    ck_assert_double_eq_tol(between(f, 0, 0), opposite(EDGE, EDGE, 3), 6e-3);
}

/* In a periodic box, triangles that lie across it face their images. What spheres send to them by beams equals what
 * they send to spheres by paths. */
TEST(triangles_face_their_images) {
    OWNED struct mesh *mesh = mesh_new();
    OWNED_BED bed = BED({2, 2, 3, .9}, {7, 3, 6, .7}, {4, 7, 1, .8});
    for (int axis = 0; axis < 3; axis++) bed.period[axis] = 9;
    mesh_triangle(mesh, mesh_vertex(mesh, 1, 8, 1), mesh_vertex(mesh, 8, 5, 2), mesh_vertex(mesh, 3, 1, 8), 0, 0);
    const fibrad_scene_config config = {.wall = mesh->wall, .walls = 1, .triangles = &mesh->triangles};
    OWNED_FACTORS *f =
        factors_of(&bed, &config, NULL, &(fibrad_bed_rule){.beam = &(fibrad_beam_rule){.directions = 1000}});
    check_balance(&bed, f, NULL, NULL);
    ck_assert_double_gt(between(f, 0, 0), .3);
    ck_assert_double_lt(f->matrix.wall_correction, .02);
}
