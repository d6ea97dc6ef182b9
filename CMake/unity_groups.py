#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Which sources of a target QUADRILLE_UNITY_BUILD compiles as one: in a joined source the anonymous namespaces of its
files are one scope, so two files that use a name there, each for a thing of its own, go to different ones.

  unity_groups.py BATCH SOURCE...     prints a line "SOURCE;NUMBER" for each, at most BATCH sources of one number
  unity_groups.py --selftest
"""
import pathlib
import re
import sys

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

def grouped(sources, batch, namesOf):
    """Lists of sources, each in the order given; every source goes to the first list that has room and none of its
    names."""
    groups = []  # [sources, their names]
    for source in sources:
        names = namesOf(source)
        for members, taken in groups:
            if len(members) < batch and not names & taken:
                members.append(source)
                taken |= names
                break
        else:
            groups.append(([source], set(names)))
    return [members for members, _ in groups]


def groupsOf(paths, batch):
    batch = -(-len(paths) // max(1, -(-len(paths) // batch)))  # the same number in each
    return grouped(paths, batch, lambda path: anonymousNames(pathlib.Path(path).read_text()))


def selftest():
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
    names = {"a": {"x"}, "b": {"x", "y"}, "c": {"z"}, "d": {"z"}}
    assert grouped("abcd", 3, names.get) == [["a", "c"], ["b", "d"]]
    assert grouped("abcd", 1, names.get) == [["a"], ["b"], ["c"], ["d"]]


def main():
    if sys.argv[1:] == ["--selftest"]:
        selftest()
        return
    for number, members in enumerate(groupsOf(sys.argv[2:], int(sys.argv[1]))):
        for source in members:
            print(f"{source};{number}")


if __name__ == "__main__":
    main()
