# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The commands quadrille, quadrille-bench and quadrille-costs: formats, exit codes, report, nothing half-written; and
`import quadrille` in the system's python3."""
import argparse
import csv
import io
import json
import math
import os
import pathlib
import pty
import random
import shutil
import struct
import subprocess
import unittest

import quadrille
from vtkmodules.vtkCommonCore import VTK_DOUBLE, vtkIntArray
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkIOExodus import vtkExodusIIReader
from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLWriter
from vtkmodules.vtkIOLegacy import vtkPolyDataWriter
from vtkmodules.vtkIOPLY import vtkPLYReader, vtkPLYWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter, vtkXMLUnstructuredGridReader

ARGS = None


def torus(around=48, across=24):
    """Points and triangles; the normal points outwards."""
    points, faces = [], []
    for i in range(around):
        for j in range(across):
            a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
            r = 1 + 0.4 * math.cos(b)
            points.append((r * math.cos(a), r * math.sin(a), 0.4 * math.sin(b)))
            p, q = i * across + j, (i + 1) % around * across + j
            r, s = i * across + (j + 1) % across, (i + 1) % around * across + (j + 1) % across
            faces += [(p, q, s), (p, s, r)]
    return points, faces


def edges(faces):
    found = {}
    for face in faces:
        for k in range(len(face)):
            edge = tuple(sorted((face[k], face[(k + 1) % len(face)])))
            found[edge] = found.get(edge, 0) + 1
    return found


def faces_of(data):
    cells = data.GetPolys() if isinstance(data, vtkPolyData) else data.GetCells()
    offsets = [cells.GetOffsetsArray().GetValue(i) for i in range(cells.GetNumberOfCells() + 1)]
    ids = [cells.GetConnectivityArray().GetValue(i) for i in range(cells.GetNumberOfConnectivityIds())]
    return [ids[a:b] for a, b in zip(offsets, offsets[1:])]


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def on_a_terminal(words):
    """What a program shows on a terminal of 80 columns, and its exit code."""
    ours, theirs = pty.openpty()
    process = subprocess.Popen([*map(str, words)], stdout=theirs, stderr=theirs, stdin=theirs)
    os.close(theirs)
    shown = b""
    while True:
        try:
            more = os.read(ours, 4096)
        except OSError:  # the other end is closed
            break
        if not more:
            break
        shown += more
    os.close(ours)
    return shown.decode(errors="replace"), process.wait(timeout=60)


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(ARGS.work) / self.id()
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)

    def run_quadrille(self, *words, expect=0):
        result = subprocess.run([ARGS.quadrille, *map(str, words)], capture_output=True, text=True,
                                errors="replace", timeout=300)
        self.assertEqual(result.returncode, expect, result.stderr)
        return result

    def write_off(self, name="torus.off"):
        points, faces = torus()
        path = self.folder / name
        path.write_text(f"OFF # a comment\n{len(points)} {len(faces)} 0\n\n" +
                        "".join("%.17g %.17g %.17g\n" % p for p in points) +
                        "".join("3 %d %d %d 0.5 0.5 0.5\n" % f for f in faces))
        return path

    def assertTorusOfQuads(self, points, faces):
        self.assertGreater(len(faces), 0)
        self.assertEqual({len(f) for f in faces}, {4})
        uses = edges(faces)
        self.assertEqual(set(uses.values()), {2})
        self.assertEqual(points - len(uses) + len(faces), 0)


