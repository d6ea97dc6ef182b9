// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadrilleSTLReader
 * @brief   reads binary STL files by several threads
 *
 * Equal points are joined, as vtkSTLReader does it, in the same order, and triangles with a point twice are left out;
 * ids have 32 bits. Files whose length is not that of their triangles, text among them, are for vtkSTLReader:
 * CanReadFile tells. A file that is damaged is an error; the output is empty then.
 */
#ifndef vtkQuadrilleSTLReader_h
#define vtkQuadrilleSTLReader_h

#include "vtkQuadrilleFileReader.h"

class QUADRILLEFILTERS_EXPORT vtkQuadrilleSTLReader : public vtkQuadrilleFileReader
{
public:
  static vtkQuadrilleSTLReader* New();
  vtkTypeMacro(vtkQuadrilleSTLReader, vtkQuadrilleFileReader);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Whether the file is as long as the triangles that it announces.
  static int CanReadFile(const char* name);

protected:
  vtkQuadrilleSTLReader();
  ~vtkQuadrilleSTLReader() override;

  vtkSmartPointer<vtkPolyData> ReadSurface(const std::string& path) override;

private:
  vtkQuadrilleSTLReader(const vtkQuadrilleSTLReader&) = delete;
  void operator=(const vtkQuadrilleSTLReader&) = delete;
};

#endif
