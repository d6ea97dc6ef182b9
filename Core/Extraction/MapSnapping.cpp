// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/MapSnapping.h"

#include "Base/Error.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace quadrille
{
namespace
{

constexpr double kLimit = 1 << 20;

void checkValues(const Mesh& mesh, const std::vector<Vector2>& uv)
{
  if (uv.size() != mesh.origin.size())
  {
    throw InvalidInput("map: " + std::to_string(uv.size()) + " uv for " +
      std::to_string(mesh.origin.size()) + " corners");
  }
  for (std::size_t h = 0; h < uv.size(); ++h)
  {
    // Written so that NaN fails, too.
    if (!(std::abs(uv[h].x()) < kLimit && std::abs(uv[h].y()) < kLimit))
    {
      throw InvalidInput("map: corner " + std::to_string(h % 3) + " of face " +
        std::to_string(h / 3) + " is not finite or beyond 2^20 quads");
    }
  }
}

Vector2 rotated(const Vector2& p, int r)
{
  switch (r & 3)
  {
    case 1:
      return { -p.y(), p.x() };
    case 2:
      return -p;
    case 3:
      return { p.y(), -p.x() };
    default:
      return p;
  }
}

/// Nearest whole transition over h; the identity where there is none.
Transition nearestTransition(const Mesh& mesh, const std::vector<Vector2>& uv, Index h)
{
  const Index g = mesh.twin[h];
  if (g == kInvalidIndex)
  {
    return {};
  }
  const Vector2 mine = uv[Mesh::next(h)] - uv[h];
  const Vector2 others = uv[g] - uv[Mesh::next(g)];
  Transition best;
  double bestFit = -1;
  for (int r = 0; r < 4; ++r)
  {
    const double fit = rotated(mine, r).dot(others);
    if (fit > bestFit)
    {
      bestFit = fit;
      best.rotation = r;
    }
  }
  const Vector2 t = uv[Mesh::next(g)] - rotated(uv[h], best.rotation);
  best.translation = { kOne * std::llround(t.x()), kOne * std::llround(t.y()) };
  return best;
}

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
    : mesh_(mesh), uv_(uv), options_(options)
  {
    result_.uv.resize(uv.size());
  }

  SnapResult run()
  {
    for (const Index h : outgoingHalfEdges(mesh_))
    {
      if (h != kInvalidIndex)
      {
        snapVertex(h);
      }
    }
    return std::move(result_);
  }

private:
  void snapVertex(Index start)
  {
    // Corners counterclockwise, each with the transition from the start's chart to its own.
    std::vector<std::pair<Index, Transition>> corners;
    Transition whole;
    Index h = start;
    do
    {
      corners.emplace_back(h, whole);
      whole = nearestTransition(mesh_, uv_, Mesh::previous(h)).after(whole);
      h = mesh_.rotateCounterclockwise(h);
    } while (h != start && h != kInvalidIndex);

    const FixedVec2 p = toFixed(snapConstrained(corners));
    const FixedVec2 chosen = h == start ? closeFan(whole, p) : p;
    for (const auto& [corner, transition] : corners)
    {
      result_.uv[corner] = transition.apply(chosen);
      result_.largestMove =
        std::max(result_.largestMove, (toDouble(result_.uv[corner]) - uv_[corner]).norm());
    }
  }

  FixedVec2 closeFan(const Transition& whole, FixedVec2 p)
  {
    if (whole.rotation != 0)
    {
      ++result_.snappedToFixedPoint;
      return fixedPoint(whole);
    }
    result_.inconsistent += whole.isIdentity() ? 0 : 1;
    return p;
  }

  /// Position in the start's chart, moved to the isolines of the constrained edges at the vertex.
  Vector2 snapConstrained(const std::vector<std::pair<Index, Transition>>& corners) const
  {
    Vector2 p = uv_[corners.front().first];
    for (const auto& [corner, transition] : corners)
    {
      const Transition back = transition.inverse();
      for (const Index side : { corner, Mesh::previous(corner) })
      {
        Vector2 q = rotated(p, transition.rotation) + toDouble(transition.translation);
        snapToIsoline(mesh_, uv_, side, options_.isolineTolerance, q);
        p = rotated(q, back.rotation) + toDouble(back.translation);
      }
    }
    return p;
  }

  const Mesh& mesh_;
  const std::vector<Vector2>& uv_;
  const SnapOptions& options_;
  SnapResult result_;
};

} // namespace

SnapResult snapMap(const Mesh& mesh, const std::vector<Vector2>& uv, const SnapOptions& options)
{
  checkValues(mesh, uv);
  return Snapper(mesh, uv, options).run();
}

} // namespace quadrille
