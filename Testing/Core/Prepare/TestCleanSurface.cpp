// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The one check of a clean surface against all passes of the repair.
#include "Prepare/CleanSurface.h"

#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/Topology.h"
#include "Mesh/Triangulate.h"
#include "PlyFile.h"
#include "Prepare/Repair.h"
#include "RandomSurface.h"
#include "SurfaceInputs.h"

#include <filesystem>

namespace quadrille
{

namespace
{

using namespace test;

/// As prepareSurface has it before it is connected.
PreparedSurface ordered(const SurfaceInput& input)
{
  PreparedSurface surface;
  triangulate(input, surface);
  surface.mesh.position = input.points;
  orderSurface(surface, 1);
  return surface;
}

enum class Verdict
{
  Clean,
  Damaged,
  Refused ///< by the repair
};

/// Without the vertices of several fans, which are split in either way.
std::string damageOf(RepairReport repair)
{
  repair.nonManifoldVertices = 0;
  return repair.text();
}

/// The surface is clean where the repair does nothing else than split vertices, and is then connected as the repair
/// does it.
Verdict expectAsRepaired(const SurfaceInput& input, int threads = 1)
{
  PreparedSurface clean = ordered(input);
  PreparedSurface repaired = clean;
  if (clean.mesh.origin.empty())
  {
    return Verdict::Damaged;
  }
  const bool isClean = connectCleanSurface(clean, threads);
  const std::string before = repaired.repair.text();
  try
  {
    repairSurface(repaired, EdgeRuns(repaired.mesh.origin, repaired.mesh.vertexCount(), 1), 1);
  }
  catch (const InvalidInput&)
  {
    EXPECT_FALSE(isClean);
    return Verdict::Refused;
  }
  EXPECT_EQ(isClean, damageOf(repaired.repair) == before) << repaired.repair.text();
  if (!isClean)
  {
    return Verdict::Damaged;
  }
  EXPECT_EQ(clean.mesh.twin, repaired.mesh.twin);
  EXPECT_EQ(clean.mesh.origin, repaired.mesh.origin);
  EXPECT_EQ(clean.mesh.flags, repaired.mesh.flags);
  EXPECT_EQ(clean.mesh.position, repaired.mesh.position);
  EXPECT_EQ(clean.sourcePolygon, repaired.sourcePolygon);
  EXPECT_EQ(clean.sourcePoints, repaired.sourcePoints);
  EXPECT_EQ(clean.components, repaired.components);
  EXPECT_EQ(clean.repair.text(), repaired.repair.text());
  return Verdict::Clean;
}

} // namespace

TEST(CleanSurface, CleanMeshesAreConnectedAsTheRepairDoesIt)
{
  for (const Mesh& mesh : { gridPlane(7, 5), plateWithHole(3), plateL(4), unitCube(5), sphere(4),
         torus(9, 7), doubleTorus(2), openCylinder(9, 4), twoComponents() })
  {
    for (const int threads : { 1, 3 })
    {
      EXPECT_EQ(expectAsRepaired(toInput(mesh), threads), Verdict::Clean);
    }
  }
}

TEST(CleanSurface, ManyBlocksOfVertices)
{
  // A sphere of 164,000 vertices has eleven blocks, between which half-edges are passed on.
  EXPECT_EQ(expectAsRepaired(toInput(sphere(7)), 2), Verdict::Clean);
  EXPECT_EQ(expectAsRepaired(toInput(gridPlane(300, 200)), 2), Verdict::Clean);
}

TEST(CleanSurface, AFanOfAnyLengthTakesNoLongerThanItsFaces)
{
  // Half-edges round the tip ascend all the way; looking one way only, each would look at all that follow.
  constexpr Index kFaces = 200000;
  std::vector<Vector3> points{ Vector3(0, 0, 1) };
  std::vector<std::vector<Index>> polygons;
  for (Index i = 0; i < kFaces; ++i)
  {
    const double angle = 2 * kPi * i / kFaces;
    points.emplace_back(std::cos(angle), std::sin(angle), 0);
    polygons.push_back({ 0, 1 + i, 1 + (i + 1) % kFaces });
  }
  EXPECT_EQ(expectAsRepaired(makeInput(points, polygons)), Verdict::Clean);
}

TEST(CleanSurface, EachDamageIsSeen)
{
  const SurfaceInput good = toInput(unitCube(3));
  const auto with = [&](const std::function<void(SurfaceInput&)>& damage)
  {
    SurfaceInput input = good;
    damage(input);
    return expectAsRepaired(input);
  };
  const auto addFace = [](SurfaceInput& input, Index a, Index b, Index c)
  {
    input.polygonPoints.append({ a, b, c });
    input.polygonOffsets.push_back(static_cast<Index>(input.polygonPoints.size()));
  };
  const Index* first = good.polygonPoints.data();
  EXPECT_EQ(
    with([&](SurfaceInput& s) { std::swap(s.polygonPoints.edit()[0], s.polygonPoints.edit()[1]); }),
    Verdict::Damaged)
    << "a face that is reversed";
  EXPECT_EQ(
    with([&](SurfaceInput& s) { addFace(s, first[0], first[1], first[2]); }), Verdict::Damaged)
    << "a face that is there twice";
  EXPECT_EQ(with([&](SurfaceInput& s)
              { addFace(s, first[0], first[1], static_cast<Index>(s.points.size() - 1)); }),
    Verdict::Damaged)
    << "an edge of three faces";
  EXPECT_EQ(with([&](SurfaceInput& s)
              { s.points.edit()[first[0]] = (s.points[first[1]] + s.points[first[2]]) / 2; }),
    Verdict::Damaged)
    << "a face without area";
  EXPECT_EQ(expectAsRepaired(toSoup(unitCube(3))), Verdict::Damaged) << "points to be joined";
  EXPECT_EQ(expectAsRepaired(
              makeInput({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { -1, 0, 0 }, { 0, -1, 0 } },
                { { 0, 1, 2 }, { 0, 3, 4 } })),
    Verdict::Clean)
    << "two fans at a vertex";
  EXPECT_EQ(expectAsRepaired(makeInput(
              { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { -1, 0, 0 }, { 0, -1, 0 }, { 1, 1, 0 } },
              { { 0, 1, 2 }, { 0, 3, 4 }, { 1, 2, 5 } })),
    Verdict::Damaged)
    << "two fans, and a face that is reversed";
}

TEST(CleanSurface, RandomDamageIsSeen)
{
  std::array<int, 3> count{};
  for (unsigned seed = 0; seed < 1000; ++seed)
  {
    SCOPED_TRACE(seed);
    ++count[static_cast<std::size_t>(expectAsRepaired(RandomSurface(seed).make()))];
  }
  EXPECT_GT(count[0], 20);
  EXPECT_GT(count[1], 500);
}

TEST(CleanSurface, ModelsAsTheyCome)
{
  namespace fs = std::filesystem;
  std::size_t models = 0;
  for (const char* folder : { QUADRILLE_DATA, QUADRILLE_SHARED_DATA "/scan",
         QUADRILLE_SHARED_DATA "/cad", QUADRILLE_SHARED_DATA "/open" })
  {
    std::error_code code;
    for (const fs::directory_entry& file : fs::directory_iterator(folder, code))
    {
      const std::uintmax_t most = 4000000; // bytes; the test takes seconds
      if (file.path().extension() != ".ply" || file.file_size() > most)
      {
        continue;
      }
      if (const std::optional<SurfaceInput> input = loadPly(file.path().string()))
      {
        SCOPED_TRACE(file.path().filename().string());
        expectAsRepaired(*input, 2);
        ++models;
      }
    }
  }
  EXPECT_GT(models, 0U);
}

} // namespace quadrille
