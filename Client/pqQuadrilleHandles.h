// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqQuadrilleHandles_h
#define pqQuadrilleHandles_h

#include "DrawnLine.h"
#include "SurfaceUnderMouse.h"

#include "vtkWeakPointer.h"

#include <QObject>
#include <QPointer>
#include <QTimer>

#include <optional>
#include <vector>

class pqPipelineSource;
class pqQuadrilleOverlay;
class pqRenderView;
class pqView;
class vtkObject;
class vtkRenderWindowInteractor;
class vtkSMQuadConstraintProxy;
class vtkSMRenderViewProxy;
class vtkSMSourceProxy;

/**
 * The points of the constraint that is selected in the pipeline, as rings in front of everything, where they are.
 *
 * The plain left mouse button on a ring drags the point over the surface that is seen: it never leaves it. Meanwhile
 * the quads follow as a preview; the button released, they are made.
 */
class pqQuadrilleHandles : public QObject
{
  Q_OBJECT
  typedef QObject Superclass;

public:
  explicit pqQuadrilleHandles(QObject* parent = nullptr);
  ~pqQuadrilleHandles() override;

private:
  Q_DISABLE_COPY(pqQuadrilleHandles)

  void watch(pqPipelineSource* source);
  void watchView(pqView* view);
  void stopWatching();
  void showRings();

  // Answers whether the event was for a ring; then nobody else gets it.
  bool onPress(vtkObject*, unsigned long, void*);
  bool onMove(vtkObject*, unsigned long, void*);
  bool onRelease(vtkObject*, unsigned long, void*);

  /// Takes up the point whose ring is under the mouse, where it is not behind what is seen.
  std::optional<std::size_t> grasp(vtkSMSourceProxy* filter);
  void glide();
  void finish();

  quadrille::Pixel mouse() const;
  double pixelRatio() const;
  vtkSMRenderViewProxy* viewProxy() const;

  vtkWeakPointer<vtkSMQuadConstraintProxy> Constraint;
  QPointer<pqRenderView> View;
  QPointer<pqQuadrilleOverlay> Overlay;
  vtkWeakPointer<vtkRenderWindowInteractor> Interactor; ///< of the view, which may be closed
  std::vector<unsigned long> Observers;

  std::vector<quadrille::Place> Points;
  std::optional<std::size_t> Dragged;
  std::optional<quadrille::HeldSurface>
    Surface; ///< that it glides on, as it was when it was pressed
  bool HasMoved = false;
  bool IsBusy = false;    ///< what was dragged is being applied
  bool IsReleased = true; ///< the button
  QTimer Glide;           ///< moves of the mouse come faster than places are found
};

#endif
