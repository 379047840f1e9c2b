// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/fuse.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "grid/logistic.hpp"
#include "grid/parallel.hpp"
#include "gridmerge/grid/resample.hpp"
#include "gridmerge/similarity/lattice.hpp"
#include "merge/log_odds.hpp"

namespace gridmerge {

using namespace internal;

namespace {

constexpr std::int32_t kLimit = static_cast<std::int32_t>(3.5 * kLogOddsPerNat);

// What is remembered of the inputs that know a cell, beside the sum of their log-odds.
enum Witness : std::uint8_t { kSawFree = 1, kSawOccupied = 2, kSawTwice = 4 };

struct Totals {
  std::vector<std::int32_t> sum;
  std::vector<std::uint8_t> witnesses;
};

void add(const LogOddsPatch& patch, const Lattice& lattice, Totals& total) {
  parallel_rows(0, patch.height, [&](int row) {
    std::size_t target = static_cast<std::size_t>(patch.row + row) * static_cast<std::size_t>(lattice.width) +
                         static_cast<std::size_t>(patch.column);
    for (int column = 0; column < patch.width; ++column, ++target) {
      const std::int16_t log_odds = patch.at(column, row);
      if (log_odds == 0) continue;
      total.sum[target] += log_odds;
      std::uint8_t& seen = total.witnesses[target];
      seen = static_cast<std::uint8_t>(seen | (seen != 0 ? kSawTwice : 0) |
                                       (log_odds > 0 ? kSawOccupied : kSawFree));
    }
  });
}

// Cells of a row that several maps know.
struct SharedCells {
  std::int64_t agreeing = 0;
  std::int64_t conflicting = 0;
};

SharedCells draw_row(const Totals& total, int row, OccupancyGrid& fused) {
  SharedCells shared;
  const std::size_t begin = fused.index(0, row);
  for (std::size_t i = begin; i < begin + static_cast<std::size_t>(fused.width); ++i) {
    const bool conflict = (total.witnesses[i] & kSawFree) != 0 && (total.witnesses[i] & kSawOccupied) != 0;
    if (conflict) ++shared.conflicting;
    if (!conflict && (total.witnesses[i] & kSawTwice) != 0) ++shared.agreeing;
    if (total.sum[i] == 0) continue;
    const double log_odds = std::clamp(total.sum[i], -kLimit, kLimit) / kLogOddsPerNat;
    fused.cells[i] = log_odds > 0.0 ? Cell::occupied : Cell::free;
    fused.probability[i] = static_cast<float>(logistic(log_odds));
  }
  return shared;
}

// The map without what somebody painted black, where that is most of it; none where it is not.
std::unique_ptr<const OccupancyGrid> as_seen(const OccupancyGrid& map) {
  if (!is_mostly_painted(map) || count_cells(map).free == 0) return nullptr;
  return std::make_unique<const OccupancyGrid>(without_painted(map));
}

std::optional<EqualCells> measure_omega(const OccupancyGrid& lattice, const std::vector<PlacedMap>& inputs) {
  try {
    return EqualCells{count_equal_cells(lattice, inputs), static_cast<std::int64_t>(lattice.cells.size())};
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

}  // namespace

FusedMap fuse(const std::vector<PlacedMap>& maps, double resolution,
              const std::vector<Deformation>& deformations) {
  if (maps.empty()) throw std::invalid_argument("there is no map to fuse");
  std::vector<PlacedMap> inputs = maps;
  std::vector<std::unique_ptr<const OccupancyGrid>> seen;
  for (PlacedMap& input : inputs) {
    if (input.map == nullptr) continue;  // cover() refuses it
    validate(*input.map);
    if (seen.emplace_back(as_seen(*input.map))) input.map = seen.back().get();
  }
  const Lattice lattice = cover(inputs, resolution, deformations);
  FusedMap fused;
  fused.grid =
      make_grid(lattice.width, lattice.height, lattice.resolution, {lattice.corner.x, lattice.corner.y, 0.0});
  fused.grid.probability.assign(fused.grid.cells.size(), std::numeric_limits<float>::quiet_NaN());

  Totals total{std::vector<std::int32_t>(fused.grid.cells.size(), 0),
               std::vector<std::uint8_t>(fused.grid.cells.size(), 0)};
  bool is_bent = false;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Deformation deformation = i < deformations.size() ? deformations[i] : Deformation();
    is_bent = is_bent || !deformation.is_identity();
    add(draw_log_odds(inputs[i], lattice, deformation), lattice, total);
  }

  std::vector<SharedCells> shared(static_cast<std::size_t>(lattice.height));
  parallel_rows(0, lattice.height,
                [&](int row) { shared[static_cast<std::size_t>(row)] = draw_row(total, row, fused.grid); });
  for (const SharedCells& of_row : shared) {
    fused.conflicting += of_row.conflicting;
    fused.agreeing += of_row.agreeing;
  }
  if (!is_bent) fused.omega = measure_omega(fused.grid, inputs);
  return fused;
}

OccupancyGrid bent_map(const OccupancyGrid& map, const Deformation& deformation) {
  validate(map);
  if (deformation.is_identity()) return map;
  OccupancyGrid upright = map;
  upright.origin = {};
  const Deformation in_grid = seen_from(inverse(map.origin), deformation);
  const Lattice lattice = cover({PlacedMap{&upright, {}}}, map.resolution, {in_grid});
  const LogOddsPatch patch = draw_log_odds({&upright, {}}, lattice, in_grid);
  OccupancyGrid bent = make_grid(lattice.width, lattice.height, lattice.resolution,
                                 map.origin * SE2{lattice.corner.x, lattice.corner.y, 0.0});
  for (int row = 0; row < patch.height; ++row) {
    for (int column = 0; column < patch.width; ++column) {
      const std::int16_t log_odds = patch.at(column, row);
      if (log_odds != 0)
        bent.at(patch.column + column, patch.row + row) = log_odds > 0 ? Cell::occupied : Cell::free;
    }
  }
  return bent;
}

}  // namespace gridmerge
