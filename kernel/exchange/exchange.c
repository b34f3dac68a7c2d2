/* exchange.c - exchange factors of grey diffuse spheres, and how far emission is carried. SPDX-License-Identifier: MIT
 *
 * A beam row tells where the emission of a sphere first arrives. It is far more accurate than paths. Of what arrives, a
 * part is absorbed there. Only the reflected part is followed along paths. All of it arrives somewhere. So the sums
 * over paths are scaled to the reflected part, and the row adds up to 1. */
#include "exchange/paths.h"
#include "row/beam.h"

/* The first few paths tell whether they run among mirrors. They do if most of their weight is left at their end, or if
 * a path takes more than the usual number of rays on the mean. */
#define FEW_PATHS  4u
#define USUAL_RAYS 1024u

/* Largest number of paths that begin with segments of the beam row. */
#define SEGMENTS_MOST 2048u

/* Up to BY_POINTS directions, windows of 256 points are as good as exact areas and take a third of the time. Up to
 * BY_FEW_POINTS directions, the error comes from the directions, and 64 points take two thirds of the time of 256. */
#define BY_POINTS     144u
#define BY_FEW_POINTS (FIBRAD_EXCHANGE_DIRECTIONS_DEFAULT - 1)

/* The share of the tolerance that the first segment may take. At an emissivity of 0.8 beams and paths then take about
 * as much time. At lower emissivities beams take less. */
#define BEAM_SHARE 0.5

/* One call: the rule, emissivities, and the number of rays that the call has traced. */
typedef struct exchange_task {
    const fibrad_exchange_rule *rule;
    const double *emissivity;             /* [spheres], of nodes if spheres conduct */
    double wall_emissivity[FIBRAD_SLOTS]; /* by slot */
    uint64_t rays;                        /* out */
} exchange_task;

/* Checks a rule and begins a task. Errors: FIBRAD_E_ARGUMENT, _STATE. */
static int exchange_begin(exchange_task *task, const fibrad_scene *scene, uint32_t i,
                          const fibrad_exchange_rule *rule) {
    if (scene == NULL || rule == NULL || rule->emissivity == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(scene)) return FIBRAD_E_STATE;
    const uint32_t walls = scene->facts.walls;
    if (i >= scene->facts.spheres || (walls > 0 && rule->wall_emissivity == NULL)) return FIBRAD_E_ARGUMENT;
    if (!(rule->emissivity[i] >= 0 && rule->emissivity[i] <= 1) || rule->paths > FIBRAD_PATHS_MAX ||
        !(rule->open_error >= 0 && fibrad_finite(rule->open_error)))
        return FIBRAD_E_ARGUMENT;
    *task = (exchange_task){.rule = rule, .emissivity = rule->emissivity};
    const int status = fibrad_paths_emissivities(scene, rule->wall_emissivity, task->wall_emissivity);
    if (status != FIBRAD_OK) return status;
    const bool valid =
        rule->tolerance >= 0 && fibrad_finite(rule->tolerance) && rule->cutoff >= 0 && fibrad_finite(rule->cutoff);
    return valid ? FIBRAD_OK : FIBRAD_E_ARGUMENT;
}

static fibrad_paths paths_of(const exchange_task *task, fibrad_workspace *space, const fibrad_scene *scene,
                             uint32_t i) {
    const uint32_t place = scene->place[i];
    return (fibrad_paths){.tracer = fibrad_tracer_of(space, scene),
                          .place = place,
                          .inverse = 1 / scene->r[place],
                          .cut = task->rule->cutoff > 0,
                          .cutoff = task->rule->cutoff > 0 ? task->rule->cutoff / scene->r[place] : __builtin_inf(),
                          .emissivity = task->emissivity,
                          .surface = task->rule->emissivity,
                          .wall_emissivity = task->wall_emissivity,
                          .stream = fibrad_random_start(task->rule->seed, fibrad_scene_id(scene, i)),
                          .back = UINT32_MAX};
}

/* Asks the beam row for the first segments of the first paths. Error: FIBRAD_E_WORK. */
static int want_segments(fibrad_workspace *space, const fibrad_paths *paths, const fibrad_exchange_rule *rule) {
    const uint64_t count = rule->paths > 0 ? rule->paths : FIBRAD_PATHS_DEFAULT;
    const uint32_t wanted = count < SEGMENTS_MOST ? (uint32_t)count : SEGMENTS_MOST;
    space->needed = space->plan;
    space->needed.segments = wanted;
    if (wanted > space->plan.segments) return FIBRAD_E_WORK;
    space->segments.wanted = wanted;
    for (uint32_t d = 0; d < 4; d++) space->segments.shift[d] = fibrad_random_ahead(paths->stream, d);
    return FIBRAD_OK;
}

