# test_factors.py - factors of beds from Python against independent truths. SPDX-License-Identifier: MIT
import csv
import subprocess

import numpy as np
import pytest
import scipy.sparse
from conftest import CUBE, same

import fibrad


def sums(factors):
    return factors.matrix.sum(axis=1).A1 + factors.walls.sum(axis=1) + factors.escaped + factors.beyond


def test_two_spheres_are_exact(tree):
    """Against a file of values by another program (tests/data)."""
    with open(tree / "tests" / "data" / "pair_exact.csv", encoding="ascii") as lines:
        rows = [{name: float(text) for name, text in row.items()} for row in csv.DictReader(lines)]
    pairs = [row for row in rows if row["r1"] == 1 and row["r2"] in (1, 2) and 1e-6 < row["gap"] < 10]
    assert len(pairs) > 3
    for pair in pairs:
        x = [[0, 0, 0], [pair["r1"] + pair["r2"] + pair["gap"], 0, 0]]
        factors = fibrad.view_factors(x, [pair["r1"], pair["r2"]], directions=10000)
        assert factors.matrix[0, 1] == pytest.approx(pair["F12"], abs=1e-5)


def test_closed_and_reciprocal(small):
    factors = fibrad.view_factors(small.x, small.r, directions=100)
    exchanged = scipy.sparse.diags(small.r**2) @ factors.matrix
    assert abs(exchanged - exchanged.T).max() < 1e-15
    assert sums(factors) == pytest.approx(1, abs=1e-13)
    assert factors.closure_error < 1e-12 and factors.reciprocity_error < 1e-15
    assert factors.directions == 100 and factors.n == small.n and factors.shape == (small.n, small.n)
    assert 0 < factors.error.max() < 0.01 and factors.seconds > 0 and factors.threads > 0
    columns, row = factors.row(7)
    assert np.array_equal(columns, factors.matrix[7].indices) and np.array_equal(row, factors.matrix[7].data)
    assert (np.diff(columns) > 0).all()


def test_the_estimated_error_is_kept(small):
    factors = fibrad.view_factors(small.x, small.r, tolerance=0.002)
    fine = fibrad.view_factors(small.x, small.r, directions=8000)
    difference = factors.matrix - fine.matrix
    true = np.sqrt(difference.multiply(difference).sum(axis=1)).A1
    assert factors.error.max() <= 0.002 and true.max() < 0.002


@pytest.mark.parametrize("bed", ["mono2000.dump", "monoper2000.dump"])
def test_bits_are_those_of_the_program(bed, tree, program, tmp_path):
    path = tree / "tests" / "data" / bed
    subprocess.run([program, "factors", path, "--directions", "60", "-o", tmp_path / "F.npz"], check=True,
                   capture_output=True)
    columns = np.loadtxt(path, skiprows=9)
    columns = columns[np.argsort(columns[:, 0])]
    factors = fibrad.view_factors(columns[:, 2:5], columns[:, 5], directions=60,
                                  box=(12, 12, 0) if "per" in bed else None)
    matrix = scipy.sparse.load_npz(tmp_path / "F.npz")
    assert matrix.nnz > 10000 and same(factors, matrix)


def test_bits_of_exchange_are_those_of_the_program(small, program, tmp_path):
    table = np.column_stack([small.x, small.r])
    np.savetxt(tmp_path / "bed.csv", table, fmt="%.17g", delimiter=",", header="x,y,z,r", comments="")
    subprocess.run([program, "factors", tmp_path / "bed.csv", "--emissivity", "0.6", "--rays", "100", "-o",
                    tmp_path / "D.npz"], check=True, capture_output=True)
    factors = fibrad.exchange_factors(small.x, small.r, 0.6, paths=100)
    assert same(factors, scipy.sparse.load_npz(tmp_path / "D.npz"))


