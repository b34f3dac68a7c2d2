/* test_exchange_error.c - errors of whole rows of exchange factors, walls and surroundings included.
 * SPDX-License-Identifier: MIT */
#include "host_owned.h"
#include "scenes.h"
#include "suite.h"

enum { MOST = 15, WALLS = 6 };

/* A room with spheres, and the emissivities of spheres and walls. Its walls are a floor and either a cylinder or
 * planes. */
struct room {
    uint32_t spheres, walls;
    double low, high, wall; /* emissivities: of spheres, from low to high; of walls */
};

/* An open box, a cup, and two closed boxes. */
static const struct room rooms[] = {{8, 5, .3, .8, .02}, {15, 2, .6, .9, .5}, {12, 6, .1, .5, .3}, {6, 6, .8, .8, .1}};

/* Computes the matrix of a room. */
static fibrad_bed_matrix *factors_of(const struct room *room, double tolerance, uint64_t seed) {
    static const int axis[WALLS] = {2, 0, 0, 1, 1, 2}, upper[WALLS] = {0, 0, 1, 0, 1, 1};
    double emissivity[MOST], wall_emissivity[WALLS];
    fibrad_wall wall[WALLS];
    const fibrad_plane lid = {2, 1, 4.5};
    OWNED_BED bed = bed_empty();
    for (uint32_t i = 0; i < room->spheres; i++) {
        add_sphere(&bed, 1.3 * (i % 2) - .65 + .2 * bed_make_random(7, i), 1.3 * (i / 2 % 2) - .65, .6 + 1.05 * (i / 4),
                   .3 + .2 * bed_make_random(9, i));
        emissivity[i] = room->low + (room->high - room->low) * bed_make_random(10, i);
    }
    for (uint32_t k = 0; k < room->walls; k++) {
        wall[k] = plane_at(axis[k], upper[k], k == 0 ? 0 : k == 5 ? 4.5 : upper[k] ? 2 : -2);
        wall_emissivity[k] = room->wall;
    }
    if (room->walls == 2) wall[1] = (fibrad_wall){.kind = FIBRAD_WALL_CYLINDER, .cylinder = {0, 0, 2, 2}};
    const bool open = room->walls == 2 || room->walls == 5;
    const fibrad_scene_config scene = {.wall = wall, .walls = room->walls, .opening = &lid, .openings = open};
    const fibrad_exchange_rule rule = {
        .emissivity = emissivity, .wall_emissivity = wall_emissivity, .tolerance = tolerance, .seed = seed};
    const fibrad_spheres spheres = spheres_of(&bed);
    fibrad_bed_matrix *factors = NULL;
    assert_ok(exchange_of(&scene, &spheres, &rule, NULL, NULL, &factors));
    return factors;
}

/* A row of a matrix, walls and surroundings included. */
static void read_row(const fibrad_factors *m, uint32_t i, double row[MOST + WALLS + 1]) {
    memset(row, 0, (MOST + WALLS + 1) * sizeof *row);
    for (uint64_t k = m->start[i]; k < m->start[i + 1]; k++) row[m->col[k]] = m->f[k];
    for (uint32_t b = 0; b < m->walls; b++) row[MOST + b] = m->wall[(size_t)i * m->walls + b];
    row[MOST + WALLS] = m->escaped[i];
}

static double row_error(const fibrad_factors *found, const fibrad_factors *right, uint32_t i) {
    double a[MOST + WALLS + 1], b[MOST + WALLS + 1], square = 0;
    read_row(found, i, a), read_row(right, i, b);
    for (int k = 0; k < MOST + WALLS + 1; k++) square += (a[k] - b[k]) * (a[k] - b[k]);
    return sqrt(square);
}

/* Rows keep the error that is allowed, and estimates know their errors. The matrix that is taken as right errs by a
 * tenth to a half of what is allowed. */
LOOP_TEST(rows_keep_their_tolerance, by_night(4, 3)) {
    static const double allowed[] = {.01, .005};
    OWNED_FACTORS *right = factors_of(&rooms[_i], .003, 99);
    int beyond = 0;
    for (int k = 0; k < 2; k++) {
        OWNED_FACTORS *found = factors_of(&rooms[_i], allowed[k], 1);
        for (uint32_t i = 0; i < rooms[_i].spheres; i++) {
            const double error = row_error(&found->matrix, &right->matrix, i);
            ck_assert_double_le(found->matrix.error[i], allowed[k]);
            ck_assert_msg(error < 1.4 * allowed[k], "row %d: %g for %g", (int)i, error, allowed[k]);
            beyond += error > 2 * found->matrix.error[i];
        }
    }
    ck_assert_int_le(20 * beyond, (int)(2 * rooms[_i].spheres));
}
