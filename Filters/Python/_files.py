# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces from files, and quads to files."""
import os

from ._errors import InvalidInput, RemeshError, one_of
from ._inputs import to_polydata


def _reader_for(path):
    extension = os.path.splitext(path)[1].lower()
    if extension == ".ply":
        from .QuadrilleFilters import vtkQuadrillePLYReader
        return vtkQuadrillePLYReader()
    if extension == ".off":
        from .QuadrilleFilters import vtkQuadrilleOFFReader
        return vtkQuadrilleOFFReader()
    if extension == ".stl":
        from vtkmodules.vtkIOGeometry import vtkSTLReader

        from .QuadrilleFilters import vtkQuadrilleSTLReader, vtkQuadrilleUniquePoints
        if vtkQuadrilleSTLReader.CanReadFile(path):
            return vtkQuadrilleSTLReader()
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
    reader = _reader_for(path)
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


#: Whose input decks are written, and the versions of Gmsh's format, in the order of vtkQuadMeshWriter's.
DIALECTS = ("calculix", "abaqus")
MSH_VERSIONS = ("4.1", "2.2")


def write(mesh, path, *, patch_array=None, element=None, dialect="calculix", material="MATERIAL", msh_version="4.1",
          progress=None):
    """Writes quads to a file with their sets and returns a list of notices: what the user should know.

    mesh: a vtkPolyData of quads, a vtkUnstructuredGrid of quads of 4, 8 or 9 points, or a pair (points, faces), n by 3
        and m by 4.
    path: its extension says the format: .inp (CalculiX, Abaqus), .msh (Gmsh), .mesh (MEDIT), .ex2, .e, .exo (Exodus
        II), .vtu, .vtp, .obj, .ply, .stl. The file is whole or not there.
    patch_array: the cell array, whole numbers or strings, whose values are the sets of elements; None: PatchId, else
        PatchNames, else LayoutPatch where it has at most 200 patches, whichever is there first. Names of patches:
        string array PatchNames of the cells, or in the field data, there with PatchNumbers.
    element: inp: the type of the elements, "S4", "S4R", "CPS4", "CPE8R", ...; None: S4, S8R or S9R5 by the nodes.
    dialect: inp: "calculix" or "abaqus".
    material: inp: the name of the material in sections, which are there where the mesh has the cell array Thickness or
        ElementAxis.
    msh_version: msh: "4.1" or "2.2".
    progress: called as progress(fraction, text); a return value of False (not None) stops the writing, for which
        RemeshError is raised.

    Raises InvalidInput where the mesh or an argument is at fault, OSError where the file cannot be written.
    """
    from .QuadrilleFilters import vtkQuadMeshWriter

    writer = vtkQuadMeshWriter()
    path = os.fspath(path)
    if not writer.CanWriteFile(path):
        raise InvalidInput(f"{path}: unknown extension; known are {writer.GetExtensions()}")
    writer.SetFileName(path)
    writer.SetPatchArrayName(patch_array or "")
    writer.SetElementType(element or "")
    writer.SetDialect(one_of("dialect", dialect, DIALECTS))
    writer.SetMaterial(material)
    writer.SetMshVersion(one_of("msh_version", msh_version, MSH_VERSIONS))
    writer.SetInputDataObject(mesh if hasattr(mesh, "GetCellData") else to_polydata(*mesh))

    def on_progress(caller, _):
        if progress(caller.GetProgress(), caller.GetProgressText() or "") is False:
            caller.SetAbortExecute(1)

    if progress is not None:
        writer.AddObserver("ProgressEvent", on_progress)
    for source in (writer, writer.GetExecutive()):
        source.AddObserver("ErrorEvent", lambda caller, event: None)
    writer.Write()
    if writer.GetOutcome() != writer.Succeeded:
        kind = {writer.BadInput: InvalidInput, writer.CannotWrite: OSError}.get(writer.GetOutcome(), RemeshError)
        raise kind(writer.GetOutcomeText())
    return writer.GetNoticesText().splitlines()
