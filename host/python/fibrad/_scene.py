# _scene.py - spheres, and triangles, as the library takes them. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._structures import Spheres
from ._values import Names, doubles, refuse

_STRIDE_MAX = 2**32 - 1
WHOLE: Any = ctypes.POINTER(ctypes.c_uint32)
MARKS: Any = ctypes.POINTER(ctypes.c_ubyte)


def pointer(array: Optional[NDArray[Any]], kind: Any = ctypes.POINTER(ctypes.c_double)) -> Any:
    """The address of an array, NULL for None."""
    return None if array is None else ctypes.cast(array.ctypes.data, kind)


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

    def __init__(self, x: ArrayLike, r: ArrayLike, ids: Optional[ArrayLike] = None,
                 clump: Optional[ArrayLike] = None):
        self.x = _strided(doubles("x", x))
        if self.x.ndim != 2 or self.x.shape[1] != 3:
            raise refuse(f"x has the shape {self.x.shape}; (n, 3) is wanted: the centres of n spheres")
        self.n = len(self.x)
        r = doubles("r", r)
        if r.shape not in ((), (self.n,)):
            raise refuse(f"r has the shape {r.shape}; a radius or {self.n} of them, one for each sphere, are wanted")
        self.r = _strided(np.broadcast_to(r, (self.n,)))
        self.ids = None if ids is None else self._take_ids(ids)
        self.clump = None if clump is None else self._take_clump(clump)
        self.names = Names(self.ids)
        columns = [pointer(self.x[:, k]) for k in range(3)] if self.n else [None] * 3
        self.spheres = Spheres(*columns, pointer(self.r), self.n, _stride(self.x), _stride(self.r),
                               pointer(self.ids, ctypes.POINTER(ctypes.c_uint64)), pointer(self.clump, WHOLE))

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

    def _take_clump(self, clump: ArrayLike) -> NDArray[np.uint32]:
        array = np.asarray(clump)
        if array.shape != (self.n,):
            raise refuse(f"clump has the shape {array.shape}; {self.n} are wanted, one for each sphere")
        if array.size and (array.min() < 0 or array.max() >= 2**32 or (array != np.floor(array)).any()):
            raise refuse("clump must be whole numbers from 0, below 2**32; 0 stands for a sphere that is alone")
        return np.require(array, np.uint32, ["C", "A"])


def period_of(box: Optional[ArrayLike]) -> NDArray[np.float64]:
    """Three lengths of the periodic box."""
    period = np.zeros(3) if box is None else doubles("box", box)
    if period.shape != (3,) or not (np.isfinite(period) & (period >= 0)).all():
        raise refuse("box must be three lengths; 0 stands for an open axis")
    return period


class Mesh:
    """The triangles of a wall, for `wall`: ``fibrad.wall(Mesh(vertices, triangles), name="hopper")``.

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
        """Reads a wall from an STL or OBJ file, as the program does. The file may be text or binary, also packed by gzip.
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
        vertices, triangles, both = stl(path, packing.spheres, period_of(box), scale, sides)
        return cls(vertices, triangles, back=both or None)

    def areas(self) -> NDArray[np.float64]:
        """[L^2] (t,) areas of the triangles."""
        a, b, c = (self.vertices[self.triangles[:, k]] for k in range(3))
        return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2)
