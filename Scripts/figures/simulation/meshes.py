# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of the example: quads by this package, quads and triangles by Gmsh; read from Abaqus' and Gmsh's files."""
import pathlib
import re
import subprocess
from dataclasses import dataclass, field

import numpy as np

from . import elements

#: Element types of Gmsh's file format 2.2 that the example has: numbers of nodes.
GMSH_NODES = {2: 3, 3: 4, 9: 6, 16: 8}
#: Mesh.Algorithm and Mesh.RecombinationAlgorithm. Frontal-Delaunay for quads (8) crashes in Gmsh 4.8.4 of Debian 12;
#: 9, packing of parallelograms, is the other one that places points for quads.
GMSH = {"Gmsh, recombined": (9, 1), "Gmsh, full quad": (6, 3), "triangles": (6, None)}
LIMIT = 600  # seconds that a mesher may take


@dataclass
class NodeSet:
    """A set in a deck, with the lines that make it, none where the mesh's file has it."""
    name: str
    lines: list


@dataclass
class Mesh:
    """Nodes (#nodes by 3) with their numbers in the file, elements by number of nodes (#elements by nodes, places in
    `points`), and node sets by name (places in `points`)."""
    points: np.ndarray
    numbers: np.ndarray
    blocks: dict
    node_sets: dict = field(default_factory=dict)

    def set_of(self, places, name):
        """The node set that has these nodes and no other; a new one of this name if there is none."""
        for known, members in self.node_sets.items():
            if np.array_equal(members, places):
                return NodeSet(known, [])
        return NodeSet(name, [f"*NSET, NSET={name}", *(f"{number}," for number in self.numbers[places])])

    def irregular(self):
        """Vertices of quads inside, with other than four quads; None with triangles."""
        if any(elements.CORNERS[nodes] == 3 for nodes in self.blocks):
            return None
        valence = np.zeros(len(self.points), int)
        for block in self.blocks.values():
            np.add.at(valence, block[:, :4], 1)
        outer = {node for edge in self.boundary_edges() for node in edge}
        return sum(1 for node, count in enumerate(valence) if count not in (0, 4) and node not in outer)

    def count(self):
        return sum(len(block) for block in self.blocks.values())

    def boundary_edges(self):
        """Edges of one element only, each (begin, end[, middle]) as places in `points`, in the element's direction."""
        seen = {}
        for nodes, block in self.blocks.items():
            for edge in elements.edges(nodes):
                for ends in block[:, edge]:
                    seen.setdefault((min(ends[:2]), max(ends[:2])), []).append(tuple(ends))
        return [ends[0] for ends in seen.values() if len(ends) == 1]


class MesherError(RuntimeError):
    """A mesher gave no mesh; the message has its words."""


