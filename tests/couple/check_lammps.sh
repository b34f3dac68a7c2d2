#!/bin/bash
# check_lammps.sh [all] - fix fibrad in LAMMPS: a frozen bed on 1 and 2 ranks has the temperatures of one scene without ranks. All:
# the same bytes of rows on 1, 2 and 4 ranks, energy in moving beds, meshes, and failures that end all ranks.
# SPDX-License-Identifier: MIT
#
# LMP and LOAD may name another LAMMPS and a script that loads the fix into it: host/couple/lammps/newer.sh does.
set -u
: "${BUILD:=build}" "${MPICC:=mpicc}" "${MPIRUN:=mpirun}" "${LMP:=lmp}"
for program in "$MPICC" "$MPIRUN" "$LMP"; do
    command -v "$program" >/dev/null || { echo "SKIP fix fibrad: no $program on this machine (make deps-couple)" && exit; }
done
test -n "${LOAD:-}" || test -e /usr/include/lammps/fix.h || { echo "SKIP fix fibrad: no liblammps-dev (make deps-couple)" && exit; }
. tests/couple/mpi.sh
. tests/couple/beds.sh

make_one_by_one "$BUILD/tests/couple/serial_bed" "$BUILD/tests/couple/sorted_rows" "$BUILD/fibrad" || exit 1
test -n "${LOAD:-}" || { LOAD=$BUILD/couple/fibrad.lmp && make_one_by_one "$LOAD" || exit 1; }
work=$BUILD/couple/check_lammps
rm -rf "$work"
mkdir -p "$work"
faults=0

# verdict WHAT STATUS [WHY]
verdict() {
    if test "$2" -eq 0; then echo "ok      $1"; else echo "FAILED  $1${3:+: $3}" && faults=1; fi
}

# run NP NAME SCRIPT [NAME VALUE]...: runs a script, whose output is NAME.out, with values of its variables
run() {
    local np=$1 name=$2 script=$3 words=()
    shift 3

    while test $# -gt 0; do words+=(-var "$1" "$2") && shift 2; done
    # shellcheck disable=SC2086  # a variable may be several words
    limited_mpi "$np" "$LMP" -in "tests/couple/$script" -log "$work/$name.log" -screen none \
        -var load "$LOAD" -var out "$work/$name.out" "${words[@]}" >"$work/$name.err" 2>&1
}

# near A B BOUND WHAT: the largest difference of temperatures, and whether it is below BOUND
near() {
    found=$(awk 'NF == 2 && /^[0-9]+ / && NR == FNR { t[$1] = $2; n++; next }
        NF == 2 && /^[0-9]+ / { d = $2 - t[$1]; if (d < 0) d = -d; if (!($1 in t) || !(d <= worst)) worst = d; m++ }
        END { if (n && n == m) printf "%.2g", worst; else printf "inf" }' "$1" "$2" 2>/dev/null || echo inf)
    awk -v d="${found:-inf}" -v bound="$3" 'BEGIN { exit !(d + 0 == d && d < bound) }'
    verdict "$4 ($found K)" $?
}

# balance NAME DT BEFORE CHANGE RECORDS WHAT: energy against what walls and surroundings have gained since, by powers of the
# same record, or with BEFORE of the one before it; the energy has changed by more than CHANGE of it
balance() {
    found=$(awk -v dt="$2" -v before="$3" -v change="$4" -v records="$5" '
        /^[0-9]/ { if (n++) gained += (before ? power : $3)*dt; else first = $2; last = $2; power = $3 }
        END {
            moved = (last - first)/last; error = moved + gained/last
            printf "error %.2g of the total", error
            exit !(n > records && error*error < 1e-24 && moved*moved > change*change)
        }' "$work/$1.out.balance")
    verdict "$6 ($found)" $?
}

# ---- frozen beds ------------------------------------------------------------------------------------------------------
# a quarter of a bed of 2,000, with a cutoff that all particles are within, which is none
awk '/^[0-9]+ 1 / && ($3 >= 6 || $4 >= 6) { next } { print }' tests/data/mono2000.dump >"$work/quarter.dump"
as_data "$work/quarter.dump" >"$work/quarter.data"
awk '/^[0-9]+ 1 / { print $1, $3, $4, $5, $6, $7 }' "$work/quarter.dump" |
    tee "$work/quarter" | "$BUILD/tests/couple/serial_bed" 50 20 100 >"$work/serial.out"
whole=(data "$work/quarter.data" cutoff 4000)

test "${1:-}" = all && numbers="1 2 4" || numbers="1 2"
for np in $numbers; do
    run "$np" "frozen$np" frozen.lmp "${whole[@]}"
    near "$work/serial.out" "$work/frozen$np.out" 1e-10 "frozen bed against one scene without ranks, np $np"
done
test "${1:-}" = all || exit $faults
same() { near "$work/frozen1.out" "$work/$1.out" 1e-10 "$2"; }

run 2 newton frozen.lmp "${whole[@]}" newton off
same newton "newton off"
for grid in "4 1 1" "1 4 1" "2 1 2"; do
    run 4 grid frozen.lmp "${whole[@]}" grid "$grid"
    same grid "processors $grid"
done
run 4 empty frozen.lmp "${whole[@]}" grid "1 1 4"
same empty "ranks without particles"
run 4 balance frozen.lmp "${whole[@]}" grid "1 1 4" also "fix b all balance 10 1.0 shift z 10 1.01"
same balance "balance during the run"
run 2 first frozen.lmp "${whole[@]}" steps 25 also "restart 25 $work/at.*"
run 4 restarted frozen.lmp data "$work/at.25" cutoff 4000 restarted yes steps 25
same restarted "restart in the middle, from np 2 to np 4"

# ---- rows -------------------------------------------------------------------------------------------------------------
# bytes NAME: the rows that a run left
bytes() { "$BUILD/tests/couple/sorted_rows" "$work/$1.0" | sha256sum; }
for bed in poly2000 monoper2000; do
    as_data tests/data/$bed.dump | sed '/^Temperatures/,$d' >"$work/$bed.data"
    as_data tests/data/$bed.dump 1 | sed '/^Temperatures/,$d' >"$work/reversed.data"
    box="f f f"
    if test $bed = monoper2000; then box="p p f"; fi
    for np in 1 2 4; do
        data=$work/$bed.data
        if test "$np" -eq 4; then data=$work/reversed.data; fi
        run $np $bed$np rows.lmp data "$data" boundary "$box" rows "$work/$bed$np"
        test "$np" -eq 1 && bytes "$bed$np" >"$work/bytes" && continue
        test -s "$work/$bed$np.0.0.rows" && test "$(bytes "$bed$np")" = "$(cat "$work/bytes")"
        verdict "rows of $bed, np $np: the same bytes" $?
    done
done

# ---- the sky above a bed, against fibrad heat ---------------------------------------------------------------------------
awk 'NF == 8 && /^[0-9]/ { $2 = 2 - $1%2 } { print }' tests/data/monoper2000.dump >"$work/types.dump"
as_data tests/data/monoper2000.dump >"$work/flat.data"
run 1 sky frozen.lmp data "$work/flat.data" boundary "p p f" steps 0 also "set group all d_T 1000"
found=$("$BUILD/fibrad" heat "$work/types.dump" --emissivity 1:.5,2:.8 --temperature 1000 --ambient 300 \
    --wall zmin:at=0:temperature=1000:emissivity=.9 --directions 200 2>/dev/null |
    awk '$1 == "surroundings_W" { print $2; exit }')
awk '$1 == "Step" { getline; print $3; exit }' "$work/sky.log" |
    awk -v heat="${found:-0}" '{ d = $1/heat - 1; printf "%.2g", d; exit !(heat > 0 && d*d < 8e-3^2) }' >"$work/sky.error"
status=$?
verdict "the sky above a flat bed gets what fibrad heat says ($(cat "$work/sky.error"))" $status

# ---- single particles below a periodic bed, against fibrad heat --------------------------------------------------------
run 2 below below.lmp
"$BUILD/fibrad" heat "$work/below.out" --emissivity .8 --temperature 300 --ambient 300 \
    --wall zmin:at=0:temperature=1000:emissivity=.9 --directions 600 --length-unit m -o "$work/below.csv" >/dev/null 2>&1
found=$(awk -F'[ ,]' 'NR == FNR && $1 ~ /^[0-9]/ { q[$1] = $3; next } NR == FNR && /zmin$/ { floor = $3 }
    NR > FNR && NF == 7 && $1 in q { all += $7; truth += q[$1]; n++ }
    NR > FNR && NF == 7 && $1 > 192 { alone += $7; expected += q[$1] }
    END { printf "%.2g, all %.2g", alone/expected - 1, all/truth - 1
          exit !(n == 195 && (alone/expected - 1)^2 < .015^2 && (all/truth - 1)^2 < .006^2) }' "$work/below.csv" "$work/below.out")
verdict "particles below a periodic bed have the powers of fibrad heat ($found)" $?
! grep -q 'WARNING: fix fibrad' "$work/below.log"
verdict "no warning of a bed without a cutoff" $?

# ---- particles that conduct, against fibrad heat ------------------------------------------------------------------------
# powers_near CSV DUMP WHAT: the powers of all particles
powers_near() {
    found=$(awk -F'[ ,]' 'NR == FNR && $1 ~ /^[0-9]/ { q[$1] = $3 } NR > FNR && NF == 2 && $1 in q {
            d = $2 - q[$1]; n++; off += d*d; all += q[$1]^2 }
        END { printf "%.2g", sqrt(off/all); exit !(n == 499 && off < .05^2*all) }' "$1" "$2")
    verdict "$3 ($found)" $?
}
awk 'BEGIN { print "id,type,x,y,z,radius,T" } { print $1 "," 2 - $1%2 "," $2 "," $3 "," $4 "," $5 "," $6 }' \
    "$work/quarter" >"$work/quarter.csv"
"$BUILD/fibrad" heat "$work/quarter.csv" --emissivity 1:.5,2:.8 --temperature T --ambient 300 \
    --wall zmin:at=0:temperature=1000:emissivity=.9 --solid-conductivity 1:4,2:12 --directions 600 --length-unit m \
    -o "$work/conduct.csv" >/dev/null 2>&1
run 2 conduct frozen.lmp "${whole[@]}" steps 0 strict "no solid type 4 12 accuracy high" also "dump powers all custom 1 $work/powers id f_rad"
powers_near "$work/conduct.csv" "$work/powers" "powers of particles that conduct are those of fibrad heat"
for np in 1 2; do
    run $np conducts$np frozen.lmp "${whole[@]}" strict "no solid 10"
done
near "$work/conducts1.out" "$work/conducts2.out" 1e-8 "a bed that conducts, np 1 and 2"
run 1 conductor frozen.lmp "${whole[@]}" strict "no solid 1e9"
near "$work/frozen1.out" "$work/conductor.out" .01 "particles of a good conductor"

# ---- walls of triangles -------------------------------------------------------------------------------------------------
box 6.499 20 >"$work/box.stl"
planes=
for side in xmin xmax ymin ymax zmin zmax; do
    case $side in *min) at=0 ;; zmax) at=20 ;; *) at=6.499 ;; esac
    planes="$planes wall $side temperature 1000 emissivity 0.9 at $at"
