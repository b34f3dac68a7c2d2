/* contact_list.h - contacts that have been found. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_CONTACT_LIST_H
#define FIBRAD_CONTACT_LIST_H

#include <math.h>

#include "simple/heap.h"

static inline double length_of(double x, double y, double z) { return sqrt(x * x + y * y + z * z); }

/* Contacts of spheres that need not be a bed: they may lie inside one another or beyond walls. Otherwise as
 * fibrad_bed_contacts. config: walls and meshes that fibrad_scene_init has accepted. Free the list with free().
 * Errors: _ARGUMENT, _MEMORY; _GEOMETRY: a period is less than the largest radius. */
int fibrad_contacts_find(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                         const fibrad_contact_rule *rule, fibrad_contact_list **list);

/* Two ends that are near enough, as in fibrad_contact_list. */
struct contact_found {
    uint32_t first, second;
    double distance, radius, other;
};

/* A growing block of them. */
struct contact_block {
    struct contact_found *contact;
    uint32_t n, capacity;
};

/* Adds a contact. Status 0, FIBRAD_E_MEMORY, or _UNSUPPORTED: there are more than 2^32. */
int fibrad_contact_add(struct contact_block *block, const struct contact_found *contact);

/* Makes a list of what was found, with spots, and frees the block. status: of the search. Returns it, or
 * FIBRAD_E_MEMORY. */
int fibrad_contact_list_of(struct contact_block *block, const fibrad_contact_rule *rule, int status,
                           fibrad_contact_list **list);

/* Spheres that are looked for at triangles. */
struct triangle_search {
    const double (*at)[4]; /* [n], centres and radii */
    uint32_t n;
    double gas_reach; /* over the radius */
    double period[3]; /* 0: none */
};

/* Adds contacts of spheres with walls of triangles. Status 0 or FIBRAD_E_MEMORY. */
int fibrad_contact_triangles(const struct fibrad_triangles *triangles, const struct triangle_search *search,
                             struct contact_block *block);

#endif
