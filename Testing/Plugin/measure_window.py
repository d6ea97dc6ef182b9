# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""How long ParaView's real window stands still while it is worked with, and how often the quads follow the mouse.

  measure_window.py XVFB PARAVIEW OPENBOX SURFACE [--quads N] [--walks NAME...] [--drag SECONDS] [--server WORD...]

A timer in the window (QUADRILLE_WINDOW_PAUSES) writes each time in which no events were taken up. Each walk is done by
the mouse; for each the longest of these times is printed, and how many were longer than 0.3 s. While a ball or a handle
is dragged it is counted how many pictures with other quads there were, and how long the window's threads have worked
for each, which other programs change less. No test of ctest, as it measures time.
"""
import argparse
import math
import os
import pathlib
import random
import tempfile
import time

import test_draw
import test_places

STILL = 0.3  # seconds that nobody minds


class Session(test_draw.Session):
    """Reads what the timer in the window has written."""

    def __init__(self, folder, programs):
        self.pauses = folder / "pauses"
        os.environ["QUADRILLE_WINDOW_PAUSES"] = str(self.pauses)
        super().__init__(folder, programs)

    def longest(self, begin, end, what):
        """Prints how long the window stood still between two times."""
        lines = [line.split() for line in self.pauses.read_text(encoding="utf-8").splitlines()]
        found = sorted(((float(length), float(work)) for at, length, work in lines if begin < float(at) < end + 0.5),
                       reverse=True)
        long = [pause for pause in found if pause[0] > STILL]
        print(f"{what}: {end - begin:.2f} s, longest pause {max(found, default=(0, 0))[0]:.2f} s, longest work "
              f"{max((work for _, work in found), default=0):.2f} s, {len(long)} pauses above {STILL} s"
              f"{' (' + ', '.join(f'{length:.2f}/{work:.2f}' for length, work in long[:6]) + ')' if long else ''}",
              flush=True)

    def work(self):
        """Seconds that the threads of the window's process have worked so far, those for the picture, too."""
        numbers = pathlib.Path(f"/proc/{self.paraview.pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
        return (int(numbers[11]) + int(numbers[12])) / os.sysconf("SC_CLK_TCK")

    def watch(self):
        """Notes each picture of the view: when it was, and which quads it shows."""
        self.ask("pictures = []\n"
                 "def note(*_):\n"
                 "    shown = simple.GetRepresentation(quads(), view) if quads() else None\n"
                 "    data = shown.GetClientSideObject().GetRenderedDataObject(0) if shown else None\n"
                 "    pictures.append((time.time(), data.GetMTime() if data else 0))\n"
                 "import time\n"
                 "view.GetRenderWindow().AddObserver('EndEvent', note)")

    def slow_drag(self, pixels, seconds, what):
        """A drag, the button is released after a while at rest."""
        pause = seconds / len(pixels)
        words = []
        for pixel in pixels[1:]:
            words += ["mousemove", *self.screen(pixel), "sleep", pause]
        self.xdotool("mousemove", *self.screen(pixels[0]), "sleep", 0.3)
        begin = time.time()
        self.xdotool("mousedown", 1, "sleep", 0.05)
        worked = self.work()
        self.xdotool(*words)
        worked = self.work() - worked
        end = time.time()
        self.longest(begin, end, f"{what}, button down")
        time.sleep(0.3)
        released = time.time()
        self.xdotool("mouseup", 1)
        self.settle()
        self.longest(released, time.time(), f"{what}, button released")
        pictures = [p for p in self.value("pictures") if begin < p[0] < end + 0.3]
        kinds = {p[1] for p in pictures}
        print(f"{what}: {len(pictures)} pictures, {len(kinds)} meshes in {end - begin:.2f} s: "
              f"{len(kinds) / (end - begin):.1f} a second; {worked / len(kinds):.3f} s of work a mesh", flush=True)


def arc(start, goal, count):
    return [tuple(round(a + (b - a) * k / count) for a, b in zip(start, goal)) for k in range(count + 1)]


def goal_from(session, start, chance):
    """A place on the quads, some way from the pixel."""
    for _ in range(20):
        for pixel, _ in session.places(chance, 6):
            if 60 < sum((a - b) ** 2 for a, b in zip(pixel, start)) ** 0.5 < 300:
                return pixel
    raise SystemExit("FAILED: no place for a drag")


def ball(session, chance, seconds):
    session.take("Move")
    start = tuple(round(c) for c in chance.choice(test_draw.visible_balls(session, chance, 1))[0])
    session.slow_drag(arc(start, goal_from(session, start, chance), round(seconds / 0.05)), seconds, "ball")
    print("  ", session.word("move"), session.drawn())
    session.shot("measured-ball-made")
    session.xdotool("key", "Escape")


def handle(session, chance, seconds):
    session.take("Valence")
    test_draw.valence(session, chance)
    session.xdotool("key", "Escape")
    session.ask("simple.SetActiveSource(list(quads().Constraints)[-1])")
    time.sleep(1)
    start = tuple(round(c) for c in session.value("pixel_of(constraints()[-1][1][0])"))
    goal = goal_from(session, start, chance)
    seen = session.value(f"seen_at({goal!r})")
    session.slow_drag(arc(start, goal, round(seconds / 0.05)), seconds, "handle")
    print(f"   {math.dist(session.drawn()[1][0], seen) / session.edge:.3f} edge lengths off")
    session.ask("simple.SetActiveSource(quads())")


def stroke(session, chance, seconds):
    session.take("Stroke")
    pixels, _ = session.path(chance)
    session.slow_drag(pixels, seconds, "stroke")
    session.xdotool("key", "Escape")


WALKS = {"ball": ball, "handle": handle, "stroke": stroke}


def main():
    parser = argparse.ArgumentParser()
    for program in ("xvfb", "paraview", "openbox"):
        parser.add_argument(program)
    parser.add_argument("surface", type=pathlib.Path)
    parser.add_argument("--quads", type=int)
    parser.add_argument("--walks", nargs="*", default=list(WALKS))
    parser.add_argument("--drag", type=float, default=3)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--server", nargs="+", default=())
    options = parser.parse_args()
    Session.pvserver = options.server
    with tempfile.TemporaryDirectory() as folder:
        session = Session(pathlib.Path(folder), options)
        session.surface = options.surface
        try:
            session.start()
            session.watch()
            begin = time.time()
            session.open_surface()
            session.ask("pass", seconds=120)
            session.longest(begin, time.time(), "open")
            session.find_tools()
            begin = time.time()
            session.take("Remesh")
            session.wait_until("quads() is not None and output(0).GetNumberOfCells() > 0", seconds=120)
            session.longest(begin, time.time(), "first quads")
            session.wait_for_quads()
            if options.quads:
                session.ask(f"quads().NumberOfQuads = {options.quads}; simple.Render(view)", seconds=120)
            for name in options.walks:
                session.ask("clear()", seconds=120)
                session.look(270, 10)
                WALKS[name](session, random.Random(options.seed), options.drag)
                session.shot(f"measured-{name}")
        except BaseException:
            session.shot("measure-failure")
            raise
        finally:
            print((pathlib.Path(folder) / "log").read_text(encoding="utf-8"))
            session.close()


if __name__ == "__main__":
    main()
