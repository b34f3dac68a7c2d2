# test_bed.py - powers and temperatures from Python against closed forms. SPDX-License-Identifier: MIT
import copy
import math
import pickle
import re
import threading

import numpy as np
import pytest
from conftest import CUBE, PAIR

import fibrad

SIGMA = fibrad.STEFAN_BOLTZMANN


def cube(words):
    """A cube about the origin whose walls have these words."""
    return CUBE.replace("=-5", f"=-5:{words}").replace("=5", f"=5:{words}")


@pytest.mark.parametrize("emissivity", [0.3, 1])
def test_one_sphere(emissivity):
    """It sees the surroundings alone: 4 pi r^2 e sigma (Ta^4 - T^4)."""
    with fibrad.Bed([[1, 2, 3]], 0.02) as bed:
        powers = bed.solve(900, emissivity, surroundings=400)
    expected = 4 * np.pi * 0.02**2 * emissivity * SIGMA * (400**4 - 900**4)
    assert powers.spheres == pytest.approx(expected, rel=1e-9, abs=1e-12) and powers.walls == {}
    assert powers.surroundings == pytest.approx(-expected, rel=1e-9, abs=1e-12)
    assert abs(powers.balance) < 1e-12 * 900**4 * SIGMA


def test_two_black_spheres():
    """By the exact view factor between them, from the same bed."""
    with fibrad.Bed(PAIR, 1.0) as bed:
        seen = bed.factors(directions=65536).data[0]
        bed.beams(directions=1000)
        powers = bed.solve([1000, 500], 1, surroundings=300)
    hot, warm, cold = SIGMA * 1000**4, SIGMA * 500**4, SIGMA * 300**4
    expected = 4 * np.pi * np.array([seen * warm + (1 - seen) * cold - hot, seen * hot + (1 - seen) * cold - warm])
    assert np.sqrt(np.mean((powers.spheres - expected) ** 2)) < 3 * powers.error < 1e-3 * 4 * np.pi * hot
    assert abs(powers.surroundings + expected.sum()) < 3 * powers.surroundings_error < 1e-3 * 4 * np.pi * hot


@pytest.mark.parametrize("e1, e2", [(1, 1), (0.8, 0.5), (0.1, 0.9)])
def test_parallel_plates(e1, e2):
    """No spheres: sigma (T1^4 - T2^4)/(1/e1 + 1/e2 - 1) for each of 2 m2."""
    walls = [f"zmin:at=0:temperature=1000:emissivity={e1}", fibrad.wall("zmax", at=1, temperature=500, emissivity=e2)]
    powers = fibrad.Bed(np.zeros((0, 3)), [], box=(1, 2, 0), walls=walls).solve([], [])
    expected = 2 * SIGMA * (1000**4 - 500**4) / (1 / e1 + 1 / e2 - 1)
    assert powers.walls["zmax"] == pytest.approx(expected, rel=1e-5)
    assert powers.walls["zmin"] == pytest.approx(-expected, rel=1e-5) and powers.surroundings == 0


def test_a_sphere_within_black_walls():
    """Closed, so that no temperature of surroundings is needed."""
    powers = fibrad.Bed([[0, 0, 0]], 1.0, walls=cube("temperature=800")).solve(500, 0.4)
    assert powers.spheres[0] == pytest.approx(4 * np.pi * 0.4 * SIGMA * (800**4 - 500**4), rel=1e-9)
    assert powers.surroundings == 0 and sum(powers.walls.values()) == pytest.approx(-powers.spheres[0])


def test_a_box_without_a_lid():
    """As with a black lid as hot as the surroundings; at the end of the spheres where no place is given."""
    x, r = [[0, 0, -2], [1, 2, 3]], [1, 0.5]
    walls = [cube("temperature=600:emissivity=0.5"), "zmin:at=-5:temperature=900:emissivity=0.5"]
    for lid, at in (("zmax:open", 3.5), ("zmax:open:at=5", 5)):
        with fibrad.Bed(x, r, walls=[*walls, lid]) as bed:
            cup = bed.solve(500, 0.6, surroundings=300)
            assert set(cup.walls) == {"xmin", "xmax", "ymin", "ymax", "zmin"}
            with pytest.raises(fibrad.InputError, match="surroundings"):
                bed.solve(500, 0.6)
            with pytest.raises(fibrad.InputError, match="zmax is open"):
                bed.solve(500, 0.6, surroundings=300, walls="zmax:temperature=600")
        with fibrad.Bed(x, r, walls=[*walls, f"zmax:at={at}:temperature=300"]) as bed:
            box = bed.solve(500, 0.6)
        assert cup.spheres == pytest.approx(box.spheres, rel=1e-13)
        assert cup.surroundings == pytest.approx(box.walls["zmax"], rel=1e-13) and cup.surroundings > 1e4
        assert cup.walls["zmin"] == pytest.approx(box.walls["zmin"], rel=1e-13)


