// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Assembly/JoinParts.h"

#include "Base/DisjointSets.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <unordered_map>
#include <unordered_set>

namespace quadrille
{

namespace
{

using PartBox = Eigen::AlignedBox3d;

/// Polygons of a surface are its corners from one offset to the next.
std::size_t polygonCount(const SurfaceInput& input)
{
  return input.polygonOffsets.empty() ? 0 : input.polygonOffsets.size() - 1;
}

/// An edge of a polygon both of whose ends lie where another part has points, too.
struct PartEdge
{
  Index low = 0, high = 0; ///< places of its ends
  Index from = 0, to = 0;  ///< points at these
  Index part = 0;
};

/// Places at which several parts have a point. Points at exactly the same place go first: where a part has points
/// nearer to each other than the tolerance, such as the corners of a sliver, only these tell which is which. Others go
/// to the nearest place.
class CommonPlaces
{
public:
  CommonPlaces(const std::vector<const SurfaceInput*>& parts, const std::vector<Index>& firstPoint)
    : parts_(parts), firstPoint_(firstPoint), placeOf_(firstPoint.back())
  {
    measure();
    for (std::size_t p = 0; p < parts_.size(); ++p)
    {
      forEachNear(p, [&](Index point, const Vector3& at) { addExactly(point, at, p); });
    }
    for (const Index place : places_)
    {
      if (isCommon_[place] != 0)
      {
        cells_[cellKey(cellOf(position(place)), 0)].push_back(place);
      }
    }
    for (std::size_t p = 0; p < parts_.size(); ++p)
    {
      forEachNear(p, [&](Index point, const Vector3& at) { addNearly(point, at, p); });
    }
  }

  /// Per point one of those at its place.
  Index place(Index point) const { return placeOf_[point]; }
  /// Whether several parts have a point at the place of this one.
  bool isCommon(Index point) const { return isCommon_[placeOf_[point]] != 0; }

private:
  void measure()
  {
    PartBox whole;
    for (const SurfaceInput* part : parts_)
    {
      PartBox box;
      for (const Vector3& p : part->points)
      {
        if (p.allFinite())
        {
          box.extend(p);
        }
      }
      boxes_.push_back(box);
      whole.extend(box);
    }
    if (whole.isEmpty())
    {
      whole.extend(Vector3(Vector3::Zero()));
    }
    tolerance_ = kRoundingOfSingle * whole.diagonal().norm();
    lowest_ = whole.min();
    isCommon_.assign(placeOf_.size(), 0);
    for (Index i = 0; i < placeOf_.size(); ++i)
    {
      placeOf_[i] = i;
    }
  }

  /// Points in the box of another part.
  template <class Visit>
  void forEachNear(std::size_t part, const Visit& visit) const
  {
    std::vector<PartBox> others;
    for (std::size_t other = 0; other < parts_.size(); ++other)
    {
      PartBox box = boxes_[other];
      if (other != part && !box.isEmpty())
      {
        box.min().array() -= tolerance_;
        box.max().array() += tolerance_;
        if (!box.intersection(boxes_[part]).isEmpty())
        {
          others.push_back(box);
        }
      }
    }
    const std::vector<Vector3>& points = parts_[part]->points;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      pollNowAndThen(i);
      if (points[i].allFinite() &&
        std::any_of(others.begin(), others.end(),
          [&](const PartBox& box) { return box.contains(points[i]); }))
      {
        visit(firstPoint_[part] + static_cast<Index>(i), points[i]);
      }
    }
  }

  /// A place takes one point of each part: those of one part are different however near they are.
  bool take(Index place, std::size_t part)
  {
    return taken_.insert(std::uint64_t{ place } << 32 | part).second;
  }

  void addExactly(Index point, const Vector3& p, std::size_t part)
  {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double x = p[axis] + 0.0; // 0 and -0 are the same
      std::uint64_t bits = 0;
      std::memcpy(&bits, &x, sizeof(bits));
      hash = (hash ^ bits) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 32;
    }
    std::vector<Index>& bucket = exact_[hash];
    for (const Index place : bucket)
    {
      if (position(place) == p && take(place, part))
      {
        placeOf_[point] = place;
        isCommon_[place] = 1;
        return;
      }
    }
    bucket.push_back(point);
    places_.push_back(point);
    take(point, part);
  }

