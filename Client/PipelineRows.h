// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PipelineRows_h
#define PipelineRows_h

class QObject;

namespace quadrille
{

/// Keeps two things of ParaView's pipeline browser as they are for filters of one input, when a Quad Remesh has others,
/// its constraints: its row stays selected while that moves out from under its input, and in again; and when it is
/// deleted, its surface is shown where it was. And where a state that is loaded leaves nothing selected, a Quad Remesh
/// is, so that the tools can be used. parent: of the connections.
void keepRows(QObject* parent);

} // namespace quadrille

#endif
