// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIntegerGridMap
 * @brief   the integer-grid map of the coarse level: cross field, seamless map, quantization, embedding
 *
 * Input: output 0 of vtkDecimationHierarchy, or any clean triangle mesh when EdgeLength is set; cell arrays
 * `GuidingDirection`, `GuidingWeight` and the point arrays `TargetValence` and `Sizing` are honoured as
 * vtkQuadrilleSurfaceAlgorithm says. Output: the same mesh with `IGM` (cells, double, 6: u0 v0 u1 v1 u2 v2, one unit a
 * quad), `Matching` (cells, 3: quarter turns of the transition across each edge), `Determinant` (cells: twice the uv
 * area, positive when valid), and on points `Turns` (quarter turns of the map), `Index` (0 where regular) and
 * `IntegerVertex`. Field data: certificate and stage times.
 */
#ifndef vtkIntegerGridMap_h
#define vtkIntegerGridMap_h

#include "vtkQuadrilleAlgorithm.h"

class QUADRILLEFILTERS_EXPORT vtkIntegerGridMap : public vtkQuadrilleAlgorithm
{
public:
  static vtkIntegerGridMap* New();
  vtkTypeMacro(vtkIntegerGridMap, vtkQuadrilleAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The values of Method, see there.
  enum Methods
  {
    METHOD_SCALE_AWARE = 0,
    METHOD_MIXED_INTEGER = 1,
    METHOD_QUADCOVER = 2,
    METHOD_SEAMLESS = 3
  };

  ///@{
  /**
   * How the map of the coarse level is made, a Methods. Scale aware never inverts a triangle. Mixed integer
   * [Bommes et al. 2009] rounds integers one at a time, QuadCover [Kalberer et al. 2007] all at once: both
   * may leave inverted triangles, which a notice counts, and then there may be no quads. Seamless has no
   * integers and cannot be given quads. Default: METHOD_SCALE_AWARE.
   */
  vtkSetClampMacro(Method, int, METHOD_SCALE_AWARE, METHOD_SEAMLESS);
  vtkGetMacro(Method, int);
  void SetMethodToScaleAware() { this->SetMethod(METHOD_SCALE_AWARE); }
  void SetMethodToMixedInteger() { this->SetMethod(METHOD_MIXED_INTEGER); }
  void SetMethodToQuadCover() { this->SetMethod(METHOD_QUADCOVER); }
  void SetMethodToSeamless() { this->SetMethod(METHOD_SEAMLESS); }
  ///@}

  /// The values of Integers, see there.
  enum IntegersTypes
  {
    INTEGERS_KEEP_SIZES = 0,
    INTEGERS_COARSEST = 1
  };

  ///@{
  /**
   * What the whole numbers of the map aim at, an IntegersTypes: quads of the size asked for, or the coarsest layout,
   * with integers as small as a map can have whose quads are the surface. The size then sets only what the coarse level
   * keeps. Needs METHOD_SCALE_AWARE. Default: INTEGERS_KEEP_SIZES.
   */
  vtkSetClampMacro(Integers, int, INTEGERS_KEEP_SIZES, INTEGERS_COARSEST);
  vtkGetMacro(Integers, int);
  void SetIntegersToKeepSizes() { this->SetIntegers(INTEGERS_KEEP_SIZES); }
  void SetIntegersToCoarsest() { this->SetIntegers(INTEGERS_COARSEST); }
  ///@}

  ///@{
  /**
   * The ratio of the two stretches of a triangle of the coarse level, against the sizes asked for, from which on the
   * map gives way to bring it down, at the price of quads that differ more in size. At least 1; 0 means no limit. Whole
   * numbers, features and irregular vertices may keep it from being met: the share of the area beyond it is told in the
   * field data. Not with METHOD_MIXED_INTEGER and METHOD_QUADCOVER. Default: 0.
   */
  vtkSetMacro(AnisotropyLimit, double);
  vtkGetMacro(AnisotropyLimit, double);
  ///@}

  ///@{
  /**
   * Target edge length in units of the input; 0, the default, takes `TargetEdgeLength` and `TargetQuads` from the
   * input's field data.
   */
  vtkSetClampMacro(EdgeLength, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(EdgeLength, double);
  ///@}

protected:
  vtkIntegerGridMap();
  ~vtkIntegerGridMap() override;

  PortRole GetPortRole(int) const override { return PortRole::Mesh; }
  void Execute(quadrille::Block& block) override;

private:
  vtkIntegerGridMap(const vtkIntegerGridMap&) = delete;
  void operator=(const vtkIntegerGridMap&) = delete;

  double EdgeLength = 0;
  int Method = METHOD_SCALE_AWARE;
  int Integers = INTEGERS_KEEP_SIZES;
  double AnisotropyLimit = 0;
};

#endif
