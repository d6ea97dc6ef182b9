// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceWrap.h"

#include "Blocks/Blocks.h"
#include "Common/Report.h"
#include "Convert/PolyData.h"
#include "Convert/Soup.h"
#include "Repair/SurfaceWrap.h"

#include "vtkCellData.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <sstream>
#include <string>

vtkStandardNewMacro(vtkSurfaceWrap);

//------------------------------------------------------------------------------
vtkSurfaceWrap::vtkSurfaceWrap() = default;
vtkSurfaceWrap::~vtkSurfaceWrap() = default;

//------------------------------------------------------------------------------
void vtkSurfaceWrap::Execute(quadrille::Block& block)
{
  const quadrille::ConvertedSoup input =
    quadrille::convertSoup(block.input(), this->NumberOfThreads);
  quadrille::WrapOptions options;
  if (this->Alpha > 0)
  {
    options.alpha = this->Alpha;
  }
  if (this->Offset > 0)
  {
    options.offset = this->Offset;
  }
  options.progress = this->MakeProgress(0, 1);
  const quadrille::WrappedSurface wrap = quadrille::wrapSurface(input.soup, options);
  quadrille::requireOk(wrap.status, "the wrap");
  const vtkSmartPointer<vtkPolyData> surface = quadrille::writeTriangleList(wrap.surface);
  for (const std::string& text :
    quadrille::carryFromNearest(block.input(), input, surface, this->NumberOfThreads))
  {
    this->AddWarning(text);
  }
  // From triangle to triangle their borders are jagged, and would be features.
  for (const char* name : { quadrille::arrays::kPatchId, quadrille::arrays::kFeatureEdges })
  {
    if (surface->GetCellData()->HasArray(name))
    {
      surface->GetCellData()->RemoveArray(name);
      this->AddNotice(std::string(name) +
        " is not carried over: on the wrap it would mark jagged borders as features");
    }
  }
  quadrille::addNumber(surface, "WrapAlpha", wrap.alpha);
  quadrille::addNumber(surface, "WrapOffset", wrap.offset);
  block.output()->ShallowCopy(surface);
  std::ostringstream text;
  text << wrap.surface.corners.size() << " triangles, alpha " << wrap.alpha << ", offset "
       << wrap.offset;
  this->SetResult(text.str());
}

//------------------------------------------------------------------------------
void vtkSurfaceWrap::AddSettings(std::ostream& os) const
{
  this->Superclass::AddSettings(os);
  os << "Alpha " << this->Alpha << '\n' << "Offset " << this->Offset << '\n';
}

//------------------------------------------------------------------------------
void vtkSurfaceWrap::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Alpha: " << this->Alpha << "\n";
  os << indent << "Offset: " << this->Offset << "\n";
}
