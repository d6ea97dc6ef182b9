// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleUniquePoints.h"

#include "vtkObjectFactory.h"
#include "vtkPoints.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <unordered_map>

struct vtkQuadrilleUniquePoints::Internals
{
  /// Three coordinates in single precision. Compared as bits, so that what is no number equals itself.
  using SinglePoint = std::array<std::uint32_t, 3>;

  struct HashOfPoint
  {
    std::size_t operator()(const SinglePoint& p) const
    {
      std::uint64_t hash = 0;
      for (const std::uint32_t b : p)
      {
        hash = (hash ^ b) * 0x9e3779b97f4a7c15ULL;
        hash ^= hash >> 32;
      }
      return static_cast<std::size_t>(hash);
    }
  };

  static SinglePoint InSingle(const double x[3])
  {
    SinglePoint bits{};
    for (std::size_t i = 0; i < 3; ++i)
    {
      const float single = static_cast<float>(x[i]) + 0.0F; // both zeros are one coordinate
      std::memcpy(&bits[i], &single, sizeof(single));
    }
    return bits;
  }

  std::unordered_map<SinglePoint, vtkIdType, HashOfPoint> Known;
};

vtkStandardNewMacro(vtkQuadrilleUniquePoints);

//------------------------------------------------------------------------------
vtkQuadrilleUniquePoints::vtkQuadrilleUniquePoints() : Ids(std::make_unique<Internals>()) {}

vtkQuadrilleUniquePoints::~vtkQuadrilleUniquePoints() = default;

//------------------------------------------------------------------------------
int vtkQuadrilleUniquePoints::InitPointInsertion(vtkPoints* points, const double bounds[6])
{
  return this->InitPointInsertion(points, bounds, 0);
}

//------------------------------------------------------------------------------
int vtkQuadrilleUniquePoints::InitPointInsertion(
  vtkPoints* points, const double bounds[6], vtkIdType size)
{
  this->Ids->Known.clear();
  this->Ids->Known.reserve(static_cast<std::size_t>(size));
  return this->Superclass::InitPointInsertion(points, bounds, size);
}

//------------------------------------------------------------------------------
int vtkQuadrilleUniquePoints::InsertUniquePoint(const double x[3], vtkIdType& id)
{
  const auto [known, isNew] =
    this->Ids->Known.try_emplace(Internals::InSingle(x), this->Points->GetNumberOfPoints());
  id = known->second;
  if (isNew)
  {
    this->Points->InsertNextPoint(x);
  }
  return isNew ? 1 : 0;
}

//------------------------------------------------------------------------------
vtkIdType vtkQuadrilleUniquePoints::IsInsertedPoint(const double x[3])
{
  const auto known = this->Ids->Known.find(Internals::InSingle(x));
  return known == this->Ids->Known.end() ? -1 : known->second;
}

//------------------------------------------------------------------------------
vtkIdType vtkQuadrilleUniquePoints::IsInsertedPoint(double x, double y, double z)
{
  const double p[3] = { x, y, z };
  return this->IsInsertedPoint(p);
}

//------------------------------------------------------------------------------
void vtkQuadrilleUniquePoints::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Points known: " << this->Ids->Known.size() << "\n";
}
