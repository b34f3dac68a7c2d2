/* options.h - command-line options by tables, numbers, help. SPDX-License-Identifier: MIT */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "fibrad.h"

/* What becomes of the argument of an option. */
enum option_kind {
    OPTION_FUNCTION, /* a function takes it */
    OPTION_OPTIONAL, /* likewise; the argument may be left out */
    OPTION_FLAG,     /* there is none: a bool becomes true */
    OPTION_TEXT,     /* a const char * */
    OPTION_PATH,     /* likewise, of a file to write: a second one is refused */
    OPTION_NUMBER,   /* a double from low to high */
    OPTION_COUNT,    /* a uint32_t or int from low to high */
    OPTION_WHOLE     /* a uint64_t from low to high, which may be INFINITY */
};

/* Takes an argument into a field of the request. text NULL: the option has no argument. Status 0, or another one that
 * ends the command. OPTION_LEFT: the text is no argument of an OPTION_OPTIONAL. */
typedef int option_take(const char *text, void *field);
enum { OPTION_LEFT = -1 };

/* An option of a command. Its argument goes into a field of the command's request. A table of options ends with a name
 * of NULL. */
struct option {
    char letter;          /* of the short form, 'o' for -o; 0: none */
    const char *name;     /* without the dashes; "": arguments that belong to no option */
    const char *argument; /* name of the argument in the help; NULL: the option takes no argument */
    const char *help;     /* NULL: the help does not show the option */
    enum option_kind kind;
    size_t field; /* its place in the request */
    double low, high;
    option_take *take;
};

/* The fields of a row from `kind` on. */
#define TO_FUNCTION(take, request, field)    OPTION_FUNCTION, offsetof(request, field), 0, 0, take
#define TO_REQUEST(take)                     OPTION_FUNCTION, 0, 0, 0, take /* the field is the whole request */
#define TO_FLAG(request, field)              OPTION_FLAG, offsetof(request, field), 0, 0, NULL
#define TO_TEXT(request, field)              OPTION_TEXT, offsetof(request, field), 0, 0, NULL
#define TO_PATH(request, field)              OPTION_PATH, offsetof(request, field), 0, 0, NULL
#define TO_NUMBER(request, field, low, high) OPTION_NUMBER, offsetof(request, field), low, high, NULL
#define TO_COUNT(request, field, low, high)  OPTION_COUNT, offsetof(request, field), low, high, NULL
#define TO_WHOLE(request, field, low, high)  OPTION_WHOLE, offsetof(request, field), low, high, NULL

/* The text of a macro that is a number, for help texts. */
#define TEXT_OF(macro)   TEXT_OF_IT(macro)
#define TEXT_OF_IT(text) #text

/* Texts of bounds that several options have. */
#define TEXT_DIRECTIONS TEXT_OF(FIBRAD_DIRECTIONS_MIN) " to " TEXT_OF(FIBRAD_DIRECTIONS_MAX)

/* Rows of tables, without braces. */
#define OPTION_THREADS(request, field)                                                                                 \
    0, "threads", "T", "number of threads, 1 to 1024 [all cores]", TO_COUNT(request, field, 1, 1024)
#define OPTION_HELP 'h', "help", NULL, "this text", OPTION_OPTIONAL, 0, 0, 0, option_help

/* A row with braces. The rows behind it are shown by `--help all` alone. */
#define OPTIONS_RARE                                                                                                   \
    { .name = "\n" }

/* Returns STATUS_HELP. The text `all` has options_help print everything. */
int option_help(const char *text, void *request);

/* Reads all arguments of a command into its request. Status 0, or that of the first argument that is refused. An
 * argument that begins like a negative number is no option. Behind `--` there are no options. */
int options_read(const char *command, const struct option *table, int argc, char **argv, void *request);

/* Prints the table, each option with its help. */
void options_print(const struct option *table);

/* Prints the help of a command: how it begins, its options, and how it ends. `--help all` prints all of them, and
 * `more`, paragraphs that end with NULL. Else options behind OPTIONS_RARE are left out, and of the others the help goes
 * up to its first ; and has the default. */
void options_help(const char *command, const char *begin, const struct option *table, const char *const *more,
                  const char *end);

/* Reads a number, or a whole number, from low to high. The whole text must be the number. `what` names the number in
 * messages. _or_table: the message says how a table would be written if the text is the name of a file. Status 0 or
 * STATUS_USAGE. */
int options_number(const char *what, const char *text, double low, double high, double *value);
int options_number_or_table(const char *what, const char *text, double low, double high, double *value);
int options_whole(const char *what, const char *text, uint64_t low, uint64_t high, uint64_t *value);
int options_count(const char *what, const char *text, uint32_t low, uint32_t high, uint32_t *value);

/* Reads up to `capacity` numbers with commas in between. *count: how many. Status 0 or STATUS_USAGE. */
int options_numbers(const char *what, const char *text, int capacity, double *values, int *count);

/* Takes the argument of --points, 64, 128 or 256, into a uint32_t. */
int option_points(const char *text, void *points);

#endif
