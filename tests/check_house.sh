#!/bin/sh
# check_house.sh - the order of the house. SPDX-License-Identifier: MIT
#
# Neither folders nor files have a circle of includes. Static functions of the kernel have names of their own, since
# `make dist` writes it as one file. Prose of README.md, SECURITY.md, CHANGELOG.md and docs is within 120 columns, and
# its links lead to files and headings that exist. Tests and benches that docs/trust.md names exist. A source names its
# licence in one line, where tools look for it.
set -u

# pairs TREE: "FILE includes FILE", without suffixes
pairs() {
    find "$1" -name '*.[ch]' -exec grep -HE '^#include "[a-z_]+/' {} + | sed "s|^$1/||; s|:#include \"| |; s|\"\$||; s/\.[ch]\>//g"
}

faults=$(
    # a .c and a .h of one name are one module; the folder lanes belongs to its parent
    for tree in kernel host; do
        pairs $tree | awk '$1 != $2' | tsort 2>&1 >/dev/null | sed "s|^|a circle of includes in $tree: |"
        pairs $tree | grep / | sed 's|/[^/ ]*\( \)|\1|; s|/[^/]*$||; s|/lanes\>||g' | awk '$1 != $2' | sort -u |
            tsort 2>&1 >/dev/null | sed "s|^|a circle of folders in $tree: |"
    done

    find kernel -name '*.c' -exec awk '
        /^(static|FIBRAD_INLINE)[^=;]*\(/ && !/;$/ {
            sub(/LANED\(/, ""); sub(/[()].*/, ""); sub(/.*[ *]/, "")
            print $0 (FILENAME ~ /_lanes/ ? "_ISA" : "") " " FILENAME
        }' {} + | sort -u | awk '
        $1 == last { print $2 " and " file ": static " $1 } { last = $1; file = $2 }'

    awk '/^```/ { code = !code } FNR == 1 { code = 0 }
        !code && !/^\|/ && length($0) > 120 { print FILENAME ":" FNR ": " length($0) " columns" }' \
        README.md SECURITY.md CHANGELOG.md docs/*.md
    grep -rn --include='*.[ch]' 'SPDX-License-Identifier:$' kernel host tests bench | sed 's/$/ the licence is a line below/'
    tr '`' '\n' <docs/trust.md | grep -E '^([a-z]+/)?(test|check|bench)_[a-z_]+(\.sh)?(:|$)' | while IFS=: read -r file names; do
        source=
        for path in "tests/$file" "tests/$file.c" "tests/$file.py" "bench/$file.c"; do test -f "$path" && source=$path; done
        test -n "$source" || echo "docs/trust.md: no $file"
        for name in $names; do
            grep -qE "(TEST\(|void |def )$name\>" "${source:-/dev/null}" || echo "docs/trust.md: no $name in $file"
        done
    done
    # lines "PAGE LINK FILE", FILE from here; a heading that is not there has no FILE
    # shellcheck disable=SC2046  # pages
    awk '
        function slug(text) { text = tolower(text); gsub(/[^a-z0-9 _-]/, "", text); gsub(/ /, "-", text); return text }
        !links { if (/^##* /) { sub(/^##* /, ""); heading[FILENAME "#" slug($0)] } next }
        {
            folder = FILENAME
            sub(/[^\/]*$/, "", folder)
            while (match($0, /\]\([^):]+\)/)) {
                link = substr($0, RSTART + 2, RLENGTH - 3)
                $0 = substr($0, RSTART + RLENGTH)
                file = link
                sub(/#.*/, "", file)
                file = file == "" ? FILENAME : folder file
                while (sub(/[^\/]+\/\.\.\//, "", file)) continue
                at = index(link, "#")
                if (at && !((file "#" substr(link, at + 1)) in heading)) file = ""
                print FILENAME, link, file
            }
        }' $(ls README.md SECURITY.md docs/*.md) links=1 $(ls README.md SECURITY.md docs/*.md) |
        while read -r page link file; do test -n "$file" && test -e "$file" || echo "$page: no $link"; done
)
test -z "$faults" && exit
echo "$faults"
exit 1
