// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Assembly/SheetJoints.h"

#include "Assembly/JointChains.h"
#include "Assembly/JointStrips.h"
#include "Assembly/SheetBorders.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Quads/QuadMoves.h"
#include "Quads/QuadShape.h"
#include "Quads/QuadSmoothing.h"
#include "Quads/QuadUntangling.h"
#include "Quads/SurfaceWalk.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

namespace quadrille
{

namespace
{

class SheetMeeting
{
public:
  SheetMeeting(RemeshResult& result, const JointSheets& sheets,
    const std::vector<Vector3>& jointPoints, int smoothingSteps, int threads)
    : result_(result), mesh_(result.surface.mesh), quads_(result.quads), sheets_(sheets),
      jointPoints_(jointPoints), smoothingSteps_(smoothingSteps), threads_(threads),
      borders_(result, sheets), chains_(result, sheets, jointPoints, borders_, threads, met_),
      strips_(result, sheets, borders_, chains_, threads, met_), segments_(chains_.segments()),
      loops_(chains_.loops())
  {
  }

  MetSheets meet()
  {
    chains_.find();
    if (met_.status.ok())
    {
      chains_.chooseNumbers();
    }
    strips_.fillSheets();
    if (met_.status.ok())
    {
      placePoints();
      smooth();
    }
    moveBack();
    return std::move(met_);
  }

private:
  //----------------------------------------------------------------------------
  // Places

  Vector3 placeAt(const JointSegment& segment, double arc) const
  {
    const auto next = std::upper_bound(segment.arc.begin() + 1, segment.arc.end() - 1, arc);
    const auto i = static_cast<std::size_t>(next - segment.arc.begin());
    const double length = segment.arc[i] - segment.arc[i - 1];
    const double t = length > 0 ? std::clamp((arc - segment.arc[i - 1]) / length, 0.0, 1.0) : 0.0;
    const Vector3& from = jointPoints_[segment.points[i - 1]];
    const Vector3& to = jointPoints_[segment.points[i]];
    return t == 1 ? to : Vector3(from + t * (to - from));
  }

  void placePoints()
  {
    met_.same.resize(quads_.points.size());
    for (Index p = 0; p < met_.same.size(); ++p)
    {
      met_.same[p] = p;
    }
    for (JointSegment& segment : segments_)
    {
      for (std::size_t i = 0; i <= segment.edges; ++i)
      {
        segment.stops.push_back(
          segment.arc.back() * static_cast<double>(i) / static_cast<double>(segment.edges));
      }
    }
    std::map<Index, std::vector<Index>> atNode; // points of the quads
    std::map<std::pair<Index, std::size_t>, std::vector<Index>> atStop;
    target_.assign(quads_.points.size(), kInvalidIndex);
    for (const SheetLoop& loop : loops_)
    {
      for (const SheetChain& chain : loop.chains)
      {
        if (chain.segment == kInvalidIndex)
        {
          continue;
        }
        const JointSegment& segment = segments_[chain.segment];
        for (std::size_t i = 0; i < chain.points.size(); ++i)
        {
          const std::size_t stop = chain.isForward ? i : segment.edges - i;
          const bool isNode = stop == 0 || stop == segment.edges;
          const Index p = chain.points[i];
          const Index node = stop == 0 ? segment.points.front() : segment.points.back();
          (isNode ? atNode[node] : atStop[{ chain.segment, stop }]).push_back(p);
          target_[p] = static_cast<Index>(places_.size());
          places_.push_back(isNode ? jointPoints_[node] : placeAt(segment, segment.stops[stop]));
          borders_.move(p, loop.sheet, places_.back() + sheets_.offset[loop.sheet]);
        }
      }
    }
    const auto makeSame = [this](const std::vector<Index>& points)
    {
      const Index lowest = *std::min_element(points.begin(), points.end());
      for (const Index p : points)
      {
        met_.same[p] = lowest;
      }
    };
    for (const auto& [node, points] : atNode)
    {
      makeSame(points);
    }
    for (const auto& [stop, points] : atStop)
    {
      makeSame(points);
    }
  }

