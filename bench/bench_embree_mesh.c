/* bench_embree_mesh.c - a peer: rows beside a bundle of tubes in a settled bed, by beams and by rays through Embree.
 * SPDX-License-Identifier: MIT
 *
 *     bench_embree_mesh [quick | BED]
 *
 * The bench writes CSV to standard output. Seven tubes of 5,000 triangles stand in a bed. The spheres that meet a tube
 * are taken out. If BED is given, the 5,000 spheres nearest to the centre of the middle tube stay. Otherwise the bed is
 * random. The rows are those of the spheres nearest to the tubes. A row has an entry for each sphere, and one entry for
 * all tubes. The true rows are by beams with exact areas and many directions.
 *
 * As in bench_embree, one thread does the work, times are processor times of the rows alone, and numbers for rays are
 * made beforehand. Errors are the root mean square over all entries that are not 0 in the true rows, and the Euclidean
 * error of a row. `tubes` is the error of the entry for the tubes. */
#include "bed/packing.h"
#include "bench_triangles.h"
#include "embree_rays.h"
#include "read/read.h"

enum { TUBES = 7, ROWS = 10, ROUNDS = 3 };

/* Bed, tubes, and the rows to be computed, with their true values: [rows][n + 1]. */
struct bundle {
    struct bed bed;
    struct bench_triangles triangles;
    double middle[TUBES][2], radius, ends[2];
    uint32_t rows, sphere[ROWS];
    double *truth;
};

static double tube_gap(const struct bundle *b, const struct bed *bed, uint32_t i) {
    double gap = INFINITY;
    for (int t = 0; t < TUBES; ++t)
        gap = fmin(gap, hypot(bed->x[i] - b->middle[t][0], bed->y[i] - b->middle[t][1]) - b->radius - bed->r[i]);
    return gap;
}

/* Seven tubes, six about one, along z through the middle of a bed. */
static void stand_tubes(struct bundle *b, const struct bed *from, double radius, double pitch, uint32_t facets) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    const double *at[3] = {from->x, from->y, from->z};
    for (int axis = 0; axis < 3; ++axis)
        for (uint32_t i = 0; i < from->n; ++i)
            low[axis] = fmin(low[axis], at[axis][i]), high[axis] = fmax(high[axis], at[axis][i]);
    b->radius = radius, b->ends[0] = low[2], b->ends[1] = high[2];
    b->triangles = bench_triangles_new(TUBES * 2 * facets * 3);
    for (int t = 0; t < TUBES; ++t) {
        const double angle = 2 * 3.14159265358979323846 * t / 6;
        b->middle[t][0] = 0.5 * (low[0] + high[0]) + (t < 6 ? pitch * cos(angle) : 0);
        b->middle[t][1] = 0.5 * (low[1] + high[1]) + (t < 6 ? pitch * sin(angle) : 0);
        bench_tube(&b->triangles, b->middle[t], radius, b->ends, facets, 3, true, 0);
    }
    memset(b->triangles.back, 0, b->triangles.list.n * sizeof *b->triangles.back); /* their ends are open */
}

static double from_middle(const struct bundle *b, const struct bed *bed, uint32_t i) {
    return hypot(hypot(bed->x[i] - b->middle[6][0], bed->y[i] - b->middle[6][1]),
                 bed->z[i] - 0.5 * (b->ends[0] + b->ends[1]));
}

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Takes from a bed the spheres that meet no tube: at most `most` of them, those nearest to the middle. */
static void take_clear(struct bundle *b, const struct bed *from, uint32_t most) {
    double *away = bench_array(from->n, sizeof *away);
    uint32_t clear = 0;
    for (uint32_t i = 0; i < from->n; ++i)
        if (tube_gap(b, from, i) > 0) away[clear++] = from_middle(b, from, i);
    qsort(away, clear, sizeof *away, by_size);
    const double limit = clear > most ? away[most - 1] : INFINITY;
    b->bed = bed_empty();
    for (uint32_t i = 0; i < from->n; ++i)
        if (tube_gap(b, from, i) > 0 && from_middle(b, from, i) <= limit &&
            bed_add(&b->bed, &(struct bed_sphere){.x = from->x[i], .y = from->y[i], .z = from->z[i], .r = from->r[i]}))
            bench_check("bed", FIBRAD_E_MEMORY);
    free(away);
}

