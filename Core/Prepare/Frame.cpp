// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/Frame.h"

#include "Base/LargeArray.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Mesh/PointSets.h"
#include "Prepare/Repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace quadrille
{

namespace
{

/// Steps of the grid in the box's longest side, as a power of two: four times as fine as single precision.
constexpr int kGridBits = 26;
/// Where one edge in kFineShare is shorter than 2^kStepsOfEdge steps, the grid is finer, up to kMostGridBits.
constexpr int kStepsOfEdge = 10;
constexpr int kMostGridBits = 44;
constexpr std::size_t kFineShare = 64;
/// Rounding goes up from this part of a step on, away from zero. Not one half, nor any simple fraction, as coordinates
/// that people or programs write sit on such, and there the last bit would decide.
constexpr double kUp = 0.618;

/// Takes differences of coordinates of some magnitude back to the binary fractions that they were before a shift
/// rounded them: of a surface in single precision, say, that was moved in double precision.
class Snap
{
public:
  explicit Snap(double magnitude)
    : noise_(std::ldexp(magnitude, -51)), step_(std::ldexp(1.0, std::ilogb(magnitude) - 44))
  {
  }
  double operator()(double x) const
  {
    const double near = std::round(x / step_) * step_;
    return std::abs(x - near) <= noise_ ? near : x;
  }

private:
  double noise_; ///< of a coordinate and of the centre together
  double step_;  ///< some hundred times as much, so that little snaps by chance
};

/// Length of the first sampled edges of polygons by powers of two; how fine the grid has to be.
int gridBits(const SurfaceInput& input, double unit)
{
  // A grid for shorter edges would be finer than the finest one.
  const int lowest = kStepsOfEdge - kMostGridBits;
  constexpr std::size_t kEdgeSamples = std::size_t{ 1 } << 20;
  std::array<std::size_t, 64> count{};
  const std::size_t corners = input.polygonPoints.size();
  const std::size_t stride = std::max<std::size_t>(1, corners / kEdgeSamples);
  std::size_t sum = 0;
  for (std::size_t i = 0; i + 1 < corners; i += stride)
  {
    const double length =
      (input.points[input.polygonPoints[i]] - input.points[input.polygonPoints[i + 1]]).norm() /
      unit;
    if (length > 0)
    {
      ++count[static_cast<std::size_t>(std::clamp(std::ilogb(length), lowest, -1) - lowest)];
      ++sum;
    }
  }
  std::size_t below = 0;
  int exponent = lowest;
  while (exponent < -1 &&
    (below += count[static_cast<std::size_t>(exponent - lowest)]) * kFineShare <= sum)
  {
    ++exponent;
  }
  return std::clamp(kStepsOfEdge - exponent, kGridBits, kMostGridBits);
}

double roundToGrid(double x)
{
  return std::copysign(std::floor(std::abs(x) + (1 - kUp)), x);
}

/// Whether all coordinates could have come as single precision.
bool areFloats(const std::vector<Vector3>& points, int threads)
{
  return firstRefused(points.size(), kLightChunk, threads,
           [&](std::size_t i)
           { return points[i].cast<float>().cast<double>() == points[i]; }) == points.size();
}

/// The points in steps of the grid round the centre, whole numbers.
void toGrid(FramedInput& framed, const Snap& snap, double steps, int threads)
{
  reserveWithRoom(framed.input.points, framed.points.size(), threads);
  growLarge(framed.input.points, framed.points.size());
  Vector3* placed = framed.input.points.edit();
  parallelForEach(framed.points.size(), kLightChunk, threads,
    [&](std::size_t i)
    {
      for (int k = 0; k < 3; ++k)
      {
        const double x = snap(framed.points[i][k] - framed.frame.centre[k]);
        placed[i][k] = roundToGrid(x / framed.frame.unit * steps);
      }
    });
}

/// Of each axis: the side on which the first point lies that is half way or more to the end.
Vector3 signsOf(const std::vector<Vector3>& points, const UsedPoints& used, const PointBox& box)
{
  Vector3 sign = Vector3::Zero();
  for (std::size_t i = 0; i < points.size() && (sign.array() == 0).any(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      const double x = points[i][k];
      if (sign[k] == 0 && used.has(i) && std::abs(x) * 4 >= box.high[k] - box.low[k])
      {
        sign[k] = x < 0 ? -1 : 1;
      }
    }
  }
  return (sign.array() == 0).select(Vector3::Ones(), sign);
}

/// What is asked for at places and in directions.
void requestsToFrame(FramedInput& framed)
{
  const Frame& frame = framed.frame;
  for (Vector3& direction : framed.input.guideDirections)
  {
    direction = frame.mirrored(direction);
  }
  for (KnownCurvature& known : framed.input.curvatures)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      known.atCorner[k] = static_cast<float>(frame.unit * known.atCorner[k]);
      known.alongSide[k] = static_cast<float>(frame.unit * known.alongSide[k]);
    }
  }
  framed.input.drawn.visit([&](Vector3& p) { p = frame.fromUser(p); },
    [&](double& length) { length = frame.lengthOf(length); });
  visitPaths(
    framed.input, [&](Vector3& p) { p = frame.fromUser(p); },
    [&](Vector3& direction) { direction = frame.mirrored(direction); });
  for (Vector3& place : framed.input.withoutMap)
  {
    place = frame.fromUser(place);
  }
}

