#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What noise does to the quads: irregular vertices of the quads of meshes whose points were moved at random, against
those of the meshes as they are. Gaussian in each coordinate, with a standard deviation in mean edge lengths.

  noise_table.py MESH... [--quads N] [--noise X[,X...]] [--seed N] [--limit RATIO] [--json FILE]

Fails where a noisy mesh has more than --limit times the irregular vertices of the clean one, or no quads.
"""
import argparse
import json
import os
import sys

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData

import quadrille


def mean_edge(mesh):
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    faces = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return float(numpy.mean([numpy.linalg.norm(points[faces[:, i]] - points[faces[:, (i + 1) % 3]], axis=1).mean()
                             for i in range(3)]))


def with_noise(mesh, deviation, seed):
    """Each point once: faces keep their points."""
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    points = points + numpy.random.default_rng(seed).normal(0, deviation, points.shape)
    moved = vtkPoints()
    moved.SetDataTypeToDouble()
    moved.SetData(numpy_to_vtk(points, deep=True))
    noisy = vtkPolyData()
    noisy.ShallowCopy(mesh)
    noisy.SetPoints(moved)
    return noisy


def irregular(quads):
    """Points inside of a valence other than 4 and points of the boundary of one other than 3."""
    faces = vtk_to_numpy(quads.GetPolys().GetConnectivityArray()).reshape(-1, 4).astype(numpy.int64)
    count = quads.GetNumberOfPoints()
    ends = numpy.stack((faces.ravel(), numpy.roll(faces, -1, axis=1).ravel()), axis=1)
    ends.sort(axis=1)
    edges, sides = numpy.unique(ends[:, 0] * count + ends[:, 1], return_counts=True)
    valence = numpy.bincount(numpy.concatenate((edges // count, edges % count)), minlength=count)
    boundary = numpy.zeros(count, bool)
    open_edges = edges[sides == 1]
    boundary[numpy.concatenate((open_edges // count, open_edges % count))] = True
    return int((valence != numpy.where(boundary, 3, 4)).sum())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", nargs="+")
    parser.add_argument("--quads", type=int, default=2500)
    parser.add_argument("--noise", default="0.05,0.1,0.2")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--limit", type=float, default=1.3)
    parser.add_argument("--json", help="file for all results")
    arguments = parser.parse_args()
    rows, bad = [], 0
    for name in arguments.mesh:
        mesh = quadrille.read(name)
        edge = mean_edge(mesh)
        clean = None
        for noise in [0.0] + [float(text) for text in arguments.noise.split(",")]:
            row = {"mesh": os.path.basename(name), "noise": noise, "irregular": None, "ratio": None, "why": ""}
            try:
                quads = quadrille.remesh(with_noise(mesh, noise * edge, arguments.seed), quads=arguments.quads)
                row["irregular"] = irregular(quads)
                clean = row["irregular"] if noise == 0 else clean
                row["ratio"] = row["irregular"] / clean if clean else None
            except quadrille.RemeshError as error:
                row["why"] = str(error)
            too_many = row["ratio"] is not None and row["ratio"] > arguments.limit
            bad += 1 if too_many or row["why"] else 0
            print(f"{row['mesh']:>24} {100 * noise:4.0f} %: irregular {row['irregular']}, ratio "
                  f"{'none' if row['ratio'] is None else format(row['ratio'], '.2f')}"
                  f"{' TOO MANY' if too_many else ''} {row['why'][:160]}", flush=True)
            rows.append(row)
    if arguments.json:
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump(rows, file, indent=1)
    print("noise_table: fine" if bad == 0 else f"noise_table: {bad} bad")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
