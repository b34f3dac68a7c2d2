# _scene.py - spheres, box and walls as the library takes them. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import math
from collections.abc import Collection, Mapping, Sequence
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import ARGUMENT, BACK, ENDLESS, GEOMETRY, Error, error_of, status_text, why_text
from ._limits import LENGTH_MAX
from ._structures import Wall, Plane, SceneConfig, Spheres, Triangles
from ._values import Names, doubles, real, refuse

_AXES = "xyz"
_PLANES = {f"{axis}{end}": (k, upper) for k, axis in enumerate(_AXES) for upper, end in enumerate(("min", "max"))}
_PLANE, _CYLINDER, _MESH = 1, 2, 3
_CYLINDERS = ("xcylinder", "ycylinder", "cylinder")  # by fibrad_wall.cylinder.along
_NO_WALL = 2**32 - 1
_STRIDE_MAX = 2**32 - 1

Walls = Union[Mapping[str, Any], Sequence[tuple[str, Any]]]
MARKS: Any = ctypes.POINTER(ctypes.c_ubyte)


def pointer(array: Optional[NDArray[Any]], kind: Any = ctypes.POINTER(ctypes.c_double)) -> Any:
    """The address of an array, NULL for None."""
    return None if array is None else ctypes.cast(array.ctypes.data, kind)


def pointers(arrays: Mapping[str, NDArray[Any]]) -> dict[str, Any]:
    """Fields of a structure by name. An array is of doubles or of bytes."""
    return {name: pointer(array) if array.dtype == np.float64 else pointer(array, MARKS)
            for name, array in arrays.items()}


def _stride(array: NDArray[np.float64]) -> int:
    """Distance of the elements along the first axis, in doubles. 0: the library cannot take this array."""
    if len(array) < 2:
        return 1
    apart, rest = divmod(array.strides[0], array.itemsize)
    return apart if rest == 0 and 0 < apart <= _STRIDE_MAX else 0


def _strided(array: NDArray[np.float64]) -> NDArray[np.float64]:
    """The array itself if its stride allows, else a copy."""
    return array if _stride(array) else np.ascontiguousarray(array)


class Packing:
    """Spheres, and their arrays, which this object keeps."""

    def __init__(self, x: ArrayLike, r: ArrayLike, ids: Optional[ArrayLike] = None):
        self.x = _strided(doubles("x", x))
        if self.x.ndim != 2 or self.x.shape[1] != 3:
            raise refuse(f"x has the shape {self.x.shape}; (n, 3) is wanted: the centres of n spheres")
        self.n = len(self.x)
        r = doubles("r", r)
        if r.shape not in ((), (self.n,)):
            raise refuse(f"r has the shape {r.shape}; a radius or {self.n} of them, one for each sphere, are wanted")
        self.r = _strided(np.broadcast_to(r, (self.n,)))
        self.ids = None if ids is None else self._take_ids(ids)
        self.names = Names(self.ids)
        columns = [pointer(self.x[:, k]) for k in range(3)] if self.n else [None] * 3
        self.spheres = Spheres(*columns, pointer(self.r), self.n, _stride(self.x), _stride(self.r),
                               pointer(self.ids, ctypes.POINTER(ctypes.c_uint64)))

    def _take_ids(self, ids: ArrayLike) -> NDArray[np.uint64]:
        array = np.asarray(ids)
        if array.shape != (self.n,):
            raise refuse(f"ids has the shape {array.shape}; {self.n} are wanted, one for each sphere")
        if array.size and (array.dtype.kind not in "iu" or array.min() < 0):
            raise refuse("ids must be whole numbers from 0")
        values, counts = np.unique(array, return_counts=True)
        if values.size < self.n:
            raise refuse(f"two spheres have the id {values[counts > 1][0]}")
        return np.require(array, np.uint64, ["C", "A"])

    def error(self, status: int, fault: Any, container: Container) -> Error:
        """The exception for a status, with the spheres or the triangle at fault."""
        concerned = tuple(dict.fromkeys(i for i in (fault.first, fault.second) if i < self.n))
        text = status_text(status)
        if fault.why:
            text = why_text(fault.why)
            if fault.wall:
                return error_of(status, f"wall {container.names[fault.wall - 1]}: {text}", concerned)
        elif status == GEOMETRY and len(concerned) == 1 and container.reaches(2 * self.r[concerned[0]]):
            text = "a sphere reaches beyond an open side"
        elif status == GEOMETRY and len(concerned) < 2:
            text = "the box is smaller than a sphere's radius along a periodic axis"
        elif status == ENDLESS:
            text = f"{text}, such as walls={{{container.missing()!r}: 'open'}}"
        elif status == ARGUMENT and not concerned and not container.triangle(fault.triangle):
            text = f"this bed, box and walls cannot be computed: {text}"
        places = ", ".join(f"{self.names(i)} at {self.x[i].tolist()}, radius {self.r[i]}" for i in concerned)
        if status == BACK or not places:
            places = container.triangle(fault.triangle)
        return error_of(status, f"{text}: {places}" if places else text, concerned)


