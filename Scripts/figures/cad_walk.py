#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Goes from a STEP file to a solved shell: quads by Quadrille, displacements by CalculiX, at two sizes, and a picture.

  Scripts/figures/cad_walk.py OUT [--quads N] [--picture FILE.png] [--quadrille PATH]

The part is Data/bracket.step. The quads are elements S8R, half as long at the bore (a size by name). The face 'support'
is held, a force along the axis of the bore is spread over the nodes of the face 'bore'; both are node sets that the
mesh's file has. OUT gets meshes, decks and results: of N quads (1,000), and of four times as many, whose edges are half
as long. Ends with an error where CalculiX has a warning about a deck, or where the forces at the support are not those
of the load. Takes half a minute.

Needs ccx (Debian: calculix-ccx), numpy, matplotlib for the picture, and a build of Quadrille with Open CASCADE in
build/ (or --quadrille PATH).
"""
import argparse
import pathlib
import re
import shutil
import sys

import numpy as np

from simulation import calculix, elements, meshes

ROOT = pathlib.Path(__file__).resolve().parents[2]
PART = ROOT / "Data" / "bracket.step"
# The file is in millimetres, so forces are in newton, and stresses and moduli in megapascal.
THICKNESS = 0.1  # mm
FORCE = 10.0  # N, against the z-axis
HELD, LOADED = "SUPPORT", "BORE"  # as they are called in the deck
DECK = """*INCLUDE, INPUT={mesh}
*MATERIAL, NAME=STEEL
*ELASTIC
210000., 0.3
*SHELL SECTION, ELSET=EALL, MATERIAL=STEEL
{thickness}
*BOUNDARY
SUPPORT, 1, 6
*STEP
*STATIC
*CLOAD
BORE, 3, {force:.10g}
*NODE PRINT, NSET=NALL
U
*NODE PRINT, NSET=SUPPORT, TOTALS=ONLY
RF
*NODE FILE, OUTPUT=2D
U
*EL FILE, OUTPUT=2D
S
*END STEP"""


class WalkError(RuntimeError):
    """What came is not what the deck asks for."""


class Solved:
    """A mesh of about so many quads, and its displacements in mm."""

    def __init__(self, program, folder, quads):
        self.job = f"bracket_{quads}"
        file = folder / f"{self.job}_mesh.inp"
        meshes.run([program, PART, file, "--quads", quads, "--order", 2, "--size", "bore=0.5"], folder)
        self.mesh = meshes.read_inp(file)
        missing = {HELD, LOADED} - self.mesh.node_sets.keys()
        if missing:
            raise WalkError(f"{file} has no node set {' and '.join(sorted(missing))}")
        # The load of a node set is that of each of its nodes.
        self.force_of_node = -FORCE / len(self.mesh.node_sets[LOADED])
        deck = DECK.format(mesh=file.name, thickness=THICKNESS, force=self.force_of_node)
        calculix.write(folder, self.job, [deck])
        calculix.solve(folder, self.job)
        self.displacements = calculix.displacements(folder, self.job, self.mesh)
        self.reaction = total_force(folder / f"{self.job}.dat")
        if not np.allclose(self.reaction, (0, 0, FORCE), atol=1e-6 * FORCE):
            raise WalkError(f"{self.job}: the support gives {self.reaction} N, which is not the load")

    def largest(self):
        return float(np.linalg.norm(self.displacements, axis=1).max())


def total_force(path):
    text = path.read_text(encoding="utf-8")
    return np.array(re.search(r"total force .*\n\n(.*)\n", text).group(1).split(), float)


def draw(solved, path):
    """The part as it was, in lines, and as it is under load, in colours of the displacement."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot as plt
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    mesh, moved = solved.mesh, solved.displacements
    factor = float(f"{0.5 / solved.largest():.0e}")  # about half a millimetre
    around = [node for begin, _, middle in elements.edges(8) for node in (begin, middle)]
    rings = mesh.blocks[8][:, around]
    figure = plt.figure(figsize=(10, 7))
    axes = figure.add_axes((-0.03, -0.1, 0.92, 1.2), projection="3d")
    shown = Poly3DCollection((mesh.points + factor * moved)[rings], edgecolors="k", linewidths=0.4)
    shown.set_array(1000 * np.linalg.norm(moved, axis=1)[rings].mean(1))
    shown.set_cmap("turbo")
    axes.add_collection3d(shown)
    low, high = mesh.points.min(0), mesh.points.max(0)
    axes.add_collection3d(Line3DCollection(seen_edges(low, high), colors="#555555", linewidths=1.2, linestyles="--"))
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low, zoom=0.95)
    axes.view_init(34, -52)
    axes.set_axis_off()
    bar = figure.colorbar(shown, cax=figure.add_axes((0.87, 0.18, 0.025, 0.62)))
    bar.set_label("displacement, µm", fontsize=15)
    bar.ax.tick_params(labelsize=14)
    figure.text(0.03, 0.06, f"drawn {factor:g} times as large\ndashed: without the load", fontsize=15)
    figure.savefig(path, dpi=100)
    plt.close(figure)


def seen_edges(low, high):
    """Edges of a box but those of the corner that is farthest from the camera, at low x, high y, low z."""
    hidden = 2
    corners = [np.where([i & 1, i & 2, i & 4], high, low) for i in range(8)]
    ends = [(i, i | bit) for i in range(8) for bit in (1, 2, 4) if not i & bit]
    return [(corners[i], corners[j]) for i, j in ends if hidden not in (i, j)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path, help="folder, made if it is not there")
    parser.add_argument("--quads", type=int, default=1000)
    parser.add_argument("--picture", type=pathlib.Path, help="PNG file of the coarser mesh; none is drawn without")
    parser.add_argument("--quadrille", type=pathlib.Path, default=ROOT / "build" / "bin" / "quadrille")
    chosen = parser.parse_args()
    for program, remedy in (("ccx", "apt-get install calculix-ccx"),
                            (str(chosen.quadrille), "build it, or give --quadrille")):
        if not shutil.which(program):
            parser.error(f"{program} is not there: {remedy}")
    folder = chosen.out.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    try:
        coarse, fine = (Solved(chosen.quadrille.resolve(), folder, quads) for quads in (chosen.quads, 4 * chosen.quads))
    except (calculix.SolverError, meshes.MesherError, WalkError) as error:
        print(f"cad_walk: {error}", file=sys.stderr)
        return 1
    for solved in (coarse, fine):
        print(f"{solved.mesh.count()} quads: {len(solved.mesh.node_sets[LOADED])} nodes of the bore with "
              f"{solved.force_of_node:.4g} N each, largest displacement {1000 * solved.largest():.2f} micrometres")
    print(f"difference: {100 * abs(fine.largest() / coarse.largest() - 1):.1f} %")
    if chosen.picture:
        draw(coarse, chosen.picture)
    return 0


if __name__ == "__main__":
    sys.exit(main())
