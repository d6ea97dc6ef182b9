# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Quad Remesh on ParaView's own surfaces: pvpython test_surfaces.py GROUP [--full] [NAME...], see surface_runs.py."""
import sys

# Programmable filters run in this module and put all of numpy's names into it, so what is to last is in another one.
import surface_runs

surface_runs.main(sys.argv[1:])
