/* test_simple.c - the simple layer returns what the kernel returns, for any number of threads. Faults, cancelled calls,
 * and beds that move. SPDX-License-Identifier: MIT */
#include <omp.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include "host_owned.h"
#include "scenes.h"
#include "meshes.h"
#include "suite.h"

static const int threads[] = {1, 2, 5};

static fibrad_scene_config box_of(const struct bed *bed) {
    return (fibrad_scene_config){.period = {bed->period[0], bed->period[1], bed->period[2]}};
}

/* Computes the beam rows of all spheres. */
static fibrad_rows rows_one_by_one(const fibrad_scene *scene, uint32_t n, uint32_t walls,
                                   const fibrad_beam_rule *rule) {
    OWNED_WORK work = work_growing();
    fibrad_rows rows = {.memory = memory_growing()};
    fibrad_row row = {.rows = &rows};
    for (uint32_t i = 0; i < n; i++) {
        assert_ok(fibrad_beam_row(scene, &work, i, rule, &row));
        double sum = row.escaped;
        for (uint32_t k = 0; k < row.length; k++) sum += row.f[k];
        for (uint32_t b = 0; b < walls; b++) sum += row.wall[b];
        ck_assert_double_eq_tol(sum, 1, 1e-12); /* the row can be read where it lies in the collection */
    }
    return rows;
}

/* Makes the same matrix with the kernel, with rows in the order of the spheres: raw rows along directions, or all rows
 * along lines. */
static struct matrix kernel_matrix(const struct bed *bed, const fibrad_scene_config *config,
                                   const fibrad_beam_rule *rule, bool raw) {
    OWNED fibrad_scene *scene = scene_with(bed, config);
    OWNED fibrad_line_set *lines = raw ? NULL : lines_of(rule->directions);
    const fibrad_beam_rule along = {.lines = lines, .chords = rule->points / 4, .cutoff = rule->cutoff};
    OWNED_ROWS rows = rows_one_by_one(scene, bed->n, config ? config->walls : 0, raw ? rule : &along);
    return matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.raw = raw});
}

TEST(view_factors_are_the_kernels) {
    OWNED_BED bed = packing(300, .8, 1.2, .5, 3, false);
    const fibrad_wall wall[] = {plane_at(2, 0, -20), cylinder_at(10, 10, 60)};
    const fibrad_plane opening = {2, 1, 90};
    const fibrad_scene_config config = {.wall = wall, .walls = 2, .opening = &opening, .openings = 1};
    const fibrad_spheres spheres = spheres_of(&bed);
    const fibrad_beam_rule rule = {.directions = 40};
    OWNED_MATRIX expected = kernel_matrix(&bed, &config, &rule, false);
    for (int t = 0; t < 3; t++) {
        fibrad_run run = {.threads = threads[t]};
        OWNED_FACTORS *factors = NULL;
        assert_ok(fibrad_view_factors(&config, &spheres, &(fibrad_bed_rule){.beam = &rule}, &run, &factors));
        ck_assert(matrix_same_bits(&factors->matrix, &expected.factors));
        ck_assert_int_eq(factors->threads, threads[t]);
        ck_assert_uint_eq(factors->directions, fibrad_line_set_lines(40));
        ck_assert_uint_eq(factors->facts.spheres, 300);
        ck_assert_double_lt(factors->closure_error, 1e-12);
        ck_assert_double_lt(factors->reciprocity_error, 1e-14);
        ck_assert(factors->wall_area[0] > 0 && isfinite(factors->wall_area[1]));
    }
}

struct calls {
    uint64_t count, done, total, stop_at; /* stop_at: the call that asks to stop */
    int ends;
};

static int count_calls(void *context, const char *stage, uint64_t done, uint64_t total) {
    struct calls *calls = context;
    ck_assert_ptr_nonnull(stage);
    if (done > 0 && total > 0) ck_assert_uint_ge(done, calls->done);
    ck_assert(total == 0 || done <= total);
    calls->done = done, calls->total = total;
    calls->ends += total > 0 && done == total;
    return ++calls->count == calls->stop_at;
}

/* Rows of spheres far larger than most others are divided over threads. If there are fewer rows than threads, all
 * are. */
