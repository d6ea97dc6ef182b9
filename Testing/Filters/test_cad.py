#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""CAD files in the command and in Python: features, names as sets, nodes on the exact shape, by cad_measure.

  test_cad.py QUADRILLE CAD_SHAPES CAD_MEASURE WORK_DIR
"""
import ctypes
import os
import pathlib
import subprocess
import sys
import unittest

import numpy
import vtkmodules.vtkIOXML  # noqa: F401, so that Python knows the class of the reader
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
from vtkmodules.vtkIOExodus import vtkExodusIIReader

import quadrille

try:
    import meshio
except ImportError:  # its tests are left out, and say so
    meshio = None

COMMAND, SHAPES, MEASURE, WORK = sys.argv[1:5]
FOLDER = pathlib.Path(WORK)
KEPT = []  # what has to last as long as the process


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

        paths = os.pathsep.join([str(alone), *filter(None, [os.environ.get("LD_LIBRARY_PATH")])])

        def run_alone(source, target):
            return subprocess.run([COMMAND, source, target, "--quads", "100"], capture_output=True, text=True,
                                  env=dict(os.environ, LD_LIBRARY_PATH=paths))

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
            self.assertIn(f"NSET={name}\n", text)

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

    def test_a_damaged_file_is_read_once(self):
        """Each reading forks; another one comes with a change of the reader or of the file, and not by itself."""
        whole = (FOLDER / "named.step").read_bytes()
        (FOLDER / "cut.step").write_bytes(whole[:len(whole) // 3])
        reader = quadrille.QuadrilleFilters.vtkQuadrilleCADReader()
        reader.SetFileName(str(FOLDER / "cut.step"))
        reader.AddObserver("ErrorEvent", lambda caller, event: None)
        reader.GetExecutive().AddObserver("ErrorEvent", lambda caller, event: None)
        forks = []
        count = ctypes.CFUNCTYPE(None)(lambda: forks.append(1))
        getattr(ctypes.CDLL(None), "__register_atfork")(None, count, None, None)
        self.addCleanup(KEPT.append, count)  # which is never taken back
        reader.Update()
        self.assertIn("is damaged", reader.GetOutcomeText())
        self.assertEqual(len(forks), 1)
        reader.Update()
        self.assertEqual(len(forks), 1)
        reader.Modified()
        reader.Update()
        self.assertEqual(len(forks), 2)
        (FOLDER / "cut.step").write_bytes(whole)
        reader.Modified()
        reader.Update()
        self.assertEqual(reader.GetOutcomeText(), "")
        self.assertGreater(reader.GetOutputDataObject(0).GetNumberOfCells(), 0)

    def test_what_is_of_no_cad_file_is_told(self):
        with self.assertRaisesRegex(quadrille.InvalidInput, "CadShape"):
            quadrille.on_cad_geometry(quadrille.to_polydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
                                                            [(0, 1, 2, 3)]))
        result = run(FOLDER / "part.ply", FOLDER / "out.inp", "--cad-follow", "all")
        self.assertEqual(result.returncode, 2)
        self.assertIn("is for CAD files", result.stderr)


NEAR = 1e-6  # readers may give single precision


def near_rim(points):
    return (abs(numpy.hypot(points[:, 0] - 2, points[:, 1] - 1.5) - 0.5) < NEAR) & (abs(points[:, 2] - 2) < NEAR)


def near_front(points):
    return (abs(points[:, 1]) < NEAR) & (abs(points[:, 2]) < NEAR)


def near_origin(points):
    return numpy.linalg.norm(points, axis=1) < NEAR


#: Named edges and vertices of named.step, and where they are.
NAMED = {"upper rim": near_rim, "front edge": near_front, "origin": near_origin}


class Notices(unittest.TestCase):
    def test_the_command_tells_each_once(self):
        text = (FOLDER / "named.step").read_text()
        self.assertIn("SI_UNIT(.MILLI.,.METRE.)", text)
        (FOLDER / "metres.step").write_text(text.replace("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT($,.METRE.)"))
        result = run(FOLDER / "metres.step", FOLDER / "metres.inp", "--quads", 200)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((result.stdout + result.stderr).count("the unit of the file is"), 1, result.stderr)

    def test_corners_without_a_node(self):
        """Quads of a whole box have nodes at all corners, the lower half of them none at the upper ones."""
        whole = quadrille.remesh(quadrille.read(FOLDER / "named.step"), quads=300)
        points, faces = quadrille.to_arrays(whole)
        lower = faces[(points[faces][:, :, 2] < 1.2).all(axis=1)]
        used, corners = numpy.unique(lower, return_inverse=True)
        half = quadrille.to_polydata(points[used], corners.reshape(-1, 4))
        half.GetFieldData().ShallowCopy(whole.GetFieldData())

        def told(quads):
            projection = quadrille.QuadrilleFilters.vtkQuadCADProjection()
            projection.SetInputData(quads)
            projection.Update()
            ids = projection.GetOutputDataObject(0).GetFieldData().GetArray("CadVerticesWithoutNode")
            return projection, ids.GetNumberOfValues() if ids else 0

        projection, count = told(whole)
        self.assertEqual((projection.GetNoticesText(), count), ("", 0))
        self.assertEqual(projection.GetVerdict(), f"All {len(points)} nodes lie on the exact shape")
        self.assertEqual(projection.GetOutputDataObject(1).GetNumberOfCells(), 0)
        projection, count = told(half)
        self.assertEqual(count, 4)
        wanted = r"4 corners of CAD edges .* have no node, the first at \(-?\d, \d, 2\): quads of"
        self.assertRegex(projection.GetNoticesText(), "^" + wanted)
        self.assertRegex(projection.GetVerdict(), f"^All {len(used)} nodes lie on the exact shape; " + wanted)
        # The places themselves are the second output.
        problems = projection.GetOutputDataObject(1)
        self.assertEqual(problems.GetNumberOfVerts(), 4)
        self.assertEqual(set(vtk_to_numpy(problems.GetCellData().GetArray("CadProblem"))), {0})
        self.assertEqual({tuple(p) for p in vtk_to_numpy(problems.GetPoints().GetData())},
                         {(x, y, 2) for x in (0, 4) for y in (0, 3)})
        # Of blocks all together, each with its name; far from the shape no node is put there.
        far = quadrille.to_polydata(points[used] + (0, 0, 50), corners.reshape(-1, 4))
        far.GetFieldData().ShallowCopy(whole.GetFieldData())
        blocks = vtkMultiBlockDataSet()
        for i, (name, block) in enumerate((("whole", whole), ("half", half), ("far", far))):
            blocks.SetBlock(i, block)
            blocks.GetMetaData(i).Set(blocks.NAME(), name)
        projection.SetInputData(blocks)
        projection.Update()
        self.assertEqual(projection.GetNodesOnGeometry(), len(points) + len(used))
        self.assertEqual(projection.GetNodesOffGeometry(), len(used))
        self.assertRegex(projection.GetNoticesText(), r"^12 corners .* the first at \(-?\d, \d, 2\) of half: quads of")
        self.assertRegex(projection.GetVerdict(), rf"^{len(used)} of {len(points) + 2 * len(used)} nodes stay on")
        kinds = vtk_to_numpy(projection.GetOutputDataObject(1).GetCellData().GetArray("CadProblem"))
        self.assertEqual((kinds == 1).sum(), len(used))
        output = projection.GetOutputDataObject(0)
        self.assertEqual([output.GetMetaData(i).Get(output.NAME()) for i in range(3)], ["whole", "half", "far"])


class Sets(unittest.TestCase):
    """Named edges and vertices of the file are sets, which other programs read."""

    def written(self, extension, *options):
        path = FOLDER / f"sets.{extension}"
        result = run(FOLDER / "named.step", path, "--quads", 800, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("without a set", result.stderr)
        return path

    def require_nodes(self, name, points, nodes):
        found = numpy.unique(nodes)
        self.assertEqual(set(found), set(numpy.flatnonzero(NAMED[name](points))), name)
        self.assertEqual(len(found), 1 if name == "origin" else len(found))
        self.assertGreater(len(found), 0 if name == "origin" else 4)

    @unittest.skipUnless(meshio, "package python3-meshio is missing")
    def test_inp_by_meshio(self):
        for order in (1, 2):
            mesh = meshio.read(self.written("inp", "--order", order))
            for name in NAMED:
                self.require_nodes(name, mesh.points, mesh.point_sets[name.upper().replace(" ", "_")])
        text = (FOLDER / "sets.inp").read_text()
        self.assertIn("*SURFACE, NAME=FRONT_EDGE_EDGES, TYPE=ELEMENT", text.upper())

    @unittest.skipUnless(meshio, "package python3-meshio is missing")
    def test_msh_by_meshio(self):
        for version in ("4.1", "2.2"):
            mesh = meshio.read(self.written("msh", "--msh-version", version))
            for name in NAMED:
                tag, dimension = mesh.field_data[name]
                self.assertEqual(dimension, 0 if name == "origin" else 1)
                cells = [block.data[groups == tag]
                         for block, groups in zip(mesh.cells, mesh.cell_data["gmsh:physical"])
                         if block.dim == dimension]
                self.require_nodes(name, mesh.points, numpy.concatenate([c.ravel() for c in cells]))

    def test_exodus_by_vtk(self):
        reader = vtkExodusIIReader()
        reader.SetFileName(str(self.written("ex2")))
        reader.GenerateGlobalNodeIdArrayOn()
        reader.UpdateInformation()
        for kind, wanted in ((reader.NODE_SET, NAMED), (reader.SIDE_SET, ("upper rim", "front edge"))):
            names = [reader.GetObjectName(kind, i) for i in range(reader.GetNumberOfObjects(kind))]
            for name in wanted:
                self.assertTrue(any(n.startswith(name) for n in names), (name, names))
                for i, other in enumerate(names):
                    reader.SetObjectStatus(kind, i, int(other.startswith(name)))
                reader.Update()
                leaves = reader.GetOutput().NewIterator()
                points = []
                while not leaves.IsDoneWithTraversal():
                    data = leaves.GetCurrentDataObject()
                    label = leaves.GetCurrentMetaData().Get(reader.GetOutput().NAME())
                    if label.startswith(name):
                        points.append(vtk_to_numpy(data.GetPoints().GetData()))
                    leaves.GoToNextItem()
                points = numpy.concatenate(points)
                self.assertGreater(len(points), 0 if name == "origin" else 4)
                self.assertTrue(NAMED[name](points).all(), name)

    def test_medit_names_them(self):
        text = self.written("mesh").read_text()
        for name, kind in (("upper rim", "edges"), ("front edge", "edges"), ("origin", "vertices")):
            self.assertRegex(text, rf"# {kind} [0-9]+: {name}\n")

    def test_names_without_nodes_are_told(self):
        result = run(FOLDER / "named.step", FOLDER / "raw.inp", "--quads", 600, "--cad-nodes", "triangles")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("without a set", " ".join(result.stderr.split()))
        self.assertNotIn("FRONT_EDGE", (FOLDER / "raw.inp").read_text().upper())


class Sizes(unittest.TestCase):
    def lengths(self, quads):
        """Of edges: middles and lengths."""
        points, faces = quadrille.to_arrays(quads)
        ends = numpy.unique(numpy.sort(numpy.concatenate(
            [faces[:, (i, (i + 1) % 4)] for i in range(4)]), axis=1), axis=0)
        a, b = points[ends[:, 0]], points[ends[:, 1]]
        return (a + b) / 2, numpy.linalg.norm(a - b, axis=1)

    def test_faces(self):
        """A face of half the size; away from it quads keep theirs."""
        part = quadrille.read(FOLDER / "named.step")
        sized = quadrille.sizes_by_name(part, {"bor?": 0.5})
        self.assertGreater(sized.GetNumberOfCells(), part.GetNumberOfCells())
        quads = quadrille.remesh(sized, edge_length=0.25)
        middles, lengths = self.lengths(quads)
        radius = numpy.hypot(middles[:, 0] - 2, middles[:, 1] - 1.5)
        on_bore = radius < 0.51
        self.assertLess(abs(numpy.median(lengths[on_bore]) / 0.125 - 1), 0.2)
        self.assertLess(abs(numpy.median(lengths[radius > 1.2]) / 0.25 - 1), 0.15)

    def test_exact_curvature(self):
        """Edges round a bore of radius 0.5 are as long as chord error or angle say, also where sizes by name have split
        the triangles; on plane faces those at its rims."""
        part = quadrille.read_cad(FOLDER / "named.step", chord_error=0.02)
        known = vtk_to_numpy(part.GetCellData().GetArray("KnownCurvature"))
        self.assertEqual(known.shape[1], 6)
        numpy.testing.assert_allclose(numpy.unique(known), [0, 2], atol=1e-5)
        named = quadrille.sizes_by_name(part, {"support": 0.7})
        self.assertGreater(named.GetNumberOfCells(), part.GetNumberOfCells())
        for surface in (part, named):
            for options in ({"chord_error": 0.004}, {"angle_a_quad": 14.5}):
                quads = quadrille.on_cad_geometry(quadrille.remesh(surface, edge_length=0.4, **options))
                points, faces = quadrille.to_arrays(quads)
                ends = numpy.unique(numpy.sort(numpy.concatenate(
                    [faces[:, (i, (i + 1) % 4)] for i in range(4)]), axis=1), axis=0)
                radius = numpy.hypot(points[:, 0] - 2, points[:, 1] - 1.5)
                a, b = points[ends[:, 0]], points[ends[:, 1]]
                round_bore = (abs(radius[ends] - 0.5) < 1e-6).all(axis=1) & (abs(a[:, 2] - b[:, 2]) < 1e-6)
                self.assertGreater(round_bore.sum(), 20)
                lengths = numpy.linalg.norm(a - b, axis=1)[round_bore]
                self.assertLess(abs(numpy.median(lengths) / 0.1265 - 1), 0.12, options)

    def test_edges_and_vertices(self):
        for name, near in (("front edge", lambda m: (m[:, 1] < 0.01) & (m[:, 2] < 0.01)),
                           ("origin", lambda m: numpy.linalg.norm(m, axis=1) < 0.1)):
            sized = quadrille.sizes_by_name(quadrille.read(FOLDER / "named.step"), {name: 0.4})
            middles, lengths = self.lengths(quadrille.remesh(sized, edge_length=0.25))
            self.assertGreater(near(middles).sum(), 0, name)
            # Round a vertex sizes grow again within the first quads.
            self.assertLess(numpy.median(lengths[near(middles)]), (0.8 if name == "origin" else 0.6) * 0.25, name)
            far = middles[:, 2] > 1.5
            self.assertLess(abs(numpy.median(lengths[far]) / 0.25 - 1), 0.15, name)

    def test_area_and_features_stay(self):
        part = quadrille.read(FOLDER / "rounded.step")
        sized = quadrille.sizes_by_name(part, {"FACE_1": 0.3, "EDGE_1": 0.5})

        def facts(surface):
            points, faces = quadrille.to_arrays(surface)
            a, b, c = (points[faces[:, i]] for i in range(3))
            bits = vtk_to_numpy(surface.GetCellData().GetArray("FeatureEdges"))
            features = sum(numpy.linalg.norm(p - q, axis=1)[(bits >> i) & 1 == 1].sum()
                           for i, (p, q) in enumerate(((a, b), (b, c), (c, a))))
            return numpy.array([numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1).sum(), features])

        self.assertGreater(sized.GetNumberOfCells(), part.GetNumberOfCells())
        numpy.testing.assert_allclose(facts(sized), facts(part), rtol=1e-12)

    def test_the_smallest_counts_and_the_last_of_one_name(self):
        part = quadrille.read(FOLDER / "named.step")
        sized = quadrille.sizes_by_name(part, {"*": 0.9, "support": 2, "FACE_*": 2, "bore": 1.5})
        sizing = vtk_to_numpy(sized.GetPointData().GetArray("Sizing"))
        self.assertEqual(set(numpy.round(sizing, 6)), {numpy.float32(0.9), numpy.float32(2), numpy.float32(1.5)} &
                         set(numpy.round(sizing, 6)))
        self.assertAlmostEqual(sizing.min(), 0.9, 6)  # edges and vertices of *

    def test_the_command(self):
        plain = run(FOLDER / "named.step", FOLDER / "plain.vtp", "--edge-length", 0.25)
        sized = run(FOLDER / "named.step", FOLDER / "sized.vtp", "--edge-length", 0.25, "--size", "bore=0.5",
                    "--size", "support = 0.5")
        for result in (plain, sized):
            self.assertEqual(result.returncode, 0, result.stderr)
        counts = [quadrille.read(FOLDER / f"{name}.vtp").GetNumberOfCells() for name in ("plain", "sized")]
        self.assertGreater(counts[1], 1.3 * counts[0])

    def test_a_session_takes_them(self):
        sized = quadrille.sizes_by_name(quadrille.read(FOLDER / "named.step"), {"bore": 0.5})
        session = quadrille.Session(sized, edge_length=0.25, feature_angle=None)
        session.update()
        middles, lengths = self.lengths(session.polydata)
        on_bore = numpy.hypot(middles[:, 0] - 2, middles[:, 1] - 1.5) < 0.51
        self.assertLess(abs(numpy.median(lengths[on_bore]) / 0.125 - 1), 0.2)

    def test_blocks(self):
        blocks = quadrille.read_cad(FOLDER / "assembly.step", join_parts=False)
        sized = quadrille.sizes_by_name(blocks, {"left/FACE_2": 0.5})
        least = [vtk_to_numpy(sized.GetBlock(i).GetPointData().GetArray("Sizing")).min() for i in range(2)]
        self.assertEqual(least, [0.5, 1])

    def test_unknown_names_list_near_ones(self):
        part = quadrille.read(FOLDER / "named.step")
        with self.assertRaisesRegex(quadrille.InvalidInput, 'is called "bores"; the nearest of .* names are bore, '):
            quadrille.sizes_by_name(part, {"bore": 0.5, "bores": 0.5})
        with self.assertRaisesRegex(quadrille.InvalidInput, "factors above 1 are for faces"):
            quadrille.sizes_by_name(part, {"upper rim": 2})
        with self.assertRaisesRegex(quadrille.InvalidInput, "above 0"):
            quadrille.sizes_by_name(part, {"bore": 0})
        with self.assertRaisesRegex(quadrille.InvalidInput, "has no names"):
            quadrille.sizes_by_name(quadrille.to_polydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]), {"a": 0.5})
        result = run(FOLDER / "named.step", FOLDER / "out.inp", "--size", "bor=0.5")
        self.assertEqual(result.returncode, 2)
        self.assertIn("bore", result.stderr)
        result = run(FOLDER / "named.step", FOLDER / "out.inp", "--size", "bore")
        self.assertEqual(result.returncode, 2)
        self.assertIn("fillet*=0.5", result.stderr)


if __name__ == "__main__":
    subprocess.run([SHAPES, FOLDER], check=True, stdout=subprocess.DEVNULL)
    unittest.main(argv=sys.argv[:1])
