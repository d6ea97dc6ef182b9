// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/Copies.h"

#include "Base/PlaceText.h"
#include "Mesh/Topology.h"
#include "Prepare/Frame.h"
#include "Quads/QuadTopology.h"
#include "Symmetry/CutBorder.h"

#include <algorithm>
#include <array>
#include <utility>

namespace quadrille
{

namespace
{

/// Numbers of the points of all images: those of the part, then those that each image after it adds.
class ImageNumbers
{
public:
  ImageNumbers(std::size_t points, const std::vector<SamePoints>& pairs, int order)
    : order_(order), firstOf_(points, kInvalidIndex), place_(points, 0), inImages_(points, 0)
  {
    for (const SamePoints& pair : pairs)
    {
      firstOf_[pair.second] = pair.first;
    }
    for (Index p = 0; p < points; ++p)
    {
      if (isOwn(p) || isFixed(p))
      {
        place_[p] = static_cast<Index>(base_++);
        inImages_[p] = static_cast<Index>(added_);
        added_ += isFixed(p) ? 0 : 1;
      }
    }
  }

  /// Whether it is its own image.
  bool isFixed(Index p) const { return firstOf_[p] == p; }
  std::size_t ofPart() const { return base_; }
  std::size_t count() const { return base_ + static_cast<std::size_t>(order_ - 1) * added_; }
  /// Whether the image by so many steps is the first one with this number.
  bool isNew(int step, Index p) const { return isOwn(p) || (isFixed(p) && step == 0); }

  Index operator()(int step, Index p) const
  {
    if (!isOwn(p) && !isFixed(p))
    {
      p = firstOf_[p];
      ++step;
    }
    step %= order_;
    if (step == 0 || isFixed(p))
    {
      return place_[p];
    }
    return static_cast<Index>(base_ + static_cast<std::size_t>(step - 1) * added_ + inImages_[p]);
  }

private:
  /// Whether it has a number of its own in each image.
  bool isOwn(Index p) const { return firstOf_[p] == kInvalidIndex; }

