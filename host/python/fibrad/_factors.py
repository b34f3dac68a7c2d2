# _factors.py - view factors and exchange factors of whole beds. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import dataclasses
import operator
import os
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._library import library
from ._limits import DIRECTIONS, LENGTH_MAX, RELATIVE_CONDUCTIVITY_MIN
from ._scene import MARKS, Packing, pointer
from ._structures import BeamRule, BedMatrix, BedRule, CastRule, ExchangeRule
from ._values import marks, per_sphere, real, refuse, whole
from ._walls import Container

Folder = Union[str, "os.PathLike[str]"]

_SEED = (0, 2**64 - 1)
_METHODS = {"beam": {"directions"}, "cast": {"rays", "seed"}, "mc": {"rays", "seed"},
            "exchange": {"directions", "paths", "seed"}}


class Owner:
    """Factors of the library. They are freed with the last array that refers to them."""

    def __init__(self) -> None:
        self.factors: Any = ctypes.POINTER(BedMatrix)()

    def __del__(self, free: Any = library.fibrad_bed_matrix_free) -> None:  # bound: at exit the module may be gone
        free(self.factors)


class _Memory:
    """The array interface of numpy for memory of the library."""

    def __init__(self, owner: Owner, address: Any, shape: tuple[int, ...], kind: str):
        self._owner = owner
        self.__array_interface__ = {"data": (ctypes.cast(address, ctypes.c_void_p).value, False), "shape": shape,
                                    "typestr": np.dtype(kind).str, "version": 3}


