#!/usr/bin/env python3
# cooling.py - a bed of hot spheres cools on a floor. SPDX-License-Identifier: MIT
"""Usage: cooling.py [TIMES]. Prints temperatures every ten seconds. Steps are automatic, and the energy is kept."""
import sys

import numpy as np

import fibrad

TIMES = int(sys.argv[1]) if len(sys.argv) > 1 else 20
RADIUS, DENSITY, CAPACITY, EMISSIVITY = 0.005, 2500.0, 800.0, 0.8  # m, kg/m3, J/(kg K)
SURROUNDINGS, FLOOR = 300.0, 350.0  # K

# 8 x 8 x 4 spheres, nearly touching, on a floor
place = np.indices((8, 8, 4)).reshape(3, -1).T
x = RADIUS * (2.02 * place + 1.01)
heat_capacity = 4 / 3 * np.pi * RADIUS**3 * DENSITY * CAPACITY  # J/K, of a sphere
temperature = np.full(len(x), 1200.0)
given_away = 0.0  # J, to floor and surroundings

floor = fibrad.wall("zmin", at=0.0, temperature=FLOOR, emissivity=0.9)
with fibrad.Bed(x, RADIUS, walls=floor) as bed:
    for time in range(1, TIMES + 1):
        end = bed.advance(temperature, 10.0, capacity=heat_capacity, emissivity=EMISSIVITY, surroundings=SURROUNDINGS)
        temperature = end.temperatures
        given_away += end.surroundings + end.walls["zmin"]
        if time % 5 == 0:
            print(f"{10 * time:4d} s  {temperature.min():7.1f} to {temperature.max():7.1f} K, {end.steps} steps")

lost = heat_capacity * (1200.0 * len(x) - temperature.sum())
print(f"lost by the spheres {lost:.6f} J, gained by floor and surroundings {given_away:.6f} J")
assert abs(lost - given_away) < 1e-9 * lost
