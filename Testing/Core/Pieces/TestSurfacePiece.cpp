// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/SurfacePiece.h"

#include "Base/Error.h"
#include "MeshInput.h"
#include "Pipeline/Pipeline.h"
#include "TestHandleMeshes.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <utility>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

using PieceOf = std::function<std::size_t(const Vector3& middle, Index polygon)>;

/// A piece of a surface of triangles with its own numbers of points.
struct Part
{
  SurfaceInput input;
  std::vector<Index> polygon; ///< of the whole
};

std::vector<Part> split(const SurfaceInput& whole, std::size_t count, const PieceOf& pieceOf)
{
  std::vector<Part> parts(count);
  std::vector<std::map<Index, Index>> known(count);
  for (Part& part : parts)
  {
    part.input.polygonOffsets = { 0 };
  }
  for (Index f = 0; f + 1 < whole.polygonOffsets.size(); ++f)
  {
    const Index* const corners = &whole.polygonPoints[3 * std::size_t{ f }];
    const Vector3 middle =
      (whole.points[corners[0]] + whole.points[corners[1]] + whole.points[corners[2]]) / 3;
    const std::size_t p = pieceOf(middle, f);
    SurfaceInput& input = parts[p].input;
    for (int i = 0; i < 3; ++i)
    {
      const auto [at, isNew] =
        known[p].emplace(corners[i], static_cast<Index>(input.points.size()));
      if (isNew)
      {
        input.points.push_back(whole.points[corners[i]]);
      }
      input.polygonPoints.push_back(at->second);
    }
    input.polygonOffsets.push_back(static_cast<Index>(input.polygonPoints.size()));
    parts[p].polygon.push_back(f);
  }
  return parts;
}

/// By place, as ranks find them.
std::vector<std::vector<Index>> sharedPoints(
  const std::vector<Part>& parts, const std::vector<SurfacePiece>& pieces)
{
  std::map<std::array<double, 3>, int> uses;
  const auto key = [&](std::size_t p, Index point)
  {
    const Vector3& at = parts[p].input.points[point];
    return std::array<double, 3>{ at.x(), at.y(), at.z() };
  };
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    for (const Index point : pieces[p].boundary())
    {
      ++uses[key(p, point)];
    }
  }
  std::vector<std::vector<Index>> shared(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    std::copy_if(pieces[p].boundary().begin(), pieces[p].boundary().end(),
      std::back_inserter(shared[p]), [&](Index point) { return uses[key(p, point)] > 1; });
  }
  return shared;
}

struct Spread
{
  std::vector<Part> parts;
  std::vector<SurfacePiece> pieces;
  std::vector<PieceLevel> levels;
  JoinedPieces joined;
};

Spread thinPieces(
  const SurfaceInput& whole, std::size_t count, const PieceOf& pieceOf, const PieceOptions& options)
{
  Spread spread;
  spread.parts = split(whole, count, pieceOf);
  for (const Part& part : spread.parts)
  {
    spread.pieces.emplace_back(part.input, options);
  }
  const auto shared = sharedPoints(spread.parts, spread.pieces);
  for (std::size_t p = 0; p < count; ++p)
  {
    spread.pieces[p].thinOut(shared[p]);
    spread.levels.push_back(spread.pieces[p].level());
  }
  spread.joined = joinPieces(spread.levels, {}, options.featureAngle);
  return spread;
}

Spread thinPieces(const SurfaceInput& whole, std::size_t count, const PieceOf& pieceOf,
  double edgeLength, std::optional<double> featureAngle, int threads = 1)
{
  PieceOptions options;
  options.edgeLength = edgeLength;
  options.featureAngle = featureAngle;
  options.threads = threads;
  return thinPieces(whole, count, pieceOf, options);
}

