// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace quadrille
{

/// Lets ParaView's window show the plugin's help pages; to be called when there is a window. In Qt 6 a help engine only
/// reads its collection unless it is told otherwise, and ParaView 5.13 adds the pages of plug-ins to a collection
/// without having told it so, which fails without a word (later versions tell it). Nothing is done in programs without
/// a window, with Qt 5, and where those functions are not there.
void allowHelpPages();

} // namespace quadrille
