// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/IntegerMap.h"

#include "Base/Angles.h"
#include "Base/Lists.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{

namespace
{

double orientedAngle(const Vector2& a, const Vector2& b)
{
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

/// The number nearest to x that is residue modulo kGrain.
std::int64_t nearest(double x, std::int64_t residue)
{
  return kGrain * std::llround((x - double(residue)) / double(kGrain)) + residue;
}

/// The same, but with the sign of x and never zero.
std::int64_t nearestWithSign(double x, std::int64_t residue)
{
  std::int64_t n = nearest(x, residue);
  while (x < 0 ? n >= 0 : n <= 0)
  {
    n += x < 0 ? -kGrain : kGrain;
  }
  return n;
}

} // namespace

IntegerMap::IntegerMap(UvMesh& mesh, UvEditor& editor,
  const std::vector<std::uint8_t>& integerVertex, std::vector<CurveShare> shares)
  : mesh_(mesh), editor_(editor), integerVertex_(integerVertex), q_(mesh.origin.size()),
    axis_(mesh.origin.size(), kFree), shares_(std::move(shares)),
    wanted_(mesh.origin.size(), Vector2::Zero()), target_(wanted_), weight_(mesh.origin.size(), 0)
{
  shares_.resize(mesh.origin.size());
  for (Index f = 0; f < mesh_.alive.size(); ++f)
  {
    if (mesh_.alive[f])
    {
      faces_.push_back(f);
    }
  }
  for (const Index f : faces_)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      measure(h);
    }
  }
  for (const Index f : faces_)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      weigh(h);
    }
  }
  for (Index v = 0; v < mesh_.outgoing.size(); ++v)
  {
    if (mesh_.outgoing[v] != kInvalidIndex && !integerVertex_[v])
    {
      freeVertices_.push_back(v);
    }
  }
  turns_ = windings([&](Index h) { return seamless(h); });
  findLoops();
}

void IntegerMap::findLoops()
{
  loop_.assign(q_.size(), kInvalidIndex);
  for (const Index f : faces_)
  {
    for (Index first = 3 * f; first < 3 * f + 3; ++first)
    {
      if (mesh_.twin[first] != kInvalidIndex || loop_[first] != kInvalidIndex)
      {
        continue;
      }
      const Index id = static_cast<Index>(loopLength_.size());
      loopLength_.push_back(0);
      for (Index h = first; loop_[h] == kInvalidIndex;)
      {
        loop_[h] = id;
        h = Mesh::next(h);
        while (mesh_.twin[h] != kInvalidIndex)
        {
          h = Mesh::next(mesh_.twin[h]);
        }
      }
    }
  }
}

void IntegerMap::measureLoops()
{
  std::fill(loopLength_.begin(), loopLength_.end(), 0);
  for (Index h = 0; h < loop_.size(); ++h)
  {
    if (loop_[h] != kInvalidIndex)
    {
      loopLength_[loop_[h]] += lengthOf(q_[h]);
    }
  }
  shortage_ = 0;
  for (Index loop = 0; loop < loopLength_.size(); ++loop)
  {
    shortage_ += shortageOf(loop);
  }
}

std::vector<Index> IntegerMap::shortLoops() const
{
  return idsWhere(shortage_ > 0 ? loop_.size() : 0,
    [&](Index h) { return loop_[h] != kInvalidIndex && shortageOf(loop_[h]) > 0; });
}

FixedVec2 IntegerMap::along(Index h) const
{
  return axis_[h] == kOnlyU ? FixedVec2{ wanted_[h].x() > 0 ? kGrain : -kGrain, 0 }
                            : FixedVec2{ 0, wanted_[h].y() > 0 ? kGrain : -kGrain };
}

void IntegerMap::measure(Index h)
{
  const FixedVec2 d = mesh_.vector(h);
  wanted_[h] = shares_[h].all() * toDouble(d);
  target_[h] = (shares_[h].bent + pull_ * shares_[h].rest) * toDouble(d);
  const bool constrained = mesh_.twin[h] == kInvalidIndex || (mesh_.flags[h] & kUvConstrained) != 0;
  axis_[h] = !constrained ? kFree : d.v == 0 ? kOnlyU : kOnlyV;
}

void IntegerMap::setPull(double pull)
{
  pull_ = pull;
  for (const Index f : faces_)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      measure(h);
    }
  }
}

/// Cotangent of the angle opposite to h in the seamless map.
double IntegerMap::cotangentOpposite(Index h) const
{
  const Vector2 a = seamless(Mesh::previous(h)), b = -seamless(Mesh::next(h));
  return a.dot(b) / (a.x() * b.y() - a.y() * b.x());
}