done
many="accuracy high" # so that the noise of wall powers is 8e-4 at most
for np in 1 2 4; do
    run $np mesh$np mesh.lmp data "$work/quarter.data" walls "wall mesh $work/box.stl temperature 1000 emissivity 0.9 solids name box"
done
run 2 triangles mesh.lmp data "$work/quarter.data" walls "wall mesh $work/box.stl temperature 1000 emissivity 0.9 solids name box $many"
run 2 planes mesh.lmp data "$work/quarter.data" walls "$planes $many"
# without a lid: as with a black one at the temperature of the surroundings, where the bed ends or higher up
sides=${planes% wall zmax*}
gained="f_rad f_rad[6] f_rad[7] f_rad[8] f_rad[9] f_rad[10]"
for np in 1 2; do
    run $np open$np mesh.lmp data "$work/quarter.data" walls "$sides wall zmax open at 20" shown "$gained f_rad[1]"
done
run 1 lid mesh.lmp data "$work/quarter.data" walls "$sides wall zmax temperature 300 emissivity 1 at 20"
run 2 rim mesh.lmp data "$work/quarter.data" walls "$sides wall zmax open" shown "$gained f_rad[1]"
test -n "$(grep -A1 '^ *Step' "$work/rim.log")" && near "$work/lid.out" "$work/open1.out" 1e-10 "a bed without a lid" &&
    near "$work/open1.out" "$work/open2.out" 1e-10 "a bed without a lid, np 1 and 2"
top=$(awk '/zlo zhi/ { print $2 }' "$work/quarter.data")
run 2 face mesh.lmp data "$work/quarter.data" walls "$sides wall zmax open at $top" shown "$gained f_rad[1]"
near "$work/face.out" "$work/rim.out" 1e-300 "an opening lies at the face of the box, $top"
grep -q 'f_rad: \[1\] surroundings by opening zmax,.*, \[10\] wall zmin, \[11\] outside.*, \[18\] T of wall zmin' "$work/rim.log"
verdict "elements of the output are named" $?
run 1 endless mesh.lmp data "$work/quarter.data" walls "$sides" shown "$gained"
grep -q 'zmax open' "$work/endless.log"
verdict "a bed without a lid and without an opening is refused" $?
# walls NAME: step, the powers of particles and six walls, when the run begins
walls() { awk '$1 == "Step" { getline; print; exit }' "$work/$1.log"; }
test -n "$(walls mesh1)" && test "$(walls mesh1)" = "$(walls mesh2)" && test "$(walls mesh1)" = "$(walls mesh4)" &&
    near "$work/mesh1.out" "$work/mesh4.out" 1e-10 "a box of triangles, np 1 and 4"
