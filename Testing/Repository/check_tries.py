#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The ledger of tries is whole: each row of Core/Base/TryCount.cpp stands in Documentation/Design/Tries.md, with equal
words, and no other; and some source counts it.

  check_tries.py SOURCE_DIR
"""
import pathlib
import re
import sys


def main():
    root = pathlib.Path(sys.argv[1])
    sys.path.insert(0, str(root / "Scripts" / "study"))
    from tries_table import rows
    page = (root / "Documentation" / "Design" / "Tries.md").read_text()
    told = [tuple(cell.strip() for cell in line.split("|")[1:5]) for line in page.splitlines() if line.startswith("| ")]
    problems = [f"Tries.md lacks the row {row}" for row in rows() if row not in told]
    problems += [f"Tries.md has a row that the sources lack: {row}" for row in told[1:] if row not in rows()]
    header = (root / "Core" / "Base" / "TryCount.h").read_text()
    names = re.findall(r"(\w+),", re.search(r"enum class Try[^{]*\{(.*?)Count\n", header, re.DOTALL).group(1))
    if len(names) != len(rows()) or len(names) < 40:
        problems.append(f"{len(names)} values of Try, {len(rows())} rows")
    sources = "".join(path.read_text() for path in sorted((root / "Core").rglob("*.cpp")) if path.stem != "TryCount")
    problems += [f"Try::{name} is counted nowhere" for name in names if f"Try::{name}" not in sources]
    print("\n".join(problems) or f"tries: {len(names)} rows, fine")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
