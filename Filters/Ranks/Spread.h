// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A surface that stays spread over the ranks of a parallel run: none ever holds all of it.
///
/// Each rank thins its pieces out (Pieces/SurfacePiece.h). The thinned pieces are joined on one rank, the owner, and
/// the filter runs there on the joined surface as if that were its input. Then the points of the quads and their
/// centres go to the ranks whose pieces they lie on, get place and attributes there, and each rank gets the quads with
/// their centre on its pieces. What is sent grows with the quads, but for eight bytes for each point on the boundary of
/// a piece.
#pragma once

#include "Convert/PolyData.h"
#include "Pieces/SurfacePiece.h"
#include "Ranks/Ranks.h"
#include "Ranks/SpreadFigures.h"

#include <vtkDataArray.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

class vtkDataObject;
class vtkPolyData;

namespace quadrille
{

/// Whether a surface that comes in pieces stays spread; the values of vtkQuadRemesh::SpreadSurfaces.
enum class SpreadMode
{
  Automatic =
    0, ///< where there are several ranks and more than kSpreadFaces faces on them together
  Always = 1,
  Never = 2 ///< the pieces are brought to one rank and put together there
};

/// Faces from which on Automatic spreads. Below, a surface in one place takes less than a gigabyte.
constexpr std::size_t kSpreadFaces = 2000000;

/// All pieces of a surface together.
struct SpreadSize
{
  std::size_t cells = 0;
  double area = 0;
  double bounds[6] = { 1, -1, 1, -1, 1, -1 }; ///< as vtkBoundingBox
  double diagonal = 0;                        ///< of the box around
};

/// What the filter asks of the pieces.
struct SpreadPlan
{
  PieceOptions piece;
  std::string patchArray; ///< as of convertSurface
  std::string guideArray; ///< a point array that guides the quads, or empty
  double memoryLimit = 0; ///< bytes that the pieces of a rank may take; 0: no limit
  ProgressCallback progress;
};

/// A piece of this rank.
struct SpreadPiece
{
  vtkSmartPointer<vtkPolyData> data;      ///< with the arrays of the model, in its order
  vtkSmartPointer<vtkDataArray> ofVolume; ///< 1 on faces of volume cells; null where there are none
  ConvertedSurface converted;             ///< without its input
  std::unique_ptr<SurfacePiece> piece;
  std::vector<Index> kept; ///< points that stay, ascending
  /// Only after a redistribution, of each cell: the rank that the user has it on, and its id there.
  std::vector<int> sourceRank;
  std::vector<vtkIdType> sourceCell;
};

class SpreadSurface
{
public:
  /// pieces: this rank's; without ghost cells. owner: the rank that gets the joined surface. All that follows is
  /// collective, and throws on all ranks alike what went wrong on one, with its rank and the place.
  SpreadSurface(
    const Ranks& ranks, int owner, const std::vector<vtkSmartPointer<vtkPolyData>>& pieces);
  ~SpreadSurface();

  const SpreadSize& size() const { return size_; }

  /// Thins the pieces out and joins them: the surface that the filter works on, on the owner; null elsewhere. Its
  /// triangles are cells, FeatureEdges and kDetectedFeatures are on them, and of the points' arrays it has those that
  /// ask for something. Notices are told on the owner.
  vtkSmartPointer<vtkPolyData> join(const SpreadPlan& plan, std::vector<std::string>& notices);

  /// quads: on the owner, what the filter made of the joined surface. Returns this rank's quads: those with their
  /// centre on its pieces, and so many rings of ghost cells around them. others: outputs with a point array
  /// QuadPointId, on the owner; their points are put to where those of the quads are on the pieces.
  vtkSmartPointer<vtkPolyData> spread(
    vtkPolyData* quads, const std::vector<vtkPolyData*>& others, int ghostLevels);

  /// Of all ranks, the same on all.
  std::vector<SpreadFigures> figures() const;

private:
  struct Orders;
  struct Carried;

  void measure();
  void makePieces();
  void findSharedPoints();
  void keepWhatAsks();
  bool isScattered(std::size_t borderPoints) const;
  void redistribute(std::vector<std::string>& notices);
  vtkSmartPointer<vtkPolyData> gatherLevels(std::vector<std::string>& notices);
  std::string packLevels();
  vtkSmartPointer<vtkPolyData> joinLevels(
    const std::vector<std::string>& all, std::vector<std::string>& notices);
  std::vector<std::string> placeQuads(vtkPolyData* quads, int ghostLevels);
  Carried carry(const Orders& orders);
  std::vector<std::string> packParcels(const Orders& orders, const Carried& carried) const;
  vtkSmartPointer<vtkPolyData> assemble(
    const std::string& share, const std::vector<std::string>& parcels) const;

  const Ranks& ranks_;
  int owner_;
  SpreadPlan plan_;
  SpreadSize size_;
  double unit_ = 0; ///< see unitOfPlaces
  std::vector<SpreadPiece> pieces_;
  SpreadFigures figures_;
  vtkSmartPointer<vtkPolyData> model_; ///< the arrays of all pieces, without tuples
  bool hasGlobalIds_ = false;          ///< of points, on all pieces
  bool isRedistributed_ = false;

  // On the owner.
  vtkSmartPointer<vtkPolyData> joined_;
  std::vector<Index> firstTriangle_; ///< #pieces of all ranks + 1
  std::vector<std::array<std::uint32_t, 2>>
    rankOf_; ///< of each piece its rank, and its number there
};

/// Whether a surface is one that SpreadSurface::join() made.
bool isJoined(vtkPolyData* surface);

/// Why pieces cannot stay spread: arrays on them that ask for what is not to be had so; empty where they can.
std::string reasonNotToSpread(
  const std::vector<vtkSmartPointer<vtkPolyData>>& pieces, const std::string& guideArray);

} // namespace quadrille
