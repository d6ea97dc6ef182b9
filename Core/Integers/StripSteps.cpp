// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/StripSteps.h"

#include "Base/Lists.h"

#include <algorithm>
#include <cstddef>

namespace quadrille
{

void apply(IntegerMap& map, const Strip& strip)
{
  for (const StripStep& step : strip.steps)
  {
    map.shift(step.halfEdge, step.e);
  }
}

void revert(IntegerMap& map, const Strip& strip)
{
  for (const StripStep& step : strip.steps)
  {
    map.shift(step.halfEdge, -step.e);
  }
}

double applyMeasured(IntegerMap& map, const Strip& strip)
{
  double change = 0;
  for (const StripStep& step : strip.steps)
  {
    change += map.energyChange(step.halfEdge, step.e);
    map.shift(step.halfEdge, step.e);
  }
  return change;
}

CrossedFaces crossedFaces(const UvMesh& mesh, const Strip& strip)
{
  CrossedFaces result;
  std::vector<Index>& faces = result.faces;
  for (const StripStep& step : strip.steps)
  {
    faces.push_back(Mesh::face(step.halfEdge));
    if (mesh.twin[step.halfEdge] != kInvalidIndex)
    {
      faces.push_back(Mesh::face(mesh.twin[step.halfEdge]));
    }
  }
  std::sort(faces.begin(), faces.end());
  // A face that is crossed once is entered once and left once.
  for (std::size_t i = 2; i < faces.size(); ++i)
  {
    result.repeated = result.repeated || faces[i] == faces[i - 2];
  }
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return result;
}

std::vector<Index> facesAround(const UvMesh& mesh, Index v)
{
  std::vector<Index> faces;
  for (const Index h : mesh.star(v))
  {
    faces.push_back(Mesh::face(h));
  }
  sortUnique(faces);
  return faces;
}

} // namespace quadrille
