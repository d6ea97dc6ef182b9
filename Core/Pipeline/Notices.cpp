// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Notices.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Quads/QuadShape.h"
#include "Quads/SurfaceWalk.h"

#include <algorithm>
#include <iomanip>
#include <iterator>
#include <sstream>

namespace quadrille
{

void tell(const std::vector<std::string>& texts, std::vector<std::string>& notices)
{
  std::copy_if(texts.begin(), texts.end(), std::back_inserter(notices),
    [](const std::string& text) { return !text.empty(); });
}

std::string featureNotice(const FeatureFilterReport& report)
{
  if (report.removedEdges == 0)
  {
    return "";
  }
  return std::to_string(report.removedEdges) +
    " sharp edges are details below the smallest one and no features (" +
    std::to_string(report.keptEdges) +
    " are kept): ask for more quads, or lower Smallest Detail (--smallest-detail)";
}

std::string refinementNotice(double factor)
{
  if (factor <= kTellRefinement)
  {
    return "";
  }
  std::ostringstream text;
  text << "sizes had to shrink by a factor of " << std::setprecision(3) << factor
       << " for a valid map: expect more quads than asked for";
  return text.str();
}

std::string anisotropyNotice(double share, double limit)
{
  if (!(share > 0))
  {
    return "";
  }
  std::ostringstream text;
  text << std::setprecision(2) << 100 * share
       << " % of the coarse level's area are beyond the anisotropy limit of "
       << std::setprecision(6) << limit
       << ", where whole numbers, features or irregular vertices leave no room";
  return text.str();
}

std::string defectsText(const Certificate& certificate)
{
  std::string text;
  appendCount(text, certificate.notPositive, "triangle is turned over or flat",
    "triangles are turned over or flat");
  appendCount(text, certificate.wrongTurns, "vertex has another valence than the field",
    "vertices have another valence than the field");
  appendCount(text, certificate.seamResiduals, "edge has two images that do not match",
    "edges have two images that do not match");
  appendCount(text, certificate.offIsolines, "feature or boundary edge is on no grid line",
    "feature or boundary edges are on no grid line");
  appendCount(text, certificate.offIntegers, "irregular vertex or corner is on no grid point",
    "irregular vertices or corners are on no grid point");
  appendCount(text, certificate.fractionalTransitions, "edge has a shift that is not whole",
    "edges have shifts that are not whole");
  return text;
}

std::string invertedText(const QuadMesh& quads)
{
  const std::vector<Index> inverted = invertedQuads(quads.points, quads.quads);
  return inverted.empty()
    ? ""
    : std::to_string(inverted.size()) + (inverted.size() == 1 ? " of them is" : " of them are") +
      " inverted, one near " + placeText(quads.points[quads.quads[inverted.front()].front()]);
}

std::string looseText(const Mesh& mesh, const QuadMesh& quads, double edgeLength)
{
  std::size_t count = 0;
  double farthest = 0;
  Vector3 place = Vector3::Zero();
  for (Index p = 0; p < quads.points.size(); ++p)
  {
    const Vector3 on = positionOf(mesh, { quads.sourceFace[p], quads.sourceWeights[p] });
    const double off = (quads.points[p] - on).norm() / edgeLength;
    count += off > kOnePlace ? 1 : 0;
    place = off > farthest ? on : place;
    farthest = std::max(farthest, off);
  }
  if (count == 0)
  {
    return "";
  }
  std::ostringstream text;
  text << count << (count == 1 ? " point lies" : " points lie") << " beside the surface, up to "
       << std::setprecision(2) << farthest << " edge lengths, the farthest near "
       << placeText(place)
       << ": with all their corners on it quads there would be inverted or nearly flat, as where "
          "sharp edges are nearer to each other than quads are wide; ask for more quads, or for "
          "fewer features there";
  return text.str();
}

std::string mapNotice(const Mesh& mesh, const Certificate& certificate)
{
  std::string text = defectsText(certificate);
  if (text.empty())
  {
    return text;
  }
  text = "map on the input surface: " + text + " (of " + std::to_string(certificate.triangles) +
    " triangles)";
  if (certificate.notPositive > 0 && !certificate.worstFaces.empty())
  {
    text +=
      ", the worst triangle near " + placeText(mesh.middleOfFace(certificate.worstFaces.front()));
  }
  return text +
    "; the quads bridge such places, but may have a poor shape there: more quads or a larger "
    "number of coarse vertices often help";
}

std::string stoppedText(const std::string& what)
{
  return "stopped on request (" + what +
    "): these are the best quads so far, others were still being tried";
}

} // namespace quadrille
