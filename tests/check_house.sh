#!/bin/sh
# check_house.sh - the order of the house. SPDX-License-Identifier: MIT
#
# No circle of includes among files; at most sixteen sources in a folder; no two sources, and no two static functions of
# kernel and host, share a name; the field's words and not our own; prose of README.md and docs within 120 columns, links
# there to files and headings that exist; the lines of tests/mutants.txt stand once. Which folder may include which:
# tests/check_map.sh.
set -u

# what the field has other words for, or what says less than a plain verb; the changelog has names of before
words='accounts|taker|takers|doubtful|in doubt|emergence|sieve|sieves|plain sweep|gets farther|had better|books|fibrad_moved_[a-z]*'

faults=$(
    find kernel host -name '*.[ch]' | sed 's|.*/||' | sort | uniq -d | sed 's/$/: a name of two sources/'
    find kernel host -name '*.[ch]' | sed 's|/[^/]*$||' | sort | uniq -c | awk '$1 > 16 {print $2 ": " $1 " sources"}'

    # a module is what a .c and a .h of one name make up
    for tree in kernel host; do
        find $tree -name '*.[ch]' -exec grep -HE '^#include "[a-z_]+/' {} + | sed "s|^$tree/||; s|:#include \"| |; s|\"\$||; s/\.[ch]\>//g" |
            awk '$1 != $2' | tsort 2>&1 >/dev/null | sed "s|^|a circle of includes in $tree: |"
    done

    find kernel host -name '*.c' -exec awk '
        /^(static|FIBRAD_INLINE)[^=;]*\(/ && !/;$/ {
            sub(/LANED\(/, ""); sub(/[()].*/, ""); sub(/.*[ *]/, ""); print $0 " " FILENAME
        }' {} + | sort -u | awk '
        $1 == last { print $2 " and " file ": static " $1 } { last = $1; file = $2 }'

    grep -rnwiE --include='*.[ch]' --include='*.md' "$words" kernel host tests bench docs README.md
    awk '/^```/ { code = !code } FNR == 1 { code = 0 }
        !code && !/^\|/ && length($0) > 120 { print FILENAME ":" FNR ": " length($0) " columns" }' README.md docs/*.md
    grep -v '^#' tests/mutants.txt | while IFS='|' read -r file old new; do
        old=${old# } old=${old% }
        test -n "$new" && test "$(grep -cF -- "$old" "${file% }")" = 1 || echo "tests/mutants.txt: $file does not have once: $old"
    done
    for page in README.md docs/*.md; do
        grep -oE '\]\([^)#:]+' "$page" | sed 's|^](||' | while read -r link; do
            test -e "$(dirname "$page")/$link" || echo "$page: no $link"
        done
        grep -oE '\]\([^):]*#[^)]+' "$page" | sed 's|^](||' | while IFS='#' read -r file heading; do
            target=$page
            test -n "$file" && target=$(dirname "$page")/$file
            sed -n 's/^##* //p' "$target" | tr '[:upper:]' '[:lower:]' | sed 's/[^a-z0-9 _-]//g; s/ /-/g' |
                grep -qxF -- "$heading" || echo "$page: no $file#$heading"
        done
    done
)
test -z "$faults" && exit
echo "$faults"
exit 1
