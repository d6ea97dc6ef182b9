# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The sources of constraints in pvpython: what each makes, and that Quad Remesh does what it asks for."""
import os
import tempfile

import numpy
import quadrille
import quick_start  # before simple
from paraview import servermanager, simple
from plugin_common import DATA, PLUGIN, check
from vtkmodules.util.numpy_support import vtk_to_numpy

QUADS = 1200
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
surface = QuadrillePLYReader(FileName=os.path.join(DATA, "beast.ply"))
surface.UpdatePipeline()


def remeshed(*constraints, **settings):
    """The filter, run with these constraints."""
    proxy = QuadRemesh(Input=surface, NumberOfQuads=QUADS, Constraints=list(constraints), **settings)
    quadrille.check(proxy)
    return proxy


def output(proxy, port):
    return proxy.GetClientSideObject().GetOutputDataObject(port)


def points_of(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def quads_of(proxy):
    """Points, and corners by quad."""
    data = output(proxy, 0)
    return points_of(data), vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 4)


def rows(proxy):
    table = output(proxy, 6)
    return [{name: table.GetValueByName(r, name).ToString() for name in ("Kind", "Met", "Deviation", "Reason")}
            for r in range(table.GetNumberOfRows())]


def check_met(proxy, *kinds):
    found = rows(proxy)
    check([row["Kind"] for row in found] == list(kinds), f"the table has {found}")
    check(all(row["Met"] == "1" for row in found), f"not met: {found}")
    shown = output(proxy, 5).GetCellData()
    check(shown.GetScalars().GetName() == "Met", "the output is not coloured by what is met")
    check(shown.GetScalars().GetRange() == (1, 1), "the output shows something as not met")


def edges_at(proxy, place):
    """Number of edges at the vertex next to the place, and its distance from there."""
    points, quads = quads_of(proxy)
    distances = numpy.linalg.norm(points - place, axis=1)
    return int((quads == distances.argmin()).sum()), distances.min()


def chain_of(proxy):
    """The ids of the vertices of the only line of the output Constraints, each joined to the next by an edge."""
    points, quads = quads_of(proxy)
    shown = output(proxy, 5)
    check(shown.GetNumberOfLines() == 1, "the output Constraints has not one line")
    ids = [int(numpy.linalg.norm(points - p, axis=1).argmin()) for p in points_of(shown)]
    edges = {frozenset((int(q[i]), int(q[(i + 1) % 4]))) for q in quads for i in range(4)}
    check(all(frozenset(pair) in edges for pair in zip(ids, ids[1:])), "the line does not run along edges")
    return ids


def irregular(proxy):
    """(place, valence) of the irregular vertices."""
    data = output(proxy, 4)
    return list(zip(points_of(data), vtk_to_numpy(data.GetPointData().GetArray("Valence"))))


plain = remeshed(ComputeMappedSurface=1)

# Each source makes one cell with all arrays; one that is switched off makes nothing.
line = [-0.5, -0.33, 0.34, 0.4, -0.47, 0.0]
kinds = {"QuadStroke": 1, "QuadConnection": 2, "QuadLoop": 3, "QuadFeatureCurve": 0, "QuadValence": 0, "QuadMove": 4,
         "QuadClearedFeature": 6, "QuadSize": 7}
for name, kind in kinds.items():
    source = globals()[name]()
    source.UpdatePipeline()
    data = servermanager.Fetch(source)
    check(data.GetNumberOfCells() == 1, f"{name} makes {data.GetNumberOfCells()} cells")
    check(data.GetCellData().GetArray("ConstraintType").GetTuple1(0) == kind, f"{name} makes another kind")
    asked = data.GetPointData().GetArray("TargetValence").GetRange()
    check(asked == ((3, 3) if name == "QuadValence" else (0, 0)), f"{name} asks for the valences {asked}")
    check(all(data.GetCellData().HasArray(a) for a in ("GuidingWeight", "GuidingRadius", "SizeFactor")),
          f"{name} lacks arrays")
    source.Enabled = 0
    source.UpdatePipeline()
    check(servermanager.Fetch(source).GetNumberOfCells() == 0, f"{name} makes something though it is off")
    check(not len(plain.Constraints), f"{name} connects itself in a script")

# The first points are on the box round the selected surface; given ones stay.
simple.SetActiveSource(plain)
box = surface.GetDataInformation().GetBounds()
check(QuadValence().Point[2] == box[5], "a valence is not placed on top of the surface")
check(list(QuadValence(Point=[1, 2, 3]).Point) == [1, 2, 3], "a given point is placed anew")
simple.SetActiveSource(None)

# A stroke: the edges of the quads next to it lie along it, or across.
quads = remeshed(QuadStroke(Points=line))
check_met(quads, "guide stroke")
corners, faces = quads_of(quads)
centres = corners[faces].mean(axis=1)
shown = output(quads, 5)
angles = []
for p, direction in zip(points_of(shown), vtk_to_numpy(shown.GetPointData().GetArray("Direction"))):
    quad = corners[faces[numpy.linalg.norm(centres - p, axis=1).argmin()]]
    sides = [quad[1] - quad[0] + quad[2] - quad[3], quad[3] - quad[0] + quad[2] - quad[1]]
    angles.append(min(numpy.degrees(numpy.arccos(min(1, abs(side @ direction) / numpy.linalg.norm(side))))
                      for side in sides))
# What the table allows as the mean over the stroke's faces, and a little for the quads' own bend.
check(numpy.mean(angles) < 7, f"the quads next to the stroke are {numpy.mean(angles):.1f} degrees off")

