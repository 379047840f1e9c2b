// SPDX-License-Identifier: Apache-2.0
#include "match/pair_pose.hpp"

#include "match/prepared_map.hpp"

namespace gridmerge::internal {

void set_common(const AgreementCounts& counts, const OccupancyGrid& fixed, const OccupancyGrid& moving,
                PairPose& pose) {
  pose.acceptance_index = counts.acceptance_index();
  pose.agreement = counts.agreement;
  pose.disagreement = counts.disagreement;
  pose.overlap = measure_overlap(fixed, moving, counts);
}

void count_common(const OccupancyGrid& fixed, const OccupancyGrid& moving, PairPose& pose) {
  set_common(count_agreement(fixed, moving, pose.T_fixed_moving), fixed, moving, pose);
}

void count_common(const PreparedMap& fixed, const PreparedMap& moving, PairPose& pose) {
  if (!are_swapped(fixed, moving)) {
    count_common(fixed.known(), moving.known(), pose);
    return;
  }
  const AgreementCounts counts = count_agreement(moving.known(), fixed.known(), inverse(pose.T_fixed_moving));
  set_common(counts, moving.known(), fixed.known(), pose);
}

}  // namespace gridmerge::internal
