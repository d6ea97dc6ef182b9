#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Random sessions of random edits of all kinds, each in a process of its own. After every edit the quads are checked
here anew, with numpy: all quads, manifold, of the surface's topology, finite; every constraint has a word, an unmet one
a reason with a place, a met one is found in the quads; undo, redo and named states give the former quads byte for byte,
a loaded session the same as the one that was saved. Fails where any of this does not hold, or a process crashes.

  random_sessions.py MESH... [--quads N[,N...]] [--sessions N] [--edits N] [--seed N] [--jobs N] [--json FILE]
                     [--inside]

Session i is on mesh i modulo their number, with the seed --seed + i. --quads: one number, or one for each mesh. Places
are points of the mesh, or with --inside places in its faces, by their area.
"""
import argparse
import collections
import concurrent.futures
import hashlib
import importlib
import json
import math
import os
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time

import numpy

#: Edge lengths round an end, or a place, within which a chain, or an irregular vertex, is looked for.
REACH = 4
#: Below it a corner of a quad counts as inverted: its scaled Jacobian, which is 1 in a square.
INVERTED = 0.0
#: Edge lengths from the nearest point of the quads, from which on a place is not at one.
INSIDE = 0.1
#: A session that waits, and does not compute, ends after so many times its limit.
SLOWEST = 20


class Quads:
    """Points and quads, and what is asked of every quad mesh."""

    def __init__(self, points, quads):
        self.points, self.quads = points, quads
        self.digest = hashlib.sha256(points.tobytes() + quads.tobytes()).hexdigest()
        count = len(points)
        starts, ends = quads.ravel(), numpy.roll(quads, -1, axis=1).ravel()
        self.half_edges = starts.astype(numpy.int64) * count + ends
        low, high = numpy.minimum(starts, ends), numpy.maximum(starts, ends)
        edges, self.sides = numpy.unique(low.astype(numpy.int64) * count + high, return_counts=True)
        self.edges = numpy.stack((edges // count, edges % count), axis=1)
        self.valence = numpy.bincount(self.edges.ravel(), minlength=count)
        self.boundary = numpy.zeros(count, bool)
        self.boundary[self.edges[self.sides == 1].ravel()] = True
        self.length = float(numpy.median(numpy.linalg.norm(
            points[self.edges[:, 0]] - points[self.edges[:, 1]], axis=1))) if len(edges) else 0.0
        #: Of the irregular ones inside, and of corners on the boundary.
        self.index = 4 - self.valence - self.boundary
        self._corner = None

    def problems(self):
        if not numpy.isfinite(self.points).all():
            return "a point is not finite"
        if len(self.quads) == 0:
            return "there are no quads"
        ordered = numpy.sort(self.quads, axis=1)
        if (ordered[:, 1:] == ordered[:, :-1]).any():
            return "a quad has a corner twice"
        if self.sides.max() > 2:
            return "an edge has more than two quads"
        if len(numpy.unique(self.half_edges)) < len(self.half_edges):
            return "two quads run along an edge the same way"
        if (self.valence == 0).any():
            return "a point is in no quad"
        fans = self._fans()
        if fans != len(self.points):
            return f"{fans} fans of quads at {len(self.points)} points"
        if int(self.index.sum()) != 4 * self.euler():
            return "the indices do not sum up"
        return ""

    def _fans(self):
        """Corners, joined where they share an edge at their point: one fan a point in a manifold."""
        corner = {}
        for i, half in enumerate(self.half_edges.tolist()):
            corner[half] = i
        parent = list(range(len(self.half_edges)))

        def root(i):
            while parent[i] != i:
                parent[i] = parent[parent[i]]
                i = parent[i]
            return i
        count = len(self.points)
        for half, i in corner.items():
            # The half-edge from a to b and its twin: the corner at a, and the twin's next corner at a.
            twin = corner.get(half % count * count + half // count)
            if twin is not None:
                parent[root(twin - twin % 4 + (twin + 1) % 4)] = root(i)
        return sum(1 for i in range(len(parent)) if root(i) == i)

    def euler(self):
        return len(self.points) - len(self.edges) + len(self.quads)

    def shape(self):
        """Euler characteristic, boundary loops and components, which a constraint may not change."""
        parent = list(range(len(self.points)))

        def root(i):
            while parent[i] != i:
                parent[i] = parent[parent[i]]
                i = parent[i]
            return i
        for a, b in self.edges.tolist():
            parent[root(a)] = root(b)
        components = sum(1 for i in range(len(parent)) if root(i) == i)
        parent = list(range(len(self.points)))
        for a, b in self.edges[self.sides == 1].tolist():
            parent[root(a)] = root(b)
        loops = len({root(i) for i in numpy.flatnonzero(self.boundary).tolist()})
        return self.euler(), loops, components

    def inverted(self):
        """Quads with a corner whose scaled Jacobian, against the quad's own normal, is not above 0."""
        p = self.points[self.quads]
        normal = numpy.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
        worst = numpy.full(len(p), numpy.inf)
        for i in range(4):
            worst = numpy.minimum(worst, numpy.einsum(
                "ij,ij->i", normal, numpy.cross(p[:, (i + 1) % 4] - p[:, i], p[:, (i + 3) % 4] - p[:, i])))
        return int((worst <= INVERTED).sum())

    def near(self, place, reach):
        return numpy.flatnonzero(numpy.linalg.norm(self.points - place, axis=1) <= reach)

    def nearest(self, place):
        return int(numpy.argmin(numpy.linalg.norm(self.points - place, axis=1)))

    def prepare(self):
        """What walks need."""
        if self._corner is None:
            self._corner = dict(zip(self.half_edges.tolist(), range(len(self.half_edges))))
            self._flat = self.quads.ravel().tolist()
            self._around = collections.defaultdict(list)
            for a, b in self.edges.tolist():
                self._around[a].append(b)
                self._around[b].append(a)

    def straight_on(self, a, b, left=True):
        """The point after b on the chain from a, with two quads on that side of b; None past a boundary."""
        count, step = len(self.points), 2 if left else 3
        i = self._corner.get(a * count + b if left else b * count + a)
        if i is None:
            return None
        c = self._flat[i - i % 4 + (i + step) % 4]
        i = self._corner.get(c * count + b if left else b * count + c)
        return None if i is None else self._flat[i - i % 4 + (i + step) % 4]

    def lines_from(self, start, most):
        """The straight chains of edges out of a point: lists of points, up to an irregular one, the boundary or the
        start again."""
        self.prepare()
        for second in self._around[start]:
            chain = [start, second]
            while len(chain) <= most and chain[-1] != start:
                last = chain[-1]
                following = None if self.boundary[last] or self.valence[last] != 4 else self.straight_on(
                    chain[-2], last)
                if following is None:
                    break
                chain.append(following)
            yield chain

    def loops_from(self, start, most):
        """Closed chains through a point that are straight on one side everywhere."""
        self.prepare()
        for second in self._around[start]:
            for left in (True, False):
                chain = [start, second]
                while len(chain) <= most:
                    following = self.straight_on(chain[-2], chain[-1], left)
                    if following is None:
                        break
                    if chain[-1] == start and following == second:
                        yield chain
                        break
                    chain.append(following)


