// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/Certificate.h"
#include "GridMap/RoundedMap.h"
#include "MapModels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace quadrille;
using namespace quadrille::test;

TEST(RoundedMap, WhatMustBeWholeIsSoExactly)
{
  for (const Model& model : models())
  {
    const Mesh mesh = model.make();
    for (const double quads : { 37.0, 200.0, 1000.0 })
    {
      const double length = std::sqrt(areaOf(mesh) / quads);
      const CrossField field = fieldOf(mesh, length);
      ASSERT_TRUE(field.status.ok()) << model.name << ": " << field.status.message;
      const RoundedMap rounded(mesh, field, length);
      ASSERT_TRUE(rounded.status().ok()) << model.name << ": " << rounded.status().message;
      for (const RoundingOrder order : { RoundingOrder::OneAtATime, RoundingOrder::AllAtOnce })
      {
        const std::vector<FixedVec2> uv = rounded.make(quads, order);
        const Certificate c = certify(mesh, uv, field.turns, integerVertices(mesh, field));
        const std::string where =
          std::string(model.name) + ", " + std::to_string(quads) + ": " + c.text();
        EXPECT_EQ(c.seamResiduals, 0u) << where;
        EXPECT_EQ(c.offAxes, 0u) << where;
        EXPECT_EQ(c.offIsolines, 0u) << where;
        EXPECT_EQ(c.offIntegers, 0u) << where;
        EXPECT_EQ(c.fractionalTransitions, 0u) << where;
        EXPECT_EQ(c.area, std::round(c.area)) << where; // whole quads, or as much of them inverted
      }
    }
  }
}

TEST(RoundedMap, AreMapsOfSmallQuadsWithoutFolds)
{
  for (const Model& model : models())
  {
    const Mesh mesh = model.make();
    const double length = std::sqrt(areaOf(mesh) / 4000);
    const CrossField field = fieldOf(mesh, length);
    ASSERT_TRUE(field.status.ok()) << model.name << ": " << field.status.message;
    const RoundedMap rounded(mesh, field, length);
    for (const RoundingOrder order : { RoundingOrder::OneAtATime, RoundingOrder::AllAtOnce })
    {
      const std::vector<FixedVec2> uv = rounded.make(4000, order);
      const Certificate c = certify(mesh, uv, field.turns, integerVertices(mesh, field));
      EXPECT_TRUE(c.valid()) << model.name << ": " << c.text();
      EXPECT_NEAR(c.area, 4000, 400) << model.name;
    }
  }
}

TEST(RoundedMap, ParityIsMetWhereNotAllIntegersAreAllowed)
{
  const Mesh mesh = test::doubleTorus(3);
  const double length = std::sqrt(areaOf(mesh) / 300);
  const CrossField field = fieldOf(mesh, length);
  const RoundedMap rounded(mesh, field, length);
  for (double quads = 250; quads < 350; quads += 9)
  {
    const auto uv = rounded.make(quads, RoundingOrder::AllAtOnce);
    const Certificate c = certify(mesh, uv, field.turns, integerVertices(mesh, field));
    EXPECT_TRUE(c.whole()) << c.text();
  }
}

TEST(RoundedMap, TheOrderOfRoundingMatters)
{
  std::size_t different = 0;
  for (const Model& model : models())
  {
    const Mesh mesh = model.make();
    const double length = std::sqrt(areaOf(mesh) / 200);
    const CrossField field = fieldOf(mesh, length);
    const RoundedMap rounded(mesh, field, length);
    const auto one = rounded.make(200, RoundingOrder::OneAtATime);
    different += one != rounded.make(200, RoundingOrder::AllAtOnce) ? 1 : 0;
    EXPECT_EQ(one, RoundedMap(mesh, field, length).make(200, RoundingOrder::OneAtATime));
  }
  EXPECT_GE(different, 2u);
}

TEST(RoundedMap, HasTheArea)
{
  const Mesh mesh = test::sphere(3);
  const CrossField field = fieldOf(mesh, 0.2);
  const RoundedMap rounded(mesh, field, 0.2);
  for (const double quads : { 300.0, 3000.0 })
  {
    const Certificate c = certify(mesh, rounded.make(quads, RoundingOrder::OneAtATime), field.turns,
      integerVertices(mesh, field));
    EXPECT_NEAR(c.area, quads, 0.15 * quads);
  }
}

TEST(RoundedMap, OnlyWhatMustBeWholeIsPinned)
{
  // The corner that lies at the origin is one of an integer vertex, where there is any.
  Mesh mesh = test::sphere(3);
  for (Vector3& p : mesh.position.editAll())
  {
    p.x() *= 1.3 + 0.2 * p.y() + 0.1 * p.z();
  }
  const CrossField field = fieldOf(mesh, 0.2);
  const std::vector<std::uint8_t> integer = integerVertices(mesh, field);
  ASSERT_EQ(integer[mesh.origin[0]], 0); // else this tests nothing
  const auto uv = RoundedMap(mesh, field, 0.2).make(300, RoundingOrder::OneAtATime);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    EXPECT_EQ(isInteger(uv[h]), integer[mesh.origin[h]] != 0) << h;
  }
}
