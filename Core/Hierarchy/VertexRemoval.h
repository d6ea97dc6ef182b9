// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Removal of one vertex [Ebke et al. 2016, Figure 4]: planar map of its star, constrained Delaunay
/// triangulation of its ring, weights of the vertex in it, and the same as a half-edge collapse and flips.
///
/// Where we differ: the triangulation is found by dynamic programming over the ring polygon instead of by
/// flipping a fan, which need not be valid. It minimizes the sum of the harmonic indices (edge lengths squared
/// over area), whose minimum is the Delaunay triangulation [Musin 1997], and can refuse single triangles
/// and diagonals. The flips are those that lead from the fan to it; what lies between need not be embedded.
///
/// Constrained curves, features and boundaries, keep their topology by the criteria for discontinuity curves of
/// [Hoppe 1996], which the paper takes over in Section 5.2. For the collapse of v onto w they come to:
///   v ends a curve, or three or more meet there    it stays: VertexKind::Protected, refused by gather()
///   v lies inside a curve, w not beside it there   never: v goes onto a neighbour on its curve, bestTarget()
///   two edges of curves would become one           refused by surroundingsFit()
/// A vertex on no curve meets none of them. Ours are besides: corners stay, no chords between curves (forbidChords()),
/// loops of at least four edges and the distance from the input's curve (surroundingsFit()).
#pragma once

