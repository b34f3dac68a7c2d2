# yade_radiation.py - spheres of YADE on a hot floor are heated by radiation. SPDX-License-Identifier: MIT
"""Run `yade -n -x yade_radiation.py`. YADE's Python must find fibrad. PyRunner calls radiate() at regular steps.
Positions are those of O.bodies. Net powers change the temperatures, which this file keeps by the ids of the bodies."""
import numpy as np

import fibrad

FLOOR, SURROUNDINGS, START = 1000.0, 300.0, 300.0  # K
CAPACITY, EMISSIVITY = 800.0, 0.8  # J/(kg K)
EVERY = 2000  # time steps

temperature = {}  # K, by the ids of the bodies
bed = None  # made by the first call, moved by the next ones
last_time = 0.0
absorbed = 0.0  # J


def spheres_of(bodies):
    """The spheres among the bodies: ids, positions, radii, masses."""
    found = [b for b in bodies if isinstance(b.shape, Sphere)]
    return (np.array([b.id for b in found]), np.array([b.state.pos for b in found], float).reshape(-1, 3),
            np.array([b.shape.radius for b in found]), np.array([b.state.mass for b in found]))


def box_of(scene):
    """Lengths of the periodic box; None where space is open."""
    return scene.cell.size if scene.periodic else None


def radiate():
    global bed, last_time, absorbed
    ids, x, r, mass = spheres_of(O.bodies)
    if bed is None or bed.n != len(ids):
        bed = fibrad.Bed(x, r, box=box_of(O), walls=f"zmin:at=0:temperature={FLOOR}", ids=ids)
    else:
        bed.move(x, r, box=box_of(O))
    now = np.array([temperature.setdefault(i, START) for i in ids])
    powers = bed.solve(now, EMISSIVITY, surroundings=SURROUNDINGS)
    passed, last_time = O.time - last_time, O.time
    now += powers.spheres * passed / (mass * CAPACITY)
    absorbed += powers.spheres.sum() * passed
    temperature.update(zip(ids, now))


if __name__ == "__main__":
    O.materials.append(FrictMat(young=1e6, poisson=0.3, frictionAngle=0.5, density=2500))
    O.bodies.append(wall(0, axis=2))
    O.bodies.append([sphere((0.011 * i, 0.011 * j, 0.006 + 0.011 * k), 0.005)
                     for i in range(4) for j in range(4) for k in range(3)])
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()],
                        [Law2_ScGeom_FrictPhys_CundallStrack()]),
        NewtonIntegrator(gravity=(0, 0, -9.81), damping=0.3),
        PyRunner(command="radiate()", iterPeriod=EVERY),
    ]
    O.dt = 0.5 * PWaveTimeStep()
    O.run(5 * EVERY, True)
    masses = {b.id: b.state.mass for b in O.bodies if isinstance(b.shape, Sphere)}
    gained = sum(masses[i] * CAPACITY * (t - START) for i, t in temperature.items())
    print(f"{O.time:.4f} s: {len(temperature)} spheres, {min(temperature.values()):.4f} to "
          f"{max(temperature.values()):.4f} K, absorbed {absorbed:.9f} J, stored {gained:.9f} J")
    assert abs(gained - absorbed) < 1e-6 * abs(absorbed) and min(temperature.values()) >= START