def test_bits_with_ids_are_those_of_the_program(small, program, tmp_path):
    """Ids that are no positions, in a file without order."""
    ids = 7 * np.arange(small.n) + 5
    table = np.column_stack([ids, small.x, small.r])[np.random.default_rng(1).permutation(small.n)]
    path = tmp_path / "bed.csv"
    np.savetxt(path, table, fmt="%.17g", delimiter=",", header="id,x,y,z,r", comments="")
    bed = fibrad.read(path)
    run = {"check": True, "capture_output": True}
    for method in (["--method", "cast", "--rays", "100"], ["--method", "mc", "--rays", "100"]):
        subprocess.run([program, "factors", path, *method, "-o", tmp_path / "F.npz"], **run)
        factors = fibrad.view_factors(bed.x, bed.r, method=method[1], rays=100, ids=bed.ids)
        assert same(factors, scipy.sparse.load_npz(tmp_path / "F.npz"))
    subprocess.run([program, "factors", path, "--emissivity", "0.6", "--rays", "100", "-o", tmp_path / "D.npz"], **run)
    factors = fibrad.exchange_factors(bed.x, bed.r, 0.6, paths=100, ids=bed.ids)
    assert same(factors, scipy.sparse.load_npz(tmp_path / "D.npz"))
    kelvins = 600 + 40 * bed.x[:, 0]
    np.savetxt(path, np.column_stack([ids, bed.x, bed.r, kelvins]), fmt="%.17g", delimiter=",", header="id,x,y,z,r,T",
               comments="")
    subprocess.run([program, "heat", path, "--length-unit", "m", "--emissivity", "0.6", "--temperature", "T", "--ambient", "300",
                    "--directions", "30", "-o", tmp_path / "q.csv"], **run)
    with fibrad.Bed(bed.x, bed.r, ids=bed.ids) as heat:
        heat.beams(directions=30)
        powers = heat.solve(kelvins, 0.6, surroundings=300.0)
    found = np.loadtxt(tmp_path / "q.csv", delimiter=",", skiprows=1, usecols=2)
    assert found[:small.n].tobytes() == powers.spheres.tobytes()


def test_rows_count_from_both_ends(small):
    factors = fibrad.view_factors(small.x, small.r, directions=20)
    for back in (-1, -2, -small.n):
        (columns, row), (same_columns, same_row) = factors.row(back), factors.row(small.n + back)
        assert columns.size and (columns == same_columns).all() and (row == same_row).all()
    for wrong in (small.n, -small.n - 1):
        with pytest.raises(IndexError, match=f"there is no row {wrong}; there are {small.n}"):
            factors.row(wrong)
    with pytest.raises(TypeError):
        factors.row(1.0)


def test_scaling_by_a_power_of_two_changes_no_bit(small):
    assert same(fibrad.view_factors(small.x, small.r, directions=50),
                fibrad.view_factors(small.x * 1024, small.r * 1024, directions=50))


def test_rotated_beds_have_the_same_factors(small):
    turn, _ = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))
    one, other = (fibrad.view_factors(x, small.r) for x in (small.x, small.x @ turn.T))
    difference = one.matrix - other.matrix
    distance = np.sqrt(difference.multiply(difference).sum(axis=1)).A1
    assert 0 < distance.max() < one.error.max() + other.error.max()


def test_the_order_of_spheres_changes_no_bit_of_rows(small):
    ids = np.arange(small.n) + 17
    order = np.random.default_rng(2).permutation(small.n)
    rows = fibrad.view_factors(small.x, small.r, directions=50, raw=True, ids=ids).matrix[order][:, order]
    rows.sort_indices()
    assert same(fibrad.view_factors(small.x[order], small.r[order], directions=50, raw=True, ids=ids[order]), rows)


def test_threads_change_no_bit(small):
    one = fibrad.view_factors(small.x, small.r, directions=50, threads=1)
    three = fibrad.view_factors(small.x, small.r, directions=50, threads=3)
    assert same(one, three) and (one.threads, three.threads) == (1, 3)


