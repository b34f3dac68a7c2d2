#!/bin/sh
# check_liggghts.sh [all] - LIGGGHTS with radiation beside conduction by 1 and 2 ranks: energy, temperatures and rows of a bed at
# rest. All: moving beds, a source of the script's own, meshes, messages. SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}" "${MPICC:=mpicc}" "${MPIRUN:=mpirun}"
if ! test -f /usr/include/liggghts/library.h || ! command -v "$MPICC" >/dev/null; then
    echo "SKIP LIGGGHTS: not there (Debian: libliggghts-dev, openmpi-bin, libopenmpi-dev; make deps-couple)"
    exit 0
fi
. tests/couple/mpi.sh

make_one_by_one "$BUILD/couple/fibrad_liggghts" "$BUILD/fibrad" || exit 1
driver=$(pwd)/$BUILD/couple/fibrad_liggghts fibrad=$(pwd)/$BUILD/fibrad example=$(pwd)/host/couple/liggghts/hot_floor.liggghts
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
cd "$work" || exit 1
faults=0
complain() {
    echo "$@"
    faults=1
}

# create_atoms gives ids by ranks, on which rows depend: here each particle is made by itself, a little off its place
awk 'BEGIN {
    for (k = 0; k < 6; k++) for (j = 0; j < 7; j++) for (i = 0; i < 7; i++) {
        n++
        printf "create_atoms 1 single %.7f %.7f %.7f units box\n", .006 + .00597 * i + 1e-4 * sin(1.3 * n),
            .006 + .00597 * j + 1e-4 * sin(2.1 * n), .00299 + .00597 * k + 5e-5 * sin(3.7 * n)
    } }' >atoms
sed 's/^create_atoms.*/include atoms/' "$example" >bed
dump='dump end all custom 500 END id f_Temp f_heatSource'
format='dump_modify end sort id format "%d %.17g %.17g"'
radiation='--emissivity 0.8 --surroundings 300 --wall zmin:temperature=1200:emissivity=0.9'

# run NAME RANKS MOVE STEPS OPTIONS...: the driver, its output in NAME
run() {
    name=$1 ranks=$2 move=$3 steps=$4
    shift 4
    # shellcheck disable=SC2086  # options
    run_mpi "$ranks" "$driver" $radiation --steps "$steps" "$@" -- -log none -var move "$move" -var every 100 >"$name" ||
        complain "$name: $(grep -v '^[- ]' "$name" | tail -5)"
}

value() { sed -n "s/^$2 //p" "$1"; } # FILE KEY

# Heat that particles gain is what comes by radiation and, mean times steps (and step 0) times 2e-5 s, by conduction.
energy() { # NAME STEPS
    mean=$(awk -v step="$2" '$1 == step { mean = $4 } END { print mean }' "$1")
    echo "$(value "$1" heat_before) $(value "$1" heat_after) $(value "$1" radiation_particles) $mean \
        $(value "$1" radiation_zmin) $(value "$1" radiation_surroundings)" | awk -v name="$1" -v steps="$2" '{
        off = ($2 - $1 - $3 - $4 * (steps + 1) * 2e-5) / ($2 - $1)
        lost = ($3 + $5 + $6) / $3
        printf "%s: gained %.3f J, %.3f J by radiation; energy off by %.1e, radiation by %.1e\n", name, $2 - $1, $3, off, lost
        exit !(NF == 6 && $3 > 1 && off * off < 1e-22 && lost * lost < 1e-22) }' || complain "$1: energy is not kept"
}

# A bed at rest: temperatures for 1 and 2 ranks
for ranks in 1 2; do
    { cat bed && echo "$dump" | sed "s/END/end$ranks/" && echo "$format"; } >bed$ranks
    run still$ranks $ranks 'setforce 0 0 0' 1000 -in bed$ranks --rows 500 --write rows$ranks
    energy "still$ranks" 1000
done
paste end1 end2 | awk 'NF == 6 && $1 + 0 == $1 { off = $2 - $5; off *= off; if (off > most) most = off; n++ }
    END { printf "largest difference between 1 and 2 ranks %.1e K\n", sqrt(most); exit !(n == 3 * 294 && most < 1e-20) }' ||
    complain "temperatures depend on ranks"

