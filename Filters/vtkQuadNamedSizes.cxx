// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadNamedSizes.h"

#include "Base/Lists.h"
#include "Files/NamedSizes.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <exception>
#include <new>
#include <vector>

vtkStandardNewMacro(vtkQuadNamedSizes);

//------------------------------------------------------------------------------
vtkQuadNamedSizes::vtkQuadNamedSizes() = default;
vtkQuadNamedSizes::~vtkQuadNamedSizes() = default;

//------------------------------------------------------------------------------
void vtkQuadNamedSizes::SetSizes(const char* sizes)
{
  const std::string text = sizes ? sizes : "";
  if (text != this->Sizes)
  {
    this->Sizes = text;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkQuadNamedSizes::AddSize(const char* name, const char* factor)
{
  this->SetSizes((this->Sizes + name + "=" + factor + "\n").c_str());
}

//------------------------------------------------------------------------------
int vtkQuadNamedSizes::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

//------------------------------------------------------------------------------
/// Of all blocks together, as a name that one block lacks may be in another one.
void vtkQuadNamedSizes::Execute(vtkDataObject* input, vtkDataObject* output) const
{
  output->ShallowCopy(input);
  const std::vector<quadrille::NamedSize> sizes = quadrille::namedSizesOf(this->Sizes);
  if (sizes.empty())
  {
    return;
  }
  std::vector<bool> isUsed(sizes.size(), false);
  std::vector<std::string> names;
  const auto sized = [&](vtkPolyData* surface, const std::string& prefix)
  {
    quadrille::NamedParts parts(quadrille::namedSurface(surface), prefix);
    parts.ask(sizes, isUsed);
    quadrille::append(names, parts.names());
    return quadrille::sizedPolyData(parts.sized(), surface);
  };
  if (auto* surface = vtkPolyData::SafeDownCast(input))
  {
    output->ShallowCopy(sized(surface, ""));
  }
  else if (auto* blocks = vtkCompositeDataSet::SafeDownCast(input))
  {
    auto* results = vtkCompositeDataSet::SafeDownCast(output);
    const auto at = vtk::TakeSmartPointer(blocks->NewIterator());
    for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
    {
      if (auto* leaf = vtkPolyData::SafeDownCast(at->GetCurrentDataObject()))
      {
        const char* name = at->HasCurrentMetaData()
          ? at->GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME())
          : nullptr;
        results->SetDataSet(at, sized(leaf, name ? std::string(name) + "/" : ""));
      }
    }
  }
  quadrille::refuseUnknownNames(sizes, isUsed, names);
}

//------------------------------------------------------------------------------
int vtkQuadNamedSizes::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->OutcomeText.clear();
  vtkDataObject* output = vtkDataObject::GetData(outputs, 0);
  try
  {
    this->Execute(vtkDataObject::GetData(inputs[0], 0), output);
    return 1;
  }
  catch (const std::bad_alloc&)
  {
    this->OutcomeText = "there is not enough memory";
  }
  catch (const std::exception& error)
  {
    this->OutcomeText = error.what();
  }
  output->Initialize();
  vtkErrorMacro(<< this->OutcomeText);
  return 0;
}

//------------------------------------------------------------------------------
void vtkQuadNamedSizes::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Sizes: " << this->Sizes << "\n";
  os << indent << "OutcomeText: " << this->OutcomeText << "\n";
}
