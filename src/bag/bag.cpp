// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/bag/bag.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "bag/bag_content.hpp"
#include "bag/byte_source.hpp"
#include "bag/map_messages.hpp"
#include "bag/mcap.hpp"
#include "bag/metadata.hpp"
#include "bag/sqlite_bag.hpp"
#include "bag/unpacked_file.hpp"
#include "io/blaming.hpp"
#include "io/file_reader.hpp"

namespace gridmerge {

using namespace internal;

FileKind internal::kind_of(std::string_view first_bytes) {
  if (looks_like_mcap(first_bytes)) return FileKind::mcap;
  if (looks_like_sqlite(first_bytes)) return FileKind::sqlite;
  if (looks_like_zstd(first_bytes)) return FileKind::zstd;
  return first_bytes.starts_with("#ROSBAG V") ? FileKind::ros1_bag : FileKind::other;
}

std::string internal::unpacked_message(std::string message, std::size_t max_bytes) {
  if (!looks_like_zstd(message)) return message;  // CDR begins with a zero
  const auto source = unpack_zstd(text_source(message));
  return read_all(*source, max_bytes);
}

std::vector<std::filesystem::path> internal::bag_files(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return {path};
  constexpr std::size_t kMaxMetadataBytes = std::size_t{1} << 24;
  std::vector<std::filesystem::path> files{path / kMetadataName};
  FileReader reader(files.front(), NamedBy::file);
  const std::vector<std::string> names =
      blaming(files.front(), [&] { return parse_metadata(reader.read_all(kMaxMetadataBytes)); });
  for (const std::string& name : names) files.push_back(path / name);
  return files;
}

BagContent::BagContent(const std::filesystem::path& path, const LoadOptions& options)
    : path_(path), max_cells_(options.max_cells), files_(bag_files(path)) {
  for (const std::filesystem::path& file : files_) {
    if (files_.size() == 1 || file.filename() != kMetadataName) open(file);
  }
  collect_topics();
}

void BagContent::open(const std::filesystem::path& file) {
  const auto kind = [](const std::filesystem::path& one) {
    return kind_of(RandomAccessFile(one).read(0, kBagTellingBytes));
  };
  const std::size_t most = max_cells_ + kMaxMessageRest;
  std::filesystem::path opened = file;
  FileKind found = kind(file);
  std::optional<UnpackedFile> unpacked;  // a storage keeps it open when its name is gone
  if (found == FileKind::zstd) {
    unpacked.emplace(file);
    opened = unpacked->path();
    found = kind(opened);
  }
  switch (found) {
    case FileKind::mcap:
      storages_.push_back(std::make_unique<McapFile>(opened, file, most));
      break;
    case FileKind::sqlite:
      storages_.push_back(std::make_unique<SqliteBag>(opened, file, most));
      break;
    case FileKind::ros1_bag:
      throw FileError(file,
                      "is a bag of ROS 1, which gridmerge's Python package reads (pip install "
                      "'gridmerge[rosbags]'); rosbags-convert makes a bag of ROS 2 of it");
    case FileKind::zstd:
    case FileKind::other:
      throw FileError(file, "is no bag of ROS 2: neither MCAP nor SQLite");
  }
  storage_paths_.push_back(file);
}

void BagContent::collect_topics() {
  std::map<std::pair<std::string, std::string>, BagTopic> all;
  for (const auto& storage : storages_) {
    for (const BagTopic& topic : storage->topics()) {
      const auto [place, is_new] = all.emplace(std::pair(topic.name, topic.type), topic);
      if (!is_new) place->second.messages += topic.messages;
    }
  }
  for (auto& [key, topic] : all) topics_.push_back(std::move(topic));
}

std::vector<MapWarning> BagContent::warnings() const {
  std::vector<MapWarning> warnings;
  for (const auto& storage : storages_) std::ranges::move(storage->warnings(), std::back_inserter(warnings));
  return warnings;
}

std::vector<BagContent::Message> BagContent::find(const std::vector<BagTopic>& topics) {
  std::vector<Message> messages;
  for (std::size_t file = 0; file < storages_.size(); ++file) {
    for (const StoredMessage& stored : storages_[file]->find(topics)) messages.push_back({file, stored});
  }
  std::ranges::stable_sort(messages, {}, [](const Message& message) { return message.stored.time; });
  std::vector<std::vector<StoredMessage>> orders(storages_.size());
  for (const Message& message : messages) orders[message.file].push_back(message.stored);
  for (std::size_t file = 0; file < storages_.size(); ++file) storages_[file]->expect(orders[file]);
  return messages;
}

std::string BagContent::read(const Message& message) {
  std::string bytes = storages_[message.file]->read(message.stored);
  return blaming(storage_paths_[message.file],
                 [&] { return unpacked_message(std::move(bytes), max_cells_ + kMaxMessageRest); });
}

Bag::Bag(const std::filesystem::path& path, const LoadOptions& options)
    : content_(std::make_shared<BagContent>(path, options)) {}

Bag::~Bag() = default;
Bag::Bag(const Bag&) = default;
Bag& Bag::operator=(const Bag&) = default;

const std::vector<BagTopic>& Bag::topics() const {
  return content_->topics();
}

std::vector<BagTopic> Bag::map_topics() const {
  std::vector<BagTopic> maps;
  std::ranges::copy_if(topics(), std::back_inserter(maps),
                       [](const BagTopic& topic) { return is_map_type(topic.type) && topic.messages > 0; });
  return maps;
}

const std::filesystem::path& Bag::path() const {
  return content_->path();
}

const std::vector<std::filesystem::path>& Bag::files() const {
  return content_->files();
}

}  // namespace gridmerge
