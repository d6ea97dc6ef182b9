// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadExtraction
 * @brief   the quads of a surface with an integer-grid map
 *
 * Input: a triangle surface with the cell array `IGM` (vtkIntegerGridMapUpmap, output 1 of vtkQuadRemesh, or the coarse
 * level of vtkIntegerGridMap). Outputs: 0 the quads, 1 the feature and boundary lines, both as from vtkQuadRemesh.
 */
#ifndef vtkQuadExtraction_h
#define vtkQuadExtraction_h

#include "vtkQuadrilleAlgorithm.h"

class QUADRILLEFILTERS_EXPORT vtkQuadExtraction : public vtkQuadrilleAlgorithm
{
public:
  static vtkQuadExtraction* New();
  vtkTypeMacro(vtkQuadExtraction, vtkQuadrilleAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The filter refuses, before memory is spent, to make more quads than this; at least 1. Default: ten million.
   */
  vtkSetMacro(MaximumNumberOfQuads, vtkIdType);
  vtkGetMacro(MaximumNumberOfQuads, vtkIdType);
  ///@}

  ///@{
  /**
   * Name of the cell array with patch ids, for the pairs that feature lines separate; may be missing.
   * Default: "PatchId".
   */
  void SetPatchArrayName(const char* name);
  const char* GetPatchArrayName() { return this->PatchArrayName.c_str(); }
  ///@}

  /// Output 1.
  vtkPolyData* GetLines();

protected:
  vtkQuadExtraction();
  ~vtkQuadExtraction() override;

  void Execute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkQuadExtraction(const vtkQuadExtraction&) = delete;
  void operator=(const vtkQuadExtraction&) = delete;

  vtkIdType MaximumNumberOfQuads = 10000000;
  std::string PatchArrayName = "PatchId";
};

#endif
