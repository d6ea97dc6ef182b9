#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Quads by NumPy alone: arrays in, arrays out.

  numpy_quads.py SURFACE.ply [QUADS.obj]

Needs the wheel quadrille-mesh, and nothing else.
"""
import sys

import numpy

import quadrille

surface = quadrille.read(sys.argv[1])
points, triangles = surface
height = points[:, 2]
# Edges half as long in the upper half of the surface.
sizing = numpy.where(height > numpy.median(height), 0.5, 1.0)
mesh = quadrille.Mesh(points, triangles, point_data={"height": height})
quads = quadrille.remesh(mesh, quads=2000, sizing=sizing)

points, corners = quads
print(f"{len(corners)} quads, {len(points)} points, arrays {list(quads.point_data)}")
print(f"certificate: {quadrille.info(quads)['Certificate']}")
if len(sys.argv) > 2:
    quadrille.write(quads, sys.argv[2])
