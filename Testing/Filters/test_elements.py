#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Elements for simulation from the command and from Python."""
import argparse
import json
import pathlib
import subprocess
import sys
import unittest

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_BIQUADRATIC_QUAD, VTK_QUADRATIC_QUAD
from vtkmodules.vtkIOExodus import vtkExodusIIReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

import quadrille


def read(path):
    reader = (vtkXMLPolyDataReader if path.suffix == ".vtp" else vtkXMLUnstructuredGridReader)()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def run(*words):
    words = [str(word) for word in words]
    return subprocess.run([GIVEN.quadrille, *words], capture_output=True, text=True)


class TestCommand(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.part = GIVEN.data / "part.ply"
        cls.work = GIVEN.work
        cls.work.mkdir(parents=True, exist_ok=True)

    def test_second_order_by_an_independent_script(self):
        for nodes in (8, 9):
            result = subprocess.run([sys.executable, GIVEN.script, GIVEN.quadrille, self.part, GIVEN.data / "frame.ply",
                                     "--quads", "600", "--nodes", str(nodes), "--work", self.work],
                                    capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            self.assertIn('"good": 2', result.stdout)

    def test_exodus_has_the_elements_of_vtu(self):
        def places(grid):
            """Node by node of each element, as the reader numbers points by their use."""
            cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(grid.GetNumberOfCells(), -1)
            return vtk_to_numpy(grid.GetPoints().GetData()).astype(float)[cells]

        for nodes, kind in ((8, VTK_QUADRATIC_QUAD), (9, VTK_BIQUADRATIC_QUAD)):
            options = ("--quads", 300, "--order", 2, "--nodes", nodes, "--quiet")
            for name in ("part.vtu", "part.ex2"):
                self.assertEqual(run(self.part, self.work / name, *options).returncode, 0)
            grid = read(self.work / "part.vtu")
            reader = vtkExodusIIReader()
            reader.SetFileName(str(self.work / "part.ex2"))
            reader.Update()
            blocks = reader.GetOutput().GetBlock(0)
            blocks = [blocks.GetBlock(i) for i in range(blocks.GetNumberOfBlocks())]
            self.assertGreater(len(blocks), 1)  # one a patch
            self.assertEqual({each.GetCellType(0) for each in (grid, *blocks)}, {kind})
            ours, theirs = places(grid), numpy.concatenate([places(block) for block in blocks])
            self.assertEqual(ours.shape, theirs.shape)
            size = numpy.ptp(ours.reshape(-1, 3), axis=0).max()
            near = numpy.linalg.norm(ours.mean(axis=1)[:, None] - theirs.mean(axis=1), axis=2).argmin(axis=1)
            self.assertEqual(len(set(near)), len(ours))
            # Exodus files of small models are in single precision.
            self.assertLess(abs(ours - theirs[near]).max(), 1e-6 * size)

    def test_limits(self):
        out, report = self.work / "limits.vtp", self.work / "limits.json"
        options = ("--quads", 300, "--require", "scaled-jacobian>0.2", "--require", "warpage > -1", "--report", report)
        result = run(self.part, out, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        result = run(self.part, out, *options, "--require", "skew<0.001", "--worst", 4, "--quiet")
        self.assertEqual(result.returncode, 3)
        self.assertIn("skew<0.001, the worst: element ", result.stderr)
        told = json.loads(report.read_text())
        self.assertEqual(told["exit_code"], 3)
        skew = vtk_to_numpy(read(out).GetCellData().GetArray("Skew"))  # it was written all the same
        elements = told["elements"]
        self.assertEqual([r["failed_elements"] for r in elements["requirements"]], [0, 0, int((skew >= 0.001).sum())])
        self.assertEqual(elements["failed_elements"], int((skew >= 0.001).sum()))
        worst = [w for w in elements["worst"] if w["measure"] == "Skew"]
        self.assertEqual([w["value"] for w in worst], sorted(skew, reverse=True)[:4])
        self.assertEqual(sum(elements["measures"]["Skew"]["histogram_counts"]), len(skew))

    def test_loads_and_materials(self):
        surface = quadrille.read(str(self.part))
        points = vtk_to_numpy(surface.GetPoints().GetData())
        faces = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        corners = points[faces].astype(float)
        normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= numpy.linalg.norm(normals, axis=1, keepdims=True)
        from vtkmodules.util.numpy_support import numpy_to_vtk
        from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
        fibre = numpy.cross(normals, [0.3, 0.5, 0.8])
        for name, values in (("T", 1 + corners[:, :, 2].mean(axis=1) ** 2), ("Fibre", fibre)):
            array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
            array.SetName(name)
            surface.GetCellData().AddArray(array)
        writer = vtkXMLPolyDataWriter()
        writer.SetInputData(surface)
        writer.SetDataModeToBinary()
        writer.SetFileName(str(self.work / "loads.vtp"))
        writer.Write()
        out = self.work / "loads.vtu"
        result = run(self.work / "loads.vtp", out, "--quads", 300, "--order", 2, "--thickness", "T", "--axis", "Fibre",
                     "--axis-fallback", "element", "--local-vectors", "Fibre")
        self.assertEqual(result.returncode, 0, result.stderr)
        data = read(out).GetCellData()
        thickness = vtk_to_numpy(data.GetArray("Thickness"))
        self.assertTrue(numpy.array_equal(thickness, vtk_to_numpy(data.GetArray("T"))))
        self.assertGreater(len(numpy.unique(thickness)), 100)  # means by area, not values of single cells
        axis = vtk_to_numpy(data.GetArray("ElementAxis"))
        self.assertLess(abs(numpy.linalg.norm(axis, axis=1) - 1).max(), 1e-12)
        local = vtk_to_numpy(data.GetArray("FibreInElement"))
        lengths = numpy.linalg.norm(vtk_to_numpy(data.GetArray("Fibre")), axis=1)
        self.assertLess(abs(numpy.linalg.norm(local, axis=1) - lengths).max(), 1e-12)
        result = run(self.work / "loads.vtp", out, "--axis", "None")
        self.assertIn("no cell or point array 'None'", result.stderr)
        self.assertNotEqual(result.returncode, 0)

    def test_what_does_not_fit(self):
        out = self.work / "wrong.vtu"
        for words, text in ((("--nodes", 9), "--order 2"), (("--order", 3), "--order"),
                            (("--require", "size>3"), "unknown measure 'size'"), (("--axis-fallback", "x"), "--axis"),
                            (("--require", "skew<x"), "'x', which is no number")):
            result = run(self.part, out, *words)
            self.assertEqual(result.returncode, 2, words)
            self.assertIn(text, result.stderr)
        result = run(self.part, self.work / "wrong.obj", "--order", 2)
        self.assertIn("needs a format that has such elements", result.stderr)
        self.assertFalse(out.exists())


class TestFunction(unittest.TestCase):
    def with_nodes(self, nodes):
        surface = quadrille.read(str(GIVEN.data / "frame.ply"))
        made = quadrille.remesh(surface, quads=300, everything=True)
        return quadrille.elements(made.quads, made.surface, order=2, nodes=nodes)

    def test_elements(self):
        self.assertEqual(self.with_nodes(9).GetCellType(0), VTK_BIQUADRATIC_QUAD)
        surface = quadrille.read(str(GIVEN.data / "part.ply"))
        quads = quadrille.remesh(surface, quads=300)
        grid = quadrille.elements(quads, surface, order=2, quality=True, require="scaled-jacobian>0")
        self.assertEqual(grid.GetNumberOfCells(), quads.GetNumberOfPolys())
        self.assertEqual(grid.GetCellType(0), VTK_QUADRATIC_QUAD)
        told = quadrille.info(grid)
        self.assertEqual((told["ElementOrder"], told["NodesPerElement"], told["InvertedElements"]), (2, 8, 0))
        with self.assertRaises(quadrille.FailedElements) as failed:
            quadrille.elements(quads, require=["scaled-jacobian>0.9999"])
        self.assertGreater(failed.exception.count, 0)
        self.assertEqual(failed.exception.elements.GetNumberOfCells(), quads.GetNumberOfPolys())
        for arguments in ({"order": 2}, {"order": 3}, {"axis": "Nothing"}, {"require": "skew"}, {"require": [1]},
                          {"axis_fallback": "w"}):
            with self.assertRaises(quadrille.InvalidInput, msg=str(arguments)):
                quadrille.elements(quads, **arguments)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--quadrille", type=pathlib.Path)
    parser.add_argument("--script", type=pathlib.Path)
    parser.add_argument("--data", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path)
    GIVEN, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest])
