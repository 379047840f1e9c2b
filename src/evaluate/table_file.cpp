// SPDX-License-Identifier: Apache-2.0
#include "table_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <system_error>

#include "gridmerge/io/file_error.hpp"

namespace gridmerge {

namespace {

// Bounds what a wrong argument (a device, a disk image) makes us read.
constexpr std::size_t kMaxBytes = std::size_t{16} << 20;

std::string read_text(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw FileError(path, std::generic_category().message(errno));
  std::string text;
  std::array<char, 65536> block{};
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.get())) {
    text.append(block.data(), count);
    if (text.size() > kMaxBytes)
      throw FileError(path, "the file is larger than 16 MiB, which no truth file is");
  }
  if (std::ferror(file.get())) throw FileError(path, std::generic_category().message(errno));
  return text;
}

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

}  // namespace

TableFile::TableFile(const std::filesystem::path& path, const std::vector<std::string_view>& required,
                     const std::vector<std::string_view>& optional)
    : path_(path) {
  const std::string text = read_text(path);
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = std::string_view(text).substr(begin, end - begin);
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

void TableFile::check_header(const Row& header, const std::vector<std::string_view>& required,
                             const std::vector<std::string_view>& optional) {
  for (const std::string_view name : required) {
    if (std::count(header.fields.begin(), header.fields.end(), name) == 0) {
      fail_at_line(header.line, "names no column '" + std::string(name) + "'");
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

bool TableFile::has(std::string_view column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

const std::string& TableFile::text(std::size_t row, std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  const std::string& field = rows_[row].fields.at(static_cast<std::size_t>(found - columns_.begin()));
  if (field.empty()) fail(row, std::string(column) + " is empty");
  return field;
}

double TableFile::number(std::size_t row, std::string_view column) const {
  const std::string& field = text(row, column);
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value)) {
    fail(row, std::string(column) + " is '" + field + "', not a finite number");
  }
  return value;
}

void TableFile::fail(std::size_t row, const std::string& cause) const {
  fail_at_line(rows_[row].line, cause);
}

void TableFile::fail_at_line(std::size_t line, const std::string& cause) const {
  throw FileError(path_.string() + ":" + std::to_string(line), cause);
}

}  // namespace gridmerge
