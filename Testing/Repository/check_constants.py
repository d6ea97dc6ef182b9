#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""A constant's name has one value in Core and Filters, wherever it stands: who has read one knows the others.

  check_constants.py SOURCE_DIR
"""
import collections
import pathlib
import re
import sys

DEFINITION = re.compile(
    r"^\s*(?:static |inline )*constexpr [^;={\n]*?\b(k[A-Z]\w*)(?:\[\w*\])*\s*(?=[={])=?\s*([^;]*);", re.MULTILINE)
NEXT = re.compile(r",\s*(k[A-Z]\w*)\s*=\s*")


def constants(text):
    """Pairs of name and value, as it is written."""
    text = re.sub(r"//[^\n]*", "", text)
    for name, values in DEFINITION.findall(text):
        first, *others = NEXT.split(values)
        for key, value in ((name, first), *zip(others[::2], others[1::2])):
            yield key, " ".join(value.split())


def selftest():
    assert list(constants("constexpr int kA = 3; // of kB = 2\n  static constexpr double kC = f(1, 2),\n    kD = 4;\n"
                          "inline constexpr std::size_t kE{ 5 };\nconstexpr double kF[] = { 1,\n 2 };\n"
                          "const int other = 3;\n")) == [
        ("kA", "3"), ("kC", "f(1, 2)"), ("kD", "4"), ("kE", "{ 5 }"), ("kF", "{ 1, 2 }")]


def main():
    selftest()
    root = pathlib.Path(sys.argv[1])
    found = collections.defaultdict(lambda: collections.defaultdict(list))
    for folder in ("Core", "Filters"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".h", ".cpp", ".cxx"):
                for name, value in constants(path.read_text()):
                    found[name][value].append(str(path.relative_to(root)))
    if len(found) < 200:
        sys.exit(f"check_constants: {root} has {len(found)} constants; is it the source folder?")
    twice = {name: values for name, values in sorted(found.items()) if len(values) > 1}
    for name, values in twice.items():
        places = "; ".join(f"{value} in {', '.join(files)}" for value, files in values.items())
        print(f"{name} is {places}: give one of them a name of its own")
    print(f"check_constants: {len(found)} names, {len(twice)} with more than one value")
    return 1 if twice else 0


if __name__ == "__main__":
    sys.exit(main())
