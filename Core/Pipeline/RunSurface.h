// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The surface that attempts work on, with the sizes and features of one plan after the other. Each is a value, which
/// shares its triangles with the others: none is changed after it was made.
#pragma once

#include "Mesh/Surface.h"
#include "Pipeline/Plan.h"
#include "Pipeline/ResultStore.h"

#include <functional>
#include <memory>
#include <vector>

namespace quadrille
{

/// Bytes of the arrays; where `sharing` is given, of those alone that it does not share.
std::size_t bytesOf(const Mesh& mesh, const Mesh* sharing = nullptr);
std::size_t bytesOf(const PreparedSurface& surface, const PreparedSurface* sharing = nullptr);

class RunSurface
{
public:
  /// key: of the sized surface, its guides and valences left aside.
  RunSurface(std::shared_ptr<const PreparedSurface> surface, ResultKey key, int threads);

  const PreparedSurface& operator*() const { return *planned_; }
  const PreparedSurface* operator->() const { return planned_.get(); }

  const std::shared_ptr<const PreparedSurface>& pointer() const { return planned_; }

  /// Goes on with the surface that the plan asks for: with its sizes, without the features that it gives up.
  void apply(const Plan& plan);
  /// Goes on with the same surface without a plan and with other requests.
  void setRequests(std::shared_ptr<const PreparedSurface> surface);
  /// Of the surface with the plan.
  ResultKey key() const { return planKey_; }
  /// The same, without the sizes of the plan.
  ResultKey keyWithoutSizes() const { return featuresKey_; }
  /// The sizes without the plan.
  const SharedArray<float>& sizesBefore() const { return given_->mesh.sizing; }
  /// The mesh with the features of the plan and the sizes without it.
  Mesh meshWithSizesBefore() const;
  /// The sizes that `change` makes of those of the plan. change: may alter the sizing of the mesh only.
  std::vector<float> changedSizes(const std::function<void(Mesh&)>& change) const;
  /// The surface's area over its sizes, or over others.
  double sizedArea() const;
  double sizedArea(const std::vector<float>& sizes) const;

private:
  std::shared_ptr<const PreparedSurface> given_, planned_;
  ResultKey key_, planKey_, featuresKey_;
  int threads_;
};

} // namespace quadrille