def test_open_sides_move_with_the_spheres():
    walls = "zmin:at=-1:temperature=600:emissivity=0.5,zmax:open,cylinder:0,0,4:temperature=600:emissivity=0.5"
    with fibrad.Bed([[0, 0, 0]], 0.5, walls=walls) as bed:
        bed.move([[0, 0, 5]])
        assert bed.solve([900], 0.5, surroundings=300).spheres[0] < 0
        with pytest.raises(fibrad.InputError, match="they were zmin, cylinder, zmax open"):
            bed.move([[0, 0, 5]], walls="zmin:at=-1,zmax:at=9,cylinder:0,0,4")


def test_words_of_walls():
    """A later word replaces an earlier one, and goes before `box`; a name says more of a wall that is there."""
    bed = fibrad.Bed([[0, 0, 0]], 1.0, walls=["box:insulated,zlo:temperature=900", fibrad.wall("zlo", at=-2, temperature=800)])
    given = bed.solve(500, 0.5)
    assert set(given.walls) == {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"} and given.walls["xmax"] == 0
    assert given.wall_temperatures["zmin"] == 800
    assert bed.solve(500, 0.5, walls="zmin:temperature=700").wall_temperatures["zmin"] == 700
    found = bed.solve(500, 0.5, walls=[fibrad.wall("zmin", power=1e3)])
    assert found.walls["zmin"] == -1e3 and found.wall_temperatures["zmin"] > 500


@pytest.mark.parametrize("walls, text", [
    ("floor", "no wall 'floor'; there are box, xmin"), ("zmin:at=a", "wall zmin: at must be a number, not 'a'"),
    ("zmin:temperature=5:power=3", "temperature and power exclude each other"), ("zmin:open:emissivity=1", "exclude each other"),
    ("zmin:warmth=3", "'warmth=3' is of no use here; there are at=, open"), ("zmin:at", "'at' is of no use"),
    ("zmin:3", "'3' is of no use"), ("cylinder:0,3", "cylinder:X,Y,R, a place and a radius"), ("xcylinder", "xcylinder:Y,Z,R"),
    ("cylinder:0,0,3:at=1", "at is of no use"), ("box:open", "open is of no use"), ("zmin:name=a", "name is of no use"),
    ("zmin:scale=2", "scale is of no use"), ("zmin:both", "sides is of no use"),
    ({"zmin": 0}, "walls must be words"), ([3], "words such as"), (5, "walls must be words"),
    ([fibrad.wall(fibrad.Mesh(np.eye(3), [[0, 1, 2]], back=True), name="a")] * 2, "a is the name of two walls"),
    ("zmin:at=1,zmax:at=-1", "wall zmax: contradicts the box or another wall"), ("zmin:at=.5", "beyond a wall: sphere 0 at"),
    ("cylinder:0,0,5,ymin:at=-1", "wall ymin: contradicts"), ("ycylinder:0,0,3,cylinder:0,0,3", "wall cylinder: contradicts"),
    ("zmin:at=-1,cylinder:0,0,3", "walls='zmax:open'"), ("zmax:open:at=.3", "a sphere reaches beyond an open side"),
])
def test_walls_that_cannot_be(walls, text):
    with pytest.raises(fibrad.InputError, match=text):
        fibrad.view_factors([[0, 0, 0]], 0.5, walls=walls)


@pytest.mark.parametrize("walls, text", [
    ("", "temperature of wall zmin is missing"), ("zmax:temperature=3", "no wall 'zmax'; there are zmin"),
    ("zmin:at=3", "only `move` moves a wall"), ("zmin:temperature=nan", "temperature of wall zmin = nan"),
    ("zmin:temperature=3:emissivity=2", "emissivity of wall zmin = 2"), ("zmin:power=5", "wall zmin: is endless"),
    ([fibrad.wall("zmin", temperature=[3.0])], "a number is wanted"),
])
def test_values_of_walls_that_cannot_be(walls, text):
    with fibrad.Bed(PAIR, 1.0, walls="zmin:at=-1") as bed, pytest.raises(fibrad.InputError, match=text):
        bed.solve(300, 1, surroundings=0, walls=walls or None)


def test_energy_is_kept(small):
    """And nothing flows at one temperature; threads change no bit."""
    kelvins = np.linspace(300, 1200, small.n)
    walls = "zmin:at=-9:temperature=900:emissivity=0.9,zmax:at=99:temperature=300:emissivity=0.9"
    with fibrad.Bed(small.x, small.r, walls=walls, threads=3) as bed, fibrad.Bed(small.x, small.r, walls=walls, threads=1) as other:
        powers, same = (one.solve(kelvins, 0.7, surroundings=350) for one in (bed, other))
        even = bed.solve(700, 0.5, surroundings=700, walls="zmin:temperature=700,zmax:temperature=700")
    assert powers.spheres.tobytes() == same.spheres.tobytes() and powers.surroundings == same.surroundings
    assert np.abs(even.spheres).max() < 1e-9 * SIGMA * 700**4
    assert abs(powers.balance) < 1e-11 * np.abs(powers.spheres).sum()
    assert 0 < powers.error < 0.02 * np.sqrt(np.mean(powers.spheres**2))
    assert powers.error == pytest.approx(np.hypot(powers.error_patches, powers.error_beams))
    assert powers.sweeps > 0 and 0 < powers.residual < 1e-3
    text = repr(powers)
    assert len(text) < 200 and f"{small.n} spheres of 300 to 1200 K" in text and "zmin" in text and "surroundings" in text


def test_powers_follow_from_exchange_factors(small):
    """The same by paths: sum over j of A_i e_i D_ij sigma (T_j^4 - T_i^4)."""
    e = np.linspace(0.4, 0.9, small.n)
    emission = SIGMA * np.linspace(300, 1200, small.n) ** 4
    with fibrad.Bed(small.x, small.r) as bed:
        exchange = bed.factors(emissivity=e, directions=500, paths=8000)
        bed.beams(directions=500)
        powers = bed.solve((emission / SIGMA) ** 0.25, e, surroundings=300)
    sent = 4 * np.pi * small.r**2 * e
    expected = sent * (exchange.matrix @ emission + exchange.escaped * SIGMA * 300**4 - emission)
    assert np.sqrt(np.mean((powers.spheres - expected) ** 2)) < 0.005 * np.sqrt(np.mean(expected**2))


def test_move(small):
    """Moved spheres have the powers of a bed made anew, and those of before when they are back."""
    state = {"temperature": np.linspace(300, 900, small.n), "emissivity": 0.5, "surroundings": 300, "tolerance": 1e-8}
    there = small.x * 1.5
    with fibrad.Bed(small.x, small.r) as bed, fibrad.Bed(there, small.r) as anew:
        before = bed.solve(**state).spheres
        bed.move(there)
        expected = anew.solve(**state).spheres
        scale = np.abs(expected).max()
        assert bed.solve(**state).spheres == pytest.approx(expected, abs=1e-6 * scale)
        assert bed.factors(directions=50).data.tobytes() == anew.factors(directions=50).data.tobytes()
        bed.move(small.x, small.r)
        assert bed.solve(**state).spheres == pytest.approx(before, abs=1e-6 * scale)
        bed.move(np.asfortranarray(small.x), small.r * 0.9)
        assert np.abs(bed.solve(**state).spheres - before).max() > 0.01 * scale


def test_walls_move():
    bed = fibrad.Bed([[0, 0, 0]], 1.0, walls="zmin:at=-1:temperature=900,zmax:at=1:temperature=900", box=(4, 4, 0))
    near = bed.solve(300, 1).spheres[0]
    bed.move([[0, 0, 0]], walls="zmin:at=-9:temperature=900,zmax:at=9:temperature=900")
    assert bed.solve(300, 1).spheres[0] == pytest.approx(near, rel=0.1)
    bed.move([[0, 0, 0]], box=(8, 8, 0))
    bed.solve(300, 1)


def test_moves_that_cannot_be(small):
    bed = fibrad.Bed(small.x, small.r, ids=np.arange(small.n) + 100)
    before = bed.solve(300, 1, surroundings=400).spheres
    with pytest.raises(fibrad.InputError, match=rf"\(5, 3\); this Bed has {small.n}"):
        bed.move(small.x[:5], small.r[:5])
    with pytest.raises(fibrad.InputError, match="the walls are zmin; they were none"):
        bed.move(small.x, walls="zmin:at=-1")
    broken = small.x.copy()
    broken[7, 0] = np.nan
    with pytest.raises(fibrad.InputError, match="sphere of id 107 at") as caught:
        bed.move(broken)
    assert caught.value.spheres == (7,)
    assert bed.solve(300, 1, surroundings=400).spheres == pytest.approx(before, rel=1e-6)  # the bed of before


@pytest.mark.parametrize("options, text", [
    ({}, "surroundings is missing"), ({"surroundings": -1}, "surroundings"), ({"surroundings": np.nan}, "surroundings"),
    ({"temperature": [300, -1]}, "temperature of sphere 1 is -1"), ({"temperature": [300, np.nan]}, "temperature of sphere 1"),
    ({"temperature": [300]}, "temperature has the shape"), ({"emissivity": 1.1}, "emissivity of sphere 0 is 1.1"),
    ({"emissivity": lambda kelvins: kelvins}, "emissivity of sphere 0 is 300"), ({"sigma": 0}, "sigma"),
    ({"tolerance": 2}, "tolerance"), ({"conductivity": 0}, "conductivity"), ({"temperature": None, "power": -1e9}, "temperatures"),
    ({"power": 5.0}, "power is given, and all spheres have temperatures"), ({"walls": "zmax:power=1"}, "no wall 'zmax'"),
    ({"temperature": [300., np.nan], "power": [5., 5.]}, "both a temperature and a power.*sphere 0"),
    ({"temperature": [300., np.nan], "power": [np.nan, np.nan]}, "neither a temperature nor a power.*sphere 1"),
    ({"temperature": [300., np.nan], "power": [np.nan, 5.], "emissivity": [.5, 0.]}, "has emissivity 0.*sphere 1"),
])
def test_sources_that_cannot_be(options, text):
    given = {"temperature": 300, "emissivity": 1, **({"surroundings": 300} if options else {}), **options}
    with fibrad.Bed(PAIR, 1.0) as bed, pytest.raises(fibrad.InputError, match=text):
        bed.solve(**given)


@pytest.mark.parametrize("box, walls, closed", [
    ((6, 6, 6), None, True), ((6, 6, 0), None, False), ((6, 6, 0), "zmin:at=-2,zmax:at=2", True),
    ((6, 6, 0), "zmin:at=-2", False), ((0, 0, 6), "cylinder:0,0,3", True), (None, CUBE, True),
    (None, "cylinder:0,0,3,zmin:at=-2,zmax:at=2", True), (None, "cylinder:0,0,3,zmin:at=-2,zmax:open", False),
])
def test_what_is_closed_needs_no_surroundings(box, walls, closed):
    hot = ":temperature=500:emissivity=0.5"
    words = walls and re.sub(r"(at=-?\d|0,0,3)", rf"\1{hot}", walls)
    bed = fibrad.Bed([[0, 0, 0], [2, 2, 0]], 0.5, box=box, walls=words)
    state = {"temperature": [300, 900], "emissivity": 1}
    try:
        powers = bed.solve(**state)
        assert closed and powers.surroundings == 0
    except fibrad.InputError as error:  # few spheres in a periodic box let some beams through
        assert "surroundings is missing" in str(error) if not closed else "leave the bed after 100 periods" in str(error)
        endless_tube = walls == "cylinder:0,0,3"  # whose ends nothing reaches
        assert (bed.solve(**state, surroundings=300).surroundings == 0) == endless_tube


def test_beams_that_cannot_be():
    with fibrad.Bed(PAIR, 1.0) as bed:
        for options, text in (({"directions": 4}, "directions"), ({"points": 65}, "points = 65 is none of 64, 128, 256"),
                              ({"patches": 25}, "patches = 25 is none of 24, 96, 384")):
            with pytest.raises(fibrad.InputError, match=text):
                bed.beams(**options)


def test_closed_for_good():
    bed = fibrad.Bed(PAIR, 1.0)
    bed.close()
    bed.close()
    for use in (lambda: bed.solve(300, 1, surroundings=300), lambda: bed.move(PAIR), bed.factors, bed.beams,
                lambda: bed.advance(300, 1, capacity=1, emissivity=0.5, surroundings=300)):
        with pytest.raises(fibrad.StateError, match="this Bed is closed"):
            use()


def test_one_thread_at_a_time(small):
    """A second thread is refused while the first one computes, and so is a law that asks the bed that asks it."""
    refused, computing = [], threading.Event()

    def progress(stage, done, total):
        if stage == "sweeps" and not computing.is_set():
            computing.set()
            other.join()

    def intrude():
        computing.wait()
        for use in (bed.close, lambda: bed.move(small.x), lambda: bed.solve(300, 1, surroundings=300)):
            with pytest.raises(fibrad.StateError, match="in use"):
                use()
            refused.append(use)

    bed = fibrad.Bed(small.x, small.r, progress=progress)
    other = threading.Thread(target=intrude)
    other.start()
    bed.solve(np.linspace(300, 900, small.n), 0.5, surroundings=300)
    assert len(refused) == 3
    asked = []

    def law(kelvins):
        asked.append(kelvins)
        return 0.5 if len(asked) == 1 else bed.factors()

    with pytest.raises(fibrad.StateError, match="in use"):
        bed.solve(600, law, surroundings=300)


def test_temperatures_are_found():
    """A sphere alone: A eps sigma (T^4 - T0^4) = W, with an emissivity that follows the temperature, too."""
    with fibrad.Bed([[0, 0, 0]], 0.5) as bed:
        found = bed.solve(None, 0.6, power=5e4, surroundings=300.)
        assert found.temperatures[0] == pytest.approx((5e4 / (np.pi * 0.6 * SIGMA) + 300**4)**0.25, rel=1e-9)
        assert found.spheres[0] == -5e4 and found.emissivities[0] == 0.6
        found = bed.solve(None, lambda kelvins: 0.9 - kelvins / 2000, power=5e4, surroundings=300.)
        kelvins = found.temperatures[0]
        assert np.pi * (0.9 - kelvins / 2000) * SIGMA * (kelvins**4 - 300**4) == pytest.approx(5e4, rel=1e-4)
        assert found.emissivities[0] == pytest.approx(0.9 - kelvins / 2000, abs=1e-5)
        with pytest.raises(ZeroDivisionError):
            bed.solve(None, lambda kelvins: 0.5 if kelvins[0] == 300 else 1 / 0, power=5e4, surroundings=300.)
    with fibrad.Bed([[0, 0, 0], [2, 0, 0]], 0.5) as bed:  # one power is for those without temperature
        one = bed.solve([300., np.nan], 0.5, power=5.0, surroundings=300.)
    assert one.spheres[1] == -5 and one.temperatures[0] == 300


def test_walls_find_their_temperatures():
    """A wall that gives off nothing, one that is insulated; in time the bed becomes as it is found at once."""
    walls = ["xmin:at=-9:insulated", "box:temperature=500:emissivity=0.8", "zmax:at=9:power=9e5:emissivity=0.8"]
    places = [f"{name}:at={at}:temperature=500:emissivity=0.8" for name, at in (("xmax", 9), ("ymin", -9), ("ymax", 9), ("zmin", -9))]
    with fibrad.Bed([[0, 0, 0], [3, 0, 0]], 1, walls=[*walls, *places]) as bed:
        bed.beams(directions=72, patches=24)
        found = bed.solve([np.nan, 700], 0.5, power=[0, np.nan], walls=[fibrad.wall("zmax", power=0)])
        short = bed.advance(400, 60, capacity=5e4, emissivity=0.5, power=[0, 1e4])
        end = bed.advance(short.temperatures, 1e5, capacity=5e4, emissivity=0.5, power=[0, 1e4])
        steady = bed.solve(None, 0.5, power=[0, 1e4])
    assert 500 < found.temperatures[0] < 700 and found.temperatures[1] == 700
    assert 500 < found.wall_temperatures["zmax"] < 700 and 500 < found.wall_temperatures["xmin"] < 700
    assert found.walls["zmax"] == found.walls["xmin"] == 0 and found.wall_temperatures["ymin"] == 500
    assert abs(found.balance) < 1e-12 * abs(found.spheres[1])
    assert short.walls["zmax"] == pytest.approx(-60 * 9e5, rel=1e-9) and abs(short.walls["xmin"]) < 1e-6 * 60 * 9e5
    assert end.temperatures == pytest.approx(steady.temperatures, rel=1e-4) and np.all(end.temperatures > 510)


def test_spheres_that_conduct():
    """The centre is P/(8 pi r k) above the mean of the surface; the side of a sphere that sees a hotter one is hotter."""
    with fibrad.Bed([[0, 0, 0], [0, 0, 0.07]], 0.03) as bed:
        plain, same, found = (bed.solve([1000, np.nan], 0.8, power=50., surroundings=600, conductivity=given)
                              for given in (None, np.inf, [2., 5.]))
    assert np.array_equal(plain.least_temperatures, plain.temperatures)
    assert same.temperatures == pytest.approx(plain.temperatures, rel=1e-5)
    rise = -found.spheres / (8 * np.pi * 0.03 * np.array([2., 5.]))
    assert found.centre_temperatures - found.temperatures == pytest.approx(rise, rel=1e-9)
    assert np.all(found.least_temperatures < found.temperatures) and np.all(found.surface_errors > 0)
    assert np.all(found.temperatures < found.largest_temperatures) and abs(found.balance) < 1e-12 * 1000**4 * SIGMA


def test_light_on_a_lone_sphere():
    """It takes its shadow, pi r^2, and what it absorbs it sends out again."""
    light = fibrad.Light((0, 0, -1), 1000.0)
    with fibrad.Bed([[0, 0, 0]], 0.5) as bed:
        absorbed = bed.shine(light, 0.4)
        powers = bed.solve(None, 0.8, power=0.0, surroundings=0.0, light=absorbed)
        given = bed.solve(300.0, 0.8, surroundings=300.0, light=absorbed)
        uneven = bed.solve(None, 0.8, power=0.0, surroundings=0.0, light=absorbed, conductivity=1.0)
    shadow = 1000 * np.pi * 0.25
    assert absorbed.first == pytest.approx(0.4 * shadow, rel=1e-12)
    assert absorbed.spheres == pytest.approx(0.4 * shadow, rel=1e-9)
    assert absorbed.incident == pytest.approx(1000) and absorbed.transmitted == pytest.approx(1000 - shadow)
    assert absorbed.spheres.sum() + absorbed.transmitted + absorbed.reflected == pytest.approx(absorbed.incident, rel=1e-12)
    assert powers.temperatures == pytest.approx((0.4 * shadow / (0.8 * np.pi * SIGMA)) ** 0.25, rel=1e-6)
    assert given.spheres == pytest.approx(0.4 * shadow, rel=1e-9)
    assert uneven.temperatures == pytest.approx(powers.temperatures, rel=1e-3)
    assert uneven.largest_temperatures[0] - uneven.least_temperatures[0] > 20
    assert abs(powers.balance) < 1e-9 and abs(given.balance) < 1e-9


def test_light_between_walls():
    """Insulated walls give off what they absorb; what comes in goes out. Without an absorptivity it is the emissivity."""
    beam = [fibrad.Light((0.2, 0, -1), 1000.0, half_angle=fibrad.Light.SUN)]
    for walls in ("zmin:at=-1:insulated:absorptivity=0.5", "zmin:at=-1:insulated:emissivity=0.5"):
        with fibrad.Bed([[0, 0, 0]], 0.5, box=[2, 2, 0], walls=walls) as bed:
            absorbed = bed.shine(beam, 0.5)
            powers = bed.solve(None, 0.8, power=0.0, surroundings=0.0, light=absorbed)
        assert 0 < absorbed.walls["zmin"] < 0.6 * absorbed.incident
        assert powers.surroundings == pytest.approx(0, abs=1e-6 * absorbed.incident)
        assert powers.walls["zmin"] == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("light, why", [
    (dict(direction=(0, 0, 0), flux=1), "leads nowhere"), (dict(direction=(0, 0), flux=1), "3 finite numbers"),
    (dict(direction=(0, 0, 1), flux=1), "no open face"), (dict(direction=(0, 0, -1), flux=-1), "flux"),
    (dict(direction=(0, 0, -1), flux=1, disc=(0, 0, 0, 1)), "before the disc"),
    (dict(direction=(0, 0, -1), flux=1, disc=(0, 0, 9, 1), box=(0, 1, 0, 1)), "one disc or one box"),
])
def test_lights_that_are_refused(light, why):
    with fibrad.Bed([[0, 0, 0]], 0.5, box=[2, 2, 0], walls="zmin:at=-1") as bed:
        with pytest.raises(fibrad.InputError, match=why):
            bed.shine(fibrad.Light(**light), 0.5)


def test_a_row_in_contact():
    """Without emission all of the power goes through the contacts to the floor."""
    with fibrad.Bed([[0, 0, 1], [0, 0, 3], [0, 0, 5]], 1.0, walls="zmin:at=0:temperature=400") as bed:
        bed.beams(directions=36, patches=24)
        with pytest.raises(fibrad.InputError, match="nothing that it touches"):
            bed.solve(None, 0, power=0, surroundings=300, contacts=([0], [1], [1.0]))
        contacts = ([0, 1, "zmin"], [1, 2, 0], [0.5, 0.25, 2.0])
        powers = bed.solve(None, 0, power=[0, 0, 40.0], surroundings=300, contacts=contacts)
        end = bed.advance(400, 1e4, capacity=10.0, emissivity=0, power=[0, 0, 40.0], surroundings=300, contacts=contacts)
    assert powers.temperatures == pytest.approx([420, 500, 660], rel=1e-9)
    assert powers.contact_flows == pytest.approx([-40, -40, -40], rel=1e-9)
    assert powers.wall_conducted["zmin"] == pytest.approx(40, rel=1e-9)
    assert powers.conducted.sum() == pytest.approx(-40, rel=1e-9)
    assert end.temperatures == pytest.approx(powers.temperatures, rel=1e-4)


def test_a_matrix_of_contacts():
    """A symmetric matrix is a contact for each element above the diagonal."""
    sparse = pytest.importorskip("scipy.sparse")
    matrix = sparse.csr_matrix([[0, 2.0], [2.0, 0]])
    with fibrad.Bed(PAIR, 1.0) as bed:
        by_matrix, by_list = (bed.solve([1000, np.nan], 0.8, power=0, surroundings=300, contacts=contacts)
                              for contacts in (matrix, ([1], [0], [2.0])))
        with pytest.raises(fibrad.InputError, match="not symmetric"):
            bed.solve([1000, np.nan], 0.8, power=0, surroundings=300, contacts=sparse.triu(matrix))
    assert by_matrix.temperatures == pytest.approx(by_list.temperatures, rel=1e-6)
    assert by_matrix.conducted[1] == pytest.approx(2 * (1000 - by_matrix.temperatures[1]), rel=1e-9)


@pytest.mark.parametrize("contacts", [([0], [9], [1.0]), ([0], [1], [-1.0]), ([0], [1], [np.nan]), ([0], ["zmin"], [1.0]),
                                      ([0, 1], [1], [1.0])])
def test_contacts_that_are_refused(contacts):
    with fibrad.Bed(PAIR, 1.0) as bed, pytest.raises(fibrad.InputError, match="contacts"):
        bed.solve(1000, 0.8, surroundings=300, contacts=contacts)


def test_contacts_by_overlaps():
    """A spot conducts 2 k a between spheres, and 4 k a to a wall."""
    with fibrad.Bed([[0, 0, 0.99], [0, 0, 2.97]], 1.0, walls="zmin:at=0") as bed:
        first, second, conductance = bed.contacts(conductivity=3)
    assert sorted(zip(first, second)) == [(0, 2), (1, 0)]
    assert sorted(conductance) == pytest.approx([2 * 3 * np.sqrt(1 - 0.99**2), 4 * 3 * np.sqrt(1 - 0.99**2)])
    apart = fibrad.Bed([[0, 0, 0], [0, 0, 2.1]], 1.0)
    assert apart.contacts(conductivity=3).first.size == 0
    assert apart.contacts(conductivity=3, gas_conductivity=0.1).conductance[0] > 0
    for wrong in ({"spots": "flat", "conductivity": 1}, {}, {"conductivity": 0}, {"conductivity": 1, "gas_gap": 2, "gas_conductivity": 1}):
        with pytest.raises(fibrad.InputError):
            apart.contacts(**wrong)


def test_one_sphere_in_the_cold():
    """Into surroundings at 0 K: 1/T^3 grows by 3 A e sigma/C a second. A law of emissivities is asked in each step."""
    area, capacity = 4 * np.pi * 0.02**2, 50.0
    expected = (1200**-3 + 3 * area * 0.6 * SIGMA / capacity * 300) ** (-1 / 3)
    for emissivity in (0.6, lambda kelvins: 0.6 + 0 * kelvins):
        with fibrad.Bed([[1, 2, 3]], 0.02) as bed:
            end = bed.advance(1200, 300, capacity=capacity, emissivity=emissivity, surroundings=0)
        assert end.temperatures[0] == pytest.approx(expected, rel=1e-4)
        assert end.surroundings == pytest.approx(capacity * (1200 - end.temperatures[0]), rel=1e-12)
        assert end.spheres[0] == pytest.approx(-area * 0.6 * SIGMA * expected**4, rel=1e-3)
        assert 0 < end.error <= 1e-4 and end.walls == {} and end.steps > 5


def test_powers_walls_and_a_move(small):
    """What is supplied is stored, or goes to the walls; a wall that follows time; fixed steps."""
    capacity, power = np.full(len(small.x), 3.0), np.linspace(0, 5, len(small.x))
    given = {"capacity": capacity, "emissivity": 0.5, "power": power, "surroundings": 300}
    with fibrad.Bed(small.x, small.r, walls="zmin:at=-2:temperature=500:emissivity=0.7") as bed:
        one = bed.advance(600, 10, **given, walls_end="zmin:temperature=900", step=1)
        bed.move(small.x + [0, 0, 0.1])
        two = bed.advance(one.temperatures, 10, **given, walls="zmin:temperature=900")
    assert one.steps == 10
    for begin, end in ((np.full(len(small.x), 600.0), one), (one.temperatures, two)):
        stored = capacity @ (end.temperatures - begin)
        gone = end.surroundings + end.walls["zmin"]
        assert stored + gone == pytest.approx(10 * power.sum(), abs=1e-9 * abs(stored))
    assert f"<fibrad.Advance: {small.n} spheres of" in repr(one) and "zmin" in repr(one)


def test_a_bed_shows_itself_and_cannot_be_pickled():
    with fibrad.Bed([[0, 0, 0], [3, 0, 0]], [1, 2.5], walls="zmin:at=-3,zmax:at=3", box=[9, 0, 0]) as bed:
        assert repr(bed) == "<fibrad.Bed: 2 spheres of radius 1 to 2.5, box (9, 0, 0), zmin, zmax>"
        for copied in (pickle.dumps, copy.copy):
            with pytest.raises(TypeError, match="a Bed cannot be pickled or copied"):
                copied(bed)
    assert repr(bed).endswith("closed>")
    assert repr(fibrad.Bed(np.zeros((0, 3)), 1.0)) == "<fibrad.Bed: 0 spheres>"


def test_ends_of_contacts_may_be_whole_floats():
    bed = fibrad.Bed([[0, 0, 0], [3, 0, 0]], 1.0)
    given = {"temperature": [900.0, np.nan], "emissivity": 0.8, "power": 0.0, "surroundings": 300.0}
    one = bed.solve(**given, contacts=([0], [1], [5.0]))
    two = bed.solve(**given, contacts=(np.array([0.0]), [1.0], [5.0]))
    assert two.temperatures[1] == pytest.approx(one.temperatures[1], rel=1e-6)
    for end in (np.nan, 0.5):
        with pytest.raises(fibrad.InputError, match="neither a sphere nor a wall"):
            bed.solve(**given, contacts=([end], [1], [5.0]))
    with pytest.raises(fibrad.InputError, match="coo_array makes one of a dense matrix"):
        bed.solve(**given, contacts=np.ones((2, 2)))


def test_spans_that_cannot_be():
    bed = fibrad.Bed([[0, 0, 0], [3, 0, 0]], 1.0, ids=[7, 9], walls="zmin:at=-2:temperature=300")
    good = dict(capacity=1.0, emissivity=0.5, surroundings=300)
    for temperature, duration, options, text in (
            (300, 1, {"surroundings": None}, "surroundings is missing"), ([300, 0], 1, {}, "9"), (300, -1, {}, "duration"),
            (300, 1e6, {"power": -1e9}, ""), (300, 1, {"walls_end": "zmin:insulated"}, "walls_end"),
            (300, 1, {"walls_end": "zmax:temperature=3"}, "no wall 'zmax'")):
        with pytest.raises(fibrad.InputError, match=text):
            bed.advance(temperature, duration, **{**good, **options})


def test_convection_is_a_film():
    """A sphere that reflects everything follows gas; a wall that does gives its power to gas."""
    box = [f"{side}:at={at}:temperature=400" for side, at in
           (("xmax", 2), ("ymin", -2), ("ymax", 2), ("zmin", -2), ("zmax", 2))]
    bed = fibrad.Bed([[0.0, 0, 0]], 1.0, walls=["xmin:at=-2:power=200:emissivity=0:convection=5:gas=310", *box])
    powers = bed.solve(None, 0.0, power=100.0, convection=2.0, gas_temperature=350.0)
    assert powers.temperatures[0] == pytest.approx(350 + 100 / (2 * 4 * math.pi), rel=1e-12)
    assert powers.wall_temperatures["xmin"] == pytest.approx(310 + 200 / (5 * 16), rel=1e-12)
    assert powers.gas == pytest.approx(300, rel=1e-12)
    assert powers.convected[0] == pytest.approx(-100, rel=1e-12)
    assert abs(powers.balance) < 1e-9
    rate = 2 * 4 * math.pi / 1000
    later = bed.advance(300.0, 20.0, capacity=1000.0, emissivity=0.0, convection=2.0, gas_temperature=300.0,
                        gas_temperature_end=400.0, step=0.05)
    assert later.temperatures[0] == pytest.approx(300 + 5 * (20 - (1 - math.exp(-rate * 20)) / rate), abs=1e-5)
    with pytest.raises(fibrad.Error, match="need each other"):
        bed.solve(None, 0.0, power=0.0, convection=2.0)


def test_gas_that_flows():
    """Spheres of given powers warm a stream by what they give off, slice by slice."""
    bed = fibrad.Bed([[0.0, 0, 3 * k] for k in range(3)], 1.0)
    film = {"convection": 2.0, "gas_temperature": 300.0}
    powers = bed.solve(None, 0.0, power=[10.0, 20.0, 30.0], surroundings=300, gas_flow=([2, 1, 0], 5.0), **film)
    assert powers.gas_temperatures == pytest.approx([306, 310, 312], rel=1e-12)
    assert powers.temperatures == pytest.approx(np.array([312, 310, 306]) + np.array([10, 20, 30]) / (8 * math.pi), rel=1e-12)
    varies = bed.solve(None, 0.0, power=[0.0, 0.0, 30.0], surroundings=300, gas_flow=([2, 1, 0], [[300, 5], [400, 15]]), **film)
    assert varies.gas_temperatures[2] == pytest.approx(300 + (-5 + math.sqrt(25 + .2 * 30)) / .1, rel=1e-12)
    later = bed.advance(300.0, 1e5, capacity=1000.0, emissivity=0.0, surroundings=300, gas_flow=([2, 1, 0], 5.0),
                        gas_temperature_end=400.0, **film)
    assert later.gas == pytest.approx(-1000 * np.sum(later.temperatures - 300), rel=1e-12)
    assert later.gas_temperatures == pytest.approx([400, 400, 400], abs=1)
    for flow, why in (([0, 1], "slices"), ([0, -1, 0], "slices"), ([0.5, 0, 0], "slices")):
        with pytest.raises(fibrad.Error, match=why):
            bed.solve(None, 0.0, power=1.0, surroundings=300, gas_flow=(flow, 5.0), **film)
    with pytest.raises(fibrad.Error, match="stream"):
        bed.solve(None, 0.0, power=1.0, surroundings=300, gas_flow=([0, 0, 0], -5.0), **film)


def test_stored_heat():
    """A table with a latent heat, a held sphere and a wall with a capacity: closed forms without radiation."""
    bed = fibrad.Bed([[0.0, 0, 0], [0.5, 0, 0]], 0.1, walls="box:temperature=300")
    metal = fibrad.Store([300, 700], [1.0, 3.0], melting=500, latent=400)
    first = bed.advance(300.0, 10.0, capacity=[2.0, math.inf], emissivity=0.0, power=[100.0, 5.0], store=metal)
    assert first.stored == pytest.approx([1000, 0]) and first.held == pytest.approx(50)
    assert first.temperatures == pytest.approx([500, 300]) and first.melted == pytest.approx([0.5, 0])
    last = bed.advance(first.temperatures, 3.0, capacity=[2.0, math.inf], emissivity=0.0, power=[100.0, 5.0], store=[metal],
                       store_of=[0, 0], melted=first.melted)
    assert last.temperatures[0] == pytest.approx(500, abs=1e-9) and last.melted[0] == pytest.approx(0.875, abs=1e-12)
    walls = "zmin:capacity=50:temperature=400:power=7:emissivity=0,zmax:capacity=20:temperature=400:emissivity=0"
    end = bed.advance(300.0, 10.0, capacity=1.0, emissivity=0.0, walls=walls)
    assert end.wall_temperatures["zmin"] == pytest.approx(401.4) and end.wall_temperatures["zmax"] == pytest.approx(400)
    assert bed.solve([300, 300], 0.5, walls="zmin:capacity=5:temperature=400:power=7").wall_temperatures["zmin"] == 400
    for wrong in (fibrad.Store([300, 200], [1, 1]), fibrad.Store([300], [0]), fibrad.Store(latent=-1)):
        with pytest.raises(fibrad.Error, match="Store needs"):
            bed.advance(300.0, 1.0, capacity=1.0, emissivity=0.0, store=wrong)
    with pytest.raises(fibrad.Error, match="exclude each other"):
        bed.advance(300.0, 1.0, capacity=1.0, emissivity=0.0, walls="zmin:temperature=300:power=3")