class Mesh:
    """A wall of triangles, for the argument ``walls`` of all functions: ``walls={"hopper": Mesh(vertices,
    triangles)}``.

    Parameters
    ----------
    vertices : (v, 3) array
        [L] Positions of the vertices.
    triangles : (t, 3) array of int
        The three vertices of each triangle, from 0. Seen from the front they go counter-clockwise. The fronts belong to
        this wall.
    back : None, True or str
        None: the backs belong to no wall and must not be seen. True: the backs belong to this wall, too. A name: the
        backs belong to the mesh of that name.
    """

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike, back: Union[None, bool, str] = None):
        self.vertices = np.ascontiguousarray(doubles("vertices", vertices))
        if self.vertices.ndim != 2 or self.vertices.shape[1] != 3:
            raise refuse(f"vertices has the shape {self.vertices.shape}; (v, 3) is wanted")
        corners = np.asarray(triangles)
        if corners.ndim != 2 or corners.shape[1] != 3 or not len(corners) or corners.dtype.kind not in "iu":
            raise refuse("triangles must be whole numbers, (t, 3): the vertices of t > 0 triangles")
        if corners.min() < 0 or corners.max() >= len(self.vertices):
            raise refuse(f"triangles name vertices from {corners.min()} to {corners.max()}; "
                         f"there are {len(self.vertices)}")
        self.triangles = np.require(corners, np.uint32, ["C", "A"])
        self.back = back

    @classmethod
    def from_stl(cls, path: Any, x: ArrayLike, r: ArrayLike, *, box: Optional[ArrayLike] = None, scale: float = 1.0,
                 sides: str = "auto") -> Mesh:
        """Reads a wall from an STL file, as the program does. The file may be text or binary, also packed by gzip.
        Corners that nearly coincide are joined, and the sides of the wall are chosen.

        Parameters
        ----------
        path : str or path
            The file.
        x, r, box
            The bed, as for `view_factors`.
        scale : float
            Factor for the coordinates of the file, 1e-12 to 1e12.
        sides : {"auto", "normals", "both"}
            Which sides belong to the wall. "auto": the sides on which spheres lie. "normals": the outer sides, as the
            file winds its triangles. "both": both sides.

        Raises
        ------
        InputError
            The file cannot be read, or a part of the surface is twisted and has no two sides.
        """
        from ._files import stl
        packing = Packing(x, r)
        period = Container(box, None, packing).period
        vertices, triangles, both = stl(path, packing.spheres, period, scale, sides)
        return cls(vertices, triangles, back=both or None)

    def areas(self) -> NDArray[np.float64]:
        """[L^2] (t,) areas of the triangles."""
        a, b, c = (self.vertices[self.triangles[:, k]] for k in range(3))
        return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2)


def across_cylinder(axis: int) -> tuple[int, int]:
    """The two axes across a cylinder, of fibrad_wall.cylinder.along."""
    return ((1, 2), (0, 2), (0, 1))[axis]


def _plane(name: str, at: Any) -> tuple[int, int, float]:
    if at is None or isinstance(at, str):
        raise refuse(f"wall {name} is {at!r}; a place, 'open' or ('open', place) is wanted")
    return (*_PLANES[name], real(f"wall {name}", at, -LENGTH_MAX, LENGTH_MAX))


def _is_open(value: Any) -> bool:
    """Whether a value is an opening: "open", or ("open", at)."""
    return isinstance(value, str) and value == "open" or (
        isinstance(value, (tuple, list)) and len(value) == 2 and isinstance(value[0], str) and value[0] == "open")


def _opening(name: str, value: Any, packing: Packing) -> tuple[int, int, float]:
    """The plane of an opening. Without a coordinate it lies where the spheres end."""
    if name not in _PLANES:
        raise refuse(f"{name!r} cannot be open; {', '.join(_PLANES)} can")
    if not isinstance(value, str):
        return _plane(name, value[1])
    axis, upper = _PLANES[name]
    if not packing.n:
        raise refuse(f"there are no spheres at whose end {name} could be open; {name}=('open', where) tells")
    x = packing.x[:, axis]
    return _plane(name, float((x + packing.r).max() if upper else (x - packing.r).min()))


