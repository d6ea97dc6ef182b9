# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Run by every rank, see test_mpi.py: mpi_script.py CASE..."""
import hashlib
import os
import re
import sys

import quadrille  # the classes behind the proxies
import quick_start  # before simple
from paraview import servermanager, simple
from vtkmodules.vtkCommonCore import vtkInformation, vtkInformationVector
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

from plugin_common import ARTIFACTS, DATA, PLUGIN, check

simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
process = servermanager.vtkProcessModule.GetProcessModule()
RANK, RANKS = process.GetPartitionId(), process.GetNumberOfLocalPartitions()


def digest(data):
    """Of the set of cells, each the set of its corners, to five digits."""
    points = [tuple(round(x, 5) + 0.0 for x in data.GetPoint(i)) for i in range(data.GetNumberOfPoints())]
    cells = sorted(sorted(points[data.GetCell(c).GetPointId(k)] for k in range(data.GetCell(c).GetNumberOfPoints()))
                   for c in range(data.GetNumberOfCells()))
    return hashlib.sha1(repr(cells).encode()).hexdigest()[:12]


def blocks(data):
    if data is None or not data.IsA("vtkCompositeDataSet"):
        yield "whole", data
        return
    if data.IsA("vtkPartitionedDataSetCollection"):  # how many partitions a rank has is its own affair
        for i in range(data.GetNumberOfPartitionedDataSets()):
            for k in range(data.GetNumberOfPartitions(i)):
                yield str(i), data.GetPartition(i, k)
        return
    walk = data.NewIterator()
    walk.UnRegister(None)
    walk.InitTraversal()
    while not walk.IsDoneWithTraversal():
        information = walk.GetCurrentMetaData()
        name = information.Get(vtkCompositeDataSet.NAME()) if information else None
        yield name or str(walk.GetCurrentFlatIndex()), walk.GetCurrentDataObject()
        walk.GoToNextItem()


def open_edges(data):
    """Number of edges with one quad only."""
    uses = {}
    for c in range(data.GetNumberOfCells()):
        ids = [data.GetCell(c).GetPointId(k) for k in range(4)]
        for a, b in zip(ids, ids[1:] + ids[:1]):
            edge = (a, b) if a < b else (b, a)  # a Programmable Filter replaces min
            uses[edge] = uses.get(edge, 0) + 1
    return list(uses.values()).count(1)


def tell(name, filter_proxy, port=0):
    filter_proxy.UpdatePipeline()
    return tell_as_it_is(name, filter_proxy, port)


def tell_as_it_is(name, filter_proxy, port=0):
    raw = filter_proxy.GetClientSideObject()
    lines = []
    for block, data in blocks(raw.GetOutputDataObject(port)):
        if data is not None and data.GetNumberOfCells() > 0:
            euler = data.GetNumberOfPoints() - data.GetNumberOfCells() - open_edges(data) // 2
            lines.append(f"BLOCK {name}/{block} {data.GetNumberOfCells()} quads, {open_edges(data)} open edges, "
                         f"Euler characteristic about {euler}, {digest(data)}")
    counts = f" {raw.GetActualQuads()} quads" if hasattr(raw, "GetActualQuads") else ""
    # The number of the point that is at fault counts in what was put together before it was found.
    reason = re.sub(r"point \d+", "point", raw.GetOutcomeText()).split("\n")
    lines.append(f"TOLD {name} outcome {raw.GetOutcome()}{counts} {'; '.join(reason)}")
    # A file for each rank: lines that several print at once come out mixed.
    with open(os.path.join(os.environ["QUADRILLE_MPI_FACTS"], str(RANK)), "a") as facts:
        facts.write("\n".join(lines) + "\n")
    return raw


