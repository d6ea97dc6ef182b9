#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What the detection of features brings: on scans it should cost nothing, on parts it should keep every crease.

  Scripts/study/crease_table.py --command BIN/quadrille --judge QUADSTATS --scans FOLDER --parts FOLDER [--quads N,N]
                                [--modes NAME,NAME] [--only REGEX] [--table FILE.csv]

Each scan of the one folder and each part of the other is remeshed with each mode (automatic, angle, off) and each
number of quads. QUADSTATS is a script that is called as `QUADSTATS QUADS.obj --no-distance` and prints JSON. The table
has irregular vertices, mean and least scaled Jacobian, seconds, and `creases`: the share of the creases' length that
lies on edges of the quads. A scan is judged against `off` (mean at most 2 % less, least at most 0.05 less, irregular
vertices at most 2 % and 2 more), a part by `creases` (at least 98 %).

A crease is found here from the triangles alone: edges with a dihedral angle above 40 degrees, traced between the
vertices where other than two of them meet and on through these where one goes straight on (within 30 degrees). Such a
curve is one where it is longer than 3 s, at most 1.1 times as long as the polyline through its points s apart, and
stands out: round each of its places the normals of the surface within s / 2 are in two heaps, those nearer to the
normal of either side; their mean angle to the mean of their heap is at most 0.06 of the angle between the means (a
surface bent evenly has 0.25), and that at least half the dihedral angle, in the median of places. What is longer but
does not stand out is told as `doubtful`, in edge lengths. A sample of a crease, ten to an edge length, is on the
quads where an edge within 0.1 s has its direction within 20 degrees.
"""
import argparse
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

import numpy
from scipy.spatial import cKDTree

ANGLE = 40
LONGEST_IN_S, JAGGED, STRAIGHT = 3.0, 1.1, 30
NEAR, ALONG = 0.1, 20
SAMPLES = 10
MOST_SPREAD, LEAST_WIDE = 0.06, 0.5
DENSITY, MOST_SAMPLES, PLACES = 60, 1000000, 60  # samples of the surface in s * s; at most; places on a curve
MODES = {"automatic": [], "angle": ["--feature-criterion", "angle"], "off": ["--feature-angle", "0"]}
SCAN_MEAN, SCAN_LEAST, SCAN_IRREGULAR, PART_SHARE = 0.02, 0.05, 0.02, 0.98


def read_triangles(path):
    """Points and triangles of a PLY file, coincident points joined."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersCore import vtkTriangleFilter
    from vtkmodules.vtkIOPLY import vtkPLYReader
    reader = vtkPLYReader()
    reader.SetFileName(str(path))
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(reader.GetOutputPort())
    triangles.Update()
    surface = triangles.GetOutput()
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    faces = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3).astype(numpy.int64)
    points, joined = numpy.unique(points, axis=0, return_inverse=True)
    faces = joined.reshape(-1)[faces]
    whole = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return points, faces[whole]


def read_quads(path):
    points, edges = [], set()
    for line in open(path, encoding="utf-8"):
        words = line.split()
        if words and words[0] == "v":
            points.append([float(x) for x in words[1:4]])
        elif words and words[0] == "f":
            corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            for a, b in zip(corners, corners[1:] + corners[:1]):
                edges.add((min(a, b), max(a, b)))
    return numpy.array(points), numpy.array(sorted(edges))


def sharp_edges(points, faces):
    """Pairs of points where two faces meet at more than ANGLE, lower first, and the normals of both faces."""
    cross = numpy.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]])
    size = numpy.linalg.norm(cross, axis=1)
    normals = cross / numpy.maximum(size, 1e-300)[:, None]
    longest = numpy.max([numpy.linalg.norm(points[faces[:, i]] - points[faces[:, i - 1]], axis=1) for i in range(3)],
                        axis=0)
    # The normal of a sliver is noise, and so is every angle with it.
    reliable = size > 1e-3 * longest ** 2
    edges = numpy.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    owner = numpy.tile(numpy.arange(len(faces)), 3)
    edges.sort(axis=1)
    order = numpy.lexsort((edges[:, 1], edges[:, 0]))
    edges, owner = edges[order], owner[order]
    first = numpy.flatnonzero(numpy.concatenate([[True], numpy.any(edges[1:] != edges[:-1], axis=1)]))
    count = numpy.diff(numpy.append(first, len(edges)))
    pairs = first[count == 2]
    a, b = owner[pairs], owner[pairs + 1]
    sharp = (numpy.einsum("ij,ij->i", normals[a], normals[b]) < numpy.cos(numpy.radians(ANGLE)))
    kept = sharp & reliable[a] & reliable[b]
    return edges[pairs[kept]], normals[a[kept]], normals[b[kept]]


