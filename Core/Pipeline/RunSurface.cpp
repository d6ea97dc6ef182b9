// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/RunSurface.h"

#include "Features/FeatureFilter.h"
#include "Mesh/ContentHash.h"
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
    own(&PreparedSurface::refinedEntry) + own(&PreparedSurface::cornerWeights);
}

RunSurface::RunSurface(std::shared_ptr<const PreparedSurface> surface, ResultKey key, int threads)
  : given_(surface), planned_(std::move(surface)), key_(key), planKey_(key), featuresKey_(key),
    threads_(threads)
{
}

void RunSurface::apply(const Plan& plan)
{
  const bool asItWas = !plan.sizes && !plan.featuresGivenUp && !plan.moved;
  const ResultKey key = asItWas ? key_ : KeyMaker(key_).add(plan.surfaceKey()).key();
  if (key == planKey_)
  {
    return;
  }
  planKey_ = key;
  featuresKey_ = key_;
  if (asItWas)
  {
    planned_ = given_;
    return;
  }
  PreparedSurface planned = *given_;
  Mesh& mesh = planned.mesh;
  if (plan.sizes)
  {
    mesh.sizing = *plan.sizes;
  }
  if (plan.moved)
  {
    markYielding(mesh, plan.moved->on);
    unmarkFeatures(mesh, plan.moved->off);
    featuresKey_ = KeyMaker(featuresKey_).add(plan.moved->off).add(plan.moved->on).key();
  }
  if (plan.featuresGivenUp)
  {
    unmarkFeatures(mesh, *plan.featuresGivenUp);
    featuresKey_ = KeyMaker(featuresKey_).add(*plan.featuresGivenUp).key();
  }
  if (plan.moved || plan.featuresGivenUp)
  {
    planned.hash = contentHash(mesh, threads_);
  }
  planned_ = std::make_shared<const PreparedSurface>(std::move(planned));
}

void RunSurface::setRequests(std::shared_ptr<const PreparedSurface> surface)
{
  given_ = planned_ = std::move(surface);
  planKey_ = featuresKey_ = key_;
}

Mesh RunSurface::meshWithSizesBefore() const
{
  Mesh mesh = planned_->mesh;
  mesh.sizing = given_->mesh.sizing;
  return mesh;
}

std::vector<float> RunSurface::changedSizes(const std::function<void(Mesh&)>& change) const
{
  Mesh mesh = planned_->mesh;
  change(mesh);
  return mesh.sizing.take();
}

double RunSurface::sizedArea() const
{
  return planned_->mesh.sizing.empty() ? planned_->area : quadrille::sizedArea(planned_->mesh);
}

double RunSurface::sizedArea(const std::vector<float>& sizes) const
{
  if (sizes.empty())
  {
    return planned_->area;
  }
  Mesh mesh = planned_->mesh;
  mesh.sizing = sizes;
  return quadrille::sizedArea(mesh);
}

} // namespace quadrille
