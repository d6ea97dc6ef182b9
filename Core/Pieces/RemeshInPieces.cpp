// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/RemeshInPieces.h"

#include "Base/Error.h"
#include "Base/Memory.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Pieces/PieceCut.h"
#include "Pieces/PlaceOnSource.h"
#include "Pieces/SurfacePiece.h"
#include "Pipeline/Estimate.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <numeric>
#include <thread>
#include <tuple>
#include <utility>

namespace quadrille
{
namespace
{

/// Numbers points of the source in the order in which they come.
class PointNumbers
{
public:
  /// points: gets them. expected: about how many there will be.
  PointNumbers(std::vector<Index>& points, std::size_t expected) : points_(points)
  {
    points_.clear();
    points_.reserve(expected + expected / 8);
    std::size_t size = 1024;
    while (size < 3 * expected)
    {
      size *= 2;
    }
    slots_.assign(size, { kInvalidIndex, 0 });
  }

  Index of(Index id)
  {
    std::size_t at = slotOf(id);
    if (slots_[at].first == kInvalidIndex)
    {
      if (2 * points_.size() >= slots_.size())
      {
        grow();
        at = slotOf(id);
      }
      slots_[at] = { id, static_cast<Index>(points_.size()) };
      points_.push_back(id);
    }
    return slots_[at].second;
  }

private:
  /// The slot of the id, or the free one where it belongs.
  std::size_t slotOf(Index id) const
  {
    // Ids of neighbours are near each other, and so are their slots; blocks of ids are scattered by the mixer of
    // MurmurHash3, as one multiplication puts the rows of a grid onto each other.
    std::uint64_t block = id >> 3;
    block = (block ^ block >> 33) * 0xff51afd7ed558ccdU;
    block = (block ^ block >> 33) * 0xc4ceb9fe1a85ec53U;
    block ^= block >> 33;
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (block << 3 | (id & 7U)) & mask;
    while (slots_[at].first != kInvalidIndex && slots_[at].first != id)
    {
      at = (at + 1) & mask;
    }
    return at;
  }

  void grow()
  {
    std::vector<std::pair<Index, Index>> before(2 * slots_.size(), { kInvalidIndex, 0 });
    before.swap(slots_);
    for (const auto& [id, number] : before)
    {
      if (id != kInvalidIndex)
      {
        slots_[slotOf(id)] = { id, number };
      }
    }
  }

  std::vector<Index>& points_;
  std::vector<std::pair<Index, Index>> slots_; ///< a power of two; free: kInvalidIndex
};

/// A piece on its way.
struct Part
{
  std::unique_ptr<SurfacePiece> piece;
  std::vector<Index> points; ///< of the source, by their numbers in the piece
  std::vector<Index> shared; ///< numbers in the piece
  PieceLevel level;
  std::vector<std::int64_t> ids; ///< of the level's points, in the source
  /// Of a piece that is still to be thinned, as its boundary may be that of another one: the points there that are not
  /// shared so far, their numbers in the source and in the piece.
  std::vector<std::pair<Index, Index>> open;
};

class PiecesRun
{
public:
  PiecesRun(const TriangleSource& source, const RemeshOptions& options, const PiecesOptions& pieces,
    PiecesResult& result)
    : source_(source), options_(options), result_(result)
  {
    refuseIf(
      pieces.trianglesOfPiece < 1000, "pieces of a surface must have at least 1000 triangles.");
    StageLaps laps;
    const double quads =
      static_cast<double>(std::min(options.quads.value_or(0), options.maximumNumberOfQuads));
    const RunEstimate estimate =
      estimateInPieces(source.triangleCount(), pieces.trianglesOfPiece, quads, options.threads);
    result_.remeshed.status = memoryStatus(estimate, source.triangleCount(), options);
    if (!result_.remeshed.status.ok())
    {
      result_.remeshed.estimate = estimate;
      return;
    }
    report(options.progress, 0,
      "Cutting the surface: " + estimateText(estimate) + " for " +
        std::to_string(source.triangleCount()) + " triangles");
    cut_ = cutIntoPieces(source, pieces.trianglesOfPiece, options.threads);
    shared_ = std::make_unique<SharedPoints>(source, cut_, options.threads);
    laps.lap("cut", source.triangleCount(), cut_.pieces());
    parts_.resize(cut_.pieces());
    thinParts();
    laps.lap("thin", source.triangleCount(), countTriangles());
    for (const StageRecord& record : stagesOfParts())
    {
      laps.records.add(
        "thin:" + record.stage, record.seconds, record.elementsIn, record.elementsOut);
    }
    const JoinedPieces joined = join();
    result_.pieces = cut_.pieces();
    result_.joinedTriangles = joined.surface.polygonOffsets.size() - 1;
    laps.lap("join", result_.joinedTriangles, joined.surface.points.size());
    remeshJoined(joined, estimate);
    tellHandlesOfParts();
    laps.add(result_.remeshed.stages);
    if (result_.remeshed.status.ok() && !options.preview)
    {
      carry(joined);
      laps.lap("carry", result_.pointSource.size(), result_.quadSource.size());
    }
    result_.remeshed.stages = laps.records.all();
  }

private:
  PieceOptions pieceOptions() const
  {
    PieceOptions piece = pieceOptionsOf(options_, cut_.area, cut_.diagonal);
    piece.threads = 1; // each thread has a piece
    return piece;
  }

