#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes a generated terrain of any size as binary PLY (float coordinates, int32 triangles).

    make_terrain.py TRIANGLES FILE.ply [--seed N] [--roughness H]

A square grid of heights: valleys and ridges down to about eight cells of the grid, whose amplitude falls with their
width as that of elevation models does (a random field with the spectrum k^-(1 + H)), and a little noise of the
measurement. The triangles run row by row, and each cell is cut along the shorter of its diagonals. The same arguments
give the same bytes. Memory: about 20 bytes a triangle.
"""

import argparse
import math
import sys

import numpy as np

ROWS_AT_ONCE = 256


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


def write(path, field):
    side = field.shape[0]
    faces = 2 * (side - 1) * (side - 1)
    record = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
    with open(path, "wb") as file:
        file.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {side * side}\n"
                    "property float x\nproperty float y\nproperty float z\n"
                    f"element face {faces}\nproperty list uchar int vertex_indices\nend_header\n").encode())
        along = np.arange(side, dtype=np.float32) / np.float32(side - 1)
        points = np.empty((side, 3), dtype="<f4")
        for row in range(side):
            points[:, 0] = along
            points[:, 1] = along[row]
            points[:, 2] = field[row]
            file.write(points.tobytes())
        cells = np.arange(side - 1, dtype=np.int64)
        for row in range(side - 1):
            a = row * side + cells
            b, c, d = a + 1, a + side + 1, a + side
            low, high = field[row], field[row + 1]
            first = np.abs(high[1:] - low[:-1]) <= np.abs(high[:-1] - low[1:])  # cut from a to c
            triangles = np.empty(2 * (side - 1), dtype=record)
            triangles["count"] = 3
            corners = triangles["corners"]
            corners[0::2] = np.stack([a, b, np.where(first, c, d)], axis=1)
            corners[1::2] = np.stack([np.where(first, a, b), c, d], axis=1)
            file.write(triangles.tobytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("triangles", type=int)
    parser.add_argument("file")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--roughness", type=float, default=1.0)
    arguments = parser.parse_args()
    if arguments.triangles < 8:
        parser.error("a terrain has at least 8 triangles")
    side = round(math.sqrt(arguments.triangles / 2)) + 1
    write(arguments.file, heights(side, arguments.seed, arguments.roughness))
    return 0


if __name__ == "__main__":
    sys.exit(main())
