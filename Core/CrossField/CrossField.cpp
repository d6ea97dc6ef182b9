// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/CrossField.h"

#include "CrossField/FieldTopology.h"
#include "CrossField/PowerField.h"
#include "CrossField/TurnRepair.h"
#include "CrossField/TurnTargets.h"
#include "CrossField/Turns.h"

#include <cassert>
#include <cmath>
#include <string>

namespace quadrille
{
namespace
{

void requireInput(const Mesh& mesh, const CrossFieldOptions& options)
{
  if (mesh.faceCount() == 0)
  {
    throw InvalidInput("cross field: the mesh has no faces");
  }
  if (!(options.targetEdgeLength > 0) || !std::isfinite(options.targetEdgeLength))
  {
    throw InvalidInput("cross field: targetEdgeLength has to be positive and finite");
  }
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

// What a map cannot realize: a triangle's corner stays below half a turn.
std::string fanProblem(const Fan& fan, int turns)
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
  if (!fan.sector && (turns < 3 || turns > 6))
  {
    return "valence " + std::to_string(turns);
  }
  return {};
}

Status turnStatus(const FieldTopology& topology, const std::vector<int>& turns)
{
  Status status;
  std::size_t count = 0;
  for (std::size_t i = 0; i < turns.size(); ++i)
  {
    const std::string problem = fanProblem(topology.fans[i], turns[i]);
    if (problem.empty())
    {
      continue;
    }
    if (count++ == 0)
    {
      status.code = StatusCode::Infeasible;
      status.message = "cross field: vertex " + std::to_string(topology.fans[i].vertex) + " has " +
        problem + (topology.fans[i].sector ? " between two constrained edges" : "");
    }
  }
  if (count > 1)
  {
    status.message += " (and " + std::to_string(count - 1) + " more such places)";
  }
  if (count > 0)
  {
    status.message += "; more coarse vertices or fewer features there would help";
  }
  return status;
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

// Shifts the jumps until every fan's turns can be mapped; returns the turns.
std::vector<int> repairJumps(const Mesh& mesh, const FieldTopology& topology,
  const FieldConstraints& constraints, const std::vector<double>& angle, double length,
  std::vector<int>& jump)
{
  const std::vector<int> turns = countTurns(mesh, topology, constraints, angle, jump);
  const std::vector<double> natural = naturalTurns(topology, length);
  std::vector<double> residual;
  for (const std::array<Index, 2>& edge : topology.edges)
  {
    residual.push_back(edgeResidual(topology, angle, mesh, edge[0], jump[edge[0]]));
  }
  const TurnRepairResult repair = repairTurns({ &topology, &residual, &turns, &natural, length });
  for (std::size_t e = 0; e < topology.edges.size(); ++e)
  {
    jump[topology.edges[e][0]] += repair.shift[e];
    jump[topology.edges[e][1]] -= repair.shift[e];
  }
  return repair.turns;
}

// Angles with jumps whose turns can be mapped.
struct Solution
{
  std::vector<double> angle; // #F
  std::vector<int> jump;     // #H
  std::vector<int> turns;    // per fan
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

// For each component the candidate with fewer irregular vertices after repair, the first on a tie.
Solution bestSolution(const Mesh& mesh, const FieldTopology& topology,
  const FieldConstraints& constraints, const PowerFields& fields, double length)
{
  Solution best;
  std::vector<std::size_t> fewest;
  for (const std::vector<double>& candidate : fields.candidates)
  {
    Solution solution{ candidate, roundJumps(mesh, topology, candidate), {} };
    solution.turns = repairJumps(mesh, topology, constraints, candidate, length, solution.jump);
    if (best.angle.empty())
    {
      best = std::move(solution);
      fewest = countIrregular(topology, fields, best.turns);
      continue;
    }
    const std::vector<std::size_t> irregular = countIrregular(topology, fields, solution.turns);
    std::vector<std::uint8_t> better(fields.looseComponents);
    for (std::size_t c = 0; c < better.size(); ++c)
    {
      better[c] = irregular[c] < fewest[c] ? 1 : 0;
    }
    adopt(topology, fields, better, solution, best);
  }
  return best;
}

} // namespace

CrossField computeCrossField(const Mesh& mesh, const CrossFieldOptions& options)
{
  requireInput(mesh, options);
  const FieldTopology topology = buildFieldTopology(mesh);
  const FieldConstraints constraints = fieldConstraints(mesh, topology);
  const PowerFields fields =
    powerFields(mesh, topology, constraints, { options.targetEdgeLength, options.progress });
  report(options.progress, 0.6, "cross field: turns");
  const Solution solution =
    bestSolution(mesh, topology, constraints, fields, options.targetEdgeLength);

  CrossField field;
  report(options.progress, 0.8, "cross field: angles");
  field.angle = solveAngles(mesh, topology, constraints, solution.jump, solution.angle);
  // Angles never decide turns: the jumps do.
  assert(solution.turns == countTurns(mesh, topology, constraints, field.angle, solution.jump));
  field.alignment = constraints.alignment;
  field.matching = matchings(mesh, field.alignment, solution.jump);
  storeTurns(mesh, topology, solution.turns, field);
  field.status = turnStatus(topology, solution.turns);
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
  return integer;
}

} // namespace quadrille
