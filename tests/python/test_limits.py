# test_limits.py - bounds are those of the library's header. SPDX-License-Identifier: MIT
import re
from pathlib import Path

from fibrad import _limits

HEADER = Path(__file__).parents[2] / "kernel" / "fibrad_limits.h"


def test_bounds_are_those_of_the_header():
    text = HEADER.read_text()
    c = {name: float(value) for name, value in re.findall(r"#define FIBRAD_(\w+)\s+([\d.e-]+)\b", text)}
    assert _limits.DIRECTIONS == (c["DIRECTIONS_MIN"], c["DIRECTIONS_MAX"])
    assert _limits.PATCHES[-1] == c["HEAT_PATCHES_MAX"] and c["HEAT_PATCHES_DEFAULT"] in _limits.PATCHES
    assert _limits.SIGMA == (c["SIGMA_MIN"], c["SIGMA_MAX"])
    for name in ("LENGTH_MAX", "TEMPERATURE_MAX", "POWER_MAX", "CAPACITY_MAX", "DURATION_MAX", "SUN_HALF_ANGLE",
                 "HALF_ANGLE_MAX", "LIGHT_DIRECTIONS_MAX"):
        assert getattr(_limits, name) == c[name]


def test_docstrings_have_the_defaults():
    import fibrad

    c = dict(re.findall(r"#define FIBRAD_(\w+_DEFAULT)\s+(\d+)", HEADER.read_text()))
    for text, names in ((fibrad.Bed.factors.__doc__, ("DIRECTIONS", "EXCHANGE_DIRECTIONS", "RAYS", "PATHS", "LINES")),
                        (fibrad.Bed.beams.__doc__, ("HEAT_DIRECTIONS", "HEAT_POINTS", "HEAT_PATCHES"))):
        assert all(f"Default: {c[name + '_DEFAULT']}" in text for name in names)
