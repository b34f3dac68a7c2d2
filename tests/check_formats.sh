#!/bin/sh
# check_formats.sh - one settled bed as files of many programs gives the same rows by id.
# SPDX-License-Identifier: MIT
#
# tests/data/README.md says how the files were made. Where ids are missing, spheres stand in their order.
set -u
: "${BUILD:=build}"
beds=tests/data/formats
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
faults=0

rows() { # rows FILE OUT OPTIONS...: the matrix of a bed
    from=$1 to=$2
    shift 2
    "$BUILD/fibrad" factors "$from" --directions 34 --threads 2 -o "$to" "$@" >/dev/null 2>"$work/said" && return
    cat "$work/said"
    return 1
}

# A bed without ids has positions from 0.
by_id() {
    awk -F , -v OFS=, 'NR > 1 { $1 += $1 >= 0; $2 += $2 >= 0 } { print }' "$1" >"$work/named" && mv "$work/named" "$1"
}

# Whether both files have the same pairs, but for tiny factors, and the same factors within an error
close_to() {
    awk -F , -v error="$1" '
        function off(a, b) { return a - b > error || b - a > error }
        FNR == 1 { next }
        NR == FNR { F[$1 "," $2] = $3; next }
        { if (off(F[$1 "," $2], $3)) bad++; delete F[$1 "," $2] }
        END { for (pair in F) if (off(F[pair], 0)) bad++; exit bad > 0 }' "$work/wanted.csv" "$2"
}

check() { # check ERROR FILE OPTIONS...: 0 asks for the same bits
    error=$1 bed=$2
    shift 2
    if ! rows "$beds/$bed" "$work/F.csv" "$@"; then
        faults=$((faults + 1))
        return
    fi
    case $bed in yade.txt | yade.vtk | mercury.data) by_id "$work/F.csv" ;; esac
    if test "$error" = 0; then cmp -s "$work/wanted.csv" "$work/F.csv"; else close_to "$error" "$work/F.csv"; fi && return
    echo "$beds/$bed: other rows than those of settled.csv"
    faults=$((faults + 1))
}

rows $beds/settled.csv "$work/wanted.csv" || exit 1
for bed in lammps.dump lammps_frames.dump.gz lammps_triclinic.dump lammps_sphere.data liggghts.dump liggghts.data \
    liggghts.vtk yade.txt yade_ids.txt yade_attrs.txt yade.vtk extended.xyz mercury.data blanks.txt paraview.csv \
    vtk_ascii.vtp vtk_inline.vtp vtk_inline_zlib_big.vtp vtk_appended.vtp vtk_appended_raw.vtp \
    vtk_appended_raw_zlib.vtp vtk_ascii.vtk vtk_binary.vtk vtk_binary42.vtk; do
    check 0 $bed
done
check 1e-13 lammps_units.dump.gz # coordinates are fractions of the box
check 1e-13 semicolons.csv       # millimetres
for bed in liggghts.vtp yade_ascii.vtu yade_packed.vtu; do check 1e-5 $bed; done # floats of four bytes

# a file without a style, with the style added
sed 's/^Atoms # hybrid/& sphere/' $beds/lammps_hybrid.data >"$work/hybrid.data"
beds=$work check 0 hybrid.data

# the program reads the files that it writes
"$BUILD/fibrad" factors tests/data/formats/settled.csv --directions 34 -o "$work/own.vtp" >/dev/null 2>&1
beds=$work check 0 own.vtp

test $faults = 0
