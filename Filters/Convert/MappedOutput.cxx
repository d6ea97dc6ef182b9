// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/MappedOutput.h"

#include "Common/Report.h"
#include "Convert/Frame.h"
#include "GridMap/Certificate.h"

#include <vtkNew.h>
#include <vtkPolyData.h>

namespace quadrille
{

//------------------------------------------------------------------------------
vtkPolyData* MappedOutput::sameTriangles(const RemeshResult& result, vtkPolyData* from) const
{
  return surface && triangles == result.surface.hash && reversed == result.frame.reversed &&
      cells == cellStamps(from)
    ? surface
    : nullptr;
}

//------------------------------------------------------------------------------
std::vector<Stamp> MappedOutput::cellStamps(vtkPolyData* data)
{
  vtkNew<vtkPolyData> cells;
  cells->SetVerts(data->GetVerts());
  cells->SetLines(data->GetLines());
  cells->SetPolys(data->GetPolys());
  cells->SetStrips(data->GetStrips());
  std::vector<Stamp> stamps;
  addStamps(cells, stamps);
  return stamps;
}

//------------------------------------------------------------------------------
ResultKey MappedOutput::mapFor(vtkPolyData* other, vtkTypeBool withTextureCoordinates) const
{
  return other == input && other->GetMTime() == inputTime &&
      withTextureCoordinates == textureCoordinates
    ? map
    : 0;
}

//------------------------------------------------------------------------------
void writeMapped(const RemeshResult& result, const RemeshOptions& options,
  const MappedSource& source, vtkPolyData* mapped)
{
  mapped->ShallowCopy(writeMappedSurface(result.surface, result.uv,
    matchingOf(result.surface.mesh, result.uv, options.threads), result.turns, source.input,
    *source.converted, source.textureCoordinates, options.threads, nullptr, source.earlier));
  if (!result.framePositions.empty()) // of sheets that were moved there are none
  {
    addFrame(mapped, result.frame, result.framePositions);
  }
  addFields(mapped, methodFields(options.method));
  addFields(mapped, anisotropyFields(options.anisotropyLimit, result.beyondAnisotropyLimit));
  addFields(mapped, certificateFields(result.certificate));
  addCount(mapped, "Charts", result.charts.charts);
  addCount(mapped, "SeamEdges", result.charts.seamEdges);
}

} // namespace quadrille
