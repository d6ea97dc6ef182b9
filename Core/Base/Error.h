// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How Core tells of failures: a violated precondition throws InvalidInput, a stop throws Cancelled, which
/// only runs catch (Pipeline, Symmetry, Pieces), an expected failure is a Status in the result.
#pragma once

#include <stdexcept>
#include <string>

namespace quadrille
{

/// A precondition on the input does not hold. The message names the element (its id, what is wrong
/// with it) and what the user can do.
class InvalidInput : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Thrown out of a stage when the progress callback asked to stop. No stage catches it.
class Cancelled : public std::runtime_error
{
public:
  Cancelled() : std::runtime_error("cancelled") {}
};

enum class StatusCode
{
  Ok,
  Cancelled,
  Infeasible,   ///< the constraints contradict each other or the surface's topology
  NotConverged, ///< a solver ended without a valid result
  TooLarge      ///< the result would exceed a limit that the caller set
};

/// Outcome of a stage that may fail for reasons other than bad input.
struct Status
{
  StatusCode code = StatusCode::Ok;
  std::string message; ///< empty when ok; else the reason, the place, and what the user can do

  bool ok() const { return code == StatusCode::Ok; }
};

} // namespace quadrille