/// Weights near the Dirichlet energy of the difference of the two maps, that is the squared relative error
/// of every quad's size; divided by the length so that short edges do not grow for nothing.
void IntegerMap::weigh(Index h)
{
  const Index g = mesh_.twin[h];
  const double here = cotangentOpposite(h);
  double sum = here + (g == kInvalidIndex ? here : cotangentOpposite(g));
  // A triangle that was flipped for the sake of the integers may be degenerate in the seamless map.
  sum = std::isfinite(sum) ? sum : 0;
  weight_[h] = std::clamp(sum, 0.1, 4.0) / std::max(seamless(h).norm(), 0.25);
  if (g != kInvalidIndex)
  {
    weight_[g] = weight_[h];
  }
}

/// Calls visit(h, e, leaves) for every half-edge that leaves v, with e rotated to its chart, and for the boundary
/// half-edge that ends in v.
template <typename Visit>
void IntegerMap::visitStar(Index v, FixedVec2 e, Visit visit) const
{
  Index h = mesh_.outgoing[v];
  do
  {
    visit(h, e, true);
    const Index incoming = Mesh::previous(h);
    if (mesh_.twin[incoming] == kInvalidIndex)
    {
      visit(incoming, e, false);
    }
    e = rotate(e, mesh_.rotation[incoming]);
    h = mesh_.twin[incoming];
  } while (h != kInvalidIndex && h != mesh_.outgoing[v]);
}

/// Where a free vertex lies between whole points in the seamless map, seen from an integer neighbour.
FixedVec2 IntegerMap::residueOf(Index v) const
{
  Vector2 offset = toDouble(mesh_.uv[mesh_.outgoing[v]]);
  bool found = false;
  bool u = true, w = true;
  visitStar(v, { 1, 0 },
    [&](Index h, FixedVec2 e, bool leaves)
    {
      const int back = e.v == 0 ? (e.u > 0 ? 0 : 2) : (e.v > 0 ? 3 : 1);
      if (leaves && !found && integerVertex_[mesh_.target(h)])
      {
        offset = toDouble(rotate(-mesh_.vector(h), back));
        found = true;
      }
      if (axis_[h] != kFree)
      {
        const bool alongU = (axis_[h] == kOnlyU) == (back % 2 == 0);
        (alongU ? w : u) = false;
      }
    });
  const auto part = [](double x) { return std::llround((x - std::floor(x)) * double(kGrain)); };
  return { u ? part(offset.x()) : 0, w ? part(offset.y()) : 0 };
}

/// #H: residue of the corner modulo kGrain in the chart of its face.
std::vector<FixedVec2> IntegerMap::residues() const
{
  std::vector<FixedVec2> result(q_.size());
  for (const Index v : freeVertices_)
  {
    visitStar(v, residueOf(v),
      [&](Index h, FixedVec2 e, bool leaves)
      {
        if (leaves)
        {
          result[h] = e;
        }
      });
  }
  return result;
}

FixedVec2 IntegerMap::nearestAllowed(Index h, double scale, FixedVec2 residue) const
{
  const Vector2 p = scale * double(kGrain) * wanted_[h];
  if (axis_[h] == kOnlyU)
  {
    return { nearestWithSign(p.x(), residue.u), 0 };
  }
  if (axis_[h] == kOnlyV)
  {
    return { 0, nearestWithSign(p.y(), residue.v) };
  }
  const FixedVec2 n{ nearest(p.x(), residue.u), nearest(p.y(), residue.v) };
  if (n != FixedVec2{})
  {
    return n;
  }
  return std::abs(p.x()) >= std::abs(p.y()) ? FixedVec2{ nearestWithSign(p.x(), residue.u), 0 }
                                            : FixedVec2{ 0, nearestWithSign(p.y(), residue.v) };
}

void IntegerMap::round(double scale)
{
  const std::vector<FixedVec2> residue = residues();
  for (const Index f : faces_)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const Index g = mesh_.twin[h];
      if (g == kInvalidIndex || h < g)
      {
        q_[h] = nearestAllowed(h, scale, residue[Mesh::next(h)] - residue[h]);
      }
      if (g != kInvalidIndex && h < g)
      {
        q_[g] = -rotate(q_[h], mesh_.rotation[h]);
      }
    }
  }
  measureLoops();
}

