#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""A type of Core stands in one header only: two of the same name are one for the linker, which takes the functions of
either for both.

  check_types.py SOURCE_DIR
"""
import collections
import pathlib
import re
import sys


def typesOf(header):
    """Types that a header defines in a namespace."""
    return re.findall(r"^(?:struct|class|enum class) (?:[A-Z]+_[A-Z]+ )?(\w+)[^;\n]*\n\{", header, flags=re.M)


def headersOfTypes(core):
    """Type -> the headers of Core that define it."""
    headers = collections.defaultdict(list)
    for path in sorted(core.rglob("*.h")):
        for name in typesOf(path.read_text()):
            headers[name].append(str(path.relative_to(core)))
    return headers


def typesTwice(core, headers):
    return [f"{core}: the type {name} stands in {', '.join(files)}: give it another name in one"
            for name, files in sorted(headers.items()) if len(files) > 1]


def selftest():
    assert typesOf("struct A;\nstruct B : C\n{\n  struct D\n  {\n  };\n};\nenum class E : int\n{\n};\n"
                   "class MY_API F : public C\n{\n};\n") == ["B", "E", "F"]


def main():
    selftest()
    headers = headersOfTypes(pathlib.Path(sys.argv[1]) / "Core")
    if len(headers) < 100:
        sys.exit(f"check_types: {sys.argv[1]} has {len(headers)} types in headers; is it the source folder?")
    found = typesTwice("Core", headers)
    print("\n".join(found) or f"check_types: {len(headers)} types, each in one header")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
