# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Pure quad remeshing of triangle surfaces, in pvpython and in the system's python3.

    import quadrille
    quads = quadrille.remesh(polydata, quads=5000)              # vtkPolyData in, vtkPolyData out
    quads = quadrille.remesh((points, faces), edge_length=0.5)  # arrays or lists in
    points, faces = quadrille.to_arrays(quads)

The VTK classes themselves are here too: vtkQuadRemesh, vtkDecimationHierarchy, vtkIntegerGridMap,
vtkIntegerGridMapUpmap, vtkQuadExtraction.
"""
import collections

from vtkmodules.vtkCommonCore import vtkIdTypeArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules import vtkCommonExecutionModel as _execution_model  # base classes of the filters

from .QuadrilleFilters import (
    vtkDecimationHierarchy,
    vtkIntegerGridMap,
    vtkIntegerGridMapUpmap,
    vtkQuadExtraction,
    vtkQuadRemesh,
)

__all__ = [
    "InvalidInput", "RemeshError", "Remeshed", "info", "remesh", "to_arrays", "to_polydata",
    "vtkDecimationHierarchy", "vtkIntegerGridMap", "vtkIntegerGridMapUpmap", "vtkQuadExtraction",
    "vtkQuadRemesh",
]


#: How the map can be made, in the order of vtkQuadRemesh.Methods.
METHODS = ("scale-aware", "mixed-integer", "quadcover", "seamless")

#: What the whole numbers of the map can aim at, in the order of vtkQuadRemesh.IntegersTypes.
INTEGERS = ("keep-sizes", "coarsest")


class RemeshError(RuntimeError):
    """There is no valid result; the message says why."""


class InvalidInput(RemeshError, ValueError):
    """The mesh or an argument is at fault; the message names it."""


#: What cell arrays of the quads can come from, in the order of vtkQuadRemesh.CellDataFromTypes.
CELL_DATA = ("centre", "area")

#: What remesh(..., everything=True) returns: four vtkPolyData, and info() of the first.
Remeshed = collections.namedtuple("Remeshed", "quads surface lines info separatrices")


def to_polydata(points, faces):
    """A vtkPolyData from points (n by 3) and faces: an array (m by 3, or m by 4) or a list of lists of point ids."""
    import numpy
    from vtkmodules.util.numpy_support import numpy_to_vtk

    points = numpy.ascontiguousarray(points, dtype=numpy.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise InvalidInput(f"points must be n by 3, not {points.shape}")
    lengths = [len(face) for face in faces]
    corners = numpy.fromiter((i for face in faces for i in face), dtype=numpy.int64, count=sum(lengths))
    offsets = numpy.concatenate(([0], numpy.cumsum(lengths))).astype(numpy.int64)

    def ids(values):
        return numpy_to_vtk(values, deep=True, array_type=vtkIdTypeArray().GetDataType())

    mesh = vtkPolyData()
    mesh.SetPoints(vtkPoints())
    mesh.GetPoints().SetData(numpy_to_vtk(points, deep=True))
    cells = vtkCellArray()
    cells.SetData(ids(offsets), ids(corners))
    mesh.SetPolys(cells)
    return mesh


def to_arrays(quads):
    """Points (n by 3) and faces (m by 4) of a quad mesh, as numpy arrays of their own."""
    import numpy
    from vtkmodules.util.numpy_support import vtk_to_numpy

    points = vtk_to_numpy(quads.GetPoints().GetData()).copy() if quads.GetPoints() else numpy.zeros((0, 3))
    corners = vtk_to_numpy(quads.GetPolys().GetConnectivityArray()).copy()
    return points, corners.reshape(-1, 4)


def info(quads):
    """The field data of a result as a dict: numbers, texts and lists; `stages` and `repair` as dicts."""
    fields = quads.GetFieldData()
    result = {}
    for i in range(fields.GetNumberOfArrays()):
        array = fields.GetAbstractArray(i)
        values = [array.GetVariantValue(k) for k in range(array.GetNumberOfValues())]
        values = [v.ToString() if v.IsString() else (v.ToDouble() if v.IsFloat() or v.IsDouble() else v.ToTypeInt64())
                  for v in values]
        result[array.GetName()] = values[0] if len(values) == 1 else values

    def pairs(names, values):
        names, values = result.get(names, []), result.get(values, [])
        return dict(zip(names, values)) if isinstance(names, list) else {names: values}

    result["stages"] = pairs("StageNames", "StageSeconds")
    result["repair"] = pairs("RepairNames", "RepairCounts")
    result["extraction"] = pairs("ExtractionNames", "ExtractionCounts")
    return result


_FINAL_QUALITIES = ("coarse", "intermediate", "input")


def _check_one_size(quads, edge_length, relative_edge_length):
    given = [name for name, value in (("quads", quads), ("edge_length", edge_length),
                                      ("relative_edge_length", relative_edge_length)) if value is not None]
    if len(given) > 1:
        raise InvalidInput("give only one of " + " and ".join(given))


def _as_polydata(mesh):
    if isinstance(mesh, vtkPolyData):
        return mesh
    try:
        points, faces = mesh
    except (TypeError, ValueError):
        raise InvalidInput("the mesh must be a vtkPolyData or a pair (points, faces)") from None
    return to_polydata(points, faces)


def _set_size(run, quads, edge_length, relative_edge_length):
    if quads is not None:
        run.SetTargetTypeToNumberOfQuads()
        run.SetNumberOfQuads(int(quads))
    elif edge_length is not None:
        run.SetTargetTypeToEdgeLength()
        run.SetEdgeLength(edge_length)
    elif relative_edge_length is not None:
        run.SetRelativeEdgeLength(relative_edge_length)


def remesh(mesh, *, quads=None, edge_length=None, relative_edge_length=None, feature_angle=40.0,
           coarse_vertices=1000, patch_array="PatchId", curves=None, threads=0, maximum_number_of_quads=10000000, smoothing_steps=5,
           memory_limit=0.0, time_limit=0.0, close_handles=0.0, method="scale-aware",
           final_quality="coarse", integers="keep-sizes", anisotropy_limit=0.0, distortion_metric=False, cell_data="centre",
           progress=None, everything=False):
    """Remeshes a surface with quads only and returns a vtkPolyData.

    mesh: a vtkPolyData, or a pair (points, faces).
    quads, edge_length, relative_edge_length: target number of quads, target edge length in units of the mesh, or over
        the diagonal of its bounding box; at most one of them; 0.02 of the diagonal when none is given.
    feature_angle: degrees; edges sharper than this become edges of the quads; None turns the detection off.
    coarse_vertices: budget of the level where the layout is computed; 0: as many as the curvature needs.
    patch_array: name of a cell array of whole numbers, whose borders become edges of the quads; None: not used.
    curves: a vtkPolyData with polylines that become features.
    threads: 0 means all.
    maximum_number_of_quads: refuse to make more.
    smoothing_steps: sweeps of smoothing on the surface, which never lower the worst scaled Jacobian; 0: none.
    memory_limit: refuse to start where more is needed by the estimate; millions of bytes; 0 means what is free.
    time_limit: seconds; 0 means none.
    close_handles: handles shorter round or through than so many target edge lengths are cut and closed; 0: none.
    method: how the map is made: "scale-aware", "mixed-integer" or "quadcover" (both may leave inverted triangles), or
        "seamless" (no integers, so the result has no quads; use everything=True for the mapped surface).
    final_quality: "coarse", "intermediate" or "input": the level on which the map is solved at last; the quads are the same in number
        and connectivity, less distorted, and take longer.
    integers: "keep-sizes", or "coarsest" for the coarsest layout of quads that is the surface.
    anisotropy_limit: largest ratio of the two stretches of the map, at least 1, as far as features and irregular vertices let it;
        0: no limit.
    distortion_metric: whether coarse triangles count with the shape of the surface that they stand for, so that sizes come out more even.
    cell_data: what cell arrays of the quads come from: "centre", the cell under the centre of a quad, or "area", all cells under it: the
        average of real numbers and colours, of whole numbers and strings that with the largest part.
    progress: called as progress(fraction, text); a return value of False (not None) stops the run.
    everything: return a Remeshed with the mapped surface, the feature lines, the info dict and the lines of the layout, too.

    Raises InvalidInput where the mesh or an argument is at fault, else RemeshError, with the reason.
    """
    _check_one_size(quads, edge_length, relative_edge_length)
    run = vtkQuadRemesh()
    run.SetInputData(_as_polydata(mesh))
    if curves is not None:
        run.SetCurvesData(curves)
    _set_size(run, quads, edge_length, relative_edge_length)
    run.SetDetectFeatures(feature_angle is not None)
    if feature_angle is not None:
        run.SetFeatureAngle(feature_angle)
    run.SetCoarseVertices(coarse_vertices)
    run.SetPatchArrayName(patch_array or "")
    run.SetNumberOfThreads(threads)
    run.SetMaximumNumberOfQuads(int(maximum_number_of_quads))
    run.SetSmoothingSteps(smoothing_steps)
    run.SetMemoryLimit(memory_limit)
    run.SetTimeLimit(time_limit)
    run.SetCloseHandles(close_handles)
    run.SetAnisotropyLimit(anisotropy_limit)
    run.KeepLevelsOff()  # there is no next execution
    if method not in METHODS:
        raise InvalidInput("method must be one of " + ", ".join(METHODS) + f", not {method!r}")
    run.SetMethod(METHODS.index(method))
    if final_quality not in _FINAL_QUALITIES:
        raise InvalidInput(f"final_quality must be one of {', '.join(_FINAL_QUALITIES)}, not {final_quality!r}")
    run.SetFinalQuality(_FINAL_QUALITIES.index(final_quality))
    if integers not in INTEGERS:
        raise InvalidInput("integers must be one of " + ", ".join(INTEGERS) + f", not {integers!r}")
    run.SetIntegers(INTEGERS.index(integers))
    run.SetDistortionMetric(bool(distortion_metric))
    if cell_data not in CELL_DATA:
        raise InvalidInput("cell_data must be one of " + ", ".join(CELL_DATA) + f", not {cell_data!r}")
    run.SetCellDataFrom(CELL_DATA.index(cell_data))
    run.SetComputeMappedSurface(bool(everything))
    if progress is not None:
        def on_progress(caller, event):
            if progress(caller.GetProgress(), caller.GetProgressText() or "") is False:
                caller.SetAbortExecute(1)
        run.AddObserver("ProgressEvent", on_progress)
    # The reason comes back as an exception; without these observers VTK would print it as well.
    for source in (run, run.GetExecutive()):
        source.AddObserver("ErrorEvent", lambda caller, event: None)
        source.AddObserver("WarningEvent", lambda caller, event: None)
    run.Update()
    if run.GetOutcome() == vtkQuadRemesh.BadInput:
        raise InvalidInput(run.GetOutcomeText())
    if run.GetOutcome() != vtkQuadRemesh.Succeeded:
        raise RemeshError(run.GetOutcomeText() or "no quads were made")
    result = run.GetOutput()
    if everything:
        return Remeshed(result, run.GetMappedSurface(), run.GetLines(), info(result), run.GetSeparatrices())
    return result
