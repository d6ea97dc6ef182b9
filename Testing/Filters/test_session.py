# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""quadrille.Session: numpy in and out, undo, files, and what is wrong with what is given."""
import math
import os
import pathlib
import tempfile
import unittest

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOPLY import vtkPLYReader

import quadrille


def dents(columns=48, rows=24, even=False):
    """A torus whose tube has dents, so that nothing is a tie; even: they are symmetric about z = 0."""
    u, v = numpy.meshgrid(numpy.arange(columns) * 2 * numpy.pi / columns, numpy.arange(rows) * 2 * numpy.pi / rows)
    tube = 0.4 + 0.05 * numpy.sin(3 * u) * numpy.cos(2 * v) + 0.03 * (
        numpy.sin(u) * numpy.cos(v) if even else numpy.sin(u + v))
    ring = 1 + tube * numpy.cos(v)
    points = numpy.stack((ring * numpy.cos(u), ring * numpy.sin(u), tube * numpy.sin(v)), axis=2).reshape(-1, 3)
    i, j = numpy.meshgrid(numpy.arange(columns), numpy.arange(rows))
    right, up = (i + 1) % columns, (j + 1) % rows
    a, b, c, d = (row * columns + column for row, column in ((j, i), (j, right), (up, right), (up, i)))
    return points, numpy.concatenate((numpy.stack((a, b, c), axis=2).reshape(-1, 3),
                                      numpy.stack((a, c, d), axis=2).reshape(-1, 3)))


def ball():
    """A ball with dents."""
    source = vtkSphereSource()
    source.SetThetaResolution(48)
    source.SetPhiResolution(32)
    source.SetRadius(1)
    source.Update()
    points = vtk_to_numpy(source.GetOutput().GetPoints().GetData()).astype(float)
    faces = vtk_to_numpy(source.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 3)
    dent = 1 + 0.15 * numpy.sin(4 * points[:, 0]) * numpy.cos(3 * points[:, 1] + points[:, 2])
    return points * dent[:, None], faces


POINTS, FACES = dents()


def session(quads=400, **more):
    return quadrille.Session((POINTS, FACES), quads=quads, coarse_vertices=300, threads=2, **more)


def same(first, second):
    return all(numpy.array_equal(a, b) for a, b in zip(first, second))


def valences(made):
    """By place."""
    return dict(zip(map(tuple, made.irregular().point.tolist()), made.irregular().valence.tolist()))


def cube():
    """12 triangles."""
    points = numpy.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    sides = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return points, numpy.array([corner for a, b, c, d in sides for corner in ((a, b, c), (a, c, d))])


def part():
    """A flange, whose triangles are larger than its quads."""
    reader = vtkPLYReader()
    reader.SetFileName(str(pathlib.Path(__file__).resolve().parents[2] / "Data" / "part.ply"))
    reader.Update()
    data = reader.GetOutput()
    return (vtk_to_numpy(data.GetPoints().GetData()).astype(float),
            vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3))


