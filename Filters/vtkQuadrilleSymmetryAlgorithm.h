// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadrilleSymmetryAlgorithm
 * @brief   a filter of a surface whose quads may be their own mirror image, or their own image turned by a step
 *
 * Field data of the quads with a Symmetry: `SymmetryOrigin` and `SymmetryNormal` of the plane, or `SymmetryOrigin`,
 * `SymmetryDirection` and `SymmetryOrder` of the rotation, `SymmetryDeviation` (2: root of the mean square and maximum
 * of the distance of the surface's mirror image, or of the turned surface, over the diagonal of its box),
 * `SymmetryMovedPoints` and `SymmetryFarthestMoved` (points that were put onto the surface, and how far, over the
 * diagonal).
 */
#ifndef vtkQuadrilleSymmetryAlgorithm_h
#define vtkQuadrilleSymmetryAlgorithm_h

#include "vtkQuadrilleSurfaceAlgorithm.h"

class QUADRILLEFILTERS_EXPORT vtkQuadrilleSymmetryAlgorithm : public vtkQuadrilleSurfaceAlgorithm
{
public:
  vtkTypeMacro(vtkQuadrilleSymmetryAlgorithm, vtkQuadrilleSurfaceAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The values of Symmetry, see there.
  enum SymmetryTypes
  {
    SYMMETRY_NONE = 0,
    SYMMETRY_PLANE = 1,
    SYMMETRY_FOUND = 2,
    SYMMETRY_AXIS = 3,
    SYMMETRY_AXIS_FOUND = 4
  };

  ///@{
  /**
   * Whether the quads are a mirror image of themselves, a SymmetryTypes: about the plane through SymmetryOrigin with
   * SymmetryNormal, or about the plane that is found, about which the surface is nearest to its own image. The half in
   * front of the plane, where the normal points to, is remeshed, and its quads and their images are one mesh, with the
   * plane's curve on edges, or half way between edges, see PlaneCurve. Where the surface is symmetric to a millionth of
   * its diagonal points are exact images, else those behind the plane are put onto the surface. Guides, valences and
   * sizes of one side are asked of both, those in front go before; features are those in front. A surface that is not
   * nearly symmetric is an error. Each block of composite data is taken by itself. Output 1 is the half and its image.
   * Default: SYMMETRY_NONE.
   *
   * SYMMETRY_AXIS and SYMMETRY_AXIS_FOUND: quads that become themselves when they are turned by 1 / RotationOrder of a
   * whole turn round an axis, through SymmetryOrigin along SymmetryNormal, or found. A wedge is remeshed, between half
   * planes where the cut is short, which are on edges, and its quads and those turned are one mesh. Where the axis
   * meets the surface the number of quads is a multiple of the order. Of valences and guides those in the wedge go
   * before. Output 1 is the wedges side by side, not joined at the cuts.
   */
  vtkSetClampMacro(Symmetry, int, SYMMETRY_NONE, SYMMETRY_AXIS_FOUND);
  vtkGetMacro(Symmetry, int);
  void SetSymmetryToNone() { this->SetSymmetry(SYMMETRY_NONE); }
  void SetSymmetryToPlane() { this->SetSymmetry(SYMMETRY_PLANE); }
  void SetSymmetryToFound() { this->SetSymmetry(SYMMETRY_FOUND); }
  void SetSymmetryToAxis() { this->SetSymmetry(SYMMETRY_AXIS); }
  void SetSymmetryToAxisFound() { this->SetSymmetry(SYMMETRY_AXIS_FOUND); }
  ///@}

  /// The values of PlaneCurve, see there.
  enum PlaneCurveTypes
  {
    PLANE_CURVE_ISOLINE = 0,
    PLANE_CURVE_MID_LINE = 1
  };

  ///@{
  /**
   * What the quads have where a mirror plane cuts the surface, a PlaneCurveTypes: edges in the plane, or quads across
   * it, each its own image, with two corners in front and two behind. With a mid-line no point lies in the plane:
   * features there are not followed, which a notice tells with their length, and valences and curves in the plane are
   * not met. The map of output 1 has the plane's curve half way between two isolines. With a rotation a mid-line is an
   * error. Default: PLANE_CURVE_ISOLINE.
   */
  vtkSetClampMacro(PlaneCurve, int, PLANE_CURVE_ISOLINE, PLANE_CURVE_MID_LINE);
  vtkGetMacro(PlaneCurve, int);
  void SetPlaneCurveToIsoline() { this->SetPlaneCurve(PLANE_CURVE_ISOLINE); }
  void SetPlaneCurveToMidLine() { this->SetPlaneCurve(PLANE_CURVE_MID_LINE); }
  ///@}

  ///@{
  /**
   * A point of the mirror plane, in units of the input, and its normal, of any length but 0; for SYMMETRY_PLANE. For
   * SYMMETRY_AXIS a point of the axis, and its direction. Defaults: (0, 0, 0) and (1, 0, 0).
   */
  vtkSetVector3Macro(SymmetryOrigin, double);
  vtkGetVector3Macro(SymmetryOrigin, double);
  vtkSetVector3Macro(SymmetryNormal, double);
  vtkGetVector3Macro(SymmetryNormal, double);
  ///@}

  ///@{
  /**
   * The order of the rotation of SYMMETRY_AXIS and SYMMETRY_AXIS_FOUND: so many steps are a whole turn. 2 to 64.
   * Default: 2.
   */
  vtkSetClampMacro(RotationOrder, int, 2, 64);
  vtkGetMacro(RotationOrder, int);
  ///@}

protected:
  vtkQuadrilleSymmetryAlgorithm();
  ~vtkQuadrilleSymmetryAlgorithm() override;

  void AddSettings(std::ostream& os) const override;

  int Symmetry = SYMMETRY_NONE;
  int PlaneCurve = PLANE_CURVE_ISOLINE;
  double SymmetryOrigin[3] = { 0, 0, 0 };
  double SymmetryNormal[3] = { 1, 0, 0 };
  int RotationOrder = 2;

private:
  vtkQuadrilleSymmetryAlgorithm(const vtkQuadrilleSymmetryAlgorithm&) = delete;
  void operator=(const vtkQuadrilleSymmetryAlgorithm&) = delete;
};

#endif
