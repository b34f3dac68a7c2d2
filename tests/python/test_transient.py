# test_transient.py - temperatures in time from Python against a closed form. SPDX-License-Identifier: MIT
import numpy as np
import pytest

import fibrad

SIGMA = fibrad.STEFAN_BOLTZMANN


@pytest.mark.parametrize("method", ["corrected", "patches", "factors"])
def test_one_sphere_in_the_cold(method):
    """Into surroundings at 0 K: 1/T^3 grows by 3 A e sigma/C a second."""
    area, capacity = 4 * np.pi * 0.02**2, 50.0
    with fibrad.Transient([[1, 2, 3]], 0.02, method=method) as bed:
        end = bed.advance(1200, 300, capacity=capacity, emissivity=0.6, surroundings=0)
    expected = (1200**-3 + 3 * area * 0.6 * SIGMA / capacity * 300) ** (-1 / 3)
    assert end.temperatures[0] == pytest.approx(expected, rel=1e-4)
    assert end.surroundings == pytest.approx(capacity * (1200 - end.temperatures[0]), rel=1e-12)
    assert end.spheres[0] == pytest.approx(-area * 0.6 * SIGMA * expected**4, rel=1e-3)
    assert 0 < end.error <= 1e-4 and end.walls == {} and end.steps > 5


def test_powers_walls_and_a_move(small):
    """What is supplied is stored, or goes to the walls; a wall that follows time; fixed steps."""
    capacity, power = np.full(len(small.x), 3.0), np.linspace(0, 5, len(small.x))
    with fibrad.Transient(small.x, small.r, walls={"zmin": -2.0}) as bed:
        one = bed.advance(600, 10, capacity=capacity, emissivity=0.5, power=power, surroundings=300,
                          wall_temperature=500, wall_temperature_end={"zmin": 900}, wall_emissivity=0.7, step=1)
        bed.move(small.x + [0, 0, 0.1])
        two = bed.advance(one.temperatures, 10, capacity=capacity, emissivity=0.5, power=power, surroundings=300,
                          wall_temperature=900, wall_emissivity=0.7)
    assert one.steps == 10
    for begin, end in ((np.full(len(small.x), 600.0), one), (one.temperatures, two)):
        stored = capacity @ (end.temperatures - begin)
        gone = end.surroundings + end.walls["zmin"]
        assert stored + gone == pytest.approx(10 * power.sum(), abs=1e-9 * abs(stored))


def test_walls_of_unknown_temperature():
    """A wall that gives off 900 W, one that is insulated; in the end the bed is as Heat finds it."""
    box = {side: value for side, value in zip(("xmin", "xmax", "ymin", "ymax", "zmin", "zmax"), (-9, 9) * 3)}
    x, walls = [[0, 0, 0], [3, 0, 0]], dict(wall_temperature=500, wall_emissivity=0.8, wall_power={"zmax": 9e5},
                                            insulated=["xmin"])
    with fibrad.Transient(x, 1, walls=box, method="patches") as bed:
        short = bed.advance(400, 60, capacity=5e4, emissivity=0.5, power=[0, 1e4], **walls)
        end = bed.advance(short.temperatures, 1e5, capacity=5e4, emissivity=0.5, power=[0, 1e4], **walls)
    with fibrad.Heat(x, 1, walls=box) as heat:
        steady = heat.solve(None, 0.5, power=[0, 1e4], **walls)
    assert short.walls["zmax"] == pytest.approx(-60 * 9e5, rel=1e-9)
    assert abs(short.walls["xmin"]) < 1e-6 * 60 * 9e5
    assert end.temperatures == pytest.approx(steady.temperatures, rel=1e-4)
    assert np.all(end.temperatures > 510)


@pytest.mark.parametrize("options, text", [
    ({"wall_power": {"zmin": 1.0}}, "zmin: walls of unknown temperature need method='patches'"),
    ({"insulated": ["zmin"]}, "zmin: walls of unknown temperature need method='patches'"),
    ({"insulated": ["zmax"]}, "there is no wall 'zmax'"),
    ({"insulated": ["zmin"], "wall_temperature": {"zmin": 3.0}}, "zmin: its temperature is to be found"),
])
def test_walls_that_cannot_be(options, text):
    with fibrad.Transient([[0, 0, 0]], 1.0, walls={"zmin": -2.0}) as bed, pytest.raises(fibrad.InputError, match=text):
        bed.advance(300, 1, capacity=1, emissivity=0.5, surroundings=300, wall_emissivity=1, **options)


def test_refusals():
    bed = fibrad.Transient([[0, 0, 0], [3, 0, 0]], 1.0, ids=[7, 9])
    good = dict(capacity=1.0, emissivity=0.5, surroundings=300)
    with pytest.raises(fibrad.InputError, match="surroundings is missing"):
        bed.advance(300, 1, capacity=1, emissivity=0.5)
    with pytest.raises(fibrad.InputError, match="9"):
        bed.advance([300, 0], 1, **good)
    with pytest.raises(fibrad.InputError, match="duration"):
        bed.advance(300, -1, **good)
    with pytest.raises(fibrad.InputError):
        bed.advance(300, 1e6, power=-1e9, **good)
    with pytest.raises(fibrad.InputError, match="none of corrected"):
        fibrad.Transient([[0, 0, 0]], 1.0, method="best")
    bed.close()
    with pytest.raises(fibrad.StateError, match="this Transient is closed"):
        bed.advance(300, 1, **good)
