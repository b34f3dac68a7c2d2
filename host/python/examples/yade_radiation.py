# yade_radiation.py - spheres and clumps of YADE above a hot floor are heated by radiation. SPDX-License-Identifier: MIT
"""Run `yade -n -x yade_radiation.py`. YADE's Python must find fibrad. PyRunner calls radiate() every EVERY steps.
Positions, walls, facets and clumps are those of O.bodies. Net powers change the temperatures, which this file keeps by
the ids of the bodies. All members of a clump have the temperature of their clump.

With a ThermalEngine temperatures are state.temp. Put hand_over() before the engine, in each step, and radiate() after it,
now and then. The engine takes up stepFlux [W], above 0 where heat is gained, and then sets it to 0."""
import numpy as np

import fibrad

FLOOR, SIDES, SURROUNDINGS, START = 1000.0, 600.0, 300.0, 300.0  # K
CAPACITY, EMISSIVITY = 800.0, 0.8  # J/(kg K)
EVERY = 2000  # time steps

temperature = {}  # K, by the ids of the spheres and clumps
given = []  # pairs of a state and its power [W], for ThermalEngine
bed = None  # made by the first call, moved by the next ones
last_time = 0.0
absorbed = 0.0  # J


def spheres_of(bodies):
    """The spheres among the bodies: ids of what each belongs to (its clump, or itself), positions, radii, states."""
    found = [b for b in bodies if isinstance(b.shape, Sphere)]
    return (np.array([b.clumpId if b.isClumpMember else b.id for b in found]),
            np.array([b.state.pos for b in found], float).reshape(-1, 3), np.array([b.shape.radius for b in found]),
            [b.state for b in found])


def walls_of(bodies, x):
    """Walls of YADE as planes at the temperature FLOOR, all facets as one mesh at the temperature SIDES."""
    walls, corners = [], []
    for b in bodies:
        if isinstance(b.shape, Wall):
            axis, at = b.shape.axis, b.state.pos[b.shape.axis]
            side = "min" if np.mean(x[:, axis]) > at else "max"
            walls.append(fibrad.wall("xyz"[axis] + side, at=at, temperature=FLOOR))
        if isinstance(b.shape, Facet):
            corners += [b.state.pos + b.state.ori * v for v in b.shape.vertices]
    if corners:
        mesh = fibrad.Mesh(np.array(corners, float), np.arange(len(corners)).reshape(-1, 3), back=True)
        walls.append(fibrad.wall(mesh, name="facets", temperature=SIDES))
    return walls


def hand_over():
    """Gives ThermalEngine the powers of the last radiate()."""
    global absorbed
    for state, watts in given:
        state.stepFlux = watts
        absorbed += watts * O.dt


def radiate():
    """Computes net powers. Changes the temperatures of this file, or keeps the powers for hand_over()."""
    global bed, last_time, absorbed, given
    owner, x, r, states = spheres_of(O.bodies)
    owners, index = np.unique(owner, return_inverse=True)
    clump = np.where([O.bodies[int(i)].isClump for i in owner], owner + 1, 0)  # 0: the sphere is alone
    box = O.cell.size if O.periodic else None
    if bed is None or bed.n != len(x):
        bed = fibrad.Bed(x, r, box=box, walls=walls_of(O.bodies, x), clump=clump)
    else:
        bed.move(x, r, box=box, walls=walls_of(O.bodies, x))
    thermal = all(hasattr(state, "stepFlux") for state in states)
    part = r**3 / np.bincount(index, r**3)[index]  # share of a member in the heat of its clump
    if thermal:
        now = np.bincount(index, part * [state.temp for state in states])
    else:
        now = np.array([temperature.setdefault(int(i), START) for i in owners])
    powers = bed.solve(now[index], EMISSIVITY, surroundings=SURROUNDINGS)
    gained = np.bincount(index, powers.spheres)
    if thermal:
        given = list(zip(states, (part * gained[index]).tolist()))
        return
    passed, last_time = O.time - last_time, O.time
    now += gained * passed / (np.array([O.bodies[int(i)].state.mass for i in owners]) * CAPACITY)
    absorbed += gained.sum() * passed
    temperature.update(zip(owners.tolist(), now))


if __name__ == "__main__":
    O.materials.append(FrictMat(young=1e6, poisson=0.3, frictionAngle=0.5, density=2500))
    O.bodies.append(wall(0, axis=2))
    O.bodies.append([facet([(-.01, -.01, 0), (-.01, .05, 0), (-.01, .02, .05)]),
                     facet([(.05, -.01, 0), (.05, .05, 0), (.05, .02, .05)])])
    for j in range(4):
        O.bodies.appendClumped([sphere((.011 * i, .011 * j, .045), .005) for i in (0, .5)])
    O.bodies.append([sphere((0.011 * i, 0.011 * j, 0.006 + 0.011 * k), 0.005)
                     for i in range(4) for j in range(4) for k in range(3)])
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb(), Bo1_Facet_Aabb()]),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom()],
                        [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]),
        NewtonIntegrator(gravity=(0, 0, -9.81), damping=0.3),
        PyRunner(command="radiate()", iterPeriod=EVERY),
    ]
    O.dt = 0.5 * PWaveTimeStep()
    O.run(5 * EVERY, True)
    gained = sum(O.bodies[i].state.mass * CAPACITY * (t - START) for i, t in temperature.items())
    print(f"{O.time:.4f} s: {len(temperature)} spheres and clumps, {min(temperature.values()):.4f} to "
          f"{max(temperature.values()):.4f} K, absorbed {absorbed:.9f} J, stored {gained:.9f} J")
    assert abs(gained - absorbed) < 1e-6 * abs(absorbed) and min(temperature.values()) >= START
