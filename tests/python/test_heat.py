# test_heat.py - powers from Python against closed forms. SPDX-License-Identifier: MIT
import threading

import numpy as np
import pytest

import fibrad

SIGMA = fibrad.STEFAN_BOLTZMANN
CUBE = {"xmin": -5, "xmax": 5, "ymin": -5, "ymax": 5, "zmin": -5, "zmax": 5}
PAIR = [[0, 0, 0], [0, 0, 3]]
F12 = fibrad.view_factors(PAIR, 1, directions=65536).data[0]


@pytest.mark.parametrize("emissivity", [0.3, 1])
def test_one_sphere(emissivity):
    """It sees the surroundings alone: 4 pi r^2 e sigma (Ta^4 - T^4)."""
    with fibrad.Heat([[1, 2, 3]], 0.02) as heat:
        powers = heat.solve(900, emissivity, surroundings=400)
    expected = 4 * np.pi * 0.02**2 * emissivity * SIGMA * (400**4 - 900**4)
    assert powers.spheres == pytest.approx(expected, rel=1e-9, abs=1e-12) and powers.walls == {}
    assert powers.surroundings == pytest.approx(-expected, rel=1e-9, abs=1e-12)
    assert abs(powers.balance) < 1e-12 * 900**4 * SIGMA


def test_two_black_spheres():
    """By the exact view factor between them."""
    with fibrad.Heat(PAIR, 1.0, directions=1000) as heat:
        powers = heat.solve([1000, 500], 1, surroundings=300)
    hot, warm, cold = SIGMA * 1000**4, SIGMA * 500**4, SIGMA * 300**4
    area = 4 * np.pi
    expected = area * np.array([F12 * warm + (1 - F12) * cold - hot, F12 * hot + (1 - F12) * cold - warm])
    assert np.sqrt(np.mean((powers.spheres - expected) ** 2)) < 3 * powers.error < 1e-3 * area * hot
    assert abs(powers.surroundings + expected.sum()) < 3 * powers.surroundings_error < 1e-3 * area * hot


def test_a_mirror_gains_nothing():
    powers = fibrad.Heat(PAIR, 1.0).solve([1000, 300], [0.5, 0], surroundings=400)
    assert abs(powers.spheres[1]) < powers.error < 0.01 * -powers.spheres[0]


@pytest.mark.parametrize("e1, e2", [(1, 1), (0.8, 0.5), (0.1, 0.9)])
def test_parallel_plates(e1, e2):
    """No spheres: sigma (T1^4 - T2^4)/(1/e1 + 1/e2 - 1) for each of 2 m2."""
    heat = fibrad.Heat(np.zeros((0, 3)), [], box=(1, 2, 0), walls={"zmin": 0, "zmax": 1})
    powers = heat.solve([], [], wall_temperature={"zmax": 500, "zmin": 1000}, wall_emissivity={"zmin": e1, "zmax": e2})
    expected = 2 * SIGMA * (1000**4 - 500**4) / (1 / e1 + 1 / e2 - 1)
    assert powers.walls["zmax"] == pytest.approx(expected, rel=1e-5)
    assert powers.walls["zmin"] == pytest.approx(-expected, rel=1e-5) and powers.surroundings == 0


def test_a_sphere_within_black_walls():
    """Closed, so that no temperature of surroundings is needed."""
    heat = fibrad.Heat([[0, 0, 0]], 1.0, walls=CUBE)
    powers = heat.solve(500, 0.4, wall_temperature=800, wall_emissivity=1)
    assert powers.spheres[0] == pytest.approx(4 * np.pi * 0.4 * SIGMA * (800**4 - 500**4), rel=1e-9)
    assert powers.surroundings == 0 and sum(powers.walls.values()) == pytest.approx(-powers.spheres[0])


