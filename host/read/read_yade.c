/* read_yade.c - beds from YADE's text export: `#format x_y_z_r` names the columns, blanks part them; other lines that
 * begin with # are skipped. SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "read/read.h"
#include "read/read_columns.h"

int read_yade(struct lines *lines, const struct read_options *options, struct bed *bed) {
    struct columns columns = {0};
    struct fields fields = {0};
    bool more;
    int status = lines_next(lines, &more);
    if (!status) status = fields_split(&fields, lines->text + strlen("#format"), "_ \t");
    if (!status) status = columns_find(&columns, lines, &fields, options);
    while (!status && (status = lines_next(lines, &more)) == STATUS_OK && more) {
        if (*lines->text == '#' || lines_blank(lines)) continue;
        status = fields_split(&fields, lines->text, " \t");
        if (!status) status = columns_add(&columns, lines, &fields, options, bed);
    }
    free(columns.extra);
    free(fields.at);
    return status;
}
