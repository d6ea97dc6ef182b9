// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The costs that E_G is compared with [Ebke et al. 2016, Section 5.1 and Figure 13]: E_QEM, the quadric error metric
/// [Garland and Heckbert 1997], and E_uni, the shortest edge. Only quadrille-costs and tests ask phase 2 for them.
#pragma once

#include "Hierarchy/DecimationMesh.h"
#include "Hierarchy/Hierarchy.h"
#include "Hierarchy/VertexRemoval.h"

#include <Eigen/Core>

#include <vector>

namespace quadrille
{

/// Sum of squared distances to planes, each times a weight.
struct Quadric
{
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vector3 b = Vector3::Zero();
  double c = 0;

  void addPlane(const Vector3& normal, double offset, double weight)
  {
    a += weight * normal * normal.transpose();
    b += weight * offset * normal;
    c += weight * offset * offset;
  }
  void add(const Quadric& other)
  {
    a += other.a;
    b += other.b;
    c += other.c;
  }
  double at(const Vector3& p) const { return p.dot(a * p) + 2 * b.dot(p) + c; }
};

class ComparedCost
{
public:
  /// cost: Quadric or Uniform. E_QEM begins with the planes of the mesh's faces, by their areas. mesh must outlive this
  /// object.
  ComparedCost(const DecimationMesh& mesh, DecimationCost cost);

  /// Of the removal of the vertex that was gathered. shortestEdge: VertexRemoval::shortestEdge() of it.
  double of(const VertexRemoval& removal, double shortestEdge) const;
  /// The vertex that was gathered goes: its quadric goes to the ring vertex where it is least.
  void remove(const VertexRemoval& removal);

private:
  const DecimationMesh& mesh_;
  std::vector<Quadric> quadric_; ///< #V; empty for E_uni
};

} // namespace quadrille
