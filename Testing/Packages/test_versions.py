# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""All that tells a version of Quadrille tells the same one, in a build folder:

  test_versions.py VERSION CMAKE [--library FILE] [--cmake-version FILE] [--command FILE] [--evaluate FILE]
                   [--manuals FOLDER] [--python FOLDER] [--plugin FILE]
"""
import argparse
import ctypes
import gzip
import pathlib
import re
import subprocess
import sys

parser = argparse.ArgumentParser()
parser.add_argument("version")
parser.add_argument("cmake")
for option in "library", "cmake-version", "command", "evaluate", "manuals", "python", "plugin":
    parser.add_argument("--" + option, type=pathlib.Path)
given = parser.parse_args()
version, major = given.version, given.version.split(".")[0]
failures = []


def expect(what, told, wanted=version):
    print(f"{what}: {told}")
    if told != wanted:
        failures.append(f"{what} is {told!r}, not {wanted!r}")


def run(*words):
    return subprocess.run([str(word) for word in words], text=True, check=True, stdout=subprocess.PIPE).stdout


def found(pattern, text):
    match = re.search(pattern, text, re.MULTILINE)
    return match.group(1) if match else None


def is_compatible(file, asked):
    """Whether find_package(Quadrille ASKED) takes it."""
    script = file.parent / "ask_version.cmake"
    numbers = (asked + ".0.0").split(".")[:3]
    script.write_text("set(CMAKE_SIZEOF_VOID_P 8)\n" + "".join(
        f"set(PACKAGE_FIND_VERSION{name} {value})\n" for name, value in
        (("", asked), ("_MAJOR", numbers[0]), ("_MINOR", numbers[1]), ("_PATCH", numbers[2]))) +
        f'include("{file}")\nmessage("${{PACKAGE_VERSION}} ${{PACKAGE_VERSION_COMPATIBLE}}")\n')
    done = subprocess.run([given.cmake, "-P", str(script)], text=True, check=True, stderr=subprocess.PIPE)
    script.unlink()
    told, compatible = done.stderr.split()[-2:]
    expect("CMake's files", told)
    return compatible.upper() in ("TRUE", "1", "ON")


if given.library:
    file = given.library.resolve()
    expect("file of the library", file.name, f"libquadrille.so.{version}")
    expect("soname", found(r"SONAME.*\[(.+)\]", run("readelf", "-d", file)), f"libquadrille.so.{major}")
    library = ctypes.CDLL(str(file))
    # quadrille::libraryVersion(), by its name in the binary.
    tell = library._ZN9quadrille14libraryVersionEv
    tell.restype = ctypes.c_char_p
    expect("library", tell().decode())
if given.cmake_version:
    for asked, wanted in ((major, True), (version, True), (f"{major}.999", False), (str(int(major) + 1), False),
                          ("0.1", False)):
        expect(f"find_package(Quadrille {asked})", is_compatible(given.cmake_version, asked), wanted)
if given.command:
    expect("quadrille --version", run(given.command, "--version").strip(), f"Quadrille {version}")
if given.evaluate:
    expect("quadrille-evaluate", found(r'^VERSION = "(.+)"$', given.evaluate.read_text()))
if given.manuals:
    for page in sorted(given.manuals.glob("*.1.gz")):
        expect(page.name, found(r'^\.TH .*"Quadrille (.+?)"', gzip.decompress(page.read_bytes()).decode()))
if given.python:
    sys.path.insert(0, str(given.python))
    import quadrille

    expect("quadrille.__version__", quadrille.__version__)
if given.plugin:
    from paraview import servermanager, simple

    simple.LoadPlugin(str(given.plugin), remote=False)
    plugins = servermanager.vtkSMProxyManager.GetProxyManager().GetPluginManager().GetLocalInformation()
    versions = [plugins.GetPluginVersion(i) for i in range(plugins.GetNumberOfPlugins())
                if plugins.GetPluginName(i) == "Quadrille" and plugins.GetPluginLoaded(i)]
    expect("plugin", versions, [version])
if failures:
    sys.exit("FAILED: " + "; ".join(failures))
print("versions: fine")
