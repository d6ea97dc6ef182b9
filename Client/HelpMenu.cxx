// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "HelpMenu.h"

#include "Examples.h"
#include "pqQuadrilleDrawing.h"
#include "pqQuadrilleTutorial.h"

#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>

namespace quadrille
{

void addToHelpMenu(QMainWindow* window, pqQuadrilleDrawing* drawing)
{
  auto* menu = new QMenu("Quadrille", window);
  if (auto* help = window->findChild<QMenu*>("menu_Help"))
  {
    QAction* first = help->actions().value(0);
    help->insertMenu(first, menu);
    help->insertSeparator(first);
  }
  else
  {
    window->menuBar()->addMenu(menu);
  }
  QObject::connect(menu->addAction("Tutorial: A Minute With The Tools"), &QAction::triggered,
    drawing, [window, drawing] { pqQuadrilleTutorial::start(window, drawing); });
  menu->addSeparator();
  const std::vector<QString> names = exampleNames();
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    QObject::connect(menu->addAction("Example: " + names[i]), &QAction::triggered, drawing,
      [i] { openExample(i); });
  }
}

} // namespace quadrille
