# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The recipe for conda-forge: it is YAML once its templates are filled in, has what conda-forge asks for, and says what
pyproject.toml and CMakeLists.txt say.

  test_recipe.py SOURCES
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1])
FAILURES = []


def expect(is_so, text):
    if not is_so:
        FAILURES.append(text)


def rendered(text):
    """Variables set in the file, and functions of conda-build as their arguments."""
    values = dict(re.findall(r'{% set (\w+) = "(.*?)" %}', text))
    for name, file, pattern in re.findall(
            r'{% set (\w+) = load_file_regex\("(.*?)", "(.*?)", from_recipe_dir=True\).group\(1\) %}', text):
        values[name] = re.search(pattern, (ROOT / "Packaging/conda" / file).read_text()).group(1)
    text = re.sub(r"{%.*?%}\n", "", text)
    text = re.sub(r'{{ (\w+)\("(\w+)"\) }}', r"\1_\2", text)
    return re.sub(r"{{ (\w+) }}", lambda found: values.get(found.group(1), found.group(1)), text), values


def parsed(text):
    """The recipe as dicts and lists; by PyYAML where it is at hand, else by the few rules that it keeps to."""
    try:
        import yaml
        return yaml.safe_load(text)
    except ImportError:
        pass
    recipe, section, key = {}, None, None
    for line in text.splitlines():
        line = re.sub(r"\s+#.*$|^#.*$", "", line)
        if not line.strip():
            continue
        indent, content = len(line) - len(line.lstrip()), line.strip()
        if indent == 0 and content.endswith(":"):
            section = recipe.setdefault(content[:-1], {})
        elif indent == 2 and ":" in content:
            key, value = (part.strip() for part in content.split(":", 1))
            section[key] = value or []
        elif indent == 4 and content.startswith("- ") and isinstance(section[key], list):
            section[key].append(content[2:])
        else:
            FAILURES.append(f"line not understood: {line}")
    return recipe


def main():
    project = (ROOT / "pyproject.toml").read_text()
    text, values = rendered((ROOT / "Packaging/conda/meta.yaml").read_text())
    recipe = parsed(text)
    for section, keys in {"package": ["name", "version"], "source": ["path"], "build": ["number", "script"],
                          "requirements": ["build", "host", "run"], "test": ["imports"],
                          "about": ["summary", "license", "license_file"],
                          "extra": ["recipe-maintainers"]}.items():
        for key in keys:
            expect(key in recipe.get(section, {}), f"{section}/{key} is missing")
    if FAILURES:
        return
    version = re.search(r"project\(Quadrille VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
    expect(str(recipe["package"]["version"]) == version, "package/version is not that of CMakeLists.txt")
    for name in ("name", "description", "license"):
        theirs = re.search(rf'^{name} = "(.*)"$', project, re.MULTILINE).group(1)
        ours = {"name": values["name"], "description": recipe["about"]["summary"],
                "license": recipe["about"]["license"]}[name]
        expect(ours == theirs, f"{name} is {ours!r}, but pyproject.toml has {theirs!r}")
    for file in recipe["about"]["license_file"]:
        expect((ROOT / file).is_file(), f"there is no {file}")
    numpy = re.search(r'"numpy(.*?)"', project).group(1)
    expect(f"numpy {numpy}" in recipe["requirements"]["run"], "numpy's least version differs from pyproject.toml")
    sources = ROOT / "Packaging/conda" / recipe["source"]["path"]
    expect(sources.resolve() == ROOT.resolve(), "the sources are elsewhere")


main()
if FAILURES:
    sys.exit("FAILED: " + "; ".join(FAILURES))
print("recipe: fine")
