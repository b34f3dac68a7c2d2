/* wall_row.c - what absorbs the emission of a wall, by paths. SPDX-License-Identifier: MIT
 *
 * The paths come in parts. Each part begins at evenly spread points, which are moved at random, part by part. So the
 * spread of the parts tells the error of their mean. */
#include "exchange/paths.h"
#include "row/row.h"

/* slot: out, of the wall or opening */
static int wall_begin(const fibrad_scene *scene, uint32_t wall, const fibrad_wall_rule *rule, uint32_t part,
                      double wall_emissivity[FIBRAD_SLOTS], uint32_t *slot) {
    if (scene == NULL || rule == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(scene)) return FIBRAD_E_STATE;
    if (rule->node_emissivity != NULL && (rule->emissivity == NULL || rule->conductivity == NULL))
        return FIBRAD_E_ARGUMENT;
    *slot = fibrad_wall_slot(scene, wall);
    if (*slot == FIBRAD_NONE || part >= FIBRAD_WALL_PARTS || rule->paths > FIBRAD_PATHS_MAX) return FIBRAD_E_ARGUMENT;
    const int status = fibrad_paths_emissivities(scene, rule->wall_emissivity, wall_emissivity);
    if (status != FIBRAD_OK) return status;
    return fibrad_finite(scene->wall_area[*slot]) ? FIBRAD_OK : FIBRAD_E_UNSUPPORTED;
}

/* Whether the walls and openings are the six sides of a box, and there is no other wall. */
static bool is_box(const fibrad_scene *scene) {
    bool box = true;
    for (uint32_t b = 0; b < scene->facts.walls; b++) box = box && scene->slot[b] < FIBRAD_CYLINDER;
    for (uint32_t slot = 0; slot < FIBRAD_CYLINDER; slot++) box = box && scene->wall_area[slot] > 0;
    return box;
}

/* The view factor between two opposite sides of an empty box. Each side has the edges x and y, and their distance is 1.
 * Source: Siegel, Howell, Thermal Radiation Heat Transfer, configuration C-11. */
static double factor_of_opposite(double x, double y) {
    const double lx = fibrad_sqrt(1 + x * x), ly = fibrad_sqrt(1 + y * y);
    const double log = fibrad_log(lx * ly / fibrad_sqrt(1 + x * x + y * y));
    const double sum = log + x * ly * fibrad_quarter_angle(ly, x) + y * lx * fibrad_quarter_angle(lx, y) -
                       x * fibrad_quarter_angle(1, x) - y * fibrad_quarter_angle(1, y);
    return 2 / (FIBRAD_PI * x * y) * sum;
}

/* The view factors from a side of an empty box to each side. A side sends to the four sides beside it what it does not
 * send to the side opposite. These remainders of all three pairs of sides determine the factors between neighbours. */
static void shares_in_empty_box(const fibrad_scene *scene, uint32_t from, double share[FIBRAD_CYLINDER]) {
    const fibrad_container *c = &scene->container;
    const uint32_t own = fibrad_face_axis(from);
    double area[3], opposite[3], beside[3];
    for (uint32_t axis = 0; axis < 3; axis++) {
        const uint32_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        const double across = c->high[axis] - c->low[axis];
        area[axis] = (c->high[u] - c->low[u]) * (c->high[v] - c->low[v]);
        opposite[axis] = factor_of_opposite((c->high[u] - c->low[u]) / across, (c->high[v] - c->low[v]) / across);
        beside[axis] = area[axis] * (1 - opposite[axis]);
    }
    share[from] = 0, share[fibrad_face_opposite(from)] = opposite[own];
    for (uint32_t turn = 1; turn < 3; turn++) {
        const uint32_t axis = (own + turn) % 3, third = 3 - own - axis;
        const double each = fibrad_max(0, (beside[own] + beside[axis] - beside[third]) / (4 * area[own]));
        share[fibrad_face(axis, false)] = share[fibrad_face(axis, true)] = each;
    }
}

/* An empty box would give a known fraction to each wall. Of the paths towards that wall spheres have stopped a
 * fraction. Spheres get this fraction of the known fraction, and the wall gets the rest. */
static void share_out_box(fibrad_paths *paths, double followed) {
    double share[FIBRAD_CYLINDER];
    shares_in_empty_box(paths->tracer->scene, paths->from, share);
    for (uint32_t k = 0; k < FIBRAD_CYLINDER; k++) {
        const double all = paths->wall[k] + paths->behind[k], kept = all > 0 ? paths->behind[k] / all : 0;
        paths->absorbed += followed * share[k] * kept;
        paths->wall[k] = followed * share[k] * (1 - kept);
    }
}

/* The row that paths give. */
static int row_of_paths(const fibrad_scene *scene, fibrad_paths *paths, uint64_t followed, fibrad_wall_row *row) {
    if (paths->back != UINT32_MAX) return FIBRAD_E_BACK;
    if (paths->boxed) share_out_box(paths, (double)followed);
    const double sum = fibrad_paths_sum(paths);
    if (!fibrad_finite(sum)) return FIBRAD_E_ARGUMENT; /* a path met an emissivity that is NaN */
    *row = (fibrad_wall_row){.rays = paths->rays, .paths = followed};
    row->error = paths->left > 0 ? paths->left / (paths->left + sum) : 0;
    if (sum == 0) {
        row->escaped = 1;
        return FIBRAD_OK;
    }
    row->spheres = paths->absorbed / sum;
    row->escaped = (paths->escaped + paths->beyond) / sum;
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++)
        if (fibrad_is_opening(&scene->container, k)) row->escaped += paths->wall[k] / sum;
    double all = row->spheres + row->escaped;
    for (uint32_t b = 0; b < scene->facts.walls; b++) all += row->wall[b] = paths->wall[scene->slot[b]] / sum;
    return fibrad_sum_checked(all);
}

