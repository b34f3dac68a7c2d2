/* command_join.c - `fibrad join`: the rows that the ranks of a simulation wrote, as one matrix.
 * SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/message.h"
#include "cli/options.h"
#include "command/commands.h"
#include "read/read_rows.h"
#include "simple/heap.h"
#include "write/outputs.h"

struct join_request {
    const char **files; /* [count] */
    size_t count;
    struct outputs outputs;
    bool raw, positions, quiet;
    struct report report;
};

static int take_rows_file(const char *path, void *join_request) {
    struct join_request *request = join_request;
    request->files[request->count++] = path;
    return STATUS_OK;
}

static const struct option join_table[] = {
    {0, "", NULL, NULL, TO_REQUEST(take_rows_file)},
    {0, "raw", NULL, "leave the rows as they were computed [averaged and closed: A_i e_i D_ij = A_j e_j D_ji]",
     TO_FLAG(struct join_request, raw)},
    {OPTION_OUTPUT(
        "write the factors (.csv .mtx .npz .json, - for standard output) or the spheres (.vtp) [summary only]",
        struct join_request, outputs)},
    {OPTION_FORMAT(struct join_request, outputs)},
    {0, "positions", NULL, "name spheres by positions from 0, in the order of ids [by ids]",
     TO_FLAG(struct join_request, positions)},
    {0, "json", "OUT", "write the summary as JSON, with all digits [none]",
     TO_PATH(struct join_request, outputs.summary)},
    {0, "quiet", NULL, "print no summary", TO_FLAG(struct join_request, quiet)},
    {OPTION_HELP},
    {.name = NULL}};

static int join_help(void) {
    puts("fibrad join FILE.rows... [options]\n\n"
         "Puts the rows that all ranks of a simulation wrote in one step (fix fibrad ... rows NAME: NAME.0.rows,\n"
         "NAME.1.rows, ...) together into one matrix. The matrix has exchange factors, or view factors if all\n"
         "emissivities are 1.\n");
    options_print(join_table);
    puts("\n"
         "Outputs have the form of fibrad factors. In .csv the surroundings are j = -1 and walls are j = -2, -3,\n"
         "... The next number is `beyond`, the fraction that leaves the cutoff and whose end is not followed. To give\n"
         "it back, multiply the entries of a row by 1/(1 - beyond). Rows are in the order of ids. .npz always has\n"
         "the ids.\n"
         "\n"
         "Memory: 24 bytes for each entry with --raw, 36 without. Standard output ends with a summary, one `key\n"
         "value` on a line.\n"
         "\n"
         "Examples:\n"
         "  fibrad join bed.*.rows -o D.npz\n"
         "  fibrad join bed.*.rows --raw -o D.csv -o D.vtp");
    return STATUS_OK;
}

/* Makes the scene of a matrix. The matrix needs the radii and the number of walls. Files of rows do not say where the
 * walls are, so each wall gets the same triangle above all spheres. */
static int join_scene(const struct joined *joined, fibrad_scene **scene, void **block) {
    const double *x = joined->x;
    const fibrad_spheres spheres = {x, x + 1, x + 2, joined->radius, joined->n, .stride = 3};
    const uint32_t walls = joined->n > 0 ? joined->walls : 0;
    double top = -INFINITY;
    for (uint32_t i = 0; i < joined->n; ++i) top = fmax(top, x[3 * (size_t)i + 2] + joined->radius[i]);
    double vertex[3][3] = {{0}};
    for (int k = 0; k < 3 && joined->n > 0; ++k) {
        vertex[k][0] = x[0] + (k == 1) * joined->radius[0];
        vertex[k][1] = x[1] + (k == 2) * joined->radius[0];
        vertex[k][2] = top;
    }
    fibrad_wall wall[FIBRAD_WALLS_MAX];
    uint32_t corner[FIBRAD_WALLS_MAX][3], front[FIBRAD_WALLS_MAX];
    for (uint32_t k = 0; k < walls; ++k) {
        wall[k] = (fibrad_wall){.kind = FIBRAD_WALL_MESH};
        for (uint32_t c = 0; c < 3; ++c) corner[k][c] = c;
        front[k] = k;
    }
    struct fibrad_triangles triangles = {.x = vertex[0], .y = vertex[0] + 1, .z = vertex[0] + 2, .stride = 3};
    triangles.vertices = 3, triangles.corner = corner[0], triangles.front = front, triangles.n = walls;
    const fibrad_scene_config config = {.wall = wall, .walls = walls, .triangles = walls ? &triangles : NULL};
    fibrad_fault fault = {joined->n, joined->n, UINT32_MAX, 0, 0};
    const int status = fibrad_heap_scene(scene, block, &config, &spheres, &fault);
    if (!status) return STATUS_OK;
    if (status == FIBRAD_E_MEMORY) return message_memory();
    if (fault.first >= joined->n || fault.second >= joined->n)
        return message(STATUS_INPUT, "these rows cannot be joined: %s", fibrad_status_text(status));
    return message(STATUS_INPUT, "ids %" PRIu64 " and %" PRIu64 ": %s", joined->id[fault.first],
                   joined->id[fault.second], fibrad_status_text(status));
}

