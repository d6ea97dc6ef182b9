#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""CAD files to quads by Quadrille and by Gmsh, measured alike.

  cad_gmsh_table.py BUILD_DIR STEP_DIR [--quads 2000] [--only PART,PART] [--csv FILE]

Gmsh: Frontal-Delaunay triangles, recombined by Blossom and subdivided, so that all are quads (Mesh.Algorithm 6,
RecombinationAlgorithm 1, SubdivisionAlgorithm 1); its size is corrected twice, so that there are about as many quads,
and the time is that of the last run, with reading. Quadrille: the command with its defaults, one run, with reading.

A row each: seconds; quads; irregular points (other than four quads at a point, all of the surface) in percent; quads
that are turned over at a corner; least and mean scaled Jacobian; the share of the length of sharp edges longer than two
edge lengths that chains of the quads' edges cover; and how far nodes are from the exact shape over its diagonal: by how
much vtkQuadCADProjection moves them (99.9 % of them), and how many it finds no place for.

Needs gmsh (package gmsh).
"""
import argparse
import csv
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy

import cad_table

#: Of the triangles and polylines that quads are compared with, over the diagonal.
CHORD_ERROR = 1e-4
#: Nodes within this of the triangles are measured, over the diagonal; triangles may lie off by more than was asked.
REACH = 1e-3

COLUMNS = ("file", "mesher", "seconds", "quads", "irregular", "inverted", "least", "mean", "edges", "distance", "off")


def gmsh_quads(part, size, folder):
    """Points and quads of a mesh with about this edge length, and the seconds it took."""
    target = folder / "gmsh.msh"
    target.unlink(missing_ok=True)
    options = {"Mesh.Algorithm": 6, "Mesh.RecombineAll": 1, "Mesh.RecombinationAlgorithm": 1,
               "Mesh.SubdivisionAlgorithm": 1, "Mesh.MeshSizeMin": 2 * size, "Mesh.MeshSizeMax": 2 * size}
    command = ["gmsh", part, "-2", "-o", target, "-format", "msh22", "-v", "1"]
    for name, value in options.items():
        command += ["-setnumber", name, str(value)]
    start = time.time()
    subprocess.run(command, capture_output=True, timeout=600, check=False)
    seconds = time.time() - start
    if not target.exists():
        raise RuntimeError("Gmsh wrote no mesh")
    lines = target.read_text().splitlines()
    at = lines.index("$Nodes")
    count = int(lines[at + 1])
    nodes = numpy.array([line.split() for line in lines[at + 2:at + 2 + count]], dtype=float)
    number = {int(tag): i for i, tag in enumerate(nodes[:, 0])}
    at = lines.index("$Elements")
    quads = []
    for line in lines[at + 2:at + 2 + int(lines[at + 1])]:
        words = line.split()
        if words[1] == "3":
            quads.append([number[int(tag)] for tag in words[3 + int(words[2]):]])
        elif words[1] == "2":
            raise RuntimeError("Gmsh left triangles")
    quads = numpy.array(quads)
    used, compact = numpy.unique(quads, return_inverse=True)
    return nodes[used, 1:], compact.reshape(-1, 4), seconds


def gmsh_of_count(part, area, wanted, folder):
    size = (area / wanted) ** 0.5
    for _ in range(2):
        _, quads, _ = gmsh_quads(part, size, folder)
        size *= (len(quads) / wanted) ** 0.5
    return gmsh_quads(part, size, folder)


def shapes(points, quads):
    """Of each quad the least scaled Jacobian of its corners, over the normal of its diagonals."""
    p = points[quads]
    normal = numpy.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
    normal /= numpy.maximum(numpy.linalg.norm(normal, axis=1), 1e-300)[:, None]
    least = numpy.full(len(quads), numpy.inf)
    for i in range(4):
        a, b = p[:, (i + 1) % 4] - p[:, i], p[:, (i + 3) % 4] - p[:, i]
        lengths = numpy.linalg.norm(a, axis=1) * numpy.linalg.norm(b, axis=1)
        least = numpy.minimum(least, (numpy.cross(a, b) * normal).sum(axis=1) / numpy.maximum(lengths, 1e-300))
    return least


def kept_edges(edges, points, sides, size, near):
    """Length kept and length of the sharp edges longer than two edge lengths. A side is on an edge where its ends are
    near it, and its middle within a sixth of its length, as that of an arc is."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    line_points = vtk_to_numpy(edges.GetPoints().GetData())
    kinds = edges.GetCellData().GetAbstractArray("CadEdgeKind")
    kept = length = 0.0
    middles = points[sides].mean(axis=1)
    lengths = numpy.linalg.norm(points[sides[:, 0]] - points[sides[:, 1]], axis=1)

    def distance(line, of):
        direction = numpy.diff(line, axis=0)
        squares = numpy.maximum((direction ** 2).sum(axis=1), 1e-300)
        best = numpy.full(len(of), numpy.inf)
        for a, d, s in zip(line[:-1], direction, squares):
            t = numpy.clip((of - a) @ d / s, 0, 1)
            best = numpy.minimum(best, numpy.linalg.norm(a + t[:, None] * d - of, axis=1))
        return best

    for cell in range(edges.GetNumberOfCells()):
        ids = edges.GetCell(cell).GetPointIds()
        line = line_points[[ids.GetId(i) for i in range(ids.GetNumberOfIds())]]
        if kinds.GetValue(cell) != "sharp" or numpy.linalg.norm(numpy.diff(line, axis=0), axis=1).sum() <= 2 * size:
            continue
        low, high = line.min(axis=0) - near, line.max(axis=0) + near
        boxed = numpy.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
        is_on = numpy.zeros(len(points), bool)
        is_on[boxed] = distance(line, points[boxed]) <= near
        candidates = numpy.flatnonzero(is_on[sides].all(axis=1))
        good = candidates[distance(line, middles[candidates]) <= lengths[candidates] / 6]
        part, whole = cad_table.covered(line, [(points[a], points[b]) for a, b in sides[good]])
        kept, length = kept + part, length + whole
    return kept, length


