#!/bin/sh
# check_npz.sh - a matrix as .npz: the reader in docs/examples, Python's zipfile and SciPy find the same matrix.
# SPDX-License-Identifier: MIT
set -eu
: "${BUILD:=build}" "${CC:=cc}"
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT

"$CC" -std=c11 -pedantic -Wall -Wextra -Werror docs/examples/read_npz.c -o "$work/read_npz"
printf 'x,y,z,r\n0,0,0,1\n9e9,0,0,1\n' >"$work/apart.csv"
for bed in tests/data/mono2000.dump "$work/apart.csv"; do # the second has no entries
    for ending in npz csv; do
        "$BUILD/fibrad" factors "$bed" --directions 8 --cutoff 3 --threads 2 -o "$work/F.$ending" >"$work/summary" 2>&1
    done
    "$work/read_npz" "$work/F.npz" >"$work/read.csv"
    # the entries are the same to the bit; their digits differ
    awk -F, 'NR == FNR { if (!/,surroundings$|,beyond$|^i/) known[n++] = $1 "," $2 " " $3; next }
        FNR > 1 { split(known[m++], one, " "); bad += one[1] != $1 "," $2 || one[2] + 0 != $3 + 0 } END { exit bad > 0 || m != n }' \
        "$work/F.csv" "$work/read.csv"

    if ! command -v python3 >/dev/null; then
        echo "SKIP: no python3 to check the archive"
        continue
    fi
    python3 - "$work/F.npz" <<'END'
import struct, sys, zipfile
archive = zipfile.ZipFile(sys.argv[1])
assert archive.testzip() is None  # checksums
arrays = {}
for name in archive.namelist():
    member = archive.read(name)
    assert member[:8] == b'\x93NUMPY\1\0', name
    length, = struct.unpack('<H', member[8:10])
    assert (10 + length) % 64 == 0 and member[9 + length:10 + length] == b'\n', name
    arrays[name] = eval(member[10:10 + length]), member[10 + length:]
start = struct.unpack('<%dq' % arrays['indptr.npy'][0]['shape'], arrays['indptr.npy'][1])
assert start[0] == 0 and arrays['data.npy'][0]['shape'] == arrays['indices.npy'][0]['shape'] == (start[-1],)
assert struct.unpack('<2q', arrays['shape.npy'][1]) == (len(start) - 1, len(start) - 1)
assert arrays['format.npy'] == ({'descr': '|S3', 'fortran_order': False, 'shape': ()}, b'csr')
n = len(start) - 1
further = [('ids', '<i8', (n,)), ('x', '<f8', (n, 3)), ('radius', '<f8', (n,)), ('escaped', '<f8', (n,)),
           ('beyond', '<f8', (n,)), ('error', '<f8', (n,)), ('length_unit', '|S16', ())]
for name, kind, shape in further:
    assert arrays.pop(name + '.npy')[0] == {'descr': kind, 'fortran_order': False, 'shape': shape}, name
assert len(arrays) == 5, arrays.keys()
END
    scipy=$(tests/find_python.sh numpy scipy.sparse)
    if test -z "$scipy"; then
        echo "SKIP: no SciPy (Debian: python3-scipy)"
        continue
    fi
    "$scipy" - "$work/F.npz" "$work/F.csv" <<'END'
import csv, sys, numpy, scipy.sparse
ids = numpy.load(sys.argv[1])['ids']
matrix = scipy.sparse.load_npz(sys.argv[1])
assert matrix.format == 'csr' and matrix.has_sorted_indices
entries = [entry for entry in csv.DictReader(open(sys.argv[2])) if not entry['body']]
matrix = matrix.tocoo()
assert matrix.nnz == len(entries)
for i, j, f, entry in zip(matrix.row, matrix.col, matrix.data, entries):
    assert (ids[i], ids[j], f) == (int(entry['i']), int(entry['j']), float(entry['F']))
END
done

# walls by their names, and which rows were computed
if test -n "${scipy:-}"; then
    "$BUILD/fibrad" factors tests/data/mono2000.dump --directions 21 --wall zmin,cylinder:6,6,9,zmax:open --targets 1-99 --quiet \
        -o "$work/W.npz" -o "$work/W.csv" 2>"$work/said"
    "$scipy" - "$work/W.npz" "$work/W.csv" <<'END'
import csv, sys, numpy
a = numpy.load(sys.argv[1])
names = [name.decode() for name in a['wall_names']]
assert names == ['zmin', 'cylinder']
row = {i: k for k, i in enumerate(a['ids'])}
known = {name: {} for name in names + ['surroundings', '']}
for entry in csv.DictReader(open(sys.argv[2])):
    if int(entry['i']) >= 0: known[entry['body']][int(entry['i'])] = float(entry['F'])
for k, name in enumerate(names):
    assert known[name] and sum(a['body'][:, k] > 0) == len(known[name])
    for i, f in known[name].items(): assert a['body'][row[i], k] == f
for i, f in known['surroundings'].items(): assert a['escaped'][row[i]] == f
assert a['computed'].sum() == 99 and a['computed'][row[7]] and not a['computed'][row[100]]
END
fi

# rows of a simulation with the largest possible ids
if command -v python3 >/dev/null; then
    python3 - "$work/D.0.rows" <<'END'
import struct, sys
head = struct.pack('<8s7Qd', b'FIBROWS1', 0, 1, 5, 2, 1, 1, 1, 8.)
whole = struct.pack('<6Q', 7, 1 << 63, 0, 1, 1, 1 << 63)
real = struct.pack('<17d', .5, .25, 1, .125, 0, .125, 0, .1, 0, 1, 2, .5, 1, 0, 0, 0, 4)
open(sys.argv[1], 'wb').write(head + whole + real + struct.pack('<2d', 0, 0))
END
    if "$BUILD/fibrad" join "$work/D.0.rows" --raw -o "$work/D.csv" 2>"$work/said"; then exit 1; fi
    grep -q 'id 9223372036854775808 is too large for a name; --positions' "$work/said"
    test ! -e "$work/D.csv"
    "$BUILD/fibrad" join "$work/D.0.rows" --raw --positions -o "$work/D.npz" -o "$work/D.csv" >"$work/summary"
    grep -qx '0,1,0.5,' "$work/D.csv"
    "$work/read_npz" "$work/D.npz" >"$work/read.csv"
    grep -qx '7,9223372036854775808,0.5' "$work/read.csv"
    python3 - "$work/D.npz" <<'END'
import struct, sys, zipfile
archive = zipfile.ZipFile(sys.argv[1])
assert archive.testzip() is None
def array(name):
    member = archive.read(name + '.npy')
    head, data = eval(member[10:128]), member[128:]
    return head['shape'], struct.unpack('<%d%s' % (len(data) // 8, 'Q' if 'u' in head['descr'] else 'd'), data)
assert array('ids') == ((2,), (7, 1 << 63))
assert array('x') == ((2, 3), (0, 0, 0, 4, 0, 0))
assert array('body') == ((2, 1), (.25, 1))
assert array('escaped') == ((2,), (.125, 0)) and array('beyond') == ((2,), (.125, 0))
assert array('error') == ((2,), (.1, 0)) and array('radius') == ((2,), (1, 2)) and array('emissivity') == ((2,), (.5, 1))
END
fi
