/* options.c - command-line options by tables, numbers, help. SPDX-License-Identifier: MIT */
#include "cli/options.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

static int unknown_option(const struct options *options, const char *name, int length) {
    message(STATUS_USAGE, "unknown option %.*s; see fibrad %s --help", length, name, options->command);
    return OPTIONS_BAD;
}

/* Sets options->value to `inline_value`, the text behind = or behind the letter, or else to the next argument. */
static int take_argument(struct options *options, const struct option *option, const char *inline_value) {
    options->name = option->name;
    options->value = inline_value;
    if (!option->argument && inline_value) {
        message(STATUS_USAGE, "--%s takes no argument", option->name);
        return OPTIONS_BAD;
    }
    if (option->argument && !inline_value) {
        if (options->at == options->argc) {
            message(STATUS_USAGE, "--%s needs an argument: %s", option->name, option->argument);
            return OPTIONS_BAD;
        }
        options->value = options->argv[options->at++];
    }
    return option->key;
}

static bool is_positional(const char *text) {
    return text[0] != '-' || text[1] == 0 || text[1] == '.' || isdigit((unsigned char)text[1]);
}

int options_next(struct options *options) {
    if (options->at == options->argc) return OPTIONS_END;
    const char *text = options->argv[options->at++];
    if (!options->plain && strcmp(text, "--") == 0) {
        options->plain = true;
        return options_next(options);
    }
    if (options->plain || is_positional(text)) {
        options->value = text;
        return OPTIONS_POSITIONAL;
    }
    if (text[1] != '-') {
        for (const struct option *option = options->table; option->name; ++option)
            if (option->key == text[1]) return take_argument(options, option, text[2] ? text + 2 : NULL);
        return unknown_option(options, text, 2);
    }
    const size_t length = strcspn(text + 2, "=");
    for (const struct option *option = options->table; option->name; ++option)
        if (strlen(option->name) == length && strncmp(option->name, text + 2, length) == 0)
            return take_argument(options, option, text[2 + length] ? text + 3 + length : NULL);
    return unknown_option(options, text, (int)length + 2);
}

/* Prints a text in lines of at most HELP_WIDTH columns. The first line goes on at column HELP_TEXT; the others begin
 * there. */
enum { HELP_TEXT = 29, HELP_WIDTH = 100 };
static void print_wrapped(const char *text) {
    while (strlen(text) > HELP_WIDTH - HELP_TEXT) {
        size_t length = HELP_WIDTH - HELP_TEXT;
        while (length > 1 && text[length] != ' ') --length;
        printf("%.*s\n%*s", (int)length, text, HELP_TEXT, "");
        text += length + 1;
    }
    printf("%s\n", text);
}

void options_print(const struct option *table) {
    for (; table->name; ++table) {
        char left[64];
        if (!table->help) continue;
        if (table->key < KEY_LONG)
            snprintf(left, sizeof left, "-%c, --%s %s", table->key, table->name,
                     table->argument ? table->argument : "");
        else
            snprintf(left, sizeof left, "--%s %s", table->name, table->argument ? table->argument : "");
        printf("  %-26s ", left);
        print_wrapped(table->help);
    }
}

int options_number(const char *what, const char *text, double low, double high, double *value) {
    char *end;
    *value = strtod(text, &end);
    if (end == text || *end || !isfinite(*value))
        return message(STATUS_USAGE, "%s: '%.40s' is not a number", what, text);
    if (*value < low || *value > high)
        return message(STATUS_USAGE, "%s: %.40s is not within %g and %g", what, text, low, high);
    return STATUS_OK;
}

int options_whole(const char *what, const char *text, uint64_t low, uint64_t high, uint64_t *value) {
    char *end;
    errno = 0;
    *value = strtoull(text, &end, 10);
    if (!isdigit((unsigned char)*text) || *end || errno || *value < low || *value > high)
        return message(STATUS_USAGE, "%s: '%.40s' is not a whole number from %" PRIu64 " to %" PRIu64, what, text, low,
                       high);
    return STATUS_OK;
}

