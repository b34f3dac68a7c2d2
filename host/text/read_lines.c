/* read_lines.c - text files line by line, which may be packed by gzip, and their numbers. SPDX-License-Identifier: MIT
 *
 * The file is read in blocks. A line is a piece of the buffer. A 0 replaces the character behind the line. This
 * character is put back before the next line is looked for. So kept lines can be read once more. */
#include "text/read_lines.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

#include "cli/output.h"
#include "text/read_number.h"

/* No real line is longer than MOST bytes. A longer one is refused, so that a binary file does not fill the memory. */
enum { BLOCK = 1 << 16, MOST = 1 << 20 };

static const char blanks[] = " \t\r\v\f";

const char *lines_name(const char *path) { return strcmp(path, "-") == 0 ? "standard input" : path; }

static int lines_fail(const struct lines *lines) {
    int code;
    const char *why = gzerror(lines->file, &code);
    if (code == Z_ERRNO) return message_at(STATUS_FILE, lines->name, 0, "%s", strerror(errno));
    if (code == Z_MEM_ERROR) return message_memory();
    return message_at(STATUS_INPUT, lines->name, 0, "the gzip file is damaged: %s", why);
}

/* Makes room for more bytes. If at least half of the buffer is not needed any more, moves the bytes that are kept or
 * unread to the front. Else doubles the buffer. */
static int lines_make_room(struct lines *lines) {
    const size_t first = lines->keeps ? lines->kept : lines->next;
    if (first >= lines->end - first) {
        memmove(lines->buffer, lines->buffer + first, lines->end - first);
        lines->kept = 0;
        lines->next -= first;
        lines->end -= first;
    }
    if (lines->end + 1 < lines->capacity) return STATUS_OK;
    char *buffer = realloc(lines->buffer, 2 * lines->capacity);
    if (!buffer) return message_memory();
    lines->buffer = buffer;
    lines->capacity *= 2;
    return STATUS_OK;
}

/* Reads another block, or notes that the file is finished. One byte behind the end stays free for a 0. */
static int lines_read_block(struct lines *lines) {
    int status = lines_make_room(lines);
    if (status) return status;
    const size_t room = lines->capacity - 1 - lines->end;
    const int got = gzread(lines->file, lines->buffer + lines->end, (unsigned)(room < MOST ? room : MOST));
    if (interrupt_status()) return interrupt_status();
    if (got < 0) return lines_fail(lines);
    lines->end += (size_t)got;
    lines->finished = got == 0;
    int code;
    gzerror(lines->file, &code);
    lines->truncated = lines->finished && code == Z_BUF_ERROR;
    return STATUS_OK;
}

int lines_open(struct lines *lines, const char *path) {
    *lines = (struct lines){.name = lines_name(path), .capacity = BLOCK + 1};
    const int spared = output_spare(path);
    if (spared) return spared;
    lines->file = strcmp(path, "-") == 0 ? gzdopen(dup(STDIN_FILENO), "rb") : gzopen(path, "rb");
    if (!lines->file) return message_at(STATUS_FILE, path, 0, "%s", strerror(errno));
    gzbuffer(lines->file, BLOCK);
    lines->buffer = malloc(lines->capacity);
    if (!lines->buffer) return message_memory();
    const int status = lines_read_block(lines);
    if (!status && lines->end >= 3 && memcmp(lines->buffer, "\xEF\xBB\xBF", 3) == 0) lines->next = 3;
    return status;
}

void lines_close(struct lines *lines) {
    if (lines->file) gzclose(lines->file);
    free(lines->buffer);
    *lines = (struct lines){0};
}

/* Puts back the character that the 0 behind the current line has replaced. */
static void lines_restore(struct lines *lines) {
    if (lines->text) lines->text[lines->length] = lines->behind;
    lines->text = NULL;
}

/* Finds the end of the line that begins at lines->next. The last line may end with the file. */
static int find_end(struct lines *lines, size_t *end) {
    size_t sought = 0;
    for (;;) {
        const char *from = lines->buffer + lines->next;
        const char *found = memchr(from + sought, '\n', lines->end - lines->next - sought);
        *end = found ? (size_t)(found - lines->buffer) : lines->end;
        if (found || lines->finished) return STATUS_OK;
        sought = lines->end - lines->next;
        if (sought >= MOST) return lines_fault(lines, "the line has no end; is this a text file?");
        const int status = lines_read_block(lines);
        if (status) return status;
    }
}

