# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces from files, and quads to files."""
import os

from ._backend import backend
from ._errors import one_of, real
from ._inputs import surface_of_arrays


def read(path):
    """The surface in a file as a vtkPolyData: .ply and .off with all properties of their vertices and faces, .obj,
    .stl, .vtp or .vtk; of CAD files (.step, .stp, .iges, .igs, .brep) see read_cad(), with its defaults. Without VTK as
    a Mesh, and of .ply, .off, .obj and .stl. Raises InvalidInput where the file is missing, damaged or of another
    kind."""
    return backend.read(os.fspath(path))


#: Which edges of a CAD file become features, in the order of vtkQuadrilleCADReader's.
FOLLOW = ("sharp", "all", "none")


def read_cad(path, *, chord_error=0.0005, sharp_angle=5.0, follow="sharp", join_parts=True):
    """The faces of a CAD file (.step, .stp, .iges, .igs, .brep) as triangles that know them, in millimetres: a
    vtkPolyData with the cell arrays CadFaceId, PatchNames (names of the faces, of which write() makes sets) and
    FeatureEdges, and with the exact shape in the field data. remesh() takes it as it is.

    chord_error: by how much triangles may lie off the shape, over the diagonal of the part, 1e-6 to 0.1.
    sharp_angle: edges whose faces meet at a larger angle are sharp, degrees.
    follow: which edges become edges of the quads: "sharp", "all" (also where faces go on into each other), "none".
    join_parts: False: an assembly is a vtkMultiBlockDataSet with a block for each instance.

    Raises InvalidInput where the file is missing or damaged, and where this build has no Open CASCADE.
    """
    return backend.read_cad(
        os.fspath(path), chord_error=real("chord_error", chord_error, least=1e-6, most=0.1),
        sharp_angle=real("sharp_angle", sharp_angle, least=0.1, most=179),
        follow=one_of("follow", follow, FOLLOW),
        join_parts=bool(join_parts))


def on_cad_geometry(mesh):
    """Quads, or elements of second order, that were made on a surface of a CAD file, with their nodes on the exact
    surfaces, curves and vertices of the file. The point array CadPlace tells where each is (0: it stays, 1: face, 2:
    edge, 3: vertex), CadId of which face, edge or vertex. Raises InvalidInput where the mesh has no shape."""
    return backend.on_cad_geometry(mesh)


def sizes_by_name(mesh, sizes):
    """The surface with sizes of quads by names: with the point array Sizing, which remesh() and Session take as it is,
    and with short triangles beside what has a size.

    mesh: of read_cad(), or with the cell array PatchNames; also a vtkMultiBlockDataSet, in the wheel a dict, of such
        ones.
    sizes: a dict from names of faces, edges and vertices to factors of the target edge length, {"fillet*": 0.5}; *
        stands for any letters, ? for one. CAD edges and vertices without a name are EDGE_n and VERTEX_n, by their ids
        from 1, and take factors up to 1. Of several sizes of one name the last one counts; where faces, edges and
        vertices meet, the smallest.

    Raises InvalidInput where nothing has such a name, with near ones.
    """
    lines = [f"{name}={real(f'the size of {name!r}', factor, above=0)!r}" for name, factor in dict(sizes).items()]
    return backend.sizes_by_name(mesh, "\n".join(lines))


#: Whose input decks are written, and the versions of Gmsh's format, in the order of vtkQuadMeshWriter's.
DIALECTS = ("calculix", "abaqus")
MSH_VERSIONS = ("4.1", "2.2")


def write(mesh, path, *, patch_array=None, element=None, dialect="calculix", material="MATERIAL", msh_version="4.1",
          file_details=False, progress=None):
    """Writes quads to a file with their sets and returns a list of notices: what the user should know.

    mesh: a vtkPolyData of quads, a vtkUnstructuredGrid of quads of 4, 8 or 9 points, a Mesh, or a pair (points, faces),
        n by 3 and m by 4.
    path: its extension says the format: .inp (CalculiX, Abaqus), .msh (Gmsh), .mesh (MEDIT), .ex2, .e, .exo, .exodus
        (Exodus II), .vtu, .vtp, .obj, .ply, .stl; without VTK .inp, .msh, .mesh, .obj, .ply and .stl. The file is whole
        or not there.
    patch_array: the cell array, whole numbers or strings, whose values are the sets of elements; None: PatchId, else
        PatchNames, else LayoutPatch where it has at most 200 patches, whichever is there first. Names of patches:
        string array PatchNames of the cells, or in the field data, there with PatchNumbers.
    element: inp: the type of the elements, "S4", "S4R", "CPS4", "CPE8R", ...; None: S4, S8R or S9R5 by the nodes.
    dialect: inp: "calculix" or "abaqus".
    material: inp: the name of the material in sections, which are there where the mesh has the cell array Thickness or
        ElementAxis.
    msh_version: msh: "4.1" or "2.2".
    file_details: vtu, ply: also what many programs stop at: in vtu arrays of texts, as the names of patches and the
        notices of the run; in ply the patches of faces.
    progress: called as progress(fraction, text); a return value of False (not None) stops the writing, for which
        RemeshError is raised.

    Raises InvalidInput where the mesh or an argument is at fault, OSError where the file cannot be written.
    """
    return backend.write(
        backend.mesh_to_write(mesh) or surface_of_arrays(*mesh), os.fspath(path), patch_array=patch_array or "",
        element=element or "", dialect=one_of("dialect", dialect, DIALECTS), material=material,
        msh_version=one_of("msh_version", msh_version, MSH_VERSIONS), file_details=bool(file_details),
        progress=progress)