  /// Points of joints stay: the boundary there has no lines meanwhile, as a trimmed one.
  void smooth()
  {
    constexpr int leastSteps = 40;
    std::vector<QuadLine> joints, others;
    for (QuadLine& line : quads_.lines)
    {
      const bool isOnJoint =
        line.boundary && target_[line.a] != kInvalidIndex && target_[line.b] != kInvalidIndex;
      if (line.halfEdge == kInvalidIndex)
      {
        line.halfEdge = borders_
                          .nearestOnLoops(borders_.sheetOfFace(quads_.sourceFace[line.a]),
                            0.5 * (quads_.points[line.a] + quads_.points[line.b]))
                          .at.h;
      }
      (isOnJoint ? joints : others).push_back(line);
    }
    quads_.lines = others;
    SmoothingOptions options;
    options.threads = threads_;
    for (const ValenceRequest& request : result_.surface.valenceRequests)
    {
      if (!request.mayDrift)
      {
        options.fixedVertices.push_back(request.vertex);
      }
    }
    if (met_.strips > 0)
    {
      evenOut(options.fixedVertices);
    }
    if (met_.strips > 0 || smoothingSteps_ > 0)
    {
      options.steps = met_.strips > 0 ? std::max(leastSteps, smoothingSteps_) : smoothingSteps_;
      options.goodShape = met_.strips > 0 ? 1 : options.goodShape;
      smoothQuads(mesh_, quads_, options);
    }
    UntanglingOptions untangling;
    untangling.fixedVertices = options.fixedVertices;
    untangling.threads = threads_;
    met_.inverted = untangleQuads(mesh_, quads_, untangling);
    quads_.lines.insert(quads_.lines.end(), joints.begin(), joints.end());
  }

  /// Points of sheets with strips go to the middle of their neighbours, those of features and of boundaries without
  /// joint along their curve, whatever this does to single quads: strips have made some narrow and others wide.
  void evenOut(const std::vector<Index>& fixedVertices)
  {
    constexpr int sweeps = 50;
    QuadMoves moves(mesh_, quads_, fixedVertices);
    std::vector<std::vector<Index>> neighbours(quads_.points.size());
    for (const std::array<Index, 4>& quad : quads_.quads)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        const Index p = quad[i];
        if (moves.freedom(p) == QuadMoves::Freedom::Surface &&
          strips_.withStrips().count(sheetOfPoint(p)) != 0)
        {
          neighbours[p].push_back(quad[(i + 1) % 4]);
          neighbours[p].push_back(quad[(i + 3) % 4]);
        }
      }
    }
    for (const QuadLine& line : quads_.lines)
    {
      for (const auto& [p, other] :
        { std::make_pair(line.a, line.b), std::make_pair(line.b, line.a) })
      {
        if (moves.freedom(p) == QuadMoves::Freedom::Curve &&
          strips_.withStrips().count(sheetOfPoint(p)) != 0)
        {
          neighbours[p].push_back(other);
        }
      }
    }
    for (int sweep = 0; sweep < sweeps; ++sweep)
    {
      poll();
      for (Index p = 0; p < neighbours.size(); ++p)
      {
        Vector3 sum = Vector3::Zero();
        for (const Index other : neighbours[p])
        {
          sum += quads_.points[other] - quads_.points[p];
        }
        const auto there = neighbours[p].empty()
          ? std::nullopt
          : moves.target(p, sum / static_cast<double>(neighbours[p].size()));
        if (there)
        {
          moves.move(p, *there, positionOf(mesh_, *there));
        }
      }
    }
  }

  Index sheetOfPoint(Index p) const { return borders_.sheetOfFace(quads_.sourceFace[p]); }

  //----------------------------------------------------------------------------
  // Back to where the sheets were

  void moveBack()
  {
    std::vector<Index> sheetOf(mesh_.vertexCount(), 0);
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      sheetOf[mesh_.origin[h]] = borders_.sheetOfFace(Mesh::face(h));
    }
    for (Index p = 0; p < quads_.points.size(); ++p)
    {
      const bool isPlaced = p < target_.size() && target_[p] != kInvalidIndex;
      quads_.points[p] = isPlaced
        ? places_[target_[p]]
        : Vector3(quads_.points[p] - sheets_.offset[borders_.sheetOfFace(quads_.sourceFace[p])]);
    }
    for (Index v = 0; v < mesh_.vertexCount(); ++v)
    {
      mesh_.position.edit()[v] -= sheets_.offset[sheetOf[v]];
    }
    for (SmallDetail& detail : result_.details)
    {
      detail.place = sheets_.movedBack(detail.place);
    }
    for (GivenUpCurve& curve : result_.givenUpFeatures)
    {
      curve.place = sheets_.movedBack(curve.place);
    }
    result_.framePositions.clear();
  }

  RemeshResult& result_;
  Mesh& mesh_;
  QuadMesh& quads_;
  const JointSheets& sheets_;
  const std::vector<Vector3>& jointPoints_;
  int smoothingSteps_;
  int threads_;
  MetSheets met_;
  SheetBorders borders_;
  JointChains chains_;
  JointStrips strips_;
  std::vector<JointSegment>& segments_;
  const std::vector<SheetLoop>& loops_;
  std::vector<Index> target_; ///< per point of the quads: its place on a joint, or kInvalidIndex
  std::vector<Vector3> places_;
};

} // namespace

MetSheets meetAtJoints(RemeshResult& result, const JointSheets& sheets,
  const std::vector<Vector3>& jointPoints, int smoothingSteps, int threads)
{
  const TryScope tries;
  MetSheets met = SheetMeeting(result, sheets, jointPoints, smoothingSteps, threads).meet();
  result.tries.add(tries.counts());
  return met;
}

} // namespace quadrille
