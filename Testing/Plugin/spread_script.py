# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Run by every rank, see test_spread.py: spread_script.py CASE..."""
import itertools
import os
import sys
import time

import numpy as np
import quadrille
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkCommonDataModel import vtkPolyData

from spread_common import (CONTROLLER, RANK, RANKS, Joined, add, arrays_of, box, euler, gather, icosphere, piece,
                           plane, random_blobs, random_faces, sphere, stripes, sum_of_piece, surface, torus)

ALWAYS, NEVER = 1, 2
SUCCEEDED, BAD_INPUT, NO_RESULT, ABORTED, TIMED_OUT = 1, 2, 3, 4, 5


def check(fine, what):
    """Ends all ranks where it does not hold on one."""
    if not fine:
        print(f"FAILED on rank {RANK}: {what}", flush=True)
        os._exit(1)


def remesher(data, quads=300, **properties):
    remesh = quadrille.vtkQuadRemesh()
    remesh.SetInputDataObject(0, data)
    remesh.SetNumberOfQuads(quads)
    remesh.SetSpreadSurfaces(ALWAYS)
    remesh.SetNumberOfThreads(1)
    for name, value in properties.items():
        getattr(remesh, "Set" + name)(value)
    return remesh


def run(remesh, ghost_levels=0):
    remesh.UpdatePiece(RANK, RANKS, ghost_levels)
    return remesh.GetOutputDataObject(0)


def same_on_all(text, what):
    """Compares a text with that of rank 0."""
    note = vtkPolyData()
    quadrille_texts = np.frombuffer(text.encode() + b"\0", np.uint8)
    add(note.GetFieldData(), "text", quadrille_texts)
    parts = gather(note)
    for rank, part in enumerate(parts or []):
        other = vtk_to_numpy(part.GetFieldData().GetArray("text"))
        check(np.array_equal(other, quadrille_texts), f"{what} differs on rank {rank}")


def joined(remesh, what, characteristic=None, ghost_levels=0):
    """The mesh of all ranks on rank 0, checked; None elsewhere."""
    quads = run(remesh, ghost_levels)
    check(remesh.GetOutcome() == SUCCEEDED, f"{what}: {remesh.GetOutcomeText()}")
    same_on_all(remesh.GetNoticesText() + remesh.GetResultText(), f"{what}: what is told")
    return mesh_of(quads, remesh.GetActualQuads(), what, characteristic)


def mesh_of(quads, count, what, characteristic=None):
    """Of the quads that each rank has, and their number."""
    copy = vtkPolyData()
    copy.ShallowCopy(quads)
    copy.GetFieldData().Initialize()
    parts = gather(copy)
    if parts is None:
        return None
    try:
        mesh = Joined(parts)
        mesh.check_manifold(2 if characteristic is None else characteristic)
        if sum(sum_of_piece(part) for part in parts) != mesh.sum_of_quads():
            raise AssertionError("the sum of the pieces is not that of the mesh")
        if len(mesh.quads) != count:
            raise AssertionError(f"{len(mesh.quads)} quads, {count} are told")
    except AssertionError as error:
        check(False, f"{what}: {error}")
    return mesh


SHAPES = {"sphere": sphere, "torus": torus, "plane": plane, "box": box}


def splits(shapes, count):
    """Random splits of small surfaces, by blobs and face by face."""
    for name in shapes:
        points, triangles = SHAPES[name]()
        characteristic = euler(triangles)
        for seed in range(count):
            rng = np.random.default_rng(seed)
            split = random_faces if seed % 3 == 2 else random_blobs
            part = split(points, triangles, RANKS, rng)
            data, used, faces = piece(points, triangles, part == RANK)
            mesh = joined(remesher(data, 150 + 10 * seed), f"{name}, split {seed}", characteristic)
            if mesh is not None:
                print(f"{name} {seed}: {len(mesh.quads)} quads", flush=True)


def stripe(points, triangles):
    return piece(points, triangles, stripes(points, triangles, RANKS) == RANK)


def repeat():
    """The same bytes on every repetition, with any number of threads."""
    for split in (stripes, lambda p, t, n: random_faces(p, t, n, np.random.default_rng(3))):
        points, triangles = sphere(60)
        data, used, faces = piece(points, triangles, split(points, triangles, RANKS) == RANK)
        digests = []
        for threads in (1, 1, 2):
            mesh = joined(remesher(data, 500, NumberOfThreads=threads), "repetition")
            digests.append(mesh.digest() if mesh else "")
        check(len(set(digests)) == 1, "repetitions differ")


