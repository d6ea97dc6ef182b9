// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Words to the user at the right of the tool bar: ParaView's status bar has room for a third of a sentence.
#pragma once

#include <QString>

class QToolBar;

namespace quadrille
{

/// Makes room for them behind what the tool bar has.
void addRoomForWords(QToolBar* bar);

/// Shows a word for half a minute, on what was just done.
void say(const QString& text);
/// The same on what was done earlier: in front of what was said since.
void sayOutcome(const QString& text);
/// How far a run is, in front of all words; empty: it is over.
void sayProgress(const QString& text);

} // namespace quadrille
