// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/IrregularEdits.h"

#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Mesh/Distance.h"
#include "Mesh/Topology.h"
#include "Pipeline/DrawnOnSurface.h"
#include "Pipeline/FaceDivision.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <utility>

namespace quadrille
{
namespace
{

/// Of the points of the input round a corner of the surface the nearest one.
Index pointNearCorner(const PreparedSurface& surface, Index h)
{
  const SourceLocation source = surface.locate(Mesh::face(h), cornerWeight(h));
  const auto* nearest = std::max_element(source.weights.begin(), source.weights.end());
  return source.points[static_cast<std::size_t>(nearest - source.weights.begin())];
}

bool isInside(const OnCurves& onCurves, Index v)
{
  return onCurves.vertices[v] == 0;
}

bool hasMap(const std::vector<int>& turns, Index v)
{
  return turns[v] != 0;
}

/// One operation, being applied.
class EditResolution
{
public:
  EditResolution(IrregularEdit& edit, const std::string& name, const PlacesOfEdits& where,
    const std::vector<IrregularVertex>& irregular)
    : edit_(edit), name_(name), where_(where), irregular_(irregular)
  {
  }

  std::vector<Vector3> run()
  {
    edit_.before = irregular_;
    edit_.changes.clear();
    switch (edit_.operation)
    {
      case IrregularOperation::Move:
        move();
        break;
      case IrregularOperation::Split:
        split();
        break;
      case IrregularOperation::Merge:
        merge();
        break;
      case IrregularOperation::Cancel:
        cancel();
        break;
      case IrregularOperation::Add:
        addPair();
        break;
    }
    takeChanges();
    return way_;
  }

private:
  static int indexOf(const IrregularVertex& vertex) { return kRegularValence - vertex.valence; }

  const IrregularVertex& vertexNear(std::size_t i) const
  {
    const Vector3 place = where_.places.nearestPlace(edit_.points[i]).point;
    requireMap(place);
    if (isOnCurve(place))
    {
      // A corner of a feature may look irregular, and the nearest one inside would be another one than is meant.
      refuse(name_, " needs an irregular vertex inside, but at ", placeText(place),
        " is a feature or boundary, whose vertices stay: choose one beside it");
    }
    if (irregular_.empty())
    {
      refuse(name_, " needs an irregular vertex near ", placeText(edit_.points[i]),
        ", but the quads have none inside: add a pair first");
    }
    const Vector3& given = edit_.points[i];
    const Vector3 side = sideOf(given);
    const auto rank = [&](const IrregularVertex& vertex)
    { return std::pair(!isOnSide(vertex, side), distanceTo(vertex, given)); };
    return *std::min_element(irregular_.begin(), irregular_.end(),
      [&](const IrregularVertex& a, const IrregularVertex& b) { return rank(a) < rank(b); });
  }
  /// The normal of the quads at a place; zero: not known.
  Vector3 sideOf(const Vector3& given) const
  {
    return where_.quads == nullptr ? Vector3(Vector3::Zero()) : where_.quads->normalAt(given);
  }
  bool isOnSide(const IrregularVertex& vertex, const Vector3& side) const
  {
    return areOnOneSide(shownPlaceOf(vertex).normal, side);
  }
  /// Where it is shown; one without edges there is shown at its own place.
  ShownPlace shownPlaceOf(const IrregularVertex& vertex) const
  {
    static const ShownPlaces kNoneShown;
    const ShownPlaces& shown = where_.shown == nullptr ? kNoneShown : *where_.shown;
    const auto found = shown.find(vertex.place);
    return found == shown.end() ? ShownPlace{ vertex.place } : found->second;
  }
  /// Of its place itself who gives exactly that, else of where it is shown.
  double distanceTo(const IrregularVertex& vertex, const Vector3& given) const
  {
    const double distance = (vertex.place - given).norm();
    return distance <= where_.sameWithin ? 0 : (shownPlaceOf(vertex).point - given).norm();
  }
  /// Two different ones.
  std::pair<IrregularVertex, IrregularVertex> twoVertices() const
  {
    const IrregularVertex& first = vertexNear(0);
    const IrregularVertex& second = vertexNear(1);
    if (first.place == second.place)
    {
      refuse(name_, " needs two irregular vertices, but the one nearest to both of its places is ",
        "that of valence ", first.valence, " at ", placeText(first.place),
        ": give places nearer to the two");
    }
    return { first, second };
  }
  /// Where an irregular vertex is already, that one.
  Vector3 placeNear(std::size_t i) const
  {
    Vector3 place = where_.places.nearestPlace(edit_.points[i]).point;
    for (const IrregularVertex& vertex : irregular_)
    {
      if ((vertex.place - place).norm() <= where_.sameWithin)
      {
        return vertex.place;
      }
    }
    requireMap(place);
    if (isOnCurve(place))
    {
      refuse(name_, " would put an irregular vertex on a feature or boundary, at ",
        placeText(place), ": choose a place inside");
    }
    return place;
  }
  /// Another irregular vertex than the one that is moved, shown where that goes; null: none is.
  const IrregularVertex* shownNear(const IrregularVertex& moved, std::size_t i) const
  {
    constexpr double kJoinsWithin = 0.5; // edge lengths
    const Vector3 side = sideOf(edit_.points[i]);
    const IrregularVertex* nearest = nullptr;
    for (const IrregularVertex& vertex : irregular_)
    {
      const double within =
        std::max(where_.sameWithin, kJoinsWithin * shownPlaceOf(vertex).edgeLength);
      const double distance = distanceTo(vertex, edit_.points[i]);
      if (!(vertex == moved) && distance <= within && isOnSide(vertex, side) &&
        (nearest == nullptr || distance < distanceTo(*nearest, edit_.points[i])))
      {
        nearest = &vertex;
      }
    }
    return nearest;
  }
  /// Where two that become one are: where the one that stayed is shown, unless no vertex can be put there.
  Vector3 placeShown(const IrregularVertex& vertex) const
  {
    const Vector3 shown = where_.places.nearestPlace(shownPlaceOf(vertex).point).point;
    const bool isSame = (shown - vertex.place).norm() <= where_.sameWithin;
    return isSame || isOnCurve(shown) || isWithoutMap(shown) ? vertex.place : shown;
  }
  /// Of a feature or a boundary.
  bool isOnCurve(const Vector3& place) const
  {
    return std::any_of(where_.fixed.edges.begin(), where_.fixed.edges.end(),
      [&](const std::array<Vector3, 2>& edge)
      { return distanceToSegment(place, edge[0], edge[1]) <= where_.sameWithin; });
  }
  /// Quads that fill a face without a map have irregular vertices that no operation can take.
  void requireMap(const Vector3& place) const
  {
    if (isWithoutMap(place))
    {
      refuse(name_, " needs quads of a map, but the face between sharp edges at ", placeText(place),
        " has no map with quads of this size: ask for more quads");
    }
  }
  bool isWithoutMap(const Vector3& place) const
  {
    return std::any_of(where_.fixed.withoutMap.begin(), where_.fixed.withoutMap.end(),
      [&](const std::array<Vector3, 3>& face)
      {
        return (nearestOnTriangle(place, face[0], face[1], face[2]) - place).norm() <=
          where_.sameWithin;
      });
  }
  void add(const Vector3& place, int index) { indices_[place] += index; }

