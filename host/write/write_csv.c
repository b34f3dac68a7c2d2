/* write_csv.c - comma-separated values: i,j,F or i,j,D of a matrix, i,T_K,q_W,... of heat, F_E and k of conduction.
 * SPDX-License-Identifier: MIT
 *
 * Numbers below 0 are not spheres, and the column wall has their names: -1 is the surroundings, -2, -3 ... are walls,
 * and the next number is `beyond`. */
#include <gsl/gsl_math.h>
#include <limits.h>
#include <math.h>
#include <string.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "text/text.h"
#include "write/write.h"

enum { SURROUNDINGS = -1, FIRST_WALL = -2 };

/* The line that is being written. */
struct csv {
    FILE *file;
    const struct contents *what;
    bool named;     /* the file has a column wall */
    size_t columns; /* length of the columns file, frame, timestep and time_s, with which all lines begin */
    char line[2 * PATH_MAX + 16 * TEXT_NUMBER];
};

/* Puts a text, in quotes if it has commas or quotes. */
static char *put_text(char *to, const char *text) {
    const bool quoted = strpbrk(text, ",\"\r\n");
    if (quoted) *to++ = '"';
    for (int k = 0; k < PATH_MAX && text[k]; ++k) {
        if (text[k] == '"') *to++ = '"';
        *to++ = text[k];
    }
    if (quoted) *to++ = '"';
    return to;
}

static char *put_comma(char *to) {
    *to = ',';
    return to + 1;
}

/* Begins the lines of a frame. If the file is empty (first), writes the header. names: of the columns. */
static void begin_csv(struct csv *csv, FILE *file, const struct contents *what, const char *names, bool first) {
    const struct bed *bed = what->bed;
    char *at = csv->line;
    csv->file = file;
    csv->what = what;
    if (first)
        fprintf(file, "%s%s%s%s%s\n", what->file ? "file," : "", what->series ? "frame,timestep," : "",
                what->time ? "time_s," : "", names, csv->named ? ",body" : "");
    if (what->file) at = put_comma(put_text(at, what->file));
    if (what->series) {
        at = put_comma(text_whole(at, bed->frame));
        at = put_comma(bed->timestep < 0 ? at : text_whole(at, bed->timestep));
    }
    if (what->time) at = put_comma(text_real(at, *what->time));
    csv->columns = (size_t)(at - csv->line);
}

static void end_line(struct csv *csv, char *at, const char *wall) {
    if (csv->named) at = put_comma(at);
    for (; csv->named && *wall; ++wall) *at++ = *wall;
    *at++ = '\n';
    fwrite(csv->line, 1, (size_t)(at - csv->line), csv->file);
}

static void write_entry(struct csv *csv, int64_t i, int64_t j, double f, const char *wall) {
    if (!(f > 0)) return;
    char *at = put_comma(text_whole(csv->line + csv->columns, i));
    at = put_comma(text_whole(at, j));
    end_line(csv, text_real(at, f), wall);
}

static double wall_factor(const struct contents *what, uint32_t i, uint32_t wall) {
    return what->factors->matrix.wall[(size_t)i * what->walls->count + wall];
}

static void write_outside(struct csv *csv, uint32_t i) {
    const struct contents *what = csv->what;
    const uint32_t walls = what->walls->count;
    const int64_t row = bed_name(what->bed, i);
    char name[WALL_NAME];
    write_entry(csv, row, SURROUNDINGS, what->factors->matrix.escaped[i], "surroundings");
    for (uint32_t k = 0; k < walls; ++k)
        write_entry(csv, row, FIRST_WALL - (int64_t)k, wall_factor(what, i, k), contents_wall(what, k, name));
    write_entry(csv, row, FIRST_WALL - (int64_t)walls, what->factors->matrix.beyond[i], "beyond");
}

/* Writes the factors from a wall to walls and surroundings. The column wall has both names. */
static void write_wall_row(struct csv *csv, uint32_t k) {
    const struct contents *what = csv->what;
    const fibrad_factors *matrix = &what->factors->matrix;
    const uint32_t walls = what->walls->count;
    char from[WALL_NAME], to[WALL_NAME], both[2 * WALL_NAME + 16];
    const char *name = contents_wall(what, k, from);
    if (!matrix->wall_wall) return;
    for (uint32_t j = 0; j <= walls; ++j) {
        snprintf(both, sizeof both, "%s:%s", name, j < walls ? contents_wall(what, j, to) : "surroundings");
        write_entry(csv, FIRST_WALL - (int64_t)k, j < walls ? FIRST_WALL - (int64_t)j : SURROUNDINGS,
                    j < walls ? matrix->wall_wall[(size_t)k * walls + j] : matrix->wall_escaped[k], both);
    }
}

