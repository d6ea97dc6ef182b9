# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Each format by each program at hand that reads it: the same points, quads and sets. foreign_readers.py is what runs
in those programs. Here also the table of Formats.md is made:

  test_readers.py --quadrille PROGRAM --data Data --work FOLDER --results HERE.json
  python3 test_readers.py --files FOLDER --results THERE.json     # the same files on another system, without Quadrille
  test_readers.py --table HERE.json THERE.json"""
import argparse
import collections
import functools
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import textwrap
import unittest

import numpy
import quad_meshes

ARGS = None
HERE = pathlib.Path(__file__).resolve().parent
FORMATS = ("inp", "msh", "mesh", "exo", "vtu", "vtp", "obj", "ply", "stl")
MODELS = ("part", "box", "plate")

#: package: of Debian; command: what runs foreign_readers.py, here the Python of this test; needs: a module or program.
Program = collections.namedtuple("Program", "package needs command version")
PYTHON = [sys.executable, HERE / "foreign_readers.py"]
PROGRAMS = {
    "meshio": Program("python3-meshio", "import meshio", PYTHON, "print(meshio.__version__)"),
    "Gmsh": Program("python3-gmsh", "import gmsh", PYTHON, 
                    "gmsh.initialize(); print(gmsh.option.getString('General.Version'))"),
    "MeshLab": Program("meshlab", "meshlabserver", PYTHON, ""),
    "Blender": Program("blender", "blender", ["blender", "--background", "--factory-startup", "--python",
                                              HERE / "foreign_readers.py", "--"], "--version"),
    "admesh": Program("admesh", "admesh", PYTHON, "--version"),
    "CalculiX": Program("calculix-ccx", "ccx", PYTHON, "-v"),
    "VTK": Program("python3-vtk9", "import vtkmodules.vtkIOExodus, vtkmodules.vtkCommonCore", PYTHON,
                   "print(vtkmodules.vtkCommonCore.vtkVersion().GetVTKVersion())"),
    "ParaView": Program("paraview", "pvpython", ["pvpython", HERE / "foreign_readers.py"], "--version"),
    "PyVista": Program("python3-pyvista", "import pyvista", PYTHON, "print(pyvista.__version__)"),
    "trimesh": Program("python3-trimesh", "import trimesh", PYTHON, "print(trimesh.__version__)"),
}


#: What of a file comes back. faces: quads, or the triangles that the format or the program cuts them into. sets:
#: patches by name, by number, as parts without either, or none. has_nodes: boundary loops, feature curves and corners
#: by name. tolerance: of points, over the largest coordinate. has_copies: points once a block. has_patch_nodes: node
#: sets of patches with a name, too.
Cell = collections.namedtuple("Cell", "faces sets has_nodes tolerance has_copies has_patch_nodes",
                              defaults=(False, 0, False, False))
SINGLE = 6e-8  # half a bit of single precision
DIGITS = 5e-6  # six digits

CELLS = {
    ("inp", "meshio"): Cell("quads", "names", True, 1e-14, has_patch_nodes=True),  # 20 characters a number
    ("inp", "CalculiX"): Cell("quads", "names", True, DIGITS, has_patch_nodes=True),
    ("msh", "meshio"): Cell("quads", "names", True),
    ("msh", "Gmsh"): Cell("quads", "names", True),
    ("msh", "PyVista"): Cell("quads", "parts"),
    ("mesh", "meshio"): Cell("quads", "parts"),
    ("mesh", "Gmsh"): Cell("quads", "parts"),
    ("mesh", "PyVista"): Cell("quads", "parts"),
    ("exo", "meshio"): Cell("quads", "numbers", True, has_patch_nodes=True),
    ("exo", "VTK"): Cell("quads", "names", True, SINGLE, has_copies=True, has_patch_nodes=True),
    ("exo", "ParaView"): Cell("quads", "names", True, SINGLE, has_copies=True, has_patch_nodes=True),
    ("exo", "PyVista"): Cell("quads", "names", tolerance=SINGLE, has_copies=True),
    **{(extension, program): Cell("quads", "numbers")
       for extension, programs in (("vtu", ("meshio", "VTK", "ParaView", "PyVista")),
                                   ("vtp", ("VTK", "ParaView", "PyVista"))) for program in programs},
    ("obj", "meshio"): Cell("quads", "parts"),
    ("obj", "Blender"): Cell("quads", "names", tolerance=SINGLE),
    ("obj", "VTK"): Cell("quads", "parts", tolerance=SINGLE),
    ("obj", "ParaView"): Cell("quads", "parts", tolerance=SINGLE),
    ("obj", "PyVista"): Cell("quads", "parts", tolerance=SINGLE),
    ("obj", "trimesh"): Cell("triangles", None),
    **{("ply", program): Cell("quads", None, tolerance=SINGLE)
       for program in ("meshio", "Blender", "VTK", "ParaView", "PyVista")},
    ("ply", "MeshLab"): Cell("triangles", None, tolerance=DIGITS),
    ("ply", "trimesh"): Cell("triangles", None, tolerance=SINGLE),
    **{("stl", program): Cell("triangles", None, tolerance=SINGLE)
       for program in ("meshio", "Gmsh", "Blender", "VTK", "ParaView", "PyVista", "trimesh")},
    **{("stl", program): Cell("triangles", None, tolerance=DIGITS) for program in ("MeshLab", "admesh")},
}

#: Why a program that has a reader for a format is not tested with it.
REASONS = {
    ("obj", "MeshLab"): "MeshLab 2020.09 of Debian 12 ends at any OBJ, of one triangle or its own, by an assertion in "
                        "its reader; Debian 13 has no `meshlabserver`",
    ("ply", "Gmsh"): "Gmsh reads PLY as text and of triangles only; this is binary, and of quads in text it keeps "
                     "three corners",
}


# ------------------------------------------------------------------------------------------------- files
BOX_NAMES = dict(enumerate(["FRONT", "RIGHT", "BACK", "LEFT", "BOTTOM", "TOP"]))


def polygons(data, names):
    import quadrille

    mesh, grid = quadrille.to_polydata(data.points, data.elements), quad_meshes.grid(data)
    mesh.GetCellData().ShallowCopy(grid.GetCellData())
    quad_meshes.add_strings(mesh.GetFieldData(), "PatchNames", names.values())
    return mesh


def write_files(folder):
    """All formats of each model, and beside them what must be in them."""
    import quadrille

    source = pathlib.Path(ARGS.data) / "part.ply"
    for extension in FORMATS:
        subprocess.run([ARGS.quadrille, source, folder / f"part.{extension}", "--quads", "2000", "--quiet"], check=True)
    write_expected(folder / "part", quad_meshes.data_of(quadrille.remesh(quadrille.read(source), quads=2000)))
    box, plate = quad_meshes.closed_box(), quad_meshes.plate_with_hole()
    for name, data, names in (("box", box, BOX_NAMES), ("plate", plate, {})):
        write_expected(folder / name, data, names)
        mesh = polygons(data, names)
        for extension in FORMATS:
            quadrille.write(mesh, folder / f"{name}.{extension}")


def write_expected(path, data, names=None):
    sets = quad_meshes.Sets(data, names)
    numbers = collections.defaultdict(list)
    for place, patch in enumerate(data.patch):
        numbers[str(patch)].append(place)
    expected = {"points": data.points.tolist(), "quads": [list(map(int, row)) for row in data.elements],
                "names": {name: sorted(members) for name, members in sets.patches.items()}, "numbers": numbers,
                "nodes": sets.node_sets(), "patch_names": list((names or {}).values())}
    path.with_suffix(".expected.json").write_text(json.dumps(expected))


# ------------------------------------------------------------------------------------------------- comparison
def is_at_hand(program):
    needs = PROGRAMS[program].needs
    if not needs.startswith("import"):
        return shutil.which(needs) is not None
    return subprocess.run([sys.executable, "-c", needs], capture_output=True, check=False).returncode == 0


def version(program):
    """Its number as it tells it, or empty."""
    _, needs, _, ask = PROGRAMS[program]
    command = [sys.executable, "-c", f"{needs}; {ask}"] if needs.startswith("import") else [needs, *ask.split()]
    told = subprocess.run(command, capture_output=True, text=True, check=False,
                          env={**os.environ, "QT_QPA_PLATFORM": "offscreen"})
    number = re.search(r"\d+\.\d+(\.\d+)*", told.stdout + told.stderr)
    return number.group(0) if number else ""


def first_is_lowest(face):
    """A face by its corners, whichever the first one is; orientation counts."""
    at = face.index(min(face))
    return (*face[at:], *face[:at])


class Comparison:
    """What a program has read, in points and quads of what is expected."""

    def __init__(self, test, expected, read, cell):
        self.test, self.expected, self.read, self.cell = test, expected, read, cell
        self.quads = [first_is_lowest(quad) for quad in expected["quads"]]
        self.places = self.places_of_points()
        self.faces = [first_is_lowest([self.places[i] for i in face]) for face in read["faces"]]

    def places_of_points(self):
        wanted, found = numpy.array(self.expected["points"]), numpy.array(self.read["points"])
        if not self.cell.has_copies:
            self.test.assertEqual(len(found), len(wanted), "another number of points")
        places = []
        for rows in numpy.array_split(found, max(1, len(found) // 500)):
            distance = abs(rows[:, None] - wanted).max(axis=2)
            places += distance.argmin(axis=1).tolist()
            self.test.assertLessEqual(distance.min(axis=1).max(), self.cell.tolerance * abs(wanted).max())
        self.test.assertEqual(len(set(places)), len(wanted), "points are missing")
        return places

    def check_faces(self):
        if self.cell.faces == "quads":
            # Not by assertEqual, whose texts of long lists take minutes.
            self.test.assertTrue(sorted(self.faces) == sorted(self.quads), f"other quads: {self.difference()}")
            return
        # Each quad is two triangles on one diagonal.
        cuts = {first_is_lowest(face): quad for quad in self.quads for face in self.triangles(quad)}
        halves = collections.defaultdict(list)
        for face in self.faces:
            self.test.assertTrue(face in cuts, f"{face} is no half of a quad")
            halves[cuts[face]].append(face)
        for quad in self.quads:
            two = sorted(halves[quad])
            self.test.assertIn(two, [sorted(map(first_is_lowest, self.triangles(quad)[i:i + 2])) for i in (0, 2)])

    def difference(self):
        found, wanted = collections.Counter(self.faces), collections.Counter(self.quads)
        return f"{list(found - wanted)[:3]} in place of {list(wanted - found)[:3]}"

    @staticmethod
    def triangles(quad):
        a, b, c, d = quad
        return [(a, b, c), (a, c, d), (a, b, d), (b, c, d)]

    def check_sets(self):
        if self.cell.sets is None:
            return
        found = {name: {self.faces[i] for i in members} for name, members in self.read["sets"].items()}
        wanted = {name: {self.quads[i] for i in members}
                  for name, members in self.expected["numbers" if self.cell.sets == "numbers" else "names"].items()}
        if self.cell.sets == "parts":
            parts, wanted_parts = ({frozenset(part) for part in sets.values()} for sets in (found, wanted))
            self.test.assertTrue(parts == wanted_parts and len(found) == len(wanted), "other parts")
            return
        # All elements, and those with a side on a loop, are sets of input decks; ParaView has names in small letters.
        found = {name.upper(): members for name, members in found.items() if not re.search(r"^EALL$|_E[1-4]$", name)}
        self.test.assertEqual(sorted(found), sorted(wanted))
        for name, members in wanted.items():
            self.test.assertTrue(found[name] == members, f"{name} has other quads")

    def check_nodes(self):
        if self.cell.has_nodes:
            found = {name.upper(): {self.places[i] for i in members} for name, members in self.read["nodes"].items()
                     if name != "NALL"}
            if self.cell.has_patch_nodes:
                for name in self.expected["patch_names"]:
                    wanted = {node for i in self.expected["names"][name] for node in self.quads[i]}
                    self.test.assertEqual(found.pop(name), wanted, name)
            self.test.assertEqual(quad_meshes.by_kind(found), self.expected["nodes"])

    def check(self):
        self.check_faces()
        self.check_sets()
        self.check_nodes()


# ------------------------------------------------------------------------------------------------- tests
class ReadersTest(unittest.TestCase):
    results = {"cells": {}, "versions": {}}

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(ARGS.files or ARGS.work).resolve()
        if not ARGS.files:
            shutil.rmtree(cls.folder, ignore_errors=True)
            cls.folder.mkdir(parents=True)
            write_files(cls.folder)

    @classmethod
    def tearDownClass(cls):
        if ARGS.results:
            pathlib.Path(ARGS.results).write_text(json.dumps(cls.results, indent=1))

    def leave_out(self, extensions, program, package):
        print(f"left out: {', '.join(extensions)} by {program} (package {package})", flush=True)

    def check_program(self, program):
        extensions = [extension for extension in FORMATS if (extension, program) in CELLS]
        if not is_at_hand(program):
            self.leave_out(extensions, program, PROGRAMS[program].package)
            self.skipTest(f"no {program}")
        files = [self.folder / f"{model}.{extension}" for extension in extensions for model in MODELS]
        for file in files:
            self.answer(file, program).unlink(missing_ok=True)
        command = PROGRAMS[program].command
        # Programs with a Python of their own do not take the modules of this one.
        env = {key: value for key, value in os.environ.items() if key != "PYTHONPATH" or command is PYTHON}
        done = subprocess.run([*command, program, *files], capture_output=True, text=True, check=False, timeout=600,
                              env=env)
        self.results["versions"][program] = version(program)
        for extension in extensions:
            read = {model: self.answer(self.folder / f"{model}.{extension}", program) for model in MODELS}
            with self.subTest(extension=extension):
                for path in read.values():
                    self.assertTrue(path.exists(), f"{path.name} is missing: {(done.stdout + done.stderr)[-2000:]}")
                missing = {json.loads(path.read_text()).get("left_out") for path in read.values()} - {None}
                if missing:
                    self.leave_out([extension], program, missing.pop())
                    continue
                for model, path in read.items():
                    self.check_file(model, json.loads(path.read_text()), CELLS[extension, program])
                self.results["cells"][f"{extension} {program}"] = len(read)

    @staticmethod
    def answer(file, program):
        return file.with_name(f"{file.name}.{program}.json")

    def check_file(self, model, read, cell):
        with self.subTest(model=model):
            self.assertNotIn("error", read, read.get("error"))
            expected = json.loads((self.folder / f"{model}.expected.json").read_text())
            Comparison(self, expected, read, cell).check()

    def test_table(self):
        """Formats.md has the table as it is made here."""
        document = HERE.parents[1] / "Documentation" / "Formats.md"
        if document.exists():
            self.assertIn("\n".join(table_rows()), document.read_text())


for name in PROGRAMS:
    setattr(ReadersTest, f"test_{name.lower()}", functools.partialmethod(ReadersTest.check_program, name))


# ------------------------------------------------------------------------------------------------- the table
def cell_text(extension, program):
    if (extension, program) in REASONS:
        return f"no: {list(REASONS).index((extension, program)) + 1}"
    if (extension, program) not in CELLS:
        return "—"
    cell = CELLS[extension, program]
    sets = {"names": "patches", "numbers": "patches by number", "parts": "patches without names", None: ""}[cell.sets]
    return ", ".join(filter(None, (cell.faces, sets, "curves" if cell.has_nodes else "")))


def table_rows():
    rows = [f"| | {' | '.join(PROGRAMS)} |", "|---" * (len(PROGRAMS) + 1) + "|"]
    rows += [f"| `{extension}` | {' | '.join(cell_text(extension, program) for program in PROGRAMS)} |"
             for extension in FORMATS]
    reasons = [textwrap.fill(f"{i + 1}. {reason}.", 120, subsequent_indent="   ")
               for i, reason in enumerate(REASONS.values())]
    return [*rows, "", *reasons]


def print_table(results):
    """Only where each cell was read by one of the runs."""
    found = [json.loads(pathlib.Path(path).read_text()) for path in results]
    read = set().union(*(each["cells"] for each in found))
    missing = [f"{extension} {program}" for extension, program in CELLS if f"{extension} {program}" not in read]
    if missing:
        raise SystemExit("not read by any of these runs: " + ", ".join(missing))
    print("\n".join(table_rows()))
    versions = {program: [each["versions"][program] for each in found if each["versions"].get(program)]
                for program in PROGRAMS}
    read_by = ", ".join(f"{program} {' and '.join(dict.fromkeys(numbers))}" for program, numbers in versions.items())
    print("\n" + textwrap.fill(f"Read by {read_by}.", 120))


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--quadrille")
    parser.add_argument("--data")
    parser.add_argument("--work")
    parser.add_argument("--files", help="a folder of files that another run has written as its --work")
    parser.add_argument("--results", help="writes which cells were read")
    parser.add_argument("--table", nargs="+", metavar="RESULTS", help="prints the table for Formats.md")
    ARGS, rest = parser.parse_known_args()
    if ARGS.table:
        print_table(ARGS.table)
        sys.exit()
    if not ARGS.files and not (ARGS.quadrille and ARGS.data and ARGS.work):
        parser.error("give --quadrille, --data and --work, or --files")
    unittest.main(argv=[__file__, *rest])