  void move()
  {
    const IrregularVertex from = vertexNear(0);
    const IrregularVertex* other = shownNear(from, 1);
    const Vector3 to = other == nullptr ? placeNear(1) : placeShown(*other);
    if (to == from.place)
    {
      refuse(name_, ": the irregular vertex of valence ", from.valence, " is at ",
        placeText(from.place), " already");
    }
    add(from.place, -indexOf(from));
    add(to, indexOf(from));
    if (other != nullptr && other->place != to)
    {
      add(other->place, -indexOf(*other));
      add(to, indexOf(*other));
    }
    way_ = { from.place, to };
  }

  void split()
  {
    const IrregularVertex at = vertexNear(0);
    const Vector3 first = placeNear(1);
    const Vector3 second = placeNear(2);
    const int index = indexOf(at);
    if (edit_.valences.empty() && index % 2 != 0)
    {
      refuse(name_, ": the irregular vertex at ", placeText(at.place), " has valence ", at.valence,
        ", which has no half: give two valences with the sum ", kRegularValence + at.valence);
    }
    requireTwo(first, second);
    add(at.place, -index);
    add(first, edit_.valences.empty() ? index / 2 : kRegularValence - edit_.valences[0]);
    add(second, edit_.valences.empty() ? index / 2 : kRegularValence - edit_.valences[1]);
  }

  void merge()
  {
    const auto [first, second] = twoVertices();
    if (indexOf(first) + indexOf(second) == 0)
    {
      refuse(name_, ": valences ", first.valence, " and ", second.valence,
        " would make a regular vertex: cancel the pair instead");
    }
    const Vector3 to = edit_.points.size() > 2 ? placeNear(2) : first.place;
    add(first.place, -indexOf(first));
    add(second.place, -indexOf(second));
    add(to, indexOf(first) + indexOf(second));
  }

  void cancel()
  {
    const auto [first, second] = twoVertices();
    add(first.place, -indexOf(first));
    add(second.place, -indexOf(second));
  }