def test_a_box_without_a_lid():
    """As with a black lid as hot as the surroundings; at the end of the spheres where no place is given."""
    x, r = [[0, 0, -2], [1, 2, 3]], [1, 0.5]
    states = {"emissivity": 0.6, "surroundings": 300}
    for lid, at in (("open", 3.5), (("open", 5), 5)):
        with fibrad.Heat(x, r, walls={**CUBE, "zmax": lid}) as heat:
            cup = heat.solve(500, wall_temperature={name: {"zmin": 900}.get(name, 600) for name in CUBE if name != "zmax"},
                             wall_emissivity=0.5, **states)
            assert set(cup.walls) == set(CUBE) - {"zmax"}
            with pytest.raises(fibrad.InputError, match="surroundings"):
                heat.solve(500, 0.6, wall_temperature=600, wall_emissivity=0.5)
            with pytest.raises(fibrad.InputError, match="zmax is open"):
                heat.solve(500, wall_temperature={"zmax": 600}, wall_emissivity=0.5, **states)
        with fibrad.Heat(x, r, walls={**CUBE, "zmax": at}) as heat:
            box = heat.solve(500, wall_temperature={name: {"zmin": 900, "zmax": 300}.get(name, 600) for name in CUBE},
                             wall_emissivity={name: 1 if name == "zmax" else 0.5 for name in CUBE}, **states)
        assert cup.spheres == pytest.approx(box.spheres, rel=1e-13)
        assert cup.surroundings == pytest.approx(box.walls["zmax"], rel=1e-13) and cup.surroundings > 1e4
        assert cup.walls["zmin"] == pytest.approx(box.walls["zmin"], rel=1e-13)


def test_open_sides_move_with_the_spheres():
    walls = {"zmin": -1, "zmax": "open", "cylinder": (0, 0, 4)}
    with fibrad.Transient([[0, 0, 0]], 0.5, walls=walls, method="factors") as bed:
        bed.move([[0, 0, 5]])
        assert bed.advance([900], 1, capacity=1e4, emissivity=0.5, surroundings=300, wall_temperature=600,
                           wall_emissivity=0.5).temperatures[0] < 900
        with pytest.raises(fibrad.InputError, match="they were zmin, cylinder, zmax open"):
            bed.move([[0, 0, 5]], walls={"zmin": -1, "zmax": 9, "cylinder": (0, 0, 4)})


def test_at_one_temperature_nothing_flows(small):
    powers = fibrad.Heat(small.x, small.r, walls={"zmin": 0}).solve(700, 0.5, surroundings=700, wall_temperature=700,
                                                                   wall_emissivity=0.2)
    assert np.abs(powers.spheres).max() < 1e-9 * SIGMA * 700**4


def test_energy_is_kept(small):
    temperature = np.linspace(300, 1200, small.n)
    powers = fibrad.Heat(small.x, small.r, walls={"zmin": -9, "zmax": 99}).solve(
        temperature, 0.7, surroundings=350, wall_temperature={"zmin": 900, "zmax": 300}, wall_emissivity=0.9)
    assert abs(powers.balance) < 1e-11 * np.abs(powers.spheres).sum()
    assert 0 < powers.error < 0.02 * np.sqrt(np.mean(powers.spheres**2))
    assert powers.error == pytest.approx(np.hypot(powers.error_patches, powers.error_beams))
    assert powers.sweeps > 0 and 0 < powers.residual < 1e-3


def test_powers_follow_from_exchange_factors(small):
    """The same by paths: sum over j of A_i e_i D_ij sigma (T_j^4 - T_i^4)."""
    e = np.linspace(0.4, 0.9, small.n)
    emission = SIGMA * np.linspace(300, 1200, small.n) ** 4
    exchange = fibrad.exchange_factors(small.x, small.r, e, directions=500, paths=8000)
    outside = SIGMA * 300**4
    sent = 4 * np.pi * small.r**2 * e
    expected = sent * (exchange.matrix @ emission + exchange.escaped * outside - emission)
    powers = fibrad.Heat(small.x, small.r, directions=500).solve((emission / SIGMA) ** 0.25, e, surroundings=300)
    assert np.sqrt(np.mean((powers.spheres - expected) ** 2)) < 0.005 * np.sqrt(np.mean(expected**2))


