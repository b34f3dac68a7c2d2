/* factors.c - view factors and exchange factors of whole beds. SPDX-License-Identifier: MIT */
#include <omp.h>
#include <stdlib.h>

#include "simple/rows.h"

static int row_by_rays(const void *rule, const fibrad_scene *scene, fibrad_work *work, uint32_t i, fibrad_row *row,
                       uint64_t *rays) {
    (void)rays;
    return fibrad_cast_row(scene, work, i, rule, row, NULL);
}

static int row_by_paths(const void *rule, const fibrad_scene *scene, fibrad_work *work, uint32_t i, fibrad_row *row,
                        uint64_t *rays) {
    return fibrad_exchange_row(scene, work, i, rule, row, rays);
}

/* Checks that at most one method is set and that 0 <= drop <= 1. */
static int check_rule(const fibrad_bed_rule *rule) {
    const int methods = (rule->beam != NULL) + (rule->cast != NULL) + (rule->exchange != NULL);
    return methods <= 1 && rule->drop >= 0 && rule->drop <= 1 ? FIBRAD_OK : FIBRAD_E_ARGUMENT;
}

/* Paths from a wall for each direction of beams of a sphere, and for each path of a sphere. So many paths of a wall
 * take about as long as the direction or the path. */
enum { PER_DIRECTION = 64, PER_PATH = 8 };

/* Error allowed in the row of a wall before averaging, over the error allowed after averaging. */
#define WALL_BEFORE_AVERAGING 1.4

/* How rows of walls are computed: to the tolerance of the matrix, 0: none, and not at all with a cutoff. */
struct wall_plan {
    fibrad_wall_rule rule;
    double tolerance, cutoff;
};

/* Fills `rule` for the matrix of a bed. Computes rows of walls if options->walls is set, all rows of spheres are
 * computed and there is no cutoff. */
static int plan_matrix(fibrad_bed *bed, const fibrad_bed_rule *options, const struct wall_plan *walls,
                       fibrad_wall_row *wall_row, fibrad_matrix_rule *rule) {
    *rule = (fibrad_matrix_rule){.raw = options->raw || options->wanted, .drop = options->drop};
    if (options->cast) rule->kind = FIBRAD_ROWS_SAMPLED;
    if (!options->walls || options->wanted || walls->cutoff > 0 || bed->facts.walls == 0) return FIBRAD_OK;
    rule->wall_row = wall_row;
    rule->wall_emissivity = walls->rule.wall_emissivity;
    const double tolerance = rule->raw ? walls->tolerance : walls->tolerance * WALL_BEFORE_AVERAGING;
    return fibrad_bed_wall_rows(bed, &walls->rule, tolerance, wall_row);
}

/* Computes the rows by one rule, and their matrix. */
static int run_rule(fibrad_bed *bed, fibrad_row_method *row, const void *rule, const fibrad_bed_rule *options,
                    const fibrad_matrix_rule *how, fibrad_bed_matrix **factors) {
    fibrad_rows_report report;
    const int status = fibrad_bed_rows(bed, row, rule, options->wanted, &report);
    return status ? status : fibrad_bed_average(bed, how, &report, factors);
}

/* Computes all rows for a matrix, along lines, and the matrix. */
static int run_all_rows(fibrad_bed *bed, const fibrad_beam_rule *beam, const fibrad_matrix_rule *how,
                        fibrad_bed_matrix **factors) {
    fibrad_rows_report report;
    if (beam && beam->tolerance > 0) return fibrad_bed_tolerance_rows(bed, beam, how, factors);
    const int status = fibrad_bed_line_rows(bed, beam, &report);
    return status ? status : fibrad_bed_average(bed, how, &report, factors);
}

/* A plan for rows of black walls, which makes them about as accurate as the rows of spheres. */
static struct wall_plan black_bodies(const fibrad_bed *bed, const fibrad_bed_rule *options) {
    const fibrad_beam_rule *beam = options->beam;
    const fibrad_cast_rule *cast = options->cast;
    struct wall_plan plan = {.rule.paths = 20000};
    if (cast) {
        if (cast->rays) plan.rule.paths = cast->rays;
        plan.rule.seed = cast->seed, plan.cutoff = cast->cutoff;
    } else {
        plan.rule.paths = PER_DIRECTION * (beam && beam->directions ? beam->directions : FIBRAD_DIRECTIONS_DEFAULT);
        if (beam) plan.tolerance = beam->tolerance, plan.cutoff = beam->cutoff;
    }
    plan.rule.paths = fibrad_bed_wall_paths(bed, plan.rule.paths);
    return plan;
}

static int run_options(fibrad_bed *bed, const fibrad_bed_rule *options, fibrad_bed_matrix **factors) {
    const fibrad_beam_rule *beam = options->beam;
    const struct wall_plan walls = black_bodies(bed, options);
    fibrad_wall_row wall_row[FIBRAD_WALLS_MAX];
    fibrad_matrix_rule how;
    const int status = plan_matrix(bed, options, &walls, wall_row, &how);
    if (status) return status;
    if (options->cast) return run_rule(bed, row_by_rays, options->cast, options, &how, factors);
    if (!how.raw) return run_all_rows(bed, beam, &how, factors);
    return run_rule(bed, fibrad_row_by_beams, beam, options, &how, factors);
}

/* Checks the properties of all spheres, since paths may meet each of them. The fault names the first invalid sphere.
 * node, conductivity: may be NULL */
