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

from vtkmodules.util.numpy_support import vtk_to_numpy


def serve(view, names):
    """names: the globals that the questions see, and change."""
    question = os.environ["QUADRILLE_QUESTION"]

    def answer(*_):
        if not os.path.exists(question):
            return
        with open(question, encoding="utf-8") as file:
            text = file.read()
        os.remove(question)
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
    interactor.CreateRepeatingTimer(50)
    return interactor


def bytes_of(quads):
    """A fingerprint of places and connectivity of the first output of a filter's proxy, and the number of quads."""
    data = quads.GetClientSideObject().GetOutputDataObject(0)
    polys = data.GetPolys()
    arrays = (data.GetPoints().GetData(), polys.GetOffsetsArray(), polys.GetConnectivityArray())
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(vtk_to_numpy(array).tobytes())
    return digest.hexdigest(), data.GetNumberOfPolys()
