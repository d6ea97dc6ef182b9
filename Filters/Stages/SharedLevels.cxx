// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Stages/SharedLevels.h"

#include "Convert/PolyData.h"
#include "Mesh/ContentHash.h"
#include "Pipeline/ResultStore.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <mutex>

namespace quadrille
{

namespace
{

/// Those that are held somewhere in this process, without holding them. One for the process, as filters know nothing of
/// each other: between them are data objects, which ParaView copies and hands on.
template <class Shared>
class Registry
{
public:
  static Registry& ofProcess()
  {
    static Registry registry;
    return registry;
  }

  void add(const std::shared_ptr<const Shared>& shared)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    known_.erase(std::remove_if(known_.begin(), known_.end(),
                   [](const std::weak_ptr<const Shared>& known) { return known.expired(); }),
      known_.end());
    known_.push_back(shared);
  }

  template <class Key>
  std::shared_ptr<const Shared> find(const Key& key)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const std::weak_ptr<const Shared>& known : known_)
    {
      std::shared_ptr<const Shared> shared = known.lock();
      if (shared && shared->key == key)
      {
        return shared;
      }
    }
    return nullptr;
  }

private:
  std::mutex mutex_;
  std::vector<std::weak_ptr<const Shared>> known_;
};

/// Hashes arrays one after the other.
class ArrayHash
{
public:
  explicit ArrayHash(int threads) : threads_(threads) {}

  /// Null: counts as an array that is missing.
  void add(vtkDataArray* array)
  {
    const int type = array ? array->GetDataType() : -1;
    const int components = array ? array->GetNumberOfComponents() : 0;
    mix(static_cast<std::uint64_t>(type + 1) << 32 | static_cast<std::uint64_t>(components));
    if (!array)
    {
      return;
    }
    plain_ = plain_ && array->HasStandardMemoryLayout() && type != VTK_BIT;
    if (plain_)
    {
      const auto bytes = static_cast<std::size_t>(array->GetNumberOfValues()) *
        static_cast<std::size_t>(array->GetDataTypeSize());
      mix(contentHash(array->GetVoidPointer(0), bytes, threads_));
    }
  }
  void mix(std::uint64_t word) { hash_ = combineHashes(hash_, word); }

  std::optional<std::uint64_t> result() const
  {
    return plain_ ? std::optional<std::uint64_t>(hash_) : std::nullopt;
  }

private:
  int threads_;
  bool plain_ = true;
  std::uint64_t hash_ = 0;
};

} // namespace

std::uint64_t drawnHash(DrawnRequests drawn)
{
  drawn.strokes.clear(); // guides of the levels
  KeyMaker key;
  for (const FeatureRequest& feature : drawn.features)
  {
    key.add(std::uint64_t{ feature.points.size() });
  }
  for (const ValencePlace& asked : drawn.valences)
  {
    key.add(static_cast<std::uint64_t>(asked.valence));
  }
  for (const SizeRequest& size : drawn.sizes)
  {
    key.add(size.factor).add(static_cast<std::uint64_t>(size.order));
  }
  if (!drawn.cleared.empty())
  {
    key.add(std::uint64_t{ drawn.cleared.size() });
  }
  drawn.visit([&](const Vector3& p) { key.add(p[0]).add(p[1]).add(p[2]); },
    [&](double length) { key.add(length); });
  return key.key();
}

std::shared_ptr<const SharedSurface> findSharedSurface(const SurfaceKey& key)
{
  return Registry<SharedSurface>::ofProcess().find(key);
}

std::shared_ptr<const SharedMap> findSharedMap(std::uint64_t key)
{
  return Registry<SharedMap>::ofProcess().find(key);
}

void share(const std::shared_ptr<const SharedSurface>& surface)
{
  Registry<SharedSurface>::ofProcess().add(surface);
}

void share(const std::shared_ptr<const SharedMap>& map)
{
  Registry<SharedMap>::ofProcess().add(map);
}

std::optional<std::uint64_t> mappedSurfaceHash(vtkPolyData* data, int threads)
{
  if (!data->GetPoints() || !data->GetCellData()->GetArray(arrays::kIgm))
  {
    return std::nullopt;
  }
  ArrayHash hash(threads);
  hash.mix(static_cast<std::uint64_t>(data->GetNumberOfCells()));
  hash.add(data->GetPoints()->GetData());
  hash.add(data->GetPolys()->GetOffsetsArray());
  hash.add(data->GetPolys()->GetConnectivityArray());
  for (const char* name : { arrays::kIgm, arrays::kMatching, arrays::kFeatureEdges, arrays::kTwin })
  {
    hash.add(data->GetCellData()->GetArray(name));
  }
  for (const char* name : { arrays::kSurfacePointId, arrays::kSizing })
  {
    hash.add(data->GetPointData()->GetArray(name));
  }
  return hash.result();
}

} // namespace quadrille
