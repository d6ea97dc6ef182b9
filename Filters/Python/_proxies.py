# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""For scripts of ParaView, whose proxies never raise."""
from ._errors import InvalidInput, RemeshError


def _inputs_of(proxy):
    """The proxies that a ParaView proxy takes data from."""
    from paraview import servermanager

    found = []
    for name in proxy.ListProperties():
        prop = proxy.GetProperty(name)
        if isinstance(prop, servermanager.InputProperty):
            ports = [prop.GetData()] if not isinstance(prop.GetData(), (list, tuple)) else prop.GetData()
            found += [port for port in ports if port is not None]
    return [servermanager._getPyProxy(port.SMProxy) for port in found]


def _outcome_of(algorithm):
    """(text, is bad input) of a filter of Quadrille that has failed, else None."""
    if not hasattr(algorithm, "GetOutcomeText"):
        return None
    if not hasattr(algorithm, "GetOutcome"):  # a reader
        return (algorithm.GetOutcomeText(), True) if algorithm.GetOutcomeText() else None
    if algorithm.GetOutcome() in (algorithm.NotRun, algorithm.Succeeded):
        return None
    return algorithm.GetOutcomeText(), algorithm.GetOutcome() == algorithm.BadInput


def _failure_upstream(proxy, seen):
    """The outcome of the first filter of Quadrille on the way to this proxy that has failed, else None."""
    if proxy.GetGlobalIDAsString() in seen:
        return None
    seen.add(proxy.GetGlobalIDAsString())
    for source in _inputs_of(proxy):
        failure = _failure_upstream(source, seen)
        if failure:
            return failure
    algorithm = proxy.GetClientSideObject()
    if algorithm is not None:
        return _outcome_of(algorithm)
    return _outcome_of_properties(proxy)


def _outcome_of_properties(proxy):
    """The same of a filter that lives in a server."""
    if "OutcomeText" not in proxy.ListProperties():
        return None
    proxy.UpdatePropertyInformation()
    text = proxy.GetPropertyValue("OutcomeText")
    return (text, False) if text else None


def check(source):
    """Brings a filter of ParaView up to date, raises if it or a filter of Quadrille before it has failed, returns it.

    source: a proxy (`QuadRemesh(...)`, or anything behind it), or an algorithm of VTK (`vtkQuadRemesh()`).

    ParaView's proxies print an error and go on, with the previous result or with nothing; this is for scripts that have
    to notice:

        quads = quadrille.check(QuadRemesh(Input=surface, NumberOfQuads=5000))

    Raises InvalidInput where the input or a property is at fault, else RemeshError, with the reason.
    """
    if hasattr(source, "SMProxy"):
        source.UpdatePipeline()
        failure = _failure_upstream(source, set())
    elif hasattr(source, "Update"):
        source.Update()
        failure = _outcome_of(source)
    else:
        raise InvalidInput(f"check takes a proxy of ParaView or an algorithm of VTK, not {type(source).__name__}")
    if failure:
        text, is_bad_input = failure
        raise (InvalidInput if is_bad_input else RemeshError)(text or "no quads were made")
    return source
