# _heat.py - net radiative powers of a bed, step after step. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import dataclasses
import math
from collections.abc import Callable, Collection, Mapping
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._bed import Bed, heat_config
from ._call import Call, Progress
from ._library import HeatResult, HeatSources, library
from ._scene import Walls, pointer, pointers
from ._values import HOTTEST, STRONGEST, per_sphere, real, refuse

STEFAN_BOLTZMANN = 5.670374419e-8
"""W/(m2 K4)"""

_SETTLE_MAX, _EMISSIVITY_CHANGE = 100, 1e-5


def _law(emissivity: Union[ArrayLike, Callable[[Any], ArrayLike]]) -> Callable[[Any], ArrayLike]:
    if callable(emissivity):
        function: Callable[[Any], ArrayLike] = emissivity
        return function
    given: ArrayLike = emissivity
    return lambda found: given


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Powers:
    """Net powers [W], positive where heat is gained; all of them add up to 0. And temperatures."""

    spheres: NDArray[np.float64]
    """(n,) to each sphere."""
    walls: dict[str, float]
    """To each wall, by its name."""
    surroundings: float
    """To the surroundings."""
    temperatures: NDArray[np.float64]
    """(n,) of each sphere [K], given or found; NaN of emissivity 0."""
    wall_temperatures: dict[str, float]
    """Of each wall [K]; of an insulated one that at which it would emit what it sends back."""
    triangle_fluxes: dict[str, NDArray[np.float64]]
    """(t, 2) what front and back of each triangle of a `Mesh` gain [W/m2], by its name; NaN: nobody's, or not reached.
    Times areas they add up to `walls`, unless planes or the cylinder cut the mesh."""
    triangle_temperatures: dict[str, NDArray[np.float64]]
    """(t, 2) likewise [K]; of an insulated mesh place by place."""
    emissivities: NDArray[np.float64]
    """(n,) of each sphere, at its temperature."""
    errors: NDArray[np.float64]
    """(n,) estimated errors of `spheres` [W]."""
    wall_errors: dict[str, float]
    """Of `walls` [W]."""
    temperature_errors: NDArray[np.float64]
    """(n,) estimated errors of `temperatures` [K], 0 of those given."""
    error: float
    """Estimated error of the powers of spheres, root mean square."""
    error_patches: float
    """The part of the error that patches have."""
    error_beams: float
    """The part of the error that beams have."""
    residual: float
    """Of the radiosities, relative."""
    sweeps: int
    """Of the beams that the solution took."""

    @property
    def balance(self) -> float:
        """Sum of all powers [W]: 0 but for rounding."""
        return math.fsum([*self.spheres, *self.walls.values(), self.surroundings])

    def __repr__(self) -> str:
        known = self.temperatures[~np.isnan(self.temperatures)]
        range_of = f" of {known.min():.6g} to {known.max():.6g} K" if known.size else ""
        outside = "".join(f", {name} {power:.6g} W" for name, power in [*self.walls.items(), ("surroundings", self.surroundings)])
        return (f"<fibrad.Powers: {len(self.spheres)} spheres{range_of} {math.fsum(self.spheres):.6g} W{outside}; "
                f"error of a sphere {self.error:.2g} W>")


