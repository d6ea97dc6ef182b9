#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Whether a change leaves every quad mesh as it was: a fixed list of runs, and what came out of each.

  Scripts/check/gate.py record FILE --python BUILD [--shared FOLDER] [--jobs N] [--quick] [--only REGEX]
  Scripts/check/gate.py compare OLD NEW [--common]
  Scripts/check/gate.py list [--shared FOLDER]

record makes each run of the list in a process of its own, through the VTK filters of the build in the folder BUILD, and
writes to FILE: status, texts, number of quads, and SHA-256 sums of the quads (points, corners; of symmetric ones their
images), of the map on the surface (points, `IGM`, `Matching`) and of the outputs drawn from the quads; seconds and peak
memory of the process.
Models are those of Data/, and those of FOLDER (default: shared/data beside the checkout), which are left out, with a
line, where they are not there. A run of several steps uses the same filter for all of them; some are followed by a run
that makes each step with a new filter, or with other numbers of threads, which must give the same sums: where they
differ, record ends with 1. About 4 minutes with two jobs on two cores.

compare tells what differs and ends with 1 where a sum, a status or the text of a failure does, or a run of OLD is not
in NEW (--common: only runs that both have count). Notices, reused stages, time and memory are told, and change nothing
in the exit code.

Sums can be compared on one machine with one version of the libraries only.
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import time

# The process that starts the runs imports neither numpy nor VTK: what it holds would count in their peak memory.

ROOT = pathlib.Path(__file__).resolve().parents[2]
RUN_LIMIT = 180  # seconds; a run that takes longer is recorded as stopped
MEMORY_TOLERANCE = 1.03
SCALE_AWARE, MIXED_INTEGER, QUADCOVER, SEAMLESS = range(4)  # vtkQuadRemesh.Methods
INTERMEDIATE, INPUT = 1, 2  # vtkQuadRemesh.FinalQualityLevel
PLANE, FOUND, AXIS, AXIS_FOUND = range(1, 5)  # vtkQuadRemesh.SymmetryTypes
OUTCOMES = ("not run", "succeeded", "bad input", "no valid result", "aborted", "timed out", "too large")


# --- the list ---------------------------------------------------------------------------------------------------------

class Run:
    """One process. `steps` are (name, requests), made one after the other by `make`; requests are setters of the filter
    without their Set, in capitals, and, in small letters, what is added to the surface, a name of ADDITIONS or of
    DRAWN. Those of `base` hold for each step. """

    def __init__(self, name, mesh, base=None, steps=None, make="one filter", quick=False, same_as=None):
        self.name, self.mesh, self.base = name, mesh, base or {}
        self.steps = steps or [("", {})]
        self.make, self.quick = make, quick
        self.same_as = same_as  # name of the run whose steps must have the same sums


def quads(number, **requests):
    return {"NumberOfQuads": number, **requests}


def single(mesh, number, label="", quick=False, **requests):
    name = f"{pathlib.PurePath(mesh).stem}/{number}" + (f"/{label}" if label else "")
    return Run(name, mesh, quads(number, **requests), quick=quick)


def warm_and_cold(name, mesh, base, steps, quick=False):
    """The same steps with one filter, which remembers, and with a new one for each."""
    return [Run(f"{name}/warm", mesh, base, steps, quick=quick),
            Run(f"{name}/cold", mesh, base, steps, "new filters", quick, same_as=f"{name}/warm")]


def one_and_two_threads(mesh, number, **requests):
    name = f"{pathlib.PurePath(mesh).stem}/{number}/" + "".join(f"{key}-" for key in requests)
    return [Run(f"{name}1-thread", mesh, quads(number, NumberOfThreads=1, **requests)),
            Run(f"{name}2-threads", mesh, quads(number, NumberOfThreads=2, **requests), same_as=f"{name}1-thread")]


#: What a user changes between two executions.
EDITS = [
    ("first", {}),
    ("nothing", {}),
    ("smoothing steps", {"SmoothingSteps": 1}),
    ("more coarse vertices", {"CoarseVertices": 1400}),
    ("more quads", {"NumberOfQuads": 3600}),
    ("stroke", {"strokes": "over the top"}),
    ("other stroke", {"strokes": "along the side"}),
    ("stroke gone", {}),
    ("valence", {"valences": "three at one end"}),
    ("other valence", {"valences": "three and five"}),
    ("valence gone", {}),
    ("sizes", {"sizes": "finer to one end"}),
    ("feature angle", {"FeatureAngle": 25.0}),
    ("back", {}),
]


