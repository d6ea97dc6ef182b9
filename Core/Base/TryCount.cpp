// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/TryCount.h"

namespace quadrille
{
namespace
{

thread_local TryScope* innermostTries = nullptr;

constexpr std::array<TryRow, kTries> kTryRows{ {
  { "pipeline", "more freedom",
    "intermediate vertices near failures are kept, or both levels get twice the budget",
    "2 a round" },
  { "pipeline", "more quads", "as many quads as go three times round the shortest loop", "1" },
  { "pipeline", "counterparts",
    "three more irregular vertices beside each that was asked for near a failure", "1" },
  { "pipeline", "fewer features", "detected features near the places of a failure are given up",
    "4" },
  { "pipeline", "fewer details", "details that had been left are cut, and all begins again", "1" },
  { "pipeline", "components",
    "each connected component without a map is a run of its own, and so is the rest",
    "components" },
  { "pipeline", "filled faces",
    "faces without a map are cut out, and filled with quads beside those of the rest", "faces" },
  { "pipeline", "faces by themselves",
    "quads of a map of such a face alone, made to fit by strips, where they are better", "1" },
  { "pipeline", "others free", "irregular vertices that connections do not join need not stay",
    "1" },
  { "pipeline", "without its guides", "the map is carried without the guides of the finer level",
    "1" },
  { "pipeline", "larger pull", "the coarsest integers with a larger pull to the wanted sizes",
    "6 maps" },
  { "pipeline", "carried map held", "final quality with vertices near inverted quads held", "3" },
  { "map", "fewer irregular at seams", "the map again with fewer irregular vertices", "1" },
  { "map", "bent lines", "irregular vertices may lie on lines", "1 map" },
  { "map", "without the earlier map", "the map again from the beginning", "1" },
  { "map", "other number", "the same integers for another number of quads, by strips", "5" },
  { "map", "other integers", "integers with room where the embedding failed", "6" },
  { "map", "seamless near the earlier", "the seamless map starts from the earlier one", "1" },
  { "map", "more weight", "the map near its defects again, with more weight there",
    "as long as it helps" },
  { "map", "guides and limit followed",
    "once more with terms for guides and the limit of anisotropy", "1" },
  { "integers", "of earlier ones", "the integers of the earlier map or try", "1" },
  { "integers", "finer scale", "rounded at a scale larger by the square root of two", "11" },
  { "integers", "breakout", "the weight of a triangle that nothing mends is doubled",
    "40 and a quarter of the triangles" },
  { "field", "other fields", "principal directions, without guides, the smoothest field", "3" },
  { "field", "turns for strips",
    "quarter turns move between corners, so that strips close over all sides of nearly true length",
    "1" },
  { "field", "valences for sizes", "irregular vertices are moved so that sizes can be followed",
    "1" },
  { "transfer", "wider patches", "four, then eight rings round a bad triangle", "2" },
  { "transfer", "turned references", "a patch towards triangles turned along a path", "1" },
  { "extraction", "more corners", "a polygon of the boundary with more corners",
    "stops of the face" },
  { "quads", "other edges", "quads round a bad one are replaced, see QuadRepair.h", "4 rounds" },
  { "elements", "node moved further", "a node nearer to the straight edge", "4" },
  { "elements", "centre otherwise", "the centre by the other pair of edges, or the nearest place",
    "3" },
  { "hierarchy", "looser guards", "guards and prices of removals are loosened", "15 stages" },
  { "hierarchy", "old folds", "stars that were folded before may stay folded", "1" },
  { "hierarchy", "other diagonals", "a star's triangulation without a diagonal that is there",
    "4" },
  { "details", "through three corners", "the cut leads through three corners", "1" },
  { "symmetry", "twice the quads", "the part is made with twice the quads", "2" },
  { "symmetry", "another half plane", "the cut along another half plane", "12" },
  { "symmetry", "narrower band", "fewer rows beside the mirror plane are solved again", "4" },
  { "assembly", "strip otherwise", "a strip is split, or raised", "3" },
  { "session", "without held vertices", "vertices on features are free", "1" },
  { "session", "without a constraint", "a constraint is left out", "as many as constraints" },
  { "session", "without the symmetry", "a symmetry that is refused is left out",
    "as many as symmetries" },
} };

std::array<std::size_t, kTries> valuesOf(
  const std::array<std::atomic<std::size_t>, kTries>& counters)
{
  std::array<std::size_t, kTries> values{};
  for (std::size_t i = 0; i < kTries; ++i)
  {
    values[i] = counters[i].load(std::memory_order_relaxed);
  }
  return values;
}

} // namespace

const std::array<TryRow, kTries>& tryTable()
{
  return kTryRows;
}

void TryCounts::addTaken(const TryCounts& other)
{
  for (std::size_t i = 0; i < kTries; ++i)
  {
    taken[i] += other.taken[i];
  }
}

void TryCounts::addLed(const TryCounts& other)
{
  for (std::size_t i = 0; i < kTries; ++i)
  {
    led[i] += other.led[i];
  }
}

void TryCounts::add(const TryCounts& other)
{
  addTaken(other);
  addLed(other);
}

TryScope::TryScope() : outer_(innermostTries)
{
  innermostTries = this;
}

TryScope::~TryScope()
{
  innermostTries = outer_;
}

TryCounts TryScope::counts() const
{
  return { valuesOf(taken_), valuesOf(led_) };
}

TryHandover::TryHandover() : scope_(innermostTries) {}

void TryHandover::take() const
{
  innermostTries = scope_;
}

void countTry(Try which, std::size_t times)
{
  if (innermostTries != nullptr)
  {
    innermostTries->taken_[static_cast<std::size_t>(which)].fetch_add(
      times, std::memory_order_relaxed);
  }
}

void countTryLed(Try which, std::size_t times)
{
  if (innermostTries != nullptr)
  {
    innermostTries->led_[static_cast<std::size_t>(which)].fetch_add(
      times, std::memory_order_relaxed);
  }
}

} // namespace quadrille
