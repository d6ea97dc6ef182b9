#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""CAD files to quads: what is kept of them, for each file and number of quads.

  cad_table.py BUILD_DIR STEP_DIR [--quads 5000,2000,10000] [--order 1] [--only PART] [--sample 7] [--lost]

Prints a row each: seconds, quads, the share of the length of sharp edges longer than two edge lengths that chains of
the quads' edges cover, the share of their corners that are points of the quads, nodes on the exact shape, and the
distance of nodes from it over the diagonal (99.9 % of them, and the largest), by Testing/Cad/cad_measure. With --lost
also each of these edges that is not kept whole: its id, the length that is not, its length, and its middle; and each
corner that is no point of the quads: its id, its place, and how far the nearest corner is that is one, over the edge
length.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--quads", default="5000,2000,10000")
    parser.add_argument("--order", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--lost", action="store_true")
    parser.add_argument("--sample", type=int, default=7, help="every so manieth node is measured")
    return parser.parse_args()


def covered(line, chords):
    """The length of a polyline that lies between the ends of chords with both ends on it."""
    steps = numpy.linalg.norm(numpy.diff(line, axis=0), axis=1)
    at = numpy.concatenate(([0], numpy.cumsum(steps)))
    closed = numpy.allclose(line[0], line[-1])

    def place(point):
        direction = numpy.diff(line, axis=0)
        t = numpy.clip(numpy.einsum("ij,ij->i", point - line[:-1], direction) /
                       numpy.maximum(steps, 1e-300) ** 2, 0, 1)
        distance = numpy.linalg.norm(line[:-1] + t[:, None] * direction - point, axis=1)
        best = distance.argmin()
        return at[best] + t[best] * steps[best]

    parts = []
    for a, b in chords:
        low, high = sorted((place(a), place(b)))
        if closed and high - low > at[-1] / 2:
            parts += [(0, low), (high, at[-1])]
        else:
            parts.append((low, high))
    total, end = 0.0, 0.0
    for low, high in sorted(parts):
        total += max(0.0, high - max(low, end))
        end = max(end, high)
    return total, at[-1]


def distance_from(line, point):
    """Of a point from a polyline."""
    direction = numpy.diff(line, axis=0)
    squares = numpy.maximum((direction ** 2).sum(axis=1), 1e-300)
    t = numpy.clip(((point - line[:-1]) * direction).sum(axis=1) / squares, 0, 1)
    return numpy.linalg.norm(line[:-1] + t[:, None] * direction - point, axis=1).min()


def chords_of_edges(quads, ends, lines):
    """By edge, pairs of points: sides of quads that run along it. lines: polylines by edge. A side with nodes on one
    edge, or on it and on a vertex, is of that edge; one between two vertices is of the edge that ends there, and one
    between two edges of both where these meet in a vertex, if the middle of the edge, or the vertex, is within a sixth
    of its length from it, as that of an arc is. Also the vertices that are nodes."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    points = vtk_to_numpy(quads.GetPoints().GetData())
    place = vtk_to_numpy(quads.GetPointData().GetArray("CadPlace"))
    ids = vtk_to_numpy(quads.GetPointData().GetArray("CadId"))
    corners = vtk_to_numpy(quads.GetPolys().GetConnectivityArray()).reshape(-1, 4)
    sides = numpy.concatenate([corners[:, [i, (i + 1) % 4]] for i in range(4)])
    sides = numpy.unique(numpy.sort(sides, axis=1), axis=0)
    sides = sides[(place[sides] >= 2).all(axis=1)]
    with_ends = {}
    for edge in lines:
        with_ends.setdefault(frozenset(ends[edge]), []).append(edge)
    chords = {}
    for a, b in sides:
        chord = points[[a, b]]
        near = numpy.linalg.norm(chord[1] - chord[0]) / 6
        found = {ids[i] for i in (a, b) if place[i] == 2}
        if len(found) == 1:
            of = found
        elif not found:
            of = [edge for edge in with_ends.get(frozenset(ids[[a, b]]), ())
                  if distance_from(lines[edge], chord.mean(axis=0)) <= near]
        else:
            first, second = (lines.get(edge) for edge in found)
            shared = set.intersection(*(set(ends[edge]) for edge in found)) - {-1}
            at = [line[k] for edge, line in zip(found, (first, second)) if line is not None
                  for k in (0, -1) if ends[edge][k] in shared]
            of = found if any(distance_from(chord, vertex) <= near for vertex in at) else ()
        for edge in of:
            chords.setdefault(edge, []).append(chord)
    return chords, set(ids[place == 3])


def kept_edges(quads, reader, size):
    """Length kept and length of the sharp edges longer than two edge lengths; corners kept and their number; and rows
    of the edges that are not kept whole, and of the corners."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    edges = reader.GetEdges()
    all_points = vtk_to_numpy(edges.GetPoints().GetData())
    kinds, edge_ids = edges.GetCellData().GetAbstractArray("CadEdgeKind"), edges.GetCellData().GetArray("CadEdgeId")
    lines = {}
    for cell in range(edges.GetNumberOfCells()):
        ids = edges.GetCell(cell).GetPointIds()
        if kinds.GetValue(cell) == "sharp":
            lines[edge_ids.GetValue(cell)] = all_points[[ids.GetId(i) for i in range(ids.GetNumberOfIds())]]
    ends = vtk_to_numpy(reader.GetOutputDataObject(0).GetFieldData().GetArray("CadEdgeEnds"))
    chords, vertices = chords_of_edges(quads, ends, lines)
    kept = length = corners_kept = corners_all = 0
    lost, corners = [], {}
    at_vertices = vtk_to_numpy(quads.GetPoints().GetData())[
        vtk_to_numpy(quads.GetPointData().GetArray("CadPlace")) == 3]
    for edge, line in lines.items():
        if numpy.linalg.norm(numpy.diff(line, axis=0), axis=1).sum() <= 2 * size:
            continue
        part, whole = covered(line, chords.get(edge, []))
        kept, length = kept + part, length + whole
        if part < 0.99 * whole:
            lost.append((edge, whole - part, whole, line[len(line) // 2]))
        if not numpy.allclose(line[0], line[-1]):
            corners_all += 2
            corners_kept += sum(vertex in vertices for vertex in ends[edge])
            for end, vertex in zip((line[0], line[-1]), ends[edge]):
                if vertex not in vertices:
                    corners[vertex] = end, numpy.linalg.norm(at_vertices - end, axis=1).min(initial=numpy.inf) / size
    return (kept, length, corners_kept, corners_all), lost, corners


def distances(measure, part, grid, sample, folder):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    place = vtk_to_numpy(grid.GetPointData().GetArray("CadPlace"))
    ids = vtk_to_numpy(grid.GetPointData().GetArray("CadId"))
    points = vtk_to_numpy(grid.GetPoints().GetData())
    chosen = numpy.flatnonzero(place > 0)[::sample]
    nodes = folder / "nodes.bin"
    numpy.column_stack((points[chosen], place[chosen], ids[chosen])).astype(float).tofile(nodes)
    text = subprocess.run([measure, part, nodes], capture_output=True, text=True, check=True).stdout
    numbers = numpy.array(text.split(), dtype=float)
    return numbers[3:] / numbers[0], numbers[1], numbers[2], (place == 0).sum(), len(place)


def main():
    options = arguments()
    sys.path.insert(0, str(options.build / "lib/python3/dist-packages"))
    import quadrille
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    folder = pathlib.Path(tempfile.mkdtemp())
    measure = options.build / "bin/cad_measure"
    sums = numpy.zeros(4)
    print("file quads_asked seconds quads edges_kept corners_kept nodes_off nodes p999 largest")
    for part in sorted(options.data.iterdir()):
        if options.only not in part.name or part.suffix.lower() not in (".stp", ".step", ".igs", ".iges", ".brep"):
            continue
        for count in options.quads.split(","):
            mesh = folder / ("mesh.vtp" if options.order == 1 else "mesh.vtu")
            start = time.time()
            run = subprocess.run(
                [options.build / "bin/quadrille", part, mesh, "--quads", count, "--order", str(options.order),
                 "--quiet"], capture_output=True, text=True)
            seconds = time.time() - start
            if run.returncode != 0:
                print(part.name, count, f"{seconds:.1f}", "FAILED", run.stderr.strip()[-300:], flush=True)
                continue
            if options.order == 1:
                grid = quadrille.read(mesh)
                size = grid.GetFieldData().GetArray("TargetEdgeLength").GetTuple1(0)
                reader = quadrille.QuadrilleFilters.vtkQuadrilleCADReader()
                reader.SetFileName(str(part))
                reader.JoinPartsOn()
                reader.AddObserver("WarningEvent", lambda caller, event: None)
                reader.Update()
                kept, lost, corners = kept_edges(grid, reader, size)
                sums += kept
            else:
                reader = vtkXMLUnstructuredGridReader()
                reader.SetFileName(str(mesh))
                reader.Update()
                grid, kept, lost, corners = reader.GetOutput(), numpy.ones(4), [], {}
            away, _, _, off, nodes = distances(measure, part, grid, options.sample, folder)
            print(part.name, count, f"{seconds:.1f}", grid.GetNumberOfCells(),
                  f"{kept[0] / kept[1]:.4f}" if kept[1] else "-", f"{kept[2] / kept[3]:.4f}" if kept[3] else "-",
                  off, nodes, f"{numpy.quantile(away, 0.999):.1e}", f"{away.max():.1e}", flush=True)
            for edge, missing, whole, middle in lost if options.lost else []:
                print(f"  lost: edge {edge}, {missing:.3g} of {whole:.3g} at", *(f"{x:.5g}" for x in middle))
            for vertex, (at, distance) in sorted(corners.items()) if options.lost else []:
                print(f"  lost: vertex {vertex} at", *(f"{x:.5g}" for x in at), f"nearest corner {distance:.2f}")
    if options.order == 1 and sums[1]:
        print(f"all: {sums[0] / sums[1]:.4%} of the length, {sums[2] / max(1, sums[3]):.4%} of the corners")


if __name__ == "__main__":
    main()
