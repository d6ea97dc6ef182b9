// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/IrregularEdits.h"

#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "Base/Refuse.h"
#include "Requests/Guides.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <utility>

namespace quadrille
{
namespace
{

/// Points of the input round a corner of the surface, the nearest one first.
std::array<Index, 3> pointsNearCorner(const PreparedSurface& surface, Index h)
{
  const Index f = Mesh::face(h);
  std::array<Index, 3> order{ h % 3, (h + 1) % 3, (h + 2) % 3 };
  if (!surface.refinedEntry.empty() && surface.refinedEntry[f] != kInvalidIndex)
  {
    const std::array<double, 3>& weights = surface.cornerWeights[surface.refinedEntry[f]][h % 3];
    order = { 0, 1, 2 };
    std::stable_sort(
      order.begin(), order.end(), [&](Index a, Index b) { return weights[a] > weights[b]; });
  }
  return { surface.sourcePoints[f][order[0]], surface.sourcePoints[f][order[1]],
    surface.sourcePoints[f][order[2]] };
}

/// One operation, being applied.
class EditResolution
{
public:
  EditResolution(IrregularEdit& edit, const std::string& name, const SurfaceInput& surface,
    const SurfacePlaces& places, const std::vector<IrregularVertex>& irregular,
    const std::vector<Index>& fixedPoints)
    : edit_(edit), name_(name), surface_(surface), places_(places), irregular_(irregular),
      fixedPoints_(fixedPoints)
  {
  }

  void run()
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
  }

private:
  static int indexOf(const IrregularVertex& vertex) { return kRegularValence - vertex.valence; }

  const IrregularVertex& vertexNear(std::size_t i) const
  {
    if (irregular_.empty())
    {
      refuse(name_, " needs an irregular vertex near ", placeText(edit_.points[i]),
        ", but the quads have none inside: add a pair first");
    }
    return *std::min_element(irregular_.begin(), irregular_.end(),
      [&](const IrregularVertex& a, const IrregularVertex& b) {
        return (a.place - edit_.points[i]).squaredNorm() <
          (b.place - edit_.points[i]).squaredNorm();
      });
  }
  /// Two different ones.
  std::pair<IrregularVertex, IrregularVertex> twoVertices() const
  {
    const IrregularVertex& first = vertexNear(0);
    const IrregularVertex& second = vertexNear(1);
    if (first.point == second.point)
    {
      refuse(name_, " needs two irregular vertices, but the one nearest to both of its places is ",
        "that of valence ", first.valence, " at ", placeText(first.place),
        ": give places nearer to the two");
    }
    return { first, second };
  }
  Index pointNear(std::size_t i) const
  {
    const Index point = places_.nearestCorner(edit_.points[i]);
    if (std::binary_search(fixedPoints_.begin(), fixedPoints_.end(), point))
    {
      refuse(name_, " would put an irregular vertex on a feature or boundary, at ",
        placeText(surface_.points[point]), ": choose a place inside");
    }
    return point;
  }
  void add(Index point, int index) { indices_[point] += index; }

  void move()
  {
    const IrregularVertex from = vertexNear(0);
    const Index to = pointNear(1);
    if (to == from.point)
    {
      refuse(name_, ": the irregular vertex of valence ", from.valence, " is at ",
        placeText(from.place), " already");
    }
    add(from.point, -indexOf(from));
    add(to, indexOf(from));
  }

  void split()
  {
    const IrregularVertex at = vertexNear(0);
    const Index first = pointNear(1);
    const Index second = pointNear(2);
    const int index = indexOf(at);
    if (edit_.valences.empty() && index % 2 != 0)
    {
      refuse(name_, ": the irregular vertex at ", placeText(at.place), " has valence ", at.valence,
        ", which has no half: give two valences with the sum ", kRegularValence + at.valence);
    }
    if (first == second)
    {
      refuse(
        name_, ": both places have the same nearest point, ", placeText(surface_.points[first]));
    }
    add(at.point, -index);
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
    const Index to = edit_.points.size() > 2 ? pointNear(2) : first.point;
    add(first.point, -indexOf(first));
    add(second.point, -indexOf(second));
    add(to, indexOf(first) + indexOf(second));
  }

