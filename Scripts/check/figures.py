#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The stored figures of a list of models, and whether a change makes one of them worse.

  Scripts/check/figures.py record QUADRILLE [--shared FOLDER] [--all] [--only REGEX] [--jobs N] [--table FILE]
  Scripts/check/figures.py check  QUADRILLE [--shared FOLDER] [--all] [--only REGEX] [--jobs N] [--table FILE]

The table, Testing/Figures.json, has for each run (a model and a number of quads) what its quads and its map are, and no
times. record makes the runs and puts them into the table; check makes them and ends with 1 where a figure is worse than
its tolerance allows, with a line for each. Better figures are told as well, so that the table can be recorded again.
Runs: models of Data/, and where the folder is there (default: shared/data beside the checkout) those of SUBSET, or with
--all every model of scan/, cad/ and open/ at 1,000, 2,500 and 10,000 quads.

Tolerances. Results are the same bytes on one machine, so that a change which moves no figure moves none here; other
processors and libraries round otherwise, and a change may move quads without being worse. A limit is therefore what
such a move has been seen to do, not zero:
  exit code, topology, folds of the map, inverted quads, attempts: none may be worse;
  number of quads: 3 % farther from what was asked for;
  irregular vertices: 5 % and 2 more;
  mean scaled Jacobian: 0.005 less; least one: 0.1 less;
  mean distance between quads and surface: 5 % more; length of sharp edges on edges of quads: 1 % less;
  mean anisotropy of the map: 2 % more, mean shear 0.5 degrees less, distance of singularities: 20 % and 5 more;
  instructions of a run on one thread, and of its parts, counted by valgrind where that is there: 5 % more. They are
    compared where the program was made by the compiler of the table, as another one makes other instructions.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = ROOT / "Testing" / "Figures.json"
#: Of the shared models, for each change: scans, parts with creases, open ones, handles, several components.
SUBSET = (("scan/horse.ply", 2500), ("scan/igea.ply", 5000), ("scan/gargoyle_50k.ply", 2500), ("cad/fandisk.ply", 2500),
          ("cad/joint.ply", 2500), ("cad/of_flange.ply", 2500), ("cad/cgal_spool.ply", 1000),
          ("cad/tm_plate_holes.ply", 2500), ("open/of_rotating.ply", 1000), ("scan/bunny_69k.ply", 2500),
          ("open/plane_holes.ply", 2500))
OWN = (("beast.ply", 1000), ("beast.ply", 4000), ("frame.ply", 1000), ("frame.ply", 4000), ("part.ply", 1000),
       ("part.ply", 4000))
SIZES = (1000, 2500, 10000)
#: Runs whose instructions are counted, and of which functions: the decimation, the way back, the extraction.
COUNTED = (("Data/beast.ply", 4000), ("Data/part.ply", 1000))
PARTS = {"phase 1": "quadrille::decimateUniformly", "phase 2": "quadrille::Redecimation::update",
         "replay": "quadrille::transferMap", "extraction": "quadrille::extractQuads"}

#: Folders whose sharp edges are lines of the shape; those of scans are noise.
OF_PARTS = ("Data", "cad")
#: By figure: which way is worse (1: more, -1: less), what may be relative, what absolute.
LIMITS = {"code": (1, 0, 0), "topology": (1, 0, 0), "folds": (1, 0, 0), "inverted": (1, 0, 0), "attempts": (1, 0, 0),
          "count_off": (1, 0, 0.03), "irregular": (1, 0.05, 2), "mean": (-1, 0, 0.005), "least": (-1, 0, 0.1),
          "distance": (1, 0.05, 1e-6), "creases": (-1, 0, 0.01), "anisotropy": (1, 0.02, 0), "shear": (-1, 0, 0.5),
          "singularities": (1, 0.2, 5)}
INSTRUCTIONS = (1, 0.05, 0)


def worse(name, old, new):
    """How a figure compares: 1 where it is worse beyond its tolerance, -1 where it is better beyond it, else 0."""
    way, relative, absolute = INSTRUCTIONS if name.startswith("instructions") else LIMITS[name]
    if old is None or new is None:
        return 0 if old == new else 1 if new is None else -1
    change = float(way * (new - old))
    allowed = float(relative * abs(old) + absolute) + 1e-12
    return int(change > allowed) - int(-change > allowed)


def one(program, path, quads):
    """The figures of a run."""
    from quadrille.evaluation import meshes

    with tempfile.TemporaryDirectory() as folder:
        report, output = os.path.join(folder, "report.json"), os.path.join(folder, "quads.obj")
        done = subprocess.run([program, str(path), output, "--quads", str(quads), "--report", report, "--quiet",
                               "--threads", "1"], capture_output=True, text=True, check=False)
        figures = {"code": done.returncode}
        if done.returncode != 0:
            return figures
        with open(report, encoding="utf-8") as file:
            told = json.load(file)
        quality, certificate = told["quality"], told["certificate"]
        measured = meshes.measure(meshes.read(output), meshes.read(str(path)))
        figures.update(
            attempts=told["attempts"], count_off=round(abs(told["quads_actual"] / quads - 1), 4),
            irregular=quality["irregular_vertices"], mean=round(quality["mean_scaled_jacobian"], 5),
            least=round(quality["minimum_scaled_jacobian"], 4), inverted=quality["quads_not_positive"],
            folds=certificate["not_positive"] + certificate["wrong_turns"],
            topology=int(not quality["manifold"]) + measured["other_faces"],
            distance=round(measured["distance_mean"], 5))
        if path.parent.name in OF_PARTS and "feature_share" in measured:
            figures["creases"] = round(measured["feature_share"], 4)
        return figures