  /// Of points that are alone so far.
  void addNearly(Index point, const Vector3& p, std::size_t part)
  {
    if (placeOf_[point] != point || isCommon_[point] != 0)
    {
      return;
    }
    const Eigen::Array3d cell = cellOf(p);
    Index nearest = kInvalidIndex;
    double least = tolerance_;
    for (int corner = 0; corner < 8; ++corner)
    {
      const auto bucket = cells_.find(cellKey(cell - 0.5, corner));
      if (bucket == cells_.end())
      {
        continue;
      }
      for (const Index place : bucket->second)
      {
        const double distance = (position(place) - p).norm();
        const bool isNearer = nearest == kInvalidIndex ? distance <= least : distance < least;
        if (isNearer && taken_.count(std::uint64_t{ place } << 32 | part) == 0)
        {
          nearest = place;
          least = distance;
        }
      }
    }
    if (nearest == kInvalidIndex)
    {
      cells_[cellKey(cell, 0)].push_back(point);
      return;
    }
    take(nearest, part);
    placeOf_[point] = nearest;
    isCommon_[nearest] = 1;
  }

  Eigen::Array3d cellOf(const Vector3& p) const { return (p - lowest_).array() / cellSize(); }
  double cellSize() const { return tolerance_ > 0 ? 2 * tolerance_ : 1; }

  /// Of the cell, or one of its neighbours in front.
  static std::uint64_t cellKey(const Eigen::Array3d& cell, int corner)
  {
    constexpr int bits = 21; // 1 / (2 kRoundingOfSingle) cells along the diagonal, and some
    std::uint64_t result = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto at = static_cast<std::int64_t>(std::floor(cell[axis])) + (corner >> axis & 1) + 1;
      result = result << bits | (static_cast<std::uint64_t>(at) & ((1U << bits) - 1));
    }
    return result;
  }

  const Vector3& position(Index point) const
  {
    const auto next = std::upper_bound(firstPoint_.begin(), firstPoint_.end(), point);
    const auto part = static_cast<std::size_t>(next - firstPoint_.begin()) - 1;
    return parts_[part]->points[point - firstPoint_[part]];
  }

  const std::vector<const SurfaceInput*>& parts_;
  const std::vector<Index>& firstPoint_;
  std::vector<PartBox> boxes_;
  double tolerance_ = 0;
  Vector3 lowest_;
  std::vector<Index> placeOf_;
  std::vector<Index> places_; ///< of points at exactly the same place, the first
  std::vector<std::uint8_t> isCommon_;
  // Looked up, never walked through.
  std::unordered_set<std::uint64_t> taken_; ///< place and part
  std::unordered_map<std::uint64_t, std::vector<Index>> exact_, cells_;
};

/// All edges between common places, those of the same one after the other.
std::vector<PartEdge> usesOf(const std::vector<const SurfaceInput*>& parts,
  const std::vector<Index>& firstPoint, const CommonPlaces& places)
{
  std::vector<PartEdge> uses;
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    const SurfaceInput& part = *parts[p];
    for (std::size_t polygon = 0; polygon < polygonCount(part); ++polygon)
    {
      pollNowAndThen(polygon);
      const Index begin = part.polygonOffsets[polygon];
      const Index end = part.polygonOffsets[polygon + 1];
      for (Index i = begin; i < end; ++i)
      {
        PartEdge use;
        use.part = static_cast<Index>(p);
        use.from = firstPoint[p] + part.polygonPoints[i];
        use.to = firstPoint[p] + part.polygonPoints[i + 1 < end ? i + 1 : begin];
        use.low = places.place(use.from);
        use.high = places.place(use.to);
        if (use.low != use.high && places.isCommon(use.from) && places.isCommon(use.to))
        {
          if (use.low > use.high)
          {
            std::swap(use.low, use.high);
            std::swap(use.from, use.to);
          }
          uses.push_back(use);
        }
      }
    }
  }
  std::stable_sort(uses.begin(), uses.end(),
    [](const PartEdge& a, const PartEdge& b)
    { return std::make_pair(a.low, a.high) < std::make_pair(b.low, b.high); });
  return uses;
}

