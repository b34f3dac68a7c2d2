# _walls.py - walls in words, and as the library takes them. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import dataclasses
import math
import pathlib
import re
from collections.abc import Callable, Iterable, Iterator
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import ARGUMENT, BACK, ENDLESS, GEOMETRY, Error, error_of, status_text, why_text
from ._limits import CAPACITY_MAX, LENGTH_MAX, POWER_MAX, TEMPERATURE_MAX
from ._scene import WHOLE, Mesh, Packing, period_of, pointer
from ._structures import Plane, SceneConfig, Triangles, Wall as WallStructure
from ._values import doubles, real, refuse

_PLANES = ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")  # 2 axis + upper
_CYLINDERS = ("xcylinder", "ycylinder", "cylinder")  # by fibrad_wall.cylinder.along
_OTHERS = {"zcylinder": "cylinder", **{x + end: x + name for x in "xyz" for end, name in (("lo", "min"), ("hi", "max"))}}
_HEAT = ("temperature", "power", "insulated")  # a wall has one of these
_VALUES = (*_HEAT, "emissivity", "absorptivity", "convection", "gas", "capacity")
_SIDES = ("auto", "normals", "both")
_PLANE, _CYLINDER, _MESH = 1, 2, 3
_NO_WALL = 2**32 - 1


@dataclasses.dataclass(frozen=True, eq=False)
class Wall:
    """A wall, made by `wall`."""

    kind: str  # "plane", "cylinder", "mesh", "box", or "" for more about a wall that is there
    name: str
    place: Any  # of a plane a coordinate or None, of a cylinder three numbers, of a mesh a Mesh
    opened: bool
    values: dict[str, Any]  # by _VALUES, those that are given

    def with_values(self, values: dict[str, Any]) -> Wall:
        """The same wall with other values."""
        kept = {key: value for key, value in self.values.items() if not (key in _HEAT and set(_HEAT) & set(values))}
        return dataclasses.replace(self, values={**kept, **values})

    def share(self, key: str, otherwise: float) -> float:
        return real(f"{key} of wall {self.name}", self.values.get(key, otherwise), 0, 1)


Walls = Union[str, Wall, Iterable[Union[str, Wall]]]


def wall(shape: Union[str, Mesh], *, at: Optional[float] = None, open: bool = False, name: Optional[str] = None,
         temperature: Any = None, power: Optional[ArrayLike] = None, insulated: bool = False,
         emissivity: Optional[float] = None, absorptivity: Optional[float] = None,
         convection: Optional[ArrayLike] = None, gas: Optional[ArrayLike] = None, capacity: Optional[float] = None,
         scale: float = 1.0, sides: str = "auto") -> Wall:
    """A wall, for the argument ``walls``. The words of the program say the same:
    ``"zmin:temperature=1200:emissivity=0.8,zmax:open"``.

    Parameters
    ----------
    shape : str or Mesh
        "xmin" to "zmax": a plane. "cylinder:X,Y,R", along z, "xcylinder:Y,Z,R" or "ycylinder:X,Z,R". "mesh:FILE" or a
        `Mesh`: triangles. "box": all planes that are not named. The name of a wall that is there: more about it.
    at : float, optional
        [L] Coordinate of a plane. Default: where the spheres end.
    open : bool
        True: an opening. The container ends there and the surroundings begin.
    name : str, optional
        Name of a mesh. Default: that of the file.
    temperature : float or (t,) array, optional
        [K] Of a mesh it may be an array, one value for each triangle.
    power : float or (t,) array, optional
        [W] Power that the wall gives off. Its temperature is found. Of a mesh it may be an array, one value for each
        triangle, NaN where none is given; see `convection`.
    insulated : bool
        True: the wall sends back all that arrives, point by point.
    emissivity : float, optional
        0 to 1. Default: 1.
    absorptivity : float, optional
        Of light from outside, 0 to 1. Default: the emissivity.
    convection, gas : float or (t,) array, optional
        [W/(m2 K)] Heat transfer coefficient to gas, and [K] temperature of this gas. Not of an endless wall. If the
        convection of a mesh is an array, it is that behind each triangle, 0 where there is none. The temperatures of
        such triangles, and of those with a power, are found. The search begins with `temperature`.
    capacity : float, optional
        [J/K] In `Bed.advance` the wall stores heat: it begins at `temperature`, and may have a power, too.
    scale, sides
        Of "mesh:FILE", as for `Mesh.from_stl`.
    """
    kind, word, place = _shape(shape, name, (scale, sides))
    given = {"temperature": temperature, "power": power, "insulated": insulated or None, "emissivity": emissivity,
             "absorptivity": absorptivity, "convection": convection, "gas": gas, "capacity": capacity}
    values = {key: value for key, value in given.items() if value is not None}
    useless = [key for key, use in (("at", at is not None and kind != "plane"), ("open", open and kind != "plane"),
                                    ("name", name is not None and kind != "mesh"),
                                    ("scale", scale != 1.0 and kind != "mesh"),
                                    ("sides", sides != "auto" and kind != "mesh")) if use]
    if useless:
        raise refuse(f"wall {word}: {useless[0]} is of no use here")
    several = ["open", *values] if open else [key for key in _HEAT if key in values]
    if len(several) > 1 and not ((capacity is not None or np.ndim(power)) and several == ["temperature", "power"]):
        raise refuse(f"wall {word}: {' and '.join(several)} exclude each other")
    if at is not None:
        place = real(f"wall {word}: at", at, -LENGTH_MAX, LENGTH_MAX)
    return Wall(kind, word, place, open, values)


