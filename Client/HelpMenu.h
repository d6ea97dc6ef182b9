// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class pqQuadrilleDrawing;
class QMainWindow;

namespace quadrille
{

/// Puts the tutorial and the examples into the menu Help of the window; where it has none, into one of their own.
void addToHelpMenu(QMainWindow* window, pqQuadrilleDrawing* drawing);

} // namespace quadrille
