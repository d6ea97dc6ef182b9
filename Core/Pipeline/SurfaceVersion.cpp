// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/SurfaceVersion.h"

#include "Mesh/ContentHash.h"
#include "Mesh/FeatureFilter.h"
#include "Mesh/Sizing.h"

#include <utility>

namespace quadrille
{

std::size_t SurfaceMarks::bytes() const
{
  return bytesOf(flags) + bytesOf(sizing) + bytesOf(requests.polygonGuides) +
    bytesOf(requests.valenceRequests);
}

SurfaceRequests requestsOf(const PreparedSurface& surface)
{
  return { surface.polygonGuides, surface.valenceRequests, surface.unusedValences, surface.curves,
    surface.regularElsewhere, surface.sectorRequests, surface.regularOnFeatures, surface.seams,
    surface.straight };
}

void putOn(const SurfaceRequests& requests, PreparedSurface& surface)
{
  surface.polygonGuides = requests.polygonGuides;
  surface.valenceRequests = requests.valenceRequests;
  surface.unusedValences = requests.unusedValences;
  surface.curves = requests.curves;
  surface.regularElsewhere = requests.regularElsewhere;
  surface.sectorRequests = requests.sectorRequests;
  surface.regularOnFeatures = requests.regularOnFeatures;
  surface.seams = requests.seams;
  surface.straight = requests.straight;
}

SurfaceMarks marksOf(const PreparedSurface& surface)
{
  return { surface.mesh.flags, surface.mesh.sizing, surface.hash, surface.repair, surface.notice,
    requestsOf(surface) };
}

void putOn(const SurfaceMarks& marks, PreparedSurface& surface)
{
  surface.mesh.flags = marks.flags;
  surface.mesh.sizing = marks.sizing;
  surface.hash = marks.hash;
  surface.repair = marks.repair;
  surface.notice = marks.notice;
  putOn(marks.requests, surface);
}

std::size_t bytesOf(const Mesh& mesh)
{
  return bytesOf(mesh.position) + bytesOf(mesh.origin) + bytesOf(mesh.twin) + bytesOf(mesh.flags) +
    bytesOf(mesh.sizing);
}

std::size_t bytesOf(const PreparedSurface& surface)
{
  return bytesOf(surface.mesh) + bytesOf(surface.sourcePolygon) + bytesOf(surface.sourcePoints) +
    bytesOf(surface.refinedEntry) + bytesOf(surface.cornerWeights);
}

void forgetRequests(SurfaceMarks& marks)
{
  marks.requests = {};
}

RunSurface::RunSurface(std::shared_ptr<PreparedSurface> surface, ResultKey key, int threads)
  : surface_(std::move(surface)), key_(key), planKey_(key), featuresKey_(key), threads_(threads)
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
  Mesh& mesh = surface_->mesh;
  if (!before_)
  {
    before_ = marksOf(*surface_);
  }
  else
  {
    putOn(*before_, *surface_);
  }
  if (plan.sizes)
  {
    mesh.sizing = *plan.sizes;
  }
  featuresKey_ = key_;
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
    surface_->hash = contentHash(mesh, threads_);
  }
  planKey_ = key;
}

void RunSurface::withSizesBefore(const std::function<void()>& act)
{
  std::vector<float> sizes = sizesBefore();
  std::vector<float>& sizing = surface_->mesh.sizing;
  sizing.swap(sizes);
  try
  {
    act();
  }
  catch (...)
  {
    sizing.swap(sizes);
    throw;
  }
  sizing.swap(sizes);
}

std::vector<float> RunSurface::changedSizes(const std::function<void(Mesh&)>& change)
{
  Mesh& mesh = surface_->mesh;
  std::vector<float> sizes = mesh.sizing;
  change(mesh);
  mesh.sizing.swap(sizes);
  return sizes;
}

double RunSurface::sizedArea() const
{
  return surface_->mesh.sizing.empty() ? surface_->area : quadrille::sizedArea(surface_->mesh);
}

double RunSurface::sizedArea(const std::vector<float>& sizes)
{
  std::vector<float> given = sizes;
  surface_->mesh.sizing.swap(given);
  const double area = sizedArea();
  surface_->mesh.sizing.swap(given);
  return area;
}

} // namespace quadrille
