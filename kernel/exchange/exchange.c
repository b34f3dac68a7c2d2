/* exchange.c - exchange factors of grey diffuse spheres, and how far they reach. SPDX-License-Identifier: MIT
 *
 * What a sphere emits is absorbed in part where it first arrives, which the beam method tells far more accurately than
 * paths do. Only what is reflected there is followed along paths; all of it arrives somewhere, so the paths' sum is
 * scaled to it, and the row closes. */
#include "exchange/paths.h"

#define DIRECTIONS 50u
#define PATHS      400u

/* Up to so many directions, windows by 256 points are as good as by exact areas and take a third of the time. */
#define BY_POINTS 144u

/* What of the tolerance the first leg may take: about as much time then goes into beams as into paths at emissivity
 * 0.8, and less at lower ones. */
#define BEAM_SHARE 0.5

static bool valid(const fibrad_tracer *tracer, uint32_t i, const fibrad_exchange_rule *rule) {
    if (tracer == NULL || rule == NULL || i >= tracer->scene->facts.spheres || rule->emissivity == NULL) return false;
    if (!(rule->emissivity[i] > 0 && rule->emissivity[i] <= 1) || rule->paths > FIBRAD_PATHS_MAX) return false;
    for (int wall = 0; wall < FIBRAD_WALLS; wall++)
        if (!(rule->wall_emissivity[wall] >= 0 && rule->wall_emissivity[wall] <= 1)) return false;
    return rule->error >= 0 && fibrad_finite(rule->error);
}

static fibrad_paths begin(fibrad_tracer *tracer, uint32_t i, const fibrad_exchange_rule *rule) {
    return (fibrad_paths){.tracer = tracer,
                          .place = tracer->scene->place[i],
                          .emissivity = rule->emissivity,
                          .wall_emissivity = rule->wall_emissivity,
                          .stream = fibrad_random_start(rule->seed, i)};
}

/* The first leg: a beam row, and the error of what it makes spheres absorb. */
static int first_leg(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i, const fibrad_exchange_rule *rule,
                     fibrad_row *row, double *error) {
    fibrad_beam_rule beam = {.directions = rule->directions > 0 ? rule->directions : DIRECTIONS};
    for (;;) {
        beam.points = beam.directions <= BY_POINTS ? 256 : 0;
        int status = fibrad_beam_row(scene, work, i, &beam, row);
        if (status != FIBRAD_OK) return status;
        double most = 0;
        for (uint32_t k = 0; k < row->length; k++) most = fibrad_max(most, rule->emissivity[row->col[k]]);
        *error = most * row->error;
        double wanted = BEAM_SHARE * rule->error;
        if (!(wanted > 0 && *error > wanted) || beam.directions == FIBRAD_DIRECTIONS_MAX) return FIBRAD_OK;
        beam.directions = fibrad_directions_for(beam.directions, *error, wanted);
    }
}

/* How much of the first leg is reflected. */
static double reflected(const fibrad_exchange_rule *rule, const fibrad_row *row) {
    double sum = 0;
    for (uint32_t k = 0; k < row->length; k++) sum += row->f[k] * (1 - rule->emissivity[row->col[k]]);
    for (int wall = 0; wall < FIBRAD_WALLS; wall++) sum += row->wall[wall] * (1 - rule->wall_emissivity[wall]);
    return sum;
}

/* All that the paths have put down. */
static double total(const fibrad_paths *paths) {
    double sum = paths->absorbed + paths->escaped;
    for (int wall = 0; wall < FIBRAD_WALLS; wall++) sum += paths->wall[wall];
    return sum;
}

/* The Euclidean distance of the sums over even and odd paths, which is the error of their mean. */
static double halves(const fibrad_entries *entries) {
    double square = 0;
    for (uint32_t k = 0; k < entries->length; k++) {
        const double *part = entries->part[k];
        double difference = part[0] + part[2] - part[1] - part[3];
        square += difference * difference;
    }
    return fibrad_sqrt(square);
}

/* Follows paths until their error is not above `wanted` (0: as many as the rule says). Where reflecting surfaces are so
 * small that no path meets one, up to 64 times as many. */
