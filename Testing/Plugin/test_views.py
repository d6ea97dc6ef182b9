# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What a view shows is current also after a failure: ParaView 5.11 alone would show the quads before it for ever."""
import quick_start  # before simple
from paraview import simple

from plugin_common import PLUGIN, check, size_of, surface

simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
remesher = QuadRemesh(Input=surface(simple), NumberOfQuads=300)
behind = simple.ExtractEdges(Input=remesher)
view = simple.CreateRenderView()
shown = [simple.Show(remesher, view), simple.Show(behind, view)]


def represented(quads):
    """Points that each representation holds after the view was drawn."""
    remesher.NumberOfQuads = quads
    simple.Render(view)
    return [representation.SMProxy.GetRepresentedDataInformation().GetNumberOfPoints() for representation in shown]


before = represented(300)
check(min(before) > 0, f"nothing is shown: {before}")
check(represented(20000000) == before, "a failure changes what is shown")
after = represented(900)
check(min(after) > 2 * max(before), f"after a failure the view shows {after} points, before it {before}")
check(size_of(remesher) > 600, "too few quads")
print("views: fine", before, after)
