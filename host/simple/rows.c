/* rows.c - rows of a bed by many threads, and their matrix. SPDX-License-Identifier: MIT */
#include "simple/rows.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#define ROWS_AT_ONCE 16 /* rows per task: few enough to divide a bed, enough to be neighbours in the cache */
#define LONG_RATIO   8  /* the row of a sphere of more than this many mean radii begins early */
#define AVERAGES     4  /* tasks of averaging per thread: several, so that a late thread does not delay the others */
#define AVERAGES_MAX 64 /* at most so many tasks of averaging, unless there are more threads: each reads all rows */
#define FILED_MAX    256
/* Bytes that a task of averaging writes if rows are in a file. It writes in no order, so its bytes must fit in memory.
 */
#define FILED_BYTES ((uint64_t)1 << 28)

/* Rows that are being computed, one per task. */
struct row_tasks {
    fibrad_bed *bed;
    fibrad_row_method *row;
    const void *rule;
    const uint32_t *order;      /* [tasks] spheres */
    fibrad_rows_report *report; /* [threads] */
};

static double sum_of_row(const fibrad_row *row, uint32_t walls) {
    double sum = 0;
    for (uint32_t k = 0; k < row->length; ++k) sum += row->f[k];
    sum += row->escaped;
    for (uint32_t b = 0; b < walls; ++b) sum += row->wall[b];
    return sum + row->beyond;
}

/* Adds a row to the report of the thread that has computed the row. */
static void note_row(const struct row_tasks *rows, int thread, const fibrad_row *row) {
    fibrad_rows_report *report = &rows->report[thread];
    ++report->rows;
    const uint32_t taken = row->directions + row->lines; /* one of both is 0 */
    report->directions = taken > report->directions ? taken : report->directions;
    report->fallbacks += row->fallbacks;
    const double sum = row->rows ? sum_of_row(row, rows->bed->facts.walls) : 0;
    if (sum != 0) /* 0: there is no row, or the sphere emits nothing */
        report->closure_error = larger_of(report->closure_error, fabs(sum - 1));
}

static int run_row(void *tasks, int thread, uint32_t task) {
    const struct row_tasks *rows = tasks;
    fibrad_bed *bed = rows->bed;
    const uint32_t i = rows->order[task];
    fibrad_row row = {.rows = &bed->team.rows[thread]};
    uint64_t rays = 0;
    const int status = rows->row(rows->rule, bed->scene, &bed->team.work[thread], i, &row, &rays);
    if (status) return status;
    row.sphere = i; /* rows of displacements leave it 0 */
    note_row(rows, thread, &row);
    rows->report[thread].rays += rays;
    return FIBRAD_OK;
}

int fibrad_row_by_beams(const void *rule, const fibrad_scene *scene, fibrad_work *work, uint32_t i, fibrad_row *row,
                        uint64_t *rays) {
    (void)rays;
    return fibrad_beam_row(scene, work, i, rule, row);
}

static void exchange(uint32_t *order, uint32_t a, uint32_t b) {
    const uint32_t i = order[a];
    order[a] = order[b], order[b] = i;
}

/* A sphere of k mean radii has k^2 times the discs in a window, so its row takes long. Threads take `chunk` rows at a
 * time. Each of the first chunks begins with the row of a sphere far larger than the mean. The order is the same for
 * any number of threads, and so is the row that fails first. */
static void put_long_first(const fibrad_spheres *s, uint32_t *order, uint32_t count, uint32_t chunk) {
    uint32_t longs = 0;
    double sum = 0;
    for (uint32_t i = 0; i < s->n; ++i) sum += s->r[i];
    for (uint32_t k = 0; k < count; ++k)
        if (s->r[order[k]] * s->n > LONG_RATIO * sum) exchange(order, k, longs++);
    for (uint32_t k = longs; k-- > 1;)
        if (k < count / chunk) exchange(order, k, k * chunk);
}

/* Lists the wanted spheres in the order of the cells. Returns their number. */
static uint32_t list_spheres(const fibrad_bed *bed, const unsigned char *wanted, uint32_t *order) {
    uint32_t count = 0;
    for (uint32_t k = 0; k < bed->facts.spheres; ++k) {
        const uint32_t i = fibrad_scene_sphere(bed->scene, k);
        if (!wanted || wanted[i]) order[count++] = i;
    }
    return count;
}

