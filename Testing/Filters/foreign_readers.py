# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What other programs make of a file: run by each of them, or by the Python that has it, for test_readers.py.

PROGRAM foreign_readers.py NAME FILE... writes beside each file FILE.NAME.json with `points`, `faces` (of 3 or 4
corners), `sets` (name or number: places in `faces`) and `nodes` (name: places in `points`); or `error`, what went
wrong; or `left_out`, a package that is missing. A program that ends while it reads leaves nothing there."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys


class LeftOut(Exception):
    """A package that a reader needs for one of its formats."""


class Found:
    """Collects what is in a file."""

    def __init__(self):
        self.points, self.faces, self.sets, self.nodes = [], [], {}, {}

    def add_points(self, points):
        """Returns the place of the first one."""
        first = len(self.points)
        self.points += [[float(x) for x in p] for p in points]
        return first

    def add_faces(self, faces, first_point=0, name=None):
        places = range(len(self.faces), len(self.faces) + len(faces))
        self.faces += [[int(i) + first_point for i in face] for face in faces]
        if name is not None:
            self.sets.setdefault(str(name), []).extend(places)

    def number(self, numbers):
        """Sets by a number each face."""
        for place, number in enumerate(numbers):
            self.sets.setdefault(str(int(number)), []).append(place)


# ------------------------------------------------------------------------------------------------- Python modules
def read_meshio(path):
    import meshio

    if path.suffix == ".exo":
        try:
            import netCDF4  # noqa: F401
        except ImportError:
            raise LeftOut("python3-netcdf4") from None
    mesh = meshio.read(path)
    found = Found()
    found.add_points(mesh.points)
    first_of = []  # the place of each block's first face; None of lines and points
    numbers = next((mesh.cell_data[name] for name in ("medit:ref", "PatchId") if name in mesh.cell_data), None)
    for i, block in enumerate(mesh.cells):
        is_face = block.type in ("triangle", "quad")
        first_of.append(len(found.faces) if is_face else None)
        if is_face and numbers is not None:
            for face, number in zip(block.data, numbers[i]):
                found.add_faces([face], name=int(number))
        elif is_face:
            found.add_faces(block.data, name=f"block {i}" if path.suffix == ".obj" else None)
    found.nodes = {name: [int(i) for i in ids] for name, ids in mesh.point_sets.items()}
    for name, of_blocks in mesh.cell_sets.items():
        for i, ids in enumerate(of_blocks):
            if ids is None or len(ids) == 0 or name.startswith("gmsh:"):
                continue
            if first_of[i] is not None:
                found.sets.setdefault(name, []).extend(first_of[i] + int(e) for e in ids)
            else:
                found.nodes.setdefault(name, []).extend(int(n) for e in ids for n in mesh.cells[i].data[e])
    return found


def read_gmsh(path):
    import gmsh
    import numpy

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.logger.start()
    gmsh.open(str(path))
    wrong = [line for line in gmsh.logger.get() if line.startswith(("Warning", "Error"))]
    gmsh.logger.stop()
    if wrong:
        raise ValueError("; ".join(wrong))
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    found = Found()
    found.add_points(coordinates.reshape(-1, 3))
    place = {int(tag): i for i, tag in enumerate(tags)}

    def rows(dimension, entity):
        for kind, _, nodes in zip(*gmsh.model.mesh.getElements(dimension, entity)):
            count = gmsh.model.mesh.getElementProperties(kind)[3]
            yield from [[place[int(n)] for n in row] for row in numpy.asarray(nodes).reshape(-1, count)]

    groups = gmsh.model.getPhysicalGroups()
    named = {(d, int(e)): gmsh.model.getPhysicalName(d, tag)
             for d, tag in groups for e in gmsh.model.getEntitiesForPhysicalGroup(d, tag)}
    for _, entity in gmsh.model.getEntities(2):
        found.add_faces(list(rows(2, entity)), name=named.get((2, entity)) or entity)
    for dimension in (0, 1):
        for _, entity in gmsh.model.getEntities(dimension):
            name = named.get((dimension, entity))
            if name:
                found.nodes.setdefault(name, []).extend(n for row in rows(dimension, entity) for n in row)
    gmsh.finalize()
    return found


def read_trimesh(path):
    import trimesh

    mesh = trimesh.load(str(path))  # which joins equal points
    found = Found()
    found.add_points(mesh.vertices)
    found.add_faces(mesh.faces)
    return found


def read_pyvista(path):
    import pyvista

    return of_vtk(pyvista.read(str(path)))


