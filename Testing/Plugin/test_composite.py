# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Composite data and volume meshes in ParaView: an Exodus file, groups of every kind, adaptive grids."""
import os

import quadrille  # the classes behind the proxies
import quick_start  # before simple
from paraview import simple

from plugin_common import ARTIFACTS, PLUGIN, check, size_of

simple.LoadPlugin(PLUGIN, remote=False, ns=globals())


def remesh(source):
    quads = QuadRemesh(Input=source, TargetType="Number Of Quads", NumberOfQuads=800)
    quads.UpdatePipeline()
    raw = quads.GetClientSideObject()
    check(raw.GetOutcome() == raw.Succeeded, raw.GetOutcomeText())
    check(size_of(quads) == raw.GetActualQuads() > 0, "no quads")
    return quads, raw


# An Exodus file: a multiblock of multiblocks, with leaves that are empty, and of tetrahedra.
path = os.path.join(ARTIFACTS, "composite.ex2")
box = simple.Tetrahedralize(Input=simple.Wavelet(WholeExtent=[0, 8, 0, 8, 0, 8]))
simple.SaveData(path, proxy=box)
reader = simple.ExodusIIReader(FileName=[path])
reader.UpdatePipeline()
check(reader.GetClientSideObject().GetOutputDataObject(0).IsA("vtkMultiBlockDataSet"), "no multiblock")
quads, raw = remesh(reader)
check("the surface of 2560 volume cells" in raw.GetNoticesText(), raw.GetNoticesText())
check(raw.GetOutputDataObject(0).IsA("vtkMultiBlockDataSet"), "the output is no multiblock")

# Blocks of all kinds in one group.
parts = [simple.Sphere(), simple.Wavelet(WholeExtent=[0, 6, 0, 6, 0, 6]),
         simple.Tetrahedralize(Input=simple.Cone(Resolution=12)),
         simple.Plane(XResolution=5, YResolution=5)]
for kind in ("vtkMultiBlockDataSet", "vtkPartitionedDataSetCollection"):
    quads, raw = remesh(simple.GroupDatasets(Input=parts, OutputType=kind))
    check(raw.GetOutputDataObject(0).IsA(kind),
          f"{raw.GetOutputDataObject(0).GetClassName()} where {kind} was expected")
    check(raw.GetNoticesText().count("the surface of") == 1, raw.GetNoticesText())
quads.QuadsAre = "Per Block"
quads.UpdatePipeline()
check(raw.GetTargetQuads() == 800 * len(parts),
      f"{raw.GetTargetQuads()} quads where each of {len(parts)} blocks gets 800")

# What filters do with blocks downstream.
merged = simple.MergeBlocks(Input=quads)
merged.UpdatePipeline()
check(size_of(merged) == size_of(quads), "blocks are lost downstream")

# Grids of other kinds, which have no composite data.
for source in (simple.HierarchicalFractal(MaximumLevel=1), simple.FastUniformGrid(WholeExtent=[0, 5, 0, 5, 0, 5])):
    source.UpdatePipeline()
    quads, raw = remesh(source)

# The stage filters go through blocks, too.
spheres = simple.GroupDatasets(Input=[simple.Sphere(), simple.Sphere(Center=[2, 0, 0], ThetaResolution=30)])
levels = DecimationHierarchy(Input=spheres, TargetType="Number Of Quads", NumberOfQuads=600)
upmap = IntegerGridMapUpmap(Input=IntegerGridMap(Input=simple.OutputPort(levels, 0)), Surface=spheres,
                            Log=simple.OutputPort(levels, 2))
extraction = QuadExtraction(Input=upmap)
extraction.UpdatePipeline()
quads = QuadRemesh(Input=spheres, TargetType="Number Of Quads", NumberOfQuads=600)
quads.UpdatePipeline()
check(size_of(extraction) == size_of(quads) > 0, "the chain gives other quads than the filter")
print("composite: fine")