class Curves:
    """Sharp edges as paths of points."""

    def __init__(self, points, edges, s):
        self.points, self.s = points, s
        self.at = {}
        for number, (a, b) in enumerate(edges):
            self.at.setdefault(a, []).append((number, b))
            self.at.setdefault(b, []).append((number, a))
        self.edges = edges
        self.partners = {}

    def course(self, v, number):
        """Direction from v along edge `number` and on to the next junction, at most s."""
        start, walked, first = v, 0.0, number
        while True:
            w = next(other for n, other in self.at[v] if n == number)
            walked += numpy.linalg.norm(self.points[w] - self.points[v])
            v = w
            if walked >= self.s or len(self.at[v]) != 2:
                break
            number = next(n for n, _ in self.at[v] if n != number)
            if number == first:
                break
        direction = self.points[v] - self.points[start]
        return direction / max(numpy.linalg.norm(direction), 1e-300)

    def onwards(self, v, number):
        if len(self.at[v]) == 2:
            return next((n for n, _ in self.at[v] if n != number), None)
        if v not in self.partners:
            ways = {n: self.course(v, n) for n, _ in self.at[v]}
            best = {}
            for n, way in ways.items():
                rest = [(-way @ ways[m], m) for m in ways if m != n]
                if rest and max(rest)[0] > numpy.cos(numpy.radians(STRAIGHT)):
                    best[n] = max(rest)[1]
            self.partners[v] = {n: m for n, m in best.items() if best.get(m) == n}
        return self.partners[v].get(number)

    def paths(self):
        done = set()
        for number, (a, b) in enumerate(self.edges):
            if number in done:
                continue
            done.add(number)
            ways = []
            for start in (b, a):
                way, v, current = [start], start, number
                while True:
                    current = self.onwards(v, current)
                    if current is None or current in done:
                        break
                    done.add(current)
                    v = next(other for n, other in self.at[v] if n == current)
                    way.append(v)
                ways.append(way)
            yield ways[1][::-1] + ways[0]


def resampled(path, step):
    lengths = numpy.linalg.norm(numpy.diff(path, axis=0), axis=1)
    at = numpy.concatenate([[0], numpy.cumsum(lengths)])
    wanted = numpy.append(numpy.arange(0, at[-1], step), at[-1])
    return numpy.stack([numpy.interp(wanted, at, path[:, k]) for k in range(3)], axis=1), at[-1]


def surface_samples(points, faces, s):
    """Points spread evenly over the surface, and the normals there."""
    a, b, c = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
    cross = numpy.cross(b - a, c - a)
    double = numpy.linalg.norm(cross, axis=1)
    count = int(min(MOST_SAMPLES, DENSITY * 0.5 * double.sum() / s ** 2))
    random = numpy.random.default_rng(0)
    chosen = random.choice(len(faces), size=count, p=double / double.sum())
    u, v = random.random((2, count, 1))
    outside = u + v > 1
    u, v = numpy.where(outside, 1 - u, u), numpy.where(outside, 1 - v, v)
    return a[chosen] + u * (b - a)[chosen] + v * (c - a)[chosen], cross[chosen] / double[chosen, None]