# ------------------------------------------------------------------------------------------------- VTK and ParaView
def set_up_exodus(reader):
    reader.UpdateInformation()
    for i in range(reader.GetNumberOfNodeSetArrays()):
        reader.SetNodeSetArrayStatus(reader.GetNodeSetArrayName(i), 1)
    reader.Update()


def leaves(data, name=""):
    """Data sets in a composite, with the first word of their blocks' names."""
    if data is None:
        return
    if data.IsA("vtkMultiBlockDataSet"):
        count, get = data.GetNumberOfBlocks(), data.GetBlock
    elif data.IsA("vtkPartitionedDataSetCollection"):
        count, get = data.GetNumberOfPartitionedDataSets(), data.GetPartitionedDataSet
    elif data.IsA("vtkPartitionedDataSet"):
        count, get = data.GetNumberOfPartitions(), data.GetPartition
    else:
        yield name, data
        return
    for i in range(count):
        title = data.GetMetaData(i).Get(data.NAME()) if data.HasMetaData(i) else None
        yield from leaves(get(i), title.split()[0] if title else name)


def of_vtk(data):
    """Blocks are sets; of one data set alone the arrays of patches are."""
    found = Found()
    is_composite = data.IsA("vtkCompositeDataSet")
    numbers = []
    for name, leaf in leaves(data):
        first = found.add_points([leaf.GetPoint(i) for i in range(leaf.GetNumberOfPoints())])
        cells = []  # dimensions with points; the cell itself is one object for all of them
        for i in range(leaf.GetNumberOfCells()):
            cell = leaf.GetCell(i)
            cells.append((cell.GetCellDimension(), [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]))
        faces = [points for dimension, points in cells if dimension == 2]
        if is_composite and cells and all(dimension == 0 for dimension, _ in cells):
            found.nodes[name] = list(range(first, len(found.points)))
        found.add_faces(faces, first, name if is_composite and faces else None)
        for array in ("PatchId", "GroupIds", "medit:ref", "gmsh:physical"):
            values = leaf.GetCellData().GetArray(array)
            if values is not None and not is_composite:
                numbers = [values.GetTuple1(i) for i, (dimension, _) in enumerate(cells) if dimension == 2]
                break
    found.number(numbers)
    return found


def read_vtk(path):
    from vtkmodules.vtkIOExodus import vtkExodusIIReader
    from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
    from vtkmodules.vtkIOPLY import vtkPLYReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

    readers = {".exo": vtkExodusIIReader, ".obj": vtkOBJReader, ".stl": vtkSTLReader, ".ply": vtkPLYReader,
               ".vtp": vtkXMLPolyDataReader, ".vtu": vtkXMLUnstructuredGridReader}
    reader = readers[path.suffix]()
    reader.SetFileName(str(path))
    if path.suffix == ".exo":
        set_up_exodus(reader)
    reader.Update()
    return of_vtk(reader.GetOutput())


def read_paraview(path):
    from paraview import simple

    source = simple.OpenDataFile(str(path))
    if path.suffix == ".exo":  # sets are off at first
        source.NodeSets = source.NodeSets.Available
    source.UpdatePipeline()
    return of_vtk(source.GetClientSideObject().GetOutputDataObject(0))


# ------------------------------------------------------------------------------------------------- programs
def read_blender(path):
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    axes = {"forward_axis": "Y", "up_axis": "Z"}
    if path.suffix == ".obj":
        bpy.ops.wm.obj_import(filepath=str(path), import_vertex_groups=True, **axes)
    elif bpy.app.version >= (4, 2):
        getattr(bpy.ops.wm, f"{path.suffix[1:]}_import")(filepath=str(path), **axes)
    else:
        getattr(bpy.ops.import_mesh, path.suffix[1:])(filepath=str(path))
    found = Found()
    one, = bpy.data.objects
    found.add_points([vertex.co for vertex in one.data.vertices])
    found.add_faces([polygon.vertices for polygon in one.data.polygons])
    # Groups are of vertices there: a face is of those that all its corners have.
    groups = [{group.group for group in vertex.groups} for vertex in one.data.vertices]
    for place, face in enumerate(found.faces):
        for group in set.intersection(*(groups[i] for i in face)):
            found.sets.setdefault(one.vertex_groups[group].name, []).append(place)
    return found


