#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What solving the map again on a finer level brings, as a table in Markdown.

  Scripts/study/measure-final-quality.py --program build/bin/quadrille MESH... [--quads N]... [--threads N]
                                         [-- more options]

Each mesh is remeshed three times. Distortion is that of the map on the input: the mean over the area of the symmetric
Dirichlet energy over 4 (1 where the map is an isometry), the value that 99 hundredths of the area lie below, and the
mean of (a/b + b/a) / 2 with the singular values a, b. Of the quads: mean and least scaled Jacobian, deviation of the
edge length over its mean. Seconds are processor time: of the whole run for the coarse map, beyond it for the others, so
that a busy machine does not count.
"""
import argparse
import json
import pathlib
import resource
import subprocess
import tempfile

LEVELS = ("coarse", "intermediate", "input")


def run(program, mesh, quads, level, threads, more):
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        subprocess.run([program, mesh, str(pathlib.Path(folder) / "quads.obj"), "--quads", str(quads),
                        "--final-quality", level, "--threads", str(threads), "--report", str(report)] + more,
                       capture_output=True, check=False)
        content = json.loads(report.read_text())
        content["user_seconds"] = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        return content


def connectivity(report):
    return report["quads_actual"], report["sizes"]["quad_points"], report["quality"]["interior_valences"]


def row(report, level, distortion, seconds):
    quality = report["quality"]
    map_values = [f"{distortion[key]:.4f}" for key in ("mean", "p99", "angle")]
    return [level, *map_values, f"{quality['mean_scaled_jacobian']:.4f}", f"{quality['minimum_scaled_jacobian']:.3f}",
            f"{quality['edge_length_deviation'] / quality['mean_edge_length']:.4f}", f"{seconds:.1f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--program", default="build/bin/quadrille")
    parser.add_argument("--quads", type=int, action="append")
    parser.add_argument("--threads", type=int, default=1)
    arguments, more = parser.parse_known_args()
    more = [word for word in more if word != "--"]
    print("| mesh | faces | quads | level | distortion | 99 % below | angles | scaled Jacobian | least | edge lengths "
          "| user s |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for mesh in arguments.meshes:
        for quads in arguments.quads or [5000]:
            name = pathlib.Path(mesh).stem
            reports = [run(arguments.program, mesh, quads, level, arguments.threads, more) for level in LEVELS]
            failed = [report for report in reports if report["exit_code"] != 0]
            if failed:
                print(f"| {name} | | {quads} | {failed[0]['error'][:60]} | | | | | | | |", flush=True)
                continue
            first = [name, int(reports[0]["sizes"]["surface_faces"]), reports[0]["quads_actual"]]
            for level, report in zip(LEVELS, reports):
                distortion = reports[2]["distortion_before"] if level == "coarse" else report["distortion_after"]
                cells = row(report, level, distortion,
                            report["user_seconds"] - (reports[0]["user_seconds"] if level != "coarse" else 0))
                if connectivity(report) != connectivity(reports[0]):
                    cells[0] += " (OTHER CONNECTIVITY)"
                if any("final quality" in notice for notice in report["notices"]):
                    cells[0] += " (kept)"
                print("| " + " | ".join(str(cell) for cell in [*first, *cells]) + " |", flush=True)
                first = ["", "", ""]


if __name__ == "__main__":
    main()
