// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Native/Arrays.h"

#include "Base/Refuse.h"
#include "Requests/AskedValues.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace quadrille::native
{

namespace
{

/// The array of this name in the dict; empty where there is none.
template <class Value>
std::vector<Value> valuesOf(const py::dict& surface, const char* name)
{
  return surface.contains(name) ? valuesFrom(surface[name].cast<ArrayOf<Value>>())
                                : std::vector<Value>{};
}

void readGuides(const py::dict& surface, SurfaceInput& input)
{
  if (!surface.contains("guiding_direction"))
  {
    return;
  }
  input.guideDirections = vectorsFrom(surface["guiding_direction"].cast<ArrayOf<double>>());
  input.guideWeights = valuesOf<double>(surface, "guiding_weight");
  for (std::size_t i = 0; i < input.guideDirections.size(); ++i)
  {
    const auto cell = static_cast<std::int64_t>(i);
    requireDirection(cell, input.guideDirections[i]);
    if (!input.guideWeights.empty() && !input.guideDirections[i].isZero(0))
    {
      requireGuideWeight(cell, input.guideWeights[i]);
    }
  }
}

} // namespace

std::vector<Vector3> vectorsFrom(const ArrayOf<double>& array)
{
  if (array.ndim() != 2 || array.shape(1) != 3)
  {
    refuse("an array of points or directions is not n by 3");
  }
  std::vector<Vector3> vectors(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t i = 0; i < vectors.size(); ++i)
  {
    vectors[i] = Vector3(array.data() + 3 * i);
  }
  return vectors;
}

py::array arrayFrom(const std::vector<Vector3>& vectors)
{
  py::array array =
    py::array_t<double>({ static_cast<py::ssize_t>(vectors.size()), py::ssize_t{ 3 } });
  auto* to = static_cast<double*>(array.mutable_data());
  for (const Vector3& vector : vectors)
  {
    std::memcpy(to, vector.data(), 3 * sizeof(double));
    to += 3;
  }
  return array;
}

SurfaceInput surfaceFrom(const py::dict& surface)
{
  SurfaceInput input;
  input.points = vectorsFrom(surface["points"].cast<ArrayOf<double>>());
  const auto offsets = valuesOf<std::int64_t>(surface, "offsets");
  const auto corners = valuesOf<std::int64_t>(surface, "corners");
  if (corners.size() >= kInvalidIndex || input.points.size() >= kInvalidIndex)
  {
    refuse("the mesh has ", corners.size(), " corners and ", input.points.size(),
      " points: that is more than 32-bit ids can name");
  }
  input.polygonOffsets.assign(offsets.begin(), offsets.end());
  input.polygonPoints.assign(corners.begin(), corners.end());
  input.featureEdges = valuesOf<std::uint8_t>(surface, "feature_edges");
  input.patchIds = valuesOf<std::int64_t>(surface, "patch_ids");
  input.isDesigned = surface.contains("designed");
  const auto known = valuesOf<float>(surface, "known_curvature");
  for (std::size_t i = 0; i + 5 < known.size(); i += 6)
  {
    KnownCurvature& own = input.curvatures.emplace_back();
    std::copy_n(known.begin() + static_cast<std::ptrdiff_t>(i), 3, own.atCorner.begin());
    std::copy_n(known.begin() + static_cast<std::ptrdiff_t>(i) + 3, 3, own.alongSide.begin());
  }
  readGuides(surface, input);
  input.targetValences = valuesOf<int>(surface, "target_valence");
  for (std::size_t i = 0; i < input.targetValences.size(); ++i)
  {
    requireValence(static_cast<std::int64_t>(i), input.points[i], input.targetValences[i]);
  }
  const auto sizing = valuesOf<double>(surface, "sizing");
  for (std::size_t i = 0; i < sizing.size(); ++i)
  {
    input.sizing.push_back(requireSize(static_cast<std::int64_t>(i), sizing[i]));
  }
  return input;
}

} // namespace quadrille::native
