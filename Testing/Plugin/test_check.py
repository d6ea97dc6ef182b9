# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""A filter that fails in pvpython: one line says why, quadrille.check raises; a state written as Python, which does not
load the plugin.

    test_check.py PVPYTHON      runs itself there, as what it prints is part of the test
"""
import os
import re
import subprocess
import sys
import tempfile


def failing_script():
    from paraview import simple

    import quadrille
    from plugin_common import PLUGIN, surface

    simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
    mesh = surface(simple)
    # What looks at the mapped surface would switch it on, which is another execution.
    quads = QuadRemesh(Input=mesh, TargetType="Edge Length", EdgeLength=-1, ComputeMappedSurface=1)
    quads.UpdatePipeline()
    for port in range(4):  # as ParaView does for what is shown
        simple.Calculator(Input=simple.OutputPort(quads, port), Function="1").UpdatePipeline()
        quads.GetDataInformation(port).GetNumberOfCells()

    def reason_of(proxy):
        try:
            quadrille.check(proxy)
        except quadrille.RemeshError as error:
            return f"{type(error).__name__}: {error}"
        return "nothing"

    print("CHECK", reason_of(quads))
    print("BEHIND", reason_of(simple.Calculator(Input=quads, Function="1")))
    quads.EdgeLength = 0.2
    print("MENDED", reason_of(quads), quadrille.check(quads) is quads)
    # A stage whose input has failed is not at fault itself.
    hierarchy = DecimationHierarchy(Input=mesh, TargetType="Edge Length", EdgeLength=-1)
    grid = IntegerGridMap(Input=simple.OutputPort(hierarchy, 0))
    print("CHAIN", reason_of(QuadExtraction(Input=grid)))


def write_state(path):
    from paraview import simple, smstate

    from plugin_common import PLUGIN, surface

    simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
    QuadRemesh(registrationName="my quads", Input=surface(simple), TargetType="Number Of Quads",
               NumberOfQuads=350).UpdatePipeline()
    with open(path, "w") as file:
        file.write(smstate.get_state())
        file.write("\nquads = FindSource('my quads')\nquads.UpdatePipeline()\n"
                   "print('CELLS', quads.GetDataInformation().GetNumberOfCells())\n")


def run(pvpython, *words, **environment):
    result = subprocess.run([pvpython, *words], env=dict(os.environ, **environment), stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT,
                            text=True, timeout=120)
    return result.returncode, result.stdout


def expect(condition, text, output):
    if not condition:
        # Without what makes ctest take every output with an error of VTK for a failure of its own.
        sys.exit(f"FAILED: {text}\n" + output.replace("ERR|", "ERR :").replace("Traceback", "Trace"))


def test_failures(pvpython):
    code, output = run(pvpython, __file__, "failing")
    expect(code == 0, f"exit code {code}", output)
    said = re.findall(r"ERR\|.*", output)
    of_remesh = [line for line in said if "vtkQuadRemesh" in line]
    expect(len(of_remesh) == 1, f"{len(of_remesh)} lines tell of one failure", output)
    expect("returned failure for request" not in output
           or "vtkQuad" not in output.split("returned failure")[0].splitlines()[-1],
           "the executive dumps its request", output)
    for wanted in (r"CHECK InvalidInput: .*edge length", r"BEHIND InvalidInput: .*edge length", r"MENDED nothing True",
                   r"CHAIN InvalidInput: .*target edge length"):
        expect(re.search(wanted, output), f"no line {wanted!r}", output)


def test_python_state(pvpython):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "state.py")
        code, output = run(pvpython, __file__, "state", path)
        expect(code == 0, f"writing the state: exit code {code}", output)
        code, output = run(pvpython, path)
        expect(code != 0 and "QuadRemesh" in output, "ParaView loads the plugin by itself: the guide need not say how",
               output)
        plugin = os.environ["QUADRILLE_PLUGIN"]
        # The two ways of the guide.
        code, by_path = run(pvpython, path, PV_PLUGIN_PATH=os.path.dirname(plugin))
        expect(code == 0, "with PV_PLUGIN_PATH", by_path)
        with open(path) as file:
            text = file.read()
        imported = "from paraview.simple import *\n"
        expect(text.count(imported) == 1, "the state has another import", text)
        with open(path, "w") as file:
            file.write(text.replace(imported, f"{imported}LoadPlugin({plugin!r}, remote=False, ns=globals())\n"))
        code, by_line = run(pvpython, path)
        expect(code == 0, "with LoadPlugin", by_line)
        cells = [re.search(r"CELLS (\d+)", output) for output in (by_path, by_line)]
        expect(all(cells) and int(cells[0].group(1)) > 0 and cells[0].group(1) == cells[1].group(1), "other quads",
               by_path + by_line)


if sys.argv[1] == "failing":
    failing_script()
elif sys.argv[1] == "state":
    write_state(sys.argv[2])
else:
    test_failures(sys.argv[1])
    test_python_state(sys.argv[1])
    print("check: fine")
