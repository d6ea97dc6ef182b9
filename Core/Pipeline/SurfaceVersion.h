// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The same triangles with other features and sizes. A surface of two million faces takes 140 MB, what changes from one
/// size of quads to another, or from one attempt to the next, takes ten: so the stages share the triangles and put on
/// what they need.
#pragma once

#include "Mesh/Surface.h"
#include "Pipeline/Plan.h"
#include "Pipeline/ResultStore.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace quadrille
{

/// Guides, valences and curves, which belong to the run and not to the surface.
struct SurfaceRequests
{
  std::vector<PolygonGuide> polygonGuides;
  std::vector<ValenceRequest> valenceRequests;
  std::size_t unusedValences = 0;
  std::vector<CurveRequest> curves;
  bool regularElsewhere = false;
  std::vector<SectorRequest> sectorRequests;
  bool regularOnFeatures = false;
  std::vector<SeamRequest> seams;
  std::vector<StraightRequest> straight;
};
SurfaceRequests requestsOf(const PreparedSurface& surface);
void putOn(const SurfaceRequests& requests, PreparedSurface& surface);

/// All of a prepared surface that refinement changes where it splits no face.
struct SurfaceMarks
{
  std::vector<std::uint8_t> flags; ///< of the mesh
  std::vector<float> sizing;       ///< of the mesh
  std::uint64_t hash = 0;
  RepairReport repair;
  std::string notice;
  SurfaceRequests requests;

  std::size_t bytes() const;
};
SurfaceMarks marksOf(const PreparedSurface& surface);
void forgetRequests(SurfaceMarks& marks);
void putOn(const SurfaceMarks& marks, PreparedSurface& surface);
std::size_t bytesOf(const Mesh& mesh);
std::size_t bytesOf(const PreparedSurface& surface);

/// The surface that a run works on: sized, with the features and sizes of one plan after the other.
class RunSurface
{
public:
  /// key: of the sized surface, its guides and valences left aside.
  RunSurface(std::shared_ptr<PreparedSurface> surface, ResultKey key, int threads);

  const PreparedSurface& operator*() const { return *surface_; }
  const PreparedSurface* operator->() const { return surface_.get(); }
  const std::shared_ptr<PreparedSurface>& pointer() const { return surface_; }

  /// Puts the sizes of the plan on and takes the features off that it gives up; what another plan has changed is
  /// undone.
  void apply(const Plan& plan);
  /// Of the surface as it is now.
  ResultKey key() const { return planKey_; }
  /// The same, without the sizes of the plan.
  ResultKey keyWithoutSizes() const { return featuresKey_; }
  /// Those without the plan.
  const std::vector<float>& sizesBefore() const
  {
    return before_ ? before_->sizing : surface_->mesh.sizing;
  }
  /// What `act` sees of the surface has these sizes.
  void withSizesBefore(const std::function<void()>& act);
  /// The sizes that `change` makes of those the surface has now, which it keeps. change: may alter the sizing of the
  /// mesh only.
  std::vector<float> changedSizes(const std::function<void(Mesh&)>& change);
  /// The surface's area over its sizes, or over others.
  double sizedArea() const;
  double sizedArea(const std::vector<float>& sizes);

private:
  std::shared_ptr<PreparedSurface> surface_;
  ResultKey key_, planKey_, featuresKey_;
  int threads_;
  std::optional<SurfaceMarks> before_; ///< where a plan has changed something
};

} // namespace quadrille
