#!/bin/sh
# check_python.sh - the Python package, installed in a virtual environment without network, and its tests by pytest.
# SPDX-License-Identifier: MIT
set -eu
: "${BUILD:=build}" "${CC:=cc}"
tree=$PWD
case $BUILD in /*) build=$BUILD ;; *) build=$tree/$BUILD ;; esac

python=$(tests/find_python.sh ensurepip numpy pytest scipy.sparse venv)
if test -z "$python"; then
    echo "SKIP: no Python with NumPy, SciPy, pytest and venv (Debian: python3-numpy python3-scipy python3-pytest python3-venv)"
    exit 0
fi

work=$build/python
rm -rf "$work"
"$python" -m venv --system-site-packages "$work"
BUILD=$build CC=$CC "$work/bin/pip" install -q --no-index --disable-pip-version-check ./host/python

if command -v mypy >/dev/null; then
    mypy --strict --ignore-missing-imports --cache-dir /dev/null host/python/fibrad >"$work/types" || { cat "$work/types" && exit 1; }
else
    echo "SKIP types: no mypy"
fi

# elsewhere, so that only the installed package is found
cd "$work"
status=0
BUILD=$build CC=$CC PYTHONDONTWRITEBYTECODE=1 bin/python -m pytest -q -rs -p no:cacheprovider -c /dev/null --rootdir "$tree" \
    "$tree/tests/python" >log 2>&1 || status=$?
sed 's/^SKIPPED/SKIP/' log
exit $status
