// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Symmetry as a constraint of a session.
#include "SessionHelpers.h"

#include "Symmetry/Symmetry.h"

#include <cstdio>
#include <fstream>
#include <set>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// Symmetric about x = 0 only; the bump keeps it from more.
SurfaceInput lopsided()
{
  Mesh mesh = sphere(3);
  for (Vector3& p : mesh.position.editAll())
  {
    const double bump = 0.25 * std::exp(-8 * (p - Vector3(0, 0.6, 0.8)).squaredNorm());
    p = (1 + bump) * Vector3(p.x(), 1.6 * p.y() + 0.2 * p.z(), 1.2 * p.z());
  }
  return toInput(mesh);
}

const MirrorSymmetry kAcrossX{ MirrorPlane{ Vector3::Zero(), Vector3(2, 0, 0) } };

/// mirrorPoint is its own inverse and takes quads to quads, and points to their images in x = 0.
void expectMirrored(const SessionResult& result)
{
  const std::vector<Index>& image = result.mirrorPoint;
  const std::vector<Vector3>& points = result.quads.points;
  ASSERT_EQ(image.size(), points.size());
  double worst = 0;
  for (Index p = 0; p < image.size(); ++p)
  {
    ASSERT_EQ(image[image[p]], p);
    worst = std::max(
      worst, (points[image[p]] - Vector3(-points[p].x(), points[p].y(), points[p].z())).norm());
  }
  EXPECT_LT(worst, 1e-5); // twice the tolerance of exact images, a millionth of the diagonal
  std::set<std::set<Index>> quads;
  for (const auto& quad : result.quads.quads)
  {
    quads.insert(std::set<Index>(quad.begin(), quad.end()));
  }
  for (const auto& quad : result.quads.quads)
  {
    std::set<Index> mirrored;
    for (const Index p : quad)
    {
      mirrored.insert(image[p]);
    }
    ASSERT_EQ(quads.count(mirrored), 1u);
  }
}

TEST(SessionSymmetry, QuadsAreTheirOwnImage)
{
  Session session(lopsided(), sessionOptions(400));
  session.update();
  EXPECT_TRUE(session.result()->mirrorPoint.empty());
  const QuadMesh plain = session.result()->quads;
  const int id = session.add(kAcrossX);
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  ASSERT_EQ(report.constraints.size(), 1u);
  EXPECT_TRUE(report.constraints[0].isMet) << report.constraints[0].reason;
  EXPECT_EQ(report.constraints[0].kind, "symmetry");
  EXPECT_LT(report.constraints[0].deviation, kRoundingOfSingle);
  expectMirrored(*session.result());
  const SymmetricResult direct =
    remeshSymmetric(lopsided(), session.settings(), { kAcrossX.plane });
  EXPECT_TRUE(areSame(direct.remeshed.quads, session.result()->quads));
  EXPECT_EQ(direct.mirrorPoint, session.result()->mirrorPoint);

  session.undo();
  EXPECT_EQ(session.update().runs, 0);
  EXPECT_TRUE(areSame(session.result()->quads, plain));
  session.redo();
  EXPECT_EQ(session.update().runs, 0);
  expectMirrored(*session.result());

  // Found in place of given.
  session.edit(id, MirrorSymmetry{});
  const SessionReport& found = session.update();
  ASSERT_TRUE(found.status.ok()) << found.status.message;
  EXPECT_TRUE(found.constraints[0].isMet) << found.constraints[0].reason;
  expectMirrored(*session.result());
}

TEST(SessionSymmetry, QuadsAreTheirOwnTurnedImage)
{
  Session session(toInput(torus(40, 20)), sessionOptions(400));
  const RotationalSymmetry fifth{ 5, RotationAxis{ Vector3::Zero(), Vector3(0, 0, 3) } };
  const int id = session.add(fifth);
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  ASSERT_EQ(report.constraints.size(), 1u);
  EXPECT_TRUE(report.constraints[0].isMet) << report.constraints[0].reason;
  EXPECT_EQ(report.constraints[0].kind, "rotation");
  const SymmetricResult direct = remeshSymmetric(toInput(torus(40, 20)), session.settings(),
    { std::nullopt, RotationRequest{ fifth.order, fifth.axis } });
  EXPECT_TRUE(areSame(direct.remeshed.quads, session.result()->quads));
  EXPECT_EQ(direct.rotatedPoint, session.result()->rotatedPoint);
  EXPECT_FALSE(direct.rotatedPoint.empty());
  EXPECT_TRUE(session.result()->mirrorPoint.empty());
  // Other orders are other quads, and undo makes nothing.
  session.edit(id, RotationalSymmetry{ 2, std::nullopt });
  ASSERT_TRUE(session.update().status.ok());
  EXPECT_FALSE(areSame(direct.remeshed.quads, session.result()->quads));
  session.undo();
  EXPECT_EQ(session.update().runs, 0);
  EXPECT_TRUE(areSame(direct.remeshed.quads, session.result()->quads));
}

