// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sizes of quads by names: of faces (cell array PatchNames), and of edges and vertices of a CAD file (CadNames.h).
#pragma once

#include <vtkSmartPointer.h>

#include <cstddef>
#include <string>
#include <vector>

class vtkPolyData;

namespace quadrille
{

struct NamedSize
{
  std::string pattern; ///< * stands for any letters, ? for one
  double factor = 1;   ///< > 0; of the target edge length
};

/// "fillet*=0.5", one a line or with semicolons between them. Throws InvalidInput, which names the line.
std::vector<NamedSize> namedSizesOf(const std::string& text);

/// Faces, edges and vertices of a surface, with what is asked of them.
class NamedParts
{
public:
  /// prefix: may stand before all names: "bolt/" of the block "bolt", so that bolt/FACE_1 is found as well as FACE_1.
  /// Edges without a name are EDGE_n, vertices VERTEX_n, by their ids from 1, as faces are FACE_n.
  NamedParts(vtkPolyData* surface, const std::string& prefix);

  /// The names, each once, in their order: of faces, then those of edges and vertices that the file has.
  std::vector<std::string> names() const;
  /// Of several sizes of one name the last one counts. isUsed: of each size, whether a name was found; stays where one
  /// was. Edges and vertices take no factor above 1, as the faces round them have none.
  void ask(const std::vector<NamedSize>& sizes, std::vector<bool>& isUsed);

  /// The surface with triangles that are short beside what has a size, so that sizes end there, and the point array
  /// Sizing: at each point the smallest of what is asked of the faces, edges and vertices there, of the array that the
  /// surface has, and of 1 for a face that nothing is asked of. The surface itself where nothing is asked. Throws
  /// InvalidInput where a cell is no triangle.
  vtkSmartPointer<vtkPolyData> sized() const;

private:
  struct Part
  {
    std::string name;
    bool isOfFile = true; ///< the name
    double factor = 0;    ///< 0: nothing is asked
  };

  vtkPolyData* surface_;
  std::string prefix_;
  std::vector<Part> faces_;
  std::vector<std::size_t> faceOf_; ///< #cells
  std::vector<Part> edges_;
  std::vector<Part> vertices_;
};

/// Throws InvalidInput for the first size that no name was found for, with the names that are near to it.
void refuseUnknownNames(const std::vector<NamedSize>& sizes, const std::vector<bool>& isUsed,
  const std::vector<std::string>& names);

} // namespace quadrille
