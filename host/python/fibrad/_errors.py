# _errors.py - what can go wrong, as exceptions. SPDX-License-Identifier: MIT
from __future__ import annotations

import errno
import os

from ._library import library

ARGUMENT, TABLE, GEOMETRY, UNSUPPORTED, MEMORY, CANCELLED, UNSOLVABLE, BACK = -1, -5, -6, -10, -11, -12, -13, -14
SUM, ENDLESS, FILE, UNSETTLED = -15, -16, -17, -18


class Error(Exception):
    """Any error of fibrad.

    Attributes
    ----------
    status : int
        The number of the error in ``fibrad.h``, -6 for example if a centre lies inside another sphere.
    spheres : tuple of int
        Positions of the spheres at fault, from 0. There are none, one or two.
    """

    status: int = 0
    spheres: tuple[int, ...] = ()

    def __init__(self, text: str, status: int = 0, spheres: tuple[int, ...] = ()):
        super().__init__(text)
        self.status = status
        self.spheres = spheres


class InputError(Error, ValueError):
    """A value is out of its range, or the bed cannot be computed."""


class FileError(Error, OSError):
    """A file cannot be made, read or written."""


class MissingFileError(FileError, FileNotFoundError):
    """There is no such file."""


class StateError(Error, RuntimeError):
    """A call comes too late or too early."""


class Cancelled(Error, RuntimeError):
    """A progress function has asked to stop."""


class OutOfMemory(Error, MemoryError):
    """The library has no more memory."""


_KINDS = {MEMORY: OutOfMemory, CANCELLED: Cancelled, ARGUMENT: InputError, TABLE: InputError, GEOMETRY: InputError,
          UNSUPPORTED: InputError, UNSOLVABLE: InputError, BACK: InputError, SUM: Error,
          ENDLESS: InputError, FILE: FileError, UNSETTLED: InputError}


def status_text(status: int) -> str:
    return str(library.fibrad_status_text(status).decode())


def why_text(why: int) -> str:
    return str(library.fibrad_why_text(why).decode())


def file_error(text: str, status: int) -> FileError:
    """The exception for a message that ends as the system says why a file cannot be opened."""
    number = next((number for number in errno.errorcode if text.endswith(os.strerror(number))), None)
    error = (MissingFileError if number == errno.ENOENT else FileError)(text, status)
    if number is not None:
        error.errno = number
    return error


def error_of(status: int, text: str, spheres: tuple[int, ...] = ()) -> Error:
    return _KINDS.get(status, StateError)(text, status, spheres)
