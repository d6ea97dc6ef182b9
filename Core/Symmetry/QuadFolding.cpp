// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
// The quads of the doubled map as those of the half, their images, and those that are their own: foldQuads.
#include "Base/PlaceText.h"
#include "Prepare/Frame.h"
#include "Quads/QuadTopology.h"
#include "Symmetry/MidLine.h"

#include <algorithm>
#include <array>
#include <cstddef>
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
  QuadFolding(const QuadMesh& extracted, const CopiedMesh& copied, const Isometry& mirror)
    : given_(extracted), copied_(copied), mirror_(mirror),
      twin_(analyzeQuads(extracted.quads, extracted.points.size()).twin),
      image_(extracted.points.size(), kInvalidIndex),
      imageOfQuad_(extracted.quads.size(), kInvalidIndex)
  {
  }

  CopiedQuads run()
  {
    pairAcross();
    spread();
    pairRest();
    const Index lost = unpaired();
    if (crowded_ != kInvalidIndex || lost != kInvalidIndex)
    {
      CopiedQuads result;
      result.status = { StatusCode::NotConverged,
        "ask for more quads: the half in front of the mirror plane is too narrow near " +
          placeText(given_.points[crowded_ != kInvalidIndex ? crowded_ : lost]) +
          " for quads across the plane and their neighbours" };
      return result;
    }
    CopiedQuads result = copyQuads(inFront(), copied_, {}, mirror_);
    addAcross(result);
    addLines(result);
    return result;
  }