def _shape(shape: Union[str, Mesh], name: Optional[str], of_file: tuple[float, str]) -> tuple[str, str, Any]:
    """Kind, name and place of a wall. Of a mesh in a file the place is the file, its scale and its sides."""
    word, _, rest = ("mesh", "", "") if isinstance(shape, Mesh) else str(shape).partition(":")
    word = _OTHERS.get(word, word)
    if word == "mesh":
        called = name or re.sub(r"\W", "_", pathlib.Path(rest).stem)
        if not called:
            raise refuse("a Mesh needs a name, and mesh:FILE a file")
        return "mesh", called, shape if isinstance(shape, Mesh) else (rest, *of_file)
    if word in _CYLINDERS:
        numbers = [real(f"wall {word}", part, -LENGTH_MAX, LENGTH_MAX) for part in rest.split(",") if part]
        if len(numbers) != 3 or not numbers[2] > 0:
            across = "XYZ".replace("XYZ"[_CYLINDERS.index(word)], "")
            raise refuse(f"wall {word} needs {word}:{across[0]},{across[1]},R, a place and a radius above 0")
        return "cylinder", word, tuple(numbers)
    if rest:
        raise refuse(f"wall {word}: {rest} is of no use here")
    return "plane" if word in _PLANES else "box" if word == "box" else "", word, None


def _of_words(text: str) -> Iterator[Wall]:
    """The walls of words that are joined by colons and commas. A comma before a number belongs to the wall."""
    for item in re.split(r",(?![-+.\d])", text):
        shape, *words = item.split(":")
        if shape == "mesh" or _OTHERS.get(shape, shape) in _CYLINDERS:
            shape = ":".join([shape, *words[:1]])
            words = words[1:]
        keys: dict[str, Any] = {}
        for word in words:
            key, equal, value = word.partition("=")
            if equal and key in ("at", "name", "scale", *_VALUES) and key != "insulated":
                keys[key] = value
            elif not equal and key in ("open", "insulated"):
                keys[key] = True
            elif not equal and key in _SIDES:
                keys["sides"] = key
            else:
                raise refuse(f"wall {shape}: {word!r} is of no use here; there are at=, open, temperature=, power=, insulated, "
                             f"emissivity=, absorptivity=, convection=, gas=, capacity=, name=, scale=, {', '.join(_SIDES)}")
        yield wall(shape, **keys)


def walls_of(walls: Any) -> list[Wall]:
    """The walls of an argument."""
    several = [walls] if isinstance(walls, (str, Wall)) else [] if walls is None else walls
    if not isinstance(several, Iterable) or isinstance(several, dict):
        raise refuse("walls must be words such as 'zmin:temperature=1200', fibrad.wall, or several of these, not "
                     f"{walls!r}")
    found: list[Wall] = []
    for one in several:
        if not isinstance(one, (str, Wall)):
            raise refuse(f"walls has {one!r}; words such as 'zmin:temperature=1200' or fibrad.wall are wanted")
        found += _of_words(one) if isinstance(one, str) else [one]
    return found


