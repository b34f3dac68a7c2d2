# _bed.py - an object of the library that holds a bed and may be moved. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import threading
import weakref
from collections.abc import Collection, Mapping
from typing import Any, Optional, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._call import Call
from ._errors import StateError
from ._library import Fault, HeatConfig, SceneFacts, library
from ._limits import DIRECTIONS, PATCHES, POINTS, POWER_MAX, TEMPERATURE_MAX
from ._scene import Container, Packing, Walls
from ._values import mapping, refuse, whole
from ._warnings import warn_metres, warn_overlap, warn_walls


def _choice(name: str, value: Optional[int], choices: tuple[int, ...]) -> int:
    if value is not None and value not in choices:
        raise refuse(f"{name} = {value} is none of {', '.join(map(str, choices))}")
    return value or 0


def heat_config(directions: Optional[int], points: Optional[int], patches: Optional[int]) -> Any:
    return HeatConfig(directions=whole("directions", directions, *DIRECTIONS),
                      points=_choice("points", points, POINTS),
                      patches=_choice("patches", patches, PATCHES))


_Self = TypeVar("_Self", bound="Bed")


class Bed:
    """The common part of `Heat` and `Transient`. The functions of the library are fibrad_KIND_new and so on. KIND is
    `_kind`."""

    _kind: str

    def __init__(self, x: ArrayLike, r: ArrayLike, box: Optional[ArrayLike], walls: Optional[Walls],
                 ids: Optional[ArrayLike], config: Any, call: Call):
        self._packing = Packing(x, r, ids)
        self._container = Container(box, walls, self._packing)
        self._call = call
        self._busy = threading.Lock()
        self._handle = ctypes.c_void_p()
        self._free = weakref.finalize(self, _free, self._kind, self._handle)
        status = self._call(self._function("new"), self._handle, self._container.config, self._packing.spheres,
                            config, self._call.run)
        if status:
            raise self._packing.error(status, self._call.run.fault, self._container)
        warn_metres(self._packing)
        self._warn()

    def _warn(self) -> None:
        """Warns of spheres that overlap, and of walls that do not fit the bed."""
        facts = SceneFacts()
        self._function("describe")(self._handle, ctypes.byref(facts), None)
        warn_overlap(self._packing, facts)
        warn_walls(self._packing, self._container)

    def _function(self, verb: str) -> Any:
        return getattr(library, f"fibrad_{self._kind}_{verb}")

    @property
    def n(self) -> int:
        """Number of spheres."""
        return self._packing.n

    def _walls(self, temperature: Any, emissivity: Any, power: Optional[Mapping[str, float]],
               insulated: Collection[str]) -> dict[str, NDArray[Any]]:
        """The arrays of fibrad_heat_sources for walls. A wall with a power, or an insulated wall, has the temperature
        NaN."""
        container, powers = self._container, dict(mapping("wall_power", power, "{'zmax': 500.0}"))
        found = frozenset([*powers, *insulated])
        container.known("wall_power" if powers else "insulated", found)
        if isinstance(temperature, Mapping) and found & set(temperature):
            raise refuse(f"{', '.join(sorted(found & set(temperature)))}: its temperature is to be found")
        temperature, sides = container.sides("wall_temperature", temperature, 0, TEMPERATURE_MAX)
        shares = container.per_wall("wall_emissivity", emissivity, 0, 1, frozenset(insulated))
        arrays: dict[str, NDArray[Any]] = {
            "wall_temperature": container.per_wall("wall_temperature", temperature, 0, TEMPERATURE_MAX, found),
            "wall_emissivity": np.nan_to_num(shares),
            "insulated": np.array([wall in insulated for wall in container.names], np.uint8)}
        if sides is not None:
            arrays["side_temperature"] = sides
        if powers:
            arrays["wall_power"] = container.per_wall("wall_power", powers, -POWER_MAX, POWER_MAX,
                                                      frozenset(container.names))
        return arrays

    def _use(self, function: Any, packing: Packing, *arguments: Any) -> None:
        if not self._busy.acquire(blocking=False):
            raise StateError(f"this {type(self).__name__} is in use by another call; one thread at a time may use it")
        try:
            if not self._handle:
                raise StateError(f"this {type(self).__name__} is closed")
            status = self._call(function, self._handle, *arguments)
            if status:
                fault = Fault()
                self._function("describe")(self._handle, None, fault)
                raise packing.error(status, fault, self._container)
        finally:
            self._busy.release()

    def move(self, x: ArrayLike, r: Optional[ArrayLike] = None, *, box: Optional[ArrayLike] = None,
             walls: Optional[Walls] = None) -> None:
        """Goes on with the same spheres and walls at other positions.

        Parameters
        ----------
        x : (n, 3) array
            Centres [m].
        r : (n,) array or float, optional
            Radii [m]. Default: the present ones.
        box, walls : optional
            As at the beginning, with the same names. Default: the present ones.

        Raises
        ------
        InputError
            A value is out of its range, or the number of spheres or the names of walls differ. The last bed then
            stays in use.
        """
        if np.shape(x)[:1] != (self.n,):
            raise refuse(f"x has the shape {np.shape(x)}; this {type(self).__name__} has {self.n} spheres")
        packing = Packing(x, self._packing.r if r is None else r, self._packing.ids)
        container = Container(self._container.period if box is None else box,
                              self._container.walls if walls is None else walls, packing)
        if container.kinds != self._container.kinds:
            now, before = (", ".join(kinds) or "none" for kinds in (container.kinds, self._container.kinds))
            raise refuse(f"the walls are {now}; they were {before}")
        self._use(self._function("move"), packing, container.config, packing.spheres)
        self._packing, self._container = packing, container
        self._warn()

    def close(self) -> None:
        """Frees the memory. The object cannot be used afterwards."""
        if not self._busy.acquire(blocking=False):
            raise StateError(f"this {type(self).__name__} is in use by another call")
        self._free()
        self._busy.release()

    def __enter__(self: _Self) -> _Self:
        return self

    def __exit__(self, *exception: Any) -> None:
        self.close()


def _free(kind: str, handle: ctypes.c_void_p) -> None:
    getattr(library, f"fibrad_{kind}_free")(handle)
    handle.value = None
