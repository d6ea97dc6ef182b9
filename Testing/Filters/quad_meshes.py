# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Small meshes of quads, and a second, simple derivation of their sets, for tests of files."""
import collections
import math
import re

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

QUAD_CELLS = {4: 9, 8: 23, 9: 28}  # VTK_QUAD, VTK_QUADRATIC_QUAD, VTK_BIQUADRATIC_QUAD

Mesh = collections.namedtuple("Mesh", "points elements patch features")


# ------------------------------------------------------------------------------------------------- meshes
def grid(data):
    """A Mesh as a vtkUnstructuredGrid."""
    mesh = vtkUnstructuredGrid()
    mesh.SetPoints(vtkPoints())
    mesh.GetPoints().SetData(numpy_to_vtk(numpy.asarray(data.points, float), deep=True))
    for element in data.elements:
        mesh.InsertNextCell(QUAD_CELLS[len(element)], len(element), [int(i) for i in element])
    for name, values in (("PatchId", data.patch), ("FeatureEdges", data.features)):
        array = vtkIntArray()
        array.SetName(name)
        for value in values:
            array.InsertNextValue(int(value))
        mesh.GetCellData().AddArray(array)
    return mesh


def add_strings(attributes, name, values):
    array = vtkStringArray()
    array.SetName(name)
    for value in values:
        array.InsertNextValue(value)
    attributes.AddArray(array)


def data_of(mesh):
    """A vtkPolyData or vtkUnstructuredGrid of quads as a Mesh."""
    cells = mesh.GetPolys() if hasattr(mesh, "GetPolys") else mesh.GetCells()
    nodes = cells.GetMaxCellSize()
    elements = vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, nodes)
    cell_data = mesh.GetCellData()
    patch = cell_data.GetArray("PatchId") or cell_data.GetArray("LayoutPatch")
    return Mesh(vtk_to_numpy(mesh.GetPoints().GetData()).astype(float), elements, vtk_to_numpy(patch),
                vtk_to_numpy(cell_data.GetArray("FeatureEdges")))


