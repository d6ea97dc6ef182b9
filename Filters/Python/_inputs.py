# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Arrays, lists and data sets of Python as the vtkPolyData that the filters take."""
import os

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdTypeArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkCompositeDataSet, vtkDataSet, vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm

from ._errors import InvalidInput

_KINDS = "a vtkPolyData (or another vtkDataSet), or a pair (points, faces)"


def _numbers(name, values, shape):
    """values as an array of numbers; `shape` is how the message calls what is wanted."""
    try:
        array = numpy.asarray(values)
    except ValueError:  # rows of different lengths
        raise InvalidInput(f"{name} must be {shape}; its rows have different lengths") from None
    if array.dtype == object or array.dtype.kind not in "iufb":
        raise InvalidInput(f"{name} must be {shape}, but it does not hold numbers only (it is {array.dtype})")
    return array


def as_points(points, name="points"):
    """n by 3 real numbers, all finite."""
    array = _numbers(name, points, "n by 3 numbers")
    if array.ndim == 1 and array.size % 3 == 0 and array.size > 0:
        raise InvalidInput(f"{name} must be n by 3, not a flat array of {array.size}: take reshape(-1, 3)")
    if array.ndim == 2 and array.shape[1] == 2:
        raise InvalidInput(f"{name} must be n by 3, not {array.shape}: add a column of zeros for z")
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidInput(f"{name} must be n by 3, not {array.shape}")
    array = numpy.ascontiguousarray(array, dtype=numpy.float64)
    bad = numpy.flatnonzero(~numpy.isfinite(array).all(axis=1))
    if bad.size:
        raise InvalidInput(f"point {bad[0]} of {name} is {array[bad[0]].tolist()}: coordinates must be finite")
    return array


def _as_ids(name, values):
    """Whole numbers as int64, whatever type they came as."""
    if values.dtype.kind == "f":
        bad = numpy.flatnonzero(~(numpy.isfinite(values) & (values == numpy.floor(values))))
        if bad.size:
            raise InvalidInput(f"{name} must hold whole numbers, but has {values.ravel()[bad[0]]!r}")
    if values.dtype.kind == "b":
        raise InvalidInput(f"{name} must hold whole numbers, not truth values")
    return values.astype(numpy.int64)


def _split_counted(flat):
    """Faces of a flat array n, id 1 ... id n, n, ... as VTK had it, or None where it is none."""
    starts = []
    at = 0
    while at < flat.size and 3 <= flat[at] <= flat.size - at - 1:
        starts.append(at)
        at += int(flat[at]) + 1
    return starts if at == flat.size and starts else None


def _from_flat(flat):
    starts = _split_counted(flat)
    triangles = flat.size % 3 == 0
    if starts is None or triangles:
        advice = "take reshape(-1, 3) if they are triangles" if triangles else "give one row of point ids a face"
        also = ", or leave out the counts if they are [3, a, b, c, ...]" if starts is not None else ""
        raise InvalidInput(f"faces is a flat array of {flat.size} numbers: {advice}{also}")
    counts = flat[starts]
    keep = numpy.ones(flat.size, dtype=bool)
    keep[starts] = False
    return counts, flat[keep]


def _without_counts(rows):
    """Rows [n, id 1 ... id n] as rows of ids. A face that names a point twice is none, so these cannot be polygons with
    one corner more."""
    corners = rows.shape[1] - 1
    if corners < 3 or rows.shape[0] == 0 or not (rows[:, 0] == corners).all():
        return rows
    if (rows[:, 1:] == corners).any():
        return rows[:, 1:]
    raise InvalidInput(
        f"each of the faces begins with {corners} and has {corners} numbers more: if that is their number of corners, "
        "as in VTK, give faces[:, 1:]; if not, begin one of them with another of its points")