# Their rows, bit for bit
"$fibrad" join rows1.0.rows --raw -o rows1.csv >joined1 || complain "1 rank: no rows"
"$fibrad" join rows2.0.rows rows2.1.rows --raw -o rows2.csv >joined2 || complain "2 ranks: no rows"
cmp rows1.csv rows2.csv || complain "rows depend on ranks"
test "$(value joined2 spheres)" = 294 || complain "294 spheres, not $(value joined2 spheres)"

test "${1:-}" = all || exit $faults

# Moving beds: energy alone, since LIGGGHTS parts from itself as soon as contacts differ
for ranks in 1 2; do
    run moving$ranks $ranks nve/sphere 3000 -in bed --rows 1000
    energy "moving$ranks" 3000
done

# What the floor takes, without a cutoff and ranks
{ echo x,y,z,r && awk '{ print $4 "," $5 "," $6 ",.003" }' atoms; } >bed.csv
"$fibrad" factors bed.csv --emissivity 0.8 --wall zmin:at=0:emissivity=0.9 --raw >serial 2>/dev/null || complain "no serial factors"
echo "$(value joined2 wall_1_F) $(value serial wall_zmin_F)" |
    awk '{ printf "the floor takes %.5f, %.5f in one scene\n", $1, $2; off = $1 / $2 - 1; exit !(off * off < 1e-4) }' ||
    complain "the floor takes something else"

# what a cylinder along x or y takes, and its ends
for axis in x y; do
    "$fibrad" factors bed.csv --emissivity 0.8 --wall ${axis}cylinder:.024,.018,.025:emissivity=.9 \
        --wall ${axis}min:at=0:emissivity=.9,${axis}max:at=.048:emissivity=.9 --raw >alone 2>/dev/null || complain "no factors of a bed in ${axis}cylinder"
    radiation="--emissivity 0.8 --surroundings 300 --wall ${axis}cylinder:.024,.018,.025:temperature=600:emissivity=.9,${axis}min:temperature=600:emissivity=.9,${axis}max:temperature=600:emissivity=.9"
    run round 2 'setforce 0 0 0' 1 -in bed --write round
    "$fibrad" join round.0.rows round.1.rows --raw -o round.csv >joined_round || complain "${axis}cylinder: no rows"
    echo "$(value joined_round wall_1_F) $(value alone wall_${axis}cylinder_F) $(value joined_round wall_3_F) $(value alone wall_${axis}max_F)" |
        awk -v axis=$axis '{
            printf "%scylinder takes %.5f, %.5f in one scene, its end %.5f, %.5f\n", axis, $1, $2, $3, $4
            round = $1 / $2 - 1; end = $3 / $4 - 1
            exit !(NF == 4 && round * round < 1e-4 && end * end < 4e-4) }' || complain "${axis}cylinder takes something else"
done
radiation='--emissivity 0.8 --surroundings 300 --wall zmin:temperature=1200:emissivity=0.9'

# A source of the script's own stays: 1 W in each of 294 particles for 200 steps of 2e-5 s
{ cat bed && echo 'run 0' && echo 'set group all property/atom heatSource 1'; } >source
run own 2 'setforce 0 0 0' 200 -in source
run none 2 'setforce 0 0 0' 200 -in bed
echo "$(value own conduction_and_sources) $(value none conduction_and_sources)" |
    awk '{ printf "a source of 1.176 J brings %.4f J\n", $1 - $2; exit !($1 - $2 > 1.1 && $1 - $2 < 1.18) }' || complain "the own source is lost"

