# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's window itself, see test_gui.py."""
import os
import sys
import traceback

try:
    from paraview import simple
    simple.LoadPlugin(os.environ["QUADRILLE_PLUGIN"], remote=False, ns=globals())
    part = simple.PLYReader(registrationName="part", FileNames=[os.path.join(os.environ["QUADRILLE_DATA"], "part.ply")])
    quads = QuadRemesh(registrationName="quads", Input=part, TargetType="Number Of Quads", NumberOfQuads=2000)
    view = simple.GetActiveViewOrCreate("RenderView")
    display = simple.Show(quads, view)
    display.SetRepresentationType("Surface With Edges")
    simple.ColorBy(display, ("POINTS", "Valence"))
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
