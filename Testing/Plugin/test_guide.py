# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs every snippet of the user guide, as a reader would: in a folder where `build`, `Data` and `Scripts` are those of
the project.

    test_guide.py GUIDE.md SOURCE_FOLDER BUILD_FOLDER PVPYTHON PYTHON WORK_FOLDER
    test_guide.py GUIDE.md --list       the snippets in their order; runs none

The pages are GUIDE.md and those of the folder Guide beside it, in the order in which GUIDE.md links to them; a page in
that folder without a link is an error.

What counts as a snippet, for who edits the guide:

- a fenced block with the language `python`: run by pvpython where it imports `paraview`, else by the system's python3;
- a fenced block with the language `sh`: run by bash, which stops at the first command that fails;
- a fenced block with the language `text` is no code (a synopsis, an output) and is not run;
- a block without a language or with another one, and a block that is indented and not fenced, is an error: it would go
  unseen.

A line directly above the fence may say more, as a comment that readers do not see:

    <!-- snippet: continues -->         begins where the Python snippet before it on its page ended (its code is run
                                        first)
    <!-- snippet: with NAME -->         needs the file NAME, which is one of FILES below
    <!-- snippet: without VTK -->       is of the Python package without VTK, that of the build's folder wheel
    <!-- snippet: prints an error -->   an error of VTK or ParaView is part of it, and has to come
    <!-- snippet: not run, REASON -->   only for `sh`: what changes the machine; each is listed with its reason in
                                        the test's output

Several of them are separated by semicolons: <!-- snippet: continues; prints an error -->.

