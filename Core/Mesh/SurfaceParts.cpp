// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SurfaceParts.h"

#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Mesh/ContentHash.h"
#include "Mesh/FlatSources.h"
#include "Mesh/NearestTriangle.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace quadrille
{
namespace
{

/// Which part of a surface a place belongs to.
class PartOfPlace
{
public:
  PartOfPlace(const Mesh& mesh, const std::vector<Index>& partOfFace)
    : mesh_(mesh), partOfFace_(partOfFace)
  {
  }

  Index at(const Vector3& place)
  {
    if (!tree_)
    {
      tree_.emplace(trianglesOf(mesh_));
    }
    return partOfFace_[tree_->at(place)->triangle];
  }

private:
  const Mesh& mesh_;
  const std::vector<Index>& partOfFace_;
  std::optional<NearestTriangle> tree_; ///< made where the first place is asked for
};

/// The parts, while elements and requests are given to them.
class Splitting
{
public:
  Splitting(const PreparedSurface& whole, const std::vector<Index>& partOfFace, std::size_t parts)
    : whole_(whole), partOfFace_(partOfFace), partOfPlace_(whole.mesh, partOfFace), parts_(parts),
      newFace_(whole.mesh.faceCount()), newVertex_(whole.mesh.vertexCount(), kInvalidIndex),
      partOfVertex_(whole.mesh.vertexCount(), kInvalidIndex)
  {
  }

  std::vector<ComponentPart> take(int threads)
  {
    for (ComponentPart& part : parts_)
    {
      part.surface = withoutElements(whole_);
      part.surface.repair = {};
      part.surface.setRequests({});
      part.surface.regularElsewhere = whole_.regularElsewhere;
      part.surface.regularOnFeatures = whole_.regularOnFeatures;
      part.surface.localSizes = whole_.localSizes;
    }
    takeVertices();
    takeFaces();
    takeElementRequests();
    takePlaceRequests();
    for (ComponentPart& part : parts_)
    {
      part.surface.hash = contentHash(part.surface.mesh, threads);
    }
    return std::move(parts_);
  }

private:
  PreparedSurface& partOf(Index face) { return parts_[partOfFace_[face]].surface; }
  PreparedSurface& partAt(const Vector3& place) { return parts_[partOfPlace_.at(place)].surface; }

  void takeVertices()
  {
    const Mesh& mesh = whole_.mesh;
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      partOfVertex_[mesh.origin[h]] = partOfFace_[Mesh::face(h)];
    }
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      pollNowAndThen(v);
      Mesh& part = parts_[partOfVertex_[v]].surface.mesh;
      newVertex_[v] = part.vertexCount();
      part.position.push_back(mesh.position[v]);
      if (!mesh.sizing.empty())
      {
        part.sizing.push_back(mesh.sizing[v]);
      }
    }
  }

  void takeFaces()
  {
    const Mesh& mesh = whole_.mesh;
    std::vector<Index> faces(parts_.size(), 0);
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      newFace_[f] = faces[partOfFace_[f]]++;
    }
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      pollNowAndThen(f);
      PreparedSurface& part = partOf(f);
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        const Index twin = mesh.twin[h];
        part.mesh.origin.push_back(newVertex_[mesh.origin[h]]);
        part.mesh.twin.push_back(
          twin == kInvalidIndex ? kInvalidIndex : 3 * newFace_[twin / 3] + twin % 3);
        part.mesh.flags.push_back(mesh.flags[h]);
      }
      part.area += mesh.faceArea(f);
      part.sourcePolygon.push_back(whole_.sourcePolygon[f]);
      part.sourcePoints.push_back(whole_.sourcePoints[f]);
      takeRefined(f, part);
    }
  }

  void takeRefined(Index f, PreparedSurface& part)
  {
    if (whole_.refinedEntry.empty())
    {
      return;
    }
    const Index entry = whole_.refinedEntry[f];
    if (entry == kInvalidIndex)
    {
      part.refinedEntry.push_back(kInvalidIndex);
      return;
    }
    part.refinedEntry.push_back(static_cast<Index>(part.cornerWeights.size()));
    part.cornerWeights.push_back(whole_.cornerWeights[entry]);
    if (!whole_.flipped.empty())
    {
      part.flipped.push_back(whole_.flipped[entry]);
    }
  }

  template <class Request>
  void takeAtVertices(
    const std::vector<Request>& requests, std::vector<Request> SurfaceRequests::*list)
  {
    for (Request request : requests)
    {
      PreparedSurface& part = parts_[partOfVertex_[request.vertex]].surface;
      request.vertex = newVertex_[request.vertex];
      (part.*list).push_back(std::move(request));
    }
  }

  void takeElementRequests()
  {
    takeAtVertices(whole_.valenceRequests, &SurfaceRequests::valenceRequests);
    takeAtVertices(whole_.sectorRequests, &SurfaceRequests::sectorRequests);
    for (StrokeFace guided : whole_.strokeFaces)
    {
      PreparedSurface& part = partOf(guided.face);
      guided.face = newFace_[guided.face];
      part.strokeFaces.push_back(guided);
    }
    if (whole_.polygonGuides.empty())
    {
      return;
    }
    for (ComponentPart& part : parts_)
    {
      std::vector<Index> polygons = part.surface.sourcePolygon;
      sortUnique(polygons);
      std::copy_if(whole_.polygonGuides.begin(), whole_.polygonGuides.end(),
        std::back_inserter(part.surface.polygonGuides),
        [&](const PolygonGuide& guide)
        { return std::binary_search(polygons.begin(), polygons.end(), guide.polygon); });
    }
  }

  void takePlaceRequests()
  {
    for (Index i = 0; i < whole_.curves.size(); ++i)
    {
      ComponentPart& part = parts_[partOfPlace_.at(whole_.curves[i].points.front())];
      part.surface.curves.push_back(whole_.curves[i]);
      part.curves.push_back(i);
    }
    for (const StrokeRequest& stroke : whole_.strokes)
    {
      partAt(stroke.points.front()).strokes.push_back(stroke);
    }
    for (const SizeRequest& size : whole_.sizes)
    {
      partAt(size.place).sizes.push_back(size);
    }
    for (const SeamRequest& seam : whole_.seams)
    {
      partAt(seam.from).seams.push_back(seam);
    }
    for (const StraightRequest& straight : whole_.straight)
    {
      partAt(straight.via).straight.push_back(straight);
    }
    for (const Vector3& place : whole_.withoutMap)
    {
      partAt(place).withoutMap.push_back(place);
    }
  }

  const PreparedSurface& whole_;
  const std::vector<Index>& partOfFace_;
  PartOfPlace partOfPlace_;
  std::vector<ComponentPart> parts_;
  std::vector<Index> newFace_, newVertex_, partOfVertex_; ///< of the whole's elements
};

