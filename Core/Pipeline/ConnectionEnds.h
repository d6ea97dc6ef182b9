// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What connections join is known from the quads without them: irregular vertices, features or boundaries. With the
/// connections all other irregular vertices stay where these quads have them.
#pragma once

#include "Evaluation/QuadPlaces.h"
#include "Mesh/Surface.h"
#include "Pipeline/Pipeline.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{

/// The ends of an input's connections.
class ConnectionEnds
{
public:
  /// Both stay for as long as this does; input: gets what is found.
  ConnectionEnds(SurfaceInput& input, const RemeshOptions& options);

  /// Whether quads without the connections that lack ends have to be made for these.
  bool areMissing() const { return isMissing_; }
  /// How these quads are made.
  RemeshOptions optionsOfQuads() const;
  /// The input without connections that lack ends, with the irregular vertices that are held.
  SurfaceInput drawn() const;
  /// In the quads of a run with what was drawn. Those that are left may have ends at what the others change. Returns
  /// whether some were found.
  bool findIn(RemeshResult& without);

  /// Whether another run may be better, where other irregular vertices are free: this one, which holds them, has
  /// failed, or lacks a line.
  bool mayFreeOthers(const RemeshResult& made) const;
  /// From now on they are. Returns the options of a run that tells so.
  RemeshOptions freeOthers();
  /// Whether the quads of the run with free ones count; those that do tell of both, and of a stop.
  bool isBetter(RemeshResult& free, RemeshResult& held);

  /// To the result: what these runs have taken before it, and why connections have no line.
  void tell(RemeshResult& result) const;

private:
  /// joined: gets the points of the quads that it joins.
  void join(CurveRequest& connection, const RemeshResult& without, const NearestQuads& nearest,
    std::string& whyNot, std::set<Index>& joined);
  void hold(
    const RemeshResult& without, const NearestQuads& nearest, const std::set<Index>& joined);
  void take(const RemeshResult& made);

  SurfaceInput& input_;
  const RemeshOptions& options_;
  bool isMissing_ = false;
  std::vector<std::string> whyNot_; ///< of each curve
  std::vector<ValencePlace> held_;
  RemeshResult taken_;  ///< by runs whose quads do not count
  StageRecords stages_; ///< of these
};

/// A run, after others where connections need them. run(SurfaceInput, options): returns what has a RemeshResult, which
/// remeshedOf() gives.
template <typename Run, typename RemeshedOf>
auto remeshWithEnds(
  SurfaceInput& input, const RemeshOptions& options, const Run& run, const RemeshedOf& remeshedOf)
{
  if (std::all_of(input.curves.begin(), input.curves.end(),
        [](const CurveRequest& curve) { return curve.isDrawn(); }))
  {
    return run(std::move(input), options); // which lets go of its memory
  }
  ConnectionEnds ends(input, options);
  bool isMade = false;
  decltype(run(ends.drawn(), options)) made;
  while (ends.areMissing())
  {
    made = run(ends.drawn(), ends.optionsOfQuads());
    // The quads are those that were asked for, but for a preview.
    isMade = !ends.findIn(remeshedOf(made)) && !(remeshedOf(made).status.ok() && options.preview);
  }
  if (!isMade)
  {
    made = run(ends.drawn(), options);
  }
  if (ends.mayFreeOthers(remeshedOf(made)))
  {
    const RemeshOptions again = ends.freeOthers();
    auto other = run(ends.drawn(), again);
    if (ends.isBetter(remeshedOf(other), remeshedOf(made)))
    {
      made = std::move(other);
    }
  }
  ends.tell(remeshedOf(made));
  return made;
}

} // namespace quadrille