TEST(long_rows_are_divided) {
    OWNED_BED bed = strewn(300, 3);
    const fibrad_wall floor = plane_at(2, 0, -.3);
    const fibrad_scene_config config = {.wall = &floor, .walls = 1};
    const fibrad_spheres spheres = spheres_of(&bed);
    const fibrad_beam_rule rule = {.directions = 60};
    unsigned char two[300] = {[1] = 1, [200] = 1};
    OWNED_MATRIX expected = kernel_matrix(&bed, &config, &rule, true);
    fibrad_bed_matrix *factors, *alone[3];
    for (int t = 0; t < 3; t++) {
        struct calls calls = {0};
        fibrad_run run = {.threads = threads[t], .progress = count_calls, .context = &calls};
        fibrad_bed_rule options = {.beam = &rule, .raw = 1};
        assert_ok(fibrad_view_factors(&config, &spheres, &options, &run, &factors));
        ck_assert(matrix_same_bits(&factors->matrix, &expected.factors));
        ck_assert_uint_eq(factors->directions, 60);
        ck_assert(calls.ends == 1 && calls.total == 300);
        fibrad_bed_matrix_free(factors);
        run.progress = NULL;
        options.wanted = two;
        assert_ok(fibrad_view_factors(&config, &spheres, &options, &run, &alone[t]));
        ck_assert(matrix_same_bits(&alone[t]->matrix, &alone[0]->matrix));
    }
    ck_assert_uint_gt(alone[0]->matrix.start[300], 100);
    for (int t = 0; t < 3; t++) fibrad_bed_matrix_free(alone[t]);
}

/* The same holds along lines, with masks and without. A bed of fewer spheres than threads has masks, too. */
TEST(long_rows_along_lines_are_divided) {
    struct bed beds[] = {strewn(300, 3), strewn(3, 3)};
    const fibrad_wall floor = plane_at(2, 0, -.3);
    const fibrad_scene_config config = {.wall = &floor, .walls = 1};
    for (int b = 0; b < 2; b++)
        for (uint32_t points = 0; points <= 64; points += 64) {
            const fibrad_spheres spheres = spheres_of(&beds[b]);
            const fibrad_beam_rule rule = {.directions = 60, .points = points};
            OWNED_MATRIX expected = kernel_matrix(&beds[b], &config, &rule, false);
            for (int t = 0; t < 3; t++) {
                fibrad_run run = {.threads = threads[t]};
                OWNED_FACTORS *factors = NULL;
                assert_ok(fibrad_view_factors(&config, &spheres, &(fibrad_bed_rule){.beam = &rule}, &run, &factors));
                ck_assert(matrix_same_bits(&factors->matrix, &expected.factors));
            }
        }
    for (int b = 0; b < 2; b++) bed_free(&beds[b]);
}

/* Each other method and option gives the same for any number of threads. */
TEST(nothing_depends_on_threads) {
    OWNED_BED bed = packing(200, .8, 1.2, .5, 3, true);
    const fibrad_scene_config config = box_of(&bed);
    const fibrad_spheres spheres = spheres_of(&bed);
    unsigned char wanted[200] = {0};
    wanted[3] = wanted[199] = 1;
    const fibrad_bed_rule options[] = {
        {.beam = &(fibrad_beam_rule){.directions = 21}, .raw = 1},
        {.beam = &(fibrad_beam_rule){.tolerance = .02}},
        {.beam = &(fibrad_beam_rule){.tolerance = .02}, .wanted = wanted},
        {.beam = &(fibrad_beam_rule){.directions = 21}, .drop = 1e-3},
        {.cast = &(fibrad_cast_rule){.rays = 300}},
    };
    for (size_t k = 0; k < sizeof options / sizeof *options; k++) {
        fibrad_bed_matrix *first = NULL, *next;
        for (int t = 0; t < 3; t++) {
            fibrad_run run = {.threads = threads[t]};
            assert_ok(fibrad_view_factors(&config, &spheres, &options[k], &run, &next));
            if (first) {
                ck_assert(matrix_same_bits(&first->matrix, &next->matrix));
                fibrad_bed_matrix_free(next);
            } else {
                first = next;
            }
        }
        const fibrad_factors *matrix = &first->matrix;
        for (uint32_t i = 0; i < 200 && k == 1; i++) ck_assert_double_le(matrix->error[i], .02);
        for (uint32_t i = 0; i < 200 && k == 2; i++)
            ck_assert(wanted[i] ? matrix->error[i] <= .02 && matrix->start[i + 1] > matrix->start[i]
                                : matrix->start[i + 1] == matrix->start[i] && matrix->escaped[i] == 0);
        ck_assert_int_eq(isnan(first->reciprocity_error) != 0, options[k].wanted != NULL);
        fibrad_bed_matrix_free(first);
    }
}

