// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Refine.h"

#include "Base/Progress.h"
#include "Mesh/ContentHash.h"
#include "Mesh/Sizing.h"
#include "Mesh/SmallComponents.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/SurfaceEdit.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace quadrille
{

namespace
{

/// Faces that refinement may end with: so many for each square of the maximum edge length, and for each
/// input face; a small surface may grow more, and there is an end to all.
constexpr double kFacesPerSquare = 20;
constexpr double kFacesPerFace = 16;
constexpr double kFacesPerFaceOfSmall = 160;
constexpr double kSmallEnd = 4e6;
constexpr double kMostFaces = 1e8;

constexpr std::size_t kSplitsBetweenReports = 100000;

struct LongEdge
{
  double squaredLength;
  Index halfEdge;

  bool operator<(const LongEdge& other) const
  {
    return squaredLength != other.squaredLength ? squaredLength < other.squaredLength
                                                : halfEdge > other.halfEdge;
  }
};

class LongEdgeQueue
{
public:
  LongEdgeQueue(const Mesh& mesh, double maximumLength)
    : mesh_(mesh), limit_(maximumLength * maximumLength), faces_(mesh.faceCount())
  {
    findScales(maximumLength);
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      pollNowAndThen(f);
      pushEdgesOf(f);
    }
  }

  /// Faces that were appended since are parts of f or of a neighbour of it.
  void pushNewFaces(Index f)
  {
    const Index before = faces_;
    faces_ = mesh_.faceCount();
    if (!scale_.empty())
    {
      scale_.resize(faces_, scale_[f]);
    }
    for (Index g = before; g < faces_; ++g)
    {
      pushEdgesOf(g);
    }
  }

  void pushEdgesOf(Index f)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const double length = squaredLength(h);
      if (length > limit_ && (mesh_.isBoundary(h) || h < mesh_.twin[h]))
      {
        queue_.push({ length, h });
      }
      else if (length > limit_)
      {
        queue_.push({ length, mesh_.twin[h] });
      }
    }
  }

  /// The longest edge; kInvalidIndex when none is too long. Splits rename and shorten half-edges, so what
  /// has not the length it was queued with is old.
  Index pop()
  {
    while (!queue_.empty())
    {
      const LongEdge top = queue_.top();
      queue_.pop();
      if (squaredLength(top.halfEdge) == top.squaredLength)
      {
        return top.halfEdge;
      }
    }
    return kInvalidIndex;
  }

private:
  void findScales(double maximumLength)
  {
    const ComponentSizes sizes = measureComponents(mesh_);
    const auto scale = [&](Index c) { return triangulationScale(sizes.area[c], maximumLength); };
    std::vector<double> ofComponent;
    bool anySmall = false;
    for (Index c = 0; c < sizes.area.size(); ++c)
    {
      ofComponent.push_back(scale(c) * scale(c));
      anySmall = anySmall || ofComponent.back() < 1;
    }
    for (Index f = 0; f < mesh_.faceCount() && anySmall; ++f)
    {
      scale_.push_back(ofComponent[sizes.componentOfFace[f]]);
    }
  }

  /// In sizes, the same from both sides.
  double squaredLength(Index h) const
  {
    const double length = mesh_.edgeVector(h).squaredNorm();
    const double sized = mesh_.sizing.empty()
      ? length
      : length / (sizeAt(mesh_, mesh_.origin[h]) * sizeAt(mesh_, mesh_.target(h)));
    return scale_.empty() ? sized : sized / scale_[Mesh::face(h)];
  }

  const Mesh& mesh_;
  double limit_;
  Index faces_;
  std::vector<double> scale_; ///< #F, squared; empty where no component is small
  std::priority_queue<LongEdge> queue_;
};

std::vector<std::uint8_t> verticesOnConstraints(const Mesh& mesh)
{
  std::vector<std::uint8_t> on(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (mesh.isConstrained(h))
    {
      on[mesh.origin[h]] = 1;
      on[mesh.target(h)] = 1;
    }
  }
  return on;
}

std::size_t faceLimit(const PreparedSurface& surface, double maximumLength)
{
  const double faces = surface.mesh.faceCount();
  const double area = surface.mesh.sizing.empty() ? surface.area : sizedArea(surface.mesh);
  const double growth =
    std::max(kFacesPerFace * faces, std::min(kFacesPerFaceOfSmall * faces, kSmallEnd));
  const double wanted = growth + kFacesPerSquare * area / (maximumLength * maximumLength);
  return static_cast<std::size_t>(std::min(wanted, std::max(faces, kMostFaces)));
}

