# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Save Data with the writers of the plugin; test_pvserver.py does it on a server."""
import os
import pathlib
import tempfile

import quick_start  # before simple
from paraview import servermanager, simple

from plugin_common import DATA, PLUGIN, check, surface

EXTENSIONS = {"inp": "QuadInpWriter", "msh": "QuadMshWriter", "mesh": "QuadMeditWriter",
              "exodus": "QuadExodusWriter"}


def written(name, source, **options):
    path = pathlib.Path(FOLDER) / name
    path.unlink(missing_ok=True)
    simple.SaveData(str(path), proxy=source, **options)
    check(path.exists(), f"{name} is not there")
    check([p.name for p in pathlib.Path(FOLDER).glob("*.part*")] == [], "a part of a file is left behind")
    return path


def look():
    simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
    mesh = surface(simple)
    quads = QuadRemesh(Input=mesh, TargetType="Number Of Quads", NumberOfQuads=400)
    quads.UpdatePipeline()
    count = quads.GetDataInformation().GetNumberOfCells()

    # The window lists what the factory does.
    factory = servermanager.vtkSMProxyManager.GetProxyManager().GetWriterFactory()
    types = factory.GetSupportedFileTypes(quads.SMProxy, 0)
    for text in ("CalculiX and Abaqus Input Deck (Quadrille)(*.inp", "Gmsh Mesh (Quadrille)(*.msh",
                 "MEDIT Mesh (Quadrille)(*.mesh", "Exodus II with Sets (Quadrille)(*.exo"):
        check(text in types, f"{text} is not among the types of files: {types}")
    for extension, name in EXTENSIONS.items():
        writer = factory.CreateWriter(f"a.{extension}", quads.SMProxy, 0)
        check(writer.GetXMLName() == name, f"{extension} is written by {writer.GetXMLName()}")

    text = written("a.inp", quads).read_text()
    patches = servermanager.Fetch(quads).GetCellData().GetArray("LayoutPatch")
    patches = {patches.GetValue(i) for i in range(count)}
    check(text.count("\n*ELSET, ELSET=PATCH_") == len(patches) and "TYPE=S4," in text, "no sets by LayoutPatch")
    check(f"{count} elements" in text, "another number of elements")
    check("TYPE=S4," in written("d.inp", quads, ElementType="Automatic").read_text(), "Automatic is not S4 for quads")
    text = written("a.inp", quads, ElementType="S4R", Dialect="Abaqus").read_text()
    check("TYPE=S4R," in text, "ElementType has no effect")
    check(written("a.msh", quads).read_text().splitlines()[1] == "4.1 0 8", "not version 4.1")
    check(written("a.msh", quads, MshVersion="2.2").read_text().splitlines()[1] == "2.2 0 8", "not version 2.2")
    check("Quadrilaterals\n" in written("a.mesh", quads).read_text(), "no quads")

    # Another array of patches, and names in the field data.
    halves = simple.Calculator(Input=quads, AttributeType="Cell Data", ResultArrayName="Half",
                               Function="SourceCellId - SourceCellId")
    text = written("b.inp", halves, PatchArray="Half").read_text()
    check(text.count("*ELSET, ELSET=PATCH_") == 1 and "ELSET=PATCH_0\n" in text, "PatchArray has no effect")

    # An unstructured grid, as second order comes, is taken as well.
    grid = simple.AppendDatasets(Input=quads)
    check(written("c.inp", grid).read_text().count("\n") > count, "no unstructured grid")

    # Exodus with sets comes back by ParaView's own reader.
    part = QuadRemesh(Input=PartReader(), NumberOfQuads=1500)
    path = written("part.exodus", part)
    again = simple.ExodusIIReader(FileName=[str(path)])
    again.UpdatePipeline()
    blocks = [str(name) for name in again.GetPropertyValue("ElementBlocks")]
    check(len(blocks) == 15 and blocks[0].startswith("PATCH_1"), f"blocks {blocks}")
    sets = [name for name in again.SideSetArrayStatus.Available if name.startswith("BOUNDARY_")]
    check(len(sets) == 2, f"side sets {again.SideSetArrayStatus.Available}")
    cells = part.GetDataInformation().GetNumberOfCells()
    check(again.GetDataInformation().GetNumberOfCells() == cells, "there are other cells than before")
    print(f"writers: fine, {count} quads, {len(blocks)} blocks")


def PartReader():
    return QuadrillePLYReader(FileName=os.path.join(DATA, "part.ply"))


with tempfile.TemporaryDirectory() as FOLDER:
    look()
