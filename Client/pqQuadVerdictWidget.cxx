// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqQuadVerdictWidget.h"

#include "FittedWords.h"
#include "MakeQuads.h"
#include "RemeshConstraints.h"
#include "RemeshProblems.h"
#include "pqQuadrilleRun.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkCommand.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSourceProxy.h"

#include <QApplication>
#include <QEvent>
#include <QFontMetrics>
#include <QLabel>
#include <QLocale>
#include <QPushButton>
#include <QRegularExpression>
#include <QScrollArea>
#include <QTimer>
#include <QVBoxLayout>

#include <algorithm>
#include <string>

namespace
{

enum class Mood
{
  NotRun,
  Well,
  Doubtful,
  Failed
};

constexpr int kPadding = 4; // pixels
/// More would push the number of quads off a panel of a small window; the tool tip has all of it.
constexpr std::size_t kMostLines = 4;

QString styleOf(Mood mood)
{
  const char* colour = mood == Mood::Failed ? "#f6d5d5"
    : mood == Mood::Doubtful                ? "#fbe6c8"
    : mood == Mood::Well                    ? "#d6efd9"
                                            : "transparent";
  return QString("QLabel { background: %1; color: %2; padding: %3px; border-radius: 3px; }")
    .arg(colour, mood == Mood::NotRun ? "palette(text)" : "#202020")
    .arg(kPadding);
}

/// The first sentence of the text, without the breaks that fields of one width need.
QString firstLineOf(QString text)
{
  text.replace(QRegularExpression("\n  +"), " ");
  return text.section('\n', 0, 0);
}

QString textOf(vtkSMProxy* filter, const char* property)
{
  return QString::fromUtf8(vtkSMPropertyHelper(filter, property).GetAsString());
}

} // namespace

pqQuadVerdictWidget::pqQuadVerdictWidget(
  vtkSMProxy* filter, vtkSMProperty* verdict, QWidget* parent)
  : Superclass(filter, parent), Verdict(verdict), Text(new QLabel(this)),
    Show(new QPushButton("Show", this)), Apply(new QPushButton(this))
{
  this->setShowLabel(false);
  this->Text->setObjectName("QuadVerdictText");
  this->Text->setWordWrap(true);
  this->Text->setTextInteractionFlags(Qt::TextSelectableByMouse);
  this->Show->setObjectName("QuadVerdictShow");
  this->Show->setToolTip("Looks at the place from outside; each press shows the next one");
  this->Apply->setObjectName("QuadVerdictApply");
  this->Apply->setToolTip("Sets this property, and makes the quads anew; Ctrl+Z takes it back");
  // Where a button that has the focus goes, the panel would scroll to the next field.
  this->Show->setFocusPolicy(Qt::NoFocus);
  this->Apply->setFocusPolicy(Qt::NoFocus);
  auto* rows = new QVBoxLayout(this);
  rows->setContentsMargins(0, 0, 0, 0);
  rows->addWidget(this->Text);
  rows->addWidget(this->Show, 0, Qt::AlignLeft);
  rows->addWidget(this->Apply, 0, Qt::AlignLeft);
  QObject::connect(this->Show, &QPushButton::clicked, this, &pqQuadVerdictWidget::showNext);
  QObject::connect(this->Apply, &QPushButton::clicked, this, &pqQuadVerdictWidget::applyRemedy);
  for (vtkSMProperty* property : { verdict, filter->GetProperty("Remedy") })
  {
    if (property) // quads of a CAD file have no remedy
    {
      pqCoreUtilities::connect(
        property, vtkCommand::ModifiedEvent, this, SLOT(refresh()), Qt::QueuedConnection);
    }
  }
  this->refresh();
}

//-----------------------------------------------------------------------------
void pqQuadVerdictWidget::apply()
{
  this->Superclass::apply();
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  auto* source = model->findItem<pqPipelineSource*>(this->proxy());
  if (!source || !quadrille::isQuadRemesh(this->proxy()))
  {
    return;
  }
  if (source->modifiedState() != pqProxy::UNINITIALIZED)
  {
    pqQuadrilleRun::instance()->follow(this->filter());
    return;
  }
  // At first ParaView shows what an execution has given, and hides the surface; so it is waited for.
  QTimer::singleShot(0, this,
    [this]
    {
      const pqScopedUndoExclude noStepOfTheUser;
      if (pqView* view = pqActiveObjects::instance().activeView())
      {
        quadrille::leaveColoursOfOneValue(this->filter(), view->getViewProxy());
        view->render();
      }
    });
}

