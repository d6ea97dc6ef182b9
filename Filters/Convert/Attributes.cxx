// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/Attributes.h"

#include "Base/Parallel.h"
#include "Base/Types.h"
#include "Convert/Frame.h"
#include "Convert/PolyData.h"

#include <vtkAbstractArray.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkSmartPointer.h>
#include <vtkVariant.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <type_traits>
#include <unordered_map>
#include <utility>

namespace quadrille
{

namespace
{

/// Arrays that describe the source itself and would be wrong on anything made from it.
bool isOwn(const std::string& name)
{
  static const std::array<const char*, 25> own = { arrays::kFeatureEdges, arrays::kDetectedFeatures,
    arrays::kKnownCurvature, arrays::kIgm, arrays::kMatching, arrays::kDeterminant, arrays::kTwin,
    arrays::kFineFace, arrays::kFineVertex, arrays::kTurns, arrays::kIndex, arrays::kIntegerVertex,
    arrays::kSurfacePointId, arrays::kTextureCoordinates, arrays::kSourcePointIds,
    arrays::kSourceWeights, arrays::kSourceBarycentric, arrays::kValence, arrays::kOnBoundary,
    arrays::kLayoutPatch, arrays::kPartial, arrays::kQuadNormals, arrays::kFramePosition,
    arrays::kMirrorPoint, arrays::kRotatedPoint };
  return std::any_of(own.begin(), own.end(), [&name](const char* n) { return name == n; });
}

bool isColour(vtkAbstractArray* array)
{
  return array->GetDataType() == VTK_UNSIGNED_CHAR &&
    (array->GetNumberOfComponents() == 3 || array->GetNumberOfComponents() == 4);
}

bool isMixed(vtkAbstractArray* array)
{
  const int type = array->GetDataType();
  return type == VTK_FLOAT || type == VTK_DOUBLE || isColour(array);
}

/// Whether its tuples lie one after the other in memory, whole bytes each, so that threads can write them.
bool isPlain(vtkAbstractArray* array)
{
  return array->HasStandardMemoryLayout() && vtkDataArray::SafeDownCast(array) &&
    array->GetDataType() != VTK_BIT;
}

vtkSmartPointer<vtkAbstractArray> newLike(vtkAbstractArray* array, std::size_t count)
{
  auto result = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(array->GetDataType()));
  result->SetName(array->GetName());
  result->SetNumberOfComponents(array->GetNumberOfComponents());
  result->CopyComponentNames(array);
  result->SetNumberOfTuples(static_cast<vtkIdType>(count));
  return result;
}

std::size_t largest(const std::array<double, 3>& weights)
{
  return static_cast<std::size_t>(
    std::max_element(weights.begin(), weights.end()) - weights.begin());
}

template <class Real>
Real rounded(double value)
{
  if constexpr (std::is_floating_point_v<Real>)
  {
    return static_cast<Real>(value);
  }
  else
  {
    return static_cast<Real>(std::clamp(std::floor(value + 0.5), 0.0, 255.0));
  }
}

/// Calls body(real pointer, real pointer) for the two arrays of a mixed type.
template <class Body>
void withValues(vtkAbstractArray* from, vtkAbstractArray* to, const Body& body)
{
  void* source = from->GetVoidPointer(0);
  void* target = to->GetVoidPointer(0);
  switch (from->GetDataType())
  {
    case VTK_FLOAT:
      body(static_cast<const float*>(source), static_cast<float*>(target));
      break;
    case VTK_DOUBLE:
      body(static_cast<const double*>(source), static_cast<double*>(target));
      break;
    default:
      body(static_cast<const unsigned char*>(source), static_cast<unsigned char*>(target));
  }
}

//------------------------------------------------------------------------------
// Points

/// From the point with the largest weight on: exact there, and for a value that all three share.
template <class Real>
void mixPoint(const Real* from, std::size_t components, const PointOrigin& origin, Real* to)
{
  const std::size_t k = largest(origin.weights);
  const std::size_t i = (k + 1) % 3;
  const std::size_t j = (k + 2) % 3;
  const auto tuple = [&](std::size_t corner)
  { return from + components * static_cast<std::size_t>(origin.ids[corner]); };
  for (std::size_t c = 0; c < components; ++c)
  {
    const double base = static_cast<double>(tuple(k)[c]);
    double value = base;
    for (const std::size_t corner : { i, j })
    {
      if (origin.weights[corner] != 0) // what is there may be no number
      {
        value += origin.weights[corner] * (static_cast<double>(tuple(corner)[c]) - base);
      }
    }
    to[c] = rounded<Real>(value);
  }
}

/// Gives a mixed tuple unit length; `fallback` is taken where it has none.
template <class Real>
void normalize(Real* tuple, std::size_t components, const Real* fallback)
{
  double square = 0;
  for (std::size_t c = 0; c < components; ++c)
  {
    square += static_cast<double>(tuple[c]) * static_cast<double>(tuple[c]);
  }
  const double length = std::sqrt(square);
  for (std::size_t c = 0; c < components; ++c)
  {
    tuple[c] = length > 0 ? rounded<Real>(static_cast<double>(tuple[c]) / length) : fallback[c];
  }
}

void mixPoints(vtkAbstractArray* from, vtkAbstractArray* to,
  const std::vector<PointOrigin>& origins, bool normals, int threads)
{
  const auto components = static_cast<std::size_t>(from->GetNumberOfComponents());
  withValues(from, to,
    [&](auto* source, auto* target)
    {
      parallelForEach(origins.size(), kMediumChunk, threads,
        [&](std::size_t i)
        {
          const PointOrigin& o = origins[i];
          mixPoint(source, components, o, target + components * i);
          if (normals)
          {
            normalize(target + components * i, components,
              source + components * static_cast<std::size_t>(o.ids[largest(o.weights)]));
          }
        });
    });
}

//------------------------------------------------------------------------------
// Cells

void mixCells(vtkAbstractArray* from, vtkAbstractArray* to, const CellOrigins& origins,
  bool normals, int threads)
{
  const auto components = static_cast<std::size_t>(from->GetNumberOfComponents());
  withValues(from, to,
    [&](auto* source, auto* target)
    {
      using Real = std::remove_pointer_t<decltype(target)>;
      parallelForEach(origins.first.size() - 1, kMediumChunk, threads,
        [&](std::size_t q)
        {
          const auto* base =
            source + components * static_cast<std::size_t>(origins.shares[origins.first[q]].cell);
          for (std::size_t c = 0; c < components; ++c)
          {
            double value = static_cast<double>(base[c]);
            for (std::size_t i = origins.first[q] + 1; i < origins.first[q + 1]; ++i)
            {
              const CellOrigins::Share& share = origins.shares[i];
              value += share.weight *
                (static_cast<double>(
                   source[components * static_cast<std::size_t>(share.cell) + c]) -
                  static_cast<double>(base[c]));
            }
            target[components * q + c] = rounded<Real>(value);
          }
          if (normals)
          {
            normalize(target + components * q, components, base);
          }
        });
    });
}

/// A number per tuple, the same for equal ones.
class TupleKeys
{
public:
  explicit TupleKeys(vtkAbstractArray* array)
    : bytes_(static_cast<std::size_t>(array->GetNumberOfComponents() * array->GetDataTypeSize()))
  {
    if (isPlain(array) && bytes_ <= sizeof(std::uint64_t))
    {
      data_ = static_cast<const char*>(array->GetVoidPointer(0));
      return;
    }
    number(array);
  }

