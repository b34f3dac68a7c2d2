# test_files.py - beds and meshes from files, matrices to files. SPDX-License-Identifier: MIT
import errno
import gzip
import subprocess

import numpy as np
import pytest

import fibrad

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float) * 4 - 2
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def write_cube(path, turned=()):
    """An STL file of 12 triangles whose fronts are outside, but for those turned."""
    lines = ["solid a cube"]
    for f, (a, b, c, d) in enumerate(FACES):
        for corners in ((a, b, c), (a, c, d)):
            corners = corners[::-1] if f in turned else corners
            lines += ["facet", "outer loop", *(f"vertex {x} {y} {z}" for x, y, z in CUBE[list(corners)]), "endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid", ""]))
    return path


def test_frames(mono, tmp_path):
    bed = fibrad.read(mono.path, columns=["v_T", "type"])
    assert (bed.x == mono.x).all() and (bed.r == mono.r).all() and (bed.ids == mono.ids).all()
    assert bed.unit is None and bed.frame == 0 and (bed.box == 0).all() and bed.high.tolist() == [12, 12, 50]
    assert bed.columns["v_T"].shape == (2000,) and (bed.columns["type"] == 1).all()
    text = mono.path.read_text()
    path = tmp_path / "two.dump.gz"
    path.write_bytes(gzip.compress((text + text.replace("0.5 ", "0.25 ")).encode()))
    assert fibrad.read(path).frame == 1 and fibrad.read(path, 0).r[0] == 0.5 and fibrad.read(path, 1).r[0] == 0.25
    with pytest.raises(fibrad.InputError, match="there is no frame 2; the last is 1"):
        fibrad.read(path, 2)
    table = tmp_path / "a.csv"
    table.write_text("x [mm],y [mm],z [mm],T [C]\n1,2,3,20\n")
    bed = fibrad.read(table, radius=0.5, columns=["T [C]"])
    assert bed.unit == "mm" and bed.ids is None and bed.x.tolist() == [[1, 2, 3]] and bed.r.tolist() == [0.5]


def test_refusals(tmp_path):
    with pytest.raises(fibrad.Error, match="No such file"):
        fibrad.read(tmp_path / "no.dump")
    table = tmp_path / "a.csv"
    table.write_text("x,y,z,r\n1,2,3,0\n")
    with pytest.raises(fibrad.InputError, match=r"a\.csv:2: the radius is 0"):
        fibrad.read(table)
    with pytest.raises(fibrad.InputError, match="no column T; there are x, y, z, r"):
        fibrad.read(table, columns="T")
    with pytest.raises(fibrad.InputError, match="sides = 'inner'"):
        fibrad.Mesh.from_stl(write_cube(tmp_path / "cube.stl"), [[0, 0, 0]], 1.0, sides="inner")


def test_columns_of_other_names(tmp_path):
    table = tmp_path / "a.csv"
    table.write_text("p_x [mm],p_y [mm],p_z [mm],diameters [mm],power [W],material,phase\n"
                     "1,2,3,1,20,steel,1\n4,5,6,2,30,glass,1\n7,8,9,4,40,steel,2\n")
    names = {"x": "p_x", "y": "p_y", "z": "p_z", "d": "diameters", "q": "power"}
    bed = fibrad.read(table, names=names, columns=["q", "power", "power [W]", "phase"])
    assert bed.unit == "mm" and bed.r.tolist() == [0.5, 1, 2] and bed.x[2].tolist() == [7, 8, 9]
    assert all(bed.columns[name].tolist() == [20, 30, 40] for name in ("q", "power", "power [W]"))
    assert fibrad.read(table, names=names, only={"material": "steel"}).r.tolist() == [0.5, 2]
    assert fibrad.read(table, names=names, only={"material": "steel"}, skip={"phase": 1.0}).r.tolist() == [2]
    bare = tmp_path / "b.txt"
    bare.write_text("1 2 3 1\n4 5 6 2\n")
    assert fibrad.read(bare, names={"x": "1 [cm]", "y": "2 [cm]", "z": "3 [cm]"}, radius=1).unit == "cm"
    assert fibrad.read(bare, names={"x": 1, "y": 2, "z": 3, "d": 4}).r.tolist() == [0.5, 1]
    with pytest.raises(fibrad.InputError, match="--only and --skip leave no spheres"):
        fibrad.read(table, names=names, only={"material": "stone"})
    with pytest.raises(fibrad.InputError, match="no column size; there are p_x"):
        fibrad.read(table, names={**names, "d": "size"})
    for wrong in ({"names": {"r": 1, "d": 2}}, {"names": {"r": 1}, "radius": 1.0}, {"names": ["x"]}, {"only": "type"},
                  {"columns": 5}, {"frame": 1 << 63}, {"columns": ["a\0b"]}):
        with pytest.raises(fibrad.InputError, match=next(iter(wrong))):
            fibrad.read(bare, **wrong)


