/* host_owned.h - OWNED variables (owned.h) of the host's simple calls. SPDX-License-Identifier: MIT */
#ifndef TESTS_HOST_OWNED_H
#define TESTS_HOST_OWNED_H

#include "owned.h"
#include "simple/fibrad_host.h"

static inline void factors_free(fibrad_bed_matrix **factors) { fibrad_bed_matrix_free(*factors); }

#define OWNED_FACTORS OWNED_BY(factors_free) fibrad_bed_matrix

#endif
