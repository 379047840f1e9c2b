// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "maps.hpp"

namespace gridmerge::paper {

inline constexpr double kTolerance = 1.0;         ///< [m]: a larger error is a wrong pose
inline constexpr double kAcceptanceIndex = 0.98;  ///< the paper's

/// How two maps are merged.
struct Method {
  std::string name;
  std::vector<double> c_locks;  ///< of the walks, in turn; empty for the engine
  int walks = 1;

  bool is_walk() const { return !c_locks.empty(); }
};

/// How one merge of two maps went.
struct Run {
  std::size_t steps = 0;  ///< proposals of all walks; 0 for the engine
  double seconds = 0.0;
  double error = 0.0;  ///< rms_displacement() [m]
  bool accepted = false;
  SE2 T_fixed_moving;
  double c_lock = 0.0;    ///< of the walk
  ImageSimilarity found;  ///< at that pose
  ImageSimilarity truth;

  bool correct() const { return error <= kTolerance; }
  /// Wrong, although Delta at the truth is better than at the pose that was found.
  bool is_search_failure() const { return !correct() && truth.delta(c_lock) < found.delta(c_lock); }
  /// Wrong, and Delta prefers the wrong pose: no search could help.
  bool is_measure_failure() const { return !correct() && !is_search_failure(); }
};

Run merge_two(const Pair& pair, const Method& method, std::uint64_t seed);

/// One line of a table of runs of one pair by one method, over several draws.
extern const char* const kRunsHead;
std::string runs_row(const std::string& pair, const Method& method, const std::vector<Run>& runs);

}  // namespace gridmerge::paper
