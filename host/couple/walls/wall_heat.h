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

    /* Collective, after rows have been made. Finds what each wall exchanges: what particles of 1 K send to it. The
     * state has sigma and the particles. Status as fibrad_insitu_powers. */
    int weigh(fibrad_insitu *insitu, fibrad_insitu_state state) {
        if (!any()) return FIBRAD_OK;
        const std::vector<double> one(state.n, 1), cold(capacity.size());
        std::vector<double> power(state.n);
        fibrad_insitu_totals totals;
        state.surroundings = 0;
        state.body_temperature = cold.data();
        state.temperature = one.data();
        const int status = fibrad_insitu_powers(insitu, &state, power.data(), &totals);
        gain.assign(totals.body, totals.body + capacity.size());
        return status;
    }

    /* A step of `seconds` over the longest one in which no wall overshoots the particles that it sees: the largest
     * 4 sigma T^3 G seconds/capacity. *wall: the index of that wall. */
    double ratio(const std::vector<double> &temperature, double seconds, size_t *wall) const {
        double worst = 0;
        for (size_t k = 0; k < gain.size(); ++k) {
            const double t = temperature[k];
            const double of_wall = stores(capacity[k]) ? 4 * t * t * t * gain[k] * seconds / capacity[k] : 0;
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
    std::vector<double> gain; /* [walls], sigma G, energy/(time K^4) */
    static bool stores(double capacity) { return capacity > 0; }
};

#endif
