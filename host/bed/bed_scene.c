/* bed_scene.c - a bed in the form of the library, and messages for errors of the library.
 * SPDX-License-Identifier: MIT */
#include "bed/bed_scene.h"

#include <math.h>

#include "cli/message.h"

fibrad_spheres bed_spheres(const struct bed *bed) {
    return (fibrad_spheres){.x = bed->x,
                            .y = bed->y,
                            .z = bed->z,
                            .r = bed->r,
                            .n = bed->n,
                            .id = bed->ids ? (const uint64_t *)bed->id : NULL,
                            .clump = bed->clump};
}

fibrad_scene_config bed_scene(const struct bed *bed, const struct walls *walls) {
    return (fibrad_scene_config){.period = {bed->period[0], bed->period[1], bed->period[2]},
                                 .wall = walls ? walls->wall : NULL,
                                 .walls = walls ? walls->count : 0,
                                 .opening = walls ? walls->opening : NULL,
                                 .openings = walls ? walls->openings : 0,
                                 .triangles = walls && walls->meshes ? &walls->meshes->triangles : NULL};
}

/* Refuses a sphere that overlaps its own image or reaches beyond an opening. */
static int bed_misplaced(const struct bed *bed, const char *file, uint32_t i) {
    bool image = false;
    for (int axis = 0; axis < 3; ++axis) image = image || (bed->period[axis] > 0 && bed->period[axis] < 2 * bed->r[i]);
    return message_at(STATUS_INPUT, file, bed->line[i],
                      image ? "sphere %lld overlaps its own image in the periodic box"
                            : "sphere %lld reaches beyond an opening; move the opening, or leave out its coordinate",
                      (long long)bed_name(bed, i));
}

/* Refuses two spheres that overlap too much. The message names the line of the sphere that comes later in the file. */
static int bed_overlap(const struct bed *bed, const char *file, uint32_t first, uint32_t second) {
    const uint32_t later = bed->line[first] < bed->line[second] ? second : first;
    const uint32_t other = later == first ? second : first;
    char place[BED_LINE_TEXT];
    if (later == other) return bed_misplaced(bed, file, later);
    const bool equal =
        bed->x[first] == bed->x[second] && bed->y[first] == bed->y[second] && bed->z[first] == bed->z[second];
    return message_at(STATUS_INPUT, file, bed->line[later],
                      equal ? "sphere %lld has the same centre as sphere %lld%s"
                            : "sphere %lld and sphere %lld%s: the centre of one lies inside the other",
                      (long long)bed_name(bed, later), (long long)bed_name(bed, other),
                      bed_line_text(bed, other, place));
}

int bed_status(const struct bed *bed, const char *file, int status, const fibrad_fault *fault) {
    const uint32_t first = fault->first, second = fault->second;
    const bool known = first < bed->n && second < bed->n;
    if (!status) return STATUS_OK;
    if (status == FIBRAD_E_CANCELLED) return interrupt_status();
    if (status == FIBRAD_E_MEMORY) return message_memory();
    if (status == FIBRAD_E_GEOMETRY && fault->why == FIBRAD_WHY_CLUMP)
        return message_at(STATUS_INPUT, file, bed->line[first],
                          "sphere %lld: its clump %u touches its own image, so the periodic box is too small for it",
                          (long long)bed_name(bed, first), bed->clump[first]);
    if (status == FIBRAD_E_GEOMETRY && known) return bed_overlap(bed, file, first, second);
    if (status == FIBRAD_E_GEOMETRY)
        return message_at(STATUS_INPUT, file, 0, "the periodic box is smaller than a sphere's radius");
    if (status == FIBRAD_E_UNSETTLED) return message_at(STATUS_INPUT, file, 0, "%s", fibrad_status_text(status));
    if (!known)
        return message_at(STATUS_INPUT, file, 0, "this bed and box cannot be computed: %s", fibrad_status_text(status));
    const bool place = fault->why == FIBRAD_WHY_PLACE;
    const double value[] = {bed->x[first], bed->y[first], bed->z[first], bed->r[first]};
    int worst = place ? 0 : 3;
    for (int axis = 1; axis < 3 && place; ++axis)
        if (fabs(value[axis]) > fabs(value[worst])) worst = axis;
    if (fault->why == FIBRAD_WHY_CLUMP_HEAT)
        return message_at(
            STATUS_INPUT, file, bed->line[first],
            "sphere %lld: the members of clump %u have different temperatures or stores, or only some have one",
            (long long)bed_name(bed, first), bed->clump[first]);
    if (place || fault->why == FIBRAD_WHY_RADIUS)
        return message_at(STATUS_INPUT, file, bed->line[first], "sphere %lld: %c is %g: %s",
                          (long long)bed_name(bed, first), "xyzr"[worst], value[worst], fibrad_why_text(fault->why));
    return message_at(STATUS_INPUT, file, bed->line[first], "sphere %lld: %s", (long long)bed_name(bed, first),
                      fibrad_status_text(status));
}