TEST(SessionSymmetry, PlanesThatAreNoneAreLeftOutAndTold)
{
  Session session(lopsided(), sessionOptions(400));
  ASSERT_TRUE(session.update().status.ok());
  const QuadMesh plain = session.result()->quads;
  session.add(MirrorSymmetry{ MirrorPlane{ Vector3(50, 0, 0), Vector3(1, 0, 0) } });
  const SessionReport beside = session.update();
  ASSERT_TRUE(beside.status.ok()) << beside.status.message;
  EXPECT_FALSE(beside.constraints[0].isMet);
  EXPECT_NE(beside.constraints[0].reason.find("mirror plane"), std::string::npos)
    << beside.constraints[0].reason;
  EXPECT_TRUE(areSame(session.result()->quads, plain));
  EXPECT_TRUE(session.result()->mirrorPoint.empty());
  // The next one counts then.
  session.add(kAcrossX);
  const SessionReport& next = session.update();
  ASSERT_TRUE(next.status.ok()) << next.status.message;
  EXPECT_FALSE(next.constraints[0].isMet);
  EXPECT_TRUE(next.constraints[1].isMet) << next.constraints[1].reason;
  expectMirrored(*session.result());
}

TEST(SessionSymmetry, OneAtMost)
{
  Session session(lopsided(), sessionOptions(400));
  session.add(kAcrossX);
  session.add(MirrorSymmetry{});
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_TRUE(report.constraints[0].isMet);
  EXPECT_FALSE(report.constraints[1].isMet);
  for (const char* name : { "symmetry 1", "symmetry 2" })
  {
    EXPECT_NE(report.constraints[1].reason.find(name), std::string::npos)
      << report.constraints[1].reason;
  }
}

TEST(SessionSymmetry, OperationsComeOutOnBothSides)
{
  Session session(lopsided(), sessionOptions(400));
  session.add(kAcrossX);
  ASSERT_TRUE(session.update().status.ok());
  const auto isInFront = [](const IrregularVertex& vertex) { return vertex.place.x() > 0.2; };
  const std::vector<IrregularVertex> before = session.result()->irregular;
  const auto from = std::find_if(before.begin(), before.end(), isInFront);
  ASSERT_NE(from, before.end());
  // A little further in front.
  Vector3 target = from->place;
  double nearest = 1e300;
  for (const Vector3& p : session.surface().points)
  {
    const double distance = (p - from->place).norm();
    if (p.x() > 0.2 && distance > 0.2 && distance < nearest)
    {
      nearest = distance;
      target = p;
    }
  }
  const int valence = from->valence;
  session.add(IrregularEdit{ IrregularOperation::Move, { from->place, target }, {}, {}, {}, {} });
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_TRUE(report.constraints[0].isMet) << report.constraints[0].reason;
  EXPECT_TRUE(report.constraints[1].isMet) << report.constraints[1].reason;
  expectMirrored(*session.result());
  EXPECT_EQ(session.result()->irregular.size(), before.size());
  for (const std::string& notice : report.notices)
  {
    EXPECT_EQ(notice.find("the operations leave"), std::string::npos) << notice;
  }
  for (const double side : { 1.0, -1.0 })
  {
    const Vector3 place(side * target.x(), target.y(), target.z());
    EXPECT_TRUE(std::any_of(session.result()->irregular.begin(), session.result()->irregular.end(),
      [&](const IrregularVertex& vertex)
      { return vertex.valence == valence && (vertex.place - place).norm() < 1e-5; }))
      << side;
  }
}

TEST(SessionSymmetry, OperationsBehindThePlaneAreTold)
{
  Session session(lopsided(), sessionOptions(400));
  session.add(kAcrossX);
  ASSERT_TRUE(session.update().status.ok());
  const std::vector<IrregularVertex> before = session.result()->irregular;
  const auto from = std::find_if(before.begin(), before.end(),
    [](const IrregularVertex& vertex) { return vertex.place.x() < -0.2; });
  ASSERT_NE(from, before.end());
  session.add(
    IrregularEdit{ IrregularOperation::Move, { from->place, Vector3(-1, 0, 0) }, {}, {}, {}, {} });
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_FALSE(report.constraints[1].isMet);
  EXPECT_NE(report.constraints[1].reason.find("in front of the mirror plane"), std::string::npos)
    << report.constraints[1].reason;
  expectMirrored(*session.result());
}

