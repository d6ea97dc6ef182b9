# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Two ranks: rank 0 has the whole mesh, the other one an empty output without an error."""
import os

from paraview import servermanager, simple

from plugin_common import DATA, PLUGIN, check, number, size_of, surface

simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
process = servermanager.vtkProcessModule.GetProcessModule()
check(process.GetNumberOfLocalPartitions() == 2, "not two ranks")
reader = simple.PLYReader(FileNames=[os.path.join(DATA, "frame.ply")])
for name, mesh in (("torus", surface(simple)), ("file", reader)):
    quads = QuadRemesh(Input=mesh, TargetType="Number Of Quads", NumberOfQuads=900)
    quads.UpdatePipeline()
    raw = quads.GetClientSideObject()
    local = raw.GetOutput().GetNumberOfCells() if raw else 0
    check((local > 0) == (process.GetPartitionId() == 0), f"{name}: {local} quads on rank {process.GetPartitionId()}")
    check(size_of(quads) > 0, f"{name}: no quads")
    if process.GetPartitionId() == 0:
        # Under MPI a source comes in pieces that share points; only a whole mesh gives a closed result.
        cells, points = raw.GetOutput().GetNumberOfCells(), raw.GetOutput().GetNumberOfPoints()
        euler = {"torus": 0, "file": -4}[name]
        check(points - cells == euler, f"{name}: {points} points and {cells} quads are no closed mesh of this genus")
print("mpi: fine")
