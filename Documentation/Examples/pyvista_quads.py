#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Quads in PyVista: its PolyData is a vtkPolyData, so it goes in as it is, and pyvista.wrap() takes the quads.

  pyvista_quads.py SURFACE.ply [--picture QUADS.png]

PyVista has to use the VTK that quadrille was built with: on Debian that of python3-vtk9, as in
  /usr/bin/python3 -m venv --system-site-packages folder && folder/bin/pip install --no-deps pyvista pooch scooby
and not the package vtk of pip, which is another one.
"""
import argparse

import numpy
import pyvista

import quadrille


def remesh(surface, **options):
    """A pyvista.PolyData of quads on one of triangles; its arrays and those of the filter come along."""
    return pyvista.wrap(quadrille.remesh(surface, **options))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("surface")
    parser.add_argument("--picture", metavar="FILE.png")
    chosen = parser.parse_args()

    surface = pyvista.read(chosen.surface)
    surface["height"] = surface.points[:, 2]
    quads = remesh(surface, quads=2000)
    print(f"{quads.n_cells} quads, {quads.n_points} points, arrays {quads.point_data.keys()}")
    corners = quads.points[quads.faces.reshape(-1, 5)[:, 1:]]  # n by 4 by 3
    edges = numpy.linalg.norm(corners - numpy.roll(corners, -1, axis=1), axis=2)
    quads.cell_data["EdgeRatio"] = edges.max(axis=1) / edges.min(axis=1)
    print(f"longest over shortest edge of a quad: {numpy.median(quads.cell_data['EdgeRatio']):.2f} in the middle")

    if chosen.picture:
        plotter = pyvista.Plotter(off_screen=True, window_size=(900, 700))
        plotter.add_mesh(quads, scalars="EdgeRatio", show_edges=True)
        plotter.screenshot(chosen.picture)


if __name__ == "__main__":
    main()
