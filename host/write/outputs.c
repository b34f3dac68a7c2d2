/* outputs.c - the outputs of a run: -o, --format, --json. SPDX-License-Identifier: MIT */
#include "write/outputs.h"

#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "text/text.h"

static const struct format formats[] = {{"csv", {write_csv, write_heat_csv, write_conduction_csv}, true, false},
                                        {"mtx", {write_mtx}, false, false},
                                        {"npz", {write_npz}, false, false},
                                        {"vtp", {write_vtp, write_heat_vtp}, false, false},
                                        {"json", {write_json, write_heat_json, write_conduction_json}, true, false},
                                        {"dump", {NULL, write_heat_dump}, true, true},
                                        {"lammpstrj", {NULL, write_heat_dump}, true, true}};
enum { FORMATS = sizeof formats / sizeof *formats };

/* Lists the formats that can hold such contents: ".csv, .mtx and .npz". `dot` stands before each name. */
static const char *list_formats(enum content content, const char *dot, char text[100]) {
    int left = 0, used = 0;
    for (int k = 0; k < FORMATS; ++k) left += formats[k].write[content] != NULL;
    for (int k = 0; k < FORMATS; ++k) {
        if (!formats[k].write[content]) continue;
        --left;
        used += snprintf(text + used, (size_t)(100 - used), "%s%s%s", dot, formats[k].name,
                         left > 1    ? ", "
                         : left == 1 ? " and "
                                     : "");
    }
    return text;
}

static const struct format *format_of_ending(const char *path) {
    for (int k = 0; k < FORMATS; ++k) {
        char ending[16];
        snprintf(ending, sizeof ending, ".%s", formats[k].name);
        if (output_ends(path, ending)) return &formats[k];
    }
    return NULL;
}

int outputs_add(const char *path, void *all) {
    struct outputs *outputs = all;
    const char *star = strchr(path, '*');
    if (outputs->count == OUTPUTS_MAX) return message(STATUS_USAGE, "-o: at most %d are allowed", OUTPUTS_MAX);
    if (star && strchr(star + 1, '*')) return message_at(STATUS_USAGE, path, 0, "has more than one *");
    outputs->to[outputs->count].path = path;
    outputs->to[outputs->count].star = star;
    outputs->to[outputs->count++].format = format_of_ending(path);
    return STATUS_OK;
}

int outputs_add_meshes(const char *path, void *all) {
    struct outputs *outputs = all;
    static const struct format meshes = {"vtp", {write_mesh_vtp, write_mesh_vtp}, false, false};
    const int status = outputs_add(path, outputs);
    if (!status) outputs->to[outputs->count - 1].format = &meshes;
    return status;
}

int outputs_format(const char *name, void *all) {
    struct outputs *outputs = all;
    if (outputs->format) return message(STATUS_USAGE, "--format may be given only once");
    for (int k = 0; k < FORMATS; ++k)
        if (strcmp(formats[k].name, name) == 0) outputs->format = &formats[k];
    if (!outputs->format) return message(STATUS_USAGE, "--format: '%.40s' is not a format", name);
    return STATUS_OK;
}

/* Finds the format of an output, and checks that the format can hold the contents. */
static int check_format(struct outputs *outputs, size_t k, bool series) {
    const char *path = outputs->to[k].path;
    const struct format *format = outputs->to[k].format ? outputs->to[k].format : outputs->format;
    char list[100];
    if (!format && strcmp(path, "-") == 0)
        return message(STATUS_USAGE, "-o - needs a --format: %s", list_formats(outputs->content, "", list));
    if (!format || (outputs->to[k].format && !format->write[outputs->content]))
        return message_at(STATUS_USAGE, path, 0, "unknown ending; there are %s",
                          list_formats(outputs->content, ".", list));
    if (!format->write[outputs->content])
        return message(STATUS_USAGE, "--format: %s cannot hold this; these formats can: %s", format->name,
                       list_formats(outputs->content, "", list));
    if (series && !format->frames && !outputs->to[k].star)
        return message_at(STATUS_USAGE, path, 0, "%s holds one frame; put * into its name", format->name);
    outputs->to[k].format = format;
    return STATUS_OK;
}

static bool is_same(const char *a, const char *b) {
    return a && b && ((output_stdout(a) && output_stdout(b)) || output_same(a, b));
}

/* Checks that no other output of the run has the path of output k. */
static int check_others(const struct outputs *outputs, size_t k, const char *path) {
    bool twice = is_same(path, outputs->summary) || is_same(path, outputs->picture);
    for (size_t other = 0; other < outputs->count; ++other)
        twice = twice || (other != k && is_same(path, outputs->to[other].path));
    return twice ? message_at(STATUS_USAGE, path, 0, "is given twice") : STATUS_OK;
}

int outputs_check(struct outputs *outputs, enum content content, bool series) {
    bool wanted = outputs->format == NULL;
    int status = STATUS_OK;
    outputs->content = content;
    for (size_t k = 0; k < outputs->count && !status; ++k) {
        if (!outputs->to[k].format) wanted = true;
        status = check_format(outputs, k, series);
        if (!status) status = check_others(outputs, k, outputs->to[k].path);
    }
    if (!status && is_same(outputs->summary, outputs->picture))
        status = message_at(STATUS_USAGE, outputs->summary, 0, "is given twice");
    if (status || wanted) return status;
    return message(STATUS_USAGE, "--format %s: every -o has an ending that names its format", outputs->format->name);
}

