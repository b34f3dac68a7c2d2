/* reproduce_contacts.c - conductivity of beds with contacts and gas that were measured. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "bed/packing.h"
#include "cli/message.h"
#include "conductivity/plates.h"
#include "papers/reproduce/published.h"
#include "papers/reproduce/reproduce.h"

#define GAS_REACH   .65   /* the default of --gas-gap */
#define GAS_LEAST   4e-10 /* [m] the least gap */
#define TOUCHING    1e-3  /* spheres that are so near have a spot, over their radius */
#define PEBBLE      .03   /* [m] radius of reactors' pebbles */
#define PEBBLE_SPOT .0114 /* radius of their spots over that of pebbles: Hertz, graphite of 10 GPa, 18 N a contact */
#define GRAIN       5e-4  /* [m] radius of lithium ceramics */
#define CERAMIC     2.4   /* [W/(m K)] their conductivity, from memory */
#define VACUUM_BED  .25   /* [W/(m K)] of their beds in a vacuum at 500 C; .2 to .3 was measured. Read */
#define EMITTING    .8    /* emissivity of pebbles and grains */
#define ABSOLUTE    273.15
enum { SPHERES = 1000, WALKS = 60 };

/* A periodic bed of unit spheres, between plates across each axis. */
struct touching_bed {
    struct bed bed;
    struct plates plates[3];
};

static void touching_free(struct touching_bed *t) {
    for (int axis = 0; axis < 3; ++axis) plates_close(&t->plates[axis]);
    bed_free(&t->bed);
}

static int touching_make(struct touching_bed *t, uint32_t n, double porosity) {
    fibrad_run run = {.threads = 1};
    *t = (struct touching_bed){.bed = bed_empty()};
    int status = bed_make_jammed(&t->bed, n, 1 - porosity, 1000, 1);
    for (int axis = 0; axis < 3 && !status; ++axis) {
        status = plates_open(&t->plates[axis], &t->bed, NULL, axis, &run);
        status = bed_status(&t->bed, "bed", status, &run.fault);
    }
    return status;
}

/* The conductivity along an axis by gas and spots, in the unit of conductances over the radius. */
static int conduct_along(const struct plates *plates, double k_solid, double k_gas, double spot, double least,
                         double *k) {
    const fibrad_contact_rule rule = {.gas_reach = GAS_REACH, .gas_least = least};
    const fibrad_contact_list *list;
    struct conduction_plates along;
    int status = fibrad_bed_contacts(plates->made, &rule, &list);
    if (status) return status;
    double *room = calloc(plates->bed.n + 2 * (size_t)list->n + 1, sizeof *room);
    double *solid = room, *gas = room + plates->bed.n, *conductance = gas + list->n;
    if (!room) return FIBRAD_E_MEMORY;
    for (uint32_t i = 0; i < plates->bed.n; ++i) solid[i] = k_solid;
    for (uint32_t c = 0; c < list->n; ++c) gas[c] = k_gas;
    status = fibrad_contacts_conduct(list, &rule, solid, gas, conductance);
    for (uint32_t c = 0; c < list->n; ++c)
        if (list->second[c] < plates->bed.n && list->distance[c] < 2 + TOUCHING) conductance[c] += 2 * k_solid * spot;
    const struct plates_problem problem = {.temperature = 1000,
                                           .contacts = list->n,
                                           .first = list->first,
                                           .second = list->second,
                                           .conductance = conductance};
    if (!status) status = plates_conduct(plates, &problem, &along);
    free(room);
    *k = along.conduction.k;
    return status;
}

/* The conductivity of the bed by gas and spots, as the mean of three axes [W/(m K)]. spot, least: radius of the spots
 * of spheres that touch, and the least gap, over the radius. */
static int touching_conduct(struct touching_bed *t, double k_solid, double k_gas, double spot, double least,
                            double *k) {
    int status = FIBRAD_OK;
    *k = 0;
    for (int axis = 0; axis < 3 && !status; ++axis) {
        double along = 0;
        status = conduct_along(&t->plates[axis], k_solid, k_gas, spot, least, &along);
        *k += along / 3;
    }
    return bed_status(&t->bed, "bed", status, &(fibrad_fault){0});
}

/* The same with radiation of spheres of k* = k_solid/(4 sigma T^3 d) added. radius [m]. */
static int touching_radiate(struct touching_bed *t, double kelvins, double k_solid, double k_gas, double spot,
                            double radius, double *k) {
    const double unit = 4 * FIBRAD_STEFAN_BOLTZMANN * pow(kelvins, 3) * 2 * radius;
    double factor = 0;
    int status = STATUS_OK;
    *k = 0;
    if (k_gas > 0 || spot > 0) status = touching_conduct(t, k_solid, k_gas, spot, GAS_LEAST / radius, k);
    if (!status) status = grey_conduction(&t->bed, EMITTING, k_solid / unit, WALKS, &factor);
    *k += factor * unit;
    return status;
}

