#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Checks elements of second order against the surface that they were made of, without any code of Quadrille.

    check_second_order.py QUADRILLE MODEL... [--quads 2500] [--nodes 8] [--work FOLDER] [-- OPTIONS OF QUADRILLE]

Runs the command on each model and looks at the VTU file: the determinant of the Jacobian at all nodes and at the 3 by 3
Gauss points, from shape functions in NumPy, against the normal of the straight quad; and the distance of each node from
the input, by VTK's cell locator. Ends with 1 where an element whose corners alone are not inverted has a determinant
that is not positive, or a node farther from the surface than 1e-9 of its diagonal that is not marked as moved off it.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator
from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

READERS = {".ply": vtkPLYReader, ".obj": vtkOBJReader, ".stl": vtkSTLReader, ".vtp": vtkXMLPolyDataReader}
NODES = numpy.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0), (0, 0)], float)


def read(path):
    reader = (vtkXMLUnstructuredGridReader if path.suffix == ".vtu" else READERS[path.suffix])()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def derivatives(count, x, y):
    """d/dx and d/dy of the shape functions, from monomials: the columns of the inverse of their values at the nodes."""
    powers = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (2, 1), (1, 2), (2, 2)][:count]
    values = numpy.array([[a ** i * b ** j for i, j in powers] for a, b in NODES[:count]])
    along = [i * x ** max(i - 1, 0) * y ** j for i, j in powers]
    across = [j * x ** i * y ** max(j - 1, 0) for i, j in powers]
    inverse = numpy.linalg.inv(values)
    return along @ inverse, across @ inverse


def determinants(points, cells):
    """#elements by #places, over the squared length of the straight quad's diagonals."""
    count = cells.shape[1]
    x = points[cells] - points[cells[:, :1]]
    normal = numpy.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1])
    area = numpy.linalg.norm(normal, axis=1, keepdims=True)
    normal = normal / area
    g = numpy.sqrt(0.6)
    places = list(NODES[:count]) + [(a, b) for a in (-g, 0, g) for b in (-g, 0, g)]
    result = []
    for a, b in places:
        along, across = derivatives(count, a, b)
        u = numpy.einsum("n,qnk->qk", along, x)
        v = numpy.einsum("n,qnk->qk", across, x)
        result.append(numpy.einsum("qk,qk->q", numpy.cross(u, v), normal) / area[:, 0])
    corners = [numpy.einsum("qk,qk->q", numpy.cross(x[:, i] - x[:, (i + 3) % 4], x[:, (i + 1) % 4] - x[:, i]), normal)
               for i in range(4)]
    return numpy.array(result).T, numpy.array(corners).T


def distances(surface, points):
    locator = vtkStaticCellLocator()
    locator.SetDataSet(surface)
    locator.BuildLocator()
    foot, cell, sub, square = [0.0] * 3, reference(0), reference(0), reference(0.0)
    result = numpy.empty(len(points))
    for i, p in enumerate(points):
        locator.FindClosestPoint(p, foot, cell, sub, square)
        result[i] = numpy.linalg.norm(p - foot)  # the square itself loses digits
    return result


def check(command, model, arguments, options):
    out = arguments.work / (model.stem + ".vtu")
    report = arguments.work / (model.stem + ".json")
    run = subprocess.run([command, str(model), str(out), "--quads", str(arguments.quads), "--order", "2", "--nodes",
                          str(arguments.nodes), "--report", str(report), "--quiet", *options],
                         capture_output=True, text=True)
    if run.returncode != 0:
        print(f"{model.name}: exit code {run.returncode}: {run.stderr.strip()}")
        return False
    grid, surface = read(out), read(model)
    points = vtk_to_numpy(grid.GetPoints().GetData())
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(grid.GetNumberOfCells(), -1)
    bounds = numpy.array(surface.GetBounds())
    diagonal = numpy.linalg.norm(bounds[1::2] - bounds[::2])
    moved = vtk_to_numpy(grid.GetPointData().GetArray("MovedBack"))
    corners = numpy.unique(cells[:, :4])
    nodes = numpy.unique(cells[:, 4:])
    far = distances(surface, points) / diagonal
    det, straight = determinants(points, cells)
    inverted = (straight <= 0).any(axis=1)
    folded = (det <= 0).any(axis=1) & ~inverted
    on = nodes[moved[nodes] < 2]
    field = grid.GetFieldData()
    number = {name: int(field.GetArray(name).GetTuple1(0)) for name in
              ("NodesMovedAlong", "NodesMovedOff", "NodesByNearest", "EdgesWithoutCurve", "InvertedElements")}
    good = not folded.any() and far[on].max() <= 1e-9 and number["InvertedElements"] == inverted.sum()
    print(f"{model.name}: {len(cells)} elements, {len(nodes)} nodes between corners; least determinant over that of a "
          f"square {4 * det[~inverted].min() * 2:.4f}, folded {folded.sum()}, inverted at corners {inverted.sum()}; "
          f"farthest node {far[on].max():.1e}, corner {far[corners].max():.1e}, diagonals; moved along "
          f"{number['NodesMovedAlong']}, off {number['NodesMovedOff']}, nearest {number['NodesByNearest']}, without "
          f"curve {number['EdgesWithoutCurve']}{'' if good else '  FAILED'}", flush=True)
    return good


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("command")
    arguments.add_argument("models", nargs="+", type=pathlib.Path)
    arguments.add_argument("--quads", type=int, default=2500)
    arguments.add_argument("--nodes", type=int, default=8)
    arguments.add_argument("--work", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "second_order")
    options = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    given = arguments.parse_args(sys.argv[1:sys.argv.index("--")] if "--" in sys.argv else None)
    given.work.mkdir(parents=True, exist_ok=True)
    results = [bool(check(given.command, model, given, options)) for model in given.models]
    print(json.dumps({"models": len(results), "good": sum(results)}))
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
