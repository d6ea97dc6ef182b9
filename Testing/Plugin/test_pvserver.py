# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Plugin on a pvserver and on its client: test_pvserver.py PVSERVER."""
import os
import sys
import tempfile
import traceback

import quick_start  # before simple
from paraview import servermanager, simple
from vtkmodules.vtkCommonCore import vtkLogger

import paraview_server
import quadrille
from plugin_common import PLUGIN, check, number, size_of, surface


def run(server):
    simple.Connect("127.0.0.1", server.port)
    simple.LoadPlugin(PLUGIN, remote=True, ns=globals())
    simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
    mesh = surface(simple)
    quads = QuadRemesh(Input=mesh, TargetType="Number Of Quads", NumberOfQuads=400)
    quads.UpdatePipeline()
    cells = size_of(quads)
    check(cells > 0, "no quads from the server")
    check(number(quads, "ActualQuads") == cells, "ActualQuads does not reach the client")
    check("extract" in number(quads, "StageTimes"), "stage times do not reach the client")
    data = servermanager.Fetch(quads)
    check(data.GetNumberOfCells() == cells and data.GetPointData().HasArray("Valence"),
          "the quads do not reach the client")
    # The server writes, by a writer of the plugin.
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "quads.inp")
        simple.SaveData(path, proxy=quads, ElementType="S4R")
        with open(path) as file:
            text = file.read()
    check("TYPE=S4R," in text and f"{cells} elements" in text, "Save Data on the server wrote something else")
    hierarchy = DecimationHierarchy(Input=mesh, TargetType="Number Of Quads", NumberOfQuads=400)
    upmap = IntegerGridMapUpmap(Input=IntegerGridMap(Input=simple.OutputPort(hierarchy, 0)), Surface=mesh,
                                Log=simple.OutputPort(hierarchy, 2))
    extraction = QuadExtraction(Input=upmap)
    extraction.UpdatePipeline()
    check(size_of(extraction) == cells, "the chain gives another result on the server")
    check(quadrille.check(extraction) is extraction, "check does not return what it was given")

    # An array upstream that changes is answered from the stage that it enters at, on the server, too.
    guided = simple.Calculator(Input=mesh, AttributeType="Cell Data", ResultArrayName="GuidingDirection",
                               Function="iHat")
    hierarchy = DecimationHierarchy(Input=guided, TargetType="Number Of Quads", NumberOfQuads=400)
    upmap = IntegerGridMapUpmap(Input=IntegerGridMap(Input=simple.OutputPort(hierarchy, 0)), Surface=guided,
                                Log=simple.OutputPort(hierarchy, 2), Intermediate=simple.OutputPort(hierarchy, 1))
    extraction = QuadExtraction(Input=upmap)
    quads = QuadRemesh(Input=guided, TargetType="Number Of Quads", NumberOfQuads=400)
    for function in ("iHat", "jHat"):
        guided.Function = function
        for last in (extraction, quads):
            quadrille.check(last)
            last.UpdatePipeline()
        check(size_of(extraction) == size_of(quads), "guided quads of the chain are others")
        for first in (hierarchy, quads):
            first.UpdatePropertyInformation()
            stages = str(first.StageTimes)
            for phase in ("phase1", "phase2"):
                check((phase in stages) == (function == "iHat"), f"with {function} these stages ran: {stages}")

    # A failure on the server is raised on the client. The line that both print of it is wanted, hence the last.
    server.is_heard.clear()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    bad = QuadRemesh(Input=mesh, TargetType="Edge Length", EdgeLength=-1)
    for proxy in (bad, simple.Calculator(Input=bad, Function="1")):
        try:
            quadrille.check(proxy)
        except quadrille.RemeshError as error:
            check("edge length" in str(error), f"the reason does not reach the client: {error}")
        else:
            check(False, "a failure on the server is not noticed")


server = paraview_server.Server([sys.argv[1]])
failed = 0
try:
    run(server)
    print("pvserver: fine", flush=True)
except BaseException:
    traceback.print_exc()
    failed = 1
# The client complains of the server's end, which is no result of the test.
server.stop()
sys.stderr.flush()
os._exit(failed)
