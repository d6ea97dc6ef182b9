// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Constraints/Constraints.h"
#include "Convert/ArrayNames.h"
#include "Evaluation/ConstraintWords.h"
#include "TestSurfaces.h"

#include "Base/Error.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// What the user is told of curves on the first of the inputs.
std::vector<std::string> applyCurves(ConvertedSurface& surface, vtkPolyData* curves)
{
  ConstraintInputs inputs;
  inputs.curves = curves;
  return applyConstraints(surface, inputs).notices;
}

TEST(Constraints, CurvesRunStraightOverTheFaces)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(8, 8));
  ConvertedSurface surface = convertSurface(data, "");
  ConstraintInputs inputs;
  // Along no edge of the grid, and off the plane: it is projected.
  const vtkSmartPointer<vtkPolyData> curve =
    test::polyline({ { 0, 1.25, 0.02 }, { 8, 6.5, 0.02 } });
  inputs.curves = curve;
  const PlacedConstraints placed = applyConstraints(surface, inputs);
  EXPECT_TRUE(placed.notices.empty());
  ASSERT_EQ(surface.input.drawn.features.size(), 1u);
  const std::vector<Vector3>& points = surface.input.drawn.features[0].points;
  ASSERT_EQ(points.size(), 2u);
  EXPECT_LT((points[0] - Vector3(0, 1.25, 0)).norm(), 1e-12);
  EXPECT_LT((points[1] - Vector3(8, 6.5, 0)).norm(), 1e-12);
  ASSERT_GT(placed.placed[0].path.size(), 16u); // it crosses as many edges
  for (const Vector3& p : placed.placed[0].path)
  {
    EXPECT_NEAR(p.y(), 1.25 + p.x() * 5.25 / 8, 1e-9);
  }
  EXPECT_TRUE(surface.input.featureEdges.empty()); // arrays stay the user's
}

TEST(Constraints, OtherTypesAreRefused)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(2, 2));
  const vtkSmartPointer<vtkPolyData> curve = test::polyline({ { 0, 0, 0 }, { 1, 0, 0 } });
  vtkNew<vtkIntArray> type;
  type->SetName("ConstraintType");
  type->InsertNextValue(0);
  curve->GetCellData()->AddArray(type);
  ConvertedSurface surface = convertSurface(data, "");
  EXPECT_NO_THROW(applyCurves(surface, curve));
  type->SetValue(0, 3);
  EXPECT_THROW(applyCurves(surface, curve), InvalidInput);
}

TEST(Constraints, CurvesMayBeStrokes)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(8, 8));
  const vtkSmartPointer<vtkPolyData> curve =
    test::polyline({ { 0, 4, 0 }, { 4, 4, 0 }, { 8, 4, 0 } });
  vtkNew<vtkIntArray> type;
  type->SetName("ConstraintType");
  type->InsertNextValue(1);
  curve->GetCellData()->AddArray(type);
  ConvertedSurface surface = convertSurface(data, "");
  ConstraintInputs inputs;
  inputs.curves = curve;
  const PlacedConstraints placed = applyConstraints(surface, inputs);
  EXPECT_TRUE(surface.input.drawn.features.empty());
  EXPECT_TRUE(surface.input.guideDirections.empty());
  ASSERT_EQ(surface.input.drawn.strokes.size(), 1u);
  EXPECT_EQ(surface.input.drawn.strokes[0].points.size(), 3u);
  ASSERT_GT(placed.placed[0].guided.size(), 100u);
  for (const GuidedPlace& guided : placed.placed[0].guided)
  {
    EXPECT_NEAR(guided.place.y(), 4, 1e-12);
    EXPECT_NEAR(std::abs(guided.direction.x()), 1, 1e-12);
  }
}

