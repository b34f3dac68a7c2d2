/* command_conductivity.c - `fibrad conductivity`: effective radiative conductivity of a bed of grey spheres.
 * SPDX-License-Identifier: MIT
 *
 * In a linear field of temperature with gradient g the spheres of a volume V, each at the temperature of its centre,
 * carry the flux g/(2 V) sum over i, j of 4 sigma T^3 A_i e_i D_ij dz_ij^2 along the gradient, which is k g. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "bed/property_option.h"
#include "cli/message.h"
#include "command/bed_options.h"
#include "command/commands.h"

#define PI 3.14159265358979323846

/* On open axes only spheres emit whose centres are so many mean diameters inside all, and so many there have to be. */
#define MARGIN   4.0
#define EMITTERS 40u

/* What --error asks for is first estimated with so many paths in all; and the most there may be per sphere. */
#define PILOT   50000.0
#define PER_MAX 100000000.0

static const struct option conductivity_table[] = {
    {OPTION_EMISSIVITY},
    {KEY_RAYS, "rays", "N", "paths from each sphere; error ~ N^-0.5 [as many as --error takes]"},
    {KEY_ERROR, "error", "E", "as many as bring the estimated standard errors to E of F_E, 1e-4 to 1 [0.003]"},
    {KEY_SEED, "seed", "S", "another number, other paths and directions [0]"},
    OPTIONS_INPUT,
    OPTIONS_RUN,
    {0, NULL, NULL, NULL}};

struct conductivity_request {
    struct bed_options bed;
    struct quantity emissivity;
    fibrad_exchange_rule rule;
    double error;
};

/* The part of the bed that emits, and what comes of it. */
struct conductivity {
    double volume, diameter; /* [L^3] that belongs to them; [L] mean of all spheres */
    uint32_t emitters;
    double factor[3], error[3]; /* F_E per axis and its standard error */
    double escaped;             /* fraction of the emission that no sphere absorbs */
    uint64_t rays;
    double seconds;
};

static int conductivity_help(void) {
    puts("fibrad conductivity FILE --emissivity E|COLUMN [options]\n\n"
         "Exchange factor F_E = k/(4 sigma T^3 d) along each axis, k being the radiative conductivity [W/(m K)] of a "
         "bed of\n"
         "grey diffuse spheres, each of one temperature (their own conductivity is large), and d the mean diameter "
         "[m].\n"
         "FILE as for fibrad bed.\n");
    options_print(conductivity_table);
    printf("\nThe result is that of a linear field of temperature. With open axes only spheres at least %g mean "
           "diameters inside\n"
           "the outermost centres emit; all absorb.\n",
           MARGIN);
    puts("Standard output ends with lines `key value`, the last six F_E_x, F_E_y, F_E_z, F_E_x_error, F_E_y_error,\n"
         "F_E_z_error (standard errors, estimated).\n\n"
         "Examples:\n"
         "  fibrad conductivity packing.dump --emissivity 0.8\n"
         "  fibrad conductivity cell.csv --periodic 2,2,2 --emissivity 0.4 --error 0.001");
    return STATUS_OK;
}

static int conductivity_take(struct conductivity_request *request, const struct options *options, int key) {
    const char *value = options->value;
    switch (key) {
    case KEY_EMISSIVITY:
        return quantity_option("--emissivity", value, 0, 1, &request->emissivity);
    case KEY_RAYS:
        return options_count("--rays", value, 1, FIBRAD_PATHS_MAX, &request->rule.paths);
    case KEY_ERROR:
        return options_number("--error", value, 1e-4, 1, &request->error);
    case KEY_SEED:
        return options_whole("--seed", value, 0, UINT64_MAX, &request->rule.seed);
    default:
        return bed_options_take(&request->bed, options, key);
    }
}

static int conductivity_parse(struct conductivity_request *request, int argc, char **argv) {
    struct options options = {.command = "conductivity", .table = conductivity_table, .argc = argc, .argv = argv};
    *request = (struct conductivity_request){0};
    int status = STATUS_OK;
    for (int key; !status && (key = options_next(&options)) != OPTIONS_END;)
        status = conductivity_take(request, &options, key);
    if (status) return status;
    status = bed_options_check(&request->bed, "conductivity", CONTENT_MATRIX);
    if (status) return status;
    if (!request->emissivity.given) return message(STATUS_USAGE, "which --emissivity? see fibrad conductivity --help");
    if (request->error > 0 && request->rule.paths > 0)
        return message(STATUS_USAGE, "--error finds the rays itself; leave out --rays");
    if (request->error == 0) request->error = 0.003;
    request->emissivity.place = bed_options_column(&request->bed, request->emissivity.column);
    return STATUS_OK;
}

