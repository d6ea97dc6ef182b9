#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The walk from a STEP file to a solved shell, at small sizes, and the deck on its page.

  test_cad_walk.py QUADRILLE SCRIPTS DOCUMENTATION
"""
import pathlib
import sys
import tempfile
import unittest

import numpy as np

PROGRAM, SCRIPTS, DOCUMENTATION = (pathlib.Path(sys.argv.pop(1)).resolve() for _ in range(3))
sys.path.insert(0, str(SCRIPTS))
import cad_walk  # noqa: E402

NEAR = 1e-9  # mm; nodes lie on the exact shape


class Walk(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            cls.coarse, cls.fine = (cad_walk.Solved(PROGRAM, pathlib.Path(folder), quads) for quads in (200, 800))

    def test_node_sets_of_faces_are_the_nodes_on_them(self):
        for solved in (self.coarse, self.fine):
            points, sets = solved.mesh.points, solved.mesh.node_sets
            np.testing.assert_array_equal(sets["SUPPORT"], np.flatnonzero(abs(points[:, 0]) < NEAR))
            away = abs(np.hypot(points[:, 0] - 2, points[:, 1] - 1.5) - 0.5)
            np.testing.assert_array_equal(sets["BORE"], np.flatnonzero(away < NEAR))

    def test_the_held_face_stays_and_the_loaded_one_moves(self):
        for solved in (self.coarse, self.fine):
            self.assertLess(abs(solved.displacements[solved.mesh.node_sets["SUPPORT"]]).max(), NEAR * solved.largest())
            self.assertLess(solved.displacements[solved.mesh.node_sets["BORE"], 2].max(), 0)

    def test_sizes_agree(self):
        # The coarser shell is stiffer, by 7.8 %; with 1,000 and 4,000 quads it is 2.4 %.
        self.assertAlmostEqual(self.fine.largest() / self.coarse.largest(), 1.05, delta=0.05)

    def test_the_page_has_the_deck(self):
        page = (DOCUMENTATION / "Guide" / "Cad.md").read_text(encoding="utf-8")
        for part in cad_walk.DECK.format(mesh="bracket.inp", thickness=cad_walk.THICKNESS, force=0).split("BORE, 3, 0"):
            self.assertIn(part, page)


if __name__ == "__main__":
    unittest.main()
