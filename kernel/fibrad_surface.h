/* fibrad_surface.h - view factors by the surface method of Bao, Gao and Tan (2022): tensor-product Fibonacci
 * integration.
 *
 * Index: fibrad_surface_pair, FIBRAD_SURFACE_SCRATCH, fibrad_surface_row. Conventions are those of fibrad.h. For
 * comparison with that paper: the beams of fibrad.h are faster and more accurate.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SURFACE_H
#define FIBRAD_SURFACE_H

#include "fibrad.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The method of Bao, Gao and Tan: a Fibonacci lattice of nodes on either sphere, about the line of centres and
 * clustered at its poles; the sum of cos cos/(pi e^2) over all pairs of nodes, those of sphere 2 once more turned by
 * pi; each ray tested against the obstacles. */

/* What a rule may switch off. All but the first are for proofs: they cost time and change no result. */
typedef enum fibrad_surface_flags {
    FIBRAD_SURFACE_NO_CORRECTION = 1, /* the plain sum, without the factor exact/unblocked */
    FIBRAD_SURFACE_NO_HORIZON = 2,    /* visit nodes that cannot see the other sphere */
    FIBRAD_SURFACE_NO_REGION = 4,     /* test rays against obstacles that they cannot meet */
    FIBRAD_SURFACE_NO_EXACT = 8,      /* sum even if nothing is in between */
    FIBRAD_SURFACE_NO_HIDDEN = 16     /* test every ray even if one obstacle hides the whole sphere */
} fibrad_surface_flags;

/* How a surface factor is integrated. Zeroed: 55 nodes, corrected, no cutoff, the best instruction set. */
typedef struct fibrad_surface_rule {
    uint32_t nodes; /* N_F, a Fibonacci number from 8 to 987; 0: 55 */
    uint32_t flags; /* sum of fibrad_surface_flags */
    double cutoff;  /* rows: spheres whose centres are farther than this (1 + 1e-12) neither receive nor block [L]; 0:
                       none, which is only possible without periodic axes; at most 100 periods of any of those */
    int isa;        /* pairs: a fibrad_isa (rows use that of the scene). FIBRAD_ISA_BEST asks the machine at every call,
                       which under a hypervisor takes longer than the pair; others are used unasked, so take what
                       fibrad_isa_best has returned once */
} fibrad_surface_rule;

/* What else a pair turned out to be. The sums are 0 if they were not needed. */
typedef struct fibrad_surface_facts {
    double unblocked, blocked; /* F12 as summed, without and with the obstacles, not corrected */
    double error;              /* half the difference between the two turns of sphere 2 */
    uint64_t rays, tests;      /* pairs of nodes summed and ray-sphere tests, in whole vectors of the instruction set */
} fibrad_surface_facts;

/* Doubles of scratch memory for n obstacles. */
#define FIBRAD_SURFACE_SCRATCH(n) (12 * (((size_t)(n) + 7) / 8 * 8) + 8)

/* View factor F12 from sphere 1 (radius r1, centre at the origin) to sphere 2 (radius r2, centre (0, 0, r1 + r2 + gap))
 * with obstacles in between. r1, r2, gap [L] as in fibrad_pair_exact, but these and the obstacles' coordinates and
 * radii at most 1e70 r1; overlapping spheres are summed as if they touched. The lattices begin at azimuth 0, the x
 * axis, so the result depends a little on the azimuth of an obstacle. A point inside an obstacle sees nothing. Without
 * obstacles in the way the result is fibrad_pair_exact, unless corrections are off. scratch
 * [FIBRAD_SURFACE_SCRATCH(obstacles->n)]; obstacles (with scratch), rule (all defaults) and facts may be NULL.
 * Errors: _ARGUMENT, _TABLE (nodes), _ISA. Cost: about nodes^2/2 divisions and, for each obstacle in
 * the way, as many ray-sphere tests. Source: Y. Bao, Y. Gao, J. Tan (2022), docs/methods.md section 7. */
int fibrad_surface_pair(double r1, double r2, double gap, const fibrad_spheres *obstacles,
                        const fibrad_surface_rule *rule, double *scratch, double *f12, fibrad_surface_facts *facts);

/* Row i of the view factors of a scene by the surface method, pair by pair; blockers are the near spheres within the
 * cutoff, all of which the work memory must hold (132 bytes each). i [0, spheres). Sphere 1 of a pair is the
 * one of lower index; its frame has the z axis w towards sphere 2 and the x axis along a x w, a being the coordinate
 * axis that w has least of (the first where equal). So rows are reciprocal but for blockers within the
 * cutoff of one of two spheres. row->escaped is 1 - sum of f, as this method does not measure it (bodies are
 * FIBRAD_E_UNSUPPORTED); row->symmetric is 1; row->error is
 * the root of the sum of the pairs' squares. rule: NULL is all defaults; its isa is not used.
 * Errors: _ARGUMENT (included: no cutoff in a periodic scene, more than 2^28 spheres or images in the cube about the
 * cutoff), _TABLE (nodes), _CAPACITY as fibrad_beam_row. Cost: about 5 microseconds per partly hidden sphere within the
 * cutoff at 55 nodes, and 3 nanoseconds per pair of spheres within it. */
int fibrad_surface_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_surface_rule *rule,
                       fibrad_row *row);

#ifdef __cplusplus
}
#endif
#endif
