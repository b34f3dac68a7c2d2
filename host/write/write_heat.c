/* write_heat.c - net radiative powers to files. SPDX-License-Identifier: MIT */
#include "write/write_heat.h"

#include <inttypes.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "write/vtp.h"

int write_heat_csv(FILE *file, const struct heat_contents *what) {
    const fibrad_heat_sources *sources = &what->options->sources;
    const fibrad_heat_result *heat = &what->report->heat;
    fputs("i,T,q\n", file);
    for (uint32_t i = 0; i < what->bed->n; ++i) {
        if (interrupt_status()) return interrupt_status();
        const int64_t name = what->ids ? what->bed->id[i] : (int64_t)i;
        fprintf(file, "%" PRId64 ",%.17g,%.17g\n", name, sources->temperature[i], heat->power[i]);
    }
    fprintf(file, "-1,%.17g,%.17g\n", sources->surroundings, heat->surroundings_power);
    for (uint32_t k = 0; k < what->walls->count; ++k) {
        const uint32_t wall = what->walls->wall[k];
        fprintf(file, "%" PRId64 ",%.17g,%.17g\n", -2 - (int64_t)k, sources->wall_temperature[wall],
                heat->wall_power[wall]);
    }
    return STATUS_OK;
}

int write_heat_vtp(FILE *file, const struct heat_contents *what) {
    const struct bed *bed = what->bed;
    vtp_begin(file, bed, "power");
    vtp_doubles(file, "temperature", what->options->sources.temperature, bed->n, NULL);
    vtp_doubles(file, "emissivity", what->options->sources.emissivity, bed->n, NULL);
    vtp_doubles(file, "power", what->report->heat.power, bed->n, NULL);
    vtp_end(file, bed);
    return interrupt_status();
}
