# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Pure quad remeshing of triangle surfaces, in pvpython, in the system's python3, and by pip without VTK.

    import quadrille
    quads = quadrille.remesh(quadrille.read("part.ply"))        # vtkPolyData in, vtkPolyData out
    quads = quadrille.remesh((points, faces), edge_length=0.5)  # arrays or lists in
    points, faces = quadrille.to_arrays(quads)
    quadrille.write(quads, "part.inp")                          # with sets for CalculiX, Gmsh, Exodus II, ...

    surface, findings = quadrille.repair(mesh)                  # damaged surfaces; both need a build with CGAL
    surface = quadrille.wrap(mesh, alpha=0.1)

    part = quadrille.read_cad("part.step")                      # where the build has Open CASCADE
    quads = quadrille.on_cad_geometry(quadrille.remesh(part))   # nodes on the exact surfaces, curves and vertices

    elements = quadrille.elements(quads, surface, order=2)      # vtkUnstructuredGrid of second order, for simulation

    session = quadrille.Session(mesh, quads=5000)               # change one thing, and see what it does
    session.set_valence(point, 5)
    session.update()

    quadrille.check(QuadRemesh(Input=surface))                  # in a script of ParaView: raises where it fails

Where this package was built for a VTK, meshes are data of VTK. The wheel quadrille-mesh needs NumPy alone: there a
mesh is a Mesh of arrays, which is the pair (points, faces) as well; data of VTK that go in come out as such.
repair(), wrap(), elements(), check(), spread=True and what follows are not in the wheel; read_cad() and
on_cad_geometry() are in one that was made with Open CASCADE.

