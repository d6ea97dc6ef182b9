# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The example project finds the installed library, builds with it and makes quads:

  test_consumer.py CMAKE BUILD_FOLDER PROJECT WORK_FOLDER
"""
import pathlib
import re
import shutil
import subprocess
import sys

cmake, build, project, work = sys.argv[1:]
work = pathlib.Path(work)
shutil.rmtree(work, ignore_errors=True)
prefix = work / "prefix"


def run(*words, code=0):
    done = subprocess.run([str(word) for word in words], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != code:
        sys.exit(f"FAILED with {done.returncode}: {words}\n{done.stdout}")
    return done.stdout


def require(truth, text):
    if not truth:
        sys.exit(f"FAILED: {text}")


for component in "SharedLibrary", "Library":
    run(cmake, "--install", build, "--prefix", prefix, "--component", component)
installed = sorted(str(path.relative_to(prefix)) for path in prefix.rglob("*") if not path.is_dir())
print("\n".join(installed))
require([name for name in installed if name.endswith(".h")] == ["include/quadrille/quadrille.h"], "the headers")

# No type of another library is in the interface.
included = re.findall(r"#include [<\"](.+?)[>\"]", (prefix / "include/quadrille/quadrille.h").read_text())
require(all(re.fullmatch(r"[a-z]+", name) for name in included), f"headers of others in quadrille.h: {included}")

# Core is hidden. What else is exported are templates of the standard library, of its own types.
library = next(prefix.rglob("libquadrille.so"))
symbols = [line.split(maxsplit=2)[2] for line in run("nm", "-DC", "--defined-only", library).splitlines()]
ours = {re.sub(r"\(.*", "", re.sub(r"^(typeinfo name|typeinfo|vtable) for ", "", symbol)) for symbol in symbols
        if "quadrille" in symbol}
expected = {f"quadrille::{name}" for name in ("makeQuads", "libraryVersion", "QuadError", "InputError", "NoQuadsError",
                                              "StoppedError")}
require(ours == expected, f"exported: {sorted(ours)}")

# The version is asked for.
configure = [cmake, "-S", project, "-B", work / "build", f"-DCMAKE_PREFIX_PATH={prefix}"]
run(*configure)
run(cmake, "--build", work / "build")
text = run(work / "build" / "sphere-quads", work / "sphere.obj", 500)
print(text)
told = re.search(r"(\d+) quads, (\d+) points", text)
lines = (work / "sphere.obj").read_text().splitlines()
quads = [[int(word) for word in line.split()[1:]] for line in lines if line.startswith("f ")]
points = [line for line in lines if line.startswith("v ")]
require(told and (int(told.group(1)), int(told.group(2))) == (len(quads), len(points)), "what it told and wrote")
# A closed surface of genus 0: V - E + F = 2, and each edge has two quads.
edges = {}
for quad in quads:
    for a, b in zip(quad, quad[1:] + quad[:1]):
        edges[min(a, b), max(a, b)] = edges.get((min(a, b), max(a, b)), 0) + 1
require(set(edges.values()) == {2} and len(points) - len(edges) + len(quads) == 2, "a closed sphere of quads")
require("at least 1" in run(work / "build" / "sphere-quads", work / "none.obj", 0, code=3), "no quads are refused")

wrong = work / "wrong"
shutil.copytree(project, wrong)
lists = wrong / "CMakeLists.txt"
lists.write_text(re.sub(r"(find_package\(Quadrille) \d+ ", r"\1 99 ", lists.read_text()))
done = subprocess.run([cmake, "-S", wrong, "-B", wrong / "build", f"-DCMAKE_PREFIX_PATH={prefix}"], text=True,
                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
require(done.returncode != 0 and "99" in done.stdout, "another version is not found")
print("consumer: fine")