  void cancel()
  {
    const auto [first, second] = twoVertices();
    add(first.point, -indexOf(first));
    add(second.point, -indexOf(second));
  }

  void addPair()
  {
    const Index first = pointNear(0);
    const Index second = pointNear(1);
    if (first == second)
    {
      refuse(
        name_, ": both places have the same nearest point, ", placeText(surface_.points[first]));
    }
    add(first, edit_.valences.empty() ? 1 : kRegularValence - edit_.valences[0]);
    add(second, edit_.valences.empty() ? -1 : kRegularValence - edit_.valences[1]);
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
    for (const auto& [point, index] : indices_)
    {
      const Index at = point;
      const auto found = std::find_if(irregular_.begin(), irregular_.end(),
        [at](const IrregularVertex& vertex) { return vertex.point == at; });
      const int before = found == irregular_.end() ? kRegularValence : found->valence;
      const int after = before - index;
      if (after < kLeastValence || after > kMostValence)
      {
        refuse(name_, " would make a vertex of valence ", after, " at ",
          placeText(surface_.points[point]), ", but only ", kLeastValence, " to ", kMostValence,
          " are possible");
      }
      if (after != before)
      {
        edit_.changes.push_back({ point, before, after });
      }
    }
    if (edit_.changes.empty())
    {
      refuse(name_, " would change nothing: its places are those of the vertices that it takes");
    }
  }

  IrregularEdit& edit_;
  const std::string& name_;
  const SurfaceInput& surface_;
  const SurfacePlaces& places_;
  const std::vector<IrregularVertex>& irregular_;
  const std::vector<Index>& fixedPoints_;
  std::map<Index, int> indices_; ///< by how much they grow
};

} // namespace

OnCurves findOnCurves(const PreparedSurface& surface, int threads)
{
  constexpr std::size_t kEditChunk = 3 << 15;
  const Mesh& mesh = surface.mesh;
  std::vector<std::vector<Index>> constrained((mesh.halfEdgeCount() + kEditChunk - 1) / kEditChunk);
  parallelFor(mesh.halfEdgeCount(), kEditChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (Index h = static_cast<Index>(begin); h < end; ++h)
      {
        if (mesh.isConstrained(h))
        {
          constrained[begin / kEditChunk].push_back(h);
        }
      }
    });
  OnCurves on;
  on.vertices.assign(mesh.vertexCount(), 0);
  for (const std::vector<Index>& part : constrained)
  {
    for (const Index h : part)
    {
      on.vertices[mesh.origin[h]] = on.vertices[mesh.target(h)] = 1;
    }
  }
  std::vector<std::vector<Index>> points(constrained.size());
  parallelFor(mesh.halfEdgeCount(), kEditChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (Index h = static_cast<Index>(begin); h < end; ++h)
      {
        if (on.vertices[mesh.origin[h]] != 0)
        {
          points[begin / kEditChunk].push_back(pointsNearCorner(surface, h)[0]);
        }
      }
    });
  for (const std::vector<Index>& part : points)
  {
    on.points.insert(on.points.end(), part.begin(), part.end());
  }
  std::sort(on.points.begin(), on.points.end());
  on.points.erase(std::unique(on.points.begin(), on.points.end()), on.points.end());
  return on;
}

