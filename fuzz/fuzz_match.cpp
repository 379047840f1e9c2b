// SPDX-License-Identifier: Apache-2.0
#include "fuzz_target.hpp"
#include "gridmerge/match/match.hpp"
#include "match/prepared_map.hpp"
#include "tiny_maps.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  using internal::is_smaller;
  FuzzedDataProvider bytes(data, size);
  MatchOptions options;
  options.search =
      bytes.PickValueInArray({SearchMethod::exhaustive, SearchMethod::quick, SearchMethod::thorough});
  options.accept_probability = bytes.PickValueInArray({0.95, 0.0, 0.5, 1.0});
  options.max_hypotheses = bytes.PickValueInArray({std::size_t{10}, std::size_t{1}, std::size_t{100}});
  const std::vector<OccupancyGrid> maps = fuzz::draw_maps(bytes, 2);

  options.threads = 1;
  const MatchResult result = match(maps[0], maps[1], options);
  fuzz::require_sound(result, maps[0], maps[1], options.accept_probability);
  // Neither the threads nor the order of the maps plays a part, except between maps that hold the same.
  options.threads = 2;
  const PreparedMap a(maps[0]), b(maps[1]);
  const bool can_swap = is_smaller(a, b) != is_smaller(b, a);
  if (can_swap && is_smaller(a, b)) {
    fuzz::require(fuzz::are_same(inverse(match(maps[1], maps[0], options)), result));
  } else if (can_swap) {
    fuzz::require(fuzz::are_same(match(maps[1], maps[0], options), inverse(result)));
  } else {
    fuzz::require(fuzz::are_same(match(maps[0], maps[1], options), result));
  }
  return 0;
}
