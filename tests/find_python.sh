#!/bin/sh
# find_python.sh MODULE... - prints a Python that has these modules, or nothing. Debian's own python3 may have modules
# that another python3 in the path lacks. SPDX-License-Identifier: MIT
modules=$(echo "$*" | sed 's/ /, /g')
for python in python3 /usr/bin/python3; do
    if "$python" -c "import $modules" 2>/dev/null; then
        echo "$python"
        exit
    fi
done
