#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes a generated terrain of any size as binary PLY (float coordinates, int32 triangles) or as VTP (float
coordinates, int64 ids as ParaView writes them, raw data without compression), by the name of the file.

    make_terrain.py TRIANGLES FILE.ply|FILE.vtp [--seed N] [--roughness H]

A square grid of heights: valleys and ridges down to about eight cells of the grid, whose amplitude falls with their
width as that of elevation models does (a random field with the spectrum k^-(1 + H)), and a little noise of the
measurement. The triangles run row by row, and each cell is cut along the shorter of its diagonals. The same arguments
give the same bytes. Memory: about 20 bytes a triangle.
"""

import argparse
import math
import pathlib
import sys

import numpy as np

ROWS_AT_ONCE = 256
TRIANGLES_AT_ONCE = 1 << 20


def heights(side, seed, roughness):
    """#side x #side, in units of the grid's side: a random field by its spectrum."""
    random = np.random.default_rng(seed)
    frequency = np.fft.fftfreq(side).astype(np.float32)[:, None] ** 2 + (
        np.fft.rfftfreq(side).astype(np.float32)[None, :] ** 2)
    np.sqrt(frequency, out=frequency)
    lowest = 1.5 / side
    amplitude = np.maximum(frequency, lowest) ** -(1 + roughness) * (frequency < 1 / 8)
    del frequency
    phase = random.random(amplitude.shape, dtype=np.float32)
    spectrum = amplitude * np.exp(2j * math.pi * phase).astype(np.complex64)
    del amplitude, phase
    field = np.fft.irfft2(spectrum, s=(side, side)).astype(np.float32)
    del spectrum
    field -= field.mean()
    field *= 0.06 / max(float(np.abs(field).max()), 1e-30)
    for first in range(0, side, ROWS_AT_ONCE):
        part = field[first:first + ROWS_AT_ONCE]
        part += 0.02 / side * random.standard_normal(part.shape, dtype=np.float32)
    return field


def rows_of_points(field):
    """Of each row of the grid its points, #side x 3."""
    side = field.shape[0]
    along = np.arange(side, dtype=np.float32) / np.float32(side - 1)
    points = np.empty((side, 3), dtype="<f4")
    for row in range(side):
        points[:, 0] = along
        points[:, 1] = along[row]
        points[:, 2] = field[row]
        yield points


def rows_of_triangles(field):
    """Of each row of cells its triangles, 2 (#side - 1) x 3."""
    side = field.shape[0]
    cells = np.arange(side - 1, dtype=np.int64)
    corners = np.empty((2 * (side - 1), 3), dtype="<i8")
    for row in range(side - 1):
        a = row * side + cells
        b, c, d = a + 1, a + side + 1, a + side
        low, high = field[row], field[row + 1]
        first = np.abs(high[1:] - low[:-1]) <= np.abs(high[:-1] - low[1:])  # cut from a to c
        corners[0::2] = np.stack([a, b, np.where(first, c, d)], axis=1)
        corners[1::2] = np.stack([np.where(first, a, b), c, d], axis=1)
        yield corners


def write_ply(path, field):
    side = field.shape[0]
    record = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
    with open(path, "wb") as file:
        file.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {side * side}\n"
                    "property float x\nproperty float y\nproperty float z\n"
                    f"element face {2 * (side - 1) ** 2}\nproperty list uchar int vertex_indices\n"
                    "end_header\n").encode())
        for points in rows_of_points(field):
            file.write(points.tobytes())
        triangles = np.empty(2 * (side - 1), dtype=record)
        triangles["count"] = 3
        for corners in rows_of_triangles(field):
            triangles["corners"] = corners
            file.write(triangles.tobytes())


def write_vtp(path, field):
    """Three blocks of raw data after the XML, each behind its number of bytes."""
    side = field.shape[0]
    faces = 2 * (side - 1) ** 2
    sizes = [12 * side * side, 24 * faces, 8 * faces]
    begins = [0, 8 + sizes[0], 16 + sizes[0] + sizes[1]]

    def array(kind, name, block, components=""):
        return f'<DataArray type="{kind}" Name="{name}"{components} format="appended" offset="{begins[block]}"/>'

    with open(path, "wb") as file:
        file.write(('<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" '
                    'header_type="UInt64">\n<PolyData>\n'
                    f'<Piece NumberOfPoints="{side * side}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" '
                    f'NumberOfPolys="{faces}">\n'
                    f'<Points>{array("Float32", "Points", 0, " NumberOfComponents=" + chr(34) + "3" + chr(34))}'
                    f'</Points>\n<Polys>{array("Int64", "connectivity", 1)}{array("Int64", "offsets", 2)}</Polys>\n'
                    '</Piece>\n</PolyData>\n<AppendedData encoding="raw">\n_').encode())
        file.write(np.array(sizes[0], dtype="<u8").tobytes())
        for points in rows_of_points(field):
            file.write(points.tobytes())
        file.write(np.array(sizes[1], dtype="<u8").tobytes())
        for corners in rows_of_triangles(field):
            file.write(corners.tobytes())
        file.write(np.array(sizes[2], dtype="<u8").tobytes())
        for first in range(0, faces, TRIANGLES_AT_ONCE):
            file.write((3 * np.arange(first + 1, min(first + TRIANGLES_AT_ONCE, faces) + 1, dtype="<i8")).tobytes())
        file.write(b"\n</AppendedData>\n</VTKFile>\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("triangles", type=int)
    parser.add_argument("file")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--roughness", type=float, default=1.0)
    arguments = parser.parse_args()
    if arguments.triangles < 8:
        parser.error("a terrain has at least 8 triangles")
    writer = {".ply": write_ply, ".vtp": write_vtp}.get(pathlib.Path(arguments.file).suffix.lower())
    if writer is None:
        parser.error(f"{arguments.file}: the name must end in .ply or .vtp")
    side = round(math.sqrt(arguments.triangles / 2)) + 1
    writer(arguments.file, heights(side, arguments.seed, arguments.roughness))
    return 0


if __name__ == "__main__":
    sys.exit(main())
