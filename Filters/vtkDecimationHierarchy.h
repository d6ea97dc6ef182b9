// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDecimationHierarchy
 * @brief   the levels of a surface: input, intermediate, coarse, and the log that joins them
 *
 * Inputs and properties: see vtkQuadrilleSurfaceAlgorithm. Outputs:
 *
 * 0. the coarse level, for vtkIntegerGridMap. Points: `FineVertex`, and `TargetValence` and `Sizing` where they are
 *    asked for; cells: `FineFace`, `FeatureEdges`, and `GuidingDirection` with `GuidingWeight` where there are guides;
 *    field data: `TargetEdgeLength`, `TargetQuads`, `SizeWish` (where sizes are asked for: 0 nowhere, 1 everywhere, 2
 *    at places), stage times, repair counts, `Notices`.
 * 1. the intermediate level, with the same arrays.
 * 2. the log, for vtkIntegerGridMapUpmap: a table without columns, the bytes in the field array `DecimationLog`, bound
 *    to the surface by `SurfaceHash`. It has a port of its own so that it never travels with a picture.
 * Moves of irregular vertices and connections are refused: they need quads without them, as vtkQuadRemesh makes them.
 */
#ifndef vtkDecimationHierarchy_h
#define vtkDecimationHierarchy_h

#include "vtkQuadrilleSurfaceAlgorithm.h"

class QUADRILLEFILTERS_EXPORT vtkDecimationHierarchy : public vtkQuadrilleSurfaceAlgorithm
{
public:
  static vtkDecimationHierarchy* New();
  vtkTypeMacro(vtkDecimationHierarchy, vtkQuadrilleSurfaceAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether the filter holds on to what each stage has made, so that a change begins where it enters: guides and the
   * number of coarse vertices at phase 2 of the decimation, the size of the quads at the refinement. Contents are
   * compared, not times; the levels are the same as without. About 130 bytes a triangle; nothing where the machine has
   * no room for that, which a notice says. Off lets all go. Default: on.
   */
  void SetKeepLevels(vtkTypeBool on);
  vtkGetMacro(KeepLevels, vtkTypeBool);
  vtkBooleanMacro(KeepLevels, vtkTypeBool);
  ///@}

  /// The values of DecimationCost, see there.
  enum DecimationCostType
  {
    COST_GAUSSIAN = 0,
    COST_GAUSSIAN_MEMORY,
    COST_QUADRIC,
    COST_UNIFORM
  };

  ///@{
  /**
   * What the removal of a vertex costs on the way from the intermediate to the coarse level, a DecimationCostType
   * [Ebke et al. 2016, Section 5.1]: the change of Gaussian curvature against the level so far (E_G) or against the
   * surface (E_G,mem), the quadric error (E_QEM), the length of the shortest edge (E_uni). The last two concentrate
   * curvature at single vertices, and are there to compare with. Default: COST_GAUSSIAN.
   */
  vtkSetClampMacro(DecimationCost, int, COST_GAUSSIAN, COST_UNIFORM);
  vtkGetMacro(DecimationCost, int);
  ///@}

  /**
   * Names of the stages that the last execution took over; empty where it began from nothing.
   */
  const char* GetReusedStagesText() const { return this->GetReusedStages(); }

protected:
  vtkDecimationHierarchy();
  ~vtkDecimationHierarchy() override;

  const char* GetBlockType(int outputPort) const override;
  void AddSettings(std::ostream& os) const override;
  void Execute(quadrille::Block& block) override;

private:
  vtkDecimationHierarchy(const vtkDecimationHierarchy&) = delete;
  void operator=(const vtkDecimationHierarchy&) = delete;

  vtkTypeBool KeepLevels = 1;
  int DecimationCost = COST_GAUSSIAN;
};

#endif
