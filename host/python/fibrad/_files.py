# _files.py - beds and meshes from files, by libfibrad_files.so. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import dataclasses
import os
import pathlib
import threading
from collections.abc import Iterable, Mapping, Sequence
from ctypes import POINTER, c_char_p, c_double, c_int, c_int64, c_size_t, c_uint32, c_void_p
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import Error, InputError, OutOfMemory, file_error
from ._structures import Spheres
from ._values import mapping, real, refuse, several, whole
from ._warnings import warn

Path = Union[str, "os.PathLike[str]"]
_HEARD: Any = ctypes.CFUNCTYPE(None, c_void_p, c_char_p)
_SIDES = ("auto", "normals", "both")
_KINDS: dict[int, Any] = {3: InputError, 4: file_error, 5: OutOfMemory}
_busy = threading.Lock()
_loaded: list[Any] = []


def _structure(name: str, *fields: tuple[str, Any]) -> Any:
    """The structure NAME of file_arrays.h. Each field is one or more names, separated by blanks, and their type."""
    return type(name, (ctypes.Structure,),
                {"_fields_": [(one, kind) for names, kind in fields for one in names.split()]})


FileBed = _structure(
    "file_bed", ("x y z r", POINTER(c_double)), ("id", POINTER(c_int64)), ("extra", POINTER(c_double)),
    ("low high period", c_double * 3), ("frame timestep", c_int64), ("units", ctypes.c_char * 16), ("bed", c_void_p),
    ("n", c_uint32))
FileWanted = _structure("file_wanted", ("path", c_char_p), ("frame", c_int64), ("column name only skip", POINTER(c_char_p)),
                        ("columns names onlys skips", c_size_t), ("no_radius", c_int))
FileMesh = _structure("file_mesh", ("vertex", POINTER(c_double)), ("corner", POINTER(c_uint32)), ("meshes", c_void_p),
                      ("vertices n", c_uint32), ("both", c_int))


def _library() -> Any:
    """libfibrad_files.so of the package, or else of the source tree."""
    if _loaded:
        return _loaded[0]
    here = pathlib.Path(__file__).resolve().parent
    name = "libfibrad_files.so"
    places = [here / name, here.parents[2] / os.environ.get("BUILD", "build") / name]
    path = next((place for place in places if place.exists()), None)
    if path is None:
        raise Error(f"fibrad was installed without {name}, which reads files: zlib was missing (Debian: zlib1g-dev)")
    library = ctypes.CDLL(str(path))
    library.fibrad_file_sizeof.argtypes, library.fibrad_file_sizeof.restype = [c_char_p], c_size_t
    for kind in (FileBed, FileWanted, FileMesh):
        if library.fibrad_file_sizeof(kind.__name__.encode()) != ctypes.sizeof(kind):
            raise ImportError(f"fibrad: {path} is of another version")
    library.fibrad_file_read.argtypes = [POINTER(FileWanted), POINTER(FileBed), _HEARD, c_void_p]
    library.fibrad_file_mesh.argtypes = [c_char_p, c_double, c_int, POINTER(Spheres), POINTER(c_double),
                                         POINTER(FileMesh), _HEARD, c_void_p]
    library.fibrad_file_free.restype = library.fibrad_file_mesh_free.restype = None
    _loaded.append(library)
    return library


def _call(function: Any, *arguments: Any) -> None:
    """Calls a function. Its lines become warnings. After an error the last line is the text of the exception."""
    lines: list[str] = []
    heard = _HEARD(lambda context, line: lines.append(line.decode(errors="replace")))
    status = function(*arguments, heard, None)
    if status:
        raise _KINDS.get(status, Error)(lines[-1] if lines else "out of memory", status)
    for line in lines:
        warn(line)


def _array(address: Any, shape: tuple[int, ...]) -> NDArray[Any]:
    return np.ctypeslib.as_array(address, shape).copy()


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class FileFrame:
    """The spheres of one frame of a file, in the order of their ids. L is the unit of length of the file.

    Attributes
    ----------
    x, r
        [L] (n, 3) centres and (n,) radii.
    ids
        (n,) ids. None: the file has none.
    box
        [L] (3,) lengths of the periodic box, for the argument `box`. 0: the axis is open.
    low, high
        [L] (3,) lower and upper corner of the box in the file. 0 if the file has no box.
    columns
        (n,) values of each further column that was wanted.
    unit
        Name of the unit of length in the file. None: the file names none.
    frame, timestep
        Number of the frame in the file, from 0, and timestep in the file. None: the file has no timesteps.
    """

    x: NDArray[np.float64]
    r: NDArray[np.float64]
    ids: Optional[NDArray[np.int64]]
    box: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    columns: dict[str, NDArray[np.float64]]
    unit: Optional[str]
    frame: int
    timestep: Optional[int]

    def __repr__(self) -> str:
        return f"<fibrad.FileFrame: {len(self.x)} spheres, frame {self.frame}>"


