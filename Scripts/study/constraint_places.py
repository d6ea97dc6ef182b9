#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Whether constraints come where they were asked for: at random places of the surface, one at a time in a session, each
judged in the quads alone (`constraint_judge.py`) against what was asked, and compared with the word on it.

  constraint_places.py [--model MODEL]... [--class CLASS]... [--count N] [--quads N] [--seed N] [--threads N]
                       [--parts FOLDER] [--scans FOLDER] [--out CSV] [--again CSV]
  constraint_places.py --table [--out CSV]

MODEL is a file, or `cube` (12 triangles), `sphere` (an icosahedron, 20 triangles, all of whose edges are features) or
`ball` (the same without features); without one it is ten parts, two scans, `Data/part.ply` and these. Of CLASS there
are valence, move, connection, cycle, feature, stroke and size. --quads is 5,000, and 2,400 for those of 12 and 20.
--out takes a row for each constraint, with seconds of the processor and their share of the first run; --again tells the
table of such a file. With --table it is what large triangles had wrong on a cube: a row each, with its notices. Each
model runs in a process of its own, so that a crash is told and the others go on.

A place is feasible unless the session does not give it and the judge sees why not: it lies on a feature or boundary,
the way there crosses a feature, or what lies between features has room for less than nine quads; of a size, half of the
area within its radius is nearer to features than half a quad of that size, as in strips narrower than two of them,
across which a whole number need not come near it. Features are sharp edges, and lines that the quads have without
constraints. A stroke has room where its features are two edge lengths away, and quads that turn from them to it have
sizes that grow by at most a quarter an edge length, as the guide lets sizes grow.
Random sessions of all kinds of edits are made by `check/random_sessions.py MODEL... --sessions N --inside`.
"""
import argparse
import collections
import csv
import dataclasses
import math
import multiprocessing
import pathlib
import re
import sys
import time
import traceback

import numpy
import quadrille
from scipy.spatial import cKDTree

import constraint_judge as judge

ROOT = pathlib.Path(__file__).resolve().parents[2]
#: Ten parts spread over the folder: every fourth by name.
EVERY = 4
SCANS = ("igea.ply", "bunny_69k.ply")
#: Draws of a place before a class has none on a model.
TRIES = 300
#: Draws among which those are preferred that cross no feature, or lie away from features.
PREFERRED = 60
#: Edge lengths from a feature or the boundary within which a place cannot be told from one on it.
ON_FEATURE = 0.3
#: Quads for which there has to be room between features.
ROOM = 9
#: Edge lengths from features within which they do not leave a stroke room.
STROKE_ROOM = 2
#: Edge lengths that a drawn line keeps from features, where it does not cross them.
CLEAR = 0.75
#: By how much sizes grow over an edge length beyond the radius that they are asked for in, as the guide has it.
GROWTH = 0.25
#: Degrees an edge length by which quads turn from features to a stroke where these leave it room: a conformal map that
#: turns by an angle over a length has sizes that grow by as much, across.
BEND = math.degrees(GROWTH)
COLUMNS = ("model", "kind", "number", "asked", "word", "met", "told", "unit", "reason", "ok", "deviation", "more",
           "excuse", "seconds", "share", "notices")


@dataclasses.dataclass
class Ask:
    """What is asked for, how it is judged in quads, and why it may not be feasible."""
    kind: str
    text: str
    add: object
    judge: object
    excuse: str = ""


def cube():
    points = numpy.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    faces = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
             [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]]
    return points, numpy.array(faces)


def sphere():
    golden = (1 + math.sqrt(5)) / 2
    points = numpy.array([[-1, golden, 0], [1, golden, 0], [-1, -golden, 0], [1, -golden, 0], [0, -1, golden],
                          [0, 1, golden], [0, -1, -golden], [0, 1, -golden], [golden, 0, -1], [golden, 0, 1],
                          [-golden, 0, -1], [-golden, 0, 1]])
    faces = [[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6],
             [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10],
             [8, 6, 7], [9, 8, 1]]
    return points / math.sqrt(1 + golden ** 2), numpy.array(faces)


MADE = {"cube": cube, "sphere": sphere, "ball": sphere}
SETTINGS = {"ball": {"feature_angle": None}}


def lines_of(lines, points):
    """Pairs of points of the quads, of a vtkPolyData or a mesh of quadrille without VTK."""
    if hasattr(lines, "GetLines"):
        from vtkmodules.util.numpy_support import vtk_to_numpy  # pylint: disable=import-outside-toplevel
        places = vtk_to_numpy(lines.GetPoints().GetData()) if lines.GetNumberOfPoints() else numpy.zeros((0, 3))
        offsets, corners = (vtk_to_numpy(array) for array in (lines.GetLines().GetOffsetsArray(),
                                                              lines.GetLines().GetConnectivityArray()))
    else:
        places, offsets, corners = lines.points, lines.offsets, lines.corners
    ids = cKDTree(points).query(places)[1] if len(places) else numpy.zeros(0, int)
    inner = numpy.setdiff1d(numpy.arange(max(len(corners) - 1, 0)), numpy.asarray(offsets[1:-1]) - 1)
    return ids[numpy.stack((corners[inner], corners[inner + 1]), axis=1).astype(int)].reshape(-1, 2)


def text_of(place):
    return "(" + ", ".join(f"{x:.6g}" for x in place) + ")"


class Model:
    """A surface, its quads without constraints, and what is asked of it."""

    def __init__(self, name, quads, seed, threads):
        self.name = pathlib.Path(name).stem
        mesh = MADE[name]() if name in MADE else quadrille.read(name)
        points, faces = mesh if name in MADE else quadrille.to_arrays(mesh)
        quads = quads or (2400 if name in MADE else 5000)
        self.random = numpy.random.default_rng(seed)
        self.session = quadrille.Session(mesh, quads=quads, threads=threads, **SETTINGS.get(name, {}))
        start = time.process_time()
        self.session.update()
        self.first = time.process_time() - start
        self.free = judge.Quads(*self.session.quads)
        edge = float(numpy.median(self.free.sizes))
        points, merged = numpy.unique(numpy.asarray(points, float) + 0.0, axis=0, return_inverse=True)
        faces = merged.reshape(-1)[numpy.asarray(faces)]
        faces = faces[(faces != numpy.roll(faces, 1, axis=1)).all(axis=1)]
        self.surface = judge.Surface(points, faces, edge, self.session.settings()["feature_angle"])
        pairs = lines_of(quadrille.remesh(mesh, quads=quads, threads=threads, everything=True,
                                          **SETTINGS.get(name, {})).lines, self.free.points)
        self.surface.add_features(*(self.free.points[pairs[:, i]] for i in (0, 1)))
        #: Of the free quads the parts that their lines bound, and the areas of these.
        self.parts = self.free.parts(pairs)
        self.part_area = numpy.bincount(self.parts, self.free.sizes ** 2)
        irregular = self.free.irregular()
        away = self.surface.to_feature(self.free.points[irregular]) > 0.5 * edge
        self.irregular = irregular[away]
        #: Pairs of them that were asked for.
        self.connected = []

    # Places.

    def centre(self, least=0.0):
        """A place below a random quad's centre, a quad's length off the boundary and at least so many edge lengths off
        features; None where there is none."""
        for _ in range(TRIES):
            quad = int(self.random.integers(len(self.free.quads)))
            place = self.surface.nearest(self.free.centres[quad])[0]
            if (self.surface.to_boundary(place)[0] > self.free.sizes[quad] and
                    self.surface.to_feature(place)[0] >= least * self.free.sizes[quad]):
                return place[0]
        return None

    def excuse(self, place):
        """Why nothing irregular can be there."""
        edge = self.free.length_at(place)
        if self.surface.to_feature([place])[0] < ON_FEATURE * edge:
            return "on a feature"
        if self.surface.to_boundary([place])[0] < ON_FEATURE * edge:
            return "on the boundary"
        return "no room between features" if self.area_at(place) < ROOM * edge ** 2 else ""

    def region(self, place):
        """What sharp edges bound, and what lines bound."""
        face = self.surface.nearest(place)[1]
        below = self.free.below(numpy.atleast_2d(place), self.surface.normals[face])
        return int(self.surface.region[face[0]]), int(self.parts[below[0]])

    def area_at(self, place):
        region, part = self.region(place)
        return min(self.surface.region_area[region], self.part_area[part])

    def regular_near(self, place):
        """Whether nothing irregular is within an edge length."""
        irregular = self.free.points[self.free.irregular()]
        return not len(irregular) or (numpy.linalg.norm(irregular - place, axis=1).min() >
                                      self.free.length_at(place))

    def crosses(self, course):
        """Whether a course comes nearer to a feature than a sample tells."""
        return bool((self.surface.to_feature(course.places) < 2 * judge.STEP * self.surface.edge).any())

    def course(self, line):
        return judge.Course(numpy.asarray(line), self.surface.edge)

    def around(self, point, least, most):
        """Points of the free quads so many edge lengths from one of them along the surface, and the way back."""
        edge = self.free.length_at(self.free.points[point])
        distance, before = self.free.distances(point, most * edge)
        return numpy.flatnonzero((distance >= least * edge) & (distance <= most * edge)), before

    # Classes. Each draws what is asked for, or returns None.

    def valence(self):
        for _ in range(TRIES):
            place = self.centre()
            if place is not None and self.regular_near(place):
                break
        else:
            return None
        valence = int(self.random.choice((3, 5)))
        return Ask("valence", f"{valence} at {text_of(place)}", lambda s: s.set_valence(place, valence),
                   lambda quads: judge.judge_valence(self.surface, quads, place, valence), self.excuse(place))

    def move(self):
        for _ in range(TRIES if len(self.irregular) else 0):
            point = int(self.random.choice(self.irregular))
            near = self.around(point, 2, 6)[0]
            near = near[~self.free.boundary[near]]
            if not len(near):
                continue
            quads = numpy.flatnonzero((self.free.quads == self.random.choice(near)).any(axis=1))
            target = self.surface.nearest(self.free.centres[self.random.choice(quads)])[0][0]
            if self.regular_near(target):
                break
        else:
            return None
        origin, valence = self.free.points[point], int(self.free.valence[point])
        excuse = self.excuse(target)
        if not excuse and self.region(origin) != self.region(target):
            excuse = "on the other side of a feature"
        return Ask("move", f"{valence} from {text_of(origin)} to {text_of(target)}",
                   lambda s: s.move_irregular(origin, target),
                   lambda quads: judge.judge_move(self.surface, quads, self.free, origin, target, valence),
                   excuse)

    def connection(self):
        drawn = None
        for attempt in range(TRIES if len(self.irregular) > 1 else 0):
            start = int(self.random.choice(self.irregular))
            near, before = self.around(start, 4, 15)
            near = [p for p in numpy.intersect1d(near, self.irregular) if {start, p} not in self.connected]
            if not near:
                continue
            end = int(self.random.choice(near))
            way = [end]
            while way[-1] != start:
                way.append(int(before[way[-1]]))
            # A point of the way at every third of it; between them straight along the surface.
            points = self.free.points[[way[-1 - round(part * (len(way) - 1) / 3)] for part in range(4)]]
            line = [numpy.atleast_2d(points[0])]
            for a, b in zip(points[:-1], points[1:]):
                piece = self.surface.straight(a, b, compare=False)
                if piece is None:
                    break
                line.append(piece[1:])
            else:
                course = self.course(numpy.concatenate(line))
                drawn = {start, end}, points, course, "the course crosses a feature" if self.crosses(course) else ""
                if not drawn[3] or attempt > PREFERRED:
                    break
        if drawn is None:
            return None
        pair, points, course, excuse = drawn
        self.connected.append(pair)
        return Ask("connection", " ".join(map(text_of, points)), lambda s: s.connect(points),
                   lambda quads: judge.judge_connection(self.surface, quads, course), excuse)

    def cycle(self):
        """With a random plane, or one nearly across the quads at its place."""
        drawn, along_flow = None, self.random.random() < 0.5
        for attempt in range(TRIES):
            quad = int(self.random.integers(len(self.free.quads)))
            normal = self.random.normal(size=3)
            if along_flow:
                normal = self.free.families[quad, self.random.integers(2)] + 0.1 * judge.unit(normal)
            normal = judge.unit(normal)
            line = self.surface.loop(self.free.centres[quad], normal)
            if line is None or judge.length_of(line) < 12 * self.surface.edge:
                continue
            drawn = self.course(line)
            if not self.crosses(drawn) or attempt > PREFERRED:
                break
        return None if drawn is None else self.ask_cycle(drawn)

    def ask_cycle(self, course):
        points = simplified(course.line, 0.05 * self.surface.edge)[:-1]
        excuse = ""
        if self.crosses(course) and not judge.judge_cycle(self.free, course).ok:
            excuse = "the course crosses a feature"
        return Ask("cycle", f"of {course.length / self.surface.edge:.0f} edges, {len(points)} points from "
                   f"{text_of(points[0])}", lambda s: s.add_cycle(points),
                   lambda quads: judge.judge_cycle(quads, course), excuse)

    def feature(self):
        for _ in range(TRIES):
            first = self.centre(CLEAR)
            if first is None:
                return None
            points, line = [first], [numpy.atleast_2d(first)]
            for _ in range(int(self.random.integers(1, 4))):
                piece = self.leg(points[-1])
                if piece is None:
                    break
                corners, along = piece
                points += corners
                line.append(along[1:])
            else:
                course = self.course(numpy.concatenate(line))
                if self.can_be_drawn(course, points):
                    return self.ask_feature(points, course)
        return None

    def leg(self, start):
        """From a place to another one, 2 to 8 edge lengths away: the points that are drawn, one where it crosses a
        feature among them, and the course; None where that is not clear."""
        edge = self.free.length_at(start)
        within = numpy.linalg.norm(self.free.centres - start, axis=1) / edge
        near = numpy.flatnonzero((within > 2) & (within < 8))
        if not len(near):
            return None
        end = self.surface.nearest(self.free.centres[self.random.choice(near)])[0][0]
        if self.surface.to_feature([end])[0] < CLEAR * edge or self.surface.to_boundary([end])[0] < CLEAR * edge:
            return None
        line = self.surface.straight(start, end, compare=False)
        if line is None:
            return None
        course = self.course(line)
        if not self.crosses(course):
            clear = self.surface.straight(start, end, compare=True)
            return None if clear is None else ([end], clear)
        # Over one feature, at more than 40 degrees to it.
        tree, directions = self.surface.features
        off, which = tree.query(course.places)
        close = numpy.flatnonzero(off < CLEAR * edge)
        at = int(off.argmin())
        if (close[-1] - close[0] + 1 > len(close) or
                abs(course.directions[at] @ directions[which[at]]) > math.cos(math.radians(40))):
            return None
        cut = line[numpy.argmin(tree.query(line)[0])]
        legs = [self.surface.straight(a, b, compare=True) for a, b in ((start, cut), (cut, end))]
        if any(leg is None for leg in legs):
            return None
        return [cut, end], numpy.concatenate((legs[0], legs[1][1:]))

    def can_be_drawn(self, course, points):
        """Whether quads have room on both sides: no sharp turn, no place twice, off features but where it crosses."""
        legs = judge.unit(numpy.diff(points, axis=0))
        turns = judge.dots(legs[:-1], legs[1:])
        edge = self.free.length_at(course.places)
        off = self.surface.to_feature(course.places)
        crossings = numpy.asarray(points)[self.surface.to_feature(points) < judge.STEP * edge]
        for place in crossings:
            off[numpy.linalg.norm(course.places - place, axis=1) < 1.5 * edge] = numpy.inf
        return ((turns > math.cos(math.radians(100))).all() and course.apart_from_itself(1.2 * edge) and
                (off > CLEAR * edge).all() and (self.surface.to_boundary(course.places) > CLEAR * edge).all())

    def ask_feature(self, points, course):
        points = numpy.array(points)
        return Ask("feature", " ".join(map(text_of, points)), lambda s: s.add_feature(points),
                   lambda quads: judge.judge_feature(quads, course))

    def stroke(self):
        drawn = None
        for attempt in range(TRIES):
            quad = int(self.random.integers(len(self.free.quads)))
            edge = float(self.free.sizes[quad])
            places, faces, _ = self.surface.nearest(self.free.centres[quad])
            turn = math.radians(self.random.uniform(20, 60))
            one = self.free.families[quad, self.random.integers(2)]
            direction = math.cos(turn) * one + math.sin(turn) * numpy.cross(self.free.normals[quad], one)
            step = edge * self.random.uniform(1.2, 2.2)
            points, line = [places[0]], [places]
            for _ in range(4):
                normal = self.surface.normals[faces[0]]
                direction = judge.unit(direction - normal * (direction @ normal))
                end, faces, _ = self.surface.nearest(points[-1] + step * direction)
                piece = self.surface.straight(points[-1], end[0], compare=True)
                if piece is None or judge.length_of(piece) < 0.7 * step:
                    break
                points.append(end[0])
                line.append(piece[1:])
            else:
                course = self.course(numpy.concatenate(line))
                if self.crosses(course) or (self.surface.to_boundary(course.places) < CLEAR * edge).any():
                    continue
                room = self.surface.to_feature(course.places).min() > STROKE_ROOM * edge
                drawn = points, course, room
                if room or attempt > PREFERRED:
                    break
        if drawn is None:
            return None
        radius = float(self.random.choice((0, 1.5))) * self.surface.edge
        return self.ask_stroke(*drawn, radius)

    def ask_stroke(self, points, course, room, radius):
        points = numpy.array(points)
        turn = judge.judge_stroke(self.surface, self.free, course, radius).deviation
        off = self.surface.to_feature(course.places).min() / self.free.length_at(course.places)
        room = room and turn <= BEND * off
        return Ask("stroke" if room else "stroke near features",
                   f"radius {radius:.4g} {' '.join(map(text_of, points))}",
                   lambda s: s.add_guide(points, radius=radius),
                   lambda quads: judge.judge_stroke(self.surface, quads, course, radius))

    def size(self):
        place = self.centre()
        if place is None:
            return None
        factor = math.exp(self.random.uniform(math.log(0.4), math.log(2)))
        return self.ask_size(place, factor, self.random.uniform(3, 6) * self.free.length_at(place))

    def ask_size(self, place, factor, radius):
        off, areas = self.surface.off_features(place, radius)
        narrow = len(off) and judge.weighted_median(off, areas) < 0.5 * factor * self.surface.edge
        return Ask("size", f"{factor:.3g} within {radius:.4g} of {text_of(place)}",
                   lambda s: s.set_size(place, factor, radius=radius),
                   lambda quads: judge.judge_size(self.surface, quads, place, radius, factor, GROWTH),
                   "less than two such quads between features" if narrow else "")

    # Runs.

    def run(self, ask, number):
        """Asks, judges, and takes it back."""
        row = dict.fromkeys(COLUMNS, "")
        row.update(model=self.name, kind=ask.kind, number=number, asked=ask.text, excuse=ask.excuse, ok=False,
                   deviation=math.inf, met=False)
        self.session.update()
        start = time.process_time()
        try:
            which = ask.add(self.session)
            report = self.session.update()
            row["seconds"] = time.process_time() - start
            row["share"] = row["seconds"] / self.first
            word = next(w for w in report["constraints"] if w["id"] == which)
            row.update(word="met" if word["met"] else "not met", met=word["met"], told=word["deviation"],
                       unit=word["unit"], reason=word["reason"], notices=" | ".join(report["notices"]))
            quads = self.session.quads
            verdict = judge.Verdict(False, math.inf, "no quads") if quads is None else ask.judge(judge.Quads(*quads))
            row.update(ok=bool(verdict.ok), deviation=verdict.deviation, more=verdict.more)
        except (quadrille.InvalidInput, quadrille.RemeshError) as error:
            row.update(word="refused", reason=str(error))
        if self.session.constraints():
            self.session.undo()
        return row


CLASSES = ("valence", "move", "connection", "cycle", "feature", "stroke", "size")


def simplified(line, tolerance):
    """The points of a polyline that are needed to stay within a tolerance of it."""
    keep = [0, len(line) - 1]
    parts = [(0, len(line) // 2), (len(line) // 2, len(line) - 1)]
    while parts:
        first, last = parts.pop()
        keep += [first, last]
        between = line[first + 1:last]
        if len(between):
            off = numpy.linalg.norm(judge.on_segments(between, line[first][None], line[last][None]) - between, axis=1)
            if off.max() > tolerance:
                middle = first + 1 + int(off.argmax())
                parts += [(first, middle), (middle, last)]
    return line[sorted(set(keep))]


def in_child(job, arguments, send):
    """All of a model; each row is sent as it comes, and before it what is asked for."""
    try:
        job(arguments, send)
        send.send(("done", None))
    except Exception:  # pylint: disable=broad-except
        send.send(("failed", traceback.format_exc()))
    send.close()


def asked_of(job, arguments):
    """The rows of a job that runs in a process of its own. What ends it is a row as well."""
    context = multiprocessing.get_context("spawn")
    receive, send = context.Pipe(duplex=False)
    process = context.Process(target=in_child, args=(job, arguments, send))
    process.start()
    send.close()
    last, what = dict.fromkeys(COLUMNS, ""), None
    while what not in ("done", "failed", "crashed"):
        try:
            what, content = receive.recv()
        except EOFError:
            process.join()
            what, content = "crashed", f"exit code {process.exitcode}"
        if what == "asking":
            last.update(content)
        elif what == "row":
            yield content
        elif what != "done":
            yield dict(last, word=what, reason=content, met=False, ok=False, deviation=math.inf)
    process.join()


def all_classes(arguments, send):
    """Of one model: {"model", "classes", "count", "quads", "seed", "threads"}."""
    name = arguments["model"]
    send.send(("asking", {"model": pathlib.Path(name).stem, "kind": "first run", "asked": ""}))
    model = Model(name, arguments["quads"], arguments["seed"], arguments["threads"])
    for kind in arguments["classes"]:
        # Each class draws by itself, so that one of them alone asks for the same.
        model.random = numpy.random.default_rng((arguments["seed"], CLASSES.index(kind)))
        for number in range(arguments["count"]):
            try:
                ask = getattr(model, kind)()
                if ask is None:
                    row = dict.fromkeys(COLUMNS, "") | {"model": model.name, "kind": kind, "number": number,
                                                        "word": "no place", "ok": False, "met": False}
                else:
                    send.send(("asking", {"kind": ask.kind, "number": number, "asked": ask.text}))
                    row = model.run(ask, number)
            except Exception:  # pylint: disable=broad-except
                row = dict.fromkeys(COLUMNS, "") | {"model": model.name, "kind": kind, "number": number, "met": False,
                                                    "word": "failed", "reason": traceback.format_exc(), "ok": False}
                while model.session.constraints():
                    model.session.undo()
            send.send(("row", row))


def cube_table(arguments, send):
    """The rows of the cube's table. A stroke of a large radius reaches the sides' borders, which leave it no room."""
    model = Model("cube", arguments["quads"], arguments["seed"], arguments["threads"])
    step = model.surface.edge

    def line(*points):
        points = numpy.array(points, float)
        pieces = [model.surface.straight(a, b, compare=True) for a, b in zip(points[:-1], points[1:])]
        return points, model.course(numpy.concatenate([points[:1]] + [piece[1:] for piece in pieces]))

    middle = numpy.array([0.5, 0.5, 1])
    asks = [Ask("valence", "3 at the middle of a side", lambda s: s.set_valence(middle, 3),
                lambda quads: judge.judge_valence(model.surface, quads, middle, 3))]
    for ends in (((0.2, 0.3, 1), (0.8, 0.6, 1)), ((0.2, 0.5, 1), (0.8, 0.5, 1)), ((0.2, 0.8, 1), (0.8, 0.2, 1))):
        asks.append(model.ask_feature(*line(*ends)))
    for radius, room in ((0, True), (0.1, True), (0.3, False)):
        asks.append(model.ask_stroke(*line((0.3, 0.2, 1), (0.7, 0.8, 1)), room, radius))
    asks.append(model.ask_size(middle, 0.4, 0.2))
    ring = numpy.array([(0, 0, 0.37), (1, 0, 0.37), (1, 1, 0.37), (0, 1, 0.37), (0, 0, 0.37)], float)
    asks.append(dataclasses.replace(model.ask_cycle(judge.Course(ring, step)), excuse=""))
    for number, ask in enumerate(asks):
        send.send(("asking", {"model": "cube", "kind": ask.kind, "number": number, "asked": ask.text}))
        send.send(("row", model.run(ask, number)))


# Tables.

def number(value):
    return f"{value:.2f}" if math.isfinite(value) else "none"


def spread(rows):
    """Median, 90 % and most of what is judged; infinite where nothing is there."""
    values = numpy.array([float(row["deviation"]) for row in rows if row["deviation"] != ""])
    if not len(values):
        return "", "", ""
    return tuple(number(float(numpy.quantile(values, q, method="higher"))) for q in (0.5, 0.9, 1))


def counts(rows):
    """What a row of the table says: of places that were drawn."""
    asked = [row for row in rows if row["word"] != "no place"]
    feasible = [row for row in asked if row["ok"] or row["met"] or not row["excuse"]]
    ok = sum(row["ok"] for row in feasible)
    shares = [float(row["share"]) for row in asked if row["share"] != ""]
    return (len(asked), len(feasible), ok, f"{100 * ok / len(feasible):.0f}" if feasible else "",
            sum(row["word"] == "refused" for row in asked), sum(row["word"] in ("failed", "crashed") for row in asked),
            sum(row["met"] and not row["ok"] for row in asked), sum(row["ok"] and not row["met"] for row in asked),
            *spread(asked), f"{numpy.median(shares):.2f}" if shares else "")


HEADINGS = ("model", "class", "n", "feasible", "ok", "%", "refused", "failed", "met, judged no", "not met, judged yes",
            "median", "90 %", "most", "share of the first run")


def tell(rows):
    print("| " + " | ".join(HEADINGS) + " |")
    print("|" + "---|" * len(HEADINGS))
    models = list(dict.fromkeys(row["model"] for row in rows))
    kinds = list(dict.fromkeys(row["kind"] for row in rows))
    for model, kind in [(m, k) for m in models + ["all"] for k in kinds]:
        of_both = [row for row in rows if model in (row["model"], "all") and row["kind"] == kind]
        if of_both:
            print(f"| {model} | {kind} | " + " | ".join(map(str, counts(of_both))) + " |")
    print()
    for row in rows:
        if row["word"] in ("met", "not met") and row["met"] != row["ok"]:
            told = f"{float(row['told']):.2f}" if row["told"] not in ("", None) else "nothing"
            print(f"{row['model']} {row['kind']} {row['number']}: {row['word']} with {told} {row['unit']}, judged "
                  f"{number(float(row['deviation']))}; {row['more']}")
        if row["met"] and "not met" in row["notices"]:
            print(f"{row['model']} {row['kind']} {row['number']}: met, and not met by a notice")
    reasons = collections.Counter()
    for row in rows:
        if row["word"] not in ("met", "no place"):
            seen = "judged yes" if row["ok"] else f"agreed: {row['excuse']}" if row["excuse"] else "not agreed"
            reason = re.sub(r"-?\d[\d,.]*(e-?\d+)?", "#", str(row["reason"]).strip().split("\n")[-1])
            reasons[f"{row['kind']}, {row['word']} ({seen}): {reason}"] += 1
    print()
    for reason, count in reasons.most_common():
        print(f"{count:4d}  {reason}")


def tell_rows(rows):
    """One line each."""
    print("| class | asked | word | told | judged | deviation | more | reason, notices |")
    print("|" + "---|" * 8)
    for row in rows:
        told = "" if row["told"] in ("", None) else f"{row['told']:.2f} {row['unit']}"
        print(f"| {row['kind']} | {row['asked']} | {row['word']} | {told} | {'yes' if row['ok'] else 'no'} | "
              f"{number(row['deviation'])} | {row['more']} | {row['reason']} {row['notices']} |")


def read_again(file):
    with open(file, encoding="utf-8", newline="") as opened:
        rows = list(csv.DictReader(opened))
    for row in rows:
        row["ok"], row["met"] = row["ok"] == "True", row["met"] == "True"
    return rows


def models_of(arguments):
    if arguments.model:
        return arguments.model
    parts = sorted(str(path) for path in arguments.parts.glob("*.stl"))[::EVERY]
    scans = [str(arguments.scans / name) for name in SCANS]
    return parts[:10] + scans + [str(ROOT / "Data" / "part.ply"), *MADE]


def main():
    shared = ROOT.parent / "shared" / "data"
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--model", action="append")
    parser.add_argument("--class", action="append", dest="classes", choices=CLASSES)
    parser.add_argument("--count", type=int, default=25)
    parser.add_argument("--quads", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--parts", type=pathlib.Path, default=shared / "parts", help="folder of STL files")
    parser.add_argument("--scans", type=pathlib.Path, default=shared / "scan", help="folder of " + " and ".join(SCANS))
    parser.add_argument("--out", help="file of comma-separated values for all rows")
    parser.add_argument("--again", help="such a file, whose table is told")
    parser.add_argument("--table", action="store_true", help="the rows of the cube's table")
    arguments = parser.parse_args()
    if arguments.again:
        tell(read_again(arguments.again))
        return 0
    if arguments.table:
        jobs = [(cube_table, {})]
    else:
        jobs = [(all_classes, {"model": model, "classes": arguments.classes or CLASSES, "count": arguments.count})
                for model in models_of(arguments)]
    rows = []
    with open(arguments.out or "/dev/null", "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        for job, content in jobs:
            same = {"quads": arguments.quads, "seed": arguments.seed, "threads": arguments.threads}
            for row in asked_of(job, dict(content, **same)):
                rows.append(row)
                writer.writerow(row)
                file.flush()
                if not arguments.table:
                    print(f"{row['model']} {row['kind']} {row['number']}: {row['word']}, judged "
                          f"{'yes' if row['ok'] else 'no'} {row['deviation']:.4} {row['more']}"
                          if row["deviation"] != "" else f"{row['model']} {row['kind']}: {row['word']}",
                          file=sys.stderr, flush=True)
    (tell_rows if arguments.table else tell)(rows)
    return 1 if any(row["word"] in ("failed", "crashed") for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
