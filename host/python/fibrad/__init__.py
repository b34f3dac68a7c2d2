# __init__.py - fibrad in Python: thermal radiation between the spheres of packed beds. SPDX-License-Identifier: MIT
"""View factors, exchange factors and radiative powers between the spheres of packed beds.

>>> import fibrad
>>> factors = fibrad.view_factors([[0, 0, 0], [0, 0, 3]], 1.0)
>>> round(float(factors.data[0]), 3)
0.03

`Bed` holds a bed and answers: `Bed.factors`, `Bed.solve` (powers and temperatures), `Bed.shine` (light from outside),
`Bed.advance` (temperatures in time), `Bed.contacts` (what spheres that touch conduct). `view_factors` and
`exchange_factors` are such a bed in one call. `wall` makes a wall. `read` and `Mesh.from_stl` read files.

Positions are arrays (n, 3), radii are arrays (n,). The surroundings lie outside the bed and are black. A wall is a
plane, a cylinder or a `Mesh`. A view factor is the fraction of the radiation leaving a sphere that reaches another
sphere directly. An exchange factor is the fraction of the emission of a sphere that another sphere absorbs, directly or
after reflections. The error of a row of factors is the root of the sum of the squared errors of its factors.

The GIL is released while the library computes. Ctrl-C stops the library. Errors are subclasses of `Error`.
"""
from . import _library
from ._bed import Bed, exchange_factors, view_factors
from ._contacts import Contacts
from ._errors import Cancelled, Error, FileError, InputError, OutOfMemory, StateError
from ._factors import Factors
from ._files import FileFrame, read
from ._heat import STEFAN_BOLTZMANN, Advance, Powers, Store
from ._light import Absorbed, Light
from ._scene import Mesh
from ._walls import wall

__version__: str = _library.library.fibrad_version().decode()
__all__ = ["Absorbed", "Advance", "Bed", "Cancelled", "Contacts", "Error", "Factors", "FileError", "FileFrame",
           "InputError", "Light", "Mesh", "OutOfMemory", "Powers", "STEFAN_BOLTZMANN", "StateError", "Store", "exchange_factors",
           "read", "view_factors", "wall"]
