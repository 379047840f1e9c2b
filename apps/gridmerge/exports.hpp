// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/report/merge_output.hpp"

namespace gridmerge::cli {

/// What is written of a merge for other programs.
struct ExportOptions {
  std::vector<std::string> wanted;  // FORMAT or FORMAT=FILE
};

/// A file to write.
struct Export {
  ExportFormat format;
  std::filesystem::path file;
};

/// --export. A format that there is not is a mistake in the command line.
void add_export_option(CLI::App& command, ExportOptions& options);

/// The files, those without a name in `directory`.
std::vector<Export> exports_of(const ExportOptions& options, const std::string& directory);

/// Throws FileError if two results would go to one file, by whichever folder's links. `writers` says whose
/// they are: "two exports".
void require_two_files(const std::filesystem::path& a, const std::filesystem::path& b,
                       std::string_view writers);

/// The same of a file and all that exports may write.
void require_not_exported(const std::vector<Export>& exports, const std::filesystem::path& file,
                          std::string_view writers);

/// Makes sure, before long work, that a file can be written in or beside `directory`, which need not be there
/// yet. Throws FileError, also for a name that a merge itself gives to a file there, or one of `inputs` has.
void try_result_file(const std::filesystem::path& file, const std::string& directory,
                     const std::vector<std::filesystem::path>& inputs);

/// The same of all that is to be exported, and no two to one file.
void try_exports(const std::vector<Export>& exports, const std::string& directory,
                 const std::vector<std::filesystem::path>& inputs);

/// Writes all of them by so many threads, and returns what to tell of it: a line for each file. Throws
/// FileError.
std::string write_exports(const std::vector<Export>& exports,
                          const std::vector<std::filesystem::path>& inputs, const NamedMerge& merge,
                          int threads);

}  // namespace gridmerge::cli
