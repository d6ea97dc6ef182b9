# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Whether Scripts/check/figures.py tells worse figures from others.

  test_figures.py SCRIPTS DATA
"""
import os
import sys
import unittest
import unittest.mock

import numpy

DATA = sys.argv.pop(2)
sys.path.insert(0, sys.argv.pop(1))
import figures  # noqa: E402  (the folder comes first)
import quadrille  # noqa: E402
from quadrille.evaluation import features, meshes, study  # noqa: E402


def cube(n):
    """A cube of quads, or with `cut` of triangles, n along each edge, with its points joined by place only."""
    quads = []
    for axis in range(3):
        for side in (0, n):
            for i in range(n):
                for k in range(n):
                    corners = [(i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1)]
                    quad = [numpy.roll((side, *corner), axis) for corner in corners]
                    quads.append(quad if side else quad[::-1])
    return numpy.array(quads, dtype=float) / n


def mesh_of(faces):
    points = numpy.concatenate(faces)
    sizes = [len(face) for face in faces]
    return meshes.Mesh(points, numpy.arange(len(points)), numpy.concatenate([[0], numpy.cumsum(sizes)]))


class Figures(unittest.TestCase):
    def test_what_may_not_be_worse_at_all(self):
        for name in ("code", "topology", "folds", "inverted", "attempts"):
            self.assertEqual(figures.worse(name, 1, 2), 1)
            self.assertEqual(figures.worse(name, 1, 0), -1)
            self.assertEqual(figures.worse(name, 1, 1), 0)

    def test_tolerances_hold_on_both_sides(self):
        self.assertEqual(figures.worse("irregular", 100, 107), 0)
        self.assertEqual(figures.worse("irregular", 100, 108), 1)
        self.assertEqual(figures.worse("mean", 0.96, 0.9551), 0)
        self.assertEqual(figures.worse("mean", 0.96, 0.9549), 1)
        self.assertEqual(figures.worse("mean", 0.96, 0.97), -1)
        self.assertEqual(figures.worse("instructions replay", 100, 104), 0)
        self.assertEqual(figures.worse("instructions replay", 100, 106), 1)

    def test_a_figure_that_is_gone_is_worse(self):
        self.assertEqual(figures.worse("mean", 0.96, None), 1)
        self.assertEqual(figures.worse("creases", None, 1), -1)

    def test_creases_of_a_cube_are_on_its_quads(self):
        quads = cube(6)
        triangles = numpy.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        surface = mesh_of(list(triangles))
        self.assertAlmostEqual(numpy.linalg.norm(numpy.diff(features.sharp_edges(surface), axis=1), axis=2).sum(), 12)
        self.assertAlmostEqual(features.deviation(surface, mesh_of(list(quads)))[2], 1)
        moved = [quad + [0.05, 0, 0] for quad in quads]  # 0.3 of an edge off: only edges along x stay
        self.assertAlmostEqual(features.deviation(surface, mesh_of(moved))[2], 1 / 3, delta=0.03)

    def test_a_study_without_a_map_of_the_surface_says_so(self):
        surface = quadrille.read(os.path.join(DATA, "beast.ply"))
        with unittest.mock.patch.object(study, "_whole_map", side_effect=quadrille.RemeshError("near (1, 2, 3): flat")):
            made = study.study(surface, "beast", 600, budgets=(), tell=lambda text: None, costs=study.COSTS[1:2])
        self.assertIn("near (1, 2, 3): flat", made.reference_note)
        self.assertEqual([outcome.name for outcome in made.outcomes], ["intermediate level", "E_G"])
        self.assertEqual([outcome.error for outcome in made.outcomes], ["", ""])


if __name__ == "__main__":
    unittest.main()
