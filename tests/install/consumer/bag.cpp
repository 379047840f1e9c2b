// SPDX-License-Identifier: Apache-2.0
#include <gridmerge/gridmerge.hpp>

int main() {
  try {
    gridmerge::Bag("there_is_none.mcap");
  } catch (const gridmerge::FileError&) {
    return 0;
  }
  return 1;
}
