// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads with a rotational symmetry, see Symmetry/Symmetry.h.
#pragma once

#include "Symmetry/CopiedRun.h"
#include "Symmetry/RotationCut.h"
#include "Symmetry/RotationRequests.h"

#include <optional>

namespace quadrille
{

class RotationRun : public CopiedRun
{
public:
  /// Throws InvalidInput for an order out of its range and an axis without direction.
  RotationRun(const RemeshOptions& options, const RotationRequest& request, ResultStore* store);

protected:
  void choose() override;
  void cut() override;
  std::size_t copies() const override { return static_cast<std::size_t>(order_); }
  ResultKey keyOf(ResultKey of) const override;
  std::vector<CurveOutcome> outcomes(const std::vector<CurveOutcome>& ofPart) const override;
  bool copy() override;

private:
  RotationTask task() const;
  void tellPoles();
  void relocate(const QuadMesh& quads, const std::vector<std::uint8_t>& moved);

  int order_;
  std::optional<RotationAxis> given_; ///< direction: unit
  SurfaceWedge wedge_;                ///< without its input
  WedgeCurves curves_;
};

} // namespace quadrille
