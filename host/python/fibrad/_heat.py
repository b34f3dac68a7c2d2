# _heat.py - net radiative powers of a bed, step after step. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import dataclasses
import math
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._bed import Bed, heat_config
from ._call import Call, Progress
from ._contacts import contacts_of
from ._library import library
from ._light import Absorbed, Light, add, lights_of, patches_pointer
from ._scene import Walls, pointer, pointers
from ._limits import POWER_MAX, SIGMA, TEMPERATURE_MAX
from ._structures import HeatResult, HeatSources, LightResult, LightSources
from ._values import per_sphere, real, refuse, several
from ._warnings import warn_around, warn_surfaces, warn_temperatures

STEFAN_BOLTZMANN = 5.670374419e-8
"""[W/(m2 K4)]"""

_SETTLE_MAX, _EMISSIVITY_CHANGE = 100, 1e-5

_OF_SPHERES = ("power", "temperature", "power_error", "temperature_error", "least_temperature", "largest_temperature",
               "centre_temperature", "surface_error", "centre_error", "conducted")


def _law(emissivity: Union[ArrayLike, Callable[[Any], ArrayLike]]) -> Callable[[Any], ArrayLike]:
    if callable(emissivity):
        function: Callable[[Any], ArrayLike] = emissivity
        return function
    given: ArrayLike = emissivity
    return lambda found: given


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Powers:
    """Net powers and temperatures. A net power is above 0 where heat is gained. All net powers add up to 0.

    Attributes
    ----------
    spheres
        [W] (n,) net power of each sphere.
    walls
        [W] net power of each wall by name.
    surroundings
        [W] net power of the surroundings.
    temperatures
        [K] (n,) temperature of each sphere, given or found. NaN if the emissivity is 0.
    wall_temperatures
        [K] temperature of each wall by name. For an insulated wall: the fourth root of its mean T**4.
    triangle_fluxes
        [W/m2] (t, 2) net power per area of front and back of each triangle, by the name of the `Mesh`. NaN: the
        side belongs to no wall, or nothing reaches it. Fluxes times areas add up to `walls`, unless a plane or
        the cylinder cuts the mesh.
    triangle_temperatures
        [K] (t, 2) temperature of front and back of each triangle, by the name of the `Mesh`.
    emissivities
        (n,) emissivity of each sphere, at its temperature.
    errors
        [W] (n,) estimated error of `spheres`.
    wall_errors
        [W] estimated error of `walls`, by name.
    surroundings_error
        [W] estimated error of `surroundings`.
    temperature_errors
        [K] (n,) estimated error of `temperatures`, 0 if the temperature was given.
    least_temperatures
        [K] (n,) least temperature of the surface of each sphere. `temperatures` if the sphere does not conduct.
    largest_temperatures
        [K] (n,) largest temperature of the surface of each sphere, likewise.
    centre_temperatures
        [K] (n,) temperature in the centre of each sphere, likewise.
    surface_errors
        [K] (n,) estimated error of `least_temperatures` and `largest_temperatures`.
    centre_errors
        [K] (n,) estimated error of `centre_temperatures`.
    conducted
        [W] (n,) part of `spheres` that comes through contacts. The rest is radiation.
    wall_conducted
        [W] part of `walls` that comes through contacts, by name.
    contact_flows
        [W] (m,) what each contact conducts from i to j.
    error
        [W] estimated error of `spheres`, root mean square.
    error_patches
        [W] part of `error` that comes from patches.
    error_beams
        [W] part of `error` that comes from beams.
    residual
        Residual of the radiosities, relative to the differences of emission.
    sweeps
        Sweeps over the beams that the solution took.
    """

    spheres: NDArray[np.float64]
    walls: dict[str, float]
    surroundings: float
    temperatures: NDArray[np.float64]
    wall_temperatures: dict[str, float]
    triangle_fluxes: dict[str, NDArray[np.float64]]
    triangle_temperatures: dict[str, NDArray[np.float64]]
    emissivities: NDArray[np.float64]
    errors: NDArray[np.float64]
    wall_errors: dict[str, float]
    surroundings_error: float
    temperature_errors: NDArray[np.float64]
    least_temperatures: NDArray[np.float64]
    largest_temperatures: NDArray[np.float64]
    centre_temperatures: NDArray[np.float64]
    surface_errors: NDArray[np.float64]
    centre_errors: NDArray[np.float64]
    conducted: NDArray[np.float64]
    wall_conducted: dict[str, float]
    contact_flows: NDArray[np.float64]
    error: float
    error_patches: float
    error_beams: float
    residual: float
    sweeps: int

    @property
    def balance(self) -> float:
        """[W] sum of all net powers: 0, to rounding."""
        return math.fsum([*self.spheres, *self.walls.values(), self.surroundings])

    def __repr__(self) -> str:
        known = self.temperatures[~np.isnan(self.temperatures)]
        range_of = f" of {known.min():.6g} to {known.max():.6g} K" if known.size else ""
        outside = "".join(f", {name} {power:.6g} W" for name, power in [*self.walls.items(), ("surroundings", self.surroundings)])
        return (f"<fibrad.Powers: {len(self.spheres)} spheres{range_of} {math.fsum(self.spheres):.6g} W{outside}; "
                f"error of a sphere {self.error:.2g} W>")


