# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs traces of ParaView's window, or loads its states, and tells what quads they make: replay_trace.py FILE..."""
import os
import pathlib
import sys

import quadrille  # the raw classes behind the proxies
from paraview import simple

import window_answers

for path in sys.argv[1:]:
    simple.ResetSession()
    names = {}
    simple.LoadPlugin(os.environ["QUADRILLE_PLUGIN"], remote=False, ns=names)
    if path.endswith(".pvsm"):
        simple.LoadState(path)
    else:
        exec(compile(pathlib.Path(path).read_text(encoding="utf-8"), path, "exec"), names)
    quads = simple.FindSource("QuadRemesh1")
    quads.UpdatePipeline()
    print("replayed", path, *window_answers.bytes_of(quads), len(quads.Constraints))
