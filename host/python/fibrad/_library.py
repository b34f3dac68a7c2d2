# _library.py - libfibrad.so by ctypes, checked against the structures of this package. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import importlib.metadata
import os
import pathlib

from ._structures import FUNCTIONS, STRUCTURES


def _load() -> ctypes.CDLL:
    """The library that FIBRAD_LIBRARY names, that of the package, that of the source tree, or that of the system."""
    here = pathlib.Path(__file__).resolve().parent
    named = os.environ.get("FIBRAD_LIBRARY")
    places = [here / "libfibrad.so", here.parents[2] / os.environ.get("BUILD", "build") / "libfibrad.so"]
    path = named or next((str(place) for place in places if place.exists()), "libfibrad.so.3")
    try:
        return ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"fibrad: {path} cannot be loaded: {error}") from None


def _check(library: ctypes.CDLL) -> None:
    """The library must be that of this package: its version, and the sizes of its structures."""
    found = library.fibrad_version().decode()
    try:
        wanted = importlib.metadata.version("fibrad")
    except importlib.metadata.PackageNotFoundError:
        wanted = found  # used from the source tree
    if found != wanted:
        raise ImportError(f"fibrad: {library._name} is of version {found}, this package of {wanted}")
    for name, kind in STRUCTURES.items():
        size = library.fibrad_host_sizeof(name.encode())
        if size != ctypes.sizeof(kind):
            raise ImportError(f"fibrad: {library._name}: {name} has {size} bytes, "
                              f"this package has {ctypes.sizeof(kind)}")


library = _load()
for _name, (_result, _arguments) in FUNCTIONS.items():
    getattr(library, _name).restype, getattr(library, _name).argtypes = _result, _arguments
_check(library)
