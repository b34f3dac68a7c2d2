#!/bin/sh
# check_couple.sh - links, rows and powers over MPI by 1, 2, 3 and 4 ranks, and the example. SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}" "${MPICC:=mpicc}" "${MPIRUN:=mpirun}"
if ! command -v "$MPICC" >/dev/null || ! command -v "$MPIRUN" >/dev/null; then
    echo "SKIP couplings: no MPI (Debian: openmpi-bin, libopenmpi-dev; make deps-couple)"
    exit 0
fi
. tests/couple/mpi.sh

make_one_by_one "$BUILD/couple/test_couple" "$BUILD/couple/example" || exit 1
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
faults=0

for ranks in 1 2 3 4; do
    run_mpi $ranks "$BUILD/couple/test_couple" "$work" || faults=1
    test -z "$(ls "$work")" || { echo "left behind: $(ls "$work")" && faults=1; }
done

# the energy balance of the example: stored = from the walls, and the same for any number of ranks
for ranks in 1 2; do
    run_mpi $ranks "$BUILD/couple/example" | tee "$work/$ranks"
done
awk '{ exit !($1 > 0 && $1 == $4) }' "$work/1" && cmp "$work/1" "$work/2" || faults=1
exit $faults