#include "Hierarchy/DecimationMesh.h"
#include "Hierarchy/FanFlips.h"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace quadrille
{

/// Doubled area times this over the sum of squared edges is 1 for an equilateral triangle: 2 sqrt(3).
constexpr double kEquilateral = 3.4641016151377544;
/// Triangles flatter than this have no reliable normal, and planar ones carry no useful weights.
constexpr double kSliverQuality = 0.02;

/// What a removal must not do to the surface.
struct RemovalGuards
{
  /// Quality 4 sqrt(3) area / (sum of squared edges), 1 for an equilateral triangle, that new triangles must have
  /// unless the star they replace had a worse one.
  double minimumQuality = 0.15;
  /// Cosine of the largest deviation of a normal from those of the old faces at the same ring edges.
  double minimumNormalDot = 0.4;
  /// Let new triangles deviate as far as the faces of the star do from their mean, where that is further.
  bool allowOldFolds = false;
  int minimumValence = 4; ///< of free ring vertices, unless they had less before
  int maximumValence = 16;
  double curveTolerance = 0; ///< distance by which a curve may deviate from the input's
};

class VertexRemoval
{
public:
  explicit VertexRemoval(DecimationMesh& mesh) : mesh_(mesh) {}

  /// Collects the star of a live vertex. False when it can never be removed: protected, or too many faces.
  bool gather(Index v);
  int ringSize() const { return ringSize_; }
  Index ringVertex(int i) const { return ring_[index(i)]; }
  Index vertex() const { return vertex_; }
  /// Shortest edge at the vertex; for a curve vertex the shorter one of its two curve edges.
  double shortestEdge() const;

  /// Finds the new triangulation. False when the removal is illegal or breaks a guard.
  bool plan(const RemovalGuards& guards);

  /// The parts of plan() for who remembers plans: what lies around the star, the triangulation, the valences.
  bool surroundingsFit(const RemovalGuards& guards) const;
  bool planStar(const RemovalGuards& guards);
  bool valencesFit(const RemovalGuards& guards) const;
  /// After planStar(): whether its outcome follows from what addStarKey() gives, and not from edges elsewhere.
  bool dependsOnStarOnly() const { return !metExistingDiagonal_; }
  /// Appends all that planStar() depends on besides the guards, except edges between ring vertices outside the star.
  /// names: of the vertices, #V, or null where they have their ids.
  void addStarKey(std::vector<std::uint32_t>& words, const std::vector<Index>* names) const;
  /// Appends the plan.
  void savePlan(std::vector<std::uint32_t>& words) const;
  /// Takes over a plan for this star. False when one of its diagonals is an edge of the mesh already.
  bool loadPlan(const std::uint32_t* words);
  int planWords() const { return 3 + (ringSize_ - 2); }

  /// What the plan does to the shape of the surface.
  struct Change
  {
    double ownDefect = 0; ///< angle defect at the vertex; of a curve vertex the sides' |pi - angle|
    /// Change of the angle defect at the ring vertices, on the sides of a curve through them apart.
    std::array<std::array<double, 2>, kMaximumRing> defect;
    double starArea = 0;
    double worstQuality = 1; ///< of the new triangles
  };
  /// After planStar(), not after loadPlan().
  void measureChange(Change& change) const;
  /// After a plan: by how much the logarithm of the wanted size at the vertex differs from what the new triangulation
  /// has there.
  double sizeChange() const;
  /// After a plan: valence of the ring vertex afterwards.
  int newValence(int i) const;

  /// Carries out the plan and logs it.
  void apply(RecordWriter& log);

private:
  struct Triangle
  {
    std::uint8_t a = 0, b = 0, c = 0;
  };
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  int nextRing(int i) const { return i + 1 == ringSize_ ? 0 : i + 1; }
  /// Face of the star between ring vertices x and y = x + 1, or -1 (diagonals, the open side of a boundary star).
  int starFace(int x, int y) const
  {
    if (y == x + 1)
    {
      return x;
    }
    return y == 0 && x == ringSize_ - 1 && !boundary_ ? x : -1;
  }
  bool isRingEdge(int x, int y) const { return starFace(x, y) >= 0; }

  /// A curve passes inside the surface; the edge that takes its place parts the triangulation.
  bool splits() const { return onCurve_ && !boundary_; }
  void rotateToCurve(int first);
  bool measureStar();
  bool mapToPlane();
  bool placeSide(int first, int last, double total);
  bool curveStaysClose(const RemovalGuards& guards) const;
  bool loopStaysLong() const;
  void forbidChords();
  bool isForbidden(int x, int y) const { return (forbidden_[index(x)] >> y & 1U) != 0; }
  void forbid(int x, int y);
  double worstDeviation() const;
  bool triangulate(const RemovalGuards& guards);
  bool triangulatePolygon(const int* polygon, int count);
  void collectTriangles(const int* polygon, int i, int j);
  double triangleCost(int a, int b, int c) const;
  bool normalFits(int a, int b, int c, const Vector3& n, double least) const;
  double constraintCost(int a, int b, int c) const;
  bool forbidExistingDiagonals();
  bool closesTetrahedron() const;
  bool triangulateStar(const RemovalGuards& guards);
  bool locate();
  void countDiagonals();

  int bestTarget() const;
  CollapseRecord makeRecord(int target) const;

  DecimationMesh& mesh_;
  Index vertex_ = kInvalidIndex;
  int faces_ = 0;
  int ringSize_ = 0;
  bool boundary_ = false;
  bool onCurve_ = false;
  bool anyConstrained_ = false; ///< some ring vertex lies on a curve
  int curveEnd_ = 0; ///< ring position of the second neighbour on the curve; the first one is at 0

  std::array<Index, kMaximumRing> slot_{}; ///< corner of the vertex in its faces
  std::array<Index, kMaximumRing> ring_{};
  std::array<Vector3, kMaximumRing> spoke_{}; ///< ring vertex minus vertex
  std::array<double, kMaximumRing> length_{};
  std::array<Vector3, kMaximumRing>
    normal_{}; ///< unit normals of the star's faces; zero for slivers
  std::array<double, kMaximumRing> doubled_{}; ///< doubled areas of the faces
  std::array<double, kMaximumRing> angle_{};   ///< at the vertex
  std::array<Vector2, kMaximumRing> planar_{};
  std::array<std::uint8_t, kMaximumRing> constrainedEdge_{}; ///< ring edge i -> i + 1
  std::array<Vector3, 2> sideNormal_{};
  double starArea_ = 0;
  double starQuality_ = 0;
  bool constrainedFaces_ = false; ///< a face of the star has three constrained vertices
  double leastDot_ = 0;           ///< of normals of new triangles with those they replace
  double leastPlanar_ = 0;        ///< doubled area over sum of squared edges, of planar triangles
  double mostHarmonic_ = 0;       ///< harmonic index (1 / quality) of new triangles

  std::array<std::uint64_t, kMaximumRing> forbidden_{};
  std::array<std::array<double, kMaximumRing>, kMaximumRing> best_{};
  std::array<std::array<std::uint8_t, kMaximumRing>, kMaximumRing> split_{};
  std::array<Triangle, kMaximumRing> triangles_{};
  int triangleCount_ = 0;
  bool metExistingDiagonal_ = false;
  std::array<std::uint8_t, kMaximumRing> diagonals_{}; ///< new diagonals at each ring vertex

  std::array<std::uint8_t, 3> weightRing_{};
  std::array<std::uint32_t, 2> weight_{}; ///< in units of 2^-32

  FanFlips<kMaximumRing> flips_; ///< work of apply()
};

} // namespace quadrille
