/* published_formulas.c - correlations for the conductivity of beds, and the theory of two streams for their faces.
 * SPDX-License-Identifier: MIT
 *
 * "Read" says where a formula was read. A source that is not the original paper is called a second source. Correlations
 * that could be read nowhere are not here: those of Breitbach and Barthels, of Vortmeyer, of Singh and Kaviany, and of
 * Sih and Barlow. */
#include <math.h>

#include "papers/reproduce/published.h"

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

/* D. Kunii, J. M. Smith, AIChE J. 6 (1960) 71, with the coefficients of S. Yagi, D. Kunii, AIChE J. 3 (1957) 373. Here
 * without gas. Read in a public program for a thermal store after F. G. Battisti et al., Applied Thermal Engineering
 * 183 (2021) 116032, a second source: beta .9, gamma 2/3. */
double correlation_kunii_smith(double emissivity, double porosity, double conductivity) {
    const double beta = .9, gamma = 2. / 3;
    const double through_void = 1 / (1 + porosity * (1 - emissivity) / (2 * (1 - porosity) * emissivity));
    return beta * porosity * through_void +
           beta * (1 - porosity) / ((2 - emissivity) / emissivity + gamma / conductivity);
}

/* Two streams in a half space whose spheres are far apart, derived here. F and G are the fluxes down and up, t is the
 * optical depth across the bed, w = 1 - e is the albedo of a sphere and b the mean cosine of what it scatters. The mean
 * of 1/cosine in a stream is 2, so that S = F + G and D = F - G have
 *
 *     D' = -2 (1 - w) S,   S' = -2 (1 - w b) D.
 *
 * What decays into the bed has D = g S with g = sqrt((1 - w)/(1 - w b)). So the bed reflects (1 - g)/(1 + g) of diffuse
 * radiation and absorbs, hence emits, 2 g/(1 + g). A large sphere that reflects diffusely has b = -4/9: the mean normal
 * of the points that light meets is turned back by 2/3, and what a point reflects goes along its normal by 2/3.
 *
 * Parallel light from straight above adds w e^-t to D' (with b = 0). The solution that vanishes far below, and has F =
 * 0 at the top, reflects (1 - g)/(1 + 2 g). So the bed absorbs 3 g/(1 + 2 g). By the similarity of media, scattering
 * with a mean cosine b counts as even scattering of the albedo w (1 - b)/(1 - w b), which has the same g.
 *
 * Compared with B. Hapke, Theory of reflectance and emittance spectroscopy (1993): (1 - g)/(1 + g), and g H with
 * H = (1 + 2 c)/(1 + 2 c g) at the cosine c = 1. Both were read in github.com/jekharris/hapke_ssa_matlab and other
 * public programs, second sources. */
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
