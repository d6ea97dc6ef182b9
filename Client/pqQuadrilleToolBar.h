// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqQuadrilleToolBar_h
#define pqQuadrilleToolBar_h

#include <QList>
#include <QString>
#include <QTimer>
#include <QToolBar>

class pqQuadrilleDrawing;
class QAction;
class QDoubleSpinBox;
class QSpinBox;

/// A button that makes quads of what is selected in the pipeline, and the drawing tools: a button for each, of which
/// one at most is down. Buttons that can do nothing now are grey, and their tool tips say why.
class pqQuadrilleToolBar : public QToolBar
{
  Q_OBJECT
  typedef QToolBar Superclass;

public:
  explicit pqQuadrilleToolBar(QWidget* parent = nullptr);

  pqQuadrilleDrawing* drawing() const { return this->Drawing; }

private:
  Q_DISABLE_COPY(pqQuadrilleToolBar)

  QAction* add(const QString& name, const QString& help);
  void addTools();
  void addValence();
  void addSize();
  void watchPipeline();
  /// Which buttons can do something.
  void refresh();
  void makeQuads();

  pqQuadrilleDrawing* Drawing;
  QAction* Remesh;
  QList<QAction*> Tools;
  QAction* Remove = nullptr;
  QSpinBox* Valence = nullptr;
  QDoubleSpinBox* Size = nullptr;
  QTimer Refresh; ///< the pipeline changes in several steps
};

#endif
