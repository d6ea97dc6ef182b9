#!/usr/bin/env pvpython
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws meshes into one picture, with their edges, irregular vertices as dots (blue: fewer than four edges, red: more),
boundary vertices left out, and, if asked for, edges that are bent by more than 30 degrees as thick lines.

  xvfb-run -a pvpython Scripts/figures/contact-sheet.py OUT.png MESH.obj... [--columns N] [--tile PIXELS] [--sharp]
"""
import argparse
import math
import pathlib

import vtk
from vtk.util.numpy_support import vtk_to_numpy

SHARP_ANGLE = 30


def readMesh(path):
    reader = vtk.vtkOBJReader() if path.endswith(".obj") else vtk.vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def irregularPoints(mesh, below):
    """Inner points with fewer, or more, than four edges."""
    edges = {}
    connectivity = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray())
    offsets = vtk_to_numpy(mesh.GetPolys().GetOffsetsArray())
    for begin, end in zip(offsets[:-1], offsets[1:]):
        face = connectivity[begin:end].tolist()
        for a, b in zip(face, face[1:] + face[:1]):
            key = (min(a, b), max(a, b))
            edges[key] = edges.get(key, 0) + 1
    valence, border = {}, set()
    for key, count in edges.items():
        for point in key:
            valence[point] = valence.get(point, 0) + 1
        if count == 1:
            border.update(key)
    points = vtk.vtkPoints()
    for point, v in valence.items():
        if point not in border and (v < 4 if below else v > 4):
            points.InsertNextPoint(mesh.GetPoint(point))
    cloud = vtk.vtkPolyData()
    cloud.SetPoints(points)
    return cloud


def dots(mesh, below, radius):
    sphere = vtk.vtkSphereSource()
    sphere.SetRadius(radius)
    glyph = vtk.vtkGlyph3D()
    glyph.SetSourceConnection(sphere.GetOutputPort())
    glyph.SetInputData(irregularPoints(mesh, below))
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(glyph.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor((0.12, 0.35, 0.85) if below else (0.85, 0.13, 0.13))
    return actor


def surface(mesh):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(mesh)
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    looks = actor.GetProperty()
    looks.SetInterpolationToFlat()
    looks.SetColor(0.85, 0.87, 0.9)
    looks.EdgeVisibilityOn()
    looks.SetEdgeColor(0.2, 0.2, 0.25)
    return actor


def sharpEdges(mesh):
    edges = vtk.vtkFeatureEdges()
    edges.SetInputData(mesh)
    edges.SetFeatureAngle(SHARP_ANGLE)
    edges.ManifoldEdgesOff()
    edges.ColoringOff()
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(edges.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.75, 0.25, 0.0)
    actor.GetProperty().SetLineWidth(2.5)
    return actor


def renderer(path, viewport, drawsSharp):
    mesh = readMesh(path)
    view = vtk.vtkRenderer()
    view.SetBackground(1, 1, 1)
    view.SetViewport(*viewport)
    view.AddActor(surface(mesh))
    if drawsSharp:
        view.AddActor(sharpEdges(mesh))
    for below in (True, False):
        view.AddActor(dots(mesh, below, 0.004 * mesh.GetLength()))
    label = vtk.vtkTextActor()
    label.SetInput(f"{pathlib.Path(path).stem}: {mesh.GetNumberOfCells()}")
    label.GetTextProperty().SetColor(0, 0, 0)
    label.GetTextProperty().SetFontSize(18)
    label.SetPosition(8, 8)
    view.AddActor2D(label)
    camera = view.GetActiveCamera()
    camera.SetPosition(0.55, 0.45, 1)
    camera.SetViewUp(0, 1, 0)
    view.ResetCamera()
    camera.Zoom(1.05)
    view.ResetCameraClippingRange()
    return view


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out")
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--columns", type=int, default=4)
    parser.add_argument("--tile", type=int, default=620)
    parser.add_argument("--sharp", action="store_true")
    asked = parser.parse_args()
    columns = min(asked.columns, len(asked.meshes))
    rows = math.ceil(len(asked.meshes) / columns)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(asked.tile * columns, asked.tile * rows)
    for k, path in enumerate(asked.meshes):
        x, y = k % columns, rows - 1 - k // columns
        viewport = (x / columns, y / rows, (x + 1) / columns, (y + 1) / rows)
        window.AddRenderer(renderer(path, viewport, asked.sharp))
    for k in range(len(asked.meshes), rows * columns):
        blank = vtk.vtkRenderer()
        blank.SetBackground(1, 1, 1)
        x, y = k % columns, rows - 1 - k // columns
        blank.SetViewport(x / columns, y / rows, (x + 1) / columns, (y + 1) / rows)
        window.AddRenderer(blank)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(asked.out)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