def stands_out(line, sides, tree, normals, s):
    """Whether the normals beside a curve are in two heaps. sides: its edges' middles and the two normals of each."""
    middles, left, right = sides
    places = resampled(line, s / 2)[0]
    places = places[numpy.linspace(0, len(places) - 1, min(len(places), PLACES)).astype(int)]
    spreads, wides = [], []
    _, edge_at = cKDTree(middles).query(places)
    for near, edge in zip(tree.query_ball_point(places, s / 2), edge_at):
        here = normals[near]
        to_left = here @ left[edge] > here @ right[edge]
        if to_left.sum() < 3 or (~to_left).sum() < 3:
            continue
        means = [heap.mean(axis=0) / max(numpy.linalg.norm(heap.mean(axis=0)), 1e-300)
                 for heap in (here[to_left], here[~to_left])]
        own = numpy.arccos(numpy.clip(left[edge] @ right[edge], -1, 1))
        between = numpy.arccos(numpy.clip(means[0] @ means[1], -1, 1))
        spread = [numpy.arccos(numpy.clip(heap @ mean, -1, 1)).mean()
                  for heap, mean in zip((here[to_left], here[~to_left]), means)]
        spreads.append(numpy.mean(spread) / max(between, 1e-3))
        wides.append(between / own)
    return bool(spreads) and numpy.median(spreads) <= MOST_SPREAD and numpy.median(wides) >= LEAST_WIDE


def creases(points, faces, s):
    """Long smooth curves of sharp edges that stand out, each as points along it; and the length of those that do not,
    over s."""
    edges, left, right = sharp_edges(points, faces)
    middles = 0.5 * (points[edges[:, 0]] + points[edges[:, 1]])
    samples, normals = surface_samples(points, faces, s)
    tree = cKDTree(samples)
    found, doubtful = [], 0.0
    number = {tuple(edge): i for i, edge in enumerate(edges.tolist())}
    for path in Curves(points, edges, s).paths():
        line = points[path]
        stepped, length = resampled(line, s)
        chords = numpy.linalg.norm(numpy.diff(stepped, axis=0), axis=1).sum()
        if length <= LONGEST_IN_S * s or length > JAGGED * chords:
            continue
        own = [number[min(a, b), max(a, b)] for a, b in zip(path, path[1:])]
        if stands_out(line, (middles[own], left[own], right[own]), tree, normals, s):
            found.append(line)
        else:
            doubtful += length / s
    return found, doubtful


def share_on_quads(curves, points, edges, s):
    """Of the length of the curves, that on edges of the quads; None without curves."""
    if not curves:
        return None, 0.0
    a, b = points[edges[:, 0]], points[edges[:, 1]]
    parts = 40
    weights = (numpy.arange(parts + 1) / parts)[None, :, None]
    on_edges = (a[:, None] * (1 - weights) + b[:, None] * weights).reshape(-1, 3)
    owner = numpy.repeat(numpy.arange(len(edges)), parts + 1)
    direction = (b - a) / numpy.maximum(numpy.linalg.norm(b - a, axis=1), 1e-300)[:, None]
    tree = cKDTree(on_edges)
    hit = total = 0
    for line in curves:
        samples, _ = resampled(line, s / SAMPLES)
        middles = 0.5 * (samples[1:] + samples[:-1])
        along = samples[1:] - samples[:-1]
        length = numpy.linalg.norm(along, axis=1)
        along /= numpy.maximum(length, 1e-300)[:, None]
        total += length.sum()
        for i, near in enumerate(tree.query_ball_point(middles, NEAR * s)):
            lies = near and numpy.max(numpy.abs(direction[owner[near]] @ along[i])) > numpy.cos(numpy.radians(ALONG))
            hit += length[i] if lies else 0
    return hit / total, total / s


