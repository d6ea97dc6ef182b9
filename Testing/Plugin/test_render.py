# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Scripts/figures/render.py makes a picture with quads, red and blue balls and lines: test_render.py RENDER_SCRIPT."""
import os
import runpy
import sys

import numpy
import quadrille
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

from plugin_common import ARTIFACTS, DATA, check

reader = vtkPLYReader()
reader.SetFileName(os.path.join(DATA, "beast.ply"))
reader.Update()
writer = vtkXMLPolyDataWriter()
writer.SetInputData(quadrille.remesh(reader.GetOutput(), quads=3000))
writer.SetDataModeToBinary()
writer.SetFileName(os.path.join(ARTIFACTS, "beast-quads.vtp"))
writer.Write()

picture = os.path.join(ARTIFACTS, "beast-quads.png")
if os.path.exists(picture):
    os.remove(picture)
script = sys.argv[1]
sys.argv = [script, os.path.join(ARTIFACTS, "beast-quads.vtp"), picture, "--size", "900", "700"]
runpy.run_path(script, run_name="__main__")

image = vtkPNGReader()
image.SetFileName(picture)
image.Update()
pixels = vtk_to_numpy(image.GetOutput().GetPointData().GetScalars())[:, :3].astype(int)
check(len(pixels) == 900 * 700, "the picture has another size")
background = (pixels.min(axis=1) > 240).mean()
check(0.1 < background < 0.9, f"{100 * background:.0f} % of the picture are background")
red, green, blue = pixels.T
check(((red > 120) & (green < 80) & (blue < 80)).sum() > 20, "no red balls")
check(((blue > 120) & (red < 80)).sum() > 20, "no blue balls")
print("render: fine")
