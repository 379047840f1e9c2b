// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "internal_export.hpp"

namespace gridmerge::internal {

/// A tab-separated text file whose first line names the columns. Knows files, lines and columns, not their
/// meaning. Every failure is a FileError that says "file:line: cause".
class GRIDMERGE_INTERNAL_EXPORT TextTable {
 public:
  /// Checks the shape of the file's text: every required column once, no column that is neither required nor
  /// optional, and as many fields in every line as there are columns.
  TextTable(std::filesystem::path path, std::string_view text, const std::vector<std::string_view>& required,
            const std::vector<std::string_view>& optional = {});

  std::size_t rows() const { return rows_.size(); }
  bool has(std::string_view column) const;
  /// The field, which must not be empty.
  const std::string& text(std::size_t row, std::string_view column) const;
  /// The field as a finite number.
  double number(std::size_t row, std::string_view column) const;
  /// "file:line".
  std::string place(std::size_t row) const;
  [[noreturn]] void fail(std::size_t row, const std::string& cause) const;

 private:
  struct Row {
    std::size_t line;  ///< in the file, from 1
    std::vector<std::string> fields;
  };

  void check_header(const Row& header, const std::vector<std::string_view>& required,
                    const std::vector<std::string_view>& optional);
  [[noreturn]] void fail_at_line(std::size_t line, const std::string& cause) const;

  std::filesystem::path path_;
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

}  // namespace gridmerge::internal
