// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef QuadrilleClientLoader_h
#define QuadrilleClientLoader_h

/// Puts the drawing tools into ParaView's window; called when the plugin is loaded. The library with the tools lies
/// beside the plugin in the folder Client and is linked with Qt; it is loaded only into programs that have a window, as
/// the plugin itself is also loaded by pvserver and pvpython, which may run where there is no Qt.
void quadrilleLoadClient();

#endif
