// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/stat.h>

#include <cstdint>
#include <optional>
#include <system_error>
#include <utility>

#include "bag/bag_content.hpp"
#include "bag/metadata.hpp"
#include "bag/random_access_file.hpp"
#include "gridmerge/bag/bag.hpp"

namespace gridmerge {

using namespace internal;

namespace {

bool is_there(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) && !error;
}

// Of what is not a regular file nothing is read: a pipe gives its bytes once.
FileKind kind_of_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return FileKind::other;
  try {
    return kind_of(RandomAccessFile(path).read(0, kBagTellingBytes));
  } catch (const FileError&) {
    return FileKind::other;  // whoever reads it says why it cannot be read
  }
}

}  // namespace

MapName parse_map_name(const std::filesystem::path& name) {
  const std::string& text = name.native();
  const std::size_t mark = text.rfind('#');
  if (mark == std::string::npos || mark == 0 || mark + 1 == text.size() || is_there(name)) return {name, {}};
  const std::filesystem::path file = text.substr(0, mark);
  // A topic's name begins with a slash, also where no file is there to tell.
  if (text[mark + 1] != '/' && !is_there(file)) return {name, {}};
  return {file, text.substr(mark + 1)};
}

std::filesystem::path format_map_name(const MapName& name) {
  return name.topic.empty() ? name.file : std::filesystem::path(name.file.native() + "#" + name.topic);
}

std::optional<MapIdentity> map_identity(const std::filesystem::path& name) {
  const MapName map = parse_map_name(name);
  struct ::stat status {};
  if (::stat(map.file.c_str(), &status) != 0) return std::nullopt;
  return MapIdentity{static_cast<std::uint64_t>(status.st_dev), static_cast<std::uint64_t>(status.st_ino),
                     map.topic.starts_with('/') ? map.topic.substr(1) : map.topic};
}

bool is_same_map(const std::filesystem::path& a, const std::filesystem::path& b) {
  const std::optional<MapIdentity> one = map_identity(a);
  return one && one == map_identity(b);
}

bool is_bag(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return is_there(path / kMetadataName);
  const FileKind kind = kind_of_file(path);
  return kind != FileKind::other && kind != FileKind::ros1_bag;
}

LoadedMap load_any_map(const std::filesystem::path& name, const LoadOptions& options) {
  if (name.empty()) throw FileError(name, "is no name of a map: it is empty");
  const auto [file, topic] = parse_map_name(name);
  if (is_bag(file) || kind_of_file(file) == FileKind::ros1_bag) {
    const Bag bag(file, options);
    BagMap map = BagMaps(bag, topic).last();
    return {std::move(map.grid), std::move(map.warnings), bag.files()};
  }
  if (!topic.empty() && is_there(file))
    throw FileError(file, fmt::format("is no bag, and so has no topic '{}'", topic));
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw FileError(file, fmt::format("is a directory without a {}, and so no rosbag2 bag", kMetadataName));
  return load_map(file, options);
}

std::vector<std::filesystem::path> any_map_files(const std::filesystem::path& name,
                                                 const LoadOptions& options) {
  const MapName parts = parse_map_name(name);
  return is_bag(parts.file) ? bag_files(parts.file) : map_files(parts.file, options);
}

}  // namespace gridmerge
