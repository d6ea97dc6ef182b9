#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of what each constraint does, as in Figures 1 and 9 of [Ebke et al. 2016]: quads before and after on the
same surface, seen by the same camera.

  PYTHONPATH=build/lib/python3/dist-packages xvfb-run -a /usr/bin/python3 Scripts/figures/constraint_pictures.py
      [SURFACE.ply] [FOLDER] [--quads N] [--chord-error E] [--view X Y Z] [--up X Y Z] [--only CLASS ...]

On the left what is asked for, as it is drawn with the mouse in this view, in orange; on the right what became of it,
in green, or in magenta if it is not met. Balls are irregular vertices: blue has three edges, red five, purple six or
more, black two; in the picture of the symmetry those without a mirror image have a ring; in that of the sizes quads are
orange where they are smaller than the mean, and teal where they are larger. Places are chosen by the surface: irregular
vertices in view of the camera, or the place that is farthest from them. --view is the direction from the surface to the
camera. FOLDER gets constraint-CLASS.png for the classes guide, valence, connection, cycle, move,
symmetry and sizing.
"""
import argparse
import os
import sys
import textwrap

import numpy
import quadrille
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

SIDE = 600
TEXT = 64  # pixels below each picture
ASKED, MET, NOT_MET, BESIDE = (0.95, 0.50, 0.0), (0.0, 0.62, 0.25), (0.85, 0.0, 0.65), (0.1, 0.1, 0.1)
VALENCES = {2: (0.05, 0.05, 0.05), 3: (0.12, 0.35, 0.85), 5: (0.85, 0.13, 0.13), 6: (0.55, 0.15, 0.65)}
SIZES = ((1.0, 0.62, 0.25), (0.92, 0.92, 0.92), (0.35, 0.72, 0.68))  # of quads of half, once and twice the mean size
CURVES = {"stroke": 1, "connection": 2, "cycle": 3}  # ConstraintType
UNMET = (3, 5, 7)  # of the array Constraint of the output


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("surface", nargs="?", default="Data/beast.ply")
    parser.add_argument("folder", nargs="?", default="Documentation/Pictures")
    parser.add_argument("--quads", type=int, default=3000)
    parser.add_argument("--chord-error", type=float, help="of the picture of sizes; a 2,000th of the diagonal at first")
    parser.add_argument("--view", type=float, nargs=3, default=(0.25, -1.0, 0.3))
    parser.add_argument("--up", type=float, nargs=3, default=(0, 0, 1))
    parser.add_argument("--only", nargs="+", choices=CLASSES, default=CLASSES)
    return parser.parse_args()


# --- data -------------------------------------------------------------------------------------------------------------

def array(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def points_of(data):
    return vtk_to_numpy(data.GetPoints().GetData()).astype(float) if data.GetNumberOfPoints() else numpy.zeros((0, 3))


def corners_of(data):
    return vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(data.GetNumberOfPolys(), -1)


def lines_data(lines, kind=None):
    """Polylines (n by 3 each) as a vtkPolyData, with ConstraintType."""
    data, cells, points = vtk.vtkPolyData(), vtk.vtkCellArray(), vtk.vtkPoints()
    for line in lines:
        cells.InsertNextCell(len(line))
        for point in line:
            cells.InsertCellPoint(points.InsertNextPoint(*point))
    data.SetPoints(points)
    data.SetLines(cells)
    if kind is not None:
        types = numpy_to_vtk(numpy.full(len(lines), CURVES[kind], numpy.int32), deep=True)
        types.SetName("ConstraintType")
        data.GetCellData().AddArray(types)
    return data


def lines_of(data):
    """The polylines of a vtkPolyData, and their values of the array Constraint."""
    points, ids, lines = points_of(data), vtk.vtkIdList(), []
    cells = data.GetLines()
    cells.InitTraversal()
    while cells.GetNextCell(ids):
        lines.append(points[[ids.GetId(i) for i in range(ids.GetNumberOfIds())]])
    # Cells are numbered with the points (vertex cells) first.
    kinds = data.GetCellData().GetArray("Constraint")
    return lines, vtk_to_numpy(kinds)[data.GetNumberOfVerts():] if kinds else None


class Quads:
    """A quad mesh, its irregular vertices inside, and its mean edge length."""

    def __init__(self, data):
        self.data = vtk.vtkPolyData()
        self.data.DeepCopy(data)
        self.points, self.corners = points_of(self.data), corners_of(self.data)
        valence = array(self.data, "Valence")
        self.irregular = numpy.flatnonzero((valence != 4) & (array(self.data, "OnBoundary") == 0))
        self.valence = valence[self.irregular]
        sides = self.points[self.corners] - self.points[numpy.roll(self.corners, 1, axis=1)]
        self.length = float(numpy.linalg.norm(sides, axis=2).mean())
        self.after = {}  # from the vertices (a, b) of an edge to the vertex c straight on behind b
        across = {}
        for quad in self.corners.tolist():
            for k in range(4):
                across[quad[k], quad[(k + 1) % 4]] = (quad[(k + 2) % 4], quad[(k + 3) % 4])
        regular = set(numpy.flatnonzero(valence == 4).tolist())
        for a, b in across:
            # The quad on the other side of the edge, and over its other side at b the next one round b.
            right = across.get((b, a))
            beyond = across.get((b, right[1])) if b in regular and right is not None else None
            if beyond is not None:
                self.after[a, b] = beyond[1]

    def chain(self, a, b, steps):
        """Vertices straight on from the edge (a, b), as far as it goes, or until it closes."""
        found = [a, b]
        while len(found) <= steps and (found[-2], found[-1]) in self.after:
            found.append(self.after[found[-2], found[-1]])
            if len(found) > 3 and found[-2:] == found[:2]:
                break
        return found

    def neighbours(self, vertex):
        rows, columns = numpy.nonzero(self.corners == vertex)
        return sorted({int(self.corners[r, (c + 1) % 4]) for r, c in zip(rows, columns)}
                      | {int(self.corners[r, (c + 3) % 4]) for r, c in zip(rows, columns)})


def remeshed(surface, quads, curves=None, points=None, **settings):
    """Quads, the output Constraints, and the reason of the first constraint that is not met."""
    run = quadrille.vtkQuadRemesh()
    for source in (run, run.GetExecutive()):  # told by the exception, or in the picture
        source.AddObserver("WarningEvent", lambda caller, event: None)
    run.SetInputData(surface)
    run.SetNumberOfQuads(quads)
    for name, value in settings.items():
        getattr(run, "Set" + name)(*value)
    if curves is not None:
        run.SetCurvesData(curves)
    if points is not None:
        run.SetValencePointsData(points)
    run.Update()
    if run.GetOutcome() != quadrille.vtkQuadRemesh.Succeeded:
        raise quadrille.RemeshError(run.GetOutcomeText())
    table = run.GetConstraintTable()
    reasons = [str(table.GetColumnByName("Reason").GetValue(i)) for i in range(table.GetNumberOfRows())
               if not table.GetColumnByName("Met").GetValue(i)]
    became = vtk.vtkPolyData()
    became.DeepCopy(run.GetConstraints())
    return Quads(run.GetOutput()), became, "; ".join(reasons)


# --- the view ---------------------------------------------------------------------------------------------------------

class View:
    """A parallel camera, and what it sees of the surface."""

    def __init__(self, surface, direction, up):
        self.back = numpy.array(direction, float) / numpy.linalg.norm(direction)
        self.right = numpy.cross(up, self.back)
        self.right /= numpy.linalg.norm(self.right)
        self.up = numpy.cross(self.back, self.right)
        normals = vtk.vtkPolyDataNormals()
        normals.SetInputData(surface)
        normals.SplittingOff()
        normals.AutoOrientNormalsOff()
        normals.Update()
        self.points = points_of(surface)
        self.facing = array(normals.GetOutput(), "Normals") @ self.back
        self.diagonal = float(numpy.linalg.norm(numpy.ptp(self.points, axis=0)))
        self.locator = vtk.vtkStaticCellLocator()
        self.locator.SetDataSet(surface)
        self.locator.BuildLocator()
        self.nearest = vtk.vtkStaticPointLocator()
        self.nearest.SetDataSet(surface)
        self.nearest.BuildLocator()

    def flat(self, points):
        """In the plane of the picture."""
        return numpy.stack([numpy.asarray(points) @ self.right, numpy.asarray(points) @ self.up], axis=-1)

    def hit(self, start, end):
        t, x, uvw, sub = vtk.mutable(0.0), [0.0] * 3, [0.0] * 3, vtk.mutable(0)
        return numpy.array(x) if self.locator.IntersectWithLine(start, end, 0.0, t, x, uvw, sub) else None

    def under(self, place):
        """What the mouse is over at a place of the picture; None beside the surface."""
        base = place[0] * self.right + place[1] * self.up
        base = base + (self.points.mean(axis=0) @ self.back) * self.back
        return self.hit(base + 2 * self.diagonal * self.back, base - 2 * self.diagonal * self.back)

    def draw(self, first, second, bow=0.0, count=40):
        """A line drawn on the surface between two places in space, bent to the side by a part of its length; None
        where it leaves what is seen."""
        first, second = self.flat(first), self.flat(second)
        side = numpy.array([first[1] - second[1], second[0] - first[0]])
        line = [self.under(first + t * (second - first) + 4 * bow * t * (1 - t) * side)
                for t in numpy.linspace(0, 1, count)]
        if any(point is None for point in line):
            return None
        line = numpy.array(line)
        step = numpy.linalg.norm(second - first) / (count - 1)
        jumps = numpy.linalg.norm(numpy.diff(line, axis=0), axis=1)
        return line if jumps.max() < 4 * step else None

    def seen(self, points, least_facing=0.5):
        """Which points face the camera with nothing before them."""
        result = []
        for point in points:
            facing = self.facing[self.nearest.FindClosestPoint(point)]
            start = point + 0.01 * self.diagonal * self.back
            hidden = self.hit(start, start + 3 * self.diagonal * self.back) is not None
            result.append(facing > least_facing and not hidden)
        return numpy.array(result, bool)


def distances(points, others):
    """Of each point to the nearest of the others."""
    result = numpy.full(len(points), numpy.inf)
    for other in others:
        numpy.minimum(result, numpy.linalg.norm(points - other, axis=1), out=result)
    return result


def free_places(view):
    """Some of the points that face the camera."""
    step = max(1, len(view.points) // 1500)
    candidates = view.points[::step][view.facing[::step] > 0.75]
    candidates = candidates[view.seen(candidates, 0.75)]
    if not len(candidates):
        raise SystemExit("constraint_pictures: the view shows no place that faces it; choose another --view")
    return candidates


def free_place(view, quads):
    """The place in view that is farthest from irregular vertices, and from what turns away from the camera."""
    step = max(1, len(view.points) // 1500)
    candidates = free_places(view)
    away = view.points[::step][view.facing[::step] < 0.2]
    room = numpy.minimum(distances(candidates, quads.points[quads.irregular]), 0.8 * distances(candidates, away))
    return candidates[numpy.argmax(room)]


def sections(surface, origin, normal):
    """The polylines where a plane cuts a surface."""
    plane = vtk.vtkPlane()
    plane.SetOrigin(*origin)
    plane.SetNormal(*normal)
    cutter = vtk.vtkCutter()
    cutter.SetInputData(surface)
    cutter.SetCutFunction(plane)
    strips = vtk.vtkStripper()
    strips.SetInputConnection(cutter.GetOutputPort())
    strips.SetMaximumLength(1000000)
    strips.Update()
    return lines_of(strips.GetOutput())[0]


# --- one picture ------------------------------------------------------------------------------------------------------

class Half:
    """One side of a picture: quads, coloured by their size or not, lines and places on top, and a text."""

    def __init__(self, quads, text, sizes=False):
        self.quads, self.text, self.lines, self.places, self.sizes = quads, text, [], [], sizes

    def add_lines(self, lines, colour, width=1.0):
        self.lines += [(numpy.asarray(line), colour, width) for line in lines]
        return self

    def add_places(self, points, colour):
        self.places += [(numpy.asarray(point), colour) for point in points]
        return self

    def add_became(self, became):
        """The output Constraints: lines, and cells of single points."""
        lines, kinds = lines_of(became)
        for line, kind in zip(lines, kinds):
            self.add_lines([line], NOT_MET if kind in UNMET else MET)
        if became.GetNumberOfVerts():
            colours = vtk_to_numpy(became.GetCellData().GetArray("Constraint"))[:became.GetNumberOfVerts()]
            ids = vtk_to_numpy(became.GetVerts().GetConnectivityArray())
            for point, kind in zip(points_of(became)[ids], colours):
                self.add_places([point], NOT_MET if kind in UNMET else MET)
        return self


def actor_of(algorithm, colour):
    mapper = vtk.vtkPolyDataMapper()
    if isinstance(algorithm, vtk.vtkDataObject):
        mapper.SetInputData(algorithm)
    else:
        mapper.SetInputConnection(algorithm.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(colour)
    return actor


def colours_of_sizes(quads):
    """The square roots of the areas against their mean: orange at half of it, grey, teal at twice."""
    corners = quads.points[quads.corners]
    areas = numpy.linalg.norm(numpy.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]), axis=1) / 2
    sizes = numpy.sqrt(areas)
    log = numpy.log2(numpy.maximum(sizes, 1e-3 * sizes.mean()) / sizes.mean())
    colours = numpy.stack([numpy.interp(log, (-1, 0, 1), levels) for levels in zip(*SIZES)], axis=1)
    result = numpy_to_vtk((255 * colours).astype(numpy.uint8), deep=True)
    result.SetName("Colour")
    return result


def surface_actor(quads, sizes):
    data = vtk.vtkPolyData()
    data.ShallowCopy(quads.data)
    if sizes:
        data.GetCellData().SetScalars(colours_of_sizes(quads))
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(data)
    normals.SetFeatureAngle(40)
    normals.ConsistencyOff()
    actor = actor_of(normals, SIZES[1])
    if sizes:
        actor.GetMapper().ScalarVisibilityOn()
        actor.GetMapper().SetScalarModeToUseCellData()
    style = actor.GetProperty()
    style.EdgeVisibilityOn()
    style.SetEdgeColor(0.33, 0.33, 0.37)
    style.SetAmbient(0.3)
    style.SetDiffuse(0.68)
    return actor


def tube_actor(line, colour, radius):
    tube = vtk.vtkTubeFilter()
    tube.SetInputData(lines_data([line]))
    tube.SetRadius(radius)
    tube.SetNumberOfSides(12)
    tube.CappingOn()
    actor = actor_of(tube, colour)
    actor.GetProperty().SetAmbient(0.45)
    actor.GetProperty().SetDiffuse(0.6)
    return actor


def ball_actor(point, colour, radius):
    ball = vtk.vtkSphereSource()
    ball.SetCenter(*point)
    ball.SetRadius(radius)
    ball.SetThetaResolution(20)
    ball.SetPhiResolution(20)
    actor = actor_of(ball, colour)
    actor.GetProperty().SetAmbient(0.3)
    actor.GetProperty().SetDiffuse(0.7)
    return actor


def ring(view, point, radius):
    angles = numpy.linspace(0, 2 * numpy.pi, 49)
    return point + radius * (numpy.cos(angles)[:, None] * view.right + numpy.sin(angles)[:, None] * view.up)


def text_actor(text):
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    style = actor.GetTextProperty()
    style.SetFontSize(17)
    style.SetColor(0.1, 0.1, 0.12)
    style.SetJustificationToCentered()
    style.SetVerticalJustificationToCentered()
    style.SetLineSpacing(1.1)
    actor.SetPosition(SIDE // 2, TEXT // 2)
    return actor


def renderer_of(half, view, centre, half_height):
    """What lies on top is moved to the camera by its size, which a parallel camera does not see."""
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(surface_actor(half.quads, half.sizes))
    thick = 0.012 * half_height
    for line, colour, width in half.lines:
        renderer.AddActor(tube_actor(line + 1.5 * thick * view.back, colour, width * thick))
    ball = min(max(0.3 * half.quads.length, 0.014 * half_height), 0.035 * half_height)
    for place, colour in half.places:
        at = place + (10 * ball + 4 * thick) * view.back
        renderer.AddActor(tube_actor(ring(view, at, 2.4 * ball), colour, min(0.8 * thick, 0.5 * ball)))
    for vertex, valence in zip(half.quads.irregular, half.quads.valence):
        at = half.quads.points[vertex] + ball * view.back
        renderer.AddActor(ball_actor(at, VALENCES[min(max(valence, 2), 6)], ball))
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(centre + 3 * view.diagonal * view.back))
    camera.SetViewUp(*view.up)
    camera.SetParallelScale(half_height * SIDE / (SIDE - TEXT))
    camera.SetWindowCenter(0, -TEXT / SIDE)
    renderer.ResetCameraClippingRange()
    renderer.AddViewProp(paper())
    renderer.AddViewProp(text_actor(half.text))
    return renderer


def paper():
    """White below the text."""
    points, cells = vtk.vtkPoints(), vtk.vtkCellArray()
    for x, y in ((0, 0), (SIDE, 0), (SIDE, TEXT), (0, TEXT)):
        points.InsertNextPoint(x, y, 0)
    cells.InsertNextCell(4, (0, 1, 2, 3))
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    mapper = vtk.vtkPolyDataMapper2D()
    mapper.SetInputData(data)
    actor = vtk.vtkActor2D()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(1, 1, 1)
    return actor


def save(path, view, halves, shown, least_height, margin=1.35):
    """shown: points that the picture frames, with at least so much height on both sides of the middle."""
    flat = view.flat(shown)
    low, high = flat.min(axis=0), flat.max(axis=0)
    middle = 0.5 * (low + high)
    half_height = max(margin * 0.5 * (high - low).max(), least_height)
    centre = middle[0] * view.right + middle[1] * view.up + (numpy.mean(shown, axis=0) @ view.back) * view.back
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(2 * SIDE, SIDE)
    for i, half in enumerate(halves):
        renderer = renderer_of(half, view, centre, half_height)
        renderer.SetViewport(0.5 * i, 0, 0.5 * (i + 1), 1)
        window.AddRenderer(renderer)
    window.Render()
    shot = vtk.vtkWindowToImageFilter()
    shot.SetInput(window)
    shot.ReadFrontBufferOff()
    shot.Update()
    # Twenty-five levels a channel are enough and make the file smaller.
    pixels = vtk_to_numpy(shot.GetOutput().GetPointData().GetScalars())
    pixels[:] = numpy.round(numpy.round(pixels / 10.2) * 10.2)
    writer = vtk.vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetFileName(path)
    writer.SetInputData(shot.GetOutput())
    writer.Write()
    print(f"constraint_pictures: {path}: {halves[1].text.splitlines()[0]}")


# --- the classes ------------------------------------------------------------------------------------------------------

class Pictures:
    def __init__(self, args):
        self.args = args
        self.surface = quadrille.read(args.surface)
        self.view = View(self.surface, args.view, args.up)
        self.before, _, _ = remeshed(self.surface, args.quads)

    def path(self, name):
        return os.path.join(self.args.folder, f"constraint-{name}.png")

    def save_near(self, name, before, after, shown):
        save(self.path(name), self.view, (before, after), shown, 9 * self.before.length)

    def guide(self):
        """A bowed stroke through the free place, at 45 degrees to the edges there."""
        middle = free_place(self.view, self.before)
        quad = numpy.argmin(numpy.linalg.norm(self.before.points[self.before.corners].mean(axis=1) - middle, axis=1))
        a, _, c, _ = self.before.points[self.before.corners[quad]]
        across = (c - a) / numpy.linalg.norm(c - a)
        for reach in (7, 6, 5, 4, 3, 2):
            step = reach * self.before.length * across
            line = self.view.draw(middle - step, middle + step, bow=0.12)
            if line is not None:
                break
        else:
            raise SystemExit("constraint_pictures: no room for a stroke; choose another --view")
        radius = 1.5 * self.before.length
        quads, became, reason = remeshed(self.surface, self.args.quads, lines_data([line], "stroke"),
                                         StrokeRadius=(radius,))
        self.save_near("guide", Half(self.before, "before, with the stroke").add_lines([line], ASKED),
                       Half(quads, "quads follow the stroke" + why(reason)).add_became(became), line)

    def valence(self):
        place = free_place(self.view, self.before)
        quads, became, reason = remeshed(self.surface, self.args.quads, points=lines_data([[place, place]]),
                                         PointValence=(5,))
        self.save_near("valence", Half(self.before, "before, with the place").add_places([place], ASKED),
                       Half(quads, "a vertex with five edges there" + why(reason)).add_became(became),
                       numpy.array([place]))

    def pairs(self):
        """Pairs of irregular vertices in view that no chain joins; those about ten edges apart first, on a part of the
        surface that faces the camera."""
        quads = self.before
        seen = quads.irregular[self.view.seen(quads.points[quads.irregular])]
        joined = {v: {w for n in quads.neighbours(v) for w in quads.chain(v, n, 40)} for v in seen.tolist()}
        found = []
        for i, v in enumerate(seen.tolist()):
            for w in seen[i + 1:].tolist():
                apart = numpy.linalg.norm(quads.points[v] - quads.points[w]) / quads.length
                line = None if w in joined[v] or apart < 5 else self.view.draw(quads.points[v], quads.points[w])
                if line is not None:
                    away = [1 - self.view.facing[self.view.nearest.FindClosestPoint(point)] for point in line]
                    found.append((abs(apart - 10) + 20 * numpy.mean(away), i, line))
        return [line for _, _, line in sorted(found, key=lambda entry: entry[:2])]

    def connection(self):
        """The first pair that gets its chain; pairs without are told."""
        for line in self.pairs()[:12]:
            quads, became, reason = remeshed(self.surface, self.args.quads, lines_data([line], "connection"))
            if reason:
                print(f"constraint_pictures: connection from {line[0]} to {line[-1]} is not met: {reason}")
                continue
            self.save_near(
                "connection", Half(self.before, "before, with the line between two irregular vertices")
                .add_lines([line], ASKED), Half(quads, "a straight chain of edges joins them").add_became(became),
                numpy.concatenate([line, *lines_of(became)[0]]))
            return
        print("constraint_pictures: no picture of a connection: no pair in view that is not joined and can be",
              file=sys.stderr)

    def loop(self, place, normal):
        """The closed section by a plane that comes nearest to a place, turned to begin there; None without."""
        closed = [line for line in sections(self.surface, place, normal)
                  if len(line) > 3 and numpy.linalg.norm(line[0] - line[-1]) < 1e-6 * self.view.diagonal]
        line = min(closed, key=lambda line: distances(line, [place]).min(), default=None)
        if line is None:
            return None
        return numpy.roll(line[:-1], -int(numpy.argmin(distances(line[:-1], [place]))), axis=0)

    def smaller_side(self, line, place, normal):
        """Area of the smaller part that is left of the surface when it is cut along a section."""
        corners = corners_of(self.surface)
        triangles = self.view.points[corners]
        front = (triangles - place) @ normal > 0
        cut = numpy.flatnonzero(front.any(axis=1) & ~front.all(axis=1))
        size = numpy.linalg.norm(triangles[cut, 0] - triangles[cut, 1], axis=1).max()
        cut = cut[distances(triangles[cut].mean(axis=1), line) < 2 * size]  # those of this section only
        rest = vtk.vtkPolyData()
        rest.SetPoints(self.surface.GetPoints())
        rest.SetPolys(quadrille.to_polydata(self.view.points, numpy.delete(corners, cut, axis=0)).GetPolys())
        parts = vtk.vtkPolyDataConnectivityFilter()
        parts.SetInputData(rest)
        parts.SetExtractionModeToAllRegions()
        parts.ColorRegionsOn()
        parts.Update()
        region = array(parts.GetOutput(), "RegionId")
        faces = corners_of(parts.GetOutput())
        sides = points_of(parts.GetOutput())[faces]
        areas = numpy.linalg.norm(numpy.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1) / 2
        areas = numpy.sort(numpy.bincount(region[faces[:, 0]], weights=areas))
        return areas[-2] if len(areas) > 1 else 0.0

    def loops(self):
        """Closed sections across the picture, those first that are short for what lies on both sides of them."""
        seen = free_places(self.view)
        found = []
        for place in seen[::max(1, len(seen) // 10)]:
            for angle in numpy.radians((0, 45, 90, 135)):
                normal = numpy.cos(angle) * self.view.right + numpy.sin(angle) * self.view.up
                line = self.loop(place, normal)
                if line is not None:
                    length = numpy.linalg.norm(numpy.diff(line, axis=0), axis=1).sum()
                    found.append((-self.smaller_side(line, place, normal) / length ** 2, len(found), line))
        return [line for _, _, line in sorted(found, key=lambda entry: entry[:2])]

    def beside(self, line):
        """The chain of edges of the quads before that leaves along the line where it begins, once round and a third;
        None where it closes, or runs more than 20 degrees off the line."""
        quads = self.before
        start = int(numpy.argmin(distances(quads.points, [line[0]])))
        along = line[min(5, len(line) // 4)] - line[0]
        along /= numpy.linalg.norm(along)

        def cosine(v):
            edge = quads.points[v] - quads.points[start]
            return edge @ along / numpy.linalg.norm(edge)

        following = max(quads.neighbours(start), key=cosine)
        if cosine(following) < numpy.cos(numpy.radians(20)):
            return None
        length = numpy.linalg.norm(numpy.diff(line, axis=0), axis=1).sum()
        chain = quads.chain(start, following, int(1.33 * length / quads.length))
        return None if len(chain) < 4 or chain[-2:] == chain[:2] else quads.points[chain]

    def cycle(self):
        """Round a limb, where edges do not close yet if there is such a place."""
        loops = self.loops()[:12]
        if not loops:
            print("constraint_pictures: no picture of a cycle: no closed section in view", file=sys.stderr)
            return
        line = next((line for line in loops if self.beside(line) is not None), loops[0])
        chain = self.beside(line)
        line = numpy.concatenate([line, line[:1]])
        quads, became, reason = remeshed(self.surface, self.args.quads, lines_data([line], "cycle"))
        before = Half(self.before, "before, with the closed line").add_lines([line], ASKED)
        if chain is not None:
            before.add_lines([chain], BESIDE, 0.8).text += "; edges there (black) do not close"
        self.save_near("cycle", before, Half(quads, "a chain of edges closes" + why(reason)).add_became(became), line)

    def move(self):
        """The irregular vertex in view with the most room round it goes towards the free place."""
        session = quadrille.Session(self.surface, quads=self.args.quads)
        found = session.irregular().point.astype(float)
        seen = found[self.view.seen(found, 0.6)]
        target = free_place(self.view, self.before)
        for origin in sorted(seen.tolist(), key=lambda point: numpy.linalg.norm(target - point)):
            line = self.view.draw(numpy.array(origin), target)
            if line is not None:
                break
        else:
            print("constraint_pictures: no picture of a move: no irregular vertex in view", file=sys.stderr)
            return
        before = Quads(session.polydata)
        session.move_irregular(origin, target)
        reason = "; ".join(word["reason"] for word in session.update()["constraints"] if not word["met"])
        points = session.irregular().point.astype(float)
        place = points[numpy.argmin(distances(points, [target]))]
        others = found[numpy.linalg.norm(found - origin, axis=1) > 0]
        farthest = distances(others, points).max() / before.length
        text = "it is there, all others " + (
            "stay" if farthest < 0.005 else f"move by {farthest:.2f} edge lengths at most")
        self.save_near(
            "move", Half(before, "before, with where an irregular vertex is to go")
            .add_lines([line], ASKED).add_places([target], ASKED),
            Half(Quads(session.polydata), text + why(reason))
            .add_places([place], NOT_MET if reason else MET), line)

    def symmetry(self):
        """The camera looks along the plane, which is upright in the picture."""
        quads, _, reason = remeshed(self.surface, self.args.quads, Symmetry=(2,))
        fields = quads.data.GetFieldData()
        origin, normal = (vtk_to_numpy(fields.GetArray(name)).ravel() for name in ("SymmetryOrigin", "SymmetryNormal"))
        within = self.view.back - (self.view.back @ normal) * normal
        if numpy.linalg.norm(within) < 0.2:
            within = numpy.cross(normal, self.view.right)
        up = numpy.cross(normal, within)
        view = View(self.surface, within, up if up @ self.view.up > 0 else -up)
        lines = sections(self.surface, origin, normal)
        # Half an edge length, and by how much the surface is off its own image.
        tolerance = 0.5 * self.before.length + fields.GetArray("SymmetryDeviation").GetValue(1) * self.view.diagonal
        halves = []
        for mesh, colour, text in ((self.before, ASKED, "before: "),
                                   (quads, MET, "symmetric: ")):
            alone = without_image(mesh, origin, normal, tolerance)
            text += f"{len(mesh.irregular) - len(alone)} of {len(mesh.irregular)} irregular vertices have an image"
            halves.append(Half(mesh, text + why(reason if mesh is quads else "")).add_lines(lines, colour, 0.6)
                          .add_places(alone[view.seen(alone, -1)], NOT_MET))
        save(self.path("symmetry"), view, halves, self.view.points, 0, 1.06)

    def sizing(self):
        error = self.args.chord_error or self.view.diagonal / 2000
        quads, _, reason = remeshed(self.surface, self.args.quads, ChordError=(error,))
        save(self.path("sizing"), self.view, (
            Half(self.before, f"before: {len(self.before.corners):,} quads of one size", True),
            Half(quads, f"{len(quads.corners):,} quads, smaller where the surface is curved" + why(reason), True)),
            self.view.points, 0, 1.06)


def without_image(quads, origin, normal, tolerance):
    """Irregular vertices that have none of the same valence near their mirror image."""
    points = quads.points[quads.irregular]
    images = points - 2 * ((points - origin) @ normal)[:, None] * normal
    apart = numpy.array([distances(points[quads.valence == valence], [image]).min()
                         for image, valence in zip(images, quads.valence)])
    return points[apart > tolerance]


def why(reason):
    return "\n" + textwrap.shorten("not met: " + reason, 68, placeholder=" ...") if reason else ""


CLASSES = ("guide", "valence", "connection", "cycle", "move", "symmetry", "sizing")


def main():
    args = arguments()
    vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_WARNING)  # cuts are told otherwise
    os.makedirs(args.folder, exist_ok=True)
    pictures = Pictures(args)
    for name in args.only:
        getattr(pictures, name)()


if __name__ == "__main__":
    main()
