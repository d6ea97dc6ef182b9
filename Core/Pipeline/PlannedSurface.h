// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The surface of a run with the sizes and features of a plan: a value, which shares its triangles with those of other
/// plans.
#pragma once

#include "CrossField/CrossField.h"
#include "Mesh/Surface.h"
#include "Pipeline/Plan.h"
#include "Pipeline/ResultStore.h"

#include <memory>
#include <vector>

namespace quadrille
{

/// Bytes of the arrays; where `sharing` is given, of those alone that it does not share.
std::size_t bytesOf(const Mesh& mesh, const Mesh* sharing = nullptr);
std::size_t bytesOf(const PreparedSurface& surface, const PreparedSurface* sharing = nullptr);

/// The surface's area over its sizes, or over others.
double areaOverSizes(const PreparedSurface& surface);
double areaOverSizes(const PreparedSurface& surface, const std::vector<float>& sizes);

struct PlannedSurface
{
  std::shared_ptr<const PreparedSurface> surface;
  ResultKey key = 0;              ///< guides and valences left aside
  ResultKey keyWithoutSizes = 0;  ///< as if the plan had no sizes
  SharedArray<float> sizesBefore; ///< those without the plan

  const PreparedSurface& operator*() const { return *surface; }
  const PreparedSurface* operator->() const { return surface.get(); }
};

/// The surface as it is. key: of it.
PlannedSurface withoutPlan(std::shared_ptr<const PreparedSurface> surface, ResultKey key);

/// Where sizes of quads are asked for, whatever the plan has beside.
SizeWish sizeWish(const PlannedSurface& surface);

/// With the sizes and irregular vertices of the plan, without the features that it gives up. surface: without a plan.
PlannedSurface withPlan(const PlannedSurface& surface, const Plan& plan);

} // namespace quadrille
