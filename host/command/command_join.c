/* command_join.c - `fibrad join`: the rows that the ranks of a simulation wrote, as one matrix.
 * SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/output.h"
#include "command/commands.h"
#include "read/read_rows.h"
#include "simple/heap.h"
#include "write/write.h"

static const struct option join_table[] = {
    {KEY_RAW, "raw", NULL, "leave the rows as they were computed [averaged and closed: A_i e_i D_ij = A_j e_j D_ji]"},
    {'o', "output", "OUT", "the factors: .csv, .mtx, .npz (SciPy) [summary only]"},
    {KEY_IDS, "ids", NULL, "in .csv the ids of the simulation [positions from 0 in the order of ids]"},
    {OPTION_HELP},
    {0, NULL, NULL, NULL}};

struct join_request {
    const char **files; /* [count] */
    size_t count;
    const char *out;
    write_function *write;
    bool raw, ids;
};

static int join_help(void) {
    puts(
        "fibrad join FILE.rows... [options]\n\n"
        "The rows that all ranks of a simulation wrote in one step (fix fibrad ... rows NAME: NAME.0.rows, NAME.1.rows "
        "...),\n"
        "put together into one matrix: exchange factors, or view factors where all emissivities are 1.\n");
    options_print(join_table);
    puts("\nThe .csv is that of fibrad exchange: spheres by position in the order of ids, the surroundings j = -1, "
         "walls\n"
         "j = -2, -3 ..., then what is beyond the cutoff. The .npz has besides the matrix: ids, escaped, beyond, "
         "error,\n"
         "radius, emissivity [n], body [n][walls], x [n][3]. What is beyond may be given back: entries times 1/(1 - "
         "beyond).\n"
         "Memory: 24 bytes an entry with --raw, 36 without. Standard output ends with a summary, one `key value` a "
         "line.\n\n"
         "Examples:\n"
         "  fibrad join bed.*.rows -o D.npz\n"
         "  fibrad join bed.*.rows --raw --ids -o D.csv");
    return STATUS_OK;
}

static int join_take(struct join_request *request, const struct options *options, int key) {
    switch (key) {
    case OPTIONS_POSITIONAL:
        request->files[request->count++] = options->value;
        return STATUS_OK;
    case KEY_HELP:
        return STATUS_HELP;
    case KEY_RAW:
        request->raw = true;
        return STATUS_OK;
    case KEY_IDS:
        request->ids = true;
        return STATUS_OK;
    case 'o':
        request->out = options->value;
        return STATUS_OK;
    default:
        return STATUS_USAGE; /* OPTIONS_BAD: the message is out */
    }
}

static int join_check(struct join_request *request) {
    request->write = write_find(request->out, NULL);
    if (request->count == 0) return message(STATUS_USAGE, "which FILEs? see fibrad join --help");
    if (request->out && (!request->write || request->write == write_vtp))
        return message_at(STATUS_USAGE, request->out, 0, "unknown ending; there are .csv, .mtx and .npz");
    if (request->ids && request->write != write_csv) return message(STATUS_USAGE, "--ids is for -o OUT.csv only");
    for (size_t k = 0; request->out && k < request->count; ++k)
        if (output_same(request->files[k], request->out))
            return message_at(STATUS_USAGE, request->out, 0, "is one of the files; it would be replaced");
    return STATUS_OK;
}

static int join_parse(struct join_request *request, int argc, char **argv) {
    struct options options = {.command = "join", .table = join_table, .argc = argc, .argv = argv};
    int status = STATUS_OK;
    for (int key; !status && (key = options_next(&options)) != OPTIONS_END;) status = join_take(request, &options, key);
    return status ? status : join_check(request);
}

/* A body below or above all spheres. */
static fibrad_body wall_beside(const struct joined *joined, int axis, int upper) {
    double at = 0;
    for (uint32_t i = 0; i < joined->n; ++i) {
        const double x = joined->x[3 * (size_t)i + (size_t)axis], r = joined->radius[i];
        at = i == 0 ? (upper ? x + r : x - r) : upper ? fmax(at, x + r) : fmin(at, x - r);
    }
    return (fibrad_body){.kind = FIBRAD_BODY_PLANE, .plane = {axis, upper, at}};
}

/* The scene of a matrix, which asks for radii and for how many bodies there are; not where, which is not known. */
static int join_scene(const struct joined *joined, fibrad_scene **scene, void **block) {
    const double *x = joined->x;
    const fibrad_spheres spheres = {x, x + 1, x + 2, joined->radius, joined->n, .stride = 3};
    fibrad_body body[6];
    for (uint32_t k = 0; k < joined->bodies && joined->n > 0; ++k)
        body[k] = wall_beside(joined, (int)k / 2, (int)k % 2);
    const fibrad_scene_config config = {.body = body, .bodies = joined->n > 0 ? joined->bodies : 0};
    fibrad_fault fault = {joined->n, joined->n};
    const int status = fibrad_heap_scene(scene, block, &config, &spheres, &fault);
    if (status == FIBRAD_OK) return STATUS_OK;
    if (status == FIBRAD_E_MEMORY) return message_memory();
    if (fault.first >= joined->n || fault.second >= joined->n)
        return message(STATUS_INPUT, "these rows cannot be joined: %s", fibrad_status_text(status));
    return message(STATUS_INPUT, "ids %" PRIu64 " and %" PRIu64 ": %s", joined->id[fault.first],
                   joined->id[fault.second], fibrad_status_text(status));
}

