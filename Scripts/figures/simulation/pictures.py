# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Plots of the errors, and pictures of meshes with what was found on them."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.collections import LineCollection, PolyCollection  # noqa: E402
from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # noqa: E402

from . import elements, plate, study  # noqa: E402

plt.rcParams["svg.hashsalt"] = "quadrille"  # the same figures are the same bytes
COLOURS = {"Quadrille": "#1f5fa8", "Gmsh, recombined": "#d9822b", "Gmsh, full quad": "#b03a48", "triangles": "#777777"}
MARKERS = {"Quadrille": "o", "Gmsh, recombined": "s", "Gmsh, full quad": "D", "triangles": "^"}


def save(figure, folder, name, formats=("svg", "png")):
    for extension in formats:
        figure.savefig(folder / f"{name}.{extension}", dpi=110, metadata={"Date": None} if extension == "svg" else None)
    plt.close(figure)


def _panel(axes, rows, problem, order):
    known = []
    for mesher in study.MESHERS:
        freedoms, errors = study.series(rows, problem, mesher, order)
        known.append((freedoms, errors))
        axes.loglog(freedoms, errors, marker=MARKERS[mesher], color=COLOURS[mesher], label=mesher, lw=1.4, ms=5)
    ends = np.array([min(f[0] for f, _ in known), max(f[-1] for f, _ in known)])
    low = min(np.min(e * f ** problem.slopes[order]) for f, e in known) * 0.6
    axes.loglog(ends, low * ends ** -problem.slopes[order], "k--", lw=1,
                label=f"theory: dof$^{{-{problem.slopes[order]:g}}}$")
    types = " and ".join(name for _, name in sorted(problem.types[order].items(), reverse=True))
    axes.set_title(f"{problem.title}\n{types}", fontsize=10)
    axes.set_xlabel(f"degrees of freedom ({problem.freedoms} a node)")
    axes.set_ylabel(problem.measure)
    axes.grid(True, which="both", color="#dddddd", lw=0.5)
    axes.legend(fontsize=8)


def errors(rows, problems, folder, name):
    """A row of panels for each problem, first and second order."""
    figure, axes = plt.subplots(len(problems), 2, figsize=(11, 4.6 * len(problems)), squeeze=False)
    for line, problem in zip(axes, problems):
        for panel, order in zip(line, (1, 2)):
            _panel(panel, rows, problem, order)
    figure.tight_layout()
    save(figure, folder, name)


def _outlines(mesh, displacement=None):
    """The outline of each element as polygon, with the middles of its edges."""
    points = mesh.points if displacement is None else mesh.points + displacement
    polygons = []
    for nodes, block in mesh.blocks.items():
        around = [node for begin, _, *middle in elements.edges(nodes) for node in (begin, *middle)]
        polygons += list(points[block[:, around]])
    return polygons


def _nodal_field(axes, mesh, values, levels, cmap):
    """Smooth colours: each element as a fan of triangles round the mean of its corners."""
    triangles, points, colours = [], [mesh.points[:, :2]], [values]
    first = len(mesh.points)
    for nodes, block in mesh.blocks.items():
        around = [node for begin, _, *middle in elements.edges(nodes) for node in (begin, *middle)]
        ring = block[:, around]
        centre = elements.shape(nodes, 0, 0)[0][0]
        points.append(np.einsum("n,end->ed", centre, mesh.points[block, :2]))
        colours.append(values[block] @ centre)
        middle = np.arange(first, first + len(block))
        first += len(block)
        for i in range(ring.shape[1]):
            triangles.append(np.stack([ring[:, i], ring[:, (i + 1) % ring.shape[1]], middle], 1))
    at = np.concatenate(points)
    return axes.tripcolor(at[:, 0], at[:, 1], np.concatenate(triangles), np.concatenate(colours), shading="gouraud",
                          vmin=levels[0], vmax=levels[1], cmap=cmap)


def solutions(plate_mesh, stress, roof_mesh, displacement, folder, name):
    """The stress along the tension on the plate, and the roof as it sags, on our quads of second order."""
    figure = plt.figure(figsize=(13, 5.6))
    axes = figure.add_subplot(1, 2, 1)
    colours = _nodal_field(axes, plate_mesh, stress[:, 0], (-1, 3), "turbo")
    axes.add_collection(LineCollection(_closed(_outlines(plate_mesh)), colors="k", linewidths=0.35))
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title("stress along the tension, over the tension")
    figure.colorbar(colours, ax=axes, shrink=0.8)
    axes = figure.add_subplot(1, 2, 2, projection="3d")
    factor = 10
    polygons = _outlines(roof_mesh, factor * displacement)
    sag = [-displacement[element, 2].mean() for block in roof_mesh.blocks.values() for element in block]
    shown = Poly3DCollection(polygons, edgecolors="k", linewidths=0.25)
    shown.set_array(np.array(sag))
    shown.set_cmap("turbo")
    axes.add_collection3d(shown)
    low, high = roof_mesh.points.min(0), roof_mesh.points.max(0)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_zlim(low[2] - 4, high[2])
    axes.set_box_aspect((high - low + [0, 0, 4]), zoom=0.97)
    axes.view_init(28, -58)
    axes.set_axis_off()
    axes.set_title(f"deflection, drawn {factor} times as large")
    figure.colorbar(shown, ax=axes, shrink=0.8)
    figure.tight_layout()
    save(figure, folder, name, ("png",))


def _closed(polygons):
    return [np.concatenate([polygon, polygon[:1]])[:, :2] for polygon in polygons]


def where_errors_are(panels, folder, name):
    """Panels of a plate: (title, mesh, displacement), round the hole: the error of the stress in each element."""
    figure, axes = plt.subplots(1, len(panels), figsize=(5.4 * len(panels) + 0.8, 5.4), layout="constrained")
    for panel, (title, mesh, displacement) in zip(axes, panels):
        error, energy, area = plate.element_errors(mesh, displacement)
        shown = PolyCollection([polygon[:, :2] for polygon in _outlines(mesh)], cmap="magma_r", edgecolors="#666666",
                               linewidths=0.4)
        mean_stress = np.sqrt(energy.sum() / area.sum())
        shown.set_array(np.sqrt(error / area) / mean_stress)
        shown.set_clim(0, 0.04)
        panel.add_collection(shown)
        panel.set_xlim(-1.75, 1.75)
        panel.set_ylim(-1.75, 1.75)
        panel.set_aspect("equal")
        panel.set_axis_off()
        panel.set_title(title)
    figure.colorbar(shown, ax=axes, shrink=0.9, label="error of the stress over the mean stress")
    save(figure, folder, name, ("png",))
