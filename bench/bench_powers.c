/* bench_powers.c - net powers by patches and by exchange factors: processor time against error.
 * SPDX-License-Identifier: MIT
 *
 *     bench_powers [quick | EMISSIVITY...]      default 0.3 0.8
 *
 * The bench writes CSV to standard output. The bed is the settled bed of 2,000 equal spheres of tests/data, open to 300
 * K. Run the bench where tests/data is. With `quick` the bed is a random bed of 100 spheres. A hundred fields of
 * temperature go in equal steps from the temperatures of the file to 1300 K less those temperatures.
 *
 * Seconds are processor seconds of one thread. There are three columns: one solution, its geometry included; the
 * hundred fields, with the geometry once (by patches every third field is solved and counts threefold); and one
 * solution after all spheres have moved by 0.02 of a radius. The error is the root mean square error over the root mean
 * square of the powers, against 384 patches and 400 directions of 128 points. It is taken over the first field, the
 * last field and two fields in between.
 *
 * Lines `patches` are by fibrad_bed with so many patches, directions and points. Lines `factors` are powers by D,
 * with the tolerance of its rows. Lines `corrected` are as in fibrad_bed_advance: D of tolerance 0.03, corrected by the
 * default patches. The correction is computed anew when powers by D have changed by a tenth. */
#include "bed/packing.h"
#include "bench_bed.h"
#include "read/read.h"

enum { FIELDS_MOST = 100, EACH = 3, CHECKS = 4, MOVES = 3 };

#define ROUGH 0.03
#define SIGMA 5.670374419e-8
#define SKY   300.0

struct powers {
    struct bed bed;
    fibrad_spheres spheres;
    fibrad_scene_config config;
    int fields;
    const double *given;    /* [n] the first temperatures */
    double *temperature;    /* [n] the present temperatures */
    double *emissivity;     /* [n] */
    double *truth[CHECKS];  /* [n] */
    double *power, *change; /* [n] */
    double square, size;    /* sums of squares of errors and powers that were compared */
};

static void set_field(struct powers *p, int field) {
    const double share = (double)field / (p->fields - 1);
    for (uint32_t i = 0; i < p->bed.n; i++)
        p->temperature[i] = (1 - share) * p->given[i] + share * (1300 - p->given[i]);
}

static int field_of_check(const struct powers *p, int check) { return check * (p->fields - 1) / (CHECKS - 1); }

/* Compares the present powers with the true ones, if this field has true ones. */
static void compare(struct powers *p, int field) {
    for (int c = 0; c < CHECKS; c++)
        for (uint32_t i = 0; i < p->bed.n && field == field_of_check(p, c); i++) {
            p->square += pow(p->power[i] - p->truth[c][i], 2);
            p->size += p->truth[c][i] * p->truth[c][i];
        }
}

static void solve_patches(struct powers *p, fibrad_bed *made, double *power) {
    const fibrad_heat_sources sources = {
        .temperature = p->temperature, .emissivity = p->emissivity, .surroundings = SKY, .sigma = SIGMA};
    bench_check("solve", fibrad_bed_solve(made, &sources, NULL, &(fibrad_heat_result){.power = power}));
}

static fibrad_bed *trace_patches(struct powers *p, const fibrad_heat_config *heat) {
    fibrad_bed *made;
    fibrad_run run = {.threads = 1};
    bench_check("bed", fibrad_bed_new(&made, &p->config, &p->spheres, &run));
    bench_check("beams", fibrad_bed_beams(made, heat));
    return made;
}

static void find_truth(struct powers *p, const fibrad_heat_config *heat) {
    fibrad_bed *made = trace_patches(p, heat);
    for (int c = 0; c < CHECKS; c++) {
        set_field(p, field_of_check(p, c));
        solve_patches(p, made, p->truth[c]);
    }
    fibrad_bed_free(made);
}

static void print_costs(struct powers *p, const char *way, const char *setting, double one, double hundred,
                        double moved) {
    printf("%g,%s,%s,%.2f,%.2f,%.2f,%.2e\n", p->emissivity[0], way, setting, one, hundred, moved,
           sqrt(p->square / p->size));
    fflush(stdout);
    p->square = p->size = 0;
}