def own_runs():
    part, beast, frame = (f"Data/{name}.ply" for name in ("part", "beast", "frame"))
    runs = [
        single(part, 3000, quick=True), single(beast, 2000, quick=True), single(frame, 1500, quick=True),
        single(part, 5000), single(part, 800), single(part, 150), single(part, 30000), single(beast, 12000),
        single(beast, 300), single(frame, 60), single(frame, 10000),
        single(part, 3000, "seamless", Method=SEAMLESS), single(beast, 2000, "seamless", Method=SEAMLESS, quick=True),
        single(part, 3000, "mixed-integer", Method=MIXED_INTEGER),
        single(beast, 2000, "mixed-integer", Method=MIXED_INTEGER),
        single(frame, 1500, "mixed-integer", Method=MIXED_INTEGER), single(frame, 1500, "quadcover", Method=QUADCOVER),
        single(part, 3000, "quadcover", Method=QUADCOVER), single(beast, 2000, "quadcover", Method=QUADCOVER),
        single(part, 3000, "coarsest", Integers=1), single(beast, 2000, "coarsest", Integers=1),
        single(frame, 1500, "coarsest", Integers=1),
        single(part, 3000, "intermediate", FinalQuality=INTERMEDIATE), single(part, 3000, "input", FinalQuality=INPUT),
        single(beast, 2000, "intermediate", FinalQuality=INTERMEDIATE),
        single(beast, 2000, "input", FinalQuality=INPUT),
        single(frame, 1500, "input", FinalQuality=INPUT),
        single(part, 3000, "metric", DistortionMetric=1), single(beast, 2000, "metric", DistortionMetric=1),
        single(beast, 2000, "anisotropy", AnisotropyLimit=1.5), single(part, 3000, "anisotropy", AnisotropyLimit=2.0),
        single(beast, 2000, "sizes", sizes="finer to one end"), single(part, 3000, "sizes", sizes="finer to one end"),
        single(beast, 2000, "too-steep-sizes", sizes="leap"),
        single(beast, 2000, "directions", directions="round z"),
        single(frame, 1500, "directions", directions="along x"),
        single(beast, 2000, "weak-directions", directions="along x", weights="half"),
        single(beast, 2000, "strokes", strokes="over the top"), single(part, 3000, "strokes", strokes="along the side"),
        single(beast, 2000, "weak-strokes", strokes="along the side", StrokeWeight=0.4),
        single(beast, 2000, "curves", curves="over the top"), single(frame, 1500, "curves", curves="along the side"),
        single(beast, 2000, "valences", valences="three and five"),
        single(beast, 2000, "valence-points", points="both ends", PointValence=3),
        single(part, 3000, "valence", valences="three at one end"),
        single(beast, 2000, "bad-valence", valences="nine"),
        single(beast, 4000, "own-patches", patches="slabs", PatchArrayName="Slab"),
        single(part, 3000, "no-patches", PatchArrayName="(none)", DetectFeatures=0),
        single(part, 3000, "missing-patches", PatchArrayName="Slab"),
        single(frame, 1500, "few-coarse-vertices", CoarseVertices=40),
        single(beast, 2000, "automatic-coarse-vertices", CoarseVertices=0),
        single(frame, 1500, "small-details", SmallestDetail=3.0),
        single(beast, 2000, "unsmoothed", SmoothingSteps=0),
        single(beast, 2000, "area", CellDataFrom=1, patches="slabs"),
        single(beast, 200, "too-many-quads", MaximumNumberOfQuads=50, quick=True),
        Run("part/edge-length", part, {"TargetType": 1, "EdgeLength": 0.05}),
        Run("frame/relative-edge-length", frame, {"TargetType": 2, "RelativeEdgeLength": 0.03}),
        Run("pieces/2000", "islands", quads(2000)),
        Run("pieces/2000/removed", "islands", quads(2000, SmallComponents=1)),
        Run("blocks/3000", "blocks", quads(3000), quick=True),
        Run("blocks/3000/each", "blocks", quads(3000, QuadsAre=1)),
        Run("torn/500", "torn", quads(500), quick=True), Run("empty", "empty", quads(500), quick=True),
        Run("part/3000/chain", part, quads(3000), make="chain", same_as="part/3000", quick=True),
        Run("beast/2000/chain", beast, quads(2000), make="chain", same_as="beast/2000"),
        Run("frame/1500/chain-coarsest", frame, quads(1500, Integers=1), make="chain", same_as="frame/1500/coarsest"),
        Run("beast/2000/chain-directions", beast, quads(2000, directions="round z"), make="chain"),
        Run("frame/60/chain", frame, quads(60), make="chain"),
        Run("beast/warm-start", beast, quads(2000, WarmStart=1),
            [("first", {}), ("stroke", {"strokes": "over the top"}), ("valence", {"valences": "three at one end"}),
             ("back", {})]),
        Run("part/warm-start", part, quads(3000, WarmStart=1),
            [("first", {}), ("stroke", {"strokes": "along the side"}),
             ("more coarse vertices", {"CoarseVertices": 1400}), ("back", {})]),
    ]
    runs += warm_and_cold("beast/edits", beast, quads(2000), EDITS)
    runs += warm_and_cold("part/edits", part, quads(3000), [step for step in EDITS if "valence" not in step[0]])
    runs += warm_and_cold("frame/edits", frame, quads(1500), EDITS[:4] + EDITS[5:8] + EDITS[-1:])
    runs += warm_and_cold("frame/few-edits", frame, quads(400), EDITS[:3] + EDITS[4:5] + EDITS[-1:], quick=True)
    runs += warm_and_cold("frame/edits-of-what-fails", frame, quads(60), EDITS[:4] + EDITS[5:8] + EDITS[-1:])
    runs += one_and_two_threads(part, 4000) + one_and_two_threads(beast, 4000, FinalQuality=INTERMEDIATE)
    runs += one_and_two_threads(frame, 2000, Integers=1)
    return runs + symmetric_runs()


