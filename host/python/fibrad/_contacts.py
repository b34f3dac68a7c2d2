# _contacts.py - heat that contacts and gas conduct. SPDX-License-Identifier: MIT
from __future__ import annotations

import ctypes
import math
from collections.abc import Mapping
from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._limits import CONDUCTANCE_MAX
from ._library import library
from ._scene import Container, Packing, Walls, pointer
from ._structures import ContactList, ContactRule
from ._values import doubles, per_sphere, real, refuse

_SPOTS: Mapping[Optional[str], int] = {None: 0, "lens": 1, "hertz": 2}


class Contacts(NamedTuple):
    """Contacts of a bed. Hand them to `Heat.solve`."""

    first: NDArray[np.uint32]
    """(m,) a sphere."""
    second: NDArray[np.uint32]
    """(m,) another sphere, or n plus the number of a wall."""
    conductance: NDArray[np.float64]
    """[W/K] (m,)"""


def _ends(name: str, given: Any, n: int, container: Container) -> NDArray[np.uint32]:
    """Numbers of spheres, and names of walls as n plus their numbers."""
    numbers = [n + container.names.index(end) if isinstance(end, str) and end in container.names else end
               for end in np.asarray(given, dtype=object).ravel().tolist()]
    wrong = [end for end in numbers if not isinstance(end, (int, np.integer)) or not 0 <= end < n + len(container.names)]
    if wrong:
        raise refuse(f"contacts: {name} has {wrong[0]!r}, which is neither a sphere nor a wall")
    return np.array(numbers, np.uint32)


def contacts_of(contacts: Any, n: int, container: Container) -> Contacts:
    """The argument ``contacts`` of `Heat.solve`: (i, j, conductance), or a symmetric SciPy matrix."""
    if hasattr(contacts, "tocoo"):
        if contacts.shape != (n, n):
            raise refuse(f"contacts has the shape {contacts.shape}; ({n}, {n}) is wanted")
        if abs(contacts - contacts.T).max() > 1e-12 * abs(contacts).max():
            raise refuse("contacts is not symmetric")
        upper = contacts.tocoo()
        above = upper.row < upper.col
        contacts = upper.row[above], upper.col[above], upper.data[above]
    if len(contacts) != 3:
        raise refuse("contacts must be (i, j, conductance) or a SciPy matrix")
    values = np.ascontiguousarray(doubles("contacts", contacts[2]).ravel())
    first, second = (_ends(name, given, n, container) for name, given in zip("ij", contacts))
    if not first.shape == second.shape == values.shape:
        raise refuse(f"contacts has {first.size} values of i, {second.size} of j and {values.size} conductances")
    bad = np.flatnonzero(~((values >= 0) & (values <= CONDUCTANCE_MAX)))
    if bad.size:
        raise refuse(f"contacts: the conductance of {first[bad[0]]} and {second[bad[0]]} is {values[bad[0]]}")
    return Contacts(first, second, values)


def contacts(x: ArrayLike, r: ArrayLike, *, spots: Optional[str] = "lens", conductivity: Optional[ArrayLike] = None,
             scale: Optional[float] = None, gas_conductivity: Optional[float] = None, gas_gap: float = 0.65,
             gas_jump: float = 0.0, gas_alone: bool = False, box: Optional[ArrayLike] = None, walls: Optional[Walls] = None,
             ids: Optional[ArrayLike] = None) -> Contacts:
    """Contacts of spheres with each other and with walls, and what they conduct.

    Parameters
    ----------
    x, r, box, walls, ids
        As for `Heat`, in metres.
    spots : {"lens", "hertz"}, optional
        Radius a of the spot of two spheres that overlap: that of the circle in which they cut each other, or Hertz's.
        None: only gas conducts.
    conductivity : (n,) array or float, optional
        [W/(m K)] Conductivities k of the solid. A spot conducts 2 k a, to a wall 4 k a. Needed unless `spots` is None
        and `gas_alone` is True.
    scale : float, optional
        Multiplies the radii of spots. Default: 1.
    gas_conductivity : float, optional
        [W/(m K)] Of the gas in narrow gaps. Default: no gas conducts.
    gas_gap : float
        Gas conducts out to this distance from the smaller sphere, in its radii, 0 to 1.
    gas_jump : float
        [m] Length added to gaps, since narrow gaps conduct less.
    gas_alone : bool
        True: lines through gas have no resistance in the solid.

    Returns
    -------
    Contacts

    Raises
    ------
    InputError
        A value is out of its range.
    """
    packing = Packing(x, r, ids)
    container = Container(box, walls, packing)
    if spots not in _SPOTS:
        raise refuse(f"spots is {spots!r}; 'lens', 'hertz' or None are wanted")
    if conductivity is None and not (spots is None and gas_alone):
        raise refuse("conductivity is missing")
    solid = per_sphere("conductivity", 1.0 if conductivity is None else conductivity, packing.n, 5e-324, math.inf,
                       packing.names)
    rule = ContactRule(spots=_SPOTS[spots], scale=real("scale", scale, 0, 1e6), gas_least=4e-10,
                       gas_reach=real("gas_gap", gas_gap, 0, 1) if gas_conductivity is not None else 0.0,
                       gas_jump=real("gas_jump", gas_jump, 0, 1), gas_alone=bool(gas_alone))
    found = ctypes.POINTER(ContactList)()
    status = library.fibrad_contacts_find(container.config, packing.spheres, rule, ctypes.byref(found))
    if status:
        raise refuse("these contacts cannot be found")
    try:
        m = found.contents.n
        ends = [np.ctypeslib.as_array(end, (m,)).copy() if m else np.zeros(0, np.uint32)
                for end in (found.contents.first, found.contents.second)]
        conductance = np.zeros(m)
        gas = None if gas_conductivity is None else np.full(m, real("gas_conductivity", gas_conductivity, 0, 1e12))
        library.fibrad_contacts_conduct(found, rule, pointer(solid), pointer(gas), pointer(conductance))
    finally:
        library.fibrad_contacts_free(found)
    return Contacts(ends[0], ends[1], conductance)