@pytest.mark.parametrize("kind", ["fortran", "slice", "columns", "reversed", "records", "shifted", "list"])
def test_any_layout(small, kind):
    """Strided arrays of float64 are taken as they are; what the library's strides do not allow is copied."""
    x, r = small.x, small.r
    table = np.column_stack([np.zeros(small.n), x, r, r])
    record = np.zeros(small.n, [("tag", "u1"), ("x", "f8", 3), ("r", "f8")])
    record["x"], record["r"] = x, r
    given = {"fortran": (np.asfortranarray(x), r), "slice": (np.repeat(x, 3, 0)[::3], np.repeat(r, 2)[::2]),
             "columns": (table[:, 1:4], table[:, 4]), "reversed": (x[::-1].copy()[::-1], r[::-1].copy()[::-1]),
             "records": (record["x"], record["r"]), "shifted": (table[:, 3:0:-1][:, ::-1], table[:, 5]),
             "list": (x.tolist(), r.tolist())}[kind]
    assert same(fibrad.view_factors(*given, directions=20), fibrad.view_factors(x, r, directions=20))
    packing = fibrad._scene.Packing(*given)
    assert np.may_share_memory(packing.x, given[0]) == (kind in ("fortran", "slice", "columns", "shifted"))


def test_any_address(small):
    """Arrays at addresses that are no multiple of 8 are copied, those in one piece, too."""
    def off(array):
        moved = np.frombuffer(b"x" + np.ascontiguousarray(array).tobytes(), array.dtype, offset=1).reshape(array.shape)
        assert not moved.flags.aligned
        return moved
    expected = fibrad.view_factors(small.x, small.r, ids=np.arange(small.n), directions=20)
    assert same(fibrad.view_factors(off(small.x), off(small.r), ids=off(np.arange(small.n, dtype="u8")), directions=20),
                expected)
    with fibrad.Bed(off(small.x), off(small.r)) as heat:
        heat.beams(directions=20, patches=24)
        t = np.linspace(300, 900, small.n)
        moved, plain = (heat.solve(kelvins, 0.5, surroundings=300.0) for kelvins in (off(t), t))
    with fibrad.Bed(small.x, small.r) as heat:
        heat.beams(directions=20, patches=24)
        given = heat.solve(t, 0.5, surroundings=300.0)
    assert (given.spheres == moved.spheres).all()
    np.testing.assert_allclose(plain.spheres, given.spheres, atol=1e-6 * abs(given.spheres).max())


def test_other_types_are_converted():
    x = [[0, 0, 0], [0, 0, 3]]
    expected = fibrad.view_factors(x, 1.0)
    for kind in ("f4", "i2", "u8", ">f8", object, bool):
        assert same(expected, fibrad.view_factors(x, np.ones(2, kind)))
        if kind is not bool:
            assert same(expected, fibrad.view_factors(np.array(x, kind), 1))


def test_rows_wanted(small):
    rows = fibrad.view_factors(small.x, small.r, directions=50, raw=True)
    wanted = fibrad.view_factors(small.x, small.r, directions=50, wanted=[3, 50])
    mask = np.zeros(small.n, bool)
    mask[[3, 50]] = True
    assert same(wanted, fibrad.view_factors(small.x, small.r, directions=50, wanted=mask))
    assert set(np.flatnonzero(np.diff(wanted.indptr))) == {3, 50}
    for i in (3, 50):
        assert wanted.row(i)[1].tobytes() == rows.row(i)[1].tobytes()
    assert np.isnan(wanted.reciprocity_error)
    assert not len(fibrad.view_factors(small.x, small.r, wanted=[]).data)


def test_methods_agree(small):
    exact = fibrad.view_factors(small.x, small.r, directions=400).matrix
    for options in ({"directions": 64}, {"method": "cast", "rays": 5000},
                    {"method": "mc", "rays": 5000, "seed": 3}):
        other = fibrad.view_factors(small.x, small.r, **options)
        assert abs(other.matrix - exact).max() < 0.03, options
    assert same(other, fibrad.view_factors(small.x, small.r, method="mc", rays=5000, seed=3))
    assert not same(other, fibrad.view_factors(small.x, small.r, method="mc", rays=5000, seed=4))


