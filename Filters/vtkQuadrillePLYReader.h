// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadrillePLYReader
 * @brief   reads PLY files with all properties of their vertices and faces
 *
 * Text and binary, both byte orders. Each scalar property becomes a point or cell array of its own type and name
 * (vtkPLYReader keeps a few only, and patch ids of CAD surfaces are not among them); nx ny nz become Normals, red green
 * blue (alpha) RGB or RGBA, pairs of texture coordinates TCoords, and `tristrips` triangle strips. A file that is
 * damaged is an error that names the line of the header or the element; the output is empty then.
 */
#ifndef vtkQuadrillePLYReader_h
#define vtkQuadrillePLYReader_h

#include "vtkQuadrilleFileReader.h"

class QUADRILLEFILTERS_EXPORT vtkQuadrillePLYReader : public vtkQuadrilleFileReader
{
public:
  static vtkQuadrillePLYReader* New();
  vtkTypeMacro(vtkQuadrillePLYReader, vtkQuadrilleFileReader);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Whether the file begins as a PLY file does.
  static int CanReadFile(const char* name);

protected:
  vtkQuadrillePLYReader();
  ~vtkQuadrillePLYReader() override;

  vtkSmartPointer<vtkPolyData> ReadSurface(const std::string& path) override;

private:
  vtkQuadrillePLYReader(const vtkQuadrillePLYReader&) = delete;
  void operator=(const vtkQuadrillePLYReader&) = delete;
};

#endif
