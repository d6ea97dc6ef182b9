# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's window itself, see test_draw.py: answers what was drawn and what the quads have there.

Nothing here is asked of the drawing tools: places under the mouse are rays from the camera's properties, and quads are
measured by their points.
"""
import math
import random

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersCore import vtkCutter, vtkStripper

import places_script  # whose questions are answered, too
import window_answers
from places_script import edge_length, is_clear, output, pixel_of, quads, seen_at, view


COVERED = 200  # pixels at the lower end of the view, where the window Output Messages may lie


def quad_arrays():
    """Points, and the corners of each quad."""
    data = output(0)
    points = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    return points, vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 4)


def constraints():
    """(kind of source, its points, valence or None) of each constraint of the filter, in their order."""
    found = []
    for source in quads().Constraints:
        if source is None:
            continue
        names = [n for n in ("Points", "Point", "From", "To") if n in source.ListProperties()]
        values = [v for n in names for v in source.GetPropertyValue(n)]
        points = [tuple(values[i:i + 3]) for i in range(0, len(values), 3)]
        valence = source.GetPropertyValue("Valence") if "Valence" in source.ListProperties() else None
        found.append((source.GetXMLName(), points, valence))
    return found


def selected():
    """The number of rows of the pipeline browser that are."""
    return servermanager.ProxyManager().SMProxyManager.GetSelectionModel("ActiveSources").GetNumberOfSelectedProxies()


def from_polyline(places, line, is_closed=False):
    """The distance of each place from the line."""
    places, line = numpy.array(places), numpy.array(line)
    if is_closed:
        line = numpy.vstack([line, line[:1]])
    best = numpy.full(len(places), math.inf)
    for a, b in zip(line[:-1], line[1:]):
        along = b - a
        share = numpy.clip((places - a) @ along / max(along @ along, 1e-300), 0, 1)
        best = numpy.minimum(best, numpy.linalg.norm(places - a - share[:, None] * along, axis=1))
    return best


def line_off(expected, is_closed=False):
    """How far the last constraint is from the places under the mouse, and these from it: the largest distance."""
    points = constraints()[-1][1]
    there, back = from_polyline(expected, points, is_closed), from_polyline(points, expected, is_closed)
    return float(max(there.max(), back.max()))


def angle_along(expected):
    """Degrees between a line and the nearer family of edges of the quads under it, the mean over its length."""
    points, corners = quad_arrays()
    centres = points[corners].mean(axis=1)
    line = numpy.array(expected)
    sum_, length = 0, 0
    for a, b in zip(line[:-1], line[1:]):
        way = b - a
        long = numpy.linalg.norm(way)
        if long == 0:
            continue
        quad = points[corners[((centres - (a + b) / 2) ** 2).sum(axis=1).argmin()]]
        families = (quad[1] - quad[0] + quad[2] - quad[3], quad[3] - quad[0] + quad[2] - quad[1])
        cosine = max(abs(way @ f) / long / numpy.linalg.norm(f) for f in families)
        sum_ += long * math.degrees(math.acos(min(1, cosine)))
        length += long
    return sum_ / length


def valences():
    """Of each point of the quads how many meet there; 0 on a boundary."""
    points, corners = quad_arrays()
    count = numpy.bincount(corners.ravel(), minlength=len(points))
    edges = numpy.sort(numpy.stack([corners, numpy.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    unique, uses = numpy.unique(edges, axis=0, return_counts=True)
    count[unique[uses == 1].ravel()] = 0
    return points, count


def nearest_of_valence(place, valence):
    """The distance from a place to the nearest inner point of the quads with a valence."""
    points, count = valences()
    those = points[count == valence]
    return float(numpy.linalg.norm(those - place, axis=1).min()) if len(those) else math.inf


def off_lines(expected):
    """The largest distance of places from the edges of the quads on features and boundaries; infinite without these."""
    ends = lines_of_quads()[0]
    if not len(ends):
        return math.inf
    starts, along = ends[:, 0], ends[:, 1] - ends[:, 0]
    worst = 0
    for place in numpy.array(expected):
        share = numpy.clip(((place - starts) * along).sum(axis=1) / (along ** 2).sum(axis=1), 0, 1)
        worst = max(worst, numpy.linalg.norm(starts + share[:, None] * along - place, axis=1).min())
    return float(worst)


def valence_at(place):
    """Of the point of the quads nearest to a place."""
    points, count = valences()
    return int(count[((points - place) ** 2).sum(axis=1).argmin()])


def lines_of_quads():
    """The ends of the edges of the quads on features and boundaries, #E by 2 by 3, and whether they are on these."""
    data = output(2)
    if data.GetNumberOfLines() == 0:
        return numpy.zeros((0, 2, 3)), numpy.zeros(0, bool)
    ends = vtk_to_numpy(data.GetLines().GetConnectivityArray()).reshape(-1, 2)
    on_boundary = vtk_to_numpy(data.GetCellData().GetArray("Boundary")) != 0
    return vtk_to_numpy(data.GetPoints().GetData()).astype(float)[ends], on_boundary