  std::uint64_t operator()(vtkIdType cell) const
  {
    const auto i = static_cast<std::size_t>(cell);
    if (!data_)
    {
      return numbers_[i];
    }
    std::uint64_t key = 0;
    std::memcpy(&key, data_ + bytes_ * i, bytes_);
    return key;
  }

private:
  void number(vtkAbstractArray* array)
  {
    const vtkIdType count = array->GetNumberOfTuples();
    const int components = array->GetNumberOfComponents();
    std::unordered_map<std::string, std::uint64_t> seen;
    std::string key;
    const char* plain =
      isPlain(array) ? static_cast<const char*>(array->GetVoidPointer(0)) : nullptr;
    // The variants of VTK's bits are empty.
    vtkDataArray* bits =
      array->GetDataType() == VTK_BIT ? vtkDataArray::SafeDownCast(array) : nullptr;
    numbers_.reserve(static_cast<std::size_t>(count));
    for (vtkIdType i = 0; i < count; ++i)
    {
      key.clear();
      if (plain)
      {
        key.assign(plain + bytes_ * static_cast<std::size_t>(i), bytes_);
      }
      for (int c = 0; !plain && c < components; ++c)
      {
        const vtkVariant value =
          bits ? vtkVariant(bits->GetComponent(i, c)) : array->GetVariantValue(i * components + c);
        const std::string text = value.ToString();
        key += std::to_string(value.GetType()) + " " + std::to_string(text.size()) + " " + text;
      }
      numbers_.push_back(seen.try_emplace(key, seen.size()).first->second);
    }
  }

