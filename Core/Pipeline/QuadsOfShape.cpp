// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/QuadsOfShape.h"

#include "Base/Parallel.h"
#include "Mesh/Surface.h"
#include "Sizes/Curvature.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace quadrille
{
namespace
{

constexpr std::size_t kPlacesOfShape = 1000;

/// The faces of places at equal distances along the area, in the order of the mesh; a large one several times.
std::vector<Index> facesOfPlaces(const Mesh& mesh, std::size_t places)
{
  std::vector<double> upTo(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    upTo[f] = mesh.doubleAreaNormal(f).norm();
  }
  std::partial_sum(upTo.begin(), upTo.end(), upTo.begin());
  std::vector<Index> faces;
  Index f = 0;
  for (std::size_t i = 0; i < places && !upTo.empty(); ++i)
  {
    const double at = upTo.back() * (static_cast<double>(i) + 0.5) / static_cast<double>(places);
    while (upTo[f] < at && f + 1 < mesh.faceCount())
    {
      ++f;
    }
    faces.push_back(f);
  }
  return faces;
}

std::size_t timesAsMany(std::size_t quads, double growth)
{
  return static_cast<std::size_t>(std::lround(growth * static_cast<double>(quads)));
}

std::string percent(double share)
{
  return std::to_string(std::lround(100 * share)) + " %";
}

} // namespace

void askForQuadsOfShape(RemeshOptions& options)
{
  options.quads = kLeastQuadsOfShape;
  options.growsWithShape = true;
}

bool growsQuads(const RemeshOptions& options)
{
  return options.growsWithShape && options.quads && !options.sizes.any() &&
    options.maximumNumberOfQuads / 2 >= timesAsMany(*options.quads, kGrowthOfQuads.back());
}

std::optional<std::size_t> mostQuads(const RemeshOptions& options)
{
  return growsQuads(options) ? timesAsMany(*options.quads, kGrowthOfQuads.back()) : options.quads;
}

std::optional<std::size_t> quadsAsked(const RemeshOptions& options, std::size_t target)
{
  return growsQuads(options) ? target : options.quads;
}

double shareThatTurns(const Mesh& mesh, double edgeLength, double turn, int threads)
{
  const std::vector<Index> faces = facesOfPlaces(mesh, kPlacesOfShape);
  std::vector<std::uint8_t> turns(faces.size(), 0);
  parallelForEach(faces.size(), 1, threads,
    [&](std::size_t i)
    {
      const double curvature = curvatureRound(mesh, faces[i], 0.5 * edgeLength).largest;
      turns[i] = std::abs(curvature) * edgeLength > turn ? 1 : 0;
    });
  const auto count = std::count(turns.begin(), turns.end(), 1);
  return turns.empty() ? 0 : static_cast<double>(count) / static_cast<double>(turns.size());
}

std::string QuadsOfShape::text(std::size_t least) const
{
  if (quads == least)
  {
    return "";
  }
  return std::to_string(quads) + " quads are asked for, as nobody has said how many: with " +
    std::to_string(least) + " the surface would turn by more than 45 degrees over an edge on " +
    percent(meltedBefore) + " of its area, and shapes would melt there; with these on " +
    percent(melted) + " (Number Of Quads, --quads, quads= ask for another number)";
}

QuadsOfShape quadsOfShape(
  const PreparedSurface& surface, double sizedArea, const RemeshOptions& options)
{
  const std::size_t least = *options.quads;
  QuadsOfShape found;
  for (const double growth : kGrowthOfQuads)
  {
    found.quads = timesAsMany(least, growth);
    const double edgeLength = std::sqrt(sizedArea / static_cast<double>(found.quads));
    found.melted = shareThatTurns(surface.mesh, edgeLength, kMostTurn, options.threads);
    found.meltedBefore = found.quads == least ? found.melted : found.meltedBefore;
    if (found.melted <= kMostMelted)
    {
      break;
    }
  }
  return found;
}

std::string settleQuads(const PreparedSurface& surface, double sizedArea, ResultStore* store,
  ResultKey key, RemeshOptions& options)
{
  if (!growsQuads(options))
  {
    return "";
  }
  const std::size_t least = *options.quads;
  const auto found = findOrMake<QuadsOfShape>(
    store, KeyMaker(key).add(least, kMostTurn).key(),
    [&] { return quadsOfShape(surface, sizedArea, options); },
    [](const QuadsOfShape&) { return sizeof(QuadsOfShape); });
  options.quads = found->quads;
  options.growsWithShape = false;
  return found->text(least);
}

} // namespace quadrille