def _texts(name: str, values: Iterable[Any]) -> Any:
    """An array of C strings. Numbers are written as they are shown."""
    texts = [str(value) for value in values]
    if any("\0" in text for text in texts):
        raise refuse(f"{name} has a text with a zero byte")
    return (c_char_p * len(texts))(*(text.encode() for text in texts))


def _pairs(name: str, values: Optional[Mapping[str, Any]]) -> Any:
    """The keys and values of a mapping in turn, as C strings."""
    return _texts(name, (text for pair in mapping(name, values, "{'x': 'p_x'}").items() for text in pair))


def _path(path: Path) -> bytes:
    name = os.fsencode(path)
    if b"\0" in name:
        raise refuse(f"{path!r} has a zero byte and names no file")
    return name


def read(path: Path, frame: int = -1, *, columns: Sequence[str] = (), radius: Optional[float] = None,
         names: Optional[Mapping[str, Union[str, int]]] = None, only: Optional[Mapping[str, Any]] = None,
         skip: Optional[Mapping[str, Any]] = None) -> FileFrame:
    """Reads the spheres of a file, as the program does. ``docs/files.md`` lists the formats.

    Parameters
    ----------
    path : str or path
        The file. Its contents tell its format.
    frame : int
        Number of the frame, from 0. -1: the last frame.
    columns : names, optional
        Further columns that are wanted, ``["v_T"]`` for example. Values have the unit of the file.
    radius : float, optional
        [L] Radius of all spheres, for files without radii.
    names : mapping, optional
        What the file calls columns, as ``--columns`` of the program: ``{"x": "p_x", "d": "diameters [mm]"}``. If a
        table has no header, the number of the column, from 1.
    only, skip : mapping, optional
        Rows that are read: those with ``only={"type": 1}``, a text or number of each column, and without
        ``skip={"material": "glass"}``.

    Returns
    -------
    FileFrame

    Raises
    ------
    InputError
        The file is no bed. The text names the line.
    FileNotFoundError, FileError
        There is no such file, or it cannot be opened. FileNotFoundError is a FileError here.
    """
    columns = several("columns", columns)
    radii = [known for known in names or () if str(known).lower() in ("r", "radius", "d", "diameter")]
    if radius is not None and radii or len(radii) > 1:
        raise refuse(f"names has {', '.join(map(repr, radii))}{' beside radius' if radius is not None else ''}: "
                     "one of them gives the radii")
    frame = -1 if frame == -1 else whole("frame", frame, 0, 2**63 - 2)
    library, found = _library(), FileBed()
    texts = [_texts("columns", columns), _pairs("names", names), _pairs("only", only), _pairs("skip", skip)]
    wanted = FileWanted(_path(path), frame, *texts, len(texts[0]), *(len(pairs) // 2 for pairs in texts[1:]),
                        radius is not None)
    with _busy:
        try:
            _call(library.fibrad_file_read, wanted, found)
            n = found.n
            x = np.stack([_array(axis, (n,)) for axis in (found.x, found.y, found.z)], axis=1)
            extra = _array(found.extra, (n, len(columns))) if columns else np.zeros((n, 0))
            return FileFrame(
                x=x, r=_array(found.r, (n,)) if radius is None else np.full(n, float(radius)),
                ids=_array(found.id, (n,)) if found.id else None, box=np.array(found.period), low=np.array(found.low),
                high=np.array(found.high), columns={name: extra[:, k].copy() for k, name in enumerate(columns)},
                unit=found.units.decode() or None, frame=found.frame,
                timestep=found.timestep if found.timestep >= 0 else None)
        finally:
            library.fibrad_file_free(ctypes.byref(found))


def stl(path: Path, spheres: Any, period: ArrayLike, scale: float, sides: str) -> tuple[Any, Any, bool]:
    """Vertices and triangles of an STL or OBJ file, and whether both sides belong to the wall. The fronts belong to the
    wall."""
    if sides not in _SIDES:
        raise refuse(f"sides = {sides!r} is none of {', '.join(_SIDES)}")
    scale = real("scale", scale, 1e-12, 1e12)
    library, found = _library(), FileMesh()
    with _busy:
        try:
            _call(library.fibrad_file_mesh, _path(path), scale, _SIDES.index(sides), spheres,
                  (c_double * 3)(*np.asarray(period, float)), found)
            return (_array(found.vertex, (found.vertices, 3)), _array(found.corner, (found.n, 3)), bool(found.both))
        finally:
            library.fibrad_file_mesh_free(ctypes.byref(found))
