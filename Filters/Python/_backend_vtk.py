# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Quads by the VTK classes of Filters/; see _backend.py."""
import os

import numpy
from vtkmodules import vtkCommonExecutionModel as _execution_model  # base classes of the filters
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from . import QuadrilleFilters as filters
from ._errors import InvalidInput, RemeshError
from ._options import NAMES
from ._vtk_data import add_array, arrays_of_cells, as_polydata, cells_of
from ._vtk_data import fields_of  # noqa: F401, a function of the backend

vtkQuadRemesh = filters.vtkQuadRemesh

#: Classes of VTK that the package has beside its functions.
CLASSES = (
    "vtkDecimationHierarchy", "vtkIntegerGridMap", "vtkIntegerGridMapComparison", "vtkIntegerGridMapQuality",
    "vtkIntegerGridMapUpmap", "vtkQuadConstraintSource", "vtkQuadElements", "vtkQuadExtraction", "vtkQuadMeshWriter",
    "vtkQuadNamedSizes",
    "vtkQuadRemesh", "vtkQuadrilleOFFReader", "vtkQuadrillePLYReader", "vtkQuadrilleSTLReader", "vtkQuadrilleSession")


# --- surfaces ---------------------------------------------------------------------------------------------------------

surface_of = as_polydata


def surface_from(points, counts, corners):
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints

    mesh = vtkPolyData()
    mesh.SetPoints(vtkPoints())
    mesh.GetPoints().SetData(numpy_to_vtk(points, deep=True))
    mesh.SetPolys(cells_of(numpy.concatenate(([0], numpy.cumsum(counts))), corners))
    return mesh


def cloud_of(points):
    """A vtkPolyData of points alone."""
    cloud = surface_from(points, numpy.zeros(0, numpy.int64), numpy.zeros(0, numpy.int64))
    cloud.SetVerts(cells_of(numpy.arange(len(points) + 1), numpy.arange(len(points))))
    return cloud


def polydata_of(surface):
    return surface


def is_polydata(mesh):
    return isinstance(mesh, vtkPolyData)


def point_count(surface):
    return surface.GetNumberOfPoints()


def face_count(surface):
    return surface.GetNumberOfPolys()


def points_of(surface):
    points = surface.GetPoints()
    return vtk_to_numpy(points.GetData()) if points else numpy.zeros((0, 3))


def polygons_of(surface):
    return arrays_of_cells(surface.GetPolys())


def has_polygons_only(surface):
    return surface.GetNumberOfCells() == surface.GetNumberOfPolys()


def has_cell_array(surface, name):
    return bool(surface.GetCellData().HasArray(name))


def with_arrays(surface, point_data, cell_data):
    result = vtkPolyData()
    result.ShallowCopy(surface)
    for attributes, arrays in ((result.GetPointData(), point_data), (result.GetCellData(), cell_data)):
        for name, values in arrays.items():
            add_array(attributes, name, values)
    return result


def lines_of(polydata):
    return polydata


def lines_from(lines):
    lines = sorted(lines, key=lambda line: len(line.points) > 1)  # vertices come before lines in the order of cells
    data = surface_from(numpy.concatenate([line.points for line in lines]), numpy.zeros(0, numpy.int64),
                        numpy.zeros(0, numpy.int64))
    single = sum(len(line.points) == 1 for line in lines)
    ends = numpy.cumsum([0] + [len(line.points) for line in lines])
    if single:
        data.SetVerts(cells_of(ends[:single + 1], numpy.arange(single)))
    data.SetLines(cells_of(ends[single:] - single, numpy.arange(single, ends[-1])))
    add_array(data.GetCellData(), "ConstraintType", numpy.array([line.kind for line in lines], numpy.int32))
    add_array(data.GetCellData(), "GuidingRadius", numpy.array([line.radius for line in lines], float))
    add_array(data.GetCellData(), "SizeFactor", numpy.array([line.factor for line in lines], float))
    return data


def arrays_of(quads):
    points = vtk_to_numpy(quads.GetPoints().GetData()).copy() if quads.GetPoints() else numpy.zeros((0, 3))
    corners = vtk_to_numpy(quads.GetPolys().GetConnectivityArray()).copy()
    return points, corners.reshape(-1, 3 if quads.GetPolys().GetMaxCellSize() == 3 else 4)


# --- runs -------------------------------------------------------------------------------------------------------------

