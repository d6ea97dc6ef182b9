// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqQuadVerdictWidget_h
#define pqQuadVerdictWidget_h

#include "pqPropertyWidget.h"

#include <QPointer>
#include <QString>

#include <cstddef>

class QLabel;
class QPushButton;
class QScrollArea;
class vtkSMSourceProxy;

/// The verdict on the last execution of Quad Remesh, or of Quad Nodes On CAD Geometry, in the panel: in words and
/// colour, with a button that shows what is wrong, a place at each press, and one that sets the property that mends it
/// and makes the quads anew.
class pqQuadVerdictWidget : public pqPropertyWidget
{
  Q_OBJECT
  typedef pqPropertyWidget Superclass;

public:
  pqQuadVerdictWidget(vtkSMProxy* filter, vtkSMProperty* verdict, QWidget* parent = nullptr);

  /// ParaView's button Apply, and Auto Apply: the quads are made beside the window.
  void apply() override;

protected:
  bool event(QEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

private Q_SLOTS:
  void refresh();

private:
  Q_DISABLE_COPY(pqQuadVerdictWidget)

  vtkSMSourceProxy* filter() const;
  /// ParaView lets fields be wider than the panel, which scrolls then; a text that has to be read may not be.
  void fit();
  void showNext();
  void applyRemedy();

  vtkSMProperty* Verdict;
  QPointer<QScrollArea> Scrolled; ///< the panel
  QString Words;                  ///< of which the text shows what has room
  QLabel* Text;
  QPushButton* Show;
  QPushButton* Apply;
  std::size_t Shown = 0; ///< places, since the last execution
};

#endif
