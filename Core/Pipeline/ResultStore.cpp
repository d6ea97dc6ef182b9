// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/ResultStore.h"

#include "Mesh/ContentHash.h"

#include <unistd.h>

#include <algorithm>
#include <cstring>

namespace quadrille
{
namespace
{

constexpr std::size_t kShareOfMachine = 4;

} // namespace

KeyMaker& KeyMaker::add(std::uint64_t value)
{
  key_ = combineHashes(key_, value);
  return *this;
}

KeyMaker& KeyMaker::add(double value)
{
  std::uint64_t bits = 0;
  static_assert(sizeof(bits) == sizeof(value));
  std::memcpy(&bits, &value, sizeof(bits));
  return add(bits);
}

KeyMaker& KeyMaker::addBytes(const void* bytes, std::size_t count)
{
  return add(contentHash(bytes, count, 1));
}

std::size_t ResultStore::bytesOfMachine()
{
  const long pages = sysconf(_SC_PHYS_PAGES);
  const long page = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && page > 0 ? static_cast<std::size_t>(pages) * static_cast<std::size_t>(page)
                               : std::size_t{ 1 } << 32;
}

ResultStore::ResultStore(std::size_t maximumBytes)
  : maximumBytes_(maximumBytes > 0 ? maximumBytes : bytesOfMachine() / kShareOfMachine)
{
}

void ResultStore::setMaximumBytes(std::size_t bytes)
{
  maximumBytes_ = bytes > 0 ? bytes : bytesOfMachine() / kShareOfMachine;
  shrinkTo(maximumBytes_);
}

void ResultStore::clear()
{
  entries_.clear();
  bytes_ = 0;
}

void ResultStore::putEntry(const Name& name, std::shared_ptr<void> value, std::size_t bytes)
{
  Entry& entry = entries_[name];
  bytes_ += bytes - entry.bytes;
  entry = { std::move(value), bytes, ++uses_ };
  shrinkTo(maximumBytes_);
}

std::shared_ptr<void> ResultStore::findEntry(const Name& name)
{
  const auto found = entries_.find(name);
  if (found == entries_.end())
  {
    return nullptr;
  }
  found->second.lastUse = ++uses_;
  return found->second.value;
}

std::vector<std::shared_ptr<void>> ResultStore::allOf(std::type_index type) const
{
  std::vector<std::pair<std::uint64_t, std::shared_ptr<void>>> found;
  for (const auto& [name, entry] : entries_)
  {
    if (name.first == type)
    {
      found.emplace_back(entry.lastUse, entry.value);
    }
  }
  std::sort(
    found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::shared_ptr<void>> values;
  values.reserve(found.size());
  for (auto& [use, value] : found)
  {
    values.push_back(std::move(value));
  }
  return values;
}

void ResultStore::shrinkTo(std::size_t bytes)
{
  while (bytes_ > bytes)
  {
    auto oldest = entries_.end();
    for (auto at = entries_.begin(); at != entries_.end(); ++at)
    {
      const bool isHeld = at->second.value.use_count() > 1;
      if (!isHeld && (oldest == entries_.end() || at->second.lastUse < oldest->second.lastUse))
      {
        oldest = at;
      }
    }
    if (oldest == entries_.end())
    {
      return; // the rest is in use
    }
    bytes_ -= oldest->second.bytes;
    entries_.erase(oldest);
  }
}

} // namespace quadrille
