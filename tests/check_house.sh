#!/bin/sh
# check_house.sh - the order of the house. SPDX-License-Identifier: MIT
#
# Files have no circle of includes. A folder has at most sixteen sources. No two sources, and no two static functions of
# kernel and host, share a name. The banned words below do not occur. Prose of README.md, SECURITY.md, CHANGELOG.md and
# docs is within 120 columns, and its links lead to files and headings that exist. Each line of tests/mutants.txt stands
# once in its file. Tests and benches that docs/trust.md names exist. A source names its licence in one line, where tools
# look for it. tests/check_map.sh checks which folder includes which.
set -u

# banned: the field has other words for these, or a plain verb says more; the changelog may have old names
words='accounts|taker|takers|doubtful|in doubt|emergence|sieve|sieves|plain sweep|gets farther|had better|books|fibrad_moved_[a-z]*'

faults=$(
    find kernel host -name '*.[ch]' | sed 's|.*/||' | sort | uniq -d | sed 's/$/: a name of two sources/'
    find kernel host -name '*.[ch]' | sed 's|/[^/]*$||' | sort | uniq -c | awk '$1 > 16 {print $2 ": " $1 " sources"}'

    # a .c and a .h of one name are one module
    for tree in kernel host; do
        find $tree -name '*.[ch]' -exec grep -HE '^#include "[a-z_]+/' {} + | sed "s|^$tree/||; s|:#include \"| |; s|\"\$||; s/\.[ch]\>//g" |
            awk '$1 != $2' | tsort 2>&1 >/dev/null | sed "s|^|a circle of includes in $tree: |"
    done

    find kernel host -name '*.c' -exec awk '
        /^(static|FIBRAD_INLINE)[^=;]*\(/ && !/;$/ {
            sub(/LANED\(/, ""); sub(/[()].*/, ""); sub(/.*[ *]/, ""); print $0 " " FILENAME
        }' {} + | sort -u | awk '
        $1 == last { print $2 " and " file ": static " $1 } { last = $1; file = $2 }'

    grep -rnwiE --include='*.[ch]' --include='*.md' "$words" kernel host tests bench docs README.md SECURITY.md
    awk '/^```/ { code = !code } FNR == 1 { code = 0 }
        !code && !/^\|/ && length($0) > 120 { print FILENAME ":" FNR ": " length($0) " columns" }' \
        README.md SECURITY.md CHANGELOG.md docs/*.md
    grep -rn --include='*.[ch]' 'SPDX-License-Identifier:$' kernel host tests bench | sed 's/$/ the licence is a line below/'
    grep -v '^#' tests/mutants.txt | while IFS='|' read -r file old new; do
        old=${old# } old=${old% }
        test -n "$new" && test "$(grep -cF -- "$old" "${file% }")" = 1 || echo "tests/mutants.txt: $file does not have once: $old"
    done
    tr '`' '\n' <docs/trust.md | grep -E '^([a-z]+/)?(test|check|bench)_[a-z_]+(\.sh)?(:|$)' | while IFS=: read -r file names; do
        source=
        for path in "tests/$file" "tests/$file.c" "tests/$file.py" "bench/$file.c"; do test -f "$path" && source=$path; done
        test -n "$source" || echo "docs/trust.md: no $file"
        for name in $names; do
            grep -qE "(TEST\(|void |def )$name\>" "${source:-/dev/null}" || echo "docs/trust.md: no $name in $file"
        done
    done
    for page in README.md SECURITY.md docs/*.md; do
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
