#!/bin/sh
# check_examples.sh - the complete programs in README.md and docs/ build without warnings and run. SPDX-License-Identifier: MIT
#
# Programs are blocks of C or C++ with a main, and files of docs/examples that include fibrad. They are linked with
# libfibrad.a, those that include fibrad_host.h also with libfibrad_host.a. A comment in the page before a block,
#     <!-- at most NUMBER lines from FIRST to LAST -->
# bounds the lines of code from the first line that begins with FIRST to the next one that begins with LAST, indented or
# not (a LAST of } is not indented), as .clang-format has them.
set -u
: "${BUILD:=build}" "${CC:=cc}" "${CXX:=c++}"
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
warnings="-pedantic -Wall -Wextra -Werror"
tidy=$(command -v clang-format-14 || command -v clang-format) || echo "SKIP format of examples: no clang-format"

# each block with a main becomes a file named after its page and line; its bound stands beside it in FILE.bound
awk -v to="$work" '
    /^<!-- at most .* -->$/ { bound = $0; next }
    /^```(c|cpp)$/ {
        name = FILENAME; gsub("/", "_", name)
        name = to "/" name "_" FNR "." substr($0, 4); text = ""; inside = 1; next
    }
    /^```/ {
        if (inside && text ~ /int main\(/) {
            printf "%s", text > name
            if (bound != "") print bound > (name ".bound")
        }
        inside = 0; bound = ""; next
    }
    inside { text = text $0 "\n"; next }
    NF { bound = "" }' README.md docs/*.md
for program in docs/examples/*; do
    if grep -q '^#include "fibrad' "$program"; then cp "$program" "$work/docs_examples_${program##*/}" || exit 1; fi
done

# lines of code from FIRST to LAST in FILE, without blank lines and lines of comment; 0: not found
lines_of() { # FILE FIRST LAST
    awk -v first="$2" -v last="$3" '
        { line = $0; sub(/^ */, "", line) }
        !on && !off && index(line, first) == 1 { on = 1 }
        on && line != "" && line !~ /^\/[*\/]/ { count++ }
        on && index(last == "}" ? $0 : line, last) == 1 { off = 1; on = 0 }
        END { print off ? count : 0 }' "$1"
}

check_bound() { # FILE
    bound=$(sed 's/^<!-- at most //; s/ -->$//' "$1.bound")
    first=${bound#* lines from }
    count=$(lines_of "$1" "${first%% to *}" "${first##* to }")
    echo "    $count of ${bound%% *} lines"
    test "$count" -gt 0 && test "$count" -le "${bound%% *}"
}

build() { # FILE
    libraries="$BUILD/libfibrad.a"
    include=-Ikernel
    openmp=
    if grep -q '^#include "fibrad_host\.h"' "$1"; then
        libraries="$BUILD/libfibrad_host.a $BUILD/libfibrad.a -lm"
        include="-Ikernel -Ihost/simple"
    fi
    if grep -qE '^#pragma omp|^#include "fibrad_host\.h"' "$1"; then openmp=-fopenmp; fi
    case $1 in
    *.cpp) compiler="$CXX -std=c++11" ;;
    *) compiler="$CC -std=c11" ;;
    esac
    # shellcheck disable=SC2086  # lists of flags
    $compiler $warnings $openmp $include "$1" $libraries -o "$work/example"
}

programs=0
for program in "$work"/*.c "$work"/*.cpp; do
    test -f "$program" || continue
    echo "${program##*/}"
    case $program in
    *.cpp) command -v "$CXX" >/dev/null || { echo "SKIP example in C++: no $CXX on this machine" && continue; } ;;
    esac
    test -z "$tidy" || "$tidy" --style=file:.clang-format --dry-run --Werror "$program" || exit 1
    test ! -f "$program.bound" || check_bound "$program" || exit 1
    build "$program" && (cd "$work" && ./example >example.out) || exit 1
    programs=$((programs + 1))
done
test "$programs" -gt 0 || echo "README.md and docs/ hold no complete program"
test "$programs" -gt 0