/* The part of the bed that emits, a box; infinite along periodic axes. */
struct core {
    double low[3], high[3], volume;
};

static int find_core(const struct bed *bed, const char *file, double diameter, struct core *core) {
    const double *at[3] = {bed->x, bed->y, bed->z};
    core->volume = 1;
    for (int axis = 0; axis < 3; ++axis) {
        core->low[axis] = -INFINITY;
        core->high[axis] = INFINITY;
        if (bed->period[axis] > 0) {
            core->volume *= bed->period[axis];
            continue;
        }
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = 0; i < bed->n; ++i) {
            low = fmin(low, at[axis][i]);
            high = fmax(high, at[axis][i]);
        }
        core->low[axis] = low + MARGIN * diameter;
        core->high[axis] = high - MARGIN * diameter;
        if (!(core->high[axis] > core->low[axis]))
            return message_at(STATUS_INPUT, file, 0, "too thin along %c, an open axis: %g mean diameters at the least",
                              'x' + axis, 2 * MARGIN);
        core->volume *= core->high[axis] - core->low[axis];
    }
    return STATUS_OK;
}

static bool is_inside(const struct core *core, const double at[3]) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(at[axis] >= core->low[axis] && at[axis] < core->high[axis])) return false;
    return true;
}

/* The fraction of a sphere that lies inside, by points: counting centres alone would be as rough as a small core is
 * small. */
static double part_inside(const struct bed *bed, uint32_t i, const struct core *core) {
    enum { POINTS = 256 };
    uint32_t count = 0;
    for (uint32_t k = 0; k < POINTS; ++k) {
        double w[3];
        fibrad_direction(k, POINTS, w);
        const double depth =
            bed->r[i] * cbrt(fmod((k + .5) * .7548776662466927, 1)); /* even in the cube of the radius */
        const double at[3] = {bed->x[i] + depth * w[0], bed->y[i] + depth * w[1], bed->z[i] + depth * w[2]};
        count += is_inside(core, at);
    }
    return count / (double)POINTS;
}

/* Marks the spheres that emit, and measures the volume that belongs to them: that of the spheres themselves over the
 * solid fraction of the core. */
static int choose_emitters(const struct bed *bed, const char *file, struct conductivity *result, unsigned char *emits) {
    struct core core;
    double solid = 0, emitting = 0;
    for (uint32_t i = 0; i < bed->n; ++i) result->diameter += 2 * bed->r[i] / bed->n;
    const int status = find_core(bed, file, result->diameter, &core);
    if (status) return status;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double volume = 4 * PI / 3 * pow(bed->r[i], 3);
        emits[i] = is_inside(&core, (const double[]){bed->x[i], bed->y[i], bed->z[i]});
        emitting += emits[i] * volume;
        solid += part_inside(bed, i, &core) * volume;
        result->emitters += emits[i];
    }
    result->volume = core.volume * emitting / solid;
    const bool open = bed->period[0] == 0 || bed->period[1] == 0 || bed->period[2] == 0;
    if (open && result->emitters < EMITTERS)
        return message_at(STATUS_INPUT, file, 0, "only %u spheres are %g mean diameters inside the bed, %u are needed",
                          result->emitters, MARGIN, EMITTERS);
    return STATUS_OK;
}

/* Adds up what the emitters have told. Summed in order, whatever the threads did. */
static void add_emitters(const struct bed *bed, const double *emissivity, const unsigned char *emits,
                         const fibrad_displacement *moved, struct conductivity *result) {
    double square[3] = {0}, lost = 0, all = 0;
    for (int axis = 0; axis < 3; ++axis) result->factor[axis] = 0;
    for (uint32_t i = 0; i < bed->n; ++i) {
        if (!emits[i]) continue;
        const double emission = 4 * PI * bed->r[i] * bed->r[i] * emissivity[i];
        const double weight = emission / (2 * result->volume * result->diameter);
        for (int axis = 0; axis < 3; ++axis) {
            result->factor[axis] += weight * moved[i].square[axis];
            square[axis] += pow(weight * moved[i].error[axis], 2);
        }
        lost += emission * (1 - moved[i].absorbed);
        all += emission;
        result->rays += moved[i].rays;
    }
    for (int axis = 0; axis < 3; ++axis) result->error[axis] = sqrt(square[axis]);
    result->escaped = fmax(0, lost / all);
}

