// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadElements
 * @brief   quads as elements for simulation, of first or second order
 *
 * Input port 0 takes quads, as of vtkQuadRemesh. Port 1 takes the surface that they were made of, for elements of second
 * order: the input of vtkQuadRemesh, or its output 1, the mapped surface, which also has the curves that were drawn and
 * is without the handles and holes that were closed.
 *
 * Output 0 is a vtkUnstructuredGrid of VTK_QUAD, VTK_QUADRATIC_QUAD or VTK_BIQUADRATIC_QUAD with the points of the
 * quads, by their ids, and behind them the nodes of edges and of centres; with all arrays of the quads. Nodes lie on the
 * surface, on features and boundaries on their curves, see Extraction/SecondOrder.h. Where an element would be folded at
 * a node or Gauss point, nodes move back towards the middle of the straight edge; the point array MovedBack has 0 where
 * a node stayed, 1 where it moved along the surface or curve, 2 where it left it. Point arrays at new nodes are those of
 * the same name of the surface there, others the mean of the corners; Valence is 0.
 *
 * Field data: ElementOrder; of second order NodesPerElement, NodesMovedAlong, NodesMovedOff, NodesByNearest,
 * EdgesWithoutCurve, InvertedElements.
 */
#ifndef vtkQuadElements_h
#define vtkQuadElements_h

#include "vtkQuadrilleAlgorithm.h"

class vtkUnstructuredGrid;

class QUADRILLEFILTERS_EXPORT vtkQuadElements : public vtkQuadrilleAlgorithm
{
public:
  static vtkQuadElements* New();
  vtkTypeMacro(vtkQuadElements, vtkQuadrilleAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Orders
  {
    FIRST = 1,
    SECOND = 2
  };

  ///@{
  /// The surface, needed for second order.
  void SetSurfaceConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(1, output); }
  void SetSurfaceData(vtkDataObject* surface) { this->SetInputDataObject(1, surface); }
  ///@}

  /// Output 0, of an input that is no composite data; else null.
  vtkUnstructuredGrid* GetElements();

  ///@{
  /**
   * An Orders. Default: FIRST.
   */
  vtkSetClampMacro(Order, int, FIRST, SECOND);
  vtkGetMacro(Order, int);
  void SetOrderToFirst() { this->SetOrder(FIRST); }
  void SetOrderToSecond() { this->SetOrder(SECOND); }
  ///@}

  ///@{
  /**
   * Nodes of an element of second order: 8 (serendipity) or 9 (Lagrange). Default: 8.
   */
  vtkSetClampMacro(NodesPerElement, int, 8, 9);
  vtkGetMacro(NodesPerElement, int);
  ///@}

  ///@{
  /**
   * Cell array of the surface whose borders are features, as in vtkQuadRemesh; "" for none. Default: PatchId.
   */
  vtkSetStdStringFromCharMacro(PatchArrayName);
  vtkGetCharFromStdStringMacro(PatchArrayName);
  ///@}

protected:
  vtkQuadElements();
  ~vtkQuadElements() override;

  PortRole GetPortRole(int port) const override;
  const char* GetBlockType(int outputPort) const override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  void AddSettings(std::ostream& os) const override;
  void Execute(quadrille::Block& block) override;

private:
  vtkQuadElements(const vtkQuadElements&) = delete;
  void operator=(const vtkQuadElements&) = delete;

  vtkSmartPointer<vtkUnstructuredGrid> MakeElements(quadrille::Block& block);
  vtkSmartPointer<vtkUnstructuredGrid> MakeSecondOrder(vtkPolyData* quads, vtkPolyData* surface);

  int Order = FIRST;
  int NodesPerElement = 8;
  std::string PatchArrayName = "PatchId";
};

#endif
