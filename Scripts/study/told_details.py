# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The topology that quads should have: that of the input, less the small details that a report tells as simplified."""


def without(topology, details):
    """components, loops and euler of the input as a dictionary; details: those of a report."""
    wanted = {name: topology[name] for name in ("components", "loops", "euler")}
    for detail in details or ():
        if detail["decision"] != "simplified":
            continue
        if detail["kind"] == "handle":
            wanted["euler"] += 2
        elif detail["kind"] == "thin part":
            if detail["result"] == "cut in two":
                wanted["components"] += 1
                wanted["euler"] += 2
        elif detail["kind"] == "boundary loop":
            wanted["euler"] += 1
            wanted["loops"] -= 1
        elif detail["result"].startswith("removed"):
            wanted["components"] -= 1
            wanted["euler"] -= 2
    return wanted
