// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Export/SurfaceWriters.h"

#include "Base/LargeArray.h"
#include "Base/Refuse.h"
#include "Export/OutputFile.h"
#include "Export/SetNames.h"

#include <array>
#include <cstdio>
#include <limits>

namespace quadrille
{

namespace
{

void requireFirstOrder(const ElementMesh& mesh, const char* format)
{
  refuseIf(mesh.nodesPerElement != 4, format, " has no elements of ", mesh.nodesPerElement,
    " nodes: make them of first order, or write vtu, ex2, inp or msh");
}

//------------------------------------------------------------------------------
// MEDIT

void writeReferenceNames(OutputFile& file, const char* kind, const std::vector<std::string>& names,
  std::size_t firstReference)
{
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    file << "# " << kind << " " << firstReference + i << ": " << names[i] << '\n';
  }
}

void writeMeditVertices(const ElementMesh& mesh, const MeshSets& sets, OutputFile& file)
{
  std::vector<Index> referenceOf;
  growLarge(referenceOf, mesh.nodes.size(), Index{ 0 });
  for (std::size_t i = 0; i < sets.corners.size(); ++i)
  {
    referenceOf[sets.corners[i].node] = static_cast<Index>(i + 1);
  }
  file << "\nVertices\n" << mesh.nodes.size() << '\n';
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    pollNowAndThen(i);
    file << mesh.nodes[i][0] << ' ' << mesh.nodes[i][1] << ' ' << mesh.nodes[i][2] << ' '
         << referenceOf[i] << '\n';
  }
}

/// Boundary loops, then feature curves; edges of a loop that are of a curve with a name go with that. Returns the
/// places of edges inside of the surface among the edges, from 1.
std::vector<std::uint64_t> writeMeditEdges(const MeshSets& sets, OutputFile& file)
{
  const std::size_t count = sets.edgeCount();
  std::vector<std::uint64_t> ridges;
  if (count == 0)
  {
    return ridges;
  }
  file << "\nEdges\n" << count << '\n';
  std::vector<std::uint64_t> referenceOf(sets.chains.size());
  std::vector<std::uint8_t> isBoundary(sets.chains.size(), 0);
  std::vector<Index> order; // of chains, each once
  std::uint64_t reference = 0;
  for (const auto* curves : { &sets.boundaries, &sets.curves })
  {
    for (const CurveSet& curve : *curves)
    {
      ++reference;
      for (const Index c : curve.chains)
      {
        if (referenceOf[c] == 0)
        {
          order.push_back(c);
          isBoundary[c] = curves == &sets.boundaries ? 1 : 0;
        }
        referenceOf[c] = reference;
      }
    }
  }
  std::uint64_t edge = 0;
  for (const Index c : order)
  {
    const EdgeChain& chain = sets.chains[c];
    for (std::size_t k = 0; k < chain.sides.size(); ++k)
    {
      file << chain.nodes[k] + 1 << ' ' << chain.nodes[(k + 1) % chain.nodes.size()] + 1 << ' '
           << referenceOf[c] << '\n';
      ++edge;
      if (isBoundary[c] == 0)
      {
        ridges.push_back(edge);
      }
    }
  }
  return ridges;
}

void writeMeditQuads(const ElementMesh& mesh, const MeshSets& sets, OutputFile& file)
{
  const std::vector<Index> setOf = patchSetOfElements(mesh, sets);
  file << "\nQuadrilaterals\n" << mesh.elementCount() << '\n';
  for (std::size_t e = 0; e < mesh.elementCount(); ++e)
  {
    pollNowAndThen(e);
    for (std::size_t i = 0; i < 4; ++i)
    {
      file << mesh.corner(e, i) + 1 << ' ';
    }
    file << setOf[e] + 1 << '\n';
  }
}

template <class Number>
void writeMeditList(OutputFile& file, const char* keyword, const std::vector<Number>& numbers)
{
  if (numbers.empty())
  {
    return;
  }
  file << '\n' << keyword << '\n' << numbers.size() << '\n';
  for (const Number number : numbers)
  {
    file << number << '\n';
  }
}

//------------------------------------------------------------------------------
// OBJ

void writeObjFace(const ElementMesh& mesh, std::size_t e, OutputFile& file)
{
  pollNowAndThen(e);
  file << 'f';
  for (std::size_t i = 0; i < 4; ++i)
  {
    file << ' ' << mesh.corner(e, i) + 1;
  }
  file << '\n';
}

//------------------------------------------------------------------------------
// STL

/// The least angle of a triangle, as the largest of the cosines: less is better. Beyond 1 without area.
double worstCosine(const Vector3& a, const Vector3& b, const Vector3& c)
{
  const std::array<Vector3, 3> edges{ b - a, c - b, a - c };
  double worst = -1;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const double lengths = edges[i].norm() * edges[(i + 2) % 3].norm();
    const double cosine = -edges[i].dot(edges[(i + 2) % 3]);
    worst = std::max(worst, lengths > 0 ? cosine / lengths : 2.);
  }
  return worst;
}

