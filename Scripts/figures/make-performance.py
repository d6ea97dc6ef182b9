#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Measures the stages with quadrille-bench and writes the tables of Documentation/Performance.md.

  Scripts/figures/make-performance.py [--data FOLDER] [--command build/bin/quadrille-bench] [--out out/performance]
                                      [--repeat 5]

Meshes: the shape `beast` of Data/generate.py at 125 k, 500 k, 2 M and 8 M faces, the one of 2 M with its faces and
points shuffled, and, where --data has scan/bunny_ct.ply, that scan, the same shuffled, and the same with each face cut
into four and its points moved at random by up to a tenth of their shortest edge. Runs of all meshes and thread counts
alternate, so that a busy machine disturbs all alike; a figure is the median of the repeats. The tables replace what
stands between the two marks in the page; what is around them is written by hand. --replay writes the table of the
replay over all scans of --data instead, --coarse that of the coarse level over all of its scan, cad and open,
--extraction that of the extraction from DATA/scan/bunny_ct.ply, --sizes that of whole runs of the command over four
sizes of that scan, from file to file. Needs Debian's python3 with numpy; --sizes also the Python module quadrille.
"""
import argparse
import csv
import io
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import made_from

ROOT = made_from.ROOT
# Names of the marks round generated parts of the page.
TABLES, REPLAY, COARSE, EXTRACTION, ANY_SIZE = "tables", "replay", "coarse", "extraction", "sizes"
REPLAY_QUADS = [1000, 2500, 10000]
COARSE_QUADS = 2500
COARSE_LIMIT = 1200 # vertices; levels that features or handles hold above are not what the aims are about
SIZES = {"beast_125k": 125000, "beast_500k": 500000, "beast_2M": 2000000, "beast_8M": 8000000}
STAGES = ["order", "connectivity", "repair", "refine", "phase1", "phase2", "field", "seamless", "quantize", "embed",
          "replay",
          "certify", "extract", "total", "cancel"]
FACE_TYPE = np.dtype([("count", "u1"), ("corners", "<i4", 3)])


# --------------------------------------------------------------------------------------------- meshes
def readPly(path):
    """Binary little-endian PLY with float points and triangles, as all meshes here are."""
    with open(path, "rb") as file:
        header = []
        while not header or header[-1] != "end_header":
            header.append(file.readline().decode("ascii").strip())
        body = file.read()
    if "format binary_little_endian 1.0" not in header:
        raise SystemExit(f"{path}: only binary little-endian PLY can be changed by this script")
    count = {line.split()[1]: int(line.split()[2]) for line in header if line.startswith("element")}
    names, element = {"vertex": [], "face": []}, None
    for line in header:
        words = line.split()
        if words[0] == "element":
            element = words[1]
        elif words[0] == "property":
            names[element].append(words[1:])
    kinds = {"float": "<f4", "double": "<f8", "uchar": "u1", "int": "<i4"}
    pointType = np.dtype([(words[1], kinds[words[0]]) for words in names["vertex"]])
    points = np.frombuffer(body, pointType, count["vertex"])
    faces = np.frombuffer(body, FACE_TYPE, count["face"], count["vertex"] * pointType.itemsize)
    if len(names["face"]) != 1 or (faces["count"] != 3).any():
        raise SystemExit(f"{path}: only triangles without properties can be changed by this script")
    return np.stack([points["x"], points["y"], points["z"]], 1).astype(np.float64), faces["corners"].astype(np.int64)


def writePly(path, points, faces):
    table = np.empty(len(faces), FACE_TYPE)
    table["count"], table["corners"] = 3, faces
    with open(path, "wb") as file:
        file.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\n"
                    f"property float y\nproperty float z\nelement face {len(faces)}\n"
                    "property list uchar int vertex_indices\nend_header\n").encode("ascii"))
        file.write(points.astype("<f4").tobytes())
        file.write(table.tobytes())


def shuffled(points, faces):
    random = np.random.default_rng(1)
    order = random.permutation(len(points))
    place = np.empty_like(order)
    place[order] = np.arange(len(points))
    return points[order], place[faces][random.permutation(len(faces))]


def cutInFour(points, faces):
    """Every face into four by the middles of its edges."""
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    keys, inverse = np.unique(edges[:, 0] * len(points) + edges[:, 1], return_inverse=True)
    first, second = keys // len(points), keys % len(points)
    ab, bc, ca = len(points) + inverse.reshape(3, -1)
    a, b, c = faces.T
    finer = np.concatenate([np.stack(f, 1) for f in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return np.concatenate([points, 0.5 * (points[first] + points[second])]), finer


def subdivided(points, faces):
    """Every face into four, every point moved at random by up to a tenth of its shortest edge."""
    every, finer = cutInFour(points, faces)
    reach = np.full(len(every), np.inf)
    for i, j in ((0, 1), (1, 2), (2, 0)):
        length = np.linalg.norm(every[finer[:, i]] - every[finer[:, j]], axis=1)
        np.minimum.at(reach, finer[:, i], length)
        np.minimum.at(reach, finer[:, j], length)
    return every + np.random.default_rng(2).uniform(-0.06, 0.06, every.shape) * reach[:, None], finer


def makeMeshes(folder, data):
    folder.mkdir(parents=True, exist_ok=True)
    meshes = {}

    def make(name, build):
        path = folder / f"{name}.ply"
        if not path.exists():
            print(f"making {path}", flush=True)
            writePly(path, *build())
        meshes[name] = path

    for name, size in SIZES.items():
        path = folder / f"{name}.ply"
        if not path.exists():
            subprocess.run([sys.executable, ROOT / "Data/generate.py", "beast", str(size), path], check=True)
        meshes[name] = path
    make("beast_2M_shuffled", lambda: shuffled(*readPly(meshes["beast_2M"])))
    scan = pathlib.Path(data or "") / "scan" / "bunny_ct.ply"
    if data and scan.exists():
        meshes["bunny_ct"] = scan
        make("bunny_ct_shuffled", lambda: shuffled(*readPly(scan)))
        make("bunny_ct_8M", lambda: subdivided(*readPly(scan)))
    return meshes


# ----------------------------------------------------------------------------------------------- runs
def measure(command, meshes, threads, repeat, largeRepeat, quads):
    """{(mesh, threads): {stage: [seconds]}} and, beside the stages, faces and peak memory; {mesh: why it failed}."""
    results, failures = {}, {}
    for turn in range(repeat):
        for name, path in meshes.items():
            if turn >= largeRepeat and name.endswith("8M"):
                continue
            for count in threads:
                print(f"run {turn + 1} of {repeat}: {name}, {count} threads", flush=True)
                run = subprocess.run([command, path, "--quads", str(quads), "--threads", str(count)],
                                     capture_output=True, text=True)
                if run.returncode != 0:
                    failures[name] = run.stderr.strip()
                    continue
                into = results.setdefault((name, count), {})
                for row in csv.DictReader(io.StringIO(run.stdout)):
                    into.setdefault(row["stage"], []).append(float(row["seconds"]))
                    into["megabytes"] = float(row["peak_rss_mb"])
                    if row["stage"] == "attempts":
                        into["decimations"], into["replays"] = int(row["elements_in"]), int(row["elements_out"])
                    if row["stage"] == "phase1":
                        into["mapped"], into["intermediate"] = int(row["elements_in"]), int(row["elements_out"])
                    if row["stage"] == "read":
                        into["faces"] = int(row["elements_in"])
    return {key: run for key, run in results.items() if key[0] not in failures}, failures


def table(results, count):
    names = [name for name, threads in results if threads == count]
    lines = ["| stage | " + " | ".join(names) + " |", "|---|" + "---:|" * len(names)]

    def line(title, value):
        lines.append(f"| {title} | " + " | ".join(value(results[name, count]) for name in names) + " |")

    line("faces", lambda run: f"{run['faces']:,}")
    line("mapped faces", lambda run: f"{run['mapped']:,}")
    line("intermediate faces", lambda run: f"{run['intermediate']:,}")
    for stage in STAGES:
        line(stage, lambda run: f"{statistics.median(run[stage]):.3f}")
    line("runs of phase1", lambda run: str(run["decimations"]))
    line("runs of replay", lambda run: str(run["replays"]))
    line("peak bytes a face", lambda run: f"{run['megabytes'] * 1048576 / run['faces']:.0f}")
    line("one phase1, ns a mapped face",
         lambda run: f"{statistics.median(run['phase1']) / run['decimations'] / run['mapped'] * 1e9:.0f}")
    line("one replay, ns a mapped face",
         lambda run: f"{statistics.median(run['replay']) / run['replays'] / run['mapped'] * 1e9:.0f}")
    line("total, ns a face", lambda run: f"{statistics.median(run['total']) / run['faces'] * 1e9:.0f}")
    return "\n".join(lines)


def replayRows(command, scans, threads):
    """What the replay did to the triangles of every scan; a row for each number of quads and model."""
    rows = []
    for quads in REPLAY_QUADS:
        print(f"replay: {len(scans)} models, {quads} quads", flush=True)
        run = subprocess.run([command, *scans, "--compare", "replay", "--quads", str(quads), "--threads", str(threads)],
                             capture_output=True, text=True)
        if run.returncode != 0:
            raise SystemExit(run.stderr.strip())
        rows += [{"mesh": row["mesh"], **{key: int(value) for key, value in row.items() if key != "mesh"}}
                 for row in csv.DictReader(io.StringIO(run.stdout))]
    return rows


def replayTable(rows):
    """Counts per 100,000 triangles, and what is left as it is; models without a coarse map are named."""
    lines = ["| quads | model | triangles | inverted stars | into the kernel | no kernel | inverted after it | "
             "mended patches | left |",
             "|---:|---|---:|---:|---:|---:|---:|---:|---:|"]
    replayed = [row for row in rows if row["coarse_not_positive"] == 0 and hasReplay(row)]

    def line(title, some):
        faces = sum(row["faces"] for row in some)
        each = [sum(row[key] for row in some) / faces * 1e5
                for key in ("inverted_stars", "moved_to_kernel", "without_kernel", "replay_not_positive",
                            "mended_patches")]
        left = sum(row["not_positive"] for row in some)
        lines.append(f"| {title} | {faces:,} | " + " | ".join(f"{value:.2f}" for value in each) + f" | {left} |")

    for row in replayed:
        line(f"{row['quads']:,} | {row['mesh']}", [row])
    for quads in REPLAY_QUADS:
        line(f"{quads:,} | **all**", [row for row in replayed if row["quads"] == quads])
    absent = [f"{row['mesh']} at {row['quads']:,}" for row in rows if row not in replayed]
    return "\n".join(lines) + (f"\n\nWithout a coarse map: {', '.join(absent)}." if absent else "")


def coarseRows(command, models, repeat):
    """Processor seconds of field and map on the coarse level of every model, cold and after edits."""
    rows = []
    for path in models:
        print(f"coarse level: {path.stem}", flush=True)
        run = subprocess.run([command, path, "--compare", "coarse", "--quads", str(COARSE_QUADS),
                              "--repeat", str(repeat)],
                             capture_output=True, text=True)
        if run.returncode != 0:
            raise SystemExit(run.stderr.strip())
        rows += [row for row in csv.DictReader(io.StringIO(run.stdout)) if row["clock"] == "processor"]
    return rows


def coarseTable(rows):
    """Medians over the models, the largest in brackets, in milliseconds."""
    lines = ["| edit | start | maps | field | seamless | quantize | seamless and quantize | embed | Newton steps | "
             "took over integers |",
             "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|"]
    fitting = [row for row in rows if int(row["vertices"]) <= COARSE_LIMIT]
    for edit, start in dict.fromkeys((row["edit"], row["start"]) for row in fitting):
        some = [row for row in fitting if (row["edit"], row["start"]) == (edit, start) and row["ok"] == "1"]

        def cell(*stages):
            values = [1e3 * sum(float(row[stage]) for stage in stages) for row in some]
            return f"{statistics.median(values):.1f} ({max(values):.0f})"

        steps = [int(row["seamless_steps"]) + int(row["embed_steps"]) for row in some]
        kept = sum(int(row["integers_reused"]) > 0 for row in some)
        lines.append(f"| {edit} | {start} | {len(some)} | {cell('field')} | {cell('seamless')} | {cell('quantize')} | "
                     f"{cell('seamless', 'quantize')} | {cell('embed')} | {statistics.median(steps):.0f} "
                     f"({max(steps)}) | {kept} |")
    first = [row for row in rows if row["edit"] == "none"]
    large = [row["mesh"] for row in first if row not in fitting]
    failed = [row["mesh"] for row in first if row in fitting and row["ok"] != "1"]
    return "\n".join(lines) + (f"\n\nMore than {COARSE_LIMIT:,} vertices: {', '.join(large)}." if large else "") + (
        f" Without a map at the first attempt: {', '.join(failed)}." if failed else "")


def extractionRows(command, scan, repeat, quads):
    """Seconds of the extraction from the map of a scan and from that map with each triangle cut into four, by (faces,
    quads, path, threads, clock)."""
    seconds = {}
    for subdivide in (0, 1):
        print(f"extraction: {scan.stem}, cut {subdivide} times", flush=True)
        run = subprocess.run([command, scan, "--compare", "extraction", "--quads", str(quads), "--threads", "2",
                              "--subdivide", str(subdivide),
                              "--repeat", str(repeat)], capture_output=True, text=True)
        if run.returncode != 0:
            raise SystemExit(run.stderr.strip() or "the ways to extract do not agree:\n" + run.stdout)
        for row in csv.DictReader(io.StringIO(run.stdout)):
            seconds[int(row["faces"]), int(row["quads"]), row["path"], int(row["threads"]),
                    row["clock"]] = float(row["seconds"])
    return seconds


def extractionTable(seconds):
    """One line for each size and path; the scaling is the ratio on the wall."""
    lines = ["| triangles | quads | path | one thread: processor | wall | two threads: processor | wall | scaling | "
             "ns a triangle, one thread |",
             "|---:|---:|---|---:|---:|---:|---:|---:|---:|"]
    for faces, quads, path in dict.fromkeys(key[:3] for key in seconds):
        one, two = ({clock: seconds[faces, quads, path, threads, clock] for clock in ("processor", "wall")}
                    for threads in (1, 2))
        lines.append(f"| {faces:,} | {quads:,} | {path} | {one['processor']:.3f} | {one['wall']:.3f} | "
                     f"{two['processor']:.3f} | {two['wall']:.3f} | {one['wall'] / two['wall']:.2f} | "
                     f"{one['processor'] / faces * 1e9:.0f} |")
    return "\n".join(lines)


# Faces of the scan's versions that are coarser than it is.
COARSER = {"125 k": 125000, "500 k": 500000}
# The rows of the table over sizes: a name and the stages whose seconds it adds up; the rest of the run is "other".
PARTS = [("read", ["read"]), ("repair", ["repair"]), ("order", ["order"]), ("connectivity", ["connectivity"]),
         ("refine", ["refine"]), ("phase 1", ["phase1"]), ("handles", ["handles", "simplify"]), ("phase 2", ["phase2"]),
         ("field and map", ["field", "seamless", "quantize", "embed"]), ("replay", ["replay"]),
         ("certify", ["certify"]), ("extract", ["extract"])]


def coarser(scan, faces):
    """The scan thinned out by our own decimation to about so many faces, which leaves it a manifold."""
    import quadrille
    from vtkmodules.util.numpy_support import vtk_to_numpy

    levels = quadrille.vtkDecimationHierarchy()
    levels.SetInputData(quadrille.read(str(scan)))
    quads = faces / 2.8 # phase 1 leaves 1.4 vertices a quad
    for _ in range(3):
        levels.SetNumberOfQuads(round(quads))
        levels.SetTargetTypeToNumberOfQuads()
        levels.Update()
        level = levels.GetOutput(1)
        quads *= faces / level.GetNumberOfPolys()
    return (vtk_to_numpy(level.GetPoints().GetData()),
            vtk_to_numpy(level.GetPolys().GetConnectivityArray()).reshape(-1, 3))


def makeSizes(folder, scan):
    folder.mkdir(parents=True, exist_ok=True)
    meshes = {}
    for name, faces in COARSER.items():
        meshes[name] = folder / f"bunny_ct_{name.replace(' ', '')}.ply"
        if not meshes[name].exists():
            print(f"making {meshes[name]}", flush=True)
            writePly(meshes[name], *coarser(scan, faces))
    meshes["2 M"] = scan
    meshes["8 M"] = folder / "bunny_ct_in_four.ply"
    if not meshes["8 M"].exists():
        print(f"making {meshes['8 M']}", flush=True)
        writePly(meshes["8 M"], *cutInFour(*readPly(scan)))
    return meshes


def wholeRuns(program, meshes, threads, repeat, quads):
    """{(mesh, threads): figures of each run}: seconds of the stages and of the process, faces, peak memory."""
    results = {}
    with tempfile.TemporaryDirectory() as folder:
        report, output = os.path.join(folder, "report.json"), os.path.join(folder, "quads.vtp")
        for turn in range(repeat):
            for name, path in meshes.items():
                for count in threads:
                    print(f"run {turn + 1} of {repeat}: {name}, {count} threads", flush=True)
                    start = time.perf_counter()
                    run = subprocess.Popen([program, path, output, "--quads", str(quads), "--threads", str(count),
                                            "--pieces", "never", "--report", report, "--quiet"])
                    _, status, usage = os.wait4(run.pid, 0)
                    seconds = time.perf_counter() - start
                    if status != 0:
                        raise SystemExit(f"{path} gave no quads")
                    with open(report, encoding="utf-8") as file:
                        told = json.load(file)
                    stages = {}
                    for row in told["stages"]:
                        stages[row["stage"]] = stages.get(row["stage"], 0) + row["seconds"]
                    figures = {part: sum(stages.get(stage, 0) for stage in of) for part, of in PARTS}
                    figures["other"] = seconds - sum(figures.values())
                    figures.update(whole=seconds, processor=usage.ru_utime + usage.ru_stime,
                                   faces=told["input_cells"], memory=usage.ru_maxrss * 1024)
                    results.setdefault((name, count), []).append(figures)
    return results


def sizesTable(results, threads):
    names = [name for name, count in results if count == threads]
    lines = ["| stage | " + " | ".join(names) + " |", "|---|" + "---:|" * len(names)]

    def middle(name, figure):
        return statistics.median(run[figure] for run in results[name, threads])

    def line(title, value):
        lines.append(f"| {title} | " + " | ".join(value(name) for name in names) + " |")

    line("faces", lambda name: f"{int(middle(name, 'faces')):,}")
    for part in [part for part, _ in PARTS] + ["other"]:
        line(part, lambda name: f"{middle(name, part):.3f}")
    line("**whole run**", lambda name: f"{middle(name, 'whole'):.2f}")
    line("processor", lambda name: f"{middle(name, 'processor'):.2f}")
    line("whole run over phase 1", lambda name: "{:.2f}".format(
        statistics.median(run["whole"] / run["phase 1"] for run in results[name, threads])))
    line("whole run, ns a face", lambda name: f"{middle(name, 'whole') / middle(name, 'faces') * 1e9:.0f}")
    line("processor, ns a face", lambda name: f"{middle(name, 'processor') / middle(name, 'faces') * 1e9:.0f}")
    line("peak memory, bytes a face", lambda name: f"{middle(name, 'memory') / middle(name, 'faces'):.0f}")
    return "\n".join(lines)


def hasReplay(row):
    """A model whose map never got to the surface has no counts at all."""
    return row["ok"] == 1 or row["inverted_stars"] > 0


def writePart(page, name, text, commit):
    """commit: that of before the measurement."""
    begin, end = f"<!-- {name}: begin -->", f"<!-- {name}: end -->"
    before, _, rest = page.read_text().partition(begin)
    _, found, after = rest.partition(end)
    if not found:
        raise SystemExit(f"{page} has no marks for the part {name}")
    made = made_from.madeFrom(commit, made_from.machine())
    page.write_text(f"{before}{begin}\n\n{made}\n\n{text}\n\n{end}{after}")


def main():
    parser = argparse.ArgumentParser(description="Measures the stages; see the top of this file.")
    parser.add_argument("--data", help="folder of models with scan/bunny_ct.ply")
    parser.add_argument("--command", default=str(ROOT / "build/bin/quadrille-bench"))
    parser.add_argument("--out", default=str(ROOT / "out/performance"), help="folder for the meshes")
    parser.add_argument("--markdown", default=str(ROOT / "Documentation/Performance.md"))
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--large-repeat", type=int, default=3, help="the same for the meshes of 8 M faces")
    parser.add_argument("--quads", type=int, default=10000)
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--meshes", nargs="+", help="only these")
    parser.add_argument("--replay", action="store_true", help="only the table of the replay over DATA/scan")
    parser.add_argument("--coarse", action="store_true",
                        help="only the table of the coarse level over DATA/scan, cad and open")
    parser.add_argument("--extraction", action="store_true",
                        help="only the table of the extraction from DATA/scan/bunny_ct.ply")
    parser.add_argument("--sizes", action="store_true",
                        help="only the table of whole runs over sizes of DATA/scan/bunny_ct.ply, by the command "
                             "quadrille beside quadrille-bench")
    arguments = parser.parse_args()
    page = pathlib.Path(arguments.markdown)
    commit = made_from.commit()
    if arguments.coarse:
        models = [path for folder in ("scan", "cad", "open")
                  for path in sorted((pathlib.Path(arguments.data or "") / folder).glob("*.ply"))]
        if not arguments.data or not models:
            raise SystemExit("--coarse needs --data with folders scan, cad and open of PLY files")
        writePart(page, COARSE, coarseTable(coarseRows(arguments.command, models, arguments.repeat)), commit)
        return 0
    if arguments.extraction:
        scan = pathlib.Path(arguments.data or "") / "scan" / "bunny_ct.ply"
        if not arguments.data or not scan.exists():
            raise SystemExit("--extraction needs --data with scan/bunny_ct.ply")
        writePart(page, EXTRACTION, extractionTable(extractionRows(arguments.command, scan, arguments.repeat,
                                                                   arguments.quads)), commit)
        return 0
    if arguments.sizes:
        scan = pathlib.Path(arguments.data or "") / "scan" / "bunny_ct.ply"
        if not arguments.data or not scan.exists():
            raise SystemExit("--sizes needs --data with scan/bunny_ct.ply")
        program = pathlib.Path(arguments.command).with_name("quadrille")
        results = wholeRuns(program, makeSizes(pathlib.Path(arguments.out), scan), arguments.threads, arguments.repeat,
                            arguments.quads)
        runs = f"medians of {arguments.repeat}" if arguments.repeat > 1 else "one run each"
        writePart(page, ANY_SIZE, "\n\n".join(
            f"Seconds with {count} thread{'s' if count > 1 else ''}, {runs}:\n\n"
            f"{sizesTable(results, count)}" for count in arguments.threads), commit)
        return 0
    if arguments.replay:
        scans = sorted((pathlib.Path(arguments.data or "") / "scan").glob("*.ply"))
        if not arguments.data or not scans:
            raise SystemExit("--replay needs --data with a folder scan of PLY files")
        writePart(page, REPLAY, replayTable(replayRows(arguments.command, scans, max(arguments.threads))), commit)
        return 0
    meshes = makeMeshes(pathlib.Path(arguments.out), arguments.data)
    if arguments.meshes:
        meshes = {name: path for name, path in meshes.items() if name in arguments.meshes}
    results, failures = measure(arguments.command, meshes, arguments.threads, arguments.repeat, arguments.large_repeat,
                                arguments.quads)
    text = "\n\n".join(f"Seconds with {count} thread{'s' if count > 1 else ''}, {arguments.quads:,} quads asked for, "
                       f"medians of {arguments.repeat} ({arguments.large_repeat} at 8 M):\n\n{table(results, count)}"
                       for count in arguments.threads)
    for name, reason in failures.items():
        reason = reason[:200].replace(str(ROOT), "")
        text += "\n\n" + made_from.filled(f"{name} gave no quads and is left out: {reason}")
    writePart(page, TABLES, text, commit)
    return 0


if __name__ == "__main__":
    sys.exit(main())
