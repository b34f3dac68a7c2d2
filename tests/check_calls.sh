#!/bin/sh
# check_calls.sh - no circle of calls among the files of kernel and host, by the symbols of their objects. The couplings
# are looked at, too, once they are built (make couple). SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}"
set -- "$BUILD"/libfibrad.a "$BUILD"/libfibrad_host.a "$BUILD"/libhost.a
couple=$BUILD/couple/libfibrad_couple.a
if test -e "$couple"; then set -- "$@" "$couple"; else echo "SKIP calls of couplings: no $couple (make couple)"; fi
symbols=$(nm -A -g "$@") || exit 1

# lines "CALLER CALLED"
calls=$(echo "$symbols" | awk '
    NF < 3 { next }
    { split($1, at, ":") }
    $2 == "U" { user[++uses] = at[1] ":" at[2]; used[uses] = $3; next }
    { home[$3] = at[1] ":" at[2] }
    END { for (k = 1; k <= uses; k++) if (used[k] in home) print user[k], home[used[k]] }' | sort -u)
test -n "$calls" || { echo "no calls among the objects of $BUILD" && exit 1; }

circles=$(echo "$calls" | awk '$1 != $2' | tsort 2>&1 >/dev/null | sed 's/^/a circle of calls: /')
test -z "$circles" && exit
echo "$circles"
exit 1
