// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqQuadrilleDrawing_h
#define pqQuadrilleDrawing_h

#include "DrawnLine.h"
#include "RemeshConstraints.h"
#include "SurfaceUnderMouse.h"

#include "vtkSmartPointer.h"
#include "vtkWeakPointer.h"

#include <QObject>
#include <QPointer>
#include <QTimer>

#include <optional>
#include <string>
#include <vector>

class pqQuadrilleOverlay;
class pqRenderView;
class pqView;
class vtkObject;
class vtkRenderWindowInteractor;
class vtkSMQuadConstraintProxy;
class vtkSMRenderViewProxy;
class vtkSMSourceProxy;

/**
 * Draws constraints on the surface that is seen in the active view.
 *
 * While a tool is on, the plain left mouse button belongs to it where the mouse is over a surface; elsewhere, and with
 * all other buttons and with keys held down, the camera is moved as always. What a press, drag and release has drawn
 * becomes one constraint of the Quad Remesh of that surface, which is executed at once; one undo takes it back.
 */
class pqQuadrilleDrawing : public QObject
{
  Q_OBJECT
  typedef QObject Superclass;

public:
  enum class Tool
  {
    None,
    Stroke,
    Valence,
    Move,
    Connect,
    Loop,
    Feature,
    Size
  };

  explicit pqQuadrilleDrawing(QObject* parent = nullptr);
  ~pqQuadrilleDrawing() override;

  Tool tool() const { return this->Current; }
  int valence() const { return this->Valence; }
  double sizeFactor() const { return this->SizeFactor; }

public Q_SLOTS:
  void setTool(Tool tool);
  /// Of what is clicked next, and of what was clicked last with the tool that is on still; 2 to 8.
  void setValence(int valence);
  /// Of what is dragged next, see QuadSize.
  void setSizeFactor(double factor) { this->SizeFactor = factor; }
  /// Takes away the constraint that is selected in the pipeline, else the one that was made last.
  void removeMeant();

Q_SIGNALS:
  void toolChanged(pqQuadrilleDrawing::Tool tool);
  void valenceChanged(int valence);

protected:
  /// Keys, wherever the focus is.
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  Q_DISABLE_COPY(pqQuadrilleDrawing)

  void listenTo(pqView* view);
  void stopListening();

  // Answers whether the event was for the tool; then nobody else gets it.
  bool onPress(vtkObject*, unsigned long, void*);
  bool onMove(vtkObject*, unsigned long, void*);
  bool onRelease(vtkObject*, unsigned long, void*);
  bool onWheel(vtkObject*, unsigned long event, void*);
  bool onEscape();

  void stopDrawing();
  /// What a drag has drawn becomes a constraint, once the events of the mouse are over.
  void finish();
  struct Line
  {
    std::vector<quadrille::Place> places;
    bool isWhole = true; ///< or else the longest part of what was drawn
  };
  /// A line along what was drawn; none, with a word to the user, where it cannot be had.
  std::optional<Line> drawnLine(vtkSMSourceProxy* filter, bool isClosed);
  void finishLine(vtkSMSourceProxy* filter);
  /// The feature curve at a click is none any more.
  void finishClear(vtkSMSourceProxy* filter);
  void finishLoop(vtkSMSourceProxy* filter);
  void finishValence(vtkSMSourceProxy* filter);
  /// Sizes from where the drag began to as far as it went.
  void finishSize(vtkSMSourceProxy* filter);
  void finishMove(vtkSMSourceProxy* filter);
  void finishConnection(vtkSMSourceProxy* filter);
  /// The irregular vertex that is seen at the pixel, or none.
  std::optional<quadrille::Place> ballAt(
    vtkSMSourceProxy* filter, const quadrille::Pixel& pixel, const char* ifNone);
  /// Takes up the ball under the mouse: the quads follow as a preview while it is dragged.
  void grasp();
  /// Where it is to go: the place under the mouse, or another ball there.
  std::optional<quadrille::Place> placeOfBall() const;
  void glide();
  /// The quads are as they were before.
  void letGo();
  /// Balls, which can be pressed where they are seen, and the constraints, so that their first picture is not made when
  /// something was drawn, in the time that the window stands still then.
  void showOutputs();

  /// remark: told with the outcome.
  void perform(vtkSMSourceProxy* filter, const quadrille::NewConstraint& constraint,
    const QString& remark = {});
  void remove(vtkSMSourceProxy* filter, vtkSMSourceProxy* constraint);
  void applyValence();
  void showQuads(vtkSMSourceProxy* filter);
  /// Makes the quads anew and says what became of the constraint of this source.
  void execute(vtkSMSourceProxy* filter, const std::string& source, const QString& remark = {});
  /// unmetBefore: how many constraints were not met in the quads from before.
  void tellOutcome(
    vtkSMSourceProxy* filter, const std::string& source, int unmetBefore, const QString& remark);

  quadrille::Pixel mouse() const;
  double pixelRatio() const;
  void showPath();
  void showFirstBall();
  vtkSMRenderViewProxy* viewProxy() const;

  Tool Current = Tool::None;
  int Valence = 3;
  double SizeFactor = 0.5;
  QPointer<pqRenderView> View;
  QPointer<pqQuadrilleOverlay> Overlay;
  vtkWeakPointer<vtkRenderWindowInteractor> Interactor; ///< of the view, which may be closed
  std::vector<unsigned long> Observers;

  bool IsDrawing = false;                   ///< the button is down
  bool IsBusy = false;                      ///< what was drawn is being made
  vtkWeakPointer<vtkSMSourceProxy> Surface; ///< that is drawn on
  std::vector<quadrille::Pixel> Path;

  /// A ball that is dragged.
  struct DraggedBall
  {
    vtkWeakPointer<vtkSMSourceProxy> Filter;
    quadrille::Place From;
    std::vector<quadrille::Place> All; ///< balls, as they were when the button was pressed
    quadrille::HeldSurface Surface;    ///< as it was then
    double Edge = 0;                   ///< of the quads
    vtkSmartPointer<vtkSMQuadConstraintProxy>
      Move;                                ///< that previews are made with; null: none was made yet
    std::optional<quadrille::Place> Shown; ///< by the last preview
  };
  std::optional<DraggedBall> Ball;
  QTimer Glide; ///< moves of the mouse come faster than places are found

  std::optional<quadrille::Place> FirstBall; ///< of a connection whose second end is still to come

  /// The valence that was clicked last, which wheel and digits change as long as the mouse stays there.
  struct Clicked
  {
    vtkWeakPointer<vtkSMSourceProxy> Filter;
    vtkWeakPointer<vtkSMSourceProxy> Constraint;
    quadrille::Pixel Where;
  };
  std::optional<Clicked> Last;
  QTimer ValenceTimer; ///< a turn of the wheel is several events
};

#endif
