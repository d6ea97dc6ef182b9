// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The coordinates that a run works in. Maps in metres and parts of assemblies lie far from the origin, where the last
/// bits of their numbers are noise; CAD models are full of exact ties, which that noise would decide. So a run sees the
/// surface round its box's centre, with the longest side of the box as unit, on a grid that is coarser than this noise,
/// and with axes and faces reversed so that a mirror image is the same. Then a shift, a scale and a mirror image are
/// the same to the last bit for all that follows.
///
///   user                                  frame
///   P = centre + unit * sign . p   <->    p = sign . round((P - centre) / unit)      faces may run the other way round
#pragma once

#include "Mesh/Surface.h"

#include <vector>

namespace quadrille
{

struct Frame
{
  Vector3 centre = Vector3::Zero(); ///< of the surface's box, in units of the input
  double unit = 1;                  ///< the longest side of the box, in units of the input
  Vector3 sign = Vector3::Ones();   ///< of each axis; -1: it runs the other way
  bool reversed = false;            ///< faces run the other way round than those of the input

  Vector3 toUser(const Vector3& p) const { return centre + unit * sign.cwiseProduct(p); }
  Vector3 fromUser(const Vector3& p) const { return sign.cwiseProduct((p - centre) / unit); }
  /// Vectors of any length, such as directions.
  Vector3 mirrored(const Vector3& direction) const { return sign.cwiseProduct(direction); }
  /// A length of the user's in the frame, kept to 40 bits: the way out (times unit) and in again gives the same number.
  double lengthOf(double userLength) const;
};

/// Keeps 40 significant bits of a length in a frame, see Frame::lengthOf.
double roundedLength(double length);

/// A surface in its frame, and its points as they came.
struct FramedInput
{
  Frame frame;
  SurfaceInput input; ///< points, directions, faceOrder and precision are those of the frame
  std::vector<Vector3> points; ///< of the user
};

/// Puts a surface into its frame. Points that no polygon uses do not count. Which way an axis runs is told by the first
/// point that lies well off the middle, which way faces run by the volume that they enclose, or the first polygon where
/// that says nothing: with the same ids of points, a mirror image has the same frame, whether its faces are reversed or
/// not. Throws InvalidInput as checkInput does.
FramedInput enterFrame(SurfaceInput input, int threads);

/// The same for points and polygons that have been put into the known frame before. The result's input has no points:
/// it is for who has the surface that was made of them. The input must have passed checkInput.
FramedInput enterKnownFrame(SurfaceInput input, const FramedInput& known);

/// Held vertices as the frame sees them, and sectors back.
void enterFrame(std::vector<HeldVertex>& held, const Frame& frame);
void leaveFrame(std::vector<SectorRequest>& sectors, const Frame& frame);

/// The user's positions of the vertices, #V: for points of the input their own numbers, for vertices that refinement
/// made the place between them, for others (repair and closed handles) that of the frame. points: those of FramedInput.
/// threads: 0: all.
std::vector<Vector3> userPositions(const PreparedSurface& surface, const Frame& frame,
  const std::vector<Vector3>& points, int threads = 1);

/// The same in place of those of the frame.
void putUserPositions(PreparedSurface& surface, const Frame& frame,
  const std::vector<Vector3>& points, int threads = 1);

/// That of one of them, at whose corner the half-edge begins.
Vector3 userPosition(const PreparedSurface& surface, Index halfEdge, const Frame& frame,
  const std::vector<Vector3>& points);

/// Reverses all faces: corners 0 1 2 become 0 2 1. What belongs to corner i moves to reversedCorner(h), what belongs
/// to half-edge i to reversedEdge(h). Twice is nothing.
inline Index reversedCorner(Index h)
{
  return h / 3 * 3 + (3 - h % 3) % 3;
}
inline Index reversedEdge(Index h)
{
  return h / 3 * 3 + 2 - h % 3;
}
void reverseFaces(Mesh& mesh);
/// The same with all that is kept by corners.
void reverseFaces(PreparedSurface& surface);

} // namespace quadrille