class Formats(Case):
    def test_far_from_the_origin_all_formats_keep_the_digits(self):
        """A map in metres: single precision knows half of one there."""
        shift = (4500000.125, 5400000.25, 300.5)
        points, faces = torus()
        far = [tuple(x + s for x, s in zip(p, shift)) for p in points]
        off, obj = self.folder / "far.off", self.folder / "far.obj"
        off.write_text(f"OFF\n{len(far)} {len(faces)} 0\n" + "".join("%.17g %.17g %.17g\n" % p for p in far) +
                       "".join("3 %d %d %d\n" % f for f in faces))
        obj.write_text("".join("v %.17g %.17g %.17g\n" % p for p in far) +
                       "".join("f %d %d %d\n" % tuple(v + 1 for v in f) for f in faces))
        self.run_quadrille(self.write_off("near.off"), self.folder / "near.obj", "--quads", 300)
        near = self.obj_points(self.folder / "near.obj")
        for source in (off, obj):
            results = {}
            for extension in ("obj", "ply", "vtp", "vtu"):
                target = self.folder / f"{source.suffix[1:]}.{extension}"
                self.run_quadrille(source, target, "--quads", 300)
                results[extension] = self.points_of(target)
            # VTK's reader of Exodus files has single precision, the file has more: a NetCDF variable of type 6, double.
            target = self.folder / f"{source.suffix[1:]}.ex2"
            self.run_quadrille(source, target, "--quads", 300)
            data = target.read_bytes()
            at = data.find(b"coordx")
            kind, _, begin = struct.unpack(">IIQ", data[at + 24:at + 40])
            self.assertEqual(kind, 6)
            self.assertEqual(struct.unpack(">5d", data[begin:begin + 40]), tuple(p[0] for p in results["vtp"][:5]))
            for extension, found in results.items():
                self.assertEqual(found, results["vtp"], f"{source.suffix} {extension}")
            self.assertEqual(len(results["vtp"]), len(near))
            for p, q in zip(results["vtp"], near):
                self.assertLess(math.dist([a - b for a, b in zip(p, shift)], q), 1e-7)

    def test_an_obj_file_that_its_reader_cannot_tell_apart_is_refused(self):
        """Readers of some versions of VTK can, as they have double precision: there are quads then."""
        points, faces = torus()
        path = self.folder / "textured.obj"
        path.write_text("".join("v %.17g %.17g %.17g\n" % (x + 4.5e6, y, z) for x, y, z in points) +
                        "vt 0 0\nvt 1 1\n" +
                        "".join("f %d/1 %d/2 %d/1\n" % tuple(v + 1 for v in f) for f in faces))
        reader = vtkOBJReader()
        reader.SetFileName(str(path))
        reader.Update()
        if reader.GetOutput().GetPoints().GetDataType() == VTK_DOUBLE:
            self.run_quadrille(path, self.folder / "out.obj")
            self.assertGreater(len(self.obj_points(self.folder / "out.obj")), 1000)
            return
        result = self.run_quadrille(path, self.folder / "out.obj", expect=2)
        self.assertIn("texture coordinates", result.stderr)

    @staticmethod
    def obj_points(path):
        return [tuple(map(float, line.split()[1:])) for line in path.read_text().splitlines() if line.startswith("v ")]

    def points_of(self, path):
        if path.suffix == ".obj":
            return self.obj_points(path)
        if path.suffix == ".ply":
            header, body = path.read_bytes().split(b"end_header\n", 1)
            self.assertIn(b"property double x", header)
            count = int(header.split(b"element vertex ")[1].split()[0])
            return list(struct.iter_unpack("<ddd", body[:24 * count]))
        data = read(vtkXMLPolyDataReader() if path.suffix == ".vtp" else vtkXMLUnstructuredGridReader(), path)
        return [data.GetPoint(i) for i in range(data.GetNumberOfPoints())]

    def test_reads_every_input(self):
        mesh = quadrille.to_polydata(*torus())
        self.write_off()
        for writer, name in ((vtkPLYWriter(), "t.ply"), (vtkSTLWriter(), "t.stl"), (vtkPolyDataWriter(), "t.vtk"),
                             (vtkXMLPolyDataWriter(), "t.vtp")):
            writer.SetInputData(mesh)
            writer.SetFileName(str(self.folder / name))
            if name == "t.vtp":
                writer.SetDataModeToBinary()
            writer.Write()
        points, faces = torus()
        (self.folder / "t.obj").write_text("".join("v %.17g %.17g %.17g\n" % p for p in points) +
                                           "".join("f %d %d %d\n" % tuple(i + 1 for i in f) for f in faces))
        for name in ("torus.off", "t.ply", "t.stl", "t.vtk", "t.vtp", "t.obj"):
            with self.subTest(name):
                out = self.folder / (name + ".obj")
                self.run_quadrille(self.folder / name, out, "--quads", 300)
                data = read(vtkOBJReader(), out)
                self.assertTorusOfQuads(data.GetNumberOfPoints(), faces_of(data))

    def test_writes_every_output(self):
        source = self.write_off()
        sizes = set()
        for reader, name in ((vtkXMLPolyDataReader(), "q.vtp"), (vtkOBJReader(), "q.obj"), (vtkPLYReader(), "q.ply"),
                             (vtkXMLUnstructuredGridReader(), "q.vtu"), (vtkExodusIIReader(), "q.ex2")):
            with self.subTest(name):
                out = self.folder / name
                self.run_quadrille(source, out, "--quads", 300)
                data = read(reader, out)
                if name == "q.ex2":
                    data = data.GetBlock(0).GetBlock(0)
                self.assertTorusOfQuads(data.GetNumberOfPoints(), faces_of(data))
                sizes.add((data.GetNumberOfPoints(), data.GetNumberOfCells()))
                if name in ("q.vtp", "q.vtu"):
                    self.assertTrue(data.GetPointData().HasArray("Valence"))
                    # Texts only where all readers take them.
                    self.assertEqual(data.GetFieldData().HasArray("Certificate"), name == "q.vtp")
                    self.assertTrue(data.GetFieldData().HasArray("CertificateValues"))
                    self.assertNotIn(b"<AppendedData", out.read_bytes())
        self.assertEqual(len(sizes), 1)
        self.run_quadrille(source, self.folder / "q.vtu", "--quads", 300, "--file-details")
        data = read(vtkXMLUnstructuredGridReader(), self.folder / "q.vtu")
        self.assertTrue(data.GetFieldData().HasArray("Certificate"))
        leftovers = [p.name for p in self.folder.iterdir() if ".part" in p.name]
        self.assertEqual(leftovers, [])


    def test_ply_keeps_every_property(self):
        points, faces = torus()
        header = ["comment x", f"element vertex {len(points)}", "property double x", "property double y",
                  "property double z", "property uchar red", "property uchar green", "property uchar blue",
                  "property float quality", "element edge 1", "property int vertex1", f"element face {len(faces)}",
                  "property uchar flag", "property list uchar int vertex_indices", "property int Body",
                  "end_header", ""]
        bodies = [int(3 * f / len(faces)) for f in range(len(faces))]
        text = "".join("%.17g %.17g %.17g 10 20 30 %.9g\n" % (*p, p[2]) for p in points) + "7\n"
        text += "".join("9 3 %d %d %d %d\n" % (*f, b) for f, b in zip(faces, bodies))
        variants = {"ascii": text.encode()}
        for name, order in (("binary_little_endian", "<"), ("binary_big_endian", ">")):
            variants[name] = b"".join(struct.pack(order + "3d3Bf", *p, 10, 20, 30, p[2]) for p in points)
            variants[name] += struct.pack(order + "i", 7)
            variants[name] += b"".join(struct.pack(order + "BB4i", 9, 3, *f, b) for f, b in zip(faces, bodies))
        for name, body in variants.items():
            with self.subTest(name):
                path = self.folder / f"{name}.ply"
                path.write_bytes("\n".join(["ply", f"format {name} 1.0"] + header).encode() + body)
                out = self.folder / f"{name}.vtp"
                self.run_quadrille(path, out, "--quads", 300)
                data = read(vtkXMLPolyDataReader(), out)
                self.assertTorusOfQuads(data.GetNumberOfPoints(), faces_of(data))
                quality, rgb = data.GetPointData().GetArray("quality"), data.GetPointData().GetArray("RGB")
                for i in range(data.GetNumberOfPoints()):
                    self.assertAlmostEqual(quality.GetTuple1(i), data.GetPoint(i)[2], 5)  # float
                    self.assertEqual(rgb.GetTuple3(i), (10, 20, 30))
                self.assertEqual(data.GetCellData().GetArray("Body").GetRange(), (0, 2))
                self.assertEqual(data.GetCellData().GetArray("flag").GetRange(), (9, 9))
                path.write_bytes(path.read_bytes()[:-20])  # cut off in the last faces
                self.assertIn("face", self.run_quadrille(path, out, expect=2).stderr)

    def test_off_keeps_what_its_first_word_promises(self):
        points, faces = torus()
        path, out = self.folder / "all.off", self.folder / "q.vtp"
        lines = ["STCNOFF", f"{len(points)} {len(faces)} 0"]
        lines += ["%.17g %.17g %.17g 0 0 1 10 20 30 0.25 0.75" % p for p in points]
        lines += ["3 %d %d %d %d" % (*f, 3 * i // len(faces)) for i, f in enumerate(faces)]
        path.write_text("\n".join(lines))
        self.run_quadrille(path, out, "--quads", 300)
        data = read(vtkXMLPolyDataReader(), out)
        self.assertTorusOfQuads(data.GetNumberOfPoints(), faces_of(data))
        self.assertEqual({data.GetPointData().GetArray("RGB").GetTuple3(i) for i in range(data.GetNumberOfPoints())},
                         {(10, 20, 30)})
        self.assertEqual(data.GetCellData().GetArray("ColorIndex").GetRange(), (0, 2))
        for number, line, words in ((2, "0 0 0 0 0 1 10 20 30 0.25", ["vertex 0", "colour"]),
                                    (3, "0 0 0 0 0", ["vertex 1", "normal"]),
                                    (4, "0 0 0 0 0 1 1", ["vertex 2", "texture"]),
                                    (5, "0 0 0 0 0 1 10 20 nan 0 0", ["vertex 3", "colour"])):
            damaged = list(lines)
            damaged[number] = line
            path.write_text("\n".join(damaged))
            told = self.run_quadrille(path, out, expect=2).stderr
            for word in words:
                self.assertIn(word, told)

    def test_ply_strips(self):
        # A closed band of 40 columns of one strip each: an open cylinder.
        columns, rows, strips, points = 40, 20, [], []
        for i in range(columns):
            for j in range(rows + 1):
                a = 2 * math.pi * i / columns
                points.append((math.cos(a), math.sin(a), 0.15 * j))
        for i in range(columns):
            for j in range(rows + 1):
                strips += [(i + 1) % columns * (rows + 1) + j, i * (rows + 1) + j]
            strips.append(-1)
        path = self.folder / "strips.ply"
        path.write_text(f"ply\nformat ascii 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
                        "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                        "".join("%.9g %.9g %.9g\n" % p for p in points) + " ".join(map(str, [len(strips)] + strips)))
        out, report = self.folder / "q.obj", self.folder / "r.json"
        self.run_quadrille(path, out, "--quads", 400, "--report", report)
        quality = json.loads(report.read_text())["quality"]
        self.assertEqual((quality["manifold"], quality["boundary_loops"], quality["euler_characteristic"]),
                         (True, 2, 0))


class ExitCodes(Case):
    def write_two_parts(self):
        """A torus, and one with a tree of features through all its points, which few quads cannot follow."""
        path = self.folder / "parts.vtk"
        points, faces = torus(64, 32)
        count = len(points)
        both = points + [(x + 20, y, z) for x, y, z in points]
        polygons = faces + [tuple(i + count for i in f) for f in faces]
        reached, tree = {faces[0][0]}, [0] * len(faces)
        while len(reached) < count:
            for f, corners in enumerate(faces):
                for i, (a, b) in enumerate(zip(corners, corners[1:] + corners[:1])):
                    if a in reached and b not in reached:
                        reached.add(b)
                        tree[f] |= 1 << i
        bits = [0] * len(faces) + tree
        path.write_text("# vtk DataFile Version 3.0\ntwo\nASCII\nDATASET POLYDATA\nPOINTS %d double\n" % len(both)
                        + "".join("%.9g %.9g %.9g\n" % p for p in both)
                        + "POLYGONS %d %d\n" % (len(polygons), 4 * len(polygons))
                        + "".join("3 %d %d %d\n" % f for f in polygons)
                        + "CELL_DATA %d\nSCALARS FeatureEdges unsigned_char 1\nLOOKUP_TABLE default\n" % len(bits)
                        + "\n".join(map(str, bits)) + "\n")
        return path

    def test_a_component_without_quads_has_an_exit_code_of_its_own(self):
        source, out, report = self.write_two_parts(), self.folder / "q.obj", self.folder / "r.json"
        told = self.run_quadrille(source, out, "--quads", 40, "--report", report, expect=5).stderr
        self.assertIn("1 of 2 connected components", told)
        said = json.loads(report.read_text())
        self.assertEqual((said["exit_code"], said["components_without_quads"], said["certificate"]["valid"]),
                         (5, 1, False))
        self.assertTrue(said["quality"]["manifold"])
        self.assertIn("1 of 2 connected components",
                      self.run_quadrille(source, out, "--quads", 40, "--quiet", expect=5).stderr)
        told = self.run_quadrille(source, self.folder / "none.obj", "--quads", 40, "--failed-components", "fail",
                                  expect=3).stderr
        self.assertRegex(told, r"parts\.vtk: ask for smaller quads")
        self.assertFalse((self.folder / "none.obj").exists())

    def test_help(self):
        self.assertIn("usage: quadrille", self.run_quadrille("--help").stdout)

    def test_on_a_terminal_the_progress_is_one_line(self):
        source = self.write_off()
        shown, code = on_a_terminal([ARGS.quadrille, source, self.folder / "q.obj", "--quads", "20000"])
        self.assertEqual(code, 0, shown)
        self.assertRegex(shown, r"\r\x1b\[K\[#*\.*\] +\d+ % +\d+ s  \S")
        bars, _, rest = shown.rpartition("\r\x1b[K")  # what stands after the bar was taken away
        self.assertNotIn("\n", bars)
        self.assertIn("20,", rest)
        self.assertIn("no folds", rest)
        self.assertNotIn(" %", rest)
        shown, code = on_a_terminal([ARGS.quadrille, source, self.folder / "q.obj", "--quads", "300", "--quiet"])
        self.assertEqual((shown, code), ("", 0))

    def test_elsewhere_a_short_run_shows_no_progress(self):
        told = self.run_quadrille(self.write_off(), self.folder / "q.obj", "--quads", 300).stderr
        self.assertNotIn(" % ", told)
        self.assertRegex(told.splitlines()[-1], r"q\.obj: \d+ quads \(asked for 300\), \d+ points, "
                         r"edge length .* s; the map has no folds")
        self.assertEqual(self.run_quadrille(self.write_off(), self.folder / "q.obj", "--quads", 300, "--quiet").stderr,
                         "")
        # What goes wrong is told all the same.
        self.assertIn("limit", self.run_quadrille(self.write_off(), self.folder / "q.obj", "--quads", 300, "--quiet",
                                                  "--maximum-quads", 10, expect=3).stderr)

    def test_repairs_are_told_in_sentences(self):
        points, faces = torus()
        faces = faces + faces[:2] + [(5, 5, 6)]
        path = self.folder / "broken.off"
        path.write_text("\n".join(["OFF", f"{len(points) + 1} {len(faces)} 0"]
                                  + ["%g %g %g" % p for p in points + [(9, 9, 9)]]
                                  + ["3 %d %d %d" % f for f in faces]))
        told = self.run_quadrille(path, self.folder / "q.obj", "--quads", 300).stderr.splitlines()
        self.assertIn("- input: 2 faces that were there already were removed", told)
        self.assertIn("- input: 1 face without area was removed", told)
        self.assertIn("- input: 1 point that no face uses was left out", told)

    def test_an_option_nearly_right_is_named(self):
        source, out = self.write_off(), self.folder / "q.obj"
        self.assertIn("did you mean --quads?", self.run_quadrille(source, out, "--quad", 5, expect=2).stderr)
        self.assertIn("did you mean --edge-length?",
                      self.run_quadrille(source, out, "--edgelength", 5, expect=2).stderr)
        self.assertIn("--help", self.run_quadrille(source, out, "--bananas", 5, expect=2).stderr)
        for word in ("--quiet=1", "--quiet=", "--help=1"):
            self.assertIn(word.split("=")[0] + " takes no value",
                          self.run_quadrille(source, out, word, expect=2).stderr)
        self.assertIn("unknown option -quads;", self.run_quadrille(source, out, "-quads", 5, expect=2).stderr)

    def test_wrong_values_name_the_option_and_what_it_may_be(self):
        source, out = self.write_off(), self.folder / "q.obj"
        for words, told in ((("--quads",), "--quads needs a value"),
                            (("--quads", "many"), "--quads needs a number from 1 to"),
                            (("--edge-length", "-1"), "not '-1'"),
                            (("--quads=5", "--quads=6"), "--quads is given twice"),
                            (("--quads", "5", "--edge-length", "1"), "only one of --quads"),
                            (("--method", "best"), "--method needs scale-aware, mixed-integer, quadcover or seamless"),
                            (("--integers", "all"), "--integers needs keep-sizes or coarsest, not 'all'"),
                            (("--coarse-vertices", "some"), "--coarse-vertices needs auto or a number from 4 to"),
                            (("--map", "map.obj"), "a map needs the extension vtp"),
                            (("third.obj",), "an input and an output file")):
            with self.subTest(words):
                self.assertIn(told, self.run_quadrille(source, out, *words, expect=2).stderr)
                self.assertFalse(out.exists())

    def test_help_and_version(self):
        usage = self.run_quadrille("--help").stdout
        self.assertTrue(usage.startswith("usage: quadrille") and usage.endswith("(--failed-components)\n"))
        # Who asks for help may not know yet what is wrong.
        for words in (("-h",), ("a.off", "--help"), ("--quads", "many", "--help"), ("--help", "--bananas"),
                      ("--help", "--quads")):
            self.assertEqual(self.run_quadrille(*words).stdout, usage)
        for program in (ARGS.quadrille, ARGS.bench, ARGS.costs):
            result = subprocess.run([program, "--version"], capture_output=True, text=True, timeout=60)
            self.assertEqual(result.returncode, 0)
            self.assertRegex(result.stdout, r"^Quadrille \d+\.\d+\.\d+\n$")

    def test_the_help_has_every_option_once(self):
        for program in (ARGS.quadrille, ARGS.bench, ARGS.costs):
            text = subprocess.run([program, "--help"], capture_output=True, text=True, timeout=60).stdout
            options = [line.split()[0] for line in text.splitlines() if line.startswith("  --")]
            self.assertEqual(len(options), len(set(options)))
            self.assertIn("--quads", options)
            self.assertLessEqual(max(map(len, text.splitlines())), 120)
            for option in options:
                if option in ("--quiet", "--version", "--quality", "--file-details"):
                    continue
                # Each is known: what is wrong is its value.
                result = subprocess.run([program, "in.off", "out.obj", option], capture_output=True, text=True,
                                        timeout=60)
                self.assertEqual((result.returncode, f"{option} needs a value" in result.stderr), (2, True),
                                 result.stderr)

    def test_bad_arguments(self):
        source = self.write_off()
        out = self.folder / "q.obj"
        for words in ((), (source,), (source, out, "--quads"), (source, out, "--quads", "many"),
                      (source, out, "--quads", "0"), (source, out, "--quads", "5", "--edge-length", "1"),
                      (source, out, "--edge-length", "-1"), (source, out, "--nonsense", "1"),
                      (source, self.folder / "q.dae"), (source, self.folder / "missing" / "q.obj"),
                      (source, out, "--feature-angle", "200"), (source, out, "--quads", "10", "--quads", "20")):
            with self.subTest(words):
                self.assertIn("quadrille", self.run_quadrille(*words, expect=2).stderr)
                self.assertFalse(out.exists())

    def test_bad_input_names_the_element(self):
        points, faces = torus(12, 6)
        lines = ["OFF", f"{len(points)} {len(faces)} 0"] + ["%g %g %g" % p for p in points]
        lines += ["3 %d %d %d" % f for f in faces]
        cases = {
            "nan": (lambda l: l.__setitem__(2 + 5, "0 nan 0"), "5"),
            "corner": (lambda l: l.__setitem__(-1, "3 0 1 99999"), f"face {len(faces) - 1}"),
            "short": (lambda l: l.__delitem__(slice(20, None)), "vertex 18"),
            "counts": (lambda l: l.__setitem__(1, "what"), "counts"),
            "empty": (lambda l: l.clear(), "empty"),
        }
        for name, (damage, told) in cases.items():
            with self.subTest(name):
                damaged = list(lines)
                damage(damaged)
                path = self.folder / f"{name}.off"
                path.write_text("\n".join(damaged))
                report = self.folder / f"{name}.json"
                result = self.run_quadrille(path, self.folder / "q.obj", "--report", report, expect=2)
                self.assertIn(told, result.stderr)
                self.assertFalse((self.folder / "q.obj").exists())
                content = json.loads(report.read_text())
                self.assertEqual(content["exit_code"], 2)
                self.assertIn(told, content["error"])
        self.run_quadrille(self.folder / "absent.ply", self.folder / "q.obj", expect=2)

    def test_no_valid_result(self):
        # More quads than the limit is the one failure that needs no luck to provoke.
        source = self.write_off()
        report = self.folder / "r.json"
        out = self.folder / "q.vtp"
        out.write_text("an older result")
        result = self.run_quadrille(source, out, "--quads", 900000000, "--report", report, expect=3)
        self.assertIn("limit", result.stderr)
        self.assertEqual(json.loads(report.read_text())["exit_code"], 3)
        self.assertEqual(out.read_text(), "an older result")

    def test_damaged_files_of_vtk_readers(self):
        for extension in ("ply", "vtp", "stl", "obj", "vtk"):
            with self.subTest(extension):
                path = self.folder / f"garbage.{extension}"
                path.write_bytes(bytes((7 * i * i + 13) % 256 for i in range(3000)))
                self.run_quadrille(path, self.folder / "q.obj", expect=2)
                self.assertFalse((self.folder / "q.obj").exists())


    def test_lying_headers(self):
        """Counts beyond the file must neither take the memory nor end in a crash."""
        huge = 123456789012
        vtp = ('<?xml version="1.0"?><VTKFile type="PolyData" version="0.1"><PolyData>'
               '<Piece NumberOfPoints="{0}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0">'
               '<Points><DataArray type="Float32" NumberOfComponents="{1}" format="ascii">0 0 0</DataArray></Points>'
               '</Piece></PolyData></VTKFile>')
        files = {
            "huge.ply": f"ply\nformat ascii 1.0\nelement vertex {huge}\nproperty float x\nproperty float y\n"
                        f"property float z\nelement face {huge}\nproperty list uchar int vertex_indices\nend_header\n"
                        "0 0 0\n",
            "huge.off": f"OFF\n{huge} {huge} 0\n0 0 0\n",
            "huge.vtk": f"# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS {huge} float\n0 0 0\n"
                        f"POLYGONS {huge} {4 * huge}\n3 0 0 0\n",
            "points.vtp": vtp.format(huge, 3),
            "components.vtp": vtp.format(1, 2147483648),
        }
        for name, text in files.items():
            with self.subTest(name):
                (self.folder / name).write_text(text)
                self.run_quadrille(self.folder / name, self.folder / "q.obj", expect=2)
        (self.folder / "huge.stl").write_bytes(b"x" * 80 + b"\xff\xff\xff\x7f" + b"\0" * 50)
        self.assertIn("triangles", self.run_quadrille(self.folder / "huge.stl", self.folder / "q.obj", expect=2).stderr)


class Report(Case):
    def test_report_of_a_success(self):
        report = self.folder / "r.json"
        out = self.folder / "q.vtp"
        self.run_quadrille(pathlib.Path(ARGS.data) / "frame.ply", out, "--quads", 1500, "--threads", 2,
                           "--report", report)
        content = json.loads(report.read_text())
        data = read(vtkXMLPolyDataReader(), out)
        self.assertEqual(content["exit_code"], 0)
        self.assertEqual(content["error"], "")
        self.assertEqual(content["quads_actual"], data.GetNumberOfCells())
        self.assertEqual(content["quads_asked"], 1500)
        self.assertTrue(content["certificate"]["valid"])
        self.assertEqual(content["quality"]["euler_characteristic"], -4)  # genus 3
        self.assertEqual(content["handles"], 3)
        self.assertEqual(content["unresolved_handles"], 0)
        self.assertGreater(content["shortest_loop_over_edge_length"], 3)
        self.assertEqual(content["shortest_boundary_over_edge_length"], 0)
        self.assertTrue(content["quality"]["manifold"] and content["quality"]["closed"])
        self.assertIn("duplicate_faces", content["repair"])
        self.assertEqual(content["constraints"], [])
        self.assertEqual(set(content["extraction"].values()), {0})
        stages = [s["stage"] for s in content["stages"]]
        self.assertEqual(stages[0], "read")
        for stage in ("repair", "phase1", "phase2", "field", "seamless", "quantize", "embed", "replay", "extract"):
            self.assertIn(stage, stages)
        self.assertLessEqual(sum(s["seconds"] for s in content["stages"]), 1.05 * content["seconds_total"] + 0.05)

    def test_report_has_a_word_on_each_constraint(self):
        points, faces = torus()
        surface = quadrille.to_polydata(points, faces)
        asked = vtkIntArray()
        asked.SetName("TargetValence")
        asked.SetNumberOfTuples(len(points))
        asked.Fill(0)
        wanted = {100: 5, 700: 3}
        for point, valence in wanted.items():
            asked.SetValue(point, valence)
        surface.GetPointData().AddArray(asked)
        writer = vtkXMLPolyDataWriter()
        writer.SetInputData(surface)
        writer.SetFileName(str(self.folder / "torus.vtp"))
        writer.Write()
        report, out = self.folder / "r.json", self.folder / "q.vtp"
        self.run_quadrille(self.folder / "torus.vtp", out, "--quads", 800, "--report", report)
        told = json.loads(report.read_text())["constraints"]
        self.assertEqual([row["source_id"] for row in told], list(wanted))
        quads = read(vtkXMLPolyDataReader(), out)
        for row in told:
            self.assertEqual(row["kind"], "valence")
            self.assertIsNone(row["deviation_95"])
            self.assertLess(math.dist(row["place"], points[row["source_id"]]), 1e-6)
            nearest = quads.FindPoint(row["place"])
            is_there = math.dist(quads.GetPoint(nearest), row["place"]) < 1e-6
            got = quads.GetPointData().GetArray("Valence").GetTuple1(nearest) if is_there else 4
            self.assertEqual(row["deviation"], got - wanted[row["source_id"]])
            self.assertEqual(row["met"], row["deviation"] == 0)
            self.assertEqual(row["met"], row["reason"] == "")

    def test_automatic_coarse_level(self):
        sizes = {}
        for budget in ("auto", 500):
            report = self.folder / f"{budget}.json"
            self.run_quadrille(pathlib.Path(ARGS.data) / "beast.ply", self.folder / "quads.vtp", "--quads", 2500,
                               "--coarse-vertices",
                               budget, "--report", report)
            sizes[budget] = json.loads(report.read_text())["sizes"]["coarse_vertices"]
        self.assertEqual(sizes[500], 500)
        self.assertTrue(500 < sizes["auto"] < 4000)
        self.run_quadrille(pathlib.Path(ARGS.data) / "beast.ply", self.folder / "no.vtp", "--coarse-vertices", "some",
                           expect=2)

    def test_a_name_that_is_no_utf_8(self):
        source = self.write_off().rename(self.folder / os.fsdecode(b"caf\xe9.off"))
        report = self.folder / "r.json"
        self.run_quadrille(source, self.folder / "q.obj", "--quads", 300, "--report", report)
        self.assertIn("caf\ufffd.off", json.loads(report.read_text(encoding="utf-8"))["input"])


    def test_handles_are_closed_on_request(self):
        # Round the tube of the torus it is 2.5.
        source = self.write_off()
        for words, unresolved, closed, euler in ((("--small-details", "resolve"), 1, 0, 0),
                                                 (("--smallest-detail", 3), 0, 1, 2)):
            with self.subTest(words):
                report = self.folder / "r.json"
                result = self.run_quadrille(source, self.folder / "q.obj", "--edge-length", 0.9, *words, "--report",
                                            report)
                content = json.loads(report.read_text())
                self.assertEqual(content["unresolved_handles"], unresolved)
                self.assertEqual(content["repair"]["closed_handles"], closed)
                self.assertEqual(content["quality"]["euler_characteristic"], euler)
                self.assertIn("three quads" if unresolved else "cut and closed", result.stderr)
        self.run_quadrille(source, self.folder / "q.obj", "--close-handles", -1, expect=2)


    def test_small_details_are_decided_on_and_told(self):
        # Round the tube of the torus it is 2.5: 0.8 edge lengths.
        source = self.write_off()
        for words, decision, euler in (((), "simplified", 2), (("--small-details", "resolve"), "resolved", 0)):
            with self.subTest(words):
                report = self.folder / "r.json"
                result = self.run_quadrille(source, self.folder / "q.obj", "--edge-length", 3, *words, "--report",
                                            report)
                content = json.loads(report.read_text())
                row, = [row for row in content["details"] if row["kind"] == "handle"]
                self.assertEqual(row["decision"], decision)
                self.assertTrue(0 < row["size"] < 0.9)
                self.assertEqual(len(row["place"]), 3)
                self.assertEqual(content["quality"]["euler_characteristic"], euler)
                self.assertEqual(content["attempts"], 1 + sum(content["recoveries"].values()))
                self.assertEqual("1 handle was cut and closed" in result.stderr, decision == "simplified")
        self.run_quadrille(source, self.folder / "q.obj", "--small-details", "ignore", expect=2)

    def test_methods(self):
        source = self.write_off()
        map_file, out, report = (self.folder / name for name in ("m.vtp", "q.obj", "r.json"))
        for method in ("scale-aware", "mixed-integer", "quadcover"):
            with self.subTest(method):
                result = self.run_quadrille(source, out, "--quads", 900, "--method", method, "--map", map_file)
                data = read(vtkOBJReader(), out)
                self.assertTorusOfQuads(data.GetNumberOfPoints(), faces_of(data))
                self.assertEqual("gives no guarantee: 0 of" in result.stderr, method != "scale-aware")
                self.assertTrue(read(vtkXMLPolyDataReader(), map_file).GetCellData().HasArray("IGM"))
        map_file.unlink()
        result = self.run_quadrille(source, "--quads", 900, "--method", "seamless", "--map", map_file, "--report",
                                    report)
        self.assertIn("no quads", result.stderr)
        surface = read(vtkXMLPolyDataReader(), map_file)
        self.assertGreaterEqual(surface.GetNumberOfCells(), len(torus()[1]))
        self.assertTrue(surface.GetCellData().HasArray("IGM"))
        content = json.loads(report.read_text())
        self.assertEqual((content["exit_code"], content["quads_actual"]), (0, 0))
        # No half result: neither quads that the method has not, nor a map that nobody would see.
        before = sorted(path.name for path in self.folder.iterdir())
        for words, told in (((out, "--method", "seamless"), "--map"), (("--method", "seamless"), "--map"),
                            ((out, "--method", "seamless", "--map", map_file), "no output file"),
                            ((out, "--method", "best"), "best"), ((out, "--map", self.folder / "m.obj"), "vtp")):
            with self.subTest(words):
                self.assertIn(told, self.run_quadrille(source, *words, expect=2).stderr)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), before)

    def test_coarsest_integers(self):
        source, out = self.write_off(), self.folder / "q.obj"
        self.run_quadrille(source, out, "--quads", 900, "--integers", "coarsest")
        data = read(vtkOBJReader(), out)
        self.assertTorusOfQuads(data.GetNumberOfPoints(), faces_of(data))
        self.assertLess(data.GetNumberOfPoints(), 150)
        for words, told in ((("--integers", "few"), "keep-sizes or coarsest"),
                            (("--integers", "coarsest", "--method", "quadcover"), "scale aware")):
            with self.subTest(words):
                self.assertIn(told, self.run_quadrille(source, out, *words, expect=2).stderr)

    def test_anisotropy_limit(self):
        source, out, report = self.write_off(), self.folder / "q.obj", self.folder / "r.json"
        self.run_quadrille(source, out, "--quads", 900, "--report", report)
        self.assertNotIn("anisotropy_limit", json.loads(report.read_text()))
        self.run_quadrille(source, out, "--quads", 900, "--anisotropy-limit", 1.1, "--report", report)
        content = json.loads(report.read_text())
        self.assertEqual(content["anisotropy_limit"], 1.1)
        self.assertTrue(0 < content["share_beyond_anisotropy_limit"] < 1)
        for words in ((0.5,), (-1,), ("inf",), ("nan",), (2, "--method", "quadcover")):
            with self.subTest(words):
                result = self.run_quadrille(source, out, "--anisotropy-limit", *words, expect=2)
                self.assertIn("anisotropy", result.stderr)

    def test_folds_of_a_method_are_told(self):
        # The four holes of the flange are narrower than such quads.
        out = self.folder / "q.obj"
        result = self.run_quadrille(pathlib.Path(ARGS.data) / "part.ply", out, "--quads", 100, "--method", "quadcover",
                                    expect=3)
        self.assertIn("'QuadCover'", result.stderr)
        self.assertFalse(out.exists())

    def test_final_quality(self):
        source = self.write_off()
        means, connectivity = {}, set()
        for level in ("coarse", "intermediate", "input"):
            with self.subTest(level):
                report = self.folder / "r.json"
                self.run_quadrille(source, self.folder / "q.obj", "--quads", 100, "--final-quality", level, "--report",
                                   report)
                content = json.loads(report.read_text())
                connectivity.add((content["quads_actual"], content["sizes"]["quad_points"]))
                stages = [stage["stage"] for stage in content["stages"]]
                self.assertEqual("optimize" in stages, level != "coarse")
                self.assertEqual("distortion_after" in content, level != "coarse")
                if level != "coarse":
                    self.assertLessEqual(content["distortion_after"]["mean"], content["distortion_before"]["mean"])
                    means[level] = content["distortion_after"]["mean"]
        self.assertEqual(len(connectivity), 1)
        self.assertLess(means["input"], 1.2)
        result = self.run_quadrille(source, self.folder / "q.obj", "--final-quality", "best", expect=2)
        self.assertIn("coarse, intermediate or input", result.stderr)

    def test_feature_criterion(self):
        # A sheet with a ridge that is sharp and straight and ends free, through noise.
        columns, rows, noise = 40, 24, random.Random(3)
        points = [(x, y, -max(0, min(0.75, min(x - 8, 32 - x) / 4)) * abs(y - 12)
                   + (noise.uniform(-0.3, 0.3) if y != 12 else 0))
                  for y in range(rows + 1) for x in range(columns + 1)]
        corners = [(y * (columns + 1) + x, y * (columns + 1) + x + 1, (y + 1) * (columns + 1) + x + 1,
                    (y + 1) * (columns + 1) + x) for y in range(rows) for x in range(columns)]
        faces = [face for a, b, c, d in corners for face in ((a, b, c), (a, c, d))]
        source = self.folder / "ridge.off"
        source.write_text(f"OFF\n{len(points)} {len(faces)} 0\n" + "".join("%g %g %.17g\n" % p for p in points) +
                          "".join("3 %d %d %d\n" % f for f in faces))
        report = self.folder / "r.json"
        for word in ("creases", "angle"):
            self.run_quadrille(source, self.folder / "q.obj", "--quads", 300, "--feature-criterion", word, "--report",
                               report)
            notices = " ".join(json.loads(report.read_text())["notices"])
            self.assertEqual("no crease" in notices, word == "creases", notices)
        result = self.run_quadrille(source, self.folder / "q.obj", "--feature-criterion", "sharp", expect=2)
        self.assertIn("creases or angle", result.stderr)

    def test_distortion_metric(self):
        source = self.write_off()
        for word in ("on", "off"):
            report = self.folder / "r.json"
            self.run_quadrille(source, self.folder / "q.obj", "--quads", 100, "--distortion-metric", word, "--report",
                               report)
            stages = [stage["stage"] for stage in json.loads(report.read_text())["stages"]]
            self.assertEqual("metric" in stages, word == "on")
        result = self.run_quadrille(source, self.folder / "q.obj", "--distortion-metric", "yes", expect=2)
        self.assertIn("on or off", result.stderr)

    def test_sizes_and_guides_by_shape(self):
        source = self.write_off()
        report = self.folder / "r.json"
        self.run_quadrille(source, self.folder / "q.obj", "--quads", 200, "--chord-error", 0.02, "--gap-quads", 2,
                           "--smallest-size", 0.3, "--largest-size", 1.5, "--guide", "curvature", "--guide-anisotropy",
                           0.1, "--report", report)
        content = json.loads(report.read_text())
        stages = [stage["stage"] for stage in content["stages"]]
        self.assertIn("sizes", stages)
        self.assertIn("guides", stages)
        result = self.run_quadrille(source, self.folder / "q.obj", "--guide", "Stress", expect=2)
        self.assertIn("Stress", result.stderr)
        self.run_quadrille(source, self.folder / "q.obj", "--chord-error", 0, expect=2)
        self.run_quadrille(source, self.folder / "q.obj", "--smallest-size", 2, expect=2)

    def test_symmetry(self):
        source, report = self.write_off(), self.folder / "r.json"
        for plane in ("found", "0,0,0,0,0,1"):
            self.run_quadrille(source, self.folder / "q.vtp", "--quads", 200, "--symmetry", plane, "--report", report)
            told = json.loads(report.read_text())
            self.assertEqual(told["symmetry"]["moved_points"], 0)
            self.assertLess(told["symmetry"]["deviation"][1], 1e-6)
            self.assertEqual([row["kind"] for row in told["constraints"]], ["symmetry"])
            quads = read(vtkXMLPolyDataReader(), self.folder / "q.vtp")
            self.assertTrue(quads.GetPointData().HasArray("MirrorPoint"))
        for plane in ("lost", "0,0,0,0,0", "0,0,0,0,0,1,2", "0,0,0,0,0,x"):
            result = self.run_quadrille(source, self.folder / "q.vtp", "--symmetry", plane, expect=2)
            self.assertIn("x,y,z,nx,ny,nz", result.stderr)
        self.run_quadrille(source, self.folder / "q.vtp", "--quads", 200, "--symmetry", "0,0,0,0,0,1",
                           "--plane-curve", "mid-line")
        image = read(vtkXMLPolyDataReader(), self.folder / "q.vtp").GetPointData().GetArray("MirrorPoint")
        self.assertFalse(any(image.GetValue(p) == p for p in range(image.GetNumberOfTuples())))
        result = self.run_quadrille(source, self.folder / "q.vtp", "--plane-curve", "edges", "--symmetry", "found",
                                    expect=2)
        self.assertIn("mid-line", result.stderr)

    def test_rotation(self):
        source, report = self.write_off(), self.folder / "r.json"
        for rotation in ("5", "5,0,0,0,0,0,2"):
            self.run_quadrille(
                source, self.folder / "q.vtp", "--quads", 300, "--rotation", rotation, "--report", report)
            told = json.loads(report.read_text())
            self.assertEqual(told["symmetry"]["order"], 5)
            self.assertAlmostEqual(abs(told["symmetry"]["direction"][2]), 1)
            self.assertEqual([row["kind"] for row in told["constraints"]], ["rotation"])
            quads = read(vtkXMLPolyDataReader(), self.folder / "q.vtp")
            self.assertTrue(quads.GetPointData().HasArray("RotatedPoint"))
            self.assertEqual(quads.GetNumberOfCells() % 5, 0)
        for rotation in ("found", "1", "65", "2.5", "3,0,0,0,0,0", "3,0,0,0,0,0,1,2"):
            result = self.run_quadrille(source, self.folder / "q.vtp", "--rotation", rotation, expect=2)
            self.assertIn("n,x,y,z,dx,dy,dz", result.stderr)
        result = self.run_quadrille(
            source, self.folder / "q.vtp", "--rotation", 3, "--symmetry", "found", expect=2)
        self.assertIn("one symmetry", result.stderr)

    def test_wrap(self):
        points, faces = torus()
        path, out, report = self.folder / "soup.off", self.folder / "q.vtp", self.folder / "r.json"
        if not quadrille.has_cgal():
            result = self.run_quadrille(self.write_off(), out, "--wrap", "auto", expect=2)
            self.assertIn("QUADRILLE_USE_CGAL", result.stderr)
            return
        # Each face a little smaller, round its centre: none has a neighbour.
        corners = []
        for face in faces:
            centre = [sum(points[i][k] for i in face) / 3 for k in range(3)]
            corners += [tuple(0.9 * points[i][k] + 0.1 * centre[k] for k in range(3)) for i in face]
        path.write_text(f"OFF\n{len(corners)} {len(faces)} 0\n" + "".join("%.17g %.17g %.17g\n" % p for p in corners) +
                        "".join(f"3 {3 * i} {3 * i + 1} {3 * i + 2}\n" for i in range(len(faces))))
        for wrap, reason in (("auto", "stand alone"), (0.1, "the wrap has")):
            result = self.run_quadrille(path, out, "--quads", 400, "--wrap", wrap, "--report", report)
            self.assertIn(reason, result.stderr.replace("\n", " "))
            told = json.loads(report.read_text())
            quads = read(vtkXMLPolyDataReader(), out)
            self.assertTorusOfQuads(quads.GetNumberOfPoints(), faces_of(quads))
            self.assertGreater(told["wrap"]["points_on_surface"], 0.9 * quads.GetNumberOfPoints())
            self.assertEqual(told["quads_actual"], quads.GetNumberOfPolys())
        # What has quads is left alone.
        self.run_quadrille(self.write_off(), self.folder / "a.obj", "--quads", 400)
        self.run_quadrille(self.write_off(), self.folder / "b.obj", "--quads", 400, "--wrap", "auto")
        self.assertEqual((self.folder / "a.obj").read_bytes(), (self.folder / "b.obj").read_bytes())
        for words in (("--wrap", "never"), ("--wrap", "0"), ("--wrap", "1e-9"),
                      ("--wrap", "auto", "--map", self.folder / "m.vtp")):
            self.run_quadrille(path, self.folder / "c.obj", *words, expect=2)
            self.assertFalse((self.folder / "c.obj").exists())

    def test_cell_data(self):
        points, faces = torus()
        source, out = self.folder / "load.ply", self.folder / "q.vtp"
        with open(source, "w") as file:
            file.write(f"ply\nformat ascii 1.0\nelement vertex {len(points)}\nproperty double x\nproperty double y\n"
                       f"property double z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\n"
                       "property double load\nend_header\n")
            file.writelines("%r %r %r\n" % tuple(p) for p in points)
            file.writelines("3 %d %d %d %d\n" % (*f, i % 2) for i, f in enumerate(faces))
        for word in ("centre", "area"):
            self.run_quadrille(source, out, "--quads", 100, "--cell-data", word)
            load = read(vtkXMLPolyDataReader(), out).GetCellData().GetArray("load")
            between = [v for v in map(load.GetValue, range(load.GetNumberOfTuples())) if 0.1 < v < 0.9]
            self.assertEqual(len(between) > 0.9 * load.GetNumberOfTuples(), word == "area")
        result = self.run_quadrille(source, out, "--cell-data", "most", expect=2)
        self.assertIn("centre or area", result.stderr)


class Bench(Case):
    COLUMNS = "mesh,repeat,threads,stage,seconds,elements_in,elements_out,peak_rss_mb".split(",")
    STAGES = ("read repair order connectivity refine phase1 phase2 field seamless quantize embed replay certify "
              "extract total cancel attempts").split()

    def test_columns_and_stages(self):
        source = self.write_off()
        result = subprocess.run([ARGS.bench, str(source), "--quads", "300", "--threads", "1", "--repeat", "2"],
                                capture_output=True, text=True, timeout=300)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = list(csv.DictReader(io.StringIO(result.stdout)))
        self.assertEqual(list(rows[0]), self.COLUMNS)
        self.assertEqual([r["stage"] for r in rows], 2 * self.STAGES)
        self.assertEqual({r["repeat"] for r in rows}, {"0", "1"})
        for row in rows:
            self.assertGreaterEqual(float(row["seconds"]), 0)
            self.assertGreater(float(row["peak_rss_mb"]), 1)
        for run in (rows[:len(self.STAGES)], rows[len(self.STAGES):]):
            stages, total, cancel, attempts = run[:-3], *run[-3:]
            self.assertLessEqual(sum(float(r["seconds"]) for r in stages), 1.01 * float(total["seconds"]))
            self.assertGreaterEqual(int(attempts["elements_in"]), 1)
            self.assertGreaterEqual(int(attempts["elements_out"]), 1)
            self.assertTrue(0 < float(cancel["seconds"]) <= float(total["seconds"]))

    def test_wrong_comparisons_are_told(self):
        source = os.path.join(ARGS.data, "beast.ply")
        for wrong in (["--compare", "costs"], ["--subdivide", "1"], ["--compare", "field", "--edge-length", "1"]):
            result = subprocess.run([ARGS.bench, source, *wrong], capture_output=True, text=True, timeout=60)
            self.assertEqual(result.returncode, 2, result.stderr)

    def test_counts_of_the_replay(self):
        source = os.path.join(ARGS.data, "beast.ply")
        result = subprocess.run([ARGS.bench, source, "--compare", "replay", "--quads", "500"], capture_output=True,
                                text=True,
                                timeout=300)
        self.assertEqual(result.returncode, 0, result.stderr)
        (row,) = csv.DictReader(io.StringIO(result.stdout))
        self.assertEqual((row["mesh"], row["quads"], row["ok"]), ("beast", "500", "1"))
        self.assertEqual(int(row["inverted_stars"]), int(row["moved_to_kernel"]) + int(row["without_kernel"]))
        self.assertGreater(int(row["inverted_stars"]), 0)
        self.assertLessEqual(int(row["not_positive"]), int(row["replay_not_positive"]))

    def test_irregular_vertices_with_and_without_decimation(self):
        result = subprocess.run([ARGS.bench, os.path.join(ARGS.data, "part.ply"), "--compare", "field", "--quads",
                                 "500"],
                                capture_output=True, text=True, timeout=300)
        self.assertEqual(result.returncode, 0, result.stderr)
        (row,) = csv.DictReader(io.StringIO(result.stdout))
        self.assertEqual((row["mesh"], row["quads"], row["ok"]), ("part", "500", "1"))
        self.assertLess(int(row["coarse_vertices"]), int(row["faces"]) / 2)
        surface, coarse = int(row["irregular_surface"]), int(row["irregular_coarse"])
        self.assertGreater(min(surface, coarse), 0)
        self.assertAlmostEqual(float(row["ratio"]), coarse / surface, delta=0.001)

    def test_times_of_the_coarse_level(self):
        source = os.path.join(ARGS.data, "beast.ply")
        result = subprocess.run([ARGS.bench, source, "--compare", "coarse", "--quads", "500", "--coarse-vertices",
                                 "300",
                                 "--repeat", "2"], capture_output=True, text=True, timeout=300)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = list(csv.DictReader(io.StringIO(result.stdout)))
        edits = [("none", "cold")] + [(edit, start) for edit in ("direction", "valence", "level")
                                      for start in ("cold", "warm")]
        self.assertEqual([(row["edit"], row["start"], row["clock"]) for row in rows],
                         [(*edit, clock) for edit in edits for clock in ("wall", "processor")])
        for row in rows:
            self.assertEqual((row["mesh"], row["quads"], row["ok"]), ("beast", "500", "1"))
            stages = [float(row[name]) for name in ("field", "seamless", "quantize", "embed")]
            self.assertGreater(min(stages), 0)
            self.assertLessEqual(max(stages), float(row["total"]))
            self.assertEqual(int(row["faces_reused"]) > 0, row["start"] == "warm")
        self.assertEqual(rows[0]["vertices"], "300")
        result = subprocess.run([ARGS.bench, source, "--compare", "coarse", "--quads", "500", "--method",
                                 "mixed-integer"],
                                capture_output=True, text=True, timeout=300)
        rows = list(csv.DictReader(io.StringIO(result.stdout)))
        self.assertEqual([(row["edit"], row["ok"], float(row["embed"])) for row in rows], 2 * [("none", "1", 0)])
        wrong = subprocess.run([ARGS.bench, source, "--coarse-vertices", "300"], capture_output=True, text=True,
                               timeout=60)
        self.assertEqual(wrong.returncode, 2, wrong.stderr)

    def test_a_bad_mesh_does_not_end_the_others(self):
        source = self.write_off()
        result = subprocess.run([ARGS.bench, "absent.ply", str(source), "--quads", "300"], capture_output=True,
                                text=True, timeout=300)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(len(result.stdout.splitlines()), 1 + len(self.STAGES))


class Costs(Case):
    COLUMNS = "mesh,field,triangles,valences,distance,percent,seconds_cold,seconds_warm,hit_percent".split(",")
    FIELDS = ["reference", "intermediate", "E_G,mem", "E_G", "E_QEM", "E_uni"]

    def test_columns_and_rows(self):
        source = os.path.join(ARGS.data, "beast.ply")
        result = subprocess.run([ARGS.costs, source, "--quads", "1000", "--coarse-vertices", "300"],
                                capture_output=True, text=True, timeout=300)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = list(csv.DictReader(io.StringIO(result.stdout)))
        self.assertEqual(list(rows[0]), self.COLUMNS)
        self.assertEqual([r["field"] for r in rows], self.FIELDS)
        # Every field on a closed surface has the same index sum, 8 on one without handles.
        for row in rows:
            valences = dict(map(int, pair.split(":")) for pair in row["valences"].split())
            self.assertEqual(sum((4 - valence) * number for valence, number in valences.items()), 8)
        self.assertEqual(float(rows[0]["distance"]), 0)
        self.assertEqual(float(rows[2]["percent"]), 100)
        for row in rows[2:]:
            self.assertGreater(float(row["distance"]), 0)
            self.assertTrue(0 < float(row["hit_percent"]) <= 100)

    def test_a_bad_mesh_is_told(self):
        result = subprocess.run([ARGS.costs, "absent.ply"], capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 2)
        self.assertIn("absent.ply", result.stderr)


class Python(Case):
    def test_remesh(self):
        points, faces = torus()
        progress = []
        result = quadrille.remesh((points, faces), quads=300, everything=True,
                                  progress=lambda f, text: progress.append((f, text)))
        corners = quadrille.to_arrays(result.quads)
        self.assertTorusOfQuads(len(corners[0]), [list(map(int, f)) for f in corners[1]])
        self.assertEqual(result.info["ActualQuads"], len(corners[1]))
        self.assertEqual(result.info["TargetQuads"], 300)
        self.assertIn("extract", result.info["stages"])
        self.assertGreater(result.surface.GetNumberOfCells(), 0)
        self.assertEqual(result.lines.GetNumberOfCells(), 0)
        self.assertEqual(result.separatrices.GetNumberOfCells(), 0)
        self.assertEqual((result.info["LayoutPatchShape"],
                          result.quads.GetCellData().GetArray("LayoutPatch").GetRange()),
                         (2, (0.0, 0.0)))  # one patch, a torus
        self.assertTrue(progress and progress == sorted(progress, key=lambda p: p[0]))
        better = quadrille.remesh((points, faces), quads=300, final_quality="input")
        before, after = (quadrille.info(better)[name][0] for name in ("DistortionBefore", "DistortionAfter"))
        self.assertLessEqual(after, before)
        self.assertEqual(better.GetNumberOfCells(), len(corners[1]))
        stretched = quadrille.remesh((points, faces), quads=300, distortion_metric=True, everything=True)
        self.assertIn("metric", stretched.info["stages"])
        self.assertNotIn("metric", result.info["stages"])

    def test_methods(self):
        points, faces = torus()
        for method in quadrille.METHODS:
            result = quadrille.remesh((points, faces), quads=900, method=method, everything=True)
            self.assertEqual(result.quads.GetNumberOfCells() > 0, method != "seamless")
            self.assertGreaterEqual(result.surface.GetNumberOfCells(), len(faces))
            self.assertEqual(result.info["Method"].replace(" ", "-").lower(), method)
        with self.assertRaisesRegex(quadrille.InvalidInput, "ComputeMappedSurface"):
            quadrille.remesh((points, faces), quads=900, method="seamless")
        with self.assertRaisesRegex(quadrille.InvalidInput, "best"):
            quadrille.remesh((points, faces), quads=900, method="best")

    def test_errors_are_exceptions(self):
        points, faces = torus(12, 6)
        with self.assertRaises(quadrille.InvalidInput):
            quadrille.remesh((points, faces), quads=10, edge_length=1)
        with self.assertRaises(ValueError):
            quadrille.remesh(42, quads=10)
        with self.assertRaisesRegex(quadrille.InvalidInput, "3"):
            quadrille.remesh((points[:3] + [(math.inf, 0, 0)] + points[4:], faces), quads=10)
        with self.assertRaisesRegex(quadrille.RemeshError, "limit"):
            quadrille.remesh((points, faces), quads=1000, maximum_number_of_quads=100)
        with self.assertRaisesRegex(quadrille.RemeshError, "2 MB are allowed"):
            quadrille.remesh((points, faces), quads=1000, memory_limit=2)
        with self.assertRaisesRegex(quadrille.InvalidInput, "cell_data must be one of centre, area"):
            quadrille.remesh((points, faces), quads=300, cell_data="best")
        with self.assertRaisesRegex(quadrille.InvalidInput, "intermediate"):
            quadrille.remesh((points, faces), quads=100, final_quality="finest")
        with self.assertRaises(quadrille.RemeshError):
            quadrille.remesh((points, faces), quads=100, progress=lambda f, text: False)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    for name in ("quadrille", "bench", "costs", "data", "work"):
        parser.add_argument("--" + name, required=True)
    ARGS, rest = parser.parse_known_args()
    os.makedirs(ARGS.work, exist_ok=True)
    unittest.main(argv=["test_programs"] + rest, verbosity=2)
