# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces that are spread over ranks, and what must hold of the quads: for spread_script.py and spread_table.py.

Every rank makes the same whole surface and keeps its part of it, as a reader or a filter of ParaView would deliver it.
"""
import hashlib

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersModeling import vtkLinearSubdivisionFilter
from vtkmodules.vtkFiltersSources import vtkPlatonicSolidSource
from vtkmodules.vtkParallelCore import vtkMultiProcessController

CONTROLLER = vtkMultiProcessController.GetGlobalController()
RANK, RANKS = CONTROLLER.GetLocalProcessId(), CONTROLLER.GetNumberOfProcesses()
TAG = 4711


def surface(points, triangles):
    """points: #V by 3; triangles: #F by 3. -> vtkPolyData."""
    data = vtkPolyData()
    places = vtkPoints()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    cells = vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(np.arange(0, 3 * len(triangles) + 1, 3, dtype=np.int64), deep=1),
                  numpy_to_vtkIdTypeArray(np.ascontiguousarray(triangles, dtype=np.int64).reshape(-1), deep=1))
    data.SetPoints(places)
    data.SetPolys(cells)
    return data


def arrays_of(data):
    """Points and triangles of a vtkPolyData of triangles."""
    return (vtk_to_numpy(data.GetPoints().GetData()).astype(float),
            vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3))


def icosphere(times=3):
    """Triangles of a sphere of radius 1: those of an icosahedron, cut into four so many times."""
    source = vtkPlatonicSolidSource()
    source.SetSolidTypeToIcosahedron()
    finer = vtkLinearSubdivisionFilter()
    finer.SetNumberOfSubdivisions(times)
    finer.SetInputConnection(source.GetOutputPort())
    finer.Update()
    points, triangles = arrays_of(finer.GetOutput())
    return points / np.linalg.norm(points, axis=1, keepdims=True), triangles


def sphere(rows=24):
    """Triangles of a sphere of radius 1, closed; 4 rows^2 faces."""
    theta = np.pi * np.arange(1, rows) / rows
    phi = 2 * np.pi * np.arange(2 * rows) / (2 * rows)
    ring = np.stack([np.outer(np.sin(theta), np.cos(phi)), np.outer(np.sin(theta), np.sin(phi)),
                     np.outer(np.cos(theta), np.ones_like(phi))], -1).reshape(-1, 3)
    points = np.vstack([ring, [[0, 0, 1], [0, 0, -1]]])
    n, top, bottom = 2 * rows, len(ring), len(ring) + 1
    triangles = []
    for j in range(n):
        k = (j + 1) % n
        triangles += [(top, j, k), (bottom, (rows - 2) * n + k, (rows - 2) * n + j)]
        for i in range(rows - 2):
            a, b = i * n, (i + 1) * n
            triangles += [(a + j, b + j, b + k), (a + j, b + k, a + k)]
    return points, np.array(triangles)


def torus(rows=20):
    n, m = 2 * rows, rows
    u, v = np.meshgrid(2 * np.pi * np.arange(n) / n, 2 * np.pi * np.arange(m) / m, indexing="ij")
    points = np.stack([(1 + 0.45 * np.cos(v)) * np.cos(u), (1 + 0.45 * np.cos(v)) * np.sin(u), 0.45 * np.sin(v)],
                      -1).reshape(-1, 3)
    at = lambda i, j: (i % n) * m + j % m
    return points, np.array([t for i in range(n) for j in range(m)
                             for t in ((at(i, j), at(i + 1, j), at(i + 1, j + 1)),
                                       (at(i, j), at(i + 1, j + 1), at(i, j + 1)))])


def plane(rows=30, height=None):
    """A square with a boundary; height(x, y) in place of a flat one."""
    x, y = np.meshgrid(np.arange(rows + 1) / rows, np.arange(rows + 1) / rows, indexing="ij")
    z = height(x, y) if height else 0.15 * np.sin(5 * x) * np.cos(4 * y)
    points = np.stack([x, y, z], -1).reshape(-1, 3)
    at = lambda i, j: i * (rows + 1) + j
    return points, np.array([t for i in range(rows) for j in range(rows)
                             for t in ((at(i, j), at(i + 1, j), at(i + 1, j + 1)),
                                       (at(i, j), at(i + 1, j + 1), at(i, j + 1)))])


def box(rows=8):
    """A cube with sharp edges."""
    index, points, triangles = {}, [], []

    def at(p):
        if p not in index:
            index[p] = len(points)
            points.append(p)
        return index[p]
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, rows):
            for i in range(rows):
                for j in range(rows):
                    quad = []
                    for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        p = [0, 0, 0]
                        p[axis], p[u], p[v] = side, i + di, j + dj
                        quad.append(at(tuple(p)))
                    a, b, c, d = quad if side else quad[::-1]
                    triangles += [(a, b, c), (a, c, d)]
    return np.array(points, float) / rows, np.array(triangles)