  /// Tells how many pieces are done; called from any thread, but progress is the caller's thread's.
  void thinParts()
  {
    const ProgressCallback progress = subProgress(options_.progress, 0.05, 0.6, "Thinning: ");
    std::atomic<std::size_t> done{ 0 };
    const std::thread::id caller = std::this_thread::get_id();
    const auto tell = [&]
    {
      const std::size_t now = ++done;
      if (std::this_thread::get_id() == caller)
      {
        report(progress, static_cast<double>(now) / static_cast<double>(parts_.size() + 1),
          "piece " + std::to_string(now) + " of " + std::to_string(parts_.size()));
      }
    };
    parallelFor(parts_.size(), 1, options_.threads,
      [&](std::size_t p, std::size_t)
      {
        prepare(p);
        if (parts_[p].open.empty())
        {
          thinOut(p);
          tell();
        }
      });
    joinOpenBoundaries();
    parallelFor(parts_.size(), 1, options_.threads,
      [&](std::size_t p, std::size_t)
      {
        if (parts_[p].level.points.empty())
        {
          thinOut(p);
          tell();
        }
      });
    releaseFreedMemory();
  }

  void prepare(std::size_t p)
  {
    Part& part = parts_[p];
    SurfaceInput input;
    const std::size_t faces = cut_.first[p + 1] - cut_.first[p];
    input.polygonPoints.resize(3 * faces);
    input.polygonOffsets.resize(faces + 1);
    Index* const polygonPoints = input.polygonPoints.edit();
    Index* const polygonOffsets = input.polygonOffsets.edit();
    PointNumbers numbers(part.points, faces / 2);
    for (std::size_t i = 0; i < faces; ++i)
    {
      pollNowAndThen(i);
      const std::size_t f = cut_.order[cut_.first[p] + i];
      Index* const corners = polygonPoints + 3 * i;
      source_.corners(f, f + 1, corners);
      std::transform(corners, corners + 3, corners, [&](Index id) { return numbers.of(id); });
      polygonOffsets[i + 1] = static_cast<Index>(3 * (i + 1));
    }
    const std::vector<Index>& points = part.points;
    input.points.resize(points.size());
    source_.positions(points.data(), points.size(), input.points.edit());
    part.piece = std::make_unique<SurfacePiece>(std::move(input), pieceOptions());
    for (Index point = 0; point < points.size(); ++point)
    {
      if (shared_->has(points[point]))
      {
        part.shared.push_back(point);
      }
    }
    for (const Index point : part.piece->boundary())
    {
      if (!std::binary_search(part.shared.begin(), part.shared.end(), point))
      {
        part.open.emplace_back(points[point], point);
      }
    }
  }

  void thinOut(std::size_t p)
  {
    Part& part = parts_[p];
    part.piece->thinOut(part.shared);
    part.level = part.piece->level();
    part.piece->forgetLevel();
    for (const Index point : part.level.inputPoint)
    {
      const Index id = part.points[point];
      const auto other =
        std::lower_bound(sameAs_.begin(), sameAs_.end(), std::pair<Index, Index>(id, 0));
      part.ids.push_back(other != sameAs_.end() && other->first == id ? other->second : id);
    }
  }

