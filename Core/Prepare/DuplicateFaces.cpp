// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/DuplicateFaces.h"

#include "Base/DisjointSets.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace quadrille
{

namespace
{

/// A face under the name of its three sorted vertices.
struct NamedFace
{
  std::array<Index, 3> vertices;
  Index face;
  bool even; ///< the corners are an even permutation of the sorted vertices

  bool operator<(const NamedFace& other) const
  {
    return std::tie(vertices, face) < std::tie(other.vertices, other.face);
  }
};

NamedFace nameOf(const Mesh& mesh, Index f)
{
  std::array<Index, 3> v{ mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] };
  const bool even = (v[0] < v[1]) == ((v[1] < v[2]) == (v[0] < v[2]));
  std::sort(v.begin(), v.end());
  return { v, f, even };
}

/// All faces that share an edge and the vertex opposite to it with another face.
std::vector<NamedFace> repeatedFaces(const Mesh& mesh, const EdgeRuns& runs)
{
  std::vector<NamedFace> faces;
  const auto apex = [&mesh](const EdgeRuns::Entry* entry)
  { return mesh.origin[Mesh::previous(entry->halfEdge)]; };
  std::vector<std::pair<Index, Index>> apexes;
  runs.forEach(
    [&](const EdgeRuns::Entry* begin, const EdgeRuns::Entry* end)
    {
      if (end - begin < 2 || (end - begin == 2 && apex(begin) != apex(begin + 1)))
      {
        return;
      }
      apexes.clear();
      for (const EdgeRuns::Entry* entry = begin; entry != end; ++entry)
      {
        apexes.emplace_back(apex(entry), entry->halfEdge / 3);
      }
      std::sort(apexes.begin(), apexes.end());
      for (std::size_t i = 0; i < apexes.size(); ++i)
      {
        const bool repeated = (i > 0 && apexes[i - 1].first == apexes[i].first) ||
          (i + 1 < apexes.size() && apexes[i + 1].first == apexes[i].first);
        if (repeated)
        {
          faces.push_back(nameOf(mesh, apexes[i].second));
        }
      }
    });
  std::sort(faces.begin(), faces.end());
  const auto sameFace = [](const NamedFace& a, const NamedFace& b) { return a.face == b.face; };
  faces.erase(std::unique(faces.begin(), faces.end(), sameFace), faces.end());
  return faces;
}

/// What becomes of a pair of opposite faces.
enum class PairFate
{
  KeepOne,
  KeepBoth,
  KeepNone
};

/// Finds regions of opposite pairs that hang together, and what they are from the edges where they
/// end: by how many other faces there are.
class PairRegions
{
public:
  /// pairOfFace: #F, kInvalidIndex for faces in no pair.
  PairRegions(const EdgeRuns& runs, const std::vector<Index>& pairOfFace, Index pairs)
    : regions_(pairs, 1), ends_(pairs)
  {
    runs.forEach([&](const EdgeRuns::Entry* begin, const EdgeRuns::Entry* end)
      { addEdge(begin, end, pairOfFace); });
  }

  std::vector<PairFate> fates()
  {
    std::vector<Ends> total(ends_.size());
    for (Index i = 0; i < ends_.size(); ++i)
    {
      Ends& ends = total[regions_.find(i)];
      ends.complete += ends_[i].complete;
      ends.open += ends_[i].open;
      ends.rim += ends_[i].rim;
      ++ends.pairs;
    }
    std::vector<PairFate> fates(ends_.size());
    for (Index i = 0; i < ends_.size(); ++i)
    {
      fates[i] = fateOf(total[regions_.find(i)]);
    }
    return fates;
  }

private:
  /// Edges at which a region ends.
  struct Ends
  {
    Index complete = 0; ///< with two or four... other faces, which need no face of the pair
    Index open = 0;     ///< with one or three... other faces, which need one
    Index rim = 0;      ///< with none
    Index pairs = 0;    ///< size of the region
  };

  static PairFate fateOf(const Ends& ends)
  {
    if (ends.complete == 0)
    {
      return PairFate::KeepOne; // a sheet with two sides
    }
    if (ends.open == 0 && ends.rim == 0)
    {
      return PairFate::KeepBoth; // a wall between solids
    }
    return ends.complete >= ends.open ? PairFate::KeepNone
                                      : PairFate::KeepOne; // a flap, or a patch
  }

  void addEdge(
    const EdgeRuns::Entry* begin, const EdgeRuns::Entry* end, const std::vector<Index>& pairOfFace)
  {
    pairs_.clear();
    for (const EdgeRuns::Entry* entry = begin; entry != end; ++entry)
    {
      const Index pair = pairOfFace[entry->halfEdge / 3];
      if (pair != kInvalidIndex)
      {
        pairs_.push_back(pair);
      }
    }
    const std::size_t others = static_cast<std::size_t>(end - begin) - pairs_.size();
    for (const Index pair : pairs_)
    {
      ends_[pair].complete += others >= 2 && others % 2 == 0 ? 1 : 0;
      ends_[pair].open += others % 2 == 1 ? 1 : 0;
      ends_[pair].rim += others == 0 && pairs_.size() == 2 ? 1 : 0;
      regions_.join(pair, pairs_.front());
    }
  }

  DisjointSets regions_;
  std::vector<Ends> ends_;
  std::vector<Index> pairs_;
};

/// Faces on the same vertices: the first of each orientation, and all further ones.
struct Sorted
{
  std::vector<std::array<Index, 2>> pairs;
  std::vector<Index> repeats;
};

Sorted sortByOrientation(const std::vector<NamedFace>& faces)
{
  Sorted sorted;
  for (std::size_t i = 0; i < faces.size();)
  {
    std::array<Index, 2> first{ kInvalidIndex, kInvalidIndex };
    const std::array<Index, 3> vertices = faces[i].vertices;
    for (; i < faces.size() && faces[i].vertices == vertices; ++i)
    {
      Index& slot = first[faces[i].even ? 0 : 1];
      if (slot == kInvalidIndex)
      {
        slot = faces[i].face;
      }
      else
      {
        sorted.repeats.push_back(faces[i].face);
      }
    }
    if (first[0] != kInvalidIndex && first[1] != kInvalidIndex)
    {
      sorted.pairs.push_back({ std::min(first[0], first[1]), std::max(first[0], first[1]) });
    }
  }
  return sorted;
}

std::vector<PairFate> decide(
  const EdgeRuns& runs, const std::vector<std::array<Index, 2>>& pairs, Index faceCount)
{
  std::vector<Index> pairOfFace(faceCount, kInvalidIndex);
  for (Index i = 0; i < pairs.size(); ++i)
  {
    pairOfFace[pairs[i][0]] = pairOfFace[pairs[i][1]] = i;
  }
  return PairRegions(runs, pairOfFace, static_cast<Index>(pairs.size())).fates();
}

} // namespace

std::size_t removeDuplicateFaces(PreparedSurface& surface, const EdgeRuns& runs)
{
  const std::vector<NamedFace> faces = repeatedFaces(surface.mesh, runs);
  if (faces.empty())
  {
    return 0;
  }
  const Sorted sorted = sortByOrientation(faces);
  const std::vector<PairFate> fates = decide(runs, sorted.pairs, surface.mesh.faceCount());
  std::vector<Index> toRemove = sorted.repeats;
  for (std::size_t i = 0; i < fates.size(); ++i)
  {
    if (fates[i] == PairFate::KeepNone)
    {
      toRemove.push_back(sorted.pairs[i][0]);
    }
    if (fates[i] != PairFate::KeepBoth)
    {
      toRemove.push_back(sorted.pairs[i][1]);
    }
  }
  for (const Index f : toRemove)
  {
    std::fill_n(surface.mesh.origin.edit() + 3 * std::size_t{ f }, 3, kInvalidIndex);
  }
  return toRemove.size();
}

} // namespace quadrille