verdict "walls of triangles, np 1, 2, 4: the same powers" $?
found=$({ walls triangles && walls planes; } | awk 'NR == 1 { for (k = 2; k < 9; k++) p[k] = $k; next }
    { all = $2/p[2] - 1; for (k = 3; k < 8; k++) { d = ($k - p[k])/$k; if (d < 0) d = -d; if (d > worst) worst = d } }
    END { printf "particles %.2g, walls %.2g", all, worst; exit !(NR == 2 && all*all < 25e-8 && worst < .002) }')
verdict "a box of triangles has the powers of planes ($found)" $?
# a floor that two triangles are, across a box that is periodic and twice as wide as the bed
box 12 20 | sed -n '/solid zlo/,/endsolid/p' >"$work/floor.stl"
for np in 1 2; do
    run $np floor$np frozen.lmp data "$work/quarter.data" boundary "p p f" floor "mesh $work/floor.stl temperature 1000 emissivity 0.9" steps 5 \
        strict "no accuracy high"
done
near "$work/floor1.out" "$work/floor2.out" 1e-10 "a floor of triangles in a periodic box, np 1 and 2"
grep -q 'floor.stl: the mesh is not closed: 4 edges' "$work/floor2.log" && ! grep -q 'WARNING: fix fibrad' "$work/floor2.log"
verdict "a floor of triangles is not closed, which is no warning" $?
run 1 flat frozen.lmp data "$work/quarter.data" boundary "p p f" steps 5 strict "no accuracy high"
found=$({ walls floor1 && walls flat; } | awk 'NR == 1 { p = $2; next } { d = $2/p - 1; printf "%.2g", d } END { exit !(NR == 2 && d*d < 1e-4) }')
verdict "particles above a floor of triangles have the power of those above a plane ($found)" $?
grep -q 'f_rad\[7\] is of wall box_xhi, 2 triangles' "$work/mesh2.log"
verdict "walls of triangles are named" $?

# ---- meshes that move ---------------------------------------------------------------------------------------------------
# placed X Y Z: an STL file whose corner x, y, z goes to the place that these expressions give
placed() {
    awk "/vertex/ { x = \$2; y = \$3; z = \$4; print \"vertex\", $1, $2, $3; next } { print }" CONVFMT=%.17g OFMT=%.17g
}
# last NAME: step and powers at the end of the run
last() { awk '$1 == "Step" { n = 1; next } /^Loop/ { n = 0 } n && /^ *[0-9]/ { line = $0 } END { print line }' "$work/$1.log"; }
# moves NAME WHAT HOME MOVED SIDES MOTION [NAME VALUE]...: the rows of step 5, at the time 500, are those of a file of the moved
# triangles
moves() {
    local name=$1 what=$2 sides=$5 motion=$6
    local still=(data "$work/quarter.data" every 5 cp 1e30 "${@:7}")
    run 1 "$name" mesh.lmp "${still[@]}" walls "wall mesh $work/$4.stl temperature 1000 emissivity 0.9 $sides"
    for np in 1 2; do
        run $np "$name$np" mesh.lmp "${still[@]}" walls "wall mesh $work/$3.stl temperature 1000 emissivity 0.9 $sides $motion"
        found=$({ last "$name" && last "$name$np" && walls "$name$np"; } | awk '
            { for (k = 2; k <= NF; k++) if (NR == 1) p[k] = $k; else { d = $k/p[k] - 1; off[NR] += d*d } }
            END {
                printf "%.2g; before the motion %.2g", sqrt(off[2]), sqrt(off[3])
                exit !(NR == 3 && off[2] < 1e-18 && off[3] > 1e-4) }')
        verdict "$what, np $np ($found)" $?
    done
}
placed 6.499-y x z <"$work/box.stl" >"$work/box_turned.stl"
moves quarter "a box after a quarter of a turn" box box_turned solids "rotate 0 0 3 2000 about 3.2495 3.2495 -7"
# a third of a turn about 1 1 1 exchanges coordinates
placed y-6 z-1 x+2 <"$work/box.stl" >"$work/box_away.stl"
moves third "a box after a third of a turn and a way" box_away box "solids both" \
    "velocity 0 0.01 0 rotate 1 1 1 1500 about 1 2 3"
box 3 20 | sed -n '/solid zlo/,/endsolid/p' | placed x y z-1 >"$work/plate.stl"
placed x+3 y+6 z <"$work/plate.stl" >"$work/plate_away.stl"
moves travels "a plate that has crossed a periodic box 31 times" plate plate_away both "velocity 0.75 -0.756 0" \
    boundary "p p f" shown "f_rad f_rad[1] f_rad[6]"
# LAMMPS of 2021 begins again with the time 0
turning="mesh $work/box_away.stl temperature 1000 emissivity 0.9 both rotate 1 1 1 -700"
run 2 turning frozen.lmp "${whole[@]}" every 5 steps 10 floor "$turning" also "restart 5 $work/turning.*"
run 1 turned frozen.lmp data "$work/turning.5" cutoff 4000 restarted yes every 5 steps 5 floor "$turning"
near "$work/turning.out" "$work/turned.out" 1e-10 "a mesh that turns, restarted"
run 1 turned_on frozen.lmp "${whole[@]}" every 5 steps 5 floor "$turning" also "run 5"
near "$work/turning.out" "$work/turned_on.out" 1e-10 "a mesh that turns in two runs"
! run 1 moving_rerun rerun.lmp data "$work/quarter.data" wall "$turning" && grep -q 'meshes cannot move' "$work/moving_rerun.log"
verdict "a mesh that moves in a rerun is refused" $?

# ---- cylinders along all axes -------------------------------------------------------------------------------------------
# laid AXIS: a dump with its axes turned cyclically so that z becomes x, y or z
laid() {
    awk -v axis="$1" '
        BEGIN { split(axis == "x" ? "3 1 2" : axis == "y" ? "2 3 1" : "1 2 3", from, " ") }
        /BOX BOUNDS/ { box = 1 }
        box && NF == 2 { side[box++] = $0; if (box == 4) print side[from[1]] "\n" side[from[2]] "\n" side[from[3]]; next }
        /^[0-9]+ 1 / { for (k = 1; k < 4; k++) at[k] = $(2 + from[k]); for (k = 1; k < 4; k++) $(2 + k) = at[k] }
        { print }'
}
# one bed in a tube between a floor and an opening, in a tube without ends, and in a tube that triangles close
printf 'solid %s\n facet normal 0 0 0\n outer loop\n vertex -9 -9 %s\n vertex 20 -9 %s\n vertex 5 25 %s\n endloop\n endfacet\nendsolid\n' \
    low 0 0 0 high 13.6 13.6 13.6 >"$work/caps.stl"
sed 's/^0[^ ]* 5[^ ]*$/0 13.5/' "$work/quarter.dump" >"$work/period.dump"
for axis in z x y; do
    laid $axis <"$work/quarter.dump" | as_data - >"$work/laid.data"
    laid $axis <"$work/period.dump" | as_data - >"$work/period.data"
    case $axis in
        x) ends="p f f" at="3.25 3.4" to="z x y" ;;
        y) ends="f p f" at="3.4 3.25" to="y z x" ;;
        z) ends="f f p" at="3.25 3.4" to="x y z" ;;
    esac
    # shellcheck disable=SC2086  # three words
    placed $to <"$work/caps.stl" >"$work/caps.$axis.stl"
    tube="wall ${axis}cylinder $at 4.6 temperature 600 emissivity 0.8"
    low="wall ${axis}min temperature 1000 emissivity 0.9 at 0"
    caps="wall mesh $work/caps.$axis.stl temperature 1000 emissivity 0.9 both wall ${axis}min open at -1 wall ${axis}max open at 15"
    # along x and y rows have other directions than along z, so temperatures and powers agree within errors
    case $axis in z) numbers="1 2" most=1e-10 off=1e-10 ;; *) numbers=2 most=6 off=.04 ;; esac
    for np in $numbers; do
        run $np "tube$axis$np" mesh.lmp data "$work/laid.data" walls "$tube $low wall ${axis}max open at 20" shown "f_rad f_rad[1] f_rad[6] f_rad[7]"
        run $np "endless$axis$np" mesh.lmp data "$work/period.data" boundary "$ends" walls "$tube" shown "f_rad f_rad[6]"
        run $np "caps$axis$np" mesh.lmp data "$work/laid.data" walls "$tube $caps" shown "f_rad f_rad[6] f_rad[7]"
        for bed in tube endless caps; do
            near "$work/${bed}z1.out" "$work/$bed$axis$np.out" $most "a bed in ${axis}cylinder, $bed, np $np"
            found=$({ walls ${bed}z1 && walls "$bed$axis$np"; } | awk -v off=$off 'NR == 1 { for (k = 2; k <= NF; k++) p[k] = $k; next }
                { for (k = 2; k <= NF; k++) { d = $k/p[k] - 1; if (!(d*d < worst*worst)) worst = d } print worst }
                END { exit !(NR == 2 && NF > 2 && worst*worst < off*off) }')
            verdict "its powers and those of its walls ($found)" $?
        done
    done
done
"$BUILD/fibrad" heat "$work/quarter.csv" --emissivity 1:.5,2:.8 --temperature T --ambient 300 --length-unit m \
    --wall zmin:at=0:temperature=1000:emissivity=.9,zmax:open:at=20,cylinder:3.25,3.4,4.6:temperature=600:emissivity=.8 \
    --directions 600 -o "$work/tube.csv" >/dev/null 2>&1
laid x <"$work/quarter.dump" | as_data - >"$work/laid.data"
run 2 tube frozen.lmp data "$work/laid.data" steps 0 strict "no accuracy high" also "dump powers all custom 1 $work/powers id f_rad" \
    floor "xcylinder 3.25 3.4 4.6 temperature 600 emissivity 0.8 wall xmin temperature 1000 emissivity 0.9 at 0 wall xmax open at 20"
powers_near "$work/tube.csv" "$work/powers" "powers in xcylinder are those of fibrad heat"

# ---- moving particles -------------------------------------------------------------------------------------------------
run 2 moving moving.lmp hot 1000
balance moving 20e-3 0 1e-3 500 "energy of moving particles"
awk '/^[0-9]/ { n++; d = ($2 - $3)^2; if (d > worst) worst = d; if ($3^2 > most) most = $3^2 }
    END { exit !(n > 300 && most > 0 && worst < 1e-24*most) }' "$work/moving.out.power"
verdict "powers move with their particles" $?
awk '/TIMESTEP/ { frame++ } NF == 2 && /^[0-9]+ / { if (frame == 1) rank[$1] = $2; else if (frame == 3 && rank[$1] != $2) moved++ }
    END { exit !(moved > 20) }' "$work/moving.out.rank"
verdict "particles changed ranks" $?
run 4 equal moving.lmp hot 300 steps 2000
awk 'NF == 2 && /^[0-9]+ / { n++; if ($2 != 300) bad++ } END { exit !(n && !bad) }' "$work/equal.out"
verdict "equal temperatures stay equal to the bit" $?

# ---- temperatures of walls in time --------------------------------------------------------------------------------------
for floor in 1000 v_hot; do
    run 2 "steady.$floor" frozen.lmp "${whole[@]}" steps 3 floor "zmin temperature $floor emissivity 0.9 at 0"
done
run 2 rising frozen.lmp "${whole[@]}" steps 10 floor "zmin temperature v_hot emissivity 0.9 at 0" rise 100
near "$work/steady.1000.out" "$work/steady.v_hot.out" 1e-300 "a wall with a constant variable"
awk '$1 == "Step" { n = 1 } n && $1 == 0 { first = $4 } n && $1 == 10 { last = $4; n = 0 }
    END { exit !(last/first > 10) }' "$work/rising.log"
verdict "a wall that a variable heats" $?

# ---- walls that store heat ----------------------------------------------------------------------------------------------
# floor NAME: its temperature at the last step
floor() { awk '$1 == "Step" { n = 1 } n && NF == 5 && $1 ~ /^[0-9]/ { t = $5 } /^Loop/ { n = 0 } END { print t + 0 }' CONVFMT=%.17g OFMT=%.17g "$work/$1.log"; }
"$BUILD/tests/couple/serial_bed" 50 20 100 1e7 <"$work/quarter" >"$work/serial_floor.out"
stores="zmin temperature 1000 emissivity 0.9 at 0 capacity 1e7"
for np in 1 2 4; do
    run $np stores$np frozen.lmp "${whole[@]}" floor "$stores"
    near "$work/serial_floor.out" "$work/stores$np.out" 1e-10 "a floor that stores heat against one scene, np $np"
    awk -v t="$(floor stores$np)" '$1 == "floor" { d = $2 - t; printf "%.2g", d; exit !(d*d < 1e-20 && $2 < 990) }' \
        "$work/serial_floor.out" >"$work/floor.error"
    verdict "its temperature, np $np ($(cat "$work/floor.error") K)" $?
done
run 2 stored frozen.lmp "${whole[@]}" floor "$stores" steps 25 also "restart 25 $work/floor.*"
run 4 restored frozen.lmp data "$work/floor.25" cutoff 4000 restarted yes steps 25 floor "$stores"
near "$work/stores1.out" "$work/restored.out" 1e-10 "a floor that stores heat, restarted"
run 2 warming moving.lmp hot 1000 steps 4000 capacity "capacity 2e4 contacts 20 hertz gas .1" stored 2e4
balance warming 20e-3 0 1e-3 150 "energy of moving particles with contacts and a floor that stores heat"

# ---- contacts -----------------------------------------------------------------------------------------------------------
# closed EXPLICIT STEPS STEP [LESS]: temperatures of contacts.lmp by eigenvectors of the chain and differences of pairs: after explicit
# steps, or in continuous time. The floor counts as ball 14, and conducts LESS times less
closed() {
    awk -v OFMT=%.17g -v explicit="$1" -v steps="$2" -v step="$3" -v floor="${4:-1}" '
        function left(rate) { return explicit ? exp(steps*log(1 - rate*step)) : exp(-rate*step*steps) }
        function mass(r) { return 2500*4/3*pi*r^3*800 } # its heat capacity
        # Hertz, scaled by .9; other 0: a wall
        function spot(r, other, d) { return .9*sqrt((other ? r*other/(r + other) : r)*(r + other - d)) }
        function pair(a, b, ca, cb, h, name,    mean, off) {
            mean = (ca*a + cb*b)/(ca + cb); off = (a - b)*left(h*(1/ca + 1/cb))
            print name, mean + off*cb/(ca + cb); print name + 1, mean - off*ca/(ca + cb)
        }
        BEGIN {
            pi = 4*atan2(1, 1); n = 10; big = mass(.5)
            for (i = 1; i <= n; i++) t[i] = 300
            t[1] = 900; t[4] = 600
            rate = 2*200*spot(.5, .5, .96)/big
            for (k = 0; k < n; k++) for (i = 1; i <= n; i++) c[k] += t[i]*cos(k*pi*(i - .5)/n)*(k ? 2 : 1)/n
            for (i = 1; i <= n; i++) {
                sum = 0
                for (k = 0; k < n; k++) sum += c[k]*cos(k*pi*(i - .5)/n)*left(2*rate*(1 - cos(k*pi/n)))
                print i, sum
            }
            pair(500, 300, big, mass(.3), 2*240*spot(.5, .3, .7), 11)
            pair(300, 700, big, 1e6, 4*200*spot(.5, 0, .47)/floor, 13)
        }'
}
# with_floor NAME: temperatures at the end, the floor as ball 14
with_floor() {
    awk 'NF == 2 && /^[0-9]+ /' "$work/$1.out"
    awk '$1 == "Step" { n = 1 } /^Loop/ { n = 0 } n && /^ *[0-9]/ { t = $5 } END { print 14, t }' "$work/$1.log"
}
run 1 contacts1 contacts.lmp
run 1 contacts_half contacts.lmp step 0.5 steps 4000
with_floor contacts1 >"$work/contacts1"
with_floor contacts_half >"$work/contacts_half"
closed 1 1000 2 >"$work/explicit"
near "$work/explicit" "$work/contacts1" 1e-9 "contacts of chains, pairs and a floor, by closed forms of explicit steps"
closed 0 1000 2 >"$work/continuous"
paste -d ' ' "$work/contacts1" "$work/contacts_half" | awk '{ print $1, 2*$4 - $2 }' CONVFMT=%.17g OFMT=%.17g >"$work/extrapolated"
near "$work/continuous" "$work/extrapolated" 1e-5 "the same in continuous time"
run 2 contacts2 contacts.lmp newton off also "restart 1000 $work/contacts.*"
run 4 contacts4 contacts.lmp restarted yes data "$work/contacts.1000" steps 1000
for np in 2 4; do
    with_floor contacts$np | cmp - "$work/contacts1"
    verdict "contacts without radiation, np $np: the same bits" $?
done
# LAMMPS rounds coordinates when it balances
run 2 contacts_moved contacts.lmp also "fix b all balance 10 1.0 shift y 10 1.01"
near "$work/contacts1.out" "$work/contacts_moved.out" 1e-10 "contacts, balance during the run"

# ---- clumps -----------------------------------------------------------------------------------------------------------
# power_is NAME WATT ERROR WHAT: what the particles lose at first, to the surroundings
power_is() {
    found=$(awk '$1 == "Step" { getline; print substr($2, 2), $3, $4 }' "$work/$1.log")
    echo "$found" | awk -v want="$2" -v error="$3" '{ off = $1/want - 1 } END { exit !(off*off < error*error && ($1 - $2)^2 < 1e-26*$1*$1 && $3 == 0) }'
    verdict "$4 ($found)" $?
}
# two balls of radius 1, d apart, 1000 K, black: sigma T^4 A (1 - F), A = 2 pi (2 + d), 1 - F = 4 <shadow>/A
lens() {
    awk -v d="$1" 'BEGIN {
        pi = atan2(0, -1)
        for (k = 0; k < 20000; k++) {
            x = d*sqrt(1 - ((k + .5)/20000)^2)
            sum += 2*pi - 2*atan2(sqrt(4 - x*x), x) + x/2*sqrt(4 - x*x)
        }
        printf "%.10g", 4*sum/20000*5.670374419e-8*1e12 }'
}
for apart in 0.5 0.9 1.8; do
    run 1 pair clumps.lmp apart $apart run 0
    power_is pair "$(lens $apart)" 1e-6 "a black clump of two balls, $apart radii apart"
