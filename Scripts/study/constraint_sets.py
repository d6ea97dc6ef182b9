#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""How often sets of constraints that some quad mesh has are met.

A set is feasible because it is taken from a quad mesh: the same surface is remeshed at other settings (coarse vertices,
number of quads, strokes somewhere or along the curvature), and from these quads come connections (chains of edges
between two irregular vertices, with their valences), cycles (closed chains), strokes (along short chains) and the
valence at further irregular vertices. All of it is then asked for at the default settings.

With --drawn a set is what a user draws, which no mesh is known to have: a connection between two irregular vertices of
the default quads that lie near each other, or a cycle round a plane section.

  constraint_sets.py make SETS.json MODEL... [--sets N] [--seed N] [--quads N] [--drawn]
  constraint_sets.py run SETS.json RESULT.json [--threads N] [--first N] [--count N]
  constraint_sets.py tell RESULT.json...

MODEL is a file of a surface. SETS.json holds the places, so the same sets can be asked for of another build.
"""
import argparse
import collections
import json
import random
import sys
import time

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import mutable, vtkLogger
from vtkmodules.vtkCommonDataModel import vtkPlane, vtkStaticCellLocator
from vtkmodules.vtkFiltersCore import vtkCutter, vtkStripper

import quadrille

#: In edges of quads: chains that are asked for.
CONNECTION = (3, 25)
CYCLE = (8, 120)
STROKE = (5, 10)
#: Degrees; strokes that are off less count as met.
MET_ANGLE = 5
#: As the constraint table calls them.
KINDS = ("connection", "cycle", "guide stroke", "valence")


class Chains:
    """Chains of edges that run straight through a quad mesh."""

    def __init__(self, points, quads, lines):
        self.points, self.quads = points, quads
        count = 4 * len(quads)
        self.origin = quads.ravel()
        self.next = numpy.arange(count).reshape(-1, 4)[:, [1, 2, 3, 0]].ravel()
        ends = self.origin[self.next]
        there = {(a, b): h for h, (a, b) in enumerate(zip(self.origin.tolist(), ends.tolist()))}
        self.twin = [there.get((b, a), -1) for a, b in zip(self.origin.tolist(), ends.tolist())]
        self.valence = numpy.bincount(self.origin, minlength=len(points))
        self.fixed = numpy.zeros(len(points), bool)  # on a feature or boundary
        for h, twin in enumerate(self.twin):
            if twin < 0:
                self.fixed[[self.origin[h], ends[h]]] = True
        self.fixed[lines] = True
        self.irregular = numpy.flatnonzero((self.valence != 4) & ~self.fixed)

    def straight_on(self, h):
        across = self.twin[self.next[h]]
        return self.next[across] if across >= 0 else -1

    def follow(self, h, most):
        """Points of the chain that begins with h, up to an irregular or fixed one, or back to the first."""
        chain = [self.origin[h]]
        while h >= 0 and len(chain) <= most:
            p = self.origin[self.next[h]]
            chain.append(p)
            if p == chain[0] or self.valence[p] != 4 or self.fixed[p]:
                break
            h = self.straight_on(h)
        return chain

    def connections(self):
        irregular = set(self.irregular.tolist())
        for h in range(len(self.twin)):
            if self.origin[h] in irregular:
                chain = self.follow(h, CONNECTION[1])
                if chain[0] < chain[-1] and chain[-1] in irregular and CONNECTION[0] < len(chain):
                    yield chain

    def cycles(self):
        seen = set()
        for h in range(len(self.twin)):
            if h in seen or self.fixed[self.origin[h]]:
                continue
            chain, at = [self.origin[h]], h
            seen.add(h)
            while True:
                p = self.origin[self.next[at]]
                at = self.straight_on(at)
                if at < 0 or self.valence[p] != 4 or self.fixed[p] or len(chain) > CYCLE[1] or at == h:
                    break
                chain.append(p)
                seen.add(at)
            whole = at == h and self.valence[chain[0]] == 4
            if whole and CYCLE[0] <= len(chain) and len(set(chain)) == len(chain):
                yield chain

    def stroke(self, chance):
        """A chain of regular points off features somewhere, or None."""
        for _ in range(200):
            chain = self.follow(chance.randrange(len(self.twin)), chance.randint(*STROKE))
            regular = all(self.valence[p] == 4 and not self.fixed[p] for p in chain)
            if regular and len(chain) > STROKE[0] and chain[0] != chain[-1]:
                return chain
        return None


class Surface:
    """A mesh whose places are looked up."""

    def __init__(self, model):
        self.mesh = quadrille.read(model)
        self.points = vtk_to_numpy(self.mesh.GetPoints().GetData())
        self.used = numpy.unique(vtk_to_numpy(self.mesh.GetPolys().GetConnectivityArray()))
        self.size = float(numpy.linalg.norm(self.points.max(axis=0) - self.points.min(axis=0)))
        self.triangles = vtk_to_numpy(self.mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        self.cells = locator_of(self.mesh)

    def point_near(self, place):
        return int(self.used[numpy.argmin(((self.points[self.used] - place) ** 2).sum(axis=1))])

    def corners_near(self, place):
        return self.points[self.triangles[cell_near(self.cells, place)]]


def locator_of(mesh):
    locator = vtkStaticCellLocator()
    locator.SetDataSet(mesh)
    locator.BuildLocator()
    return locator


def cell_near(locator, place):
    closest, cell, part, distance = [0.0, 0.0, 0.0], mutable(0), mutable(0), mutable(0.0)
    locator.FindClosestPoint(place, closest, cell, part, distance)
    return int(cell)


def deviation(surface, chains, course):
    """Degrees between a stroke and the quads' edges under it, in the planes of the surface's triangles, on average."""
    angles = []
    for a, b in zip(course[:-1], course[1:]):
        for part in (0.125, 0.375, 0.625, 0.875):
            corner = surface.corners_near((a + part * (b - a)).tolist())
            normal = numpy.cross(corner[1] - corner[0], corner[2] - corner[0])
            quad = chains.points[chains.quads[cell_near(chains.cells, corner.mean(axis=0).tolist())]]

            def in_plane(vector, normal=normal / numpy.linalg.norm(normal)):
                flat = vector - normal * normal.dot(vector)
                return flat / numpy.linalg.norm(flat)

            along = [quad[1] - quad[0] + quad[2] - quad[3], quad[3] - quad[0] + quad[2] - quad[1]]
            cosine = max(abs(in_plane(b - a).dot(in_plane(edges))) for edges in along)
            angles.append(numpy.degrees(numpy.arccos(min(1, cosine))))
    return float(numpy.mean(angles))


def random_strokes(surface, chance):
    """Settings that turn the field somewhere."""
    points, size = surface.points[surface.used], surface.size
    strokes = []
    for _ in range(chance.randint(1, 3)):
        start = points[chance.randrange(len(points))]
        distance = numpy.linalg.norm(points - start, axis=1)
        near = numpy.flatnonzero((distance > 0.04 * size) & (distance < 0.15 * size))
        strokes.append([start.tolist(), points[chance.choice(near.tolist())].tolist()])
    return {"strokes": strokes, "stroke_radius": chance.uniform(0.02, 0.06) * size}


def chains_at(surface, **settings):
    made = quadrille.remesh(surface.mesh, everything=True, **settings)
    points, faces = quadrille.to_arrays(made.quads)
    line_points = vtk_to_numpy(made.lines.GetPoints().GetData()) if made.lines.GetNumberOfPoints() else []
    ids = {tuple(p): i for i, p in enumerate(points.tolist())}
    lines = sorted({ids[tuple(p)] for p in numpy.asarray(line_points, float).tolist() if tuple(p) in ids})
    chains = Chains(points, faces, lines)
    chains.cells = locator_of(made.quads)
    return chains


def reference(surface, quads, chance):
    """The quads at other settings, or None where these have failed."""
    settings = {"coarse_vertices": chance.randrange(600, 1600), "quads": round(quads * chance.uniform(0.9, 1.1))}
    way = chance.randrange(3)
    if way == 1:
        settings["guide"] = "curvature"
    elif way == 2:
        settings.update(random_strokes(surface, chance))
    try:
        return chains_at(surface, **settings)
    except quadrille.RemeshError as error:
        print(f"no quads with {settings}: {error}", flush=True)
        return None


def some(items, most, chance):
    """At most so many of them."""
    items = list(items)
    return chance.sample(items, min(chance.randint(0, most), len(items)))


def met_stroke(surface, chains, chance):
    """A chain that counts as met in its own quads, or None: on a rough surface triangles have other planes."""
    for _ in range(10):
        chain = chains.stroke(chance)
        if chain and deviation(surface, chains, chains.points[chain]) <= MET_ANGLE:
            return chain
    return None


def make_set(surface, chains, chance):
    """What is asked for, or None where the quads have not three of these things."""
    connections = some(chains.connections(), 2, chance)
    cycles = some(chains.cycles(), 2, chance)
    strokes = (met_stroke(surface, chains, chance) for _ in range(chance.randint(0, 2)))
    strokes = [stroke for stroke in strokes if stroke]
    held = {p for chain in connections for p in (chain[0], chain[-1])}
    held.update(some(chains.irregular.tolist(), 3, chance))
    if len(connections) + len(cycles) + len(strokes) + len(held) < 3 or not connections + cycles:
        return None

    def courses(items):
        return [chains.points[chain].tolist() for chain in items]

    return {"connections": courses(connections), "cycles": courses(cycles), "strokes": courses(strokes),
            "target_valence": {str(surface.point_near(chains.points[p])): int(chains.valence[p]) for p in sorted(held)}}


def section(surface, chance):
    """A closed polyline where a plane cuts the surface, or None."""
    plane = vtkPlane()
    plane.SetOrigin(surface.points[chance.choice(surface.used.tolist())].tolist())
    plane.SetNormal([chance.gauss(0, 1) for _ in range(3)])
    cutter, strips = vtkCutter(), vtkStripper()
    cutter.SetInputData(surface.mesh)
    cutter.SetCutFunction(plane)
    strips.SetInputConnection(cutter.GetOutputPort())
    strips.JoinContiguousSegmentsOn()
    strips.SetMaximumLength(100000)
    strips.Update()
    cut = strips.GetOutput()
    places = vtk_to_numpy(cut.GetPoints().GetData()) if cut.GetNumberOfPoints() else None
    loops = []
    for i in range(cut.GetNumberOfLines()):
        ids = cut.GetCell(i).GetPointIds()
        ids = [ids.GetId(k) for k in range(ids.GetNumberOfIds())]
        if ids[0] == ids[-1] and len(ids) > 8:
            loops.append(places[ids[:-1]])
    return chance.choice(loops) if loops else None


def drawn_set(surface, chains, chance):
    """One connection or one cycle, or None."""
    asked = {"connections": [], "cycles": [], "strokes": [], "target_valence": {}}
    if chance.random() < 0.5:
        edge = numpy.mean(numpy.linalg.norm(
            chains.points[chains.quads] - chains.points[numpy.roll(chains.quads, 1, axis=1)], axis=2))
        if len(chains.irregular) < 2:
            return None
        a = chains.points[chance.choice(chains.irregular.tolist())]
        distance = numpy.linalg.norm(chains.points[chains.irregular] - a, axis=1)
        near = chains.irregular[(distance > 2 * edge) & (distance < 12 * edge)]
        if not len(near):
            return None
        asked["connections"] = [[a.tolist(), chains.points[chance.choice(near.tolist())].tolist()]]
        return asked
    loop = section(surface, chance)
    if loop is None:
        return None
    size = numpy.linalg.norm(numpy.roll(loop, 1, axis=0) - loop, axis=1).sum()
    if size < 0.05 * surface.size:
        return None
    asked["cycles"] = [loop.tolist()]
    return asked


def make(arguments):
    chance = random.Random(arguments.seed)
    surfaces = {model: Surface(model) for model in arguments.models}
    plain = {}
    sets = []
    while len(sets) < arguments.sets:
        model = arguments.models[len(sets) % len(arguments.models)]
        surface = surfaces[model]
        if arguments.drawn:
            if model not in plain:
                plain[model] = chains_at(surface, quads=arguments.quads)
            asked = drawn_set(surface, plain[model], chance)
        else:
            chains = reference(surface, arguments.quads, chance)
            asked = chains and make_set(surface, chains, chance)
        if asked:
            sets.append(dict(asked, model=model, quads=arguments.quads))
    with open(arguments.file, "w", encoding="utf-8") as file:
        json.dump(sets, file)
    told = [f"{sum(len(s[name]) for s in sets)} {name}" for name in ("connections", "cycles", "strokes")]
    print(f"{len(sets)} sets with {', '.join(told)}")


def inverted(quads):
    """Quads with a corner of 180 degrees or more."""
    points, faces = quadrille.to_arrays(quads)
    corner = points[faces]
    after, before = numpy.roll(corner, -1, axis=1) - corner, numpy.roll(corner, 1, axis=1) - corner
    normal = numpy.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    signs = numpy.einsum("qij,qj->qi", numpy.cross(after, before), normal)
    return int((signs <= 0).any(axis=1).sum())


def ask(mesh, asked, threads):
    """The rows of the constraint table that the set stands for."""
    start = time.time()
    try:
        made = quadrille.remesh(
            mesh, quads=asked["quads"], threads=threads, everything=True, strokes=asked["strokes"] or None,
            connections=asked["connections"] or None, cycles=asked["cycles"] or None,
            target_valence={int(p): v for p, v in asked["target_valence"].items()})
    except quadrille.RemeshError as error:
        return {"failed": str(error), "rows": [], "inverted": 0, "seconds": time.time() - start}
    rows = [row for row in made.info["constraints"] if row["kind"] in KINDS]
    return {"rows": rows, "inverted": inverted(made.quads), "quads": made.quads.GetNumberOfCells(),
            "seconds": time.time() - start}


def run(arguments):
    with open(arguments.sets_file, encoding="utf-8") as file:
        sets = json.load(file)
    meshes, results = {}, []
    last = len(sets) if arguments.count is None else arguments.first + arguments.count
    for i in range(arguments.first, min(last, len(sets))):
        asked = sets[i]
        if asked["model"] not in meshes:
            meshes[asked["model"]] = quadrille.read(asked["model"])
        results.append(dict(ask(meshes[asked["model"]], asked, arguments.threads), set=i, model=asked["model"]))
        with open(arguments.file, "w", encoding="utf-8") as file:
            json.dump(results, file)
        unmet = [row["kind"] for row in results[-1]["rows"] if not row["met"]]
        print(i, asked["model"].rsplit("/", 1)[-1], results[-1].get("failed", ""), *unmet, flush=True)
    tell_all(results)


def is_met(result):
    return "failed" not in result and result["inverted"] == 0 and all(row["met"] for row in result["rows"])


def tell_all(results):
    """Met of asked for each kind, for whole sets, and the reasons by how often they are given."""
    rows = [row for result in results for row in result["rows"]]
    for kind in KINDS:
        of_kind = [row for row in rows if row["kind"] == kind]
        print(f"{kind}: {sum(row['met'] for row in of_kind)} of {len(of_kind)}")
    print(f"failed: {sum('failed' in result for result in results)}; "
          f"with inverted quads: {sum(result['inverted'] > 0 for result in results)}")
    print(f"whole sets: {sum(map(is_met, results))} of {len(results)}; "
          f"{numpy.mean([result['seconds'] for result in results]):.1f} s each")
    reasons = collections.Counter()
    for row in rows:
        if not row["met"]:
            words = "".join("#" if c.isdigit() else c for c in row["reason"])
            reasons[row["kind"] + ": " + words[:150]] += 1
    for reason, count in reasons.most_common():
        print(f"{count:4d}  {reason}")


def tell(arguments):
    results = []
    for name in arguments.files:
        with open(name, encoding="utf-8") as file:
            results += json.load(file)
    tell_all(results)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    making = commands.add_parser("make")
    making.add_argument("file")
    making.add_argument("models", nargs="+")
    making.add_argument("--sets", type=int, default=60)
    making.add_argument("--seed", type=int, default=1)
    making.add_argument("--quads", type=int, default=3000)
    making.add_argument("--drawn", action="store_true")
    making.set_defaults(call=make)
    running = commands.add_parser("run")
    running.add_argument("sets_file")
    running.add_argument("file")
    running.add_argument("--threads", type=int, default=0)
    running.add_argument("--first", type=int, default=0)
    running.add_argument("--count", type=int)
    running.set_defaults(call=run)
    telling = commands.add_parser("tell")
    telling.add_argument("files", nargs="+")
    telling.set_defaults(call=tell)
    arguments = parser.parse_args()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_WARNING)
    arguments.call(arguments)
    return 0


if __name__ == "__main__":
    sys.exit(main())
