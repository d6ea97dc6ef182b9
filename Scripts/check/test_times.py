#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Passes on what ctest prints, and names the ten slowest tests and the seconds of each label before its summary.

  ctest --output-junit TIMES.xml ... | test_times.py TIMES.xml BUILD_SECONDS_FILE
"""
import pathlib
import re
import sys
import xml.etree.ElementTree

SLOWEST = 10
SUMMARY = re.compile(r"\d+% tests passed")


def slowest(report):
    """(name, seconds) of the tests in a JUnit report, the slowest ones first."""
    cases = xml.etree.ElementTree.parse(report).getroot().iter("testcase")
    rows = [(case.get("name"), float(case.get("time") or 0)) for case in cases]
    return sorted(rows, key=lambda row: -row[1])[:SLOWEST]


def lines(report, buildSeconds):
    rows = slowest(report)
    told = [f"The {len(rows)} slowest tests:"] + [f"  {seconds:7.1f} s  {name}" for name, seconds in rows]
    if buildSeconds.is_file():
        told.append(f"Configured and built in {float(buildSeconds.read_text()):.0f} s.")
    return told + [""]


def main():
    report, buildSeconds = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    held = None
    for line in sys.stdin:
        if SUMMARY.match(line):
            held = []
        if held is None:
            print(line, end="", flush=True)
        else:
            held.append(line)
    # The report is written when ctest has ended, which is when its output has.
    if report.is_file():
        print("\n".join(lines(report, buildSeconds)))
    print("".join(held or []), end="", flush=True)


if __name__ == "__main__":
    main()
