#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Damages surface files of all formats at random and has the command remesh them. Fails where it crashes, hangs, ends
without a message or with a code that its help does not list, or leaves a file behind after an error.

  damaged_files.py QUADRILLE MESH... [--files N] [--seed N] [--jobs N] [--limit SECONDS] [--keep FOLDER]

MESH, a PLY file, is written in every format that the command reads; a CAD file is taken as it is. Each damaged file is
one of these with bytes changed, cut away, doubled or inserted, numbers replaced, lines swapped or dropped. The same
seed makes the same files. What fails is kept in --keep.
"""
import argparse
import collections
import concurrent.futures
import math
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkIOGeometry import vtkOBJWriter, vtkSTLWriter
from vtkmodules.vtkIOLegacy import vtkPolyDataWriter
from vtkmodules.vtkIOPLY import vtkPLYReader, vtkPLYWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

#: Exit codes of the command that say what went wrong, as its help lists them; 0 is success.
CODES = set(range(8))
#: Numbers that files should not have, or not there.
NUMBERS = ("nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "0", "-1", "-0", "2147483647", "2147483648", "4294967295",
           "4294967296", "-2147483649", "9223372036854775808", "99999999999999999999999", "1e999", "0x1F", "1.5", "",
           "abc", "3", "1000000")
#: Of CAD files.
CAD = (".step", ".stp", ".iges", ".igs", ".brep", ".brp")
#: Bytes of address space, so that a length read from a damaged file cannot take the machine's memory.
MEMORY = 6 << 30
#: A run that waits, and does not compute, ends after so many times the limit.
SLOWEST = 20


def write_off(mesh, name):
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    faces = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    with open(name, "w", encoding="ascii") as file:
        file.write(f"OFF\n{len(points)} {len(faces)} 0\n")
        numpy.savetxt(file, points, fmt="%.9g")
        numpy.savetxt(file, numpy.insert(faces, 0, 3, axis=1), fmt="%d")


def write_all(mesh, stem):
    """The mesh in every format; the names of the files."""
    names = []

    def write(writer, name, **settings):
        writer.SetInputData(mesh)
        for setting, value in settings.items():
            getattr(writer, setting)(*value)
        writer.SetFileName(f"{stem}-{name}")
        if writer.Write() != 1:
            raise SystemExit(f"cannot write {stem}-{name}")
        names.append(f"{stem}-{name}")

    write(vtkPLYWriter(), "text.ply", SetFileTypeToASCII=())
    write(vtkPLYWriter(), "binary.ply", SetFileTypeToBinary=())
    write(vtkSTLWriter(), "text.stl", SetFileTypeToASCII=())
    write(vtkSTLWriter(), "binary.stl", SetFileTypeToBinary=())
    write(vtkOBJWriter(), "text.obj")
    write(vtkPolyDataWriter(), "text.vtk", SetFileTypeToASCII=())
    write(vtkPolyDataWriter(), "binary.vtk", SetFileTypeToBinary=())
    write(vtkXMLPolyDataWriter(), "text.vtp", SetDataModeToAscii=())
    write(vtkXMLPolyDataWriter(), "binary.vtp", SetDataModeToBinary=())
    write(vtkXMLPolyDataWriter(), "appended.vtp", SetDataModeToAppended=())
    write_off(mesh, f"{stem}-text.off")
    names.append(f"{stem}-text.off")
    return names


class Damage:
    """One kind after the other on the bytes of a file, by a seed."""

    def __init__(self, seed):
        self.random = random.Random(seed)

    def place(self, data):
        """Half of them in the first thousand bytes, where headers are."""
        last = max(len(data) - 1, 0)
        return self.random.randint(0, min(last, 1000) if self.random.random() < 0.5 else last)

    def bytes(self, data):
        for _ in range(self.random.choice((1, 1, 3, 30))):
            data[self.place(data)] = self.random.randrange(256)
        return data

    def bits(self, data):
        for _ in range(self.random.choice((1, 5))):
            data[self.place(data)] ^= 1 << self.random.randrange(8)
        return data

    def cut(self, data):
        return data[:self.place(data)]

    def hole(self, data):
        at = self.place(data)
        return data[:at] + data[at + self.random.choice((1, 2, 7, 100, 5000)):]

    def doubled(self, data):
        at = self.place(data)
        part = data[at:at + self.random.choice((1, 4, 80, 5000))]
        return data[:at] + part + data[at:]

    def inserted(self, data):
        at = self.place(data)
        count = self.random.choice((1, 3, 200))
        return data[:at] + bytearray(self.random.randrange(256) for _ in range(count)) + data[at:]

    def zeros(self, data):
        at, count = self.place(data), self.random.choice((4, 64, 2000))
        count = min(count, len(data) - at)
        data[at:at + count] = bytes([self.random.choice((0, 255, 127))]) * count
        return data

    def number(self, data):
        for _ in range(self.random.choice((1, 1, 4))):
            begin = self.place(data)
            found = re.compile(rb"-?\d+(\.\d+)?(e[-+]?\d+)?").search(bytes(data[begin:begin + 4000]))
            if found:
                data = (data[:begin + found.start()] + self.random.choice(NUMBERS).encode() +
                        data[begin + found.end():])
        return data

    def lines(self, data):
        lines = bytes(data).split(b"\n")
        for _ in range(self.random.choice((1, 10))):
            i, k = (self.random.randrange(min(len(lines), self.random.choice((20, len(lines))))) for _ in range(2))
            what = self.random.randrange(3)
            if what == 0:
                lines[i], lines[k] = lines[k], lines[i]
            elif what == 1:
                lines.insert(i, lines[k])
            elif len(lines) > 1:
                del lines[i]
        return bytearray(b"\n".join(lines))

    def appended(self, data):
        return data + data

    KINDS = (bytes, bits, cut, hole, doubled, inserted, zeros, number, number, lines, appended)

    def make(self, data):
        kinds = self.random.choices(self.KINDS, k=self.random.choice((1, 1, 1, 2)))
        for kind in kinds:
            data = kind(self, data) if data else data
        return bytes(data), "+".join(kind.__name__ for kind in kinds)


def run_one(program, originals, seed, limit, keep):
    """Why the file's run is a fault, or None, the exit code, the seconds and what the file is."""
    name = originals[seed % len(originals)]
    with open(name, "rb") as file:
        data, kinds = Damage(seed).make(bytearray(file.read()))
    what = f"{os.path.basename(name)} seed {seed} ({kinds})"
    suffix = os.path.splitext(name)[1]
    with tempfile.TemporaryDirectory() as folder:
        damaged = os.path.join(folder, "damaged" + suffix)
        with open(damaged, "wb") as file:
            file.write(data)
        sanitized = "ASAN_OPTIONS" in os.environ

        def bound():
            seconds = math.ceil(limit)
            resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
            if not sanitized:
                resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        start = time.monotonic()
        try:
            done = subprocess.run(
                [program, damaged, os.path.join(folder, "quads.vtp"), "--quads", "300", "--threads", "1"],
                capture_output=True, timeout=SLOWEST * limit, check=False, preexec_fn=bound)
            code, message = done.returncode, done.stderr.decode(errors="replace").strip()
            code = None if code == -signal.SIGXCPU else code
        except subprocess.TimeoutExpired:
            code, message = None, ""
        seconds = time.monotonic() - start
        left = sorted(set(os.listdir(folder)) - {"damaged" + suffix})
        fault = None
        if code is None:
            fault = f"not done after {limit:g} s of a processor"
        elif code not in CODES:
            fault = f"exit code {code}: {message[-600:]}"
        elif code == 0 and left != ["quads.vtp"]:
            fault = f"it succeeded, but the folder has {left}"
        elif code != 0 and left:
            fault = f"after the exit code {code} it left {left}"
        elif code != 0 and not message:
            fault = f"the exit code {code} without a message"
        elif re.search(r"std::|bad_alloc|terminate|Sanitizer|runtime error", message):
            fault = f"the message is not for users: {message[-600:]}"
        if fault and keep:
            os.makedirs(keep, exist_ok=True)
            shutil.copy(damaged, os.path.join(keep, f"{seed}{suffix}"))
    return fault, code, seconds, what, message


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("mesh", nargs="+")
    parser.add_argument("--files", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--limit", type=float, default=30, help="seconds of a processor")
    parser.add_argument("--keep")
    parser.add_argument("--messages", action="store_true", help="print each message once, numbers left out")
    arguments = parser.parse_args()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    codes, faults, slowest, messages = collections.Counter(), 0, (0, ""), collections.Counter()
    with tempfile.TemporaryDirectory() as folder:
        originals = []
        for mesh in arguments.mesh:
            if os.path.splitext(mesh)[1].lower() in CAD:
                originals.append(mesh)
                continue
            reader = vtkPLYReader()
            reader.SetFileName(mesh)
            reader.Update()
            surface = vtkPolyData()
            surface.ShallowCopy(reader.GetOutput())
            if surface.GetNumberOfPolys() == 0:
                parser.error(f"{mesh} has no triangles: give PLY or CAD files")
            originals += write_all(surface, os.path.join(folder, os.path.splitext(os.path.basename(mesh))[0]))
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            runs = [pool.submit(run_one, arguments.program, originals, arguments.seed + i, arguments.limit,
                                arguments.keep) for i in range(arguments.files)]
            for run in concurrent.futures.as_completed(runs):
                fault, code, seconds, what, message = run.result()
                codes[code] += 1
                slowest = max(slowest, (seconds, what))
                messages[re.sub(r"-?\d+(\.\d+)?(e-?\d+)?|/\S+", "#", message)] += 1
                if fault:
                    faults += 1
                    print(f"{what}: {fault}", flush=True)
    if arguments.messages:
        for message, count in messages.most_common():
            print(f"{count:5d}  {message[:300]}")
    told = ", ".join(f"{count} with {code}" for code, count in sorted(codes.items(), key=str))
    print(f"{arguments.files} files: {told}; slowest {slowest[0]:.1f} s, {slowest[1]}")
    print(f"damaged_files: {faults} faults" if faults else "damaged_files: fine")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
