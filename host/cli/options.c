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
#include "cli/spelling.h"

/* A walk along the arguments behind the name of a command. */
struct walk {
    const char *command;
    const struct option *table;
    char *request;
    int argc, at;
    char **argv;
    bool plain; /* `--` has come: no options follow */
};

static bool help_all;

int option_help(const char *text, void *request) {
    (void)request;
    if (text && strcmp(text, "all") != 0) return OPTION_LEFT;
    help_all = text != NULL;
    return STATUS_HELP;
}

/* Puts the argument of an option into its field. */
static int put_argument(const struct walk *walk, const struct option *option, const char *text) {
    void *field = walk->request + option->field;
    char what[40];
    snprintf(what, sizeof what, "--%s", option->name);
    switch (option->kind) {
    case OPTION_FLAG:
        *(bool *)field = true;
        return STATUS_OK;
    case OPTION_PATH:
        if (*(const char **)field) return message(STATUS_USAGE, "%s is given twice", what);
        *(const char **)field = text;
        return STATUS_OK;
    case OPTION_TEXT:
        *(const char **)field = text;
        return STATUS_OK;
    case OPTION_NUMBER:
        return options_number(what, text, option->low, option->high, field);
    case OPTION_COUNT:
        return options_count(what, text, (uint32_t)option->low, (uint32_t)option->high, field);
    case OPTION_WHOLE:
        return options_whole(what, text, (uint64_t)option->low,
                             option->high < INFINITY ? (uint64_t)option->high : UINT64_MAX, field);
    default:
        return option->take(text, field);
    }
}

/* Takes an option. inline_value: the text behind = or behind the letter; NULL: the argument is the next one. */
static int take_option(struct walk *walk, const struct option *option, const char *inline_value) {
    const char *next = walk->at < walk->argc ? walk->argv[walk->at] : NULL;
    if (!option->argument && inline_value) return message(STATUS_USAGE, "--%s takes no argument", option->name);
    if (option->kind == OPTION_OPTIONAL && next) {
        const int status = put_argument(walk, option, next);
        walk->at += status != OPTION_LEFT;
        if (status != OPTION_LEFT) return status;
    }
    if (!option->argument || inline_value) return put_argument(walk, option, inline_value);
    if (!next) return message(STATUS_USAGE, "--%s needs an argument: %s", option->name, option->argument);
    ++walk->at;
    return put_argument(walk, option, next);
}

static bool is_positional(const char *text) {
    return text[0] != '-' || text[1] == 0 || text[1] == '.' || isdigit((unsigned char)text[1]);
}

/* The option of a name of `length` characters. NULL: there is none. */
static const struct option *find_option(const struct option *table, const char *name, size_t length) {
    for (; table->name; ++table)
        if (strlen(table->name) == length && strncmp(table->name, name, length) == 0) return table;
    return NULL;
}

/* Options that have another form since 0.3.0, or are of another command. */
static const struct {
    const char *old, *now;
} renamed[] = {{"wall-temperature", "--wall-temperature zmin=1200 is now --wall zmin:temperature=1200"},
               {"wall-power", "--wall-power zmin=500 is now --wall zmin:power=500"},
               {"wall-emissivity", "--wall-emissivity zmin=0.8 is now --wall zmin:emissivity=0.8"},
               {"wall-absorptivity", "--wall-absorptivity zmin=0.8 is now --wall zmin:absorptivity=0.8"},
               {"every", "--every 60 is now --times every:60"},
               {"model", "--model is not needed any more: powers at one time are by patches, in time by factors that "
                         "patches correct"},
               {"members",
                "--members is of fibrad heat --clump: rows of single members hold what passes inside the clump, "
                "and only their sums are factors"},
               {"nf", "--method surface and --nf are of fibrad pair and fibrad reproduce"}};

static int unknown_option(const struct walk *walk, const char *text, size_t length) {
    enum { OPTIONS_MOST = 80 };
    const char *names[OPTIONS_MOST], *name = text + strspn(text, "-");
    char hint[HINT_ROOM];
    size_t n = 0;
    for (const struct option *option = walk->table; option->name && n < OPTIONS_MOST; ++option)
        names[n++] = option->name;
    for (size_t k = 0; k < sizeof renamed / sizeof *renamed; ++k)
        if (strcspn(name, "=") == strlen(renamed[k].old) && strncmp(name, renamed[k].old, strlen(renamed[k].old)) == 0)
            return message(STATUS_USAGE, "%s", renamed[k].now);
    name_hint(hint, "--", name, strcspn(name, "="), names, n);
    return message(STATUS_USAGE, "unknown option %.*s%s see fibrad %s --help", (int)length, text, hint, walk->command);
}

