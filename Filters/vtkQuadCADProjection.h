// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadCADProjection
 * @brief   nodes of quads, put from the triangles onto the exact shape of the CAD file
 *
 * The input is quads, or elements of second order, that were made on a surface of vtkQuadrilleCADReader: the exact
 * shape is in their field data. The output has the same cells; a node on the polyline of a followed or free edge goes
 * onto the curve of that edge, one on a vertex of the shape onto that, all others onto the surface of the face whose
 * triangle is nearest, without leaving this face. Of quads of first order one node each also moves along its edge to a
 * vertex that would have none, as where an edge of the part is divided. Nodes stay where that is not possible, and
 * where a quad would be turned over.
 *
 * The second output has a vertex for each place that is not as it should be, with the cell array `CadProblem`: 0 where
 * a corner of the shape has no node, 1 where a node stays. Of composite data all blocks are put onto their shapes, and
 * the second output, the counts and the texts are those of all together.
 *
 * Point arrays: `CadPlace` (0: the node stays, 1: on a face, 2: on an edge, 3: on a vertex), `CadId` (of the face, edge
 * or vertex; -1), `CadNormal` and `CadCurvature` (the larger and the smaller one) of the exact surface. Field data:
 * `NodesOnGeometry`, `NodesOffGeometry`.
 *
 * There where vtkQuadrilleCADReader is.
 */
#ifndef vtkQuadCADProjection_h
#define vtkQuadCADProjection_h

#include "QuadrilleFiltersModule.h" // for the export macro
#include "vtkDataObjectAlgorithm.h"

#include <string> // for std::string

class vtkPointSet;
class vtkPolyData;

class QUADRILLEFILTERS_EXPORT vtkQuadCADProjection : public vtkDataObjectAlgorithm
{
public:
  static vtkQuadCADProjection* New();
  vtkTypeMacro(vtkQuadCADProjection, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Nodes farther from the triangles than this stay, as part of the diagonal of the shape; 0: the chord error of the
   * triangles. Default: 0.
   */
  vtkSetClampMacro(Reach, double, 0.0, 1.0);
  vtkGetMacro(Reach, double);
  ///@}

  ///@{
  /// Of the last execution.
  vtkGetMacro(NodesOnGeometry, vtkIdType);
  vtkGetMacro(NodesOffGeometry, vtkIdType);
  ///@}

  /**
   * One sentence of the corners of edges without a node, with the place of the first, and its block; empty where each
   * has one. Field data CadVerticesWithoutNode has their ids.
   */
  const char* GetNoticesText() { return this->NoticesText.c_str(); }

  /// How many nodes lie on the exact shape, then NoticesText; or why the last execution gave nothing.
  const char* GetVerdict() { return this->Verdict.c_str(); }

  /// Why the last execution gave nothing; empty after success.
  const char* GetOutcomeText() { return this->OutcomeText.c_str(); }

protected:
  vtkQuadCADProjection();
  ~vtkQuadCADProjection() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkQuadCADProjection(const vtkQuadCADProjection&) = delete;
  void operator=(const vtkQuadCADProjection&) = delete;

  void Execute(vtkDataObject* input, vtkDataObject* output, vtkPolyData* problems);
  /// name: of the block; empty where there is one data set.
  void Project(
    vtkPointSet* input, const std::string& name, vtkPointSet* output, vtkPolyData* problems);
  void SetTexts();

  double Reach = 0;
  vtkIdType NodesOnGeometry = 0;
  vtkIdType NodesOffGeometry = 0;
  vtkIdType CornersWithoutNode = 0;
  std::string FirstCornerWithout; ///< its place
  std::string NoticesText;
  std::string OutcomeText;
  std::string Verdict;
};

#endif
