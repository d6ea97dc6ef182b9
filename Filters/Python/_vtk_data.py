# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Data sets of VTK, of whatever version Python has; imported where there is VTK."""
import numpy

from ._errors import InvalidInput
from ._mesh import CAD_BYTES


def as_polydata(mesh):
    """The vtkPolyData of data of VTK. Raises InvalidInput that says what to do with anything else of VTK; None for what
    is not VTK's."""
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkDataSet, vtkPolyData
    from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm

    if isinstance(mesh, vtkPolyData):
        return mesh
    if isinstance(mesh, vtkDataSet):
        return _surface_of(mesh)
    if isinstance(mesh, vtkCompositeDataSet):
        raise InvalidInput("the mesh is composite data: call remesh for each of its blocks, or use the filter "
                           "vtkQuadRemesh, which takes them all")
    if isinstance(mesh, vtkAlgorithm):
        raise InvalidInput(f"{mesh.GetClassName()} is a reader or filter: call its Update(), then pass its GetOutput()")
    return None


def _surface_of(data):
    from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(data)
    surface.Update()
    if surface.GetOutput().GetNumberOfPolys() + surface.GetOutput().GetNumberOfStrips() == 0:
        raise InvalidInput(f"the {data.GetClassName()} has no surface: it has {data.GetNumberOfCells()} cells, none of "
                           "them a polygon or a volume")
    return surface.GetOutput()


def cells_of(offsets, corners):
    """A vtkCellArray."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkIdTypeArray
    from vtkmodules.vtkCommonDataModel import vtkCellArray

    def ids(values):
        return numpy_to_vtk(numpy.ascontiguousarray(values), deep=True, array_type=vtkIdTypeArray().GetDataType())

    cells = vtkCellArray()
    cells.SetData(ids(offsets), ids(corners))
    return cells


def arrays_of_cells(cells):
    """Offsets and corners of a vtkCellArray, as int64."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    return (vtk_to_numpy(cells.GetOffsetsArray()).astype(numpy.int64),
            vtk_to_numpy(cells.GetConnectivityArray()).astype(numpy.int64))


def add_array(attributes, name, values):
    from vtkmodules.util.numpy_support import numpy_to_vtk

    array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    array.SetName(name)
    attributes.AddArray(array)


def fields_of(data):
    """The field data as a dict of lists, without the exact shape of a CAD file, which are bytes, and the places of its
    edges and vertices."""
    fields = data.GetFieldData()
    result = {}
    for i in range(fields.GetNumberOfArrays()):
        array = fields.GetAbstractArray(i)
        if array.GetName() in CAD_BYTES:
            continue
        values = [array.GetVariantValue(k) for k in range(array.GetNumberOfValues())]
        result[array.GetName()] = [
            v.ToString() if v.IsString() else (v.ToDouble() if v.IsFloat() or v.IsDouble() else v.ToTypeInt64())
            for v in values]
    return result


def _named_arrays(attributes):
    """Arrays of numbers by name, and of strings as arrays of objects."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    found = {}
    for i in range(attributes.GetNumberOfArrays()):
        array = attributes.GetAbstractArray(i)
        if array.GetName() is None:
            continue
        if array.IsNumeric():
            found[array.GetName()] = vtk_to_numpy(array).copy()
        else:
            found[array.GetName()] = numpy.array([array.GetVariantValue(k).ToString()
                                                  for k in range(array.GetNumberOfValues())], dtype=object)
    return found


def mesh_of(data):
    """A Mesh of the polygons of a vtkPolyData, of whose strips it takes the triangles."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    from ._mesh import Mesh

    if data.GetNumberOfStrips() > 0:
        from vtkmodules.vtkFiltersCore import vtkTriangleFilter

        triangles = vtkTriangleFilter()
        triangles.SetInputData(data)
        triangles.Update()
        data = triangles.GetOutput()
    points = (vtk_to_numpy(data.GetPoints().GetData()).astype(numpy.float64) if data.GetPoints()
              else numpy.zeros((0, 3)))
    first = data.GetNumberOfVerts() + data.GetNumberOfLines()
    cell_data = {name: values[first:] for name, values in _named_arrays(data.GetCellData()).items()}
    return Mesh.from_cells(points, *arrays_of_cells(data.GetPolys()), cell_data=cell_data,
                           point_data=_named_arrays(data.GetPointData()), field_data=fields_of(data))


def polydata_of(mesh):
    """A vtkPolyData of a Mesh."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    data = vtkPolyData()
    data.SetPoints(vtkPoints())
    data.GetPoints().SetData(numpy_to_vtk(numpy.ascontiguousarray(mesh.points, dtype=numpy.float64), deep=True))
    data.SetPolys(cells_of(mesh.offsets, mesh.corners))

    def add(attributes, name, values):
        values = numpy.asarray(values)
        if values.dtype.kind in "iufb":
            add_array(attributes, name, values.astype(numpy.uint8) if values.dtype.kind == "b" else values)
            return
        texts = vtkStringArray()
        texts.SetName(name)
        for value in values.ravel():
            texts.InsertNextValue(str(value))
        attributes.AddArray(texts)

    for attributes, arrays in ((data.GetPointData(), mesh.point_data), (data.GetCellData(), mesh.cell_data),
                               (data.GetFieldData(), mesh.field_data)):
        for name, values in arrays.items():
            add(attributes, name, values)
    return data