/* Writes the rows of walls of finite area. Factors to spheres follow from reciprocity. */
static int write_walls(struct csv *csv) {
    const struct contents *what = csv->what;
    const struct bed *bed = what->bed;
    const double *emissivity = what->grey ? what->grey->emissivity : NULL;
    char name[WALL_NAME];
    if (what->grey && what->grey->node_emissivity) emissivity = what->grey->node_emissivity;
    for (uint32_t k = 0; k < what->walls->count; ++k) {
        if (interrupt_status()) return interrupt_status();
        const double weight = what->factors->wall_area[k] * (what->grey ? what->grey->wall_emissivity[k] : 1);
        if (!(weight > 0 && weight < INFINITY)) continue;
        for (uint32_t j = 0; j < bed->n; ++j)
            write_entry(csv, FIRST_WALL - (int64_t)k, bed_name(bed, j),
                        4 * M_PI * bed->r[j] * bed->r[j] * (emissivity ? emissivity[j] : 1) * wall_factor(what, j, k) /
                            weight,
                        contents_wall(what, k, name));
        write_wall_row(csv, k);
    }
    return STATUS_OK;
}

int write_csv(FILE *file, const struct contents *what, bool first) {
    const fibrad_factors *matrix = &what->factors->matrix;
    struct csv csv = {.named = what->walls};
    begin_csv(&csv, file, what, what->grey ? "i,j,D" : "i,j,F", first);
    for (uint32_t i = 0; i < matrix->n; ++i) {
        if (interrupt_status()) return interrupt_status();
        for (uint64_t k = matrix->start[i]; k < matrix->start[i + 1]; ++k)
            write_entry(&csv, bed_name(what->bed, i), bed_name(what->bed, matrix->col[k]), matrix->f[k], "");
        if (csv.named) write_outside(&csv, i);
    }
    return csv.named ? write_walls(&csv) : STATUS_OK;
}

/* Puts a number. NaN: puts nothing. */
static char *put_error(char *to, double error) { return isnan(error) ? to : text_real(to, error); }

/* Puts the columns of a sphere that conducts. i = UINT32_MAX: the line belongs to a wall or the surroundings. */
static char *put_inside(char *at, const struct contents *what, uint32_t i) {
    for (size_t k = 0; k < INSIDE_COLUMNS && what->result->least_temperature; ++k) {
        at = put_comma(at);
        if (i < UINT32_MAX) at = put_error(at, contents_inside(what, k)[i]);
    }
    return at;
}

/* i: index of a sphere, or UINT32_MAX. light[2]: light from outside that is absorbed, first and in all. conducted: part
 * of the power. */
static void write_power(struct csv *csv, int64_t name, uint32_t i, const char *wall, double temperature, double power,
                        double power_error, double temperature_error, const double light[2], double conducted) {
    char *at = put_comma(text_whole(csv->line + csv->columns, name));
    at = put_comma(text_real(at, temperature));
    at = put_comma(text_real(at, power));
    at = put_comma(put_error(at, power_error));
    at = put_inside(put_error(at, temperature_error), csv->what, i);
    for (int k = 0; k < 2 && csv->what->light; ++k) at = text_real(put_comma(at), light[k]);
    if (csv->what->result->conducted) at = text_real(put_comma(at), power - conducted);
    if (csv->what->result->conducted) at = text_real(put_comma(at), conducted);
    end_line(csv, at, wall);
}

