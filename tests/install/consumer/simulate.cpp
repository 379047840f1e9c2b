// SPDX-License-Identifier: Apache-2.0
#include <gridmerge/simulate/simulate.hpp>

int main() {
  return gridmerge::make_building(gridmerge::BuildingKind::office, 20.0, 15.0, 1).edges.empty() ? 1 : 0;
}
