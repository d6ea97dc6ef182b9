# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The block structure of a mesh of quads: the patches of its base complex."""
import numpy
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components


def _twins(corners):
    """Of each half-edge (4 f + k: from corner k of face f to the next one) the other one on its edge, -1 on a boundary;
    None where an edge has more than two faces or two that are turned against each other."""
    tail = corners.ravel()
    head = numpy.roll(corners, -1, axis=1).ravel()
    count = int(corners.max()) + 1
    ours, theirs = tail * count + head, head * count + tail
    order = numpy.argsort(ours)
    ordered = ours[order]
    if (ordered[1:] == ordered[:-1]).any():
        return None
    place = numpy.minimum(numpy.searchsorted(ordered, theirs), len(ordered) - 1)
    return numpy.where(ordered[place] == theirs, order[place], -1)


def patches(mesh):
    """The number of patches of the base complex: what is left where straight lines of edges are drawn on from every
    vertex inside without four edges, and from every one on the boundary without three, until they end on the boundary
    or in such a vertex. A component without any is one patch. None where a face has other than four corners, or the
    mesh is not manifold and oriented."""
    if len(mesh.sizes) == 0 or (mesh.sizes != 4).any():
        return None
    corners = mesh.of_size(4)
    twin = _twins(corners)
    if twin is None:
        return None
    half_edges = numpy.arange(corners.size)
    tail = corners.ravel()
    following = half_edges - half_edges % 4 + (half_edges + 1) % 4
    faces = numpy.bincount(tail, minlength=len(mesh.points))
    on_boundary = numpy.zeros(len(mesh.points), dtype=bool)
    on_boundary[tail[twin < 0]] = True
    on_boundary[tail[following[twin < 0]]] = True
    irregular = faces != numpy.where(on_boundary, 2, 4)

    drawn = twin < 0
    # On a boundary the last edge round a vertex goes out of it in no half-edge: its other one comes in.
    line = half_edges[irregular[tail] & (twin >= 0)]
    come_in = half_edges[irregular[tail[following]] & (twin >= 0)]
    line = numpy.union1d(line, twin[come_in])
    while len(line):
        line = line[~drawn[line]]
        drawn[line] = True
        drawn[twin[line]] = True
        end = tail[following[line]]
        across = twin[following[line[~irregular[end] & ~on_boundary[end]]]]
        line = numpy.unique(following[across])
    inside = half_edges[~drawn & (twin >= 0)]
    graph = coo_matrix((numpy.ones(len(inside)), (inside // 4, twin[inside] // 4)), shape=(len(corners),) * 2)
    return int(connected_components(graph, directed=False)[0])
