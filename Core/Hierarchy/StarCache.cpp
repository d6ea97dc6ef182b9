// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/StarCache.h"

#include <algorithm>

namespace quadrille
{

namespace
{

/// Words of all entries together above which the cache starts anew: a gigabyte.
constexpr std::size_t kMaximumWords = std::size_t{ 1 } << 28;

std::uint32_t hashOf(const std::uint32_t* words, std::size_t count)
{
  std::uint64_t hash = count;
  for (std::size_t i = 0; i < count; ++i)
  {
    hash = (hash ^ words[i]) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 29;
  }
  return static_cast<std::uint32_t>(hash >> 32);
}

std::uint32_t header(std::size_t key, std::size_t value)
{
  return static_cast<std::uint32_t>(key | value << 16);
}
std::size_t keyWords(std::uint32_t header)
{
  return header & 0xFFFFU;
}
std::size_t valueWords(std::uint32_t header)
{
  return header >> 16;
}

} // namespace

void StarCache::Batch::add(const Words& key, const Words& value)
{
  words_.push_back(header(key.size(), value.size()));
  words_.insert(words_.end(), key.begin(), key.end());
  words_.insert(words_.end(), value.begin(), value.end());
}

const std::uint32_t* StarCache::find(const Words& key) const
{
  if (slots_.empty())
  {
    return nullptr;
  }
  const std::uint32_t hash = hashOf(key.data(), key.size());
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t i = hash & mask; slots_[i].entry != 0; i = (i + 1) & mask)
  {
    if (slots_[i].hash == hash)
    {
      const std::uint32_t* entry = words_.data() + slots_[i].entry - 1;
      if (keyWords(*entry) == key.size() && std::equal(key.begin(), key.end(), entry + 1))
      {
        return entry + 1 + key.size();
      }
    }
  }
  return nullptr;
}

void StarCache::add(const Batch& batch)
{
  if (words_.size() + batch.words_.size() > kMaximumWords)
  {
    clear();
  }
  std::size_t begin = words_.size();
  words_.insert(words_.end(), batch.words_.begin(), batch.words_.end());
  while (begin < words_.size())
  {
    if (2 * (entries_ + 1) > slots_.size())
    {
      grow();
    }
    const std::size_t key = keyWords(words_[begin]);
    place({ hashOf(words_.data() + begin + 1, key), static_cast<std::uint32_t>(begin + 1) });
    ++entries_;
    begin += 1 + key + valueWords(words_[begin]);
  }
}

void StarCache::place(Slot slot)
{
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = slot.hash & mask;
  while (slots_[i].entry != 0)
  {
    i = (i + 1) & mask;
  }
  slots_[i] = slot;
}

void StarCache::grow()
{
  std::vector<Slot> old(std::max<std::size_t>(2, 2 * slots_.size()));
  old.swap(slots_);
  for (const Slot& slot : old)
  {
    if (slot.entry != 0)
    {
      place(slot);
    }
  }
}

void StarCache::clear()
{
  slots_.clear();
  words_.clear();
  entries_ = 0;
}

std::size_t StarCache::bytes() const
{
  return slots_.capacity() * sizeof(Slot) + words_.capacity() * sizeof(std::uint32_t);
}

} // namespace quadrille
