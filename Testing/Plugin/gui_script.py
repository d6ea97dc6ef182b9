# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's window itself, see test_gui.py."""
import os
import sys
import traceback

try:
    from paraview import servermanager, simple

    def check(condition, text):
        if not condition:
            raise RuntimeError(text)

    simple.LoadPlugin(os.environ["QUADRILLE_PLUGIN"], remote=False, ns=globals())
    part = simple.PLYReader(registrationName="part", FileNames=[os.path.join(os.environ["QUADRILLE_DATA"], "part.ply")])
    quads = QuadRemesh(registrationName="quads", Input=part, TargetType="Number Of Quads", NumberOfQuads=2000)
    view = simple.GetActiveViewOrCreate("RenderView")

    # The first Apply shows the quads alone, with edges: Apply asks this of each output.
    controller = servermanager.vtkSMParaViewPipelineControllerWithRendering()
    for port in range(8):
        chosen = controller.ShowInPreferredView(quads.SMProxy, port, view.SMProxy)
        check((chosen is not None) == (port == 0), f"output {port} shows at first Apply: {chosen}")
    check(simple.GetDisplayProperties(quads, view).Representation == "Surface With Edges", "the quads have no edges")
    # One click on the eye of the irregular vertices shows them as spheres, each valence in its colour.
    irregular = simple.Show(simple.OutputPort(quads, 4), view)
    check((irregular.Representation, irregular.PointSize, irregular.RenderPointsAsSpheres) == ("Points", 12.0, 1),
          f"irregular vertices as {irregular.Representation} of size {irregular.PointSize}")
    # ParaView takes what it picks for a cell of the first output.
    check(irregular.Pickable == 0 and simple.GetDisplayProperties(quads, view).Pickable == 1,
          "balls can be picked, or quads cannot")
    check(irregular.ColorArrayName[1] == "MovableValence",
          f"irregular vertices are coloured by {irregular.ColorArrayName}")
    colours = simple.GetColorTransferFunction("MovableValence")
    check(colours.InterpretValuesAsCategories == 1 and colours.Annotations[0:2] == ["0", "stays"] and
          colours.Annotations[4:6] == ["3", "3"], "valences have no colours of their own")
    grey, blue, red = (colours.IndexedColors[k:k + 3] for k in (0, 6, 9))
    check(grey[0] == grey[1] == grey[2] and blue[2] > 0.8 > blue[0] and red[0] > 0.8 > red[2],
          f"what stays, 3 and 5 are coloured {grey}, {blue} and {red}")
    # So are constraints by whether they are met.
    quads.Constraints = [QuadValence(Point=[0, 0, 12], Valence=5)]
    constraints = simple.Show(simple.OutputPort(quads, 5), view)
    check(constraints.ColorArrayName[1] == "Met", f"constraints are coloured by {constraints.ColorArrayName}")
    colours = simple.GetColorTransferFunction("Met")
    check(list(colours.Annotations) == ["0", "not met", "1", "met"], f"the legend has {colours.Annotations}")
    red, green = colours.IndexedColors[0:3], colours.IndexedColors[3:6]
    check(red[0] > 0.5 > red[1] and green[1] > 0.5 > green[0], f"not met and met are coloured {red} and {green}")
    # A colour that is chosen instead stays.
    simple.ColorBy(constraints, None)
    quads.Constraints = [QuadValence(Point=[0, 0, 12], Valence=3)]
    simple.Render(view)
    check(not constraints.ColorArrayName[1], f"a solid colour came back as {constraints.ColorArrayName}")
    # The measures of a map open no spreadsheets, and colour the surface.
    levels = DecimationHierarchy(registrationName="levels", Input=part, TargetType="Number Of Quads",
                                 NumberOfQuads=2000)
    grid = IntegerGridMap(registrationName="grid", Input=levels)
    quality = IntegerGridMapQuality(registrationName="quality", Input=grid)
    for port in range(4):
        chosen = controller.ShowInPreferredView(quality.SMProxy, port, view.SMProxy)
        check((chosen is not None) == (port == 0), f"output {port} of the map's quality shows at first Apply: {chosen}")
    check(simple.GetDisplayProperties(quality, view).ColorArrayName[1] == "Shear", "the map's quality has no colours")
    simple.Hide(quality, view)
    simple.SetActiveSource(quads)
    simple.ResetCamera(view)
    simple.Render(view)
    cells = quads.GetDataInformation().GetNumberOfCells()
    if not cells > 0:
        raise RuntimeError("no quads in the window")
    simple.SaveScreenshot(os.path.join(os.environ["QUADRILLE_ARTIFACTS"], "gui-view.png"), view)
    open(os.environ["QUADRILLE_READY"], "w").write(str(cells))
except Exception:
    open(os.environ["QUADRILLE_FAILED"], "w").write(traceback.format_exc())