TEST(Constraints, AStrokeIsAsWideAsItsRadius)
{
  const Mesh mesh =
    test::disjointUnion(test::gridPlane(8, 8), test::gridPlane(8, 8), Vector3(0, 0, 0.5));
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(mesh);
  const vtkSmartPointer<vtkPolyData> stroke =
    test::polyline({ { 0, 4, 0 }, { 4, 4, 0 }, { 4, 8, 0 } });
  ConvertedSurface surface = convertSurface(data, "");
  ConstraintInputs inputs;
  inputs.strokes = stroke;
  inputs.strokeRadius = 1.5;
  const PlacedConstraints placed = applyConstraints(surface, inputs);
  ASSERT_EQ(surface.input.drawn.strokes.size(), 1u);
  EXPECT_EQ(surface.input.drawn.strokes[0].radius, 1.5);
  double farthest = 0;
  for (const GuidedPlace& guided : placed.placed[0].guided)
  {
    const Vector3& p = guided.place;
    const double first = std::hypot(std::max(p.x() - 4, 0.0), p.y() - 4);
    const double second = std::hypot(p.x() - 4, std::max(4 - p.y(), 0.0));
    EXPECT_LE(std::min(first, second), 1.5 + 1e-9) << p.transpose();
    EXPECT_LT(p.z(), 0.25); // the other sheet is nearer than that
    farthest = std::max(farthest, std::min(first, second));
    if (std::abs(first - second) > 1e-3)
    {
      EXPECT_NEAR(std::abs(first < second ? guided.direction.x() : guided.direction.y()), 1, 1e-9)
        << p.transpose();
    }
  }
  EXPECT_GT(farthest, 1.2);
}

TEST(Constraints, AnArrayOfVectorsGuides)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(4, 4));
  vtkNew<vtkDoubleArray> fibre;
  fibre->SetName("Fibre");
  fibre->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    const double x = data->GetPoint(i)[0];
    // Signs do not count; on the left there is nothing.
    fibre->InsertNextTuple3(x < 2 ? 0 : (i % 2 == 0 ? 3 : -1), 0, 0);
  }
  data->GetPointData()->AddArray(fibre);
  ConvertedSurface surface = convertSurface(data, "");
  surface.input.guideDirections.assign(32, Vector3::Zero());
  surface.input.guideDirections[5] = Vector3(0, 2, 0);
  addGuideArray(data, "Fibre", surface);
  for (std::size_t i = 0; i < 32; ++i)
  {
    bool free = true;
    for (int k = 0; k < 3; ++k)
    {
      free = free && surface.input.points[surface.input.polygonPoints[3 * i + k]].x() < 2;
    }
    const Vector3& d = surface.input.guideDirections[i];
    EXPECT_EQ(d.cwiseAbs(), i == 5 ? Vector3(0, 2, 0) : free ? Vector3(0, 0, 0) : Vector3(1, 0, 0));
  }
  EXPECT_THROW(addGuideArray(data, "Fiber", surface), InvalidInput);
  fibre->SetComponent(12, 1, std::nan(""));
  ConvertedSurface other = convertSurface(data, "");
  EXPECT_THROW(addGuideArray(data, "Fibre", other), InvalidInput);
}

TEST(Constraints, NoPathBetweenComponentsIsTold)
{
  const Mesh mesh =
    test::disjointUnion(test::gridPlane(2, 2), test::gridPlane(2, 2), Vector3(0, 0, 5));
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(mesh);
  ConvertedSurface surface = convertSurface(data, "");
  const vtkSmartPointer<vtkPolyData> line = test::polyline({ { 0, 0, 0 }, { 0, 0, 5 } });
  ConstraintInputs inputs;
  inputs.curves = line;
  const PlacedConstraints result = applyConstraints(surface, inputs);
  ASSERT_EQ(result.placed.size(), 1u);
  EXPECT_NE(result.placed[0].remark.find("different parts"), std::string::npos)
    << result.placed[0].remark;
}

TEST(Constraints, FarFromTheSurfaceIsSeenInTheDistance)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(4, 4));
  ConvertedSurface surface = convertSurface(data, "");
  ConstraintInputs inputs;
  const vtkSmartPointer<vtkPolyData> curve = test::polyline({ { 0, 0, 50 }, { 1, 1, 50 } });
  inputs.curves = curve;
  const PlacedConstraints placed = applyConstraints(surface, inputs);
  ASSERT_EQ(placed.placed.size(), 1u); // what is told needs the quads, see ConstraintTable
  EXPECT_NEAR(placed.placed[0].distance, 50, 1e-9);
}

vtkSmartPointer<vtkPolyData> pointCloud(const std::vector<Vector3>& points)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> coordinates;
  coordinates->SetDataTypeToDouble();
  for (const Vector3& p : points)
  {
    coordinates->InsertNextPoint(p.data());
  }
  data->SetPoints(coordinates);
  return data;
}

