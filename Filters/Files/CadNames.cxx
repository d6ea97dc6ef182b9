// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/CadNames.h"

#include "Base/Lists.h"

#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace quadrille
{

namespace
{

constexpr int kNodeOnEdge = 2, kNodeOnVertex = 3; // of kCadPlace

vtkStringArray* stringsOf(vtkDataSet* data, const char* name)
{
  return vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray(name));
}

/// Where nodes are, as far as names need it.
class NodePlaces
{
public:
  explicit NodePlaces(vtkDataSet* data)
    : kinds_(data->GetPointData()->GetArray(arrays::kCadPlace)),
      ids_(data->GetPointData()->GetArray(arrays::kCadId)),
      ends_(data->GetFieldData()->GetArray(arrays::kCadEdgeEnds))
  {
    for (vtkIdType e = 0; isThere() && e < ends_->GetNumberOfTuples(); ++e)
    {
      const auto [found, isNew] = edgeBetween_.emplace(endsOf(e), e);
      found->second = isNew ? e : -1; // with the same ends as another one nobody knows
    }
  }

  bool isThere() const { return kinds_ && ids_ && ends_ && ends_->GetNumberOfComponents() == 2; }
  int kind(vtkIdType node) const { return static_cast<int>(kinds_->GetComponent(node, 0)); }
  vtkIdType id(vtkIdType node) const { return static_cast<vtkIdType>(ids_->GetComponent(node, 0)); }

  /// The edge of the file that two nodes lie on.
  std::optional<vtkIdType> edgeOf(vtkIdType a, vtkIdType b) const
  {
    if (kind(a) == kNodeOnVertex && kind(b) == kNodeOnVertex)
    {
      const auto found = edgeBetween_.find(std::minmax(id(a), id(b)));
      return found != edgeBetween_.end() && found->second >= 0 ? std::optional(found->second)
                                                               : std::nullopt;
    }
    if (kind(a) != kNodeOnEdge)
    {
      std::swap(a, b);
    }
    if (kind(a) != kNodeOnEdge || id(a) < 0 || id(a) >= ends_->GetNumberOfTuples())
    {
      return std::nullopt;
    }
    const auto [first, second] = endsOf(id(a));
    const bool isOn = kind(b) == kNodeOnEdge
      ? id(b) == id(a)
      : kind(b) == kNodeOnVertex && (id(b) == first || id(b) == second);
    return isOn ? std::optional(id(a)) : std::nullopt;
  }

private:
  std::pair<vtkIdType, vtkIdType> endsOf(vtkIdType edge) const
  {
    return std::minmax(static_cast<vtkIdType>(ends_->GetComponent(edge, 0)),
      static_cast<vtkIdType>(ends_->GetComponent(edge, 1)));
  }

  vtkDataArray* kinds_;
  vtkDataArray* ids_;
  vtkDataArray* ends_;
  std::map<std::pair<vtkIdType, vtkIdType>, vtkIdType> edgeBetween_;
};

/// By id: its name as a number in mesh.curveNames.
std::vector<Index> curvesByEdge(vtkStringArray* names, ElementMesh& mesh)
{
  std::map<std::string, Index> numbers;
  std::vector<Index> curves(static_cast<std::size_t>(names->GetNumberOfValues()), kInvalidIndex);
  for (std::size_t e = 0; e < curves.size(); ++e)
  {
    const std::string name = names->GetValue(static_cast<vtkIdType>(e));
    if (!name.empty())
    {
      const auto [found, isNew] = numbers.emplace(name, static_cast<Index>(mesh.curveNames.size()));
      if (isNew)
      {
        mesh.curveNames.push_back(name);
      }
      curves[e] = found->second;
    }
  }
  return curves;
}

void nameSides(const NodePlaces& places, vtkStringArray* names, ElementMesh& mesh)
{
  const std::vector<Index> curves = curvesByEdge(names, mesh);
  if (mesh.curveNames.empty())
  {
    return;
  }
  mesh.curveOf.assign(4 * mesh.elementCount(), kInvalidIndex);
  for (std::size_t side = 0; side < mesh.curveOf.size(); ++side)
  {
    const auto edge = places.edgeOf(static_cast<vtkIdType>(mesh.corner(side / 4, side % 4)),
      static_cast<vtkIdType>(mesh.corner(side / 4, side % 4 + 1)));
    if (edge && static_cast<std::size_t>(*edge) < curves.size())
    {
      mesh.curveOf[side] = curves[static_cast<std::size_t>(*edge)];
    }
  }
}

void nameNodes(const NodePlaces& places, vtkStringArray* names, ElementMesh& mesh)
{
  std::set<Index> corners(mesh.elements.begin(), mesh.elements.end()); // none that no element has
  for (const Index corner : corners)
  {
    const auto node = static_cast<vtkIdType>(corner);
    const vtkIdType id = places.kind(node) == kNodeOnVertex ? places.id(node) : -1;
    if (id >= 0 && id < names->GetNumberOfValues() && !names->GetValue(id).empty())
    {
      mesh.namedNodes.push_back({ corner, names->GetValue(id) });
    }
  }
}

bool hasNames(vtkStringArray* names)
{
  bool has = false;
  for (vtkIdType i = 0; names && i < names->GetNumberOfValues() && !has; ++i)
  {
    has = !names->GetValue(i).empty();
  }
  return has;
}

/// Adds those of the names that are not in `found`, each once.
void addMissing(
  vtkStringArray* names, const std::set<std::string>& found, std::vector<std::string>& missing)
{
  for (vtkIdType i = 0; names && i < names->GetNumberOfValues(); ++i)
  {
    const std::string name = names->GetValue(i);
    if (!name.empty() && found.count(name) == 0 &&
      std::find(missing.begin(), missing.end(), name) == missing.end())
    {
      missing.push_back(name);
    }
  }
}

} // namespace

void readCadNames(vtkDataSet* data, ElementMesh& mesh)
{
  vtkStringArray* const edges = stringsOf(data, arrays::kCadEdgeNames);
  vtkStringArray* const vertices = stringsOf(data, arrays::kCadVertexNames);
  if (!hasNames(edges) && !hasNames(vertices))
  {
    return;
  }
  const NodePlaces places(data);
  if (places.isThere() && hasNames(edges))
  {
    nameSides(places, edges, mesh);
  }
  if (places.isThere() && hasNames(vertices))
  {
    nameNodes(places, vertices, mesh);
  }
}

std::string cadNamesWithoutSet(vtkDataSet* data, const MeshSets& sets)
{
  std::set<std::string> curves, corners;
  for (const CurveSet& curve : sets.curves)
  {
    curves.insert(curve.isNamed ? curve.name : "");
  }
  for (const CornerSet& corner : sets.corners)
  {
    corners.insert(corner.name);
  }
  std::vector<std::string> missing;
  addMissing(stringsOf(data, arrays::kCadEdgeNames), curves, missing);
  addMissing(stringsOf(data, arrays::kCadVertexNames), corners, missing);
  if (missing.empty())
  {
    return {};
  }
  std::string list;
  for (std::size_t i = 0; i < missing.size() && i < kMostTold; ++i)
  {
    list += (i > 0 ? ", '" : "'") + missing[i] + "'";
  }
  return "edges and vertices of the CAD file without a set, as no nodes were put onto them or no "
         "edges of quads follow them: " +
    list +
    (missing.size() > kMostTold ? ", and " + std::to_string(missing.size() - kMostTold) + " more"
                                : "");
}

} // namespace quadrille
