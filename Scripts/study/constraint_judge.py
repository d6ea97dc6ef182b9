# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Measures what became of a constraint in the triangles that were given and in the quads that came, with numpy and
scipy alone: nothing here knows Quadrille. `constraint_places.py` asks, and lets this judge.

Lengths are in units of the surface unless a name says edges: those are local edge lengths of the quads.
"""
import dataclasses
import math

import numpy
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import connected_components, dijkstra, maximum_bipartite_matching
from scipy.spatial import cKDTree

#: Edge lengths between samples of a course.
STEP = 0.1
#: Edge lengths within which a place or a line has to be.
PLACE = 0.3
#: Edge lengths of the quads there within which other irregular vertices are where they were, as the guide has it.
OTHERS = 2
#: Mean edge lengths by which the chain of a connection or loop and its course may differ, and edge lengths of the quads
#: there within which a connection ends where its line does, as the guide has it.
LINE = 0.5
#: Cosine between normals on the two sides of a thin wall, at most; where a connection ends may be on its rim.
OTHER_SIDE = -0.5
#: Mean edge lengths within which chains are looked for, to tell by how much they are off.
REACH = 6
#: Closed chains longer than so many times the course go round more than once.
LONGEST_LOOP = 1.9
#: Degrees between edges along a feature line and its course.
ALONG = 25
#: Degrees, the mean angle between a stroke and the quads.
STROKE = 5
#: Factor by which sizes may be off.
SIZE = 1.25
#: Sharp edges that hang together and are shorter in all than so many edge lengths are no feature.
SHORTEST_FEATURE = 2
#: Triangles thinner than this, height over length, have no normal of their own.
THINNEST = 1e-5
#: Edge lengths by which a section is moved aside.
NUDGE = 1e-7
#: A walk through the triangles ends after so many of them.
FARTHEST_WALK = 200000


def unit(vectors):
    """Vectors of length 1; those of length 0 stay."""
    length = numpy.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / numpy.where(length > 0, length, 1)


def dots(a, b):
    return numpy.einsum("...i,...i->...", a, b)


def on_segments(places, a, b):
    """The point of each segment that is nearest to its place."""
    along = b - a
    square = dots(along, along)
    part = numpy.clip(dots(places - a, along) / numpy.where(square > 0, square, 1), 0, 1)
    return a + part[..., None] * along


def in_triangles(places, a, b, c):
    """The point of each triangle that is nearest to its place."""
    ab, ac, ap = b - a, c - a, places - a
    normal = numpy.cross(ab, ac)
    square = dots(normal, normal)
    whole = numpy.where(square > 0, square, 1)
    of_b = dots(numpy.cross(ap, ac), normal) / whole
    of_c = dots(numpy.cross(ab, ap), normal) / whole
    inside = (square > 0) & (of_b >= 0) & (of_c >= 0) & (of_b + of_c <= 1)
    best = a + of_b[:, None] * ab + of_c[:, None] * ac
    distance = numpy.where(inside, dots(best - places, best - places), numpy.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        found = on_segments(places, start, end)
        square = dots(found - places, found - places)
        nearer = ~inside & (square < distance)
        best[nearer], distance[nearer] = found[nearer], square[nearer]
    return best, numpy.sqrt(distance)


def sampled(line, step):
    """Places along a polyline, at most a step apart, the direction at each, and the length that it stands for."""
    places, directions, lengths = [], [], []
    for a, b in zip(line[:-1], line[1:]):
        length = numpy.linalg.norm(b - a)
        if length > 0:
            count = max(1, math.ceil(length / step))
            places.append(a + (b - a) * ((numpy.arange(count) + 0.5) / count)[:, None])
            directions.append(numpy.repeat([(b - a) / length], count, axis=0))
            lengths.append(numpy.full(count, length / count))
    return numpy.concatenate(places), numpy.concatenate(directions), numpy.concatenate(lengths)


def cut_to(points, triangles, step):
    """Corners (n, 3, 3) of triangles whose edges longer than a step were cut in the middle, again and again, and of
    which triangle each is a part. Both triangles at an edge cut it alike."""
    corners, owner = points[triangles], numpy.arange(len(triangles))
    parts, owners = [], []
    while len(corners):
        lengths = numpy.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)
        fine = lengths.max(axis=1) <= step
        parts.append(corners[fine])
        owners.append(owner[fine])
        corners, owner, first = corners[~fine], owner[~fine], lengths[~fine].argmax(axis=1)
        a, b, c = (corners[numpy.arange(len(corners)), (first + i) % 3] for i in range(3))
        middle = 0.5 * (a + b)
        corners = numpy.concatenate((numpy.stack((a, middle, c), axis=1), numpy.stack((middle, b, c), axis=1)))
        owner = numpy.concatenate((owner, owner))
    return numpy.concatenate(parts), numpy.concatenate(owners)


class Surface:
    """The triangles that were given, cut into parts that are no longer than half an edge of the quads: nearest points,
    plane sections, features and what lies between them."""

    def __init__(self, points, triangles, edge, feature_angle):
        """edge: the edge length of the quads; feature_angle: degrees, or None."""
        self.edge = edge
        whole = numpy.cross(points[triangles[:, 1]] - points[triangles[:, 0]],
                            points[triangles[:, 2]] - points[triangles[:, 0]])
        sides = numpy.linalg.norm(points[triangles[:, [1, 2, 0]]] - points[triangles], axis=2).max(axis=1)
        whole[numpy.linalg.norm(whole, axis=1) <= THINNEST * sides ** 2] = 0
        corners, owner = cut_to(points, triangles, 0.5 * edge)
        self.points, self.triangles = numpy.unique(corners.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
        self.triangles = self.triangles.reshape(-1, 3)
        self.owner = owner
        self.normals = unit(whole)[owner]
        self.areas = 0.5 * numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
                                             axis=1)
        middles = corners.mean(axis=1)
        self._cover = float(numpy.linalg.norm(corners - middles[:, None], axis=2).max())
        self._tree = cKDTree(middles)
        self._middles = middles
        self._connect(feature_angle)

    def _connect(self, feature_angle):
        """Twins of half-edges, features, boundaries and regions."""
        count = len(self.points)
        starts, ends = self.triangles.ravel(), self.triangles[:, [1, 2, 0]].ravel()
        low, high = numpy.minimum(starts, ends), numpy.maximum(starts, ends)
        _, first, edge, sides = numpy.unique(low * count + high, return_index=True, return_inverse=True,
                                             return_counts=True)
        order = numpy.argsort(edge, kind="stable")
        begin = numpy.concatenate(([0], numpy.cumsum(sides)))[:-1]
        pairs = numpy.stack((order[begin[sides == 2]], order[begin[sides == 2] + 1]), axis=1)
        self.twin = numpy.full(len(starts), -1)
        self.twin[pairs[:, 0]], self.twin[pairs[:, 1]] = pairs[:, 1], pairs[:, 0]
        one, other = self.normals[pairs[:, 0] // 3], self.normals[pairs[:, 1] // 3]
        known = (dots(one, one) > 0) & (dots(other, other) > 0)
        angle = math.radians(180 if feature_angle is None else feature_angle)
        sharp = known & (dots(one, other) < math.cos(angle))
        halves = pairs[sharp, 0]
        a, b = starts[halves], ends[halves]
        # Sharp edges that hang together; short ones are noise.
        _, part = connected_components(coo_matrix((numpy.ones(len(a)), (a, b)), (count, count)), directed=False)
        lengths = numpy.bincount(part[a], numpy.linalg.norm(self.points[a] - self.points[b], axis=1), part.max() + 1)
        long = lengths[part[a]] >= SHORTEST_FEATURE * self.edge
        self.features = self._lines(a[long], b[long])
        alone = first[sides != 2]
        self.boundary = self._lines(starts[alone], ends[alone])
        kept = numpy.ones(len(pairs), bool)
        kept[numpy.flatnonzero(sharp)[long]] = False
        one, other = pairs[kept, 0] // 3, pairs[kept, 1] // 3
        faces = len(self.triangles)
        _, self.region = connected_components(coo_matrix((numpy.ones(len(one)), (one, other)), (faces, faces)),
                                              directed=False)
        self.region_area = numpy.bincount(self.region, self.areas)

    def add_features(self, a, b):
        """Segments of lines that the quads have, which the user sees: those off the sharp edges are features, too, such
        as where a rounding begins."""
        off = self.to_feature(0.5 * (a + b)) > STEP * self.edge
        if off.any():
            added = self._sampled(a[off], b[off])
            places, directions = added[0].data, added[1]
            if self.features is not None:
                places = numpy.concatenate((self.features[0].data, places))
                directions = numpy.concatenate((self.features[1], directions))
            self.features = cKDTree(places), directions

    def _lines(self, starts, ends):
        """Samples of edges, their directions, and a tree of them; None where there are none."""
        return self._sampled(self.points[starts], self.points[ends]) if len(starts) else None

    @staticmethod
    def _sampled(a, b):
        parts = (numpy.arange(10) + 0.5) / 10
        places = (a[:, None] + parts[:, None] * (b - a)[:, None]).reshape(-1, 3)
        return cKDTree(places), numpy.repeat(unit(b - a), len(parts), axis=0)

    def to_feature(self, places):
        """Distances from features."""
        return numpy.full(len(places), numpy.inf) if self.features is None else self.features[0].query(places)[0]

    def to_boundary(self, places):
        return numpy.full(len(places), numpy.inf) if self.boundary is None else self.boundary[0].query(places)[0]

    def off_features(self, place, radius):
        """Of the surface within a radius the distances from features and boundaries, and the areas."""
        near = numpy.flatnonzero(numpy.linalg.norm(self._middles - place, axis=1) <= radius)
        places = self._middles[near]
        return numpy.minimum(self.to_feature(places), self.to_boundary(places)), self.areas[near]

    def nearest(self, places):
        """Points of the surface, their triangles and their distances from places."""
        places = numpy.atleast_2d(places)
        bound = self._tree.query(places)[0]
        found = self._tree.query_ball_point(places, bound * (1 + 1e-9) + self._cover)
        counts = numpy.array([len(f) for f in found])
        faces = numpy.concatenate([numpy.asarray(f, int) for f in found])
        which = numpy.repeat(numpy.arange(len(places)), counts)
        a, b, c = (self.points[self.triangles[faces, i]] for i in range(3))
        best, distance = in_triangles(places[which], a, b, c)
        order = numpy.lexsort((distance, which))
        first = order[numpy.concatenate(([0], numpy.cumsum(counts)))[:-1]]
        return best[first], faces[first], distance[first]

    def _cut(self, heights, first, half, last):
        """Where a plane crosses edges, from a triangle on out of one of its edges to the last triangle; None where it
        comes to a boundary, or not there."""
        above = heights > 0
        places = []
        for _ in range(FARTHEST_WALK):
            face, side = divmod(half, 3)
            a, b = self.triangles[face, side], self.triangles[face, (side + 1) % 3]
            part = heights[a] / (heights[a] - heights[b])
            places.append(self.points[a] + part * (self.points[b] - self.points[a]))
            half = int(self.twin[half])
            if half < 0:
                return None
            face = half // 3
            if face in (first, last):
                return places if face == last else None
            half = next(h for h in range(3 * face, 3 * face + 3) if h != half and
                        above[self.triangles[face, h % 3]] != above[self.triangles[face, (h + 1) % 3]])
        return None

    def _crossed(self, heights, face):
        above = (heights > 0)[self.triangles[face]]
        return [3 * face + i for i in range(3) if above[i] != above[(i + 1) % 3]]

    def between(self, start, end, normal):
        """The shorter part of a plane section from one point of the surface to another, which lie in the plane; None
        where it does not come there. Where the plane runs along edges it is taken a little beside them."""
        inward = NUDGE * self.edge * unit(end - start)
        inner = numpy.array([start + inward, end - inward])
        for aside in (0, NUDGE, -NUDGE):
            places, faces, _ = self.nearest(inner + aside * self.edge * normal)
            if faces[0] == faces[1]:
                return numpy.array([start, end])
            heights = (self.points - places[0]) @ normal
            ways = [self._cut(heights, faces[0], half, faces[1]) for half in self._crossed(heights, faces[0])]
            ways = [numpy.array([start, *way, end]) for way in ways if way is not None]
            if ways:
                return min(ways, key=length_of)
        return None

    def loop(self, place, normal):
        """The closed section with a plane through a place of the surface, its first point last again; or None."""
        for aside in (0, NUDGE, -NUDGE):
            origin, face, _ = self.nearest(place + aside * self.edge * normal)
            heights = (self.points - origin[0]) @ normal
            for half in self._crossed(heights, face[0])[:1]:
                way = self._cut(heights, face[0], half, face[0])
                if way is not None:
                    return numpy.array([origin[0], *way, origin[0]])
        return None

    def straight(self, start, end, compare):
        """The course from one place to another, straight along the surface: in the plane of both and the mean of their
        normals. None where there is none, where it is a detour, or, with `compare`, where what is nearest to the
        straight segment lies elsewhere, so that it is not clear what is meant."""
        places = self.nearest(numpy.array([start, end]))[0]
        along = places[1] - places[0]
        # A start or an end on a feature belongs to the side where the course is.
        faces = self.nearest(places + 1e-3 * numpy.array([along, -along]))[1]
        normal = numpy.cross(along, self.normals[faces].sum(axis=0))
        if numpy.linalg.norm(normal) <= 0.1 * numpy.linalg.norm(along):
            return None
        line = self.between(places[0], places[1], unit(normal))
        if line is None or length_of(line) > 1.5 * numpy.linalg.norm(along):
            return None
        if compare:
            below = self.nearest(sampled(places, STEP * self.edge)[0])[0]
            if Course(line, self.edge).distance(below).max() > STEP * self.edge:
                return None
        return line


def length_of(line):
    return float(numpy.linalg.norm(numpy.diff(line, axis=0), axis=1).sum())


class Course:
    """A polyline on the surface, sampled."""

    def __init__(self, line, edge):
        self.line = line
        self.length = length_of(line)
        self.places, self.directions, self.lengths = sampled(line, STEP * edge)
        self.tree = cKDTree(self.places)
        steps = numpy.linalg.norm(numpy.diff(self.places, axis=0), axis=1)
        self.at = numpy.concatenate(([0], numpy.cumsum(steps)))

    def distance(self, places):
        """From the polyline: of the nearest samples' pieces, which are shorter than the spacing."""
        _, near = self.tree.query(places, k=min(3, len(self.places)))
        near = near.reshape(len(places), -1)
        ends = numpy.stack((numpy.maximum(near - 1, 0), numpy.minimum(near + 1, len(self.places) - 1)), axis=2)
        points = numpy.concatenate((self.line[:1], self.places, self.line[-1:]))
        best = numpy.full(len(places), numpy.inf)
        for k in range(near.shape[1]):
            for a, b in ((ends[:, k, 0], near[:, k]), (near[:, k], ends[:, k, 1])):
                best = numpy.minimum(best, numpy.linalg.norm(
                    on_segments(places, points[a + 1], points[b + 1]) - places, axis=1))
        for end in (self.line[0], self.line[-1]):
            best = numpy.minimum(best, numpy.linalg.norm(places - end, axis=1))
        return best

    def place(self, at):
        """Places at lengths along the course, its ends beyond them."""
        return numpy.stack([numpy.interp(at, self.at, self.places[:, i]) for i in range(3)], axis=1)

    def apart_from_itself(self, length):
        """Whether places that are far apart along the course are so in space."""
        close = self.tree.query_pairs(length, output_type="ndarray")
        return not len(close) or float(numpy.abs(self.at[close[:, 0]] - self.at[close[:, 1]]).max()) <= 2.5 * length


