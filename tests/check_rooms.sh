#!/bin/sh
# check_rooms.sh - no room includes one that it should not know, no folder has more than sixteen sources, and no two
# sources share a name. SPDX-License-Identifier: MIT
set -u

# rooms FOLDER: reads lines "ROOM: other rooms it may include"
rooms() {
    list=$(cat)
    for path in "$1"/*/; do
        room=$(basename "$path")
        allowed=$(echo "$list" | sed -n "s/^$room://p")
        echo "$list" | grep -q "^$room:" || echo "$path: not in the list of tests/check_rooms.sh"
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
pair: base sample
window: base sample
scene: base
store: base
row: base sample pair window scene store
matrix: base scene store
surface: base sample pair scene row
ray: base sample pair window scene row
exchange: base sample pair window scene row ray
heat: base sample pair window scene row ray
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
)
test -z "$faults" && exit
echo "$faults"
exit 1