bool outputs_keep(const struct outputs *outputs) {
    for (size_t k = 0; k < outputs->count; ++k)
        if (outputs->to[k].format->columns) return true;
    return false;
}

int outputs_open(struct outputs *outputs) {
    int status = output_open(&outputs->summary_file, outputs->summary);
    for (size_t k = 0; k < outputs->count && !status; ++k) {
        status = output_open(&outputs->to[k].file, outputs->to[k].path);
        if (!status && outputs->to[k].star) output_close(&outputs->to[k].file, STATUS_FILE);
    }
    return status;
}

/* Writes a frame into a file of its own. */
static int write_alone(const struct outputs *outputs, size_t k, const struct contents *what, int64_t number) {
    char path[OUTPUT_PATH];
    struct output file = {0};
    int status = output_numbered(outputs->to[k].path, number, path);
    if (!status) status = check_others(outputs, k, path);
    if (!status) status = output_open(&file, path);
    if (!status) status = outputs->to[k].format->write[outputs->content](file.file, what);
    return output_close(&file, status);
}

/* Notes a frame of a series, for write_collection. */
static int note_frame(struct outputs *outputs, const struct contents *what) {
    if (!what->series && !what->time) return STATUS_OK;
    bool good = true;
    outputs->frame = memory_grown(outputs->frame, outputs->frames, sizeof *outputs->frame, &good);
    if (!good) return message_memory();
    outputs->frame[outputs->frames++] = (struct written){.number = what->bed->frame,
                                                         .time = what->time ? *what->time : (double)what->bed->timestep,
                                                         .known = what->time || what->bed->timestep >= 0};
    return STATUS_OK;
}

int outputs_write(struct outputs *outputs, const struct contents *what) {
    struct contents own = *what;
    int status = note_frame(outputs, what);
    for (size_t k = 0; k < outputs->count && !status; ++k) {
        if (outputs->to[k].star) {
            own.first = true;
            status = write_alone(outputs, k, &own, what->bed->frame);
            continue;
        }
        struct output *file = &outputs->to[k].file;
        own.first = !outputs->to[k].begun;
        status = outputs->to[k].format->write[outputs->content](file->file, &own);
        if (!status) status = output_flush(file);
        outputs->to[k].begun = true;
    }
    return status;
}

/* Whether all frames have times or timesteps that ascend. If not, the .pvd has their numbers instead. */
static bool has_times(const struct outputs *outputs) {
    for (size_t k = 0; k < outputs->frames; ++k)
        if (!outputs->frame[k].known || (k > 0 && !(outputs->frame[k].time > outputs->frame[k - 1].time))) return false;
    return true;
}

/* Writes NAME.pvd beside NAME.*.vtp. It tells ParaView the time of each file. */
static int write_collection(const struct outputs *outputs, const char *path, const char *star) {
    const char *slash = strrchr(path, '/'), *begin = slash ? slash + 1 : path;
    size_t length = (size_t)(star - path);
    char name[PATH_MAX], number[TEXT_NUMBER];
    struct output file = {0};
    if (slash > star) return STATUS_OK; /* each file is in a folder of its own */
    while (length > (size_t)(begin - path) && strchr("._-", path[length - 1])) --length;
    if (snprintf(name, sizeof name, "%.*s.pvd", (int)length, path) >= (int)sizeof name)
        return message_at(STATUS_FILE, path, 0, "the name is too long");
    int status = output_open(&file, name);
    if (status) return status;
    const bool timed = has_times(outputs);
    fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n", file.file);
    for (size_t k = 0; k < outputs->frames; ++k) {
        const struct written *frame = &outputs->frame[k];
        *text_real(number, timed ? frame->time : (double)frame->number) = 0;
        fprintf(file.file, "<DataSet timestep=\"%s\" file=\"%.*s%" PRId64 "%s\"/>\n", number, (int)(star - begin),
                begin, frame->number, star + 1);
    }
    fputs("</Collection>\n</VTKFile>\n", file.file);
    return output_close(&file, status);
}

int outputs_close(struct outputs *outputs, int status) {
    for (size_t k = 0; k < outputs->count && !status && outputs->frames > 0; ++k)
        if (outputs->to[k].star && strcmp(outputs->to[k].format->name, "vtp") == 0)
            status = write_collection(outputs, outputs->to[k].path, outputs->to[k].star);
    for (size_t k = 0; k < outputs->count; ++k) status = output_close(&outputs->to[k].file, status);
    free(outputs->frame);
    outputs->frame = NULL, outputs->frames = 0;
    return output_close(&outputs->summary_file, status);
}

struct report outputs_report(const struct outputs *outputs, bool quiet) {
    bool taken = outputs->summary && output_stdout(outputs->summary);
    for (size_t k = 0; k < outputs->count; ++k) taken = taken || output_stdout(outputs->to[k].path);
    return (struct report){.text = quiet ? NULL : taken ? stderr : stdout, .json = outputs->summary_file.file};
}