  std::size_t bytes_;
  const char* data_ = nullptr; ///< of short plain tuples, which are their own numbers
  std::vector<std::uint64_t> numbers_;
};

struct Part
{
  std::uint64_t key;
  vtkIdType cell; ///< the lowest that has it
  double weight;
};

/// Joins parts with the same key.
void sumParts(std::vector<Part>& parts)
{
  std::stable_sort(
    parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.key < b.key; });
  std::size_t used = 0;
  for (const Part& part : parts)
  {
    if (used > 0 && part.key == parts[used - 1].key)
    {
      parts[used - 1].weight += part.weight;
      parts[used - 1].cell = std::min(parts[used - 1].cell, part.cell);
    }
    else
    {
      parts[used++] = part;
    }
  }
  parts.resize(used);
}

/// Of all tuples of one cell's origins a cell with the one that has the largest part.
vtkIdType majority(
  const CellOrigins& origins, std::size_t q, const TupleKeys& keys, std::vector<Part>& parts)
{
  parts.clear();
  for (std::size_t i = origins.first[q]; i < origins.first[q + 1]; ++i)
  {
    const CellOrigins::Share& share = origins.shares[i];
    parts.push_back({ keys(share.cell), share.cell, share.weight });
  }
  const std::uint64_t centre = parts.front().key;
  sumParts(parts);
  double most = 0;
  for (const Part& part : parts)
  {
    most = std::max(most, part.weight);
  }
  vtkIdType best = -1;
  for (const Part& part : parts)
  {
    if (part.weight < most - kRounding)
    {
      continue;
    }
    if (part.key == centre)
    {
      return part.cell;
    }
    best = best < 0 ? part.cell : std::min(best, part.cell);
  }
  return best;
}

std::vector<vtkIdType> majorities(vtkAbstractArray* from, const CellOrigins& origins, int threads)
{
  const TupleKeys keys(from);
  std::vector<vtkIdType> result(origins.first.size() - 1);
  parallelFor(result.size(), kMediumChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<Part> parts;
      for (std::size_t q = begin; q < end; ++q)
      {
        result[q] = majority(origins, q, keys, parts);
      }
    });
  return result;
}

//------------------------------------------------------------------------------
// Both

/// Tuple ids(i) of `from` becomes tuple i of `to`.
template <class Ids>
void copyTuples(vtkAbstractArray* from, vtkAbstractArray* to, const Ids& ids, int threads)
{
  const auto count = static_cast<std::size_t>(to->GetNumberOfTuples());
  if (!isPlain(from) || !isPlain(to))
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      to->SetTuple(static_cast<vtkIdType>(i), ids(i), from);
    }
    return;
  }
  const auto bytes =
    static_cast<std::size_t>(from->GetNumberOfComponents() * from->GetDataTypeSize());
  const char* source = static_cast<const char*>(from->GetVoidPointer(0));
  char* target = static_cast<char*>(to->GetVoidPointer(0));
  parallelForEach(count, kMediumChunk, threads,
    [&](std::size_t i)
    { std::memcpy(target + bytes * i, source + bytes * static_cast<std::size_t>(ids(i)), bytes); });
}

/// The array itself, or a copy whose tuples lie one after the other where that is needed to mix them.
vtkSmartPointer<vtkAbstractArray> readable(vtkAbstractArray* array)
{
  if (!isMixed(array) || isPlain(array))
  {
    return array;
  }
  auto copy = newLike(array, static_cast<std::size_t>(array->GetNumberOfTuples()));
  vtkDataArray::SafeDownCast(copy)->DeepCopy(vtkDataArray::SafeDownCast(array));
  return copy;
}

