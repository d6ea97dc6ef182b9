# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Tables, figures and the page of an evaluation. Figures are SVG, in the manner of Figures 10 and 13 and of Table 1 of
[Ebke et al. 2016]: the reference is a red shadow behind each histogram, and the earth mover's distance is relative to
that of E_G,mem."""
import csv
import dataclasses
import html
import json
import os

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

from .study import COSTS, MEASURES  # noqa: E402

#: The same file for the same numbers: no date, no random names.
matplotlib.rcParams["svg.hashsalt"] = "quadrille"
PLAIN = {"Date": None}
SHADOW, OURS = "#e8a0a0", "#2b5c8a"
UNITS = {"Sizing": "det / s²", "Anisotropy": "σ₁ / σ₂", "Shear": "angle of isolines, degrees"}
#: Valences that each picture shows, whether there are such vertices or not.
VALENCES = range(1, 8)


def _save(figure, folder, name):
    figure.savefig(os.path.join(folder, name), metadata=PLAIN)
    plt.close(figure)
    return name


def relative_distance(study, outcome):
    """The earth mover's distance of an outcome in percent of that of E_G,mem; None where one of them has none."""
    base = next((each for each in study.outcomes if each.name == COSTS[0][0]), None)
    if base is None or base.error or outcome.error or not base.distance["Irregular vertices"] > 0:
        return None
    return 100 * outcome.distance["Irregular vertices"] / base.distance["Irregular vertices"]


def _by_cost(study):
    names = [name for name, _ in COSTS]
    return [outcome for outcome in study.outcomes if outcome.name in names]


def draw_valences(study, folder):
    """Irregular vertices by valence, one picture for each cost."""
    outcomes = _by_cost(study)
    figure, axes = plt.subplots(1, len(outcomes), figsize=(3 * len(outcomes), 2.6), sharey=True, squeeze=False,
                                layout="constrained")
    shown = sorted(set(VALENCES).union(*(each.valences for each in outcomes), study.reference.valences) - {4})
    for axis, outcome in zip(axes[0], outcomes):
        axis.bar(shown, [study.reference.valences.get(v, 0) for v in shown], width=0.9, color=SHADOW)
        axis.bar(shown, [outcome.valences.get(v, 0) for v in shown], width=0.45, color=OURS)
        far = relative_distance(study, outcome)
        below = f"\nEMD {far:.0f} %" if far is not None else "\nno map" if outcome.error else ""
        axis.set_title(outcome.name + below, fontsize=10)
        axis.set_xticks(shown)
        axis.set_xlabel("valence")
    axes[0][0].set_ylabel("irregular vertices")
    return _save(figure, folder, f"{study.model}-valences.svg")


def draw_distortion(study, folder):
    """Histograms of sizing, anisotropy and shear over the area, a row for each cost."""
    outcomes = [outcome for outcome in _by_cost(study) if not outcome.error]
    figure, axes = plt.subplots(len(outcomes), len(MEASURES), figsize=(9, 1.7 * len(outcomes) + 0.4), squeeze=False,
                                sharex="col", layout="constrained")
    for place, (row, outcome) in enumerate(zip(axes, outcomes)):
        for axis, measure in zip(row, MEASURES):
            middles, shares = outcome.histograms[measure]
            reference = study.reference.histograms[measure][1]
            axis.fill_between(middles, reference, step="mid", color=SHADOW, linewidth=0)
            axis.step(middles, shares, where="mid", color=OURS, linewidth=1)
            axis.set_ylim(bottom=0)
            if measure == "Sizing":
                axis.set_xscale("log", base=2)
            if place + 1 == len(outcomes):
                axis.set_xlabel(f"{measure.lower()}: {UNITS[measure]}")
        row[0].set_ylabel(f"{outcome.name}\n% of the area")
    return _save(figure, folder, f"{study.model}-distortion.svg")


