// SPDX-License-Identifier: Apache-2.0
// The records of an MCAP file (https://mcap.dev/spec, version 0), each from its content.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace gridmerge::internal {

/// What stands before and behind the records of a file.
inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

/// Kinds of records that matter here. All others are passed over.
enum class McapRecord : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  statistics = 0x0b,
  data_end = 0x0f,
};

/// A record begins with its kind and the length of its content.
inline constexpr std::size_t kRecordHeadBytes = 9;
/// A message's content begins with so many bytes that are not the message's.
inline constexpr std::size_t kMessageHeadBytes = 22;
/// A footer's content.
inline constexpr std::size_t kFooterBytes = 20;

/// The first bytes of a record.
struct RecordHead {
  McapRecord kind{};
  std::uint64_t bytes = 0;  ///< of its content
};

/// A type of messages.
struct McapSchema {
  std::uint16_t id = 0;
  std::string name;
};

/// A topic, as one of its publishers had it.
struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;  ///< 0 = it has none
  std::string topic;
  std::string encoding;
};

/// What stands before a message's bytes.
struct McapMessageHead {
  std::uint16_t channel = 0;
  std::int64_t time = 0;  ///< when it was recorded [ns]
};

/// What stands before a chunk's records.
struct McapChunkHead {
  std::uint64_t unpacked_bytes = 0;
  std::uint32_t crc = 0;  ///< of the unpacked records; 0 = not given
  std::string compression;
  std::uint64_t packed_bytes = 0;
  std::size_t head_bytes = 0;  ///< of the chunk's content before the packed records
};

/// Counts of a whole file.
struct McapStatistics {
  std::uint64_t messages = 0;
  std::uint32_t channels = 0;
  std::map<std::uint16_t, std::uint64_t> channel_messages;
};

/// Where a file's summary is.
struct McapFooter {
  std::uint64_t summary_begin = 0;  ///< 0 = it has none
  std::uint32_t crc = 0;            ///< of the summary and the footer up to here; 0 = not given
};

/// The channel whose messages an index of a chunk lists.
struct McapIndexHead {
  std::uint16_t channel = 0;
  bool lists_messages = false;  ///< whether there are any
};

/// Each throws ParseError where the content ends early.
RecordHead parse_record_head(std::string_view bytes);
McapSchema parse_schema(std::string_view content);
McapChannel parse_channel(std::string_view content);
McapMessageHead parse_message_head(std::string_view content);
McapChunkHead parse_chunk_head(std::string_view content);
McapStatistics parse_statistics(std::string_view content);
McapFooter parse_footer(std::string_view content);
McapIndexHead parse_index_head(std::string_view content);

}  // namespace gridmerge::internal
