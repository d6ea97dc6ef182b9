#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Makes Quadrille's own test surfaces, at any resolution from about 5 thousand to 10 million faces.

  Data/generate.py SHAPE FACES OUT.{ply,vtk} [--check]

Shapes:
  part   flange with a pipe stub: sharp and rounded edges, four chamfered through holes and a bore, open
         at the end of the stub (two boundary loops); genus 4; face property PatchId
  beast  an organic closed shape with head, ears, legs and a tail; genus 0
  frame  the rounded edges of a tetrahedron as struts; closed, genus 3

The number of faces comes within a few percent of what is asked for (eight below 10 thousand). The output is binary PLY,
or VTK's legacy format, whose reader keeps PatchId, and depends on the arguments only. --check counts the topology anew
and fails where it is not what it should be. Needs Python 3 and numpy.
"""
import argparse
import sys
import time

import numpy as np

# Euler characteristic and boundary loops: chi = 2 - 2 genus - loops.
EXPECTED = {"part": (-8, 2), "beast": (2, 0), "frame": (-4, 0)}


# ---------------------------------------------------------------------------------------------- part
# Lengths in millimetres. The plate is cut into 3 x 3 cells (CELL_X, CELL_Y are the inner lines), so that every
# face of the part is a structured block and neighbours share their samples.
HALF_X, HALF_Y, CORNER = 60.0, 52.0, 14.0   # plate, radius of its corners in plan
CELL_X, CELL_Y = 24.0, 24.0
TOP, ROUND = 12.0, 3.0                      # thickness, radius of the upper edge
HOLE, CHAMFER, HOLE_X, HOLE_Y = 7.0, 1.5, 42.0, 37.0
STUB, FILLET, BORE, STUB_TOP = 14.0, 5.0, 8.0, 42.0


def segment(a, b, count):
    """Samples from a to b without b."""
    t = np.arange(count)[:, None] / count
    return np.asarray(a, float) * (1 - t) + np.asarray(b, float) * t


class Part:
    """Structured blocks of the flange at edge length h; `blocks` holds (grid of points, patch id)."""

    def __init__(self, h):
        self.h = h
        self.blocks = []
        outline, normal, corners = self.plateOutline()
        self.plane(outline, corners, 0.0, BORE, HOLE, patch=2, up=False)
        self.plane(outline - ROUND * normal, corners, TOP, STUB + FILLET, HOLE + CHAMFER, patch=1, up=True)
        self.rim(outline, normal)
        self.stub()
        self.holes(corners, outline, normal)

    def count(self, length):
        return max(2, int(round(length / self.h)))

    def plateOutline(self):
        """Counterclockwise points and normals of the plate's outline, and where its cells begin."""
        straightX, straightY = HALF_X - CORNER, HALF_Y - CORNER
        points, normals, cells = [], [], []
        total = 0

        def add(p, n):
            nonlocal total
            points.append(p)
            normals.append(n)
            total += len(p)

        centres = [(straightX, -straightY), (straightX, straightY), (-straightX, straightY), (-straightX, -straightY)]
        for k, (cx, cy) in enumerate(centres):
            # side k: middle cell, then the corner cell (straight, arc, straight)
            along = np.array([(1, 0), (0, 1), (-1, 0), (0, -1)][k], float)
            out = np.array([(0, -1), (1, 0), (0, 1), (-1, 0)][k], float)
            half = CELL_X if k % 2 == 0 else CELL_Y
            base = out * (HALF_Y if k % 2 == 0 else HALF_X)
            straight = straightX if k % 2 == 0 else straightY
            middle = segment(base - along * half, base + along * half, self.count(2 * half))
            cells.append(total)
            add(middle, np.tile(out, (len(middle), 1)))
            cells.append(total)
            lead = segment(base + along * half, base + along * straight, self.count(straight - half))
            add(lead, np.tile(out, (len(lead), 1)))
            start = np.arctan2(out[1], out[0])
            arc = self.count(CORNER * np.pi / 2)
            angle = start + np.arange(arc) / arc * np.pi / 2
            direction = np.stack([np.cos(angle), np.sin(angle)], 1)
            add(np.array([cx, cy]) + CORNER * direction, direction)
            nextOut = np.array([-out[1], out[0]])
            nextHalf = CELL_Y if k % 2 == 0 else CELL_X
            nextStraight = straightY if k % 2 == 0 else straightX
            nextBase = nextOut * (HALF_X if k % 2 == 0 else HALF_Y)
            tail = segment(nextBase - out * -nextStraight, nextBase - out * -nextHalf,
                           self.count(nextStraight - nextHalf))
            add(tail, np.tile(nextOut, (len(tail), 1)))
        return np.concatenate(points), np.concatenate(normals), cells

    def cornerLoop(self, k, outline, cells):
        """Counterclockwise outline of corner cell k, and the angles of its points about the hole."""
        begin = cells[2 * k + 1]
        end = cells[2 * k + 2] if 2 * k + 2 < len(cells) else len(outline)
        outer = outline[np.arange(begin, end + 1) % len(outline)]
        corner = np.array([(CELL_X, -CELL_Y), (CELL_X, CELL_Y), (-CELL_X, CELL_Y), (-CELL_X, -CELL_Y)][k])
        inward = segment(outer[-1], corner, self.count(HALF_X - CELL_X if k % 2 == 0 else HALF_Y - CELL_Y))
        outward = segment(corner, outer[0], self.count(HALF_Y - CELL_Y if k % 2 == 0 else HALF_X - CELL_X))
        return np.concatenate([outer[:-1], inward, outward])

    def centreLoop(self):
        """Counterclockwise outline of the middle cell."""
        x, y = CELL_X, CELL_Y
        nx, ny = self.count(2 * x), self.count(2 * y)
        return np.concatenate([segment((-x, -y), (x, -y), nx), segment((x, -y), (x, y), ny),
                               segment((x, y), (-x, y), nx), segment((-x, y), (-x, -y), ny)])

    @staticmethod
    def circle(loop, centre, radius):
        """Points of the circle seen from its centre in the directions of the loop's points."""
        d = loop - centre
        return centre + radius * d / np.linalg.norm(d, axis=1)[:, None]

    def ring(self, inner, outer, z, patch, up):
        """Block between two closed loops in a plane."""
        gap = np.linalg.norm(outer - inner, axis=1).mean()
        t = np.linspace(0, 1, max(2, int(round(gap / self.spacing(inner, outer)))) + 1)[:, None, None]
        grid = inner[None] * (1 - t) + outer[None] * t
        self.add(self.lift(grid, z), patch, closed=True, flip=not up)

    def spacing(self, *loops):
        mean = np.mean([np.linalg.norm(np.roll(l, -1, 0) - l, axis=1).mean() for l in loops])
        return np.sqrt(mean * self.h)

    @staticmethod
    def lift(grid, z):
        return np.concatenate([grid, np.full(grid.shape[:-1] + (1,), z)], -1)

    def plane(self, outline, cells, z, boreRadius, holeRadius, patch, up):
        centre = self.centreLoop()
        self.ring(self.circle(centre, np.zeros(2), boreRadius), centre, z, patch, up)
        for k in range(4):
            loop = self.cornerLoop(k, outline, cells)
            self.ring(self.circle(loop, self.holeCentre(k), holeRadius), loop, z, patch, up)
            begin, end = cells[2 * k], cells[2 * k + 1]
            outer = outline[begin:end + 1]
            half = np.array([CELL_X, CELL_Y])
            a = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)][k]) * half
            b = np.array([(1, -1), (1, 1), (-1, 1), (-1, -1)][k]) * half
            inner = np.concatenate([segment(a, b, end - begin), [b]])
            t = np.linspace(0, 1, self.count(HALF_Y - CELL_Y if k % 2 == 0 else HALF_X - CELL_X) + 1)[:, None, None]
            self.add(self.lift(inner[None] * (1 - t) + outer[None] * t, z), patch, closed=False, flip=not up)

    @staticmethod
    def holeCentre(k):
        return np.array([(HOLE_X, -HOLE_Y), (HOLE_X, HOLE_Y), (-HOLE_X, HOLE_Y), (-HOLE_X, -HOLE_Y)][k])

    def sweep(self, base, normal, profile, patch, step, flip):
        """Sweeps a profile (offset along the normal, z) round a closed loop, cut to pieces of length step."""
        profile = np.asarray(profile, float)
        length = np.linalg.norm(np.diff(profile, axis=0), axis=1)
        s = np.concatenate([[0], np.cumsum(length)])
        # A rounding keeps six pieces, so that it stays one at low resolution: 15 degrees each.
        n = max(6 if len(profile) > 2 else 2, int(round(s[-1] / step)))
        t = np.linspace(0, s[-1], n + 1)
        offset, z = np.interp(t, s, profile[:, 0]), np.interp(t, s, profile[:, 1])
        grid = base[None] + offset[:, None, None] * normal[None]
        height = np.broadcast_to(z[:, None, None], grid.shape[:2] + (1,))
        self.add(np.concatenate([grid, height], -1), patch, closed=True, flip=flip)

    @staticmethod
    def arc(centre, radius, start, end):
        a = np.linspace(start, end, 513)
        return np.stack([centre[0] + radius * np.cos(a), centre[1] + radius * np.sin(a)], 1)

    def rim(self, outline, normal):
        self.sweep(outline, normal, [(0, 0), (0, TOP - ROUND)], 3, self.h, flip=True)
        self.sweep(outline, normal, self.arc((-ROUND, TOP - ROUND), ROUND, 0, np.pi / 2), 4, self.h, flip=True)

    def stub(self):
        loop = self.centreLoop()
        normal = loop / np.linalg.norm(loop, axis=1)[:, None]
        zero = np.zeros_like(loop)
        step = self.spacing(STUB * normal)
        fillet = self.arc((STUB + FILLET, TOP + FILLET), FILLET, -np.pi / 2, -np.pi)
        self.sweep(zero, normal, fillet, 5, step, flip=True)
        self.sweep(zero, normal, [(STUB, TOP + FILLET), (STUB, STUB_TOP)], 6, step, flip=True)
        self.sweep(zero, normal, [(BORE, 0), (BORE, STUB_TOP)], 7, self.spacing(BORE * normal), flip=False)

    def holes(self, cells, outline, normal):
        for k in range(4):
            centre = self.holeCentre(k)
            for patch, loop, profile in (
                    (8 + 2 * k, self.cornerLoop(k, outline, cells), [(HOLE, 0), (HOLE, TOP - CHAMFER)]),
                    (9 + 2 * k, self.cornerLoop(k, outline - ROUND * normal, cells),
                     [(HOLE, TOP - CHAMFER), (HOLE + CHAMFER, TOP)])):
                # The rays to the lower and the upper outline differ a little: turn from the one to the other.
                low = self.rays(self.cornerLoop(k, outline, cells), centre)
                high = self.rays(self.cornerLoop(k, outline - ROUND * normal, cells), centre)
                step = self.spacing(HOLE * low)
                n = max(2, int(round(abs(np.subtract(*profile)).max() / step)))
                t = np.linspace(0, 1, n + 1)[:, None, None]
                direction = low[None] * (1 - t) + high[None] * t if patch % 2 == 0 else np.repeat(high[None], n + 1, 0)
                direction = direction / np.linalg.norm(direction, axis=2)[:, :, None]
                radius = profile[0][0] * (1 - t) + profile[1][0] * t
                z = profile[0][1] * (1 - t) + profile[1][1] * t
                grid = np.concatenate([centre + radius * direction,
                                       np.broadcast_to(z, direction.shape[:2] + (1,))], -1)
                self.add(grid, patch, closed=True, flip=False)

    @staticmethod
    def rays(loop, centre):
        d = loop - centre
        return d / np.linalg.norm(d, axis=1)[:, None]

    def add(self, grid, patch, closed, flip):
        self.blocks.append((grid, patch, closed, flip))

    def faceCount(self):
        return sum(2 * (g.shape[0] - 1) * (g.shape[1] if closed else g.shape[1] - 1)
                   for g, _, closed, _ in self.blocks)

    def mesh(self):
        points, faces, patches, border, first = [], [], [], [], 0
        for grid, patch, closed, flip in self.blocks:
            rows, columns = grid.shape[:2]
            ids = first + np.arange(rows * columns).reshape(rows, columns)
            rim = np.zeros((rows, columns), bool)
            rim[0] = rim[-1] = True
            if not closed:
                rim[:, 0] = rim[:, -1] = True
            f = triangulateGrid(grid, ids, closed)
            faces.append(f[:, ::-1] if flip else f)
            patches.append(np.full(len(f), patch, np.int32))
            points.append(grid.reshape(-1, 3))
            border.append(rim.ravel())
            first += rows * columns
        points, border = np.concatenate(points), np.concatenate(border)
        return (*weld(points, np.concatenate(faces), border), np.concatenate(patches))


