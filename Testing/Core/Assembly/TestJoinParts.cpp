// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Assembly/JoinParts.h"

#include "Base/Error.h"
#include "MeshInput.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace quadrille
{
namespace
{

/// n x n unit cells of two triangles each.
SurfaceInput squareSheet(int n, const Vector3& origin, const Vector3& u, const Vector3& v)
{
  SurfaceInput input = test::toInput(test::gridPlane(n, n));
  for (Vector3& p : input.points.editAll())
  {
    p = origin + p.x() * u + p.y() * v;
  }
  return input;
}

PartContacts contactsOf(const std::vector<SurfaceInput>& parts)
{
  std::vector<const SurfaceInput*> addresses;
  for (const SurfaceInput& part : parts)
  {
    addresses.push_back(&part);
  }
  return findContacts(addresses);
}

const Vector3 kX = Vector3::UnitX(), kY = Vector3::UnitY(), kZ = Vector3::UnitZ();

TEST(JoinParts, SheetsWithACommonCurveAreOne)
{
  std::vector<SurfaceInput> parts{ squareSheet(4, Vector3::Zero(), kX, kY),
    squareSheet(4, Vector3::Zero(), kZ, kY), squareSheet(4, 9 * kX, kX, kY) };
  const PartContacts contacts = contactsOf(parts);
  EXPECT_EQ(contacts.edges, 4U);
  EXPECT_EQ(contacts.manyFaced, 0U);
  EXPECT_EQ(contacts.loosePoints, 0U);
  EXPECT_EQ(contacts.group, (std::vector<Index>{ 0, 0, 2 }));
  parts.pop_back();
  const JoinedParts joined = joinParts(parts, contactsOf(parts));
  EXPECT_EQ(joined.input.points.size(), 2U * 25 - 5);
  EXPECT_EQ(joined.firstPolygon, (std::vector<Index>{ 0, 32, 64 }));
  EXPECT_EQ(joined.partOf(31), 0U);
  EXPECT_EQ(joined.partOf(32), 1U);
  // Each corner is where it was, and the way back leads to the part's own point.
  for (std::size_t p = 0; p < 2; ++p)
  {
    for (Index i = joined.firstPolygon[p]; i < joined.firstPolygon[p + 1]; ++i)
    {
      for (Index corner = 0; corner < 3; ++corner)
      {
        const Index joint = joined.input.polygonPoints[joined.input.polygonOffsets[i] + corner];
        const Index own = parts[p].polygonPoints[3 * (i - joined.firstPolygon[p]) + corner];
        EXPECT_EQ(joined.parts[p].ownPoint(joint), own);
        EXPECT_EQ(joined.input.points[joint], parts[p].points[own]);
      }
    }
  }
  EXPECT_EQ(
    joined.parts[1].ownPoint(0) == kInvalidIndex, joined.input.points[0] != parts[1].points[0]);
}

/// Within the tolerance both get the place of the first part; beyond it they stay apart.
TEST(JoinParts, NearPointsAreOne)
{
  const double size = std::sqrt(3 * 16.0);
  for (const double factor : { 0.4, 3.0 })
  {
    std::vector<SurfaceInput> parts{ squareSheet(4, Vector3::Zero(), kX, kY),
      squareSheet(4, factor * kRoundingOfSingle * size * kX.normalized(), kZ, kY) };
    const PartContacts contacts = contactsOf(parts);
    EXPECT_EQ(contacts.edges, factor < 1 ? 4U : 0U);
    const JoinedParts joined = joinParts(parts, contacts);
    EXPECT_EQ(joined.input.points.size(), factor < 1 ? 45U : 50U);
  }
}

/// A part with a sliver at its border, narrower than the tolerance: the other one has the far corner of it.
TEST(JoinParts, CornersOfASliverAreTold)
{
  constexpr double width = 1e-7;
  const Vector3 near = kX, far = (1 + width) * kX, top = kX + kY;
  SurfaceInput left, right;
  left.points = { Vector3::Zero(), near, top, far };
  left.polygonOffsets = { 0, 3, 6 };
  left.polygonPoints = { 0, 1, 2, 1, 3, 2 };
  right.points = { far, 2 * kX, top };
  right.polygonOffsets = { 0, 3 };
  right.polygonPoints = { 0, 1, 2 };
  for (const bool isLeftFirst : { true, false })
  {
    const PartContacts contacts =
      isLeftFirst ? contactsOf({ left, right }) : contactsOf({ right, left });
    EXPECT_EQ(contacts.edges, 1U);
    EXPECT_EQ(contacts.manyFaced, 0U);
    EXPECT_EQ(contacts.loosePoints, 0U);
    EXPECT_EQ(contacts.pointOf,
      isLeftFirst ? (std::vector<Index>{ 0, 1, 2, 3, 3, 5, 2 })
                  : (std::vector<Index>{ 0, 1, 2, 3, 4, 2, 0 }));
  }
  // Not to the last bit, but nearer than the other corner.
  right.points.edit()[0] += 0.2 * width * kX;
  EXPECT_EQ(contactsOf({ left, right }).pointOf, (std::vector<Index>{ 0, 1, 2, 3, 3, 5, 2 }));
}

TEST(JoinParts, PatchesOfPartsStayApart)
{
  std::vector<SurfaceInput> parts{ squareSheet(2, Vector3::Zero(), kX, kY),
    squareSheet(2, Vector3::Zero(), kZ, kY) };
  parts[0].patchIds = { 7, 7, 7, 7, 3, 3, 3, 3 };
  const JoinedParts joined = joinParts(parts, contactsOf(parts));
  const std::vector<std::int64_t>& ids = joined.input.patchIds;
  ASSERT_EQ(ids.size(), 16U);
  EXPECT_EQ(ids[0], ids[3]);
  EXPECT_NE(ids[0], ids[4]);
  EXPECT_NE(ids[0], ids[8]);
  EXPECT_NE(ids[4], ids[8]);
  EXPECT_EQ(ids[8], ids[15]);
}

TEST(JoinParts, WhatOnePartLacksIsFilledIn)
{
  std::vector<SurfaceInput> parts{ squareSheet(2, Vector3::Zero(), kX, kY),
    squareSheet(2, Vector3::Zero(), kZ, kY) };
  parts[1].featureEdges.assign(8, 5);
  parts[1].guideDirections.assign(8, kZ);
  parts[1].guideWeights.assign(8, 0.5);
  parts[1].sizing.assign(9, 0.25F);
  parts[1].targetValences.assign(9, 5);
  const JoinedParts joined = joinParts(parts, contactsOf(parts));
  const SurfaceInput& all = joined.input;
  EXPECT_EQ(all.featureEdges[0], 0);
  EXPECT_EQ(all.featureEdges[8], 5);
  EXPECT_EQ(all.guideDirections[0], Vector3(Vector3::Zero()));
  EXPECT_EQ(all.guideDirections[8], kZ);
  EXPECT_EQ(all.guideWeights[0], 1);
  EXPECT_EQ(all.guideWeights[8], 0.5);
  for (Index i = 0; i < 15; ++i)
  {
    const bool isOfSecond = joined.parts[1].ownPoint(i) != kInvalidIndex;
    EXPECT_EQ(all.sizing[i], isOfSecond ? 0.25F : 1.0F);
    EXPECT_EQ(all.targetValences[i], isOfSecond ? 5 : 0);
  }
}

TEST(JoinParts, ThreeSheetsAtACurveAreCounted)
{
  const std::vector<SurfaceInput> parts{ squareSheet(4, Vector3::Zero(), kX, kY),
    squareSheet(4, Vector3::Zero(), kZ, kY), squareSheet(4, Vector3::Zero(), -kX, kY) };
  const PartContacts contacts = contactsOf(parts);
  EXPECT_EQ(contacts.manyFaced, 4U);
  EXPECT_EQ(contacts.manyFacedParts, (std::vector<Index>{ 0, 1, 2 }));
  EXPECT_EQ(contacts.manyFacedPlace.x(), 0);
}

/// Solids that touch in a face with the same triangles have edges of four faces there.
TEST(JoinParts, TouchingSolidsAreCounted)
{
  SurfaceInput box = test::toInput(test::unitCube(2)), other = box;
  for (Vector3& p : other.points.editAll())
  {
    p.x() += 1;
  }
  const PartContacts contacts = contactsOf({ box, other });
  EXPECT_EQ(contacts.edges, contacts.manyFaced);
  EXPECT_EQ(contacts.manyFaced, 16U); // of 2 x 2 cells: 12 and 4 diagonals
}

TEST(JoinParts, CurvesWithOtherPointsAreLoose)
{
  std::vector<SurfaceInput> parts{ squareSheet(4, Vector3::Zero(), kX, kY),
    squareSheet(7, Vector3::Zero(), kZ, 4.0 / 7 * kY) };
  const PartContacts contacts = contactsOf(parts);
  EXPECT_EQ(contacts.edges, 0U);
  EXPECT_EQ(contacts.loosePoints, 2U); // the ends of the curve
  EXPECT_EQ(contacts.looseParts, (std::array<Index, 2>{ 0, 1 }));
  EXPECT_EQ(contacts.group, (std::vector<Index>{ 0, 1 }));
}

TEST(JoinParts, NothingToJoinIsRefused)
{
  const SurfaceInput one = squareSheet(2, Vector3::Zero(), kX, kY);
  EXPECT_THROW(joinParts({ one }, contactsOf({ one })), InvalidInput);
  EXPECT_THROW(joinParts({ one, one }, contactsOf({ one })), InvalidInput);
}

} // namespace
} // namespace quadrille
