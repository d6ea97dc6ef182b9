# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""From a STEP file to a deck in ParaView's real window under openbox, by keyboard: eight steps.

  test_cad_window.py XVFB PARAVIEW PVPYTHON OPENBOX STEP_FILE

File > Open, Apply, Quad Remesh, Apply, Quad Nodes On CAD Geometry, Apply, colour by face, File > Save Data. Screenshots
are left in the folder QUADRILLE_ARTIFACTS. Needs Debian's openbox and xdotool.
"""
import argparse
import pathlib
import sys
import tempfile
import time

import test_places


class Session(test_places.Session):
    def filter(self, name, wanted):
        self.xdotool("mousemove", *self.middle(), "key", "ctrl+space", "sleep", 0.7)
        self.xdotool("type", "--delay", 20, name)
        self.xdotool("sleep", 0.7, "key", "Return", "sleep", 0.5)
        self.wait_until(f"simple.GetActiveSource().GetXMLName() == {wanted!r}")
        time.sleep(0.5)

    def cells(self, wanted):
        self.wait_until(f"simple.GetActiveSource().GetXMLName() == {wanted!r} and "
                        "simple.GetActiveSource().GetDataInformation().GetNumberOfCells() > 0", seconds=120)

    def file(self, keys, path):
        self.xdotool("mousemove", *self.middle(), "key", keys, "sleep", 2)
        self.xdotool("type", "--delay", 20, str(path))
        self.xdotool("sleep", 1, "key", "Return", "sleep", 1)


def walk(session, step, deck):
    session.file("ctrl+o", step)
    session.wait_until("simple.GetActiveSource() is not None")
    session.apply()
    session.cells("QuadrilleCADReader")
    session.find_origin()
    session.shot("cad-surface")
    session.filter("Quad Remesh", "QuadRemesh")
    session.apply()
    session.cells("QuadRemesh")
    session.filter("Quad Nodes On CAD Geometry", "QuadCADProjection")
    session.apply()
    session.cells("QuadCADProjection")
    session.ask("simple.ColorBy(simple.GetDisplayProperties(simple.GetActiveSource(), view), ('CELLS', 'CadFaceId')); "
                "simple.Render()")
    session.shot("cad-quads")
    session.file("ctrl+s", deck)
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
    programs = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        session = Session(folder, programs)
        try:
            session.start()
            walk(session, programs.step, folder / "deck.inp")
        except BaseException:
            session.shot("cad-failure")
            raise
        finally:
            session.close()
    print("cad window: fine")


if __name__ == "__main__":
    sys.exit(main())