class Heat(Bed):
    """Radiation between grey diffuse spheres, walls and surroundings of given temperatures or powers.

    The beams between all surfaces are traced once; `solve` gives the net powers for any temperatures and emissivities,
    and starts from the last solution. Memory is freed by `close`, at the end of ``with``, or with the object. One
    thread at a time may use it.

    Parameters
    ----------
    x : (n, 3) array
        Centres [m].
    r : (n,) array or float
        Radii [m].
    box : (3,) array, optional
        Lengths of the periodic box [m]; 0 stands for an open axis. Default: open.
    walls : mapping or sequence of pairs, optional
        As of `view_factors`: ``{"zmin": 0.0, "cylinder": (x, y, radius)}``.
    directions : int, optional
        Of the beams, 8 to 65536. Default: 168.
    points : {64, 128, 256}, optional
        Beams per direction and sphere. Default: 64.
    patches : {24, 96, 384}, optional
        That the surface of a sphere is divided into. Default: 96.
    ids : (n,) array of whole numbers, optional
        Names of the spheres, for messages and the order among equals.
    threads, progress
        As of `view_factors`, for this and later calls.

    Examples
    --------
    >>> import fibrad
    >>> with fibrad.Heat([[0, 0, 0], [0, 0, 3]], 1.0) as heat:
    ...     powers = heat.solve([1000.0, 300.0], 0.8, surroundings=300.0)
    >>> bool(powers.spheres[0] < 0 < powers.spheres[1])
    True
    """

    _kind = "radiation"

    def __init__(self, x: ArrayLike, r: ArrayLike, *, box: Optional[ArrayLike] = None, walls: Optional[Walls] = None,
                 directions: Optional[int] = None, points: Optional[int] = None, patches: Optional[int] = None,
                 ids: Optional[ArrayLike] = None, threads: Optional[int] = None, progress: Optional[Progress] = None):
        super().__init__(x, r, box, walls, ids, heat_config(directions, points, patches), Call(threads, progress))

    def solve(self, temperature: Optional[ArrayLike], emissivity: Union[ArrayLike, Callable[[Any], ArrayLike]], *,
              power: Optional[ArrayLike] = None, surroundings: Optional[float] = None, wall_temperature: Any = None,
              wall_emissivity: Any = None, wall_power: Optional[Mapping[str, float]] = None,
              insulated: Collection[str] = (), tolerance: Optional[float] = None, uniform: bool = False,
              sigma: float = STEFAN_BOLTZMANN) -> Powers:
        """Net powers, and the temperatures of spheres and walls whose powers are given.

        Parameters
        ----------
        temperature : (n,) array or float
            Of the spheres [K]; NaN: unknown, which needs `power`. None: of all.
        emissivity : (n,) array, float or function
            Of the spheres, 0 to 1; 0 reflects all. A function gets the temperatures (n,) and returns emissivities;
            it is asked again until they change no more.
        power : (n,) array or float, optional
            What spheres of unknown temperature give off from inside [W]; their net power is its negative. NaN where
            a temperature is given. One number is for those without a temperature.
        surroundings : float
            Temperature of the surroundings [K]; may be left out only where walls and periods leave no way out.
        wall_temperature : mapping or float
            Temperatures of the walls [K] by their names, or of all others; needed where there are walls. Of a `Mesh`
            also an array (t,), one for each triangle.
        wall_emissivity : mapping or float
            Emissivities of the walls by their names, or of all, 0 to 1; needed where there are walls.
        wall_power : mapping, optional
            What walls of unknown temperature give off [W], by their names.
        insulated : names, optional
            Walls that send back all that arrives, place by place.
        tolerance : float, optional
            Residual at which to stop, relative to the differences of emission. Default: 1e-3, or 1e-5 where
            temperatures are unknown.
        uniform : bool
            One radiosity for each sphere and wall; wrong but for emissivities near 1.
        sigma : float
            Emission is ``sigma T**4``; another value for other units.

        Returns
        -------
        Powers

        Raises
        ------
        InputError
            Also where no temperatures give the powers.
        StateError, OutOfMemory
        """
        container, names, n = self._container, self._packing.names, self.n
        kelvins = per_sphere("temperature", math.nan if temperature is None else temperature, n, 0, HOTTEST, names,
                             power is not None)
        powers = None if power is None else per_sphere("power", power, n, -STRONGEST, STRONGEST, names, True)
        if powers is not None and np.any(powers) and n and not np.isnan(kelvins).any():
            raise refuse("power is given, and all spheres have temperatures; NaN is an unknown one")
        if powers is not None and np.ndim(power) == 0:
            powers = np.where(np.isnan(kelvins), powers, math.nan)
        of_bodies = self._walls(wall_temperature, wall_emissivity, wall_power, insulated)
        if surroundings is None and not container.closed():
            raise refuse("surroundings is missing: the temperature [K] of what radiation meets that leaves the bed")
        law = _law(emissivity)
        shares = per_sphere("emissivity", law(np.where(np.isnan(kelvins), surroundings or 300., kelvins)), n, 0, 1, names)
        sources = HeatSources(surroundings=real("surroundings", surroundings, 0, HOTTEST),
                              sigma=real("sigma", sigma, 1e-30, 1e30), tolerance=real("tolerance", tolerance, 0, 1),
                              uniform=bool(uniform), temperature=pointer(kelvins), power=pointer(powers),
                              **pointers(of_bodies))
        of_spheres = {name: np.zeros(n) for name in ("power", "temperature", "power_error", "temperature_error")}
        of_walls = {name: np.zeros(len(container.names)) for name in ("body_power", "body_temperature", "body_error")}
        result = HeatResult(**{name: pointer(array) for name, array in (of_spheres | of_walls).items()})
        for _ in range(_SETTLE_MAX):
            sources.emissivity = pointer(shares)
            self._use(library.fibrad_radiation_solve, self._packing, sources, result)
            before, known = shares, np.isfinite(of_spheres["temperature"])
            shares = per_sphere("emissivity", law(np.where(known, of_spheres["temperature"], kelvins)), n, 0, 1, names)
            if np.max(np.abs(shares - before)[known], initial=0) <= _EMISSIVITY_CHANGE:
                break
        else:
            raise refuse("the emissivities do not settle")
        if surroundings is None and result.surroundings_power != 0:
            raise refuse(f"{result.surroundings_power} W leave the bed after 100 periods: surroundings is needed")
        sides = np.full((2, container.sides_count), math.nan)
        if sides.size:
            self._use(library.fibrad_radiation_sides, self._packing, pointer(sides[0]), pointer(sides[1]))
        walls = {name: dict(zip(container.names, array.tolist())) for name, array in of_walls.items()}
        return Powers(spheres=of_spheres["power"], walls=walls["body_power"], surroundings=result.surroundings_power,
                      temperatures=of_spheres["temperature"], wall_temperatures=walls["body_temperature"],
                      triangle_fluxes=container.by_mesh(sides[0]), triangle_temperatures=container.by_mesh(sides[1]),
                      emissivities=before, errors=of_spheres["power_error"], wall_errors=walls["body_error"],
                      temperature_errors=of_spheres["temperature_error"],
                      error=math.hypot(result.error_patches, result.error_beams), error_patches=result.error_patches,
                      error_beams=result.error_beams, residual=result.residual, sweeps=result.sweeps)
