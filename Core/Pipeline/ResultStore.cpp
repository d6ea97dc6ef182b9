// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/ResultStore.h"

#include "Mesh/ContentHash.h"

#include <unistd.h>

#include <cstring>

namespace quadrille
{
namespace
{

constexpr std::size_t kShareOfMachine = 4;

} // namespace

void KeyMaker::addBits(std::uint64_t value)
{
  key_ = combineHashes(key_, value);
}

void KeyMaker::addNumber(double value)
{
  std::uint64_t bits = 0;
  static_assert(sizeof(bits) == sizeof(value));
  std::memcpy(&bits, &value, sizeof(bits));
  addBits(bits);
}

void KeyMaker::addBytes(const void* bytes, std::size_t count)
{
  addBits(contentHash(bytes, count, 1));
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
  shrink();
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

void ResultStore::shrink()
{
  while (bytes_ > maximumBytes_)
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
