#!/usr/bin/env pvpython
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws up to 12 meshes into one picture, with their edges, irregular vertices as dots (blue: fewer than four edges,
red: more), boundary vertices left out.

  xvfb-run -a pvpython Scripts/figures/contact-sheet.py OUT.png MESH.obj...
"""
import math
import pathlib
import sys

import vtk
from vtk.util.numpy_support import vtk_to_numpy

TILE = 620


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


def renderer(path, viewport):
    mesh = readMesh(path)
    view = vtk.vtkRenderer()
    view.SetBackground(1, 1, 1)
    view.SetViewport(*viewport)
    view.AddActor(surface(mesh))
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
    out, meshes = sys.argv[1], sys.argv[2:]
    columns = min(4, len(meshes))
    rows = math.ceil(len(meshes) / columns)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(TILE * columns, TILE * rows)
    for k, path in enumerate(meshes):
        x, y = k % columns, rows - 1 - k // columns
        window.AddRenderer(renderer(path, (x / columns, y / rows, (x + 1) / columns, (y + 1) / rows)))
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(out)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
