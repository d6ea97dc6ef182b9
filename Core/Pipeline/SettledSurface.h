// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Measure first, then decide, then map once: small details of the sized surface are found and simplified before the
/// first map.
#pragma once

#include "Pipeline/Attempt.h"
#include "Pipeline/SizedSurface.h"
#include "Pipeline/SmallDetails.h"

#include <memory>
#include <string>
#include <vector>

namespace quadrille
{

/// All that attempts work on: the surface, its levels, and the short loops that are left. Stays where it is made, as
/// the parts refer to each other.
struct RunBench
{
  RunBench(const SizedSurface& sized, const RemeshOptions& options, ResultStore* store);
  RunBench(const RunBench&) = delete;
  RunBench& operator=(const RunBench&) = delete;

  RunSurface surface;
  Levels levels;
  /// Progress tells which attempt it is, from the second one on.
  RemeshOptions options;
  RunContext run;
};

/// What settling told beside the bench.
struct Settled
{
  /// Infeasible where the surface has more handles and boundary loops than so many quads can go round, whatever is
  /// done; only where details may be simplified.
  Status status;
  std::unique_ptr<RunBench> bench; ///< the short loops are found; null where the status is not ok
  /// Handles and boundary loops shorter than kQuadsOfLoop s, those that were simplified first.
  std::vector<SmallDetail> details;
  int decimations = 0; ///< runs of phase 1 before that of the bench
};

/// Where nothing is to be simplified, `sized` and the levels are what they are without; else its surface is another
/// one, with its key. Boundary loops are measured on the surface itself and filled at once. Handles are found on the
/// intermediate level and cut, until no short one is left that can be. Automatic goes on with the next longer boundary
/// loops, or all short handles, where smaller quads at all that are left would take too many.
Settled settleDetails(SizedSurface& sized, const RemeshOptions& options, ResultStore* store,
  StageRecords& stages, std::vector<std::string>& reused);

/// Whether Automatic has left details that simplifyRest would take out.
bool hasRest(const Settled& settled, const RemeshOptions& options);

/// Where Automatic has left details and no attempt has led to quads: takes them out, too. Where there are such details,
/// the bench is another one afterwards, of the surface without any plan. False where nothing was taken out, so that no
/// attempt would end otherwise.
bool simplifyRest(Settled& settled, SizedSurface& sized, const RemeshOptions& options,
  ResultStore* store, StageRecords& stages, std::vector<std::string>& reused);

} // namespace quadrille
