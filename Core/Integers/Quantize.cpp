// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quantization without a T-mesh [Coudert-Osmont et al. 2023, from its description]. Where we differ: the decimation is
/// exact and ends in the Delaunay triangulation of the locked vertices; straight edges between locked
/// vertices of the coarse mesh stay, so every triangle that re-embedding cannot move is tested as it is; the
/// start is repaired before the scale is raised; shrinking steps begin large.
#include "Integers/Quantize.h"

#include "Base/TryCount.h"
#include "Integers/CurveShares.h"
#include "Integers/LockedVertices.h"
#include "Integers/QuantizeIntegers.h"
#include "Integers/UvDecimation.h"
#include "Mesh/BreadthFirst.h"
#include "Requests/SeamRequests.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace quadrille
{

namespace
{

/// By what factor sizes may grow for that the integers become valid. It is judged after shrinking, which undoes most of
/// the growth by a scale.
constexpr double kMostRefinement = 8;

void checkInput(const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& uv)
{
  if (uv.size() != mesh.halfEdgeCount() || field.matching.size() != mesh.halfEdgeCount())
  {
    throw InvalidInput("quantizeMap: " + std::to_string(uv.size()) + " corners of the map and " +
      std::to_string(field.matching.size()) + " matchings for " +
      std::to_string(mesh.halfEdgeCount()) + " half-edges");
  }
}

/// Why the map is no start for quantization; empty when it is one.
std::string defectOf(const UvMesh& mesh)
{
  for (Index h = 0; h < mesh.origin.size(); ++h)
  {
    if (h % 3 == 0 && mesh.faceDeterminant(Mesh::face(h)) <= 0)
    {
      return "face " + std::to_string(Mesh::face(h)) + " is not positive in the seamless map";
    }
    const Index g = mesh.twin[h];
    if (g != kInvalidIndex && mesh.vector(g) != -rotate(mesh.vector(h), mesh.rotation[h]))
    {
      return "the seamless map does not fit its matching across half-edge " + std::to_string(h);
    }
    const FixedVec2 d = mesh.vector(h);
    if ((mesh.flags[h] & kUvConstrained) != 0 && d.u != 0 && d.v != 0)
    {
      return "constrained half-edge " + std::to_string(h) + " is not on an isoline";
    }
  }
  return {};
}

void placeFace(const IntegerMap& map, Index corner, FixedVec2 at, UvMesh& mesh)
{
  const auto place = [&](Index h, FixedVec2 q) {
    mesh.uv[h] = at + FixedVec2{ q.u * (kOne / kGrain), q.v * (kOne / kGrain) };
  };
  place(corner, {});
  place(Mesh::next(corner), map[corner]);
  place(Mesh::previous(corner), map[corner] + map[Mesh::next(corner)]);
}

/// Charts from displacements: integer vertices lie at whole points, so all translations are whole.
void integrate(const IntegerMap& map, const std::vector<std::uint8_t>& integer, UvMesh& mesh)
{
  std::vector<std::uint8_t> placed(mesh.alive.size(), 0);
  std::vector<Index> queue;
  for (const Index seed : map.faces())
  {
    for (Index h = 3 * seed; h < 3 * seed + 3 && !placed[seed]; ++h)
    {
      if (integer[mesh.origin[h]])
      {
        placeFace(map, h, {}, mesh);
        placed[seed] = 1;
        queue.push_back(seed);
      }
    }
  }
  // Faces without an integer vertex follow from their neighbours.
  for (std::size_t i = 0; i < queue.size(); ++i)
  {
    for (Index h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h)
    {
      const Index g = mesh.twin[h];
      if (g != kInvalidIndex && !placed[Mesh::face(g)])
      {
        placeFace(map, g, rotate(mesh.uv[Mesh::next(h)], mesh.rotation[h]), mesh);
        placed[Mesh::face(g)] = 1;
        queue.push_back(Mesh::face(g));
      }
    }
  }
}

/// In quads.
double uvArea(const UvMesh& mesh)
{
  double area = 0;
  for (Index f = 0; f < mesh.alive.size(); ++f)
  {
    area += mesh.alive[f] ? 0.5 / kUnitArea * static_cast<double>(mesh.faceDeterminant(f)) : 0.0;
  }
  return area;
}

void moveChart(UvMesh& mesh, Index f, FixedVec2 by)
{
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    mesh.uv[h] = mesh.uv[h] + by;
  }
}

/// Joins charts: along a spanning tree of the faces the transitions become rotations without translation.
void joinCharts(UvMesh& mesh)
{
  visitFaces(
    mesh.twin, [](Index) {},
    [&](Index h)
    {
      moveChart(mesh, Mesh::face(mesh.twin[h]), -mesh.transition(h).translation);
      return true;
    });
}

/// Integers that begin as those of a map along the same field; not valid where they lead nowhere.
/// done: how the seamless map came to its triangles.
IntegerStart startFrom(const std::vector<FixedVec2>& uv, const Mesh& mesh, const CrossField& field,
  const UvEditor& done, IntegerMap& integers)
{
  UvMesh followed = UvMesh::from(mesh, field, uv);
  UvEditor(followed).repeat(done.records());
  return integers.adopt(followed.uv) ? repairIntegers(integers) : IntegerStart{};
}

/// The mesh with its seams joined, as each one is an edge now: strips that leave by one part come back by its image, so
/// that both keep the same length.
class JoinedSides
{
public:
  JoinedSides(UvMesh& mesh, const Mesh& whole, const CrossField& field) : mesh_(mesh)
  {
    for (const SeamEdges& seam : field.seams)
    {
      const Index a = edgeOf(whole, seam.left);
      const Index b = edgeOf(whole, seam.right);
      if (a == kInvalidIndex || b == kInvalidIndex || !join(a, b))
      {
        isWhole_ = false;
        return;
      }
    }
  }

  bool isWhole() const { return isWhole_; }

  /// Half-edges that were boundary.
  const std::vector<Index>& joined() const { return joined_; }

private:
  Index edgeOf(const Mesh& whole, const std::vector<Index>& part) const
  {
    const Index h = mesh_.outgoing[whole.origin[part.front()]];
    const bool isEdge = h != kInvalidIndex && mesh_.twin[h] == kInvalidIndex &&
      mesh_.target(h) == whole.target(part.back());
    return isEdge ? h : kInvalidIndex;
  }

  bool join(Index a, Index b)
  {
    for (int r = 0; r < 4; ++r)
    {
      if (mesh_.vector(b) == -rotate(mesh_.vector(a), r))
      {
        mesh_.twin[a] = b;
        mesh_.twin[b] = a;
        mesh_.rotation[a] = static_cast<std::int8_t>(r);
        mesh_.rotation[b] = static_cast<std::int8_t>(-r & 3);
        joined_.insert(joined_.end(), { a, b });
        return true;
      }
    }
    return false;
  }

  UvMesh& mesh_;
  std::vector<Index> joined_;
  bool isWhole_ = true;
};

void takeApart(const std::vector<Index>& joined, UvMesh& mesh)
{
  for (const Index h : joined)
  {
    mesh.twin[h] = kInvalidIndex;
    mesh.rotation[h] = 0;
  }
}

/// A vertex between the ends of a seam that may lie anywhere on it is none that its image need have.
void freeSeams(const Mesh& mesh, const CrossField& field, LockedVertices& locked)
{
  for (const SeamEdges& seam : field.seams)
  {
    for (const std::vector<Index>* part : { &seam.left, &seam.right })
    {
      for (std::size_t i = 1; i < part->size(); ++i)
      {
        const Index v = mesh.origin[(*part)[i]];
        locked.keep[v] = locked.integer[v];
      }
    }
  }
}

Status tooFine(double growth)
{
  return { StatusCode::NotConverged,
    "quads would have to be smaller by a factor of " + std::to_string(growth) };
}

} // namespace

