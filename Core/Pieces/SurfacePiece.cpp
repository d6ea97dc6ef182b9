// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/SurfacePiece.h"

#include "Base/Clock.h"
#include "Base/Lists.h"
#include "Base/Refuse.h"
#include "Features/Features.h"
#include "Hierarchy/Hierarchy.h"
#include "Pieces/CarriedPlaces.h"
#include "Pieces/HandlesOfPiece.h"
#include "Pipeline/PlannedSurface.h"
#include "Pipeline/QuadsOfShape.h"
#include "Pipeline/ResultStore.h"
#include "Pipeline/SmallParts.h"
#include "Prepare/Prepare.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace quadrille
{
namespace
{

/// Edges over the smallest ones of quads that are asked for, where these are much smaller than s: those of the
/// intermediate level.
constexpr double kEdgeOfSmallest = 0.5;

} // namespace

PieceOptions pieceOptionsOf(const RemeshOptions& options, double area, double boundingBoxDiagonal)
{
  PieceOptions piece;
  const std::optional<std::size_t> quads = mostQuads(options);
  const double s = quads ? std::sqrt(area / static_cast<double>(*quads))
    : options.edgeLength ? *options.edgeLength
                         : options.relativeEdgeLength * boundingBoxDiagonal;
  piece.edgeLength = s *
    (options.sizes.any() ? std::min(kEdgeOfPiece, kEdgeOfSmallest * options.sizes.smallest)
                         : kEdgeOfPiece);
  piece.featureAngle = options.featureAngle;
  piece.quadEdge = s;
  // Where sizes vary, a handle is short against the size there, which the whole surface knows.
  if (maySimplify(options) && !options.sizes.any())
  {
    piece.closedLoop = s *
      std::max(options.smallestDetail,
        options.smallDetails == SmallDetails::Simplify ? kQuadsOfLoop : 0.0);
  }
  return piece;
}

class SurfacePiece::Implementation
{
public:
  Implementation(SurfaceInput input, const PieceOptions& options)
    : options_(options), handles_(options.closedLoop, options.quadEdge)
  {
    refuseIf(!(options.edgeLength > 0) || !std::isfinite(options.edgeLength),
      "the edge length of the pieces of a surface must be above 0 and finite.");
    PrepareOptions prepare;
    prepare.featureAngle = options.featureAngle;
    prepare.threads = options.threads;
    prepare.progress = options.progress;
    const std::size_t polygons = input.polygonOffsets.empty() ? 0 : input.polygonOffsets.size() - 1;
    surface_ = prepareSurface(std::move(input), prepare);
    for (const auto& [name, seconds] : surface_.seconds)
    {
      stages_.add(name, seconds, polygons, surface_.mesh.faceCount());
    }
    findInputPoints();
    findBoundary();
  }

  const std::vector<Index>& boundary() const { return boundary_; }
  const StageRecords& stages() const { return stages_; }
  const std::vector<SmallDetail>& closedHandles() const { return handles_.closed(); }
  const PreparedSurface& surface() const { return surface_; }
  const PieceLevel& level() const { return told_; }
  void forgetLevel() { told_ = {}; }

  void thinOut(const std::vector<Index>& shared)
  {
    Mesh& mesh = surface_.mesh;
    Stopwatch watch;
    Hierarchy made = decimate(shared);
    stages_.add("phase1", watch.lap(), mesh.faceCount(), made.intermediate.mesh.faceCount());
    if (closeHandles(made.intermediate, shared))
    {
      made = decimate(shared);
    }
    stages_.add("handles", watch.lap(), mesh.faceCount(), handles_.closed().size());
    const std::vector<BorderNormal> border = borderNormals(shared);
    level_ = std::move(made.intermediate);
    log_ = std::move(made.log);
    tellLevel(shared);
    tellBorder(border);
    letGo();
  }

  std::vector<CarriedPlace> carry(const std::vector<PiecePlace>& places)
  {
    std::vector<FacePlace> onLevel(places.size());
    std::transform(places.begin(), places.end(), onLevel.begin(),
      [](const PiecePlace& place) {
        return FacePlace{ place.triangle, place.weights };
      });
    Stopwatch watch;
    const std::vector<FacePlace> onPiece =
      carryPlaces(level_, log_, log_.rounds.size(), onLevel, options_.threads, options_.progress);
    stages_.add("carry", watch.lap(), places.size(), places.size());
    log_ = {};
    level_ = {};
    std::vector<CarriedPlace> result(places.size());
    std::transform(onPiece.begin(), onPiece.end(), result.begin(),
      [this](const FacePlace& place) {
        return CarriedPlace{ surface_.locate(place.face, place.weights), handles_.offInput(place) };
      });
    return result;
  }

  std::size_t bytes() const
  {
    return bytesOf(surface_) + bytesOf(inputPoint_) + bytesOf(boundary_) + log_.recordBytes() +
      bytesOf(level_.mesh);
  }

private:
  Hierarchy decimate(const std::vector<Index>& shared) const
  {
    HierarchyOptions hierarchy;
    hierarchy.targetEdgeLength = 2 * options_.edgeLength; // phase 1 ends at a half of it
    hierarchy.threads = options_.threads;
    hierarchy.progress = options_.progress;
    for (Index v = 0; v < surface_.mesh.vertexCount(); ++v)
    {
      if (isShared(v, shared))
      {
        hierarchy.keepVertices.push_back(v);
      }
    }
    return Redecimation(surface_.mesh, surface_.hash, hierarchy).take();
  }

  bool isShared(Index v, const std::vector<Index>& shared) const
  {
    return !handles_.isNew(v) && std::binary_search(shared.begin(), shared.end(), inputPoint_[v]);
  }

  /// Of shared points, all of which the level has.
  std::vector<Vector3> placesOf(const std::vector<Index>& shared, const Level& level) const
  {
    std::vector<Vector3> places;
    for (const Index v : level.fineVertex)
    {
      if (isShared(v, shared))
      {
        places.push_back(surface_.mesh.position[v]);
      }
    }
    return places;
  }

  /// Returns whether the surface has changed.
  bool closeHandles(const Level& level, const std::vector<Index>& shared)
  {
    if (!(options_.closedLoop > 0) ||
      !std::includes(boundary_.begin(), boundary_.end(), shared.begin(), shared.end()) ||
      !handles_.close(surface_, level, placesOf(shared, level), options_.threads))
    {
      return false;
    }
    findInputPoints();
    return true;
  }

  /// What only the decimation needed: to carry a place takes the log, and the polygon of each face.
  void letGo()
  {
    surface_.mesh = {};
    std::vector<Index>().swap(inputPoint_);
    std::vector<Index>().swap(boundary_);
  }

  /// The normal beside a boundary edge between shared points.
  struct BorderNormal
  {
    std::array<Index, 2> ends; ///< vertices of the mesh
    Vector3 normal;

    bool operator<(const BorderNormal& other) const { return ends < other.ends; }
  };

  /// Ascending by their ends.
  std::vector<BorderNormal> borderNormals(const std::vector<Index>& shared) const
  {
    const Mesh& mesh = surface_.mesh;
    if (!options_.featureAngle || shared.empty())
    {
      return {};
    }
    std::vector<Index> halfEdges;
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      if (mesh.isBoundary(h) && isShared(mesh.origin[h], shared) &&
        isShared(mesh.target(h), shared))
      {
        halfEdges.push_back(h);
      }
    }
    const std::vector<Vector3> normals = normalsBeside(mesh, halfEdges, options_.threads);
    std::vector<BorderNormal> border;
    for (std::size_t i = 0; i < halfEdges.size(); ++i)
    {
      border.push_back({ { mesh.origin[halfEdges[i]], mesh.target(halfEdges[i]) }, normals[i] });
    }
    std::sort(border.begin(), border.end());
    return border;
  }

  void tellBorder(const std::vector<BorderNormal>& border)
  {
    const Mesh& mesh = level_.mesh;
    for (Index h = 0; h < mesh.halfEdgeCount() && !border.empty(); ++h)
    {
      if (!mesh.isBoundary(h))
      {
        continue;
      }
      const BorderNormal wanted{
        { level_.fineVertex[mesh.origin[h]], level_.fineVertex[mesh.target(h)] }, {}
      };
      const auto found = std::lower_bound(border.begin(), border.end(), wanted);
      if (found != border.end() && found->ends == wanted.ends)
      {
        told_.border.push_back({ Mesh::face(h), h % 3, found->normal });
      }
    }
  }

  /// Of each vertex the lowest id of the points that repair has joined there.
  void findInputPoints()
  {
    const Mesh& mesh = surface_.mesh;
    inputPoint_.assign(mesh.vertexCount(), kInvalidIndex);
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      Index& point = inputPoint_[mesh.origin[h]];
      point = std::min(point, surface_.sourcePoints[Mesh::face(h)][h % 3]);
    }
  }

  void findBoundary()
  {
    const Mesh& mesh = surface_.mesh;
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      if (mesh.isBoundary(h))
      {
        boundary_.push_back(inputPoint_[mesh.origin[h]]);
        boundary_.push_back(inputPoint_[mesh.target(h)]);
      }
    }
    sortUnique(boundary_);
  }

  void tellLevel(const std::vector<Index>& shared)
  {
    const Mesh& mesh = level_.mesh;
    told_.points = mesh.position;
    for (const Index v : level_.fineVertex)
    {
      told_.inputPoint.push_back(inputPoint_[v]);
      told_.shared.push_back(isShared(v, shared) ? 1 : 0);
    }
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      told_.triangles.push_back(
        { mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] });
      unsigned detected = 0, requested = 0;
      for (Index i = 0; i < 3; ++i)
      {
        const unsigned flags = mesh.flags[3 * f + i];
        const bool isRequested = (flags & kRequestedFeature) != 0;
        detected |= ((flags & kFeatureEdge) != 0 && !isRequested ? 1U : 0U) << i;
        requested |= (isRequested ? 1U : 0U) << i;
      }
      told_.detectedFeatures.push_back(static_cast<std::uint8_t>(detected));
      told_.requestedFeatures.push_back(static_cast<std::uint8_t>(requested));
    }
  }

  PieceOptions options_;
  PreparedSurface surface_;
  std::vector<Index> inputPoint_; ///< #V
  std::vector<Index> boundary_;
  Level level_;
  DecimationLog log_;
  PieceLevel told_;
  HandlesOfPiece handles_;
  StageRecords stages_;
};