The VTK classes themselves are here too: vtkQuadRemesh, vtkDecimationHierarchy, vtkIntegerGridMap,
vtkIntegerGridMapUpmap, vtkQuadExtraction, vtkQuadElements, vtkIntegerGridMapQuality, vtkIntegerGridMapComparison,
vtkQuadrilleSession, the source vtkQuadConstraintSource, the readers vtkQuadrilleOFFReader, vtkQuadrillePLYReader and
vtkQuadrilleSTLReader, the writer vtkQuadMeshWriter, and in QuadrilleFilters, where there is CGAL, vtkSurfaceRepair,
vtkSurfaceWrap and vtkQuadProjection, and where there is Open CASCADE vtkQuadrilleCADReader and vtkQuadCADProjection.
"""
import collections
from importlib.util import find_spec

if find_spec(__name__ + "._vtk"):
    from . import _vtk

    __path__ = _vtk.folders(__path__)  # before anything else is imported from there

from ._backend import backend
from ._elements import FailedElements, elements
from ._errors import InvalidInput, RemeshError
from ._files import on_cad_geometry, read, read_cad, sizes_by_name, write
from ._inputs import as_curves, as_surface, to_polydata, with_requests
from ._mesh import Mesh
from ._options import (
    CELL_DATA, FEATURE_CRITERIA, FINAL_QUALITIES, INTEGERS, METHODS, SMALL_COMPONENTS, SMALL_DETAILS, checked)
from ._proxies import check
from ._repair import has_cgal, repair, wrap
from ._session import Irregular, Session
from ._version import __version__

__all__ = [
    "FailedElements", "InvalidInput", "Irregular", "Mesh", "RemeshError", "Remeshed", "Session", "check", "elements",
    "has_cad", "has_cgal", "info", "on_cad_geometry", "read", "read_cad", "remesh", "repair", "sizes_by_name",
    "to_arrays", "to_polydata", "wrap", "write", "__version__",
    *backend.CLASSES,
]


has_cad = backend.has_cad


def __getattr__(name):
    """Classes of VTK, where there are any."""
    if name in backend.CLASSES:
        return getattr(backend.filters, name)
    if name.startswith("vtk") and not backend.CLASSES:
        raise AttributeError(str(backend.missing(name)))
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


#: What remesh(..., everything=True) returns: four vtkPolyData, and info() of the first.
Remeshed = collections.namedtuple("Remeshed", "quads surface lines info separatrices")


def to_arrays(quads):
    """Points (n by 3) and faces (m by 4, of triangles m by 3) of a mesh, as numpy arrays of their own."""
    return backend.arrays_of(quads)


def info(quads):
    """The field data of a result as a dict: numbers, texts and lists; `stages` and `repair` as dicts."""
    result = {name: values[0] if len(values) == 1 else values for name, values in backend.fields_of(quads).items()}

    def pairs(names, values):
        names, values = result.get(names, []), result.get(values, [])
        return dict(zip(names, values)) if isinstance(names, list) else {names: values}

    result["stages"] = pairs("StageNames", "StageSeconds")
    result["repair"] = pairs("RepairNames", "RepairCounts")
    result["extraction"] = pairs("ExtractionNames", "ExtractionCounts")
    result["recoveries"] = pairs("RecoveryNames", "RecoveryCounts")
    led = pairs("TryNames", "TriesLed")
    result["tries"] = {name: {"taken": taken, "led": led[name]}
                       for name, taken in pairs("TryNames", "TriesTaken").items()}
    return result


def remesh(mesh, *, quads=None, edge_length=None, relative_edge_length=None, feature_angle=40.0,
           feature_criterion="creases",
           guiding_direction=None, guiding_weight=None, target_valence=None, sizing=None, feature_edges=None,
           patch_ids=None, curves=None, strokes=None, connections=None, cycles=None, cleared=None, sizes=None,
           patch_array="PatchId", coarse_vertices=1000,
           threads=0, maximum_number_of_quads=10000000, smoothing_steps=5,
           memory_limit=0.0, time_limit=0.0, smallest_detail=1.0, small_details="automatic",
           small_components="keep", method="scale-aware",
           final_quality="coarse", integers="keep-sizes", anisotropy_limit=0.0, distortion_metric=False,
           cell_data="centre", preview=False, symmetry=None, rotation=None,
           plane_curve="isoline", chord_error=None, angle_a_quad=None, gap_quads=0.0, smallest_size=0.2,
           largest_size=1.0, guide=None, guide_anisotropy=0.3, stroke_radius=0.0, wrap=None,
           progress=None, everything=False, spread=False):
    """Remeshes a surface with quads only and returns a vtkPolyData; without VTK, of arrays, a Mesh.

    mesh: a vtkPolyData (of another vtkDataSet the surface is taken), a Mesh, or a pair (points, faces) of arrays or
        lists: points #V by 3, faces #F by 3 or by 4, or one list of point ids a face, also as VTK has them, with the
        number of corners before the corners; or an object with `vertices` and `faces`.
    quads, edge_length, relative_edge_length: target number of quads, target edge length in units of the mesh, or over
        the diagonal of its bounding box; at most one of them. Where none is, or with
        quads="automatic", 5,000 quads, or up to 20,000 where shapes would melt with fewer, which a notice tells.
    feature_angle: degrees; edges sharper than this become edges of the quads; None turns the detection off.
    feature_criterion: which of these edges: "creases", those of curves that are creases as a whole, which the noise of
        scans is not, or "angle", all that quads of this size can follow.
    guiding_direction: #F by 3; edges of the quads should run along this direction in the face; zero: free.
    guiding_weight: #F or one number, above 0 and at most 1: how strongly; 1 where it is not given.
    target_valence: #V whole numbers, or a dict from point ids to them: 0 free, 4 regular, 2, 3, 5 to 8 a vertex of this
        valence there.
    sizing: #V, above 0: the edge length there as a multiple of the target edge length.
    feature_edges: n by 2 point ids, the ends of edges of the mesh; or #F numbers, of which bit i marks the edge from
        corner i to i + 1.
    patch_ids: #F whole numbers; edges between two values become edges of the quads.
    curves: a list of polylines (n by 3 points each) that become features, straight over the faces of the mesh;
        or a vtkPolyData with lines and, if some are no features, the cell array ConstraintType (0 feature, 1 stroke,
        2 connection, 3 cycle), and vertices of which it says 6 (cleared) or 7 (size: GuidingRadius, SizeFactor).
    strokes: a list of polylines along which quads should run.
    connections: a list of polylines from one irregular vertex to another, or to a feature or boundary, along
        which a straight chain of edges is to join the two. The quads without them are made first.
    cycles: a list of closed polylines along which a chain of edges is to close.
    cleared: n by 3: the feature curve nearest to each point, within half an edge length, is none; also one that
        feature_edges or patch_ids ask for.
    sizes: a list of (point, radius, factor): edges within the radius of the point are factor times as long.
    patch_array: name of a cell array of whole numbers of a vtkPolyData, whose borders become edges of the quads; None:
        not used.
    coarse_vertices: budget of the level where the layout is computed; 0: as many as the curvature needs.
    threads: 0 means all.
    maximum_number_of_quads: refuse to make more.
    smoothing_steps: sweeps of smoothing on the surface, which never lower the worst scaled Jacobian; 0: none.
    memory_limit: refuse to start where more is needed by the estimate; millions of bytes; 0 means what is free.
    time_limit: seconds; 0 means none.
    smallest_detail: what is smaller than so many target edge lengths is taken out before the first map: handles and
        holes (with small_details "automatic"), groups, ends and bands of detected features, above 1 connected
        components; 0: nothing.
    small_details: what becomes of handles and holes that are shorter round than three target edge lengths: "resolve",
        quads are smaller there; "simplify", handles are closed and holes filled; "keep", as they are, or a RemeshError
        where that is impossible; "automatic", below smallest_detail, and crowds of handles on surfaces not known as
        designed, simplified, else resolved where that takes at most 1.6 times the quads.
    small_components: connected components with less area than the smallest block of quads has: "keep", as about that
        many quads, or "remove".
    method: how the map is made: "scale-aware", "mixed-integer" or "quadcover" (both may leave inverted triangles), or
        "seamless" (no integers, so the result has no quads; use everything=True for the mapped surface).
    final_quality: "coarse", "intermediate" or "input": the level on which the map is solved at last; the quads are the
        same in number and connectivity, less distorted, and take longer.
    integers: "keep-sizes", or "coarsest" for the coarsest layout of quads that is the surface.
    anisotropy_limit: largest ratio of the two stretches of the map, at least 1, as far as features and irregular
        vertices let it; 0: no limit.
    distortion_metric: whether coarse triangles count with the shape of the surface that they stand for, so that sizes
        come out more even.
    cell_data: what cell arrays of the quads come from: "centre", the cell under the centre of a quad, or "area", all
        cells under it: the average of real numbers and colours, of whole numbers and strings that with the largest
        part.
    preview: whether to make the quads of the intermediate level only: the same layout in a fraction of the time. Points
        lie near the surface, and no arrays of it are carried.
    chord_error: by how much edges of the quads may lie off the surface, in units of the mesh: they are shorter where it
        is curved; with quads=N as many quads are distributed so. None: sizes do not depend on the curvature.
    angle_a_quad: by how many degrees the surface may turn along an edge of the quads; else as chord_error.
    gap_quads: so many edges at least go into the thickness of the solid and into gaps outside; 0: sizes do not depend
        on that. Of all three and `sizing` the smallest counts.
    smallest_size, largest_size: the range of what these three lead to, over the target edge length.
    guide: what quads follow where guiding_direction and strokes are not given: "curvature", or the name of an array of
        three numbers on cells or points of a vtkPolyData.
    guide_anisotropy: with guide="curvature", where |k1 - k2| / (|k1| + |k2|) is above this, over about an edge length.
    stroke_radius: what lies within this distance of a stroke takes its direction; 0: only what it runs over.
    symmetry: "found", or the mirror plane as (origin, normal), three numbers each: quads that are their own mirror
        image. The half where the normal points to is remeshed; the point array MirrorPoint of the result has the id of
        each point's image. Where the mesh is only nearly symmetric, points of the other half are put onto it.
    plane_curve: what quads with a symmetry have in the mirror plane: "isoline", edges, or "mid-line", quads across it,
        each its own image; then no point lies in the plane, and features there are not followed.
    rotation: the order of a rotation, 2 to 64, round the axis that is found, or (order, origin, direction) with a point
        of the axis and its direction: quads that become themselves when they are turned by one step. The point array
        RotatedPoint of the result has the id of the point that each one becomes. Not with symmetry.
    wrap: a length: the quads are made of a wrap of the mesh with this alpha, and their points put back onto the mesh
        where they belong to it (see the function wrap, and the point array OnSurface of the result). "auto": only where
        the mesh itself cannot be remeshed, or most of its faces cross others or stand alone, with the default alpha;
        the field data then have WrapAlpha and WrapOffset.
        Sharp edges, which a wrap rounds, are not looked for on it.
    progress: called as progress(fraction, text); a return value of False (not None) stops the run. Where there are
        quads by then that were still to be made better, these are returned, and their field data have Stopped, which
        tells what was being tried; else RemeshError is raised. The same holds for time_limit.
    everything: return a Remeshed with the mapped surface, the feature lines, the info dict and the lines of the layout,
        too. `constraints` of the info dict is a list of dicts, one for each guided region, stroke, curve, valence and
        sizing: id, kind, source_id, place, met, deviation, deviation_95, unit, reason and remark; see the user
        guide.
    spread: whether the mesh is this rank's piece of a surface that all ranks of VTK's global controller hold together
        (vtkMPIController under mpirun): all of them call remesh with the same arguments, an empty piece included. Each
        gets its share of the quads, with GlobalPointIds and GlobalCellIds, which tell where shares meet. An error is
        raised on all ranks. Not with wrap.

    Raises InvalidInput where the mesh or an argument is at fault, else RemeshError, with the reason.
    """
    options = checked(
        quads=quads, edge_length=edge_length, relative_edge_length=relative_edge_length, feature_angle=feature_angle,
        feature_criterion=feature_criterion, patch_array=patch_array, coarse_vertices=coarse_vertices, threads=threads,
        maximum_number_of_quads=maximum_number_of_quads, smoothing_steps=smoothing_steps, memory_limit=memory_limit,
        time_limit=time_limit, smallest_detail=smallest_detail, small_details=small_details,
        small_components=small_components, method=method, final_quality=final_quality, integers=integers,
        anisotropy_limit=anisotropy_limit, distortion_metric=distortion_metric, cell_data=cell_data, preview=preview,
        symmetry=symmetry, rotation=rotation, plane_curve=plane_curve, chord_error=chord_error,
        angle_a_quad=angle_a_quad, gap_quads=gap_quads, smallest_size=smallest_size, largest_size=largest_size,
        guide=guide, guide_anisotropy=guide_anisotropy, stroke_radius=stroke_radius, everything=everything)
    surface = with_requests(
        as_surface(mesh), guiding_direction=guiding_direction, guiding_weight=guiding_weight,
        target_valence=target_valence, sizing=sizing, feature_edges=feature_edges, patch_ids=patch_ids,
        patch_array=patch_array)
    requests = {
        "guiding_direction": guiding_direction, "target_valence": target_valence, "sizing": sizing,
        "feature_edges": feature_edges, "patch_ids": patch_ids, "curves": curves, "strokes": strokes,
        "connections": connections, "cycles": cycles, "cleared": cleared, "sizes": sizes, "symmetry": symmetry,
        "rotation": rotation}
    lines = as_curves(stroke_radius, curves=curves, strokes=strokes, connections=connections, cycles=cycles,
                      cleared=cleared, sizes=sizes)
    made = backend.remesh(surface, options, lines, wrap=wrap, requests=requests, spread=spread, progress=progress)
    if not everything:
        return made
    result, mapped, drawn, told, separatrices = made
    return Remeshed(result, mapped, drawn, {**info(result), **told}, separatrices)