struct Quantizer::State
{
  UvMesh mesh;
  UvEditor editor;
  LockedVertices locked;
  std::size_t decimated = 0; ///< records of the editor, before the seams were joined
  std::vector<Index> joined; ///< along seams
  std::optional<IntegerMap> integers;
  double wantedArea = 0;
  QuantizeResult result; ///< but for its map

  explicit State(UvMesh seamless) : mesh(std::move(seamless)), editor(mesh) {}

  bool prepare(const Mesh& coarse, const CrossField& field,
    const std::vector<FixedVec2>& seamlessUv, const QuantizeOptions& options)
  {
    const std::string defect = defectOf(mesh);
    if (!defect.empty())
    {
      result.status = { StatusCode::Infeasible, "quantization: " + defect };
      return false;
    }
    wantedArea = uvArea(mesh);
    locked = lockedVertices(coarse, mesh, integerVertices(coarse, field), options.watched);
    freeSeams(coarse, field, locked);
    decimateInUv(mesh, editor, locked.keep);
    decimated = editor.recordCount();
    const JoinedSides seams(mesh, coarse, field);
    joined = seams.joined();
    if (!seams.isWhole())
    {
      result.status = { StatusCode::NotConverged,
        "quantization: the two sides of the cut have not the same corners and ends of features" };
      return false;
    }
    integers.emplace(mesh, editor, locked.integer,
      options.edgeLength > 0 ? sharesOfCurves(coarse, field, seamlessUv, options.edgeLength, mesh)
                             : std::vector<CurveShare>{});
    return true;
  }

