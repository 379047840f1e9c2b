// SPDX-License-Identifier: Apache-2.0
#include "report/interchange.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <system_error>

#include "gridmerge/report/merge_output.hpp"
#include "gridmerge/report/merge_record.hpp"
#include "io/atomic_file.hpp"
#include "report/json_values.hpp"
#include "report/output_names.hpp"

namespace gridmerge {

using namespace internal;

namespace {

struct Format {
  ExportFormat format;
  const char* name;
  const char* file;
  std::string_view mark;
  std::string (*text)(const NamedMerge&);  // null of one that is no text
};

constexpr std::array<Format, 4> kFormats{{
    {ExportFormat::g2o, "g2o", "merged.g2o", kG2oMark, &g2o_text},
    {ExportFormat::open_rmf, "open-rmf", "open_rmf.yaml", kOpenRmfMark, &open_rmf_text},
    {ExportFormat::geojson, "geojson", "merged.geojson", kGeoJsonMark, &geojson_text},
    {ExportFormat::geotiff, "geotiff", "merged.tif", kGeoTiffMark, nullptr},
}};

const Format& of(ExportFormat format) {
  return *std::find_if(kFormats.begin(), kFormats.end(),
                       [format](const Format& one) { return one.format == format; });
}

void check_placed(const NamedMerge& merge) {
  if (merge.result.components.empty())
    throw std::invalid_argument("no two maps were joined, so that no map has a place to tell");
  for (const Component& component : merge.result.components) {
    if (component.members.empty()) throw std::invalid_argument("a component must have members");
    for (const Member& member : component.members) {
      if (member.map >= merge.names.size() || member.map >= merge.maps.size())
        throw std::out_of_range("there are fewer names or maps than the result speaks of");
    }
  }
}

}  // namespace

void internal::protect_inputs(const std::filesystem::path& file,
                              const std::vector<std::filesystem::path>& inputs) {
  for (const std::filesystem::path& input : inputs) {
    std::error_code absent;
    if (std::filesystem::equivalent(file, input, absent))
      throw FileError(file, "is an input and would be replaced: choose another file for the export");
  }
}

std::span<const ExportFormat> export_formats() {
  static const std::vector<ExportFormat> formats = [] {
    std::vector<ExportFormat> all;
    all.reserve(kFormats.size());
    for (const Format& one : kFormats) all.push_back(one.format);
    return all;
  }();
  return formats;
}

const char* name_of(ExportFormat format) {
  return of(format).name;
}

std::optional<ExportFormat> export_format(std::string_view name) {
  const auto found =
      std::find_if(kFormats.begin(), kFormats.end(), [name](const Format& one) { return one.name == name; });
  return found == kFormats.end() ? std::nullopt : std::optional(found->format);
}

const char* export_file(ExportFormat format) {
  return of(format).file;
}

std::string_view internal::export_mark(ExportFormat format) {
  return of(format).mark;
}

bool internal::is_text(ExportFormat format) {
  return of(format).text != nullptr;
}

std::string export_text(ExportFormat format, const NamedMerge& merge) {
  if (!is_text(format))
    throw std::invalid_argument(std::string(of(format).name) + " is no text: write_export() writes it");
  check_placed(merge);
  return of(format).text(merge);
}

internal::ExportedFiles internal::write_export_files(ExportFormat format, const std::filesystem::path& file,
                                                     const std::vector<std::filesystem::path>& inputs,
                                                     const NamedMerge& merge) {
  protect_inputs(file, inputs);
  try {
    check_placed(merge);
    if (!is_text(format)) return write_geotiff(file, inputs, merge);
    write_file_atomically(file, export_text(format, merge));
  } catch (const std::invalid_argument& error) {
    throw FileError(file, std::string("is not written: ") + error.what());
  }
  return {{file}, {}};
}

std::vector<std::filesystem::path> write_export(ExportFormat format, const std::filesystem::path& file,
                                                const std::vector<std::filesystem::path>& inputs,
                                                const NamedMerge& merge) {
  return write_export_files(format, file, inputs, merge).written;
}

std::string internal::frame_owner(const NamedMerge& merge, const Component& component) {
  const std::optional<std::size_t> frame = frame_of(component);
  if (frame) return "the map " + merge.names.at(*frame);
  const std::optional<PlanPlacement>& plan = merge.result.plan;
  return plan ? "the plan " + plan->name + ", in metres of the maps" : "the poses that were given";
}

}  // namespace gridmerge
