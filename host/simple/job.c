/* job.c - rows of a bed by many threads, and their matrix. SPDX-License-Identifier: MIT */
#include "simple/job.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "simple/heap.h"

#define ROWS_AT_ONCE 16 /* that a thread takes: few enough to share out a bed, enough to share a neighbourhood */
#define AVERAGES     4  /* tasks of averaging for a thread, so that one that is late does not hold up the rest */
#define AVERAGES_MAX 64 /* tasks, unless there are more threads: each looks into all rows */
#define FILED_MAX    256
#define FILED_BYTES  ((uint64_t)1 << 28) /* that a task of averaging writes, in no order, where they are in a file */

int fibrad_job_open(fibrad_job *job, const fibrad_scene_config *config, const fibrad_spheres *spheres,
                    fibrad_run *run) {
    const uint32_t n = spheres ? spheres->n : 0;
    fibrad_fault fault = {n, n, UINT32_MAX};
    *job = (fibrad_job){.run = run, .begun = omp_get_wtime()};
    if (run) run->fault = fault;
    int status = fibrad_team_open(&job->team, run);
    if (!status) status = fibrad_heap_scene(&job->scene, &job->block, config, spheres, &fault);
    if (status && run) run->fault = fault;
    if (!status) fibrad_scene_describe(job->scene, &job->facts);
    return status;
}

int fibrad_job_scratch(fibrad_job *job, const char *folder) {
    job->scratch = folder;
    return fibrad_team_scratch(&job->team, folder);
}

void fibrad_job_close(fibrad_job *job) {
    fibrad_team_close(&job->team);
    free(job->block);
}

/* Rows in work. */
struct row_tasks {
    fibrad_job *job;
    fibrad_job_row *row;
    const void *rule;
    const uint32_t *order; /* [tasks] spheres */
    double *error;
    fibrad_job_report *report; /* [threads] */
};

static double larger_of(double a, double b) { return a > b ? a : b; } /* no library of mathematics for this alone */

static double sum_of_row(const fibrad_row *row, uint32_t bodies) {
    double sum = 0;
    for (uint32_t k = 0; k < row->length; ++k) sum += row->f[k];
    sum += row->escaped;
    for (uint32_t b = 0; b < bodies; ++b) sum += row->body[b];
    return sum + row->beyond;
}

static int run_row(void *tasks, int thread, uint32_t task) {
    const struct row_tasks *rows = tasks;
    fibrad_job *job = rows->job;
    fibrad_job_report *report = &rows->report[thread];
    const uint32_t i = rows->order[task];
    fibrad_row row = {.rows = &job->team.rows[thread]};
    uint64_t rays = 0;
    const int status = rows->row(rows->rule, job->scene, &job->team.work[thread], i, &row, &rays);
    if (status) return status;
    if (rows->error) rows->error[i] = row.error;
    ++report->rows;
    report->directions = row.directions > report->directions ? row.directions : report->directions;
    report->fallbacks += row.fallbacks;
    report->rays += rays;
    const double sum = row.rows ? sum_of_row(&row, job->facts.bodies) : 0;
    if (sum != 0) /* else there is no row, or that of a sphere that emits nothing */
        report->closure_error = larger_of(report->closure_error, fabs(sum - 1));
    return FIBRAD_OK;
}

/* The spheres wanted, in the order of the cells. */
static uint32_t list_spheres(const fibrad_job *job, const unsigned char *wanted, uint32_t *order) {
    uint32_t count = 0;
    for (uint32_t k = 0; k < job->facts.spheres; ++k) {
        const uint32_t i = fibrad_scene_sphere(job->scene, k);
        if (!wanted || wanted[i]) order[count++] = i;
    }
    return count;
}

