// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/TurnPrescription.h"

#include "Base/DisjointSets.h"
#include "Base/PlaceText.h"
#include "Base/Refuse.h"
#include "CrossField/TurnRepair.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace quadrille
{
namespace
{

// Sets of fans whose turns have a fixed sum.
DisjointSets fansOfFixedSum(const FieldTopology& topology, const TurnPrescription& prescription)
{
  DisjointSets sets(topology.fans.size(), 1);
  for (const std::array<Index, 2>& edge : topology.edges)
  {
    sets.join(topology.fanOfCorner[edge[0]], topology.fanOfCorner[edge[1]]);
  }
  std::vector<Index> first(prescription.turns.size(), kInvalidIndex);
  for (Index i = 0; i < prescription.groupOfFan.size(); ++i)
  {
    const Index group = prescription.groupOfFan[i];
    if (group != kInvalidIndex)
    {
      first[group] = first[group] == kInvalidIndex ? i : first[group];
      sets.join(first[group], i);
    }
  }
  return sets;
}

// The sums of one set. Indices are what the turns are less than regular.
struct SetSums
{
  long turns = 0;
  long regular = 0;
  long asked = 0, askedRegular = 0;
  long least = 0, most = 0; // of the free fans
  std::size_t requests = 0, freeFans = 0;
  Index vertex = kInvalidIndex; // of a request
};

std::vector<SetSums> sumUp(const FieldTopology& topology, const TurnPrescription& prescription,
  const std::vector<int>& turns, DisjointSets& sets)
{
  std::vector<SetSums> sums(topology.fans.size());
  std::vector<std::uint8_t> counted(prescription.turns.size(), 0);
  for (Index i = 0; i < turns.size(); ++i)
  {
    const Fan& fan = topology.fans[i];
    SetSums& sum = sums[sets.find(i)];
    const int regular = fan.sector ? 2 : 4;
    sum.turns += turns[i];
    sum.regular += regular;
    if (prescription.isFree(i))
    {
      const bool stuck = fan.sector && fan.corners == 1; // no edge can change it
      sum.least += stuck ? turns[i] : fan.sector ? 1 : 3;
      sum.most += stuck ? turns[i] : fan.sector ? turnLimit(fan) : 6;
      sum.freeFans += stuck ? 0 : 1;
      continue;
    }
    sum.askedRegular += regular;
    if (counted[prescription.groupOfFan[i]] == 0)
    {
      counted[prescription.groupOfFan[i]] = 1;
      sum.asked += prescription.turns[prescription.groupOfFan[i]];
      sum.vertex = fan.vertex;
      ++sum.requests;
    }
  }
  return sums;
}

std::string textOfMissing(const Mesh& mesh, const SetSums& sum, long missing, bool holdsFeatures)
{
  std::ostringstream text;
  if (holdsFeatures)
  {
    text << "choose places on one side of features and boundaries: irregular vertices cannot pass "
            "features and boundaries: on the part of the surface "
         << "near " << placeText(mesh.position[sum.vertex]) << " that they bound, the sum of "
         << "4 - valence would change by " << std::abs(missing);
    return text.str();
  }
  text << "leave more points free (TargetValence 0), or change the targets by the sum that is "
          "missing: on the "
          "component near "
       << placeText(mesh.position[sum.vertex]) << ", 4 - valence has to sum up to "
       << sum.regular - sum.turns << " over all irregular vertices; the " << sum.requests
       << " vertices with a target sum up to " << sum.askedRegular - sum.asked << ", and ";
  if (sum.freeFans == 0)
  {
    text << "no vertex is free to take the missing " << missing;
  }
  else
  {
    text << "the " << sum.freeFans << " free ones cannot take all of the rest: " << missing
         << " are missing";
  }
  return text.str();
}

void prescribeValences(const Mesh& mesh, const FieldTopology& topology,
  const std::vector<int>& targetValence, TurnPrescription& result)
{
  refuseIf(targetValence.size() != mesh.vertexCount(), "cross field: ", targetValence.size(),
    " target valences for ", mesh.vertexCount(), " vertices");
  const std::vector<std::uint8_t> boundary = boundaryVertices(mesh);
  std::vector<Index> groupOfVertex(mesh.vertexCount(), kInvalidIndex);
  for (Index i = 0; i < topology.fans.size(); ++i)
  {
    const Index v = topology.fans[i].vertex;
    if (targetValence[v] == 0)
    {
      continue;
    }
    const int turns = targetValence[v] - (boundary[v] != 0 ? 2 : 0);
    if (turns < (boundary[v] != 0 ? 1 : 2))
    {
      throw InvalidInput("cross field: the vertex at " + placeText(mesh.position[v]) +
        " is to have valence " + std::to_string(targetValence[v]) +
        (boundary[v] != 0 ? ", but on the boundary the least is 3" : ", but the least is 2"));
    }
    if (groupOfVertex[v] == kInvalidIndex)
    {
      groupOfVertex[v] = static_cast<Index>(result.turns.size());
      result.turns.push_back(turns);
    }
    result.groupOfFan[i] = groupOfVertex[v];
  }
}

} // namespace

TurnPrescription prescribeTurns(const Mesh& mesh, const FieldTopology& topology,
  const std::vector<int>& targetValence, const std::vector<int>& sectorTurns)
{
  TurnPrescription result;
  const auto isFree = [](int turns) { return turns == 0; };
  if (std::all_of(targetValence.begin(), targetValence.end(), isFree) &&
    std::all_of(sectorTurns.begin(), sectorTurns.end(), isFree))
  {
    return result;
  }
  result.groupOfFan.assign(topology.fans.size(), kInvalidIndex);
  if (!targetValence.empty())
  {
    prescribeValences(mesh, topology, targetValence, result);
  }
  result.valences = result.turns.size();
  for (Index i = 0; i < topology.fans.size() && !sectorTurns.empty(); ++i)
  {
    const Fan& fan = topology.fans[i];
    if (fan.sector && result.groupOfFan[i] == kInvalidIndex && sectorTurns[fan.first] != 0)
    {
      result.groupOfFan[i] = static_cast<Index>(result.turns.size());
      result.turns.push_back(sectorTurns[fan.first]);
    }
  }
  return result;
}

Status checkPrescription(const Mesh& mesh, const FieldTopology& topology,
  const TurnPrescription& prescription, const std::vector<int>& turns)
{
  if (prescription.turns.empty())
  {
    return {};
  }
  DisjointSets sets = fansOfFixedSum(topology, prescription);
  for (const SetSums& sum : sumUp(topology, prescription, turns, sets))
  {
    // Turns that the free fans have to make together.
    const long left = sum.turns - sum.asked;
    const long missing = left < sum.least ? sum.least - left : std::min(0L, sum.most - left);
    if (sum.requests > 0 && missing != 0)
    {
      return { StatusCode::Infeasible,
        textOfMissing(mesh, sum, missing, prescription.turns.size() > prescription.valences) };
    }
  }
  return {};
}

} // namespace quadrille
