// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/Fillets.h"

#include "Base/Angles.h"
#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Features/EdgeCurves.h"
#include "Features/FaceNormals.h"
#include "Features/FeatureFilter.h"
#include "Mesh/Sizing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

/// Edges that a walk crosses; one that goes on round slivers is none.
constexpr std::size_t kMostCrossedEdges = 10000;

/// Of an edge length: how far from its middle line a fillet ends. Wider ones have room for quads of their own.
constexpr double kHalfFillet = 0.35;
/// The surface is looked at as far as this times that.
constexpr double kBeyond = 2;
/// A single edge of a curve may bend the surface by this part of what the curve has to on average.
constexpr double kLeastPart = 0.5;
/// Edges that bend by this part of one beside them are the diagonals of a strip.
constexpr double kDiagonal = 0.5;

struct Crossing
{
  double distance; ///< from the begin of the walk
  double turn; ///< of the normal behind the edge since then, ahead: > 0 where the surface is convex
  Index edge;  ///< by its lower half-edge
};

/// What lies on one side of an edge.
struct Side
{
  std::vector<Crossing> crossings;
  bool isOpen = true; ///< no constrained edge came in the way

  /// The largest turn in one sense.
  double turnWithin(double distance, double sense) const
  {
    double most = 0;
    for (const Crossing& crossing : crossings)
    {
      most = crossing.distance <= distance ? std::max(most, sense * crossing.turn) : most;
    }
    return most;
  }
};

/// An edge that may be on the middle line of a fillet.
struct Line
{
  Index edge = kInvalidIndex;
  double bend = 0;           ///< at the edge itself
  double turn = 0;           ///< across the fillet
  double turnWide = 0;       ///< as far as the surface is looked at
  std::vector<Index> beside; ///< the edges across the fillet
};

/// By which angle the normal turns to `way`, a unit vector in the face that is left, on the way to the next face.
double turnBetween(const Vector3& from, const Vector3& way, const Vector3& to)
{
  return std::atan2(to.dot(way), to.dot(from));
}

/// The surface on both sides of an edge.
struct Section
{
  Index edge = kInvalidIndex;
  double bend = 0; ///< > 0
  double width = 0;
  double sense = 0; ///< 1: convex, -1
  Side left, right;
  double onLeft = 0, onRight = 0; ///< turns as far as the surface is looked at

  double turn() const { return onLeft + bend + onRight; }

  /// The edge at which the normal has turned by half; this one where both sides are even with its own bend.
  Index middle() const
  {
    constexpr double rounding = 1e-3;
    if (std::abs(onLeft - onRight) <= bend + rounding)
    {
      return edge;
    }
    const bool goesLeft = onLeft > onRight;
    const double half = turn() / 2 - bend - std::min(onLeft, onRight);
    const std::vector<Crossing>& crossings = (goesLeft ? left : right).crossings;
    const auto found = std::find_if(crossings.begin(), crossings.end(),
      [&](const Crossing& crossing) { return sense * crossing.turn >= half; });
    return found == crossings.end() ? edge : found->edge;
  }
};

class LineFinder
{
public:
  LineFinder(const Mesh& mesh, double angle, double edgeLength, int threads)
    : mesh_(mesh), normals_(mesh, 0, threads), angle_(angle), edgeLength_(edgeLength)
  {
  }

  /// > 0 where convex.
  double bendAt(Index h) const
  {
    const Index g = mesh_.twin[h];
    const Vector3 here = normals_.of(Mesh::face(h)), there = normals_.of(Mesh::face(g));
    return turnBetween(there, -inwardOf(g, there), here);
  }

  /// Of an inner edge that bends.
  Section sectionAt(Index h) const
  {
    const double bend = bendAt(h);
    Section section;
    section.edge = h;
    section.bend = std::abs(bend);
    section.sense = bend > 0 ? 1 : -1;
    section.width = kHalfFillet * edgeLength_ * sizeAt(mesh_, mesh_.origin[h]);
    section.left = across(h, kBeyond * section.width);
    section.right = across(mesh_.twin[h], kBeyond * section.width);
    section.onLeft = section.left.turnWithin(kBeyond * section.width, section.sense);
    section.onRight = section.right.turnWithin(kBeyond * section.width, section.sense);
    return section;
  }

  /// Whether no edge across is on a fillet: what it would have to turn by is more than all of this.
  bool isFlat(const Section& section) const { return section.turn() <= kLeastPart * angle_; }

  std::optional<Line> lineOf(const Section& section) const
  {
    const double turn = section.left.turnWithin(section.width, section.sense) + section.bend +
      section.right.turnWithin(section.width, section.sense);
    if (!section.left.isOpen || !section.right.isOpen || turn <= kLeastPart * angle_ ||
      section.middle() != section.edge)
    {
      return std::nullopt;
    }
    Line line{ section.edge, section.bend, turn, section.turn(), {} };
    for (const Side* side : { &section.left, &section.right })
    {
      for (const Crossing& crossing : side->crossings)
      {
        if (crossing.distance <= section.width)
        {
          line.beside.push_back(crossing.edge);
        }
      }
    }
    return line;
  }

private:
  /// A unit vector in the face of h, across that edge.
  Vector3 inwardOf(Index h, const Vector3& normal) const
  {
    return normal.cross(mesh_.edgeVector(h)).normalized();
  }