  void addPair()
  {
    const Vector3 first = placeNear(0);
    const Vector3 second = placeNear(1);
    requireTwo(first, second);
    add(first, edit_.valences.empty() ? 1 : kRegularValence - edit_.valences[0]);
    add(second, edit_.valences.empty() ? -1 : kRegularValence - edit_.valences[1]);
  }

  void requireTwo(const Vector3& first, const Vector3& second) const
  {
    if ((first - second).norm() <= where_.sameWithin)
    {
      refuse(name_, ": both places are the same on the surface, ", placeText(first));
    }
  }

  void takeChanges()
  {
    const int off = std::accumulate(indices_.begin(), indices_.end(), 0,
      [](int sum, const auto& change) { return sum + change.second; });
    if (off != 0)
    {
      refuse(name_, " would change the sum of indices (4 - valence) by ", off,
        ", but the surface's shape sets it: choose valences that add up");
    }
    for (const auto& [place, index] : indices_)
    {
      const Vector3 at = place;
      const auto found = std::find_if(irregular_.begin(), irregular_.end(),
        [&at](const IrregularVertex& vertex) { return vertex.place == at; });
      const int before = found == irregular_.end() ? kRegularValence : found->valence;
      const int after = before - index;
      if (after < kLeastValence || after > kMostValence)
      {
        refuse(name_, " would make a vertex of valence ", after, " at ", placeText(place),
          ", but only ", kLeastValence, " to ", kMostValence, " are possible");
      }
      if (after != before)
      {
        edit_.changes.push_back({ place, before, after });
      }
    }
    if (edit_.changes.empty())
    {
      refuse(name_, " would change nothing: its places are those of the vertices that it takes");
    }
  }

  IrregularEdit& edit_;
  const std::string& name_;
  const PlacesOfEdits& where_;
  const std::vector<IrregularVertex>& irregular_;
  std::map<Vector3, int, PlaceOrder> indices_; ///< by how much they grow
  std::vector<Vector3> way_;                   ///< of a move
};

} // namespace

OnCurves findOnCurves(const MadeSurface& made, int threads)
{
  const Mesh& mesh = made.surface.mesh;
  OnCurves on;
  on.vertices = constrainedVertices(mesh);
  for (const Index h : constrainedEdges(mesh, threads))
  {
    on.edges.push_back({ made.placeAt(h), made.placeAt(Mesh::next(h)) });
  }
  return on;
}

std::vector<IrregularVertex> irregularVertices(const MadeSurface& made,
  const std::vector<int>& turns, const OnCurves& onCurves, const std::vector<ValencePlace>& asked,
  double takenWithin)
{
  const Mesh& mesh = made.surface.mesh;
  std::vector<IrregularVertex> irregular;
  std::vector<std::uint8_t> isOpen(mesh.vertexCount(), 0);
  std::size_t open = 0;
  for (Index v = 0; v < turns.size(); ++v)
  {
    isOpen[v] = isInside(onCurves, v) && hasMap(turns, v) && turns[v] != kRegularValence;
    open += isOpen[v];
  }
  for (Index h = 0; open > 0 && h < mesh.halfEdgeCount(); ++h)
  {
    const Index v = mesh.origin[h];
    if (isOpen[v] == 0)
    {
      continue;
    }
    isOpen[v] = 0;
    --open;
    IrregularVertex vertex{ made.placeAt(h), turns[v] };
    const ValencePlace* nearest = nearestOf(asked, vertex.valence, vertex.place, takenWithin);
    vertex.place = nearest == nullptr ? vertex.place : nearest->place;
    irregular.push_back(vertex);
  }
  std::sort(irregular.begin(), irregular.end(),
    [](const IrregularVertex& a, const IrregularVertex& b)
    { return PlaceOrder()(a.place, b.place); });
  return irregular;
}

FixedPlaces fixedPlaces(
  const MadeSurface& made, const OnCurves& onCurves, const std::vector<Vector3>& insideOfFaces)
{
  FixedPlaces fixed{ onCurves.edges, {}, insideOfFaces };
  if (insideOfFaces.empty())
  {
    return fixed;
  }
  const Mesh& mesh = made.surface.mesh;
  std::vector<Vector3> places = insideOfFaces;
  for (Vector3& place : places)
  {
    place = made.frame == nullptr ? place : made.frame->fromUser(place);
  }
  const std::vector<std::uint8_t> isWithout = isInFaces(mesh, facesAt(places, mesh));
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (isWithout[f] != 0)
    {
      fixed.withoutMap.push_back(
        { made.placeAt(3 * f), made.placeAt(3 * f + 1), made.placeAt(3 * f + 2) });
    }
  }
  return fixed;
}

