/* embree_rays.h - rays through Embree from spheres, by the cosine law, in packets. SPDX-License-Identifier: MIT */
#ifndef EMBREE_RAYS_H
#define EMBREE_RAYS_H

#include <embree3/rtcore.h>
#include <immintrin.h>

#include "bench_bed.h"

enum { PACKET = 16, DIMENSIONS = 4, BITS = 32 };

#define PI 3.14159265358979323846f

static inline uint64_t mix(uint64_t z) {
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* Direction numbers by the recurrence of each dimension's primitive polynomial 1, x + 1, x^2 + x + 1, x^3 + x + 1. */
static inline void make_sobol(uint32_t v[DIMENSIONS][BITS]) {
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

/* Flips each digit at random. The choice depends on all digits before it. */
static inline uint32_t scramble(uint32_t x, uint64_t seed) {
    uint32_t out = 0;
    for (int bit = 31; bit >= 0; --bit) {
        const uint64_t prefix = bit == 31 ? 0 : x >> (bit + 1);
        const uint32_t flip = (uint32_t)(mix(seed ^ mix(prefix << 6 | (uint64_t)bit)) & 1);
        out |= ((x >> bit & 1) ^ flip) << bit;
    }
    return out;
}

static inline void make_numbers(bool owen, uint32_t rays, uint32_t *u) {
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

static inline void set_ray(struct RTCRayHit16 *packet, int lane, const float centre[4], const uint32_t *u,
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
    packet->ray.tnear[lane] = 1e-4f; /* the ray begins beyond the surface of its own sphere */
    packet->ray.tfar[lane] = INFINITY;
    packet->ray.time[lane] = 0;
    packet->ray.mask[lane] = UINT32_MAX;
    packet->ray.id[lane] = 0;
    packet->ray.flags[lane] = 0;
    packet->hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
}

/* Counts what the rays from sphere i meet. Geometry 0 has the spheres, which are counted by their numbers. Geometry 1
 * counts as number n. */
static inline void trace_row(RTCScene scene, const float *spheres, uint32_t n, uint32_t i, const uint32_t *u,
                             uint32_t rays, uint32_t *hits) {
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
            if (packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID)
                hits[packet.hit.geomID[lane] == 0 ? packet.hit.primID[lane] : n]++;
    }
}

/* Attaches the spheres of a bed as geometry 0. The array belongs to Embree. Ends the program if this fails. */
static inline float *attach_spheres(RTCDevice device, RTCScene scene, const struct bed *bed) {
    RTCGeometry points = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    float *spheres =
        rtcSetNewGeometryBuffer(points, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof *spheres, bed->n);
    if (!spheres) fprintf(stderr, "Embree: error %d\n", (int)rtcGetDeviceError(device)), exit(1);
    for (uint32_t j = 0; j < bed->n; ++j) {
        const double values[] = {bed->x[j], bed->y[j], bed->z[j], bed->r[j]};
        for (int c = 0; c < 4; ++c) spheres[4 * j + (uint32_t)c] = (float)values[c];
    }
    rtcCommitGeometry(points);
    rtcAttachGeometry(scene, points);
    rtcReleaseGeometry(points);
    return spheres;
}

#endif
