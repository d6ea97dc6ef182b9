#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What a surface costs that stays spread over ranks, and what its quads are worth against those of a serial run.

  Scripts/study/spread_table.py MODEL.ply... --python build [--quads N,N] [--ranks 1,2,4,8]
                                [--splits redistribute,stripes,random] [--judge QUADSTATS] [--samples N]
                                [--table FILE.csv] [--work FOLDER]

Each model is cut into a part for each rank: as ParaView's Redistribute Data Set cuts it, in stripes along the longest
side of its box, and face by face at random. Then each rank reads its part alone, *Quad Remesh* runs with Spread
Surfaces at Always, and the quads of all ranks are joined by their global ids. QUADSTATS is a script that is called as
`QUADSTATS QUADS.obj MODEL.ply --samples N` and prints JSON. `serial` is a run of one rank with Spread Surfaces at
Never.

The table has a row for each run: faces; quads; irregular vertices and distance (mean, over the diagonal of the box),
and both over those of the serial run; megabytes gathered on one rank, redistributed, and sent by the rank that sends
most; megabytes of memory at the peak of the rank that has most, before the filter ran, and what is allowed (the rank's
share of the faces times 200 bytes, and 300 MB); and seconds of the stages, of the slowest rank. It is printed as
Markdown and written as CSV. What a rank of Python and VTK takes before it does anything, some 100 MB, counts. A rank
has one thread.
"""
import argparse
import csv
import ctypes
import ctypes.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

STAGES = ("prepare", "exchange", "redistribute", "thin", "gather", "run", "place", "carry", "scatter")
BYTES_A_FACE, BYTES_OF_A_RANK = 200, 300e6
KEPT = []  # arrays of numpy that VTK reads in place
COLUMNS = ("model", "split", "ranks", "faces", "quads", "irregular", "irregular_ratio", "distance", "distance_ratio",
           "manifold", "euler", "gathered_mb", "redistributed_mb", "sent_mb", "base_mb", "peak_mb", "allowed_mb",
           "peaks_mb", "seconds") + STAGES


def read_model(path):
    """Points (float) and triangles (int32) of a PLY file."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersCore import vtkTriangleFilter
    from vtkmodules.vtkIOPLY import vtkPLYReader
    reader = vtkPLYReader()
    reader.SetFileName(str(path))
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(reader.GetOutputPort())
    triangles.Update()
    surface = triangles.GetOutput()
    points = vtk_to_numpy(surface.GetPoints().GetData()).copy()
    return points, vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3).astype(np.int32)


def save_parts(points, triangles, part, ranks, folder):
    for rank in range(ranks):
        used, corners = np.unique(triangles[part == rank], return_inverse=True)
        np.save(folder / f"{rank}.points.npy", points[used])
        np.save(folder / f"{rank}.triangles.npy", corners.reshape(-1, 3).astype(np.int32))


def stripes(points, triangles, ranks):
    axis = np.argmax(np.ptp(points, axis=0))
    order = np.argsort(points[triangles, axis].sum(1), kind="stable")
    part = np.empty(len(triangles), np.int32)
    part[order] = np.arange(len(triangles)) * ranks // len(triangles)
    return part


def scatter(points, triangles, ranks):
    return np.random.default_rng(1).integers(0, ranks, len(triangles))


def mpi(arguments, ranks, script, options):
    command = [arguments.mpiexec, "--allow-run-as-root", "--oversubscribe", "-np", str(ranks), sys.executable, script,
               *options]
    environment = dict(os.environ, OMPI_MCA_mpi_yield_when_idle="1")
    paths = [str(path) for path in (arguments.python / "lib/python3/dist-packages",) if path.exists()]
    environment["PYTHONPATH"] = os.pathsep.join(paths + [environment.get("PYTHONPATH", "")])
    done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=arguments.timeout)
    if done.returncode != 0:
        sys.exit(f"FAILED: {' '.join(command)}\n{done.stdout}")


def cut(arguments, model, split, ranks, folder):
    """Writes the parts; returns the number of faces."""
    points, triangles = read_model(model)
    part = scatter(points, triangles, ranks) if split == "random" else stripes(points, triangles, ranks)
    save_parts(points, triangles, part, ranks, folder)
    count = len(triangles)
    del points, triangles, part
    if split == "redistribute" and ranks > 1:
        mpi(arguments, ranks, __file__, ["--redistribute", str(folder)])
    return count


def judge(arguments, quads, model):
    command = [sys.executable, str(arguments.judge), str(quads), str(model), "--samples", str(arguments.samples)]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)


