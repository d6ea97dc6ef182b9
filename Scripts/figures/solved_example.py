#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Solves two problems with CalculiX on meshes of Quadrille and of Gmsh, and compares the errors.

  Scripts/figures/solved_example.py OUT [--documentation] [--drawn-again]

A plate with a hole (exact solution known) with even and with graded sizes, and the Scordelis-Lo roof (published
reference); quads by Quadrille, quads and triangles by Gmsh; four sizes; elements of first and second order. OUT gets
all meshes, decks and results, results.csv, the plots, and Simulation.md, the page of the documentation with the
measured section in its place. With --documentation the page and its pictures in the checkout are replaced. With
--drawn-again nothing is solved: page and pictures are made of what is in OUT.

Needs ccx and gmsh (Debian: calculix-ccx, gmsh) and a build of Quadrille in build/ (or --quadrille PATH). Takes about
ten minutes on one core; CalculiX has to read every deck without a warning.
"""
import argparse
import pathlib
import shutil
import sys

from simulation import calculix, meshes, page, pictures, plate, roof, study

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENTATION = ROOT / "Documentation"


def solve_all(problems, program, folder):
    rows = []
    for problem in problems:
        surface = study.make_surface(problem, folder)
        for order in (1, 2):
            for mesher in study.MESHERS:
                for count in problem.sizes:
                    row = study.solve(problem, program, surface, folder, mesher, order, count)
                    rows.append(row)
                    print(f"{problem.name}, {mesher}, order {order}: {row['elements']} elements, "
                          f"{row['freedoms']} degrees of freedom, error {row['error']:.3e}, "
                          f"{problem.local} {row['local']:.4f}", flush=True)
    return rows


def draw(problems, rows, folder):
    even, graded, shell = problems
    target = folder / "Pictures"
    target.mkdir(exist_ok=True)
    pictures.errors(rows, (graded, even), target, "simulation-plate")
    pictures.errors(rows, (shell,), target, "simulation-roof")

    def found(problem, mesher, count, read):
        job = study.job_name(problem, mesher, 2, count)
        mesh = meshes.read_inp(folder / f"{job}_mesh.inp")
        return mesh, read(folder, job, mesh)

    pictures.solutions(*found(graded, study.OURS, 600, calculix.nodal_stresses),
                       *found(shell, study.OURS, 384, calculix.displacements), target, "simulation-solutions")
    pictures.where_errors_are([(mesher, *found(even, mesher, 2400, calculix.displacements))
                               for mesher in (study.OURS, "Gmsh, recombined")], target, "simulation-errors")


def require_programs(parser, quadrille):
    for program, remedy in (("ccx", "apt-get install calculix-ccx"), ("gmsh", "apt-get install gmsh"),
                            (str(quadrille), "build it, or give --quadrille")):
        if not shutil.which(program):
            parser.error(f"{program} is not there: {remedy}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path, help="folder, made if it is not there")
    parser.add_argument("--quadrille", type=pathlib.Path, default=ROOT / "build" / "bin" / "quadrille")
    parser.add_argument("--documentation", action="store_true", help="replace page and pictures in the checkout")
    parser.add_argument("--drawn-again", action="store_true", help="solve nothing; take what is in OUT")
    chosen = parser.parse_args()
    require_programs(parser, chosen.quadrille)
    folder = chosen.out.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    problems = plate.Plate(graded=False), plate.Plate(graded=True), roof.Roof()
    if not chosen.drawn_again:
        try:
            study.write_rows(solve_all(problems, chosen.quadrille.resolve(), folder), folder / "results.csv")
        except (calculix.SolverError, meshes.MesherError) as error:
            print(f"solved_example: {error}", file=sys.stderr)
            return 1
    rows = study.read_rows(folder / "results.csv")
    draw(problems, rows, folder)
    text = page.fill((DOCUMENTATION / "Simulation.md").read_text(encoding="utf-8"),
                     page.section(problems, rows, chosen.quadrille.resolve()))
    (folder / "Simulation.md").write_text(text, encoding="utf-8")
    if chosen.documentation:
        shutil.copy(folder / "Simulation.md", DOCUMENTATION)
        shutil.copytree(folder / "Pictures", DOCUMENTATION / "Pictures", dirs_exist_ok=True)
    print(f"{folder / 'Simulation.md'} is written")
    return 0


if __name__ == "__main__":
    sys.exit(main())
