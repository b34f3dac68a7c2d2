/* wall_heat.h - walls that store heat: their temperatures follow the radiation that they get.
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_WALL_HEAT_H
#define FIBRAD_COUPLE_WALL_HEAT_H

#include <algorithm>
#include <vector>

#include "couple/fibrad_couple.h"

/* Heat capacities of walls. A wall without a capacity keeps the temperature that it was given. */
class WallHeat {
  public:
    std::vector<double> capacity; /* [walls], energy/K; 0: none */

    bool any() const { return std::any_of(capacity.begin(), capacity.end(), stores); }

    /* A step of `seconds` over the longest one in which no wall overshoots what it sees and touches: the largest
     * (4 sigma T^3 G + 2 H) seconds/capacity. exchange, conductance: G and H of each wall, of fibrad_insitu_facts and
     * fibrad_insitu_conducted. *wall: the index of that wall. */
    double ratio(const double *exchange, const double *conductance, double sigma,
                 const std::vector<double> &temperature, double seconds, size_t *wall) const {
        double worst = 0;
        for (size_t k = 0; k < capacity.size(); ++k) {
            const double t = temperature[k], gain = 4 * sigma * t * t * t * exchange[k] + 2 * conductance[k];
            const double of_wall = stores(capacity[k]) ? gain * seconds / capacity[k] : 0;
            if (of_wall > worst) worst = of_wall, *wall = k;
        }
        return worst;
    }

    /* Gives walls what they gain in `seconds`. power: [walls], of fibrad_insitu_totals. */
    void step(const double *power, double seconds, std::vector<double> *temperature) const {
        for (size_t k = 0; k < capacity.size(); ++k)
            if (stores(capacity[k])) (*temperature)[k] += power[k] * seconds / capacity[k];
    }

  private:
    static bool stores(double capacity) { return capacity > 0; }
};

#endif
