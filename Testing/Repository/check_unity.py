#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""A name in an anonymous namespace stands in one source of a folder only, as QUADRILLE_UNITY_BUILD compiles several of
them as one. Two with the same signature would not compile; two functions with different ones would be overloads of each
other, and a call could take another one than without it. Nor is such a name a type of one of Core's headers, which
another source may include. A type of Core stands in one header only: two of the same name are one for the linker, which
takes the functions of either for both.

  check_unity.py SOURCE_DIR
"""
import collections
import pathlib
import re
import sys

FOLDERS = ("Core", "Filters", "Programs", "ServerManager", "Testing")
TYPE = re.compile(r"(?:enum class|enum|struct|class|union)\s+(\w+)\s*(?:final\b\s*)?(?::|\{|$)")
ALIAS = re.compile(r"using\s+(\w+)\s*=")
VARIABLE = re.compile(r"[\w:][^(=]*?\b(\w+)\s*(?:\[[^]]*\]\s*)*(?:=|\{|;)")
FUNCTION = re.compile(r"(?:[^(]*[\s*&>])?(?<!::)(\w+)\s*\(")


def stripped(line):
    """Without literals and comments."""
    line = re.sub(r'"(\\.|[^"\\])*"', '""', line)
    line = re.sub(r"(?<!\w)'(\\.|[^'\\])+'", "''", line)
    return re.sub(r"//.*", "", line)


def nameIn(line):
    """What a line without indentation declares, or None."""
    line = re.sub(r"\[\[\w+\]\]\s*", "", line)
    if line.startswith(("template", "using namespace", "namespace", "TEST", "INSTANTIATE", "return", "static_assert",
                        "friend")):
        return None
    for pattern in (TYPE, ALIAS):
        match = pattern.match(line)
        if match:
            return match.group(1)
    if line.startswith("using "):
        return None  # of the same name from elsewhere, which may stand twice
    if "(" in line and not re.match(r"[^(]*=", line):
        # A definition of a member has its class before the name.
        match = FUNCTION.match(line)
        return match.group(1) if match and not re.search(r"::~?\w+\s*\(", line) else None
    match = VARIABLE.match(line)
    return match.group(1) if match else None


def anonymousNames(text):
    """Names that the anonymous namespaces of a source declare."""
    names, depth, begin = set(), 0, None
    text = re.sub(r'R"(\w*)\(.*?\)\1"', '""', text, flags=re.S)
    for line in map(stripped, text.splitlines()):
        if begin is None and re.match(r"\s*namespace\s*\{?\s*$", line):
            begin = depth
        elif begin is not None and depth == begin + 1 and line and re.match(r"[A-Za-z_:\[]", line):
            names.add(nameIn(line))
        depth += line.count("{") - line.count("}")
        if begin is not None and depth <= begin and "}" in line:
            begin = None
    return names - {None}


def problems(folder, shared):
    """shared: type -> the header that defines it."""
    users = collections.defaultdict(list)
    for path in sorted(p for p in folder.iterdir() if p.suffix in (".cpp", ".cxx")):
        text = path.read_text()
        if re.search(r"^int main\(", text, flags=re.M):
            continue  # a program is a target of its own
        for name in anonymousNames(text):
            users[name].append(path.name)
    hidden = [f"{folder}: {name} stands in the anonymous namespace of {', '.join(files)} and is a type of "
              f"{shared[name]}: give it another name" for name, files in sorted(users.items()) if name in shared]
    return hidden + [f"{folder}: {name} stands in the anonymous namespaces of {', '.join(files)}: give it another name "
                     "in one, or share it in a header" for name, files in sorted(users.items()) if len(files) > 1]


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
    names = anonymousNames("""namespace quadrille
{
void outside();
namespace
{

// int comment;
constexpr double kOne = 1, kBracket = '{';
struct Part final
{
  int member = 0;
  void method() {}
};
using Pair = std::pair<int, int>;
using test::elsewhere;
template <class T>
std::vector<T> made(
  int a, int b)
{
  int local = 0;
}
void Part::elsewhere() {}
thread_local Part* current = nullptr;
std::array<int, 3> table = { {
  1 } };
Part whole(const char* text = "(")
{
}

} // namespace

int after();
}
""")
    assert names == {"kOne", "Part", "Pair", "made", "current", "table", "whole"}, names


def main():
    selftest()
    root = pathlib.Path(sys.argv[1])
    folders = {path.parent for top in FOLDERS for path in (root / top).rglob("*.c*") if path.suffix in (".cpp", ".cxx")}
    if len(folders) < 10:
        sys.exit(f"check_unity: {root} has sources in {len(folders)} folders only; is it the source folder?")
    headers = headersOfTypes(root / "Core")
    shared = {name: files[0] for name, files in headers.items()}
    found = [problem for folder in sorted(folders) for problem in problems(folder, shared)]
    found += typesTwice(root / "Core", headers)
    for problem in found:
        print(problem)
    print(f"check_unity: {len(folders)} folders, {len(found)} names more than once")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