static int take_next(struct walk *walk) {
    const char *text = walk->argv[walk->at++];
    const struct option *option = NULL;
    size_t length = 2;
    if (!walk->plain && strcmp(text, "--") == 0) {
        walk->plain = true;
        return STATUS_OK;
    }
    if (walk->plain || is_positional(text)) {
        option = find_option(walk->table, "", 0);
        return option ? put_argument(walk, option, text)
                      : message(STATUS_USAGE, "'%.40s': %s takes options only", text, walk->command);
    }
    if (text[1] != '-') {
        for (option = walk->table; option->name && option->letter != text[1];) ++option;
        if (option->name) return take_option(walk, option, text[2] ? text + 2 : NULL);
    } else {
        length += strcspn(text + 2, "=");
        option = length > 2 ? find_option(walk->table, text + 2, length - 2) : NULL;
        if (option) return take_option(walk, option, text[length] ? text + length + 1 : NULL);
    }
    return unknown_option(walk, text, length);
}

int options_read(const char *command, const struct option *table, int argc, char **argv, void *request) {
    struct walk walk = {.command = command, .table = table, .request = request, .argc = argc, .argv = argv};
    int status = STATUS_OK;
    while (!status && walk.at < argc) status = take_next(&walk);
    return status;
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

/* Prints the part of a help up to the first ; and the default. */
static void print_short(const char *help) {
    char text[400];
    const char *end = strchr(help, ';'), *standard = strrchr(help, '[');
    const bool more = end && standard > end && help[strlen(help) - 1] == ']';
    snprintf(text, sizeof text, "%.*s%s%s", end ? (int)(end - help) : 399, help, more ? " " : "", more ? standard : "");
    print_wrapped(text);
}

static void print_table(const struct option *table, bool whole) {
    for (; table->name && (whole || table->name[0] != '\n'); ++table) {
        char left[64];
        if (!table->help) continue;
        const char *argument = table->argument ? table->argument : "";
        if (table->letter)
            snprintf(left, sizeof left, "-%c, --%s %s", table->letter, table->name, argument);
        else
            snprintf(left, sizeof left, "--%s %s", table->name, argument);
        printf("  %-26s ", left);
        (whole ? print_wrapped : print_short)(table->help);
    }
}

void options_print(const struct option *table) { print_table(table, true); }

void options_help(const char *command, const char *begin, const struct option *table, const char *const *more,
                  const char *end) {
    printf("%s\n", begin);
    print_table(table, help_all);
    for (; help_all && *more; ++more) printf("\n%s", *more);
    if (!help_all) printf("\nAll options, and what files and walls may be: fibrad %s --help all\n", command);
    printf("\n%s", end);
}

static int read_number(const char *what, const char *text, const char *hint, double low, double high, double *value) {
    char *end;
    *value = strtod(text, &end);
    if (end == text || *end || !isfinite(*value))
        return message(STATUS_USAGE, "%s: '%.40s' is not a number%s", what, text, hint);
    if (*value < low || *value > high)
        return message(STATUS_USAGE, "%s: %.40s is not within %g and %g", what, text, low, high);
    return STATUS_OK;
}

int options_number(const char *what, const char *text, double low, double high, double *value) {
    return read_number(what, text, "", low, high, value);
}

int options_number_or_table(const char *what, const char *text, double low, double high, double *value) {
    char hint[HINT_ROOM];
    return read_number(what, text, table_hint(hint, "", text), low, high, value);
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

int option_points(const char *text, void *points) {
    if (strcmp(text, "64") != 0 && strcmp(text, "128") != 0 && strcmp(text, "256") != 0)
        return message(STATUS_USAGE, "--points: '%.40s' is not built in; 64, 128 and 256 are", text);
    *(uint32_t *)points = (uint32_t)strtoul(text, NULL, 10);
    return STATUS_OK;
}
