// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "StatusBar.h"

#include "pqCoreUtilities.h"

#include <QMainWindow>
#include <QStatusBar>

namespace quadrille
{
namespace
{

constexpr int kMessageTime = 30000; // milliseconds

} // namespace

void say(const QString& text)
{
  if (auto* window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget()))
  {
    window->statusBar()->showMessage(text, kMessageTime);
  }
}

} // namespace quadrille