def tell_after(name, filter_proxy, port):
    """What tell() tells where another output is looked at, as where a window shows marks before quads."""
    request, requests = vtkInformation(), vtkInformationVector()
    request.Set(vtkStreamingDemandDrivenPipeline.UPDATE_PIECE_NUMBER(), RANK)
    request.Set(vtkStreamingDemandDrivenPipeline.UPDATE_NUMBER_OF_PIECES(), RANKS)
    requests.SetInformationObject(port, request)
    filter_proxy.GetClientSideObject().Update(port, requests)
    return tell_as_it_is(name, filter_proxy)


def remesh(source, quads=600, **options):
    return QuadRemesh(Input=source, TargetType="Number Of Quads", NumberOfQuads=quads, **options)


def torus():
    return simple.Triangulate(Input=simple.Superquadric(
        Toroidal=1, ThetaResolution=48, PhiResolution=24, PhiRoundness=1, ThetaRoundness=1, Thickness=0.6))


def sphere(**options):
    return simple.Sphere(ThetaResolution=40, PhiResolution=30, **options)


def ply(name="frame.ply"):
    return simple.PLYReader(FileNames=[os.path.join(DATA, name)])


def box(n=8):
    """A box of n^3 voxels; each rank has a part of it."""
    return simple.Wavelet(WholeExtent=[0, n, 0, n, 0, n])


def tetrahedra():
    """A file of tetrahedra that fit together, as one rank alone makes them."""
    path = os.path.join(ARTIFACTS, f"mpi-tetrahedra-{RANKS}.vtu")
    if RANK == 0:
        from vtkmodules.vtkFiltersGeneral import vtkDataSetTriangleFilter
        from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
        source = vtkRTAnalyticSource()
        source.SetWholeExtent(0, 8, 0, 8, 0, 8)
        triangles = vtkDataSetTriangleFilter()
        triangles.SetInputConnection(source.GetOutputPort())
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetInputConnection(triangles.GetOutputPort())
        writer.SetFileName(path)
        writer.SetDataModeToBinary()
        writer.Write()
    process.GetGlobalController().Barrier()
    return simple.XMLUnstructuredGridReader(FileName=[path])


def broken_on(rank):
    """A sphere of which one rank gets a point that is no number; where there is no such rank, the first one."""
    return simple.ProgrammableFilter(Input=sphere(), Script=f"""
import numpy
output.ShallowCopy(inputs[0].VTKObject)
from vtkmodules.vtkParallelCore import vtkMultiProcessController
c = vtkMultiProcessController.GetGlobalController()
if c.GetLocalProcessId() == {rank} % c.GetNumberOfProcesses():
    points = inputs[0].VTKObject.GetPoints().NewInstance()
    points.DeepCopy(inputs[0].VTKObject.GetPoints())
    points.SetPoint(5, float('nan'), 0, 0)
    output.SetPoints(points)
""")


def group(*sources):
    return simple.GroupDatasets(Input=list(sources))


def chain(source):
    levels = DecimationHierarchy(Input=source, TargetType="Number Of Quads", NumberOfQuads=600)
    coarse = IntegerGridMap(Input=simple.OutputPort(levels, 0))
    upmap = IntegerGridMapUpmap(Input=coarse, Surface=source, Log=simple.OutputPort(levels, 2))
    return QuadExtraction(Input=upmap)


def partitioned():
    """A data set of three partitions that are one sphere."""
    parts = [sphere(StartTheta=a, EndTheta=b) for a, b in ((0.01, 120), (120, 240), (240, 360))]
    return simple.GroupDatasets(Input=parts, OutputType="vtkPartitionedDataSet")


def collection():
    return simple.GroupDatasets(Input=[sphere(), simple.Cylinder(Resolution=24)],
                                OutputType="vtkPartitionedDataSetCollection")


