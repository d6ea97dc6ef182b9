#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Holds the includes of Core against the layers: a module includes only itself and the modules below it
that it may know, and no VTK. The same for the folders of Filters, whose VTK classes may include all of them.

  check_layers.py SOURCE_DIR [--selftest]
"""
import pathlib
import re
import sys

# Who may include whom, one step; what a module reaches through its neighbours it may include as well.
MAY_INCLUDE = {
    "Base": [],
    "Mesh": ["Base"],
    "Features": ["Mesh"],
    "Requests": ["Mesh"],
    "Prepare": ["Features", "Requests"],
    "Details": ["Mesh"],
    "Sizes": ["Mesh"],
    "Numerics": ["Base"],
    "Hierarchy": ["Requests"],
    "CrossField": ["Requests", "Numerics"],
    "Integers": ["CrossField"],
    "GridMap": ["Integers"],
    "Transfer": ["Hierarchy", "GridMap"],
    "Quads": ["Mesh"],
    "Filling": ["Quads"],
    "Extraction": ["Filling"],
    "Elements": ["Quads"],
    "ForeignMaps": ["Extraction"],
    "Evaluation": ["GridMap", "Extraction"],
    "Export": ["Base"],  # files need no more than the elements
    "Import": ["Base"],  # readers, for programs and Python alike
    "Pipeline": ["Prepare", "Details", "Sizes", "Transfer", "Filling", "Evaluation"],  # one surface, as a whole
    "Symmetry": ["Pipeline"],  # ways that make several runs, or one of another surface
    "Assembly": ["Pipeline"],
    "Pieces": ["Pipeline"],
    "Session": ["Symmetry", "Pieces"],
    "Ways": ["Pieces", "Session"],  # which of them a run takes
    "Api": ["Ways"],  # the library for C++ programs
    "Repair": ["Prepare"],  # with CGAL, and nothing of Core needs it: it can be left out
}
# The folders of Filters in the same way; headers of Core and of VTK they may all include.
FILTERS_MAY_INCLUDE = {
    "Common": [],
    "Convert": ["Common"],  # surfaces, quads and their arrays, from VTK and to VTK
    "Ranks": ["Convert"],
    "Blocks": ["Ranks"],
    "Constraints": ["Convert"],
    "ElementGrids": ["Convert"],
    "Files": ["ElementGrids"],
    "Stages": ["Blocks"],  # what stage filters hand to each other
    "Runs": ["Constraints", "Blocks"],  # runs in the background, and what a run made, as VTK data
}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def reachable(module, table=MAY_INCLUDE):
    found = {module}
    for other in table[module]:
        found |= reachable(other, table)
    return found


def violations(module, name, text):
    """Includes of one file of Core that its layer forbids."""
    result = []
    for bracket, path in INCLUDE.findall(text):
        first = path.split("/")[0]
        if path.startswith("vtk"):
            result.append(f"{name}: Core must not know VTK: {path}")
        elif bracket == '"' and first in MAY_INCLUDE and first not in reachable(module):
            result.append(f"{name}: {module} must not include {path}")
        elif bracket == '"' and first not in MAY_INCLUDE:
            result.append(f"{name}: \"{path}\" is no header of Core; name it as Module/Header.h")
    return result


def violationsOfFilters(folder, name, text):
    """The same for one file of a folder of Filters."""
    result = []
    for bracket, path in INCLUDE.findall(text):
        first = path.split("/")[0]
        if first in FILTERS_MAY_INCLUDE and first not in reachable(folder, FILTERS_MAY_INCLUDE):
            result.append(f"{name}: Filters/{folder} must not include {path}")
        elif bracket == '"' and re.match(r"vtk(Quad|IntegerGrid|Decimation|Surface)\w+\.h$", path):
            result.append(f"{name}: what filters call must not know the filters: {path}")
    return result


def check(root):
    result, files = [], 0
    for folder in sorted(p.name for p in (root / "Filters").iterdir() if p.is_dir() and p.name != "Python"):
        if folder not in FILTERS_MAY_INCLUDE:
            result.append(f"Filters/{folder}: a folder that the layers do not know")
            continue
        for path in sorted((root / "Filters" / folder).rglob("*")):
            result += violationsOfFilters(folder, str(path.relative_to(root)), path.read_text())
    for module in sorted(p.name for p in (root / "Core").iterdir() if p.is_dir()):
        if module not in MAY_INCLUDE:
            result.append(f"Core/{module}: a module that the layers do not know")
            continue
        for path in sorted((root / "Core" / module).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                files += 1
                result += violations(module, str(path.relative_to(root)), path.read_text())
    if files == 0:
        result.append("no source file found")
    return result


def selftest():
    assert not violations("Mesh", "a", '#include "Mesh/Mesh.h"\n#include <vector>\n#include "Base/Types.h"\n')
    assert violations("Mesh", "a", '#include "Hierarchy/Hierarchy.h"\n')
    assert violations("Numerics", "a", '#include "Mesh/Mesh.h"\n')
    assert violations("Pipeline", "a", "#include <vtkPolyData.h>\n")
    assert violations("Mesh", "a", '  #  include "Mesh.h"\n')
    below = reachable("Session") - {"Session"}
    assert not violations("Session", "a", "".join(f'#include "{m}/X.h"\n' for m in below))
    assert violations("Session", "a", '#include "Repair/Soup.h"\n')
    assert not set(MAY_INCLUDE) & set(FILTERS_MAY_INCLUDE), "an include would be of either"
    assert not violationsOfFilters("Ranks", "a", '#include "Mesh/Mesh.h"\n#include "Convert/Quads.h"\n')
    assert violationsOfFilters("Convert", "a", '#include "Ranks/Ranks.h"\n')
    assert violationsOfFilters("Convert", "a", '#include "vtkQuadRemesh.h"\n')


def main():
    selftest()
    problems = check(pathlib.Path(sys.argv[1]))
    print("\n".join(problems) or "layers: fine")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