/* Makes the matrix of the rows in *block. The caller frees *block also after an error. */
static int join_matrix(const struct join_request *request, const struct joined *joined, const fibrad_scene *scene,
                       fibrad_bed_matrix *factors, void **block) {
    const fibrad_matrix_rule rule = {.kind = joined->emissive ? FIBRAD_ROWS_EXCHANGE : FIBRAD_ROWS_AREAS,
                                     .emissivity = joined->emissive ? joined->emissivity : NULL,
                                     .raw = request->raw};
    fibrad_matrix *matrix;
    uint32_t sphere = 0;
    const size_t size = fibrad_matrix_size(scene, &joined->rows, 1, &rule);
    *block = size ? malloc(size) : NULL;
    if (!*block) return message_memory();
    int status = fibrad_matrix_init(&matrix, *block, size, scene, &joined->rows, 1, &rule, &sphere);
    if (!status) status = fibrad_matrix_close(matrix);
    if (!status) status = fibrad_matrix_read(matrix, &factors->matrix);
    if (!status) status = fibrad_matrix_reciprocity(matrix, &factors->reciprocity_error);
    fibrad_scene_describe(scene, &factors->facts);
    return status ? message(STATUS_INPUT, "these rows cannot be joined: %s", fibrad_status_text(status)) : STATUS_OK;
}

static void join_report(struct join_request *request, const struct joined *joined, const struct contents *what) {
    const fibrad_factors *matrix = &what->factors->matrix;
    struct report *report = &request->report;
    struct summary summary;
    summary_make(&summary, what);
    report_begin(report);
    report_text(report, "factors", joined->emissive ? "exchange" : "view");
    report_text(report, "rows", request->raw ? "raw" : "reciprocal");
    report_count(report, "ranks", joined->ranks);
    report_count(report, "step", joined->step);
    report_count(report, "spheres", matrix->n);
    report_text(report, "named_by", request->positions ? "positions" : "ids");
    report_value(report, "radius_min", what->factors->facts.radius_min, 6);
    report_value(report, "radius_max", what->factors->facts.radius_max, 6);
    report_value(report, "cutoff", joined->cutoff, 6);
    summary_report(&summary, what, report);
    report_end(report);
}

/* Writes the matrix and its summary. x: room for [3][n] numbers. */
static int join_write(struct join_request *request, const struct joined *joined, double *x,
                      const fibrad_bed_matrix *factors) {
    double unbounded[FIBRAD_WALLS_MAX];
    const size_t n = joined->n;
    for (size_t b = 0; b < FIBRAD_WALLS_MAX; ++b) unbounded[b] = INFINITY;
    for (size_t k = 0; k < 3 * n; ++k) x[k % 3 * n + k / 3] = joined->x[k];
    const struct array ids = {"ids.npy", "u8", joined->id, n, 0};
    struct bed bed = {.n = joined->n, .ids = !request->positions, .id = (int64_t *)joined->id};
    bed.x = x, bed.y = x + n, bed.z = x + 2 * n, bed.r = joined->radius;
    bed.frame = bed.timestep = (int64_t)joined->step; /* the frame is the number for a * in OUT */
    const struct walls walls = {.count = joined->walls};
    const fibrad_exchange_rule grey = {.emissivity = joined->emissivity, .wall_emissivity = unbounded};
    fibrad_bed_matrix with_areas = *factors;
    with_areas.wall_area = unbounded; /* not known; INFINITY leaves out the rows of walls */
    struct contents what = {.bed = &bed, .factors = &with_areas, .walls = &walls, .array = &ids, .arrays = 1};
    if (joined->emissive) what.grey = &grey;
    const int status = outputs_write(&request->outputs, &what);
    if (!status) join_report(request, joined, &what);
    return status;
}

static int join_solve(struct join_request *request, const struct joined *joined) {
    fibrad_scene *scene = NULL;
    void *scene_block = NULL, *matrix_block = NULL;
    double *x = malloc(3 * sizeof *x * joined->n + 1);
    fibrad_bed_matrix factors = {0};
    int status = x ? join_scene(joined, &scene, &scene_block) : message_memory();
    if (!status) status = join_matrix(request, joined, scene, &factors, &matrix_block);
    if (!status) status = interrupt_status();
    if (!status) status = join_write(request, joined, x, &factors);
    free(scene_block);
    free(matrix_block);
    free(x);
    return status;
}

/* Refuses ids that are too large to name spheres. */
static int join_names(const struct join_request *request, const struct joined *joined) {
    if (request->positions || joined->n == 0 || joined->id[joined->n - 1] <= INT64_MAX) return STATUS_OK;
    return message(STATUS_INPUT, "id %" PRIu64 " is too large for a name; --positions names spheres by positions",
                   joined->id[joined->n - 1]);
}

/* Reads rows, makes the matrix and writes it. Outputs are opened first: a path that cannot be written is an error
 * before any work is done. */
static int join_run(struct join_request *request) {
    struct joined joined = {0};
    int status = outputs_open(&request->outputs);
    request->report = outputs_report(&request->outputs, request->quiet);
    if (!status) report_open(&request->report, "join");
    if (!status) status = read_rows(request->files, request->count, &joined);
    if (!status) status = join_names(request, &joined);
    if (!status) status = join_solve(request, &joined);
    if (!status) report_close(&request->report);
    joined_free(&joined);
    return outputs_close(&request->outputs, status);
}

int command_join(int argc, char **argv) {
    struct join_request request = {.files = calloc((size_t)argc + 1, sizeof *request.files)};
    if (!request.files) return message_memory();
    int status = options_read("join", join_table, argc, argv, &request);
    if (!status && request.count == 0) status = message(STATUS_USAGE, "FILE is missing; see fibrad join --help");
    if (!status) status = outputs_check(&request.outputs, CONTENT_MATRIX, false);
    const int ended = status == STATUS_HELP ? join_help() : status ? status : join_run(&request);
    free(request.files);
    return ended;
}