/* Moves the bed. Returns the seconds of the solution after the move. */
static double move_patches(struct powers *p, fibrad_bed *made) {
    double seconds = 0;
    for (int m = 0; m < MOVES; m++) {
        for (uint32_t i = 0; i < p->bed.n; i++) {
            const double far = .04 * p->bed.r[i];
            p->bed.x[i] += far * (bed_make_random(11 + (uint64_t)m, 3 * (uint64_t)i) - .5);
            p->bed.y[i] += far * (bed_make_random(11 + (uint64_t)m, 3 * (uint64_t)i + 1) - .5);
            p->bed.z[i] += far * (bed_make_random(11 + (uint64_t)m, 3 * (uint64_t)i + 2) - .5);
        }
        const double begun = bench_thread_seconds();
        bench_check("move", fibrad_bed_move(made, &p->config, &p->spheres));
        solve_patches(p, made, p->power);
        seconds += bench_thread_seconds() - begun;
    }
    return seconds / MOVES;
}

static void bench_patches(struct powers *p, const fibrad_heat_config *heat) {
    char setting[40];
    const size_t bytes = p->bed.n * sizeof(double);
    double *place = bench_array(3 * (size_t)p->bed.n, sizeof *place), *const axis[] = {p->bed.x, p->bed.y, p->bed.z};
    const double begun = bench_thread_seconds();
    double one = 0;
    fibrad_bed *made = trace_patches(p, heat);
    for (int field = 0; field < p->fields; field += EACH) {
        set_field(p, field);
        solve_patches(p, made, p->power);
        if (field == 0) one = bench_thread_seconds() - begun;
        compare(p, field);
    }
    const double hundred = one + EACH * (bench_thread_seconds() - begun - one);
    for (size_t k = 0; k < 3; k++) memcpy(place + k * p->bed.n, axis[k], bytes);
    const double moved = move_patches(p, made);
    for (size_t k = 0; k < 3; k++) memcpy(axis[k], place + k * p->bed.n, bytes);
    snprintf(setting, sizeof setting, "%u x %u x %u", heat->patches, heat->directions, heat->points);
    print_costs(p, "patches", setting, one, hundred, moved);
    fibrad_bed_free(made);
    free(place);
}

static fibrad_bed_matrix *make_factors(struct powers *p, double tolerance) {
    const fibrad_exchange_rule rule = {.emissivity = p->emissivity, .tolerance = tolerance};
    fibrad_run run = {.threads = 1};
    fibrad_bed_matrix *factors;
    bench_check("factors",
                fibrad_view_factors(&p->config, &p->spheres, &(fibrad_bed_rule){.exchange = &rule}, &run, &factors));
    return factors;
}

static double emission(double temperature) { return SIGMA * pow(temperature, 4); }

static void powers_by_factors(struct powers *p, const fibrad_factors *d) {
    for (uint32_t i = 0; i < d->n; i++) {
        const double area = 4 * acos(-1) * p->bed.r[i] * p->bed.r[i], own = emission(p->temperature[i]);
        double sum = d->escaped[i] * (emission(SKY) - own);
        for (uint64_t k = d->start[i]; k < d->start[i + 1]; k++)
            sum += d->f[k] * (emission(p->temperature[d->col[k]]) - own);
        p->power[i] = area * p->emissivity[i] * sum;
    }
}

static void bench_factors_alone(struct powers *p, double tolerance) {
    char setting[40];
    const double begun = bench_thread_seconds();
    double one = 0;
    fibrad_bed_matrix *factors = make_factors(p, tolerance);
    for (int field = 0; field < p->fields; field++) {
        set_field(p, field);
        powers_by_factors(p, &factors->matrix);
        if (field == 0) one = bench_thread_seconds() - begun;
        compare(p, field);
    }
    snprintf(setting, sizeof setting, "%g", tolerance);
    print_costs(p, "factors", setting, one, bench_thread_seconds() - begun, one);
    fibrad_bed_matrix_free(factors);
}

