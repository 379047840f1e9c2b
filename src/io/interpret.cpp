// SPDX-License-Identifier: Apache-2.0
#include "io/interpret.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "gridmerge/grid/message_values.hpp"
#include "io/cell_warnings.hpp"

namespace gridmerge::internal {

namespace {

constexpr float kUnknownProbability = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint8_t kOpaque = 255;

// What a pixel means.
struct Meaning {
  Cell cell = Cell::unknown;
  float probability = kUnknownProbability;
};

Cell classify(double occupancy, const MapYaml& yaml) {
  if (occupancy > yaml.occupied_thresh) return Cell::occupied;
  return occupancy < yaml.free_thresh ? Cell::free : Cell::unknown;
}

Meaning raw_meaning(double shade, const MapYaml& yaml) {
  const int percent = static_cast<int>(std::lround(shade * 255.0));
  return {cell_of_percentage(percent, {yaml.occupied_thresh, yaml.free_thresh}),
          probability_of_percentage(percent)};
}

double occupancy_of(double shade, const MapYaml& yaml) {
  return yaml.negate ? shade : 1.0 - shade;
}

Meaning scale_meaning(double shade, const MapYaml& yaml) {
  const double occupancy = occupancy_of(shade, yaml);
  const Cell cell = classify(occupancy, yaml);
  if (cell != Cell::unknown) return {cell, cell == Cell::occupied ? 1.0f : 0.0f};
  const double span = yaml.occupied_thresh - yaml.free_thresh;
  return {cell, span > 0.0 ? static_cast<float>((occupancy - yaml.free_thresh) / span) : 0.5f};
}

Meaning opaque_meaning(double shade, const MapYaml& yaml) {
  switch (yaml.mode) {
    case MapMode::raw:
      return raw_meaning(shade, yaml);
    case MapMode::scale:
      return scale_meaning(shade, yaml);
    case MapMode::trinary:
      break;
  }
  return {classify(occupancy_of(shade, yaml), yaml), kUnknownProbability};
}

// One entry for each lightness a pixel can have: pixels are many, values few.
std::vector<Meaning> opaque_meanings(std::uint16_t white, const MapYaml& yaml) {
  std::vector<Meaning> meanings(white + std::size_t{1});
  for (std::size_t value = 0; value < meanings.size(); ++value) {
    meanings[value] = opaque_meaning(static_cast<double>(value) / white, yaml);
  }
  return meanings;
}

const char* name(Cell cell) {
  return cell == Cell::occupied ? "occupied" : cell == Cell::free ? "free" : "unknown";
}

constexpr int kUnknownGray = 205;  // of 255: what map savers write for unknown
constexpr int kFreeGray = 254;     // and for free

std::uint32_t on_scale_of(const MapImage& image, int gray) {
  return static_cast<std::uint32_t>(image.white) * static_cast<std::uint32_t>(gray) / 255;
}

// Lightness 205 of 255 is p = 0.196: above a free_thresh of 0.196 by a hair, and below the 0.25 that many a
// YAML has. The picture of a map that somebody has negated holds 50 instead. A lossy one holds what is near.
void make_unknown_gray_unknown(const MapYaml& yaml, const MapImage& image, std::vector<Meaning>& meanings) {
  const auto make_unknown = [&](std::uint32_t lightness) {
    meanings[yaml.negate ? image.white - lightness : lightness].cell = Cell::unknown;
  };
  if (image.is_lossy) {
    const std::uint32_t gray = on_scale_of(image, kUnknownGray), free = on_scale_of(image, kFreeGray);
    for (std::uint32_t lightness = 2 * gray - (gray + free) / 2; lightness <= (gray + free) / 2; ++lightness)
      make_unknown(lightness);
  } else if (image.white * kUnknownGray % 255 == 0) {
    make_unknown(on_scale_of(image, kUnknownGray));
  }
}

bool is_opaque(const MapImage& image, std::size_t pixel) {
  return image.alpha.empty() || image.alpha[pixel] == kOpaque;
}

// Of pixels that are unknown because of their gray, though the thresholds call them something else.
void warn_of_unknown_gray(const MapYaml& yaml, const MapImage& image, const std::vector<Meaning>& literal,
                          const std::vector<Meaning>& meanings, std::vector<MapWarning>& warnings) {
  std::size_t count = 0;
  Cell cell = Cell::unknown;
  for (std::size_t pixel = 0; pixel < image.lightness.size(); ++pixel) {
    const std::uint16_t lightness = image.lightness[pixel];
    if (literal[lightness].cell == meanings[lightness].cell || !is_opaque(image, pixel)) continue;
    cell = literal[lightness].cell;
    ++count;
  }
  if (count == 0) return;
  const bool is_free = cell == Cell::free;
  warnings.push_back(
      {MapWarningKind::unknown_gray,
       fmt::format(
           "{} pixels of lightness {}{}, which map savers write for unknown, load as unknown, though {} {} "
           "would make them {} (--literal-thresholds reads to the letter)",
           count, image.is_lossy ? "about " : "", yaml.negate ? 255 - kUnknownGray : kUnknownGray,
           is_free ? "free_thresh" : "occupied_thresh", is_free ? yaml.free_thresh : yaml.occupied_thresh,
           name(cell))});
}

// Of the same gray where it is known: thresholds that are read to the letter, a negated map that holds it
// all the same, or scale mode, in which map_saver writes whole percents and never 205.
void warn_of_known_gray(const MapYaml& yaml, const MapImage& image, const std::vector<Meaning>& meanings,
                        std::vector<MapWarning>& warnings) {
  if (image.white * kUnknownGray % 255 != 0) return;
  const std::uint32_t gray = on_scale_of(image, kUnknownGray);
  const Cell cell = meanings[gray].cell;
  if (cell == Cell::unknown) return;
  std::size_t count = 0;
  for (std::size_t pixel = 0; pixel < image.lightness.size(); ++pixel) {
    if (image.lightness[pixel] == gray && is_opaque(image, pixel)) ++count;
  }
  if (count == 0) return;
  warnings.push_back(
      {MapWarningKind::gray_is_known,
       fmt::format("{} pixels of lightness 205, which map_saver writes for unknown, load as {} with "
                   "free_thresh {} and negate {}",
                   count, name(cell), yaml.free_thresh, yaml.negate ? 1 : 0)});
}

// `literal` and `meanings` differ in the gray that warn_of_unknown_gray() tells of.
void warn_of_alpha(const MapYaml& yaml, const MapImage& image, const OccupancyGrid& grid,
                   const std::vector<Meaning>& literal, const std::vector<Meaning>& meanings,
                   std::vector<MapWarning>& warnings) {
  if (image.alpha.empty()) return;
  std::size_t count = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const std::size_t pixel = grid.index(column, row);
      const std::uint16_t lightness = image.lightness[pixel];
      if (is_opaque(image, pixel) && literal[lightness].cell != meanings[lightness].cell) continue;
      const double shade = static_cast<double>(lightness) / image.white;
      const double shade_in_nav2 = (3.0 * shade + image.alpha[pixel] / 255.0) / 4.0;
      if (classify(occupancy_of(shade_in_nav2, yaml), yaml) != grid.at(column, image.height - 1 - row))
        ++count;
    }
  }
  if (count == 0) return;
  warnings.push_back(
      {MapWarningKind::alpha,
       fmt::format("{} pixels load otherwise in nav2, which averages alpha into the lightness; here alpha "
                   "only marks unknown cells",
                   count)});
}

}  // namespace

