#!/bin/sh
# check_freestanding.sh [pin] - the kernel on machines without an operating system or a C library. The kernel must
# build, run from static memory and have the bits of this machine, and docs/embedding.md must have its true sizes.
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

# kernel NAME PREFIX FLAGS TABLES ISAS [LIKE]: builds the archive; with LIKE, from the objects of that one that know
# no tables
kernel() {
    rm -rf "${folder:?}/$1"
    test -z "${6:-}" || like "$1" "$6"
    $MAKE -s BUILD="$folder/$1" CC="$2gcc" AR="$2ar" HOSTCC="$HOSTCC" ISAS="$5" PIC= WERROR=-Werror \
        CFLAGS="-Os -ffunction-sections -fdata-sections -fstack-usage $3" \
        TABLES="-DFIBRAD_PORT_HEADER='\"smoke_port.h\"' -I$here $4" lib >"$folder/log" 2>&1 && return
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

# program NAME PREFIX FLAGS: links the smoke program; nothing but libgcc may be needed
program() {
    # shellcheck disable=SC2086  # flags is a list
    "$2gcc" -std=c11 -Os -ffunction-sections -fdata-sections -ffreestanding -fno-math-errno -ffp-contract=off \
        $3 -Ikernel -I$here $here/smoke.c $here/bare.c "$here/$4" "$folder/$1/libfibrad.a" -nostdlib -lgcc \
        -Wl,--gc-sections -o "$folder/$1/smoke" >"$folder/log" 2>&1 && return
    fault "$1: the smoke program does not link"
    head -n 5 "$folder/log"
}

# run NAME EMULATOR...: the smoke program must print the same as on this machine
run() {
    name=$1
    shift
    if ! command -v "$1" >/dev/null; then
        echo "SKIP smoke program on $name: no $1 on this machine"
    elif ! timeout 300 "$@" >"$folder/$name/out"; then
        fault "$name: the smoke program fails"
    elif ! cmp -s "$folder/out" "$folder/$name/out"; then
        fault "$name: the smoke program has other bits than here"
    else
        echo "$name: $(wc -l <"$folder/out") lines with the bits of this machine"
    fi
}

# sizes NAME PREFIX: a line of the table; bytes of code, tables, and the deepest stack
sizes() {
    code=$("$2size" "$folder/$1/libfibrad.a" | awk '$6 !~ /^(line_table|tables)\.o$/ && NR > 1 {sum += $1} END {print sum}')
    tables=$("$2size" "$folder/$1/libfibrad.a" | awk '$6 ~ /^(line_table|tables)\.o$/ {sum += $1} END {print sum}')
    stack=$($here/stack.sh "$2objdump" "$folder/$1") || {
        fault "$1: $stack"
        stack=0
    }
    echo "| $1 | $code | $tables | $stack |" >>"$table"
}

if ! "$CC" -O2 -std=c11 -Ikernel $here/smoke.c $here/host.c "$BUILD/libfibrad.a" -o "$folder/host" ||
    ! "$folder/host" >"$folder/out"; then
    fault "the smoke program fails here"
fi

m7="-mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard"
rv64="-march=rv64imac -mabi=lp64 -mcmodel=medany"
small="-DFIBRAD_TABLE_AZIMUTHS=0 -DFIBRAD_TABLE_SURFACE=0 -DFIBRAD_TABLE_LINES=0"
{
    echo "| target, \`-Os\` | code | tables | deepest stack |"
    echo "|---|---|---|---|"
} >"$table"
complete=true
if command -v arm-none-eabi-gcc >/dev/null; then
    kernel m7 arm-none-eabi- "$m7" "$small" scalar
    program m7 arm-none-eabi- "$m7 -T$here/arm.ld" arm.c
    run m7 qemu-system-arm -M mps2-an500 -display none -monitor none -serial none \
        -chardev stdio,id=text -semihosting-config enable=on,target=native,chardev=text -kernel "$folder/m7/smoke"
    sizes m7 arm-none-eabi-
    kernel m7-all-tables arm-none-eabi- "$m7" "" scalar m7
    sizes m7-all-tables arm-none-eabi-
else
    echo "SKIP Cortex-M7: no arm-none-eabi-gcc on this machine"
    complete=false
fi
if command -v riscv64-unknown-elf-gcc >/dev/null; then
    kernel rv64 riscv64-unknown-elf- "$rv64" "$small" scalar
    program rv64 riscv64-unknown-elf- "$rv64 -Wl,--no-relax" riscv.c
    run rv64 qemu-riscv64 "$folder/rv64/smoke"
    sizes rv64 riscv64-unknown-elf-
else
    echo "SKIP RV64: no riscv64-unknown-elf-gcc on this machine"
    complete=false
fi
if command -v aarch64-linux-gnu-gcc >/dev/null; then # NEON, that is
    kernel a64 aarch64-linux-gnu- "" "$small" "scalar neon"
    FIBRAD_PORT_SYMBOLS="smoke_sqrt smoke_copy" BUILD=$folder/a64 tests/check_symbols.sh >"$folder/log" ||
        fault "a64: $(cat "$folder/log")"
    program a64 aarch64-linux-gnu- -static aarch64.c
    run a64 qemu-aarch64 "$folder/a64/smoke"
else
    echo "SKIP aarch64: no aarch64-linux-gnu-gcc on this machine"
fi

cat "$table"
# in docs/embedding.md the table stands between two comments
page=docs/embedding.md
if test "${1:-}" = pin; then
    sed -i -e '/^<!-- footprint -->$/,/^<!-- end -->$/{/^|/d}' -e "/^<!-- footprint -->\$/r $table" $page
elif $complete; then
    # Compilers of other versions make other code: half as much again is still true.
    sed -n '/^<!-- footprint -->$/,/^<!-- end -->$/p' $page | grep '^| [mr]' | while IFS='|' read -r _ \
        name code tables stack _; do
        line=$(grep "^|$name|" "$table")
        echo "$line" | awk -F'|' -v code="$code" -v tables="$tables" -v stack="$stack" \
            '{exit !($3 <= 1.05 * code && code <= 1.3 * $3 && $4 == tables && $5 <= 1.3 * stack && stack <= 1.5 * $5)}' ||
            echo "$name: $page says code $code, tables $tables, stack $stack; found $line"
    done >"$folder/differences"
    test -s "$folder/differences" && fault "$(cat "$folder/differences")"
fi
exit $faults
