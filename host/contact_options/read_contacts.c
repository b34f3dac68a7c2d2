/* read_contacts.c - conductances of contacts from a file. SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "cli/targets.h"
#include "contact_options/contact_option.h"
#include "text/unit.h"

/* Finds an end: a wall by its name, or a sphere. */
static int name_of_end(const struct lines *lines, const char *text, const struct bed *bed, const struct walls *walls,
                       uint32_t *end) {
    const uint32_t wall = wall_index(walls, text);
    *end = bed->n + wall;
    if (wall < WALLS_MAX) return STATUS_OK;
    char *rest;
    const int64_t name = strtoll(text, &rest, 10);
    if (rest == text || *rest) return lines_fault(lines, "'%.40s' is neither a sphere nor a wall", text);
    *end = targets_first(bed->ids ? bed->id : NULL, bed->n, (unsigned long long)name);
    if (*end < bed->n && bed_name(bed, *end) == name) return STATUS_OK;
    return lines_fault(lines, "there is no sphere %" PRId64, name);
}

int contacts_resize(struct contact_lines *to, size_t n) {
    bool good = true;
    to->first = memory_resized(to->first, n * sizeof *to->first, &good);
    to->second = memory_resized(to->second, n * sizeof *to->second, &good);
    to->conductance = memory_resized(to->conductance, n * sizeof *to->conductance, &good);
    return good ? STATUS_OK : message_memory();
}

static int take_contact(const struct lines *lines, const struct fields *fields, const struct bed *bed,
                        const struct walls *walls, double unit, struct contact_lines *to) {
    if (fields->n != 3) return lines_fault(lines, "%zu columns instead of i,j,W/K", fields->n);
    const uint32_t k = to->n;
    if (k > UINT32_MAX / 2) return message(STATUS_INPUT, "--contacts: too many contacts");
    int status = k & (k - 1) ? STATUS_OK : contacts_resize(to, 2 * (size_t)k + 1); /* doubles the room */
    if (!status) status = name_of_end(lines, fields->at[0], bed, walls, &to->first[k]);
    if (!status) status = name_of_end(lines, fields->at[1], bed, walls, &to->second[k]);
    if (!status) status = lines_number(lines, "conductance", fields->at[2], &to->conductance[k]);
    if (status) return status;
    to->conductance[k] *= unit;
    const bool periodic = bed->period[0] > 0 || bed->period[1] > 0 || bed->period[2] > 0;
    if (!(to->conductance[k] >= 0 && to->conductance[k] <= CONDUCTANCE_MOST))
        return lines_fault(lines, "the conductance is %g; it must be within 0 and %g", to->conductance[k],
                           CONDUCTANCE_MOST);
    if (to->first[k] == to->second[k] && !(periodic && to->first[k] < bed->n))
        return lines_fault(lines, "%s is in contact with itself", fields->at[0]);
    ++to->n;
    return STATUS_OK;
}

/* Takes the header i,j,UNIT. unit: of the conductances [W/K]. */
static int take_header(const struct lines *lines, const struct fields *fields, double *unit) {
    if (fields->n != 3 || strcmp(fields->at[0], "i") != 0 || strcmp(fields->at[1], "j") != 0)
        return lines_fault(lines, "the header is not i,j,W/K");
    if (unit_factor(fields->at[2], "W/K", unit)) return STATUS_OK;
    return lines_fault(lines,
                       "the third name of the header is '%.40s'; it must be a unit of conductance: W/K, mW/K or kW/K",
                       fields->at[2]);
}

int contacts_read(const char *pattern, const struct bed *bed, const struct walls *walls, struct contact_lines *to) {
    struct lines lines;
    struct fields fields = {0};
    char path[OUTPUT_PATH];
    double unit = 1;
    int status = output_numbered(pattern, bed->frame, path);
    if (status) return status;
    status = lines_open(&lines, path);
    if (status) return status;
    bool begun = false;
    for (bool more = true; !status;) {
        status = lines_next(&lines, &more);
        if (status || !more) break;
        if (lines_blank(&lines) || lines_comment(&lines)) continue;
        status = fields_split(&fields, lines.text, ",; \t\r");
        if (!status)
            status = begun ? take_contact(&lines, &fields, bed, walls, unit, to) : take_header(&lines, &fields, &unit);
        begun = true;
    }
    if (!status && !begun) status = message_at(STATUS_INPUT, lines.name, 0, "there is no header i,j,W/K");
    lines_close(&lines);
    free(fields.at);
    return status;
}
