#!/bin/sh
# check_deb.sh - packages of Debian, unpacked into a folder, run; CMake finds the libraries there; the wheel works
# beside NumPy alone. SPDX-License-Identifier: MIT
set -eu
: "${BUILD:=build}" "${MAKE:=make}" "${CC:=cc}"
if ! command -v dpkg-shlibdeps >/dev/null || ! command -v cmake >/dev/null; then
    echo "SKIP packages: no dpkg-shlibdeps or no cmake (Debian: dpkg-dev cmake)"
    exit 0
fi
env -u MAKEFLAGS "$MAKE" -s --no-print-directory BUILD="$BUILD" CC="$CC" deb >/dev/null
tree=$PWD
work=$(cd "$BUILD" && pwd)/packages
rm -rf "$work"
mkdir -p "$work/alone"
for package in "$BUILD"/deb/*.deb; do dpkg-deb -x "$package" "$work/root"; done
usr=$work/root/usr

# what the packages need of Debian: libc, libgomp, zlib and GSL, Python and NumPy
others=$(for package in "$BUILD"/deb/*.deb; do dpkg-deb -f "$package" Depends; done | tr ',' '\n' |
    grep -vE '^ *(libc6|libgomp1|zlib1g|libgsl27|python3|python3-numpy|libfibrad[0-9]+) *(\(|$)' || true)
test -z "$others" || { echo "packages need $others" && exit 1; }
if command -v lintian >/dev/null; then
    lintian --fail-on error "$BUILD"/deb/*.deb >"$work/lintian" 2>/dev/null || { cat "$work/lintian" && exit 1; }
else
    echo "SKIP lintian: it is not on this machine"
fi

"$usr/bin/fibrad" factors tests/data/mono2000.dump --quiet -o "$work/F.npz"
man -l "$usr/share/man/man1/fibrad.1.gz" >/dev/null 2>&1 || ! command -v man >/dev/null

cat >"$work/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.10)
project(uses_fibrad C CXX)
find_package(fibrad 0.5 REQUIRED)
add_executable(in_c pair.c)
target_link_libraries(in_c fibrad::host)
add_executable(in_cpp pair.cpp)
target_link_libraries(in_cpp fibrad::host)
add_executable(kernel_alone kernel.c)
target_link_libraries(kernel_alone fibrad::fibrad)
END
cat >"$work/pair.c" <<'END'
#include <fibrad_host.h>
#include <math.h>
int main(void) {
    const double x[2] = {0, 2}, y[2] = {0, 0}, r[2] = {1, 1};
    fibrad_spheres spheres = {0};
    fibrad_bed_matrix *factors;
    spheres.x = x, spheres.y = spheres.z = y, spheres.r = r, spheres.n = 2;
    if (fibrad_view_factors(0, &spheres, 0, 0, &factors)) return 1;
    const double error = fabs(factors->matrix.f[0] - .0755868184216124); /* docs/validation.md */
    fibrad_bed_matrix_free(factors);
    return error < 1e-6 ? 0 : 2;
}
END
cp "$work/pair.c" "$work/pair.cpp"
echo '#include <fibrad.h>
int main(void) { return fibrad_version()[0] == 48 ? 0 : 1; }' >"$work/kernel.c"
if ! { cmake -S "$work" -B "$work/cmake" -DCMAKE_PREFIX_PATH="$usr" && cmake --build "$work/cmake"; } >"$work/log" 2>&1; then
    cat "$work/log"
    exit 1
fi
for program in in_c in_cpp kernel_alone; do "$work/cmake/$program"; done

# pair.py SITE: the factor of two spheres that touch, from the package in a folder
pair() {
    (cd "$work" && PYTHONPATH=$1 LD_LIBRARY_PATH=$usr/lib "$work/venv/bin/python" -c "
import fibrad
assert abs(fibrad.view_factors([[0, 0, 0], [2, 0, 0]], 1.0).data[0] - .0755868184216124) < 1e-6
fibrad.read('$tree/tests/data/mono2000.dump')")
}
python=$(tests/find_python.sh ensurepip numpy venv)
test -n "$python" || { echo "SKIP wheel: no Python with NumPy and venv" && exit 0; }
"$python" -m venv "$work/venv"
ln -s "$("$python" -c 'import numpy, os; print(os.path.dirname(numpy.__file__))')" "$work/alone/numpy"
"$work/venv/bin/pip" install -q --no-index --no-deps --disable-pip-version-check "$BUILD"/wheel/*.whl
pair "$work/alone"
"$work/venv/bin/pip" uninstall -q -y --disable-pip-version-check fibrad
pair "$usr/lib/python3/dist-packages:$work/alone"
echo "packages: program, libraries by CMake, Python by wheel and by package"