/* The number of directions with which the open part has about the error `wanted`. */
static uint32_t directions_for_open(uint32_t directions, double error, double wanted) {
    const double ratio = error / wanted, n = directions * (ratio * fibrad_sqrt(fibrad_sqrt(ratio)));
    return n < FIBRAD_DIRECTIONS_MAX ? (uint32_t)n : FIBRAD_DIRECTIONS_MAX;
}

/* Computes the first segment of all emission, a beam row. error: of what spheres and walls absorb there. */
static int first_segment(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const exchange_task *task,
                         fibrad_row *row, double *error) {
    const fibrad_exchange_rule *rule = task->rule;
    fibrad_beam_rule beam = {.directions = rule->directions > 0 ? rule->directions : FIBRAD_EXCHANGE_DIRECTIONS_DEFAULT,
                             .cutoff = rule->cutoff,
                             .turn = rule->seed};
    double open_error = rule->open_error;
    uint32_t by_points = BY_POINTS;
    int status = fibrad_beam_complete(&beam, &beam);
    for (;;) {
        beam.points = beam.directions <= BY_FEW_POINTS ? 64 : beam.directions <= by_points ? 256 : 0;
        if (status == FIBRAD_OK) status = fibrad_beam_compute(scene, space, i, &beam, true, row);
        if (status != FIBRAD_OK) return status;
        double most = 0;
        for (uint32_t k = 0; k < row->length; k++) most = fibrad_max(most, task->emissivity[row->col[k]]);
        for (uint32_t b = 0; b < scene->facts.walls; b++)
            if (row->wall[b] > 0) most = fibrad_max(most, rule->wall_emissivity[b]);
        *error = most * row->error;
        if (open_error > 0 && space->open_error > open_error) {
            by_points = beam.directions = directions_for_open(beam.directions, space->open_error, open_error);
            open_error = 0;
            continue;
        }
        double wanted = BEAM_SHARE * rule->tolerance;
        if (!(wanted > 0 && *error > wanted) || beam.directions == FIBRAD_DIRECTIONS_MAX) return FIBRAD_OK;
        beam.directions = fibrad_directions_for(beam.directions, *error, wanted);
    }
}

/* What a member of a clump gets of its clump begins for the most part inside other members. The part of it that does
 * not: the hidden part of the surface is known exactly. It may be below 0, since of two members the one whose centre is
 * farther on has what leaves both; errors of members cancel in the sum over the clump. */
static double part_outside(const fibrad_scene *scene, uint32_t i, const fibrad_row *row) {
    const uint32_t place = scene->place[i];
    const double r = scene->r[place];
    double own = 0;
    if (scene->clump == NULL || scene->clump[place] == 0) return 1;
    for (uint32_t k = 0; k < row->length; k++)
        if (fibrad_one_clump(scene, place, scene->place[row->col[k]])) own += row->f[k];
    return own > 0 ? 1 - (1 - scene->clumps.exposed[place] / (4 * FIBRAD_PI * (r * r))) / own : 0;
}

/* The fraction of the first segment that is reflected. outside: out, part_outside, of which own members reflect. wall:
 * factors by slot. NaN: an emissivity is not valid. The sum over spheres is a sum of whole numbers. So it does not
 * depend on the order of the columns, which is the caller's. */
static double reflected_of(const exchange_task *task, const fibrad_scene *scene, uint32_t i, const fibrad_row *row,
                           const double wall[FIBRAD_SLOTS], double *outside) {
    uint64_t units = 0, inside = 0;
    for (uint32_t k = 0; k < row->length; k++) {
        const double part = row->f[k] * (1 - task->emissivity[row->col[k]]);
        if (!(part >= 0 && part <= 2)) return __builtin_nan("");
        const bool own = scene->clump != NULL && fibrad_one_clump(scene, scene->place[i], scene->place[row->col[k]]);
        *(own ? &inside : &units) += (uint64_t)(part * 0x1p60);
    }
    double sum = (double)units * 0x1p-60;
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++)
        if (fibrad_slot_of_wall(slot)) sum += wall[slot] * (1 - task->wall_emissivity[slot]);
    const double own = (double)inside * 0x1p-60;
    *outside = inside > 0 ? fibrad_max(part_outside(scene, i, row), -sum / own) : 1;
    return inside > 0 ? fibrad_max(0, sum + *outside * own) : sum;
}

