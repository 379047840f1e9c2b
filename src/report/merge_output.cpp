// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/report/merge_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "grid/parallel.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/resample.hpp"
#include "gridmerge/io/map_file.hpp"
#include "gridmerge/report/merge_record.hpp"
#include "io/add_map.hpp"
#include "io/destination.hpp"
#include "io/directory_names.hpp"
#include "io/file_set.hpp"
#include "merge/joins.hpp"
#include "report/earlier_merge.hpp"
#include "report/output_names.hpp"
#include "report/page.hpp"
#include "report/record_file.hpp"

namespace gridmerge {

using namespace internal;

namespace {

namespace fs = std::filesystem;

constexpr const char* kPreview = "preview.png";
constexpr const char* kReport = "report.html";

// merged.yaml, merged_2.yaml, and so on, and the same as .pgm.
bool is_merged_map(const fs::path& file) {
  return is_numbered(file, "merged.yaml") || is_numbered(file, "merged.pgm");
}

}  // namespace

bool internal::is_merge_output(const fs::path& name) {
  return is_merged_map(name) || name == kPreview || name == kReport || name == kTransforms;
}

fs::path internal::numbered(const fs::path& file, std::size_t component) {
  if (component == 0) return file;
  return file.parent_path() /
         fmt::format("{}_{}{}", file.stem().string(), component + 1, file.extension().string());
}

std::optional<std::size_t> internal::number_in(const fs::path& name, const fs::path& file) {
  if (name == file) return 1;
  if (name.extension() != file.extension()) return std::nullopt;
  constexpr std::size_t kMostDigits = 6;  // what is longer is a date
  const std::string stem = name.stem().string(), first = file.stem().string() + "_";
  if (!stem.starts_with(first)) return std::nullopt;
  const std::string_view digits = std::string_view(stem).substr(first.size());
  if (digits.empty() || digits.size() > kMostDigits || digits == "1" || digits.front() == '0' ||
      digits.find_first_not_of("0123456789") != std::string_view::npos)
    return std::nullopt;
  std::size_t number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return number;
}

bool internal::is_numbered(const fs::path& name, const fs::path& file) {
  return number_in(name, file).has_value();
}

namespace {

bool is_export(const fs::path& name) {
  const auto formats = export_formats();
  return is_numbered(name, export_file(ExportFormat::geotiff)) ||
         std::any_of(formats.begin(), formats.end(),
                     [&](ExportFormat format) { return name == export_file(format); });
}

// The files in the directory whose names are those of a merge's outputs, exports among them.
std::vector<fs::path> outputs_in(const fs::path& directory) {
  std::vector<fs::path> outputs;
  std::error_code error;
  for (const std::string& name : names_in(directory, error)) {
    if (is_merge_output(name) || is_export(name)) outputs.push_back(directory / name);
  }
  if (error && error != std::errc::no_such_file_or_directory)  // then there are none
    throw FileError(directory, "cannot be read: " + error.message());
  return outputs;
}

// Maps and exports of an earlier merge that this one has none for. Who asks for an export writes it later.
std::vector<fs::path> remove_stale(FileSet& files, const fs::path& directory, std::size_t components) {
  std::set<fs::path> current;
  for (std::size_t i = 0; i < components; ++i) {
    const fs::path yaml = component_file(i);
    current.insert(yaml);
    current.insert(fs::path(yaml).replace_extension(".pgm"));
  }
  std::vector<fs::path> removed;
  for (const std::string& name : earlier_outputs(directory)) {
    if (current.contains(name)) continue;
    files.remove(name);
    removed.push_back(directory / name);
  }
  return removed;
}

// No file that a map was read from may bear the name of an output, whichever way it was named itself.
void protect(const std::vector<fs::path>& inputs, const fs::path& directory) {
  for (const fs::path& output : outputs_in(directory)) {
    for (const fs::path& input : inputs) {
      std::error_code absent;
      if (fs::equivalent(output, input, absent)) {
        throw FileError(input,
                        "is an input and would be replaced or removed: choose another output directory");
      }
    }
  }
}

}  // namespace

std::optional<double> check_merged_size(const std::vector<std::string>& names,
                                        const std::vector<OccupancyGrid>& maps, double resolution) {
  if (names.size() < maps.size()) throw std::out_of_range("there are fewer names than maps");
  validate_merged_resolution(resolution);
  if (maps.empty()) return std::nullopt;
  double diagonals = 0.0;
  for (const OccupancyGrid& map : maps) {
    diagonals += std::hypot(map.width, map.height) * map.resolution;
  }
  const bool is_asked_for =
      resolution != 0.0;  // otherwise the merged map is drawn coarser where it has to be
  // With room to spare, in two digits.
  const auto fitting = [&](double cells) {
    const double least = resolution * std::sqrt(2.0 * cells / kMaxGridCells);
    const double digit = std::pow(10.0, std::floor(std::log10(least)) - 1.0);
    return std::ceil(least / digit) * digit;
  };
  double cells = 0.0;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const OccupancyGrid& map = maps[i];
    if (std::max(std::abs(map.origin.x), std::abs(map.origin.y)) + diagonals > kMaxOrigin)
      throw FileError(
          names[i],
          fmt::format("lies too far from zero: with the other maps it may reach beyond {} m", kMaxOrigin));
    if (!is_asked_for) continue;
    const double ratio = map.resolution / resolution;
    double own = static_cast<double>(map.cells.size()) * ratio * ratio;
    if (own > kMaxGridCells && count_cells(map).known() > 0)
      own = static_cast<double>(crop_to_known(map).cells.size()) * ratio * ratio;
    if (own > kMaxGridCells)
      throw FileError(names[i],
                      fmt::format("alone has {:.3g} cells of {:.4g} m, and a merged map may have 2^28: "
                                  "choose an output resolution of {:.2g} m (--output-resolution)",
                                  own, resolution, fitting(own)));
    cells += own;
  }
  return cells > kMaxGridCells ? std::optional(fitting(cells)) : std::nullopt;
}

void prepare_merge_output(const fs::path& directory, const std::vector<fs::path>& inputs) {
  check_directory(directory);
  protect(inputs, directory);
  for (const char* const name : {"merged.yaml", "merged.pgm", kPreview, kReport, kTransforms})
    check_destination(directory / name);
}

std::vector<fs::path> write_merge_output(const fs::path& directory, const std::vector<fs::path>& inputs,
                                         const NamedMerge& merge) {
  FileSet files(directory, FileSet::IfMissing::make);
  protect(inputs, directory);
  const std::vector<Component>& components = merge.result.components;
  for (std::size_t i = 0; i < components.size(); ++i)
    add_map(files, components[i].fused.grid, component_file(i));
  std::string preview, report;
  parallel_for(2, [&](std::size_t i) {
    if (i == 0) {
      preview = preview_png(merge);
    } else {
      report = report_page(merge);
    }
  });
  files.add(kPreview, preview);
  files.add(kReport, report);
  files.add(kTransforms, transforms_json(merge.names, merge.result));
  std::vector<fs::path> removed = remove_stale(files, directory, components.size());
  files.commit();
  return removed;
}

void write_report(const fs::path& directory, const std::vector<fs::path>& inputs, const NamedMerge& merge,
                  std::optional<std::uint64_t> fingerprint) {
  FileSet files(directory);
  // From here on no other merge writes there.
  if (fingerprint && *fingerprint != read_fingerprint(directory))
    throw FileError(directory / kTransforms,
                    "has changed since it was read: another merge wrote there, so make the report again");
  protect(inputs, directory);
  files.add(kReport, report_page(merge));
  files.commit();
}

}  // namespace gridmerge
