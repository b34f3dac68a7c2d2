# _warnings.py - beds and values that contradict each other, as the program warns of them. SPDX-License-Identifier: MIT
from __future__ import annotations

import os
import sys
import warnings
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from ._scene import Container, Packing, across_cylinder

# The bounds are those of host/frames/warnings.c.
_SPACE, _WARM_CELSIUS = 5.0, 75.0  # [K] colder surroundings are those of space, warmer ones no degrees Celsius
_RADIUS_LARGE, _OVERLAP_LARGE, _CUT_LARGE, _SIZES_APART, _COLD = 0.1, 0.05, 0.1, 200.0, 150.0
_CLOSED, _APART, _CHANGE_LARGE = 1e-9, 0.1, 1.5
_STORE_LOW, _STORE_HIGH = 30.0 * 10.0, 3e4 * 1e5  # J/(m3 K): heat capacity times density

_HERE = os.path.dirname(os.path.abspath(__file__)) + os.sep


def warn(text: str) -> None:
    """A warning that names the line outside of this package from which the call came."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_HERE):
        level, frame = level + 1, frame.f_back
    warnings.warn(text, stacklevel=level)


def warn_metres(packing: Packing) -> None:
    """Radii that are hardly metres."""
    if packing.n and packing.r.mean() > _RADIUS_LARGE:
        warn(f"radii of {packing.r.mean():.4g} are taken as metres; 0.001 * x and 0.001 * r are for millimetres")


def warn_overlap(packing: Packing, facts: Any) -> None:
    if facts.overlap_max > _OVERLAP_LARGE:
        first, second = (packing.names(i) for i in facts.overlap_pair)
        small, large = sorted(packing.r[list(facts.overlap_pair)])
        d = small + large - facts.overlap_max * small
        rim = 1 - (d * d + small * small - large * large) / (2 * d * small)  # as in host/frames/warnings.c
        warn(f"{first} and {second} overlap by {facts.overlap_max:.3g} of a radius, so their view factors err by "
             f"about {rim * rim / 8:.1g}")


def _warn_cuts(packing: Packing, container: Container) -> None:
    """Planes and a cylinder inside spheres."""
    worst, count, r = (0.0, 0, ""), 0, packing.r
    for name, axis, upper, at in container.planes():
        beyond = packing.x[:, axis] - at
        depth = (r + (beyond if upper else -beyond)) / r
        count, worst = count + int((depth > _CUT_LARGE).sum()), max(worst, (depth.max(), int(depth.argmax()), name))
    for name, cylinder in container.cylinders():
        u, v = across_cylinder(cylinder.along)
        depth = (np.hypot(packing.x[:, u] - cylinder.x, packing.x[:, v] - cylinder.y) + r - cylinder.radius) / r
        count, worst = count + int((depth > _CUT_LARGE).sum()), max(worst, (depth.max(), int(depth.argmax()), name))
    if count:
        warn(f"{packing.names(worst[1])} reaches through the wall {worst[2]} by {worst[0]:.2g} of its radius ({count} "
             "such cases in all); is the wall in the right place?")


def _warn_meshes(packing: Packing, container: Container) -> None:
    """Meshes of another unit than the bed, or in another place."""
    low, high = (packing.x - packing.r[:, None]).min(0), (packing.x + packing.r[:, None]).max(0)
    near = 2 * packing.r.mean()
    for name, mesh in container.meshes():
        used = mesh.vertices[np.unique(mesh.triangles)]
        begin, end = used.min(0), used.max(0)
        size, bed = float((end - begin).max()), float((high - low).max())
        if not 1 / _SIZES_APART <= size / bed <= _SIZES_APART:
            warn(f"the wall {name} is {size:.3g} long, the bed {bed:.3g}; is the mesh in the unit of the bed? "
                 f"Mesh.from_stl(..., scale={'0.001' if size > bed else '1000'}) scales a mesh")
        apart = (container.period == 0) & ((begin > high + near) | (end < low - near))
        for axis in np.flatnonzero(apart)[:1]:
            warn(f"the wall {name} lies from {begin[axis]:g} to {end[axis]:g} along {'xyz'[axis]}, the bed from "
                 f"{low[axis]:g} to {high[axis]:g}; are both in the same place and unit?")


def warn_walls(packing: Packing, container: Container) -> None:
    if packing.n:
        _warn_cuts(packing, container)
        _warn_meshes(packing, container)


def warn_temperatures(packing: Packing, kelvins: NDArray[np.float64]) -> None:
    """Given temperatures, NaN where there is none."""
    most, zeros = np.max(kelvins, initial=0, where=~np.isnan(kelvins)), np.flatnonzero(kelvins == 0)
    if 0 < most < _COLD:
        warn(f"no sphere is warmer than {most:g} K; temperatures are in kelvins, 273.15 more than degrees Celsius")
    if most > 0 and zeros.size:
        warn(f"{packing.names(int(zeros[0]))} has 0 K ({zeros.size} spheres in all), others have up to {most:g} K; is "
             "a value missing? NaN stands for an unknown temperature")


def warn_around(container: Container, surroundings: Optional[float], walls: NDArray[np.float64],
                kelvins: NDArray[np.float64]) -> None:
    """Given temperatures of the surroundings (None: not given), of walls and of spheres, NaN where there is none."""
    known = ~np.isnan(kelvins)
    cold = known.any() and np.max(kelvins[known]) < _COLD
    for what, around in [("surroundings", surroundings), *zip(container.names, walls.tolist())]:
        if around is not None and _SPACE < around < _WARM_CELSIUS and not cold:
            warn(f"{what}: {around:g} K; temperatures are in kelvins, 273.15 more than degrees Celsius")
            break
    if surroundings is not None and container.closed() and (known.any() or not np.isnan(walls).all()):
        warn("surroundings has no effect: nothing leaves a bed that walls and periods close")


def warn_surfaces(packing: Packing, least: NDArray[np.float64]) -> None:
    """Least temperatures of surfaces that conduct."""
    below = np.flatnonzero(least < 0)
    if below.size:
        i = int(below[0])
        warn(f"{packing.names(i)}: its surface comes out at {least[i]:.0f} K in one place; conductivity is for surfaces "
             "whose temperature differs little from its mean")


def warn_capacity(packing: Packing, capacity: NDArray[np.float64]) -> None:
    """Heat capacities that no matter has."""
    store = capacity / (4 / 3 * np.pi * packing.r**3)
    wrong = np.flatnonzero(~((store >= _STORE_LOW) & (store <= _STORE_HIGH)))
    if wrong.size:
        i = int(wrong[0])
        warn(f"the capacity of {packing.names(i)} is {store[i]:.3g} J/K for each m3; solids have some 1e5 to 5e6")


def warn_rows(packing: Packing, factors: Any) -> None:
    """Rows of walls that contradict those of spheres, and rows that closing has changed much."""
    matrix, meshed = factors.matrix, factors.facts.triangles > 0
    walls = bool(matrix.wall_wall)
    if walls and matrix.wall_closure > _CLOSED:
        asked = "; do triangles cut spheres?" if meshed else ""
        warn(f"rows of walls are not closed: their sums are off by {matrix.wall_closure:.2g}, because they contradict "
             f"the rows of spheres{asked}")
    elif walls and matrix.wall_correction > _APART:
        asked = "do triangles cut spheres? If not, " if meshed else ""
        warn(f"rows of walls and of spheres disagreed by {matrix.wall_correction:.2g} before they were closed; {asked}"
             "more directions help")
    elif matrix.changed > _CHANGE_LARGE:
        asked = "do triangles cut this sphere? If not, " if meshed else ""
        warn(f"rows were scaled to add up to 1; this changes what {packing.names(matrix.changed_row)} gives to walls "
             f"and surroundings by {matrix.changed:.2g} times the error of its row; {asked}more directions help")
