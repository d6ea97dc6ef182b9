# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Quad Remesh on what ParaView's own sources and filters make, with default settings but for the number of quads.

GROUP: contours, cuts or shapes (see paraview_surfaces.py). Each surface has to give valid quads, or a message that
names a place. With --full at the default of 5,000 quads, each in less than five seconds; without, fewer quads, and the
larger ones of the surfaces are left out.
"""
import time

import numpy

import quick_start  # before simple
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

from paraview_surfaces import surfaces
from plugin_common import PLUGIN, check, number

SMALL_QUADS = 2000
MOST_SECONDS = 5
MOST_MESSAGES = 2
# Left out of the small run: as these, but larger.
LARGE = ("wavelet_20_", "gyroid_20", "tangle_20", "perlin_20", "threshold_fine", "clustering")


def faces_of(data):
    """Polygons with their corners, all of one size."""
    connectivity = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    sizes = numpy.diff(vtk_to_numpy(data.GetPolys().GetOffsetsArray()))
    check(len(sizes) > 0 and sizes.min() == sizes.max(), "faces of several sizes")
    return connectivity.reshape(len(sizes), -1)


def topology_of(faces):
    """Euler characteristic, boundary edges, components, and whether it is an oriented manifold."""
    corners = faces.shape[1]
    sides = numpy.stack([faces, numpy.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    oriented = numpy.unique(sides, axis=0).shape[0] == sides.shape[0]
    edges, uses = numpy.unique(numpy.sort(sides, axis=1), axis=0, return_counts=True)
    points = int(faces.max()) + 1
    valence = numpy.bincount(edges.ravel(), minlength=points)
    around = numpy.bincount(faces.ravel(), minlength=points)
    on_boundary = numpy.zeros(points, bool)
    on_boundary[edges[uses == 1].ravel()] = True
    one_fan = numpy.array_equal(valence, numpy.where(on_boundary, around + 1, around))
    distinct = all(len(set(face)) == corners for face in faces.tolist())
    return {"euler": int((valence > 0).sum()) - len(edges) + len(faces), "boundary": int((uses == 1).sum()),
            "manifold": bool(oriented and one_fan and distinct and uses.max() <= 2)}


def area_of(points, faces):
    total = 0.0
    for k in range(1, faces.shape[1] - 1):
        a, b, c = points[faces[:, 0]], points[faces[:, k]], points[faces[:, k + 1]]
        total += numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1).sum() / 2
    return total


def turned_over(points, quads):
    """Quads of which a corner is reflex."""
    corners = [points[quads[:, i]] for i in range(4)]
    normal = numpy.cross(corners[2] - corners[0], corners[3] - corners[1])
    least = numpy.full(len(quads), numpy.inf)
    for i in range(4):
        turn = numpy.cross(corners[i] - corners[i - 1], corners[(i + 1) % 4] - corners[i])
        least = numpy.minimum(least, (turn * normal).sum(axis=1))
    return int((least <= 0).sum())


def faults_of(quads, mapped):
    """What is wrong with the quads, against the surface as it was mapped (repaired, refined, the same in shape)."""
    faces, triangles = faces_of(quads), faces_of(mapped)
    if faces.shape[1] != 4:
        return ["not all faces are quads"]
    points = vtk_to_numpy(quads.GetPoints().GetData()).astype(float)
    places = vtk_to_numpy(mapped.GetPoints().GetData()).astype(float)
    made, wanted = topology_of(faces), topology_of(triangles)
    faults = [f"{key} {made[key]} instead of {wanted[key]}" for key in ("euler", "manifold")
              if made[key] != wanted[key]]
    if (made["boundary"] > 0) != (wanted["boundary"] > 0):
        faults.append("open or closed by mistake")
    ratio = area_of(points, faces) / area_of(places, triangles)
    if not 0.85 < ratio < 1.15:
        faults.append(f"{ratio:.2f} of the area")
    over = turned_over(points, faces)
    if over > max(2, 0.005 * len(faces)):
        faults.append(f"{over} of {len(faces)} quads turned over")
    return faults


def remesh(source, quads):
    """Quads and mapped surface, or None twice, with seconds and the message."""
    remesher = QuadRemesh(Input=source, TargetType="Number Of Quads", NumberOfQuads=quads, TextureCoordinates=0)
    start = time.monotonic()
    remesher.UpdatePipeline()
    seconds = time.monotonic() - start
    outcome = number(remesher, "OutcomeText") or ""
    made = servermanager.Fetch(remesher, idx=0)
    mapped = servermanager.Fetch(servermanager.OutputPort(remesher, 1))
    return (made if made.GetNumberOfCells() > 0 else None), mapped, seconds, outcome


def run(group, full, names):
    faults, messages, slow, count = [], [], [], 0
    for name, make in surfaces(simple)[group].items():
        if (names and name not in names) or (not names and not full and name.startswith(LARGE)):
            continue
        source = make()
        source.UpdatePipeline()
        count += 1
        quads, mapped, seconds, outcome = remesh(source, 5000 if full else SMALL_QUADS)
        if quads is None:
            messages.append(name)
            if " near (" not in outcome and " at (" not in outcome:
                faults.append(f"{name}: no quads, and a message without a place: {outcome}")
        else:
            faults += [f"{name}: {fault}" for fault in faults_of(quads, mapped)]
        slow += [name] if seconds > MOST_SECONDS else []
        print(f"{name}: {quads.GetNumberOfCells() if quads else outcome} {seconds:.1f} s", flush=True)
    print(f"{count} surfaces, {len(messages)} without quads {messages}, slower than {MOST_SECONDS} s: {slow}")
    print("\n".join(faults))
    check(count > 0, f"no surface of {group} has a name of {names}")
    check(not faults, f"{len(faults)} faults")
    check(len(messages) <= MOST_MESSAGES, f"too many without quads: {messages}")
    check(not full or not slow, f"slow: {slow}")


def main(words):
    """words: GROUP [--full] [NAME...]"""
    simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
    run(words[0], "--full" in words, [word for word in words[1:] if word != "--full"])
