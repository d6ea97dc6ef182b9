# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Arrays and lists of Python, checked; by NumPy alone."""
import numpy

from ._errors import InvalidInput


def as_numbers(name, values, shape):
    """values as an array of numbers; `shape` is how the message calls what is wanted."""
    try:
        array = numpy.asarray(values)
    except ValueError:  # rows of different lengths
        raise InvalidInput(f"{name} must be {shape}; its rows have different lengths") from None
    if array.dtype == object or array.dtype.kind not in "iufb":
        raise InvalidInput(f"{name} must be {shape}, but it does not hold numbers only (it is {array.dtype})")
    return array


def as_points(points, name="points"):
    """n by 3 real numbers, all finite."""
    array = as_numbers(name, points, "n by 3 numbers")
    if array.ndim == 1 and array.size % 3 == 0 and array.size > 0:
        raise InvalidInput(f"{name} must be n by 3, not a flat array of {array.size}: take reshape(-1, 3)")
    if array.ndim == 2 and array.shape[1] == 2:
        raise InvalidInput(f"{name} must be n by 3, not {array.shape}: add a column of zeros for z")
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidInput(f"{name} must be n by 3, not {array.shape}")
    array = numpy.ascontiguousarray(array, dtype=numpy.float64)
    bad = numpy.flatnonzero(~numpy.isfinite(array).all(axis=1))
    if bad.size:
        raise InvalidInput(f"point {bad[0]} of {name} is {array[bad[0]].tolist()}: coordinates must be finite")
    return array


def as_ids(name, values):
    """Whole numbers as int64, whatever type they came as."""
    if values.dtype.kind == "f":
        bad = numpy.flatnonzero(~(numpy.isfinite(values) & (values == numpy.floor(values))))
        if bad.size:
            raise InvalidInput(f"{name} must hold whole numbers, but has {values.ravel()[bad[0]]!r}")
    if values.dtype.kind == "b":
        raise InvalidInput(f"{name} must hold whole numbers, not truth values")
    return values.astype(numpy.int64)


def _split_counted(flat):
    """Faces of a flat array n, id 1 ... id n, n, ... as VTK had it, or None where it is none."""
    starts = []
    at = 0
    while at < flat.size and 3 <= flat[at] <= flat.size - at - 1:
        starts.append(at)
        at += int(flat[at]) + 1
    return starts if at == flat.size and starts else None


def _from_flat(flat):
    starts = _split_counted(flat)
    triangles = flat.size % 3 == 0
    if starts is None or triangles:
        advice = "take reshape(-1, 3) if they are triangles" if triangles else "give one row of point ids a face"
        also = ", or leave out the counts if they are [3, a, b, c, ...]" if starts is not None else ""
        raise InvalidInput(f"faces is a flat array of {flat.size} numbers: {advice}{also}")
    counts = flat[starts]
    keep = numpy.ones(flat.size, dtype=bool)
    keep[starts] = False
    return counts, flat[keep]


def _without_counts(rows):
    """Rows [n, id 1 ... id n] as rows of ids. A face that names a point twice is none, so these cannot be polygons with
    one corner more."""
    corners = rows.shape[1] - 1
    if corners < 3 or rows.shape[0] == 0 or not (rows[:, 0] == corners).all():
        return rows
    if (rows[:, 1:] == corners).any():
        return rows[:, 1:]
    raise InvalidInput(
        f"each of the faces begins with {corners} and has {corners} numbers more: if that is their number of corners, "
        "as in VTK, give faces[:, 1:]; if not, begin one of them with another of its points")


def as_faces(faces, point_count):
    """Number of corners of each face, and the corners of all: from an array m by k, a list of lists of point ids, or
    VTK's faces with their numbers of corners before them (rows or flat)."""
    try:
        array = numpy.asarray(faces)
    except ValueError:
        array = None  # rows of different lengths
    if array is None or array.dtype == object:
        rows = [as_ids(f"face {i}", as_numbers(f"face {i}", face, "a list of point ids").ravel())
                for i, face in enumerate(faces)]
        counts = numpy.array([row.size for row in rows], dtype=numpy.int64)
        corners = numpy.concatenate(rows) if rows else numpy.zeros(0, numpy.int64)
    else:
        array = as_ids("faces", as_numbers("faces", array, "m by 3 point ids"))
        if array.size == 0:
            raise InvalidInput("the mesh has no faces")
        if array.ndim == 1:
            counts, corners = _from_flat(array)
        elif array.ndim == 2:
            array = _without_counts(array)
            counts = numpy.full(array.shape[0], array.shape[1], dtype=numpy.int64)
            corners = array.ravel()
        else:
            raise InvalidInput(f"faces must be m by 3 (or m by 4, or a list of lists), not {array.shape}")
    _check_corners(counts, corners, point_count)
    return counts, corners


def _check_corners(counts, corners, point_count):
    few = numpy.flatnonzero(counts < 3)
    if few.size:
        raise InvalidInput(f"face {few[0]} has {counts[few[0]]} corners; a face needs 3 at least")
    bad = numpy.flatnonzero((corners < 0) | (corners >= point_count))
    if bad.size:
        face = numpy.searchsorted(numpy.cumsum(counts), bad[0], side="right")
        from_one = corners.min() == 1 and corners.max() == point_count
        raise InvalidInput(f"face {face} names point {corners[bad[0]]}, but there are only the points 0 to "
                           f"{point_count - 1}"
                           + ("; the ids seem to begin at 1: subtract 1" if from_one else ""))


def per_element(name, values, count, element, components=1):
    """values as an array with one row for each of the `count` elements."""
    shape = f"one number a {element}" if components == 1 else f"#{element}s by {components} numbers"
    array = as_numbers(name, values, shape)
    if components == 1 and array.ndim == 2 and array.shape[1] == 1:
        array = array.ravel()
    wanted = (count,) if components == 1 else (count, components)
    if array.shape != wanted:
        raise InvalidInput(f"{name} must have {shape}: the shape {wanted}, not {array.shape}")
    return array


def is_far(points):
    """Whether single precision is not enough there: see Filters/Common/Far.h."""
    if not len(points):
        return False
    return bool(numpy.abs(points).max() > 4 * (points.max(axis=0) - points.min(axis=0)).max())