class SessionTest(unittest.TestCase):
    def test_undo_makes_nothing(self):
        made = session()
        first = made.quads
        self.assertEqual(first[0].shape[1], 3)
        self.assertEqual(first[1].shape[1], 4)
        guide = made.add_guide(POINTS[[0, 30, 100]], radius=0.2)
        report = made.update()
        self.assertEqual(report["runs"], 1)
        self.assertNotIn("phase1", report["stages"])
        self.assertIn("phase1", report["reused"])
        self.assertEqual([word["id"] for word in report["constraints"]], [guide])
        second = made.quads
        self.assertFalse(same(first, second))
        self.assertTrue(made.undo())
        self.assertFalse(made.undo())
        self.assertEqual(made.update()["runs"], 0)
        self.assertTrue(same(made.quads, first))
        self.assertTrue(made.redo())
        self.assertTrue(same(made.quads, second))
        made.set_settings(quads=600)
        self.assertEqual(made.settings()["quads"], 600)
        self.assertAlmostEqual(made.settings()["feature_angle"], 40)
        self.assertEqual(made.settings()["feature_criterion"], "creases")
        made.set_settings(feature_criterion="angle")
        self.assertEqual(made.settings()["feature_criterion"], "angle")
        self.assertGreater(len(made.quads[1]), len(second[1]))

    def test_preview(self):
        made = session()
        points, quads = made.preview()
        self.assertEqual(points.shape[1], 3)
        report = made.update()
        self.assertNotIn("phase1", report["stages"])
        self.assertIn("replay", report["stages"])
        self.assertEqual(len(quads), len(made.quads[1]))
        self.assertTrue(same(made.preview(), (points, quads)))
        self.assertEqual(made.update()["runs"], 0)
        with self.assertRaisesRegex(quadrille.RemeshError, "stopped"):
            session(progress=lambda fraction: False).preview()

    def test_symmetry(self):
        sheet, faces = dents(even=True)
        made = quadrille.Session((sheet, faces), quads=400, coarse_vertices=300, threads=2)
        self.assertIsNone(made.mirror_point)
        symmetry = made.set_symmetry((0, 0, 0), (0, 0, 2))
        word, = made.update()["constraints"]
        self.assertTrue(word["met"], word)
        self.assertEqual((word["kind"], word["id"], word["unit"]), ("symmetry", symmetry, "diagonals"))
        image, (points, quads) = made.mirror_point, made.quads
        numpy.testing.assert_array_equal(image[image], numpy.arange(len(points)))
        # The diagonals of the faces are not symmetric: points are put onto the mesh, nearer than its faces are to the
        # shape, about a 16th of the square of their edges, 0.1, over the radius of the tube.
        numpy.testing.assert_allclose(points[image], points * (1, 1, -1), atol=5e-3)
        self.assertEqual({tuple(sorted(quad)) for quad in image[quads].tolist()},
                         {tuple(sorted(quad)) for quad in quads.tolist()})
        with self.assertRaisesRegex(quadrille.InvalidInput, "symmetry 1"):
            made.preview()
        self.assertEqual(made.set_symmetry(edit=symmetry), symmetry)
        self.assertTrue(made.update()["constraints"][0]["met"])
        made.remove(symmetry)
        self.assertIsNone(made.mirror_point)

    def test_mid_line(self):
        mesh = dents(even=True)
        made = quadrille.Session(mesh, quads=400, coarse_vertices=300, threads=2)
        symmetry = made.set_symmetry((0, 0, 0), (0, 0, 2))
        isoline = made.quads
        self.assertTrue((made.mirror_point == numpy.arange(len(isoline[0]))).any())
        self.assertEqual(made.set_symmetry((0, 0, 0), (0, 0, 2), plane_curve="mid-line", edit=symmetry), symmetry)
        self.assertTrue(made.update()["constraints"][0]["met"])
        image, (points, quads) = made.mirror_point, made.quads
        numpy.testing.assert_array_equal(image[image], numpy.arange(len(points)))
        self.assertFalse((image == numpy.arange(len(points))).any())
        across = (numpy.sort(image[quads], axis=1) == numpy.sort(quads, axis=1)).all(axis=1)
        self.assertTrue(across.any())
        self.assertTrue((numpy.sign(points[quads[across]][:, :, 2]).sum(axis=1) == 0).all())
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "s.json")
            made.save(path)
            with open(path) as file:
                self.assertIn('"plane_curve": "mid-line"', file.read())
            again = quadrille.Session.load(path, mesh)
            numpy.testing.assert_array_equal(again.quads[0], points)
            numpy.testing.assert_array_equal(again.quads[1], quads)
        made.undo()
        numpy.testing.assert_array_equal(made.quads[0], isoline[0])
        made.redo()
        numpy.testing.assert_array_equal(made.quads[0], points)
        with self.assertRaisesRegex(quadrille.InvalidInput, "plane_curve"):
            made.set_symmetry(plane_curve="edges")

    def test_rotation(self):
        count = 12
        ring = [(math.cos(2 * math.pi * k / count), math.sin(2 * math.pi * k / count)) for k in range(count)]
        tube = numpy.array([(x, y, z / 4) for z in range(9) for x, y in ring])
        faces = [(count * j + k, count * j + (k + 1) % count, count * (j + 1) + (k + 1) % count, count * (j + 1) + k)
                 for j in range(8) for k in range(count)]
        made = quadrille.Session((tube, faces), quads=200, coarse_vertices=300, threads=2, feature_angle=None)
        self.assertIsNone(made.rotated_point)
        rotation = made.set_rotation(3, (0, 0, 0), (0, 0, 1))
        word, = made.update()["constraints"]
        self.assertTrue(word["met"], word)
        self.assertEqual((word["kind"], word["id"], word["unit"]), ("rotation", rotation, "diagonals"))
        image, (points, quads) = made.rotated_point, made.quads
        numpy.testing.assert_array_equal(image[image[image]], numpy.arange(len(points)))
        self.assertEqual({tuple(sorted(quad)) for quad in image[quads].tolist()},
                         {tuple(sorted(quad)) for quad in quads.tolist()})
        self.assertIsNone(made.mirror_point)
        with self.assertRaisesRegex(quadrille.InvalidInput, "rotation 1"):
            made.preview()
        # One symmetry is in force: the later one is told to be left out.
        made.set_symmetry((0, 0, 0), (1, 0, 0))
        self.assertFalse(made.update()["constraints"][1]["met"])
        made.remove(rotation)
        self.assertIsNone(made.rotated_point)
        for arguments in ((1,), (65,), (3, (0, 0, 0)), (3, (0, 0, 0), (0, 0, 0))):
            with self.assertRaises(quadrille.InvalidInput):
                made.set_rotation(*arguments)

    def test_sizes_and_guides_from_the_shape(self):
        made = session()
        plain = made.quads
        shape = {"chord_error": 0.02, "gap_quads": 3, "smallest_size": 0.3, "largest_size": 1.5,
                 "curvature_guides": 0.2}
        made.set_settings(**shape)
        self.assertEqual({name: made.settings()[name] for name in shape}, shape)
        shaped = made.quads
        self.assertFalse(same(shaped, plain))
        self.assertTrue(same(session(**shape).quads, shaped))
        made.set_settings(angle_a_quad=5)
        self.assertAlmostEqual(made.settings()["angle_a_quad"], 5)
        self.assertFalse(same(made.quads, shaped))
        made.set_settings(angle_a_quad=None)
        self.assertTrue(same(made.quads, shaped))
        made.set_settings(chord_error=None, gap_quads=0, smallest_size=0.2, largest_size=1, curvature_guides=None)
        self.assertTrue(same(made.quads, plain))

    def test_each_kind(self):
        made = session()
        made.add_guide(POINTS[[0, 30]])
        made.add_guide(faces=range(10), direction=(0, 0, 1), weight=0.5)
        made.add_feature(POINTS[[300, 310]])
        made.set_valence(500, 5)
        made.set_size(800, 0.5, radius=0.2)
        made.set_size(faces=[900, 901], factor=0.7)
        made.connect(POINTS[100], 200)
        made.connect(POINTS[[600, 610, 620]])
        made.add_cycle(POINTS[numpy.arange(24) * 48])
        report = made.update()
        kinds = [word["kind"] for word in report["constraints"]]
        self.assertEqual(kinds, ["guide", "guide region", "feature", "valence", "size", "size region", "connection",
                                 "connection", "cycle"])
        for word in report["constraints"]:
            self.assertEqual(word["met"], word["reason"] == "", word)
            is_far = word["met"] and word["kind"] in ("connection", "cycle") and word["deviation"] > 0.5
            self.assertEqual(is_far, word["remark"] != "", word)
        listed = made.constraints()
        self.assertEqual(listed[3]["valence"], 5)
        numpy.testing.assert_array_equal(listed[3]["point"], POINTS[500])
        self.assertEqual(listed[3]["met"], report["constraints"][3]["met"])

    def test_irregular_vertices(self):
        points, faces = ball()
        made = quadrille.Session((points, faces), quads=400, coarse_vertices=300, threads=2)
        before = valences(made)
        self.assertEqual(sum(4 - valence for valence in before.values()), 8)
        places = made.irregular().point
        # Points far from all irregular vertices, one after the other.
        empty = []
        for _ in range(3):
            nearest = numpy.min(numpy.linalg.norm(points[:, None] - places, axis=2), axis=1)
            empty.append(int(numpy.argmax(nearest)))
            places = numpy.concatenate((places, points[empty[-1:]]))
        a, b, c = empty
        at = [tuple(p) for p in points.tolist()]
        made.add_pair(points[a], b)
        self.assertEqual(valences(made), {**before, at[a]: 3, at[b]: 5})
        made.move_irregular(a, c)
        self.assertEqual(valences(made), {**before, at[c]: 3, at[b]: 5})
        made.cancel_pair(c, b)
        self.assertEqual(valences(made), before)
        self.assertTrue(all(word["met"] for word in made.update()["constraints"]))
        with self.assertRaisesRegex(quadrille.InvalidInput, "by 1"):
            made.add_pair(a, b, valences=(3, 4))
        with self.assertRaisesRegex(quadrille.InvalidInput, "target"):
            made.merge_irregular(a, b, "here")

    def test_what_no_surface_can_have_is_left_out(self):
        # No quad mesh of a torus has just one vertex of valence 3 and one of valence 5.
        made = session()
        self.assertEqual(valences(made), {})
        made.add_pair(5, 600)
        report = made.update()
        self.assertFalse(report["constraints"][0]["met"])
        self.assertIn("cannot be met", report["constraints"][0]["reason"])
        self.assertEqual(valences(made), {})

    def test_files_and_states(self):
        made = session()
        made.state("plain")
        made.update()
        valence = made.set_valence(500, 5)
        made.update()
        comparison = made.compare("plain")
        self.assertEqual(comparison["only_second"], [valence])
        self.assertEqual(comparison["results"]["unmatched"], 0)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "session.json")
            made.save(file)
            loaded = quadrille.Session.load(file, (POINTS, FACES))
            self.assertTrue(same(loaded.quads, made.quads))
            self.assertEqual(loaded.states(), ["plain"])
            loaded.go_to("plain")
            self.assertEqual(loaded.constraints(), [])
            with self.assertRaisesRegex(quadrille.InvalidInput, "another surface"):
                quadrille.Session.load(file, (2 * POINTS, FACES))
            with self.assertRaisesRegex(quadrille.RemeshError, "cannot read"):
                quadrille.Session.load(os.path.join(folder, "nothing"), (POINTS, FACES))

    def test_edits_keep_ids(self):
        made = session()
        guide = made.add_guide(POINTS[[0, 30]])
        self.assertEqual(made.add_guide(POINTS[[0, 40]], edit=guide), guide)
        self.assertEqual(len(made.constraints()), 1)
        with self.assertRaisesRegex(quadrille.InvalidInput, "no constraint 77"):
            made.remove(77)
        with self.assertRaises(quadrille.InvalidInput):
            made.set_valence(5, 4, edit=guide)

    def test_stops(self):
        made = session(progress=lambda fraction: False)
        with self.assertRaisesRegex(quadrille.RemeshError, "stopped"):
            made.update()

    def test_reports_tell_no_stop_where_there_was_none(self):
        self.assertEqual(session().update()["stopped"], "")

    def test_what_is_wrong_is_named(self):
        for more, text in (({"quads": 0}, "quads"), ({"featureangle": 3}, "featureangle"),
                           ({"method": "best"}, "method"), ({"feature_angle": 200}, "feature_angle")):
            with self.assertRaisesRegex(quadrille.InvalidInput, text):
                session(**more)
        made = session()
        for call, text in ((lambda: made.set_valence(len(POINTS), 5), "points 0 to"),
                           (lambda: made.set_valence((0, 0), 5), "three numbers"),
                           (lambda: made.set_valence(5, 11), "valence 11"),
                           (lambda: made.add_guide(), "points"),
                           (lambda: made.add_guide([[0, 0, 0]]), "at least 2"),
                           (lambda: made.go_to("there"), "there"),
                           (lambda: made.set_symmetry((0, 0, 0)), "an origin and a normal"),
                           (lambda: made.set_symmetry((0, 0, 0), (0, 0, 0)), "normal"),
                           (lambda: made.set_settings(chord_error=0), "chord_error"),
                           (lambda: made.set_settings(gap_quads=None), "gap_quads"),
                           (lambda: made.set_settings(smallest_size=1.5), "smallest_size"),
                           (lambda: made.set_settings(largest_size=0.5), "largest_size"),
                           (lambda: made.set_settings(curvature_guides=1), "anisotropy"),
                           (lambda: made.set_size(3, 0), "factor")):
            with self.assertRaisesRegex(quadrille.InvalidInput, text):
                call()
        self.assertEqual(made.constraints(), [])


