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
from ._heat import STEFAN_BOLTZMANN
from ._library import ExchangeRule, HeatSources, Span, TransientConfig, library
from ._scene import Walls, pointer, pointers
from ._values import HOTTEST, STRONGEST, per_sphere, real, refuse

_METHODS = {"corrected": 0, "patches": 1, "factors": 2}


@dataclasses.dataclass(frozen=True, eq=False)
class Advance:
    """What a span of time has brought. Energies [J], positive where heat was gained: the spheres have lost what walls
    and surroundings have gained, less what their powers have supplied."""

    temperatures: NDArray[np.float64]
    """(n,) of the spheres at the end [K]."""
    spheres: NDArray[np.float64]
    """(n,) net radiative power of each at the end [W]."""
    walls: dict[str, float]
    """Energy that radiation has brought to each wall, by its name."""
    surroundings: float
    """Energy that it has brought to the surroundings."""
    steps: int
    """Taken."""
    refused: int
    """Steps that were tried besides."""
    corrections: int
    """Solutions by patches that have corrected the exchange factors."""
    error: float
    """The largest estimate of a step, relative to a temperature."""


class Transient(Bed):
    """A bed whose temperatures change with time: capacity dT/dt = power + what radiation brings.

    Steps are implicit, of second order, and keep the energy; small spheres among large ones set no limit to them.
    Memory is freed by `close`, at the end of ``with``, or with the object. One thread at a time may use it.

    Parameters
    ----------
    x, r, box, walls, ids, threads, progress
        As of `Heat`.
    method : {"corrected", "patches", "factors"}
        Exchange factors, made by the first step in a place, and corrected by patches where powers have changed;
        patches for each step, for beds that move after a step or two; exchange factors alone, which err by some
        percent and need less memory.
    error : float, optional
        Of the rows of exchange factors. Default: 0.03, alone 0.01.
    directions, points, patches : optional
        As of `Heat`.

    Examples
    --------
    >>> import fibrad
    >>> with fibrad.Transient([[0, 0, 0], [0, 0, 3]], 1.0) as bed:
    ...     end = bed.advance([1000.0, 300.0], 3600.0, capacity=1e7, emissivity=0.8, surroundings=300.0)
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
                sigma: float = STEFAN_BOLTZMANN) -> Advance:
        """Temperatures after a span of time.

        Parameters
        ----------
        temperature : (n,) array or float
            Of the spheres at the beginning [K], above 0.
        duration : float
            Of the span [s].
        capacity : (n,) array or float
            Heat that warms a sphere by 1 K [J/K], above 0: its mass times its heat capacity.
        emissivity : (n,) array or float
            Of the spheres, 0 to 1; 0 reflects all.
        power : (n,) array or float, optional
            What heats the spheres from inside [W].
        surroundings, wall_temperature, wall_emissivity
            As of `Heat.solve`, at the beginning.
        surroundings_end, wall_temperature_end : optional
            At the end [K], linear in between. Default: constant, as the triangles of a `Mesh` always are whose
            ``wall_temperature`` is an array.
        wall_power, insulated : optional
            As of `Heat.solve`: walls of unknown temperature, which have no capacity. Only with ``method="patches"``.
        step : float, optional
            Steps of this length at most [s], all alike. Default: automatic.
        tolerance : float, optional
            Of automatic steps: error of a temperature, relative. Default: 1e-4.
        sigma : float
            Emission is ``sigma T**4``.

        Raises
        ------
        InputError
            Also where a sphere would fall below zero.
        StateError, OutOfMemory
        """
        container, names, n = self._container, self._packing.names, self.n
        if surroundings is None and not container.closed():
            raise refuse("surroundings is missing: the temperature [K] of what radiation meets that leaves the bed")
        now = per_sphere("temperature", temperature, n, 0, HOTTEST, names).copy()
        heat = per_sphere("capacity", capacity, n, 0, STRONGEST, names)
        walls = self._walls(wall_temperature, wall_emissivity, wall_power, insulated)
        found = frozenset([*(wall_power or {}), *insulated])
        if found and self._method != "patches":
            raise refuse(f"{', '.join(sorted(found))}: walls of unknown temperature need method='patches'")
        if "side_temperature" in walls and self._method == "factors":
            raise refuse("triangles with temperatures of their own need another method than 'factors'")
        end, constant = walls["body_temperature"], container.with_arrays(wall_temperature)
        if isinstance(wall_temperature_end, Mapping) and constant & set(wall_temperature_end):
            raise refuse(f"wall_temperature_end of {', '.join(sorted(constant & set(wall_temperature_end)))}: "
                         "triangles with temperatures of their own keep them")
        if wall_temperature_end is not None:
            given_end = container.per_wall("wall_temperature_end", wall_temperature_end, 0, HOTTEST, found | constant)
            end = np.where(np.isnan(given_end), end, given_end)
        shares = per_sphere("emissivity", emissivity, n, 0, 1, names)
        given = None if power is None else per_sphere("power", power, n, -STRONGEST, STRONGEST, names)
        around = ctypes.c_double(real("surroundings_end", surroundings if surroundings_end is None else surroundings_end,
                                      0, HOTTEST))
        sources = HeatSources(emissivity=pointer(shares), power=pointer(given), sigma=real("sigma", sigma, 1e-30, 1e30),
                              surroundings=real("surroundings", surroundings, 0, HOTTEST), **pointers(walls))
        flow, energy = np.zeros(n), np.zeros(len(container.names))
        span = Span(temperature=pointer(now), capacity=pointer(heat), duration=real("duration", duration, 0, 1e300),
                    body_temperature=pointer(end), surroundings=ctypes.pointer(around),
                    step=real("step", step, 0, 1e300), tolerance=real("tolerance", tolerance, 0, 1),
                    power=pointer(flow), body_energy=pointer(energy))
        self._use(library.fibrad_transient_advance, self._packing, sources, span)
        return Advance(temperatures=now, spheres=flow, walls=dict(zip(container.names, energy.tolist())),
                       surroundings=span.surroundings_energy, steps=span.steps, refused=span.refused,
                       corrections=span.corrections, error=span.error)
