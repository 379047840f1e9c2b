// SPDX-License-Identifier: Apache-2.0
#include "merge/log_odds.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>

#include "grid/known_rim.hpp"
#include "grid/parallel.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

namespace {

// Positions are compared with cell boundaries with this slack [cells]: far above rounding noise, far below
// what shows. A centre that lies on a boundary but for noise then always falls to the same side, so no row of
// cells is lost.
constexpr double kSlack = 1e-6;

// The box of the input's known cells in the output frame. The extreme points of a set of cells, in any
// direction, are corners of the first and last cells of its rows.
Box known_box(const PlacedMap& input) {
  const OccupancyGrid& map = *input.map;
  const ManyPointsTransform T_output_grid(input.T_output_map * map.origin);
  const auto is_known = [](Cell cell) { return cell != Cell::unknown; };
  Box box;
  for (int row = 0; row < map.height; ++row) {
    throw_if_cancelled();
    const auto begin = map.cells.begin() + static_cast<std::ptrdiff_t>(map.index(0, row));
    const auto end = begin + map.width;
    const auto first = std::find_if(begin, end, is_known);
    if (first == end) continue;
    const auto last =
        std::find_if(std::make_reverse_iterator(end), std::make_reverse_iterator(first), is_known).base();
    for (const auto column : {first - begin, last - begin}) {
      for (const int corner_row : {row, row + 1}) {
        box.add(T_output_grid *
                Point2{static_cast<double>(column) * map.resolution, corner_row * map.resolution});
      }
    }
  }
  return box;
}

// The same of a bent input: its extreme points are bent corners of cells at the rim of what it knows, or
// between two of them, where the rim bulges by less than a cell.
Box known_box(const PlacedMap& input, const Deformation& deformation) {
  if (deformation.is_identity()) return known_box(input);
  Box box;
  for_each_rim_corner(*input.map,
                      [&](const Point2& corner) { box.add(input.T_output_map * deformation.bend(corner)); });
  return box;
}

// Lower-left corner of the input whose map frame is the output frame (the lowest one, should there be
// several).
std::optional<Point2> frame_anchor(const std::vector<PlacedMap>& inputs) {
  std::optional<Point2> anchor;
  for (const PlacedMap& input : inputs) {
    if (input.T_output_map != SE2{}) continue;
    const Point2 corner{input.map->origin.x, input.map->origin.y};
    if (!anchor || std::tie(corner.x, corner.y) < std::tie(anchor->x, anchor->y)) anchor = corner;
  }
  return anchor;
}

std::int16_t to_log_odds(double probability) {
  return static_cast<std::int16_t>(std::lround(std::log(probability / (1.0 - probability)) * kLogOddsPerNat));
}

// What a map says of one of its cells: the cell gives the sign and the probability, where there is one, the
// strength.
std::int16_t cell_log_odds(const OccupancyGrid& map, std::size_t index) {
  static const std::int16_t occupied = to_log_odds(0.85);
  static const std::int16_t free = to_log_odds(0.35);
  const Cell cell = map.cells[index];
  if (cell == Cell::unknown) return 0;
  if (map.probability.empty() || std::isnan(map.probability[index]))
    return cell == Cell::occupied ? occupied : free;
  const std::int16_t stated = to_log_odds(std::clamp<double>(map.probability[index], 0.12, 0.88));
  return cell == Cell::occupied ? std::max<std::int16_t>(stated, 1) : std::min<std::int16_t>(stated, -1);
}

// The log-odds of a map's cells in a box, to be looked up at points. Where the map goes on beyond the box,
// points lie at least a cell from its side. A border of one unknown cell lets neighbours be read without a
// check.
class LogOddsSource {
 public:
  LogOddsSource(const OccupancyGrid& map, const CellBox& box)
      : box_(box),
        stride_(static_cast<std::size_t>(box.width()) + 2),
        log_odds_(stride_ * (static_cast<std::size_t>(box.height()) + 2), 0),
        has_band_(log_odds_.size(), 0) {
    parallel_rows(box.bottom, box.top, [&](int row) {
      for (int column = box.left; column < box.right; ++column)
        log_odds_[offset(column, row)] = cell_log_odds(map, map.index(column, row));
    });
    parallel_rows(box.bottom, box.top, [&](int row) { mark_bands(row); });
  }

  // What the map says at a point, in its own cells from its lower-left corner.
  std::int16_t at(double x, double y) const {
    x += kSlack;
    y += kSlack;
    if (!(x >= box_.left && x < box_.right && y >= box_.bottom && y < box_.top)) return 0;
    const int column = static_cast<int>(x);
    const int row = static_cast<int>(y);
    const std::size_t here = offset(column, row);
    const std::int16_t value = log_odds_[here];
    if (value > 0 || has_band_[here] == 0) return value;
    const std::int16_t band = joined_diagonally(here, x - column, y - row);
    return band > 0 ? band : value;
  }

