/* published_formulas.c - correlations for the conductivity of beds and for the emissivity of their faces.
 * SPDX-License-Identifier: MIT
 *
 * "Read" says where a formula was read. A source that is not the original paper is called a second source. */
#include <math.h>

#include "reproduce/published.h"

/* The shape parameter of the cell of Zehner and Schluender for spheres: 1.25 ((1 - p)/p)^(10/9). */
static double cell_shape(double porosity) { return 1.25 * pow((1 - porosity) / porosity, 10. / 9); }

/* The part of the cell in which radiation and the solid follow each other: plates at a distance of d, whose exchange
 * factor is 1/(2/e - 1), and solid in series. */
static double cell_core(double emissivity, double porosity, double conductivity) {
    const double plates = 1 / (2 / emissivity - 1), shape = cell_shape(porosity);
    return sqrt(1 - porosity) * (shape + 1) / shape * plates / (1 + plates / conductivity);
}

/* P. Zehner, E. U. Schluender, Chem. Ing. Tech. 44 (1972) 1303; R. Bauer, E. U. Schluender, Int. Chem. Eng. 18 (1978)
 * 181; VDI Heat Atlas, section D6.3. Here in the limit of no gas and no conduction through contacts. Read in
 * github.com/ClaRaLibrary/TransiEnt, VDIHeatAtlas.mo, a second source, with the 1.4 of crushed material. The constant
 * 1.25 of spheres: read in a public program for pebble beds (type ZbsBed), which quotes C. G. van Antwerpen et al.,
 * Nucl. Eng. Des. 240 (2010) 1803. */
double correlation_zehner_bauer_schluender(double emissivity, double porosity, double conductivity) {
    return (1 - sqrt(1 - porosity)) * porosity / (2 / emissivity - 1) + cell_core(emissivity, porosity, conductivity);
}

/* G. Breitbach, H. Barthels, Nucl. Technol. 49 (1980) 392: as above, the void in parallel being black. From memory.
 * That reactor codes offer it: github.com/idaholab/moose, NavierStokesEnums.C, read there. */
double correlation_breitbach_barthels(double emissivity, double porosity, double conductivity) {
    return (1 - sqrt(1 - porosity)) * porosity + cell_core(emissivity, porosity, conductivity);
}

/* D. Vortmeyer, Proc. 6th Int. Heat Transfer Conf., Toronto (1978), vol. 6, 525: two fluxes and layers that let a part
 * of the radiation pass. The fit of that part belongs to a porosity of 0.4. From memory; agrees with the values .25,
 * .33, .54, .85, 1.12 at emissivities of .2, .35, .6, .85, 1 that M. Kaviany, Principles of heat transfer in porous
 * media (1991), gives, also from memory. */
double correlation_vortmeyer(double emissivity, double porosity, double conductivity) {
    (void)porosity;
    (void)conductivity;
    const double e = emissivity;
    const double passed = .149909 + e * (-.24791 + e * (.290799 + e * (-.20081 + e * .0651042)));
    return (2 * passed + e * (1 - passed)) / (2 * (1 - passed) - e * (1 - passed));
}

/* B. P. Singh, M. Kaviany, Int. J. Heat Mass Transfer 37 (1994) 2579: a fit for a porosity of 0.476. From
 * memory. */
double correlation_singh_kaviany(double emissivity, double porosity, double conductivity) {
    (void)porosity;
    return .5756 * emissivity * atan(1.5353 * pow(conductivity, .8011) / emissivity) + .1843;
}

/* D. Kunii, J. M. Smith, AIChE J. 6 (1960) 71, with the coefficients of S. Yagi, D. Kunii, AIChE J. 3 (1957) 373. Here
 * without gas. Read in a public program for a thermal store after F. G. Battisti et al., Applied Thermal Engineering
 * 183 (2021) 116032, a second source: beta .9, gamma 2/3. */
double correlation_kunii_smith(double emissivity, double porosity, double conductivity) {
    const double beta = .9, gamma = 2. / 3;
    const double through_void = 1 / (1 + porosity * (1 - emissivity) / (2 * (1 - porosity) * emissivity));
    return beta * porosity * through_void +
           beta * (1 - porosity) / ((2 - emissivity) / emissivity + gamma / conductivity);
}

/* S. S. Sih, J. W. Barlow, Particulate Science and Technology 22 (2004) 291. Read in P. Ferro et al., Frattura ed
 * Integrita Strutturale 53 (2020) 252, equations 30 to 32, a second source whose text was damaged: what it lacked is
 * from memory. */
double emissivity_sih_barlow(double emissivity, double porosity) {
    const double p = porosity, e = emissivity, ratio = (1 - p) * (1 - p) / (p * p);
    const double holes = .908 * p * p / (1.908 * p * p - 2 * p + 1);
    const double hole = e * (2 + 3.082 * ratio) / (e * (1 + 3.082 * ratio) + 1);
    return holes * hole + (1 - holes) * e;
}

/* B. Hapke, Theory of reflectance and emittance spectroscopy (1993), chapter 8: two streams in a half space whose
 * grains are far apart. The scattering albedo of a grain is 1 - e. A large sphere that reflects diffusely scatters
 * backwards, with a mean cosine of -4/9, which the similarity relation takes into account. With a mean cosine of 0,
 * absorptance_two_stream is that of A. V. Gusarov et al., J. Heat Transfer 131 (2009) 072101, for a deep bed. All from
 * memory. */
static double depth_factor(double emissivity) { return sqrt(emissivity / (1 + 4. / 9 * (1 - emissivity))); }

double emissivity_two_stream(double emissivity) {
    const double g = depth_factor(emissivity);
    return 2 * g / (1 + g);
}

double absorptance_two_stream(double emissivity) {
    const double g = depth_factor(emissivity);
    return 3 * g / (1 + 2 * g);
}

/* The graphite of SANA at 25 to 1000 C, constant beyond. Read. */
double conductivity_graphite(double kelvins) {
    static const double celsius[] = {25, 100, 200, 300, 400, 500, 1000}, k[] = {110, 100, 92, 85, 79, 75, 50};
    const double at = kelvins - 273.15;
    int i = 1;
    while (i < 6 && at > celsius[i]) ++i;
    const double share = fmax(0, fmin(1, (at - celsius[i - 1]) / (celsius[i] - celsius[i - 1])));
    return k[i - 1] + share * (k[i] - k[i - 1]);
}

/* Helium: as SANA's authors have it. Read. */
double conductivity_helium(double kelvins) { return .0025 * pow(kelvins, .72); }

/* Nitrogen: .0258 at 300 K and .065 at 1000 K. From memory. */
double conductivity_nitrogen(double kelvins) { return .0258 * pow(kelvins / 300, .768); }

/* Beds of pebbles of 1 mm, solid fraction .63, 45 to 800 C. Fits of measurements. Read. */
double bed_of_titanate(double celsius) { return .9922 + 1.7859e-4 * celsius + 1.9879e-7 * celsius * celsius; }
double bed_of_silicate(double celsius) { return .97198 + 5.04496e-4 * celsius + 3.30432e-7 * celsius * celsius; }
