// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/QuadPatches.h"

#include "Mesh/SurfaceParts.h"
#include "Quads/QuadShape.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>

namespace quadrille
{

namespace
{

/// Rings of quads round a bad one that changes are tried in, and whose points may move.
constexpr int kRingsOfChanges = 1, kRingsOfPatch = 2;

/// Quads with a corner that is straight but for this count as inverted: rounding makes them so.
constexpr double kStraightCorner = 1e-4;

using Quad = std::array<Index, 4>;

} // namespace

QuadScore scoreOf(const FaceQuads& mesh)
{
  QuadScore score;
  for (const Quad& quad : mesh.quads)
  {
    if (quad[0] != kInvalidIndex)
    {
      const double shape =
        std::min(shapeOfQuad(mesh, quad), scaledJacobian(cornersOf(mesh.points, quad)));
      score.inverted += shape > kStraightCorner ? 0 : 1;
      score.bad += shape < kLeastShape ? 1 : 0;
      score.worst = std::min(score.worst, shape);
    }
  }
  return score;
}

QuadPatches::QuadPatches(const Mesh& mesh, QuadMesh& quads, const std::vector<Index>& fixedVertices)
  : mesh_(mesh), quads_(quads), topology_(analyzeQuads(quads.quads, quads.points.size())),
    quadsAt_(quadsAtPoints(quads.quads, quads.points.size())), stays_(quads.points.size(), 0),
    onLine_(topology_.onBoundary), isTouched_(quads.quads.size(), 0)
{
  for (const QuadLine& line : quads.lines)
  {
    lines_.insert(std::minmax(line.a, line.b));
    onLine_[line.a] = 1;
    onLine_[line.b] = 1;
  }
  for (Index p = 0; p < quads.points.size() && !fixedVertices.empty(); ++p)
  {
    const std::optional<Index> corner = meshCorner(quads, p);
    const bool stays = corner &&
      std::binary_search(fixedVertices.begin(), fixedVertices.end(), mesh.origin[*corner]);
    stays_[p] = stays ? 1 : 0;
  }
}

void QuadPatches::keep(const std::vector<std::vector<Index>>& chains)
{
  for (const std::vector<Index>& chain : chains)
  {
    for (std::size_t i = 0; i < chain.size(); ++i)
    {
      stays_[chain[i]] = 1;
      if (i > 0)
      {
        lines_.insert(std::minmax(chain[i - 1], chain[i]));
      }
    }
  }
}

bool QuadPatches::areJoined(Index a, Index b) const
{
  return std::any_of(quadsAt_.begin(a), quadsAt_.end(a),
    [&](Index q)
    {
      const Quad& quad = quads_.quads[q];
      const auto at = std::find(quad.begin(), quad.end(), a) - quad.begin();
      return at < 4 && (quad[(at + 1) % 4] == b || quad[(at + 3) % 4] == b);
    });
}

std::optional<QuadPatch> QuadPatches::around(Index q) const
{
  QuadPatch patch;
  if (!collect(q, patch))
  {
    return std::nullopt;
  }
  patch.triangles = trianglesBelow(patch);
  if (patch.triangles.empty())
  {
    return std::nullopt;
  }
  patch.below = std::make_shared<const Mesh>(partOf(mesh_, patch.triangles).mesh);
  patch.ground = std::make_shared<const FaceGround>(*patch.below);
  number(patch);
  return patch;
}

/// In rings round a quad, without crossing lines. False where one of them was changed already.
bool QuadPatches::collect(Index first, QuadPatch& patch) const
{
  if (isTouched_[first] != 0)
  {
    return false;
  }
  std::set<Index> known{ first };
  patch.quads = { first };
  std::size_t begin = 0;
  bool isFresh = true;
  for (int ring = 1; isFresh && ring <= kRingsOfPatch; ++ring)
  {
    const std::size_t end = patch.quads.size();
    const auto add = [&](Index q)
    {
      if (known.insert(q).second)
      {
        patch.quads.push_back(q);
        isFresh = isFresh && isTouched_[q] == 0;
      }
    };
    for (; begin < end; ++begin)
    {
      for (Index h = 4 * patch.quads[begin]; h < 4 * patch.quads[begin] + 4; ++h)
      {
        const Index a = quads_.origin(h), b = quads_.target(h);
        const Index twin = topology_.twin[h];
        if (twin != kInvalidIndex && !isOnLine(a, b))
        {
          add(twin / 4);
        }
        if (onLine_[a] == 0)
        {
          std::for_each(quadsAt_.begin(a), quadsAt_.end(a), add);
        }
      }
    }
    patch.changeable = ring == kRingsOfChanges ? patch.quads.size() : patch.changeable;
  }
  return isFresh;
}

/// The triangles below the quads, and round them as far as these are wide, without crossing features.
std::vector<Index> QuadPatches::trianglesBelow(const QuadPatch& patch) const
{
  Eigen::AlignedBox3d box;
  for (const Index q : patch.quads)
  {
    for (const Index p : quads_.quads[q])
    {
      box.extend(quads_.points[p]);
    }
  }
  const Vector3 margin = Vector3::Constant(0.5 * box.diagonal().norm());
  box = Eigen::AlignedBox3d(box.min() - margin, box.max() + margin);
  std::vector<Index> found;
  std::set<Index> known;
  const auto add = [&](Index f)
  {
    Eigen::AlignedBox3d triangle;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      triangle.extend(mesh_.position[mesh_.origin[h]]);
    }
    if (box.intersects(triangle) && known.insert(f).second)
    {
      found.push_back(f);
    }
  };
  for (const Index q : patch.quads)
  {
    add(quads_.quadSourceFace[q]);
  }
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    for (Index h = 3 * found[i]; h < 3 * found[i] + 3; ++h)
    {
      if (!mesh_.isConstrained(h))
      {
        add(Mesh::face(mesh_.twin[h]));
      }
    }
  }
  return found;
}

