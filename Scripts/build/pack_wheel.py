#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Packs a folder with the package quadrille as the wheel quadrille-mesh, or names a wheel for its C library.

    pack_wheel.py FOLDER WHEELS          FOLDER/quadrille is packed, with metadata of pyproject.toml and CMakeLists.txt
    pack_wheel.py --retag WHEEL WHEELS   a wheel of the tag linux gets that of its C library

The tag is manylinux_2_N, N from the newest version of a symbol of the C library (GLIBC_2.N) that the module asks for;
the C++ library is inside of the module, which is looked at, too. With the module for CAD files, which asks for the
libraries of Open CASCADE of this machine, the tag is linux.
"""
import argparse
import base64
import csv
import hashlib
import io
import pathlib
import platform
import re
import subprocess
import sys
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
#: What a module may be linked with at run time: parts of the C library, which each machine has.
SYSTEM_LIBRARIES = re.compile(r"^(lib(c|m|pthread|dl|rt)\.so\.\d+|ld-linux.*)$")


def fail(text):
    sys.exit(f"pack_wheel: {text}")


def version():
    found = re.search(r"project\(Quadrille VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    return found.group(1) if found else fail("CMakeLists.txt has no version")


def least_c_library(module):
    """N of GLIBC_2.N, after looking that the module needs nothing else."""
    dynamic = subprocess.run(["objdump", "-p", str(module)], check=True, capture_output=True, text=True).stdout
    for library in re.findall(r"NEEDED\s+(\S+)", dynamic):
        if not SYSTEM_LIBRARIES.match(library):
            fail(f"{module.name} needs {library}, which not every machine has: link it statically")
    return max(int(minor) for minor in re.findall(r"GLIBC_2\.(\d+)", dynamic))


def tag_of(module):
    python = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    if (module.parent / "Cad").exists():
        return f"{python}-{python}-linux_{platform.machine()}"
    return f"{python}-{python}-manylinux_2_{least_c_library(module)}_{platform.machine()}"


def value_of(name, text):
    return re.search(rf'^{name} = "(.*)"$', text, re.MULTILINE).group(1)


def metadata():
    project = (ROOT / "pyproject.toml").read_text()
    lines = ["Metadata-Version: 2.1", f"Name: {value_of('name', project)}", f"Version: {version()}",
             f"Summary: {value_of('description', project)}", f"License: {value_of('license', project)}",
             f"Requires-Python: {value_of('requires-python', project)}"]
    lines += [f"Classifier: {text}" for text in re.findall(r'^  "(.* :: .*)",$', project, re.MULTILINE)]
    lines += [f"Requires-Dist: {text}" for text in
              re.findall(r'"(.*?)"', re.search(r"^dependencies = \[(.*)\]$", project, re.MULTILINE).group(1))]
    lines += ["Provides-Extra: vtk", 'Requires-Dist: vtk; extra == "vtk"', "Description-Content-Type: text/markdown",
              "", (ROOT / value_of("readme", project)).read_text()]
    return "\n".join(lines)


def write_wheel(path, files):
    """files: contents by name. The record of their hashes comes last; times are those of 1980, so that the same files
    make the same wheel."""
    record = io.StringIO()
    rows = csv.writer(record, lineterminator="\n")
    info = next(name for name in files if name.endswith("/WHEEL")).rsplit("/", 1)[0]
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as wheel:
        for name, content in sorted(files.items()):
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            rows.writerow([name, f"sha256={digest}", len(content)])
            entry = zipfile.ZipInfo(name)
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, content)
        rows.writerow([f"{info}/RECORD", "", ""])
        wheel.writestr(zipfile.ZipInfo(f"{info}/RECORD"), record.getvalue())


def wheel_text(tag):
    return f"Wheel-Version: 1.0\nGenerator: pack_wheel\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()


def module_in(folder):
    modules = list(pathlib.Path(folder).glob("quadrille/_native*.so"))
    return modules[0] if len(modules) == 1 else fail(f"{folder} has not one module quadrille/_native")


def pack(folder, wheels):
    tag = tag_of(module_in(folder))
    name = f"quadrille_mesh-{version()}"
    files = {str(path.relative_to(folder)): path.read_bytes()
             for path in sorted(folder.glob("quadrille/**/*")) if path.is_file()}
    info = f"{name}.dist-info"
    files[f"{info}/METADATA"] = metadata().encode()
    files[f"{info}/WHEEL"] = wheel_text(tag)
    for licence in ("LICENSE", "Packaging/wheel/LICENSES"):
        files[f"{info}/licenses/{licence}"] = (ROOT / licence).read_bytes()
    write_wheel(wheels / f"{name}-{tag}.whl", files)


def retag(wheel, wheels, work):
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(work)
        files = {name: archive.read(name) for name in archive.namelist() if not name.endswith(("/RECORD", "/"))}
    tag = tag_of(module_in(work))
    info = next(name for name in files if name.endswith("/WHEEL"))
    files[info] = wheel_text(tag)
    write_wheel(wheels / f"quadrille_mesh-{version()}-{tag}.whl", files)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--retag", type=pathlib.Path)
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    given = parser.parse_args()
    if given.retag:
        import tempfile
        with tempfile.TemporaryDirectory() as work:
            retag(given.retag, given.folders[0], pathlib.Path(work))
    else:
        pack(*given.folders)


main()
