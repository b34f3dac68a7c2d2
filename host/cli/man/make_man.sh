#!/bin/sh
# make_man.sh FIBRAD FOLDER - the manual pages of the program and its commands, made from --help.
# SPDX-License-Identifier: MIT
set -eu
fibrad=$1 folder=$2
version=$("$fibrad" --version | cut -d ' ' -f 2)

page() { # NAME PURPOSE: the text on standard input
    awk -v page="$1" -v purpose="$2" -v version="$version" -f host/cli/man/man.awk >"$folder/$1.1.part"
    mv "$folder/$1.1.part" "$folder/$1.1"
}

mkdir -p "$folder"
"$fibrad" --help >"$folder/help"
purpose=$(sed -n '1s/^[^-]*- //p' "$folder/help")
page fibrad "$purpose" <"$folder/help"
sed -n '/^Commands:/,/^$/s/^  \([a-z]*\)  *\(.*\)/\1 \2/p' "$folder/help" | while read -r command purpose; do
    "$fibrad" "$command" --help all | page "fibrad-$command" "$purpose"
done
rm "$folder/help"