using Triangle = std::array<Index, 3>;

/// Whether to cut from corner 0 to corner 2: never along a diagonal that leaves a triangle turned over.
bool isCutFromFirst(const ElementMesh& mesh, std::size_t e)
{
  std::array<Vector3, 4> p;
  for (std::size_t i = 0; i < 4; ++i)
  {
    p[i] = mesh.nodes[mesh.corner(e, i)];
  }
  const Vector3 normal = elementNormal(mesh, e);
  const auto cost = [&](std::size_t i)
  {
    const Vector3 &a = p[i], &b = p[i + 1], &c = p[i + 2], &d = p[(i + 3) % 4];
    const bool isTurned =
      (b - a).cross(c - a).dot(normal) < 0 || (c - a).cross(d - a).dot(normal) < 0;
    return std::max(worstCosine(a, b, c), worstCosine(a, c, d)) + (isTurned ? 10 : 0);
  };
  return cost(0) <= cost(1);
}

/// Corners of second order are cut off, the middle is cut like a quad, or round the centre.
void addTriangles(const ElementMesh& mesh, std::size_t e, std::vector<Triangle>& triangles)
{
  const Index* n = mesh.element(e);
  if (mesh.nodesPerElement == 4)
  {
    const std::size_t i = isCutFromFirst(mesh, e) ? 0 : 1;
    triangles.push_back({ n[i], n[i + 1], n[i + 2] });
    triangles.push_back({ n[i], n[i + 2], n[(i + 3) % 4] });
    return;
  }
  for (std::size_t i = 0; i < 4; ++i)
  {
    const Index before = n[4 + (i + 3) % 4];
    if (mesh.nodesPerElement == 8)
    {
      triangles.push_back({ before, n[i], n[4 + i] });
    }
    else
    {
      triangles.push_back({ n[8], before, n[i] });
      triangles.push_back({ n[8], n[i], n[4 + i] });
    }
  }
  if (mesh.nodesPerElement == 8)
  {
    triangles.push_back({ n[4], n[5], n[6] });
    triangles.push_back({ n[4], n[6], n[7] });
  }
}

void writeStlTriangle(const ElementMesh& mesh, const Triangle& triangle, OutputFile& file)
{
  const Vector3& a = mesh.nodes[triangle[0]];
  const Vector3 normal =
    (mesh.nodes[triangle[1]] - a).cross(mesh.nodes[triangle[2]] - a).stableNormalized();
  const auto write = [&file](const Vector3& v)
  {
    for (int k = 0; k < 3; ++k)
    {
      file.writeBinary(static_cast<float>(v[k]));
    }
  };
  write(normal);
  for (const Index node : triangle)
  {
    write(mesh.nodes[node]);
  }
  file.writeBinary(std::uint16_t{ 0 });
}

/// Edges whose ends are one in single precision.
std::size_t lostEdges(const ElementMesh& mesh)
{
  std::size_t lost = 0;
  for (std::size_t e = 0; e < mesh.elementCount(); ++e)
  {
    pollNowAndThen(e);
    for (std::size_t i = 0; i < 4; ++i)
    {
      lost += mesh.nodes[mesh.corner(e, i)].cast<float>() ==
          mesh.nodes[mesh.corner(e, i + 1)].cast<float>()
        ? 1
        : 0;
    }
  }
  return lost;
}

} // namespace

std::vector<std::string> writeMedit(const ElementMesh& mesh, const MeshSets& sets,
  const std::string& path, const ProgressCallback& progress)
{
  requireFirstOrder(mesh, "MEDIT's format");
  report(progress, 0, writingText(mesh));
  SetNames names(kCommentNames);
  OutputFile file(path);
  file << "MeshVersionFormatted 2\n\nDimension 3\n\n# quad mesh made by Quadrille; references:\n";
  writeReferenceNames(file, "quadrilaterals", names.uniqueOf(sets.patches), 1);
  writeReferenceNames(file, "edges", names.uniqueOf(sets.boundaries), 1);
  writeReferenceNames(file, "edges", names.uniqueOf(sets.curves), 1 + sets.boundaries.size());
  writeReferenceNames(file, "vertices", names.uniqueOf(sets.corners), 1);
  writeMeditVertices(mesh, sets, file);
  report(progress, 0.5, writingText(mesh));
  const std::vector<std::uint64_t> ridges = writeMeditEdges(sets, file);
  writeMeditQuads(mesh, sets, file);
  std::vector<std::uint64_t> corners;
  for (const CornerSet& corner : sets.corners)
  {
    corners.push_back(corner.node + 1);
  }
  writeMeditList(file, "Ridges", ridges);
  writeMeditList(file, "Corners", corners);
  writeMeditList(file, "RequiredVertices", corners);
  file << "\nEnd\n";
  file.close();
  report(progress, 1, writingText(mesh));
  return names.notices();
}

