#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what quadrille-costs writes: the irregular vertices and the distances of every cost, model by model, as SVG.

  quadrille-costs MESH... > costs.csv
  Scripts/figures/plot-costs.py costs.csv Documentation/Pictures/costs.svg
"""
import csv
import sys
from xml.sax.saxutils import escape

COLOURS = {"reference": "#555555", "E_G,mem": "#1f5fa8", "E_G": "#4aa3df", "E_QEM": "#d9822b", "E_uni": "#b03a48"}
PANEL_WIDTH, PANEL_HEIGHT, LEFT, TOP, GAP = 230, 150, 60, 56, 66


def valences(row):
    return {int(v): int(n) for v, n in (pair.split(":") for pair in row["valences"].split())}


def text(x, y, words, size=11, anchor="middle"):
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}">{escape(words)}</text>'


def bars(x, y, groups, most):
    """groups: [(name, [(colour, value)])], drawn side by side above the line at y + PANEL_HEIGHT."""
    parts, base = [], y + PANEL_HEIGHT
    step = PANEL_WIDTH / len(groups)
    for i, (name, values) in enumerate(groups):
        width = 0.8 * step / len(values)
        for k, (colour, value) in enumerate(values):
            height = PANEL_HEIGHT * value / most
            left = x + i * step + 0.1 * step + k * width
            parts.append(f'<rect x="{left:.1f}" y="{base - height:.1f}" width="{0.9 * width:.1f}" '
                         f'height="{height:.1f}" fill="{colour}"/>')
            parts.append(text(left + 0.45 * width, base - height - 3, f"{value:.0f}", 8))
        parts.append(text(x + (i + 0.5) * step, base + 14, name, 10))
    parts.append(f'<path d="M{x} {base}h{PANEL_WIDTH}" stroke="black"/>')
    return parts


def draw(rows):
    models = list(dict.fromkeys(row["mesh"] for row in rows))
    rows = [row for row in rows if row["field"] in COLOURS]
    width = LEFT + len(models) * (PANEL_WIDTH + 30)
    height = TOP + 2 * (PANEL_HEIGHT + GAP)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif">',
             f'<rect width="{width}" height="{height}" fill="white"/>']
    for i, (name, colour) in enumerate(COLOURS.items()):
        parts.append(f'<rect x="{LEFT + 120 * i}" y="8" width="12" height="12" fill="{colour}"/>')
        parts.append(text(LEFT + 120 * i + 18, 18, "no decimation" if name == "reference" else name, 12, "start"))
    counts = {id(row): valences(row) for row in rows}
    kinds = sorted({v for count in counts.values() for v in count})
    below = TOP + PANEL_HEIGHT + GAP
    for i, model in enumerate(models):
        own = [row for row in rows if row["mesh"] == model]
        x = LEFT + i * (PANEL_WIDTH + 30)
        parts.append(text(x + PANEL_WIDTH / 2, TOP - 16, model, 13))
        histogram = [(f"valence {kind}", [(COLOURS[row["field"]], counts[id(row)].get(kind, 0)) for row in own])
                     for kind in kinds]
        parts += bars(x, TOP, histogram, 1.15 * max(value for _, group in histogram for _, value in group))
        distances = [(COLOURS[row["field"]], float(row["distance"])) for row in own if row["field"] != "reference"]
        parts += bars(x, below, [("distance to the field without decimation", distances)],
                      1.15 * max(v for _, v in distances))
    for words, y in (("vertices", TOP), ("quarter turns x edges", below)):
        parts.append(f'<g transform="translate({LEFT - 20} {y + PANEL_HEIGHT / 2}) '
                     f'rotate(-90)">{text(0, 0, words)}</g>')
    return "\n".join(parts + ["</svg>"]) + "\n"


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if not rows or "valences" not in rows[0]:
        raise SystemExit(f"{sys.argv[1]} is not what quadrille-costs writes")
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(draw(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
