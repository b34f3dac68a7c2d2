/* bed_options.c - what all commands about a bed are asked. SPDX-License-Identifier: MIT */
#include "command/bed_options.h"

#include <string.h>

#include "bed/bed_scene.h"
#include "cli/message.h"
#include "read/read.h"

static int take_period(const char *text, double period[3]) {
    int count = 3;
    const int status = strcmp(text, "none") == 0 ? STATUS_OK : options_numbers("--periodic", text, 3, period, &count);
    if (status) return status;
    if (count != 3 || period[0] < 0 || period[1] < 0 || period[2] < 0)
        return message(STATUS_USAGE, "--periodic: '%.60s' is neither none nor three lengths LX,LY,LZ", text);
    return STATUS_OK;
}

int bed_options_take(struct bed_options *asked, const struct options *options, int key) {
    const char *value = options->value;
    uint64_t frame = 0;
    int status = STATUS_OK;
    switch (key) {
    case OPTIONS_POSITIONAL:
        asked->name = lines_name(value);
        return options_file(value, &asked->file);
    case KEY_HELP:
        return STATUS_HELP;
    case KEY_PERIODIC:
        asked->periodic = true;
        return take_period(value, asked->period);
    case KEY_FRAME:
        status = options_whole("--frame", value, 0, INT64_MAX, &frame);
        asked->frame = (int64_t)frame;
        return status;
    case KEY_WALL:
        return walls_option(value, &asked->walls);
    case KEY_THREADS:
        return options_threads(value, &asked->threads);
    case KEY_IDS:
        asked->ids = true;
        return STATUS_OK;
    case KEY_PROGRESS:
        asked->progress.forced = true;
        return STATUS_OK;
    case 'o':
        return outputs_add(&asked->outputs, value);
    case KEY_FORMAT:
        return outputs_format(&asked->outputs, value);
    default:
        return STATUS_USAGE; /* OPTIONS_BAD: the message is out */
    }
}

size_t bed_options_column(struct bed_options *asked, const char *name) {
    asked->column[asked->columns] = name;
    return name ? asked->columns++ : 0;
}

int bed_options_output(struct bed_options *asked, enum content content) {
    return outputs_check(&asked->outputs, content, &asked->file, 1, false);
}

fibrad_run bed_options_run(struct bed_options *asked) {
    return (fibrad_run){.threads = asked->threads, .progress = progress_stage, .context = &asked->progress};
}

int bed_options_status(struct bed_options *asked, const struct bed *bed, int status, const fibrad_fault *fault) {
    progress_stop(&asked->progress);
    return bed_status(bed, asked->name, status, fault);
}

int bed_options_read(const struct bed_options *asked, struct bed *bed) {
    const struct read_options read = {.frames = {.end = asked->frame + 1},
                                      .positions = !asked->ids,
                                      .extra = asked->column,
                                      .extras = asked->columns};
    const int status = read_bed(asked->file, &read, bed);
    if (!status && asked->periodic) memcpy(bed->period, asked->period, sizeof bed->period);
    return status;
}
