# _bed.py - a bed, and what is asked of it. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import math
import threading
import weakref
from collections.abc import Collection, Iterable, Sequence
from typing import Any, NoReturn, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._call import Call, Progress
from ._contacts import Contacts, rule_of, take_contacts
from ._errors import StateError
from ._factors import Factors, Folder, Owner, Rule, take_factors
from ._heat import STEFAN_BOLTZMANN, Advance, Emissivity, GasFlow, Powers, Sources, Store, power_of, stores_of
from ._library import library
from ._light import Absorbed, Light, lights_of, patches_pointer
from ._limits import DIRECTIONS, DURATION_MAX, PATCHES, POINTS, POWER_MAX, TEMPERATURE_MAX
from ._scene import WHOLE, Packing, pointer
from ._structures import ContactList, Fault, HeatConfig, HeatResult, LightResult, LightSources, Span
from ._values import per_sphere, real, refuse, whole
from ._walls import Container, Walls
from ._warnings import PLACES, ROWS, SOURCES, warn, warn_found, warn_metres

_OF_SPHERES = ("power", "temperature", "power_error", "temperature_error", "least_temperature", "largest_temperature",
               "centre_temperature", "surface_error", "centre_error", "conducted", "convected")
_OF_WALLS = ("wall_power", "wall_temperature", "wall_error", "wall_conducted", "wall_convected")


def _choice(name: str, value: Optional[int], choices: tuple[int, ...]) -> int:
    if value is not None and value not in choices:
        raise refuse(f"{name} = {value} is none of {', '.join(map(str, choices))}")
    return value or 0


def _free(handle: ctypes.c_void_p) -> None:
    library.fibrad_bed_free(handle)
    handle.value = None


