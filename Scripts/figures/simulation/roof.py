# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Scordelis-Lo roof: a piece of a cylinder under its own weight, its curved ends on rigid diaphragms, its straight
sides free [Scordelis and Lo 1964; MacNeal and Harder 1985].

CalculiX makes solids of shells, one through the thickness: C3D8I of S4, C3D20R of S8R, C3D6 and C3D15 of S3 and S6.
So the whole roof is solved, not a quarter, as conditions of symmetry hold rotations, which are rigid connections there.
"""
import numpy as np

from . import calculix, elements, meshes

RADIUS, LENGTH, HALF_ANGLE, THICKNESS = 25.0, 50.0, float(np.radians(40)), 0.25
YOUNG, POISSON, WEIGHT = 4.32e8, 0.0, 90.0  # the weight is that of an area
PUBLISHED = 0.3024
_SIDE, _RISE = float(RADIUS * np.sin(HALF_ANGLE)), float(RADIUS * np.cos(HALF_ANGLE))
#: The built-in kernel: Gmsh's full-quad recombination refuses the cylinder of the other one, as it is periodic.
_GEOMETRY = f"""Point(1) = {{0, 0, 0}};
Point(2) = {{0, {-_SIDE!r}, {_RISE!r}}};
Point(3) = {{0, {_SIDE!r}, {_RISE!r}}};
Circle(1) = {{2, 1, 3}};
Extrude {{{LENGTH}, 0, 0}} {{ Curve{{1}}; }}
"""
#: Elements along each direction of the regular grid that the error is measured against.
REFERENCE = 96


def grid(count, order):
    """A regular grid of count by count quads, exactly on the cylinder: first along the axis, then across."""
    places = {}
    block = []
    for i in range(count):
        for k in range(count):
            ring = [(i + 1, k), (i + 1, k + 1), (i, k + 1), (i, k)]
            ring = [(order * a, order * b) for a, b in ring]
            if order == 2:
                ring += [((a[0] + b[0]) // 2, (a[1] + b[1]) // 2) for a, b in zip(ring, ring[1:] + ring[:1])]
            block.append([places.setdefault(place, len(places)) for place in ring])
    at = np.array(list(places)) / (order * count)
    angle = HALF_ANGLE * (2 * at[:, 1] - 1)
    points = np.stack([LENGTH * at[:, 0], RADIUS * np.sin(angle), RADIUS * np.cos(angle)], 1)
    return meshes.Mesh(points, np.arange(1, len(points) + 1), {len(block[0]): np.array(block)})


def on_grid(count, displacement, points):
    """The displacement of grid(count, 2) at other points of the cylinder, #points by 3."""
    blocks = grid(count, 2).blocks[8].reshape(count, count, 8)
    along = points[:, 0] / LENGTH * count
    across = (np.arctan2(points[:, 1], points[:, 2]) / HALF_ANGLE + 1) / 2 * count
    i, k = (np.clip(place.astype(int), 0, count - 1) for place in (along, across))
    # Corners 0 and 1 of an element of the grid are those farther along, and 0 and 3 those less across.
    values = elements.shape(8, 2 * (across - k) - 1, 1 - 2 * (along - i))[0]
    return np.einsum("pn,pnd->pd", values, displacement[blocks[i, k]])


def element_errors(mesh, displacement, reference):
    """(squared error of the displacement, squared reference, area): integrals over each of #elements.

    `reference`: as on_grid takes it. One corner is held along the axis, where the solution is least smooth; so fields
    are compared with the middles of their motion along the axis at one place.
    """
    count, wanted = reference
    shift = (wanted[:, 0].max() + wanted[:, 0].min() - displacement[:, 0].max() - displacement[:, 0].min()) / 2
    displacement = displacement + [shift, 0, 0]
    rows = []
    for nodes, block in mesh.blocks.items():
        r, s, weights = elements.quadrature(nodes)
        values, slopes = elements.shape(nodes, r, s)
        at = mesh.points[block]
        place = np.einsum("qn,end->eqd", values, at)
        tangents = np.einsum("end,qnk->eqkd", at, slopes)
        area = np.linalg.norm(np.cross(tangents[:, :, 0], tangents[:, :, 1]), axis=2) * weights
        exact = on_grid(count, wanted, place.reshape(-1, 3)).reshape(place.shape)
        error = np.einsum("qn,end->eqd", values, displacement[block]) - exact
        rows.append(np.stack([np.einsum("eqd,eqd,eq->e", error, error, area),
                              np.einsum("eqd,eqd,eq->e", exact, exact, area), area.sum(1)], 1))
    return np.concatenate(rows).T