def row_of(arguments, model, split, ranks, quads, serial):
    with tempfile.TemporaryDirectory(dir=arguments.work) as name:
        folder = pathlib.Path(name)
        faces = cut(arguments, model, split, ranks, folder)
        mode = "2" if split == "serial" else "1"
        mpi(arguments, ranks, __file__, ["--worker", str(folder), "--quads", str(quads), "--mode", mode])
        told = json.loads((folder / "told.json").read_text())
        row = dict(dict.fromkeys(COLUMNS, ""), model=model.stem, split=split, ranks=ranks, faces=faces, **told)
        if arguments.judge:
            judged = judge(arguments, folder / "quads.obj", model)
            valence, shape = judged["valence"], judged["topology"]
            row.update(irregular=valence["irregular_interior"] + valence["irregular_boundary"],
                       distance=judged["distance"]["mean_rel"], manifold=shape["manifold"],
                       euler=shape["euler_characteristic"])
            for key in ("irregular", "distance"):
                if serial and serial[key] and row[key] is not None:
                    row[key + "_ratio"] = f"{row[key] / serial[key]:.3f}"
    return row


def start_mpi():
    """A controller of all ranks without ParaView, whose programs take 280 MB before they do anything."""
    from vtkmodules.vtkParallelCore import vtkMultiProcessController
    from vtkmodules.vtkParallelMPI import vtkMPIController
    # Initialize() without arguments takes for granted that MPI is initialized.
    ctypes.CDLL(ctypes.util.find_library("mpi"), ctypes.RTLD_GLOBAL).MPI_Init(None, None)
    controller = vtkMPIController()
    controller.Initialize()
    vtkMultiProcessController.SetGlobalController(controller)
    return controller


def end_mpi(controller):
    from vtkmodules.vtkParallelCore import vtkMultiProcessController
    vtkMultiProcessController.SetGlobalController(None)
    controller.Finalize()


def worker_parts(folder, rank):
    """This rank's part as vtkPolyData."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    points = np.load(folder / f"{rank}.points.npy")
    corners = np.load(folder / f"{rank}.triangles.npy").astype(np.int64).reshape(-1)
    data, places, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(points))
    offsets = np.arange(0, len(corners) + 1, 3, dtype=np.int64)
    cells.SetData(numpy_to_vtkIdTypeArray(offsets), numpy_to_vtkIdTypeArray(corners))
    data.SetPoints(places)
    data.SetPolys(cells)
    KEPT.extend((points, corners, offsets))
    return data


def redistribute(folder):
    """Run by every rank: replaces the parts by those of Redistribute Data Set."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
    from vtkmodules.vtkFiltersParallelDIY2 import vtkRedistributeDataSetFilter
    controller = start_mpi()
    rank, ranks = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()
    filter_ = vtkRedistributeDataSetFilter()
    filter_.SetInputDataObject(worker_parts(folder, rank))
    filter_.UpdatePiece(rank, ranks, 0)
    surface = vtkDataSetSurfaceFilter()
    surface.SetPieceInvariant(0)
    surface.SetInputDataObject(filter_.GetOutputDataObject(0))
    surface.Update()
    data = surface.GetOutput()
    data.RemoveGhostCells()
    triangles = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    used, corners = np.unique(triangles, return_inverse=True)
    points = vtk_to_numpy(data.GetPoints().GetData()) if data.GetNumberOfPoints() else np.empty((0, 3), np.float32)
    controller.Barrier()
    np.save(folder / f"{rank}.points.npy", points[used])
    np.save(folder / f"{rank}.triangles.npy", corners.reshape(-1, 3).astype(np.int32))
    end_mpi(controller)


def peak_memory():
    for line in open("/proc/self/status"):
        if line.startswith("VmHWM"):
            return 1024 * int(line.split()[1])
    return 0


