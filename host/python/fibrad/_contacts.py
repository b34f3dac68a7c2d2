# _contacts.py - heat that contacts and gas conduct. SPDX-License-Identifier: MIT
from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._library import library
from ._limits import CONDUCTANCE_MAX
from ._scene import WHOLE, Packing, pointer
from ._structures import ContactRule, HeatSources
from ._values import doubles, per_sphere, real, refuse
from ._walls import Container

_SPOTS: Mapping[Optional[str], int] = {None: 0, "lens": 1, "hertz": 2}


class Contacts(NamedTuple):
    """Contacts of a bed. Hand them to `Bed.solve` or `Bed.advance`."""

    first: NDArray[np.uint32]
    """(m,) a sphere."""
    second: NDArray[np.uint32]
    """(m,) another sphere, or n plus the number of a wall."""
    conductance: NDArray[np.float64]
    """[W/K] (m,)"""


def _ends(name: str, given: Any, n: int, container: Container) -> NDArray[np.uint32]:
    """Numbers of spheres, and names of walls as n plus their numbers."""
    numbers = [n + container.names.index(end) if isinstance(end, str) and end in container.names else
               int(end) if isinstance(end, float) and end.is_integer() else end  # columns of tables with blanks are floats
               for end in np.asarray(given, dtype=object).ravel().tolist()]
    wrong = [end for end in numbers if not isinstance(end, (int, np.integer)) or not 0 <= end < n + len(container.names)]
    if wrong:
        raise refuse(f"contacts: {name} has {wrong[0]!r}, which is neither a sphere nor a wall")
    return np.array(numbers, np.uint32)


def contacts_of(contacts: Any, n: int, container: Container) -> Contacts:
    """The argument ``contacts`` of `Bed.solve`: (i, j, conductance), or a symmetric SciPy matrix."""
    if contacts is None:
        return Contacts(np.zeros(0, np.uint32), np.zeros(0, np.uint32), np.zeros(0))
    if hasattr(contacts, "tocoo"):
        if contacts.shape != (n, n):
            raise refuse(f"contacts has the shape {contacts.shape}; ({n}, {n}) is wanted")
        if abs(contacts - contacts.T).max() > 1e-12 * abs(contacts).max():
            raise refuse("contacts is not symmetric")
        upper = contacts.tocoo()
        above = upper.row < upper.col
        contacts = upper.row[above], upper.col[above], upper.data[above]
    if len(contacts) != 3:
        raise refuse("contacts must be (i, j, conductance) or a SciPy matrix; scipy.sparse.coo_array makes one of a dense matrix")
    values = np.ascontiguousarray(doubles("contacts", contacts[2]).ravel())
    first, second = (_ends(name, given, n, container) for name, given in zip("ij", contacts))
    if not first.shape == second.shape == values.shape:
        raise refuse(f"contacts has {first.size} values of i, {second.size} of j and {values.size} conductances")
    bad = np.flatnonzero(~((values >= 0) & (values <= CONDUCTANCE_MAX)))
    if bad.size:
        raise refuse(f"contacts: the conductance of {first[bad[0]]} and {second[bad[0]]} is {values[bad[0]]}")
    return Contacts(first, second, values)


def add_contacts(sources: HeatSources, joined: Contacts) -> None:
    sources.contacts, sources.conductance = joined.conductance.size, pointer(joined.conductance)
    sources.contact_first, sources.contact_second = pointer(joined.first, WHOLE), pointer(joined.second, WHOLE)


def rule_of(spots: Optional[str], conductivity: Optional[ArrayLike], scale: Optional[float], gas_gap: float,
            gas_jump: float, gas_alone: bool, gas: bool) -> ContactRule:
    if spots not in _SPOTS:
        raise refuse(f"spots is {spots!r}; 'lens', 'hertz' or None are wanted")
    if conductivity is None and not (spots is None and gas_alone):
        raise refuse("conductivity is missing")
    return ContactRule(spots=_SPOTS[spots], scale=real("scale", scale, 0, 1e6), gas_least=4e-10,
                       gas_reach=real("gas_gap", gas_gap, 0, 1) if gas else 0.0,
                       gas_jump=real("gas_jump", gas_jump, 0, 1), gas_alone=bool(gas_alone))


def take_contacts(found: Any, rule: ContactRule, conductivity: Optional[ArrayLike], gas_conductivity: Optional[float],
                  packing: Packing) -> Contacts:
    """A copy of a list of the library, and what its contacts conduct."""
    solid = per_sphere("conductivity", 1.0 if conductivity is None else conductivity, packing.n, 5e-324, math.inf,
                       packing.names)
    m = found.contents.n
    first, second = (np.ctypeslib.as_array(end, (m,)).copy() if m else np.zeros(0, np.uint32)
                     for end in (found.contents.first, found.contents.second))
    conductance = np.zeros(m)
    gas = None if gas_conductivity is None else np.full(m, real("gas_conductivity", gas_conductivity, 0, 1e12))
    library.fibrad_contacts_conduct(found, rule, pointer(solid), pointer(gas), pointer(conductance))
    return Contacts(first, second, conductance)
