# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Files with sets, read back by programs that are not ours: meshio, Gmsh, CalculiX, SciPy's NetCDF, VTK's readers.
Points, elements in their order and orientation, and the members of every set must be those that a second, simple
derivation of the sets finds here."""
import argparse
import collections
import contextlib
import io
import math
import os
import pathlib
import re
import resource
import shutil
import signal
import struct
import subprocess
import unittest

import gmsh
import meshio
import numpy
import quadrille
from quad_meshes import QUAD_CELLS, Mesh, Sets, add_strings, box, by_kind, data_of, grid, plate, second_order
from scipy.io import netcdf_file
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkBitArray, vtkIntArray, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkIOExodus import vtkExodusIIReader
from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

ARGS = None
REMESHED = {}  # models of Data/, each once


# ------------------------------------------------------------------------------------------------- readers
def read_silently(path):
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        return meshio.read(path)


class Gmsh:
    """A file in Gmsh: what its own reader makes of it."""

    def __init__(self, path):
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.logger.start()
        gmsh.open(str(path))
        self.log = [line for line in gmsh.logger.get() if line.startswith(("Warning", "Error"))]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        gmsh.logger.stop()
        gmsh.finalize()

    def points(self):
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        return coordinates.reshape(-1, 3)[numpy.argsort(tags)]

    def elements(self, dimension, entity=-1):
        """Node tags from 0 in the order of element tags."""
        rows = {}
        kinds, tags, nodes = gmsh.model.mesh.getElements(dimension, entity)
        for kind, of_kind, flat in zip(kinds, tags, nodes):
            for tag, row in zip(of_kind, numpy.asarray(flat).reshape(len(of_kind), -1)):
                rows[int(tag)] = [int(i) - 1 for i in row]
        return rows

    def groups(self, dimension):
        """Names with the elements of the group."""
        found = {}
        for _, tag in gmsh.model.getPhysicalGroups(dimension):
            rows = {}
            for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
                rows.update(self.elements(dimension, entity))
            found[gmsh.model.getPhysicalName(dimension, tag)] = rows
        return found


def exodus_by_netcdf(path):
    """Coordinates, elements in file order with their ids from 0, and the sets of an Exodus file, as the document
    SAND92-2137 has them."""
    def texts(variable):
        return [b"".join(row).split(b"\0")[0].decode() for row in variable[:]] if variable is not None else []

    with netcdf_file(str(path), "r", mmap=False) as file:
        v = file.variables
        points = numpy.stack([v[f"coord{axis}"][:] for axis in "xyz"], 1)
        order = v["elem_num_map"][:] - 1 if "elem_num_map" in v else v["elem_map"][:] - 1
        blocks, elements = {}, []
        for i, name in enumerate(texts(v["eb_names"])):
            rows = v[f"connect{i + 1}"]
            blocks[name] = [int(order[len(elements) + k]) for k in range(rows.shape[0])]
            assert rows.elem_type.decode().lower().startswith("quad"), rows.elem_type
            elements += [[int(n) - 1 for n in row] for row in rows[:]]
        nodes = {name: [int(n) - 1 for n in v[f"node_ns{i + 1}"][:]] for i, name in enumerate(texts(v.get("ns_names")))}
        sides = {name: [(int(order[e - 1]), int(s) - 1)
                        for e, s in zip(v[f"elem_ss{i + 1}"][:], v[f"side_ss{i + 1}"][:])]
                 for i, name in enumerate(texts(v.get("ss_names")))}
        by_id = [None] * len(elements)
        for place, element in enumerate(elements):
            by_id[order[place]] = element
        return points, by_id, blocks, nodes, sides


def run_calculix(deck, folder):
    """What CalculiX says, and the file of results."""
    (folder / "job.inp").write_text(deck)
    run = subprocess.run([shutil.which("ccx"), "-i", "job"], cwd=folder, capture_output=True, text=True, check=False,
                         env={**os.environ, "OMP_NUM_THREADS": "1"})
    results = folder / "job.dat"
    return run.stdout + run.stderr, results.read_text() if results.exists() else ""


def by_calculix(test):
    """A test that needs CalculiX, which not every release of Debian has."""
    test.by_calculix = True
    return test


# ------------------------------------------------------------------------------------------------- tests
class FormatTest(unittest.TestCase):
    def setUp(self):
        self.work = pathlib.Path(ARGS.work) / self.id().split(".")[-1]
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir(parents=True)

    def write(self, mesh, name, **options):
        path = self.work / name
        if not mesh.GetCellData().HasArray("PatchId") and mesh.GetCellData().HasArray("LayoutPatch"):
            options.setdefault("patch_array", "LayoutPatch")  # by default not of so many patches
        self.assertEqual(quadrille.write(mesh, path, **options), [])
        self.assertEqual([p.name for p in self.work.glob("*.part*")], [])
        return path

    def meshes(self):
        """All kinds, with and without boundary, features and corners, of first and second order."""
        for name, data in (("plate", plate()), ("box", box()), ("torus", torus()), ("ring", ring())):
            for nodes in (4, 8, 9):
                whole = data if nodes == 4 else second_order(data, nodes)
                yield f"{name}{nodes}", whole, grid(whole)
        for name in ("part", "frame"):
            if name not in REMESHED:
                REMESHED[name] = quadrille.remesh(quadrille.read(pathlib.Path(ARGS.data) / f"{name}.ply"), quads=1500)
            yield name, data_of(REMESHED[name]), REMESHED[name]

    def same_elements(self, found, data):
        self.assertEqual([list(map(int, row)) for row in found], [list(map(int, row)) for row in data.elements])

    def test_inp_by_meshio(self):
        for name, data, mesh in self.meshes():
            with self.subTest(name):
                if data.elements.shape[1] == 9:
                    continue  # meshio knows no shell of 9 nodes
                # meshio knows no element S8, but S8R.
                read = read_silently(self.write(mesh, f"{name}.inp"))
                sets = Sets(data)
                # At most 20 characters a number: all digits, or all but the last one or two.
                numpy.testing.assert_allclose(read.points, data.points, rtol=1e-14, atol=1e-16)
                self.same_elements(read.cells[0].data, data)
                named = {name: nodes for name, nodes in read.point_sets.items() if name != "NALL"}
                self.assertEqual(by_kind(named), sets.node_sets())
                patches = {k: set(map(int, v[0])) for k, v in read.cell_sets.items() if k in sets.patches}
                self.assertEqual(patches, dict(sets.patches))
                self.sides_of_loops(read, data, sets)

    def sides_of_loops(self, read, data, sets):
        """The element sets NAME_E1 to NAME_E4 are the sides of the loop."""
        loops = collections.defaultdict(set)
        for name, members in read.cell_sets.items():
            found = re.fullmatch(r"(BOUNDARY_\d+)_E([1-4])", name)
            if found:
                side = int(found.group(2)) - 1
                ends = [(data.elements[e][side], data.elements[e][(side + 1) % 4]) for e in members[0]]
                loops[found.group(1)] |= {frozenset(map(int, edge)) for edge in ends}
        self.assertEqual({frozenset(edges) for edges in loops.values()}, set(sets.loops))

    @by_calculix
    def test_inp_by_calculix(self):
        """CalculiX reads the deck without a warning, prints the members of each set, and loads act on the sides."""
        data = box(2)
        for nodes, dialect_type in ((4, "S4"), (8, "S8R")):
            with self.subTest(nodes):
                whole = data if nodes == 4 else second_order(data, nodes)
                path = self.write(grid(whole), f"mesh{nodes}.inp", element=dialect_type)
                sets = Sets(whole)
                names = re.findall(r"\*NSET, NSET=(\S+)", path.read_text())
                deck = f"*INCLUDE, INPUT={path.name}\n" + """*MATERIAL, NAME=STEEL