TEST(SessionSymmetry, PreviewsAreRefused)
{
  Session session(lopsided(), sessionOptions(400));
  const int id = session.add(kAcrossX);
  try
  {
    session.preview();
    FAIL() << "a preview was made";
  }
  catch (const InvalidInput& error)
  {
    EXPECT_NE(std::string(error.what()).find("symmetry 1"), std::string::npos) << error.what();
  }
  session.remove(id);
  EXPECT_TRUE(session.preview().report.status.ok());
}

TEST(SessionSymmetry, GoesToAFileAndBack)
{
  const std::string path = ::testing::TempDir() + "quadrille-symmetry.json";
  Session session(lopsided(), sessionOptions(400));
  const int id = session.add(MirrorSymmetry{});
  session.save(path);
  const Session found = Session::load(path, lopsided());
  EXPECT_FALSE(std::get<MirrorSymmetry>(found.constraints()[0]->content).plane.has_value());
  const MirrorSymmetry given{ MirrorPlane{ Vector3(0, 1.0 / 3, 0), Vector3(0.7, 0, 0) } };
  session.edit(id, given);
  session.update();
  session.save(path);
  Session loaded = Session::load(path, lopsided());
  const auto& plane = std::get<MirrorSymmetry>(loaded.constraints()[0]->content).plane;
  ASSERT_TRUE(plane.has_value());
  EXPECT_EQ(plane->origin, given.plane->origin);
  EXPECT_EQ(plane->normal, given.plane->normal);
  ASSERT_TRUE(loaded.update().status.ok());
  EXPECT_TRUE(areSame(loaded.result()->quads, session.result()->quads));
  const RotationalSymmetry half{ 2, RotationAxis{ Vector3(0, 1.0 / 3, 0), Vector3(0.7, 0, 0) } };
  session.remove(id);
  session.add(half);
  session.add(RotationalSymmetry{ 3, std::nullopt });
  session.save(path);
  const Session turned = Session::load(path, lopsided());
  const auto& rotation = std::get<RotationalSymmetry>(turned.constraints()[0]->content);
  EXPECT_EQ(rotation.order, half.order);
  ASSERT_TRUE(rotation.axis.has_value());
  EXPECT_EQ(rotation.axis->origin, half.axis->origin);
  EXPECT_EQ(rotation.axis->direction, half.axis->direction);
  EXPECT_FALSE(std::get<RotationalSymmetry>(turned.constraints()[1]->content).axis.has_value());
  std::remove(path.c_str());
}

TEST(SessionSymmetry, AMidLineIsKeptInFilesAndTakenBack)
{
  const std::string path = ::testing::TempDir() + "quadrille-mid-line.json";
  Session session(lopsided(), sessionOptions(400));
  const int id = session.add(kAcrossX);
  ASSERT_TRUE(session.update().status.ok());
  const QuadMesh isoline = session.result()->quads;
  MirrorSymmetry across = kAcrossX;
  across.planeCurve = PlaneCurve::MidLine;
  session.edit(id, across);
  ASSERT_TRUE(session.update().status.ok());
  const std::vector<Index>& image = session.result()->mirrorPoint;
  for (Index p = 0; p < image.size(); ++p)
  {
    EXPECT_NE(image[p], p);
    EXPECT_EQ(image[image[p]], p);
  }
  session.save(path);
  Session loaded = Session::load(path, lopsided());
  EXPECT_EQ(
    std::get<MirrorSymmetry>(loaded.constraints()[0]->content).planeCurve, PlaneCurve::MidLine);
  ASSERT_TRUE(loaded.update().status.ok());
  EXPECT_TRUE(areSame(loaded.result()->quads, session.result()->quads));
  session.undo();
  ASSERT_TRUE(session.update().status.ok());
  EXPECT_TRUE(areSame(session.result()->quads, isoline));
  std::remove(path.c_str());
}

TEST(SessionSymmetry, RefusesWhatIsNoPlane)
{
  Session session(lopsided(), sessionOptions(100));
  EXPECT_THROW(
    session.add(MirrorSymmetry{ MirrorPlane{ Vector3::Zero(), Vector3::Zero() } }), InvalidInput);
  EXPECT_THROW(
    session.add(MirrorSymmetry{ MirrorPlane{ Vector3(std::nan(""), 0, 0), Vector3(1, 0, 0) } }),
    InvalidInput);
  for (const int order : { 1, 65 })
  {
    EXPECT_THROW(session.add(RotationalSymmetry{ order, std::nullopt }), InvalidInput);
  }
  EXPECT_THROW(
    session.add(RotationalSymmetry{ 3, RotationAxis{ Vector3::Zero(), Vector3::Zero() } }),
    InvalidInput);
  EXPECT_TRUE(session.constraints().empty());
}

} // namespace
} // namespace quadrille
