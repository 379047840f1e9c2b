// SPDX-License-Identifier: Apache-2.0
#include "merge/fuse_box.hpp"

#include <algorithm>
#include <limits>

#include "grid/logistic.hpp"
#include "grid/painted.hpp"
#include "grid/parallel.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::int32_t kLimit = static_cast<std::int32_t>(3.5 * kLogOddsPerNat);

/// What is remembered of the inputs that know a cell, beside the sum of their log-odds.
enum Witness : std::uint8_t { kSawFree = 1, kSawOccupied = 2, kSawTwice = 4 };

/// What all inputs say of the cells of a box, row by row.
class Totals {
 public:
  explicit Totals(const CellBox& box)
      : box_(box),
        sum_(static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()), 0),
        witnesses_(sum_.size(), 0) {}

  /// `patch` lies within the box.
  void add(const LogOddsPatch& patch) {
    parallel_rows(0, patch.height, [&](int row) {
      std::size_t target = index(patch.column, patch.row + row);
      for (int column = 0; column < patch.width; ++column, ++target) {
        const std::int16_t log_odds = patch.at(column, row);
        if (log_odds == 0) continue;
        sum_[target] += log_odds;
        std::uint8_t& seen = witnesses_[target];
        seen = static_cast<std::uint8_t>(seen | (seen != 0 ? kSawTwice : 0) |
                                         (log_odds > 0 ? kSawOccupied : kSawFree));
      }
    });
  }

  SharedCells draw_row(int row, OccupancyGrid& fused, const LatticeCell& first) const {
    SharedCells shared;
    std::size_t from = index(box_.left, row), to = fused.index(box_.left - first.column, row - first.row);
    for (int column = box_.left; column < box_.right; ++column, ++from, ++to) {
      const bool conflict = (witnesses_[from] & kSawFree) != 0 && (witnesses_[from] & kSawOccupied) != 0;
      if (conflict) ++shared.conflicting;
      if (!conflict && (witnesses_[from] & kSawTwice) != 0) ++shared.agreeing;
      if (sum_[from] == 0) {
        fused.cells[to] = Cell::unknown;
        fused.probability[to] = std::numeric_limits<float>::quiet_NaN();
        continue;
      }
      const double log_odds = std::clamp(sum_[from], -kLimit, kLimit) / kLogOddsPerNat;
      fused.cells[to] = log_odds > 0.0 ? Cell::occupied : Cell::free;
      fused.probability[to] = static_cast<float>(logistic(log_odds));
    }
    return shared;
  }

 private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row - box_.bottom) * static_cast<std::size_t>(box_.width()) +
           static_cast<std::size_t>(column - box_.left);
  }

  CellBox box_;
  std::vector<std::int32_t> sum_;
  std::vector<std::uint8_t> witnesses_;
};

/// The map without what is painted; null where that is the map.
std::unique_ptr<const OccupancyGrid> as_seen(const OccupancyGrid& map) {
  if (!is_mostly_painted(map) || count_cells(map).free == 0) return nullptr;
  return std::make_unique<const OccupancyGrid>(without_painted(map));
}

}  // namespace

FusedInputs::FusedInputs(std::vector<PlacedMap> maps) : maps_(std::move(maps)) {
  for (PlacedMap& input : maps_) {
    validate(input);
    if (seen_.emplace_back(as_seen(*input.map))) input.map = seen_.back().get();
  }
}

bool FusedInputs::is_any_painted() const {
  return std::any_of(seen_.begin(), seen_.end(), [](const auto& seen) { return seen != nullptr; });
}

SharedCells fuse_box(const std::vector<PlacedMap>& inputs, const std::vector<Deformation>& deformations,
                     const Lattice& lattice, const CellBox& box, OccupancyGrid& fused,
                     const LatticeCell& first) {
  Totals totals(box);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    totals.add(
        draw_log_odds(inputs[i], lattice, i < deformations.size() ? deformations[i] : Deformation(), box));
  std::vector<SharedCells> of_rows(static_cast<std::size_t>(box.height()));
  parallel_rows(box.bottom, box.top, [&](int row) {
    of_rows[static_cast<std::size_t>(row - box.bottom)] = totals.draw_row(row, fused, first);
  });
  SharedCells shared;
  for (const SharedCells& of_row : of_rows) shared.add(of_row);
  return shared;
}

}  // namespace gridmerge::internal
