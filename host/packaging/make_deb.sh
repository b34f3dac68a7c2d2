#!/bin/sh
# make_deb.sh OUT - Debian packages of this tree in the folder OUT, from what `make install` and `make wheel` give.
# MAINTAINER: their maintainer, NAME <ADDRESS>. SPDX-License-Identifier: MIT
set -eu
: "${BUILD:=build}" "${CC:=cc}" "${MAKE:=make}" "${PYTHON:=/usr/bin/python3}" "${MAINTAINER:=fibrad authors <authors@fibrad.invalid>}"
version=$(sed -n 's/^#define FIBRAD_VERSION "\(.*\)"/\1/p' kernel/fibrad.h)
machine=$(dpkg --print-architecture)
rm -rf "$1"
mkdir -p "$1/all" "$1/debian"
out=$(cd "$1" && pwd)
"$MAKE" -s --no-print-directory CC="$CC" install wheel DESTDIR="$out/all" PREFIX=/usr
shared=$(basename "$out"/all/usr/lib/libfibrad.so.*)
libfibrad=libfibrad${shared##*.}

# move PACKAGE PATH...: what a package gets of all that is installed, below usr
move() {
    package=$1
    shift
    for path in "$@"; do
        mkdir -p "$out/$package/usr/$(dirname "$path")"
        mv "$out/all/usr/$path" "$out/$package/usr/$path"
    done
}

# The packages that files need, by the symbols that they use. dpkg-shlibdeps wants a debian/control.
printf 'Source: fibrad\n\nPackage: fibrad\nArchitecture: any\n' >"$out/debian/control"
needs() { (cd "$out" && dpkg-shlibdeps -O "$@" 2>/dev/null | sed 's/^shlibs:Depends=//'); }

# pack PACKAGE SECTION FIELDS SUMMARY: writes a package. Standard input: its description.
pack() {
    root=$out/$1 doc=$out/$1/usr/share/doc/$1
    mkdir -p "$root/DEBIAN" "$doc"
    {
        printf 'Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n\nFiles: *\n'
        printf 'Copyright: %s\nLicense: Expat\n' "$(sed -n 's/^Copyright (c) //p' LICENSE)"
        sed -n '5,$ { s/^$/./; s/^/ /; p; }' LICENSE
    } >"$doc/copyright"
    printf 'fibrad (%s) unstable; urgency=low\n\n  * CHANGELOG.md of the sources tells what is new.\n\n -- %s  %s\n' \
        "$version" "$MAINTAINER" "$(date -R -u -d "$(sed -n 's/^date-released: //p' CITATION.cff)")" |
        gzip -9n >"$doc/changelog.gz"
    find "$root" -path '*/man/*' -name '*.1' -exec gzip -9n {} +
    find "$root/usr" -name '*.so*' -type f -exec strip --strip-unneeded {} + -exec chmod 644 {} +
    find "$root/usr" -name '*.a' -exec strip --strip-debug --enable-deterministic-archives {} +
    (cd "$root" && find usr -type f -exec md5sum {} + >DEBIAN/md5sums)
    {
        printf 'Package: %s\nSource: fibrad\nVersion: %s\nArchitecture: %s\nMaintainer: %s\n' "$1" "$version" \
            "$machine" "$MAINTAINER"
        printf 'Installed-Size: %s\nSection: %s\nPriority: optional\n%s\nDescription: %s\n' \
            "$(du -sk "$root/usr" | cut -f1)" "$2" "$3" "$4"
        sed 's/^/ /'
    } >"$root/DEBIAN/control"
    chmod -R u=rwX,go=rX "$root"
    dpkg-deb --root-owner-group --build "$root" "$out/$1_${version}_$machine.deb" >/dev/null
}

move "$libfibrad" "lib/$shared"
move libfibrad-dev include lib
move fibrad bin share
strip "$out/fibrad/usr/bin/fibrad"
mkdir -p "$out/python3-fibrad/usr/lib/python3/dist-packages" "$out/$libfibrad/DEBIAN"
(cd "$out/python3-fibrad/usr/lib/python3/dist-packages" && "$PYTHON" -m zipfile -e "$BUILD"/wheel/*.whl .)
rm "$out"/python3-fibrad/usr/lib/python3/dist-packages/fibrad/libfibrad.so \
    "$out"/python3-fibrad/usr/lib/python3/dist-packages/*/RECORD
printf 'libfibrad %s %s (>= %s)\n' "${shared##*.}" "$libfibrad" "$version" >"$out/$libfibrad/DEBIAN/shlibs"
echo 'activate-noawait ldconfig' >"$out/$libfibrad/DEBIAN/triggers"

pack "$libfibrad" libs "Depends: $(needs "$out/$libfibrad/usr/lib/$shared")" \
    'thermal radiation in packed beds, shared library' <<END
View factors between the spheres of packed beds, net powers, temperatures and
heat fluxes by radiation, contacts and convection, and light from outside.
Results have the same bits for any number of threads.
END
pack libfibrad-dev libdevel "Depends: $libfibrad (= $version)" 'thermal radiation in packed beds, for developers' <<END
Headers, static libraries, and files for pkg-config and CMake. The kernel
libfibrad.a needs no heap and no other library.
END
pack fibrad science "Depends: $(needs "$out/fibrad/usr/bin/fibrad")
Recommends: gnuplot-nox | gnuplot
Suggests: lammps, libprecice3, python3-fibrad" 'thermal radiation in packed beds, program' <<END
Computes view factors, powers, temperatures and conductivities of beds of
spheres from files of DEM codes, with pages and examples. docs/lammps.md says
how radiation gets into a simulation with LAMMPS or LIGGGHTS.
END
pack python3-fibrad python "Depends: python3, python3-numpy, $libfibrad (= $version), $(
    needs "$out"/python3-fibrad/usr/lib/python3/dist-packages/fibrad/libfibrad_files.so)
Suggests: python3-scipy" 'thermal radiation in packed beds, Python package' <<END
The library in Python: beds, factors, powers and temperatures as arrays of
NumPy.
END
ls "$out"/*.deb
