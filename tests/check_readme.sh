#!/bin/sh
# check_readme.sh - every line of the program in README.md runs, with settled beds under the names of README.md. Every
# recipe of docs/recipes.md runs, too, and has the output of the page. SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}" "${CC:=cc}"
case $BUILD in /*) PATH=$BUILD:$PATH ;; *) PATH=$PWD/$BUILD:$PATH ;; esac
tree=$PWD
python=$(tests/find_python.sh numpy scipy)
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
cd "$work" || exit 1

sed 's/v_T/T/' "$tree/tests/data/mono2000.dump" >large.dump
head -n 59 large.dump | sed "4s,.*,50," >mybed.dump
awk 'BEGIN { print "x,y,z,r" } NR > 9 { print $3 "," $4 "," $5 "," $6 }' mybed.dump >mybed.csv
gzip <mybed.dump >bed.0.dump.gz
cp bed.0.dump.gz bed.1.dump.gz

# a closed tube through the bed: the sides, then both ends
awk 'function facet(a, b, c) { print "facet\nouter loop\nvertex " a "\nvertex " b "\nvertex " c "\nendloop\nendfacet" }
BEGIN {
    print "solid tube"
    split("5.9 5.9,6.1 5.9,6.1 6.1,5.9 6.1", at, ",")
    for (k = 1; k <= 4; k++) {
        next_one = at[k % 4 + 1]
        facet(at[k] " 0", next_one " 0", next_one " 9"); facet(at[k] " 0", next_one " 9", at[k] " 9")
    }
    facet(at[1] " 9", at[2] " 9", at[3] " 9"); facet(at[1] " 9", at[3] " 9", at[4] " 9")
    facet(at[1] " 0", at[3] " 0", at[2] " 0"); facet(at[1] " 0", at[4] " 0", at[3] " 0")
    print "endsolid tube"
}' >tube.stl

# rows of two ranks, a sphere each: host/couple/rows_file.h
without=
python3 - 2>/dev/null <<'END' || { without="join" && echo "SKIP fibrad join: no python3 to write its files"; }
import struct
for rank in (0, 1):
    head = struct.pack("<8s7Qd", b"FIBROWS1", rank, 2, 0, 1, 1, 0, 1, 0.0)
    rest = struct.pack("<4Q9d", rank, 0, 1, 1 - rank, 0.25, 0.75, 0, 0, 1, 0.5, 3.0 * rank, 0, 0)
    open(f"bed.{rank}.rows", "wb").write(head + rest)
END

faults=0
lines=0
command=
awk '/^    build\/fibrad / { on = 1 } on { print; on = /\\$/ }' "$tree/README.md" | sed 's/ #.*//; s/COMMAND/heat/' >list
while IFS= read -r line; do
    command=$command${line%\\}
    case $line in *\\) continue ;; esac
    lines=$((lines + 1))
    set -- "$command"
    command=
    case $1 in
    *" reproduce"*) continue ;; # some minutes; test_reproduce runs it in part
    *" ${without:-nothing} "*) continue ;;
    *" furnace "*) set -- "$1 --cells 4,4,8 --bundles 400000" ;;    # 15 s else
    *" conductivity "*) cp large.dump mybed.dump ;;                 # the others are too thin
    esac
    # the line as a shell would run it
    if ! eval "${1#*build/} >said 2>&1" </dev/null; then
        echo "README.md:$1" && sed 's/^/    /' said && faults=1
    fi
done <list
echo "$lines lines"
test $lines -gt 12 || exit 1

# the recipes: blocks of sh run one after the other, beside the beds and the files that `File `NAME`:` announces; the
# lines of a block of text behind one are in its output, in this order, but for `...` and a last digit or two
mkdir try && cp "$tree"/tests/data/*.dump try && cd try && ln -s "$tree/kernel" "$tree/build" .. || exit 1
test "${BUILD#/}" = "$BUILD" || ln -sfn "$BUILD" ../build
awk '
    /^File `.*`:$/ { file = $0; gsub(/File `|`:$/, "", file); next }
    /^```./ {
        if (/^```sh/) to = sprintf("%02d.sh", ++steps)
        else if (file != "") to = file
        else to = behind_sh ? sprintf("%02d.said", steps) : ""
        behind_sh = /^```sh/; inside = 1; file = ""; next
    }
    /^```/ { inside = 0; next }
    inside && to != "" { print >to }' "$tree/docs/recipes.md"
for step in [0-9]*.sh; do
    case $(cat "$step") in
    python3*) test -n "$python" || { echo "SKIP recipe $step: no python3 with SciPy" && continue; }
        sed -i "s|python3|$python|" "$step" ;;
    cc*) sed -i "s|^cc|$CC|" "$step" ;;
    lmp*) { command -v lmp >/dev/null && test -e ../build/couple/fibrad.lmp; } ||
        { echo "SKIP recipe $step: no lmp with the fix (make deps-couple lammps)" && continue; } ;;
    esac
    sh -e "$step" >said 2>&1 </dev/null || { echo "docs/recipes.md: $(cat "$step" said)" && faults=1 && continue; }
    test -e "${step%.sh}.said" || continue
    awk '
        function same(a, b,    n, m, i, p, q) { # numbers may differ by 2 %, as results do that are computed anew
            n = split(a, p); m = split(b, q)
            for (i = 1; i <= n; i++) if (p[i] != q[i] && (p[i] * q[i] == 0 || (p[i] / q[i] - 1)^2 > 4e-4)) return 0
            return n == m
        }
        NR == FNR { if ($0 != "...") line[++n] = $0; next } same(line[k + 1], $0) { k++ }
        END { if (k < n) print "not in the output, or not in this order: " line[k + 1]; exit k < n }' \
        "${step%.sh}.said" said || { echo "docs/recipes.md: $(cat "$step" said)" && faults=1; }
done
echo "${step%.sh} recipes' commands"
test "${step%.sh}" -gt 10 && exit $faults
