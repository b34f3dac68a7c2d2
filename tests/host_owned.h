/* host_owned.h - OWNED variables (owned.h) of the host's simple calls. SPDX-License-Identifier: MIT */
#ifndef TESTS_HOST_OWNED_H
#define TESTS_HOST_OWNED_H

#include "owned.h"
#include "simple/fibrad_host.h"

static inline void factors_free(fibrad_bed_matrix **factors) { fibrad_bed_matrix_free(*factors); }
static inline void radiation_free(fibrad_radiation **radiation) { fibrad_radiation_free(*radiation); }
static inline void transient_free(fibrad_transient **transient) { fibrad_transient_free(*transient); }

#define OWNED_FACTORS   OWNED_BY(factors_free) fibrad_bed_matrix
#define OWNED_RADIATION OWNED_BY(radiation_free) fibrad_radiation
#define OWNED_TRANSIENT OWNED_BY(transient_free) fibrad_transient

#endif
