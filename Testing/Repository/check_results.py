#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Figures of the documents tell what they were made from: Results.md, and each part of Performance.md that a script
writes, has a line "Made from commit X". How often Core has changed since is told and fails nothing.

  check_results.py SOURCE_DIR
  check_results.py --selftest
"""
import pathlib
import re
import subprocess
import sys

RESULTS, PERFORMANCE = "Documentation/Results.md", "Documentation/Performance.md"
WATCHED = "Core"
MADE = re.compile(r"^Made from commit ([0-9a-f]{7,40})\b", re.MULTILINE)
PART = re.compile(r"<!-- (\w+): begin -->(.*?)<!-- \1: end -->", re.DOTALL)


def madeFrom(page, text):
    """({where: commit}, problems) of a page, or of its parts where it has any."""
    parts = {f"{page} ({name})": part for name, part in PART.findall(text)} or {page: text}
    commits = {where: MADE.search(part) for where, part in parts.items()}
    return ({where: match.group(1) for where, match in commits.items() if match},
            [f"{where}: no line \"Made from commit X\", which its script writes"
             for where, match in commits.items() if not match])


def commitsSince(root, commit):
    """None where git cannot tell, as in a copy without history."""
    try:
        told = subprocess.run(["git", "-C", str(root), "rev-list", "--count", f"{commit}..HEAD", "--", WATCHED],
                              capture_output=True, text=True)
    except FileNotFoundError:
        return None
    return int(told.stdout) if told.returncode == 0 else None


def selftest():
    assert madeFrom("a.md", "# A\n\nMade from commit 0123abc, on 2 cores.\n") == ({"a.md": "0123abc"}, [])
    assert madeFrom("a.md", "Made from commit 0123.\n")[1] == [
        'a.md: no line "Made from commit X", which its script writes']
    found, wrong = madeFrom("a.md", "<!-- b: begin -->\n\nMade from commit 0123abc.\n<!-- b: end -->\n"
                                    "<!-- c: begin -->\n| |\n<!-- c: end -->\nMade from commit 4567def.\n")
    assert found == {"a.md (b)": "0123abc"} and len(wrong) == 1 and "(c)" in wrong[0]


def main():
    selftest()
    if sys.argv[1] == "--selftest":
        return 0
    root = pathlib.Path(sys.argv[1])
    missing = []
    for page in (RESULTS, PERFORMANCE):
        commits, wrong = madeFrom(page, (root / page).read_text())
        missing += wrong
        for where, commit in commits.items():
            since = commitsSince(root, commit)
            print(f"{where}: made from {commit}, " + (
                "which git does not know here" if since is None else f"{WATCHED} has changed in {since} commits since"))
    print("\n".join(missing) or "results: fine")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