  /// Where boundaries of pieces lie in the same places without being the same points, as in surfaces that were put
  /// together from parts, they are joined as repair does it within a piece.
  void joinOpenBoundaries()
  {
    struct Open
    {
      std::array<double, 3> place{};
      Index id = 0;
      std::size_t piece = 0;
      Index point = 0;
    };
    std::vector<Open> open;
    for (std::size_t p = 0; p < parts_.size(); ++p)
    {
      for (const auto& [id, point] : parts_[p].open)
      {
        Vector3 place;
        source_.positions(&id, 1, &place);
        open.push_back({ { place.x() + 0.0, place.y() + 0.0, place.z() + 0.0 }, id, p, point });
      }
    }
    std::sort(open.begin(), open.end(),
      [](const Open& a, const Open& b)
      { return std::tie(a.place, a.id, a.piece) < std::tie(b.place, b.id, b.piece); });
    for (std::size_t begin = 0, end = 0; begin < open.size(); begin = end)
    {
      while (end < open.size() && open[end].place == open[begin].place)
      {
        ++end;
      }
      if (std::all_of(open.begin() + static_cast<std::ptrdiff_t>(begin),
            open.begin() + static_cast<std::ptrdiff_t>(end),
            [&](const Open& o) { return o.piece == open[begin].piece; }))
      {
        continue;
      }
      for (std::size_t i = begin; i < end; ++i)
      {
        parts_[open[i].piece].shared.push_back(open[i].point);
        sameAs_.emplace_back(open[i].id, open[begin].id);
      }
    }
    std::sort(sameAs_.begin(), sameAs_.end());
    for (Part& part : parts_)
    {
      std::sort(part.shared.begin(), part.shared.end());
    }
  }

  /// Of all pieces together: numbers of elements are their sums, too.
  std::vector<StageRecord> stagesOfParts() const
  {
    std::vector<StageRecord> sums;
    for (const Part& part : parts_)
    {
      addPart(part.piece->stages().all(), sums);
    }
    return sums;
  }

  std::size_t countTriangles() const
  {
    return std::accumulate(parts_.begin(), parts_.end(), std::size_t{ 0 },
      [](std::size_t sum, const Part& part) { return sum + part.level.triangles.size(); });
  }

  JoinedPieces join()
  {
    report(options_.progress, 0.6, "Joining the pieces");
    std::vector<PieceLevel> levels;
    std::vector<std::vector<std::int64_t>> ids;
    for (Part& part : parts_)
    {
      levels.push_back(std::move(part.level));
      ids.push_back(std::move(part.ids));
      part.level = {};
    }
    shared_.reset();
    return joinPieces(levels, ids, options_.featureAngle);
  }

  void remeshJoined(const JoinedPieces& joined, const RunEstimate& estimate)
  {
    RemeshOptions options = options_;
    options.progress = subProgress(options_.progress, 0.6, 0.9);
    options.mergeCharts = false;
    result_.remeshed = remesh(joined.surface, options);
    result_.remeshed.estimate = estimate;
  }

  /// Those that were cut before the pieces were thinned.
  void tellHandlesOfParts()
  {
    std::vector<SmallDetail> closed;
    for (const Part& part : parts_)
    {
      const std::vector<SmallDetail>& here = part.piece->closedHandles();
      closed.insert(closed.end(), here.begin(), here.end());
    }
    tellClosedHandles(closed, result_.remeshed);
  }

  void carry(const JoinedPieces& joined)
  {
    const QuadMesh& quads = result_.remeshed.quads;
    result_.pointSource.resize(quads.points.size());
    result_.quadSource.resize(quads.quads.size());
    std::vector<std::vector<SurfacePoint>> places(parts_.size());
    std::vector<std::vector<std::size_t>> whose(parts_.size());
    const SourceTriangles source{ joined.surface.polygonPoints, joined.surface.points };
    const PlacesOfQuads found = placesOfQuads(result_.remeshed.surface, quads, source);
    const auto& first = joined.firstTriangle;
    for (std::size_t i = 0; i < found.places.size(); ++i)
    {
      const SurfacePoint& on = found.places[i];
      const auto piece = static_cast<std::size_t>(
        std::upper_bound(first.begin(), first.end(), on.face) - first.begin() - 1);
      places[piece].push_back({ on.face - first[piece], on.weights });
      whose[piece].push_back(found.whose[i]);
    }
    report(options_.progress, 0.9, "Carrying points to the surface");
    parallelFor(parts_.size(), 1, options_.threads,
      [&](std::size_t p, std::size_t)
      {
        carryPart(p, places[p], whose[p]);
        parts_[p].piece.reset();
      });
    releaseFreedMemory();
  }