/// V - E + F, with each edge used at most twice.
long long eulerCharacteristic(const SurfaceInput& surface)
{
  std::map<std::pair<Index, Index>, int> edges;
  std::set<Index> points(surface.polygonPoints.begin(), surface.polygonPoints.end());
  const auto faces = surface.polygonOffsets.size() - 1;
  for (std::size_t f = 0; f < faces; ++f)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      const Index a = surface.polygonPoints[3 * f + i];
      const Index b = surface.polygonPoints[3 * f + (i + 1) % 3];
      EXPECT_LE(++edges[std::minmax(a, b)], 2);
    }
  }
  return static_cast<long long>(points.size()) - static_cast<long long>(edges.size()) +
    static_cast<long long>(faces);
}

double areaOf(const SurfaceInput& surface)
{
  double area = 0;
  for (std::size_t i = 0; i < surface.polygonPoints.size(); i += 3)
  {
    const Vector3& a = surface.points[surface.polygonPoints[i]];
    const Vector3& b = surface.points[surface.polygonPoints[i + 1]];
    const Vector3& c = surface.points[surface.polygonPoints[i + 2]];
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return area;
}

std::size_t byX(const Vector3& middle, double low, double high, std::size_t count)
{
  const double share = std::clamp((middle.x() - low) / (high - low), 0.0, 0.999);
  return static_cast<std::size_t>(share * static_cast<double>(count));
}

/// Where a place is on its piece.
Vector3 pointOf(const SurfaceInput& input, const SourceLocation& location)
{
  Vector3 point = Vector3::Zero();
  for (std::size_t k = 0; k < 3; ++k)
  {
    point += location.weights[k] * input.points[location.points[k]];
  }
  return point;
}

TEST(SurfacePiece, JoinedPiecesAreTheSurface)
{
  const SurfaceInput whole = toInput(torus(120, 60, 2, 1));
  const Spread spread = thinPieces(
    whole, 3, [](const Vector3& middle, Index) { return byX(middle, -3, 3, 3); }, 0.3, {});
  const std::size_t before = whole.polygonOffsets.size() - 1;
  const std::size_t after = spread.joined.surface.polygonOffsets.size() - 1;
  EXPECT_LT(after, before / 3);
  EXPECT_GT(spread.joined.sharedPoints, 100U);
  EXPECT_EQ(eulerCharacteristic(spread.joined.surface), 0);
  EXPECT_NEAR(areaOf(spread.joined.surface) / areaOf(whole), 1, 0.02);
  // All points are points of the surface, bit for bit, and shared ones are there once.
  std::set<std::array<double, 3>> places, given;
  for (const Vector3& p : whole.points)
  {
    given.insert({ p.x(), p.y(), p.z() });
  }
  for (const Vector3& p : spread.joined.surface.points)
  {
    EXPECT_TRUE(places.insert({ p.x(), p.y(), p.z() }).second);
    EXPECT_EQ(given.count({ p.x(), p.y(), p.z() }), 1U);
  }
}

TEST(SurfacePiece, APieceThatIsAllIsThinnedAsAWhole)
{
  const SurfaceInput whole = toInput(sphere(5));
  const Spread spread = thinPieces(whole, 1, [](const Vector3&, Index) { return 0U; }, 0.2, {});
  EXPECT_EQ(spread.joined.sharedPoints, 0U);
  EXPECT_EQ(eulerCharacteristic(spread.joined.surface), 2);
}

TEST(SurfacePiece, RandomFacesKeepTheTopology)
{
  const SurfaceInput whole = toInput(torus(40, 20, 2, 1));
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::size_t count = 2 + seed % 5;
    const bool blobs = seed % 2 == 0;
    std::vector<Vector3> centres(count);
    for (Vector3& c : centres)
    {
      c = Vector3(random() % 601 / 100.0 - 3, random() % 601 / 100.0 - 3, 0);
    }
    const auto pieceOf = [&](const Vector3& middle, Index)
    {
      if (!blobs)
      {
        return static_cast<std::size_t>(random() % count);
      }
      return static_cast<std::size_t>(std::min_element(centres.begin(), centres.end(),
                                        [&](const Vector3& a, const Vector3& b)
                                        { return (middle - a).norm() < (middle - b).norm(); }) -
        centres.begin());
    };
    // A part without triangles is no piece.
    const std::vector<Part> parts = split(whole, count, pieceOf);
    if (std::any_of(
          parts.begin(), parts.end(), [](const Part& part) { return part.polygon.empty(); }))
    {
      continue;
    }
    std::vector<std::size_t> of(whole.polygonOffsets.size() - 1);
    for (std::size_t p = 0; p < count; ++p)
    {
      for (const Index f : parts[p].polygon)
      {
        of[f] = p;
      }
    }
    const Spread spread =
      thinPieces(whole, count, [&](const Vector3&, Index f) { return of[f]; }, 0.5, {});
    EXPECT_EQ(eulerCharacteristic(spread.joined.surface), 0);
  }
}

