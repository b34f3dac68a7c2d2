/* reproduce_powder.c - the face of a bed, beside the theory of two streams: its emissivity, and its absorptance for
 * light from straight above. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "bed/packing.h"
#include "cli/message.h"
#include "cli/progress.h"
#include "papers/reproduce/published.h"
#include "papers/reproduce/reproduce.h"

#define PI 3.14159265358979323846

enum { EMISSIVITIES = 5, PACKINGS = 3 };
static const double face_emissivities[EMISSIVITIES] = {.2, .4, .6, .8, 1}, face_porosity[PACKINGS] = {.4, .5, .8};

/* The emissivity of a face: what an isothermal layer of black surroundings emits over both faces, relative to black
 * faces. That is the sum of A_i e_i times the fraction of sphere i that escapes. */
static int face_emissivity(const struct bed *layer, double emissivity, double *face) {
    const fibrad_scene_config open = bed_scene(layer, NULL);
    const fibrad_exchange_rule rule = {.directions = 89, .paths = 50};
    const fibrad_bed_rule raw = {.raw = 1};
    fibrad_bed_matrix *factors = NULL;
    const int status = grey_factors(layer, &open, &rule, emissivity, &raw, &factors);
    double escaped = 0;
    for (uint32_t i = 0; i < layer->n && !status; ++i) escaped += factors->matrix.escaped[i];
    *face = 4 * PI * emissivity * escaped / (2 * layer->period[0] * layer->period[1]);
    fibrad_bed_matrix_free(factors);
    return status;
}

/* What the face absorbs of light from straight above, for each emissivity. */
static int face_absorptances(const struct bed *layer, double face[EMISSIVITIES]) {
    const fibrad_scene_config open = bed_scene(layer, NULL);
    const fibrad_spheres spheres = bed_spheres(layer);
    const fibrad_light light = {.direction = {0, 0, -1}, .flux = 1};
    struct progress bar = {0};
    fibrad_run run = {.threads = 1, .progress = progress_stage, .context = &bar};
    fibrad_bed *made = NULL;
    double *of_light = malloc(3 * layer->n * sizeof *of_light);
    int status = of_light ? fibrad_bed_new(&made, &open, &spheres, &run) : FIBRAD_E_MEMORY;
    for (int e = 0; e < EMISSIVITIES && !status; ++e) {
        for (uint32_t i = 0; i < layer->n; ++i) of_light[i] = face_emissivities[e];
        const fibrad_light_sources sources = {.light = &light, .lights = 1, .absorptivity = of_light};
        fibrad_light_result result = {.absorbed = of_light + layer->n, .absorbed_first = of_light + 2 * layer->n};
        status = fibrad_bed_shine(made, &sources, &result);
        face[e] = 1 - (result.reflected + result.transmitted) / result.incident;
    }
    progress_stop(&bar);
    fibrad_bed_free(made);
    free(of_light);
    return bed_status(layer, "bed", status, &run.fault);
}

/* Emissivities and absorptances of all layers. */
static int all_faces(double emits[PACKINGS][EMISSIVITIES], double absorbs[PACKINGS][EMISSIVITIES]) {
    int status = STATUS_OK;
    for (int k = 0; k < PACKINGS && !status; ++k) {
        struct bed layer = bed_empty();
        status = bed_make_layer(&layer, 1500, 1 - face_porosity[k], 1000, 1);
        for (int e = 0; e < EMISSIVITIES && !status; ++e)
            status = face_emissivity(&layer, face_emissivities[e], &emits[k][e]);
        if (!status) status = face_absorptances(&layer, absorbs[k]);
        bed_free(&layer);
    }
    return status;
}

static const char faces_script[] =
    "set xlabel 'emissivity of the spheres'\nset ylabel 'emissivity of the face of the bed'\nset xrange [0:1]\n"
    "set yrange [0:1]\nset key bottom right\ng(x) = sqrt(x/(1+4./9*(1-x)))\n"
    "p(k) = real(word('0.4 0.5 0.8', k))\n"
    "plot for [k=1:3] $data using (abs($1-p(k))<1e-9 ? $2 : 1/0):3 lw 2 lc k title sprintf('ours, porosity %.1f', "
    "p(k)), \\\n"
    "     $data using ($1 == 0.4 ? $2 : 1/0):5 pt 6 lc 4 title 'ours, light from above, porosity 0.4', \\\n"
    "     2*g(x)/(1+g(x)) with lines dt 3 lc 'black' title 'two streams: spheres far apart', \\\n"
    "     x with lines lc 'grey' title 'the spheres themselves'\n";

int reproduce_faces(struct reproduce *reproduce) {
    double emits[PACKINGS][EMISSIVITIES], absorbs[PACKINGS][EMISSIVITIES];
    const int status = all_faces(emits, absorbs);
    if (status) return status;
    fputs("porosity,emissivity,ours,two_streams,ours_of_light,two_streams_of_light\n", reproduce->data);
    for (int k = 0; k < PACKINGS; ++k)
        for (int e = 0; e < EMISSIVITIES; ++e) {
            const double solid = face_emissivities[e], porosity = face_porosity[k];
            const double emitted = emissivity_two_stream(solid), absorbed = absorptance_two_stream(solid);
            reproduce_compare(reproduce, SOURCE_CHECK, "", emitted, emits[k][e],
                              "emissivity, two streams, porosity %g, spheres %g", porosity, solid);
            reproduce_compare(reproduce, SOURCE_CHECK, "", absorbed, absorbs[k][e],
                              "absorptance from above, two streams, porosity %g, spheres %g", porosity, solid);
            fprintf(reproduce->data, "%g,%g,%.5f,%.5f,%.5f,%.5f\n", porosity, solid, emits[k][e], emitted,
                    absorbs[k][e], absorbed);
        }
    return reproduce_figure(reproduce, "faces", faces_script);
}