A snippet fails where its exit code is not 0 or it prints an error of VTK or ParaView. All snippets of all pages share
one folder, in the order of the guide, so that one can use the files that another has written.
"""
import os
import re
import shutil
import subprocess
import sys

TIMEOUT = 240
ERRORS = re.compile(r"ERR\||ERROR: In|Traceback|^error: ", re.MULTILINE)
LANGUAGES = ("python", "sh", "text")


class GuideError(Exception):
    """The guide breaks the convention."""


class Snippet:
    def __init__(self, line, language, code, directives):
        self.line, self.language, self.code, self.directives = line, language, code, directives
        self.page = ""

    def __str__(self):
        return f"{self.page}:{self.line} ({self.language})"


def write_param_obj(path):
    """A plane of 8 x 6 squares with texture coordinates where one unit is one square."""
    with open(path, "w") as file:
        for j in range(7):
            for i in range(9):
                file.write(f"v {i} {j} 0\nvt {i} {j}\n")
        for j in range(6):
            for i in range(8):
                a, b, c, d = 9 * j + i + 1, 9 * j + i + 2, 9 * j + i + 11, 9 * j + i + 10
                file.write(f"f {a}/{a} {b}/{b} {c}/{c}\nf {a}/{a} {c}/{c} {d}/{d}\n")


#: Files that snippets may ask for, and who writes them.
FILES = {"param.obj": write_param_obj}


def directives_of(text, line):
    found = re.fullmatch(r"<!-- snippet: (.*?) -->", text.strip())
    if text.strip().startswith("<!-- snippet") and not found:
        raise GuideError(f"line {line}: cannot read {text.strip()!r}")
    return found.group(1).split("; ") if found else []


def is_indented_code(lines, i):
    """An indented block begins here: after an empty line, and not as part of a list."""
    if not lines[i].startswith("    ") or not lines[i].strip() or (i > 0 and lines[i - 1].strip()):
        return False
    before = [line for line in lines[:i] if line.strip() and not line.startswith(" ")]
    return not before or not re.match(r"([-*+]|\d+\.) ", before[-1])


def read_snippets(text):
    lines = text.split("\n")
    snippets = []
    i = 0
    while i < len(lines):
        fence = re.match(r"\s*```(.*)$", lines[i])
        if not fence:
            if is_indented_code(lines, i):
                raise GuideError(f"line {i + 1}: an indented block is not seen by this test; fence it, with a language")
            i += 1
            continue
        begin, language = i, fence.group(1).strip()
        if language not in LANGUAGES:
            raise GuideError(f"line {begin + 1}: the language of a fence is one of {', '.join(LANGUAGES)}, not "
                             f"{language!r}")
        i += 1
        while i < len(lines) and not re.match(r"\s*```\s*$", lines[i]):
            i += 1
        if i == len(lines):
            raise GuideError(f"line {begin + 1}: the fence is not closed")
        directives = directives_of(lines[begin - 1], begin) if begin > 0 else []
        snippets.append(Snippet(begin + 1, language, "\n".join(lines[begin + 1:i]) + "\n", directives))
        i += 1
    return snippets


def pages_of(guide):
    """The guide and its pages, in the order of its links."""
    folder = os.path.join(os.path.dirname(guide), "Guide")
    with open(guide) as file:
        linked = list(dict.fromkeys(re.findall(r"\]\(Guide/(\w+\.md)\)", file.read())))
    there = {name for name in os.listdir(folder) if name.endswith(".md")}
    if there != set(linked):
        raise GuideError(f"pages and links differ: {', '.join(sorted(there.symmetric_difference(linked)))}")
    return [guide] + [os.path.join(folder, name) for name in linked]


def snippets_of(page):
    name = os.path.basename(page)
    with open(page) as file:
        try:
            snippets = [snippet for snippet in read_snippets(file.read()) if snippet.language != "text"]
        except GuideError as error:
            raise GuideError(f"{name}: {error}") from None
    for snippet in snippets:
        snippet.page = name
    chain(snippets)
    return snippets


def chain(snippets):
    """Puts the code before a snippet that continues into it."""
    previous = None
    for snippet in snippets:
        if snippet.language != "python":
            continue
        if "continues" in snippet.directives:
            if previous is None:
                raise GuideError(f"{snippet}: there is nothing to continue")
            snippet.code = previous.code + snippet.code
        previous = snippet


def command_for(snippet, number, folder, pvpython, python):
    path = os.path.join(folder, f"snippet-{number}.{'py' if snippet.language == 'python' else 'sh'}")
    with open(path, "w") as file:
        file.write(snippet.code)
    if snippet.language == "sh":
        return ["bash", "-euo", "pipefail", path]
    return [pvpython if re.search(r"^\s*(import|from) paraview", snippet.code, re.MULTILINE) else python, path]


def prepare(snippet, folder):
    """True where it is to be run."""
    wanted = True
    for directive in snippet.directives:
        file = re.fullmatch(r"with (\S+)", directive)
        reason = re.fullmatch(r"not run, (\S.*)", directive)
        if file and file.group(1) in FILES:
            FILES[file.group(1)](os.path.join(folder, file.group(1)))
        elif file:
            raise GuideError(f"{snippet}: nobody writes {file.group(1)}; add it to FILES")
        elif reason and snippet.language == "sh":
            print(f"{snippet} is NOT RUN: {reason.group(1)}", flush=True)
            wanted = False
        elif directive == "without VTK" and snippet.language == "python":
            if not os.path.isdir(os.path.join(folder, "build", "wheel", "quadrille")):
                print(f"{snippet} is NOT RUN: the build has no package without VTK (pybind11-dev)", flush=True)
                wanted = False
        elif directive != "prints an error" and (directive != "continues" or snippet.language != "python"):
            raise GuideError(f"{snippet}: the directive {directive!r} is not known for this language")
    return wanted


def run(snippet, command, folder, environment):
    print(f"{snippet} ...", flush=True)
    result = subprocess.run(command, cwd=folder, env=environment, timeout=TIMEOUT, text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT)
    has_error = bool(ERRORS.search(result.stdout))
    failed = result.returncode != 0 or has_error != ("prints an error" in snippet.directives)
    if failed:
        print(f"FAILED: {snippet}, exit code {result.returncode}\n--- code\n{snippet.code}"
              f"--- output\n{result.stdout}---", flush=True)
    return not failed


def main(guide, source, build, pvpython, python, folder):
    snippets = [snippet for page in pages_of(guide) for snippet in snippets_of(page)]
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    for name, target in (("build", build), ("Data", os.path.join(source, "Data")),
                         ("Scripts", os.path.join(source, "Scripts"))):
        os.symlink(target, os.path.join(folder, name))
    environment = dict(os.environ)
    results = []
    for number, snippet in enumerate(snippets):
        if prepare(snippet, folder):
            package = "wheel" if "without VTK" in snippet.directives else "lib/python3/dist-packages"
            environment["PYTHONPATH"] = os.path.join(build, package)
            results.append(run(snippet, command_for(snippet, number, folder, pvpython, python), folder, environment))
    if not results:
        raise GuideError("the guide has no snippet")
    print(f"{sum(results)} of {len(results)} snippets run without an error; {len(snippets) - len(results)} not run")
    return 0 if all(results) else 1


if __name__ == "__main__":
    try:
        if sys.argv[2:] == ["--list"]:
            print("\n".join(f"{snippet} {'; '.join(snippet.directives)}".rstrip()
                            for page in pages_of(sys.argv[1]) for snippet in snippets_of(page)))
            sys.exit(0)
        sys.exit(main(*sys.argv[1:]))
    except GuideError as error:
        sys.exit(f"FAILED: the guide: {error}")