*ELASTIC
210000., 0.3
*SHELL SECTION, ELSET=EALL, MATERIAL=STEEL
0.1
*BOUNDARY
PATCH_8, 1, 3
PATCH_9, 1, 3
*STEP
*STATIC
*DLOAD
BOUNDARY_1_E3, EDNOR3, 2.
"""
                # Supports are for nodes: those of the bottom.
                bottom = sorted({int(n) + 1 for e in sets.patches["PATCH_8"] | sets.patches["PATCH_9"]
                                 for n in whole.elements[e]})
                deck = deck.replace("PATCH_8, 1, 3\nPATCH_9, 1, 3", "\n".join(f"{n}, 1, 3" for n in bottom))
                for name in names:
                    deck += f"*NODE PRINT, NSET={name}\nU\n"
                for name in sets.patches:
                    deck += f"*EL PRINT, ELSET={name}\nS\n"
                log, results = run_calculix(deck + "*END STEP\n", self.work)
                self.assertNotRegex(log.upper(), r"\*WARNING|\*ERROR")
                found = self.printed_sets(results)
                self.assertEqual(by_kind({name: found[name] for name in names}), sets.node_sets())
                for name, elements in sets.patches.items():
                    self.assertEqual(found[name], elements)
                self.assertIn("displacements", results)

    @staticmethod
    def printed_sets(results):
        """Members, from 0, of the tables of CalculiX; those of displacements and of stresses."""
        found = {}
        members = None
        for line in results.splitlines():
            title = re.search(r"for set (\S+) and time", line)
            if title:
                members = found.setdefault(title.group(1), set())
            elif line.strip() and members is not None:
                members.add(int(line.split()[0]) - 1)
        return found

    @by_calculix
    def test_inp_surfaces(self):
        """A pressure on the surface of a loop is the same force as on its sides by element sets: both solve."""
        data = plate(4, 4, 1)
        path = self.write(grid(data), "plane.inp", element="CPS4")
        self.assertIn("*ELEMENT, TYPE=CPS4,", path.read_text())
        deck = f"*INCLUDE, INPUT={path.name}\n" + """*MATERIAL, NAME=STEEL
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL
1.
*BOUNDARY
1, 1, 2
5, 2
*STEP
*STATIC
*DSLOAD
BOUNDARY_1_EDGES, P, 10.
*NODE PRINT, NSET=NALL
U
*END STEP
"""
        log, results = run_calculix(deck, self.work)
        self.assertNotRegex(log.upper(), r"\*WARNING|\*ERROR")
        # All round pressure p shrinks a plate without Poisson's effect by p / E everywhere.
        rows = [line.split() for line in results.splitlines() if re.match(r"\s+\d+\s", line)]
        self.assertEqual(len(rows), len(data.points))
        for row in rows:
            point = data.points[int(row[0]) - 1]
            for k in range(2):
                self.assertAlmostEqual(float(row[1 + k]), -0.01 * point[k], places=6)

    def with_cell_array(self, data, name, values):
        mesh = grid(data)
        array = numpy_to_vtk(numpy.asarray(values, float), deep=True)
        array.SetName(name)
        mesh.GetCellData().AddArray(array)
        return mesh

    def pulled(self, path, nodes_left, nodes_right, length):
        """The strain of a strip under one unit of stress times thickness in x, by CalculiX."""
        deck = f"*INCLUDE, INPUT={path.name}\n" + """*MATERIAL, NAME=PLY
*ELASTIC, TYPE=ENGINEERING CONSTANTS
100000., 10000., 10000., 0., 0., 0., 5000., 5000.,
5000., 293.
*NSET, NSET=LEFT
""" + ",\n".join(str(n + 1) for n in nodes_left) + "\n*NSET, NSET=RIGHT\n" + \
            ",\n".join(str(n + 1) for n in nodes_right) + f"""
