# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What the real window shows where there are no quads, or not of all: never nothing.

  test_problems.py XVFB PARAVIEW OPENBOX

Two tori, one of them with features that the quads asked for cannot follow. Without quads the view shows the input and
where it fails, the panel's first field what to do; with those of one torus it shows them, and the triangles of the
other one. Screenshots are left in the folder QUADRILLE_ARTIFACTS.
"""
import math
import pathlib
import sys
import tempfile
import time
import types

import test_places


def spanning_tree(cells):
    """Bits of edges that join all points of a connected surface and close no loop: there is no face to fill."""
    bits, reached, grows = [0] * len(cells), {cells[0][0]}, True
    while grows:
        grows = False
        for f, cell in enumerate(cells):
            for i, (a, b) in enumerate(zip(cell, cell[1:] + cell[:1])):
                if a in reached and b not in reached:
                    reached.add(b)
                    bits[f] |= 1 << i
                    grows = True
    return bits


def write_two_tori(path, around=56, across=28):
    """VTK's legacy format. A tree of edges through all points of the second torus are features that somebody asks for.
    """
    points, faces = [], []
    for middle in (0, 12):
        first = len(points)
        for i in range(around):
            for j in range(across):
                a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
                r = 4 + 1.5 * math.cos(b)
                points.append((middle + r * math.cos(a), r * math.sin(a), 1.5 * math.sin(b)))
        def at(i, j):
            return first + i % around * across + j % across
        for i in range(around):
            for j in range(across):
                faces += [(at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1))]
    half = len(faces) // 2
    tree = spanning_tree(faces[half:])
    path.write_text("# vtk DataFile Version 3.0\ntwo tori\nASCII\nDATASET POLYDATA\n"
                    f"POINTS {len(points)} double\n" + "".join("%.9g %.9g %.9g\n" % p for p in points)
                    + f"POLYGONS {len(faces)} {4 * len(faces)}\n" + "".join("3 %d %d %d\n" % f for f in faces)
                    # Active scalars, which are no patches though nothing else says what is one.
                    + f"CELL_DATA {len(faces)}\nSCALARS FeatureEdges unsigned_char 1\nLOOKUP_TABLE default\n"
                    + "0\n" * half + "".join(f"{bits}\n" for bits in tree), encoding="utf-8")
    return half


def colours(session):
    """How many pixels of the view have which colour, the background left out."""
    left, bottom = session.origin
    width, height = session.value("tuple(view.ViewSize)")
    counts = {}
    for row in session.rows()[bottom - height + 30:bottom - 5]:
        for x in range(left + 5, left + width - 5, 3):
            pixel = row[3 * x:3 * x + 3]
            counts[pixel] = counts.get(pixel, 0) + 1
    background = max(counts, key=counts.get)
    return {pixel: n for pixel, n in counts.items() if pixel != background}


def marks(session):
    """Pixels in the magenta of a place that fails, lit or not."""
    return sum(n for (r, g, b), n in colours(session).items() if r > 60 and b > 60 and g < min(r, b) / 3)


def check(condition, text):
    if not condition:
        raise SystemExit("FAILED: " + text)


def problems(session):
    """By kind: how many cells the output Problems has."""
    return eval(session.ask(
        "data = output(8); kinds = data.GetCellData().GetArray('Problem'); all_kinds = [kinds.GetTuple1(i) for i in "
        "range(data.GetNumberOfCells())]; print([all_kinds.count(k) for k in (0, 1, 2)])"))


def verdict_colour(session):
    """Of the verdict in the panel, and its left and lower end on the screen."""
    rows = session.rows()
    for name, colour in (("red", (0xf6, 0xd5, 0xd5)), ("orange", (0xfb, 0xe6, 0xc8)), ("green", (0xd6, 0xef, 0xd9))):
        found = [(x, y) for y in range(450, len(rows)) for x in range(5, 200)
                 if tuple(rows[y][3 * x:3 * x + 3]) == colour]
        if len(found) > 500:
            return name, min(x for x, _ in found), max(y for _, y in found)
    return "none", 0, 0


def press_under_verdict(session, row):
    """A button: those under the verdict stand in rows."""
    _, left, bottom = verdict_colour(session)
    session.xdotool("mousemove", left + 30, bottom + 18 + 27 * row, "sleep", 0.2, "click", 1)
    for _ in range(2):
        session.ask("pass", seconds=120)
    session.wait_until("is_made()", seconds=120)
    time.sleep(0.5)  # the panel tells of it then


def check_buttons(session):
    """Show leads to the place that fails, Apply sets the property that mends it; one undo takes that back."""
    check(verdict_colour(session)[0] == "red", "the verdict on a failure is not red")
    places = session.value("[output(8).GetPoint(output(8).GetCell(i).GetPointId(0)) for i in "
                           "range(output(8).GetNumberOfVerts())]")
    press_under_verdict(session, 0)
    session.shot("problems-shown")
    looked_at = session.value("list(view.CameraFocalPoint)")
    check(min(math.dist(looked_at, p) for p in places) < 1e-6, f"Show looks at {looked_at}, of {places}")
    x, y = (round(c) for c in session.value(f"tuple(pixel_of({tuple(looked_at)!r}))"))
    x, y = session.screen((x, y))
    middle = [session.rows()[y][3 * (x + d):3 * (x + d) + 3] for d in range(-3, 4)]
    check(any(r > 60 and b > 60 and g < min(r, b) / 3 for r, g, b in middle), "the ball is not seen in the middle")
    press_under_verdict(session, 1)
    check(session.value("quads().NumberOfQuads") == 120, "Apply did not set four times the number of quads")
    session.wait_until("output(0).GetNumberOfCells() > 0", seconds=60)
    session.shot("problems-applied")
    check(verdict_colour(session)[0] == "green", "the verdict on quads that are valid is not green")
    check(session.value("quads().GetPropertyValue('Remedy')") in (None, ""), "there is a remedy where all is well")
    session.xdotool("mousemove", *session.middle(), "key", "ctrl+z")
    session.wait_until("quads().NumberOfQuads == 30 and is_made()", seconds=60)


def main():
    programs = types.SimpleNamespace(**dict(zip(("xvfb", "paraview", "openbox"), sys.argv[1:])))
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        session = test_places.Session(folder, programs)
        session.surface = folder / "tori.vtk"
        half = write_two_tori(session.surface)
        try:
            session.start()
            session.open(quads=30, more="quads().FailedComponents = 'Fail'", wait="output(8).GetNumberOfCells() > 0")
            session.shot("problems-none")
            check(session.value("quads().PatchArray == '(none)' == quads().GuideArray"),
                  "an array of patches, or of guides, is chosen, though by nobody")
            check(session.value("output(0).GetNumberOfCells()") == 0, "there are quads, which was not to be")
            without, fails, _ = problems(session)
            check(without == 2 * half and fails > 0, f"the output Problems has {without} triangles, {fails} places")
            seen = sum(colours(session).values())
            check(seen > 5000, f"the view is blank after a failure: {seen} pixels")
            check(marks(session) > 10, f"no place is marked: {marks(session)} pixels")
            verdict = session.value("quads().GetPropertyValue('Verdict')")
            check(0 <= verdict.find("ask for smaller quads") < 80, "the verdict is " + verdict)

            check_buttons(session)
            session.ask("simple.ResetCamera(view); quads().FailedComponents = 'Leave Out'; simple.Render(view)",
                        seconds=120)
            # Until then it is the quads before the failure that are there.
            session.wait_until(f"output(0).GetNumberOfCells() > 0 and output(8).GetNumberOfCells() > {half}",
                               seconds=60)
            session.shot("problems-some")
            without, fails, _ = problems(session)
            check(without == half and fails > 0, f"beside quads Problems has {without} triangles, {fails} places")
            verdict = session.value("quads().GetPropertyValue('Verdict')")
            check(verdict.startswith("1 of 2 connected components"), "the verdict is " + verdict)
            check(marks(session) > 10, f"no place is marked beside quads: {marks(session)} pixels")
        except BaseException:
            session.shot("problems-failure")
            print((folder / "log").read_text(encoding="utf-8"))
            raise
        finally:
            session.close()
    print("problems: fine")


if __name__ == "__main__":
    main()
