// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqQuadrilleOverlay_h
#define pqQuadrilleOverlay_h

#include <QPolygonF>
#include <QWidget>

/// What is being drawn, on top of a view. It is seen at once, however long a picture of the surface takes: the camera
/// stands still meanwhile, so the pixels of the mouse are where the line lies on the surface.
class pqQuadrilleOverlay : public QWidget
{
  Q_OBJECT
  typedef QWidget Superclass;

public:
  explicit pqQuadrilleOverlay(QWidget* view);

  /// In pixels of the widget. A path of one pixel is drawn as a ring.
  void setPath(const QPolygonF& path);
  /// Round points that can be dragged.
  void setRings(const QPolygonF& centres);

protected:
  void paintEvent(QPaintEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  Q_DISABLE_COPY(pqQuadrilleOverlay)

  void showWhatThereIs();

  QPolygonF Path;
  QPolygonF Rings;
};

#endif
