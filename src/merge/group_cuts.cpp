// SPDX-License-Identifier: Apache-2.0
#include "merge/group_cuts.hpp"

#include <algorithm>

#include "grid/parallel.hpp"

namespace gridmerge::internal {

namespace {

/// In the frame of the lowest map, maps ascending.
NodeGroup in_order(NodeGroup group) {
  std::sort(group.begin(), group.end(),
            [](const PlacedNode& a, const PlacedNode& b) { return a.map < b.map; });
  const SE2 T_first_group = inverse(group.front().T_group_map);
  for (PlacedNode& node : group) node.T_group_map = T_first_group * node.T_group_map;
  group.front().T_group_map = {};
  return group;
}

void doubt_members(const JoinWeights& weights, NodeGroup& group) {
  if (group.size() < 2) return;
  std::vector<double> probabilities(group.size(), 1.0);
  parallel_for(group.size(), [&](std::size_t i) {
    if (weights.is_fixed(group[i].map)) return;
    const auto [rest, alone] = taken_out(group, i);
    probabilities[i] = weights.probability_of_lying_so(rest, alone);
  });
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (!weights.is_fixed(group[i].map)) group[i].probability = probabilities[i];
  }
}

}  // namespace

GroupCuts::GroupCuts(const JoinWeights& weights, const NodeGroups& groups) : weights_(weights) {
  for (const NodeGroup& group : groups) add(group);
  find_least_from(0);
}

NodeGroups GroupCuts::groups() const {
  NodeGroups all;
  for (const Part& part : parts_) all.push_back(part.group);
  return all;
}

NodeGroups GroupCuts::weighed_groups() {
  parallel_for(parts_.size(), [&](std::size_t i) {
    if (parts_[i].weighed) return;
    NodeGroup group = in_order(parts_[i].group);
    doubt_members(weights_, group);
    parts_[i].weighed = std::move(group);
  });
  NodeGroups all;
  for (const Part& part : parts_) all.push_back(*part.weighed);
  std::sort(all.begin(), all.end(),
            [](const NodeGroup& a, const NodeGroup& b) { return a.front().map < b.front().map; });
  return all;
}

void GroupCuts::cut_below(double keep_probability) {
  while (true) {
    std::vector<std::size_t> unsure;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (parts_[i].least && parts_[i].least->probability < keep_probability) unsure.push_back(i);
    }
    if (unsure.empty()) return;
    cut(unsure);
  }
}

bool GroupCuts::cut_least() {
  std::optional<std::size_t> which;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const std::optional<Cut>& cut = parts_[i].least;
    if (cut && (!which || cut->probability < parts_[*which].least->probability)) which = i;
  }
  if (which) cut({*which});
  return which.has_value();
}

/// Poses may agree less after they were adjusted, so that a part falls apart again.
void GroupCuts::add(NodeGroup group) {
  NodeGroups held_together = weights_.connected(group);
  if (held_together.size() == 1) {
    parts_.push_back({std::move(group), {}, {}});
    return;
  }
  for (NodeGroup& part : held_together) add(weights_.adjusted(std::move(part)));
}

void GroupCuts::find_least_from(std::size_t first) {
  parallel_for(parts_.size() - first,
               [&](std::size_t i) { parts_[first + i].least = least_cut_of(parts_[first + i].group); });
}

std::optional<GroupCuts::Cut> GroupCuts::least_cut_of(const NodeGroup& group) const {
  if (group.size() < 2) return std::nullopt;
  std::vector<std::pair<NodeGroup, NodeGroup>> halves = weights_.halves(group);
  if (halves.empty()) return std::nullopt;
  std::vector<double> probabilities(halves.size());
  parallel_for(halves.size(), [&](std::size_t i) {
    probabilities[i] = weights_.probability_of_lying_so(halves[i].first, halves[i].second);
  });
  const auto least = std::min_element(probabilities.begin(), probabilities.end());
  return Cut{*least, std::move(halves[static_cast<std::size_t>(least - probabilities.begin())])};
}

/// `places` are ascending.
void GroupCuts::cut(const std::vector<std::size_t>& places) {
  std::vector<std::pair<NodeGroup, NodeGroup>> halves;
  for (auto place = places.rbegin(); place != places.rend(); ++place) {
    halves.push_back(std::move(parts_[*place].least->halves));
    parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(*place));
  }
  const std::size_t first = parts_.size();
  for (auto& [one, other] : halves) {
    add(weights_.adjusted(std::move(one)));
    add(weights_.adjusted(std::move(other)));
  }
  find_least_from(first);
}

}  // namespace gridmerge::internal
