#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The ledger of tries (Core/Base/TryCount.h) over many runs: how often each was taken, and how often it led to one.

  Scripts/study/tries_table.py --command BIN/quadrille [--gate GATE.json] [--folder NAME=FOLDER@QUADS,QUADS ...]
                               [--table FILE.md] [--record FILE.json] [--limit SECONDS]

GATE.json is a record of Scripts/check/gate.py. Of each FOLDER all surfaces are remeshed with each number of quads, and
their reports read. --record keeps what was read, and takes from there what an earlier call with the same file has made.
The table has a column for each folder, `taken / led`; the rows are those of the source of this checkout.
"""
import argparse
import collections
import json
import pathlib
import re
import subprocess
import tempfile

SURFACES = (".ply", ".obj", ".stl", ".off", ".vtp")
ROW = re.compile(r'\{ "([^"]*)",\s*"([^"]*)",\s*"([^"]*)",\s*"([^"]*)" \}')


def rows():
    """Room, name, what it changes, bound."""
    source = pathlib.Path(__file__).resolve().parents[2] / "Core" / "Base" / "TryCount.cpp"
    return ROW.findall(source.read_text())


def added(total, tries):
    for name, counts in tries.items():
        taken, led = (counts["taken"], counts["led"]) if isinstance(counts, dict) else counts
        total[name][0] += taken
        total[name][1] += led


def tries_of_gate(path):
    total = collections.defaultdict(lambda: [0, 0])
    for run in json.loads(path.read_text()).values():
        for step in run["steps"].values():
            added(total, step.get("tries", {}))
    return total


def tries_of_model(command, model, quads, limit):
    """Of its report; what is wrong instead, where there are no quads."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        try:
            result = subprocess.run([command, str(model), f"{folder}/quads.vtp", "--quads", str(quads), "--report",
                                     str(report)], capture_output=True, text=True, timeout=limit)
        except subprocess.TimeoutExpired:
            return {"failed": f"more than {limit} s"}
        if result.returncode != 0 or not report.exists():
            return {"failed": (result.stderr.strip().splitlines() or ["?"])[-1]}
        return {"tries": json.loads(report.read_text())["tries"]}


def tries_of_folder(arguments, folder, numbers, record):
    total = collections.defaultdict(lambda: [0, 0])
    for model in sorted(path for path in folder.rglob("*") if path.suffix.lower() in SURFACES):
        for quads in numbers:
            key = f"{model} {quads}"
            if key not in record:
                record[key] = tries_of_model(arguments.command, model, quads, arguments.limit)
                print(f"{key}: {record[key].get('failed', 'quads')}", flush=True)
                if arguments.record:
                    arguments.record.write_text(json.dumps(record, indent=1))
            added(total, record[key].get("tries", {}))
    return total


def table(columns):
    """Markdown. columns: name -> counts by row."""
    lines = ["| room | what is tried | what it changes | at most |" + "".join(f" {name} |" for name in columns),
             "|---|---|---|---|" + "---:|" * len(columns)]
    for room, name, changes, bound in rows():
        cells = [counts.get(f"{room}: {name}", (0, 0)) for counts in columns.values()]
        texts = [f"{taken} / {led}" if taken else "" for taken, led in cells]
        lines.append(f"| {room} | {name} | {changes} | {bound} |" + "".join(f" {text} |" for text in texts))
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", required=True)
    parser.add_argument("--gate", type=pathlib.Path)
    parser.add_argument("--folder", action="append", default=[])
    parser.add_argument("--table", type=pathlib.Path)
    parser.add_argument("--record", type=pathlib.Path)
    parser.add_argument("--limit", type=float, default=300)
    arguments = parser.parse_args()
    columns = {"gate": tries_of_gate(arguments.gate)} if arguments.gate else {}
    record = json.loads(arguments.record.read_text()) if arguments.record and arguments.record.exists() else {}
    for text in arguments.folder:
        name, folder, numbers = re.fullmatch(r"(.+?)=(.+)@([\d,]+)", text).groups()
        columns[name] = tries_of_folder(arguments, pathlib.Path(folder), [int(n) for n in numbers.split(",")], record)
    text = table(columns)
    print(text, end="")
    if arguments.table:
        arguments.table.write_text(text)


if __name__ == "__main__":
    main()
