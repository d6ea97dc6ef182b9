# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What ParaView's real window shows of inputs that cannot have quads, or not everywhere.

  failing_inputs.py XVFB PARAVIEW OPENBOX [FILE[:QUADS]...]

Opens each file by keyboard, asks for so many quads, and looks: something is seen in the view; where quads are missing
or inverted a place is marked; the first 80 characters of the verdict say what to do; where that is a property the
button Apply mends it. Without files the script makes its own: no surface, not a number, degenerate, non-manifold, other
cells than polygons. What is wrong is told with BAD. Screenshots are left in the folder QUADRILLE_ARTIFACTS. No test of
ctest, as larger ones need files of their own.
"""
import argparse
import math
import pathlib
import re
import struct
import tempfile

import test_places
import test_problems

SEEN = 300  # of every second pixel
LEGEND, MESSAGES = 180, 280  # pixels at the right and lower end
FIRST = 80   # characters
TOO_MANY = 400  # quads, with a limit below that
PRESSES = 3  # of Apply, each of which halves the length of the quads' edges
#: What a user is told to do begins with one of these.
TO_DO = re.compile(r"\b(ask for|use|set|switch|raise|repair|triangulate|correct|take|free|remove|make|choose|allow|"
                   r"load|open|give|connect|see|show)\b", re.IGNORECASE)


def legacy(path, points, cells, kind="POLYGONS", more=""):
    size = len(cells) + sum(len(c) for c in cells)
    path.write_text("# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n"
                    f"POINTS {len(points)} double\n" + "".join(f"{p[0]} {p[1]} {p[2]}\n" for p in points)
                    + (f"{kind} {len(cells)} {size}\n" if cells else "")
                    + "".join(f"{len(c)} {' '.join(map(str, c))}\n" for c in cells) + more, encoding="utf-8")
    return path


def binary_ply(path, points, cells):
    """VTK's readers of text know no nan."""
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {len(cells)}\nproperty list uchar int vertex_indices\nend_header\n")
    path.write_bytes(head.encode() + b"".join(struct.pack("<3f", *p) for p in points)
                     + b"".join(struct.pack(f"<B{len(c)}i", len(c), *c) for c in cells))
    return path


def grid(n, height=lambda x, y: 0):
    points = [(x, y, height(x, y)) for y in range(n + 1) for x in range(n + 1)]
    corner = lambda x, y: y * (n + 1) + x
    cells = [t for y in range(n) for x in range(n)
             for t in ((corner(x, y), corner(x + 1, y), corner(x + 1, y + 1)),
                       (corner(x, y), corner(x + 1, y + 1), corner(x, y + 1)))]
    return points, cells


def ball(n):
    """A sphere of n meridians and as many circles."""
    at = lambda lat, lon: (math.sin(lat) * math.cos(lon), math.sin(lat) * math.sin(lon), math.cos(lat))
    points = [at(math.pi * i / (n + 1), 2 * math.pi * j / n) for i in range(1, n + 1) for j in range(n)]
    cells = [t for i in range(n - 1) for j in range(n) for k in [(j + 1) % n]
             for t in ((n * i + j, n * i + n + j, n * i + n + k), (n * i + j, n * i + n + k, n * i + k))]
    top, bottom, last = n * n, n * n + 1, n * (n - 1)
    caps = [t for j in range(n) for k in [(j + 1) % n] for t in ((top, j, k), (bottom, last + k, last + j))]
    return points + [(0, 0, 1), (0, 0, -1)], cells + caps


def own_files(folder):
    points, cells = grid(12)
    yield legacy(folder / "points_only.vtk", points, [[i] for i in range(len(points))], "VERTICES"), 200
    yield legacy(folder / "lines_only.vtk", points, [[i, i + 1] for i in range(12)], "LINES"), 200
    broken = list(points)
    broken[40] = (math.nan, 3, 0)
    yield binary_ply(folder / "not_a_number.ply", broken, cells), 200
    yield legacy(folder / "all_degenerate.vtk", [(x, 0, 0) for x, _, _ in points], cells), 200
    yield legacy(folder / "one_point.vtk", [(0, 0, 0)] * len(points), cells), 200
    fins = points + [(6, y, 5) for y in range(13)]
    more = [t for y in range(12) for t in ((13 * y + 6, 13 * y + 19, 169 + y), (13 * y + 19, 170 + y, 169 + y))]
    yield legacy(folder / "three_sheets.vtk", fins, cells + more), 200
    yield legacy(folder / "polygons.vtk", [(math.cos(k / 5), math.sin(k / 5), 0) for k in range(31)],
                 [list(range(31))]), 200
    yield legacy(folder / "huge_places.vtk", [(x * 1e300, y * 1e300, z) for x, y, z in points], cells), 200
    yield legacy(folder / "too_many.vtk", points, cells), TOO_MANY
    round_points, round_cells = ball(40)
    asked = "".join(f"{bits}\n" for bits in test_problems.spanning_tree(round_cells))
    yield legacy(folder / "many_features.vtk", round_points, round_cells,
                 more=f"CELL_DATA {len(round_cells)}\nSCALARS FeatureEdges unsigned_char 1\nLOOKUP_TABLE default\n"
                 + asked), 20
    yield legacy(folder / "wrong_array.vtk", points, cells,
                 more="POINT_DATA %d\nSCALARS TargetValence double 1\nLOOKUP_TABLE default\n" % len(points)
                 + "9\n" * len(points)), 200