/// Values of an optional array, or what stands for them.
template <class Value>
void appendOr(std::vector<Value>& all, const std::vector<Value>& part, std::size_t count,
  const Value& missing, bool isNeeded)
{
  if (isNeeded && part.empty())
  {
    all.resize(all.size() + count, missing);
  }
  else if (isNeeded)
  {
    all.insert(all.end(), part.begin(), part.end());
  }
}

template <class Member>
bool anyHas(const std::vector<SurfaceInput>& parts, Member member)
{
  return std::any_of(
    parts.begin(), parts.end(), [&](const SurfaceInput& part) { return !(part.*member).empty(); });
}

} // namespace

PartContacts findContacts(const std::vector<const SurfaceInput*>& parts)
{
  PartContacts contacts;
  std::size_t points = 0;
  for (const SurfaceInput* part : parts)
  {
    contacts.firstPoint.push_back(static_cast<Index>(points));
    points += part->points.size();
    refuseIf(points >= kInvalidIndex,
      "the parts have more than 4294967294 points in all: reduce them first, or "
      "remesh them apart");
  }
  contacts.firstPoint.push_back(static_cast<Index>(points));
  const CommonPlaces places(parts, contacts.firstPoint);
  const std::vector<PartEdge> uses = usesOf(parts, contacts.firstPoint, places);

  DisjointSets same(points, 1), together(parts.size(), 1);
  const auto positionOf = [&](const PartEdge& use, Index point) -> const Vector3&
  { return parts[use.part]->points[point - contacts.firstPoint[use.part]]; };
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end)
  {
    const PartEdge& first = uses[begin];
    while (end < uses.size() && uses[end].low == first.low && uses[end].high == first.high)
    {
      ++end;
    }
    std::vector<Index> owners; // ascending, as uses are part after part
    for (std::size_t i = begin; i < end; ++i)
    {
      if (owners.empty() || owners.back() != uses[i].part)
      {
        owners.push_back(uses[i].part);
      }
    }
    if (owners.size() < 2)
    {
      continue;
    }
    ++contacts.edges;
    for (std::size_t i = begin + 1; i < end; ++i)
    {
      same.join(first.from, uses[i].from);
      same.join(first.to, uses[i].to);
      together.join(first.part, uses[i].part);
    }
    if (end - begin > 2)
    {
      if (contacts.manyFaced++ == 0)
      {
        owners.resize(std::min<std::size_t>(owners.size(), 3));
        contacts.manyFacedParts = owners;
        contacts.manyFacedPlace =
          0.5 * (positionOf(first, first.from) + positionOf(first, first.to));
      }
    }
  }
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    contacts.group.push_back(together.find(static_cast<Index>(p)));
  }
  contacts.pointOf.resize(points);
  std::vector<std::uint8_t> isJoined(
    points, 0); // per place: one of its points is the end of a common edge
  for (Index i = 0; i < points; ++i)
  {
    contacts.pointOf[i] = same.find(i);
    if (contacts.pointOf[i] != i)
    {
      isJoined[places.place(i)] = 1;
    }
  }
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    for (Index i = contacts.firstPoint[p]; i < contacts.firstPoint[p + 1]; ++i)
    {
      const Index place = places.place(i);
      if (place != i && isJoined[place] == 0 && contacts.loosePoints++ == 0)
      {
        const auto next =
          std::upper_bound(contacts.firstPoint.begin(), contacts.firstPoint.end(), place);
        contacts.looseParts = { static_cast<Index>(next - contacts.firstPoint.begin() - 1),
          static_cast<Index>(p) };
        contacts.loosePlace = parts[p]->points[i - contacts.firstPoint[p]];
      }
    }
  }
  return contacts;
}

Index JoinedParts::Part::ownPoint(Index joint) const
{
  const auto found = std::lower_bound(points.begin(), points.end(), joint,
    [](const std::pair<Index, Index>& entry, Index point) { return entry.first < point; });
  return found != points.end() && found->first == joint ? found->second : kInvalidIndex;
}

Index JoinedParts::partOf(Index polygon) const
{
  const auto next = std::upper_bound(firstPolygon.begin(), firstPolygon.end(), polygon);
  return static_cast<Index>(next - firstPolygon.begin()) - 1;
}