int fibrad_exchange_wall(const fibrad_scene *scene, fibrad_work *work, uint32_t wall, const fibrad_wall_rule *rule,
                         uint32_t part, fibrad_wall_row *row, uint64_t *reflected) {
    double wall_emissivity[FIBRAD_SLOTS] = {0};
    fibrad_workspace *space;
    fibrad_wall_row own = {0};
    uint32_t slot;
    int status = wall_begin(scene, wall, rule, part, wall_emissivity, &slot);
    if (status == FIBRAD_OK && (work == NULL || row == NULL)) status = FIBRAD_E_ARGUMENT;
    if (status == FIBRAD_OK)
        status = fibrad_work_open(work, scene, fibrad_tracer_least(), fibrad_tracer_best(scene), &space);
    if (status != FIBRAD_OK) return status;
    if (wall_emissivity[slot] == 0) {
        *row = own;
        return FIBRAD_OK;
    }

    const bool nodes = rule->node_emissivity != NULL, black = rule->emissivity == NULL && rule->wall_emissivity == NULL;
    fibrad_sobol sobol;
    fibrad_sobol_make(&sobol);
    const uint32_t wanted = rule->paths > 0 ? rule->paths : FIBRAD_WALL_PATHS_DEFAULT;
    const uint32_t count = (wanted + FIBRAD_WALL_PARTS - 1) / FIBRAD_WALL_PARTS;
    const uint64_t turn = (uint64_t)slot * FIBRAD_WALL_PARTS + part; /* streams of walls count down, those of ids up */
    fibrad_paths none = {.tracer = fibrad_tracer_of(space, scene), .place = FIBRAD_NONE, .from = slot, .sobol = &sobol};
    none.emissivity = nodes ? rule->node_emissivity : rule->emissivity, none.surface = rule->emissivity;
    none.conductivity = nodes ? rule->conductivity : NULL, none.wall_emissivity = wall_emissivity;
    none.boxed = black && is_box(scene), none.stream = fibrad_random_start(rule->seed, UINT64_MAX - turn);
    none.first = true, none.reflected = reflected, none.back = UINT32_MAX;
    fibrad_paths paths = none;
    const uint64_t followed = fibrad_paths_begin(&paths, count);
    work->triangle = paths.back;
    status = row_of_paths(scene, &paths, followed, &own);
    if (status == FIBRAD_OK)
        *row = own;
    else if (reflected != NULL) { /* the same paths take back what they have added */
        paths = none, paths.undo = true;
        fibrad_paths_begin(&paths, count);
    }
    return status;
}

/* By chance a factor may be below 0. Such a factor becomes 0, and the others are scaled so that the sum is 1. */
static void wall_row_settle(fibrad_wall_row *row) {
    double below = 0;
    for (uint32_t b = 0; b < FIBRAD_WALLS_MAX; b++) {
        below += fibrad_min(0, row->wall[b]);
        row->wall[b] = fibrad_max(0, row->wall[b]);
    }
    const double all = 1 - below;
    row->spheres /= all, row->escaped /= all;
    for (uint32_t b = 0; b < FIBRAD_WALLS_MAX; b++) row->wall[b] /= all;
}

int fibrad_exchange_wall_mean(const fibrad_wall_row part[FIBRAD_WALL_PARTS], fibrad_wall_row *mean) {
    if (part == NULL || mean == NULL) return FIBRAD_E_ARGUMENT;
    fibrad_wall_row sum = {0};
    for (uint32_t p = 0; p < FIBRAD_WALL_PARTS; p++) {
        for (uint32_t b = 0; b < FIBRAD_WALLS_MAX; b++) sum.wall[b] += part[p].wall[b] / FIBRAD_WALL_PARTS;
        sum.spheres += part[p].spheres / FIBRAD_WALL_PARTS;
        sum.escaped += part[p].escaped / FIBRAD_WALL_PARTS;
        sum.error += part[p].error / FIBRAD_WALL_PARTS;
        sum.rays += part[p].rays, sum.paths += part[p].paths;
    }
    double square = 0;
    for (uint32_t p = 0; p < FIBRAD_WALL_PARTS; p++) {
        const double escaped = part[p].escaped - sum.escaped, spheres = part[p].spheres - sum.spheres;
        square += escaped * escaped + spheres * spheres;
        for (uint32_t b = 0; b < FIBRAD_WALLS_MAX; b++) {
            const double difference = part[p].wall[b] - sum.wall[b];
            square += difference * difference;
        }
    }
    sum.error += fibrad_sqrt(square / (FIBRAD_WALL_PARTS * (FIBRAD_WALL_PARTS - 1)));
    wall_row_settle(&sum);
    *mean = sum;
    return FIBRAD_OK;
}
