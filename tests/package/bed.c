/* bed.c - a user of the simple layer: all view factors of a bed in eight lines; heat of a moving bed in fifteen.
 * SPDX-License-Identifier: MIT */
#include <fibrad_host.h>

#include <math.h>
#include <stdio.h>

enum { N = 27 };

static int print_factors(const fibrad_spheres *spheres) {
    fibrad_bed_matrix *bed;
    int status = fibrad_view_factors(NULL, spheres, NULL, NULL, &bed);
    if (status != FIBRAD_OK) return fprintf(stderr, "fibrad: %s\n", fibrad_status_text(status));
    for (uint32_t i = 0; i < bed->matrix.n; i++)
        for (uint64_t k = bed->matrix.start[i]; k < bed->matrix.start[i + 1]; k++)
            printf("F %u %u %.17g\n", (unsigned)i, (unsigned)bed->matrix.col[k], bed->matrix.f[k]);
    fibrad_bed_matrix_free(bed);
    return 0;
}

/* A bed that falls apart and cools, per unit heat capacity. */
static int cool(const fibrad_spheres *spheres, double *z, double *temperature, const double *emissivity) {
    double power[N];
    fibrad_bed *bed;
    fibrad_heat_sources sources;
    fibrad_heat_result result = {.power = power};
    fibrad_heat_sources_init(&sources);
    sources.temperature = temperature, sources.emissivity = emissivity, sources.surroundings = 300;
    int status = fibrad_bed_new(&bed, NULL, spheres, NULL);
    for (int step = 0; step < 10 && status == FIBRAD_OK; step++) {
        status = fibrad_bed_solve(bed, &sources, NULL, &result);
        for (int i = 0; i < N; i++) temperature[i] += 1e-3 * power[i], z[i] *= 1.01;
        if (status == FIBRAD_OK) status = fibrad_bed_move(bed, NULL, spheres);
    }
    fibrad_bed_free(bed);
    return status;
}

int main(void) {
    double at[N][3], r[N], temperature[N], emissivity[N], z[N];
    for (int i = 0; i < N; i++) {
        at[i][0] = 2 * (i % 3), at[i][1] = 2 * (i / 3 % 3), z[i] = at[i][2] = 2 * (i / 9) + 1;
        r[i] = 1, temperature[i] = 300 + 10 * i, emissivity[i] = 0.8;
    }
    const fibrad_spheres spheres = {.x = &at[0][0], .y = &at[0][1], .z = &at[0][2], .r = r, .n = N, .stride = 3};
    if (print_factors(&spheres) != 0) return 1;
    double x[N], y[N];
    for (int i = 0; i < N; i++) x[i] = at[i][0], y[i] = at[i][1];
    const fibrad_spheres moving = {.x = x, .y = y, .z = z, .r = r, .n = N};
    if (cool(&moving, z, temperature, emissivity) != FIBRAD_OK) return 1;
    for (int i = 0; i < N; i++) printf("T %d %.17g\n", i, temperature[i]);
    return !(temperature[26] < 560 && temperature[26] > 300 && fabs(temperature[0] - 300) < 50);
}
