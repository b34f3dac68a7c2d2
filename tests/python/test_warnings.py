# test_warnings.py - what the library warns of, in words. SPDX-License-Identifier: MIT
import warnings

import numpy as np
import pytest

import fibrad

X, R = np.array([[0.0, 0.0, 0.02], [0.05, 0.0, 0.02]]), 0.02
SQUARE = fibrad.Mesh([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]], [[0, 1, 2]], back=True)
HEAT = {"surroundings": 300.0}


def of(mesh, scale, x=0.0):
    return fibrad.wall(fibrad.Mesh(scale * mesh.vertices + [x, 0, 0], mesh.triangles, back=True), name="plate", temperature=300)


@pytest.fixture(autouse=True)
def fixture_all_are_errors():
    """A warning that is not expected ends a test."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


def bed(walls=None, scale=1.0):
    return fibrad.Bed(scale * X, scale * R, walls=walls)


def moved(walls):
    """A wall that moves into spheres."""
    with bed("zmin:at=0") as there:
        there.move(X, walls=walls)


def test_nothing_is_said_of_a_good_bed():
    with bed(["zmin:at=0:temperature=300", of(SQUARE, 1, -0.02)]) as heat:
        heat.solve([900.0, 300.0], 0.8, conductivity=30.0, **HEAT)
        heat.move(X + [0, 0, 1e-4])
    with bed() as hot:
        hot.factors()
        hot.advance(900.0, 1.0, capacity=2e6 * 4 / 3 * np.pi * R**3, emissivity=0.8, **HEAT)


def test_millimetres_as_metres():
    with bed(scale=1000) as large, pytest.warns(UserWarning, match="radii of 20 are taken as metres"):
        large.factors()  # of any unit
        large.solve(900.0, 0.8, **HEAT)


@pytest.mark.parametrize("make", [bed, moved, lambda walls: fibrad.view_factors(X, R, walls=walls)])
def test_planes_inside_spheres(make):
    with pytest.warns(UserWarning, match=r"sphere 0 reaches through the wall zmin by 0.5 of its radius \(2 such cases"):
        make("zmin:at=0.01")


@pytest.mark.parametrize("name, axis", [("cylinder", 2), ("xcylinder", 0), ("ycylinder", 1)])
def test_cylinders_inside_spheres(name, axis):
    x = np.roll(X, axis + 1, axis=1)
    tube = f"{name}:0,0,0.06,{'xyz'[axis]}min:open,{'xyz'[axis]}max:open"
    with pytest.warns(UserWarning, match=rf"sphere of id 9 reaches through the wall {name} by 0.5 of its radius \(1 such"):
        fibrad.view_factors(x, R, walls=tube, ids=[7, 9])


def test_meshes_of_another_unit(tmp_path):
    stl = tmp_path / "plate.stl"
    points = "".join(f"vertex {x} {y} {z}\n" for x, y, z in 1000 * SQUARE.vertices)
    stl.write_text(f"solid p\nfacet normal 0 0 1\nouter loop\n{points}endloop\nendfacet\nendsolid p\n")
    with pytest.warns(UserWarning, match="not closed"):
        millimetres = fibrad.Mesh.from_stl(stl, X, R, sides="both")
    with pytest.warns(UserWarning, match=r"the wall plate is 100 long, the bed 0.09.*scale=0.001"):
        bed(fibrad.wall(millimetres, name="plate"))
    with pytest.warns(UserWarning, match=r"the wall plate is 0.0001 long, the bed 0.09.*scale=1000"):
        fibrad.view_factors(X, R, walls=of(SQUARE, 1e-3))


def test_meshes_in_another_place():
    with pytest.warns(UserWarning, match="the wall plate lies from 1 to 1.1 along x, away from the bed"):
        fibrad.view_factors(X, R, walls=of(SQUARE, 1, 1.0))
    fibrad.view_factors(X, R, walls=of(SQUARE, 1, 1.0), box=[0.2, 0, 0])  # an image is near


def test_spheres_that_overlap():
    with pytest.warns(UserWarning, match="sphere 0 and sphere 1 overlap by 0.1 of a radius"):
        fibrad.Bed([[0, 0, 0], [0.038, 0, 0]], R)
    with pytest.warns(UserWarning, match="sphere of id 4 and sphere of id 5 overlap by 0.1 of a radius"):
        fibrad.view_factors([[0, 0, 0], [0.038, 0, 0]], R, ids=[4, 5])


def test_temperatures():
    with bed() as heat:
        for call in (lambda kelvins: heat.solve(kelvins, 0.8, **HEAT),
                     lambda kelvins: heat.advance(kelvins, 1.0, capacity=100.0, emissivity=0.8, **HEAT)):
            with pytest.warns(UserWarning, match="no sphere is warmer than 25 K; temperatures are in kelvins"):
                call([25.0, 20.0])
        with pytest.warns(UserWarning, match=r"sphere 1 has 0 K \(1 spheres in all\), others have up to 900 K"):
            heat.solve([900.0, 0.0], 0.8, **HEAT)


def test_temperatures_around():
    with bed() as heat, bed("zmin:temperature=25") as floor, bed("box:temperature=500") as closed:
        with pytest.warns(UserWarning, match="surroundings: 25 K; temperatures are in kelvins"):
            heat.solve(900.0, 0.8, surroundings=25.0)
        with pytest.warns(UserWarning, match="surroundings: 25 K; temperatures are in kelvins"):
            heat.advance(900.0, 1.0, capacity=100.0, emissivity=0.8, surroundings=25.0)
        with pytest.warns(UserWarning, match="zmin: 25 K; temperatures are in kelvins"):
            floor.solve(900.0, 0.8, **HEAT)
        with pytest.warns(UserWarning, match="surroundings has no effect: nothing leaves a bed"):
            closed.solve(900.0, 0.8, **HEAT)
        closed.solve(900.0, 0.8)
        heat.solve(900.0, 0.8, surroundings=4.0)


def test_surfaces_below_nothing():
    with bed() as heat, pytest.warns(UserWarning, match="its surface comes out at -.* K in one place"):
        heat.solve([2000.0, 100.0], 1.0, surroundings=0.0, conductivity=1e-3)


def test_capacities_that_no_solid_has():
    with bed() as hot, pytest.warns(UserWarning, match="the capacity of sphere 0 is 29.8 J/K for each m3"):
        hot.advance(900.0, 1e-9, capacity=1e-3, emissivity=0.8, **HEAT)


def test_the_line_of_the_user_is_named():
    with pytest.warns(UserWarning) as caught:
        fibrad.view_factors(X, R, walls="zmin:at=0.01")
        bed("zmin:at=0.01")
        fibrad.view_factors(X, 0.028)
    assert [one.filename for one in caught] == [__file__] * 3