static int check_spheres(fibrad_bed *bed, const double *emissivity, const double *node, const double *conductivity) {
    if ((!emissivity && bed->facts.spheres > 0) || (node && !conductivity)) return FIBRAD_E_ARGUMENT;
    for (uint32_t i = 0; i < bed->facts.spheres; ++i) {
        const bool grey = emissivity[i] >= 0 && emissivity[i] <= 1;
        const bool solid = (!conductivity || conductivity[i] >= FIBRAD_RELATIVE_CONDUCTIVITY_MIN) &&
                           (!node || (node[i] >= 0 && node[i] <= emissivity[i]));
        if (grey && solid) continue;
        const int why = grey ? FIBRAD_WHY_CONDUCTIVITY : FIBRAD_WHY_EMISSIVITY;
        bed->fault = (fibrad_fault){i, i, UINT32_MAX, 0, why};
        return FIBRAD_E_ARGUMENT;
    }
    return FIBRAD_OK;
}

static int run_exchange(fibrad_bed *bed, const fibrad_bed_rule *options, fibrad_bed_matrix **factors) {
    const fibrad_exchange_rule *rule = options->exchange;
    fibrad_wall_row wall_row[FIBRAD_WALLS_MAX];
    fibrad_matrix_rule how;
    int status = check_spheres(bed, rule->emissivity, rule->node_emissivity, rule->conductivity);
    if (status) return status;
    const uint64_t paths = PER_PATH * (uint64_t)(rule->paths ? rule->paths : FIBRAD_PATHS_DEFAULT);
    const struct wall_plan walls = {.rule = {.emissivity = rule->emissivity,
                                             .wall_emissivity = rule->wall_emissivity,
                                             .node_emissivity = rule->node_emissivity,
                                             .conductivity = rule->conductivity,
                                             .paths = fibrad_bed_wall_paths(bed, paths),
                                             .seed = rule->seed},
                                    .tolerance = rule->tolerance,
                                    .cutoff = rule->cutoff};
    status = plan_matrix(bed, options, &walls, wall_row, &how);
    if (status) return status;
    how.kind = FIBRAD_ROWS_EXCHANGE;
    how.emissivity = rule->node_emissivity ? rule->node_emissivity : rule->emissivity;
    if (rule->tolerance > 0 && !how.raw) return fibrad_bed_exchange_rows(bed, row_by_paths, rule, &how, factors);
    return run_rule(bed, row_by_paths, rule, options, &how, factors);
}

/* Marks all spheres of the bodies of which one is marked. Free the copy. */
static int mark_bodies(const fibrad_bed *bed, unsigned char **marks, fibrad_bed_rule *rule) {
    const fibrad_bodies *bodies = bed->bodies;
    const uint32_t n = bed->facts.spheres;
    *marks = calloc((size_t)n + bodies->n + 1, 1);
    if (!*marks) return FIBRAD_E_MEMORY;
    for (uint32_t i = 0; i < n; ++i) (*marks)[n + bodies->body[i]] |= rule->wanted[i] != 0;
    for (uint32_t i = 0; i < n; ++i) (*marks)[i] = (*marks)[n + bodies->body[i]];
    rule->wanted = *marks;
    return FIBRAD_OK;
}

static int factors_now(fibrad_bed *bed, const fibrad_bed_rule *given, fibrad_bed_matrix **matrix) {
    fibrad_bed_rule rule = *given;
    unsigned char *marks = NULL;
    bed->begun = omp_get_wtime();
    bed->scratch = rule.scratch;
    int status = check_rule(&rule);
    if (!status && bed->bodies && rule.exchange) status = FIBRAD_E_UNSUPPORTED;
    if (!status && bed->bodies && rule.wanted) status = mark_bodies(bed, &marks, &rule);
    if (!status) status = fibrad_team_scratch(&bed->team, rule.scratch);
    if (!status) status = rule.exchange ? run_exchange(bed, &rule, matrix) : run_options(bed, &rule, matrix);
    fibrad_team_forget(&bed->team);
    free(marks);
    if (!status) fibrad_bed_warn_of_rows(bed, &(*matrix)->matrix);
    return status;
}

int fibrad_bed_exchange(fibrad_bed *bed, const fibrad_exchange_rule *rule, fibrad_bed_matrix **matrix) {
    return factors_now(bed, &(fibrad_bed_rule){.exchange = rule}, matrix);
}

int fibrad_bed_factors(fibrad_bed *bed, const fibrad_bed_rule *rule, fibrad_bed_matrix **matrix) {
    if (!matrix) return FIBRAD_E_ARGUMENT;
    *matrix = NULL;
    const int status = fibrad_bed_begin(bed);
    return status ? status : fibrad_bed_end(bed, factors_now(bed, rule ? rule : &(fibrad_bed_rule){0}, matrix));
}

int fibrad_view_factors(const fibrad_scene_config *config, const fibrad_spheres *spheres, const fibrad_bed_rule *rule,
                        fibrad_run *run, fibrad_bed_matrix **matrix) {
    fibrad_bed *bed;
    if (!matrix) return FIBRAD_E_ARGUMENT;
    *matrix = NULL;
    int status = fibrad_bed_new(&bed, config, spheres, run);
    if (status) return status;
    status = fibrad_bed_factors(bed, rule, matrix);
    if (run) fibrad_bed_describe(bed, NULL, &run->fault);
    fibrad_bed_free(bed);
    return status;
}
