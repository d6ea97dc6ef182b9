# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The drawing tools in ParaView's real window, under openbox at its defaults, by the mouse at random places.

  test_draw.py XVFB PARAVIEW OPENBOX [--tools NAME...] [--places N] [--surface FILE...] [--seed N]

Opens each surface and makes quads by keyboard. With each tool so many random places, or paths, are drawn where the
surface is clearly seen. Then the constraint, and the quads, are compared with the places under the mouse, which rays
from the camera tell: half an edge length of the quads is allowed. What the table of constraints says is compared with
the quads themselves. At last it is tried that Escape leaves the tool, and that one undo takes back one action.
Screenshots are left in the folder QUADRILLE_ARTIFACTS. Needs Debian's openbox and xdotool.
"""
import argparse
import math
import pathlib
import random
import sys
import tempfile
import time

import count_actions
import test_places

ALLOWED = test_places.ALLOWED  # edge lengths
NEAR = test_places.NEAR
BAR = 0.98       # of the places
MET_ANGLE = 5    # degrees in the mean, as the Constraint Table has it for strokes
DOUBT = 2.5      # degrees in which two ways to measure the mean may differ
WIDTH = count_actions.WIDTH
TOOLS = ("Stroke", "Valence", "Feature")  # in their order


class Session(test_places.Session):
    """ParaView under a window manager, with the tools of its tool bar."""

    script = "draw_script.py"

    def start(self):
        super().start()
        self.find_tools()

    def find_tools(self):
        """The buttons of the tool bar, which has a row of its own above the panels: icons with gaps between them."""
        rows = self.rows()
        top, bottom, empty = 152, 174, 3 * (WIDTH - 60)
        icons, start, last = [], None, 0
        for x in range(WIDTH // 2):
            if any(rows[y][3 * x:3 * x + 3] != rows[y][empty:empty + 3] for y in range(top, bottom)):
                start, last = x if start is None else start, x
            elif start is not None and x - last > 3:
                icons.append((start, last))
                start = None
        icons = [(a, b) for a, b in icons if b - a >= 10]
        self.tools = {name: ((a + b) // 2, (top + bottom) // 2) for name, (a, b) in zip(TOOLS, icons)}

    def take(self, name):
        """Presses the button of a tool; pressed again it leaves it."""
        self.xdotool("mousemove", *self.tools[name], "sleep", 0.2, "click", 1, "sleep", 0.2)
        self.ask("pass")

    def drag(self, pixels):
        """With the left button, through pixels of the view."""
        x, y = self.screen(pixels[0])
        words = ["mousemove", x, y, "sleep", 0.1, "mousedown", 1, "sleep", 0.05]
        for pixel in pixels[1:]:
            words += ["mousemove", *self.screen(pixel), "sleep", 0.01]
        self.xdotool(*words, "sleep", 0.05, "mouseup", 1)
        self.ask("pass", seconds=180)
        self.ask("pass", seconds=180)
