# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Quads by the module over Core, without VTK; see _backend.py. Surfaces are Meshes. Data of VTK are taken where Python
has VTK, and then the results are data of VTK as well."""
import json
import math
import os
import sys

import numpy

from . import _native
from ._arrays import is_far
from ._errors import InvalidInput, RemeshError
from ._mesh import CAD_BYTES, CAD_PLACES, Mesh, carried
from ._options import NAMES

#: Without VTK there are none of its classes.
CLASSES = ()

#: Where what is missing here can be had.
_ELSEWHERE = ("the wheel of quadrille-mesh has no classes of VTK; Quadrille's packages for Debian (quadrille, "
              "paraview-quadrille) and its own build have them")


def missing(what):
    """The error for what only VTK's classes can do."""
    return RemeshError(f"there is no {what} here: {_ELSEWHERE}")


# --- surfaces ---------------------------------------------------------------------------------------------------------

class _FromVtk(Mesh):
    """A surface that came as data of VTK."""


def _has_vtk_data(mesh):
    return "vtkmodules.vtkCommonCore" in sys.modules and hasattr(mesh, "GetClassName")


def surface_of(mesh):
    if isinstance(mesh, Mesh):
        return mesh
    if not _has_vtk_data(mesh):
        return None
    from ._vtk_data import as_polydata, mesh_of

    polydata = as_polydata(mesh)
    if polydata is None:
        return None
    found = mesh_of(polydata)
    found.__class__ = _FromVtk
    return found


def surface_from(points, counts, corners):
    return Mesh.from_cells(points, numpy.concatenate(([0], numpy.cumsum(counts))).astype(numpy.int64), corners)


def polydata_of(surface):
    return surface.to_vtk()


def is_polydata(mesh):
    return _has_vtk_data(mesh) and mesh.IsA("vtkPolyData")


def point_count(surface):
    return len(surface.points)


def face_count(surface):
    return len(surface.offsets) - 1


def points_of(surface):
    return surface.points


def polygons_of(surface):
    return surface.offsets, surface.corners


def has_polygons_only(surface):
    return True


def has_cell_array(surface, name):
    return name in surface.cell_data


def with_arrays(surface, point_data, cell_data):
    result = surface.with_arrays(point_data, cell_data)
    result.__class__ = surface.__class__
    return result


def lines_from(lines):
    return lines


def lines_of(polydata):
    """Those of a vtkPolyData: its lines, and vertices that clear features or ask for sizes. Lines without an array of
    radii have none."""
    from ._inputs import Line
    from ._vtk_data import arrays_of_cells, mesh_of

    mesh = mesh_of(polydata)
    array = polydata.GetCellData().GetArray
    kinds, radii, factors = array("ConstraintType"), array("GuidingRadius"), array("SizeFactor")
    first = polydata.GetNumberOfVerts()

    def value(values, cell, otherwise):
        return values.GetComponent(cell, 0) if values else otherwise

    lines = []
    offsets, ids = arrays_of_cells(polydata.GetLines())
    for i in range(len(offsets) - 1):
        kind = int(value(kinds, first + i, 0))
        if kind not in (0, 1, 2, 3):
            raise InvalidInput(f"curve {i} has ConstraintType {kind}, but only 0 (feature curve), 1 (guiding stroke), "
                               "2 (connection) and 3 (cycle) can be asked for here: correct the array")
        lines.append(Line(kind, mesh.points[ids[offsets[i]:offsets[i + 1]]], value(radii, first + i, None)))
    offsets, ids = arrays_of_cells(polydata.GetVerts())
    for i in range(first):
        kind = int(value(kinds, i, 0))
        if kind == 7 and not factors:
            raise InvalidInput(f"vertex {i} asks for a size, but the cells have no array SizeFactor: add it")
        if kind in (6, 7):
            lines += [Line(kind, mesh.points[[k]], value(radii, i, 0.0), value(factors, i, 1.0))
                      for k in ids[offsets[i]:offsets[i + 1]]]
    return lines