def as_faces(faces, point_count):
    """Number of corners of each face, and the corners of all: from an array m by k, a list of lists of point ids, or
    VTK's faces with their numbers of corners before them (rows or flat)."""
    try:
        array = numpy.asarray(faces)
    except ValueError:
        array = None  # rows of different lengths
    if array is None or array.dtype == object:
        rows = [_as_ids(f"face {i}", _numbers(f"face {i}", face, "a list of point ids").ravel())
                for i, face in enumerate(faces)]
        counts = numpy.array([row.size for row in rows], dtype=numpy.int64)
        corners = numpy.concatenate(rows) if rows else numpy.zeros(0, numpy.int64)
    else:
        array = _as_ids("faces", _numbers("faces", array, "m by 3 point ids"))
        if array.size == 0:
            raise InvalidInput("the mesh has no faces")
        if array.ndim == 1:
            counts, corners = _from_flat(array)
        elif array.ndim == 2:
            array = _without_counts(array)
            counts = numpy.full(array.shape[0], array.shape[1], dtype=numpy.int64)
            corners = array.ravel()
        else:
            raise InvalidInput(f"faces must be m by 3 (or m by 4, or a list of lists), not {array.shape}")
    _check_corners(counts, corners, point_count)
    return counts, corners


def _check_corners(counts, corners, point_count):
    few = numpy.flatnonzero(counts < 3)
    if few.size:
        raise InvalidInput(f"face {few[0]} has {counts[few[0]]} corners; a face needs 3 at least")
    bad = numpy.flatnonzero((corners < 0) | (corners >= point_count))
    if bad.size:
        face = numpy.searchsorted(numpy.cumsum(counts), bad[0], side="right")
        from_one = corners.min() == 1 and corners.max() == point_count
        raise InvalidInput(f"face {face} names point {corners[bad[0]]}, but there are only the points 0 to "
                           f"{point_count - 1}"
                           + ("; the ids seem to begin at 1: subtract 1" if from_one else ""))


def _cells(counts, corners):
    def ids(values):
        return numpy_to_vtk(numpy.ascontiguousarray(values), deep=True, array_type=vtkIdTypeArray().GetDataType())

    cells = vtkCellArray()
    cells.SetData(ids(numpy.concatenate(([0], numpy.cumsum(counts)))), ids(corners))
    return cells


def to_polydata(points, faces):
    """A vtkPolyData from points (n by 3) and faces: an array (m by 3, or m by 4), a list of lists of point ids, or
    faces with their numbers of corners before them, as VTK and PyVista have them. Raises InvalidInput, which names the
    point or the face."""
    points = as_points(points)
    mesh = vtkPolyData()
    mesh.SetPoints(vtkPoints())
    mesh.GetPoints().SetData(numpy_to_vtk(points, deep=True))
    mesh.SetPolys(_cells(*as_faces(faces, len(points))))
    return mesh


def as_cloud(points):
    """A vtkPolyData of points alone."""
    array = as_points(points)
    cloud = vtkPolyData()
    cloud.SetPoints(vtkPoints())
    cloud.GetPoints().SetData(numpy_to_vtk(array, deep=True))
    cloud.SetVerts(_cells(numpy.ones(len(array), dtype=numpy.int64), numpy.arange(len(array))))
    return cloud


def as_surface(mesh):
    """The vtkPolyData of what remesh takes as its mesh. Raises InvalidInput that says what to do with anything else."""
    if isinstance(mesh, vtkPolyData):
        return mesh
    if isinstance(mesh, vtkDataSet):
        return _surface_of(mesh)
    if isinstance(mesh, vtkCompositeDataSet):
        raise InvalidInput("the mesh is composite data: call remesh for each of its blocks, or use the filter "
                           "vtkQuadRemesh, which takes them all")
    if isinstance(mesh, vtkAlgorithm):
        raise InvalidInput(f"{mesh.GetClassName()} is a reader or filter: call its Update(), then pass its GetOutput()")
    if hasattr(mesh, "SMProxy"):
        raise InvalidInput("this is a ParaView proxy: use QuadRemesh(Input=...) and quadrille.check(), or pass "
                           "servermanager.Fetch(...)")
    if isinstance(mesh, (str, bytes, os.PathLike)):
        raise InvalidInput(f"the mesh must be {_KINDS}, not the name of a file: quadrille.read({str(mesh)!r}) reads it")
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return to_polydata(mesh.vertices, mesh.faces)
    try:
        points, faces = mesh
    except (TypeError, ValueError):
        raise InvalidInput(f"the mesh must be {_KINDS}, not {type(mesh).__name__}") from None
    return to_polydata(points, faces)


