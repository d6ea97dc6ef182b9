// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqQuadrilleOverlay.h"

#include <QColor>
#include <QEvent>
#include <QPainter>
#include <QPen>

namespace
{

constexpr qreal kRing = 9; // pixels
constexpr qreal kHandle = 7;

const QColor kLine(255, 140, 0); // as the orange of what is asked for in the guide's pictures
const QColor kRim(20, 20, 20, 160);

} // namespace

pqQuadrilleOverlay::pqQuadrilleOverlay(QWidget* view) : Superclass(view)
{
  this->setAttribute(Qt::WA_TransparentForMouseEvents);
  this->setAttribute(Qt::WA_NoSystemBackground);
  this->setFocusPolicy(Qt::NoFocus);
  this->setGeometry(view->rect());
  view->installEventFilter(this);
  this->hide();
}

//-----------------------------------------------------------------------------
void pqQuadrilleOverlay::setPath(const QPolygonF& path)
{
  this->Path = path;
  this->showWhatThereIs();
}

//-----------------------------------------------------------------------------
void pqQuadrilleOverlay::setRings(const QPolygonF& centres)
{
  this->Rings = centres;
  this->showWhatThereIs();
}

//-----------------------------------------------------------------------------
void pqQuadrilleOverlay::showWhatThereIs()
{
  this->setVisible(!this->Path.isEmpty() || !this->Rings.isEmpty());
  this->raise();
  this->update();
}

//-----------------------------------------------------------------------------
void pqQuadrilleOverlay::paintEvent(QPaintEvent*)
{
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  for (const QPen& pen : { QPen(kRim, 5), QPen(kLine, 3) })
  {
    QPen round = pen;
    round.setCapStyle(Qt::RoundCap);
    round.setJoinStyle(Qt::RoundJoin);
    painter.setPen(round);
    for (const QPointF& centre : this->Rings)
    {
      painter.drawEllipse(centre, kHandle, kHandle);
    }
    if (this->Path.size() == 1)
    {
      painter.drawEllipse(this->Path.front(), kRing, kRing);
    }
    else
    {
      painter.drawPolyline(this->Path);
    }
  }
}

//-----------------------------------------------------------------------------
bool pqQuadrilleOverlay::eventFilter(QObject* watched, QEvent* event)
{
  if (event->type() == QEvent::Resize && watched == this->parentWidget())
  {
    this->setGeometry(this->parentWidget()->rect());
  }
  return this->Superclass::eventFilter(watched, event);
}
