// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMQuadConstraintPlacement
 * @brief   puts the first points of a new constraint on the selected surface
 *
 * The hint `<InitializationHelper class="vtkSMQuadConstraintPlacement"/>` of a vtkSMQuadConstraintProxy, which see.
 */
#ifndef vtkSMQuadConstraintPlacement_h
#define vtkSMQuadConstraintPlacement_h

#include "QuadrilleServerManagerModule.h" // for the export macro
#include "vtkSMProxyInitializationHelper.h"

class QUADRILLESERVERMANAGER_EXPORT vtkSMQuadConstraintPlacement
  : public vtkSMProxyInitializationHelper
{
public:
  static vtkSMQuadConstraintPlacement* New();
  vtkTypeMacro(vtkSMQuadConstraintPlacement, vtkSMProxyInitializationHelper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void PostInitializeProxy(vtkSMProxy* proxy, vtkPVXMLElement* hint, vtkMTimeType made) override;

protected:
  vtkSMQuadConstraintPlacement();
  ~vtkSMQuadConstraintPlacement() override;

private:
  vtkSMQuadConstraintPlacement(const vtkSMQuadConstraintPlacement&) = delete;
  void operator=(const vtkSMQuadConstraintPlacement&) = delete;
};

#endif
