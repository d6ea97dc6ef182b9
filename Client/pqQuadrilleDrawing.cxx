// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqQuadrilleDrawing.h"

#include "Word.h"
#include "pqQuadrilleOverlay.h"
#include "pqQuadrilleRun.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqUndoStack.h"
#include "vtkCommand.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMQuadConstraintProxy.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSourceProxy.h"

#include <QApplication>
#include <QKeyEvent>

#include <algorithm>
#include <cmath>
#include <utility>

namespace
{

using quadrille::NewConstraint;
using quadrille::Pixel;
using quadrille::Place;
using quadrille::say;
using quadrille::sayOutcome;
using Tool = pqQuadrilleDrawing::Tool;

constexpr double kSampleStep = 5;       // pixels between places that are looked for
constexpr double kMostSamples = 120;    // of a line, however long
constexpr std::size_t kSmoothReach = 3; // samples to each side
constexpr double kClick = 6;            // pixels; what is shorter is a click
constexpr double kNearEnd = 10;         // pixels between the ends of a line that closes
constexpr double kLineTolerance = 0.03; // edge lengths that the line may lose by having few points
constexpr double kFarStep = 2;          // edge lengths between places side by side
constexpr std::size_t kMostUnseen = 2;  // samples side by side with which a line goes on
constexpr std::size_t kLeastPlaces = 3; // of a line
constexpr double kBallReach = 14;       // pixels from the centre of a ball
constexpr double kSameBall = 0.5;       // edge lengths
constexpr int kBallsOutput = 4;
constexpr int kConstraintsOutput = 5;
constexpr float kBeforeAllOthers = 10; // priority of observers
constexpr int kWheelPause = 250;       // milliseconds

/// The constraint in words, and as the column Kind of the Constraint Table has it.
struct KindName
{
  const char* source;
  const char* name;
  const char* row;
};

const KindName kKinds[] = {
  { "QuadStroke", "Stroke", "guide stroke" },
  { "QuadValence", "Valence", "valence" },
  { "QuadMove", "Move", "move" },
  { "QuadConnection", "Connection", "connection" },
  { "QuadLoop", "Loop", "cycle" },
  { "QuadFeatureCurve", "Feature", "feature curve" },
  { "QuadClearedFeature", "Cleared feature", "cleared feature" },
  { "QuadSize", "Size", "size" },
};

const KindName& kindOf(const std::string& source)
{
  return *std::find_if(std::begin(kKinds), std::end(kKinds),
    [&source](const KindName& kind) { return source == kind.source; });
}

QString hintOf(Tool tool)
{
  switch (tool)
  {
    case Tool::Stroke:
      return "Stroke: drag over the surface with the left button. Escape ends it.";
    case Tool::Valence:
      return "Valence: click on the surface with the left button; digits and wheel change the "
             "number. Escape ends "
             "it.";
    case Tool::Move:
      return "Move: drag a ball, an irregular vertex, with the left button; onto another one it "
             "joins with it. Escape "
             "ends it.";
    case Tool::Connect:
      return "Connect: click on two balls with the left button, or drag from one to the other. "
             "Escape ends it.";
    case Tool::Loop:
      return "Loop: drag across a body for a loop round it, or back to where the drag began, with "
             "the left button; a loop goes round something. Escape ends it.";
    case Tool::Feature:
      return "Feature: drag over the surface with the left button where edges of the quads are to "
             "run; click on a feature curve to clear it. Escape ends it.";
    case Tool::Size:
      return "Size: drag from a place to as far as quads are to be smaller or larger, with the "
             "left button. Escape ends it.";
    default:
      return {};
  }
}

std::vector<double> coordinatesOf(const std::vector<Place>& places)
{
  std::vector<double> coordinates;
  for (const Place& place : places)
  {
    coordinates.insert(coordinates.end(), place.begin(), place.end());
  }
  return coordinates;
}

bool isIn(QWidget* inner, QWidget* outer)
{
  return inner && outer && (inner == outer || outer->isAncestorOf(inner));
}

} // namespace

