// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/CrossField.h"

#include "Base/PlaceText.h"
#include "Base/Refuse.h"
#include "Base/TryCount.h"
#include "CrossField/FieldTopology.h"
#include "CrossField/PatchStrips.h"
#include "CrossField/PowerField.h"
#include "CrossField/SideLengths.h"
#include "CrossField/SizeCones.h"
#include "CrossField/TurnRepair.h"
#include "CrossField/Turns.h"

#include <cassert>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace quadrille
{
namespace
{

void requireInput(const Mesh& mesh, const CrossFieldOptions& options)
{
  refuseIf(mesh.faceCount() == 0, "cross field: the mesh has no faces");
  refuseIf(!(options.targetEdgeLength > 0) || !std::isfinite(options.targetEdgeLength),
    "cross field: targetEdgeLength has to be positive and finite");
}

// Guides make what crosses them expensive, so that turns are moved round the regions that they cover.
constexpr double kGuideStiffness = 8;

std::vector<double> stiffnessOf(const FieldTopology& topology, const std::vector<Guide>& guides,
  const FieldConstraints& constraints)
{
  std::vector<double> stiffness;
  for (const std::array<Index, 2>& edge : topology.edges)
  {
    if (constraints.guideStrength.empty())
    {
      break;
    }
    const auto weight = [&](Index h) { return double{ guides[Mesh::face(h)].weight }; };
    stiffness.push_back(1 + kGuideStiffness * std::min(weight(edge[0]), weight(edge[1])));
  }
  return stiffness;
}

std::vector<std::int8_t> matchings(
  const Mesh& mesh, const std::vector<std::int8_t>& alignment, const std::vector<int>& jump)
{
  std::vector<std::int8_t> matching(mesh.halfEdgeCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isBoundary(h))
    {
      continue;
    }
    const int turns = mesh.isFeature(h) ? alignment[mesh.twin[h]] + 2 - alignment[h] : jump[h];
    matching[h] = static_cast<std::int8_t>(turns & 3);
  }
  return matching;
}

// An irregular vertex gives way by up to about so many times s to one that is to be regular.
constexpr double kPriceInTheWay = 8;

std::vector<double> priceOfIrregular(
  const FieldTopology& topology, const std::vector<std::uint8_t>& regular)
{
  std::vector<double> price;
  for (std::size_t i = 0; i < topology.fans.size() && !regular.empty(); ++i)
  {
    price.push_back(regular[topology.fans[i].vertex] != 0 ? kPriceInTheWay : 0.0);
  }
  return price;
}

// What a map cannot realize: a triangle's corner stays below half a turn.
std::string fanProblem(const Fan& fan, int turns, bool asked)
{
  if (turns < 1)
  {
    return fan.corners == 1 ? "no quarter turn in a triangle with three constrained edges"
                            : "no quarter turn";
  }
  if (turns > turnLimit(fan))
  {
    return std::to_string(turns) + " quarter turns in " + std::to_string(fan.corners) +
      " triangles";
  }
  if (!fan.sector && !asked && (turns < 3 || turns > 6))
  {
    return "valence " + std::to_string(turns);
  }
  return {};
}

// Fills status and failedAt.
void judgeTurns(const Mesh& mesh, const FieldTopology& topology,
  const TurnPrescription& prescription, const std::vector<int>& turns,
  const std::vector<std::uint8_t>& blocked, CrossField& field)
{
  for (Index i = 0; i < turns.size(); ++i)
  {
    std::string problem = fanProblem(topology.fans[i], turns[i], !prescription.isFree(i));
    if (problem.empty() && !blocked.empty() && blocked[i] != 0)
    {
      problem = "triangles around it that cannot carry the turns";
    }
    if (problem.empty())
    {
      continue;
    }
    if (field.failedAt.empty())
    {
      field.status.code = StatusCode::Infeasible;
      field.status.message =
        "ask for smaller quads, a larger feature angle or more coarse vertices: no cross field, as "
        "the vertex near " +
        placeText(mesh.position[topology.fans[i].vertex]) + " would have " + problem +
        (topology.fans[i].sector ? " between two features or on the boundary" : "");
    }
    field.failedAt.push_back(topology.fans[i].vertex);
  }
  if (field.failedAt.size() > 1)
  {
    field.status.message +=
      " (and " + std::to_string(field.failedAt.size() - 1) + " more such places)";
  }
}

void storeTurns(
  const Mesh& mesh, const FieldTopology& topology, const std::vector<int>& turns, CrossField& field)
{
  field.sectorTurns.assign(mesh.halfEdgeCount(), 0);
  field.turns.assign(mesh.vertexCount(), 0);
  for (std::size_t i = 0; i < turns.size(); ++i)
  {
    const Fan& fan = topology.fans[i];
    field.turns[fan.vertex] += turns[i];
    if (fan.sector)
    {
      field.sectorTurns[fan.first] = static_cast<std::int8_t>(turns[i]);
    }
  }
}

// What turn repair reads, for given jumps.
struct RepairData
{
  std::vector<double> residual; // per topology edge
  std::vector<int> turns;       // per fan

  RepairData(const Mesh& mesh, const FieldTopology& topology, const FieldConstraints& constraints,
    const std::vector<double>& angle, const std::vector<int>& jump)
    : turns(countTurns(mesh, topology, constraints, angle, jump))
  {
    for (const std::array<Index, 2>& edge : topology.edges)
    {
      residual.push_back(edgeResidual(topology, angle, mesh, edge[0], jump[edge[0]]));
    }
  }
};

void applyShift(
  const FieldTopology& topology, const std::vector<int>& shift, std::vector<int>& jump)
{
  for (std::size_t e = 0; e < topology.edges.size(); ++e)
  {
    jump[topology.edges[e][0]] += shift[e];
    jump[topology.edges[e][1]] -= shift[e];
  }
}

// Angles with jumps whose turns can be mapped.
struct Solution
{
  std::vector<double> angle;         // #F
  std::vector<int> jump;             // #H
  std::vector<int> turns;            // per fan
  std::vector<std::uint8_t> blocked; // per fan: no angles exist; empty when all do
  Status status;                     // of the prescription
};

// Irregular vertices in each component without constraints.
std::vector<std::size_t> countIrregular(
  const FieldTopology& topology, const PowerFields& fields, const std::vector<int>& turns)
{
  std::vector<std::size_t> count(fields.looseComponents, 0);
  for (std::size_t i = 0; i < turns.size(); ++i)
  {
    const Index component = fields.looseComponent[Mesh::face(topology.fans[i].first)];
    if (component != kInvalidIndex && turns[i] != 4)
    {
      ++count[component];
    }
  }
  return count;
}

// Takes over what `other` found in the components that `better` names.
void adopt(const FieldTopology& topology, const PowerFields& fields,
  const std::vector<std::uint8_t>& better, const Solution& other, Solution& solution)
{
  const auto taken = [&](Index f)
  { return fields.looseComponent[f] != kInvalidIndex && better[fields.looseComponent[f]] != 0; };
  for (Index f = 0; f < solution.angle.size(); ++f)
  {
    solution.angle[f] = taken(f) ? other.angle[f] : solution.angle[f];
  }
  for (Index h = 0; h < solution.jump.size(); ++h)
  {
    solution.jump[h] = taken(Mesh::face(h)) ? other.jump[h] : solution.jump[h];
  }
  for (std::size_t i = 0; i < solution.turns.size(); ++i)
  {
    solution.turns[i] =
      taken(Mesh::face(topology.fans[i].first)) ? other.turns[i] : solution.turns[i];
  }
}

// A field with more irregular vertices has to lessen the expected error of sizes over the surface by this factor.
constexpr double kWorthwhileError = 0.9;

double quadsOf(const FieldTopology& topology, const CrossFieldOptions& options)
{
  return topology.totalArea / (options.targetEdgeLength * options.targetEdgeLength);
}

// What turns of a solution are changed with.
struct Change
{
  const Mesh& mesh;
  const FieldTopology& topology;
  const FieldConstraints& constraints;
  const CrossFieldOptions& options;
  TurnRepairInput input; // of its repair, without what the solution has
};

// The turns, and jumps, of the solution with other ones prescribed; none where they cannot be had.
std::optional<Solution> withTurns(
  const Change& change, const TurnPrescription& prescription, const Solution& solution)
{
  const RepairData data(
    change.mesh, change.topology, change.constraints, solution.angle, solution.jump);
  TurnRepairInput input = change.input;
  if (!checkPrescription(change.mesh, change.topology, prescription, data.turns).ok())
  {
    return std::nullopt;
  }
  input.residual = &data.residual;
  input.turns = &data.turns;
  input.prescription = &prescription;
  const TurnRepairResult repair = repairTurns(input);
  if (!repair.complete)
  {
    return std::nullopt;
  }
  Solution other = solution;
  applyShift(change.topology, repair.shift, other.jump);
  other.turns = repair.turns;
  return other;
}

// Where sides of patches would have no length in any map, or one far from their own: other turns at the corners of
// these patches, in components whose sides all have some then. Returns the turns of sectors that are prescribed from
// then on.
std::vector<int> turnPatches(const Change& change, Solution& solution)
{
  const CrossFieldOptions& options = change.options;
  const auto sidesOf = [&](const Solution& of, const std::vector<std::int8_t>& matching)
  {
    return PatchSides({ change.mesh, change.topology, of.turns, matching,
      change.constraints.alignment, *change.input.natural, options.targetEdgeLength,
      options.sectorTurns, options.targetValences });
  };
  const std::vector<std::int8_t> matching =
    matchings(change.mesh, change.constraints.alignment, solution.jump);
  PatchSides sides = sidesOf(solution, matching);
  PatchStrips strips(sides);
  const std::size_t without = strips.find();
  if (strips.lessen(without) > 0)
  {
    sides.leaveOut(strips.patchesWithout());
  }
  SideLengths(sides, strips).evenOut();
  if (!sides.isAnyChanged())
  {
    return options.sectorTurns;
  }
  countTry(Try::TurnsForStrips);
  std::vector<int> sectors = sides.sectorTurns();
  std::optional<Solution> led = withTurns(change,
    prescribeTurns(change.mesh, change.topology, sides.targetValences(), sectors), solution);
  if (!led)
  {
    return options.sectorTurns;
  }
  // In a patch of several loops the flow decides how these lie to each other.
  const std::vector<std::int8_t> matchingLed =
    matchings(change.mesh, change.constraints.alignment, led->jump);
  PatchSides sidesLed = sidesOf(*led, matchingLed);
  if (PatchStrips(sidesLed).find() > without)
  {
    return options.sectorTurns;
  }
  countTryLed(Try::TurnsForStrips);
  solution = std::move(*led);
  return sectors;
}

// Where sizes are asked for: irregular vertices with which quads can have them, if turns can be moved so.
void adaptToSizes(const Change& change, const std::vector<int>& sectorTurns, Solution& solution)
{
  const CrossFieldOptions& options = change.options;
  const bool isAtPlaces = options.sizes == SizeWish::AtPlaces;
  const std::vector<int> targets = valencesForSizes(change.mesh, change.topology, solution.turns,
    options.targetValences, { options.sizes, quadsOf(change.topology, options) });
  if (targets.empty())
  {
    return;
  }
  countTry(Try::ValencesForSizes);
  std::optional<Solution> other =
    withTurns(change, prescribeTurns(change.mesh, change.topology, targets, sectorTurns), solution);
  if (other &&
    sizeError(change.mesh, change.topology, other->turns) <
      (isAtPlaces ? 1 : kWorthwhileError) * sizeError(change.mesh, change.topology, solution.turns))
  {
    countTryLed(Try::ValencesForSizes);
    solution = std::move(*other);
  }
}

// For each component the candidate with fewer irregular vertices after repair, the first on a tie.
Solution bestSolution(const Mesh& mesh, const FieldTopology& topology,
  const FieldConstraints& constraints, const PowerFields& fields,
  const TurnPrescription& prescription, const CrossFieldOptions& options)
{
  const double length = options.targetEdgeLength;
  const std::vector<double> natural = naturalTurns(topology, length);
  const std::vector<double> stiffness = stiffnessOf(topology, options.guides, constraints);
  const std::vector<double> irregularPrice = priceOfIrregular(topology, options.regular);
  const auto inputOf = [&](const RepairData& data) -> TurnRepairInput
  {
    return { &topology, &data.residual, &data.turns, &natural, length, &prescription, &stiffness,
      &irregularPrice };
  };
  Solution best;
  std::vector<std::size_t> fewest;
  bool hasOther = false; // some component has not the first one
  for (const std::vector<double>& candidate : fields.candidates)
  {
    const bool isOther = !best.angle.empty();
    if (isOther)
    {
      countTry(Try::OtherField);
    }
    Solution solution{ candidate, roundJumps(mesh, topology, candidate), {}, {}, {} };
    const RepairData data(mesh, topology, constraints, candidate, solution.jump);
    if (best.angle.empty())
    {
      // The sums that matter are the same for all candidates.
      solution.status = checkPrescription(mesh, topology, prescription, data.turns);
      if (!solution.status.ok())
      {
        solution.turns = data.turns;
        return solution;
      }
    }
    const TurnRepairResult repair = repairTurns(inputOf(data));
    if (!repair.complete && !prescription.turns.empty())
    {
      solution.status = { StatusCode::NotConverged,
        "ask for valences farther apart, or for more coarse vertices: the irregular vertices asked "
        "for are too many at one place for the coarse level" };
    }
    applyShift(topology, repair.shift, solution.jump);
    solution.turns = repair.turns;
    if (best.angle.empty() || (!best.status.ok() && solution.status.ok()))
    {
      best = std::move(solution);
      hasOther = isOther;
      fewest = countIrregular(topology, fields, best.turns);
      continue;
    }
    if (!solution.status.ok())
    {
      continue; // fewer irregular vertices than asked for are no gain
    }
    const std::vector<std::size_t> irregular = countIrregular(topology, fields, solution.turns);
    std::vector<std::uint8_t> better(fields.looseComponents);
    for (std::size_t c = 0; c < better.size(); ++c)
    {
      better[c] = irregular[c] < fewest[c] ? 1 : 0;
      hasOther = hasOther || better[c] != 0;
    }
    adopt(topology, fields, better, solution, best);
  }
  if (hasOther)
  {
    countTryLed(Try::OtherField);
  }

  const Change change{ mesh, topology, constraints, options,
    { &topology, nullptr, nullptr, &natural, length, nullptr, &stiffness, &irregularPrice } };
  if (best.status.ok())
  {
    const std::vector<int> sectors = turnPatches(change, best);
    if (!mesh.sizing.empty())
    {
      adaptToSizes(change, sectors, best);
    }
  }
  const RepairData data(mesh, topology, constraints, best.angle, best.jump);
  TurnRepairResult complete{ std::vector<int>(topology.edges.size(), 0), best.turns };
  best.blocked = completeTurns(mesh, inputOf(data), complete);
  applyShift(topology, complete.shift, best.jump);
  best.turns = complete.turns;
  return best;
}

std::vector<FieldGuide> fieldGuides(
  const std::vector<Guide>& guides, const FieldConstraints& constraints)
{
  std::vector<FieldGuide> result(guides.size());
  for (Index f = 0; f < guides.size(); ++f)
  {
    if (constraints.strength(f) > 0)
    {
      result[f] = { constraints.guideAngle[f], double{ guides[f].weight } };
    }
  }
  return result;
}

} // namespace