def test_threads_change_no_bit(small):
    one, three = (fibrad.Heat(small.x, small.r, threads=threads).solve(np.linspace(300, 900, small.n), 0.5, surroundings=0)
                  for threads in (1, 3))
    assert one.spheres.tobytes() == three.spheres.tobytes() and one.surroundings == three.surroundings


def test_move(small):
    """Moved spheres have the powers of a Heat made anew, and those of before when they are back."""
    state = {"temperature": np.linspace(300, 900, small.n), "emissivity": 0.5, "surroundings": 300, "tolerance": 1e-8}
    there = small.x * 1.5
    with fibrad.Heat(small.x, small.r) as heat, fibrad.Heat(there, small.r) as anew:
        before = heat.solve(**state).spheres
        heat.move(there)
        expected = anew.solve(**state).spheres
        scale = np.abs(expected).max()
        assert heat.solve(**state).spheres == pytest.approx(expected, abs=1e-6 * scale)
        heat.move(small.x, small.r)
        assert heat.solve(**state).spheres == pytest.approx(before, abs=1e-6 * scale)
        heat.move(np.asfortranarray(small.x), small.r * 0.9)
        assert np.abs(heat.solve(**state).spheres - before).max() > 0.01 * scale


def test_walls_move():
    heat = fibrad.Heat([[0, 0, 0]], 1.0, walls={"zmin": -1, "zmax": 1}, box=(4, 4, 0))
    state = {"temperature": 300, "emissivity": 1, "wall_temperature": {"zmin": 900, "zmax": 900}, "wall_emissivity": 1}
    near = heat.solve(**state).spheres[0]
    heat.move([[0, 0, 0]], walls={"zmin": -9, "zmax": 9})
    assert heat.solve(**state).spheres[0] == pytest.approx(near, rel=0.1)
    heat.move([[0, 0, 0]], box=(8, 8, 0))
    heat.solve(**state)


def test_moves_that_cannot_be(small):
    heat = fibrad.Heat(small.x, small.r, ids=np.arange(small.n) + 100)
    before = heat.solve(300, 1, surroundings=400).spheres
    with pytest.raises(fibrad.InputError, match=rf"\(5, 3\); this Heat has {small.n}"):
        heat.move(small.x[:5], small.r[:5])
    with pytest.raises(fibrad.InputError, match="the walls are zmin; they were none"):
        heat.move(small.x, walls={"zmin": -1})
    broken = small.x.copy()
    broken[7, 0] = np.nan
    with pytest.raises(fibrad.InputError, match="sphere of id 107 at") as caught:
        heat.move(broken)
    assert caught.value.spheres == (7,)
    assert heat.solve(300, 1, surroundings=400).spheres == pytest.approx(before, rel=1e-6)  # the bed of before


@pytest.mark.parametrize("options, text", [
    ({}, "surroundings is missing"), ({"surroundings": -1}, "surroundings"), ({"surroundings": np.nan}, "surroundings"),
    ({"temperature": [300, -1]}, "temperature of sphere 1 is -1"), ({"temperature": [300, np.nan]}, "temperature of sphere 1"),
    ({"temperature": [300]}, "temperature has the shape"), ({"emissivity": 1.1}, "emissivity of sphere 0 is 1.1"),
    ({"wall_temperature": 300}, "there are no walls"), ({"sigma": 0}, "sigma"), ({"tolerance": 2}, "tolerance"),
])
def test_sources_that_cannot_be(options, text):
    heat = fibrad.Heat(PAIR, 1.0)
    given = {"temperature": 300, "emissivity": 1, **({"surroundings": 300} if options else {}), **options}
    with pytest.raises(fibrad.InputError, match=text):
        heat.solve(**given)


