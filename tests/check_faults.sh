#!/bin/sh
# check_faults.sh - the program when the machine fails: disk full, folder gone, signals, no memory, killed. The script
# makes each of these faults happen. There must be no partial file under the given name, one message, and the exit
# status of the manual. SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}"
fibrad=$(pwd)/$BUILD/fibrad
bed=$(pwd)/tests/data/mono2000.dump
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
faults=0

# verdict WHAT STATUS-FOUND STATUS-WANTED MESSAGE: compares them. There must be no result and no part of one
verdict() {
    test "$2" = "$3" || complain "$1: exit status $2 instead of $3"
    grep -q "^fibrad: .*$4" "$work/err" || complain "$1: no message with '$4': $(cat "$work/err")"
    left=$(find "$work" -name 'F.*')
    test -z "$left" || complain "$1: left behind: $left"
    rm -f "$work"/F.*
}

complain() {
    echo "$1"
    faults=1
}

# Waits until process $1 has its output open. The output may have no name; the file of messages does not count.
until_open() {
    # shellcheck disable=SC2010  # a link of /proc has no odd name
    until ls -l "/proc/$1/fd" 2>/dev/null | grep "$work" | grep -qv "$work/err"; do sleep 0.05; done
}

# Signals during far more work than there is time for
for pair in INT:130 TERM:143 HUP:129; do
    "$fibrad" factors "$bed" --directions 65536 -o "$work/F.csv" >/dev/null 2>"$work/err" &
    until_open $!
    kill -s "${pair%:*}" $!
    wait $!
    verdict "SIG${pair%:*}" $? "${pair#*:}" interrupted
done

# The same for a furnace
"$fibrad" furnace --case 1 --bundles 4000000000 -o "$work/F.csv" >/dev/null 2>"$work/err" &
until_open $!
kill -s INT $!
wait $!
verdict "SIGINT, furnace" $? 130 interrupted

# Killed at once: no file has the given name. A temporary file may stay, and does not disturb the next run
"$fibrad" factors "$bed" --directions 65536 -o "$work/F.csv" >/dev/null 2>&1 &
until_open $!
kill -s KILL $!
wait $! 2>/dev/null
test -e "$work/F.csv" && complain "SIGKILL: a partial file"
"$fibrad" factors "$bed" --directions 8 -o "$work/F.csv" >/dev/null 2>"$work/err" || complain "after SIGKILL: $(cat "$work/err")"
test -s "$work/F.csv" || complain "after SIGKILL: no file"

# An older result stays as it is if the new run fails
cp "$work/F.csv" "$work/old"
(ulimit -f 64 && exec "$fibrad" factors "$bed" --directions 34 -o "$work/F.csv") >/dev/null 2>"$work/err"
status=$?
cmp -s "$work/old" "$work/F.csv" || complain "a failed run changed the older result"
rm -f "$work"/F.*
verdict "limit of file sizes" $status 4 "F.csv: cannot be written: File too large"

# Pictures as well
for ending in svg png; do
    (ulimit -f 64 && exec "$fibrad" factors "$bed" --directions 8 --plot "$work/F.$ending") >/dev/null 2>"$work/err"
    verdict "limit of file sizes, .$ending" $? 4 "F.$ending: cannot be written: File too large"
done

# The reader of standard output ends: a pipe whose other end is closed
mkfifo "$work/pipe"
exec 3<>"$work/pipe"
exec 4>"$work/pipe"
exec 3<&-
"$fibrad" factors "$bed" --directions 8 >&4 2>"$work/err"
verdict "SIGPIPE" $? 4 "standard output: Broken pipe"
exec 4>&-

# A full disk, if this machine may mount one
mkdir "$work/disc"
if mount -t tmpfs -o size=100k tmpfs "$work/disc" 2>/dev/null; then
    for ending in csv mtx vtp; do
        "$fibrad" factors "$bed" --directions 34 -o "$work/disc/F.$ending" >/dev/null 2>"$work/err"
        verdict "disc full, .$ending" $? 4 "No space left on device"
    done
    for ending in svg png; do
        "$fibrad" factors "$bed" --directions 8 --plot "$work/disc/F.$ending" >/dev/null 2>"$work/err"
        verdict "disc full, .$ending" $? 4 "F.$ending: cannot be written: No space left on device"
    done
    umount "$work/disc"
else
    echo "SKIP disc full: no right to mount one"
fi

# The folder of the output is gone when the file shall get its name
mkdir "$work/gone"
"$fibrad" factors "$bed" --directions 4000 --threads 1 -o "$work/gone/F.csv" >/dev/null 2>"$work/err" &
until_open $!
kill -s STOP $! # for as long as it takes
rm -rf "$work/gone"
kill -s CONT $!
wait $!
verdict "folder gone" $? 4 "F.csv: cannot be written: No such file"

# Not enough memory, from too little at the start to nearly enough: a clean failure or a complete result
"$fibrad" factors "$bed" --directions 21 --threads 1 -o "$work/F.csv" >/dev/null 2>&1
mv "$work/F.csv" "$work/whole"
refused=0
for limit in 8000 9000 10000 10500 11000 11500 12000 12500 13000 13500 14000 15000 16000 20000; do
    # shellcheck disable=SC3045  # dash and bash have it
    (ulimit -v $limit && exec "$fibrad" factors "$bed" --directions 21 --threads 1 -o "$work/F.csv") >/dev/null 2>"$work/err"
    status=$?
    if test $status = 0; then
        cmp -s "$work/whole" "$work/F.csv" || complain "memory limit $limit KiB: another result"
        rm -f "$work/F.csv"
    elif test $status = 127 || grep -q "^libgomp: Out of memory" "$work/err"; then # the loader or OpenMP found no room
        rm -f "$work"/F.*
    else
        refused=$((refused + 1))
        verdict "memory limit $limit KiB" $status 5 "out of memory"
    fi
done
test $refused -gt 0 || complain "no memory limit made the program run out of memory"
echo "$refused of 14 memory limits made the program run out of memory"

# Input that cannot be read
"$fibrad" factors /proc/self/mem -o "$work/F.csv" >/dev/null 2>"$work/err"
verdict "unreadable input" $? 4 "/proc/self/mem"
exit $faults