# A valence at a place of the surface.
vertices = points_of(output(plain, 1))
place = vertices[numpy.linalg.norm(vertices - [-0.2, -0.44, 0.1], axis=1).argmin()]
quads = remeshed(QuadValence(Point=list(place), Valence=5))
check_met(quads, "valence")
# Points of the quads are kept in single precision.
check(edges_at(quads, place)[0] == 5 and edges_at(quads, place)[1] < 1e-6, f"at the point are {edges_at(quads, place)}")

# A loop round the body.
ring = [0, 0.36, 0.35, 0, 0.38, -0.1, 0, -0.4, -0.1, 0, -0.36, 0.35]
quads = remeshed(QuadLoop(Points=ring))
check_met(quads, "cycle")
chain = chain_of(quads)
check(chain[0] == chain[-1] and len(set(chain)) == len(chain) - 1 > 10, f"the loop is {chain}")

# A connection of the two nearest irregular vertices that can be joined.
found = irregular(plain)
pairs = sorted(((numpy.linalg.norm(a[0] - b[0]), i, k) for i, a in enumerate(found) for k, b in enumerate(found[:i])))
for _, i, k in pairs[:10]:
    quads = remeshed(QuadConnection(Points=list(found[i][0]) + list(found[k][0])))
    if rows(quads)[0]["Met"] == "1":
        break
check_met(quads, "connection")
chain = chain_of(quads)
corners, faces = quads_of(quads)
ends = [int((faces == v).sum()) for v in (chain[0], chain[-1])]
check(4 not in ends and all((faces == v).sum() == 4 for v in chain[1:-1]), f"the chain ends at valences {ends}")

# A feature curve, which runs straight over the faces.
quads = remeshed(QuadFeatureCurve(Points=line))
check([row["Kind"] for row in rows(quads)] == ["feature curve"] and float(rows(quads)[0]["Deviation"]) < 0.3,
      f"a feature curve gives {rows(quads)}")

# A move: the same quads as in a session, bit for bit; the vertex is at the new place and not at the old one.
start, valence = min(found, key=lambda vertex: numpy.linalg.norm(vertex[0] - [0.78, -0.19, 0.76]))
target = start + [0.01, 0.04, 0.1]
quads = remeshed(QuadMove(From=list(start), To=list(target)))
check_met(quads, "move")
reached = points_of(output(quads, 5))[0]
check(numpy.linalg.norm(reached - target) < 0.05, f"the vertex went to {reached}")
check(edges_at(quads, reached)[0] == valence and edges_at(quads, reached)[1] < 1e-6,
      f"at the new place are {edges_at(quads, reached)}")
session = quadrille.Session(output(surface, 0), quads=QUADS, feature_angle=40)
session.move_irregular(start, target)
session.update()
check(numpy.array_equal(session.quads[0], points_of(output(quads, 0))), "a session gives other quads")
check(len(irregular(quads)) == len(found), "the move changes the number of irregular vertices")

# What cannot be moved is told, and the rest is done.
simple.SetActiveSource(None)
both = remeshed(QuadValence(Point=list(place), Valence=5), QuadMove(From=list(start), To=list(start)))
check([row["Met"] for row in rows(both)] == ["1", "0"], f"a move to where the vertex is gives {rows(both)}")
check("already" in rows(both)[1]["Reason"], f"the reason is {rows(both)[1]['Reason']}")
check(output(both, 5).GetCellData().GetScalars().GetRange() == (0, 1), "what is not met is not shown so")

# All classes at once, in the order of the connections; a preview shows them, too.
every = [QuadStroke(Points=line), QuadLoop(Points=ring), QuadMove(From=list(start), To=list(target))]
quads = remeshed(*every)
check([row["Kind"] for row in rows(quads)] == ["guide stroke", "cycle", "move"], f"all at once: {rows(quads)}")
quads.Preview = 1
quadrille.check(quads)
check(output(quads, 5).GetNumberOfCells() == 3, "the preview does not show the constraints")
quads.Preview = 0
every[0].Enabled = 0
quadrille.check(quads)
check([row["Kind"] for row in rows(quads)] == ["cycle", "move"], f"without the stroke: {rows(quads)}")
quads.Constraints = []
quadrille.check(quads)
check(numpy.array_equal(points_of(output(quads, 0)), points_of(output(plain, 0))), "without constraints: other quads")

# A mirror plane is shown by the edges in it.
quads = remeshed(Symmetry="Plane", SymmetryNormal=[0, 1, 0])
check_met(quads, "symmetry")
shown = output(quads, 5)
image = vtk_to_numpy(output(quads, 0).GetPointData().GetArray("MirrorPoint"))
corners, faces = quads_of(quads)
inside = image == numpy.arange(len(image))
edges = {frozenset((int(q[i]), int(q[(i + 1) % 4]))) for q in faces for i in range(4)}
check(shown.GetNumberOfCells() == sum(all(inside[p] for p in edge) for edge in edges) > 20, "the plane is not shown")
height = abs(points_of(shown)[:, 1] - quads.SymmetryOrigin[1]).max()
check(height < 1e-6, f"the line is {height} off the plane")  # points of the quads are kept in single precision

# A state file has the constraints and their connections.
simple.RenameSource("V", QuadValence(Point=list(place), Valence=5))
quads = remeshed(simple.FindSource("V"))
simple.RenameSource("Q", quads)
quads = None
with tempfile.TemporaryDirectory() as folder:
    servermanager.SaveState(os.path.join(folder, "constraints.pvsm"))
    simple.ResetSession()
    simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
    simple.LoadState(os.path.join(folder, "constraints.pvsm"))
loaded = simple.FindSource("Q")
quadrille.check(loaded)
check(len(loaded.Constraints) == 1, f"the state file gives the constraints {loaded.Constraints}")
check(list(simple.FindSource("V").Point) == list(place), "the state file gives another place")
check_met(loaded, "valence")
print("constraints: fine")
