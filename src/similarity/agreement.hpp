// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Cells that two maps know in common (Birk & Carpin 2006, the lock term and the acceptance index).
struct AgreementCounts {
  std::int64_t agreement = 0;     ///< cells of the moving map that are known in both and equal
  std::int64_t disagreement = 0;  ///< cells of the moving map that are known in both and different

  std::int64_t both_known() const { return agreement + disagreement; }

  /// agreement / (agreement + disagreement); 0 when nothing is known in common.
  double acceptance_index() const {
    return both_known() == 0 ? 0.0 : static_cast<double>(agreement) / static_cast<double>(both_known());
  }
};

/// Looks the known cells of one map up in another one (nearest cell), under many poses.
class AgreementCounter {
 public:
  /// With a `stride` above 1, only every stride-th cell of every stride-th row is looked up, and stands for
  /// stride^2 cells. Both maps must outlive this. O(cells of moving / stride^2).
  AgreementCounter(const OccupancyGrid& fixed, const OccupancyGrid& moving, int stride = 1);

  /// Under a pose between the map frames [m, rad]. O(known cells of moving / stride^2).
  AgreementCounts count(const SE2& T_fixed_moving) const;

 private:
  struct KnownCell {
    int column;
    Cell value;
  };
  struct Row {
    int row;
    std::size_t begin, end;  // of its known cells
  };

  const OccupancyGrid& fixed_;
  const OccupancyGrid& moving_;
  int stride_;
  std::vector<KnownCell> known_;
  std::vector<Row> rows_;
};

/// AgreementCounter for one pose and all cells. O(cells of moving).
GRIDMERGE_INTERNAL_EXPORT AgreementCounts count_agreement(const OccupancyGrid& fixed,
                                                          const OccupancyGrid& moving,
                                                          const SE2& T_fixed_moving);

/// Share of the smaller map's known area that is known in both, in [0, 1], from what count_agreement found.
/// O(cells of both).
double measure_overlap(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                       const AgreementCounts& counts);

}  // namespace gridmerge::internal
