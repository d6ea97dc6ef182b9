// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Results of stages under keys of exactly what they depend on. What a run can take from an earlier one falls out of
/// the keys: an edit is answered from the first stage whose key it changes, and one that is taken back is a look-up.
#pragma once

#include "Base/Types.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <type_traits>
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
  /// Numbers, enumerators, vectors of space, and arrays of plain numbers with how many they are.
  template <typename... Values>
  KeyMaker& add(const Values&... values)
  {
    (addValue(values), ...);
    return *this;
  }
  ResultKey key() const { return key_; }

private:
  template <typename Value>
  void addValue(const Value& value)
  {
    if constexpr (std::is_floating_point_v<Value>)
    {
      addNumber(value);
    }
    else if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>)
    {
      addBits(static_cast<std::uint64_t>(value));
    }
    else if constexpr (std::is_same_v<Value, Vector3>)
    {
      add(value[0], value[1], value[2]);
    }
    else
    {
      addBytes(value.data(), value.size() * sizeof(*value.data()));
    }
  }
  void addBits(std::uint64_t value);
  void addNumber(double value);
  void addBytes(const void* bytes, std::size_t count);

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
  /// Lets go what is used least until no more is held than may be, or the rest is in use.
  void shrink();

  std::map<Name, Entry> entries_;
  std::size_t maximumBytes_;
  std::size_t bytes_ = 0;
  std::uint64_t uses_ = 0;
};

/// What the store has under the key; null where it has none, or there is no store.
template <typename T>
std::shared_ptr<T> findIn(ResultStore* store, ResultKey key)
{
  return store != nullptr ? store->find<T>(key) : nullptr;
}

/// The same, made where there is none, and then put into the store, if any. bytes: of what was made.
template <typename T, typename Make, typename Bytes>
std::shared_ptr<T> findOrMake(
  ResultStore* store, ResultKey key, const Make& make, const Bytes& bytes)
{
  std::shared_ptr<T> found = findIn<T>(store, key);
  if (!found)
  {
    found = std::make_shared<T>(make());
    if (store != nullptr)
    {
      store->put(key, found, bytes(*found));
    }
  }
  return found;
}

/// Bytes that a vector or a shared array has taken.
template <typename Array, typename Value = typename Array::value_type>
std::size_t bytesOf(const Array& values)
{
  return values.capacity() * sizeof(Value);
}

} // namespace quadrille