def test_cutoff_and_drop(small):
    near = fibrad.view_factors(small.x, small.r, cutoff=1.5)
    assert near.beyond.max() > 0.1 and sums(near) == pytest.approx(1, abs=1e-13)
    dropped = fibrad.view_factors(small.x, small.r, drop=0.01)
    assert len(dropped.data) < 0.9 * len(fibrad.view_factors(small.x, small.r).data) and sums(dropped) == pytest.approx(1, abs=1e-12)


def test_scratch(small, tmp_path):
    kept = fibrad.exchange_factors(small.x, small.r, 0.5, paths=20, directions=8)
    filed = fibrad.exchange_factors(small.x, small.r, 0.5, paths=20, directions=8, scratch=tmp_path)
    assert same(kept, filed) and not list(tmp_path.iterdir())
    assert same(fibrad.view_factors(small.x, small.r), fibrad.view_factors(small.x, small.r, scratch=str(tmp_path)))


def test_walls():
    """An infinite plane takes one half of what a sphere sends, a side of a cube about it a sixth."""
    plane = fibrad.view_factors([[0, 0, 3]], 1, walls="zmin:at=0")
    assert plane.wall("zmin") == pytest.approx(0.5, abs=1e-12) and np.isinf(plane.wall_area[0])
    cube = fibrad.view_factors([[0, 0, 0]], 1, walls=CUBE, directions=10000)
    assert cube.walls == pytest.approx(1 / 6, abs=1e-3) and cube.walls.sum() == pytest.approx(1, abs=1e-14)
    assert cube.wall_area == pytest.approx(100) and cube.wall_names == ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")
    turned = fibrad.view_factors([[0, 0, 1]], 1, walls=list(reversed(CUBE.split(","))))
    assert turned.wall("zmax") == pytest.approx(turned.walls[:, 0]) and turned.wall("zmax") > turned.wall("zmin")
    for cylinder, axis, at in (("cylinder", "z", (4, 5)), ("xcylinder", "x", (5, 6)), ("ycylinder", "y", (4, 6))):
        middle = {"x": 4, "y": 5, "z": 6}
        low, high = f"{axis}min", f"{axis}max"
        walls = f"{cylinder}:{at[0]},{at[1]},2,{low}:at={middle[axis] - 2},{high}:at={middle[axis] + 2}"
        tube = fibrad.view_factors([[4, 5, 6]], 1, walls=walls)
        assert tube.wall_area == pytest.approx([16 * np.pi, 4 * np.pi, 4 * np.pi])
        # from the centre of a sphere the discs are seen under half angles of 45 degrees
        assert tube.wall(high) == pytest.approx((1 - np.sqrt(0.5)) / 2, abs=2e-6)
        assert tube.wall_names == (cylinder, low, high)


def test_rows_of_walls():
    """They add up to 1 with what goes to the spheres, are reciprocal, and those of an empty cube are in every table."""
    cube = fibrad.view_factors(np.zeros((0, 3)), [], walls=CUBE, directions=256)
    assert cube.wall_wall[:2, 2:] == pytest.approx(0.2000438, abs=3e-3) and cube.wall_escaped == pytest.approx(0)
    x, r, e = [[1, 2, 0], [-2, 0, 0]], np.array([2, 1]), np.array([0.5, 0.9])
    shares = [0.3, 0.5, 0.7, 0.9, 1.0, 0.0]
    grey = [f"{word}:emissivity={share}" for word, share in zip(CUBE.split(","), shares)]
    for found, emitted, walls_emit in (
            (fibrad.view_factors(x, r, walls=CUBE), 4 * np.pi * r**2, np.full(6, 100)),
            (fibrad.exchange_factors(x, r, e, walls=grey), 4 * np.pi * r**2 * e,
             100 * np.array(shares))):
        with np.errstate(invalid="ignore"):
            sums = found.wall_wall.sum(axis=1) + found.wall_escaped + emitted @ found.walls / walls_emit
        assert np.nan_to_num(sums, nan=1) == pytest.approx(1, abs=1e-12)
        exchanged = walls_emit[:, None] * found.wall_wall
        assert exchanged == pytest.approx(exchanged.T, rel=1e-15) and 0 < found.wall_error.max() < 0.02
        assert 0 < found.wall_correction < 0.05 and found.wall_closure < 1e-9
    assert np.all(found.wall_wall[5] == 0) and np.all(found.wall_wall[:, 5] == 0)
    assert np.isnan(fibrad.view_factors([[0, 0, 3]], 1, walls="zmin:at=0").wall_wall).all()
    for less in ({"cutoff": 3}, {"wanted": [0]}, {"walls": None}):
        assert fibrad.view_factors(x, r, **{"walls": CUBE, **less}).wall_wall is None


