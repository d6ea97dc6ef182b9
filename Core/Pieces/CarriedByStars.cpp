// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/CarriedPlaces.h"

#include "Base/Refuse.h"
#include "Pieces/PlaneStar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace quadrille
{
namespace
{

/// Where a place is now.
struct PlaceState
{
  std::array<double, 3> weights{};
  Index face = kInvalidIndex;
  Index next = kInvalidIndex; ///< on the same face
};

/// What all blocks work on: those of a round share no face.
struct PlacesByFace
{
  /// #H of the finest mesh, as the log has the faces so far; of those that are still to come back it does not matter.
  Index* corner;
  /// #F, of the list of those on it, kInvalidIndex: none; of faces that are still to come back not set.
  std::unique_ptr<Index[]> firstPlace;
  std::vector<PlaceState> places;

  void put(Index place, Index face)
  {
    places[place].face = face;
    places[place].next = firstPlace[face];
    firstPlace[face] = place;
  }
};

/// Weights below it are rounding: the place is on the edge, or at the corner.
constexpr double kWeightRounding = 1e-9;

/// Fetches the face of a slot.
struct FetchFace
{
  [[gnu::always_inline]] void operator()(Index slot) const
  {
#if defined(__GNUC__)
    __builtin_prefetch(&corner[slot], 1);
    __builtin_prefetch(&firstPlace[slot / 3], 1);
#else
    static_cast<void>(slot);
#endif
  }

  const Index* corner;
  const Index* firstPlace;
};

class StarCarrier
{
public:
  StarCarrier(PlacesByFace& state, const std::vector<Vector3>& position)
    : state_(state), position_(position)
  {
  }

  void run(const BlockRecords& records)
  {
    readBackwards(
      records, record_, [this](Index h, Index g) { unflip(h, g); }, [this] { uncollapse(); },
      FetchFace{ state_.corner, state_.firstPlace.get() });
  }

private:
  /// A place on its way.
  struct Moving
  {
    Index place;
    Complex at;
    Index vertex; ///< that it lies at; kInvalidIndex: at none
  };

  Index slot(int i) const { return record_.slot[static_cast<std::size_t>(i)]; }
  Index& cornerAt(Index h) { return state_.corner[h]; }
  bool isEmpty(Index face) const { return state_.firstPlace[face] == kInvalidIndex; }

  /// Where `corner` lies in the plane of a triangle with base, which is at 0, and before: the angle between both and
  /// the length are those in space.
  static Complex beside(
    const Vector3& base, const Vector3& before, const Vector3& corner, Complex flatBefore)
  {
    const Vector3 a = before - base, b = corner - base;
    const double lengths = a.norm() * b.norm();
    const double flat = std::abs(flatBefore);
    if (!(lengths > 0) || !(flat > 0))
    {
      return Complex(b.norm());
    }
    const Complex turn(a.dot(b) / lengths, a.cross(b).norm() / lengths);
    return flatBefore * turn * (b.norm() / flat);
  }

  /// Takes the places of a face whose corners, from the slot h on, lie at these points.
  void take(Index h, Complex a, Complex b, Complex c)
  {
    const Index face = h / 3;
    const std::array<Index, 3> corner{ h % 3, (h + 1) % 3, (h + 2) % 3 };
    Index place = std::exchange(state_.firstPlace[face], kInvalidIndex);
    while (place != kInvalidIndex)
    {
      const PlaceState& at = state_.places[place];
      const Complex flat =
        at.weights[corner[0]] * a + at.weights[corner[1]] * b + at.weights[corner[2]] * c;
      Index vertex = kInvalidIndex;
      for (Index k = 0; k < 3; ++k)
      {
        vertex = at.weights[k] == 1 ? cornerAt(3 * face + k) : vertex;
      }
      moving_.push_back({ place, flat, vertex });
      place = at.next;
    }
  }

  /// What moves goes into the triangle that holds it, or that it is least far outside of; what lies at a vertex stays
  /// there.
  void putAll()
  {
    for (const Moving& moving : moving_)
    {
      PlaceState& place = state_.places[moving.place];
      const Index slot =
        moving.vertex == kInvalidIndex ? putInside(moving.at, place) : putAt(moving.vertex, place);
      state_.put(moving.place, slot / 3);
    }
    moving_.clear();
  }

  /// Returns the first corner of the triangle. Outside of all of them it stays outside: a later star may have it.
  Index putInside(Complex at, PlaceState& place) const
  {
    const PlaneTriangle<Complex>* const held = triangleOf(triangles_, at);
    const Index slot = held != nullptr ? held->slot : triangles_.front().slot;
    const std::array<double, 3> weights =
      held != nullptr ? held->weightsOf(at) : std::array<double, 3>{ 1.0 / 3, 1.0 / 3, 1.0 / 3 };
    for (Index k = 0; k < 3; ++k)
    {
      place.weights[(slot + k) % 3] = weights[k];
    }
    return slot;
  }

  Index putAt(Index vertex, PlaceState& place)
  {
    for (const PlaneTriangle<Complex>& triangle : triangles_)
    {
      const Index first = triangle.slot / 3 * 3;
      for (Index h = first; h < first + 3; ++h)
      {
        if (cornerAt(h) == vertex)
        {
          place.weights = {};
          place.weights[h % 3] = 1;
          return triangle.slot;
        }
      }
    }
    throw std::logic_error("a vertex of a star is none of the star with its vertex");
  }

  /// See the figure in DecimationLog.h: f = (a, d, c) and g/3 = (b, c, d) become (a, b, c) and (b, a, d).
  void unflip(Index h, Index g)
  {
    const Index a = cornerAt(h), b = cornerAt(g);
    const Index nextH = Mesh::next(h), nextG = Mesh::next(g);
    const Index d = cornerAt(nextH), c = cornerAt(nextG);
    const bool isEmptyPair = isEmpty(h / 3) && isEmpty(g / 3);
    if (!isEmptyPair)
    {
      takeFlip(h, g, { a, b, c, d });
    }
    cornerAt(nextH) = b;
    cornerAt(nextG) = a;
    if (!isEmptyPair)
    {
      putAll();
    }
  }

  void takeFlip(Index h, Index g, const std::array<Index, 4>& v)
  {
    const Vector3& base = position_[v[3]];
    const Complex c((position_[v[2]] - base).norm());
    // d lies at 0; counterclockwise round it b, c, a.
    const Complex a = beside(base, position_[v[2]], position_[v[0]], c);
    const Complex b = std::conj(beside(base, position_[v[2]], position_[v[1]], c));
    take(h, a, 0, c);
    take(g, b, c, 0);
    triangles_ = { { h, { a, b, c } }, { g, { b, a, Complex(0) } } };
  }

  void uncollapse()
  {
    const int first = record_.firstSurvivor();
    const int last = record_.lastSurvivor();
    bool isEmptyStar = true;
    for (int i = first; i <= last; ++i)
    {
      isEmptyStar = isEmptyStar && isEmpty(slot(i) / 3);
    }
    const Index target = cornerAt(slot(first));
    if (!isEmptyStar)
    {
      takeStar(target);
    }
    comeBack(target);
    if (!isEmptyStar)
    {
      putAll();
    }
  }

  /// The ring of the star round the vertex that it had collapsed onto, which lies at 0, and what is to go where.
  void takeStar(Index target)
  {
    const int first = record_.firstSurvivor();
    const int last = record_.lastSurvivor();
    const Vector3& base = position_[target];
    ring_[static_cast<std::size_t>(record_.target())] = 0;
    Index before = cornerAt(Mesh::next(slot(first)));
    Complex at((position_[before] - base).norm());
    for (int i = first; i <= last; ++i)
    {
      const Index after = cornerAt(Mesh::previous(slot(i)));
      const Complex next = beside(base, position_[before], position_[after], at);
      ring_[static_cast<std::size_t>(i)] = at;
      ring_[static_cast<std::size_t>(i) + 1] = next;
      take(slot(i), 0, at, next);
      before = after;
      at = next;
    }
    const Complex p = StarReplay<PlaneCharts>::placeInRing(ring_, record_);
    layOutStar(record_, ring_, intoStar(record_, ring_, p), triangles_);
  }

  /// The vertex gets its corners, and the faces at its edge to the target come back.
  void comeBack(Index target)
  {
    const int first = record_.firstSurvivor();
    const int last = record_.lastSurvivor();
    for (int i = first; i <= last; ++i)
    {
      cornerAt(slot(i)) = record_.vertex;
    }
    if (first == 1)
    {
      bringBack(slot(0), target, cornerAt(Mesh::next(slot(1))));
    }
    if (last == record_.faces - 2)
    {
      bringBack(slot(record_.faces - 1), cornerAt(Mesh::previous(slot(last))), target);
    }
  }

  void bringBack(Index h, Index next, Index previous)
  {
    cornerAt(h) = record_.vertex;
    cornerAt(Mesh::next(h)) = next;
    cornerAt(Mesh::previous(h)) = previous;
    state_.firstPlace[h / 3] = kInvalidIndex;
  }

  PlacesByFace& state_;
  const std::vector<Vector3>& position_;
  CollapseRecord record_;
  std::array<Complex, kMaximumRing + 1> ring_;
  std::vector<Moving> moving_;
  std::vector<PlaneTriangle<Complex>> triangles_;
};

void checkCarried(const Mesh& fine, const Level& level, const DecimationLog& log,
  const std::vector<FacePlace>& places)
{
  refuseIf(fine.faceCount() != log.fineFaces ||
      level.mesh.vertexCount() + log.collapses != fine.vertexCount(),
    "A level of ", level.mesh.vertexCount(), " vertices and a log of ", log.collapses,
    " removals are not those of a mesh of ", fine.vertexCount(), " vertices and ", fine.faceCount(),
    " faces.");
  requirePlaces(level, places);
}

} // namespace

std::vector<FacePlace> carryPlaces(Mesh& fine, const Level& level, const DecimationLog& log,
  const std::vector<FacePlace>& places, int threads, const ProgressCallback& progress)
{
  checkCarried(fine, level, log, places);
  PlacesByFace state{ fine.origin.edit(), std::unique_ptr<Index[]>(new Index[log.fineFaces]), {} };
  for (Index f = 0; f < level.mesh.faceCount(); ++f)
  {
    const Index fineFace = level.fineFace[f];
    for (Index k = 0; k < 3; ++k)
    {
      state.corner[3 * fineFace + k] = level.fineVertex[level.mesh.origin[3 * f + k]];
    }
    state.firstPlace[fineFace] = kInvalidIndex;
  }
  state.places.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    state.places[i].weights = places[i].weights;
    state.put(static_cast<Index>(i), level.fineFace[places[i].face]);
  }
  carryBackwards(log, log.rounds.size(), threads, progress,
    [&](const BlockRecords& records) { StarCarrier(state, fine.position).run(records); });
  std::vector<FacePlace> result(places.size());
  std::transform(state.places.begin(), state.places.end(), result.begin(),
    [](const PlaceState& place) {
      return FacePlace{ place.face, insideWeights(place.weights, kWeightRounding) };
    });
  return result;
}

} // namespace quadrille
