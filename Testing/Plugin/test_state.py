# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""A state file keeps the filter with its properties, and loads once the plugin is there."""
import os

import quick_start  # before simple
from paraview import simple

from plugin_common import ARTIFACTS, PLUGIN, check, size_of, surface

simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
state = os.path.join(ARTIFACTS, "quadrille.pvsm")
quads = QuadRemesh(registrationName="my quads", Input=surface(simple), TargetType="Number Of Quads", NumberOfQuads=350,
                   FeatureAngle=55, FeatureCriterion="Angle", CoarseVertices=600)
quads.UpdatePipeline()
cells = size_of(quads)
simple.SaveState(state)
simple.ResetSession()
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
simple.LoadState(state)
again = simple.FindSource("my quads")
check(again is not None, "the filter is not in the state")
check(again.NumberOfQuads == 350 and again.FeatureAngle == 55 and again.CoarseVertices == 600
      and again.FeatureCriterion == "Angle", "properties are lost")
check(again.TargetType == "Number Of Quads", "the target type is lost")
again.UpdatePipeline()
check(size_of(again) == cells > 0, "the state gives another result")
print("state: fine")