def arrays_of(quads):
    if isinstance(quads, Mesh):
        return quads.points.copy(), quads.faces.copy()
    mesh = _polygons_of_vtk(quads)
    return mesh.points, mesh.faces


def fields_of(quads):
    if isinstance(quads, Mesh):
        return {name: list(values) for name, values in quads.field_data.items() if name not in CAD_BYTES}
    from ._vtk_data import fields_of as of_vtk

    return of_vtk(quads)


def _polygons_of_vtk(data):
    if not _has_vtk_data(data):
        raise InvalidInput(f"this must be a Mesh or a vtkPolyData, not {type(data).__name__}")
    from ._vtk_data import mesh_of

    return mesh_of(data)


# --- runs -------------------------------------------------------------------------------------------------------------

#: Options that the settings of Core have under the same name and in the same unit.
_SETTINGS = ("quads", "edge_length", "relative_edge_length", "feature_criterion", "chord_error", "gap_quads",
             "smallest_size", "largest_size", "method", "integers", "small_details", "small_components",
             "final_quality", "coarse_vertices", "smallest_detail", "anisotropy_limit", "distortion_metric",
             "maximum_number_of_quads", "smoothing_steps", "threads")


def _settings_text(options):
    settings = {name: options[name] for name in _SETTINGS if name in options}
    for name in ("feature_angle", "angle_a_quad"):
        settings[name] = None if options[name] is None else options[name] * math.pi / 180
    settings["memory_limit"] = 1e6 * options["memory_limit"] if options["memory_limit"] > 0 else None
    settings["curvature_guides"] = options["guide_anisotropy"] if options["guide"] == "curvature" else None
    return json.dumps(settings)


def _how(options):
    how = {name: options[name] for name in ("preview", "everything", "time_limit")}
    if options["symmetry"] is not None:
        how["symmetry"] = True
        how["plane_curve"] = NAMES["plane_curve"].index(options["plane_curve"])
        if options["symmetry"] != "found":
            how["symmetry_plane"] = numpy.array(options["symmetry"], dtype=float)
    if options["rotation"] is not None:
        order, axis = options["rotation"]
        how["rotation_order"] = order
        if axis is not None:
            how["rotation_axis"] = numpy.array(axis, dtype=float)
    return how


def _column(name, values, dtype, components=1):
    """An array that asks for something, as the module takes it."""
    values = numpy.asarray(values)
    wanted = 1 if values.ndim == 1 else values.shape[1]
    if values.dtype.kind not in "iufb" or values.ndim > 2 or wanted != components:
        raise InvalidInput(f"array '{name}' must have {components} number(s) a cell or point")
    if dtype != numpy.float64 and values.dtype.kind == "f" and not (values == numpy.floor(values)).all():
        raise InvalidInput(f"array '{name}' must hold whole numbers")
    return numpy.ascontiguousarray(values.reshape(-1) if components == 1 else values, dtype=dtype)


def _surface_dict(surface, patch_array, guide):
    result = {"points": surface.points, "offsets": surface.offsets, "corners": surface.corners}
    cells, points = surface.cell_data, surface.point_data
    if "FeatureEdges" in cells:
        result["feature_edges"] = _column("FeatureEdges", cells["FeatureEdges"], numpy.uint8)
    if patch_array in cells:
        result["patch_ids"] = _column(patch_array, cells[patch_array], numpy.int64)
    elif patch_array not in ("", "PatchId", "(none)"):
        raise InvalidInput(f"there is no cell array named '{patch_array}' with patch ids")
    if "GuidingDirection" in cells:
        result["guiding_direction"] = _column("GuidingDirection", cells["GuidingDirection"], numpy.float64, 3)
        if "GuidingWeight" in cells:
            result["guiding_weight"] = _column("GuidingWeight", cells["GuidingWeight"], numpy.float64)
    if "TargetValence" in points:
        result["target_valence"] = _column("TargetValence", points["TargetValence"], numpy.int32)
    if "Sizing" in points:
        result["sizing"] = _column("Sizing", points["Sizing"], numpy.float64)
    if "KnownCurvature" in cells:
        result["known_curvature"] = _column("KnownCurvature", cells["KnownCurvature"], numpy.float64, 6)
    if "CadShape" in surface.field_data:
        result["designed"] = True
    if guide and guide != "curvature":
        if guide not in cells:
            raise InvalidInput(f"there is no cell array '{guide}' to guide by; of points, and of whole surfaces, "
                               f"arrays guide with VTK's classes only: {_ELSEWHERE}; guiding_direction takes an array")
        result.setdefault("guiding_direction", _column(guide, cells[guide], numpy.float64, 3))
    return result


