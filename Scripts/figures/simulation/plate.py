# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""A square piece of an infinite plate with a circular hole under tension, in plane stress [Kirsch 1898].

The exact stresses of the infinite plate are put onto the outer edges as tractions, so the exact solution of the piece
is known in closed form and is smooth, and the error of finite elements has the theory's slope. The stress at the hole
is three times the tension.
"""
import numpy as np

from . import calculix, elements, meshes

HALF_SIDE, RADIUS, TENSION = 4.0, 1.0, 1.0
#: Thin, so that what CalculiX makes a solid of has plane stress: errors of (THICKNESS / RADIUS)^2 times 1e-2.
YOUNG, POISSON, THICKNESS = 1.0, 0.3, 0.02
CONCENTRATION = 3.0
COMPLIANCE = np.array([[1, -POISSON, 0], [-POISSON, 1, 0], [0, 0, 2 * (1 + POISSON)]]) / YOUNG
_GEOMETRY = f"""SetFactory("OpenCASCADE");
Rectangle(1) = {{-{HALF_SIDE}, -{HALF_SIDE}, 0, {2 * HALF_SIDE}, {2 * HALF_SIDE}}};
Disk(2) = {{0, 0, 0, {RADIUS}}};
BooleanDifference(3) = {{ Surface{{1}}; Delete; }}{{ Surface{{2}}; Delete; }};
Field[1] = MathEval;
Field[1].F = "%s";
Background Field = 1;
"""


def exact_stress(x, y):
    """#points by 3 (xx, yy, xy), tension along x."""
    r2, angle = x * x + y * y, np.arctan2(y, x)
    a2 = RADIUS ** 2 / r2
    two, four = np.cos(2 * angle), np.cos(4 * angle)
    xx = 1 - a2 * (1.5 * two + four) + 1.5 * a2 * a2 * four
    yy = -a2 * (0.5 * two - four) - 1.5 * a2 * a2 * four
    xy = -a2 * (0.5 * np.sin(2 * angle) + np.sin(4 * angle)) + 1.5 * a2 * a2 * np.sin(4 * angle)
    return TENSION * np.stack([xx, yy, xy], 1)


def boundary(mesh):
    """(edges of the outer boundary, nodes of the hole, ascending), as places in the mesh's points."""
    outer, hole = [], set()
    for edge in mesh.boundary_edges():
        if np.all(np.hypot(*mesh.points[list(edge), :2].T) < 1.5 * RADIUS):
            hole.update(edge)
        else:
            outer.append(edge)
    return outer, np.array(sorted(hole))


def corners(mesh):
    """The nodes at the lower left and the lower right corner."""
    distance = [np.hypot(mesh.points[:, 0] - x, mesh.points[:, 1] + HALF_SIDE) for x in (-HALF_SIDE, HALF_SIDE)]
    return [int(np.argmin(d)) for d in distance]


def forces(mesh):
    """#nodes by 2: what the tractions of the exact solution do at the nodes of the outer edges."""
    force = np.zeros((len(mesh.points), 2))
    r, weights = np.polynomial.legendre.leggauss(8)
    for edge in boundary(mesh)[0]:
        values, slopes = elements.line_shape(len(edge), r)
        at, tangent = values @ mesh.points[list(edge), :2], slopes @ mesh.points[list(edge), :2]
        normal = np.stack([tangent[:, 1], -tangent[:, 0]], 1)  # its length: that of the edge over that of [-1, 1]
        xx, yy, xy = exact_stress(*at.T).T
        traction = np.stack([xx * normal[:, 0] + xy * normal[:, 1], xy * normal[:, 0] + yy * normal[:, 1]], 1)
        force[list(edge)] += THICKNESS * values.T @ (weights[:, None] * traction)
    return force


def element_errors(mesh, displacement):
    """(squared energy of the error, that of the exact solution, area), #elements each, in the order of the blocks.

    The stresses are those of the displacements that CalculiX prints, at more points than the elements' own.
    """
    rows = []
    for nodes, block in mesh.blocks.items():
        r, s, weights = elements.quadrature(nodes)
        values, slopes = elements.shape(nodes, r, s)
        at = mesh.points[block, :2]
        place = np.einsum("qn,end->eqd", values, at)
        jacobian = np.einsum("end,qnk->eqdk", at, slopes)
        area = np.linalg.det(jacobian) * weights
        gradient = np.einsum("end,qnk,eqkj->eqdj", displacement[block, :2], slopes, np.linalg.inv(jacobian))
        strain = np.stack([gradient[..., 0, 0], gradient[..., 1, 1], gradient[..., 0, 1] + gradient[..., 1, 0]], -1)
        exact = exact_stress(*place.reshape(-1, 2).T).reshape(strain.shape)
        error = strain @ np.linalg.inv(COMPLIANCE) - exact
        rows.append(np.stack([np.einsum("eqi,ij,eqj,eq->e", error, COMPLIANCE, error, area),
                              np.einsum("eqi,ij,eqj,eq->e", exact, COMPLIANCE, exact, area), area.sum(1)], 1))
    return np.concatenate(rows).T