TEST(SurfacePiece, FeaturesGoOnFromPieceToPiece)
{
  // The cut runs along an edge of the cube on one side, and across its faces on the others.
  const SurfaceInput whole = toInput(unitCube(12));
  const Spread spread = thinPieces(
    whole, 2, [](const Vector3& middle, Index) { return middle.z() > 0.999999 ? 1U : 0U; }, 0.2,
    radians(40));
  double length = 0;
  const SurfaceInput& surface = spread.joined.surface;
  for (std::size_t h = 0; h < surface.polygonPoints.size(); ++h)
  {
    if ((surface.detectedFeatures[h / 3] >> h % 3 & 1U) != 0)
    {
      const std::size_t next = h % 3 == 2 ? h - 2 : h + 1;
      length += 0.5 *
        (surface.points[surface.polygonPoints[next]] - surface.points[surface.polygonPoints[h]])
          .norm();
    }
  }
  EXPECT_NEAR(length, 12, 1e-12);
}

/// All corners of a level and the middles of its triangles, carried.
TEST(SurfacePiece, PlacesComeBackWhereTheyWere)
{
  const SurfaceInput whole = toInput(torus(160, 80, 2, 1));
  Spread spread = thinPieces(
    whole, 2, [](const Vector3& middle, Index) { return byX(middle, -3, 3, 2); }, 0.25, {});
  for (std::size_t p = 0; p < 2; ++p)
  {
    const PieceLevel& level = spread.levels[p];
    std::vector<SurfacePoint> places;
    std::vector<Vector3> before;
    std::vector<bool> isCorner;
    for (Index t = 0; t < level.triangles.size(); ++t)
    {
      for (const std::array<double, 3>& weights :
        { std::array<double, 3>{ 1, 0, 0 }, { 0, 0, 1 }, { 1.0 / 3, 1.0 / 3, 1.0 / 3 } })
      {
        Vector3 point = Vector3::Zero();
        for (std::size_t k = 0; k < 3; ++k)
        {
          point += weights[k] * level.points[level.triangles[t][k]];
        }
        places.push_back({ t, weights });
        before.push_back(point);
        isCorner.push_back(weights[0] != weights[1]);
      }
    }
    const std::vector<CarriedPlace> carried = spread.pieces[p].carry(places);
    ASSERT_EQ(carried.size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      const double moved = (pointOf(spread.parts[p].input, carried[i].source) - before[i]).norm();
      // A corner stays, but for rounding; the middle of a triangle is within the sagitta and a part of its size.
      EXPECT_LT(moved, isCorner[i] ? 1e-9 : 0.1);
      EXPECT_NEAR(
        carried[i].source.weights[0] + carried[i].source.weights[1] + carried[i].source.weights[2],
        1, 1e-12);
      EXPECT_GE(
        *std::min_element(carried[i].source.weights.begin(), carried[i].source.weights.end()), 0);
    }
  }
}

