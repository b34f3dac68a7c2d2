/* command_pair.c - `fibrad pair`: the view factor between two spheres. SPDX-License-Identifier: MIT */
#include <gsl/gsl_errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "cli/options.h"
#include "cli/output.h"
#include "command/commands.h"
#include "fibrad_surface.h"
#include "papers/pair/exact_gsl.h"
#include "papers/pair/reference.h"
#include "text/report.h"
#include "simple/heap.h"

/* With obstacles: default errors, a larger one if spheres overlap, since visible areas then jump; and most directions.
 */
#define ERROR_APART   1e-9
#define ERROR_OVERLAP 1e-5
#define DIRECTIONS    5000000

enum { SPHERES_MAX = 1000 };

struct pair_request {
    double r1, r2, gap;
    int given; /* how many of these three were given */
    /* sphere 1, sphere 2, obstacles */
    uint32_t n;
    double x[SPHERES_MAX], y[SPHERES_MAX], z[SPHERES_MAX], r[SPHERES_MAX];
    bool by_surface; /* --method surface */
    fibrad_surface_rule surface;
    bool plain;       /* --no-correction */
    double error;     /* 0: not given */
    const char *json; /* NULL: not given */
    struct report report;
    bool check;
};

static int take_obstacle(const char *text, void *pair_request) {
    struct pair_request *request = pair_request;
    double sphere[4];
    int count;
    const int status = options_numbers("--obstacle", text, 4, sphere, &count);
    if (status) return status;
    if (count != 4 || !(sphere[3] > 0))
        return message(STATUS_USAGE, "--obstacle: '%.60s' is not X,Y,Z,R with R above 0", text);
    if (request->n == SPHERES_MAX) return message(STATUS_USAGE, "more than %d obstacles", SPHERES_MAX - 2);
    const uint32_t i = request->n++;
    request->x[i] = sphere[0];
    request->y[i] = sphere[1];
    request->z[i] = sphere[2];
    request->r[i] = sphere[3];
    return STATUS_OK;
}

static int take_length(const char *text, void *pair_request) {
    struct pair_request *request = pair_request;
    static const char *const name[] = {"R1", "R2", "GAP"};
    double *const length[] = {&request->r1, &request->r2, &request->gap};
    const int k = request->given++;
    if (k < 3)
        return options_number(name[k], text, k < 2 ? FIBRAD_LENGTH_MIN : -FIBRAD_LENGTH_MAX, FIBRAD_LENGTH_MAX,
                              length[k]);
    return message(STATUS_USAGE, "three lengths are allowed, not also '%.40s'; see fibrad pair --help", text);
}

static int take_method(const char *text, void *by_surface) {
    *(bool *)by_surface = strcmp(text, "surface") == 0;
    if (*(bool *)by_surface || strcmp(text, "exact") == 0) return STATUS_OK;
    return message(STATUS_USAGE, "--method: '%.40s' is neither exact nor surface; fibrad factors has more", text);
}

/* Takes the argument of --nf, a built-in number of nodes, into a uint32_t. */
static int take_nodes(const char *text, void *nodes) {
    uint32_t *wanted = nodes;
    const int status = options_count("--nf", text, 1, UINT32_MAX, wanted);
    char sizes[64] = "";
    int length = 0;
    for (uint32_t size = FIBRAD_NODES_MIN, next = 13, sum; size <= FIBRAD_NODES_MAX && !status;
         size = next, next = sum) {
        if (*wanted == size) return STATUS_OK;
        length += snprintf(sizes + length, sizeof sizes - (size_t)length, "%s%" PRIu32, length ? ", " : "", size);
        sum = size + next;
    }
    return status ? status : message(STATUS_USAGE, "--nf: %.40s is not built in; %s are", text, sizes);
}

