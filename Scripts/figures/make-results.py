#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the quadrille command over a folder of models and judges every result.

  Scripts/figures/make-results.py --data FOLDER --judge quadstats.py [--command build/bin/quadrille] [--out out/results]

Writes Documentation/Results.md, and in --out one JSON a run, all.json, the meshes and contact sheets of
pictures. The runs go one after the other. A run that is already there for the same build of the command is not
repeated, so the script can be stopped and started again. Needs Debian's python3 with numpy and scipy.
"""
import argparse
import csv
import hashlib
import importlib.util
import json
import multiprocessing
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import time

import numpy as np
from scipy.spatial import cKDTree

import made_from

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "study"))
import told_details  # noqa: E402

MODELS = [
    "scan/bunny_69k.ply", "scan/armadillo_86k.ply", "scan/nefertiti_100k.ply", "scan/igea.ply", "scan/bunny_ct.ply",
    "cad/fandisk.ply", "cad/joint.ply", "cad/rolling_stage.ply", "cad/of_flange.ply", "cad/tm_torus.ply",
    "cad/cgal_anchor_dense.ply", "cad/thingi_908460.ply",
    "open/mountain.ply", "open/plane_holes.ply", "open/st_helens.ply", "open/mask.ply",
]
COUNTS = [2500, 10000]
EVERY_FOLDER, EVERY_COUNT = ["scan", "cad", "open"], [1000, 2500, 10000]
WITH_SHARP_FEATURES = {"fandisk", "joint", "of_flange"}
EXIT_CODES = {0: "quads", 2: "bad input", 3: "no valid result"}
# Limits of the acceptance bar.
COUNT_DEVIATION, JACOBIAN_MEAN, JACOBIAN_BAD = 0.15, 0.93, 0.005
OTHER_VALENCES, DISTANCE, FEATURE_DISTANCE = 0.05, 0.0005, 0.001
SCALE_SECONDS, SCALE_MEGABYTES = 60, 4096
VALID_RUNS_NEEDED = 28
EVERY_JACOBIAN_MEAN = 0.95


# ------------------------------------------------------------------------------------------- running
def buildStamp(command):
    """Changes with the command and with the project's libraries that it loads."""
    digest = hashlib.sha256(pathlib.Path(command).read_bytes())
    library = pathlib.Path(command).resolve().parent.parent / "lib"
    for path in sorted(library.glob("**/*uadrille*.so*")) if library.is_dir() else []:
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def runLimited(arguments, seconds):
    """Runs a program in a process group of its own: exit code (None: killed at the limit), times, memory, output."""
    start = time.time()
    process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
    os.set_blocking(process.stdout.fileno(), False)
    output, code, usage, timedOut = b"", None, None, False
    while usage is None:
        output += process.stdout.read() or b""
        pid, status, used = os.wait4(process.pid, os.WNOHANG)
        if pid:
            usage, code = used, os.waitstatus_to_exitcode(status)
        elif time.time() - start > seconds and not timedOut:
            os.killpg(process.pid, signal.SIGKILL)
            timedOut = True
        else:
            time.sleep(0.02)
    process.returncode = code
    output += process.stdout.read() or b""
    process.stdout.close()
    return {"exit": None if timedOut else code, "seconds": time.time() - start,
            "cpuSeconds": usage.ru_utime + usage.ru_stime, "peakMegabytes": usage.ru_maxrss / 1024,
            "output": output.decode(errors="replace").replace("\r", "\n")[-4000:]}


def lastMessage(output):
    """The line of the output that tells why a run failed, without the folders of files, which are this machine's."""
    lines = [l.strip() for l in output.splitlines() if l.strip()]
    telling = [l for l in lines if "error" in l.lower() or l.lower().startswith("quadrille:")]
    return re.sub(r"(?<=\s)/\S*/", "", (telling or lines or [""])[-1])[:300]


