#!/bin/sh
# check_readme.sh - every line of the program in README.md runs, with settled beds under the names of README.md. Every
# recipe of docs/recipes.md and docs/beside.md runs, too, and has the output of the page. SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}" "${CC:=cc}"
case $BUILD in /*) PATH=$BUILD:$PATH ;; *) PATH=$PWD/$BUILD:$PATH ;; esac
tree=$PWD
python=$(tests/find_python.sh numpy scipy)
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
cd "$work" || exit 1

sed 's/v_T/T/' "$tree/tests/data/mono2000.dump" >large.dump
head -n 59 large.dump | sed "4s,.*,50," >mybed.dump

faults=0
lines=0
command=
awk '/^    build\/fibrad / { on = 1 } on { print; on = /\\$/ }' "$tree/README.md" | sed 's/ #.*//' >list
while IFS= read -r line; do
    command=$command${line%\\}
    case $line in *\\) continue ;; esac
    lines=$((lines + 1))
    set -- "$command"
    command=
    case $1 in
    *" conductivity "*) cp large.dump mybed.dump ;; # the others are too thin
    esac
    # the line as a shell would run it
    if ! eval "${1#*build/} >said 2>&1" </dev/null; then
        echo "README.md:$1" && sed 's/^/    /' said && faults=1
    fi
done <list
echo "$lines lines"
test $lines -gt 4 || exit 1

# the recipes: blocks of sh run one after the other, beside the beds and the files that `File `NAME`:` announces; the
# lines of a block of text behind one are in its output to the last digit, in this order
mkdir try && cp "$tree"/tests/data/*.dump try && cd try && ln -s "$tree/build" "$tree/docs" "$tree/host" "$tree/kernel" "$tree/tests" .. || exit 1
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
    inside && to != "" { print >to }' "$tree/docs/recipes.md" "$tree/docs/beside.md"
for step in [0-9]*.sh; do
    case ${NIGHTLY:-}$(cat "$step") in # what takes long is for the night
    fibrad*--until* | fibrad*--irradiate* | fibrad*--solid-* | fibrad*--steady* | *clumps2000* | *neighbours.py*) continue ;;
    esac
    case $(cat "$step") in
    python3*) test -n "$python" || { echo "SKIP recipe $step: no python3 with SciPy" && continue; }
        sed -i "s|python3|$python|" "$step" ;;
    *yade*) continue ;; # tests/python/test_examples.py
    *lprecice*) echo '#include <precice/preciceC.h>' | "$CC" -E - >/dev/null 2>&1 || { echo "SKIP recipe $step: no preCICE" && continue; } ;;
    cc*) sed -i "s|^cc|$CC|" "$step" ;;
    lmp*) { command -v lmp >/dev/null && test -e ../build/couple/fibrad.lmp; } ||
        { echo "SKIP recipe $step: no lmp with the fix (make deps-couple lammps)" && continue; } ;;
    esac
    sh -e "$step" >said 2>&1 </dev/null || { echo "recipe $step: $(cat "$step" said)" && faults=1 && continue; }
    test -e "${step%.sh}.said" || continue
    awk '
        function plain(line) { gsub(/ +/, " ", line); sub(/ $/, "", line); return line }
        NR == FNR { if ($0 != "...") line[++n] = plain($0); next } line[k + 1] == plain($0) { k++ }
        END { if (k < n) print "not in the output, or not in this order: " line[k + 1]; exit k < n }' \
        "${step%.sh}.said" said || { echo "recipe $step: $(cat "$step" said)" && faults=1; }
done
echo "${step%.sh} recipes' commands"
test "${step%.sh}" -gt 10 && exit $faults