/// Faces among the first `count` that had no weights before and have some now.
std::size_t countRefined(
  const PreparedSurface& surface, const std::vector<Index>& entriesBefore, Index count)
{
  std::size_t refined = 0;
  for (Index f = 0; f < count && !surface.refinedEntry.empty(); ++f)
  {
    const bool before = !entriesBefore.empty() && entriesBefore[f] != kInvalidIndex;
    refined += !before && surface.refinedEntry[f] != kInvalidIndex ? 1 : 0;
  }
  return refined;
}

} // namespace

bool splitLongEdges(PreparedSurface& surface, double maximumLength, std::size_t mostFaces,
  const ProgressCallback& progress)
{
  const Mesh& mesh = surface.mesh;
  LongEdgeQueue queue(mesh, maximumLength);
  const double firstFaces = mesh.faceCount();
  std::size_t splits = 0;
  for (Index h = queue.pop(); h != kInvalidIndex; h = queue.pop())
  {
    if (mesh.faceCount() + std::size_t{ 2 } > mostFaces)
    {
      return false;
    }
    const Index g = mesh.twin[h];
    splitEdge(surface, h);
    queue.pushEdgesOf(Mesh::face(h));
    if (g != kInvalidIndex)
    {
      queue.pushEdgesOf(Mesh::face(g));
    }
    queue.pushNewFaces(Mesh::face(h));
    if (++splits % kSplitsBetweenReports == 0)
    {
      report(progress, 0.8 * (mesh.faceCount() - firstFaces) / (mostFaces - firstFaces),
        "Splitting long edges");
    }
  }
  return true;
}

void splitEnclosedFaces(PreparedSurface& surface)
{
  const Mesh& mesh = surface.mesh;
  const Index count = mesh.faceCount();
  for (Index f = 0; f < count; ++f)
  {
    pollNowAndThen(f);
    if (mesh.isConstrained(3 * f) && mesh.isConstrained(3 * f + 1) && mesh.isConstrained(3 * f + 2))
    {
      splitFace(surface, f);
    }
  }
}

void splitChords(PreparedSurface& surface)
{
  const Mesh& mesh = surface.mesh;
  const std::vector<std::uint8_t> onConstraint = verticesOnConstraints(mesh);
  // Vertices made here are on no constraint and have ids past the end of onConstraint.
  const auto isOn = [&](Index v) { return v < onConstraint.size() && onConstraint[v] != 0; };
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (!mesh.isConstrained(h) && isOn(mesh.origin[h]) && isOn(mesh.target(h)))
    {
      splitEdge(surface, h); // what it moves comes later in the list, or is seen from its twin
    }
  }
}

void refineSurface(
  PreparedSurface& surface, double maximumEdgeLength, const ProgressCallback& progress)
{
  if (!(maximumEdgeLength > 0) || !std::isfinite(maximumEdgeLength))
  {
    throw InvalidInput("the maximum edge length must be positive and finite.");
  }
  const Index facesBefore = surface.mesh.faceCount();
  const std::vector<Index> entriesBefore = surface.refinedEntry;
  report(progress, 0, "Splitting long edges");
  const std::size_t limit = faceLimit(surface, maximumEdgeLength);
  if (!splitLongEdges(surface, maximumEdgeLength, limit, progress))
  {
    surface.notice = "Refinement stopped at " + std::to_string(limit) +
      " faces with edges longer than " + std::to_string(maximumEdgeLength) +
      " left: the surface has many long thin triangles. Remesh it into better shaped triangles for "
      "better quads.";
  }
  report(progress, 0.8, "Splitting chords between features");
  splitEnclosedFaces(surface);
  splitChords(surface);
  if (surface.mesh.faceCount() != facesBefore)
  {
    surface.repair.refinedFaces += countRefined(surface, entriesBefore, facesBefore);
    report(progress, 0.9, "Ordering the refined surface");
    orderSurface(surface, 1);
  }
  surface.hash = contentHash(surface.mesh, 1); // the caller may have changed features before
  report(progress, 1, "Surface refined");
}

} // namespace quadrille
