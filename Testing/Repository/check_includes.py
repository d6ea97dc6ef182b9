#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Every source and header of Core includes, itself or by what it includes, a header that declares each name of Core
that it uses: with QUADRILLE_UNITY_BUILD several sources are compiled as one, which would not notice.

  check_includes.py SOURCE_DIR

Names are those that headers declare in the namespace quadrille: types, constants, and functions where they are called.
A name that the file or what it includes declares in any way, a member or a variable, counts as known. It takes two
seconds; check_alone.py, which compiles each source alone, sees more (headers of the standard library, types that
are only declared) and takes minutes: Scripts/check/check-release.sh runs it.
"""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "CMake"))
import unity_groups

INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
WORD = re.compile(r"(?<![\w.])(?<!->)(?<!::)(\w+)\b(\s*\()?")
#: A word after a type, or in a structured binding.
TYPE = r"(?:\b[A-Z]\w*|\b(?:auto|void|bool|int|char|float|double|unsigned|long)|::\w+|>|&)"
DECLARED = re.compile(TYPE + r"(?:\s*const)?[\s&*]+(\w+)\s*(?:[=({,;)\[]|:(?!:))")
BOUND = re.compile(r"[\[,]\s*(\w+)(?=[\],])")
ENUMERATOR = re.compile(r"^\s+(\w+)\s*(?:=[^,;(]*)?,?\s*$", re.MULTILINE)
BLOCK_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)


def code(text):
    """Lines without comments, literals and preprocessor."""
    text = re.sub(r'R"(\w*)\(.*?\)\1"', '""', BLOCK_COMMENT.sub("", text), flags=re.DOTALL)
    return [unity_groups.stripped(line) for line in text.splitlines() if not line.startswith("#")]


def declared(text):
    """What a header declares in the namespace itself, not in one inside of it."""
    names, depth = set(), 0
    for line in code(text):
        if depth == 1 and re.match(r"[A-Za-z_:\[]", line):
            names.add(unity_groups.nameIn(re.sub(r"^(inline|constexpr|extern|explicit)\s+(?=[A-Za-z])", "", line)
                                          if "(" in line else line))
        depth += line.count("{") - line.count("}")
    return names - {None}


def used(text):
    """Types and constants by their names, functions where they are called."""
    for line in code(text):
        for word, call in WORD.findall(line):
            if word[0].isupper() or re.match(r"k[A-Z]", word) or call:
                yield word


def own(text):
    """Words that a file declares in some way: variables, parameters, members, functions and types."""
    text = "\n".join(code(text))
    return set(DECLARED.findall(text)) | set(BOUND.findall(text)) | set(ENUMERATOR.findall(text)) | \
        set(re.findall(r"(?:struct|class|enum|using)\s+(?:class\s+)?(\w+)", text))


def closure(path, texts, seen):
    for name in INCLUDE.findall(texts[path]):
        if name in texts and name not in seen:
            seen.add(name)
            closure(name, texts, seen)
    return seen


def problems(texts):
    """texts: by path below Core."""
    headers = {}
    for path, text in texts.items():
        for name in declared(text) if path.endswith(".h") else ():
            headers.setdefault(name, set()).add(path)
    owned = {path: own(text) for path, text in texts.items()}
    for path, text in sorted(texts.items()):
        seen = closure(path, texts, {path})
        known = set().union(*(owned[other] for other in seen))
        for word in sorted(set(used(text)) - known):
            if word in headers and not headers[word] & seen:
                yield f"Core/{path} uses {word} and includes none of {', '.join(sorted(headers[word]))}"


def selftest():
    header = "namespace quadrille\n{\nstruct Part\n{\n  int size = 0;\n};\nint countOf(const Part& part);\n}\n"
    assert declared(header) == {"Part", "countOf"}, declared(header)
    source = "namespace quadrille\n{\nint twice(int a)\n{\n  return 2 * countOf(a); // Part\n}\n}\n"
    assert len(list(problems({"A/A.h": header, "B/B.cpp": source}))) == 1
    between = {"B/B.h": '#include "A/A.h"\n', "B/B.cpp": '#include "B/B.h"\n' + source}
    assert not list(problems({"A/A.h": header, **between}))


def main():
    selftest()
    core = pathlib.Path(sys.argv[1]) / "Core"
    texts = {str(path.relative_to(core)): path.read_text()
             for path in core.rglob("*.*") if path.suffix in (".h", ".cpp")}
    found = list(problems(texts))
    print("\n".join(found) or f"includes: {len(texts)} files, fine")
    return 1 if found or not texts else 0


if __name__ == "__main__":
    sys.exit(main())
