// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/SmallDetails.h"

#include "Base/PlaceText.h"

#include <array>
#include <iomanip>
#include <sstream>

namespace quadrille
{
namespace
{

struct SimplifiedCount
{
  DetailKind kind;
  const char* one;
  const char* many;
};

/// Components have a notice of their own.
constexpr std::array<SimplifiedCount, 3> kSimplifiedCounts{ {
  { DetailKind::Handle, "handle was cut and closed", "handles were cut and closed" },
  { DetailKind::BoundaryLoop, "hole was filled", "holes were filled" },
  { DetailKind::ThinPart, "thin part was cut off", "thin parts were cut off" },
} };

} // namespace

const char* nameOf(DetailKind kind)
{
  constexpr std::array<const char*, 4> kKindNames{ "handle", "boundary loop", "component",
    "thin part" };
  return kKindNames[static_cast<std::size_t>(kind)];
}

const char* nameOf(DetailDecision decision)
{
  constexpr std::array<const char*, 3> kDecisionNames{ "resolved", "simplified", "kept" };
  return kDecisionNames[static_cast<std::size_t>(decision)];
}

bool maySimplify(const RemeshOptions& options)
{
  const bool hasSizes = options.method == MapMethod::ScaleAware && !options.coarsestIntegers;
  return options.smallDetails == SmallDetails::Simplify ||
    (options.smallDetails == SmallDetails::Automatic && hasSizes);
}

std::string detailsNotice(const std::vector<SmallDetail>& details)
{
  std::ostringstream text;
  const SmallDetail* longest = nullptr;
  for (const SimplifiedCount& counted : kSimplifiedCounts)
  {
    std::size_t count = 0;
    for (const SmallDetail& detail : details)
    {
      if (detail.kind == counted.kind && detail.decision == DetailDecision::Simplify)
      {
        ++count;
        longest = longest == nullptr || detail.size > longest->size ? &detail : longest;
      }
    }
    if (count > 0)
    {
      text << (text.str().empty() ? "" : " and ") << count << ' '
           << (count == 1 ? counted.one : counted.many);
    }
  }
  if (longest == nullptr)
  {
    return {};
  }
  text
    << ", as quads of this size cannot show them, the longest loop of " << std::setprecision(2)
    << longest->size << std::setprecision(6) << " edge lengths near " << placeText(longest->place)
    << " (Smallest Detail, --smallest-detail, sets the limit; Small Details Resolve or Keep leaves "
       "them)";
  return text.str();
}

} // namespace quadrille
