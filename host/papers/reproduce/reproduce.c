/* reproduce.c - what experiments compare and draw. SPDX-License-Identifier: MIT */
#include "papers/reproduce/reproduce.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "plot/gnuplot.h"

void reproduce_compare(struct reproduce *reproduce, const char *source, const char *unit, double theirs, double ours,
                       const char *what, ...) {
    char text[80];
    va_list arguments;
    va_start(arguments, what);
    vsnprintf(text, sizeof text, what, arguments);
    va_end(arguments);
    const bool points = strcmp(unit, "%") == 0;
    const double difference = points ? ours - theirs : 100 * (ours / theirs - 1);
    if (isnan(theirs))
        printf("%-12s %-70s %-5s %12s %12.6g %-3s\n", reproduce->experiment, text, "", "", ours, unit);
    else
        printf("%-12s %-70s %-5s %12.6g %12.6g %-3s %+8.2f %s\n", reproduce->experiment, text, source, theirs, ours,
               unit, difference, points ? "points" : "%");
    if (!reproduce->comparison.file) return;
    fprintf(reproduce->comparison.file, "%s,\"%s\",%s,%s,", reproduce->experiment, text, isnan(theirs) ? "" : source,
            unit);
    if (isnan(theirs))
        fprintf(reproduce->comparison.file, ",%.6g,\n", ours);
    else
        fprintf(reproduce->comparison.file, "%.6g,%.6g,%.3f\n", theirs, ours, difference);
}

char *reproduce_path(const struct reproduce *reproduce, const char *name, const char *ending) {
    const size_t size = strlen(reproduce->directory) + strlen(name) + strlen(ending) + 2;
    char *path = malloc(size);
    if (path) snprintf(path, size, "%s/%s%s", reproduce->directory, name, ending);
    return path;
}

static int write_figure(const struct reproduce *reproduce, const char *name) {
    char *path = reproduce_path(reproduce, name, ".csv");
    if (!path) return message_memory();
    struct output output = {0};
    int status = output_open(&output, path);
    if (!status) fwrite(reproduce->text, 1, reproduce->length, output.file);
    status = output_close(&output, status);
    free(path);
    return status;
}

static int draw_figure(const struct reproduce *reproduce, const char *name, const char *script) {
    char *path = reproduce_path(reproduce, name, ".svg");
    if (!path) return message_memory();
    struct output output = {0};
    struct gnuplot gnuplot;
    int status = output_open(&output, path);
    if (!status) status = gnuplot_start(&gnuplot, &output);
    if (!status) {
        const char *wall = strchr(reproduce->text, '\n');
        fprintf(gnuplot.script,
                "set terminal svg size 900,600 font 'Helvetica,13' background 'white'\n"
                "set datafile separator ','\nset grid\nset style data linespoints\nset key font ',11'\n"
                "$data << END%s\nEND\n%s\n",
                wall ? wall : "\n", script);
        status = gnuplot_end(&gnuplot);
    }
    status = output_close(&output, status);
    free(path);
    return status;
}

int reproduce_figure(struct reproduce *reproduce, const char *name, const char *script) {
    if (fflush(reproduce->data) != 0) return message_memory();
    if (!reproduce->directory) return STATUS_OK;
    const int status = write_figure(reproduce, name);
    return status || !reproduce->plots || !script ? status : draw_figure(reproduce, name, script);
}
