/* copies.h - large periodic beds of small ones, for tests and benches. SPDX-License-Identifier: MIT */
#ifndef COPIES_H
#define COPIES_H

#include "bed/bed.h"
#include "cli/message.h"

/* Fills an empty bed with copies[axis] copies of a periodic bed side by side along each axis. So large beds are made
 * quickly: pushing apart takes more than linear time. The copies of one sphere follow each other. So neighbours in
 * space are as far apart in memory as in a random bed. Status 0 or STATUS_MEMORY. */
static inline int bed_make_copies(struct bed *to, const struct bed *from, const uint32_t copies[3]) {
    int status = STATUS_OK;
    for (uint32_t i = 0; i < from->n; ++i)
        for (uint32_t a = 0; a < copies[0]; ++a)
            for (uint32_t b = 0; b < copies[1]; ++b)
                for (uint32_t c = 0; c < copies[2] && !status; ++c)
                    status = bed_add(to, &(struct bed_sphere){.x = from->x[i] + a * from->period[0],
                                                              .y = from->y[i] + b * from->period[1],
                                                              .z = from->z[i] + c * from->period[2],
                                                              .r = from->r[i]});
    for (int axis = 0; axis < 3; ++axis) to->period[axis] = to->high[axis] = copies[axis] * from->period[axis];
    return status;
}

#endif
