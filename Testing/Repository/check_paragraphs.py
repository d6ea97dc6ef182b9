#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Paragraphs and list items of documents are filled: no line ends where the first word of the next one would still have
fitted into 120 columns. Code, tables, headings, comments, definitions of links and hard breaks stay as they are, and a
word that would be a mark at the begin of a line, as `-` or `2.`, stays behind the word before it, and so does a single
`/` or `.`.

  check_paragraphs.py SOURCE_DIR [--fill]      --fill fills the paragraphs that are cut short
  check_paragraphs.py --selftest
"""
import pathlib
import re
import sys

from check_lines import COLUMNS
from check_sources import repositoryFiles

FENCE = re.compile(r"\s*(`{3,}|~{3,})")
ITEM = re.compile(r"(\s*)([-*+]|\d{1,9}[.)])\s+")
# Headings and rules, rows of tables, quotes, definitions of links, HTML: what no paragraph goes over.
APART = re.compile(r"\s*(#{1,6}(\s|$)|(=+|-{2,}|(\*\s*){3,})\s*$|\||>|\[[^]]+\]:\s|</?[A-Za-z][\w-]*[\s>/]|<!)")
HARD_BREAK = re.compile(r"(  |\\)$")
MARK = re.compile(r"([-+*>|./]|=+|-{2,}|#{1,6}|\d{1,9}[.)])$|[|>]|`{3}|~{3}|<[!/A-Za-z]")


def indentOf(line):
    return len(line) - len(line.lstrip(" "))


def paragraphs(text):
    """(begin, end, content): lines [begin, end) of each paragraph or list item, and the column where its text begins.
    A hard break ends one."""
    lines = text.split("\n")
    found, contents, afterBlank, i = [], [], True, 0
    while i < len(lines):
        line = lines[i]
        fence = FENCE.match(line)
        if fence or line.lstrip().startswith("<!--"):
            closed = re.compile(rf"\s*{fence.group(1)}\s*$" if fence else r".*-->")
            i += 1 if fence else 0
            while i < len(lines) and not closed.match(lines[i]):
                i += 1
            i, afterBlank = i + 1, True
            continue
        if not line.strip() or APART.match(line):
            i, afterBlank = i + 1, True
            continue
        item = ITEM.match(line)
        if item:
            contents = [c for c in contents if c <= len(item.group(1))] + [item.end()]
            content = item.end()
        elif afterBlank:
            contents = [c for c in contents if c <= indentOf(line)]
            content = indentOf(line)
            if content - (contents[-1] if contents else 0) >= 4:
                i += 1  # indented code; afterBlank stays, so that its next line is one, too
                continue
        begin, i = i, i + 1
        while i < len(lines) and not HARD_BREAK.search(lines[i - 1]) and lines[i].strip() and not (
                APART.match(lines[i]) or FENCE.match(lines[i]) or ITEM.match(lines[i])):
            i += 1
        found.append((begin, i, content))
        afterBlank = False
    return found


def chunks(words):
    """Words that may stand at the begin of a line, each with the marks behind it."""
    result = []
    for word in words:
        if result and MARK.match(word):
            result[-1] += " " + word
        else:
            result.append(word)
    return result


def filled(lines, content):
    """The lines of a paragraph, filled."""
    first = chunks(" ".join(lines)[content:].split())
    result = [lines[0][:content] + first[0]]
    for chunk in first[1:]:
        if len(result[-1]) + 1 + len(chunk) <= COLUMNS:
            result[-1] += " " + chunk
        else:
            result.append(" " * content + chunk)
    if HARD_BREAK.search(lines[-1]) and not result[-1].endswith("\\"):
        result[-1] += "  "
    return result


def cutShort(lines):
    """Places in a paragraph, counted from 0, of lines that the first word of the next one would have fitted behind."""
    return [k for k in range(len(lines) - 1)
            if len(lines[k]) + 1 + len(chunks(lines[k + 1].split())[0]) <= COLUMNS]


def problems(path, text):
    lines = text.split("\n")
    return [f"{path}:{begin + k + 1}: cut short, {lines[begin + k + 1].split()[0]!r} would still fit"
            for begin, end, _ in paragraphs(text) for k in cutShort(lines[begin:end])]


def filledText(text):
    lines = text.split("\n")
    for begin, end, content in reversed(paragraphs(text)):
        if cutShort(lines[begin:end]) or any(len(line) > COLUMNS for line in lines[begin:end]):
            lines[begin:end] = filled(lines[begin:end], content)
    return "\n".join(lines)


def selftest():
    def fill(text):
        result = filledText(text)
        assert result.split() == text.split() and not problems("a.md", result), result
        return result

    long = "x" * 50
    assert problems("a.md", "# A\n\nshort\nline\n") == ["a.md:3: cut short, 'line' would still fit"]
    assert fill("# A\n\nshort\nline\n") == "# A\n\nshort line\n"
    assert fill(f"{long} {long}\n{long} b\nc\n") == f"{long} {long}\n{long} b c\n"
    assert fill(f"{long} {long} {'y' * 18}\nz\n") == f"{long} {long} {'y' * 18}\nz\n"  # 120 columns
    assert fill("- a\n  b\n  - c\n    d\n2. e\n   f\n") == "- a b\n  - c d\n2. e f\n"
    assert fill(f"- {long} {long} {long}\n") == f"- {long} {long}\n  {long}\n"
    assert fill("- a\n  b\n\n  c\n  d\n") == "- a b\n\n  c d\n"
    for kept in ("```sh\na\nb\n```\n", "~~~\na\n~~~\n", "| a |\n| b |\n", "<!-- a\nb -->\n", "a  \nb\n", "a\\\nb\n",
                 "[a]: b\n[c]: d\n", "    code\n    code\n", "- a\n\n      code\n      code\n", "<p>\n</p>\n",
                 "a\n\nb\n"):
        assert fill(kept) == kept, kept
    # A mark may not come to the begin of a line.
    assert fill(f"{long} {long} {'y' * 15} 7 - 1\n") == f"{long} {long} {'y' * 15}\n7 - 1\n"
    assert cutShort([f"{long} {long} {'y' * 15}", "7 - 1"]) == []
    assert fill("a\nb  \nc\nd\n") == "a b  \nc d\n"


def main():
    selftest()
    if sys.argv[1] == "--selftest":
        return 0
    root = pathlib.Path(sys.argv[1])
    files = [p for p in repositoryFiles(root) if p.suffix == ".md"]
    if "--fill" in sys.argv[2:]:
        for path in files:
            path.write_text(filledText(path.read_text()))
    found = [line for path in files for line in problems(path.relative_to(root), path.read_text())]
    if not files:
        found.append("no file found")
    elif found:
        found.append("check_paragraphs.py SOURCE_DIR --fill fills them")
    print("\n".join(found) or f"paragraphs: {len(files)} files, fine")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