int options_count(const char *what, const char *text, uint32_t low, uint32_t high, uint32_t *value) {
    uint64_t whole;
    const int status = options_whole(what, text, low, high, &whole);
    if (!status) *value = (uint32_t)whole;
    return status;
}

int options_numbers(const char *what, const char *text, int capacity, double *values, int *count) {
    for (*count = 0; *count < capacity; ++*count) {
        char *end;
        values[*count] = strtod(text, &end);
        if (end == text || (*end && *end != ',') || !isfinite(values[*count]))
            return message(STATUS_USAGE, "%s: '%.40s' does not begin with a number", what, text);
        if (*end == 0) {
            ++*count;
            return STATUS_OK;
        }
        text = end + 1;
    }
    return message(STATUS_USAGE, "%s: more than %d numbers", what, capacity);
}

int options_file(const char *text, const char **file) {
    if (*file) return message(STATUS_USAGE, "one FILE is allowed, not also '%.60s'", text);
    *file = text;
    return STATUS_OK;
}

int options_threads(const char *text, int *threads) {
    uint32_t count = 0;
    const int status = options_count("--threads", text, 1, 1024, &count);
    *threads = (int)count;
    return status;
}

int options_method(const char *text, enum method *method) {
    static const char *const names[] = {"exact", "beam", "surface", "cast", "mc"};
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k)
        if (strcmp(text, names[k]) == 0) {
            *method = (enum method)k;
            return STATUS_OK;
        }
    return message(STATUS_USAGE, "--method: '%.40s' is not a method", text);
}

int options_beam(int key, const char *text, struct beam_options *beam) {
    switch (key) {
    case KEY_DIRECTIONS:
        return options_count("--directions", text, FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX, &beam->directions);
    case KEY_AREAS:
        if (strcmp(text, "exact") != 0 && strcmp(text, "points") != 0)
            return message(STATUS_USAGE, "--areas: '%.40s' is neither exact nor points", text);
        beam->areas = text;
        return STATUS_OK;
    default:
        if (strcmp(text, "64") != 0 && strcmp(text, "128") != 0 && strcmp(text, "256") != 0)
            return message(STATUS_USAGE, "--points: '%.40s' is not built in; 64, 128 and 256 are", text);
        beam->points = (uint32_t)strtoul(text, NULL, 10);
        return STATUS_OK;
    }
}

int options_beam_rule(const struct beam_options *beam, fibrad_beam_rule *rule) {
    const bool exact = beam->areas && strcmp(beam->areas, "exact") == 0;
    if (exact && beam->points) return message(STATUS_USAGE, "--points contradicts --areas exact");
    rule->directions = beam->directions ? beam->directions : FIBRAD_DIRECTIONS_DEFAULT;
    rule->points = beam->points;
    if (beam->areas && !exact && !beam->points) rule->points = 256;
    return STATUS_OK;
}

int options_cast(int key, const char *text, fibrad_cast_rule *rule) {
    if (key == KEY_SEED) return options_whole("--seed", text, 0, UINT64_MAX, &rule->seed);
    return options_count("--rays", text, 1, UINT32_MAX, &rule->rays);
}

int options_surface(int key, const char *text, fibrad_surface_rule *rule) {
    if (key == KEY_NO_CORRECTION) {
        rule->flags |= FIBRAD_SURFACE_NO_CORRECTION;
        return STATUS_OK;
    }
    const int status = options_count("--nf", text, 1, UINT32_MAX, &rule->nodes);
    char sizes[64] = "";
    int length = 0;
    for (uint32_t size = FIBRAD_NODES_MIN, next = 13, sum; size <= FIBRAD_NODES_MAX && !status;
         size = next, next = sum) {
        if (rule->nodes == size) return STATUS_OK;
        length += snprintf(sizes + length, sizeof sizes - (size_t)length, "%s%" PRIu32, length ? ", " : "", size);
        sum = size + next;
    }
    return status ? status : message(STATUS_USAGE, "--nf: %.40s is not built in; %s are", text, sizes);
}
