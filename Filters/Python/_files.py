# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces from files."""
import os

from ._errors import InvalidInput


def _reader_for(extension):
    if extension == ".ply":
        from .QuadrilleFilters import vtkQuadrillePLYReader
        return vtkQuadrillePLYReader()
    if extension == ".off":
        from .QuadrilleFilters import vtkQuadrilleOFFReader
        return vtkQuadrilleOFFReader()
    if extension == ".stl":
        from vtkmodules.vtkIOGeometry import vtkSTLReader

        from .QuadrilleFilters import vtkQuadrilleUniquePoints
        reader = vtkSTLReader()
        reader.SetLocator(vtkQuadrilleUniquePoints())
        return reader
    if extension == ".obj":
        from vtkmodules.vtkIOGeometry import vtkOBJReader
        return vtkOBJReader()
    if extension == ".vtp":
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
        return vtkXMLPolyDataReader()
    if extension == ".vtk":
        from vtkmodules.vtkIOLegacy import vtkPolyDataReader
        return vtkPolyDataReader()
    raise InvalidInput(f"files of the kind {extension or 'without extension'} are not read here; known are .ply, .off, "
                       ".obj, .stl, .vtp and .vtk")


class _Silence:
    """VTK's readers report through parsers of their own: what they print is collected while this is entered."""

    def __enter__(self):
        from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow

        self._before = (vtkOutputWindow.GetInstance(), vtkLogger.GetCurrentVerbosityCutoff())
        self._window = vtkStringOutputWindow()
        vtkOutputWindow.SetInstance(self._window)
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
        return self

    def __exit__(self, *_):
        from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow

        vtkOutputWindow.SetInstance(self._before[0])
        vtkLogger.SetStderrVerbosity(self._before[1])

    def reason(self):
        """The last line of what was printed; empty where nothing was."""
        lines = [line for line in self._window.GetOutput().splitlines() if line.strip()]
        return lines[-1].split("): ", 1)[-1] if lines else ""


def read(path):
    """The surface in a file as a vtkPolyData: .ply and .off with all properties of their vertices and faces, .obj,
    .stl, .vtp or .vtk. Raises InvalidInput where the file is missing, damaged or of another kind."""
    path = os.fspath(path)
    reader = _reader_for(os.path.splitext(path)[1].lower())
    if not os.path.isfile(path):
        raise InvalidInput(f"{path}: there is no such file")
    from .QuadrilleFilters import vtkQuadrilleFileReader

    damage = vtkQuadrilleFileReader.GetHeaderError(path)
    if damage:
        raise InvalidInput(f"{path}: {damage}")
    with _Silence() as silence:
        reader.SetFileName(path)
        reader.Update()
    reason = reader.GetOutcomeText() if hasattr(reader, "GetOutcomeText") else silence.reason()
    if reason:
        raise InvalidInput(reason if path in reason else f"{path}: {reason}")
    return reader.GetOutput()
