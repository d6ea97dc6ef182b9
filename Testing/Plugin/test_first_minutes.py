# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What the menu Help of ParaView's real window has for the first minutes, by the mouse under openbox.

  test_first_minutes.py XVFB PARAVIEW PVPYTHON OPENBOX [--size WIDTH HEIGHT] [--server WORD...]

The tutorial is walked through: its strip goes on when what it says is done, and not when something else is. Each
example is opened and looked at: quads, constraints, symmetry, elements. With --server the window is connected to what
these words start, such as pvserver. Screenshots are left in the folder QUADRILLE_ARTIFACTS. Needs Debian's openbox and
xdotool.
"""
import argparse
import math
import pathlib
import sys
import tempfile
import time

import count_actions
import test_draw
import test_places

MENU_BAR = range(4, 18)     # rows of pixels
ENTRY = 25                  # pixels from one entry of a menu to the next, separators aside
STRIP = range(204, 244)     # rows of the tutorial, under its title
CLOSE = 191                 # row of its title
FLANK = ((-0.75, 0.42), (-0.45, 0.33), (-0.15, 0.18), (0.15, 0.03), (0.45, -0.1))  # x and z on the scan's side
EXAMPLES = ("Scan With Strokes", "Part For Simulation", "Symmetry")


def check(condition, text):
    if not condition:
        raise SystemExit("FAILED: " + text)


class Session(test_draw.Session):
    def help(self, entry):
        """Help > Quadrille > its first entry, 0, or one of the examples, which stand below a separator."""
        rows = self.rows()
        words = [x for x in range(count_actions.WIDTH // 2)
                 if any(max(rows[y][3 * x:3 * x + 3]) < 90 for y in MENU_BAR)]
        below = 34 + entry * ENTRY + (2 if entry else 0)
        self.xdotool("mousemove", words[-1] - 10, 10, "sleep", 0.2, "click", 1, "sleep", 0.4,
                     "mousemove_relative", 30, 24, "sleep", 0.2, "click", 1, "sleep", 0.4)
        self.xdotool("mousemove", words[-1] + 360, below, "sleep", 0.2, "click", 1)
        self.settle()

    def strip(self):
        """What the tutorial's strip looks like."""
        rows = self.rows()
        return b"".join(rows[y][:3 * self.size[0] // 2] for y in STRIP)

    def goes_on(self, what, action):
        """Whether the strip changes with what is done."""
        action()
        self.settle()
        time.sleep(0.6)  # it looks five times a second
        before, self.seen = self.seen, self.strip()
        changed = self.seen != before
        print(f"{what}: the tutorial {'goes on' if changed else 'stays'}", flush=True)
        return changed


def draw_stroke(session):
    corners = [session.value(f"pixel_of(({x}, -0.45, {z}))") for x, z in FLANK]
    session.drag([tuple(round(a + (b - a) * k / 8) for a, b in zip(p, q))
                  for p, q in zip(corners, corners[1:]) for k in range(9)])


def drag_ball(session):
    """The one that is seen nearest to the middle of the body's side, along the body."""
    found = session.value("[(pixel_of(b), seen_at(pixel_of(b)), b) for b in "
                          "[output(4).GetPoint(i) for i in range(output(4).GetNumberOfPoints())]]")
    seen = [pixel for pixel, place, ball in found if place and math.dist(place, ball) < session.edge]
    middle = session.value("pixel_of((0, -0.45, 0))")
    x, y = (round(c) for c in min(seen, key=lambda pixel: math.dist(pixel, middle)))
    to = 1 if x < middle[0] else -1
    session.drag([(x, y), (x + 15 * to, y + 8), (x + 30 * to, y + 15), (x + 40 * to, y + 20)])


def tutorial(session):
    """All steps, with what is not asked for between them."""
    session.help(0)
    session.find_origin()
    session.find_tools()
    session.shot("first-tutorial")
    session.seen = session.strip()
    view = session.value("view.ViewSize[1]")
    steps = (("Remesh", lambda: session.take("Remesh"), True), ("Valence in place of Stroke",
             lambda: session.take("Valence"), False), ("Stroke", lambda: session.take("Stroke"), True),
             ("a drag", lambda: draw_stroke(session), True), ("Move", lambda: session.take("Move"), True),
             ("a click beside the balls", lambda: session.press((30, 30)), False),
             ("a drag of a ball", lambda: drag_ball(session), True),
             ("Ctrl+Z", lambda: session.xdotool("key", "ctrl+z"), True),
             ("Escape", lambda: session.xdotool("key", "Escape"), True))
    for number, (what, action, wanted) in enumerate(steps):
        check(session.goes_on(what, action) == wanted,
              f"after {what} the tutorial {'stays' if wanted else 'goes on'}")
        if number == 0:
            session.find_origin()
            session.edge = session.value("edge_length()")
    check([c[0] for c in session.value("constraints()")] == ["QuadStroke"], "there is more, or less, than a stroke")
    check(session.word("guide stroke")[0] == 1, "the stroke is not met")
    check(session.value("simple.GetDisplayProperties(simple.OutputPort(quads(), 5), view).ColorArrayName[1]") == "Met",
          "the stroke is not coloured by whether it is met")
    session.xdotool("mousemove", session.size[0] - 8, CLOSE, "sleep", 0.2, "click", 1, "sleep", 1)
    session.ask("pass")
    check(session.value("view.ViewSize[1]") > view, "the tutorial does not close")


#: What an example must have, by what is asked of the window.
LOOKS = {
    "Scan With Strokes": ("sorted((kind, met) for kind, met, _ in rows())",
                          [("guide stroke", "1"), ("guide stroke", "1"), ("valence", "1")]),
    "Part For Simulation": ("[(e.GetCellType(0), e.GetCellData().HasArray('ScaledJacobian')) for e in "
                            "[window_answers.data_of(simple.FindSource('QuadElements1'))]]", [(23, 1)]),
    "Symmetry": ("[output(0).GetPointData().HasArray('MirrorPoint'), rows()[0][1]]", [1, "1"]),
}


def example(session, number, name):
    session.help(number)
    session.wait_until("quads() is not None and output(0).GetNumberOfCells() > 0")
    session.wait_until("is_made()", seconds=120)
    session.shot("first-example-" + str(number))
    question, wanted = LOOKS[name]
    there = session.value(question)
    print(f"{name}: {session.value('output(0).GetNumberOfCells()')} quads, {there}", flush=True)
    check(there == wanted, f"{name} has {there}")
    press_key(session, "ctrl+z")
    check(session.value("quads() is not None"), "an undo takes half of an example away")


def delete_all(session):
    """By the window's script, what was made last first."""
    session.ask("clear() if quads() else None")
    session.ask("[simple.Delete(s) for s in "
                "sorted(simple.GetSources().values(), key=lambda s: -s.SMProxy.GetGlobalID())]")


def press_key(session, key):
    session.xdotool("mousemove", *session.middle(), "key", key)
    session.settle()


def check_reset(session):
    """The window lives on where a session is left whose constraint is selected. No questions afterwards."""
    session.ask("simple.SetActiveSource(quads().Constraints[0])")
    session.ask("simple.ResetSession()")
    time.sleep(3)
    session.shot("first-reset")
    check(session.paraview.poll() is None, "ParaView ended when the session was left")


def main():
    parser = argparse.ArgumentParser()
    for program in ("xvfb", "paraview", "pvpython", "openbox"):
        parser.add_argument(program)
    parser.add_argument("--size", nargs=2, type=int, default=(1280, 800))
    parser.add_argument("--server", nargs="+", default=())
    options = parser.parse_args()
    Session.size, Session.pvserver = tuple(options.size), options.server
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        session = Session(folder, options)
        try:
            session.start()
            tutorial(session)
            for left in (2, 1, 1):
                press_key(session, "ctrl+z")
                there = session.value("list(simple.GetSources())")
                check(len(there) == left, f"undo leaves {there}")
            for number, name in reversed(list(enumerate(EXAMPLES, 1))):
                delete_all(session)
                example(session, number, name)
            check_reset(session)
        except BaseException:
            session.shot("first-failure")
            raise
        finally:
            log = (folder / "log").read_text(encoding="utf-8")
            print(log)
            session.close()
    check("critical" not in log, "ParaView told of something critical")
    print("first minutes: fine")


if __name__ == "__main__":
    main()
