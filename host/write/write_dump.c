/* write_dump.c - heat as a LAMMPS text dump, which OVITO and fibrad itself read. SPDX-License-Identifier: MIT */
#include <inttypes.h>

#include "cli/message.h"
#include "text/text.h"
#include "write/write.h"

static void write_header(FILE *file, const struct bed *bed, const struct heat_column *column, bool first) {
    if (first && bed->units[0]) fprintf(file, "ITEM: UNITS\n%s\n", bed->units);
    fprintf(file, "ITEM: TIMESTEP\n%" PRId64 "\nITEM: NUMBER OF ATOMS\n%" PRIu32 "\nITEM: BOX BOUNDS",
            bed->timestep < 0 ? bed->frame : bed->timestep, bed->n);
    for (int axis = 0; axis < 3; ++axis) fputs(bed->period[axis] > 0 ? " pp" : " ff", file);
    putc('\n', file);
    for (int axis = 0; axis < 3; ++axis) {
        const double low = bed_end(bed, axis, false), high = bed_end(bed, axis, true), period = bed->period[axis];
        char line[2 * TEXT_NUMBER], *at = text_real(line, low);
        *at++ = ' ';
        at = text_real(at, period > 0 && high - low != period ? low + period : high);
        *at++ = '\n';
        fwrite(line, 1, (size_t)(at - line), file);
    }
    fputs("ITEM: ATOMS id x y z radius T_K q_W", file);
    for (int k = HEAT_PARTS; k < HEAT_COLUMNS; ++k)
        if (column[k].value) fprintf(file, " %s", column[k].name);
    fprintf(file, "%s%s\n", bed->kept_names ? " " : "", bed->kept_names ? bed->kept_names : "");
}

int write_heat_dump(FILE *file, const struct contents *what) {
    const struct bed *bed = what->bed;
    struct heat_column column[HEAT_COLUMNS];
    heat_columns(what, column);
    char line[12 * TEXT_NUMBER];
    write_header(file, bed, column, what->first);
    for (uint32_t i = 0; i < bed->n; ++i) {
        if (interrupt_status()) return interrupt_status();
        size_t values = 6;
        double value[9] = {
            bed->x[i], bed->y[i], bed->z[i], bed->r[i], what->result->temperature[i], what->result->power[i]};
        for (int k = HEAT_PARTS; k < HEAT_COLUMNS; ++k)
            if (column[k].value) value[values++] = heat_value(&column[k], i);
        char *at = text_whole(line, bed_name(bed, i));
        for (size_t k = 0; k < values; ++k) {
            *at++ = ' ';
            at = text_real(at, value[k]);
        }
        fwrite(line, 1, (size_t)(at - line), file);
        if (bed->kept_names) fprintf(file, " %s", bed->kept + bed->kept_at[i]);
        putc('\n', file);
    }
    return STATUS_OK;
}