def hole_stress(mesh, stress):
    """(#hole nodes, tangential stress there as CalculiX hands it to viewers, the exact one)."""
    hole = boundary(mesh)[1]
    x, y = mesh.points[hole, 0], mesh.points[hole, 1]
    r2 = x * x + y * y
    found = (stress[hole, 0] * y * y + stress[hole, 1] * x * x - 2 * stress[hole, 3] * x * y) / r2
    return hole, found, TENSION * (1 - 2 * (x * x - y * y) / r2)


class Plate:
    """Sizes are even, or grow as the distance from the centre, the same for all meshers."""
    sizes = (150, 600, 2400, 9600)
    types = {1: {3: "CPS3", 4: "CPS4"}, 2: {6: "CPS6", 8: "CPS8"}}
    freedoms = 2  # of a node
    #: Exponents of the degrees of freedom: the energy norm has h^1 and h^2, and there are 1 / h^2 degrees of freedom.
    slopes = {1: 0.5, 2: 1.0}
    measure = "error of the stress, energy norm"
    local = "concentration"
    local_name = "stress concentration"
    local_exact = CONCENTRATION

    fine = 0.01  # edges of the triangles at the hole

    def __init__(self, graded):
        self.graded = graded
        self.name = "plate-graded" if graded else "plate-even"
        self.title = "Plate with a hole, " + ("edges graded towards it" if graded else "even edges")

    def geometry(self, size):
        """For Gmsh; `size`: edge length, of graded ones at the hole."""
        return _GEOMETRY % (f"{size!r} * Sqrt(x * x + y * y) / {RADIUS}" if self.graded else f"{size!r}")

    def first_size(self, count):
        """The edge length of so many squares."""
        if self.graded:  # the number is the integral of 1 / (size r)^2
            angle = np.linspace(0, np.pi / 4, 1001)
            return (8 * np.trapz(np.log(HALF_SIDE / np.cos(angle) / RADIUS), angle) / count) ** 0.5 * RADIUS
        return ((4 * HALF_SIDE ** 2 - np.pi * RADIUS ** 2) / count) ** 0.5

    def surface(self, folder):
        """The triangles that Quadrille gets, with sizes (None: even). Edges of 0.01 lie within 1.3e-5 of the circle."""
        fine = meshes.gmsh(_GEOMETRY % f"{self.fine} * (1 + 3 * (Sqrt(x * x + y * y) - {RADIUS}))", folder, "fine", 6,
                           None)
        return fine, np.hypot(*fine.points[:, :2].T) if self.graded else None

    def deck(self, mesh, include):
        """The analysis: three displacements are held, those of a rigid body, as the loads are in equilibrium."""
        left, right = (mesh.set_of([corner], f"SUPPORT_{i}") for i, corner in enumerate(corners(mesh)))
        force = forces(mesh)
        lines = [f"*INCLUDE, INPUT={include}", *left.lines, *right.lines,
                 "*MATERIAL, NAME=SHEET", "*ELASTIC", f"{YOUNG}, {POISSON}",
                 "*SOLID SECTION, ELSET=EALL, MATERIAL=SHEET", f"{THICKNESS}",
                 "*BOUNDARY", f"{left.name}, 1, 2", f"{right.name}, 2, 2", "*STEP", "*STATIC", "*CLOAD"]
        for i in np.flatnonzero(np.any(force != 0, 1)):
            lines += [f"{mesh.numbers[i]}, {k + 1}, {force[i, k]:.12e}" for k in range(2)]
        return lines + calculix.OUTPUT + ["*END STEP"]

    def measures(self, folder, job, mesh):
        displacement = calculix.displacements(folder, job, mesh)
        error, energy, _ = element_errors(mesh, displacement)
        _, found, exact = hole_stress(mesh, calculix.nodal_stresses(folder, job, mesh))
        return {"error": (error.sum() / energy.sum()) ** 0.5, "concentration": found.max() / TENSION,
                "hole": np.sqrt(np.mean((found - exact) ** 2)) / TENSION}
