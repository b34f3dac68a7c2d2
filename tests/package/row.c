/* row.c - a user of the installed library in C99: a pair, and a row in static memory. SPDX-License-Identifier: MIT */
#include <fibrad.h>

#include <math.h>
#include <stdio.h>

enum { N = 7 };

/* A sphere and six that touch it: nothing lies between it and them. */
static const double x[N] = {0, 2, -2, 0, 0, 0, 0}, y[N] = {0, 0, 0, 2, -2, 0, 0}, z[N] = {0, 0, 0, 0, 0, 2, -2},
                    r[N] = {1, 1, 1, 1, 1, 1, 1};

static unsigned char scene_block[FIBRAD_SCENE_BYTES(N)], work_block[FIBRAD_WORK_BYTES(64, N)];

static int report(const char *call, int status) {
    if (status != FIBRAD_OK) fprintf(stderr, "%s: %s\n", call, fibrad_status_text(status));
    return status;
}

int main(void) {
    fibrad_spheres spheres = {.x = x, .y = y, .z = z, .r = r, .n = N};
    fibrad_work work = {.memory = {.block = work_block, .size = sizeof work_block}};
    fibrad_beam_rule rule = {.directions = 233};
    fibrad_scene *scene;
    uint32_t col[N], k;
    double f[N], pair, sum = 0;
    fibrad_row row = {.col = col, .f = f, .capacity = N};

    if (report("pair", fibrad_pair_exact(1, 1, 0, &pair)) ||
        report("scene", fibrad_scene_init(&scene, scene_block, sizeof scene_block, NULL, &spheres, NULL)) ||
        report("row", fibrad_beam_row(scene, &work, 0, &rule, &row)))
        return 1;

    printf("fibrad %s\n", fibrad_version());
    for (k = 0; k < row.length; k++) {
        printf("F 0 %u %.17g\n", (unsigned)col[k], f[k]);
        if (fabs(f[k] - pair) > 1e-3) return 1;
        sum += f[k];
    }
    printf("escaped %.17g\n", row.escaped);
    if (row.length != 6 || fabs(sum + row.escaped - 1) > 1e-12) return 1;
    return fabs(pair - 0.0755868184216124) > 1e-15;
}
