# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Picture of a quad mesh: quads with their edges, irregular vertices as balls, feature lines.

  xvfb-run -a pvpython --force-offscreen-rendering Scripts/figures/render.py QUADS.{vtp,obj,ply,vtu} PICTURE.png
      [--size W H] [--view X Y Z] [--up X Y Z] [--zoom Z] [--no-edges] [--no-balls]

Balls: valence 3 blue, 5 red, 6 and more purple, 2 and less black; on the boundary, where 3 is regular: 2 green, 4 and
more orange. --view is the direction from the mesh to the camera.
"""
import argparse
import sys

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

COLOURS = {
    "three": (0.12, 0.35, 0.85), "five": (0.85, 0.13, 0.13), "six": (0.55, 0.15, 0.65),
    "two": (0.05, 0.05, 0.05), "boundary low": (0.10, 0.60, 0.25), "boundary high": (0.95, 0.55, 0.05),
}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("picture")
    parser.add_argument("--size", type=int, nargs=2, default=(1400, 1000))
    parser.add_argument("--view", type=float, nargs=3, default=(0.6, -1.0, 0.55))
    parser.add_argument("--up", type=float, nargs=3)
    parser.add_argument("--zoom", type=float, default=1.0)
    parser.add_argument("--no-edges", action="store_true")
    parser.add_argument("--no-balls", action="store_true")
    return parser.parse_args()


def read(path):
    """The mesh as points (n by 3), quads (m by 4) and the feature bits of the quads (or None)."""
    source = simple.OpenDataFile(path)
    if source is None:
        sys.exit(f"render: cannot read {path}")
    simple.UpdatePipeline(proxy=source)
    surface = simple.ExtractSurface(Input=source)
    data = simple.servermanager.Fetch(surface)
    if data.GetNumberOfPoints() == 0:
        sys.exit(f"render: {path} has no points")
    points = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    if corners.size != 4 * data.GetNumberOfPolys():
        sys.exit(f"render: {path} has faces that are no quads")
    bits = data.GetCellData().GetArray("FeatureEdges")
    return surface, points, corners.reshape(-1, 4), vtk_to_numpy(bits) if bits else None


def edges_of(quads):
    """Distinct edges, how many quads each has, and for each side of each quad the edge's number."""
    sides = numpy.stack([quads, numpy.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2)
    edges, number, uses = numpy.unique(numpy.sort(sides, axis=1), axis=0, return_inverse=True, return_counts=True)
    return edges, uses, number.reshape(-1, 4)


def irregular(points, quads):
    """Point ids of the irregular vertices by the name of their colour. Needs nothing but the quads."""
    edges, uses, _ = edges_of(quads)
    valence = numpy.bincount(edges.ravel(), minlength=len(points))
    boundary = numpy.zeros(len(points), bool)
    boundary[edges[uses == 1].ravel()] = True
    inside, used = ~boundary, valence > 0
    return {
        "three": numpy.flatnonzero(inside & (valence == 3)), "five": numpy.flatnonzero(inside & (valence == 5)),
        "six": numpy.flatnonzero(inside & (valence >= 6)), "two": numpy.flatnonzero(inside & used & (valence < 3)),
        "boundary low": numpy.flatnonzero(boundary & (valence < 3)),
        "boundary high": numpy.flatnonzero(boundary & (valence > 3)),
    }


def line_ids(quads, bits):
    """Edges on the boundary and on features."""
    edges, uses, number = edges_of(quads)
    marked = uses == 1
    if bits is not None:
        for i in range(4):
            marked[number[(bits >> i) & 1 == 1, i]] = True
    return edges[marked]


def producer(data, name):
    source = simple.TrivialProducer(registrationName=name)
    source.GetClientSideObject().SetOutput(data)
    source.UpdatePipeline()
    return source


def polydata(points):
    data = vtkPolyData()
    data.SetPoints(vtkPoints())
    data.GetPoints().SetData(numpy_to_vtk(numpy.ascontiguousarray(points), deep=True))
    return data


def show_balls(view, points, radius, colour, name):
    glyph = simple.Glyph(Input=producer(polydata(points), name), GlyphType="Sphere")
    glyph.GlyphType.ThetaResolution = glyph.GlyphType.PhiResolution = 16
    glyph.ScaleArray = ["POINTS", "No scale array"]
    glyph.OrientationArray = ["POINTS", "No orientation array"]
    glyph.ScaleFactor = 2 * radius
    glyph.GlyphMode = "All Points"
    display = simple.Show(glyph, view)
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = colour
    display.Specular = 0.3


def show_lines(view, points, edges, radius):
    used, ids = numpy.unique(edges, return_inverse=True)
    data = polydata(points[used])
    cells = vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(numpy.arange(0, 2 * len(edges) + 1, 2), deep=True),
                  numpy_to_vtkIdTypeArray(ids.ravel().astype(numpy.int64), deep=True))
    data.SetLines(cells)
    tubes = simple.Tube(Input=producer(data, "lines"), Radius=radius, NumberofSides=8)
    display = simple.Show(tubes, view)
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = (0.05, 0.25, 0.20)