  void findValid(const Mesh& coarse, const CrossField& field, const QuantizeOptions& options)
  {
    IntegerStart start;
    if (options.previousUv != nullptr)
    {
      countTry(Try::EarlierIntegers);
      start = startFrom(*options.previousUv, coarse, field, editor, *integers);
      result.startedFromPrevious = start.valid;
      countTryLed(Try::EarlierIntegers, start.valid ? 1 : 0);
    }
    if (!start.valid && options.anew)
    {
      try
      {
        start = findValidIntegers(*integers, options.progress);
      }
      catch (const WorkSpent&)
      {
        throw QuantizingSpent(brokenFaces(*integers));
      }
    }
    if (!start.valid)
    {
      result.status = { StatusCode::NotConverged,
        options.anew ? "quantization: no valid integers up to scale " +
            std::to_string(std::min(start.scale, kMaximumScale))
                     : "quantization: the earlier integers lead to none" };
      result.failedFaces = brokenFaces(*integers);
    }
  }
};

Quantizer::Quantizer(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& seamlessUv, const QuantizeOptions& options)
{
  checkInput(mesh, field, seamlessUv);
  state_ = std::make_unique<State>(UvMesh::from(mesh, field, seamlessUv));
  state_->result.uv = seamlessUv;
  if (state_->prepare(mesh, field, seamlessUv, options))
  {
    state_->findValid(mesh, field, options);
  }
}

Quantizer::~Quantizer() = default;

const Status& Quantizer::status() const
{
  return state_->result.status;
}

bool Quantizer::startedFromPrevious() const
{
  return state_->result.startedFromPrevious;
}

void Quantizer::improve(double pull, const ProgressCallback& progress)
{
  state_->integers->setPull(pull);
  improveIntegers(*state_->integers, progress);
}

double Quantizer::area() const
{
  return state_->integers->area();
}

QuantizeResult Quantizer::result() const
{
  QuantizeResult result = state_->result;
  if (!result.status.ok())
  {
    return result;
  }
  result.refinement = std::max(1.0, std::sqrt(area() / state_->wantedArea));
  UvMesh mesh = state_->mesh;
  UvEditor editor(mesh, state_->editor);
  integrate(*state_->integers, state_->locked.integer, mesh);
  editor.undoTo(state_->decimated, state_->locked.keep);
  takeApart(state_->joined, mesh);
  editor.undoTo(0, state_->locked.keep);
  joinCharts(mesh);
  result.uv = std::move(mesh.uv);
  if (result.refinement > kMostRefinement)
  {
    result.status = tooFine(result.refinement);
  }
  return result;
}

QuantizeResult quantizeMap(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& seamlessUv, const QuantizeOptions& options)
{
  if (!(options.pull >= 0))
  {
    throw InvalidInput(
      "quantizeMap: the share of the sizes that integers keep must not be negative");
  }
  Quantizer quantizer(mesh, field, seamlessUv, options);
  if (quantizer.status().ok())
  {
    quantizer.improve(options.pull, options.progress);
  }
  return quantizer.result();
}

} // namespace quadrille
