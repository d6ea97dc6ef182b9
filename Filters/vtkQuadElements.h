// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadElements
 * @brief   quads as elements for simulation, of first or second order
 *
 * Input port 0 takes quads, as of vtkQuadRemesh. Port 1 takes the surface that they were made of, for elements of
 * second order: the input of vtkQuadRemesh, or its output 1, the mapped surface, which also has the curves that were
 * drawn and is without the handles and holes that were closed.
 *
 * Output 0 is a vtkUnstructuredGrid of VTK_QUAD, VTK_QUADRATIC_QUAD or VTK_BIQUADRATIC_QUAD with the points of the
 * quads, by their ids, and behind them the nodes of edges and of centres; with all arrays of the quads. Nodes lie on
 * the surface, on features and boundaries on their curves, see Elements/SecondOrder.h. Where an element would be
 * folded at a node or Gauss point, nodes move back towards the middle of the straight edge; the point array MovedBack
 * has 0 where a node stayed, 1 where it moved along the surface or curve, 2 where it left it. Point arrays at new nodes
 * are those of the same name of the surface there, others the mean of the corners; Valence is 0.
 *
 * On request the cell arrays ScaledJacobian, AspectRatio, Skew, Warpage, Taper, EdgeRatio, MinimumAngle and
 * MaximumAngle are added, as Verdict defines them (vtkMeshQuality), of the quad of the corners; Thickness, ElementAxis,
 * and vectors in the frame of each element.
 *
 * Output 1 is a vtkTable with the histograms of the measures: columns <Measure>From, <Measure>To, <Measure>Elements.
 * Output 2 is a vtkPolyData with vertices at the worst elements: point arrays ElementId, Measure, Value.
 *
 * Field data: ElementOrder; of second order NodesPerElement, NodesMovedAlong, NodesMovedOff, NodesByNearest,
 * EdgesWithoutCurve, InvertedElements; with requirements Requirements (text) and FailedElements, a number each.
 */
#ifndef vtkQuadElements_h
#define vtkQuadElements_h

#include "vtkQuadrilleAlgorithm.h"

class vtkTable;
class vtkUnstructuredGrid;

namespace quadrille
{
struct ElementRequirement;
}

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

  ///@{
  /// Outputs 0, 1 and 2, of an input that is no composite data; else null.
  vtkUnstructuredGrid* GetElements();
  vtkTable* GetHistograms();
  vtkPolyData* GetWorstElements();
  ///@}

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

  ///@{
  /**
   * Whether to add the measures of quality as cell arrays, and to fill outputs 1 and 2. Default: off.
   */
  vtkSetMacro(Quality, vtkTypeBool);
  vtkGetMacro(Quality, vtkTypeBool);
  vtkBooleanMacro(Quality, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Parts of the range of a measure in its histogram, from 1 to 10000. Default: 20.
   */
  vtkSetClampMacro(HistogramBins, int, 1, 10000);
  vtkGetMacro(HistogramBins, int);
  ///@}

  enum Measures
  {
    SCALED_JACOBIAN = 0,
    ASPECT_RATIO,
    SKEW,
    WARPAGE,
    TAPER,
    EDGE_RATIO,
    MINIMUM_ANGLE,
    MAXIMUM_ANGLE
  };

  ///@{
  /**
   * The measure by which the worst elements are told beside those of requirements, a Measures. Default:
   * SCALED_JACOBIAN.
   */
  vtkSetClampMacro(WorstMeasure, int, SCALED_JACOBIAN, MAXIMUM_ANGLE);
  vtkGetMacro(WorstMeasure, int);
  ///@}

  ///@{
  /**
   * How many of the worst elements are told of each measure, 0 or more. Default: 10.
   */
  vtkSetClampMacro(NumberOfWorst, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfWorst, int);
  ///@}

  ///@{
  /**
   * Limits that all elements have to keep: a measure, <, <=, > or >=, and a number, as in "scaled-jacobian>0.2".
   * Measures are scaled-jacobian, aspect-ratio, skew, warpage, taper, edge-ratio, minimum-angle and maximum-angle,
   * angles in degrees. A value that is no number keeps none. Elements that do not are counted and told by a warning
   * with the worst places; the outputs are made all the same. Default: none.
   */
  void AddRequirement(const char* text);
  void RemoveAllRequirements();
  int GetNumberOfRequirements() { return static_cast<int>(this->Requirements.size()); }
  const char* GetRequirement(int i);
  ///@}
  /// Why a text is no requirement; empty where it is one.
  static std::string GetRequirementError(const char* text);
  /// Elements that fail at least one requirement in the last execution.
  vtkIdType GetNumberOfFailedElements() const;

  ///@{
  /**
   * A cell or point array of the quads with one number that becomes the cell array Thickness: of cells as it is, which
   * is the mean by area where the quads were made with CellDataFrom Area, of points the mean over the element. "", the
   * default: none.
   */
  vtkSetStdStringFromCharMacro(ThicknessArrayName);
  vtkGetCharFromStdStringMacro(ThicknessArrayName);
  ///@}

  ///@{
  /**
   * A cell or point array of the quads with three numbers, as GuidingDirection, that becomes the cell array
   * ElementAxis: its direction in the plane of the element, of the length 1. The plane is that of the normal at the
   * centre of the quad of the corners. "", the default: none.
   */
  vtkSetStdStringFromCharMacro(AxisArrayName);
  vtkGetCharFromStdStringMacro(AxisArrayName);
  ///@}

  enum AxisFallbacks
  {
    AXIS_REQUIRED = 0, ///< an error
    AXIS_X,
    AXIS_Y,
    AXIS_Z,
    AXIS_OF_ELEMENT ///< from the middle of its edge 3 to that of its edge 1
  };

  ///@{
  /**
   * What elements get whose direction is zero or along the normal, an AxisFallbacks; how many they are is told.
   * Default: AXIS_REQUIRED.
   */
  vtkSetClampMacro(AxisFallback, int, AXIS_REQUIRED, AXIS_OF_ELEMENT);
  vtkGetMacro(AxisFallback, int);
  ///@}

  ///@{
  /**
   * Cell or point arrays of the quads with three numbers whose components in the frame of the element become the cell
   * array <name>InElement. Axis 1 of the frame is ElementAxis where AxisArrayName is given, else the direction from the
   * middle of the element's edge 3 to that of edge 1; axis 3 is the normal, axis 2 = axis 3 x axis 1. The array itself
   * stays. Of a point array the mean over the element counts. Default: none.
   */
  void AddVectorArrayName(const char* name);
  void RemoveAllVectorArrayNames();
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
  void AddProperties(vtkUnstructuredGrid* grid);
  void Measure(vtkUnstructuredGrid* grid,
    const std::vector<quadrille::ElementRequirement>& requirements, quadrille::Block& block);

  int Order = FIRST;
  int NodesPerElement = 8;
  std::string PatchArrayName = "PatchId";
  vtkTypeBool Quality = 0;
  int HistogramBins = 20;
  int WorstMeasure = SCALED_JACOBIAN;
  int NumberOfWorst = 10;
  std::vector<std::string> Requirements;
  std::string ThicknessArrayName;
  std::string AxisArrayName;
  int AxisFallback = AXIS_REQUIRED;
  std::vector<std::string> VectorArrayNames;
};

#endif