/// Runs the first polygon, begun at its lowest point, against ascending ids?
bool firstPolygonDescends(const SurfaceInput& input)
{
  for (std::size_t p = 0; p + 1 < input.polygonOffsets.size(); ++p)
  {
    const auto begin = input.polygonPoints.begin() + input.polygonOffsets[p];
    const auto end = input.polygonPoints.begin() + input.polygonOffsets[p + 1];
    const auto lowest = std::min_element(begin, end);
    if (end - begin >= 3)
    {
      const Index next = lowest + 1 == end ? *begin : *(lowest + 1);
      const Index previous = lowest == begin ? *(end - 1) : *(lowest - 1);
      if (next != previous)
      {
        return next > previous;
      }
    }
  }
  return false;
}

/// Do faces look inwards, as far as that can be told?
bool looksInwards(const SurfaceInput& input, int threads)
{
  const std::size_t polygons = input.polygonOffsets.size() - 1;
  const auto parts = parallelParts<std::array<double, 2>>(polygons, kLightChunk, threads,
    [&](std::size_t begin, std::size_t end, std::array<double, 2>& part)
    {
      for (std::size_t p = begin; p < end; ++p)
      {
        const Index* ids = input.polygonPoints.data() + input.polygonOffsets[p];
        const std::size_t corners = input.polygonOffsets[p + 1] - input.polygonOffsets[p];
        for (std::size_t i = 2; i < corners; ++i)
        {
          const double volume =
            input.points[ids[0]].dot(input.points[ids[i - 1]].cross(input.points[ids[i]]));
          part[0] += volume;
          part[1] += std::abs(volume);
        }
      }
    });
  double volume = 0;
  double terms = 0;
  for (const std::array<double, 2>& part : parts)
  {
    volume += part[0];
    terms += part[1];
  }
  return std::abs(volume) > kRoundingOfSingle * terms ? volume < 0 : firstPolygonDescends(input);
}

} // namespace

double roundedLength(double length)
{
  int exponent = 0;
  const double part = std::frexp(length, &exponent);
  return std::ldexp(std::round(std::ldexp(part, 40)), exponent - 40);
}

double Frame::lengthOf(double userLength) const
{
  return roundedLength(userLength / unit);
}

void enterFrame(std::vector<HeldVertex>& held, const Frame& frame)
{
  for (HeldVertex& vertex : held)
  {
    vertex.place = frame.fromUser(vertex.place);
    for (HeldSector& sector : vertex.sectors)
    {
      sector.middle = frame.mirrored(sector.middle);
    }
    if (frame.reversed)
    {
      std::reverse(vertex.sectors.begin(), vertex.sectors.end());
    }
  }
}