def _as_given(surface, mesh):
    """In the form that the surface came in."""
    return mesh.to_vtk() if isinstance(surface, _FromVtk) else mesh


def _quads_mesh(surface, made):
    point_data, cell_data = made["point_data"], made["cell_data"]
    if "point_source" in made:
        polygons, points, weights = made["point_source"]
        from_points, from_cells = carried(surface, points, weights, made["quad_source"])
        from_cells.pop("KnownCurvature", None)  # of the triangles
        own = {"SourceCellId": polygons, "SourcePointIds": points, "SourceBarycentric": weights}
        point_data = {**from_points, **own, **point_data}
        cell_data = {**from_cells, "SourceCellId": made["quad_source"], **cell_data}
    corners = made["quads"].reshape(-1)
    return Mesh.from_cells(made["points"], 4 * numpy.arange(len(made["quads"]) + 1), corners, point_data=point_data,
                           cell_data=cell_data, field_data={**surface.field_data, **made["fields"]})


def _cells_mesh(made):
    return Mesh.from_cells(made["points"], made["offsets"], made["corners"], point_data=made["point_data"],
                           cell_data=made["cell_data"])


def remesh(surface, options, lines, *, wrap, requests, spread, progress):
    if wrap is not None:
        raise missing("wrap, which needs CGAL")
    if spread:
        raise missing("spread, which needs MPI and VTK's controller")
    if options["cell_data"] != "centre":
        raise missing("cell_data='area'")
    if "CadShape" in surface.field_data:  # whose features are known
        options = {**options, "feature_angle": None}
    lines = [line if line.radius is not None else line._replace(radius=options["stroke_radius"])
             for line in lines or []]
    made = _native.remesh(_surface_dict(surface, options["patch_array"], options["guide"]), _settings_text(options),
                          _how(options), lines, progress)
    quads = _as_given(surface, _quads_mesh(surface, made))
    if not options["everything"]:
        return quads
    others = [_as_given(surface, _cells_mesh(made[name])) if name in made else None
              for name in ("surface", "lines", "separatrices")]
    told = {"constraints": made["constraints"], "details": made["details"]}
    return quads, others[0], others[1], told, others[2]


# --- sessions ---------------------------------------------------------------------------------------------------------

class _Session(_native.Session):
    """The module's session, which takes a Mesh as its surface."""

    def Start(self, surface, settings):
        return super().Start(_surface_dict(surface, "PatchId", None), settings)

    def Load(self, file, surface):
        return super().Load(file, _surface_dict(surface, "PatchId", None))


def session(progress):
    return _Session(progress)


def session_states(session):
    return session.GetStateNames()


def session_error(session):
    """The module raises what is wrong."""
    return "", False


def preview_arrays(session):
    return session.GetPreviewQuads()


def session_mesh(session, surface):
    points, quads, point_data = session.GetQuads()
    mesh = Mesh.from_cells(points, 4 * numpy.arange(len(quads) + 1), quads.reshape(-1), point_data=point_data)
    return _as_given(surface, mesh)


def session_arrays(mesh):
    return arrays_of(mesh)


def session_point_array(mesh, name):
    if not isinstance(mesh, Mesh):
        mesh = _polygons_of_vtk(mesh)
    values = mesh.point_data.get(name)
    return None if values is None else values.copy()


def session_irregular(session):
    return session.GetIrregularVertices()


# --- files ------------------------------------------------------------------------------------------------------------