class Bed:
    """A bed of spheres, its walls and its periodic box. Scene, beams and lists of contacts are made when they are first
    needed, and kept. `close`, the end of ``with`` or the end of the object frees the memory. One thread at a time may
    use the object.

    Parameters
    ----------
    x : (n, 3) array
        [m] Centres. Factors alone may have any unit L of length.
    r : (n,) array or float
        [m] Radii. x and r are not copied if they are of float64 and their strides are whole numbers of float64.
    box : (3,) array, optional
        [m] Lengths of the periodic box. 0: the axis is open. Default: all axes are open.
    walls : str, `wall`, or several of them, optional
        ``"zmin:temperature=1200:emissivity=0.8,zmax:open"`` or ``fibrad.wall("zmin", temperature=1200)``. A later wall
        replaces an earlier one of the same name. Default: no walls.
    ids : (n,) array of whole numbers, optional
        Names of the spheres, from 0. Messages use them. They seed random paths and decide ties.
    clump : (n,) array of whole numbers, optional
        Numbers of clumps, from 1. Spheres of one number are one body and may lie within one another. 0: the sphere is
        alone. Default: there are no clumps.
    threads : int, optional
        1 to 1024. Changes no bit. Default: ``OMP_NUM_THREADS``, or else all processors.
    progress : callable, optional
        Called as ``progress(stage, done, total)`` up to 20 times a second. If it returns something true, the call ends
        with `Cancelled`.

    Raises
    ------
    InputError
        A value is out of its range, or the spheres overlap too much. The attribute ``spheres`` has those at fault. All
        methods raise it.
    StateError
        The object is closed, or another thread uses it. All methods raise it.
    OutOfMemory, Cancelled
        There is no more memory, or the progress function has asked to stop. All methods raise them.

    Examples
    --------
    >>> import fibrad
    >>> with fibrad.Bed([[0, 0, 0], [0, 0, 0.03]], 0.01) as bed:
    ...     powers = bed.solve([1000.0, 300.0], 0.8, surroundings=300.0)
    ...     end = bed.advance([1000.0, 300.0], 60.0, capacity=10.0, emissivity=0.8, surroundings=300.0)
    >>> bool(powers.spheres[0] < 0 < powers.spheres[1] and end.temperatures[0] < 1000)
    True
    """

    def __init__(self, x: ArrayLike, r: ArrayLike, *, box: Optional[ArrayLike] = None, walls: Optional[Walls] = None,
                 ids: Optional[ArrayLike] = None, clump: Optional[ArrayLike] = None, threads: Optional[int] = None,
                 progress: Optional[Progress] = None):
        self._packing = Packing(x, r, ids, clump)
        self._container = Container(box, walls, self._packing)
        self._call = Call(threads, progress)
        self._busy = threading.Lock()
        self._told = False  # of metres
        self._handle = ctypes.c_void_p()
        self._free = weakref.finalize(self, _free, self._handle)
        status = self._call(library.fibrad_bed_new, self._handle, self._container.config, self._packing.spheres,
                            self._call.run)
        if status:
            raise self._container.error(self._packing, status, self._call.run.fault)
        self._warn(PLACES)

    def _warn(self, codes: Collection[int]) -> None:
        warn_found(self._handle, self._packing, self._container, codes)

    def _use(self, function: Any, *arguments: Any, packing: Optional[Packing] = None,
             container: Optional[Container] = None) -> None:
        if not self._busy.acquire(blocking=False):
            raise StateError("this Bed is in use by another call; one thread at a time may use it")
        try:
            if not self._handle:
                raise StateError("this Bed is closed")
            status = self._call(function, self._handle, *arguments)
            if status:
                fault = Fault()
                library.fibrad_bed_describe(self._handle, None, fault)
                raise (container or self._container).error(packing or self._packing, status, fault)
        finally:
            self._busy.release()

    def _area_of(self, wall: int) -> float:
        return float(library.fibrad_bed_wall_area(self._handle, wall))

    def _areas(self) -> NDArray[np.float64]:
        return 4 * math.pi * self._packing.r**2 if self._packing.clump is None else self.surfaces()[0]

    def __repr__(self) -> str:
        r = self._packing.r
        radii = f" of radius {r.min():.6g} to {r.max():.6g}" if self.n else ""
        box = ", box ({:.6g}, {:.6g}, {:.6g})".format(*self._container.period) if self._container.period.any() else ""
        walls = ", ".join(["", *self._container.names])
        return f"<fibrad.Bed: {self.n} spheres{radii}{box}{walls}{'' if self._handle else ', closed'}>"

    def __reduce__(self) -> NoReturn:
        raise TypeError("a Bed cannot be pickled or copied: it is memory of the library. Pickle its arrays and its results")

    @property
    def n(self) -> int:
        """Number of spheres."""
        return self._packing.n

    def move(self, x: ArrayLike, r: Optional[ArrayLike] = None, *, box: Optional[ArrayLike] = None,
             walls: Optional[Walls] = None) -> None:
        """Goes on with the same spheres and walls at other positions. If this is refused, the last bed stays in use.

        Parameters
        ----------
        x : (n, 3) array
            [m] Centres.
        r : (n,) array or float, optional
            [m] Radii. Default: the present ones.
        box, walls : optional
            As at the beginning, with the same names. Default: the present ones.
        """
        if np.shape(x)[:1] != (self.n,):
            raise refuse(f"x has the shape {np.shape(x)}; this Bed has {self.n} spheres")
        packing = Packing(x, self._packing.r if r is None else r, self._packing.ids, self._packing.clump)
        container = Container(self._container.period if box is None else box,
                              self._container.all if walls is None else walls, packing)
        kinds = [[*one.names, *(f"{name} open" for name in sorted(one.opened))] for one in (container, self._container)]
        if kinds[0] != kinds[1]:
            now, before = (", ".join(names) or "none" for names in kinds)
            raise refuse(f"the walls are {now}; they were {before}")
        self._use(library.fibrad_bed_move, container.config, packing.spheres, packing=packing, container=container)
        self._packing, self._container = packing, container
        self._warn(PLACES)

    def surfaces(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """[L^2] and [L^3] (n,) areas and volumes of the spheres. The area of a member of a clump is what no other member
        hides. The volume of a clump, counted once, is shared out among its members in proportion to ``r**3``."""
        area, volume = np.zeros(self.n), np.zeros(self.n)
        self._use(library.fibrad_bed_surfaces, pointer(area), pointer(volume))
        return area, volume

    def close(self) -> None:
        """Frees the memory. The object cannot be used afterwards."""
        if not self._busy.acquire(blocking=False):
            raise StateError("this Bed is in use by another call")
        self._free()
        self._busy.release()

    def __enter__(self) -> Bed:
        return self

    def __exit__(self, *exception: Any) -> None:
        self.close()

    def factors(self, *, emissivity: Optional[ArrayLike] = None, k_star: Optional[ArrayLike] = None,
                tolerance: Optional[float] = None, directions: Optional[int] = None, method: str = "beam",
                rays: Optional[int] = None, paths: Optional[int] = None, seed: Optional[int] = None,
                cutoff: Optional[float] = None, wanted: Optional[ArrayLike] = None, raw: bool = False, drop: float = 0.0,
                scratch: Optional[Folder] = None) -> Factors:
        """View factors between all spheres, or exchange factors if emissivities are given. View factors of clumps have
        one row and one column for each body (`Factors.body`). Exchange factors of clumps are not computed.

        An exchange factor D_ij is the fraction of the emission of sphere i that sphere j absorbs, directly or after
        diffuse reflections. The net power of sphere i is ``sum_j A_i e_i D_ij sigma (T_j**4 - T_i**4)``, where j counts
        walls and surroundings, too. With ``k_star`` the spheres conduct, and temperatures differ from point to point on
        each sphere. D_ij is then between nodes of emissivities n_i, `Factors.node_emissivity`. The net power is ``q_i =
        sum_j A_i n_i D_ij (N_j - N_i)`` with ``N_i = sigma T_i**4 - (1 / n_i - 1 / e_i) q_i / A_i`` and the mean
        temperature T_i of the surface. This is a linear system. Walls and surroundings have ``N = sigma T**4``.

        Parameters
        ----------
        emissivity : (n,) array or float, optional
            Emissivities of the spheres, 0 to 1. Those of walls are keys of the walls. Default: view factors.
        k_star : (n,) array or float, optional
            Relative conductivities of the spheres, ``k_s / (4 d sigma T**3)``, at least 1e-6, inf for one temperature.
            Default: each sphere has one temperature.
        tolerance : float, optional
            The error allowed in every row. Directions and paths are added until it is met. Default: none.
        directions : int, optional
            Directions of beams, 8 to 65536. The error falls as ``directions**-1.5``. Default: 233. If all rows of a bed
            are averaged, it is the number of lines, up to 1024. Default: 181, among walls 233, and more for few spheres.
            Of exchange factors: of the way to the first surface. Default: 50.
        method : {"beam", "cast", "mc"}
            View factors by parallel beams, by quasi-random rays or by random rays.
        rays : int, optional
            For "cast" and "mc": rays from each sphere. Default: 20000.
        paths : int, optional
            Of exchange factors: paths that follow the reflections. Default: 400.
        seed : int, optional
            Of random numbers. Default: 0.
        cutoff : float, optional
            [L] Spheres with centres farther apart do not see each other. Default: none.
        wanted : (n,) bool array or positions, optional
            Rows that are wanted. The other rows are empty, and the wanted rows are raw. Default: all.
        raw : bool
            True: rows as they were computed. False: averaged, so that ``A_i F_ij = A_j F_ji``, and closed.
        drop : float
            0 to 1. Pairs of entries are dropped if both are below this. The other entries are enlarged, so that the
            sums of the rows stay.
        scratch : path, optional
            A folder for files that hold rows and matrix, for matrices larger than memory. The files have no names and
            vanish with the result. Changes no bit. Default: in memory.
        """
        values = {"directions": directions, "rays": rays, "paths": paths, "seed": seed}
        rule = Rule(self._packing, self._container, method, emissivity, k_star, values, tolerance, cutoff, wanted, raw,
                    drop, scratch)
        owner = Owner()
        self._use(library.fibrad_bed_factors, rule.c, ctypes.byref(owner.factors))
        factors = take_factors(owner, self._container.names, self._packing.ids, rule.nodes)
        self._warn(ROWS)
        if tolerance is not None and factors.error.max(initial=0) > tolerance:
            warn(f"the estimated error is {factors.error.max():.3g}, above the tolerance of {tolerance:g}: no more "
                 "directions or paths are possible")
        return factors

    def beams(self, *, directions: Optional[int] = None, points: Optional[int] = None,
              patches: Optional[int] = None) -> None:
        """How finely `solve`, `shine` and `advance` resolve heat from now on. Traces the beams.

        Parameters
        ----------
        directions : int, optional
            Directions of beams from each sphere, 8 to 65536. Default: 168.
        points : {64, 128, 256}, optional
            Points of each beam. Default: 64.
        patches : {24, 96, 384}, optional
            Patches of the surface of each sphere. Default: 96.
        """
        self._use(library.fibrad_bed_beams, HeatConfig(
            directions=whole("directions", directions, *DIRECTIONS), points=_choice("points", points, POINTS),
            patches=_choice("patches", patches, PATCHES)))

    def contacts(self, *, spots: Optional[str] = "lens", conductivity: Optional[ArrayLike] = None,
                 scale: Optional[float] = None, gas_conductivity: Optional[float] = None, gas_gap: float = 0.65,
                 gas_jump: float = 0.0, gas_alone: bool = False) -> Contacts:
        """Contacts of spheres with each other and with walls, and what they conduct.

        Parameters
        ----------
        spots : {"lens", "hertz"}, optional
            Radius a of the spot of two spheres that overlap: that of the circle in which they cut each other, or
            Hertz's. None: only gas conducts.
        conductivity : (n,) array or float, optional
            [W/(m K)] Conductivities k of the solid. A spot conducts 2 k a, to a wall 4 k a. Needed unless `spots` is
            None and `gas_alone` is True.
        scale : float, optional
            Multiplies the radii of spots. Default: 1.
        gas_conductivity : float, optional
            [W/(m K)] Of the gas in narrow gaps. Default: no gas conducts.
        gas_gap : float
            Gas conducts out to this distance from the smaller sphere, in its radii, 0 to 1.
        gas_jump : float
            [m] Length added to gaps, since narrow gaps conduct less.
        gas_alone : bool
            True: lines through gas have no resistance in the solid.
        """
        rule = rule_of(spots, conductivity, scale, gas_gap, gas_jump, gas_alone, gas_conductivity is not None)
        found = ctypes.POINTER(ContactList)()
        self._use(library.fibrad_bed_contacts, rule, ctypes.byref(found))
        return take_contacts(found, rule, conductivity, gas_conductivity, self._packing)

    def shine(self, lights: Union[Light, Iterable[Light]], absorptivity: ArrayLike) -> Absorbed:
        """What spheres and walls absorb of light from outside.

        Parameters
        ----------
        lights : Light or several
            What shines on the bed, through open faces.
        absorptivity : (n,) array or float
            Absorptivities of the spheres for the light, 0 to 1. The rest is reflected. Those of walls are keys of the
            walls.

        Returns
        -------
        Absorbed
            Hand it to `solve`. It is valid until the next `shine` or `move`.
        """
        container, n = self._container, self.n
        shares = per_sphere("absorptivity", absorptivity, n, 0, 1, self._packing.names)
        of_walls, array = container.absorptivities(container.walls), lights_of(lights)
        arrays = {name: np.zeros(n) for name in ("absorbed", "absorbed_first", "absorbed_error")}
        arrays |= {name: np.zeros(len(container.names)) for name in ("wall_absorbed", "wall_absorbed_first")}
        sources = LightSources(light=array, lights=len(array), absorptivity=pointer(shares),
                               wall_absorptivity=pointer(of_walls))
        result = LightResult(**{name: pointer(values) for name, values in arrays.items()})
        self._use(library.fibrad_bed_shine, sources, result)
        walls, first = (dict(zip(container.names, arrays[name].tolist())) for name in ("wall_absorbed", "wall_absorbed_first"))
        return Absorbed(spheres=arrays["absorbed"], first=arrays["absorbed_first"], errors=arrays["absorbed_error"],
                        walls=walls, walls_first=first, incident=result.incident, transmitted=result.transmitted,
                        reflected=result.reflected, error=result.error, _patches=result.patches, _of=self)

    def solve(self, temperature: Optional[ArrayLike], emissivity: Emissivity, *, power: Optional[ArrayLike] = None,
              surroundings: Optional[float] = None, walls: Optional[Walls] = None, tolerance: Optional[float] = None,
              sigma: float = STEFAN_BOLTZMANN, light: Optional[Absorbed] = None,
              conductivity: Optional[ArrayLike] = None, contacts: Any = None, convection: Optional[ArrayLike] = None,
              gas_temperature: Optional[ArrayLike] = None, gas_flow: Optional[GasFlow] = None) -> Powers:
        """Net powers and temperatures of grey diffuse spheres and walls. A solution begins with the last one.

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
        walls : str, `wall`, or several of them, optional
            Other values of walls that are there: ``"zmin:temperature=900"``. Default: those of the bed.
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
        contacts : Contacts, (i, j, conductance) or SciPy matrix, optional
            [W/K] What conducts heat between spheres i and j. j may also be the name of a wall, in a list. Several
            contacts may join the same spheres. Of a matrix (n, n), which is symmetric, each element above the diagonal
            is a contact. On spheres of finite `conductivity` they act at their places.
        convection, gas_temperature : (n,) array or float, optional
            [W/(m2 K)] Heat transfer coefficients of spheres to gas, and [K] temperatures of this gas. Walls have keys:
            ``"zmin:convection=20:gas=300"``.
        gas_flow : (slices, rate), optional
            Gas flows through slices, and its temperature is found in each. `gas_temperature` is then one number, that of
            the inlet. slices (n,): whole numbers, 0 at the inlet. rate: [W/K] mass flow times specific heat, or (m, 2)
            temperatures [K] and rates.
        """
        container, packing, n = self._container, self._packing, self.n
        kelvins = per_sphere("temperature", math.nan if temperature is None else temperature, n, 0, TEMPERATURE_MAX,
                             packing.names, power is not None)
        given = container.with_values(walls)
        sources = Sources(packing, container, given, surroundings, sigma, tolerance, contacts, conductivity, convection,
                          gas_temperature, gas_flow, self._areas(), self._area_of)
        sources.c.temperature = pointer(kelvins)
        powers, wall_light = power_of(power, kelvins, packing), np.zeros(len(given))
        if light is not None:
            if not isinstance(light, Absorbed) or light._of is not self:
                raise refuse(f"light must be what shine of this bed returns, not {light!r}")
            sources.c.absorbed = patches_pointer(light)
            wall_light = np.where(sources.insulated, 0.0, [light.walls[name] for name in container.names])
            powers = light.spheres + (math.nan if powers is None else powers)
            sources.set_wall_power(wall_light + (math.nan if sources.wall_power is None else sources.wall_power))
        sources.set_power(powers)
        law = sources.set_emissivity(emissivity, kelvins, self._call)
        self._warn_of_units(surroundings, kelvins, sources.wall_temperature)
        of_spheres = {name: np.zeros(n) for name in _OF_SPHERES}
        of_walls = {name: np.zeros(len(given)) for name in _OF_WALLS}
        flows = np.zeros(sources.joined.conductance.size)
        result = HeatResult(contact_flow=pointer(flows),
                            **{name: pointer(array) for name, array in (of_spheres | of_walls).items()})
        self._use(library.fibrad_bed_solve, sources.c, law, result)
        self._warn(SOURCES)
        if light is not None:
            of_spheres["power"] += light.spheres
            of_walls["wall_power"] += wall_light
            result.surroundings_power += light.reflected + light.transmitted - light.incident
        if surroundings is None and result.surroundings_power != 0:
            raise refuse(f"{result.surroundings_power} W leave the bed after 100 periods: surroundings is needed")
        sides = np.full((2, container.sides_count), math.nan)
        if sides.size:
            self._use(library.fibrad_bed_sides, pointer(sides[0]), pointer(sides[1]))
        by_name = {name: dict(zip(container.names, array.tolist())) for name, array in of_walls.items()}
        return Powers(spheres=of_spheres["power"], walls=by_name["wall_power"], surroundings=result.surroundings_power,
                      temperatures=of_spheres["temperature"], wall_temperatures=by_name["wall_temperature"],
                      triangle_fluxes=container.by_mesh(sides[0]), triangle_temperatures=container.by_mesh(sides[1]),
                      emissivities=sources.emissivity, errors=of_spheres["power_error"],
                      wall_errors=by_name["wall_error"],
                      surroundings_error=result.surroundings_error, temperature_errors=of_spheres["temperature_error"],
                      least_temperatures=of_spheres["least_temperature"],
                      largest_temperatures=of_spheres["largest_temperature"],
                      centre_temperatures=of_spheres["centre_temperature"], surface_errors=of_spheres["surface_error"],
                      centre_errors=of_spheres["centre_error"], conducted=of_spheres["conducted"],
                      wall_conducted=by_name["wall_conducted"], contact_flows=flows,
                      convected=of_spheres["convected"], wall_convected=by_name["wall_convected"], gas=result.gas_power,
                      gas_error=result.gas_error, gas_temperatures=sources.gas_temperatures,
                      error=math.hypot(result.error_patches, result.error_beams), error_patches=result.error_patches,
                      error_beams=result.error_beams, residual=result.residual, sweeps=result.sweeps)

    def _warn_of_units(self, surroundings: Optional[float], *kelvins: NDArray[np.float64]) -> None:
        """What the library cannot know: that lengths are metres, and which temperatures were given."""
        if not self._told:
            warn_metres(self._packing)
        self._told = True
        if surroundings is not None and self._container.closed() and not all(np.isnan(given).all() for given in kelvins):
            warn("surroundings has no effect: nothing leaves a bed that walls and periods close")

    def advance(self, temperature: ArrayLike, duration: float, *, capacity: ArrayLike, emissivity: Emissivity,
                power: Optional[ArrayLike] = None, surroundings: Optional[float] = None,
                surroundings_end: Optional[float] = None, walls: Optional[Walls] = None,
                walls_end: Optional[Walls] = None, step: Optional[float] = None, tolerance: Optional[float] = None,
                sigma: float = STEFAN_BOLTZMANN, conductivity: Optional[ArrayLike] = None, contacts: Any = None,
                convection: Optional[ArrayLike] = None, gas_temperature: Optional[ArrayLike] = None,
                gas_temperature_end: Optional[ArrayLike] = None, gas_flow: Optional[GasFlow] = None,
                store: Union[Store, Sequence[Store], None] = None, store_of: Optional[ArrayLike] = None,
                melted: Optional[ArrayLike] = None) -> Advance:
        """Temperatures after a span of time: capacity dT/dt = power + net power. Steps are implicit and of second order.
        They keep the energy. Small spheres among large ones do not limit the step.

        Parameters
        ----------
        temperature : (n,) array or float
            [K] Temperatures of the spheres at the beginning, above 0.
        duration : float
            [s] Length of the span.
        capacity : (n,) array or float
            [J/K] Heat capacities of the spheres, mass times specific heat, above 0. With `store` [kg] masses. A sphere of
            infinite capacity keeps its temperature. Those of a clump add up: `surfaces` has the volumes.
        power : (n,) array or float, optional
            [W] Power of each sphere from inside. Default: none.
        surroundings_end : float, optional
            [K] Temperature of the surroundings at the end, linear in between. Default: constant.
        walls_end : str, `wall`, or several of them, optional
            Temperatures of walls at the end, linear in between: ``"zmin:temperature=900"``. Default: constant.
        step : float, optional
            [s] All steps are equal and at most this long. Default: automatic steps.
        tolerance : float, optional
            Of automatic steps: relative error of a temperature. Default: 1e-4.
        gas_temperature_end : (n,) array or float, optional
            [K] Temperatures of the gas at the end, linear in between. Default: constant.
        store : Store or several, optional
            A heat capacity that follows the temperature, and a latent heat. Default: capacities are constant.
        store_of : (n,) array, optional
            Number of the store of each sphere. Default: 0.
        melted : (n,) array, optional
            Fraction of each sphere that has melted at the beginning: that of the last span. Default: by the temperature.
        emissivity, surroundings, walls, sigma, conductivity, contacts, convection, gas_temperature, gas_flow
            As for `solve`.
        """
        container, packing, n = self._container, self._packing, self.n
        now = per_sphere("temperature", temperature, n, 0, TEMPERATURE_MAX, packing.names).copy()
        heat = per_sphere("capacity", capacity, n, 0, math.inf, packing.names)
        stores = [] if store is None else [store] if isinstance(store, Store) else list(store)
        structures, _arrays = stores_of(stores)
        number = np.ascontiguousarray(np.broadcast_to(0 if store_of is None else np.asarray(store_of), (n,)), np.uint32)
        fraction = np.full(n, math.nan) if melted is None else per_sphere("melted", melted, n, 0, 1, packing.names, True).copy()
        given = container.with_values(walls)
        sources = Sources(packing, container, given, surroundings, sigma, None, contacts, conductivity, convection,
                          gas_temperature, gas_flow, self._areas(), self._area_of)
        if gas_temperature_end is not None and gas_temperature is None:
            raise refuse("gas_temperature_end needs gas_temperature")
        gas = (None if gas_temperature_end is None else
               per_sphere("gas_temperature_end", gas_temperature_end, n, 0, TEMPERATURE_MAX, packing.names))
        inlet = None if gas is None or gas_flow is None else pointer(gas[:1])
        if inlet is not None and np.ndim(gas_temperature_end) > 0:
            raise refuse("gas_flow: gas_temperature_end is one number, that of the inlet")
        end, sides = container.temperatures(container.with_values(walls_end, given))
        if not np.array_equal(np.isnan(end), np.isnan(sources.wall_temperature)) or not sources.has_sides(sides):
            raise refuse("walls_end: only the temperatures of walls can change, and not those of single triangles")
        powers = None if power is None else per_sphere("power", power, n, -POWER_MAX, POWER_MAX, packing.names)
        sources.set_power(powers)
        law = sources.set_emissivity(emissivity, now, self._call)
        self._warn_of_units(surroundings, now)
        around = ctypes.c_double(real("surroundings_end", surroundings if surroundings_end is None else surroundings_end,
                                      0, TEMPERATURE_MAX))
        flow, stored, energy, capacities, ended = np.zeros(n), np.zeros(n), *np.zeros((3, len(given)))
        capacities[:] = container.capacities(given)
        sources.set_wall_power(container.powers(given, True))
        of_sides = None if sources.behind is None else np.full((2, container.sides_count), math.nan)
        span = Span(temperature=pointer(now), capacity=pointer(heat), duration=real("duration", duration, 0, DURATION_MAX),
                    wall_temperature=pointer(end), surroundings=ctypes.pointer(around), gas=pointer(gas), inlet=inlet,
                    step=real("step", step, 0, DURATION_MAX), tolerance=real("tolerance", tolerance, 0, 1),
                    store=structures if stores else None, stores=len(stores), store_of=pointer(number, WHOLE) if stores else None,
                    melted=pointer(fraction), stored=pointer(stored), wall_capacity=pointer(capacities), wall_end=pointer(ended),
                    side_energy=None if of_sides is None else pointer(of_sides[0]),
                    side_end=None if of_sides is None else pointer(of_sides[1]),
                    power=pointer(flow), wall_energy=pointer(energy), law=ctypes.pointer(law) if law else None)
        self._use(library.fibrad_bed_advance, sources.c, span)
        self._warn(SOURCES)
        return Advance(temperatures=now, spheres=flow, walls=dict(zip(container.names, energy.tolist())),
                       surroundings=span.surroundings_energy, gas=span.gas_energy, gas_temperatures=sources.gas_temperatures,
                       held=span.held_energy, stored=stored, melted=fraction,
                       wall_temperatures=dict(zip(container.names, ended.tolist())),
                       triangle_energies={} if of_sides is None else container.by_mesh(of_sides[0]),
                       triangle_temperatures={} if of_sides is None else container.by_mesh(of_sides[1]),
                       steps=span.steps, refused=span.refused,
                       corrections=span.corrections, error=span.error)


def view_factors(x: ArrayLike, r: ArrayLike, *, box: Optional[ArrayLike] = None, walls: Optional[Walls] = None,
                 ids: Optional[ArrayLike] = None, clump: Optional[ArrayLike] = None, threads: Optional[int] = None,
                 progress: Optional[Progress] = None, **options: Any) -> Factors:
    """View factors of a bed in one call. Arguments are those of `Bed` and of `Bed.factors`."""
    with Bed(x, r, box=box, walls=walls, ids=ids, clump=clump, threads=threads, progress=progress) as bed:
        return bed.factors(**options)


def exchange_factors(x: ArrayLike, r: ArrayLike, emissivity: ArrayLike, **options: Any) -> Factors:
    """Exchange factors of a bed in one call. Arguments are those of `Bed` and of `Bed.factors`."""
    return view_factors(x, r, emissivity=emissivity, **options)
