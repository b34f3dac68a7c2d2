/* factors.c - view factors, exchange factors and displacements of whole beds. SPDX-License-Identifier: MIT */
#include <omp.h>
#include <stdlib.h>

#include "simple/job.h"

static int row_by_surface(const void *rule, const fibrad_scene *scene, fibrad_work *work, uint32_t i, fibrad_row *row,
                          uint64_t *rays) {
    (void)rays;
    return fibrad_surface_row(scene, work, i, rule, row);
}

static int row_by_rays(const void *rule, const fibrad_scene *scene, fibrad_work *work, uint32_t i, fibrad_row *row,
                       uint64_t *rays) {
    (void)rays;
    return fibrad_cast_row(scene, work, i, rule, row, NULL);
}

static int row_by_paths(const void *rule, const fibrad_scene *scene, fibrad_work *work, uint32_t i, fibrad_row *row,
                        uint64_t *rays) {
    return fibrad_exchange_row(scene, work, i, rule, row, rays);
}

/* Checks that at most `most` rules are set and that 0 <= drop <= 1. */
static int check_options(const fibrad_bed_options *options, int most) {
    const int rules = (options->beam != NULL) + (options->surface != NULL) + (options->cast != NULL);
    return rules <= most && options->drop >= 0 && options->drop <= 1 ? FIBRAD_OK : FIBRAD_E_ARGUMENT;
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
static int plan_matrix(fibrad_job *job, const fibrad_bed_options *options, const struct wall_plan *walls,
                       fibrad_wall_row *wall_row, fibrad_matrix_rule *rule) {
    *rule = (fibrad_matrix_rule){.raw = options->raw || options->wanted, .drop = options->drop};
    if (options->cast) rule->kind = FIBRAD_ROWS_SAMPLED;
    if (!options->walls || options->wanted || walls->cutoff > 0 || job->facts.walls == 0) return FIBRAD_OK;
    rule->wall_row = wall_row;
    rule->wall_emissivity = walls->rule.wall_emissivity;
    const double tolerance = rule->raw ? walls->tolerance : walls->tolerance * WALL_BEFORE_AVERAGING;
    return fibrad_job_walls(job, &walls->rule, tolerance, wall_row);
}

/* Computes the rows by one rule, and their matrix. */
static int run_rule(fibrad_job *job, fibrad_job_row *row, const void *rule, const fibrad_bed_options *options,
                    const fibrad_matrix_rule *how, fibrad_bed_factors **factors) {
    fibrad_job_report report;
    const int status = fibrad_job_rows(job, row, rule, options->wanted, NULL, &report);
    return status ? status : fibrad_job_factors(job, how, &report, factors);
}

/* Computes all rows for a matrix, along lines, and the matrix. */
static int run_all_rows(fibrad_job *job, const fibrad_beam_rule *beam, const fibrad_matrix_rule *how,
                        fibrad_bed_factors **factors) {
    fibrad_job_report report;
    if (beam && beam->tolerance > 0) return fibrad_job_tolerance(job, beam, how, factors);
    const int status = fibrad_job_line_rows(job, beam, &report);
    return status ? status : fibrad_job_factors(job, how, &report, factors);
}

/* A plan for rows of black walls, which makes them about as accurate as the rows of spheres. */
static struct wall_plan black_bodies(const fibrad_job *job, const fibrad_bed_options *options) {
    const fibrad_beam_rule *beam = options->beam;
    const fibrad_cast_rule *cast = options->cast;
    struct wall_plan plan = {.rule.paths = 20000};
    if (cast) {
        if (cast->rays) plan.rule.paths = cast->rays;
        plan.rule.seed = cast->seed, plan.cutoff = cast->cutoff;
    } else if (!options->surface) {
        plan.rule.paths = PER_DIRECTION * (beam && beam->directions ? beam->directions : FIBRAD_DIRECTIONS_DEFAULT);
        if (beam) plan.tolerance = beam->tolerance, plan.cutoff = beam->cutoff;
    }
    plan.rule.paths = fibrad_job_wall_paths(job, plan.rule.paths);
    return plan;
}

static int run_options(fibrad_job *job, const fibrad_bed_options *options, fibrad_bed_factors **factors) {
    const fibrad_beam_rule *beam = options->beam;
    const struct wall_plan walls = black_bodies(job, options);
    fibrad_wall_row wall_row[FIBRAD_WALLS_MAX];
    fibrad_matrix_rule how;
    const int status = plan_matrix(job, options, &walls, wall_row, &how);
    if (status) return status;
    if (options->surface) return run_rule(job, row_by_surface, options->surface, options, &how, factors);
    if (options->cast) return run_rule(job, row_by_rays, options->cast, options, &how, factors);
    if (!how.raw) return run_all_rows(job, beam, &how, factors);
    return run_rule(job, fibrad_job_beam_row, beam, options, &how, factors);
}

/* Checks the properties of all spheres, since paths may meet each of them. The fault names the first invalid sphere.
 * node, conductivity: may be NULL */
static int check_spheres(fibrad_job *job, const double *emissivity, const double *node, const double *conductivity) {
    if ((!emissivity && job->facts.spheres > 0) || (node && !conductivity)) return FIBRAD_E_ARGUMENT;
    for (uint32_t i = 0; i < job->facts.spheres; ++i) {
        const bool grey = emissivity[i] >= 0 && emissivity[i] <= 1;
        const bool solid = (!conductivity || conductivity[i] >= FIBRAD_RELATIVE_CONDUCTIVITY_MIN) &&
                           (!node || (node[i] >= 0 && node[i] <= emissivity[i]));
        if (grey && solid) continue;
        const int why = grey ? FIBRAD_WHY_CONDUCTIVITY : FIBRAD_WHY_EMISSIVITY;
        if (job->run) job->run->fault = (fibrad_fault){i, i, UINT32_MAX, 0, why};
        return FIBRAD_E_ARGUMENT;
    }
    return FIBRAD_OK;
}

static int run_exchange(fibrad_job *job, const fibrad_exchange_rule *rule, const fibrad_bed_options *options,
                        fibrad_bed_factors **factors) {
    fibrad_wall_row wall_row[FIBRAD_WALLS_MAX];
    fibrad_matrix_rule how;
    if (!rule) return FIBRAD_E_ARGUMENT;
    int status = check_spheres(job, rule->emissivity, rule->node_emissivity, rule->conductivity);
    if (status) return status;
    const uint64_t paths = PER_PATH * (uint64_t)(rule->paths ? rule->paths : FIBRAD_PATHS_DEFAULT);
    const struct wall_plan walls = {.rule = {.emissivity = rule->emissivity,
                                             .wall_emissivity = rule->wall_emissivity,
                                             .node_emissivity = rule->node_emissivity,
                                             .conductivity = rule->conductivity,
                                             .paths = fibrad_job_wall_paths(job, paths),
                                             .seed = rule->seed},
                                    .tolerance = rule->tolerance,
                                    .cutoff = rule->cutoff};
    status = plan_matrix(job, options, &walls, wall_row, &how);
    if (status) return status;
    how.kind = FIBRAD_ROWS_EXCHANGE;
    how.emissivity = rule->node_emissivity ? rule->node_emissivity : rule->emissivity;
    if (rule->tolerance > 0 && !how.raw) return fibrad_job_exchange(job, row_by_paths, rule, &how, factors);
    return run_rule(job, row_by_paths, rule, options, &how, factors);
}

/* grey: exchange factors by a rule. Otherwise: view factors. */
static int factors_of_bed(const fibrad_scene_config *config, const fibrad_spheres *spheres, bool grey,
                          const fibrad_exchange_rule *rule, const fibrad_bed_options *options, fibrad_run *run,
                          fibrad_bed_factors **factors) {
    static const fibrad_bed_options defaults;
    fibrad_job job;
    if (!factors) return FIBRAD_E_ARGUMENT;
    *factors = NULL;
    if (!options) options = &defaults;
    int status = fibrad_job_open(&job, config, spheres, run);
    if (!status) status = check_options(options, grey ? 0 : 1);
    if (!status) status = fibrad_job_scratch(&job, options->scratch);
    if (!status) status = grey ? run_exchange(&job, rule, options, factors) : run_options(&job, options, factors);
    fibrad_job_close(&job);
    return status;
}

int fibrad_job_exchange_of(fibrad_scene *scene, const fibrad_exchange_rule *rule, fibrad_run *run,
                           fibrad_bed_factors **factors) {
    static const fibrad_bed_options defaults;
    fibrad_job job = {.scene = scene, .run = run, .begun = omp_get_wtime()};
    fibrad_scene_describe(scene, &job.facts);
    run->fault = (fibrad_fault){job.facts.spheres, job.facts.spheres, UINT32_MAX, 0, 0};
    int status = fibrad_team_open(&job.team, run);
    if (!status) status = run_exchange(&job, rule, &defaults, factors);
    fibrad_job_close(&job);
    return status;
}

int fibrad_view_factors(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                        const fibrad_bed_options *options, fibrad_run *run, fibrad_bed_factors **factors) {
    return factors_of_bed(config, spheres, false, NULL, options, run, factors);
}

int fibrad_exchange_factors(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                            const fibrad_exchange_rule *rule, const fibrad_bed_options *options, fibrad_run *run,
                            fibrad_bed_factors **factors) {
    return factors_of_bed(config, spheres, true, rule, options, run, factors);
}

struct displaced {
    const fibrad_displacement_rule *rule;
    fibrad_displacement *to; /* [spheres] */
};

/* A fibrad_job_row that computes the displacement of one sphere. The row stays empty. */
static int displacement_of(const void *rule, const fibrad_scene *scene, fibrad_work *work, uint32_t i, fibrad_row *row,
                           uint64_t *rays) {
    const struct displaced *how = rule;
    (void)rays;
    *row = (fibrad_row){0};
    return fibrad_exchange_displacement(scene, work, i, how->rule, &how->to[i]);
}

int fibrad_displacements(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                         const fibrad_displacement_rule *rule, const unsigned char *wanted, fibrad_run *run,
                         fibrad_displacement *displacement, fibrad_scene_facts *facts) {
    fibrad_job job;
    fibrad_job_report report;
    const struct displaced how = {rule, displacement};
    int status = fibrad_job_open(&job, config, spheres, run);
    if (!status && (!rule || !displacement)) status = FIBRAD_E_ARGUMENT;
    if (!status) status = check_spheres(&job, rule->emissivity, NULL, rule->conductivity);
    if (!status) status = fibrad_job_rows(&job, displacement_of, &how, wanted, NULL, &report);
    if (!status && facts) *facts = job.facts;
    fibrad_job_close(&job);
    return status;
}
