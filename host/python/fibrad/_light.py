# _light.py - light from outside that falls on a bed. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import dataclasses
import math
from collections.abc import Iterable
from typing import Any, Optional, Sequence

import numpy as np
from numpy.typing import NDArray

from ._limits import HALF_ANGLE_MAX, LENGTH_MAX, LIGHT_DIRECTIONS_MAX, POWER_MAX, SUN_HALF_ANGLE
from ._structures import Light as LightStructure
from ._values import real, refuse, whole


@dataclasses.dataclass(frozen=True)
class Light:
    """Light from outside. Without `disc` and `box` it falls on all that is open.

    Attributes
    ----------
    direction
        (3,) the way that the light goes, of any length above 0.
    flux
        [W/m2] on a plane across the direction.
    half_angle
        [rad] of the cone of directions. 0: parallel.
    directions
        Directions of the cone. Default: 16, for cones wider than 0.02 rad as many for each solid angle.
    disc
        (4,) [m] x, y, z and radius of a disc across the direction, through which all of the light passes.
    box
        (4,) [m] x1, x2, y1 and y2 of a rectangle at the end of the bed in z, through which all of the light
        passes.
    SUN
        [rad] the half-angle of the sun.

    Examples
    --------
    >>> import fibrad
    >>> fibrad.Light((0, 0, -1), 1000.0, half_angle=fibrad.Light.SUN).flux
    1000.0
    """

    direction: Sequence[float]
    flux: float
    half_angle: float = 0.0
    directions: Optional[int] = None
    disc: Optional[Sequence[float]] = None
    box: Optional[Sequence[float]] = None

    SUN = SUN_HALF_ANGLE


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Absorbed:
    """What is absorbed of light. `spheres`, `walls`, `reflected` and `transmitted` add up to `incident`.

    Attributes
    ----------
    spheres, first, errors
        [W] (n,) absorbed by each sphere with all reflections, absorbed of the light that it meets first, and the
        estimated error of `spheres`.
    walls, walls_first
        [W] absorbed by each wall by name, and of the light that it meets first.
    incident
        [W] what all lights bring.
    transmitted
        [W] leaves without having met anything.
    reflected
        [W] leaves after reflections, on whichever side.
    error
        [W] estimated error of `reflected`.
    """

    spheres: NDArray[np.float64]
    first: NDArray[np.float64]
    errors: NDArray[np.float64]
    walls: dict[str, float]
    walls_first: dict[str, float]
    incident: float
    transmitted: float
    reflected: float
    error: float
    _patches: Any
    _of: Any

    def __repr__(self) -> str:
        return (f"<fibrad.Absorbed: {math.fsum(self.spheres):.6g} W by {len(self.spheres)} spheres, of "
                f"{self.incident:.6g} W; reflected {self.reflected:.6g} W, transmitted {self.transmitted:.6g} W>")


def _numbers(name: str, values: Sequence[float], count: int) -> list[float]:
    try:
        numbers = [float(value) for value in values]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) != count or not all(abs(number) <= LENGTH_MAX for number in numbers):
        raise refuse(f"{name} must be {count} finite numbers, not {values!r}")
    return numbers


def lights_of(lights: Any) -> Any:
    """The array of fibrad_light."""
    given = [lights] if isinstance(lights, Light) else list(lights) if isinstance(lights, Iterable) else [lights]
    if not all(isinstance(light, Light) for light in given):
        raise refuse(f"lights must be Light or several of them, not {lights!r}")
    array = (LightStructure * len(given))()
    for light, to in zip(given, array):
        direction = _numbers("direction", light.direction, 3)
        if not any(direction):
            raise refuse("the direction (0, 0, 0) leads nowhere")
        if light.disc is not None and light.box is not None:
            raise refuse("a light has one disc or one box")
        to.direction[:] = direction
        to.flux = real("flux", light.flux, 0, POWER_MAX)
        to.half_angle = real("half_angle", light.half_angle, 0, HALF_ANGLE_MAX)
        to.directions = whole("directions", light.directions, 1, LIGHT_DIRECTIONS_MAX)
        if light.disc is not None:
            disc = _numbers("disc", light.disc, 4)
            to.shape, to.centre[:], to.radius = 1, disc[:3], disc[3]
        if light.box is not None:
            box = _numbers("box", light.box, 4)
            to.shape, to.low[:], to.high[:] = 2, box[0::2], box[1::2]
    return array


def patches_pointer(absorbed: Absorbed) -> Any:
    return ctypes.cast(absorbed._patches, ctypes.POINTER(ctypes.c_double))