void leaveFrame(std::vector<SectorRequest>& sectors, const Frame& frame)
{
  for (SectorRequest& request : sectors)
  {
    for (HeldSector& sector : request.sectors)
    {
      sector.middle = frame.mirrored(sector.middle);
    }
    if (frame.reversed)
    {
      std::reverse(request.sectors.begin(), request.sectors.end());
    }
  }
}

FramedInput enterFrame(SurfaceInput input, int threads)
{
  checkInput(input, threads);
  FramedInput framed;
  const UsedPoints used(input.polygonPoints, input.points.size(), threads);
  const auto isUsed = [&](std::size_t i) { return used.has(i); };
  const PointBox box = boxOfPoints(input.points, threads, isUsed);
  const double magnitude = std::max(box.high.cwiseAbs().maxCoeff(), box.low.cwiseAbs().maxCoeff());
  Frame& frame = framed.frame;
  const Snap snap(magnitude > 0 ? magnitude : 1.0);
  frame.centre = box.low / 2 + box.high / 2;
  double unit = 0;
  for (int k = 0; k < 3; ++k)
  {
    unit = std::max(unit, snap(box.high[k] - frame.centre[k]) - snap(box.low[k] - frame.centre[k]));
  }
  if (!(unit > 0) || !std::isnormal(unit))
  {
    frame.centre.setZero(); // all in one point: what follows says so
    framed.points = input.points;
    framed.input = std::move(input);
    return framed;
  }
  frame.unit = unit;
  const double steps = std::ldexp(1.0, gridBits(input, unit));
  const bool floats = areFloats(input.points, threads);
  framed.points = std::move(input.points);
  framed.input = std::move(input);
  toGrid(framed, snap, steps, threads);
  frame.sign =
    signsOf(framed.input.points, used, boxOfPoints(framed.input.points, threads, isUsed));
  Vector3* placed = framed.input.points.edit();
  parallelForEach(framed.input.points.size(), kLightChunk, threads,
    [&](std::size_t i)
    {
      // Of the two zeros one.
      placed[i] = frame.mirrored(placed[i]) / steps + Vector3::Zero();
    });
  requestsToFrame(framed);
  frame.reversed = looksInwards(framed.input, threads);
  enterFrame(framed.input.held, frame);
  framed.input.faceOrder = frame.reversed ? FaceOrder::Reversed : FaceOrder::FromLowest;
  framed.input.precision = std::max(1 / steps, std::ldexp(magnitude, floats ? -24 : -53) / unit);
  return framed;
}

FramedInput enterKnownFrame(SurfaceInput input, const FramedInput& known)
{
  FramedInput framed;
  framed.frame = known.frame;
  framed.points = std::move(input.points);
  framed.input = std::move(input);
  framed.input.faceOrder = known.input.faceOrder;
  framed.input.precision = known.input.precision;
  requestsToFrame(framed);
  enterFrame(framed.input.held, framed.frame);
  return framed;
}

namespace
{

/// Where the corner at which half-edge h begins lies between the points that its face comes from.
Vector3 placeBetween(
  const PreparedSurface& surface, Index h, const Frame& frame, const std::vector<Vector3>& points)
{
  const SourceLocation source = surface.locate(Mesh::face(h), cornerWeight(h));
  Vector3 between = Vector3::Zero();
  for (std::size_t k = 0; k < 3; ++k)
  {
    if (source.weights[k] == 1)
    {
      return points[source.points[k]];
    }
    between += source.weights[k] * (points[source.points[k]] - frame.centre);
  }
  return between + frame.centre;
}

/// At the corner where half-edge h begins.
Vector3 userPositionAt(
  const PreparedSurface& surface, Index h, const Frame& frame, const std::vector<Vector3>& points)
{
  const Vector3 place = frame.toUser(surface.mesh.position[surface.mesh.origin[h]]);
  const Index point = surface.inputPointAt(h);
  const Vector3 between =
    point != kInvalidIndex ? points[point] : placeBetween(surface, h, frame, points);
  // Repair may have moved a corner: then its source is another point.
  const double step = std::ldexp(frame.unit, -kGridBits);
  const double last = std::ldexp(place.cwiseAbs().maxCoeff(), -50);
  return (between - place).cwiseAbs().maxCoeff() <= 2 * step + last ? between : place;
}

/// Calls put(v, position) for each vertex that has a face, from several threads.
template <typename Put>
void forEachUserPosition(const PreparedSurface& surface, const Frame& frame,
  const std::vector<Vector3>& points, int threads, const Put& put)
{
  const Mesh& mesh = surface.mesh;
  std::vector<Index> first(mesh.vertexCount(), kInvalidIndex);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    Index& corner = first[mesh.origin[h]];
    corner = std::min(corner, h);
  }
  parallelForEach(mesh.vertexCount(), kLightChunk, threads,
    [&](std::size_t v)
    {
      if (first[v] != kInvalidIndex)
      {
        put(v, userPositionAt(surface, first[v], frame, points));
      }
    });
}

} // namespace

