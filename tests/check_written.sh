#!/bin/sh
# check_written.sh - other readers read powers and factors: Python's csv and json, VTK's reader, LAMMPS' reader of
# dumps. SPDX-License-Identifier: MIT
#
# All formats of one run have the same numbers to the bit, by the same ids, whatever the order of the input file.
set -eu
: "${BUILD:=build}"
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
fibrad=$(cd "$BUILD" && pwd)/fibrad
bed=$(pwd)/tests/data/monoper2000.dump
vtk=$(tests/find_python.sh vtkmodules.vtkIOXML)
cd "$work"
{
    printf 'ITEM: UNITS\nsi\n'
    head -9 "$bed"
    tail -n +10 "$bed" | sort -r
} >a.dump
sed 's/^75000$/76000/' a.dump >b.dump

heat() { # COLUMN FILES AND OUTPUTS
    "$fibrad" heat --temperature "$@" --emissivity 0.5 --directions 13 --patches 24 --threads 2 --ambient 300 \
        --wall zmin:at=0:temperature=900 --quiet
}
heat v_T a.dump -o q.csv -o q.json -o q.dump -o q.vtp -o - --format json >out.json
cmp out.json q.json
heat v_T a.dump b.dump -o two.csv -o two.json -o two.lammpstrj -o 'frame*.dump'
cmp frame0.dump q.dump
sed 's/^75000$/76000/' q.dump | cmp - frame1.dump

# what was written is read again
heat T_K q.dump -o again.csv
cmp again.csv q.csv
heat temperature_K q.vtp --length-unit m --periodic 12,12,0 -o again.csv
cmp again.csv q.csv
heat T_K two.lammpstrj --frame all -o again.csv
cut -d, -f2- two.csv | sed '2004,$s/^0/1/' | cmp - again.csv
"$fibrad" factors a.dump --directions 13 --threads 2 --wall zmin,zmax --targets 1-999 --quiet -o F.csv -o F.json -o F.mtx -o F.vtp

if ! command -v python3 >/dev/null; then
    echo "SKIP: no python3 to read what was written"
    exit
fi
cat >known.py <<'END'
import csv, json
powers, walls = {}, {}
for row in csv.DictReader(open('q.csv')):
    (walls if row['body'] else powers)[row['body'] or int(row['i'])] = float(row['T_K']), float(row['q_W'])
assert list(powers) == list(range(1, 2001)) and list(walls) == ['surroundings', 'zmin']
factors, outside = {}, {}
for row in csv.DictReader(open('F.csv')):
    i, j = int(row['i']), int(row['j'])
    if row['body']: outside[row['body'], i, j] = float(row['F'])
    else: factors[i, j] = float(row['F'])
def strict(text): raise ValueError(text)  # NaN and Infinity are no JSON
def lines(path): return [json.loads(line, parse_constant=strict) for line in open(path)]
END
python3 - <<'END'
from known import *
q, = lines('q.json')
assert dict(zip(q['id'], zip(q['T_K'], q['q_W']))) == powers and q['frame'] == 0
assert [q['surroundings'][key] for key in ('T_K', 'q_W')] == list(walls['surroundings'])
assert [q['walls']['zmin'][key] for key in ('T_K', 'q_W')] == list(walls['zmin'])
two = lines('two.json')
assert [frame.pop('file') for frame in two] == ['a.dump', 'b.dump']
assert [frame.pop('timestep') for frame in two] == [75000, 76000] and q.pop('timestep') == 75000
assert [frame.pop('frame') for frame in two] == [0, 1] and q.pop('frame') == 0
assert two == [q, q]
rows = list(csv.DictReader(open('two.csv')))
assert len(rows) == 2 * 2002 and {row['file'] for row in rows} == {'a.dump', 'b.dump'}
assert all(powers[int(row['i'])][1] == float(row['q_W']) for row in rows if not row['body'])

F, = lines('F.json')
ids, start = F['id'], F['indptr']
found = {(ids[i], ids[F['indices'][k]]): F['data'][k] for i in range(2000) for k in range(start[i], start[i + 1])}
assert found == factors
for name, j in ('surroundings', -1), ('zmin', -2), ('zmax', -3):
    values = F['escaped'] if name == 'surroundings' else F['walls'][name]
    assert {i: f for i, f in zip(ids, values) if f} == {i: f for (wall, i, to), f in outside.items() if wall == name and i > 0}
assert [e is None for e in F['error']] == [i > 999 for i in ids]

names, comments, entries = [], '', {}
for line in open('F.mtx'):
    if line.startswith('% ids:'): names += map(int, line.split()[2:])
    assert len(line) < 200
    if line.startswith('%'): continue
    i, j, f = line.split()
    if '.' in f or 'e' in f: entries[names[int(i) - 1], names[int(j) - 1]] = float(f)
assert entries == factors
END

if test -n "$vtk"; then
    "$vtk" - <<'END'
from known import *
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
def read(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    arrays = data.GetPointData()
    assert data.GetNumberOfVerts() == data.GetNumberOfPoints() == 2000
    names = [arrays.GetArrayName(k) for k in range(arrays.GetNumberOfArrays())]
    return data, {name: [arrays.GetArray(name).GetValue(i) for i in range(2000)] for name in names}
data, q = read('q.vtp')
assert q['id'] == list(range(1, 2001)) and data.GetPointData().GetScalars().GetName() == 'power_W'
assert dict(zip(q['id'], zip(q['temperature_K'], q['power_W']))) == powers and set(q['emissivity']) == {0.5}
places = {int(row[0]): tuple(map(float, row[2:5])) for row in map(str.split, open('a.dump')) if len(row) == 8 and row[0] != 'ITEM:'}
assert all(data.GetPoint(i) == places[q['id'][i]] for i in range(2000)) and set(q['radius']) == {0.5}
data, F = read('F.vtp')
for i in (1, 500, 999):
    k = F['id'].index(i)
    assert F['neighbours'][k] == sum(row == i for row, column in factors)
    assert F['wall_zmin'][k] == outside.get(('zmin', i, -2), 0) and F['escaped'][k] == 0
assert F['row_sum'][1500] != F['row_sum'][1500]
END
else
    echo "SKIP: no VTK for Python (Debian: python3-vtk9)"
fi

if command -v lmp >/dev/null; then
    cat >read.lmp <<'END'
units si
boundary p p f
region r block 0 1 0 1 0 1
create_box 1 r
create_atoms 1 random 2000 1 r
mass 1 1
read_dump two.lammpstrj 76000 x y z vx vy vz label vx T_K label vy q_W label vz radius box yes
write_dump all custom back.dump id x y z vx vy vz modify sort id format float %.17g
END
    lmp -in read.lmp -log none >lammps.log 2>&1 || { cat lammps.log; exit 1; }
    python3 - <<'END'
def rows(path): return [list(map(float, line.split())) for line in open(path).read().split('ITEM: ATOMS')[1].split('\n')[1:2001]]
ours, theirs = rows('q.dump'), rows('back.dump')
assert len(ours) == 2000 and all([i, x, y, z, t, q, r] == other for (i, x, y, z, r, t, q, *_), other in zip(ours, theirs))
from known import powers
assert {row[0]: tuple(row[5:7]) for row in ours} == powers
kept = {int(row[0]): (float(row[1]), float(row[6]), float(row[7])) for row in map(str.split, open('a.dump')) if len(row) == 8 and row[0] != 'ITEM:'}
assert {row[0]: tuple(row[7:]) for row in ours} == kept  # type v_T c_cn of the input
END
else
    echo "SKIP: no lmp to read the dump (Debian: lammps)"
fi
