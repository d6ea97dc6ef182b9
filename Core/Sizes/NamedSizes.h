// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sizes of quads by names: of faces, and of edges and vertices of a design.
#pragma once

#include "Base/Types.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

struct NamedSize
{
  std::string pattern; ///< * stands for any letters, ? for one
  double factor = 1;   ///< > 0; of the target edge length
};

/// "fillet*=0.5", one a line or with semicolons between them. Throws InvalidInput, which names the line.
std::vector<NamedSize> namedSizesOf(const std::string& text);

/// Triangles whose faces, edges and vertices have names.
struct NamedSurface
{
  std::vector<Vector3> points;
  std::vector<std::array<Index, 3>> triangles;
  std::vector<std::string> faceNames;     ///< #triangles; empty: no face has a name
  std::vector<float> sizes;               ///< #points, factors that are asked for before; or empty
  std::vector<std::uint8_t> featureEdges; ///< #triangles, bit i: side i is one; or empty
  std::vector<std::array<float, 6>>
    knownCurvature;                            ///< #triangles, at corners and along sides; or empty
  std::vector<std::string> edgeNames;          ///< by id; an empty one where the edge has none
  std::vector<std::vector<Vector3>> edgeLines; ///< by id, polylines
  std::vector<std::string> vertexNames;        ///< by id; an empty one where the vertex has none
  std::vector<Vector3> vertexPoints;           ///< by id; NaN where the surface has no such point
};

/// Triangles that are short beside what has a size.
struct SizedTriangles
{
  std::vector<Vector3> points; ///< of the surface, then the middles
  std::vector<std::array<Index, 2>>
    middles; ///< of the points that are new, in their order: between which two
  std::vector<std::array<Index, 3>> triangles;
  std::vector<Index> parents; ///< #triangles: of the surface
  /// #points: the smallest of what is asked of the faces, edges and vertices there, of the sizes that the surface has,
  /// and of 1 for a face that nothing is asked of.
  std::vector<float> sizes;
  std::vector<std::uint8_t> featureEdges;           ///< as of the surface
  std::vector<std::array<float, 6>> knownCurvature; ///< as of the surface
};

/// Faces, edges and vertices of a surface, with what is asked of them.
class NamedParts
{
public:
  /// prefix: may stand before all names: "bolt/" of the block "bolt", so that bolt/FACE_1 is found as well as FACE_1.
  /// Edges without a name are EDGE_n, vertices VERTEX_n, by their ids from 1, as faces are FACE_n.
  NamedParts(NamedSurface surface, std::string prefix);

  /// The names, each once, in their order and with the prefix: of faces, then those of edges and vertices that the
  /// design has.
  std::vector<std::string> names() const;
  /// Of several sizes of one name the last one counts. isUsed: of each size, whether a name was found; stays where one
  /// was. Edges and vertices take no factor above 1, as the faces round them have none.
  void ask(const std::vector<NamedSize>& sizes, std::vector<bool>& isUsed);

  SizedTriangles sized() const;

private:
  struct Part
  {
    std::string name;
    bool isOfDesign = true; ///< the name
    double factor = 0;      ///< 0: nothing is asked
  };

  void addParts(
    const std::vector<std::string>& names, const std::string& word, std::vector<Part>& parts);
  double factorOf(Index triangle) const;

  NamedSurface surface_;
  std::string prefix_;
  std::vector<Part> faces_;
  std::vector<std::size_t> faceOf_; ///< #triangles
  std::vector<Part> edges_;
  std::vector<Part> vertices_;
};

/// Throws InvalidInput for the first size that no name was found for, with the names that are near to it.
void refuseUnknownNames(const std::vector<NamedSize>& sizes, const std::vector<bool>& isUsed,
  const std::vector<std::string>& names);

} // namespace quadrille
