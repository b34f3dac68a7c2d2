/* column_option.c - options about the columns of a file: --columns, --only, --skip. SPDX-License-Identifier: MIT */
#include "frames/column_option.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cli/message.h"

/* Keeps a copy of a text. */
static int keep_text(struct column_options *options, const char *text, char **copy) {
    bool good = true;
    options->text = memory_resized(options->text, (options->texts + 1) * sizeof *options->text, &good);
    *copy = good ? strdup(text) : NULL;
    if (!*copy) return message_memory();
    options->text[options->texts++] = *copy;
    return STATUS_OK;
}

static bool is_radius(const char *known) {
    static const char *const radii[] = {"r", "radius", "d", "diameter"};
    for (size_t k = 0; k < sizeof radii / sizeof *radii; ++k)
        if (strcasecmp(known, radii[k]) == 0) return true;
    return false;
}

/* Takes an item KNOWN=NAME of the list. */
static int take_name(struct column_options *options, char *item) {
    char *name = strchr(item, '=');
    if (!name || name == item || !name[1])
        return message(STATUS_USAGE, "--columns: '%.60s' is not x=NAME, d=NAME or the like", item);
    *name++ = 0;
    for (size_t k = 0; k < options->names; ++k)
        if (strcasecmp(options->name[k].known, item) == 0 || (is_radius(options->name[k].known) && is_radius(item)))
            return message(STATUS_USAGE, "--columns: %.40s and %.40s are one thing, and have two columns",
                           options->name[k].known, item);
    bool good = true;
    options->name = memory_resized(options->name, (options->names + 1) * sizeof *options->name, &good);
    if (!good) return message_memory();
    options->name[options->names++] = (struct column_name){item, name};
    return STATUS_OK;
}

int columns_option(const char *text, void *column_options) {
    char *item;
    int status = keep_text(column_options, text, &item);
    for (char *end; !status && item; item = end) {
        end = strchr(item, ',');
        if (end) *end++ = 0;
        status = take_name(column_options, item);
    }
    return status;
}

int columns_check(const struct column_options *options) {
    for (size_t k = 0; k < options->names; ++k)
        if (is_radius(options->name[k].known))
            return message(STATUS_USAGE, "--radius and --columns %s=%.40s both give radii", options->name[k].known,
                           options->name[k].name);
    return STATUS_OK;
}

/* Takes COLUMN=VALUE. */
static int take_rule(struct column_options *options, const char *option, const char *text, bool skip) {
    char *column;
    int status = keep_text(options, text, &column);
    if (status) return status;
    char *value = strchr(column, '=');
    if (!value || value == column) return message(STATUS_USAGE, "%s: '%.60s' is not COLUMN=VALUE", option, text);
    *value++ = 0;
    bool good = true;
    options->rule = memory_resized(options->rule, (options->rules + 1) * sizeof *options->rule, &good);
    if (!good) return message_memory();
    options->rule[options->rules++] = (struct row_rule){column, value, skip};
    return STATUS_OK;
}

int only_option(const char *text, void *column_options) { return take_rule(column_options, "--only", text, false); }

int skip_option(const char *text, void *column_options) { return take_rule(column_options, "--skip", text, true); }

void column_options_free(struct column_options *options) {
    for (size_t k = 0; k < options->texts; ++k) free(options->text[k]);
    free(options->text);
    free(options->name);
    free(options->rule);
    *options = (struct column_options){0};
}
