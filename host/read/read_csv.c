/* read_csv.c - beds from comma-separated values: a header with x,y,z,r among its columns, then a sphere a line; lines
 * that begin with # are skipped. SPDX-License-Identifier: MIT */
#include <stdlib.h>

#include "cli/message.h"
#include "read/read.h"
#include "read/read_columns.h"

int read_csv(struct lines *lines, const struct read_options *options, struct bed *bed) {
    struct columns columns = {0};
    struct fields fields = {0};
    bool more, header = true;
    int status;
    while ((status = lines_next(lines, &more)) == STATUS_OK && more) {
        if (*lines->text == '#' || lines_blank(lines)) continue;
        status = fields_split_csv(&fields, lines);
        if (!status) {
            status = header ? columns_find(&columns, lines, &fields, options)
                            : columns_add(&columns, lines, &fields, options, bed);
        }
        if (status) break;
        header = false;
    }
    free(columns.extra);
    free(fields.at);
    return status;
}