std::string lostMapText(const std::vector<Vector3>& with, const std::vector<Vector3>& without)
{
  if (with.size() <= without.size())
  {
    return {};
  }
  const auto isNew = [&](const Vector3& place) { return !contains(without, place); };
  return "with it a face between sharp edges has no map with quads of this size, near " +
    placeText(*std::find_if(with.begin(), with.end(), isNew)) +
    ": ask for more quads, or choose another place";
}

std::vector<HeldVertex> featureVertices(
  const MadeSurface& made, const std::vector<SectorRequest>& onFeatures)
{
  const Mesh& mesh = made.surface.mesh;
  std::vector<Index> corner(onFeatures.empty() ? 0 : mesh.vertexCount(), kInvalidIndex);
  for (Index h = 0; h < mesh.halfEdgeCount() && !corner.empty(); ++h)
  {
    Index& at = corner[mesh.origin[h]];
    at = at == kInvalidIndex ? h : at;
  }
  std::vector<HeldVertex> vertices;
  for (const SectorRequest& request : onFeatures)
  {
    const Index h = corner[request.vertex];
    vertices.push_back({ pointNearCorner(made.surface, h), made.placeAt(h), request.sectors });
  }
  std::stable_sort(vertices.begin(), vertices.end(),
    [](const HeldVertex& a, const HeldVertex& b) { return a.point < b.point; });
  return vertices;
}

std::vector<Vector3> resolveEdit(IrregularEdit& edit, const std::string& name,
  const PlacesOfEdits& where, const std::vector<IrregularVertex>& irregular)
{
  return EditResolution(edit, name, where, irregular).run();
}

//------------------------------------------------------------------------------
std::string IrregularList::apply(int id, int revision, const IrregularEdit& edit)
{
  std::map<Vector3, int, PlaceOrder> valences = valences_;
  std::optional<std::vector<IrregularVertex>> shown = shown_;
  const auto show = [&shown](const IrregularEdit::Change& made)
  {
    if (shown)
    {
      quadrille::change(*shown, made);
    }
  };
  const bool takesOwn = edit.upon == links_ || !isInForce_;
  if (takesOwn)
  {
    for (auto& [place, valence] : valences)
    {
      valence = kRegularValence; // unless the operation's list has it
    }
    for (const IrregularVertex& vertex : edit.before)
    {
      valences[vertex.place] = vertex.valence;
    }
    const bool isKnown = !edit.shown.empty() || edit.before.empty();
    shown = isKnown ? std::optional(edit.shown) : std::nullopt;
  }
  for (std::size_t i = takesOwn && !(edit.upon == links_) ? edit.upon.size() : 0; i-- > 0;)
  {
    for (const IrregularEdit::Change& change : edit.upon[i].changes)
    {
      valences[change.place] = change.before;
      show({ change.place, change.after, change.before });
    }
  }
  for (const IrregularEdit::Change& change : edit.changes)
  {
    const int there = valences.emplace(change.place, kRegularValence).first->second;
    if (there != change.before)
    {
      return "it changes the vertex of valence " + std::to_string(change.before) + " at " +
        placeText(change.place) + ", but since the operations before it changed, " +
        "the valence there is " + std::to_string(there) + ": remove it, or make it anew";
    }
    valences[change.place] = change.after;
    show(change);
  }
  for (const IrregularEdit::Change& change : edit.changes)
  {
    changedBy_[change.place] = id;
  }
  valences_ = std::move(valences);
  shown_ = std::move(shown);
  if (takesOwn)
  {
    onFeatures_ = edit.onFeatures;
    withoutMap_ = edit.withoutMap;
    joined_ = edit.joined;
  }
  links_.push_back({ id, revision, edit.changes });
  isInForce_ = true;
  return {};
}

int IrregularList::valenceAt(const Vector3& place) const
{
  const auto found = valences_.find(place);
  return found == valences_.end() ? kRegularValence : found->second;
}

Vector3 IrregularList::sameAs(const Vector3& place, double sameWithin) const
{
  Vector3 best = place;
  double least = kInfinity;
  for (const auto& [other, valence] : valences_)
  {
    const double distance = (other - place).norm();
    if (distance <= sameWithin && distance < least)
    {
      least = distance;
      best = other;
    }
  }
  return best;
}

std::vector<IrregularVertex> IrregularList::irregular() const
{
  std::vector<IrregularVertex> vertices;
  for (const auto& [place, valence] : valences_)
  {
    if (valence != kRegularValence)
    {
      vertices.push_back({ place, valence });
    }
  }
  return vertices;
}

int IrregularList::changedBy(const Vector3& place) const
{
  const auto found = changedBy_.find(place);
  return found == changedBy_.end() ? 0 : found->second;
}

} // namespace quadrille
