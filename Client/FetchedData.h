// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the outputs of a source hold, brought to the client.
#pragma once

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkSmartPointer.h"

#include <functional>

class vtkDataObject;
class vtkSMSourceProxy;

namespace quadrille
{

/// What an output holds, of all ranks; null where it was not made.
vtkSmartPointer<vtkDataObject> fetched(vtkSMSourceProxy* source, int port);

/// Visits the data, or each block of it, that is of the type.
template <class Type>
void forEach(vtkDataObject* data, const std::function<void(Type&)>& visit)
{
  if (auto* single = Type::SafeDownCast(data))
  {
    visit(*single);
  }
  if (auto* blocks = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto iterator = vtk::TakeSmartPointer(blocks->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      forEach<Type>(iterator->GetCurrentDataObject(), visit);
    }
  }
}

} // namespace quadrille