TEST(exchange_does_not_depend_on_threads) {
    OWNED_BED bed = packing(150, .8, 1.2, .5, 3, true);
    const fibrad_scene_config config = box_of(&bed);
    const fibrad_spheres spheres = spheres_of(&bed);
    double emissivity[150];
    for (int i = 0; i < 150; i++) emissivity[i] = .3 + i / 300.;
    const fibrad_exchange_rule rule = {.emissivity = emissivity, .directions = 20, .paths = 50};
    fibrad_bed_matrix *first = NULL, *next;
    for (int t = 0; t < 3; t++) {
        fibrad_run run = {.threads = threads[t]};
        assert_ok(exchange_of(&config, &spheres, &rule, NULL, &run, &next));
        ck_assert_uint_gt(next->rays, 150 * 50);
        if (first) ck_assert(matrix_same_bits(&first->matrix, &next->matrix) && first->rays == next->rays);
        fibrad_bed_matrix_free(first);
        first = next;
    }
    ck_assert_double_lt(first->reciprocity_error, 1e-12);
    fibrad_bed_matrix_free(first);
}

/* Spheres that reflect all light have empty rows, which are no fault of closure. A bed of nothing but such spheres is
 * empty. */
TEST(reflectors_have_empty_rows) {
    OWNED_BED bed = packing(150, .8, 1.2, .5, 3, true);
    const fibrad_scene_config config = box_of(&bed);
    const fibrad_spheres spheres = spheres_of(&bed);
    double emissivity[150];
    const fibrad_exchange_rule rule = {.emissivity = emissivity, .directions = 20, .paths = 50};
    for (int all = 0; all <= 1; all++)
        for (int raw = 0; raw <= 1; raw++) {
            OWNED_FACTORS *factors = NULL;
            for (int i = 0; i < 150; i++) emissivity[i] = all || i % 5 == 0 ? 0 : .3;
            assert_ok(exchange_of(&config, &spheres, &rule, &(fibrad_bed_rule){.raw = raw}, NULL, &factors));
            ck_assert_double_le(factors->closure_error, 1e-12);
            if (!raw) ck_assert_double_le(factors->reciprocity_error, 1e-14);
            ck_assert(factors->reciprocity_error >= 0 && (factors->rays > 0) == !all);
            for (uint32_t i = 0; i < 150; i++)
                ck_assert_double_le(fabs(matrix_total(&factors->matrix, i) - (emissivity[i] > 0)), 1e-12);
        }
}

/* Whether an address is in a file of the folder. If the system does not tell, true. */
static bool is_filed(const void *address, const char *folder) {
    char line[1000];
    FILE *maps = fopen("/proc/self/maps", "r");
    bool found = maps == NULL;
    while (maps && fgets(line, sizeof line, maps)) {
        unsigned long long first, last;
        if (sscanf(line, "%llx-%llx", &first, &last) == 2 && first <= (uintptr_t)address && (uintptr_t)address < last)
            found = strstr(line, folder) && strstr(line, "(deleted)");
    }
    if (maps) fclose(maps);
    return found;
}

/* Rows and a matrix in files are those in memory, with those of walls, for any number of threads. No file is left
 * behind. */
