#!/bin/sh
# check_couple.sh [all] - links, rows and powers over MPI by 3 ranks, all: by 1 to 4, the number of messages, and
# the example, built in the tree and against the installed library. SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}" "${MPICC:=mpicc}" "${MPIRUN:=mpirun}"
if ! command -v "$MPICC" >/dev/null || ! command -v "$MPIRUN" >/dev/null; then
    echo "SKIP couplings: no MPI (Debian: openmpi-bin, libopenmpi-dev; make deps-couple)"
    exit 0
fi
. tests/couple/mpi.sh

make_one_by_one "$BUILD/couple/test_couple" "$BUILD/couple/example" "$BUILD/couple/ranks" || exit 1
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
faults=0

test "${1:-}" = all && numbers="1 2 3 4" || numbers=3
for ranks in $numbers; do
    run_mpi "$ranks" "$BUILD/couple/test_couple" "$work" || faults=1
    test -z "$(ls "$work")" || { echo "left behind: $(ls "$work")" && faults=1; }
done

# eight ranks, each with five neighbours: two messages to each neighbour in a making of rows, two in a step of heat
run_mpi 8 "$BUILD/couple/ranks" tests/data/monoper2000.dump 2 1 2.5 | awk -F, '
    NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k }
    { print }
    END { exit !(NR == 2 && $column["rows_messages"] == 10 && $column["heat_messages"] == 10) }' || faults=1

# the energy balance of the example: stored = from the walls, and the same for any number of ranks
for ranks in 1 2; do
    run_mpi $ranks "$BUILD/couple/example" | tee "$work/$ranks"
done
awk '{ exit !($1 > 0 && $1 == $4) }' "$work/1" && cmp "$work/1" "$work/2" || faults=1

# the same program, with what pkg-config says of the installed library
make_one_by_one install-couple BUILD="$BUILD" PREFIX="$work/usr" || exit 1
sed 's|couple/fibrad_couple.h|fibrad_couple.h|' host/couple/example.c >"$work/installed.c"
flags=$(PKG_CONFIG_PATH="$work/usr/lib/pkgconfig" pkg-config --cflags --libs fibrad_couple)
# shellcheck disable=SC2086  # a list of flags
"$MPICC" -std=c99 "$work/installed.c" $flags -o "$work/installed" && run_mpi 1 "$work/installed" >"$work/3" &&
    cmp "$work/1" "$work/3" || faults=1
exit $faults
