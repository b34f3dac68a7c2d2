/* moving_rows.h - rows of a bed that moves, those of which motion has changed little kept. SPDX-License-Identifier: MIT
 */
#ifndef MOVING_ROWS_H
#define MOVING_ROWS_H

#include <stdint.h>

#include "bed/bed.h"
#include "fibrad.h"

/* The rows of one bed, and what the kernel has to be asked about them. */
struct moving {
    uint32_t n;
    int threads;
    fibrad_beam_rule rule;
    fibrad_row *row;     /* [n] raw rows */
    double *error;       /* [n] estimated error of each through motion, since it was computed */
    uint32_t redone;     /* rows computed in the last step */
    uint32_t rounds;     /* in how many rounds, since new rows tell of further ones */
    fibrad_scene *scene; /* of the last step */
    /* its own */
    void *block;        /* of the scene */
    fibrad_row *fresh;  /* [n] rows computed in this round */
    unsigned char *due; /* [n] DUE: to be computed; DONE: computed in this step */
    fibrad_work *work;  /* [threads] */
    fibrad_rows *rows;  /* [threads] the row in hand */
};

/* Computes all rows of a bed. threads: 0 is all. End it also after an error. Status 0, STATUS_INPUT or STATUS_MEMORY.
 */
int moving_begin(struct moving *moving, const struct bed *bed, const fibrad_beam_rule *rule, int threads);

/* Goes on to the same spheres at other places: computes anew those rows whose estimated error through motion would
 * exceed `error`; with 0, all. Nothing depends on the number of threads. */
int moving_step(struct moving *moving, const struct bed *bed, double error);

void moving_end(struct moving *moving);

#endif