TEST(factors_in_files) {
    char folder[] = "/tmp/fibrad_filed_XXXXXX";
    OWNED_BED bed = packing(300, .8, 1.2, .5, 3, false);
    const fibrad_wall wall[] = {plane_at(2, 0, -20), cylinder_at(10, 10, 60)};
    const fibrad_plane opening = {2, 1, 90};
    const fibrad_scene_config config = {.wall = wall, .walls = 2, .opening = &opening, .openings = 1};
    const fibrad_spheres spheres = spheres_of(&bed);
    double emissivity[300], wall_emissivity[] = {.5, .9};
    for (int i = 0; i < 300; i++) emissivity[i] = .3 + i / 500.;
    const fibrad_exchange_rule rule = {
        .emissivity = emissivity, .wall_emissivity = wall_emissivity, .directions = 20, .paths = 50};
    ck_assert_ptr_nonnull(mkdtemp(folder));
    for (int k = 0; k < 3; k++) {
        const fibrad_bed_rule kept = {.walls = 1, .raw = k == 1, .drop = k == 2 ? 1e-3 : 0};
        fibrad_bed_rule filed = kept;
        OWNED_FACTORS *here = NULL, *there = NULL;
        fibrad_run run = {.threads = threads[k]};
        filed.scratch = folder;
        assert_ok(exchange_of(&config, &spheres, &rule, &kept, NULL, &here));
        assert_ok(exchange_of(&config, &spheres, &rule, &filed, &run, &there));
        ck_assert(matrix_same_bits(&here->matrix, &there->matrix));
        ck_assert(here->reciprocity_error == there->reciprocity_error && here->closure_error == there->closure_error);
        ck_assert(is_filed(there->matrix.f, folder));
    }
    ck_assert_int_eq(rmdir(folder), 0); /* empty */
    fibrad_bed_matrix *none;
    ck_assert_int_eq(exchange_of(&config, &spheres, &rule, &(fibrad_bed_rule){.scratch = folder}, NULL, &none),
                     FIBRAD_E_FILE);
    ck_assert_ptr_null(none);
}

/* It is an error if a file cannot grow any more. */
TEST(full_disk) {
    OWNED_BED bed = packing(300, .8, 1.2, .5, 3, false);
    const fibrad_spheres spheres = spheres_of(&bed);
    struct rlimit limit;
    fibrad_bed_matrix *none;
    ck_assert_int_eq(getrlimit(RLIMIT_FSIZE, &limit), 0);
    limit.rlim_cur = 100000;
    signal(SIGXFSZ, SIG_IGN);
    ck_assert_int_eq(setrlimit(RLIMIT_FSIZE, &limit), 0);
    const int status = fibrad_view_factors(NULL, &spheres, &(fibrad_bed_rule){.scratch = "/tmp"}, NULL, &none);
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_FSIZE, &limit); /* the test itself writes, too */
    ck_assert_int_eq(status, FIBRAD_E_MEMORY);
    ck_assert_ptr_null(none);
}

/* ---- errors ------------------------------------------------------------------------------------------------------ */

TEST(faults_name_spheres) {
    OWNED_BED bed = packing(100, .8, 1.2, .5, 3, false);
    const fibrad_spheres spheres = spheres_of(&bed);
    fibrad_bed_matrix *factors = (void *)&bed;
    fibrad_run run = {.threads = 2};
    double emissivity[100];
    for (int i = 0; i < 100; i++) emissivity[i] = .5;
    emissivity[70] = emissivity[71] = emissivity[3] = NAN;
    const fibrad_exchange_rule rule = {.emissivity = emissivity, .paths = 10};
    const uint32_t first = 3;
    for (int t = 0; t < 3; t++) {
        run.threads = threads[t];
        const fibrad_bed_rule raw = {.raw = 1};
        assert_invalid(exchange_of(NULL, &spheres, &rule, &raw, &run, &factors));
        ck_assert(run.fault.first == first && run.fault.second == first && factors == NULL);
    }
    bed.x[5] = bed.x[60], bed.y[5] = bed.y[60], bed.z[5] = bed.z[60];
    ck_assert_int_eq(fibrad_view_factors(NULL, &spheres, NULL, &run, &factors), FIBRAD_E_GEOMETRY);
    ck_assert_uint_eq(run.fault.first + run.fault.second, 65);
    bed.x[5] = NAN;
    assert_invalid(fibrad_view_factors(NULL, &spheres, NULL, &run, &factors));
    ck_assert(run.fault.first == 5 && run.fault.second == 5);
    assert_invalid(fibrad_view_factors(NULL, &spheres, NULL, NULL, &factors));
}