 private:
  std::size_t offset(int column, int row) const {
    return static_cast<std::size_t>(row - box_.bottom + 1) * stride_ +
           static_cast<std::size_t>(column - box_.left + 1);
  }

  // The cells of a row that joined_diagonally() may say something of: most have no such neighbours.
  void mark_bands(int row) {
    const std::size_t begin = offset(box_.left, row);
    for (std::size_t wall = begin; wall < begin + static_cast<std::size_t>(box_.width()); ++wall) {
      if (log_odds_[wall] <= 0) continue;
      for (const std::size_t above : {wall - stride_, wall + stride_}) {
        if (log_odds_[above] > 0) continue;
        if (log_odds_[above - 1] > 0) has_band_[wall - 1] = 1;
        if (log_odds_[above + 1] > 0) has_band_[wall + 1] = 1;
      }
    }
  }

  // The log-odds of the band that joins two occupied neighbours of this cell across one of its corners, if
  // they touch only there and the point (u, v) of the cell is in the band. A band one cell wide reaches
  // 1/sqrt(2) along the cell's sides; the cell's centre is outside it, so a map drawn without rotation or
  // shift is copied exactly.
  std::int16_t joined_diagonally(std::size_t here, double u, double v) const {
    std::int16_t strongest = 0;
    for (const bool right : {false, true}) {
      for (const bool upper : {false, true}) {
        if ((right ? 1.0 - u : u) + (upper ? 1.0 - v : v) > std::numbers::sqrt2 / 2.0) continue;
        const std::size_t beside = right ? here + 1 : here - 1;
        const std::size_t above = upper ? here + stride_ : here - stride_;
        const std::size_t across = upper ? beside + stride_ : beside - stride_;
        if (log_odds_[beside] <= 0 || log_odds_[above] <= 0 || log_odds_[across] > 0) continue;
        strongest = std::max(strongest, std::min(log_odds_[beside], log_odds_[above]));
      }
    }
    return strongest;
  }

  CellBox box_;
  std::size_t stride_;
  std::vector<std::int16_t> log_odds_;
  std::vector<std::uint8_t> has_band_;
};

// The lattice cells within `limits` that a box touches, as an empty patch.
LogOddsPatch patch_over(const Box& box, const Lattice& lattice, const CellBox& limits) {
  LogOddsPatch patch;
  if (box.empty()) return patch;
  const auto cell_range = [&](double low, double high, double corner, int size) {
    const auto clip = [&](double cell) { return static_cast<int>(std::fmin(std::fmax(cell, 0.0), size)); };
    const int first = clip(std::floor((low - corner) / lattice.resolution - kSlack));
    const int end = clip(std::ceil((high - corner) / lattice.resolution + kSlack));
    return std::pair(first, end);
  };
  CellBox touched;
  std::tie(touched.left, touched.right) = cell_range(box.min_x, box.max_x, lattice.corner.x, lattice.width);
  std::tie(touched.bottom, touched.top) = cell_range(box.min_y, box.max_y, lattice.corner.y, lattice.height);
  const CellBox drawn = intersect(touched, limits);
  patch.column = drawn.left;
  patch.row = drawn.bottom;
  patch.width = drawn.width();
  patch.height = drawn.height();
  patch.log_odds.assign(static_cast<std::size_t>(patch.width) * static_cast<std::size_t>(patch.height), 0);
  return patch;
}

void keep_strongest(std::int16_t& target, std::int16_t value) {
  if (value != 0 && (target == 0 || value > target)) target = value;
}

// Looks up the map under `samples` x `samples` points of every cell of the patch.
void sample_map(const PlacedMap& input, const Lattice& lattice, int samples, LogOddsPatch& patch) {
  constexpr int kRim = 2;  // for neighbours across a corner, and rounding
  const SE2 T_grid_output = inverse(input.T_output_map * input.map->origin);
  const LogOddsSource source(
      *input.map,
      cells_under({patch.column, patch.row, patch.column + patch.width, patch.row + patch.height},
                  lattice.resolution, T_grid_output * SE2{lattice.corner.x, lattice.corner.y, 0.0},
                  input.map->resolution, kRim, all_cells(*input.map)));
  const double map_resolution = input.map->resolution;
  const double c = std::cos(T_grid_output.theta) / map_resolution;
  const double s = std::sin(T_grid_output.theta) / map_resolution;
  const double shift_x = T_grid_output.x / map_resolution;
  const double shift_y = T_grid_output.y / map_resolution;
  parallel_rows(patch.row, patch.row + patch.height, [&](int row) {
    std::size_t target = patch.index(0, row - patch.row);
    for (int column = patch.column; column < patch.column + patch.width; ++column, ++target) {
      for (int j = 0; j < samples; ++j) {
        const double y = lattice.corner.y + (row + (j + 0.5) / samples) * lattice.resolution;
        for (int i = 0; i < samples; ++i) {
          const double x = lattice.corner.x + (column + (i + 0.5) / samples) * lattice.resolution;
          keep_strongest(patch.log_odds[target], source.at(c * x - s * y + shift_x, s * x + c * y + shift_y));
        }
      }
    }
  });
}

// From the output's frame to a bent map's, at the nodes of a coarse grid over a patch; linear between them.
// Nodes are cells of the lattice by their numbers, so that no patch has others.
class StraightenedGrid {
 public:
  StraightenedGrid(const PlacedMap& input, const Deformation& deformation, const Lattice& lattice,
                   const LogOddsPatch& patch)
      // As a number of cells it may be more than an int holds; beyond the lattice there is nothing to look
      // up.
      : step_(static_cast<int>(std::clamp(kNodesApart * deformation.spacing() / lattice.resolution, 1.0,
                                          static_cast<double>(std::max(lattice.width, lattice.height))))),
        first_column_(patch.column / step_),
        first_row_(patch.row / step_),
        columns_((patch.column + patch.width) / step_ - first_column_ + 2) {
    const SE2 T_map_output = inverse(input.T_output_map), T_grid_map = inverse(input.map->origin);
    const int end_row = (patch.row + patch.height) / step_ + 2;
    for (int j = first_row_; j < end_row; ++j) {
      throw_if_cancelled();
      for (int i = first_column_; i < first_column_ + columns_; ++i) {
        const Point2 node{lattice.corner.x + static_cast<double>(i) * step_ * lattice.resolution,
                          lattice.corner.y + static_cast<double>(j) * step_ * lattice.resolution};
        const Point2 in_grid = T_grid_map * deformation.straighten(T_map_output * node);
        nodes_.push_back({in_grid.x / input.map->resolution, in_grid.y / input.map->resolution});
      }
    }
  }