std::vector<IrregularVertex> irregularVertices(
  const MadeSurface& made, const std::vector<int>& turns, const OnCurves& onCurves)
{
  const Mesh& mesh = made.surface.mesh;
  std::vector<IrregularVertex> irregular;
  std::vector<std::uint8_t> isOpen(mesh.vertexCount(), 0);
  std::size_t open = 0;
  for (Index v = 0; v < turns.size(); ++v)
  {
    isOpen[v] = onCurves.vertices[v] == 0 && turns[v] != kRegularValence;
    open += isOpen[v];
  }
  std::map<Index, IrregularVertex> byPoint;
  for (Index h = 0; open > 0 && h < mesh.halfEdgeCount(); ++h)
  {
    const Index v = mesh.origin[h];
    if (isOpen[v] == 0)
    {
      continue;
    }
    isOpen[v] = 0;
    --open;
    const std::array<Index, 3> near = pointsNearCorner(made.surface, h);
    const auto free =
      std::find_if(near.begin(), near.end(), [&](Index p) { return byPoint.count(p) == 0; });
    if (free != near.end())
    {
      byPoint[*free] = { *free, made.placeAt(h), turns[v] };
    }
    else // of three in one triangle of the input: they count as one with the first
    {
      byPoint[near[0]].valence += turns[v] - kRegularValence;
    }
  }
  for (const auto& [point, vertex] : byPoint)
  {
    if (vertex.valence != kRegularValence)
    {
      irregular.push_back(vertex);
    }
  }
  return irregular;
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
    vertices.push_back({ pointsNearCorner(made.surface, h)[0], made.placeAt(h), request.sectors });
  }
  std::stable_sort(vertices.begin(), vertices.end(),
    [](const HeldVertex& a, const HeldVertex& b) { return a.point < b.point; });
  return vertices;
}

void resolveEdit(IrregularEdit& edit, const std::string& name, const SurfaceInput& surface,
  const SurfacePlaces& places, const std::vector<IrregularVertex>& irregular,
  const std::vector<Index>& fixedPoints)
{
  EditResolution(edit, name, surface, places, irregular, fixedPoints).run();
}

//------------------------------------------------------------------------------
std::string IrregularList::apply(
  int id, int revision, const IrregularEdit& edit, const SurfaceInput& surface)
{
  std::map<Index, int> valences = valences_;
  std::map<Index, Vector3> places = places_;
  const bool takesOwn = edit.upon == links_ || !isInForce_;
  if (takesOwn)
  {
    for (auto& [point, valence] : valences)
    {
      valence = kRegularValence; // unless the operation's list has it
    }
    places.clear();
    for (const IrregularVertex& vertex : edit.before)
    {
      valences[vertex.point] = vertex.valence;
      places[vertex.point] = vertex.place;
    }
  }
  for (std::size_t i = takesOwn && !(edit.upon == links_) ? edit.upon.size() : 0; i-- > 0;)
  {
    for (const IrregularEdit::Change& change : edit.upon[i].changes)
    {
      valences[change.point] = change.before;
    }
  }
  for (const IrregularEdit::Change& change : edit.changes)
  {
    const int there = valences.emplace(change.point, kRegularValence).first->second;
    if (there != change.before)
    {
      return "it changes the vertex of valence " + std::to_string(change.before) + " at " +
        placeText(surface.points[change.point]) + ", but since the operations before it changed, " +
        "the valence there is " + std::to_string(there) + ": remove it, or make it anew";
    }
    valences[change.point] = change.after;
    if (change.before == kRegularValence || change.after == kRegularValence)
    {
      places.erase(change.point);
    }
  }
  for (const IrregularEdit::Change& change : edit.changes)
  {
    changedBy_[change.point] = id;
  }
  valences_ = std::move(valences);
  places_ = std::move(places);
  if (takesOwn)
  {
    onFeatures_ = edit.onFeatures;
  }
  links_.push_back({ id, revision, edit.changes });
  isInForce_ = true;
  return {};
}

int IrregularList::valenceAt(Index point) const
{
  const auto found = valences_.find(point);
  return found == valences_.end() ? kRegularValence : found->second;
}

std::vector<IrregularVertex> IrregularList::irregular(const SurfaceInput& surface) const
{
  std::vector<IrregularVertex> vertices;
  for (const auto& [point, valence] : valences_)
  {
    if (valence != kRegularValence)
    {
      const auto found = places_.find(point);
      vertices.push_back(
        { point, found == places_.end() ? surface.points[point] : found->second, valence });
    }
  }
  return vertices;
}

int IrregularList::changedBy(Index point) const
{
  const auto found = changedBy_.find(point);
  return found == changedBy_.end() ? 0 : found->second;
}

} // namespace quadrille
