# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""A session: a surface, what is asked of it, and every state that it has been through."""
import collections
import json
import math
import numbers
import os

import numpy

from ._arrays import as_points
from ._backend import backend
from ._errors import InvalidInput, RemeshError, one_of, real, whole
from ._inputs import as_surface, with_requests
from ._options import AUTOMATIC, number_of_quads

#: Irregular vertices: points (n by 3), which name them, and valences.
Irregular = collections.namedtuple("Irregular", "point valence")

#: Settings that go on as they are, by the names of remesh().
_PLAIN = ("feature_criterion", "method", "integers", "small_details", "small_components",
          "final_quality", "coarse_vertices",
          "smallest_detail",
          "anisotropy_limit", "distortion_metric", "maximum_number_of_quads", "smoothing_steps", "warm_start",
          "threads", "memory_limit")

#: Settings that are degrees here and radians in the class; None turns them off.
_ANGLES = ("feature_angle", "angle_a_quad")
#: Settings of sizes and guides that follow from the shape: whether None turns them off, and their range.
_SHAPE = {"chord_error": (True, {"above": 0}), "gap_quads": (False, {"least": 0}),
          "smallest_size": (False, {"above": 0, "most": 1}), "largest_size": (False, {"least": 1}),
          "curvature_guides": (True, {"least": 0})}


def _settings(quads=None, edge_length=None, relative_edge_length=None, **settings):
    """The text that the class takes; what is not named stays."""
    sizes = {name: value for name, value in (("quads", quads), ("edge_length", edge_length),
                                             ("relative_edge_length", relative_edge_length)) if value is not None}
    if len(sizes) > 1:
        raise InvalidInput("give only one of " + " and ".join(sizes))
    result = {name: number_of_quads(value) if name == "quads" else real(name, value, above=0)
              for name, value in sizes.items()}
    for name, value in settings.items():
        if name in _ANGLES:
            result[name] = None
            if value is not None:
                degrees = real(name, value, above=0, most=180, hint=" (None turns it off)")
                result[name] = degrees * math.pi / 180
        elif name == "memory_limit":
            megabytes = real(name, value, least=0)
            result[name] = 1e6 * megabytes if megabytes > 0 else None
        elif name in _SHAPE:
            may_be_off, limits = _SHAPE[name]
            result[name] = (None if value is None and may_be_off else
                            real(name, value, hint=" (None turns it off)" if may_be_off else "", **limits))
        elif name not in _PLAIN:
            raise InvalidInput(f"there is no setting {name!r}; the settings are quads, edge_length, "
                               f"relative_edge_length, {', '.join((*_ANGLES, *_SHAPE, *_PLAIN))}")
        elif isinstance(value, (bool, str)):
            result[name] = value
        else:
            number = real(name, value)
            result[name] = int(number) if number == math.floor(number) else number
    return json.dumps(result)