def symmetric_runs():
    """Mirror planes with their curve on edges and across quads, rotations of the orders 2 to 6."""
    def plane(mesh, number, label, normal=(1, 0, 0), **requests):
        return single(mesh, number, f"plane-{label}", Symmetry=PLANE, SymmetryNormal=normal, **requests)

    def turned(mesh, number, order, label="", **requests):
        return single(mesh, number, f"turned-{order}{label}", Symmetry=AXIS, SymmetryNormal=(0, 0, 1),
                      RotationOrder=order, **requests)

    runs = [turned("ring of 60", 800, order) for order in (2, 3, 4, 5, 6)]
    runs += [turned("ball of 60", 800, order) for order in (2, 3, 4, 5, 6)]
    runs += [
        turned("box", 900, 2), turned("box", 900, 4), turned("tube", 600, 5), turned("dented ring", 900, 3),
        turned("dented box", 900, 2), turned("wavy ring", 600, 6, "-sizes", sizes="finer to one end"),
        turned("wavy ring", 600, 3, "-directions", directions="round z"),
        turned("ball of 60", 700, 2, "-valences", valences="three and five"),
        turned("box", 900, 4, "-strokes", strokes="over the top"),
        turned("tube", 900, 2, "-curves", curves="along the side"),
        turned("tube", 900, 4, "-seamless", Method=SEAMLESS),
        turned("ring of 60", 60, 6), turned("box", 900, 3), turned("tube", 900, 3),
        Run("wavy ring/600/axis-found", "wavy ring", quads(600, Symmetry=AXIS_FOUND, RotationOrder=6), quick=True),
        Run("wavy ring/edge-length/turned-3", "wavy ring",
            {"TargetType": 1, "EdgeLength": 0.1, "Symmetry": AXIS_FOUND, "RotationOrder": 3}),
    ]
    for curve, label in ((0, "on-edges"), (1, "across")):
        def halved(mesh, number, more="", normal=(1, 0, 0), across=curve, name=label, **requests):
            return plane(mesh, number, name + more, normal, PlaneCurve=across, **requests)

        runs += [
            halved("ball of 60", 800), halved("ring of 60", 800), halved("ring of 60", 900, "-level", (0, 0, 1)),
            halved("box", 900), halved("tube", 600), halved("dented ring", 900), halved("dented box", 900),
            halved("box", 900, "-oblique", (0.2, 0.1, 1)), halved("wavy ring", 600, "-sizes", sizes="finer to one end"),
            halved("dented ring", 900, "-directions", directions="round z"),
            halved("ball of 60", 700, "-valences", (0, 0, 1), valences="three and five"),
            halved("wavy ring", 700, "-strokes", strokes="along the side"),
            halved("tube", 900, "-curves", (0, 0, 1), curves="along the side"),
            halved("ring of 60", 24), halved("wavy ring", 600),
            halved("tube", 600, "-seamless", Method=SEAMLESS),
            Run(f"wavy ring/600/found-{label}", "wavy ring", quads(600, Symmetry=FOUND, PlaneCurve=curve), quick=True),
            Run(f"box/edge-length/{label}", "box",
                {"TargetType": 1, "EdgeLength": 0.1, "Symmetry": PLANE, "PlaneCurve": curve}),
        ]
    runs += [single(f"Data/{name}.ply", number, f"mirrored{label}", Symmetry=FOUND, PlaneCurve=curve)
             for name, number in (("part", 3000), ("beast", 2000), ("frame", 1500))
             for curve, label in ((0, ""), (1, "-across"))]
    runs += warm_and_cold("box/symmetries", "box", quads(900), [
        ("half", {"Symmetry": PLANE}), ("across", {"Symmetry": PLANE, "PlaneCurve": 1}),
        ("turned", {"Symmetry": AXIS, "SymmetryNormal": (0, 0, 1), "RotationOrder": 4}), ("none", {}),
        ("half again", {"Symmetry": PLANE}), ("more quads", {"Symmetry": PLANE, "NumberOfQuads": 1500}),
    ])
    return runs


#: Models of the shared folder: numbers of quads to make of each.
SHARED = {
    "cad/fandisk.ply": (5000, 600), "cad/joint.ply": (5000, 1000), "cad/rolling_stage.ply": (5000,),
    "cad/of_flange.ply": (2000,),
    "cad/cgal_couplingdown.ply": (5000, 800), "cad/cgal_anchor_dense.ply": (3000,),
    "cad/cgal_spool.ply": (2000, 200), "cad/cgal_part.ply": (1500,), "cad/tm_box.ply": (5000,),
    "cad/tm_plate_holes.ply": (1500, 300), "cad/tm_1002_tray_bottom.ply": (3000,),
    "cad/tm_torus.ply": (1000,), "cad/of_naca0012.ply": (3000,), "cad/of_pipe.ply": (1500,),
    "cad/of_bullet.ply": (3000,),
    "cad/abc3.ply": (4000,), "cad/ost_wingnut.ply": (1000,), "cad/crank_case.ply": (8000,),
    "cad/axom_boxedSphere.ply": (3000,),
    "cad/input_wheel.ply": (8000,), "cad/thingi_908460.ply": (10000,), "cad/ost_boot.ply": (6000,),
    "open/mask.ply": (3000,), "open/plane_holes.ply": (3000,), "open/st_helens.ply": (5000,),
    "open/dir_dome.ply": (1000,),
    "open/of_rotating.ply": (500,), "open/cgal_holes.ply": (1500,), "open/violin_open.ply": (2000,),
    "scan/bunny_69k.ply": (5000,), "scan/horse.ply": (4000,), "scan/armadillo_86k.ply": (8000,),
    "scan/lucy_100k.ply": (6000,),
    "scan/ost_hammer.ply": (2000,), "scan/bunny_ct.ply": (5000,),
    "bad/tm_soup.stl": (500,), "bad/tm_shared.stl": (500,), "bad/tm_multibody.stl": (500,),
    "bad/tm_angle_block.stl": (1000,),
    "bad/tm_not_convex.obj": (500,), "bad/cgal_degtri_sliding.off": (100,), "bad/cgal_blobby-shuffled.off": (1000,),
    "bad/cgal_oblong-shuffled.off": (500,), "bad/cgal_pig.stl": (2000,), "bad/cgal_boeing.off": (2000,),
    "bad/cgal_elephant-with-holes.off": (3000,), "bad/cgal_b9_mesh.off": (3000,),
    "bad/ml_many_small_holes.ply": (2000,),
    "bad/mf_openscad-nonmanifold-crash.obj": (1500,), "bad/vtk_doorman.obj": (4000,),
}