  // Of a point of a cell of the lattice, x and y from 0 to 1 across the cell: in the map's cells.
  Point2 at(int column, int row, double x, double y) const {
    const int i = column / step_, j = row / step_;
    const double u = (column - i * step_ + x) / step_, v = (row - j * step_ + y) / step_;
    const Point2* const low =
        nodes_.data() + static_cast<std::ptrdiff_t>(j - first_row_) * columns_ + (i - first_column_);
    const Point2* const high = low + columns_;
    return {(1.0 - v) * ((1.0 - u) * low[0].x + u * low[1].x) + v * ((1.0 - u) * high[0].x + u * high[1].x),
            (1.0 - v) * ((1.0 - u) * low[0].y + u * low[1].y) + v * ((1.0 - u) * high[0].y + u * high[1].y)};
  }

 private:
  static constexpr double kNodesApart = 1.0 / 16.0;  // [spacings]

  int step_;
  int first_column_;  // of nodes
  int first_row_;
  int columns_;
  std::vector<Point2> nodes_;
};

// As sample_map() for a bent map.
void sample_bent_map(const PlacedMap& input, const Deformation& deformation, const Lattice& lattice,
                     int samples, LogOddsPatch& patch) {
  const LogOddsSource source(*input.map, all_cells(*input.map));
  const StraightenedGrid straightened(input, deformation, lattice, patch);
  parallel_rows(0, patch.height, [&](int row) {
    std::size_t target = patch.index(0, row);
    for (int column = 0; column < patch.width; ++column, ++target) {
      for (int j = 0; j < samples; ++j) {
        for (int i = 0; i < samples; ++i) {
          const Point2 p = straightened.at(patch.column + column, patch.row + row, (i + 0.5) / samples,
                                           (j + 0.5) / samples);
          keep_strongest(patch.log_odds[target], source.at(p.x, p.y));
        }
      }
    }
  });
}

// Drops every known cell of the map into the patch's cell that its centre lies in. `to_lattice` takes a
// point of the map, in its own cells from its lower-left corner, to the lattice's cells.
template <typename ToLattice>
void splat_map(const OccupancyGrid& map, const ToLattice& to_lattice, LogOddsPatch& patch) {
  const int right = patch.column + patch.width, top = patch.row + patch.height;
  for (int row = 0; row < map.height; ++row) {
    throw_if_cancelled();
    for (int column = 0; column < map.width; ++column) {
      const std::int16_t value = cell_log_odds(map, map.index(column, row));
      if (value == 0) continue;
      const auto [x, y] = to_lattice(column + 0.5, row + 0.5);
      if (!(x >= patch.column && x < right && y >= patch.row && y < top)) continue;
      keep_strongest(
          patch.log_odds[patch.index(static_cast<int>(x) - patch.column, static_cast<int>(y) - patch.row)],
          value);
    }
  }
}

}  // namespace