TEST(Constraints, StrokesOfTheirOwnInputNeedNoArray)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(8, 8));
  ConvertedSurface surface = convertSurface(data, "");
  ConstraintInputs inputs;
  const vtkSmartPointer<vtkPolyData> stroke = test::polyline({ { 1, 4, 0.1 }, { 7, 4, 0.1 } });
  inputs.strokes = stroke;
  inputs.strokeWeight = 0.25;
  const PlacedConstraints result = applyConstraints(surface, inputs);
  EXPECT_TRUE(result.notices.empty());
  ASSERT_EQ(result.placed.size(), 1u);
  EXPECT_EQ(result.placed[0].kind, ConstraintKind::Stroke);
  EXPECT_NEAR(result.placed[0].distance, 0.1, 1e-12);
  for (const Vector3& p : result.placed[0].path)
  {
    EXPECT_EQ(p.z(), 0); // on the surface
    EXPECT_NEAR(p.y(), 4, 1e-12);
  }
  ASSERT_EQ(surface.input.drawn.strokes.size(), 1u);
  EXPECT_EQ(surface.input.drawn.strokes[0].weight, 0.25);
  for (const GuidedPlace& guided : result.placed[0].guided)
  {
    EXPECT_EQ(guided.weight, 0.25);
  }
}

TEST(Constraints, StrokesCrossTrianglesLargerThanTheirSegments)
{
  // The stroke lies within one of two triangles and near none of the edges.
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(1, 1));
  ConvertedSurface surface = convertSurface(data, "");
  ConstraintInputs inputs;
  const vtkSmartPointer<vtkPolyData> stroke = test::polyline({ { 0.7, 0.1, 0 }, { 0.9, 0.3, 0 } });
  inputs.strokes = stroke;
  const PlacedConstraints placed = applyConstraints(surface, inputs);
  const Vector3 along = Vector3(1, 1, 0).normalized();
  ASSERT_FALSE(placed.placed[0].guided.empty());
  for (const GuidedPlace& guided : placed.placed[0].guided)
  {
    EXPECT_NEAR(guided.place.x() - guided.place.y(), 0.6, 1e-9);
    EXPECT_NEAR(std::abs(guided.direction.dot(along)), 1, 1e-9);
  }
}

TEST(Constraints, ValencePointsStayBetweenVertices)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(4, 4));
  ConvertedSurface surface = convertSurface(data, "");
  ConstraintInputs inputs;
  const vtkSmartPointer<vtkPolyData> points = pointCloud({ { 1.1, 2.2, 0 }, { 3, 1, 0 } });
  inputs.points = points;
  inputs.valence = 5;
  const PlacedConstraints result = applyConstraints(surface, inputs);
  ASSERT_EQ(result.placed.size(), 2u);
  EXPECT_EQ(result.placed[0].path.front(), Vector3(1.1, 2.2, 0));
  EXPECT_TRUE(surface.input.targetValences.empty());
  ASSERT_EQ(surface.input.drawn.valences.size(), 2u);
  EXPECT_EQ(surface.input.drawn.valences[0], (ValencePlace{ { 1.1, 2.2, 0 }, 5 }));
  EXPECT_EQ(surface.input.drawn.valences[1], (ValencePlace{ { 3, 1, 0 }, 5 }));
}

TEST(Constraints, WholeDoublesAreTargetValences)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(4, 4));
  const vtkSmartPointer<vtkPolyData> points = pointCloud({ { 1, 2, 0 }, { 3, 1, 0 } });
  vtkNew<vtkDoubleArray> valences;
  valences->SetName("TargetValence");
  valences->InsertNextValue(0);
  valences->InsertNextValue(6);
  points->GetPointData()->AddArray(valences);
  ConstraintInputs inputs;
  inputs.points = points;
  ConvertedSurface surface = convertSurface(data, "");
  const PlacedConstraints result = applyConstraints(surface, inputs);
  ASSERT_EQ(result.placed.size(), 1u);
  EXPECT_EQ(result.placed[0].valence, 6);
  valences->SetValue(1, 4.5);
  ConvertedSurface again = convertSurface(data, "");
  EXPECT_THROW(applyConstraints(again, inputs), InvalidInput);
}

TEST(Constraints, OfTwoValencesAtOnePlaceTheLaterOneIsLeftOut)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(4, 4));
  vtkNew<vtkIntArray> valences;
  valences->SetName("TargetValence");
  valences->InsertNextValue(3);
  valences->InsertNextValue(5);
  const vtkSmartPointer<vtkPolyData> points = pointCloud({ { 1, 2, 0 }, { 1.1, 2, 0 } });
  points->GetPointData()->AddArray(valences);
  ConstraintInputs inputs;
  inputs.points = points;
  inputs.sameWithin = 0.2;
  ConvertedSurface surface = convertSurface(data, "");
  const PlacedConstraints made = applyConstraints(surface, inputs);
  ASSERT_EQ(made.placed.size(), 2U);
  EXPECT_EQ(made.placed[0].whyNot, "");
  EXPECT_NE(made.placed[1].whyNot.find("3 is asked for already"), std::string::npos)
    << made.placed[1].whyNot;
  EXPECT_EQ(made.notices.size(), 1U);
  ASSERT_EQ(surface.input.drawn.valences.size(), 1U);
  EXPECT_EQ(surface.input.drawn.valences[0].valence, 3);
}

