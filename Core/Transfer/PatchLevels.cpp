// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/PatchLevels.h"

#include "Base/ChartRotation.h"
#include "Base/TryCount.h"
#include "Hierarchy/LogRecords.h"
#include "Numerics/IsotropicEnergy.h"
#include "Transfer/RingKernel.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace quadrille
{
namespace
{

/// Inner vertices that the levels have at most, the coarsest one first.
constexpr std::array<std::size_t, 4> kInnerVertices{ 24, 96, 384, 1536 };
/// References flatter than this (2 area / longest edge squared) are replaced by equilateral ones.
constexpr double kFlattestTriangle = 0.1;
/// A triangle of less quality than this counts as one of this quality.
constexpr double kLeastQuality = 0.01;
/// Newton steps of a vertex that has come back, and of those round it.
constexpr int kStepsOfVertex = 4;
constexpr int kStepsOfRing = 2;
/// Work of a collapse, in triangles.
constexpr std::size_t kWorkOfCollapse = 100;
/// Triangles that a vertex that stays keeps round it, in each of its sectors, where it has them.
constexpr std::size_t kLeastSector = 2;

/// Twice the area over the longest edge squared, 1 for the equilateral triangle.
double qualityOf(const Vector3& a, const Vector3& b, const Vector3& c)
{
  const double longest =
    std::max({ (b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm() });
  return longest > 0 ? (b - a).cross(c - a).norm() / longest * 1.1547005383792517 : 0;
}

/// The patch and the faces that touch it, with ids of its own.
class PatchLevels
{
public:
  PatchLevels(const Mesh& mesh, const std::vector<Index>& patch,
    const std::vector<PatchStar>& stars, const std::vector<int>& turns, double scale,
    const std::vector<FixedVec2>& uv);

  PatchLevelsResult run(const PatchSolver& solver);
  void write(std::vector<FixedVec2>& uv) const;

private:
  /// The image of a vertex is rotation x + offset, x its place.
  struct Corner
  {
    Index vertex = kInvalidIndex;
    int rotation = 0;
    FixedVec2 offset;
  };
  struct Vertex
  {
    PatchFreedom freedom = PatchFreedom::Fixed;
    FixedVec2 place; ///< in its own chart
    Vector3 position;
    Index corner = kInvalidIndex; ///< one of its corners, or none once it is gone
    int turns = 0;
    bool isIrregular = false;
    bool goesLast = false;
  };
  /// A half-edge and what was there before a collapse.
  struct OldEdge
  {
    Index h = 0, twin = 0;
    std::uint8_t constrained = 0;
  };
  struct Collapse
  {
    Index vertex = 0, target = 0;
    Index left = kInvalidIndex, right = kInvalidIndex; ///< the faces that went
    std::vector<std::pair<Index, Corner>> corners;     ///< of those that stayed, as they were
    std::vector<std::pair<Index, Index>> cornerOf;     ///< of vertices
    std::vector<OldEdge> edges;
  };

  Index face(Index h) const { return h / 3; }
  FixedVec2 image(Index c) const
  {
    return rotate(vertex_[corner_[c].vertex].place, corner_[c].rotation) + corner_[c].offset;
  }
  /// A point of the chart of a corner's face in the own chart of its vertex.
  FixedVec2 toOwn(Index c, FixedVec2 p) const
  {
    return rotate(p - corner_[c].offset, 4 - corner_[c].rotation);
  }
  Index origin(Index h) const { return corner_[h].vertex; }
  Index target(Index h) const { return corner_[Mesh::next(h)].vertex; }
  bool isConstrained(Index h) const { return constrained_[h] != 0; }

  std::vector<Index> cornersAround(Index v) const;
  bool isClosed(Index v) const { return isClosedFan_[v] != 0; }
  std::vector<Index> neighbours(Index v) const;
  std::size_t sectorWithout(Index v, Index without) const;

  std::optional<double> costOf(Index h) const;
  std::optional<std::pair<double, Index>> bestCollapse(Index v) const;
  void collapse(Index h);
  void undo(const Collapse& record);
  double shortestEdge(Index v) const;
  void coarsen();
  std::vector<std::size_t> levels() const;
  bool solve(const PatchSolver& solver);
  bool putBack(const Collapse& record);
  bool place(Index v);
  void relax(Index v, int steps);
  bool isPositive(Index f) const
  {
    return determinant(image(3 * f), image(3 * f + 1), image(3 * f + 2)) > 0;
  }

  std::vector<Index> fineFace_;   ///< of the faces; those of the patch first
  std::vector<Index> fineVertex_; ///< of the vertices
  std::size_t patchFaces_ = 0;
  std::vector<Corner> corner_;
  std::vector<Index> twin_;
  std::vector<std::uint8_t> constrained_;
  std::vector<std::uint8_t> gone_; ///< faces
  std::vector<Vertex> vertex_;
  std::vector<std::uint8_t> isClosedFan_;
  std::vector<Collapse> collapses_;
  std::size_t inner_ = 0;             ///< vertices that may move
  std::optional<std::size_t> placed_; ///< of them when those that go last were left
  double scale_ = 1;
  std::size_t work_ = 0;
};

PatchLevels::PatchLevels(const Mesh& mesh, const std::vector<Index>& patch,
  const std::vector<PatchStar>& stars, const std::vector<int>& turns, double scale,
  const std::vector<FixedVec2>& uv)
  : fineFace_(patch), patchFaces_(patch.size()), scale_(scale)
{
  // Vertices that stay have no chart of their own: their place is the origin, and each corner has its image.
  std::vector<std::pair<Index, Index>> ids; // of the mesh, of the patch
  std::vector<Index> around;
  for (const PatchStar& star : stars)
  {
    const Index v = mesh.origin[star.begin->corner];
    ids.emplace_back(v, static_cast<Index>(vertex_.size()));
    Vertex vertex;
    vertex.freedom = star.freedom;
    vertex.goesLast = star.goesLast;
    vertex.position = mesh.position[v];
    vertex.turns = turns[v];
    vertex.place = star.freedom == PatchFreedom::Fixed ? FixedVec2{} : uv[star.begin->corner];
    vertex_.push_back(vertex);
    fineVertex_.push_back(v);
    inner_ += star.freedom == PatchFreedom::Fixed ? 0U : 1U;
    for (const PatchCorner* c = star.begin; c != star.end; ++c)
    {
      around.push_back(Mesh::face(c->corner));
    }
  }
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  std::set_difference(
    around.begin(), around.end(), patch.begin(), patch.end(), std::back_inserter(fineFace_));
  std::sort(ids.begin(), ids.end());
  corner_.resize(3 * fineFace_.size());
  twin_.assign(corner_.size(), kInvalidIndex);
  constrained_.resize(corner_.size());
  gone_.assign(fineFace_.size(), 0);
  std::vector<std::pair<Index, Index>> faces; // of the mesh, of the patch
  for (Index f = 0; f < fineFace_.size(); ++f)
  {
    faces.emplace_back(fineFace_[f], f);
  }
  std::sort(faces.begin(), faces.end());
  const auto find = [](const std::vector<std::pair<Index, Index>>& list, Index id)
  {
    const auto at = std::lower_bound(list.begin(), list.end(), std::make_pair(id, Index{ 0 }));
    return at != list.end() && at->first == id ? at->second : kInvalidIndex;
  };
  for (Index f = 0; f < fineFace_.size(); ++f)
  {
    for (Index k = 0; k < 3; ++k)
    {
      const Index fine = 3 * fineFace_[f] + k, h = 3 * f + k;
      Index v = find(ids, mesh.origin[fine]);
      if (v == kInvalidIndex)
      {
        v = static_cast<Index>(vertex_.size());
        const auto at =
          std::lower_bound(ids.begin(), ids.end(), std::make_pair(mesh.origin[fine], Index{ 0 }));
        ids.insert(at, { mesh.origin[fine], v });
        Vertex vertex;
        vertex.position = mesh.position[mesh.origin[fine]];
        vertex.turns = turns[mesh.origin[fine]];
        vertex_.push_back(vertex);
        fineVertex_.push_back(mesh.origin[fine]);
      }
      corner_[h] = { v, 0, uv[fine] };
      vertex_[v].corner = h;
      constrained_[h] = mesh.isConstrained(fine) ? 1 : 0;
      if (mesh.twin[fine] != kInvalidIndex)
      {
        const Index g = find(faces, Mesh::face(mesh.twin[fine]));
        twin_[h] = g == kInvalidIndex ? g : 3 * g + mesh.twin[fine] % 3;
      }
    }
  }
  for (const PatchStar& star : stars)
  {
    const Index v = find(ids, mesh.origin[star.begin->corner]);
    for (const PatchCorner* c = star.begin;
         c != star.end && vertex_[v].freedom != PatchFreedom::Fixed; ++c)
    {
      const Index f = find(faces, Mesh::face(c->corner));
      Corner& corner = corner_[3 * f + c->corner % 3];
      corner.rotation = c->rotation;
      corner.offset = uv[c->corner] - rotate(vertex_[v].place, c->rotation);
    }
  }
  isClosedFan_.resize(vertex_.size());
  for (Index v = 0; v < vertex_.size(); ++v)
  {
    Index h = vertex_[v].corner;
    const Index first = h;
    do
    {
      h = twin_[Mesh::previous(h)];
    } while (h != kInvalidIndex && h != first);
    isClosedFan_[v] = h == first ? 1 : 0;
    vertex_[v].isIrregular = vertex_[v].turns != (isClosedFan_[v] != 0 ? 4 : 2);
  }
}

/// Counterclockwise; where the fan is open from its boundary on.
std::vector<Index> PatchLevels::cornersAround(Index v) const
{
  Index first = vertex_[v].corner;
  if (!isClosed(v))
  {
    for (Index h = first; h != kInvalidIndex;
         h = twin_[h] == kInvalidIndex ? kInvalidIndex : Mesh::next(twin_[h]))
    {
      first = h;
    }
  }
  std::vector<Index> corners;
  Index h = first;
  do
  {
    corners.push_back(h);
    h = twin_[Mesh::previous(h)];
  } while (h != kInvalidIndex && h != first);
  return corners;
}

std::vector<Index> PatchLevels::neighbours(Index v) const
{
  std::vector<Index> found;
  for (const Index c : cornersAround(v))
  {
    found.push_back(target(c));
    found.push_back(origin(Mesh::previous(c)));
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// How many triangles are left of the sector between curves that has this face, once it is gone.
std::size_t PatchLevels::sectorWithout(Index v, Index without) const
{
  const std::vector<Index> corners = cornersAround(v);
  std::size_t at = 0;
  while (at < corners.size() && face(corners[at]) != without)
  {
    ++at;
  }
  std::size_t count = 0;
  const bool closed = isClosed(v);
  const std::size_t n = corners.size();
  for (std::size_t i = at; i + 1 < n + (closed ? at : 0); ++i) // counterclockwise
  {
    const Index c = corners[(i + 1) % n];
    if (isConstrained(c))
    {
      break;
    }
    ++count;
  }
  if (count + 1 < n || !closed)
  {
    for (std::size_t i = at, steps = 0; steps + 1 < n; ++steps) // clockwise
    {
      if (isConstrained(corners[i]) || (i == 0 && !closed))
      {
        break;
      }
      i = (i + n - 1) % n;
      ++count;
    }
  }
  return count;
}

/// None where the vertex that h leaves cannot go to the other end.
std::optional<double> PatchLevels::costOf(Index h) const
{
  const Index v = origin(h), to = target(h);
  const Vertex& vertex = vertex_[v];
  const Index g = twin_[h];
  if (vertex.freedom != PatchFreedom::Plane && !isConstrained(h))
  {
    return std::nullopt;
  }
  if (g == kInvalidIndex && isClosed(v))
  {
    return std::nullopt;
  }
  // Link condition: the ends have just the apexes as common neighbours.
  const std::vector<Index> a = neighbours(v), b = neighbours(to);
  std::vector<Index> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  if (common.size() != (g == kInvalidIndex ? 1U : 2U) || (isClosed(v) && a.size() < 4) ||
    (!isClosed(v) && a.size() < 3))
  {
    return std::nullopt;
  }
  const std::vector<Index> corners = cornersAround(v);
  const std::vector<Index> there = cornersAround(to);
  if (there.size() + corners.size() > static_cast<std::size_t>(kMaximumRing))
  {
    return std::nullopt;
  }
  // What comes between the spokes to the apexes must be less than a whole turn round an irregular vertex.
  const std::size_t kept = corners.size() - (g == kInvalidIndex ? 1U : 2U);
  if (vertex_[to].isIrregular && vertex_[to].turns > 4 && 3 * kept > 2 * (there.size() + kept))
  {
    return std::nullopt;
  }
  const Index left = face(h), right = g == kInvalidIndex ? kInvalidIndex : face(g);
  const auto keepsApex = [&](Index apex, Index goes)
  {
    const Vertex& end = vertex_[apex];
    const bool bends = end.freedom == PatchFreedom::Fixed;
    std::size_t least = end.freedom == PatchFreedom::Plane ? 3 : kLeastSector;
    if (bends && end.isIrregular)
    {
      least = static_cast<std::size_t>(std::max(end.turns, 2));
    }
    return sectorWithout(apex, goes) >= least;
  };
  if (!keepsApex(origin(Mesh::previous(h)), left) ||
    (g != kInvalidIndex && !keepsApex(origin(Mesh::previous(g)), right)))
  {
    return std::nullopt;
  }
  double worst = 1;
  for (const Index c : corners)
  {
    if (face(c) == left || face(c) == right)
    {
      continue;
    }
    const Index x = target(c), y = origin(Mesh::previous(c));
    const bool allStay = vertex_[to].freedom != PatchFreedom::Plane &&
      vertex_[x].freedom != PatchFreedom::Plane && vertex_[y].freedom != PatchFreedom::Plane;
    if (allStay)
    {
      return std::nullopt; // its corners may be on one isoline
    }
    worst =
      std::min(worst, qualityOf(vertex_[to].position, vertex_[x].position, vertex_[y].position));
  }
  return (vertex.position - vertex_[to].position).squaredNorm() / std::max(worst, kLeastQuality);
}

std::optional<std::pair<double, Index>> PatchLevels::bestCollapse(Index v) const
{
  std::optional<std::pair<double, Index>> best;
  if (vertex_[v].freedom == PatchFreedom::Fixed || vertex_[v].corner == kInvalidIndex)
  {
    return best;
  }
  for (const Index h : cornersAround(v))
  {
    const std::optional<double> cost = costOf(h);
    if (cost && (!best || *cost < best->first))
    {
      best = { *cost, h };
    }
  }
  return best;
}

void PatchLevels::collapse(Index h)
{
  Collapse record;
  const Index v = origin(h), to = target(h), g = twin_[h];
  record.vertex = v;
  record.target = to;
  const auto setEdge = [&](Index e, Index other, std::uint8_t constrained)
  {
    record.edges.push_back({ e, twin_[e], constrained_[e] });
    twin_[e] = other;
    constrained_[e] = constrained;
  };
  const auto setCorner = [&](Index w, Index c)
  {
    record.cornerOf.emplace_back(w, vertex_[w].corner);
    vertex_[w].corner = c;
  };
  // In the own chart of v the other end is at rotation x + offset.
  const Corner& mine = corner_[h];
  const Corner& other = corner_[Mesh::next(h)];
  const int rotation = (other.rotation - mine.rotation) & 3;
  const FixedVec2 offset = toOwn(h, other.offset);
  const std::vector<Index> corners = cornersAround(v);
  record.left = face(h);
  record.right = g == kInvalidIndex ? kInvalidIndex : face(g);
  for (const Index c : corners)
  {
    if (face(c) != record.left && face(c) != record.right)
    {
      record.corners.emplace_back(c, corner_[c]);
      const Corner before = corner_[c];
      corner_[c] = { to, (before.rotation + rotation) & 3,
        rotate(offset, before.rotation) + before.offset };
      setCorner(to, c);
    }
  }
  const auto joinAcross = [&](Index goneEdge, Index otherEdge)
  {
    const Index a = twin_[goneEdge], b = twin_[otherEdge];
    const std::uint8_t constrained = constrained_[goneEdge] | constrained_[otherEdge];
    if (a != kInvalidIndex)
    {
      setEdge(a, b, constrained);
      setCorner(corner_[a].vertex, a);
      setCorner(corner_[Mesh::next(a)].vertex, Mesh::next(a));
    }
    if (b != kInvalidIndex)
    {
      setEdge(b, a, constrained);
      setCorner(corner_[b].vertex, b);
      setCorner(corner_[Mesh::next(b)].vertex, Mesh::next(b));
    }
  };
  joinAcross(Mesh::next(h), Mesh::previous(h));
  gone_[record.left] = 1;
  if (g != kInvalidIndex)
  {
    joinAcross(Mesh::next(g), Mesh::previous(g));
    gone_[record.right] = 1;
  }
  setCorner(v, kInvalidIndex);
  collapses_.push_back(std::move(record));
  --inner_;
}

void PatchLevels::undo(const Collapse& record)
{
  for (auto e = record.edges.rbegin(); e != record.edges.rend(); ++e)
  {
    twin_[e->h] = e->twin;
    constrained_[e->h] = e->constrained;
  }
  for (auto c = record.cornerOf.rbegin(); c != record.cornerOf.rend(); ++c)
  {
    vertex_[c->first].corner = c->second;
  }
  for (const auto& [c, before] : record.corners)
  {
    corner_[c] = before;
  }
  gone_[record.left] = 0;
  if (record.right != kInvalidIndex)
  {
    gone_[record.right] = 0;
  }
  ++inner_;
}

double PatchLevels::shortestEdge(Index v) const
{
  double shortest = std::numeric_limits<double>::infinity();
  Index h = vertex_[v].corner;
  const Index first = h;
  do
  {
    shortest =
      std::min(shortest, (vertex_[target(h)].position - vertex_[v].position).squaredNorm());
    h = twin_[Mesh::previous(h)];
  } while (h != kInvalidIndex && h != first);
  return shortest;
}

/// Down to the coarsest level, vertices with the shortest edges first.
void PatchLevels::coarsen()
{
  std::set<std::tuple<bool, double, Index>> queue; // whether it goes last, length, vertex
  std::vector<double> known(vertex_.size(), -1);
  const auto forget = [&](Index v)
  {
    if (known[v] >= 0)
    {
      queue.erase({ vertex_[v].goesLast, known[v], v });
      known[v] = -1;
    }
  };
  const auto update = [&](Index v)
  {
    forget(v);
    if (vertex_[v].freedom != PatchFreedom::Fixed && vertex_[v].corner != kInvalidIndex)
    {
      known[v] = shortestEdge(v);
      queue.insert({ vertex_[v].goesLast, known[v], v });
    }
  };
  for (Index v = 0; v < vertex_.size(); ++v)
  {
    update(v);
  }
  while (inner_ > kInnerVertices.front() && !queue.empty())
  {
    const Index v = std::get<2>(*queue.begin());
    forget(v); // until something round it changes
    if (vertex_[v].goesLast && !placed_)
    {
      placed_ = inner_;
    }
    if (const auto best = bestCollapse(v))
    {
      const std::vector<Index> ring = neighbours(v);
      collapse(best->second);
      work_ += kWorkOfCollapse;
      for (const Index w : ring)
      {
        update(w);
      }
    }
  }
}

/// Asks for a map of the level as it is. True where it is valid; then the vertices have their places of it.
bool PatchLevels::solve(const PatchSolver& solver)
{
  std::vector<Index> faces, numberOf(fineFace_.size(), kInvalidIndex);
  for (Index f = 0; f < fineFace_.size(); ++f)
  {
    if (gone_[f] == 0)
    {
      numberOf[f] = static_cast<Index>(faces.size());
      faces.push_back(f);
    }
  }
  Mesh mesh;
  std::vector<int> turns;
  std::vector<Index> vertexOf(vertex_.size(), kInvalidIndex), patch;
  std::vector<FixedVec2> uv;
  for (const Index f : faces)
  {
    if (f < patchFaces_)
    {
      patch.push_back(numberOf[f]);
    }
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const Index v = origin(h);
      if (vertexOf[v] == kInvalidIndex)
      {
        vertexOf[v] = mesh.vertexCount();
        mesh.position.push_back(vertex_[v].position);
        turns.push_back(vertex_[v].turns);
      }
      mesh.origin.push_back(vertexOf[v]);
      mesh.twin.push_back(
        twin_[h] == kInvalidIndex ? twin_[h] : 3 * numberOf[face(twin_[h])] + twin_[h] % 3);
      mesh.flags.push_back(isConstrained(h) ? kFeatureEdge : 0);
      uv.push_back(image(h));
    }
  }
  if (!solver(mesh, patch, turns, uv))
  {
    return false;
  }
  for (const Index f : patch)
  {
    for (Index k = 0; k < 3; ++k)
    {
      const Index c = 3 * faces[f] + k;
      Vertex& vertex = vertex_[origin(c)];
      if (vertex.freedom != PatchFreedom::Fixed)
      {
        vertex.place = toOwn(c, uv[3 * f + k]);
      }
    }
  }
  return true;
}

/// Into the kernel of its ring; on a curve between its neighbours there.
bool PatchLevels::place(Index v)
{
  const std::vector<Index> corners = cornersAround(v);
  const bool closed = isClosed(v);
  std::vector<FixedVec2> ring;
  ring.reserve(corners.size() + 1);
  for (const Index c : corners)
  {
    ring.push_back(toOwn(c, image(Mesh::next(c))));
  }
  if (!closed)
  {
    ring.push_back(toOwn(corners.back(), image(Mesh::previous(corners.back()))));
  }
  const int count = static_cast<int>(ring.size());
  std::optional<FixedVec2> p;
  if (vertex_[v].freedom == PatchFreedom::Plane)
  {
    p = kernelPoint(ring.data(), count, closed);
  }
  else
  {
    std::vector<FixedVec2> ends;
    for (const Index c : corners)
    {
      if (isConstrained(c))
      {
        ends.push_back(toOwn(c, image(Mesh::next(c))));
      }
    }
    if (!closed)
    {
      ends.push_back(ring.back());
    }
    if (ends.size() == 2)
    {
      p = kernelPointOnSegment(ring.data(), count, closed, ends[0], ends[1]);
    }
  }
  if (p)
  {
    vertex_[v].place = *p;
  }
  return p.has_value();
}

/// Newton steps of one vertex on the symmetric Dirichlet energy of its star, which stays positive.
void PatchLevels::relax(Index v, int steps)
{
  Vertex& vertex = vertex_[v];
  if (vertex.freedom == PatchFreedom::Fixed)
  {
    return;
  }
  const std::vector<Index> corners = cornersAround(v);
  struct Triangle
  {
    Vector2 next, previous; ///< in the own chart of the vertex
    Eigen::Matrix2d inverse;
    double weight = 0;
  };
  std::vector<Triangle> triangles;
  const FixedVec2 base = vertex.place;
  for (const Index c : corners)
  {
    const Vector3 ab = vertex_[target(c)].position - vertex.position;
    const Vector3 ac = vertex_[origin(Mesh::previous(c))].position - vertex.position;
    Triangle triangle;
    triangle.inverse = inverseOfTriangle(scale_ * ab, scale_ * ac);
    triangle.next = toDouble(toOwn(c, image(Mesh::next(c))) - base);
    triangle.previous = toDouble(toOwn(c, image(Mesh::previous(c))) - base);
    triangle.weight = 0.5 / std::abs(triangle.inverse.determinant());
    triangles.push_back(triangle);
  }
  const auto jacobian = [](const Triangle& t, const Vector2& x)
  {
    Eigen::Matrix2d edges;
    edges << t.next - x, t.previous - x;
    const Eigen::Matrix2d j = edges * t.inverse;
    return Jacobian(j(0, 0), j(1, 0), j(0, 1), j(1, 1));
  };
  const auto energy = [&](const Vector2& x)
  {
    double sum = 0;
    for (const Triangle& t : triangles)
    {
      const Jacobian j = jacobian(t, x);
      const double d = determinantOf(j);
      if (!(d > 0))
      {
        return std::numeric_limits<double>::infinity();
      }
      sum += t.weight * j.squaredNorm() * (1 + 1 / (d * d));
    }
    return sum;
  };
  Vector2 x(0, 0);
  for (int step = 0; step < steps; ++step)
  {
    work_ += triangles.size();
    Vector2 gradient(0, 0);
    Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
    const double before = energy(x);
    if (!std::isfinite(before))
    {
      return;
    }
    for (const Triangle& t : triangles)
    {
      const Jacobian j = jacobian(t, x);
      const double d = determinantOf(j), f = j.squaredNorm();
      Jacobian g;
      Eigen::Matrix4d h;
      deriveByJacobian(j,
        { 1 + 1 / (d * d), -2 * f / (d * d * d), -2 / (d * d * d), 6 * f / (d * d * d * d), 0 }, g,
        h);
      // Columns of J move by -(row sums of the inverse) times x.
      const double a = -(t.inverse(0, 0) + t.inverse(1, 0)),
                   b = -(t.inverse(0, 1) + t.inverse(1, 1));
      Eigen::Matrix<double, 4, 2> by;
      by << a, 0, 0, a, b, 0, 0, b;
      gradient += t.weight * by.transpose() * g;
      hessian += t.weight * by.transpose() * h * by;
    }
    Vector2 direction = Vector2::Zero();
    if (vertex.freedom == PatchFreedom::Plane)
    {
      direction = -hessian.inverse() * gradient;
    }
    else
    {
      const int axis = vertex.freedom == PatchFreedom::AlongU ? 0 : 1;
      direction[axis] = -gradient[axis] / hessian(axis, axis);
    }
    if (!direction.allFinite())
    {
      return;
    }
    bool moved = false;
    for (double length = 1; length > 1e-3 && !moved; length *= 0.5)
    {
      const Vector2 trial = x + length * direction;
      if (energy(trial) < before)
      {
        const FixedVec2 old = vertex.place;
        vertex.place = base + toFixed(trial);
        moved =
          std::all_of(corners.begin(), corners.end(), [&](Index c) { return isPositive(face(c)); });
        if (moved)
        {
          x = toDouble(vertex.place - base);
        }
        else
        {
          vertex.place = old;
        }
      }
    }
    if (!moved)
    {
      return;
    }
  }
}

/// The vertex of a collapse comes back; not where rounding leaves its star no kernel.
bool PatchLevels::putBack(const Collapse& record)
{
  undo(record);
  if (!place(record.vertex))
  {
    return false;
  }
  relax(record.vertex, kStepsOfVertex);
  for (const Index w : neighbours(record.vertex))
  {
    relax(w, kStepsOfRing);
  }
  return true;
}

/// The level of the vertices that go last, and the coarser ones; then finer ones.
std::vector<std::size_t> PatchLevels::levels() const
{
  std::vector<std::size_t> sizes(kInnerVertices.begin(), kInnerVertices.end());
  if (placed_)
  {
    sizes.push_back(*placed_);
    std::sort(sizes.begin(), sizes.end());
  }
  return sizes;
}

PatchLevelsResult PatchLevels::run(const PatchSolver& solver)
{
  PatchLevelsResult result;
  const std::size_t before = inner_;
  coarsen();
  bool isOther = false;
  for (const std::size_t most : levels())
  {
    while (!collapses_.empty() && inner_ < most)
    {
      undo(collapses_.back());
      collapses_.pop_back();
    }
    if (inner_ == before)
    {
      break; // tried as a whole before
    }
    countTry(Try::LevelOfPatch, isOther ? 1 : 0);
    if (!solve(solver))
    {
      isOther = true;
      continue;
    }
    result.valid = true;
    while (!collapses_.empty() && result.valid)
    {
      const Collapse record = std::move(collapses_.back());
      collapses_.pop_back();
      result.valid = putBack(record);
    }
    countTryLed(Try::LevelOfPatch, isOther && result.valid ? 1 : 0);
    break;
  }
  result.work = work_;
  return result;
}

void PatchLevels::write(std::vector<FixedVec2>& uv) const
{
  for (Index f = 0; f < patchFaces_; ++f)
  {
    for (Index k = 0; k < 3; ++k)
    {
      uv[3 * fineFace_[f] + k] = image(3 * f + k);
    }
  }
}

} // namespace

Eigen::Matrix2d inverseOfTriangle(const Vector3& ab, const Vector3& ac)
{
  const double longest = std::max({ ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm() });
  const double doubled = ab.cross(ac).norm();
  Eigen::Matrix2d reference;
  if (doubled > kFlattestTriangle * longest)
  {
    const double length = ab.norm();
    reference << length, ab.dot(ac) / length, 0, doubled / length;
  }
  else
  {
    // A tenth of the longest edge keeps the weight of a sliver small without letting it vanish.
    const double side = 0.1 * std::sqrt(std::max(longest, 1e-12));
    reference << side, 0.5 * side, 0, 0.8660254037844386 * side;
  }
  return reference.inverse();
}

PatchLevelsResult solveByLevels(const Mesh& mesh, const std::vector<Index>& patch,
  const std::vector<PatchStar>& stars, const std::vector<int>& turns, double scale,
  const PatchSolver& solver, std::vector<FixedVec2>& uv)
{
  PatchLevels levels(mesh, patch, stars, turns, scale, uv);
  const PatchLevelsResult result = levels.run(solver);
  if (result.valid)
  {
    levels.write(uv);
  }
  return result;
}

} // namespace quadrille