/* The paths per sphere that bring the error of the worst axis down to what is asked for, a tenth to spare. */
static double paths_for(const struct conductivity_request *request, const struct conductivity *result) {
    double worst = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (result->factor[axis] > 0) worst = fmax(worst, result->error[axis] / result->factor[axis]);
    return request->rule.paths * fmax(1, 1.1 * pow(worst / request->error, 2));
}

static int conductivity_compute(struct conductivity_request *request, const struct bed *bed, const unsigned char *emits,
                                fibrad_displacement *moved, struct conductivity *result) {
    const fibrad_scene_config scene = bed_scene(bed, NULL);
    const fibrad_spheres spheres = bed_spheres(bed);
    const bool search = request->rule.paths == 0;
    const double begun = progress_clock();
    if (search) request->rule.paths = (uint32_t)fmin(PER_MAX, fmax(16, ceil(PILOT / result->emitters)));
    for (int round = 0; round < 3; ++round) {
        fibrad_run run = bed_options_run(&request->bed);
        int status = fibrad_displacements(&scene, &spheres, &request->rule, emits, &run, moved, NULL);
        status = bed_options_status(&request->bed, bed, status, &run.fault);
        if (status) return status;
        add_emitters(bed, request->rule.emissivity, emits, moved, result);
        const double paths = paths_for(request, result);
        if (!search || paths <= request->rule.paths) break;
        request->rule.paths = (uint32_t)fmin(PER_MAX, paths);
    }
    result->seconds = progress_clock() - begun;
    return STATUS_OK;
}

static void conductivity_print(const struct conductivity_request *request, const struct bed *bed,
                               const struct conductivity *result) {
    static const char axes[] = "xyz";
    printf("%s: paths of grey diffuse radiation in a linear field of temperature\n", request->bed.name);
    printf("spheres %" PRIu32 "\n", bed->n);
    printf("emitters %" PRIu32 "\n", result->emitters);
    printf("diameter %.17g\n", result->diameter);
    printf("paths %" PRIu32 "\n", request->rule.paths);
    printf("rays %" PRIu64 "\n", result->rays);
    printf("seconds %.17g\n", result->seconds);
    printf("escaped %.17g\n", result->escaped);
    for (int axis = 0; axis < 3; ++axis) printf("F_E_%c %.17g\n", axes[axis], result->factor[axis]);
    for (int axis = 0; axis < 3; ++axis) printf("F_E_%c_error %.17g\n", axes[axis], result->error[axis]);
}

static int conductivity_frame(void *conductivity_request, struct bed *bed) {
    struct conductivity_request *request = conductivity_request;
    struct conductivity result = {0};
    const char *file = request->bed.name;
    int status = STATUS_OK;
    double *emissivity = NULL;
    unsigned char *emits = calloc(bed->n, 1);
    fibrad_displacement *moved = calloc(bed->n, sizeof *moved);
    if (!emits || !moved) status = message_memory();
    if (!status) status = quantity_values(&request->emissivity, bed, file, "emissivity", 0, 0, 1, &emissivity);
    request->rule.emissivity = emissivity;
    if (!status) status = choose_emitters(bed, file, &result, emits);
    if (!status) status = conductivity_compute(request, bed, emits, moved, &result);
    if (!status && result.escaped > 1e-3)
        fprintf(stderr, "fibrad: %s: warning: %.2g of what the core emits leaves the bed; F_E is too low\n", file,
                result.escaped);
    if (!status) conductivity_print(request, bed, &result);
    free(emits);
    free(moved);
    free(emissivity);
    return status;
}

int command_conductivity(int argc, char **argv) {
    struct conductivity_request request;
    int status = conductivity_parse(&request, argc, argv);
    if (status == STATUS_HELP)
        status = conductivity_help();
    else if (!status)
        status = bed_options_frames(&request.bed, "conductivity", conductivity_frame, &request);
    bed_options_free(&request.bed);
    return status;
}
