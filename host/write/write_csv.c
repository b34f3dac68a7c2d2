/* write_csv.c - comma-separated values: i,j,F or i,j,D of a matrix, i,T_K,q_W,... of heat, F_E and k of conduction.
 * SPDX-License-Identifier: MIT
 *
 * Numbers below 0 are not spheres, and the column wall has their names: -1 is the surroundings, -2, -3 ... are walls,
 * and the next number is `beyond`. */
#include <limits.h>
#include <math.h>
#include <string.h>

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

/* Begins the lines of a frame. If the file is empty, writes the header. names: of the columns. */
static void begin_csv(struct csv *csv, FILE *file, const struct contents *what, const char *names) {
    const struct bed *bed = what->bed;
    char *at = csv->line;
    csv->file = file;
    csv->what = what;
    if (what->first)
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

int write_csv(FILE *file, const struct contents *what) {
    const fibrad_factors *matrix = &what->factors->matrix;
    struct csv csv = {.named = what->walls};
    begin_csv(&csv, file, what, what->grey ? "i,j,D" : "i,j,F");
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

/* Writes a line of heat. Errors that are not known and columns that walls do not have are empty. */
static void write_power(struct csv *csv, int64_t name, const char *wall, const struct heat_column *column,
                        const double value[HEAT_COLUMNS]) {
    char *at = text_whole(csv->line + csv->columns, name);
    for (int k = 0; k < HEAT_COLUMNS; ++k) {
        if (!column[k].value) continue;
        at = put_comma(at);
        at = (k > HEAT_POWER && k < HEAT_LIGHT) || k == HEAT_AREA ? put_error(at, value[k]) : text_real(at, value[k]);
    }
    end_line(csv, at, wall);
}

int write_heat_csv(FILE *file, const struct contents *all) {
    const struct contents table = contents_table(all), *what = &table;
    struct csv csv = {.named = true};
    struct heat_column column[HEAT_COLUMNS];
    char wall[WALL_NAME], names[220] = "i";
    double value[HEAT_COLUMNS] = {0};
    heat_columns(what, column);
    for (int k = 0; k < HEAT_COLUMNS; ++k)
        if (column[k].value) strcat(strcat(names, ","), column[k].name);
    begin_csv(&csv, file, what, names);
    for (uint32_t i = 0; i < what->bed->n; ++i) {
        if (interrupt_status()) return interrupt_status();
        for (int k = 0; k < HEAT_COLUMNS; ++k)
            if (column[k].value) value[k] = heat_value(&column[k], i);
        write_power(&csv, bed_name(what->bed, i), "", column, value);
    }
    for (int64_t k = -1; what->walls && k <= what->walls->count; ++k) {
        const char *name = heat_outside(what, k, wall, value);
        if (name) write_power(&csv, FIRST_WALL - k, name, column, value);
    }
    return STATUS_OK;
}

#define TOTAL_COLUMNS                                                                                                  \
    ",k_total_W_mK,k_total_W_mK_error,k_radiation_W_mK,k_radiation_W_mK_error,k_conduction_W_mK,"                      \
    "k_conduction_W_mK_error"
#define CONDUCTION_COLUMNS                                                                                             \
    "axis,F_E,F_E_error,k_W_mK,k_W_mK_error,reliable,F_E_steady,F_E_steady_error,k_star,T_K,warning"

int write_conduction_csv(FILE *file, const struct contents *what) {
    const struct conduction *conduction = what->conduction;
    const bool contacts = conduction_contacts(conduction), hot = !isnan(conduction->temperature);
    struct csv csv = {0};
    begin_csv(&csv, file, what, contacts ? CONDUCTION_COLUMNS TOTAL_COLUMNS : CONDUCTION_COLUMNS);
    for (int axis = 0; axis < 3; ++axis) {
        if (!conduction_wants(conduction, axis)) continue;
        const struct conduction_plates *plates = &conduction->plates[axis];
        const struct conduction_value *const total[] = {&plates->both, &plates->radiation, &plates->conduction};
        const bool steady = plates->spheres > 0;
        const char *doubt = conduction_doubt(conduction, axis);
        char *at = csv.line + csv.columns;
        *at++ = (char)('x' + axis);
        at = text_real(put_comma(at), conduction->factor[axis]);
        at = text_real(put_comma(at), conduction->error[axis]);
        at = hot ? text_real(put_comma(at), conduction->k[axis]) : put_comma(at);
        at = put_comma(hot ? text_real(put_comma(at), conduction->k_error[axis]) : put_comma(at));
        *at++ = conduction_flights(conduction, axis) == FLIGHTS_SETTLED ? '1' : '0';
        at = put_error(put_comma(at), steady ? plates->factor.k : NAN);
        at = put_error(put_comma(at), steady ? plates->factor.error : NAN);
        at = put_error(put_comma(at), k_star_mean(&conduction->k_star));
        at = put_error(put_comma(at), conduction->temperature);
        at = put_text(put_comma(at), doubt ? doubt : "");
        for (int k = 0; k < 3 && contacts; ++k) { /* empty if they were not computed */
            at = put_error(put_comma(at), plates->touches ? total[k]->k : NAN);
            at = put_error(put_comma(at), plates->touches ? total[k]->error : NAN);
        }
        end_line(&csv, at, "");
    }
    return STATUS_OK;
}
