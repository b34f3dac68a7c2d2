/* emissivity.h - the options --emissivity and --wall-emissivity: a number, or a column of the file.
 * SPDX-License-Identifier: MIT */
#ifndef EMISSIVITY_H
#define EMISSIVITY_H

#include <stdint.h>

#include "bed.h"
#include "fibrad.h"
#include "walls.h"

/* What --emissivity asks for. */
struct emissivity_option {
    double value;       /* of all spheres; 0: as `column` says */
    const char *column; /* of the file; to be read as one of read_options.extra */
};

/* Takes the argument of --emissivity, a number above 0 up to 1 or the name of a column. Status 0 or STATUS_USAGE. */
int emissivity_option(const char *text, struct emissivity_option *option);

/* The emissivity of every sphere [n], to be freed; `extra` is the number of the column among bed->extra, `file` the
 * bed's name in messages. Status 0, STATUS_INPUT naming the line of one that is not in (0, 1], or STATUS_MEMORY. */
int emissivity_of(const struct emissivity_option *option, const struct bed *bed, const char *file, size_t extra,
                  double **emissivity);

/* What --help says of --wall-emissivity. */
#define EMISSIVITY_WALL_HELP                                                                                           \
    "emissivities of the walls in the order given, 0 to 1; the last one is that of all further [1]"

/* Spreads the list of --wall-emissivity (NULL: not given) over the walls there are. Status 0 or STATUS_USAGE. */
int emissivity_walls(const char *text, const struct wall_order *order, double emissivity[FIBRAD_WALLS]);

#endif
