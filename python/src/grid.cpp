// SPDX-License-Identifier: Apache-2.0
#include <nanobind/ndarray.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "bindings.hpp"
#include "grid/equal_grids.hpp"
#include "gridmerge/grid/message_values.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "worker.hpp"

namespace gridmerge::python {

namespace {

// Of any strides: a copy of an array that claims to be huge would be huge.
template <typename Value>
using Input = nb::ndarray<const Value, nb::ndim<2>, nb::device::cpu>;
using Percentages = Input<std::int8_t>;
using Cells = Input<std::uint8_t>;
using Probabilities = Input<float>;

constexpr std::int8_t kUnknown = -1;
constexpr std::int8_t kFree = 0;
constexpr std::int8_t kOccupied = 100;

std::int8_t percentage_of(float probability) {
  return std::isnan(probability)
             ? kUnknown
             : static_cast<std::int8_t>(std::lround(100.0F * std::clamp(probability, 0.0F, 1.0F)));
}

bool is_plain(std::int8_t percentage) {
  return percentage == kUnknown || percentage == kFree || percentage == kOccupied;
}

template <typename Value>
OccupancyGrid frame(const char* name, const Input<Value>& values, double resolution, const Pose& origin) {
  const std::size_t height = values.shape(0), width = values.shape(1);
  const std::string shape = "its shape is (" + std::to_string(height) + ", " + std::to_string(width) + ")";
  if (height == 0 || width == 0) throw std::invalid_argument(name + (": has no cells: " + shape));
  if (height > kMaxGridCells / width)
    throw std::invalid_argument(name +
                                (": has more than " + std::to_string(kMaxGridCells) + " cells: " + shape));
  OccupancyGrid grid;
  grid.width = static_cast<int>(width);
  grid.height = static_cast<int>(height);
  grid.resolution = resolution;
  grid.origin = to_se2(origin);
  return grid;
}

template <typename Value>
std::vector<Value> copy_of(const Input<Value>& values) {
  const std::size_t height = values.shape(0), width = values.shape(1);
  const std::int64_t up = values.stride(0), right = values.stride(1);
  std::vector<Value> copy(height * width);
  for (std::size_t row = 0; row < height; ++row) {
    const Value* from = values.data() + static_cast<std::int64_t>(row) * up;
    Value* to = copy.data() + row * width;
    if (right == 1) {
      std::copy_n(from, width, to);
    } else {
      for (std::size_t column = 0; column < width; ++column, from += right) to[column] = *from;
    }
  }
  return copy;
}

// Another thread may write into the array meanwhile: what is checked is what is used.
Map from_percentages(const Percentages& data, double resolution, const Pose& origin) {
  const OccupancyGrid grid = frame("data", data, resolution, origin);
  const OthersRun meanwhile;
  const std::vector<std::int8_t> values = copy_of(data);
  const auto wrong = std::find_if(values.begin(), values.end(),
                                  [](std::int8_t value) { return value < kUnknown || value > kOccupied; });
  if (wrong != values.end()) {
    const auto at = static_cast<std::size_t>(wrong - values.begin());
    throw std::invalid_argument("data: the value " + std::to_string(*wrong) + " in row " +
                                std::to_string(at / data.shape(1)) + ", column " +
                                std::to_string(at % data.shape(1)) +
                                " is neither -1 (unknown) nor a percentage from 0 to 100");
  }
  return {std::make_shared<const OccupancyGrid>(
              grid_of_percentages(grid.width, grid.height, grid.resolution, grid.origin, values)),
          {},
          {}};
}

Map from_cells(const Cells& cells, double resolution, const Pose& origin,
               const std::optional<Probabilities>& probability) {
  OccupancyGrid grid = frame("cells", cells, resolution, origin);
  if (probability && (probability->shape(0) != cells.shape(0) || probability->shape(1) != cells.shape(1)))
    throw std::invalid_argument("probability: its shape must be that of cells");
  const OthersRun meanwhile;
  const std::vector<std::uint8_t> values = copy_of(cells);
  grid.cells.resize(values.size());
  std::transform(values.begin(), values.end(), grid.cells.begin(), [](std::uint8_t value) {
    if (value > static_cast<std::uint8_t>(Cell::occupied))
      throw std::invalid_argument("cells: the value " + std::to_string(value) +
                                  " is neither 0 (unknown) nor 1 (free) nor 2 (occupied)");
    return static_cast<Cell>(value);
  });
  if (probability) {
    grid.probability = copy_of(*probability);
    for (const float value : grid.probability) {
      if (!std::isnan(value) && !(value >= 0.0F && value <= 1.0F))
        throw std::invalid_argument("probability: its values must lie in [0, 1], or be NaN where unknown");
    }
  }
  return {std::make_shared<const OccupancyGrid>(std::move(grid)), {}, {}};
}

/// The same map, with what is told of the files that it was read from.
Map with_files(const Map& map, const std::vector<nb::bytes>& warnings, const std::vector<nb::bytes>& files) {
  Map told{map.grid, {}, {}};
  for (const nb::bytes& warning : warnings) told.warnings.push_back(to_string(warning));
  for (const nb::bytes& file : files) told.files.emplace_back(to_string(file));
  return told;
}

/// Whether the grid is one that from_percentages() makes of its percentages: then they tell all of it.
bool follows_from_percentages(const OccupancyGrid& grid) {
  bool plain = true;
  for (std::size_t i = 0; i < grid.probability.size(); ++i) {
    const std::int8_t percentage = percentage_of(grid.probability[i]);
    plain = plain && is_plain(percentage);
    if (cell_of_percentage(percentage) != grid.cells[i]) return false;
    if (percentage != kUnknown && probability_of_percentage(percentage) != grid.probability[i]) return false;
  }
  return !plain;
}

std::int8_t plain_value(Cell cell) {
  constexpr std::array<std::int8_t, 3> kValues{kUnknown, kFree, kOccupied};
  return kValues[static_cast<std::size_t>(cell)];
}

/// An array that owns its values.
nb::ndarray<nb::numpy, std::int8_t, nb::ndim<2>> to_numpy(const Map& map, std::optional<bool> probabilities) {
  const OccupancyGrid& grid = *map.grid;
  if (probabilities == true && grid.probability.empty())
    throw std::invalid_argument("probabilities: the map has none");
  auto values = std::make_unique<std::vector<std::int8_t>>(grid.cells.size());
  {
    const OthersRun meanwhile;
    const bool as_percentages =
        !grid.probability.empty() && probabilities.value_or(follows_from_percentages(grid));
    if (as_percentages) {
      std::transform(grid.probability.begin(), grid.probability.end(), values->begin(), percentage_of);
    } else {
      std::transform(grid.cells.begin(), grid.cells.end(), values->begin(), plain_value);
    }
  }
  std::int8_t* data = values->data();
  const nb::capsule owner(values.release(), [](void* owned) noexcept {
    std::unique_ptr<std::vector<std::int8_t>>(static_cast<std::vector<std::int8_t>*>(owned)).reset();
  });
  return {data, {static_cast<std::size_t>(grid.height), static_cast<std::size_t>(grid.width)}, owner};
}

template <typename Value>
using View = nb::ndarray<nb::numpy, const Value, nb::ndim<2>>;

/// A view that keeps the grid alive.
template <typename Value>
View<Value> view(const Map& map, const void* values) {
  using Kept = std::shared_ptr<const OccupancyGrid>;
  const nb::capsule owner(std::make_unique<Kept>(map.grid).release(), [](void* kept) noexcept {
    std::unique_ptr<Kept>(static_cast<Kept*>(kept)).reset();
  });
  return {static_cast<const Value*>(values),
          {static_cast<std::size_t>(map.grid->height), static_cast<std::size_t>(map.grid->width)},
          owner};
}

}  // namespace

void bind_grid(nb::module_& module) {
  module.def(
      "decimal_of",
      [](double value) {
        const bool is_single = std::abs(value) <= std::numeric_limits<float>::max() &&
                               static_cast<double>(static_cast<float>(value)) == value;
        return is_single ? decimal_of(static_cast<float>(value)) : value;
      },
      nb::arg("value"));
  nb::class_<Map>(module, "Grid")
      .def_static("from_percentages", &from_percentages, nb::arg("data").noconvert(), nb::arg("resolution"),
                  nb::arg("origin"))
      .def_static("from_cells", &from_cells, nb::arg("cells").noconvert(), nb::arg("resolution"),
                  nb::arg("origin"), nb::arg("probability").noconvert().none())
      .def_prop_ro("width", [](const Map& map) { return map.grid->width; })
      .def_prop_ro("height", [](const Map& map) { return map.grid->height; })
      .def_prop_ro("resolution", [](const Map& map) { return map.grid->resolution; })
      .def_prop_ro("origin", [](const Map& map) { return to_pose(map.grid->origin); })
      .def_prop_ro("counts",
                   [](const Map& map) {
                     const CellCounts counts = count_cells(*map.grid);
                     return std::tuple(counts.unknown, counts.free, counts.occupied);
                   })
      .def_prop_ro("warnings", [](const Map& map) { return to_strs(map.warnings); })
      .def_prop_ro("files",
                   [](const Map& map) {
                     std::vector<nb::bytes> files;
                     for (const std::filesystem::path& file : map.files)
                       files.emplace_back(file.c_str(), file.native().size());
                     return files;
                   })
      .def("with_files", &with_files, nb::arg("warnings"), nb::arg("files"))
      .def("to_numpy", &to_numpy, nb::arg("probabilities").none())
      .def("cells", [](const Map& map) { return view<std::uint8_t>(map, map.grid->cells.data()); })
      .def("probability",
           [](const Map& map) {
             return map.grid->probability.empty()
                        ? std::nullopt
                        : std::optional(view<float>(map, map.grid->probability.data()));
           })
      .def(
          "equals",
          [](const Map& map, const Map& other) { return internal::are_equal(*map.grid, *other.grid); },
          nb::arg("other"));
}

}  // namespace gridmerge::python