_READ = (".ply", ".off", ".obj", ".stl")
_WRITTEN = (".inp", ".msh", ".mesh", ".obj", ".ply", ".stl")
#: Sets of elements of more patches of the layout than this nobody works with, see Filters/ElementGrids/Elements.h.
_MOST_LAYOUT_PATCHES = 200


def _cells_or_none(cells):
    return (numpy.zeros(1, numpy.int64), numpy.zeros(0, numpy.int64)) if cells is None else tuple(
        array.astype(numpy.int64) for array in cells)


def _triangles_of_strips(offsets, ids):
    """Triangle i of a strip is (i, i + 1, i + 2), every second one turned round."""
    triangles = []
    for begin, end in zip(offsets[:-1], offsets[1:]):
        strip = ids[begin:end]
        for i in range(len(strip) - 2):
            odd = i & 1
            triangles.append((strip[i], strip[i + 1 + odd], strip[i + 2 - odd]))
    return numpy.array(triangles, numpy.int64).reshape(-1, 3)


_CAD = (".step", ".stp", ".iges", ".igs", ".brep", ".brp")


def has_cad():
    return hasattr(_native, "read_cad")


def _part_mesh(part, unit):
    triangles, face = part["triangles"], part["face"]
    names = numpy.array(part["names"], dtype=object)
    cell_data = {"CadFaceId": face, "PatchNames": names[face], "FeatureEdges": part["feature_edges"],
                 "KnownCurvature": part["known_curvature"], "CadColour": part["colours"][face]}
    fields = {"CadShape": part["shape"], "CadTessellation": part["tessellation"], "CadFaceNames": part["names"],
              "CadSurfaceKinds": part["kinds"], "CadUnitOfFile": [unit], **{name: part[name] for name in CAD_PLACES},
              "CadEdgeNames": part["CadEdgeNames"], "CadVertexNames": part["CadVertexNames"]}
    return Mesh.from_cells(part["points"], 3 * numpy.arange(len(triangles) + 1), triangles.reshape(-1),
                           cell_data=cell_data, field_data=fields)


def read_cad(path, *, chord_error, sharp_angle, follow, join_parts):
    if not has_cad():
        raise InvalidInput(f"{path}: CAD files are not read here: {_ELSEWHERE}. Or have your CAD program write STL or "
                           "PLY")
    parts, unit, _ = _native.read_cad(path, chord_error, sharp_angle * math.pi / 180, follow, join_parts)
    if len(parts) == 1:
        return _part_mesh(parts[0], unit)
    return {part["name"]: _part_mesh(part, unit) for part in parts}


def _named_dict(surface):
    """What has names on a surface, as the module takes it."""
    if len(surface.corners) != 3 * (len(surface.offsets) - 1) or (numpy.diff(surface.offsets) != 3).any():
        raise InvalidInput("sizes by name are for surfaces of triangles: triangulate this one first")
    cells, fields = surface.cell_data, surface.field_data
    result = {"points": surface.points, "triangles": surface.corners}
    if "PatchNames" in cells:
        result["face_names"] = [str(name) for name in cells["PatchNames"]]
    if "Sizing" in surface.point_data:
        result["sizing"] = _column("Sizing", surface.point_data["Sizing"], numpy.float32)
    if "FeatureEdges" in cells:
        result["feature_edges"] = _column("FeatureEdges", cells["FeatureEdges"], numpy.uint8)
    if "KnownCurvature" in cells:
        result["known_curvature"] = _column("KnownCurvature", cells["KnownCurvature"], numpy.float32, 6)
    if all(name in fields for name in (*CAD_PLACES, "CadEdgeNames", "CadVertexNames")):
        result.update(edge_names=list(fields["CadEdgeNames"]), edge_points=fields["CadEdgePoints"],
                      edge_counts=fields["CadEdgeCounts"], vertex_names=list(fields["CadVertexNames"]),
                      vertex_points=fields["CadVertexPoints"])
    return result