# Particles that come with 300 K bring heat, which is no conduction
{
    sed 's/^fix floor .*/fix floor all wall\/gran model hertz tangential history primitive type 1 zplane 0.0/' bed
    echo 'fix kind all particletemplate/sphere 15485863 atom_type 1 density constant 2500 radius constant 0.003'
    echo 'fix kinds all particledistribution/discrete 15485867 1 kind 1.0'
    echo 'region up block 0.006 0.042 0.006 0.042 0.045 0.058 units box'
    echo 'fix come all insert/pack seed 86028157 distributiontemplate kinds insert_every 50 overlapcheck yes vel constant 0 0 0 particles_in_region 5 region up'
} >filling
run coming 2 'setforce 0 0 0' 200 -in filling --rows 100
awk -v came="$(value coming heat_came)" -v gone="$(value coming heat_gone)" -v other="$(value coming conduction_and_sources)" 'BEGIN {
    number = came / (2500 * 4 / 3 * atan2(0, -1) * .003^3 * 5 * 300)
    printf "%.12g particles bring %.4f J, %.2g J go, conduction %.2g J\n", number, came, gone, other
    whole = int(number + .5)
    exit !(whole >= 5 && (number / whole - 1)^2 < 1e-24 && gone == 0 && other^2 < 1e-20 * came^2) }' || complain "heat of particles that come counts as conduction"

# Particles that conduct, at 1000 K on a floor of 1200 K: the powers of fibrad heat, where one temperature a particle
# would bring 15 % more; energy, at temperatures that rise
sed 's/initial_temperature 300/initial_temperature 1000/' bed >warm
radiation='--emissivity 0.8 --surroundings 900 --wall zmin:temperature=1200:emissivity=0.9 --solid-conductivity 0.68'
"$fibrad" heat bed.csv --emissivity 0.8 --temperature 1000 --ambient 900 --wall zmin:at=0:temperature=1200:emissivity=0.9 \
    --length-unit m --directions 600 --solid-conductivity 0.68 -o heat.csv >/dev/null 2>&1 || complain "no powers of fibrad heat"
for ranks in 1 2; do
    { cat warm && echo 'fix fibradPower all property/atom fibradPower scalar yes no no 0' &&
        echo "dump powers all custom 1 powers$ranks id f_fibradPower" && echo 'dump_modify powers sort id format "%d %.17g"'; } >conduct$ranks
    run conducts$ranks $ranks 'setforce 0 0 0' 0 -in conduct$ranks --tolerance 0.01
    awk -F'[ ,]' -v ranks="$ranks" 'NR == FNR && $1 ~ /^[0-9]/ { q[$1 + 1] = $3 }
        NR > FNR && NF == 3 && $1 in q { off += ($2 - q[$1])^2; all += q[$1]^2; found += $2; truth += q[$1]; n++ }
        END {
            printf "%d rank(s): powers that conduct %.4f W, %.4f W by patches; each off by %.2g\n", ranks, found, truth, sqrt(off / all)
            exit !(n == 294 && (found / truth - 1)^2 < 1e-4 && off < .08^2 * all) }' heat.csv "powers$ranks" ||
        complain "$ranks rank(s): particles that conduct have other powers"
done
run warming 2 'setforce 0 0 0' 600 -in warm --rows 300
energy warming 600
radiation='--emissivity 0.8 --surroundings 300 --wall zmin:temperature=1200:emissivity=0.9'

# Contacts that the driver conducts, against those of LIGGGHTS, whose spots conduct sqrt(pi) times as much: temperatures,
# the same for 1 and 2 ranks; energy with a floor that conducts, too
sed '/^fix floor/s/ temperature .*//' bed >plain
transport="fix heat all transportequation/scalar equation_id heattransfer quantity Temp default_value 300 \
flux_quantity heatFlux source_quantity heatSource capacity_quantity thermalCapacity"
sed -e "s|^fix heat .*|$transport|" -e '/conducted/d' plain >free
echo 'thermo_style custom step c_mean c_hottest' >>free
for bed in plain free; do { echo 'run 0' && echo 'set atom 1*100 property/atom Temp 900' && echo "$dump" | sed "s/500 END/300 end_$bed/" && echo "$format"; } >>$bed; done
radiation='--emissivity 0.8 --surroundings 300 --wall zmin:temperature=1200:emissivity=0.9:at=-0.001 --every 1 --rows 300'
run own_contacts 1 'setforce 0 0 0' 300 -in plain
for ranks in 1 2; do
    sed "s/end_free/end_free$ranks/" free >free$ranks
    run contacts$ranks $ranks 'setforce 0 0 0' 300 -in free$ranks --contacts '5 lens scale 1.7724538509055159'
    paste end_plain "end_free$ranks" | awk -v ranks="$ranks" '
        NF == 6 && $1 + 0 == $1 { off = ($2 - $5)^2; if (off > most) most = off; moved += ($2 != 900 && $2 != 300); n++ }
        END {
            printf "%d rank(s): contacts of the driver and of LIGGGHTS part by %.1e K\n", ranks, sqrt(most)
            exit !(n == 588 && moved > 200 && most < 1e-16) }' || complain "contacts conduct otherwise than those of LIGGGHTS"