/* The change of the powers by D since the last correction, over their norm. */
static double gone(const struct powers *p, const double *compared) {
    double square = 0, size = 0;
    for (uint32_t i = 0; i < p->bed.n; i++)
        square += pow(p->power[i] - compared[i], 2), size += p->power[i] * p->power[i];
    return sqrt(square / size);
}

static void bench_corrected(struct powers *p) {
    char setting[40];
    const uint32_t n = p->bed.n;
    double *compared = bench_array(n, sizeof *compared), one = 0;
    const double begun = bench_thread_seconds();
    fibrad_bed *made = trace_patches(p, NULL);
    fibrad_bed_matrix *factors = make_factors(p, ROUGH);
    int solutions = 0;
    for (int field = 0; field < p->fields; field++) {
        set_field(p, field);
        powers_by_factors(p, &factors->matrix);
        if (field == 0 || gone(p, compared) > .1) {
            memcpy(compared, p->power, n * sizeof *compared);
            solve_patches(p, made, p->change);
            for (uint32_t i = 0; i < n; i++) p->change[i] -= p->power[i];
            solutions++;
        }
        for (uint32_t i = 0; i < n; i++) p->power[i] += p->change[i];
        if (field == 0) one = bench_thread_seconds() - begun;
        compare(p, field);
    }
    snprintf(setting, sizeof setting, "%d by patches", solutions);
    print_costs(p, "corrected", setting, one, bench_thread_seconds() - begun, one);
    fibrad_bed_free(made);
    fibrad_bed_matrix_free(factors);
    free(compared);
}

static void open_powers(struct powers *p, bool quick) {
    static const char *const column[] = {"v_T"};
    struct bed *bed = &p->bed;
    *p = (struct powers){.fields = quick ? CHECKS : FIELDS_MOST};
    *bed = bed_empty();
    if (quick ? bed_make_packing(bed, 100, .5, .5, .55, 1)
              : read_bed("tests/data/mono2000.dump", &(struct read_options){.extra = column, .extras = 1}, bed))
        exit(1);
    double *given = bench_array(bed->n, sizeof *given);
    for (uint32_t i = 0; i < bed->n; i++) given[i] = quick ? 300 + 700 * bed_make_random(3, i) : bed->extra[i];
    p->given = given;
    p->spheres = bench_spheres(bed);
    p->config = (fibrad_scene_config){.isa = FIBRAD_ISA_BEST}; /* open on all sides */
    double **const arrays[] = {&p->temperature, &p->emissivity, &p->power,    &p->change,
                               &p->truth[0],    &p->truth[1],   &p->truth[2], &p->truth[3]};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) *arrays[k] = bench_array(bed->n, sizeof(double));
}

int main(int argc, char **argv) {
    static const fibrad_heat_config settings[] = {{.directions = 36, .points = 64, .patches = 24},
                                                  {.directions = 72, .points = 64, .patches = 96},
                                                  {.directions = 168, .points = 64, .patches = 96}};
    static const double tolerances[] = {.03, .01, .005};
    static char *both[] = {".3", ".8"};
    const bool quick = argc > 1 && strcmp(argv[1], "quick") == 0;
    const fibrad_heat_config reference = {.directions = quick ? 100 : 400, .points = 128, .patches = quick ? 96 : 384};
    struct powers p;
    open_powers(&p, quick);
    bench_preamble("net powers by patches and by exchange factors: processor seconds of one thread, error", 1);
    puts("emissivity,way,setting,one_s,hundred_s,moved_s,error");
    char **list = quick || argc < 2 ? both : argv + 1;
    for (int k = 0, count = quick || argc < 2 ? 2 : argc - 1; k < count; k++) {
        for (uint32_t i = 0; i < p.bed.n; i++) p.emissivity[i] = strtod(list[k], NULL);
        find_truth(&p, &reference);
        for (size_t s = 0; s < (quick ? 1 : 3); s++) bench_patches(&p, &settings[s]);
        for (size_t s = 0; s < (quick ? 1 : 3); s++) bench_factors_alone(&p, tolerances[s]);
        bench_corrected(&p);
    }
    return 0; /* memory is freed when the program ends */
}