pqQuadrilleDrawing::pqQuadrilleDrawing(QObject* parent) : Superclass(parent)
{
  this->ValenceTimer.setSingleShot(true);
  this->ValenceTimer.setInterval(kWheelPause);
  this->Glide.setSingleShot(true);
  this->Glide.setInterval(0);
  QObject::connect(&this->Glide, &QTimer::timeout, this, &pqQuadrilleDrawing::glide);
  QObject::connect(&this->ValenceTimer, &QTimer::timeout, this, &pqQuadrilleDrawing::applyValence);
  QObject::connect(&pqActiveObjects::instance(), &pqActiveObjects::viewChanged, this,
    &pqQuadrilleDrawing::listenTo);
}

pqQuadrilleDrawing::~pqQuadrilleDrawing()
{
  this->stopListening();
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::setTool(Tool tool)
{
  this->stopDrawing();
  this->stopListening();
  this->Last.reset();
  this->FirstBall.reset();
  const bool isOther = this->Current != tool;
  this->Current = tool;
  this->listenTo(pqActiveObjects::instance().activeView());
  qApp->removeEventFilter(this);
  // Where a computer is slow Qt leaves out places where the mouse has been, and lines would cut corners.
  QCoreApplication::setAttribute(Qt::AA_CompressHighFrequencyEvents, tool == Tool::None);
  if (tool != Tool::None)
  {
    qApp->installEventFilter(this);
  }
  this->showOutputs();
  if (isOther)
  {
    say(hintOf(tool));
  }
  Q_EMIT this->toolChanged(tool);
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::listenTo(pqView* view)
{
  this->stopListening();
  auto* renderView = qobject_cast<pqRenderView*>(view);
  if (this->Current == Tool::None || !renderView || !renderView->widget()) // it is being closed
  {
    return;
  }
  this->View = renderView;
  this->Overlay = new pqQuadrilleOverlay(renderView->widget());
  QObject::connect(
    renderView, &pqView::endRender, this->Overlay, [this] { this->showFirstBall(); });
  renderView->widget()->setCursor(Qt::CrossCursor);
  this->Interactor = this->viewProxy()->GetInteractor();
  const auto observe = [this](unsigned long event,
                         bool (pqQuadrilleDrawing::*answer)(vtkObject*, unsigned long, void*))
  {
    this->Observers.push_back(this->Interactor->AddObserver(event, this, answer, kBeforeAllOthers));
  };
  observe(vtkCommand::LeftButtonPressEvent, &pqQuadrilleDrawing::onPress);
  observe(vtkCommand::LeftButtonDoubleClickEvent, &pqQuadrilleDrawing::onPress);
  observe(vtkCommand::MouseMoveEvent, &pqQuadrilleDrawing::onMove);
  observe(vtkCommand::LeftButtonReleaseEvent, &pqQuadrilleDrawing::onRelease);
  observe(vtkCommand::MouseWheelForwardEvent, &pqQuadrilleDrawing::onWheel);
  observe(vtkCommand::MouseWheelBackwardEvent, &pqQuadrilleDrawing::onWheel);
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::stopListening()
{
  for (const unsigned long observer : this->Observers)
  {
    if (this->Interactor)
    {
      this->Interactor->RemoveObserver(observer);
    }
  }
  if (this->View && this->View->widget()) // a view that is being closed has none
  {
    this->View->widget()->unsetCursor();
  }
  this->Observers.clear();
  this->View = nullptr;
  delete this->Overlay;
}

//-----------------------------------------------------------------------------
vtkSMRenderViewProxy* pqQuadrilleDrawing::viewProxy() const
{
  return this->View->getRenderViewProxy();
}

//-----------------------------------------------------------------------------
Pixel pqQuadrilleDrawing::mouse() const
{
  const int* at = this->viewProxy()->GetInteractor()->GetEventPosition();
  return { static_cast<double>(at[0]), static_cast<double>(at[1]) };
}

//-----------------------------------------------------------------------------
double pqQuadrilleDrawing::pixelRatio() const
{
  return this->View->widget()->devicePixelRatioF();
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::showPath()
{
  if (!this->Overlay)
  {
    return;
  }
  QPolygonF path;
  for (const Pixel& pixel : this->Path)
  {
    path << QPointF((pixel[0] + 0.5) / this->pixelRatio(),
      this->Overlay->height() - (pixel[1] + 0.5) / this->pixelRatio());
  }
  this->Overlay->setPath(path);
}

//-----------------------------------------------------------------------------
bool pqQuadrilleDrawing::onPress(vtkObject*, unsigned long, void*)
{
  if (this->IsDrawing)
  {
    return true;
  }
  if (this->IsBusy)
  {
    this->finish(); // on a busy computer the next press comes before
  }
  vtkRenderWindowInteractor* interactor = this->viewProxy()->GetInteractor();
  if (interactor->GetShiftKey() || interactor->GetControlKey() || interactor->GetAltKey())
  {
    return false;
  }
  this->Surface = quadrille::sourceUnder(this->viewProxy(), this->mouse());
  if (!this->Surface)
  {
    return false;
  }
  this->IsDrawing = true;
  this->Last.reset();
  this->Path = { this->mouse() };
  this->showPath();
  if (this->Current == Tool::Move)
  {
    this->grasp();
  }
  return true;
}

//-----------------------------------------------------------------------------
bool pqQuadrilleDrawing::onMove(vtkObject*, unsigned long, void*)
{
  if (!this->IsDrawing)
  {
    return this->IsBusy;
  }
  const Pixel pixel = this->mouse();
  if (pixel != this->Path.back())
  {
    this->Path.push_back(pixel);
    this->showPath();
    if (this->Ball)
    {
      this->Glide.start();
    }
  }
  return true;
}

//-----------------------------------------------------------------------------
bool pqQuadrilleDrawing::onRelease(vtkObject*, unsigned long, void*)
{
  if (!this->IsDrawing)
  {
    return this->IsBusy;
  }
  this->onMove(nullptr, 0, nullptr);
  this->IsDrawing = false;
  this->IsBusy = true;
  QTimer::singleShot(0, this, &pqQuadrilleDrawing::finish);
  return true;
}

//-----------------------------------------------------------------------------
bool pqQuadrilleDrawing::onWheel(vtkObject*, unsigned long event, void*)
{
  if (this->Current != Tool::Valence)
  {
    return this->IsDrawing || this->IsBusy;
  }
  bool isThere = this->IsDrawing;
  if (this->Last)
  {
    const Pixel now = this->mouse();
    isThere = isThere ||
      std::hypot(now[0] - this->Last->Where[0], now[1] - this->Last->Where[1]) <
        kNearEnd * this->pixelRatio();
  }
  if (isThere)
  {
    this->setValence(this->Valence + (event == vtkCommand::MouseWheelForwardEvent ? 1 : -1));
  }
  return isThere || this->IsBusy;
}

//-----------------------------------------------------------------------------
bool pqQuadrilleDrawing::onEscape()
{
  if (QApplication::activeModalWidget() || QApplication::activePopupWidget())
  {
    return false; // theirs
  }
  this->setTool(Tool::None);
  return true;
}

//-----------------------------------------------------------------------------
bool pqQuadrilleDrawing::eventFilter(QObject* watched, QEvent* event)
{
  if (event->type() != QEvent::KeyPress && event->type() != QEvent::ShortcutOverride)
  {
    return this->Superclass::eventFilter(watched, event);
  }
  auto* key = static_cast<QKeyEvent*>(event);
  const bool isPlain = (key->modifiers() & ~Qt::KeypadModifier) == Qt::NoModifier;
  const bool isEscape = isPlain && key->key() == Qt::Key_Escape &&
    !QApplication::activeModalWidget() && !QApplication::activePopupWidget();
  const bool isNumber = isPlain && this->Current == Tool::Valence && this->View &&
    key->key() >= Qt::Key_2 && key->key() <= Qt::Key_8 &&
    isIn(QApplication::focusWidget(), this->View->widget());
  if (!isEscape && this->IsBusy)
  {
    this->finish(); // the key is for what comes of it
  }
  if (!isEscape && !isNumber)
  {
    return this->Superclass::eventFilter(watched, event);
  }
  if (event->type() == QEvent::ShortcutOverride)
  {
    event->accept(); // ParaView has shortcuts of its own on these keys
    return true;
  }
  if (isNumber)
  {
    this->setValence(key->key() - Qt::Key_0);
    return true;
  }
  return this->onEscape();
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::stopDrawing()
{
  this->IsDrawing = false;
  this->letGo();
  this->Path.clear();
  this->showPath();
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::finish()
{
  if (!this->IsBusy)
  {
    return; // done already
  }
  vtkSMSourceProxy* surface = this->Surface;
  if (this->View && surface && !this->Path.empty())
  {
    pqPipelineSource* active = pqActiveObjects::instance().activeSource();
    vtkSMSourceProxy* filter = quadrille::remeshOf(surface, active ? active->getProxy() : nullptr);
    if (!filter)
    {
      say("There is no Quad Remesh of this surface: select it in the pipeline, then press Quad "
          "Remesh in "
          "this tool bar.");
    }
    else if (this->Current == Tool::Valence)
    {
      this->finishValence(filter);
    }
    else if (this->Current == Tool::Size)
    {
      this->finishSize(filter);
    }
    else if (this->Current == Tool::Move)
    {
      this->finishMove(filter);
    }
    else if (this->Current == Tool::Connect)
    {
      this->finishConnection(filter);
    }
    else if (this->Current == Tool::Loop)
    {
      this->finishLoop(filter);
    }
    else
    {
      this->finishLine(filter);
    }
  }
  this->stopDrawing();
  this->IsBusy = false;
  this->showFirstBall();
}

//-----------------------------------------------------------------------------
std::optional<pqQuadrilleDrawing::Line> pqQuadrilleDrawing::drawnLine(
  vtkSMSourceProxy* filter, bool isClosed)
{
  const double length = quadrille::lengthOf(this->Path);
  const double step = std::max(kSampleStep * this->pixelRatio(), length / kMostSamples);
  const std::vector<Pixel> pixels =
    quadrille::smoothPath(quadrille::evenPath(this->Path, step), kSmoothReach, isClosed);
  const double edge = quadrille::edgeLength(filter).value_or(0);
  const std::vector<Place> places = quadrille::longestOnOneSheet(
    quadrille::placesUnder(this->viewProxy(), pixels, this->Surface), kFarStep * edge, kMostUnseen);
  const bool isWhole = places.size() + kMostUnseen >= pixels.size();
  if (isClosed && !isWhole)
  {
    say("The loop leaves the part of the surface that is seen: draw it where all of it is seen.");
    return std::nullopt;
  }
  if (places.size() < kLeastPlaces)
  {
    say("Nothing was drawn: no part of this line is long enough on one side of the surface. Zoom "
        "in or turn the view, and drag along the surface.");
    return std::nullopt;
  }
  Line line;
  for (const std::size_t id : quadrille::keptPlaces(places, kLineTolerance * edge))
  {
    line.places.push_back(places[id]);
  }
  line.isWhole = isWhole;
  return line;
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::finishLine(vtkSMSourceProxy* filter)
{
  if (quadrille::lengthOf(this->Path) < kClick * this->pixelRatio())
  {
    if (this->Current == Tool::Feature)
    {
      this->finishClear(filter);
      return;
    }
    say("That was a click: press, drag along the surface, and release.");
    return;
  }
  const std::optional<Line> line = this->drawnLine(filter, false);
  if (!line)
  {
    return;
  }
  const char* source = this->Current == Tool::Feature ? "QuadFeatureCurve" : "QuadStroke";
  this->perform(filter, { source, { { "Points", coordinatesOf(line->places) } } },
    line->isWhole ? QString()
                  : QString("Only its longest part is drawn, as the mouse passed an outline: turn "
                            "the view to draw the rest."));
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::finishClear(vtkSMSourceProxy* filter)
{
  const std::vector<Place> places = quadrille::placesOnFeatures(filter);
  const double near = kSameBall * quadrille::edgeLength(filter).value_or(0);
  const std::optional<std::size_t> found = quadrille::nearestSeen(this->viewProxy(), this->Surface,
    places, this->Path.back(), kBallReach * this->pixelRatio(), near);
  if (!found)
  {
    say("There is no feature curve here: click on one to clear it, or drag to draw one.");
    return;
  }
  if (vtkSMSourceProxy* drawn = quadrille::featureCurveAt(filter, places[*found], near))
  {
    this->remove(filter, drawn);
    return;
  }
  this->perform(
    filter, { "QuadClearedFeature", { { "Point", coordinatesOf({ places[*found] }) } } });
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::finishLoop(vtkSMSourceProxy* filter)
{
  if (quadrille::lengthOf(this->Path) < kClick * this->pixelRatio())
  {
    say("That was a click: drag across a body, or round something.");
    return;
  }
  if (quadrille::isClosedPath(this->Path, kNearEnd * this->pixelRatio()))
  {
    const std::optional<Line> line = this->drawnLine(filter, true);
    if (line)
    {
      this->perform(filter, { "QuadLoop", { { "Points", coordinatesOf(line->places) } } });
    }
    return;
  }
  // The plane through the line and the eye cuts the body; what is behind cannot be drawn.
  const std::vector<Pixel> pixels =
    quadrille::evenPath(this->Path, kSampleStep * this->pixelRatio());
  std::vector<Place> seen;
  std::vector<Pixel> seenPixels;
  const std::vector<std::optional<Place>> places =
    quadrille::placesUnder(this->viewProxy(), pixels, this->Surface);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    if (places[i])
    {
      seen.push_back(*places[i]);
      seenPixels.push_back(pixels[i]);
    }
  }
  const std::size_t middle = seen.size() / 2;
  std::vector<Place> curve;
  if (seen.size() > 2)
  {
    const Place into = quadrille::directionThrough(this->viewProxy(), seenPixels[middle]);
    Place along;
    for (std::size_t c = 0; c < along.size(); ++c)
    {
      along[c] = seen.back()[c] - seen.front()[c];
    }
    Place normal;
    vtkMath::Cross(along.data(), into.data(), normal.data());
    curve = quadrille::closedCut(this->Surface, seen[middle], normal);
  }
  if (curve.size() < 3)
  {
    say("No loop closes there: drag across a body whose other side closes, or back to where the "
        "drag began.");
    return;
  }
  const double edge = quadrille::edgeLength(filter).value_or(0);
  std::vector<Place> closed = curve;
  closed.push_back(curve.front());
  std::vector<Place> line;
  for (const std::size_t id : quadrille::keptPlaces(closed, kLineTolerance * edge))
  {
    line.push_back(closed[id]);
  }
  line.pop_back();
  this->perform(filter, { "QuadLoop", { { "Points", coordinatesOf(line) } } });
}

//-----------------------------------------------------------------------------
std::optional<Place> pqQuadrilleDrawing::ballAt(
  vtkSMSourceProxy* filter, const Pixel& pixel, const char* ifNone)
{
  const std::vector<Place> balls = quadrille::irregularVertices(filter);
  const double edge = quadrille::edgeLength(filter).value_or(0);
  const std::optional<std::size_t> found = quadrille::nearestSeen(this->viewProxy(), this->Surface,
    balls, pixel, kBallReach * this->pixelRatio(), kSameBall * edge);
  if (!found)
  {
    say(ifNone);
    return std::nullopt;
  }
  return balls[*found];
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::grasp()
{
  pqPipelineSource* active = pqActiveObjects::instance().activeSource();
  vtkSMSourceProxy* filter =
    quadrille::remeshOf(this->Surface, active ? active->getProxy() : nullptr);
  const std::optional<Place> ball = filter
    ? this->ballAt(
        filter, this->Path.front(), "There is no ball here: press on a ball and drag it.")
    : std::nullopt;
  if (ball && !quadrille::isMovable(filter, *ball))
  {
    say(
      "This ball stays, as grey ones do: it is on a feature or boundary, or in a face that has no "
      "map. Drag a coloured one.");
  }
  else if (ball)
  {
    this->Ball = { filter, *ball, quadrille::irregularVertices(filter),
      quadrille::HeldSurface(this->Surface), quadrille::edgeLength(filter).value_or(0), nullptr,
      {} };
  }
}

//-----------------------------------------------------------------------------
std::optional<Place> pqQuadrilleDrawing::placeOfBall() const
{
  std::optional<Place> to = this->Ball->Surface.placeUnder(this->viewProxy(), this->Path.back());
  double least = kSameBall * this->Ball->Edge;
  const std::optional<Place> under = to;
  for (const Place& ball : this->Ball->All)
  {
    const double away =
      under ? std::sqrt(vtkMath::Distance2BetweenPoints(ball.data(), under->data())) : least + 1;
    if (ball != this->Ball->From && away <= least)
    {
      least = away;
      to = ball;
    }
  }
  return to;
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::glide()
{
  // While a preview is being made the mouse moves on; the next one is of where it is then.
  if (!this->IsDrawing || !this->Ball || !this->Ball->Filter || !this->View ||
    pqQuadrilleRun::instance()->isUnderway() ||
    quadrille::lengthOf(this->Path) < kClick * this->pixelRatio())
  {
    return;
  }
  const std::optional<Place> to = this->placeOfBall();
  if (!to || *to == this->Ball->Shown)
  {
    return; // beside the surface it stays where it was last
  }
  this->Ball->Shown = *to;
  if (!this->Ball->Move)
  {
    this->Ball->Move = quadrille::newMove(this->Ball->Filter);
  }
  if (this->Ball->Move &&
    this->Ball->Move->SendPreview(this->Ball->Filter, coordinatesOf({ this->Ball->From, *to })))
  {
    pqQuadrilleRun::instance()->startPreview(this->Ball->Filter,
      [this](pqQuadrilleRun::End how)
      {
        if (how == pqQuadrilleRun::End::Shown)
        {
          this->glide();
        }
      });
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::letGo()
{
  this->Glide.stop();
  const std::optional<DraggedBall> ball = std::exchange(this->Ball, std::nullopt);
  if (!ball || !ball->Move)
  {
    return;
  }
  ball->Move->EndPreview();
  if (ball->Filter)
  {
    pqQuadrilleRun::instance()->startPreview(ball->Filter, // a look-up
      [view = this->View](pqQuadrilleRun::End)
      {
        if (view)
        {
          view->render(); // with smooth edges
        }
      });
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::finishMove(vtkSMSourceProxy* filter)
{
  if (!this->Ball)
  {
    return; // the press has told why
  }
  if (quadrille::lengthOf(this->Path) < kClick * this->pixelRatio())
  {
    say("That was a click: drag the ball to where it is to go.");
    return;
  }
  const std::optional<Place> to = this->placeOfBall();
  if (!to || quadrille::sourceUnder(this->viewProxy(), this->Path.back()) != this->Surface)
  {
    say("The ball was dropped beside the surface: it stays where it was.");
    return;
  }
  const Place from = this->Ball->From;
  if (this->Ball->Move)
  {
    this->Ball->Move->EndPreview();
  }
  this->Ball.reset();
  this->perform(filter,
    { "QuadMove", { { "From", coordinatesOf({ from }) }, { "To", coordinatesOf({ *to }) } } });
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::finishConnection(vtkSMSourceProxy* filter)
{
  const std::optional<Place> ball =
    this->ballAt(filter, this->Path.front(), "There is no ball here: click on a ball.");
  if (!ball)
  {
    return;
  }
  std::vector<Place> line;
  if (quadrille::lengthOf(this->Path) >= kBallReach * this->pixelRatio())
  {
    // A drag says where the line lies.
    const std::optional<Place> end = this->ballAt(filter, this->Path.back(),
      "The drag does not end on a ball: drag from one ball to another one.");
    const std::optional<Line> drawn = end ? this->drawnLine(filter, false) : std::nullopt;
    if (drawn && !drawn->isWhole)
    {
      // From one end to the part that is left the course would be another one than was drawn.
      say("Nothing was drawn: the drag passes an outline, so that a part of its way is not seen. "
          "Turn the view until all of it is seen, or click on the two balls.");
    }
    if (!drawn || !drawn->isWhole)
    {
      return;
    }
    line = drawn->places;
    line.front() = *ball;
    line.back() = *end;
  }
  else if (!this->FirstBall)
  {
    this->FirstBall = ball;
    say("This is the one end: click on the ball at the other end.");
    return;
  }
  else
  {
    line = { *this->FirstBall, *ball };
  }
  this->FirstBall.reset();
  if (line.front() == line.back())
  {
    say("Both ends are the same ball: click on two different ones.");
    return;
  }
  this->perform(filter, { "QuadConnection", { { "Points", coordinatesOf(line) } } });
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::showOutputs()
{
  pqPipelineSource* active = pqActiveObjects::instance().activeSource();
  auto* selected = vtkSMSourceProxy::SafeDownCast(active ? active->getProxy() : nullptr);
  vtkSMSourceProxy* filter = quadrille::remeshOf(selected, selected);
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  if (this->View && filter && controller->GetVisibility(filter, 0, this->viewProxy()))
  {
    const pqScopedUndoExclude noStepOfTheUser;
    controller->SetVisibility(filter, kConstraintsOutput, this->viewProxy(), true);
    if (this->Current == Tool::Move || this->Current == Tool::Connect)
    {
      controller->SetVisibility(filter, kBallsOutput, this->viewProxy(), true);
      this->View->render();
    }
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::showFirstBall()
{
  if (this->FirstBall && this->View && !this->IsDrawing)
  {
    this->Path = { quadrille::pixelOf(this->viewProxy(), *this->FirstBall) };
    this->showPath();
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::finishValence(vtkSMSourceProxy* filter)
{
  const Pixel pixel = this->Path.back();
  const std::optional<Place> place =
    quadrille::placesUnder(this->viewProxy(), { pixel }, this->Surface).front();
  if (!place)
  {
    say("The mouse was not over the surface when the button was released: nothing was asked for.");
    return;
  }
  this->perform(filter,
    { "QuadValence",
      { { "Valence", { static_cast<double>(this->Valence) } },
        { "Point", coordinatesOf({ *place }) } } });
  this->Last = { filter, quadrille::lastConstraint(filter), pixel };
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::finishSize(vtkSMSourceProxy* filter)
{
  if (quadrille::lengthOf(this->Path) < kClick * this->pixelRatio())
  {
    say("That was a click: drag to as far as the size is to reach.");
    return;
  }
  const std::vector<std::optional<Place>> ends = quadrille::placesUnder(
    this->viewProxy(), { this->Path.front(), this->Path.back() }, this->Surface);
  if (!ends[0] || !ends[1])
  {
    say("The drag leaves the surface: begin and end it on the surface.");
    return;
  }
  const double radius =
    std::sqrt(vtkMath::Distance2BetweenPoints(ends[0]->data(), ends[1]->data()));
  this->perform(filter,
    { "QuadSize",
      { { "Factor", { this->SizeFactor } }, { "Radius", { radius } },
        { "Point", coordinatesOf({ *ends[0] }) } } });
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::perform(
  vtkSMSourceProxy* filter, const NewConstraint& constraint, const QString& remark)
{
  BEGIN_UNDO_SET(kindOf(constraint.source).name);
  const bool isMade = quadrille::addConstraint(filter, constraint) != nullptr;
  if (isMade)
  {
    pqQuadrilleRun::prepare(filter);
    this->showQuads(filter);
  }
  END_UNDO_SET();
  if (!isMade)
  {
    say(QString(
      "The server has no %1: load the plugin Quadrille there, too (Tools > Manage Plugins).")
          .arg(constraint.source.c_str()));
    return;
  }
  this->execute(filter, constraint.source, remark);
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::showQuads(vtkSMSourceProxy* filter)
{
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  vtkSMRenderViewProxy* view = this->viewProxy();
  if (!controller->GetVisibility(filter, 0, view) && this->Surface)
  {
    controller->Show(filter, 0, view);
    controller->SetVisibility(this->Surface, 0, view, false);
  }
  controller->SetVisibility(filter, kConstraintsOutput, view, true);
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::execute(
  vtkSMSourceProxy* filter, const std::string& source, const QString& remark)
{
  const vtkWeakPointer<vtkSMSourceProxy> executed = filter;
  pqQuadrilleRun::prepare(filter); // so that what is looked at is what was made before
  const int unmetBefore = quadrille::countUnmet(filter);
  pqQuadrilleRun::instance()->start(filter,
    [this, executed, source, remark, unmetBefore](pqQuadrilleRun::End how)
    {
      if (how == pqQuadrilleRun::End::Stopped)
      {
        pqApplicationCore::instance()->getUndoStack()->undo();
        sayOutcome(QString("%1: stopped, and taken back.").arg(kindOf(source).name));
      }
      else if (how == pqQuadrilleRun::End::Shown && executed)
      {
        this->tellOutcome(executed, source, unmetBefore, remark);
      }
    });
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::tellOutcome(
  vtkSMSourceProxy* filter, const std::string& source, int unmetBefore, const QString& remark)
{
  const KindName& kind = kindOf(source);
  const std::optional<quadrille::ConstraintWord> word = quadrille::wordOnLast(filter, kind.row);
  QString outcome = "no quads were made; Output Messages says why";
  if (word)
  {
    outcome = word->isMet ? QString("met") : QString("not met, ") + word->reason.c_str();
    if (!word->remark.empty())
    {
      outcome += QString(word->isMet ? ", but " : "; ") + word->remark.c_str();
    }
  }
  const int lost = quadrille::countUnmet(filter) - unmetBefore - (word && !word->isMet ? 1 : 0);
  const QString others = lost <= 0 ? QString()
    : lost == 1                    ? QString("Another constraint is not met any more (magenta). ")
                : QString("%1 others are not met any more (magenta). ").arg(lost);
  sayOutcome(QString("%1: %2. %3%4Ctrl+Z takes it back.")
               .arg(kind.name, outcome, remark.isEmpty() ? remark : remark + ' ', others));
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::setValence(int valence)
{
  const int wanted = std::clamp(valence, 2, 8);
  if (wanted == this->Valence)
  {
    return;
  }
  this->Valence = wanted;
  say(QString("Valence %1").arg(wanted));
  if (this->Last)
  {
    this->ValenceTimer.start();
  }
  Q_EMIT this->valenceChanged(wanted);
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::applyValence()
{
  if (!this->Last || !this->Last->Filter || !this->Last->Constraint || !this->View ||
    quadrille::lastConstraint(this->Last->Filter) != this->Last->Constraint)
  {
    return; // it was taken back meanwhile
  }
  BEGIN_UNDO_SET("Valence");
  const bool isOther = quadrille::setNumber(this->Last->Constraint, "Valence", this->Valence);
  END_UNDO_SET();
  if (isOther)
  {
    this->execute(this->Last->Filter, "QuadValence");
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::removeMeant()
{
  pqPipelineSource* active = pqActiveObjects::instance().activeSource();
  auto* selected = vtkSMSourceProxy::SafeDownCast(active ? active->getProxy() : nullptr);
  vtkSMSourceProxy* filter = quadrille::remeshOf(selected, selected);
  vtkSMSourceProxy* meant = filter ? quadrille::constraintMeant(filter, selected) : nullptr;
  if (!meant)
  {
    say(filter ? "This Quad Remesh has no constraint that could be taken away."
               : "Select in the pipeline the constraint that is to go, or its Quad Remesh for the "
                 "last one.");
    return;
  }
  this->remove(filter, meant);
}

//-----------------------------------------------------------------------------
void pqQuadrilleDrawing::remove(vtkSMSourceProxy* filter, vtkSMSourceProxy* constraint)
{
  const QString name = kindOf(constraint->GetXMLName()).name;
  BEGIN_UNDO_SET("Remove " + name);
  quadrille::removeConstraint(filter, constraint);
  END_UNDO_SET();
  pqQuadrilleRun::instance()->start(filter,
    [name](pqQuadrilleRun::End how)
    {
      if (how == pqQuadrilleRun::End::Stopped)
      {
        pqApplicationCore::instance()->getUndoStack()->undo();
        sayOutcome(QString("%1: stopped, and brought back.").arg(name));
      }
      else if (how == pqQuadrilleRun::End::Shown)
      {
        sayOutcome(QString("%1 was taken away. Ctrl+Z brings it back.").arg(name));
      }
    });
}