done
# The same with a floor of the conductivity of the particles
sed -e "s|^fix heat .*|$transport|" -e '/conducted/d' bed >floored
echo 'thermo_style custom step c_mean c_hottest' >>floored
for bed in bed floored; do { echo 'run 0' && echo 'set atom 1*100 property/atom Temp 900' && echo "$dump" | sed "s/500 END/300 end_$bed/" && echo "$format"; } | cat $bed - >own_$bed; done
sed -i '/^fix floor/s/ temperature .*//' own_floored
radiation='--emissivity 0.8 --surroundings 300 --wall zmin:temperature=1200:emissivity=0.9 --every 1 --rows 300'
run own_floor 1 'setforce 0 0 0' 300 -in own_bed
for ranks in 1 2; do
    sed "s/end_floored/end_floored$ranks/" own_floored >own_floored$ranks
    run floor$ranks $ranks 'setforce 0 0 0' 300 -in own_floored$ranks --contacts '5 lens scale 1.7724538509055159 wall 5'
    paste end_bed "end_floored$ranks" | awk -v ranks="$ranks" '
        NF == 6 && $1 + 0 == $1 { off = ($2 - $5)^2; if (off > most) most = off; n++ }
        END {
            printf "%d rank(s): contacts and a floor of the driver and of LIGGGHTS part by %.1e K\n", ranks, sqrt(most)
            exit !(n == 588 && most < 1e-18) }' || complain "the floor conducts otherwise than that of LIGGGHTS"
    awk -v q="$(value "floor$ranks" contacts_zmin)" 'BEGIN { exit !(q < -.1) }' || complain "the floor conducts nothing"
done

# Gas: each step leaves 1 - h A t/C of the difference; by type, and by properties of particles
radiation='--emissivity 0 --surroundings 300 --wall zmin:temperature=1200:emissivity=0 --every 1 --rows 300'
{ sed '/end_free/,$d' free && echo 'fix film all property/atom film scalar yes no no 25' &&
    echo 'fix gas all property/atom gas scalar yes no no 400' && echo "$dump" | sed 's/500 END/300 end_GAS/' && echo "$format"; } >in_gas
for ranks in 1 2; do
    for words in "25 400" "film gas"; do
        sed "s/GAS/gas$ranks/" in_gas >"in_gas$ranks"
        run "gas$ranks" "$ranks" 'setforce 0 0 0' 300 -in "in_gas$ranks" --convection "$words"
        awk -v q="$(value "gas$ranks" convection_particles)" -v heat="$(value "gas$ranks" heat_before) $(value "gas$ranks" heat_after)" '
            NF == 3 && $1 + 0 == $1 { at[$1] = $2 }
            END {
                left = exp(300 * log(1 - 25 * 3 / .003 / 2500 / 5 * 2e-5)); split(heat, h)
                for (i in at) { d = at[i] - 400 - ((i + 0 <= 100 ? 900 : 300) - 400) * left; n++; if (d * d > most) most = d * d }
                lost = (h[2] - h[1] - q) / q
                printf "gas cools particles off by %.1e K, energy off by %.1e\n", sqrt(most), lost
                exit !(n == 294 && most < 1e-18 && lost * lost < 1e-22) }' "end_gas$ranks" || complain "gas cools otherwise"
    done
done
cmp end_gas1 end_gas2 || complain "what gas brings depends on ranks"
radiation='--emissivity 0.8 --surroundings 300 --wall zmin:temperature=1200:emissivity=0.9'

