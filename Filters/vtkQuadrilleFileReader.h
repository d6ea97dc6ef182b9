// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadrilleFileReader
 * @brief   what the readers of surfaces share: the name of the file, and what went wrong
 *
 * A file that is damaged is an error that names the file and the place in it; the output is empty then.
 */
#ifndef vtkQuadrilleFileReader_h
#define vtkQuadrilleFileReader_h

#include "QuadrilleFiltersModule.h" // for the export macro
#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h" // for the result of ReadSurface

#include <string> // for std::string

class QUADRILLEFILTERS_EXPORT vtkQuadrilleFileReader : public vtkPolyDataAlgorithm
{
public:
  vtkTypeMacro(vtkQuadrilleFileReader, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to read. Default: none.
   */
  void SetFileName(const char* name);
  const char* GetFileName() { return this->FileName.c_str(); }
  ///@}

  ///@{
  /**
   * Threads to read with; 0 means all. The result does not depend on it. Default: 0.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 4096);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  /**
   * Why VTK's reader of .stl, .vtp and .vtu should not be asked for a file: its headers announce more than its bytes
   * can hold, for which these readers ask for memory, or count, before they look. Empty for all other files.
   */
  static std::string GetHeaderError(const char* path);

  /**
   * Versions of vtkOBJReader give points in single precision, in double precision, or in either by the file. Gives
   * those of a surface that one of them has read the digits of the file, in double precision. False where that cannot
   * be: points are one in single precision, and the reader has made copies of some at seams of textures.
   */
  static bool RestoreObjDigits(vtkPolyData* surface, const char* path);

  /**
   * A new reader of VTK's XML files of polygons (.vtp), or for other extensions of unstructured grids (.vtu), which
   * reads appended data with any libexpat. VTK's own ones up to 9.3.0 cannot with that of Debian 12 and its security
   * updates.
   */
  VTK_NEWINSTANCE
  static vtkAlgorithm* NewXMLReader(const char* extension);

  /// Why the last execution gave nothing; empty after success.
  const char* GetOutcomeText() { return this->OutcomeText.c_str(); }

protected:
  vtkQuadrilleFileReader();
  ~vtkQuadrilleFileReader() override;

  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  int NumberOfThreads = 0;

  /// The surface in the file; throws a std::exception whose text names the file and the place.
  virtual vtkSmartPointer<vtkPolyData> ReadSurface(const std::string& path) = 0;

private:
  vtkQuadrilleFileReader(const vtkQuadrilleFileReader&) = delete;
  void operator=(const vtkQuadrilleFileReader&) = delete;

  std::string FileName;
  std::string OutcomeText;
};

#endif
