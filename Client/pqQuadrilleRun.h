// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqQuadrilleRun_h
#define pqQuadrilleRun_h

#include "vtkWeakPointer.h"

#include <QObject>
#include <QPointer>
#include <QTimer>

#include <functional>
#include <vector>

class vtkSMSourceProxy;

/**
 * Executes a Quad Remesh while the window goes on: its run is in a thread of its own (vtkQuadRemesh::InBackground), and
 * a timer looks whether it is over. Then the quads are shown.
 *
 * One filter at a time. What is started for a filter whose run is not over takes the place of that run. Escape stops
 * it. Where a filter cannot run in the background the window waits for it, as for any filter of ParaView.
 */
class pqQuadrilleRun : public QObject
{
  Q_OBJECT
  typedef QObject Superclass;

public:
  /// The one of the window.
  static pqQuadrilleRun* instance();

  enum class End
  {
    Shown,
    Stopped,
    Gone ///< the filter was deleted, or its server left, before: there is nothing to take back
  };
  using Then = std::function<void(End)>;

  /// What is done after a run of one step of the user that says nothing more.
  static void undoIfStopped(End how);

  /// From now on an execution of the filter, by whatever is shown of it, only begins the run that start() then follows.
  static void prepare(vtkSMSourceProxy* filter);

  /// Executes the filter; then: what is done when its quads are shown, or will not be. Where one run takes the
  /// place of another what was to be done after that one is done after this one.
  void start(vtkSMSourceProxy* filter, Then then);
  /// The same for a preview, of which nothing is told, and which Escape does not stop.
  void startPreview(vtkSMSourceProxy* filter, Then then);
  /// What ParaView is about to execute the filter for becomes such a run, too, if it executes it at all.
  void follow(vtkSMSourceProxy* filter);

  bool isUnderway() const { return this->Filter != nullptr; }
  void stop();

protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  Q_DISABLE_COPY(pqQuadrilleRun)
  explicit pqQuadrilleRun(QObject* parent);

  void execute(vtkSMSourceProxy* filter, Then then);
  void look();
  void show();
  void end(End how);
  /// Save Data would write the quads from before: grey while there are others to come.
  void holdSaving();
  void releaseSaving();

  QTimer Timer;
  vtkWeakPointer<vtkSMSourceProxy> Filter; ///< whose run is not over
  std::vector<Then> Waiting;
  bool IsTold = false; ///< in the tool bar

  /// An action for Save Data that is grey.
  struct HeldAction
  {
    QPointer<QObject> Reaction;   ///< ParaView's, which knows whether it is live otherwise
    QMetaObject::Connection Hold; ///< makes it grey again
  };
  std::vector<HeldAction> Saving;
};

#endif