def test_periodic_spheres_see_themselves():
    factors = fibrad.view_factors([[0.5, 0.5, 0.5]], 0.5, box=(1, 1, 1))
    assert factors.matrix[0, 0] == pytest.approx(1, abs=1e-2) and sums(factors) == pytest.approx(1, abs=1e-13)


def test_no_spheres():
    factors = fibrad.view_factors(np.zeros((0, 3)), [])
    assert factors.n == 0 and factors.matrix.shape == (0, 0) and factors.indptr.tolist() == [0]
    assert fibrad.exchange_factors(np.zeros((0, 3)), [], []).n == 0


def test_results_outlive_what_they_were_made_of(small):
    """Arrays keep the library's memory, and only they do."""
    data = fibrad.view_factors(small.x, small.r, directions=50).data
    others = [fibrad.view_factors(small.x, small.r, directions=51) for _ in range(5)]
    assert data.tobytes() == fibrad.view_factors(small.x, small.r, directions=50).data.tobytes()
    matrix = others[0].matrix
    assert np.shares_memory(matrix.data, others[0].data) and np.shares_memory(matrix.indices, others[0].indices)
    data = others[0].data
    data *= 2  # they may be written
    del others
    assert matrix.sum() > 0


def test_black_spheres_absorb_what_they_see(small):
    exchange = fibrad.exchange_factors(small.x, small.r, 1.0, directions=233)
    seen = fibrad.view_factors(small.x, small.r, directions=233)
    assert abs(exchange.matrix - seen.matrix).max() < seen.error.max() and sums(exchange) == pytest.approx(1, abs=1e-12)


def test_grey_spheres(small):
    """Reciprocal with emissivities, closed; between mirrors two spheres of one kind share what each emits."""
    e = np.linspace(0.3, 0.9, small.n)
    exchange = fibrad.exchange_factors(small.x, small.r, e)
    area = scipy.sparse.diags(small.r**2 * e) @ exchange.matrix
    assert abs(area - area.T).max() < 1e-15 and sums(exchange) == pytest.approx(1, abs=1e-12) and exchange.rays > 0
    mirrors = fibrad.exchange_factors([[2, 0, 0], [-2, 0, 0]], 1, 0.5, walls=CUBE.replace("5", "5:emissivity=0"), paths=20000)
    assert mirrors.matrix.sum(axis=1).A1 == pytest.approx(1, abs=1e-3) and mirrors.walls.max() == 0
    named = fibrad.exchange_factors([[0, 0, 0]], 1, 0.5, walls=[CUBE, "zmin:at=-5:emissivity=0"])
    assert named.wall("zmin") == 0 and named.wall("zmax") > 0.1