def runModel(options, model, count, reference):
    name = f"{pathlib.Path(model).stem}-{count}"
    result, record = options.out / f"{name}.obj", options.out / f"{name}.json"
    if record.exists() and not options.fresh:
        old = json.loads(record.read_text())
        if old["stamp"] == options.stamp or options.keep:
            return old
    print(f"{name} ...", end=" ", flush=True)
    report = options.out / f"{name}-report.json"
    for path in (result, report, record):
        path.unlink(missing_ok=True)
    row = {"name": name, "model": model, "asked": count, "stamp": options.stamp}
    row.update(runLimited([options.command, str(options.data / model), str(result), "--quads", str(count),
                           "--report", str(report)] + options.extra, options.timeout))
    row["report"] = readJson(report)
    row["outputLeft"] = result.exists()
    if row["exit"] == 0 and result.exists():
        try:
            row["stats"] = judgeApart(options, result, options.data / model, reference)
        except Exception as problem:
            row["judgeProblem"] = f"{type(problem).__name__}: {problem}"
    record.write_text(json.dumps(row, indent=1))
    print(f"exit {row['exit']}, {row['seconds']:.1f} s", flush=True)
    return row


def readJson(path):
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError):
        return None


# ------------------------------------------------------------------------------------------- judging
def loadJudge(path):
    spec = importlib.util.spec_from_file_location("quadstats", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def judgeApart(options, result, source, reference):
    """judge() in a process of its own: what a parent has used would count as memory of the commands started later."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return pool.apply(judge, (options.judge, result, source, reference, options.samples))


def judge(judgePath, result, source, reference, sampleCount):
    try:
        return measure(loadJudge(judgePath), result, source, reference, sampleCount)
    except SystemExit as problem:   # the judge refuses what it cannot read; a pool would hang on this
        raise ValueError(str(problem)) from None


def measure(tool, result, source, reference, sampleCount):
    quads = tool.read_mesh(str(result))
    readable = source.suffix.lower() in (".ply", ".obj")
    compared = tool.read_mesh(str(source)) if readable and reference else None
    stats = tool.stats(quads, compared, samples=sampleCount)
    if source.stem in WITH_SHARP_FEATURES and compared is not None:
        stats["featureDistanceRel"] = featureDistance(tool, quads, compared, stats["reference"]["bbox_diagonal"])
    return stats


def featureDistance(tool, quads, reference, diagonal, angle=40.0):
    """Mean distance from the reference's sharp edges to the edges of the quads over the diagonal."""
    points, index, offsets = reference
    topology = tool.topology(len(points), index, offsets)
    normals = tool.face_normals(points, topology)
    h0, h1, face = topology["h0"], topology["h1"], topology["fid"]
    cosine = np.einsum("nd,nd->n", normals[face[h0]], normals[face[h1]])
    sharp = h0[cosine < np.cos(np.radians(angle))]
    a, b = points[topology["idx"][sharp]], points[topology["idx"][topology["nxt"][sharp]]]
    samples = samplesOnSegments(a, b, 20000)
    quadTopology = tool.topology(len(quads[0]), quads[1], quads[2])
    distances = distanceToSegments(samples, quads[0][quadTopology["elo"]], quads[0][quadTopology["ehi"]])
    return float(distances.mean() / diagonal)


def samplesOnSegments(a, b, count):
    length = np.linalg.norm(b - a, axis=1)
    cumulative = np.concatenate([[0], np.cumsum(length)])
    s = (np.arange(count) + 0.5) / count * cumulative[-1]
    i = np.clip(np.searchsorted(cumulative, s, side="right") - 1, 0, len(a) - 1)
    t = np.clip((s - cumulative[i]) / np.maximum(length[i], 1e-300), 0, 1)[:, None]
    return a[i] * (1 - t) + b[i] * t


def distanceToSegments(p, a, b):
    """Exact where the nearest segment is among those with the 48 nearest middles; else an upper bound."""
    tree = cKDTree((a + b) / 2)
    _, near = tree.query(p, k=min(48, len(a)))
    near = near.reshape(len(p), -1)
    best = np.full(len(p), np.inf)
    for column in near.T:
        d = b[column] - a[column]
        t = np.clip(np.einsum("nd,nd->n", p - a[column], d) / np.maximum(np.einsum("nd,nd->n", d, d), 1e-300), 0, 1)
        best = np.minimum(best, np.linalg.norm(p - a[column] - t[:, None] * d, axis=1))
    return best


def otherValences(stats):
    """Irregular vertices, and those of them whose index is not +-1/4: inside not 3 or 5, on the boundary not 2 or 4."""
    inner = {int(k): n for k, n in stats["valence"]["interior"].items()}
    border = {int(k): n for k, n in stats["valence"]["boundary"].items()}
    irregular = sum(n for k, n in inner.items() if k != 4) + sum(n for k, n in border.items() if k != 3)
    other = sum(n for k, n in inner.items() if k not in (3, 4, 5))
    other += sum(n for k, n in border.items() if k not in (2, 3, 4))
    return irregular, other


def countsOf(topology):
    """What details change."""
    return {"components": topology["components"], "loops": topology["boundary_loops"],
            "euler": topology["euler_characteristic"]}


def verdict(row):
    """Figure and pass or fail for every line of the bar; None where a line does not apply."""
    lines = {"ends": (row["exit"] in EXIT_CODES and (row["exit"] == 0) == row["outputLeft"]
                      and (row["exit"] == 0 or bool(lastMessage(row["output"]))), row["exit"])}
    stats = row.get("stats")
    if not stats:
        return lines
    topology, reference = stats["topology"], stats.get("reference")
    if reference:
        lines["topology"] = (stats["counts"]["non_quads"] == 0 and topology["manifold"] and topology["oriented"]
                             and (topology["closed"] or not reference["closed"])
                             and countsOf(topology) == told_details.without(countsOf(reference),
                                                                            (row.get("report") or {}).get("details")),
                             topology["euler_characteristic"])
    count = stats["counts"]["quads"]
    lines["count"] = (abs(count - row["asked"]) <= COUNT_DEVIATION * row["asked"], count)
    if stats["quality"]:
        bad = stats["quality"]["quads_sj_le_0"] / max(count, 1)
        mean = stats["quality"]["scaled_jacobian_mean"]
        lines["jacobian"] = (mean >= JACOBIAN_MEAN and bad < JACOBIAN_BAD, (mean, bad))
    irregular, other = otherValences(stats)
    lines["valence"] = (other < OTHER_VALENCES * irregular or other == 0, (irregular, other))
    if "distance" in stats:
        mean = stats["distance"]["quads_to_reference"]["mean_rel"]
        lines["distance"] = (mean <= DISTANCE if row["asked"] >= 10000 else None, mean)
    if "featureDistanceRel" in stats:
        lines["features"] = (stats["featureDistanceRel"] <= FEATURE_DISTANCE, stats["featureDistanceRel"])
    if "bunny_ct" in row["name"]:
        lines["scale"] = (row["seconds"] < SCALE_SECONDS and row["peakMegabytes"] < SCALE_MEGABYTES, row["seconds"])
    return lines


def badVerdict(row):
    """A repaired surface with quads, or a clear error; nothing half-written."""
    if row["exit"] == 0:
        stats = row.get("stats")
        fine = (bool(stats) and stats["counts"]["non_quads"] == 0 and stats["counts"]["quads"] > 0
                and stats["topology"]["manifold"])
        return fine, repairText(row)
    clear = row["exit"] in EXIT_CODES and not row["outputLeft"] and bool(lastMessage(row["output"]))
    return clear, lastMessage(row["output"]) or "no message"


def repairText(row):
    """What the report says about repairs: its nonzero counts, or its text."""
    report = row.get("report") or {}
    repair = report.get("repair", report.get("repaired"))
    if isinstance(repair, dict):
        said = [f"{value} {key}" for key, value in repair.items() if isinstance(value, (int, float)) and value]
        text = repair.get("text") if isinstance(repair.get("text"), str) else ""
        return ", ".join(said) or text or "nothing to repair"
    return str(repair) if repair else "nothing to repair"


def unresolved(row):
    """Whether the report says that the edge length is too long for a handle; None where it does not say."""
    handles = (row.get("report") or {}).get("unresolved_handles")
    return None if handles is None else handles > 0


# ------------------------------------------------------------------------------------------- writing
def mark(ok):
    return "" if ok is None else (" ✓" if ok else " **✗**")


def tableRow(row):
    v = verdict(row)
    if "stats" not in row:
        why = ("killed at the time limit" if row["exit"] is None
               else row.get("judgeProblem") or lastMessage(row["output"]))
        code = "timeout" if row["exit"] is None else f"exit {row['exit']}"
        return (f"| {row['name']} | {code}{mark(v['ends'][0])} | {escape(why)} |||||| "
                f"{row['seconds']:.1f} | {row['peakMegabytes']:.0f} |")
    cells = [row["name"], "", "", "", "", "", "", ""]
    topology = row["stats"]["topology"]
    right = mark(v["topology"][0]) if "topology" in v else ""
    cells[1] = f"chi {topology['euler_characteristic']}, {topology['boundary_loops']} loops{right}"
    cells[2] = f"{v['count'][1]} ({100 * (v['count'][1] / row['asked'] - 1):+.1f} %){mark(v['count'][0])}"
    if "jacobian" in v:
        cells[3] = f"{v['jacobian'][1][0]:.3f}{mark(v['jacobian'][0])}"
        cells[4] = f"{100 * v['jacobian'][1][1]:.2f} %"
    cells[5] = f"{v['valence'][1][0]}, {v['valence'][1][1]}{mark(v['valence'][0])}"
    if "distance" in v:
        cells[6] = f"{100 * v['distance'][1]:.4f} %{mark(v['distance'][0])}"
    if "features" in v:
        cells[7] = f"{100 * v['features'][1]:.4f} %{mark(v['features'][0])}"
    timing = mark(v["scale"][0]) if "scale" in v else ""
    return "| " + " | ".join(cells) + f" | {row['seconds']:.1f}{timing} | {row['peakMegabytes']:.0f} |"


def escape(text):
    return text.replace("|", "\\|").replace("\n", " ")


def summary(rows):
    def tally(line, ofRows):
        judged = [verdict(r).get(line) for r in ofRows]
        judged = [j[0] for j in judged if j is not None and j[0] is not None]
        return sum(judged), len(judged)

    valid = [r for r in rows if verdict(r).get("topology", (False,))[0]]
    text = {
        "ends": "ends by itself with quads or a clear error",
        "topology": "quads only, manifold, oriented, topology of the input",
        "count": f"count within {100 * COUNT_DEVIATION:.0f} % of the asked one",
        "jacobian": f"scaled Jacobian: mean >= {JACOBIAN_MEAN}, fewer than {100 * JACOBIAN_BAD} % <= 0",
        "valence": f"irregular vertices other than 3 and 5: fewer than {100 * OTHER_VALENCES:.0f} %",
        "distance": f"mean distance to the input <= {100 * DISTANCE:.2f} % of the diagonal (at 10,000)",
        "features": f"sharp features on quad edges, mean distance <= {100 * FEATURE_DISTANCE:.1f} %",
        "scale": f"bunny_ct under {SCALE_SECONDS} s and {SCALE_MEGABYTES / 1024:.0f} GiB",
    }
    out = ["| line of the bar | passed |", "|---|---|"]
    for line, words in text.items():
        passed, total = tally(line, rows if line in ("ends", "scale") else valid)
        if line == "topology":
            passed, total = len(valid), len(rows)
            words += f" (needed: {VALID_RUNS_NEEDED} of 32)"
        out.append(f"| {words} | {passed} of {total} |")
    every = sum(all(j[0] is not False for j in verdict(r).values()) and r in valid for r in rows)
    out.append(f"| **all lines at once** | {every} of {len(rows)} |")
    return "\n".join(out)


def writeMarkdown(options, rows, badRows, everyRows):
    parts = ["# Results", "",
             "Written by `Scripts/figures/make-results.py`; do not edit. Judged by an independent tool: exact "
             f"topology, exact distances of {options.samples:,} samples. A figure is followed by ✓ or ✗ where the bar "
             "has a limit for it. The topology is that of the input less the small details that the run tells as "
             "simplified. Lines below \"topology\" count "
             "the runs with the right topology only.", "",
             made_from.madeFrom(options.commit, options.machine), "",
             "Times and memory are of the whole command, from file to file.", "",
             summary(rows), "",
             "| run | topology | quads | Jacobian mean | <= 0 | irregular, other than 3 and 5 | "
             "distance to the input | features | s | MB |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    parts += [tableRow(r) for r in rows]
    if badRows:
        fine = sum(badVerdict(r)[0] for r in badRows)
        parts += ["", "## Damaged input", "",
                  f"Quads on a repaired surface, or an error that says why; nothing half-written: {fine} of "
                  f"{len(badRows)}.", "",
                  "| file | outcome | quads | what was repaired, or the error | s | MB |", "|---|---|---|---|---|---|"]
        for row in badRows:
            ok, words = badVerdict(row)
            outcome = "timeout" if row["exit"] is None else EXIT_CODES.get(row["exit"], f"exit {row['exit']}")
            quads = row["stats"]["counts"]["quads"] if "stats" in row else ""
            parts.append(f"| {pathlib.Path(row['model']).name} | {outcome}{mark(ok)} | {quads} | {escape(words)} "
                         f"| {row['seconds']:.1f} | {row['peakMegabytes']:.0f} |")
    if everyRows:
        parts += [""] + everyModel(everyRows)
    peers = readPeers(options.peers) if options.peers else {}
    if peers:
        parts += [""] + againstPeers(peers, {r["name"]: r for r in everyRows + rows})
    if options.field:
        parts += [""] + fieldCounts(options.field)
    options.markdown.write_text("\n".join(
        line if line.startswith(("|", "#")) else made_from.filled(line)
        for part in parts for line in part.split("\n")) + "\n")


# ------------------------------------------------------------------------------------------- other tools
PEER_MODELS = {"bunny": "bunny_69k"}


def readPeers(path):
    """Quality of other tools from a page with a table of | model count | tool | quads | irregular | topology | SJ |
    opposing | ...: {run: [{tool, irregular, inverted, opposing, mean, topology, distance}]}."""
    peers, run = {}, None
    for line in path.read_text().splitlines():
        cells = [c.strip() for c in line.strip().strip("|").split("|")] if line.startswith("|") else []
        if len(cells) != 10 or "/" not in cells[5] or cells[1] == "tool":
            continue
        if cells[0]:
            model, count = cells[0].rsplit(" ", 1)
            run = f"{PEER_MODELS.get(model, model)}-{int(float(count.rstrip('k')) * 1000)}"
        least, mean, inverted = cells[5].split("/")
        peers.setdefault(run, []).append({
            "tool": cells[1], "irregular": sum(int(n) for n in cells[3].split("+")), "topology": cells[4],
            "mean": float(mean),
            "inverted": int(inverted), "opposing": int(cells[6]), "distance": float(cells[9].split("/")[1])})
    return peers


def againstPeers(peers, ours):
    """Model by model: irregular vertices, inverted quads, opposing quads, distance of each tool and of ours."""
    out = ["## Against other tools", "",
           "Irregular vertices (with those on the boundary), quads with scaled Jacobian <= 0, quads that face against "
           "the surface, mean scaled Jacobian, and mean distance to the input in % of the diagonal; the other tools on "
           "the same models, with their default settings. IM: Instant Meshes, QF: QuadriFlow, MIQ: libigl with libQEx, "
           "QW: QuadWild with Bi-MDF.", "",
           "| run | tool | irregular | <= 0 | opposing | Jacobian mean | distance | topology |",
           "|---|---|---|---|---|---|---|---|"]
    ahead, compared = [0, 0], 0
    for run, others in peers.items():
        row = ours.get(run)
        if row is None or "stats" not in row:
            continue
        quality = row["stats"]["quality"]
        own = {"irregular": verdict(row)["valence"][1][0], "inverted": quality["quads_sj_le_0"],
               "opposing": quality["quads_opposing_reference"], "mean": quality["scaled_jacobian_mean"],
               "distance": 100 * row["stats"]["distance"]["quads_to_reference"]["mean_rel"]}
        fine = verdict(row)["topology"][0]
        out.append(f"| {run} | **Quadrille** | **{own['irregular']}** | **{own['inverted']}** | **{own['opposing']}** "
                   f"| {own['mean']:.3f} | {own['distance']:.3f} | {'ok' if fine else 'wrong'} |")
        for peer in others:
            out.append(f"| | {peer['tool']} | {peer['irregular']} | {peer['inverted']} | {peer['opposing']} | "
                       f"{peer['mean']:.3f} | {peer['distance']:.3f} | {peer['topology']} |")
        rivals = [p for p in others if p["topology"] == "ok"]
        compared += 1
        better = [fine and all(own["irregular"] <= p["irregular"]
                               and sum(own[k] for k in kinds) <= sum(p[k] for k in kinds) for p in rivals)
                  for kinds in (("inverted",), ("inverted", "opposing"))]
        ahead = [n + b for n, b in zip(ahead, better)]
    out += ["", f"Among the tools with the right topology none has fewer irregular vertices, and none fewer quads with "
            f"scaled Jacobian <= 0, on {ahead[0]} of {compared} runs; with opposing quads counted, too, on {ahead[1]}."]
    return out


def fieldCounts(path):
    """What quadrille-bench --compare field wrote: irregular vertices with decimation over those without."""
    with open(path, newline="") as file:
        rows = [r for r in readCsv(file) if r["ok"] == "1"]
    within = [r for r in rows if int(r["irregular_coarse"]) <= 1.15 * int(r["irregular_surface"])]
    coarse, surface = (sum(int(r[k]) for r in rows) for k in ("irregular_coarse", "irregular_surface"))
    beyond = [r for r in rows if r not in within]
    out = ["## Irregular vertices with and without decimation", "",
           f"The field on the coarse level against the field on all of the surface (`quadrille-bench --compare "
           f"field`): at most 1.15 times as many on {share(len(within), len(rows))} of the runs with quads; {coarse:,} "
           f"against {surface:,} over all of them. The others:", "",
           "| run | on the coarse level | on the surface |", "|---|---|---|"]
    return out + [f"| {r['mesh']}-{r['quads']} | {r['irregular_coarse']} | {r['irregular_surface']} |" for r in beyond]


def readCsv(file):
    """Rows of several tables with the same header, one after the other."""
    lines = [line for line in file if line.strip()]
    return csv.DictReader([lines[0]] + [line for line in lines if line != lines[0]])


def share(passed, total):
    return f"{passed} of {total}" + (f" ({100 * passed / total:.1f} %)" if total else "")


def everyModel(rows):
    """The part of the page about all models: figures of the whole, and a line a run."""
    valid = [r for r in rows if verdict(r).get("topology", (False,))[0]]
    resolved = [r for r in rows if not unresolved(r)]
    certified = [r for r in valid if fineCertificate(r)]
    mapped = [r for r in rows if coarseCertificate(r)]
    quality = [r["stats"]["quality"] for r in valid]
    out = ["## Every model", "",
           f"All models of {', '.join(EVERY_FOLDER)} at {', '.join(f'{n:,}' for n in EVERY_COUNT)} quads. A run is "
           "resolved where no handle is shorter round than three edge lengths.", "",
           "| figure | runs |", "|---|---|",
           f"| quads with the topology of the input | {share(len(valid), len(rows))} |",
           f"| of the resolved ones | {share(sum(r in resolved for r in valid), len(resolved))} |",
           "| valid map of the coarse mesh, of the resolved ones | "
           f"{share(sum(r in resolved for r in mapped), len(resolved))} |",
           "| map on the input without defect, of the resolved ones | "
           f"{share(sum(r in resolved for r in certified), len(resolved))} |",
           f"| of those with quads: the map on the input has no defect | {share(len(certified), len(valid))} |",
           "| no quad with scaled Jacobian <= 0 | "
           f"{share(sum(q['quads_sj_le_0'] == 0 for q in quality), len(valid))} |",
           f"| mean scaled Jacobian >= {EVERY_JACOBIAN_MEAN} | "
           f"{share(sum(q['scaled_jacobian_mean'] >= EVERY_JACOBIAN_MEAN for q in quality), len(valid))} |",
           f"| count within {100 * COUNT_DEVIATION:.0f} % | "
           f"{share(sum(verdict(r)['count'][0] for r in valid), len(valid))} |", "",
           "| run | outcome | quads | Jacobian mean, min, <= 0 | irregular, other than 3 and 5 | "
           "shortest handle / s | s |",
           "|---|---|---|---|---|---|---|"]
    return out + [everyRow(r) for r in rows]


def fineCertificate(row):
    return not any("map on the input surface" in n for n in (row.get("report") or {}).get("notices", []))


def coarseCertificate(row):
    """Quads are made of valid coarse maps only; where none came, the error says which stage failed."""
    return row["exit"] == 0 or (row["exit"] == 3 and "no valid quad mesh" in lastMessage(row["output"]))


def everyRow(row):
    loop = (row.get("report") or {}).get("shortest_loop_over_edge_length") or 0
    loop = f"{loop:.1f}" if loop else ""
    v = verdict(row)
    if "stats" not in row:
        why = ("killed at the time limit" if row["exit"] is None
               else row.get("judgeProblem") or lastMessage(row["output"]))
        why = why.split(".ply: ", 1)[-1]
        return f"| {row['name']} | {escape(why[:160])} ||||{loop} | {row['seconds']:.1f} |"
    quality, (irregular, other) = row["stats"]["quality"], v["valence"][1]
    outcome = "quads" if v["topology"][0] else "wrong topology **✗**"
    if not fineCertificate(row):
        outcome += ", map mended by the extraction"
    return (f"| {row['name']} | {outcome} | {v['count'][1]} ({100 * (v['count'][1] / row['asked'] - 1):+.1f} %) | "
            f"{quality['scaled_jacobian_mean']:.3f}, {quality['scaled_jacobian_min']:.2f}, {quality['quads_sj_le_0']} "
            f"| {irregular}, {other} | {loop} | {row['seconds']:.1f} |")


def contactSheets(options, rows):
    """Pictures of all results, for people to look at."""
    meshes = [str(options.out / f"{r['name']}.obj") for r in rows if "stats" in r]
    script = pathlib.Path(__file__).with_name("contact-sheet.py")
    for k in range(0, len(meshes), 12):
        subprocess.run(["xvfb-run", "-a", "pvpython", str(script), str(options.out / f"sheet-{k // 12 + 1:02}.png")]
                       + meshes[k:k + 12], check=False)


def parseArguments():
    root = pathlib.Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser(description="Runs the command over models and judges the results.")
    parser.add_argument("--data", type=pathlib.Path, required=True, help="folder that holds the models")
    parser.add_argument("--judge", required=True, help="quadstats.py")
    parser.add_argument("--command", default=str(root / "build/bin/quadrille"))
    parser.add_argument("--out", type=pathlib.Path, default=root / "out/results")
    parser.add_argument("--markdown", type=pathlib.Path, default=root / "Documentation/Results.md")
    parser.add_argument("--models", nargs="*", help="paths below --data; default: the models of the bar")
    parser.add_argument("--folder", help="take every mesh of this folder below --data instead")
    parser.add_argument("--bad", default="bad", help="folder with damaged input below --data; empty: leave out")
    parser.add_argument("--every", action="store_true",
                        help="also all models of scan, cad, open, in a table of their own")
    parser.add_argument("--peers", type=pathlib.Path,
                        help="page with the table of what other tools reach, to compare with")
    parser.add_argument("--field", type=pathlib.Path,
                        help="what quadrille-bench --compare field wrote, to be summed up")
    parser.add_argument("--quads", type=int, nargs="*", default=COUNTS)
    parser.add_argument("--timeout", type=float, default=600, help="seconds a run")
    parser.add_argument("--samples", type=int, default=100000)
    parser.add_argument("--commit", help="that the command was built from; default: that of the checkout")
    parser.add_argument("--machine", default=made_from.machine())
    parser.add_argument("--extra", nargs="*", default=[],
                        help="further arguments of the command, without their dashes' first --")
    parser.add_argument("--fresh", action="store_true", help="repeat runs that are already there")
    parser.add_argument("--keep", action="store_true", help="do not repeat runs of an older build")
    parser.add_argument("--no-pictures", action="store_true")
    options = parser.parse_args()
    options.commit = options.commit or made_from.commit()
    return options


def meshesOf(folder, data):
    suffixes = {".ply", ".obj", ".stl", ".off", ".vtp", ".vtk"}
    return [str(p.relative_to(data)) for p in sorted((data / folder).iterdir()) if p.suffix.lower() in suffixes]


def main():
    options = parseArguments()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    options.extra = ["--" + e if not e[:1].isdigit() else e for e in options.extra]
    options.out.mkdir(parents=True, exist_ok=True)
    options.stamp = buildStamp(options.command)
    models = meshesOf(options.folder, options.data) if options.folder else options.models or MODELS
    rows = [runModel(options, m, n, reference=True) for m in models for n in options.quads]
    bad = meshesOf(options.bad, options.data) if options.bad and (options.data / options.bad).is_dir() else []
    badRows = [runModel(options, m, options.quads[0], reference=False) for m in bad]
    (options.out / "all.json").write_text(json.dumps([dict(r, verdict=verdict(r)) for r in rows] + badRows, indent=1))
    every = [runModel(options, m, n, reference=True) for folder in EVERY_FOLDER if options.every
             for m in meshesOf(folder, options.data) for n in EVERY_COUNT]
    writeMarkdown(options, rows, badRows, every)
    print(summary(rows))
    if not options.no_pictures:
        contactSheets(options, rows + badRows)


if __name__ == "__main__":
    main()
