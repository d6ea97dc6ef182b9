// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/CreaseCurves.h"

#include "Base/Angles.h"
#include "Base/Error.h"
#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Features/EdgeCurves.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_set>
#include <utility>

namespace quadrille
{
namespace
{

/// How far the two sides of a crease are looked at, and how far apart the places are, over the edge length.
constexpr double kSideWidth = 0.5;
/// A short curve is looked at in so many places, too.
constexpr double kLeastCurvePlaces = 4;
/// Noise makes no curve of so many edge lengths.
constexpr double kLongCrease = 50;

double meanOf(const std::vector<double>& values)
{
  return std::accumulate(values.begin(), values.end(), 0.0) /
    std::max<double>(1, static_cast<double>(values.size()));
}

/// The edges that a map follows and how they go on at vertices.
class CreaseNetwork
{
public:
  CreaseNetwork(const Mesh& mesh, double edgeLength, int threads)
    : mesh_(mesh), edgeLength_(edgeLength), edges_(constrainedEdges(mesh, threads))
  {
    if (std::none_of(edges_.begin(), edges_.end(), [this](Index h) { return isDetected(h); }))
    {
      edges_.clear(); // nothing to judge
      return;
    }
    at_ = edgesAtVertices(mesh, edges_);
  }

  std::vector<CreaseCurve> curves() const
  {
    std::vector<CreaseCurve> result;
    std::vector<std::uint8_t> done(edges_.empty() ? 0 : mesh_.halfEdgeCount(), 0);
    for (std::size_t i = 0; i < edges_.size(); ++i)
    {
      pollNowAndThen(i);
      const Index h = edges_[i];
      if (done[h] == 0 && isDetected(h))
      {
        result.push_back(trace(h, done));
      }
    }
    return result;
  }

private:
  bool isDetected(Index h) const
  {
    return !mesh_.isBoundary(h) && (mesh_.flags[h] & kRequestedFeature) == 0;
  }

  /// Direction from v along edge h and on to the next junction, at most an edge length.
  Vector3 courseFrom(Index v, Index h) const
  {
    const Vector3 start = mesh_.position[v];
    const Index first = h;
    double walked = 0;
    while (true)
    {
      walked += sizedLength(mesh_, h);
      v = mesh_.otherEnd(h, v);
      if (walked >= edgeLength_ || at_.size(v) != 2)
      {
        break;
      }
      h = at_.otherThan(v, h);
      if (h == first)
      {
        break;
      }
    }
    return (mesh_.position[v] - start).stableNormalized();
  }

  /// At a junction the edge that goes on straightest from h; kInvalidIndex where all bend.
  Index straightest(Index h, Index v) const
  {
    constexpr double kBend = 0.6; // at most, in radians over an edge length
    const Vector3 forward = -courseFrom(v, h);
    double most = std::cos(kBend);
    Index best = kInvalidIndex;
    for (const Index* edge = at_.begin(v); edge != at_.end(v); ++edge)
    {
      const double cosine = *edge == h ? -1.0 : forward.dot(courseFrom(v, *edge));
      if (cosine > most)
      {
        most = cosine;
        best = *edge;
      }
    }
    return best;
  }

  /// The edge of the same curve beyond v.
  Index onwards(Index h, Index v) const
  {
    Index next = kInvalidIndex;
    if (at_.size(v) == 2)
    {
      next = at_.otherThan(v, h);
    }
    else if (at_.size(v) > 2)
    {
      const Index best = straightest(h, v);
      next = best != kInvalidIndex && straightest(best, v) == h ? best : kInvalidIndex;
    }
    return next != kInvalidIndex && isDetected(next) ? next : kInvalidIndex;
  }

  CreaseCurve trace(Index seed, std::vector<std::uint8_t>& done) const
  {
    CurveOfEdges edges = curveThrough(
      mesh_, seed, [this](Index h, Index v) { return onwards(h, v); }, done);
    CreaseCurve curve;
    for (const Index v : edges.ends)
    {
      curve.freeEnds += at_.size(v) == 1 ? 1 : 0;
    }
    curve.halfEdges = std::move(edges.edges);
    for (const Index h : curve.halfEdges)
    {
      curve.length += sizedLength(mesh_, h) / edgeLength_;
    }
    return curve;
  }

