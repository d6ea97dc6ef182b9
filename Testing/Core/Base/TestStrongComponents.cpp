// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/StrongComponents.h"

#include <gtest/gtest.h>

#include <vector>

using namespace quadrille;

namespace
{

struct Nodes
{
  std::vector<Index> nodes;

  Index size() const { return static_cast<Index>(nodes.size()); }
  Index operator[](Index i) const { return nodes[i]; }
};

} // namespace

TEST(StrongComponents, ArcsOfCyclesJoinAndOthersDoNot)
{
  // Two triangles with a way from the one to the other, and a node that leads nowhere.
  const std::vector<std::vector<Index>> arcs{ { 1 }, { 2 }, { 0, 3 }, { 4 }, { 5, 6 }, { 3 }, {} };
  StrongComponents<Nodes> components(static_cast<Index>(arcs.size()));
  int asked = 0;
  for (Index root = 0; root < arcs.size(); ++root)
  {
    components.walkFrom(root,
      [&](Index node)
      {
        ++asked;
        return Nodes{ arcs[node] };
      });
  }
  EXPECT_EQ(asked, 7);
  EXPECT_EQ(components.componentOf(0), components.componentOf(1));
  EXPECT_EQ(components.componentOf(0), components.componentOf(2));
  EXPECT_EQ(components.componentOf(3), components.componentOf(5));
  EXPECT_NE(components.componentOf(0), components.componentOf(3));
  EXPECT_NE(components.componentOf(4), components.componentOf(6));
  EXPECT_EQ(components.sizeOf(components.componentOf(4)), 3U);
  EXPECT_EQ(components.sizeOf(components.componentOf(6)), 1U);
}

TEST(StrongComponents, WhatNoWalkHasReachedHasNone)
{
  StrongComponents<Nodes> components(3);
  components.walkFrom(1, [](Index node) { return node == 1 ? Nodes{ { 1, 2 } } : Nodes{}; });
  EXPECT_EQ(components.componentOf(0), kInvalidIndex);
  EXPECT_NE(components.componentOf(1), kInvalidIndex);
  EXPECT_NE(components.componentOf(2), kInvalidIndex);
}
