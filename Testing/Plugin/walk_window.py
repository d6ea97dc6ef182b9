# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Walks with each tool of the tool bar in ParaView's real window, by mouse at random places, judged in the quads alone.

  walk_window.py XVFB PARAVIEW OPENBOX SURFACE... [--actions NAME...] [--places N] [--quads N] [--seed N]
                 [--size WIDTH HEIGHT] [--csv FILE]

The gestures are those of test_draw.py, under openbox at its defaults. What the mouse was over is told by rays from the
camera, before each gesture; `Scripts/study/constraint_judge.py`, which knows nothing of Quadrille, says afterwards
whether the quads have there what was drawn, and whether the word on it is true. A timer in the window tells how long it
stood still between a press and the picture of what came of it. For each surface and action a row is printed, and
appended to --csv. No test of ctest, as it takes minutes and judges with scipy.
"""
import argparse
import csv
import dataclasses
import math
import pathlib
import random
import sys
import tempfile
import time

import numpy

import measure_window
import test_draw
import test_places

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "Scripts" / "study"))
import constraint_judge as judge  # noqa: E402, pylint: disable=wrong-import-position

CLOSE = test_draw.ALLOWED
FEATURE_ANGLE = 40  # degrees, the default of Quad Remesh
NEAREST = 6  # balls among which the other end of every second connection is
UNDONE = ("Stroke", "Valence", "Feature")
ROWS = {"Stroke": "guide stroke", "Valence": "valence", "Move": "move", "Merge": "move", "Connect": "connection",
        "Drag": "connection", "Loop": "cycle", "Feature": "feature curve", "Size": "size", "Mirror": "symmetry"}
GROWTH = 0.25  # of sizes over an edge length beyond the radius that they are asked for in, as the guide has it
SMALLER = 0.5  # the factor that the tool bar has
COLUMNS = ("surface", "size", "action", "tries", "drawn", "there", "met", "true", "still", "longest")


class Session(measure_window.Session):
    """Notes what is under the mouse before each gesture, and how long the window stands still after it."""

    def begin(self):
        """Before an action."""
        self.under, self.stills, self.plane = [], [], None

    def _watched(self, gesture, pixels):
        pixels = [tuple(round(c) for c in p) for p in pixels]
        self.under += self.value(f"[seen_at(p) for p in {pixels!r}]")
        begin = time.time()
        gesture()
        end = time.time() + 0.02
        for line in self.pauses.read_text(encoding="utf-8").splitlines():
            at, length, work = map(float, line.split())
            if begin < at - length and at < end and length > measure_window.STILL:
                self.stills.append((length, work))

    def drag(self, pixels):
        drag = super().drag
        self._watched(lambda: drag(pixels), pixels)

    def press(self, pixel):
        press = super().press
        self._watched(lambda: press(pixel), [pixel])

    def path(self, chance, **shape):
        pixels, places = super().path(chance, **shape)
        self.plane = self.value(f"plane_of({places!r})")  # in which a loop across a body lies
        return pixels, places

    def quads_now(self):
        """As the judge has them."""
        path = self.folder / "quads.npz"
        self.ask(f"import numpy; numpy.savez({str(path)!r}, **dict(zip(('points', 'quads'), quad_arrays())))")
        found = numpy.load(path)
        return judge.Quads(found["points"], found["quads"])

    def input_now(self):
        """The triangles that were given, and the features of the quads without constraints."""
        path = self.folder / "surface.npz"
        self.ask(f"import numpy; numpy.savez({str(path)!r}, **dict(zip(('points', 'triangles'), input_arrays())), "
                 "features=features())")
        found = numpy.load(path)
        points, merged = numpy.unique(found["points"] + 0.0, axis=0, return_inverse=True)
        triangles = merged.reshape(-1)[found["triangles"]]
        triangles = triangles[(triangles != numpy.roll(triangles, 1, axis=1)).all(axis=1)]
        surface = judge.Surface(points, triangles, self.edge, FEATURE_ANGLE)
        surface.add_features(*found["features"].transpose(1, 0, 2))
        return surface


@dataclasses.dataclass
class Step:
    """One action: by how much what was drawn is off, what the judge says of it (None where it cannot), the word, and
    how far what the quads have is from where the mouse was, where that is another question."""
    off: float
    verdict: object
    met: object
    text: str = ""
    from_mouse: float = 0

    def is_true(self):
        return self.verdict is None or self.met is None or bool(self.met) == self.verdict.ok

    def is_there(self):
        return self.verdict is None or (self.verdict.ok and self.from_mouse <= CLOSE)

    def is_good(self):
        return self.off <= CLOSE and self.is_true() and self.is_there()


class Walk:
    """On one surface, from quads without constraints."""

    def __init__(self, session):
        self.session = session
        self.free = session.quads_now()
        self.surface = session.input_now()

    def ball(self, place):
        """The irregular vertex of the quads from before that was meant, its place and valence."""
        inside = numpy.flatnonzero(self.free.valence + self.free.boundary != 4)
        near = inside[numpy.linalg.norm(self.free.points[inside] - place, axis=1).argmin()]
        return self.free.points[near], int(self.free.valence[near] + self.free.boundary[near])

    def course(self, places):
        """Of places on the quads from before, which are chords of the surface."""
        return judge.Course(self.surface.nearest(numpy.asarray(places, float))[0], self.surface.edge)

    def seen(self):
        """What was under the mouse."""
        return [numpy.asarray(p) for p in self.session.under if p is not None]

    def from_mouse(self, name, quads, drawn):
        """Edge lengths between what the quads have and where the mouse was; the constraint is smoothed a little. Of a
        loop across a body its farthest point from the plane of the drag: the rest of it no mouse has drawn."""
        under = self.seen()
        if name == "Feature":
            return judge.judge_feature(quads, self.course(under)).deviation
        if name == "Drag":
            ends = [self.ball(under[i])[0] for i in (0, -1)]
            return judge.judge_connection(self.surface, quads,
                                          self.course([ends[0], *under[1:-1], ends[1]])).deviation
        if name == "Loop":
            middle, normal = self.session.plane
            return float(numpy.abs((numpy.asarray(drawn[1]) - middle) @ normal).max()) / self.session.edge
        return 0

    def judged(self, name, quads, drawn):
        """What the quads have of it; None where it is not clear what was meant."""
        under = self.seen()
        if name == "Stroke":
            return judge.judge_stroke(self.surface, quads, self.course(under), 0)
        if name == "Feature":
            return judge.judge_feature(quads, self.course(drawn[1]))
        if name == "Valence":
            off = judge.judge_valence(self.surface, quads, under[-1], drawn[2])
            return judge.Verdict(off.deviation <= CLOSE, off.deviation)
        if name == "Move":
            place, valence = self.ball(under[0])
            return judge.judge_move(self.surface, quads, self.free, place, numpy.asarray(drawn[1][1]), valence)
        if name == "Drag":
            return judge.judge_connection(self.surface, quads, self.course(drawn[1]))
        if name == "Connect":
            line = self.surface.straight(*(self.ball(under[i])[0] for i in (0, -1)), True)
            return None if line is None else judge.judge_connection(self.surface, quads, self.course(line))
        if name == "Size":
            place, radius = under[0], math.dist(under[0], under[-1])
            return judge.judge_size(self.surface, quads, place, radius, SMALLER, GROWTH)
        if name == "Loop":
            return judge.judge_cycle(quads, self.course([*drawn[1], drawn[1][0]]))
        return None

    def step(self, name, chance):
        session = self.session
        session.ask("clear()")
        test_places.random_view(session, chance)
        session.ask("global balls_before; balls_before = [output(4).GetPoint(i) for i in "
                    "range(output(4).GetNumberOfPoints())]")
        session.begin()
        if name in ("Undo", "Remove"):
            return self.back(name, chance)
        if name == "Mirror":
            return self.mirror(chance)
        own = {"Connect": self.connect, "Drag": self.drag_connection}
        outcome = own.get(name, test_draw.ACTIONS.get(name))(session, chance)
        drawn = session.drawn()
        if not drawn:
            return Step(math.inf if outcome is test_draw.NOTHING else outcome.off, None, outcome.met, outcome.text)
        quads = session.quads_now()
        verdict, from_mouse = self.judged(name, quads, drawn), self.from_mouse(name, quads, drawn)
        if name == "Merge":
            verdict = judge.Verdict(outcome.is_true == (outcome.met == 1), 0)
        remark = session.value(f"last_remark({ROWS[name]!r})")
        told = f"judged {verdict.ok}, {verdict.deviation:.2f} {verdict.more}" if verdict else "not judged"
        return Step(outcome.off, verdict, outcome.met, f"{told}, {from_mouse:.2f} from the mouse; {outcome.text}; "
                    f"{remark}", from_mouse)

    def back(self, name, chance):
        """Two actions; the last one is undone, or taken away by the button."""
        session = self.session
        states = []
        for tool in (chance.choice(UNDONE), chance.choice(UNDONE)):
            session.take(tool)
            test_draw.ACTIONS[tool](session, chance)
            session.xdotool("key", "Escape")
            session.settle()
            states.append((session.value("bytes_of(quads())"), len(session.value("constraints()"))))
        begin = time.time()
        if name == "Undo":
            session.xdotool("mousemove", *session.middle(), "key", "ctrl+z")
        else:
            session.xdotool("mousemove", *session.remove, "sleep", 0.2, "click", 1)
        session.settle()
        after = session.value("bytes_of(quads())"), len(session.value("constraints()"))
        fine = after == states[0]
        return Step(0, judge.Verdict(fine, 0), 1, f"{states} {after}; {time.time() - begin:.1f} s")

    def mirror(self, chance):
        """By the list in the panel and Apply; the plane stands in the middle, across a random axis."""
        session = self.session
        normal = [0, 0, 0]
        normal[chance.randrange(3)] = 1
        session.ask(f"set_quietly('Symmetry', 'None'); set_quietly('SymmetryNormal', {normal!r})")
        panel = (150, session.size[1] - 250)
        session.xdotool("mousemove", *panel, "sleep", 0.1, "click", "--repeat", 20, "--delay", 30, 4)  # to its top
        session.scroll(panel, "the panel")
        x, y = session.find_by_change("set_quietly('Symmetry', 'None')", "set_quietly('Symmetry', 'Found')")
        session.click((x, y), "the list Symmetry")
        session.click((x, y + 22), "Plane in it")
        session.apply()
        session.settle()
        if session.value("quads().Symmetry") != "Plane":
            return Step(math.inf, None, None, "the list gave " + session.value("quads().Symmetry"))
        verdict = judge.Verdict(session.value("is_mirrored()"), 0)
        met, reason = session.word("symmetry") or (None, "no row")
        told = session.value("verdict_of(quads())")
        session.shot(f"walk-{session.surface.stem}-plane")
        session.ask("set_quietly('Symmetry', 'None')")
        session.apply()
        session.settle()
        return Step(0, verdict, met, f"normal {normal}, judged {verdict.ok}; {reason}; {told}")

    def connect(self, session, chance):
        """By clicks on two balls, every second time on one near the first."""
        first, second = self.pair(chance)
        session.press(first[0])
        session.press(second[0])
        return self.connected(first, second)

    def connected(self, first, second, places=None):
        """places: those under the mouse between them, where it was dragged."""
        drawn = self.session.drawn()
        if not drawn:
            self.session.xdotool("key", "Escape")
            self.session.take("Connect")
            return test_draw.NOTHING
        off = max(math.dist(drawn[1][0], first[1]), math.dist(drawn[1][-1], second[1]))
        off = max(off, self.session.value(f"line_off({places!r})") if places else 0) / self.session.edge
        met, reason = self.session.word("connection") or (None, "no row")
        far = math.dist(first[1], second[1]) / self.session.edge
        return test_draw.Outcome(off, met, True, f"{far:.1f} apart; {reason}")

    def pair(self, chance):
        balls = test_draw.visible_balls(self.session, chance, 2)
        first = chance.choice(balls)
        others = sorted((b for b in balls if b is not first), key=lambda b: math.dist(b[1], first[1]))
        return first, chance.choice(others[:NEAREST] if chance.random() < 0.5 else others)

    def drag_connection(self, session, chance):
        """From ball to ball, where all of the way is clearly seen."""
        for _ in range(200):
            first, second = self.pair(chance)
            count = max(6, round(math.dist(first[0], second[0]) / 8))
            pixels = [tuple(round(a + (b - a) * k / count) for a, b in zip(first[0], second[0]))
                      for k in range(count + 1)]
            seen = session.value(f"[seen_at(p) for p in {pixels!r}]")
            if math.dist(first[0], second[0]) > 20 and None not in seen and \
                    max(math.dist(a, b) for a, b in zip(seen[:-1], seen[1:])) < test_draw.LINE_NEAR * session.edge:
                session.drag(pixels)
                return self.connected(first, second, seen)
            test_places.random_view(session, chance)
        raise SystemExit("FAILED: hardly any way from ball to ball is seen")


def walk(session, options, writer):
    """All actions on one surface."""
    test_places.random_view(session, random.Random(options.seed))
    walked = Walk(session)
    for name in options.actions:
        session.ask("clear()")
        tool = {"Merge": "Move", "Drag": "Connect"}.get(name, name)
        if tool in session.tools:
            session.take(tool)
        steps, stills = [], []
        chance = random.Random(f"{options.seed} {name}")
        for number in range(options.places):
            try:
                step = walked.step(name, chance)
            except SystemExit as nowhere:
                print(f"{name} {number + 1}: {nowhere}", flush=True)
                break
            steps.append(step)
            stills += session.stills
            worst = max(session.stills, default=(0, 0))
            marks = ("" if step.is_true() else "  UNTRUE") + ("" if step.is_good() else "  BAD")
            print(f"{name} {number + 1}: {step.off:.3f} off, met {step.met}; {step.text}; still {worst[0]:.2f}/"
                  f"{worst[1]:.2f}{marks}", flush=True)
            if number < 1 or not step.is_good():
                session.shot(f"walk-{session.surface.stem}-{name.lower()}-{number + 1}")
        session.xdotool("key", "Escape")
        session.ask("pass")
        judged = [s for s in steps if s.verdict]
        row = (session.surface.stem, session.size[0], name, len(steps), sum(s.off <= CLOSE for s in steps),
               f"{sum(s.is_there() for s in judged)}/{len(judged)}", sum(s.met == 1 for s in steps),
               sum(s.is_true() for s in steps), len(stills), f"{max(stills, default=(0, 0))[0]:.2f}")
        print("  ".join(f"{c} {v}" for c, v in zip(COLUMNS, row)), flush=True)
        writer.writerow(row)


def main():
    parser = argparse.ArgumentParser()
    for program in ("xvfb", "paraview", "openbox"):
        parser.add_argument(program)
    parser.add_argument("surface", nargs="+", type=pathlib.Path)
    parser.add_argument("--actions", nargs="*", default=[*ROWS, "Undo", "Remove"])
    parser.add_argument("--places", type=int, default=10)
    parser.add_argument("--quads", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--size", nargs=2, type=int, default=(1600, 1000), help="of the window")
    parser.add_argument("--csv", type=pathlib.Path, default=pathlib.Path("/dev/null"))
    options = parser.parse_args()
    Session.size = tuple(options.size)
    with open(options.csv, "a", newline="", encoding="utf-8") as file:
        for surface in options.surface:
            with tempfile.TemporaryDirectory() as folder:
                session = Session(pathlib.Path(folder), options)
                session.surface = surface
                try:
                    session.start()
                    session.open(options.quads)
                    session.find_tools()
                    walk(session, options, csv.writer(file))
                    file.flush()
                except BaseException:
                    session.shot("walk-failure")
                    raise
                finally:
                    print((pathlib.Path(folder) / "log").read_text(encoding="utf-8"))
                    session.close()


if __name__ == "__main__":
    main()
