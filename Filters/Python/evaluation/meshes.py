# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Any mesh of quads, or mostly of quads, by whatever made it: topology, irregular vertices, shape, distance."""
import dataclasses
import math
import os

import numpy
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkCommonDataModel import VTK_POLYGON, VTK_QUAD, VTK_TRIANGLE
from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance, vtkTriangleFilter

import quadrille

from . import features, layout

#: Places on each surface that distances are taken at.
SAMPLES = 20000
#: Corners of a face that a file of Gmsh has, by its type of element; others are no faces.
GMSH_FACES = {2: 3, 3: 4}


@dataclasses.dataclass
class Mesh:
    """points: n by 3. corners: of all faces, one after the other. first: where each face begins, and the end."""
    points: numpy.ndarray
    corners: numpy.ndarray
    first: numpy.ndarray

    @property
    def sizes(self):
        return numpy.diff(self.first)

    @property
    def half_edges(self):
        """(from, to) of each corner along its face."""
        after = numpy.arange(1, len(self.corners) + 1)
        after[self.first[1:] - 1] = self.first[:-1]
        return self.corners, self.corners[after]

    def of_size(self, size):
        """Corners of the faces with so many of them, a row each."""
        starts = self.first[:-1][self.sizes == size]
        return self.corners[starts[:, None] + numpy.arange(size)]


def _from_faces(points, faces):
    sizes = [len(face) for face in faces]
    return Mesh(numpy.asarray(points, dtype=float).reshape(-1, 3),
                numpy.array([corner for face in faces for corner in face], dtype=numpy.int64),
                numpy.concatenate([[0], numpy.cumsum(sizes)]).astype(numpy.int64))


def _gmsh_sections(lines):
    """The lines between $Name and $EndName, by name."""
    sections, name = {}, None
    for line in lines:
        line = line.strip()
        if line.startswith("$End"):
            name = None
        elif line.startswith("$"):
            name = line[1:]
            sections[name] = []
        elif name is not None and line:
            sections[name].append(line.split())
    return sections


def _read_gmsh(path):
    """Points and faces of a text file of Gmsh, version 2.2 or 4.1 (Gmsh 4.8 manual, Section 9)."""
    with open(path, encoding="utf-8", errors="replace") as file:
        sections = _gmsh_sections(file)
    try:
        version, binary = sections["MeshFormat"][0][:2]
        nodes, elements = sections["Nodes"], sections["Elements"]
        if int(binary) != 0:
            raise quadrille.InvalidInput(f"{path}: binary files of Gmsh are not read here; save it as text")
        points, faces = {}, []
        if version.startswith("2"):
            for row in nodes[1:]:
                points[int(row[0])] = [float(x) for x in row[1:4]]
            for row in elements[1:]:
                if int(row[1]) in GMSH_FACES:
                    faces.append([int(tag) for tag in row[3 + int(row[2]):]])
        elif version.startswith("4.1"):
            row = 1
            for _ in range(int(nodes[0][0])):
                count = int(nodes[row][3])
                for k in range(count):
                    points[int(nodes[row + 1 + k][0])] = [float(x) for x in nodes[row + 1 + count + k][:3]]
                row += 1 + 2 * count
            row = 1
            for _ in range(int(elements[0][0])):
                kind, count = int(elements[row][2]), int(elements[row][3])
                if kind in GMSH_FACES:
                    faces += [[int(tag) for tag in each[1:]] for each in elements[row + 1:row + 1 + count]]
                row += 1 + count
        else:
            raise quadrille.InvalidInput(f"{path}: version {version} of Gmsh's files is not read here; known are 2.2 "
                                         "and 4.1")
        used = sorted({tag for face in faces for tag in face})
        place = {tag: i for i, tag in enumerate(used)}
        missing = [tag for tag in used if tag not in points]
        if missing:
            raise quadrille.InvalidInput(f"{path}: faces have the node {missing[0]}, which the file does not have")
        return _from_faces([points[tag] for tag in used], [[place[tag] for tag in face] for face in faces])
    except quadrille.InvalidInput:
        raise
    except (KeyError, IndexError, ValueError) as error:
        raise quadrille.InvalidInput(f"{path}: damaged file of Gmsh ({error})") from error


def from_poly_data(data):
    """The polygons of a vtkPolyData."""
    polys = data.GetPolys()
    return Mesh(vtk_to_numpy(data.GetPoints().GetData()).astype(float),
                vtk_to_numpy(polys.GetConnectivityArray()).astype(numpy.int64),
                vtk_to_numpy(polys.GetOffsetsArray()).astype(numpy.int64))


