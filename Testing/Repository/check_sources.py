#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Every source file names its licence; no file of the repository holds a path of somebody's machine; names of tests in
C++ are in CamelCase.

  check_sources.py SOURCE_DIR
"""
import os
import pathlib
import re
import subprocess
import sys

SOURCES = {".h", ".cpp", ".cxx", ".py", ".cmake", ".sh", ".xml"}
SOURCE_NAMES = {"CMakeLists.txt", "run"}
LICENSE_LINES = ("SPDX-FileCopyrightText:", "SPDX-License-Identifier: BSD-3-Clause")
# Sources that include CGAL, whose packages are GPL, are GPL as well, and stand in one module that can be left out.
GPL_LINES = ("SPDX-FileCopyrightText:", "SPDX-License-Identifier: GPL-3.0-or-later")
CGAL_INCLUDE = re.compile(r'^\s*#\s*include\s*(?:<CGAL/|"Repair/CgalMesh\.h")', re.MULTILINE)
CGAL_FOLDER = pathlib.PurePath("Core/Repair")
# Folders of people's machines; what every Linux has (/usr, /proc, ...) may be named.
MACHINE_PATH = re.compile(r"(?<![\w.$}\])/])/(?:work|home|root|tmp|mnt|Users|workspace|builds?|data)/[\w.-]")
TEST_NAME = re.compile(r"^(?:TEST|TEST_F|TEST_P|TYPED_TEST)\((\w+),\s*(?:DISABLED_)?(\w+)", re.MULTILINE)
BINARY = {".ply", ".png", ".vtp", ".stl", ".ex2", ".gz"}


def repositoryFiles(root):
    """What git tracks; outside of a git checkout everything but build folders and hidden ones."""
    listing = subprocess.run(["git", "-C", str(root), "ls-files", "-z"], capture_output=True)\
        if (root / ".git").exists() and any(os.access(os.path.join(d, "git"), os.X_OK) for d in os.get_exec_path()) \
        else None
    if listing is not None and listing.returncode == 0:
        names = [n for n in listing.stdout.decode().split("\0") if n]
        return [root / n for n in names if (root / n).is_file()]
    found = []
    for folder, folders, files in os.walk(root):
        isTop = pathlib.Path(folder) == root
        folders[:] = sorted(f for f in folders if not (isTop and f.startswith("build"))
                            and not f.startswith("__pycache__") and f not in (".git", "out"))
        found += [pathlib.Path(folder) / f for f in sorted(files)]
    return found


def licenseProblem(path, text):
    if path.suffix not in SOURCES and path.name not in SOURCE_NAMES:
        return None
    head = "\n".join(text.splitlines()[:6])
    includesCgal = path.suffix in (".h", ".cpp", ".cxx") and bool(CGAL_INCLUDE.search(text))
    if includesCgal and path.parent != CGAL_FOLDER:
        return f"{path}: includes CGAL; only {CGAL_FOLDER} does"
    missing = [line for line in (GPL_LINES if includesCgal else LICENSE_LINES) if line not in head]
    return f"{path}: no \"{missing[0]}\" in its first lines" if missing else None


def pathProblems(path, text):
    return [f"{path}:{number}: path of a machine: {match.group(0)}..."
            for number, line in enumerate(text.splitlines(), 1) for match in MACHINE_PATH.finditer(line)]


def testNameProblems(path, text):
    if path.suffix not in (".cpp", ".cxx"):
        return []
    return [f"{path}: the test {suite}.{name} is not in CamelCase" for suite, name in TEST_NAME.findall(text)
            if not re.fullmatch(r"[A-Z][A-Za-z0-9]*", suite) or not re.fullmatch(r"[A-Z][A-Za-z0-9]*", name)]


def selftest():
    machine = "/wo" + "rk/somewhere"
    assert pathProblems("a", f'open("{machine}")') and pathProblems("a", f"cd {machine}")
    assert not pathProblems("a", f"${{CMAKE_SOURCE_DIR}}{machine}")
    assert not pathProblems("a", "a/work/b, #!/usr/bin/python3")
    assert testNameProblems(pathlib.Path("a.cpp"), "TEST(Some, thing)\n")
    assert not testNameProblems(pathlib.Path("a.cpp"), "TEST_P(Some, DISABLED_Thing2)\n")
    gpl, bsd = (f"// {lines[0]}\n// {lines[1]}\n" for lines in (GPL_LINES, LICENSE_LINES))
    cgal = "#include <CGAL/Surface_mesh.h>\n"
    assert not licenseProblem(CGAL_FOLDER / "a.cpp", gpl + cgal) and licenseProblem(CGAL_FOLDER / "a.cpp", bsd + cgal)
    assert licenseProblem(pathlib.PurePath("Core/Mesh/a.cpp"), gpl + cgal)
    assert licenseProblem(CGAL_FOLDER / "a.cpp", gpl) and not licenseProblem(CGAL_FOLDER / "a.cpp", bsd)
    assert licenseProblem(pathlib.Path("a.h"), "#pragma once\n") and not licenseProblem(pathlib.Path("a.md"), "x")


def main():
    selftest()
    root = pathlib.Path(sys.argv[1])
    files = repositoryFiles(root)
    problems = [] if files else ["no file found"]
    for path in files:
        if path.suffix in BINARY:
            continue
        try:
            text = path.read_text()
        except UnicodeDecodeError:
            problems.append(f"{path}: neither text nor a known binary kind")
            continue
        name = path.relative_to(root)
        problems += [p for p in [licenseProblem(name, text)] if p]
        problems += pathProblems(name, text) + testNameProblems(name, text)
    print("\n".join(problems) or f"sources: {len(files)} files, fine")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
