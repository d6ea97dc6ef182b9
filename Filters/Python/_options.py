# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What remesh() can be asked for, checked: a dict by the names of its arguments, for both backends."""
from ._errors import InvalidInput, one_of, real, whole

#: How the map can be made, in the order of vtkQuadRemesh.Methods.
METHODS = ("scale-aware", "mixed-integer", "quadcover", "seamless")

#: What the whole numbers of the map can aim at, in the order of vtkQuadRemesh.IntegersTypes.
INTEGERS = ("keep-sizes", "coarsest")


#: The level on which the map is solved at last, in the order of vtkQuadRemesh.FinalQualityTypes.
FINAL_QUALITIES = ("coarse", "intermediate", "input")

#: What cell arrays of the quads can come from, in the order of vtkQuadRemesh.CellDataFromTypes.
CELL_DATA = ("centre", "area")
SMALL_COMPONENTS = ("keep", "remove")

#: What becomes of handles and holes smaller than the quads, in the order of vtkQuadRemesh.SmallDetailsTypes.
SMALL_DETAILS = ("automatic", "resolve", "simplify", "keep")
FEATURE_CRITERIA = ("creases", "angle")

#: What becomes of quads with a mirror plane there, in the order of vtkQuadRemesh.PlaneCurveTypes.
PLANE_CURVES = ("isoline", "mid-line")

#: What `quads` is where no size is given: as many as the shape of the surface needs; and how the classes say it.
AUTOMATIC = "automatic"
BY_SHAPE = 0

#: Arguments that are one of some names.
NAMES = {"method": METHODS, "final_quality": FINAL_QUALITIES, "integers": INTEGERS, "cell_data": CELL_DATA,
         "small_details": SMALL_DETAILS, "small_components": SMALL_COMPONENTS,
         "feature_criterion": FEATURE_CRITERIA, "plane_curve": PLANE_CURVES}


def number_of_quads(quads):
    """As the classes take it."""
    return BY_SHAPE if quads == AUTOMATIC else whole("quads", quads, least=1, hint=' (or "automatic")')


def _size(given):
    """The one size that is given, as a dict of one."""
    sizes = {name: value for name, value in given.items() if value is not None}
    if len(sizes) > 1:
        raise InvalidInput("give only one of " + " and ".join(sizes))
    if "edge_length" in sizes:
        return {"edge_length": real("edge_length", sizes["edge_length"], above=0)}
    if "relative_edge_length" in sizes:
        return {"relative_edge_length": real(
            "relative_edge_length", sizes["relative_edge_length"], above=0, most=1,
            hint=" (it is a part of the diagonal of the bounding box)")}
    return {"quads": number_of_quads(sizes.get("quads", AUTOMATIC))}


def _numbers(given):
    angle, coarse = given["feature_angle"], whole("coarse_vertices", given["coarse_vertices"], least=0)
    if angle is not None:
        angle = real("feature_angle", angle, above=0, most=180, hint=" (None turns the detection off)")
    if 0 < coarse < 4:
        raise InvalidInput(f"coarse_vertices must be 0 (as many as the curvature needs) or at least 4, not {coarse}")
    limit = real("anisotropy_limit", given["anisotropy_limit"], least=0)
    if 0 < limit < 1:
        raise InvalidInput(f"anisotropy_limit must be 0 (none) or at least 1, not {limit}")
    chord = given["chord_error"]
    if chord is not None:
        chord = real("chord_error", chord, above=0, hint=" (None leaves sizes as they are)")
    turn = given["angle_a_quad"]
    if turn is not None:
        turn = real("angle_a_quad", turn, above=0, most=180, hint=" (None leaves sizes as they are)")
    return {
        "feature_angle": angle, "coarse_vertices": coarse, "anisotropy_limit": limit, "chord_error": chord,
        "angle_a_quad": turn,
        "threads": whole("threads", given["threads"], least=0),
        "maximum_number_of_quads": whole("maximum_number_of_quads", given["maximum_number_of_quads"], least=1),
        "smoothing_steps": whole("smoothing_steps", given["smoothing_steps"], least=0),
        "memory_limit": real("memory_limit", given["memory_limit"], least=0),
        "time_limit": real("time_limit", given["time_limit"], least=0),
        "smallest_detail": real("smallest_detail", given["smallest_detail"], least=0),
        "gap_quads": real("gap_quads", given["gap_quads"], least=0),
        "smallest_size": real("smallest_size", given["smallest_size"], above=0, most=1),
        "largest_size": real("largest_size", given["largest_size"], least=1),
        "guide_anisotropy": real("guide_anisotropy", given["guide_anisotropy"], least=0, most=0.99),
        "stroke_radius": real("stroke_radius", given["stroke_radius"], least=0)}