*BOUNDARY
LEFT, 1
{nodes_left[0] + 1}, 2
NALL, 3
*STEP
*STATIC
*CLOAD
""" + "".join(f"{n + 1}, 1, {0.5 if n in (nodes_right[0], nodes_right[-1]) else 1.0}\n" for n in nodes_right) + """
*NODE PRINT, NSET=RIGHT
U
*END STEP
"""
        log, results = run_calculix(deck, self.work)
        self.assertNotRegex(log.upper(), r"\*WARNING|\*ERROR")
        moved = [float(line.split()[1]) for line in results.splitlines() if re.match(r"\s+\d+\s", line)]
        self.assertEqual(len(moved), len(nodes_right))
        return numpy.mean(moved) / length

    @by_calculix
    def test_thickness_and_axis_by_calculix(self):
        """Fibres along x carry ten times what those across do; half the thickness gives twice the strain."""
        data = plate(4, 2, 1)
        left, right = ([5 * j + i for j in range(3)] for i in (0, 4))
        count = len(data.elements)
        for kind in ("S4", "CPS4"):
            for axis, modulus in (((1, 0, 0), 1e5), ((0, 1, 0), 1e4)):
                for thickness in (1.0, 0.5):
                    with self.subTest(kind=kind, axis=axis, thickness=thickness):
                        mesh = self.with_cell_array(data, "ElementAxis", [axis] * count)
                        other = self.with_cell_array(data, "Thickness", [thickness] * count)
                        mesh.GetCellData().AddArray(other.GetCellData().GetArray("Thickness"))
                        path = self.write(mesh, "strip.inp", element=kind, material="PLY")
                        # Two units of force over a width of two.
                        strain = self.pulled(path, left, right, 4.0)
                        self.assertAlmostEqual(strain * modulus * thickness, 1, places=3)

    @by_calculix
    def test_axes_differ_by_element(self):
        """Two halves in a row, fibres along in one and across in the other: the strains add up."""
        data = plate(4, 2, 1)
        left, right = ([5 * j + i for j in range(3)] for i in (0, 4))
        axes = [(1, 0, 0) if e % 4 < 2 else (0, 1, 0) for e in range(len(data.elements))]
        for kind in ("S4", "CPS4"):
            with self.subTest(kind):
                mesh = self.with_cell_array(data, "ElementAxis", axes)
                ones = self.with_cell_array(data, "Thickness", [1.0] * len(axes))
                mesh.GetCellData().AddArray(ones.GetCellData().GetArray("Thickness"))
                path = self.write(mesh, "halves.inp", element=kind, material="PLY")
                self.assertAlmostEqual(self.pulled(path, left, right, 4.0) / (0.5 / 1e5 + 0.5 / 1e4), 1, places=2)

    @by_calculix
    def test_many_thicknesses_go_by_nodes(self):
        """A strip whose thickness grows along x: strain is the mean of 1 / t where t is linear."""
        data = plate(80, 1, 1)
        left, right = ([81 * j + i for j in range(2)] for i in (0, 80))
        thickness = [1 + (e + 0.5) / 80 for e in range(80)]
        mesh = self.with_cell_array(data, "Thickness", thickness)
        path = self.work / "wedge.inp"
        notices = quadrille.write(mesh, path, element="CPS4", material="PLY")
        self.assertEqual(len(notices), 1)
        self.assertIn("80 different thicknesses", notices[0])
        self.assertIn("*NODAL THICKNESS", path.read_text())
        self.assertNotIn("ORIENTATION", path.read_text())
        text = path.read_text().replace("MATERIAL=PLY", "MATERIAL=PLY, ORIENTATION=GLOBAL")
        path.write_text(text + "*ORIENTATION, NAME=GLOBAL\n1., 0., 0., 0., 1., 0.\n")
        strain = self.pulled(path, left, right, 80.0)
        # One unit of force over the width 1; the ends of the wedge are flat for half an element.
        self.assertAlmostEqual(strain * 1e5 / math.log(2), 1, places=2)

    def test_abaqus_dialect(self):
        data = plate(4, 2, 1)
        mesh = self.with_cell_array(data, "ElementAxis", [(1, 0, 0)] * len(data.elements))
        ones = self.with_cell_array(data, "Thickness", [2.0] * len(data.elements))
        mesh.GetCellData().AddArray(ones.GetCellData().GetArray("Thickness"))
        text = self.write(mesh, "abaqus.inp", dialect="abaqus").read_text()
        self.assertIn("*DISTRIBUTION TABLE, NAME=AXES_TABLE\nCOORD3D, COORD3D\n", text)
        self.assertIn("BOUNDARY_1_E1, E1\n", text)
        calculix = self.write(mesh, "calculix.inp").read_text()
        self.assertNotIn("*DISTRIBUTION", calculix)
        self.assertIn("BOUNDARY_1_E1, S3\n", calculix)

    def test_msh_by_gmsh(self):
        for name, data, mesh in self.meshes():
            for version in ("4.1", "2.2"):
                with self.subTest(name, version=version):
                    path = self.write(mesh, f"{name}.msh", msh_version=version)
                    self.assertEqual(path.read_text().splitlines()[1], f"{version} 0 8")
                    with Gmsh(path) as read:
                        self.assertEqual(read.log, [])
                        numpy.testing.assert_array_equal(read.points(), data.points)
                        rows = read.elements(2)
                        self.assertEqual(sorted(rows), list(range(1, len(data.elements) + 1)))
                        self.same_elements([rows[tag] for tag in sorted(rows)], data)
                        self.gmsh_sets(read, data)

    def gmsh_sets(self, read, data):
        sets = Sets(data)
        self.assertEqual({name: {tag - 1 for tag in rows} for name, rows in read.groups(2).items()},
                         dict(sets.patches))
        nodes = {name: {n for row in rows.values() for n in row} for name, rows in read.groups(1).items()}
        nodes.update({name: {n for row in rows.values() for n in row} for name, rows in read.groups(0).items()})
        self.assertEqual(by_kind(nodes), sets.node_sets())
        lines = read.elements(1).values()
        self.assertEqual({frozenset(line[:2]) for line in lines},
                         {edge for c in sets.loops + sets.curves for edge in c})
        for line in lines:
            if len(line) == 3:
                self.assertEqual(line[2], sets.middle[frozenset(line[:2])])

    def test_msh_topology(self):
        """In 4.1 each curve has its ends, and each patch the curves round it."""
        data = box()
        path = self.write(grid(data), "box.msh")
        with Gmsh(path) as read:
            self.assertEqual(len(gmsh.model.getEntities(2)), 10)
            for _, curve in gmsh.model.getEntities(1):
                ends = {n for row in read.elements(1, curve).values() for n in row[:2]}
                bounds = gmsh.model.getBoundary([(1, curve)], oriented=False)
                self.assertEqual(len(bounds), 2)
                for _, point in bounds:
                    node = gmsh.model.mesh.getNodes(0, point)[0]
                    self.assertIn(int(node[0]) - 1, ends)
            for _, surface in gmsh.model.getEntities(2):
                own = read.elements(2, surface).values()
                edges = collections.Counter(frozenset((row[i], row[(i + 1) % 4])) for row in own for i in range(4))
                border = {edge for edge, count in edges.items() if count == 1}
                found = {frozenset(row[:2]) for _, curve in gmsh.model.getBoundary([(2, surface)], False, False)
                         for row in read.elements(1, abs(curve)).values()}
                self.assertEqual(found, border)

    def test_msh_by_meshio(self):
        for nodes, kind in ((4, "quad"), (8, "quad8"), (9, "quad9")):
            data = box() if nodes == 4 else second_order(box(), nodes)
            for version in ("4.1", "2.2"):
                with self.subTest(nodes=nodes, version=version):
                    read = read_silently(self.write(grid(data), "box.msh", msh_version=version))
                    quads = numpy.concatenate([c.data for c in read.cells if c.type == kind])
                    # meshio numbers the nodes of version 4.1 by their place in the file.
                    self.assertEqual(sorted(read.points[quads].tolist()), sorted(data.points[data.elements].tolist()))
                    self.assertEqual({name for name in read.field_data if name.startswith("PATCH")},
                                     set(Sets(data).patches))

    def test_mesh_by_meshio_and_gmsh(self):
        for name, data, mesh in self.meshes():
            if data.elements.shape[1] > 4:
                continue
            with self.subTest(name):
                sets = Sets(data)
                path = self.write(mesh, f"{name}.mesh")
                read = read_silently(path)
                numpy.testing.assert_array_equal(read.points, data.points)
                cells = {c.type: (c.data, read.cell_data["medit:ref"][i]) for i, c in enumerate(read.cells)}
                quads, references = cells["quad"]
                self.same_elements(quads, data)
                names = dict(re.findall(r"^# quadrilaterals (\d+): (\S+)$", path.read_text(), re.MULTILINE))
                found = collections.defaultdict(set)
                for e, reference in enumerate(references):
                    found[names[str(reference)]].add(e)
                self.assertEqual(dict(found), dict(sets.patches))
                self.medit_edges(path, cells, sets)
                with Gmsh(path) as seen:
                    self.assertEqual(seen.log, [])
                    numpy.testing.assert_array_equal(seen.points(), data.points)
                    self.assertEqual(sorted(seen.elements(2).values()), sorted(map(list, data.elements.tolist())))

    def medit_edges(self, path, cells, sets):
        text = path.read_text()
        names = dict(re.findall(r"^# edges (\d+): (\S+)$", text, re.MULTILINE))
        found = collections.defaultdict(set)
        lines, references = cells.get("line", ((), ()))
        for line, reference in zip(lines, references):
            found[names[str(reference)]].add(frozenset(map(int, line)))
        kinds = collections.defaultdict(set)
        for name, edges in found.items():
            kinds[name.split("_")[0]].add(frozenset(edges))
        self.assertEqual(kinds["BOUNDARY"], set(sets.loops))
        self.assertEqual(kinds["CURVE"], set(sets.curves))

        def numbers(keyword):
            block = re.search(rf"^{keyword}\n(\d+)\n((?:\d+\n)*)", text, re.MULTILINE)
            return [int(x) - 1 for x in block.group(2).split()] if block else []

        self.assertEqual(set(numbers("Corners")), sets.corners)
        self.assertEqual(numbers("RequiredVertices"), numbers("Corners"))
        self.assertEqual({frozenset(map(int, lines[i])) for i in numbers("Ridges")},
                         {edge for curve in sets.curves for edge in curve})

    def test_exodus_by_netcdf(self):
        for name, data, mesh in self.meshes():
            with self.subTest(name):
                sets = Sets(data)
                points, elements, blocks, nodes, sides = exodus_by_netcdf(self.write(mesh, f"{name}.ex2"))
                numpy.testing.assert_array_equal(points, data.points)
                self.same_elements(elements, data)
                self.assertEqual({k: set(v) for k, v in blocks.items()}, dict(sets.patches))
                self.assertEqual(by_kind(nodes), sets.node_sets())
                found = {"BOUNDARY": set(), "CURVE": set()}
                for side_set, members in sides.items():
                    found[side_set.split("_")[0]].add(frozenset(
                        frozenset(map(int, (elements[e][s], elements[e][(s + 1) % 4]))) for e, s in members))
                    self.assertEqual(len(set(members)), len(members))
                self.assertEqual(found, {"BOUNDARY": set(sets.loops), "CURVE": set(sets.curves)})

    def test_exodus_by_vtk(self):
        """Blocks and sets by VTK's reader: names, numbers of members, kinds of cells, arrays in double precision."""
        for nodes in (4, 8, 9):
            with self.subTest(nodes):
                data = box() if nodes == 4 else second_order(box(), nodes)
                reader = vtkExodusIIReader()
                reader.SetFileName(str(self.write(grid(data), "box.ex2")))
                reader.UpdateInformation()
                reader.SetAllArrayStatus(reader.ELEM_BLOCK, 1)
                reader.SetAllArrayStatus(reader.NODE_SET, 1)
                reader.SetAllArrayStatus(reader.SIDE_SET, 1)
                for i in range(reader.GetNumberOfElementResultArrays()):
                    reader.SetElementResultArrayStatus(reader.GetElementResultArrayName(i), 1)
                reader.Update()
                sets, output = Sets(data), reader.GetOutput()
                blocks = output.GetBlock(0)
                found = {}
                for i in range(blocks.GetNumberOfBlocks()):
                    block = blocks.GetBlock(i)
                    title = blocks.GetMetaData(i).Get(output.NAME())
                    found[title.split()[0]] = block.GetNumberOfCells()
                    kinds = {block.GetCellType(k) for k in range(block.GetNumberOfCells())}
                    self.assertEqual(kinds, {QUAD_CELLS[nodes]})
                    patch = block.GetCellData().GetArray("PatchId")
                    self.assertEqual({patch.GetValue(k) for k in range(patch.GetNumberOfTuples())},
                                     {float(title.split()[0].split("_")[1])})
                self.assertEqual(found, {name: len(members) for name, members in sets.patches.items()})
                self.assertEqual(reader.GetNumberOfNodeSetArrays(),
                                 len(sets.loops) + len(sets.curves) + len(sets.corners))
                self.assertEqual(reader.GetNumberOfSideSetArrays(), len(sets.loops) + len(sets.curves))
                found = sorted(reader.GetNumberOfEntriesInObject(reader.SIDE_SET, i)
                               for i in range(reader.GetNumberOfSideSetArrays()))
                self.assertEqual(found, sorted(map(len, sets.loops + sets.curves)))

    def test_obj(self):
        """A group each patch in one piece, however the patches alternate; elements keep their order within a group."""
        data = box()
        path = self.write(grid(data), "box.obj")
        read = read_silently(path)
        numpy.testing.assert_array_equal(read.points, data.points)
        groups = [line[2:] for line in path.read_text().splitlines() if line.startswith("g ")]
        expected = Sets(data).patches
        self.assertEqual(sorted(groups), sorted(expected))
        self.assertEqual(len(read.cells), len(groups))  # meshio begins a block at each line "g"
        for group, block in zip(groups, read.cells):
            self.same_elements(block.data, data._replace(elements=data.elements[sorted(expected[group])]))
        reader = vtkOBJReader()
        reader.SetFileName(str(path))
        reader.Update()
        self.assertEqual(reader.GetOutput().GetNumberOfPolys(), len(data.elements))

    def test_obj_without_patches(self):
        """Without patches of the user there are no groups, and elements keep their order."""
        mesh = quadrille.to_polydata(box().points, box().elements)
        path = self.write(mesh, "plain.obj")
        self.assertNotIn("\ng ", path.read_text())
        self.same_elements([row for c in read_silently(path).cells for row in c.data], box())

    def test_ply_with_details(self):
        data = box()
        path = self.write(grid(data), "box.ply", file_details=True)
        reader = vtkPLYReader()
        reader.SetFileName(str(path))
        reader.Update()
        read = reader.GetOutput()
        numpy.testing.assert_array_equal(vtk_to_numpy(read.GetPoints().GetData()), data.points.astype(numpy.float32))
        self.same_elements(vtk_to_numpy(read.GetPolys().GetConnectivityArray()).reshape(-1, 4), data)
        again = quadrille.read(path)
        self.assertEqual(list(vtk_to_numpy(again.GetCellData().GetArray("PatchId"))), list(data.patch))
        # By the document of the format: the property follows the list of each face.
        body = path.read_bytes().split(b"end_header\n", 1)[1][12 * len(data.points):]
        rows = [struct.unpack_from("<B4ii", body, 21 * e) for e in range(len(data.elements))]
        self.assertEqual([row[5] for row in rows], list(data.patch))
        self.same_elements([row[1:5] for row in rows], data)
        self.assertIn(b"comment PatchId 3: PATCH_3\n", path.read_bytes())

    def test_ply(self):
        """Points and faces only, with or without patches in the mesh, and whole or not there."""
        mesh = quadrille.to_polydata(box().points, box().elements)
        reader = vtkPLYReader()
        reader.SetFileName(str(self.write(mesh, "plain.ply")))
        reader.Update()
        plain = (self.work / "plain.ply").read_bytes()
        self.assertEqual(self.write(grid(box()), "patches.ply").read_bytes(), plain)
        self.assertEqual(plain.split(b"end_header\n")[0].count(b"property"), 4)
        self.assertEqual(self.write(mesh, "details.ply", file_details=True).read_bytes(), plain)  # no patches to tell
        self.same_elements(vtk_to_numpy(reader.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 4), box())
        size = (self.work / "plain.ply").stat().st_size
        for name in ("plain.ply", "patches.ply", "details.ply"):
            (self.work / name).unlink()
        limit = resource.getrlimit(resource.RLIMIT_FSIZE)
        before = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        try:
            for room in (100, size // 2, size - 1):
                resource.setrlimit(resource.RLIMIT_FSIZE, (room, limit[1]))
                try:
                    with self.assertRaises(OSError):
                        quadrille.write(mesh, self.work / "plain.ply")
                finally:
                    resource.setrlimit(resource.RLIMIT_FSIZE, limit)
                self.assertEqual(list(self.work.iterdir()), [])
        finally:
            signal.signal(signal.SIGXFSZ, before)

    def test_stl(self):
        """Triangles have the area and the direction of the quads; a quad that is not convex is cut inside."""
        dart = Mesh(numpy.array([(0, 0, 0), (4, 0, 0), (1, 1, 0), (0, 4, 0)], float), numpy.array([(0, 1, 2, 3)]), [0],
                    [0])
        for data, each in ((dart, 2), (box(), 2), (second_order(box(), 8), 6), (second_order(box(), 9), 8)):
            reader = vtkSTLReader()
            reader.SetFileName(str(self.write(grid(data), "mesh.stl")))
            reader.Update()
            read = reader.GetOutput()
            self.assertEqual(read.GetNumberOfPolys(), each * len(data.elements))
            points = vtk_to_numpy(read.GetPoints().GetData()).astype(float)
            corners = points[vtk_to_numpy(read.GetPolys().GetConnectivityArray()).reshape(-1, 3)]
            normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
            quads = numpy.asarray(data.points)[numpy.asarray(data.elements)[:, :4]]
            whole = numpy.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1]) / 2
            numpy.testing.assert_allclose(normals.reshape(-1, each, 3).sum(axis=1), whole, atol=1e-6)
            # None is turned over: areas add up, too.
            numpy.testing.assert_allclose(numpy.linalg.norm(normals, axis=1).sum(),
                                          numpy.linalg.norm(whole, axis=1).sum(), rtol=1e-6)
            again = read_silently(self.work / "mesh.stl")
            self.assertEqual(len(again.cells[0].data), each * len(data.elements))

    def test_stl_far_away(self):
        data = plate(10, 10, 1)
        far = data._replace(points=data.points * 1e-3 + 1e5)
        notices = quadrille.write(grid(far), self.work / "far.stl")
        self.assertEqual(len(notices), 1)
        self.assertIn("no length in the single precision of STL", notices[0])

    def test_vtu(self):
        for nodes in (4, 8, 9):
            data = box() if nodes == 4 else second_order(box(), nodes)
            path = self.write(grid(data), "box.vtu")
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(str(path))
            reader.Update()
            self.same_elements(data_of(reader.GetOutput()).elements, data)
            read = read_silently(path)
            numpy.testing.assert_array_equal(read.points, data.points)
            self.same_elements(read.cells[0].data, data)

    NAMES = {0: "inlet pipe", 1: "inlet,pipe", 2: "Größe", 3: "x" * 200, 4: "Inlet_Pipe", 5: "CURVE_1", 6: '"q"',
             7: "7up", 8: "wall", 9: "wall"}

    def named_box(self):
        mesh = grid(box())
        add_strings(mesh.GetFieldData(), "PatchNames", [self.NAMES[i] for i in range(10)])
        return mesh

    def test_a_layout_of_many_patches_is_one_set(self):
        data = box(12)
        for count, sets in ((200, 200), (201, 1)):
            mesh = grid(data)
            mesh.GetCellData().RemoveArray("PatchId")
            array = vtkIntArray()
            array.SetName("LayoutPatch")
            for i in range(mesh.GetNumberOfCells()):
                array.InsertNextValue(i % count)
            mesh.GetCellData().AddArray(array)
            path = self.work / "layout.inp"
            notices = quadrille.write(mesh, path)
            self.assertEqual(len(re.findall(r"ELSET=PATCH_", path.read_text())), sets)
            self.assertEqual(["201 patches" in notice for notice in notices], [True] if sets == 1 else [])
            quadrille.write(mesh, path, patch_array="LayoutPatch")
            self.assertEqual(len(re.findall(r"ELSET=PATCH_", path.read_text())), count)

    def test_vtu_for_others(self):
        """meshio ends at texts, bits, and field data without values, each alone; with details all of them are there."""
        def named(array, name, *values):
            if name:
                array.SetName(name)
            for value in values:
                array.InsertNextValue(value)
            return array

        data = box()
        count = len(data.elements)
        texts = {"cells": named(vtkStringArray(), "Words", *["a"] * count),
                 "bits": named(vtkBitArray(), "Bits", *[1] * count), "nameless": named(vtkIntArray(), "", *[1] * count)}
        fields = {"PatchNames": named(vtkStringArray(), "PatchNames", "one"), "Empty": named(vtkIntArray(), "Empty"),
                  "Notices": named(vtkStringArray(), "Notices", "told"), "Kept": named(vtkIntArray(), "Kept", 3)}
        for name in (*texts, *fields):
            with self.subTest(name):
                mesh = grid(data)
                (mesh.GetCellData() if name in texts else mesh.GetFieldData()).AddArray({**texts, **fields}[name])
                notices = quadrille.write(mesh, self.work / "a.vtu")
                self.assertEqual(len(notices), name in texts or name == "PatchNames", notices)
                read = read_silently(self.work / "a.vtu")
                self.same_elements(read.cells[0].data, data)
                self.assertEqual(set(read.cell_data), {"PatchId", "FeatureEdges"})
                self.assertEqual(set(read.field_data), {"Kept"} & {name})
                # The mesh that was given keeps its arrays.
                self.assertEqual(mesh.GetCellData().GetNumberOfArrays() + mesh.GetFieldData().GetNumberOfArrays(), 3)
                self.assertEqual(quadrille.write(mesh, self.work / "b.vtu", file_details=True), [])
                reader = vtkXMLUnstructuredGridReader()
                reader.SetFileName(str(self.work / "b.vtu"))
                reader.Update()
                again = reader.GetOutput()
                self.assertEqual(again.GetCellData().GetNumberOfArrays() + again.GetFieldData().GetNumberOfArrays(), 3)
        # From polygons, too, and vtp has all.
        quads = quadrille.to_polydata(data.points, data.elements)
        add_strings(quads.GetFieldData(), "Notices", ["told"])
        self.write(quads, "c.vtu")
        self.assertEqual(read_silently(self.work / "c.vtu").field_data, {})
        self.assertIn(b'Name="Notices"', self.write(quads, "c.vtp").read_bytes())
        self.assertTrue(quads.GetFieldData().HasArray("Notices"))

    def test_vtu_of_mixed_faces(self):
        """Boundaries in the old shape leave faces of three and more than four corners."""
        points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0.5, 0), (0.5, 2, 0), (1.5, 1.5, 0)]
        faces = [(0, 1, 2, 3), (1, 4, 2), (3, 2, 4, 6, 5)]
        path = self.work / "mixed.vtu"
        quadrille.write(quadrille.to_polydata(points, faces), str(path))
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        mesh = reader.GetOutput()
        self.assertEqual([mesh.GetCellType(i) for i in range(3)], [9, 5, 7])  # VTK_QUAD, VTK_TRIANGLE, VTK_POLYGON
        self.assertEqual([tuple(mesh.GetCell(i).GetPointId(k) for k in range(len(face)))
                          for i, face in enumerate(faces)], faces)

    def test_names(self):
        """Blanks, commas, other letters, long names, names that are one after cleaning: told once, and all sets there.
        Two patches of one name are one set. A node set has the name of the element set or block."""
        data = box()
        expected = Sets(data, self.NAMES).patches
        self.assertEqual(len(expected), 9)
        members = {frozenset(those) for those in expected.values()}
        for extension in ("inp", "msh", "ex2"):
            with self.subTest(extension):
                path = self.work / f"named.{extension}"
                notices = quadrille.write(self.named_box(), path)
                self.assertEqual(len(notices), 1, notices)
                self.assertIn("another in this format", notices[0])
                if extension == "inp":
                    read = read_silently(path)
                    names = [name for name in read.cell_sets if not re.search(r"_E[1-4]$", name)]
                    found = {frozenset(map(int, read.cell_sets[name][0])) for name in names if name != "EALL"}
                    self.assertTrue(all(re.fullmatch(r"[A-Z][A-Z0-9_]{0,79}", name) for name in names), names)
                    self.assertEqual(len({name.upper() for name in names}), len(names))
                    self.assertIn("INLET_PIPE", names)
                    elements = {name: read.cell_sets[name][0] for name in names if name != "EALL"}
                    nodes = read.point_sets
                elif extension == "msh":
                    with Gmsh(path) as read:
                        groups = read.groups(2)
                    found = {frozenset(tag - 1 for tag in rows) for rows in groups.values()}
                    elements = nodes = {}
                    self.assertIn("Größe", groups)
                    self.assertIn("inlet pipe", groups)
                    self.assertTrue(all(len(name.encode()) <= 127 for name in groups))
                else:
                    _, _, blocks, nodes, _ = exodus_by_netcdf(path)
                    found = {frozenset(those) for those in blocks.values()}
                    elements = blocks
                    self.assertIn("inlet pipe", blocks)
                    self.assertTrue(all(len(name.encode()) <= 32 for name in blocks), blocks)
                self.assertEqual(found, members)
                for name, those in elements.items():
                    self.assertEqual(sorted(map(int, nodes[name])),
                                     sorted({int(n) for e in those for n in data.elements[int(e)]}), name)

    @by_calculix
    def test_names_by_calculix(self):
        path = self.work / "named.inp"
        quadrille.write(self.named_box(), path)
        names = [name for name in read_silently(path).cell_sets if not re.search(r"_E[1-4]$", name) and name != "EALL"]
        sections = "".join(f"*SHELL SECTION, ELSET={name}, MATERIAL=M\n1.\n" for name in names)
        log, _ = run_calculix(f"*INCLUDE, INPUT={path.name}\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n{sections}"
                              "*BOUNDARY\nNALL, 1, 3\n*STEP\n*STATIC\n*CLOAD\n1, 1, 1.\n*END STEP\n", self.work)
        self.assertNotRegex(log.upper(), r"\*WARNING|\*ERROR")
        self.assertEqual(len(names), 9)

    def test_where_names_come_from(self):
        def patches(mesh, **options):
            path = self.work / "named.inp"
            notices = quadrille.write(mesh, path, **options)
            read = read_silently(path)
            return {k: set(map(int, v[0])) for k, v in read.cell_sets.items()
                    if k != "EALL" and not re.search(r"_E[1-4]$", k)}, notices

        data = plate()  # patches 1 and 2
        halves = [{e for e, p in enumerate(data.patch) if p == number} for number in (1, 2)]
        with self.subTest("names of 1 to n"):
            mesh = grid(data)
            add_strings(mesh.GetFieldData(), "PatchNames", ["LEFT", "RIGHT"])
            self.assertEqual(patches(mesh)[0], {"LEFT": halves[0], "RIGHT": halves[1]})
        with self.subTest("names from 0"):
            mesh = grid(data)
            add_strings(mesh.GetFieldData(), "PatchNames", ["NONE", "LEFT", "RIGHT", "MORE"])
            self.assertEqual(patches(mesh)[0], {"LEFT": halves[0], "RIGHT": halves[1]})
        with self.subTest("names by numbers"):
            mesh = grid(data)
            add_strings(mesh.GetFieldData(), "PatchNames", ["RIGHT"])
            numbers = vtkIntArray()
            numbers.SetName("PatchNumbers")
            numbers.InsertNextValue(2)
            mesh.GetFieldData().AddArray(numbers)
            self.assertEqual(patches(mesh)[0], {"PATCH_1": halves[0], "RIGHT": halves[1]})
        with self.subTest("strings of cells"):
            mesh = grid(data)
            add_strings(mesh.GetCellData(), "PatchNames", ["LEFT" if p == 1 else "RIGHT" for p in data.patch])
            self.assertEqual(patches(mesh), ({"LEFT": halves[0], "RIGHT": halves[1]}, []))
            mesh.GetCellData().RemoveArray("PatchId")
            self.assertEqual(patches(mesh), ({"LEFT": halves[0], "RIGHT": halves[1]}, []))
        with self.subTest("strings that differ within a patch"):
            mesh = grid(data)
            add_strings(mesh.GetCellData(), "PatchNames", ["LEFT" if p == 1 and e else "RIGHT"
                                                           for e, p in enumerate(data.patch)])
            found, notices = patches(mesh)
            self.assertEqual(found, {"LEFT": halves[0], "RIGHT": halves[1]})
            self.assertEqual(len(notices), 1)
            self.assertIn("1 patch has elements of more than one name", notices[0])
        with self.subTest("another array"):
            mesh = grid(data)
            array = vtkIntArray()
            array.SetName("Material")
            for e in range(len(data.elements)):
                array.InsertNextValue(-1 if e < 3 else 7)
            mesh.GetCellData().AddArray(array)
            found, _ = patches(mesh, patch_array="Material")
            self.assertEqual(found["PATCH_MINUS_1"], {0, 1, 2})
            self.assertEqual(found["PATCH_7"], set(range(3, len(data.elements))))
        with self.subTest("none"):
            mesh = grid(data)
            mesh.GetCellData().RemoveArray("PatchId")
            self.assertEqual(patches(mesh)[0], {"PATCH_1": set(range(len(data.elements)))})

    def test_refusals(self):
        """What cannot be written is refused with the place, and leaves nothing behind."""
        triangle = vtkUnstructuredGrid()
        triangle.SetPoints(vtkPoints())
        for p in ((0, 0, 0), (1, 0, 0), (0, 1, 0)):
            triangle.GetPoints().InsertNextPoint(p)
        triangle.InsertNextCell(5, 3, [0, 1, 2])
        turned = plate(1, 1, 1)
        turned = turned._replace(elements=turned.elements[:, ::-1])
        lifted = plate(1, 1, 1)
        lifted = lifted._replace(points=lifted.points + (0, 0, 1))
        nine = second_order(plate(1, 1, 1), 9)
        cases = [
            (triangle, "a.inp", {}, "cell 0 is no quad"),
            (grid(plate()), "a.inp", {"patch_array": "Nothing"}, "no cell array 'Nothing'"),
            (grid(plate()), "a.inp", {"element": "S8"}, "elements of 4 nodes cannot be of type S8; choose one of S4,"),
            (grid(nine), "a.inp", {}, "CalculiX has no elements of 9 nodes"),
            (grid(turned), "a.inp", {"element": "CPS4"}, "element 0 is clockwise"),
            (grid(lifted), "a.inp", {"element": "CPS4"}, "node 0 has z = 1"),
            (grid(nine), "a.mesh", {}, "MEDIT's format has no elements of 9 nodes"),
            (grid(nine), "a.obj", {}, "OBJ has no elements of 9 nodes"),
            (grid(nine), "a.ply", {}, "PLY has no elements of 9 nodes"),
            (triangle, "a.ply", {}, "cell 0 is no quad"),
            (grid(plate()), "a.xyz", {}, "unknown extension; known are vtp, vtu"),
            (self.with_cell_array(plate(), "Thickness", [0.0] * 24), "a.inp", {}, "element 0 has the thickness 0"),
            (self.with_cell_array(plate(), "ElementAxis", [(2, 0, 0)] * 24), "a.inp", {}, "has the length 2"),
            (self.with_cell_array(plate(), "PatchId", [0.5] * 24), "a.inp", {}, "has the value 0.5 at cell 0"),
        ]
        for mesh, name, options, reason in cases:
            with self.subTest(reason):
                with self.assertRaises(quadrille.InvalidInput) as caught:
                    quadrille.write(mesh, self.work / name, **options)
                self.assertIn(reason, str(caught.exception))
                self.assertEqual(list(self.work.iterdir()), [])
        with self.assertRaises(quadrille.InvalidInput):
            quadrille.write(grid(plate()), self.work / "a.inp", dialect="nastran")

    def test_no_room(self):
        """Where the disk is full, here a limit of the size of files, there is an error, no part of a file, and what was
        there before stays."""
        data = plate(100, 100, 2)
        mesh = grid(data)
        limit = resource.getrlimit(resource.RLIMIT_FSIZE)
        before = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        try:
            for extension in ("inp", "msh", "mesh", "obj", "ply", "stl", "vtu", "ex2"):
                with self.subTest(extension):
                    path = self.work / f"full.{extension}"
                    path.write_text("as it was")
                    resource.setrlimit(resource.RLIMIT_FSIZE, (20000, limit[1]))
                    try:
                        with self.assertRaises(OSError) as caught:
                            quadrille.write(mesh, path)
                    finally:
                        resource.setrlimit(resource.RLIMIT_FSIZE, limit)
                    self.assertIn(str(path), str(caught.exception))
                    self.assertEqual([p.name for p in self.work.glob(f"*{extension}*")], [path.name])
                    self.assertEqual(path.read_text(), "as it was")
        finally:
            signal.signal(signal.SIGXFSZ, before)
        with self.assertRaises(OSError):
            quadrille.write(mesh, self.work / "nowhere" / "a.inp")

    def test_progress_and_stop(self):
        mesh = grid(plate(100, 100, 2))
        fractions = []
        quadrille.write(mesh, self.work / "a.inp", progress=lambda fraction, text: fractions.append(fraction))
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual(fractions[-1], 1)
        self.assertGreater(len(fractions), 2)
        (self.work / "a.inp").unlink()
        with self.assertRaises(quadrille.RemeshError):
            quadrille.write(mesh, self.work / "a.inp", progress=lambda fraction, text: fraction < 0.3)
        self.assertEqual(list(self.work.iterdir()), [])

    def test_command(self):
        """The command writes what the function does, options reach the file, notices are told."""
        source = pathlib.Path(ARGS.data) / "part.ply"

        def run(name, *options):
            path = self.work / name
            run = subprocess.run([ARGS.quadrille, source, path, "--quads", "1500", *options], capture_output=True,
                                 text=True, check=False)
            self.assertEqual(run.returncode, 0, run.stderr)
            return path

        quads = quadrille.remesh(quadrille.read(source), quads=1500)
        for name, options, arguments in (
                ("a.inp", ["--element", "s4r"], {"element": "S4R"}),
                ("a.inp", ["--inp-dialect", "abaqus", "--patch-array", "LayoutPatch"],
                 {"dialect": "abaqus", "patch_array": "LayoutPatch"}),
                ("a.msh", ["--msh-version", "2.2"], {"msh_version": "2.2"}),
                ("a.msh", [], {}), ("a.mesh", [], {}), ("a.stl", [], {}), ("a.obj", [], {}), ("a.ply", [], {}),
                ("a.ply", ["--file-details"], {"file_details": True})):
            with self.subTest(name, options=options):
                ours = self.write(quads, "b" + name[1:], **arguments)
                self.assertEqual(run(name, *options).read_bytes(), ours.read_bytes())
        run("a.e")
        self.assertEqual(len(exodus_by_netcdf(self.work / "a.e")[1]), quads.GetNumberOfPolys())
        bad = subprocess.run([ARGS.quadrille, source, self.work / "c.inp", "--quads", "1500", "--element", "S8"],
                             capture_output=True, text=True, check=False)
        self.assertEqual(bad.returncode, 2)
        self.assertIn("cannot be of type S8", bad.stderr)
        self.assertFalse((self.work / "c.inp").exists())

    def test_command_of_second_order(self):
        """--order 2 in all formats that have such elements: the same nodes and elements everywhere."""
        source = pathlib.Path(ARGS.data) / "part.ply"
        for nodes in (8, 9):
            with self.subTest(nodes):
                for extension in ("vtu", "msh", "ex2", "inp"):
                    options = ["--inp-dialect", "abaqus"] if nodes == 9 and extension == "inp" else []
                    subprocess.run([ARGS.quadrille, source, self.work / f"a.{extension}", "--quads", "1500", "--order",
                                    "2", "--nodes", str(nodes), "--quiet", *options], check=True)
                reader = vtkXMLUnstructuredGridReader()
                reader.SetFileName(str(self.work / "a.vtu"))
                reader.Update()
                data = data_of(reader.GetOutput())
                self.assertEqual(data.elements.shape[1], nodes)
                with Gmsh(self.work / "a.msh") as read:
                    self.assertEqual(read.log, [])
                    numpy.testing.assert_array_equal(read.points(), data.points)
                    rows = read.elements(2)
                    self.same_elements([rows[tag] for tag in sorted(rows)], data)
                    self.gmsh_sets(read, data)
                points, elements, _, found, _ = exodus_by_netcdf(self.work / "a.ex2")
                numpy.testing.assert_array_equal(points, data.points)
                self.same_elements(elements, data)
                self.assertEqual(by_kind(found), Sets(data).node_sets())
                if nodes == 8:
                    read = read_silently(self.work / "a.inp")
                    numpy.testing.assert_allclose(read.points, data.points, rtol=1e-12, atol=1e-14)
                    self.same_elements(read.cells[0].data, data)
                else:
                    self.assertIn("TYPE=S9R5", (self.work / "a.inp").read_text())

    def test_same_bytes(self):
        """A file depends on the mesh alone."""
        for extension in ("inp", "msh", "mesh", "obj", "ply", "stl"):
            first = self.write(grid(box()), f"a.{extension}").read_bytes()
            self.assertEqual(self.write(grid(box()), f"b.{extension}").read_bytes(), first)


