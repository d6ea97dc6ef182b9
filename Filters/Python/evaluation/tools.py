# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Quad meshes of a surface by this package, by Gmsh, what a user of finite elements would take instead, and figures of
other tools that were taken elsewhere."""
import csv
import os
import shutil
import subprocess
import tempfile
import time

from vtkmodules.vtkFiltersCore import vtkTriangleFilter
from vtkmodules.vtkIOGeometry import vtkSTLWriter

import quadrille

from . import meshes

#: How Gmsh makes quads: pairs of triangles [Remacle et al. 2012], and the same on a mesh twice as coarse whose faces
#: are all cut into quads (Gmsh 4.8 manual, Mesh.RecombinationAlgorithm).
GMSH = (("Gmsh, recombined", 1), ("Gmsh, full quad", 3))
#: Frontal-Delaunay; the variant for quads (8) ends without a mesh on discrete surfaces in Debian 12's version.
TRIANGLES = 6
FEATURE_ANGLE = 40
LIMIT = 300  # seconds

SCRIPT = """Merge "surface.stl";
ClassifySurfaces{{{angle} * Pi / 180, 1, 1, Pi}};
CreateGeometry;
Mesh.MeshSizeMin = {size};
Mesh.MeshSizeMax = {size};
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.Algorithm = {triangles};
Mesh.RecombineAll = 1;
Mesh.RecombinationAlgorithm = {quads};
Mesh.MshFileVersion = 4.1;
"""


def require_gmsh():
    if not shutil.which("gmsh"):
        raise quadrille.InvalidInput("gmsh is not there: install it (apt-get install gmsh), or leave --gmsh out")


def _write_stl(surface, path):
    cut = vtkTriangleFilter()
    cut.SetInputData(surface)
    writer = vtkSTLWriter()
    writer.SetFileTypeToBinary()
    writer.SetFileName(path)
    writer.SetInputConnection(cut.GetOutputPort())
    writer.Write()


def _by_gmsh(surface, edge_length, algorithm):
    """(mesh, seconds). Raises RemeshError with Gmsh's reason."""
    with tempfile.TemporaryDirectory() as folder:
        _write_stl(surface, os.path.join(folder, "surface.stl"))
        with open(os.path.join(folder, "run.geo"), "w", encoding="utf-8") as file:
            file.write(SCRIPT.format(angle=FEATURE_ANGLE, size=edge_length, triangles=TRIANGLES, quads=algorithm))
        start = time.perf_counter()
        try:
            done = subprocess.run(["gmsh", "run.geo", "-2", "-o", "quads.msh", "-v", "2", "-nt", "1"], cwd=folder,
                                  capture_output=True, text=True, timeout=LIMIT, check=False)
        except subprocess.TimeoutExpired as error:
            raise quadrille.RemeshError(f"gmsh: not done after {LIMIT} s") from error
        seconds = time.perf_counter() - start
        output = os.path.join(folder, "quads.msh")
        if done.returncode != 0 or not os.path.isfile(output):
            lines = [line.strip() for line in (done.stderr + done.stdout).splitlines() if line.strip()]
            reason = f": {lines[-1][:200]}" if lines else ""
            raise quadrille.RemeshError(f"gmsh ended with {done.returncode}{reason}")
        try:
            return meshes.read(output), seconds
        except quadrille.InvalidInput as error:
            raise quadrille.RemeshError("gmsh's mesh cannot be used: " + str(error).split(": ", 1)[-1]) from error


def read_figures(path):
    """Rows of a table (CSV) of meshes that others made: `model` and `asked` (the number of quads) say what of, `mesh`
    the tool, the other columns are those of meshes.measure(). Raises InvalidInput."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise quadrille.InvalidInput(f"{path}: cannot be read ({error})") from error
    missing = [name for name in ("model", "asked", "mesh") if not rows or name not in rows[0]]
    if missing:
        raise quadrille.InvalidInput(f"{path}: the table has no column {missing[0]!r}, or no row")
    words = ("model", "mesh", "note")
    for line, row in enumerate(rows, 2):
        for name in [name for name, value in row.items() if value in (None, "")]:
            del row[name]
        for name, value in row.items():
            if name not in words:
                try:
                    row[name] = float(value) if "." in value else int(value)
                except (TypeError, ValueError) as error:
                    raise quadrille.InvalidInput(f"{path}, line {line}: {name} is {value!r}, which is no "
                                                 "number") from error
    return rows


def compare(surface, model, quads, threads=0, tell=print, gmsh=True, figures=()):
    """A row for each tool, as meshes.measure() has it, with `mesh` and `seconds`; a tool that fails has its error.
    figures: rows of read_figures(), of which those of this model and number of quads are put behind."""
    original = meshes.from_poly_data(surface)
    tell(f"{model}: Quadrille")
    start = time.perf_counter()
    made = quadrille.remesh(surface, quads=quads, threads=threads, everything=True)
    seconds = time.perf_counter() - start
    rows = [{"mesh": f"{model}: Quadrille", "seconds": round(seconds, 2),
             **meshes.measure(meshes.from_poly_data(made.quads), original), "error": ""}]
    for name, algorithm in GMSH if gmsh else ():
        tell(f"{model}: {name}")
        row = {"mesh": f"{model}: {name}"}
        try:
            mesh, seconds = _by_gmsh(surface, made.info["TargetEdgeLength"], algorithm)
            row.update(seconds=round(seconds, 2), **meshes.measure(mesh, original))
        except (quadrille.RemeshError, quadrille.InvalidInput) as error:
            row["error"] = str(error)
        rows.append(row)
    for told in figures:
        if told["model"] == model and told["asked"] == quads:
            row = {key: value for key, value in told.items() if key not in ("model", "asked")}
            rows.append({**row, "mesh": f"{model}: {told['mesh']} (table)"})
    return rows