def triangulateGrid(grid, ids, closed):
    """Cuts every cell of a grid along its shorter diagonal."""
    if closed:
        grid = np.concatenate([grid, grid[:, :1]], 1)
        ids = np.concatenate([ids, ids[:, :1]], 1)
    a, b, c, d = ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]
    ac = np.linalg.norm(grid[1:, 1:] - grid[:-1, :-1], axis=2)
    bd = np.linalg.norm(grid[1:, :-1] - grid[:-1, 1:], axis=2)
    useAc = (ac <= bd)[..., None]
    one = np.where(useAc, np.stack([a, c, b], -1), np.stack([a, d, b], -1))
    two = np.where(useAc, np.stack([a, d, c], -1), np.stack([b, d, c], -1))
    return np.stack([one, two], 2).reshape(-1, 3)


def weld(points, faces, border):
    """Joins the samples that neighbouring blocks share; only those marked as border are looked at."""
    candidates = np.nonzero(border)[0]
    # Computed from two sides, a sample differs by rounding; the odd offset keeps round coordinates off the limits.
    key = np.round(points[candidates] * 1e4 + 0.2371).astype(np.int64)
    order = np.lexsort(key.T)
    changed = np.ones(len(order), bool)
    changed[1:] = (key[order][1:] != key[order][:-1]).any(1)
    group = np.cumsum(changed) - 1
    representative = np.arange(len(points))
    representative[candidates[order]] = candidates[order][changed][group]
    used = np.zeros(len(points), bool)
    used[representative] = True
    number = np.cumsum(used) - 1
    return points[used], number[representative][faces]