/// The map from the thinned surface to the surface is one to one: triangles of a fine grid on each thinned triangle
/// keep their orientation and cover the surface once.
TEST(SurfacePiece, WhatIsCarriedCoversTheSurfaceOnce)
{
  const SurfaceInput whole = toInput(torus(90, 45, 2, 1));
  Spread spread = thinPieces(whole, 1, [](const Vector3&, Index) { return 0U; }, 0.3, {});
  constexpr int kSteps = 8;
  const PieceLevel& level = spread.levels[0];
  std::vector<SurfacePoint> places;
  for (Index t = 0; t < level.triangles.size(); ++t)
  {
    for (int i = 0; i <= kSteps; ++i)
    {
      for (int j = 0; j <= kSteps - i; ++j)
      {
        const double a = static_cast<double>(i) / kSteps, b = static_cast<double>(j) / kSteps;
        places.push_back({ t, { std::max(0.0, 1 - a - b), a, b } });
      }
    }
  }
  const std::vector<CarriedPlace> carried = spread.pieces[0].carry(places);
  const auto at = [&](std::size_t first, int i, int j)
  {
    const int before = i * (kSteps + 1) - i * (i - 1) / 2;
    return pointOf(
      spread.parts[0].input, carried[first + static_cast<std::size_t>(before + j)].source);
  };
  const std::size_t each = (kSteps + 1) * (kSteps + 2) / 2;
  double area = 0, opposed = 0;
  for (Index t = 0; t < level.triangles.size(); ++t)
  {
    for (int i = 0; i < kSteps; ++i)
    {
      for (int j = 0; j < kSteps - i; ++j)
      {
        for (const bool upper : { false, true })
        {
          if (upper && i + j + 2 > kSteps)
          {
            continue;
          }
          const Vector3 p = at(t * each, i + (upper ? 1 : 0), j + (upper ? 1 : 0));
          const Vector3 q = upper ? at(t * each, i, j + 1) : at(t * each, i + 1, j);
          const Vector3 r = upper ? at(t * each, i + 1, j) : at(t * each, i, j + 1);
          const Vector3 n = 0.5 * (q - p).cross(r - p);
          // The normal of the torus with radii 2 and 1 at p.
          const Vector3 ring = 2 * Vector3(p.x(), p.y(), 0).normalized();
          (n.dot(p - ring) > 0 ? area : opposed) += n.norm();
        }
      }
    }
  }
  EXPECT_LT(opposed, 1e-4 * area);
  EXPECT_NEAR(area / areaOf(whole), 1, 0.02);
}

TEST(SurfacePiece, TheSameForAnyNumberOfThreads)
{
  const SurfaceInput whole = toInput(torus(200, 100, 2, 1));
  const auto halves = [](const Vector3& middle, Index) { return byX(middle, -3, 3, 2); };
  Spread one = thinPieces(whole, 2, halves, 0.2, {}, 1);
  Spread four = thinPieces(whole, 2, halves, 0.2, {}, 4);
  for (std::size_t p = 0; p < 2; ++p)
  {
    ASSERT_EQ(one.levels[p].triangles, four.levels[p].triangles);
    std::vector<SurfacePoint> places;
    for (Index t = 0; t < one.levels[p].triangles.size(); ++t)
    {
      places.push_back({ t, { 0.5, 0.3, 0.2 } });
    }
    const auto a = one.pieces[p].carry(places);
    const auto b = four.pieces[p].carry(places);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      EXPECT_EQ(a[i].source.polygon, b[i].source.polygon);
      EXPECT_EQ(a[i].source.weights, b[i].source.weights);
    }
  }
}