def test_walls_have_temperatures_by_name():
    heat = fibrad.Heat(PAIR, 1.0, walls={"zmin": -1, "zmax": 4})
    state = {"temperature": 300, "emissivity": 1, "surroundings": 0}
    for temperature, text in ((None, "wall_temperature of zmin, zmax is missing"),
                              ({"zmin": 3}, "wall_temperature of zmax is missing"),
                              ({"zmin": 3, "zmax": 3, "top": 3}, "no wall 'top'; there are zmin, zmax"),
                              ({"zmin": 3, "zmax": np.nan}, "wall_temperature of zmax")):
        with pytest.raises(fibrad.InputError, match=text):
            heat.solve(**state, wall_temperature=temperature, wall_emissivity=1)
    with pytest.raises(fibrad.InputError, match="wall_emissivity of zmin, zmax is missing"):
        heat.solve(**state, wall_temperature=300)


@pytest.mark.parametrize("box, walls, closed", [
    ((6, 6, 6), {}, True), ((6, 6, 0), {}, False), ((6, 6, 0), {"zmin": -2, "zmax": 2}, True),
    ((6, 6, 0), {"zmin": -2}, False), ((0, 0, 6), {"cylinder": (0, 0, 3)}, True),
    (None, {"cylinder": (0, 0, 3), "zmin": -2, "zmax": 2}, True), (None, {"cylinder": (0, 0, 3), "zmin": -2, "zmax": "open"}, False),
    (None, CUBE, True),
])
def test_what_is_closed_needs_no_surroundings(box, walls, closed):
    heat = fibrad.Heat([[0, 0, 0], [2, 2, 0]], 0.5, box=box, walls=walls)
    state = {"temperature": [300, 900], "emissivity": 1}
    if walls:
        state.update(wall_temperature=500, wall_emissivity=0.5)
    try:
        powers = heat.solve(**state)
        assert closed and powers.surroundings == 0
    except fibrad.InputError as error:  # few spheres in a periodic box let some beams through
        assert "surroundings is missing" in str(error) if not closed else "leave the bed after 100 periods" in str(error)
        endless_tube = walls == {"cylinder": (0, 0, 3)}  # whose ends nothing reaches
        assert (heat.solve(**state, surroundings=300).surroundings == 0) == endless_tube


def test_configurations_that_cannot_be():
    for options, text in (({"directions": 4}, "directions"), ({"points": 65}, "points = 65 is none of 64, 128, 256"),
                          ({"patches": 25}, "patches = 25 is none of 24, 96, 384"), ({"ids": [2, 2]}, "id 2")):
        with pytest.raises(fibrad.InputError, match=text):
            fibrad.Heat(PAIR, 1.0, **options)
    with pytest.raises(fibrad.InputError, match="same centre") as caught:
        fibrad.Heat([[0, 0, 0], [0, 0, 0]], 1.0)
    assert caught.value.spheres == (0, 1)


def test_closed_for_good():
    heat = fibrad.Heat(PAIR, 1.0)
    heat.close()
    heat.close()
    with pytest.raises(fibrad.StateError, match="closed"):
        heat.solve(300, 1, surroundings=300)
    with pytest.raises(RuntimeError, match="closed"):
        heat.move(PAIR)


def test_one_thread_at_a_time(small):
    """A second thread is refused while the first one computes."""
    refused, computing = [], threading.Event()

    def progress(stage, done, total):
        if stage == "sweeps" and not computing.is_set():
            computing.set()
            other.join()

    def intrude():
        computing.wait()
        for use in (heat.close, lambda: heat.move(small.x), lambda: heat.solve(300, 1, surroundings=300)):
            with pytest.raises(fibrad.StateError, match="in use"):
                use()
            refused.append(use)

    heat = fibrad.Heat(small.x, small.r, progress=progress)
    other = threading.Thread(target=intrude)
    other.start()
    heat.solve(np.linspace(300, 900, small.n), 0.5, surroundings=300)
    assert len(refused) == 3