def dense():
    """Far more faces than the quads need: what is gathered grows with the quads only."""
    gathered = []
    for rows in (60, 120, 240):
        points, triangles = sphere(rows)
        data, used, faces = stripe(points, triangles)
        remesh = remesher(data, 400)
        joined(remesh, f"{rows} rows")
        figures = remesh.GetOutputDataObject(0).GetFieldData().GetArray("SpreadFigures")
        names = [figures.GetComponentName(i) for i in range(figures.GetNumberOfComponents())]
        values = vtk_to_numpy(figures)
        check(values.shape[0] == RANKS, "the figures are not of all ranks")
        check(values[:, names.index("faces")].sum() == len(triangles), "faces are missing in the figures")
        gathered.append((values[:, names.index("gathered_bytes")].sum(), len(triangles)))
    (first, few), _, (last, many) = gathered
    # Boundaries of pieces are as long as the square root of the faces; the rest is a matter of the quads.
    check(last / first < 1.2 * (many / few) ** 0.5,
          f"{first:.0f} bytes are gathered of {few} faces, {last:.0f} of {many}")


def scattered():
    """Faces dealt out at random are redistributed; ids of cells are then still those of the user."""
    points, triangles = sphere(120)
    part = random_faces(points, triangles, RANKS, np.random.default_rng(5))
    data, used, faces = piece(points, triangles, part == RANK)
    add(data.GetCellData(), "face", faces.astype(np.int64))
    remesh = remesher(data, 300)
    joined(remesh, "scattered faces")
    check(("redistributed" in remesh.GetNoticesText()) == (RANKS > 1), "the pieces were not redistributed")
    quads = remesh.GetOutputDataObject(0)
    if RANKS == 1 or quads.GetNumberOfCells() == 0:
        return
    cells = quads.GetCellData()
    rank, cell = vtk_to_numpy(cells.GetArray("SourceRank")), vtk_to_numpy(cells.GetArray("SourceCellId"))
    face = vtk_to_numpy(cells.GetArray("face"))
    of_rank = [np.flatnonzero(part == r) for r in range(RANKS)]
    check(all(of_rank[r][c] == f for r, c, f in zip(rank, cell, face)), "SourceCellId is not the user's")
    check(not quads.GetPointData().HasArray("SourcePointIds"), "SourcePointIds mean nothing here")


def attributes():
    """Arrays come from the pieces, whatever rank needs them."""
    points, triangles = sphere(90)
    data, used, faces = stripe(points, triangles)
    slope = np.array([1.0, -2.0, 0.5])
    add(data.GetPointData(), "linear", points[used] @ slope)
    add(data.GetPointData(), "label", used.astype(np.int64))
    add(data.GetCellData(), "face", faces.astype(np.int64))
    add(data.GetCellData(), "height", points[triangles[faces]].mean(1)[:, 2])
    data.GetPointData().SetActiveScalars("linear")
    if RANK == 0 and len(used):
        add(data.GetPointData(), "only here", used.astype(np.float32))
    remesh = remesher(data, 400)
    joined(remesh, "arrays", ghost_levels=1)
    check(("missing on some pieces" in remesh.GetNoticesText()) == (RANKS > 1), "a missing array is not told")
    quads = remesh.GetOutputDataObject(0)
    if quads.GetNumberOfCells() == 0:
        return
    where = vtk_to_numpy(quads.GetPoints().GetData())
    got = vtk_to_numpy(quads.GetPointData().GetArray("linear"))
    check(np.abs(got - where @ slope).max() < 1e-12, "a linear array is not interpolated on the pieces")
    check(quads.GetPointData().GetScalars().GetName() == "linear", "the active scalars are others")
    corners = vtk_to_numpy(quads.GetPolys().GetConnectivityArray()).reshape(-1, 4)
    centres, face = where[corners].mean(1), vtk_to_numpy(quads.GetCellData().GetArray("face"))
    size = np.sqrt(4 * np.pi / 400)
    apart = np.linalg.norm(centres - points[triangles[face]].mean(1), axis=1)
    check(apart.max() < 0.5 * size, f"the face under a quad's centre is {apart.max() / size:.2f} of an edge away")
    height = vtk_to_numpy(quads.GetCellData().GetArray("height"))
    check(np.array_equal(height, points[triangles[face]].mean(1)[:, 2]), "cell arrays are of different cells")
    # Every point lies on the surface of the input, not on its thinned pieces: the chords of 90 rows.
    radius = np.linalg.norm(where, axis=1)
    check(radius.max() <= 1 + 1e-12 and radius.min() > np.cos(np.pi / 90) ** 2 - 1e-9, "points left the surface")
    own = vtk_to_numpy(quads.GetPointData().GetArray("SourceRank")) == RANK
    ids = vtk_to_numpy(quads.GetPointData().GetArray("SourcePointIds"))[own]
    weights = vtk_to_numpy(quads.GetPointData().GetArray("SourceBarycentric"))[own]
    again = (points[used][ids] * weights[:, :, None]).sum(1)
    check(np.abs(again - where[own]).max() < 1e-12, "SourcePointIds and SourceBarycentric are of other points")


