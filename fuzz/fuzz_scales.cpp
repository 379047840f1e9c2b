// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <stdexcept>

#include "fuzz_target.hpp"
#include "gridmerge/match/match.hpp"
#include "match/drawing.hpp"
#include "tiny_maps.hpp"

namespace {

using namespace gridmerge;

bool is_valid(const ScaleRange& scales) {
  try {
    validate(scales);
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

ScaleRange draw_scales(FuzzedDataProvider& bytes) {
  if (bytes.ConsumeBool())
    return bytes.PickValueInArray({ScaleRange{0.5, 2.0}, ScaleRange{1.0, 1.0}, ScaleRange{0.95, 1.05}});
  ScaleRange any{bytes.ConsumeFloatingPoint<double>(), bytes.ConsumeFloatingPoint<double>()};
  // A range that is allowed may be twenty times as wide, but that takes twenty times as long.
  if (is_valid(any)) any.most = std::min(any.most, 2.0 * any.least);
  return any;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider bytes(data, size);
  MatchOptions options;
  options.scales = draw_scales(bytes);
  options.search = bytes.PickValueInArray({SearchMethod::exhaustive, SearchMethod::thorough});
  options.accept_probability = bytes.PickValueInArray({0.95, 0.0, 1.0});
  options.threads = 1;
  const std::vector<OccupancyGrid> maps = fuzz::draw_maps(bytes, 2);
  // Of a line drawing, what it encloses counts as free: black on nothing else is painted, and no wall.
  const bool has_walls = std::all_of(maps.begin(), maps.end(), [](const OccupancyGrid& map) {
    return PreparedMap(internal::with_enclosed_free(map)).counts().occupied > 0;
  });
  MatchResult result;
  try {
    result = match(maps[0], maps[1], options);
  } catch (const std::invalid_argument&) {
    fuzz::require(!has_walls || !is_valid(*options.scales));
    return 0;
  }
  fuzz::require(has_walls && is_valid(*options.scales));
  fuzz::require_sound(result, maps[0], maps[1], options.accept_probability);
  // The climb may leave the range by a little.
  fuzz::require(result.scale > 0.8 * options.scales->least && result.scale < 1.25 * options.scales->most);
  options.threads = 2;
  fuzz::require(fuzz::are_same(match(maps[0], maps[1], options), result));
  return 0;
}