class OneWayForAllFronts(unittest.TestCase):
    """A session, remesh() and the filter make the same bytes of the same constraints."""

    def check(self, mesh, quads, ask, told, kind, places, valence=3, radius=0.0):
        made = quadrille.Session(mesh, quads=quads, threads=2)
        ask(made)
        expected = made.quads
        self.assertEqual([word["kind"] for word in made.update()["constraints"]], [told])
        source = quadrille.vtkQuadConstraintSource()
        source.SetKind(getattr(source, kind))
        points = numpy.asarray(places, dtype=float)
        source.SetNumberOfPoints(len(points))
        for i, p in enumerate(points):
            source.SetPoint(i, *p)
        source.SetValence(valence)
        source.SetRadius(radius)
        run = quadrille.vtkQuadRemesh()
        run.SetInputDataObject(quadrille.to_polydata(*mesh))
        run.SetNumberOfQuads(quads)
        run.SetNumberOfThreads(2)
        run.AddConstraintsConnection(source.GetOutputPort())
        run.Update()
        self.assertTrue(same(quadrille.to_arrays(run.GetOutput()), expected))
        word, row = made.update()["constraints"][0], run.GetConstraintTable()
        self.assertEqual(row.GetValueByName(0, "Met").ToInt(), int(word["met"]))
        if kind in ("CLEARED_FEATURE", "SIZE"):
            self.assertAlmostEqual(row.GetValueByName(0, "Deviation").ToDouble(), word["deviation"], 6)
        lines = {"FEATURE_CURVE": "curves", "GUIDING_STROKE": "strokes", "CONNECTION": "connections",
                 "CYCLE": "cycles", "CLEARED_FEATURE": "cleared"}
        if kind == "SIZE":
            lines[kind] = "sizes"
        if kind in lines:
            more = {lines[kind]: [points] if len(points) > 1 else points}
            if kind == "SIZE":
                more = {"sizes": [(points[0], radius, 0.5)]}
                radius = 0
            if radius:
                more["stroke_radius"] = radius
            self.assertTrue(same(quadrille.to_arrays(quadrille.remesh(mesh, quads=quads, threads=2, **more)), expected))
        return made

    def on_a_surface(self, mesh, quads):
        points, faces = mesh
        corners = points[faces]
        areas = numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        a, b, c = corners[numpy.argmax(areas)]
        p, q = 0.5 * a + 0.3 * b + 0.2 * c, 0.2 * a + 0.3 * b + 0.5 * c
        length = float(numpy.linalg.norm(q - p))
        self.check(mesh, quads, lambda made: made.add_feature([p, q]), "feature", "FEATURE_CURVE", [p, q])
        self.check(mesh, quads, lambda made: made.add_guide([p, q], radius=0.2 * length), "guide", "GUIDING_STROKE",
                   [p, q], radius=0.2 * length)
        self.check(mesh, quads, lambda made: made.set_valence(p, 3), "valence", "VALENCE", [p])
        self.check(mesh, quads, lambda made: made.connect([p, q]), "connection", "CONNECTION", [p, q])
        return p, q

    def test_on_a_cube(self):
        mesh = cube()
        self.on_a_surface(mesh, 2400)
        ring = [(0.5, 0.5, 1), (1, 0.5, 0.5), (0.5, 0.5, 0), (0, 0.5, 0.5)]
        self.check(mesh, 2400, lambda made: made.add_cycle(ring), "cycle", "CYCLE", ring)
        self.check(mesh, 2400, lambda made: made.clear_feature((0.5, 0, 1)), "cleared feature", "CLEARED_FEATURE",
                   [(0.5, 0, 1)])
        self.check(mesh, 2400, lambda made: made.set_size((0.5, 0.5, 1), 0.5, radius=0.2), "size", "SIZE",
                   [(0.5, 0.5, 1)], radius=0.2)

    def test_on_a_part(self):
        mesh = part()
        self.on_a_surface(mesh, 3000)
        irregular = quadrille.Session(mesh, quads=3000, threads=2).irregular()
        origin = irregular.point[numpy.argmax(irregular.point[:, 2])]
        target = 0.9 * origin + (0, 0, 0.1 * origin[2])
        self.check(mesh, 3000, lambda made: made.move_irregular(origin, target), "irregular", "MOVE", [origin, target])