done
for e in 1 .6 .3; do
    printf '%s\n' x,y,z,r,mol,T 0,0,0,1,7,1000 .9,0,0,1,7,1000 .3,.8,0,1,7,1000 .4,-2.3,.4,.8,0,400 .4,.1,3,.8,0,400 >"$work/clumps.csv"
    "$BUILD/fibrad" heat "$work/clumps.csv" --clump mol --temperature T --emissivity $e --ambient 0 --error 0.0003 -o "$work/heat.csv" >"$work/heat.log" 2>&1
    run 1 three clumps.lmp more yes e $e run 0
    power_is three "$(awk -F, '$1 == -1 { print $3 }' "$work/heat.csv")" 5e-4 "a clump of three of emissivity $e beside balls, as by fibrad heat"
done
floor="wall zmin temperature 900 emissivity .7 at -1.6 wall zmax open wall xmin insulated wall xmax open wall ymin open wall ymax open"
for words in "accuracy high" "accuracy low convection 20 500" "$floor" "cutoff 8"; do
    for np in 1 2 4; do
        run $np clumps$np clumps.lmp more yes e .6 words "clump mol $words"
        cmp "$work/clumps1.out" "$work/clumps$np.out"
        verdict "clumps with ${words%%zmax*}, np $np: the same bits" $?
        awk 'NF == 2 && $1 > 0 && $1 < 4 { n++; if (n > 1 && $2 != t) bad = 1; t = $2 } END { exit !(n == 3 && t < 1000 && !bad) }' "$work/clumps$np.out"
        verdict "clumps with ${words%%zmax*}, np $np: one temperature" $?
    done
