# the settled bed by VTK, in each of its encodings, and by ParaView as a spreadsheet
import csv, random
from paraview import simple, servermanager
from vtkmodules.vtkCommonCore import vtkPoints, vtkDoubleArray, vtkIntArray
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkCellArray
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
from vtkmodules.vtkIOLegacy import vtkPolyDataWriter
rows = list(csv.DictReader(open('settled.csv')))
random.Random(5).shuffle(rows)
points = vtkPoints(); points.SetDataTypeToDouble()
verts = vtkCellArray()
arrays = {'id': vtkIntArray(), 'radius': vtkDoubleArray(), 'T': vtkDoubleArray()}
vel = vtkDoubleArray(); vel.SetName('v'); vel.SetNumberOfComponents(3)
for name, a in arrays.items(): a.SetName(name)
for row in rows:
    i = points.InsertNextPoint(*(float(row[k]) for k in 'xyz'))
    verts.InsertNextCell(1); verts.InsertCellPoint(i)
    arrays['id'].InsertNextValue(int(row['id']))
    arrays['radius'].InsertNextValue(float(row['r']))
    arrays['T'].InsertNextValue(float(row['T']))
    vel.InsertNextTuple3(0, 0, 0)
bed = vtkPolyData(); bed.SetPoints(points); bed.SetVerts(verts)
bed.GetPointData().AddArray(vel)
bed.GetPointData().SetScalars(arrays['id'])
for name in ('radius', 'T'): bed.GetPointData().AddArray(arrays[name])
def xml(name, mode, encode=True, compress=False, wide=True, big=False):
    w = vtkXMLPolyDataWriter(); w.SetInputData(bed); w.SetFileName(name)
    getattr(w, 'SetDataModeTo' + mode)(); w.SetEncodeAppendedData(encode)
    if compress == 'lz4': w.SetCompressorTypeToLZ4()
    elif compress: w.SetCompressorTypeToZLib(); w.SetBlockSize(1000)
    else: w.SetCompressorTypeToNone()
    (w.SetHeaderTypeToUInt64 if wide else w.SetHeaderTypeToUInt32)()
    (w.SetByteOrderToBigEndian if big else w.SetByteOrderToLittleEndian)()
    w.Write()
xml('vtk_ascii.vtp', 'Ascii')
xml('vtk_inline.vtp', 'Binary')
xml('vtk_inline_zlib_big.vtp', 'Binary', compress=True, wide=False, big=True)
xml('vtk_appended.vtp', 'Appended', wide=False)
xml('vtk_appended_raw.vtp', 'Appended', encode=False)
xml('vtk_appended_raw_zlib.vtp', 'Appended', encode=False, compress=True)
xml('vtk_lz4.vtp', 'Appended', compress='lz4')
for name, binary in (('vtk_ascii.vtk', False), ('vtk_binary.vtk', True)):
    w = vtkPolyDataWriter(); w.SetInputData(bed); w.SetFileName(name)
    if binary: w.SetFileTypeToBinary()
    w.Write()
w = vtkPolyDataWriter(); w.SetInputData(bed); w.SetFileName('vtk_binary42.vtk'); w.SetFileTypeToBinary(); w.SetFileVersion(42); w.Write()
producer = simple.TrivialProducer(); producer.GetClientSideObject().SetOutput(bed)
simple.SaveData('paraview.csv', proxy=producer, Precision=17)
