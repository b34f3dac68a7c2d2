#!/bin/sh
# check_header.sh - each public header stands alone in C99, C11, C++11 and C++17. SPDX-License-Identifier: MIT
set -u
status=0
check() { # COMPILER LANGUAGE STANDARD
    if command -v "$1" >/dev/null; then
        for header in fibrad.h fibrad_heat.h fibrad_light.h fibrad_mesh.h fibrad_surface.h fibrad_furnace.h fibrad_host.h; do
            printf '#include "%s"\nint main(void) { return fibrad_status_text(FIBRAD_OK) == 0; }\n' $header |
                "$1" -x "$2" -std="$3" -pedantic-errors -Wall -Wextra -Werror -Ikernel -Ihost/simple -fsyntax-only - ||
                status=1
        done
    else
        echo "SKIP headers in $3: no $1 on this machine"
    fi
}
check "${CC:=cc}" c c99
check "$CC" c c11
check "${CXX:=c++}" c++ c++11
check "$CXX" c++ c++17
exit $status
