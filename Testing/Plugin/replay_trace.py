# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs traces of ParaView's window, or loads its states, and tells what quads they make: replay_trace.py FILE...

With QUADRILLE_SERVER_PORT in the environment all goes through the server there.
"""
import os
import pathlib
import sys

import quadrille  # the raw classes behind the proxies
from paraview import servermanager, simple

import window_answers

SERVER = os.environ.get("QUADRILLE_SERVER_PORT")

for path in sys.argv[1:]:
    simple.ResetSession()
    names = {}
    if SERVER:
        simple.Connect("localhost", int(SERVER))
        simple.LoadPlugin(os.environ["QUADRILLE_PLUGIN"], remote=True)
    simple.LoadPlugin(os.environ["QUADRILLE_PLUGIN"], remote=False, ns=names)
    if path.endswith(".pvsm"):
        simple.LoadState(path)
    else:
        exec(compile(pathlib.Path(path).read_text(encoding="utf-8"), path, "exec"), names)
    quads = simple.FindSource("QuadRemesh1")
    quads.UpdatePipeline()
    data = servermanager.Fetch(quads) if SERVER else quads.GetClientSideObject().GetOutputDataObject(0)
    print("replayed", path, *window_answers.bytes_of_data(data), len(quads.Constraints))