def _at_middles(name, values, middles):
    """A point array with the points in the middle of two others. Real numbers are their average, all else is that of
    one of them; nobody asks for a valence there."""
    count = len(values)
    result = numpy.concatenate((values, values[numpy.zeros(len(middles), numpy.int64)]))
    for i, (a, b) in enumerate(middles, count):  # the two may be middles themselves
        result[i] = (result[a] + result[b]) / 2 if values.dtype.kind == "f" else result[a]
    if name == "TargetValence":
        result[count:] = 0
    return result


def _sized_mesh(surface, made):
    parents, triangles = made["parents"], made["triangles"]
    point_data = {name: _at_middles(name, values, made["middles"]) for name, values in surface.point_data.items()}
    cell_data = {name: values[parents] for name, values in surface.cell_data.items()}
    for array, name in (("FeatureEdges", "feature_edges"), ("KnownCurvature", "known_curvature")):
        if name in made:
            cell_data[array] = made[name]
    return Mesh.from_cells(made["points"], 3 * numpy.arange(len(triangles) + 1), triangles.reshape(-1),
                           point_data={**point_data, "Sizing": made["sizing"]}, cell_data=cell_data,
                           field_data=surface.field_data)


def sizes_by_name(mesh, text):
    blocks = mesh if isinstance(mesh, dict) else {"": mesh}
    surfaces = {name: surface_of(block) for name, block in blocks.items()}
    if any(surface is None for surface in surfaces.values()):
        raise InvalidInput("take a Mesh of read_cad(), or one with the cell array PatchNames")
    prefixes = [f"{name}/" if name else "" for name in surfaces]
    made = _native.sizes_by_name([_named_dict(surface) for surface in surfaces.values()], prefixes, text)
    sized = {name: _as_given(surfaces[name], _sized_mesh(surfaces[name], own)) for name, own in zip(surfaces, made)}
    return sized if isinstance(mesh, dict) else sized[""]


def on_cad_geometry(mesh):
    if not has_cad():
        raise InvalidInput(f"there is no exact geometry here: {_ELSEWHERE}")
    fields = mesh.field_data if isinstance(mesh, Mesh) else {}
    if "CadShape" not in fields or mesh.faces.ndim != 2 or mesh.faces.shape[1] != 4:
        raise InvalidInput("take quads that were made on a Mesh of read_cad()")
    points, place, ids, normals, curvatures = _native.place_on_cad(
        fields["CadShape"], fields["CadTessellation"], mesh.points, mesh.faces,
        mesh.cell_data.get("CadFaceId", ()))
    arrays = {"CadPlace": place, "CadId": ids, "CadNormal": normals, "CadCurvature": curvatures}
    counts = {"NodesOnGeometry": [int((place > 0).sum())], "NodesOffGeometry": [int((place == 0).sum())]}
    return Mesh.from_cells(points, mesh.offsets, mesh.corners, point_data={**mesh.point_data, **arrays},
                           cell_data=mesh.cell_data, field_data={**fields, **counts})


def read(path):
    if os.path.splitext(path)[1].lower() in _CAD:
        return read_cad(path, chord_error=0.0005, sharp_angle=5.0, follow=0, join_parts=True)
    extension = os.path.splitext(path)[1].lower()
    if extension not in _READ:
        raise InvalidInput(f"files of the kind {extension or 'without extension'} are not read here; known are "
                           f".ply, .off, .obj and .stl. For .vtp and .vtk: {_ELSEWHERE}")
    if not os.path.isfile(path):
        raise InvalidInput(f"{path}: there is no such file")
    points, polygons, strips, point_data, cell_data = _native.read(path)
    offsets, corners = _cells_or_none(polygons)
    if strips is not None:
        triangles = _triangles_of_strips(*_cells_or_none(strips))
        cell_data = {}  # which strips have none of
        offsets = numpy.concatenate((offsets, offsets[-1] + 3 * numpy.arange(1, len(triangles) + 1)))
        corners = numpy.concatenate((corners, triangles.reshape(-1)))
    return Mesh.from_cells(points.astype(numpy.float64), offsets, corners, point_data=point_data, cell_data=cell_data)