def features():
    """The ends of the edges of the quads on features, #E by 2 by 3."""
    ends, on_boundary = lines_of_quads()
    return ends[~on_boundary]


def off_features(place):
    """The distance of a place from the features of the quads."""
    return min((float(from_polyline([place], edge)[0]) for edge in features()), default=math.inf)


def feature_places(seed, near):
    """Pixels that clearly see a feature, with the place, in a random order; one at each edge of the quads."""
    found = []
    for a, b in features():
        place = (a + b) / 2
        pixel = tuple(round(c) for c in pixel_of(place))
        seen = seen_at(pixel) if COVERED < pixel[1] < view.ViewSize[1] and 0 < pixel[0] < view.ViewSize[0] else None
        if seen is not None and math.dist(seen, place) < near / 2 and is_clear(pixel, seen, near):
            found.append((pixel, tuple(place)))
    random.Random(seed).shuffle(found)
    return found


def irregular_within(place, radius):
    """(distance, valence) of the irregular vertices inside of the quads within a radius, the nearest first."""
    points, count = valences()
    away = numpy.linalg.norm(points - place, axis=1)
    found = numpy.flatnonzero((away <= radius) & (count != 4) & (count != 0))
    return sorted((float(away[i]), int(count[i])) for i in found)


def free_balls():
    """Irregular vertices that are coloured, as moves take them, and are on no feature and no boundary of the quads."""
    data, lines = output(4), output(2)
    movable = data.GetPointData().GetArray("MovableValence")
    on_lines = {lines.GetPoint(i) for i in range(lines.GetNumberOfPoints())}
    return {data.GetPoint(i) for i in range(data.GetNumberOfPoints()) if movable.GetTuple1(i) != 0} - on_lines


def size_within(place, radius):
    """The median by area of the edge lengths of quads with their centre within the radius; how many there are."""
    points, corners = quad_arrays()
    inside = numpy.linalg.norm(points[corners].mean(axis=1) - place, axis=1) <= radius
    lengths = numpy.linalg.norm(points[corners] - points[numpy.roll(corners, -1, axis=1)], axis=2).mean(axis=1)[inside]
    if not len(lengths):
        return math.nan, 0
    lengths.sort()
    share = numpy.cumsum(lengths ** 2) / (lengths ** 2).sum()
    return float(lengths[numpy.searchsorted(share, 0.5)]), int(inside.sum())


def clear_path(start, angle, length, bend, near, step=6):
    """Pixels along an arc that clearly sees the quads everywhere, with what they see; None where it does not."""
    x, y = start
    found = []
    for k in range(int(length / step) + 1):
        pixel = round(x), round(y)
        place = seen_at(pixel)
        if place is None or pixel[1] < COVERED or not is_clear(pixel, place, near) or \
                (found and math.dist(found[-1][1], place) > 2 * near):
            return None
        found.append((pixel, tuple(place)))
        x, y = x + step * math.cos(angle), y + step * math.sin(angle)
        angle += bend * step
    return found


def random_path(seed, shortest, longest, bend, near):
    """Of random arcs the first one that clearly sees the quads everywhere; None where there is hardly any."""
    chance = random.Random(seed)
    width, height = view.ViewSize
    for _ in range(400):
        start = chance.uniform(20, width - 20), chance.uniform(20, height - 20)
        found = clear_path(start, chance.uniform(0, 2 * math.pi), chance.uniform(shortest, longest),
                           chance.uniform(-bend, bend), near)
        if found:
            return found
    return None


def outline_right_of(pixel):
    """The last pixel to the right of one that sees the quads from which on the quads are still seen."""
    x, y = pixel
    while seen_at((x + 1, y)) is not None:
        x += 1
    return x, y


def cut_closes(path):
    """Whether the plane through a drag and the eye cuts the quads there in a closed curve."""
    curve = cut_of(path)
    return math.dist(curve[0], curve[-1]) == 0


