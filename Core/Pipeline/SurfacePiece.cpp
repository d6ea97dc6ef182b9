// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/SurfacePiece.h"

#include "Base/Clock.h"
#include "Base/Error.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/CloseHandles.h"
#include "Mesh/Features.h"
#include "Mesh/Handles.h"
#include "Mesh/NearLoops.h"
#include "Pipeline/ResultStore.h"
#include "Pipeline/SmallHandles.h"
#include "Pipeline/SmallParts.h"
#include "Pipeline/SurfaceVersion.h"
#include "Transfer/CarriedPlaces.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

/// Edges over the smallest ones of quads that are asked for, where these are much smaller than s: those of the
/// intermediate level.
constexpr double kEdgeOfSmallest = 0.5;
/// Handles that are cut are so many times the length below which they are from shared points.
constexpr double kReachOfLoop = 1;

} // namespace

PieceOptions pieceOptionsOf(const RemeshOptions& options, double area, double boundingBoxDiagonal)
{
  PieceOptions piece;
  const double s = options.quads ? std::sqrt(area / static_cast<double>(*options.quads))
    : options.edgeLength         ? *options.edgeLength
                                 : options.relativeEdgeLength * boundingBoxDiagonal;
  piece.edgeLength = s *
    (options.sizes.any() ? std::min(kEdgeOfPiece, kEdgeOfSmallest * options.sizes.smallest)
                         : kEdgeOfPiece);
  piece.featureAngle = options.featureAngle;
  piece.quadEdge = s;
  // Where sizes vary, a handle is short against the size there, which the whole surface knows.
  if (maySimplify(options) && !options.sizes.any())
  {
    piece.closedLoop =
      s * (options.smallDetails == SmallDetails::Simplify ? kQuadsOfLoop : kSimplifiedLoop);
  }
  return piece;
}

class SurfacePiece::Implementation
{
public:
  Implementation(SurfaceInput input, const PieceOptions& options) : options_(options)
  {
    if (!(options.edgeLength > 0) || !std::isfinite(options.edgeLength))
    {
      throw InvalidInput("the edge length of the pieces of a surface must be above 0 and finite.");
    }
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
  const std::vector<SmallDetail>& closedHandles() const { return closed_; }
  const PreparedSurface& surface() const { return surface_; }
  const PieceLevel& level() const { return told_; }
  void forgetLevel() { told_ = {}; }

  void thinOut(const std::vector<Index>& shared)
  {
    Mesh& mesh = surface_.mesh;
    Stopwatch watch;
    Hierarchy made = decimate(shared);
    stages_.add("phase1", watch.lap(), mesh.faceCount(), made.intermediate.mesh.faceCount());
    if (closeShortHandles(made.intermediate, shared))
    {
      made = decimate(shared);
    }
    stages_.add("handles", watch.lap(), mesh.faceCount(), closed_.size());
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
        return CarriedPlace{ surface_.locate(place.face, place.weights), offInput(place) };
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
    return (isNew_.empty() || isNew_[v] == 0) &&
      std::binary_search(shared.begin(), shared.end(), inputPoint_[v]);
  }

  /// Whether a shared point is nearer to the place, vertices of the surface, than a loop there reaches.
  bool isNearShared(const std::vector<Index>& place, const std::vector<Vector3>& shared) const
  {
    const auto isNear = [&](Index v)
    {
      return std::any_of(shared.begin(), shared.end(),
        [&](const Vector3& p)
        { return (surface_.mesh.position[v] - p).norm() < kReachOfLoop * options_.closedLoop; });
    };
    return std::any_of(place.begin(), place.end(), isNear);
  }

  /// Handles that are short on the piece itself, found on the level. Returns whether the surface has changed.
  bool closeShortHandles(const Level& level, const std::vector<Index>& shared)
  {
    if (!(options_.closedLoop > 0) ||
      !std::includes(boundary_.begin(), boundary_.end(), shared.begin(), shared.end()))
    {
      return false;
    }
    std::vector<Vector3> sharedPlaces;
    for (Index v = 0; v < surface_.mesh.vertexCount(); ++v)
    {
      if (isShared(v, shared))
      {
        sharedPlaces.push_back(surface_.mesh.position[v]);
      }
    }
    std::vector<std::vector<Index>> places;
    for (const HandleLoop& loop :
      findShortHandles(level.mesh, kLongerAlongEdges * options_.closedLoop))
    {
      std::vector<Index> place;
      for (const Index v : loop.vertices)
      {
        place.push_back(level.fineVertex[v]);
      }
      if (!isNearShared(place, sharedPlaces))
      {
        places.push_back(std::move(place));
      }
    }
    const std::vector<double> lengths =
      lengthsNear(surface_.mesh, places, options_.closedLoop, options_.threads)
        .value_or(std::vector<double>(places.size(), 0));
    std::vector<std::vector<Index>> shortOnes;
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      if (lengths[i] > 0)
      {
        closed_.push_back(
          { DetailKind::Handle, DetailDecision::Simplify, lengths[i] / options_.quadEdge,
            surface_.mesh.position[places[i].front()], kCutAndClosed });
        shortOnes.push_back(std::move(places[i]));
      }
    }
    if (shortOnes.empty())
    {
      return false;
    }
    const std::vector<Vector3> before = placesOfPoints();
    std::vector<SmallDetail> closed;
    for (const std::size_t i :
      closeHandles(surface_, shortOnes, kLongerAlongEdges * options_.closedLoop,
        kGirthOfLimb * options_.quadEdge, options_.threads))
    {
      closed.push_back(closed_[i]);
    }
    closed_ = std::move(closed);
    surface_.repair.closedHandles = 0; // told as details
    if (!closed_.empty())
    {
      findInputPoints();
      findNewVertices(before);
    }
    return !closed_.empty();
  }

