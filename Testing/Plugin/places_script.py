# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's window itself, see test_places.py: answers questions on what is there and where it is seen.

Rays are made from the camera's properties alone, so that what they say is not what ParaView's picks are made of.
"""
import math
import os
import random

import numpy
import quadrille  # the raw classes behind the proxies
import quick_start  # before simple
from paraview import simple, smstate, smtrace
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

import window_answers
from window_answers import bytes_of, verdict_of

simple.LoadPlugin(os.environ["QUADRILLE_PLUGIN"], remote=False, ns=globals())
view = simple.GetActiveViewOrCreate("RenderView")


def quads():
    return simple.FindSource("QuadRemesh1")


def output(port):
    return window_answers.data_of(quads(), port)


def is_made():
    """Whether no quads are being made in the background."""
    if not quads():
        return True
    here = quads().GetClientSideObject()
    return not here.GetInBackground() if here else not verdict_of(quads()).startswith("Underway")


def is_whole():
    """Whether the quads are no preview."""
    return not verdict_of(quads()).startswith("preview")


def edge_length():
    """Mean of the edges of all quads."""
    data = output(0)
    points = [data.GetPoint(i) for i in range(data.GetNumberOfPoints())]
    lengths = []
    for i in range(data.GetNumberOfCells()):
        ids = data.GetCell(i).GetPointIds()
        corners = [points[ids.GetId(k)] for k in range(4)]
        lengths += [math.dist(corners[k - 1], corners[k]) for k in range(4)]
    return sum(lengths) / len(lengths)


def axes():
    """The eye, and unit vectors to the right, up and forward."""
    camera = view.GetActiveCamera()
    eye = numpy.array(camera.GetPosition())
    forward = numpy.array(camera.GetFocalPoint()) - eye
    forward /= numpy.linalg.norm(forward)
    right = numpy.cross(forward, numpy.array(camera.GetViewUp()))
    right /= numpy.linalg.norm(right)
    return eye, right, numpy.cross(right, forward), forward


def half_height():
    """Of what is seen, at a distance of one."""
    return math.tan(math.radians(view.GetActiveCamera().GetViewAngle()) / 2)


def pixel_of(place):
    """From the left and from the bottom of the view, to the centre of the pixel."""
    eye, right, up, forward = axes()
    width, height = view.ViewSize
    way = numpy.array(place) - eye
    unit = 2 * half_height() * way.dot(forward) / height
    return way.dot(right) / unit + width / 2 - 0.5, way.dot(up) / unit + height / 2 - 0.5


def seen_at(pixel):
    """The place of the quads that the centre of a pixel sees; None where it sees none."""
    eye, right, up, forward = axes()
    width, height = view.ViewSize
    unit = 2 * half_height() / height
    way = forward + unit * ((pixel[0] + 0.5 - width / 2) * right + (pixel[1] + 0.5 - height / 2) * up)
    far = eye + 100 * numpy.linalg.norm(eye) * way
    hit = [0, 0, 0]
    if locator().IntersectWithLine(list(eye), list(far), 1e-9, reference(0.0), hit, [0, 0, 0], reference(0)):
        return hit
    return None


def locator():
    """Of the quads as they are, made when they change."""
    data = output(0)
    if locator.of != data.GetMTime():
        locator.made = vtkStaticCellLocator()
        locator.made.SetDataSet(data)
        locator.made.BuildLocator()
        locator.of = data.GetMTime()
    return locator.made


locator.of = None


def is_clear(pixel, place, near):
    """Whether pixels around see places near this one: no outline runs there."""
    for dx, dy in ((0, 0), (3, 0), (-3, 0), (0, 3), (0, -3)):
        there = seen_at((pixel[0] + dx, pixel[1] + dy))
        if there is None or math.dist(there, place) > near:
            return False
    return True


def visible_places(numbers, near):
    """For pairs of numbers from 0 to 1 across the view: the pixels that clearly see the quads, with what they see."""
    width, height = view.ViewSize
    found = []
    for u, v in numbers:
        pixel = int(20 + u * (width - 40)), int(20 + v * (height - 40))
        place = seen_at(pixel)
        if place and is_clear(pixel, place, near):
            found.append((pixel, place))
    return found


def visible_balls(near):
    """Pixels and places of the irregular vertices that are clearly seen."""
    data = output(4)
    found = []
    for i in range(data.GetNumberOfPoints()):
        place = data.GetPoint(i)
        pixel = tuple(round(c) for c in pixel_of(place))
        if all(20 < pixel[c] < view.ViewSize[c] - 20 for c in range(2)) and is_clear(pixel, place, near):
            found.append((pixel, place))
    return found


def look(azimuth, elevation):
    """Degrees round the surface and above it, at all of it."""
    azimuth, elevation = math.radians(azimuth), math.radians(elevation)
    view.CameraViewUp = [0, 0, 1]
    view.CameraFocalPoint = [0, 0, 0]
    view.CameraPosition = [math.cos(azimuth) * math.cos(elevation), math.sin(azimuth) * math.cos(elevation),
                           math.sin(elevation)]
    simple.ResetCamera(view)
    view.GetActiveCamera().Dolly(1.35)
    simple.Render(view)


def come_near(seed, pixels):
    """Where an edge of the quads has fewer pixels than these, the camera goes towards a random place that is seen until
    it has them: quads that small nobody draws on."""
    random.seed(seed)
    eye, _, _, forward = axes()
    width, height = view.ViewSize
    near = edge_length() * height / (2 * half_height() * pixels)
    for _ in range(400):
        place = seen_at((random.uniform(0, width), random.uniform(0, height)))
        if place is not None:
            break
    else:
        return
    if (numpy.array(place) - eye).dot(forward) > near:
        view.CameraFocalPoint = place
        view.CameraPosition = (numpy.array(place) - near * forward).tolist()
        view.GetRenderer().ResetCameraClippingRange()
        simple.Render(view)


def applied(name):
    """The values of a property of the selected source."""
    return list(simple.GetActiveSource().GetPropertyValue(name))


def is_connected():
    """Whether the selected source is one of the constraints of the filter."""
    return simple.GetActiveSource() in list(quads().Constraints)


def show_balls(on):
    (simple.Show if on else simple.Hide)(simple.OutputPort(quads(), 4), view)
    simple.Render(view)


def clear():
    """Back to quads without constraints, with Quad Remesh selected."""
    quads().Constraints = []
    for (name, _), source in list(simple.GetSources().items()):
        if name.startswith("Quad") and name != "QuadRemesh1":
            simple.Delete(source)
    simple.SetActiveSource(quads())
    simple.Render(view)


def rows():
    """Kind, Met and Reason of each row of the table of constraints."""
    table = output(6)
    return [tuple(table.GetValueByName(r, n).ToString() for n in ("Kind", "Met", "Reason"))
            for r in range(table.GetNumberOfRows())]


interactor = window_answers.serve(view, globals())
