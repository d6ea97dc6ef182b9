# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""quadrille.remesh with what Python has: arrays, lists, data sets, and what is wrong with them."""
import math
import os
import tempfile
import unittest

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_HEXAHEDRON, vtkImageData, vtkMultiBlockDataSet, vtkPolyData, vtkUnstructuredGrid)
from vtkmodules.vtkFiltersModeling import vtkLinearSubdivisionFilter
from vtkmodules.vtkFiltersSources import vtkPlatonicSolidSource, vtkSphereSource
from vtkmodules.vtkIOGeometry import vtkSTLReader, vtkSTLWriter
from vtkmodules.vtkIOPLY import vtkPLYReader

import quadrille


def plate(columns=24, rows=16):
    """A flat plate of triangles, one unit a square."""
    x, y = numpy.meshgrid(numpy.arange(columns + 1.0), numpy.arange(rows + 1.0))
    points = numpy.stack((x.ravel(), y.ravel(), numpy.zeros(x.size)), axis=1)
    corner = (numpy.arange(rows)[:, None] * (columns + 1) + numpy.arange(columns)).ravel()
    up = columns + 1
    faces = numpy.concatenate((numpy.stack((corner, corner + 1, corner + up + 1), axis=1),
                               numpy.stack((corner, corner + up + 1, corner + up), axis=1)))
    return points, faces


def box(low, high):
    """Of two triangles a side."""
    (a, b, c), (d, e, f) = low, high
    points = numpy.array([(x, y, z) for z in (c, f) for y in (b, e) for x in (a, d)], dtype=float)
    sides = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return points, numpy.array([t for p, q, r, s in sides for t in ((p, q, r), (p, r, s))])


