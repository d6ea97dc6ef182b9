# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What makes the quads: VTK's classes where this package was built for a VTK, or the module over Core alone, which the
wheel brings. Both have the same functions; all else of the package is common to them.

    surface_of(mesh)       the surface of data that need no arrays of Python, else None
    surface_from(points, counts, corners), polydata_of(surface), is_polydata(mesh)
    point_count, face_count, points_of, polygons_of (offsets and corners), has_polygons_only, has_cell_array
    with_arrays(surface, point_data, cell_data)     a copy with further arrays; the surface stays as it is
    lines_from(list of Line), lines_of(polydata)    curves, strokes, connections, cycles, cleared features, sizes
    arrays_of(mesh), fields_of(mesh)    points and faces; field data as a dict of lists
    remesh(surface, options, lines, wrap, requests, progress)
    read(path), write(mesh, path, options, progress)
    session(progress), and of its results session_arrays, session_irregular, session_mesh
"""
from importlib.util import find_spec

if find_spec(__package__ + "._native"):
    from . import _backend_native as backend
else:
    from . import _backend_vtk as backend

__all__ = ["backend"]
