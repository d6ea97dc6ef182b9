# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Manual page and completions of a command tell what the command does: test_manual.py FOLDER COMMAND..."""
import gzip
import pathlib
import re
import shutil
import subprocess
import sys

folder, commands = pathlib.Path(sys.argv[1]), sys.argv[2:]
COMPLETE = """
source "$1"
COMP_WORDS=("${@:3}"); COMP_CWORD=$(( ${#COMP_WORDS[@]} - 1 ))
"$2"
printf '%s\\n' "${COMPREPLY[@]}"
"""


def run(*words, code=0):
    done = subprocess.run([str(word) for word in words], text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    if code is not None and done.returncode != code:
        sys.exit(f"FAILED with {done.returncode}: {words}\n{done.stdout}")
    return done.stdout


def require(truth, text):
    if not truth:
        sys.exit(f"FAILED: {text}")


def completed(name, *words):
    function = "_" + name.replace("-", "_")
    return run("bash", "--norc", "-c", COMPLETE, "bash", folder / f"{name}.bash", function, name, *words).split()


for command in commands:
    name = pathlib.Path(command).name
    # Read here in another way than by who has written the files: each word of the help that begins as an option does.
    help_text = run(command, "--help")
    options = set(re.findall(r"^  (?:-\w, ?)?(--[a-z][a-z-]*)", help_text, re.MULTILINE))
    require(len(options) > 5, f"{name}: options are {options}")

    page = gzip.decompress((folder / f"{name}.1.gz").read_bytes()).decode()
    documented = {word.replace("\\-", "-") for word in re.findall(r"\\fB(\\-\\-[a-z\\-]+)\\fR", page)}
    require(documented == options, f"{name}.1: differs in {documented ^ options}")
    if shutil.which("man"):
        warnings = [line for line in run("man", "--warnings", "-E", "UTF-8", "-l", folder / f"{name}.1.gz").splitlines()
                    if "warning" in line]
        require(not warnings, f"{name}.1: {warnings}")

    require(set(completed(name, "--")) == options, f"{name}.bash: {set(completed(name, '--')) ^ options}")
    some = sorted(options)[0]
    require(completed(name, some[:-1]) and completed(name, "xyz") == [], f"{name}.bash: beginnings of words")
    words = {option: completed(name, option, "") for option in options}
    require(words["--method"][:2] in (["scale-aware", "mixed-integer"], ["seamless", "scale-aware"]),
            f"{name}.bash: methods are {words['--method']}")
    for option, taken in words.items():
        for word in taken:
            # Each is taken: what is wrong then is that there are no files.
            said = run(command, option, word, code=None)
            require("needs" not in said.split("\n")[0] or "are needed" in said, f"{option} {word}: {said}")
            require("invalid choice" not in said, f"{option} {word}: {said}")
    for option in options:
        require(f"'{option}[" in (folder / f"_{name}").read_text(), f"_{name} lacks {option}")
    if shutil.which("zsh"):
        run("zsh", "-n", folder / f"_{name}")
    print(f"{name}: {len(options)} options, words of {sum(1 for taken in words.values() if taken)}")
