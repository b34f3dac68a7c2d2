/* furnace_cases.c - the published furnace, its reference values, and values along its axis.
 * SPDX-License-Identifier: MIT */
#include "papers/furnace/furnace.h"

#include <math.h>

fibrad_furnace_config furnace_case(int number) {
    return (fibrad_furnace_config){.size = {2, 2, 4},
                                   .cells = {20, 20, 40},
                                   .absorption = number == 2 ? 0.15 : 0.5,
                                   .scattering = number == 2 ? 0.35 : 0,
                                   .source = 5000,
                                   .wall_temperature = {900, 900, 900, 900, 1200, 400},
                                   .wall_emissivity = {0.7, 0.7, 0.7, 0.7, 0.85, 0.7},
                                   .seed = 1};
}

const double furnace_reference_z[FURNACE_REFERENCES] = {0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0,
                                                        2.2, 2.4, 2.6, 2.8, 3.0, 3.2, 3.4, 3.6, 3.8, 3.9};

/* Both cases have the same extinction, and so the same incident radiation. E = incident/4 + source/(4 absorption). So
 * one table serves both. */
double furnace_reference(int number, int k) {
    static const double t[FURNACE_REFERENCES] = {1094.52, 1081.62, 1057.76, 1036.54, 1017.96, 1002.14, 988.77,
                                                 977.33,  967.53,  958.93,  951.15,  943.82,  936.64,  929.32,
                                                 921.22,  912.00,  901.08,  887.89,  871.41,  850.37,  837.25};
    double e = FIBRAD_STEFAN_BOLTZMANN * pow(t[k], 4);
    if (number == 2) e += 5000.0 / 4 * (1 / 0.15 - 1 / 0.5);
    return fibrad_furnace_temperature(e);
}

const double furnace_reference_power[3] = {215.532, -96.996, -198.536};

const double furnace_reference_theta[2][2][FURNACE_REFERENCES] = {
    {{1.5000, 1.4763, 1.4439, 1.4156, 1.3976, 1.3887, 1.3871, 1.3901, 1.3963, 1.4035, 1.4115,
      1.4196, 1.4269, 1.4337, 1.4400, 1.4452, 1.4493, 1.4523, 1.4544, 1.4553, 1.4544},
     {1.5211, 1.5190, 1.5177, 1.5174, 1.5181, 1.5196, 1.5225, 1.5268, 1.5315, 1.5382, 1.5471,
      1.5578, 1.5717, 1.5880, 1.6077, 1.6295, 1.6493, 1.6573, 1.6376, 1.5796, 1.5000}},
    {{1.3333, 1.3267, 1.3135, 1.2964, 1.2814, 1.2712, 1.2657, 1.2641, 1.2655, 1.2683, 1.2723,
      1.2768, 1.2814, 1.2857, 1.2899, 1.2937, 1.2967, 1.2992, 1.3011, 1.3023, 1.3029},
     {1.3446, 1.3440, 1.3441, 1.3445, 1.3456, 1.3472, 1.3497, 1.3533, 1.3569, 1.3620, 1.3683,
      1.3759, 1.3849, 1.3948, 1.4051, 1.4142, 1.4176, 1.4095, 1.3871, 1.3578, 1.3333}}};

/* The mean over the two middle cells along x and along y. If the number of cells is odd, both are the same cell. */
static double furnace_axis_mean(const double *values, size_t start, const uint32_t cells[3]) {
    double sum = 0;
    for (uint32_t j = 0; j < 2; j++)
        for (uint32_t i = 0; i < 2; i++)
            sum += values[start + (cells[0] - 1 + i) / 2 + (size_t)cells[0] * ((cells[1] - 1 + j) / 2)] / 4;
    return sum;
}

double furnace_axis_temperature(const struct furnace_run *run, double z) {
    const uint32_t *n = run->config.cells;
    double place = fmin(fmax(z / run->config.size[2] * n[2] - 0.5, 0), n[2] - 1), t[2];
    size_t low = n[2] == 1 ? 0 : place < n[2] - 1 ? (size_t)place : n[2] - 2, layer = (size_t)n[0] * n[1];
    for (size_t k = 0; k < 2; k++) {
        size_t level = low + k < n[2] ? low + k : low;
        t[k] = fibrad_furnace_temperature(furnace_axis_mean(run->at.e, level * layer, n));
    }
    return t[0] + (place - (double)low) * (t[1] - t[0]);
}

double furnace_axis_theta(const struct furnace_run *run, int g, double z) {
    const uint32_t *n = run->config.cells;
    double place = fmin(fmax(z / run->config.size[2] * n[2], 0), n[2]);
    size_t low = place < n[2] ? (size_t)place : n[2] - 1, layer = (size_t)n[0] * n[1];
    double here = furnace_axis_mean(run->at.theta[2][g], low * layer, n);
    return here + (place - (double)low) * (furnace_axis_mean(run->at.theta[2][g], (low + 1) * layer, n) - here);
}

void furnace_powers(const struct furnace_run *run, double kilowatts[4]) {
    const fibrad_furnace_config *c = &run->config;
    const double *power = run->at.power;
    kilowatts[0] = power[4] / 1000;
    kilowatts[1] = power[5] / 1000;
    kilowatts[2] = (power[0] + power[1] + power[2] + power[3]) / 1000;
    kilowatts[3] = kilowatts[0] + kilowatts[1] + kilowatts[2] + c->source * c->size[0] * c->size[1] * c->size[2] / 1000;
}