def makePart(target):
    # Faces grow like 1 / h^2, so a large part is predicted from a small one.
    small, h = min(target, 200000), 1.0
    for _ in range(8):
        h *= np.sqrt(Part(h).faceCount() / small)
    return Part(h * np.sqrt(small / target)).mesh()


# ------------------------------------------------------------------------------------ implicit shapes
class Blend:
    """Smooth union of rounded cones, given as (end, radius, end, radius); negative inside."""

    def __init__(self, cones, softness):
        self.cones = [(np.array(a, float), ra, np.array(b, float), rb) for a, ra, b, rb in cones]
        self.softness = softness

    def bounds(self):
        low = np.min([np.minimum(a - ra, b - rb) for a, ra, b, rb in self.cones], axis=0)
        high = np.max([np.maximum(a + ra, b + rb) for a, ra, b, rb in self.cones], axis=0)
        margin = 2.5 * self.softness
        return low - margin, high + margin

    def evaluate(self, x, gradient=True):
        """Value of -k log(sum exp(-d / k)) and its gradient; d the distance to a cone's axis minus its radius."""
        total = np.zeros(len(x))
        slope = np.zeros_like(x) if gradient else None
        for a, ra, b, rb in self.cones:
            axis = b - a
            along = axis / max(axis @ axis, 1e-30)
            t = np.clip((x - a) @ along, 0, 1)
            d = x - a - t[:, None] * axis
            length = np.linalg.norm(d, axis=1)
            w = np.exp(np.clip((ra + t * (rb - ra) - length) / self.softness, -200, 200))
            total += w
            if gradient:
                inside = (t > 0) & (t < 1)
                g = d / np.maximum(length, 1e-30)[:, None]
                g -= (inside * (rb - ra))[:, None] * along
                slope += w[:, None] * g
        value = -self.softness * np.log(np.maximum(total, 1e-300))
        return (value, slope / np.maximum(total, 1e-300)[:, None]) if gradient else value

    def project(self, x, steps, chunk=100000):
        """Newton steps along the gradient onto the zero set."""
        for begin in range(0, len(x), chunk):
            part = x[begin:begin + chunk]
            for _ in range(steps):
                value, slope = self.evaluate(part)
                part = part - (value / np.maximum((slope * slope).sum(1), 1e-12))[:, None] * slope
            x[begin:begin + chunk] = part
        return x