def _array(owner: Owner, address: Any, shape: tuple[int, ...], kind: str = "f8") -> NDArray[Any]:
    return np.asarray(_Memory(owner, address, shape, kind)) if address and np.prod(shape) else np.zeros(shape, kind)


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Factors:
    """A matrix of factors in compressed rows (CSR), and facts of its computation.

    Row ``i`` has the factors ``data[indptr[i]:indptr[i + 1]]`` and the columns ``indices[indptr[i]:indptr[i + 1]]``.
    The columns ascend. The sum of row ``i`` of ``data`` and ``walls``, ``escaped[i]`` and ``beyond[i]`` is 1.

    ``wall_wall``, ``wall_escaped``, ``wall_error``, ``wall_correction`` and ``wall_closure`` are None without walls,
    with a cutoff, or if only some rows were wanted.

    Attributes
    ----------
    indptr
        (n + 1,) where each row begins.
    indices
        (entries,) positions of the spheres that receive, from 0.
    data
        (entries,) factors from the sphere of the row to the sphere of the column.
    escaped, beyond, error
        (n,) factors to the surroundings, fractions whose target is not known beyond the cutoff, and the estimated error of
        each row.
    walls
        (n, walls) factors to each wall.
    wall_names
        (walls,) names of the walls, in the order given.
    wall_area
        [L^2] (walls,) area of a wall inside all other planes and the cylinder, of one period. Infinite: an
        endless wall.
    wall_wall
        (walls, walls) factors from wall to wall. NaN from an endless wall. The factor from wall w to sphere i
        follows from ``A_w F_wi = A_i F_iw``, where A is area times emissivity for exchange factors.
    wall_escaped, wall_error
        (walls,) factors from walls to the surroundings, and the estimated error of these and of ``wall_wall``.
    wall_correction
        Largest ``|sum - 1|`` of a row of a wall before closing. It shows how far rows of spheres and of walls
        disagree.
    wall_closure
        Largest ``|sum - 1|`` of a row of a wall after closing. In some beds that triangles cut, reciprocity and
        sums contradict each other. Then rows of walls are not closed, this is ``wall_correction``, and there is
        a warning.
    ids
        (n,) ids of the spheres as given. None: none were given, or there are clumps.
    body
        With clumps: (spheres,) the row of each sphere. Rows and columns are bodies then, n of them, in the order of
        their first spheres. None: there are no clumps.
    area
        [L^2] With clumps: (n,) exposed areas of the bodies. None: there are no clumps.
    closure_error
        Largest ``|sum - 1|`` of a raw row.
    reciprocity_error
        Largest ``|A_i F_ij - A_j F_ji| / max(A_i, A_j)``. NaN if rows are missing.
    node_emissivity
        (n,) emissivities of the nodes of spheres that conduct. None: spheres do not conduct.
    directions, fallbacks, rays
        Most directions of a row, 0 of a method without directions. Windows that the robust method for areas resolved. Rays
        traced, for exchange factors.
    overlap
        Largest overlap of two spheres over the smaller radius.
    threads, seconds
        Threads that were used, and [s] of computing.
    """

    indptr: NDArray[np.int64]
    indices: NDArray[np.int32]
    data: NDArray[np.float64]
    escaped: NDArray[np.float64]
    beyond: NDArray[np.float64]
    error: NDArray[np.float64]
    walls: NDArray[np.float64]
    wall_names: tuple[str, ...]
    wall_area: NDArray[np.float64]
    wall_wall: Optional[NDArray[np.float64]]
    wall_escaped: Optional[NDArray[np.float64]]
    wall_error: Optional[NDArray[np.float64]]
    wall_correction: Optional[float]
    wall_closure: Optional[float]
    ids: Optional[NDArray[np.uint64]]
    body: Optional[NDArray[np.int32]]
    area: Optional[NDArray[np.float64]]
    closure_error: float
    reciprocity_error: float
    node_emissivity: Optional[NDArray[np.float64]]
    directions: int
    fallbacks: int
    rays: int
    overlap: float
    threads: int
    seconds: float

    @property
    def n(self) -> int:
        """Number of rows: of spheres or, with clumps, of bodies."""
        return len(self.escaped)

    @property
    def shape(self) -> tuple[int, int]:
        """Shape of the matrix, (n, n)."""
        return self.n, self.n

    @property
    def matrix(self) -> Any:
        """The factors as a ``scipy.sparse.csr_matrix`` in the same memory. Needs SciPy."""
        from scipy.sparse import csr_matrix
        return csr_matrix((self.data, self.indices, self.indptr), shape=self.shape)

    def row(self, i: int) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """Columns and factors of row ``i``. Rows -1, -2 ... count from the end."""
        k = operator.index(i)
        if not -self.n <= k < self.n:
            raise IndexError(f"there is no row {k}; there are {self.n}")
        part = slice(self.indptr[k % self.n], self.indptr[k % self.n + 1])
        return self.indices[part], self.data[part]

    def wall(self, name: str) -> NDArray[np.float64]:
        """(n,) factors to the wall of this name."""
        if name not in self.wall_names:
            raise refuse(f"there is no wall {name!r}; there are {', '.join(self.wall_names) or 'none'}")
        return self.walls[:, self.wall_names.index(name)]

    def save(self, path: Folder) -> None:
        """Writes a .npz file, as the program does. ``scipy.sparse.load_npz`` reads the matrix from the file. The file
        also has `escaped`, `beyond` and `error`, and, if there are any, `ids`, `area`, `node_emissivity` and the factors
        of walls."""
        if not os.fspath(path).endswith(".npz"):
            raise refuse(f"{os.fspath(path)!r} does not end in .npz")
        arrays: dict[str, Any] = {
            "indices": self.indices, "indptr": self.indptr, "format": np.array(b"csr"), "shape": np.array(self.shape),
            "data": self.data, "escaped": self.escaped, "beyond": self.beyond, "error": self.error}
        if self.ids is not None:
            arrays["ids"] = self.ids
        if self.area is not None:
            arrays["area"] = self.area
        if self.node_emissivity is not None:
            arrays["node_emissivity"] = self.node_emissivity
        if self.wall_names:
            arrays |= {"body": self.walls, "wall_names": np.array([name.encode() for name in self.wall_names]),
                       "wall_area": self.wall_area}
        if self.wall_wall is not None and self.wall_names:
            arrays |= {"wall_wall": self.wall_wall, "wall_escaped": self.wall_escaped, "wall_error": self.wall_error}
        np.savez(os.fspath(path), **arrays)

    def __repr__(self) -> str:
        return (f"<fibrad.Factors: {self.n} spheres, {len(self.data)} entries, error {self.error.max(initial=0):.2g}, "
                f"{self.seconds:.3g} s>")


