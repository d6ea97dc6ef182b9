// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Strongly connected components of a directed graph [Tarjan 1972], without a recursion: an arc is part of a cycle if
/// both its ends lie in the same one.
#pragma once

#include "Base/Types.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace quadrille
{

/// Next: the nodes that the arcs of a node lead to, with `Index size() const` and `Index operator[](Index) const`.
template <typename Next>
class StrongComponents
{
public:
  StrongComponents() = default;
  explicit StrongComponents(Index nodes)
    : component_(nodes, kInvalidIndex), order_(nodes, kInvalidIndex), lowest_(nodes, kInvalidIndex)
  {
  }

  bool empty() const { return component_.empty(); }
  /// kInvalidIndex where no walk has come to the node.
  Index componentOf(Index node) const { return component_[node]; }
  /// The number of nodes of a component.
  Index sizeOf(Index component) const { return size_[component]; }

  /// Everything that arcs lead to from a node. nextOf: node -> Next, asked once for each node.
  template <typename NextOf>
  void walkFrom(Index root, const NextOf& nextOf)
  {
    if (order_[root] != kInvalidIndex)
    {
      return;
    }
    enter(root, nextOf(root));
    while (!way_.empty())
    {
      Entered& last = way_.back();
      if (last.done == last.next.size())
      {
        leave();
        continue;
      }
      const Index next = last.next[last.done++];
      if (order_[next] == kInvalidIndex)
      {
        enter(next, nextOf(next));
      }
      else if (component_[next] == kInvalidIndex)
      {
        lowest_[last.node] = std::min(lowest_[last.node], order_[next]);
      }
    }
  }

private:
  /// A node on the way of the walk, and how many of its arcs are done.
  struct Entered
  {
    Index node = 0;
    Next next;
    Index done = 0;
  };

  void enter(Index node, Next next)
  {
    order_[node] = lowest_[node] = clock_++;
    open_.push_back(node);
    way_.push_back({ node, std::move(next) });
  }

  /// Back from the last node of the way. Where nothing from there on leads to one before it, these are a component.
  void leave()
  {
    const Index node = way_.back().node;
    way_.pop_back();
    if (!way_.empty())
    {
      Index& before = lowest_[way_.back().node];
      before = std::min(before, lowest_[node]);
    }
    if (lowest_[node] < order_[node])
    {
      return;
    }
    const auto begin = std::find(open_.rbegin(), open_.rend(), node).base() - 1;
    for (auto i = begin; i != open_.end(); ++i)
    {
      component_[*i] = static_cast<Index>(size_.size());
    }
    size_.push_back(static_cast<Index>(open_.end() - begin));
    open_.erase(begin, open_.end());
  }

  std::vector<Index> component_; ///< by node
  std::vector<Index> size_;      ///< of components
  std::vector<Index> order_;  ///< by node, in which the walk came to them; kInvalidIndex: not yet
  std::vector<Index> lowest_; ///< by node, the first one on its way that it leads back to
  std::vector<Index> open_;   ///< nodes without a component, in the order of the walk
  std::vector<Entered> way_;
  Index clock_ = 0;
};

} // namespace quadrille