def _read_grid(path):
    """Faces of an unstructured grid in VTK's XML format."""
    import vtkmodules.vtkIOXML  # noqa: F401, so that Python knows the class of the reader

    from quadrille.QuadrilleFilters import vtkQuadrilleFileReader

    if not os.path.isfile(path):
        raise quadrille.InvalidInput(f"{path}: there is no such file")
    reader = vtkQuadrilleFileReader.NewXMLReader(".vtu")
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    if grid.GetNumberOfCells() == 0:
        raise quadrille.InvalidInput(f"{path}: it has no cells, or is no file of an unstructured grid")
    kinds = vtk_to_numpy(grid.GetCellTypesArray())
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    first = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    faces = [corners[first[i]:first[i + 1]] for i in
             numpy.flatnonzero(numpy.isin(kinds, (VTK_TRIANGLE, VTK_QUAD, VTK_POLYGON)))]
    return _from_faces(vtk_to_numpy(grid.GetPoints().GetData()), faces)


def read(path):
    """The faces of a mesh in a file: .obj, .off, .ply, .stl, .vtp, .vtk, .vtu or .msh (Gmsh, text). Raises InvalidInput
    where it is missing, damaged or has no faces."""
    extension = os.path.splitext(path)[1].lower()
    if extension == ".msh":
        if not os.path.isfile(path):
            raise quadrille.InvalidInput(f"{path}: there is no such file")
        mesh = _read_gmsh(path)
    elif extension == ".vtu":
        mesh = _read_grid(path)
    else:
        mesh = from_poly_data(quadrille.read(path))
    if len(mesh.sizes) == 0:
        raise quadrille.InvalidInput(f"{path}: the mesh has no faces")
    if not numpy.isfinite(mesh.points).all():
        raise quadrille.InvalidInput(f"{path}: a coordinate is not a finite number")
    return mesh


def _joined(mesh):
    """The same with points at one place joined, and those left out that no face uses."""
    used, corners = numpy.unique(mesh.corners, return_inverse=True)
    points, names = numpy.unique(mesh.points[used], axis=0, return_inverse=True)
    return Mesh(points, names.ravel()[corners], mesh.first)


