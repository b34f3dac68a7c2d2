#!/bin/sh
# check_man.sh - manual pages have the whole text of --help, and groff and mandoc accept them. Completion in bash offers
# commands, options and files. SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}" "${MAKE:=make}"
export LC_ALL=C
fibrad=$BUILD/fibrad
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
faults=0
fault() {
    echo "$@"
    faults=1
}

$MAKE -s --no-print-directory BUILD="$BUILD" man || exit 1
"$fibrad" --help >"$work/help"
commands=$(sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p' "$work/help")
count=$(echo "$commands" | wc -w)
test "$count" -ge 7 || fault "only $count commands"

# ---- pages: as many as commands, and one; all words of the help in their order but headings and synopsis
words() { sed 's/  */\n/g' | grep -v '^$'; }
if command -v groff >/dev/null; then
    for name in "" $commands; do
        page=$BUILD/man/fibrad${name:+-$name}.1
        groff -man -Tascii -P-cbou -ww -rLL=400n "$page" >"$work/page" 2>"$work/err" || fault "$page: groff fails"
        test -s "$work/err" && fault "$page: $(head -n 2 "$work/err")"
        if test -z "$name"; then
            sed -n '3,$p' "$work/help" | sed "s/^Commands://; s/^Exit status://; s/^  \([a-z][a-z]*\) /  fibrad-\1(1) /"
        else
            "$fibrad" "$name" --help all | sed 's/^Examples:$//'
        fi | words >"$work/expected"
        sed '/^NAME$/,/^SYNOPSIS$/d; /^[A-Z ]*$/d; /^SEE ALSO$/,$d' "$work/page" | words >"$work/found"
        # the page may have more, at the beginning and the end
        diff "$work/expected" "$work/found" | grep '^<' | grep -v '^< \(FIBRAD\)' >"$work/missing"
        test -s "$work/missing" && fault "$page: is not said: $(head -n 5 "$work/missing" | tr '\n' ' ')"
        grep -q "^ *fibrad${name:+-$name} - [a-z]" "$work/page" || fault "$page: no purpose"
    done
else
    echo "SKIP manual pages: no groff on this machine"
fi
if command -v mandoc >/dev/null; then
    mandoc -T lint -W error "$BUILD"/man/*.1 || faults=1
fi
test "$(find "$BUILD/man" -type f | wc -l)" = $((count + 1)) || fault "other files in $BUILD/man"

# ---- completion
# complete_words WORD...: the completions of the last word
complete_words() {
    (cd "$work/files" && bash -c '
        source "$0"
        program=$1 && shift
        COMP_WORDS=(fibrad "$@") COMP_CWORD=$#
        _fibrad "$program" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
        test ${#COMPREPLY[@]} -gt 0 && printf "%s\n" "${COMPREPLY[@]}"' "$completion" "$program" "$@" | sort | tr '\n' ' ')
}
offers() { # EXPECTED WORD...
    expected=$1
    shift
    found=$(complete_words "$@")
    test "$found" = "${expected:+$expected }" || fault "fibrad $*: offers '$found' instead of '$expected'"
}
if command -v bash >/dev/null; then
    completion=$PWD/host/cli/man/fibrad.bash
    case $fibrad in /*) program=$fibrad ;; *) program=$PWD/$fibrad ;; esac
    mkdir "$work/files" && touch "$work/files/bed one.dump" "$work/files/bed.csv" "$work/files/-odd"
    for name in $commands; do
        offers "$name" "$name"
        complete_words "$name" -- | tr ' ' '\n' >"$work/offered"
        for option in $("$fibrad" "$name" --help all | sed -n 's/^  \(-., \)\{0,1\}\(--[a-z-]*\) .*/\2/p'); do
            grep -qx -e "$option" "$work/offered" || fault "fibrad $name $option: not offered"
        done
    done
    test "$(complete_words "" | wc -w)" -ge 12 || fault "fibrad: offers '$(complete_words "")'"
    offers "heat help" he
    offers "heat" help he
    offers "--targets" factors --tar
    offers "-o" factors -o
    offers "bed one.dump bed.csv" factors be
    offers "bed.csv" factors -o bed.
    offers "bed.csv" factors --output = bed.
    offers "-odd" factors -- -o
    offers "" factors --no-such
    offers "" nothing --a
else
    echo "SKIP completion: no bash on this machine"
fi
exit $faults
