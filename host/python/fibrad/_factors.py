# _factors.py - view factors, exchange factors and displacements of whole beds. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import dataclasses
import operator
import os
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._call import Call, Progress
from ._library import library
from ._limits import DIRECTIONS, FLIGHTS_MAX, LENGTH_MAX, NODES, RELATIVE_CONDUCTIVITY_MIN
from ._scene import Container, Packing, Walls, pointer
from ._structures import (BeamRule, BedFactors, BedOptions, CastRule, Displacement, DisplacementRule, ExchangeRule,
                          SurfaceRule)
from ._values import marks, per_sphere, real, refuse, whole
from ._warnings import warn, warn_overlap, warn_rows, warn_walls

Folder = Union[str, "os.PathLike[str]"]

_SEED = (0, 2**64 - 1)
_FAR = (0.0, LENGTH_MAX)
_METHODS = {"beam": {"directions", "points", "tolerance"}, "surface": {"nodes"}, "cast": {"rays", "seed"},
            "mc": {"rays", "seed"}}


class _Owner:
    """Factors of the library. They are freed with the last array that refers to them."""

    def __init__(self) -> None:
        self.factors: Any = ctypes.POINTER(BedFactors)()

    def __del__(self, free: Any = library.fibrad_bed_free) -> None:  # bound: at exit the module may be gone
        free(self.factors)


class _Memory:
    """The array interface of numpy for memory of the library."""

    def __init__(self, owner: _Owner, address: Any, shape: tuple[int, ...], kind: str):
        self._owner = owner
        self.__array_interface__ = {"data": (ctypes.cast(address, ctypes.c_void_p).value, False), "shape": shape,
                                    "typestr": np.dtype(kind).str, "version": 3}