def _surface_of(data):
    from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(data)
    surface.Update()
    if surface.GetOutput().GetNumberOfPolys() + surface.GetOutput().GetNumberOfStrips() == 0:
        raise InvalidInput(f"the {data.GetClassName()} has no surface: it has {data.GetNumberOfCells()} cells, none of "
                           "them a polygon or a volume")
    return surface.GetOutput()


# --- what is asked for ------------------------------------------------------------------------------------------------

def _per(name, values, count, element, components=1):
    """values as an array with one row for each of the `count` elements."""
    shape = f"one number a {element}" if components == 1 else f"#{element}s by {components} numbers"
    array = _numbers(name, values, shape)
    if components == 1 and array.ndim == 2 and array.shape[1] == 1:
        array = array.ravel()
    wanted = (count,) if components == 1 else (count, components)
    if array.shape != wanted:
        raise InvalidInput(f"{name} must have {shape}: the shape {wanted}, not {array.shape}")
    return array


def _add(attributes, name, values, kind):
    array = numpy_to_vtk(numpy.ascontiguousarray(values.astype(kind)), deep=True)
    array.SetName(name)
    attributes.AddArray(array)


def _bits_of_pairs(surface, pairs):
    """FeatureEdges of the polygons from pairs of point ids."""
    offsets = vtk_to_numpy(surface.GetPolys().GetOffsetsArray()).astype(numpy.int64)
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).astype(numpy.int64)
    point_count = surface.GetNumberOfPoints()
    bad = numpy.flatnonzero(((pairs < 0) | (pairs >= point_count)).any(axis=1))
    if bad.size:
        raise InvalidInput(f"feature edge {bad[0]} is {tuple(pairs[bad[0]].tolist())}, but there are only the points 0 "
                           f"to {point_count - 1}")
    counts = numpy.diff(offsets)
    face = numpy.repeat(numpy.arange(counts.size), counts)
    corner = numpy.arange(corners.size) - offsets[face]
    following = numpy.where(corner + 1 < counts[face], numpy.arange(corners.size) + 1, offsets[face])
    ends = numpy.sort(numpy.stack((corners, corners[following]), axis=1), axis=1)
    wanted = numpy.sort(pairs, axis=1)
    edge_keys = ends[:, 0] * point_count + ends[:, 1]
    wanted_keys = wanted[:, 0] * point_count + wanted[:, 1]
    missing = numpy.flatnonzero(~numpy.isin(wanted_keys, edge_keys))
    if missing.size:
        raise InvalidInput(f"feature edge {missing[0]}, from point {pairs[missing[0], 0]} to {pairs[missing[0], 1]}, "
                           "is no edge of a face; a line across faces can be given in `curves`")
    marked = numpy.isin(edge_keys, wanted_keys)
    if (corner[marked] > 7).any():
        raise InvalidInput(f"face {face[marked][corner[marked] > 7][0]} has more than 8 corners: triangulate it to "
                           "mark its edges")
    bits = numpy.zeros(counts.size, numpy.uint8)
    numpy.bitwise_or.at(bits, face[marked], (1 << corner[marked]).astype(numpy.uint8))
    return bits


def _feature_bits(surface, feature_edges):
    array = _as_ids("feature_edges", _numbers("feature_edges", feature_edges,
                                              "n by 2 point ids, or one number of bits a face"))
    if array.ndim == 2 and array.shape[1] == 2:
        return _bits_of_pairs(surface, array)
    faces = surface.GetNumberOfPolys()
    if array.shape != (faces,):
        raise InvalidInput(f"feature_edges must be n by 2 point ids, or bits for each of the {faces} faces, not of the "
                           f"shape {array.shape}")
    bad = numpy.flatnonzero((array < 0) | (array > 255))
    if bad.size:
        raise InvalidInput(f"feature_edges of face {bad[0]} is {array[bad[0]]}, but bits for 8 edges are 0 to 255")
    return array


def _valences(target_valence, point_count):
    if not isinstance(target_valence, dict):
        return _as_ids("target_valence", _per("target_valence", target_valence, point_count, "point"))
    valences = numpy.zeros(point_count, numpy.int64)
    for point, valence in target_valence.items():
        if not 0 <= point < point_count:
            raise InvalidInput(f"target_valence names point {point}, but there are only the points 0 to "
                               f"{point_count - 1}")
        valences[point] = valence
    return valences