def mirrored(cones):
    """Adds the mirror image in y of every cone that lies off the plane y = 0."""
    result = []
    for a, ra, b, rb in cones:
        result.append((a, ra, b, rb))
        if a[1] != 0 or b[1] != 0:
            result.append(((a[0], -a[1], a[2]), ra, (b[0], -b[1], b[2]), rb))
    return result


def beast():
    return Blend(mirrored([
        ((-0.75, 0, 0.05), 0.42, (0.55, 0, 0.15), 0.46),            # trunk
        ((0.60, 0, 0.25), 0.34, (1.05, 0, 0.80), 0.22),             # neck
        ((1.05, 0, 0.90), 0.28, (1.55, 0, 0.80), 0.15),             # head
        ((0.98, 0.16, 1.06), 0.12, (0.82, 0.44, 1.40), 0.085),      # ears
        ((0.55, 0.30, -0.05), 0.20, (0.70, 0.36, -0.62), 0.13),     # fore legs
        ((0.70, 0.36, -0.62), 0.13, (0.66, 0.36, -1.12), 0.11),
        ((0.66, 0.36, -1.14), 0.10, (0.88, 0.38, -1.18), 0.08),
        ((-0.75, 0.28, -0.02), 0.25, (-0.62, 0.36, -0.60), 0.15),   # hind legs
        ((-0.62, 0.36, -0.60), 0.14, (-0.86, 0.36, -1.10), 0.11),
        ((-0.86, 0.36, -1.14), 0.10, (-0.64, 0.38, -1.18), 0.08),
        ((-1.05, 0, 0.20), 0.15, (-1.45, 0, 0.42), 0.10),           # tail
        ((-1.45, 0, 0.42), 0.10, (-1.62, 0, 0.90), 0.085),
    ]), softness=0.05)


