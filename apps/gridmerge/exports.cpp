// SPDX-License-Identifier: Apache-2.0
#include "exports.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <system_error>

#include "console.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/report/merge_output.hpp"
#include "io/destination.hpp"
#include "report/interchange.hpp"
#include "report/output_names.hpp"

namespace gridmerge::cli {

namespace {

std::string formats_text() {
  std::string text;
  for (const ExportFormat format : export_formats())
    text += (text.empty() ? "" : ", ") + std::string(name_of(format));
  return text;
}

struct Wanted {
  std::string_view format;
  std::optional<std::string_view> file;
};

Wanted split(std::string_view text) {
  const std::size_t at = text.find('=');
  if (at == std::string_view::npos) return {text, std::nullopt};
  return {text.substr(0, at), text.substr(at + 1)};
}

std::string what_is_wrong(const std::string& text) {
  const Wanted wanted = split(text);
  if (!export_format(wanted.format))
    return fmt::format("'{}' is no format: there are {}", escape_controls(wanted.format), formats_text());
  if (wanted.file && wanted.file->empty()) return fmt::format("'{}' names no file", escape_controls(text));
  return {};
}

/// The file, whichever links its folder is named by.
std::filesystem::path normal(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::absolute(file).lexically_normal();
  const std::filesystem::path folder = std::filesystem::weakly_canonical(path.parent_path(), error);
  return error ? path : folder / path.filename();
}

/// A folder, "" for the current one.
std::filesystem::path normal_folder(const std::filesystem::path& folder) {
  return normal((folder.empty() ? "." : folder) / "-").parent_path();
}

}  // namespace

void add_export_option(CLI::App& command, ExportOptions& options) {
  command
      .add_option(
          "--export", options.wanted,
          "Also write the merge for other programs: g2o is a pose graph, open-rmf has points "
          "for fleet adapters, geojson has outlines, geotiff is the merged map in the cells of its finest "
          "map, of any size. If not named, the file is merged.g2o, open_rmf.yaml, merged.geojson or "
          "merged.tif in "
          "DIR. Repeat the option for others")
      ->option_text("FORMAT[=FILE]")
      ->check(CLI::Validator([](std::string& text) { return what_is_wrong(text); }, ""));
}

std::vector<Export> exports_of(const ExportOptions& options, const std::string& directory) {
  std::vector<Export> exports;
  for (const std::string& text : options.wanted) {
    const Wanted wanted = split(text);
    const ExportFormat format = *export_format(wanted.format);
    exports.push_back({format, wanted.file ? std::filesystem::path(*wanted.file)
                                           : std::filesystem::path(directory) / export_file(format)});
  }
  return exports;
}

namespace {

/// Whether an export may write this file too, beside the one that it is told.
bool may_write(const Export& one, const std::filesystem::path& file) {
  const std::filesystem::path a = normal(one.file), b = normal(file);
  return one.format == ExportFormat::geotiff && a.parent_path() == b.parent_path() &&
         internal::is_numbered(b.filename(), a.filename());
}

}  // namespace

void require_two_files(const std::filesystem::path& a, const std::filesystem::path& b,
                       std::string_view writers) {
  if (normal(a) == normal(b))
    throw FileError(a, fmt::format("would be written by {}: choose another name for one", writers));
}

void try_result_file(const std::filesystem::path& file, const std::string& directory,
                     const std::vector<std::filesystem::path>& inputs) {
  if (normal(file) == normal_folder(directory))
    throw FileError(file, "is the folder of the results: choose another name");
  internal::check_destination(file);  // also where its folder is still to be made
  const bool beside = normal_folder(file.parent_path()) == normal_folder(directory);
  if (beside && internal::is_merge_output(file.filename()))
    throw FileError(file, "is a file that the merge itself writes: choose another name");
  if (!beside || std::filesystem::exists(directory)) try_output_file(file.string(), inputs);
}

void require_not_exported(const std::vector<Export>& exports, const std::filesystem::path& file,
                          std::string_view writers) {
  for (const Export& one : exports) {
    require_two_files(file, one.file, writers);
    if (may_write(one, file))
      throw FileError(
          file, fmt::format("may be written by {}, as a GeoTIFF of a further merged map: choose another "
                            "name for one",
                            writers));
  }
}

void try_exports(const std::vector<Export>& exports, const std::string& directory,
                 const std::vector<std::filesystem::path>& inputs) {
  for (std::size_t i = 0; i < exports.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      require_not_exported({exports[j]}, exports[i].file, "two exports");
      require_not_exported({exports[i]}, exports[j].file, "two exports");
    }
    for (const std::filesystem::path& input : inputs) {
      if (may_write(exports[i], input))
        throw FileError(input,
                        "is an input and might be replaced by a GeoTIFF of a further merged map: choose "
                        "another name for that");
    }
    try_result_file(exports[i].file, directory, inputs);
  }
}

std::string write_exports(const std::vector<Export>& exports,
                          const std::vector<std::filesystem::path>& inputs, const NamedMerge& merge,
                          int threads) {
  std::string text;
  with_threads(threads, [&] {
    for (const Export& one : exports) {
      const internal::ExportedFiles files = internal::write_export_files(one.format, one.file, inputs, merge);
      for (const std::filesystem::path& file : files.written)
        text += fmt::format("{}: {}\n", name_of(one.format), escape_controls(file.string()));
      text += describe_removed(files.removed, "merge");
    }
  });
  return text;
}

}  // namespace gridmerge::cli