def mesh_to_write(mesh):
    return surface_of(mesh) if isinstance(mesh, Mesh) or _has_vtk_data(mesh) else None


def _patch_values(mesh, patch_array):
    """The array of patches, and whether it is the user's, and not that of the layout; or None."""
    if patch_array:
        if patch_array not in mesh.cell_data:
            raise InvalidInput(f"the mesh has no cell array '{patch_array}' to make sets of")
        return mesh.cell_data[patch_array], patch_array != "LayoutPatch"
    for name, is_text in (("PatchId", False), ("PatchNames", True), ("LayoutPatch", False)):
        values = mesh.cell_data.get(name)
        if values is not None and values.ndim == 1 and (values.dtype.kind in "OUS") == is_text:
            if name == "LayoutPatch" and values.size and values.max() >= _MOST_LAYOUT_PATCHES:
                return None, False
            return values, name != "LayoutPatch"
    return None, False


def _patches(mesh, patch_array, faces):
    """Pairs of a number and a name, in the order of their first elements; the patch of each element; is it asked."""
    values, is_asked = _patch_values(mesh, patch_array)
    if values is None:
        return [(1, "")], numpy.zeros(faces, numpy.int64), False
    if values.ndim != 1:
        raise InvalidInput(f"the cell array '{patch_array}' has {values.shape[1]} values a cell, but the number of a "
                           "patch, or its name, is one")
    is_text = values.dtype.kind in "OUS"
    found, first, patch_of = numpy.unique(values.astype(str) if is_text else values, return_index=True,
                                          return_inverse=True)
    order = numpy.argsort(first, kind="stable")
    place = numpy.empty(len(order), numpy.int64)
    place[order] = numpy.arange(len(order))
    names = [str(value) if is_text else "" for value in found[order]]
    numbers = [i + 1 if is_text else int(value) for i, value in enumerate(found[order])]
    if not is_text and is_asked:
        names = _names_by_numbers(mesh.field_data, numbers)
    return list(zip(numbers, names)), place[patch_of.reshape(-1)], is_asked


def _names_by_numbers(fields, numbers):
    names = [str(name) for name in fields.get("PatchNames", [])]
    if not names:
        return [""] * len(numbers)
    first = 1 if min(numbers) >= 1 and max(numbers) == len(names) else 0
    of = fields.get("PatchNumbers", range(first, first + len(names)))
    if len(of) != len(names):
        raise InvalidInput(f"the field data have {len(names)} PatchNames and {len(of)} PatchNumbers: give as many")
    known = {int(number): name for number, name in zip(of, names)}
    return [known.get(number, "") for number in numbers]


def write(mesh, path, *, patch_array, element, dialect, material, msh_version, file_details, progress):
    extension = os.path.splitext(path)[1].lower()
    if extension not in _WRITTEN:
        raise InvalidInput(f"{path}: files of this kind are not written here; known are .inp, .msh, .mesh, .obj, .ply "
                           f"and .stl. For .vtp, .vtu and Exodus II: {_ELSEWHERE}")
    faces = mesh.faces
    if not isinstance(faces, numpy.ndarray) or faces.ndim != 2 or faces.shape[1] != 4:
        raise InvalidInput(f"{path}: only quads are written here; elements of second order come from {_ELSEWHERE}")
    patches, patch_of, is_asked = _patches(mesh, patch_array, len(faces))
    elements = {"points": mesh.points, "elements": faces, "patches": patches, "patch_of": patch_of}
    for name, array, dtype, components in (("feature_edges", "FeatureEdges", numpy.uint8, 1),
                                           ("thickness", "Thickness", numpy.float64, 1),
                                           ("axis", "ElementAxis", numpy.float64, 3)):
        if array in mesh.cell_data:
            elements[name] = _column(array, mesh.cell_data[array], dtype, components)
    how = {"element": element, "dialect": dialect, "material": material, "msh_version": msh_version,
           "with_patches": is_asked, "patch_property": (patch_array or "PatchId") if is_asked and file_details else "",
           "in_double": is_far(mesh.points)}
    return _native.write(path, elements, how, progress)
