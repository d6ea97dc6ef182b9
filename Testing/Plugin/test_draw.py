# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The drawing tools in ParaView's real window, under openbox at its defaults, by the mouse at random places.

  test_draw.py XVFB PARAVIEW PVPYTHON OPENBOX [--tools NAME...] [--places N] [--surface FILE...] [--seed N]
               [--quads N] [--checks NAME...] [--size WIDTH HEIGHT] [--server WORD...]

Opens each surface and makes quads by keyboard. With each tool so many random places, or paths, are drawn where the
surface is clearly seen. Then the constraint, and the quads, are compared with the places under the mouse, which rays
from the camera tell: half an edge length of the quads is allowed. What the table of constraints says is compared with
the quads themselves. Then it is tried that Escape leaves the tool, that one undo takes back one action, that what
test_places.py looks at holds here, too, and more (CHECKS). With --server the window is connected to what these words
start, such as pvserver.
Screenshots are left in the folder QUADRILLE_ARTIFACTS. Needs Debian's openbox and xdotool.
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
import test_places

REGULAR = 4
ALLOWED = test_places.ALLOWED  # edge lengths
NEAR = test_places.NEAR
LINE_NEAR = 0.7   # edge lengths between what pixels beside each other see along a line
BAR = 0.98       # of the places
MET_ANGLE = 5    # degrees in the mean, as the Constraint Table has it for strokes
MET_OFF = 0.3    # edge lengths, as the table has it for feature curves
SEEN = 0.8       # of a line, the share that is not hidden
DOUBT = 2.5      # degrees in which two ways to measure the mean may differ
WIDTH = count_actions.WIDTH
FILE_MENU = 20, 10      # pixels of the screen
CLOSE_VIEW = 16, 222    # from the right end of the window
SELECTED = bytes((48, 140, 198))  # of the pipeline
BUSY = 80000  # quads: an edit of them takes seconds, in which something else can be done
COVERED = 200  # pixels at the lower end of the view, where the window Output Messages may lie
TOOLS = ("Stroke", "Valence", "Move", "Connect", "Loop", "Feature", "Size")  # in their order
MESSAGES = "^Output Messages"


