// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Undo and redo in ParaView's traces.
#pragma once

class QObject;

namespace quadrille
{

/// ParaView leaves undo and redo out of its traces, so that what a trace makes has what was taken back. From now on a
/// trace that is being recorded gets what they change in the pipeline: sources that go or come again, values of
/// properties, and what is shown. The parent owns what listens.
void traceUndo(QObject* parent);

} // namespace quadrille