Box covered_box(const std::vector<PlacedMap>& inputs, const std::vector<Deformation>& deformations) {
  Box box;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    validate(inputs[i]);
    box.add(i < deformations.size() ? known_box(inputs[i], deformations[i]) : known_box(inputs[i]));
  }
  return box;
}

bool is_any_bent(const std::vector<Deformation>& deformations) {
  return std::any_of(deformations.begin(), deformations.end(),
                     [](const Deformation& one) { return !one.is_identity(); });
}

Lattice cover(const std::vector<PlacedMap>& inputs, double resolution,
              const std::vector<Deformation>& deformations, const LatticeLimits& limits) {
  if (!std::isfinite(resolution) || resolution <= 0.0) {
    throw std::invalid_argument("the output's resolution must be a positive number of metres");
  }
  const Box box = covered_box(inputs, deformations);
  if (box.empty()) return {1, 1, resolution, {}};

  const Point2 anchor = frame_anchor(inputs).value_or(Point2{box.min_x, box.min_y});
  const auto snap = [&](double low, double to) {
    return to + std::floor((low - to) / resolution + kSlack) * resolution;
  };
  const Point2 corner{snap(box.min_x, anchor.x), snap(box.min_y, anchor.y)};
  const double columns = std::max(1.0, std::ceil((box.max_x - corner.x) / resolution - kSlack));
  const double rows = std::max(1.0, std::ceil((box.max_y - corner.y) / resolution - kSlack));
  const auto require_within = [](double size, double limit, const char* what) {
    if (!(size <= limit))
      throw std::invalid_argument("the merged map would exceed 2^" + std::to_string(std::ilogb(limit)) +
                                  what);
  };
  require_within(columns * rows, limits.cells, " cells");
  require_within(std::max(columns, rows), limits.side, " cells per side");
  return {static_cast<int>(columns), static_cast<int>(rows), resolution, corner};
}

LogOddsPatch draw_log_odds(const PlacedMap& input, const Lattice& lattice, const Deformation& deformation) {
  return draw_log_odds(input, lattice, deformation, lattice.whole());
}

LogOddsPatch draw_log_odds(const PlacedMap& input, const Lattice& lattice, const Deformation& deformation,
                           const CellBox& within) {
  validate(input);
  LogOddsPatch patch = patch_over(known_box(input, deformation), lattice, within);
  if (patch.log_odds.empty()) return patch;
  const OccupancyGrid& map = *input.map;
  const double ratio = lattice.resolution / map.resolution;
  const auto to_lattice = [&](const Point2& output) {
    return Point2{(output.x - lattice.corner.x) / lattice.resolution + kSlack,
                  (output.y - lattice.corner.y) / lattice.resolution + kSlack};
  };
  // A square of side a holds a point of any square grid of spacing a / sqrt(2), however that is rotated. So
  // from that ratio on, every lattice cell meets the centre of a map cell; below it, two samples per side
  // meet every map cell.
  constexpr double kEveryCell = std::numbers::sqrt2;
  if (!deformation.is_identity()) {
    constexpr double kMostStretched = 1.0 + Deformation::kMostStrain;
    // Squeezed at most so much, the cells of the map are so much denser.
    constexpr double kMostSqueezed = 1.0 / (1.0 - Deformation::kMostStrain);
    if (ratio >= kMostStretched * kEveryCell) {
      const ManyPointsTransform T_map_grid(map.origin), T_output_map(input.T_output_map);
      splat_map(
          map,
          [&](double x, double y) {
            const Point2 straight = T_map_grid * Point2{x * map.resolution, y * map.resolution};
            return to_lattice(T_output_map * deformation.bend(straight));
          },
          patch);
    } else {
      const int samples = ratio <= 1.0 + kSlack ? 1 : static_cast<int>(std::ceil(kMostSqueezed * ratio));
      sample_bent_map(input, deformation, lattice, samples, patch);
    }
  } else if (ratio >= kEveryCell) {
    const SE2 T_output_grid = input.T_output_map * map.origin;
    const Point2 shift = to_lattice({T_output_grid.x, T_output_grid.y});
    const double scale = map.resolution / lattice.resolution;
    const double c = std::cos(T_output_grid.theta) * scale, s = std::sin(T_output_grid.theta) * scale;
    splat_map(
        map,
        [&](double x, double y) {
          return Point2{c * x - s * y + shift.x, s * x + c * y + shift.y};
        },
        patch);
  } else {
    sample_map(input, lattice, ratio <= 1.0 + kSlack ? 1 : 2, patch);
  }
  return patch;
}

}  // namespace gridmerge::internal
