// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadrillePLYReader
 * @brief   reads PLY files with all properties of their vertices and faces
 *
 * Text and binary, both byte orders. Each scalar property becomes a point or cell array of its own type and name (vtkPLYReader keeps a few
 * only, and patch ids of CAD surfaces are not among them); nx ny nz become Normals, red green blue (alpha) RGB or RGBA, pairs of
 * texture coordinates TCoords, and `tristrips` triangle strips. A file that is damaged is an error that names the line of the header or
 * the element; the output is empty then.
 */
#ifndef vtkQuadrillePLYReader_h
#define vtkQuadrillePLYReader_h

#include "QuadrilleFiltersModule.h" // for the export macro
#include "vtkPolyDataAlgorithm.h"

#include <string> // for std::string

class QUADRILLEFILTERS_EXPORT vtkQuadrillePLYReader : public vtkPolyDataAlgorithm
{
public:
  static vtkQuadrillePLYReader* New();
  vtkTypeMacro(vtkQuadrillePLYReader, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to read. Default: none.
   */
  void SetFileName(const char* name);
  const char* GetFileName() { return this->FileName.c_str(); }
  ///@}

  /// Whether the file begins as a PLY file does.
  static int CanReadFile(const char* name);

  /// Why the last execution gave nothing; empty after success.
  const char* GetOutcomeText() { return this->OutcomeText.c_str(); }

protected:
  vtkQuadrillePLYReader();
  ~vtkQuadrillePLYReader() override;

  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkQuadrillePLYReader(const vtkQuadrillePLYReader&) = delete;
  void operator=(const vtkQuadrillePLYReader&) = delete;

  std::string FileName;
  std::string OutcomeText;
};

#endif
