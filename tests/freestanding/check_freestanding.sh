#!/bin/sh
# check_freestanding.sh [pin] - the kernel on a Cortex-M7, without an operating system or a C library. It must build,
# run from static memory and have the bits of this machine, and docs/embedding.md must have its true sizes.
# SPDX-License-Identifier: MIT
#
# `pin` writes the sizes into the table of docs/embedding.md, between the lines "footprint".
set -u
: "${BUILD:=build}" "${MAKE:=make}" "${CC:=cc}" "${HOSTCC:=cc}"
faults=0
here=tests/freestanding
folder=$BUILD/freestanding
table=$folder/table
mkdir -p "$folder"

fault() {
    echo "$1"
    faults=1
}

# kernel NAME TABLES [LIKE]: builds the archive; with LIKE, from the objects of that one that know no tables
kernel() {
    rm -rf "${folder:?}/$1"
    test -z "${3:-}" || like "$1" "$3"
    $MAKE -s BUILD="$folder/$1" CC=arm-none-eabi-gcc AR=arm-none-eabi-ar HOSTCC="$HOSTCC" ISAS=scalar PIC= \
        WERROR=-Werror CFLAGS="-Os -ffunction-sections -fdata-sections -fstack-usage $m7" \
        TABLES="-DFIBRAD_PORT_HEADER='\"smoke_port.h\"' -I$here $2" lib >"$folder/log" 2>&1 && return
    fault "$1: the kernel does not build"
    head -n 5 "$folder/log"
}

# like NAME OTHER: takes the objects of OTHER that are the same for all tables
like() {
    cp -rp "$folder/$2" "$folder/$1"
    rm -f "$folder/$1/libfibrad.a" "$folder/$1/tables.o"
    find "$folder/$1" -name '*.d' -exec grep -l 'sample/tables\.h' {} + | sed 's/d$/o/' | xargs rm -f
    find "$folder/$1" -name '*.d' -delete
}

# sizes NAME: a line of the table; bytes of code, tables, and the deepest stack
sizes() {
    code=$(arm-none-eabi-size "$folder/$1/libfibrad.a" |
        awk '$6 !~ /^(line_table|tables)\.o$/ && NR > 1 {sum += $1} END {print sum}')
    tables=$(arm-none-eabi-size "$folder/$1/libfibrad.a" |
        awk '$6 ~ /^(line_table|tables)\.o$/ {sum += $1} END {print sum}')
    stack=$($here/stack.sh arm-none-eabi-objdump "$folder/$1") || {
        fault "$1: $stack"
        stack=0
    }
    echo "| $1 | $code | $tables | $stack |" >>"$table"
}

if ! command -v arm-none-eabi-gcc >/dev/null; then
    echo "SKIP Cortex-M7: no arm-none-eabi-gcc on this machine"
    exit 0
fi
if ! "$CC" -O2 -std=c11 -Ikernel $here/smoke.c $here/host.c "$BUILD/libfibrad.a" -o "$folder/host" ||
    ! "$folder/host" >"$folder/out"; then
    fault "the smoke program fails here"
fi

m7="-mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard"
{
    echo "| target, \`-Os\` | code | tables | deepest stack |"
    echo "|---|---|---|---|"
} >"$table"
kernel m7 "-DFIBRAD_TABLE_AZIMUTHS=0 -DFIBRAD_TABLE_SURFACE=0 -DFIBRAD_TABLE_LINES=0"
# nothing but libgcc may be needed
# shellcheck disable=SC2086  # m7 is a list
if ! arm-none-eabi-gcc -std=c11 -Os -ffunction-sections -fdata-sections -ffreestanding -fno-math-errno \
    -ffp-contract=off $m7 -T$here/arm.ld -Ikernel -I$here $here/smoke.c $here/bare.c $here/arm.c \
    "$folder/m7/libfibrad.a" -nostdlib -lgcc -Wl,--gc-sections -o "$folder/m7/smoke" >"$folder/log" 2>&1; then
    fault "the smoke program does not link"
    head -n 5 "$folder/log"
elif ! command -v qemu-system-arm >/dev/null; then
    echo "SKIP smoke program: no qemu-system-arm on this machine"
elif ! timeout 300 qemu-system-arm -M mps2-an500 -display none -monitor none -serial none -chardev stdio,id=text \
    -semihosting-config enable=on,target=native,chardev=text -kernel "$folder/m7/smoke" >"$folder/m7/out"; then
    fault "the smoke program fails"
elif ! cmp -s "$folder/out" "$folder/m7/out"; then
    fault "the smoke program has other bits than here"
else
    echo "m7: $(wc -l <"$folder/out") lines with the bits of this machine"
fi
sizes m7
kernel m7-all-tables "" m7
sizes m7-all-tables

cat "$table"
# in docs/embedding.md the table stands between two comments
page=docs/embedding.md
if test "${1:-}" = pin; then
    sed -i -e '/^<!-- footprint -->$/,/^<!-- end -->$/{/^|/d}' -e "/^<!-- footprint -->\$/r $table" $page
else
    # Compilers of other versions make other code: half as much again is still true.
    sed -n '/^<!-- footprint -->$/,/^<!-- end -->$/p' $page | grep '^| m7' | while IFS='|' read -r _ \
        name code tables stack _; do
        line=$(grep "^|$name|" "$table")
        echo "$line" | awk -F'|' -v code="$code" -v tables="$tables" -v stack="$stack" \
            '{exit !($3 <= 1.05 * code && code <= 1.3 * $3 && $4 == tables && $5 <= 1.3 * stack && stack <= 1.5 * $5)}' ||
            echo "$name: $page says code $code, tables $tables, stack $stack; found $line"
    done >"$folder/differences"
    test -s "$folder/differences" && fault "$(cat "$folder/differences")"
fi
exit $faults
