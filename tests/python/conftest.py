# conftest.py - beds for the tests of the Python package. SPDX-License-Identifier: MIT
import os
import pathlib
from types import SimpleNamespace

import numpy as np
import pytest

CUBE = "xmin:at=-5,xmax:at=5,ymin:at=-5,ymax:at=5,zmin:at=-5,zmax:at=5"
PAIR = [[0, 0, 0], [0, 0, 3]]
TREE = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def tree():
    return TREE


@pytest.fixture(scope="session")
def program():
    return TREE / os.environ.get("BUILD", "build") / "fibrad"


@pytest.fixture(scope="session")
def mono():
    """2,000 equal spheres in the order of their ids."""
    path = TREE / "tests" / "data" / "mono2000.dump"
    columns = np.loadtxt(path, skiprows=9)
    columns = columns[np.argsort(columns[:, 0])]
    return SimpleNamespace(path=path, ids=columns[:, 0].astype(int), x=columns[:, 2:5], r=columns[:, 5])


@pytest.fixture(scope="session")
def small(mono):
    """Some 200 spheres around a corner of it, with different radii."""
    near = (mono.x < 5.5).all(axis=1)
    r = mono.r[near] * np.linspace(0.8, 1, near.sum())
    return SimpleNamespace(x=np.ascontiguousarray(mono.x[near]), r=r, n=int(near.sum()))


def same(one, other):
    """Whether two matrices in compressed rows have the same bits."""
    return all(getattr(one, name).tobytes() == getattr(other, name).astype(getattr(one, name).dtype).tobytes()
               for name in ("indptr", "indices", "data"))
