# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws a constraint of each class in ParaView's real window, by mouse and keyboard, and counts the actions.

  count_actions.py XVFB PARAVIEW OPENBOX [TASK...]

A click, a key, a drag and a typed value are one action each. Each task begins with quads that are selected in the
pipeline; afterwards the table of constraints must say that what was asked for is met. Screenshots are left in the
folder QUADRILLE_ARTIFACTS. What is there and where on the screen is asked of the window by a script that runs in it;
asking is no action. No test of ctest, as it takes more than a minute of a window of its own; needs Debian's xdotool.
"""
import ast
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import private_display
import test_gui

ARTIFACTS = pathlib.Path(os.environ["QUADRILLE_ARTIFACTS"])
WIDTH, HEIGHT = 1920, 1080
MOST = {"stroke": 8, "valence": 7, "move": 6, "connection": 6, "loop": 9, "undo": 1, "mirror": 4, "follow": 5}


def environment_of(window):
    """Of ParaView and what runs beside it: settings of their own, the plugin, and window_answers.py."""
    folder = str(window.folder)
    modules = os.pathsep.join([str(pathlib.Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    return dict(os.environ, DISPLAY=window.display, QUADRILLE_QUESTION=str(window.question), HOME=folder,
                XDG_CONFIG_HOME=folder, XDG_RUNTIME_DIR=folder, PYTHONPATH=modules,
                PV_PLUGIN_PATH=os.path.dirname(os.environ["QUADRILLE_PLUGIN"]))


class Window:
    """The window, as a user's eyes and hands have it."""

    def __init__(self, folder, display):
        self.folder, self.display = folder, display
        self.question = folder / "question"
        self.actions = []
        self.origin = (0, 0)
        self.touched = False  # by mouse or keyboard, since it was asked

    def xdotool(self, *words):
        self.touched = True
        subprocess.run(["xdotool", *[str(w) for w in words]], env=dict(os.environ, DISPLAY=self.display), check=True)

    def resize(self, width, height, seconds=60):
        """xdotool looks at all windows, and ends with an error where one goes meanwhile, as the splash screen does."""
        end = time.time() + seconds
        while True:
            try:
                self.xdotool("search", "--sync", "--onlyvisible", "--name", "ParaView", "windowmove", 0, 0,
                             "windowsize", width, height)
                return
            except subprocess.CalledProcessError:
                if time.time() > end:
                    raise
                time.sleep(0.5)

    def ask(self, code, seconds=60):
        """What the code prints in the window; it is idle then."""
        if self.touched:
            time.sleep(0.15)  # the window manager hands on what was done before
            self.touched = False
        part = self.folder / "question.part"
        part.write_text(code, encoding="utf-8")
        part.rename(self.question)
        answer = self.folder / "question.answer"
        end = time.time() + seconds
        while not answer.exists():
            if time.time() > end:
                raise SystemExit("FAILED: the window does not answer")
            time.sleep(0.005)
        text = answer.read_text(encoding="utf-8")
        answer.unlink()
        if text.startswith("FAILED"):
            raise SystemExit(text)
        return text.strip()

    def value(self, expression):
        return ast.literal_eval(self.ask(f"print(repr({expression}))"))

    def wait_until(self, expression, seconds=30):
        """Other programs may have the processors."""
        end = time.time() + seconds
        while not self.value(expression):
            if time.time() > end:
                raise SystemExit(f"FAILED: in vain it was waited for {expression}")

    def rows(self):
        return test_gui.read_xwd(self.folder / "Xvfb_screen0")

    def screenshot(self, name):
        time.sleep(0.5)
        test_gui.write_png(ARTIFACTS / f"actions-{name}.png", self.rows())

    def act(self, what):
        self.actions.append(what)

    # Actions.
    def click(self, place, what):
        self.act("click " + what)
        self.xdotool("mousemove", *place, "sleep", 0.1, "click", 1)
        self.ask("pass")

    def key(self, key, place=None, what=""):
        self.act(f"key {key}" + (" " + what if what else ""))
        if place:
            self.xdotool("mousemove", *place, "sleep", 0.15)
        self.xdotool("key", key)
        self.ask("pass")

    def scroll(self, place, what):
        self.act("scroll " + what)
        self.xdotool("mousemove", *place, "sleep", 0.1, "click", "--repeat", 2, "--delay", 30, 5)
        self.ask("pass")

    def turn_round(self):
        """Half the width of the view is half a turn."""
        self.act("drag the view round")
        width = self.value("view.ViewSize[0]")
        x, y = self.origin[0] + width // 4, self.origin[1] - 40
        self.xdotool("mousemove", x, y, "sleep", 0.1, "mousedown", 1)
        for k in range(1, 9):
            self.xdotool("mousemove", x + k * width // 16, y, "sleep", 0.05)
        self.xdotool("mouseup", 1)
        self.ask("pass")

    def type(self, text, what):
        self.act(f"type {text} {what}")
        self.xdotool("type", text)
        self.ask("pass")

    def new(self, name):
        """A source or filter, from the list that Ctrl+Space opens."""
        self.act("key ctrl+space")
        self.xdotool("mousemove", self.origin[0] + 400, self.origin[1] - 300, "key", "ctrl+space", "sleep", 0.7)
        self.act(f"type {name}")
        self.xdotool("type", "--delay", 20, name)
        self.act("key Return")
        self.xdotool("sleep", 0.7, "key", "Return", "sleep", 0.5)
        wanted = name.replace(" ", "")
        self.wait_until(f"simple.GetActiveSource().GetXMLName() == {wanted!r}")
        time.sleep(0.5)

    def apply(self):
        self.key("alt+a", what="(Apply)")
        self.ask("pass")

    # Where things are.
    def on_screen(self, place):
        x, y = self.value(f"tuple(display({tuple(place)!r}))")
        return round(self.origin[0] + x), round(self.origin[1] - y)

    def find_origin(self):
        """The lower left corner of the view: by where the view says the mouse is."""
        place = (WIDTH // 2, HEIGHT // 2)
        self.xdotool("mousemove", place[0] - 5, place[1], "sleep", 0.2, "mousemove", *place, "sleep", 0.2)
        x, y = self.value("tuple(interactor.GetEventPosition())")
        self.origin = (place[0] - x, place[1] + y)

    def find_by_change(self, first, second):
        """The right end of what looks different in the panel after the second of two pieces of code."""
        self.ask(first)
        time.sleep(0.7)
        before = self.rows()
        self.ask(second)
        time.sleep(0.7)
        after = self.rows()
        self.ask(first)
        panel = WIDTH // 6 - 60  # without its scroll bar
        changed = [(x, y) for y in range(HEIGHT // 3, HEIGHT) if before[y][:3 * panel] != after[y][:3 * panel]
                   for x in range(panel) if before[y][3 * x:3 * x + 3] != after[y][3 * x:3 * x + 3]]
        if not changed:
            raise SystemExit("FAILED: nothing in the panel shows the change of " + second)
        top = min(y for _, y in changed)
        changed = [(x, y) for x, y in changed if y < top + 25]
        return max(x for x, _ in changed) - 2, top + 5

    def body(self, x, z):
        """A place on the flank of the animal, towards the eye."""
        return self.on_screen((x, -0.45, z))


def met(window, kind):
    rows = window.value("rows()")
    found = [row for row in rows if row[0] == kind]
    if len(found) != 1 or found[0][1] != "1":
        raise SystemExit(f"FAILED: the table of constraints has {rows}")
    return found[0]


def stroke(window):
    places = [window.body(*p) for p in ((-0.5, 0.4), (-0.2, 0.25), (0.1, 0.1), (0.4, -0.02))]
    window.new("Quad Stroke")
    window.key("1", places[0])
    for place in places[1:]:
        window.key("2", place)
    window.apply()
    return met(window, "guide stroke")


def valence(window):
    window.new("Quad Valence")
    field = window.find_by_change("v = simple.GetActiveSource(); v.Valence = 3", "v.Valence = 8")
    window.key("p", window.body(-0.2, 0.1))
    window.act("double click the field Valence")
    window.xdotool("mousemove", *field, "click", "--repeat", 2, "--delay", 80, 1)
    window.type("5", "into Valence")
    window.apply()
    if window.value("simple.GetActiveSource().Valence") != 5:
        raise SystemExit("FAILED: the typed valence did not come in")
    return met(window, "valence")


def visible(window):
    """Irregular vertices towards the eye, with their places on the screen."""
    return [(p, v, window.on_screen(p)) for p, v in window.value("[x for x in irregular() if is_visible(x[0])]")]


def can_be_met(window, constraint):
    """Tries a constraint by the window's script; no action."""
    window.ask(f"trial = {constraint}; quads.Constraints = [trial]; quads.UpdatePipeline()")
    rows = window.value("rows()")
    window.ask("clear()")
    return bool(rows) and rows[0][1] == "1"


def move(window):
    """The first one that can be moved up by two edge lengths, by trials that are no actions."""
    for place, _, pixels in visible(window):
        target = (place[0], place[1], place[2] + 0.12)
        if can_be_met(window, f"QuadMove(From={list(place)}, To={list(target)})"):
            break
    else:
        raise SystemExit("FAILED: no irregular vertex can be moved")
    window.new("Quad Move")
    window.key("2", window.on_screen(target))
    window.key("1", pixels)
    window.apply()
    return met(window, "move")


def connection(window):
    found = visible(window)
    pairs = sorted(((sum((a - b) ** 2 for a, b in zip(p[0], q[0])), p, q) for i, p in enumerate(found)
                    for q in found[:i]), key=lambda pair: pair[0])
    for _, p, q in pairs:
        if can_be_met(window, f"QuadConnection(Points={list(p[0]) + list(q[0])})"):
            break
    else:
        raise SystemExit("FAILED: no two irregular vertices can be connected")
    window.new("Quad Connection")
    window.key("1", p[2])
    window.key("2", q[2])
    window.apply()
    return met(window, "connection")


def loop(window):
    """Round the body: two places on this side, two on the other."""
    high, low = 0.35, -0.1
    window.new("Quad Loop")
    window.key("1", window.on_screen((0, -0.35, high)))
    window.key("2", window.on_screen((0, -0.37, low)))
    window.turn_round()
    for z in (low, high):
        window.key("2", window.on_screen((0, 0.36, z)))
    window.apply()
    return met(window, "cycle")


def undo(window):
    before = window.value("fingerprint()")
    window.new("Quad Valence")
    window.key("p", window.body(-0.2, 0.1))
    window.apply()
    if window.value("fingerprint()") == before:
        raise SystemExit("FAILED: the valence changes nothing")
    window.actions.clear()
    window.key("ctrl+z")
    if window.value("fingerprint()") != before:
        raise SystemExit("FAILED: the undo did not bring the quads back")
    return ("undo", "1", "0", "")


def mirror(window):
    """The plane is where it is at first: through the middle, with the normal along x; it could be dragged."""
    window.ask("quads.SymmetryNormal = [0, 1, 0]")
    window.scroll((150, 900), "the panel")
    x, y = window.find_by_change("quads.Symmetry = 'None'", "quads.Symmetry = 'Found'")
    window.click((x, y), "the list Symmetry")
    window.click((x, y + 22), "Plane in it")
    window.apply()
    if not window.value("quads.Symmetry == 'Plane'"):
        raise SystemExit("FAILED: the list gave " + window.ask("print(repr(quads.Symmetry), rows())"))
    return met(window, "symmetry")


def follow(window):
    """No task of a bar: with Auto Apply on the quads follow a handle while it is dragged."""
    window.ask("set_auto_apply(True)")
    window.new("Quad Valence")
    x, y = window.body(-0.2, 0.1)
    seen = [window.value("fingerprint()")]
    window.key("p", (x, y))
    window.wait_until(f"fingerprint() != {seen[-1]!r}")
    x, y = window.on_screen(window.value("tuple(simple.GetActiveSource().Point)"))
    seen = [window.value("fingerprint()")]
    window.act("drag the handle")
    window.xdotool("mousemove", x, y, "sleep", 0.1, "mousedown", 1, "sleep", 0.1)
    for k in range(1, 4):
        window.xdotool("mousemove", x + 25 * k, y - 15 * k)
        window.wait_until(f"fingerprint() != {seen[-1]!r}")
        seen.append(window.value("fingerprint()"))
    previews = window.value("previews")
    window.xdotool("mouseup", 1)
    window.wait_until("not quads.GetClientSideObject().GetPreview() and rows()[0][1] == '1'")
    window.ask("set_auto_apply(False)")
    if len(set(seen)) != len(seen) or previews == 0:
        raise SystemExit(f"FAILED: under the dragged handle there were {len(set(seen))} meshes, {previews} previews")
    return met(window, "valence")


TASKS = {"stroke": stroke, "valence": valence, "move": move, "connection": connection, "loop": loop, "undo": undo,
         "mirror": mirror, "follow": follow}


def run(window, tasks):
    window.ask("print(quads.GetDataInformation().GetNumberOfCells())", seconds=120)
    window.find_origin()
    bad = []
    for name in tasks:
        start = time.time()
        window.ask("clear()")
        window.actions.clear()
        state = TASKS[name](window)
        actions = list(window.actions)
        window.ask("show_constraints()")
        window.screenshot(name)
        print(f"{name}: {len(actions)} actions, at most {MOST[name]} ({', '.join(actions)}); met, deviation "
              f"{state[2]}; {time.time() - start:.1f} s", flush=True)
        if len(actions) > MOST[name]:
            bad.append(name)
    return bad


def main():
    xvfb, paraview, openbox = sys.argv[1:4]
    tasks = sys.argv[4:] or list(TASKS)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        server, display = private_display.start(xvfb, "-screen", "0", f"{WIDTH}x{HEIGHT}x24", "-fbdir", str(folder))
        window = Window(folder, display)
        environment = environment_of(window)
        manager = subprocess.Popen([openbox], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        script = pathlib.Path(__file__).with_name("actions_script.py")
        with open(folder / "log", "w", encoding="utf-8") as output:
            process = subprocess.Popen([paraview, "--dr", f"--script={script}"], env=environment, stdout=output,
                                       stderr=subprocess.STDOUT)
        try:
            window.ask("pass", seconds=120)
            window.resize(WIDTH, HEIGHT - 40)
            time.sleep(2)
            bad = run(window, tasks)
        except BaseException:
            window.screenshot("failure")
            raise
        finally:
            for started in (process, manager, server):
                private_display.stop(started)
            print((folder / "log").read_text(encoding="utf-8"))
    if bad:
        sys.exit("FAILED: too many actions for " + ", ".join(bad))


if __name__ == "__main__":
    main()