#: Properties of vtkQuadRemesh that arguments of remesh() are as they are.
_PROPERTIES = {
    "coarse_vertices": "CoarseVertices", "threads": "NumberOfThreads",
    "maximum_number_of_quads": "MaximumNumberOfQuads", "smoothing_steps": "SmoothingSteps",
    "memory_limit": "MemoryLimit", "time_limit": "TimeLimit", "smallest_detail": "SmallestDetail",
    "anisotropy_limit": "AnisotropyLimit", "gap_quads": "GapQuads", "smallest_size": "SmallestSize",
    "largest_size": "LargestSize", "guide_anisotropy": "LeastAnisotropy", "stroke_radius": "StrokeRadius",
    "patch_array": "PatchArrayName", "distortion_metric": "DistortionMetric", "preview": "Preview",
    "everything": "ComputeMappedSurface"}
#: And those that are one of some names.
_ENUMERATED = {
    "method": "Method", "final_quality": "FinalQuality", "integers": "Integers", "cell_data": "CellDataFrom",
    "small_details": "SmallDetails", "small_components": "SmallComponents", "feature_criterion": "FeatureCriterion",
    "plane_curve": "PlaneCurve"}


def _set_all(run, options):
    for name, setter in _PROPERTIES.items():
        getattr(run, "Set" + setter)(options[name])
    for name, setter in _ENUMERATED.items():
        getattr(run, "Set" + setter)(NAMES[name].index(options[name]))
    if "edge_length" in options:
        run.SetTargetTypeToEdgeLength()
        run.SetEdgeLength(options["edge_length"])
    elif "relative_edge_length" in options:
        run.SetTargetTypeToRelativeEdgeLength()
        run.SetRelativeEdgeLength(options["relative_edge_length"])
    else:
        run.SetTargetTypeToNumberOfQuads()
        run.SetNumberOfQuads(options["quads"])
    run.SetDetectFeatures(options["feature_angle"] is not None)
    if options["feature_angle"] is not None:
        run.SetFeatureAngle(options["feature_angle"])
    if options["chord_error"] is not None:
        run.SetChordError(options["chord_error"])
    if options["angle_a_quad"] is not None:
        run.SetAngleAQuad(options["angle_a_quad"])
    guide = options["guide"]
    run.SetCurvatureGuides(guide == "curvature")
    run.SetGuideArrayName(guide if guide and guide != "curvature" else "")
    _set_symmetry(run, options["symmetry"], options["rotation"])
    run.KeepLevelsOff()  # there is no next execution


def _set_symmetry(run, symmetry, rotation):
    axis = symmetry
    if rotation is not None:
        order, axis = rotation
        run.SetRotationOrder(order)
        if axis is None:
            run.SetSymmetryToAxisFound()
        else:
            run.SetSymmetryToAxis()
    elif symmetry == "found":
        run.SetSymmetryToFound()
        return
    elif symmetry is not None:
        run.SetSymmetryToPlane()
    if axis is not None:
        run.SetSymmetryOrigin(axis[0])
        run.SetSymmetryNormal(axis[1])


def _spread(run, wrap):
    """Asks for quads of a surface over ranks; returns this rank and their number."""
    from vtkmodules.vtkParallelCore import vtkMultiProcessController
    controller = vtkMultiProcessController.GetGlobalController()
    if controller is None:
        raise InvalidInput("spread needs VTK's global controller: initialize a vtkMPIController, and give it to "
                           "vtkMultiProcessController.SetGlobalController")
    if wrap is not None:
        raise InvalidInput("a wrap is made of a surface in one place: leave out wrap, or spread")
    run.SetSpreadSurfaces(1)  # always
    return controller.GetLocalProcessId(), controller.GetNumberOfProcesses()


def _finish(run, ranks=None):
    """Runs it, as one of the ranks where there are several; the reason of a failure comes as an exception, so VTK need
    not print it as well."""
    for source in (run, run.GetExecutive()):
        source.AddObserver("ErrorEvent", lambda caller, event: None)
        source.AddObserver("WarningEvent", lambda caller, event: None)
    if ranks is None:
        run.Update()
    else:
        run.UpdatePiece(*ranks, 0)
    if run.GetOutcome() == vtkQuadRemesh.BadInput:
        raise InvalidInput(run.GetOutcomeText())
    if run.GetOutcome() != vtkQuadRemesh.Succeeded and not run.GetIsSoFar():
        raise RemeshError(run.GetOutcomeText() or "no quads were made")


def _details(places):
    """The points of the output Small Details as dicts, with the names of the command's report."""
    names = (("kind", "Kind"), ("size", "Size"), ("decision", "Decision"), ("result", "Result"))
    data = places.GetPointData()
    return [dict({name: data.GetAbstractArray(array).GetValue(i) for name, array in names}, place=places.GetPoint(i))
            for i in range(places.GetNumberOfPoints())]