class Session(test_places.Session):
    """ParaView under a window manager, with the tools of its tool bar."""

    script = "draw_script.py"

    def find_tools(self):
        """The buttons of the tool bar, which has a row of its own above the panels: icons with gaps between them."""
        rows = self.rows()
        top, bottom, empty = 152, 174, 3 * 13
        icons, start, last = [], None, 0
        for x in range(13, WIDTH // 4):
            if any(rows[y][3 * x:3 * x + 3] != rows[y][empty:empty + 3] for y in range(top, bottom)):
                start, last = x if start is None else start, x
            elif start is not None and x - last > 3:
                icons.append((start, last))
                start = None
        icons = [(a, b) for a, b in icons if b - a >= 10]
        self.tools = {name: ((a + b) // 2, (top + bottom) // 2) for name, (a, b) in zip(("Remesh", *TOOLS), icons)}
        y = (top + bottom) // 2
        self.remove = max(x for x in range(WIDTH // 2) if rows[y][3 * x:3 * x + 3] != rows[y][3:6]), y

    def take(self, name):
        """Presses the button of a tool; pressed again it leaves it."""
        self.xdotool("mousemove", *self.tools[name], "sleep", 0.05, "click", 1)
        self.ask("pass")

    def drag(self, pixels):
        """With the left button, through pixels of the view."""
        words = ["mousemove", *self.screen(pixels[0]), "sleep", 0.1, "mousedown", 1, "sleep", 0.05]
        for pixel in pixels[1:]:
            words += ["mousemove", *self.screen(pixel), "sleep", 0.01]
        self.xdotool(*words, "sleep", 0.05, "mouseup", 1)
        self.settle()

    def set_number(self, number):
        """By the field of the panel, and Apply; 0: the field is emptied."""
        self.ask("simple.SetActiveSource(quads())")
        old = self.value("quads().NumberOfQuads")
        x, y = self.find_by_change(f"set_quietly('NumberOfQuads', {old})", "set_quietly('NumberOfQuads', 8888)")
        keys = ("type", str(number)) if number else ("key", "BackSpace")
        self.xdotool("mousemove", x, y, "click", "--repeat", 3, "--delay", 80, 1, "sleep", 0.3, *keys)
        self.xdotool("sleep", 0.3)
        self.apply()
        self.settle()
        if self.value("quads().NumberOfQuads") != number:
            raise SystemExit("FAILED: the typed number of quads did not come in")

    def press(self, pixel):
        """A click."""
        self.xdotool("mousemove", *self.screen(pixel), "sleep", 0.1, "click", 1)
        self.settle()

    def settle(self):
        """What was drawn is made once the events of the mouse are over, in the background."""
        for _ in range(2):
            self.ask("pass", seconds=180)
        self.wait_until("is_made()", seconds=180)

    def places(self, chance, count):
        found = []
        for _ in range(20 + 10 * count):
            found += [p for p in super().places(chance, 1) if p[0][1] > COVERED]
            if len(found) == count:
                return found
        raise SystemExit("FAILED: hardly any place of the quads is seen in the upper part of the view")

    def share_seen(self, pixels):
        """Of pixels of the view those with the green or magenta of a stroke within four pixels."""
        self.ask("simple.Render(view)")
        time.sleep(0.3)
        rows = self.rows()

        def is_drawn(x, y):
            near = [rows[v][3 * u:3 * u + 3] for v in range(y - 4, y + 5) for u in range(x - 4, x + 5)]
            return any(r > 45 and b > 45 and g < min(r, b) / 2 or g > 55 and r < g / 2 and b < 0.8 * g
                       for r, g, b in near)

        return sum(is_drawn(*(round(c) for c in self.screen(p))) for p in pixels) / len(pixels)

    def balls(self):
        return [b for b in super().balls() if b[0][1] > COVERED]

    def path(self, chance, shortest=80, longest=240, bend=0.006):
        """Pixels that clearly see the quads, and what they see, along a random arc."""
        for _ in range(20):
            numbers = chance.randrange(10 ** 6), shortest, longest, bend, LINE_NEAR * self.edge
            found = self.value(f"random_path{numbers!r}")
            if found:
                return [tuple(p) for p, _ in found], [tuple(q) for _, q in found]
            test_places.random_view(self, chance)
        raise SystemExit("FAILED: hardly any line on the quads is seen")

    def drawn(self):
        """The constraint that was drawn: kind of source, points, valence; None where nothing was."""
        found = self.value("constraints()")
        return found[-1] if found else None

    def word(self, kind):
        return self.value(f"last_row({kind!r})")


class Outcome:
    """How far a constraint lies from the mouse, and whether what is said of it is true; in edge lengths."""

    def __init__(self, off, met, is_true, text=""):
        self.off, self.met, self.is_true, self.text = off, met, is_true, text

    def is_good(self):
        return self.off <= ALLOWED and self.is_true


NOTHING = Outcome(math.inf, None, False, "nothing was drawn")


def stroke(session, chance):
    pixels, places = session.path(chance)
    session.drag(pixels)
    if not session.drawn():
        return NOTHING
    seen = session.share_seen(pixels)
    off = session.value(f"line_off({places!r})") / session.edge
    angle = session.value(f"angle_along({places!r})")
    met, reason = session.word("guide stroke") or (None, "no row")
    is_true = met is not None and (angle <= MET_ANGLE + DOUBT if met else angle >= MET_ANGLE - DOUBT)
    return Outcome(off, met, is_true and seen > SEEN, f"{angle:.1f} degrees; seen {seen:.2f}; {reason}")


def feature(session, chance):
    pixels, places = session.path(chance)
    session.drag(pixels)
    if not session.drawn():
        return NOTHING
    off = session.value(f"line_off({places!r})") / session.edge
    away = session.value(f"off_lines({places!r})") / session.edge
    met, reason = session.word("feature curve") or (None, "no row")
    is_true = met is not None and (away <= MET_OFF + off if met else away > MET_OFF - off)
    return Outcome(off, met, is_true, f"features {away:.2f} off; {reason}")


def clear(session, chance):
    """A click on a feature curve."""
    for _ in range(20):
        found = session.value(f"feature_places({chance.randrange(10 ** 6)}, {NEAR * session.edge})")
        if found:
            break
        test_places.random_view(session, chance)
    else:
        raise SystemExit("FAILED: hardly any feature is seen")
    pixel, place = found[0]
    session.press(pixel)
    drawn = session.drawn()
    if not drawn or drawn[0] != "QuadClearedFeature":
        return NOTHING
    off = math.dist(drawn[1][0], place) / session.edge
    away = session.value(f"off_features({tuple(drawn[1][0])!r})") / session.edge
    met, reason = session.word("cleared feature") or (None, "no row")
    return Outcome(off, met, met is not None and (away > MET_OFF) == (met == 1),
                   f"the nearest feature is {away:.2f} off; {reason}")


def valence(session, chance):
    pixel, place = session.places(chance, 1)[0]
    wanted = chance.choice((3, 5))
    session.ask("pass")
    session.xdotool("mousemove", *session.screen(pixel), "key", str(wanted))
    session.press(pixel)
    drawn = session.drawn()
    if not drawn:
        return NOTHING
    off = math.dist(drawn[1][0], place) / session.edge
    nearest = session.value(f"nearest_of_valence({tuple(place)!r}, {wanted})") / session.edge
    met, reason = session.word("valence") or (None, "no row")
    is_true = drawn[2] == wanted and met is not None and (nearest <= ALLOWED if met else reason != "" or nearest > 0.2)
    return Outcome(off, met, is_true, f"{wanted} is {nearest:.2f} off; {reason}")


def size(session, chance):
    """From a place to another one between two and six edge lengths away, with the factor that the tool bar has."""
    for _ in range(40):
        centre, *others = session.places(chance, 8)
        near = [p for p in others if 2 * session.edge < math.dist(p[1], centre[1]) < 6 * session.edge]
        if near:
            break
    else:
        raise SystemExit("FAILED: hardly any two places near each other are seen")
    pixel, place = near[0]
    session.drag([centre[0], tuple((a + b) / 2 for a, b in zip(centre[0], pixel)), pixel])
    drawn = session.drawn()
    if not drawn:
        return NOTHING
    radius, factor = session.value("[list(quads().Constraints)[-1].GetPropertyValue(n) for n in ('Radius', 'Factor')]")
    off = max(math.dist(drawn[1][0], centre[1]), abs(radius - math.dist(place, centre[1]))) / session.edge
    length, count = session.value(f"size_within({tuple(centre[1])!r}, {radius})")
    met, reason = session.word("size") or (None, "no row")
    share = length / session.edge / factor
    is_true = met is not None and factor == 0.5 and (share < 1.45 if met else share > 1.1 and reason != "")
    return Outcome(off, met, is_true, f"{count} quads {share:.2f} times as long as asked for; {reason}")


def visible_balls(session, chance, least, only_free=False):
    """In a view that shows so many; only_free: those that can be moved."""
    for _ in range(40):
        balls = session.balls()
        free = session.value("free_balls()") if only_free and balls else set()
        balls = [b for b in balls if b[1] in free] if only_free else balls
        if len(balls) >= least:
            return balls
        test_places.random_view(session, chance)
    raise SystemExit("FAILED: hardly any irregular vertex is seen")


def move(session, chance):
    ball = chance.choice(visible_balls(session, chance, 1, True))
    before = session.value(f"valence_at({tuple(ball[1])!r})")
    places = [p for p in session.places(chance, 6)
              if session.edge < math.dist(p[1], ball[1]) < 5 * session.edge] or session.places(chance, 1)
    pixel, place = chance.choice(places)
    others = [b for b in session.value("balls_before")
              if math.dist(b, place) <= ALLOWED * session.edge and b != tuple(ball[1])]
    goal = min(others, key=lambda b: math.dist(b, place)) if others else place
    wanted = before + session.value(f"valence_at({tuple(goal)!r})") - REGULAR if others else before
    beside = others_near(session, goal, ball[1])
    session.drag([ball[0], tuple((a + b) / 2 for a, b in zip(ball[0], pixel)), pixel])
    drawn = session.drawn()
    if not drawn:
        return NOTHING
    return moved(session, drawn, ball, goal, wanted, beside)


def moved(session, drawn, ball, goal, wanted, beside):
    """Of a ball that was dropped: what is there now. beside: the other irregular vertices there before."""
    off = max(math.dist(drawn[1][0], ball[1]), math.dist(drawn[1][1], goal)) / session.edge
    met, reason = session.word("move") or (None, "no row")
    there = session.value(f"irregular_within({tuple(goal)!r}, {session.edge})")
    is_there = wanted == REGULAR and len(there) <= len(beside) or \
        any(v == wanted and d <= ALLOWED * session.edge for d, v in there) and len(there) <= len(beside) + 1
    is_true = met is not None and (is_there if met else reason != "")
    found = [(round(d / session.edge, 2), v) for d, v in there]
    return Outcome(off, met, is_true, f"a {wanted} was to be there and is {is_there}: {found}; {reason}")


def merge(session, chance):
    """A ball is dropped on one of another place: the two become one, or none."""
    for _ in range(40):
        balls = visible_balls(session, chance, 2, True)
        pairs = sorted((math.dist(a[1], b[1]), i, j) for i, a in enumerate(balls) for j, b in enumerate(balls)
                       if math.dist(a[1], b[1]) > 1.5 * session.edge)
        if pairs:
            break
        test_places.random_view(session, chance)
    else:
        raise SystemExit("FAILED: hardly any two balls beside features are seen")
    _, i, j = pairs[chance.randrange(min(4, len(pairs)))]
    ball, goal = balls[i], balls[j]
    wanted = sum(session.value(f"valence_at({tuple(b[1])!r})") for b in (ball, goal)) - REGULAR
    beside = others_near(session, goal[1], ball[1])
    session.drag([ball[0], *(tuple(round(a + (b - a) * k / 6) for a, b in zip(ball[0], goal[0])) for k in range(1, 7))])
    drawn = session.drawn()
    return moved(session, drawn, ball, goal[1], wanted, beside) if drawn else NOTHING


def others_near(session, goal, ball):
    """Irregular vertices that may be within an edge length of a goal afterwards: neither there nor the ball."""
    near = session.value(f"irregular_within({tuple(goal)!r}, {1.5 * session.edge})")
    own = math.dist(ball, goal)
    return [(d, v) for d, v in near if d > 1e-6 * session.edge and abs(d - own) > 1e-6 * session.edge]


def connect(session, chance):
    first, second = chance.sample(visible_balls(session, chance, 2), 2)
    session.press(first[0])
    session.press(second[0])
    drawn = session.drawn()
    if not drawn:
        session.xdotool("key", "Escape")  # the one end is not taken for the next pair
        session.take("Connect")
        return NOTHING
    off = max(math.dist(drawn[1][0], first[1]), math.dist(drawn[1][-1], second[1])) / session.edge
    met, reason = session.word("connection") or (None, "no row")
    return Outcome(off, met, met is not None and (met == 1 or reason != ""), reason)


def loop(session, chance):
    pixels, places = session.path(chance, bend=0)
    closes = session.value(f"cut_closes({places!r})")
    session.drag(pixels)
    drawn = session.drawn()
    if bool(drawn) != closes:
        return NOTHING
    if not drawn:
        return Outcome(0, None, True, "nothing was drawn, as the cut does not close")
    off = session.value(f"float(from_polyline({places!r}, constraints()[-1][1], True).max())") / session.edge
    met, reason = session.word("cycle") or (None, "no row")
    return Outcome(off, met, met is not None and (met == 1 or reason != ""), reason)


ACTIONS = {"Stroke": stroke, "Valence": valence, "Move": move, "Merge": merge, "Connect": connect, "Loop": loop,
           "Feature": feature, "Clear": clear, "Size": size}
#: Of what has no tool of its own.
BUTTONS = {"Clear": "Feature", "Merge": "Move"}


def try_tool(session, name, chance, count):
    """Draws so many times with a tool; how many of them are bad."""
    session.ask("clear()")
    session.take(BUTTONS.get(name, name))
    outcomes = []
    for number in range(count):
        session.ask("clear()")
        test_places.random_view(session, chance)
        session.ask("global balls_before; balls_before = [output(4).GetPoint(i) for i in "
                    "range(output(4).GetNumberOfPoints())]")
        outcome = ACTIONS[name](session, chance)
        outcomes.append(outcome)
        print(f"{name} {number + 1}: {outcome.off:.3f} edge lengths off, met {outcome.met}; {outcome.text}"
              f"{'' if outcome.is_good() else '  BAD'}", flush=True)
        if not outcome.is_good():
            print(f"  drawn: {session.drawn()}", flush=True)
        if number < 2 or not outcome.is_good():
            session.shot(f"draw-{session.surface.stem}-{name.lower()}-{number + 1}")
    session.xdotool("key", "Escape")
    session.ask("pass")
    good = sum(o.is_good() for o in outcomes)
    met = sum(o.met == 1 for o in outcomes)
    offs = sorted(o.off for o in outcomes)
    print(f"{session.surface.name}, {name}: {good} of {count} where the mouse was and told truly, {met} met; "
          f"median {offs[len(offs) // 2]:.3f} edge lengths off, largest {offs[-1]:.3f}", flush=True)
    return count - good


def check_escape(session, chance):
    """After Escape, and after a second press of the button, the left button moves the camera and draws nothing."""
    bad = 0
    session.ask("clear()")
    session.look(270, 20)
    pixels = [pixel for pixel, _ in session.places(chance, 2)]
    for name, way in [(name, "Escape") for name in TOOLS] + [("Stroke", "button")]:
        session.look(270, 20)
        session.take(name)
        if way == "Escape":
            session.xdotool("mousemove", *session.screen(pixels[0]), "key", "Escape")
        else:
            session.take(name)
        camera = session.value("list(view.CameraPosition)")
        session.drag(pixels)
        left = session.drawn() is None and session.value("list(view.CameraPosition)") != camera
        print(f"{name} left by {way}: {'fine' if left else 'BAD'}", flush=True)
        bad += not left
    return bad


def check_camera(session, chance):
    """With a tool on, the left button beside the surface moves the camera, and so does the right one on it."""
    session.ask("clear()")
    session.look(270, 20)
    session.take("Stroke")
    width, height = session.value("view.ViewSize")
    moved = []
    for button, start in ((1, (width - 30, height - 30)), (3, session.places(chance, 1)[0][0])):
        before = session.value("list(view.CameraPosition)")
        x, y = session.screen(start)
        session.xdotool("mousemove", x, y, "sleep", 0.1, "mousedown", button, "mousemove", x - 20, y + 20, "sleep", 0.1,
                        "mousemove", x - 40, y + 60, "sleep", 0.1, "mouseup", button)
        session.settle()
        moved.append(session.value("list(view.CameraPosition)") != before)
        session.look(270, 20)
    nothing = session.drawn() is None
    session.xdotool("key", "Escape")
    print(f"camera beside the surface {moved[0]}, with the right button {moved[1]}, nothing drawn {nothing}")
    return not (all(moved) and nothing)


def check_undo(session, chance):
    """One undo takes one action back, with the quads of before and what was said of it; redo brings it again."""
    bad = 0
    for name in ("Stroke", "Valence"):
        session.ask("clear()")
        session.look(270, 20)
        before = session.value("bytes_of(quads())")
        session.take(name)
        ACTIONS[name](session, chance)
        made, count = session.value("bytes_of(quads())"), len(session.value("constraints()"))
        states, said = [], [length_of_words(session)]
        for key in ("ctrl+z", "ctrl+y"):
            session.xdotool("key", key)
            session.settle()
            states.append((session.value("bytes_of(quads())"), len(session.value("constraints()"))))
            said.append(length_of_words(session))
        fine = count == 1 and made != before and states == [(before, 0), (made, 1)] and \
            said[0] > 0 and said[1:] == [0, 0]
        session.xdotool("key", "Escape")
        bad_word = f"BAD: {count} constraints, {states}, {said}"
        print(f"undo and redo of {name}: {'fine' if fine else bad_word}", flush=True)
        bad += not fine
    return bad


def check_rows(session, chance):
    """Actions that are undone, again and again, leave the row selected that was."""
    session.ask("clear()")
    session.look(270, 20)
    session.take("Valence")
    rows = [session.value("selected()")]
    for _ in range(3):
        ACTIONS["Valence"](session, chance)
        rows.append(session.value("selected()"))
        session.xdotool("key", "ctrl+z")
        session.settle()
        rows.append(session.value("selected()"))
    session.xdotool("key", "Escape")
    fine = min(rows) > 0
    print(f"rows that are selected after actions and undos: {rows}: {'fine' if fine else 'BAD'}", flush=True)
    return not fine


def length_of_words(session):
    """Dark pixels behind the buttons and fields of the tool bar."""
    session.ask("pass")
    rows = session.rows()
    left, y = max(x for x, _ in session.tools.values()) + 260, session.tools["Stroke"][1]
    return sum(1 for v in range(y - 14, y + 15) for x in range(left, session.size[0] - 10)
               if max(rows[v][3 * x:3 * x + 3]) < 100)


def check_words(session, chance):
    """A drag that leaves the surface at once while quads are made draws nothing, and what it says stays."""
    session.ask("clear()")
    session.look(270, 20)
    session.take("Stroke")
    pixels, _ = session.path(chance)
    outline = session.value(f"outline_right_of({pixels[0]!r})")
    words = []
    for more in ([], [(outline[0] - 1, outline[1]), (outline[0] + 30, outline[1]), (outline[0] + 60, outline[1])]):
        session.ask("clear()")
        session.xdotool("mousemove", *session.screen(pixels[0]), "sleep", 0.1, "mousedown", 1,
                        *[word for p in pixels[1:] for word in ("mousemove", *session.screen(p))], "mouseup", 1)
        if more:
            session.drag(more)
        session.settle()
        words.append((len(session.value("constraints()")), length_of_words(session)))
    session.shot("draw-words")
    session.xdotool("key", "Escape")
    fine = [count for count, _ in words] == [1, 1] and words[1][1] > 1.2 * words[0][1] > 0
    print(f"a line that cannot be drawn while quads are made: constraints and dark pixels of words {words}: "
          f"{'fine' if fine else 'BAD'}", flush=True)
    return not fine


def check_labels(session):
    """Quads are not painted by an array of one value by which their surface is."""
    session.ask("clear(); make_labels()")
    session.take("Remesh")
    session.wait_until("colour_of_second() is not None", seconds=120)
    session.shot("draw-labels")
    colour = session.value("colour_of_second()")
    session.ask("simple.Delete(simple.FindSource('QuadRemesh2')); simple.Delete(simple.FindSource('Calculator1')); "
                "simple.Show(quads(), view); clear()")
    print(f"quads of a surface with labels are painted by {colour!r}: {'BAD' if colour else 'fine'}", flush=True)
    return colour != ""


def check_remove(session, chance):
    """Remove takes the constraint that is selected, else the last one; an undo each brings it back, with its quads."""
    session.ask("clear()")
    session.look(270, 20)
    for name in ("Stroke", "Valence"):
        session.take(name)
        ACTIONS[name](session, chance)
        session.xdotool("key", "Escape")
    session.ask("pass")

    def state():
        return [kind for kind, *_ in session.value("constraints()")], session.value("bytes_of(quads())")

    both = state()
    kinds = []
    for selected in ("list(quads().Constraints)[0]", "quads()"):
        session.ask(f"simple.SetActiveSource({selected})")
        session.xdotool("mousemove", *session.remove, "sleep", 0.2, "click", 1)
        session.settle()
        kinds.append(state()[0])
        session.xdotool("mousemove", *session.middle(), "key", "ctrl+z")
        session.settle()
        kinds.append(state() == both)
    fine = kinds == [["QuadValence"], True, ["QuadStroke"], True]
    print(f"what Remove leaves, and whether an undo brings all back: {kinds}: {'fine' if fine else 'BAD'}", flush=True)
    session.ask("clear()")
    return not fine


def saturation(session, name):
    """Of the most colourful pixel of a button, 0 to 255."""
    x, y = session.tools[name]
    rows = session.rows()
    pixels = [rows[v][3 * u:3 * u + 3] for v in range(y - 8, y + 9) for u in range(x - 8, x + 9)]
    return max(max(p) - min(p) for p in pixels)


def check_bar(session):
    """Without a Quad Remesh the tools are grey and do nothing; the first button makes quads by one click."""
    session.ask("pass")
    grey = [saturation(session, name) for name in TOOLS]
    session.take("Stroke")
    x, y = session.middle()
    camera = session.value("list(view.CameraPosition)")
    session.xdotool("mousemove", x, y, "sleep", 0.1, "mousedown", 1, "mousemove", x + 40, y + 30, "sleep", 0.1,
                    "mousemove", x + 90, y + 60, "sleep", 0.1, "mouseup", 1)
    session.settle()
    moved = session.value("list(view.CameraPosition)") != camera
    session.shot("draw-bar-grey")
    session.take("Remesh")
    session.wait_for_quads()
    session.xdotool("mousemove", *session.middle(), "sleep", 0.5)
    coloured = [saturation(session, name) for name in TOOLS]
    session.shot("draw-bar-quads")
    for key, there in (("ctrl+z", False), ("ctrl+y", True)):
        session.xdotool("mousemove", *session.middle(), "key", key)
        session.settle()
        if session.value("quads() is not None") != there:
            print(f"BAD: after {key} there is {'no' if there else 'still a'} Quad Remesh")
            return 1
    session.wait_for_quads()
    fine = max(grey) < 30 and min(coloured) > 60 and moved
    print(f"tool bar: saturation without a Quad Remesh {grey}, with it {coloured}; camera moved {moved}: "
          f"{'fine' if fine else 'BAD'}", flush=True)
    return not fine


def check_handles(session, chance, count):
    """The point of a selected constraint is dragged over the surface: it lies under the mouse, with a ring round it."""
    bad = 0
    for number in range(count):
        session.ask("clear()")
        test_places.random_view(session, chance)
        session.take("Valence")
        valence(session, chance)
        session.xdotool("key", "Escape")
        session.ask("simple.SetActiveSource(quads().Constraints[0])")
        time.sleep(1)
        start = session.value("pixel_of(constraints()[-1][1][0])")
        ring = ring_pixels(session, start)
        places = [p for p in session.places(chance, 12) if 40 < math.dist(p[0], start) < 250] or \
            session.places(chance, 1)
        goal, place = places[0]
        before = session.value("bytes_of(quads())")
        session.xdotool("mousemove", *session.screen([round(c) for c in start]), "sleep", 0.1, "mousedown", 1)
        followed = 0
        for k in range(1, 6):
            session.xdotool("mousemove", *session.screen([round(a + (b - a) * k / 5) for a, b in zip(start, goal)]))
            session.ask("pass")
            followed += session.value("bytes_of(quads())") != before
        session.shot(f"draw-handle-{number + 1}")
        session.xdotool("mouseup", 1)
        session.settle()
        off = math.dist(session.drawn()[1][0], place) / session.edge
        whole = session.value("is_whole()")
        met, reason = session.word("valence") or (None, "no row")
        after = ring_pixels(session, goal)
        session.xdotool("mousemove", *session.middle(), "key", "ctrl+z")
        session.settle()
        back = session.value("bytes_of(quads())") == before
        fine = off <= ALLOWED and whole and followed > 0 and ring > 15 and after > 15 and back
        print(f"handle {number + 1}: {off:.3f} edge lengths off, met {met} {reason}; {followed} previews of 5, ring "
              f"{ring} and {after} pixels, undone {back}{'' if fine else '  BAD'}", flush=True)
        bad += not fine
    session.ask("clear()")
    return bad


def check_ball(session, chance):
    """The quads follow a ball that is dragged; Escape while the button is down brings them back."""
    session.ask("clear()")
    session.look(270, 20)
    session.take("Move")
    start = chance.choice(visible_balls(session, chance, 1))[0]
    goal = [p for p, _ in session.places(chance, 12) if 40 < math.dist(p, start) < 250][0]
    before = session.value("bytes_of(quads())")
    session.xdotool("mousemove", *session.screen([round(c) for c in start]), "sleep", 0.1, "mousedown", 1)
    followed = 0
    for k in range(1, 6):
        session.xdotool("mousemove", *session.screen([round(a + (b - a) * k / 5) for a, b in zip(start, goal)]))
        session.settle()
        followed += session.value("bytes_of(quads())") != before
    session.shot("draw-ball")
    session.xdotool("key", "Escape", "mouseup", 1)
    session.settle()
    fine = followed > 2 and session.value("bytes_of(quads())") == before and session.drawn() is None
    print(f"ball: {followed} previews of 5, as before after Escape: {'fine' if fine else 'BAD'}", flush=True)
    return not fine


def check_merge(session, chance, count):
    """Balls that are dropped on others; Output Messages does not open over the view."""
    bad = try_tool(session, "Merge", chance, 3 * count)
    found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", MESSAGES], capture_output=True,
                           env=dict(os.environ, DISPLAY=session.display), check=False).stdout.split()
    print(f"Output Messages after moves: {len(found)} windows: {'BAD' if found else 'fine'}", flush=True)
    return bad + bool(found)


def check_number(session):
    """A number that is typed counts; the shape says how many where the field is empty."""
    before = session.value("quads().NumberOfQuads")
    counts = []
    for number in (700, 0):
        session.set_number(number)
        counts.append(session.value("output(0).GetNumberOfCells()"))
    session.shot("draw-number")
    session.ask(f"set_quietly('NumberOfQuads', {before}); simple.Render(view)")
    session.settle()
    print(f"with 700 typed {counts[0]} quads, with an empty field {counts[1]}")
    return not (abs(counts[0] - 700) < 100 and counts[1] > 4500)


def make_busy(session):
    """No constraints, and so many quads that those of an edit are not there at once."""
    session.ask(f"clear(); quads().NumberOfQuads = {BUSY}; simple.Render(view)", seconds=120)
    session.look(270, 20)


def check_stop(session, chance):
    """Escape while quads are made stops them and takes the action back; so does a newer one, which is made."""
    bad = 0
    for way in ("Escape", "another one"):
        make_busy(session)
        before = session.value("bytes_of(quads())")
        session.take("Valence")
        pixels = [p[0] for p in session.places(chance, 2)]
        session.xdotool("mousemove", *session.screen(pixels[0]), "sleep", 0.2, "click", 1, "sleep", 0.2)
        if way == "Escape":
            session.xdotool("key", "Escape")
        else:
            session.press(pixels[1])
        session.settle()
        count = len(session.value("constraints()"))
        fine = (count == 0 and session.value("bytes_of(quads())") == before) if way == "Escape" else count == 2
        session.xdotool("key", "Escape")
        print(f"quads that are being made and {way}: {count} constraints: {'fine' if fine else 'BAD'}", flush=True)
        bad += not fine
    return bad


def check_pictures(session, chance):
    """What begins quads draws no picture, which would be the one that there is; ParaView selects quads meanwhile."""
    session.ask("clear()")
    session.look(270, 20)
    session.take("Valence")
    places = [session.screen(p[0]) for p in session.places(chance, 3)]
    session.xdotool("mousemove", *places[1], "sleep", 0.2, "click", 1)
    session.settle()  # with the first constraint ParaView moves rows of its pipeline, and draws the view for that
    session.ask(f"simple.ClearSelection(quads()); quads().NumberOfQuads = {BUSY}; simple.Render(view)", seconds=120)
    x, y = places[2]  # not one of other checks, which are remembered
    session.xdotool("mousemove", x, y, "sleep", 0.2, "mousedown", 1)
    session.ask("watched = watch_pictures()")
    session.xdotool("mouseup", 1)
    drawn, underway = session.value("(ignore_pictures(watched), not is_made())")
    session.take("Valence")  # leaves it
    session.xdotool("mousemove", x - 20, y - 20, "key", "s", "sleep", 0.1, "mousedown", 1, "sleep", 0.1, "mousemove",
                    x + 20, y + 20, "sleep", 0.1, "mouseup", 1)
    selected, meanwhile = session.value("(quads().SMProxy.GetSelectionInput(0) is not None, not is_made())")
    session.settle()
    session.ask("simple.ClearSelection(quads())")
    print(f"pictures before quads are made ({underway}): {drawn}, selected meanwhile ({meanwhile}) {selected}",
          flush=True)
    return not (underway and drawn == 0 and meanwhile and selected)


def save_dialogs(session, least, *actions):
    """How many windows Ctrl+S after the actions has opened once the window is idle, or there are so many; closed again.
    """
    session.xdotool(*actions, "key", "ctrl+s")
    session.ask("pass")
    end = time.time() + 30
    while True:
        time.sleep(0.5)
        found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "Save File"], capture_output=True,
                               env=dict(os.environ, DISPLAY=session.display), check=False).stdout.split()
        if len(found) >= least or time.time() > end:
            break
    if found:
        session.xdotool("key", "Escape", "sleep", 0.5)
    return len(found)


def check_save(session, chance):
    """While quads are made those from before cannot be saved by Save Data, also not at once; afterwards the new ones
    can."""
    make_busy(session)
    session.take("Valence")
    place = session.screen(session.places(chance, 1)[0][0])
    meanwhile = save_dialogs(session, 0, "mousemove", *place, "sleep", 0.2, "click", 1)
    underway = not session.value("is_made()")
    session.settle()
    afterwards = save_dialogs(session, 1)
    session.xdotool("key", "Escape")
    print(f"Save Data while quads are made ({underway}): {meanwhile} dialogs, afterwards {afterwards}")
    return not (underway and meanwhile == 0 and afterwards == 1)


def selected_row(session, seconds=20):
    """The upper left corner of the row of the pipeline that is selected; the window may still have to draw it."""
    end = time.time() + seconds
    while time.time() < end:
        rows = session.rows()
        for y in range(200, 420):
            for x in range(30, 280, 4):
                if rows[y][3 * x:3 * x + 3] == SELECTED:
                    return x, y
        time.sleep(0.2)
    return None, None


def check_delete(session, chance):
    """A Quad Remesh stays selected when a constraint is drawn. Deleted while its quads are made it is gone, its surface
    is shown, and one undo brings it back."""
    make_busy(session)
    session.take("Valence")
    place = session.screen(session.places(chance, 2)[1][0])  # not that of the check before, which is remembered
    session.ask("simple.SetActiveSource(quads())")
    session.xdotool("mousemove", *place, "sleep", 0.2, "click", 1)
    session.wait_until("not is_made()")
    x, y = selected_row(session)
    if x is None:
        session.shot("draw-not-selected")
        print("no row of the pipeline is selected after a constraint was drawn")
        return True
    session.xdotool("mousemove", x + 20, y + 8, "click", 1, "sleep", 0.1)  # the upper one, below which is the output
    underway = not session.value("is_made()")
    session.xdotool("key", "Delete", "sleep", 1)
    gone = session.value("quads() is None")
    shown = session.value("[r.Visibility for r in view.Representations if hasattr(r, 'Visibility')]").count(1)
    session.shot("draw-deleted")
    session.xdotool("mousemove", *session.middle(), "key", "ctrl+z", "sleep", 1)
    session.settle()
    back = session.value("quads() is not None and output(0).GetNumberOfCells() > 0")
    session.xdotool("key", "Escape")
    print(f"deleted while quads are made {underway}: gone {gone}, its surface shown {shown}, back by undo {back}")
    return not (underway and gone and shown == 1 and back)


def check_close(session):
    """The window lives on where its view is closed, or its server left, while a tool is on. No questions afterwards."""
    session.ask("clear()")
    session.take("Stroke")
    if session.remote:
        session.xdotool("mousemove", *FILE_MENU, "click", 1, "sleep", 0.5, "key", "d", "sleep", 0.5, "key", "Return")
    else:
        session.xdotool("mousemove", session.size[0] - CLOSE_VIEW[0], CLOSE_VIEW[1], "sleep", 0.2, "click", 1)
    for _ in range(8 if session.remote else 1):  # to leave a server takes seconds on a busy machine
        time.sleep(3)
        grey = [saturation(session, name) for name in TOOLS]
        if max(grey) < 30:
            break
    session.shot("draw-closed")
    lives = session.paraview.poll() is None
    print(f"{'left the server' if session.remote else 'closed the view'} with a tool on: lives {lives}, tools {grey}")
    return not (lives and (max(grey) < 30 or not session.remote))


def ring_pixels(session, pixel):
    """How many pixels in the orange of the rings there are round a pixel of the view."""
    x, y = session.screen([round(c) for c in pixel])
    rows = session.rows()
    return sum(1 for v in range(y - 10, y + 11) for u in range(x - 10, x + 11)
               if rows[v][3 * u] > 230 and 110 < rows[v][3 * u + 1] < 170 and rows[v][3 * u + 2] < 60)


#: Each with a session, random choices and a number of places. The last ones have many quads.
CHECKS = {"escape": lambda s, c, _: check_escape(s, c), "camera": lambda s, c, _: check_camera(s, c),
          "undo": lambda s, c, _: check_undo(s, c), "remove": lambda s, c, _: check_remove(s, c),
          "rows": lambda s, c, _: check_rows(s, c),
          "ball": lambda s, c, _: check_ball(s, c), "merge": check_merge, "handles": check_handles,
          "picks": lambda s, c, n: test_places.check_picks(s, c, 3 * n),
          "strokes": lambda s, c, n: test_places.check_strokes(s, c, 2 * n),
          "selection": lambda s, c, _: test_places.check_selection(s, c),
          "words": lambda s, c, _: check_words(s, c), "labels": lambda s, c, _: check_labels(s),
          "number": lambda s, c, _: check_number(s), "pictures": lambda s, c, _: check_pictures(s, c),
          "stop": lambda s, c, _: check_stop(s, c), "save": lambda s, c, _: check_save(s, c),
          "delete": lambda s, c, _: check_delete(s, c), "close": lambda s, c, _: check_close(s)}


def main():
    parser = argparse.ArgumentParser()
    for program in ("xvfb", "paraview", "pvpython", "openbox"):
        parser.add_argument(program)
    parser.add_argument("--tools", nargs="*", default=TOOLS)
    parser.add_argument("--checks", nargs="*", choices=CHECKS, default=[*CHECKS])
    parser.add_argument("--server", nargs="+", default=())
    parser.add_argument("--places", type=int, default=20)
    parser.add_argument("--size", nargs=2, type=int, default=Session.size, help="of the window")
    parser.add_argument("--quads", type=int, help="fewer show more balls clearly where the surface fills the view")
    parser.add_argument("--seed", type=int, default=35)
    parser.add_argument("--surface", nargs="+", type=pathlib.Path, default=[test_places.SURFACE])
    options = parser.parse_args()
    Session.pvserver, Session.size = options.server, tuple(options.size)
    bad = 0
    for surface in options.surface:
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            session = Session(folder, options)
            session.surface = surface
            try:
                session.start()
                session.open(options.quads)
                session.find_tools()
                for name in options.tools:
                    wrong = try_tool(session, name, random.Random(options.seed), options.places)
                    bad += wrong if wrong > (1 - BAR) * options.places else 0
                for name, check in CHECKS.items():
                    if name in options.checks:
                        bad += check(session, random.Random(options.seed + 1), options.places)
            except BaseException:
                session.shot("draw-failure")
                raise
            finally:
                print((folder / "log").read_text(encoding="utf-8"))
                session.close()
    if bad:
        sys.exit(f"FAILED: {bad} of the checks above")
    print("drawing: fine")


if __name__ == "__main__":
    main()
