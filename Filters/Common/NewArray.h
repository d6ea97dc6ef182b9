// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Arrays of outputs.
#pragma once

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <cstddef>

namespace quadrille
{

/// An array with so many values, all of them still to be set.
template <class Array>
vtkSmartPointer<Array> newArray(const char* name, int components = 1, std::size_t tuples = 0)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(tuples));
  return array;
}

} // namespace quadrille