std::vector<Vector3> userPositions(const PreparedSurface& surface, const Frame& frame,
  const std::vector<Vector3>& points, int threads)
{
  std::vector<Vector3> positions;
  growLarge(positions, surface.mesh.vertexCount(), Vector3(Vector3::Zero()));
  forEachUserPosition(surface, frame, points, threads,
    [&](std::size_t v, const Vector3& position) { positions[v] = position; });
  return positions;
}

void putUserPositions(
  PreparedSurface& surface, const Frame& frame, const std::vector<Vector3>& points, int threads)
{
  // What is put at a vertex depends on what was there, and on no other vertex.
  Vector3* positions = surface.mesh.position.edit();
  forEachUserPosition(surface, frame, points, threads,
    [&](std::size_t v, const Vector3& position) { positions[v] = position; });
}

Vector3 userPosition(const PreparedSurface& surface, Index halfEdge, const Frame& frame,
  const std::vector<Vector3>& points)
{
  // Of the corners of a vertex the first one counts, as for userPositions.
  const Mesh& mesh = surface.mesh;
  Index first = halfEdge;
  Index h = halfEdge;
  do
  {
    h = mesh.twin[Mesh::previous(h)];
    first = h == kInvalidIndex ? first : std::min(first, h);
  } while (h != kInvalidIndex && h != halfEdge);
  for (Index g = h == kInvalidIndex ? mesh.twin[halfEdge] : kInvalidIndex; g != kInvalidIndex;)
  {
    const Index outgoing = Mesh::next(g);
    first = std::min(first, outgoing);
    g = mesh.twin[outgoing];
  }
  return userPositionAt(surface, first, frame, points);
}

void reverseFaces(Mesh& mesh)
{
  Index* origin = mesh.origin.edit();
  Index* twin = mesh.twin.edit();
  std::uint8_t* flags = mesh.flags.edit();
  for (Index h = 0; h < mesh.halfEdgeCount(); h += 3)
  {
    pollNowAndThen(h);
    std::swap(origin[h + 1], origin[h + 2]);
    std::swap(twin[h], twin[h + 2]);
    std::swap(flags[h], flags[h + 2]);
  }
  for (Index& g : mesh.twin.editAll())
  {
    g = g == kInvalidIndex ? kInvalidIndex : reversedEdge(g);
  }
}

void reverseFaces(PreparedSurface& surface)
{
  reverseFaces(surface.mesh);
  for (std::array<Index, 3>& points : surface.sourcePoints.editAll())
  {
    std::swap(points[1], points[2]);
  }
  for (auto& corners : surface.cornerWeights.editAll())
  {
    std::swap(corners[1], corners[2]);
    for (std::array<double, 3>& weights : corners)
    {
      std::swap(weights[1], weights[2]);
    }
  }
  for (FlippedFace& face : surface.flipped.editAll())
  {
    std::swap(face.points[1], face.points[2]);
    std::swap(face.places[1], face.places[2]);
    face.isReversed = !face.isReversed;
  }
}

} // namespace quadrille
