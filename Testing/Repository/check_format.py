#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Each source is what clang-format makes of it with the .clang-format of the repository.

  check_format.py SOURCE_DIR CLANG_FORMAT

Versions of clang-format differ in what they make of a source; the one that counts is Debian 12's.
"""
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from check_sources import repositoryFiles

VERSION = 14
ENDINGS = {".h", ".cpp", ".cxx"}
VIOLATION = re.compile(r"^(.+?):(\d+):\d+: (?:warning|error): code should be clang-formatted", re.MULTILINE)


def versionOf(program):
    if not program or program.endswith("-NOTFOUND"):
        return None
    text = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    match = re.search(r"version (\d+)", text)
    return int(match.group(1)) if match else None


def linesToMend(program, files):
    """{file: first line that clang-format would change, with the number of places}. RuntimeError where it fails."""
    if not files:
        return {}
    result = subprocess.run([program, "--style=file", "--dry-run", *map(str, files)], capture_output=True, text=True)
    if result.returncode != 0:
        raise RuntimeError(result.stderr or f"{program} ended with {result.returncode}")
    found = {}
    for name, line in VIOLATION.findall(result.stderr):
        first, count = found.get(name, (int(line), 0))
        found[name] = (min(first, int(line)), count + 1)
    return found


def inParallel(program, files):
    count = os.cpu_count() or 1
    with concurrent.futures.ThreadPoolExecutor(count) as pool:
        parts = pool.map(lambda i: linesToMend(program, files[i::count]), range(count))
        return {name: place for part in parts for name, place in part.items()}


def selftest(program, style):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / ".clang-format").write_text(style)
        (folder / "good.h").write_text("int one();\nint two(int* a);\n")
        (folder / "bad.h").write_text("int one();\nint two( int *a );\n")
        found = linesToMend(program, [folder / "good.h", folder / "bad.h"])
        assert list(found) == [str(folder / "bad.h")] and found[str(folder / "bad.h")][0] == 2, found


def main():
    root, program = pathlib.Path(sys.argv[1]), sys.argv[2]
    if versionOf(program) != VERSION:
        sys.exit(f"format: no clang-format {VERSION} here, the version of Debian 12, but {program}. Install the "
                 "package clang-format (Scripts/build/install-dependencies.sh does), then run "
                 "cmake -U QUADRILLE_CLANG_FORMAT on the build folder")
    selftest(program, (root / ".clang-format").read_text())
    files = sorted(p for p in repositoryFiles(root) if p.suffix in ENDINGS)
    found = inParallel(program, files)
    if not files:
        sys.exit("format: no file found")
    names = sorted(str(pathlib.Path(name).relative_to(root)) for name in found)
    for name in names:
        line, places = found[str(root / name)]
        print(f"{name}:{line}: not as clang-format writes it ({places} place{'s' if places > 1 else ''})")
    if names:
        print(f"In the source folder: {pathlib.Path(program).name} -i {' '.join(names)}")
    else:
        print(f"format: {len(files)} files, fine")
    return 1 if names else 0


if __name__ == "__main__":
    sys.exit(main())