bool IntegerMap::adopt(const std::vector<FixedVec2>& uv)
{
  constexpr std::int64_t kSixteenth = kOne / kGrain;
  const auto nearestSixteenth = [](std::int64_t x)
  { return (x + kSixteenth / 2) & ~(kSixteenth - 1); };
  // A vertex is rounded in one of its charts and goes the same way in the others: charts that are turned against each
  // other would round the middle between two sixteenths to different sides, and no triangle there would close.
  std::vector<FixedVec2> at = uv;
  for (const Index v : freeVertices_)
  {
    const FixedVec2 p = uv[mesh_.outgoing[v]];
    visitStar(v, FixedVec2{ nearestSixteenth(p.u), nearestSixteenth(p.v) } - p,
      [&](Index h, FixedVec2 e, bool leaves)
      {
        if (leaves)
        {
          at[h] = at[h] + e;
        }
      });
  }
  for (const Index f : faces_)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const Index g = mesh_.twin[h];
      if (g != kInvalidIndex && g < h)
      {
        continue;
      }
      const FixedVec2 d = at[Mesh::next(h)] - at[h];
      q_[h] = { d.u / kSixteenth, d.v / kSixteenth };
      if (!mayShift(h, {}) || (axis_[h] == kOnlyU && q_[h].v != 0) ||
        (axis_[h] == kOnlyV && q_[h].u != 0))
      {
        return false;
      }
      if (g != kInvalidIndex)
      {
        q_[g] = -rotate(q_[h], mesh_.rotation[h]);
      }
    }
  }
  measureLoops();
  return true;
}

void IntegerMap::shift(Index h, FixedVec2 e)
{
  const std::int64_t before = lengthOf(q_[h]);
  q_[h] = q_[h] + e;
  const Index g = mesh_.twin[h];
  if (g != kInvalidIndex)
  {
    q_[g] = q_[g] - rotate(e, mesh_.rotation[h]);
    return;
  }
  shortage_ -= shortageOf(loop_[h]);
  loopLength_[loop_[h]] += lengthOf(q_[h]) - before;
  shortage_ += shortageOf(loop_[h]);
}

void IntegerMap::moveVertex(Index v, FixedVec2 e)
{
  visitStar(
    v, e, [&](Index h, FixedVec2 rotated, bool leaves) { shift(h, leaves ? -rotated : rotated); });
}

bool IntegerMap::mayMove(Index v, FixedVec2 e) const
{
  bool may = true;
  visitStar(v, e,
    [&](Index h, FixedVec2 rotated, bool leaves)
    { may = may && mayShift(h, leaves ? -rotated : rotated); });
  return may;
}

double IntegerMap::moveEnergy(Index v, FixedVec2 e) const
{
  double change = 0;
  visitStar(v, e,
    [&](Index h, FixedVec2 rotated, bool leaves)
    { change += energyChange(h, leaves ? -rotated : rotated); });
  return change;
}

/// Whether the sector (or the whole ring) that h lies in, at its origin, keeps enough corners without h: every corner
/// turns by less than two quarters, so t quarters need more than t / 2 corners.
bool IntegerMap::hasCornerToSpare(Index h) const
{
  const auto axisAngle = [&](Index x)
  { return wanted_[x].y() == 0 ? (wanted_[x].x() > 0 ? 0 : 2) : (wanted_[x].y() > 0 ? 1 : 3); };
  int corners = 0;
  Index last = h;
  int rotated = 0; // charts, from that of h on
  // Counterclockwise to the end of the sector.
  while (true)
  {
    ++corners;
    const Index incoming = Mesh::previous(last);
    const Index next = mesh_.twin[incoming];
    if (axis_[incoming] != kFree)
    {
      last = incoming;
      break;
    }
    rotated += mesh_.rotation[incoming];
    last = next;
    if (last == h)
    {
      return 2 * (corners - 1) > turns_[mesh_.origin[h]];
    }
  }
  // The end as an outgoing direction in the chart of h: the incoming half-edge reversed and rotated back.
  const int end = axisAngle(last) + 2 - rotated;
  // Clockwise to its begin.
  Index first = h;
  rotated = 0;
  while (axis_[first] == kFree)
  {
    ++corners;
    rotated -= mesh_.rotation[mesh_.twin[first]];
    first = Mesh::next(mesh_.twin[first]);
  }
  const int begin = axisAngle(first) - rotated;
  const int quarters = (end - begin) & 3;
  return 2 * (corners - 1) > (quarters == 0 ? 4 : quarters);
}

bool IntegerMap::mayFlip(Index h) const
{
  return !mesh_.isFixed(h) && Mesh::face(h) != Mesh::face(mesh_.twin[h]) && hasCornerToSpare(h) &&
    hasCornerToSpare(mesh_.twin[h]);
}

