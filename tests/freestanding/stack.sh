#!/bin/sh
# stack.sh OBJDUMP FOLDER - bytes of stack that the deepest chain of calls takes. SPDX-License-Identifier: MIT
#
# Sizes of frames come from the compiler (-fstack-usage), calls from the disassembly. Calls through pointers are added
# by name: those of fibrad_surface_factor, of fibrad_row_run to the methods, of fibrad_matrix_share to the pieces, of
# fibrad_walls_complete to the frames of windows, and of each_overlap. The caller's functions that resize memory and divide work are not
# counted. The script fails on recursion, on frames without a bound and on other calls through pointers.
set -u
find "$2" -name '*.su' -exec cat {} + | awk -F'[:\t]' '{print "frame", $4, $5, $6}' >"$2/frames"
{
    cat "$2/frames"
    "$1" -dr "$2/libfibrad.a" | awk '
        /^[0-9a-f]+ <[^.].*>:$/ {gsub(/[<>:]/, "", $2); from = $2; sub(/\.(part|constprop|isra)\..*/, "", from)}
        /R_ARM_(THM_)?(CALL|JUMP24)/ {
            to = $NF; sub(/[-+].*/, "", to); sub(/^\.text\./, "", to); sub(/\.(part|constprop|isra)\..*/, "", to)
            if (to != from && to !~ /^\./) print "call", from, to}
        /\tblx\tr/ && from !~ /^(fibrad_surface_factor|fibrad_row_run|attempt|fibrad_memory_reserve|fit|fibrad_matrix_share|fibrad_walls_complete_scalar|add_hidden|each_overlap)$/ {
            print "pointer", from}'
    for version in filter sum; do echo "call fibrad_surface_factor fibrad_surface_${version}_scalar"; done
    for frame in frame_of_beam frame_of_window; do
        echo "call fibrad_walls_complete_scalar ${frame}_scalar"
        echo "call add_hidden ${frame}_scalar"
    done
    for method in beam_to_tolerance cast_compute exchange_compute surface_compute; do
        grep -q "^frame $method " "$2/frames" || echo "gone $method"
        echo "call fibrad_row_run $method"
    done
    for met in check_overlap note_inside; do
        grep -q "^frame $met " "$2/frames" || echo "gone $met"
        echo "call each_overlap $met"
    done
    sed -n 's/.*fibrad_matrix_share([^,]*, [^,]*, \([a-z_]*\),.*/call fibrad_matrix_share \1/p' kernel/matrix/*.c
} | awk '
    $1 == "frame" {
        name = $2; sub(/\.(part|constprop|isra)\..*/, "", name)
        if ($3 > frame[name]) frame[name] = $3
        if ($4 !~ /static/ && $4 !~ /bounded/) {print name " has a frame without a bound"; failed = 1}
    }
    $1 == "pointer" {print $2 " calls through a pointer"; failed = 1}
    $1 == "gone" {print $2 " is no function any more"; failed = 1}
    $1 == "call" && !(($2, $3) in known) {known[$2, $3]; calls[$2] = calls[$2] " " $3}
    function depth(name,   list, n, k, most, d) {
        if (state[name] == 1) {print "recursion through " name; failed = 1; return 0}
        if (state[name] == 2) return total[name]
        state[name] = 1; most = 0; n = split(calls[name], list, " ")
        for (k = 1; k <= n; k++) {d = depth(list[k]); if (d > most) most = d}
        state[name] = 2
        return total[name] = frame[name] + most
    }
    END {
        for (name in frame) {d = depth(name); if (d > worst) {worst = d; at = name}}
        if (!failed) print worst " in " at
        exit failed
    }'
