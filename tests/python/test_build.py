# test_build.py - the wheel, and libraries that are not the right one. SPDX-License-Identifier: MIT
import base64
import hashlib
import importlib.metadata
import os
import re
import subprocess
import sys
import sysconfig
import zipfile

import pytest

import fibrad
from fibrad._structures import FUNCTIONS

LIKE = """
#include <stddef.h>
const char *fibrad_version(void) { return "%s"; }
const char *fibrad_status_text(int status) { return ""; }
const char *fibrad_why_text(int why) { return ""; }
size_t fibrad_host_sizeof(const char *name) { return %d; }
"""


@pytest.fixture(name="backend")
def fixture_backend(tree, monkeypatch):
    """The build backend, as pip imports it."""
    monkeypatch.syspath_prepend(str(tree / "host" / "python" / "build_backend"))
    monkeypatch.delitem(sys.modules, "fibrad_build", raising=False)
    import fibrad_build
    return fibrad_build


@pytest.fixture(name="version")
def fixture_version(tree):
    header = (tree / "kernel" / "fibrad.h").read_text(encoding="utf-8")
    return re.search('^#define FIBRAD_VERSION "(.*)"', header, re.MULTILINE)[1]


def test_versions_are_one(version):
    assert fibrad.__version__ == version == importlib.metadata.version("fibrad")


def test_the_package_is_the_installed_one(tree):
    assert str(tree / "host") not in fibrad.__file__


def test_wheel(backend, tmp_path, version):
    name = backend.build_wheel(str(tmp_path))
    platform = re.sub("[-.]", "_", sysconfig.get_platform())
    assert name == f"fibrad-{version}-py3-none-{platform}.whl"
    with zipfile.ZipFile(tmp_path / name) as wheel:
        names = wheel.namelist()
        assert {"fibrad/__init__.py", "fibrad/py.typed", "fibrad/libfibrad.so"} <= set(names)
        record = wheel.read(f"fibrad-{version}.dist-info/RECORD").decode().splitlines()
        assert len(record) == len(names)
        for line in record[:-1]:
            path, digest, size = line.split(",")
            content = wheel.read(path)
            expected = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
            assert (digest, size) == (f"sha256={expected}", str(len(content)))
        assert record[-1] == f"fibrad-{version}.dist-info/RECORD,,"
    assert (tmp_path / name).read_bytes() == (tmp_path / backend.build_wheel(str(tmp_path))).read_bytes()


def test_editable_wheel(backend, tmp_path, tree):
    with zipfile.ZipFile(tmp_path / backend.build_editable(str(tmp_path))) as wheel:
        assert wheel.read("fibrad_tree.pth").decode() == f"{tree / 'host' / 'python'}\n"


def test_used_from_the_tree(tree):
    """As an editable install does."""
    code = "import fibrad; assert 'host/python' in fibrad.__file__; print(len(fibrad.view_factors([[0, 0, 0]], 1).data))"
    run = subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": str(tree / "host" / "python")},
                         capture_output=True, text=True, check=True)
    assert run.stdout == "0\n"


def test_no_source_distribution(backend, tmp_path):
    with pytest.raises(backend.UnsupportedOperation, match="no source distribution"):
        backend.build_sdist(str(tmp_path))


def test_without_tools(backend, tmp_path, monkeypatch):
    """Without a compiler, the build takes the library that is there. Without both, it ends with a plain sentence."""
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("CC", "cc -O3")
    assert backend.build_wheel(str(tmp_path))
    monkeypatch.setattr(backend, "LIBRARY", tmp_path / "libfibrad.so")
    with pytest.raises(SystemExit, match="no make and no cc: building libfibrad.so needs make and a C compiler"):
        backend.build_wheel(str(tmp_path))


def test_a_library_that_cannot_be_built(backend, tmp_path, monkeypatch):
    monkeypatch.setenv("CC", "false")
    monkeypatch.setattr(backend, "BUILD", tmp_path)
    with pytest.raises(SystemExit, match="lib-host: failed"):
        backend.build_wheel(str(tmp_path))


def test_out_of_the_source_tree(backend, tmp_path, monkeypatch):
    monkeypatch.setattr(backend, "TREE", tmp_path)
    with pytest.raises(SystemExit, match="not in the source tree"):
        backend.build_wheel(str(tmp_path))


@pytest.mark.parametrize("version_of, size, text", [
    ("0.0.1", 0, "is of version 0.0.1, this package of"), (None, 4, " has 4 bytes, this package has ")])
def test_another_library_is_refused(version_of, size, text, version, tmp_path):
    source = LIKE % (version_of or version, size) + "".join(f"void {name}(void) {{}}\n" for name in FUNCTIONS
                                                           if f"{name}(" not in LIKE)
    (tmp_path / "like.c").write_text(source, encoding="ascii")
    library = tmp_path / "like.so"
    subprocess.run([*os.environ.get("CC", "cc").split(), "-shared", "-fPIC", tmp_path / "like.c", "-o", library], check=True)
    run = subprocess.run([sys.executable, "-c", "import fibrad"], env={**os.environ, "FIBRAD_LIBRARY": str(library)},
                         capture_output=True, text=True, check=False)
    assert run.returncode and "ImportError: fibrad:" in run.stderr and text in run.stderr


def test_no_library():
    run = subprocess.run([sys.executable, "-c", "import fibrad"], env={**os.environ, "FIBRAD_LIBRARY": "/nowhere.so"},
                         capture_output=True, text=True, check=False)
    assert run.returncode and "/nowhere.so cannot be loaded" in run.stderr
