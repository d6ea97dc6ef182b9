// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SurfaceEdit.h"

#include "Mesh/Sizing.h"

#include <algorithm>
#include <cassert>

namespace quadrille
{

namespace
{

using Weights = std::array<double, 3>;

/// Weights of a face's corners for its source triangle; begins as identity.
Index ensureEntry(PreparedSurface& surface, Index f)
{
  if (surface.refinedEntry.empty())
  {
    surface.refinedEntry.assign(surface.mesh.faceCount(), kInvalidIndex);
  }
  if (surface.refinedEntry[f] == kInvalidIndex)
  {
    surface.refinedEntry.edit()[f] = static_cast<Index>(surface.cornerWeights.size());
    surface.cornerWeights.push_back({ { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } });
    if (!surface.flipped.empty())
    {
      surface.flipped.push_back({});
    }
  }
  return surface.refinedEntry[f];
}

Weights cornerOf(const PreparedSurface& surface, Index h)
{
  return surface.cornerWeights[surface.refinedEntry[Mesh::face(h)]][h % 3];
}

/// point: of the input, where the corner stands at one.
void setCorner(PreparedSurface& surface, Index h, Index vertex, const Weights& weights,
  Index point = kInvalidIndex)
{
  const Index entry = surface.refinedEntry[Mesh::face(h)];
  surface.mesh.origin.edit()[h] = vertex;
  surface.cornerWeights.edit()[entry][h % 3] = weights;
  if (!surface.flipped.empty())
  {
    FlippedFace& flipped = surface.flipped.edit()[entry];
    flipped.points[h % 3] = point;
    flipped.places[h % 3] = surface.mesh.position[vertex];
  }
}

/// Appends a copy of face f, half-edge for half-edge, without twins and flags; returns its id.
Index appendCopy(PreparedSurface& surface, Index f)
{
  Mesh& mesh = surface.mesh;
  const Index copy = mesh.faceCount();
  const Index entry = ensureEntry(surface, f);
  for (Index i = 0; i < 3; ++i)
  {
    mesh.origin.push_back(Index{ mesh.origin[3 * f + i] });
    mesh.twin.push_back(kInvalidIndex);
    mesh.flags.push_back(0);
  }
  surface.sourcePolygon.push_back(Index{ surface.sourcePolygon[f] });
  surface.sourcePoints.push_back(std::array<Index, 3>(surface.sourcePoints[f]));
  surface.refinedEntry.push_back(static_cast<Index>(surface.cornerWeights.size()));
  surface.cornerWeights.push_back(
    std::array<std::array<double, 3>, 3>(surface.cornerWeights[entry]));
  if (!surface.flipped.empty())
  {
    surface.flipped.push_back(FlippedFace(surface.flipped[entry]));
  }
  return copy;
}

void glue(Mesh& mesh, Index h, Index g)
{
  if (h != kInvalidIndex)
  {
    mesh.twin.edit()[h] = g;
  }
  if (g != kInvalidIndex)
  {
    mesh.twin.edit()[g] = h;
  }
}

/// Hands the edge of h, its flags and its twin, over to half-edge `to`.
void moveEdge(Mesh& mesh, Index h, Index to)
{
  glue(mesh, to, mesh.twin[h]);
  mesh.flags.edit()[to] = mesh.flags[h];
}

void joinInner(Mesh& mesh, Index h, Index g)
{
  glue(mesh, h, g);
  mesh.flags.edit()[h] = mesh.flags.edit()[g] = 0;
}

/// The edge of h, from a to b, comes to join the corners c and d opposite to it; the new one is no feature. Corners and
/// half-edges as in flipEdge().
void turnDiagonal(Mesh& mesh, Index h)
{
  const Index g = mesh.twin[h];
  const Index n = Mesh::next(h), p = Mesh::previous(h);
  const Index ng = Mesh::next(g), pg = Mesh::previous(g);
  moveEdge(mesh, ng, h); // a -> d
  moveEdge(mesh, n, g);  // b -> c
  joinInner(mesh, n, ng);
  mesh.origin.edit()[n] = mesh.origin[pg]; // d -> c
  mesh.origin.edit()[ng] = mesh.origin[p]; // c -> d
}

Weights mean(const Weights& a, const Weights& b)
{
  return { (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2 };
}

Weights between(const Weights& a, const Weights& b, double share)
{
  Weights weights{};
  for (std::size_t k = 0; k < 3; ++k)
  {
    weights[k] = (1 - share) * a[k] + share * b[k];
  }
  return weights;
}

/// Splits the face of h between the new vertex m on h, at a share of it, and its opposite corner. With h from a to b:
/// the face keeps the half at a, the appended face has the other half in the same slots.
Index splitOneSide(PreparedSurface& surface, Index h, Index m, double share)
{
  Mesh& mesh = surface.mesh;
  const Index other = 3 * appendCopy(surface, Mesh::face(h)) + h % 3;
  const Weights middle = between(cornerOf(surface, h), cornerOf(surface, Mesh::next(h)), share);
  moveEdge(mesh, Mesh::next(h), Mesh::next(other));
  setCorner(surface, Mesh::next(h), m, middle);
  setCorner(surface, other, m, middle);
  joinInner(mesh, Mesh::next(h), Mesh::previous(other));
  mesh.flags.edit()[other] = mesh.flags[h];
  return other;
}

/// Of a vertex that was added last.
void addSize(Mesh& mesh, double size)
{
  if (!mesh.sizing.empty())
  {
    mesh.sizing.push_back(static_cast<float>(size));
  }
}

/// Of the origins of half-edges.
Vector3 meanOfOrigins(const Mesh& mesh, const std::vector<Index>& run)
{
  Vector3 sum = Vector3::Zero();
  for (const Index h : run)
  {
    sum += mesh.position[mesh.origin[h]];
  }
  return sum / static_cast<double>(run.size());
}

/// A fan over a closed run of boundary half-edges, each of which ends where the next one begins.
void closeWithFan(PreparedSurface& surface, const std::vector<Index>& run, const Vector3& place)
{
  Mesh& mesh = surface.mesh;
  const Index middle = mesh.vertexCount();
  double sizes = 0;
  for (const Index h : run)
  {
    sizes += sizeAt(mesh, mesh.origin[h]);
  }
  mesh.position.push_back(place);
  addSize(mesh, sizes / static_cast<double>(run.size()));
  const Index first = mesh.faceCount();
  for (const Index h : run)
  {
    const Index to = mesh.target(h);
    const Index from = mesh.origin[h];
    const Index face = 3 * appendCopy(surface, Mesh::face(h)); // becomes (to, from, middle)
    const Weights weightsTo = cornerOf(surface, Mesh::next(h));
    const Weights weightsFrom = cornerOf(surface, h);
    const Index pointTo = surface.inputPointAt(Mesh::next(h)), pointFrom = surface.inputPointAt(h);
    setCorner(surface, face, to, weightsTo, pointTo);
    setCorner(surface, face + 1, from, weightsFrom, pointFrom);
    setCorner(surface, face + 2, middle, mean(weightsTo, weightsFrom));
    glue(mesh, h, face);
    mesh.flags.edit()[face] = mesh.flags[h];
  }
  const Index count = static_cast<Index>(run.size());
  for (Index i = 0; i < count; ++i)
  {
    // (middle -> to) of one face is (from -> middle) of the next.
    joinInner(mesh, 3 * (first + i) + 2, 3 * (first + (i + 1) % count) + 1);
  }
}

} // namespace

std::vector<Index> neighboursOf(const Mesh& mesh, Index h)
{
  std::vector<Index> neighbours;
  const Index v = mesh.origin[h];
  forEachEdgeInFan(mesh, h, [&](Index g) { neighbours.push_back(mesh.otherEnd(g, v)); });
  return neighbours;
}

Index splitEdge(PreparedSurface& surface, Index h, double share)
{
  Mesh& mesh = surface.mesh;
  const Index m = mesh.vertexCount();
  const Index g = mesh.twin[h];
  const Index a = mesh.origin[h], b = mesh.target(h);
  mesh.position.push_back(Vector3((1 - share) * mesh.position[a] + share * mesh.position[b]));
  addSize(mesh, (1 - share) * sizeAt(mesh, a) + share * sizeAt(mesh, b));
  const Index h1 = splitOneSide(surface, h, m, share); // h: a -> m, h1: m -> b
  if (g != kInvalidIndex)
  {
    const Index g1 = splitOneSide(surface, g, m, 1 - share); // g: b -> m, g1: m -> a
    glue(mesh, h, g1);
    glue(mesh, h1, g);
  }
  return m;
}

namespace
{

/// Of a face whose new vertex m has the weights `centre` in its source.
void splitAt(PreparedSurface& surface, Index f, Index m, const Weights& centre)
{
  Mesh& mesh = surface.mesh;
  const Index a = 3 * f;
  const Index b = 3 * appendCopy(surface, f);
  const Index c = 3 * appendCopy(surface, f);
  moveEdge(mesh, a + 1, b + 1);
  moveEdge(mesh, a + 2, c + 2);
  setCorner(surface, a + 2, m, centre); // (a, b, m)
  setCorner(surface, b, m, centre);     // (m, b, c)
  setCorner(surface, c + 1, m, centre); // (a, m, c)
  joinInner(mesh, a + 1, b);
  joinInner(mesh, b + 2, c + 1);
  joinInner(mesh, a + 2, c);
}

} // namespace

Index splitFace(PreparedSurface& surface, Index f)
{
  Mesh& mesh = surface.mesh;
  const Index a = 3 * f;
  const Index m = mesh.vertexCount();
  ensureEntry(surface, f);
  Weights centre{};
  for (Index i = 0; i < 3; ++i)
  {
    const Weights corner = cornerOf(surface, a + i);
    for (std::size_t k = 0; k < 3; ++k)
    {
      centre[k] += corner[k] / 3;
    }
  }
  mesh.position.push_back((mesh.position[mesh.origin[a]] + mesh.position[mesh.origin[a + 1]] +
                            mesh.position[mesh.origin[a + 2]]) /
    3);
  addSize(mesh,
    (sizeAt(mesh, mesh.origin[a]) + sizeAt(mesh, mesh.origin[a + 1]) +
      sizeAt(mesh, mesh.origin[a + 2])) /
      3);
  splitAt(surface, f, m, centre);
  return m;
}

Index splitFace(PreparedSurface& surface, Index f, const std::array<double, 3>& weights)
{
  Mesh& mesh = surface.mesh;
  const Index m = mesh.vertexCount();
  ensureEntry(surface, f);
  Weights place{};
  Vector3 point = Vector3::Zero();
  double size = 0;
  for (Index i = 0; i < 3; ++i)
  {
    const Index v = mesh.origin[3 * f + i];
    const Weights corner = cornerOf(surface, 3 * f + i);
    point += weights[i] * mesh.position[v];
    size += weights[i] * sizeAt(mesh, v);
    for (std::size_t k = 0; k < 3; ++k)
    {
      place[k] += weights[i] * corner[k];
    }
  }
  mesh.position.push_back(Vector3(point));
  addSize(mesh, size);
  splitAt(surface, f, m, place);
  return m;
}

void cutAndClose(PreparedSurface& surface, const std::vector<Index>& loop)
{
  Mesh& mesh = surface.mesh;
  assert(loop.size() >= 3);
  // The faces of the loop keep its vertices; those beyond get copies.
  std::vector<Index> beyond;
  for (std::size_t i = loop.size(); i-- > 0;)
  {
    beyond.push_back(mesh.twin[loop[i]]);
  }
  std::vector<std::pair<Index, Index>> moved; // half-edge, vertex
  for (std::size_t i = 0; i < loop.size(); ++i)
  {
    const Index copy = mesh.vertexCount();
    mesh.position.push_back(Vector3(mesh.position[mesh.origin[loop[i]]]));
    addSize(mesh, sizeAt(mesh, mesh.origin[loop[i]]));
    const Index back = mesh.twin[loop[(i + loop.size() - 1) % loop.size()]];
    for (Index h = back; h != loop[i]; h = mesh.rotateCounterclockwise(h))
    {
      moved.push_back({ h, copy });
    }
  }
  for (const auto& [h, copy] : moved)
  {
    mesh.origin.edit()[h] = copy;
  }
  for (const Index h : loop)
  {
    mesh.twin.edit()[mesh.twin[h]] = kInvalidIndex;
    mesh.twin.edit()[h] = kInvalidIndex;
  }
  closeWithFan(surface, loop, meanOfOrigins(mesh, loop));
  closeWithFan(surface, beyond, meanOfOrigins(mesh, beyond));
}

void fillWithFan(PreparedSurface& surface, const std::vector<Index>& loop, const Vector3& middle)
{
  assert(loop.size() >= 3);
  for (const Index h : loop)
  {
    surface.mesh.flags.edit()[h] = 0;
  }
  closeWithFan(surface, loop, middle);
}

void removeFace(PreparedSurface& surface, Index f)
{
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    glue(surface.mesh, kInvalidIndex, surface.mesh.twin[h]);
    surface.mesh.twin.edit()[h] = kInvalidIndex;
    surface.mesh.origin.edit()[h] = kInvalidIndex;
  }
}

bool mayCollapse(const Mesh& mesh, Index h)
{
  const Index g = mesh.twin[h];
  const auto dangles = [&mesh](Index e)
  { return mesh.isBoundary(Mesh::next(e)) && mesh.isBoundary(Mesh::previous(e)); };
  if (dangles(h) || (g != kInvalidIndex && dangles(g)))
  {
    return false; // the opposite vertex would lose its last face
  }
  std::vector<Index> ofOrigin = neighboursOf(mesh, h);
  std::vector<Index> ofTarget = neighboursOf(mesh, Mesh::next(h));
  std::sort(ofOrigin.begin(), ofOrigin.end());
  std::sort(ofTarget.begin(), ofTarget.end());
  std::vector<Index> common;
  std::set_intersection(
    ofOrigin.begin(), ofOrigin.end(), ofTarget.begin(), ofTarget.end(), std::back_inserter(common));
  if (common.size() != (g == kInvalidIndex ? 1u : 2u))
  {
    return false;
  }
  const auto onBoundary = [&mesh](Index e)
  {
    bool found = false;
    forEachInFan(
      mesh, e, [&](Index k) { found |= mesh.isBoundary(k) || mesh.isBoundary(Mesh::previous(k)); });
    return found;
  };
  if (g != kInvalidIndex && onBoundary(h) && onBoundary(Mesh::next(h)))
  {
    return false; // would pinch the surface
  }
  // On a tetrahedron both opposite vertices have three neighbours only.
  return g == kInvalidIndex || onBoundary(Mesh::previous(h)) ||
    neighboursOf(mesh, Mesh::previous(h)).size() > 3;
}

void collapseEdge(PreparedSurface& surface, Index h)
{
  Mesh& mesh = surface.mesh;
  const Index kept = mesh.target(h);
  const Index keptPoint = surface.sourcePoints[Mesh::face(h)][Mesh::next(h) % 3];
  forEachInFan(mesh, h,
    [&](Index e)
    {
      mesh.origin.edit()[e] = kept;
      surface.sourcePoints.edit()[Mesh::face(e)][e % 3] = keptPoint;
    });
  const Index g = mesh.twin[h];
  for (const Index side : { h, g })
  {
    if (side == kInvalidIndex)
    {
      continue;
    }
    const Index x = mesh.twin[Mesh::next(side)];
    const Index y = mesh.twin[Mesh::previous(side)];
    const std::uint8_t flags = mesh.flags[Mesh::next(side)] | mesh.flags[Mesh::previous(side)];
    removeFace(surface, Mesh::face(side));
    glue(mesh, x, y);
    for (const Index e : { x, y })
    {
      if (e != kInvalidIndex)
      {
        mesh.flags.edit()[e] = flags;
      }
    }
  }
}

bool mayFlip(const Mesh& mesh, Index h)
{
  const Index g = mesh.twin[h];
  if (g == kInvalidIndex)
  {
    return false;
  }
  const std::vector<Index> neighbours = neighboursOf(mesh, Mesh::previous(h));
  const Index d = mesh.origin[Mesh::previous(g)];
  return d != mesh.origin[Mesh::previous(h)] &&
    std::find(neighbours.begin(), neighbours.end(), d) == neighbours.end();
}

/// before: h a->b, n b->c, p c->a; g b->a, ng a->d, pg d->b. after: h a->d, n d->c, p c->a; g b->c, ng c->d, pg d->b.
void flipEdge(Mesh& mesh, Index h)
{
  const Index n = Mesh::next(h), ng = Mesh::next(mesh.twin[h]);
  const std::uint8_t inner = mesh.flags[h];
  turnDiagonal(mesh, h);
  mesh.flags.edit()[n] = mesh.flags.edit()[ng] = inner;
}

void flipSliver(PreparedSurface& surface, Index h)
{
  Mesh& mesh = surface.mesh; // corners as in flipEdge()
  const Index g = mesh.twin[h];
  const Index n = Mesh::next(h), p = Mesh::previous(h);
  const Index ng = Mesh::next(g), pg = Mesh::previous(g);
  assert(surface.refinedEntry.empty());

  const std::uint8_t feature = mesh.flags[h];
  for (const Index e : { n, p })
  {
    mesh.flags.edit()[e] |= feature;
    if (mesh.twin[e] != kInvalidIndex)
    {
      mesh.flags.edit()[mesh.twin[e]] |= feature;
    }
  }
  auto& pointsF = surface.sourcePoints.edit()[Mesh::face(h)];
  auto& pointsK = surface.sourcePoints.edit()[Mesh::face(g)];
  const Index pointC = pointsF[p % 3];
  const Index pointD = pointsK[pg % 3];

  turnDiagonal(mesh, h);
  pointsF[n % 3] = pointD;
  pointsK[ng % 3] = pointC;
  surface.sourcePolygon.edit()[Mesh::face(h)] = surface.sourcePolygon[Mesh::face(g)];
}

void flipFlat(PreparedSurface& surface, Index h, Index level)
{
  Mesh& mesh = surface.mesh;
  const Index g = mesh.twin[h];
  const Index n = Mesh::next(h), p = Mesh::previous(h);
  const Index ng = Mesh::next(g), pg = Mesh::previous(g);
  const Index pointC = surface.inputPointAt(p), pointD = surface.inputPointAt(pg);
  std::array<FlippedFace, 2> made;
  for (const Index side : { h, g })
  {
    FlippedFace& face = made[side == h ? 0 : 1];
    face.level = level;
    for (const Index e : { side, Mesh::next(side), Mesh::previous(side) })
    {
      face.points[e % 3] = surface.inputPointAt(e);
      face.places[e % 3] = mesh.position[mesh.origin[e]];
    }
    ensureEntry(surface, Mesh::face(side));
  }
  made[0].points[n % 3] = pointD;
  made[0].places[n % 3] = mesh.position[mesh.origin[pg]];
  made[1].points[ng % 3] = pointC;
  made[1].places[ng % 3] = mesh.position[mesh.origin[p]];
  if (surface.flipped.empty())
  {
    surface.flipped.resize(surface.cornerWeights.size());
  }
  FlippedFace* flipped = surface.flipped.edit();
  flipped[surface.refinedEntry[Mesh::face(h)]] = made[0];
  flipped[surface.refinedEntry[Mesh::face(g)]] = made[1];

  flipEdge(mesh, h);
}

} // namespace quadrille
