#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Quads in vedo (Debian: python3-vedo): its meshes are VTK's data, which go in and come out as they are.

  vedo_quads.py SURFACE.ply [--picture QUADS.png]

With --picture, which needs a display (xvfb-run): the quads, coloured by the ratio of their edges.
"""
import argparse

import numpy
import vedo

import quadrille


def remesh(surface, **options):
    """A vedo.Mesh of quads on a vedo.Mesh of triangles; its arrays and those of the filter come along."""
    return vedo.Mesh(quadrille.remesh(surface.polydata(), **options))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("surface")
    parser.add_argument("--picture", metavar="FILE.png")
    chosen = parser.parse_args()

    surface = vedo.load(chosen.surface)
    surface.pointdata["height"] = surface.points()[:, 2]
    quads = remesh(surface, quads=2000)
    print(f"{quads.ncells} quads, {quads.npoints} points, arrays {quads.pointdata.keys()}")
    corners = quads.points()[numpy.array(quads.faces())]  # n by 4 by 3
    edges = numpy.linalg.norm(corners - numpy.roll(corners, -1, axis=1), axis=2)
    quads.celldata["EdgeRatio"] = edges.max(axis=1) / edges.min(axis=1)
    print(f"longest over shortest edge of a quad: {numpy.median(quads.celldata['EdgeRatio']):.2f} in the middle")

    if chosen.picture:
        quads.cmap("viridis", "EdgeRatio", on="cells").add_scalarbar("edge ratio").lc("black").lw(1)
        vedo.Plotter(offscreen=True, size=(900, 700)).show(quads, viewup="z").screenshot(chosen.picture)


if __name__ == "__main__":
    main()
