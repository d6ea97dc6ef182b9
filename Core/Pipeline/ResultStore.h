// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Results of stages under keys of exactly what they depend on. What a run can take from an earlier one falls out of
/// the keys: an edit is answered from the first stage whose key it changes, and one that is taken back is a look-up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <typeindex>
#include <utility>
#include <vector>

namespace quadrille
{

/// 64 bits over all that a result depends on: contents and options, and the keys of the results it was made from.
using ResultKey = std::uint64_t;

/// Collects what a key is of, in an order that its maker keeps to.
class KeyMaker
{
public:
  explicit KeyMaker(ResultKey first = 0) : key_(first) {}
  KeyMaker& add(std::uint64_t value);
  KeyMaker& add(double value);
  /// Plain numbers, with how many they are.
  template <typename T>
  KeyMaker& add(const std::vector<T>& values)
  {
    return addBytes(values.data(), values.size() * sizeof(T));
  }
  ResultKey key() const { return key_; }

private:
  KeyMaker& addBytes(const void* bytes, std::size_t count);

  ResultKey key_;
};

/// Belongs to the caller of remesh(), who makes it, asks for its size and clears it. Bounded in bytes: what was not
/// used for longest goes first, but nothing that a run holds. A result is found by its type and its key; one under a
/// key that is there already takes its place.
/// Not for several threads at once.
class ResultStore
{
public:
  /// 0: a quarter of the machine's memory.
  explicit ResultStore(std::size_t maximumBytes = 0);

  /// Of the machine's memory; 4 GiB where that cannot be found out.
  static std::size_t bytesOfMachine();

  std::size_t bytes() const { return bytes_; }
  std::size_t maximumBytes() const { return maximumBytes_; }
  /// Lets go what is beyond.
  void setMaximumBytes(std::size_t bytes);
  void clear();

  template <typename T>
  void put(ResultKey key, std::shared_ptr<T> value, std::size_t bytes)
  {
    putEntry({ std::type_index(typeid(T)), key }, std::move(value), bytes);
  }
  /// Null where there is none.
  template <typename T>
  std::shared_ptr<T> find(ResultKey key)
  {
    return std::static_pointer_cast<T>(findEntry({ std::type_index(typeid(T)), key }));
  }
  /// All of a type, the last used one first.
  template <typename T>
  std::vector<std::shared_ptr<T>> all() const
  {
    std::vector<std::shared_ptr<T>> values;
    for (const std::shared_ptr<void>& value : allOf(std::type_index(typeid(T))))
    {
      values.push_back(std::static_pointer_cast<T>(value));
    }
    return values;
  }
  /// Lets go what is used least until no more than so many bytes are held, or the rest is in use.
  void shrinkTo(std::size_t bytes);

private:
  using Name = std::pair<std::type_index, ResultKey>;
  struct Entry
  {
    std::shared_ptr<void> value;
    std::size_t bytes = 0;
    std::uint64_t lastUse = 0;
  };

  void putEntry(const Name& name, std::shared_ptr<void> value, std::size_t bytes);
  std::shared_ptr<void> findEntry(const Name& name);
  std::vector<std::shared_ptr<void>> allOf(std::type_index type) const;

  std::map<Name, Entry> entries_;
  std::size_t maximumBytes_;
  std::size_t bytes_ = 0;
  std::uint64_t uses_ = 0;
};

/// Bytes that a vector or a shared array has taken.
template <typename Array, typename Value = typename Array::value_type>
std::size_t bytesOf(const Array& values)
{
  return values.capacity() * sizeof(Value);
}

} // namespace quadrille
