# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's window itself, see count_actions.py: opens a surface, makes quads and answers questions."""
import os

import quadrille  # the raw classes behind the proxies
import quick_start  # before simple
from paraview import simple
from paraview.modules.vtkRemotingSettings import vtkPVGeneralSettings
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

import window_answers

simple.LoadPlugin(os.environ["QUADRILLE_PLUGIN"], remote=False, ns=globals())
surface = simple.PLYReader(registrationName="surface",
                           FileNames=[os.path.join(os.environ["QUADRILLE_DATA"], "beast.ply")])
quads = QuadRemesh(registrationName="QuadRemesh1", Input=surface, NumberOfQuads=1500)
view = simple.GetActiveViewOrCreate("RenderView")
simple.Show(quads, view)
simple.SetActiveSource(quads)
simple.Render(view)


def rows():
    """Kind, Met, Deviation and Reason of each row of the table of constraints."""
    table = quads.GetClientSideObject().GetOutputDataObject(6)
    names = ("Kind", "Met", "Deviation", "Reason")
    return [tuple(table.GetValueByName(r, n).ToString() for n in names) for r in range(table.GetNumberOfRows())]


def irregular():
    """(place, valence) of the irregular vertices inside."""
    data = quads.GetClientSideObject().GetOutputDataObject(4)
    arrays = data.GetPointData()
    return [(data.GetPoint(i), arrays.GetArray("Valence").GetValue(i)) for i in range(data.GetNumberOfPoints())
            if not arrays.GetArray("OnBoundary").GetValue(i)]


def display(place):
    """Pixels from the left and from the bottom of the view."""
    renderer = view.GetRenderer()
    renderer.SetWorldPoint(*place, 1)
    renderer.WorldToDisplay()
    return renderer.GetDisplayPoint()[:2]


def is_visible(place, margin=8):
    """Whether the eye sees it, and the surface near it for so many pixels around."""
    renderer = view.GetRenderer()
    locator = vtkStaticCellLocator()
    locator.SetDataSet(quads.GetClientSideObject().GetOutputDataObject(0))
    locator.BuildLocator()
    x, y = display(place)

    def world(dx, dy, depth):
        renderer.SetDisplayPoint(x + dx, y + dy, depth)
        renderer.DisplayToWorld()
        p = renderer.GetWorldPoint()
        return [c / p[3] for c in p[:3]]

    for dx, dy in ((0, 0), (margin, 0), (-margin, 0), (0, margin), (0, -margin)):
        hit, coordinates, part = [0, 0, 0], [0, 0, 0], reference(0)
        if not locator.IntersectWithLine(world(dx, dy, 0), world(dx, dy, 1), 1e-9, reference(0.0), hit, coordinates,
                                         part):
            return False
        if sum((a - b) ** 2 for a, b in zip(hit, place)) > 0.1 ** 2:
            return False
    return True


previews = 0


def count_previews(*_):
    global previews
    previews += quads.GetClientSideObject().GetPreview()


def set_auto_apply(on):
    global previews
    vtkPVGeneralSettings.GetInstance().SetAutoApply(on)
    previews = 0


def fingerprint():
    data = quads.GetClientSideObject().GetOutputDataObject(0)
    return data.GetNumberOfCells(), data.GetNumberOfPoints(), data.GetBounds(), data.GetCenter()


def show_constraints():
    """As a click on the eye of the output, and one on that of the irregular vertices."""
    for port in (4, 5):
        simple.Show(simple.OutputPort(quads, port), view)
    simple.Render(view)


def clear():
    """Back to quads without constraints, with Quad Remesh selected, seen from the side."""
    view.CameraViewUp = [0, 0, 1]
    view.CameraFocalPoint = [0, 0, 0]
    view.CameraPosition = [-1, -6, 3]
    simple.ResetCamera(view)
    view.GetActiveCamera().Dolly(1.35)
    for port in (4, 5):
        simple.Hide(simple.OutputPort(quads, port), view)
    quads.Constraints = []
    quads.Symmetry = "None"
    for (name, _), source in list(simple.GetSources().items()):
        if name.startswith("Quad") and name != "QuadRemesh1":
            simple.Delete(source)
    simple.SetActiveSource(quads)
    simple.Render(view)


quads.GetClientSideObject().AddObserver("EndEvent", count_previews)
interactor = window_answers.serve(view, globals())