LoadedMap interpret(const MapYaml& yaml, const MapImage& image, bool literal_thresholds) {
  const std::vector<Meaning> literal = opaque_meanings(image.white, yaml);
  std::vector<Meaning> meanings = literal;
  if (yaml.mode == MapMode::trinary && !literal_thresholds) make_unknown_gray_unknown(yaml, image, meanings);
  const bool alpha_counts = !image.alpha.empty() && yaml.mode != MapMode::raw;
  const bool keep_probability = yaml.mode != MapMode::trinary;

  LoadedMap map;
  map.warnings = yaml.warnings;
  map.grid = make_grid(image.width, image.height, yaml.resolution, yaml.origin);
  if (keep_probability) map.grid.probability.resize(map.grid.cells.size());
  for (int row = 0; row < image.height; ++row) {
    std::size_t pixel = map.grid.index(0, row);
    std::size_t cell =
        map.grid.index(0, image.height - 1 - row);  // pictures begin at the top, grids at the bottom
    for (int column = 0; column < image.width; ++column, ++pixel, ++cell) {
      const bool unknown = alpha_counts && image.alpha[pixel] != kOpaque;
      const Meaning meaning = unknown ? Meaning{} : meanings[image.lightness[pixel]];
      map.grid.cells[cell] = meaning.cell;
      if (keep_probability) map.grid.probability[cell] = meaning.probability;
    }
  }

  warn_of_unknown_gray(yaml, image, literal, meanings, map.warnings);
  if (yaml.mode != MapMode::raw) warn_of_known_gray(yaml, image, meanings, map.warnings);
  if (yaml.mode == MapMode::trinary) warn_of_alpha(yaml, image, map.grid, literal, meanings, map.warnings);
  if (yaml.mode == MapMode::raw && yaml.negate) {
    map.warnings.push_back({MapWarningKind::negate_in_raw_mode, "negate has no effect in raw mode"});
  }
  warn_of_missing_cells(map.grid, map.warnings);
  return map;
}

}  // namespace gridmerge::internal
