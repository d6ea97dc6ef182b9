#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What the four stage filters take, against Quad Remesh, and whether they make the same quads.

  PYTHONPATH=build/lib/python3/dist-packages Scripts/study/measure-chain.py MESH... [--quads N] [--threads N]
      [--repeat N]

Each mesh is read once. Then new filters, so that nothing is remembered, run --repeat times, Quad Remesh and the chain
in turn. Printed are the medians of wall and processor seconds, those of each filter, and the ratio of the chain to Quad
Remesh. The exit code is 1 where the bytes of points or quads differ.
"""
import argparse
import pathlib
import resource
import statistics
import sys
import time

from vtkmodules.util.numpy_support import vtk_to_numpy

import quadrille


def processor_seconds():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def timed(run):
    wall, processor = time.perf_counter(), processor_seconds()
    quadrille.check(run)
    return time.perf_counter() - wall, processor_seconds() - processor


def content(quads):
    return (vtk_to_numpy(quads.GetPoints().GetData()).tobytes(),
            vtk_to_numpy(quads.GetPolys().GetConnectivityArray()).tobytes())


def sized(run, arguments):
    run.SetNumberOfThreads(arguments.threads)
    run.SetTargetTypeToNumberOfQuads()
    run.SetNumberOfQuads(arguments.quads)
    return run


def one_click(surface, arguments):
    run = sized(quadrille.vtkQuadRemesh(), arguments)
    run.SetInputData(surface)
    seconds = timed(run)
    return [seconds], content(run.GetOutput())


def chain(surface, arguments):
    hierarchy = sized(quadrille.vtkDecimationHierarchy(), arguments)
    hierarchy.SetInputData(surface)
    grid, upmap, extraction = (kind() for kind in (quadrille.vtkIntegerGridMap, quadrille.vtkIntegerGridMapUpmap,
                                                   quadrille.vtkQuadExtraction))
    for run in (grid, upmap, extraction):
        run.SetNumberOfThreads(arguments.threads)
    grid.SetInputConnection(hierarchy.GetOutputPort(0))
    upmap.SetInputConnection(grid.GetOutputPort())
    upmap.SetInputData(1, surface)
    upmap.SetLogConnection(hierarchy.GetOutputPort(2))
    extraction.SetInputConnection(upmap.GetOutputPort())
    return [timed(run) for run in (hierarchy, grid, upmap, extraction)], content(extraction.GetOutput())


def medians(runs):
    """Of the sums over the filters: wall and processor."""
    return [statistics.median(sum(filter_seconds[k] for filter_seconds in run) for run in runs) for k in (0, 1)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--quads", type=int, default=5000)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--repeat", type=int, default=5)
    arguments = parser.parse_args()
    same = True
    print("| mesh | Quad Remesh, s | processor s | chain, s | processor s | its filters, s | ratio | processor | "
          "same quads |")
    print("|---|---|---|---|---|---|---|---|---|")
    for mesh in arguments.meshes:
        surface = quadrille.read(mesh)
        first, second = [], []
        for _ in range(arguments.repeat):
            seconds, expected = one_click(surface, arguments)
            first.append(seconds)
            seconds, found = chain(surface, arguments)
            second.append(seconds)
            same = same and found == expected
        one, four = medians(first), medians(second)
        filters = ", ".join(f"{statistics.median(run[i][0] for run in second):.2f}" for i in range(4))
        print(f"| {pathlib.Path(mesh).stem} | {one[0]:.2f} | {one[1]:.2f} | {four[0]:.2f} | {four[1]:.2f} | {filters} "
              f"| {four[0] / one[0]:.2f} | {four[1] / one[1]:.2f} | {'yes' if same else 'NO'} |", flush=True)
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