/// #elements values more, shifted where they are ids.
template <typename T>
void appendIds(SharedArray<T>& all, const SharedArray<T>& part, Index shift)
{
  all.change(
    [&](std::vector<T>& own)
    {
      own.reserve(own.size() + part.size());
      std::transform(part.begin(), part.end(), std::back_inserter(own),
        [&](T id) { return id == kInvalidIndex ? id : id + shift; });
    });
}
template <typename T>
void appendValues(SharedArray<T>& all, const SharedArray<T>& part)
{
  all.change([&](std::vector<T>& own) { append(own, part); });
}
/// The same for an array that may be empty, which then has `missing` for every element.
template <typename T>
void appendOptional(SharedArray<T>& all, const SharedArray<T>& part, std::size_t before,
  std::size_t added, const T& missing)
{
  if (!all.empty() || !part.empty())
  {
    all.change(
      [&](std::vector<T>& own)
      {
        own.resize(before, missing);
        append(own, part);
        own.resize(before + added, missing);
      });
  }
}

/// The flips of the part come after all that are there, but for those that both begin with.
void appendFlips(const PreparedSurface& part, PreparedSurface& all)
{
  std::vector<std::shared_ptr<const FlatSources>> own;
  const auto isShared = [&](const FlatSources* flips)
  {
    const FlatSources* there = all.beforeFlips.get();
    while (there != nullptr && there->level() > flips->level())
    {
      there = there->before().get();
    }
    return there == flips;
  };
  for (auto flips = part.beforeFlips; flips && !isShared(flips.get()); flips = flips->before())
  {
    own.push_back(flips);
  }
  const Index shared =
    (part.beforeFlips ? part.beforeFlips->level() : 0) - static_cast<Index>(own.size());
  const Index shift = (all.beforeFlips ? all.beforeFlips->level() : 0) - shared;
  for (auto flips = own.rbegin(); flips != own.rend(); ++flips)
  {
    all.beforeFlips = shift == 0 ? *flips : (*flips)->movedOnto(all.beforeFlips, shared, shift);
  }
  const Index entries = static_cast<Index>(all.cornerWeights.size());
  std::vector<FlippedFace> flipped = part.flipped;
  for (FlippedFace& face : flipped)
  {
    face.level += face.level > shared ? shift : 0;
  }
  appendOptional(all.flipped, SharedArray<FlippedFace>(std::move(flipped)), entries,
    part.cornerWeights.size(), {});
}

} // namespace