std::array<std::int64_t, 2> IntegerMap::flippedDeterminants(Index h) const
{
  const Index g = mesh_.twin[h];
  const FixedVec2 toD = rotate(q_[Mesh::next(g)], mesh_.rotation[g]);
  const FixedVec2 toC = rotate(q_[Mesh::next(h)], mesh_.rotation[h]);
  // (a, d, c) and (b, c, d); see Hierarchy/DecimationLog.h.
  return { cross(toD, -q_[Mesh::previous(h)]), cross(toC, -q_[Mesh::previous(g)]) };
}

void IntegerMap::flip(Index h)
{
  const Index g = mesh_.twin[h];
  const Index hn = Mesh::next(h), hp = Mesh::previous(h), gn = Mesh::next(g),
              gp = Mesh::previous(g);
  const FixedVec2 toD = rotate(q_[gn], mesh_.rotation[g]);
  const FixedVec2 toC = rotate(q_[hn], mesh_.rotation[h]);
  editor_.flip(h);
  loop_[h] = std::exchange(loop_[gn], kInvalidIndex);
  loop_[g] = std::exchange(loop_[hn], kInvalidIndex);
  shares_[h] = std::exchange(shares_[gn], {});
  shares_[g] = std::exchange(shares_[hn], {});
  q_[h] = toD;
  q_[g] = toC;
  q_[hn] = -(toD + q_[hp]);
  q_[gn] = -(toC + q_[gp]);
  for (const Index slot : { h, hn, hp, g, gn, gp })
  {
    measure(slot);
  }
  for (const Index slot : { h, hn, hp, g, gp })
  {
    weigh(slot);
  }
}

bool IntegerMap::wantsFlip(Index h) const
{
  if (!mayFlip(h))
  {
    return false;
  }
  const auto cotangent = [&](Index x)
  {
    const Vector2 a = inQuads(q_[Mesh::previous(x)]), b = -inQuads(q_[Mesh::next(x)]);
    return a.dot(b) / (a.x() * b.y() - a.y() * b.x());
  };
  if (!(cotangent(h) + cotangent(mesh_.twin[h]) < -kRounding))
  {
    return false;
  }
  const auto after = flippedDeterminants(h);
  return brokenness(after[0]) == 0 && brokenness(after[1]) == 0;
}

void IntegerMap::makeDelaunay()
{
  std::vector<Index> stack;
  for (const Index f : faces_)
  {
    stack.insert(stack.end(), { 3 * f, 3 * f + 1, 3 * f + 2 });
  }
  const std::size_t budget = 64 * stack.size();
  flipWhere(
    mesh_, std::move(stack), budget, [&](Index h) { return wantsFlip(h); },
    [&](Index h) { flip(h); });
}

double IntegerMap::energy() const
{
  double sum = 0;
  for (const Index f : faces_)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const double share = mesh_.twin[h] == kInvalidIndex ? 1.0 : 0.5;
      sum += share * weight_[h] * (inQuads(q_[h]) - target_[h]).squaredNorm();
    }
  }
  return sum;
}

double IntegerMap::area() const
{
  double sum = 0;
  for (const Index f : faces_)
  {
    sum += 0.5 * static_cast<double>(determinant(f)) / double(kGrain * kGrain);
  }
  return sum;
}

/// Quarter turns round every vertex; every determinant must be positive for this to mean anything.
template <typename VectorOf>
std::vector<int> IntegerMap::windings(VectorOf vectorOf) const
{
  std::vector<double> angle(mesh_.outgoing.size(), 0);
  for (const Index f : faces_)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      angle[mesh_.origin[h]] += orientedAngle(vectorOf(h), -vectorOf(Mesh::previous(h)));
    }
  }
  std::vector<int> turns(angle.size());
  std::transform(angle.begin(), angle.end(), turns.begin(),
    [](double a) { return static_cast<int>(std::lround(a / (kPi / 2))); });
  return turns;
}

bool IntegerMap::isValid() const
{
  const bool sound = std::all_of(faces_.begin(), faces_.end(),
    [&](Index f) { return residual(f) == FixedVec2{} && isSound(f); });
  return sound && wrongWindings().empty();
}

std::vector<Index> IntegerMap::wrongWindings() const
{
  const std::vector<int> turns = windings([&](Index h) { return inQuads(q_[h]); });
  return idsWhere(turns.size(), [&](Index v) { return turns[v] != turns_[v]; });
}

} // namespace quadrille
