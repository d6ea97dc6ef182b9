# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""In pvpython: a STEP file by the plugin's reader, quads, nodes on the exact shape, a deck; blocks, a state file.

  test_cad.py CAD_SHAPES WORK_DIR
"""
import os
import subprocess
import sys

import quick_start  # before simple
from paraview import simple

from plugin_common import PLUGIN, check, size_of

SHAPES, WORK = sys.argv[1:3]
subprocess.run([SHAPES, WORK], check=True, stdout=subprocess.DEVNULL)
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
named, assembly = os.path.join(WORK, "named.step"), os.path.join(WORK, "assembly.step")


def places(proxy):
    """How many nodes stay, and how many there are."""
    fields = proxy.GetDataInformation().GetFieldDataInformation()
    off = fields.GetArrayInformation("NodesOffGeometry").GetComponentRange(0)
    return off[1], proxy.GetDataInformation().GetNumberOfPoints()


def has_opencascade():
    with open("/proc/self/maps", encoding="utf-8") as maps:
        return "libTKernel" in maps.read()


check(not has_opencascade(), "the plugin loads Open CASCADE before there is a CAD file")
# As File > Open does: the reader is found by the extension.
part = simple.OpenDataFile(named)
check(part.SMProxy.GetXMLName() == "QuadrilleCADReader", "STEP files are opened by another reader")
quads = QuadRemesh(Input=part, NumberOfQuads=600)
exact = QuadNodesOnCADGeometry(Input=quads)
exact.UpdatePipeline()
check(size_of(exact) == size_of(quads) > 0, "the filter changes the quads")
check(places(exact)[0] == 0, "nodes stay on the triangles")
check(exact.PointData["CadPlace"].GetRange() == (1, 3), "CadPlace has not faces, edges and vertices")
check(exact.GetPropertyValue("Verdict") == f"All {places(exact)[1]} nodes lie on the exact shape",
      "the verdict is " + exact.GetPropertyValue("Verdict"))
check(size_of(exact, 1) == 0, "problems where all is well")
deck = os.path.join(WORK, "window.inp")
simple.SaveData(deck, proxy=exact)
text = open(deck).read()
check("ELSET=SUPPORT" in text.upper() and "ELSET=BORE" in text.upper(), "faces with names are no sets of the deck")

elements = QuadElements(Input=quads, Surface=part, Order="Second")
second = QuadNodesOnCADGeometry(Input=elements)
second.UpdatePipeline()
check(places(second)[0] == 0 and places(second)[1] > places(exact)[1], "nodes of second order stay")

sized = QuadSizesByName(Input=part, Sizes=["bore", "0.5", "EDGE_1", "0.7"])
finer = QuadRemesh(Input=sized, NumberOfQuads=600)
finer.UpdatePipeline()
check(sized.PointData["Sizing"].GetRange() == (0.5, 1), "sizes by name are not those asked for")
check(abs(size_of(finer) / 600 - 1) < 0.2, "with sizes by name the number of quads is another one")
simple.Delete(finer)
simple.Delete(sized)

# The edges are the second output.
edges = simple.OutputPort(part, 1)
check(part.GetDataInformation(1).GetNumberOfCells() == 15, "the edges are not those of the shape")

both = QuadrilleCADReader(FileName=assembly)
both.UpdatePipeline()
check(both.GetDataInformation().GetCompositeDataClassName() == "vtkMultiBlockDataSet", "instances are no blocks")
blocks = QuadNodesOnCADGeometry(Input=QuadRemesh(Input=both, NumberOfQuads=800))
blocks.UpdatePipeline()
check(size_of(blocks) > 500, "no quads on the blocks")
both.JoinParts = 1
both.UpdatePipeline()
check(both.GetDataInformation().GetDataClassName() == "vtkPolyData", "joined parts are no surface")

state = os.path.join(WORK, "cad.pvsm")
simple.SaveState(state)
count = size_of(exact)
simple.ResetSession()
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
simple.LoadState(state)
again = [proxy for (name, _), proxy in simple.GetSources().items() if proxy.SMProxy.GetXMLName() == "QuadCADProjection"]
check(len(again) == 3, "the state has other filters")
for proxy in again:
    proxy.UpdatePipeline()
check(count in [size_of(proxy) for proxy in again], "the state gives other quads")
print("cad: fine")
