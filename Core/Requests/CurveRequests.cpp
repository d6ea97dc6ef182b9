// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/CurveRequests.h"

#include "Base/Error.h"
#include "Base/PlaceText.h"
#include "Mesh/Surface.h"

#include <algorithm>

namespace quadrille
{
namespace
{

std::string nameOfKind(CurveKind kind)
{
  return kind == CurveKind::Cycle ? "cycle" : "connection";
}

} // namespace

std::string curveText(const CurveRequest& curve, std::size_t id)
{
  const std::string name = nameOfKind(curve.kind) + " " + std::to_string(id);
  return curve.kind == CurveKind::Cycle
    ? name + " through " + placeText(curve.points.front())
    : name + " from " + placeText(curve.points.front()) + " to " + placeText(curve.points.back());
}

void checkCurve(const CurveRequest& curve, std::size_t id)
{
  const std::string name = nameOfKind(curve.kind) + " " + std::to_string(id);
  const std::size_t least = curve.kind == CurveKind::Cycle ? 3 : 2;
  if (curve.points.size() < least)
  {
    throw InvalidInput(name + " has " + std::to_string(curve.points.size()) +
      " points, but needs at least " + std::to_string(least) + ": draw more of it.");
  }
  if (!std::all_of(
        curve.points.begin(), curve.points.end(), [](const Vector3& p) { return p.allFinite(); }))
  {
    throw InvalidInput(name + " has a point that is not finite: correct it.");
  }
  if (std::all_of(curve.points.begin(), curve.points.end(),
        [&](const Vector3& p) { return p == curve.points.front(); }))
  {
    throw InvalidInput(
      name + " has all its points at one place: draw it from one place to another.");
  }
}

void checkCurves(const SurfaceInput& input)
{
  for (std::size_t i = 0; i < input.curves.size(); ++i)
  {
    checkCurve(input.curves[i], i);
  }
}

} // namespace quadrille
