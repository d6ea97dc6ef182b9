# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The measured section of Documentation/Simulation.md."""
import re
import subprocess
import textwrap

from . import calculix, meshes, study

BEGIN = "<!-- measured: from here to the end mark by Scripts/figures/solved_example.py -->"
END = "<!-- measured: end -->"
COLUMNS = 120


def fill(text, section):
    """The page with the section between its marks."""
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        raise ValueError("Simulation.md has to have the marks of the measured section, once each")
    head, rest = text.split(BEGIN)
    return f"{head}{BEGIN}\n\n{section}\n{END}{rest.split(END)[1]}"


def _versions(program):
    def said(command):
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        return re.search(r"\d+(?:\.\d+)+", done.stdout + done.stderr).group()
    ours, gmsh = said([program, "--version"]), said(["gmsh", "--version"])
    return f"Quadrille {ours}, CalculiX {calculix.version()}, Gmsh {gmsh}."


def _table(head, lines):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
                     + ["| " + " | ".join(line) + " |" for line in lines])


def _figures(problem, rows):
    """All meshes: a line for each mesher and size, first and second order side by side."""
    lines = []
    for mesher in study.MESHERS:
        for count in problem.sizes:
            pair = [next(row for row in rows if (row["problem"], row["mesher"], row["order"], row["count"])
                         == (problem.name, mesher, order, count)) for order in (1, 2)]
            first = pair[0]
            elements = str(first["elements"])
            if first["triangles"] and first["triangles"] != first["elements"]:
                elements += f" ({first['triangles']} triangles)"
            words = [mesher, elements, "" if first["irregular"] is None else str(first["irregular"])]
            for row in pair:
                words += [str(row["freedoms"]), f"{100 * row['error']:.3g} %", f"{row['local']:.4f}"]
            lines.append(words)
    columns = [word for order in (1, 2) for word in
               (f"dof, {'first' if order == 1 else 'second'} order", "error", problem.local_name)]
    return _table(["mesh", "elements", "irregular", *columns], lines)


def _comparison(problem, rows):
    """The error of the others over ours, at our degrees of freedom."""
    others = [mesher for mesher in study.MESHERS if mesher != study.OURS]
    lines = []
    for order in (1, 2):
        for freedoms, error in zip(*study.series(rows, problem, study.OURS, order)):
            ratios = [f"{study.error_at(freedoms, rows, problem, mesher, order) / error:.2f}" for mesher in others]
            lines.append([f"{'first' if order == 1 else 'second'}", f"{freedoms:.0f}", f"{100 * error:.3g} %", *ratios])
    for order in (1, 2):
        slopes = [f"{study.slope(rows, problem, mesher, order):.2f}" for mesher in others]
        lines.append([f"slope, {'first' if order == 1 else 'second'}", f"theory {problem.slopes[order]:g}",
                      f"{study.slope(rows, problem, study.OURS, order):.2f}", *slopes])
    return _table(["order", "dof", "Quadrille", *others], lines)


def section(problems, rows, program):
    parts = [_versions(program),
             "Gmsh's settings: " + "; ".join(
                 f"*{name}*: `Mesh.Algorithm` {algorithm}"
                 + ("" if recombination is None else f", `Mesh.RecombinationAlgorithm` {recombination}")
                 for name, (algorithm, recombination) in meshes.GMSH.items())
             + ". The sizes asked for hold everywhere (`Mesh.MeshSizeFromPoints` and "
             "`Mesh.MeshSizeExtendFromBoundary` 0) and are corrected twice so that about as many elements come as "
             "Quadrille makes. All other settings of all programs are their defaults."]
    for problem in problems:
        parts += [f"### {problem.title}", f"Error of Quadrille, and of the others over it at equal degrees of freedom "
                  f"({problem.measure}); above 1, Quadrille's is smaller.", _comparison(problem, rows),
                  "All meshes; *irregular*: vertices inside without four quads. By the reference the "
                  f"{problem.local_name} is {problem.local_exact:g}.", _figures(problem, rows)]
    return "\n\n".join(part if part.startswith("|") else textwrap.fill(part, COLUMNS, break_on_hyphens=False)
                       for part in parts) + "\n"