TEST(Constraints, ValenceTwoOnTheBoundaryIsLeftOutWithItsPlace)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(4, 4));
  ConvertedSurface surface = convertSurface(data, "");
  const vtkSmartPointer<vtkPolyData> points = pointCloud({ { 4, 2, 0 } });
  ConstraintInputs inputs;
  inputs.points = points;
  inputs.valence = 2;
  const PlacedConstraints made = applyConstraints(surface, inputs);
  ASSERT_EQ(made.placed.size(), 1U);
  EXPECT_NE(made.placed[0].whyNot.find("(4, 2, 0)"), std::string::npos) << made.placed[0].whyNot;
}

TEST(Constraints, OutputTellsWhatWasReached)
{
  QuadMesh mesh; // one quad: its corners have two edges each and lie on the boundary
  mesh.points = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
  mesh.quads = { { 0, 1, 2, 3 } };
  mesh.valence = { 2, 2, 2, 2 };
  mesh.onBoundary = { 1, 1, 1, 1 };
  PlacedConstraint met;
  met.kind = ConstraintKind::Valence;
  met.path = { { 1, 0, 0 } };
  met.valence = 3;
  PlacedConstraint missed = met;
  missed.valence = 5;
  PlacedConstraint stroke;
  stroke.kind = ConstraintKind::Stroke;
  stroke.path = { { 0, 0, 0 }, { 1, 0, 0 } };
  const vtkSmartPointer<vtkPolyData> data =
    writeConstraints({ stroke, met, missed }, mesh, { true, true, false });
  ASSERT_EQ(data->GetNumberOfVerts(), 2);
  ASSERT_EQ(data->GetNumberOfLines(), 1);
  vtkDataArray* isMet = data->GetCellData()->GetScalars();
  ASSERT_NE(isMet, nullptr);
  EXPECT_STREQ(isMet->GetName(), "Met");
  EXPECT_EQ(isMet->GetTuple1(0), 1);
  EXPECT_EQ(isMet->GetTuple1(1), 0);
  EXPECT_EQ(isMet->GetTuple1(2), 1);
  vtkDataArray* kind = data->GetCellData()->GetArray("Constraint");
  ASSERT_NE(kind, nullptr);
  EXPECT_EQ(kind->GetTuple1(0), 2);
  EXPECT_EQ(kind->GetTuple1(1), 3);
  EXPECT_EQ(kind->GetTuple1(2), 1); // lines come behind vertices
  EXPECT_EQ(data->GetCellData()->GetArray("Valence")->GetTuple1(1), 3);
  AskedConstraints asked;
  asked.placed = { met, missed };
  const std::vector<std::string> told = unmetNotices(judgeConstraints(asked, mesh, {}), asked);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find("at (1, 0, 0) is not met: asked 5, got 3"), std::string::npos) << told[0];
  EXPECT_EQ(data->GetPointData()->GetArray("Direction")->GetComponent(2, 0), 1);
}

//------------------------------------------------------------------------------
// Arrays that were probably meant

template <class Array>
void addArray(
  vtkDataSetAttributes* attributes, const char* name, vtkIdType count, int components = 1)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(count);
  array->Fill(0);
  attributes->AddArray(array);
}

TEST(ArrayNames, WhatWasProbablyMeantIsTold)
{
  for (const char* name : { "targetvalence", "Target_Valence", "TargetValences", "TargetValenc" })
  {
    const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(2, 2));
    addArray<vtkDoubleArray>(data->GetPointData(), name, data->GetNumberOfPoints());
    const auto notices = arrayNotices(data, "the surface", surfaceArrays("PatchId"));
    ASSERT_EQ(notices.size(), 1u) << name;
    EXPECT_NE(notices[0].find("'TargetValence'"), std::string::npos);
  }
}

TEST(ArrayNames, OtherNamesAreLeftAlone)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(2, 2));
  for (const char* name : { "Valence", "Normals", "Temperature", "Pressure", "Index", "Size" })
  {
    addArray<vtkDoubleArray>(data->GetPointData(), name, data->GetNumberOfPoints());
  }
  addArray<vtkIntArray>(data->GetCellData(), "FeatureEdges", data->GetNumberOfCells());
  EXPECT_TRUE(arrayNotices(data, "the surface", surfaceArrays("PatchId")).empty());
}

