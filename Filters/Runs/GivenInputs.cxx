// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Runs/GivenInputs.h"

#include "Constraints/Constraints.h"
#include "Convert/ArrayNames.h"
#include "Pipeline/SizedSurface.h"
#include "Prepare/ConstraintPlacement.h"
#include "Runs/InPieces.h"

#include <vtkPolyData.h>

#include <utility>

namespace quadrille
{

namespace
{

void tellUnusedArrays(const GivenInputs& inputs, std::vector<ToldOfInputs>& told)
{
  const auto warn =
    [&](std::size_t port, const char* name, const std::vector<quadrille::ReadArray>& read)
  {
    if (vtkPolyData* data = inputs.port(port))
    {
      for (const std::string& notice : arrayNotices(data, name, read))
      {
        told.push_back({ notice, true });
      }
    }
  };
  warn(0, "the surface", surfaceArrays(inputs.patchArray));
  warn(1, "the feature curves", lineArrays());
  warn(2, "the guiding strokes", lineArrays());
  warn(3, "the valence points", pointArrays());
  std::vector<ReadArray> all = lineArrays();
  for (const ReadArray& array : pointArrays())
  {
    all.push_back(array);
  }
  warn(6, "the constraints", all);
  for (const std::string& notice : partnerNotices(inputs.port(0), inputs.port(1), inputs.port(2)))
  {
    told.push_back({ notice, true });
  }
}

void tellIgnored(const ConvertedSurface& surface, std::vector<ToldOfInputs>& told)
{
  if (surface.ignoredCells > 0)
  {
    told.push_back(
      { std::to_string(surface.ignoredCells) + " vertex and line cells are not used", false });
  }
}

} // namespace

//------------------------------------------------------------------------------
void GivenInputs::detach()
{
  for (vtkSmartPointer<vtkPolyData>& port : ports)
  {
    if (!port)
    {
      continue;
    }
    const auto own = vtkSmartPointer<vtkPolyData>::New();
    own->ShallowCopy(port);
    port = own;
  }
}

//------------------------------------------------------------------------------
ConvertedSurface readInputs(
  const GivenInputs& inputs, std::vector<ToldOfInputs>& told, AskedConstraints& asked)
{
  vtkPolyData* data = inputs.port(0);
  const int threads = inputs.options.threads;
  tellUnusedArrays(inputs, told);
  ConvertedSurface surface = convertSurface(data, inputs.patchArray, threads);
  if (!inputs.guideArray.empty())
  {
    addGuideArray(data, inputs.guideArray, surface);
  }
  tellIgnored(surface, told);
  ConstraintInputs constraints;
  constraints.curves = inputs.port(1);
  constraints.strokes = inputs.port(2);
  constraints.points = inputs.port(3);
  constraints.connections = inputs.port(4);
  constraints.cycles = inputs.port(5);
  constraints.mixed = inputs.port(6);
  constraints.surface = data;
  constraints.strokeWeight = inputs.strokeWeight;
  constraints.strokeRadius = inputs.strokeRadius;
  constraints.valence = inputs.pointValence;
  constraints.threads = threads;
  if (constraints.points || constraints.mixed)
  {
    constraints.sameWithin = kOnePlace *
      targetEdgeLength(inputs.options, areaOfPolygons(surface.input), diagonalOf(surface.input));
  }
  asked.arrays =
    arrayConstraints(surface.input, [&surface](Index polygon) { return surface.cell(polygon); });
  PlacedConstraints result = applyConstraints(surface, constraints);
  for (const std::string& notice : result.notices)
  {
    told.push_back({ notice, true });
  }
  asked.placed = std::move(result.placed);
  return surface;
}

//------------------------------------------------------------------------------
ConvertedSurface readForPieces(const GivenInputs& inputs, std::vector<ToldOfInputs>& told)
{
  tellUnusedArrays(inputs, told);
  ConvertedSurface surface = polygonsOf(inputs.port(0));
  tellIgnored(surface, told);
  return surface;
}

} // namespace quadrille
