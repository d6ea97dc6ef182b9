# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What goes wrong, and the checks of plain numbers."""
import math
import numbers


class RemeshError(RuntimeError):
    """There is no valid result; the message says why."""


class InvalidInput(RemeshError, ValueError):
    """The mesh or an argument is at fault; the message names it."""


def real(name, value, *, least=None, above=None, most=None, hint=""):
    """value as a float; InvalidInput unless it is a finite number in the range: at least `least`, above `above`, at
    most `most`."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real) or not math.isfinite(value):
        raise InvalidInput(f"{name} must be a finite number, not {value!r}{hint}")
    too_small = (least is not None and value < least) or (above is not None and value <= above)
    if too_small or (most is not None and value > most):
        bounds = [text for text, bound in ((f"at least {least}", least), (f"above {above}", above),
                                           (f"at most {most}", most)) if bound is not None]
        raise InvalidInput(f"{name} must be {' and '.join(bounds)}, not {value!r}{hint}")
    return float(value)


def whole(name, value, *, least, most=2**31 - 1, hint=""):
    """value as an int; InvalidInput unless it is a whole number (5000.0 is one) from `least` to `most`."""
    number = real(name, value, hint=hint)
    if number != math.floor(number):
        raise InvalidInput(f"{name} must be a whole number, not {value!r}{hint}")
    real(name, value, least=least, most=most, hint=hint)
    return int(value)


def one_of(name, value, names):
    """The place of value in names; InvalidInput where it is none of them."""
    if value not in names:
        raise InvalidInput(f"{name} must be one of {', '.join(names)}, not {value!r}")
    return names.index(value)
