// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Measure first, then decide, then map once: small details of the sized surface are found and simplified before the
/// first map.
#pragma once

#include "Pipeline/Attempt.h"
#include "Pipeline/SizedSurface.h"
#include "Pipeline/SmallDetails.h"

#include <optional>
#include <vector>

namespace quadrille
{

struct Settled
{
  /// Infeasible where the surface has more handles and boundary loops than so many quads can go round, whatever is
  /// done; only where details may be simplified.
  Status status;
  std::optional<RunContext> run; ///< the short loops are found; none where the status is not ok
  /// Handles and boundary loops shorter than kQuadsOfLoop s, those that were simplified first.
  std::vector<SmallDetail> details;
  int decimations = 0; ///< runs of phase 1 before those of the run
};

/// Where nothing is to be simplified, `sized` and the levels are what they are without; else its surface is another
/// one, with its key. Boundary loops are measured on the surface itself and filled at once. Handles are found on the
/// intermediate level and cut, until no short one is left that can be. Automatic cuts all short handles where they are
/// a crowd, of a surface that is not known as designed. Stages go to `sized`.
Settled settleDetails(SizedSurface& sized, const RemeshOptions& options, ResultStore* store);

/// Whether Automatic has left details that simplifyRest would take out.
bool hasRest(const Settled& settled, const RemeshOptions& options);

/// Where Automatic has left details and no attempt has led to quads: takes them out, too. Where there are such details,
/// the run is another one afterwards. False where nothing was taken out, so that no attempt would end otherwise.
bool simplifyRest(
  Settled& settled, SizedSurface& sized, const RemeshOptions& options, ResultStore* store);

} // namespace quadrille