def ids():
    """Global ids of the input decide which points are one: here those of pieces are not at the same place."""
    points, triangles = sphere(30)
    part = random_blobs(points, triangles, RANKS, np.random.default_rng(2))
    data, used, faces = piece(points * (1 + 1e-5 * RANK), triangles, part == RANK)
    data.GetPointData().SetGlobalIds(add(data.GetPointData(), "ids", 7 * used.astype(np.int64)))
    joined(remesher(data, 400), "global ids")
    if RANKS > 1:  # without them the pieces are no sphere
        plain = piece(points * (1 + 1e-5 * RANK), triangles, part == RANK)[0]
        remesh = remesher(plain, 400)
        quads = run(remesh)
        boundary = quads.GetPointData().GetArray("OnBoundary")
        check(remesh.GetOutcome() != SUCCEEDED or not boundary or np.any(vtk_to_numpy(boundary)),
              "pieces are joined where they do not meet")


def constraints():
    """Sizes, valences, features and patches of the pieces."""
    points, triangles = plane(60, lambda x, y: 0 * x)
    data, used, faces = stripe(points, triangles)
    valences = np.zeros(len(used), np.int32)
    wanted = np.array([0.3, 0.3, 0.0])
    valences[np.linalg.norm(points[used] - wanted, axis=1) < 1e-9] = 3
    other = np.array([0.7, 0.7, 0.0])
    valences[np.linalg.norm(points[used] - other, axis=1) < 1e-9] = 5
    add(data.GetPointData(), "TargetValence", valences)
    mesh = joined(remesher(data, 400), "valences", 1)
    if mesh is not None:
        count = np.bincount(mesh.quads.ravel(), minlength=len(mesh.points))
        for place, valence in ((wanted, 3), (other, 5)):
            nearest = np.argmin(np.linalg.norm(mesh.points - place, axis=1))
            check(np.linalg.norm(mesh.points[nearest] - place) < 1e-9 and count[nearest] == valence,
                  f"valence {valence} is not at its place")
    data, used, faces = stripe(points, triangles)
    add(data.GetPointData(), "Sizing", np.where(points[used][:, 1] < 0.5, 0.5, 1.0).astype(np.float32))
    mesh = joined(remesher(data, 400), "sizes", 1)
    if mesh is not None:
        low = (mesh.points[mesh.quads].mean(1)[:, 1] < 0.5).sum()
        check(low > 2.5 * (len(mesh.quads) - low), f"{low} of {len(mesh.quads)} quads where they are to be smaller")
    # The border of two patches along a line that the pieces cross, and along the border of two pieces.
    for axis in (0, 1):
        data, used, faces = stripe(points, triangles)
        centres = points[triangles[faces]].mean(1)
        add(data.GetCellData(), "PatchId", (centres[:, axis] > 0.5).astype(np.int32))
        mesh = joined(remesher(data, 300), f"patches along {axis}", 1)
        if mesh is not None:
            line = mesh.points[np.abs(mesh.points[:, axis] - 0.5) < 1e-9]
            check(len(line) >= 10, f"the border of the patches is not followed: {len(line)} points on it")
            across = (mesh.points[mesh.quads][:, :, axis] - 0.5)
            crossing = np.minimum(-across.min(1), across.max(1))
            check(crossing.max() < 1e-6, f"quads cross the border of patches along {axis} by {crossing.max()}: "
                  f"{across[np.argmax(crossing)]}")
    # What cannot be had is refused on all ranks alike.
    data, used, faces = stripe(points, triangles)
    add(data.GetCellData(), "GuidingDirection", np.tile([1.0, 1.0, 0.0], (len(faces), 1)))
    fails(remesher(data, 300), BAD_INPUT, "Spread Surfaces to Never", "guides on cells")
    fails(remesher(stripe(points, triangles)[0], 300, Symmetry=2), BAD_INPUT, "Spread Surfaces to Never", "symmetry")


