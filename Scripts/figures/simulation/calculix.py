# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs CalculiX on a deck and reads what it writes."""
import re
import subprocess

import numpy as np

LIMIT = 1800  # seconds that a solution may take
#: Displacements of all nodes for us; with stresses, at the nodes of shells and plane elements, for viewers.
OUTPUT = ["*NODE PRINT, NSET=NALL", "U", "*NODE FILE, OUTPUT=2D", "U", "*EL FILE, OUTPUT=2D", "S"]


class SolverError(RuntimeError):
    """CalculiX refused a deck or had something to say about it; the message has its words."""


def version():
    done = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False)
    return re.search(r"Version (\S+)", done.stdout).group(1)


def write(folder, job, lines):
    (folder / f"{job}.inp").write_text("\n".join(lines) + "\n", encoding="utf-8")


def solve(folder, job):
    """Solves JOB.inp. Returns the number of equations. Raises SolverError where CalculiX warns, too."""
    done = subprocess.run(["ccx", job], cwd=folder, capture_output=True, text=True, timeout=LIMIT, check=False,
                          env={"OMP_NUM_THREADS": "1", "PATH": "/usr/bin:/bin"})
    words = done.stdout + done.stderr
    (folder / f"{job}.log").write_text(words, encoding="utf-8")
    told = re.findall(r"\*(?:WARNING|ERROR).*\n.*", words)
    if told or done.returncode != 0 or "Job finished" not in words:
        raise SolverError(f"{folder / job}.inp: CalculiX ended with {done.returncode}"
                          + "".join(f"\n{word}" for word in told[:5]))
    return int(re.search(r"number of equations\s+(\d+)", words).group(1))


def displacements(folder, job, mesh):
    """#nodes by 3, from the print of all nodes in JOB.dat."""
    text = (folder / f"{job}.dat").read_text(encoding="utf-8")
    rows = re.search(r"displacements .*?\n\n((?:.+\n)+)", text).group(1)
    return _by_node(((int(n), values) for n, *values in (row.split() for row in rows.splitlines())), mesh)


def nodal_stresses(folder, job, mesh):
    """#nodes by 6 (xx yy zz xy yz zx), averages at nodes of what is extrapolated, as JOB.frd has them for viewers."""
    lines = (folder / f"{job}.frd").read_text(encoding="utf-8").splitlines()
    begin = next(i for i, line in enumerate(lines) if line.startswith(" -4  STRESS"))
    rows = []
    for line in lines[begin + 1:]:
        if line.startswith(" -3"):
            break
        if line.startswith(" -1"):
            rows.append((int(line[3:13]), [line[i:i + 12] for i in range(13, 85, 12)]))
    return _by_node(rows, mesh)


def _by_node(rows, mesh):
    found = {number: [float(value) for value in values] for number, values in rows}
    return np.array([found[number] for number in mesh.numbers])
