# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Every property of Quad Remesh but threads, limits and where it runs is among its settings: else a change of it would
get an earlier result."""
import sys

import quadrille

NO_SETTINGS = {"NumberOfThreads", "TimeLimit", "MemoryLimit", "MaximumNumberOfQuads", "KeepLevels", "InBackground"}


def properties(kind):
    """Names with a setter and a getter of their own classes, down to the base that the filters of Quadrille share."""
    names = set()
    for base in kind.__mro__:
        if base.__name__.startswith(("vtkQuadRemesh", "vtkQuadrille")):
            names |= {name[3:] for name in vars(base) if name.startswith("Set")}
    return sorted(name for name in names if hasattr(kind, "Get" + name))


def other(value):
    """A value that the property does not have; at the upper end of its range the setter would keep it there."""
    if isinstance(value, str):
        return value + "x"
    if isinstance(value, tuple):
        return tuple(other(number) for number in value)
    return value - 1 if value >= 1 else value + 1


def main():
    names = properties(quadrille.vtkQuadRemesh)
    if len(names) < 20 or not NO_SETTINGS <= set(names):
        sys.exit(f"FAILED: the properties are not found: {names}")
    missing = []
    for name in names:
        remesh = quadrille.vtkQuadRemesh()
        before = remesh.GetSettings()
        value = getattr(remesh, "Get" + name)()
        getattr(remesh, "Set" + name)(other(value))
        if getattr(remesh, "Get" + name)() == value:
            getattr(remesh, "Set" + name)(value + 1)  # the least of its range
        if (remesh.GetSettings() == before) != (name in NO_SETTINGS):
            missing.append(name)
    if missing:
        sys.exit(f"FAILED: {missing} are settings and not told so, or the other way round")
    print(f"settings: fine, {len(names)} properties")


main()