def features():
    """Sharp edges along borders of pieces and inside of them."""
    points, triangles = box(24)
    for seed in range(4):
        part = random_blobs(points, triangles, RANKS, np.random.default_rng(seed))
        data, used, faces = piece(points, triangles, part == RANK)
        mesh = joined(remesher(data, 400), f"box {seed}")
        if mesh is not None:
            on = (np.abs(mesh.points) < 1e-6) | (np.abs(mesh.points - 1) < 1e-6)
            check(on.any(1).all(), "points left the box")
            check((on.sum(1) == 3).sum() == 8, "corners of the box are missing")
            sides = mesh.points[mesh.quads]
            flat = [(np.abs(sides[:, :, a] - s) < 1e-6).all(1) for a in range(3) for s in (0, 1)]
            check(np.any(flat, axis=0).all(), "quads cross the edges of the box")


def ghosts():
    """Rings of ghost cells, as VTK's own generator makes them of the global ids; filters that need them work."""
    from vtkmodules.vtkFiltersParallelDIY2 import vtkGhostCellsGenerator
    points, triangles = torus(40)
    data, used, faces = stripe(points, triangles)
    add(data.GetPointData(), "height", points[used][:, 2].copy())
    plain = vtkPolyData()
    remesh = remesher(data, 600)
    joined(remesh, "torus", 0)
    plain.ShallowCopy(remesh.GetOutputDataObject(0))
    for levels in (1, 2):
        mine = run(remesher(data, 600), levels)
        generator = vtkGhostCellsGenerator()
        generator.SetInputDataObject(plain)
        generator.SetNumberOfGhostLayers(levels)
        generator.BuildIfRequiredOff()
        generator.UpdatePiece(RANK, RANKS, 0)
        theirs = generator.GetOutputDataObject(0)
        for kind, own, other in (("cell", mine.GetCellData(), theirs.GetCellData()),
                                 ("point", mine.GetPointData(), theirs.GetPointData())):
            name = "GlobalCellIds" if kind == "cell" else "GlobalPointIds"
            got, wanted = (sorted(zip(vtk_to_numpy(d.GetArray(name)).tolist())) for d in (own, other))
            check(got == wanted, f"{levels} levels: {kind}s differ from those of VTK's generator")
        flags = {}
        for data_set in (mine, theirs):
            cells = data_set.GetCellData()
            ghost = cells.GetArray("vtkGhostType")
            check(ghost is not None or RANKS == 1, "there are no ghost cells")
            if ghost:
                flags[data_set] = sorted(zip(vtk_to_numpy(cells.GetArray("GlobalCellIds")).tolist(),
                                             (vtk_to_numpy(ghost) & 1).tolist()))
        check(len(flags) < 2 or flags[mine] == flags[theirs], "other cells are ghosts")


def sums():
    """A filter over all ranks counts nothing twice: the area of the quads."""
    from vtkmodules.vtkFiltersParallel import vtkIntegrateAttributes
    points, triangles = sphere(60)
    data, used, faces = stripe(points, triangles)
    for levels in (0, 2):
        quads = run(remesher(data, 500), levels)
        integrate = vtkIntegrateAttributes()
        integrate.SetInputDataObject(quads)
        integrate.UpdatePiece(RANK, RANKS, 0)
        if RANK == 0:
            area = integrate.GetOutput().GetCellData().GetArray("Area").GetValue(0)
            check(abs(area / (4 * np.pi) - 1) < 0.03, f"the area is {area}, that of a sphere is {4 * np.pi}")