int fibrad_job_rows(fibrad_job *job, fibrad_job_row *row, const void *rule, const unsigned char *wanted, double *error,
                    fibrad_job_report *report) {
    const uint32_t n = job->facts.spheres;
    fibrad_team *team = &job->team;
    uint32_t *order = malloc(((size_t)n + 1) * sizeof *order), failed;
    fibrad_job_report *part = calloc((size_t)team->threads, sizeof *part);
    int status = order && part ? FIBRAD_OK : FIBRAD_E_MEMORY;
    *report = (fibrad_job_report){0};
    if (error) memset(error, 0, n * sizeof *error);
    for (int t = 0; t < team->threads; ++t) fibrad_rows_clear(&team->rows[t]);
    if (!status) {
        struct row_tasks tasks = {job, row, rule, order, error, part};
        const uint32_t count = list_spheres(job, wanted, order);
        status = fibrad_team_run(team, "rows", count, ROWS_AT_ONCE, run_row, &tasks, &failed);
        if (status && job->run && failed < count)
            job->run->fault = (fibrad_fault){order[failed], order[failed], team->triangle};
    }
    for (int t = 0; t < team->threads && !status; ++t) {
        report->rows += part[t].rows;
        report->directions = part[t].directions > report->directions ? part[t].directions : report->directions;
        report->fallbacks += part[t].fallbacks;
        report->rays += part[t].rays;
        report->closure_error = larger_of(report->closure_error, part[t].closure_error);
    }
    free(order);
    free(part);
    return status;
}

/* Some for each thread; in a file so many more that what each writes stays in memory meanwhile. */
static uint32_t average_tasks(const fibrad_job *job) {
    const fibrad_team *team = &job->team;
    if (team->threads == 1 && !job->scratch) return 1;
    const uint32_t threads = (uint32_t)team->threads,
                   some = threads < AVERAGES_MAX / AVERAGES ? AVERAGES * threads : AVERAGES_MAX;
    const uint32_t tasks = threads > some ? threads : some;
    uint64_t bytes = 0;
    for (int t = 0; t < team->threads && job->scratch; ++t)
        bytes += 2 * team->rows[t].entries * (sizeof(double) + sizeof(uint32_t));
    const uint64_t more = bytes / FILED_BYTES < FILED_MAX ? bytes / FILED_BYTES : FILED_MAX;
    return more > tasks ? (uint32_t)more : tasks;
}

static int make_matrix(fibrad_job *job, const fibrad_matrix_rule *rule, fibrad_matrix **matrix, fibrad_scratch *store) {
    fibrad_team *team = &job->team;
    fibrad_matrix_rule divided = *rule;
    divided.tasks = average_tasks(job);
    divided.parallel = fibrad_team_share, divided.context = team;
    const size_t size = fibrad_matrix_size(job->scene, team->rows, (uint32_t)team->threads, &divided);
    if (!size) return FIBRAD_E_ARGUMENT;
    int status = fibrad_scratch_open(store, job->scratch);
    if (status) return status;
    if (!fibrad_scratch_resize(store, NULL, size)) return FIBRAD_E_MEMORY;
    status =
        fibrad_matrix_init(matrix, store->block, size, job->scene, team->rows, (uint32_t)team->threads, &divided, NULL);
    return status ? status : fibrad_matrix_close(*matrix);
}

/* Factors with what they own. */
struct owned_factors {
    fibrad_bed_factors factors; /* first, so that its address is that of the whole */
    fibrad_scratch store;       /* of the matrix */
    double area[];
};

void fibrad_bed_free(fibrad_bed_factors *factors) {
    if (!factors) return;
    fibrad_scratch_close(&((struct owned_factors *)factors)->store);
    free(factors);
}

int fibrad_job_factors(fibrad_job *job, const fibrad_matrix_rule *rule, const fibrad_job_report *report,
                       fibrad_bed_factors **factors) {
    const uint32_t bodies = job->facts.bodies;
    struct owned_factors *owned = calloc(1, sizeof *owned + bodies * sizeof *owned->area);
    fibrad_matrix *matrix;
    if (!owned) return FIBRAD_E_MEMORY;
    int status = make_matrix(job, rule, &matrix, &owned->store);
    if (!status) status = fibrad_matrix_read(matrix, &owned->factors.matrix);
    if (status) {
        fibrad_bed_free(&owned->factors);
        return status;
    }
    fibrad_bed_factors *f = &owned->factors;
    for (uint32_t b = 0; b < bodies; ++b) owned->area[b] = fibrad_scene_body_area(job->scene, b);
    f->body_area = owned->area;
    f->facts = job->facts;
    f->threads = job->team.threads;
    f->directions = report->directions;
    f->fallbacks = report->fallbacks;
    f->rays = report->rays;
    f->closure_error = report->closure_error;
    f->seconds = omp_get_wtime() - job->begun;
    f->reciprocity_error = NAN;
    if (report->rows == job->facts.spheres) fibrad_matrix_reciprocity(matrix, &f->reciprocity_error);
    *factors = f;
    return FIBRAD_OK;
}
