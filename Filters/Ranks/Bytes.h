// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is sent between ranks: numbers and texts in a row, as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace quadrille
{

/// Numbers and texts as bytes, between ranks of one machine type.
class Packer
{
public:
  void number(double value);
  void count(std::uint64_t value);
  void text(const std::string& value);
  /// Numbers of one type.
  template <class T>
  void values(const T* first, std::size_t size)
  {
    static_assert(std::is_arithmetic_v<T>);
    count(size);
    bytes_.append(reinterpret_cast<const char*>(first), size * sizeof(T));
  }
  template <class T>
  void values(const std::vector<T>& all)
  {
    values(all.data(), all.size());
  }
  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

private:
  std::string bytes_;
};

/// The inverse, in the same order.
class Unpacker
{
public:
  explicit Unpacker(const std::string& bytes) : bytes_(bytes) {}
  double number();
  std::uint64_t count();
  std::string text();
  template <class T>
  std::vector<T> values()
  {
    static_assert(std::is_arithmetic_v<T>);
    std::vector<T> all(checkedCount(sizeof(T)));
    take(all.data(), all.size() * sizeof(T));
    return all;
  }
  bool isAtEnd() const { return at_ == bytes_.size(); }

private:
  /// A count of elements of this size that are all there.
  std::size_t checkedCount(std::size_t size);
  void take(void* target, std::size_t size);

  const std::string& bytes_;
  std::size_t at_ = 0;
};

} // namespace quadrille
