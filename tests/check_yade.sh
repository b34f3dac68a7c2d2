#!/bin/sh
# check_yade.sh - spheres, clumps, a wall and facets of YADE exchange radiation: host/python/examples/yade_radiation.py.
# SPDX-License-Identifier: MIT
set -eu
: "${BUILD:=build}" "${MAKE:=make}" "${CC:=cc}"
command -v yade >/dev/null || { echo "SKIP YADE: it is not on this machine (Debian: yade)" && exit 0; }
$MAKE -s --no-print-directory BUILD="$BUILD" CC="$CC" lib-host
FIBRAD_LIBRARY=$(cd "$BUILD" && pwd)/libfibrad.so PYTHONPATH=$PWD/host/python PYTHONDONTWRITEBYTECODE=1 \
    yade -n -x "$PWD/host/python/examples/yade_radiation.py" >"$BUILD/yade.log" 2>&1 || { cat "$BUILD/yade.log" && exit 1; }
grep absorbed "$BUILD/yade.log"
