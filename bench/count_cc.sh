#!/bin/sh
# count_cc.sh - a compiler whose objects count the instructions they execute. SPDX-License-Identifier: MIT
#
#     make CC="bench/count_cc.sh gcc" HOSTCC=gcc lib
#
# For x86-64 and aarch64, and for one thread. A block goes from a label or jump to the next one. Code before each
# block adds the number of its instructions to instructions_counted and keeps all registers and flags. Otherwise the
# compiler's assembly stays as it is. Repeated string instructions count once. Instructions of other libraries do not
# count. The caller defines uint64_t instructions_counted[2], of which the second is scratch.
set -eu
case " $* " in
*" -c "*" -o "*) ;;
*) exec "$@" ;;
esac
compiler=$(echo "$*" | sed 's/ -.*//') object=$(echo " $* " | sed 's/.* -o \([^ ]*\) .*/\1/')
for argument; do
    shift
    test "$argument" != "$object" || argument=$object.plain
    set -- "$@" "$argument"
done
"$@" -g0 -S -MF "${object%.o}.d" -MT "$object"
awk -v machine="$($compiler -dumpmachine)" '
function flush(   k) {
    if (count > 0 && machine ~ /^aarch64/) {
        print "\tstp x16, x17, [sp, -16]!\n\tadrp x16, instructions_counted"
        print "\tldr x17, [x16, #:lo12:instructions_counted]\n\tadd x17, x17, #" count
        print "\tstr x17, [x16, #:lo12:instructions_counted]\n\tldp x16, x17, [sp], 16"
    } else if (count > 0) {
        print "\tmovq %rax, 8+instructions_counted(%rip)\n\tlahf\n\tseto %al"
        print "\taddq $" count ", instructions_counted(%rip)"
        print "\taddb $127, %al\n\tsahf\n\tmovq 8+instructions_counted(%rip), %rax"
    }
    for (k = 0; k < held; k++) print line[k]
    count = held = 0
}
/^[^\t #].*:/ {flush(); print; next}
/^\t(\.section|\.text|\.data|\.bss)/ {flush(); print; next}
/^[ \t]*([.#]|\/\/|$)/ {line[held++] = $0; next}
{line[held++] = $0; count++}
/^\t(j|ret|notrack jmp|(b|br|b\.?[a-z][a-z]|cbn?z|tbn?z)\t)/ {flush()}
END {flush()}' "$object.plain" >"$object.s"
$compiler -c "$object.s" -o "$object"
rm "$object.plain" "$object.s"
