#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "polhode/core/error.hpp"

// A binary tree on the numbers of blocks: node (level, start) holds the sums of 2^level blocks from `start` on, a
// multiple of 2^level. Two complete siblings become their parent. So the sums of a set of blocks have the same bits in
// in any order of the blocks.
namespace polhode::summary {

inline std::uint64_t length_of(int level) { return std::uint64_t{1} << level; }

/// Throws InvalidInput if a node has one of these blocks.
template <class Node>
void require_apart(const std::map<std::uint64_t, Node>& nodes, std::uint64_t start, int level) {
  const auto next = nodes.lower_bound(start);
  const bool behind = next != nodes.end() && next->first < start + length_of(level);
  const bool before = next != nodes.begin() && [&] {
    const auto& [first, node] = *std::prev(next);
    return first + length_of(node.level) > start;
  }();
  if (behind || before) {
    throw InvalidInput("bodies", "not in the summary yet", "block " + std::to_string(start) + " of 4096 bodies twice");
  }
}

inline void add_to(std::vector<double>& left, const std::vector<double>& right) {
  for (std::size_t i = 0; i < left.size(); ++i) left[i] += right[i];
}

template <class Node>
void insert(std::map<std::uint64_t, Node>& nodes, std::uint64_t start, int level, std::vector<double> sums) {
  for (;;) {
    const std::uint64_t parent = start / length_of(level + 1) * length_of(level + 1);
    const std::uint64_t sibling = parent == start ? start + length_of(level) : parent;
    const auto found = nodes.find(sibling);
    if (found == nodes.end() || found->second.level != level) break;
    if (sibling < start) std::swap(sums, found->second.sums);
    add_to(sums, found->second.sums);
    nodes.erase(found);
    start = parent, ++level;
  }
  nodes.emplace(start, Node{level, std::move(sums)});
}

/// The sums of nodes [from, to), all of them within 2^level blocks from `start` on. What is missing adds nothing.
template <class Place>
std::vector<double> fold(Place from, Place to, std::uint64_t start, int level) {
  if (std::next(from) == to) return from->second.sums;
  const std::uint64_t middle = start + length_of(level - 1);
  Place right = from;
  while (right != to && right->first < middle) ++right;
  if (right == from) return fold(from, to, middle, level - 1);
  if (right == to) return fold(from, to, start, level - 1);
  std::vector<double> sums = fold(from, right, start, level - 1);
  add_to(sums, fold(right, to, middle, level - 1));
  return sums;
}

/// Of all nodes; there is at least one.
template <class Node>
std::vector<double> fold(const std::map<std::uint64_t, Node>& nodes) {
  int level = 0;
  while (level < 63 && length_of(level) <= nodes.rbegin()->first) ++level;
  return fold(nodes.begin(), nodes.end(), std::uint64_t{0}, level);
}

}  // namespace polhode::summary