//-----------------------------------------------------------------------------
bool pqQuadVerdictWidget::event(QEvent* event)
{
  if (event->type() == QEvent::EnabledChange && !this->isEnabled())
  {
    this->setEnabled(
      true); // ParaView disables the fields of what only informs, but here are buttons
  }
  if (event->type() == QEvent::Show && !this->Scrolled)
  {
    QWidget* outer = this->parentWidget();
    while (outer && !qobject_cast<QScrollArea*>(outer))
    {
      outer = outer->parentWidget();
    }
    this->Scrolled = qobject_cast<QScrollArea*>(outer);
    if (this->Scrolled)
    {
      this->Scrolled->viewport()->installEventFilter(this);
      this->fit();
    }
  }
  return this->Superclass::event(event);
}

//-----------------------------------------------------------------------------
bool pqQuadVerdictWidget::eventFilter(QObject* watched, QEvent* event)
{
  if (this->Scrolled && watched == this->Scrolled->viewport() && event->type() == QEvent::Resize)
  {
    this->fit();
  }
  return this->Superclass::eventFilter(watched, event);
}

//-----------------------------------------------------------------------------
void pqQuadVerdictWidget::fit()
{
  const int margin = 2 * this->mapTo(this->Scrolled->widget(), QPoint(0, 0)).x();
  const int width =
    std::max(this->Scrolled->viewport()->width() - margin, this->Show->sizeHint().width());
  const QFontMetrics metrics = this->Text->fontMetrics();
  this->Text->setText(QString::fromStdString(quadrille::fittedWords(this->Words.toStdString(),
    kMostLines,
    [&metrics, width](const std::string& line)
    { return metrics.horizontalAdvance(QString::fromStdString(line)) <= width - 2 * kPadding; })));
  this->Text->setMaximumWidth(width);
  this->Text->setMinimumHeight(0); // it would count as the text's
  this->Text->setFixedHeight(this->Text->heightForWidth(width));
}

//-----------------------------------------------------------------------------
vtkSMSourceProxy* pqQuadVerdictWidget::filter() const
{
  return vtkSMSourceProxy::SafeDownCast(this->proxy());
}

//-----------------------------------------------------------------------------
void pqQuadVerdictWidget::refresh()
{
  const QString text = QString::fromUtf8(vtkSMPropertyHelper(this->Verdict).GetAsString());
  const bool isWrong = !text.isEmpty() && quadrille::hasProblems(this->filter());
  const bool isOpen = text.isEmpty() || text.startsWith("Underway");
  const bool isUnmet = !isOpen && quadrille::isQuadRemesh(this->proxy()) &&
    quadrille::hasUnmetConstraints(this->filter());
  const Mood mood = isOpen                            ? Mood::NotRun
    : !textOf(this->proxy(), "OutcomeText").isEmpty() ? Mood::Failed
    : isWrong || isUnmet                              ? Mood::Doubtful
                                                      : Mood::Well;
  this->Words = text.isEmpty() ? QString("Apply tells here what it made.") : firstLineOf(text);
  this->Text->setText(this->Words);
  this->Text->setToolTip(text);
  this->Text->setStyleSheet(styleOf(mood));
  this->Show->setVisible(isWrong);
  const std::optional<quadrille::Remedy> remedy = quadrille::remedyOf(this->filter());
  this->Apply->setVisible(remedy.has_value());
  if (remedy)
  {
    this->Apply->setText(
      QString("Apply: %1 %2")
        .arg(remedy->label.c_str(), QLocale(QLocale::English).toString(remedy->value, 'g', 8)));
  }
  this->Shown = 0;
  if (this->Scrolled)
  {
    this->fit();
  }
}

//-----------------------------------------------------------------------------
void pqQuadVerdictWidget::showNext()
{
  auto* view = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  const std::vector<quadrille::ProblemPlace> places = quadrille::problemPlaces(this->filter());
  if (!view || places.empty())
  {
    if (view)
    {
      view->resetCamera(); // no place is worse than another one
    }
    return;
  }
  BEGIN_UNDO_EXCLUDE();
  quadrille::lookAt(view->getRenderViewProxy(), places[this->Shown++ % places.size()]);
  END_UNDO_EXCLUDE();
  view->render();
}

//-----------------------------------------------------------------------------
void pqQuadVerdictWidget::applyRemedy()
{
  const std::optional<quadrille::Remedy> remedy = quadrille::remedyOf(this->filter());
  if (!remedy)
  {
    return;
  }
  BEGIN_UNDO_SET(this->Apply->text());
  quadrille::apply(this->filter(), *remedy);
  END_UNDO_SET();
  pqQuadrilleRun::instance()->start(this->filter(), pqQuadrilleRun::undoIfStopped);
}
