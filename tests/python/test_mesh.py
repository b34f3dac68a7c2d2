# test_mesh.py - walls of triangles in Python. SPDX-License-Identifier: MIT
import numpy as np
import pytest

import fibrad

X, R = [[0.3, 0.3, 0.3], [0.7, 0.6, 0.5]], 0.2
PLANES = {"xmin": 0.0, "xmax": 1.0, "ymin": 0.0, "ymax": 1.0, "zmin": 0.0, "zmax": 1.0}


def box():
    """The faces of the unit cube as meshes, seen from within, by the names of planes."""
    walls = {}
    for axis in range(3):
        for upper in range(2):
            corners = np.zeros((4, 3))
            corners[:, axis] = upper
            corners[:, (axis + 1) % 3] = [0, 1, 1, 0]
            corners[:, (axis + 2) % 3] = [0, 0, 1, 1]
            triangles = [[0, 1, 2], [0, 2, 3]] if not upper else [[0, 2, 1], [0, 3, 2]]
            walls[f"{'xyz'[axis]}_{'high' if upper else 'low'}"] = fibrad.Mesh(corners, triangles)
    return walls


def test_a_box_of_triangles_is_one_of_planes():
    meshed = fibrad.view_factors(X, R, walls=box(), directions=1000)
    planes = fibrad.view_factors(X, R, walls=PLANES, directions=1000)
    assert (meshed.escaped == 0).all()
    assert np.allclose(meshed.walls, planes.walls, atol=2e-3)
    assert np.allclose(meshed.data, planes.data, atol=2e-3)


def test_heat_in_a_box_of_triangles():
    state = {"temperature": [400, 900], "emissivity": [0.5, 0.8], "wall_emissivity": 0.6, "wall_temperature": 600,
             "surroundings": 0}
    with fibrad.Heat(X, R, walls=box()) as meshed, fibrad.Heat(X, R, walls=PLANES) as planes:
        assert np.allclose(meshed.solve(**state).spheres, planes.solve(**state).spheres, rtol=5e-3)


def test_backs():
    low = {name: mesh for name, mesh in box().items() if name == "x_low"}
    low["x_low"].triangles = low["x_low"].triangles[:, ::-1].copy()
    with pytest.raises(fibrad.InputError, match="triangle [01] of x_low"):
        fibrad.view_factors(X, R, walls=low)
    low["x_low"].back = True
    assert fibrad.view_factors(X, R, walls=low).walls.max() > 0.05
    low["x_low"].back = "floor"
    with pytest.raises(fibrad.InputError, match="no mesh has that name"):
        fibrad.view_factors(X, R, walls=low)


def test_meshes_that_are_refused():
    with pytest.raises(fibrad.InputError, match="vertices has the shape"):
        fibrad.Mesh([[0, 0]], [[0, 0, 0]])
    with pytest.raises(fibrad.InputError, match="there are 3"):
        fibrad.Mesh(np.eye(3), [[0, 1, 3]])
    with pytest.raises(fibrad.InputError, match="triangles must be"):
        fibrad.Mesh(np.eye(3), [[0.0, 1.0, 2.0]])
