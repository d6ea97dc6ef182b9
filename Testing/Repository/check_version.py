#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The version of Quadrille is written in CMakeLists.txt, and nowhere else. Where a major version has to be named (the
soname, its package, find_package), it is that of CMakeLists.txt; the change log begins with what is unreleased, or with
this version. Figures that were measured, between the marks of their script, tell what they were measured with.

  check_version.py SOURCE_DIR
"""
import pathlib
import re
import sys

from check_sources import BINARY, repositoryFiles

PLACE = "CMakeLists.txt"
PROJECT = re.compile(r"^project\(Quadrille VERSION (\d+\.\d+\.\d+)\b", re.MULTILINE)
# A version of Quadrille in words, in a file's name, or as a value.
WRITTEN = re.compile(r"\bquadrille(?: version)?[ _-]v?(\d+\.\d+(?:\.\d+)?)|__version__\s*=\s*[\"'](\d[\w.]*)",
                     re.IGNORECASE)
MAJOR = re.compile(r"find_package\(Quadrille (\d[\d.]*)|libquadrille\.so\.(\d+(?:\.\d+)*)|\blibquadrille(\d+)\b")
MEASURED = re.compile(r"<!-- measured: from here.*?<!-- measured: end -->", re.DOTALL)
HEADING = re.compile(r"^## (\S+)", re.MULTILINE)


def blanked(match):
    return re.sub(r"[^\n]", " ", match.group(0))


def problems(path, text, version):
    """Of one file; its path from the root."""
    if path.name == "CHANGELOG.md":
        first = HEADING.search(text)
        return [] if first and first.group(1) in ("Unreleased", version) else [
            f"{path}: begins with {first.group(1) if first else 'no heading'}, not with Unreleased or {version}"]
    text = MEASURED.sub(blanked, text)
    if path == pathlib.PurePath(PLACE):
        text = PROJECT.sub(blanked, text, count=1)
    found = []
    itself = re.compile(rf"(?<![\d.]){re.escape(version)}(?![\d.]*\d)")
    for number, line in enumerate(text.splitlines(), 1):
        where = f"{path}:{number}: {line.strip()[:80]!r}"
        if itself.search(line) or WRITTEN.search(line):
            found.append(f"{where} has a version of Quadrille, which is to be taken from {PLACE}")
        for match in MAJOR.finditer(line):
            named = next(group for group in match.groups() if group)
            if named != version.split(".")[0]:
                found.append(f"{where} names {named}, but the major version is {version.split('.')[0]}")
    return found


def selftest():
    def of(text, name="a.md"):
        return problems(pathlib.PurePath(name), text, "3.2.10")

    assert of("project(Quadrille VERSION 3.2.10 LANGUAGES C CXX", PLACE) == []
    assert len(of("project(Quadrille VERSION 3.2.10 LANGUAGES C CXX\nset(V 3.2.10)", PLACE)) == 1
    assert len(of("about 3.2.10.\n")) == 1 and not of("13.2.10, 3.2.101, 3.2.10.4")
    assert of("made by Quadrille 0.9") and of("quadrille_0.9.1-1_amd64.deb") and of('__version__ = "0.9"', "a.py")
    assert not of("find_package(Quadrille 3 REQUIRED), libquadrille.so.3, libquadrille3, libquadrille-dev")
    assert of("find_package(Quadrille 3.2 REQUIRED)") and of("libquadrille.so.2") and of("apt install libquadrille2")
    measured = "<!-- measured: from here to the end mark by a.py -->\nQuadrille 0.9.1\n<!-- measured: end -->\n"
    assert not of(measured) and of(measured + "Quadrille 0.9.1")[0].startswith("a.md:4:")
    assert not of("# C\n## Unreleased\n", "CHANGELOG.md") and not of("## 3.2.10 (a day)\n## 3.2.9", "CHANGELOG.md")
    assert of("## 3.2.9", "CHANGELOG.md") and of("", "CHANGELOG.md")


def main():
    selftest()
    root = pathlib.Path(sys.argv[1])
    match = PROJECT.search((root / PLACE).read_text())
    if not match:
        sys.exit(f"{PLACE}: no project(Quadrille VERSION MAJOR.MINOR.PATCH")
    this = pathlib.PurePath("Testing/Repository/check_version.py")
    files = [p for p in repositoryFiles(root) if p.suffix not in BINARY and p.relative_to(root) != this]
    found = [line for path in files for line in problems(path.relative_to(root), path.read_text(), match.group(1))]
    print("\n".join(found) or f"version: {match.group(1)}, {len(files)} files, fine")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