class Session(test_places.Session):
    def shows(self):
        """Pixels that are not the background's, and those that mark a place, without legends and messages."""
        left, bottom = self.origin
        width, height = self.value("tuple(view.ViewSize)")
        rows = [row[3 * left:3 * (left + width - LEGEND)]
                for row in self.rows()[bottom - height + 30:bottom - MESSAGES]]
        counts = {}
        for row in rows:
            for x in range(5, len(row) // 3 - 5, 2):
                pixel = tuple(row[3 * x:3 * x + 3])
                counts[pixel] = counts.get(pixel, 0) + 1
        counts.pop(max(counts, key=counts.get))
        return sum(counts.values()), sum(n for (r, g, b), n in counts.items()
                                         if (r > 60 and b > 60 and g < min(r, b) / 3)  # fails here
                                         or (r > 120 and 4 * b < r and r / 5 < g < r / 2))  # inverted

    def state(self):
        return self.value("(output(0).GetNumberOfCells(), output(8).GetNumberOfCells(), marks(), "
                          "quads().GetPropertyValue('Verdict') or '', quads().GetPropertyValue('Remedy') or '', "
                          "quads().GetPropertyValue('OutcomeText') or '')")


def judge(session, name):
    """What is wrong with what is seen and told."""
    quads, problems, marks, verdict, remedy, outcome = session.state()
    seen, marked = session.shows()
    bad = []
    if seen < SEEN and session.value("has_surface()"):
        bad.append(f"only {seen} pixels are seen")
    if marks > 0 and marked < 10:
        bad.append("no place is marked")
    first = verdict.replace("\n", " ")[:FIRST]
    if (outcome or problems) and not TO_DO.search(first):
        bad.append("nothing to do in what is told first")
    print(f"{name}: {quads} quads, {problems} problems, {seen} pixels, {marked} marked, remedy '{remedy}'; {first!r}"
          f"{'  BAD: ' + '; '.join(bad) if bad else ''}", flush=True)
    return bad, remedy


def try_input(session, path, quads):
    session.surface = path
    session.ask("for source in list(simple.GetSources().values()): simple.Delete(source)")
    session.open_surface()
    session.ask("simple.ResetCamera(view)\ndef marks():\n    kinds = output(8).GetCellData().GetArray('Problem')\n"
                "    return sum(kinds.GetTuple1(i) != 0 for i in range(output(8).GetNumberOfCells())) if kinds else 0\n"
                "def has_surface():\n    data = simple.GetActiveSource()\n"
                "    source = quads().Input\n    info = source.GetDataInformation()\n"
                "    b = info.GetBounds()\n"
                "    return info.GetNumberOfCells() > 0 and sum(0 < b[i + 1] - b[i] < 1e200 for i in (0, 2, 4)) > 1")
    session.new("Quad Remesh")
    session.ask(f"quads().NumberOfQuads = {quads}"
                + ("; quads().MaximumNumberOfQuads = 300" if quads == TOO_MANY else ""))
    session.apply()
    session.wait_until("quads() is not None and (quads().GetPropertyValue('Verdict') or '') != ''", seconds=120)
    session.find_origin()
    bad, remedy = judge(session, f"{path.name} {quads}")
    session.shot(f"failing-{path.stem}-{quads}")
    presses = 0
    while remedy and presses < PRESSES:
        presses += 1
        test_problems.press_under_verdict(session, 1 if session.state()[1] else 0)
        now = session.state()[4]
        if now == remedy:
            bad.append("Apply changed nothing")
            break
        remedy = now
    if presses:
        more, _ = judge(session, f"  after {presses} of Apply")
        bad += more if remedy == "" else []
        session.shot(f"failing-{path.stem}-{quads}-applied")
    return bad


def main():
    parser = argparse.ArgumentParser()
    for program in ("xvfb", "paraview", "openbox"):
        parser.add_argument(program)
    parser.add_argument("files", nargs="*")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        inputs = [(pathlib.Path(name.partition(":")[0]), int(name.partition(":")[2] or 200)) for name in options.files]
        inputs = inputs or list(own_files(folder))
        session = Session(folder, options)
        bad = 0
        try:
            session.start()
            for path, quads in inputs:
                bad += bool(try_input(session, path, quads))
        except BaseException:
            session.shot("failing-stopped")
            print((folder / "log").read_text(encoding="utf-8")[-3000:])
            raise
        finally:
            session.close()
    print(f"{len(inputs) - bad} of {len(inputs)} inputs are fine")


if __name__ == "__main__":
    main()
