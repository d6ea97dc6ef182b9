# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Random sessions with the drawing tools in ParaView's real window, replayed elsewhere: same bytes.

  random_sessions.py XVFB PARAVIEW PVPYTHON PVBATCH PVSERVER MPIEXEC OPENBOX [--sessions N] [--edits N] [--seed N]
                     [--surface FILE]

A session: a surface is opened, quads are made with *Rank Independent* on, and random tools draw at random visible
places, with *Remove Last* and undo among them, all recorded. Its trace and the state that is saved at last are run in
pvpython, in pvbatch, in pvbatch on two ranks, and in pvpython through a server. What has other bytes is told with BAD.
All random choices come from the seed. No test of ctest, as it takes minutes; needs Debian's openbox and xdotool.
"""
import argparse
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time

import count_actions
import private_display
import test_draw
import test_places

EDITS = ("Stroke", "Valence", "Move", "Connect", "Loop", "Feature", "Size")


def edit(session, chance):
    """One random edit, its name and what the table says of it."""
    kind = chance.choice((*EDITS, "Remove", "Undo")) if session.value("len(constraints())") else chance.choice(EDITS)
    if kind == "Undo":
        session.xdotool("mousemove", *session.middle(), "key", "ctrl+z", "sleep", 1)
    elif kind == "Remove":
        session.xdotool("mousemove", *session.remove, "sleep", 0.2, "click", 1, "sleep", 0.5)
    else:
        test_places.random_view(session, chance)
        session.take(kind)
        session.ask("global balls_before; balls_before = [output(4).GetPoint(i) for i in "
                    "range(output(4).GetNumberOfPoints())]")
        outcome = test_draw.ACTIONS[kind](session, chance)
        session.xdotool("key", "Escape")
        session.settle()
        return f"{kind} {outcome.met}"
    session.settle()
    return kind


def session_of(folder, programs, number, options):
    """A session of its own: trace and state, and what the quads are."""
    chance = random.Random(f"{options.seed} {number}")
    session = test_draw.Session(folder, programs)
    session.surface = options.surface
    try:
        session.start()
        session.ask("smtrace.start_trace()")
        session.open(more="quads().RankIndependent = 'Always'")
        session.find_tools()
        rows = session.rows()
        session.remove = max((x for x in range(300, 900) if rows[163][3 * x:3 * x + 3] != rows[163][3:6]), default=0), 163
        words = [edit(session, chance) for _ in range(options.edits)]
        made = *session.value("bytes_of(quads())"), len(session.value("constraints()"))
        trace, state = folder / "trace.py", folder / "state.pvsm"
        trace.write_text(session.value("smtrace.stop_trace()"), encoding="utf-8")
        session.ask(f"simple.SaveState({str(state)!r})")
        print(f"session {number}: {', '.join(words)}; made {made}", flush=True)
        return trace, state, made, count_actions.environment_of(session)
    except BaseException:
        session.shot(f"sessions-failure-{number}")
        print((folder / "log").read_text(encoding="utf-8")[-3000:])
        raise
    finally:
        session.close()


def replay(path, command, programs, environment):
    server, display = private_display.start(programs.xvfb, "-screen", "0", "1280x1024x24")
    try:
        done = subprocess.run([*command, str(pathlib.Path(__file__).with_name("replay_trace.py")), str(path)],
                              env=dict(environment, DISPLAY=display), capture_output=True, text=True, timeout=600)
    finally:
        private_display.stop(server)
    for line in done.stdout.splitlines():
        if line.startswith("replayed"):
            digest, cells, connected = line.split()[2:]
            return digest, int(cells), int(connected)
    return "no quads", done.returncode, (done.stdout + done.stderr)[-1500:]


def through_server(path, programs, environment, port):
    server, display = private_display.start(programs.xvfb, "-screen", "0", "1280x1024x24")
    process = subprocess.Popen([programs.pvserver, f"--server-port={port}"], env=dict(environment, DISPLAY=display),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        time.sleep(3)
        return replay(path, [programs.pvpython], programs, dict(environment, QUADRILLE_SERVER_PORT=str(port)))
    finally:
        private_display.stop(process)
        private_display.stop(server)


def main():
    parser = argparse.ArgumentParser()
    for program in ("xvfb", "paraview", "pvpython", "pvbatch", "pvserver", "mpiexec", "openbox"):
        parser.add_argument(program)
    for what, count in (("sessions", 20), ("edits", 15), ("seed", 1), ("port", 11735)):
        parser.add_argument("--" + what, type=int, default=count)
    parser.add_argument("--surface", type=pathlib.Path, default=test_places.SURFACE)
    options = parser.parse_args()
    bad = 0
    for number in range(options.sessions):
        with tempfile.TemporaryDirectory() as folder:
            trace, state, made, environment = session_of(pathlib.Path(folder), options, number, options)
            ranks = [options.mpiexec, "-np", "2", options.pvbatch, "--mpi"]
            for path in (trace, state):
                for what, again in (("pvpython", replay(path, [options.pvpython], options, environment)),
                                    ("pvbatch", replay(path, [options.pvbatch], options, environment)),
                                    ("two ranks", replay(path, ranks, options, environment)),
                                    ("server", through_server(path, options, environment, options.port + number))):
                    print(f"  {path.name}, {what}: {'same' if again == made else f'BAD {again}'}", flush=True)
                    bad += again != made
                if bad:
                    print(trace.read_text(encoding="utf-8"))
    if bad:
        sys.exit(f"FAILED: {bad} replays")
    print("sessions: fine")


if __name__ == "__main__":
    main()
