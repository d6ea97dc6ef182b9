# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The package's file of types names what the package has, with the same parameters."""
import ast
import inspect
import pathlib
import sys

import quadrille

STUB = ast.parse((pathlib.Path(quadrille.__file__).parent / "__init__.pyi").read_text())
FAILURES = []


def parameters(function):
    given = function.args
    named = [argument.arg for argument in given.args + given.kwonlyargs]
    return named + [rest.arg for rest in (given.vararg, given.kwarg) if rest]


def compare(name, node, there):
    if name == "elements":  # whose options are passed on
        return
    told = [parameter for parameter in parameters(node) if parameter not in ("self", "cls")]
    has = [parameter for parameter in inspect.signature(there).parameters if parameter != "self"]
    if told != has:
        FAILURES.append(f"{name} has the parameters {has}, but the types have {told}")


names = set()
for node in STUB.body:
    if isinstance(node, ast.AnnAssign) and node.target.id in quadrille.__all__:
        names.add(node.target.id)
    if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and node.name != "__getattr__":
        names.add(node.name)
        there = getattr(quadrille, node.name)
        if isinstance(node, ast.FunctionDef):
            compare(node.name, node, there)
            continue
        for method in (part for part in node.body if isinstance(part, ast.FunctionDef)):
            is_property = isinstance(inspect.getattr_static(there, method.name), property)
            if not is_property:
                compare(f"{node.name}.{method.name}", method, getattr(there, method.name))
        missing = {name for name in vars(there) if not name.startswith("_") and inspect.isfunction(vars(there)[name])}
        missing -= {part.name for part in node.body if isinstance(part, ast.FunctionDef)}
        if missing:
            FAILURES.append(f"{node.name}: {sorted(missing)} are not among the types")
if names != set(quadrille.__all__):
    FAILURES.append(f"{sorted(names ^ set(quadrille.__all__))} are in one of __all__ and the types only")
if FAILURES:
    sys.exit("FAILED: " + "; ".join(FAILURES))
print(f"types: fine, {len(names)} names")