def _wall(name: str, value: Any) -> Any:
    if isinstance(value, Mesh):
        return Wall(kind=_MESH)
    if name in _PLANES:
        return Wall(kind=_PLANE, plane=_plane(name, value))
    if name in _CYLINDERS:
        axis, (u, v) = _CYLINDERS.index(name), across_cylinder(_CYLINDERS.index(name))
        numbers = doubles(f"wall {name}", value)
        if numbers.shape != (3,) or not np.isfinite(numbers).all() or numbers[2] <= 0:
            raise refuse(f"wall {name} must be ({_AXES[u]}, {_AXES[v]}, radius), {_AXES[u]} and {_AXES[v]} of its axis "
                         f"along {_AXES[3 - u - v]}")
        return Wall(kind=_CYLINDER, cylinder=(*numbers, axis))
    raise refuse(f"there is no wall {name!r}; there are {', '.join((*_PLANES, *_CYLINDERS))}, and any name for a Mesh")


def _pairs_of(walls: Optional[Walls]) -> list[tuple[str, Any]]:
    """Names and walls."""
    try:
        return [(name, value) for name, value in (walls.items() if isinstance(walls, Mapping) else walls or ())]
    except (TypeError, ValueError):
        raise refuse(f"walls must be a mapping such as {{'zmin': 0.0}}, not {walls!r}") from None


