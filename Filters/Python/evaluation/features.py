# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Sharp edges of a surface, and how far the edges of a mesh lie from them."""
import math

import numpy
from scipy.spatial import cKDTree

#: Sharp edges of a surface, in degrees; how near an edge of the mesh has to be, in its edge lengths, and how far it may
#: turn away, in degrees.
ANGLE, NEAR, TURN = 40, 0.1, 20
#: Places on each edge of the mesh by which the nearest ones are found, and how many of these are looked at.
PLACES, NEAREST = 16, 16
#: Places that are looked at together, so that memory does not grow with the surface.
CHUNK = 50000


def sharp_edges(surface):
    """Ends of the edges of a triangle mesh whose faces differ by more than ANGLE, n by 2 by 3."""
    faces = surface.of_size(3)
    points, names = numpy.unique(surface.points, axis=0, return_inverse=True)
    faces = names.ravel()[faces]
    normals = numpy.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]])
    normals /= numpy.maximum(numpy.linalg.norm(normals, axis=1), 1e-300)[:, None]
    ends = numpy.sort(numpy.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    owner = numpy.tile(numpy.arange(len(faces)), 3)
    order = numpy.lexsort((ends[:, 1], ends[:, 0]))
    ends, owner = ends[order], owner[order]
    pair = numpy.flatnonzero((ends[1:] == ends[:-1]).all(axis=1))
    cosine = (normals[owner[pair]] * normals[owner[pair + 1]]).sum(axis=1)
    return points[ends[pair[cosine < math.cos(math.radians(ANGLE))]]]


def along(ends, count):
    """Places on straight lines, the middles of so many equal parts, n * count by 3."""
    part = (numpy.arange(count) + 0.5) / count
    return (ends[:, None, 0] + part[:, None] * (ends[:, None, 1] - ends[:, None, 0])).reshape(-1, 3)


def mesh_edges(mesh):
    """Ends of the edges of a mesh, each once, n by 2 by 3."""
    ends = numpy.sort(numpy.stack(mesh.half_edges, axis=1), axis=1)
    return mesh.points[numpy.unique(ends, axis=0)]


def distances_to_lines(points, ends, directions):
    """From each of n points to the straight lines between `ends`, m by 2 by 3: the distance of the nearest, and of the
    nearest of those within TURN of the direction there, a unit vector (infinite where there is none)."""
    tree = cKDTree(along(ends, PLACES))
    far, beside = numpy.empty(len(points)), numpy.empty(len(points))
    for first in range(0, len(points), CHUNK):
        part = slice(first, first + CHUNK)
        far[part], beside[part] = _to_nearest(tree, points[part], ends, directions[part])
    return far, beside


def _to_nearest(tree, points, ends, directions):
    _, near = tree.query(points, k=min(NEAREST, tree.n))
    near = numpy.asarray(near).reshape(len(points), -1) // PLACES
    start, way = ends[near, 0], ends[near, 1] - ends[near, 0]
    offset = points[:, None] - start
    squares = numpy.maximum((way * way).sum(axis=2), 1e-300)
    part = numpy.clip((offset * way).sum(axis=2) / squares, 0, 1)
    far = numpy.linalg.norm(offset - part[..., None] * way, axis=2)
    cosine = numpy.abs((way * directions[:, None]).sum(axis=2)) / numpy.sqrt(squares)
    return far.min(axis=1), numpy.where(cosine >= math.cos(math.radians(TURN)), far, math.inf).min(axis=1)


def deviation(surface, mesh):
    """(mean and largest distance of the surface's sharp edges from the edges of the mesh, weighted by length, and the
    share of their length within NEAR edge lengths of one that runs along); None where the surface, of triangles, has no
    sharp edge."""
    sharp = sharp_edges(surface)
    if len(sharp) == 0:
        return None
    edges = mesh_edges(mesh)
    near = NEAR * numpy.linalg.norm(edges[:, 1] - edges[:, 0], axis=1).mean()
    # So many places that even one long edge is followed.
    ways = sharp[:, 1] - sharp[:, 0]
    lengths = numpy.linalg.norm(ways, axis=1)
    parts = int(numpy.clip(math.ceil(2 * numpy.percentile(lengths, 99) / near), 4, 64))
    far, beside = distances_to_lines(along(sharp, parts), edges,
                                     numpy.repeat(ways / numpy.maximum(lengths, 1e-300)[:, None], parts, axis=0))
    weights = numpy.repeat(lengths, parts)
    return (float((far * weights).sum() / weights.sum()), float(far.max()),
            float(weights[beside <= near].sum() / weights.sum()))