def test_files_that_are_not_there(tmp_path):
    with pytest.raises(FileNotFoundError, match="no.dump: No such file") as caught:
        fibrad.read(tmp_path / "no.dump")
    assert isinstance(caught.value, fibrad.FileError) and caught.value.errno == errno.ENOENT
    with pytest.raises(FileNotFoundError, match="no.stl: No such file"):
        fibrad.Mesh.from_stl(tmp_path / "no.stl", [[0, 0, 0]], 1.0)
    with pytest.raises(fibrad.FileError, match="Is a directory") as caught:
        fibrad.read(tmp_path)
    assert not isinstance(caught.value, FileNotFoundError) and caught.value.errno == errno.EISDIR
    whole = tmp_path / "bed.pvtu"
    whole.write_text("<VTKFile type='PUnstructuredGrid'><Piece Source='no.vtu'/></VTKFile>")
    with pytest.raises(FileNotFoundError, match="no.vtu"):
        fibrad.read(whole)
    with pytest.raises(fibrad.InputError, match="zero byte"):
        fibrad.read("a\0b")


@pytest.mark.parametrize("turned", [(), (0, 1, 2, 3, 4, 5), (1, 4)])
def test_sides_as_the_program_has_them(tmp_path, program, turned):
    """However the file winds its triangles, the wall is where the sphere is: all that it emits arrives there."""
    path, bed = write_cube(tmp_path / "cube.stl", turned), tmp_path / "bed.csv"
    inner = fibrad.Mesh.from_stl(path, [[0, 0, 0]], 1.0)
    factors = fibrad.view_factors([[0, 0, 0]], 1.0, walls=fibrad.wall(inner, name="cube"))
    assert abs(factors.wall("cube")[0] - 1) < 1e-12 and inner.areas().sum() == pytest.approx(96, rel=1e-14)
    outer = fibrad.Mesh.from_stl(path, [[5, 0, 0]], 1.0)
    seen = fibrad.view_factors([[5, 0, 0]], 1.0, directions=500, walls=fibrad.wall(f"mesh:{path}")).wall("cube")[0]
    bed.write_text("x,y,z,r\n5,0,0,1\n")
    said = subprocess.run([program, "factors", bed, "--directions", "500", "--wall", f"mesh:{path}:name=cube"], check=True,
                          capture_output=True, text=True).stdout
    assert float(dict(line.split(None, 1) for line in said.splitlines())["wall_cube_F"]) == pytest.approx(seen, rel=1e-5)
    assert 0.05 < seen < 0.5 and fibrad.Mesh.from_stl(path, [[0, 0, 0]], 1.0, sides="both").back is True
    assert (fibrad.Mesh.from_stl(path, [[0, 0, 0]], 1.0, scale=0.5).vertices == inner.vertices / 2).all()


def test_open_mesh_is_told(tmp_path):
    path = write_cube(tmp_path / "cube.stl")
    lines = path.read_text().splitlines()
    path.write_text("\n".join(lines[:1] + lines[8:]))  # one triangle less
    with pytest.warns(UserWarning, match="not closed: 3 edges"):
        fibrad.Mesh.from_stl(path, [[0, 0, 0]], 1.0)


def test_saved(small, tmp_path):
    sparse = pytest.importorskip("scipy.sparse")
    factors = fibrad.view_factors(small.x, small.r, directions=21, walls="zmin:at=-1", ids=np.arange(small.n) + 7)
    factors.save(tmp_path / "F.npz")
    back = sparse.load_npz(tmp_path / "F.npz")
    assert (back != factors.matrix).nnz == 0
    arrays = np.load(tmp_path / "F.npz")
    assert (arrays["escaped"] == factors.escaped).all() and (arrays["body"] == factors.walls).all()
    assert (arrays["ids"] == factors.ids).all() and arrays["wall_names"].tolist() == [b"zmin"]
    with pytest.raises(fibrad.InputError, match="npz"):
        factors.save(tmp_path / "F.txt")
