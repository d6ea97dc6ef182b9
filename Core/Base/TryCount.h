// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The ledger of what a run has tried otherwise, after a step had failed or was judged not good enough: every loop of
/// that kind, in whatever room, has a row here, and says when it tries and when what it tried is used. A row that never
/// leads to a result can go. Documentation/Design/Tries.md has the counts of many models.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace quadrille
{

enum class Try : std::uint8_t
{
  MoreFreedom,
  MoreQuads,
  Counterparts,
  FewerFeatures,
  FewerDetails,
  Components,
  FilledFaces,
  FacesAlone,
  OthersFree,
  WithoutGuides,
  LargerPull,
  CarriedMapHeld,
  SeamsFewer,
  BentLines,
  WithoutEarlier,
  OtherNumber,
  OtherIntegers,
  NearSeamless,
  MoreWeight,
  RequestsFollowed,
  EarlierIntegers,
  FinerScale,
  Breakout,
  OtherField,
  TurnsForStrips,
  ValencesForSizes,
  WiderPatch,
  TurnedReferences,
  MoreCorners,
  OtherEdges,
  NodeFurther,
  CentreOtherwise,
  LooserGuards,
  OldFolds,
  OtherDiagonals,
  ThreeCorners,
  TwiceTheQuads,
  OtherHalfPlane,
  NarrowerBand,
  StripOtherwise,
  WithoutHeld,
  WithoutConstraint,
  WithoutSymmetry,
  Count
};
constexpr std::size_t kTries = static_cast<std::size_t>(Try::Count);

struct TryRow
{
  const char* room;    ///< where the loop is: pipeline, map, integers, ...
  const char* name;    ///< in a room, once
  const char* changes; ///< what is otherwise
  const char* bound;   ///< how often at most
};
/// One row for each value of Try, in its order.
const std::array<TryRow, kTries>& tryTable();
inline const TryRow& tryRow(Try which)
{
  return tryTable()[static_cast<std::size_t>(which)];
}

/// How often each was tried, and how often what it tried is used by what followed.
struct TryCounts
{
  std::array<std::size_t, kTries> taken{}, led{};

  void addTaken(const TryCounts& other);
  void addLed(const TryCounts& other);
  void add(const TryCounts& other);
};

/// Counts the tries of its thread, and of those that parallelFor() starts from it, while it lives. A scope inside of
/// another one takes them for itself: what it has counted is a value that its maker adds where it belongs, so that
/// results that are remembered bring the counts of their making.
class TryScope
{
public:
  TryScope();
  ~TryScope();
  TryScope(const TryScope&) = delete;
  TryScope& operator=(const TryScope&) = delete;

  TryCounts counts() const;

private:
  friend class TryHandover;
  friend void countTry(Try which, std::size_t times);
  friend void countTryLed(Try which, std::size_t times);

  // Sums do not depend on the order of threads.
  std::array<std::atomic<std::size_t>, kTries> taken_{}, led_{};
  TryScope* outer_;
};

/// For parallelFor(): its threads count for the scope of the thread that has made this.
class TryHandover
{
public:
  TryHandover();
  /// On a thread of the loop, before it works.
  void take() const;

private:
  TryScope* scope_;
};

/// Adds to the scope, if there is one.
void countTry(Try which, std::size_t times = 1);
void countTryLed(Try which, std::size_t times = 1);

} // namespace quadrille
