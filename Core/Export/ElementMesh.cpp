// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Export/ElementMesh.h"

#include "Base/Progress.h"
#include "Base/Refuse.h"

#include <cmath>

namespace quadrille
{

namespace
{

void requireSize(std::size_t size, std::size_t elements, const char* what)
{
  refuseIf(size != 0 && size != elements, what, " are given for ", size,
    " elements, but there are ", elements);
}

void requireSizes(const ElementMesh& mesh)
{
  refuseIf(mesh.nodesPerElement != 4 && mesh.nodesPerElement != 8 && mesh.nodesPerElement != 9,
    "elements have ", mesh.nodesPerElement, " nodes, but only 4, 8 or 9 are known");
  const std::size_t count = mesh.elementCount();
  refuseIf(count * static_cast<std::size_t>(mesh.nodesPerElement) != mesh.elements.size(),
    "the list of elements ends in the middle of element ", count);
  requireSize(mesh.patchOf.size(), count, "patches");
  requireSize(mesh.featureEdges.size(), count, "feature edges");
  requireSize(mesh.thickness.size(), count, "thicknesses");
  requireSize(mesh.axis.size(), count, "axes");
  refuseIf(mesh.patches.empty() && count > 0, "there are elements, but no patch");
}

void requireElement(const ElementMesh& mesh, std::size_t e)
{
  const auto nodes = static_cast<std::size_t>(mesh.nodesPerElement);
  for (std::size_t i = 0; i < nodes; ++i)
  {
    const Index node = mesh.element(e)[i];
    refuseIf(node >= mesh.nodes.size(), "element ", e, " has the node ", node, ", but there are ",
      mesh.nodes.size());
    for (std::size_t k = 0; k < i; ++k)
    {
      refuseIf(mesh.element(e)[k] == node, "element ", e, " has the node ", node, " twice");
    }
  }
  if (mesh.patch(e) >= mesh.patches.size())
  {
    refuse("element ", e, " is of patch ", mesh.patch(e), ", but there are ", mesh.patches.size());
  }
}

void requireProperties(const ElementMesh& mesh, std::size_t e)
{
  if (!mesh.thickness.empty())
  {
    refuseIf(!(mesh.thickness[e] > 0 && std::isfinite(mesh.thickness[e])), "element ", e,
      " has the thickness ", mesh.thickness[e], "; give it one above 0");
  }
  if (!mesh.axis.empty())
  {
    const double length = mesh.axis[e].norm();
    refuseIf(!(length == 0 || std::abs(length - 1) < kRoundingOfSingle), "the axis of element ", e,
      " has the length ", length, "; give a unit vector, or zero where it has none");
  }
}

void requireNames(const ElementMesh& mesh)
{
  for (const Index curve : mesh.curveOf)
  {
    refuseIf(curve != kInvalidIndex && curve >= mesh.curveNames.size(), "a side is of curve ",
      curve, ", but there are ", mesh.curveNames.size());
  }
  for (const NamedNode& named : mesh.namedNodes)
  {
    refuseIf(named.node >= mesh.nodes.size(), "node ", named.node, " has the name '", named.name,
      "', but there are ", mesh.nodes.size());
  }
}

} // namespace

void requireValid(const ElementMesh& mesh)
{
  requireSizes(mesh);
  requireNames(mesh);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    pollNowAndThen(i);
    refuseIf(!mesh.nodes[i].allFinite(), "node ", i, " has a coordinate that is no number");
  }
  for (std::size_t e = 0; e < mesh.elementCount(); ++e)
  {
    pollNowAndThen(e);
    requireElement(mesh, e);
    requireProperties(mesh, e);
  }
}

std::string writingText(const ElementMesh& mesh)
{
  return "writing " + std::to_string(mesh.elementCount()) + " elements";
}

Vector3 elementAreaVector(const ElementMesh& mesh, std::size_t element)
{
  const auto corner = [&](std::size_t i) -> const Vector3&
  { return mesh.nodes[mesh.corner(element, i)]; };
  return (corner(2) - corner(0)).cross(corner(3) - corner(1));
}

Vector3 elementNormal(const ElementMesh& mesh, std::size_t element)
{
  const Vector3 normal = elementAreaVector(mesh, element);
  const double length = normal.stableNorm();
  return length > 0 ? Vector3(normal / length) : Vector3(Vector3::Zero());
}

} // namespace quadrille
