# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""In pvpython: the filters by the plugin, their properties, the chain of the four, the raw classes."""
import os
import tempfile

from paraview import servermanager, simple

import quadrille
from plugin_common import DATA, FILTERS, PLUGIN, check, number, size_of, surface

simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
for name in FILTERS:
    check(name in globals(), f"the plugin has no {name}")

mesh = surface(simple)
mesh.UpdatePipeline()
quads = QuadRemesh(Input=mesh, TargetType="Number Of Quads", NumberOfQuads=400)
quads.UpdatePipeline()
cells = size_of(quads)
check(cells > 0, "no quads")
check(number(quads, "ActualQuads") == cells, "ActualQuads differs from the output")
check("extract" in number(quads, "StageTimes"), "no stage times")
check(number(quads, "Certificate") != "", "no certificate")
# The mapped surface is made when something asks for it.
made = quads.GetClientSideObject().GetOutputDataObject(1)
check(made.GetNumberOfCells() == 0, "the mapped surface is made though nobody looks at it")
looked = simple.ExtractSurface(Input=simple.OutputPort(quads, 1))
looked.UpdatePipeline()
check(quads.ComputeMappedSurface == 1, "the mapped surface is not asked for by who looks at it")
check(size_of(quads, 1) == size_of(mesh), "the mapped surface has other faces than the surface")
simple.Delete(looked)
check(quads.PointData["Valence"] is not None, "no Valence")
check("ActualQuads" in quads.FieldData.keys(), "no field data")

# Every documented property can be set, and changes the result where it should.
quads.NumberOfQuads = 900
quads.UpdatePipeline()
check(size_of(quads) > cells, "more quads were asked, fewer came")
# What the panel shows is of this execution, without being asked for again.
check(quads.GetPropertyValue("ActualQuads") == size_of(quads), "Actual Quads is that of the execution before")
check(quads.GetPropertyValue("ResultText").startswith(f"{size_of(quads)} quads"),
      "Result Text is that of the execution before")
quads.TargetType = "Relative Edge Length"
quads.RelativeEdgeLength = 0.1
quads.UpdatePipeline()
coarse = size_of(quads)
quads.TargetType = "Edge Length"
quads.EdgeLength = 0.05
quads.UpdatePipeline()
check(size_of(quads) > coarse > 0, "edge length has no effect")
quads.DetectFeatures = 0
quads.FeatureAngle = 60
quads.CoarseVertices = 500
quads.NumberOfThreads = 1
quads.TimeLimit = 250
quads.MaximumNumberOfQuads = 100000
quads.UpdatePipeline()
quads.ComputeMappedSurface = 0
quads.UpdatePipeline()
check(quads.PatchArray == "(none)", "PatchArray should be (none) where there is no cell array")

# The number of quads comes first: it is the default, and whole numbers that the window has a field for.
default = QuadRemesh(Input=mesh)
check(default.TargetType == "Number Of Quads" and default.NumberOfQuads == 0, "the number is not that of the shape")
for name in ("NumberOfQuads", "MaximumNumberOfQuads", "ActualQuads"):
    kind = default.SMProxy.GetProperty(name).GetClassName()
    check(kind == "vtkSMIntVectorProperty", f"{name} is a {kind}, for which ParaView has no widget")
order = [default.SMProxy.GetPropertyGroup(i).GetXMLLabel() for i in range(default.SMProxy.GetNumberOfPropertyGroups())]
check(order[0] == "Quads" and order[-1] == "Run", f"the panel's order is {order}")
walk = servermanager.vtkSMOrderedPropertyIterator()
walk.SetProxy(default.SMProxy)
names = []
walk.Begin()
while not walk.IsAtEnd():
    names.append(walk.GetKey())
    walk.Next()
# Calm at first: the verdict, the number, features, the smallest detail, symmetry and the result.
shown = {name for name in names if default.SMProxy.GetProperty(name).GetPanelVisibility() == "default"
         and name != "Input"}
known = {"Verdict", "TargetType", "NumberOfQuads", "EdgeLength", "RelativeEdgeLength", "DetectFeatures", "FeatureAngle",
         "SmallestDetail", "Symmetry", "PlaneCurve", "RotationOrder", "SymmetryOrigin", "SymmetryNormal", "ResultText"}
check(shown == known, f"at first the panel has {shown - known} more, and not {known - shown}")
check(names.index("Verdict") < names.index("NumberOfQuads") < names.index("FeatureAngle")
      < names.index("GuidingStrokes") < names.index("ResultText") < names.index("NumberOfThreads"),
      f"the properties come as {names}")

