#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Every model of some folders at several numbers of quads: which runs end with quads of which quality, and after how
many attempts.

  model_table.py QUADRILLE FOLDER... [--quads N,N,N] [--only REGEX] [--jobs N] [--threads N] [--limit SECONDS]
                 [--table FILE.csv] [--json FILE.json] [-- OPTIONS OF THE COMMAND]

A row for each run: exit code, seconds of processor and of the clock, attempts, quads, mean and least scaled Jacobian,
irregular vertices, whether the topology is that of the input less what the report's table of small details lists, and
whether the map on the input has no defect. The topology of the input is counted here, from its triangles with equal
points joined: components, boundary loops and the Euler characteristic; where edges have more than two faces, or the
repair has split vertices, taken faces away or joined points that are not equal, it is not judged. --json keeps the
rows, and those that it has are not made again.
"""
import argparse
import concurrent.futures
import csv
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

import numpy
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkTriangleFilter

import told_details

COUNT_WITHIN = 0.15
FIELDS = ("model", "quads", "code", "processor", "seconds", "attempts", "made", "mean", "least", "inverted",
          "irregular", "topology", "map", "details", "error")


def topology(path):
    """Components, boundary loops and Euler characteristic, or None where an edge has more than two faces."""
    import quadrille
    triangles = vtkTriangleFilter()
    triangles.PassLinesOff()
    triangles.PassVertsOff()
    triangles.SetInputData(quadrille.read(path))
    triangles.Update()
    surface = triangles.GetOutput()
    points = vtk_to_numpy(surface.GetPoints().GetData())
    faces = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3).astype(numpy.int64)
    before = len(points)
    points, joined = numpy.unique(points, axis=0, return_inverse=True)
    equal = before - len(points)
    faces = joined.reshape(-1)[faces]
    whole = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    if not whole.all():
        return None
    used, faces = numpy.unique(faces, return_inverse=True)
    faces = faces.reshape(-1, 3)
    ends = numpy.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges, count = numpy.unique(numpy.sort(ends, axis=1), axis=0, return_counts=True)
    if count.max() > 2:
        return None

    def parts(pairs):
        graph = coo_matrix((numpy.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(used), len(used)))
        number, label = connected_components(graph, directed=False)
        return number, label

    rim = edges[count == 1]
    if len(rim) and numpy.bincount(rim.ravel()).max() > 2:
        return None  # loops that touch at a vertex
    loops = len(numpy.unique(parts(rim)[1][rim.ravel()])) if len(rim) else 0
    return {"components": parts(edges)[0], "loops": loops, "euler": len(used) - len(edges) + len(faces), "equal": equal}


def compare(known, report):
    """Empty where the quads have the topology of the input less the details, "?" where that cannot be told."""
    repair = report["repair"]
    if known is None or any(repair.get(name) for name in (
            "non_manifold_edges", "non_manifold_vertices", "degenerate_faces", "duplicate_faces")):
        return "?"
    if repair.get("merged_points", 0) > known["equal"]:
        return "?"  # points that are only nearly at one place
    wanted = told_details.without(known, report.get("details"))
    quality = report["quality"]
    got = {"components": quality["components"], "loops": quality["boundary_loops"],
           "euler": quality["euler_characteristic"]}
    return ", ".join(f"{name} {got[name]} for {wanted[name]}" for name in wanted if got[name] != wanted[name])


def run_one(arguments, model, quads, known):
    row = {"model": f"{model.parent.name}/{model.name}", "quads": quads}
    with tempfile.TemporaryDirectory() as folder:
        report = os.path.join(folder, "report.json")
        command = [arguments.program, str(model), os.path.join(folder, "quads.obj"), "--quads", str(quads), "--report",
                   report, "--quiet", "--threads", str(arguments.threads), *arguments.options]
        start = time.monotonic()
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=arguments.limit, check=False)
            row["code"], row["error"] = done.returncode, done.stderr.strip()[:300]
        except subprocess.TimeoutExpired:
            row["code"], row["error"] = "limit", f"not done after {arguments.limit} s"
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        row["seconds"] = round(time.monotonic() - start, 2)
        # Of this run alone with one job at a time only.
        row["processor"] = round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 2)
        if not os.path.exists(report):
            return row
        with open(report, encoding="utf-8") as file:
            told = json.load(file)
    row["attempts"] = told.get("attempts")
    quality = told.get("quality")
    if row["code"] == 0 and quality:
        row.update(made=told["quads_actual"], mean=round(quality["mean_scaled_jacobian"], 4),
                   least=round(quality["minimum_scaled_jacobian"], 4), inverted=quality["quads_not_positive"],
                   irregular=quality["irregular_vertices"], topology=compare(known, told),
                   map=told["certificate"]["valid"], details=len(told.get("details", ())))
    return row


def tell(rows):
    def share(text, good, among):
        print(f"{text}: {sum(map(bool, good))} of {len(among)}" + (
            f" ({100 * sum(map(bool, good)) / len(among):.1f} %)" if among else ""))

    made = [row for row in rows if row["code"] == 0]
    share("runs with quads", [row["code"] == 0 for row in rows], rows)
    judged = [row for row in made if row["topology"] != "?"]
    share("topology of the input less the details", [row["topology"] == "" for row in judged], judged)
    share("first attempt holds", [row["attempts"] == 1 for row in made], rows)
    share("map without defect", [row["map"] for row in made], made)
    share("no scaled Jacobian <= 0", [row["inverted"] == 0 for row in made], made)
    share("mean scaled Jacobian >= 0.95", [row["mean"] >= 0.95 for row in made], made)
    share(f"number of quads within {COUNT_WITHIN:.0%}",
          [abs(row["made"] / row["quads"] - 1) <= COUNT_WITHIN for row in made], made)
    print(f"processor seconds: {sum(row['processor'] for row in rows):.0f}, slowest "
          + ", ".join(f"{row['model']}@{row['quads']} {row['processor']:.1f}"
                      for row in sorted(rows, key=lambda row: -row["processor"])[:8]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", nargs="+", type=pathlib.Path)
    parser.add_argument("--quads", default="1000,2500,10000")
    parser.add_argument("--only", default="")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--limit", type=float, default=120)
    parser.add_argument("--table")
    parser.add_argument("--json")
    own = sys.argv[1:]
    options = own[own.index("--") + 1:] if "--" in own else []
    arguments = parser.parse_args(own[:own.index("--")] if "--" in own else own)
    arguments.options = options
    models = sorted(path for folder in arguments.folder for path in folder.iterdir()
                    if path.suffix in (".ply", ".obj", ".off", ".stl", ".vtp", ".vtk") and
                    re.search(arguments.only, path.name))
    if not models:
        parser.error("no models in these folders")
    rows = {}
    if arguments.json and os.path.exists(arguments.json):
        with open(arguments.json, encoding="utf-8") as file:
            rows = {(row["model"], row["quads"]): row for row in json.load(file)}
    runs = [(model, int(quads)) for quads in arguments.quads.split(",") for model in models
            if (f"{model.parent.name}/{model.name}", int(quads)) not in rows]
    shapes = {model: topology(str(model)) for model in {model for model, _ in runs}}
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        pending = [pool.submit(run_one, arguments, model, quads, shapes[model]) for model, quads in runs]
        for run in concurrent.futures.as_completed(pending):
            row = run.result()
            rows[row["model"], row["quads"]] = row
            print(" ".join(f"{name}={row[name]}" for name in FIELDS if row.get(name) not in (None, "")), flush=True)
            if arguments.json:
                with open(arguments.json, "w", encoding="utf-8") as file:
                    json.dump(list(rows.values()), file, indent=0)
    if arguments.table:
        with open(arguments.table, "w", newline="", encoding="utf-8") as file:
            table = csv.DictWriter(file, FIELDS, extrasaction="ignore")
            table.writeheader()
            table.writerows(rows.values())
    tell(list(rows.values()))


if __name__ == "__main__":
    main()
