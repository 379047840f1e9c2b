// SPDX-License-Identifier: Apache-2.0
#include "io/text_table.hpp"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "gridmerge/io/file_error.hpp"
#include "io/number.hpp"

namespace gridmerge::internal {

namespace {

std::vector<std::string> split_at_tabs(std::string_view line) {
  std::vector<std::string> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(line.find('\t', begin), line.size());
    fields.emplace_back(line.substr(begin, end - begin));
    if (end == line.size()) return fields;
    begin = end + 1;
  }
}

bool contains(const std::vector<std::string_view>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Without the spaces that spreadsheets put around numbers.
std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

}  // namespace

TextTable::TextTable(std::filesystem::path path, std::string_view text,
                     const std::vector<std::string_view>& required,
                     const std::vector<std::string_view>& optional)
    : path_(std::move(path)) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty()) continue;
    Row row{number, split_at_tabs(line)};
    if (columns_.empty()) {
      check_header(row, required, optional);
      columns_ = std::move(row.fields);
      continue;
    }
    if (row.fields.size() != columns_.size()) {
      fail_at_line(number, "has " + std::to_string(row.fields.size()) +
                               " fields where the first line names " + std::to_string(columns_.size()) +
                               " columns");
    }
    rows_.push_back(std::move(row));
  }
  if (columns_.empty()) throw FileError(path_, "the file is empty; its first line should name the columns");
}

void TextTable::check_header(const Row& header, const std::vector<std::string_view>& required,
                             const std::vector<std::string_view>& optional) {
  for (const std::string_view name : required) {
    if (std::count(header.fields.begin(), header.fields.end(), name) == 0) {
      const bool has_spaces = header.fields.size() == 1 && header.fields[0].find(' ') != std::string::npos;
      fail_at_line(header.line, "names no column '" + std::string(name) + "'" +
                                    (has_spaces ? ": tabs separate columns, not spaces" : ""));
    }
  }
  for (const std::string& name : header.fields) {
    if (!contains(required, name) && !contains(optional, name)) {
      fail_at_line(header.line, "names a column '" + name + "' that is not known here");
    }
    if (std::count(header.fields.begin(), header.fields.end(), name) > 1) {
      fail_at_line(header.line, "names the column '" + name + "' twice");
    }
  }
}

bool TextTable::has(std::string_view column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

const std::string& TextTable::text(std::size_t row, std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  const std::string& field = rows_[row].fields.at(static_cast<std::size_t>(found - columns_.begin()));
  if (field.empty()) fail(row, std::string(column) + " is empty");
  return field;
}

double TextTable::number(std::size_t row, std::string_view column) const {
  const std::string& field = text(row, column);
  const std::optional<double> value = parse_number(trimmed(field));
  if (!value) fail(row, std::string(column) + " is '" + field + "', not a finite number");
  return *value;
}

std::string TextTable::place(std::size_t row) const {
  return path_.string() + ":" + std::to_string(rows_[row].line);
}

void TextTable::fail(std::size_t row, const std::string& cause) const {
  fail_at_line(rows_[row].line, cause);
}

void TextTable::fail_at_line(std::size_t line, const std::string& cause) const {
  throw FileError(path_.string() + ":" + std::to_string(line), cause);
}

}  // namespace gridmerge::internal