class Failures(unittest.TestCase):
    def test_a_size_without_a_map_is_left_out(self):
        hexadecimal = float.fromhex
        place = [hexadecimal("-0x1.a4826af9da194p+5"), hexadecimal("0x1.92512b9b7f447p+5"),
                 hexadecimal("0x1.f7bcc5beddb3ap+2")]
        made = quadrille.Session(part(), quads=5000, threads=1)
        made.set_size(place, hexadecimal("0x1.123e2b070a7bdp-1"), radius=hexadecimal("0x1.4b039ca80dc56p+3"))
        word = made.update()["constraints"][0]
        self.assertGreater(len(made.quads[1]), 4000)
        self.assertTrue(word["met"] or "no valid map" in word["reason"], word)


class Topology(unittest.TestCase):
    @staticmethod
    def euler(made):
        points, quads = made.quads
        edges = numpy.unique(numpy.sort(numpy.stack((quads.ravel(), numpy.roll(quads, -1, axis=1).ravel())), axis=0),
                             axis=1)
        return len(points) - edges.shape[1] + len(quads)

    def test_a_line_beside_a_handle_is_met(self):
        part = pathlib.Path(__file__).resolve().parents[2] / "Data" / "part.ply"
        made = quadrille.Session(quadrille.read(str(part)), quads=250, threads=1)
        made.update()
        before = self.euler(made)
        # Beside a handle that quads of this size have to be smaller for.
        made.add_feature([[47.69231033325195, 23.111112594604492, 12], [35.00270080566406, 36.80562973022461, 10.5]])
        report = made.update()
        self.assertEqual(self.euler(made), before)
        self.assertTrue(report["constraints"][0]["met"], report["constraints"][0]["reason"])


if __name__ == "__main__":
    unittest.main()
