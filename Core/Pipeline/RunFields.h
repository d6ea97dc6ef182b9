// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a run has to say for itself, as named values: field data of VTK, the dict of Python's info().
#pragma once

#include "Pipeline/Pipeline.h"

#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace quadrille
{

struct RunField
{
  std::string name;
  std::variant<std::vector<std::string>, std::vector<std::size_t>, std::vector<double>> values;
};

using RunFields = std::vector<RunField>;

/// StageNames, StageSeconds, StageElementsIn, StageElementsOut: one value a stage.
RunFields stageFields(const std::vector<StageRecord>& stages);
/// Certificate (text), CertificateValid (0 or 1), CertificateNames and CertificateValues. isOfAll: false where parts of
/// the surface have no map, which is then no valid one.
RunFields certificateFields(const Certificate& certificate, bool isOfAll = true);
/// RepairNames and RepairCounts.
RunFields repairFields(const RepairReport& repair);
/// ExtractionNames and ExtractionCounts.
RunFields extractionFields(const ExtractionCounts& counts);
/// Method: the name of it.
RunFields methodFields(MapMethod method);
/// AnisotropyLimit and BeyondAnisotropyLimit, a share; nothing without limit.
RunFields anisotropyFields(double limit, double beyond);

/// All of a run: stages, ReusedStages, certificate, repair, extraction; EstimatedSeconds, EstimatedMegabytes,
/// TargetEdgeLength, TargetQuads, ActualQuads, CoarseVertices, Decimations, Replays, SurfaceFaces; Handles,
/// UnresolvedHandles, ShortestLoopOverEdgeLength and ShortestLoopPlace, ShortestBoundaryOverEdgeLength and
/// ShortestBoundaryPlace; Attempts, RecoveryNames with RecoveryCounts, how often each strategy made one of them;
/// TryNames with TriesTaken and TriesLed, what was tried otherwise and how often that is used; Stopped, where the run
/// was; DistortionNames, DistortionBefore, DistortionAfter and OptimizationSteps, unless final quality is Coarse.
RunFields runFields(const RemeshResult& result);

/// Every count of repair with its name, in the order of the struct.
std::vector<std::pair<std::string, std::size_t>> repairCounts(const RepairReport& repair);

} // namespace quadrille
