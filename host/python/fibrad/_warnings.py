# _warnings.py - what the library warns of, in words. SPDX-License-Identifier: MIT
from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Collection
from typing import Any

from ._library import library
from ._scene import Packing
from ._structures import Warning as Found
from ._walls import Container

_RADIUS_LARGE = 0.1  # [m] particles hardly have a larger mean radius
PLACES, SOURCES, ROWS = (1, 2, 3, 4, 13, 14), range(5, 10), range(10, 13)  # of fibrad_warning_code
_TEXTS = {
    1: "{first} and {second} overlap by {value:.3g} of a radius, so their view factors err by about {other:.1g}",
    2: "{first} reaches through the wall {wall} by {value:.2g} of its radius ({count} such cases in all); is the wall in "
       "the right place?",
    3: "the wall {wall} is {value:.3g} long, the bed {other:.3g}; is the mesh in the unit of the bed? scale={scale} "
       "scales it",
    4: "the wall {wall} lies from {value:g} to {other:g} along {axis}, away from the bed; are both in the same place and "
       "unit?",
    5: "no sphere is warmer than {value:g} K; temperatures are in kelvins, 273.15 more than degrees Celsius",
    6: "{first} has 0 K ({count} spheres in all), others have up to {value:g} K; is a value missing? NaN stands for an "
       "unknown temperature",
    7: "{wall}: {value:g} K; temperatures are in kelvins, 273.15 more than degrees Celsius",
    8: "{first}: its surface comes out at {value:.0f} K in one place; conductivity is for surfaces whose temperature "
       "differs little from its mean",
    9: "the capacity of {first} is {value:.3g} J/K for each m3; solids have some 1e5 to 5e6",
    10: "rows of walls are not closed: their sums are off by {value:.2g}, because they contradict the rows of "
        "spheres{asked}",
    11: "rows of walls and of spheres disagreed by {value:.2g} before they were closed{asked}; more directions help",
    12: "rows were scaled to add up to 1; this changes what {first} gives to walls and surroundings by {value:.2g} times "
        "the error of its row{asked}; more directions help",
    13: "{first} and {second} are of one clump, and its parts do not touch ({count} such clumps in all); it is one body "
        "all the same",
    14: "{first} lies within other spheres of its clump ({count} such spheres in all), so it has no surface"}

_HERE = os.path.dirname(os.path.abspath(__file__)) + os.sep


def warn(text: str) -> None:
    """A warning that names the line outside of this package from which the call came."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_HERE):
        level, frame = level + 1, frame.f_back
    warnings.warn(text, stacklevel=level)


def warn_found(bed: Any, packing: Packing, container: Container, codes: Collection[int]) -> None:
    """What the library says of a bed, of these codes."""
    found = (Found * len(_TEXTS))()
    for one in found[:library.fibrad_bed_warnings(bed, found)]:
        if one.code in codes:
            warn(_TEXTS[one.code].format(
                first=packing.names(one.first) if one.first < packing.n else "", axis="xyz"[one.first % 3],
                second=packing.names(one.second) if one.second < packing.n else "", count=one.count, value=one.value,
                wall=container.names[one.wall - 1] if one.wall else "surroundings", other=one.other,
                scale="0.001" if one.value > one.other else "1000",
                asked="; do triangles cut spheres?" if container.sides_count else ""))


def warn_metres(packing: Packing) -> None:
    """Radii that are hardly metres."""
    if packing.n and packing.r.mean() > _RADIUS_LARGE:
        warn(f"radii of {packing.r.mean():.4g} are taken as metres; 0.001 * x and 0.001 * r are for millimetres")
