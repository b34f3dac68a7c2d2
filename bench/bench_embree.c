/* bench_embree.c - peer: rays through Embree on the rows of bench_beam. SPDX-License-Identifier: MIT
 *
 *     bench_embree [quick]
 *
 * CSV as bench_beam's; built where Embree 3 is found. Spheres as sphere points, packets of 16 rays, one thread. Rays
 * leave evenly over the sphere by the cosine law. `owen`: a Sobol sequence in four dimensions with Owen's scrambling,
 * once for all, and another digital shift for each row; `mc`: pseudo-random numbers. Numbers are made beforehand and
 * not timed, which favours the peer; timed is what turns them into rays, and tracing. */
#include <embree3/rtcore.h>
#include <immintrin.h>

#include "centre.h"

enum { PACKET = 16, DIMENSIONS = 4, BITS = 32 };

#define PI 3.14159265358979323846f

static uint64_t mix(uint64_t z) {
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* Direction numbers by the recurrence of each dimension's primitive polynomial 1, x + 1, x^2 + x + 1, x^3 + x + 1. */
static void make_sobol(uint32_t v[DIMENSIONS][BITS]) {
    static const int degree[] = {0, 1, 2, 3};
    static const uint32_t inner[] = {0, 0, 1, 1}, first[][3] = {{0}, {1}, {1, 3}, {1, 3, 1}};
    for (int d = 0; d < DIMENSIONS; ++d)
        for (int k = 0; k < BITS; ++k) {
            const int s = degree[d];
            if (d == 0)
                v[d][k] = 1u << (31 - k);
            else if (k < s)
                v[d][k] = first[d][k] << (31 - k);
            else {
                v[d][k] = v[d][k - s] ^ v[d][k - s] >> s;
                for (int t = 1; t < s; ++t)
                    if (inner[d] >> (s - 1 - t) & 1) v[d][k] ^= v[d][k - t];
            }
        }
}

/* Flips each digit at random, depending on all digits before it. */
static uint32_t scramble(uint32_t x, uint64_t seed) {
    uint32_t out = 0;
    for (int bit = 31; bit >= 0; --bit) {
        const uint64_t prefix = bit == 31 ? 0 : x >> (bit + 1);
        const uint32_t flip = (uint32_t)(mix(seed ^ mix(prefix << 6 | (uint64_t)bit)) & 1);
        out |= ((x >> bit & 1) ^ flip) << bit;
    }
    return out;
}

static void make_numbers(bool owen, uint32_t rays, uint32_t *u) {
    uint32_t v[DIMENSIONS][BITS], x[DIMENSIONS] = {0};
    make_sobol(v);
    for (uint32_t k = 0; k < rays; ++k) {
        for (int d = 0; d < DIMENSIONS; ++d)
            u[DIMENSIONS * (size_t)k + (size_t)d] =
                owen ? scramble(x[d], mix((uint64_t)d + 1)) : (uint32_t)mix(((uint64_t)k * 4 + (uint64_t)d) * 977 + 1);
        const int change = __builtin_ctz(~k); /* Gray code */
        for (int d = 0; d < DIMENSIONS; ++d) x[d] ^= v[d][change & 31];
    }
}

static void set_ray(struct RTCRayHit16 *packet, int lane, const float centre[4], const uint32_t *u,
                    const uint32_t shift[DIMENSIONS]) {
    float q[DIMENSIONS];
    for (int d = 0; d < DIMENSIONS; ++d) q[d] = (float)(u[d] ^ shift[d]) * 0x1p-32f;
    const float nz = 1 - 2 * q[0], ring = sqrtf(fmaxf(0, 1 - nz * nz));
    const float nx = ring * cosf(2 * PI * q[1]), ny = ring * sinf(2 * PI * q[1]);
    const float z = sqrtf(fmaxf(0, 1 - q[2])), side = sqrtf(q[2]);
    const float x = side * cosf(2 * PI * q[3]), y = side * sinf(2 * PI * q[3]);
    /* two directions across the normal, without a branch near the poles */
    const float sign = copysignf(1, nz), a = -1 / (sign + nz), b = nx * ny * a;
    packet->ray.org_x[lane] = centre[0] + centre[3] * nx;
    packet->ray.org_y[lane] = centre[1] + centre[3] * ny;
    packet->ray.org_z[lane] = centre[2] + centre[3] * nz;
    packet->ray.dir_x[lane] = x * (1 + sign * nx * nx * a) + y * b + z * nx;
    packet->ray.dir_y[lane] = x * sign * b + y * (sign + ny * ny * a) + z * ny;
    packet->ray.dir_z[lane] = -x * sign * nx - y * ny + z * nz;
    packet->ray.tnear[lane] = 1e-4f; /* past the sphere it starts on */
    packet->ray.tfar[lane] = INFINITY;
    packet->ray.time[lane] = 0;
    packet->ray.mask[lane] = UINT32_MAX;
    packet->ray.id[lane] = 0;
    packet->ray.flags[lane] = 0;
    packet->hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
}

static void trace_row(RTCScene scene, const float *spheres, uint32_t i, const uint32_t *u, uint32_t rays,
                      uint32_t *hits) {
    static const _Alignas(64) int valid[PACKET] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    _Alignas(64) struct RTCRayHit16 packet;
    uint32_t shift[DIMENSIONS];
    for (int d = 0; d < DIMENSIONS; ++d) shift[d] = (uint32_t)mix(((uint64_t)i << 2 | (uint64_t)d) + 12345);
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (uint32_t k = 0; k < rays; k += PACKET) {
        for (int lane = 0; lane < PACKET; ++lane)
            set_ray(&packet, lane, spheres + 4 * (size_t)i, u + DIMENSIONS * ((size_t)k + (size_t)lane), shift);
        rtcIntersect16(valid, scene, &context, &packet);
        for (int lane = 0; lane < PACKET; ++lane)
            if (packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID) hits[packet.hit.primID[lane]]++;
    }
}

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
            trace_row(scene, spheres, centre->sphere[k], u, rays, hits);
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
    RTCGeometry points = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    float *spheres = rtcSetNewGeometryBuffer(points, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof *spheres,
                                             centre.bed.n);
    if (!spheres) return fprintf(stderr, "Embree: error %d\n", (int)rtcGetDeviceError(device)), 1;
    for (uint32_t j = 0; j < centre.bed.n; ++j) {
        const double values[] = {centre.bed.x[j], centre.bed.y[j], centre.bed.z[j], centre.bed.r[j]};
        for (int c = 0; c < 4; ++c) spheres[4 * j + (uint32_t)c] = (float)values[c];
    }
    rtcCommitGeometry(points);
    RTCScene scene = rtcNewScene(device);
    rtcAttachGeometry(scene, points);
    rtcReleaseGeometry(points);
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