int fibrad_bed_rows(fibrad_bed *bed, fibrad_row_method *row, const void *rule, const unsigned char *wanted,
                    fibrad_rows_report *report) {
    const uint32_t n = bed->facts.spheres;
    fibrad_team *team = &bed->team;
    uint32_t *order = malloc(((size_t)n + 1) * sizeof *order), failed;
    fibrad_rows_report *part = calloc((size_t)team->threads, sizeof *part);
    int status = order && part ? FIBRAD_OK : FIBRAD_E_MEMORY;
    *report = (fibrad_rows_report){0};
    for (int t = 0; t < team->threads; ++t) fibrad_rows_clear(&team->rows[t]);
    if (!status) {
        struct row_tasks tasks = {bed, row, rule, order, part};
        const uint32_t count = list_spheres(bed, wanted, order);
        const int chunk = count < ROWS_AT_ONCE * (uint32_t)team->threads ? 1 : ROWS_AT_ONCE;
        put_long_first(&bed->spheres, order, count, (uint32_t)chunk);
        status = fibrad_team_run(team, "rows", count, chunk, run_row, &tasks, &failed);
        if (status && failed < count) bed->fault = (fibrad_fault){order[failed], order[failed], team->triangle, 0, 0};
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
    if (status || !bed->bodies) return status;
    return fibrad_bodies_merge(bed->bodies, &bed->spheres, bed->facts.walls, bed->scratch, team);
}

/* ---- lines ------------------------------------------------------------------------------------------------------ */

/* Masks take the place of the points of a window: 16, 32 and 64 chords for 64, 128 and 256 points. */
enum { POINTS_PER_CHORD = 4 };

/* Rows along lines serve a matrix. Directions alone can be turned. */
static bool takes_lines(const fibrad_beam_rule *beam) {
    return !beam->lines && !beam->turn && beam->directions <= FIBRAD_DIRECTIONS_AS_LINES;
}

/* The default number of lines. Small scenes have more lines, of which nobody feels the time: this many windows take
 * about 10 ms. */
enum { WINDOWS_UNFELT = 40000 };
static uint32_t default_lines(const fibrad_scene_facts *facts) {
    const uint32_t usual = facts->walls > 0 ? FIBRAD_LINES_AMONG_WALLS : FIBRAD_LINES_DEFAULT;
    const uint32_t lines = facts->spheres > 0 ? WINDOWS_UNFELT / facts->spheres : 0;
    if (lines <= usual) return usual;
    return lines < FIBRAD_LINES_EVEN_MAX ? lines : FIBRAD_LINES_EVEN_MAX;
}

/* Makes a rule with so many lines, or with those of the largest set. *block: out: to be freed. */
static int take_lines(fibrad_beam_rule *rule, uint32_t lines, void **block) {
    if (lines > FIBRAD_LINES_EVEN_MAX) lines = FIBRAD_LINES_EVEN_MAX;
    const size_t size = fibrad_line_set_size(lines);
    fibrad_line_set *set = NULL;
    if (!size) return FIBRAD_E_ARGUMENT;
    *block = malloc(size);
    const int status = *block ? fibrad_line_set_init(&set, *block, size, lines) : FIBRAD_E_MEMORY;
    rule->lines = set, rule->directions = 0;
    return status;
}

/* Triangles are seen in one sense of each line, and the senses are spread less evenly than as many directions. So rows
 * among triangles go along directions. Few spheres have so many lines that these suffice. */
int fibrad_bed_line_rows(fibrad_bed *bed, const fibrad_beam_rule *beam, fibrad_rows_report *report) {
    fibrad_beam_rule rule = beam ? *beam : (fibrad_beam_rule){0};
    void *block = NULL;
    int status = FIBRAD_OK;
    if (takes_lines(&rule)) {
        const uint32_t lines = rule.directions ? rule.directions : default_lines(&bed->facts);
        if (rule.points % 64 || rule.points > 256 || rule.points == 192) return FIBRAD_E_TABLE;
        if (bed->facts.triangles == 0 || default_lines(&bed->facts) > FIBRAD_LINES_AMONG_WALLS)
            status = take_lines(&rule, lines, &block);
        else
            rule.directions = lines, rule.chords = rule.chords ? rule.chords : FIBRAD_CHORDS_SUITED;
        if (rule.points > 0) rule.chords = rule.points / POINTS_PER_CHORD, rule.points = 0;
    }
    if (!status) status = fibrad_bed_rows(bed, fibrad_row_by_beams, &rule, NULL, report);
    free(block);
    return status;
}

/* ---- matrix ----------------------------------------------------------------------------------------------------- */

/* The number of tasks of averaging: some per thread. If rows are in files, there are more, so that the bytes that one
 * task writes stay in memory. */
static uint32_t average_tasks(const fibrad_bed *bed) {
    const fibrad_team *team = &bed->team;
    if (team->threads == 1 && !bed->scratch) return 1;
    const uint32_t threads = (uint32_t)team->threads,
                   some = threads < AVERAGES_MAX / AVERAGES ? AVERAGES * threads : AVERAGES_MAX;
    const uint32_t tasks = threads > some ? threads : some;
    uint64_t bytes = 0;
    for (int t = 0; t < team->threads && bed->scratch; ++t)
        bytes += 2 * team->rows[t].entries * (sizeof(double) + sizeof(uint32_t));
    const uint64_t more = bytes / FILED_BYTES < FILED_MAX ? bytes / FILED_BYTES : FILED_MAX;
    return more > tasks ? (uint32_t)more : tasks;
}

static int make_matrix(fibrad_bed *bed, const fibrad_matrix_rule *rule, fibrad_matrix **matrix, fibrad_scratch *store) {
    fibrad_team *team = &bed->team;
    fibrad_matrix_rule divided = *rule;
    divided.tasks = average_tasks(bed);
    if (bed->bodies) divided.bodies = bed->bodies->n, divided.area = bed->bodies->area;
    divided.parallel = fibrad_team_share, divided.context = team;
    const size_t size = fibrad_matrix_size(bed->scene, team->rows, (uint32_t)team->threads, &divided);
    if (!size) return FIBRAD_E_ARGUMENT;
    int status = fibrad_scratch_open(store, bed->scratch);
    if (status) return status;
    if (!fibrad_scratch_resize(store, NULL, size)) return FIBRAD_E_MEMORY;
    status =
        fibrad_matrix_init(matrix, store->block, size, bed->scene, team->rows, (uint32_t)team->threads, &divided, NULL);
    return status ? status : fibrad_matrix_close(*matrix);
}

/* Factors and the memory they own. */
struct owned_factors {
    fibrad_bed_matrix factors; /* first: fibrad_bed_matrix_free casts its address to that of the whole */
    fibrad_scratch store;      /* of the matrix */
    double area[];
};

void fibrad_bed_matrix_free(fibrad_bed_matrix *factors) {
    if (!factors) return;
    fibrad_scratch_close(&((struct owned_factors *)factors)->store);
    free(factors);
}

int fibrad_bed_average(fibrad_bed *bed, const fibrad_matrix_rule *rule, const fibrad_rows_report *report,
                       fibrad_bed_matrix **factors) {
    const uint32_t walls = bed->facts.walls;
    const fibrad_bodies *bodies = bed->bodies;
    const size_t areas = walls + (bodies ? bodies->n : 0), spheres = bodies ? bed->facts.spheres : 0;
    struct owned_factors *owned =
        calloc(1, sizeof *owned + areas * sizeof *owned->area + spheres * sizeof *bodies->body);
    fibrad_matrix *matrix;
    if (!owned) return FIBRAD_E_MEMORY;
    int status = make_matrix(bed, rule, &matrix, &owned->store);
    if (!status) status = fibrad_matrix_read(matrix, &owned->factors.matrix);
    if (status) {
        fibrad_bed_matrix_free(&owned->factors);
        return status;
    }
    fibrad_bed_matrix *f = &owned->factors;
    for (uint32_t b = 0; b < walls; ++b) owned->area[b] = fibrad_scene_wall_area(bed->scene, b);
    f->wall_area = owned->area;
    if (bodies) {
        f->area = memcpy(owned->area + walls, bodies->area, bodies->n * sizeof *bodies->area);
        f->body = memcpy(owned->area + areas, bodies->body, spheres * sizeof *bodies->body);
    }
    f->facts = bed->facts;
    f->threads = bed->team.threads;
    f->directions = report->directions;
    f->fallbacks = report->fallbacks;
    f->rays = report->rays;
    f->closure_error = report->closure_error;
    f->seconds = omp_get_wtime() - bed->begun;
    f->reciprocity_error = NAN;
    if (report->rows == bed->facts.spheres) fibrad_matrix_reciprocity(matrix, &f->reciprocity_error);
    *factors = f;
    return FIBRAD_OK;
}