def maps(path, quads):
    """Distortion and singularities of the coarse map against those of the intermediate level."""
    import quadrille
    from quadrille.evaluation import study

    result = study.study(quadrille.read(str(path)), "model", quads, budgets=(), threads=1, tell=lambda text: None,
                         costs=study.COSTS[1:2], largest=0)
    outcome = result.outcomes[1]
    return {"anisotropy": round(outcome.means["Anisotropy"], 4), "shear": round(outcome.means["Shear"], 3),
            "singularities": round(outcome.distance["Irregular vertices"], 2)}


def compiler_of(program):
    """Name and major version of the compiler that made a program, by what it has left in it, as "GCC 12"."""
    text = subprocess.run(["readelf", "--string-dump=.comment", program], capture_output=True, text=True,
                          check=False).stdout
    match = re.search(r"(GCC|clang).* (\d+)\.\d+\.\d+", text)
    return f"{match[1]} {match[2]}" if match else "unknown"


def instructions(program, path, quads):
    """Instructions of a run and of its parts in millions; nothing without valgrind."""
    if not shutil.which("valgrind") or not shutil.which("callgrind_annotate"):
        print("figures: valgrind is not there, so that instructions are not counted", file=sys.stderr)
        return {}
    with tempfile.TemporaryDirectory() as folder:
        counts = os.path.join(folder, "counts")
        done = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={counts}", program, str(path),
                               os.path.join(folder, "quads.obj"), "--quads", str(quads), "--threads", "1", "--quiet"],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(f"figures: valgrind ended with {done.returncode}: {done.stderr[-300:]}")
        listing = subprocess.run(["callgrind_annotate", "--inclusive=yes", "--threshold=100", counts],
                                 capture_output=True, text=True, check=True).stdout
    result = {"compiler": compiler_of(program)}
    for line in listing.splitlines():
        match = re.match(r"\s*([\d,]+) (?:\([ \d.]+%\))?\s+(.*)", line)
        if not match:
            continue
        count = round(int(match[1].replace(",", "")) / 1e6, 1)
        if "PROGRAM TOTALS" in match[2]:
            result["instructions"] = count
        for part, function in PARTS.items():
            if function + "(" in match[2]:
                result.setdefault(f"instructions {part}", count)
    return result


def runs(arguments):
    chosen = [(f"Data/{name}", ROOT / "Data" / name, quads) for name, quads in OWN]
    if arguments.shared.is_dir():
        listed = SUBSET if not arguments.all else [
            (f"{path.parent.name}/{path.name}", quads) for kind in ("scan", "cad", "open")
            for path in sorted((arguments.shared / kind).glob("*.ply")) for quads in SIZES]
        chosen += [(name, arguments.shared / name, quads) for name, quads in listed
                   if (arguments.shared / name).is_file()]
    else:
        print(f"figures: there is no {arguments.shared}: only the models of Data/ are looked at", file=sys.stderr)
    return [(name, path, quads) for name, path, quads in chosen if re.search(arguments.only, name)]


def measure(arguments, name, path, quads):
    figures = one(arguments.program, path, quads)
    if figures["code"] == 0 and name.startswith("Data/"):
        figures.update(maps(path, quads))
    if (name, quads) in COUNTED:
        figures.update(instructions(arguments.program, path, quads))
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("record", "check"))
    parser.add_argument("program")
    parser.add_argument("--shared", type=pathlib.Path, default=ROOT.parent / "shared" / "data")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--table", type=pathlib.Path, default=TABLE)
    arguments = parser.parse_args()
    known = json.loads(arguments.table.read_text(encoding="utf-8")) if arguments.table.exists() else {}
    chosen = runs(arguments)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        made = list(pool.map(lambda run: measure(arguments, *run), chosen))
    found = {f"{name} {quads}": figures for (name, _, quads), figures in zip(chosen, made)}
    if arguments.what == "record":
        known.update(found)
        text = ",\n".join(f"{json.dumps(key)}: {json.dumps(known[key])}" for key in sorted(known))
        arguments.table.write_text("{\n" + text + "\n}\n", encoding="utf-8")
        print(f"figures: {len(found)} runs recorded")
        return 0
    faults = 0
    for key, figures in found.items():
        if key not in known:
            print(f"{key}: not in the table; record it")
            faults += 1
            continue
        compilers = {known[key].get("compiler"), figures.get("compiler")} - {None}
        if len(compilers) == 2:
            print(f"{key}: instructions are not compared, as the compilers are {' and '.join(sorted(compilers))}")
        for name in sorted((set(known[key]) | set(figures)) - {"compiler"}):
            if name.startswith("instructions") and (name not in figures or len(compilers) == 2):
                continue
            old, new = known[key].get(name), figures.get(name)
            how = worse(name, old, new)
            faults += how > 0
            if how:
                print(f"{key}: {name} {old} -> {new}, {'WORSE' if how > 0 else 'better'}")
    print(f"figures: {len(found)} runs, {faults} figures are worse")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