private:
  bool isFront(Index p) const { return given_.sourceFace[p] < copied_.partFaces; }
  std::size_t frontCorners(Index q) const
  {
    const std::array<Index, 4>& quad = given_.quads[q];
    return static_cast<std::size_t>(
      std::count_if(quad.begin(), quad.end(), [&](Index p) { return isFront(p); }));
  }

  void pair(Index a, Index b)
  {
    const bool isNew = image_[a] == kInvalidIndex && image_[b] == kInvalidIndex;
    crowded_ = isNew || image_[a] == b ? crowded_ : a;
    image_[a] = b;
    image_[b] = a;
  }

  /// Both ends of a half-edge and of its image, which runs the other way.
  void pairEdges(Index h, Index image)
  {
    pair(given_.origin(h), given_.target(image));
    pair(given_.target(h), given_.origin(image));
  }

  /// The quads beyond two half-edges that are each other's images.
  void goOn(Index h, Index image)
  {
    if (twin_[h] != kInvalidIndex)
    {
      next_.emplace_back(twin_[h], twin_[image]);
    }
  }

  /// The quads across the plane, and the points at their corners.
  void pairAcross()
  {
    for (Index q = 0; q < given_.quads.size(); ++q)
    {
      const std::size_t front = frontCorners(q);
      if (front == 0 || front == 4)
      {
        continue;
      }
      Index h = 4 * q;
      while (
        h < 4 * q + 4 && !(isFront(given_.origin(h)) && isFront(given_.target(h)) && front == 2))
      {
        ++h;
      }
      if (h == 4 * q + 4)
      {
        crowded_ = given_.origin(4 * q);
        continue;
      }
      pairEdges(h, oppositeInQuad(h));
      imageOfQuad_[q] = q;
      goOn(h, oppositeInQuad(h));
    }
  }

  /// From edges of quads in front whose ends have images.
  void spread()
  {
    while (!next_.empty())
    {
      auto [h, image] = next_.back();
      next_.pop_back();
      const Index q = h / 4;
      if (imageOfQuad_[q] != kInvalidIndex)
      {
        continue;
      }
      if (image == kInvalidIndex || imageOfQuad_[image / 4] != kInvalidIndex ||
        !isFront(given_.origin(h)))
      {
        crowded_ = given_.origin(h);
        continue;
      }
      imageOfQuad_[q] = image / 4;
      imageOfQuad_[image / 4] = q;
      pairEdges(oppositeInQuad(h), oppositeInQuad(image));
      for (int i = 1; i < 4; ++i)
      {
        h = nextInQuad(h);
        image = previousInQuad(image);
        goOn(h, image);
      }
    }
  }

  /// Components without a part in the plane: a quad in front and the nearest one that may be its image begin.
  void pairRest()
  {
    for (Index q = 0; q < given_.quads.size() && crowded_ == kInvalidIndex; ++q)
    {
      if (imageOfQuad_[q] != kInvalidIndex || frontCorners(q) != 4)
      {
        continue;
      }
      const Index image = nearestImage(4 * q);
      if (image == kInvalidIndex)
      {
        return;
      }
      pairEdges(4 * q, image);
      next_.emplace_back(4 * q, image);
      spread();
    }
  }

  /// Of quads behind without an image the edge that may be that of an edge in front.
  Index nearestImage(Index front) const
  {
    double nearest = kInfinity;
    Index best = kInvalidIndex;
    for (Index other = 0; other < 4 * given_.quads.size(); ++other)
    {
      if (imageOfQuad_[other / 4] != kInvalidIndex)
      {
        continue;
      }
      double sum = 0;
      Index image = other;
      for (Index k = 0, h = front; k < 4; ++k, h = nextInQuad(h))
      {
        sum +=
          (given_.points[given_.origin(image)] - mirror_.image(given_.points[given_.origin(h)]))
            .squaredNorm();
        image = previousInQuad(image);
      }
      if (sum < nearest && frontCorners(other / 4) == 0)
      {
        nearest = sum;
        best = previousInQuad(other);
      }
    }
    return best;
  }

  Index unpaired() const
  {
    for (Index h = 0; h < 4 * given_.quads.size(); ++h)
    {
      if (image_[given_.origin(h)] == kInvalidIndex || imageOfQuad_[h / 4] == kInvalidIndex)
      {
        return given_.origin(h);
      }
    }
    return kInvalidIndex;
  }

  /// Points and quads in front in their order, without lines. Numbers them, and the images behind in the same order.
  QuadMesh inFront()
  {
    QuadMesh front;
    std::vector<Index> old;
    number_.assign(image_.size(), kInvalidIndex);
    for (Index p = 0; p < image_.size(); ++p)
    {
      if (isFront(p))
      {
        number_[p] = static_cast<Index>(old.size());
        old.push_back(p);
        front.points.push_back(given_.points[p]);
        front.sourceFace.push_back(given_.sourceFace[p]);
        front.sourceWeights.push_back(given_.sourceWeights[p]);
      }
    }
    for (const Index p : old)
    {
      number_[image_[p]] = static_cast<Index>(old.size()) + number_[p];
    }
    for (Index q = 0; q < given_.quads.size(); ++q)
    {
      if (frontCorners(q) == 4)
      {
        take(q, front);
      }
    }
    return front;
  }

  void take(Index q, QuadMesh& quads) const
  {
    std::array<Index, 4> quad = given_.quads[q];
    for (Index& p : quad)
    {
      p = number_[p];
    }
    quads.quads.push_back(quad);
    quads.quadSourceFace.push_back(given_.quadSourceFace[q]);
    quads.quadSourceWeights.push_back(given_.quadSourceWeights[q]);
  }

  void addAcross(CopiedQuads& result) const
  {
    QuadMesh& quads = result.quads;
    for (Index q = 0; q < given_.quads.size(); ++q)
    {
      if (imageOfQuad_[q] == q)
      {
        take(q, quads);
      }
    }
    result.status = {};
    const Index crowded = countEdges(quads);
    if (crowded != kInvalidIndex)
    {
      result.status = { StatusCode::NotConverged,
        "ask for more quads: the half in front of the mirror plane is two quads wide from plane "
        "to plane near " +
          placeText(quads.points[crowded]) + ", so that the quads across it would be the same" };
    }
  }

  void addLines(CopiedQuads& result) const
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
          3 * copied_.partFaces + reversedEdge(line.halfEdge), line.boundary });
      }
    }
    result.quads.lines.insert(result.quads.lines.end(), images.begin(), images.end());
  }

  const QuadMesh& given_;
  const CopiedMesh& copied_;
  const Isometry& mirror_;
  std::vector<Index> twin_;                   ///< per half-edge of the quads
  std::vector<Index> image_, imageOfQuad_;    ///< per point, per quad
  std::vector<std::pair<Index, Index>> next_; ///< edges of quads in front, and their images
  std::vector<Index> number_;                 ///< of points
  Index crowded_ = kInvalidIndex;             ///< a point with two images
};

} // namespace

CopiedQuads foldQuads(const QuadMesh& extracted, const CopiedMesh& copied, const Isometry& mirror)
{
  return QuadFolding(extracted, copied, mirror).run();
}

} // namespace quadrille
