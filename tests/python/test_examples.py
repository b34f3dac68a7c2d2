# test_examples.py - the examples, and all that docs/embedding.md shows, run. SPDX-License-Identifier: MIT
import dataclasses
import doctest
import os
import pydoc
import re
import runpy
import shutil
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest

import fibrad


@pytest.fixture(name="examples")
def fixture_examples(tree):
    return tree / "host" / "python" / "examples"


def test_docstrings():
    for module in (fibrad, fibrad._bed, fibrad._light):
        found = doctest.testmod(module)
        assert found.attempted and not found.failed


def test_what_is_public_is_documented():
    """Also every field of every class of results and of lights, where `help` finds it."""
    for name in fibrad.__all__:
        what = getattr(fibrad, name)
        assert name == "STEFAN_BOLTZMANN" or what.__doc__
        if not dataclasses.is_dataclass(what):
            continue
        section = what.__doc__.split("    Attributes\n    ----------\n")[1].split("    Examples\n")[0]
        told = {one: text for names, text in re.findall(r"^    ([\w, ]+)\n((?:        .+\n?)+)", section, re.MULTILINE)
                for one in names.split(", ")}
        fields = [field.name for field in dataclasses.fields(what) if not field.name.startswith("_")]
        assert fields and set(told) - {"SUN"} == set(fields), name
        assert all(len(text.split()) > 1 for text in told.values()), name
        assert re.sub(r"\s+", " ", told[fields[0]]).strip() in re.sub(r"[\s|]+", " ", pydoc.plain(pydoc.render_doc(fibrad)))


