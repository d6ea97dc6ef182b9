#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""One word for one thing: words that stood for what the table *Words* of Documentation/Design.md gives another name are
in no source and no document, whether alone or as part of a name. The changelog may tell what had another name.

  check_words.py SOURCE_DIR
"""
import pathlib
import re
import sys

from check_sources import repositoryFiles

# The word, and what to write in its place.
INSTEAD = {
    "trouble": "failure, or defect",
    "offender": "defect, or what the stage failed at",
    "offending": "defect, or what the stage failed at",
}
ANY = re.compile("|".join(INSTEAD), re.IGNORECASE)
ENDINGS = {".h", ".cpp", ".cxx", ".py", ".cmake", ".sh", ".xml", ".md", ".txt"}
FOLDERS = ("CMake", "Core", "Documentation", "Filters", "Native", "Plugin", "Programs", "Scripts", "ServerManager",
           "Testing")
EXCEPT = ("check_words.py", "CHANGELOG.md")


def problems(name, text):
    return [f"{name}:{number}: {match.group(0)}; write {INSTEAD[match.group(0).lower()]}"
            for number, line in enumerate(text.splitlines(), 1) for match in ANY.finditer(line)]


def selftest():
    assert problems("a", "x\nstruct GridTroubles") == ["a:2: Trouble; write failure, or defect"]
    assert len(problems("a", "kManyOffenders, offending")) == 2 and not problems("a", "a defect of the offer")


def main():
    selftest()
    root = pathlib.Path(sys.argv[1])
    files = [path for path in repositoryFiles(root) if path.suffix in ENDINGS and path.name not in EXCEPT
             and path.relative_to(root).parts[0] in FOLDERS + (path.name,)]
    if len(files) < 500:
        sys.exit(f"check_words: {root} has {len(files)} files; is it the source folder?")
    found = [problem for path in files for problem in problems(path.relative_to(root), path.read_text())]
    print("\n".join(found) or f"check_words: {len(files)} files, fine")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
