// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How long the window stands still, for measurements.
#pragma once

class QObject;

namespace quadrille
{

/// Where the variable QUADRILLE_WINDOW_PAUSES of the environment names a file: writes there each time in which the
/// window has not taken up events for 50 ms or more. A line has the seconds since 1970 at its end, its length in
/// seconds, and how many of them its thread was at work: for the rest it waited, or other programs had the processors.
void writePauses(QObject* parent);

} // namespace quadrille
