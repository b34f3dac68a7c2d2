#!/bin/sh
# check_house.sh - the order of the house. SPDX-License-Identifier: MIT
#
# No room includes one that it should not know; no circle of includes among files; at most sixteen sources in a folder;
# no two sources, and no two static functions of kernel and host, share a name; the field's words and not our own; lines
# of README.md within 140 columns.
set -u

# what the field has other words for, or what says less than a plain verb
words='accounts|taker|takers|doubtful|in doubt|emergence|sieve|sieves|plain sweep|gets farther|had better|books|lacks|fibrad_moved_[a-z]*'

# rooms FOLDER: reads lines "ROOM: other rooms it may include"
rooms() {
    list=$(cat)
    for path in "$1"/*/; do
        room=$(basename "$path")
        allowed=$(echo "$list" | sed -n "s/^$room://p")
        echo "$list" | grep -q "^$room:" || echo "$path: not in the list of tests/check_house.sh"
        grep -rE '^#include "[a-z_]+/' "$path" | sed 's/:#include "/ /; s/"$//' | while read -r file header; do
            case " $room $allowed " in
            *" ${header%%/*} "*) ;;
            *) echo "$file: $room/ should not know $header" ;;
            esac
        done
    done
}

faults=$(
    rooms kernel <<LIST
base:
sample: base
pair: base
scene: base
store: base
window: base sample
row: base sample scene store window
surface: base sample scene row
matrix: base scene store
ray: base sample scene row window
exchange: base sample scene row ray
heat: base sample scene row ray
furnace: base
LIST
    rooms host <<LIST
simple:
cli:
bed: cli simple
read: cli bed
boxes: cli bed
write: cli bed simple boxes
plot: cli bed simple boxes write
reference: cli
reproduce: cli bed simple boxes write plot reference
command: cli bed read simple boxes write plot reference reproduce
examples:
LIST
    find kernel host -name '*.[ch]' | sed 's|.*/||' | sort | uniq -d | sed 's/$/: a name of two sources/'
    find kernel host -name '*.[ch]' | sed 's|/[^/]*$||' | sort | uniq -c | awk '$1 > 16 {print $2 ": " $1 " sources"}'

    # a module is what a .c and a .h of one name make up
    for tree in kernel host; do
        find $tree -name '*.[ch]' -exec grep -HE '^#include "[a-z_]+/' {} + | sed "s|^$tree/||; s|:#include \"| |; s|\"\$||; s/\.[ch]\>//g" |
            awk '$1 != $2' | tsort 2>&1 >/dev/null | sed "s|^|a circle of includes in $tree: |"
    done

    find kernel host -name '*.c' -exec awk '
        /^(static|FIBRAD_INLINE)[^=;]*\(/ && !/;$/ {
            sub(/\(.*/, ""); sub(/.*[ *]/, ""); print $0 " " FILENAME
        }' {} + | sort -u | awk '
        $1 == last { print $2 " and " file ": static " $1 } { last = $1; file = $2 }'

    grep -rnwiE --include='*.[ch]' --include='*.md' "$words" kernel host tests bench docs README.md CHANGELOG.md
    awk 'length($0) > 140 {print "README.md:" NR ": " length($0) " columns"}' README.md
)
test -z "$faults" && exit
echo "$faults"
exit 1
