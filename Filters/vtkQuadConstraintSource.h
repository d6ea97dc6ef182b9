// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadConstraintSource
 * @brief   one constraint for vtkQuadRemesh: a line or a point with the arrays that say what is asked for
 *
 * Lines have the cell arrays `ConstraintType` (see Kinds), `GuidingWeight` and `GuidingRadius`, and the point array
 * `TargetValence`, which is 0; a valence is a vertex with its `TargetValence`; cleared features and sizes are vertices
 * with their `ConstraintType`, sizes with `SizeFactor` and `GuidingRadius`. Points need not lie on the surface. In
 * ParaView there is a source of its own for each kind, with a widget in the view.
 */
#ifndef vtkQuadConstraintSource_h
#define vtkQuadConstraintSource_h

#include "QuadrilleFiltersModule.h" // for the export macro
#include "vtkPolyDataAlgorithm.h"

#include <array>  // for the points
#include <vector> // for the points

class QUADRILLEFILTERS_EXPORT vtkQuadConstraintSource : public vtkPolyDataAlgorithm
{
public:
  static vtkQuadConstraintSource* New();
  vtkTypeMacro(vtkQuadConstraintSource, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// What is asked for; of all but valences the value of `ConstraintType`.
  enum Kinds
  {
    FEATURE_CURVE = 0,
    GUIDING_STROKE = 1,
    CONNECTION = 2,
    CYCLE = 3,
    MOVE = 4,            ///< the irregular vertex nearest to the first point goes to the last one
    VALENCE = 5,         ///< at the first point
    CLEARED_FEATURE = 6, ///< the feature curve at the first point is none
    SIZE = 7             ///< edges within Radius of the first point are Factor times as long
  };

  ///@{
  /**
   * A Kinds. Default: GUIDING_STROKE.
   */
  vtkSetClampMacro(Kind, int, FEATURE_CURVE, SIZE);
  vtkGetMacro(Kind, int);
  ///@}

  ///@{
  /**
   * Off: the output is empty, and nothing is asked for. Default: on.
   */
  vtkSetMacro(Enabled, vtkTypeBool);
  vtkGetMacro(Enabled, vtkTypeBool);
  vtkBooleanMacro(Enabled, vtkTypeBool);
  ///@}

  ///@{
  /**
   * The points, in their order. At first there is none; points that are added are at the origin.
   */
  void SetNumberOfPoints(vtkIdType number);
  vtkIdType GetNumberOfPoints() const { return static_cast<vtkIdType>(this->Points.size()); }
  void SetPoint(vtkIdType index, double x, double y, double z);
  /// The same for the first two.
  void SetPoint1(double x, double y, double z) { this->SetPoint(0, x, y, z); }
  void SetPoint2(double x, double y, double z) { this->SetPoint(1, x, y, z); }
  ///@}

  ///@{
  /**
   * Whether the line leads from its last point back to the first; cycles do always. Default: off.
   */
  vtkSetMacro(Closed, vtkTypeBool);
  vtkGetMacro(Closed, vtkTypeBool);
  vtkBooleanMacro(Closed, vtkTypeBool);
  ///@}

  ///@{
  /**
   * The number of quads that are to meet at the point of a valence, 2 to 8; on a boundary as if the quads went on
   * beyond. Default: 3.
   */
  vtkSetClampMacro(Valence, int, 2, 8);
  vtkGetMacro(Valence, int);
  ///@}

  ///@{
  /**
   * Of a guiding stroke: how strongly it is followed, above 0 and at most 1. Default: 1.
   */
  vtkSetMacro(Weight, double);
  vtkGetMacro(Weight, double);
  ///@}

  ///@{
  /**
   * Of a guiding stroke: what lies within this distance takes its direction, in units of the surface. 0: only what it
   * runs over. Of a size: the straight distance within which it is asked for; 0: at the point. Default: 0.
   */
  vtkSetMacro(Radius, double);
  vtkGetMacro(Radius, double);
  ///@}

  ///@{
  /**
   * Of a size: the edge length there over the target edge length, above 0. Default: 0.5.
   */
  vtkSetMacro(Factor, double);
  vtkGetMacro(Factor, double);
  ///@}

protected:
  vtkQuadConstraintSource();
  ~vtkQuadConstraintSource() override;

  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkQuadConstraintSource(const vtkQuadConstraintSource&) = delete;
  void operator=(const vtkQuadConstraintSource&) = delete;

  int Kind = GUIDING_STROKE;
  vtkTypeBool Enabled = 1;
  std::vector<std::array<double, 3>> Points;
  vtkTypeBool Closed = 0;
  int Valence = 3;
  double Weight = 1;
  double Radius = 0;
  double Factor = 0.5;
};

#endif
