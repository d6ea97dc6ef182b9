// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "ForeignMaps/MapSnapping.h"

#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Extraction/ExactMap.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace quadrille
{
namespace
{

/// Beyond this, in quads, two images of an edge or a translation are not merely imprecise.
constexpr double kSnapTolerance = 0.1;
/// So far off, in quads, images and isolines of a good map are by rounding: rotations under which they agree by so much
/// more or less are equally good, and a feature or boundary edge this near to an integer isoline is put on it.
constexpr double kImprecise = 1e-3;

std::string edgeName(Index h)
{
  return "edge " + std::to_string(h % 3) + " of cell " + std::to_string(h / 3);
}

void checkSnapArguments(
  const Mesh& mesh, const std::vector<Vector2>& uv, const SnapOptions& options)
{
  const std::string corners = std::to_string(mesh.origin.size()) + " corners";
  refuseIf(uv.size() != mesh.origin.size(), "map: ", uv.size(), " uv for ", corners);
  refuseIf(!options.matching.empty() && options.matching.size() != mesh.origin.size(),
    "map: ", options.matching.size(), " quarter turns for ", corners);
  if (!(options.valueError >= 0 && options.valueError <= 0.02))
  {
    std::ostringstream text;
    text << "map: its values are known to " << options.valueError
         << " of a quad only, too little to tell the quads apart; move the coordinates nearer to "
            "zero, or write them in double precision";
    throw InvalidInput(text.str());
  }
  const double limit = toDouble(kCoordinateLimit);
  const std::size_t h = firstRefused(uv.size(), kMediumChunk, options.threads,
    [&uv, limit](std::size_t i)
    { return std::abs(uv[i].x()) < limit && std::abs(uv[i].y()) < limit; }); // not for NaN
  if (h < uv.size())
  {
    std::ostringstream text;
    text << "map: corner " << h % 3 << " of cell " << h / 3 << " has the coordinates (" << uv[h].x()
         << ", " << uv[h].y() << "), not finite or beyond 2^20 quads";
    throw InvalidInput(text.str());
  }
}

/// One rotation for an edge.
struct Fit
{
  Transition transition;
  double residual = 0; ///< length by which the two images differ after the rotation
  double fraction = 0; ///< of the translation, from the nearest whole one
};

Fit fitOf(const Mesh& mesh, const std::vector<Vector2>& uv, Index h, int rotation)
{
  const Index g = mesh.twin[h];
  const Vector2 mine = uv[Mesh::next(h)] - uv[h];
  const Vector2 others = uv[g] - uv[Mesh::next(g)];
  Fit fit;
  fit.residual = (turned(mine, rotation) - others).norm();
  const Vector2 t = 0.5 * (uv[Mesh::next(g)] + uv[g] - turned(uv[h] + uv[Mesh::next(h)], rotation));
  const Vector2 whole(std::round(t.x()), std::round(t.y()));
  fit.fraction = (t - whole).lpNorm<Eigen::Infinity>();
  fit.transition = { rotation, { kOne * std::llround(whole.x()), kOne * std::llround(whole.y()) } };
  return fit;
}

/// The rotation with the smallest residual; of rotations that do as well the one with the least fraction.
Fit bestFit(const Mesh& mesh, const std::vector<Vector2>& uv, Index h, double ambiguity)
{
  std::array<Fit, 4> fits;
  double residual = kInfinity;
  for (int r = 0; r < 4; ++r)
  {
    fits[static_cast<std::size_t>(r)] = fitOf(mesh, uv, h, r);
    residual = std::min(residual, fits[static_cast<std::size_t>(r)].residual);
  }
  const Fit* best = nullptr;
  for (const Fit& fit : fits)
  {
    if (fit.residual <= residual + ambiguity &&
      (!best || fit.fraction < best->fraction - ambiguity))
    {
      best = &fit;
    }
  }
  return *best;
}

/// What is wrong with the edges of a part of the mesh.
struct EdgeFaults
{
  std::size_t apart = 0;      ///< images that do not match
  std::size_t fractional = 0; ///< translations that are not whole
  std::size_t charts = 0;     ///< edges over which the chart changes
  Index firstApart = kInvalidIndex;
  Index firstFractional = kInvalidIndex;
  Index firstContradiction = kInvalidIndex; ///< between matching and images
  Index firstAsymmetry = kInvalidIndex;     ///< of the matching

  void add(const EdgeFaults& other)
  {
    apart += other.apart;
    fractional += other.fractional;
    charts += other.charts;
    firstApart = std::min(firstApart, other.firstApart);
    firstFractional = std::min(firstFractional, other.firstFractional);
    firstContradiction = std::min(firstContradiction, other.firstContradiction);
    firstAsymmetry = std::min(firstAsymmetry, other.firstAsymmetry);
  }
};

/// The point that a transition with a rotation leaves in place; exact, for the translation is
/// whole.
FixedVec2 fixedPoint(const Transition& t)
{
  const FixedVec2 d = t.translation;
  switch (t.rotation)
  {
    case 1:
      return { (d.u - d.v) / 2, (d.u + d.v) / 2 };
    case 2:
      return { d.u / 2, d.v / 2 };
    default:
      return { (d.u + d.v) / 2, (d.v - d.u) / 2 };
  }
}

/// Puts the coordinate that the image of constrained half-edge h keeps on its integer, when near.
void snapToIsoline(
  const Mesh& mesh, const std::vector<Vector2>& uv, Index h, double tolerance, Vector2& p)
{
  if (!mesh.isConstrained(h))
  {
    return;
  }
  const Vector2& a = uv[h];
  const Vector2& b = uv[Mesh::next(h)];
  const int kept = std::abs(a.x() - b.x()) < std::abs(a.y() - b.y()) ? 0 : 1;
  const double isoline = std::round(a[kept]);
  if (std::abs(a[kept] - isoline) <= tolerance && std::abs(b[kept] - isoline) <= tolerance)
  {
    p[kept] = isoline;
  }
}

class Snapper
{
public:
  Snapper(const Mesh& mesh, const std::vector<Vector2>& uv, const SnapOptions& options)
    : mesh_(mesh), uv_(uv), options_(options), ambiguity_(kImprecise + 4 * options.valueError),
      isolineTolerance_(std::max(kImprecise, 4 * options.valueError))
  {
  }

  SnapResult run()
  {
    refuse(findFaults(
      [this](Index h, EdgeFaults& faults)
      {
        checkEdge(h, faults);
        checkMatching(h, faults);
      }));
    result_.uv.resize(uv_.size());
    const std::vector<Index> outgoing = outgoingHalfEdges(mesh_);
    for (const SnapResult& part :
      parallelParts<SnapResult>(outgoing.size(), kMediumChunk, options_.threads,
        [&](std::size_t begin, std::size_t end, SnapResult&snapped)
        {
          std::vector<Corner> corners;
          for (std::size_t v = begin; v < end; ++v)
          {
            if (outgoing[v] != kInvalidIndex)
            {
              snapVertex(outgoing[v], corners, snapped);
            }
          }
        }))
    {
      add(part);
    }
    return std::move(result_);
  }

  /// Of a map that fits exactly: only the given rotations can be wrong. Images of length zero
  /// say nothing about them.
  void checkExact(const std::vector<FixedVec2>& fixed) const
  {
    if (!options_.matching.empty())
    {
      const ExactMap map{ mesh_, fixed };
      refuse(findFaults(
        [this, &map](Index h, EdgeFaults& faults)
        {
          Transition t;
          if (map.transition(h, t) && t.rotation != (options_.matching[h] & 3))
          {
            faults.firstContradiction = std::min(faults.firstContradiction, h);
          }
          checkAsymmetry(h, faults);
        }));
    }
  }

private:
  struct Corner
  {
    Index h;
    Transition fromStart; ///< from the chart of the fan's first corner
  };

  // ---------------------------------------------------------------- edges

  /// Both sides of an edge take the same fit, exactly inverted.
  Fit fitAt(Index h) const
  {
    if (!options_.matching.empty())
    {
      return fitOf(mesh_, uv_, h, options_.matching[h] & 3);
    }
    return bestFit(mesh_, uv_, h, ambiguity_);
  }

  Transition transitionAt(Index h) const
  {
    const Index g = mesh_.twin[h];
    if (g == kInvalidIndex)
    {
      return {};
    }
    return h < g ? fitAt(h).transition : fitAt(g).transition.inverse();
  }

  void checkEdge(Index h, EdgeFaults& faults) const
  {
    const Fit fit = fitAt(h);
    faults.charts += fit.transition.isIdentity() && fit.fraction <= ambiguity_ ? 0 : 1;
    if (!(fit.residual <= kSnapTolerance))
    {
      ++faults.apart;
      faults.firstApart = std::min(faults.firstApart, h);
    }
    else if (!(fit.fraction <= kSnapTolerance))
    {
      ++faults.fractional;
      faults.firstFractional = std::min(faults.firstFractional, h);
    }
  }

  void checkAsymmetry(Index h, EdgeFaults& faults) const
  {
    const int around = options_.matching[h] + options_.matching[mesh_.twin[h]];
    if ((around & 3) != 0)
    {
      faults.firstAsymmetry = std::min(faults.firstAsymmetry, h);
    }
  }

  /// The given rotations are wrong where the images fit under others and not under them.
  void checkMatching(Index h, EdgeFaults& faults) const
  {
    if (options_.matching.empty())
    {
      return;
    }
    checkAsymmetry(h, faults);
    const Fit given = fitAt(h);
    const Fit best = bestFit(mesh_, uv_, h, ambiguity_);
    const bool apart =
      given.residual > kSnapTolerance && best.residual + ambiguity_ < given.residual;
    const bool fits = best.residual <= kSnapTolerance && best.fraction <= kSnapTolerance;
    if (apart || (given.fraction > kSnapTolerance && fits))
    {
      faults.firstContradiction = std::min(faults.firstContradiction, h);
    }
  }

  template <typename Check>
  EdgeFaults findFaults(const Check& check) const
  {
    const std::size_t count = mesh_.halfEdgeCount();
    EdgeFaults whole;
    for (const EdgeFaults& part : parallelParts<EdgeFaults>(count, kMediumChunk, options_.threads,
           [&](std::size_t begin, std::size_t end, EdgeFaults&found)
           {
             for (Index h = static_cast<Index>(begin); h < end; ++h)
             {
               if (mesh_.twin[h] != kInvalidIndex && h < mesh_.twin[h])
               {
                 check(h, found);
               }
             }
           }))
    {
      whole.add(part);
    }
    return whole;
  }

  void refuse(const EdgeFaults& faults) const
  {
    std::ostringstream text;
    if (const Index h = faults.firstAsymmetry; h != kInvalidIndex)
    {
      text << "map: the matching has " << int{ options_.matching[h] } << " quarter turns over "
           << edgeName(h) << " and " << int{ options_.matching[mesh_.twin[h]] } << " back over "
           << edgeName(mesh_.twin[h]) << "; they must add up to 0 or a multiple of 4";
    }
    else if (const Index c = faults.firstContradiction; c != kInvalidIndex)
    {
      text << "map: the matching has " << int{ options_.matching[c] } << " quarter turns over "
           << edgeName(c) << ", but its images in cells " << c / 3 << " and " << mesh_.twin[c] / 3
           << " differ by " << bestFit(mesh_, uv_, c, ambiguity_).transition.rotation
           << "; the matching leads from the chart of a cell to that of its neighbour. Correct it, "
              "or take the array away to have it found from the images";
    }
    else if (faults.apart > 0)
    {
      const Index a = faults.firstApart;
      text << "map: " << faults.apart
           << " edges have images that no quarter turn and translation takes to each other; "
           << edgeName(a) << " is " << (uv_[Mesh::next(a)] - uv_[a]).norm()
           << " quads long there and "
           << (uv_[Mesh::next(mesh_.twin[a])] - uv_[mesh_.twin[a]]).norm() << " in cell "
           << mesh_.twin[a] / 3
           << ". It is no integer-grid map: a texture atlas, for example, has no quads";
    }
    else if (faults.fractional > 0)
    {
      const Fit fit = fitAt(faults.firstFractional);
      text << "map: the translations are not whole over " << faults.fractional << " of the "
           << faults.charts << " edges between charts; the one over "
           << edgeName(faults.firstFractional) << " is " << fit.fraction
           << " of a quad off. Scale the texture coordinates so that one unit is one quad";
    }
    if (!text.str().empty())
    {
      throw InvalidInput(text.str());
    }
  }

  // ---------------------------------------------------------------- vertices

  void snapVertex(Index start, std::vector<Corner>& corners, SnapResult& part)
  {
    corners.clear(); // counterclockwise from start
    Transition whole;
    const bool isInside = forEachFrom(mesh_, start,
      [&](Index h)
      {
        corners.push_back({ h, whole });
        whole = transitionAt(Mesh::previous(h)).after(whole);
      });

    const FixedVec2 p = toFixed(snapConstrained(corners));
    const FixedVec2 chosen = isInside ? closeFan(whole, p, start, part) : p;
    for (const Corner& corner : corners)
    {
      result_.uv[corner.h] = corner.fromStart.apply(chosen);
      const double move = (toDouble(result_.uv[corner.h]) - uv_[corner.h]).norm();
      if (move > part.largestMove)
      {
        part.largestMove = move;
        part.largestMoveCorner = corner.h;
      }
    }
  }

  static FixedVec2 closeFan(const Transition& whole, FixedVec2 p, Index start, SnapResult& part)
  {
    if (whole.rotation != 0)
    {
      ++part.snappedToFixedPoint;
      return fixedPoint(whole);
    }
    if (!whole.isIdentity())
    {
      ++part.inconsistent;
      part.inconsistentCorner = std::min(part.inconsistentCorner, start);
    }
    return p;
  }

  /// Position in the start's chart, moved to the isolines of the constrained edges at the vertex.
  Vector2 snapConstrained(const std::vector<Corner>& corners) const
  {
    Vector2 p = uv_[corners.front().h];
    for (const auto& [corner, transition] : corners)
    {
      const Transition back = transition.inverse();
      for (const Index side : { corner, Mesh::previous(corner) })
      {
        Vector2 q = turned(p, transition.rotation) + toDouble(transition.translation);
        snapToIsoline(mesh_, uv_, side, isolineTolerance_, q);
        p = turned(q, back.rotation) + toDouble(back.translation);
      }
    }
    return p;
  }

  void add(const SnapResult& part)
  {
    result_.snappedToFixedPoint += part.snappedToFixedPoint;
    result_.inconsistent += part.inconsistent;
    result_.inconsistentCorner = std::min(result_.inconsistentCorner, part.inconsistentCorner);
    if (part.largestMove > result_.largestMove)
    {
      result_.largestMove = part.largestMove;
      result_.largestMoveCorner = part.largestMoveCorner;
    }
  }

  const Mesh& mesh_;
  const std::vector<Vector2>& uv_;
  const SnapOptions& options_;
  double ambiguity_;
  double isolineTolerance_;
  SnapResult result_;
};

/// The values on the grid; empty when one is not, bit for bit.
std::vector<FixedVec2> onGrid(const std::vector<Vector2>& uv, int threads)
{
  std::vector<FixedVec2> fixed(uv.size());
  const std::size_t refused = firstRefused(uv.size(), kMediumChunk, threads,
    [&](std::size_t h)
    {
      fixed[h] = toFixed(uv[h]);
      return toDouble(fixed[h]) == uv[h];
    });
  if (refused < uv.size())
  {
    fixed.clear();
  }
  return fixed;
}

/// Does the map need no change?
bool fitsExactly(const Mesh& mesh, const std::vector<FixedVec2>& uv, int threads)
{
  const MapCheck check = checkMap({ mesh, uv }, false, threads);
  return check.count[kResidual] == 0 && check.count[kFractional] == 0 &&
    check.count[kOffIsoline] == 0;
}

} // namespace

SnapResult snapMap(const Mesh& mesh, const std::vector<Vector2>& uv, const SnapOptions& options)
{
  checkSnapArguments(mesh, uv, options);
  std::vector<FixedVec2> fixed = onGrid(uv, options.threads);
  if (!fixed.empty() && fitsExactly(mesh, fixed, options.threads))
  {
    Snapper(mesh, uv, options).checkExact(fixed);
    SnapResult unchanged;
    unchanged.uv = std::move(fixed);
    return unchanged;
  }
  return Snapper(mesh, uv, options).run();
}

} // namespace quadrille