def fails(remesh, outcome, text, what):
    run(remesh)
    check(remesh.GetOutcome() == outcome, f"{what}: outcome {remesh.GetOutcome()}, {remesh.GetOutcomeText()}")
    check(text in remesh.GetOutcomeText(), f"{what}: '{text}' is not in '{remesh.GetOutcomeText()}'")
    same_on_all(remesh.GetOutcomeText(), what)


def last():
    return RANKS - 1


def damaged(kind):
    points, triangles = sphere(24)
    data, used, faces = stripe(points, triangles)
    if RANK != last():
        return data
    if kind == "number":
        data.GetPoints().SetPoint(5, float("nan"), 0, 0)
    else:
        data.GetPolys().GetConnectivityArray().SetValue(7, 10 ** 6)
        data.GetPolys().Modified()
    return data


def faults():
    named = f"rank {last()}: " if RANKS > 1 else ""
    fails(remesher(damaged("number")), BAD_INPUT, named + "point 5", "a point that is no number")
    fails(remesher(damaged("id")), BAD_INPUT, named, "an id out of range")
    # Too little memory on one rank, and the result before is kept; with memory it is made.
    points, triangles = sphere(60)
    data, used, faces = stripe(points, triangles)
    remesh = remesher(data, 300)
    before = joined(remesh, "before the fault")
    remesh.SetNumberOfQuads(350)
    if RANK == last():
        remesh.SetMemoryLimit(0.1)
    fails(remesh, NO_RESULT, named + "the pieces of the surface take", "memory")
    check("previous result is kept" in remesh.GetOutcomeText(), remesh.GetOutcomeText())
    copy = vtkPolyData()
    copy.ShallowCopy(remesh.GetOutputDataObject(0))
    copy.GetFieldData().Initialize()
    parts = gather(copy)
    check(parts is None or Joined(parts).digest() == before.digest(), "the result before is not kept")
    remesh.SetMemoryLimit(0)
    remesh.Modified()  # on all ranks
    joined(remesh, "with memory again")
    # Ranks without data, all of it on one rank, a piece of one triangle, and nothing anywhere.
    points, triangles = sphere(24)
    for name, part in (("all on the last", np.full(len(triangles), last())), ("all on the first", 0 * triangles[:, 0]),
                       ("one triangle", (np.arange(len(triangles)) == 100) * last())):
        mine = part == RANK
        data = piece(points, triangles, mine)[0] if mine.any() else vtkPolyData()
        joined(remesher(data, 200), name)
    fails(remesher(vtkPolyData()), BAD_INPUT, "", "nothing anywhere")
    fails(remesher(stripe(points, triangles)[0], -1), BAD_INPUT, "NumberOfQuads", "a property")


class Stop:
    """Asks the filter to stop, once, when it reports progress for the first time from some progress, or some seconds,
    on."""

    def __init__(self, remesh, begin, after=0, text=""):
        self.begin, self.time, self.text, self.is_done = begin, time.time() + after, text, False
        remesh.AddObserver(vtkCommand.ProgressEvent, self.look)

    def look(self, caller, event):
        is_far = caller.GetProgress() >= self.begin and self.text in (caller.GetProgressText() or "")
        if is_far and time.time() >= self.time and not self.is_done:
            self.is_done = True
            caller.SetAbortExecute(1)


def cancel():
    """A stop on any rank ends all, before, while and after the quads are made; then all is as before."""
    points, triangles = sphere(150)
    data, used, faces = stripe(points, triangles)
    for rank in {0, last()}:
        remesh = remesher(data, 2000)
        before = joined(remesh, "before the stop")
        for begin in (0, 0.03) if rank == 0 else (0,):
            remesh.SetNumberOfQuads(remesh.GetNumberOfQuads() + 500)
            stop = Stop(remesh, begin) if RANK == rank else None
            fails(remesh, ABORTED, "stopped on request", f"a stop on rank {rank}")
            check("previous result is kept" in remesh.GetOutcomeText(), remesh.GetOutcomeText())
            check(stop is None or stop.is_done, "nobody asked to stop")
            remesh.RemoveAllObservers()
            joined(remesh, "after the stop")
    waits()
    for limit in (1e-9, 0.05):
        late = remesher(data, 30000, TimeLimit=limit)
        run(late)
        check(late.GetOutcome() in (TIMED_OUT, SUCCEEDED), f"a time limit: {late.GetOutcomeText()}")
        check(late.GetOutcome() == TIMED_OUT or limit > 1e-9, "no time at all was enough")
        same_on_all(late.GetOutcomeText(), "time limit")