def _constraints(table):
    """The rows of the constraint table as dicts, with the names of the command's report; None where not measured."""
    names = (("id", "Id"), ("kind", "Kind"), ("source_id", "SourceId"), ("met", "Met"), ("deviation", "Deviation"),
             ("deviation_95", "Deviation95"), ("unit", "Unit"), ("reason", "Reason"), ("remark", "Remark"))

    def known(number):
        return None if number != number else number

    rows = []
    for i in range(table.GetNumberOfRows()):
        row = {name: table.GetColumnByName(column).GetValue(i) for name, column in names}
        row["place"] = tuple(table.GetColumnByName(axis).GetValue(i) for axis in "XYZ")
        row["met"] = bool(row["met"])
        row["deviation"], row["deviation_95"] = known(row["deviation"]), known(row["deviation_95"])
        rows.append(row)
    return rows


def remesh(surface, options, lines, *, wrap, requests, spread, progress):
    """The quads, or with everything quads, surface, lines, info, separatrices. surface: with the arrays that ask for
    something; requests: arguments by name, of which a wrap keeps none."""
    from ._repair import Wrapping

    run = vtkQuadRemesh()
    run.SetFailedComponents(vtkQuadRemesh.FAIL_WITH_FAILED_COMPONENTS)  # who calls a function wants all of the surface
    _set_all(run, options)
    ranks = _spread(run, wrap) if spread else None
    wrapping = Wrapping(wrap, surface, requests)
    run.SetInputData(surface)
    if lines is not None:
        run.SetCurvesData(lines)
    if progress is not None:
        def on_progress(caller, event):
            if progress(caller.GetProgress(), caller.GetProgressText() or "") is False:
                caller.SetAbortExecute(1)
        run.AddObserver("ProgressEvent", on_progress)
    result = wrapping.remeshed(run, lambda: _finish(run, ranks))
    if not options["everything"]:
        return result
    told = {"constraints": _constraints(run.GetConstraintTable()), "details": _details(run.GetDetailPlaces())}
    return result, run.GetMappedSurface(), run.GetLines(), told, run.GetSeparatrices()


# --- sessions ---------------------------------------------------------------------------------------------------------

def session(progress):
    made = filters.vtkQuadrilleSession()
    if progress is not None:
        def on_progress(caller, event):
            if progress(caller.GetProgress()) is False:
                caller.AbortUpdateOn()
        made.AddObserver("ProgressEvent", on_progress)
    return made


def session_states(session):
    return [session.GetStateName(i) for i in range(session.GetNumberOfNamedStates())]


def session_error(session):
    """Text, and whether the input is at fault."""
    return session.GetErrorText(), session.GetErrorIsInInput()


def preview_arrays(session):
    return session_arrays(session.GetPreviewQuads())


def session_mesh(session, surface):
    return session.GetQuads()


def session_arrays(data):
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).copy()
    return vtk_to_numpy(data.GetPoints().GetData()).copy(), corners.reshape(-1, 4)


def session_point_array(data, name):
    array = data.GetPointData().GetArray(name)
    return None if array is None else vtk_to_numpy(array).copy()


def session_irregular(session):
    """Points and valences."""
    data = session.GetIrregularVertices()
    return tuple(vtk_to_numpy(array).copy() for array in (
        data.GetPoints().GetData(), data.GetPointData().GetArray("Valence")))


# --- files ------------------------------------------------------------------------------------------------------------

def _reader_for(path):
    extension = os.path.splitext(path)[1].lower()
    if extension == ".ply":
        return filters.vtkQuadrillePLYReader()
    if extension == ".off":
        return filters.vtkQuadrilleOFFReader()
    if extension == ".stl":
        from vtkmodules.vtkIOGeometry import vtkSTLReader

        if filters.vtkQuadrilleSTLReader.CanReadFile(path):
            return filters.vtkQuadrilleSTLReader()
        reader = vtkSTLReader()
        reader.SetLocator(filters.vtkQuadrilleUniquePoints())
        return reader
    if extension == ".obj":
        from vtkmodules.vtkIOGeometry import vtkOBJReader
        return vtkOBJReader()
    if extension == ".vtp":
        import vtkmodules.vtkIOXML  # noqa: F401, so that Python knows the class of the reader

        return filters.vtkQuadrilleFileReader.NewXMLReader(extension)
    if extension == ".vtk":
        from vtkmodules.vtkIOLegacy import vtkPolyDataReader
        return vtkPolyDataReader()
    raise InvalidInput(f"files of the kind {extension or 'without extension'} are not read here; known are .ply, .off, "
                       ".obj, .stl, .vtp and .vtk")


