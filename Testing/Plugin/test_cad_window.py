# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""From a STEP file to a deck in ParaView's real window under openbox, by keyboard: eight steps.

  test_cad_window.py XVFB PARAVIEW PVPYTHON OPENBOX STEP_FILE [--tools]

File > Open, Apply, Quad Remesh, Apply, Quad Nodes On CAD Geometry, Apply, colour by face, File > Save Data. With
--tools the tool Move is tried on a ball at a sharp edge between. Screenshots are left in the folder
QUADRILLE_ARTIFACTS. Needs Debian's openbox and xdotool.
"""
import argparse
import pathlib
import sys
import tempfile
import time

import test_draw


class Session(test_draw.Session):
    def filter(self, name, wanted):
        self.xdotool("mousemove", *self.middle(), "key", "ctrl+space", "sleep", 0.7)
        self.xdotool("type", "--delay", 20, name)
        self.xdotool("sleep", 0.7, "key", "Return", "sleep", 0.5)
        self.wait_until(f"simple.GetActiveSource().GetXMLName() == {wanted!r}")
        time.sleep(0.5)

    def cells(self, wanted):
        self.wait_until(f"simple.GetActiveSource().GetXMLName() == {wanted!r} and "
                        "simple.GetActiveSource().GetDataInformation().GetNumberOfCells() > 0", seconds=120)


def check_edge(session):
    """Move takes no ball at a sharp edge, where vertices stay: nothing is drawn, and the quads are as they were."""
    session.find_tools()
    session.edge = session.value("edge_length()")
    session.take("Move")
    session.settle()
    for azimuth in range(30, 390, 60):  # towards a corner, which is no outline then
        session.look(azimuth, 35)
        balls = session.value(f"[b for b in visible_balls({session.edge}) if off_features(b[1]) == 0]")
        if balls:
            break
    else:
        raise SystemExit("FAILED: no ball is seen at a sharp edge")
    (x, y), _ = balls[0]
    before = session.value("bytes_of(quads())")
    session.drag([(x, y), (x + 15, y + 10), (x + 40, y + 25)])
    session.shot("cad-ball")
    if session.drawn() or session.value("bytes_of(quads())") != before:
        raise SystemExit(f"FAILED: a ball at a sharp edge was moved: {session.drawn()}")
    session.xdotool("key", "Escape")


def walk(session, step, deck, has_tools):
    session.tell_path("ctrl+o", "Open File", step)
    session.wait_until("simple.GetActiveSource() is not None")
    session.apply()
    session.cells("QuadrilleCADReader")
    session.find_origin()
    session.shot("cad-surface")
    session.filter("Quad Remesh", "QuadRemesh")
    session.apply()
    session.cells("QuadRemesh")
    if has_tools:
        check_edge(session)
    session.filter("Quad Nodes On CAD Geometry", "QuadCADProjection")
    session.apply()
    session.cells("QuadCADProjection")
    session.ask("simple.ColorBy(simple.GetDisplayProperties(simple.GetActiveSource(), view), ('CELLS', 'CadFaceId')); "
                "simple.Render()")
    session.shot("cad-quads")
    session.tell_path("ctrl+s", "Save File", deck)
    for _ in range(2):  # the options of the writer
        if not deck.exists():
            session.xdotool("sleep", 1, "key", "Return", "sleep", 1)
    session.shot("cad-saved")
    end = time.time() + 30
    while not deck.exists() and time.time() < end:
        time.sleep(0.2)
    text = deck.read_text(encoding="utf-8").upper() if deck.exists() else ""
    if "ELSET=SUPPORT" not in text or "ELSET=BORE" not in text:
        raise SystemExit("FAILED: the deck has not the faces of the file as sets")


def main():
    parser = argparse.ArgumentParser()
    for name in ("xvfb", "paraview", "pvpython", "openbox", "step"):
        parser.add_argument(name)
    parser.add_argument("--tools", action="store_true")
    programs = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        session = Session(folder, programs)
        try:
            session.start()
            walk(session, programs.step, folder / "deck.inp", programs.tools)
        except BaseException:
            session.shot("cad-failure")
            raise
        finally:
            session.close()
    print("cad window: fine")


if __name__ == "__main__":
    sys.exit(main())