double fibrad_paths_sum(const fibrad_paths *paths) {
    double sum = paths->absorbed + paths->escaped + paths->beyond;
    for (uint32_t wall = 0; wall < FIBRAD_SLOTS; wall++) sum += paths->wall[wall];
    return sum;
}

uint64_t fibrad_paths_begin(fibrad_paths *paths, uint64_t count) {
    fibrad_paths_function *follow = FIBRAD_VERSION_OF(fibrad_paths_follow, paths->tracer->scene->facts.isa);
    const uint64_t few = count < FEW_PATHS ? count : FEW_PATHS;
    follow(paths, 0, few);
    if (paths->left > fibrad_paths_sum(paths)) return few;
    if (paths->rays > few * USUAL_RAYS) count = count * USUAL_RAYS * few / paths->rays;
    if (count < few) return few;
    follow(paths, few, count);
    return count;
}

/* The sum of squares by which the parts of a sum differ from what is expected of them. share: the shares of the parts
 * in all paths. */
static double spread_of_sum(const double part[4], const double share[4]) {
    const double sum = part[0] + part[1] + part[2] + part[3];
    double square = 0;
    for (int p = 0; p < 4; p++) square += (part[p] - share[p] * sum) * (part[p] - share[p] * sum);
    return square;
}

/* The Euclidean error of the sums over all paths, of spheres, walls and surroundings, from the spread of four parts of
 * the paths. Two parts might agree by chance in rows of few entries. Sums are divided by that of all paths, so parts
 * are compared with their shares in all. `weight`, that of one more path, is added, since a path may end where none has
 * ended so far. */
static double spread_of_parts(const fibrad_paths *paths, double weight) {
    const fibrad_entries *entries = paths->entries;
    double square = 0, squares = 0, share[4] = {0, 0, 0, 0};
    for (int p = 0; p < 4; p++) {
        for (uint32_t k = 0; k < entries->length; k++) share[p] += entries->part[k][p];
        for (uint32_t k = 0; k < FIBRAD_SLOTS + 2; k++) share[p] += paths->end[k][p];
    }
    const double all = share[0] + share[1] + share[2] + share[3];
    for (int p = 0; p < 4; p++) share[p] = all > 0 ? share[p] / all : 0.25;
    for (uint32_t k = 0; k < entries->length + FIBRAD_SLOTS + 2; k++) {
        const bool sphere = k < entries->length;
        const double own = spread_of_sum(sphere ? entries->part[k] : paths->end[k - entries->length], share);
        square += own, squares += own * own;
    }
    square += fibrad_sqrt(2.0 / 3 * squares);
    return fibrad_sqrt(4.0 / 3 * square + weight * weight);
}

/* The fraction of the emission that paths still carry where they were broken off. */
static double lost_of(const fibrad_paths *paths, double carried) {
    return paths->left > 0 ? carried * (paths->left / (paths->left + fibrad_paths_sum(paths))) : 0;
}

/* Follows paths until their error is at most `wanted`. 0: the function follows as many paths as the rule says. If the
 * reflecting surfaces are so small that no path meets one, it follows up to 64 times as many. If paths that were broken
 * off among mirrors leave a greater error than `wanted`, it stops. */
static uint64_t follow_paths(fibrad_paths *paths, const fibrad_exchange_rule *rule, double carried, double weight,
                             double wanted) {
    fibrad_paths_function *follow = FIBRAD_VERSION_OF(fibrad_paths_follow, paths->tracer->scene->facts.isa);
    FIBRAD_VERSION_OF(fibrad_paths_arrive, paths->tracer->scene->facts.isa)(paths);
    const uint64_t first = rule->paths > 0 ? rule->paths : FIBRAD_PATHS_DEFAULT;
    uint64_t done = fibrad_paths_begin(paths, first), next = done;
    do {
        follow(paths, done, next);
        done = next;
        const double sum = fibrad_paths_sum(paths);
        double ratio = 0;
        if (lost_of(paths, carried) > wanted) break;
        if (sum == 0) {
            if (carried > wanted && done < 64 * first) next = 4 * done;
            continue;
        }
        if (wanted > 0 && carried > wanted) ratio = spread_of_parts(paths, weight) / sum * carried / wanted;
        if (ratio > 1)
            next = (uint64_t)fibrad_min(FIBRAD_PATHS_MAX, (double)done * fibrad_min(8, 1.1 * ratio * ratio) + 1);
    } while (done < next);
    return done;
}

