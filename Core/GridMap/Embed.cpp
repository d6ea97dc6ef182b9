// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/Embed.h"

#include "Base/Refuse.h"
#include "GridMap/FieldUntangling.h"
#include "GridMap/LockedMap.h"
#include "GridMap/MapCheck.h"
#include "GridMap/MapShape.h"
#include "Mesh/Sizing.h"
#include "Numerics/Untangler.h"

#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

/// Moving a free vertex does not change the signed area of a map, so it tells the size that the integers
/// were made for, which may differ from the one that was asked.
double lengthOfUnit(
  const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& uv, double edgeLength)
{
  double mapped = 0;
  double area = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    mapped += 2 * mappedArea(uv, f);
    area += areaStretch(field, f) *
      (mesh.sizing.empty() ? mesh.doubleAreaNormal(f).norm() : 2 * sizedArea(mesh, f));
  }
  return mapped > 0 && area > 0 ? std::sqrt(area / mapped) : edgeLength;
}

void failEmbedding(const Mesh& mesh, StatusCode code, const std::string& message,
  const MapDefects& cause, EmbedResult& result)
{
  result.status = { code, "embedding: " + message };
  result.failedAt = verticesOf(mesh, cause);
  result.failedFaces = failedFacesOf(mesh, cause);
  result.inverted = findNotPositive(mesh, result.uv);
}

} // namespace

EmbedResult embedMap(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& integerUv, const EmbedOptions& options)
{
  refuseIf(!(options.edgeLength > 0) || !std::isfinite(options.edgeLength),
    "embedding: the edge length must be positive and finite");
  checkAnisotropyLimit(options.anisotropyLimit);
  report(options.progress, 0, "embedding the map");
  EmbedResult result;
  const LockedMap locked(mesh, field, integerUv);
  const MapDefects hopeless = locked.hopeless();
  if (!hopeless.none())
  {
    result.uv = integerUv;
    failEmbedding(
      mesh, StatusCode::Infeasible, "the integers alone make " + hopeless.text(), hopeless, result);
    return result;
  }
  const UntangleProblem problem =
    locked.problem(lengthOfUnit(mesh, field, integerUv, options.edgeLength));
  const auto snap = [&](const Eigen::VectorXd& y) { return locked.snap(y); };
  FieldUntangling untangled =
    untangleAlongField(mesh, field, problem, locked.start(), snap, options.progress);
  followRequests(mesh, field, problem, options.anisotropyLimit, snap, options.progress, untangled);
  result.uv = std::move(untangled.uv);
  result.newtonSteps = untangled.newtonSteps;
  if (!untangled.defects.none())
  {
    failEmbedding(
      mesh, StatusCode::NotConverged, untangled.defects.text(), untangled.defects, result);
  }
  return result;
}

} // namespace quadrille
