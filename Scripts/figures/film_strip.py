# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the six pictures of the README anew: what the drawing tools do in ParaView's window, by the mouse.

  film_strip.py XVFB PARAVIEW OPENBOX PICTURE

A scan (Data/beast.ply); its quads; a stroke while it is drawn; the quads that follow it; an irregular vertex that was
dragged; smaller quads where a size was dragged. Two rows of three. It takes the environment of the tests of the plugin
(PYTHONPATH, QUADRILLE_PLUGIN, QUADRILLE_DATA, QUADRILLE_ARTIFACTS); needs Debian's openbox and xdotool.
"""
import argparse
import math
import pathlib
import sys
import tempfile

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "Testing" / "Plugin"))
import test_draw  # noqa: E402
import test_gui  # noqa: E402

FRAME = 800, 640  # pixels of the view round its middle
GAP = 8           # white pixels between frames, which are half as large
FLANK = ((-0.75, 0.42), (-0.45, 0.33), (-0.15, 0.18), (0.15, 0.03), (0.45, -0.1))  # x and z on the scan's side
DRAGGED = (0.3, 0.25), (0.62, 0.1)  # likewise: from where to where sizes are


class Session(test_draw.Session):
    def frame(self, aside=True):
        """The middle of the view at half its size, with the mouse aside or where it is."""
        corner = self.origin[0] + 10, self.origin[1] - 10
        self.xdotool(*(("mousemove", *corner) if aside else ()), "sleep", 0.7)
        width, height = self.value("tuple(view.ViewSize)")
        left = self.origin[0] + (width - FRAME[0]) // 2
        top = self.origin[1] - (height + FRAME[1]) // 2
        rows = self.rows()[top:top + FRAME[1]]
        pixels = numpy.array([list(row[3 * left:3 * (left + FRAME[0])]) for row in rows], float)
        image = pixels.reshape(FRAME[1], FRAME[0], 3)
        return (image[::2, ::2] + image[1::2, ::2] + image[::2, 1::2] + image[1::2, 1::2]) / 4

    def pixel(self, place):
        x, z = place
        return tuple(round(c) for c in self.value(f"pixel_of(({x}, -0.45, {z}))"))

    def line(self, places, steps=8):
        pixels = [self.pixel(p) for p in places]
        return [tuple(round(a + (b - a) * k / steps) for a, b in zip(p, q))
                for p, q in zip(pixels, pixels[1:]) for k in range(steps + 1)]

    def ball(self):
        """The one that is seen nearest to the middle of the scan's side."""
        found = self.value("[(pixel_of(b), seen_at(pixel_of(b)), b) for b in "
                           "[output(4).GetPoint(i) for i in range(output(4).GetNumberOfPoints())]]")
        seen = [pixel for pixel, place, ball in found if place and math.dist(place, ball) < self.edge]
        middle = self.pixel((0, 0))
        return tuple(round(c) for c in min(seen, key=lambda pixel: math.dist(pixel, middle)))


def frames(session):
    session.open_surface()
    session.find_origin()
    session.find_tools()
    session.look(285, 18)
    yield session.frame()
    session.take("Remesh")
    session.wait_for_quads()
    session.ask("quads().NumberOfQuads = 1800; simple.Render(view)")
    session.wait_for_quads("output(0).GetNumberOfCells() < 3000")
    session.look(285, 18)
    yield session.frame()
    session.take("Stroke")
    path = session.line(FLANK)
    words = [word for p in path[1:] for word in ("mousemove", *session.screen(p), "sleep", 0.02)]
    session.xdotool("mousemove", *session.screen(path[0]), "sleep", 0.1, "mousedown", 1, *words)
    yield session.frame(aside=False)
    session.xdotool("mouseup", 1)
    session.settle()
    yield session.frame()
    session.take("Move")
    x, y = session.ball()
    session.drag([(x + 8 * k, y + 6 * k) for k in range(10)])
    yield session.frame()
    session.take("Size")
    session.drag(session.line(DRAGGED))
    yield session.frame()


def main():
    parser = argparse.ArgumentParser()
    for program in ("xvfb", "paraview", "openbox"):
        parser.add_argument(program)
    parser.add_argument("picture", type=pathlib.Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        session = Session(pathlib.Path(folder), options)
        try:
            session.start()
            made = list(frames(session))
            print([row[:2] for row in session.value("rows()")])
        except BaseException:
            session.shot("strip-failure")
            raise
        finally:
            session.close()
    height, width = made[0].shape[:2]
    strip = numpy.full((2 * height + GAP, 3 * width + 2 * GAP, 3), 255.0)
    for number, image in enumerate(made):
        row, column = divmod(number, 3)
        top, left = row * (height + GAP), column * (width + GAP)
        strip[top:top + height, left:left + width] = image
    test_gui.write_png(options.picture, [bytes(row) for row in strip.round().astype("uint8").reshape(len(strip), -1)])


if __name__ == "__main__":
    main()
