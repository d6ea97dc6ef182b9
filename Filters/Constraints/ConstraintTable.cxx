// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Constraints/ConstraintTable.h"

#include "Common/NewArray.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <initializer_list>

namespace quadrille
{

std::vector<double> valuesOf(vtkDataArray* array)
{
  std::vector<double> values;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    values.push_back(array->GetComponent(i, 0));
  }
  return values;
}

vtkSmartPointer<vtkTable> writeConstraintTable(const std::vector<ConstraintWord>& words)
{
  auto id = newArray<vtkIdTypeArray>("Id");
  auto kind = newArray<vtkStringArray>("Kind");
  auto source = newArray<vtkIdTypeArray>("SourceId");
  auto x = newArray<vtkDoubleArray>("X");
  auto y = newArray<vtkDoubleArray>("Y");
  auto z = newArray<vtkDoubleArray>("Z");
  auto met = newArray<vtkIntArray>("Met");
  auto deviation = newArray<vtkDoubleArray>("Deviation");
  auto deviation95 = newArray<vtkDoubleArray>("Deviation95");
  auto unit = newArray<vtkStringArray>("Unit");
  auto reason = newArray<vtkStringArray>("Reason");
  auto remark = newArray<vtkStringArray>("Remark");
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    const ConstraintWord& word = words[i];
    id->InsertNextValue(static_cast<vtkIdType>(i));
    kind->InsertNextValue(word.kind);
    source->InsertNextValue(word.source);
    x->InsertNextValue(word.place.x());
    y->InsertNextValue(word.place.y());
    z->InsertNextValue(word.place.z());
    met->InsertNextValue(word.isMet ? 1 : 0);
    deviation->InsertNextValue(word.deviation);
    deviation95->InsertNextValue(word.deviation95);
    unit->InsertNextValue(word.unit);
    reason->InsertNextValue(word.reason);
    remark->InsertNextValue(word.remark);
  }
  auto table = vtkSmartPointer<vtkTable>::New();
  for (vtkAbstractArray* column : std::initializer_list<vtkAbstractArray*>{
         id, kind, source, x, y, z, met, deviation, deviation95, unit, reason, remark })
  {
    table->AddColumn(column);
  }
  return table;
}

} // namespace quadrille