def _topology(mesh, result):
    """Counts, and per point the number of its faces and whether it is on a boundary."""
    tail, head = mesh.half_edges
    low, high = numpy.minimum(tail, head), numpy.maximum(tail, head)
    keys, edge, uses = numpy.unique(low * len(mesh.points) + high, return_inverse=True, return_counts=True)
    forward = numpy.bincount(edge, weights=tail < head, minlength=len(keys))
    boundary = uses == 1
    turned = (uses == 2) & (forward != 1)
    ends = numpy.stack([keys // len(mesh.points), keys % len(mesh.points)], axis=1)
    on_boundary = numpy.zeros(len(mesh.points), dtype=bool)
    on_boundary[ends[boundary].ravel()] = True
    graph = coo_matrix((numpy.ones(len(keys)), (ends[:, 0], ends[:, 1])), shape=(len(mesh.points),) * 2)
    loops = coo_matrix((numpy.ones(boundary.sum()), tuple(ends[boundary].T)), shape=(len(mesh.points),) * 2)
    labels = connected_components(loops, directed=False)[1]
    result.update(
        components=int(connected_components(graph, directed=False)[0]),
        boundary_loops=len(numpy.unique(labels[on_boundary])),
        euler=len(mesh.points) - len(keys) + len(mesh.sizes),
        non_manifold_edges=int((uses > 2).sum()), turned_edges=int(turned.sum()))
    return numpy.bincount(mesh.corners, minlength=len(mesh.points)), on_boundary


def _angles(corners):
    """Angles of polygons, n by k by 3 points, in degrees."""
    out = numpy.roll(corners, -1, axis=1) - corners
    back = numpy.roll(corners, 1, axis=1) - corners
    cross = numpy.linalg.norm(numpy.cross(out, back), axis=2)
    return numpy.degrees(numpy.arctan2(cross, (out * back).sum(axis=2)))


def _scaled_jacobians(corners):
    """The least of a quad's four, each against the normal of the quad, the mean of those at its corners, as Verdict."""
    out = numpy.roll(corners, -1, axis=1) - corners
    back = numpy.roll(corners, 1, axis=1) - corners
    cross = numpy.cross(out, back)
    normal = cross.sum(axis=1)
    normal /= numpy.maximum(numpy.linalg.norm(normal, axis=1), 1e-300)[:, None]
    lengths = numpy.linalg.norm(out, axis=2) * numpy.linalg.norm(back, axis=2)
    return ((cross * normal[:, None]).sum(axis=2) / numpy.maximum(lengths, 1e-300)).min(axis=1)


def _shape(mesh, result):
    quads = mesh.points[mesh.of_size(4)]
    if len(quads):
        jacobians, angles = _scaled_jacobians(quads), _angles(quads)
        result.update(sj_mean=float(jacobians.mean()), sj_least=float(jacobians.min()),
                      sj_not_positive=int((jacobians <= 0).sum()), angle_mean=float(angles.min(axis=1).mean()),
                      angle_5=float(numpy.percentile(angles.min(axis=1), 5)), angle_largest=float(angles.max()))
    tail, head = mesh.half_edges
    lengths = numpy.linalg.norm(mesh.points[tail] - mesh.points[head], axis=1)
    result.update(edge_mean=float(lengths.mean()), edge_cv=float(lengths.std() / lengths.mean()))


def _samples(poly_data, count, seed=1):
    """Points of a triangle mesh, evenly over its area."""
    corners = vtk_to_numpy(poly_data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    points = vtk_to_numpy(poly_data.GetPoints().GetData()).astype(float)[corners]
    areas = numpy.linalg.norm(numpy.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]), axis=1)
    random = numpy.random.default_rng(seed)
    chosen = random.choice(len(areas), count, p=areas / areas.sum())
    u, v = random.random((2, count))
    over = u + v > 1
    u[over], v[over] = 1 - u[over], 1 - v[over]
    a, b, c = points[chosen].transpose(1, 0, 2)
    return a + u[:, None] * (b - a) + v[:, None] * (c - a)


def _triangles(mesh):
    faces = numpy.split(mesh.corners, mesh.first[1:-1])
    data = quadrille.to_polydata(mesh.points, [face.tolist() for face in faces])
    cut = vtkTriangleFilter()
    cut.SetInputData(data)
    cut.PassVertsOff()
    cut.PassLinesOff()
    cut.Update()
    return cut.GetOutput()


def _distances(points, surface):
    implicit = vtkImplicitPolyDataDistance()
    implicit.SetInput(surface)
    values = vtkDoubleArray()
    implicit.FunctionValue(numpy_to_vtk(numpy.ascontiguousarray(points), deep=True), values)
    return numpy.abs(vtk_to_numpy(values))


def _distance(mesh, surface, result):
    """Both ways, over the diagonal of the surface, in percent."""
    ours, theirs = _triangles(mesh), _triangles(surface)
    diagonal = float(numpy.linalg.norm(surface.points.max(axis=0) - surface.points.min(axis=0)))
    there = _distances(_samples(ours, SAMPLES), theirs)
    back = _distances(_samples(theirs, SAMPLES), ours)
    result.update(distance_mean=50 * (there.mean() + back.mean()) / diagonal,
                  distance_largest=100 * max(there.max(), back.max()) / diagonal)
    sharp = features.deviation(_joined(from_poly_data(theirs)), mesh)
    if sharp is not None:
        result.update(feature_mean=100 * sharp[0] / diagonal, feature_largest=100 * sharp[1] / diagonal,
                      feature_share=sharp[2])


def measure(mesh, surface=None):
    """All that can be said of a mesh, as a dictionary of numbers; where there is a surface, also a Mesh, distances, and
    those of its sharp edges from the edges of the mesh. Points at one place count as one. Scaled Jacobians and angles
    are of the quads alone; `other_faces` is the rest. `patches`: of the base complex, of meshes of quads only."""
    mesh = _joined(mesh)
    result = {"faces": len(mesh.sizes), "quads": int((mesh.sizes == 4).sum())}
    result["other_faces"] = result["faces"] - result["quads"]
    faces_at, on_boundary = _topology(mesh, result)
    valences, counts = numpy.unique(faces_at[~on_boundary], return_counts=True)
    result["valences"] = {int(v): int(n) for v, n in zip(valences, counts)}
    result["irregular"] = int(counts[valences != 4].sum())
    result["irregular_boundary"] = int((faces_at[on_boundary] != 2).sum())
    patches = layout.patches(mesh)
    if patches is not None:
        result["patches"] = patches
    _shape(mesh, result)
    if surface is not None:
        _distance(mesh, _joined(surface), result)
    return {key: value if not isinstance(value, float) or math.isfinite(value) else None
            for key, value in result.items()}
