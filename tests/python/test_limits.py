# test_limits.py - bounds are those of the library's header. SPDX-License-Identifier: MIT
import re
from pathlib import Path

from fibrad import _limits

HEADER = Path(__file__).parents[2] / "kernel" / "fibrad_limits.h"


def test_bounds_are_those_of_the_header():
    text = HEADER.read_text()
    c = {name: float(value) for name, value in re.findall(r"#define FIBRAD_(\w+)\s+([\d.e-]+)\b", text)}
    assert _limits.DIRECTIONS == (c["DIRECTIONS_MIN"], c["DIRECTIONS_MAX"])
    assert _limits.NODES == (c["NODES_MIN"], c["NODES_MAX"])
    assert _limits.PATCHES[-1] == c["HEAT_PATCHES_MAX"] and c["HEAT_PATCHES_DEFAULT"] in _limits.PATCHES
    assert _limits.SIGMA == (c["SIGMA_MIN"], c["SIGMA_MAX"])
    for name in ("LENGTH_MAX", "TEMPERATURE_MAX", "POWER_MAX", "CAPACITY_MAX", "DURATION_MAX", "SUN_HALF_ANGLE",
                 "HALF_ANGLE_MAX", "LIGHT_DIRECTIONS_MAX"):
        assert getattr(_limits, name) == c[name]


def test_docstrings_and_fortran_have_the_defaults():
    import fibrad

    c = dict(re.findall(r"#define FIBRAD_(\w+_DEFAULT)\s+(\d+)", HEADER.read_text()))
    factors = fibrad.view_factors.__doc__
    for name in ("DIRECTIONS_DEFAULT", "NODES_DEFAULT", "RAYS_DEFAULT"):
        assert f"Default: {c[name]}" in factors, name
    fortran = (HEADER.parents[1] / "host" / "fortran" / "fibrad.f90").read_text()
    for name in ("DIRECTIONS_DEFAULT", "EXCHANGE_DIRECTIONS_DEFAULT", "HEAT_DIRECTIONS_DEFAULT",
                 "HEAT_POINTS_DEFAULT", "HEAT_PATCHES_DEFAULT"):
        assert f"absent: {c[name]}" in fortran, name
