// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMQuadConstraintProxy
 * @brief   a source of a constraint, which finds its Quad Remesh by itself in ParaView's window
 *
 * Four things that save actions in the window; in scripts, where no panel shows the source, none but the first is
 * done:
 *
 * - Where its points are not given, they are put on the box round the surface that is selected, or that the selected
 *   *Quad Remesh* has as its input.
 * - When it is applied after all of its first points were moved, it becomes an input `Constraints` of the *Quad Remesh*
 *   that was selected when it was made, else of the one behind what was selected, else of the last one that was made.
 *   That happens once; with a property `Enabled` a constraint is taken out and put back, and with the window's *Change
 *   Input* it goes for good. Sources of a state file are connected as the file has it.
 * - While a point is dragged and ParaView's *Auto Apply* is on, the *Quad Remesh* behind it follows as a preview (see
 *   its property `Preview`). The values of the properties stay as they are until all is applied, so that an undo goes
 *   back to what was applied before.
 * - ParaView's key 2 moves the last point of a line to the place under the mouse. Where that has been placed already,
 *   the place becomes one more point instead, so that a line of any number of points is drawn by 1 where it begins and
 *   2 at each place after that. ParaView's own ways to more points need Alt+click, which window managers take for
 *   themselves, or a button in the panel, which takes the keys away from the view.
 *
 * A hint `<Points property="Points" shape="line"/>` names a property with coordinates of points. shape says where they
 * are at first: "point" on top of the box, "line" along it, "begin" and "end" of a line of two properties, whose
 * methods are SetPoint1 and SetPoint2.
 *
 * In the XML of the server manager it is the element QuadConstraintProxy.
 */
#ifndef vtkSMQuadConstraintProxy_h
#define vtkSMQuadConstraintProxy_h

#include "QuadrilleServerManagerModule.h" // for the export macro
#include "vtkSMSourceProxy.h"
#include "vtkWeakPointer.h" // for the filter

#include <string> // for names of properties
#include <vector> // for points

class QUADRILLESERVERMANAGER_EXPORT vtkSMQuadConstraintProxy : public vtkSMSourceProxy
{
public:
  static vtkSMQuadConstraintProxy* New();
  vtkTypeMacro(vtkSMQuadConstraintProxy, vtkSMSourceProxy);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Called when properties are applied.
  void UpdateVTKObjects() override;

  /// Called when it comes from a state file, or comes back by an undo or redo.
  int LoadXMLState(vtkPVXMLElement* element, vtkSMProxyLocator* locator) override;

  /// Called when the proxy is made, see vtkSMQuadConstraintPlacement. Properties that were set since then stay.
  void PlaceOnSurface(vtkMTimeType made);

  /// The coordinates of all its points, as the panel shows them, applied or not.
  std::vector<double> GetShownPoints();

  /// Sets all points, also for a trace.
  void SetPoints(const std::vector<double>& coordinates);

  /// The Quad Remesh that has it as a constraint; null where there is none.
  vtkSMProxy* GetFilter() { return this->ConnectedFilter(); }

  /// Lets the next execution of the filter be a preview with other points, which do not become those of the properties,
  /// whether this is one of its constraints or not. Whether the filter has previews. It ends when properties are
  /// applied, or by EndPreview. Whoever executes the filter marks it as modified.
  bool SendPreview(vtkSMProxy* filter, const std::vector<double>& coordinates);
  void EndPreview() { this->EndFollowing(); }

protected:
  vtkSMQuadConstraintProxy();
  ~vtkSMQuadConstraintProxy() override;

  int ReadXMLAttributes(vtkSMSessionProxyManager* manager, vtkPVXMLElement* element) override;

private:
  vtkSMQuadConstraintProxy(const vtkSMQuadConstraintProxy&) = delete;
  void operator=(const vtkSMQuadConstraintProxy&) = delete;

  /// A property that the hints name, and the values that it had at first.
  struct PointsProperty
  {
    std::string Name;
    std::string Shape;
    std::vector<double> First;
    std::vector<double> Shown;  ///< in the panel, applied or not
    std::vector<double> Picked; ///< with one more point; empty: there is none to be shown
  };
  /// Who is told when a view has been drawn.
  struct RenderWait
  {
    vtkWeakPointer<vtkSMProxy> View;
    unsigned long Observer;
  };
  void ReadFirstValues();
  void NoteShown();
  void WaitForRender();
  void StopWaiting();
  void ShowPicked();
  bool IsShown();
  bool IsPlaced();
  void Attach();
  vtkSMProxy* ConnectedFilter();
  void SendPoints(const PointsProperty& points, const std::vector<double>& coordinates);
  void BeginPreview(vtkSMProxy* filter);
  void Join(vtkSMProxy* filter, const char* method);
  bool IsChanging(); ///< what the panel shows is not applied yet
  void Follow();
  void EndFollowing();

  std::vector<PointsProperty> PointsProperties;
  std::vector<RenderWait> Waits;
  vtkWeakPointer<vtkSMProxy> Filter; ///< that it belongs to when it is made
  bool IsAttached = false;           ///< or need not be
  bool IsFollowing = false;
  vtkWeakPointer<vtkSMProxy> Joined; ///< a filter that has it as a constraint for previews only
  bool IsBusy = false;
};

#endif
