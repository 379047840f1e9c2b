// SPDX-License-Identifier: Apache-2.0
#include "bag/mcap_records.hpp"

#include "io/parse_error.hpp"

namespace gridmerge::internal {

namespace {

// Reads little-endian values one after another.
class Fields {
 public:
  explicit Fields(std::string_view content) : left_(content), size_(content.size()) {}

  template <typename Unsigned>
  Unsigned number() {
    const std::string_view bytes = take(sizeof(Unsigned));
    Unsigned value = 0;
    for (std::size_t i = sizeof(Unsigned); i-- > 0;)
      value = static_cast<Unsigned>(value << 8 | static_cast<std::uint8_t>(bytes[i]));
    return value;
  }

  std::string text() { return std::string(take(number<std::uint32_t>())); }

  std::string_view take(std::size_t count) {
    if (count > left_.size()) throw ParseError("a record ends early");
    const std::string_view taken = left_.substr(0, count);
    left_.remove_prefix(count);
    return taken;
  }

  std::size_t used() const { return size_ - left_.size(); }
  bool is_at_end() const { return left_.empty(); }

 private:
  std::string_view left_;
  std::size_t size_;
};

}  // namespace

RecordHead parse_record_head(std::string_view bytes) {
  Fields fields(bytes);
  RecordHead head;
  head.kind = static_cast<McapRecord>(fields.number<std::uint8_t>());
  head.bytes = fields.number<std::uint64_t>();
  return head;
}

McapSchema parse_schema(std::string_view content) {
  Fields fields(content);
  McapSchema schema;
  schema.id = fields.number<std::uint16_t>();
  schema.name = fields.text();
  return schema;
}

McapChannel parse_channel(std::string_view content) {
  Fields fields(content);
  McapChannel channel;
  channel.id = fields.number<std::uint16_t>();
  channel.schema = fields.number<std::uint16_t>();
  channel.topic = fields.text();
  channel.encoding = fields.text();
  return channel;
}

McapMessageHead parse_message_head(std::string_view content) {
  Fields fields(content);
  McapMessageHead head;
  head.channel = fields.number<std::uint16_t>();
  fields.number<std::uint32_t>();  // its sequence number
  head.time = static_cast<std::int64_t>(fields.number<std::uint64_t>());
  fields.number<std::uint64_t>();  // when it was published
  return head;
}

McapChunkHead parse_chunk_head(std::string_view content) {
  Fields fields(content);
  McapChunkHead head;
  fields.number<std::uint64_t>();  // time of its first message
  fields.number<std::uint64_t>();  // time of its last
  head.unpacked_bytes = fields.number<std::uint64_t>();
  head.crc = fields.number<std::uint32_t>();
  head.compression = fields.text();
  head.packed_bytes = fields.number<std::uint64_t>();
  head.head_bytes = fields.used();
  return head;
}

McapStatistics parse_statistics(std::string_view content) {
  Fields fields(content);
  McapStatistics statistics;
  statistics.messages = fields.number<std::uint64_t>();
  fields.number<std::uint16_t>();  // schemas
  statistics.channels = fields.number<std::uint32_t>();
  fields.number<std::uint32_t>();  // attachments
  fields.number<std::uint32_t>();  // metadata records
  fields.number<std::uint32_t>();  // chunks
  fields.number<std::uint64_t>();  // time of the first message
  fields.number<std::uint64_t>();  // time of the last
  Fields counts(fields.take(fields.number<std::uint32_t>()));
  while (!counts.is_at_end()) {
    const auto channel = counts.number<std::uint16_t>();
    statistics.channel_messages[channel] = counts.number<std::uint64_t>();
  }
  return statistics;
}

McapFooter parse_footer(std::string_view content) {
  Fields fields(content);
  McapFooter footer;
  footer.summary_begin = fields.number<std::uint64_t>();
  fields.number<std::uint64_t>();  // where the summary's own index begins
  footer.crc = fields.number<std::uint32_t>();
  return footer;
}

McapIndexHead parse_index_head(std::string_view content) {
  Fields fields(content);
  McapIndexHead head;
  head.channel = fields.number<std::uint16_t>();
  head.lists_messages = fields.number<std::uint32_t>() > 0;
  return head;
}

}  // namespace gridmerge::internal