def read_meshlab(path):
    """meshlabserver needs OpenGL, here of a display without a screen; it cuts quads."""
    copy = path.with_suffix(".meshlab.off")
    command = ["meshlabserver", "-i", str(path), "-o", str(copy)]
    run(["xvfb-run", "-a", *command] if shutil.which("xvfb-run") else command)
    return of_off(copy)


def read_admesh(path):
    """Looks for neighbours by equal corners, and must find nothing to mend."""
    copy = path.with_suffix(".admesh.off")
    told = run(["admesh", "--exact", f"--write-off={copy}", str(path)])
    for count in ("Degenerate facets", "Facets removed", "Facets reversed", "Backwards edges"):
        if not re.search(rf"{count} +: +0\b", told):
            raise ValueError(told)
    return of_off(copy)


def read_calculix(path):
    """A step without loads: the file of results has nodes and elements, the other one the members of each set."""
    text = path.read_text()
    nodes = re.findall(r"\*NSET, NSET=(\S+)", text)
    elements = re.findall(r"\*ELSET, ELSET=([^\s,]+)", text)
    deck = f"*INCLUDE, INPUT={path.name}\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n*SHELL SECTION, ELSET=EALL, MATERIAL=M\n"
    deck += "0.01\n*BOUNDARY\nNALL, 1, 6\n*STEP\n*STATIC\n*NODE FILE, OUTPUT=2D\nU\n"
    deck += "".join(f"*NODE PRINT, NSET={name}\nU\n" for name in nodes)
    deck += "".join(f"*EL PRINT, ELSET={name}\nS\n" for name in elements)
    job = path.with_suffix(".job.inp")
    job.write_text(deck + "*END STEP\n")
    told = run(["ccx", "-i", job.stem], cwd=path.parent, env={**os.environ, "OMP_NUM_THREADS": "1"})
    if re.search(r"\*WARNING|\*ERROR", told.upper()):
        raise ValueError(told)
    found = of_frd(job.with_suffix(".frd"))
    printed = printed_sets(job.with_suffix(".dat").read_text())
    found.nodes = {name: sorted(printed["displacements", name]) for name in nodes}
    found.sets = {name: sorted(printed["stresses", name]) for name in elements}
    return found


def of_frd(path):
    """Nodes and elements of a file of results of CalculiX; both are numbered from 1 without gaps."""
    found, block = Found(), None
    for line in path.read_text().splitlines():
        title = re.match(r" +(\d+C)", line)
        block = title.group(1) if title else block
        if block == "2C" and line.startswith(" -1"):
            found.add_points([[line[13 + 12 * k:25 + 12 * k] for k in range(3)]])
        elif block == "3C" and line.startswith(" -2"):
            found.add_faces([[int(n) - 1 for n in line[3:].split()]])
    return found


def printed_sets(text):
    """Members, from 0, of the tables of CalculiX, by what is printed and the set: a node set and an element set may
    have one name."""
    found, members = {}, None
    for line in text.splitlines():
        title = re.search(r"(\w+) \(.*for set (\S+) and time", line)
        if title:
            members = found.setdefault(title.groups(), set())
        elif line.strip() and members is not None:
            members.add(int(line.split()[0]) - 1)
    return found


def of_off(path):
    words = path.read_text().split()
    found = Found()
    points, faces = int(words[1]), int(words[2])
    found.add_points([words[4 + 3 * i:7 + 3 * i] for i in range(points)])
    at = 4 + 3 * points
    for _ in range(faces):
        count = int(words[at])
        found.add_faces([words[at + 1:at + 1 + count]])
        at += 1 + count
    return found


def run(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300, **options)
    if done.returncode != 0:
        raise ValueError(f"{command[0]} ended with {done.returncode}: {(done.stdout + done.stderr)[-600:]}")
    return done.stdout + done.stderr


READERS = {"meshio": read_meshio, "Gmsh": read_gmsh, "MeshLab": read_meshlab, "Blender": read_blender,
           "admesh": read_admesh, "CalculiX": read_calculix, "VTK": read_vtk, "ParaView": read_paraview,
           "PyVista": read_pyvista, "trimesh": read_trimesh}


def main(name, files):
    for file in files:
        path = pathlib.Path(file)
        try:
            answer = vars(READERS[name](path))
        except LeftOut as missing:
            answer = {"left_out": str(missing)}
        except BaseException as error:  # meshio ends the process where it does not understand a file
            answer = {"error": f"{type(error).__name__}: {error}"}
        path.with_name(f"{path.name}.{name}.json").write_text(json.dumps(answer))


if __name__ == "__main__":
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else sys.argv[1:]
    main(words[0], words[1:])