std::vector<std::string> writeObj(const ElementMesh& mesh, const MeshSets& sets, bool withGroups,
  const std::string& path, const ProgressCallback& progress)
{
  requireFirstOrder(mesh, "OBJ");
  report(progress, 0, writingText(mesh));
  SetNames names(kObjNames);
  const std::vector<std::string> groups = names.uniqueOf(sets.patches);
  OutputFile file(path);
  file << "# quad mesh made by Quadrille: " << mesh.nodes.size() << " points, "
       << mesh.elementCount() << " faces\n";
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    pollNowAndThen(i);
    const Vector3& p = mesh.nodes[i];
    char line[96];
    std::snprintf(line, sizeof(line), "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
    file << static_cast<const char*>(line);
  }
  report(progress, 0.5, writingText(mesh));
  for (std::size_t e = 0; !withGroups && e < mesh.elementCount(); ++e)
  {
    writeObjFace(mesh, e, file);
  }
  for (std::size_t i = 0; withGroups && i < sets.patches.size(); ++i)
  {
    file << "g " << groups[i] << '\n';
    for (const Index e : sets.patches[i].elements)
    {
      writeObjFace(mesh, e, file);
    }
  }
  file.close();
  report(progress, 1, writingText(mesh));
  return withGroups ? names.notices() : std::vector<std::string>{};
}

std::vector<std::string> writePly(const ElementMesh& mesh, const MeshSets& sets,
  const std::string& patchProperty, bool inDouble, const std::string& path,
  const ProgressCallback& progress)
{
  requireFirstOrder(mesh, "PLY");
  report(progress, 0, writingText(mesh));
  using Limits = std::numeric_limits<std::int32_t>;
  const bool withPatches = !patchProperty.empty();
  SetNames names(kCommentNames);
  const std::vector<std::string> patches = names.uniqueOf(sets.patches);
  const std::string real = inDouble ? "double" : "float";
  OutputFile file(path);
  file << "ply\nformat binary_little_endian 1.0\ncomment quad mesh made by Quadrille\n";
  for (std::size_t i = 0; withPatches && i < patches.size(); ++i)
  {
    file << "comment " << patchProperty << ' ' << sets.patches[i].number << ": " << patches[i]
         << '\n';
  }
  file << "element vertex " << mesh.nodes.size() << '\n';
  for (const char* axis : { "x", "y", "z" })
  {
    file << "property " << real << ' ' << axis << '\n';
  }
  file << "element face " << mesh.elementCount() << "\nproperty list uchar int vertex_indices\n"
       << (withPatches ? "property int " + patchProperty + "\n" : "") << "end_header\n";
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    pollNowAndThen(i);
    for (int k = 0; k < 3; ++k)
    {
      const double x = mesh.nodes[i][k];
      inDouble ? file.writeBinary(x) : file.writeBinary(static_cast<float>(x));
    }
  }
  report(progress, 0.5, writingText(mesh));
  for (std::size_t e = 0; e < mesh.elementCount(); ++e)
  {
    pollNowAndThen(e);
    file.writeBinary(static_cast<unsigned char>(4));
    for (std::size_t i = 0; i < 4; ++i)
    {
      file.writeBinary(static_cast<std::int32_t>(mesh.corner(e, i)));
    }
    const std::int64_t number = mesh.patches[mesh.patch(e)].number;
    refuseIf(withPatches && (number < Limits::min() || number > Limits::max()), "element ", e,
      " is of patch ", number, ", which is no int: number patches lower");
    if (withPatches)
    {
      file.writeBinary(static_cast<std::int32_t>(number));
    }
  }
  file.close();
  report(progress, 1, writingText(mesh));
  return withPatches ? names.notices() : std::vector<std::string>{};
}

std::vector<std::string> writeStl(
  const ElementMesh& mesh, const std::string& path, const ProgressCallback& progress)
{
  report(progress, 0, writingText(mesh));
  const std::size_t each = mesh.nodesPerElement == 4 ? 2 : mesh.nodesPerElement == 8 ? 6 : 8;
  const std::size_t count = each * mesh.elementCount();
  refuseIf(count > std::numeric_limits<std::uint32_t>::max(),
    "STL has room for 4,294,967,295 triangles, but these quads are ", count);
  std::array<char, 80> header{};
  std::snprintf(header.data(), header.size(), "triangles of a quad mesh made by Quadrille");
  OutputFile file(path);
  file << std::string_view(header.data(), header.size());
  file.writeBinary(static_cast<std::uint32_t>(count));
  std::vector<Triangle> triangles;
  for (std::size_t e = 0; e < mesh.elementCount(); ++e)
  {
    pollNowAndThen(e);
    triangles.clear();
    addTriangles(mesh, e, triangles);
    for (const Triangle& triangle : triangles)
    {
      writeStlTriangle(mesh, triangle, file);
    }
  }
  file.close();
  report(progress, 1, writingText(mesh));
  const std::size_t lost = lostEdges(mesh);
  return lost == 0
    ? std::vector<std::string>{}
    : std::vector<std::string>{ std::to_string(lost) +
        " sides of elements have no length in the single precision of STL: move the mesh to the "
        "origin, or write obj or ply" };
}

} // namespace quadrille
