// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Plan.h"

#include "Requests/Guides.h"

namespace quadrille
{

ResultKey Plan::surfaceKey() const
{
  KeyMaker key;
  key.add(std::uint64_t{ sizes ? 1U : 0U }).add(std::uint64_t{ featuresGivenUp ? 1U : 0U });
  if (sizes)
  {
    key.add(*sizes);
  }
  if (featuresGivenUp)
  {
    key.add(*featuresGivenUp);
  }
  if (moved)
  {
    key.add(moved->off).add(moved->on);
  }
  return key.key();
}

ResultKey Plan::levelsKey() const
{
  return KeyMaker()
    .add(levels.keptVertices)
    .add(std::uint64_t{ levels.coarseVertices })
    .add(levels.edgeLength)
    .add(quads)
    .key();
}

} // namespace quadrille
