# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces from files."""
import os

from ._errors import InvalidInput


def _reader_for(extension):
    if extension == ".ply":
        from .QuadrilleFilters import vtkQuadrillePLYReader
        return vtkQuadrillePLYReader()
    if extension == ".stl":
        from vtkmodules.vtkIOGeometry import vtkSTLReader
        return vtkSTLReader()
    if extension == ".obj":
        from vtkmodules.vtkIOGeometry import vtkOBJReader
        return vtkOBJReader()
    if extension == ".vtp":
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
        return vtkXMLPolyDataReader()
    if extension == ".vtk":
        from vtkmodules.vtkIOLegacy import vtkPolyDataReader
        return vtkPolyDataReader()
    raise InvalidInput(f"files of the kind {extension or 'without extension'} are not read here; known are .ply, .obj, .stl, .vtp and .vtk")


def read(path):
    """The surface in a file as a vtkPolyData: .ply with all properties of its vertices and faces, .obj, .stl, .vtp or .vtk. Raises InvalidInput
    where the file is missing, damaged or of another kind."""
    path = os.fspath(path)
    reader = _reader_for(os.path.splitext(path)[1].lower())
    if not os.path.isfile(path):
        raise InvalidInput(f"{path}: there is no such file")
    messages = []

    def on_error(caller, event, text):
        messages.append(text.strip())
    on_error.CallDataType = "string0"
    for source in (reader, reader.GetExecutive()):
        source.AddObserver("ErrorEvent", on_error)
    reader.SetFileName(path)
    reader.Update()
    if messages:
        reason = reader.GetOutcomeText() if hasattr(reader, "GetOutcomeText") else messages[0].splitlines()[-1]
        raise InvalidInput(reason if path in reason else f"{path}: {reason}")
    return reader.GetOutput()
