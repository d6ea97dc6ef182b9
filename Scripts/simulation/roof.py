# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Scordelis-Lo roof: a piece of a cylinder under its own weight, its curved ends on rigid diaphragms, its straight
sides free [Scordelis and Lo 1964; MacNeal and Harder 1985, a proposed standard set of problems].

CalculiX makes solids of shells: C3D8I of S4, C3D20 of S8, C3D6 and C3D15 of S3 and S6, with one element through the
thickness. So the whole roof is solved, not a quarter: conditions of symmetry would need rotations, which become rigid
connections there.
"""
import numpy as np

from . import calculix, elements, meshes

TITLE = "Scordelis-Lo roof"
RADIUS, LENGTH, HALF_ANGLE, THICKNESS = 25.0, 50.0, np.radians(40), 0.25
YOUNG, POISSON, WEIGHT = 4.32e8, 0.0, 90.0
PUBLISHED = 0.3024  # downwards, in the middles of the free sides
AREA = 2 * HALF_ANGLE * RADIUS * LENGTH
SIZES = (96, 384, 1536, 6144)
TYPES = {1: {3: "S3", 4: "S4"}, 2: {6: "S6", 8: "S8R"}}
FREEDOMS = 6
_SIDE, _RISE = RADIUS * np.sin(HALF_ANGLE), RADIUS * np.cos(HALF_ANGLE)
#: The built-in kernel: Gmsh's full-quad recombination refuses the cylinder of the other one, as it is periodic.
GEOMETRY = f"""Point(1) = {{0, 0, 0}};
Point(2) = {{0, {-_SIDE!r}, {_RISE!r}}};
Point(3) = {{0, {_SIDE!r}, {_RISE!r}}};
Circle(1) = {{2, 1, 3}};
Extrude {{{LENGTH}, 0, 0}} {{ Curve{{1}}; }}
"""


def grid(along, across, order=2):
    """A regular grid, exactly on the cylinder."""
    middle = order
    index = {}
    points = []
    block = []

    def node(i, k):
        if (i, k) not in index:
            index[i, k] = len(points)
            angle = HALF_ANGLE * (2 * k / (middle * across) - 1)
            points.append([LENGTH * i / (middle * along), RADIUS * np.sin(angle), RADIUS * np.cos(angle)])
        return index[i, k]

    for i in range(along):
        for k in range(across):
            corners = [(i, k), (i, k + 1), (i + 1, k + 1), (i + 1, k)][::-1]
            corners = [(middle * a, middle * b) for a, b in corners]
            places = list(corners)
            if order == 2:
                places += [((a[0] + b[0]) // 2, (a[1] + b[1]) // 2) for a, b in zip(corners, corners[1:] + corners[:1])]
            block.append([node(*place) for place in places])
    return meshes.Mesh(np.array(points), np.arange(1, len(points) + 1), {len(block[0]): np.array(block)})


def deck(mesh, include):
    x = mesh.points[:, 0]
    near = 1e-6 * LENGTH
    ends = mesh.numbers[(x < near) | (x > LENGTH - near)]
    corner = mesh.numbers[np.argmin(np.linalg.norm(mesh.points - [0, -_SIDE, _RISE], axis=1))]
    lines = [f"*INCLUDE, INPUT={include}", "*NSET, NSET=DIAPHRAGMS", *(f"{number}," for number in ends),
             "*MATERIAL, NAME=SHELL", "*ELASTIC", f"{YOUNG}, {POISSON}", "*DENSITY", f"{WEIGHT / THICKNESS}",
             "*SHELL SECTION, ELSET=EALL, MATERIAL=SHELL", f"{THICKNESS}",
             "*BOUNDARY", "DIAPHRAGMS, 2, 3", f"{corner}, 1, 1",
             "*STEP", "*STATIC", "*DLOAD", "EALL, GRAV, 1., 0., 0., -1.",
             "*NODE PRINT, NSET=NALL", "U", "*NODE FILE, OUTPUT=2D", "U", "*EL FILE, OUTPUT=2D", "S", "*END STEP"]
    return "\n".join(lines) + "\n"


def side_deflection(mesh, displacement):
    """Downwards in the middles of the two free sides, the mean of both, within the edges that lie there."""
    found = []
    for edge in mesh.boundary_edges():
        ends = mesh.points[list(edge)]
        if np.all(np.abs(ends[:, 2] - _RISE) < 1e-2) and min(ends[:2, 0]) <= LENGTH / 2 < max(ends[:2, 0]):
            r = np.linspace(-1, 1, 2001)
            values = elements.line_shape(len(edge), r)[0]
            found.append(-np.interp(LENGTH / 2, *_ascending(values @ ends[:, 0], values @ displacement[list(edge), 2])))
    assert len(found) == 2, found
    return np.mean(found)


def _ascending(x, y):
    return (x, y) if x[-1] > x[0] else (x[::-1], y[::-1])


def on_grid(along, across, displacement, x, angle):
    """#points by 3: the displacement of grid(along, across) at other points of the cylinder."""
    mesh_blocks = grid(along, across).blocks[8].reshape(along, across, 8)
    i = np.clip((x / LENGTH * along).astype(int), 0, along - 1)
    k = np.clip(((angle / HALF_ANGLE + 1) / 2 * across).astype(int), 0, across - 1)
    s = 2 * (x / LENGTH * along - i) - 1
    r = 2 * ((angle / HALF_ANGLE + 1) / 2 * across - k) - 1
    # The corners of an element of the grid: (i + 1, k), (i + 1, k + 1), (i, k + 1), (i, k).
    values = elements.shape(8, r, -s)[0]
    return np.einsum("pn,pnd->pd", values, displacement[mesh_blocks[i, k]])


def element_errors(mesh, displacement, reference):
    """(squared error of the displacement, squared reference, area): integrals over #elements each."""
    rows = []
    shift = sum(field[:, 0].max() + field[:, 0].min() for field in (reference[2], -displacement)) / 2
    displacement = displacement + [shift, 0, 0]
    for nodes, block in mesh.blocks.items():
        r, s, weights = elements.quadrature(nodes)
        values, slopes = elements.shape(nodes, r, s)
        at = mesh.points[block]
        place = np.einsum("qn,end->eqd", values, at)
        tangents = np.einsum("end,qnk->eqkd", at, slopes)
        area = np.linalg.norm(np.cross(tangents[:, :, 0], tangents[:, :, 1]), axis=2) * weights
        flat = place.reshape(-1, 3)
        exact = on_grid(*reference, flat[:, 0], np.arctan2(flat[:, 1], flat[:, 2])).reshape(place.shape)
        error = np.einsum("qn,end->eqd", values, displacement[block]) - exact
        rows.append(np.stack([np.einsum("eqd,eqd,eq->e", error, error, area),
                              np.einsum("eqd,eqd,eq->e", exact, exact, area), area.sum(1)], 1))
    return np.concatenate(rows).T
