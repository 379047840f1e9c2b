// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bag/bag_storage.hpp"
#include "gridmerge/bag/bag.hpp"

namespace gridmerge::internal {

/// What a file is, by its first bytes.
enum class FileKind { mcap, sqlite, zstd, ros1_bag, other };

/// So many first bytes tell it.
inline constexpr std::size_t kBagTellingBytes = 16;

/// Tells the kind of a file that begins so.
FileKind kind_of(std::string_view first_bytes);

/// The files of a bag: those that a folder's metadata names, behind the metadata itself, or the one file.
/// Only the metadata is opened. Throws FileError.
std::vector<std::filesystem::path> bag_files(const std::filesystem::path& path);

/// The files of a bag as one: topics by name and type, messages in order of time.
class BagContent {
 public:
  /// As Bag.
  BagContent(const std::filesystem::path& path, const LoadOptions& options);

  const std::filesystem::path& path() const { return path_; }
  const std::vector<std::filesystem::path>& files() const { return files_; }
  const std::vector<BagTopic>& topics() const { return topics_; }
  std::size_t max_cells() const { return max_cells_; }

  /// What is odd about the files.
  std::vector<MapWarning> warnings() const;

  /// A message, and which of the files has it.
  struct Message {
    std::size_t file = 0;
    StoredMessage stored;
  };

  /// The messages of these topics, the earliest first; of those of one time, as the files have them.
  std::vector<Message> find(const std::vector<BagTopic>& topics);

  /// The bytes of a message, unpacked. Throws FileError.
  std::string read(const Message& message);

 private:
  void open(const std::filesystem::path& file);
  void collect_topics();

  std::filesystem::path path_;
  std::size_t max_cells_;
  std::vector<std::filesystem::path> files_;
  std::vector<std::unique_ptr<BagStorage>> storages_;
  std::vector<std::filesystem::path> storage_paths_;  ///< for messages
  std::vector<BagTopic> topics_;
};

}  // namespace gridmerge::internal