def sides(n=10):
    """The six sides of a box, each a block with points of its own, each of which all ranks have a part of."""
    corners = [((0, 0, 0), (0, 1, 0), (1, 0, 0)), ((0, 0, 1), (1, 0, 1), (0, 1, 1)), ((0, 0, 0), (1, 0, 0), (0, 0, 1)),
               ((0, 1, 0), (0, 1, 1), (1, 1, 0)), ((0, 0, 0), (0, 0, 1), (0, 1, 0)), ((1, 0, 0), (1, 1, 0), (1, 0, 1))]
    return [simple.Plane(Origin=list(o), Point1=list(a), Point2=list(b), XResolution=n, YResolution=n)
            for o, a, b in corners]


def tell_closed(name, filter_proxy):
    """What tell() tells, and on the first rank, where all conforming blocks lie, how often edges are used."""
    raw = tell(name, filter_proxy)
    uses = {}
    for _, data in blocks(raw.GetOutputDataObject(0)):
        for c in range(data.GetNumberOfCells() if data is not None else 0):
            places = [data.GetPoint(data.GetCell(c).GetPointId(k)) for k in range(4)]
            for pair in zip(places, places[1:] + places[:1]):
                edge = frozenset(pair)
                uses[edge] = uses.get(edge, 0) + 1
    check(set(uses.values()) <= {2, 4}, f"{name}: edges are used {sorted(set(uses.values()))} times")
    return raw


CASES = {
    "sources": lambda: [tell("sphere", remesh(sphere())), tell("torus", remesh(torus()))],
    "files": lambda: [tell("ply", remesh(ply())), tell("vtu", remesh(tetrahedra())),
                      tell_after("irregular vertices first", remesh(ply()), 4)],
    "redistribute": lambda: [
        tell("redistributed", remesh(simple.RedistributeDataSet(Input=ply()))),
        tell("redistributed torus", remesh(simple.RedistributeDataSet(Input=torus())))],
    "d3": lambda: [tell("tetrahedra", remesh(simple.D3(Input=tetrahedra())))],
    "volumes": lambda: [
        tell("image", remesh(box())),
        tell("contour", remesh(simple.Contour(Input=box(20), ContourBy=["POINTS", "RTData"], Isosurfaces=[150]), 900)),
        tell("unstructured", remesh(simple.RedistributeDataSet(Input=tetrahedra())))],
    "blocks": lambda: [tell("blocks", remesh(group(sphere(), simple.Cylinder(Resolution=24),
                                                   simple.Plane(XResolution=9, YResolution=9)), 900)),
                       tell("per block", remesh(group(sphere(), simple.Cylinder(Resolution=24)), 300,
                                                QuadsAre="Per Block"))],
    "conforming": lambda: [
        tell_closed("conforming", remesh(group(*sides(), sphere(Center=[9, 0, 0])), 900, Conforming=1)),
        tell_closed("touching solids", remesh(group(
            *(simple.Triangulate(Input=simple.Box(Center=[x, 0, 0])) for x in (0, 1))), 600, Conforming=1)),
        tell_closed("own numbers", remesh(group(*sides()), 700, Conforming=1, QuadsOfBlocks="Plane1 = 40"))],
    "partitions": lambda: [tell("partitions", remesh(partitioned()))],
    "collections": lambda: [tell("collection", remesh(collection(), 700))],
    "stages": lambda: [tell("stages", chain(sphere())), tell("stages of blocks", chain(group(sphere(), torus())))],
    "faults": lambda: [
        tell("bad point", remesh(broken_on(1))),
        tell("bad block", remesh(group(simple.Cylinder(Resolution=24), broken_on(1), sphere(Center=[3, 0, 0])), 900)),
        tell("bad property", remesh(sphere(), 0)),
        tell("no file", remesh(simple.PLYReader(FileNames=["/missing.ply"]))),  # which rank 0 alone reads
        tell("after it", remesh(sphere()))],
    "timeout": lambda: [tell("late", remesh(sphere(), TimeLimit=1e-9)), tell("after it", remesh(sphere()))],
}

for case in sys.argv[1:]:
    CASES[case]()
check(RANKS in (1, 2, 4), f"{RANKS} ranks")