radiation='--emissivity 0.8 --surroundings 300 --wall zmin:temperature=1200:emissivity=0.9:capacity=3'
run touched 2 nve/sphere 300 -in free --contacts '5 hertz gas 0.03' --rows 100 --every 10
echo "$(value touched heat_before) $(value touched heat_after) $(value touched radiation_surroundings) $(value touched temperature_zmin) \
    $(value touched contacts_zmin) $(value touched contacts_particles)" | awk '{
    lost = ($2 - $1 + $3 + 3 * ($4 - 1200)) / ($2 - $1)
    printf "contacts bring %.3f J; energy off by %.1e\n", $6, lost
    exit !(NF == 6 && $6 > 0.01 && ($5 + $6)^2 < 1e-24 * $6 * $6 && lost * lost < 1e-22) }' || complain "contacts: energy is not kept"
radiation='--emissivity 0.8 --surroundings 300 --wall zmin:temperature=1200:emissivity=0.9'

# Meshes of the script. A box of triangles against planes in its place
quad() { # NAME CORNER CORNER CORNER CORNER: two triangles
    printf 'solid %s\n' "$1"
    for third in "$3|$4" "$4|$5"; do
        printf 'facet normal 0 0 0\nouter loop\nvertex %s\nvertex %s\nvertex %s\nendloop\nendfacet\n' \
            "$2" "${third%|*}" "${third#*|}"
    done
    printf 'endsolid\n'
}
box() {
    quad box "0 0 0" "0 0 .06" "0 .048 .06" "0 .048 0"
    quad box ".048 0 0" ".048 .048 0" ".048 .048 .06" ".048 0 .06"
    quad box "0 0 0" ".048 0 0" ".048 0 .06" "0 0 .06"
    quad box "0 .048 0" "0 .048 .06" ".048 .048 .06" ".048 .048 0"
    quad box "0 0 0" "0 .048 0" ".048 .048 0" ".048 0 0"
    quad box "0 0 .06" ".048 0 .06" ".048 .048 .06" "0 .048 .06"
}
box | sed '/solid/d' | { echo solid box && cat && echo endsolid box; } >box.stl
with_mesh() { awk -v fixes="$1" '/^fix heat/ { print fixes } { print }' bed; }
with_mesh 'fix vessel all mesh/surface file box.stl type 1 temperature 1200' >meshed
only_planes=$radiation
for side in zmax xmin xmax ymin ymax; do only_planes="$only_planes --wall $side:temperature=1200:emissivity=.9"; done
# Without a lid: as with a black one as hot as the surroundings, at the end of the box; refused without the word
sides=$(echo "$only_planes" | sed 's/ --wall zmax:[^ ]*//')
radiation="$sides --wall zmax:temperature=300:emissivity=1"
run black_lid 1 'setforce 0 0 0' 200 -in bed
for ranks in 1 2; do
    radiation="$sides --wall zmax:open$(test $ranks = 2 || echo :at=.06)"
    run open$ranks $ranks 'setforce 0 0 0' 200 -in bed
done
echo "$(value black_lid radiation_particles) $(value open1 radiation_particles) $(value open2 radiation_particles) \
    $(value black_lid radiation_zmax) $(value open1 radiation_surroundings)" | awk '{
    printf "below a black lid %.5f J, an opening %.5f J; the lid gets %.5f J, the surroundings %.5f J\n", $1, $2, $4, $5
    off = $2 / $1 - 1; ranks = $2 / $3 - 1; lid = $5 / $4 - 1
    exit !(NF == 5 && off * off < 1e-24 && ranks * ranks < 1e-24 && lid * lid < 1e-24) }' || complain "an opening is no black lid"
radiation=$only_planes
run planes 1 'setforce 0 0 0' 200 -in bed
radiation='--emissivity 0.8 --surroundings 300'
for ranks in 1 2; do run mesh$ranks $ranks 'setforce 0 0 0' 200 -in meshed --wall mesh:vessel:emissivity=0.9; done
echo "$(value planes radiation_particles) $(value mesh1 radiation_particles) $(value mesh2 radiation_particles) \
    $(value mesh1 radiation_vessel)" | awk '{
    printf "six planes bring %.5f J, twelve triangles %.5f J\n", $1, $2
    off = $2 / $1 - 1; ranks = $2 / $3 - 1; lost = $4 / $2 + 1
    exit !(NF == 4 && off * off < 9e-6 && ranks * ranks < 1e-24 && lost * lost < 1e-24) }' || complain "a box of triangles is no box"

