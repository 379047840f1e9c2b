// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "gridmerge/grid/execution.hpp"
#include "io/atomic_file.hpp"
#include "merge/fused_windows.hpp"
#include "merge/joins.hpp"
#include "report/fused_places.hpp"
#include "report/interchange.hpp"
#include "report/output_names.hpp"
#include "report/tiff_pyramid.hpp"

namespace gridmerge::internal {

namespace {

/// Fused at once: some tens of megabytes while it is worked on.
constexpr int kWindowColumns = 8192;

/// What GeoTIFF's texts may hold.
std::string plain(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~' || c == '|'; }, '_');
  return text;
}

/// In percent, and on the side of 50 where the cell is.
std::uint8_t percentage(Cell cell, float probability) {
  if (cell == Cell::unknown) return TiffPyramid::kUnknown;
  const auto rounded = static_cast<int>(std::lround(100.0F * probability));
  return static_cast<std::uint8_t>(cell == Cell::occupied ? std::clamp(rounded, 51, 100)
                                                          : std::clamp(rounded, 0, 49));
}

void draw(const FusedWindows& windows, TiffPyramid& picture) {
  const Lattice& lattice = windows.lattice();
  int top = lattice.height;
  while (picture.rows_left() > 0) {
    throw_if_cancelled();
    const int count = picture.rows_left();
    std::vector<std::uint8_t> rows(static_cast<std::size_t>(count) * static_cast<std::size_t>(lattice.width));
    for (int left = 0; left < lattice.width; left += kWindowColumns) {
      const int right = std::min(lattice.width, left + kWindowColumns);
      const OccupancyGrid fused = windows.fused({left, top - count, right, top});
      for (int row = 0; row < count; ++row) {
        std::uint8_t* to = rows.data() + static_cast<std::size_t>(row) * lattice.width + left;
        std::size_t from = fused.index(0, count - 1 - row);  // a picture's first row is its top
        for (int column = left; column < right; ++column, ++from)
          *to++ = percentage(fused.cells[from], fused.probability[from]);
      }
    }
    picture.add_rows(rows);
    top -= count;
  }
}

}  // namespace

FusedWindows windows_of(const NamedMerge& merge, std::size_t component) {
  std::vector<const OccupancyGrid*> grids;
  for (const OccupancyGrid& map : merge.maps) grids.push_back(&map);
  PlacedMembers placed = placed_members(merge.result.components[component].members,
                                        fused_places(merge.result, component, merge.maps), grids);
  const double resolution = finest_resolution(placed.maps);
  return FusedWindows(std::move(placed.maps), resolution, std::move(placed.deformations));
}

std::vector<std::filesystem::path> write_geotiff(const std::filesystem::path& file, const NamedMerge& merge) {
  const std::vector<Component>& components = merge.result.components;
  std::vector<std::filesystem::path> files;
  std::vector<std::unique_ptr<StagedFile>> staged;
  for (std::size_t i = 0; i < components.size(); ++i) {
    files.push_back(numbered(file, i));
    staged.push_back(std::make_unique<StagedFile>(files.back()));
    const FusedWindows windows = windows_of(merge, i);
    const Lattice& lattice = windows.lattice();
    TiffPyramid picture(staged.back()->path(), lattice.width, lattice.height);
    draw(windows, picture);
    const std::string owner = plain(frame_owner(merge, components[i]));
    picture.write(*staged.back(),
                  {{lattice.corner.x, lattice.corner.y + lattice.height * lattice.resolution},
                   lattice.resolution,
                   "frame of " + owner,
                   fmt::format("merged map of {}{}{} where nothing is known", components[i].members.size(),
                               kGeoTiffMark, TiffPyramid::kUnknown)});
  }
  for (const auto& one : staged) one->commit();
  return files;
}

}  // namespace gridmerge::internal