def test_exchange_between_nodes(small):
    """Spheres that conduct have the powers of patches; D is reciprocal with the emissivities of nodes."""
    n, relative = small.n, np.geomspace(0.2, 5, small.n)
    e, kelvins = np.linspace(0.5, 0.9, n), 900 + 40 * small.x[:, 2]
    found = fibrad.exchange_factors(small.x, small.r, e, k_star=relative, directions=400, paths=6000)
    area, node = 4 * np.pi * small.r**2, found.node_emissivity
    assert ((0 < node) & (node < e)).all() and sums(found) == pytest.approx(1, abs=1e-12)
    weighted = scipy.sparse.diags(area * node) @ found.matrix
    assert abs(weighted - weighted.T).max() < 1e-12 * area.max()
    flow = (weighted - scipy.sparse.diags(area * node)).toarray()  # q = flow N + sky, N = emission - resistance q
    sky = area * node * found.escaped * fibrad.STEFAN_BOLTZMANN * 800.0**4
    emission, resistance = fibrad.STEFAN_BOLTZMANN * kelvins**4, (1 / node - 1 / e) / area
    power = np.linalg.solve(np.eye(n) + flow * resistance, flow @ emission + sky)
    with fibrad.Bed(small.x, small.r) as heat:
        heat.beams(directions=500)
        solid = relative * 8 * small.r * fibrad.STEFAN_BOLTZMANN * kelvins**3
        truth = heat.solve(kelvins, e, surroundings=800.0, conductivity=solid).spheres
        isothermal = heat.solve(kelvins, e, surroundings=800.0).spheres
    off, apart = np.linalg.norm(power - truth), np.linalg.norm(isothermal - truth)
    assert off < 0.02 * np.linalg.norm(truth) and off < 0.15 * apart, (off, apart, np.linalg.norm(truth))
    assert fibrad.exchange_factors(small.x, small.r, e).node_emissivity is None
    for wrong in (0.0, -1.0, np.nan):
        with pytest.raises(fibrad.InputError, match="k_star of sphere 0"):
            fibrad.exchange_factors([[0, 0, 0]], 0.5, 1.0, k_star=wrong)


@pytest.mark.parametrize("x, r, text, spheres", [
    ([0, 0, 0], 1, r"x has the shape \(3,\)", ()),
    ([[0, 0]], 1, r"\(1, 2\)", ()),
    ([[0, 0, 0]], [1, 1], r"r has the shape \(2,\); a radius or 1", ()),
    ([[0, 0, 0], [0, np.nan, 3]], 1, r"sphere of id 8 at \[0.0, nan, 3.0\]", (1,)),
    ([[0, 0, 0], [0, 0, 3]], [1, 0], "radius 0.0", (1,)),
    ([[0, 0, 0], [0, 0, 3]], [1, np.inf], "id 8", (1,)),
    ([[0, 0, 0], [0, 0, 0]], 1, "same centre.*id 5.*id 8", (0, 1)),
    ([[0, 0, 0], [0, 0, 3]], ["a", "b"], "r must be numbers", ()),
    ([[0, 0, 0], [0, 0, 3j]], 1, "x must be numbers, not complex", ()),
    ([[0, 0, 0], [0, 0, None]], 1, "x must be numbers|id 8", None),
    (np.ma.masked_less([[0, 0, 0], [0, 0, -3]], -1), 1, "x has masked elements", ()),
])
def test_beds_that_cannot_be(x, r, text, spheres):
    with pytest.raises(ValueError, match=text) as caught:
        fibrad.view_factors(x, r, ids=[5, 8][:max(1, len(x) if np.ndim(x) == 2 else 1)])
    assert isinstance(caught.value, fibrad.InputError) and isinstance(caught.value, fibrad.Error)
    assert spheres is None or caught.value.spheres == spheres
    assert caught.value.status < 0


