/* fibrad_surface.h - view factors by the surface method of Bao, Gao and Tan (2022).
 *
 * Index
 *   fibrad_surface_pair         two spheres with obstacles in between
 *   FIBRAD_SURFACE_SCRATCH      doubles of scratch memory for a pair
 *   fibrad_surface_row          one row of a scene
 *
 * This method is here for comparison with the paper. The beams of fibrad.h are faster and more accurate. Units, words,
 * errors and the layout of comments are as in fibrad.h.
 *
 * Method   Each sphere carries a Fibonacci lattice of nodes about the line of centres. The nodes are clustered at the
 *          poles. Each node stands for a piece of the surface. Let a and b be the areas of two nodes and e the ray
 *          between them. Then F12 is the sum of a b cos cos/(pi e^2) over all pairs of nodes, divided by the area of
 *          sphere 1. A ray that meets an obstacle does not count. F12 is the mean of two such sums. For the second one
 *          the nodes of sphere 2 are turned by pi about the line of centres.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SURFACE_H
#define FIBRAD_SURFACE_H

#include "fibrad.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A step of the method that a rule may switch off. */
typedef enum fibrad_surface_flags {
    FIBRAD_SURFACE_NO_CORRECTION = 1 /* return the plain sum, without the factor exact/unblocked */
} fibrad_surface_flags;

/* How a factor is integrated. Zeroed: FIBRAD_NODES_DEFAULT nodes, corrected, no cutoff, the best instruction set.
 *
 * isa is used by fibrad_surface_pair only. FIBRAD_ISA_BEST asks the machine at every call. Under a hypervisor this
 * question takes longer than the pair. Other values are not checked against the machine: take the value that
 * fibrad_isa_best has returned once. */
typedef struct fibrad_surface_rule {
    uint32_t nodes; /* on each sphere, a Fibonacci number, FIBRAD_NODES_MIN to _MAX; 0: FIBRAD_NODES_DEFAULT */
    uint32_t flags; /* 0 or FIBRAD_SURFACE_NO_CORRECTION */
    double cutoff;  /* L, used by rows only, as in fibrad_beam_rule; at most 100 periods; 0: none, if not periodic */
    int isa;        /* a fibrad_isa, see above */
} fibrad_surface_rule;

/* Facts of a pair. The sums are 0 if the factor did not need them. */
typedef struct fibrad_surface_facts {
    double unblocked; /* F12 as summed without the obstacles, not corrected */
    double blocked;   /* F12 as summed with the obstacles, not corrected */
    double error;     /* estimated error: half the difference between both turns of sphere 2 */
    uint64_t rays;    /* pairs of nodes summed, in whole vectors of the instruction set */
    uint64_t tests;   /* tests of a ray against an obstacle, in whole vectors of the instruction set */
} fibrad_surface_facts;

/* Doubles of scratch memory for n obstacles. */
#define FIBRAD_SURFACE_SCRATCH(n) (12 * (((size_t)(n) + 7) / 8 * 8) + 8)

/* View factor F12 from sphere 1 to sphere 2 with obstacles in between. Sphere 1 has its centre at the origin. Sphere 2
 * has its centre at (0, 0, r1 + r2 + gap). Spheres that overlap are summed as if they touched. A point of sphere 1
 * inside an obstacle sees nothing. The lattices begin at azimuth 0, the x axis. Hence F12 depends a little on the
 * azimuth of an obstacle. If no obstacle is in the way, F12 is that of fibrad_pair_exact.
 *   Input    r1, r2, gap: [L] as for fibrad_pair_exact; r2 and gap at most 1e70 r1
 *            obstacles: spheres; coordinates and radii at most 1e70 r1; NULL: none
 *            rule: NULL for all defaults
 *            scratch[FIBRAD_SURFACE_SCRATCH(obstacles->n)]: NULL without obstacles
 *   Output   f12
 *            facts: may be NULL
 *   Errors   _ARGUMENT, _TABLE (nodes), _ISA
 *   Cost     nodes^2/2 divisions, and as many ray tests for each obstacle in the way
 *   Source   Y. Bao, Y. Gao, J. Tan (2022), docs/methods.md section 7 */
int fibrad_surface_pair(double r1, double r2, double gap, const fibrad_spheres *obstacles,
                        const fibrad_surface_rule *rule, double *scratch, double *f12, fibrad_surface_facts *facts);

/* Row i of the view factors of a scene, pair by pair.
 *
 * The obstacles of a pair are the spheres within the cutoff of sphere i. Sphere 1 of a pair is the one of lower index.
 * The z axis of a pair goes from sphere 1 to sphere 2. The x axis is the cross product of a and z. a is the coordinate
 * axis along which z has its smallest component. If several components are equally small, the first one counts. Hence
 * rows i and j sum a pair alike, and rows are reciprocal. An obstacle that lies within the cutoff of only one sphere of
 * the pair breaks this reciprocity. row->symmetric is 1. row->escaped is 1 - the sum of f. row->error is the root of
 * the sum of the squared errors of the pairs.
 *   Input    i: 0 to spheres - 1
 *            rule: NULL for all defaults
 *   Output   row
 *   Errors   _ARGUMENT: also a periodic scene without a cutoff, or more than 2^28 spheres or images in the cube about
 *            the cutoff
 *            _STATE, _TABLE (nodes), _CAPACITY, _WORK, _MEMORY, _SUM
 *            _UNSUPPORTED: the scene has walls, triangles or openings
 *   Cost     5 microseconds for each partly hidden sphere at 55 nodes, and 3 ns for each pair of spheres within the
 *            cutoff. Work memory must hold all spheres within the cutoff, 132 bytes each.
 *   Source   as fibrad_surface_pair */
int fibrad_surface_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_surface_rule *rule,
                       fibrad_row *row);

#ifdef __cplusplus
}
#endif
#endif