def waits():
    """A stop on a rank that waits for the others reaches the one that works."""
    points, triangles = sphere(150)
    data, used, faces = stripe(points, triangles)
    remesh = remesher(data, 60000)
    begin = time.time()
    run(remesh)
    whole = time.time() - begin
    remesh = remesher(data, 60000)
    stop = Stop(remesh, 0, after=0.3 * whole) if RANK == last() else None
    fails(remesh, ABORTED, "stopped on request", "a stop while waiting")
    check(stop is None or stop.is_done, "the rank that waits was not asked")


def crossing_connections(count, quads, angle=0.85):
    """The filter for a sphere with connections that all cross each other at a pole; angle: from there to their ends."""
    points, triangles = icosphere()
    ids = np.zeros(len(points), np.int32)
    for k in range(count):
        around = np.pi * k / count
        for beside in (-np.sin(angle), np.sin(angle)):
            end = (beside * np.cos(around), beside * np.sin(around), np.cos(angle))
            ids[np.argmin(((points - end) ** 2).sum(1))] = k + 1
    data, used, faces = stripe(points, triangles)
    add(data.GetPointData(), "ConnectId", ids[used])
    return remesher(data, quads)


def so_far():
    """A stop after the first quads keeps them, on all ranks."""
    # No map has all of the connections while other irregular vertices stay, which a second attempt lets go.
    for count, number in itertools.product((3, 2, 4), (60, 80, 100, 150)):
        remesh = crossing_connections(count, number)
        stop = Stop(remesh, 0, text="Attempt 2 of at most ") if RANK == 0 else None
        quads = run(remesh)
        if remesh.GetIsSoFar():
            break
    check(remesh.GetOutcome() == ABORTED and remesh.GetIsSoFar(), f"quads so far: {remesh.GetOutcomeText()}")
    check(stop is None or stop.is_done, "there was no second attempt")
    same_on_all(remesh.GetOutcomeText(), "quads so far")
    copy = vtkPolyData()
    copy.ShallowCopy(quads)
    copy.GetFieldData().Initialize()
    parts = gather(copy)
    if parts is not None:
        try:
            Joined(parts).check_manifold(2)
        except AssertionError as error:
            check(False, f"quads so far: {error}")


def modes():
    """Automatic keeps small surfaces in one place; a result of one mode takes the place of one of the other."""
    points, triangles = sphere(30)
    data, used, faces = stripe(points, triangles)
    remesh = remesher(data, 300)
    joined(remesh, "spread")
    remesh.SetSpreadSurfaces(0)
    quads = run(remesh)
    check((quads.GetNumberOfCells() > 0) == (RANK == 0), "a small surface is spread")
    remesh.SetSpreadSurfaces(ALWAYS)
    first = joined(remesh, "spread again")
    remesh.SetNumberOfQuads(400)
    joined(remesh, "other quads")
    remesh.SetNumberOfQuads(300)
    again = joined(remesh, "the first ones")
    check(first is None or first.digest() == again.digest(), "the quads depend on what was made before")


def blocks():
    """Composite data: each block is spread; and a surface that comes in several pieces a rank."""
    from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkPartitionedDataSet
    rng = np.random.default_rng(4)
    whole = [sphere(30), torus(24)]
    parts = [random_blobs(*surface_, RANKS, rng) for surface_ in whole]
    data = vtkMultiBlockDataSet()
    for i, ((points, triangles), part) in enumerate(zip(whole, parts)):
        mine = part == RANK
        data.SetBlock(i, piece(points, triangles, mine)[0] if mine.any() else vtkPolyData())
    remesh = remesher(data, 600)
    quads = run(remesh)
    check(remesh.GetOutcome() == SUCCEEDED, remesh.GetOutcomeText())
    total = 0
    for i, characteristic in enumerate((2, 0)):
        copy = vtkPolyData()
        if quads.GetBlock(i):
            copy.ShallowCopy(quads.GetBlock(i))
        copy.GetFieldData().Initialize()
        gathered = gather(copy)
        if gathered is not None:
            try:
                mesh = Joined(gathered)
                mesh.check_manifold(characteristic)
                total += len(mesh.quads)
            except AssertionError as error:
                check(False, f"block {i}: {error}")
    check(RANK > 0 or total == remesh.GetActualQuads(), "the blocks do not have the quads that are told")
    points, triangles = whole[1]
    part = random_blobs(points, triangles, 3 * RANKS, rng)
    data = vtkPartitionedDataSet()
    for k in range(3):
        mine = part == 3 * RANK + k
        if mine.any():
            data.SetPartition(data.GetNumberOfPartitions(), piece(points, triangles, mine)[0])
    remesh = remesher(data, 300)
    quads = run(remesh)
    check(remesh.GetOutcome() == SUCCEEDED, remesh.GetOutcomeText())
    copy = vtkPolyData()
    if quads.GetNumberOfPartitions() and quads.GetPartition(0):
        copy.ShallowCopy(quads.GetPartition(0))
    copy.GetFieldData().Initialize()
    gathered = gather(copy)
    if gathered is not None:
        try:
            Joined(gathered).check_manifold(0)
        except AssertionError as error:
            check(False, f"several pieces a rank: {error}")


