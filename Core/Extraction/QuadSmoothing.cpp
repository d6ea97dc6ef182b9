// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/QuadSmoothing.h"

#include "Base/Parallel.h"
#include "Extraction/QuadShape.h"
#include "Extraction/SurfaceWalk.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace quadrille
{
namespace
{

constexpr std::size_t kChunk = 256;
constexpr int kMaximumFaces = 2000;
/// A curve that turns by more than this at a mesh vertex has a corner there that a quad vertex
/// keeps.
constexpr double kCurveCorner = 0.5235987755982988; // 30 degrees
/// A move must not shorten the shortest edge at a point below this part of their mean: the scaled
/// Jacobian does not see lengths.
constexpr double kShortEdge = 0.35;
/// Below this a quad is worth a search in all directions.
constexpr double kBadShape = 0.4;

// ------------------------------------------------------------------ who may move where

enum class Freedom : std::uint8_t
{
  Fixed,
  Curve,
  Surface
};

/// Two lists per point in one array each.
struct PointLists
{
  std::vector<Index> first;
  std::vector<Index> items;

  PointLists(std::size_t points, const std::vector<std::pair<Index, Index>>& pairs)
    : first(points + 1, 0), items(pairs.size())
  {
    for (const auto& pair : pairs)
    {
      ++first[pair.first + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Index> fill(first.begin(), first.end() - 1);
    for (const auto& pair : pairs)
    {
      items[fill[pair.first]++] = pair.second;
    }
  }
  const Index* begin(Index p) const { return items.data() + first[p]; }
  const Index* end(Index p) const { return items.data() + first[p + 1]; }
  Index size(Index p) const { return first[p + 1] - first[p]; }
};

PointLists incidentQuads(const QuadMesh& quads)
{
  std::vector<std::pair<Index, Index>> pairs;
  for (Index q = 0; q < quads.quads.size(); ++q)
  {
    for (const Index p : quads.quads[q])
    {
      pairs.emplace_back(p, q);
    }
  }
  return { quads.points.size(), pairs };
}

PointLists lineNeighbours(const QuadMesh& quads)
{
  std::vector<std::pair<Index, Index>> pairs;
  for (const QuadLine& line : quads.lines)
  {
    pairs.emplace_back(line.a, line.b);
    pairs.emplace_back(line.b, line.a);
  }
  return { quads.points.size(), pairs };
}

/// Does the constrained curve run nearly straight through the vertex of corner h?
bool isSmoothCurve(const Mesh& mesh, Index h)
{
  const std::vector<Index> edges = constrainedEdgesAt(mesh, h);
  if (edges.size() != 2)
  {
    return false;
  }
  const auto outgoing = [&](Index e) -> Vector3
  { return mesh.origin[e] == mesh.origin[h] ? mesh.edgeVector(e) : -mesh.edgeVector(e); };
  const Vector3 a = outgoing(edges[0]);
  const Vector3 b = -outgoing(edges[1]);
  return a.dot(b) > std::cos(kCurveCorner) * a.norm() * b.norm();
}

class Smoother
{
public:
  Smoother(const Mesh& mesh, QuadMesh& quads, const SmoothingOptions& options)
    : mesh_(mesh), quads_(quads), options_(options), incident_(incidentQuads(quads)),
      lines_(lineNeighbours(quads))
  {
    classify();
    computeNormals();
    colour();
  }

  SmoothingResult run()
  {
    SmoothingResult result;
    for (int step = 0; step < options_.steps; ++step)
    {
      report(options_.progress, static_cast<double>(step) / options_.steps, "smoothing");
      const std::size_t moves = sweep();
      result.moves += moves;
      if (moves == 0)
      {
        break;
      }
    }
    return result;
  }

private:
  struct Quality
  {
    double worst = std::numeric_limits<double>::infinity();
    double sum = 0;

    bool betterThan(const Quality& other) const
    {
      if (worst < other.worst)
      {
        return false;
      }
      return sum > other.sum + 1e-6 || (other.worst < kBadShape && worst > other.worst + 1e-6);
    }
  };

  struct Move
  {
    SurfacePoint place;
    Vector3 position;
    Quality quality;
  };

  void classify()
  {
    freedom_.resize(quads_.points.size());
    for (Index p = 0; p < quads_.points.size(); ++p)
    {
      freedom_[p] = lines_.size(p) == 0 ? Freedom::Surface : curveFreedom(p);
      if (lines_.size(p) == 0 && quads_.onBoundary[p])
      {
        freedom_[p] = Freedom::Fixed; // where cells were trimmed
      }
      if (!options_.fixedVertices.empty() && isOnFixedVertex(p))
      {
        freedom_[p] = Freedom::Fixed;
      }
    }
    for (const Index p : quads_.polygonPoints)
    {
      freedom_[p] = Freedom::Fixed;
    }
  }

  bool isOnFixedVertex(Index p) const
  {
    const std::optional<Index> corner = meshCorner(quads_, p);
    return corner &&
      std::binary_search(
        options_.fixedVertices.begin(), options_.fixedVertices.end(), mesh_.origin[*corner]);
  }

  /// A point of a curve slides only where the curve goes straight on in the quad mesh (two quads on
  /// each side) and, on a mesh vertex, in space.
  Freedom curveFreedom(Index p) const
  {
    const bool straight =
      lines_.size(p) == 2 && incident_.size(p) == (quads_.onBoundary[p] ? 2u : 4u);
    const std::optional<Index> corner = meshCorner(quads_, p);
    if (!straight || (corner && !isSmoothCurve(mesh_, *corner)) || (!corner && !curvePoint(p)))
    {
      return Freedom::Fixed;
    }
    return quads_.onBoundary[p] || isOpposite(p) ? Freedom::Curve : Freedom::Fixed;
  }

  /// Do the two lines at an inner point of valence four have two quads on each side?
  bool isOpposite(Index p) const
  {
    const Index a = lines_.begin(p)[0];
    const Index b = lines_.begin(p)[1];
    for (const Index* q = incident_.begin(p); q != incident_.end(p); ++q)
    {
      const std::array<Index, 4>& corners = quads_.quads[*q];
      const bool hasA = std::find(corners.begin(), corners.end(), a) != corners.end();
      const bool hasB = std::find(corners.begin(), corners.end(), b) != corners.end();
      if (hasA && hasB)
      {
        return false; // a quarter turn between them
      }
    }
    return true;
  }

  Vector3 faceNormal(Index f) const
  {
    return mesh_.edgeVector(3 * f).cross(mesh_.edgeVector(3 * f + 1)).normalized();
  }

  /// Which side of a quad is out: a scaled Jacobian cannot see a quad that is turned over as a
  /// whole.
  void computeNormals()
  {
    normal_.resize(quads_.quads.size());
    for (std::size_t q = 0; q < normal_.size(); ++q)
    {
      normal_[q] = faceNormal(quads_.quadSourceFace[q]);
      for (const Index p : quads_.quads[q])
      {
        if (lines_.size(p) == 0) // on a crease the face may be that of the other side
        {
          normal_[q] += faceNormal(quads_.sourceFace[p]);
        }
      }
    }
  }

  /// Colours so that two points of a quad never have the same one.
  void colour()
  {
    const Index points = static_cast<Index>(quads_.points.size());
    std::vector<Index> colourOf(points, kInvalidIndex);
    std::vector<Index> usedBy; // per colour the last point that saw it
    for (Index p = 0; p < points; ++p)
    {
      for (const Index* q = incident_.begin(p); q != incident_.end(p); ++q)
      {
        for (const Index n : quads_.quads[*q])
        {
          if (colourOf[n] != kInvalidIndex)
          {
            usedBy[colourOf[n]] = p;
          }
        }
      }
      Index c = 0;
      while (c < usedBy.size() && usedBy[c] == p)
      {
        ++c;
      }
      if (c == usedBy.size())
      {
        usedBy.push_back(kInvalidIndex);
        classes_.emplace_back();
      }
      colourOf[p] = c;
      if (freedom_[p] != Freedom::Fixed)
      {
        classes_[c].push_back(p);
      }
    }
  }

  std::size_t sweep()
  {
    std::size_t moves = 0;
    for (const std::vector<Index>& points : classes_)
    {
      std::vector<std::uint8_t> moved(points.size(), 0);
      parallelFor(points.size(), kChunk, options_.threads,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t i = begin; i < end; ++i)
          {
            moved[i] = improve(points[i]) ? 1 : 0;
          }
        });
      moves += static_cast<std::size_t>(std::count(moved.begin(), moved.end(), 1));
    }
    return moves;
  }

  bool improve(Index p)
  {
    const Quality before = qualityAt(p, quads_.points[p]);
    if (before.worst > options_.goodShape)
    {
      return false;
    }
    const bool bad = before.worst < kBadShape;
    const EdgeLengths lengths = edgeLengths(p, quads_.points[p]);
    const double reach = 0.5 * (bad ? lengths.mean : lengths.shortest);
    Move best{ { quads_.sourceFace[p], quads_.sourceWeights[p] }, quads_.points[p], before };
    tryWantedPlaces(p, reach, best);
    if (bad)
    {
      tryAllDirections(p, reach, best);
    }
    if (!best.quality.betterThan(before))
    {
      return false;
    }
    quads_.points[p] = best.position;
    quads_.sourceFace[p] = best.place.face;
    quads_.sourceWeights[p] = best.place.weights;
    return true;
  }

  /// Towards the average of the neighbours, and to where the quads would be parallelograms.
  void tryWantedPlaces(Index p, double reach, Move& best) const
  {
    const Vector3 here = quads_.points[p];
    const Vector3 average = averageOfNeighbours(p) - here;
    const Vector3 parallelogram = parallelogramCorner(p) - here;
    for (const Vector3& wanted : { average, parallelogram, Vector3((average + parallelogram) / 2) })
    {
      const double length = wanted.norm();
      const double scale = length > reach ? reach / length : 1.0;
      for (const double factor : { 1.0, 0.5, 0.25 })
      {
        tryMove(p, factor * scale * wanted, best);
      }
    }
  }

  void tryAllDirections(Index p, double reach, Move& best) const
  {
    const Vector3 normal = faceNormal(quads_.sourceFace[p]);
    const Vector3 x = mesh_.edgeVector(3 * quads_.sourceFace[p]).normalized();
    const Vector3 y = normal.cross(x);
    for (const double factor : { 1.0, 0.3, 0.1, 0.03 })
    {
      for (int i = 0; i < 8; ++i)
      {
        const double angle = i * 0.7853981633974483; // 45 degrees
        tryMove(p, factor * reach * (std::cos(angle) * x + std::sin(angle) * y), best);
      }
    }
  }

  /// Keeps the move in `best` when it is better than what is there.
  void tryMove(Index p, const Vector3& displacement, Move& best) const
  {
    const std::optional<SurfacePoint> place =
      freedom_[p] == Freedom::Curve ? slide(p, displacement) : walk(p, displacement);
    if (!place)
    {
      return;
    }
    const Vector3 position = positionOf(mesh_, *place);
    if (shrinksShortEdge(p, position))
    {
      return;
    }
    const Quality quality = qualityAt(p, position);
    if (quality.betterThan(best.quality))
    {
      best = { *place, position, quality };
    }
  }

  std::optional<SurfacePoint> walk(Index p, const Vector3& displacement) const
  {
    return walkSurface(
      mesh_, { quads_.sourceFace[p], quads_.sourceWeights[p] }, displacement, kMaximumFaces);
  }

  std::optional<CurvePoint> curvePoint(Index p) const
  {
    if (const std::optional<Index> corner = meshCorner(quads_, p))
    {
      const std::vector<Index> edges = constrainedEdgesAt(mesh_, *corner);
      if (edges.empty())
      {
        return std::nullopt;
      }
      const bool starts = mesh_.origin[edges[0]] == mesh_.origin[*corner];
      return CurvePoint{ edges[0], starts ? 0.0 : 1.0 };
    }
    return locateOnCurve(mesh_, { quads_.sourceFace[p], quads_.sourceWeights[p] });
  }

  std::optional<SurfacePoint> slide(Index p, const Vector3& displacement) const
  {
    const std::optional<CurvePoint> from = curvePoint(p);
    if (!from)
    {
      return std::nullopt;
    }
    const double length = displacement.dot(mesh_.edgeVector(from->h).normalized());
    const std::optional<CurvePoint> to = walkCurve(mesh_, *from, length, kMaximumFaces);
    return to ? std::optional<SurfacePoint>(to->onSurface()) : std::nullopt;
  }

  Quality qualityAt(Index p, const Vector3& position) const
  {
    Quality quality;
    for (const Index* q = incident_.begin(p); q != incident_.end(p); ++q)
    {
      std::array<Vector3, 4> corners;
      for (std::size_t i = 0; i < 4; ++i)
      {
        const Index c = quads_.quads[*q][i];
        corners[i] = c == p ? position : quads_.points[c];
      }
      const Vector3 normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]);
      const double shape = scaledJacobian(corners);
      // A quad that turns over passes through a bow tie of -1 and gets worse from there.
      const double value = normal.dot(normal_[*q]) > 0 ? shape : -2 - shape;
      quality.worst = std::min(quality.worst, value);
      quality.sum += value;
    }
    return quality;
  }

  /// Edge neighbours, each once per quad: an inner edge counts twice, a boundary edge once.
  template <typename Visitor>
  void forEachNeighbour(Index p, const Visitor& visit) const
  {
    for (const Index* q = incident_.begin(p); q != incident_.end(p); ++q)
    {
      const std::array<Index, 4>& c = quads_.quads[*q];
      for (std::size_t i = 0; i < 4; ++i)
      {
        if (c[i] == p)
        {
          visit(quads_.points[c[(i + 1) % 4]]);
          visit(quads_.points[c[(i + 3) % 4]]);
        }
      }
    }
  }

  Vector3 averageOfNeighbours(Index p) const
  {
    Vector3 sum = Vector3::Zero();
    int count = 0;
    forEachNeighbour(p,
      [&](const Vector3& x)
      {
        sum += x;
        ++count;
      });
    return sum / std::max(count, 1);
  }

  Vector3 parallelogramCorner(Index p) const
  {
    Vector3 sum = Vector3::Zero();
    for (const Index* q = incident_.begin(p); q != incident_.end(p); ++q)
    {
      const std::array<Index, 4>& c = quads_.quads[*q];
      const std::size_t i = static_cast<std::size_t>(std::find(c.begin(), c.end(), p) - c.begin());
      sum += quads_.points[c[(i + 1) % 4]] + quads_.points[c[(i + 3) % 4]] -
        quads_.points[c[(i + 2) % 4]];
    }
    return sum / incident_.size(p);
  }

  struct EdgeLengths
  {
    double shortest = std::numeric_limits<double>::infinity();
    double mean = 0;
  };

  EdgeLengths edgeLengths(Index p, const Vector3& position) const
  {
    EdgeLengths lengths;
    int count = 0;
    forEachNeighbour(p,
      [&](const Vector3& x)
      {
        const double length = (x - position).norm();
        lengths.shortest = std::min(lengths.shortest, length);
        lengths.mean += length;
        ++count;
      });
    lengths.mean /= std::max(count, 1);
    return lengths;
  }

  bool shrinksShortEdge(Index p, const Vector3& position) const
  {
    const EdgeLengths after = edgeLengths(p, position);
    return after.shortest < kShortEdge * after.mean &&
      after.shortest < edgeLengths(p, quads_.points[p]).shortest;
  }

  const Mesh& mesh_;
  QuadMesh& quads_;
  const SmoothingOptions& options_;
  PointLists incident_; ///< per point its quads
  PointLists lines_;    ///< per point the other ends of its lines
  std::vector<Freedom> freedom_;
  std::vector<Vector3> normal_;             ///< per quad, of the surface below it
  std::vector<std::vector<Index>> classes_; ///< movable points per colour
};

} // namespace

SmoothingResult smoothQuads(const Mesh& mesh, QuadMesh& quads, const SmoothingOptions& options)
{
  if (options.steps < 0)
  {
    throw InvalidInput("smoothing: the number of steps is negative");
  }
  if (options.steps == 0 || quads.quads.empty())
  {
    return {};
  }
  return Smoother(mesh, quads, options).run();
}

} // namespace quadrille
