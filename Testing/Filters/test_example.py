# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""An example with a library that may be missing: test_example.py MODULE EXAMPLE.py SURFACE. Where Python cannot import
the module it ends with 77, which CTest takes for skipped, and says why."""
import importlib
import re
import subprocess
import sys

module, example, surface = sys.argv[1:]
try:
    importlib.import_module(module)
except ImportError as reason:
    print(f"skipped: {sys.executable} has no {module} for this VTK: {reason}")
    sys.exit(77)
done = subprocess.run([sys.executable, example, surface], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
print(done.stdout)
found = re.search(r"^(\d+) quads, .*'height'", done.stdout, re.MULTILINE)
if done.returncode != 0 or not found or not 1500 < int(found.group(1)) < 2500:
    sys.exit(f"FAILED: {example} ended with {done.returncode}, and should tell of about 2000 quads with 'height'")
