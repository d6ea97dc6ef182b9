# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Of two packages `quadrille` on the path the one for the VTK of this Python is imported, and one for another VTK alone
says so: test_vtk_choice.py PACKAGES WORK_FOLDER."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

packages, work = (pathlib.Path(word) for word in sys.argv[1:])
shutil.rmtree(work, ignore_errors=True)
other, ours = work / "other", packages
shutil.copytree(packages / "quadrille", other / "quadrille")
told = other / "quadrille" / "_vtk.py"
told.write_text(re.sub(r'^BUILT_FOR = ".+"$', 'BUILT_FOR = "0.1.2"', told.read_text(), flags=re.MULTILINE))
# Would be told by the import of the wrong one.
(other / "quadrille" / "_inputs.py").write_text("raise SystemExit('this one is for another VTK')\n")


def imported(*folders):
    rest = [folder for folder in os.environ.get("PYTHONPATH", "").split(os.pathsep)
            if folder and not os.path.isdir(os.path.join(folder, "quadrille"))]
    path = os.pathsep.join([*map(str, folders), *rest])
    done = subprocess.run([sys.executable, "-c", "import quadrille; from quadrille import evaluation; "
                           "print(quadrille.__path__, evaluation.__file__, quadrille.vtkQuadRemesh())"], text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=dict(os.environ, PYTHONPATH=path))
    return done.returncode, done.stdout


for folders in ((ours, other), (other, ours)):
    code, text = imported(*folders)
    if code != 0 or not text.startswith(f"['{ours / 'quadrille'}'] {ours}"):
        sys.exit(f"FAILED: {folders}: {text}")
code, text = imported(other)
if code == 0 or "ImportError" not in text or "is built for VTK 0.1.2, but this Python has VTK 9." not in text:
    sys.exit(f"FAILED: of another VTK alone: {text}")
print(text.splitlines()[-1])
