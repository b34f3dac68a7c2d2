#!/bin/sh
# find_python.sh MODULE... - prints a Python that has these modules, nothing if there is none: Debian's own python3 may
# have what another in the path has not. SPDX-License-Identifier: MIT
modules=$(echo "$*" | sed 's/ /, /g')
for python in python3 /usr/bin/python3; do
    if "$python" -c "import $modules" 2>/dev/null; then
        echo "$python"
        exit
    fi
done
