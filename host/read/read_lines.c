/* read_lines.c - text input line by line, with strict numbers. SPDX-License-Identifier: MIT */
#include "read/read_lines.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/interrupt.h"
#include "cli/message.h"

enum { LINE_MAX_BYTES = 1 << 20 }; /* far beyond any real line: binary files are refused instead of swallowed */

static const char blanks[] = " \t\r\v\f";

const char *lines_name(const char *path) { return strcmp(path, "-") == 0 ? "standard input" : path; }

int lines_open(struct lines *lines, const char *path) {
    *lines = (struct lines){.name = lines_name(path)};
    lines->file = strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
    if (!lines->file) return message_at(STATUS_FILE, path, 0, "%s", strerror(errno));
    return STATUS_OK;
}

void lines_close(struct lines *lines) {
    if (lines->file && lines->file != stdin) fclose(lines->file);
    free(lines->text);
    *lines = (struct lines){0};
}

static int make_room(struct lines *lines, size_t used) {
    if (used < lines->capacity) return STATUS_OK;
    if (used >= LINE_MAX_BYTES)
        return message_at(STATUS_INPUT, lines->name, lines->number, "the line has no end; is this a text file?");
    const size_t capacity = lines->capacity ? 2 * lines->capacity : 256;
    char *text = realloc(lines->text, capacity);
    if (!text) return message_memory();
    lines->text = text;
    lines->capacity = capacity;
    return STATUS_OK;
}

int lines_next(struct lines *lines, bool *more) {
    *more = true;
    if (lines->held) {
        lines->held = false;
        return STATUS_OK;
    }
    ++lines->number;
    size_t used = 0;
    int c;
    for (;; ++used) {
        const int status = make_room(lines, used);
        if (status) return status;
        c = getc_unlocked(lines->file);
        if (c == EOF || c == '\n') break;
        if (c == 0) return message_at(STATUS_INPUT, lines->name, lines->number, "binary data; a text file is expected");
        lines->text[used] = (char)c;
    }
    if (used && lines->text[used - 1] == '\r') --used;
    lines->text[used] = 0;
    if (interrupt_status()) return interrupt_status();
    if (c == EOF) {
        if (ferror(lines->file)) return message_at(STATUS_FILE, lines->name, 0, "%s", strerror(errno));
        *more = used > 0;
        if (!*more) --lines->number;
    }
    if (lines->number == 1 && strncmp(lines->text, "\xEF\xBB\xBF", 3) == 0) /* byte order mark */
        memmove(lines->text, lines->text + 3, used - 2);
    return STATUS_OK;
}

void lines_hold(struct lines *lines) { lines->held = true; }

bool lines_blank(const struct lines *lines) { return lines->text[strspn(lines->text, blanks)] == 0; }

static int add_field(struct fields *fields, char *text) {
    if (fields->n == fields->capacity) {
        const size_t capacity = fields->capacity ? 2 * fields->capacity : 16;
        char **at = realloc(fields->at, capacity * sizeof *at);
        if (!at) return message_memory();
        fields->at = at;
        fields->capacity = capacity;
    }
    fields->at[fields->n++] = text;
    return STATUS_OK;
}

int fields_split(struct fields *fields, char *text, const char *separators) {
    fields->n = 0;
    for (text += strspn(text, separators); *text; text += strspn(text, separators)) {
        const int status = add_field(fields, text);
        if (status) return status;
        text += strcspn(text, separators);
        if (*text) *text++ = 0;
    }
    return STATUS_OK;
}

/* Takes a quoted piece out of its quotes, where "" stands for a quote. Returns the place behind it; NULL: no end. */
static char *unquote(char *text) {
    char *to = text;
    for (char *from = text + 1; *from; ++from) {
        if (*from == '"' && *++from != '"') {
            *to = 0;
            return from;
        }
        *to++ = *from;
    }
    return NULL;
}

int fields_split_csv(struct fields *fields, const struct lines *lines) {
    fields->n = 0;
    for (char *text = lines->text;;) {
        text += strspn(text, blanks);
        const int status = add_field(fields, text);
        if (status) return status;
        char *end = text;
        char after;
        if (*text == '"') {
            end = unquote(text);
            if (end) end += strspn(end, blanks);
            if (!end || (*end && *end != ','))
                return message_at(STATUS_INPUT, lines->name, lines->number, "a quoted field does not end");
            after = *end;
        } else {
            end += strcspn(text, ",");
            after = *end;
            char *tail = end;
            while (tail > text && strchr(blanks, tail[-1])) --tail;
            *tail = 0;
        }
        if (!after) return STATUS_OK;
        text = end + 1;
    }
}

int lines_number(const struct lines *lines, const char *what, const char *text, double *value) {
    char *end;
    *value = strtod(text, &end);
    if (end == text || *end)
        return message_at(STATUS_INPUT, lines->name, lines->number, "%s is not a number: '%.40s'", what, text);
    if (!isfinite(*value))
        return message_at(STATUS_INPUT, lines->name, lines->number, "%s is not finite: '%.40s'", what, text);
    return STATUS_OK;
}

int lines_whole(const struct lines *lines, const char *what, const char *text, int64_t *value) {
    char *end;
    errno = 0;
    *value = strtoll(text, &end, 10);
    if (end == text || *end || errno)
        return message_at(STATUS_INPUT, lines->name, lines->number, "%s is not a whole number: '%.40s'", what, text);
    return STATUS_OK;
}