def draw_budgets(study, folder):
    """What the budget of the coarse level changes: the means and the distance of the irregular vertices. None where
    there is one budget alone."""
    outcomes = sorted((each for each in study.outcomes[1:] if each.name.startswith("E_G") and not each.error and
                       not each.name.startswith("E_G,m")), key=lambda each: each.vertices)
    if len(outcomes) < 2:
        return None
    figure, axes = plt.subplots(1, 3, figsize=(9, 2.6), layout="constrained")
    vertices = [each.vertices for each in outcomes]
    for axis, measure in zip(axes, ("Anisotropy", "Shear", "Irregular vertices")):
        values = [(each.distance if measure == "Irregular vertices" else each.means)[measure] for each in outcomes]
        axis.plot(vertices, values, "o-", color=OURS)
        if measure in MEASURES:
            axis.axhline(study.reference.means[measure], color="#c04040", linewidth=1)
            axis.set_title(f"mean {measure.lower()}", fontsize=10)
        else:
            axis.set_title("EMD, quarter turns × edge lengths", fontsize=10)
        axis.set_xlabel("coarse vertices")
    return _save(figure, folder, f"{study.model}-budgets.svg")


ROW = ("model", "map", "vertices", "triangles", "irregular", "extreme", "emd", "emd_percent", "sizing", "anisotropy",
       "shear", "sizing_median", "anisotropy_median", "shear_median", "sizing_distance", "anisotropy_distance",
       "shear_distance", "guides", "inverted", "seconds_levels", "seconds_map", "seconds_carry", "error")


def row_of(study, outcome):
    """One line of the table; seconds are of the second decimation, of field and map, and of the way to the surface."""
    row = {"model": study.model, "map": outcome.name, "error": outcome.error}
    if outcome.error:
        return row
    seconds = outcome.seconds
    far = relative_distance(study, outcome)
    row.update(
        vertices=outcome.vertices, triangles=outcome.triangles, irregular=sum(outcome.valences.values()),
        extreme=outcome.extreme, emd=round(outcome.distance["Irregular vertices"], 1),
        emd_percent="" if far is None else round(far), inverted=outcome.inverted,
        guides="" if outcome.guides is None else round(outcome.guides, 2))
    for measure in MEASURES:
        row[measure.lower()] = round(outcome.means[measure], 4)
        row[measure.lower() + "_median"] = round(outcome.medians[measure], 4)
        row[measure.lower() + "_distance"] = round(outcome.distance[measure], 4)
    for column, stages in (("seconds_levels", ("phase2",)), ("seconds_map", ("field", "seamless", "quantize", "embed")),
                           ("seconds_carry", ("replay", "charts", "certify"))):
        row[column] = round(sum(seconds.get(stage, 0) for stage in stages), 3)
    return row