def plane_of(path):
    """The plane through a drag and the eye: a point and the unit normal."""
    path = numpy.array(path)
    middle = path[len(path) // 2]
    normal = numpy.cross(path[-1] - path[0], middle - numpy.array(view.GetActiveCamera().GetPosition()))
    return middle.tolist(), (normal / numpy.linalg.norm(normal)).tolist()


def cut_of(path):
    """The curve in which that plane cuts the quads nearest to the middle of the drag."""
    middle, normal = plane_of(path)
    plane = vtkPlane()
    plane.SetOrigin(*middle)
    plane.SetNormal(*normal)
    cutter, joined = vtkCutter(), vtkStripper()
    cutter.SetInputData(output(0))
    cutter.SetCutFunction(plane)
    joined.SetInputConnection(cutter.GetOutputPort())
    joined.JoinContiguousSegmentsOn()
    joined.SetMaximumLength(10 ** 6)
    joined.Update()
    lines = joined.GetOutput()
    nearest = lines.GetCell(int(numpy.argmin([
        min(math.dist(lines.GetPoint(lines.GetCell(i).GetPointId(k)), middle)
            for k in range(lines.GetCell(i).GetNumberOfPoints())) for i in range(lines.GetNumberOfCells())])))
    return [lines.GetPoint(nearest.GetPointId(i)) for i in range(nearest.GetNumberOfPoints())]


def last_row(kind):
    """Met and Reason of the last row of a kind; None where there is none."""
    table = output(6)
    rows = [r for r in range(table.GetNumberOfRows()) if table.GetValueByName(r, "Kind").ToString() == kind]
    if not rows:
        return None
    return table.GetValueByName(rows[-1], "Met").ToInt(), table.GetValueByName(rows[-1], "Reason").ToString()


def is_mirrored():
    """Whether MirrorPoint takes each quad to a quad, and each point back to itself."""
    array = output(0).GetPointData().GetArray("MirrorPoint")
    if array is None:
        return False
    image, corners = vtk_to_numpy(array).astype(int), quad_arrays()[1]
    quads_of = {tuple(sorted(quad)) for quad in corners.tolist()}
    images_of = {tuple(sorted(quad)) for quad in image[corners].tolist()}
    return quads_of == images_of and bool((image[image] == numpy.arange(len(image))).all())


def last_remark(kind):
    """Of the last row of a kind; None where there is none."""
    table = output(6)
    rows = [r for r in range(table.GetNumberOfRows()) if table.GetValueByName(r, "Kind").ToString() == kind]
    return table.GetValueByName(rows[-1], "Remark").ToString() if rows else None


def input_arrays():
    """Points, and the corners of each triangle of the surface that was given."""
    data = window_answers.data_of(quads().Input)
    points = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    return points, vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)


pictures = []  # of the view, since watch_pictures()


def note_picture(window, _):
    if window.GetSwapBuffers():  # that of a selection is not shown
        pictures.append(True)


def watch_pictures():
    """From now on they are counted; returns what ignore_pictures() takes."""
    pictures.clear()
    return view.GetRenderWindow().AddObserver("EndEvent", note_picture)


def ignore_pictures(watched):
    view.GetRenderWindow().RemoveObserver(watched)
    return len(pictures)


def steps():
    """How many steps can be undone, and redone."""
    stack = servermanager.vtkSMProxyManager.GetProxyManager().GetUndoStackBuilder().GetUndoStack()
    return stack.GetNumberOfUndoSets(), stack.GetNumberOfRedoSets()


def point_seen():
    """The pixel of a point of the last constraint that is clearly seen; None where there is none."""
    for place in constraints()[-1][1]:
        pixel = tuple(round(c) for c in pixel_of(place))
        seen = seen_at(pixel) if 20 < pixel[0] < view.ViewSize[0] - 20 and COVERED < pixel[1] else None
        if seen is not None and math.dist(seen, place) < edge_length() / 4 and is_clear(pixel, seen, edge_length() / 2):
            return pixel
    return None


def make_labels():
    """The surface with cells that have one label, painted by it, as ParaView shows a text STL file; selected."""
    labels = simple.Calculator(Input=quads().Input, AttributeType="Cell Data", ResultArrayName="Label", Function="7")
    simple.Show(labels, view)
    simple.ColorBy(simple.GetRepresentation(labels, view), ("CELLS", "Label"))
    simple.Hide(quads(), view)
    simple.SetActiveSource(labels)


def colour_of_second():
    """The array by which quads that were made later are painted; None as long as there are none."""
    second = simple.FindSource("QuadRemesh2")
    shown = [r for r in view.Representations if second and r.Input and r.Input.SMProxy == second.SMProxy
             and r.Visibility and r.Input.Port == 0]
    return shown[0].ColorArrayName[1] if shown and second.GetDataInformation().GetNumberOfCells() > 0 else None


def set_defaults(text):
    """Defaults of properties, as the file of a user's settings has them."""
    servermanager.vtkSMSettings.GetInstance().AddCollectionFromString(text, 10)


def set_quietly(name, value):
    """Sets a property of the filter, which is no step that could be undone."""
    with window_answers.no_step_of_the_user():
        setattr(quads(), name, value)


vars(places_script).update({name: thing for name, thing in list(globals().items()) if callable(thing)})