/* What the kernel makes of the rows, in *block, to be freed also after an error. */
static int join_matrix(const struct join_request *request, const struct joined *joined, const fibrad_scene *scene,
                       fibrad_bed_factors *factors, void **block) {
    const fibrad_matrix_rule rule = {.emissivity = joined->emissive ? joined->emissivity : NULL, .raw = request->raw};
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

static void join_print(const struct join_request *request, const struct joined *joined, const struct contents *what) {
    const fibrad_factors *matrix = &what->factors->matrix;
    struct summary summary;
    summary_make(&summary, what);
    printf("%" PRIu64 " ranks, step %" PRIu64 ": radii %g to %g, %s rows of %s factors\n", joined->ranks, joined->step,
           what->factors->facts.radius_min, what->factors->facts.radius_max, request->raw ? "raw" : "reciprocal",
           joined->emissive ? "exchange" : "view");
    printf("spheres %" PRIu32 "\n", matrix->n);
    printf("nonzeros %" PRIu64 "\n", matrix->start[matrix->n]);
    printf("cutoff %.17g\n", joined->cutoff);
    printf("row_sum_min %.17g\n", summary.row_sum_min);
    printf("row_sum_max %.17g\n", summary.row_sum_max);
    printf("escaped_mean %.17g\n", summary.escaped_mean);
    printf("beyond_mean %.17g\n", summary.beyond_mean);
    for (uint32_t k = 0; k < matrix->bodies; ++k) printf("wall_%" PRIu32 "_mean %.17g\n", k + 1, summary.wall_mean[k]);
    printf("closure_max %.17g\n", summary.closure_max);
    printf("reciprocity_max %.17g\n", what->factors->reciprocity_error);
    printf("error_rms %.17g\n", summary.error_rms);
    printf("error_estimate %.17g\n", summary.error_max);
}

/* Writes the matrix and what is known of it. */
static int join_write(const struct join_request *request, const struct joined *joined,
                      const fibrad_bed_factors *factors) {
    static const double unbounded[] = {INFINITY, INFINITY, INFINITY, INFINITY, INFINITY, INFINITY};
    const uint64_t n = joined->n;
    const fibrad_factors *matrix = &factors->matrix;
    const struct array arrays[] = {
        {"ids.npy", "u8", joined->id, n, 0},        {"escaped.npy", "f8", matrix->escaped, n, 0},
        {"beyond.npy", "f8", matrix->beyond, n, 0}, {"error.npy", "f8", matrix->error, n, 0},
        {"radius.npy", "f8", joined->radius, n, 0}, {"emissivity.npy", "f8", joined->emissivity, n, 0},
        {"x.npy", "f8", joined->x, n, 3},           {"body.npy", "f8", matrix->body, n, matrix->bodies}};
    const struct bed bed = {.n = joined->n, .ids = request->ids, .r = joined->radius, .id = (int64_t *)joined->id};
    const struct walls walls = {.count = joined->bodies};
    const fibrad_exchange_rule grey = {.emissivity = joined->emissivity, .body_emissivity = unbounded};
    fibrad_bed_factors with_areas = *factors;
    with_areas.body_area = unbounded; /* not known, so that there are no rows of walls */
    const struct contents what = {.bed = &bed,
                                  .factors = &with_areas,
                                  .walls = &walls,
                                  .grey = joined->emissive ? &grey : NULL,
                                  .array = arrays,
                                  .arrays = sizeof arrays / sizeof *arrays - (matrix->bodies == 0)};
    struct output out = {0};
    int status = output_open(&out, request->out);
    if (!status && request->out) status = request->write(out.file, &what);
    status = output_close(&out, status);
    if (!status) join_print(request, joined, &what);
    return status;
}

static int join_solve(const struct join_request *request, const struct joined *joined) {
    fibrad_scene *scene = NULL;
    void *scene_block = NULL, *matrix_block = NULL;
    fibrad_bed_factors factors = {0};
    int status = join_scene(joined, &scene, &scene_block);
    if (!status) status = join_matrix(request, joined, scene, &factors, &matrix_block);
    if (!status) status = interrupt_status();
    if (!status) status = join_write(request, joined, &factors);
    free(scene_block);
    free(matrix_block);
    return status;
}

int command_join(int argc, char **argv) {
    struct join_request request = {.files = calloc((size_t)argc + 1, sizeof *request.files)};
    struct joined joined = {0};
    if (!request.files) return message_memory();
    int status = join_parse(&request, argc, argv);
    if (status == STATUS_HELP)
        status = join_help();
    else if (!status) {
        status = read_rows(request.files, request.count, &joined);
        if (!status && request.ids && joined.n > 0 && joined.id[joined.n - 1] > INT64_MAX)
            status = message(STATUS_INPUT, "--ids: id %" PRIu64 " is too large for it", joined.id[joined.n - 1]);
        if (!status) status = join_solve(&request, &joined);
        joined_free(&joined);
    }
    free(request.files);
    return status;
}