def shared_runs():
    runs = [single(mesh, number) for mesh, numbers in SHARED.items() for number in numbers]
    fandisk, joint, couplingdown = "cad/fandisk.ply", "cad/joint.ply", "cad/cgal_couplingdown.ply"
    horse = "scan/horse.ply"
    for label, method in (("mixed-integer", MIXED_INTEGER), ("quadcover", QUADCOVER), ("seamless", SEAMLESS)):
        runs += [single(mesh, number, label, Method=method) for mesh, number in ((fandisk, 5000), (horse, 4000))]
    runs += [single(fandisk, 5000, "coarsest", Integers=1), single(joint, 5000, "coarsest", Integers=1),
             single(horse, 4000, "coarsest", Integers=1), single(fandisk, 5000, "input", FinalQuality=INPUT),
             single(horse, 4000, "intermediate", FinalQuality=INTERMEDIATE),
             single(joint, 5000, "metric", DistortionMetric=1),
             single(horse, 4000, "anisotropy", AnisotropyLimit=1.5),
             single(horse, 4000, "strokes", strokes="over the top"),
             single(fandisk, 5000, "sizes", sizes="finer to one end"),
             single("open/mask.ply", 3000, "curves", curves="over the top"),
             single(horse, 4000, "valences", valences="three and five"),
             single("cad/tm_box.ply", 5000, "removed", SmallComponents=1),
             Run("joint/5000/chain", joint, quads(5000), make="chain", same_as="joint/5000"),
             Run("horse/4000/chain", horse, quads(4000), make="chain", same_as="horse/4000"),
             Run("cgal_couplingdown/800/chain", couplingdown, quads(800), make="chain")]
    runs += [Run(f"{name}/foreign-map", f"igm/{name}.obj", {"BoundaryMode": mode}, make="extraction")
             for name, mode in (("qex_fandisk_param", 0), ("qex_duck_miq_4_param", 1), ("qex_duck_miq_16_param", 0))]
    runs += warm_and_cold("horse/edits", horse, quads(4000),
                          [step for step in EDITS if step[0] not in ("sizes", "feature angle")])
    runs += warm_and_cold("fandisk/edits", fandisk, quads(600), EDITS[:8] + EDITS[-1:])
    runs += one_and_two_threads("scan/bunny_69k.ply", 4000) + one_and_two_threads(joint, 3000)
    return runs


def all_runs(shared):
    """The list, and a line for each model that is not there."""
    found, missing = own_runs(), []
    there = {mesh for mesh in {run.mesh for run in shared_runs()} if (shared / mesh).is_file()}
    for run in shared_runs():
        if run.mesh in there:
            found.append(run)
        else:
            missing.append(f"left out, no {run.mesh} in {shared}: {run.name}")
    names = [run.name for run in found]
    assert len(set(names)) == len(names), sorted(name for name in names if names.count(name) > 1)
    return found, missing


# --- surfaces ---------------------------------------------------------------------------------------------------------

def read_off(path):
    import numpy
    words = [line.split("#")[0] for line in path.read_text().splitlines()]
    numbers = " ".join(words).split()[1:]
    points = numpy.array(numbers[3:3 + 3 * int(numbers[0])], float).reshape(-1, 3)
    at, faces = 3 + points.size, []
    for _ in range(int(numbers[1])):
        corners = int(numbers[at])
        faces.append([int(corner) for corner in numbers[at + 1:at + 1 + corners]])
        at += 1 + corners
    return points, faces


