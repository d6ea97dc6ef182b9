// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadrilleOFFReader
 * @brief   reads OFF files with normals, colours and texture coordinates
 *
 * The text form of the Object File Format in three dimensions, with any of the prefixes ST, C and N. Normals and
 * texture coordinates become the point arrays Normals and TCoords, colours of vertices and of faces RGB or RGBA, and an
 * index in place of a face's colour the cell array ColorIndex. A file that is damaged is an error that names the vertex
 * or the face; the output is empty then.
 */
#ifndef vtkQuadrilleOFFReader_h
#define vtkQuadrilleOFFReader_h

#include "vtkQuadrilleFileReader.h"

class QUADRILLEFILTERS_EXPORT vtkQuadrilleOFFReader : public vtkQuadrilleFileReader
{
public:
  static vtkQuadrilleOFFReader* New();
  vtkTypeMacro(vtkQuadrilleOFFReader, vtkQuadrilleFileReader);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Whether the first word of the file, after comments, is that of an OFF file.
  static int CanReadFile(const char* name);

protected:
  vtkQuadrilleOFFReader();
  ~vtkQuadrilleOFFReader() override;

  vtkSmartPointer<vtkPolyData> ReadSurface(const std::string& path) override;

private:
  vtkQuadrilleOFFReader(const vtkQuadrilleOFFReader&) = delete;
  void operator=(const vtkQuadrilleOFFReader&) = delete;
};

#endif
