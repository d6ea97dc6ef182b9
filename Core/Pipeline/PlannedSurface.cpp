// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/PlannedSurface.h"

#include "Base/Lists.h"
#include "Features/FeatureFilter.h"
#include "Mesh/ContentHash.h"
#include "Mesh/FlatSources.h"
#include "Mesh/Sizing.h"

#include <utility>

namespace quadrille
{
namespace
{

/// Of an array that another one does not share.
template <typename T>
std::size_t ownBytes(const SharedArray<T>& values, const SharedArray<T>* other)
{
  return other != nullptr && values.data() == other->data() ? 0 : bytesOf(values);
}

} // namespace

std::size_t bytesOf(const Mesh& mesh, const Mesh* sharing)
{
  const auto own = [&](auto member)
  { return ownBytes(mesh.*member, sharing != nullptr ? &(sharing->*member) : nullptr); };
  return own(&Mesh::position) + own(&Mesh::origin) + own(&Mesh::twin) + own(&Mesh::flags) +
    own(&Mesh::sizing);
}

std::size_t bytesOf(const PreparedSurface& surface, const PreparedSurface* sharing)
{
  const auto own = [&](auto member)
  { return ownBytes(surface.*member, sharing != nullptr ? &(sharing->*member) : nullptr); };
  return bytesOf(surface.mesh, sharing != nullptr ? &sharing->mesh : nullptr) +
    own(&PreparedSurface::sourcePolygon) + own(&PreparedSurface::sourcePoints) +
    own(&PreparedSurface::refinedEntry) + own(&PreparedSurface::cornerWeights) +
    own(&PreparedSurface::flipped) + own(&PreparedSurface::curvatures) +
    (surface.beforeFlips && (sharing == nullptr || surface.beforeFlips != sharing->beforeFlips)
        ? surface.beforeFlips->bytes()
        : 0);
}

double areaOverSizes(const PreparedSurface& surface)
{
  return surface.mesh.sizing.empty() ? surface.area : sizedArea(surface.mesh);
}

double areaOverSizes(const PreparedSurface& surface, const std::vector<float>& sizes)
{
  if (sizes.empty())
  {
    return surface.area;
  }
  Mesh mesh = surface.mesh;
  mesh.sizing = sizes;
  return sizedArea(mesh);
}

PlannedSurface withoutPlan(std::shared_ptr<const PreparedSurface> surface, ResultKey key)
{
  const SharedArray<float> sizes = surface->mesh.sizing;
  return { std::move(surface), key, key, sizes };
}

SizeWish sizeWish(const PlannedSurface& surface)
{
  return surface->localSizes      ? SizeWish::AtPlaces
    : surface.sizesBefore.empty() ? SizeWish::None
                                  : SizeWish::Everywhere;
}

PlannedSurface withPlan(const PlannedSurface& surface, const Plan& plan)
{
  if (!plan.sizes && !plan.featuresGivenUp && !plan.counterparts)
  {
    return surface;
  }
  PreparedSurface planned = *surface;
  Mesh& mesh = planned.mesh;
  KeyMaker key(surface.key);
  if (plan.featuresGivenUp)
  {
    unmarkFeatures(mesh, *plan.featuresGivenUp);
    key.add(*plan.featuresGivenUp);
    planned.hash = contentHash(mesh, 1);
  }
  if (plan.counterparts)
  {
    append(planned.valenceRequests, *plan.counterparts);
    sortByVertex(planned.valenceRequests);
  }
  const ResultKey keyWithoutSizes = key.key();
  if (plan.sizes)
  {
    mesh.sizing = *plan.sizes;
    key.add(*plan.sizes);
  }
  return { std::make_shared<const PreparedSurface>(std::move(planned)), key.key(), keyWithoutSizes,
    surface.sizesBefore };
}

} // namespace quadrille