class Heat(Bed):
    """Radiation between grey diffuse spheres, walls and surroundings.

    Each sphere and wall has a given temperature, or it gives off a given power and its temperature is found. The beams
    between all surfaces are traced once. `solve` then gives net powers and temperatures for any sources. A solution
    begins with the last one. The memory is freed by `close`, at the end of ``with``, or with the object. One thread at
    a time may use the object.

    Parameters
    ----------
    x : (n, 3) array
        [m] Centres.
    r : (n,) array or float
        [m] Radii.
    box : (3,) array, optional
        [m] Lengths of the periodic box. 0: the axis is open. Default: all axes are open.
    walls : mapping or sequence of pairs, optional
        As for `view_factors`: ``{"zmin": 0.0, "cylinder": (x, y, radius)}``.
    directions : int, optional
        Directions of beams from each sphere, 8 to 65536. Default: 168.
    points : {64, 128, 256}, optional
        Points of each beam. Default: 64.
    patches : {24, 96, 384}, optional
        Patches of the surface of each sphere. Default: 96.
    ids : (n,) array of whole numbers, optional
        Names of the spheres, from 0. Messages use them. They decide ties.
    threads, progress
        As for `view_factors`. They are kept for later calls.

    Examples
    --------
    >>> import fibrad
    >>> with fibrad.Heat([[0, 0, 0], [0, 0, 0.03]], 0.01) as heat:
    ...     powers = heat.solve([1000.0, 300.0], 0.8, surroundings=300.0)
    >>> bool(powers.spheres[0] < 0 < powers.spheres[1])
    True
    """

    _kind = "radiation"

    def __init__(self, x: ArrayLike, r: ArrayLike, *, box: Optional[ArrayLike] = None, walls: Optional[Walls] = None,
                 directions: Optional[int] = None, points: Optional[int] = None, patches: Optional[int] = None,
                 ids: Optional[ArrayLike] = None, threads: Optional[int] = None, progress: Optional[Progress] = None):
        super().__init__(x, r, box, walls, ids, heat_config(directions, points, patches), Call(threads, progress))

    def shine(self, lights: Union[Light, Iterable[Light]], absorptivity: ArrayLike, *, wall_absorptivity: Any = None) -> Absorbed:
        """What spheres and walls absorb of light from outside.

        Parameters
        ----------
        lights : Light or several
            What shines on the bed.
        absorptivity : (n,) array or float
            Absorptivities of the spheres for the light, 0 to 1. The rest is reflected.
        wall_absorptivity : mapping or float
            Absorptivities of the walls by name, or one for all, 0 to 1. Needed with walls.

        Returns
        -------
        Absorbed
            Hand it to `solve`. It is valid until the next `shine` or `move`.

        Raises
        ------
        InputError
            A value is out of its range, or no open face lets a light in.
        """
        container, names, n = self._container, self._packing.names, self.n
        shares = per_sphere("absorptivity", absorptivity, n, 0, 1, names)
        of_walls = container.per_wall("wall_absorptivity", wall_absorptivity, 0, 1, frozenset())
        array = lights_of(lights)
        arrays = {name: np.zeros(n) for name in ("absorbed", "absorbed_first", "absorbed_error")}
        arrays |= {name: np.zeros(len(container.names)) for name in ("wall_absorbed", "wall_absorbed_first")}
        sources = LightSources(light=array, lights=len(array), absorptivity=pointer(shares),
                               wall_absorptivity=pointer(of_walls))
        result = LightResult(**{name: pointer(values) for name, values in arrays.items()})
        self._use(library.fibrad_radiation_shine, self._packing, sources, result)
        walls = {name: dict(zip(container.names, arrays[name].tolist())) for name in ("wall_absorbed", "wall_absorbed_first")}
        return Absorbed(spheres=arrays["absorbed"], first=arrays["absorbed_first"], errors=arrays["absorbed_error"],
                        walls=walls["wall_absorbed"], walls_first=walls["wall_absorbed_first"], incident=result.incident,
                        transmitted=result.transmitted, reflected=result.reflected, error=result.error,
                        _patches=result.patches, _of=self)

    def solve(self, temperature: Optional[ArrayLike], emissivity: Union[ArrayLike, Callable[[Any], ArrayLike]], *,
              power: Optional[ArrayLike] = None, surroundings: Optional[float] = None, wall_temperature: Any = None,
              wall_emissivity: Any = None, wall_power: Optional[Mapping[str, float]] = None,
              insulated: Collection[str] = (), tolerance: Optional[float] = None,
              sigma: float = STEFAN_BOLTZMANN, light: Optional[Absorbed] = None,
              conductivity: Optional[ArrayLike] = None, contacts: Any = None) -> Powers:
        """Net powers and temperatures.

        Parameters
        ----------
        temperature : (n,) array or float
            [K] Temperatures of the spheres. NaN: the temperature is unknown, and `power` is needed. None: all are
            unknown.
        emissivity : (n,) array, float or function
            Emissivities of the spheres, 0 to 1. 0 reflects everything. A function gets the temperatures (n,) and
            returns the emissivities. It is called until the emissivities change by at most 1e-5.
        power : (n,) array or float, optional
            [W] Power that a sphere of unknown temperature gives off from inside. Its net power is the negative. NaN
            where the temperature is given. One number holds for all spheres of unknown temperature.
        surroundings : float
            [K] Temperature of the surroundings. May be left out only if walls and periods close the bed on all sides.
        wall_temperature : mapping or float
            [K] Temperatures of the walls by name, or one for all others. Needed with walls. For a `Mesh` it may be an
            array (t,), one value for each triangle.
        wall_emissivity : mapping or float
            Emissivities of the walls by name, or one for all, 0 to 1. Needed with walls.
        wall_power : mapping, optional
            [W] Power that a wall of unknown temperature gives off, by name.
        insulated : names, optional
            Walls that send back all that arrives, point by point.
        tolerance : float, optional
            Residual at which to stop, relative to the differences of emission. Default: 1e-3, or 1e-5 if a temperature
            is unknown.
        sigma : float
            [W/(m2 K4)] Emission is ``sigma T**4``.
        light : Absorbed, optional
            The last `shine` of this bed. Absorbed light heats. Net powers are those of light and thermal radiation
            together.
        conductivity : (n,) array or float, optional
            [W/(m K)] Conductivities of the solid, above 0. Temperatures of spheres are then means of their surfaces.
            Infinite: the sphere has one temperature. Default: all do.
        contacts : (i, j, conductance) or SciPy matrix, optional
            [W/K] What conducts heat between spheres i and j. j may also be the name of a wall, in a list. Several
            contacts may join the same spheres. Of a matrix (n, n), which is symmetric, each element above the diagonal
            is a contact. `contacts` finds them by overlaps. On spheres of finite `conductivity` they act at their
            places.

        Returns
        -------
        Powers

        Raises
        ------
        InputError
            A value is out of its range, no temperatures give the powers, or the emissivities do not settle.
        StateError
            The object is closed, or another thread uses it.
        OutOfMemory, Cancelled
            As for `view_factors`.
        """
        container, names, n = self._container, self._packing.names, self.n
        kelvins = per_sphere("temperature", math.nan if temperature is None else temperature, n, 0, TEMPERATURE_MAX, names,
                             power is not None)
        warn_temperatures(self._packing, kelvins)
        powers = None if power is None else per_sphere("power", power, n, -POWER_MAX, POWER_MAX, names, True)
        if powers is not None and np.any(powers) and n and not np.isnan(kelvins).any():
            raise refuse("power is given, and all spheres have temperatures; NaN is an unknown one")
        if power is not None and powers is not None and np.ndim(power) == 0:
            powers = np.where(np.isnan(kelvins), powers, math.nan)
        conducts = None if conductivity is None else per_sphere("conductivity", conductivity, n, 5e-324, math.inf, names)
        insulated = several("insulated", insulated)
        given_walls = self._walls(wall_temperature, wall_emissivity, wall_power, insulated)
        if light is not None:
            if not isinstance(light, Absorbed):
                raise refuse(f"light must be what shine returns, not {light!r}")
            if light._of is not self:
                raise refuse("light is of another bed")
            powers = add(powers, light.spheres)
            walls_absorb = np.array([0.0 if wall in insulated else light.walls[wall] for wall in container.names])
            given_walls["wall_power"] = add(given_walls.get("wall_power"), walls_absorb)
        if surroundings is None and not container.closed():
            raise refuse("surroundings is missing: the temperature [K] of what radiation meets that leaves the bed")
        law = _law(emissivity)
        shares = per_sphere("emissivity", law(np.where(np.isnan(kelvins), surroundings or 300., kelvins)), n, 0, 1, names)
        sources = HeatSources(surroundings=real("surroundings", surroundings, 0, TEMPERATURE_MAX),
                              sigma=real("sigma", sigma, *SIGMA), tolerance=real("tolerance", tolerance, 0, 1),
                              temperature=pointer(kelvins), power=pointer(powers),
                              conductivity=pointer(conducts),
                              **pointers(given_walls))
        warn_around(container, surroundings, given_walls["wall_temperature"], kelvins)
        if light is not None:
            sources.absorbed = patches_pointer(light)
        joined = contacts_of(((), (), ()) if contacts is None else contacts, n, container)
        flows = np.zeros(joined.conductance.size)
        sources.contacts, sources.conductance = joined.conductance.size, pointer(joined.conductance)
        ends = ctypes.POINTER(ctypes.c_uint32)
        sources.contact_first, sources.contact_second = pointer(joined.first, ends), pointer(joined.second, ends)
        of_spheres = {name: np.zeros(n) for name in _OF_SPHERES}
        of_walls = {name: np.zeros(len(container.names)) for name in ("wall_power", "wall_temperature", "wall_error",
                                                                            "wall_conducted")}
        result = HeatResult(**{name: pointer(array) for name, array in (of_spheres | of_walls).items()})
        result.contact_flow = pointer(flows)
        for _ in range(_SETTLE_MAX):
            sources.emissivity = pointer(shares)
            self._use(library.fibrad_radiation_solve, self._packing, sources, result)
            before, known = shares, np.isfinite(of_spheres["temperature"])
            shares = per_sphere("emissivity", law(np.where(known, of_spheres["temperature"], kelvins)), n, 0, 1, names)
            if np.max(np.abs(shares - before)[known], initial=0) <= _EMISSIVITY_CHANGE:
                break
        else:
            raise refuse("the emissivities do not settle")
        if light is not None:
            of_spheres["power"] += light.spheres
            of_walls["wall_power"] += walls_absorb
            result.surroundings_power += light.reflected + light.transmitted - light.incident
        if surroundings is None and result.surroundings_power != 0:
            raise refuse(f"{result.surroundings_power} W leave the bed after 100 periods: surroundings is needed")
        if conducts is not None:
            warn_surfaces(self._packing, of_spheres["least_temperature"])
        sides = np.full((2, container.sides_count), math.nan)
        if sides.size:
            self._use(library.fibrad_radiation_sides, self._packing, pointer(sides[0]), pointer(sides[1]))
        walls = {name: dict(zip(container.names, array.tolist())) for name, array in of_walls.items()}
        return Powers(spheres=of_spheres["power"], walls=walls["wall_power"], surroundings=result.surroundings_power,
                      temperatures=of_spheres["temperature"], wall_temperatures=walls["wall_temperature"],
                      triangle_fluxes=container.by_mesh(sides[0]), triangle_temperatures=container.by_mesh(sides[1]),
                      emissivities=before, errors=of_spheres["power_error"], wall_errors=walls["wall_error"],
                      surroundings_error=result.surroundings_error,
                      temperature_errors=of_spheres["temperature_error"],
                      least_temperatures=of_spheres["least_temperature"],
                      largest_temperatures=of_spheres["largest_temperature"],
                      centre_temperatures=of_spheres["centre_temperature"], surface_errors=of_spheres["surface_error"],
                      centre_errors=of_spheres["centre_error"], conducted=of_spheres["conducted"],
                      wall_conducted=walls["wall_conducted"], contact_flows=flows,
                      error=math.hypot(result.error_patches, result.error_beams), error_patches=result.error_patches,
                      error_beams=result.error_beams, residual=result.residual, sweeps=result.sweeps)
