# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Where the gestures of the user guide put things, in ParaView's real window under openbox at its defaults.

  test_places.py XVFB PARAVIEW OPENBOX [--picks N] [--strokes N] [--seed N] [--surface FILE]

Opens a surface and makes quads by keyboard. A pick: a key over a ball of *Irregular Vertices*, with its eye on. A
stroke: four random visible places, by the gesture of the guide. Where the points came to lie is compared with the ball,
or with the place under the mouse, which rays from the camera tell: half an edge length of the quads is allowed. A click
with the tool for cells takes a quad, also where a ball lies over it. All random places come from the seed. Screenshots
are left in the folder QUADRILLE_ARTIFACTS. Needs Debian's openbox and xdotool.

In a build with the drawing tools test_draw.py makes these checks in its own window.
"""
import argparse
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time

import count_actions
import paraview_server
import private_display

SURFACE = pathlib.Path(os.environ["QUADRILLE_DATA"]) / "beast.ply"
ALLOWED = 0.5  # edge lengths
NEAR = 0.3     # edge lengths between what pixels beside each other see
PIXELS = 12    # of an edge at least; three of them are what a place is seen with


class Session(count_actions.Window):
    """ParaView under a window manager, and a pipeline made in it."""

    script = "places_script.py"
    surface = SURFACE
    size = 1880, 1000  # of the window; with room for its frame on the screen
    pvserver = ()  # what starts a server that the window is connected to; empty: none

    def __init__(self, folder, programs):
        self.programs = programs
        self.server, display = private_display.start(programs.xvfb, "-screen", "0", "1920x1080x24", "-fbdir",
                                                     str(folder))
        super().__init__(folder, display)
        environment = count_actions.environment_of(self)
        script = pathlib.Path(__file__).with_name(self.script)
        self.manager = subprocess.Popen([programs.openbox], env=environment, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        self.remote = paraview_server.Server(self.pvserver, environment) if self.pvserver else None
        connection = [f"--url=cs://127.0.0.1:{self.remote.port}"] if self.remote else []
        with open(folder / "log", "w", encoding="utf-8") as output:
            self.paraview = subprocess.Popen([programs.paraview, "--dr", f"--script={script}", *connection],
                                             env=environment, stdout=output, stderr=subprocess.STDOUT)

    def close(self):
        if self.remote:
            self.remote.stop()
        for process in (self.paraview, self.manager, self.server):
            private_display.stop(process)

    def start(self):
        self.ask("pass", seconds=180)
        self.resize(*self.size)
        time.sleep(1)
        self.find_origin()

    def look(self, azimuth, elevation):
        self.ask(f"look({azimuth}, {elevation})")

    def middle(self):
        return self.origin[0] + 400, self.origin[1] - 300

    def apply(self):
        super().apply()
        self.wait_until("is_made()", seconds=180)  # in the background

    def tell_path(self, keys, title, path):
        """In the dialog that the keys open."""
        self.xdotool("mousemove", *self.middle(), "key", keys)
        self.xdotool("search", "--sync", "--onlyvisible", "--name", title)
        self.xdotool("sleep", 0.5, "type", "--delay", 5, str(path))
        self.xdotool("sleep", 0.5, "key", "Return")

    def open_surface(self):
        """File > Open, Apply."""
        self.tell_path("ctrl+o", "Open File", self.surface)
        self.wait_until("simple.GetActiveSource() is not None")
        self.apply()

    def open(self, quads=None, more="pass", wait="output(0).GetNumberOfCells() > 0"):
        """A surface and quads of it, by keyboard. more: done before; wait: what is true afterwards."""
        self.open_surface()
        self.new("Quad Remesh")
        self.ask((f"quads().NumberOfQuads = {quads}; " if quads else "") + more)
        self.apply()
        self.wait_for_quads(wait)

    def wait_for_quads(self, wait="output(0).GetNumberOfCells() > 0"):
        self.wait_until(f"quads() is not None and {wait}", seconds=120)
        self.find_origin()
        self.edge = self.value("edge_length() if output(0).GetNumberOfCells() else None")

    def screen(self, pixel):
        """Of a pixel of the view, from the left and from the bottom."""
        return self.origin[0] + pixel[0], self.origin[1] - pixel[1]

    def shot(self, name):
        time.sleep(0.2)
        count_actions.test_gui.write_png(count_actions.ARTIFACTS / f"places-{name}.png", self.rows())

    def places(self, chance, count):
        """Random ones among those that are clearly seen, pixel and place."""
        found = []
        for _ in range(40):
            numbers = [(round(chance.random(), 6), round(chance.random(), 6)) for _ in range(20)]
            found += self.value(f"visible_places({numbers!r}, {NEAR * self.edge})")
            if len(found) >= count:
                return found[:count]
        raise SystemExit("FAILED: hardly any place of the quads is seen")

    def balls(self):
        return self.value(f"visible_balls({NEAR * self.edge})")

    def draw(self, places):
        """A line of several points: the gesture of the guide."""
        self.key("1", self.screen(places[0][0]))
        for pixel, _ in places[1:]:
            self.key("2", self.screen(pixel))

    def put(self, name, places):
        """A constraint through the places, applied."""
        self.new(name)
        if name == "Quad Valence":
            self.key("p", self.screen(places[0][0]))
        else:
            self.draw(places)
        self.apply()

    def farthest(self, properties, places):
        """The largest distance of points of the selected source from the places, in edge lengths."""
        if not self.value("is_connected()"):
            return math.inf
        values = [v for name in properties for v in self.value(f"applied({name!r})")]
        points = [values[i:i + 3] for i in range(0, len(values), 3)]
        if len(points) != len(places):
            return math.inf
        return max(math.dist(p, place) for p, (_, place) in zip(points, places)) / self.edge


def random_view(session, chance):
    """From so near that pixels beside each other can clearly see one place."""
    azimuth, elevation = round(chance.uniform(0, 360), 3), round(chance.uniform(-30, 45), 3)
    session.look(azimuth, elevation)
    session.ask(f"come_near({azimuth}, {PIXELS})")


def summary(what, off):
    far = sum(not d <= ALLOWED for d in off)
    if off:
        print(f"{what}: {len(off)}, {far} farther than {ALLOWED} edge lengths; largest {max(off):.3f}, "
              f"median {sorted(off)[len(off) // 2]:.3f}")
    return far


def check_picks(session, chance, count):
    """How many are far off. P of a valence, 1 of a move and 1 of a stroke over balls, in turns; the other end is where
    it may be.
    """
    kinds = (("Quad Valence", ("Point",)), ("Quad Move", ("From", "To")), ("Quad Stroke", ("Points",)))
    off = []
    while len(off) < count:
        session.ask("clear(); show_balls(True)")
        random_view(session, chance)
        balls = session.balls()
        if not balls:
            continue
        name, properties = kinds[len(off) % len(kinds)]
        places = [chance.choice(balls)] + ([] if name == "Quad Valence" else session.places(chance, 1))
        session.put(name, places)
        off.append(session.farthest(properties, places))
        print(f"pick {len(off)}: {name}, {off[-1]:.3f} edge lengths off; {session.value('rows()')}", flush=True)
        if len(off) <= len(kinds):
            session.shot(f"pick-{len(off)}")
    session.ask("clear(); show_balls(False)")
    return summary("picks", off)


def check_strokes(session, chance, count):
    """How many are far off."""
    off = []
    while len(off) < count:
        session.ask("clear()")
        random_view(session, chance)
        places = session.places(chance, 4)
        session.put("Quad Stroke", places)
        off.append(session.farthest(("Points",), places))
        print(f"stroke {len(off)}: {off[-1]:.3f} edge lengths off; {session.value('rows()')}", flush=True)
        if len(off) <= 2:
            session.shot(f"stroke-{len(off)}")
    session.ask("clear()")
    return summary("strokes", off)


def check_selection(session, chance):
    """A click with the tool for cells takes a quad, also where a ball lies over it."""
    session.ask("clear(); show_balls(True)")
    balls = []
    while not balls:
        random_view(session, chance)
        balls = session.balls()
    pixel = balls[0][0]
    code = (f"simple.SelectSurfaceCells(Rectangle=[{pixel[0]}, {pixel[1]}, {pixel[0]}, {pixel[1]}], View=view); "
            "print(repr([(p, quads().SMProxy.GetSelectionInput(p) is not None) for p in (0, 4)]))")
    found = dict(eval(session.ask(code)))
    session.ask("simple.ClearSelection(quads()); show_balls(False)")
    fine = found[0] and not found[4]
    print(f"selection over a ball: quads {found[0]}, irregular vertices {found[4]}: {'fine' if fine else 'BAD'}")
    return not fine


def main():
    parser = argparse.ArgumentParser()
    for program in ("xvfb", "paraview", "openbox"):
        parser.add_argument(program)
    for what, count in (("picks", 20), ("strokes", 20), ("seed", 31)):
        parser.add_argument("--" + what, type=int, default=count)
    parser.add_argument("--surface", default=SURFACE)
    options = parser.parse_args()
    Session.surface = options.surface
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        session = Session(folder, options)
        try:
            session.start()
            session.open()
            bad += check_picks(session, random.Random(options.seed), options.picks)
            bad += check_strokes(session, random.Random(options.seed + 1), options.strokes)
            bad += check_selection(session, random.Random(options.seed + 2))
        except BaseException:
            session.shot("failure")
            print((folder / "log").read_text(encoding="utf-8"))
            raise
        finally:
            session.close()
    if bad:
        sys.exit(f"FAILED: {bad} of the checks above")
    print("places: fine")


if __name__ == "__main__":
    main()
