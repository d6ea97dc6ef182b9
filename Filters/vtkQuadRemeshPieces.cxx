// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadRemesh.h"

#include "Base/Error.h"
#include "Blocks/Blocks.h"
#include "Convert/Quads.h"
#include "Pipeline/Options.h"
#include "Ranks/Spread.h"
#include "Runs/InPieces.h"

#include "vtkPolyData.h"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

//------------------------------------------------------------------------------
std::string vtkQuadRemesh::ReasonForWhole() const
{
  if (this->Symmetry != SYMMETRY_NONE)
  {
    return "symmetric quads need the whole surface";
  }
  if (this->Preview)
  {
    return "a preview has no quads on the surface";
  }
  if (this->Method == METHOD_SEAMLESS)
  {
    return "the method 'seamless' makes no quads";
  }
  if (this->CellDataFrom != CELL_DATA_FROM_CENTRE)
  {
    return "cell data by area need all cells under a quad";
  }
  return {};
}

//------------------------------------------------------------------------------
std::string vtkQuadRemesh::ReasonNotToCut(const quadrille::Block& block) const
{
  const std::string reason = this->ReasonForWhole();
  if (!reason.empty())
  {
    return reason;
  }
  if (this->ComputeMappedSurface)
  {
    return "the mapped surface is that of the whole (Compute Mapped Surface)";
  }
  if (this->FinalQuality == Input)
  {
    return "final quality on the input needs the map of the whole surface";
  }
  if (!this->GetGuideArrayInUse().empty())
  {
    return "directions by an array are those of the whole surface";
  }
  for (std::size_t port = 1; port < block.inputs.size(); ++port)
  {
    vtkPolyData* constraints = block.input(static_cast<int>(port));
    if (constraints && constraints->GetNumberOfPoints() > 0)
    {
      return "constraints are drawn on the whole surface";
    }
  }
  const std::string array = quadrille::constrainingArray(block.input(), this->PatchArrayName);
  return array.empty() ? "" : "the array " + array + " constrains the whole surface";
}

//------------------------------------------------------------------------------
std::unique_ptr<quadrille::TriangleSource> vtkQuadRemesh::TrianglesToCut(
  const quadrille::Block& block, const quadrille::RemeshOptions& options) const
{
  vtkPolyData* input = block.input();
  const auto cells = static_cast<std::size_t>(input->GetNumberOfPolys());
  constexpr std::size_t leastWithLevels = 10000000; // what is held of the whole would be gigabytes
  if (this->Pieces == PIECES_NEVER || quadrille::isJoined(input) ||
    (this->Pieces == PIECES_AUTOMATIC &&
      cells < (this->KeepLevels ? leastWithLevels : quadrille::kTrianglesWorthPieces)))
  {
    return nullptr;
  }
  std::string reason = this->ReasonNotToCut(block);
  std::unique_ptr<quadrille::TriangleSource> triangles;
  if (reason.empty())
  {
    triangles = quadrille::trianglesOf(input);
    reason = triangles ? ""
                       : "it has polygons that are no triangles, or points that are not float "
                         "or double";
  }
  if (this->Pieces == PIECES_AUTOMATIC)
  {
    return triangles && quadrille::isWorthPieces(*triangles, options) ? std::move(triangles)
                                                                      : nullptr;
  }
  if (!triangles)
  {
    throw quadrille::InvalidInput(
      "the surface cannot be cut into pieces: " + reason + "; set Pieces to Automatic or Never");
  }
  return triangles;
}

//------------------------------------------------------------------------------
bool vtkQuadRemesh::IsWorthThinning(
  const quadrille::Block& block, const quadrille::RemeshOptions& options) const
{
  vtkPolyData* input = block.input();
  if (this->Pieces != PIECES_AUTOMATIC || this->KeepLevels || quadrille::isJoined(input) ||
    static_cast<std::size_t>(input->GetNumberOfPolys()) < quadrille::kTrianglesWorthThinning ||
    !this->ReasonNotToCut(block).empty())
  {
    return false;
  }
  const std::unique_ptr<quadrille::TriangleSource> triangles = quadrille::trianglesOf(input);
  return triangles && quadrille::isWorthThinning(*triangles, options);
}

//------------------------------------------------------------------------------
std::string vtkQuadRemesh::ReasonNotToSpread(
  const std::vector<vtkSmartPointer<vtkPolyData>>& pieces) const
{
  const std::string reason = this->ReasonForWhole();
  return reason.empty() ? quadrille::reasonNotToSpread(pieces, this->GetGuideArrayInUse()) : reason;
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::PlanSpread(const quadrille::Block& block, const quadrille::SpreadSize& size,
  quadrille::SpreadPlan& plan) const
{
  quadrille::RemeshOptions options = this->MakeOptions(block);
  this->SetSizes(options);
  plan.piece = quadrille::pieceOptionsOf(options, size.area, size.diagonal);
  plan.patchArray = this->PatchArrayName;
  plan.guideArray = this->GetGuideArrayInUse();
  plan.memoryLimit = 1e6 * this->MemoryLimit;
}
