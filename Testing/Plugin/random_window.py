# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Random sessions with the drawing tools in ParaView's real window, replayed elsewhere: same bytes.

  random_window.py XVFB PARAVIEW PVPYTHON PVBATCH PVSERVER MPIEXEC OPENBOX [--sessions N] [--edits N] [--seed N]
                   [--first N] [--surface FILE...] [--kinds KIND...]

A session: a surface is opened, quads are made by the first button of the tool bar, and random tools draw at random
visible places, with *Remove*, dragged points, sources of constraints made by keyboard, undo, redo and another
*Number Of Quads* among them and an undo at last, all recorded. --kinds says what is done in place of random edits. Its
trace, and the state saved at last as .pvsm and as .py, are run in pvpython, in pvbatch on two ranks, and in pvpython
through a server. What has other bytes, or other constraints, is told with BAD. *Rank Independent* is *Always* by
defaults that this window has and the replays have not: a surface in one piece keeps its own order else, and ranks have
another one. All random choices come from the seed. ctest runs one short session; needs Debian's openbox and xdotool.
"""
import argparse
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

import count_actions
import paraview_server
import private_display
import test_draw
import test_places

DRAWN = ("Stroke", "Valence", "Move", "Connect", "Loop", "Feature", "Size", "Clear")
BUTTONS = ("Remove", "Undo", "Redo", "Number", "Drag", "Source")
DEFAULTS = {"filters": {"QuadRemesh": {"RankIndependent": 1}}}  # as a user saves them by the panel's button
NUMBERS = (0, 1500, 3000, 4000, 6000)  # of quads; 0: the shape says how many
SOURCES = {"Quad Stroke": 3, "Quad Valence": 1, "Quad Move": 2, "Quad Feature Curve": 3}  # and their points


class Session(test_draw.Session):
    """With what the panel and the stack of undos have."""

    def steps(self):
        """How many can be undone and redone."""
        return self.value("steps()")

    def drag_point(self, chance):
        """A point of the last constraint, by its ring; whether it is seen, and moves."""
        self.ask("simple.SetActiveSource(list(quads().Constraints)[-1])")
        before = self.value("constraints()[-1]")
        for _ in range(10):
            test_places.random_view(self, chance)
            found = self.value("point_seen()")
            places = self.places(chance, 1)
            if found and math.dist(found, places[0][0]) > 20:
                self.drag([found, *[p[0] for p in places]])
                break
        self.ask("simple.SetActiveSource(quads())")
        return self.value("constraints()[-1]") != before

    def put_source(self, chance):
        """A constraint by keyboard, as the guide has it without tools."""
        name = chance.choice(list(SOURCES))
        test_places.random_view(self, chance)
        self.put(name, self.places(chance, SOURCES[name]))
        self.ask("simple.SetActiveSource(quads())")
        return name


def edit(session, chance, first, kind=None):
    """One edit, a random one unless told, in words; None where there is no place for it. first: steps that are none."""
    kind = kind or chance.choice((*DRAWN, *DRAWN, *BUTTONS))
    undone, redone = session.steps()
    if (kind == "Undo" and undone <= first) or (kind == "Redo" and redone == 0) or \
            (kind in ("Remove", "Drag") and not session.value("len(constraints())")):
        return None
    if kind in ("Undo", "Redo"):
        session.xdotool("mousemove", *session.middle(), "key", "ctrl+z" if kind == "Undo" else "ctrl+y")
    elif kind == "Remove":
        session.xdotool("mousemove", *session.remove, "sleep", 0.2, "click", 1)
    elif kind == "Drag":
        kind = kind if session.drag_point(chance) else None
    elif kind == "Source":
        kind = session.put_source(chance)
    elif kind == "Number":
        session.set_number(chance.choice([n for n in NUMBERS if n != session.value("quads().NumberOfQuads")]))
    else:
        return draw(session, kind, chance)
    session.settle()
    return kind


def draw(session, kind, chance):
    if kind == "Clear" and not session.value("len(features())"):
        return None
    test_places.random_view(session, chance)
    session.edge = session.value("edge_length()")
    session.ask("global balls_before; balls_before = [output(4).GetPoint(i) for i in "
                "range(output(4).GetNumberOfPoints())]")
    session.take(test_draw.BUTTONS.get(kind, kind))
    outcome = test_draw.ACTIONS[kind](session, chance)
    session.xdotool("key", "Escape")
    session.settle()
    return f"{kind} {outcome.met}"


def edit_where_seen(session, *how):
    """As edit(); None, too, where no place for it is clearly seen."""
    try:
        return edit(session, *how)
    except SystemExit as nowhere:
        if "hardly" not in str(nowhere):
            raise
        session.xdotool("key", "Escape")
        session.settle()
        return None


def session_of(folder, options, number):
    """A session of its own: the files with trace and states, and what the quads are."""
    chance = random.Random(f"{options.seed} {number}")
    session = Session(folder, options)
    session.surface = options.surface[number % len(options.surface)]
    try:
        session.start()
        session.ask(f"set_defaults({json.dumps(DEFAULTS)!r}); smtrace.start_trace()")
        session.open_surface()
        session.find_tools()
        if test_draw.check_bar(session):
            raise SystemExit("FAILED: the tool bar, see above")
        begun, first = session.value("bytes_of(quads())"), session.steps()[0]
        words = []
        wanted = len(options.kinds) or options.edits
        for kind in options.kinds or [None] * 10 * options.edits:
            if len(words) < wanted:
                word = edit_where_seen(session, chance, first, kind)
                words += [word] if word else []
        # Each edit writes all constraints into a trace, so only what comes last shows whether an undo is in it.
        words.append(edit(session, chance, first, "Undo"))
        made = *session.value("bytes_of(quads())"), len(session.value("constraints()"))
        print(f"session {number}, {session.surface.name}: {', '.join(words)}; made {made}", flush=True)
        if len(words) < wanted + 1 or (made[:2] == begun and made[2] > 0):
            raise SystemExit("FAILED: there were too few edits, or they changed nothing")
        paths = [folder / name for name in ("trace.py", "state.pvsm", "state.py")]
        paths[0].write_text(session.value("smtrace.stop_trace()"), encoding="utf-8")
        session.ask(f"simple.SaveState({str(paths[1])!r})")
        paths[2].write_text(session.value("smstate.get_state()"), encoding="utf-8")
        return paths, made
    except BaseException:
        session.shot(f"random-failure-{number}")
        raise
    finally:
        print((folder / "log").read_text(encoding="utf-8")[-3000:])
        session.close()


def replays(paths, command, options, server=False):
    """What each file makes in a program, by path; with folders of its own, so that no setting of the window counts."""
    with tempfile.TemporaryDirectory() as folder:
        display_server, display = private_display.start(options.xvfb, "-screen", "0", "1280x1024x24")
        window = count_actions.Window(pathlib.Path(folder), display)
        environment = count_actions.environment_of(window)
        remote = None
        if server:
            # What PV_PLUGIN_PATH has loaded there ParaView cannot load once more (5.11).
            remote = paraview_server.Server([options.pvserver], dict(environment, PV_PLUGIN_PATH=""))
            environment["QUADRILLE_SERVER_PORT"] = str(remote.port)
        try:
            script = pathlib.Path(__file__).with_name("replay_trace.py")
            done = subprocess.run([*command, str(script), *map(str, paths)], env=environment, capture_output=True,
                                  text=True, timeout=900)
        finally:
            if remote:
                remote.stop()
            private_display.stop(display_server)
    found = {}
    for line in done.stdout.splitlines():
        if line.startswith("replayed"):
            path, digest, cells, connected = line.split()[1:]
            found[pathlib.Path(path)] = digest, int(cells), int(connected)
    if len(found) < len(paths):
        print((done.stdout + done.stderr)[-3000:])
    return found


def check(paths, made, options):
    """How many replays differ."""
    ranks = [options.mpiexec, "-np", "2", options.pvbatch, "--mpi"]
    bad = 0
    for what, found in (("pvpython", replays(paths, [options.pvpython], options)),
                        ("two ranks", replays(paths, ranks, options)),
                        ("server", replays(paths, [options.pvpython], options, server=True))):
        for path in paths:
            again = found.get(path, "no quads")
            print(f"  {path.name}, {what}: {'same' if again == made else f'BAD {again}'}", flush=True)
            bad += again != made
    return bad


def main():
    parser = argparse.ArgumentParser()
    for program in ("xvfb", "paraview", "pvpython", "pvbatch", "pvserver", "mpiexec", "openbox"):
        parser.add_argument(program)
    for what, count in (("sessions", 20), ("edits", 15), ("seed", 1), ("first", 0)):
        parser.add_argument("--" + what, type=int, default=count)
    data = pathlib.Path(os.environ["QUADRILLE_DATA"])
    parser.add_argument("--surface", nargs="+", type=pathlib.Path, default=[data / "beast.ply", data / "part.ply"])
    parser.add_argument("--kinds", nargs="*", default=(), choices=(*DRAWN, *BUTTONS))
    options = parser.parse_args()
    bad = 0
    for number in range(options.first, options.first + options.sessions):
        begin = time.time()
        with tempfile.TemporaryDirectory() as folder:
            paths, made = session_of(pathlib.Path(folder), options, number)
            drawn = time.time()
            differ = check(paths, made, options)
            if differ:
                for path in paths:
                    shutil.copy(path, count_actions.ARTIFACTS / f"random-{number}-{path.name}")
            bad += differ
        print(f"  {drawn - begin:.0f} s drawn, {time.time() - drawn:.0f} s replayed", flush=True)
    if bad:
        sys.exit(f"FAILED: {bad} replays")
    print("random window: fine")


if __name__ == "__main__":
    main()
