#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""clang-tidy with the .clang-tidy of the repository finds nothing in Core.

  check_tidy.py SOURCE_DIR CLANG_TIDY WORK_DIR INCLUDE_DIR... [--only MODULE]

A source of Core costs clang-tidy 17 seconds, nearly all of it for the headers of Eigen and of the standard library. So
many sources, of all modules, are included in one here, in which no names of anonymous namespaces meet (see
CMake/unity_groups.py): fifty of them take 44 seconds of one core.
"""
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "CMake"))
import unity_groups

from check_sources import CGAL_INCLUDE

# Sources are included on purpose, in the file that this script writes.
LEFT_OUT = "-bugprone-suspicious-include"
AT_ONCE = 60  # sources; clang-tidy takes 1 GB for them
FINDING = re.compile(r"^(.+?:\d+:\d+: (?:warning|error): .+)$", re.MULTILINE)


def sourcesOf(folder):
    """Sources with CGAL's headers would cost as much as all others together."""
    return sorted(path for path in folder.rglob("*.cpp") if not CGAL_INCLUDE.search(path.read_text()))


def findings(program, unit, filterOfNames, includes):
    """What clang-tidy says of the files that a source includes, one line each; RuntimeError where it failed itself."""
    command = [program, "--quiet", f"--checks={LEFT_OUT}", f"--header-filter={filterOfNames}", str(unit), "--",
               "-std=c++17", "-DNDEBUG", '-DQUADRILLE_VERSION=""', *(word for folder in includes for word in folder)]
    result = subprocess.run(command, capture_output=True, text=True)
    found = sorted(set(FINDING.findall(result.stdout)))
    if result.returncode != 0 and not found:
        raise RuntimeError(f"{' '.join(command)}\n{result.stdout}{result.stderr}")
    return found


def check(program, root, work, includes, number, sources):
    begin = time.perf_counter()
    unit = work / f"unit{number}.cpp"
    unit.write_text("".join(f'#include "{path}"\n' for path in sources))
    found = findings(program, unit, re.escape(str(root / "Core")) + r"/.*\.(h|cpp)$", includes)
    print(f"tidy: {len(sources)} sources, {time.perf_counter() - begin:.0f} s", flush=True)
    return found


def selftest(program, style):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / ".clang-tidy").write_text(style)
        (folder / "a.h").write_text("namespace some\n{\ninline int Wrong_Name()\n{\n  return 1;\n}\n}\n")
        (folder / "unit.cpp").write_text('#include "a.h"\n')
        found = findings(program, folder / "unit.cpp", re.escape(str(folder)), [])
        assert len(found) == 1 and "a.h:3:" in found[0] and "readability-identifier-naming" in found[0], found


def main():
    arguments = sys.argv[1:]
    only = arguments[arguments.index("--only") + 1] if "--only" in arguments else None
    arguments = arguments[:arguments.index("--only")] if only else arguments
    root, program, work = pathlib.Path(arguments[0]), arguments[1], pathlib.Path(arguments[2])
    if program.endswith("-NOTFOUND"):
        sys.exit("tidy: no clang-tidy here. Install the package clang-tidy "
                 "(Scripts/build/install-dependencies.sh does), then run "
                 "cmake -U QUADRILLE_CLANG_TIDY on the build folder")
    style = (root / ".clang-tidy").read_text()
    selftest(program, style)
    work.mkdir(parents=True, exist_ok=True)
    (work / ".clang-tidy").write_text(style)
    includes = [("-I", str(root / "Core"))] + [("-isystem", folder) for folder in arguments[3:]]
    sources = sourcesOf(root / "Core" / (only or ""))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        parts = pool.map(lambda unit: check(program, root, work, includes, *unit),
                         enumerate(unity_groups.groupsOf(sources, AT_ONCE)))
        found = sorted({line.replace(f"{root}/", "") for part in parts for line in part})
    print("\n".join(found) or f"tidy: {len(sources)} sources, fine")
    return 1 if found or not sources else 0


if __name__ == "__main__":
    sys.exit(main())