/* If several rows fail, the same one is named for any number of threads, divided or not. A call that is cancelled names
 * none. */
TEST(faults_of_divided_rows) {
    OWNED_BED bed = strewn(300, 3);
    OWNED struct mesh *mesh = mesh_new();
    const fibrad_spheres spheres = spheres_of(&bed);
    fibrad_fault first = {0, 0, 0, 0, 0};
    fibrad_bed_matrix *factors;
    mesh_box(mesh, (const double[]){-9, -9, -9}, (const double[]){9, 9, 9}, 0);
    for (uint32_t t = 0; t < mesh->triangles.n; ++t) /* all see its back, which belongs to no wall */
        mesh->back[t] = mesh->front[t], mesh->front[t] = FIBRAD_NO_WALL;
    const fibrad_scene_config config = {.wall = mesh->wall, .walls = 6, .triangles = &mesh->triangles};
    for (int t = 0; t < 3; t++) {
        struct calls calls = {.stop_at = 1};
        fibrad_run run = {.threads = threads[t]};
        ck_assert_int_eq(fibrad_view_factors(&config, &spheres, NULL, &run, &factors), FIBRAD_E_BACK);
        if (t == 0) first = run.fault;
        ck_assert(first.first < 300 && first.triangle < 12);
        ck_assert(run.fault.first == first.first && run.fault.triangle == first.triangle);
        run.progress = count_calls, run.context = &calls;
        ck_assert_int_eq(fibrad_view_factors(NULL, &spheres, NULL, &run, &factors), FIBRAD_E_CANCELLED);
        ck_assert(run.fault.first == 300 && run.fault.second == 300);
    }
}

TEST(arguments) {
    OWNED_BED bed = packing(10, .8, 1.2, .4, 3, false);
    const fibrad_spheres spheres = spheres_of(&bed);
    OWNED_FACTORS *factors;
    fibrad_bed *made;
    const fibrad_bed_rule two = {.beam = &(fibrad_beam_rule){0}, .cast = &(fibrad_cast_rule){0}}, drop = {.drop = -1},
                          nan = {.drop = NAN}, points = {.beam = &(fibrad_beam_rule){.points = 3}},
                          between = {.beam = &(fibrad_beam_rule){.points = 192}};
    fibrad_run run = {.threads = -1}, many = {.threads = 1025};
    assert_invalid(fibrad_view_factors(NULL, NULL, NULL, NULL, &factors));
    assert_invalid(fibrad_view_factors(NULL, &spheres, NULL, NULL, NULL));
    assert_invalid(fibrad_view_factors(NULL, &spheres, &two, NULL, &factors));
    assert_invalid(fibrad_view_factors(NULL, &spheres, &drop, NULL, &factors));
    assert_invalid(fibrad_view_factors(NULL, &spheres, &nan, NULL, &factors));
    assert_invalid(fibrad_view_factors(NULL, &spheres, NULL, &run, &factors));
    assert_invalid(fibrad_view_factors(NULL, &spheres, NULL, &many, &factors));
    ck_assert_int_eq(fibrad_view_factors(NULL, &spheres, &points, NULL, &factors), FIBRAD_E_TABLE);
    ck_assert_int_eq(fibrad_view_factors(NULL, &spheres, &between, NULL, &factors), FIBRAD_E_TABLE);
    ck_assert_ptr_null(factors);
    assert_invalid(fibrad_bed_new(NULL, NULL, &spheres, NULL));
    assert_invalid(fibrad_bed_new(&made, NULL, NULL, NULL));
    ck_assert_ptr_null(made);
    assert_invalid(fibrad_bed_move(NULL, NULL, &spheres));
    assert_invalid(fibrad_bed_beams(NULL, NULL));
    assert_invalid(fibrad_bed_solve(NULL, NULL, NULL, NULL));
    fibrad_bed_describe(NULL, NULL, NULL);
    fibrad_bed_free(NULL);
    fibrad_bed_matrix_free(NULL);
    assert_ok(fibrad_view_factors(NULL, &(fibrad_spheres){0}, NULL, NULL, &factors));
    ck_assert(factors->matrix.n == 0 && factors->matrix.start[0] == 0);
    fibrad_bed_matrix_free(factors);
    const fibrad_bed_rule tolerance = {.beam = &(fibrad_beam_rule){.tolerance = .1}};
    assert_ok(fibrad_view_factors(NULL, &(fibrad_spheres){0}, &tolerance, NULL, &factors));
    fibrad_bed_matrix_free(factors);
    omp_set_num_threads(1025); /* the number of OpenMP's threads, up to the largest that is allowed */
    assert_ok(fibrad_view_factors(NULL, &spheres, NULL, NULL, &factors));
    ck_assert_int_eq(factors->threads, 1024);
}