@pytest.mark.parametrize("options, text", [
    ({"directions": 7}, r"directions = 7 is not in \[8, 65536\]"), ({"rays": 5}, "rays: not of the method 'beam'"),
    ({"tolerance": -1}, "tolerance"), ({"threads": -1}, "threads"), ({"threads": 2000}, "threads"),
    ({"cutoff": np.nan}, "cutoff"), ({"drop": 2}, "drop"), ({"scratch": "/no/folder"}, "is no folder"), ({"seed": -1, "method": "mc"}, "seed"),
    ({"method": "magic"}, "no method 'magic'; there are beam"), ({"method": "mc", "tolerance": .1}, "tolerance: not of"),
    ({"k_star": 1}, "emissivity is missing"), ({"emissivity": 1, "method": "mc"}, "method: not of exchange"), ({"box": [1, 2]}, "three lengths"),
    ({"box": [-1, 2, 3]}, "three lengths"), ({"box": [0.1, 0, 0]}, "smaller than a sphere's radius"),
    ({"wanted": [2]}, r"positions \[0, 2\)"), ({"wanted": [-1]}, "positions"), ({"wanted": [True]}, "one element for each"),
    ({"wanted": [0.5]}, "positions"), ({"ids": [1, 1]}, "two spheres have the id 1"), ({"ids": [1]}, "2 are wanted"),
    ({"ids": [-1, 1]}, "whole numbers from 0"), ({"ids": [0.5, 1]}, "whole numbers from 0"),
])
def test_options_that_cannot_be(options, text):
    with pytest.raises(fibrad.InputError, match=text):
        fibrad.view_factors([[0, 0, 0], [0, 0, 3]], 1, **options)


def test_options_of_the_wrong_type():
    for options in ({"directions": 50.5}, {"threads": "two"}, {"progress": 5}):
        with pytest.raises(TypeError, match=next(iter(options))):
            fibrad.view_factors([[0, 0, 0]], 1, **options)


def test_emissivities_that_cannot_be():
    x = [[0, 0, 0], [0, 0, 3]]
    with pytest.raises(fibrad.InputError, match="emissivity of sphere of id 9 is 1.5") as caught:
        fibrad.exchange_factors(x, 1, [0.5, 1.5], ids=[4, 9])
    assert caught.value.spheres == (1,)
    with pytest.raises(fibrad.InputError, match="emissivity has the shape"):
        fibrad.exchange_factors(x, 1, [0.5])


def test_more_than_the_library_can_do_is_said():
    with pytest.warns(UserWarning, match="overlap by 0.1 of a radius"):
        fibrad.view_factors([[0, 0, 0], [0, 0, 1.9]], 1)
    with pytest.warns(UserWarning, match="above the tolerance of 1e-09"):
        fibrad.view_factors([[0, 0, 0], [0, 0, 3], [1.2, 0, 6]], 1, tolerance=1e-9)  # a pair with something in between


def test_clumps_are_bodies():
    """A dumbbell, alone and beside a sphere, against closed forms."""
    x, r, clump = [[0, 0, 0], [1, 0, 0], [0.5, 2.2, 0]], 1.0, [4, 4, 0]
    factors = fibrad.view_factors(x, r, clump=clump)
    assert factors.n == 2 and factors.body.tolist() == [0, 0, 1] and factors.ids is None
    assert factors.area == pytest.approx([6 * np.pi, 4 * np.pi], rel=1e-12)
    assert factors.matrix[0, 0] == pytest.approx(0.0107708, abs=1e-6) and sums(factors) == pytest.approx(1, abs=1e-13)
    assert factors.area[0] * factors.matrix[0, 1] == pytest.approx(factors.area[1] * factors.matrix[1, 0], rel=1e-14)
    with pytest.warns(UserWarning, match="do not touch"):
        fibrad.view_factors(x, 0.4, clump=[1, 1, 0])
    with pytest.raises(fibrad.InputError, match="centre of one lies inside"):
        fibrad.view_factors(x, [1, 1.5, 1])
    with pytest.raises(fibrad.InputError, match="exchange factors of clumps"):
        fibrad.exchange_factors(x, r, 0.5, clump=clump)
    with pytest.raises(fibrad.InputError, match="touches its own image"):
        fibrad.view_factors(x, r, clump=clump, box=[2.9, 0, 0])
    for wrong in ([1, 2], [0.5, 1, 1], [-1, 1, 1]):
        with pytest.raises(fibrad.InputError, match="clump"):
            fibrad.view_factors(x, r, clump=wrong)
