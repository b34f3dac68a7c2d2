/* property_option.c - radii, emissivities and temperatures of spheres and walls, from options and columns of the file.
 * SPDX-License-Identifier: MIT */
#include "bed/property_option.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bed/units.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/spelling.h"

/* Reads the table whose path is the next item of a list. Moves *text behind the item. */
static int take_table(const char *what, const char **text, const struct curve_axes *axes, double low, double high,
                      struct curve *curve) {
    const size_t length = strcspn(*text, ",");
    char *path = strndup(*text, length);
    *text += length;
    const int status = path ? curve_read(path, what, axes, low, high, curve) : message_memory();
    free(path);
    return status;
}

/* Reads a number, or @TABLE if quantity->curves. Moves *text behind the item. */
static int take_value(const char *what, const char **text, double low, double high, struct quantity *quantity,
                      struct curve *curve, double *value) {
    char *end, table[HINT_ROOM];
    if (!quantity->curves || **text != '@') {
        *value = strtod(*text, &end);
        if (end == *text || (*end && *end != ','))
            return message(STATUS_USAGE, "%s: '%.60s' is not a list like 1:0.5,2:0.8%s", what, *text,
                           table_hint(table, "", quantity->curves ? *text : ""));
        *text = end;
        if (*value >= low && *value <= high) return STATUS_OK;
        return message(STATUS_USAGE, "%s: %g is not within %g and %g", what, *value, low, high);
    }
    ++*text;
    const int status = take_table(what + strlen("--"), text, quantity->curves, low, high, curve);
    if (!status) *value = curve->y[curve->n / 2];
    return status;
}

/* Reads a list TYPE:VALUE,TYPE:VALUE ... */
static int take_types(const char *what, const char *text, double low, double high, struct quantity *quantity) {
    quantity->column = "type";
    for (;;) {
        const int k = quantity->types++;
        char *end;
        if (k == QUANTITY_TYPES_MAX) return message(STATUS_USAGE, "%s: more than %d types", what, QUANTITY_TYPES_MAX);
        quantity->type[k] = strtod(text, &end);
        if (end == text || *end != ':')
            return message(STATUS_USAGE, "%s: '%.60s' is not a list like 1:0.5,2:0.8", what, text);
        text = end + 1;
        const int status = take_value(what, &text, low, high, quantity, &quantity->curve[k], &quantity->of_type[k]);
        if (status) return status;
        for (int j = 0; j < k; ++j)
            if (quantity->type[j] == quantity->type[k])
                return message(STATUS_USAGE, "%s: type %g is named twice", what, quantity->type[k]);
        if (*text++ == 0) return STATUS_OK;
    }
}

static int take_quantity(const char *what, const char *text, double low, double high, const struct curve_axes *curves,
                         struct quantity *quantity) {
    quantity_free(quantity);
    *quantity = (struct quantity){.given = true, .curves = curves};
    const bool column = isalpha((unsigned char)*text) || *text == '_';
    if (curves && *text == '@') return take_value(what, &text, low, high, quantity, quantity->curve, &quantity->value);
    if (*text == '@') return message(STATUS_USAGE, "%s takes no table, as '%.60s' would be", what, text);
    if (!column && strchr(text, ':')) return take_types(what, text, low, high, quantity);
    if (!column) return (curves ? options_number_or_table : options_number)(what, text, low, high, &quantity->value);
    quantity->column = text;
    return STATUS_OK;
}

int quantity_option(const char *what, const char *text, double low, double high, struct quantity *quantity) {
    return take_quantity(what, text, low, high, NULL, quantity);
}

int table_option(const char *what, const char *text, const struct curve_axes *axes, double low, double high,
                 struct quantity *quantity) {
    return take_quantity(what, text, low, high, axes, quantity);
}

int emissivity_option(const char *text, void *quantity) {
    return quantity_option("--emissivity", text, 0, 1, quantity);
}

int emissivity_curves_option(const char *text, void *quantity) {
    static const struct curve_axes axes = {CURVE_AXIS_KELVINS, {"e eps epsilon emissivity", ""}};
    return table_option("--emissivity", text, &axes, 0, 1, quantity);
}

int temperature_option(const char *text, void *quantity) { /* --temperature-unit may follow */
    return quantity_option("--temperature", text, -KELVIN_OF_0_CELSIUS, TEMPERATURE_MAX, quantity);
}

void quantity_free(struct quantity *quantity) {
    for (int k = 0; k < QUANTITY_TYPES_MAX; ++k) curve_free(&quantity->curve[k]);
}

int quantity_item(const struct quantity *quantity, const struct bed *bed, uint32_t i) {
    int k = 0;
    if (quantity->types) {
        const double type = bed->extra[i * bed->extras + quantity->index];
        while (k < quantity->types - 1 && quantity->type[k] != type) ++k;
    }
    return k;
}