/* ---- progress ---------------------------------------------------------------------------------------------------- */

TEST(progress_and_cancelling) {
    OWNED_BED bed = packing(200, .8, 1.2, .5, 3, false);
    const fibrad_spheres spheres = spheres_of(&bed);
    const fibrad_bed_rule options = {.beam = &(fibrad_beam_rule){.directions = 200}};
    for (int t = 0; t < 3; t++) {
        struct calls calls = {0};
        fibrad_run run = {.threads = threads[t], .progress = count_calls, .context = &calls};
        fibrad_bed_matrix *factors;
        assert_ok(fibrad_view_factors(NULL, &spheres, &options, &run, &factors));
        ck_assert(calls.ends == 1 && calls.total == 200 && calls.count >= 2);
        fibrad_bed_matrix_free(factors);
        for (uint64_t at = 1; at <= 2; at++) {
            calls = (struct calls){.stop_at = at};
            ck_assert_int_eq(fibrad_view_factors(NULL, &spheres, &options, &run, &factors), FIBRAD_E_CANCELLED);
            ck_assert_uint_eq(calls.count, at);
            ck_assert_ptr_null(factors);
        }
    }
}

/* Rows that are divided do not report their progress one by one. */
TEST(progress_of_short_rows) {
    OWNED_BED bed = bed_empty();
    for (int k = 0; k < 400; k++) add_sphere(&bed, 9 * k, 0, 0, 1);
    for (int k = 0; k < 8000; k++) add_sphere(&bed, .1 * k, 99, 0, .01);
    const fibrad_spheres spheres = spheres_of(&bed);
    unsigned char wanted[8400] = {0};
    memset(wanted, 1, 400);
    const fibrad_bed_rule options = {.beam = &(fibrad_beam_rule){.directions = 8}, .wanted = wanted};
    struct calls calls = {0};
    fibrad_run run = {.threads = 2, .progress = count_calls, .context = &calls};
    OWNED_FACTORS *factors = NULL;
    assert_ok(fibrad_view_factors(NULL, &spheres, &options, &run, &factors));
    ck_assert(calls.ends >= 1 && calls.total == 400);
    ck_assert_uint_lt(calls.count, 400); /* all takes less than 20 seconds */
}

/* ---- heat -------------------------------------------------------------------------------------------------------- */

enum { N = 80 };

static fibrad_heat_sources sources_of(const double *temperature, const double *emissivity) {
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.temperature = temperature;
    sources.emissivity = emissivity;
    sources.surroundings = 300;
    return sources;
}

static void powers(fibrad_bed *radiation, const fibrad_heat_sources *sources, double power[N]) {
    fibrad_heat_result result = {.power = power};
    assert_ok(fibrad_bed_solve(radiation, sources, NULL, &result));
}

