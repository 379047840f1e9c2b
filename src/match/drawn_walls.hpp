// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "gridmerge/match/match.hpp"
#include "internal_export.hpp"
#include "similarity/likelihood_field.hpp"

namespace gridmerge::internal {

/// A prepared map as it is compared: drawn once in cells of each size.
class GRIDMERGE_INTERNAL_EXPORT DrawnWalls {
 public:
  /// In cells of `cell` metres; drawn when first asked for, O(cells) then. Lives as long as the map.
  static const LikelihoodField& of(const PreparedMap& map, double cell);

  /// The map drawn `factor` times as large, with walls yet to be drawn. O(cells), with a small factor.
  static PreparedMap scaled(const PreparedMap& map, double factor);

 private:
  std::mutex drawing_;
  std::map<double, std::unique_ptr<const LikelihoodField>> by_cell_;
};

}  // namespace gridmerge::internal
