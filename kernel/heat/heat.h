/* heat.h - what the files of the heat room share. SPDX-License-Identifier: MIT
 *
 * Surfaces are cut into patches, numbered through: P of each sphere in the order of the scene's places, then those of
 * the walls, then the surroundings as one. Patches of one sphere follow each other so that four at a time make up a
 * patch of the next coarser level. */
#ifndef FIBRAD_HEAT_HEAT_H
#define FIBRAD_HEAT_HEAT_H

#include "bed/scene.h"

/* What a sweep reads of a patch: side by side, since hits come to patches in no order. */
typedef struct fibrad_heat_source {
    double value;
    double density; /* beams per area that its surface sends out */
} fibrad_heat_source;

typedef enum fibrad_heat_phase {
    FIBRAD_HEAT_EMPTY, /* beams are being traced */
    FIBRAD_HEAT_AREA,  /* the sweep in hand sums the areas of patches */
    FIBRAD_HEAT_FIRST, /* that of the radiosity to begin with */
    FIBRAD_HEAT_STEPS, /* that of a search direction */
    FIBRAD_HEAT_DONE
} fibrad_heat_phase;

struct fibrad_heat {
    fibrad_heat_config config;
    const fibrad_scene *scene;
    uint32_t beams;   /* of one sphere: directions times points */
    uint32_t patches; /* all of them */
    uint32_t side;    /* patches of a sphere along an edge of its cube */
    uint16_t *leave;  /* [beams] which patch of a sphere each beam leaves: the same for all spheres */
    uint32_t *hit;    /* [spheres][beams] the patch it meets */

    fibrad_heat_source *source; /* [patches] of the sweep in hand */
    double *gathered;           /* [parts][patches] what the beams of each part bring */
    double *area;               /* [patches] as the beams have it [L2] */
    double *radiosity;          /* [patches] J */
    double *received;           /* [patches] what comes in at these J, H times area */
    double *direction;          /* [patches] of the search */
    double *emissivity, *emission; /* [patches] eps, and E = sigma T^4 */
    double *coarse;             /* [spheres] net power at the coarser level */

    fibrad_heat_phase phase;
    uint32_t group; /* patches that share one J: 1, 4, or all of a sphere */
    double slope;   /* residual times preconditioned residual */
    double scale;   /* what `slope` is compared with */
    double tolerance;
    uint32_t sweeps, limit;
    bool solved; /* radiosity and emission are those of an earlier solution */
};

#endif
