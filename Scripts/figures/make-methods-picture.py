#!/usr/bin/env pvpython
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Picture of the four methods side by side, as Figure 8 of [Ebke et al. 2016]: the same surface with the same features
and guides, the isolines of each map on it, irregular vertices as balls (blue: fewer than four edges, red: more), and
triangles that the map inverts in red.

  PYTHONPATH=build/lib/python3/dist-packages xvfb-run -a pvpython Scripts/figures/make-methods-picture.py
      [SURFACE.ply] [OUT.png] [--quads N] [--view X Y Z] [--up X Y Z] [--zoom Z]

Guides: the cells in the middle third of the surface, along its longest extent, ask for the direction of that extent,
turned by 30 degrees, with weight 0.3.
"""
import argparse
import math

import numpy
import quadrille
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

TILE = (480, 470)
METHODS = (("scale aware", "ScaleAware"), ("mixed integer", "MixedInteger"), ("QuadCover", "QuadCover"),
           ("seamless", "Seamless"))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("surface", nargs="?", default="Data/part.ply")
    parser.add_argument("picture", nargs="?", default="Documentation/Pictures/methods.png")
    parser.add_argument("--quads", type=int, default=700)
    parser.add_argument("--view", type=float, nargs=3, default=(0.2, -0.75, 0.8))
    parser.add_argument("--up", type=float, nargs=3, default=(0, 0, 1))
    parser.add_argument("--zoom", type=float, default=1.22)
    return parser.parse_args()


def read(path):
    """The surface with its guides."""
    reader = vtk.vtkPLYReader()
    reader.SetFileName(path)
    reader.Update()
    mesh = reader.GetOutput()
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    faces = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    centres = points[faces].mean(axis=1)
    low, high = centres.min(axis=0), centres.max(axis=0)
    axis = int(numpy.argmax(high - low))
    direction = numpy.zeros(3)
    direction[axis], direction[(axis + 1) % 3] = math.cos(math.pi / 6), math.sin(math.pi / 6)
    part = (centres[:, axis] - low[axis]) / (high[axis] - low[axis])
    guided = (part > 1 / 3) & (part < 2 / 3)
    for name, values in (("GuidingDirection", numpy.where(guided[:, None], direction, 0.0)),
                         ("GuidingWeight", numpy.full(len(faces), 0.3))):
        array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
        array.SetName(name)
        mesh.GetCellData().AddArray(array)
    return mesh


def succeed(algorithm):
    algorithm.Update()
    if algorithm.GetOutcome() != quadrille.vtkQuadRemesh.Succeeded:
        raise SystemExit("make-methods-picture: " + algorithm.GetOutcomeText())


def map_by(method, mesh, levels):
    """The surface with its map, and how many of the coarse triangles are not positive."""
    stage = quadrille.vtkIntegerGridMap()
    stage.SetInputConnection(levels.GetOutputPort(0))
    getattr(stage, "SetMethodTo" + method)()
    carry = quadrille.vtkIntegerGridMapUpmap()
    for algorithm in (stage, carry, stage.GetExecutive(), carry.GetExecutive()):
        algorithm.AddObserver("WarningEvent", lambda caller, event: None)  # the picture shows the folds
    carry.SetInputConnection(stage.GetOutputPort())
    carry.SetInputData(1, mesh)
    carry.SetInputConnection(2, levels.GetOutputPort(2))
    succeed(stage)
    succeed(carry)

    def inverted(data):
        return int((vtk_to_numpy(data.GetCellData().GetArray("Determinant")) <= 0).sum())

    counts = (inverted(stage.GetOutput()), stage.GetOutput().GetNumberOfPolys(), inverted(carry.GetOutput()),
              carry.GetOutput().GetNumberOfPolys())
    return carry.GetOutput(), counts


def isolines():
    """A texture with lines at whole coordinates."""
    size, line = 256, 13
    pixels = numpy.full((size, size, 3), (242, 226, 190), numpy.uint8)
    for edge in (slice(0, line), slice(size - line, size)):
        pixels[edge, :] = pixels[:, edge] = (40, 45, 60)
    image = vtk.vtkImageData()
    image.SetDimensions(size, size, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(pixels.reshape(-1, 3), deep=True))
    texture = vtk.vtkTexture()
    texture.SetInputData(image)
    texture.RepeatOn()
    texture.InterpolateOn()
    texture.MipmapOn()
    texture.SetMaximumAnisotropicFiltering(8)
    return texture


def actor_of(data, colour):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(colour)
    return actor


def surface(data):
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(data)
    normals.SetFeatureAngle(40)
    normals.SplittingOn()
    normals.ConsistencyOff()
    normals.Update()
    actor = actor_of(normals.GetOutput(), (1, 1, 1))
    actor.SetTexture(isolines())
    actor.GetProperty().SetAmbient(0.3)
    actor.GetProperty().SetDiffuse(0.75)
    return actor


def folds(data):
    cells = vtk.vtkThreshold()
    cells.SetInputData(data)
    cells.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, "Determinant")
    cells.SetThresholdFunction(vtk.vtkThreshold.THRESHOLD_LOWER)
    cells.SetLowerThreshold(0.0)
    skin = vtk.vtkGeometryFilter()
    skin.SetInputConnection(cells.GetOutputPort())
    skin.Update()
    actor = actor_of(skin.GetOutput(), (0.9, 0.1, 0.1))
    actor.GetProperty().SetAmbient(0.6)
    actor.GetProperty().SetDiffuse(0.4)
    actor.GetMapper().SetResolveCoincidentTopologyToPolygonOffset()
    actor.GetMapper().SetRelativeCoincidentTopologyPolygonOffsetParameters(-2, -2)
    return actor


def balls(data, sign, radius, colour):
    """One ball an irregular vertex, though the points of seams are there twice."""
    index = vtk_to_numpy(data.GetPointData().GetArray("Index"))
    points = vtk_to_numpy(data.GetPoints().GetData())[numpy.sign(index) == sign].astype(float)
    cloud = vtk.vtkPolyData()
    cloud.SetPoints(vtk.vtkPoints())
    if len(points):
        cloud.GetPoints().SetData(numpy_to_vtk(numpy.unique(points, axis=0), deep=True))
    sphere = vtk.vtkSphereSource()
    sphere.SetRadius(radius)
    glyph = vtk.vtkGlyph3D()
    glyph.SetSourceConnection(sphere.GetOutputPort())
    glyph.SetInputData(cloud)
    glyph.Update()
    return actor_of(glyph.GetOutput(), colour)


def label(text):
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    style = actor.GetTextProperty()
    style.SetFontSize(17)
    style.SetColor(0.1, 0.1, 0.12)
    style.SetJustificationToCentered()
    style.SetLineSpacing(1.15)
    actor.SetPosition(TILE[0] // 2, 12)
    return actor


def aim(renderer, args):
    camera = renderer.GetActiveCamera()
    view = numpy.array(args.view) / numpy.linalg.norm(args.view)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(*view)
    camera.SetViewUp(*args.up)
    camera.ParallelProjectionOn()
    renderer.ResetCamera()
    camera.Zoom(args.zoom)
    camera.SetWindowCenter(0, -0.14)  # room for the text
    renderer.ResetCameraClippingRange()


def main():
    args = arguments()
    mesh = read(args.surface)
    levels = quadrille.vtkDecimationHierarchy()
    levels.SetInputData(mesh)
    levels.SetTargetTypeToNumberOfQuads()
    levels.SetNumberOfQuads(args.quads)
    succeed(levels)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(len(METHODS) * TILE[0], TILE[1])
    for i, (name, method) in enumerate(METHODS):
        data, (coarse, coarse_all, fine, fine_all) = map_by(method, mesh, levels)
        length = math.sqrt(sum(surface_areas(mesh)) / args.quads)
        renderer = vtk.vtkRenderer()
        renderer.SetViewport(i / len(METHODS), 0, (i + 1) / len(METHODS), 1)
        renderer.SetBackground(1, 1, 1)
        renderer.AddActor(surface(data))
        renderer.AddActor(folds(data))
        renderer.AddActor(balls(data, 1, 0.2 * length, (0.12, 0.35, 0.85)))
        renderer.AddActor(balls(data, -1, 0.2 * length, (0.85, 0.13, 0.13)))
        renderer.AddViewProp(label(
            f"{name}\ninverted or degenerate: {coarse} of {coarse_all} coarse, {fine} of {fine_all}"))
        aim(renderer, args)
        window.AddRenderer(renderer)
        print(f"make-methods-picture: {name}: {coarse} of {coarse_all} and {fine} of {fine_all} inverted")
    window.Render()
    shot = vtk.vtkWindowToImageFilter()
    shot.SetInput(window)
    shot.ReadFrontBufferOff()
    shot.Update()
    # Thirty levels a channel are enough and make the file smaller.
    pixels = vtk_to_numpy(shot.GetOutput().GetPointData().GetScalars())
    pixels[:] = numpy.round(pixels / 8.5) * 8.5
    writer = vtk.vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetFileName(args.picture)
    writer.SetInputData(shot.GetOutput())
    writer.Write()
    print(f"make-methods-picture: {args.picture}")


def surface_areas(mesh):
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    corners = points[vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)]
    return numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2


if __name__ == "__main__":
    main()
