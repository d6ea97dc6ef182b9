// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// An array whose copies share its elements until one of them is changed. A surface of two million faces takes 140 MB,
/// what differs from one version of it to the next takes ten: so versions are values, and none is changed for another.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

namespace quadrille
{

/// Reads are those of a vector. What changes elements says so: `edit()` gives them to be written, after it has made an
/// own copy where others share them. Several threads may read copies that share elements, or copy them; edit() is to be
/// called by one of them, which may hand the pointer to others.
template <typename T>
class SharedArray
{
public:
  // Names of the standard library, as algorithms and matchers of tests ask for them.
  using value_type = T;            // NOLINT(readability-identifier-naming)
  using const_iterator = const T*; // NOLINT(readability-identifier-naming)
  using iterator = const T*;       // NOLINT(readability-identifier-naming)

  SharedArray() = default;
  SharedArray(std::vector<T> values) { *this = std::move(values); }
  SharedArray(std::initializer_list<T> values) : SharedArray(std::vector<T>(values)) {}
  explicit SharedArray(std::size_t count, const T& value = T())
    : SharedArray(std::vector<T>(count, value))
  {
  }
  template <typename Iterator,
    typename = typename std::iterator_traits<Iterator>::iterator_category>
  SharedArray(Iterator first, Iterator last) : SharedArray(std::vector<T>(first, last))
  {
  }
  SharedArray(const SharedArray&) = default;
  SharedArray(SharedArray&& other) noexcept { swap(other); }
  SharedArray& operator=(const SharedArray&) = default;
  SharedArray& operator=(SharedArray&& other) noexcept
  {
    SharedArray(std::move(other)).swap(*this);
    return *this;
  }
  SharedArray& operator=(std::vector<T> values)
  {
    values_ = std::make_shared<std::vector<T>>(std::move(values));
    look();
    return *this;
  }
  SharedArray& operator=(std::initializer_list<T> values) { return *this = std::vector<T>(values); }
  ~SharedArray() = default;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t capacity() const { return values_ ? values_->capacity() : 0; }
  const T* data() const { return data_; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  const T& front() const { return data_[0]; }
  const T& back() const { return data_[size_ - 1]; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  /// As a vector, for what takes one.
  const std::vector<T>& vector() const
  {
    static const std::vector<T> kNone;
    return values_ ? *values_ : kNone;
  }
  operator const std::vector<T>&() const { return vector(); }
  /// Whether another array has the same elements at the same place, so that a change would copy them.
  bool isShared() const { return values_.use_count() > 1; }

  /// The elements to be written, size() of them, until the next change of the size.
  T* edit()
  {
    if (isShared())
    {
      own();
    }
    return values_ ? values_->data() : nullptr;
  }

  struct Elements
  {
    T *first, *last;
    T* begin() const { return first; }
    T* end() const { return last; }
  };
  /// The same for a loop over all of them.
  Elements editAll()
  {
    T* first = edit();
    return { first, first + size_ };
  }

  /// Calls act(values), which may change the size, too.
  template <typename Act>
  void change(const Act& act)
  {
    act(own());
    look();
  }

  void push_back(const T& value) // NOLINT(readability-identifier-naming)
  {
    own().push_back(value);
    look();
  }
  template <typename... Arguments>
  void emplace_back(Arguments&&... arguments) // NOLINT(readability-identifier-naming)
  {
    own().emplace_back(std::forward<Arguments>(arguments)...);
    look();
  }
  void pop_back() // NOLINT(readability-identifier-naming)
  {
    own().pop_back();
    look();
  }
  void resize(std::size_t count)
  {
    own().resize(count);
    look();
  }
  void resize(std::size_t count, const T& value)
  {
    own().resize(count, value);
    look();
  }
  void reserve(std::size_t count)
  {
    own().reserve(count);
    look();
  }
  void assign(std::size_t count, const T& value) { *this = std::vector<T>(count, value); }
  template <typename Iterator,
    typename = typename std::iterator_traits<Iterator>::iterator_category>
  void assign(Iterator first, Iterator last)
  {
    *this = std::vector<T>(first, last);
  }
  /// At the end.
  template <typename Iterator,
    typename = typename std::iterator_traits<Iterator>::iterator_category>
  void append(Iterator first, Iterator last)
  {
    std::vector<T>& values = own();
    values.insert(values.end(), first, last);
    look();
  }
  void append(std::size_t count, const T& value)
  {
    std::vector<T>& values = own();
    values.insert(values.end(), count, value);
    look();
  }
  void append(std::initializer_list<T> values) { append(values.begin(), values.end()); }
  /// Lets the elements go; where nobody shares them, their memory too.
  void clear() { SharedArray().swap(*this); }
  void swap(SharedArray& other) noexcept
  {
    values_.swap(other.values_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }
  /// The elements as a vector of the caller's, without a copy where nobody shares them; empty afterwards.
  std::vector<T> take()
  {
    std::vector<T> values = std::move(own());
    clear();
    return values;
  }

  friend bool operator==(const SharedArray& a, const SharedArray& b)
  {
    return a.values_ == b.values_ || a.vector() == b.vector();
  }
  friend bool operator!=(const SharedArray& a, const SharedArray& b) { return !(a == b); }

private:
  std::vector<T>& own()
  {
    if (!values_)
    {
      values_ = std::make_shared<std::vector<T>>();
    }
    else if (isShared())
    {
      values_ = std::make_shared<std::vector<T>>(*values_);
      look();
    }
    return *values_;
  }
  void look()
  {
    data_ = values_->data();
    size_ = values_->size();
  }

  std::shared_ptr<std::vector<T>> values_;
  const T* data_ = nullptr;
  std::size_t size_ = 0;
};

} // namespace quadrille