static void compare_bed(struct reproduce *reproduce, const char *bed, double at, double theirs, double ours) {
    fprintf(reproduce->data, "%s,%g,%.5g,%.5g\n", bed, at, theirs, ours);
    reproduce_compare(reproduce, SOURCE_PAPER, "", theirs, ours, "k, %s %g", bed, at);
}

/* Beds without radiation, over the conductivity of the gas. */
static int compare_gas(struct reproduce *reproduce) {
    struct touching_bed t;
    double k;
    int status = touching_make(&t, SPHERES, .4);
    for (int i = 0; i < BEDS_WITH_GAS && !status; ++i) {
        const double ratio = beds_with_gas[i][0];
        status = touching_conduct(&t, ratio, 1, 0, 1e-8, &k);
        if (status) break;
        compare_bed(reproduce, "gas alone: least measured [k_s/k_gas]", ratio, beds_with_gas[i][1], k);
        if (beds_with_gas[i][2] > beds_with_gas[i][1])
            compare_bed(reproduce, "gas alone: largest measured [k_s/k_gas]", ratio, beds_with_gas[i][2], k);
    }
    touching_free(&t);
    return status;
}

/* Lithium ceramics. Spots are so large that the bed conducts VACUUM_BED without gas at 500 C. */
static int compare_grains(struct reproduce *reproduce) {
    struct touching_bed t;
    double vacuum = 0, spots = 1, k;
    int status = touching_make(&t, SPHERES, .37);
    if (!status) status = touching_radiate(&t, 500 + ABSOLUTE, CERAMIC, 0, 0, GRAIN, &vacuum);
    if (!status) status = touching_conduct(&t, CERAMIC, 0, 1, 0, &spots);
    const double spot = (VACUUM_BED - vacuum) / spots;
    if (!status)
        reproduce_compare(reproduce, "", "", NAN, spot, "radius of spots, lithium ceramics, over that of grains");
    for (int celsius = 100; celsius <= 700 && !status; celsius += 200) {
        const double kelvins = celsius + ABSOLUTE;
        status = touching_radiate(&t, kelvins, CERAMIC, conductivity_helium(kelvins), spot, GRAIN, &k);
        if (status) break;
        compare_bed(reproduce, "Li2TiO3 in helium [C]", celsius, bed_of_titanate(celsius), k);
        compare_bed(reproduce, "Li4SiO4 in helium [C]", celsius, bed_of_silicate(celsius), k);
    }
    touching_free(&t);
    return status;
}

/* Pebbles of graphite. published[n]: temperature over `zero` and conductivity. */
static int compare_pebbles(struct reproduce *reproduce, struct touching_bed *t, const char *name, double zero,
                           double (*gas)(double kelvins), int n, const double published[][2]) {
    int status = STATUS_OK;
    for (int i = 0; i < n && !status; ++i) {
        const double kelvins = published[i][0] + zero;
        double k;
        status = touching_radiate(t, kelvins, conductivity_graphite(kelvins), gas(kelvins), PEBBLE_SPOT, PEBBLE, &k);
        if (!status) compare_bed(reproduce, name, published[i][0], published[i][1], k);
    }
    return status;
}

static const char contacts_script[] =
    "set xlabel 'temperature [C]'\nset ylabel 'conductivity of the bed [W/(m K)]'\nset key top left\n"
    "set xrange [0:1000]\nset yrange [0:*]\nhelium = 'SANA in helium [C]'\nnitrogen = 'SANA in nitrogen [C]'\n"
    "plot $data using 2:(strcol(1) eq helium?$3:1/0) with points pt 7 lc 1 title 'SANA, helium: measured', \\\n"
    "     '' using 2:(strcol(1) eq helium?$4:1/0) with linespoints pt 6 lc 1 title 'ours', \\\n"
    "     '' using 2:(strcol(1) eq nitrogen?$3:1/0) with points pt 5 lc 2 title 'SANA, nitrogen: measured', \\\n"
    "     '' using 2:(strcol(1) eq nitrogen?$4:1/0) with linespoints pt 4 lc 2 title 'ours'\n";

int reproduce_contacts(struct reproduce *reproduce) {
    struct touching_bed pebbles;
    fputs("bed,at,published,ours\n", reproduce->data);
    int status = compare_gas(reproduce);
    if (!status) status = compare_grains(reproduce);
    if (status) return status;
    status = touching_make(&pebbles, SPHERES, .41);
    if (!status)
        status = compare_pebbles(reproduce, &pebbles, "SANA in helium [C]", ABSOLUTE, conductivity_helium, SANA_HELIUM,
                                 sana_helium);
    if (!status)
        status = compare_pebbles(reproduce, &pebbles, "SANA in nitrogen [C]", ABSOLUTE, conductivity_nitrogen,
                                 SANA_NITROGEN, sana_nitrogen);
    touching_free(&pebbles);
    if (!status) status = touching_make(&pebbles, SPHERES, .39);
    if (!status)
        status =
            compare_pebbles(reproduce, &pebbles, "reactor in helium [K]", 0, conductivity_helium, REACTOR, reactor_bed);
    touching_free(&pebbles);
    return status ? status : reproduce_figure(reproduce, "contacts", contacts_script);
}