def kinds():
    """Pieces with ghost cells, of quads, of strips, of volumes."""
    from vtkmodules.vtkFiltersCore import vtkStripper
    from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
    points, triangles = torus(30)
    part = stripes(points, triangles, RANKS)
    # A layer of ghost cells on each side, flagged as ParaView does.
    at_border = np.isin(triangles, np.unique(triangles[part == RANK])).any(1)
    data, used, faces = piece(points, triangles, (part == RANK) | at_border)
    flags = np.where(part[faces] == RANK, 0, 1).astype(np.uint8)
    add(data.GetCellData(), "vtkGhostType", flags)
    remesh = remesher(data, 400)
    ghosted = joined(remesh, "ghost cells", 0)
    check(("ghost cells were left out" in remesh.GetNoticesText()) == (RANKS > 1), "ghost cells are not told")
    plain = joined(remesher(stripe(points, triangles)[0], 400), "no ghost cells", 0)
    check(plain is None or plain.digest() == ghosted.digest(), "ghost cells change the quads")
    stripper = vtkStripper()
    data, used, faces = stripe(points, triangles)
    add(data.GetCellData(), "face", faces.astype(np.int64))
    stripper.SetInputData(data)
    stripper.PassCellDataAsFieldDataOff()
    stripper.Update()
    check(stripper.GetOutput().GetNumberOfStrips() > 0, "there are no strips")
    joined(remesher(stripper.GetOutput(), 400), "strips", 0)
    # Faces dealt out at random, so that they are redistributed; first as quads.
    count = 80
    at = lambda i, j: (i % (2 * count)) * count + j % count
    dense = torus(count)[0]
    quads = np.array([(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1))
                      for i in range(2 * count) for j in range(count)])
    mine = quads[np.random.default_rng(6).integers(0, RANKS, len(quads)) == RANK]
    used, corners = np.unique(mine, return_inverse=True)
    data = surface(dense[used], np.empty((0, 3), int))
    for quad in corners.reshape(-1, 4).tolist():
        data.GetPolys().InsertNextCell(4, quad)
    remesh = remesher(data, 200)
    joined(remesh, "quads", 0)
    check(("redistributed" in remesh.GetNoticesText()) == (RANKS > 1), "quads were not redistributed")
    # The surface of a volume: each rank has a part of it, with faces where the parts meet.
    source = vtkRTAnalyticSource()
    source.SetWholeExtent(0, 12, 0, 12, 0, 12)
    source.UpdatePiece(RANK, RANKS, 0)
    remesh = remesher(source.GetOutput(), 300)
    joined(remesh, "a volume")
    check(("where volumes meet were left out" in remesh.GetNoticesText()) == (RANKS > 1), remesh.GetNoticesText())


