// SPDX-License-Identifier: Apache-2.0
#include <gridmerge/gridmerge.hpp>

int main() {
  gridmerge::Merger merger;
  merger.add(gridmerge::make_grid(8, 8, 0.1));
  return merger.solve().left_out.size() == 1 ? 0 : 1;
}