class _Silence:
    """VTK's readers report through parsers of their own: what they print is collected while this is entered."""

    def __enter__(self):
        from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow

        self._before = (vtkOutputWindow.GetInstance(), vtkLogger.GetCurrentVerbosityCutoff())
        self._window = vtkStringOutputWindow()
        vtkOutputWindow.SetInstance(self._window)
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
        return self

    def __exit__(self, *_):
        from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow

        vtkOutputWindow.SetInstance(self._before[0])
        vtkLogger.SetStderrVerbosity(self._before[1])

    def reason(self):
        """The last line of what was printed; empty where nothing was."""
        lines = [line for line in self._window.GetOutput().splitlines() if line.strip()]
        return lines[-1].split("): ", 1)[-1] if lines else ""


_CAD = (".step", ".stp", ".iges", ".igs", ".brep", ".brp")


def has_cad():
    return hasattr(filters, "vtkQuadrilleCADReader")


def _missing_cad():
    return ("this build of Quadrille reads no CAD files: build it with Open CASCADE (package "
            "libocct-data-exchange-dev)")


def read_cad(path, *, chord_error, sharp_angle, follow, join_parts):
    if not has_cad():
        raise InvalidInput(f"{path}: {_missing_cad()}, or have your CAD program write STL or PLY")
    reader = filters.vtkQuadrilleCADReader()
    reader.SetFileName(path)
    reader.SetChordError(chord_error)
    reader.SetSharpAngle(sharp_angle)
    reader.SetFollow(follow)
    reader.SetJoinParts(join_parts)
    with _Silence():
        reader.Update()
    if reader.GetOutcomeText():
        raise InvalidInput(reader.GetOutcomeText())
    return reader.GetOutputDataObject(0)


def on_cad_geometry(mesh):
    if not has_cad():
        raise InvalidInput(_missing_cad())
    projection = filters.vtkQuadCADProjection()
    projection.SetInputDataObject(mesh)
    with _Silence():
        projection.Update()
    if projection.GetOutcomeText():
        raise InvalidInput(projection.GetOutcomeText())
    return projection.GetOutputDataObject(0)


def sizes_by_name(mesh, text):
    sized = filters.vtkQuadNamedSizes()
    sized.SetSizes(text)
    sized.SetInputDataObject(mesh)
    with _Silence():
        sized.Update()
    if sized.GetOutcomeText():
        raise InvalidInput(sized.GetOutcomeText())
    return sized.GetOutputDataObject(0)


def read(path):
    if os.path.splitext(path)[1].lower() in _CAD:
        return read_cad(path, chord_error=0.0005, sharp_angle=5.0, follow=0, join_parts=True)
    reader = _reader_for(path)
    if not os.path.isfile(path):
        raise InvalidInput(f"{path}: there is no such file")
    damage = filters.vtkQuadrilleFileReader.GetHeaderError(path)
    if damage:
        raise InvalidInput(f"{path}: {damage}")
    with _Silence() as silence:
        reader.SetFileName(path)
        reader.Update()
    reason = reader.GetOutcomeText() if hasattr(reader, "GetOutcomeText") else silence.reason()
    if reason:
        raise InvalidInput(reason if path in reason else f"{path}: {reason}")
    surface = reader.GetOutput()
    if path.lower().endswith(".obj"):
        filters.vtkQuadrilleFileReader.RestoreObjDigits(surface, path)
    return surface


def mesh_to_write(mesh):
    return mesh if hasattr(mesh, "GetCellData") else None


def write(mesh, path, *, patch_array, element, dialect, material, msh_version, file_details, progress):
    writer = filters.vtkQuadMeshWriter()
    if not writer.CanWriteFile(path):
        raise InvalidInput(f"{path}: unknown extension; known are {writer.GetExtensions()}")
    writer.SetFileName(path)
    writer.SetPatchArrayName(patch_array)
    writer.SetElementType(element)
    writer.SetDialect(dialect)
    writer.SetMaterial(material)
    writer.SetMshVersion(msh_version)
    writer.SetFileDetails(file_details)
    writer.SetInputDataObject(mesh)

    def on_progress(caller, _):
        if progress(caller.GetProgress(), caller.GetProgressText() or "") is False:
            caller.SetAbortExecute(1)

    if progress is not None:
        writer.AddObserver("ProgressEvent", on_progress)
    for source in (writer, writer.GetExecutive()):
        source.AddObserver("ErrorEvent", lambda caller, event: None)
    writer.Write()
    if writer.GetOutcome() != writer.Succeeded:
        kind = {writer.BadInput: InvalidInput, writer.CannotWrite: OSError}.get(writer.GetOutcome(), RemeshError)
        raise kind(writer.GetOutcomeText())
    return writer.GetNoticesText().splitlines()
