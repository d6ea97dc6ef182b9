// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What un-flip and un-collapse do to the corners of a star [Ebke et al. 2016, Appendix A], whatever a point is:
/// fixed-point uv for the map, complex numbers for the triangles laid out in their planes.
#pragma once

#include "Hierarchy/LogRecords.h"
#include "Mesh/Mesh.h"

#include <array>
#include <vector>

namespace quadrille
{

/// The star whose vertex comes back. `Charts` says what a point is and how the charts of two faces are related:
///   Point, Rotation               images of vertices, rotations from one chart to another
///   static Rotation none()
///   Rotation between(a, b)        that carries one image of an edge onto the other; none() where there is no such
///   static Rotation after(r, s)   s first
///   static Point rotate(r, p), rotateBack(r, p)
///   static Point scaled(d, w)     w d for w in units of 2^-32
template <typename Charts>
class StarReplay
{
public:
  using Point = typename Charts::Point;
  using Rotation = typename Charts::Rotation;

  /// corner: the images of all corners in the charts of their faces; must outlive this object.
  explicit StarReplay(std::vector<Point>& corner) : corner_(corner) {}

  void unflip(Index h, Index g)
  {
    // Before: f = (a, d, c), g/3 = (b, c, d). See the figure in DecimationLog.h.
    const Index nextH = Mesh::next(h);
    const Index nextG = Mesh::next(g);
    const Point dInF = corner_[nextH];
    const Point dInG = corner_[Mesh::previous(g)];
    const Rotation rotation =
      charts_.between(corner_[nextG] - dInG, corner_[Mesh::previous(h)] - dInF);
    corner_[nextH] = dInF + Charts::rotate(rotation, corner_[g] - dInG);
    corner_[nextG] = dInG + Charts::rotateBack(rotation, corner_[h] - dInF);
  }

  /// Lays the ring of a removed vertex out in the chart of the first face that is left, relative to the vertex that the
  /// star had collapsed onto. Returns where the weights put the removed vertex there.
  Point unfold(const CollapseRecord& record)
  {
    const int first = record.firstSurvivor();
    const int last = record.lastSurvivor();
    Rotation rotation = Charts::none();
    ring_[at(record.target())] = {};
    for (int i = first; i <= last; ++i)
    {
      const Index corner = record.slot[at(i)];
      const Point base = corner_[corner];
      const Point toNext = corner_[Mesh::next(corner)] - base;
      if (i > first)
      {
        // The spoke to ring vertex i is known from the face before.
        const Index before = record.slot[at(i - 1)];
        rotation = Charts::after(
          rotation, charts_.between(toNext, corner_[Mesh::previous(before)] - corner_[before]));
      }
      rotation_[at(i)] = rotation;
      ring_[at(i)] = Charts::rotate(rotation, toNext);
      if (i == last)
      {
        ring_[at(i + 1)] = Charts::rotate(rotation, corner_[Mesh::previous(corner)] - base);
      }
    }
    return placeInRing(ring_, record);
  }

  /// Where the weights of a record put its vertex.
  static Point placeInRing(
    const std::array<Point, kMaximumRing + 1>& ring, const CollapseRecord& record)
  {
    const Point base = ring[record.ring[0]];
    Point p = base + Charts::scaled(ring[record.ring[1]] - base, record.weight[0]);
    if (!record.onCurve)
    {
      p = p + Charts::scaled(ring[record.ring[2]] - base, record.weight[1]);
    }
    return p;
  }

  /// The ring that was unfolded, record.ringSize() points.
  const std::array<Point, kMaximumRing + 1>& ring() const { return ring_; }

  /// From the chart of the i-th face to the one that the ring was unfolded in; of faces that are left only.
  Rotation rotation(int i) const { return rotation_[at(i)]; }

  /// Gives the star that was unfolded its vertex back, at p beside its ring.
  void write(const CollapseRecord& record, Point p)
  {
    const int first = record.firstSurvivor();
    const int last = record.lastSurvivor();
    const Index firstSlot = record.slot[at(first)];
    const Index lastSlot = record.slot[at(last)];
    const Point targetFirst = corner_[firstSlot];
    const Point targetLast = corner_[lastSlot];
    for (int i = first; i <= last; ++i)
    {
      Point& corner = corner_[record.slot[at(i)]];
      corner = corner + Charts::rotateBack(rotation_[at(i)], p);
    }
    // The faces that come back take the chart of their neighbour in the star.
    if (first == 1)
    {
      const Index corner = record.slot[0];
      corner_[corner] = corner_[firstSlot];
      corner_[Mesh::next(corner)] = targetFirst;
      corner_[Mesh::previous(corner)] = corner_[Mesh::next(firstSlot)];
    }
    if (last == record.faces - 2)
    {
      const Index corner = record.slot[at(record.faces - 1)];
      corner_[corner] = corner_[lastSlot];
      corner_[Mesh::next(corner)] = corner_[Mesh::previous(lastSlot)];
      corner_[Mesh::previous(corner)] = targetLast;
    }
  }

  const Charts& charts() const { return charts_; }

private:
  static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

  std::vector<Point>& corner_;
  Charts charts_;
  std::array<Point, kMaximumRing + 1> ring_;
  /// From the chart of each face that is left to the first one's.
  std::array<Rotation, kMaximumRing> rotation_{};
};

} // namespace quadrille
