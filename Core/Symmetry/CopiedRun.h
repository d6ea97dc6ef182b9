// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads of a part of a surface, and their images under a symmetry, as one mesh: what the mirror image and the rotation
/// have in common.
#pragma once

#include "Mesh/Topology.h"
#include "Symmetry/MirrorFit.h"
#include "Symmetry/Symmetry.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace quadrille
{

using FaceWeights = std::array<std::array<double, 3>, 3>;

/// A part of a surface that images of it make a whole.
struct SurfacePart
{
  SurfaceInput input;      ///< triangles
  std::vector<Index> face; ///< per triangle: the face of the whole that it is a part of
  /// Of a triangle: its corners in weights of the corners of that face.
  std::function<FaceWeights(Index triangle)> cornerWeights;
};

/// Several times the same mesh, its images behind it, each with the same number of faces.
struct CopiedMesh
{
  Mesh mesh;
  Index partFaces = 0; ///< of the mesh itself
  std::vector<FixedVec2> uv;
  std::vector<int> turns;
};

/// Sources of the faces of images, in the store.
struct StoredImages;
/// A face under a place, and the last place that was searched for in the tree.
struct NearImage
{
  Index face = kInvalidIndex;
  Vector3 searched = Vector3::Zero();
  double distance = 0; ///< from there
};

/// "0.0012".
std::string shareText(double share);

/// Features that meet the plane count as requested, up to where they end or meet others: each half of one may be too
/// short for the quads though it is not as a whole.
void requestCutFeatures(Mesh& mesh, const MirrorPlane& plane, double tolerance);

/// #V flags of vertices that have other turns than regular ones.
std::vector<std::uint8_t> irregularOf(const Mesh& mesh, const std::vector<int>& turns);

/// One run: each step leaves what the next ones need.
class CopiedRun
{
public:
  CopiedRun(const RemeshOptions& options, ResultStore* store) : options_(options), store_(store) {}
  virtual ~CopiedRun() = default;
  CopiedRun(const CopiedRun&) = delete;
  CopiedRun& operator=(const CopiedRun&) = delete;

  SymmetricResult run(SurfaceInput& input);
  /// Whether the run of the part was stopped with quads, see RemeshResult::stopped.
  bool isStopped() const { return !made_.remeshed.stopped.empty(); }

protected:
  /// The symmetry: given or found; told, and refused where the surface has not got it.
  virtual void choose() = 0;
  /// Makes the part, with what is asked of it.
  virtual void cut() = 0;
  /// How many parts make the whole.
  virtual std::size_t copies() const = 0;
  /// Of a result that depends on the symmetry.
  virtual ResultKey keyOf(ResultKey of) const = 0;
  /// Outcomes of all curves of the whole from those of the part.
  virtual std::vector<CurveOutcome> outcomes(const std::vector<CurveOutcome>& ofPart) const = 0;
  /// Quads that the part needs beside its share of the whole's, at this edge length.
  virtual double quadsBeside(double edgeLength) const
  {
    static_cast<void>(edgeLength);
    return 0;
  }
  /// The quads of the part and their images become the result's, by takeQuads() and takeSurface(). False where they
  /// are no mesh and more quads would help.
  virtual bool copy() = 0;

  const PreparedSurface& surface() const { return whole_->surface; }
  void lap(const char* stage, double start, std::size_t in, std::size_t out);
  /// What `act` sees of the whole has only the features that the edge length resolves.
  void withFeatures(const std::function<void(Mesh&)>& act);
  /// Throws where the part does not look like its images.
  void tell(const std::string& text, const std::string& help);
  /// Where the quads of the part lie on the input.
  void locatePart(const QuadMesh& quads);
  void takeQuads(DoubledQuads quads, const MirrorFit& fit);
  /// The mapped surface of the whole, which is certified.
  void takeSurface(CopiedMesh copied);
  void tellTopology(const TopologySummary& made, const char* sides);

  const RemeshOptions& options_;
  ResultStore* store_;
  ResultKey key_ = 0;
  double tolerance_ = 0;
  std::shared_ptr<SearchedSurface> whole_;
  SurfacePart part_;
  SymmetricResult made_;
  std::vector<std::string> notices_, reused_;

private:
  void prepare(SurfaceInput& input);
  void remeshAndCopy();
  void remeshPart(std::size_t more);
  FaceWeights weightsInWhole(Index f) const;
  std::size_t cornerOf(Index t, Index point) const;
  SourceLocation locateInWhole(Index f, const std::array<double, 3>& weights) const;
  Index polygonOf(Index f) const;
  void tellMoved(const DoubledQuads& quads, const MirrorFit& fit);
  StoredImages imageSources(const CopiedMesh& copied);
  void findImageSource(const Mesh& mesh, Index f, NearImage& near, FaceWeights& weights) const;
  bool climb(NearImage& near, const Vector3& p, const Vector3& normal) const;
  void certifyWhole();
  void ownFrame();

  StageRecords laps_;
};

} // namespace quadrille