class Container:
    """The periodic box, the walls and the openings of a bed."""

    def __init__(self, box: Optional[ArrayLike], walls: Optional[Walls], packing: Packing):
        self.period = np.zeros(3) if box is None else doubles("box", box)
        if self.period.shape != (3,) or not (np.isfinite(self.period) & (self.period >= 0)).all():
            raise refuse("box must be three lengths; 0 stands for an open axis")
        self.walls = all_pairs = _pairs_of(walls)
        if len({name for name, _ in all_pairs}) < len(all_pairs):
            raise refuse("a wall is named twice")
        pairs = [(name, value) for name, value in all_pairs if not _is_open(value)]
        openings = {name: _opening(name, value, packing) for name, value in all_pairs if _is_open(value)}
        self.names = tuple(name for name, _ in pairs)
        self.opened = frozenset(openings)
        self.kinds = (*self.names, *(f"{name} open" for name in sorted(openings)))
        self._openings = (Plane * len(openings))(*openings.values())
        self._walls = (Wall * len(pairs))(*(_wall(name, value) for name, value in pairs))
        self.config = SceneConfig(period=tuple(self.period), wall=self._walls, walls=len(pairs),
                                  opening=self._openings, openings=len(openings))
        self._meshes = [(b, value) for b, (_, value) in enumerate(pairs) if isinstance(value, Mesh)]
        if self._meshes:
            self.config.triangles = ctypes.pointer(self._triangles())

    def _back_of(self, wall: int, mesh: Mesh) -> int:
        if mesh.back is None or mesh.back is False:
            return _NO_WALL
        if mesh.back is True:
            return wall
        numbers = [b for b, _ in self._meshes if self.names[b] == mesh.back]
        if not numbers:
            raise refuse(f"the back of wall {self.names[wall]} is to be {mesh.back!r}, and no mesh has that name")
        return numbers[0]

    def _triangles(self) -> Any:
        """All meshes as arrays, which this object keeps."""
        first = np.cumsum([0] + [len(mesh.vertices) for _, mesh in self._meshes])
        at = np.concatenate([mesh.vertices for _, mesh in self._meshes])
        numbers = [np.concatenate(parts).astype(np.uint32) for parts in (
            [(mesh.triangles + int(start)).ravel() for start, (_, mesh) in zip(first, self._meshes)],
            [np.full(len(mesh.triangles), b) for b, mesh in self._meshes],
            [np.full(len(mesh.triangles), self._back_of(b, mesh)) for b, mesh in self._meshes])]
        self._arrays = [at, *numbers]
        return Triangles(*(pointer(at[:, k]) for k in range(3)), 3, len(at),
                         *(pointer(array, ctypes.POINTER(ctypes.c_uint32)) for array in numbers), len(numbers[1]))

    def planes(self) -> list[tuple[str, int, int, float]]:
        """Name, axis, whether it is the upper end, and place of each plane that is a wall."""
        return [(name, b.plane.axis, b.plane.upper, b.plane.at) for name, b in zip(self.names, self._walls)
                if b.kind == _PLANE]

    def cylinders(self) -> list[tuple[str, Any]]:
        """Name, and fibrad_wall.cylinder, of the cylinder, if there is one."""
        return [(name, b.cylinder) for name, b in zip(self.names, self._walls) if b.kind == _CYLINDER]

    def meshes(self) -> list[tuple[str, Mesh]]:
        """Name and mesh of each wall of triangles."""
        return [(self.names[b], mesh) for b, mesh in self._meshes]

    def triangle(self, number: int) -> str:
        """The name of a triangle for a message. "": there is no such triangle."""
        for b, mesh in self._meshes:
            if number < len(mesh.triangles):
                return f"triangle {number} of {self.names[b]}"
            number -= len(mesh.triangles)
        return ""

    @staticmethod
    def with_arrays(value: Any) -> frozenset[str]:
        """The walls for which a mapping has an array."""
        pairs = value.items() if isinstance(value, Mapping) else ()
        return frozenset(wall for wall, given in pairs if np.ndim(given))

    def sides(self, name: str, value: Any, low: float, high: float) -> tuple[Any, Optional[NDArray[np.float64]]]:
        """Divides a mapping in two: numbers for walls, and values for the sides of triangles. The number of a wall with
        an array is the fourth root of the mean fourth power by area. The values are [2 t], NaN for walls without an
        array. They are None if no wall has an array."""
        arrays = {wall: value[wall] for wall in self.with_arrays(value)}
        if not arrays:
            return value, None
        numbers, parts = dict(value), []
        for b, mesh in self._meshes:
            wall, part = self.names[b], np.full((len(mesh.triangles), 2), math.nan)
            parts.append(part)
            if wall not in arrays:
                continue
            given = doubles(f"{name} of {wall}", arrays.pop(wall))
            if given.shape != (len(part),):
                raise refuse(f"{name} of {wall} has the shape {given.shape}; a number or {len(part)} of them, "
                             "one for each triangle, are wanted")
            wrong = np.flatnonzero(~((given >= low) & (given <= high)))
            if wrong.size:
                raise refuse(f"{name} of triangle {wrong[0]} of {wall} is {given[wrong[0]]}, not in [{low:g}, {high:g}]")
            part[:, 0] = given
            if mesh.back is True or mesh.back == wall:
                part[:, 1] = given
            numbers[wall] = float(np.average(given**4, weights=mesh.areas()))**0.25
        if arrays:
            raise refuse(f"{name} of {', '.join(arrays)} has several values, and no mesh has that name")
        return numbers, np.ascontiguousarray(np.concatenate(parts).ravel())

    def by_mesh(self, values: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        """Values [2 t] of all sides as (t, 2) for each mesh, by the name of the wall."""
        ends = np.cumsum([len(mesh.triangles) for _, mesh in self._meshes])
        parts = np.split(values.reshape(-1, 2), ends[:-1]) if self._meshes else []
        return {self.names[b]: part for (b, _), part in zip(self._meshes, parts)}

    @property
    def sides_count(self) -> int:
        return 2 * sum(len(mesh.triangles) for _, mesh in self._meshes)

    def _bounded(self, axis: int) -> bool:
        """Whether an axis has an end or a period: two planes, a period, or the cylinder across it."""
        ends = {f"{_AXES[axis]}min", f"{_AXES[axis]}max"}
        round_it = any(axis in across_cylinder(cylinder.along) for _, cylinder in self.cylinders())
        return bool(self.period[axis] > 0 or ends <= {*self.names, *self.opened} or round_it)

    def closed(self) -> bool:
        """Whether no radiation can leave."""
        return not self.opened and all(self._bounded(axis) for axis in range(3))

    def reaches(self, diameter: float) -> bool:
        """Whether a refused sphere of this diameter reaches beyond an opening. Otherwise the sphere overlaps its own
        image."""
        return bool(self.opened) and not ((self.period > 0) & (self.period < diameter)).any()

    def missing(self) -> str:
        """The name of a side that makes the walls endless."""
        return next((name for name, (axis, _) in reversed(_PLANES.items())
                     if not self._bounded(axis) and name not in {*self.names, *self.opened}), "zmax")

    def known(self, name: str, walls: Collection[str]) -> None:
        """Refuses names of walls that do not exist, for an argument."""
        opened, wrong = sorted(set(walls) & self.opened), sorted(set(walls) - set(self.names))
        if opened:
            raise refuse(f"{name}: {', '.join(opened)} is open: as black and as hot as the surroundings")
        if wrong:
            there = f"; there are {', '.join(self.names)}" if self.names else ""
            raise refuse(f"{name}: there is no wall {', '.join(map(repr, wrong))}{there}")

    def per_wall(self, name: str, value: Any, low: float, high: float,
                 others: frozenset[str] = frozenset()) -> NDArray[np.float64]:
        """[walls] values, low to high, of a mapping by name. A number holds for all walls except `others`. Walls of
        `others` need no value, and their value is NaN."""
        if not self.names and value is not None:
            raise refuse(f"{name} is given, and there are no walls")
        if not isinstance(value, Mapping):
            value = dict.fromkeys([wall for wall in self.names if wall not in others], value)
        self.known(name, value)
        missing = [wall for wall in self.names if value.get(wall) is None and wall not in others]
        if missing:
            raise refuse(f"{name} of {', '.join(missing)} is missing")
        return np.array([math.nan if value.get(wall) is None else real(f"{name} of {wall}", value[wall], low, high)
                         for wall in self.names])
