#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Every file of Core that Documentation/Design.md names is there: `Hierarchy/StarCache`, without ending, or with one.

  check_design.py SOURCE_DIR
"""
import pathlib
import re
import sys

ENDINGS = (".h", ".cpp")


def modules(root):
    return sorted(p.name for p in (root / "Core").iterdir() if p.is_dir())


def names(text, folders):
    """Names of files in one of the folders, also those in code spans that have more in them."""
    return sorted(set(re.findall(r"\b((?:" + "|".join(folders) + r")/\w+(?:\.\w+)?)", text)))


def exists(core, name):
    return (core / name).is_file() or any((core / (name + ending)).is_file() for ending in ENDINGS)


def selftest(root):
    folders = modules(root)
    assert names("`Mesh/Mesh`, `Core/Mesh/Mesh.h` and Some/Thing", folders) == ["Mesh/Mesh", "Mesh/Mesh.h"]
    assert exists(root / "Core", "Mesh/Mesh") and exists(root / "Core", "Mesh/Mesh.h")
    assert not exists(root / "Core", "Mesh/Mesh.cxx") and not exists(root / "Core", "Mesh/NoSuchFile")


def main():
    root = pathlib.Path(sys.argv[1])
    selftest(root)
    named = names((root / "Documentation" / "Design.md").read_text(), modules(root))
    problems = [f"Documentation/Design.md: no {name} in Core" for name in named if not exists(root / "Core", name)]
    if len(named) < 30:
        problems.append(f"Documentation/Design.md: only {len(named)} files are named, the table of steps is gone")
    print("\n".join(problems) or f"design: {len(named)} files, fine")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
