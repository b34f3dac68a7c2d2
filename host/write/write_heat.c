/* write_heat.c - net radiative powers to files. SPDX-License-Identifier: MIT */
#include "write/write_heat.h"

#include <inttypes.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "write/vtp.h"

static void write_power(FILE *file, int64_t name, double temperature, double power) {
    fprintf(file, "%" PRId64 ",%.17g,%.17g\n", name, temperature, power);
}

int write_heat_csv(FILE *file, const struct heat_contents *what) {
    const fibrad_heat_sources *sources = what->sources;
    const fibrad_heat_result *result = what->result;
    fputs("i,T,q\n", file);
    for (uint32_t i = 0; i < what->bed->n; ++i) {
        if (interrupt_status()) return interrupt_status();
        write_power(file, bed_name(what->bed, i), sources->temperature[i], result->power[i]);
    }
    write_power(file, -1, sources->surroundings, result->surroundings_power);
    for (uint32_t k = 0; k < what->walls->count; ++k)
        write_power(file, -2 - (int64_t)k, sources->body_temperature[k], result->body_power[k]);
    return STATUS_OK;
}

int write_heat_vtp(FILE *file, const struct heat_contents *what) {
    const struct bed *bed = what->bed;
    vtp_begin(file, bed, "power");
    vtp_doubles(file, "temperature", what->sources->temperature, bed->n, NULL);
    vtp_doubles(file, "emissivity", what->sources->emissivity, bed->n, NULL);
    vtp_doubles(file, "power", what->result->power, bed->n, NULL);
    vtp_end(file, bed);
    return interrupt_status();
}