  void carryPart(
    std::size_t p, const std::vector<SurfacePoint>& places, const std::vector<std::size_t>& whose)
  {
    if (places.empty())
    {
      return;
    }
    QuadMesh& quads = result_.remeshed.quads;
    const std::vector<CarriedPlace> carried = parts_[p].piece->carry(places);
    const std::vector<Index>& points = parts_[p].points;
    for (std::size_t i = 0; i < carried.size(); ++i)
    {
      SourceLocation at = carried[i].source;
      at.polygon = cut_.order[cut_.first[p] + at.polygon];
      for (Index& point : at.points)
      {
        point = points[point];
      }
      if (whose[i] >= quads.points.size())
      {
        result_.quadSource[whose[i] - quads.points.size()] = at;
        continue;
      }
      Vector3& place = quads.points[whose[i]];
      if (carried[i].offInput)
      {
        place = *carried[i].offInput;
        continue;
      }
      std::array<Vector3, 3> corner;
      source_.positions(at.points.data(), 3, corner.data());
      place = at.weights[0] * corner[0] + at.weights[1] * corner[1] + at.weights[2] * corner[2];
      result_.pointSource[whose[i]] = at;
    }
  }

  const TriangleSource& source_;
  const RemeshOptions& options_;
  PiecesResult& result_;
  PieceCut cut_;
  std::unique_ptr<SharedPoints> shared_;
  std::vector<Part> parts_;
  std::vector<std::pair<Index, Index>>
    sameAs_; ///< ids of the source, ascending, and the first one in that place
};

} // namespace

void tellClosedHandles(const std::vector<SmallDetail>& closed, RemeshResult& result)
{
  if (!closed.empty())
  {
    result.notices.insert(result.notices.begin(), detailsNotice(closed));
    result.details.insert(result.details.begin(), closed.begin(), closed.end());
  }
}

std::string MadeThinning::text() const
{
  const std::string cut = pieces > 1
    ? "the surface was cut into " + std::to_string(pieces) + " pieces, which were"
    : "the surface was";
  return cut + " thinned out to " + std::to_string(joinedTriangles) +
    " triangles before quads were made; the certificate is that of their map";
}

PiecesResult remeshInPieces(
  const TriangleSource& source, const RemeshOptions& options, const PiecesOptions& pieces)
{
  checkOptions(options);
  refuseIf(source.triangleCount() == 0 || source.triangleCount() >= kInvalidIndex ||
      source.pointCount() >= kInvalidIndex,
    "the surface has ", source.pointCount(), " points and ", source.triangleCount(),
    " triangles; there must be triangles, and fewer than ", kInvalidIndex,
    " of both: cut the surface into parts.");
  PiecesResult result;
  PollScope poll(options.progress);
  RemeshOptions asked = options;
  asked.progress = poll.callback();
  try
  {
    PiecesRun(source, asked, pieces, result);
  }
  catch (const Cancelled&)
  {
    result = {};
    result.remeshed.becomeStopped();
  }
  return result;
}

std::vector<SourceLocation> sourcesOfPoints(const MadeThinning& made, const QuadMesh& mesh)
{
  std::vector<SourceLocation> ofPoints = made.pointSource;
  const auto isMissing = [](const SourceLocation& at) { return at.polygon == kInvalidIndex; };
  for (bool hasChanged = true; hasChanged;)
  {
    hasChanged = false;
    for (const std::array<Index, 4>& quad : mesh.quads)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        SourceLocation& at = ofPoints[quad[i]];
        const SourceLocation& next = ofPoints[quad[(i + 1) % 4]];
        if (isMissing(at) && !isMissing(next))
        {
          at = next;
          hasChanged = true;
        }
      }
    }
  }
  return ofPoints;
}

Index sourceOfQuad(const MadeThinning& made, const QuadMesh& mesh,
  const std::vector<SourceLocation>& sourcesOfPoints, std::size_t q)
{
  const Index polygon = made.quadSource[q].polygon;
  return polygon == kInvalidIndex ? sourcesOfPoints[mesh.quads[q][0]].polygon : polygon;
}

} // namespace quadrille
