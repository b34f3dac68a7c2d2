/* factors.c - view factors, exchange factors and displacements of whole beds. SPDX-License-Identifier: MIT */
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

/* Fills `rule` for the matrix of a bed. Computes rows of walls by `walls` if options->walls is set, all rows of
 * spheres are computed and there is no cutoff. */
static int plan_matrix(fibrad_job *job, const fibrad_bed_options *options, const fibrad_exchange_rule *walls,
                       fibrad_wall_row *wall_row, fibrad_matrix_rule *rule) {
    *rule = (fibrad_matrix_rule){.raw = options->raw || options->wanted, .drop = options->drop};
    if (options->cast) rule->kind = FIBRAD_ROWS_SAMPLED;
    if (!options->walls || options->wanted || walls->cutoff > 0 || job->facts.walls == 0) return FIBRAD_OK;
    fibrad_exchange_rule before = *walls;
    if (!rule->raw) before.tolerance *= WALL_BEFORE_AVERAGING;
    rule->wall_row = wall_row;
    rule->wall_emissivity = walls->wall_emissivity;
    return fibrad_job_walls(job, &before, wall_row);
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

/* A rule for rows of black walls, which makes them about as accurate as the rows of spheres. */
static fibrad_exchange_rule black_bodies(const fibrad_job *job, const fibrad_bed_options *options) {
    const fibrad_beam_rule *beam = options->beam;
    const fibrad_cast_rule *cast = options->cast;
    fibrad_exchange_rule rule = {.paths = 20000};
    if (cast) {
        if (cast->rays) rule.paths = cast->rays;
        rule.seed = cast->seed, rule.cutoff = cast->cutoff;
    } else if (!options->surface) {
        rule.paths = PER_DIRECTION * (beam && beam->directions ? beam->directions : FIBRAD_DIRECTIONS_DEFAULT);
        if (beam) rule.tolerance = beam->tolerance, rule.cutoff = beam->cutoff;
    }
    rule.paths = fibrad_job_wall_paths(job, rule.paths);
    return rule;
}

static int run_options(fibrad_job *job, const fibrad_bed_options *options, fibrad_bed_factors **factors) {
    const fibrad_beam_rule *beam = options->beam;
    const fibrad_exchange_rule walls = black_bodies(job, options);
    fibrad_wall_row wall_row[FIBRAD_WALLS_MAX];
    fibrad_matrix_rule how;
    const int status = plan_matrix(job, options, &walls, wall_row, &how);
    if (status) return status;
    if (options->surface) return run_rule(job, row_by_surface, options->surface, options, &how, factors);
    if (options->cast) return run_rule(job, row_by_rays, options->cast, options, &how, factors);
    if (!how.raw) return run_all_rows(job, beam, &how, factors);
    return run_rule(job, fibrad_job_beam_row, beam, options, &how, factors);
}

/* Checks the properties of all spheres, since paths may meet each of them. The fault names the first invalid sphere. */
static int check_spheres(fibrad_job *job, const fibrad_exchange_rule *rule) {
    if (!rule || (!rule->emissivity && job->facts.spheres > 0)) return FIBRAD_E_ARGUMENT;
    if (rule->node_emissivity && !rule->conductivity) return FIBRAD_E_ARGUMENT;
    for (uint32_t i = 0; i < job->facts.spheres; ++i) {
        const bool grey = rule->emissivity[i] >= 0 && rule->emissivity[i] <= 1;
        const double node = rule->node_emissivity ? rule->node_emissivity[i] : 0;
        const bool solid = !rule->conductivity || (rule->conductivity[i] >= FIBRAD_RELATIVE_CONDUCTIVITY_MIN &&
                                                   node >= 0 && node <= rule->emissivity[i]);
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
    int status = check_spheres(job, rule);
    if (status) return status;
    fibrad_exchange_rule walls = *rule;
    walls.paths = fibrad_job_wall_paths(job, PER_PATH * (uint64_t)(rule->paths ? rule->paths : 400));
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

int fibrad_view_factors(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                        const fibrad_bed_options *options, fibrad_run *run, fibrad_bed_factors **factors) {
    return factors_of_bed(config, spheres, false, NULL, options, run, factors);
}

int fibrad_exchange_factors(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                            const fibrad_exchange_rule *rule, const fibrad_bed_options *options, fibrad_run *run,
                            fibrad_bed_factors **factors) {
    return factors_of_bed(config, spheres, true, rule, options, run, factors);
}

struct displacement_rule {
    const fibrad_exchange_rule *rule;
    fibrad_displacement *to; /* [spheres] */
};

/* A fibrad_job_row that computes the displacement of one sphere. The row stays empty. */
static int displacement_of(const void *rule, const fibrad_scene *scene, fibrad_work *work, uint32_t i, fibrad_row *row,
                           uint64_t *rays) {
    const struct displacement_rule *how = rule;
    (void)rays;
    *row = (fibrad_row){0};
    if (how->rule->conductivity) return fibrad_exchange_walk(scene, work, i, how->rule, &how->to[i]);
    return fibrad_exchange_displacement(scene, work, i, how->rule, &how->to[i]);
}

int fibrad_displacements(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                         const fibrad_exchange_rule *rule, const unsigned char *wanted, fibrad_run *run,
                         fibrad_displacement *displacement, fibrad_scene_facts *facts) {
    fibrad_job job;
    fibrad_job_report report;
    const struct displacement_rule how = {rule, displacement};
    int status = fibrad_job_open(&job, config, spheres, run);
    if (!status && !displacement) status = FIBRAD_E_ARGUMENT;
    if (!status) status = check_spheres(&job, rule);
    if (!status) status = fibrad_job_rows(&job, displacement_of, &how, wanted, NULL, &report);
    if (!status && facts) *facts = job.facts;
    fibrad_job_close(&job);
    return status;
}