  /// A face with a vertex that the input does not have.
  struct OffFace
  {
    Index face = kInvalidIndex;
    std::array<Vector3, 3> corners;
  };

  /// By id in the input.
  std::vector<Vector3> placesOfPoints() const
  {
    std::vector<Vector3> places;
    for (Index h = 0; h < surface_.mesh.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      const Index point = surface_.sourcePoints[Mesh::face(h)][h % 3];
      places.resize(std::max(places.size(), std::size_t{ point } + 1));
      places[point] = surface_.mesh.position[surface_.mesh.origin[h]];
    }
    return places;
  }

  /// The middles of caps: their faces have the sources of the faces beside them.
  void findNewVertices(const std::vector<Vector3>& placesBefore)
  {
    const Mesh& mesh = surface_.mesh;
    isNew_.assign(mesh.vertexCount(), 0);
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      const Index v = mesh.origin[h];
      if (placesBefore[surface_.sourcePoints[Mesh::face(h)][h % 3]] != mesh.position[v])
      {
        isNew_[v] = 1;
      }
    }
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      pollNowAndThen(f);
      const std::array<Index, 3> v{ mesh.origin[3 * f], mesh.origin[3 * f + 1],
        mesh.origin[3 * f + 2] };
      if (std::any_of(v.begin(), v.end(), [&](Index corner) { return isNew_[corner] != 0; }))
      {
        offFaces_.push_back(
          { f, { mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]] } });
      }
    }
  }

  std::optional<Vector3> offInput(const FacePlace& place) const
  {
    const auto found = std::lower_bound(offFaces_.begin(), offFaces_.end(), place.face,
      [](const OffFace& off, Index face) { return off.face < face; });
    if (found == offFaces_.end() || found->face != place.face)
    {
      return std::nullopt;
    }
    return Vector3(place.weights[0] * found->corners[0] + place.weights[1] * found->corners[1] +
      place.weights[2] * found->corners[2]);
  }

  /// What only the decimation needed: to carry a place takes the log, and the polygon of each face.
  void letGo()
  {
    surface_.mesh = {};
    std::vector<Index>().swap(inputPoint_);
    std::vector<Index>().swap(boundary_);
    std::vector<std::uint8_t>().swap(isNew_);
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
    std::sort(boundary_.begin(), boundary_.end());
    boundary_.erase(std::unique(boundary_.begin(), boundary_.end()), boundary_.end());
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
  std::vector<SmallDetail> closed_;
  std::vector<std::uint8_t> isNew_; ///< #V; empty: no vertex is
  std::vector<OffFace> offFaces_;   ///< ascending by face
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
