# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs traces of ParaView's window, or loads its states, and tells what quads they make: replay_trace.py FILE...

With QUADRILLE_SERVER_PORT in the environment all goes through the server there.
"""
import os
import pathlib
import sys

import quadrille  # the raw classes behind the proxies
import quick_start  # before simple
from paraview import simple

import window_answers

SERVER = os.environ.get("QUADRILLE_SERVER_PORT")

if SERVER:
    simple.Connect("127.0.0.1", int(SERVER))
    simple.LoadPlugin(os.environ["QUADRILLE_PLUGIN"], remote=True)
for path in sys.argv[1:]:
    simple.ResetSession()
    window_answers.fetched.clear()
    names = {}
    simple.LoadPlugin(os.environ["QUADRILLE_PLUGIN"], remote=False, ns=names)
    if path.endswith(".pvsm"):
        simple.LoadState(path)
    else:
        exec(compile(pathlib.Path(path).read_text(encoding="utf-8"), path, "exec"), names)
    quads = simple.FindSource("QuadRemesh1")
    quads.UpdatePipeline()
    print("replayed", path, *window_answers.bytes_of(quads), len([c for c in quads.Constraints if c]), flush=True)
