// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/Heal.h"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepCheck_ListOfStatus.hxx>
#include <BRepCheck_Result.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Shape.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>

#include <cmath>
#include <map>
#include <memory>

namespace quadrille
{

namespace
{

const char* wordsOf(BRepCheck_Status status)
{
  switch (status)
  {
    case BRepCheck_InvalidPointOnCurve:
    case BRepCheck_InvalidPointOnCurveOnSurface:
    case BRepCheck_InvalidPointOnSurface:
      return "vertices off their geometry";
    case BRepCheck_No3DCurve:
    case BRepCheck_Invalid3DCurve:
    case BRepCheck_NoCurveOnSurface:
    case BRepCheck_InvalidCurveOnSurface:
    case BRepCheck_InvalidCurveOnClosedSurface:
      return "edges without a valid curve";
    case BRepCheck_InvalidSameRangeFlag:
    case BRepCheck_InvalidSameParameterFlag:
      return "edges whose curves disagree";
    case BRepCheck_InvalidDegeneratedFlag:
      return "edges wrongly called degenerate";
    case BRepCheck_FreeEdge:
      return "edges of no face";
    case BRepCheck_SelfIntersectingWire:
      return "self-intersecting borders of faces";
    case BRepCheck_IntersectingWires:
      return "borders of faces that cross each other";
    case BRepCheck_NoSurface:
      return "faces without a surface";
    case BRepCheck_InvalidWire:
    case BRepCheck_RedundantWire:
    case BRepCheck_EmptyWire:
    case BRepCheck_RedundantEdge:
    case BRepCheck_InvalidImbricationOfWires:
    case BRepCheck_NotClosed:
      return "borders that do not bound their face";
    case BRepCheck_UnorientableShape:
    case BRepCheck_BadOrientation:
    case BRepCheck_BadOrientationOfSubshape:
      return "faces of the wrong direction";
    case BRepCheck_EmptyShell:
    case BRepCheck_RedundantFace:
    case BRepCheck_NotConnected:
    case BRepCheck_InvalidImbricationOfShells:
    case BRepCheck_EnclosedRegion:
    case BRepCheck_SubshapeNotInShape:
      return "shells that do not bound their solid";
    default:
      return "elements that cannot be checked";
  }
}

/// How many faults of each kind.
std::map<std::string, int> faultsOf(const TopoDS_Shape& shape, const BRepCheck_Analyzer& check)
{
  std::map<std::string, int> counts;
  TopTools_IndexedMapOfShape all;
  TopExp::MapShapes(shape, all);
  for (int i = 1; i <= all.Extent(); ++i)
  {
    const Handle(BRepCheck_Result) result = check.Result(all(i));
    if (result.IsNull())
    {
      continue;
    }
    for (const BRepCheck_Status status : result->Status())
    {
      counts[wordsOf(status)] += status == BRepCheck_NoError ? 0 : 1;
    }
    for (result->InitContextIterator(); result->MoreShapeInContext(); result->NextShapeInContext())
    {
      for (const BRepCheck_Status status : result->StatusOnShape())
      {
        counts[wordsOf(status)] += status == BRepCheck_NoError ? 0 : 1;
      }
    }
  }
  return counts;
}

std::string listOf(const std::map<std::string, int>& counts)
{
  std::string text;
  for (const auto& [words, count] : counts)
  {
    if (count > 0)
    {
      text += (text.empty() ? "" : ", ") + words + " (" + std::to_string(count) + ")";
    }
  }
  return text;
}

/// Edges of one face, in which it does not close.
int freeEdges(const TopoDS_Shape& shape)
{
  TopTools_IndexedDataMapOfShapeListOfShape facesOf;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, facesOf);
  int count = 0;
  for (int i = 1; i <= facesOf.Extent(); ++i)
  {
    count += facesOf(i).Extent() == 1 && !BRep_Tool::Degenerated(TopoDS::Edge(facesOf.FindKey(i)));
  }
  return count;
}

void sewFreeFaces(HealedShape& healed)
{
  TopTools_IndexedMapOfShape faces, solids;
  TopExp::MapShapes(healed.shape, TopAbs_FACE, faces);
  TopExp::MapShapes(healed.shape, TopAbs_SOLID, solids);
  if (faces.Extent() < 2 || solids.Extent() > 0 || freeEdges(healed.shape) == 0)
  {
    return;
  }
  constexpr double kSewingTolerance =
    1e-5; // of the diagonal: borders that were one before the file was written
  Bnd_Box box;
  BRepBndLib::Add(healed.shape, box, Standard_False);
  const auto sewing =
    std::make_shared<BRepBuilderAPI_Sewing>(kSewingTolerance * std::sqrt(box.SquareExtent()));
  sewing->Add(healed.shape);
  sewing->Perform();
  if (sewing->SewedShape().IsNull() || sewing->NbContigousEdges() == 0)
  {
    return;
  }
  healed.shape = sewing->SewedShape();
  healed.healed = [sewing](const TopoDS_Shape& shape)
  {
    return sewing->IsModifiedSubShape(shape) ? sewing->ModifiedSubShape(shape)
                                             : sewing->Modified(shape);
  };
  healed.repairs.push_back(std::to_string(faces.Extent()) + " free faces were sewn along " +
    std::to_string(sewing->NbContigousEdges()) + " edges that they have in common");
}

void fixFaults(HealedShape& healed)
{
  const BRepCheck_Analyzer before(healed.shape);
  if (before.IsValid())
  {
    return;
  }
  const std::map<std::string, int> faults = faultsOf(healed.shape, before);
  const Handle(ShapeFix_Shape) fix = new ShapeFix_Shape(healed.shape);
  fix->Perform();
  const TopoDS_Shape fixed = fix->Shape();
  if (fixed.IsNull())
  {
    healed.repairs.push_back(
      "the shape is invalid, and ShapeFix leaves nothing of it: " + listOf(faults));
    return;
  }
  const Handle(ShapeBuild_ReShape) context = fix->Context();
  const auto earlier = healed.healed;
  healed.healed = [earlier, context](const TopoDS_Shape& shape)
  { return context->Apply(earlier(shape)); };
  healed.shape = fixed;
  const BRepCheck_Analyzer after(fixed);
  healed.repairs.push_back("repaired by Open CASCADE's ShapeFix: " + listOf(faults));
  if (!after.IsValid())
  {
    healed.repairs.push_back("still invalid after ShapeFix: " + listOf(faultsOf(fixed, after)));
  }
}

} // namespace

HealedShape healShape(const TopoDS_Shape& shape)
{
  HealedShape healed{ shape, [](const TopoDS_Shape& old) { return old; }, {} };
  sewFreeFaces(healed);
  fixFaults(healed);
  return healed;
}

} // namespace quadrille
