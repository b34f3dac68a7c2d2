# _values.py - arguments as the library takes them, or a clear refusal. SPDX-License-Identifier: MIT
from __future__ import annotations

import operator
from collections.abc import Iterable, Mapping
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import ARGUMENT, InputError


def refuse(text: str, *spheres: int) -> InputError:
    return InputError(text, ARGUMENT, spheres)


def whole(name: str, value: Optional[int], low: int, high: int) -> int:
    """A whole number, low to high. None: 0, which stands for the default of the library."""
    if value is None:
        return 0
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be a whole number, not {value!r}") from None
    if not low <= number <= high:
        raise refuse(f"{name} = {number} is not in [{low}, {high}]")
    return number


def real(name: str, value: Optional[float], low: float, high: float) -> float:
    """A number, low to high. None: 0, which stands for the default of the library."""
    if value is None:
        return 0.0
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise refuse(f"{name} must be a number, not {value!r}") from None
    if not low <= number <= high:
        raise refuse(f"{name} = {number} is not in [{low:g}, {high:g}]")
    return number


def mapping(name: str, value: Optional[Mapping[str, Any]], like: str) -> Mapping[str, Any]:
    """A mapping. None: an empty one."""
    if value is not None and not isinstance(value, Mapping):
        raise refuse(f"{name} must be a mapping such as {like}, not {value!r}")
    return value or {}


def several(name: str, value: Union[str, Iterable[Any]]) -> list[Any]:
    """Names, or one of them."""
    if isinstance(value, str):
        return [value]
    if not isinstance(value, Iterable):
        raise refuse(f"{name} must be a name or several of them, not {value!r}")
    return list(value)


def doubles(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """An aligned array of float64: the given array, or a copy. An array with masked elements, or without numbers, is
    refused."""
    if isinstance(value, np.ma.MaskedArray) and np.any(value.mask):
        raise refuse(f"{name} has masked elements")
    array = np.asarray(value)
    try:
        if array.dtype.kind in "fiubO":
            return np.require(array, np.float64, "A")
    except (TypeError, ValueError):
        pass  # objects that are no numbers
    raise refuse(f"{name} must be numbers, not {array.dtype}")


def per_sphere(name: str, value: ArrayLike, n: int, low: float, high: float, names: "Names",
               some: bool = False) -> NDArray[np.float64]:
    """[n] values, low to high, contiguous. A number holds for all spheres. With `some`, NaN is allowed."""
    array = doubles(name, value)
    if array.shape not in ((), (n,)):
        raise refuse(f"{name} has the shape {array.shape}; a number or {n} of them, one for each sphere, are wanted")
    array = np.ascontiguousarray(np.broadcast_to(array, (n,)))
    wrong = np.flatnonzero(~((array >= low) & (array <= high) | (some & np.isnan(array))))
    if wrong.size:
        i = int(wrong[0])
        raise refuse(f"{name} of {names(i)} is {array[i]}, not in [{low:g}, {high:g}]", i)
    return array


def marks(wanted: Optional[ArrayLike], n: int) -> Optional[NDArray[np.uint8]]:
    """[n] marks of rows: 1 if the row is wanted. `wanted` is a mask or positions."""
    if wanted is None:
        return None
    array = np.asarray(wanted)
    if array.dtype == bool:
        if array.shape != (n,):
            raise refuse(f"wanted has the shape {array.shape}; a mask has one element for each of {n} spheres")
        return array.astype(np.uint8)
    if array.size and (array.dtype.kind not in "iu" or array.min() < 0 or array.max() >= n):
        raise refuse(f"wanted must be a mask or positions [0, {n})")
    marked = np.zeros(n, np.uint8)
    marked[array.astype(np.intp)] = 1
    return marked


class Names:
    """The names of spheres in messages: ids if there are any, else positions."""

    def __init__(self, ids: Optional[NDArray[np.uint64]]):
        self._ids = ids

    def __call__(self, i: int) -> str:
        return f"sphere {i}" if self._ids is None else f"sphere of id {self._ids[i]}"
