// SPDX-License-Identifier: Apache-2.0
#include <gridmerge/gridmerge.hpp>

int main() {
  try {
    gridmerge::load_map("there_is_none.yaml");
  } catch (const gridmerge::FileError&) {
    return 0;
  }
  return 1;
}
