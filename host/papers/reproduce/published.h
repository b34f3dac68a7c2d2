/* published.h - tables and formulas of publications. Each stands beside its source and says whether it was read there.
 * SPDX-License-Identifier: MIT */
#ifndef PUBLISHED_H
#define PUBLISHED_H

/* ---- tables ---- */

/* Exchange factors of Johnson, Tari, Baker against distance [radii] in beds of equal spheres: from sphere to sphere by
 * the distance of the centres, from a sphere to a plane wall by the distance of the centre from the wall. */
enum { JOHNSON_TABLES = 2, JOHNSON_FRACTIONS = 5, JOHNSON_ROWS = 21 };
struct johnson_table {
    double emissivity, wall_emissivity;
    double row[JOHNSON_ROWS][1 + JOHNSON_FRACTIONS]; /* distance, and the factor at each solid fraction; 0: none */
};
extern const double johnson_fraction[JOHNSON_FRACTIONS];
extern const struct johnson_table johnson_spheres[JOHNSON_TABLES], johnson_walls[JOHNSON_TABLES];

/* Conductivity of beds with gas. Van Antwerpen and others: over that of the gas, without radiation, the least and the
 * largest that were measured at a ratio k_s/k_gas of solid and gas. SANA: [W/(m K)] at a temperature [C]. Reactor: at a
 * temperature [K]. */
enum { BEDS_WITH_GAS = 10, SANA_HELIUM = 8, SANA_NITROGEN = 6, REACTOR = 5 };
extern const double beds_with_gas[BEDS_WITH_GAS][3], sana_helium[SANA_HELIUM][2], sana_nitrogen[SANA_NITROGEN][2],
    reactor_bed[REACTOR][2];

/* ---- formulas ---- */

/* Conductivities [W/(m K)]: of the graphite of SANA, of helium and of nitrogen at a temperature [K]; of beds of lithium
 * ceramics in helium of .1 MPa at a temperature [C]. */
double conductivity_graphite(double kelvins);
double conductivity_helium(double kelvins);
double conductivity_nitrogen(double kelvins);
double bed_of_titanate(double celsius);
double bed_of_silicate(double celsius);

/* A correlation for the radiative exchange factor F_E = k/(4 sigma T^3 d) of a bed without gas.
 *   emissivity    above 0, at most 1
 *   porosity      the volume between spheres over that of the bed
 *   conductivity  k* = k_s/(4 sigma T^3 d), k_s of the solid; INFINITY: each sphere has one temperature */
typedef double exchange_correlation(double emissivity, double porosity, double conductivity);
exchange_correlation correlation_zehner_bauer_schluender, correlation_kunii_smith;

/* The emissivity of the face of a bed into the half space, and the absorptance for light straight from above, by the
 * two-stream theory of a bed of spheres that are far apart. */
double emissivity_two_stream(double emissivity);
double absorptance_two_stream(double emissivity);

#endif
