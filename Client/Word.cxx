// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Word.h"

#include "pqCoreUtilities.h"

#include <QLabel>
#include <QTimer>
#include <QToolBar>

namespace quadrille
{
namespace
{

constexpr int kMessageTime = 30000; // milliseconds
constexpr int kMargin = 8;          // pixels
constexpr const char* kName = "QuadrilleWord";

} // namespace

void addRoomForWords(QToolBar* bar)
{
  auto* label = new QLabel(bar);
  label->setObjectName(kName);
  label->setWordWrap(true);
  label->setContentsMargins(kMargin, 0, 0, 0);
  label->setSizePolicy(
    QSizePolicy::Expanding, QSizePolicy::Ignored); // the bar stays as high as its buttons
  bar->addWidget(label);
  auto* timer = new QTimer(label);
  timer->setSingleShot(true);
  timer->setInterval(kMessageTime);
  QObject::connect(timer, &QTimer::timeout, label, &QLabel::clear);
}

void say(const QString& text)
{
  QWidget* window = pqCoreUtilities::mainWidget();
  if (auto* label = window ? window->findChild<QLabel*>(kName) : nullptr)
  {
    label->setText(text);
    label->setToolTip(text);
    label->findChild<QTimer*>()->start();
  }
}

} // namespace quadrille
