#!/bin/sh
# check_map.sh - the table of folders in docs/design.md is that of the tree, and has no circles. SPDX-License-Identifier: MIT
#
# Lines of the table are | FOLDER | what for | FILES without .c and .h | OTHER FOLDERS of the same tree it includes from |.
# Folders of Python and Fortran are in it, too; they include nothing.
set -u
page=docs/design.md
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1

# lines "FOLDER: FILES / FOLDERS", as the page says
awk -F ' *[|] *' '
    function sorted(list,    words, n, i, j, word) {
        n = split(list, words, " ")
        for (i = 2; i <= n; i++)
            for (j = i; j > 1 && words[j] < words[j - 1]; j--) {
                word = words[j]; words[j] = words[j - 1]; words[j - 1] = word
            }
        list = ""
        for (i = 1; i <= n; i++) list = list words[i] " "
        return list
    }
    $2 ~ /^(kernel|host)(\/|$)/ { print $2 ": " sorted($4) "/ " sorted($5) }' "$page" | LC_ALL=C sort >"$work/page"

# the same from the tree; the folder lanes belongs to its parent
find kernel host -name '*.[ch]' -o -name '*.py' -o -name '*.f90' | sed 's|/[^/]*$||' | LC_ALL=C sort -u | while read -r folder; do
    files=$(find "$folder" -maxdepth 1 -name '*.[ch]' -o -maxdepth 1 -name '*.py' -o -maxdepth 1 -name '*.f90' |
        sed 's|.*/||; s|\.[a-z0-9]*$||' | LC_ALL=C sort -u | tr '\n' ' ')
    room=${folder#*/}
    knows=$(find "$folder" -maxdepth 1 -name '*.[ch]' -exec sed -n 's/^#include "\([a-z_/]*\)\/.*/\1/p' {} + |
        sed 's|/lanes$||' |
        grep -vx "$room" | LC_ALL=C sort -u | tr '\n' ' ')
    echo "$folder: $files/ $knows"
done | LC_ALL=C sort >"$work/tree"

test -s "$work/page" || { echo "$page has no table of folders" && exit 1; }
if ! LC_ALL=C diff "$work/page" "$work/tree"; then
    echo "< $page, > the tree (folder: files / folders it includes from)"
    exit 1
fi

for tree in kernel host; do
    sed -n "s|^$tree/\(.*\): .*/ |\1 |p" "$work/page" | awk '{ for (i = 2; i <= NF; i++) print $1, $i }' |
        tsort 2>&1 >/dev/null | sed "s|^|a circle of folders in $tree: |"
done >"$work/circles"
cat "$work/circles"
test ! -s "$work/circles"