/* Pools what paths gave to walls and surroundings with what other paths gave. The sum of all stays. So whatever else
 * paths gave is multiplied by the number that this function returns. The caller multiplies what they gave to spheres.
 * scale: fraction of the emission for a path of weight 1; count: number of paths */
static double pool_known(fibrad_paths *paths, const fibrad_exchange_rule *rule, double scale, uint64_t count) {
    const fibrad_scene *scene = paths->tracer->scene;
    const uint32_t walls = scene->facts.walls;
    const double all = fibrad_paths_sum(paths), own = (double)count;
    double *given[FIBRAD_WALLS_MAX + 1], pooled[FIBRAD_WALLS_MAX + 1] = {0}, sum = 0;
    for (uint32_t b = 0; b < walls; b++) given[b] = &paths->wall[scene->slot[b]];
    given[walls] = &paths->escaped;
    for (uint32_t slot = 0; slot < FIBRAD_WALLS && rule->known[walls] >= 0; slot++)
        if (fibrad_is_opening(&scene->container, slot)) paths->escaped += paths->wall[slot], paths->wall[slot] = 0;
    for (uint32_t b = 0; b <= walls; b++) {
        if (!(rule->known[b] >= 0)) continue;
        pooled[b] = fibrad_min((own * *given[b] + rule->known[b] / scale) / (own + rule->known_paths), all);
        sum += pooled[b], *given[b] = 0;
    }
    const double rest = fibrad_paths_sum(paths), others = rest > 0 ? fibrad_max(0, all - sum) / rest : 0;
    const double fit = others > 0 || sum == 0 ? 1 : all / sum;
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++) paths->wall[slot] *= others;
    paths->escaped *= others, paths->beyond *= others;
    for (uint32_t b = 0; b <= walls; b++)
        if (rule->known[b] >= 0) *given[b] = fit * pooled[b];
    return others;
}

/* The entries of paths overwrite the row of the first segment. This function moves the row to where entries will be
 * sorted. */
static void keep_first_segment(fibrad_entries *entries, fibrad_row *segment) {
    fibrad_copy(entries->key[0], segment->f, segment->length * sizeof *segment->f);
    fibrad_copy(entries->key[1], segment->col, segment->length * sizeof *segment->col);
    segment->f = (double *)(void *)entries->key[0];
    segment->col = (uint32_t *)(void *)entries->key[1];
}

/* Adds the first segment to the scaled sums of the paths. */
static void add_first_segment(fibrad_workspace *work, const double *of_sphere, const fibrad_row *row, double scale,
                              uint32_t i, double outside) {
    fibrad_entries *entries = &work->entries;
    for (uint32_t k = 0; k < entries->length; k++)
        for (int part = 0; part < 4; part++) entries->part[k][part] *= scale;
    for (uint32_t k = 0; k < row->length; k++) {
        const uint32_t place = work->scene->place[row->col[k]];
        double emissivity = of_sphere[row->col[k]];
        if (fibrad_one_clump(work->scene, work->scene->place[i], place)) emissivity = 1 - outside * (1 - emissivity);
        if (!(emissivity > 0)) continue;
        const uint32_t entry = fibrad_entries_of(entries, place);
        for (uint32_t part = 0; part < 4; part++)
            fibrad_entries_add(entries, entry, part, 0.25 * row->f[k] * emissivity);
    }
}

/* The row of a sphere that emits nothing. */
static int empty_row(const fibrad_scene *scene, fibrad_row *row) {
    row->length = row->directions = row->fallbacks = 0;
    row->symmetric = 0;
    row->escaped = row->error = 0;
    for (uint32_t b = 0; b < scene->facts.walls; b++) row->wall[b] = 0;
    return FIBRAD_OK;
}