TEST(radiation_moves) {
    OWNED_BED bed = packing(N, .8, 1.2, .5, 3, false);
    const fibrad_spheres spheres = spheres_of(&bed),
                         fewer = {.x = bed.x, .y = bed.y, .z = bed.z, .r = bed.r, .n = N - 1};
    const fibrad_heat_config config = {.directions = 20, .patches = 24};
    const fibrad_wall wall = plane_at(0, 0, -5);
    double temperature[N], emissivity[N], first[N], power[N], again[N], kept;
    for (int i = 0; i < N; i++) temperature[i] = 300 + i, emissivity[i] = .6;
    const fibrad_heat_sources sources = sources_of(temperature, emissivity);
    for (int t = 0; t < 3; t++) {
        struct calls calls = {0};
        fibrad_run run = {.threads = threads[t], .progress = count_calls, .context = &calls};
        OWNED_MADE *radiation = NULL;
        fibrad_scene_facts facts;
        fibrad_fault fault;
        assert_ok(made_with(&radiation, NULL, &spheres, &config, &run));
        powers(radiation, &sources, power);
        if (t == 0) memcpy(first, power, sizeof power);
        ck_assert_int_eq(memcmp(first, power, sizeof power), 0);

        /* a refused call leaves the bed as it was */
        assert_invalid(fibrad_bed_move(radiation, NULL, &fewer));
        assert_invalid(fibrad_bed_move(radiation, &(fibrad_scene_config){.wall = &wall, .walls = 1}, &spheres));
        kept = bed.x[7], bed.x[7] = NAN;
        assert_invalid(fibrad_bed_move(radiation, NULL, &spheres));
        bed.x[7] = kept;
        fibrad_bed_describe(radiation, &facts, &fault);
        ck_assert(facts.spheres == N && fault.first == 7 && fault.second == 7);
        powers(radiation, &sources, again);
        for (int i = 0; i < N; i++) ck_assert_double_eq_tol(again[i], power[i], 10);

        /* the bed moves to another place, and back */
        for (int i = 0; i < N; i++) bed.z[i] *= 1.1;
        assert_ok(fibrad_bed_move(radiation, NULL, &spheres));
        powers(radiation, &sources, again);
        ck_assert(memcmp(again, power, sizeof power) != 0);

        /* a solution is cancelled while it traces, and then while it sweeps */
        assert_ok(fibrad_bed_move(radiation, NULL, &spheres));
        calls = (struct calls){.stop_at = 1};
        ck_assert_int_eq(fibrad_bed_solve(radiation, &sources, NULL, &(fibrad_heat_result){.power = power}),
                         FIBRAD_E_CANCELLED);
        calls.stop_at = 0;
        assert_ok(fibrad_bed_beams(radiation, &config));
        calls = (struct calls){.stop_at = 2};
        ck_assert_int_eq(fibrad_bed_solve(radiation, &sources, NULL, &(fibrad_heat_result){.power = power}),
                         FIBRAD_E_CANCELLED);
        calls.stop_at = 0;
        powers(radiation, &sources, power);
        for (int i = 0; i < N; i++) ck_assert_double_eq_tol(power[i], again[i], 10);
        for (int i = 0; i < N; i++) bed.z[i] /= 1.1;
    }
}

/* Counts how often beams were begun again. */
struct returns {
    uint64_t done, count;
};

static int count_returns(void *context, const char *stage, uint64_t done, uint64_t total) {
    struct returns *returns = context;
    if (total == 0 || strcmp(stage, "beams") != 0) return 0;
    returns->count += done < returns->done;
    returns->done = done;
    return 0;
}

/* A bed comes apart, so that spheres see more others than there is room for. They get more room, and all is as if the
 * bed had begun so. */
TEST(radiation_gets_more_room) {
    enum { MANY = 800 };
    OWNED_BED bed = packing(MANY, 1, 1, .6, 3, false);
    const fibrad_spheres spheres = spheres_of(&bed);
    const fibrad_heat_config config = {.patches = 96, .directions = 672};
    double temperature[MANY], emissivity[MANY], moved[MANY], begun[MANY];
    for (int i = 0; i < MANY; i++) temperature[i] = 300 + i, emissivity[i] = 1;
    const fibrad_heat_sources sources = sources_of(temperature, emissivity);
    struct returns returns = {0};
    fibrad_run run = {.threads = 1, .progress = count_returns, .context = &returns};
    OWNED_MADE *radiation;
    assert_ok(made_with(&radiation, NULL, &spheres, &config, &run));
    ck_assert_uint_eq(returns.count, 0);
    returns.done = 0;
    for (int i = 0; i < MANY; i++) bed.x[i] *= 2, bed.y[i] *= 2, bed.z[i] *= 2;
    assert_ok(fibrad_bed_move(radiation, NULL, &spheres));
    assert_ok(fibrad_bed_beams(radiation, &config));
    ck_assert_uint_ge(returns.count, 1);
    powers(radiation, &sources, moved);
    fibrad_bed_free(radiation);
    assert_ok(made_with(&radiation, NULL, &spheres, &config, &run));
    powers(radiation, &sources, begun);
    ck_assert_mem_eq(moved, begun, sizeof moved);
}