# The patch array is found by its name.
marked = simple.Calculator(Input=mesh, AttributeType="Cell Data", ResultArrayName="PatchId", Function="1",
                           ResultArrayType="Int")
marked.UpdatePipeline()
check(QuadRemesh(Input=marked).PatchArray == "PatchId", "PatchId is not chosen where it is there")

# Another array is for the user to choose, also where it is the active one of a file, and known as such.
with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "active.vtk")
    with open(path, "w") as file:
        file.write("# vtk DataFile Version 3.0\ntwo colours\nASCII\nDATASET POLYDATA\nPOINTS 4 double\n0 0 0 1 0 0\n"
                   "1 1 0 0 1 0\nPOLYGONS 2 8\n3 0 1 2\n3 0 2 3\nCELL_DATA 2\nSCALARS Colour int 1\n"
                   "LOOKUP_TABLE default\n0\n1\n")
    coloured = simple.OpenDataFile(path)
    coloured.UpdatePipeline()
    for make, names in ((QuadRemesh, ("PatchArray", "GuideArray")), (DecimationHierarchy, ("PatchArray", "GuideArray")),
                        (QuadExtraction, ("PatchArray",))):
        asked = make(Input=coloured)
        chosen = [name for name in names if getattr(asked, name) != "(none)"]
        check(not chosen, f"{chosen} of {make.__name__} is chosen, though by nobody")
    of_coloured = QuadRemesh(Input=coloured, NumberOfQuads=50)
    borders = []
    for of_coloured.PatchArray in ("(none)", "Colour"):
        of_coloured.UpdatePipeline()
        borders.append(of_coloured.CellData["FeatureEdges"].GetRange()[1] > 0)
    check(borders == [False, True], f"borders without and with the array: {borders}")

# A curve as second input becomes a line between quads; without it there are only boundary lines.
plane = simple.Triangulate(Input=simple.Plane(XResolution=20, YResolution=20))
curve = simple.PolyLineSource(Points=[-0.5, 0.0, 0.0, 0.5, 0.0, 0.0])
for curves, expected in ((None, {1}), (curve, {0, 1})):
    flat = QuadRemesh(Input=plane, FeatureCurves=curves, TargetType="Number Of Quads", NumberOfQuads=200)
    flat.UpdatePipeline()
    lines = flat.GetClientSideObject().GetLines()
    boundary = lines.GetCellData().GetArray("Boundary")
    found = {boundary.GetValue(i) for i in range(boundary.GetNumberOfTuples())}
    check(found == expected, f"lines with Boundary {found} where {expected} was expected")
inner = [i for i in range(lines.GetNumberOfCells()) if boundary.GetValue(i) == 0]
heights = {round(lines.GetPoint(lines.GetCell(i).GetPointId(k))[1], 9) for i in inner for k in (0, 1)}
check(heights == {0.0}, f"the curve is not followed: {heights}")

# Strokes and valences by sources without any array; the output Constraints shows what became of them.
ball = simple.Triangulate(Input=simple.Sphere(ThetaResolution=48, PhiResolution=48))
stroke = simple.PolyLineSource(Points=[0.5, 0.0, 0.0, 0.4, 0.3, 0.0, 0.3, 0.4, 0.1])
point = simple.PolyPointSource(Points=[0.0, -0.5, 0.0])
drawn = QuadRemesh(Input=ball, NumberOfQuads=600, GuidingStrokes=stroke, StrokeWeight=0.5, ValencePoints=point,
                   ValenceAtPoints=5)
drawn.UpdatePipeline()
shown = servermanager.Fetch(drawn, idx=5)
kinds = [int(shown.GetCellData().GetArray("Constraint").GetTuple1(i)) for i in range(shown.GetNumberOfCells())]
check(kinds == [2, 1], f"constraints {kinds} where a valence that was met and a stroke were expected")
check(shown.GetCellData().GetArray("Valence").GetTuple1(0) == 5, "the valence at the point is not 5")
table = servermanager.Fetch(drawn, idx=6)
words = [table.GetColumnByName("Kind").GetValue(i) for i in range(table.GetNumberOfRows())]
check(words == ["guide stroke", "valence"], f"the constraint table has {words}")
check(table.GetColumnByName("Met").GetValue(1) == 1, "the table says that the valence is not met")
irregular = servermanager.Fetch(drawn, idx=4)
valences = irregular.GetPointData().GetArray("Valence")
index = sum(4 - valences.GetTuple1(i) for i in range(irregular.GetNumberOfPoints()))
check(irregular.GetNumberOfVerts() == irregular.GetNumberOfPoints() > 0, "the irregular vertices are no vertices")
check(index == 8, f"the indices of the irregular vertices of a sphere sum up to {index}")
check(servermanager.Fetch(drawn).GetPointData().GetNormals() is not None,
      "a smooth surface without normals is drawn flat")
