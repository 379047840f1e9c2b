// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "gridmerge/grid/execution.hpp"
#include "io/atomic_file.hpp"
#include "io/directory_names.hpp"
#include "io/file_set.hpp"
#include "merge/fused_windows.hpp"
#include "merge/joins.hpp"
#include "report/earlier_merge.hpp"
#include "report/fused_places.hpp"
#include "report/interchange.hpp"
#include "report/output_names.hpp"
#include "report/tiff_pyramid.hpp"

namespace gridmerge::internal {

namespace fs = std::filesystem;

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

namespace {

using StagedFiles = std::vector<std::unique_ptr<StagedFile>>;

/// By what a file of further merged maps says of itself: that of another export has a number of its own.
std::string further_map(std::size_t number) {
  return fmt::format("merged map no. {}, of ", number);
}

std::string description_of(std::size_t component, std::size_t maps) {
  return fmt::format("{}{}{}{} where nothing is known",
                     component == 0 ? "merged map of " : further_map(component + 1), maps, kGeoTiffMark,
                     TiffPyramid::kUnknown);
}

/// The files of an earlier export to `file` that had more merged maps.
std::vector<fs::path> files_beyond(const fs::path& file, std::size_t components) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const std::string& name : names_in(file.parent_path(), error)) {
    const std::optional<std::size_t> number = number_in(name, file.filename());
    if (!number || *number <= components) continue;
    const fs::path path = file.parent_path() / name;
    if (fs::is_regular_file(fs::symlink_status(path, error)) && holds(path, further_map(*number)))
      files.push_back(path);
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// By which a folder is the same, whichever way it is named.
fs::path folder_of(const fs::path& file) {
  const fs::path folder = file.parent_path().empty() ? fs::path(".") : file.parent_path();
  std::error_code error;
  fs::path canonical = fs::canonical(folder, error);
  if (error) throw FileError(file, "cannot be written: " + error.message());
  return canonical;
}

/// In one step what is in one folder: links may lead to others.
void commit(const StagedFiles& staged, const std::vector<fs::path>& removed) {
  if (staged.size() == 1 && removed.empty()) return staged.front()->commit();
  std::map<fs::path, FileSet> sets;
  const auto set_of = [&](const fs::path& file) -> FileSet& {
    return sets.try_emplace(folder_of(file), file.parent_path()).first->second;
  };
  for (const auto& one : staged) set_of(one->path()).add(*one);
  for (const fs::path& file : removed) set_of(file).remove(file.filename().string());
  for (auto& [folder, set] : sets) set.commit();
}

}  // namespace

ExportedFiles write_geotiff(const fs::path& file, const std::vector<fs::path>& inputs,
                            const NamedMerge& merge) {
  const std::vector<Component>& components = merge.result.components;
  ExportedFiles files;
  for (std::size_t i = 0; i < components.size(); ++i) {
    files.written.push_back(numbered(file, i));
    protect_inputs(files.written.back(), inputs);
  }
  StagedFiles staged;
  for (std::size_t i = 0; i < components.size(); ++i) {
    staged.push_back(std::make_unique<StagedFile>(files.written[i]));
    const FusedWindows windows = windows_of(merge, i);
    const Lattice& lattice = windows.lattice();
    TiffPyramid picture(staged.back()->path(), lattice.width, lattice.height);
    draw(windows, picture);
    const std::string owner = plain(frame_owner(merge, components[i]));
    picture.write(*staged.back(), {{lattice.corner.x, lattice.corner.y + lattice.height * lattice.resolution},
                                   lattice.resolution,
                                   "frame of " + owner,
                                   description_of(i, components[i].members.size())});
  }
  files.removed = files_beyond(file, components.size());
  for (const fs::path& one : files.removed) protect_inputs(one, inputs);
  commit(staged, files.removed);
  return files;
}

}  // namespace gridmerge::internal