def _vectors(name, values, what, error_text):
    """Two vectors of three numbers each."""
    try:
        first, second = ([real(name, value) for value in vector] for vector in values)
    except (TypeError, ValueError) as error:
        if isinstance(error, InvalidInput):
            raise
        raise InvalidInput(error_text) from error
    if len(first) != 3 or len(second) != 3:
        raise InvalidInput(f"{name} needs three numbers for the origin and three for the {what}")
    return first, second


def _symmetry(symmetry, rotation, plane_curve):
    """symmetry: None, "found", or origin and normal; rotation: None, or an order and None, or origin and direction."""
    one_of("plane_curve", plane_curve, PLANE_CURVES)
    if plane_curve == "mid-line" and symmetry is None:
        raise InvalidInput("plane_curve 'mid-line' belongs to a mirror plane: give symmetry, too")
    if rotation is not None and symmetry is not None:
        raise InvalidInput("quads have one symmetry: give symmetry or rotation")
    if rotation is not None:
        rotation = _rotation(rotation)
    if isinstance(symmetry, str):
        one_of("symmetry", symmetry, ("found",))
    elif symmetry is not None:
        symmetry = _vectors("symmetry", symmetry, "normal",
                            f"symmetry must be 'found' or a pair (origin, normal), not {symmetry!r}")
    return {"symmetry": symmetry, "rotation": rotation, "plane_curve": plane_curve}


def _rotation(rotation):
    if not isinstance(rotation, (list, tuple)):
        return whole("rotation", rotation, least=2, most=64), None
    wrong = f"rotation must be an order or a triple (order, origin, direction), not {rotation!r}"
    if len(rotation) != 3:
        raise InvalidInput(wrong)
    axis = _vectors("rotation", rotation[1:], "direction", wrong)
    return whole("rotation", rotation[0], least=2, most=64), axis


def checked(*, quads, edge_length, relative_edge_length, symmetry, rotation, plane_curve, guide, patch_array,
            distortion_metric, preview, everything, **given):
    """What remesh() was given, by the names of its arguments. Raises InvalidInput that names the argument."""
    options = _size({"quads": quads, "edge_length": edge_length, "relative_edge_length": relative_edge_length})
    options.update(_numbers(given))
    for name in NAMES:
        if name != "plane_curve":
            one_of(name, given[name], NAMES[name])
            options[name] = given[name]
    if guide is not None and not isinstance(guide, str):
        raise InvalidInput('guide must be "curvature" or the name of an array')
    options.update(_symmetry(symmetry, rotation, plane_curve))
    options.update(guide=guide, patch_array=patch_array or "", distortion_metric=bool(distortion_metric),
                   preview=bool(preview), everything=bool(everything))
    if options["preview"] and (options["symmetry"] is not None or options["rotation"] is not None):
        raise InvalidInput("there is no preview of symmetric quads: leave out preview, or symmetry and rotation")
    if options["method"] == "seamless" and options["preview"]:
        raise InvalidInput("the method 'seamless' makes no quads, so there is nothing to preview: leave out preview, "
                           "or choose another method")
    if options["method"] == "seamless" and not options["everything"]:
        raise InvalidInput("the method 'seamless' makes no quads, and its result, the mapped surface, comes with "
                           "everything=True (ComputeMappedSurface of the filter): give that, or choose another method")
    return options