def measured(quadrille, surface, edges, points, quads):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    mesh = quadrille.to_polydata(points, quads)
    mesh.GetFieldData().ShallowCopy(surface.GetFieldData())
    projection = quadrille.QuadrilleFilters.vtkQuadCADProjection()
    projection.SetReach(REACH)
    projection.SetInputData(mesh)
    projection.Update()
    placed = projection.GetOutputDataObject(0)
    place = vtk_to_numpy(placed.GetPointData().GetArray("CadPlace"))
    # takeVertices moves nodes along edges, which is no distance from the shape.
    moved = numpy.linalg.norm(vtk_to_numpy(placed.GetPoints().GetData()) - points, axis=1)[(place > 0) & (place < 3)]
    quality = shapes(points, quads)
    sides = numpy.unique(numpy.sort(numpy.concatenate([quads[:, [i, (i + 1) % 4]] for i in range(4)]), axis=1), axis=0)
    size = float(numpy.median(numpy.linalg.norm(points[sides[:, 0]] - points[sides[:, 1]], axis=1)))
    kept, length = kept_edges(edges, points, sides, size, 3 * CHORD_ERROR * surface.GetLength())
    valence = numpy.bincount(quads.ravel(), minlength=len(points))
    return {"quads": len(quads), "irregular": f"{100 * (valence != 4).mean():.2f}",
            "inverted": int((quality <= 0).sum()), "least": f"{quality.min():.2f}", "mean": f"{quality.mean():.3f}",
            "edges": f"{100 * kept / length:.1f}" if length else "-",
            "distance": f"{numpy.quantile(moved, 0.999) / surface.GetLength():.0e}", "off": int((place == 0).sum())}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--quads", type=int, default=2000)
    parser.add_argument("--only", default="")
    parser.add_argument("--csv")
    options = parser.parse_args()
    sys.path.insert(0, str(options.build / "lib/python3/dist-packages"))
    import quadrille
    from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: F401, before data of VTK come
    import vtkmodules.vtkIOXML  # noqa: F401

    folder = pathlib.Path(tempfile.mkdtemp())
    rows = []
    for part in sorted(options.data.iterdir()):
        if part.suffix.lower() not in (".stp", ".step") or not any(
                word in part.name for word in options.only.split(",")):
            continue
        reader = quadrille.QuadrilleFilters.vtkQuadrilleCADReader()
        reader.SetFileName(str(part))
        reader.JoinPartsOn()
        reader.SetChordError(CHORD_ERROR)
        reader.AddObserver("WarningEvent", lambda caller, event: None)
        reader.Update()
        surface, edges = reader.GetOutputDataObject(0), reader.GetEdges()
        p, t = quadrille.to_arrays(surface)
        area = numpy.linalg.norm(numpy.cross(p[t[:, 1]] - p[t[:, 0]], p[t[:, 2]] - p[t[:, 0]]), axis=1).sum() / 2

        def ours():
            target = folder / "ours.vtp"
            target.unlink(missing_ok=True)
            start = time.time()
            run = subprocess.run([options.build / "bin/quadrille", part, target, "--quads", str(options.quads),
                                  "--quiet"], capture_output=True, text=True, check=False)
            if not target.exists():
                raise RuntimeError(run.stderr.strip())
            return (*quadrille.to_arrays(quadrille.read(target)), time.time() - start)

        for mesher, make in (("Quadrille", ours),
                             ("Gmsh", lambda: gmsh_of_count(part, area, options.quads, folder))):
            row = {"file": part.name, "mesher": mesher}
            try:
                points, quads, seconds = make()
                row.update(measured(quadrille, surface, edges, points, quads), seconds=f"{seconds:.1f}")
            except (RuntimeError, subprocess.TimeoutExpired) as error:
                row["quads"] = f"none: {str(error)[-120:]}"
            rows.append(row)
            print(" | ".join(str(row.get(name, "")) for name in COLUMNS), flush=True)
    if options.csv:
        with open(options.csv, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS)
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    main()