def torus(around=12, across=6):
    """Closed, without features."""
    points = []
    for i in range(around):
        for j in range(across):
            a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
            r = 3 + math.cos(b)
            points.append((r * math.cos(a), r * math.sin(a), math.sin(b)))
    elements = [(i * across + j, (i + 1) % around * across + j, (i + 1) % around * across + (j + 1) % across,
                 i * across + (j + 1) % across) for i in range(around) for j in range(across)]
    return Mesh(numpy.array(points), numpy.array(elements), [3] * len(elements), [0] * len(elements))


def ring(around=6):
    """A flat ring of two rows with a closed feature between them; its edges bend by 60 degrees and have no corners."""
    points = [(r * math.cos(2 * math.pi * i / around), r * math.sin(2 * math.pi * i / around), 0.0)
              for r in (1, 2, 3) for i in range(around)]
    elements, features = [], []
    for j in range(2):
        for i in range(around):
            k = (i + 1) % around
            elements.append((j * around + i, (j + 1) * around + i, (j + 1) * around + k, j * around + k))
            features.append(1 << (1 if j == 0 else 3))
    return Mesh(numpy.array(points), numpy.array(elements), [0] * around + [1] * around, features)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--quadrille", required=True)
    parser.add_argument("--data", required=True)
    parser.add_argument("--work", required=True)
    parser.add_argument("--calculix", choices=("only", "without"), default="without")
    ARGS, rest = parser.parse_known_args()
    for name in unittest.defaultTestLoader.getTestCaseNames(FormatTest):
        if hasattr(getattr(FormatTest, name), "by_calculix") != (ARGS.calculix == "only"):
            delattr(FormatTest, name)
    unittest.main(argv=[__file__, *rest])
