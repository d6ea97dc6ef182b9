#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What the documents name is there: files of Core (`Hierarchy/StarCache`, without ending, or with one), those of
Filters in code spans of the design (`Filters/Convert/Pieces`, `Ranks/Spread`), what such a page lists as its `Files:`,
and names of the sources in code spans (`quadsOfBlock`, `Mesh::sizing`). Pages that comments and documents name
(Documentation/Design/Map.md) are there as well; links are a matter of check_links.py.

  check_design.py SOURCE_DIR
"""
import pathlib
import re
import sys

from check_sources import repositoryFiles

ENDINGS = (".h", ".cpp")
FILTER_ENDINGS = ("", ".h", ".cxx", ".py")
SOURCES = {".h", ".cpp", ".cxx", ".py", ".xml", ".cmake", ".txt", ".sh"}
PAGE = re.compile(r"\bDocumentation/[\w/]+\.(?:md|bib)\b")
SPAN = re.compile(r"`([A-Za-z_]\w*(?:::\w+)*)(?:\(\))?`")
FILES = re.compile(r"\bFiles?: ((?:(?:in Core|and)?\s*`[\w/:]+`(?: \([^)]*\))?[,;]?\s*)+)")
LIBRARY = re.compile(r"(?:std|tbb)::|vtkSMPTools$")
FENCE = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)


def modules(root):
    return sorted(p.name for p in (root / "Core").iterdir() if p.is_dir())


def names(text, folders):
    """Names of files in one of the folders, also those in code spans that have more in them."""
    return sorted(set(re.findall(r"(?<![\w/])(?:Core/)?((?:" + "|".join(folders) + r")/\w+(?:\.\w+)?)", text)))


def exists(core, name):
    return (core / name).is_file() or any((core / (name + ending)).is_file() for ending in ENDINGS)


def spans(text):
    """Names of the sources that code spans hold: the last part of `Mesh::sizing`. Those of libraries are not ours."""
    return sorted({match.split("::")[-1] for match in SPAN.findall(FENCE.sub("", text)) if not LIBRARY.match(match)})


def filterFiles(text, folders):
    """Names of files in Filters, or in one of its folders."""
    return sorted(set(re.findall(r"`(?:Filters/)?((?:" + "|".join(folders) + r")/\w+)`", text))
                  | set(re.findall(r"`Filters/([\w/]+)`", text)))


def listedFiles(text):
    """Last parts of the names that follow `File:` or `Files:`; a class of VTK stands for its file."""
    return sorted({name.split("/")[-1].split("::")[0]
                   for listed in FILES.findall(text)
                   for name in re.findall(r"`([^`]+)`", re.sub(r"\([^)]*\)", "", listed))})


def selftest(root):
    folders = modules(root)
    assert names("`Mesh/Mesh`, `Core/Mesh/Mesh.h` and Some/Thing", folders) == ["Mesh/Mesh", "Mesh/Mesh.h"]
    assert not names("Design/Mesh/Mesh", folders)
    assert exists(root / "Core", "Mesh/Mesh") and exists(root / "Core", "Mesh/Mesh.h")
    assert not exists(root / "Core", "Mesh/Mesh.cxx") and not exists(root / "Core", "Mesh/NoSuchFile")
    assert filterFiles("`Ranks/Spread`, `Filters/NoFile`, `Mesh/Mesh`", ["Ranks"]) == ["NoFile", "Ranks/Spread"]
    assert listedFiles("Files: `Ranks/A` (the `x`), `B::c`; in Core\n`D/E`. Then `F`") == ["A", "B", "E"]
    assert spans("`poll()` of `Some::thing`, `std::sort`, `a b`, `x.h`\n```\n`no`\n```\n") == ["poll", "thing"]


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    selftest(root)
    files = repositoryFiles(root)
    texts = {p: p.read_text() for p in files if p.suffix in SOURCES | {".md"} and "CHANGELOG" not in p.name}
    words = set().union(*(re.findall(r"\w+", text) for path, text in texts.items() if path.suffix != ".md"))
    design = [p for p in texts if p == root / "Documentation/Design.md" or p.parent == root / "Documentation/Design"]
    stems = {path.stem for path in files if path.suffix in SOURCES}
    filters = root / "Filters"
    rooms = sorted(p.name for p in filters.iterdir() if p.is_dir())
    problems, named = [], set()
    for path, text in sorted(texts.items()):
        page = path.relative_to(root)
        pages = sorted(set(PAGE.findall(text)))
        problems += [f"{page}: no {goal} here" for goal in pages if not (root / goal).is_file()]
        if path in design:
            found = names(text, modules(root))
            named |= set(found)
            problems += [f"{page}: no {name} in Core" for name in found if not exists(root / "Core", name)]
            problems += [f"{page}: no {name} in Filters" for name in filterFiles(text, rooms)
                         if not any((filters / (name + ending)).exists() for ending in FILTER_ENDINGS)]
            problems += [f"{page}: no file {name}" for name in listedFiles(text) if name not in stems]
            problems += [f"{page}: no `{name}` in the sources" for name in spans(text) if name not in words]
    if len(named) < 30:
        problems.append(f"Documentation/Design.md: only {len(named)} files are named, the table of steps is gone")
    print("\n".join(problems) or f"design: {len(design)} pages, {len(named)} files, fine")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
