// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a run tells the user, in sentences that remesh() and the stage filters share. Each is empty where there is
/// nothing to tell.
#pragma once

#include "Extraction/Extraction.h"
#include "Features/FeatureFilter.h"
#include "GridMap/GridMap.h"

#include <string>
#include <vector>

namespace quadrille
{

/// A smaller factor of sizes is nothing that a user would see.
constexpr double kTellRefinement = 1.1;

/// Adds those that are not empty.
void tell(const std::vector<std::string>& texts, std::vector<std::string>& notices);

/// Features that the edge length cannot resolve.
std::string featureNotice(const FeatureFilterReport& report);

/// Sizes that shrank by this factor for a valid map; see GridMapResult::refinement.
std::string refinementNotice(double factor);

/// The share of the coarse level's area that is beyond the limit.
std::string anisotropyNotice(double share, double limit);

/// "12 of 3000 triangles are turned over or flat, 1 vertex ...": the counts of a certificate that are not zero.
std::string defectsText(const Certificate& certificate);

/// Of points that have left the surface (see loosenQuads()), how many, how far, and where; lengths in edge lengths.
std::string looseText(const Mesh& mesh, const QuadMesh& quads, double edgeLength);

/// What is wrong with the map on the input surface, with the place of its worst triangle and what it means.
std::string mapNotice(const Mesh& mesh, const Certificate& certificate);

/// Of quads that are not what the attempts were to end with: how many are inverted, and where one is. Empty where none
/// is.
std::string invertedText(const QuadMesh& quads);

/// Of quads beside which others were still being made. what: see RemeshResult::stopped.
std::string stoppedText(const std::string& what);

} // namespace quadrille