/// All the way: quads of the joined pieces, their points on the pieces.
TEST(SurfacePiece, QuadsOfAllPieces)
{
  const SurfaceInput whole = toInput(torus(150, 75, 2, 1));
  RemeshOptions options;
  options.quads = 600;
  options.threads = 1;
  const double edgeLength = pieceOptionsOf(options, areaOf(whole), 8).edgeLength;
  EXPECT_NEAR(edgeLength, 0.2 * std::sqrt(areaOf(whole) / 600), 1e-12);
  Spread spread = thinPieces(
    whole, 4, [](const Vector3& middle, Index) { return byX(middle, -3, 3, 4); }, edgeLength,
    options.featureAngle);
  const RemeshResult made = remesh(spread.joined.surface, options);
  ASSERT_TRUE(made.status.ok()) << made.status.message;
  EXPECT_NEAR(static_cast<double>(made.quads.quads.size()), 600, 120);
  std::vector<std::vector<SurfacePoint>> places(4);
  for (std::size_t v = 0; v < made.quads.points.size(); ++v)
  {
    const SourceLocation at =
      made.surface.locate(made.quads.sourceFace[v], made.quads.sourceWeights[v]);
    const auto& first = spread.joined.firstTriangle;
    const auto piece = static_cast<std::size_t>(
      std::upper_bound(first.begin(), first.end(), at.polygon) - first.begin() - 1);
    SurfacePoint place{ at.polygon - first[piece], {} };
    for (std::size_t k = 0; k < 3; ++k)
    {
      // The corners of the triangle in the order of the piece.
      const Index corner = spread.joined.surface.polygonPoints[3 * std::size_t{ at.polygon } + k];
      const auto found = std::find(at.points.begin(), at.points.end(), corner);
      ASSERT_NE(found, at.points.end());
      place.weights[k] = at.weights[static_cast<std::size_t>(found - at.points.begin())];
    }
    places[piece].push_back(place);
  }
  for (std::size_t p = 0; p < 4; ++p)
  {
    EXPECT_GT(places[p].size(), 50U);
    for (const CarriedPlace& carried : spread.pieces[p].carry(places[p]))
    {
      const Vector3 point = pointOf(spread.parts[p].input, carried.source);
      const Vector3 ring = 2 * Vector3(point.x(), point.y(), 0).normalized();
      EXPECT_NEAR((point - ring).norm(), 1, 2e-3); // the facets of 75 sides
    }
  }
}

/// Pieces of the unit sphere with a handle at a place, whose mouth is a tenth of the sphere, for quads of 0.4.
Spread piecesWithHandle(const Vector3& place, double closedLoop)
{
  PieceOptions options;
  options.edgeLength = 0.08;
  options.quadEdge = 0.4;
  options.closedLoop = closedLoop;
  options.threads = 1;
  return thinPieces(
    toInput(sphereWithHandle(5, place).mesh), 2,
    [](const Vector3& middle, Index) { return middle.x() < 0 ? 0 : 1; }, options);
}

TEST(SurfacePiece, ShortHandlesAreCutBeforeTheyAreThinned)
{
  const Vector3 place = Vector3(1, 0.2, 0.3).normalized();
  EXPECT_EQ(eulerCharacteristic(piecesWithHandle(place, 0).joined.surface), 0);
  EXPECT_EQ(eulerCharacteristic(piecesWithHandle(place, 0.05).joined.surface), 0); // it is longer
  Spread cut = piecesWithHandle(place, 0.4);
  EXPECT_EQ(eulerCharacteristic(cut.joined.surface), 2);
  EXPECT_TRUE(cut.pieces[0].closedHandles().empty());
  ASSERT_EQ(cut.pieces[1].closedHandles().size(), 1U);
  const SmallDetail& handle = cut.pieces[1].closedHandles().front();
  EXPECT_EQ(handle.kind, DetailKind::Handle);
  EXPECT_EQ(handle.decision, DetailDecision::Simplify);
  EXPECT_GT(handle.size, 0.1);
  EXPECT_LT(handle.size, 1);
  EXPECT_LT((handle.place - place).norm(), 0.2);
  EXPECT_EQ(cut.pieces[1].repairText(), "");
}