static void follow(fibrad_paths *paths, const fibrad_exchange_rule *rule, double carried, double wanted) {
    uint64_t done = 0, first = rule->paths > 0 ? rule->paths : PATHS, next = first;
    while (done < next) {
        fibrad_paths_follow(paths, done, next);
        done = next;
        double sum = total(paths), ratio = 0;
        if (sum == 0) {
            if (carried > wanted && done < 64 * first) next = 4 * done;
            continue;
        }
        if (wanted > 0) ratio = halves(paths->entries) / sum * carried / wanted;
        if (ratio > 1)
            next = (uint64_t)fibrad_min(FIBRAD_PATHS_MAX, (double)done * fibrad_min(8, 1.1 * ratio * ratio) + 1);
    }
}

/* Adds the first leg to the scaled sums of the paths. */
static void join(fibrad_workspace *work, const fibrad_exchange_rule *rule, const fibrad_row *row, double scale) {
    fibrad_entries *entries = &work->entries;
    for (uint32_t k = 0; k < entries->length; k++)
        for (int part = 0; part < 4; part++) entries->part[k][part] *= scale;
    for (uint32_t k = 0; k < row->length; k++)
        for (uint32_t part = 0; part < 4; part++)
            fibrad_entries_add(entries, fibrad_entries_of(entries, work->scene->place[row->col[k]]), part,
                               0.25 * row->f[k] * rule->emissivity[row->col[k]]);
}

int fibrad_exchange_row(fibrad_tracer *tracer, fibrad_workspace *work, uint32_t i, const fibrad_exchange_rule *rule,
                        fibrad_row *row, uint64_t *rays) {
    if (!valid(tracer, i, rule)) return FIBRAD_E_ARGUMENT;
    const fibrad_scene *scene = tracer->scene;
    double beam_error;
    int status = first_leg(scene, work, i, rule, row, &beam_error);
    if (status != FIBRAD_OK) return status;

    double carried = reflected(rule, row), scale = 0;
    fibrad_paths paths = begin(tracer, i, rule);
    paths.entries = &work->entries;
    fibrad_work_begin(work, scene, paths.place, 0, (fibrad_stride){0});
    if (carried > 0) { /* what no path has found counts as escaped, and as an error */
        double left = rule->error * rule->error - beam_error * beam_error, least = 0.5 * rule->error;
        follow(&paths, rule, carried, fibrad_max(fibrad_sqrt(fibrad_max(left, 0)), least));
        double sum = total(&paths);
        scale = sum > 0 ? carried / sum : 0;
        if (sum == 0) paths.escaped = carried, scale = 1, beam_error += carried;
    }
    join(work, rule, row, scale);
    if (work->entries.missed > 0) {
        uint64_t enough = (uint64_t)work->entries.capacity + work->entries.missed;
        work->needed.entries = (uint32_t)(enough < scene->facts.spheres ? enough : scene->facts.spheres);
        return row->length = 0, FIBRAD_E_CAPACITY;
    }
    status = fibrad_entries_row(work, 1, row);
    if (status != FIBRAD_OK) return status;
    row->error = fibrad_sqrt(row->error * row->error + beam_error * beam_error);
    row->escaped += paths.escaped * scale;
    for (int wall = 0; wall < FIBRAD_WALLS; wall++)
        row->wall[wall] = row->wall[wall] * rule->wall_emissivity[wall] + paths.wall[wall] * scale;
    if (rays != NULL) *rays = paths.rays;
    return FIBRAD_OK;
}

int fibrad_exchange_spread(fibrad_tracer *tracer, uint32_t i, const fibrad_exchange_rule *rule, fibrad_spread *spread) {
    if (!valid(tracer, i, rule) || spread == NULL) return FIBRAD_E_ARGUMENT;
    fibrad_paths paths = begin(tracer, i, rule);
    uint32_t count = rule->paths > 0 ? rule->paths : PATHS;
    paths.first = true;
    fibrad_paths_follow(&paths, 0, count);
    for (int axis = 0; axis < 3; axis++) {
        double sum = 0, square = 0;
        for (int part = 0; part < FIBRAD_SPREAD_PARTS; part++) sum += paths.square[part][axis];
        for (int part = 0; part < FIBRAD_SPREAD_PARTS; part++) {
            double difference = paths.square[part][axis] - sum / FIBRAD_SPREAD_PARTS;
            square += difference * difference;
        }
        spread->square[axis] = sum / count;
        spread->error[axis] = fibrad_sqrt(square * FIBRAD_SPREAD_PARTS / (FIBRAD_SPREAD_PARTS - 1)) / count;
    }
    spread->absorbed = paths.absorbed / count;
    spread->rays = paths.rays;
    return FIBRAD_OK;
}
