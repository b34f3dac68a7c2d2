# _transient.py - temperatures of a bed in time. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import dataclasses
from collections.abc import Collection, Mapping
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._bed import Bed, heat_config
from ._call import Call, Progress
from ._contacts import contacts_of
from ._heat import STEFAN_BOLTZMANN
from ._library import ExchangeRule, HeatSources, Span, TransientConfig, library
from ._scene import Walls, pointer, pointers
from ._limits import CAPACITY_MAX, DURATION_MAX, POWER_MAX, SIGMA, TEMPERATURE_MAX
from ._values import per_sphere, real, refuse, several
from ._warnings import warn_around, warn_capacity, warn_temperatures

_METHODS = {"corrected": 0, "patches": 1, "factors": 2}


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Advance:
    """The result of a span of time. An energy is above 0 where heat was gained. The heat stored in the spheres, and the
    energies of walls and surroundings, add up to the energy that the powers have supplied.

    Attributes
    ----------
    temperatures
        [K] (n,) temperatures of the spheres at the end.
    spheres
        [W] (n,) net radiative power of each sphere at the end.
    walls
        [J] energy that each wall has gained by radiation, by name.
    surroundings
        [J] energy that the surroundings have gained by radiation.
    steps
        Steps that were taken.
    refused
        Steps tried and refused.
    corrections
        Solutions by patches that corrected the exchange factors.
    error
        Largest estimated error of a step, relative to a temperature.
    """

    temperatures: NDArray[np.float64]
    spheres: NDArray[np.float64]
    walls: dict[str, float]
    surroundings: float
    steps: int
    refused: int
    corrections: int
    error: float

    def __repr__(self) -> str:
        range_of = f" of {self.temperatures.min():.6g} to {self.temperatures.max():.6g} K" if self.temperatures.size else ""
        gained = ", ".join(f"{name} {energy:.6g} J" for name, energy in [*self.walls.items(), ("surroundings", self.surroundings)])
        return (f"<fibrad.Advance: {len(self.temperatures)} spheres{range_of}; {gained}; {self.steps} steps, error of a "
                f"step {self.error:.2g}>")


