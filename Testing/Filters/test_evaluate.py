# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""quadrille-evaluate: the study of a surface, meshes of other programs, and what it says of wrong input.

  test_evaluate.py QUADRILLE-EVALUATE DATA
"""
import csv
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy

COMMAND, DATA = sys.argv.pop(1), pathlib.Path(sys.argv.pop(1))

CUBE = numpy.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def run(*words, environment=None):
    return subprocess.run([COMMAND, *map(str, words)], capture_output=True, text=True, timeout=280,
                          env={**os.environ, **(environment or {})})


def write_obj(path, points=CUBE, faces=FACES):
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in points) +
                    "".join("f " + " ".join(str(i + 1) for i in face) + "\n" for face in faces))


def write_gmsh_2(path):
    path.write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n" +
                    "".join(f"{i + 10} {x} {y} {z}\n" for i, (x, y, z) in enumerate(CUBE)) +
                    "$EndNodes\n$Elements\n7\n1 15 2 1 1 10\n" +
                    "".join(f"{k + 2} 3 2 1 1 " + " ".join(str(i + 10) for i in face) + "\n"
                            for k, face in enumerate(FACES)) + "$EndElements\n")


def write_gmsh_4(path):
    path.write_text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n2 8 1 8\n2 1 0 4\n1\n2\n3\n4\n" +
                    "".join(f"{x} {y} {z}\n" for x, y, z in CUBE[:4]) + "2 2 0 4\n5\n6\n7\n8\n" +
                    "".join(f"{x} {y} {z}\n" for x, y, z in CUBE[4:]) +
                    "$EndNodes\n$Elements\n2 7 1 7\n0 1 15 1\n1 1\n2 1 3 6\n" +
                    "".join(f"{k + 2} " + " ".join(str(i + 1) for i in face) + "\n" for k, face in enumerate(FACES)) +
                    "$EndElements\n")


class Evaluate(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def rows(self, name):
        with open(self.folder / "out" / name, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_study_of_a_surface(self):
        done = run(DATA / "beast.ply", "--quads", 600, "--budgets", "600", "--out", self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = self.rows("evaluation.csv")
        self.assertEqual([row["map"] for row in rows],
                         ["without decimation", "E_G,mem", "E_G", "E_QEM", "E_uni", "E_G, 600"])
        reference = rows[0]
        for name in ("emd", "sizing_distance", "anisotropy_distance", "shear_distance"):
            self.assertEqual(float(reference[name]), 0)
        self.assertEqual(rows[1]["emd_percent"], "100")
        for row in rows[1:]:
            self.assertLessEqual(int(row["vertices"]), int(reference["vertices"]))
            self.assertGreaterEqual(float(row["anisotropy"]), 1)
            self.assertGreater(float(row["shear"]), 0)
            self.assertEqual(int(row["inverted"]), 0)
        whole = json.loads((self.folder / "out" / "evaluation.json").read_text(encoding="utf-8"))
        self.assertIn("quadrille-evaluate", whole["about"]["command"])
        indices = set()  # the sum of indices is that of the surface, whatever the map
        for outcome in whole["studies"][0]["outcomes"]:
            indices.add(sum((4 - int(valence)) * count for valence, count in outcome["valences"].items()))
            for bins, shares in outcome["histograms"].values():
                self.assertEqual(len(bins), len(shares))
                self.assertAlmostEqual(sum(shares), 100, places=6)
        self.assertEqual(len(indices), 1)
        page = (self.folder / "out" / "index.html").read_text(encoding="utf-8")
        pictures = re.findall(r'<img src="([^"]+)"', page)
        self.assertEqual(len(pictures), 3)
        for picture in pictures:
            self.assertIn("<svg", (self.folder / "out" / picture).read_text(encoding="utf-8")[:2000])
        self.assertEqual(sorted(path.name for path in (self.folder / "out").iterdir()),
                         sorted(["evaluation.csv", "evaluation.json", "index.html", *pictures]))

    def test_meshes_of_all_formats_are_measured_alike(self):
        write_obj(self.folder / "cube.obj")
        write_gmsh_2(self.folder / "two.msh")
        write_gmsh_4(self.folder / "four.msh")
        (self.folder / "cube.off").write_text("OFF\n8 6 0\n" + "".join(f"{x} {y} {z}\n" for x, y, z in CUBE) +
                                              "".join("4 " + " ".join(map(str, face)) + "\n" for face in FACES))
        names = ("cube.obj", "two.msh", "four.msh", "cube.off")
        done = run("--meshes", *(self.folder / name for name in names), "--surface", self.folder / "cube.obj",
                   "--out", self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = self.rows("meshes.csv")
        self.assertEqual([row.pop("mesh") for row in rows], list(names))
        for row in rows:
            self.assertEqual((row["quads"], row["other_faces"], row["components"], row["boundary_loops"], row["euler"]),
                             ("6", "0", "1", "0", "2"))
            self.assertEqual((row["irregular"], row["non_manifold_edges"], row["turned_edges"]), ("8", "0", "0"))
            for name, value in (("sj_mean", 1), ("sj_least", 1), ("angle_mean", 90), ("edge_mean", 1), ("edge_cv", 0),
                                ("distance_mean", 0), ("distance_largest", 0), ("patches", 6), ("feature_mean", 0),
                                ("feature_largest", 0), ("feature_share", 1)):
                self.assertAlmostEqual(float(row[name]), value, places=6, msg=name)

    def test_what_is_wrong_with_a_mesh_is_counted(self):
        sheet = [[x, y, 0] for y in range(3) for x in range(3)]
        # One quad turned over, one cut into two triangles; the corner (2, 2) is drawn over the one across.
        faces = [(0, 1, 4, 3), (1, 4, 5, 2), (3, 4, 7), (3, 7, 6), (4, 5, 8, 7)]
        sheet[8] = [0.9, 0.9, 0]
        write_obj(self.folder / "sheet.obj", sheet, faces)
        done = run("--meshes", self.folder / "sheet.obj", "--out", self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        row = self.rows("meshes.csv")[0]
        self.assertEqual((row["quads"], row["other_faces"], row["boundary_loops"], row["euler"]), ("3", "2", "1", "1"))
        self.assertEqual((row["turned_edges"], row["sj_not_positive"]), ("2", "1"))
        self.assertNotIn("distance_mean", row)

    def test_distance_is_that_of_a_shift(self):
        write_obj(self.folder / "cube.obj")
        grown = (CUBE - 0.5) * 1.2 + 0.5  # each side 0.1 farther out
        write_obj(self.folder / "grown.obj", grown)
        done = run("--meshes", self.folder / "grown.obj", "--surface", self.folder / "cube.obj", "--out",
                   self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        row = self.rows("meshes.csv")[0]
        self.assertGreaterEqual(float(row["distance_mean"]), 10 / math.sqrt(3))
        self.assertLessEqual(float(row["distance_largest"]), 100 * 0.1 + 1e-9)  # a corner: 0.1 sqrt 3 of sqrt 3

    def test_blocks_of_a_mesh(self):
        def sheet(name, cells):
            points = [(i, k, 0) for k in range(5) for i in range(5)]
            write_obj(self.folder / name, points,
                      [(i + 5 * k, i + 1 + 5 * k, i + 6 + 5 * k, i + 5 + 5 * k) for i, k in cells])
        cells = [(i, k) for i in range(4) for k in range(4)]
        sheet("square.obj", cells)
        sheet("corner.obj", [(i, k) for i, k in cells if i < 2 or k < 2])  # its inner corner draws two lines
        sheet("ring.obj", [(i, k) for i, k in cells if i in (0, 3) or k in (0, 3)])  # four inner corners, eight
        write_obj(self.folder / "triangle.obj", CUBE, [*FACES[1:], (0, 1, 3), (0, 3, 2)])
        names = ("square.obj", "corner.obj", "ring.obj", "triangle.obj")
        done = run("--meshes", *(self.folder / name for name in names), "--out", self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual([row["patches"] for row in self.rows("meshes.csv")], ["1", "3", "8", ""])

    def test_sharp_edges_are_as_far_as_the_mesh_is_moved(self):
        write_obj(self.folder / "cube.obj")
        write_obj(self.folder / "moved.obj", CUBE + [0.3, 0, 0])
        done = run("--meshes", self.folder / "moved.obj", "--surface", self.folder / "cube.obj", "--out",
                   self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        row = self.rows("meshes.csv")[0]
        # A third each: edges along x lie on the moved ones but for 0.3; those at x = 0 are 0.3 off; those at x = 1 too,
        # but for both ends, where the moved edges along x come by. Places are the middles of parts of an edge.
        percent = 100 / math.sqrt(3)
        self.assertAlmostEqual(float(row["feature_mean"]), percent * (0.045 + 0.3 + 0.3 - 2 * 0.045) / 3, delta=0.01)
        # VTK 9.1 reads .obj in single precision: 0.3 is off by up to 2^-26.
        self.assertAlmostEqual(float(row["feature_largest"]), percent * 0.3, delta=percent * 2**-26)
        self.assertAlmostEqual(float(row["feature_share"]), (1 - 0.2) / 3, delta=0.01)

    def test_maps_with_guides(self):
        done = run(DATA / "beast.ply", "--quads", 600, "--budgets", "600", "--guides", "--out", self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = self.rows("evaluation.csv")
        free = [row for row in rows if row["model"] == "beast"]
        asked = [row for row in rows if row["model"] == "beast-guided"]
        self.assertEqual([row["map"] for row in asked], ["without decimation", "E_G,mem", "E_G", "E_QEM", "E_uni"])
        self.assertEqual({row["guides"] for row in free}, {""})
        for row in asked:  # any two directions are 22.5 degrees apart in the mean
            self.assertGreaterEqual(float(row["guides"]), 0)
            self.assertLess(float(row["guides"]), 15)

    def test_figures_of_other_tools_beside_ours(self):
        table = self.folder / "tools.csv"
        table.write_text("model,asked,mesh,quads,irregular,sj_mean,note\npart,600,Tool,590,80,0.9,hole lost\n"
                         "part,2500,Tool,2500,80,0.9,\nother,600,Tool,590,80,0.9,\n")
        done = run(DATA / "part.ply", "--beside", table, "--quads", 600, "--out", self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = self.rows("meshes.csv")
        self.assertEqual([row["mesh"] for row in rows], ["part: Quadrille", "part: Tool (table)"])
        self.assertEqual((rows[1]["quads"], rows[1]["irregular"], rows[1]["note"]), ("590", "80", "hole lost"))
        self.assertIn("hole lost", (self.folder / "out" / "index.html").read_text(encoding="utf-8"))
        for text, wrong in (("model,mesh\na,b\n", "'asked'"),
                            ("model,asked,mesh,quads\npart,600,Tool,many\n", "line 2")):
            table.write_text(text)
            done = run(DATA / "part.ply", "--beside", table, "--out", self.folder / "wrong")
            self.assertEqual(done.returncode, 2)
            self.assertIn(wrong, done.stderr)
            self.assertFalse((self.folder / "wrong").exists())

    def test_gmsh_is_asked_for_where_it_is_not_there(self):
        done = run(DATA / "part.ply", "--gmsh", "--out", self.folder / "out", environment={"PATH": "/nowhere"})
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("gmsh is not there", done.stderr)
        self.assertFalse((self.folder / "out").exists())

    @unittest.skipUnless(shutil.which("gmsh"), "Gmsh is not installed")
    def test_quads_beside_those_of_gmsh(self):
        done = run(DATA / "part.ply", "--gmsh", "--quads", 600, "--out", self.folder / "out")
        self.assertIn(done.returncode, (0, 3), done.stderr)
        rows = self.rows("meshes.csv")
        self.assertEqual([row["mesh"] for row in rows],
                         ["part: Quadrille", "part: Gmsh, recombined", "part: Gmsh, full quad"])
        self.assertEqual((rows[0]["other_faces"], rows[0]["error"]), ("0", ""))
        for row in rows[1:]:
            self.assertTrue(row["error"] or int(row["quads"]) > 0)

    def test_errors_name_the_file_and_leave_nothing(self):
        (self.folder / "bad.msh").write_text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2 1 2\n")
        (self.folder / "binary.msh").write_text("$MeshFormat\n4.1 1 8\n$EndMeshFormat\n$Nodes\n$EndNodes\n$Elements\n")
        for words, expected in (((self.folder / "none.ply",), "no such file"),
                                (("--meshes", self.folder / "bad.msh"), "damaged"),
                                (("--meshes", self.folder / "binary.msh"), "as text"),
                                (("--meshes", self.folder / "none.msh"), "no such file"),
                                (("--budgets", "3", DATA / "part.ply"), "whole number from 4 on"),
                                ((), "neither a surface nor a mesh")):
            done = run(*words, "--out", self.folder / "out")
            self.assertEqual(done.returncode, 2, words)
            self.assertIn(expected, done.stderr)
            self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    unittest.main()