def euler(triangles):
    edges = np.sort(np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    return len(np.unique(triangles)) - len(np.unique(edges, axis=0)) + len(triangles)


def stripes(points, triangles, parts):
    """The part of each face: as many in each, one beside the other along the longest side of the box."""
    axis = np.argmax(np.ptp(points, axis=0))
    order = np.argsort(points[triangles].mean(1)[:, axis], kind="stable")
    part = np.empty(len(triangles), int)
    part[order] = np.arange(len(triangles)) * parts // len(triangles)
    return part


def random_faces(points, triangles, parts, rng):
    return rng.integers(0, parts, len(triangles))


def random_blobs(points, triangles, parts, rng):
    """Faces nearest to one of some places each; a part has several places, or none."""
    seeds = points[rng.choice(len(points), rng.integers(parts, 4 * parts), replace=False)]
    of_seed = rng.integers(0, parts, len(seeds))
    centres = points[triangles].mean(1)
    nearest = np.argmin(((centres[:, None, :] - seeds[None]) ** 2).sum(-1), axis=1)
    return of_seed[nearest]


def piece(points, triangles, mine):
    """The faces of a mask, with points of their own; also the ids of points and faces in the whole."""
    chosen = triangles[mine]
    used, corners = np.unique(chosen, return_inverse=True)
    return surface(points[used], corners.reshape(-1, 3)), used, np.flatnonzero(mine)


def add(attributes, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=1)
    array.SetName(name)
    attributes.AddArray(array)
    return array


def gather(data):
    """The data of all ranks, by rank, on rank 0; elsewhere None."""
    if RANK > 0:
        CONTROLLER.Send(data, 0, TAG)
        return None
    others = []
    for rank in range(1, RANKS):
        received = data.NewInstance()
        CONTROLLER.Receive(received, rank, TAG)
        others.append(received)
    return [data] + others


class Joined:
    """The quads of all ranks as one mesh, by their global ids; raises AssertionError where they are none."""

    def __init__(self, parts):
        places, quads, owned = {}, {}, {}
        for rank, part in enumerate(parts):
            if part.GetNumberOfCells() == 0:
                continue
            ids = vtk_to_numpy(part.GetPointData().GetArray("GlobalPointIds"))
            cells = vtk_to_numpy(part.GetCellData().GetArray("GlobalCellIds"))
            ghost_points = vtk_to_numpy(part.GetPointData().GetArray("vtkGhostType"))
            ghost_array = part.GetCellData().GetArray("vtkGhostType")
            ghosts = vtk_to_numpy(ghost_array) if ghost_array else np.zeros(len(cells), int)
            where = vtk_to_numpy(part.GetPoints().GetData())
            sizes = np.diff(vtk_to_numpy(part.GetPolys().GetOffsetsArray()))
            assert (sizes == 4).all(), f"rank {rank} has cells that are no quads"
            corners = vtk_to_numpy(part.GetPolys().GetConnectivityArray()).reshape(-1, 4)
            assert len(np.unique(ids)) == len(ids), f"rank {rank} has a point twice"
            for point, place, ghost in zip(ids.tolist(), where, ghost_points):
                same = places.setdefault(point, place)
                assert (same == place).all(), f"point {point} has two places"
                if not ghost:
                    assert point not in owned, f"point {point} has two owners"
                    owned[point] = rank
            for quad, ghost, own in zip(cells.tolist(), ghosts, ids[corners].tolist()):
                if not ghost:
                    assert quad not in quads, f"quad {quad} is there twice"
                    quads[quad] = own
        assert sorted(places) == list(range(len(places))), "points are missing"
        assert sorted(owned) == list(range(len(places))), "points have no owner"
        assert sorted(quads) == list(range(len(quads))), "quads are missing"
        self.points = np.array([places[i] for i in range(len(places))])
        self.quads = np.array([quads[i] for i in range(len(quads))], dtype=int).reshape(-1, 4)

    def check_manifold(self, characteristic):
        edges = {}
        for quad in self.quads.tolist():
            for a, b in zip(quad, quad[1:] + quad[:1]):
                assert (a, b) not in edges, f"the edge from {a} to {b} is there twice"
                edges[a, b] = True
        pairs = sum((b, a) in edges for a, b in edges)
        count = len(edges) - pairs // 2
        assert len(np.unique(self.quads)) == len(self.points), "there are points of no quad"
        got = len(self.points) - count + len(self.quads)
        assert got == characteristic, f"the Euler characteristic is {got}, that of the input {characteristic}"
        fans = np.bincount(self.quads.ravel(), minlength=len(self.points))
        neighbours = {}
        for a, b in edges:
            neighbours.setdefault(a, set()).add(b)
            neighbours.setdefault(b, set()).add(a)
        for point, around in neighbours.items():  # one fan: as many edges as quads, or one more on a boundary
            assert len(around) - fans[point] in (0, 1), f"point {point} has two fans"

    def digest(self):
        return hashlib.sha1(self.points.tobytes() + self.quads.tobytes()).hexdigest()

    def sum_of_quads(self):
        """A hash of each quad's corners, summed: the same for the mesh and for its pieces together."""
        return sum(int.from_bytes(hashlib.sha1(self.points[q].tobytes()).digest()[:8], "little") for q in self.quads)


def sum_of_piece(part):
    """As Joined.sum_of_quads, of the quads of one rank that are no ghosts."""
    if part.GetNumberOfCells() == 0:
        return 0
    where = vtk_to_numpy(part.GetPoints().GetData())
    corners = vtk_to_numpy(part.GetPolys().GetConnectivityArray()).reshape(-1, 4)
    ghosts = part.GetCellData().GetArray("vtkGhostType")
    own = corners if not ghosts else corners[vtk_to_numpy(ghosts) == 0]
    return sum(int.from_bytes(hashlib.sha1(where[q].tobytes()).digest()[:8], "little") for q in own)
