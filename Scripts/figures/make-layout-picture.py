#!/usr/bin/env pvpython
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Picture of the layout of quads: patches in colours, on features red lines between them, elsewhere black ones. On the
left the quads of the size asked for, on the right those of the coarsest layout.

  PYTHONPATH=build/lib/python3/dist-packages xvfb-run -a pvpython Scripts/figures/make-layout-picture.py
      [SURFACE.ply] [OUT.png] [--quads N] [--view X Y Z] [--up X Y Z] [--zoom Z]
"""
import argparse

import numpy
import quadrille
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

TILE = (720, 600)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("surface", nargs="?", default="Data/part.ply")
    parser.add_argument("picture", nargs="?", default="Documentation/Pictures/layout.png")
    parser.add_argument("--quads", type=int, default=3000)
    parser.add_argument("--view", type=float, nargs=3, default=(0.6, -1, 0.8))
    parser.add_argument("--up", type=float, nargs=3, default=(0, 0, 1))
    parser.add_argument("--zoom", type=float, default=1.15)
    return parser.parse_args()


def coloured(data, colours):
    """An actor with a colour (0 to 255) a cell."""
    array = numpy_to_vtk(numpy.ascontiguousarray(colours, dtype=numpy.uint8), deep=True)
    array.SetName("Colours")
    data.GetCellData().SetScalars(array)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetScalarModeToUseCellData()
    mapper.SetColorModeToDirectScalars()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetAmbient(0.35)
    actor.GetProperty().SetDiffuse(0.7)
    return actor


def patches(quads):
    patch = vtk_to_numpy(quads.GetCellData().GetArray("LayoutPatch"))
    palette = numpy.random.default_rng(3).uniform(100, 245, (patch.max() + 1, 3))
    actor = coloured(quads, palette[patch])
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(0.5, 0.5, 0.5)
    actor.GetProperty().SetInterpolationToFlat()
    return actor


def lines(separatrices, radius):
    tube = vtk.vtkTubeFilter()
    tube.SetInputData(separatrices)
    tube.SetRadius(radius)
    tube.SetNumberOfSides(8)
    tube.Update()
    tubes = tube.GetOutput()
    on_feature = vtk_to_numpy(tubes.GetCellData().GetArray("Feature"))
    return coloured(tubes, numpy.where(on_feature[:, None] == 1, (200, 25, 25), (25, 25, 25)))


def renderer(mesh, integers, column, args):
    result = quadrille.remesh(mesh, quads=args.quads, integers=integers, everything=True)
    view = vtk.vtkRenderer()
    view.SetBackground(1, 1, 1)
    view.SetViewport(column / 2, 0, (column + 1) / 2, 1)
    view.AddActor(patches(result.quads))
    view.AddActor(lines(result.separatrices, 0.0018 * result.quads.GetLength()))
    count = result.quads.GetFieldData().GetArray("LayoutPatchShape").GetNumberOfTuples()
    label = vtk.vtkTextActor()
    label.SetInput(f"{integers}: {result.quads.GetNumberOfCells()} quads, {count} patches")
    label.GetTextProperty().SetColor(0, 0, 0)
    label.GetTextProperty().SetFontSize(20)
    label.SetPosition(10, 8)
    view.AddActor2D(label)
    camera = view.GetActiveCamera()
    camera.SetPosition(*args.view)
    camera.SetViewUp(*args.up)
    view.ResetCamera()
    camera.Zoom(args.zoom)
    view.ResetCameraClippingRange()
    return view


def main():
    args = arguments()
    reader = vtk.vtkPLYReader()
    reader.SetFileName(args.surface)
    reader.Update()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(2 * TILE[0], TILE[1])
    for column, integers in enumerate(quadrille.INTEGERS):
        window.AddRenderer(renderer(reader.GetOutput(), integers, column, args))
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(args.picture)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