static int exchange_compute(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const void *of,
                            fibrad_row *row) {
    exchange_task *task = *(exchange_task *const *)of;
    const fibrad_exchange_rule *rule = task->rule;
    double beam_error = 0, of_walls[FIBRAD_WALLS_MAX], wall[FIBRAD_SLOTS], scale = 0, to_spheres = 1, outside = 1;
    if (task->emissivity[i] == 0) return empty_row(scene, row);
    fibrad_row segment = fibrad_row_scratch(space, of_walls);
    fibrad_paths paths = paths_of(task, space, scene, i);
    int status = want_segments(space, &paths, rule);
    if (status == FIBRAD_OK) status = first_segment(scene, space, i, task, &segment, &beam_error);
    space->segments.wanted = 0;
    if (status != FIBRAD_OK) return status;

    keep_first_segment(&space->entries, &segment);
    fibrad_copy(wall, space->wall, sizeof wall);
    const double carried = reflected_of(task, scene, i, &segment, wall, &outside),
                 met = 1 - segment.escaped - segment.beyond;
    const double weight = carried > 0 ? carried / fibrad_max(carried, met) : 0;
    paths.segments = &space->segments;
    paths.entries = &space->entries;
    if (rule->node_emissivity != NULL) paths.conductivity = rule->conductivity;
    fibrad_work_begin(space, scene, paths.place, rule->cutoff, (fibrad_stride){0});
    if (!fibrad_finite(carried)) return FIBRAD_E_ARGUMENT;
    if (carried > 0) { /* if all paths end nowhere, what they carry counts as escaped or beyond, and as an error */
        double left = rule->tolerance * rule->tolerance - beam_error * beam_error, least = 0.5 * rule->tolerance;
        const uint64_t count =
            follow_paths(&paths, rule, carried, weight, fibrad_max(fibrad_sqrt(fibrad_max(left, 0)), least));
        space->back = paths.back;
        if (paths.back != UINT32_MAX) return FIBRAD_E_BACK;
        double sum = fibrad_paths_sum(&paths);
        scale = sum != 0 ? carried / sum : 0;
        if (sum == 0) *(paths.cut ? &paths.beyond : &paths.escaped) = carried, scale = 1, beam_error += carried;
        if (sum != 0 && rule->known != NULL) to_spheres = pool_known(&paths, rule, scale, count);
    }
    /* before add_first_segment, which adds the same to all parts */
    const double paths_error = fibrad_min(carried, scale * spread_of_parts(&paths, weight));
    add_first_segment(space, task->emissivity, &segment, scale * to_spheres, i, outside);
    if (space->entries.missed > 0) return fibrad_work_entries_missed(space);
    const double error = fibrad_sqrt(paths_error * paths_error + beam_error * beam_error) + lost_of(&paths, carried);
    if (!fibrad_finite(error + scale)) return FIBRAD_E_ARGUMENT; /* a number that a path met is not valid */
    status = fibrad_entries_row(&space->entries, scene, 1, row);
    if (status != FIBRAD_OK) return status;
    row->error = error;
    row->directions = segment.directions, row->fallbacks = segment.fallbacks, row->symmetric = 0;
    row->escaped = segment.escaped + paths.escaped * scale;
    row->beyond = segment.beyond + paths.beyond * scale;
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++)
        wall[slot] = wall[slot] * task->wall_emissivity[slot] + paths.wall[slot] * scale;
    fibrad_row_walls(scene, wall, row);
    task->rays = paths.rays;
    return fibrad_row_checked(scene, row);
}

int fibrad_exchange_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_exchange_rule *rule,
                        fibrad_row *row, uint64_t *rays) {
    exchange_task task, *handle = &task;
    int status = exchange_begin(&task, scene, i, rule);
    if (status != FIBRAD_OK) return status;
    if (rule->node_emissivity != NULL) task.emissivity = rule->node_emissivity;
    if (rule->node_emissivity != NULL && rule->conductivity == NULL) return FIBRAD_E_ARGUMENT;
    if (!(task.emissivity[i] <= rule->emissivity[i])) return FIBRAD_E_ARGUMENT;
    if (rule->known != NULL && !(rule->known_paths >= 0 && fibrad_finite(rule->known_paths))) return FIBRAD_E_ARGUMENT;
    const fibrad_row_method method = {exchange_compute, &handle, fibrad_tracer_least(), fibrad_tracer_best(scene)};
    status = fibrad_row_run(scene, work, i, &method, row);
    if (status == FIBRAD_OK && rays != NULL) *rays = task.rays;
    return status;
}

