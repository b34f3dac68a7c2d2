/* bench_embree.c - a peer: rays through Embree on the rows of bench_beam. SPDX-License-Identifier: MIT
 *
 *     bench_embree [quick]
 *
 * The bench is built if Embree 3 is found. It writes CSV with the columns of bench_beam. Spheres are sphere points of
 * Embree. Rays are traced in packets of 16, by one thread. They leave evenly over the sphere by the cosine law. Lines
 * `owen` take a Sobol sequence in four dimensions with Owen's scrambling. The scrambling is the same for all rows. Each
 * row has another digital shift. Lines `mc` take pseudo-random numbers. The numbers are made beforehand and are not
 * timed, which favours the peer. The time is that of making rays from numbers, and of tracing. */
#include "centre.h"
#include "embree_rays.h"

static void bench(const struct centre *centre, RTCScene scene, const float *spheres, bool owen, uint32_t rays) {
    const uint32_t n = centre->bed.n;
    uint32_t *u = bench_array((size_t)rays * DIMENSIONS, sizeof *u), *hits = bench_array(n, sizeof *hits);
    double *full = bench_array(n, sizeof *full), best = INFINITY;
    struct centre_error sum = {0};
    make_numbers(owen, rays, u);
    for (int round = 0; round < 3; ++round) {
        double seconds = 0;
        sum = (struct centre_error){0};
        for (uint32_t k = 0; k < centre->rows; ++k) {
            memset(hits, 0, n * sizeof *hits);
            const double begun = bench_thread_seconds();
            trace_row(scene, spheres, n, centre->sphere[k], u, rays, hits);
            seconds += bench_thread_seconds() - begun;
            for (uint32_t j = 0; j < n; ++j) full[j] = (double)hits[j] / rays;
            centre_add_error(centre, k, full, &sum);
        }
        best = fmin(best, seconds);
    }
    centre_print(owen ? "embree owen" : "embree mc", "rays", rays, best, &sum);
    free(u);
    free(hits);
    free(full);
}

int main(int argc, char **argv) {
    static const uint32_t rays[] = {1 << 10, 1 << 13, 1 << 17, 1 << 20};
    const bool quick = argc > 1 && strcmp(argv[1], "quick") == 0;
    struct centre centre;
    const int status = centre_make(&centre, quick ? 200 : 1000, quick ? 2 : 10, quick ? 2000 : 40000);
    if (status) return status;
    _mm_setcsr(_mm_getcsr() | 0x8040); /* no denormal numbers, as Embree's manual asks */
    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene scene = rtcNewScene(device);
    const float *spheres = attach_spheres(device, scene, &centre.bed);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene);
    bench_preamble("bench_embree: " RTC_VERSION_STRING " on the rows of bench_beam", 1);
    puts(CENTRE_COLUMNS);
    for (int owen = 1; owen >= 0; --owen)
        for (size_t r = 0; r < (quick ? 2 : sizeof rays / sizeof *rays); ++r)
            bench(&centre, scene, spheres, owen, rays[r]);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    return 0;
}