def has_chain(quads, points):
    """A straight chain from near the first to near the last point."""
    reach = REACH * quads.length
    ends = numpy.zeros(len(quads.points), bool)
    ends[quads.near(points[-1], reach)] = True
    steps = 8 * (2 + int(numpy.linalg.norm(numpy.diff(points, axis=0), axis=1).sum() / quads.length))
    return any(ends[chain].any() for start in quads.near(points[0], reach).tolist()
               for chain in quads.lines_from(start, steps))


def has_loop(quads, points, reach):
    """A closed straight chain near all points of a closed polyline."""
    closed = numpy.vstack((points, points[:1]))
    steps = 8 * (4 + int(numpy.linalg.norm(numpy.diff(closed, axis=0), axis=1).sum() / quads.length))
    return any(all(numpy.linalg.norm(quads.points[chain] - p, axis=1).min() <= reach for p in points)
               for start in quads.near(points[0], reach).tolist() for chain in quads.loops_from(start, steps))


class RandomSession:
    def __init__(self, mesh, quads, seed, inside):
        import quadrille
        self.quadrille = quadrille
        self.mesh = quadrille.read(mesh)
        self.random = random.Random(seed)
        self.session = quadrille.Session(self.mesh, quads=quads, threads=1)
        self.points = self.session._points
        _, faces = quadrille.to_arrays(self.mesh)
        self.faces = len(faces)
        self.corners = None
        if inside:
            self.corners = self.points[faces[:, :3]]
            areas = numpy.linalg.norm(numpy.cross(self.corners[:, 1] - self.corners[:, 0],
                                                  self.corners[:, 2] - self.corners[:, 0]), axis=1)
            self.areas = numpy.cumsum(areas).tolist()
        self.size = float(numpy.linalg.norm(self.points.max(axis=0) - self.points.min(axis=0)))
        self.problems, self.edits = [], []
        self.count = quads
        #: Digests of the quads of every state of the history, None before the update, and where it stands.
        self.history, self.at = [None], 0
        self.named = {}
        self.shapes = {}
        self.now = None
        self.inverted = 0

    # Places.

    def point(self):
        if self.corners is None:
            return self.points[self.random.randrange(len(self.points))]
        face = self.random.choices(range(len(self.corners)), cum_weights=self.areas)[0]
        first, second = sorted((self.random.random(), self.random.random()))
        return numpy.array((first, second - first, 1 - second)) @ self.corners[face]

    def place(self):
        """Mostly on the surface; now and then away from it."""
        p = self.point()
        if self.random.random() < 0.1:
            p = p + self.size * numpy.array([self.random.uniform(-0.3, 0.3) for _ in range(3)])
        return p

    def line(self, most=4):
        """Points one after the other; near each other, or anywhere, or all the same."""
        start = self.place()
        how = self.random.random()
        if how < 0.05:
            return numpy.array([start, start])
        if how < 0.25:
            return numpy.array([start] + [self.place() for _ in range(self.random.randint(1, most - 1))])
        reach = self.size * self.random.choice((0.02, 0.05, 0.1, 0.2))
        line = [start]
        for _ in range(self.random.randint(1, most - 1)):
            around = numpy.flatnonzero(numpy.linalg.norm(self.points - line[-1], axis=1) <= reach)
            line.append(self.points[self.random.choice(around.tolist())] if len(around) else self.place())
        return numpy.array(line)

    def irregular(self):
        """A place at, or near, an irregular vertex, or anywhere."""
        found = self.session.irregular()
        if len(found.valence) == 0 or self.random.random() < 0.2:
            return self.place()
        return found.point[self.random.randrange(len(found.valence))]

    def irregular_of(self, valence):
        found = self.session.irregular()
        among = numpy.flatnonzero(found.valence == valence).tolist()
        return found.point[self.random.choice(among)] if among else self.place()

    def some_faces(self):
        return [self.random.randrange(self.faces) for _ in range(self.random.randint(1, 40))]

    def editable(self, *kinds):
        """One that is there already, or None: then a new one is made."""
        if self.random.random() < 0.8:
            return None
        there = [c["id"] for c in self.session.constraints() if c["kind"] in kinds]
        return self.random.choice(there) if there else None

    # Edits. Each returns what it was, for the summary; those that enter a state call entered().

    def guide(self):
        if self.random.random() < 0.3:
            self.session.add_guide(faces=self.some_faces(), direction=[self.random.gauss(0, 1) for _ in range(3)],
                                   weight=self.random.uniform(0.05, 1), edit=self.editable("guide region"))
        else:
            self.session.add_guide(self.line(), weight=self.random.uniform(0.05, 1),
                                   radius=self.size * self.random.choice((0, 0.01, 0.05, 0.2)),
                                   edit=self.editable("guide"))
        self.entered()

    def valence(self):
        self.session.set_valence(self.place() if self.random.random() < 0.7 else self.irregular(),
                                 self.random.choice((2, 3, 3, 4, 5, 5, 6, 7, 8)), edit=self.editable("valence"))
        self.entered()

    def feature(self):
        if self.random.random() < 0.3:
            self.session.clear_feature(self.place() if self.random.random() < 0.5 else self.irregular(),
                                       edit=self.editable("cleared feature"))
        else:
            self.session.add_feature(self.line(), edit=self.editable("feature"))
        self.entered()

    def sizes(self):
        factor = math.exp(self.random.uniform(math.log(0.3), math.log(3)))
        if self.random.random() < 0.3:
            self.session.set_size(faces=self.some_faces(), factor=factor, edit=self.editable("size region"))
        else:
            self.session.set_size(self.place(), factor, radius=self.size * self.random.choice((0, 0.02, 0.1, 0.3)),
                                  edit=self.editable("size"))
        self.entered()

    def connection(self):
        start = self.irregular()
        end = self.irregular()
        found = self.session.irregular()
        if len(found.valence) > 1 and self.random.random() < 0.6:
            order = numpy.argsort(numpy.linalg.norm(found.point - start, axis=1))
            end = found.point[order[min(len(order) - 1, self.random.randint(1, 3))]]
        if self.random.random() < 0.3:
            line = self.line()
            line[0], line[-1] = start, end
            self.session.connect(line, edit=self.editable("connection"))
        else:
            self.session.connect(start, end, edit=self.editable("connection"))
        self.entered()

    def cycle(self):
        how = self.random.random()
        if how < 0.2:
            ring = self.line(6)
            ring = ring if len(ring) > 2 else numpy.array([self.place() for _ in range(3)])
        else:
            # Round the surface in a plane, or a ring on it.
            axis = numpy.array([self.random.gauss(0, 1) for _ in range(3)]) if how < 0.5 else numpy.eye(3)[
                self.random.randrange(3)]
            axis = axis / numpy.linalg.norm(axis)
            centre = self.point()
            height = (self.points - centre) @ axis
            slab = self.points[numpy.abs(height) < 0.01 * self.size]
            if self.corners is not None:
                slab = numpy.vstack((slab, centre))
            if how > 0.8:
                away = numpy.linalg.norm(slab - centre, axis=1)
                slab = slab[away < 0.2 * self.size]
            middle = slab.mean(axis=0)
            across = numpy.cross(axis, numpy.eye(3)[numpy.argmin(numpy.abs(axis))])
            across /= numpy.linalg.norm(across)
            angle = numpy.arctan2((slab - middle) @ numpy.cross(axis, across), (slab - middle) @ across)
            ring = numpy.array([slab[numpy.argmin(numpy.abs(angle - a))]
                                for a in numpy.linspace(-math.pi, math.pi, self.random.choice((4, 8, 24)), False)])
        self.session.add_cycle(ring, edit=self.editable("cycle"))
        self.entered()

    def move(self):
        target = self.place() if self.random.random() < 0.5 else self.near(self.irregular())
        self.session.move_irregular(self.irregular(), target)
        self.entered()

    def near(self, place):
        around = numpy.flatnonzero(numpy.linalg.norm(self.points - place, axis=1) <= 0.1 * self.size)
        return self.points[self.random.choice(around.tolist())] if len(around) else self.place()

    def split(self):
        at = self.irregular()
        valences = self.random.choice((None, (3, 3), (5, 5), (3, 4), (5, 4), (3, 6), (5, 3), (2, 8)))
        self.session.split_irregular(at, self.near(at), self.near(at), valences)
        self.entered()

    def merge(self):
        self.session.merge_irregular(self.irregular(), self.irregular(),
                                     self.place() if self.random.random() < 0.5 else None)
        self.entered()

    def cancel(self):
        self.session.cancel_pair(self.irregular_of(3), self.irregular_of(5))
        self.entered()

    def pair(self):
        at = self.place()
        self.session.add_pair(at, self.near(at), self.random.choice((None, None, (5, 3), (2, 6), (4, 4))))
        self.entered()

    def symmetry(self):
        if self.random.random() < 0.6:
            self.session.set_symmetry()
        else:
            self.session.set_symmetry(self.points.mean(axis=0), [self.random.gauss(0, 1) for _ in range(3)])
        self.entered()

    def settings(self):
        before = self.session.settings()
        self.session.set_settings(**self.random.choice((
            {"quads": int(self.count * self.random.uniform(0.6, 1.5))}, {"feature_angle": self.random.choice((25, 40))},
            {"smoothing_steps": self.random.choice((0, 3, 10))}, {"coarse_vertices": self.random.choice((500, 2000))},
            {"final_quality": True}, {"final_quality": False}, {"threads": 2}, {"chord_error": 0.01 * self.size})))
        if self.session.settings() != before:
            self.entered()

    def remove(self):
        there = [c["id"] for c in self.session.constraints()]
        if there:
            self.session.remove(self.random.choice(there))
            self.entered()
        return bool(there)

    def undo(self):
        if self.session.undo() != (self.at > 0):
            self.problem("undo goes where there is nothing, or does not go")
        self.at = max(0, self.at - 1)

    def redo(self):
        if self.session.redo() != (self.at + 1 < len(self.history)):
            self.problem("redo goes where there is nothing, or does not go")
        self.at = min(len(self.history) - 1, self.at + 1)

    def name(self):
        name = self.random.choice("ABC")
        self.session.state(name)
        self.named[name] = self.history[self.at]

    def go(self):
        if not self.named:
            return self.name()
        name = self.random.choice(sorted(self.named))
        self.session.compare(name)
        self.session.go_to(name)
        self.entered(self.named[name])

    def reload(self):
        """Goes on with what was read back, which has no history."""
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "session.json")
            self.session.save(file)
            read = self.quadrille.Session.load(file, self.mesh)
        read.set_settings(threads=1)
        if sorted(read.states()) != sorted(self.session.states()):
            self.problem("the file has other named states")
        self.session = read
        self.history, self.at = [self.history[self.at]], 0

    def preview(self):
        try:
            points, quads = self.session.preview()
        except self.quadrille.InvalidInput:
            if not any(c["kind"] == "symmetry" for c in self.session.constraints()):
                raise
            return
        text = Quads(points, quads).problems()
        if text:
            self.problem("preview: " + text)

    KINDS = (guide, guide, valence, valence, feature, feature, sizes, sizes, connection, connection, connection, cycle,
             cycle, move, move, move, split, merge, cancel, cancel, pair, pair, symmetry, settings, settings, undo,
             undo, undo, redo, redo, name, go, reload, preview, remove, remove)

    def entered(self, digest=None):
        del self.history[self.at + 1:]
        self.history.append(digest)
        self.at += 1

    # Checks.

    def problem(self, text):
        self.problems.append(f"edit {len(self.edits)} ({self.kind}): {text}")

    def shape(self):
        """Of the quads of the same settings without constraints; None where there are none."""
        settings = self.session.settings()
        key = json.dumps(settings, sort_keys=True)
        if key not in self.shapes:
            bare = self.quadrille.Session(self.mesh, threads=1, quads=1)
            bare.set_settings(**{name: value for name, value in settings.items() if value is not None})
            bare.set_settings(feature_angle=settings["feature_angle"])
            try:
                made = Quads(*bare.quads)
                self.shapes[key] = made.shape(), made.inverted()
            except self.quadrille.RemeshError:
                self.shapes[key] = None
        return self.shapes[key]

    def check(self):
        constraints = self.session.constraints()
        try:
            report = self.session.update()
        except self.quadrille.RemeshError as error:
            if not str(error):
                self.problem("no quads without a reason")
            elif constraints and self.shape() is not None:
                self.problem(f"no quads, but without constraints there are: {error}")
            self.history[self.at] = None
            return None
        made = Quads(*self.session.quads)
        text = made.problems()
        if text:
            self.problem(text)
            return report
        mirrored = any(word["kind"] == "symmetry" and not word["met"] and "not alike" in word["reason"]
                       for word in report["constraints"])
        if constraints and not mirrored and self.shape() is not None and made.shape() != self.shape()[0]:
            self.problem(f"topology {made.shape()}, but {self.shape()[0]} without constraints")
        elif not constraints:
            self.shapes[json.dumps(self.session.settings(), sort_keys=True)] = made.shape(), made.inverted()
        inverted = made.inverted()
        self.inverted += 1 if inverted > (self.shape()[1] if self.shape() else 0) else 0
        known = self.history[self.at]
        if known is not None and known != made.digest:
            self.problem("other quads than this state had before")
        self.history[self.at] = made.digest
        self.words(report, constraints, made)
        self.now = made
        return report

    def words(self, report, constraints, made):
        words = {word["id"]: word for word in report["constraints"]}
        if sorted(words) != sorted(c["id"] for c in constraints) or len(words) != len(report["constraints"]):
            self.problem("not one word for each constraint")
        for constraint in constraints:
            word = words.get(constraint["id"])
            if word is None:
                continue
            if word["met"] == bool(word["reason"]):
                self.problem(f"{word['text']} is met {word['met']}, reason {word['reason']!r}")
            if not all(isinstance(x, float) and math.isfinite(x) for x in word["place"]):
                self.problem(f"{word['text']} has no place: {word['place']}")
            if word["met"]:
                text = self.found(constraint, word, made)
                if text:
                    self.problem(f"{word['text']} is told as met, but {text}")

    def found(self, constraint, word, made):
        """Why a constraint that is told as met is not in the quads; empty where it is, or is not looked for."""
        kind = constraint["kind"]
        if kind == "valence":
            at = made.nearest(word["place"])
            # Where nothing irregular is wanted the place lies inside a quad, or on an edge, as well as on a vertex.
            inside = numpy.linalg.norm(made.points[at] - word["place"]) > INSIDE * made.length
            if constraint["valence"] == 4 and inside:
                return ""
            valence = int(made.valence[at] + made.boundary[at])
            return "" if valence == constraint["valence"] else f"the valence at {made.points[at]} is {valence}"
        if kind in ("connection", "cycle"):
            # What lies off the surface stands for its place on it.
            points = made.points[[made.nearest(p) for p in constraint["points"]]]
        if kind == "connection":
            return "" if has_chain(made, points) else "there is no straight chain between its ends"
        if kind == "cycle":
            reach = (REACH + 2 + (word["deviation"] or 0)) * made.length
            return "" if has_loop(made, points, reach) else "there is no closed straight chain there"
        if kind == "symmetry":
            image = self.session.mirror_point
            if image is None or not numpy.array_equal(image[image], numpy.arange(len(made.points))):
                return "the images are no permutation that is its own inverse"
            faces = {tuple(sorted(q)) for q in made.quads.tolist()}
            if {tuple(sorted(q)) for q in image[made.quads].tolist()} != faces:
                return "the quads are not those of their image"
        return ""

    def others(self, before, after, constraint):
        """After an operation that is told as met: irregular vertices of the quads that came or went elsewhere."""
        reach = REACH * max(before.length, after.length)
        # Places beside the surface are taken to it, on a fine mesh about to its nearest point.
        places = [p for given in constraint["points"] for p in (
            given, self.points[numpy.argmin(numpy.linalg.norm(self.points - given, axis=1))])]
        if constraint["operation"] != "add":
            # What it took was the nearest irregular vertex that can move, which need not be near: its word has it.
            taken = places[:4 if constraint["operation"] in ("merge", "cancel") else 2]
            irregular = numpy.flatnonzero(before.index != 0)
            places += [before.points[irregular[numpy.argsort(numpy.linalg.norm(
                before.points[irregular] - p, axis=1))[:3]]] for p in taken]
            places.append(constraint["place"])
        places = numpy.vstack(places)

        def unmatched(these, those):
            there = numpy.flatnonzero(those.index != 0)
            for at in numpy.flatnonzero(these.index != 0):
                p = these.points[at]
                same = there[those.index[there] == these.index[at]]
                if len(same) and numpy.linalg.norm(those.points[same] - p, axis=1).min() <= reach:
                    continue
                if numpy.linalg.norm(places - p, axis=1).min() > reach:
                    yield f"{4 - these.index[at]} at {numpy.round(p, 3).tolist()}"
        gone, came = list(unmatched(before, after)), list(unmatched(after, before))
        if not gone and not came:
            return ""
        return f"elsewhere {', '.join(gone) or 'nothing'} went and {', '.join(came) or 'nothing'} came"

    def run(self, count):
        self.kind = "start"
        self.check()
        for _ in range(count):
            edit = self.random.choice(self.KINDS)
            self.kind = edit.__name__
            entry = {"kind": self.kind}
            self.edits.append(entry)
            start = time.perf_counter()
            before = self.now
            entry["refused"] = ""
            try:
                edit(self)
            except self.quadrille.InvalidInput as error:
                entry["refused"] = str(error)
                if not str(error):
                    self.problem("refused without a reason")
            except self.quadrille.RemeshError as error:
                entry["refused"] = str(error)
            report = self.check()
            entry["seconds"] = time.perf_counter() - start
            if report is None:
                entry["no quads"] = True
                continue
            last = self.session.constraints()[-1:]
            if (self.kind in ("move", "split", "merge", "cancel", "pair") and not entry["refused"] and before and
                    last[0]["met"] and not any(c["kind"] == "symmetry" for c in self.session.constraints())):
                text = self.others(before, self.now, last[0])
                if text:
                    self.problem(f"{last[0]['text']} is told as met, but {text}")
            entry["runs"] = report["runs"]
            entry["words"] = [{"kind": word["kind"], "met": word["met"], "reason": word["reason"],
                               "place": word["place"]} for word in report["constraints"]]
        return {"edits": self.edits, "problems": self.problems, "inverted": self.inverted,
                "shape": self.now.shape() if self.now else None}


