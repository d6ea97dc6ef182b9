#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""A session of 40 mixed edits on a mesh, with undo, redo, save and load in between. Fails where a stage runs that need
not, or where the quads after every tenth edit are not, byte for byte, those of the same constraints from nothing.

  session_edits.py MESH [--quads N] [--seed N] [--threads N] [--edits N]
"""
import argparse
import os
import random
import sys
import tempfile
import time

import numpy

import quadrille

#: Stages that no edit but one of features and sizes may run.
PREPARED = {"repair", "order", "connectivity", "refine", "close", "handles", "phase1"}


class Edits:
    """One after the other, each kind in turn; places by a seed."""

    def __init__(self, mesh, quads, seed, threads):
        self.mesh = mesh
        self.threads = threads
        self.session = quadrille.Session(mesh, quads=quads, threads=threads)
        self.random = random.Random(seed)
        self.points = self.session._points
        self.sizes = numpy.linalg.norm(self.points.max(axis=0) - self.points.min(axis=0))
        self.normals = numpy.zeros_like(self.points)
        corners = numpy.asarray(quadrille.to_arrays(mesh)[1])[:, :3]
        a, b, c = (self.points[corners[:, i]] for i in range(3))
        numpy.add.at(self.normals, corners.ravel(), numpy.repeat(numpy.cross(b - a, c - a), 3, axis=0))
        self.guides, self.ids = [], []
        self.problems = []
        self.cold = None
        self.seconds = {}

    def point(self):
        return self.points[self.random.randrange(len(self.points))]

    def line(self):
        """Between two points near each other, also along the surface: on the same side of it."""
        at = self.random.randrange(len(self.points))
        start = self.points[at]
        near = numpy.linalg.norm(self.points - start, axis=1)
        around = numpy.flatnonzero((near > 0.05 * self.sizes) & (near < 0.1 * self.sizes) &
                                   (self.normals @ self.normals[at] > 0))
        return numpy.array([start, self.points[self.random.choice(around.tolist())]])

    def irregular(self, valence=None):
        found = self.session.irregular()
        among = [i for i in range(len(found.valence)) if valence is None or found.valence[i] == valence]
        return found.point[self.random.choice(among)] if among else None

    # Each returns the stages that may not run.

    def guide(self):
        self.guides.append(self.session.add_guide(self.line(), radius=0.02 * self.sizes))
        return PREPARED

    def turn_guide(self):
        if not self.guides:
            return self.guide()
        self.session.add_guide(self.line(), edit=self.random.choice(self.guides))
        return PREPARED

    def valence(self):
        self.ids.append(self.session.set_valence(self.point(), self.random.choice((3, 5))))
        return PREPARED

    def move(self):
        origin = self.irregular()
        if origin is None:
            return self.pair()
        self.ids.append(self.session.move_irregular(origin, self.line()[0]))
        return PREPARED

    def pair(self):
        self.ids.append(self.session.add_pair(*self.line()))
        return PREPARED

    def cancel(self):
        first, second = self.irregular(3), self.irregular(5)
        if first is None or second is None:
            return self.pair()
        self.ids.append(self.session.cancel_pair(first, second))
        return PREPARED

    def connect(self):
        """An irregular vertex and the one nearest to it."""
        found = self.session.irregular()
        if len(found.valence) < 2:
            return self.guide()
        first = found.point[self.random.randrange(len(found.valence))]
        second = found.point[numpy.argsort(numpy.linalg.norm(found.point - first, axis=1))[1]]
        self.ids.append(self.session.connect(first, second))
        return PREPARED

    def cycle(self):
        """Round the surface, in a plane through one of its points."""
        axis = self.random.randrange(3)
        at = self.point()[axis]
        slab = self.points[numpy.abs(self.points[:, axis] - at) < 0.01 * self.sizes]
        others = [k for k in range(3) if k != axis]
        middle = slab.mean(axis=0)
        angle = numpy.arctan2(slab[:, others[1]] - middle[others[1]], slab[:, others[0]] - middle[others[0]])
        ring = [slab[numpy.argmin(numpy.abs(angle - a))] for a in numpy.linspace(-numpy.pi, numpy.pi, 24, False)]
        self.ids.append(self.session.add_cycle(numpy.array(ring)))
        return PREPARED

    def feature(self):
        self.ids.append(self.session.add_feature(self.line()))
        return set()

    def size(self):
        self.ids.append(self.session.set_size(self.point(), 0.7, radius=0.05 * self.sizes))
        return set()

    def remove(self):
        if not self.ids:
            return self.guide()
        which = self.ids.pop(self.random.randrange(len(self.ids)))
        kind = next((c["kind"] for c in self.session.constraints() if c["id"] == which), None)
        if kind is None:
            return self.guide()
        self.session.remove(which)
        return set() if kind in ("feature", "size") else PREPARED

    KINDS = (guide, valence, move, connect, turn_guide, pair, cycle, cancel, remove, feature, size)

    def update(self, edit, forbidden):
        start = time.perf_counter()
        try:
            report = self.session.update()
        except quadrille.RemeshError as error:
            print(f"{edit:>3}: no quads: {error}")
            return
        seconds = time.perf_counter() - start
        ran = set(report["stages"])
        # Retries of an attempt may need phase 1 anew, which is no stage that the edit did not need.
        if report["runs"] <= 1 and ran & forbidden and "retries" not in ran:
            self.problems.append(f"edit {edit}: {sorted(ran & forbidden)} ran")
        if self.cold is None:
            self.cold = seconds
        else:
            self.seconds.setdefault(self.kind, []).append(seconds)
        met = sum(word["met"] for word in report["constraints"])
        print(f"{edit:>3}: {seconds:7.2f} s, {report['runs']} runs, {met} of {len(report['constraints'])} met, ran "
              f"{' '.join(report['stages']) or 'nothing'}")
        for word in report["constraints"]:
            if word["met"] == bool(word["reason"]):
                self.problems.append(f"edit {edit}: {word['text']} is met {word['met']}, reason {word['reason']!r}")

    def expect_nothing(self, edit, what, expected):
        start = time.perf_counter()
        report = self.session.update()
        seconds = time.perf_counter() - start
        if report["runs"] or report["stages"]:
            self.problems.append(f"edit {edit}: {what} ran {report['stages']}")
        if expected is not None and not all(map(numpy.array_equal, self.session.quads, expected)):
            self.problems.append(f"edit {edit}: {what} has other quads")
        self.seconds.setdefault("undo or redo", []).append(seconds)
        print(f"     {what}: {seconds:.4f} s")

    def undo_and_redo(self, edit):
        now = self.session.quads
        if self.session.undo():
            self.session.update()
            self.expect_nothing(edit, "the state before", None)
            self.session.redo()
            self.expect_nothing(edit, "redo", now)

    def compare_with_fresh(self, edit):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "session.json")
            self.session.save(file)
            start = time.perf_counter()
            fresh = quadrille.Session.load(file, self.mesh)
            fresh.set_settings(threads=self.threads)
            fresh.update()
            print(f"     from nothing: {time.perf_counter() - start:.2f} s")
            if not all(map(numpy.array_equal, self.session.quads, fresh.quads)):
                self.problems.append(f"edit {edit}: other quads than those of the same constraints from nothing")

    def run(self, count):
        self.kind = "cold"
        self.update(0, set())
        for edit in range(1, count + 1):
            kind = self.KINDS[(edit - 1) % len(self.KINDS)]
            self.kind = kind.__name__
            try:
                forbidden = kind(self)
            except quadrille.InvalidInput as error:
                print(f"{edit:>3}: {kind.__name__} is refused: {error}")
                continue
            print(f"     {kind.__name__}")
            self.update(edit, forbidden)
            if edit % 5 == 0:
                self.undo_and_redo(edit)
            if edit % 10 == 0:
                self.compare_with_fresh(edit)


    def tell(self):
        """What is not met, and the times as shares of the cold run."""
        for word in self.session.update()["constraints"]:
            if not word["met"]:
                print(f"not met: {word['text']}: {word['reason']}")
        for kind, seconds in self.seconds.items():
            median = sorted(seconds)[len(seconds) // 2]
            print(f"{kind:>12}: {median:8.3f} s, {100 * median / self.cold:6.1f} % of the cold run, "
                  f"median of {len(seconds)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("--quads", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--edits", type=int, default=40)
    arguments = parser.parse_args()
    edits = Edits(quadrille.read(arguments.mesh), arguments.quads, arguments.seed, arguments.threads)
    edits.run(arguments.edits)
    edits.tell()
    print("\n".join(edits.problems) or "session_edits: fine")
    return 1 if edits.problems else 0


if __name__ == "__main__":
    sys.exit(main())