def test_temperatures_are_found():
    """A sphere alone: A eps sigma (T^4 - T0^4) = W, with an emissivity that follows the temperature, too."""
    with fibrad.Heat([[0, 0, 0]], 0.5) as heat:
        found = heat.solve(None, 0.6, power=5e4, surroundings=300.)
        assert found.temperatures[0] == pytest.approx((5e4 / (np.pi * 0.6 * SIGMA) + 300**4)**0.25, rel=1e-9)
        assert found.spheres[0] == -5e4 and found.emissivities[0] == 0.6
        found = heat.solve(None, lambda kelvins: 0.9 - kelvins / 2000, power=5e4, surroundings=300.)
        kelvins = found.temperatures[0]
        assert np.pi * (0.9 - kelvins / 2000) * SIGMA * (kelvins**4 - 300**4) == pytest.approx(5e4, rel=1e-4)


def test_walls_find_their_temperatures(small):
    box = {side: value for side, value in zip(("xmin", "xmax", "ymin", "ymax", "zmin", "zmax"), (-9, 9) * 3)}
    with fibrad.Heat([[0, 0, 0], [3, 0, 0]], 1, walls=box) as heat:
        found = heat.solve([np.nan, 700], 0.5, power=[0, np.nan], wall_temperature=500, wall_emissivity=0.8,
                           wall_power={"zmax": 0}, insulated=["xmin"])
    assert 500 < found.temperatures[0] < 700 and found.temperatures[1] == 700
    assert 500 < found.wall_temperatures["zmax"] < 700 and 500 < found.wall_temperatures["xmin"] < 700
    assert found.walls["zmax"] == found.walls["xmin"] == 0 and found.wall_temperatures["ymin"] == 500
    assert abs(found.balance) < 1e-12 * abs(found.spheres[1])


def test_spheres_that_conduct():
    """The centre is P/(8 pi r k) above the mean of the surface; the side of a sphere that sees a hotter one is hotter."""
    with fibrad.Heat([[0, 0, 0], [0, 0, 0.07]], 0.03) as heat:
        plain = heat.solve([1000, np.nan], 0.8, power=50., surroundings=600)
        same = heat.solve([1000, np.nan], 0.8, power=50., surroundings=600, conductivity=np.inf)
        found = heat.solve([1000, np.nan], 0.8, power=50., surroundings=600, conductivity=[2., 5.])
        with pytest.raises(fibrad.InputError, match="conductivity"):
            heat.solve(1000, 0.8, surroundings=600, conductivity=0)
    assert np.array_equal(plain.least_temperatures, plain.temperatures)
    assert same.temperatures == pytest.approx(plain.temperatures, rel=1e-5)
    rise = -found.spheres / (8 * np.pi * 0.03 * np.array([2., 5.]))
    assert found.centre_temperatures - found.temperatures == pytest.approx(rise, rel=1e-9)
    assert np.all(found.least_temperatures < found.temperatures) and np.all(found.surface_errors > 0)
    assert np.all(found.temperatures < found.largest_temperatures) and abs(found.balance) < 1e-12 * 1000**4 * SIGMA


@pytest.mark.parametrize("options, text", [
    ({"temperature": np.nan}, "temperature"),
    ({"temperature": None, "power": -1e9}, "temperatures"),
    ({"wall_power": {"zmax": 1.}}, "no wall"),
])
def test_temperatures_that_cannot_be(options, text):
    with fibrad.Heat([[0, 0, 0]], 0.5) as heat, pytest.raises(fibrad.InputError, match=text):
        heat.solve(**{"temperature": 300., "emissivity": 0.5, "surroundings": 300., **options})


