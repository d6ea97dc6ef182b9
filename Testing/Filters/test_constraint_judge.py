# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Whether Scripts/study/constraint_judge.py measures what is known of a cube of 12 triangles and a grid of quads on it.

  test_constraint_judge.py SCRIPTS
"""
import math
import sys
import unittest

import numpy

sys.path.insert(0, sys.argv.pop(1))
import constraint_judge as judge  # noqa: E402  (the folder comes first)

#: Quads along each edge of the cube.
N = 20
#: Places are sums of some tens of roundings.
EXACT = 1e-9


def cube_faces(n):
    """The quads of a cube with n along each edge: points and rows of four."""
    corners = []
    for axis in range(3):
        for side in (0, n):
            for i in range(n):
                for k in range(n):
                    quad = [numpy.roll((side, *c), axis) for c in ((i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1))]
                    corners += quad if side else quad[::-1]
    points, ids = numpy.unique(numpy.array(corners, float) / n, axis=0, return_inverse=True)
    return points, ids.reshape(-1, 4)


def grid(aslant=0.0):
    """The quads, those of the top turned by so many degrees about its middle where that stays inside."""
    points, quads = cube_faces(N)
    if aslant:
        turn = math.radians(aslant)
        from_middle = points[:, :2] - 0.5
        moved = (points[:, 2] == 1) & (numpy.linalg.norm(from_middle, axis=1) < 0.45)
        turned = from_middle @ numpy.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]]) + 0.5
        points[moved, :2] = turned[moved]
    return judge.Quads(points, quads)


class Judge(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        points, quads = cube_faces(1)
        triangles = numpy.concatenate((quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]))
        cls.surface = judge.Surface(points, triangles, 1 / N, 40)

    def course(self, *points):
        points = numpy.array(points, float)
        pieces = [self.surface.straight(a, b, compare=False) for a, b in zip(points[:-1], points[1:])]
        return judge.Course(numpy.concatenate([points[:1]] + [piece[1:] for piece in pieces]), self.surface.edge)

    def test_surface(self):
        self.assertTrue((self.surface.twin >= 0).all())
        numpy.testing.assert_allclose(self.surface.region_area, numpy.ones(6), atol=EXACT)
        # Samples of the twelve edges, at most a twentieth of half an edge length apart.
        self.assertLess(self.surface.to_feature(numpy.array([[0.123, 0, 0]])).max(), 0.025 / N)
        self.assertAlmostEqual(self.surface.to_feature(numpy.array([[0.5, 0.3, 1]]))[0], 0.3, delta=0.001)
        self.assertTrue(numpy.isinf(self.surface.to_boundary(numpy.zeros((1, 3)))).all())

    def test_nearest_is_that_of_the_box(self):
        random = numpy.random.default_rng(1)
        places = random.uniform(-0.5, 1.5, (200, 3))
        found, _, distance = self.surface.nearest(places)
        inside = ((places > 0) & (places < 1)).all(axis=1)
        outside = numpy.linalg.norm(places - numpy.clip(places, 0, 1), axis=1)
        numpy.testing.assert_allclose(distance, numpy.where(
            inside, numpy.minimum(places, 1 - places).min(axis=1), outside), atol=EXACT)
        numpy.testing.assert_allclose(numpy.linalg.norm(found - places, axis=1), distance, atol=EXACT)

    def test_sections(self):
        loop = self.surface.loop(numpy.array([0.31, 0, 0.37]), numpy.array([0, 0, 1.0]))
        self.assertAlmostEqual(judge.length_of(loop), 4, delta=EXACT)
        # Over an edge the section with the plane of the mean normal: unfolded it is straight, (2, 1) on both sides.
        line = self.surface.straight(numpy.array([0.5, 0.2, 1]), numpy.array([1, 0.7, 0.5]), compare=False)
        self.assertAlmostEqual(judge.length_of(line), math.hypot(1, 0.5), delta=EXACT)
        # Along edges of the triangles, and along the diagonal that they have or have not.
        for ends in (((0.2, 0.5, 1), (0.8, 0.5, 1)), ((0.2, 0.2, 1), (0.8, 0.8, 1)), ((0.2, 0.8, 1), (0.8, 0.2, 1))):
            line = self.surface.straight(*numpy.array(ends), compare=True)
            self.assertAlmostEqual(judge.length_of(line), math.dist(*ends), delta=1e-6)

    def test_valence(self):
        corner, middle = numpy.array([1.0, 1, 1]), numpy.array([0.5, 0.5, 1])
        self.assertTrue(judge.judge_valence(self.surface, grid(), corner, 3).ok)
        verdict = judge.judge_valence(self.surface, grid(), middle, 3)
        self.assertFalse(verdict.ok)
        self.assertAlmostEqual(verdict.deviation, N * math.sqrt(0.5), delta=1e-6)
        self.assertFalse(judge.judge_valence(self.surface, grid(), middle, 5).ok)

    def test_move(self):
        origin, target = numpy.array([0.0, 1, 1]), numpy.array([0.5, 0.5, 1])
        free = grid()
        # The corner was taken to the middle of the top: all quads of the corner's are elsewhere in name only.
        moved = judge.Quads(free.points.copy(), free.quads)
        corner = numpy.flatnonzero((moved.points == origin).all(axis=1))[0]
        moved.points[corner] = target
        self.assertTrue(judge.judge_move(self.surface, moved, free, origin, target, 3).ok)
        # Nothing was done; the old one is still there; another one went, too.
        self.assertFalse(judge.judge_move(self.surface, free, free, origin, target, 3).ok)
        self.assertFalse(judge.judge_move(self.surface, free, free, origin, numpy.array([1.0, 1, 1]), 3).ok)
        another = numpy.flatnonzero((moved.points == 0).all(axis=1))[0]
        moved.points[another, 0] += 3 / N
        verdict = judge.judge_move(self.surface, moved, free, origin, target, 3)
        self.assertFalse(verdict.ok)
        self.assertIn("2 others", verdict.more)

    def test_connection(self):
        along = judge.judge_connection(self.surface, grid(), self.course((0, 0, 1), (0.4, 0, 1), (1, 0, 1)))
        self.assertTrue(along.ok)
        self.assertAlmostEqual(along.deviation, 0, delta=1e-6)
        self.assertFalse(judge.judge_connection(self.surface, grid(), self.course((0, 0, 1), (1, 1, 1))).ok)
        # Across a side, from feature to feature, a fifth of an edge beside the chain.
        beside = self.course((0.5 + 0.2 / N, 0, 1), (0.5 + 0.2 / N, 1, 1))
        verdict = judge.judge_connection(self.surface, grid(), beside)
        self.assertTrue(verdict.ok)
        self.assertAlmostEqual(verdict.deviation, 0.2, delta=1e-6)
        # One end lies in a side, two edges from the nearest vertex that is irregular or on a feature.
        inside = self.course((0.5, 2 / N, 1), (0.5, 1, 1))
        self.assertFalse(judge.judge_connection(self.surface, grid(), inside).ok)
        # The chain lies on the course, which goes elsewhere besides.
        detour = self.course((0.5, 0, 1), (0.5, 0.5, 1), (0.5 + 7 / N, 0.5, 1), (0.5, 0.5, 1), (0.5, 1, 1))
        self.assertFalse(judge.judge_connection(self.surface, grid(), detour).ok)

    def test_cycle(self):
        for height, off in ((0.5, 0), (0.5 + 0.4 / N, 0.4)):
            loop = self.surface.loop(numpy.array([0.31, 0, height]), numpy.array([0, 0, 1.0]))
            verdict = judge.judge_cycle(grid(), judge.Course(loop, self.surface.edge))
            self.assertTrue(verdict.ok)
            # Samples cut the corners of the course by less than a tenth of an edge.
            self.assertAlmostEqual(verdict.deviation, off, delta=0.01)
        aslant = self.surface.loop(numpy.array([0.31, 0, 0.5]), judge.unit(numpy.array([0, 1.0, 1])))
        self.assertFalse(judge.judge_cycle(grid(), judge.Course(aslant, self.surface.edge)).ok)

    def test_feature(self):
        for off in (0, 0.2, 0.4):
            y = 0.5 + off / N
            verdict = judge.judge_feature(grid(), self.course((0.2, y, 1), (0.5, y, 1), (0.8, y, 1)))
            self.assertEqual(verdict.ok, off <= judge.PLACE)
            self.assertAlmostEqual(verdict.deviation, off, delta=1e-6)
        # A chain may turn; edges that only cross the course are none of it.
        turned = self.course((0.2, 0.5, 1), (0.5, 0.5, 1), (0.5, 0.8, 1))
        self.assertTrue(judge.judge_feature(grid(), turned).ok)
        self.assertFalse(judge.judge_feature(grid(), self.course((0.2, 0.3, 1), (0.8, 0.6, 1))).ok)
        self.assertFalse(judge.judge_feature(grid(), self.course((0.2, 0.2, 1), (0.8, 0.8, 1))).ok)

    def test_stroke(self):
        course = self.course((0.4, 0.5, 1), (0.6, 0.5, 1))
        for angle in (0, 3, 20, 45):
            verdict = judge.judge_stroke(self.surface, grid(angle), course, 0.1)
            self.assertEqual(verdict.ok, angle <= judge.STROKE)
            self.assertAlmostEqual(verdict.deviation, angle, delta=1e-3)
        # Each part of a course counts by its length, into however many pieces it comes: half of this one, which crosses
        # no quad that was turned, is one piece, the other half fifty.
        line = numpy.array([(0.5, 0.5, 1)] + [(0.5 - 0.3 * k / 50, 0.5, 1) for k in range(1, 51)])
        pieces = judge.Course(numpy.concatenate((line[::-1], [(0.8, 0.5, 1)])), 10 * self.surface.edge)
        turned = grid()
        there = (turned.points[:, 2] == 1) & (turned.points[:, 0] < 0.5) & (turned.points[:, 0] > 0)
        turned.points[there, 1] += 0.1 * (turned.points[there, 0] - 0.5)
        verdict = judge.judge_stroke(self.surface, judge.Quads(turned.points, turned.quads), pieces, 0)
        self.assertAlmostEqual(verdict.deviation, 0.5 * math.degrees(math.atan(0.1)), delta=0.2)
        # Where the stroke is at right angles to a family it is along the other one.
        self.assertTrue(judge.judge_stroke(self.surface, grid(88), course, 0.1).ok)

    def test_size(self):
        middle = numpy.array([0.5, 0.5, 1])
        for factor, off in ((1, 0), (0.9, 1 / 9), (1.25, 0.25), (0.5, 1)):
            verdict = judge.judge_size(self.surface, grid(), middle, 0.2, factor, 1e6)
            self.assertEqual(verdict.ok, off <= 0.25 + EXACT)
            # What is within the radius takes its part of the quads.
            self.assertAlmostEqual(verdict.deviation, off, delta=0.07)


if __name__ == "__main__":
    unittest.main()
