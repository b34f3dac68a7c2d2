# test_mesh.py - walls of triangles in Python. SPDX-License-Identifier: MIT
import numpy as np
import pytest

import fibrad

X, R = [[0.3, 0.3, 0.3], [0.7, 0.6, 0.5]], 0.2
PLANES = "xmin:at=0,xmax:at=1,ymin:at=0,ymax:at=1,zmin:at=0,zmax:at=1"
STATE = {"temperature": [400, 900], "emissivity": [0.5, 0.8], "surroundings": 0}


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


def of(meshes, kelvins=None, **keys):
    """Walls of meshes by name, with temperatures."""
    return [fibrad.wall(mesh, name=name, temperature=kelvins[name] if kelvins else None, **keys) for name, mesh in meshes.items()]


def test_a_box_of_triangles_is_one_of_planes():
    meshed = fibrad.view_factors(X, R, walls=of(box()), directions=1000)
    planes = fibrad.view_factors(X, R, walls=PLANES, directions=1000)
    assert (meshed.escaped == 0).all()
    assert np.allclose(meshed.walls, planes.walls, atol=2e-3)
    assert np.allclose(meshed.data, planes.data, atol=2e-3)


def test_heat_in_a_box_of_triangles():
    kelvins = dict.fromkeys(box(), 600)
    with fibrad.Bed(X, R, walls=of(box(), kelvins, emissivity=0.6)) as meshed, \
            fibrad.Bed(X, R, walls=PLANES.replace(",", ":temperature=600:emissivity=0.6,") + ":temperature=600:emissivity=0.6") as planes:
        assert np.allclose(meshed.solve(**STATE).spheres, planes.solve([400, 900], [0.5, 0.8]).spheres, rtol=5e-3)


def test_fluxes_of_triangles():
    walls = box()
    walls["shelf"] = fibrad.Mesh([[0.02, 0.02, 0.02], [0.5, 0.02, 0.02], [0.02, 0.5, 0.02]], [[0, 1, 2]], back=True)
    kelvins = {name: 300.0 + 50 * k for k, name in enumerate(walls)}
    with fibrad.Bed(X, R, walls=of(walls, kelvins, emissivity=0.6)) as heat:
        powers = heat.solve(**STATE)
    assert list(powers.triangle_fluxes) == list(walls) == list(powers.triangle_temperatures)
    for k, (name, mesh) in enumerate(walls.items()):
        flux, kelvins = powers.triangle_fluxes[name], powers.triangle_temperatures[name]
        assert flux.shape == kelvins.shape == (len(mesh.triangles), 2)
        assert np.isnan(flux[:, 1]).all() == (mesh.back is None)
        assert (kelvins[:, 0] == 300.0 + 50 * k).all()
        assert np.nansum(flux * mesh.areas()[:, None]) == pytest.approx(powers.walls[name], rel=1e-9)
    with fibrad.Bed(X, R, walls="zmin:at=0:temperature=300") as heat:
        powers = heat.solve(**STATE)
        assert powers.triangle_fluxes == {} == powers.triangle_temperatures