class Session:
    """A surface and an ordered list of what is asked of it, with undo.

        session = quadrille.Session(mesh, quads=2000)
        session.add_guide([[0, 0, 1], [1, 0, 1]])
        report = session.update()       # a dict: "stages" that ran, "reused", "constraints", "notices", "seconds"
        points, quads = session.quads
        session.undo()
        session.update()                # makes nothing, the quads are there

    Methods that ask for something return an id, which never changes: for edit(), remove() and the report. A place is
    three numbers, or the id of a point of the mesh; it means the nearest point of the surface, wherever the mesh has
    its points. Quads depend on mesh, settings and constraints only: the same set from nothing makes the same bytes,
    unless warm_start is on.
    """

    def __init__(self, mesh, *, quads=None, edge_length=None, relative_edge_length=None, guiding_direction=None,
                 guiding_weight=None, target_valence=None, sizing=None, feature_edges=None, patch_ids=None,
                 progress=None, **settings):
        """mesh and all others as remesh() has them; further settings: feature_angle (degrees, None: off),
        feature_criterion,
        chord_error (None: off), gap_quads, smallest_size, largest_size, curvature_guides (None: off), method, integers,
        coarse_vertices, smallest_detail, small_details, small_components, anisotropy_limit, final_quality,
        distortion_metric, maximum_number_of_quads, smoothing_steps, warm_start, threads, memory_limit. Where no size
        is given quads is "automatic": 5,000, or up to 20,000 where the shape needs them. progress: called as
        progress(fraction); False (not None) stops the run, see update."""
        if quads is None and edge_length is None and relative_edge_length is None:
            quads = AUTOMATIC
        self._begin(with_requests(
            as_surface(mesh), guiding_direction=guiding_direction, guiding_weight=guiding_weight,
            target_valence=target_valence, sizing=sizing, feature_edges=feature_edges, patch_ids=patch_ids), progress)
        self._check(self._session.Start(self._surface, _settings(quads, edge_length, relative_edge_length, **settings)))

    def _begin(self, surface, progress):
        self._session = backend.session(progress)
        self._surface = surface
        self._report = None
        self._points = backend.points_of(surface)

    @classmethod
    def load(cls, file, mesh, *, progress=None, **arrays):
        """A session that save() has written, for the same mesh (and arrays, as __init__ takes them)."""
        session = cls.__new__(cls)
        session._begin(with_requests(as_surface(mesh), **arrays), progress)
        session._check(session._session.Load(os.fspath(file), session._surface))
        return session

    def save(self, file):
        """Constraints, settings and named states, without the mesh. A file of that name is replaced at once."""
        self._check(self._session.Save(os.fspath(file)))

    def _check(self, ok):
        if not ok:
            text, is_in_input = backend.session_error(self._session)
            raise (InvalidInput if is_in_input else RemeshError)(text or "the session failed")
        return ok

    def _place(self, name, value):
        if isinstance(value, numbers.Integral) and not isinstance(value, bool):
            if not 0 <= value < len(self._points):
                raise InvalidInput(f"{name} is point {value}, but there are only the points 0 to "
                                   f"{len(self._points) - 1}")
            return [float(x) for x in self._points[int(value)]]
        array = numpy.asarray(value, dtype=object)
        if array.shape != (3,):
            raise InvalidInput(f"{name} must be three numbers, or the id of a point, not {value!r}")
        return [real(name, x) for x in array]

    @staticmethod
    def _line(name, points):
        return as_points(points, name).tolist()

    @staticmethod
    def _faces(faces):
        return [whole("faces", face, least=0) for face in numpy.asarray(faces).ravel().tolist()]

    def _add(self, constraint, edit):
        text = json.dumps(constraint)
        self._report = None
        if edit is not None:
            self._check(self._session.EditConstraint(whole("edit", edit, least=1), text))
            return edit
        return self._check(self._session.AddConstraint(text))

    # What can be asked for. With edit=id it takes the place of what has that id.

    def add_guide(self, points=None, weight=1.0, radius=0.0, *, faces=None, direction=None, edit=None):
        """Quads run along a polyline (n by 3), and beside it within the radius; or in faces, along a direction.
        The weight is above 0 and at most 1. Where guides overlap the last one counts."""
        if (points is None) == (faces is None) or (faces is None) != (direction is None):
            raise InvalidInput("a guide needs points, or faces and a direction")
        if faces is not None:
            return self._add({"kind": "guide region", "polygons": self._faces(faces),
                              "direction": self._place("direction", direction), "weight": real("weight", weight)}, edit)
        return self._add({"kind": "guide", "points": self._line("points", points), "weight": real("weight", weight),
                          "radius": real("radius", radius)}, edit)

    def add_feature(self, points, *, edit=None):
        """A polyline becomes edges of the quads, straight over the faces of the mesh."""
        return self._add({"kind": "feature", "points": self._line("points", points)}, edit)

    def clear_feature(self, point, *, edit=None):
        """The feature curve nearest to a point, within half an edge length, is none."""
        return self._add({"kind": "cleared feature", "point": self._place("point", point)}, edit)

    def set_valence(self, point, valence, *, edit=None):
        """2 to 8; on a boundary one more than the edges there."""
        return self._add({"kind": "valence", "point": self._place("point", point),
                          "valence": whole("valence", valence, least=0)}, edit)

    def set_size(self, point=None, factor=1.0, radius=0.0, *, faces=None, edit=None):
        """Edges are factor times as long within the radius of a place, or at the corners of faces."""
        if (point is None) == (faces is None):
            raise InvalidInput("a size needs a point, or faces")
        if faces is not None:
            return self._add({"kind": "size region", "polygons": self._faces(faces), "factor": real("factor", factor)},
                             edit)
        return self._add({"kind": "size", "point": self._place("point", point), "radius": real("radius", radius),
                          "factor": real("factor", factor)}, edit)

    def _irregular(self, operation, places, valences, edit):
        return self._add({"kind": "irregular", "operation": operation,
                          "points": [self._place(name, place) for name, place in places if place is not None],
                          "valences": [whole("valences", v, least=0) for v in valences or ()]}, edit)

    def move_irregular(self, origin, target, *, edit=None):
        """The irregular vertex nearest to origin goes to target; all others stay. Runs update() before, if need be, as
        do the other operations."""
        return self._irregular("move", (("origin", origin), ("target", target)), None, edit)

    def split_irregular(self, at, first, second, valences=None, *, edit=None):
        """The one nearest to `at` becomes two, with half its index each, or with two valences."""
        return self._irregular("split", (("at", at), ("first", first), ("second", second)), valences, edit)

    def merge_irregular(self, first, second, target=None, *, edit=None):
        """Two become one, at target, or where the first one was."""
        return self._irregular("merge", (("first", first), ("second", second), ("target", target)), None, edit)

    def cancel_pair(self, first, second, *, edit=None):
        """Two of opposite indices, such as 3 and 5, become regular."""
        return self._irregular("cancel", (("first", first), ("second", second)), None, edit)

    def add_pair(self, first, second, valences=None, *, edit=None):
        """Two of opposite indices come: 3 at first and 5 at second, or two valences."""
        return self._irregular("add", (("first", first), ("second", second)), valences, edit)

    def connect(self, start, end=None, *, edit=None):
        """A straight chain of edges joins what is nearest to two places, irregular vertices, features or boundaries;
        or to the ends of a polyline, along it."""
        points = self._line("start", start) if end is None else [self._place("start", start), self._place("end", end)]
        return self._add({"kind": "connection", "points": points}, edit)

    def add_cycle(self, points, *, edit=None):
        """A straight chain of edges closes along a closed polyline, from its last point to the first."""
        return self._add({"kind": "cycle", "points": self._line("points", points)}, edit)

    def set_symmetry(self, origin=None, normal=None, *, plane_curve="isoline", edit=None):
        """Quads that are their own image in a mirror plane, given by a point in it and a normal, or found. The quads in
        front of it are made, and mirrored. plane_curve: "isoline", edges lie in the plane, or "mid-line", quads lie
        across it, each its own image. One symmetry at most is in force."""
        one_of("plane_curve", plane_curve, ("isoline", "mid-line"))
        if (origin is None) != (normal is None):
            raise InvalidInput("a symmetry needs an origin and a normal, or neither: then the plane is found")
        content = {"kind": "symmetry"}
        if origin is not None:
            content["origin"] = self._place("origin", origin)
            content["normal"] = self._place("normal", normal)
        if plane_curve != "isoline":
            content["plane_curve"] = plane_curve
        return self._add(content, edit)

    def set_rotation(self, order, origin=None, direction=None, *, edit=None):
        """Quads that become themselves when they are turned by one step of an order, 2 to 64, round an axis, given by a
        point of it and its direction, or found. The quads of one wedge are made, and turned. One symmetry at most is in
        force, of a plane or of an axis."""
        if (origin is None) != (direction is None):
            raise InvalidInput("a rotation needs an origin and a direction, or neither: then the axis is found")
        content = {"kind": "rotation", "order": whole("order", order, least=2, most=64)}
        if origin is not None:
            content["origin"] = self._place("origin", origin)
            content["direction"] = self._place("direction", direction)
        return self._add(content, edit)

    def remove(self, constraint):
        self._report = None
        self._check(self._session.RemoveConstraint(whole("constraint", constraint, least=1)))

    def set_settings(self, **settings):
        """Those of __init__ that are to change."""
        self._report = None
        self._check(self._session.SetSettings(_settings(**settings)))

    # What comes of it.

    def update(self):
        """Makes what the present state needs, and returns the report, a dict: "stages" that ran, with their seconds,
        "reused" stages ("all": nothing was to do), "runs", "seconds", "notices", and "constraints", a list of dicts
        with id, kind, text, place, met, deviation, deviation_95, unit, reason (why it is not met, else empty) and
        remark (what else is to be known). Raises RemeshError where there are no quads. "stopped" is empty, or says what
        was being tried when a stop left the best quads so far; the next update makes the result."""
        ok = self._session.Update()
        text = self._session.GetReport()
        self._check(ok)
        self._report = json.loads(text)
        return self._report

    def preview(self):
        """Points (n by 3) and quads (m by 4) from the intermediate level: the same layout as update() makes, in a time
        that follows the number of quads. They lie near the mesh, not on it. update() afterwards goes on from there; the
        report is not touched. Not with a symmetry."""
        self._check(self._session.Preview())
        return backend.preview_arrays(self._session)

    @property
    def quads(self):
        """Points (n by 3) and quads (m by 4) of the present state, as arrays of their own; update() is run before, if
        need be."""
        return backend.session_arrays(self.polydata)

    @property
    def polydata(self):
        """The same as a vtkPolyData (without VTK a Mesh), with Valence and OnBoundary on points, and with a symmetry
        MirrorPoint."""
        self.update()
        return backend.session_mesh(self._session, self._surface)

    @property
    def mirror_point(self):
        """Per point of the quads its mirror image, a permutation that is its own inverse; None without a symmetry. See
        quads."""
        return backend.session_point_array(self.polydata, "MirrorPoint")

    @property
    def rotated_point(self):
        """Per point of the quads the one that it becomes when it is turned by one step; None without a rotation. See
        quads."""
        return backend.session_point_array(self.polydata, "RotatedPoint")

    def irregular(self):
        """Irregular vertices inside of the surface, off its features: points and valences; see quads."""
        self.update()
        return Irregular(*backend.session_irregular(self._session))

    def constraints(self):
        """Dicts with id, revision, kind and what was given; once update() has been run, also with what its report says
        of each."""
        listed = json.loads(self._check(self._session.GetConstraints()))
        words = {word["id"]: word for word in self._report["constraints"]} if self._report else {}
        for constraint in listed:
            for name in ("points", "point", "direction", "origin", "normal"):
                if name in constraint:
                    constraint[name] = numpy.array(constraint[name], dtype=float)
            constraint.update({name: value for name, value in words.get(constraint["id"], {}).items()
                               if name not in ("id", "kind")})
        return listed

    def settings(self):
        """Of the present state, by their names; feature_angle and angle_a_quad in degrees."""
        result = json.loads(self._check(self._session.GetSettings()))
        for name in _ANGLES:
            if result[name] is not None:
                result[name] *= 180 / math.pi
        return result

    # States.

    def undo(self):
        """To the state before; False where there is none."""
        self._report = None
        return self._session.Undo()

    def redo(self):
        self._report = None
        return self._session.Redo()

    def state(self, name):
        """Gives the present state a name."""
        self._check(self._session.NameState(name))

    def states(self):
        return backend.session_states(self._session)

    def go_to(self, name):
        """To a state with a name; undo() comes back."""
        self._report = None
        self._check(self._session.GoTo(name))

    def compare(self, first, second=""):
        """How two states with names differ, "" is the present one: a dict with "settings", "only_first", "only_second"
        and "changed" (ids of constraints), and "results": None, or "quads", "irregular" (two numbers each) and
        "distance", the least sum of quarter turns times length that takes the irregular vertices of one to those of the
        other; "unmatched" quarter turns have no partner."""
        return json.loads(self._check(self._session.Compare(first, second)))