def with_requests(surface, *, guiding_direction=None, guiding_weight=None, target_valence=None, sizing=None,
                  feature_edges=None,
                  patch_ids=None, patch_array="PatchId"):
    """The surface with the arrays that the filters look for; the surface itself stays as it is."""
    given = (guiding_direction, guiding_weight, target_valence, sizing, feature_edges, patch_ids)
    if all(values is None for values in given):
        return surface
    as_arrays = [v for v in given if v is not None and v is not target_valence]
    if surface.GetNumberOfCells() != surface.GetNumberOfPolys() and as_arrays:
        raise InvalidInput("the surface has vertices, lines or strips beside its polygons, so arrays of its faces "
                           "could be meant in two ways; keep the polygons only (vtkCleanPolyData, vtkTriangleFilter)")
    faces, points = surface.GetNumberOfPolys(), surface.GetNumberOfPoints()
    result = vtkPolyData()
    result.ShallowCopy(surface)
    cell_data, point_data = result.GetCellData(), result.GetPointData()
    if guiding_weight is not None and guiding_direction is None and not cell_data.HasArray("GuidingDirection"):
        raise InvalidInput("guiding_weight needs guiding_direction")
    if guiding_direction is not None:
        _add(cell_data, "GuidingDirection", _per("guiding_direction", guiding_direction, faces, "face", 3),
             numpy.float64)
    if guiding_weight is not None:
        weights = numpy.full(faces, guiding_weight) if numpy.ndim(guiding_weight) == 0 else guiding_weight
        _add(cell_data, "GuidingWeight", _per("guiding_weight", weights, faces, "face"), numpy.float64)
    if target_valence is not None:
        _add(point_data, "TargetValence", _valences(target_valence, points), numpy.int32)
    if sizing is not None:
        _add(point_data, "Sizing", _per("sizing", sizing, points, "point"), numpy.float64)
    if feature_edges is not None:
        _add(cell_data, "FeatureEdges", _feature_bits(result, feature_edges), numpy.uint8)
    if patch_ids is not None:
        _add(cell_data, patch_array or "PatchId", _as_ids("patch_ids", _per("patch_ids", patch_ids, faces, "face")),
             numpy.int64)
    return result


def _polylines(name, lines):
    """A list of polylines, each n by 3 points, n at least 2."""
    if isinstance(lines, numpy.ndarray) and lines.ndim == 2:
        lines = [lines]  # one polyline
    result = []
    for i, line in enumerate(lines):
        points = as_points(line, f"{name}[{i}]")
        if len(points) < 2:
            raise InvalidInput(f"{name}[{i}] has {len(points)} point(s); a line needs 2 at least")
        result.append(points)
    return result


#: Values of the array ConstraintType.
_TYPES = {"curves": 0, "strokes": 1, "connections": 2, "cycles": 3}


def as_curves(**given):
    """The lines of all as one vtkPolyData with the array ConstraintType, or None. curves may be a vtkPolyData that has
    it already."""
    given = {name: lines for name, lines in given.items() if lines is not None}
    ready = given.get("curves")
    if isinstance(ready, vtkPolyData):
        if len(given) > 1:
            others = ", ".join(f"{name} ({_TYPES[name]})" for name in given if name != "curves")
            raise InvalidInput(f"beside a vtkPolyData of curves there is no room for {others}: put them into it, with "
                               "these numbers in its cell array ConstraintType")
        return ready
    lines = [(line, _TYPES[name]) for name in given for line in _polylines(name, given[name])]
    if not lines:
        return None
    data = vtkPolyData()
    data.SetPoints(vtkPoints())
    data.GetPoints().SetData(numpy_to_vtk(numpy.concatenate([line for line, _ in lines]), deep=True))
    counts = numpy.array([len(line) for line, _ in lines], dtype=numpy.int64)
    data.SetLines(_cells(counts, numpy.arange(counts.sum())))
    _add(data.GetCellData(), "ConstraintType", numpy.array([kind for _, kind in lines]), numpy.int32)
    return data