def thin_ring(around=600, across=24, radius=0.0102):
    """A torus, whose tube a quad of 5,000 goes round by more than 45 degrees."""
    u, v = numpy.meshgrid(2 * math.pi * numpy.arange(around) / around, 2 * math.pi * numpy.arange(across) / across,
                          indexing="ij")
    r = 1 + radius * numpy.cos(v)
    points = numpy.stack([r * numpy.cos(u), r * numpy.sin(u), radius * numpy.sin(v)], axis=-1).reshape(-1, 3)
    i, j = numpy.meshgrid(numpy.arange(around), numpy.arange(across), indexing="ij")
    a, b = across * i + j, across * ((i + 1) % around) + j
    c, d = across * ((i + 1) % around) + (j + 1) % across, across * i + (j + 1) % across
    return points, numpy.concatenate([numpy.stack(t, axis=-1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])


def hexahedra():
    """Two hexahedra side by side."""
    grid = vtkUnstructuredGrid()
    points = vtkPoints()
    for z in range(2):
        for y in range(2):
            for x in range(3):
                points.InsertNextPoint(x, y, z)
    grid.SetPoints(points)
    for x in range(2):
        grid.InsertNextCell(VTK_HEXAHEDRON, 8, [x, x + 1, x + 4, x + 3, x + 6, x + 7, x + 10, x + 9])
    return grid


def sphere_without_room(count=3, angle=0.85):
    """Points and faces of a sphere, and connections that all cross each other at its pole, where quads have edges in
    two directions only: of some 80 quads no map has all of them while other irregular vertices stay. angle: from the
    pole to their ends."""
    source = vtkPlatonicSolidSource()
    source.SetSolidTypeToIcosahedron()
    finer = vtkLinearSubdivisionFilter()
    finer.SetNumberOfSubdivisions(3)
    finer.SetInputConnection(source.GetOutputPort())
    finer.Update()
    points, faces = quadrille.to_arrays(finer.GetOutput())
    points = points / numpy.linalg.norm(points, axis=1, keepdims=True)

    def end(side, around):
        beside = side * math.sin(angle)
        place = [beside * math.cos(around), beside * math.sin(around), math.cos(angle)]
        return points[numpy.argmin(((points - place) ** 2).sum(axis=1))]

    return points, faces, [[end(side, math.pi * k / count) for side in (-1, 1)] for k in range(count)]


class Stops(unittest.TestCase):
    def test_a_stop_keeps_the_quads_so_far(self):
        points, faces, connections = sphere_without_room()

        def until_second(fraction, text):
            return not text.startswith("Attempt 2 of at most ")

        quads = quadrille.remesh((points, faces), quads=80, connections=connections, progress=until_second)
        self.assertGreater(len(quadrille.to_arrays(quads)[1]), 50)
        self.assertTrue(quadrille.info(quads)["Stopped"].startswith("Attempt 2 of at most "))
        whole = quadrille.remesh((points, faces), quads=80, connections=connections)
        self.assertNotIn("Stopped", quadrille.info(whole))

    def test_a_stop_before_there_are_any_is_an_error(self):
        points, faces = plate()
        with self.assertRaisesRegex(quadrille.RemeshError, "stopped"):
            quadrille.remesh((points, faces), quads=150, progress=lambda fraction, text: False)


class Mesh(unittest.TestCase):
    def setUp(self):
        self.points, self.faces = plate()
        self.expected = quadrille.to_arrays(quadrille.remesh((self.points, self.faces), quads=150))

    def assertSame(self, points, faces):
        found = quadrille.to_arrays(quadrille.remesh((points, faces), quads=150))
        numpy.testing.assert_array_equal(found[0], self.expected[0])
        numpy.testing.assert_array_equal(found[1], self.expected[1])

    def assertRefused(self, words, *args, **options):
        with self.assertRaises(quadrille.InvalidInput) as caught:
            quadrille.remesh(*args, **options)
        for word in words:
            self.assertIn(word, str(caught.exception))

    def test_every_form_of_the_same_mesh(self):
        self.assertSame(self.points.tolist(), self.faces.tolist())
        self.assertSame(self.points, [tuple(face) for face in self.faces.tolist()])
        self.assertSame(self.points, self.faces.astype(numpy.float64))
        self.assertSame(self.points, self.faces.astype(numpy.uint32))
        counted = numpy.insert(self.faces, 0, 3, axis=1)
        self.assertSame(self.points, counted)           # as VTK: 3, a, b, c
        self.assertSame(self.points, counted.tolist())
        if counted.size % 3:
            self.assertSame(self.points, counted.ravel())
        self.assertSame(self.points, numpy.asfortranarray(self.faces))

        class Trimesh:
            vertices, faces = self.points, self.faces
        found = quadrille.to_arrays(quadrille.remesh(Trimesh(), quads=150))
        numpy.testing.assert_array_equal(found[0], self.expected[0])

    def test_flat_faces_with_counts_as_pyvista_has_them(self):
        points, faces = plate(5, 5)  # 50 triangles: 200 numbers, which are no multiple of 3
        flat = numpy.insert(faces, 0, 3, axis=1).ravel()
        self.assertEqual(flat.size % 3, 2)
        quads = quadrille.remesh((points, flat), quads=25)
        self.assertGreater(quads.GetNumberOfCells(), 0)

    def test_quads_are_quads(self):
        corner = (numpy.arange(16)[:, None] * 25 + numpy.arange(24)).ravel()
        quads = numpy.stack((corner, corner + 1, corner + 26, corner + 25), axis=1)
        self.assertGreater(quadrille.remesh((self.points, quads), quads=100).GetNumberOfCells(), 50)
        mixed = (quads[:10].tolist() + [q[:3] for q in quads[10:].tolist()]
                 + [[q[0], q[2], q[3]] for q in quads[10:].tolist()])
        self.assertGreater(quadrille.remesh((self.points, mixed), quads=100).GetNumberOfCells(), 50)

    def test_faces_that_could_be_two_things(self):
        # Two faces that begin with 3 and name it nowhere else: quads round point 3, or triangles.
        points = numpy.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [-1, 1, 0]], dtype=float)
        self.assertRefused(["begins with 3", "faces[:, 1:]"], (points, numpy.array([[3, 0, 1, 2], [3, 4, 0, 2]])),
                           quads=4)

    def test_what_is_wrong_with_faces(self):
        p, f = self.points, self.faces
        self.assertRefused(["flat array", "reshape(-1, 3)"], (p, f.ravel()), quads=9)
        self.assertRefused(["face 7", "point 9999", "0 to 424"],
                           (p, numpy.where(numpy.arange(len(f))[:, None] == 7, 9999, f)), quads=9)
        self.assertRefused(["begin at 1", "subtract 1"], (p, f + 1), quads=9)
        self.assertRefused(["names point -1"], (p, numpy.where(f == 0, -1, f)), quads=9)
        self.assertRefused(["whole numbers", "0.5"], (p, f + 0.5), quads=9)
        self.assertRefused(["no faces"], (p, numpy.zeros((0, 3), int)), quads=9)
        self.assertRefused(["no faces"], (p, []), quads=9)
        self.assertRefused(["2 corners"], (p, f[:, :2]), quads=9)
        self.assertRefused(["face 1 has 2 corners"], (p, [[0, 1, 26], [0, 1]]), quads=9)
        self.assertRefused(["numbers only"], (p, [["a", "b", "c"]]), quads=9)

    def test_what_is_wrong_with_points(self):
        p, f = self.points, self.faces
        self.assertRefused(["points", "reshape(-1, 3)"], (p.ravel(), f), quads=9)
        self.assertRefused(["column of zeros"], (p[:, :2], f), quads=9)
        self.assertRefused(["point 17", "finite"], (numpy.where(numpy.arange(len(p))[:, None] == 17, math.nan, p), f),
                           quads=9)
        self.assertRefused(["numbers only"], ([["a", "b", "c"]], f), quads=9)
        self.assertRefused(["different lengths"], ([[0, 0, 0], [1, 0]], f), quads=9)

    def test_what_is_no_mesh(self):
        self.assertRefused(["name of a file", "read"], "part.ply", quads=9)
        self.assertRefused(["int"], 42, quads=9)
        self.assertRefused(["NoneType"], None, quads=9)
        self.assertRefused(["Update()", "GetOutput()"], vtkSphereSource(), quads=9)
        self.assertRefused(["blocks"], vtkMultiBlockDataSet(), quads=9)

    def test_volumes_give_their_surface(self):
        quads = quadrille.remesh(hexahedra(), quads=100)
        self.assertEqual(quads.GetBounds(), (0, 2, 0, 1, 0, 1))
        image = vtkImageData()
        image.SetDimensions(4, 4, 4)
        self.assertGreater(quadrille.remesh(image, quads=60).GetNumberOfCells(), 40)
        self.assertRefused(["no surface"], vtkUnstructuredGrid(), quads=9)

    def test_cells_of_parts_that_touch(self):
        """Each quad has the number of its own part, also where another part lies on it."""
        parts = [box((0, 0, 0), (9, 7, 1)), box((1, 2, 1), (8, 4, 2))]
        turned = numpy.linalg.qr(numpy.random.default_rng(7).normal(size=(3, 3)))[0]
        for turn in (numpy.eye(3), turned):
            for order in (1, -1):
                mesh = quadrille.to_polydata(numpy.concatenate([points for points, _ in parts]) @ turn.T,
                                             numpy.concatenate((parts[0][1], parts[1][1] + 8))[:, ::order])
                number = numpy_to_vtk(numpy.repeat([0, 1], 12).astype(numpy.int32), deep=True)
                number.SetName("Part")
                mesh.GetCellData().AddArray(number)
                quads = quadrille.remesh(mesh, quads=1500)
                points, faces = quadrille.to_arrays(quads)
                found = vtk_to_numpy(quads.GetCellData().GetArray("Part"))
                for part in (0, 1):
                    # Points of the two are apart, so that each has its own.
                    own, other = (numpy.unique(faces[found == k]) for k in (part, 1 - part))
                    self.assertEqual(len(numpy.intersect1d(own, other)), 0)

    def test_numbers(self):
        mesh = (self.points, self.faces)
        for name, values in {
                "quads": (0, -5, 2.5, math.nan, math.inf, "100", True, 10**12),
                "edge_length": (0, -1, math.nan, math.inf, "1"),
                "relative_edge_length": (0, -1, 1.5, math.nan),
                "feature_angle": (0, -40, 181, math.nan, "40"),
                "coarse_vertices": (-3, 3, 2.5, math.nan),
                "threads": (-1, 1.5),
                "maximum_number_of_quads": (0, -1),
                "smoothing_steps": (-1, 0.5),
                "memory_limit": (-1, math.nan),
                "time_limit": (-1, math.nan),
                "smallest_detail": (-1, math.inf),
                "anisotropy_limit": (-1, 0.5, math.nan),
                "method": ("best", 0), "final_quality": ("finest",), "integers": ("few",), "cell_data": ("best",),
                "small_components": ("shrink",), "small_details": ("ignore", 1),
                "feature_criterion": ("sharp", 0)}.items():
            for value in values:
                with self.subTest(name=name, value=value):
                    self.assertRefused([name, repr(value) if not isinstance(value, float) else str(value)], mesh,
                                       **{name: value})
        self.assertRefused(["only one", "quads", "edge_length"], mesh, quads=100, edge_length=1)
        made = quadrille.remesh(mesh, quads=100.0, coarse_vertices=0, feature_angle=None)
        self.assertGreater(made.GetNumberOfCells(), 0)

    def test_symmetry(self):
        box = (numpy.array([(x, y, z) for x in (0, 1) for y in (0, 2) for z in (0, 3)], float),
               [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
        for symmetry, axis in (((0.5, 1, 1.5), (0, -2, 0)), 1), ("found", None):
            quads = quadrille.remesh(box, quads=200, symmetry=symmetry)
            points, faces = quadrille.to_arrays(quads)
            image = vtk_to_numpy(quads.GetPointData().GetArray("MirrorPoint"))
            self.assertTrue((image[image] == numpy.arange(len(points))).all())
            as_sets = {frozenset(face) for face in faces.tolist()}
            self.assertEqual({frozenset(face) for face in image[faces].tolist()}, as_sets)
            told = quadrille.info(quads)
            axis = numpy.argmax(numpy.abs(told["SymmetryNormal"])) if axis is None else axis
            mirrored = points.copy()
            mirrored[:, axis] = 2 * told["SymmetryOrigin"][axis] - mirrored[:, axis]
            self.assertLess(numpy.abs(mirrored - points[image]).max(), 1e-11)
        for symmetry in ("x", 3, ((0, 0, 0), (0, 0)), ((0, 0, 0), (0, 0, math.nan)), ((0, 0, 0),)):
            self.assertRefused(["symmetry"], box, symmetry=symmetry)
        self.assertRefused(["normal", "mirror plane"], box, symmetry=((0.5, 1, 1.5), (0, 0, 0)))
        self.assertRefused(["not symmetric"], box, symmetry=((0.9, 1, 1.5), (1, 0, 0)))

    def test_mid_line(self):
        box = (numpy.array([(x, y, z) for x in (0, 1) for y in (0, 2) for z in (0, 3)], float),
               [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
        plane = ((0.5, 1, 1.5), (0, -2, 0))
        quads = quadrille.remesh(box, quads=200, symmetry=plane, plane_curve="mid-line")
        points, faces = quadrille.to_arrays(quads)
        image = vtk_to_numpy(quads.GetPointData().GetArray("MirrorPoint"))
        self.assertTrue((image[image] == numpy.arange(len(points))).all())
        self.assertFalse((image == numpy.arange(len(points))).any())
        as_sets = {frozenset(face) for face in faces.tolist()}
        self.assertEqual({frozenset(face) for face in image[faces].tolist()}, as_sets)
        self.assertLess(numpy.abs(points * (1, -1, 1) + (0, 2, 0) - points[image]).max(), 1e-11)
        # A strip round the box, with two corners on each side; it is 8 round, of quads about as long as wide.
        across = [face for face in faces if frozenset(image[face]) == frozenset(face)]
        sides = numpy.sign(points[across][:, :, 1] - 1)
        self.assertTrue((numpy.abs(sides).sum(axis=1) == 4).all() and (sides.sum(axis=1) == 0).all())
        width = numpy.median(2 * numpy.abs(points[across][:, :, 1] - 1))
        self.assertAlmostEqual(width * len(across) / 8, 1, delta=0.3)
        isoline = quadrille.remesh(box, quads=200, symmetry=plane, plane_curve="isoline")
        plain = quadrille.remesh(box, quads=200, symmetry=plane)
        for made, same in zip(quadrille.to_arrays(isoline), quadrille.to_arrays(plain)):
            numpy.testing.assert_array_equal(made, same)
        self.assertRefused(["plane_curve"], box, symmetry=plane, plane_curve="edges")
        self.assertRefused(["plane_curve", "symmetry"], box, plane_curve="mid-line")
        self.assertRefused(["plane_curve", "mirror plane"], box, rotation=4, plane_curve="mid-line")
        # A tip in the plane where two sharp edges of each side end.
        tip = ([(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0), (0, 0, 1.5)],
               [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
        self.assertRefused(["several features", "isoline"], tip, symmetry=((0, 0, 0), (1, 0, 0)),
                           plane_curve="mid-line")

    def test_rotation(self):
        box = (numpy.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 3)], float),
               [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
        for rotation in ((4, (0.5, 0.5, 0), (0, 0, 1)), 4, (2, (0.5, 0.5, 0), (0, 0, -2))):
            quads = quadrille.remesh(box, quads=300, rotation=rotation)
            points, faces = quadrille.to_arrays(quads)
            image = vtk_to_numpy(quads.GetPointData().GetArray("RotatedPoint"))
            told = quadrille.info(quads)
            order = int(told["SymmetryOrder"])
            power = numpy.arange(len(points))
            for _ in range(order):
                power = image[power]
            numpy.testing.assert_array_equal(power, numpy.arange(len(points)))
            as_sets = {frozenset(face) for face in faces.tolist()}
            self.assertEqual({frozenset(face) for face in image[faces].tolist()}, as_sets)
            angle = 2 * math.pi / order * numpy.sign(told["SymmetryDirection"][2])
            c, s = math.cos(angle), math.sin(angle)
            turn = numpy.array([(c, -s, 0), (s, c, 0), (0, 0, 1)])
            middle = numpy.array((0.5, 0.5, 0))
            self.assertLess(numpy.abs((points - middle) @ turn.T + middle - points[image]).max(), 1e-11)
        for rotation in ("x", 1, 65, (3, (0, 0, 0)), (3, (0, 0, 0), (0, 0)), (3, (0, 0, 0), (0, 0, math.nan))):
            self.assertRefused(["rotation"], box, rotation=rotation)
        self.assertRefused(["direction", "axis"], box, rotation=(4, (0.5, 0.5, 0), (0, 0, 0)))
        self.assertRefused(["not symmetric"], box, rotation=(4, (0.5, 0.5, 1.5), (0, 1, 0)))
        self.assertRefused(["one symmetry"], box, rotation=4, symmetry="found")

    def test_the_default_is_a_number_of_quads(self):
        result = quadrille.remesh((self.points, self.faces))
        self.assertEqual(quadrille.info(result)["TargetQuads"], 5000)

    def test_the_default_grows_where_shapes_would_melt(self):
        ring = thin_ring()
        for number in ({}, {"quads": "automatic"}, {"symmetry": "found"}):
            told = quadrille.info(quadrille.remesh(ring, threads=1, **number))
            self.assertEqual(told["TargetQuads"], 7000)
            self.assertTrue(any("7000 quads are asked for, as nobody" in notice for notice in told["Notices"]))
        self.assertEqual(quadrille.info(quadrille.remesh(ring, quads=5000, threads=1))["TargetQuads"], 5000)
        self.assertRefused(["quads", "automatic"], ring, quads=0)
        self.assertRefused(["quads", "automatic"], ring, quads="many")
        session = quadrille.Session(ring, threads=1)
        self.assertTrue(any("7000 quads are asked for" in notice for notice in session.update()["notices"]))
        made = quadrille.to_arrays(quadrille.remesh(ring, threads=1))
        numpy.testing.assert_array_equal(session.quads[1], made[1])
        session.set_settings(quads=5000)
        self.assertFalse(any("nobody" in notice for notice in session.update()["notices"]))
        session.set_settings(quads="automatic")
        session.update()
        numpy.testing.assert_array_equal(session.quads[1], made[1])


class Files(unittest.TestCase):
    def test_read(self):
        data = os.path.join(os.path.dirname(__file__), "..", "..", "Data")
        part = quadrille.read(os.path.join(data, "part.ply"))
        self.assertTrue(part.GetCellData().HasArray("PatchId"))
        for path, words in ((os.path.join(data, "absent.ply"), ["absent.ply", "no such file"]),
                            (os.path.join(data, "README.md"), [".md", ".ply"]), (__file__, [".py"])):
            with self.assertRaises(quadrille.InvalidInput) as caught:
                quadrille.read(path)
            for word in words:
                self.assertIn(word, str(caught.exception))
        with tempfile.TemporaryDirectory() as folder:
            for name in ("damaged.ply", "damaged.vtp"):
                path = os.path.join(folder, name)
                with open(path, "w") as file:
                    file.write("ply\nformat ascii 1.0\nelement vertex what\n")
                with self.assertRaises(quadrille.InvalidInput) as caught:
                    quadrille.read(path)
                self.assertIn(path, str(caught.exception))
            path = os.path.join(folder, "announced.vtp")
            with open(path, "w") as file:
                file.write('<VTKFile type="PolyData"><PolyData><Piece NumberOfPoints="4294967296">')
            with self.assertRaises(quadrille.InvalidInput) as caught:
                quadrille.read(path)
            self.assertIn("4294967296 Points", str(caught.exception))

    def test_the_reader_keeps_what_vtk_leaves_out(self):
        path = os.path.join(os.path.dirname(__file__), "..", "..", "Data", "part.ply")
        ours, theirs = quadrille.vtkQuadrillePLYReader(), vtkPLYReader()
        for reader in (ours, theirs):
            reader.SetFileName(path)
            reader.Update()
        self.assertTrue(ours.CanReadFile(path))
        self.assertFalse(ours.CanReadFile(__file__))
        self.assertFalse(theirs.GetOutput().GetCellData().HasArray("PatchId"))  # else ours is not needed any more
        self.assertEqual(ours.GetOutput().GetNumberOfPolys(), theirs.GetOutput().GetNumberOfPolys())
        for data in (ours.GetOutput(), theirs.GetOutput()):
            self.assertGreater(quadrille.remesh(data, quads=300).GetNumberOfCells(), 0)

    def test_binary_ply_is_what_its_text_is(self):
        """Rows of one length are read by several threads, all others one after the other: text is the measure."""
        random = numpy.random.default_rng(3)
        points = random.standard_normal((5000, 3)).astype("<f4").astype("<f8")
        triangles = random.integers(0, len(points), (90000, 3))
        quads = [tuple(row) for row in random.integers(0, len(points), (3, 4))]
        names = {"f4": "float", "f8": "double", "u1": "uchar", "i2": "short", "u2": "ushort", "i4": "int", "u4": "uint"}

        def header(form, real, scalars, count, index, faces):
            lines = ["ply", f"format {form} 1.0", "comment made by a test", f"element vertex {len(points)}",
                     f"property {names[real]} x", "property short before", f"property {names[real]} y",
                     f"property {names[real]} z", "property uchar after", f"element face {faces}"]
            lines += [f"property {names[kind]} {name}" for name, kind in scalars[:1]]
            lines += [f"property list {names[count]} {names[index]} vertex_indices"]
            lines += [f"property {names[kind]} {name}" for name, kind in scalars[1:]]
            return "\n".join(lines + ["end_header", ""]).encode("ascii")

        def write(path, order, real, scalars, count, index, polygons, values):
            form = {"<": "binary_little_endian", ">": "binary_big_endian", "": "ascii"}[order]
            with open(path, "wb") as file:
                file.write(header(form, real, scalars, count, index, len(polygons)))
                if order == "":
                    for i, (x, y, z) in enumerate(points):
                        file.write(f"{float(x)!r} {i % 300} {float(y)!r} {float(z)!r} {i % 256}\n".encode("ascii"))
                    for corners, row in zip(polygons, values):
                        words = [*row[:1], len(corners), *corners, *row[1:]]
                        file.write((" ".join(str(word) for word in words) + "\n").encode("ascii"))
                    return
                table = numpy.zeros(len(points), [("x", order + real), ("before", order + "i2"), ("y", order + real),
                                                  ("z", order + real), ("after", "u1")])
                table["x"], table["y"], table["z"] = points.T
                table["before"], table["after"] = numpy.arange(len(points)) % 300, numpy.arange(len(points)) % 256
                file.write(table.tobytes())
                for corners, row in zip(polygons, values):
                    file.write(b"".join(numpy.array(v, order + kind).tobytes()
                                        for v, (_, kind) in list(zip(row, scalars))[:1]))
                    file.write(numpy.array(len(corners), order + count).tobytes())
                    file.write(numpy.array(corners, order + index).tobytes())
                    file.write(b"".join(numpy.array(v, order + kind).tobytes()
                                        for v, (_, kind) in list(zip(row, scalars))[1:]))

        def read(path, threads):
            reader = quadrille.vtkQuadrillePLYReader()
            reader.SetNumberOfThreads(threads)
            reader.SetFileName(path)
            reader.Update()
            self.assertEqual(reader.GetOutcomeText(), "")
            return reader.GetOutput()

        layouts = [("f4", [], "u1", "i4"), ("f8", [("part", "i4")], "i4", "u4"),
                   ("f4", [("part", "u1"), ("weight", "f8")], "u2", "i4"), ("f4", [("part", "i2")], "u1", "u2")]
        with tempfile.TemporaryDirectory() as folder:
            for real, scalars, count, index in layouts:
                # One polygon that is no triangle, at the end, sends all faces the other way.
                for polygons in ([tuple(t) for t in triangles], [tuple(t) for t in triangles[:300]] + quads):
                    values = [tuple((i * (k + 7)) % 100 for k in range(len(scalars))) for i in range(len(polygons))]
                    data = {}
                    for order in ("", "<", ">"):
                        path = os.path.join(folder, "mesh.ply")
                        write(path, order, real, scalars, count, index, polygons, values)
                        data[order] = read(path, 1)
                        again = read(path, 3)
                        numpy.testing.assert_array_equal(vtk_to_numpy(again.GetPolys().GetConnectivityArray()),
                                                         vtk_to_numpy(data[order].GetPolys().GetConnectivityArray()))
                    for order in ("<", ">"):
                        ours, text = data[order], data[""]
                        self.assertEqual(ours.GetPoints().GetDataType(), text.GetPoints().GetDataType())
                        pairs = [(ours.GetPoints().GetData(), text.GetPoints().GetData()),
                                 (ours.GetPolys().GetConnectivityArray(), text.GetPolys().GetConnectivityArray()),
                                 (ours.GetPolys().GetOffsetsArray(), text.GetPolys().GetOffsetsArray())]
                        for name in ("before", "after"):
                            pairs.append((ours.GetPointData().GetArray(name), text.GetPointData().GetArray(name)))
                        for name, _ in scalars:
                            pairs.append((ours.GetCellData().GetArray(name), text.GetCellData().GetArray(name)))
                            self.assertEqual(pairs[-1][0].GetDataType(), pairs[-1][1].GetDataType())
                        for mine, theirs in pairs:
                            numpy.testing.assert_array_equal(vtk_to_numpy(mine), vtk_to_numpy(theirs))
            # Damage is told as it is of rows that are read one after the other.
            whole = os.path.join(folder, "whole.ply")
            broken = [tuple(t) for t in triangles]
            broken[70000] = (0, 1, len(points))
            write(whole, "<", "f4", [], "u1", "i4", broken, [()] * len(broken))
            with self.assertRaisesRegex(quadrille.InvalidInput, "face 70000 refers to vertex 5000"):
                quadrille.read(whole)
            write(whole, "<", "f4", [], "u1", "i4", [tuple(t) for t in triangles], [()] * len(triangles))
            with open(whole, "rb") as file:
                content = file.read()
            cut = os.path.join(folder, "cut.ply")
            with open(cut, "wb") as file:
                file.write(content[:-7])
            with self.assertRaisesRegex(quadrille.InvalidInput, "face 89999 has no valid vertex_indices"):
                quadrille.read(cut)

    def test_binary_stl_is_what_vtk_reads(self):
        """Random triangles on a few points: equal ones everywhere, triangles with a point twice, both zeros, NaN."""
        random = numpy.random.default_rng(4)
        lattice = numpy.array([-1.0, -0.0, 0.0, 0.5, 1e30, numpy.nan], "<f4")
        table = numpy.zeros(40000, [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("bytes", "<u2")])
        table["corners"] = lattice[random.integers(0, len(lattice), (len(table), 3, 3))]
        table["corners"][::3] = random.standard_normal((len(table[::3]), 3, 3)).astype("<f4")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "soup.stl")
            with open(path, "wb") as file:
                file.write(b"binary".ljust(80) + numpy.array(len(table), "<u4").tobytes() + table.tobytes())
            self.assertTrue(quadrille.vtkQuadrilleSTLReader.CanReadFile(path))
            theirs = vtkSTLReader()
            theirs.SetLocator(quadrille.QuadrilleFilters.vtkQuadrilleUniquePoints())
            theirs.SetFileName(path)
            theirs.Update()
            for threads in (1, 3):
                ours = quadrille.vtkQuadrilleSTLReader()
                ours.SetNumberOfThreads(threads)
                ours.SetFileName(path)
                ours.Update()
                self.assertEqual(ours.GetOutcomeText(), "")
                found, expected = ours.GetOutput(), theirs.GetOutput()
                self.assertLess(found.GetNumberOfPolys(), len(table))
                numpy.testing.assert_array_equal(
                    vtk_to_numpy(found.GetPoints().GetData()), vtk_to_numpy(expected.GetPoints().GetData()))
                numpy.testing.assert_array_equal(vtk_to_numpy(found.GetPolys().GetConnectivityArray()),
                                                 vtk_to_numpy(expected.GetPolys().GetConnectivityArray()))
            with open(path, "ab") as file:
                file.write(b"more than its triangles")
            self.assertFalse(quadrille.vtkQuadrilleSTLReader.CanReadFile(path))
            ours.Modified()
            ours.GlobalWarningDisplayOff()  # the error is what is wanted
            ours.Update()
            ours.GlobalWarningDisplayOn()
            self.assertIn("soup.stl", ours.GetOutcomeText())

    def test_stl_with_a_point_far_off(self):
        """Points are joined as VTK joins them, but none is looked for among all others."""
        sphere = vtkSphereSource()
        sphere.SetThetaResolution(40)
        sphere.SetPhiResolution(40)
        sphere.Update()
        surface = sphere.GetOutput()
        for far in (1.0, 1e30):
            surface.GetPoints().SetPoint(0, 0, 0, far)
            with tempfile.TemporaryDirectory() as folder:
                name = os.path.join(folder, "far.stl")
                writer = vtkSTLWriter()
                writer.SetFileTypeToBinary()
                writer.SetInputData(surface)
                writer.SetFileName(name)
                writer.Write()
                theirs = vtkSTLReader()
                theirs.SetFileName(name)
                theirs.Update()
                found = quadrille.read(name)
            expected = theirs.GetOutput()
            self.assertEqual(found.GetNumberOfPoints(), surface.GetNumberOfPoints())
            numpy.testing.assert_array_equal(
                vtk_to_numpy(found.GetPoints().GetData()), vtk_to_numpy(expected.GetPoints().GetData()))
            numpy.testing.assert_array_equal(vtk_to_numpy(found.GetPolys().GetConnectivityArray()),
                                             vtk_to_numpy(expected.GetPolys().GetConnectivityArray()))

    def test_off(self):
        texts = {
            "plain": ("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n", {}, {}),
            "colours": ("COFF # vertices have whole numbers, faces have fractions\n4 2 0\n0 0 0 255 0 0 7\n"
                        "1 0 0 1 0 0 128\n1 1 0 0 0 0 0\n0 1 0 0 0 0 0\n3 0 1 2 1 0 0\n3 0 2 3 0. 1 0.2\n",
                        {"RGBA": [(255, 0, 0, 7), (1, 0, 0, 128), (0, 0, 0, 0), (0, 0, 0, 0)]},
                        {"RGB": [(255, 0, 0), (0, 255, 51)]}),
            "both kinds": ("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 1 2 3\n3 0 2 3 0. 1 0.2\n", {}, {}),
            "normals": ("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 2\n1 1 0 0 0 3\n3 0 1 2 5\n",
                        {"Normals": [(0, 0, 1), (0, 0, 2), (0, 0, 3)]}, {"ColorIndex": [(5,)]}),
            "texture": ("STOFF 3 1 0\n0 0 0 0.5 1\n1 0 0 0 0.25\n1 1 0 0 0\n3 0 1 2\n",
                        {"TCoords": [(0.5, 1), (0, 0.25), (0, 0)]}, {}),
            "some without": ("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 1 2 3\n3 0 2 3\n", {}, {}),
        }
        with tempfile.TemporaryDirectory() as folder:
            for name, (text, points, cells) in texts.items():
                path = os.path.join(folder, name + ".off")
                with open(path, "w") as file:
                    file.write(text)
                data = quadrille.read(path)
                self.assertTrue(quadrille.vtkQuadrilleOFFReader.CanReadFile(path))
                for attributes, wanted in ((data.GetPointData(), points), (data.GetCellData(), cells)):
                    found = {array.GetName(): [array.GetTuple(i) for i in range(array.GetNumberOfTuples())]
                             for array in map(attributes.GetArray, range(attributes.GetNumberOfArrays()))}
                    self.assertEqual(found, wanted, name)
            with open(path, "w") as file:
                file.write("COFF\n3 1 0\n0 0 0 1 2 3\n1 0 0 0.5 0 0\n1 1 0 0 0 0\n3 0 1 2\n")
            with self.assertRaisesRegex(quadrille.InvalidInput, "vertex 1 has no colour .* like the others"):
                quadrille.read(path)
        self.assertFalse(quadrille.vtkQuadrilleOFFReader.CanReadFile(__file__))


class Requests(unittest.TestCase):
    def setUp(self):
        self.points, self.faces = plate()
        self.mesh = (self.points, self.faces)

    def assertRefused(self, words, **options):
        Mesh.assertRefused(self, words, self.mesh, quads=100, **options)

    def middle(self):
        """Ends of the edges of the column x = 12."""
        return [(12 + 25 * row, 12 + 25 * (row + 1)) for row in range(16)]

    def inner_lines(self, result):
        lines = result.lines
        boundary = vtk_to_numpy(lines.GetCellData().GetArray("Boundary"))
        ends = vtk_to_numpy(lines.GetLines().GetConnectivityArray()).reshape(-1, 2)
        return vtk_to_numpy(lines.GetPoints().GetData())[ends[boundary == 0]]

    def test_feature_edges_as_pairs_and_as_bits(self):
        pairs = self.middle()
        bits = numpy.zeros(len(self.faces), numpy.uint8)
        ends = {frozenset(pair) for pair in pairs}
        for f, face in enumerate(self.faces.tolist()):
            for i in range(3):
                bits[f] |= (frozenset((face[i], face[(i + 1) % 3])) in ends) << i
        results = [quadrille.remesh(self.mesh, quads=100, feature_edges=given, everything=True)
                   for given in (pairs, numpy.array(pairs)[:, ::-1], bits)]
        for result in results:
            inner = self.inner_lines(result)
            self.assertGreater(len(inner), 3)
            numpy.testing.assert_array_equal(inner[:, :, 0], 12)
            numpy.testing.assert_array_equal(quadrille.to_arrays(result.quads)[0],
                                             quadrille.to_arrays(results[0].quads)[0])
        # An edge of a polydata and of faces with four corners, too.
        surface = quadrille.to_polydata(*self.mesh)
        given = quadrille.remesh(surface, quads=100, feature_edges=pairs)
        numpy.testing.assert_array_equal(quadrille.to_arrays(given)[0], quadrille.to_arrays(results[0].quads)[0])
        self.assertFalse(surface.GetCellData().HasArray("FeatureEdges"), "the user's mesh was changed")

    def test_patch_ids(self):
        ids = (self.points[self.faces].mean(axis=1)[:, 0] > 12).astype(int)
        result = quadrille.remesh(self.mesh, quads=100, patch_ids=ids, everything=True)
        numpy.testing.assert_array_equal(self.inner_lines(result)[:, :, 0], 12)
        self.assertEqual(set(vtk_to_numpy(result.quads.GetCellData().GetArray("PatchId"))), {0, 1})

    def test_curves_and_strokes(self):
        line = [[12, -0.1, 0], [12, 8, 0], [12, 16.1, 0]]
        result = quadrille.remesh(self.mesh, quads=100, curves=[line], everything=True)
        numpy.testing.assert_array_equal(self.inner_lines(result)[:, :, 0], 12)
        stroke = numpy.array([[5, 3, 0], [15, 13, 0]])
        result = quadrille.remesh(self.mesh, quads=100, strokes=[stroke], everything=True)
        self.assertEqual(len(self.inner_lines(result)), 0)
        plain = quadrille.remesh(self.mesh, quads=100)
        self.assertFalse(numpy.array_equal(quadrille.to_arrays(plain)[0], quadrille.to_arrays(result.quads)[0]))

    def test_sizes_that_follow_the_shape(self):
        sphere = vtkSphereSource()
        sphere.SetThetaResolution(60)
        sphere.SetPhiResolution(40)
        sphere.SetRadius(1)
        sphere.Update()
        plain = quadrille.remesh(sphere.GetOutput(), edge_length=0.5)
        fine = quadrille.remesh(sphere.GetOutput(), edge_length=0.5, chord_error=0.01)
        # Edges of sqrt(8 e) = 0.28 in place of 0.5.
        self.assertAlmostEqual(fine.GetNumberOfCells() / (4 * math.pi / 0.08), 1, delta=0.2)
        self.assertLess(plain.GetNumberOfCells(), 0.6 * fine.GetNumberOfCells())
        thick = quadrille.remesh(sphere.GetOutput(), edge_length=0.5, gap_quads=6, smallest_size=0.5)
        self.assertGreater(thick.GetNumberOfCells(), 1.5 * plain.GetNumberOfCells())  # 2 / 6
        turned = quadrille.remesh(sphere.GetOutput(), edge_length=0.5, angle_a_quad=math.degrees(0.08 ** 0.5))
        self.assertAlmostEqual(turned.GetNumberOfCells() / (4 * math.pi / 0.08), 1, delta=0.2)
        for words, options in ((["chord_error", "above 0"], {"chord_error": 0}),
                               (["angle_a_quad", "180"], {"angle_a_quad": 181}),
                               (["gap_quads"], {"gap_quads": -1}), (["smallest_size"], {"smallest_size": 2}),
                               (["largest_size"], {"largest_size": 0.5})):
            self.assertRefused(words, **options)

    def test_guides_by_name_and_by_curvature(self):
        surface = quadrille.to_polydata(*self.mesh)
        fibre = numpy_to_vtk(numpy.tile((math.cos(0.4), math.sin(0.4), 0.0), (len(self.points), 1)), deep=True)
        fibre.SetName("Fibre")
        surface.GetPointData().AddArray(fibre)
        by_name = quadrille.remesh(surface, quads=100, guide="Fibre")
        direction = numpy.tile((math.cos(0.4), math.sin(0.4), 0.0), (len(self.faces), 1))
        given = quadrille.remesh(self.mesh, quads=100, guiding_direction=direction)
        numpy.testing.assert_allclose(quadrille.to_arrays(by_name)[0], quadrille.to_arrays(given)[0], atol=1e-3)
        flat = quadrille.remesh(self.mesh, quads=100, guide="curvature", everything=True)
        self.assertIn("guides", flat.info["stages"])
        numpy.testing.assert_array_equal(quadrille.to_arrays(flat.quads)[0],  # a plane has no direction
                                         quadrille.to_arrays(quadrille.remesh(self.mesh, quads=100))[0])
        self.assertRefused(["Fiber"], guide="Fiber")
        self.assertRefused(["guide", "curvature"], guide=3)
        stroke = [[5, 3, 0], [15, 13, 0]]
        narrow = quadrille.remesh(self.mesh, quads=100, strokes=[stroke], everything=True)
        wide = quadrille.remesh(self.mesh, quads=100, strokes=[stroke], stroke_radius=4, everything=True)
        self.assertFalse(numpy.array_equal(quadrille.to_arrays(narrow.quads)[0], quadrille.to_arrays(wide.quads)[0]))

    def test_constraints_have_a_word_each(self):
        """Guides and valences of the info dict against the quads, measured by numpy."""
        centres = self.points[self.faces].mean(axis=1)
        guided = numpy.linalg.norm(centres - (12, 8, 0), axis=1) < 5
        direction = numpy.where(guided[:, None], (math.cos(0.4), math.sin(0.4), 0.0), 0.0)
        valence_at = int(numpy.flatnonzero((self.points == (4, 12, 0)).all(axis=1))[0])
        line = [[12, 0, 0], [12, 2, 0]]
        result = quadrille.remesh(self.mesh, quads=400, guiding_direction=direction, target_valence={valence_at: 5},
                                  curves=[line], everything=True)
        told = result.info["constraints"]
        self.assertEqual([row["kind"] for row in told], ["guide array", "valence", "feature curve"])
        self.assertEqual([row["id"] for row in told], [0, 1, 2])
        points, quads = quadrille.to_arrays(result.quads)
        corners = points[quads]
        middle = corners.mean(axis=1)
        near = numpy.linalg.norm(centres[guided][:, None] - middle, axis=2).argmin(axis=1)
        along = numpy.stack((corners[:, 1] + corners[:, 2] - corners[:, 0] - corners[:, 3],
                             corners[:, 2] + corners[:, 3] - corners[:, 0] - corners[:, 1]), axis=1)[near]
        angle = numpy.degrees(numpy.arctan2(along[:, :, 1], along[:, :, 0]) - 0.4)
        off = numpy.abs(angle - 180 * numpy.round(angle / 180)).min(axis=1)
        # The faces are of one size; the quad with the nearest centre is nearly always the one that holds the face's.
        self.assertAlmostEqual(told[0]["deviation"], off.mean(), delta=1)
        self.assertEqual(told[0]["met"], told[0]["deviation"] <= 5)
        self.assertEqual(told[0]["unit"], "degrees")
        distance = numpy.linalg.norm(points - told[1]["place"], axis=1)
        numpy.testing.assert_array_equal(told[1]["place"], (4, 12, 0))
        got = vtk_to_numpy(result.quads.GetPointData().GetArray("Valence"))[distance.argmin()]
        got = got if distance.min() < 1e-6 else 4
        self.assertEqual(told[1]["deviation"], got - 5)
        self.assertEqual(told[1]["source_id"], valence_at)
        self.assertTrue(told[2]["met"])
        self.assertIsNone(told[2]["deviation_95"])
        for row in told:
            self.assertEqual(row["met"], row["reason"] == "")
        self.assertEqual(quadrille.remesh(self.mesh, quads=100, everything=True).info["constraints"], [])

    def test_small_details_have_a_row_each(self):
        """A plate of 30 by 30 cells without one: the hole is 4 long round, 0.67 edge lengths of 25 quads."""
        at = [(x, y) for y in range(30) for x in range(30) if (x, y) != (10, 20)]
        corner = {p: i for i, p in enumerate((x, y) for y in range(31) for x in range(31))}
        points = [(x, y, 0) for x, y in corner]
        cells = [[corner[x, y], corner[x + 1, y], corner[x + 1, y + 1], corner[x, y + 1]] for x, y in at]
        for decision, expected, loops in (("automatic", "simplified", 1), ("keep", "kept", 2)):
            with self.subTest(decision):
                made = quadrille.remesh((points, cells), quads=25, small_details=decision, everything=True)
                row, = made.info["details"]
                self.assertEqual((row["kind"], row["decision"]), ("boundary loop", expected))
                self.assertAlmostEqual(row["size"] * made.info["TargetEdgeLength"], 4, delta=1e-5)
                self.assertLess(numpy.linalg.norm(numpy.subtract(row["place"], (10.5, 20.5, 0))), 0.8)
                self.assertEqual(made.info["repair"]["filled_holes"], 2 - loops)
                self.assertEqual(made.info["Attempts"], 1 + sum(made.info["recoveries"].values()))

    def test_guiding_direction(self):
        direction = numpy.tile((1.0, 1.0, 0.0), (len(self.faces), 1))
        weight = numpy.full(len(self.faces), 0.5)
        surface = quadrille.to_polydata(*self.mesh)
        for name, values in (("GuidingDirection", direction), ("GuidingWeight", weight)):
            array = numpy_to_vtk(values, deep=True)
            array.SetName(name)
            surface.GetCellData().AddArray(array)
        expected = quadrille.to_arrays(quadrille.remesh(surface, quads=400))[0]
        for given in (weight, 0.5):
            guided = quadrille.remesh(self.mesh, quads=400, guiding_direction=direction, guiding_weight=given)
            numpy.testing.assert_array_equal(quadrille.to_arrays(guided)[0], expected)
        free = quadrille.to_arrays(quadrille.remesh(self.mesh, quads=400))[0]
        self.assertFalse(numpy.array_equal(free, expected))

    def test_target_valence_and_sizing(self):
        asked = {8 * 25 + 9: 3, 8 * 25 + 15: 5}
        valences = numpy.zeros(len(self.points), int)
        for point, valence in asked.items():
            valences[point] = valence
        for given in (asked, valences):
            quads = quadrille.remesh(self.mesh, quads=400, target_valence=given)
            found = vtk_to_numpy(quads.GetPointData().GetArray("Valence"))
            points = quadrille.to_arrays(quads)[0]
            for point, valence in asked.items():
                nearest = numpy.linalg.norm(points - self.points[point], axis=1).argmin()
                self.assertEqual(found[nearest], valence)
        small_left = numpy.where(self.points[:, 0] < 12, 0.5, 1.0)
        points, faces = quadrille.to_arrays(quadrille.remesh(self.mesh, quads=400, sizing=small_left))
        left = points[faces].mean(axis=1)[:, 0] < 12
        self.assertGreater(left.sum(), 1.2 * (~left).sum())

    def test_what_is_wrong_with_requests(self):
        faces, points = len(self.faces), len(self.points)
        self.assertRefused(["guiding_direction", str((faces, 3))], guiding_direction=numpy.ones((5, 3)))
        self.assertRefused(["guiding_direction", "shape"], guiding_direction=numpy.ones(faces))
        self.assertRefused(["guiding_weight needs"], guiding_weight=1)
        self.assertRefused(["above 0"], guiding_direction=numpy.ones((faces, 3)), guiding_weight=7)
        self.assertRefused(["finite"], guiding_direction=numpy.full((faces, 3), math.nan))
        self.assertRefused(["target_valence", str((points,))], target_valence=[4, 4])
        self.assertRefused(["target_valence names point 9999"], target_valence={9999: 3})
        self.assertRefused(["TargetValence 9"], target_valence={200: 9})
        self.assertRefused(["target_valence", "whole", "4.5"], target_valence=numpy.full(points, 4.5))
        self.assertRefused(["Sizing", "point 0"], sizing=numpy.full(points, -1.0))
        self.assertRefused(["sizing", "numbers"], sizing=["a"] * points)
        self.assertRefused(["feature edge 0", "no edge of a face"], feature_edges=[(0, 60)])
        self.assertRefused(["feature edge 1", "9999"], feature_edges=[(0, 1), (0, 9999)])
        self.assertRefused(["feature_edges", "n by 2"], feature_edges=[1, 2, 3])
        self.assertRefused(["feature_edges of face 0 is 256"], feature_edges=numpy.full(faces, 256))
        self.assertRefused(["patch_ids"], patch_ids=[1])
        self.assertRefused(["curves[0]", "1 point(s)"], curves=[[[0, 0, 0]]])
        self.assertRefused(["strokes[1]", "n by 3"], strokes=[[[0, 0, 0], [1, 0, 0]], [[1, 2]] * 4])
        self.assertRefused(["no room for strokes (1)"], curves=vtkPolyData(), strokes=[[[0, 0, 0], [1, 0, 0]]])


class Check(unittest.TestCase):
    def test_of_an_algorithm(self):
        run = quadrille.vtkQuadRemesh()
        run.SetInputData(quadrille.to_polydata(*plate()))
        run.AddObserver("ErrorEvent", lambda caller, event: None)
        self.assertIs(quadrille.check(run), run)
        run.SetTargetTypeToEdgeLength()
        run.SetEdgeLength(-1)
        with self.assertRaises(quadrille.InvalidInput) as caught:
            quadrille.check(run)
        self.assertIn("edge length", str(caught.exception))
        run.SetEdgeLength(1)
        run.SetMaximumNumberOfQuads(3)
        with self.assertRaises(quadrille.RemeshError) as caught:
            quadrille.check(run)
        self.assertNotIsInstance(caught.exception, quadrille.InvalidInput)
        with self.assertRaises(quadrille.InvalidInput):
            quadrille.check(42)


if __name__ == "__main__":
    unittest.main()
