#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Every source of Core includes what it uses, so that it compiles whatever is compiled with it. QUADRILLE_UNITY_BUILD,
with which the tests are built, compiles several sources as one and would not notice.

  check_alone.py SOURCE_DIR COMPILER WORK_DIR INCLUDE_DIR...

The headers of Eigen and of the standard library are compiled once for all of them: five minutes of two cores. By hand,
and by Scripts/check/check-release.sh; the test repository.includes sees most of it in two seconds. Left out are sources
with CGAL's headers.
"""
import concurrent.futures
import os
import pathlib
import subprocess
import sys

from check_sources import CGAL_INCLUDE

STANDARD = ("algorithm", "array", "atomic", "chrono", "cmath", "fstream", "functional", "map", "memory", "mutex",
            "optional", "queue", "set", "sstream", "string", "thread", "tuple", "unordered_map", "utility", "vector")


def problem(command, source):
    result = subprocess.run([*command, str(source)], capture_output=True, text=True)
    if result.returncode == 0:
        return None
    return f"{source} does not compile alone:\n" + "\n".join(
        line for line in result.stderr.splitlines() if "error" in line)


def main():
    root, compiler, work = pathlib.Path(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3])
    work.mkdir(parents=True, exist_ok=True)
    common = work / "common.h"
    common.write_text("#include <Eigen/Dense>\n#include <Eigen/Sparse>\n" +
                      "".join(f"#include <{name}>\n" for name in STANDARD))
    options = ["-std=c++17", "-O0", '-DQUADRILLE_VERSION=""', "-I", str(root / "Core"),
               *(word for folder in sys.argv[4:] for word in ("-isystem", folder))]
    subprocess.run([compiler, *options, "-x", "c++-header", str(common), "-o", f"{common}.gch"], check=True)
    command = [compiler, *options, "-fsyntax-only", "-include", str(common)]
    (work / "wrong.cpp").write_text("ProgressCallback progress;\n")
    assert "ProgressCallback" in (problem(command, work / "wrong.cpp") or "")
    sources = [path for path in sorted((root / "Core").rglob("*.cpp")) if not CGAL_INCLUDE.search(path.read_text())]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        found = [text for text in pool.map(lambda source: problem(command, source), sources) if text]
    print("\n".join(found) or f"alone: {len(sources)} sources, fine")
    return 1 if found or not sources else 0


if __name__ == "__main__":
    sys.exit(main())