def run_one(mesh, quads, seed, edits, limit, inside):
    """In a process of its own, so that a crash is counted."""
    start = time.time()
    command = [sys.executable, os.path.abspath(__file__), mesh, "--quads", str(quads), "--seed", str(seed), "--edits",
               str(edits), "--limit", str(limit), "--one"] + ["--inside"] * inside
    result = {"mesh": os.path.basename(mesh), "seed": seed}
    waited = SLOWEST * limit
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=waited)
    except subprocess.TimeoutExpired:
        return dict(result, crash=f"not done after {waited:g} s", seconds=time.time() - start)
    result["seconds"] = time.time() - start
    if done.returncode == -signal.SIGXCPU:
        return dict(result, crash=f"not done after {limit:g} s of a processor")
    if done.returncode != 0 or not done.stdout.startswith("{"):
        return dict(result, crash=f"code {done.returncode}: {done.stderr[-2000:]}")
    return dict(result, **json.loads(done.stdout))


def without_numbers(text):
    return re.sub(r"-?\d+(\.\d+)?(e-?\d+)?", "#", text)


def summary(results):
    words = collections.Counter()
    reasons = collections.Counter()
    kinds = collections.Counter()
    refused = collections.Counter()
    for result in results:
        for edit in result.get("edits", ()):
            kinds[edit["kind"]] += 1
            if edit["refused"]:
                refused[without_numbers(edit["refused"])] += 1
        # The words of the last state: each constraint once.
        last = next((e["words"] for e in reversed(result.get("edits", ())) if "words" in e), ())
        for word in last:
            words[word["kind"] + (" met" if word["met"] else " not met")] += 1
            if not word["met"]:
                reasons[f"{word['kind']}: {without_numbers(word['reason'])}"] += 1
    crashes = [r for r in results if "crash" in r]
    problems = [f"{r['mesh']} seed {r['seed']}: {text}" for r in results for text in r.get("problems", ())]
    return {"sessions": len(results), "edits": sum(kinds.values()), "crashes": len(crashes),
            "problems": len(problems), "edits without quads": sum(
                "no quads" in e for r in results for e in r.get("edits", ())),
            "states with more inverted quads than without constraints": sum(r.get("inverted", 0) for r in results),
            "kinds": dict(kinds.most_common()), "words": dict(sorted(words.items())),
            "refused": dict(refused.most_common()), "reasons": dict(reasons.most_common()),
            "crashed": [{"mesh": r["mesh"], "seed": r["seed"], "why": r["crash"]} for r in crashes],
            "problem list": problems}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", nargs="+")
    parser.add_argument("--quads", default="2000")
    parser.add_argument("--sessions", type=int, default=10)
    parser.add_argument("--edits", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--limit", type=float, default=300,
                        help="seconds of a processor for one session, whatever else the machine does")
    parser.add_argument("--json", help="file for all results")
    parser.add_argument("--inside", action="store_true", help="places in faces, not at points of the mesh")
    parser.add_argument("--one", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    quads = [int(text) for text in arguments.quads.split(",")]
    importlib.import_module("quadrille")  # where it is missing, that is told once
    if arguments.one:
        seconds = math.ceil(arguments.limit)
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
        session = RandomSession(arguments.mesh[0], quads[0], arguments.seed, arguments.inside)
        print(json.dumps(session.run(arguments.edits)))
        return 0
    quads = quads * len(arguments.mesh) if len(quads) == 1 else quads
    if len(quads) != len(arguments.mesh):
        parser.error(f"{len(quads)} numbers of quads for {len(arguments.mesh)} meshes")
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        runs = [pool.submit(run_one, arguments.mesh[i % len(quads)], quads[i % len(quads)], arguments.seed + i,
                            arguments.edits, arguments.limit, arguments.inside) for i in range(arguments.sessions)]
        results = []
        for run in concurrent.futures.as_completed(runs):
            result = run.result()
            results.append(result)
            bad = result.get("crash") or "; ".join(result.get("problems", ()))
            print(f"{result['mesh']:>24} seed {result['seed']:>5} {result['seconds']:6.1f} s {bad or 'fine'}",
                  flush=True)
    results.sort(key=lambda result: result["seed"])
    told = summary(results)
    if arguments.json:
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump({"summary": told, "sessions": results}, file, indent=1)
    for name, value in told.items():
        if not isinstance(value, (dict, list)):
            print(f"{name}: {value}")
    print("words:", ", ".join(f"{name} {count}" for name, count in told["words"].items()))
    bad = told["crashes"] + told["problems"]
    print("random_sessions: fine" if bad == 0 else f"random_sessions: {bad} bad")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
