// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMQuadNamedArrayDomain
 * @brief   arrays of which the one with the default name is chosen where it is there, and none where it is not
 *
 * ParaView's own domain chooses the active scalars of a file where there is no array of that name. In the XML of the
 * server manager it is the element QuadNamedArrayDomain, with the attributes of ArrayListDomain; none_string is needed.
 */
#ifndef vtkSMQuadNamedArrayDomain_h
#define vtkSMQuadNamedArrayDomain_h

#include "QuadrilleServerManagerModule.h" // for the export macro
#include "vtkSMArrayListDomain.h"

class QUADRILLESERVERMANAGER_EXPORT vtkSMQuadNamedArrayDomain : public vtkSMArrayListDomain
{
public:
  static vtkSMQuadNamedArrayDomain* New();
  vtkTypeMacro(vtkSMQuadNamedArrayDomain, vtkSMArrayListDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The default of the XML where the input has it, or is not known yet; else none.
  int SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues) override;

protected:
  vtkSMQuadNamedArrayDomain();
  ~vtkSMQuadNamedArrayDomain() override;

private:
  vtkSMQuadNamedArrayDomain(const vtkSMQuadNamedArrayDomain&) = delete;
  void operator=(const vtkSMQuadNamedArrayDomain&) = delete;
};

#endif
