// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqQuadrilleTutorial_h
#define pqQuadrilleTutorial_h

#include <QDockWidget>
#include <QPointer>
#include <QTimer>

#include <cstddef>

class pqPipelineSource;
class pqQuadrilleDrawing;
class QLabel;
class QMainWindow;
class vtkSMSourceProxy;

/// A minute with the drawing tools: says above the views what to press, and goes on when that is done. It only looks;
/// what the user does meanwhile is as without it. Closed by its cross, and with its surface.
class pqQuadrilleTutorial : public QDockWidget
{
  Q_OBJECT
  typedef QDockWidget Superclass;

public:
  /// Opens the scan, and the tutorial about it; one that is there already is closed.
  static void start(QMainWindow* window, pqQuadrilleDrawing* drawing);

private:
  Q_DISABLE_COPY(pqQuadrilleTutorial)
  pqQuadrilleTutorial(QMainWindow* window, pqQuadrilleDrawing* drawing, pqPipelineSource* surface);

  void look();
  void say();
  bool isDone() const;
  vtkSMSourceProxy* filter() const;
  unsigned int constraints() const;

  QPointer<pqQuadrilleDrawing> Drawing;
  QPointer<pqPipelineSource> Surface;
  QLabel* Text;
  QTimer Timer;
  std::size_t Current = 0; ///< step
  unsigned int Before = 0; ///< constraints, when this step began
};

#endif
