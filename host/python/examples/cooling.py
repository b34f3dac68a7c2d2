#!/usr/bin/env python3
# cooling.py - a bed of hot spheres cools on a floor: explicit steps that keep the energy. SPDX-License-Identifier: MIT
"""Usage: cooling.py [STEPS]. Each step needs the net powers alone: m c dT/dt = power."""
import sys

import numpy as np

import fibrad

STEPS = int(sys.argv[1]) if len(sys.argv) > 1 else 20
RADIUS, DENSITY, CAPACITY, EMISSIVITY = 0.005, 2500.0, 800.0, 0.8  # m, kg/m3, J/(kg K)
SURROUNDINGS, FLOOR = 300.0, 350.0  # K
STEP = 2.0  # s

# 8 x 8 x 4 spheres, nearly touching, on a floor
place = np.indices((8, 8, 4)).reshape(3, -1).T
x = RADIUS * (2.02 * place + 1.01)
heat_capacity = 4 / 3 * np.pi * RADIUS**3 * DENSITY * CAPACITY  # J/K, of a sphere
temperature = np.full(len(x), 1200.0)
given_away = 0.0  # J, to floor and surroundings

with fibrad.Heat(x, RADIUS, walls={"zmin": 0.0}) as heat:
    for step in range(1, STEPS + 1):
        powers = heat.solve(temperature, EMISSIVITY, surroundings=SURROUNDINGS, wall_temperature={"zmin": FLOOR},
                            wall_emissivity={"zmin": 0.9})
        temperature += STEP * powers.spheres / heat_capacity
        given_away += STEP * (powers.surroundings + powers.walls["zmin"])
        if step % 5 == 0:
            print(f"{step * STEP:6.1f} s  {temperature.min():7.1f} to {temperature.max():7.1f} K")

lost = heat_capacity * (1200.0 * len(x) - temperature.sum())
print(f"lost by the spheres {lost:.6f} J, gained by floor and surroundings {given_away:.6f} J")
assert abs(lost - given_away) < 1e-9 * lost