CrossField computeCrossField(const Mesh& mesh, const CrossFieldOptions& options)
{
  requireInput(mesh, options);
  const FieldTopology topology = buildFieldTopology(mesh);
  FieldConstraints constraints = fieldConstraints(mesh, topology);
  if (!options.guides.empty())
  {
    addGuides(mesh, topology, options.guides, options.targetEdgeLength, constraints);
  }
  const TurnPrescription prescription =
    prescribeTurns(mesh, topology, options.targetValences, options.sectorTurns);
  const PowerFields fields =
    powerFields(mesh, topology, constraints, { options.targetEdgeLength, options.progress });
  report(options.progress, 0.6, "cross field: turns");
  const Solution solution =
    bestSolution(mesh, topology, constraints, fields, prescription, options);

  CrossField field;
  report(options.progress, 0.8, "cross field: angles");
  field.angle = solveAngles(mesh, topology, constraints, solution.jump, solution.angle);
  // Angles never decide turns: the jumps do.
  assert(solution.turns == countTurns(mesh, topology, constraints, field.angle, solution.jump));
  field.guides = fieldGuides(options.guides, constraints);
  field.alignment = constraints.alignment;
  field.matching = matchings(mesh, field.alignment, solution.jump);
  storeTurns(mesh, topology, solution.turns, field);
  if (solution.status.ok())
  {
    judgeTurns(mesh, topology, prescription, solution.turns, solution.blocked, field);
  }
  else
  {
    field.status = solution.status;
  }
  report(options.progress, 1.0, "cross field: done");
  return field;
}

std::vector<std::uint8_t> integerVertices(const Mesh& mesh, const CrossField& field)
{
  std::vector<int> sectors(mesh.vertexCount(), 0);
  std::vector<std::uint8_t> boundary(mesh.vertexCount(), 0);
  std::vector<std::uint8_t> bent(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isConstrained(h))
    {
      const Index v = mesh.origin[h];
      ++sectors[v];
      boundary[v] |= mesh.isBoundary(h) ? 1 : 0;
      bent[v] |= field.sectorTurns[h] != 2 ? 1 : 0;
    }
  }
  std::vector<std::uint8_t> integer(mesh.vertexCount(), 0);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    // A curve that passes has one sector at a boundary, two inside; any other count is an end or junction.
    const int passing = boundary[v] != 0 ? 1 : 2;
    const bool constrained = sectors[v] > 0;
    integer[v] = constrained ? (bent[v] != 0 || sectors[v] != passing) : field.turns[v] != 4;
  }
  for (const SeamEdges& seam : field.seams)
  {
    for (const std::vector<Index>& edges : { seam.left, seam.right })
    {
      integer[mesh.origin[edges.front()]] = integer[mesh.target(edges.back())] = 1;
    }
  }
  return integer;
}

} // namespace quadrille