static const struct option pair_table[] = {
    {0, "", NULL, NULL, TO_REQUEST(take_length)},
    {0, "method", "NAME", "exact or surface (nodes on surfaces) [exact]",
     TO_FUNCTION(take_method, struct pair_request, by_surface)},
    {0, "obstacle", "X,Y,Z,R", "a sphere in the way; may be repeated [none]", TO_REQUEST(take_obstacle)},
    {0, "error", "E",
     "exact, with obstacles: error allowed, estimated, relative to the factor without obstacles, 1e-12 to 1; if "
     "spheres overlap, each further digit takes ten times as long [1e-9; 1e-5 if spheres overlap]",
     TO_NUMBER(struct pair_request, error, 1e-12, 1)},
    {0, "check", NULL, "compare the exact factor with a quadrature by GSL [off]", TO_FLAG(struct pair_request, check)},
    {0, "nf", "N",
     "surface: nodes on each sphere, a Fibonacci number from " TEXT_OF(FIBRAD_NODES_MIN) " to " TEXT_OF(
         FIBRAD_NODES_MAX) " [" TEXT_OF(FIBRAD_NODES_DEFAULT) "]",
     TO_FUNCTION(take_nodes, struct pair_request, surface.nodes)},
    {0, "no-correction", NULL, "surface: plain sums [corrected by the exact factor without obstacles]",
     TO_FLAG(struct pair_request, plain)},
    {0, "json", "OUT", "write the output as JSON, with all digits [none]", TO_PATH(struct pair_request, json)},
    {OPTION_HELP},
    {.name = NULL}};

static int pair_help(void) {
    puts("fibrad pair R1 R2 GAP [options]\n\n"
         "View factor from sphere 1 to sphere 2. Sphere 1 has the radius R1 and its centre at the origin. Sphere 2\n"
         "has the radius R2 and its centre at 0,0,R1+R2+GAP. If GAP is negative, the spheres overlap. With\n"
         "obstacles, the method exact is a slow adaptive quadrature.\n");
    options_print(pair_table);
    puts("\nThe last line of the output is `F12 VALUE`.\n\n"
         "Examples:\n"
         "  fibrad pair 1 1 0\n"
         "  fibrad pair 1 0.3 0.05 --check\n"
         "  fibrad pair 1 1 1 --obstacle 0.8,0,1.5,0.4\n"
         "  fibrad pair 1 1 1 --obstacle 0.8,0,1.5,0.4 --method surface --nf 144");
    return STATUS_OK;
}

static int pair_parse(struct pair_request *request, int argc, char **argv) {
    request->n = 2; /* obstacles behind spheres 1 and 2 */
    const int status = options_read("pair", pair_table, argc, argv, request);
    if (status) return status;
    if (request->given < 3) return message(STATUS_USAGE, "R1, R2 and GAP are needed; see fibrad pair --help");
    if (request->check && (request->by_surface || request->n > 2))
        return message(STATUS_USAGE, "--check is for the exact factor without obstacles");
    if (request->error > 0 && (request->by_surface || request->n == 2))
        return message(STATUS_USAGE, "--error is for the exact factor with obstacles");
    if (request->gap <= -2 * fmin(request->r1, request->r2))
        return message(STATUS_USAGE, "GAP: %g: one sphere lies inside the other", request->gap);
    request->r[0] = request->r1;
    request->r[1] = request->r2;
    request->z[1] = request->r1 + request->r2 + request->gap;
    if ((request->surface.nodes || request->plain) && !request->by_surface)
        return message(STATUS_USAGE, "--nf and --no-correction are for --method surface");
    if (request->plain) request->surface.flags |= FIBRAD_SURFACE_NO_CORRECTION;
    if (!request->surface.nodes) request->surface.nodes = FIBRAD_NODES_DEFAULT;
    return STATUS_OK;
}

/* Compares the kernel's value with GSL. The difference is relative to the kernel's value. */
static int pair_check(struct pair_request *request, double f12) {
    double value = 0, abserr = 0;
    char text[120];
    const int error = exact_gsl_lens(request->r1, request->r2, request->gap, &value, &abserr);
    if (error) return message(STATUS_USAGE, "GSL: %s", gsl_strerror(error));
    report_value(&request->report, "kernel", f12, 17);
    snprintf(text, sizeof text, "%.17g error %.3g difference %.3g", value, abserr, value / f12 - 1);
    report_text(&request->report, "gsl_lens", text);
    return STATUS_OK;
}

static int pair_exact(struct pair_request *request, double *f12) {
    const int status = fibrad_pair_exact(request->r1, request->r2, request->gap, f12);
    if (status) return message(STATUS_USAGE, "%s", fibrad_status_text(status));
    if (request->r1 + request->r2 + request->gap < fmax(request->r1, request->r2))
        message(STATUS_OK, "warning: the centre of one sphere lies inside the other; beds and the other methods refuse "
                           "such spheres");
    return request->check ? pair_check(request, *f12) : STATUS_OK;
}

