# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Quads as elements for simulation."""
from ._backend import backend
from ._errors import InvalidInput, RemeshError, one_of, whole
from ._inputs import as_surface

#: What elements get that have no direction, in the order of vtkQuadElements.AxisFallbacks.
AXIS_FALLBACKS = ("none", "x", "y", "z", "element")


class FailedElements(RemeshError):
    """Elements that fail a requirement. `elements` is the grid, `count` how many they are."""

    def __init__(self, text, elements, count):
        super().__init__(text)
        self.elements = elements
        self.count = count


def _texts(name, values):
    values = [values] if isinstance(values, str) else list(values or [])
    for value in values:
        if not isinstance(value, str):
            raise InvalidInput(f"{name} must be texts, not {value!r}")
    return values


def elements(quads, surface=None, *, order=1, nodes=8, patch_array="PatchId", quality=False, require=(), thickness=None,
             axis=None, axis_fallback="none", local_vectors=(), threads=0):
    """Quads as a vtkUnstructuredGrid of elements of first or second order.

    quads: what remesh returns.
    surface: what was remeshed, in any form that remesh takes, or the mapped surface of remesh(..., everything=True),
        which also has the curves that were drawn; needed for second order.
    order: 1: four corners; 2: with nodes between them, on the surface and on the curves of features and boundaries. The
        point array MovedBack has 1 where a node moved along the surface, 2 where it left it, so that no element is
        folded; info() of the result tells how many.
    nodes: of elements of second order, 8 or 9.
    patch_array: cell array of the surface whose borders are features; None: none.
    quality: whether to add the cell arrays ScaledJacobian, AspectRatio, Skew, Warpage, Taper, EdgeRatio, MinimumAngle
        and MaximumAngle, as Verdict defines them.
    require: limits that all elements have to keep, as "scaled-jacobian>0.2", one or a list; else FailedElements is
        raised, which has the grid.
    thickness: name of an array of the quads that becomes the cell array Thickness; of cells it is the mean by area
        where remesh had cell_data="area".
    axis: name of an array of the quads with directions, as "GuidingDirection", that becomes the cell array ElementAxis.
    axis_fallback: what elements get whose direction is zero or along the normal: "none" (InvalidInput), "x", "y", "z",
        or "element", the direction from their edge 3 to their edge 1.
    local_vectors: names of arrays of the quads with vectors whose components in the frames of the elements become cell
        arrays of the name and InElement.
    threads: 0 means all.

    Raises InvalidInput where an argument is at fault, else RemeshError, with the reason.
    """
    if not backend.CLASSES:
        raise backend.missing("elements")
    run = backend.filters.vtkQuadElements()
    run.SetOrder(whole("order", order, least=1, most=2))
    run.SetNodesPerElement(whole("nodes", nodes, least=8, most=9))
    run.SetPatchArrayName(patch_array or "")
    run.SetQuality(bool(quality))
    for text in _texts("require", require):
        run.AddRequirement(text)
    run.SetThicknessArrayName(thickness or "")
    run.SetAxisArrayName(axis or "")
    run.SetAxisFallback(one_of("axis_fallback", axis_fallback, AXIS_FALLBACKS))
    for name in _texts("local_vectors", local_vectors):
        run.AddVectorArrayName(name)
    run.SetNumberOfThreads(whole("threads", threads, least=0))
    run.SetInputDataObject(0, quads)
    if surface is not None:
        run.SetSurfaceData(as_surface(surface))
    for source in (run, run.GetExecutive()):
        source.AddObserver("ErrorEvent", lambda caller, event: None)
        source.AddObserver("WarningEvent", lambda caller, event: None)
    run.Update()
    if run.GetOutcome() == run.BadInput:
        raise InvalidInput(run.GetOutcomeText())
    if run.GetOutcome() != run.Succeeded:
        raise RemeshError(run.GetOutcomeText() or "there are no elements")
    if run.GetNumberOfFailedElements() > 0:
        raise FailedElements(run.GetNoticesText(), run.GetElements(), run.GetNumberOfFailedElements())
    return run.GetElements()
