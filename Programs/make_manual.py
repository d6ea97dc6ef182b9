#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Manual page and completions of a command, from what the command itself says:

  make_manual.py FOLDER VERSION "WHAT IT IS" COMMAND

FOLDER gets NAME.1.gz, NAME.bash and _NAME (zsh). The options are those of `COMMAND --help`. Which words an option takes
the help of Python's argparse tells; the other commands are asked with a word that none is, and their error names those
that are.
"""
import gzip
import pathlib
import re
import subprocess
import sys

NO_WORD = "?"


class Option:
    def __init__(self, names, unit, text):
        self.names, self.unit, self.text = names, unit, text
        self.words = []

    @property
    def name(self):
        """The long one."""
        return self.names[-1]


class Help:
    """What --help says, in parts: usage, introduction, groups of options under their headings, closing words."""

    def __init__(self, text):
        self.usage, self.introduction, self.groups, self.closing = [], [], [], []
        part = self.usage
        for block in re.split(r"\n\n+", text.rstrip("\n")):
            lines = block.splitlines()
            if lines[0].startswith("usage: "):
                self.usage = [re.sub(r"^(usage:| {6})", "", line).strip() for line in joined(lines)]
                part = self.introduction
            elif lines[0].endswith(":") and len(lines) > 1 and lines[1].startswith("  "):
                options = options_of(lines[1:])
                if options:
                    self.groups.append((lines[0][:-1], options))
                    part = self.closing
            else:
                part.append(lines)

    @property
    def options(self):
        return [option for _, options in self.groups for option in options]


def joined(lines):
    """The usage of argparse goes on in deeply indented lines; one of ours has a line for each way to call it."""
    result = []
    for line in lines:
        if result and re.match(r" {8,}", line):
            result[-1] += " " + line.strip()
        else:
            result.append(line)
    return result


def options_of(lines):
    result = []
    for line in lines:
        found = re.match(r"  (-.*?)(?:\s{2,}(.*))?$", line)
        if found:
            names, unit = re.fullmatch(r"(-[\w-]+(?:, ?-[\w-]+)*) ?(.*)", found.group(1)).groups()
            names = re.split(", ?", names)
            result.append(Option(names, unit, [found.group(2)] if found.group(2) else []))
        elif result:
            result[-1].text.append(line.strip())
    for option in result:
        option.text = " ".join(option.text)
    return result


def output_of(*words):
    done = subprocess.run(words, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          timeout=60)
    return done.stdout


def ask_for_words(command, option):
    """Fills in the words that an option takes."""
    choice = re.fullmatch(r"\{(.+)\}", option.unit)
    if choice:
        option.words = choice.group(1).split(",")
        return
    if not option.unit:
        return
    # Without files no run can start, whatever the option does with the word.
    said = re.search(rf"{option.name} needs (.+), not '\{NO_WORD}'", output_of(command, option.name, NO_WORD))
    if said:
        words = re.split(r", | or ", said.group(1))
        option.words = [word for word in words if re.fullmatch(r"[\w.-]+", word)]


# --- the manual page --------------------------------------------------------------------------------------------------

def escaped(text):
    return re.sub(r"^([.'])", r"\\&\1", text.replace("\\", "\\e").replace("-", "\\-"))


def option_words(option):
    return ", ".join(f"\\fB{escaped(name)}\\fR" for name in option.names) + (
        f" \\fI{escaped(option.unit)}\\fR" if option.unit else "")


def synopsis(name, usage):
    return "\n.br\n".join(re.sub(rf"^{name}", f"\\\\fB{escaped(name)}\\\\fR", escaped(line)
                                 .replace(escaped(name), name, 1)) for line in usage)


def manual(name, version, what, parts):
    lines = [f'.TH {name.upper()} 1 "" "Quadrille {version}" "Quadrille"', ".SH NAME", f"{name} \\- {escaped(what)}",
             ".SH SYNOPSIS", ".nh", ".ad l", synopsis(name, parts.usage), ".SH DESCRIPTION"]
    for block in parts.introduction:
        lines += [".PP", escaped(" ".join(line.strip() for line in block))]
    lines.append(".SH OPTIONS")
    for title, options in parts.groups:
        lines += [f".SS {escaped(title[:1].upper() + title[1:])}"]
        for option in options:
            lines += [".TP", option_words(option), escaped(option.text)]
    for block in parts.closing:
        title, _, rest = " ".join(line.strip() for line in block).partition(": ")
        lines += [f".SH {title.upper()}", escaped(rest)]
    lines += [".SH SEE ALSO", "Formats, arrays and methods are described in the user guide, "
              "/usr/share/doc/quadrille/UserGuide.md with its folder Guide where the Debian package is installed."]
    return "\n".join(lines) + "\n"


# --- completions ------------------------------------------------------------------------------------------------------

def bash(name, options):
    function = "_" + name.replace("-", "_")
    with_words = "".join(f"    {o.name}) COMPREPLY=($(compgen -W \"{' '.join(o.words)}\" -- \"$current\")); return ;;\n"
                         for o in options if o.words)
    free = [o.name for o in options if o.unit and not o.words]
    return f"""# Completion of {name} for bash.
{function}()
{{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}}
  COMPREPLY=()
  case $before in
{with_words}    {'|'.join(free)}) return ;; # a file or a number
  esac
  if [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "{' '.join(n for o in options for n in o.names)}" -- "$current"))
  fi
}}
complete -o default -F {function} {name}
"""


def zsh(name, options):
    def text_of(option):
        first = re.split(r"[;:.] |[;:.]$", option.text)[0]
        return re.sub(r"[\[\]:'\"`$\\]", "", first)

    rows = []
    for option in options:
        value = f":{option.unit}:({' '.join(option.words)})" if option.words else (
            f":{re.sub(r'[^A-Za-z.]', ' ', option.unit)}:_files" if option.unit else "")
        rows += [f"  '{each}[{text_of(option)}]{value}'" for each in option.names]
    return f"#compdef {name}\n# Completion of {name} for zsh.\n_arguments \\\n" + " \\\n".join(
        rows + ["  '*:file:_files'"]) + "\n"


def main(folder, version, what, command):
    name, folder = pathlib.Path(command).name, pathlib.Path(folder)
    parts = Help(output_of(command, "--help"))
    if not parts.usage or not parts.options:
        sys.exit(f"make_manual: {command} --help has no usage or no options")
    for option in parts.options:
        ask_for_words(command, option)
    folder.mkdir(parents=True, exist_ok=True)
    page = gzip.compress(manual(name, version, what, parts).encode(), 9, mtime=0)
    (folder / f"{name}.1.gz").write_bytes(page)
    (folder / f"{name}.bash").write_text(bash(name, parts.options), encoding="utf-8")
    (folder / f"_{name}").write_text(zsh(name, parts.options), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