  /// From the middle of an edge straight across the face of h and what follows, as if all were laid out in a plane.
  Side across(Index h, double distance) const
  {
    Side side;
    Vector3 normal = normals_.of(Mesh::face(h));
    Vector3 place = 0.5 * (mesh_.position[mesh_.origin[h]] + mesh_.position[mesh_.target(h)]);
    Vector3 way = inwardOf(h, normal);
    double turn = 0;
    for (double walked = 0;;)
    {
      const auto [exit, length] = exitOf(h, place, way, normal);
      walked += length;
      if (exit == kInvalidIndex || walked > distance)
      {
        return side;
      }
      if (mesh_.isConstrained(exit))
      {
        side.isOpen = walked > distance / kBeyond;
        return side;
      }
      if (side.crossings.size() == kMostCrossedEdges)
      {
        side.isOpen = false;
        return side;
      }
      place += length * way;
      h = mesh_.twin[exit];
      const double onwards = -inwardOf(exit, normal).dot(way);
      const Vector3 along = mesh_.edgeVector(exit).normalized();
      const Vector3 next = normals_.of(Mesh::face(h));
      turn += turnBetween(normal, way, next);
      normal = next;
      way = (along.dot(way) * along + onwards * inwardOf(h, normal)).normalized();
      side.crossings.push_back({ walked, turn, std::min(h, exit) });
    }
  }

  /// The edge that a way leaves the face of h by, other than h, and how far that is.
  std::pair<Index, double> exitOf(
    Index h, const Vector3& place, const Vector3& way, const Vector3& normal) const
  {
    std::pair<Index, double> exit{ kInvalidIndex, kInfinity };
    for (const Index g : { Mesh::next(h), Mesh::previous(h) })
    {
      const Vector3 inward = inwardOf(g, normal);
      const double speed = -inward.dot(way);
      const double length =
        std::max(0.0, inward.dot(place - mesh_.position[mesh_.origin[g]])) / speed;
      if (speed > 0 && length < exit.second)
      {
        exit = { g, length };
      }
    }
    return exit;
  }

  const Mesh& mesh_;
  FaceNormals normals_;
  double angle_, edgeLength_;
};

/// Lines, found by their edges. One walk across a fillet leads to its middle from wherever it begins, and tells of the
/// edges that it crosses along each other, too, so that finely tessellated fillets take no longer than their edges.
class Lines
{
public:
  Lines(const Mesh& mesh, double angle, double edgeLength, int threads)
    : mesh_(mesh), finder_(mesh, angle, edgeLength, threads),
      lineOf_(mesh.halfEdgeCount(), kInvalidIndex), known_(mesh.halfEdgeCount(), kUnknown)
  {
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      if (!mesh.isConstrained(h) && h < mesh.twin[h] && known_[h] == kUnknown && bends(h))
      {
        searchFrom(h);
      }
    }
    std::sort(
      lines_.begin(), lines_.end(), [](const Line& a, const Line& b) { return a.edge < b.edge; });
    for (Index i = 0; i < lines_.size(); ++i)
    {
      lineOf_[lines_[i].edge] = i;
    }
  }

  const Line& operator[](Index edge) const { return lines_[lineOf_[edge]]; }

  /// Ascending, without diagonals of strips.
  std::vector<Index> edges() const
  {
    std::vector<Index> edges;
    for (const Line& line : lines_)
    {
      const bool isDiagonal = std::any_of(line.beside.begin(), line.beside.end(),
        [&](Index other)
        { return lineOf_[other] != kInvalidIndex && line.bend < kDiagonal * (*this)[other].bend; });
      if (!isDiagonal)
      {
        edges.push_back(line.edge);
      }
    }
    return edges;
  }

  /// Of curves side by side the longest, and of the others what is beside none; ascending.
  std::vector<Index> single(const std::vector<Index>& edges) const
  {
    const std::vector<std::vector<Index>> curves = curvesOfEdges(mesh_, edges);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < curves.size(); ++i)
    {
      order.emplace_back(-sum(curves[i], [](const Line&) { return 1; }), i);
    }
    std::sort(order.begin(), order.end());
    std::vector<std::uint8_t> isBeside(lineOf_.size(), 0);
    std::vector<Index> left;
    for (const auto& [length, i] : order)
    {
      const std::size_t before = left.size();
      std::copy_if(curves[i].begin(), curves[i].end(), std::back_inserter(left),
        [&](Index edge) { return isBeside[edge] == 0; });
      for (std::size_t k = before; k < left.size(); ++k)
      {
        for (const Index other : (*this)[left[k]].beside)
        {
          isBeside[other] = 1;
        }
      }
    }
    std::sort(left.begin(), left.end());
    return left;
  }

  /// Of a value over the length of a curve.
  template <typename Value>
  double sum(const std::vector<Index>& curve, Value value) const
  {
    return std::accumulate(curve.begin(), curve.end(), 0.0,
      [&](double sum, Index edge)
      { return sum + mesh_.edgeVector(edge).norm() * value((*this)[edge]); });
  }