int lines_next(struct lines *lines, bool *more) {
    size_t end;
    *more = true;
    lines_restore(lines);
    ++lines->number;
    const int status = find_end(lines, &end);
    if (status) return status;
    if (end == lines->end && (end == lines->next || lines->truncated)) {
        --lines->number;
        *more = false;
        return STATUS_OK;
    }
    lines->text = lines->buffer + lines->next;
    lines->length = end - lines->next;
    lines->ended = end < lines->end;
    lines->next = end + lines->ended;
    if (lines->length && lines->text[lines->length - 1] == '\r') --lines->length;
    lines->behind = lines->text[lines->length];
    lines->text[lines->length] = 0;
    if (memchr(lines->text, 0, lines->length)) return lines_fault(lines, "binary data; a text file is expected");
    return STATUS_OK;
}

int lines_next_text(struct lines *lines, bool *more) {
    int status;
    while (!(status = lines_next(lines, more)) && *more && lines_blank(lines)) continue;
    return status;
}

void lines_hold(struct lines *lines) {
    lines->next = (size_t)(lines->text - lines->buffer);
    --lines->number;
    lines_restore(lines);
}

void lines_keep(struct lines *lines) {
    lines_restore(lines);
    lines->keeps = true;
    lines->kept = lines->next;
    lines->kept_number = lines->number;
}

void lines_return(struct lines *lines) {
    lines_restore(lines);
    lines->next = lines->kept;
    lines->number = lines->kept_number;
}

void lines_drop(struct lines *lines) { lines->keeps = false; }

int lines_rest(struct lines *lines, char **rest, size_t *size) {
    lines_keep(lines);
    while (!lines->finished) {
        const int status = lines_read_block(lines);
        if (status) return status;
    }
    *rest = lines->buffer + lines->next;
    *size = lines->end - lines->next;
    (*rest)[*size] = 0;
    return STATUS_OK;
}

bool lines_blank(const struct lines *lines) { return lines->text[strspn(lines->text, blanks)] == 0; }

bool lines_comment(const struct lines *lines) { return *lines->text == '#' || *lines->text == '%'; }

bool lines_begin(const struct lines *lines, const char *with) { return strncmp(lines->text, with, strlen(with)) == 0; }

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

static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/* This loop is many times as fast as fields_split. It cuts the rows of large files. */
int fields_split_blanks(struct fields *fields, char *text) {
    fields->n = 0;
    for (;;) {
        while (is_blank(*text)) ++text;
        if (!*text) return STATUS_OK;
        const int status = add_field(fields, text);
        if (status) return status;
        while (*text && !is_blank(*text)) ++text;
        if (*text) *text++ = 0;
    }
}

/* Removes the quotes about a field, in which "" stands for a quote. Returns a pointer behind the field. NULL: the
 * closing quote is missing. */
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

/* Skips blanks. The separator, such as a tab, is not a blank. */
static char *skip_blanks(char *text, char separator) {
    while (is_blank(*text) && *text != separator) ++text;
    return text;
}

int fields_split_at(struct fields *fields, const struct lines *lines, char *text, char separator) {
    for (fields->n = 0;;) {
        text = skip_blanks(text, separator);
        const int status = add_field(fields, text);
        if (status) return status;
        char *end = text;
        char after;
        if (*text == '"') {
            end = unquote(text);
            if (end) end = skip_blanks(end, separator);
            if (!end || (*end && *end != separator)) return lines_fault(lines, "a quoted field does not end");
            after = *end;
        } else {
            while (*end && *end != separator) ++end;
            after = *end;
            char *tail = end;
            while (tail > text && is_blank(tail[-1])) --tail;
            *tail = 0;
        }
        if (!after) return STATUS_OK;
        text = end + 1;
    }
}

int lines_number(const struct lines *lines, const char *what, const char *text, double *value) {
    if (!number_read(text, value)) return lines_fault(lines, "%s is not a number: '%.40s'", what, text);
    if (!isfinite(*value)) return lines_fault(lines, "%s is not finite: '%.40s'", what, text);
    return STATUS_OK;
}

int lines_whole(const struct lines *lines, const char *what, const char *text, int64_t *value) {
    if (number_read_whole(text, value)) return STATUS_OK;
    return lines_fault(lines, errno ? "%s is too large: '%.40s'" : "%s is not a whole number: '%.40s'", what, text);
}

int lines_decimal(const struct lines *lines, const char *what, char *text, char *mark, double *value) {
    char *here = mark ? strpbrk(text, ".,") : NULL;
    if (here && *mark && *here != *mark)
        return lines_fault(lines, "%s is '%.40s': decimal commas and decimal points in one file", what, text);
    if (here) *mark = *here, *here = '.';
    return lines_number(lines, what, text, value);
}
