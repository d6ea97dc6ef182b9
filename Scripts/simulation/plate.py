# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""A square piece of an infinite plate with a circular hole under tension, in plane stress [Kirsch 1898].

The exact stresses of the infinite plate are put onto the outer edges as tractions, so the exact solution of the piece
is known in closed form and is smooth: the error of finite elements has the theory's slope. Stress at the hole: three
times the tension.
"""
import numpy as np

from . import calculix, elements

TITLE = "Plate with a hole"
HALF_SIDE, RADIUS, TENSION = 4.0, 1.0, 1.0
YOUNG, POISSON, THICKNESS = 1.0, 0.3, 0.02
CONCENTRATION = 3.0
AREA = 4 * HALF_SIDE ** 2 - np.pi * RADIUS ** 2
SIZES = (150, 600, 2400, 9600)
TYPES = {1: {3: "CPS3", 4: "CPS4"}, 2: {6: "CPS6", 8: "CPS8"}}
FREEDOMS = 2  # of a node
#: Of the energy norm: h^1 and h^2, where h^2 is the inverse of the degrees of freedom.
SLOPES = {1: 0.5, 2: 1.0}
MEASURE = "error of the stress in the energy norm"
GEOMETRY = f"""SetFactory("OpenCASCADE");
Rectangle(1) = {{-{HALF_SIDE}, -{HALF_SIDE}, 0, {2 * HALF_SIDE}, {2 * HALF_SIDE}}};
Disk(2) = {{0, 0, 0, {RADIUS}}};
BooleanDifference(3) = {{ Surface{{1}}; Delete; }}{{ Surface{{2}}; Delete; }};
"""
#: The triangles that Quadrille gets: edges of the hole of 0.01 lie within 1.3e-5 of the circle.
FINE = GEOMETRY + f"""Field[1] = MathEval;
Field[1].F = "0.01 + 0.03 * (Sqrt(x * x + y * y) - {RADIUS})";
Background Field = 1;
"""
FINE_SIZE = 0.1
PLANE_STRESS = np.array([[1, -POISSON, 0], [-POISSON, 1, 0], [0, 0, 2 * (1 + POISSON)]]) / YOUNG


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
    """(edges of the outer boundary, nodes of the hole), as places in the mesh's points."""
    outer, hole = [], set()
    for edge in mesh.boundary_edges():
        ends = mesh.points[list(edge), :2]
        if np.all(np.hypot(*ends.T) < 1.5 * RADIUS):
            hole.update(edge)
        else:
            outer.append(edge)
    return outer, np.array(sorted(hole))


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


def deck(mesh, include):
    """The analysis: three displacements are held, those of a rigid body; loads are in equilibrium."""
    corners = [mesh.numbers[np.argmin(np.hypot(mesh.points[:, 0] - x, mesh.points[:, 1] + HALF_SIDE))]
               for x in (-HALF_SIDE, HALF_SIDE)]
    force = forces(mesh)
    lines = [f"*INCLUDE, INPUT={include}", "*NSET, NSET=SOLVED", *(f"{number}," for number in mesh.numbers),
             "*MATERIAL, NAME=SHEET", "*ELASTIC", f"{YOUNG}, {POISSON}",
             "*SOLID SECTION, ELSET=EALL, MATERIAL=SHEET", f"{THICKNESS}",
             "*BOUNDARY", f"{corners[0]}, 1, 2", f"{corners[1]}, 2, 2", "*STEP", "*STATIC", "*CLOAD"]
    for i in np.flatnonzero(np.any(force != 0, 1)):
        lines += [f"{mesh.numbers[i]}, {k + 1}, {force[i, k]:.12g}" for k in range(2)]
    lines += ["*NODE PRINT, NSET=SOLVED", "U", "*NODE FILE, OUTPUT=2D", "U", "*EL FILE, OUTPUT=2D", "S", "*END STEP"]
    return "\n".join(lines) + "\n"


def element_errors(mesh, displacement):
    """(squared energy of the error, that of the exact solution, area), #elements each, in the order of the blocks."""
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
        error = strain @ np.linalg.inv(PLANE_STRESS) - exact
        rows.append(np.stack([np.einsum("eqi,ij,eqj,eq->e", error, PLANE_STRESS, error, area),
                              np.einsum("eqi,ij,eqj,eq->e", exact, PLANE_STRESS, exact, area), area.sum(1)], 1))
    return np.concatenate(rows).T


def measures(folder, job, mesh):
    displacement = calculix.displacements(folder, job, mesh)
    stress = calculix.nodal_stresses(folder, job, mesh)
    error, energy, _ = element_errors(mesh, displacement)
    hole = boundary(mesh)[1]
    x, y = mesh.points[hole, 0], mesh.points[hole, 1]
    r2 = x * x + y * y
    along = (stress[hole, 0] * y * y + stress[hole, 1] * x * x - 2 * stress[hole, 3] * x * y) / r2
    return {"error": (error.sum() / energy.sum()) ** 0.5,
            "concentration": along.max() / TENSION,
            "hole": np.sqrt(np.mean((along - TENSION * (1 - 2 * (x * x - y * y) / r2)) ** 2)) / TENSION}
