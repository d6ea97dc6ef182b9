# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What `cmake --install` puts somewhere else runs there: test_install.py CMAKE BUILD_DIR PREFIX PVPYTHON."""
import glob
import os
import pathlib
import shutil
import subprocess
import sys

cmake, build, prefix, pvpython = sys.argv[1:5]
data = pathlib.Path(os.environ["QUADRILLE_DATA"])
shutil.rmtree(prefix, ignore_errors=True)


def run(*words, **environment):
    clean = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "LD_LIBRARY_PATH")}
    result = subprocess.run([str(w) for w in words], env=dict(clean, **environment), text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if result.returncode != 0:
        sys.exit(f"FAILED: {words}\n{result.stdout}")
    return result.stdout


def one(pattern):
    found = glob.glob(os.path.join(prefix, pattern), recursive=True)
    if len(found) != 1:
        sys.exit(f"FAILED: {pattern}: {found}")
    return found[0]


run(cmake, "--install", build, "--prefix", prefix)
out = pathlib.Path(prefix) / "quads.vtp"
run(one("bin/quadrille"), data / "part.ply", out, "--quads", "1000")
if out.stat().st_size < 1000:
    sys.exit("FAILED: no quads were written")
if glob.glob(os.path.join(prefix, "lib*/**/QuadrilleCad.so"), recursive=True):
    run(one("bin/quadrille"), data / "bracket.step", out, "--quads", "800")
package = os.path.dirname(os.path.dirname(one("lib*/**/quadrille/__init__.py")))
code = ("import quadrille; m = quadrille.to_polydata([[0,0,0],[1,0,0],[0,1,0]], [[0,1,2]]);"
        "q = quadrille.remesh(m, quads=30); print('quads', q.GetNumberOfCells())")
print(run(sys.executable, "-c", code, PYTHONPATH=package))
plugin = one("lib*/**/Quadrille.so")
print(run(pvpython, "-c", f"from paraview import simple; simple.LoadPlugin({plugin!r}, remote=False, ns=globals());"
          "print(QuadRemesh(Input=simple.Sphere()).ListProperties())"))
build_paths = [line for line in run("readelf", "-d", plugin, one("bin/quadrille")).splitlines()
               if "PATH" in line and os.path.realpath(build) in line]
if build_paths:
    sys.exit(f"FAILED: installed files look into the build folder: {build_paths}")
listed = run(pvpython, "-c", "from paraview import simple; print('QuadRemesh' in dir(simple))",
             PV_PLUGIN_CONFIG_FILE=one("lib*/**/quadrille.plugins.xml"))
if "True" not in listed.split():
    sys.exit(f"FAILED: pvpython does not load the plugin of PV_PLUGIN_CONFIG_FILE: {listed}")
out.unlink()
run(cmake, "--build", build, "--target", "uninstall")
if os.path.exists(prefix):
    sys.exit(f"FAILED: after uninstall there is {[str(path) for path in pathlib.Path(prefix).rglob('*')]}")
print("install: fine")
