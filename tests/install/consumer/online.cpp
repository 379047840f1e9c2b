// SPDX-License-Identifier: Apache-2.0
#include <gridmerge/online/team.hpp>

int main() {
  const gridmerge::Team team;
  return team.answer()->robots.empty() ? 0 : 1;
}
