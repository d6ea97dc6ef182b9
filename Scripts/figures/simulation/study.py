# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes a problem with each mesher at each size, solves it, and measures the error: a row each."""
import csv

import numpy as np

from . import calculix, meshes

OURS = "Quadrille"
MESHERS = (OURS, *meshes.GMSH)
COLUMNS = ("problem", "mesher", "order", "count", "elements", "triangles", "irregular", "nodes", "freedoms",
           "equations", "error", "local", "hole")


def job_name(problem, mesher, order, count):
    word = mesher.split()[-1].lower()
    return f"{problem.name}_{word}_{order}_{count}"


def make_surface(problem, folder):
    """Writes the triangles that Quadrille gets, and returns the path."""
    path = folder / f"{problem.name}.vtk"
    meshes.write_vtk(*problem.surface(folder), path)
    return path


def solve(problem, program, surface, folder, mesher, order, count):
    """Quads are as many as `count`, about; triangles twice as many, so that nodes are."""
    job = job_name(problem, mesher, order, count)
    if mesher == OURS:
        mesh = meshes.quadrille_mesh(program, surface, problem, folder, job, count, order)
    else:
        wanted = count if meshes.GMSH[mesher][1] is not None else 2 * count
        mesh = meshes.gmsh_mesh(problem, folder, job, mesher, wanted, order)
    calculix.write(folder, job, problem.deck(mesh, f"{job}_mesh.inp"))
    equations = calculix.solve(folder, job)
    measured = problem.measures(folder, job, mesh)
    row = {"problem": problem.name, "mesher": mesher, "order": order, "count": count, "elements": mesh.count(),
           "triangles": sum(len(block) for nodes, block in mesh.blocks.items() if nodes in (3, 6)),
           "irregular": mesh.irregular(), "nodes": len(mesh.points), "freedoms": problem.freedoms * len(mesh.points),
           "equations": equations, "error": measured["error"], "local": measured[problem.local],
           "hole": measured.get("hole")}
    return row


def write_rows(rows, path):
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)


def read_rows(path):
    def value(name, word):
        if word == "":
            return None
        if name in ("problem", "mesher"):
            return word
        return float(word) if name in ("error", "local", "hole") else int(word)

    with open(path, encoding="utf-8", newline="") as file:
        return [{name: value(name, word) for name, word in row.items()} for row in csv.DictReader(file)]


def series(rows, problem, mesher, order):
    """(degrees of freedom, errors) of the rows of one mesher, from coarse to fine."""
    found = sorted((row["freedoms"], row["error"]) for row in rows
                   if (row["problem"], row["mesher"], row["order"]) == (problem.name, mesher, order))
    return tuple(np.array(column, float) for column in zip(*found))


def error_at(freedoms, rows, problem, mesher, order):
    """The error of a series at a number of degrees of freedom: straight in logarithms between its meshes, with the
    theory's slope beyond them."""
    known, errors = series(rows, problem, mesher, order)
    nearest = known[0] if freedoms < known[0] else known[-1] if freedoms > known[-1] else freedoms
    inside = np.exp(np.interp(np.log(nearest), np.log(known), np.log(errors)))
    return float(inside * (nearest / freedoms) ** problem.slopes[order])


def slope(rows, problem, mesher, order):
    """By how much the error falls with the degrees of freedom, over all sizes: an exponent."""
    known, errors = series(rows, problem, mesher, order)
    return float(-np.polyfit(np.log(known), np.log(errors), 1)[0])