  const Mesh& mesh_;
  double edgeLength_;
  std::vector<Index> edges_;
  Grouped<> at_; ///< edges by vertex
};

/// The faces beside a half-edge, as far as no constrained edge is crossed.
struct CreaseSide
{
  Vector3 normal = Vector3::Zero();
  double turning =
    0; ///< sum over the edges in it of angle, length and squared cosine to the half-edge
};

CreaseSide lookBeside(const Mesh& mesh, Index h, double width)
{
  CreaseSide side;
  const Vector3 middle = 0.5 * (mesh.position[mesh.origin[h]] + mesh.position[mesh.target(h)]);
  const Vector3 along = mesh.edgeVector(h).stableNormalized();
  std::vector<Index> faces{ Mesh::face(h) };
  std::unordered_set<Index> seen{ Mesh::face(h) };
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    const Vector3 normal = mesh.doubleAreaNormal(faces[i]);
    side.normal += normal;
    for (Index g = 3 * faces[i]; g < 3 * faces[i] + 3; ++g)
    {
      if (mesh.isConstrained(g))
      {
        continue;
      }
      const Index next = Mesh::face(mesh.twin[g]);
      const Vector3 edge = mesh.edgeVector(g);
      const double part = edge.dot(along);
      // Half, as an edge inside is met from both of its faces.
      side.turning += 0.5 * angleBetween(normal, mesh.doubleAreaNormal(next)) * part * part /
        std::max(edge.norm(), 1e-300);
      if ((mesh.middleOfFace(next) - middle).norm() < width && seen.insert(next).second)
      {
        faces.push_back(next);
      }
    }
  }
  return side;
}

/// Places along a curve, at equal distances in the middle of parts of equal length; the half-edges that they lie on.
std::vector<Index> placesAlong(const Mesh& mesh, const CreaseCurve& curve, double edgeLength)
{
  const double step = std::min(kSideWidth, curve.length / kLeastCurvePlaces);
  std::vector<Index> places;
  double begin = 0, wanted = 0.5 * step;
  for (const Index h : curve.halfEdges)
  {
    const double end = begin + sizedLength(mesh, h) / edgeLength;
    for (; wanted <= end && wanted < curve.length; wanted += step)
    {
      places.push_back(h);
    }
    begin = end;
  }
  return places;
}

void measureCurve(const Mesh& mesh, double edgeLength, CreaseCurve& curve)
{
  std::vector<double> angles, wide, rough;
  Index last = kInvalidIndex;
  for (const Index h : placesAlong(mesh, curve, edgeLength))
  {
    if (h == last) // several places on one long edge see the same
    {
      angles.push_back(angles.back());
      wide.push_back(wide.back());
      rough.push_back(rough.back());
      continue;
    }
    poll();
    last = h;
    const double width = kSideWidth * edgeLength * sizeOfEdge(mesh, h);
    const Index twin = mesh.twin[h];
    const CreaseSide left = lookBeside(mesh, h, width);
    const CreaseSide right = lookBeside(mesh, twin, width);
    angles.push_back(
      angleBetween(mesh.doubleAreaNormal(Mesh::face(h)), mesh.doubleAreaNormal(Mesh::face(twin))));
    wide.push_back(angleBetween(left.normal, right.normal));
    rough.push_back((left.turning + right.turning) / (2 * width)); // over the length of both discs
  }
  curve.angle = meanOf(angles);
  curve.wideAngle = meanOf(wide);
  curve.roughness = middleOf(rough);
}

} // namespace

bool CreaseCurve::isCrease() const
{
  constexpr double kLeastWide = 0.5;
  constexpr double kMostRough = 0.15;
  constexpr double kRoughPerLength = kMostRough / 25;
  constexpr double kMostRoughWithOneEnd = 0.5;
  if (freeEnds == 0 || length >= kLongCrease)
  {
    return true;
  }
  const double most =
    freeEnds == 2 ? std::max(kMostRough, kRoughPerLength * length) : kMostRoughWithOneEnd;
  return wideAngle >= kLeastWide * angle && roughness <= most * angle;
}

std::vector<CreaseCurve> traceCreases(const Mesh& mesh, double edgeLength, int threads)
{
  if (!(edgeLength > 0))
  {
    throw InvalidInput("the edge length for judging creases must be positive");
  }
  std::vector<CreaseCurve> curves = CreaseNetwork(mesh, edgeLength, threads).curves();
  parallelForEach(curves.size(), 1, threads,
    [&](std::size_t i)
    {
      if (curves[i].freeEnds > 0 && curves[i].length < kLongCrease)
      {
        measureCurve(mesh, edgeLength, curves[i]);
      }
    });
  return curves;
}

CreaseReport removeFalseCreases(
  Mesh& mesh, double edgeLength, int threads, FeatureFilterReport& filtered)
{
  CreaseReport report;
  bool again = true;
  while (again)
  {
    again = false;
    report.keptCurves = 0;
    report.keptLength = 0;
    for (const CreaseCurve& curve : traceCreases(mesh, edgeLength, threads))
    {
      if (curve.isCrease())
      {
        ++report.keptCurves;
        report.keptLength += curve.length;
        continue;
      }
      again = true;
      ++report.removedCurves;
      report.removedEdges += curve.halfEdges.size();
      report.removedLength += curve.length;
      if (curve.length > report.longest)
      {
        report.longest = curve.length;
        const Index h = curve.halfEdges[curve.halfEdges.size() / 2];
        report.place = 0.5 * (mesh.position[mesh.origin[h]] + mesh.position[mesh.target(h)]);
      }
      unmarkFeatures(mesh, curve.halfEdges);
    }
    if (again)
    {
      const FeatureFilterReport more = removeUnresolvedFeatures(mesh, edgeLength, threads);
      filtered.removedEdges += more.removedEdges;
      filtered.keptEdges = more.keptEdges;
    }
  }
  return report;
}

std::string CreaseReport::text() const
{
  if (removedCurves == 0)
  {
    return {};
  }
  return std::to_string(removedCurves) +
    (removedCurves == 1 ? " curve of sharp edges is no crease: "
                        : " curves of sharp edges are no creases: ") +
    inEdgeLengths(removedLength) + " edge lengths" +
    (removedCurves == 1 ? "" : " altogether, the longest of " + inEdgeLengths(longest)) + " near " +
    placeText(place) +
    ". What ends in the surface has to stand out from its roughness and to be sharp over half an "
    "edge length, too; " +
    (keptCurves == 0 ? std::string("none is left")
                     : std::to_string(keptCurves) + (keptCurves == 1 ? " curve" : " curves") +
          " with " + inEdgeLengths(keptLength) + " edge lengths stayed") +
    " (Feature Criterion Angle, --feature-criterion angle, keeps all; or mark edges)";
}

} // namespace quadrille
