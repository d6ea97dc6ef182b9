#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Quads in PyVista from arrays: with the wheel quadrille-mesh any VTK that PyVista uses will do.

  pyvista_arrays.py SURFACE.ply [--picture QUADS.png]
"""
import argparse

import numpy
import pyvista

import quadrille


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("surface")
    parser.add_argument("--picture", metavar="FILE.png")
    chosen = parser.parse_args()

    surface = pyvista.read(chosen.surface)
    points, corners = quadrille.to_arrays(quadrille.remesh((surface.points, surface.faces.reshape(-1, 4)), quads=2000))
    faces = numpy.insert(corners, 0, 4, axis=1)  # PyVista has the number of corners before them
    quads = pyvista.PolyData(points, faces.ravel())
    print(f"{quads.n_cells} quads, {quads.n_points} points")

    # The data set itself goes in, too, and comes out as VTK's, with its arrays.
    surface["height"] = surface.points[:, 2]
    whole = pyvista.wrap(quadrille.remesh(surface, quads=2000))
    print(f"{whole.n_cells} quads with {whole.point_data.keys()}")
    if chosen.picture:
        plotter = pyvista.Plotter(off_screen=True, window_size=(900, 700))
        plotter.add_mesh(whole, scalars="height", show_edges=True)
        plotter.screenshot(chosen.picture)


if __name__ == "__main__":
    main()