def _array(owner: _Owner, address: Any, shape: tuple[int, ...], kind: str = "f8") -> NDArray[Any]:
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
    escaped
        (n,) factors to the surroundings.
    beyond
        (n,) fractions whose target is not known, beyond the cutoff.
    error
        (n,) estimated error of each row.
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
    wall_escaped
        (walls,) factors from walls to the surroundings.
    wall_error
        (walls,) estimated error of ``wall_wall`` and ``wall_escaped``.
    wall_correction
        Largest ``|sum - 1|`` of a row of a wall before closing. It shows how far rows of spheres and of walls
        disagree.
    wall_closure
        Largest ``|sum - 1|`` of a row of a wall after closing. In some beds that triangles cut, reciprocity and
        sums contradict each other. Then rows of walls are not closed, this is ``wall_correction``, and there is
        a warning.
    ids
        (n,) ids of the spheres as given. None: none were given.
    closure_error
        Largest ``|sum - 1|`` of a raw row.
    reciprocity_error
        Largest ``|A_i F_ij - A_j F_ji| / max(A_i, A_j)``. NaN if rows are missing.
    node_emissivity
        (n,) emissivities of the nodes of spheres that conduct. None: spheres do not conduct.
    directions
        Most directions of a row. 0: a method without directions.
    fallbacks
        Windows that the robust method for areas resolved.
    rays
        Rays traced, for exchange factors.
    overlap
        Largest overlap of two spheres over the smaller radius.
    threads
        Threads that were used.
    seconds
        [s] of computing.
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
        """Number of spheres."""
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
        also has `escaped`, `beyond` and `error`, and, if there are any, `ids`, `node_emissivity` and the factors of
        walls."""
        if not os.fspath(path).endswith(".npz"):
            raise refuse(f"{os.fspath(path)!r} does not end in .npz")
        arrays: dict[str, Any] = {
            "indices": self.indices, "indptr": self.indptr, "format": np.array(b"csr"), "shape": np.array(self.shape),
            "data": self.data, "escaped": self.escaped, "beyond": self.beyond, "error": self.error}
        if self.ids is not None:
            arrays["ids"] = self.ids
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


def _factors(owner: _Owner, wall_names: tuple[str, ...], ids: Optional[NDArray[np.uint64]],
             nodes: Optional[NDArray[np.float64]]) -> Factors:
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
        wall_error=_array(owner, matrix.wall_error, (walls,)) if matrix.wall_error else None, ids=ids,
        wall_correction=matrix.wall_correction if matrix.wall_wall else None,
        wall_closure=matrix.wall_closure if matrix.wall_wall else None, closure_error=found.closure_error,
        reciprocity_error=found.reciprocity_error, node_emissivity=nodes, directions=found.directions, fallbacks=found.fallbacks,
        rays=found.rays, overlap=found.facts.overlap_max, threads=found.threads, seconds=found.seconds)


class _Job:
    """The arguments that all functions of beds have in common."""

    def __init__(self, x: ArrayLike, r: ArrayLike, box: Optional[ArrayLike], walls: Optional[Walls],
                 ids: Optional[ArrayLike], wanted: Optional[ArrayLike], threads: Optional[int],
                 progress: Optional[Progress]):
        self.packing = Packing(x, r, ids)
        self.container = Container(box, walls, self.packing)
        warn_walls(self.packing, self.container)
        self.marks = marks(wanted, self.packing.n)
        self.wanted = pointer(self.marks, ctypes.POINTER(ctypes.c_ubyte))
        self._call = Call(threads, progress)
        self._nodes: Optional[NDArray[np.float64]] = None

    def call(self, function: Any, *arguments: Any) -> None:
        status = self._call(function, self.container.config, self.packing.spheres, *arguments)
        if status:
            raise self.packing.error(status, self._call.run.fault, self.container)

    @property
    def run(self) -> Any:
        return self._call.run

    def factors(self, function: Any, tolerance: Optional[float], *arguments: Any) -> Factors:
        owner = _Owner()
        self.call(function, *arguments, self.run, ctypes.byref(owner.factors))
        factors = _factors(owner, self.container.names, self.packing.ids, self._nodes)
        warn_overlap(self.packing, owner.factors.contents.facts)
        warn_rows(self.packing, owner.factors.contents)
        if tolerance is not None and factors.error.max(initial=0) > tolerance:
            warn(f"the estimated error is {factors.error.max():.3g}, above the tolerance of {tolerance:g}: no more "
                 "directions or paths are possible")
        return factors

    def rule(self, kind: Any, emissivity: ArrayLike, wall_emissivity: Any, k_star: Optional[ArrayLike] = None,
             **values: Any) -> Any:
        self._emissivity = per_sphere("emissivity", emissivity, self.packing.n, 0, 1, self.packing.names)
        self._wall_emissivity = self.container.per_wall("wall_emissivity", wall_emissivity, 0, 1)
        self._k_star = None if k_star is None else per_sphere(
            "k_star", k_star, self.packing.n, RELATIVE_CONDUCTIVITY_MIN, np.inf, self.packing.names)
        return kind(emissivity=pointer(self._emissivity), wall_emissivity=pointer(self._wall_emissivity),
                    conductivity=pointer(self._k_star), **values)

    def between_nodes(self, rule: Any) -> Any:
        """The rule for exchange factors: between nodes, if spheres conduct."""
        if self._k_star is not None:
            node = map(library.fibrad_node_emissivity, self._emissivity, self._k_star)
            self._nodes = np.fromiter(node, np.float64, self.packing.n)
            rule.node_emissivity = pointer(self._nodes)
        return rule


def _beam_rule(values: dict[str, Any], cutoff: float) -> Any:
    points = whole("points", values["points"], 0, 256)
    if points not in (0, 64, 128, 256):
        raise refuse(f"points = {points} is neither 64, 128 nor 256")
    tolerance = real("tolerance", values["tolerance"], 0, 1)
    directions = whole("directions", values["directions"], *DIRECTIONS)
    return BeamRule(directions=directions, points=points, cutoff=cutoff, tolerance=tolerance)


def _folder(scratch: Optional[Folder]) -> Optional[bytes]:
    if scratch is None:
        return None
    if not (os.path.isdir(scratch) and os.access(scratch, os.W_OK | os.X_OK)):
        raise refuse(f"scratch = {os.fspath(scratch)!r} is no folder that can be written")
    return os.fsencode(scratch)


def _method_options(method: str, values: dict[str, Any], cutoff: Optional[float]) -> dict[str, Any]:
    """The rule of the method, as a field of fibrad_bed_options. Values for other methods are refused."""
    if method not in _METHODS:
        raise refuse(f"there is no method {method!r}; there are {', '.join(_METHODS)}")
    foreign = [name for name, value in values.items() if value is not None and name not in _METHODS[method]]
    if foreign:
        raise refuse(f"{', '.join(foreign)}: not of the method {method!r}")
    far = real("cutoff", cutoff, *_FAR)
    if method == "surface":
        return {"surface": ctypes.pointer(SurfaceRule(nodes=whole("nodes", values["nodes"], *NODES), cutoff=far))}
    if method == "beam":
        return {"beam": ctypes.pointer(_beam_rule(values, far))}
    return {"cast": ctypes.pointer(CastRule(rays=whole("rays", values["rays"], 1, 2**32 - 1), random=method == "mc",
                                            seed=whole("seed", values["seed"], *_SEED), cutoff=far))}


def view_factors(x: ArrayLike, r: ArrayLike, *, box: Optional[ArrayLike] = None, walls: Optional[Walls] = None,
                 tolerance: Optional[float] = None, directions: Optional[int] = None, points: Optional[int] = None,
                 method: str = "beam", nodes: Optional[int] = None, rays: Optional[int] = None,
                 seed: Optional[int] = None, cutoff: Optional[float] = None, wanted: Optional[ArrayLike] = None,
                 raw: bool = False, drop: float = 0.0, ids: Optional[ArrayLike] = None, threads: Optional[int] = None,
                 scratch: Optional[Folder] = None, progress: Optional[Progress] = None) -> Factors:
    """View factors between all spheres of a bed.

    Parameters
    ----------
    x : (n, 3) array
        [L] Centres. L is any unit of length.
    r : (n,) array or float
        [L] Radii. x and r are not copied if they are of float64 and their strides are whole numbers of float64.
    box : (3,) array, optional
        [L] Lengths of the periodic box. 0: the axis is open. Default: all axes are open.
    walls : mapping or sequence of pairs, optional
        Walls by name: ``{"zmin": 0.0, "zmax": 1.0, "cylinder": (x, y, radius), "hopper": Mesh(...)}``. The names of
        planes are xmin, xmax, ymin, ymax, zmin and zmax, with the coordinate [L]. The cylinder is parallel to the z
        axis. ``"xcylinder": (y, z, radius)`` and ``"ycylinder": (x, z, radius)`` are parallel to the other axes. A
        `Mesh` has any other name. ``"zmax": "open"`` is an opening: the container ends there and the
        surroundings begin, where the spheres end. ``"zmax": ("open", at)`` is an opening at the coordinate ``at``.
        Default: no walls.
    tolerance : float, optional
        The error allowed in every row. Directions are added until it is met. Default: none.
    directions : int, optional
        Directions of beams, 8 to 65536. The error falls as ``directions**-1.5``. Default: 233. If all rows
        of a bed are averaged, it is the number of lines, up to 1024. Default: 181, among walls 233, and more for few
        spheres.
    points : {64, 128, 256}, optional
        Points of each window of a beam. Along lines they stand for masks of 16, 32 and 64 chords. Default: along lines
        as many chords as suit their number, else exact visible areas.
    method : {"beam", "surface", "cast", "mc"}
        "beam": parallel beams. "surface": nodes on surfaces, after Bao, Gao and Tan. "cast": quasi-random rays. "mc":
        random rays.
    nodes : int, optional
        For "surface": nodes on each sphere, a Fibonacci number from 8 to 987. Default: 55.
    rays, seed : int, optional
        For "cast" and "mc": rays from each sphere, and the seed of the random numbers. Default: 20000 and 0.
    cutoff : float, optional
        [L] Spheres with centres farther apart do not see each other. Default: none.
    wanted : (n,) bool array or positions, optional
        Rows that are wanted. The other rows are empty, and the wanted rows are raw. Default: all.
    raw : bool
        True: rows as they were computed. False: averaged, so that ``A_i F_ij = A_j F_ji``, and closed.
    drop : float
        0 to 1. Pairs of entries are dropped if both are below this. The other entries are enlarged, so that the sums
        of the rows stay.
    ids : (n,) array of whole numbers, optional
        Names of the spheres, from 0. Messages use them. They seed random paths and decide ties.
    threads : int, optional
        1 to 1024. Changes no bit. Default: ``OMP_NUM_THREADS``, or else all processors.
    scratch : path, optional
        A folder for files that hold rows and matrix, for matrices larger than memory. The files have no names and
        vanish with the result. Changes no bit. Default: in memory.
    progress : callable, optional
        Called as ``progress(stage, done, total)`` up to 20 times a second. If it returns something true, the call ends
        with `Cancelled`.

    Returns
    -------
    Factors

    Raises
    ------
    InputError
        A value is out of its range, or the spheres overlap too much. The attribute ``spheres`` has those at fault.
    OutOfMemory
        There is no more memory.
    Cancelled
        The progress function has asked to stop.
    """
    values = {"tolerance": tolerance, "directions": directions, "points": points, "nodes": nodes, "rays": rays,
              "seed": seed}
    rule = _method_options(method, values, cutoff)
    job = _Job(x, r, box, walls, ids, wanted, threads, progress)
    options = BedOptions(wanted=job.wanted, raw=bool(raw), walls=1, drop=real("drop", drop, 0, 1),
                         scratch=_folder(scratch), **rule)
    return job.factors(library.fibrad_view_factors, tolerance, options)


def exchange_factors(x: ArrayLike, r: ArrayLike, emissivity: ArrayLike, *, box: Optional[ArrayLike] = None,
                     walls: Optional[Walls] = None, wall_emissivity: Any = None,
                     k_star: Optional[ArrayLike] = None, tolerance: Optional[float] = None,
                     directions: Optional[int] = None, paths: Optional[int] = None, seed: Optional[int] = None,
                     cutoff: Optional[float] = None, wanted: Optional[ArrayLike] = None, raw: bool = False,
                     drop: float = 0.0, ids: Optional[ArrayLike] = None, threads: Optional[int] = None,
                     scratch: Optional[Folder] = None, progress: Optional[Progress] = None) -> Factors:
    """Exchange factors between all grey diffuse spheres of a bed.

    D_ij is the fraction of the emission of sphere i that sphere j absorbs, directly or after diffuse reflections. The
    net power of sphere i is ``sum_j A_i e_i D_ij sigma (T_j**4 - T_i**4)``, where j counts walls and surroundings, too.

    With ``k_star`` the spheres conduct, and temperatures differ from point to point on each sphere. D_ij is then
    between nodes of emissivities n_i, `Factors.node_emissivity`. The net power is ``q_i = sum_j A_i n_i D_ij (N_j -
    N_i)`` with ``N_i = sigma T_i**4 - (1 / n_i - 1 / e_i) q_i / A_i`` and the mean temperature T_i of the surface. This
    is a linear system. Walls and surroundings have ``N = sigma T**4``.

    Parameters
    ----------
    x, r, box, walls, cutoff, wanted, raw, drop, ids, threads, scratch, progress
        As for `view_factors`.
    emissivity : (n,) array or float
        Emissivities of the spheres, 0 to 1.
    wall_emissivity : mapping or float
        Emissivities of the walls by name, or one for all, 0 to 1. Needed with walls.
    k_star : (n,) array or float, optional
        Relative conductivities of the spheres, ``k_s / (4 d sigma T**3)``, at least 1e-6, inf for one temperature.
        Default: each sphere has one temperature.
    tolerance : float, optional
        The error allowed in every row. Directions and paths are added until it is met. Default: none.
    directions : int, optional
        Directions of the first segment, the way to the first surface. Default: 50.
    paths : int, optional
        Paths that follow the reflections. Default: 400.
    seed : int, optional
        Of the random numbers. Default: 0.

    Returns
    -------
    Factors

    Raises
    ------
    InputError, OutOfMemory, Cancelled
        As for `view_factors`.
    """
    job = _Job(x, r, box, walls, ids, wanted, threads, progress)
    rule = job.rule(ExchangeRule, emissivity, wall_emissivity, k_star,
                    directions=whole("directions", directions, *DIRECTIONS), paths=whole("paths", paths, 1, 2**28),
                    seed=whole("seed", seed, *_SEED), cutoff=real("cutoff", cutoff, *_FAR),
                    tolerance=real("tolerance", tolerance, 0, 1))
    options = BedOptions(wanted=job.wanted, raw=bool(raw), walls=1, drop=real("drop", drop, 0, 1),
                         scratch=_folder(scratch))
    return job.factors(library.fibrad_exchange_factors, tolerance, job.between_nodes(rule), options)


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Displacements:
    """How far the emission of each sphere is carried: from its centre to the centre of the sphere that absorbs.

    Of spheres that conduct: how far a path gets in a flight.

    Attributes
    ----------
    square
        [L^2] (n, 3) mean square displacement along each axis.
    error
        [L^2] (n, 3) estimated standard error of `square`.
    absorbed
        (n,) fraction of the emission that spheres absorb. Of spheres that conduct: of the paths that stay in
        the bed.
    rays
        (n,) rays traced.
    """

    square: NDArray[np.float64]
    error: NDArray[np.float64]
    absorbed: NDArray[np.float64]
    rays: NDArray[np.uint64]

    def __repr__(self) -> str:
        wanted = self.square[self.rays > 0]
        mean = ", ".join(f"{value:.4g}" for value in wanted.mean(axis=0)) if len(wanted) else "none"
        return f"<fibrad.Displacements: {len(self.square)} spheres, mean square {mean}, {int(self.rays.sum())} rays>"


def displacements(x: ArrayLike, r: ArrayLike, emissivity: ArrayLike, *, box: Optional[ArrayLike] = None,
                  walls: Optional[Walls] = None, wall_emissivity: Any = None, k_star: Optional[ArrayLike] = None,
                  paths: Optional[int] = None, flights: Optional[int] = None, seed: Optional[int] = None, cutoff: Optional[float] = None, wanted: Optional[ArrayLike] = None,
                  ids: Optional[ArrayLike] = None, threads: Optional[int] = None,
                  progress: Optional[Progress] = None) -> Displacements:
    """Mean square displacements of radiation.

    The conductivity of a bed follows from them. For equal spheres of diameter d, solid fraction phi and emissivity e in
    a periodic box it is ``k = 4 sigma T**3 * 3 phi e square.mean(axis=0) / d``. With ``k_star`` the spheres
    conduct, temperatures differ from point to point of each sphere, and the factor e is left out.

    Parameters
    ----------
    x, r, emissivity, box, walls, wall_emissivity, seed, cutoff, wanted, ids, threads, progress
        As for `exchange_factors`. Spheres that are not wanted have zeros.
    k_star : (n,) array or float, optional
        Relative conductivities of the spheres, ``k_s / (4 d sigma T**3)``, at least 1e-6, inf for one temperature.
        Without walls and cutoff. Default: each sphere has one temperature.
    paths : int, optional
        Paths from each sphere. Default: 400.
    flights : int, optional
        With ``k_star``: flights whose displacements are correlated, 1 to 256. Default: 12.

    Returns
    -------
    Displacements

    Raises
    ------
    InputError, OutOfMemory, Cancelled
        As for `view_factors`.
    """
    job = _Job(x, r, box, walls, ids, wanted, threads, progress)
    rule = job.rule(DisplacementRule, emissivity, wall_emissivity, k_star, paths=whole("paths", paths, 1, 2**28),
                    seed=whole("seed", seed, *_SEED), cutoff=real("cutoff", cutoff, *_FAR),
                    flights=whole("flights", flights, 1, FLIGHTS_MAX))
    found: NDArray[Any] = np.zeros(job.packing.n, Displacement)
    job.call(library.fibrad_displacements, rule, job.wanted, job.run, pointer(found, ctypes.POINTER(Displacement)), None)
    return Displacements(*(np.ascontiguousarray(found[name]) for name in ("square", "error", "absorbed", "rays")))
