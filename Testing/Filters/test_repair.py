# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""quadrille.repair, quadrille.wrap and remesh(..., wrap=...): needs a build with CGAL."""
import unittest

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

import quadrille


def ball(centre, rows=24, columns=48):
    """Points and triangles of a unit sphere."""
    theta = numpy.linspace(0, numpy.pi, rows + 1)[1:-1]
    phi = numpy.linspace(0, 2 * numpy.pi, columns, endpoint=False)
    t, p = numpy.meshgrid(theta, phi, indexing="ij")
    ring = numpy.stack((numpy.sin(t) * numpy.cos(p), numpy.sin(t) * numpy.sin(p), numpy.cos(t)), axis=-1)
    points = numpy.concatenate((ring.reshape(-1, 3), [[0, 0, 1.0], [0, 0, -1.0]])) + centre
    north, south = len(points) - 2, len(points) - 1
    faces = []
    for j in range(columns):
        k = (j + 1) % columns
        faces.append((north, j, k))
        for i in range(rows - 2):
            a, b = i * columns, (i + 1) * columns
            faces += [(a + j, b + j, b + k), (a + j, b + k, a + k)]
        faces.append((south, (rows - 2) * columns + k, (rows - 2) * columns + j))
    return points, numpy.array(faces)


def two_balls():
    """Two unit spheres that cross each other, 1.1 apart."""
    (points, faces), (others, _) = ball((0, 0, 0)), ball((1.1, 0.03, 0.02))
    return numpy.concatenate((points, others)), numpy.concatenate((faces, faces + len(points)))


def euler(points, faces):
    """Of a closed surface."""
    edges = {tuple(sorted(edge)) for face in faces for edge in zip(face, numpy.roll(face, -1))}
    return len(points) - len(edges) + len(faces)


def distance(points):
    """From the surface of the two balls."""
    return abs(numpy.minimum(numpy.linalg.norm(points, axis=1),
                             numpy.linalg.norm(points - (1.1, 0.03, 0.02), axis=1)) - 1)


class Repair(unittest.TestCase):
    def test_tells_what_crosses(self):
        surface, findings = quadrille.repair(two_balls())
        self.assertEqual(len(findings), 1)
        self.assertIn("cross each other, at 1 place", findings[0])
        self.assertEqual(quadrille.info(surface)["Components"], 2)
        self.assertGreater(quadrille.info(surface)["SelfIntersections"], 0)

    def test_soup_with_faces_turned_round(self):
        points, faces = ball((0, 0, 0))
        soup = points[faces].reshape(-1, 3)
        corners = numpy.arange(len(soup)).reshape(-1, 3)
        corners[::3] = corners[::3, ::-1]
        surface, findings = quadrille.repair((soup, corners))
        new_points, new_faces = quadrille.to_arrays(surface)
        self.assertEqual(len(new_points), len(points))
        self.assertEqual(euler(new_points, new_faces), 2)
        self.assertEqual(len(findings), 2, findings)  # merged, and turned round

    def test_fills_holes(self):
        points, faces = ball((0, 0, 0))
        open_mesh = (points, faces[1:])
        self.assertEqual(quadrille.info(quadrille.repair(open_mesh)[0])["OpenBoundaries"], 1)
        surface, _ = quadrille.repair(open_mesh, fill_holes_below=1)
        self.assertEqual(quadrille.info(surface)["OpenBoundaries"], 0)
        self.assertEqual(vtk_to_numpy(surface.GetCellData().GetArray("Filling")).max(), 1)

    def test_refuses(self):
        with self.assertRaises(quadrille.InvalidInput):
            quadrille.repair(two_balls(), fill_holes_below=-1)


class Wrap(unittest.TestCase):
    def test_is_closed_round_what_crosses(self):
        points, faces = quadrille.to_arrays(quadrille.wrap(two_balls(), alpha=0.2, offset=0.02))
        self.assertEqual(faces.shape[1], 3)
        self.assertEqual(euler(points, faces), 2)
        # At the offset from the triangles, which lie within 0.005 of the balls.
        self.assertLess(abs(distance(points) - 0.02).max(), 0.006)

    def test_takes_points(self):
        points, _ = ball((0, 0, 0))
        surface = quadrille.wrap(points, alpha=0.4, offset=0.1)
        self.assertEqual(euler(*quadrille.to_arrays(surface)), 2)

    def test_stops(self):
        with self.assertRaisesRegex(quadrille.RemeshError, "stopped on request"):
            quadrille.wrap(two_balls(), alpha=0.01, offset=0.002, progress=lambda fraction, text: fraction < 0.01)

    def test_refuses(self):
        for alpha in (0, -1, float("nan"), 1e-9):
            with self.assertRaisesRegex(quadrille.InvalidInput, "alpha"):
                quadrille.wrap(two_balls(), alpha=alpha)


class Remesh(unittest.TestCase):
    def test_quads_of_a_wrap_lie_on_the_mesh(self):
        quads = quadrille.remesh(two_balls(), quads=600, wrap=0.1)
        points, faces = quadrille.to_arrays(quads)
        self.assertEqual(faces.shape[1], 4)
        self.assertEqual(euler(points, faces), 2)
        on_surface = vtk_to_numpy(quads.GetPointData().GetArray("OnSurface")) == 1
        self.assertGreater(on_surface.mean(), 0.9)  # all but those in the crease where the balls meet
        self.assertEqual(on_surface.sum(), quadrille.info(quads)["PointsOnSurface"])
        self.assertLess(distance(points[on_surface]).max(), 0.006)

    def test_auto_leaves_a_mesh_alone_that_has_quads(self):
        mesh = ball((0, 0, 0))
        expected = quadrille.to_arrays(quadrille.remesh(mesh, quads=300))
        found = quadrille.remesh(mesh, quads=300, wrap="auto")
        numpy.testing.assert_array_equal(quadrille.to_arrays(found)[0], expected[0])
        self.assertNotIn("WrapAlpha", quadrille.info(found))

    def test_auto_wraps_what_has_none(self):
        # A Moebius strip cannot be oriented.
        s = numpy.linspace(0, 2 * numpy.pi, 60, endpoint=False)
        rows = [numpy.stack(((1 + w * numpy.cos(s / 2)) * numpy.cos(s), (1 + w * numpy.cos(s / 2)) * numpy.sin(s),
                             w * numpy.sin(s / 2)), axis=1) for w in (-0.3, 0.0, 0.3)]
        points = numpy.concatenate(rows)
        faces = []
        for i in range(60):
            for r in range(2):
                a, b = r * 60 + i, (r + 1) * 60 + i
                c, d = (r * 60 + i + 1, (r + 1) * 60 + i + 1) if i < 59 else ((2 - r) * 60, (1 - r) * 60)
                faces += [(a, c, d), (a, d, b)]
        with self.assertRaises(quadrille.InvalidInput):
            quadrille.remesh((points, faces), quads=500)
        quads = quadrille.remesh((points, faces), quads=500, wrap="auto")
        self.assertEqual(euler(*quadrille.to_arrays(quads)), 0)  # a torus: both sides of the strip are one
        self.assertIn("WrapAlpha", quadrille.info(quads))

    def test_refuses_what_a_wrap_cannot_keep(self):
        mesh = ball((0, 0, 0))
        with self.assertRaisesRegex(quadrille.InvalidInput, "sizing"):
            quadrille.remesh(mesh, wrap=0.1, sizing=numpy.ones(len(mesh[0])))
        with self.assertRaisesRegex(quadrille.InvalidInput, "wrap"):
            quadrille.remesh(mesh, wrap="always")


if __name__ == "__main__":
    unittest.main()