# The cylinder comes with normals; where it has sharp edges they would smear them.
capped = QuadRemesh(Input=simple.Triangulate(Input=simple.Cylinder(Resolution=40)), NumberOfQuads=300)
capped.UpdatePipeline()
points = servermanager.Fetch(capped).GetPointData()
check(points.GetArray("Normals") is not None and points.GetNormals() is None, "sharp edges are drawn smooth")
drawn.ValencePoints = None
drawn.UpdatePipeline()
check(size_of(drawn, 5) == 1, "the valence point is still there")

# Doubles of a Calculator are whole numbers, too; on cells, or with another name, they are told.
def calculated(name, value, kind="Point Data"):
    return simple.Calculator(Input=ball, AttributeType=kind, ResultArrayName=name, Function=value)
remeshed = QuadRemesh(Input=calculated("TargetValence", "0"), NumberOfQuads=400)
remeshed.UpdatePipeline()
check("TargetValence" not in remeshed.GetPropertyValue("Notices"), "doubles are not taken for valences")

# The layout: the plate is cut in two by the curve, one line of the layout.
check(size_of(flat, 3) == 1, f"{size_of(flat, 3)} lines of the layout where one was expected")
patches = flat.GetClientSideObject().GetOutput().GetCellData().GetArray("LayoutPatch")
check(patches.GetRange() == (0.0, 1.0), f"layout patches {patches.GetRange()} where two were expected")
flat.CellDataFrom = "Area"
flat.UpdatePipeline()
check(flat.GetClientSideObject().GetCellDataFrom() == 1, "Cell Data From has no effect")

# A mirror plane: found, or given; at first it stands in the middle of the input.
mirrored = QuadRemesh(Input=ball, NumberOfQuads=400, Symmetry="Found")
mirrored.UpdatePipeline()
check(mirrored.PointData["MirrorPoint"] is not None, "no MirrorPoint")
box = ball.GetDataInformation().GetBounds()
middle = [(box[2 * i] + box[2 * i + 1]) / 2 for i in range(3)]
check(all(abs(a - b) < 1e-9 for a, b in zip(mirrored.SymmetryOrigin, middle)),
      f"the mirror plane stands at {mirrored.SymmetryOrigin}, not in the middle, {middle}")
mirrored.Symmetry = "Plane"
mirrored.SymmetryNormal = [0, 0, 2]
mirrored.UpdatePipeline()
check("mirror plane given" in mirrored.GetPropertyValue("Notices"), "the mirror plane is not told")

mirrored.PlaneCurve = "Mid-Line"
mirrored.UpdatePipeline()
image = servermanager.Fetch(mirrored).GetPointData().GetArray("MirrorPoint")
check(all(image.GetValue(p) != p for p in range(image.GetNumberOfTuples())), "points in the plane with a mid-line")
mirrored.PlaneCurve = "Isoline"

# An axis, which the same properties give, or which is found.
mirrored.Symmetry = "Rotation"
mirrored.RotationOrder = 4
mirrored.UpdatePipeline()
check("axis of order 4 given" in mirrored.GetPropertyValue("Notices"), "the axis is not told")
check(mirrored.PointData["RotatedPoint"] is not None, "no RotatedPoint")
mirrored.Symmetry = "Rotation Found"
mirrored.UpdatePipeline()
check("axis of order 4 found" in mirrored.GetPropertyValue("Notices"), "the axis that is found is not told")

# The four stages one by one.
hierarchy = DecimationHierarchy(Input=mesh, TargetType="Number Of Quads", NumberOfQuads=400)
grid = IntegerGridMap(Input=simple.OutputPort(hierarchy, 0))
upmap = IntegerGridMapUpmap(Input=grid, Surface=mesh, Log=simple.OutputPort(hierarchy, 2),
                            Intermediate=simple.OutputPort(hierarchy, 1))
extraction = QuadExtraction(Input=upmap)
extraction.UpdatePipeline()
check(size_of(extraction) == cells, "the chain and the one click differ")
check(number(upmap, "Certificate") != "", "no certificate of the chain")