SurfacePiece::SurfacePiece(SurfaceInput input, const PieceOptions& options)
  : implementation_(std::make_unique<Implementation>(std::move(input), options))
{
}

SurfacePiece::~SurfacePiece() = default;
SurfacePiece::SurfacePiece(SurfacePiece&&) noexcept = default;
SurfacePiece& SurfacePiece::operator=(SurfacePiece&&) noexcept = default;

const std::vector<Index>& SurfacePiece::boundary() const
{
  return implementation_->boundary();
}

std::string SurfacePiece::repairText() const
{
  return implementation_->surface().repair.text();
}

const std::vector<SmallDetail>& SurfacePiece::closedHandles() const
{
  return implementation_->closedHandles();
}

const StageRecords& SurfacePiece::stages() const
{
  return implementation_->stages();
}

void SurfacePiece::thinOut(const std::vector<Index>& shared)
{
  implementation_->thinOut(shared);
}

const PieceLevel& SurfacePiece::level() const
{
  return implementation_->level();
}

void SurfacePiece::forgetLevel()
{
  implementation_->forgetLevel();
}

std::vector<CarriedPlace> SurfacePiece::carry(const std::vector<PiecePlace>& places)
{
  return implementation_->carry(places);
}

std::size_t SurfacePiece::bytes() const
{
  return implementation_->bytes();
}

} // namespace quadrille