/* The sum over all parts divided by `count`, and the standard error from the spread of the parts. */
static void read_squares(const fibrad_paths *paths, double count, fibrad_displacement *displacement) {
    for (int axis = 0; axis < 3; axis++) {
        double sum = 0, square = 0;
        for (int part = 0; part < FIBRAD_DISPLACEMENT_PARTS; part++) sum += paths->square[part][axis];
        for (int part = 0; part < FIBRAD_DISPLACEMENT_PARTS; part++) {
            double difference = paths->square[part][axis] - sum / FIBRAD_DISPLACEMENT_PARTS;
            square += difference * difference;
        }
        displacement->square[axis] = sum / count;
        displacement->error[axis] =
            fibrad_sqrt(square * FIBRAD_DISPLACEMENT_PARTS / (FIBRAD_DISPLACEMENT_PARTS - 1)) / count;
    }
}

/* The displacement of emission up to the sphere that absorbs it. */
static int displace_emission(fibrad_paths *paths, uint32_t count, fibrad_displacement *displacement) {
    paths->first = true;
    const double followed = (double)fibrad_paths_begin(paths, count);
    if (paths->back != UINT32_MAX) return FIBRAD_E_BACK;
    if (!fibrad_finite(paths->absorbed)) return FIBRAD_E_ARGUMENT; /* a number that a path met is not valid */
    read_squares(paths, followed, displacement);
    for (int axis = 0; axis < 3; axis++)
        if (paths->left > 0 && paths->absorbed > 0) /* paths that were broken off would have gone at least as far */
            displacement->error[axis] += displacement->square[axis] * (paths->left / paths->absorbed);
    displacement->absorbed = paths->absorbed / followed;
    displacement->rays = paths->rays;
    return FIBRAD_OK;
}

/* The displacement of a flight of walks among spheres that conduct. */
static int displace_flights(fibrad_paths *paths, uint32_t count, fibrad_displacement *displacement) {
    FIBRAD_VERSION_OF(fibrad_paths_follow, paths->tracer->scene->facts.isa)(paths, 0, count);
    if (!fibrad_finite(paths->origins)) return FIBRAD_E_ARGUMENT; /* a number that a path met is not valid */
    *displacement = (fibrad_displacement){.absorbed = 1 - paths->lost / (double)count, .rays = paths->rays};
    if (paths->origins > 0) read_squares(paths, paths->origins, displacement);
    return FIBRAD_OK;
}

int fibrad_exchange_displacement(const fibrad_scene *scene, fibrad_work *work, uint32_t i,
                                 const fibrad_displacement_rule *rule, fibrad_displacement *displacement) {
    exchange_task task;
    fibrad_workspace *space;
    if (rule == NULL || work == NULL || displacement == NULL) return FIBRAD_E_ARGUMENT;
    const bool conduct = rule->conductivity != NULL;
    fibrad_exchange_rule row = {.emissivity = rule->emissivity, .wall_emissivity = rule->wall_emissivity};
    row.paths = rule->paths, row.seed = rule->seed;
    int status = exchange_begin(&task, scene, i, &row);
    if (status == FIBRAD_OK && conduct && rule->flights > FIBRAD_FLIGHTS_MAX) status = FIBRAD_E_ARGUMENT;
    if (status == FIBRAD_OK && conduct && (scene->container.walls || scene->mesh.triangles > 0))
        status = FIBRAD_E_UNSUPPORTED;
    if (status == FIBRAD_OK)
        status = fibrad_work_open(work, scene, fibrad_tracer_least(), fibrad_tracer_best(scene), &space);
    if (status != FIBRAD_OK) return status;
    if (rule->emissivity[i] == 0 && !conduct) {
        *displacement = (fibrad_displacement){0};
        return FIBRAD_OK;
    }
    const uint32_t count = rule->paths > 0 ? rule->paths : FIBRAD_PATHS_DEFAULT;
    fibrad_paths paths = paths_of(&task, space, scene, i);
    paths.conductivity = rule->conductivity;
    if (conduct) paths.flights = rule->flights > 0 ? rule->flights : FIBRAD_FLIGHTS_DEFAULT;
    status = conduct ? displace_flights(&paths, count, displacement) : displace_emission(&paths, count, displacement);
    work->triangle = paths.back;
    return status;
}
