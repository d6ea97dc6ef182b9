// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Small operations on lists that the standard library has no single call for.
#pragma once

#include "Base/Types.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

namespace quadrille
{

/// Ascending, each value once.
template <typename List>
void sortUnique(List& list)
{
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// The same by keys, of which each keeps the first element.
template <typename List, typename KeyOf>
void sortUniqueBy(List& list, const KeyOf& keyOf)
{
  std::stable_sort(
    list.begin(), list.end(), [&](const auto& a, const auto& b) { return keyOf(a) < keyOf(b); });
  list.erase(std::unique(list.begin(), list.end(),
               [&](const auto& a, const auto& b) { return keyOf(a) == keyOf(b); }),
    list.end());
}

/// Where a value stands among ascending ones that have it.
template <typename Values>
Index indexIn(const Values& values, Index value)
{
  const auto found = std::lower_bound(values.begin(), values.end(), value);
  assert(found != values.end() && *found == value);
  return static_cast<Index>(found - values.begin());
}

/// Takes out what the predicate holds for; the rest keeps its order.
template <typename List, typename Predicate>
void eraseIf(List& list, const Predicate& predicate)
{
  list.erase(std::remove_if(list.begin(), list.end(), predicate), list.end());
}

template <typename List, typename Value>
bool contains(const List& list, const Value& value)
{
  return std::find(list.begin(), list.end(), value) != list.end();
}

template <typename List, typename Values>
void append(List& list, const Values& values)
{
  list.insert(list.end(), values.begin(), values.end());
}

/// The ids below count that the predicate holds for, ascending.
template <typename Predicate>
std::vector<Index> idsWhere(std::size_t count, const Predicate& predicate)
{
  std::vector<Index> ids;
  for (Index i = 0; i < count; ++i)
  {
    if (predicate(i))
    {
      ids.push_back(i);
    }
  }
  return ids;
}

/// Copies of the elements that the predicate holds for, in their order.
template <typename List, typename Predicate>
std::vector<typename List::value_type> elementsWhere(const List& list, const Predicate& predicate)
{
  std::vector<typename List::value_type> elements;
  std::copy_if(list.begin(), list.end(), std::back_inserter(elements), predicate);
  return elements;
}

/// The value in the middle; some value. Changes their order.
template <typename Value>
Value middleOf(std::vector<Value>& values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Names and places that a message tells of, at most, where there may be many.
constexpr std::size_t kMostTold = 5;

/// "1, 2, 3" of at most so many of the list, with ", ..." where there are more. textOf: of an element.
template <typename List, typename TextOf>
std::string joined(const List& list, std::size_t most, const TextOf& textOf)
{
  std::string text;
  for (std::size_t i = 0; i < std::min(list.size(), most); ++i)
  {
    text += (i > 0 ? ", " : "") + textOf(list[i]);
  }
  return text + (list.size() > most ? ", ..." : "");
}

/// Adds "3 things" to a list in words; nothing where there are none.
inline void appendCount(std::string& text, std::size_t count, const char* things)
{
  if (count > 0)
  {
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + things;
  }
}
inline void appendCount(std::string& text, std::size_t count, const char* one, const char* many)
{
  appendCount(text, count, count == 1 ? one : many);
}

/// Items by a key, all in one array: those of key k are [begin(k), end(k)), in the order in which they came.
template <typename Item = Index>
class Grouped
{
public:
  Grouped() = default;
  /// forEach(visit) calls visit(key, item) for every item, twice alike; keys are below `keys`.
  template <typename ForEach>
  Grouped(std::size_t keys, const ForEach& forEach) : first_(keys + 1, 0)
  {
    forEach([this](std::size_t key, const Item&) { ++first_[key + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    items_.resize(first_.back());
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    forEach([&](std::size_t key, const Item& item) { items_[next[key]++] = item; });
  }

  const Item* begin(std::size_t key) const { return items_.data() + first_[key]; }
  const Item* end(std::size_t key) const { return items_.data() + first_[key + 1]; }
  Index size(std::size_t key) const { return first_[key + 1] - first_[key]; }
  /// Of the two items of a key the one that is not this one.
  const Item& otherThan(std::size_t key, const Item& item) const
  {
    return *begin(key) == item ? begin(key)[1] : *begin(key);
  }

private:
  std::vector<Index> first_; ///< #keys + 1
  std::vector<Item> items_;
};

} // namespace quadrille