TEST(ArrayNames, WrongElementsAndComponentsAreTold)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(2, 2));
  addArray<vtkDoubleArray>(data->GetCellData(), "TargetValence", data->GetNumberOfCells());
  const auto notices = arrayNotices(data, "the surface", surfaceArrays("PatchId"));
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_NE(notices[0].find("Cell Data To Point Data"), std::string::npos);
  addArray<vtkDoubleArray>(data->GetPointData(), "Sizing", data->GetNumberOfPoints(), 3);
  EXPECT_THROW(arrayNotices(data, "the surface", surfaceArrays("PatchId")), InvalidInput);
}

TEST(ArrayNames, WeightsWithoutDirectionsAreTold)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(2, 2));
  addArray<vtkDoubleArray>(data->GetCellData(), "GuidingWeight", data->GetNumberOfCells());
  const auto notices = partnerNotices(data, nullptr, nullptr);
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_NE(notices[0].find("'GuidingWeight' of the surface is not used"), std::string::npos);
  EXPECT_NE(notices[0].find("'GuidingDirection'"), std::string::npos);
  // On points they weight nothing either.
  addArray<vtkDoubleArray>(data->GetPointData(), "GuidingDirection", data->GetNumberOfPoints(), 3);
  EXPECT_EQ(partnerNotices(data, nullptr, nullptr).size(), 1u);
  addArray<vtkDoubleArray>(data->GetCellData(), "GuidingDirection", data->GetNumberOfCells(), 3);
  EXPECT_TRUE(partnerNotices(data, nullptr, nullptr).empty());
}

TEST(ArrayNames, ArraysOfLinesWithoutAPartnerAreTold)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(2, 2));
  const vtkSmartPointer<vtkPolyData> curves = test::polyline({ { 0, 0, 0 }, { 1, 0, 0 } });
  addArray<vtkDoubleArray>(curves->GetCellData(), "GuidingWeight", 1);
  EXPECT_TRUE(partnerNotices(data, nullptr, curves).empty()); // strokes have weights
  ASSERT_EQ(partnerNotices(data, curves, nullptr).size(), 1u);
  EXPECT_NE(partnerNotices(data, curves, nullptr)[0].find("of the feature curves is not used"),
    std::string::npos);
  addArray<vtkIntArray>(curves->GetCellData(), "ConstraintType", 1);
  EXPECT_EQ(partnerNotices(data, curves, nullptr).size(), 1u); // no line is a stroke
  ASSERT_EQ(partnerNotices(data, nullptr, curves).size(), 1u); // and here each is one
  EXPECT_NE(
    partnerNotices(data, nullptr, curves)[0].find("'ConstraintType' of the guiding strokes"),
    std::string::npos);
  curves->GetCellData()->GetArray("ConstraintType")->SetTuple1(0, 1);
  EXPECT_TRUE(partnerNotices(data, curves, nullptr).empty());
  EXPECT_TRUE(partnerNotices(data, nullptr, curves).empty());
}

TEST(ArrayNames, WholeDoublesAreFeatureEdgesAndPatchIds)
{
  const vtkSmartPointer<vtkPolyData> data = test::toPolyData(test::gridPlane(2, 2));
  addArray<vtkDoubleArray>(data->GetCellData(), "FeatureEdges", data->GetNumberOfCells());
  addArray<vtkFloatArray>(data->GetCellData(), "PatchId", data->GetNumberOfCells());
  addArray<vtkDoubleArray>(data->GetPointData(), "TargetValence", data->GetNumberOfPoints());
  data->GetCellData()->GetArray("FeatureEdges")->SetTuple1(3, 5);
  data->GetCellData()->GetArray("PatchId")->SetTuple1(3, -2);
  data->GetPointData()->GetArray("TargetValence")->SetTuple1(4, 3);
  const ConvertedSurface surface = convertSurface(data, "PatchId");
  EXPECT_EQ(surface.input.featureEdges[3], 5);
  EXPECT_EQ(surface.input.patchIds[3], -2);
  EXPECT_EQ(surface.input.targetValences[4], 3);
  data->GetCellData()->GetArray("PatchId")->SetTuple1(3, 0.5);
  EXPECT_THROW(convertSurface(data, "PatchId"), InvalidInput);
}

} // namespace
} // namespace quadrille
