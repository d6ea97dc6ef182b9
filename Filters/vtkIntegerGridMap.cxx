// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIntegerGridMap.h"

#include "Base/PlaceText.h"
#include "Blocks/Blocks.h"
#include "Common/Report.h"
#include "Convert/Frame.h"
#include "Convert/PolyData.h"
#include "GridMap/GridMap.h"
#include "Pipeline/CoarsestMap.h"
#include "Pipeline/LeaveFrame.h"
#include "Pipeline/Notices.h"
#include "Pipeline/StageRecords.h"
#include "Requests/CurveRequests.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

vtkStandardNewMacro(vtkIntegerGridMap);

namespace
{

double fieldNumber(vtkPolyData* data, const char* name)
{
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  return array && array->GetNumberOfTuples() > 0 ? array->GetTuple1(0) : 0;
}

quadrille::GridMapOptions optionsFor(vtkPolyData* input, double edgeLength)
{
  quadrille::GridMapOptions options;
  options.edgeLength = edgeLength;
  if (edgeLength == 0)
  {
    options.edgeLength = fieldNumber(input, "TargetEdgeLength");
    options.targetQuads = fieldNumber(input, "TargetQuads");
  }
  // What another program has made has its sizes for their own sake.
  options.sizes = input->GetFieldData()->HasArray("SizeWish")
    ? static_cast<quadrille::SizeWish>(fieldNumber(input, "SizeWish"))
    : quadrille::SizeWish::Everywhere;
  if (!(options.edgeLength > 0))
  {
    throw quadrille::InvalidInput(
      "the input has no field array 'TargetEdgeLength'; set EdgeLength, or take "
      "the coarse output of vtkDecimationHierarchy");
  }
  return options;
}

void addIntegerVertices(vtkPolyData* data, const std::vector<std::uint8_t>& flags)
{
  vtkNew<vtkUnsignedCharArray> array;
  array->SetName(quadrille::arrays::kIntegerVertex);
  array->SetNumberOfValues(static_cast<vtkIdType>(flags.size()));
  std::copy(flags.begin(), flags.end(), array->GetPointer(0));
  data->GetPointData()->AddArray(array);
}

} // namespace

//------------------------------------------------------------------------------
vtkIntegerGridMap::vtkIntegerGridMap() = default;
vtkIntegerGridMap::~vtkIntegerGridMap() = default;

//------------------------------------------------------------------------------
void vtkIntegerGridMap::Execute(quadrille::Block& block)
{
  vtkPolyData* input = block.input();
  const quadrille::Mesh surface = quadrille::readMesh(input);
  quadrille::Mesh mesh = surface;
  const quadrille::Frame frame = quadrille::enterFrame(input, mesh);
  const quadrille::PlaceScope places(frame.centre, frame.unit, frame.sign);
  quadrille::GridMapOptions options = optionsFor(input, this->EdgeLength);
  options.edgeLength = frame.lengthOf(options.edgeLength);
  options.method = static_cast<quadrille::MapMethod>(this->Method);
  options.anisotropyLimit = this->AnisotropyLimit;
  options.guides = quadrille::readGuides(input, surface);
  for (quadrille::Guide& guide : options.guides)
  {
    guide.direction = frame.mirrored(guide.direction);
  }
  options.targetValences = quadrille::readTargetValences(input, surface);
  options.curves = quadrille::readCurveRequests(input);
  for (quadrille::CurveRequest& curve : options.curves)
  {
    for (quadrille::Vector3& p : curve.points)
    {
      p = frame.fromUser(p);
    }
  }
  options.progress = this->MakeProgress(0.0, 0.95);
  const bool coarsest = this->Integers == INTEGERS_COARSEST;
  if (coarsest && this->Method != METHOD_SCALE_AWARE)
  {
    throw quadrille::InvalidInput("the coarsest integers need the scale aware method");
  }
  quadrille::GridMapResult map = coarsest ? quadrille::computeCoarsestMap(mesh, options)
                                          : quadrille::computeGridMap(mesh, options);

  quadrille::StageRecords stages;
  const std::size_t faces = mesh.faceCount();
  stages.add("field", map.secondsField, faces, faces);
  stages.add("seamless", map.secondsSeamless, faces, faces);
  stages.add("quantize", map.secondsQuantize, faces, faces);
  stages.add("embed", map.secondsEmbed, faces, faces);
  this->SetStageRecords(stages.all());
  this->SetCertificate(map.certificate);
  quadrille::requireOk(map.status, "the map of the coarse level");
  for (const std::string& notice : { quadrille::refinementNotice(map.refinement),
         quadrille::anisotropyNotice(map.beyondAnisotropyLimit, options.anisotropyLimit) })
  {
    if (!notice.empty())
    {
      this->AddNotice(notice);
    }
  }

  for (std::size_t i = 0; i < map.curves.size(); ++i)
  {
    if (!map.curves[i].met)
    {
      this->AddNotice(
        quadrille::curveText(options.curves[i], i) + " is not met: " + map.curves[i].why);
    }
  }

  // The mesh is written anew: a map belongs to corners, and strips or split points have none.
  vtkPolyData* output = block.output();
  output->ShallowCopy(quadrille::writeMesh(surface));
  if (input->GetNumberOfPoints() == output->GetNumberOfPoints())
  {
    output->GetPointData()->PassData(input->GetPointData());
  }
  output->GetCellData()->PassData(input->GetCellData());
  output->GetFieldData()->PassData(input->GetFieldData());
  addIntegerVertices(output, quadrille::integerVertices(mesh, map.field));
  if (frame.reversed)
  {
    quadrille::reverseMap(map.uv);
    quadrille::reverseMatching(map.field.matching);
  }
  quadrille::addMap(output, map.uv);
  quadrille::addMatching(output, map.field.matching);
  quadrille::addTurns(output, surface, map.field.turns);
  quadrille::addFields(output, quadrille::stageFields(stages.all()));
  quadrille::addFields(output, quadrille::certificateFields(map.certificate));
  quadrille::addFields(output, quadrille::methodFields(options.method));
  quadrille::addFields(
    output, quadrille::anisotropyFields(options.anisotropyLimit, map.beyondAnisotropyLimit));
  if (map.certificate.notPositive > 0)
  {
    const std::string text = std::string("the method '") + quadrille::nameOf(options.method) +
      "' gives no guarantee: " + std::to_string(map.certificate.notPositive) + " of " +
      std::to_string(map.certificate.triangles) + " triangles are inverted or degenerate";
    this->AddNotice(text);
    vtkWarningMacro(<< text);
  }
}

//------------------------------------------------------------------------------
void vtkIntegerGridMap::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "EdgeLength: " << this->EdgeLength << "\n";
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Integers: " << this->Integers << "\n";
  os << indent << "AnisotropyLimit: " << this->AnisotropyLimit << "\n";
}
