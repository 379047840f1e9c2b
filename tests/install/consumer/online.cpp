// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <gridmerge/online/team.hpp>

int main() {
  gridmerge::Team team;
  team.hear("tb1", gridmerge::make_grid(8, 8, 0.1));
  return team.wait_until_settled(std::chrono::minutes(1)) && team.answer()->robots.size() == 1 ? 0 : 1;
}
