# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The solved example at its smallest sizes, against closed forms and the published value.

  test_solved_example.py QUADRILLE SCRIPTS
"""
import math
import pathlib
import shutil
import sys
import tempfile
import unittest

import numpy as np

PROGRAM, SCRIPTS = pathlib.Path(sys.argv.pop(1)).resolve(), pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(SCRIPTS))
from simulation import calculix, elements, meshes, page, plate, roof, study  # noqa: E402

HAS_PROGRAMS = bool(shutil.which("ccx") and shutil.which("gmsh"))


class Shapes(unittest.TestCase):
    corners = {3: [(0, 0), (1, 0), (0, 1)], 4: [(-1, -1), (1, -1), (1, 1), (-1, 1)]}

    def nodes_of(self, nodes):
        corners = np.array(self.corners[elements.CORNERS[nodes]], float)
        if nodes == len(corners):
            return corners
        return np.concatenate([corners, (corners + np.roll(corners, -1, 0)) / 2])

    def test_each_function_is_one_at_its_node_only(self):
        for nodes in elements.CORNERS:
            values, _ = elements.shape(nodes, *self.nodes_of(nodes).T)
            np.testing.assert_allclose(values, np.eye(nodes), atol=1e-14)

    def test_derivatives_are_those_of_the_values(self):
        step = 1e-5  # the functions are cubic at most: central differences are off by its square, 1e-10
        r, s = np.array([0.2, 0.31]), np.array([0.15, 0.47])
        for nodes in elements.CORNERS:
            _, slopes = elements.shape(nodes, r, s)
            for k, (a, b) in enumerate(((step, 0), (0, step))):
                differences = (elements.shape(nodes, r + a, s + b)[0] - elements.shape(nodes, r - a, s - b)[0])
                np.testing.assert_allclose(slopes[:, :, k], differences / (2 * step), atol=1e-9)

    def test_quadrature_is_exact_for_polynomials(self):
        for nodes, area, moment in ((3, 0.5, 1 / 12), (4, 4.0, 4 / 3)):  # of r^2
            r, _, weights = elements.quadrature(nodes)
            self.assertAlmostEqual(weights.sum(), area, 13)
            self.assertAlmostEqual((weights * r * r).sum(), moment, 13)


class ClosedForm(unittest.TestCase):
    """Kirsch's solution: in equilibrium, free of tractions at the hole, three times the tension, tension far off."""

    def test_hole(self):
        angle = np.linspace(0, 2 * np.pi, 41)
        x, y = np.cos(angle), np.sin(angle)
        xx, yy, xy = plate.exact_stress(x, y).T
        np.testing.assert_allclose(np.stack([xx * x + xy * y, xy * x + yy * y]), 0, atol=1e-13)
        self.assertAlmostEqual(plate.exact_stress(np.zeros(1), np.ones(1))[0, 0], plate.CONCENTRATION, 13)
        np.testing.assert_allclose(plate.exact_stress(np.array([1e4]), np.array([1e4])), [[1, 0, 0]], atol=1e-7)

    def test_equilibrium(self):
        step = 1e-4  # central differences of derivatives of size 100 are off by its square, 1e-6
        x, y = np.array([1.1, -0.4, 2.0]), np.array([0.3, 1.5, -2.2])
        along_x = (plate.exact_stress(x + step, y) - plate.exact_stress(x - step, y)) / (2 * step)
        along_y = (plate.exact_stress(x, y + step) - plate.exact_stress(x, y - step)) / (2 * step)
        np.testing.assert_allclose(along_x[:, 0] + along_y[:, 2], 0, atol=1e-5)
        np.testing.assert_allclose(along_x[:, 2] + along_y[:, 1], 0, atol=1e-5)

    def test_regular_grids_of_the_roof_agree_where_they_meet(self):
        coarse = roof.grid(4, 2)
        field = coarse.points ** 2
        np.testing.assert_allclose(roof.on_grid(4, field, coarse.points), field, atol=1e-10)


class Page(unittest.TestCase):
    def test_section_goes_between_its_marks(self):
        text = f"a\n{page.BEGIN}\nold\n{page.END}\nb\n"
        self.assertEqual(page.fill(text, "new\n"), f"a\n{page.BEGIN}\n\nnew\n\n{page.END}\nb\n")
        self.assertRaises(ValueError, page.fill, "no marks", "new")