class Transient(Bed):
    """A bed whose temperatures change with time: capacity dT/dt = power + net radiative power.

    Steps are implicit and of second order. They keep the energy. Small spheres among large ones do not limit the step.
    The memory is freed by `close`, at the end of ``with``, or with the object. One thread at a time may use the object.

    Parameters
    ----------
    x, r, box, walls, ids, threads, progress
        As for `Heat`.
    method : {"corrected", "patches", "factors"}
        "corrected": by exchange factors, which patches correct from time to time. For many steps at the same positions.
        "patches": by patches in every step. For beds that move after a step or two, and for walls of unknown
        temperature. "factors": by exchange factors alone. Powers are 2 to 5 % off. Takes less memory.
    error : float, optional
        The error allowed in rows of exchange factors, 1e-6 to 1. Default: 0.03, or 0.01 for "factors".
    directions, points, patches : optional
        As for `Heat`. The default of points is 128 for "corrected".

    Examples
    --------
    >>> import fibrad
    >>> with fibrad.Transient([[0, 0, 0], [0, 0, 0.03]], 0.01) as bed:
    ...     end = bed.advance([1000.0, 300.0], 60.0, capacity=10.0, emissivity=0.8, surroundings=300.0)
    >>> bool(end.temperatures[0] < 1000 and end.temperatures[1] > 300)
    True
    """

    _kind = "transient"

    def __init__(self, x: ArrayLike, r: ArrayLike, *, box: Optional[ArrayLike] = None, walls: Optional[Walls] = None,
                 method: str = "corrected", error: Optional[float] = None, directions: Optional[int] = None,
                 points: Optional[int] = None, patches: Optional[int] = None, ids: Optional[ArrayLike] = None,
                 threads: Optional[int] = None, progress: Optional[Progress] = None):
        if method not in _METHODS:
            raise refuse(f"method = {method!r} is none of {', '.join(_METHODS)}")
        config = TransientConfig(method=_METHODS[method],
                                 exchange=ExchangeRule(tolerance=real("error", error, 1e-6, 1)),
                                 heat=heat_config(directions, points, patches))
        self._method = method
        super().__init__(x, r, box, walls, ids, config, Call(threads, progress))

    def advance(self, temperature: ArrayLike, duration: float, *, capacity: ArrayLike, emissivity: ArrayLike,
                power: Optional[ArrayLike] = None, surroundings: Optional[float] = None,
                surroundings_end: Optional[float] = None, wall_temperature: Any = None, wall_emissivity: Any = None,
                wall_temperature_end: Any = None, wall_power: Optional[Mapping[str, float]] = None,
                insulated: Collection[str] = (), step: Optional[float] = None, tolerance: Optional[float] = None,
                sigma: float = STEFAN_BOLTZMANN, contacts: Any = None) -> Advance:
        """Temperatures after a span of time.

        Parameters
        ----------
        temperature : (n,) array or float
            [K] Temperatures of the spheres at the beginning, above 0.
        duration : float
            [s] Length of the span.
        capacity : (n,) array or float
            [J/K] Heat capacities of the spheres, mass times specific heat, above 0.
        emissivity : (n,) array or float
            Emissivities of the spheres, 0 to 1. 0 reflects everything.
        power : (n,) array or float, optional
            [W] Power that heats each sphere from inside. Default: 0.
        surroundings, wall_temperature, wall_emissivity
            As for `Heat.solve`, at the beginning of the span.
        surroundings_end, wall_temperature_end : optional
            [K] At the end of the span, linear in between. Default: constant. Triangles with temperatures of their own
            (``wall_temperature`` is an array) always keep them.
        wall_power, insulated : optional
            As for `Heat.solve`. These walls have no heat capacity. Only with ``method="patches"``.
        step : float, optional
            [s] All steps are equal and at most this long. Default: automatic steps.
        tolerance : float, optional
            Of automatic steps: relative error of a temperature. Default: 1e-4.
        sigma : float
            [W/(m2 K4)] Emission is ``sigma T**4``.
        contacts : optional
            As for `Heat.solve`. Only with ``method="patches"``.

        Returns
        -------
        Advance

        Raises
        ------
        InputError
            A value is out of its range, or a sphere would fall below 0 K.
        StateError, OutOfMemory, Cancelled
            As for `Heat.solve`.
        """
        container, names, n = self._container, self._packing.names, self.n
        if surroundings is None and not container.closed():
            raise refuse("surroundings is missing: the temperature [K] of what radiation meets that leaves the bed")
        now = per_sphere("temperature", temperature, n, 0, TEMPERATURE_MAX, names).copy()
        heat = per_sphere("capacity", capacity, n, 0, CAPACITY_MAX, names)
        insulated = several("insulated", insulated)
        warn_temperatures(self._packing, now)
        warn_capacity(self._packing, heat)
        walls = self._walls(wall_temperature, wall_emissivity, wall_power, insulated)
        found = frozenset([*(wall_power or {}), *insulated])
        if found and self._method != "patches":
            raise refuse(f"{', '.join(sorted(found))}: walls of unknown temperature need method='patches'")
        if "side_temperature" in walls and self._method == "factors":
            raise refuse("triangles with temperatures of their own need another method than 'factors'")
        end, constant = walls["wall_temperature"], container.with_arrays(wall_temperature)
        if isinstance(wall_temperature_end, Mapping) and constant & set(wall_temperature_end):
            raise refuse(f"wall_temperature_end of {', '.join(sorted(constant & set(wall_temperature_end)))}: "
                         "triangles with temperatures of their own keep them")
        if wall_temperature_end is not None:
            given_end = container.per_wall("wall_temperature_end", wall_temperature_end, 0, TEMPERATURE_MAX, found | constant)
            end = np.where(np.isnan(given_end), end, given_end)
        shares = per_sphere("emissivity", emissivity, n, 0, 1, names)
        joined = contacts_of(((), (), ()) if contacts is None else contacts, n, container)
        if joined.conductance.size and self._method != "patches":
            raise refuse("contacts need method='patches'")
        given = None if power is None else per_sphere("power", power, n, -POWER_MAX, POWER_MAX, names)
        around = ctypes.c_double(real("surroundings_end", surroundings if surroundings_end is None else surroundings_end,
                                      0, TEMPERATURE_MAX))
        sources = HeatSources(emissivity=pointer(shares), power=pointer(given), sigma=real("sigma", sigma, *SIGMA),
                              surroundings=real("surroundings", surroundings, 0, TEMPERATURE_MAX), **pointers(walls))
        warn_around(container, surroundings, walls["wall_temperature"], now)
        ends = ctypes.POINTER(ctypes.c_uint32)
        sources.contacts, sources.conductance = joined.conductance.size, pointer(joined.conductance)
        sources.contact_first, sources.contact_second = pointer(joined.first, ends), pointer(joined.second, ends)
        flow, energy = np.zeros(n), np.zeros(len(container.names))
        span = Span(temperature=pointer(now), capacity=pointer(heat), duration=real("duration", duration, 0, DURATION_MAX),
                    wall_temperature=pointer(end), surroundings=ctypes.pointer(around),
                    step=real("step", step, 0, DURATION_MAX), tolerance=real("tolerance", tolerance, 0, 1),
                    power=pointer(flow), wall_energy=pointer(energy))
        self._use(library.fibrad_transient_advance, self._packing, sources, span)
        return Advance(temperatures=now, spheres=flow, walls=dict(zip(container.names, energy.tolist())),
                       surroundings=span.surroundings_energy, steps=span.steps, refused=span.refused,
                       corrections=span.corrections, error=span.error)
