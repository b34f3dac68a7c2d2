/* store.h - the heat that spheres store over temperature, and back. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_STORE_H
#define FIBRAD_SIMPLE_STORE_H

#include "simple/heap.h"

/* A fibrad_store in sections. Heats are from 0 K on, for a fibrad_span.capacity of 1. */
typedef struct fibrad_section {
    double begin;    /* K */
    double capacity; /* there */
    double slope;    /* of the capacity, up to the next section */
    double heat;     /* stored at `begin` */
    double melted;   /* fraction that has melted at `begin` */
    double melting;  /* how much of it melts for each kelvin; infinity: all of it melts at `begin` */
} fibrad_section;

typedef struct fibrad_sections {
    fibrad_section *section; /* [n] */
    uint32_t n;
    double latent;
} fibrad_sections;

/* What a sphere is like at a heat: its temperature, dheat/dtemperature (infinity: it melts at one temperature), and the
 * fraction of it that has melted. */
typedef struct fibrad_stored {
    double temperature, capacity, melted;
} fibrad_stored;

/* Whether a store is valid. */
bool fibrad_store_valid(const fibrad_store *store);

/* Makes sections: an array with room for store->rows + 3. */
void fibrad_sections_make(fibrad_sections *sections, const fibrad_store *store);

/* The heat at a temperature. melted NaN: as much has melted as at this temperature, and nothing at a melting point. */
double fibrad_sections_heat(const fibrad_sections *sections, double temperature, double melted);

/* The inverse. */
fibrad_stored fibrad_sections_at(const fibrad_sections *sections, double heat);

#endif