std::vector<ComponentPart> splitSurface(const PreparedSurface& whole,
  const std::vector<Index>& partOfFace, std::size_t parts, int threads)
{
  return Splitting(whole, partOfFace, parts).take(threads);
}

void appendMesh(const Mesh& part, Mesh& all)
{
  const Index vertices = all.vertexCount(), halfEdges = all.halfEdgeCount();
  appendOptional(all.sizing, part.sizing, vertices, part.vertexCount(), 1.0F);
  appendValues(all.position, part.position);
  appendIds(all.origin, part.origin, vertices);
  appendIds(all.twin, part.twin, halfEdges);
  appendValues(all.flags, part.flags);
}

void appendSurface(const PreparedSurface& part, PreparedSurface& all)
{
  const Index vertices = all.mesh.vertexCount(), faces = all.mesh.faceCount();
  for (ValenceRequest request : part.valenceRequests)
  {
    request.vertex += vertices;
    all.valenceRequests.push_back(request);
  }
  for (SectorRequest request : part.sectorRequests)
  {
    request.vertex += vertices;
    all.sectorRequests.push_back(std::move(request));
  }
  for (StrokeFace guided : part.strokeFaces)
  {
    guided.face += faces;
    all.strokeFaces.push_back(guided);
  }
  appendFlips(part, all);
  if (!all.refinedEntry.empty() || !part.refinedEntry.empty())
  {
    SharedArray<Index> entries;
    appendIds(entries, part.refinedEntry, static_cast<Index>(all.cornerWeights.size()));
    appendOptional(all.refinedEntry, entries, faces, part.mesh.faceCount(), kInvalidIndex);
  }
  appendValues(all.cornerWeights, part.cornerWeights);
  appendValues(all.sourcePolygon, part.sourcePolygon);
  appendValues(all.sourcePoints, part.sourcePoints);
  appendMesh(part.mesh, all.mesh);
  all.area += part.area;
  all.components += part.components;
  all.repair.refinedFaces += part.repair.refinedFaces;
  all.repair.closedHandles += part.repair.closedHandles;
  all.repair.filledHoles += part.repair.filledHoles;
}

PreparedSurface withoutElements(const PreparedSurface& whole)
{
  PreparedSurface surface;
  surface.setRequests(whole.requests());
  surface.valenceRequests.clear();
  surface.sectorRequests.clear();
  surface.strokeFaces.clear();
  surface.repair = whole.repair;
  surface.facets = whole.facets;
  surface.curvatures = whole.curvatures;
  surface.boundingBoxDiagonal = whole.boundingBoxDiagonal;
  surface.beforeFlips = whole.beforeFlips;
  surface.seconds = whole.seconds;
  surface.notice = whole.notice;
  return surface;
}

TrianglesOfMesh partOf(const Mesh& whole, const std::vector<Index>& triangles)
{
  TrianglesOfMesh part;
  Mesh& mesh = part.mesh;
  std::map<Index, Index> newVertex, newFace;
  for (const Index f : triangles)
  {
    newFace.emplace(f, static_cast<Index>(newFace.size()));
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const Index v = whole.origin[h];
      if (newVertex.emplace(v, static_cast<Index>(part.vertices.size())).second)
      {
        part.vertices.push_back(v);
        mesh.position.push_back(Vector3(whole.position[v]));
        if (!whole.sizing.empty())
        {
          mesh.sizing.push_back(float{ whole.sizing[v] });
        }
      }
      mesh.origin.push_back(Index{ newVertex[v] });
      mesh.flags.push_back(0);
    }
  }
  for (const Index f : triangles)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const Index twin = whole.twin[h];
      const auto beyond = twin == kInvalidIndex ? newFace.end() : newFace.find(Mesh::face(twin));
      mesh.twin.push_back(beyond == newFace.end() ? kInvalidIndex : 3 * beyond->second + twin % 3);
    }
  }
  return part;
}

} // namespace quadrille