def frame():
    s = 1 / np.sqrt(3.0)
    corners = [(s, s, s), (s, -s, -s), (-s, s, -s), (-s, -s, s)]
    struts = [(corners[i], 0.14, corners[j], 0.14) for i in range(4) for j in range(i)]
    return Blend(struts + [(c, 0.24, c, 0.24) for c in corners], softness=0.12)


def surfaceNet(shape, h, shift):
    """Dual surface of a grid of step h: one vertex a cell, one quad an edge that the surface crosses."""
    low, high = shape.bounds()
    low = low - h * shift
    size = np.ceil((high - low) / h).astype(int) + 1
    axes = [low[i] + h * np.arange(size[i]) for i in range(3)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    value = np.concatenate([shape.evaluate(grid[i:i + 100000], gradient=False)
                            for i in range(0, len(grid), 100000)]).reshape(size)
    inside = value < 0
    number = np.full(size, -1)
    corners = [inside[i:size[0] - 1 + i, j:size[1] - 1 + j, k:size[2] - 1 + k]
               for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    mixed = np.zeros(size, bool)
    mixed[:-1, :-1, :-1] = ~(np.all(corners, 0) | ~np.any(corners, 0))
    number[mixed] = np.arange(mixed.sum())
    points = low + h * (np.argwhere(mixed) + 0.5)
    quads = []
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        first = np.take(inside, np.arange(size[axis] - 1), axis)
        second = np.take(inside, np.arange(1, size[axis]), axis)
        for fromInside in (True, False):
            at = np.argwhere(first & ~second if fromInside else ~first & second)
            stepA, stepB = np.eye(3, dtype=int)[a], np.eye(3, dtype=int)[b]
            ring = [at - stepA - stepB, at - stepB, at, at - stepA]
            quad = np.stack([number[tuple(r.T)] for r in ring], 1)
            quads.append(quad if fromInside else quad[:, ::-1])
    return points, np.concatenate(quads)


def relax(shape, points, quads, rounds=12):
    """Evens the vertices out over the surface."""
    points = shape.project(points, 4)
    a, b = quads.ravel(), np.roll(quads, -1, 1).ravel()
    degree = np.bincount(a, minlength=len(points)).astype(float)
    for _ in range(rounds):
        mean = np.stack([np.bincount(a, points[b, i], len(points)) for i in range(3)], 1) / degree[:, None]
        points = shape.project(0.4 * points + 0.6 * mean, 2)
    return points


def cutQuads(points, quads):
    p = points[quads]
    ac = np.linalg.norm(p[:, 0] - p[:, 2], axis=1) <= np.linalg.norm(p[:, 1] - p[:, 3], axis=1)
    one = np.where(ac[:, None], quads[:, [0, 1, 2]], quads[:, [0, 1, 3]])
    two = np.where(ac[:, None], quads[:, [0, 2, 3]], quads[:, [1, 2, 3]])
    return np.stack([one, two], 1).reshape(-1, 3)


def subdivide(points, faces, n):
    """Cuts every triangle into n * n; samples on edges are shared."""
    if n == 1:
        return points, faces
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    key = ends.min(1) * np.int64(len(points)) + ends.max(1)
    unique, edge = np.unique(key, return_inverse=True)
    edge = edge.reshape(3, -1).T                                   # edges 01, 12, 20 of every face
    forward = (faces < np.roll(faces, -1, 1))                      # runs from the lower to the higher vertex
    a, b = points[unique // len(points)], points[unique % len(points)]
    t = (np.arange(1, n) / n)[None, :, None]
    onEdges = (a[:, None] * (1 - t) + b[:, None] * t).reshape(-1, 3)
    firstEdge, firstInner = len(points), len(points) + len(unique) * (n - 1)
    # Lattice of a face: i steps from corner 0 to 1, j steps from corner 0 to 2.
    ij = [(i, j) for i in range(n + 1) for j in range(n + 1 - i)]
    slot = {p: k for k, p in enumerate(ij)}
    inner = [p for p in ij if p[0] > 0 and p[1] > 0 and sum(p) < n]
    lattice = np.empty((len(faces), len(ij)), np.int64)

    def edgePoint(side, k):                                        # k of n steps along the side
        step = np.where(forward[:, side], k - 1, n - 1 - k)
        return firstEdge + edge[:, side] * (n - 1) + step

    for (i, j), k in slot.items():
        if i == 0 and j == 0:
            lattice[:, k] = faces[:, 0]
        elif i == n:
            lattice[:, k] = faces[:, 1]
        elif j == n:
            lattice[:, k] = faces[:, 2]
        elif j == 0:
            lattice[:, k] = edgePoint(0, i)
        elif i + j == n:
            lattice[:, k] = edgePoint(1, j)
        elif i == 0:
            lattice[:, k] = edgePoint(2, n - j)
    innerIds = firstInner + np.arange(len(faces) * len(inner)).reshape(len(faces), len(inner))
    innerPoints = np.empty((len(faces), len(inner), 3))
    p = points[faces]
    for k, (i, j) in enumerate(inner):
        lattice[:, slot[(i, j)]] = innerIds[:, k]
        innerPoints[:, k] = (p[:, 0] * (n - i - j) + p[:, 1] * i + p[:, 2] * j) / n
    triangles = [(slot[(i, j)], slot[(i + 1, j)], slot[(i, j + 1)]) for i in range(n) for j in range(n - i)]
    triangles += [(slot[(i + 1, j)], slot[(i + 1, j + 1)], slot[(i, j + 1)])
                  for i in range(n) for j in range(n - i - 1)]
    return (np.concatenate([points, onEdges, innerPoints.reshape(-1, 3)]),
            lattice[:, np.array(triangles)].reshape(-1, 3))


def manifoldNet(shape, h, chi):
    """A cell that the surface crosses twice makes the net non-manifold; another position of the grid avoids it."""
    for attempt in range(40):
        shift = np.mod(np.array([0.37, 0.61, 0.17]) + attempt * np.array([0.618, 0.414, 0.732]), 1)
        points, quads = surfaceNet(shape, h, shift)
        key = np.sort(quads.ravel() * np.int64(len(points)) + np.roll(quads, -1, 1).ravel())
        if (key[1:] != key[:-1]).all() and len(points) - len(quads) == chi:
            return points, quads
    raise RuntimeError(f"no manifold net at step {h:.4g}")


def makeImplicit(shape, target, chi):
    """A net of up to 96 thousand faces; for more its triangles are subdivided."""
    n = max(1, int(np.sqrt(target / 24000.0)))
    h = 0.05
    for _ in range(4):
        quads = surfaceNet(shape, h, np.zeros(3))[1]
        h *= np.sqrt(2.0 * len(quads) / (target / n ** 2))
    points, quads = manifoldNet(shape, h, chi)
    points = relax(shape, points, quads)
    points, faces = subdivide(points, cutQuads(points, quads), n)
    return shape.project(points, 2), faces, None


# --------------------------------------------------------------------------------- output and checks
def writePly(path, points, faces, patches):
    properties = "property list uchar int vertex_indices\n"
    fields = [("n", "u1"), ("v", "<i4", 3)]
    if patches is not None:
        properties += "property int PatchId\n"
        fields.append(("patch", "<i4"))
    header = ("ply\nformat binary_little_endian 1.0\ncomment made by Quadrille's Data/generate.py\n"
              f"element vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
              f"element face {len(faces)}\n{properties}end_header\n")
    record = np.zeros(len(faces), np.dtype(fields))
    record["n"], record["v"] = 3, faces
    if patches is not None:
        record["patch"] = patches
    with open(path, "wb") as file:
        file.write(header.encode())
        file.write(points.astype("<f4").tobytes())
        file.write(record.tobytes())


def writeVtk(path, points, faces, patches):
    cells = np.empty((len(faces), 4), ">i4")
    cells[:, 0], cells[:, 1:] = 3, faces
    with open(path, "wb") as file:
        file.write(b"# vtk DataFile Version 3.0\nmade by Quadrille's Data/generate.py\nBINARY\nDATASET POLYDATA\n")
        file.write(f"POINTS {len(points)} float\n".encode() + points.astype(">f4").tobytes())
        file.write(f"\nPOLYGONS {len(faces)} {cells.size}\n".encode() + cells.tobytes())
        if patches is not None:
            file.write(f"\nCELL_DATA {len(faces)}\nSCALARS PatchId int 1\nLOOKUP_TABLE default\n".encode())
            file.write(patches.astype(">i4").tobytes())
        file.write(b"\n")


def check(name, points, faces):
    """Reasons why the mesh is not what it should be: manifold, oriented, right topology, no slivers."""
    problems = []
    count = np.int64(len(points))
    a, b = faces.ravel().astype(np.int64), np.roll(faces, -1, 1).ravel().astype(np.int64)
    forward, backward = np.sort(a * count + b), np.sort(b * count + a)
    if (forward[1:] == forward[:-1]).any():
        problems.append("an edge is run through twice in one direction")
    open_ = np.setdiff1d(forward, backward, assume_unique=True)
    edges = (len(forward) + len(open_)) // 2
    used = np.unique(faces)
    chi = len(used) - edges + len(faces)
    starts, ends = open_ // count, open_ % count
    if len(np.unique(starts)) != len(starts):
        problems.append("two boundary loops touch")
    loops = countLoops(starts, ends)
    if len(used) != count:
        problems.append(f"{count - len(used)} isolated points")
    if (chi, loops) != EXPECTED[name]:
        problems.append(f"Euler characteristic {chi} and {loops} loops instead of {EXPECTED[name]}")
    p = points.astype(np.float32).astype(float)[faces]
    sides = np.stack([np.linalg.norm(p[:, i] - p[:, (i + 1) % 3], axis=1) for i in range(3)], 1)
    area = 0.5 * np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1)
    shape = 4 * np.sqrt(3.0) * area / (sides ** 2).sum(1)          # 1: equilateral, 0: degenerate
    if not shape.min() > 0.1:
        problems.append(f"sliver: triangle {shape.argmin()} has shape {shape.min():.3g}")
    volume = np.einsum("ij,ij->i", p[:, 0], np.cross(p[:, 1], p[:, 2])).sum() / 6
    if not volume > 0:
        problems.append("the faces look inward")
    print(f"{name}: {len(used)} points, {len(faces)} faces, Euler characteristic {chi}, {loops} boundary loops, "
          f"triangle shape min {shape.min():.2f} mean {shape.mean():.2f}, "
          f"edges {sides.min():.3g} to {sides.max():.3g}")
    return problems


def countLoops(starts, ends):
    following = dict(zip(starts.tolist(), ends.tolist()))
    loops = 0
    while following:
        loops += 1
        start, at = following.popitem()
        while at != start:
            at = following.pop(at)
    return loops


def main():
    parser = argparse.ArgumentParser(description="Makes Quadrille's own test surfaces; see the top of this file.")
    parser.add_argument("shape", choices=sorted(EXPECTED))
    parser.add_argument("faces", type=int, help="how many triangles, about; 5000 to 10000000")
    parser.add_argument("out", help="file to write, .ply or .vtk")
    parser.add_argument("--check", action="store_true", help="count the topology anew, fail where it is wrong")
    arguments = parser.parse_args()
    if not 5000 <= arguments.faces <= 20000000:
        parser.error("FACES must lie between 5000 and 20000000")
    start = time.time()
    if arguments.shape == "part":
        points, faces, patches = makePart(arguments.faces)
    else:
        points, faces, patches = makeImplicit({"beast": beast, "frame": frame}[arguments.shape](), arguments.faces,
                                              EXPECTED[arguments.shape][0])
    (writeVtk if arguments.out.endswith(".vtk") else writePly)(arguments.out, points, faces, patches)
    print(f"{arguments.out}: {len(faces)} faces in {time.time() - start:.1f} s")
    problems = check(arguments.shape, points, faces) if arguments.check else []
    for problem in problems:
        print(f"{arguments.out}: {problem}", file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