/* The table for sphere i. NULL: its value is a number. */
static const struct curve *curve_of_sphere(const struct quantity *quantity, const struct bed *bed, uint32_t i) {
    const struct curve *curve = &quantity->curve[quantity_item(quantity, bed, i)];
    return curve->n > 0 ? curve : NULL;
}

bool quantity_curves(const struct quantity *quantity) {
    for (int k = 0; k < QUANTITY_TYPES_MAX; ++k)
        if (quantity->curve[k].n > 0) return true;
    return false;
}

void quantity_follow(const struct quantity *quantity, const struct bed *bed, const double *temperature,
                     double *values) {
    for (uint32_t i = 0; i < bed->n; ++i) {
        const struct curve *curve = curve_of_sphere(quantity, bed, i);
        if (curve && !isnan(temperature[i])) values[i] = curve_at(curve, temperature[i]);
    }
}

#define EXCESS_LEAST 1e-3 /* [K] temperatures are found with rounding */

static void add_excess(const struct curve *curve, double temperature, struct table_excess *now) {
    if (!curve || isnan(temperature)) return;
    const double far = fmax(curve->x[0] - temperature, temperature - curve->x[curve->n - 1]);
    now->number += far > EXCESS_LEAST;
    now->kelvins = fmax(now->kelvins, far);
}

static void grow_excess(struct table_excess *excess, const struct table_excess *now) {
    if (now->number > excess->number) excess->number = now->number;
    excess->kelvins = fmax(excess->kelvins, now->kelvins);
}

void quantity_excess(const struct quantity *quantity, const struct bed *bed, const double *temperature,
                     struct table_excess *excess) {
    struct table_excess now = {0};
    for (uint32_t i = 0; i < bed->n; ++i) add_excess(curve_of_sphere(quantity, bed, i), temperature[i], &now);
    grow_excess(excess, &now);
}

void curve_excess(const struct curve *curve, uint32_t n, const double *temperature, struct table_excess *excess) {
    struct table_excess now = {0};
    for (uint32_t i = 0; i < n; ++i) add_excess(curve, temperature[i], &now);
    grow_excess(excess, &now);
}

/* The value of sphere i. NaN: the option was not given, or the list does not have the type of the sphere. */
static double value_of_sphere(const struct quantity *quantity, const struct bed *bed, uint32_t i) {
    if (!quantity->given) return NAN;
    if (!quantity->column) return quantity->value;
    const double found = bed->extra[i * bed->extras + quantity->index];
    if (!quantity->types) return found;
    for (int k = 0; k < quantity->types; ++k)
        if (quantity->type[k] == found) return quantity->of_type[k];
    return NAN;
}

int quantity_values(const struct quantity *quantity, const struct bed *bed, const char *file, const char *what,
                    double offset, double low, double high, double **values) {
    double *v = *values = malloc(bed->n * sizeof *v);
    if (!v) return message_memory();
    for (uint32_t i = 0; i < bed->n; ++i) {
        v[i] = value_of_sphere(quantity, bed, i) + offset;
        if ((v[i] >= low && v[i] <= high) || (quantity->some && isnan(v[i]))) continue;
        if (quantity->types && isnan(v[i]))
            return message_at(STATUS_INPUT, file, bed->line[i], "the list of the %s has no type %g", what,
                              bed->extra[i * bed->extras + quantity->index]);
        return message_at(STATUS_INPUT, file, bed->line[i], "the %s is %g; it must be within %g and %g", what, v[i],
                          low, high);
    }
    return STATUS_OK;
}

void quantity_report(const struct quantity *quantity, const char *key, struct report *report) {
    char column[60];
    if (quantity->given && !quantity->column && quantity->curve[0].n == 0)
        report_value(report, key, quantity->value, 6);
    if (quantity->given && !quantity->column && quantity->curve[0].n > 0) report_text(report, key, "table");
    if (quantity->column && !quantity->types) {
        snprintf(column, sizeof column, "column %.40s", quantity->column);
        report_text(report, key, column);
    }
    for (int k = 0; k < quantity->types; ++k) {
        const char *of_type = report_key(report, "%s_type_%g", key, quantity->type[k]);
        if (quantity->curve[k].n > 0)
            report_text(report, of_type, "table");
        else
            report_value(report, of_type, quantity->of_type[k], 6);
    }
}

void wall_values_report(const struct walls *walls, const double *values, const char *ending, int digits,
                        struct report *report) {
    for (uint32_t k = 0; k < walls->count; ++k)
        report_value(report, report_key(report, "wall_%s%s", wall_name(walls, k), ending), values[k], digits);
}
