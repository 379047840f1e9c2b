// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "merge/elastic_pairs.hpp"

namespace gridmerge::internal {

/// How near walls may be tied in the first round [m]; `sd` as of bend().
double first_reach(double sd);

/// What is fitted.
struct ElasticFit {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< of maps that may be tied
  double sd = 0.0;                                         ///< as of bend() [m]
  double cell = 0.0;                                       ///< in which walls were drawn [m]
  WallFold fold;                                           ///< the walls that are tied
};

/// Bends the maps that are not held, as far as their freedom goes, round by round: ties walls, and solves for
/// the shifts of all sheets together. Which walls are tied follows from how the maps lie after the round
/// before. Returns which maps were tied.
std::vector<bool> fit(const ElasticFit& options, std::vector<ElasticMember>& members);

}  // namespace gridmerge::internal
