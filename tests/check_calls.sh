#!/bin/sh
# check_calls.sh - no circle of calls among the files of kernel and host, by the symbols of their objects.
# SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}"
symbols=$(nm -A -g "$BUILD"/libfibrad.a "$BUILD"/libfibrad_host.a "$BUILD"/libhost.a) || exit 1

# lines "CALLER CALLED"
calls=$(echo "$symbols" | awk '
    NF < 3 { next }
    { split($1, at, ":") }
    $2 == "U" { user[++uses] = at[2]; used[uses] = $3; next }
    { home[$3] = at[2] }
    END { for (k = 1; k <= uses; k++) if (used[k] in home) print user[k], home[used[k]] }' | sort -u)
test -n "$calls" || { echo "no calls among the objects of $BUILD" && exit 1; }

circles=$(echo "$calls" | awk '$1 != $2' | tsort 2>&1 >/dev/null | sed 's/^/a circle of calls: /')
test -z "$circles" && exit
echo "$circles"
exit 1