/// Makes the same arrays active as on the source. Only what SetActiveAttribute allows.
void copyActive(vtkDataSetAttributes* source, vtkDataSetAttributes* target,
  const std::map<vtkAbstractArray*, int>& targetIndex)
{
  for (const int type :
    { vtkDataSetAttributes::SCALARS, vtkDataSetAttributes::VECTORS, vtkDataSetAttributes::NORMALS,
      vtkDataSetAttributes::TCOORDS, vtkDataSetAttributes::TENSORS })
  {
    const auto found = targetIndex.find(source->GetAbstractAttribute(type));
    if (found != targetIndex.end())
    {
      target->SetActiveAttribute(found->second, type);
    }
  }
}

std::string describeShort(vtkAbstractArray* array, vtkIdType needed, const char* elements)
{
  std::ostringstream text;
  text << "array '" << (array->GetName() ? array->GetName() : "") << "' has "
       << array->GetNumberOfTuples() << " tuples for " << needed << " " << elements
       << " and is not carried over";
  return text.str();
}

/// Calls fill(from, to, whether these are the active normals) for each array that is carried.
template <class Fill>
std::vector<std::string> carry(vtkDataSetAttributes* source, vtkIdType needed, const char* elements,
  vtkDataSetAttributes* target, std::size_t count, const Fill& fill)
{
  std::vector<std::string> notCarried;
  std::map<vtkAbstractArray*, int> targetIndex;
  vtkAbstractArray* normals = source->GetAbstractAttribute(vtkDataSetAttributes::NORMALS);
  for (int i = 0; i < source->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = source->GetAbstractArray(i);
    if (array->GetName() && isOwn(array->GetName()))
    {
      continue;
    }
    if (array->GetNumberOfTuples() < needed)
    {
      notCarried.push_back(describeShort(array, needed, elements));
      continue;
    }
    vtkSmartPointer<vtkAbstractArray> result = newLike(array, count);
    if (count > 0)
    {
      fill(readable(array).Get(), result.Get(), array == normals && isMixed(array));
    }
    targetIndex[array] = target->AddArray(result);
  }
  copyActive(source, target, targetIndex);
  return notCarried;
}

} // namespace

std::vector<std::string> carryPointArrays(vtkDataSetAttributes* source, vtkIdType sourcePoints,
  vtkDataSetAttributes* target, const std::vector<PointOrigin>& origins, int threads)
{
  return carry(source, sourcePoints, "points", target, origins.size(),
    [&](vtkAbstractArray* from, vtkAbstractArray* to, bool normals)
    {
      if (isMixed(from))
      {
        mixPoints(from, to, origins, normals, threads);
        return;
      }
      copyTuples(
        from, to, [&](std::size_t i) { return origins[i].ids[largest(origins[i].weights)]; },
        threads);
    });
}

std::vector<std::string> carryCellArrays(vtkDataSetAttributes* source, vtkIdType sourceCells,
  vtkDataSetAttributes* target, const std::vector<vtkIdType>& origins, int threads)
{
  return carry(source, sourceCells, "cells", target, origins.size(),
    [&](vtkAbstractArray* from, vtkAbstractArray* to, bool)
    {
      copyTuples(
        from, to, [&](std::size_t i) { return origins[i]; }, threads);
    });
}

std::vector<std::string> carryCellArrays(vtkDataSetAttributes* source, vtkIdType sourceCells,
  vtkDataSetAttributes* target, const CellOrigins& origins, int threads)
{
  return carry(source, sourceCells, "cells", target, origins.first.size() - 1,
    [&](vtkAbstractArray* from, vtkAbstractArray* to, bool normals)
    {
      if (isMixed(from))
      {
        mixCells(from, to, origins, normals, threads);
        return;
      }
      const std::vector<vtkIdType> cells = majorities(from, origins, threads);
      copyTuples(
        from, to, [&](std::size_t i) { return cells[i]; }, threads);
    });
}

} // namespace quadrille
