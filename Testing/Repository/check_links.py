#!/usr/bin/python3
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Links of documents within the repository lead somewhere: to a file or folder that is there, and, where they name a
heading, to one of that page. Each page of Documentation/Guide is linked from Documentation/UserGuide.md.

  check_links.py SOURCE_DIR
  check_links.py --selftest
"""
import pathlib
import re
import sys

from check_sources import repositoryFiles

# [text](goal#heading "title"), also of pictures, and [name]: goal#heading
LINK = re.compile(r"\]\(\s*([^)#\s]*)(?:#([^)\s]+))?(?:\s+\"[^\"]*\")?\s*\)")
DEFINITION = re.compile(r"^ {0,3}\[[^]]+\]:\s+([^#\s]*)(?:#(\S+))?", re.MULTILINE)
FENCE = re.compile(r"^ *(`{3,}|~{3,}).*?^ *\1", re.DOTALL | re.MULTILINE)
SPAN = re.compile(r"(`+)(?!`)[^\n]*?(?<!`)\1(?!`)")
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
OWN_ANCHOR = re.compile(r"<a\s+(?:id|name)=\"([^\"]+)\"")


def blanked(match):
    return re.sub(r"[^\n]", " ", match.group(0))


def withoutCode(text):
    """The same lines without code and comments."""
    return SPAN.sub(blanked, COMMENT.sub(blanked, FENCE.sub(blanked, text)))


def anchor(heading):
    """What GitHub makes of a heading."""
    heading = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def anchors(text):
    """Those of all headings; of headings with the same words the second one ends with -1."""
    found, counts = set(OWN_ANCHOR.findall(text)), {}
    for line in COMMENT.sub(blanked, FENCE.sub(blanked, text)).splitlines():
        heading = re.match(r" {0,3}#{1,6} +(.*?)(?: +#+)? *$", line)
        if heading:
            name = anchor(heading.group(1))
            count = counts[name] = counts.get(name, -1) + 1
            found.add(f"{name}-{count}" if count else name)
    return found


def links(text):
    """(line, goal, heading) of each link that is none to another site."""
    plain = withoutCode(text)
    for match in list(LINK.finditer(plain)) + list(DEFINITION.finditer(plain)):
        if not re.match(r"[a-z][a-z+.-]*:", match.group(1), re.IGNORECASE):
            yield plain.count("\n", 0, match.start()) + 1, match.group(1), match.group(2)


def problems(root, page, text):
    """page: its path."""
    found = []
    for line, goal, heading in links(text):
        path = (page.parent / goal).resolve() if goal else page
        where = f"{page.relative_to(root)}:{line}: link to {goal}"
        if not path.exists():
            found.append(f"{where}, which is not there")
        elif root not in path.parents and path != root:
            found.append(f"{where}, which is outside of the repository")
        elif heading and (path.suffix != ".md" or heading not in anchors(path.read_text())):
            found.append(f"{where}#{heading}: no such heading")
    return found


def pagesWithoutLink(root):
    guide = root / "Documentation/UserGuide.md"
    linked = {(guide.parent / goal).resolve() for _, goal, _ in links(guide.read_text())}
    return [f"{page.relative_to(root)}: {guide.relative_to(root)} has no link to it"
            for page in sorted((guide.parent / "Guide").glob("*.md")) if page.resolve() not in linked]


def selftest(root):
    assert anchors("# A b, c\n```\n# no\n```\n## [D](x.md) e-f\n### A b, c\n#### `code` it_self\n") == {
        "a-b-c", "d-e-f", "a-b-c-1", "code-it_self"}
    assert list(links("[a](b.md#c) ![d](e.png)\n`[f](g)` [h](https://i.j/k.md)\n```\n[l](m)\n```\n[n](#o)\n"
                      "[p]: q.md#r\n<!-- [s](t) -->\n[u\nv](w.md)\n")) == [
        (1, "b.md", "c"), (1, "e.png", None), (6, "", "o"), (10, "w.md", None), (7, "q.md", "r")]
    page = root / "README.md"
    assert not problems(root, page, "[a](README.md) [b](https://example.org/x) [c](Documentation) [d](#try-it)")
    assert len(problems(root, page, "[a](NoSuchFile.md) [b](README.md#no-such-heading) [c](../) [d](LICENSE#e)")) == 4


def main():
    if sys.argv[1] == "--selftest":
        selftest(pathlib.Path(__file__).resolve().parents[2])
        return 0
    root = pathlib.Path(sys.argv[1]).resolve()
    selftest(root)
    files = [p for p in repositoryFiles(root) if p.suffix == ".md"]
    texts = {path: path.read_text() for path in files}
    found = [line for path, text in sorted(texts.items()) for line in problems(root, path, text)]
    found += pagesWithoutLink(root)
    count = sum(1 for text in texts.values() for _ in links(text))
    if count < 50:
        found.append(f"only {count} links found")
    print("\n".join(found) or f"links: {count} in {len(files)} documents, fine")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
