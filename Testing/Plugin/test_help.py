# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The question mark in ParaView's panel finds a page for each filter, with all its properties: test_help.py QCH

ParaView looks for qthelp://NAMESPACE/NAME/GROUP.PROXY.html, where NAME is what comes before the dot in the namespace. A
.qch file is a data base of SQLite; its texts are compressed by zlib, after four bytes with their length.
"""
import base64
import html
import pathlib
import sqlite3
import sys
import zlib

from paraview import servermanager, simple

from plugin_common import FILTERS, PLUGIN, check

simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
qch = pathlib.Path(sys.argv[1])
tables = sqlite3.connect(qch)
(namespace,), = tables.execute("SELECT Name FROM NamespaceTable")
(folder,), = tables.execute("SELECT Name FROM FolderTable")
check(namespace.split(".")[0] == folder, f"namespace {namespace}, folder {folder}")
pages = {name: zlib.decompress(data[4:]).decode() for name, data in tables.execute(
    "SELECT FileNameTable.Name, FileDataTable.Data FROM FileNameTable JOIN FileDataTable "
    "ON FileNameTable.FileId = FileDataTable.Id WHERE Data IS NOT NULL")}


def shown(proxy):
    """Labels of all properties that the panel can show."""
    labels = []
    walk = proxy.NewPropertyIterator()
    walk.UnRegister(None)
    while not walk.IsAtEnd():
        if walk.GetProperty().GetPanelVisibility() != "never":
            labels.append(walk.GetProperty().GetXMLLabel())
        walk.Next()
    return labels


def look(group, name):
    page = pages[f"{group}.{name}.html"]
    labels = shown(servermanager.CreateProxy(group, name))
    check(len(labels) >= 1, f"{name} has no properties")
    missing = [label for label in labels if f"<b>{html.escape(label)}</b>" not in page]
    check(not missing, f"the page of {name} lacks {missing}")
    print(f"{name}: {len(labels)} properties, {len(page)} characters")


for name in FILTERS:
    look("filters", name)
for name in ("QuadrillePLYReader", "QuadrilleOFFReader", "QuadStroke", "QuadValence", "QuadMove", "QuadConnection",
             "QuadLoop", "QuadFeatureCurve", "QuadClearedFeature", "QuadSize"):
    look("sources", name)
for name in ("QuadInpWriter", "QuadMshWriter", "QuadMeditWriter", "QuadExodusWriter"):
    look("writers", name)
ours = [name for name in pages if name.startswith(("filters.", "sources.", "writers."))]
missing = [name for name in ours if f'href="{name}"' not in pages["index.html"]]
check(len(ours) > 20 and not missing, f"the index has no link to {missing}")
# The window takes the pages from the plugin itself.
text = base64.b64encode(qch.read_bytes())
check(text[:2000] in pathlib.Path(PLUGIN).read_bytes(), "the plugin does not hold the pages")
print("help: fine")
