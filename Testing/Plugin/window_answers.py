# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Lets a script that runs in ParaView's window answer questions of the program that started it.

A question is Python code in the file QUADRILLE_QUESTION; what it prints comes back in a file beside it.
"""
import contextlib
import hashlib
import io
import os
import traceback

from paraview import servermanager
from vtkmodules.util.numpy_support import vtk_to_numpy

LOOK_AGAIN = 10  # milliseconds


def serve(view, names):
    """names: the globals that the questions see, and change."""
    question = os.environ["QUADRILLE_QUESTION"]
    seen = False

    def answer(*_):
        nonlocal seen
        if not os.path.exists(question):
            return
        if not seen:
            seen = True  # the answer comes at the next look: what the window has to take up is taken up before
            return
        seen = False
        with open(question, encoding="utf-8") as file:
            text = file.read()
        os.remove(question)
        fetched.clear()
        out = io.StringIO()
        try:
            with contextlib.redirect_stdout(out):
                exec(text, names)
        except Exception:
            out.write("FAILED: " + traceback.format_exc())
        with open(question + ".part", "w", encoding="utf-8") as file:
            file.write(out.getvalue())
        os.rename(question + ".part", question + ".answer")

    interactor = view.GetInteractor()
    interactor.AddObserver("TimerEvent", answer)
    interactor.CreateRepeatingTimer(LOOK_AGAIN)
    return interactor


fetched = {}  # what a question has fetched from a server, by proxy and port


def data_of(proxy, port=0):
    """An output of a filter's proxy; that of one on a server is fetched, once for each question."""
    here = proxy.GetClientSideObject()
    if here:
        return here.GetOutputDataObject(port)
    key = proxy.GetGlobalIDAsString(), port
    if key not in fetched:
        with no_step_of_the_user():
            fetched[key] = servermanager.Fetch(proxy, idx=port)
    return fetched[key]


@contextlib.contextmanager
def no_step_of_the_user():
    """What is asked inside is not put on the stack of undos."""
    builder = servermanager.vtkSMProxyManager.GetProxyManager().GetUndoStackBuilder()
    if not builder:
        yield  # no window
        return
    before = builder.GetIgnoreAllChanges()
    builder.SetIgnoreAllChanges(True)
    try:
        yield
    finally:
        builder.SetIgnoreAllChanges(before)


def verdict_of(quads):
    """As the panel shows it."""
    quads.UpdatePropertyInformation()
    return quads.GetPropertyValue("Verdict")


def bytes_of(quads):
    """A fingerprint of places and connectivity of the first output of a filter's proxy, and the number of quads."""
    data = data_of(quads)
    polys = data.GetPolys()
    arrays = (data.GetPoints().GetData(), polys.GetOffsetsArray(), polys.GetConnectivityArray())
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(vtk_to_numpy(array).tobytes())
    return digest.hexdigest(), data.GetNumberOfPolys()