def test_temperatures_of_triangles():
    """All faces as one mesh, a temperature for each triangle, is as one mesh each."""
    walls = box()
    one = fibrad.Mesh(np.concatenate([mesh.vertices for mesh in walls.values()]),
                      np.concatenate([mesh.triangles + 4 * k for k, mesh in enumerate(walls.values())]))
    kelvins = {name: 300.0 + 100 * k for k, name in enumerate(walls)}
    given = np.repeat(list(kelvins.values()), 2)
    with fibrad.Bed(X, R, walls=of(walls, kelvins, emissivity=0.6)) as meshes, \
            fibrad.Bed(X, R, walls=fibrad.wall(one, name="tub", temperature=given, emissivity=0.6)) as tub:
        several, single = meshes.solve(**STATE), tub.solve(**STATE)
        assert np.allclose(several.spheres, single.spheres, rtol=5e-3)
        assert np.allclose(single.triangle_temperatures["tub"][:, 0], given, rtol=1e-12)
        assert single.wall_temperatures["tub"] == pytest.approx(np.mean(given**4)**0.25, rel=1e-9)
        for wrong, text in ((given[1:], "or 12, one for each"), (-given, "triangle 0 of tub is -300"),
                            (np.where(given > 700, np.nan, given), "triangle 10 of tub is nan")):
            with pytest.raises(fibrad.InputError, match=text):
                tub.solve(**STATE, walls=[fibrad.wall(one, name="tub", temperature=wrong)])
        end = tub.advance(**STATE, capacity=1e5, duration=10.0)
        assert end.walls["tub"] == pytest.approx(10 * single.walls["tub"], rel=2e-2)
        with pytest.raises(fibrad.InputError, match="walls_end"):
            tub.advance(**STATE, capacity=1e5, duration=10.0, walls_end="tub:temperature=300")


def test_backs():
    low = {name: mesh for name, mesh in box().items() if name == "x_low"}
    low["x_low"].triangles = low["x_low"].triangles[:, ::-1].copy()
    with pytest.raises(fibrad.InputError, match="triangle [01] of x_low"):
        fibrad.view_factors(X, R, walls=of(low))
    low["x_low"].back = True
    assert fibrad.view_factors(X, R, walls=of(low)).walls.max() > 0.05
    low["x_low"].back = "floor"
    with pytest.raises(fibrad.InputError, match="no mesh has that name"):
        fibrad.view_factors(X, R, walls=of(low))


def test_meshes_that_are_refused():
    with pytest.raises(fibrad.InputError, match="vertices has the shape"):
        fibrad.Mesh([[0, 0]], [[0, 0, 0]])
    with pytest.raises(fibrad.InputError, match="there are 3"):
        fibrad.Mesh(np.eye(3), [[0, 1, 3]])
    with pytest.raises(fibrad.InputError, match="triangles must be"):
        fibrad.Mesh(np.eye(3), [[0.0, 1.0, 2.0]])


def test_films_and_powers_of_triangles():
    """What is found is what its temperatures give, at once and at the end of a span."""
    tub = fibrad.Mesh(np.concatenate([mesh.vertices for mesh in box().values()]),
                      np.concatenate([mesh.triangles + 4 * k for k, mesh in enumerate(box().values())]))
    film, gas, power = np.arange(12.0) % 3 * 8, np.linspace(300, 600, 12), np.where(np.arange(12) % 3, np.nan, 40.0)
    keys = {"temperature": 500, "convection": film, "gas": gas, "power": power, "emissivity": 0.6}
    with fibrad.Bed(X, R, walls=fibrad.wall(tub, name="tub", **keys)) as bed:
        powers = bed.solve(**STATE, tolerance=1e-9)
        flux, kelvins = powers.triangle_fluxes["tub"][:, 0], powers.triangle_temperatures["tub"][:, 0]
        assert np.allclose(flux + film * (gas - kelvins) + np.nan_to_num(power / tub.areas()), 0, atol=1e-4)
        given = bed.solve(**STATE, tolerance=1e-9, walls=fibrad.wall(tub, name="tub", temperature=kelvins, convection=np.zeros(12)))
        assert np.allclose(given.triangle_fluxes["tub"][:, 0], flux, atol=1e-4)
        ended = bed.advance([400, 900], 20, capacity=[20, 30], emissivity=[0.5, 0.8], surroundings=0)
        assert np.nansum(ended.triangle_energies["tub"]) == pytest.approx(ended.walls["tub"], rel=1e-12)
        assert np.isfinite(ended.triangle_temperatures["tub"][:, 0]).all()
        for wrong, text in ((film[1:], "or 12, one for each"), (-film, "convection of triangle 1 of tub is -8")):
            with pytest.raises(fibrad.InputError, match=text):
                bed.solve(**STATE, walls=fibrad.wall(tub, name="tub", temperature=500, convection=wrong, gas=gas))