@pytest.mark.parametrize("options, text", [
    ({"power": 5.0}, "power is given, and all spheres have temperatures"),
    ({"power": [5.0, np.nan]}, "power is given, and all spheres have temperatures"),
    ({"temperature": [300., np.nan], "power": [5., 5.]}, "both a temperature and a power.*sphere 0"),
    ({"temperature": [300., np.nan], "power": [np.nan, np.nan]}, "neither a temperature nor a power.*sphere 1"),
    ({"temperature": [300., np.nan], "power": [np.nan, 5.], "emissivity": [.5, 0.]}, "has emissivity 0.*sphere 1"),
    ({"wall_temperature": None, "wall_power": {"zmin": 5.}}, "wall zmin: is endless"),
])
def test_what_is_given_twice_or_not_at_all(options, text):
    given = {"temperature": 300., "emissivity": 0.5, "surroundings": 300., "wall_temperature": 400.,
             "wall_emissivity": 0.5, **options}
    with fibrad.Heat([[0, 0, 0], [2, 0, 0]], 0.5, walls={"zmin": -1.}) as heat, \
            pytest.raises(fibrad.InputError, match=text):
        heat.solve(**given)


def test_one_power_is_for_those_without_temperature():
    with fibrad.Heat([[0, 0, 0], [2, 0, 0]], 0.5) as heat:
        one = heat.solve([300., np.nan], 0.5, power=5.0, surroundings=300.)
    assert one.spheres[1] == -5 and one.temperatures[0] == 300


@pytest.mark.parametrize("walls, box, text", [
    ({"zmin": 1., "zmax": -1.}, None, "wall zmax: contradicts the box or another wall"),
    ({"zmin": -1., "xmax": 1.}, [9, 0, 0], "wall xmax: contradicts"),
    ({"cylinder": (0, 0, 5.), "ymin": -1.}, None, "wall ymin: contradicts"),
    ({"zmin": .5}, None, "the centre lies beyond a wall: sphere 0 at"),
])
def test_walls_are_named(walls, box, text):
    with pytest.raises(fibrad.InputError, match=text):
        fibrad.view_factors([[0, 0, 0]], 0.5, walls=walls, box=box)


def test_light_on_a_lone_sphere():
    """It takes its shadow, pi r^2, and what it absorbs it sends out again."""
    light = fibrad.Light((0, 0, -1), 1000.0)
    with fibrad.Heat([[0, 0, 0]], 0.5) as heat:
        absorbed = heat.shine(light, 0.4)
        powers = heat.solve(None, 0.8, power=0.0, surroundings=0.0, light=absorbed)
        given = heat.solve(300.0, 0.8, surroundings=300.0, light=absorbed)
        uneven = heat.solve(None, 0.8, power=0.0, surroundings=0.0, light=absorbed, conductivity=1.0)
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
    """Insulated walls give off what they absorb; what comes in goes out."""
    with fibrad.Heat([[0, 0, 0]], 0.5, box=[2, 2, 0], walls={"zmin": -1}) as heat:
        absorbed = heat.shine([fibrad.Light((0.2, 0, -1), 1000.0, half_angle=fibrad.Light.SUN)], 0.5, wall_absorptivity=0.5)
        powers = heat.solve(None, 0.8, power=0.0, surroundings=0.0, insulated=["zmin"], light=absorbed)
    assert absorbed.walls["zmin"] > 0
    assert powers.surroundings == pytest.approx(0, abs=1e-6 * absorbed.incident)
    assert powers.walls["zmin"] == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("light, why", [
    (dict(direction=(0, 0, 0), flux=1), "leads nowhere"),
    (dict(direction=(0, 0), flux=1), "3 finite numbers"),
    (dict(direction=(0, 0, 1), flux=1), "no open face"),
    (dict(direction=(0, 0, -1), flux=-1), "flux"),
    (dict(direction=(0, 0, -1), flux=1, disc=(0, 0, 0, 1)), "before the disc"),
    (dict(direction=(0, 0, -1), flux=1, disc=(0, 0, 9, 1), box=(0, 1, 0, 1)), "one disc or one box"),
])
def test_lights_that_are_refused(light, why):
    with fibrad.Heat([[0, 0, 0]], 0.5, box=[2, 2, 0], walls={"zmin": -1}) as heat:
        with pytest.raises(fibrad.InputError, match=why):
            heat.shine(fibrad.Light(**light), 0.5, wall_absorptivity=1.0)


