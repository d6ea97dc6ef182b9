# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Damaged surfaces: repaired, or wrapped. Both need a build with CGAL."""
import numpy

from ._arrays import as_points
from ._backend import backend
from ._errors import InvalidInput, RemeshError, real
from ._inputs import as_surface


def has_cgal():
    """Whether this build has repair() and wrap()."""
    return bool(backend.CLASSES) and hasattr(backend.filters, "vtkSurfaceWrap")


def _filter(name):
    if not backend.CLASSES:
        raise backend.missing("repair and no wrap")
    if not has_cgal():
        raise RemeshError("this build of Quadrille has no CGAL: configure it with QUADRILLE_USE_CGAL=ON")
    return getattr(backend.filters, name)()


def _given(name, length):
    """None is the default, which the filters write as 0."""
    return 0.0 if length is None else real(name, length, above=0, hint=" (None is the default)")


def _run(surface_filter, mesh, time_limit, progress):
    surface_filter.SetInputData(mesh)
    surface_filter.SetTimeLimit(real("time_limit", time_limit, least=0))
    if progress is not None:
        def tell(caller, event):
            if progress(caller.GetProgress(), caller.GetProgressText() or "") is False:
                caller.SetAbortExecute(1)
        surface_filter.AddObserver("ProgressEvent", tell)
    for source in (surface_filter, surface_filter.GetExecutive()):
        source.AddObserver("ErrorEvent", lambda caller, event: None)
        source.AddObserver("WarningEvent", lambda caller, event: None)
    surface_filter.Update()
    if surface_filter.GetOutcome() == surface_filter.BadInput:
        raise InvalidInput(surface_filter.GetOutcomeText())
    if surface_filter.GetOutcome() != surface_filter.Succeeded:
        raise RemeshError(surface_filter.GetOutcomeText() or "there is no result")
    return surface_filter.GetOutput()


def wrap(mesh, *, alpha=None, offset=None, time_limit=0.0, progress=None):
    """A closed manifold surface without self-intersections round a mesh, as a vtkPolyData of triangles.

    mesh: as for remesh, however damaged; or an array of points alone (n by 3).
    alpha: radius of the ball that carves, in units of the mesh; gaps that it does not fit through are closed; None: a
        hundredth of the diagonal of the bounding box.
    offset: distance of the wrap from the mesh; None: a 600th of the diagonal, at most a sixth of alpha.
    time_limit: seconds; 0 means none.
    progress: called with the fraction done and a text; returning False stops, as RemeshError.

    Arrays of the mesh come from the nearest place. Raises InvalidInput for a mesh or number that is at fault, and
    RemeshError where there is no result or this build has no CGAL.
    """
    surface_filter = _filter("vtkSurfaceWrap")
    surface_filter.SetAlpha(_given("alpha", alpha))
    surface_filter.SetOffset(_given("offset", offset))
    is_cloud = isinstance(mesh, numpy.ndarray) and mesh.ndim == 2
    surface = backend.cloud_of(as_points(mesh)) if is_cloud else as_surface(mesh)
    return _run(surface_filter, surface, time_limit, progress)


def repair(mesh, *, fill_holes_below=0.0, find_self_intersections=True, time_limit=0.0, progress=None):
    """An oriented manifold from a soup of triangles, as a vtkPolyData of triangles, and a list of what was found.

    mesh: as for remesh, however damaged.
    fill_holes_below: holes whose boundary is shorter are filled; a length in units of the mesh; 0: none.
    find_self_intersections: whether faces that cross others are looked for. They are marked by the cell array
        SelfIntersecting, not removed: wrap does that.
    time_limit, progress: as for wrap.

    Returns (surface, findings): the findings are sentences with counts and places, none for a clean surface;
    info(surface) has SelfIntersections (pairs; -1: not looked for), FilledHoles, OpenBoundaries and Components.
    Raises as wrap does.
    """
    surface_filter = _filter("vtkSurfaceRepair")
    surface_filter.SetFillHolesBelow(real("fill_holes_below", fill_holes_below, least=0))
    surface_filter.SetFindSelfIntersections(bool(find_self_intersections))
    surface = _run(surface_filter, as_surface(mesh), time_limit, progress)
    return surface, surface_filter.GetNoticesText().splitlines()


class Wrapping:
    """What remesh does with its argument wrap: which surface is remeshed, and what becomes of the quads."""

    def __init__(self, alpha, surface, requests):
        """alpha: None, "auto", or a length. requests: arguments of remesh by name, which a wrap cannot keep."""
        if isinstance(alpha, str) and alpha != "auto":
            raise InvalidInput(f"wrap must be None, 'auto' or a length, not {alpha!r}")
        self._surface = surface
        self._only_after_failure = alpha == "auto"
        self._alpha = None if alpha in (None, "auto") else real("wrap", alpha, above=0)
        given = [name for name, value in requests.items() if value is not None]
        if self._alpha is not None and given:
            raise InvalidInput(f"a wrap keeps no {' and no '.join(given)}: leave out wrap, or these")
        self._may_wrap = not given
        if alpha is not None:
            _filter("vtkSurfaceWrap")  # raises where there is none

    def _needs_wrap(self):
        """With "auto": what is no surface is wrapped at once."""
        if not self._only_after_failure or not self._may_wrap:
            return False
        repaired = _filter("vtkSurfaceRepair")
        try:
            surface = _run(repaired, self._surface, 0.0, None)
        except InvalidInput:
            return False  # remesh tells what is wrong
        return surface.GetFieldData().GetArray("NeedsWrap").GetTuple1(0) != 0

    def remeshed(self, run, finish):
        """The quads. run: the filter, with its input; finish: runs it, and raises where it fails."""
        if self._alpha is None and not self._needs_wrap():
            try:
                finish()
                return run.GetOutput()
            except RemeshError:
                if not self._only_after_failure or not self._may_wrap or run.GetOutcome() in (
                        run.Aborted, run.TimedOut, run.TooLarge):
                    raise
        run.SetInputData(wrap(self._surface, alpha=self._alpha))
        run.DetectFeaturesOff()
        run.SetPatchArrayName("")
        finish()
        projection = backend.filters.vtkQuadProjection()
        projection.SetSurfaceData(self._surface)
        return _run(projection, run.GetOutput(), 0.0, None)
