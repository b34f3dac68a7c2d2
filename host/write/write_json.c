/* write_json.c - a frame as an object of JSON in one line, so that several frames are JSON lines.
 * SPDX-License-Identifier: MIT
 *
 * Numbers that are not finite are null. */
#include <inttypes.h>
#include <math.h>

#include "cli/message.h"
#include "text/text.h"
#include "write/write.h"

/* Writes a further entry of an object. */
static void json_entry(FILE *file, const char *name, double value) {
    fprintf(file, ",\"%s\":", name);
    text_json_real(file, value);
}

static void json_whole(FILE *file, int64_t value) {
    char text[TEXT_NUMBER];
    const char *end = text_whole(text, value);
    fwrite(text, 1, (size_t)(end - text), file);
}

/* Writes an entry of an object: an array of n values, each `stride`th one of `values`. valid [n]: 0: the value is null;
 * valid NULL: all are valid. `comma` stands before the entry. */
static void json_reals(FILE *file, const char *comma, const char *name, const double *values, uint64_t n, size_t stride,
                       const unsigned char *valid) {
    fprintf(file, "%s\"%s\":[", comma, name);
    for (uint64_t i = 0; i < n && !interrupt_status(); ++i) {
        if (i > 0) putc(',', file);
        text_json_real(file, !valid || valid[i] ? values[i * stride] : NAN);
    }
    putc(']', file);
}

/* Begins the object of a frame: kind, file, frame, timestep and time. */
static void json_frame(FILE *file, const struct contents *what, const char *kind) {
    const struct bed *bed = what->bed;
    fprintf(file, "{\"kind\":\"%s\"", kind);
    if (what->file) {
        fputs(",\"file\":", file);
        text_json(file, what->file);
    }
    fprintf(file, ",\"frame\":%" PRId64 ",\"timestep\":", bed->frame);
    if (bed->timestep < 0)
        fputs("null", file);
    else
        json_whole(file, bed->timestep);
    if (what->time) json_entry(file, "time_s", *what->time);
}

/* Begins the object of a frame with the names of its spheres. */
static void json_begin(FILE *file, const struct contents *what, const char *kind) {
    const struct bed *bed = what->bed;
    json_frame(file, what, kind);
    fputs(",\"id\":[", file);
    for (uint32_t i = 0; i < bed->n; ++i) {
        if (i > 0) putc(',', file);
        json_whole(file, bed_name(bed, i));
    }
    putc(']', file);
}

/* Writes the factors from each wall to all walls, in the order of `walls`, and to the surroundings. */
static void json_wall_rows(FILE *file, const struct contents *what) {
    const fibrad_factors *matrix = &what->factors->matrix;
    char name[WALL_NAME];
    for (uint32_t k = 0; k < matrix->walls; ++k) {
        fprintf(file, "%s\"%s\":{", k > 0 ? "," : ",\"wall_rows\":{", contents_wall(what, k, name));
        json_reals(file, "", "walls", matrix->wall_wall + (size_t)k * matrix->walls, matrix->walls, 1, NULL);
        json_entry(file, "escaped", matrix->wall_escaped[k]);
        json_entry(file, "error", matrix->wall_error[k]);
        putc('}', file);
    }
    putc('}', file);
}

/* Writes the matrix in compressed rows, the form of SciPy's csr_array((data, indices, indptr)). */
int write_json(FILE *file, const struct contents *what) {
    const fibrad_factors *matrix = &what->factors->matrix;
    const uint64_t entries = matrix->start[matrix->n];
    const uint32_t walls = what->walls ? what->walls->count : 0;
    char name[WALL_NAME];
    json_begin(file, what, what->grey ? "exchange factors" : "view factors");
    fputs(",\"indptr\":[0", file);
    for (uint32_t i = 1; i <= matrix->n; ++i) fprintf(file, ",%" PRIu64, matrix->start[i]);
    fputs("],\"indices\":[", file);
    for (uint64_t k = 0; k < entries && !interrupt_status(); ++k) {
        if (k > 0) putc(',', file);
        json_whole(file, matrix->col[k]);
    }
    putc(']', file);
    json_reals(file, ",", "data", matrix->f, entries, 1, NULL);
    json_reals(file, ",", "escaped", matrix->escaped, matrix->n, 1, what->wanted);
    json_reals(file, ",", "beyond", matrix->beyond, matrix->n, 1, what->wanted);
    json_reals(file, ",", "error", matrix->error, matrix->n, 1, what->wanted);
    if (what->grey && what->grey->node_emissivity)
        json_reals(file, ",", "node_emissivity", what->grey->node_emissivity, matrix->n, 1, NULL);
    for (uint32_t k = 0; k < walls; ++k)
        json_reals(file, k > 0 ? "," : ",\"walls\":{", contents_wall(what, k, name), matrix->wall + k, matrix->n, walls,
                   what->wanted);
    if (walls > 0) putc('}', file);
    if (walls > 0 && matrix->wall_wall) json_wall_rows(file, what);
    fputs("}\n", file);
    return interrupt_status();
}