def side_deflection(mesh, displacement):
    """Downwards in the middles of the two free sides, the mean of both, within the edges that lie there."""
    found = []
    for edge in mesh.boundary_edges():
        ends = mesh.points[list(edge)]
        if np.all(np.abs(ends[:, 2] - _RISE) < 1e-3) and min(ends[:2, 0]) <= LENGTH / 2 < max(ends[:2, 0]):
            values = elements.line_shape(len(edge), np.linspace(-1, 1, 2001))[0]
            x, z = values @ ends[:, 0], values @ displacement[list(edge), 2]
            found.append(-np.interp(LENGTH / 2, *((x, z) if x[-1] > x[0] else (x[::-1], z[::-1]))))
    if len(found) != 2:
        raise meshes.MesherError(f"{len(found)} edges in the middles of the two free sides")
    return float(np.mean(found))


class Roof:
    sizes = (96, 384, 1536, 6144)
    types = {1: {3: "S3", 4: "S4"}, 2: {6: "S6", 8: "S8R"}}
    freedoms = 6  # of a node
    #: Exponents of the degrees of freedom: the displacement has h^2 and h^3.
    slopes = {1: 1.0, 2: 1.5}
    measure = "error of the displacement, L2 norm"
    local = "deflection"
    local_name = "deflection of the free side"
    local_exact = PUBLISHED
    name = "roof"
    title = "Scordelis-Lo roof"
    fine = 580, 200  # edges of the triangles across and along

    def __init__(self):
        self._reference = None

    def geometry(self, size):
        return _GEOMETRY + f"Mesh.MeshSizeMax = {size!r};\n"

    def first_size(self, count):
        return (2 * HALF_ANGLE * RADIUS * LENGTH / count) ** 0.5

    def surface(self, folder):
        """The triangles that Quadrille gets; with 580 across, they lie within 1.9e-5 of the cylinder."""
        across, along = self.fine
        text = _GEOMETRY + (f"Transfinite Curve {{1, 2}} = {across + 1};\nTransfinite Curve {{3, 4}} = {along + 1};\n"
                            "Transfinite Surface {5} Alternated;\n")
        return meshes.gmsh(text, folder, "fine", 6, None), None

    def deck(self, mesh, include):
        """Both ends are held in their planes, and one corner along the axis."""
        x = mesh.points[:, 0]
        near = 1e-6 * LENGTH
        ends = mesh.set_of(np.flatnonzero((x < near) | (x > LENGTH - near)), "DIAPHRAGMS")
        at = np.linalg.norm(mesh.points - [0, -_SIDE, _RISE], axis=1)
        corner = mesh.set_of([int(np.argmin(at))], "SUPPORT")
        return [f"*INCLUDE, INPUT={include}", *ends.lines, *corner.lines,
                "*MATERIAL, NAME=SHELL", "*ELASTIC", f"{YOUNG}, {POISSON}", "*DENSITY", f"{WEIGHT / THICKNESS}",
                "*SHELL SECTION, ELSET=EALL, MATERIAL=SHELL", f"{THICKNESS}",
                "*BOUNDARY", f"{ends.name}, 2, 3", f"{corner.name}, 1, 1",
                "*STEP", "*STATIC", "*DLOAD", "EALL, GRAV, 1., 0., 0., -1.", *calculix.OUTPUT, "*END STEP"]

    def solve_grid(self, folder, count, order):
        """(mesh, displacement) of a regular grid."""
        mesh, job = grid(count, order), f"grid_{count}_{order}"
        meshes.write_inp(mesh, self.types[order], folder / f"{job}_mesh.inp")
        calculix.write(folder, job, self.deck(mesh, f"{job}_mesh.inp"))
        calculix.solve(folder, job)
        return mesh, calculix.displacements(folder, job, mesh)

    def reference(self, folder):
        """What a fine regular grid of second order comes to, as on_grid takes it."""
        if self._reference is None:
            self._reference = REFERENCE, self.solve_grid(folder, REFERENCE, 2)[1]
        return self._reference

    def measures(self, folder, job, mesh):
        displacement = calculix.displacements(folder, job, mesh)
        error, size, _ = element_errors(mesh, displacement, self.reference(folder))
        return {"error": (error.sum() / size.sum()) ** 0.5, "deflection": side_deflection(mesh, displacement)}