static const char *pair_name(uint32_t i, char text[32]) {
    if (i < 2)
        snprintf(text, 32, "sphere %" PRIu32, i + 1);
    else
        snprintf(text, 32, "obstacle %" PRIu32, i - 1);
    return text;
}

/* The spheres from `first` on. */
static fibrad_spheres pair_spheres(const struct pair_request *request, uint32_t first) {
    return (fibrad_spheres){.x = request->x + first,
                            .y = request->y + first,
                            .z = request->z + first,
                            .r = request->r + first,
                            .n = request->n - first};
}

/* Refuses spheres that make no scene. facts: of the scene. */
static int pair_facts(const struct pair_request *request, fibrad_scene_facts *facts) {
    const fibrad_spheres spheres = pair_spheres(request, 0);
    fibrad_scene *scene;
    fibrad_fault fault;
    void *block;
    char first[32], second[32];
    const int status = fibrad_heap_scene(&scene, &block, NULL, &spheres, &fault);
    if (!status) fibrad_scene_describe(scene, facts);
    free(block);
    if (status == FIBRAD_E_MEMORY) return message_memory();
    if (!status) return STATUS_OK;
    return message(STATUS_USAGE, "%s and %s: %s", pair_name(fault.first, first), pair_name(fault.second, second),
                   fibrad_status_text(status));
}

/* The exact factor with obstacles. report_wanted warns if the error is not reached: that of --error, or the default. */
static int pair_reference(struct pair_request *request, double *f12) {
    const fibrad_spheres spheres = pair_spheres(request, 0);
    fibrad_scene_facts facts;
    struct reference_report report;
    int status = pair_facts(request, &facts);
    if (status) return status;
    const double usual = facts.overlap_max > 0 ? ERROR_OVERLAP : ERROR_APART;
    const struct reference_rule rule = {.tolerance = request->error > 0 ? request->error : usual,
                                        .max_evaluations = DIRECTIONS};
    status = reference_pair(&spheres, 0, 1, &rule, f12, &report);
    if (status == REFERENCE_MEMORY) return message_memory();
    if (status == REFERENCE_ARGUMENT) return message(STATUS_USAGE, "these spheres cannot be computed");
    report_count(&request->report, "evaluations", report.evaluations);
    report_value(&request->report, "error_estimate", report.error, 3);
    report_wanted(&request->report, NULL, rule.tolerance, rule.tolerance, report.error,
                  "the factor over that without obstacles");
    return STATUS_OK;
}

static int pair_surface(struct pair_request *request, double *f12) {
    const fibrad_spheres obstacles = pair_spheres(request, 2);
    fibrad_scene_facts of_scene;
    fibrad_surface_facts facts;
    int status = pair_facts(request, &of_scene);
    if (status) return status;
    double *scratch = malloc(FIBRAD_SURFACE_SCRATCH(obstacles.n) * sizeof *scratch);
    if (!scratch) return message_memory();
    status = fibrad_surface_pair(request->r1, request->r2, request->gap, &obstacles, &request->surface, scratch, f12,
                                 &facts);
    free(scratch);
    if (status) return message(STATUS_USAGE, "%s", fibrad_status_text(status));
    report_value(&request->report, "error_estimate", facts.error, 3);
    return STATUS_OK;
}

static int pair_compute(struct pair_request *request) {
    double f12 = 0;
    int status;
    if (request->by_surface)
        status = pair_surface(request, &f12);
    else
        status = request->n > 2 ? pair_reference(request, &f12) : pair_exact(request, &f12);
    if (!status) report_value(&request->report, "F12", f12, 17);
    return status;
}

static int pair_run(struct pair_request *request) {
    struct output json = {0};
    int status = output_open(&json, request->json);
    request->report =
        (struct report){.text = request->json && output_stdout(request->json) ? stderr : stdout, .json = json.file};
    if (!status) {
        report_open(&request->report, "pair");
        report_begin(&request->report);
        status = pair_compute(request);
        report_end(&request->report);
        report_close(&request->report);
    }
    return output_close(&json, status);
}

int command_pair(int argc, char **argv) {
    struct pair_request *request = calloc(1, sizeof *request);
    if (!request) return message_memory();
    int status = pair_parse(request, argc, argv);
    if (status == STATUS_HELP)
        status = pair_help();
    else if (!status)
        status = pair_run(request);
    free(request);
    return status;
}
