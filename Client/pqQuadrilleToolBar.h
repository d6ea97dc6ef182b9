// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqQuadrilleToolBar_h
#define pqQuadrilleToolBar_h

#include <QToolBar>

/// The drawing tools: a button for each, of which one at most is down.
class pqQuadrilleToolBar : public QToolBar
{
  Q_OBJECT
  typedef QToolBar Superclass;

public:
  explicit pqQuadrilleToolBar(QWidget* parent = nullptr);

private:
  Q_DISABLE_COPY(pqQuadrilleToolBar)
};

#endif
