#!/bin/sh
# skips.sh - the time that the skips save which no argument turns off. SPDX-License-Identifier: MIT
#
# Builds copies of the library, each with one line of the kernel changed as bench/skips.txt says. Runs bench_skips in
# all of them, in turns. Writes CSV to standard output. The status is 1 if a skip changes a result or if its line is
# missing.
set -u
: "${BUILD:=build}" "${MAKE:=make}" "${CC:=cc}"
tree=$BUILD/skips rounds=3

# build NAME: from the sources in $tree
build() {
    $MAKE -s -C "$tree" CC="$CC" build/bench/bench_skips >"$tree/log" 2>&1 || { tail -n 5 "$tree/log" >&2 && exit 1; }
    cp "$tree/build/bench/bench_skips" "$tree/$1"
}

rm -rf "$tree" && mkdir -p "$tree" && cp -r Makefile kernel host bench "$tree" || exit 1
build 0
count=0
while IFS='|' read -r what file old new; do
    case $what in '#'*) continue ;; esac
    file=$(echo "$file" | tr -d ' ')
    awk -v old="$old" -v new="$new" 'BEGIN {sub(/^ /, "", old); sub(/ $/, "", old); sub(/^ /, "", new)}
        {at = index($0, old); if (at) {found++; $0 = substr($0, 1, at - 1) new substr($0, at + length(old))} print}
        END {exit found != 1}' "$file" >"$tree/changed" || { echo "$file: not one line has$old" >&2 && exit 1; }
    cp "$tree/changed" "$tree/$file"
    count=$((count + 1))
    build $count
    cp "$file" "$tree/$file"
done <bench/skips.txt

k=0
while test $k -le $count; do : >"$tree/times.$k" && k=$((k + 1)); done
round=0
while test $round -lt $rounds; do
    k=0
    while test $k -le $count; do "$tree/$k" windows >>"$tree/times.$k" && k=$((k + 1)); done
    round=$((round + 1))
done
least() { sort -n "$tree/times.$1" | head -n 1; }
echo "# open random bed of 10,000, 100 directions, exact areas, one thread: microseconds per window"
echo "skip,us_with,us_without,ratio,result"
k=1 bad=0
while IFS='|' read -r what file old new; do
    case $what in '#'*) continue ;; esac
    echo "${what% }|$(least 0)|$(least $k)" | awk -F'[| ]' '{n = NF; same = $(n - 2) == $n
        text = $1; for (f = 2; f <= n - 4; f++) text = text " " $f
        printf "\"%s\",%s,%s,%.2f,%s\n", text, $(n - 3), $(n - 1), $(n - 1) / $(n - 3), same ? "same bits" : "other bits"
        exit !same}' || bad=1
    k=$((k + 1))
done <bench/skips.txt
exit $bad