done
for np in 1 2; do
    run $np rigid$np rigid.lmp
    found=$(awk '$1 == "Step" { on = 1; next } /^Loop/ { on = 0 }
        on && /^ *[0-9]/ { if (n++) gained += .02*($4 + $5); else first = $2; last = $2; off = $3 + $4 + $5; if (off*off > 1e-26*($4*$4 + $5*$5)) bad = 1 }
        END { error = (last - first + gained)/last; printf "%.2g", error; exit !(n == 51 && !bad && error*error < 1e-26 && last < .999*first) }' "$work/rigid$np.log")
    verdict "clumps that fall, np $np: energy ($found)" $?
    awk 'NF == 2 && /^[0-9]+ [0-9.]+$/ { if ($1 in t && t[$1] != $2) bad = 1; t[$1] = $2; n++ } END { exit !(n == 20 && !bad) }' "$work/rigid$np.out.mol"
    verdict "clumps that fall, np $np: one temperature each" $?
done
near "$work/rigid1.out" "$work/rigid2.out" 1e-6 "clumps that fall, np 1 and 2"
# wrong NAME MESSAGE [NAME VALUE]...: a run of clumps ends with this message
wrong() {
    local what=$1
    shift
    run 2 wrong clumps.lmp more yes "$@" && false
    cat "$work/wrong.err" "$work/wrong.log" | grep -q "^ERROR.*$what"
    verdict "clumps: $what" $?
}
wrong "particle 2: the members of its clump 7 have different temperatures" also "set atom 2 d_T 900"
wrong "particle 2: the members of its clump 7 have different emissivities" also "set atom 2 type 2" e "type .6 .5"
wrong "leave out .contacts" words "clump mol contacts 4"
wrong "without .solid" words "clump mol solid 4"
wrong "followed by mol" words "clump d_T"
wrong "the time step must be at most" also "timestep 1e6"

# ---- gas ----------------------------------------------------------------------------------------------------------------
# explicit steps of heat: each leaves 1 - h A t/C of the difference
awk -v OFMT=%.17g 'BEGIN {
    for (i = 1; i <= 2; i++) print i, 300 + 50*i + (i == 1 ? 550 : 200)*(1 - 25*3/(i == 1 ? .5 : .3)*20/(2500*800))^1000 }' >"$work/cooled"
for film in "25 d_gas" "d_h v_gas" "v_h type 350 400"; do
    for np in 1 2; do
        run $np gas$np film.lmp film "$film"
        near "$work/cooled" "$work/gas$np.out" 1e-9 "convection $film, np $np, by explicit steps"
    done
    cmp "$work/gas1.out" "$work/gas2.out"
    verdict "convection $film: the same bits" $?
    awk 'NF == 4 && /^ *[0-9]/ && $1 % 100 == 0 { n++; off = $2 + $3 + $4; if (off*off > 1e-26*$2*$2 || $2 == 0) bad = 1 }
        END { exit !(n > 20 && !bad) }' "$work/gas2.log"
    verdict "convection $film: what the gas loses is what balls gain" $?
done
echo "fix sums all ave/time 1 1 1 f_rad f_rad[1] f_rad[6] f_rad[14] file $work/sums format ' %.17g'" >"$work/sums.lmp"
run 2 gas_floor frozen.lmp "${whole[@]}" strict "no convection 5 400" also "include $work/sums.lmp"
awk '/^[0-9]/ { n++; off = $2 + $3 + $4 + $5; most = $2*$2 + $3*$3 + $4*$4 + $5*$5; if (off*off > 1e-26*most || $5 == 0) bad = 1 }
    END { exit !(n > 40 && !bad) }' "$work/sums"
verdict "convection beside radiation" $?

# a floor of two triangles conducts as a plane does
{
    printf 'solid floor\n'
    for corners in "11 -1 0|11 13 0" "11 13 0|-1 13 0"; do
        printf 'facet normal 0 0 1\nouter loop\nvertex -1 -1 0\nvertex %s\nvertex %s\nendloop\nendfacet\n' "${corners%|*}" "${corners#*|}"
    done
    printf 'endsolid floor\n'
} >"$work/floor.stl"
for np in 1 2; do
    run $np contacts_mesh contacts.lmp floor "mesh $work/floor.stl temperature 700 emissivity 0 capacity 1e6 both"
    with_floor contacts_mesh >"$work/contacts_mesh"
    near "$work/contacts1" "$work/contacts_mesh" 1e-9 "contacts with a floor of triangles, np $np"
done
# a floor of the conductivity of the ball conducts half as much
run 2 contacts_wall contacts.lmp conducts "type 200 300 hertz scale 0.9 wall 200"
with_floor contacts_wall >"$work/contacts_wall"
closed 1 1000 2 2 >"$work/half"
near "$work/half" "$work/contacts_wall" 1e-9 "contacts with a floor of a conductivity of its own"

# beside radiation: what contacts bring is what fibrad heat says
"$BUILD/fibrad" heat "$work/quarter.csv" --emissivity 1:.5,2:.8 --temperature T --ambient 300 --wall zmin:at=0:temperature=1000 \
    --contacts lens --contact-conductivity 1:4,2:12 --gas-conductivity .03 --directions 50 --length-unit m -o "$work/touch.csv" >/dev/null 2>&1
for words in "" "contacts type 4 12 gas .03"; do
    name=${words:+touch}
    {
        echo "dump powers all custom 1 $work/${name:=alone}.dump id f_rad"
        echo 'dump_modify powers format float %.17g'
    } >"$work/touch.lmp"
    run 2 "$name" frozen.lmp "${whole[@]}" steps 0 strict "no $words" also "include $work/touch.lmp"