TEST(radiation_with_walls) {
    OWNED_BED bed = packing(N, .8, 1.2, .5, 3, false);
    const fibrad_spheres spheres = spheres_of(&bed);
    double temperature[N], emissivity[N], power[N], wall_power[6], wall_temperature[6], wall_emissivity[6];
    for (int i = 0; i < N; i++) temperature[i] = 400, emissivity[i] = .6;
    fibrad_heat_sources sources = sources_of(temperature, emissivity);
    sources.wall_temperature = wall_temperature, sources.wall_emissivity = wall_emissivity;
    fibrad_wall walls[6];
    OWNED_MADE *radiation = NULL;
    for (int far = 0; far < 2; far++) {
        const double edge = far ? 200 : 40;
        for (int w = 0; w < 6; w++) {
            walls[w] = plane_at(w / 2, w % 2, w % 2 ? edge : -edge);
            wall_temperature[w] = 400, wall_emissivity[w] = 1;
        }
        const fibrad_scene_config config = {.wall = walls, .walls = 6};
        const fibrad_heat_config heat = {.directions = 8, .patches = 24};
        assert_ok(far ? fibrad_bed_move(radiation, &config, &spheres)
                      : made_with(&radiation, &config, &spheres, &heat, NULL));
        assert_ok(fibrad_bed_solve(radiation, &sources, NULL,
                                   &(fibrad_heat_result){.power = power, .wall_power = wall_power}));
        for (int i = 0; i < N; i++) ck_assert_double_lt(fabs(power[i]), 1e-6); /* all have one temperature */
    }
}

/* A law that counts its calls, and answers something else than an emissivity at call number `fails`. */
struct law {
    int asked, fails;
    double wrong;
    bool null;
};

static void follow_law(void *context, const double *temperature, const double *wall_temperature, double *emissivity,
                       double *wall_emissivity) {
    struct law *law = context;
    law->null = law->null || temperature == NULL || wall_temperature == NULL;
    emissivity[0] = .5, wall_emissivity[0] = .8;
    if (law->asked++ == law->fails) *(law->asked % 2 ? emissivity : wall_emissivity) = law->wrong;
}

/* Laws get temperatures, and their answers are checked each time. */
TEST(laws_are_checked) {
    const fibrad_spheres one = {&(double){0}, &(double){0}, &(double){0}, &(double){1}, .n = 1};
    const fibrad_wall floor = plane_at(2, 0, -3);
    const double temperature = 400, wrong[] = {NAN, -.1, 1.1, INFINITY};
    double emissivity, wall_emissivity, power, found, wall_power, wall_found;
    fibrad_heat_result result = {
        .power = &power, .wall_power = &wall_power, .temperature = &found, .wall_temperature = &wall_found};
    OWNED_MADE *radiation = NULL;
    assert_ok(made_with(&radiation, &(fibrad_scene_config){.wall = &floor, .walls = 1}, &one,
                        &(fibrad_heat_config){.directions = 8, .patches = 24}, NULL));
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.surroundings = 300;
    for (int given = 0; given < 4; given++) {
        struct law law = {.fails = -1};
        sources.temperature = given % 2 ? &temperature : NULL;
        sources.wall_temperature = given / 2 ? &temperature : NULL;
        ck_assert_int_eq(made_settle(radiation, &sources, follow_law, &law, &emissivity, &wall_emissivity, &result),
                         given == 3 ? FIBRAD_OK : FIBRAD_E_ARGUMENT);
        ck_assert(!law.null && law.asked == (given == 3 ? 2 : 0));
    }
    for (int k = 0; k < 8; k++) {
        struct law law = {.fails = k / 4, .wrong = wrong[k % 4]};
        assert_invalid(made_settle(radiation, &sources, follow_law, &law, &emissivity, &wall_emissivity, &result));
    }
}
