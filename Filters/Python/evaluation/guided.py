# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Guides for the study of a surface, and how well the isolines of a map follow them."""
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

import quadrille

DIRECTION = "GuidingDirection"


def _triangles(surface):
    """Corners of its triangles, n by 3 by 3; None where it has other faces."""
    polys = surface.GetPolys()
    offsets = vtk_to_numpy(polys.GetOffsetsArray())
    if len(offsets) < 2 or (numpy.diff(offsets) != 3).any():
        return None
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    return points[vtk_to_numpy(polys.GetConnectivityArray()).reshape(-1, 3)]


def _areas(corners):
    """(normals, areas); normals of flat triangles are zero."""
    cross = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = numpy.linalg.norm(cross, axis=1)
    return cross / numpy.maximum(lengths, 1e-300)[:, None], lengths / 2


def with_sections(surface, quads):
    """A copy of a surface of triangles that asks for edges along three closed strokes, as users draw them: along its
    sections with the planes through the centre of its area and across its principal axes, half an edge of `quads` quads
    to both sides. A surface that has guides keeps its own. Raises InvalidInput where it has other faces than triangles.
    """
    result = vtkPolyData()
    result.ShallowCopy(surface)
    if surface.GetCellData().HasArray(DIRECTION):
        return result
    corners = _triangles(surface)
    if corners is None or surface.GetNumberOfCells() != len(corners):
        raise quadrille.InvalidInput("guides are drawn on surfaces of triangles alone; cut the faces into triangles "
                                     "first")
    normals, areas = _areas(corners)
    centres = corners.mean(axis=1)
    middle = (centres * areas[:, None]).sum(axis=0) / areas.sum()
    offset = centres - middle
    _, axes = numpy.linalg.eigh((offset * areas[:, None]).T @ offset)
    half = numpy.sqrt(areas.sum() / quads) / 2
    directions = numpy.zeros_like(normals)
    for axis in axes.T:
        distance = (corners - middle) @ axis
        along = numpy.cross(axis, normals)
        near = (distance.min(axis=1) <= half) & (distance.max(axis=1) >= -half)
        near &= numpy.linalg.norm(along, axis=1) > 0.5  # not where the plane touches the surface
        near &= (directions == 0).all(axis=1)
        directions[near] = along[near]
    array = numpy_to_vtk(directions, deep=True)
    array.SetName(DIRECTION)
    result.GetCellData().AddArray(array)
    return result


def deviation(mapped):
    """The angle between the guides of a mapped surface and the nearer of the two families of isolines, in degrees: the
    mean over the area that has guides, at most 45; None without guides. Triangles without area, on the surface or in
    the map, are left out."""
    guides, maps = mapped.GetCellData().GetArray(DIRECTION), mapped.GetCellData().GetArray("IGM")
    if guides is None or maps is None:
        return None
    directions, uv = vtk_to_numpy(guides).astype(float), vtk_to_numpy(maps).astype(float).reshape(-1, 3, 2)
    corners = _triangles(mapped)
    normals, areas = _areas(corners)
    # In the plane of each triangle: directions from the angle with its first edge, the map's differential from edges.
    first = corners[:, 1] - corners[:, 0]
    x = first / numpy.maximum(numpy.linalg.norm(first, axis=1), 1e-300)[:, None]
    y = numpy.cross(normals, x)
    second = corners[:, 2] - corners[:, 0]
    edges = numpy.stack([numpy.stack([(first * x).sum(axis=1), (second * x).sum(axis=1)], axis=1),
                         numpy.stack([(first * y).sum(axis=1), (second * y).sum(axis=1)], axis=1)], axis=1)
    images = numpy.stack([uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]], axis=2)
    asked = numpy.stack([(directions * x).sum(axis=1), (directions * y).sum(axis=1)], axis=1)
    determinants = numpy.linalg.det(images)
    used = (numpy.linalg.norm(asked, axis=1) > 0) & (areas > 0) & (determinants > 0)
    if not used.any():
        return None
    # Isolines on the surface: images of the two axes of the plane under the inverse map.
    lines = edges[used] @ numpy.linalg.inv(images[used])
    lines /= numpy.linalg.norm(lines, axis=1, keepdims=True)
    asked = asked[used] / numpy.linalg.norm(asked[used], axis=1, keepdims=True)
    cosines = numpy.abs(numpy.einsum("nij,ni->nj", lines, asked)).max(axis=1)
    angles = numpy.degrees(numpy.arccos(numpy.clip(cosines, 0, 1)))
    return float((angles * areas[used]).sum() / areas[used].sum())
