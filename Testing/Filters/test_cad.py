#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""CAD files in the command and in Python: features, names as sets, nodes on the exact shape, by cad_measure.

  test_cad.py QUADRILLE CAD_SHAPES CAD_MEASURE WORK_DIR
"""
import os
import pathlib
import subprocess
import sys
import unittest

import numpy
import vtkmodules.vtkIOXML  # noqa: F401, so that Python knows the class of the reader
from vtkmodules.util.numpy_support import vtk_to_numpy

import quadrille

COMMAND, SHAPES, MEASURE, WORK = sys.argv[1:5]
FOLDER = pathlib.Path(WORK)


def run(*words):
    return subprocess.run([COMMAND, *map(str, words)], capture_output=True, text=True)


def arrays(mesh):
    data = mesh.GetPointData()
    return (vtk_to_numpy(mesh.GetPoints().GetData()), vtk_to_numpy(data.GetArray("CadPlace")),
            vtk_to_numpy(data.GetArray("CadId")))


def distances(part, mesh):
    """Of nodes that are on the shape, from what they are on, over the diagonal; exact area and volume."""
    points, place, ids = arrays(mesh)
    nodes = FOLDER / "nodes.bin"
    on = place > 0
    numpy.column_stack((points[on], place[on], ids[on])).astype(float).tofile(nodes)
    text = subprocess.run([MEASURE, part, nodes], capture_output=True, text=True, check=True).stdout
    numbers = numpy.array(text.split(), dtype=float)
    return numbers[3:] / numbers[0], numbers[1], numbers[2]


def area(points, quads):
    a, b, c, d = (points[quads[:, i]] for i in range(4))
    return (numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1) +
            numpy.linalg.norm(numpy.cross(c - a, d - a), axis=1)).sum() / 2


class Module(unittest.TestCase):
    """Open CASCADE is in a module of its own, which is opened with the first CAD file."""

    def test_nothing_is_linked_with_it(self):
        listed = subprocess.run(["ldd", COMMAND], capture_output=True, text=True, check=True).stdout
        self.assertIn("libQuadrilleFilters", listed)
        self.assertNotIn("libTK", listed)

    def test_it_is_opened_with_the_first_cad_file(self):
        code = ("import quadrille, sys; has = lambda: 'libTKernel' in open('/proc/self/maps').read();"
                "quadrille.remesh(([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]), quads=30);"
                "before = has(); quadrille.read_cad(sys.argv[1]); print(before, has())")
        result = subprocess.run([sys.executable, "-c", code, FOLDER / "named.step"], capture_output=True, text=True)
        self.assertEqual(result.stdout.split(), ["False", "True"], result.stderr)

    def test_a_missing_module_is_told(self):
        listed = subprocess.run(["ldd", COMMAND], capture_output=True, text=True, check=True).stdout
        library = next(line.split()[2] for line in listed.splitlines() if "libQuadrilleFilters" in line)
        alone = FOLDER / "alone"
        alone.mkdir(exist_ok=True)
        (alone / pathlib.Path(library).name).unlink(missing_ok=True)
        (alone / pathlib.Path(library).name).symlink_to(library)

        def run_alone(source, target):
            return subprocess.run([COMMAND, source, target, "--quads", "100"], capture_output=True, text=True,
                                  env=dict(os.environ, LD_LIBRARY_PATH=str(alone)))

        result = run_alone(FOLDER / "named.step", FOLDER / "alone.inp")
        self.assertEqual(result.returncode, 2)
        self.assertIn("QuadrilleCad.so, which cannot be loaded", result.stderr)
        self.assertIn("Install Quadrille again", result.stderr)
        (FOLDER / "plain.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.assertEqual(run_alone(FOLDER / "plain.obj", FOLDER / "plain.vtp").returncode, 0)


class Cad(unittest.TestCase):
    def test_names_of_faces_are_sets(self):
        result = run(FOLDER / "named.step", FOLDER / "named.inp", "--quads", 800)
        self.assertEqual(result.returncode, 0, result.stderr)
        text = (FOLDER / "named.inp").read_text().upper()
        for name in ("SUPPORT", "BORE", "FACE_2"):
            self.assertIn(f"ELSET={name}\n", text)

    def test_parts_of_an_assembly_are_in_the_names(self):
        result = run(FOLDER / "assembly.step", FOLDER / "assembly.msh", "--quads", 800)
        self.assertEqual(result.returncode, 0, result.stderr)
        text = (FOLDER / "assembly.msh").read_text()
        self.assertIn('"left/FACE_1"', text)
        self.assertIn('"right/FACE_7"', text)

    def test_nodes_lie_on_the_exact_shape(self):
        for name in ("named.step", "rounded.step"):
            for order, extension in ((1, "vtp"), (2, "vtu")):
                mesh = FOLDER / f"nodes.{extension}"
                result = run(FOLDER / name, mesh, "--quads", 600, "--order", order)
                self.assertEqual(result.returncode, 0, result.stderr)
                if order == 1:
                    data = quadrille.read(mesh)
                else:
                    reader = quadrille.QuadrilleFilters.vtkQuadrilleFileReader.NewXMLReader(".vtu")
                    reader.SetFileName(str(mesh))
                    reader.Update()
                    data = reader.GetOutput()
                away, _, _ = distances(FOLDER / name, data)
                _, place, _ = arrays(data)
                self.assertEqual((place == 0).sum(), 0)
                self.assertLess(away.max(), 1e-9, (name, order))
        result = run(FOLDER / "rounded.step", FOLDER / "raw.vtp", "--quads", 600, "--cad-nodes", "triangles")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIsNone(quadrille.read(FOLDER / "raw.vtp").GetPointData().GetArray("CadPlace"))

    def test_sharp_edges_and_corners_are_kept(self):
        quads = quadrille.on_cad_geometry(quadrille.remesh(quadrille.read(FOLDER / "named.step"), quads=800))
        points, place, _ = arrays(quads)
        corners = {tuple(p) for p in numpy.round(points[place == 3], 9)}
        for x in (0, 4):
            for y in (0, 3):
                for z in (0, 2):
                    self.assertIn((x, y, z), corners)
        # All nodes of the rims of the hole have its radius, and the rims are there.
        rim = (place == 2) & (numpy.hypot(points[:, 0] - 2, points[:, 1] - 1.5) < 0.6)
        self.assertGreater(rim.sum(), 8)
        self.assertLess(abs(numpy.hypot(points[rim, 0] - 2, points[rim, 1] - 1.5) - 0.5).max(), 1e-12)

    def test_area_comes_nearer_with_the_square_of_the_size(self):
        part = FOLDER / "rounded.step"
        surface = quadrille.read_cad(part, chord_error=1e-4)
        errors = []
        for count in (500, 2000, 8000):
            quads = quadrille.on_cad_geometry(quadrille.remesh(surface, quads=count))
            _, exact, _ = distances(part, quads)
            points, faces = quadrille.to_arrays(quads)
            errors.append(abs(area(points, faces) / exact - 1) * len(faces))
        # Error times number of quads is constant; by half, as quads are of no exact size.
        for error in errors[1:]:
            self.assertLess(error, 1.5 * errors[0])

    def test_follow_says_which_edges_are_features(self):
        def edges(follow):
            surface = quadrille.read_cad(FOLDER / "rounded.step", follow=follow)
            bits = vtk_to_numpy(surface.GetCellData().GetArray("FeatureEdges"))
            return sum(bin(b).count("1") for b in bits)

        self.assertEqual(edges("none"), 0)
        self.assertGreater(edges("sharp"), 0)
        self.assertGreater(edges("all"), 2 * edges("sharp"))
        with self.assertRaisesRegex(quadrille.InvalidInput, "follow must be one of"):
            quadrille.read_cad(FOLDER / "rounded.step", follow="some")

    def test_blocks_are_instances(self):
        blocks = quadrille.read_cad(FOLDER / "assembly.step", join_parts=False)
        self.assertEqual(blocks.GetNumberOfBlocks(), 2)
        names = [blocks.GetMetaData(i).Get(blocks.NAME()) for i in range(2)]
        self.assertEqual(names, ["left", "right"])

    def test_info_has_no_bytes_of_the_shape(self):
        fields = quadrille.info(quadrille.read(FOLDER / "named.step"))
        self.assertNotIn("CadShape", fields)
        self.assertIn("support", fields["CadFaceNames"])
        self.assertIn("cylinder", fields["CadSurfaceKinds"])

    def test_damaged_files_are_told(self):
        whole = (FOLDER / "named.step").read_bytes()
        (FOLDER / "cut.step").write_bytes(whole[:len(whole) // 3])
        result = run(FOLDER / "cut.step", FOLDER / "cut.inp")
        self.assertEqual(result.returncode, 2)
        self.assertIn("cut.step", result.stderr)
        self.assertFalse((FOLDER / "cut.inp").exists())
        with self.assertRaisesRegex(quadrille.InvalidInput, "cut.step"):
            quadrille.read(FOLDER / "cut.step")
        result = run(FOLDER / "absent.step", FOLDER / "absent.inp")
        self.assertEqual(result.returncode, 2)
        self.assertIn("no such file", result.stderr)

    def test_what_is_of_no_cad_file_is_told(self):
        with self.assertRaisesRegex(quadrille.InvalidInput, "CadShape"):
            quadrille.on_cad_geometry(quadrille.to_polydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
                                                            [(0, 1, 2, 3)]))
        result = run(FOLDER / "part.ply", FOLDER / "out.inp", "--cad-follow", "all")
        self.assertEqual(result.returncode, 2)
        self.assertIn("is for CAD files", result.stderr)


if __name__ == "__main__":
    subprocess.run([SHAPES, FOLDER], check=True, stdout=subprocess.DEVNULL)
    unittest.main(argv=sys.argv[:1])