def measure(arguments, path, mode, quads, is_part):
    row = {"kind": "part" if is_part else "scan", "model": path.stem, "quads": quads, "mode": mode}
    with tempfile.TemporaryDirectory() as folder:
        made, report = pathlib.Path(folder) / "quads.obj", pathlib.Path(folder) / "report.json"
        start = time.monotonic()
        try:
            run = subprocess.run([arguments.command, str(path), str(made), "--quads", str(quads), "--threads", "1",
                                  "--report", str(report), *MODES[mode]],
                                 capture_output=True, text=True, timeout=arguments.limit, check=False)
            code = run.returncode
        except subprocess.TimeoutExpired:
            code = "timeout"
        row.update(code=code, seconds=round(time.monotonic() - start, 1))
        if code != 0:
            return row
        told = subprocess.run([sys.executable, arguments.judge, str(made), "--no-distance"], capture_output=True,
                              text=True, check=True)
        judged = json.loads(told.stdout)
        row.update(judged_columns(judged))
        notices = json.loads(report.read_text()).get("notices", [])
        row["told"] = " | ".join(text for text in notices if "crease" in text or "sharp edge" in text)
        if is_part:
            points, faces = read_triangles(path)
            cross = numpy.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]])
            s = numpy.sqrt(0.5 * numpy.linalg.norm(cross, axis=1).sum() / quads)
            found, doubtful = creases(points, faces, s)
            share, length = share_on_quads(found, *read_quads(made), s)
            row.update(creases=None if share is None else round(share, 4), crease_length=round(length, 1),
                       doubtful=round(doubtful, 1))
    return row


def judged_columns(judged):
    valence, quality = judged["valence"], judged["quality"]
    return {"made": judged["counts"]["quads"],
            "irregular": valence["irregular_interior"] + valence["irregular_boundary"],
            "mean": round(quality["scaled_jacobian_mean"], 4), "least": round(quality["scaled_jacobian_min"], 3)}


def verdict(row, off):
    """Empty, or what falls short."""
    if row["code"] != 0:
        return f"ends with {row['code']}"
    if row["kind"] == "part":
        share = row.get("creases")
        return f"{100 * (1 - share):.1f} % of the creases missed" if share is not None and share < PART_SHARE else ""
    if not off or off["code"] != 0:
        return ""
    short = []
    if row["irregular"] > off["irregular"] * (1 + SCAN_IRREGULAR) + 2:
        short.append(f"irregular {row['irregular']} > {off['irregular']}")
    if row["mean"] < off["mean"] * (1 - SCAN_MEAN):
        short.append(f"mean {row['mean']} < {off['mean']}")
    if row["least"] < off["least"] - SCAN_LEAST:
        short.append(f"least {row['least']} < {off['least']}")
    return ", ".join(short)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", required=True)
    parser.add_argument("--judge", required=True)
    parser.add_argument("--scans", type=pathlib.Path)
    parser.add_argument("--parts", type=pathlib.Path)
    parser.add_argument("--quads", default="2500,10000")
    parser.add_argument("--modes", default="automatic,off")
    parser.add_argument("--only", default="")
    parser.add_argument("--table", type=pathlib.Path)
    parser.add_argument("--limit", type=float, default=120, help="seconds a run")
    arguments = parser.parse_args()
    rows, short = [], 0
    for folder, is_part in ((arguments.scans, False), (arguments.parts, True)):
        for path in sorted(folder.glob("*.ply")) if folder else []:
            if not re.search(arguments.only, path.stem):
                continue
            for quads in map(int, arguments.quads.split(",")):
                off = None
                # Without detection first, as the others are judged by it.
                for mode in sorted(arguments.modes.split(","), key=lambda name: name != "off"):
                    row = measure(arguments, path, mode, quads, is_part)
                    row["short"] = verdict(row, off) if mode != "off" else ""
                    off = row if mode == "off" else off
                    short += row["short"] != ""
                    rows.append(row)
                    print("{kind:5} {model:22} {quads:6} {mode:10}".format(**row),
                          *(f"{name} {row.get(name)}" for name in ("irregular", "mean", "least", "creases",
                                                                   "crease_length", "doubtful",
                                                                   "seconds")),
                          row["short"] and f"<-- {row['short']}", flush=True)
    if arguments.table:
        names = list(dict.fromkeys(name for row in rows for name in row))
        with open(arguments.table, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, names)
            writer.writeheader()
            writer.writerows(rows)
    print(f"{len(rows)} runs, {short} fall short")
    return 1 if short else 0


if __name__ == "__main__":
    sys.exit(main())
