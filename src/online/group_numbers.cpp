// SPDX-License-Identifier: Apache-2.0
#include "online/group_numbers.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace gridmerge::internal {

namespace {

/// A group's robot asks for the number that it was told. The least come first, then who was heard first.
struct Claim {
  std::size_t number;
  TeamTime since;
  std::string robot;
  std::size_t group;

  friend bool operator<(const Claim& a, const Claim& b) {
    return std::tie(a.number, a.since, a.robot) < std::tie(b.number, b.since, b.robot);
  }
};

}  // namespace

std::vector<std::size_t> GroupNumbers::number(const std::vector<RobotGroup>& groups,
                                              const std::map<std::string, TeamTime>& ages,
                                              bool is_world_known) const {
  std::vector<std::size_t> numbers(groups.size(), 0);
  std::set<std::size_t> taken;
  std::vector<Claim> placed, others, newcomers;
  if (is_world_known) taken.insert(1);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups[i].in_world_frame) {
      numbers[i] = 1;
      taken.insert(1);
    }
    for (const auto& [robot, placement] : groups[i].robots) {
      const auto told = told_.find(robot);
      std::vector<Claim>& claims = told == told_.end()       ? newcomers
                                   : placed_.contains(robot) ? placed
                                                             : others;
      claims.push_back({told == told_.end() ? 0 : told->second, ages.at(robot), robot, i});
    }
  }
  for (std::vector<Claim>* claims : {&placed, &others}) {
    std::sort(claims->begin(), claims->end());
    for (const Claim& claim : *claims) {
      if (numbers[claim.group] == 0 && taken.insert(claim.number).second) numbers[claim.group] = claim.number;
    }
    // Whose number is another group's now comes as a newcomer does.
    for (Claim& claim : *claims) newcomers.push_back({0, claim.since, std::move(claim.robot), claim.group});
  }
  std::sort(newcomers.begin(), newcomers.end());
  std::size_t least = 1;
  for (const Claim& claim : newcomers) {
    if (numbers[claim.group] != 0) continue;
    while (!taken.insert(least).second) ++least;
    numbers[claim.group] = least;
  }
  return numbers;
}

void GroupNumbers::keep(const std::vector<TeamComponent>& components,
                        const std::map<std::string, TeamTime>& ages) {
  placed_.clear();
  for (const TeamComponent& component : components) {
    for (const std::string& robot : component.robots) {
      placed_.insert(robot);
      told_[robot] = component.number;
    }
  }
  std::erase_if(told_, [&](const auto& one) { return !ages.contains(one.first); });
}

}  // namespace gridmerge::internal
