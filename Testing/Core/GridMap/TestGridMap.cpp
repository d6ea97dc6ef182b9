// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/GridMap.h"

#include "TestMeshes.h"

#include <gtest/gtest.h>

using namespace quadrille;
using namespace quadrille::test;

TEST(GridMap, aMeshThatIsNoCoarseLevelIsRefusedAtOnce)
{
  const Mesh mesh = torus(30, 15);
  GridMapOptions options;
  options.edgeLength = 0.3;
  options.maximumVertices = 449;
  const GridMapResult refused = computeGridMap(mesh, options);
  EXPECT_EQ(refused.status.code, StatusCode::TooLarge);
  EXPECT_NE(refused.status.message.find("450 vertices"), std::string::npos)
    << refused.status.message;
  EXPECT_TRUE(refused.uv.empty());
  options.maximumVertices = 450;
  const GridMapResult result = computeGridMap(mesh, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.certificate.valid()) << result.certificate.text();
}
