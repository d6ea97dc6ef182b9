# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What figures of the documents were made from: the commit and the machine. Testing/Repository/check_results.py reads
the line."""
import os
import pathlib
import subprocess
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[2]
COLUMNS = 120
BUILT = ("Core", "Filters", "Native", "Programs")


def git(*arguments):
    return subprocess.run(["git", "-C", str(ROOT), *arguments], check=True, capture_output=True, text=True).stdout


def commit():
    """That of the checkout, and whether sources differ from it. Raises outside of a checkout."""
    changed = git("status", "--porcelain", "--", *BUILT).strip()
    return git("rev-parse", "--short=10", "HEAD").strip() + (" with changes" if changed else "")


def machine():
    """Cores that this process may use, the model of the processor, and memory."""
    cores = len(os.sched_getaffinity(0))
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        model = next((line.split(":", 1)[1].strip() for line in file if line.startswith("model name")),
                     "unknown processor")
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2 ** 30
    return f"{cores} core{'s' if cores > 1 else ''} of {model}, {memory:.0f} GiB"


def filled(text):
    """A paragraph of a document."""
    return textwrap.fill(text, COLUMNS, break_on_hyphens=False, break_long_words=False)


def madeFrom(commitText, machineText):
    return filled(f"Made from commit {commitText}, on {machineText}.")
