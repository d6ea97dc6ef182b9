// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Remembers what is expensive to know about the removal of a vertex, by the star of the vertex
/// [Ebke et al. 2016, Section 5.3].
///
/// Keys and values are sequences of 32-bit words. Keys are compared whole, so a value is only found for exactly the
/// star that it was computed for, and a decimation gives the same bytes with a full cache and with an empty one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille
{

class StarCache
{
public:
  using Words = std::vector<std::uint32_t>;

  /// Entries that are not in the cache yet, so that threads can fill one each.
  class Batch
  {
  public:
    /// At most 65535 words each.
    void add(const Words& key, const Words& value);
    void clear() { words_.clear(); }

  private:
    friend class StarCache;
    Words words_;
  };

  /// The words of the value, valid until the next add(); nullptr when there is none.
  const std::uint32_t* find(const Words& key) const;
  /// Takes over a batch whose keys are not in the cache; empties the cache first when it has grown too large.
  void add(const Batch& batch);
  void clear();

  std::size_t entries() const { return entries_; }
  std::size_t bytes() const;

private:
  struct Slot
  {
    std::uint32_t hash = 0;
    std::uint32_t entry = 0; ///< first word of the entry, plus 1; 0: free
  };
  void grow();
  void place(Slot slot);

  std::vector<Slot> slots_; ///< a power of two, at most half full
  Words words_;             ///< entries: numbers of words of key and of value, key, value
  std::size_t entries_ = 0;
};

} // namespace quadrille
