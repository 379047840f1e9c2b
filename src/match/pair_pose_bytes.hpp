// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

#include "gridmerge/match/match_result.hpp"
#include "match/bytes.hpp"
#include "match/flaw.hpp"

namespace gridmerge::internal {

inline void write_pair_pose(const PairPose& pose, ByteWriter& writer) {
  writer.pose(pose.T_fixed_moving);
  writer.number(pose.probability);
  writer.number(pose.acceptance_index);
  writer.whole(static_cast<std::uint64_t>(pose.agreement));
  writer.whole(static_cast<std::uint64_t>(pose.disagreement));
  writer.number(pose.overlap);
}

/// Throws std::invalid_argument for what no match can have found.
inline void read_pair_pose(ByteReader& reader, PairPose& pose) {
  pose.T_fixed_moving = reader.pose();
  pose.probability = reader.number();
  pose.acceptance_index = reader.number();
  pose.agreement = static_cast<std::int64_t>(reader.whole());
  pose.disagreement = static_cast<std::int64_t>(reader.whole());
  pose.overlap = reader.number();
  if (const char* flaw = flaw_of(pose)) throw std::invalid_argument(flaw);
}

}  // namespace gridmerge::internal