def write_tables(studies, meshes, about, folder):
    """evaluation.csv, meshes.csv where there are meshes, and evaluation.json with all numbers and `about`."""
    with open(os.path.join(folder, "evaluation.csv"), "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, ROW, restval="")
        writer.writeheader()
        for study in studies:
            writer.writerows(row_of(study, outcome) for outcome in study.outcomes)
    if meshes:
        columns = list(dict.fromkeys(key for mesh in meshes for key in mesh))
        with open(os.path.join(folder, "meshes.csv"), "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, columns, restval="")
            writer.writeheader()
            writer.writerows(meshes)
    with open(os.path.join(folder, "evaluation.json"), "w", encoding="utf-8") as file:
        json.dump({"about": about, "studies": [dataclasses.asdict(study) for study in studies], "meshes": meshes}, file,
                  indent=1)


def _table(rows, columns):
    def cell(value):
        return f"<td>{html.escape(str(value))}</td>"
    head = "".join(f"<th>{html.escape(title)}</th>" for title, _ in columns)
    body = "\n".join("<tr>" + "".join(cell(row.get(key, "")) for _, key in columns) + "</tr>" for row in rows)
    return f"<table>\n<tr>{head}</tr>\n{body}\n</table>"


STUDY_COLUMNS = (("map", "map"), ("vertices", "vertices"), ("irregular", "irregular"), ("extreme", "extreme"),
                 ("EMD", "emd"), ("EMD %", "emd_percent"), ("sizing", "sizing"), ("anisotropy", "anisotropy"),
                 ("median", "anisotropy_median"), ("shear", "shear"), ("median", "shear_median"),
                 ("W₁ sizing", "sizing_distance"), ("W₁ anisotropy", "anisotropy_distance"),
                 ("W₁ shear", "shear_distance"), ("guides °", "guides"), ("t_d s", "seconds_levels"),
                 ("t_p s", "seconds_map"), ("t_m s", "seconds_carry"), ("", "error"))
MESH_COLUMNS = (("mesh", "mesh"), ("quads", "quads"), ("others", "other_faces"), ("irregular", "irregular"),
                ("patches", "patches"), ("components", "components"), ("loops", "boundary_loops"), ("χ", "euler"),
                ("SJ mean", "sj_mean"), ("SJ least", "sj_least"), ("SJ ≤ 0", "sj_not_positive"),
                ("angle mean", "angle_mean"),
                ("angle 5 %", "angle_5"), ("CV", "edge_cv"), ("distance %", "distance_mean"),
                ("largest %", "distance_largest"), ("sharp %", "feature_mean"), ("largest %", "feature_largest"),
                ("on edges", "feature_share"),
                ("s", "seconds"), ("", "note"), ("", "error"))
STYLE = """body { font-family: sans-serif; max-width: 75em; margin: 2em auto; line-height: 1.4 }
table { border-collapse: collapse; font-size: 85% } td, th { padding: 0.2em 0.6em; text-align: right }
td:first-child, th:first-child { text-align: left } tr:nth-child(even) { background: #f2f4f6 }
img { max-width: 100% }"""


def _shown(row):
    return {key: f"{value:.4g}" if isinstance(value, float) else value for key, value in row.items()}


def write_page(studies, meshes, about, folder):
    """index.html, with the figures beside it."""
    parts = [f"<h1>Evaluation</h1>\n<p>Made by <code>{html.escape(about['command'])}</code></p>",
             _table([{"what": key, "value": value} for key, value in about.items() if key != "command"],
                    (("", "what"), ("", "value")))]
    for study in studies:
        figures = [draw(study, folder) for draw in (draw_valences, draw_distortion, draw_budgets)]
        parts.append(
            f"<h2>{html.escape(study.model)}</h2>\n<p>{study.triangles:,} triangles, {study.quads:,} quads asked for, "
            f"method {study.method}. Reference (red): {html.escape(study.reference_note)}. EMD: earth mover's distance "
            "of the irregular vertices, in quarter turns times edge lengths, and relative to E_G,mem. Means and "
            "distances are over the area; guides: the mean angle between them and the isolines.</p>")
        parts.append(_table([_shown(row_of(study, outcome)) for outcome in study.outcomes], STUDY_COLUMNS))
        parts += [f'<p><img src="{html.escape(name)}" alt="{html.escape(name)}"></p>' for name in figures if name]
    if meshes:
        parts.append("<h2>Meshes</h2>\n<p>Distances are means of both ways, and the largest, in percent of the "
                     "surface's diagonal; sharp: the same from its edges above 40 degrees to the edges of the mesh, "
                     "and the share of their length that is on these; patches: of the base complex; SJ: scaled "
                     "Jacobian of the quads; CV: deviation of edge lengths over their mean.</p>")
        parts.append(_table([_shown(mesh) for mesh in meshes], MESH_COLUMNS))
    with open(os.path.join(folder, "index.html"), "w", encoding="utf-8") as file:
        file.write('<!DOCTYPE html>\n<html lang="en">\n<head><meta charset="utf-8"><title>Evaluation</title>\n'
                   f"<style>{STYLE}</style></head>\n<body>\n" + "\n".join(parts) + "\n</body>\n</html>\n")