def pipeline():
    """Between filters of ParaView: surfaces as its sources and filters cut them, and filters that use the quads."""
    import quick_start  # before simple
    from paraview import simple
    from plugin_common import DATA, PLUGIN
    simple.LoadPlugin(PLUGIN, remote=False, ns=globals())

    def remeshed(source, what, characteristic, quads=600):
        proxy = QuadRemesh(Input=source, TargetType="Number Of Quads", NumberOfQuads=quads, SpreadSurfaces="Always")
        proxy.UpdatePipeline()
        remesh = proxy.GetClientSideObject()
        check(remesh.GetOutcome() == SUCCEEDED, f"{what}: {remesh.GetOutcomeText()}")
        copy = vtkPolyData()
        copy.ShallowCopy(remesh.GetOutputDataObject(0))
        copy.GetFieldData().Initialize()
        parts = gather(copy)
        if parts is not None:
            try:
                Joined(parts).check_manifold(characteristic)
            except AssertionError as error:
                check(False, f"{what}: {error}")
        return proxy

    pieces = simple.Sphere(ThetaResolution=60, PhiResolution=50)  # each rank computes its part
    remeshed(pieces, "source", 2)
    frame = simple.PLYReader(FileNames=[os.path.join(DATA, "frame.ply")])  # all of it on the first rank
    frame.UpdatePipeline()
    whole = frame.GetClientSideObject().GetOutputDataObject(0)
    characteristic = euler(arrays_of(whole)[1]) if RANK == 0 else None
    remeshed(frame, "file", characteristic, 1500)
    torus_source = simple.Triangulate(Input=simple.Superquadric(
        Toroidal=1, ThetaResolution=96, PhiResolution=48, PhiRoundness=1, ThetaRoundness=1, Thickness=0.6))
    proxy = remeshed(simple.RedistributeDataSet(Input=torus_source), "redistributed", 0)
    connected = simple.Connectivity(Input=proxy)
    connected.UpdatePipeline()
    regions = connected.PointData["RegionId"] if RANK == 0 else None
    check(regions is None or regions.GetRange() == (0, 0), "the quads are in several parts")
    area = simple.IntegrateVariables(Input=simple.RedistributeDataSet(Input=proxy))
    area.UpdatePipeline()
    given = simple.IntegrateVariables(Input=torus_source)
    given.UpdatePipeline()
    if RANK == 0:
        ratio = area.CellData["Area"].GetRange()[0] / given.CellData["Area"].GetRange()[0]
        check(abs(ratio - 1) < 0.02, f"the quads have {ratio:.3f} of the area of the surface")


def function():
    """quadrille.remesh with spread, which tells of errors on all ranks."""
    points, triangles = sphere(40)
    data, used, faces = stripe(points, triangles)
    quads = quadrille.remesh(data, quads=400, spread=True, threads=1)
    mesh = mesh_of(quads, quadrille.info(quads)["ActualQuads"], "the function")
    if mesh is not None:
        check(abs(len(mesh.quads) - 400) < 80, f"{len(mesh.quads)} quads for 400")
        check(np.abs(np.linalg.norm(mesh.points, axis=1) - 1).max() < 0.01, "points are off the sphere")
    arrays = quadrille.remesh(arrays_of(data), quads=400, spread=True, threads=1)
    check(arrays.GetNumberOfCells() == quads.GetNumberOfCells(), "arrays and VTK's data have other quads")
    alone = quadrille.remesh((points, triangles), quads=400)
    check(quadrille.info(alone)["ActualQuads"] == alone.GetNumberOfCells(), "without spread each rank is alone")
    for arguments, expected in (((damaged("number"), {}), f"rank {last()}: point 5" if RANKS > 1 else "point 5"),
                                ((data, {"wrap": 0.2}), "leave out wrap")):
        try:
            quadrille.remesh(arguments[0], quads=400, spread=True, **arguments[1])
        except quadrille.InvalidInput as error:
            check(expected in str(error), f"{expected!r} is not in {error}")
        else:
            check(False, f"no error where {expected!r} was expected")


CASES = {
    "splits-closed": lambda: splits(("sphere", "torus"), 25), "splits-open": lambda: splits(("plane", "box"), 25),
    "repeat": repeat, "dense": dense, "scattered": scattered, "attributes": attributes, "ids": ids,
    "constraints": constraints, "features": features, "ghosts": ghosts, "sums": sums, "faults": faults,
    "cancel": cancel, "so-far": so_far, "modes": modes, "blocks": blocks, "kinds": kinds,
    "pipeline": pipeline, "function": function,
}

if __name__ == "__main__":
    for case in sys.argv[1:]:
        try:
            CASES[case]()
        except Exception as error:  # else the other ranks wait for this one
            import traceback
            traceback.print_exc()
            check(False, f"{case}: {error!r}")
        CONTROLLER.Barrier()
    print("spread: fine", flush=True)
