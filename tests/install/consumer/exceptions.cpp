// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <gridmerge/grid/execution.hpp>
#include <gridmerge/io/map_file.hpp>
#include <stdexcept>

// The type of an exception is the same one in the program and in each library: what a library throws is
// caught here, and what is thrown here goes through a library and is caught here.
int main() {
  int caught = 0;
  try {
    gridmerge::load_map("there_is_none.yaml");
  } catch (const gridmerge::FileError&) {
    ++caught;
  }
  const std::atomic<bool> cancelled = true;
  try {
    gridmerge::with_cancellation(cancelled, [] { gridmerge::throw_if_cancelled(); });
  } catch (const gridmerge::Cancelled&) {
    ++caught;
  }
  try {
    gridmerge::with_cancellation(cancelled, [] { throw gridmerge::FileError("thrown by the program"); });
  } catch (const gridmerge::FileError&) {
    ++caught;
  }
  return caught == 3 ? 0 : 1;
}