def _settled(walls: Any, packing: Packing, box: Optional[ArrayLike]) -> dict[str, Wall]:
    """All walls and openings by name. Files are read."""
    found: dict[str, Wall] = {}
    boxes: list[Wall] = []
    for one in walls_of(walls):
        if one.kind == "box":
            boxes.append(one)
        elif one.kind == "" and one.name not in found:
            raise refuse(f"there is no wall {one.name!r}; there are box, {', '.join(_PLANES)}, cylinder:X,Y,R, "
                         "xcylinder:Y,Z,R, ycylinder:X,Z,R and mesh:FILE")
        elif one.kind == "":
            found[one.name] = found[one.name].with_values(one.values)
        elif one.kind == "mesh" and one.name in found:
            raise refuse(f"{one.name} is the name of two walls")
        elif isinstance(one.place, tuple) and one.kind == "mesh":
            path, scale, sides = one.place
            found[one.name] = dataclasses.replace(
                one, place=Mesh.from_stl(path, packing.x, packing.r, box=box, scale=scale, sides=sides))
        else:
            found[one.name] = one
    for one in boxes:
        for name in _PLANES:
            found.setdefault(name, dataclasses.replace(one, kind="plane", name=name))
    return found


class Container:
    """The periodic box, the walls and the openings of a bed."""

    def __init__(self, box: Optional[ArrayLike], walls: Any, packing: Packing):
        self.period = period_of(box)
        found = _settled(walls, packing, box)
        self.all = tuple(found.values())
        self.walls = [one for one in self.all if not one.opened]
        self.names = tuple(one.name for one in self.walls)
        self.opened = frozenset(found) - frozenset(self.names)
        self._planes = {one.name: self._plane(one, packing) for one in self.all if one.kind == "plane"}
        self._config = [(WallStructure * len(self.walls))(*map(self._wall, self.walls)),
                        (Plane * len(self.opened))(*(self._planes[name] for name in sorted(self.opened)))]
        self.config = SceneConfig(period=tuple(self.period), wall=self._config[0], walls=len(self.walls),
                                  opening=self._config[1], openings=len(self.opened))
        self._meshes = [(b, one.place) for b, one in enumerate(self.walls) if one.kind == "mesh"]
        if self._meshes:
            self.config.triangles = ctypes.pointer(self._triangles())

    @staticmethod
    def _plane(one: Wall, packing: Packing) -> tuple[int, int, float]:
        """A plane. Without a coordinate it lies where the spheres end."""
        (axis, upper), at = divmod(_PLANES.index(one.name), 2), one.place
        if at is None and not packing.n:
            raise refuse(f"there are no spheres at whose end {one.name} could be; at= says where it is")
        if at is None:
            x = packing.x[:, axis]
            at = (x + packing.r).max() if upper else (x - packing.r).min()
        return axis, upper, float(at)

    def _wall(self, one: Wall) -> Any:
        if one.kind == "mesh":
            return WallStructure(kind=_MESH)
        if one.kind == "plane":
            return WallStructure(kind=_PLANE, plane=self._planes[one.name])
        return WallStructure(kind=_CYLINDER, cylinder=(*one.place, _CYLINDERS.index(one.name)))

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
                         *(pointer(array, WHOLE) for array in numbers), len(numbers[1]))

    # ---- values of walls

    def with_values(self, walls: Any, before: Optional[list[Wall]] = None) -> list[Wall]:
        """The walls, or those of `before`, with other values for some of them."""
        now = {one.name: one for one in (self.walls if before is None else before)}
        for more in walls_of(walls):
            if more.name in self.opened:
                raise refuse(f"wall {more.name} is open: as black and as hot as the surroundings")
            if more.kind == "box":
                now = {name: one.with_values(more.values) for name, one in now.items()}
            elif more.name not in now:
                raise refuse(f"there is no wall {more.name!r}; there are {', '.join(self.names) or 'none'}")
            elif more.opened or more.place is not None and more.place != now[more.name].place:
                raise refuse(f"wall {more.name}: only `move` moves a wall")
            else:
                now[more.name] = now[more.name].with_values(more.values)
        return list(now.values())

    def emissivities(self, walls: list[Wall]) -> NDArray[np.float64]:
        """[walls]"""
        return np.array([one.share("emissivity", 1.0) for one in walls])

    def absorptivities(self, walls: list[Wall]) -> NDArray[np.float64]:
        """[walls]"""
        return np.array([one.share("absorptivity", one.share("emissivity", 1.0)) for one in walls])

    def films(self, walls: list[Wall], area_of: Callable[[int], float]) -> tuple[Optional[NDArray[np.float64]],
                                                                              Optional[NDArray[np.float64]]]:
        """[walls] W/K to gas, and K of the gas, with the areas of walls. None: no wall has a convection."""
        if all(np.ndim(one.values.get("convection", ())) for one in walls):
            return None, None
        film, kelvins = np.zeros(len(walls)), np.zeros(len(walls))
        for b, one in enumerate(walls):
            if np.ndim(one.values.get("convection", ())):
                continue
            if "gas" not in one.values or not math.isfinite(area_of(b)):
                raise refuse(f"wall {one.name}: convection needs gas=, the temperature of the gas, and a wall that ends")
            film[b] = real(f"convection of wall {one.name}", one.values["convection"], 0, 1e12) * area_of(b)
            kelvins[b] = real(f"gas of wall {one.name}", one.values["gas"], 0, TEMPERATURE_MAX)
        return film, kelvins

    def temperatures(self, walls: list[Wall]) -> tuple[NDArray[np.float64], Optional[NDArray[np.float64]]]:
        """[walls] temperatures, NaN where they are to be found. And those of the sides of triangles, [2 t], NaN for walls
        of one temperature; None if all walls are such. The temperature of a wall with an array is the fourth root of the
        mean fourth power by area."""
        kelvins = np.full(len(walls), math.nan)
        parts = [np.full((len(mesh.triangles), 2), math.nan) for _, mesh in self._meshes]
        part_of = {b: part for (b, _), part in zip(self._meshes, parts)}
        for b, one in enumerate(walls):
            name, given = f"temperature of wall {one.name}", one.values.get("temperature")
            if given is None and not {"power", "insulated"} & set(one.values):
                raise refuse(f"{name} is missing")
            if given is None:
                continue
            if not np.ndim(given):
                kelvins[b] = real(name, given, 0, TEMPERATURE_MAX)
                continue
            array = self._of_triangles(one, b, "temperature", 0, TEMPERATURE_MAX)
            part_of[b][:, 0] = array
            if one.place.back is True or one.place.back == one.name:
                part_of[b][:, 1] = array
            kelvins[b] = float(np.average(array**4, weights=one.place.areas())) ** 0.25
        some = any(np.isfinite(part).any() for part in parts)
        return kelvins, np.concatenate(parts).ravel() if some else None

    def _of_triangles(self, one: Wall, b: int, key: str, low: float, high: float, nan: bool = False) -> NDArray[np.float64]:
        """An array that a wall has, a value for each triangle."""
        name, array = f"{key} of wall {one.name}", doubles(f"{key} of wall {one.name}", one.values[key])
        count = dict((number, len(mesh.triangles)) for number, mesh in self._meshes).get(b, 0)
        if array.shape != (count,):
            raise refuse(f"{name} has the shape {array.shape}; a number is wanted"
                         + f", or {count}, one for each triangle" * (count > 0))
        wrong = np.flatnonzero(~((array >= low) & (array <= high) | nan & np.isnan(array)))
        if wrong.size:
            raise refuse(f"{key} of triangle {wrong[0]} of {one.name} is {array[wrong[0]]}")
        return array

    def sides(self, walls: list[Wall]) -> Optional[NDArray[np.float64]]:
        """(3, 2 t) films, gas temperatures and powers per area of sides. None: no wall has any."""
        sides, start = np.zeros((3, self.sides_count)), 0
        sides[2] = math.nan
        for b, mesh in self._meshes:
            one, end = walls[b], start + 2 * len(mesh.triangles)
            both = one.place.back is True or one.place.back == one.name
            to = sides[:, start:end].reshape(3, -1, 2)[:, :, :2 if both else 1]
            if np.ndim(one.values.get("convection", 0)):
                gas = one.values.get("gas", math.nan)
                to[0] = self._of_triangles(one, b, "convection", 0, 1e12)[:, None]
                to[1] = (self._of_triangles(one, b, "gas", 0, TEMPERATURE_MAX, True)[:, None] if np.ndim(gas)
                         else real(f"gas of wall {one.name}", gas, 0, TEMPERATURE_MAX))
            if np.ndim(one.values.get("power", 0)):
                power = self._of_triangles(one, b, "power", -POWER_MAX, POWER_MAX, True)
                to[2] = (power / mesh.areas() / to.shape[2])[:, None]
            start = end
        return sides if sides[0].any() or np.isfinite(sides[2]).any() else None

    def capacities(self, walls: list[Wall]) -> NDArray[np.float64]:
        """[walls] heat capacities, 0 where none is given."""
        return np.array([real(f"capacity of wall {one.name}", one.values.get("capacity", 0), 0, CAPACITY_MAX) for one in walls])

    def powers(self, walls: list[Wall], storing: bool = False) -> Optional[NDArray[np.float64]]:
        """[walls] powers that walls give off, NaN where none is given. Those of walls that have temperatures, too, count
        if `storing`. None: no wall has one."""
        given = [one.values.get("power") if storing or "temperature" not in one.values else None for one in walls]
        given = [None if np.ndim(power) else power for power in given]
        if given == [None] * len(walls):
            return None
        return np.array([math.nan if power is None else real(f"power of wall {one.name}", power, -POWER_MAX, POWER_MAX)
                         for one, power in zip(walls, given)])

    def by_mesh(self, values: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        """Values [2 t] of all sides as (t, 2) for each mesh, by the name of the wall."""
        ends = np.cumsum([len(mesh.triangles) for _, mesh in self._meshes])
        parts = np.split(values.reshape(-1, 2), ends[:-1]) if self._meshes else []
        return {self.names[b]: part for (b, _), part in zip(self._meshes, parts)}

    @property
    def sides_count(self) -> int:
        return 2 * sum(len(mesh.triangles) for _, mesh in self._meshes)

    # ---- messages

    def _bounded(self, axis: int) -> bool:
        """Whether an axis has an end or a period: two planes, a period, or the cylinder across it."""
        ends = set(_PLANES[2 * axis:2 * axis + 2])
        round_it = any(one.kind == "cylinder" and _CYLINDERS.index(one.name) != axis for one in self.walls)
        return bool(self.period[axis] > 0 or ends <= {*self.names, *self.opened} or round_it)

    def closed(self) -> bool:
        """Whether no radiation can leave."""
        return not self.opened and all(self._bounded(axis) for axis in range(3))

    def _triangle(self, number: int) -> str:
        """The name of a triangle. "": there is no such triangle."""
        for b, mesh in self._meshes:
            if number < len(mesh.triangles):
                return f"triangle {number} of {self.names[b]}"
            number -= len(mesh.triangles)
        return ""

    def error(self, packing: Packing, status: int, fault: Any) -> Error:
        """The exception for a status, with the spheres, the wall or the triangle at fault."""
        concerned = tuple(dict.fromkeys(i for i in (fault.first, fault.second) if i < packing.n))
        text = status_text(status)
        if fault.why:
            text = why_text(fault.why)
            if fault.wall:
                return error_of(status, f"wall {self.names[fault.wall - 1]}: {text}", concerned)
        elif status == GEOMETRY and len(concerned) < 2:
            image = not concerned or ((self.period > 0) & (self.period < 2 * packing.r[concerned[0]])).any()
            text = ("a sphere reaches beyond an open side" if self.opened and not image else
                    "the box is smaller than a sphere's radius along a periodic axis")
        elif status == ENDLESS:
            missing = [name for k, name in enumerate(_PLANES)
                       if not self._bounded(k // 2) and name not in {*self.names, *self.opened}]
            text = f"{text}, such as walls='{missing[-1] if missing else 'zmax'}:open'"
        elif status == ARGUMENT and not concerned and not self._triangle(fault.triangle):
            text = f"this bed, box and walls cannot be computed: {text}"
        places = ", ".join(f"{packing.names(i)} at {packing.x[i].tolist()}, radius {packing.r[i]}" for i in concerned)
        if status == BACK or not places:
            places = self._triangle(fault.triangle)
        return error_of(status, f"{text}: {places}" if places else text, concerned)