  int order_;
  std::vector<Index> firstOf_; ///< the one whose image by one step it is
  std::vector<Index> place_, inImages_;
  std::size_t base_ = 0, added_ = 0;
};

/// Where the images of a part's points lie.
Vector3 imagePlace(const Isometry& isometry, const Vector3& p, int step, bool isFixed)
{
  return isFixed && isometry.isReflection ? isometry.foot(p) : isometry.image(p, step);
}

/// All points that are their own images.
std::vector<SamePoints> fixedPoints(const std::vector<std::uint8_t>& isFixed)
{
  std::vector<SamePoints> pairs;
  for (Index p = 0; p < isFixed.size(); ++p)
  {
    if (isFixed[p] != 0)
    {
      pairs.push_back({ p, p });
    }
  }
  return pairs;
}

} // namespace

CopiedMesh copyMesh(
  const Mesh& part, const std::vector<int>& turns, const Isometry& isometry, double tolerance)
{
  CopiedMesh copied;
  copied.partVertices = part.vertexCount();
  copied.partFaces = part.faceCount();
  copied.isGlued = isometry.isReflection ? edgesInPlane(part, isometry.plane(), tolerance)
                                         : std::vector<std::uint8_t>(part.halfEdgeCount(), 0);
  const std::vector<std::uint8_t> inPlane =
    endsWhere(part, [&](Index h) { return copied.isGlued[h] != 0; });
  const ImageNumbers numbers(inPlane.size(), fixedPoints(inPlane), isometry.order);

  Mesh& mesh = copied.mesh;
  const Index count = part.halfEdgeCount();
  const auto images = static_cast<std::size_t>(isometry.order);
  mesh.position.resize(numbers.count());
  mesh.sizing.resize(part.sizing.empty() ? 0 : numbers.count());
  copied.image.resize(numbers.count());
  copied.turns.resize(numbers.count());
  mesh.origin.resize(images * count);
  mesh.twin.resize(mesh.origin.size());
  mesh.flags.resize(mesh.origin.size());
  for (int step = 0; step < isometry.order; ++step)
  {
    for (Index v = 0; v < part.vertexCount(); ++v)
    {
      const Index image = numbers(step, v);
      if (numbers.isNew(step, v))
      {
        mesh.position.edit()[image] =
          imagePlace(isometry, part.position[v], step, numbers.isFixed(v));
        copied.image[image] = numbers(step + 1, v);
        copied.turns[image] = (numbers.isFixed(v) ? isometry.order : 1) * turns[v];
        if (!part.sizing.empty())
        {
          mesh.sizing.edit()[image] = part.sizing[v];
        }
      }
    }
    const Index first = static_cast<Index>(step) * count;
    const bool isReversed = isometry.reverses(step);
    const auto edgeOf = [&](Index h) { return first + (isReversed ? reversedEdge(h) : h); };
    for (Index h = 0; h < count; ++h)
    {
      const Index twin = part.twin[h];
      const Index across = twin == kInvalidIndex ? twin : edgeOf(twin);
      const Index glued = isReversed ? h : count + reversedEdge(h);
      mesh.origin.edit()[first + (isReversed ? reversedCorner(h) : h)] =
        numbers(step, part.origin[h]);
      mesh.twin.edit()[edgeOf(h)] = copied.isGlued[h] != 0 ? glued : across;
      mesh.flags.edit()[edgeOf(h)] = part.flags[h];
    }
  }
  return copied;
}

std::vector<FixedVec2> copyMap(
  const CopiedMesh& copied, const Isometry& isometry, std::vector<FixedVec2> uv)
{
  const std::size_t count = 3 * std::size_t{ copied.partFaces };
  uv.resize(static_cast<std::size_t>(isometry.order) * count);
  for (int step = 1; step < isometry.order; ++step)
  {
    const std::size_t first = static_cast<std::size_t>(step) * count;
    for (Index h = 0; h < count; ++h)
    {
      const FixedVec2 p = uv[h];
      if (isometry.reverses(step))
      {
        uv[first + reversedCorner(h)] = { p.v, p.u };
      }
      else
      {
        uv[first + h] = p;
      }
    }
  }
  return uv;
}

Index countEdges(QuadMesh& quads)
{
  QuadTopology topology = analyzeQuads(quads.quads, quads.points.size());
  quads.valence = std::move(topology.valence);
  quads.onBoundary = std::move(topology.onBoundary);
  return topology.nonManifoldEdges > 0 ? topology.defectPoints.back() : kInvalidIndex;
}

CutQuads cutInPlane(const QuadMesh& part, const CopiedMesh& copied)
{
  CutQuads cut;
  std::vector<std::uint8_t> inPlane(part.points.size(), 0);
  for (const QuadLine& line : part.lines)
  {
    const bool isGlued = line.boundary && copied.isGlued[line.halfEdge] != 0;
    cut.lines.push_back(isGlued ? CutQuads::First : CutQuads::Own);
    if (isGlued)
    {
      inPlane[line.a] = inPlane[line.b] = 1;
    }
  }
  cut.pairs = fixedPoints(inPlane);
  return cut;
}

CutQuads cutAlongSeams(const QuadMesh& part, std::vector<SamePoints> pairs)
{
  std::vector<std::uint8_t> isFirst(part.points.size(), 0), isSecond(part.points.size(), 0);
  for (const SamePoints& pair : pairs)
  {
    isFirst[pair.first] = isSecond[pair.second] = 1;
  }
  CutQuads cut{ std::move(pairs), {} };
  for (const QuadLine& line : part.lines)
  {
    const auto lies = [&](const std::vector<std::uint8_t>& side)
    { return line.boundary && side[line.a] != 0 && side[line.b] != 0; };
    cut.lines.push_back(lies(isFirst) ? CutQuads::First
        : lies(isSecond)              ? CutQuads::Second
                                      : CutQuads::Own);
  }
  return cut;
}

CopiedQuads copyQuads(
  const QuadMesh& part, const CopiedMesh& copied, const CutQuads& cut, const Isometry& isometry)
{
  const ImageNumbers numbers(part.points.size(), cut.pairs, isometry.order);
  CopiedQuads result;
  result.partPoints = static_cast<Index>(numbers.ofPart());
  result.partQuads = static_cast<Index>(part.quads.size());
  result.image.resize(numbers.count());
  QuadMesh& quads = result.quads;
  quads.points.resize(numbers.count());
  quads.sourceFace.resize(numbers.count());
  quads.sourceWeights.resize(numbers.count());
  for (int step = 0; step < isometry.order; ++step)
  {
    const bool isReversed = isometry.reverses(step);
    const Index firstFace = static_cast<Index>(step) * copied.partFaces;
    const auto inImage = [&](const std::array<double, 3>& weights) {
      return isReversed ? std::array<double, 3>{ weights[0], weights[2], weights[1] } : weights;
    };
    for (Index p = 0; p < part.points.size(); ++p)
    {
      if (numbers.isNew(step, p))
      {
        const Index id = numbers(step, p);
        quads.points[id] = imagePlace(isometry, part.points[p], step, numbers.isFixed(p));
        quads.sourceFace[id] = firstFace + part.sourceFace[p];
        quads.sourceWeights[id] = inImage(part.sourceWeights[p]);
        result.image[id] = numbers(step + 1, p);
      }
    }
    for (std::size_t q = 0; q < part.quads.size(); ++q)
    {
      std::array<Index, 4> quad{};
      std::transform(part.quads[q].begin(), part.quads[q].end(), quad.begin(),
        [&](Index p) { return numbers(step, p); });
      if (isReversed)
      {
        std::swap(quad[1], quad[3]);
      }
      quads.quads.push_back(quad);
      quads.quadSourceFace.push_back(firstFace + part.quadSourceFace[q]);
      quads.quadSourceWeights.push_back(inImage(part.quadSourceWeights[q]));
    }
    for (std::size_t l = 0; l < part.lines.size(); ++l)
    {
      const QuadLine& line = part.lines[l];
      const bool isCut = cut.lines[l] != CutQuads::Own;
      const bool isFeature =
        cut.lines[l] == CutQuads::First && copied.mesh.isFeature(line.halfEdge);
      const bool isThere = step > 0 && numbers.isFixed(line.a) && numbers.isFixed(line.b);
      if (isCut && (!isFeature || isThere))
      {
        continue;
      }
      QuadLine image{ numbers(step, line.a), numbers(step, line.b),
        3 * firstFace + (isReversed ? reversedEdge(line.halfEdge) : line.halfEdge),
        line.boundary && !isCut };
      if (isReversed)
      {
        std::swap(image.a, image.b);
      }
      quads.lines.push_back(image);
    }
  }
  const Index crowded = countEdges(quads);
  if (crowded != kInvalidIndex)
  {
    const std::string where = placeText(quads.points[crowded]);
    result.status = { StatusCode::NotConverged,
      isometry.isReflection ? "ask for more quads: the half in front of the mirror plane is one "
                              "quad wide from plane to plane near " +
          where + ", so that with its image it would be two quads round"
                            : "ask for more quads: a wedge is one quad wide near " + where +
          ", so that with its images it would be two quads round" };
  }
  return result;
}

} // namespace quadrille