@unittest.skipUnless(HAS_PROGRAMS, "calculix-ccx and gmsh are not installed")
class Solved(unittest.TestCase):
    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.folder = pathlib.Path(made.name)

    def solve(self, problem, mesher, order, count):
        surface = self.folder / f"{problem.name}.vtk"
        if not surface.exists():
            study.make_surface(problem, self.folder)
        row = study.solve(problem, PROGRAM, surface, self.folder, mesher, order, count)
        return row, meshes.read_inp(self.folder / f"{study.job_name(problem, mesher, order, count)}_mesh.inp")

    def test_plate(self):
        problem = plate.Plate(graded=True)
        problem.fine = 0.03  # lies within 1.2e-4 of the circle, a hundredth of the smallest error
        for order in (1, 2):
            (coarse, mesh), (fine, _) = (self.solve(problem, study.OURS, order, count) for count in problem.sizes[:2])
            # One boundary loop is the hole; the corners of the square are node sets; patches cover the plate.
            hole = plate.boundary(mesh)[1]
            loops = [nodes for name, nodes in mesh.node_sets.items() if name.startswith("BOUNDARY")]
            self.assertEqual(len(loops), 2)
            self.assertEqual(sum(np.array_equal(nodes, hole) for nodes in loops), 1)
            corners = {name: nodes for name, nodes in mesh.node_sets.items() if name.startswith("CORNER")}
            at = sorted(tuple(np.round(mesh.points[nodes[0], :2], 9)) for nodes in corners.values())
            self.assertEqual(at, [(-4, -4), (-4, 4), (4, -4), (4, 4)])
            deck = (self.folder / f"{study.job_name(problem, study.OURS, order, 150)}.inp").read_text()
            self.assertNotIn("SUPPORT", deck)  # the sets of the file are taken
            # Elements of order p err by h^p, where h is the edge length over the radius; graded as the distance from
            # the centre it is the same everywhere. The factor depends on the solution and is below 1 here.
            ring = mesh.points[hole]
            h = 2 * math.pi * order / len(ring)
            self.assertLess(coarse["error"], h ** order)
            self.assertLess(abs(coarse["local"] / plate.CONCENTRATION - 1), h ** order)
            # Of the slope a fifth is left to the next power of h, which is a quarter.
            slope = math.log(coarse["error"] / fine["error"]) / math.log(fine["freedoms"] / coarse["freedoms"])
            self.assertAlmostEqual(slope / problem.slopes[order], 1, delta=0.2)

    def test_quads_of_gmsh_come_to_the_same(self):
        problem = plate.Plate(graded=False)
        problem.fine = 0.03
        for mesher in meshes.GMSH:
            row, _ = self.solve(problem, mesher, 2, 600)
            # h = 0.3 at the hole; 3 (1 - h^2) and more is what elements of second order find.
            self.assertLess(abs(row["local"] / plate.CONCENTRATION - 1), 0.09, mesher)

    def test_roof(self):
        problem = roof.Roof()
        problem.fine = 145, 50  # lies within 3e-4 of the cylinder, a thousandth of the thickness
        problem.reference = lambda folder: (8, np.ones((len(roof.grid(8, 2).points), 3)))  # the error is not looked at
        second, _ = self.solve(problem, study.OURS, 2, problem.sizes[0])
        # Published values lie between 0.3006 (deep shells) and 0.3024 (shallow ones); solids have 0.3019. Elements of
        # second order with 10 along each side are within 0.5 % of their limit.
        self.assertAlmostEqual(second["local"] / roof.PUBLISHED, 1, delta=0.01)
        first = [self.solve(problem, study.OURS, 1, count)[0]["local"] for count in problem.sizes[:2]]
        # Of first order they are stiffer, and four times as many have a quarter of the error, at most.
        missing = [roof.PUBLISHED - value for value in first]
        self.assertGreater(missing[0], 0)
        self.assertLess(missing[1], missing[0] / 4 + 0.002)  # all solids come to 0.002 less than is published

    def test_a_warning_is_an_error(self):
        problem = plate.Plate(graded=False)
        mesh = meshes.gmsh_mesh(problem, self.folder, "some", "triangles", 40, 1)
        lines = problem.deck(mesh, "some_mesh.inp")
        calculix.write(self.folder, "good", lines)
        calculix.solve(self.folder, "good")
        calculix.write(self.folder, "told", ["*NO SUCH KEYWORD", *lines])
        self.assertRaisesRegex(calculix.SolverError, "WARNING", calculix.solve, self.folder, "told")


if __name__ == "__main__":
    unittest.main()
