// SPDX-License-Identifier: Apache-2.0
// Messages of one topic: each begins with a byte, odd for an update, and two bytes for its length.
#include "bag/growing_map.hpp"
#include "fuzz_target.hpp"
#include "io/parse_error.hpp"

using namespace gridmerge::internal;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  std::string_view left = fuzz::as_bytes(data, size);
  GrowingMap map(fuzz::kMaxPixels);
  while (left.size() >= 3) {
    const bool is_update = left[0] % 2 != 0;
    const std::size_t length = static_cast<std::uint8_t>(left[1]) + 256U * static_cast<std::uint8_t>(left[2]);
    const std::string_view message = left.substr(3, length);
    left.remove_prefix(3 + message.size());
    const bool was_there = map.is_there();
    try {
      const bool taken = is_update ? map.take_update(message) : map.take_map(message);
      fuzz::require(map.is_there() == (was_there || (taken && !is_update)));
    } catch (const ParseError&) {
      fuzz::require(map.is_there() == was_there);
    }
  }
  if (!map.is_there()) return 0;
  const OccupancyGrid grid = map.grid();
  validate(grid);
  fuzz::require(grid.cells.size() <= fuzz::kMaxPixels && is_resolution(grid.resolution));
  const auto sound = [](float p) { return !(p < 0.0f || p > 1.0f); };  // unknown is NaN
  fuzz::require(std::all_of(grid.probability.begin(), grid.probability.end(), sound));
  map.warnings(grid);
  return 0;
}
