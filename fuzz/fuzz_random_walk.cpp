// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "fuzz_target.hpp"
#include "gridmerge/match/random_walk_match.hpp"
#include "tiny_maps.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  FuzzedDataProvider bytes(data, size);
  RandomWalkMatchOptions options;
  options.start = {bytes.ConsumeIntegralInRange(1, 8), bytes.ConsumeIntegralInRange(0, 1), 4.0};
  options.restarts = bytes.ConsumeIntegralInRange(1, 3);
  options.c_locks = {bytes.PickValueInArray({0.0, 7.5, 1e6}), 1.0};
  options.walk.max_proposals = bytes.ConsumeIntegralInRange(std::size_t{1}, std::size_t{300});
  options.walk.patience = bytes.ConsumeIntegralInRange(std::size_t{1}, std::size_t{300});
  options.walk.temperature = bytes.PickValueInArray({0.0, 1.0, 1e9});
  options.walk.cooling = bytes.PickValueInArray({1.0, 0.9});
  options.walk.wide_share = bytes.PickValueInArray({0.05, 0.0, 1.0});
  options.walk.seed = bytes.ConsumeIntegral<std::uint8_t>();
  options.walk.trace = WalkTrace::all;
  options.least_common_cells = bytes.PickValueInArray({400, 0, 4});
  options.accept_acceptance_index = bytes.PickValueInArray({0.98, 0.0, 0.5});
  const std::vector<OccupancyGrid> maps = fuzz::draw_maps(bytes, 2);

  // A map a hundred times as fine as the other makes a lattice of millions of cells, for each proposal.
  if (std::max(maps[0].resolution, maps[1].resolution) >
      4.0 * std::min(maps[0].resolution, maps[1].resolution))
    return 0;

  const std::size_t most_samples = 2 * options.walk.max_proposals + 1;  // a wide one may be there twice
  options.on_walk = [&](int, double, const RandomWalkResult& walk) {
    fuzz::require(is_finite(walk.T_fixed_moving) && std::isfinite(walk.delta));
    fuzz::require(walk.accepted <= walk.proposals && walk.proposals <= options.walk.max_proposals);
    fuzz::require(!walk.trace.empty() && walk.trace.size() <= most_samples);
    for (const WalkSample& sample : walk.trace)
      fuzz::require(is_finite(sample.T_fixed_moving) && std::isfinite(sample.delta));
  };
  options.threads = 1;
  const MatchResult result = match_by_random_walk(maps[0], maps[1], options);
  fuzz::require(is_finite(result.T_fixed_moving));
  for (const double share : {result.probability, result.acceptance_index, result.overlap})
    fuzz::require(share >= 0.0 && share <= 1.0);
  fuzz::require(result.agreement >= 0 && result.disagreement >= 0);
  fuzz::require(result.verdict == Verdict::refused || result.probability >= options.accept_acceptance_index);

  options.threads = 2;
  fuzz::require(fuzz::are_same(match_by_random_walk(maps[0], maps[1], options), result));
  return 0;
}