def worker(folder, quads, mode):
    """Run by every rank: remeshes the parts; the first rank writes quads.obj and told.json."""
    import quadrille
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    controller = start_mpi()
    rank, ranks = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()
    data = worker_parts(folder, rank)
    faces = data.GetNumberOfPolys()
    base = peak_memory()
    remesh = quadrille.vtkQuadRemesh()
    remesh.SetInputDataObject(0, data)
    remesh.SetNumberOfQuads(quads)
    remesh.SetSpreadSurfaces(mode)
    remesh.SetNumberOfThreads(1)
    remesh.SetKeepLevels(0)
    remesh.SetComputeMappedSurface(0)
    controller.Barrier()
    begin = time.time()
    remesh.UpdatePiece(rank, ranks, 0)
    seconds = time.time() - begin
    if remesh.GetOutcome() != 1:
        sys.exit(f"rank {rank}: {remesh.GetOutcomeText()}")
    output = remesh.GetOutputDataObject(0)
    field = output.GetFieldData()
    part = vtkPolyData()
    part.ShallowCopy(output)
    part.GetFieldData().Initialize()
    note = np.array([[faces, base, peak_memory()]])
    if rank > 0:
        from vtkmodules.util.numpy_support import numpy_to_vtk
        array = numpy_to_vtk(note, deep=1)
        array.SetName("note")
        part.GetFieldData().AddArray(array)
        controller.Send(part, 0, 1)
        end_mpi(controller)
        return
    parts, notes = [part], [note]
    for other in range(1, ranks):
        received = vtkPolyData()
        controller.Receive(received, other, 1)
        parts.append(received)
        notes.append(vtk_to_numpy(received.GetFieldData().GetArray("note")).reshape(1, 3).copy())
    notes = np.vstack(notes)
    points, cells = {}, {}
    for one in parts:
        if one.GetNumberOfCells() == 0:
            continue
        where = vtk_to_numpy(one.GetPoints().GetData())
        ids = one.GetPointData().GetArray("GlobalPointIds")
        ids = vtk_to_numpy(ids) if ids else np.arange(len(where))
        quad_ids = one.GetCellData().GetArray("GlobalCellIds")
        quad_ids = vtk_to_numpy(quad_ids) if quad_ids else np.arange(one.GetNumberOfCells())
        corners = vtk_to_numpy(one.GetPolys().GetConnectivityArray()).reshape(-1, 4)
        points.update(zip(ids.tolist(), where.tolist()))
        cells.update(zip(quad_ids.tolist(), ids[corners].tolist()))
    with open(folder / "quads.obj", "w") as out:
        for i in range(len(points)):
            out.write("v %.9g %.9g %.9g\n" % tuple(points[i]))
        for i in range(len(cells)):
            out.write("f %d %d %d %d\n" % tuple(p + 1 for p in cells[i]))
    allowed = notes[:, 0] * BYTES_A_FACE + BYTES_OF_A_RANK
    most = int(np.argmax(notes[:, 2] / allowed))
    told = {"quads": len(cells), "seconds": round(seconds, 3), "base_mb": round(1e-6 * notes[most, 1]),
            "peak_mb": round(1e-6 * notes[most, 2]), "allowed_mb": round(1e-6 * allowed[most]),
            "peaks_mb": " ".join(f"{1e-6 * x:.0f}" for x in notes[:, 2])}
    stages = field.GetArray("StageSeconds")
    told["run"] = round(float(vtk_to_numpy(stages).sum()), 3)
    figures = field.GetArray("SpreadFigures")
    if figures:
        values = vtk_to_numpy(figures).reshape(figures.GetNumberOfTuples(), -1)
        names = [figures.GetComponentName(i) for i in range(figures.GetNumberOfComponents())]
        for i, name in enumerate(names):
            if name.endswith("_seconds"):
                told[name[:-len("_seconds")]] = round(float(values[:, i].max()), 3)
        told["gathered_mb"] = round(1e-6 * values[:, names.index("gathered_bytes")].sum(), 3)
        told["redistributed_mb"] = round(1e-6 * values[:, names.index("redistributed_bytes")].sum(), 3)
        told["sent_mb"] = round(1e-6 * values[:, names.index("sent_bytes")].max(), 3)
    (folder / "told.json").write_text(json.dumps(told))
    end_mpi(controller)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*", type=pathlib.Path)
    parser.add_argument("--python", type=pathlib.Path, default=pathlib.Path("build"), help="the build folder")
    parser.add_argument("--quads", default="10000")
    parser.add_argument("--ranks", default="1,2,4,8")
    parser.add_argument("--splits", default="redistribute,stripes,random")
    parser.add_argument("--judge", type=pathlib.Path)
    parser.add_argument("--samples", type=int, default=100000)
    parser.add_argument("--table", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--timeout", type=float, default=3600)
    parser.add_argument("--mpiexec", default="mpiexec")
    parser.add_argument("--worker", type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("--redistribute", type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("--mode", type=int, default=1, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.worker:
        return worker(arguments.worker, int(arguments.quads), arguments.mode)
    if arguments.redistribute:
        return redistribute(arguments.redistribute)
    rows = []
    print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS))
    for model in arguments.models:
        for quads in map(int, arguments.quads.split(",")):
            serial = None
            runs = [("serial", 1)] + [(split, ranks) for ranks in map(int, arguments.ranks.split(","))
                                      for split in (arguments.splits.split(",") if ranks > 1 else ["whole"])]
            for split, ranks in runs:
                rows.append(row_of(arguments, model.resolve(), split, ranks, quads, serial))
                serial = serial or rows[-1]
                print("| " + " | ".join(str(rows[-1][name]) for name in COLUMNS) + " |", flush=True)
                if arguments.table:
                    with open(arguments.table, "w", newline="") as out:
                        table = csv.DictWriter(out, COLUMNS)
                        table.writeheader()
                        table.writerows(rows)



if __name__ == "__main__":
    main()
