#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what Scripts/study/spread_table.py writes: how the bytes that ranks gather and send grow with the triangles at
the same number of quads, and with the quads on the same surface, as SVG with logarithmic axes.

  Scripts/study/spread_table.py SMALL.ply MIDDLE.ply LARGE.ply --ranks 4 --splits stripes --table triangles.csv ...
  Scripts/study/spread_table.py MIDDLE.ply --quads 5000,20000,80000 --ranks 4 --splits stripes --table quads.csv ...
  Scripts/figures/plot-spread.py triangles.csv quads.csv Documentation/Pictures/spread-bytes.svg

A dashed line shows growth in proportion. Runs of the same number of ranks are compared: each table has one.
"""
import csv
import math
import sys
from xml.sax.saxutils import escape

SERIES = (("gathered_mb", "gathered on one rank", "#1f5fa8"),
          ("sent_mb", "sent by the rank that sends most", "#d9822b"))
WIDTH, HEIGHT, LEFT, TOP, GAP = 300, 220, 70, 60, 100


def text(x, y, words, size=11, anchor="middle"):
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}">{escape(words)}</text>'


def number(value):
    return f"{value / 1e6:.3g} M" if value >= 1e6 else f"{value:,.0f}" if value >= 10 else f"{value:g}"


class Axis:
    """Logarithmic, from a power of two below the least value to one above the largest."""

    def __init__(self, values, begin, length):
        self.low = math.floor(math.log2(min(values)) - 0.2)
        self.high = math.ceil(math.log2(max(values)) + 0.2)
        self.begin, self.length = begin, length

    def at(self, value):
        return self.begin + self.length * (math.log2(value) - self.low) / (self.high - self.low)

    def ticks(self):
        return [2.0 ** k for k in range(self.low, self.high + 1)]


def panel(left, rows, column, words):
    rows = sorted(rows, key=lambda row: float(row[column]))
    across = [float(row[column]) for row in rows]
    up = [float(row[name]) for row in rows for name, _, _ in SERIES]
    x, y = Axis(across, left, WIDTH), Axis(up + [up[0] * across[-1] / across[0]], TOP + HEIGHT, -HEIGHT)
    parts = [f'<rect x="{left}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="black"/>',
             text(left + WIDTH / 2, TOP + HEIGHT + 44, words, 12)]
    for value in across:
        parts.append(f'<path d="M{x.at(value):.1f} {TOP + HEIGHT}v5" stroke="black"/>')
        parts.append(text(x.at(value), TOP + HEIGHT + 18, number(value)))
    for value in y.ticks():
        parts.append(f'<path d="M{left} {y.at(value):.1f}h-5" stroke="black"/>')
        parts.append(text(left - 8, y.at(value) + 4, f"{value:g} MB", 10, "end"))
    for name, _, colour in SERIES:
        values = [float(row[name]) for row in rows]
        points = " ".join(f"{x.at(a):.1f},{y.at(b):.1f}" for a, b in zip(across, values))
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
        for a, b in zip(across, values):
            parts.append(f'<circle cx="{x.at(a):.1f}" cy="{y.at(b):.1f}" r="3.5" fill="{colour}"/>')
            parts.append(text(x.at(a), y.at(b) - 8, f"{b:.3g}", 10))
        proportion = values[0] * across[-1] / across[0]
        if math.log2(proportion) <= y.high:
            parts.append(f'<path d="M{x.at(across[0]):.1f} {y.at(values[0]):.1f}L{x.at(across[-1]):.1f} '
                         f'{y.at(proportion):.1f}" stroke="{colour}" stroke-dasharray="4 4" fill="none"/>')
    return parts


def read(path):
    """The runs of several ranks."""
    with open(path, encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row.get("gathered_mb") not in (None, "", "0")]
    if len(rows) < 2 or "sent_mb" not in rows[0]:
        raise SystemExit(f"{path} is not a table of spread_table.py with at least two runs over ranks")
    if len({(row["ranks"], row["split"]) for row in rows}) != 1:
        raise SystemExit(f"{path} has runs of several numbers of ranks, or of several cuts")
    return rows


def main():
    if len(sys.argv) != 4:
        raise SystemExit(__doc__)
    by_triangles, by_quads = read(sys.argv[1]), read(sys.argv[2])
    width, height = 2 * LEFT + 2 * WIDTH + GAP, TOP + HEIGHT + 60
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif">',
             f'<rect width="{width}" height="{height}" fill="white"/>']
    for i, (_, words, colour) in enumerate(SERIES):
        parts.append(f'<rect x="{LEFT + 200 * i}" y="10" width="12" height="12" fill="{colour}"/>')
        parts.append(text(LEFT + 200 * i + 18, 20, words, 12, "start"))
    parts.append(f'<path d="M{LEFT + 440} 16h24" stroke="#555555" stroke-dasharray="4 4"/>')
    parts.append(text(LEFT + 470, 20, "in proportion", 12, "start"))
    quads, faces = number(round(float(by_triangles[0]["quads"]), -3)), number(float(by_quads[0]["faces"]))
    parts += panel(LEFT, by_triangles, "faces", f"triangles, about {quads} quads")
    parts += panel(LEFT + WIDTH + GAP, by_quads, "quads", f"quads of {faces} triangles")
    with open(sys.argv[3], "w", encoding="utf-8") as file:
        file.write("\n".join(parts + ["</svg>"]) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