def arrays_of(surface):
    """Points #V by 3 and triangles #F by 3."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
    return vtk_to_numpy(surface.GetPoints().GetData()).astype(float), corners.reshape(-1, 3)


def islands():
    """beast, with copies beside it that are so small that they are less than a block of quads."""
    import numpy
    import quadrille
    points, faces = arrays_of(quadrille.read(ROOT / "Data/beast.ply"))
    size = numpy.ptp(points, axis=0).max()
    parts = [(1, (0, 0, 0)), (0.01, (1.2, 0, 0)), (0.004, (0, 1.3, 0)), (0.3, (0, 0, 1.2))]
    return quadrille.to_polydata(numpy.concatenate([scale * points + size * numpy.array(shift)
                                                    for scale, shift in parts]),
                                 numpy.concatenate([faces + i * len(points) for i in range(len(parts))]))


def torn():
    """Three triangles that share an edge, beside a sheet: no surface."""
    import quadrille
    return quadrille.to_polydata([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0.2], [0.3, 0, 1]],
                                 [[0, 1, 2], [1, 0, 3], [0, 1, 4]])


def blocks():
    import quadrille
    from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
    result = vtkMultiBlockDataSet()
    for i, name in enumerate(("part", "torn", "frame")):
        result.SetBlock(i, torn() if name == "torn" else quadrille.read(ROOT / f"Data/{name}.ply"))
        result.GetMetaData(i).Set(result.NAME(), name)
    return result


def swept(around, along, closed, place):
    """A grid of triangles that closes in one direction or in both; place: of two shares in [0, 1]."""
    import numpy
    import quadrille
    rows = along if closed else along + 1
    points = [place(i / around, k / along) for k in range(rows) for i in range(around)]
    faces = []
    for k in range(along):
        for i in range(around):
            a, b, c, d = (((k + row) % rows) * around + (i + column) % around
                          for row, column in ((0, 0), (0, 1), (1, 1), (1, 0)))
            faces += [(a, b, c), (a, c, d)]
    return quadrille.to_polydata(numpy.array(points), numpy.array(faces))


def ring(around, waves=0, dent=0.0):
    """A torus round z, with waves, or with a dent in one place."""
    from math import cos, exp, pi, sin

    def place(u, v):
        r = 0.35 * (1 + 0.2 * cos(2 * pi * waves * u) * (waves > 0))
        r *= 1 - dent * exp(-40 * ((u - 0.1) ** 2 + (v - 0.2) ** 2))
        out = 1 + r * cos(2 * pi * v)
        return out * cos(2 * pi * u), out * sin(2 * pi * u), r * sin(2 * pi * v)
    return swept(around, 24, True, place)


def ball(around):
    """Round z, flattened, with a vertex at both ends of it."""
    import numpy
    import quadrille
    from math import cos, pi, sin
    rows = 24
    points = [(sin(pi * k / rows) * cos(2 * pi * i / around), sin(pi * k / rows) * sin(2 * pi * i / around),
               0.7 * cos(pi * k / rows)) for k in range(1, rows) for i in range(around)]
    last = len(points)
    points += [(0, 0, 0.7), (0, 0, -0.7)]
    faces = []
    for i in range(around):
        j = (i + 1) % around
        faces += [(last, i, j), (last + 1, last - around + j, last - around + i)]
        for row in range(0, last - around, around):
            faces += [(row + i, row + around + i, row + around + j), (row + i, row + around + j, row + j)]
    return quadrille.to_polydata(numpy.array(points), numpy.array(faces))


def box(dent=0.0):
    """A cube whose six sides have the same grid, about the origin; the dent is in one side."""
    import numpy
    import quadrille
    count, points, faces = 12, {}, []

    def point(side, i, k):
        place = numpy.roll((2 * i / count - 1, 2 * k / count - 1, 1 if side < 3 else -1), side % 3)
        place = tuple(numpy.round(0.8 * place, 12))
        return points.setdefault(place, len(points))
    for side in range(6):
        for i in range(count):
            for k in range(count):
                a, b, c, d = point(side, i, k), point(side, i + 1, k), point(side, i + 1, k + 1), point(side, i, k + 1)
                faces += [(a, b, c), (a, c, d)] if side < 3 else [(a, c, b), (a, d, c)]
    places = numpy.array(list(points))
    near = numpy.exp(-8 * ((places - (0.8, 0.3, 0.2)) ** 2).sum(axis=1))
    return quadrille.to_polydata(places * (1 - dent * near)[:, None], numpy.array(faces))


def tube():
    from math import cos, pi, sin
    return swept(60, 20, False, lambda u, v: (cos(2 * pi * u), sin(2 * pi * u), 1.6 * v - 0.8))


MADE = {"ring of 60": lambda: ring(60), "wavy ring": lambda: ring(96, waves=6),
        "dented ring": lambda: ring(60, dent=0.2), "ball of 60": lambda: ball(60), "box": box,
        "dented box": lambda: box(dent=0.1), "tube": tube}


def surface_of(mesh, shared):
    import quadrille
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    made = {"islands": islands, "torn": torn, "blocks": blocks, "empty": vtkPolyData, **MADE}
    if mesh in made:
        return made[mesh]()
    path = (ROOT if mesh.startswith("Data/") else shared) / mesh
    return quadrille.to_polydata(*read_off(path)) if path.suffix == ".off" else quadrille.read(path)


# --- what is asked for beside the surface -----------------------------------------------------------------------------

def centres_of(points, faces):
    return points[faces].mean(axis=1)


def directions_round_z(points, faces):
    """Round the axis z through the middle, in the upper half."""
    import numpy
    centres = centres_of(points, faces)
    away = centres - points.mean(axis=0)
    directions = numpy.stack((-away[:, 1], away[:, 0], numpy.zeros(len(away))), axis=1)
    directions[away[:, 2] < 0] = 0
    return directions


def directions_along_x(points, faces):
    import numpy
    return numpy.tile([1.0, 0.0, 0.0], (len(faces), 1))


def size_finer_to_one_end(points, faces):
    import numpy
    along = points[:, 0]
    return 0.6 + 0.9 * (along - along.min()) / numpy.ptp(along)


def size_leap(points, faces):
    import numpy
    return numpy.where(points[:, 0] < points[:, 0].mean(), 0.3, 2.0)


def valences(*ends):
    def array(points, faces):
        import numpy
        result = numpy.zeros(len(points), numpy.int32)
        for valence, end in ends:
            result[end(points[:, 2])] = valence
        return result
    return array


def slabs(points, faces):
    """Patches by height: four slabs."""
    import numpy
    height = centres_of(points, faces)[:, 2]
    return numpy.floor(4 * (height - height.min()) / numpy.ptp(height)).clip(0, 3).astype(numpy.int32)


def highest(heights):
    return heights.argmax()


def lowest(heights):
    return heights.argmin()


#: Request, value: association and name of the array, and what fills it.
ADDITIONS = {
    ("directions", "round z"): ("cell", "GuidingDirection", directions_round_z),
    ("directions", "along x"): ("cell", "GuidingDirection", directions_along_x),
    ("weights", "half"): ("cell", "GuidingWeight", lambda points, faces: [0.5] * len(faces)),
    ("sizes", "finer to one end"): ("point", "Sizing", size_finer_to_one_end),
    ("sizes", "leap"): ("point", "Sizing", size_leap),
    ("valences", "three at one end"): ("point", "TargetValence", valences((3, highest))),
    ("valences", "three and five"): ("point", "TargetValence", valences((3, highest), (5, lowest))),
    ("valences", "nine"): ("point", "TargetValence", valences((9, highest))),
    ("patches", "slabs"): ("cell", "Slab", slabs),
}


def line_over_the_top(points):
    import numpy
    low, high = points.min(axis=0), points.max(axis=0)
    return [[low[0] + t * (high[0] - low[0]), (low[1] + high[1]) / 2, high[2]] for t in numpy.linspace(0.3, 0.7, 5)]


def line_along_the_side(points):
    import numpy
    low, high = points.min(axis=0), points.max(axis=0)
    return [[(low[0] + high[0]) / 2, high[1], low[2] + t * (high[2] - low[2])] for t in numpy.linspace(0.4, 0.6, 4)]


def both_ends(points):
    return [points[points[:, 2].argmax()].tolist(), points[points[:, 2].argmin()].tolist()]


DRAWN = {"over the top": line_over_the_top, "along the side": line_along_the_side, "both ends": both_ends}
PORTS = {"curves": "Curves", "strokes": "Strokes", "points": "ValencePoints"}


def with_arrays(surface, requests):
    """A shallow copy with what is added in new arrays, as a filter upstream delivers it."""
    import numpy
    from vtkmodules.util.numpy_support import numpy_to_vtk
    added = [ADDITIONS[item] for item in sorted(requests.items()) if item in ADDITIONS]
    result = surface.NewInstance()
    result.ShallowCopy(surface)
    for association, name, fill in added:
        array = numpy_to_vtk(numpy.ascontiguousarray(fill(*arrays_of(surface))), deep=True)
        array.SetName(name)
        (result.GetPointData() if association == "point" else result.GetCellData()).AddArray(array)
    return result


def drawn(kind, surface):
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    places = DRAWN[kind](arrays_of(surface)[0])
    result, points, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    points.SetDataTypeToDouble()
    cells.InsertNextCell(len(places))
    for place in places:
        cells.InsertCellPoint(points.InsertNextPoint(place))
    result.SetPoints(points)
    (result.SetVerts if kind == "both ends" else result.SetLines)(cells)
    return result


# --- one run ----------------------------------------------------------------------------------------------------------

def sum_of(*arrays):
    """SHA-256 of types, shapes and bytes; None stands for an array that is not there."""
    result = hashlib.sha256()
    for array in arrays:
        result.update(b"none" if array is None else f"{array.dtype.str}{array.shape}".encode() + array.tobytes())
    return result.hexdigest()


def numbers(array):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    return vtk_to_numpy(array) if array is not None else None


def leaves(data):
    """The vtkPolyData of an output, which may be composite; None for a block that is not there."""
    if not data.IsA("vtkCompositeDataSet"):
        return [data]
    return [data.GetBlock(i) for i in range(data.GetNumberOfBlocks())]


def mesh_arrays(data):
    """Points and corners of all kinds of cells."""
    result = []
    for leaf in leaves(data):
        result.append(numbers(leaf.GetPoints().GetData()) if leaf is not None and leaf.GetPoints() else None)
        for cells in (leaf.GetVerts(), leaf.GetLines(), leaf.GetPolys()) if leaf is not None else ():
            result += [numbers(cells.GetOffsetsArray()), numbers(cells.GetConnectivityArray())]
    return result


def image_arrays(data):
    """Of symmetric quads: what becomes of what, about what, and where the quads lie on the input."""
    result = []
    for leaf in leaves(data):
        names = ("MirrorPoint", "RotatedPoint", "SymmetryOrigin", "SymmetryNormal", "SymmetryDirection",
                 "SymmetryDeviation", "SymmetryMovedPoints", "SymmetryFarthestMoved")
        arrays = [(leaf.GetPointData().GetArray(name) or leaf.GetFieldData().GetArray(name)) for name in names
                  ] if leaf is not None else []
        if any(arrays):
            result += [numbers(array) for array in arrays]
            result += [numbers(leaf.GetPointData().GetArray(name)) for name in ("SourcePointIds", "SourceBarycentric")]
    return result


def map_arrays(data):
    result = []
    for leaf in leaves(data):
        if leaf is not None and leaf.GetPoints():
            result += [numbers(leaf.GetPoints().GetData()), numbers(leaf.GetCellData().GetArray("IGM")),
                       numbers(leaf.GetCellData().GetArray("Matching"))]
    return result


def silence(*sources):
    """What is reported goes into the record, not to the terminal."""
    for source in sources:
        for kind in ("ErrorEvent", "WarningEvent"):
            source.AddObserver(kind, lambda caller, event: None)
            source.GetExecutive().AddObserver(kind, lambda caller, event: None)


def set_requests(run, requests, defaults):
    """Properties that an earlier step had and this one does not name go back to their defaults."""
    for name, value in {**defaults, **requests}.items():
        if name[0].isupper() and hasattr(run, f"Set{name}"):
            defaults.setdefault(name, getattr(run, f"Get{name}")())
            getattr(run, f"Set{name}")(value)


def step_record(run, outputs, surface_output, seconds):
    data = run.GetOutputDataObject(0)
    texts = {"text": run.GetOutcomeText(), "notices": run.GetNoticesText()}
    return {
        "status": OUTCOMES[run.GetOutcome()], **{key: value.strip() for key, value in texts.items()},
        "reused": run.GetReusedStagesText().strip() if hasattr(run, "GetReusedStagesText") else "",
        "count": sum(leaf.GetNumberOfPolys() for leaf in leaves(data) if leaf is not None),
        "quads": sum_of(*mesh_arrays(data), *image_arrays(data)), "map": sum_of(*map_arrays(surface_output)),
        "drawn": sum_of(*(array for port in outputs for array in mesh_arrays(run.GetOutputDataObject(port)))),
        "tries": tries_of(data), "seconds": round(seconds, 3)}


def tries_of(data):
    """Of the ledger: name -> how often tried, and how often that is used."""
    tries = {}
    for leaf in leaves(data):
        fields = leaf.GetFieldData() if leaf is not None else None
        names = fields.GetAbstractArray("TryNames") if fields is not None else None
        for i in range(names.GetNumberOfValues() if names else 0):
            counts = tries.setdefault(names.GetValue(i), [0, 0])
            for k, array in enumerate(("TriesTaken", "TriesLed")):
                counts[k] += int(fields.GetArray(array).GetTuple1(i))
    return tries


def with_one_filter(surface, run, steps):
    """The same vtkQuadRemesh for all steps, behind a source whose output changes, as in a pipeline."""
    import quadrille
    from vtkmodules.vtkCommonExecutionModel import vtkTrivialProducer
    source, remesh, defaults, made = vtkTrivialProducer(), quadrille.vtkQuadRemesh(), {}, {}
    silence(remesh)
    remesh.SetInputConnection(source.GetOutputPort())
    before = dict.fromkeys(PORTS)
    for name, requests in steps:
        set_requests(remesh, requests, defaults)
        source.SetOutput(with_arrays(surface, requests))
        for request, port in PORTS.items():
            kind = requests.get(request)
            if kind != before[request]:
                made.setdefault(kind, drawn(kind, surface) if kind is not None else None)
                getattr(remesh, f"Set{port}Data")(made[kind])
                before[request] = kind
        begin = time.process_time()
        remesh.Update()
        yield name, step_record(remesh, range(2, 6), remesh.GetOutputDataObject(1), time.process_time() - begin)


def with_new_filters(surface, run, steps):
    for step in steps:
        yield from with_one_filter(surface, run, [step])


def with_chain(surface, run, steps):
    """The four stage filters one after the other."""
    import quadrille
    for name, requests in steps:
        hierarchy, grid, upmap, extraction = (getattr(quadrille, kind)() for kind in (
            "vtkDecimationHierarchy", "vtkIntegerGridMap", "vtkIntegerGridMapUpmap", "vtkQuadExtraction"))
        filters = (hierarchy, grid, upmap, extraction)
        surface = with_arrays(surface, requests)
        hierarchy.SetInputData(surface)
        grid.SetInputConnection(hierarchy.GetOutputPort(0))
        upmap.SetInputConnection(grid.GetOutputPort())
        upmap.SetInputData(1, surface)
        upmap.SetLogConnection(hierarchy.GetOutputPort(2))
        upmap.SetIntermediateConnection(hierarchy.GetOutputPort(1))
        extraction.SetInputConnection(upmap.GetOutputPort())
        silence(*filters)
        begin = time.process_time()
        for stage in filters:
            set_requests(stage, requests, {})
            stage.Update()
            if stage.GetOutcome() != 1 or stage is extraction:
                break
        record = step_record(stage, range(1, stage.GetNumberOfOutputPorts()) if stage is extraction else (),
                             upmap.GetOutputDataObject(0), time.process_time() - begin)
        record["notices"] = "\n".join(line for one in filters for line in [one.GetNoticesText().strip()] if line)
        yield name, record


def with_extraction(surface, run, steps):
    """The quads of a map that another program made."""
    import quadrille
    for name, requests in steps:
        extraction = quadrille.vtkQuadExtraction()
        silence(extraction)
        set_requests(extraction, requests, {})
        extraction.SetInputData(surface)
        begin = time.process_time()
        extraction.Update()
        yield name, step_record(extraction, range(1, 3), surface, time.process_time() - begin)


MAKERS = {"one filter": with_one_filter, "new filters": with_new_filters, "chain": with_chain,
          "extraction": with_extraction}


def make_run(run, shared):
    """What is recorded of a run; in its own process."""
    steps = [(name, {"NumberOfThreads": 1, **run.base, **requests}) for name, requests in run.steps]
    record = {"steps": dict(MAKERS[run.make](surface_of(run.mesh, shared), run, steps))}
    record["seconds"] = round(sum(step["seconds"] for step in record["steps"].values()), 3)
    record["peak_megabytes"] = round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, 1)
    return record


# --- record -----------------------------------------------------------------------------------------------------------

def recorded_in_process(run, arguments):
    packages = pathlib.Path(arguments.python).resolve() / "lib/python3/dist-packages"
    # Beside the build plain VTK may be on the path, which Python does not find by itself.
    folders = [str(packages), *filter(None, [os.environ.get("PYTHONPATH")])]
    command = [sys.executable, __file__, "run", run.name, "--shared", str(arguments.shared)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=RUN_LIMIT,
                              env={**os.environ, "PYTHONPATH": os.pathsep.join(folders)})
    except subprocess.TimeoutExpired:
        return {"steps": {"": {"status": f"stopped after {RUN_LIMIT} s"}}}
    try:
        return json.loads(done.stdout.splitlines()[-1]) if done.returncode == 0 else {
            "steps": {"": {"status": f"exit code {done.returncode}", "text": done.stderr[-2000:]}}}
    except (ValueError, IndexError):
        return {"steps": {"": {"status": "no record", "text": (done.stdout + done.stderr)[-2000:]}}}


SUMS = ("quads", "map", "drawn")


def unequal(runs, record):
    """Lines for runs that must have the sums of another and do not. The chain has other lines. After a failure the
    outputs hold what the filter made before, so that only the status counts."""
    lines = []
    for run in runs:
        other = record.get(run.same_as)
        if other is None or run.name not in record:
            continue
        for name, step in record[run.name]["steps"].items():
            keys = (("status",) if step["status"] != "succeeded"
                    else ("quads", "status") if run.make == "chain" else (*SUMS, "status"))
            wrong = [key for key in keys if step.get(key) != other["steps"].get(name, {}).get(key)]
            if wrong:
                lines.append(f"{run.name}, {name or 'the only step'}: other {', '.join(wrong)} than {run.same_as}")
    return lines


def record(arguments):
    runs, missing = all_runs(arguments.shared)
    runs = [run for run in runs if (run.quick or not arguments.quick) and re.search(arguments.only, run.name)]
    if not arguments.quick:
        print("\n".join(missing), end="\n" if missing else "")
    begin, made = time.perf_counter(), {}
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        # Long ones first, so that none is left over at the end.
        waiting = {pool.submit(recorded_in_process, run, arguments): run
                   for run in sorted(runs, key=lambda r: -len(r.steps))}
        for done in concurrent.futures.as_completed(waiting):
            run = waiting[done]
            made[run.name] = done.result()
            statuses = {step["status"] for step in made[run.name]["steps"].values()}
            print(f"{made[run.name].get('seconds', 0):7.2f} s {made[run.name].get('peak_megabytes', 0):8.1f} MB  "
                  f"{run.name}: {', '.join(sorted(statuses))}", flush=True)
    pathlib.Path(arguments.file).write_text(json.dumps(made, indent=1, sort_keys=True) + "\n")
    lines = unequal(runs, made)
    print("\n".join(lines), end="\n" if lines else "")
    print(f"{len(made)} runs with {sum(len(run['steps']) for run in made.values())} steps in "
          f"{time.perf_counter() - begin:.0f} s; {len(lines)} that must be equal are not")
    return 1 if lines else 0


# --- compare ----------------------------------------------------------------------------------------------------------

def differences(old, new):
    """What differs between two steps and must not, and what is only told."""
    wrong = [f"other {key} ({old.get('count')} before, {new.get('count')} now)" for key in SUMS
             if old.get(key) != new.get(key)]
    if old.get("status") != new.get("status"):
        wrong.append(f"{old.get('status')} before, {new.get('status')} now")
    if old.get("text") != new.get("text"):
        wrong.append(f"other text:\n    - {old.get('text')}\n    + {new.get('text')}")
    told = []
    for key in ("notices", "reused"):
        before, now = ((step.get(key) or "").splitlines() for step in (old, new))
        told += [f"{key}: - {line}" for line in before if line not in now]
        told += [f"{key}: + {line}" for line in now if line not in before]
        if sorted(before) == sorted(now) and before != now:
            told.append(f"{key}: other order")
    return wrong, told


def compare_runs(old, new):
    wrong, told = [], []
    for name in sorted(old.keys() & new.keys()):
        before, now = old[name]["steps"], new[name]["steps"]
        for step in {**before, **now}:
            place = f"{name}, {step}" if step else name
            if step not in before or step not in now:
                wrong.append(f"{place}: only in {'OLD' if step in before else 'NEW'}")
                continue
            one, other = differences(before[step], now[step])
            wrong += [f"{place}: {line}" for line in one]
            told += [f"{place}: {line}" for line in other]
    return wrong, told


def compare_cost(old, new):
    """Lines about memory and time."""
    pairs = {name: (old[name], new[name]) for name in sorted(old.keys() & new.keys())
             if "peak_megabytes" in old[name] and "peak_megabytes" in new[name]}
    if not pairs:
        return ["no memory to compare"]
    lines = [f"{name}: peak memory {a['peak_megabytes']} MB before, {b['peak_megabytes']} MB now"
             for name, (a, b) in pairs.items()
             if b["peak_megabytes"] > MEMORY_TOLERANCE * a["peak_megabytes"]]
    peaks = [statistics.median(pair[k]["peak_megabytes"] for pair in pairs.values()) for k in (0, 1)]
    sums = [sum(pair[k]["seconds"] for pair in pairs.values()) for k in (0, 1)]
    lines.append(f"peak memory, median of {len(pairs)} runs: {peaks[0]:.1f} MB before, {peaks[1]:.1f} MB now, ratio "
                 f"{peaks[1] / peaks[0]:.3f}; {len(lines)} runs more than 3 % above")
    lines.append(f"seconds in filters: {sums[0]:.1f} before, {sums[1]:.1f} now")
    return lines


def compare(arguments):
    old, new = (json.loads(pathlib.Path(name).read_text()) for name in (arguments.old, arguments.new))
    wrong, told = compare_runs(old, new)
    only_old, only_new = sorted(old.keys() - new.keys()), sorted(new.keys() - old.keys())
    if not arguments.common:
        wrong += [f"{name}: not in NEW" for name in only_old]
    told += [f"{name}: not in OLD" for name in only_new]
    both = len(old.keys() & new.keys())
    if not both:
        wrong.append("there is no run that both have")
    for title, lines in (("DIFFERENT", wrong), ("told otherwise", told), ("cost", compare_cost(old, new))):
        print("\n".join([f"{title}:"] + [f"  {line}" for line in lines]) if lines else f"{title}: nothing")
    print(f"{both} runs compared: {'DIFFERENT' if wrong else 'equal'}")
    return 1 if wrong else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    actions = parser.add_subparsers(dest="action", required=True)
    one, two, three = actions.add_parser("record"), actions.add_parser("compare"), actions.add_parser("list")
    hidden = actions.add_parser("run")
    one.add_argument("file")
    one.add_argument("--python", required=True, metavar="BUILD", help="build folder")
    one.add_argument("--jobs", type=int, default=2)
    one.add_argument("--quick", action="store_true", help="a small part of the list, on Data/ only")
    one.add_argument("--only", default="", metavar="REGEX", help="runs whose names match")
    two.add_argument("old")
    two.add_argument("new")
    two.add_argument("--common", action="store_true", help="compare the runs that both have")
    hidden.add_argument("name")
    for action in (one, three, hidden):
        action.add_argument("--shared", type=pathlib.Path, default=ROOT.parent / "shared/data")
    arguments = parser.parse_args()
    if arguments.action == "compare":
        return compare(arguments)
    if arguments.action == "record":
        return record(arguments)
    runs, missing = all_runs(arguments.shared)
    if arguments.action == "list":
        print("\n".join([run.name for run in runs] + missing))
        return 0
    print(json.dumps(make_run(next(run for run in runs if run.name == arguments.name), arguments.shared)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