static void json_column(FILE *file, const struct heat_column *column, uint32_t n) {
    fprintf(file, ",\"%s\":[", column->name);
    for (uint32_t i = 0; i < n && !interrupt_status(); ++i) {
        if (i > 0) putc(',', file);
        text_json_real(file, heat_value(column, i));
    }
    putc(']', file);
}

int write_heat_json(FILE *file, const struct contents *all) {
    const struct contents table = contents_table(all), *what = &table;
    const uint32_t walls = what->walls ? what->walls->count : 0;
    struct heat_column column[HEAT_COLUMNS];
    char wall[WALL_NAME];
    json_begin(file, what, "heat");
    heat_columns(what, column);
    for (int k = 0; k < HEAT_COLUMNS; ++k)
        if (column[k].value) json_column(file, &column[k], what->bed->n);
    for (int64_t k = -1; what->walls && k <= walls; ++k) {
        double value[HEAT_COLUMNS];
        const char *name = heat_outside(what, k, wall, value);
        if (k == walls && walls > 0) putc('}', file);
        if (!name) continue;
        fprintf(file, "%s\"%s\":{\"T_K\":", k == 0 && walls > 0 ? ",\"walls\":{" : ",", name);
        text_json_real(file, value[HEAT_TEMPERATURE]);
        for (int c = HEAT_POWER; c < HEAT_COLUMNS; ++c)
            if ((c < HEAT_INSIDE || c >= HEAT_PARTS) && column[c].value) json_entry(file, column[c].name, value[c]);
        putc('}', file);
    }
    fputs("}\n", file);
    return interrupt_status();
}

static void json_plates(FILE *file, const struct conduction_plates *plates) {
    static const char *const names[] = {"F_E_steady", "k_total_W_mK", "k_radiation_W_mK", "k_conduction_W_mK"};
    const struct conduction_value *const of[] = {&plates->factor, &plates->both, &plates->radiation,
                                                 &plates->conduction};
    char error[40];
    if (plates->spheres == 0) return;
    for (int k = 0; k < (plates->touches ? 4 : 1); ++k) {
        snprintf(error, sizeof error, "%s_error", names[k]);
        json_entry(file, names[k], of[k]->k);
        json_entry(file, error, of[k]->error);
    }
}

int write_conduction_json(FILE *file, const struct contents *what) {
    const struct conduction *conduction = what->conduction;
    const char *comma = "";
    json_frame(file, what, "conduction");
    if (!isnan(conduction->temperature)) json_entry(file, "T_K", conduction->temperature);
    if (conduction->k_star.spheres > 0) {
        json_entry(file, "k_star", k_star_mean(&conduction->k_star));
        json_entry(file, "k_star_min", conduction->k_star.least);
        json_entry(file, "k_star_max", conduction->k_star.largest);
    }
    fputs(",\"axes\":[", file);
    for (int axis = 0; axis < 3; ++axis) {
        if (!conduction_wants(conduction, axis)) continue;
        const char *doubt = conduction_doubt(conduction, axis);
        fprintf(file, "%s{\"axis\":\"%c\",\"reliable\":%s", comma, 'x' + axis, doubt ? "false" : "true");
        if (doubt) fprintf(file, ",\"warning\":\"%s\"", doubt);
        json_entry(file, "F_E", conduction->factor[axis]);
        json_entry(file, "F_E_error", conduction->error[axis]);
        comma = ",";
        if (!isnan(conduction->temperature)) {
            json_entry(file, "k_W_mK", conduction->k[axis]);
            json_entry(file, "k_W_mK_error", conduction->k_error[axis]);
        }
        json_plates(file, &conduction->plates[axis]);
        putc('}', file);
    }
    fputs("]}\n", file);
    return STATUS_OK;
}