TEST(SurfacePiece, PlacesWhereAHandleWasAreTold)
{
  const Vector3 place = Vector3(1, 0.2, 0.3).normalized();
  Spread cut = piecesWithHandle(place, 0.4);
  std::vector<SurfacePoint> places;
  constexpr int kSteps = 12;
  const PieceLevel& level = cut.levels[1];
  for (Index t = 0; t < level.triangles.size(); ++t)
  {
    for (int i = 0; i < kSteps; ++i)
    {
      for (int j = 0; j < kSteps - i; ++j)
      {
        const double a = (i + 0.3) / kSteps, b = (j + 0.3) / kSteps;
        places.push_back({ t, { 1 - a - b, a, b } });
      }
    }
  }
  std::size_t off = 0;
  for (const CarriedPlace& carried : cut.pieces[1].carry(places))
  {
    const Vector3 beside = pointOf(cut.parts[1].input, carried.source);
    const Vector3 at = carried.offInput.value_or(beside);
    EXPECT_NEAR(at.norm(), 1, 0.01); // nothing of the handle, which is a tenth high, is left
    EXPECT_LT((at - beside).norm(), 0.2);
    off += carried.offInput ? 1 : 0;
  }
  EXPECT_GT(off, 0U);
  EXPECT_LT(off, places.size() / 20);
}

/// There the points that are kept are near each other, so that the whole surface shows the handle as it is.
TEST(SurfacePiece, HandlesNearSharedPointsAreLeftToTheWhole)
{
  Spread spread = piecesWithHandle(Vector3(0.1, 1, 0).normalized(), 0.4);
  EXPECT_EQ(eulerCharacteristic(spread.joined.surface), 0);
  EXPECT_TRUE(spread.pieces[1].closedHandles().empty());
}

TEST(SurfacePiece, OptionsOfPieces)
{
  RemeshOptions options;
  options.quads = 100;
  const PieceOptions piece = pieceOptionsOf(options, 4, 7);
  EXPECT_DOUBLE_EQ(piece.quadEdge, 0.2);
  EXPECT_DOUBLE_EQ(piece.edgeLength, 0.04);
  EXPECT_DOUBLE_EQ(piece.closedLoop, 0.2);
  options.smallDetails = SmallDetails::Simplify;
  EXPECT_DOUBLE_EQ(pieceOptionsOf(options, 4, 7).closedLoop, 0.6);
  for (const SmallDetails kept : { SmallDetails::Resolve, SmallDetails::Keep })
  {
    options.smallDetails = kept;
    EXPECT_EQ(pieceOptionsOf(options, 4, 7).closedLoop, 0);
  }
  options.smallDetails = SmallDetails::Simplify;
  options.sizes.smallest = 0.1;
  options.sizes.largest = 1;
  options.sizes.gapQuads = 1;
  ASSERT_TRUE(options.sizes.any());
  EXPECT_EQ(pieceOptionsOf(options, 4, 7).closedLoop, 0);
  EXPECT_DOUBLE_EQ(pieceOptionsOf(options, 4, 7).edgeLength, 0.01);
}

TEST(SurfacePiece, IdsDecideWherePiecesHaveThem)
{
  PieceLevel piece;
  piece.points = { Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0) };
  piece.inputPoint = { 0, 1, 2 };
  piece.shared = { 1, 1, 0 };
  piece.triangles = { { 0, 1, 2 } };
  piece.detectedFeatures = { 0 };
  piece.requestedFeatures = { 0 };
  const std::vector<PieceLevel> pieces{ piece, piece };
  EXPECT_EQ(joinPieces(pieces, {}, {}).surface.points.size(), 4U);
  EXPECT_EQ(joinPieces(pieces, { { 7, 8, 9 }, { 7, 10, 9 } }, {}).surface.points.size(), 5U);
  EXPECT_THROW(joinPieces(pieces, { { 7, 8 }, { 7, 10, 9 } }, {}), InvalidInput);
}

TEST(SurfacePiece, RefusesWhatIsNoPiece)
{
  PieceOptions options;
  options.edgeLength = 0.1;
  EXPECT_THROW(SurfacePiece(SurfaceInput{}, options), InvalidInput);
  options.edgeLength = 0;
  EXPECT_THROW(SurfacePiece(toInput(sphere(1)), options), InvalidInput);
  Spread spread =
    thinPieces(toInput(sphere(3)), 1, [](const Vector3&, Index) { return 0U; }, 0.3, {});
  EXPECT_THROW(
    spread.pieces[0].carry({ { static_cast<Index>(spread.levels[0].triangles.size()), {} } }),
    InvalidInput);
}

} // namespace
} // namespace quadrille