def test_page(tree, tmp_path, monkeypatch):
    """Python blocks of the page, one after the other, as one reader types them, with a quarter of a bed."""
    page = (tree / "docs" / "embedding.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    assert len(blocks) > 4
    lines = (tree / "tests" / "data" / "mono2000.dump").read_text(encoding="ascii").splitlines()
    lines[9:] = [line for line in lines[9:] if max(map(float, line.split()[2:4])) < 6]
    lines[3] = str(len(lines) - 9)
    (tmp_path / "bed.dump").write_text("\n".join(lines) + "\n", encoding="ascii")
    monkeypatch.chdir(tmp_path)
    names = {}
    for block in blocks:
        exec(compile(block, f"docs/embedding.md: {block.splitlines()[0]}", "exec"), names)


def test_cooling(examples):
    run = subprocess.run([sys.executable, examples / "cooling.py", "5"], capture_output=True, text=True, check=True)
    lost, gained = map(float, re.search(r"lost by the spheres (\S+) J, gained by .* (\S+) J", run.stdout).groups())
    assert lost == gained > 1000


class Cell(np.ndarray):
    """Of the API of OVITO: a matrix of three edges and the origin, and pbc."""
    pbc = (True, True, False)


def ovito_data(small, **more):
    """A stand-in for OVITO's DataCollection: what a modifier function reads and writes of it."""
    particles = {"Position": small.x, "Radius": small.r.astype(np.float32), **more}
    made = {}
    writer = SimpleNamespace(create_property=lambda name, data: made.update({name: np.array(data)}))
    cell = np.hstack([np.diag([12.0, 12.0, 50.0]), np.zeros((3, 1))]).view(Cell)
    return SimpleNamespace(particles=particles, particles_=writer, cell=cell, attributes={}), made


def test_ovito_modifier(small, examples):
    modify = runpy.run_path(str(examples / "ovito_modifier.py"))["modify"]
    data, made = ovito_data(small)
    modify(0, data)
    expected = fibrad.view_factors(small.x, small.r.astype(np.float32), box=(12, 12, 0))
    assert set(made) == {"Escaped", "Seen"} and made["Escaped"].tobytes() == expected.escaped.tobytes()
    assert made["Seen"].sum() == len(expected.data) and 0 < data.attributes["fibrad.error"] < 0.02
    temperature = np.linspace(300, 900, small.n)
    data, made = ovito_data(small, **{"Temperature": temperature, "Particle Identifier": np.arange(small.n)})
    modify(0, data)
    powers = made["Radiative Power"]
    assert powers[-1] < 0 and powers.sum() == pytest.approx(-data.attributes["fibrad.surroundings"])
    data.cell[0, 1] = 1
    with pytest.raises(ValueError, match="right angles"):
        modify(0, data)
    data.cell = None
    modify(0, data)
    del data.particles["Radius"]
    with pytest.raises(ValueError, match="Radius"):
        modify(0, data)


class Bodies(dict):
    """Bodies by their ids, of which a loop gives the bodies, as O.bodies of YADE."""

    def __iter__(self):
        return iter(list(self.values()))


def test_yade_runner_with_a_stand_in(small, examples):
    """Bodies with the attributes that YADE's have: spheres, a clump of two, a wall, a facet."""
    class Shape(SimpleNamespace):
        pass

    class Sphere(Shape):
        pass

    class Wall(Shape):
        pass

    class Facet(Shape):
        pass

    def body(number, shape, pos=(0.0, 0.0, 0.0), mass=0.01, clump=-1):
        state = SimpleNamespace(pos=np.array(pos), mass=mass, ori=np.eye(1)[0, 0])
        return SimpleNamespace(id=number, shape=shape, state=state, isClumpMember=clump not in (-1, number),
                               isClump=clump == number, clumpId=clump)

    floor, joined = body(1, Wall(axis=2)), body(2, None, mass=0.02, clump=2)
    facet = body(4, Facet(vertices=[np.array(v) for v in ((2.0, 2, 9), (4, 2, 9), (2, 4, 9))]))
    spheres = [body(3 * i + 6, Sphere(radius=small.r[i]), small.x[i], clump=2 if i < 2 else -1) for i in range(small.n)]
    scene = SimpleNamespace(bodies=Bodies((b.id, b) for b in (floor, joined, facet, *spheres)), periodic=True, time=0.0,
                            cell=SimpleNamespace(size=(12.0, 12.0, 0.0)))
    names = runpy.run_path(str(examples / "yade_radiation.py"), {"O": scene, "Sphere": Sphere, "Wall": Wall, "Facet": Facet},
                           "yade_radiation")
    radiate = names["radiate"]
    state = radiate.__globals__
    radiate()
    assert set(state["temperature"].values()) == {300.0} and state["bed"].n == small.n
    assert set(state["temperature"]) == {2, *(b.id for b in spheres[2:])}
    assert not state["given"]
    first, scene.time = state["bed"], 1e-6
    radiate()
    stored = sum(scene.bodies[i].state.mass * 800 * (t - 300) for i, t in state["temperature"].items())
    assert state["absorbed"] == pytest.approx(stored, rel=1e-6) and state["absorbed"] > 0 and state["bed"] is first
    del scene.bodies[spheres[-1].id]
    radiate()
    assert state["bed"].n == small.n - 1
    for b in spheres[:-1]:  # with a ThermalEngine; the clump has 900 K
        b.state.temp, b.state.stepFlux = 900.0 if b.clumpId == 2 else 300.0, 0.0
    kept, state["absorbed"], scene.dt = dict(state["temperature"]), 0.0, 1e-3
    radiate()
    names["hand_over"]()
    flux = np.array([b.state.stepFlux for b in spheres[:-1]])
    powers = state["bed"].solve([b.state.temp for b in spheres[:-1]], 0.8, surroundings=300.0)
    assert flux[:2].sum() == pytest.approx(powers.spheres[:2].sum()) and flux[0] == pytest.approx(
        flux[1] * (small.r[0] / small.r[1]) ** 3) and flux[0] < 0
    assert flux[2:] == pytest.approx(powers.spheres[2:], rel=1e-6, abs=1e-9 * abs(flux[0]))
    assert state["absorbed"] == pytest.approx(1e-3 * flux.sum()) and state["temperature"] == kept


def yade(script, folder):
    if not shutil.which("yade"):
        pytest.skip("no YADE (Debian: yade); its stand-in is tested")
    places = os.path.dirname(os.path.dirname(fibrad.__file__))
    return subprocess.run(["yade", "-n", "-x", script], cwd=folder, check=False, text=True,
                          env={**os.environ, "PYTHONPATH": places}, capture_output=True)


def test_yade_thermal_engine(tree, examples, tmp_path):
    """The pair of docs/beside.md: the heat that its spheres lose is what was handed over, and they conduct to each other."""
    page = (tree / "docs" / "beside.md").read_text(encoding="utf-8")
    script, says = re.search(r"^File `pair.py`:\n```python\n(.*?)^```\n.*?^```text\n\.\.\.\n(.*?)\n```", page,
                             re.MULTILINE | re.DOTALL).groups()
    shutil.copy(examples / "yade_radiation.py", tmp_path)
    (tmp_path / "pair.py").write_text(script + """
heat = sum(b.state.mass * 710 * (b.state.temp - start) for b, start in ((hot, 1000), (cold, 800)))
print("stored", heat, "absorbed", radiate.__globals__["absorbed"])
""", encoding="utf-8")
    run = yade("pair.py", tmp_path)
    found = re.search(r"stored (\S+) absorbed (\S+)", run.stdout)
    assert found and says in run.stdout.splitlines(), run.stdout + run.stderr
    stored, absorbed = map(float, found.groups())
    assert absorbed < -0.05 and stored == pytest.approx(absorbed, rel=1e-9)
    hot, cold = map(float, re.findall(r"\S+(?= K)", says))
    assert hot < 1000 and cold > 800


def test_yade_runner(examples, tmp_path):
    run = yade(examples / "yade_radiation.py", tmp_path)
    found = re.search(r"52 spheres and clumps, (\S+) to (\S+) K, absorbed (\S+) J, stored (\S+) J", run.stdout)
    assert found, run.stdout + run.stderr
    coldest, hottest, absorbed, stored = map(float, found.groups())
    assert 300 < coldest < hottest < 1000 and absorbed == pytest.approx(stored, rel=1e-6)
