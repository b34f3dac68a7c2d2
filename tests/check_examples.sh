#!/bin/sh
# check_examples.sh - the complete C programs in README.md and docs/ build without warnings and run.
# SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}" "${CC:=cc}"
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1

# each block of C with a main becomes a file named after the page and its line
awk -v to="$work" '
    /^```c$/ { name = FILENAME; gsub("/", "_", name); name = to "/" name "_" FNR ".c"; text = ""; inside = 1; next }
    /^```/ { if (inside && text ~ /int main\(/) printf "%s", text > name; inside = 0 }
    inside { text = text $0 "\n" }' README.md docs/*.md

status=1
for program in "$work"/*.c; do
    echo "${program##*/}"
    "$CC" -std=c11 -pedantic -Wall -Wextra -Werror -Ikernel "$program" "$BUILD/libfibrad.a" -o "$work/example" &&
        (cd "$work" && ./example >example.out) || exit 1
    status=0
done
test $status -eq 0 || echo "README.md and docs/ hold no complete program"
exit $status
