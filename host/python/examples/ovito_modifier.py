# ovito_modifier.py - a modifier function for OVITO: what particles see, their powers. SPDX-License-Identifier: MIT
"""In OVITO: Add modification > Python script, and paste this file. In a script: pipeline.modifiers.append(modify).

Particles need radii. Each particle gets `Escaped`, the fraction of its view that leaves the bed, and `Seen`, the number
of particles that it sees. If particles have temperatures [K] and positions are in metres, each particle also gets
`Radiative Power`.
"""
import numpy as np

import fibrad

EMISSIVITY = 0.8
SURROUNDINGS = 300.0  # K


def box_of(cell):
    """Lengths of a box with right angles, 0 along open axes."""
    if cell is None:
        return None
    edges = np.asarray(cell)[:3, :3]
    if np.any(edges[~np.eye(3, dtype=bool)] != 0):
        raise ValueError("fibrad needs a box with right angles")
    return np.where(cell.pbc, edges.diagonal(), 0.0)


def modify(frame, data):
    particles = data.particles
    if "Radius" not in particles:
        raise ValueError("fibrad needs the particle property Radius")
    ids = np.asarray(particles["Particle Identifier"]) if "Particle Identifier" in particles else None
    bed = fibrad.Bed(np.asarray(particles["Position"]), np.asarray(particles["Radius"]), box=box_of(data.cell), ids=ids)
    factors = bed.factors()
    data.particles_.create_property("Escaped", data=factors.escaped)
    data.particles_.create_property("Seen", data=np.diff(factors.indptr))
    data.attributes["fibrad.error"] = factors.error.max(initial=0)
    if "Temperature" in particles:
        powers = bed.solve(np.asarray(particles["Temperature"]), EMISSIVITY, surroundings=SURROUNDINGS)
        data.particles_.create_property("Radiative Power", data=powers.spheres)
        data.attributes["fibrad.surroundings"] = powers.surroundings