private:
  enum Known : std::uint8_t
  {
    kUnknown,
    kPassed,  ///< crossed by the walk of another edge
    kLookedAt ///< by a walk of its own
  };

  bool bends(Index h) const { return std::abs(finder_.bendAt(h)) > kOnePlane; }

  void searchFrom(Index h)
  {
    while (known_[h] != kLookedAt)
    {
      const Section section = lookAt(h);
      const Index middle = section.middle();
      pass(section, section.left, middle);
      pass(section, section.right, middle);
      if (middle == h)
      {
        lookBeside(section.left);
        lookBeside(section.right);
      }
      h = middle;
    }
  }

  Section lookAt(Index h)
  {
    known_[h] = kLookedAt;
    Section section = finder_.sectionAt(h);
    if (std::optional<Line> line = finder_.lineOf(section))
    {
      lines_.push_back(std::move(*line));
    }
    return section;
  }

  /// Where a facet lies in the middle there are two lines.
  void lookBeside(const Side& side)
  {
    const auto next = std::find_if(side.crossings.begin(), side.crossings.end(),
      [&](const Crossing& crossing) { return bends(crossing.edge); });
    if (next != side.crossings.end() && known_[next->edge] != kLookedAt)
    {
      lookAt(next->edge);
    }
  }

  /// Edges beside that of the section, along it and bent as it is, need no walk of their own, but for the middle one.
  void pass(const Section& section, const Side& side, Index middle)
  {
    // Of the width: edges nearer to each other, and along each other, lie in one section.
    constexpr double kBeside = 0.125;
    // Cosine of the angle between edges that are along each other.
    constexpr double kParallelCosine = 0.9;
    const Vector3 along = mesh_.edgeVector(section.edge).normalized();
    const double within = (finder_.isFlat(section) ? 1 : kBeside) * section.width;
    for (const Crossing& crossing : side.crossings)
    {
      if (crossing.distance > within)
      {
        return;
      }
      const Vector3 edge = mesh_.edgeVector(crossing.edge);
      if (crossing.edge != middle && known_[crossing.edge] == kUnknown &&
        std::abs(edge.dot(along)) > kParallelCosine * edge.norm() &&
        section.sense * finder_.bendAt(crossing.edge) > 0)
      {
        known_[crossing.edge] = kPassed;
      }
    }
  }

  const Mesh& mesh_;
  LineFinder finder_;
  std::vector<Line> lines_;
  std::vector<Index> lineOf_;       ///< #H
  std::vector<std::uint8_t> known_; ///< #H
};

} // namespace

std::vector<Index> markFillets(Mesh& mesh, double angle, double edgeLength, int threads)
{
  refuseIf(!(edgeLength > 0) || !std::isfinite(edgeLength) || !(angle > 0),
    "fillets: the edge length and the angle must be positive");
  // In edge lengths: what is shorter is the corner between fillets.
  constexpr double kLeastLength = 2;
  // By how much more the surface turns over the wider distance than over that of the fillet, at most.
  constexpr double kMostBeyond = 1.25;
  const Lines lines(mesh, angle, edgeLength, threads);
  std::vector<Index> marked;
  for (const std::vector<Index>& curve : curvesOfEdges(mesh, lines.single(lines.edges())))
  {
    const double turn = lines.sum(curve, [](const Line& line) { return line.turn; });
    const double length = lines.sum(curve, [](const Line&) { return 1; });
    const double wide = lines.sum(curve, [](const Line& line) { return line.turnWide; });
    if (length < kLeastLength * edgeLength || turn <= angle * length || wide > kMostBeyond * turn)
    {
      continue;
    }
    for (const Index h : curve)
    {
      mesh.flags.edit()[h] |= kFeatureEdge;
      mesh.flags.edit()[mesh.twin[h]] |= kFeatureEdge;
    }
    append(marked, curve);
  }
  return marked;
}

std::string filletNotice(const Mesh& mesh, const std::vector<Index>& halfEdges, double edgeLength)
{
  double length = 0;
  Index longest = kInvalidIndex;
  for (const Index h : halfEdges)
  {
    if (mesh.isFeature(h))
    {
      length += sizedLength(mesh, h) / edgeLength;
      longest =
        longest == kInvalidIndex || mesh.edgeVector(h).norm() > mesh.edgeVector(longest).norm()
        ? h
        : longest;
    }
  }
  return longest == kInvalidIndex ? std::string()
                                  : "fillets narrower than a quad, " + inEdgeLengths(length) +
      " edge lengths altogether, one near " +
      placeText(0.5 * (mesh.position[mesh.origin[longest]] + mesh.position[mesh.target(longest)])) +
      ", are sharp edges of the quads: ask for more quads to have them round";
}

} // namespace quadrille
