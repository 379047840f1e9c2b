// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bag/bag_storage.hpp"
#include "bag/byte_source.hpp"
#include "bag/mcap_records.hpp"
#include "bag/random_access_file.hpp"
#include "bag/scattered_chunks.hpp"

namespace gridmerge::internal {

/// Whether a file's first bytes are those of an MCAP file.
bool looks_like_mcap(std::string_view bytes);

/// An MCAP file, with chunks or without, with a summary or without. Of a file that ends within a record, as
/// that of a recorder that was killed does, what is whole is read, with a warning.
///
/// The checksums of chunks and of the summary are checked, that of the whole data section is not. A chunk is
/// unpacked in a stream, whatever it claims to hold.
class McapFile : public BagStorage {
 public:
  /// Messages of more than `max_message_bytes` are refused before memory is taken for them. Errors name the
  /// file `shown`. O(bytes of the summary), without one O(bytes of the file).
  McapFile(const std::filesystem::path& path, const std::filesystem::path& shown,
           std::size_t max_message_bytes);
  ~McapFile() override;

  const std::vector<BagTopic>& topics() const override { return topics_; }
  std::vector<StoredMessage> find(const std::vector<BagTopic>& topics) override;
  void expect(const std::vector<StoredMessage>& order) override;
  std::string read(const StoredMessage& message) override;
  std::vector<MapWarning> warnings() const override;

 private:
  struct Channel {
    McapChannel channel;
    std::uint64_t messages = 0;
  };
  class Chunk;
  using Use = std::function<bool(const RecordHead&, std::uint64_t)>;

  void open();
  bool read_summary(const McapFooter& footer);
  void check_summary(const McapFooter& footer) const;
  void scan();
  void for_each_record(std::uint64_t begin, const Use& use);
  std::string_view content(std::uint64_t offset, const RecordHead& head);
  void learn(McapRecord kind, std::string_view content);
  void make_topics();
  std::string_view type_of(const McapChannel& channel) const;
  std::unique_ptr<Chunk> open_chunk(std::uint64_t offset, std::uint64_t bytes) const;
  std::string unpack(const StoredMessage& message);

  RandomAccessFile file_;
  BufferedReader records_{file_};  ///< heads of records, and what is short
  std::size_t max_message_bytes_;
  std::uint64_t end_ = 0;  ///< of the records before the footer
  bool is_cut_off_ = false;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::size_t name_bytes_ = 0;  ///< of all schemas and channels
  std::vector<BagTopic> topics_;
  std::unique_ptr<Chunk> chunk_;  ///< that was read from last
  std::uint64_t chunk_place_ = 0;
  ScatteredChunks scattered_;
};

}  // namespace gridmerge::internal
