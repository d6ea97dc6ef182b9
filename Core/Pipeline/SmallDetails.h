// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What of the surface is smaller than the quads, where, and what becomes of it.
#pragma once

#include "Base/Types.h"
#include "Pipeline/Options.h"

#include <cstddef>
#include <string>
#include <vector>

namespace quadrille
{

enum class DetailKind
{
  Handle,       ///< a loop round or through it; its length
  BoundaryLoop, ///< its length
  Component,    ///< connected; the square root of its area
  ThinPart      ///< behind a short loop that cuts the surface in two; the loop's length
};

enum class DetailDecision
{
  Resolve,  ///< quads are smaller there
  Simplify, ///< taken out of the surface, or made the smallest block of quads
  Keep      ///< as it is, with quads of the size that was asked for
};

struct SmallDetail
{
  DetailKind kind = DetailKind::Handle;
  DetailDecision decision = DetailDecision::Keep;
  double size = 0;                 ///< over s, and over the sizes where the surface has any
  Vector3 place = Vector3::Zero(); ///< on it; of a component its middle
  std::string result;              ///< what became of it: "filled"
};

/// What became of a handle that was simplified.
constexpr const char* kCutAndClosed = "cut and closed";

/// "handle", "boundary loop", "component", "thin part"; "resolved", "simplified", "kept".
const char* nameOf(DetailKind kind);
const char* nameOf(DetailDecision decision);

/// Whether handles and boundary loops may be taken out of the surface.
bool maySimplify(const RemeshOptions& options);

/// One line with the numbers, where something was simplified; else empty.
std::string detailsNotice(const std::vector<SmallDetail>& details);

} // namespace quadrille
