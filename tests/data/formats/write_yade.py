# the settled bed by YADE; spheres have the ids of settled.csv, since a box has id 0
import csv
from yade import export
O.bodies.append(utils.box((0, 0, -1), (1, 1, 1)))
for row in csv.DictReader(open('settled.csv')):
    O.bodies.append(sphere([float(row[k]) for k in 'xyz'], float(row['r']), fixed=True))
    O.bodies[-1].state.mass = float(row['T'])
export.text('yade.txt')
export.textExt('yade_ids.txt', format='id_x_y_z_r_matId')
export.textExt('yade_attrs.txt', format='x_y_z_r_attrs', comment='id T vx vy vz',
               attrs=['b.id', 'b.state.mass', 'b.state.vel'])
export.VTKExporter('yade').exportSpheres(what={'T': 'b.state.mass'})
for name, text in ('yade_packed-', False), ('yade_ascii-', True):
    O.engines = [VTKRecorder(fileName=name, ascii=text, recorders=['spheres', 'id'], iterPeriod=1)]
    O.run(1, True)
