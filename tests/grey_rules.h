/* grey_rules.h - rules of walls and of displacements with the surfaces of a rule of rows. SPDX-License-Identifier: MIT
 */
#ifndef TESTS_GREY_RULES_H
#define TESTS_GREY_RULES_H

#include "fibrad.h"

static inline fibrad_wall_rule wall_rule(const fibrad_exchange_rule *of) {
    return (fibrad_wall_rule){.emissivity = of->emissivity,
                              .wall_emissivity = of->wall_emissivity,
                              .node_emissivity = of->node_emissivity,
                              .conductivity = of->conductivity,
                              .paths = of->paths,
                              .seed = of->seed};
}

static inline fibrad_displacement_rule displacement_rule(const fibrad_exchange_rule *of) {
    return (fibrad_displacement_rule){
        .emissivity = of->emissivity, .wall_emissivity = of->wall_emissivity, .paths = of->paths, .seed = of->seed};
}

/* Calls that take them. */
static inline int wall_of(const fibrad_scene *scene, fibrad_work *work, uint32_t wall, const fibrad_exchange_rule *of,
                          uint32_t part, fibrad_wall_row *row, uint64_t *reflected) {
    const fibrad_wall_rule rule = wall_rule(of);
    return fibrad_exchange_wall(scene, work, wall, &rule, part, row, reflected);
}

static inline int displacement_of(const fibrad_scene *scene, fibrad_work *work, uint32_t i,
                                  const fibrad_exchange_rule *of, fibrad_displacement *displacement) {
    const fibrad_displacement_rule rule = displacement_rule(of);
    return fibrad_exchange_displacement(scene, work, i, &rule, displacement);
}

#endif
