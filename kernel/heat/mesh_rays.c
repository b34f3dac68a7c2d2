/* mesh_rays.c - rays of meshes that meet spheres, and the beams of these spheres. SPDX-License-Identifier: MIT */
#include "heat/errors.h"
#include "heat/sweep.h"

/* Beams of a row, and even minus odd ones. */
struct row_sum {
    double all, tilt;
};

/* Scales what a sphere has of walls whose rays do not count, and of the surroundings. This makes up for the difference
 * between beams to meshes and rays from them: if too many beams meet a mesh, too few pass beside it. rays: of rays,
 * exchange areas [L^2]. */
static void close_row(fibrad_heat *heat, uint32_t place, struct row_sum rays) {
    const double density = heat->density[place];
    unsigned char *const begin = heat->pencils.pool + heat->pencils.row[place].begin,
                         *const end = begin + heat->pencils.row[place].bytes;
    struct row_sum rest = {0, 0}, others = {density * rays.all, FIBRAD_HEAT_RAYS_WEIGHT * density * rays.tilt};
    for (unsigned char *at = begin; at < end; at += fibrad_heat_pencil_bytes(fibrad_heat_pencil_at(at))) {
        const fibrad_heat_pencil *pencil = fibrad_heat_pencil_at(at);
        const double seeing = pencil->body < heat->rows ? 0 : fibrad_heat_seeing(heat, pencil->body, place);
        const double beams = fibrad_heat_beams_of(pencil) * density / (density + seeing);
        struct row_sum *sum = pencil->body >= heat->rows && seeing == 0 ? &rest : &others;
        sum->all += beams, sum->tilt += pencil->tilt / 32767. * beams;
    }
    const double left = heat->beams - others.all, lacks = -others.tilt / left - rest.tilt / rest.all;
    for (unsigned char *at = begin; at < end && rest.all > 0 && left > 0;
         at += fibrad_heat_pencil_bytes(fibrad_heat_pencil_at(at))) {
        fibrad_heat_pencil *pencil = (void *)at;
        if (pencil->body < heat->rows || fibrad_heat_seeing(heat, pencil->body, place) > 0) continue;
        pencil->weight = (float)(left / rest.all * pencil->weight);
        pencil->tilt = (int16_t)(32767 * fibrad_max(-1, fibrad_min(1, pencil->tilt / 32767. + lacks)));
    }
}

uint32_t fibrad_heat_sphere_of(const fibrad_heat *heat, uint32_t patch) {
    uint32_t low = 0, high = heat->spheres;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (heat->first[middle] <= patch)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void fibrad_heat_link_rays(fibrad_heat *heat) {
    const uint32_t parts = heat->config.parts, others = fibrad_heat_others(heat);
    double *all = heat->solution.drift, *tilt = heat->solution.left;
    uint32_t *first = heat->first_met;
    fibrad_zero(first, (parts + 2) * sizeof *first);
    for (uint32_t b = 0; b < heat->spheres; b++) all[b] = tilt[b] = 0;
    for (int pass = 0; pass < 2 && heat->meshes > 0; pass++) { /* rays are counted first */
        for (uint32_t k = heat->sent[FIBRAD_MESHES].first; k < heat->rays; k++) {
            const fibrad_heat_ray *ray = &heat->ray[k];
            if (ray->area == 0 || ray->to >= others) continue;
            const uint32_t sphere = fibrad_heat_sphere_of(heat, ray->to), part = heat->part[sphere];
            if (pass == 0)
                first[part + 2]++, all[sphere] += ray->area, tilt[sphere] += k % 2 ? -ray->area : ray->area;
            else
                heat->met[first[part + 1]++] = k;
        }
        for (uint32_t part = 2; part < parts + 2 && pass == 0; part++) first[part] += first[part - 1];
    }
    for (uint32_t b = 0; b < heat->spheres; b++)
        if (all[b] > 0 && heat->division.root[b] == FIBRAD_NONE) close_row(heat, b, (struct row_sum){all[b], tilt[b]});
}