# A lid that moves is where it is when rows are made
lid() { quad lid ".004 .004 $1" ".04 .004 $1" ".04 .04 $1" ".004 .04 $1"; }
lid .045 >low.stl
lid .055 >high.stl
with_mesh 'fix lid all mesh/surface file low.stl type 1
fix lift all move/mesh mesh lid linear 0 0 5' >lifted
with_mesh 'fix lid all mesh/surface file low.stl type 1' >low
with_mesh 'fix lid all mesh/surface file high.stl type 1' >high
for bed in low high lifted; do
    run lid_$bed 2 'setforce 0 0 0' 100 -in $bed --every 100 --rows 100 --wall mesh:lid:temperature=900:emissivity=0.9:both --write $bed
    "$fibrad" join $bed.0.rows $bed.1.rows --raw -o $bed.csv >joined_$bed || complain "$bed: no rows"
done
echo "$(value joined_low wall_1_F) $(value joined_high wall_1_F) $(value joined_lifted wall_1_F)" | awk '{
    printf "the lid takes %.5f, higher %.5f, lifted %.5f\n", $1, $2, $3
    off = $3 / $2 - 1; exit !(NF == 3 && $1 > 1.2 * $2 && off * off < 1e-8) }' || complain "rows do not follow a mesh that moves"
radiation='--emissivity 0.8 --surroundings 300 --wall zmin:temperature=1200:emissivity=0.9'

# A drum of triangles that turns once and stores heat. Its temperature follows from factors of `fibrad factors` of
# frames, too, and what particles and drum lose goes to the ends. Both sides are the wall, since pebbles in the corners
# of drum and ends see the back of the shell
awk -v pi=3.14159265358979 'BEGIN {
    print "solid drum"
    for (k = 0; k < 24; k++) for (t = 0; t < 2; t++) {
        print "facet normal 0 0 0\nouter loop"
        for (c = 0; c < 3; c++) {
            turn = (k + (t ? c > 0 : c == 1)) * pi / 12
            print "vertex", (t ? c == 1 : c > 0) ? 0 : .048, .024 + .0235 * cos(turn), .024 + .0235 * sin(turn)
        }
        print "endloop\nendfacet"
    }
    print "endsolid" }' >drum.stl
sed -e '/^fix \(floor\|front\|back\)/d' -e 's/thermalCapacity peratomtype 5/thermalCapacity peratomtype 50/' \
    -e 's/^region bed.*/region bed cylinder x .024 .024 .0202 .003 .045 units box/' \
    -e '/^fix heat/i fix drum all mesh/surface file drum.stl type 1\nfix shell all wall/gran model hertz tangential history mesh n_meshes 1 meshes drum\nfix turn all move/mesh mesh drum rotate origin .024 .024 .024 axis 1 0 0 period .2' \
    "$example" >drum
{ echo 'dump frames all custom 1000 *.frame id x y z radius f_Temp' && echo 'dump shells all mesh/stl 1000 *.shell drum'; } >>drum
radiation='--emissivity 0.8 --surroundings 300 --wall xmin:temperature=600:emissivity=.9,xmax:temperature=600:emissivity=.9'
run turning 2 nve/sphere 10000 -in drum --rows 500 --wall mesh:drum:temperature=1200:emissivity=.7:both:capacity=.5
echo "$(value turning heat_before) $(value turning heat_after) $(value turning radiation_xmin) $(value turning radiation_xmax) \
    $(value turning temperature_drum)" | awk '{
    lost = ($2 - $1 + $3 + $4 + .5 * ($5 - 1200)) / ($2 - $1)
    printf "a drum cools to %.3f K; energy off by %.1e\n", $5, lost
    exit !(NF == 5 && $2 > $1 && lost * lost < 1e-24) }' || complain "a drum that stores heat: energy is not kept"