/* The spheres near the middle that are nearest to tubes. */
static void find_rows(struct bundle *b) {
    double least = 0;
    for (b->rows = 0; b->rows < ROWS; ++b->rows) {
        double best = INFINITY;
        for (uint32_t i = 0; i < b->bed.n; ++i) {
            const double gap = tube_gap(b, &b->bed, i);
            if (gap > least && gap < best && from_middle(b, &b->bed, i) < 12 * b->bed.r[i])
                best = gap, b->sphere[b->rows] = i;
        }
        least = best;
        if (best == INFINITY) break;
    }
}

/* Sums of squared errors: of all entries, and of the entry for the tubes. */
struct bundle_error {
    double square, tubes;
    uint64_t entries;
};

static void add_error(const struct bundle *b, uint32_t k, const double *full, struct bundle_error *sum) {
    const uint32_t n = b->bed.n;
    const double *truth = b->truth + (size_t)k * (n + 1);
    for (uint32_t j = 0; j <= n; ++j) {
        sum->square += (full[j] - truth[j]) * (full[j] - truth[j]);
        sum->entries += truth[j] > 0;
    }
    sum->tubes += (full[n] - truth[n]) * (full[n] - truth[n]);
}

static void print_error(const struct bundle *b, const char *method, uint32_t setting, double seconds,
                        const struct bundle_error *sum) {
    printf("%s,%u,%.1f,%.3g,%.3g,%.3g\n", method, setting, 1e6 * seconds / b->rows,
           sqrt(sum->square / (double)sum->entries), sqrt(sum->square / b->rows), sqrt(sum->tubes / b->rows));
    fflush(stdout);
}

static void spread_row(const fibrad_row *row, uint32_t n, double *full) {
    memset(full, 0, (n + 1) * sizeof *full);
    for (uint32_t e = 0; e < row->length; ++e) full[row->col[e]] = row->f[e];
    full[n] = row->wall[0];
}

static void bench_beams(struct bundle *b, const fibrad_scene *scene, uint32_t directions, uint32_t points) {
    const uint32_t n = b->bed.n;
    fibrad_work work = BENCH_GROWING;
    fibrad_row row = bench_arrays(n);
    double *full = bench_array(n + 1, sizeof *full), best = INFINITY;
    const fibrad_beam_rule rule = {.directions = directions, .points = points};
    struct bundle_error sum = {0};
    row.wall = bench_array(1, sizeof *row.wall);
    for (int round = 0; round < (b->truth ? ROUNDS : 1); ++round) {
        double seconds = 0;
        sum = (struct bundle_error){0};
        for (uint32_t k = 0; k < b->rows; ++k) {
            const double begun = bench_thread_seconds();
            bench_check("row", fibrad_beam_row(scene, &work, b->sphere[k], &rule, &row));
            seconds += bench_thread_seconds() - begun;
            spread_row(&row, n, full);
            add_error(b, k, full, &sum);
        }
        best = fmin(best, seconds);
    }
    print_error(b, points ? "beam 256 points" : "beam", directions, best, &sum);
    free(work.memory.block);
    free(row.col), free(row.f), free(row.wall);
    free(full);
}

static void bench_rays(struct bundle *b, RTCScene scene, const float *spheres, uint32_t rays) {
    const uint32_t n = b->bed.n;
    uint32_t *u = bench_array((size_t)rays * DIMENSIONS, sizeof *u), *hits = bench_array(n + 1, sizeof *hits);
    double *full = bench_array(n + 1, sizeof *full), best = INFINITY;
    struct bundle_error sum = {0};
    make_numbers(true, rays, u);
    for (int round = 0; round < ROUNDS; ++round) {
        double seconds = 0;
        sum = (struct bundle_error){0};
        for (uint32_t k = 0; k < b->rows; ++k) {
            memset(hits, 0, (n + 1) * sizeof *hits);
            const double begun = bench_thread_seconds();
            trace_row(scene, spheres, n, b->sphere[k], u, rays, hits);
            seconds += bench_thread_seconds() - begun;
            for (uint32_t j = 0; j <= n; ++j) full[j] = (double)hits[j] / rays;
            add_error(b, k, full, &sum);
        }
        best = fmin(best, seconds);
    }
    print_error(b, "embree owen", rays, best, &sum);
    free(u), free(hits), free(full);
}

