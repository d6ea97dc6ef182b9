// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What one rank gets of the quads of a spread surface: packed on the owner, put together on the rank.
#pragma once

#include "Convert/Pieces.h"
#include "Ranks/Bytes.h"
#include "Ranks/Packing.h"
#include "Ranks/PlacedQuads.h"

#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

class vtkDataArray;
class vtkDataSetAttributes;
class vtkPolyData;

namespace quadrille
{

/// The rank that has the cell SourceCellId.
constexpr const char* kSourceRank = "SourceRank";

/// Global ids of the points and cells of a share.
constexpr const char* kPointIds = "GlobalPointIds";
constexpr const char* kCellIds = "GlobalCellIds";

/// The arrays of a model as they are on quads: without those that describe the surface itself, and with those that say
/// where the quads come from.
void carriedModel(vtkDataSetAttributes* model, bool withPoints, vtkDataSetAttributes* target);

/// What one rank gets: its quads, then its ghosts, with the arrays that the filter made.
std::string packShare(vtkPolyData* quads, const PlacedQuads& placed, const Distribution& ranks,
  std::size_t rank, bool hasGhosts, vtkPolyData* model);

/// Items from all ranks, put to their places in a share.
class ReceivedItems
{
public:
  /// ids: global ones of the share's items.
  explicit ReceivedItems(vtkDataArray* ids);

  /// Calls place(local id, number in the message, places).
  template <class Place>
  void take(Unpacker& unpacker, const Place& place)
  {
    const auto ids = unpacker.values<std::int64_t>();
    const auto places = unpacker.values<double>();
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
      const auto found = std::lower_bound(
        local_.begin(), local_.end(), std::pair<std::int64_t, vtkIdType>(ids[i], 0));
      origins_[static_cast<std::size_t>(found->second)] = { sources_.size(),
        static_cast<vtkIdType>(i) };
      if (!places.empty())
      {
        place(found->second, places.data() + 3 * i);
      }
    }
    sources_.push_back(vtkSmartPointer<vtkPointData>::New());
    unpackArrays(unpacker, sources_.back());
  }

  /// The arrays in an order that all ranks have: those of the model first.
  void write(vtkDataSetAttributes* model, vtkDataSetAttributes* target) const;

private:
  std::vector<std::pair<std::int64_t, vtkIdType>> local_;
  std::vector<TupleOrigin> origins_;
  std::vector<vtkSmartPointer<vtkPointData>> sources_;
};

/// As the filter does for a surface in one place: where there are features, points on them have no one normal; else the
/// normals that the surface has go before those of the quads.
void chooseNormals(vtkPointData* data);

} // namespace quadrille
