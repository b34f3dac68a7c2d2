# fibrad_build.py - builds the wheel: libfibrad.so by the Makefile, the archive by zipfile. SPDX-License-Identifier: MIT
"""Build backend after PEP 517 and PEP 660. BUILD and CC in the environment are those of the Makefile."""
import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sysconfig
import zipfile

HERE = pathlib.Path(__file__).resolve().parents[1]
TREE = HERE.parents[1]
BUILD = TREE / os.environ.get("BUILD", "build")
LIBRARY = BUILD / "libfibrad.so"
FILES = BUILD / "libfibrad_files.so"  # reads files; needs zlib


class UnsupportedOperation(Exception):
    """What PEP 517 wants to be raised by build_sdist."""


def _version():
    header = TREE / "kernel" / "fibrad.h"
    if not header.exists():
        raise SystemExit(f"fibrad: {HERE} is not in the source tree of fibrad: "
                         "pip install TREE/host/python (pip 21.3 or newer)")
    return re.search(r'^#define FIBRAD_VERSION "(.*)"', header.read_text(encoding="utf-8"), re.MULTILINE)[1]


def _build_library():
    """Brings libfibrad.so up to date. Without make or a compiler, takes the library that is there."""
    compiler = os.environ.get("CC", "cc")
    missing = [tool for tool in ("make", compiler.split()[0]) if not shutil.which(tool)]
    if missing and not LIBRARY.exists():
        raise SystemExit(f"fibrad: no {' and no '.join(missing)}: building libfibrad.so needs make and a C compiler "
                         f"with OpenMP (Debian: make gcc libc6-dev), or {LIBRARY} built before")
    if not missing:
        command = ["make", "-s", f"-j{os.cpu_count()}", "-C", str(TREE), f"BUILD={BUILD}", f"CC={compiler}", "lib-host"]
        if subprocess.run(command, check=False).returncode:
            raise SystemExit(f"fibrad: {' '.join(command)}: failed")
        if subprocess.run([*command[:-1], "lib-files"], check=False).returncode:
            print("fibrad: without libfibrad_files.so: fibrad.read and Mesh.from_stl need zlib (Debian: zlib1g-dev)")


def _metadata():
    return f"""Metadata-Version: 2.1
Name: fibrad
Version: {_version()}
Summary: View factors and thermal radiation between the spheres of packed beds
License: MIT
Requires-Python: >=3.9
Requires-Dist: numpy
Provides-Extra: sparse
Requires-Dist: scipy; extra == "sparse"
"""


def _write_wheel(directory, tag, pure, files):
    """files: names in the archive and their bytes. Returns the name of the wheel."""
    info = f"fibrad-{_version()}.dist-info"
    files = {**files,
             f"{info}/METADATA": _metadata().encode(),
             f"{info}/LICENSE": (TREE / "LICENSE").read_bytes(),
             f"{info}/WHEEL": f"Wheel-Version: 1.0\nGenerator: fibrad_build\nRoot-Is-Purelib: {pure}\n"
                              f"Tag: py3-none-{tag}\n".encode()}
    record = f"{info}/RECORD,,\n"
    name = f"fibrad-{_version()}-py3-none-{tag}.whl"
    with zipfile.ZipFile(pathlib.Path(directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, content in files.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record = f"{path},sha256={digest},{len(content)}\n" + record
            wheel.writestr(zipfile.ZipInfo(path), content, zipfile.ZIP_DEFLATED)  # ZipInfo: the same bytes at any time
        wheel.writestr(zipfile.ZipInfo(f"{info}/RECORD"), record)
    return name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    _version()  # the source tree is there
    _build_library()
    package = HERE / "fibrad"
    files = {f"fibrad/{path.name}": path.read_bytes()
             for path in sorted(package.iterdir()) if path.suffix == ".py" or path.name == "py.typed"}
    files["fibrad/libfibrad.so"] = LIBRARY.read_bytes()
    if FILES.exists():
        files["fibrad/libfibrad_files.so"] = FILES.read_bytes()
    tag = re.sub(r"[-.]", "_", sysconfig.get_platform())
    return _write_wheel(wheel_directory, tag, "false", files)


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    """The sources stay where they are, and libfibrad.so where make leaves it."""
    _version()
    _build_library()
    return _write_wheel(wheel_directory, "any", "true", {"fibrad_tree.pth": f"{HERE}\n".encode()})


def build_sdist(sdist_directory, config_settings=None):
    raise UnsupportedOperation("fibrad: no source distribution: libfibrad.so is built from the whole source tree, "
                               "which is one already: pip install TREE/host/python")