int write_heat_csv(FILE *file, const struct contents *what, bool first) {
    const double surroundings = what->sources->surroundings;
    const fibrad_heat_result *result = what->result;
    struct csv csv = {.named = true};
    char name[WALL_NAME];
    const fibrad_light_result *light = what->light;
    double of_light[2] = {0, 0};
    char columns[200];
    snprintf(columns, sizeof columns, "i,T_K,q_W,q_error_W,T_error_K%s%s%s",
             result->least_temperature ? INSIDE_HEADER : "", light ? ",absorbed_first_W,absorbed_W" : "",
             result->conducted ? ",q_radiation_W,q_conduction_W" : "");
    begin_csv(&csv, file, what, columns, first);
    for (uint32_t i = 0; i < what->bed->n; ++i) {
        if (interrupt_status()) return interrupt_status();
        if (light) of_light[0] = light->absorbed_first[i], of_light[1] = light->absorbed[i];
        write_power(&csv, bed_name(what->bed, i), i, "", result->temperature[i], result->power[i],
                    result->power_error[i], result->temperature_error[i], of_light,
                    result->conducted ? result->conducted[i] : 0);
    }
    if (!what->walls) return STATUS_OK;
    if (light) of_light[0] = light->transmitted, of_light[1] = light->transmitted + light->reflected;
    if (!isnan(surroundings))
        write_power(&csv, SURROUNDINGS, UINT32_MAX, "surroundings", surroundings, result->surroundings_power,
                    result->surroundings_error, 0, of_light, 0);
    for (uint32_t k = 0; k < what->walls->count; ++k) {
        if (light) of_light[0] = light->wall_absorbed_first[k], of_light[1] = light->wall_absorbed[k];
        write_power(&csv, FIRST_WALL - (int64_t)k, UINT32_MAX, contents_wall(what, k, name),
                    result->wall_temperature[k], result->wall_power[k], result->wall_error[k],
                    result->wall_temperature_error[k], of_light, result->conducted ? result->wall_conducted[k] : 0);
    }
    return STATUS_OK;
}

/* The conductivities of a bed with contacts along an axis; empty if they were not computed. */
static char *put_total(char *at, const struct conduction_plates *plates) {
    const struct conduction_value *const of[] = {&plates->both, &plates->radiation, &plates->conduction};
    for (int k = 0; k < 3; ++k) {
        at = put_error(put_comma(at), plates->touches ? of[k]->k : NAN);
        at = put_error(put_comma(at), plates->touches ? of[k]->error : NAN);
    }
    return at;
}

#define TOTAL_COLUMNS                                                                                                  \
    ",k_total_W_mK,k_total_W_mK_error,k_radiation_W_mK,k_radiation_W_mK_error,k_conduction_W_mK,"                      \
    "k_conduction_W_mK_error"
#define CONDUCTION_COLUMNS                                                                                             \
    "axis,F_E,F_E_error,k_W_mK,k_W_mK_error,reliable,F_E_steady,F_E_steady_error,k_star,T_K,warning"

int write_conduction_csv(FILE *file, const struct contents *what, bool first) {
    const struct conduction *conduction = what->conduction;
    const bool contacts = conduction_contacts(conduction);
    struct csv csv = {0};
    begin_csv(&csv, file, what, contacts ? CONDUCTION_COLUMNS TOTAL_COLUMNS : CONDUCTION_COLUMNS, first);
    for (int axis = 0; axis < 3; ++axis) {
        if (!conduction_wants(conduction, axis)) continue;
        char *at = csv.line + csv.columns;
        *at++ = (char)('x' + axis);
        at = text_real(put_comma(at), conduction->factor[axis]);
        at = text_real(put_comma(at), conduction->error[axis]);
        at = put_comma(at);
        if (!isnan(conduction->temperature)) at = text_real(at, conduction->k[axis]);
        at = put_comma(at);
        if (!isnan(conduction->temperature)) at = text_real(at, conduction->k_error[axis]);
        at = put_comma(at);
        *at++ = conduction_flights(conduction, axis) == FLIGHTS_SETTLED ? '1' : '0';
        const struct conduction_plates *plates = &conduction->plates[axis];
        at = put_error(put_comma(at), plates->spheres > 0 ? plates->factor.k : NAN);
        at = put_error(put_comma(at), plates->spheres > 0 ? plates->factor.error : NAN);
        at = put_error(put_comma(at), k_star_mean(&conduction->k_star));
        at = put_error(put_comma(at), conduction->temperature);
        const char *doubt = conduction_doubt(conduction, axis);
        at = put_text(put_comma(at), doubt ? doubt : "");
        if (contacts) at = put_total(at, plates);
        end_line(&csv, at, "");
    }
    return STATUS_OK;
}
