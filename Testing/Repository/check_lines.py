#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Lines of code, scripts and documents end at column 120. Longer may be what has no place to break: a row of a Markdown
table, and a line that is one word, such as a link, beside its marks of indentation, comment, list or quote.

  check_lines.py SOURCE_DIR
"""
import pathlib
import re
import sys

from check_sources import repositoryFiles

COLUMNS = 120
ENDINGS = {".h", ".cpp", ".cxx", ".py", ".cmake", ".sh", ".xml", ".md"}
NAMES = {"CMakeLists.txt", "run"}
# Nothing but one word after marks: `  // https://...`, `- [a link](https://...)`, `"a-string"`.
ONE_WORD = re.compile(r"\s*(?:(?://|#+|\*|-|>)\s+)*\S+$")


def mayBeLonger(path, line):
    return (path.suffix == ".md" and line.lstrip().startswith("|")) or bool(ONE_WORD.match(line))


def problems(path, text):
    return [f"{path}:{number}: {len(line)} columns, more than {COLUMNS}"
            for number, line in enumerate(text.splitlines(), 1) if len(line) > COLUMNS and not mayBeLonger(path, line)]


def selftest():
    code, page = pathlib.Path("a.py"), pathlib.Path("a.md")
    link = "https://example.org/" + "x" * COLUMNS
    assert not problems(code, "x" * COLUMNS) and not problems(code, "é " * (COLUMNS // 2))
    assert problems(code, "short\n" + "x " * COLUMNS)[0].startswith("a.py:2: ")
    assert not problems(code, f"    # {link}") and problems(code, f"    # see {link}")
    assert not problems(page, "| a " * COLUMNS) and problems(code, "| a " * COLUMNS) and problems(page, "a " * COLUMNS)
    assert not problems(page, f"- {link}")


def main():
    selftest()
    root = pathlib.Path(sys.argv[1])
    files = [p for p in repositoryFiles(root) if p.suffix in ENDINGS or p.name in NAMES]
    found = [line for path in files for line in problems(path.relative_to(root), path.read_text())]
    if not files:
        found.append("no file found")
    print("\n".join(found) or f"lines: {len(files)} files, fine")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
