#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Quads of a trimesh.Trimesh, which goes in as it is; trimesh itself has triangles only, so the quads stay arrays.

  trimesh_quads.py SURFACE.ply [QUADS.obj]

Needs the wheel quadrille-mesh and trimesh.
"""
import sys

import numpy
import trimesh

import quadrille

surface = trimesh.load(sys.argv[1], force="mesh", process=False)
quads = quadrille.remesh(surface, quads=2000)
points, corners = quadrille.to_arrays(quads)
print(f"{len(corners)} quads, {len(points)} points")

# Back to trimesh, for what it measures: each quad as two triangles.
triangles = numpy.concatenate((corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]))
back = trimesh.Trimesh(points, triangles, process=False)
print(f"area {surface.area:.6g} became {back.area:.6g}, watertight: {back.is_watertight}")
if len(sys.argv) > 2:
    quadrille.write(quads, sys.argv[2])
