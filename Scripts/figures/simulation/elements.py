# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Shape functions and quadrature of the four plane elements: triangles of 3 and 6 nodes, quads of 4 and 8 nodes.

Nodes are numbered as Abaqus, CalculiX and VTK do: corners, then the middles of the edges 01, 12, 23, 30. The quad's
parameters are in [-1, 1]^2, the triangle's in the unit triangle [Zienkiewicz and Taylor, The Finite Element Method].
"""
import numpy as np

CORNERS = {3: 3, 6: 3, 4: 4, 8: 4}
_QUAD = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], float)
#: Points of Gauss's rule on a line: the exact solution is no polynomial, so more than the element's own rule has.
ORDER = 6


def shape(nodes, r, s):
    """(values, derivatives): #points by #nodes, and #points by #nodes by 2, of the element with so many nodes."""
    r, s = np.atleast_1d(r).astype(float), np.atleast_1d(s).astype(float)
    if nodes in (3, 6):
        barycentric = np.stack([1 - r - s, r, s], 1)
        slope = np.array([[-1, -1], [1, 0], [0, 1]], float)
        if nodes == 3:
            return barycentric, np.broadcast_to(slope, (len(r), 3, 2))
        values, slopes = [], []
        for i in range(3):
            b = barycentric[:, i]
            values.append(b * (2 * b - 1))
            slopes.append((4 * b - 1)[:, None] * slope[i])
        for i in range(3):
            j = (i + 1) % 3
            values.append(4 * barycentric[:, i] * barycentric[:, j])
            slopes.append(4 * (barycentric[:, i, None] * slope[j] + barycentric[:, j, None] * slope[i]))
        return np.stack(values, 1), np.stack(slopes, 1)
    values = np.empty((len(r), nodes))
    slopes = np.empty((len(r), nodes, 2))
    for i, (a, b) in enumerate(_QUAD):
        values[:, i] = (1 + a * r) * (1 + b * s) / 4
        slopes[:, i, 0] = a * (1 + b * s) / 4
        slopes[:, i, 1] = b * (1 + a * r) / 4
    if nodes == 4:
        return values, slopes
    for i in range(4):
        a, b = (_QUAD[i] + _QUAD[(i + 1) % 4]) / 2
        if a == 0:
            values[:, 4 + i] = (1 - r * r) * (1 + b * s) / 2
            slopes[:, 4 + i, 0] = -r * (1 + b * s)
            slopes[:, 4 + i, 1] = b * (1 - r * r) / 2
        else:
            values[:, 4 + i] = (1 + a * r) * (1 - s * s) / 2
            slopes[:, 4 + i, 0] = a * (1 - s * s) / 2
            slopes[:, 4 + i, 1] = -s * (1 + a * r)
    for i in range(4):  # a corner's function vanishes in the middles of its two edges
        for k in (4 + i, 4 + (i + 3) % 4):
            values[:, i] -= values[:, k] / 2
            slopes[:, i] -= slopes[:, k] / 2
    return values, slopes


def line_shape(nodes, r):
    """(values, derivatives), #points by #nodes, of an edge of 2 nodes, or 3 with the middle last; r in [-1, 1]."""
    r = np.asarray(r, float)
    if nodes == 2:
        return np.stack([(1 - r) / 2, (1 + r) / 2], 1), np.stack([-0.5 + 0 * r, 0.5 + 0 * r], 1)
    return (np.stack([r * (r - 1) / 2, r * (r + 1) / 2, 1 - r * r], 1), np.stack([r - 0.5, r + 0.5, -2 * r], 1))


def quadrature(nodes):
    """(r, s, weights) on the element with so many nodes; on triangles the quad's rule with one side collapsed."""
    x, w = np.polynomial.legendre.leggauss(ORDER)
    r, s = (g.ravel() for g in np.meshgrid(x, x, indexing="ij"))
    weights = np.outer(w, w).ravel()
    if CORNERS[nodes] == 4:
        return r, s, weights
    r, s, weights = (r + 1) / 2, (s + 1) / 2, weights / 4
    return r, s * (1 - r), weights * (1 - r)


def edges(nodes):
    """The edges of the element with so many nodes, as places in its list: begin, end and, if there is one, middle."""
    corners = CORNERS[nodes]
    middle = [(corners + i,) for i in range(corners)] if nodes > corners else [()] * corners
    return [(i, (i + 1) % corners) + middle[i] for i in range(corners)]