def fit(view, points, direction, up, zoom):
    """A parallel camera that looks against `direction` and has the points fill the picture."""
    direction = direction / numpy.linalg.norm(direction)
    right = numpy.cross(up, direction)
    right /= numpy.linalg.norm(right)
    up = numpy.cross(direction, right)
    across, along, depth = points @ right, points @ up, points @ direction
    middle = [0.5 * (c.min() + c.max()) for c in (across, along, depth)]
    centre = middle[0] * right + middle[1] * up + middle[2] * direction
    width, height = view.ViewSize
    half = 0.5 * max(numpy.ptp(along), numpy.ptp(across) * height / width)
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = list(centre)
    view.CameraPosition = list(centre + 2 * numpy.ptp(points, axis=0).sum() * direction)
    view.CameraViewUp = list(up)
    view.CameraParallelScale = 1.06 * half / zoom


def main():
    args = arguments()
    simple._DisableFirstRenderCameraReset()
    surface, points, quads, bits = read(args.mesh)
    edges, _, _ = edges_of(quads)
    length = float(numpy.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1).mean())

    view = simple.CreateView("RenderView")
    view.ViewSize = list(args.size)
    view.UseColorPaletteForBackground = 0
    view.Background = (0.97, 0.97, 0.98)
    view.OrientationAxesVisibility = 0
    display = simple.Show(surface, view)
    display.ColorArrayName = ["POINTS", ""]
    display.SetRepresentationType("Surface" if args.no_edges else "Surface With Edges")
    display.AmbientColor = display.DiffuseColor = (0.93, 0.87, 0.74)
    display.EdgeColor = (0.25, 0.25, 0.28)
    display.LineWidth = 1.0
    display.Interpolation = "Flat"
    display.Ambient = 0.2
    display.Diffuse = 0.85
    lines = line_ids(quads, bits)
    if len(lines):
        show_lines(view, points, lines, 0.08 * length)
    if not args.no_balls:
        for name, ids in irregular(points, quads).items():
            if len(ids):
                show_balls(view, points[ids], 0.28 * length, COLOURS[name], name)

    direction = numpy.array(args.view) / numpy.linalg.norm(args.view)
    up = args.up or ((0, 1, 0) if abs(direction[2]) > 0.95 else (0, 0, 1))
    fit(view, points, numpy.array(args.view), numpy.array(up, float), args.zoom)
    simple.Render(view)
    simple.SaveScreenshot(args.picture, view, ImageResolution=list(args.size))
    simple.Delete(view)  # an open window at the exit ends in an error of the X server
    print(f"render: {args.picture}: {len(quads)} quads, {len(points)} points")


if __name__ == "__main__":
    main()
