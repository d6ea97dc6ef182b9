# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What Python has as the surface, and what is asked of it, as the backend takes it."""
import os
import typing

import numpy

from ._arrays import as_faces, as_ids, as_numbers, as_points, per_element
from ._backend import backend
from ._errors import InvalidInput

_KINDS = "a vtkPolyData (or another vtkDataSet), or a pair (points, faces)"


def surface_of_arrays(points, faces):
    """A surface from points (n by 3) and faces: an array (m by 3, or m by 4), a list of lists of point ids, or
    faces with their numbers of corners before them, as VTK and PyVista have them. Raises InvalidInput, which names the
    point or the face."""
    points = as_points(points)
    return backend.surface_from(points, *as_faces(faces, len(points)))


def to_polydata(points, faces):
    """A vtkPolyData from points (n by 3) and faces: an array (m by 3, or m by 4), a list of lists of point ids, or
    faces with their numbers of corners before them, as VTK and PyVista have them. Raises InvalidInput, which names the
    point or the face. Needs VTK."""
    return backend.polydata_of(surface_of_arrays(points, faces))


def as_surface(mesh):
    """The surface of what remesh takes as its mesh. Raises InvalidInput that says what to do with anything else."""
    surface = backend.surface_of(mesh)
    if surface is not None:
        return surface
    if hasattr(mesh, "SMProxy"):
        raise InvalidInput("this is a ParaView proxy: use QuadRemesh(Input=...) and quadrille.check(), or pass "
                           "servermanager.Fetch(...)")
    if isinstance(mesh, (str, bytes, os.PathLike)):
        raise InvalidInput(f"the mesh must be {_KINDS}, not the name of a file: quadrille.read({str(mesh)!r}) reads it")
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return surface_of_arrays(mesh.vertices, mesh.faces)
    try:
        points, faces = mesh
    except (TypeError, ValueError):
        raise InvalidInput(f"the mesh must be {_KINDS}, not {type(mesh).__name__}") from None
    return surface_of_arrays(points, faces)


# --- what is asked for ------------------------------------------------------------------------------------------------

def _bits_of_pairs(surface, pairs):
    """FeatureEdges of the polygons from pairs of point ids."""
    offsets, corners = backend.polygons_of(surface)
    point_count = backend.point_count(surface)
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
    array = as_ids("feature_edges", as_numbers("feature_edges", feature_edges,
                                              "n by 2 point ids, or one number of bits a face"))
    if array.ndim == 2 and array.shape[1] == 2:
        return _bits_of_pairs(surface, array)
    faces = backend.face_count(surface)
    if array.shape != (faces,):
        raise InvalidInput(f"feature_edges must be n by 2 point ids, or bits for each of the {faces} faces, not of the "
                           f"shape {array.shape}")
    bad = numpy.flatnonzero((array < 0) | (array > 255))
    if bad.size:
        raise InvalidInput(f"feature_edges of face {bad[0]} is {array[bad[0]]}, but bits for 8 edges are 0 to 255")
    return array


def _valences(target_valence, point_count):
    if not isinstance(target_valence, dict):
        return as_ids("target_valence", per_element("target_valence", target_valence, point_count, "point"))
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
    if as_arrays and not backend.has_polygons_only(surface):
        raise InvalidInput("the surface has vertices, lines or strips beside its polygons, so arrays of its faces "
                           "could be meant in two ways; keep the polygons only (vtkCleanPolyData, vtkTriangleFilter)")
    faces, points = backend.face_count(surface), backend.point_count(surface)
    cells, nodes = {}, {}
    if guiding_weight is not None and guiding_direction is None and not backend.has_cell_array(
            surface, "GuidingDirection"):
        raise InvalidInput("guiding_weight needs guiding_direction")
    if guiding_direction is not None:
        direction = per_element("guiding_direction", guiding_direction, faces, "face", 3)
        cells["GuidingDirection"] = direction.astype(numpy.float64)
    if guiding_weight is not None:
        weights = numpy.full(faces, guiding_weight) if numpy.ndim(guiding_weight) == 0 else guiding_weight
        weights = per_element("guiding_weight", weights, faces, "face")
        cells["GuidingWeight"] = weights.astype(numpy.float64)
    if target_valence is not None:
        nodes["TargetValence"] = _valences(target_valence, points).astype(numpy.int32)
    if sizing is not None:
        nodes["Sizing"] = per_element("sizing", sizing, points, "point").astype(numpy.float64)
    if feature_edges is not None:
        cells["FeatureEdges"] = _feature_bits(surface, feature_edges).astype(numpy.uint8)
    if patch_ids is not None:
        ids = as_ids("patch_ids", per_element("patch_ids", patch_ids, faces, "face"))
        cells[patch_array or "PatchId"] = ids.astype(numpy.int64)
    return backend.with_arrays(surface, nodes, cells)


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
_TYPES = {"curves": 0, "strokes": 1, "connections": 2, "cycles": 3, "cleared": 6, "sizes": 7}


class Line(typing.NamedTuple):
    """What is drawn: a polyline, or one point."""
    kind: int            # see _TYPES
    points: numpy.ndarray
    radius: float = 0.0  # of strokes and sizes
    factor: float = 1.0  # of sizes


def _sizes(given):
    for i, size in enumerate(given):
        if len(size) != 3:
            raise InvalidInput(f"sizes[{i}] has {len(size)} values; a size is a point, a radius and a factor")
        point, radius, factor = size
        yield Line(_TYPES["sizes"], as_points([point], f"sizes[{i}]"), float(radius), float(factor))


def as_curves(stroke_radius=0.0, **given):
    """The lines of all as the backend takes them, or None. curves may be a vtkPolyData, with ConstraintType."""
    given = {name: lines for name, lines in given.items() if lines is not None}
    ready = given.get("curves")
    if backend.is_polydata(ready):
        if len(given) > 1:
            others = ", ".join(f"{name} ({_TYPES[name]})" for name in given if name != "curves")
            raise InvalidInput(f"beside a vtkPolyData of curves there is no room for {others}: put them into it, with "
                               "these numbers in its cell array ConstraintType")
        return backend.lines_of(ready)
    sizes = list(_sizes(given.pop("sizes", ())))
    cleared = as_points(given.pop("cleared", numpy.zeros((0, 3))), "cleared")
    lines = [Line(_TYPES[name], line, stroke_radius) for name in given for line in _polylines(name, given[name])]
    lines += [Line(_TYPES["cleared"], point.reshape(1, 3)) for point in cleared]
    lines += sizes
    return backend.lines_from(lines) if lines else None