void QuadPatches::number(QuadPatch& patch) const
{
  const std::set<Index> within(patch.quads.begin(), patch.quads.end());
  const auto isPin = [&](Index p)
  {
    return onLine_[p] != 0 || stays_[p] != 0 ||
      std::any_of(
        quadsAt_.begin(p), quadsAt_.end(p), [&](Index q) { return within.count(q) == 0; });
  };
  std::map<Index, Index> own;
  const auto add = [&](Index p)
  {
    if (own.emplace(p, static_cast<Index>(patch.points.size())).second)
    {
      patch.points.push_back(p);
      patch.own.points.push_back(quads_.points[p]);
      patch.own.normals.push_back(
        patch.ground->at(quads_.points[p], Vector3::Zero(), quads_.points[p])->normal);
      patch.own.fitting.push_back(4);
    }
  };
  for (const bool pins : { true, false })
  {
    for (const Index q : patch.quads)
    {
      for (const Index p : quads_.quads[q])
      {
        if (isPin(p) == pins)
        {
          add(p);
        }
      }
    }
    patch.own.pinCount = pins ? static_cast<Index>(patch.points.size()) : patch.own.pinCount;
  }
  for (const Index q : patch.quads)
  {
    const Quad& quad = quads_.quads[q];
    patch.own.quads.push_back({ own[quad[0]], own[quad[1]], own[quad[2]], own[quad[3]] });
  }
}

void QuadPatches::write(const QuadPatch& patch, const FaceQuads& made)
{
  for (const Index q : patch.quads)
  {
    isTouched_[q] = 1;
  }
  std::vector<Index> ids = patch.points;
  for (std::size_t v = made.pinCount; v < made.points.size(); ++v)
  {
    const auto facing = patch.ground->at(made.points[v], made.normals[v], made.points[v]);
    const FaceGround::Spot spot =
      facing ? *facing : *patch.ground->at(made.points[v], Vector3::Zero(), made.points[v]);
    if (v >= ids.size())
    {
      ids.push_back(static_cast<Index>(quads_.points.size()));
      quads_.points.emplace_back();
      quads_.sourceFace.emplace_back();
      quads_.sourceWeights.emplace_back();
    }
    quads_.points[ids[v]] = spot.point;
    quads_.sourceFace[ids[v]] = patch.triangles[spot.face];
    quads_.sourceWeights[ids[v]] = spot.weights;
  }
  for (std::size_t i = 0; i < made.quads.size(); ++i)
  {
    const Quad& quad = made.quads[i];
    if (i < patch.quads.size() && quad == patch.own.quads[i])
    {
      continue;
    }
    Quad there = quad;
    Vector3 middle = Vector3::Zero();
    for (Index& p : there)
    {
      p = p == kInvalidIndex ? p : ids[p];
      middle += p == kInvalidIndex ? Vector3::Zero() : Vector3(quads_.points[p] / 4);
    }
    if (i >= patch.quads.size())
    {
      quads_.quads.emplace_back();
      quads_.quadSourceFace.emplace_back();
      quads_.quadSourceWeights.emplace_back();
    }
    const std::size_t q = i < patch.quads.size() ? patch.quads[i] : quads_.quads.size() - 1;
    quads_.quads[q] = there;
    quads_.quadSourceFace[q] =
      patch.triangles[patch.ground->at(middle, Vector3::Zero(), middle)->face];
    quads_.quadSourceWeights[q] = {};
  }
}

void QuadPatches::finish()
{
  const auto keep = [](auto& list, const std::vector<Index>& kept)
  {
    for (std::size_t i = 0; i < kept.size(); ++i)
    {
      list[i] = list[kept[i]];
    }
    list.resize(kept.size());
  };
  const std::vector<Index> kept =
    idsWhere(quads_.quads.size(), [&](Index q) { return quads_.quads[q][0] != kInvalidIndex; });
  keep(quads_.quads, kept);
  keep(quads_.quadSourceFace, kept);
  keep(quads_.quadSourceWeights, kept);
  std::vector<Index> newId(quads_.points.size(), kInvalidIndex);
  for (const Quad& quad : quads_.quads)
  {
    for (const Index p : quad)
    {
      newId[p] = 0;
    }
  }
  const std::vector<Index> points =
    idsWhere(newId.size(), [&](Index p) { return newId[p] != kInvalidIndex; });
  for (Index i = 0; i < points.size(); ++i)
  {
    newId[points[i]] = i;
  }
  keep(quads_.points, points);
  keep(quads_.sourceFace, points);
  keep(quads_.sourceWeights, points);
  for (Quad& quad : quads_.quads)
  {
    for (Index& p : quad)
    {
      p = newId[p];
    }
  }
  for (QuadLine& line : quads_.lines)
  {
    line.a = newId[line.a];
    line.b = newId[line.b];
  }
  setValences(quads_);
}

} // namespace quadrille