# A map of another program: texture coordinates of an OBJ file, a plane of 8 x 6 quads in another unit and turned by
# 37 degrees at its boundary, read by ParaView's own reader.
with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "turned.obj")
    with open(path, "w") as file:
        for j in range(7):
            for i in range(9):
                file.write(f"v {i} {j} 0\nvt {(0.8 * i - 0.6 * j) / 10} {(0.6 * i + 0.8 * j) / 10}\n")
        for j in range(6):
            for i in range(8):
                a, b, c, d = 9 * j + i + 1, 9 * j + i + 2, 9 * j + i + 11, 9 * j + i + 10
                file.write(f"f {a}/{a} {b}/{b} {c}/{c}\nf {a}/{a} {c}/{c} {d}/{d}\n")
    turned = simple.OpenDataFile(path)
    foreign = QuadExtraction(Input=turned, TextureScale=10, BoundaryMode="Trimmed")
    foreign.UpdatePipeline()
    whole = size_of(foreign)
    check(0 < whole < 48, f"{whole} whole cells in 48")
    foreign.BoundaryMode = "Polygons"
    foreign.UpdatePipeline()
    partial = foreign.CellData["Partial"]
    check(size_of(foreign) > whole and partial.GetRange() == (0.0, 1.0), "no polygons at the boundary")
    data = foreign.FieldData
    check("MapLargestMove" in data.keys() and "NonIntegerFeatureEnds" in data.keys(), "no report in the field data")

# PLY files with all their properties: patch borders become edges of the quads, as with the command.
part = QuadrillePLYReader(FileName=os.path.join(DATA, "part.ply"))
part.UpdatePipeline()
check("PatchId" in part.CellData.keys(), "the reader lost PatchId")
of_part = QuadRemesh(Input=part, TargetType="Number Of Quads", NumberOfQuads=3000)
of_part.UpdatePipeline()
by_hand = quadrille.remesh(quadrille.read(os.path.join(DATA, "part.ply")), quads=3000)
check(size_of(of_part) == by_hand.GetNumberOfCells() > 0, "other quads than without ParaView")
check("PatchId" in of_part.CellData.keys(), "the quads have no PatchId")

# OFF files are opened like any other: ParaView has no reader of its own.
with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "sheet.off")
    with open(path, "w") as file:
        file.write("OFF\n9 8 0\n" + "".join(f"{i} {j} 0\n" for j in range(3) for i in range(3)))
        for j in range(2):
            for i in range(2):
                a = 3 * j + i
                file.write(f"3 {a} {a + 1} {a + 4} {i}\n3 {a} {a + 4} {a + 3} {i}\n")
    sheet = simple.OpenDataFile(path)
    check(sheet is not None and sheet.GetXMLName() == "QuadrilleOFFReader", f"an OFF file is opened by {sheet}")
    of_sheet = QuadRemesh(Input=sheet, TargetType="Number Of Quads", NumberOfQuads=100, PatchArray="ColorIndex")
    of_sheet.UpdatePipeline()
    check(size_of(of_sheet) > 0 and of_sheet.CellData["ColorIndex"].GetRange() == (0.0, 1.0), "no quads of an OFF file")
    check(of_sheet.CellData["FeatureEdges"].GetRange()[1] > 0, "the border between two colours is no feature")

# What needs CGAL: a wrap of two balls that cross each other, its quads, and these on the balls again.
if "SurfaceWrap" in FILTERS:
    balls = simple.AppendGeometry(Input=[simple.Sphere(Center=(0, 0, 0), ThetaResolution=24, PhiResolution=16),
                                         simple.Sphere(Center=(0.5, 0, 0), ThetaResolution=24, PhiResolution=16)])
    repaired = SurfaceRepair(Input=balls)
    repaired.UpdatePipeline()
    check(repaired.CellData["SelfIntersecting"].GetRange() == (0.0, 1.0), "no face crosses another one")
    check("cross each other" in number(repaired, "Notices"), "the panel does not tell what crosses")
    wrap = SurfaceWrap(Input=balls, Alpha=0.05, Offset=0.01)
    of_wrap = QuadRemesh(Input=wrap, TargetType="Number Of Quads", NumberOfQuads=300, DetectFeatures=0)
    projected = QuadProjection(Input=of_wrap, Surface=balls)
    projected.UpdatePipeline()
    check(size_of(projected) == size_of(of_wrap) > 0, "no quads of a wrap")
    check(projected.PointData["OnSurface"].GetRange()[1] == 1, "no point of the quads lies on the balls")

# The raw class is the same behind the proxy, and without one.
raw = quads.GetClientSideObject()
check(isinstance(raw, quadrille.vtkQuadRemesh), f"the proxy holds a {type(raw)}")
result = quadrille.remesh(servermanager.Fetch(mesh), quads=400)
check(result.GetNumberOfCells() == cells, "quadrille.remesh and the plugin differ")
print("pvpython: fine")