def plate(columns=6, rows=4, patches=2):
    """A rectangle in the plane z = 0 with a feature between its patches, which are halves."""
    points = [(i, j, 0.0) for j in range(rows + 1) for i in range(columns + 1)]
    elements, patch, features = [], [], []
    for j in range(rows):
        for i in range(columns):
            first = j * (columns + 1) + i
            elements.append((first, first + 1, first + columns + 2, first + columns + 1))
            patch.append(1 + i * patches // columns)
            features.append(0)
    split = columns // 2
    for j in range(rows if patches > 1 else 0):
        features[j * columns + split - 1] |= 1 << 1
        features[j * columns + split] |= 1 << 3
    return Mesh(numpy.array(points), numpy.array(elements), patch, features)


def box(n=3):
    """Ten patches: the sides of a cube without its top, each but the bottom cut in two, with edges on features."""
    ids, points, elements, patch = {}, [], [], []

    def node(p):
        if p not in ids:
            ids[p] = len(points)
            points.append([x / n for x in p])
        return ids[p]

    sides = [((1, 0, 0), (0, 0, 1), (0, 0, 0)), ((0, 1, 0), (0, 0, 1), (n, 0, 0)), ((-1, 0, 0), (0, 0, 1), (n, n, 0)),
             ((0, -1, 0), (0, 0, 1), (0, n, 0)), ((0, 1, 0), (1, 0, 0), (0, 0, 0))]
    for side, (u, v, origin) in enumerate(sides):
        for j in range(n):
            for i in range(n):
                corner = [tuple(origin[k] + (i + a) * u[k] + (j + b) * v[k] for k in range(3))
                          for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                elements.append([node(p) for p in corner])
                patch.append(2 * side + (1 if i >= n // 2 else 0))
    return with_features_at_borders(numpy.array(points), numpy.array(elements), patch)


def closed_box(n=3):
    """Six patches: the sides of a cube, the fifth at its bottom, the last at its top, with features between them."""
    open_box = box(n)
    top = []
    ids = {tuple(numpy.round(p * n).astype(int)): i for i, p in enumerate(open_box.points)}
    points = list(open_box.points)
    for j in range(n):
        for i in range(n):
            corners = [(i, j, n), (i + 1, j, n), (i + 1, j + 1, n), (i, j + 1, n)]
            for p in corners:
                if p not in ids:
                    ids[p] = len(points)
                    points.append(numpy.array(p) / n)
            top.append([ids[p] for p in corners])
    elements = numpy.concatenate([open_box.elements, top])
    return with_features_at_borders(numpy.array(points), elements, [e // (n * n) for e in range(len(elements))])


def plate_with_hole(n=6):
    """A square with a square hole of two elements in its middle: two boundary loops; two patches."""
    whole = plate(n, n)
    kept = [e for e, element in enumerate(whole.elements)
            if abs(whole.points[element].mean(axis=0)[:2] - n / 2).max() > 1]
    nodes = sorted({int(i) for i in whole.elements[kept].ravel()})
    place = {node: i for i, node in enumerate(nodes)}
    return Mesh(whole.points[nodes], numpy.array([[place[int(i)] for i in whole.elements[e]] for e in kept]),
                [whole.patch[e] for e in kept], [whole.features[e] for e in kept])


def with_features_at_borders(points, elements, patch):
    seen = collections.defaultdict(set)
    for e, element in enumerate(elements):
        for i in range(4):
            seen[frozenset((element[i], element[(i + 1) % 4]))].add(patch[e])
    features = [sum((len(seen[frozenset((element[i], element[(i + 1) % 4]))]) > 1) << i for i in range(4))
                for element in elements]
    return Mesh(points, elements, patch, features)


def second_order(data, nodes):
    """Straight edges get their middles, and for 9 nodes elements their centres."""
    points, middles, elements = [list(p) for p in data.points], {}, []

    def add(ids):
        points.append(numpy.mean([data.points[i] for i in ids], axis=0))
        return len(points) - 1

    for element in data.elements:
        element = list(element)
        for i in range(4):
            edge = frozenset((element[i], element[(i + 1) % 4]))
            if edge not in middles:
                middles[edge] = add(edge)
            element.append(middles[edge])
        if nodes == 9:
            element.append(add(element[:4]))
        elements.append(element)
    return Mesh(numpy.array(points), numpy.array(elements), data.patch, data.features)


# ------------------------------------------------------------------------------------------------- a second derivation
class Sets:
    """Node sets and sides of loops, curves and corners; elements of patches. Written for being simple: sets of edges,
    put together by their ends."""

    def __init__(self, data, names=None):
        edges, middle = collections.defaultdict(list), {}
        for e, element in enumerate(data.elements):
            for i in range(4):
                edge = frozenset((int(element[i]), int(element[(i + 1) % 4])))
                edges[edge].append((e, i))
                middle[edge] = int(element[4 + i]) if len(element) > 4 else None
        boundary = {edge for edge, sides in edges.items() if len(sides) == 1}
        feature = {edge for edge, sides in edges.items() if len(sides) > 1
                   and any(int(data.features[e]) >> i & 1 for e, i in sides)}
        around = collections.defaultdict(int)
        for element in data.elements:
            for node in element[:4]:
                around[int(node)] += 1
        at = collections.defaultdict(list)
        for edge in boundary | feature:
            for node in edge:
                at[node].append(edge)
        self.edges, self.middle = edges, middle
        self.corners = {node for node, there in at.items()
                        if len(there) != 2 or self._is_corner(data, node, there, boundary, around)}
        self.loops = self._components(boundary, cut=set())
        self.curves = self._components(feature, cut=self.corners)
        self.patches = collections.defaultdict(set)
        for e, patch in enumerate(data.patch):
            name = (names or {}).get(int(patch)) or f"PATCH_{patch}"
            self.patches[name].add(e)

    def _is_corner(self, data, node, there, boundary, around):
        a, b = (next(iter(edge - {node})) for edge in there)
        first, second = data.points[node] - data.points[a], data.points[b] - data.points[node]
        angle = math.atan2(numpy.linalg.norm(numpy.cross(first, second)), first @ second)
        if angle <= math.radians(40):
            return False
        if there[0] in boundary:
            return around[node] != 2
        # Straight on: of the four elements at an inner node none is beside both edges.
        beside = [{e for e, _ in self.edges[edge]} for edge in there]
        return around[node] != 4 or bool(beside[0] & beside[1])

    @staticmethod
    def _components(edges, cut):
        left, result = set(edges), []
        ends = collections.defaultdict(set)
        for edge in edges:
            for node in edge:
                ends[node].add(edge)
        while left:
            component, todo = set(), [left.pop()]
            while todo:
                edge = todo.pop()
                component.add(edge)
                for node in edge - frozenset(cut):
                    todo += [other for other in ends[node] if other in left]
                    left -= ends[node]
            result.append(frozenset(component))
        return result

    def nodes(self, component):
        inner = {self.middle[edge] for edge in component} - {None}
        return frozenset(node for edge in component for node in edge) | frozenset(inner)

    def node_sets(self):
        """Without the names, which depend on an order: kinds with the sets of nodes."""
        return {"BOUNDARY": sorted(sorted(self.nodes(c)) for c in self.loops),
                "CURVE": sorted(sorted(self.nodes(c)) for c in self.curves),
                "CORNER": sorted([node] for node in self.corners)}

    def side_sets(self):
        return {"BOUNDARY": sorted(sorted(c, key=sorted) for c in self.loops),
                "CURVE": sorted((sorted(c, key=sorted) for c in self.curves), key=lambda c: [sorted(e) for e in c])}


def by_kind(named):
    """Sets with names like CURVE_3 as Sets.node_sets has them."""
    found = {"BOUNDARY": [], "CURVE": [], "CORNER": []}
    numbers = collections.defaultdict(list)
    for name, nodes in named.items():
        kind, number = re.fullmatch(r"(BOUNDARY|CURVE|CORNER)_(\d+)", name).groups()
        found[kind].append(sorted(int(i) for i in nodes))
        numbers[kind].append(int(number))
    for kind, those in numbers.items():
        assert sorted(those) == list(range(1, len(those) + 1)), (kind, those)
    return {kind: sorted(sets) for kind, sets in found.items()}