for step in $(seq 0 1000 10000); do
    mv "$step.shell" shell.stl
    "$fibrad" factors "$step.frame" --emissivity .8 --wall mesh:shell.stl:both:emissivity=.7,xmin:at=0:emissivity=.9,xmax:at=.048:emissivity=.9 --raw \
        --quiet -o factors.csv 2>/dev/null || complain "no factors of step $step" >&2
    # what particles, ends and surroundings send to the drum, and what it sends to them at 1 K
    awk -F'[ ,]' 'BEGIN { pi = 3.14159265358979; s = 5.670374419e-8; both = 2 * 24 * .048 * 2 * .0235 * sin(pi / 24) }
        NR == FNR && NF == 7 && $1 ~ /^[0-9]/ { e[$1] = s * $6^4 }
        NR > FNR && $1 > 0 && $4 == "shell" { weight = 3.6e-5 * pi * .8 * $3; sum += weight * e[$1]; all += weight }
        $4 ~ /^shell:(xm|surr)/ { weight = both * .7 * $3; sum += weight * s * ($4 ~ /surr/ ? 300 : 600)^4; all += weight }
        END { printf "%.9g %.9g\n", sum, all * 5.670374419e-8 }' "$step.frame" factors.csv
done | awk -v found="$(value turning temperature_drum)" '
    NR == 1 { t = 1200 }
    NR > 1 { for (k = .005; k < 1; k += .01) t += (a + k * ($1 - a) - (g + k * ($2 - g)) * t^4) * 2e-4 / .5 }
    { a = $1; g = $2 }
    END {
        off = (found - t) / (1200 - t)
        printf "by factors of frames to %.3f K, %.2g of its change\n", t, off
        exit !(NR == 11 && off * off < 1e-4) }' || complain "the drum has another temperature than by factors of frames"
radiation='--emissivity 0.8 --surroundings 300 --wall zmin:temperature=1200:emissivity=0.9'

# Messages: exit status, words; one line of the driver's, whatever the number of ranks. The ranks write messages into a
# file themselves: mpirun now and then loses the last line of a rank that fails.
refuse() { # RANKS STATUS WORDS OPTIONS...
    ranks=$1 wanted=$2 words=$3
    shift 3
    # shellcheck disable=SC2016  # words of the inner shell
    run_mpi "$ranks" sh -c 'exec "$0" "$@" 2>>out' "$driver" "$@" -- -log none -var every 100 >mpirun
    status=$?
    test $status -eq "$wanted" || complain "exit status $status instead of $wanted: $words"
    test "$(grep -c '^fibrad_liggghts: ' out)" = 1 || complain "not one message: $(grep ^fibrad out)"
    grep -q "^fibrad_liggghts: .*$words" out || complain "no message '$words': $(grep ^fibrad out)"
    rm out
}
refuse 2 2 "--emissivity is missing" -in bed --surroundings 300 --steps 1
refuse 1 2 "--surroundings is missing" -in bed --emissivity 0.8 --steps 1
refuse 2 3 "nofile: No such file" -in nofile --emissivity 0.8 --surroundings 300 --steps 1
refuse 1 2 "the script is missing" --emissivity 0.8 --surroundings 300 --steps 1
refuse 1 2 "unknown option: --bad" -in bed --bad 3
refuse 1 2 "'1.2' is not a number from 0 to 1" -in bed --emissivity 1.2
refuse 1 2 "solid-conductivity: '0' is not a number above 0" -in bed --solid-conductivity 0
refuse 1 2 "solid-conductivity: '5,nan' is not a number above 0" -in bed --solid-conductivity 5,nan
refuse 1 2 "contacts: '5 scale' is not K" -in bed --contacts '5 scale'
refuse 1 2 "contacts: '5 wall 0' is not K" -in bed --contacts '5 wall 0'
refuse 1 2 "convection: '25' is not H" -in bed --convection 25
refuse 1 2 "convection: '25,-1 300' is not H" -in bed --convection '25,-1 300'
# shellcheck disable=SC2086
refuse 2 3 "2 heat transfer coefficients for 1 types" -in bed $radiation --convection '5,6 300' --steps 1
# shellcheck disable=SC2086
refuse 2 3 "has no fix property/atom wind scalar" -in bed $radiation --convection 'wind 300' --steps 1
refuse 1 2 "contacts excludes" -in bed --emissivity 1 --surroundings 300 --steps 1 --contacts 5 --solid-conductivity 5
# shellcheck disable=SC2086
refuse 2 3 "fix heat/gran/conduction of the script conducts through contacts already" -in bed $radiation --steps 1 --contacts 5
refuse 1 2 "'floor' is no wall" -in bed --wall floor:temperature=300
refuse 1 2 "mesh:lid: 'up' is of no use here" -in bed --wall mesh:lid:up
refuse 1 2 "is now --wall mesh:NAME" -in bed --mesh lid=0.9
refuse 1 2 "is now a word of the wall" -in bed --capacity zlo=0
refuse 1 2 "capacity: 0 is not within" -in bed --wall zmin:capacity=0
# shellcheck disable=SC2086
refuse 2 3 "too long for wall zmin" -in bed --emissivity 0.8 --surroundings 300 --steps 1 --wall zmin:temperature=1200:capacity=1e-6
refuse 1 2 "contacts is given twice" -in bed --contacts 5 --contacts 6
refuse 1 2 "'fine' is not one of low, normal and high" -in bed --accuracy fine
# shellcheck disable=SC2086
refuse 1 3 "accuracy excludes tolerance" -in bed $radiation --steps 1 --tolerance 0.01 --accuracy high
refuse 1 2 "not a multiple" -in bed --emissivity 1 --surroundings 300 --steps 1 --every 20 --rows 30
# before the script runs
{ cat bed && echo 'run 0' && echo 'shell touch has_run'; } >runs
sed 's/^boundary f f f/boundary f f fm/' runs >open_lid
refuse 2 3 "2 emissivities for 1 types" -in runs --emissivity .5,.6 --surroundings 300 --steps 1
# shellcheck disable=SC2086
refuse 1 3 "wall zmax: the box has no fixed end there" -in open_lid $radiation --wall zmax:temperature=300 --steps 1
# shellcheck disable=SC2086
refuse 2 3 "step 0: .*wall 1 at 0.05 does not lie below wall 2 at 0.02" -in runs ${radiation%% --wall*} --wall zmin:temperature=300:at=.05 \
    --wall zmax:temperature=300:at=.02 --steps 1
