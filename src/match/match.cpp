// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/match.hpp"

namespace gridmerge {

MatchResult match(const OccupancyGrid& fixed, const OccupancyGrid& moving, const MatchOptions&) {
  validate(fixed);
  validate(moving);
  return {};
}

}  // namespace gridmerge
