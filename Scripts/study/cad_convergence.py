#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Area and volume of elements against those of the exact shape, as the edge length is halved.

  cad_convergence.py BUILD_DIR FILE... [--quads 500,2000,8000] [--follow all]

Elements of first and of second order with nodes on the exact shape, integrated with 4 by 4 Gauss points. The exact
values are those of Open CASCADE, by Testing/Cad/cad_measure. With --follow all no element lies over a tangent edge,
where the curvature jumps: elements of second order that do are wrong by the cube of the edge length, others by its
fourth power.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

import numpy


def shape_functions(nodes, x, y):
    """Values and both derivatives of the functions of 4 or 8 nodes."""
    corners = numpy.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    value, dx, dy = numpy.zeros(nodes), numpy.zeros(nodes), numpy.zeros(nodes)
    for i, (a, b) in enumerate(corners):
        if nodes == 4:
            value[i], dx[i], dy[i] = (1 + a * x) * (1 + b * y) / 4, a * (1 + b * y) / 4, b * (1 + a * x) / 4
        else:
            value[i] = (1 + a * x) * (1 + b * y) * (a * x + b * y - 1) / 4
            dx[i] = a * (1 + b * y) * (2 * a * x + b * y) / 4
            dy[i] = b * (1 + a * x) * (a * x + 2 * b * y) / 4
    if nodes == 8:
        for i, (a, b) in enumerate(((0, -1), (1, 0), (0, 1), (-1, 0)), 4):
            if a == 0:
                value[i], dx[i], dy[i] = (1 - x * x) * (1 + b * y) / 2, -x * (1 + b * y), b * (1 - x * x) / 2
            else:
                value[i], dx[i], dy[i] = (1 - y * y) * (1 + a * x) / 2, a * (1 - y * y) / 2, -y * (1 + a * x)
    return value, dx, dy


def area_and_volume(points, cells):
    area = volume = 0
    places, weights = numpy.polynomial.legendre.leggauss(4)
    for x, wx in zip(places, weights):
        for y, wy in zip(places, weights):
            value, dx, dy = shape_functions(cells.shape[1], x, y)
            at = numpy.einsum("k,ekd->ed", value, points[cells])
            normal = numpy.cross(numpy.einsum("k,ekd->ed", dx, points[cells]),
                                 numpy.einsum("k,ekd->ed", dy, points[cells]))
            area += wx * wy * numpy.linalg.norm(normal, axis=1).sum()
            volume += wx * wy * numpy.einsum("ed,ed->", at, normal) / 3
    return area, volume


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    parser.add_argument("--quads", default="500,2000,8000")
    parser.add_argument("--follow", default="sharp", choices=("sharp", "all"))
    options = parser.parse_args()
    sys.path.insert(0, str(options.build / "lib/python3/dist-packages"))
    import quadrille
    import vtkmodules.vtkIOXML  # noqa: F401, so that Python knows the class of the reader
    from vtkmodules.util.numpy_support import vtk_to_numpy

    folder = pathlib.Path(tempfile.mkdtemp())
    (folder / "none.bin").write_bytes(b"")
    print("file order quads area_error volume_error area_ratio volume_ratio")
    for part in options.files:
        text = subprocess.run([options.build / "bin/cad_measure", part, folder / "none.bin"], capture_output=True,
                              text=True, check=True).stdout
        _, area, volume = (float(word) for word in text.split()[:3])
        for order in (1, 2):
            before = None
            for count in options.quads.split(","):
                mesh = folder / "mesh.vtu"
                run = subprocess.run(
                    [options.build / "bin/quadrille", part, mesh, "--quads", count, "--order", str(order), "--quiet",
                     "--cad-chord-error", "0.0001", "--cad-follow", options.follow], capture_output=True, text=True)
                if run.returncode != 0:
                    print(part.name, order, count, "FAILED", run.stderr.strip()[-200:])
                    continue
                reader = quadrille.vtkQuadrilleOFFReader.NewXMLReader(".vtu")
                reader.SetFileName(str(mesh))
                reader.Update()
                grid = reader.GetOutput()
                cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(grid.GetNumberOfCells(), -1)
                found = area_and_volume(vtk_to_numpy(grid.GetPoints().GetData()), cells)
                error = abs(found[0] / area - 1), abs(found[1] / volume - 1)
                # Ratios for a halving of the edge length, whatever the number of quads came to be.
                ratio = ["-", "-"]
                if before:
                    steps = 0.5 * numpy.log2(len(cells) / before[0])
                    ratio = [f"{(before[1][k] / error[k]) ** (1 / steps):.1f}" for k in (0, 1)]
                print(part.name, order, len(cells), f"{error[0]:.2e} {error[1]:.2e}", *ratio, flush=True)
                before = len(cells), error


if __name__ == "__main__":
    main()