def take_factors(owner: Owner, wall_names: tuple[str, ...], ids: Optional[NDArray[np.uint64]],
                 nodes: Optional[NDArray[np.float64]]) -> Factors:
    """The arrays of the library, not copied."""
    found = owner.factors.contents
    matrix = found.matrix
    n, walls = matrix.n, matrix.walls
    entries = matrix.start[n]
    return Factors(
        indptr=_array(owner, matrix.start, (n + 1,), "i8"), indices=_array(owner, matrix.col, (entries,), "i4"),
        data=_array(owner, matrix.f, (entries,)), escaped=_array(owner, matrix.escaped, (n,)),
        beyond=_array(owner, matrix.beyond, (n,)), error=_array(owner, matrix.error, (n,)),
        walls=_array(owner, matrix.wall, (n, walls)), wall_names=wall_names,
        wall_area=_array(owner, found.wall_area, (walls,)),
        wall_wall=_array(owner, matrix.wall_wall, (walls, walls)) if matrix.wall_wall else None,
        wall_escaped=_array(owner, matrix.wall_escaped, (walls,)) if matrix.wall_escaped else None,
        wall_error=_array(owner, matrix.wall_error, (walls,)) if matrix.wall_error else None,
        ids=None if found.body else ids, body=_array(owner, found.body, (found.facts.spheres,), "i4") if found.body else None,
        area=_array(owner, found.area, (n,)) if found.area else None,
        wall_correction=matrix.wall_correction if matrix.wall_wall else None,
        wall_closure=matrix.wall_closure if matrix.wall_wall else None, closure_error=found.closure_error,
        reciprocity_error=found.reciprocity_error, node_emissivity=nodes, directions=found.directions, fallbacks=found.fallbacks,
        rays=found.rays, overlap=found.facts.overlap_max, threads=found.threads, seconds=found.seconds)


def _folder(scratch: Optional[Folder]) -> Optional[bytes]:
    if scratch is None:
        return None
    if not (os.path.isdir(scratch) and os.access(scratch, os.W_OK | os.X_OK)):
        raise refuse(f"scratch = {os.fspath(scratch)!r} is no folder that can be written")
    return os.fsencode(scratch)


class Rule:
    """A fibrad_bed_rule and its arrays."""

    def __init__(self, packing: Packing, container: Container, method: str, emissivity: Optional[ArrayLike],
                 k_star: Optional[ArrayLike], values: dict[str, Any], tolerance: Optional[float], cutoff: Optional[float],
                 wanted: Optional[ArrayLike], raw: bool, drop: float, scratch: Optional[Folder]):
        if method not in ("beam", "cast", "mc"):
            raise refuse(f"there is no method {method!r}; there are beam, cast, mc")
        kind = method if emissivity is None else "exchange"
        foreign = [name for name, value in values.items() if value is not None and name not in _METHODS[kind]]
        if tolerance is not None and kind in ("cast", "mc"):
            foreign.append("tolerance")
        if foreign or emissivity is not None and method != "beam":
            raise refuse(f"{', '.join(foreign or ['method'])}: not of "
                         f"{'exchange factors' if kind == 'exchange' else f'the method {method!r}'}")
        if emissivity is not None and packing.clump is not None and packing.clump.any():
            raise refuse("exchange factors of clumps are not computed: emissivity must be left out")
        if emissivity is None and k_star is not None:
            raise refuse("k_star is given, and emissivity is missing")
        self.nodes: Optional[NDArray[np.float64]] = None
        self._marks = marks(wanted, packing.n)
        far, allowed = real("cutoff", cutoff, 0.0, LENGTH_MAX), real("tolerance", tolerance, 0, 1)
        directions = whole("directions", values["directions"], *DIRECTIONS)
        seed = whole("seed", values["seed"], *_SEED)
        self.c = BedRule(wanted=pointer(self._marks, MARKS), raw=bool(raw), walls=1, drop=real("drop", drop, 0, 1),
                         scratch=_folder(scratch))
        if kind == "exchange":
            paths = whole("paths", values["paths"], 1, 2**28)
            rule = ExchangeRule(directions=directions, paths=paths, seed=seed, cutoff=far, tolerance=allowed)
            self._grey(rule, packing, container, emissivity, k_star)
            self.c.exchange = ctypes.pointer(rule)
        elif kind == "beam":
            self.c.beam = ctypes.pointer(BeamRule(directions=directions, cutoff=far, tolerance=allowed))
        else:
            rays = whole("rays", values["rays"], 1, 2**32 - 1)
            self.c.cast = ctypes.pointer(CastRule(rays=rays, random=kind == "mc", seed=seed, cutoff=far))

    def _grey(self, rule: Any, packing: Packing, container: Container, emissivity: Any,
              k_star: Optional[ArrayLike]) -> None:
        self._emissivity = per_sphere("emissivity", emissivity, packing.n, 0, 1, packing.names)
        self._of_walls = container.emissivities(container.walls)
        rule.emissivity, rule.wall_emissivity = pointer(self._emissivity), pointer(self._of_walls)
        if k_star is None:
            return
        self._k_star = per_sphere("k_star", k_star, packing.n, RELATIVE_CONDUCTIVITY_MIN, np.inf, packing.names)
        nodes = map(library.fibrad_node_emissivity, self._emissivity, self._k_star)
        self.nodes = np.fromiter(nodes, np.float64, packing.n)
        rule.conductivity, rule.node_emissivity = pointer(self._k_star), pointer(self.nodes)
