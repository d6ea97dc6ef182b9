// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The face below the quads that fill it: the places on it, the sizes there, and the pins on its boundary.
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NearestTriangle.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace quadrille
{

/// Moves of points shorter than this share of the edges wanted there are not worth a search for the place below.
constexpr double kLeastMove = 0.02;

class FaceGround
{
public:
  struct Spot
  {
    Index face = kInvalidIndex;
    std::array<double, 3> weights{}; ///< barycentric
    Vector3 point = Vector3::Zero();
    Vector3 normal = Vector3::Zero(); ///< of length 1, or zero
    double size = 1;                  ///< as a multiple of the edge length
  };

  /// As for fillFace. The mesh must live as long as the ground.
  FaceGround(const Mesh& face, const std::vector<std::uint8_t>& isPin, double edgeLength);
  /// Without pins; of the mesh triangles and sizes count.
  explicit FaceGround(const Mesh& face);

  /// The nearest place whose face looks where `facing` does; none where there is no such face. near: a place that is
  /// about on the face, which makes the search shorter.
  std::optional<Spot> at(const Vector3& p, const Vector3& facing, const Vector3& near) const;
  /// Per vertex of the face; of length 1, or zero.
  const std::vector<Vector3>& normals() const { return normals_; }
  /// Per vertex of the face, as a multiple of the edge length: near pins that stand closer together it is less.
  const std::vector<double>& sizes() const { return sizes_; }
  double edgeLength() const { return edgeLength_; }

  /// Of vertices, also of those that a working copy has beyond the face's own.
  bool isPin(Index v) const { return v < nextPin_.size() && nextPin_[v] != kInvalidIndex; }
  /// The next one of the loop, with the face on the left; kInvalidIndex for other vertices.
  Index nextPin(Index v) const { return nextPin_[v]; }
  /// The interior angle (radians, > 0) of the polygon of pins at one of them; a full turn for a vertex inside.
  double angleAt(Index v) const;
  /// Pins of each loop of the boundary.
  const std::vector<std::size_t>& pinsOfLoops() const { return pinsOfLoops_; }

private:
  void walkLoop(
    Index first, const std::vector<std::uint8_t>& isPin, std::vector<std::uint8_t>& walked);
  void measureAngles();
  /// One that stands close to its neighbours.
  struct FinePin
  {
    Vector3 place;
    double size; ///< by the distance of its neighbours
  };
  std::vector<FinePin> finePins() const;
  void measureSizes();

  const Mesh& face_;
  double edgeLength_;
  NearestTriangle nearest_;
  std::vector<Vector3> normals_;
  std::vector<double> sizes_;
  std::vector<Index> nextPin_;
  std::vector<double> angles_; ///< per vertex
  std::vector<std::size_t> pinsOfLoops_;
};

/// 1 for an equilateral triangle, 0 for one without area, below 0 for one that is turned over against the normal.
double triangleShape(const std::array<Vector3, 3>& corners, const Vector3& normal);

/// The scaled Jacobian with respect to a normal, which sees a quad that is turned over as a whole.
double quadShape(const std::array<Vector3, 4>& corners, const Vector3& normal);

} // namespace quadrille
