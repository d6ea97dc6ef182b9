// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/PartingLoops.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace quadrille
{

PartingLoops::PartingLoops(const Mesh& mesh, const std::vector<Index>& outgoing)
  : mesh_(mesh), outgoing_(outgoing)
{
}

bool PartingLoops::setApart(Index one, Index other)
{
  std::unordered_map<Index, Index> into; // half-edge of the face before, by which a face is entered
  std::vector<Index> faces{ Mesh::face(outgoing_[one]) };
  into[faces.front()] = kInvalidIndex;
  for (std::size_t i = 0; i < faces.size() && faces.size() < kMostFacesNear; ++i)
  {
    const Index f = faces[i];
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      if (mesh_.origin[h] == other)
      {
        for (Index g = into.at(f); g != kInvalidIndex; g = into.at(Mesh::face(g)))
        {
          crossed_.insert(g);
          crossed_.insert(mesh_.twin[g]);
        }
        return true;
      }
      if (!mesh_.isBoundary(h) && into.emplace(Mesh::face(mesh_.twin[h]), h).second)
      {
        faces.push_back(Mesh::face(mesh_.twin[h]));
      }
    }
  }
  return false;
}

/// Shortest first over vertices, or over vertices with the parity of crossings on the way to them.
std::vector<Index> PartingLoops::wayTo(Index from, Index to, bool odd, double& bound) const
{
  struct Way
  {
    double length;
    Index by;
  };
  const auto crossings = [&](Index h) { return odd && crossed_.count(h) != 0 ? 1U : 0U; };
  std::unordered_map<Index, Way> known{ { 2 * from, { 0, kInvalidIndex } } }; // 2 v + parity
  NearFirst near;
  near.push({ 0, 2 * from });
  while (!near.empty() && known.size() < kMostFacesNear)
  {
    const auto [length, at] = near.top();
    near.pop();
    if (length > known.at(at).length)
    {
      continue;
    }
    if (at == 2 * to + (odd ? 1U : 0U))
    {
      bound = length;
      std::vector<Index> way;
      for (Index x = at; known.at(x).by != kInvalidIndex;)
      {
        const Index h = known.at(x).by;
        way.push_back(h);
        x = 2 * mesh_.origin[h] + ((x & 1U) ^ crossings(h));
      }
      std::reverse(way.begin(), way.end());
      return way;
    }
    if (!isInner(at / 2))
    {
      continue;
    }
    forEachInFan(mesh_, outgoing_[at / 2],
      [&, so = length, state = at](Index h)
      {
        const double there = so + mesh_.edgeVector(h).norm();
        const Index next = 2 * mesh_.target(h) + ((state & 1U) ^ crossings(h));
        const auto before = known.find(next);
        if (there < bound && (before == known.end() || there < before->second.length))
        {
          known[next] = { there, h };
          near.push({ there, next });
        }
      });
  }
  return {};
}

std::vector<Index> PartingLoops::shortest(Index root, double& bound) const
{
  std::vector<Index> loop = wayTo(root, root, true, bound);
  return loop.empty() ? loop : simple(std::move(loop));
}

std::vector<Index> PartingLoops::through(const std::array<Index, 3>& corners, double bound) const
{
  std::vector<Index> loop;
  for (std::size_t i = 0; i < 3; ++i)
  {
    double length = bound;
    const std::vector<Index> way = wayTo(corners[i], corners[(i + 1) % 3], false, length);
    if (way.empty())
    {
      return {};
    }
    bound -= length;
    loop.insert(loop.end(), way.begin(), way.end());
  }
  return isOdd(loop.begin(), loop.end()) ? simple(std::move(loop)) : std::vector<Index>();
}

bool PartingLoops::isInner(Index v) const
{
  bool inner = true;
  forEachInFan(mesh_, outgoing_[v],
    [&](Index h)
    { inner = inner && !mesh_.isBoundary(h) && !mesh_.isBoundary(Mesh::previous(h)); });
  return inner;
}

std::vector<Index> PartingLoops::simple(std::vector<Index> walk) const
{
  std::unordered_map<Index, std::size_t> at;
  for (std::size_t j = 0; j < walk.size(); ++j)
  {
    const auto [before, isNew] = at.emplace(mesh_.origin[walk[j]], j);
    if (isNew)
    {
      continue;
    }
    const auto begin = walk.begin() + static_cast<std::ptrdiff_t>(before->second);
    const auto end = walk.begin() + static_cast<std::ptrdiff_t>(j);
    if (isOdd(begin, end))
    {
      return simple({ begin, end });
    }
    walk.erase(begin, end);
    return simple(std::move(walk));
  }
  return walk;
}

} // namespace quadrille