test ! -e has_run || complain "the script runs before options are refused"
# shellcheck disable=SC2086
refuse 2 3 "2 conductivities of the solid for 1 types" -in bed $radiation --solid-conductivity 5,6 --steps 1
# shellcheck disable=SC2086
refuse 2 3 "step 0: particle [0-9]*: its relative conductivity must be at least 1e-06, not " -in bed $radiation --solid-conductivity 1e-9 --steps 1
# shellcheck disable=SC2086
refuse 2 3 "steps of heat are too long for particle" -in bed $radiation --steps 1 --every 1000000 --rows 1000000
# shellcheck disable=SC2086
refuse 2 3 "step 0: .*wall" -in bed $radiation --strict --wall zmax:temperature=300:at=0.02 --steps 1
# shellcheck disable=SC2086
# shellcheck disable=SC2086  # options
refuse 2 3 "step 0: .*zmax open" -in bed $sides --steps 1
refuse 1 2 "wall: zhi=open,.06 is not how a wall is written" -in bed --wall=zhi=open,.06
refuse 1 2 "zlo=300,1 is not how a wall is written" -in bed --wall zlo=300,1
# shellcheck disable=SC2086
refuse 1 3 "wall zmax: it needs a temperature" -in bed $radiation --wall zmax --steps 1
refuse 1 2 "xcylinder: needs Y,Z,R" -in bed --wall xcylinder:1,2
refuse 1 2 "'-1' is not a length of 0 or more" -in bed --cutoff -1
# shellcheck disable=SC2086  # options
refuse 2 3 "no such fix mesh/surface" -in bed $radiation --wall mesh:lid:emissivity=0.9 --steps 1
# shellcheck disable=SC2086
refuse 2 3 "gives no temperature" -in low $radiation --wall mesh:lid:emissivity=0.9 --steps 1
# shellcheck disable=SC2086
refuse 2 3 "sees the back" -in meshed $radiation --wall mesh:vessel:emissivity=0.9:normals --steps 1
grep -v '^fix heat\|f_\|c_' bed >cold
# shellcheck disable=SC2086
refuse 2 3 "no fix heat/gran/conduction" -in cold $radiation --steps 1
exit $faults