JoinedParts joinParts(std::vector<SurfaceInput> parts, const PartContacts& contacts)
{
  refuseIf(parts.size() < 2 || contacts.group.size() != parts.size(),
    "at least two parts are needed to join them, with the contacts between them");
  JoinedParts joined;
  SurfaceInput& all = joined.input;
  all.isDesigned = std::all_of(
    parts.begin(), parts.end(), [](const SurfaceInput& part) { return part.isDesigned; });
  const bool features = anyHas(parts, &SurfaceInput::featureEdges);
  const bool guides = anyHas(parts, &SurfaceInput::guideDirections);
  const bool weights = anyHas(parts, &SurfaceInput::guideWeights);
  const bool valences = anyHas(parts, &SurfaceInput::targetValences);
  const bool sizes = anyHas(parts, &SurfaceInput::sizing);
  const bool curvatures = anyHas(parts, &SurfaceInput::curvatures);
  std::map<std::pair<std::size_t, std::int64_t>, std::int64_t>
    patches;                                           // new ids, in the order of their first use
  std::vector<Index> jointOf(contacts.pointOf.size()); // per point: its number in the joint surface
  all.polygonOffsets.push_back(0);
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    SurfaceInput& part = parts[p];
    JoinedParts::Part& kept = joined.parts.emplace_back();
    const std::size_t polygons = polygonCount(part);
    joined.firstPolygon.push_back(static_cast<Index>(all.polygonOffsets.size() - 1));
    joined.firstCurve.push_back(all.curves.size());
    for (std::size_t i = 0; i < part.points.size(); ++i)
    {
      pollNowAndThen(i);
      const std::size_t point = contacts.firstPoint[p] + i;
      const Index first = contacts.pointOf[point];
      const bool isNew = first == point;
      jointOf[point] = isNew ? static_cast<Index>(all.points.size()) : jointOf[first];
      kept.points.emplace_back(jointOf[point], static_cast<Index>(i));
      const int valence = part.targetValences.empty() ? 0 : part.targetValences[i];
      const float size = part.sizing.empty() ? 1.0F : part.sizing[i];
      if (isNew)
      {
        all.points.push_back(part.points[i]);
        all.targetValences.resize(valences ? all.points.size() : 0, valence);
        all.sizing.resize(sizes ? all.points.size() : 0, size);
        continue;
      }
      if (valences && all.targetValences[jointOf[point]] == 0)
      {
        all.targetValences[jointOf[point]] = valence;
      }
      if (sizes)
      {
        all.sizing[jointOf[point]] = std::min(all.sizing[jointOf[point]], size);
      }
    }
    std::sort(kept.points.begin(), kept.points.end());
    const Index firstCorner = static_cast<Index>(all.polygonPoints.size());
    for (std::size_t i = 0; i < polygons; ++i)
    {
      all.polygonOffsets.push_back(firstCorner + part.polygonOffsets[i + 1]);
      const std::int64_t patch = part.patchIds.empty() ? 0 : part.patchIds[i];
      const auto next = static_cast<std::int64_t>(patches.size());
      all.patchIds.push_back(patches.emplace(std::make_pair(p, patch), next).first->second);
    }
    for (const Index corner : part.polygonPoints)
    {
      all.polygonPoints.push_back(jointOf[contacts.firstPoint[p] + corner]);
    }
    appendOr(all.featureEdges, part.featureEdges, polygons, std::uint8_t{ 0 }, features);
    appendOr(all.guideDirections, part.guideDirections, polygons, Vector3(Vector3::Zero()), guides);
    appendOr(all.guideWeights, part.guideWeights, polygons, 1.0, weights);
    appendOr(all.curvatures, part.curvatures, polygons, kNoCurvature, curvatures);
    all.curves.insert(all.curves.end(), part.curves.begin(), part.curves.end());
    all.drawn.append(part.drawn);
    kept.polygonOffsets = std::move(part.polygonOffsets);
    kept.polygonPoints = std::move(part.polygonPoints);
    part = {};
  }
  joined.firstPolygon.push_back(static_cast<Index>(all.polygonOffsets.size() - 1));
  joined.firstCurve.push_back(all.curves.size());
  return joined;
}

} // namespace quadrille
