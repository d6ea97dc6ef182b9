// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Runs/GivenInputs.h"

#include "Common/Stamps.h"
#include "Constraints/Constraints.h"
#include "Convert/ArrayNames.h"
#include "Pipeline/SizedSurface.h"
#include "Prepare/ConstraintPlacement.h"
#include "Runs/InPieces.h"

#include <vtkPolyData.h>

#include <cstdint>
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

/// Of what readSurface depends on.
ResultKey keyOf(const GivenInputs& inputs)
{
  std::vector<Stamp> stamps;
  addStamps(inputs.port(0), stamps);
  KeyMaker key;
  for (const auto& [object, time] : stamps)
  {
    key.add(reinterpret_cast<std::uintptr_t>(object), time);
  }
  return key.add(inputs.patchArray, inputs.guideArray).key();
}

ReadSurface readSurface(const GivenInputs& inputs)
{
  ReadSurface read{ convertSurface(inputs.port(0), inputs.patchArray, inputs.options.threads), {},
    {}, {} };
  if (!inputs.guideArray.empty())
  {
    addGuideArray(inputs.port(0), inputs.guideArray, read.converted);
  }
  return read;
}

/// With as much again for the tree of places, and for the prepared surface of ways between them.
std::size_t bytesWithPlaces(const ReadSurface& read)
{
  constexpr std::size_t kWithPlaces = 3;
  const SurfaceInput& input = read.converted.input;
  return kWithPlaces *
    (input.points.size() * sizeof(Vector3) +
      (input.polygonOffsets.size() + input.polygonPoints.size()) * sizeof(Index));
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
ConvertedSurface readInputs(const GivenInputs& inputs, std::vector<ToldOfInputs>& told,
  AskedConstraints& asked, ResultStore* store, std::shared_ptr<ReadSurface>* read)
{
  vtkPolyData* data = inputs.port(0);
  const int threads = inputs.options.threads;
  tellUnusedArrays(inputs, told);
  const std::shared_ptr<ReadSurface> known = findOrMake<ReadSurface>(
    store, keyOf(inputs), [&] { return readSurface(inputs); }, bytesWithPlaces);
  if (read != nullptr)
  {
    *read = known;
  }
  ConvertedSurface surface = known->converted;
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
  constraints.places = &known->places;
  constraints.threads = threads;
  if (constraints.points || constraints.mixed)
  {
    if (!known->area)
    {
      known->area = areaOfPolygons(surface.input);
      known->diagonal = diagonalOf(surface.input.points);
    }
    constraints.sameWithin =
      kOnePlace * targetEdgeLength(inputs.options, *known->area, *known->diagonal);
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
