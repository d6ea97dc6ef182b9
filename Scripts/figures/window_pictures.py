# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the pictures of ParaView's window of the guide's first minutes anew, by mouse and keyboard.

  window_pictures.py XVFB PARAVIEW OPENBOX FOLDER

FOLDER gets window-tutorial.png, window-quads.png, window-panel.png and window-irregular.png of Data/part.ply,
window-failure.png of a Moebius strip, and window-valence.png and window-stroke.png of Data/beast.ply. It takes the
environment of the tests of the plugin (PYTHONPATH, QUADRILLE_PLUGIN, QUADRILLE_DATA, QUADRILLE_ARTIFACTS); needs
Debian's openbox and xdotool.
"""
import argparse
import math
import os
import pathlib
import sys
import tempfile
import time

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "Testing" / "Plugin"))
import test_first_minutes  # noqa: E402
import test_gui  # noqa: E402

DATA = pathlib.Path(os.environ["QUADRILLE_DATA"])
PANELS = 296, 640      # where the panels end and the view begins
WIDER = 540            # where it is dragged to
HEIGHT = 1000          # of the window
SEEN = "look(250, 50); view.GetActiveCamera().Dolly(0.8); simple.Render(view)"
SPLIT = 150, 467       # between the pipeline and the panel below


def write_moebius(path, around=80, across=8):
    """A strip that is twisted once, of radius 4."""
    lines = []
    for i in range(around):
        a = 2 * math.pi * i / around
        for j in range(across + 1):
            w = j / across - 0.5
            r = 4 + 2 * w * math.cos(a / 2)
            lines.append("v %.9g %.9g %.9g" % (r * math.cos(a), r * math.sin(a), 2 * w * math.sin(a / 2)))

    def at(i, j):
        return 1 + (i * (across + 1) + j if i < around else across - j)

    for i in range(around):
        for j in range(across):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


class Window(test_first_minutes.Session):
    """With pictures of parts of it."""

    def picture(self, path, box, half):
        """What is in a box (left, top, right, bottom), at half its size or as it is."""
        time.sleep(1)
        left, top, right, bottom = box
        right, bottom = right - (right - left) % 2, bottom - (bottom - top) % 2
        rows = numpy.array([list(row[3 * left:3 * right]) for row in self.rows()[top:bottom]], float)
        image = rows.reshape(bottom - top, right - left, 3)
        if half:
            image = (image[::2, ::2] + image[1::2, ::2] + image[::2, 1::2] + image[1::2, 1::2]) / 4
        test_gui.write_png(path, [bytes(row) for row in image.round().astype("uint8").reshape(len(image), -1)])
        print(path)

    def pull(self, start, end):
        """Drags what lies between parts of the window."""
        self.xdotool("mousemove", *start, "sleep", 0.2, "mousedown", 1, "sleep", 0.2, "mousemove", end[0], end[1] - 1,
                     "sleep", 0.2, "mousemove", *end, "sleep", 0.2, "mouseup", 1, "sleep", 0.5)
        self.xdotool("mousemove", *self.middle())

    def whole(self):
        return 0, 0, 1880, HEIGHT


def tutorial(window, folder):
    window.help(0)
    window.find_origin()
    window.find_tools()
    window.take("Remesh")
    window.wait_for_quads()
    window.xdotool("mousemove", *window.middle())
    window.picture(folder / "window-tutorial.png", (0, 140, 1880, HEIGHT), True)


def part(window, folder):
    window.open()
    window.ask(SEEN)
    window.picture(folder / "window-quads.png", window.whole(), True)
    window.pull(PANELS, (WIDER, PANELS[1]))
    window.ask("quads().NumberOfQuads = 2000; simple.Render(view)")
    window.wait_for_quads("1500 < output(0).GetNumberOfCells() < 3000")
    window.picture(folder / "window-panel.png", (0, SPLIT[1], WIDER, HEIGHT - 30), False)
    window.ask(SEEN + "; show_balls(True)")
    left, bottom = window.origin
    window.picture(folder / "window-irregular.png", (left, 200, 1880, bottom), True)


def failure(window, folder):
    window.open(wait="output(8).GetNumberOfCells() > 0")
    window.ask("look(215, 50); view.GetActiveCamera().Dolly(0.8); simple.Render(view)")
    window.picture(folder / "window-failure.png", window.whole(), True)


def constraints(window, folder):
    window.open(more="quads().NumberOfQuads = 1500")
    window.ask("look(260, 20)")
    for name, keys, file in (("Quad Valence", 1, "valence"), ("Quad Stroke", 4, "stroke")):
        window.ask("clear(); show_balls(True); look(260, 20)")
        places = [tuple(window.value(f"[round(c) for c in pixel_of(({x}, -0.45, {z}))]"))
                  for x, z in ((-0.5, 0.4), (-0.2, 0.25), (0.1, 0.1), (0.4, -0.02))]
        window.new(name)
        if keys == 1:
            window.ask("simple.GetActiveSource().Valence = 5")
            window.key("p", window.screen(places[2]))
        else:
            window.draw([(p, None) for p in places])
        window.apply()
        window.ask("simple.Show(simple.OutputPort(quads(), 5), view); simple.Render(view)")
        print(window.value("rows()"))
        window.picture(folder / f"window-{file}.png", window.whole(), True)


def main():
    parser = argparse.ArgumentParser()
    for program in ("xvfb", "paraview", "openbox"):
        parser.add_argument(program)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--only", nargs="*", default=["tutorial", "part", "failure", "constraints"])
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        moebius = write_moebius(folder / "moebius.obj")
        for make, surface in ((tutorial, None), (part, DATA / "part.ply"), (failure, moebius),
                              (constraints, DATA / "beast.ply")):
            if make.__name__ not in options.only:
                continue
            place = folder / make.__name__
            place.mkdir()
            window = Window(place, options)
            window.surface = surface
            try:
                window.start()
                make(window, options.folder)
            except BaseException:
                window.shot("pictures-failure")
                raise
            finally:
                window.close()


if __name__ == "__main__":
    main()