def test_a_row_in_contact():
    """Without emission all of the power goes through the contacts to the floor."""
    row = [[0, 0, 1], [0, 0, 3], [0, 0, 5]]
    with fibrad.Heat(row, 1.0, walls={"zmin": 0}) as heat:
        with pytest.raises(fibrad.InputError, match="nothing that it touches"):
            heat.solve(None, 0, power=0, surroundings=300, wall_temperature=400, wall_emissivity=1,
                       contacts=([0], [1], [1.0]))
        powers = heat.solve(None, 0, power=[0, 0, 40.0], surroundings=300, wall_temperature=400, wall_emissivity=1,
                            contacts=([0, 1, "zmin"], [1, 2, 0], [0.5, 0.25, 2.0]))
    assert powers.temperatures == pytest.approx([420, 500, 660], rel=1e-9)
    assert powers.contact_flows == pytest.approx([-40, -40, -40], rel=1e-9)
    assert powers.wall_conducted["zmin"] == pytest.approx(40, rel=1e-9)
    assert powers.conducted.sum() == pytest.approx(-40, rel=1e-9)


def test_a_matrix_of_contacts():
    """A symmetric matrix is a contact for each element above the diagonal."""
    sparse = pytest.importorskip("scipy.sparse")
    matrix = sparse.csr_matrix([[0, 2.0], [2.0, 0]])
    with fibrad.Heat(PAIR, 1.0) as heat:
        by_matrix, by_list = (heat.solve([1000, np.nan], 0.8, power=0, surroundings=300, contacts=contacts)
                              for contacts in (matrix, ([1], [0], [2.0])))
        with pytest.raises(fibrad.InputError, match="not symmetric"):
            heat.solve([1000, np.nan], 0.8, power=0, surroundings=300, contacts=sparse.triu(matrix))
    assert by_matrix.temperatures == pytest.approx(by_list.temperatures, rel=1e-6)
    assert by_matrix.conducted[1] == pytest.approx(2 * (1000 - by_matrix.temperatures[1]), rel=1e-9)


@pytest.mark.parametrize("contacts", [([0], [9], [1.0]), ([0], [1], [-1.0]), ([0], [1], [np.nan]), ([0], ["zmin"], [1.0]),
                                      ([0, 1], [1], [1.0])])
def test_contacts_that_are_refused(contacts):
    with fibrad.Heat(PAIR, 1.0) as heat, pytest.raises(fibrad.InputError, match="contacts"):
        heat.solve(1000, 0.8, surroundings=300, contacts=contacts)


def test_contacts_by_overlaps():
    """A spot conducts 2 k a between spheres, and 4 k a to a wall."""
    first, second, conductance = fibrad.contacts([[0, 0, 0.99], [0, 0, 2.97]], 1.0, conductivity=3, walls={"zmin": 0})
    assert sorted(zip(first, second)) == [(0, 2), (1, 0)]
    assert sorted(conductance) == pytest.approx([2 * 3 * np.sqrt(1 - 0.99**2), 4 * 3 * np.sqrt(1 - 0.99**2)])
    apart = fibrad.contacts([[0, 0, 0], [0, 0, 2.1]], 1.0, conductivity=3)
    assert apart.first.size == 0 and fibrad.contacts(PAIR, 1.0, conductivity=3, gas_conductivity=0.1).first.size == 0
