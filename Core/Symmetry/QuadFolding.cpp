// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
// The quads of the doubled map as those of the half, their images, and those that are their own: foldQuads.
#include "Base/PlaceText.h"
#include "Prepare/Frame.h"
#include "Symmetry/MirrorMidLine.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace quadrille
{

namespace
{

/// Quads of the doubled map sorted by sides.
class QuadFolding
{
public:
  QuadFolding(const QuadMesh& extracted, const DoubledMesh& doubled, const MirrorPlane& plane)
    : given_(extracted), doubled_(doubled), plane_(plane),
      image_(extracted.points.size(), kInvalidIndex),
      imageOfQuad_(extracted.quads.size(), kInvalidIndex)
  {
  }

  DoubledQuads run()
  {
    DoubledQuads result;
    findEdges();
    pairAcross();
    spread();
    pairRest();
    const Index lost = unpaired();
    if (crowded_ != kInvalidIndex || lost != kInvalidIndex)
    {
      result.status = { StatusCode::NotConverged,
        "the half in front of the mirror plane is too narrow near " +
          placeText(given_.points[crowded_ != kInvalidIndex ? crowded_ : lost]) +
          " for quads across the plane and their neighbours: it needs more quads" };
      return result;
    }
    number(result);
    takePoints(result);
    takeQuads(result);
    takeLines(result);
    return result;
  }

private:
  bool isFront(Index p) const { return given_.sourceFace[p] < doubled_.halfFaces; }
  std::size_t frontCorners(const std::array<Index, 4>& quad) const
  {
    return static_cast<std::size_t>(
      std::count_if(quad.begin(), quad.end(), [&](Index p) { return isFront(p); }));
  }

  void findEdges()
  {
    for (Index q = 0; q < given_.quads.size(); ++q)
    {
      const std::array<Index, 4>& quad = given_.quads[q];
      for (Index i = 0; i < 4; ++i)
      {
        edges_.push_back({ { quad[i], quad[(i + 1) % 4] }, 4 * q + i });
      }
    }
    std::sort(edges_.begin(), edges_.end());
  }

  /// 4 q + i: the edge of quad q from its corner i on.
  Index edge(Index from, Index to) const
  {
    const auto found =
      std::lower_bound(edges_.begin(), edges_.end(), std::pair(std::pair(from, to), Index{ 0 }));
    return found != edges_.end() && found->first == std::pair(from, to) ? found->second
                                                                        : kInvalidIndex;
  }

  Index corner(Index q, Index i) const { return given_.quads[q][i % 4]; }

  void pair(Index a, Index b)
  {
    const bool isNew = image_[a] == kInvalidIndex && image_[b] == kInvalidIndex;
    crowded_ = isNew || image_[a] == b ? crowded_ : a;
    image_[a] = b;
    image_[b] = a;
  }

  /// The quads across the plane, and the points at their corners.
  void pairAcross()
  {
    for (Index q = 0; q < given_.quads.size(); ++q)
    {
      const std::array<Index, 4>& quad = given_.quads[q];
      const std::size_t front = frontCorners(quad);
      if (front == 0 || front == 4)
      {
        continue;
      }
      Index i = 0;
      while (i < 4 && !(isFront(quad[i]) && isFront(corner(q, i + 1)) && front == 2))
      {
        ++i;
      }
      if (i == 4)
      {
        crowded_ = quad[0];
        continue;
      }
      pair(quad[i], corner(q, i + 3));
      pair(corner(q, i + 1), corner(q, i + 2));
      imageOfQuad_[q] = q;
      const Index inside = edge(corner(q, i + 1), quad[i]);
      if (inside != kInvalidIndex)
      {
        next_.push_back(inside);
      }
    }
  }

  /// From edges of quads in front whose ends have images.
  void spread()
  {
    while (!next_.empty())
    {
      const Index at = next_.back();
      next_.pop_back();
      const Index q = at / 4;
      if (imageOfQuad_[q] != kInvalidIndex)
      {
        continue;
      }
      const Index a = corner(q, at), b = corner(q, at + 1);
      const Index other = edge(image_[b], image_[a]);
      if (other == kInvalidIndex || imageOfQuad_[other / 4] != kInvalidIndex || !isFront(a))
      {
        crowded_ = a;
        continue;
      }
      imageOfQuad_[q] = other / 4;
      imageOfQuad_[other / 4] = q;
      pair(corner(q, at + 3), corner(other / 4, other + 2));
      pair(corner(q, at + 2), corner(other / 4, other + 3));
      for (Index i = 1; i < 4; ++i)
      {
        const Index across = edge(corner(q, at + i + 1), corner(q, at + i));
        if (across != kInvalidIndex)
        {
          next_.push_back(across);
        }
      }
    }
  }

  /// Components without a part in the plane: a quad in front and the nearest one that may be its image begin.
  void pairRest()
  {
    for (Index q = 0; q < given_.quads.size() && crowded_ == kInvalidIndex; ++q)
    {
      if (imageOfQuad_[q] != kInvalidIndex || frontCorners(given_.quads[q]) != 4)
      {
        continue;
      }
      std::array<Vector3, 4> images;
      for (Index i = 0; i < 4; ++i)
      {
        images[i] = plane_.image(given_.points[corner(q, i)]);
      }
      double nearest = std::numeric_limits<double>::infinity();
      Index best = kInvalidIndex;
      for (Index other = 0; other < given_.quads.size(); ++other)
      {
        for (Index i = 0; i < 4 && imageOfQuad_[other] == kInvalidIndex; ++i)
        {
          double sum = 0;
          for (Index k = 0; k < 4; ++k)
          {
            sum += (given_.points[corner(other, i + 4 - k)] - images[k]).squaredNorm();
          }
          if (sum < nearest && frontCorners(given_.quads[other]) == 0)
          {
            nearest = sum;
            best = 4 * other + i;
          }
        }
      }
      if (best == kInvalidIndex)
      {
        return;
      }
      pair(corner(q, 0), corner(best / 4, best));
      pair(corner(q, 1), corner(best / 4, best + 3));
      next_.push_back(4 * q);
      spread();
    }
  }

  Index unpaired() const
  {
    for (const std::array<Index, 4>& quad : given_.quads)
    {
      for (const Index p : quad)
      {
        if (image_[p] == kInvalidIndex)
        {
          return p;
        }
      }
    }
    const auto none = std::find(imageOfQuad_.begin(), imageOfQuad_.end(), kInvalidIndex);
    return none == imageOfQuad_.end()
      ? kInvalidIndex
      : given_.quads[static_cast<std::size_t>(none - imageOfQuad_.begin())][0];
  }

  /// Points in front in their order, then their images in the same.
  void number(DoubledQuads& result)
  {
    number_.assign(image_.size(), kInvalidIndex);
    for (Index p = 0; p < image_.size(); ++p)
    {
      if (isFront(p))
      {
        number_[p] = result.halfPoints++;
        old_.push_back(p);
      }
    }
    for (Index p = 0; p < result.halfPoints; ++p)
    {
      number_[image_[old_[p]]] = result.halfPoints + p;
      result.image.push_back(result.halfPoints + p);
    }
    for (Index p = 0; p < result.halfPoints; ++p)
    {
      result.image.push_back(p);
    }
  }

  void takePoints(DoubledQuads& result) const
  {
    QuadMesh& quads = result.quads;
    for (const Index p : old_)
    {
      quads.points.push_back(given_.points[p]);
      quads.sourceFace.push_back(given_.sourceFace[p]);
      quads.sourceWeights.push_back(given_.sourceWeights[p]);
    }
    for (const Index p : old_)
    {
      quads.points.push_back(plane_.image(given_.points[p]));
      quads.sourceFace.push_back(doubled_.halfFaces + given_.sourceFace[p]);
      quads.sourceWeights.push_back(imageWeights(given_.sourceWeights[p]));
    }
  }

  void takeQuads(DoubledQuads& result) const
  {
    QuadMesh& quads = result.quads;
    const auto take = [&](Index q)
    {
      std::array<Index, 4> quad = given_.quads[q];
      for (Index& p : quad)
      {
        p = number_[p];
      }
      quads.quads.push_back(quad);
      quads.quadSourceFace.push_back(given_.quadSourceFace[q]);
      quads.quadSourceWeights.push_back(given_.quadSourceWeights[q]);
    };
    for (Index q = 0; q < given_.quads.size(); ++q)
    {
      if (frontCorners(given_.quads[q]) == 4)
      {
        take(q);
      }
    }
    result.halfQuads = static_cast<Index>(quads.quads.size());
    for (Index q = 0; q < result.halfQuads; ++q)
    {
      const std::array<Index, 4> quad = quads.quads[q];
      const std::vector<Index>& image = result.image;
      quads.quads.push_back({ image[quad[0]], image[quad[3]], image[quad[2]], image[quad[1]] });
      quads.quadSourceFace.push_back(doubled_.halfFaces + quads.quadSourceFace[q]);
      quads.quadSourceWeights.push_back(imageWeights(quads.quadSourceWeights[q]));
    }
    for (Index q = 0; q < given_.quads.size(); ++q)
    {
      if (imageOfQuad_[q] == q)
      {
        take(q);
      }
    }
    const Index crowded = countEdges(quads);
    if (crowded != kInvalidIndex)
    {
      result.status = { StatusCode::NotConverged,
        "the half in front of the mirror plane is two quads wide from plane to plane near " +
          placeText(quads.points[crowded]) +
          ", so that the quads across it would be the same: it needs more quads" };
    }
  }

  void takeLines(DoubledQuads& result) const
  {
    std::vector<QuadLine> images;
    for (QuadLine line : given_.lines)
    {
      const bool front = isFront(line.a), other = isFront(line.b);
      if (!front && !other)
      {
        continue;
      }
      line.a = number_[line.a];
      line.b = number_[line.b];
      result.quads.lines.push_back(line);
      if (front && other)
      {
        images.push_back({ result.image[line.b], result.image[line.a],
          3 * doubled_.halfFaces + reversedEdge(line.halfEdge), line.boundary });
      }
    }
    result.quads.lines.insert(result.quads.lines.end(), images.begin(), images.end());
  }

  static std::array<double, 3> imageWeights(const std::array<double, 3>& weights)
  {
    return { weights[0], weights[2], weights[1] };
  }

  const QuadMesh& given_;
  const DoubledMesh& doubled_;
  const MirrorPlane& plane_;
  std::vector<std::pair<std::pair<Index, Index>, Index>> edges_;
  std::vector<Index> image_, imageOfQuad_; ///< per point, per quad
  std::vector<Index> next_;                ///< edges of quads in front
  std::vector<Index> number_, old_;        ///< of points
  Index crowded_ = kInvalidIndex;          ///< a point with two images
};

} // namespace

DoubledQuads foldQuads(
  const QuadMesh& extracted, const DoubledMesh& doubled, const MirrorPlane& plane)
{
  return QuadFolding(extracted, doubled, plane).run();
}

} // namespace quadrille
