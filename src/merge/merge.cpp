// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merge.hpp"

#include <cmath>
#include <stdexcept>

#include "grid/pose_bounds.hpp"
#include "gridmerge/merge/merger.hpp"
#include "merge/consistent_set.hpp"
#include "merge/joins.hpp"

namespace gridmerge {

using namespace internal;

void validate(const MergeOptions& options) {
  validate(options.match);
  if (options.match.search == SearchMethod::random_walk)
    throw std::invalid_argument(
        "joint merging needs several hypotheses for each pair, with probabilities: a random walk has none "
        "(merge_up_tree() takes it)");
  if (options.match.scales)
    throw std::invalid_argument("maps are merged at one scale: only match() searches scales");
  if (static_cast<std::size_t>(options.transform) >= map_transforms().size())
    throw std::invalid_argument("there is no such transform");
  validate_merge({}, options.resolution);
  false_joins_allowed(options.max_false_joins, 0);  // throws for one that makes no sense
  if (!(options.max_missed >= 0.0 && options.max_missed < 1.0))
    throw std::invalid_argument("max_missed must be a share in [0, 1)");
}

void validate(const KnownPose& known) {
  const SE2& T = known.T_world_map;
  if (!(std::abs(T.x) <= kFarthestPose && std::abs(T.y) <= kFarthestPose && std::isfinite(T.theta)))
    throw std::invalid_argument("a known pose must be finite, and within 10000 km");
  if (known.fixed) return;
  if (!is_deviation(known.sd_position) || !is_deviation(known.sd_theta))
    throw std::invalid_argument(
        "the standard deviations of a known pose must lie between 0.000001 and 100000, unless it is fixed");
}

MergeResult merge(const std::vector<OccupancyGrid>& maps, const MergeOptions& options,
                  const std::vector<std::optional<KnownPose>>& known_poses) {
  return Merger(maps, options, known_poses).solve();
}

}  // namespace gridmerge