def run(command, folder):
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, timeout=LIMIT,
                          check=False)
    if done.returncode != 0:
        raise MesherError(f"{' '.join(map(str, command))} ended with {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout


# ---- files

def read_inp(path):
    """The mesh of an Abaqus file. Elements have to be triangles and quads of first or second order."""
    numbers, points, blocks, sets = [], [], {}, {}
    keyword, target, generate = "", None, False
    for line in pathlib.Path(path).read_text(encoding="utf-8").splitlines():
        if line.startswith("**") or not line.strip():
            continue
        if line.startswith("*"):
            keyword, *options = [word.strip().upper() for word in line.split(",")]
            given = dict(word.replace(" ", "").split("=", 1) for word in options if "=" in word)
            generate = "GENERATE" in options
            if keyword == "*NSET":
                target = sets.setdefault(given["NSET"], [])
            elif keyword == "*ELEMENT":
                target = blocks.setdefault(int(re.search(r"\d+", given["TYPE"]).group()), [])
            continue
        values = [word for word in line.replace(" ", "").split(",") if word]
        if keyword == "*NODE":
            numbers.append(int(values[0]))
            points.append([float(word) for word in values[1:]] + [0.0] * (4 - len(values)))
        elif keyword == "*ELEMENT":
            target.append([int(word) for word in values[1:]])
        elif keyword == "*NSET":
            if generate:
                first, last, step = (int(word) for word in (values + ["1"])[:3])
                target.extend(range(first, last + 1, step))
            else:
                target.extend(values)
    place = {number: i for i, number in enumerate(numbers)}
    members = {}
    for name, values in sets.items():
        flat = []
        for value in values:  # a number, or the name of a set that is part of this one
            flat += [place[int(value)]] if str(value).isdigit() else members[str(value).upper()]
        members[name] = flat
    return Mesh(np.array(points), np.array(numbers), _placed(blocks, place),
                {name: np.array(sorted(set(flat)), int) for name, flat in members.items()})


def _placed(blocks, place):
    return {nodes: np.array([[place[n] for n in element] for element in block]) for nodes, block in blocks.items()}


def read_msh(path):
    """The triangles and quads of a Gmsh file of format 2.2 as text, with the nodes that they use."""
    sections = dict(re.findall(r"\$(\w+)\n(.*?)\n\$End\1", pathlib.Path(path).read_text(encoding="utf-8"), re.S))
    nodes = [line.split() for line in sections["Nodes"].splitlines()[1:]]
    coordinates = {int(words[0]): [float(word) for word in words[1:4]] for words in nodes}
    blocks = {}
    for line in sections["Elements"].splitlines()[1:]:
        words = [int(word) for word in line.split()]
        if words[1] in GMSH_NODES:
            blocks.setdefault(GMSH_NODES[words[1]], []).append(words[3 + words[2]:])
    used = sorted({node for block in blocks.values() for element in block for node in element})
    place = {number: i for i, number in enumerate(used)}
    return Mesh(np.array([coordinates[number] for number in used]), np.arange(1, len(used) + 1), _placed(blocks, place))


def write_inp(mesh, types, path):
    """The mesh as Abaqus file; `types`: the element type for each number of nodes.

    CalculiX reads 20 characters of a number, so 13 digits behind the point.
    """
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{number}, " + ", ".join(f"{x:.13e}" for x in point) for number, point in zip(mesh.numbers, mesh.points)]
    number = 0
    for nodes, block in mesh.blocks.items():
        lines.append(f"*ELEMENT, TYPE={types[nodes]}, ELSET=EALL")
        for element in mesh.numbers[block]:
            number += 1
            lines.append(", ".join(str(n) for n in (number, *element)))
    pathlib.Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_vtk(mesh, sizes, path):
    """The triangles as legacy VTK file, with the point array `Sizing` unless it is None."""
    triangles = mesh.blocks[3]
    with open(path, "w", encoding="utf-8") as file:
        file.write("# vtk DataFile Version 3.0\ntriangles\nASCII\nDATASET POLYDATA\n"
                   f"POINTS {len(mesh.points)} double\n")
        np.savetxt(file, mesh.points, fmt="%.17g")
        file.write(f"POLYGONS {len(triangles)} {4 * len(triangles)}\n")
        np.savetxt(file, np.column_stack([np.full(len(triangles), 3), triangles]), fmt="%d")
        if sizes is not None:
            file.write(f"POINT_DATA {len(mesh.points)}\nSCALARS Sizing double 1\nLOOKUP_TABLE default\n")
            np.savetxt(file, sizes, fmt="%.17g")


# ---- meshers

def gmsh(geometry, folder, name, algorithm, recombination, order=1):
    """The mesh of a geometry in Gmsh's language, which has the sizes, too."""
    source, target = folder / f"{name}.geo", folder / f"{name}.msh"
    source.write_text(geometry, encoding="utf-8")
    options = {"Mesh.Algorithm": algorithm, "Mesh.MeshSizeFromPoints": 0, "Mesh.MeshSizeExtendFromBoundary": 0,
               "Mesh.ElementOrder": order, "Mesh.SecondOrderIncomplete": 1}
    if recombination is not None:
        options |= {"Mesh.RecombineAll": 1, "Mesh.RecombinationAlgorithm": recombination}
    run(["gmsh", source, "-2", "-o", target, "-format", "msh22", "-nt", 1, "-v", 2]
        + [word for item in options.items() for word in ("-setnumber", *item)], folder)
    return read_msh(target)


def gmsh_mesh(problem, folder, job, mesher, count, order):
    """As many elements as wanted, about: Gmsh takes sizes only, so two runs correct the size of the third."""
    algorithm, recombination = GMSH[mesher]
    size = problem.first_size(count)
    for _ in range(2):
        found = gmsh(problem.geometry(float(size)), folder, job, algorithm, recombination).count()
        size *= (found / count) ** 0.5
    mesh = gmsh(problem.geometry(float(size)), folder, job, algorithm, recombination, order)
    write_inp(mesh, problem.types[order], folder / f"{job}_mesh.inp")
    return mesh


def quadrille_mesh(program, surface, problem, folder, job, count, order):
    """The deck as Quadrille writes it is what is solved."""
    target = folder / f"{job}_mesh.inp"
    run([program, surface, target, "--quads", count, "--order", order, "--element", problem.types[order][4 * order],
         "--quiet"], folder)
    return read_inp(target)