class Quads:
    """Points and quads, and what is measured in them."""

    def __init__(self, points, quads):
        self.points, self.quads = points, quads
        corners = points[quads]
        self.centres = corners.mean(axis=1)
        across = numpy.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        self.normals = unit(across)
        self.sizes = numpy.sqrt(0.5 * numpy.linalg.norm(across, axis=1))
        #: The directions of both families of edges in each quad.
        self.families = unit(numpy.stack((corners[:, 1] - corners[:, 0] + corners[:, 2] - corners[:, 3],
                                          corners[:, 3] - corners[:, 0] + corners[:, 2] - corners[:, 1]), axis=1))
        self.tree = cKDTree(self.centres)
        self.start = quads.ravel()
        self.end = numpy.roll(quads, -1, axis=1).ravel()
        count = len(points)
        key, twin_key = self.start * count + self.end, self.end * count + self.start
        order = numpy.argsort(key)
        at = numpy.minimum(numpy.searchsorted(key[order], twin_key), len(key) - 1)
        self.twin = numpy.where(key[order[at]] == twin_key, order[at], -1)
        single = (self.twin < 0) | (self.start < self.end)
        self.edges = numpy.stack((self.start[single], self.end[single]), axis=1)
        #: Of all edges, the unit of closed chains.
        self.mean_edge = float(numpy.linalg.norm(points[self.start] - points[self.end], axis=1).mean())
        self.valence = numpy.bincount(self.edges.ravel(), minlength=count)
        self.boundary = numpy.zeros(count, bool)
        self.boundary[self.start[self.twin < 0]] = self.boundary[self.end[self.twin < 0]] = True
        total = numpy.zeros((count, 3))
        numpy.add.at(total, quads.ravel(), numpy.repeat(self.normals, 4, axis=0))
        self.point_normals = unit(total)
        self._edge_tree = cKDTree(points[self.edges].mean(axis=1))
        self._graph = None

    def length_at(self, places):
        """The mean size of the nine quads nearest to a place, the mean of that at several."""
        near = self.tree.query(numpy.atleast_2d(places), k=min(9, len(self.quads)))[1]
        return float(self.sizes[near].mean())

    def edge_at(self, place):
        """The mean of the edges of the quads at the vertex that is nearest to a place, of those of its nearest quad."""
        near = self.tree.query(place, k=min(9, len(self.quads)))[1].reshape(-1)
        corners = self.points[self.quads[near]]
        there = numpy.repeat([place], len(near), axis=0)
        nearest = self.quads[near[numpy.minimum(*(in_triangles(there, *(corners[:, i] for i in half))[1]
                                                  for half in ((0, 1, 2), (0, 2, 3)))).argmin()]]
        vertex = nearest[numpy.linalg.norm(self.points[nearest] - place, axis=1).argmin()]
        corners = self.points[self.quads[(self.quads == vertex).any(axis=1)]]
        return float(numpy.linalg.norm(numpy.roll(corners, -1, axis=1) - corners, axis=2).mean())

    def below(self, places, normals):
        """For each place the quad that is nearest to it, of those that face the same way."""
        near = self.tree.query(places, k=min(9, len(self.quads)))[1].reshape(len(places), -1)
        corners = self.points[self.quads[near.ravel()]]
        repeated = numpy.repeat(places, near.shape[1], axis=0)
        distance = numpy.minimum(*(in_triangles(repeated, *(corners[:, i] for i in half))[1]
                                   for half in ((0, 1, 2), (0, 2, 3)))).reshape(near.shape)
        distance[dots(self.normals[near], normals[:, None]) <= 0] += self.sizes.max()
        return near[numpy.arange(len(places)), distance.argmin(axis=1)]

    def places_near(self, course, radius):
        """Places in quads, sixteen in each, that are within a radius of a course: quads, places and areas."""
        close = numpy.flatnonzero(course.tree.query(self.centres)[0] <= radius + 2 * self.sizes)
        a, b, c, d = (self.points[self.quads[close, i]] for i in range(4))
        places, steps = [], (numpy.arange(4) + 0.5) / 4
        for u in steps:
            for v in steps:
                places.append((1 - u) * ((1 - v) * a + v * d) + u * ((1 - v) * b + v * c))
        quads, places = numpy.tile(close, len(places)), numpy.concatenate(places)
        within = course.tree.query(places)[0] <= radius
        return quads[within], places[within], self.sizes[quads[within]] ** 2

    def families_at(self, quads, places):
        """The directions of both families of edges at places in quads: between opposite edges, by how near they are."""
        corners = self.points[self.quads[quads]]
        families = []
        for i in (0, 1):
            one, other = (corners[:, i], corners[:, i + 1]), (corners[:, (i + 3) % 4], corners[:, (i + 2) % 4])
            far = [numpy.linalg.norm(on_segments(places, *side) - places, axis=1)[:, None] for side in (one, other)]
            share = far[0] / numpy.maximum(far[0] + far[1], 1e-300)
            families.append(unit((1 - share) * (one[1] - one[0]) + share * (other[1] - other[0])))
        return numpy.stack(families, axis=1)

    def parts(self, lines):
        """Of each quad the part of the mesh that it is in where lines, pairs of points, cut it."""
        across = self.twin >= 0
        ends = numpy.sort(numpy.stack((self.start, self.end), axis=1), axis=1)
        key, cut = ends @ [len(self.points), 1], numpy.sort(lines, axis=1) @ [len(self.points), 1]
        joined = numpy.flatnonzero(across & ~numpy.isin(key, cut))
        count = len(self.quads)
        return connected_components(coo_matrix((numpy.ones(len(joined)), (joined // 4, self.twin[joined] // 4)),
                                               (count, count)), directed=False)[1]

    def irregular(self, valence=None):
        """Inside of the surface."""
        wanted = self.valence != 4 if valence is None else self.valence == valence
        return numpy.flatnonzero(wanted & ~self.boundary)

    def distances(self, start, most):
        """From a point along the surface, nearly: along edges and diagonals. And the way back, by points."""
        if self._graph is None:
            q = self.quads
            pairs = numpy.concatenate((self.edges, q[:, [0, 2]], q[:, [1, 3]]))
            lengths = numpy.linalg.norm(self.points[pairs[:, 0]] - self.points[pairs[:, 1]], axis=1)
            self._graph = csr_matrix((lengths, (pairs[:, 0], pairs[:, 1])), (len(self.points),) * 2)
        return dijkstra(self._graph, directed=False, indices=start, limit=most, return_predecessors=True)

    # Chains. A half-edge runs from corner i to corner i + 1 of its quad, which is on its left.

    @staticmethod
    def _turned(half, by):
        return half - half % 4 + (half + by) % 4

    def straight_on(self, half, left=True):
        """The half-edge after this one, with two quads between them on that side; -1 past a boundary."""
        if left:
            across = self.twin[self._turned(half, 1)]
            return -1 if across < 0 else int(self._turned(across, 1))
        for _ in range(2):
            half = self.twin[half]
            if half < 0:
                return -1
            half = self._turned(half, 3)
        return int(self.twin[half])

    def lines_from(self, point, most):
        """Straight chains of points out of a point, up to an irregular one or the boundary."""
        for half in numpy.flatnonzero(self.start == point).tolist():
            chain = [point]
            while half >= 0 and len(chain) <= most:
                last = int(self.end[half])
                chain.append(last)
                if self.boundary[last] or self.valence[last] != 4 or last == point:
                    break
                half = self.straight_on(half)
            yield chain

    def loops(self, starts, inside):
        """Closed chains, straight on one side everywhere, through half-edges that begin at certain points, all of whose
        points are inside."""
        for left in (True, False):
            seen = numpy.zeros(len(self.start), bool)
            for first in numpy.flatnonzero(numpy.isin(self.start, starts)).tolist():
                half, chain = first, []
                while half >= 0 and not seen[half] and inside[self.start[half]]:
                    seen[half] = True
                    chain.append(int(self.start[half]))
                    half = self.straight_on(half, left)
                if half == first and chain:
                    yield chain

    def along(self, chain, closed=False):
        """Places along a chain of points, its edges' quarters with them."""
        points = self.points[chain + chain[:1] if closed else chain]
        return numpy.concatenate([points[:-1] + part * (points[1:] - points[:-1])
                                  for part in (0, 0.25, 0.5, 0.75)] + [points[-1:]])


@dataclasses.dataclass
class Verdict:
    """ok, and by how much it is off: edge lengths, degrees, or a factor less 1; and what else was measured."""
    ok: bool
    deviation: float
    more: str = ""


def nearest_of_valence(quads, place, normal, valence):
    """Edge lengths to the nearest vertex of that valence on the same side of a thin wall."""
    those = quads.irregular(valence)
    those = those[quads.point_normals[those] @ normal > 0]
    if not len(those):
        return math.inf
    return float(numpy.linalg.norm(quads.points[those] - place, axis=1).min()) / quads.edge_at(place)


def judge_valence(surface, quads, place, valence):
    place, face, _ = surface.nearest(place)
    off = nearest_of_valence(quads, place[0], surface.normals[face[0]], valence)
    return Verdict(off <= PLACE, off)


def others(quads, place, valence):
    """Irregular vertices, on features and boundaries too, without the nearest to a place of that valence: places and
    their valences, on boundaries one more than the edges."""
    valences = quads.valence + quads.boundary
    those = numpy.flatnonzero(valences != 4)
    same = those[valences[those] == valence]
    if len(same):
        those = those[those != same[numpy.linalg.norm(quads.points[same] - place, axis=1).argmin()]]
    return quads.points[those], valences[those]


def changed(before, after, quads):
    """Of the irregular vertices of two meshes those that have no partner of their valence within OTHERS, in the quads
    after, each being the partner of one at most."""
    (places, valences), (there, valences_there) = before, after
    if not len(places) or not len(there):
        return len(places) + len(there)
    within = numpy.array([OTHERS * quads.edge_at(place) for place in places])
    apart_by = numpy.linalg.norm(places[:, None] - there, axis=2)
    pairs = (apart_by <= within[:, None]) & (valences[:, None] == valences_there)
    partners = maximum_bipartite_matching(csr_matrix(pairs), perm_type="column")
    return len(places) + len(there) - 2 * int((partners >= 0).sum())


def judge_move(surface, quads, free, origin, target, valence):
    """At the new place, regular at the old one, and all others of the quads before where they were."""
    verdict = judge_valence(surface, quads, target, valence)
    place, face, _ = surface.nearest(origin)
    same_side = numpy.flatnonzero(quads.point_normals @ surface.normals[face[0]] > 0)
    nearest = same_side[numpy.linalg.norm(quads.points[same_side] - place[0], axis=1).argmin()]
    left = int(quads.valence[nearest]) + int(quads.boundary[nearest])
    elsewhere = changed(others(free, origin, valence), others(quads, target, valence), quads)
    return Verdict(verdict.ok and left == 4 and elsewhere == 0, verdict.deviation,
                   f"at the old place: valence {left}; {elsewhere} others went or came")


def apart(quads, chain, course, closed=False):
    """The farthest that a chain is from its course, or the course from the chain, in mean edge lengths."""
    points = quads.points[chain + chain[:1] if closed else chain]
    feet = on_segments(course.places[:, None], points[:-1], points[1:])
    back = numpy.linalg.norm(feet - course.places[:, None], axis=2).min(axis=1)
    return float(max(course.distance(quads.along(chain, closed)).max(), back.max())) / quads.mean_edge


def judge_connection(surface, quads, course):
    """A straight chain between vertices that are irregular, on a feature or on the boundary, each within LINE of its
    end, that stays within LINE of the course; of several the nearest one. The deviation is how far the two are
    apart."""
    start, end = course.line[0], course.line[-1]
    holds = quads.boundary | (quads.valence != 4)
    near = numpy.flatnonzero(numpy.minimum(numpy.linalg.norm(quads.points - start, axis=1),
                                           numpy.linalg.norm(quads.points - end, axis=1)) < 4 * surface.edge)
    holds[near[surface.to_feature(quads.points[near]) <= STEP * surface.edge]] = True
    edge = [quads.edge_at(start), quads.edge_at(end)]
    sides = surface.normals[surface.nearest([start, end])[1]]
    off = [numpy.where(quads.point_normals @ side > OTHER_SIDE, numpy.linalg.norm(quads.points - p, axis=1) / e,
                       numpy.inf) for p, e, side in zip((start, end), edge, sides)]
    # Within three, to tell by how much the ends of what is there are off.
    best = None
    most = 8 + int(4 * course.length / min(edge))
    for point in numpy.flatnonzero(holds & (off[0] <= 3)).tolist():
        for chain in quads.lines_from(point, most):
            for k in [k for k in range(1, len(chain)) if holds[chain[k]] and off[1][chain[k]] <= 3]:
                far = apart(quads, chain[:k + 1], course)
                ends = max(off[0][point], off[1][chain[k]])
                if far <= REACH and (best is None or (ends > LINE, far) < (best[0] > LINE, best[1])):
                    best = ends, far
    if best is None:
        return Verdict(False, math.inf, "no straight chain between vertices within 3 edges of both ends")
    return Verdict(best[0] <= LINE and best[1] <= LINE, best[1], f"ends off by {best[0]:.2f} edges")


def judge_cycle(quads, course):
    """A closed straight chain within LINE of the course, once round; the deviation is how far the two are apart."""
    edge = quads.mean_edge
    inside = course.distance(quads.points) <= REACH * edge
    starts = numpy.flatnonzero(numpy.linalg.norm(quads.points - course.line[0], axis=1) <= REACH * edge)
    best = math.inf
    for chain in quads.loops(starts, inside):
        if length_of(quads.points[chain + chain[:1]]) <= LONGEST_LOOP * course.length:
            best = min(best, apart(quads, chain, course, closed=True))
    return Verdict(best <= LINE, best)


def judge_feature(quads, course):
    """The farthest that a place of the course is from edges that run along it, and these edges from the course."""
    edge = quads.length_at(course.places)
    near = quads._edge_tree.query(course.places, k=min(24, len(quads.edges)))[1]
    a, b = quads.points[quads.edges[near, 0]], quads.points[quads.edges[near, 1]]
    feet = on_segments(course.places[:, None], a, b)
    distance = numpy.linalg.norm(feet - course.places[:, None], axis=2)
    runs = numpy.zeros(near.shape, bool)
    # Over an edge length before, round and after a place: edges along either side of a corner count.
    for before, after in ((1, 0), (0.5, 0.5), (0, 1)):
        chord = unit(course.place(course.at + after * edge) - course.place(course.at - before * edge))
        runs |= numpy.abs(dots(unit(b - a), chord[:, None])) >= math.cos(math.radians(ALONG))
    aligned = numpy.where(runs, distance, numpy.inf)
    to = float(aligned.min(axis=1).max()) / edge
    # The part of each edge that is nearest to some of the course.
    samples, best = numpy.arange(len(near)), aligned.argmin(axis=1)
    a, along, feet = a[samples, best], (b - a)[samples, best], feet[samples, best]
    part = dots(feet - a, along) / dots(along, along)
    low, high = numpy.ones(len(quads.edges)), numpy.zeros(len(quads.edges))
    numpy.minimum.at(low, near[samples, best], part)
    numpy.maximum.at(high, near[samples, best], part)
    used = numpy.unique(near[samples, best])
    start, end = quads.points[quads.edges[used, 0]], quads.points[quads.edges[used, 1]]
    parts = [low[used] + step * (high[used] - low[used]) for step in (0, 0.25, 0.5, 0.75, 1)]
    back = float(course.distance(numpy.concatenate([start + p[:, None] * (end - start) for p in parts])).max()) / edge
    return Verdict(max(to, back) <= PLACE, max(to, back),
                   f"any edges within {float(distance.min(axis=1).max()) / edge:.2f}, back {back:.2f}")


def judge_stroke(surface, quads, course, radius):
    """Degrees between the stroke and the nearer family of edges, the mean over its length of the quads below it, or
    over the area within its radius."""
    normals = surface.normals[surface.nearest(course.places)[1]]
    if radius > 0:
        which, places, weights = quads.places_near(course, radius)
        near = course.tree.query(places)[1]
        faces = dots(quads.normals[which], normals[near]) > 0.5
        which, places, weights, near = which[faces], places[faces], weights[faces], near[faces]
    else:
        which, places = quads.below(course.places, normals), course.places
        near, weights = numpy.arange(len(places)), course.lengths
    if not len(which):
        return Verdict(False, math.inf, "no quads there")
    along = course.directions[near]
    along = unit(along - dots(along, quads.normals[which])[:, None] * quads.normals[which])
    # In the plane of the quad: on curved surfaces its edges leave it.
    across = quads.normals[which][:, None]
    families = quads.families_at(which, places)
    families = unit(families - dots(families, across)[..., None] * across)
    cosine = numpy.abs(dots(families, along[:, None])).max(axis=1)
    angles = numpy.degrees(numpy.arccos(numpy.minimum(1, cosine)))
    mean = float((weights * angles).sum() / weights.sum())
    features = surface.to_feature(course.places).min() / quads.length_at(course.places)
    return Verdict(mean <= STROKE, mean, f"95 % {numpy.percentile(angles, 95):.1f}, {len(set(which.tolist()))} quads, "
                   f"features {features:.1f} edges away")


def weighted_median(values, weights):
    order = numpy.argsort(values)
    below = numpy.cumsum(weights[order])
    return float(values[order[numpy.searchsorted(below, 0.5 * below[-1])]])


def judge_size(surface, quads, place, radius, factor, growth):
    """The median by area of the sizes within the radius, over the size that quads have by their number and the area
    where nothing is asked for: beyond the radius sizes pass to those, by `growth` over an edge length."""
    inside = numpy.linalg.norm(quads.centres - place, axis=1) <= radius
    if not inside.any():
        return Verdict(False, math.inf, "no quads there")
    beyond = numpy.maximum(numpy.linalg.norm(surface._middles - place, axis=1) - radius, 0) / surface.edge
    sizes = (numpy.maximum(factor - growth * beyond, 1) if factor > 1 else
             numpy.minimum(factor + growth * beyond, 1))
    rest = math.sqrt((surface.areas / sizes ** 2).sum() / len(quads.quads))
    ratio = weighted_median(quads.sizes[inside], quads.sizes[inside] ** 2) / rest / factor
    off = max(ratio, 1 / ratio) - 1
    return Verdict(off <= SIZE - 1, off, f"{ratio * factor:.2f} for {factor:.2f}, {int(inside.sum())} quads")
