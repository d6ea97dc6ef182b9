// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMQuadPickProxy
 * @brief   ParaView's picks of places, for those who must know that a place comes from a key and not from a drag
 *
 * In the XML of the server manager it is the element QuadPickProxy, of vtkQuadSurfacePick.
 */
#ifndef vtkSMQuadPickProxy_h
#define vtkSMQuadPickProxy_h

#include "QuadrilleServerManagerModule.h" // for the export macro
#include "vtkSMProxy.h"

#include <vector> // for places

class QUADRILLESERVERMANAGER_EXPORT vtkSMQuadPickProxy : public vtkSMProxy
{
public:
  static vtkSMQuadPickProxy* New();
  vtkTypeMacro(vtkSMQuadPickProxy, vtkSMProxy);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  using vtkSMProxy::UpdatePropertyInformation;
  /// Called when the place that was picked is asked for.
  void UpdatePropertyInformation(vtkSMProperty* property) override;

  /// Whether the coordinates are those of the last pick, which is forgotten then: each counts once.
  static bool TakeLastPlace(const std::vector<double>& place);

protected:
  vtkSMQuadPickProxy();
  ~vtkSMQuadPickProxy() override;

private:
  vtkSMQuadPickProxy(const vtkSMQuadPickProxy&) = delete;
  void operator=(const vtkSMQuadPickProxy&) = delete;
};

#endif