static void find_truth(struct bundle *b, const fibrad_scene *scene, uint32_t directions) {
    fibrad_work work = BENCH_GROWING;
    fibrad_row row = bench_arrays(b->bed.n);
    double wall;
    row.wall = &wall;
    b->truth = bench_array((size_t)b->rows * (b->bed.n + 1), sizeof *b->truth);
    for (uint32_t k = 0; k < b->rows; ++k) {
        const fibrad_beam_rule rule = {.directions = directions};
        bench_check("row", fibrad_beam_row(scene, &work, b->sphere[k], &rule, &row));
        spread_row(&row, b->bed.n, b->truth + (size_t)k * (b->bed.n + 1));
    }
    free(work.memory.block);
    free(row.col), free(row.f);
}

static void attach_triangles(RTCDevice device, RTCScene scene, const struct bench_triangles *t) {
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *at =
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof *at, t->list.vertices);
    uint32_t *corner =
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof *corner, t->list.n);
    if (!at || !corner) fprintf(stderr, "Embree: error %d\n", (int)rtcGetDeviceError(device)), exit(1);
    for (size_t k = 0; k < 3 * (size_t)t->list.vertices; ++k) at[k] = (float)t->at[k];
    memcpy(corner, t->corner, 3 * (size_t)t->list.n * sizeof *corner);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
    rtcReleaseGeometry(mesh);
}

int main(int argc, char **argv) {
    static const uint32_t directions[] = {55, 100, 200, 400, 800, 1600}, rays[] = {1 << 13, 1 << 17, 1 << 20};
    const bool quick = argc == 2 && strcmp(argv[1], "quick") == 0;
    const uint32_t settings = quick ? 2 : 6, samples = quick ? 1 : 3;
    struct bed from = bed_empty();
    struct bundle bundle = {0};
    const int status = argc == 2 && !quick ? read_bed(argv[1], &(struct read_options){0}, &from)
                                           : bed_make_packing(&from, quick ? 500 : 7000, 0.4, 0.6, 0.58, 1);
    if (status) return status;
    stand_tubes(&bundle, &from, quick ? 0.6 : 1, quick ? 1.6 : 3, 119);
    take_clear(&bundle, &from, 5000);
    find_rows(&bundle);

    void *block;
    const fibrad_wall mesh = {.kind = FIBRAD_WALL_MESH};
    const fibrad_scene *scene = bench_scene_in(&bundle.bed, &mesh, 1, &bundle.triangles, &block);
    _mm_setcsr(_mm_getcsr() | 0x8040); /* no denormal numbers, as Embree's manual asks */
    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene peer = rtcNewScene(device);
    const float *spheres = attach_spheres(device, peer, &bundle.bed);
    attach_triangles(device, peer, &bundle.triangles);
    rtcSetSceneBuildQuality(peer, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(peer);

    bench_preamble("bench_embree_mesh: " RTC_VERSION_STRING " on rows beside tubes", 1);
    printf("# %u spheres, %u triangles, %u rows\n", bundle.bed.n, bundle.triangles.list.n, bundle.rows);
    puts("method,setting,us_per_row,rms_per_entry,euclidean,tubes");
    find_truth(&bundle, scene, quick ? 1000 : 20000);
    for (uint32_t s = 0; s < settings; ++s) bench_beams(&bundle, scene, directions[s], 0);
    for (uint32_t s = 0; s < settings; ++s) bench_beams(&bundle, scene, directions[s], 256);
    for (uint32_t s = 0; s < samples; ++s) bench_rays(&bundle, peer, spheres, rays[s]);
    rtcReleaseScene(peer);
    rtcReleaseDevice(device);
    free(block);
    bench_triangles_free(&bundle.triangles);
    bed_free(&bundle.bed);
    bed_free(&from);
    return 0;
}
