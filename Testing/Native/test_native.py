# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""quadrille without VTK: the same quads as the command's, progress, stops, sessions, files, and nonsense.

  test_native.py DATA [COMMAND]    COMMAND: the program quadrille, to compare with
"""
import os
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy


class NoVtk:
    """There is no VTK, whatever this machine has."""

    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in ("vtkmodules", "vtk", "paraview"):
            raise ModuleNotFoundError(f"No module named {name!r} (kept away by the test)", name=name)
        return None


sys.meta_path.insert(0, NoVtk())
import quadrille  # noqa: E402, after VTK is out of the way

DATA, COMMAND = sys.argv[1], (sys.argv[2:] + [""])[0]
PART = os.path.join(DATA, "part.ply")


def plate(columns=24, rows=16):
    """A flat plate of triangles, one unit a square."""
    x, y = numpy.meshgrid(numpy.arange(columns + 1.0), numpy.arange(rows + 1.0))
    points = numpy.stack((x.ravel(), y.ravel(), numpy.zeros(x.size)), axis=1)
    corner = (numpy.arange(rows)[:, None] * (columns + 1) + numpy.arange(columns)).ravel()
    up = columns + 1
    return points, numpy.concatenate((numpy.stack((corner, corner + 1, corner + up + 1), axis=1),
                                      numpy.stack((corner, corner + up + 1, corner + up), axis=1)))


class Quads(unittest.TestCase):
    @unittest.skipUnless(COMMAND, "there is no command to compare with")
    def test_quads_are_those_of_the_command(self):
        part = quadrille.read(PART)
        for options, arguments in (({}, []), ({"feature_angle": 60.0}, ["--feature-angle", "60"])):
            with tempfile.TemporaryDirectory() as folder:
                theirs, ours = (os.path.join(folder, name) for name in ("theirs.obj", "ours.obj"))
                subprocess.run([COMMAND, PART, theirs, "--quads", "1000", "--quiet", *arguments], check=True)
                quadrille.write(quadrille.remesh(part, quads=1000, **options), ours)
                with open(theirs, "rb") as first, open(ours, "rb") as second:
                    self.assertEqual(first.read(), second.read())

    def test_a_result_is_a_pair_with_arrays(self):
        made = quadrille.remesh(quadrille.read(PART), quads=500)
        points, quads = made
        self.assertEqual(quads.shape[1], 4)
        self.assertLess(quads.max(), len(points))
        for name, values in made.point_data.items():
            self.assertEqual(len(values), len(points), name)
        for name in ("PatchId", "LayoutPatch", "FeatureEdges", "SourceCellId"):
            self.assertEqual(len(made.cell_data[name]), len(quads))
        told = quadrille.info(made)
        self.assertEqual(told["ActualQuads"], len(quads))
        self.assertEqual(told["CertificateValid"], 1)
        self.assertIn("extract", told["stages"])
        numpy.testing.assert_array_equal(quadrille.to_arrays(made)[1], quads)

    def test_where_points_come_from(self):
        points, faces = plate()
        made = quadrille.remesh((points, faces), quads=150)
        ids, weights = made.point_data["SourcePointIds"], made.point_data["SourceBarycentric"]
        numpy.testing.assert_allclose((points[ids] * weights[:, :, None]).sum(axis=1), made.points, atol=1e-9)

    def test_everything(self):
        points, faces = plate()
        made = quadrille.remesh((points, faces), quads=100, curves=[[[12, -0.1, 0], [12, 16.1, 0]]],
                                target_valence={4 + 25 * 12: 5}, everything=True)
        self.assertEqual([row["kind"] for row in made.info["constraints"]], ["valence", "feature curve"])
        self.assertTrue(made.info["constraints"][1]["met"])
        inner = made.lines.faces[made.lines.cell_data["Boundary"] == 0]
        numpy.testing.assert_array_equal(made.lines.points[inner][:, :, 0], 12)
        self.assertEqual(made.surface.cell_data["IGM"].shape, (len(made.surface.faces), 6))
        self.assertGreater(len(made.separatrices.faces), 0)

    def test_symmetry_and_preview(self):
        box = (numpy.array([(x, y, z) for x in (0, 1) for y in (0, 2) for z in (0, 3)], float),
               [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
        made = quadrille.remesh(box, quads=200, symmetry=((0.5, 1, 1.5), (0, -2, 0)))
        image = made.point_data["MirrorPoint"]
        self.assertLess(numpy.abs(made.points * (1, -1, 1) + (0, 2, 0) - made.points[image]).max(), 1e-11)
        turned = quadrille.remesh(box, quads=200, rotation=(2, (0.5, 1, 0), (0, 0, 1))).point_data["RotatedPoint"]
        numpy.testing.assert_array_equal(turned[turned], numpy.arange(len(turned)))
        preview, whole = (quadrille.remesh(quadrille.read(PART), quads=500, preview=flag) for flag in (True, False))
        self.assertEqual(len(preview.faces), len(whole.faces))


class Running(unittest.TestCase):
    def test_progress(self):
        told = []
        quadrille.remesh(plate(), quads=150, progress=lambda fraction, text: told.append((fraction, text)))
        fractions = [fraction for fraction, _ in told]
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual(fractions[-1], 1)
        self.assertTrue(all(isinstance(text, str) for _, text in told))

    def test_a_stop(self):
        with self.assertRaisesRegex(quadrille.RemeshError, "stopped on request"):
            quadrille.remesh(plate(), quads=150, progress=lambda fraction, text: False)
        with self.assertRaisesRegex(quadrille.RemeshError, "time limit of 1e-06 s"):
            quadrille.remesh(plate(), quads=150, time_limit=1e-6)

    def test_what_progress_raises_is_raised(self):
        def progress(fraction, text):
            raise KeyError("mine")
        with self.assertRaisesRegex(KeyError, "mine"):
            quadrille.remesh(plate(), quads=150, progress=progress)
        session = quadrille.Session(plate(), quads=100, progress=lambda fraction: 1 / 0)
        with self.assertRaises(ZeroDivisionError):
            session.update()

    def test_an_interrupt_ends_a_run(self):
        # What a shell starts in the background has it ignored.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            for _ in range(1000):
                quadrille.remesh(quadrille.read(PART), quads=3000)
        timer.join()

    def test_other_threads_go_on(self):
        counted, done = [0], threading.Event()

        def count():
            while not done.wait(0.001):
                counted[0] += 1
        thread = threading.Thread(target=count)
        thread.start()
        try:
            quadrille.remesh(quadrille.read(PART), quads=1000)
        finally:
            done.set()
            thread.join()
        self.assertGreater(counted[0], 20)


class Sessions(unittest.TestCase):
    def test_ten_edits(self):
        session = quadrille.Session(plate(), quads=300)
        session.update()
        first = session.quads
        session.set_valence([6, 8, 0], 5)
        session.add_feature([[12, 0, 0], [12, 16, 0]])
        session.set_size([20, 12, 0], factor=0.6, radius=3)
        guide = session.add_guide([[3, 3, 0], [9, 9, 0]], weight=0.8, radius=1)
        session.update()
        session.add_guide([[3, 3, 0], [9, 8, 0]], edit=guide)
        session.remove(guide)
        session.set_settings(smoothing_steps=3)
        session.state("here")
        session.set_settings(quads=350)
        report = session.update()
        self.assertEqual([row["kind"] for row in report["constraints"]], ["valence", "feature", "size"])
        self.assertEqual(session.states(), ["here"])
        session.go_to("here")
        self.assertTrue(session.undo() and session.redo())
        self.assertIn("settings", session.compare("here"))
        points, quads = session.preview()
        self.assertEqual(quads.shape[1], 4)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "a.session")
            session.save(file)
            again = quadrille.Session.load(file, plate())
        for mine, theirs in zip(session.quads, again.quads):
            numpy.testing.assert_array_equal(mine, theirs)
        self.assertEqual(session.irregular().point.shape[1], 3)
        while session.undo():
            pass
        for mine, theirs in zip(session.quads, first):
            numpy.testing.assert_array_equal(mine, theirs)


class Files(unittest.TestCase):
    def test_what_is_written_is_read(self):
        made = quadrille.remesh(quadrille.read(PART), quads=500)
        with tempfile.TemporaryDirectory() as folder:
            for extension in ("inp", "msh", "mesh", "obj", "ply", "stl"):
                path = os.path.join(folder, "quads." + extension)
                quadrille.write(made, path)
                self.assertGreater(os.path.getsize(path), 10000)
                if extension in ("obj", "ply"):
                    points, faces = quadrille.read(path)
                    numpy.testing.assert_allclose(points, made.points, atol=1e-4)
                    # Those of obj are by patch.
                    by_patch = numpy.argsort(made.cell_data["PatchId"], kind="stable")
                    expected = made.faces[by_patch] if extension == "obj" else made.faces
                    numpy.testing.assert_array_equal(faces, expected)
            with open(os.path.join(folder, "quads.inp"), encoding="utf-8") as deck:
                self.assertIn("PATCH_", deck.read())
            binary = quadrille.read(os.path.join(folder, "quads.stl"))
            text = os.path.join(folder, "text.stl")
            with open(text, "w", encoding="utf-8") as file:
                file.write("solid a\n")
                for a, b, c in binary.points[binary.faces].astype("f4").tolist():
                    corners = "".join(f"vertex {p[0]!r} {p[1]!r} {p[2]!r}\n" for p in (a, b, c))
                    file.write(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
                file.write("endsolid a\n")
            again = quadrille.read(text)
            numpy.testing.assert_array_equal(again.points, binary.points)
            numpy.testing.assert_array_equal(again.faces, binary.faces)
            off = os.path.join(folder, "a.off")
            with open(off, "w", encoding="utf-8") as file:
                file.write("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 7\n3 0 2 3 8\n")
            self.assertEqual(quadrille.read(off).cell_data["ColorIndex"].tolist(), [7, 8])


def nonsense(folder):
    """Twenty calls, each with what the message has to have."""
    points, faces = plate()
    mesh = points, faces
    damaged = os.path.join(folder, "damaged.ply")
    with open(damaged, "w", encoding="utf-8") as file:
        file.write("ply\nformat ascii 1.0\nelement vertex what\n")
    bad_obj = os.path.join(folder, "bad.obj")
    with open(bad_obj, "w", encoding="utf-8") as file:
        file.write("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 9\n")
    infinite = points.copy()
    infinite[17, 1] = numpy.inf
    remesh, session = quadrille.remesh, quadrille.Session(mesh, quads=100)
    return [
        (lambda: remesh(None), "NoneType"),
        (lambda: remesh("part.ply"), "quadrille.read"),
        (lambda: remesh((points[:, :2], faces)), "column of zeros"),
        (lambda: remesh((infinite, faces)), "point 17"),
        (lambda: remesh((points, faces + 1)), "begin at 1"),
        (lambda: remesh((points, faces.ravel())), "reshape"),
        (lambda: remesh((points, [])), "no faces"),
        (lambda: remesh(mesh, quads=-5), "quads"),
        (lambda: remesh(mesh, quads=10, edge_length=1), "only one"),
        (lambda: remesh(mesh, feature_angle="sharp"), "feature_angle"),
        (lambda: remesh(mesh, method="best"), "scale-aware"),
        (lambda: remesh(mesh, sizing=numpy.zeros(len(points))), "Sizing"),
        (lambda: remesh(mesh, target_valence={0: 99}), "TargetValence"),
        (lambda: remesh(mesh, guiding_direction=[[numpy.nan] * 3] * len(faces)), "GuidingDirection"),
        (lambda: remesh(mesh, symmetry=((0, 0, 0), (0, 0, 0))), "normal"),
        (lambda: quadrille.read(os.path.join(folder, "absent.ply")), "no such file"),
        (lambda: quadrille.read(damaged), "damaged.ply"),
        (lambda: quadrille.read(bad_obj), "line 4"),
        (lambda: quadrille.write(mesh, os.path.join(folder, "a.obj")), "quads"),
        (lambda: session.add_guide([[0, 0, 0]], weight="much"), "weight"),
    ]


class SizesByName(unittest.TestCase):
    """Of a plate of two patches, one of which gets smaller quads."""

    def named_plate(self):
        points, faces = plate()
        left = points[faces].mean(axis=1)[:, 0] < points[:, 0].mean()
        valences = numpy.arange(len(points), dtype=numpy.int32) % 2 * 4
        return quadrille.Mesh(points, faces, point_data={"TargetValence": valences, "x": points[:, 0].copy()},
                              cell_data={"PatchNames": numpy.where(left, "left", "right").astype(object)})

    def test_faces(self):
        surface = self.named_plate()
        sized = quadrille.sizes_by_name(surface, {"l*t": 0.5})
        left = (sized.cell_data["PatchNames"] == "left")
        self.assertEqual(set(sized.point_data["Sizing"][sized.faces[left]].ravel()), {numpy.float32(0.5)})
        self.assertEqual(set(sized.point_data["Sizing"]), {numpy.float32(0.5), numpy.float32(1)})
        numpy.testing.assert_allclose(sized.point_data["x"], sized.points[:, 0], atol=1e-12)
        self.assertTrue((sized.point_data["TargetValence"][len(surface.points):] == 0).all())

    def test_names_that_nothing_has(self):
        with self.assertRaisesRegex(quadrille.InvalidInput, 'is called "lift"; the nearest of 2 names are left, right'):
            quadrille.sizes_by_name(self.named_plate(), {"lift": 0.5})
        with self.assertRaisesRegex(quadrille.InvalidInput, "has no names"):
            quadrille.sizes_by_name(quadrille.Mesh(*plate()), {"left": 0.5})
        with self.assertRaisesRegex(quadrille.InvalidInput, "triangulate"):
            quadrille.sizes_by_name(quadrille.Mesh([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)]),
                                    {"left": 0.5})

    def test_blocks(self):
        both = quadrille.sizes_by_name({"a": self.named_plate(), "b": self.named_plate()}, {"b/left": 0.5})
        self.assertEqual([float(both[name].point_data["Sizing"].min()) for name in ("a", "b")], [1, 0.5])


class Nonsense(unittest.TestCase):
    def test_twenty(self):
        with tempfile.TemporaryDirectory() as folder:
            calls = nonsense(folder)
            self.assertEqual(len(calls), 20)
            for call, word in calls:
                with self.subTest(word=word), self.assertRaises(quadrille.InvalidInput) as caught:
                    call()
                self.assertIn(word, str(caught.exception))

    def test_what_is_missing_says_so(self):
        points, faces = quadrille.remesh(plate(), quads=50)
        for call in (lambda: quadrille.elements((points, faces)), lambda: quadrille.repair(plate()),
                     lambda: quadrille.wrap(plate()), lambda: quadrille.remesh(plate(), wrap=1.0),
                     lambda: quadrille.remesh(plate(), cell_data="area")):
            with self.assertRaisesRegex(quadrille.RemeshError, "wheel"):
                call()
        with self.assertRaisesRegex(AttributeError, "wheel"):
            quadrille.vtkQuadRemesh  # noqa: B018
        with self.assertRaises(OSError):
            quadrille.write((points, faces), "/absent/folder/a.obj")
        with self.assertRaisesRegex(quadrille.InvalidInput, "vtu"):
            quadrille.write((points, faces), "a.vtu")


@unittest.skipUnless(quadrille.has_cad(), "this build has no Open CASCADE")
class Cad(unittest.TestCase):
    BRACKET = os.path.join(DATA, "bracket.step")

    @unittest.skipUnless(COMMAND, "there is no command to compare with")
    def test_nodes_are_those_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            theirs, ours = (os.path.join(folder, name) for name in ("theirs.obj", "ours.obj"))
            part = quadrille.read(self.BRACKET)
            sizes = {"bore": 0.5, "EDGE_1": 0.6, "VERTEX_2": 0.7}
            for surface, options, arguments in (
                    (part, {}, []), (part, {"angle_a_quad": 10.0}, ["--angle-a-quad", "10"]),
                    (quadrille.sizes_by_name(part, sizes), {}, [f"--size={name}={of}" for name, of in sizes.items()])):
                subprocess.run([COMMAND, self.BRACKET, theirs, "--quads", "800", "--quiet", *arguments], check=True)
                quads = quadrille.remesh(surface, quads=800, **options)
                quadrille.write(quadrille.on_cad_geometry(quads), ours)
                with open(theirs, "rb") as first, open(ours, "rb") as second:
                    self.assertEqual(first.read(), second.read())

    def test_what_is_known_of_a_part(self):
        part = quadrille.read_cad(self.BRACKET)
        self.assertEqual(set(part.cell_data["PatchNames"]), set(part.field_data["CadFaceNames"]))
        self.assertIn("bore", part.field_data["CadFaceNames"])
        self.assertEqual(sorted(set(part.field_data["CadSurfaceKinds"])), ["cylinder", "plane"])
        quads = quadrille.on_cad_geometry(quadrille.remesh(part, quads=800))
        self.assertEqual(quadrille.info(quads)["NodesOffGeometry"], 0)
        self.assertNotIn("KnownCurvature", quads.cell_data)
        bore = quads.faces[quads.cell_data["PatchNames"] == "bore"]
        curvatures = abs(quads.point_data["CadCurvature"][quads.point_data["CadPlace"] == 1])
        numpy.testing.assert_allclose(curvatures.max(), 1 / 0.5, rtol=1e-6)
        self.assertEqual(set(quads.point_data["CadPlace"]), {1, 2, 3})
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bracket.inp")
            quadrille.write(quads, path)
            with open(path) as file:
                self.assertIn("ELSET=BORE", file.read().upper().replace(" ", ""))
        self.assertGreater(len(bore), 20)

    def test_damaged_files_and_meshes_without_a_shape(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "cut.step")
            with open(self.BRACKET, "rb") as whole, open(path, "wb") as cut:
                cut.write(whole.read()[:3000])
            for call in (lambda: quadrille.read(path), lambda: quadrille.read(os.path.join(folder, "none.step"))):
                with self.assertRaises(quadrille.InvalidInput):
                    call()
        for mesh in (quadrille.remesh(quadrille.read(PART), quads=300), quadrille.read(self.BRACKET)):
            with self.assertRaises(quadrille.InvalidInput):
                quadrille.on_cad_geometry(mesh)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