done
found=$(awk -F'[ ,]' 'FNR == 1 { file++ } FNR == 1 && file == 1 { for (k = 1; k <= NF; k++) if ($k == "q_conduction_W") c = k }
    file == 1 && $1 ~ /^[0-9]/ { q[$1] = $c } file == 2 && NF == 2 { alone[$1] = $2 } file == 3 && NF == 2 && $1 in q {
        d = ($2 - alone[$1] - q[$1])^2; if (d > worst) worst = d; if (q[$1]^2 > most) most = q[$1]^2; n++ }
    END { printf "%.2g", sqrt(worst/most); exit !(n == 499 && worst < 1e-16*most) }' \
    "$work/touch.csv" "$work/alone.dump" "$work/touch.dump")
verdict "what contacts and gas bring is what fibrad heat says ($found)" $?

# the same with a table for the gas, and bits of a table of one value
printf 'T [K],k [W/(m K)]\n300,.02\n700,.05\n1500,.06\n' >"$work/gas.csv"
printf '300 .03\n900 .03\n' >"$work/flat.csv"
"$BUILD/fibrad" heat "$work/quarter.csv" --emissivity 1:.5,2:.8 --temperature T --ambient 300 --wall zmin:at=0:temperature=1000 \
    --contacts lens --contact-conductivity 1:4,2:12 --gas-conductivity "@$work/gas.csv" --directions 50 --length-unit m \
    -o "$work/tabled.csv" >/dev/null 2>&1
for gas in gas flat; do
    sed "s/touch.dump/tabled.$gas/" "$work/touch.lmp" >"$work/tabled.lmp"
    run 2 tabled frozen.lmp "${whole[@]}" steps 0 strict "no contacts type 4 12 gas @$work/$gas.csv" also "include $work/tabled.lmp"
done
cmp "$work/touch.dump" "$work/tabled.flat"
verdict "a table of one value for the gas: the same bits" $?
found=$(awk -F'[ ,]' 'FNR == 1 { file++ } FNR == 1 && file == 1 { for (k = 1; k <= NF; k++) if ($k == "q_conduction_W") c = k }
    file == 1 && $1 ~ /^[0-9]/ { q[$1] = $c } file == 2 && NF == 2 { alone[$1] = $2 } file == 3 && NF == 2 && $1 in q {
        d = ($2 - alone[$1] - q[$1])^2; if (d > worst) worst = d; if (q[$1]^2 > most) most = q[$1]^2; n++ }
    END { printf "%.2g", sqrt(worst/most); exit !(n == 499 && worst < 1e-16*most) }' \
    "$work/tabled.csv" "$work/alone.dump" "$work/tabled.gas")
verdict "what contacts and gas of a table bring is what fibrad heat says ($found)" $?

# ---- errors of powers, and rows by the distance moved ------------------------------------------------------------------
# scatter NAME WHAT WORDS: how powers of eight seeds part from their mean, against their errors
scatter() {
    local name=$1 seed
    for seed in 1 2 3 4 5 6 7 8; do
        echo "dump errors all custom 1 $work/$name.$seed id f_rad[1] f_rad[3]" >"$work/errors.lmp"
        run 2 "$name" frozen.lmp data "$work/quarter.data" steps 0 floor "$hot" strict "no errors yes seed $seed $3" \
            also "include $work/errors.lmp"
    done
    found=$(awk 'FNR > 9 { n[$1]++; q[$1, n[$1]] = $2; e[$1, n[$1]] = $3; sum[$1] += $2 }
        END {
            for (k in n) for (s = 1; s <= n[k]; s++) {
                off = (q[k, s] - sum[k]/n[k])^2*8/7; all++
                beyond += off > 4*e[k, s]^2; squares += off; estimates += e[k, s]^2
            }
            printf "%.2g %% beyond twice the error, which is %.2g times as wide", 100*beyond/all, sqrt(estimates/squares)
            exit !(all == 8*499 && beyond < .05*all && estimates < 16*squares)
        }' "$work/$name".[1-8])
    verdict "errors of powers, $2 ($found)" $?
}
hot="zmin temperature 2000 emissivity 0.9 at 0"
scatter over "an endless floor" ""
scatter within "a tolerance" "tolerance 0.02"
scatter inside "particles that conduct" "solid 5"
run 2 errors frozen.lmp data "$work/quarter.data" cutoff 3 steps 0 strict "no errors yes"
grep -q 'of atoms: \[1\] power, \[2\] beyond, \[3\] error' "$work/errors.log"
verdict "values of atoms are named" $?
grep -q 'WARNING: fix fibrad: what lies beyond the cutoff 3 could change the power of .* by [0-9.]* %, at step 0; take a larger .cutoff' "$work/errors.log"
verdict "a warning of what a cutoff could change" $?
run 2 moved moving.lmp hot 1000 steps 200 capacity "moved 0.1"
run 1 still frozen.lmp "${whole[@]}" steps 3 every 1000 strict "no moved 0.001"
moved_rows=$(sed -n 's/.*rows made \([0-9]*\) times.*/\1/p' "$work/moved.log")
balance moved 20e-3 0 1e-9 9 "energy with rows by the distance moved, made $moved_rows times"
test "$moved_rows" -gt 2 && grep -q 'rows made 1 times' "$work/still.log"
verdict "rows are made anew when particles have moved" $?

# ---- tables over temperature --------------------------------------------------------------------------------------------
# table NAME T VALUE T VALUE
table() { printf '# of the test\nT,value\n%s,%s\n%s,%s\n' "$2" "$3" "$4" "$5" >"$work/$1"; }
table half 300 .5 900 .5
table most 300 .8 900 .8
table constant 300 800 900 800
run 2 tables frozen.lmp "${whole[@]}" cp "@$work/constant" radiates "type @$work/half @$work/most"
near "$work/frozen1.out" "$work/tables.out" 1e-10 "tables of one value"
table steep 300 .2 700 .8
run 1 steep frozen.lmp "${whole[@]}" steps 0 radiates "@$work/steep" also "set group all d_T 600"
run 1 number frozen.lmp "${whole[@]}" steps 0 radiates .65 also "set group all d_T 600"
test -n "$(walls steep)" && test "$(walls steep)" = "$(walls number)"
verdict "an emissivity of a table" $?
table warmer 300 .02 1000 .04
run 2 tabled moving.lmp hot 1000 steps 4000 cp "@$work/warmer" enthalpy "0.02*(c_T-300)+0.01/700*(c_T-300)^2"
balance tabled 20e-3 0 1e-3 150 "energy of moving particles with a table of cp"

# ---- two groups -----------------------------------------------------------------------------------------------------------
run 1 both frozen.lmp "${whole[@]}" steps 1
sed -n '/^Temperatures/,$p' "$work/quarter.data" >"$work/begin"
for np in 1 2; do
    run $np group$np frozen.lmp "${whole[@]}" steps 1 group odd strict "no group2 even"
    grep -E '^[0-9]*[13579] ' "$work/both.out" | cat - <(grep -E '^[0-9]*[02468] ' "$work/begin") >"$work/expected"
    near "$work/expected" "$work/group$np.out" 1e-10 "a second group is seen and keeps its temperatures, np $np"
done

# ---- strays -----------------------------------------------------------------------------------------------------------
# LAMMPS goes on with centres inside others and beyond walls. So does radiation.
run 2 soft soft.lmp strict "no contacts 0.01 gas 0.001"
balance soft 10e-3 0 1e-3 90 "energy of particles inside one another and beyond a wall"
awk '/^[0-9]/ { if ($4 > 0) left++; if ($5 > 0) smaller++ } END { exit !(left && smaller) }' "$work/soft.out.balance" &&
    test "$(grep -c 'left out until back; particle [0-9]* at .* beyond wall 1, zmin' "$work/soft.log")" -eq 1 &&
    test "$(grep -c 'the centre of one lies inside the other' "$work/soft.log")" -eq 1
verdict "strays are counted and told of once" $?
# cases as LAMMPS' own examples, with the three lines of the fix
for case in chute drum hopper; do
    run 2 "$case" "$case.lmp" && ! grep -q "^ERROR" "$work/$case.log" && balance "$case" 10e-3 0 1e-3 200 "energy in a $case"
    verdict "a $case to its end" $?
done
# half a drum that stores heat and turns once, from step 1500 to 3500. Its temperature follows from factors of `fibrad factors`
# of frames, too, among triangles that are laid out anew. Both hold factors for 250 steps
# shell STEP: 12 of 24 facets
shell() {
    awk -v from="$1" -v pi=3.14159265358979 'BEGIN {
        print "solid shell"
        for (k = 0; k < 12; k++) for (t = 0; t < 2; t++) {
            print "facet normal 0 0 0\nouter loop"
            for (c = 0; c < 3; c++) {
                angle = (from/1000 + (k + (t ? c > 0 : c == 1))/12)*pi
                print "vertex", 5 + 5*cos(angle), 5 + 5*sin(angle), (t ? c == 1 : c > 0) ? 0 : 8
            }
            print "endloop\nendfacet"
        }
        print "endsolid" }' CONVFMT=%.17g OFMT=%.17g
}
shell 0 >"$work/shell.stl"
run 2 shell drum.lmp wall "mesh $work/shell.stl temperature 1000 emissivity 0.7 both rotate 0 0 2 2 about 5 5 0 capacity 20" stored 20 rows 250
balance shell 10e-3 0 1e-5 200 "energy in a drum of triangles that turns and stores heat"
# heat FRAME STEP: what particles and surroundings send to the shell, and what it sends to them at 1 K
heat() {
    shell "$2" >"$work/turned.stl"
    "$BUILD/fibrad" factors "$1" --emissivity .8 --wall "mesh:$work/turned.stl:both:emissivity=.7" --raw --quiet \
        --directions 150 -o "$work/factors.csv" 2>/dev/null
    awk -F'[ ,]' -v both="$(awk 'BEGIN { print 2*12*8*2*5*sin(atan2(1, 1)/6) }')" '
        NR == FNR && NF >= 6 && $1 ~ /^[0-9]/ { area[$1] = 16*atan2(1, 1)*$5^2; e[$1] = 1e-11*$6^4 }
        NR > FNR && $1 > 0 && $4 == "turned" { weight = area[$1]*.8*$3; sum += weight*e[$1]; all += weight*1e-11 }
        $4 == "turned:surroundings" { weight = both*.7*$3; sum += weight*1e-11*300^4; all += weight*1e-11 }
        END { print sum, all }' CONVFMT=%.17g OFMT=%.17g "$1" "$work/factors.csv"
}
for step in $(seq 1500 250 3250); do heat "$work/shell.out.frame.$step" "$step"; done >"$work/heats"
# temperatures of the shell at steps 1500 and 3500
shell_kelvins=$(awk '$1 ~ /^(1500|3500)$/ && NF > 10 { t[$1] = $(NF - 4) } END { print t[1500], t[3500] }' "$work/shell.log")
found=$(awk -v kelvins="$shell_kelvins" '
    NR == 1 { split(kelvins, of); begin = t = of[1] }
    { for (k = 0; k < 25; k++) t += ($1 - $2*t^4)*.01/20 }
    END {
        off = (t - of[2])/(begin - of[2])
        printf "%g to %g K, by frames %g K: %.2g of the change", begin, of[2], t, off
        exit !(NR == 8 && begin > of[2] + 20 && off*off < 1e-4) }' "$work/heats")
verdict "its temperature is that of factors of frames ($found)" $?
run 1 rerun rerun.lmp data "$work/quarter.data"
near "$work/rerun.out" "$work/rerun.out.after" 1e-300 "rerun steps no temperatures"
awk '$1 == "Step" { n = 0 } n++ && NF == 2 && ($1 == 0 || $1 == 10) { power[$1] = $2 }
    END { exit !(power[10] != 0 && power[0] == power[10]) }' "$work/rerun.log"
verdict "rerun has powers" $?

# ---- temperatures that LAMMPS steps -------------------------------------------------------------------------------------
if "$LMP" -h | grep -q 'heat/flow'; then
    "$BUILD/tests/couple/serial_bed" 50 1000 100 <"$work/quarter" >"$work/serial.out"
    run 2 heatflow heatflow.lmp "${whole[@]}"
    near "$work/serial.out" "$work/heatflow.out" 1e-10 "frozen bed by fix heat/flow against one scene"
    run 2 falls heatflow.lmp data "$work/quarter.data" boundary "p p f" falls yes conducts 2e5 steps 2000 heat 10
    balance falls 10e-3 1 1e-6 200 "energy of a falling bed with conduction"
    run 2 stores heatflow.lmp data "$work/quarter.data" boundary "p p f" falls yes conducts 2e5 steps 2000 heat 10 \
        capacity "capacity 1e5" stored 1e5
    balance stores 10e-3 1 1e-6 200 "energy of a falling bed and a floor that stores heat"
    ! run 2 twice heatflow.lmp "${whole[@]}" capacity "contacts 3" && grep -q 'heat model of pair granular conducts' "$work/twice.log"
    verdict "contacts beside those of pair granular are refused" $?
fi

# ---- a box that is empty at first --------------------------------------------------------------------------------------
run 2 empty empty.lmp && awk '/^[12] / && $2 < 399 && $2 > 390 { n++ } END { exit n != 2 }' "$work/empty.out"
verdict "a box that is empty at first" $?

# ---- failures ---------------------------------------------------------------------------------------------------------
# fails MESSAGE WHAT [NAME VALUE]...: all ranks, 2 or $failing, end with one message
fails() {
    message=$1 what=$2
    shift 2
    run "${failing:-2}" failure frozen.lmp data "$work/quarter.data" "$@"
    status=$?
    count=$(cat "$work/failure.err" "$work/failure.log" | grep -c "^ERROR.*$message")
    test $status -ne 0 && test $status -ne 152 && test "$count" -eq 1
    verdict "$what" $? "status $status, $count messages: $(grep -h ERROR "$work/failure.err" "$work/failure.log" | head -n 1)"
}
failing=4 fails "atom 10 .*not set" "unset temperature" also "set atom 10 d_T 0"
fails "they must be at most" "steps of heat too long" also "timestep 400" heat 20
fails "temperature d_T of atom 10 is -3, not above 0" "a temperature below 0" also "set atom 10 d_T -3"
fails "particle.* 10 .*inside" "a centre inside another particle" also "set atom 10 diameter 2.5" strict yes
fails "beyond wall 1, zmin" "a centre beyond a wall" floor "zmin temperature 1000 emissivity 0.9 at 1" strict yes
fails "rad and bad both radiate from atom" "two fixes on one particle" \
    also "fix bad all fibrad 1 1 emissivity 1 surroundings 300 cp 1"
for style in "body nparticle 2 6" "hybrid sphere ellipsoid" "hybrid sphere tri"; do
    printf '%s\n' "include $LOAD" "atom_style $style" "region box block 0 9 0 9 0 9" "create_box 1 box" \
        "fix rad all fibrad 1 1 emissivity 1 cp 1 sigma 1 surroundings 0" "run 0" >"$work/shape.lmp"
    name=${style#hybrid sphere }
    ! limited_mpi 2 "$LMP" -in "$work/shape.lmp" -log "$work/shape.log" -screen none >"$work/shape.err" 2>&1 &&
        grep -q "must be spheres, and atom_style ${name%% *} has others" "$work/shape.log"
    verdict "atom_style $style is refused" $?
done
fails "no equal-style variable" "a variable that is not there" floor "zmin temperature v_none emissivity 0.9"
fails "has a temperature of its own, not v_hot" "a capacity beside a variable" floor "zmin temperature v_hot emissivity 0.9 capacity 3e5"
fails "too long for wall zmin" "steps of heat too long for a wall" floor "zmin temperature 1000 emissivity 0.9 at 0 capacity 1e4" heat 1
fails "variable .moves. is not of equal style" "a variable of atoms" floor "zmin temperature v_moves emissivity 0.9" also "variable moves atom x"
fails "open excludes temperature; an opening is as black" "an opening with a temperature" \
    floor "zmin temperature 1000 emissivity 0.9 wall zmax open temperature 300"
fails "too many values of the emissivity: atoms have 2 types" "an emissivity for one type too many" radiates "type 0.5 0.8 0.7"
fails "emissivity of type 2 of 2 must be a number, not .cp" "an emissivity for one type too few" radiates "type 0.5"
fails "values of types follow the word .type" "emissivities without the word type" radiates "0.5 0.8"
fails "wall zlo: .1000. needs a word before it, as in .zlo temperature" "a wall in the old words" floor "zlo 1000 0.9"
fails "wall zmin: it needs a temperature, or the word insulated" "a wall without a temperature" floor "zmin"
fails "zmni. is no wall; did you mean zmin" "a wall that is not there" floor "zmni temperature 1000"
fails "wall 1 at 9 does not lie below wall 2 at 3" "walls that cross" floor "zmin temperature 1000 emissivity 0.9 at 9 wall zmax temperature 1000 emissivity 0.9 at 3"
fails "wall 2 is a cylinder, as is wall 3" "two cylinders" \
    floor "zmin temperature 1000 at 0 wall zcylinder 0 0 9 temperature 300 wall xcylinder 0 0 9 temperature 300"
fails ".contacts. is given twice" "a keyword twice" strict "no contacts 5 contacts 6"
fails "sigma must be above 0, not 0" "a sigma of 0" strict "no sigma 0"
fails "capacity: 0 is not within 1e-300" "a capacity of 0" floor "zmin temperature 1000 emissivity 0.9 capacity 0"
fails "one of low, normal and high, not .fine" "an accuracy that is not there" strict "no accuracy fine"
fails ".seed. is a whole number, not .-3" "a seed below 0" strict "no seed -3"
table wrong 300 .5 900 1.5
fails "wrong:4: the emissivity is 1.5; it must be within 0 and 1" "a table out of range" radiates "@$work/wrong"
fails "$work/none: No such file" "a table that is not there" cp "@$work/none"
fails "@FILE. needs temperatures" "a table without temperatures" heat 0 radiates "@$work/half"
fails "rad and bad both radiate from atom" "two fixes on one particle of a second group" group odd \
    also "fix bad even fibrad 1 1 emissivity 1 surroundings 300 cp 1 group2 odd"
fails "no group .none" "a group that is not there" strict "no group2 none"
fails "accuracy excludes tolerance" "accuracy beside a tolerance" strict "no tolerance 0.1 accuracy low"
fails "open axes x and y" "a cylinder with periodic axes" boundary "p p f" \
    also "fix bad all fibrad 0 1 emissivity 1 surroundings 300 cp 1 wall zcylinder 0 0 50 temperature 300 emissivity 1"
fails "wall ycylinder needs open axes x and z" "a cylinder along y with periodic axes" boundary "p p f" \
    also "fix bad all fibrad 0 1 emissivity 1 surroundings 300 cp 1 wall ycylinder 0 0 50 temperature 300 emissivity 1"
fails "particle 10 at (4.75951, 11.5, 2.78234): its centre lies beyond wall 1, the cylinder" "a centre beyond a cylinder" \
    floor "xcylinder 3 6.5 8 temperature 1000 emissivity .9 wall xmin open wall xmax open" also "set atom 10 y 11.5" strict yes
for ends in "wall ymin open wall ymax open" "wall zcylinder 0 0 30 temperature 1000 emissivity 1 wall xmin open wall xmax open"; do
    fails "the walls do not bound a box or a cylinder" "xcylinder and $ends" floor "xcylinder 0 0 30 temperature 1000 emissivity .9 $ends"
done
fails "an opening.*zmax open" "a cylinder without ends" floor "ycylinder 0 0 30 temperature 1000 emissivity .9"
fails "emissivity" "emissivity out of range" also "fix bad all fibrad 1 1 emissivity 1.5 surroundings 300 cp 1"
fails "$work/none.stl: No such file" "a mesh that is not there" \
    also "fix bad all fibrad 1 1 emissivity 1 surroundings 300 cp 1 wall mesh $work/none.stl temperature 300 emissivity 1"
: >"$work/empty.stl"
fails "empty.stl: the file is empty" "an empty mesh" \
    also "fix bad all fibrad 1 1 emissivity 1 surroundings 300 cp 1 wall mesh $work/empty.stl temperature 300 emissivity 1"
fails "sees the back of wall 1.*both" "the back of a mesh" \
    also "fix bad all fibrad 0 1 emissivity 1 surroundings 300 cp 1 wall mesh $work/box.stl temperature 300 emissivity 1 normals"
for words in "rotate 0 0 1 0:the period of a mesh must not be 0" "rotate 0 0 0 1:the axis of a mesh must not be 0 0 0" \
    "rotate 0 0 1:period is missing after" "rotate 0 0 1 5 about 0 0:axis is missing after" "velocity 0 1e305 0:a mesh's velocity must be in" \
    "velocity 0 nan 0:must be in .*, not nan"; do
    fails "${words#*:}" "a mesh with ${words%:*}" \
        also "fix bad all fibrad 0 1 emissivity 1 wall mesh $work/box.stl temperature 300 emissivity 1 ${words%:*}"
done
for words in "solid 0" "solid -4" "solid type 4 0"; do
    fails "conductivity of the solid.* must be above 0" "$words" strict "no $words"
done
fails "must be above 0, not nan" "a conductivity that is no number" strict "no solid nan"
fails "the time step must be at most 0.0627" "contacts for which the time step is too long" heat 1 strict "no contacts 1e10"
run 2 parts frozen.lmp "${whole[@]}" heat 1 strict "no contacts 1e6" && grep -q "step 0: contacts conduct in [0-9]* parts" "$work/parts.log"
verdict "contacts that conduct in parts of a step of heat" $?
fails "particle 10: convection -3 to gas of 400 K" "a heat transfer coefficient below 0" \
    also "variable h atom (id==10)*-3" strict "no convection v_h 400"
fails "the time step must be at most" "convection for which the time step is too long" heat 1 strict "no convection 1e7 400"
fails "there is no variable .h. of equal or atom style" "a coefficient that is not there" strict "no convection v_h 400"
fails "convection. needs temperatures" "convection without temperatures" heat 0 strict "no convection 5 400"
fails "none.csv: No such file" "a table for the gas that is not there" strict "no contacts 4 gas @none.csv"
fails "contacts.* without .solid." "contacts beside solid" strict "no contacts 4 solid 4"
fails "scale of contacts must be in" "a scale of 0" strict "no contacts 4 hertz scale 0"
fails "contacts. needs temperatures" "contacts without temperatures" heat 0 strict "no contacts 4"
fails "moved. needs temperatures" "a distance moved without temperatures" heat 0 strict "no moved 0.1"
fails "conductivity at contacts of type 2.* must be above 0" "contacts of conductivity 0" strict "no contacts type 4 0"
fails "conductivity of the solid of type 2 of 2 is missing after .4" "a conductivity for one of two types" strict "no solid type 4"
fails "property/atom d_none" "conductivities that are not there" strict "no solid d_none"
fails "NEVERY must be above 0" "conductivities without temperatures" heat 0 strict "no solid 4"
fails "property/atom d_none" "temperatures that are not there" \
    also "fix bad all fibrad 1 1 emissivity 1 surroundings 300 cp 1 temperature d_none"

# a killed rank; each rank leaves its process id behind
# shellcheck disable=SC2016  # for the ranks' own shell
limited_mpi 2 sh -c 'echo $$ >"$0.$OMPI_COMM_WORLD_RANK" && exec "$@"' "$work/pid" "$LMP" -in tests/couple/frozen.lmp -screen none \
    -log "$work/killed.log" -var load "$LOAD" -var out "$work/killed.out" -var data "$work/quarter.data" -var steps 100000000 \
    >"$work/killed.err" 2>&1 &
runner=$!
until grep -q '^ *Step' "$work/killed.log" 2>/dev/null || ! kill -0 $runner; do sleep 0.1; done
kill -KILL "$(cat "$work/pid.1")"
wait $runner
status=$?
test $status -ne 0 && test $status -ne 152 && timeout 10 tail --pid="$(cat "$work/pid.0")" -f /dev/null && grep -q 'signal 9' "$work/killed.err"
verdict "a killed rank" $? "status $status"

exit $faults
