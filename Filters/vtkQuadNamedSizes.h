// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadNamedSizes
 * @brief   sizes of quads by names of faces, edges and vertices
 *
 * The input is a triangle surface whose cell array `PatchNames` has names of faces, as that of vtkQuadrilleCADReader,
 * or a composite data set of such ones. The output is the same surface with the point array `Sizing`, by which
 * vtkQuadRemesh multiplies the target edge length; triangles beside what has a size are split, so that sizes end there,
 * which does not change the shape.
 */
#ifndef vtkQuadNamedSizes_h
#define vtkQuadNamedSizes_h

#include "QuadrilleFiltersModule.h" // for the export macro
#include "vtkPassInputTypeAlgorithm.h"

#include <string> // for std::string

class QUADRILLEFILTERS_EXPORT vtkQuadNamedSizes : public vtkPassInputTypeAlgorithm
{
public:
  static vtkQuadNamedSizes* New();
  vtkTypeMacro(vtkQuadNamedSizes, vtkPassInputTypeAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * One size a line (or with semicolons between them): a name, = and a factor of the target edge length, "fillet*=0.5".
   * In names * stands for any letters and ? for one. Names of faces are those of `PatchNames`; CAD edges and vertices
   * without a name are EDGE_n and VERTEX_n by their ids from 1, and take factors up to 1. Of several sizes of one name
   * the last one counts; where faces, edges and vertices meet, the smallest. A name of a block and a slash may stand
   * before a name. A name that nothing has is an error, which lists near ones. Default: none.
   */
  void SetSizes(const char* sizes);
  const char* GetSizes() { return this->Sizes.c_str(); }
  ///@}

  ///@{
  /**
   * The same, one by one: a name and the factor as text, behind those that are there; none.
   */
  void AddSize(const char* name, const char* factor);
  void ClearSizes() { this->SetSizes(""); }
  ///@}

  /// Why the last execution gave nothing; empty after success.
  const char* GetOutcomeText() { return this->OutcomeText.c_str(); }

protected:
  vtkQuadNamedSizes();
  ~vtkQuadNamedSizes() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkQuadNamedSizes(const vtkQuadNamedSizes&) = delete;
  void operator=(const vtkQuadNamedSizes&) = delete;

  void Execute(vtkDataObject* input, vtkDataObject* output) const;

  std::string Sizes;
  std::string OutcomeText;
};

#endif
