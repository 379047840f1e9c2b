// SPDX-License-Identifier: Apache-2.0
#include "report/interchange.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <system_error>

#include "gridmerge/report/merge_output.hpp"
#include "io/atomic_file.hpp"

namespace gridmerge {

using namespace internal;

namespace {

struct Format {
  ExportFormat format;
  const char* name;
  const char* file;
  std::string (*text)(const NamedMerge&);
};

constexpr std::array<Format, 3> kFormats{{
    {ExportFormat::g2o, "g2o", "merged.g2o", &g2o_text},
    {ExportFormat::open_rmf, "open-rmf", "open_rmf.yaml", &open_rmf_text},
    {ExportFormat::geojson, "geojson", "merged.geojson", &geojson_text},
}};

const Format& of(ExportFormat format) {
  return *std::find_if(kFormats.begin(), kFormats.end(),
                       [format](const Format& one) { return one.format == format; });
}

}  // namespace

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

std::string export_text(ExportFormat format, const NamedMerge& merge) {
  if (merge.result.components.empty())
    throw std::invalid_argument("no two maps were joined, so that no map has a place to tell");
  return of(format).text(merge);
}

void write_export(ExportFormat format, const std::filesystem::path& file,
                  const std::vector<std::filesystem::path>& inputs, const NamedMerge& merge) {
  for (const std::filesystem::path& input : inputs) {
    std::error_code absent;
    if (std::filesystem::equivalent(file, input, absent))
      throw FileError(file, "is an input and would be replaced: choose another file for the export");
  }
  std::string text;
  try {
    text = export_text(format, merge);
  } catch (const std::invalid_argument& error) {
    throw FileError(file, std::string("is not written: ") + error.what());
  }
  write_file_atomically(file, text);
}

}  // namespace gridmerge
