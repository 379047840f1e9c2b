// SPDX-License-Identifier: Apache-2.0
#include "bag/mcap.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "io/blaming.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::size_t kTailBytes = kRecordHeadBytes + kFooterBytes + kMcapMagic.size();

std::uint32_t add_to_crc(std::uint32_t crc, const char* bytes, std::size_t count) {
  return static_cast<std::uint32_t>(::crc32_z(crc, reinterpret_cast<const Bytef*>(bytes), count));
}

}  // namespace

/// The records of a chunk, one after another.
class McapFile::Chunk {
 public:
  Chunk(McapChunkHead head, std::unique_ptr<ByteSource> records)
      : head_(std::move(head)), records_(std::move(records)) {}

  /// How many bytes of the unpacked records were read.
  std::uint64_t position() const { return position_; }
  std::uint64_t left() const { return head_.unpacked_bytes - position_; }

  std::string read(std::size_t count) {
    std::string bytes(count, '\0');
    read(bytes.data(), count);
    return bytes;
  }

  void skip_to(std::uint64_t position) {
    std::array<char, 16384> forgotten;
    while (position_ < position) {
      const std::uint64_t step = std::min<std::uint64_t>(position - position_, forgotten.size());
      read(forgotten.data(), static_cast<std::size_t>(step));
    }
  }

  /// Calls `use(head)` for each record, whose content it may read on into.
  template <typename Use>
  void for_each_record(const Use& use) {
    while (left() > 0) {
      check_left(kRecordHeadBytes);
      const RecordHead head = parse_record_head(read(kRecordHeadBytes));
      check_left(head.bytes);
      const std::uint64_t end = position_ + head.bytes;
      use(head);
      skip_to(end);
    }
    char beyond = 0;
    if (records_->read(&beyond, 1) != 0) throw ParseError("a chunk unpacks to more than it says");
    if (head_.crc != 0 && head_.crc != crc_) throw ParseError("a chunk's checksum is wrong: it is damaged");
  }

 private:
  void check_left(std::uint64_t bytes) const {
    if (bytes > left()) throw ParseError("a record reaches beyond its chunk");
  }

  void read(char* to, std::size_t count) {
    check_left(count);
    if (records_->read(to, count) < count) throw ParseError("a chunk unpacks to less than it says");
    if (head_.crc != 0) crc_ = add_to_crc(crc_, to, count);
    position_ += count;
  }

  McapChunkHead head_;
  std::unique_ptr<ByteSource> records_;
  std::uint64_t position_ = 0;
  std::uint32_t crc_ = 0;
};

bool looks_like_mcap(std::string_view bytes) {
  return bytes.starts_with(kMcapMagic);
}

McapFile::McapFile(const std::filesystem::path& path, const std::filesystem::path& shown,
                   std::size_t max_message_bytes)
    : file_(path, shown), max_message_bytes_(max_message_bytes), scattered_(file_.path()) {
  blaming(file_.path(), [&] { open(); });
}

McapFile::~McapFile() = default;

void McapFile::open() {
  if (file_.read(0, kMcapMagic.size()) != kMcapMagic) throw ParseError("is no MCAP file of version 0");
  end_ = file_.size();
  const std::string tail =
      file_.size() < kTailBytes ? std::string() : file_.read(file_.size() - kTailBytes, kTailBytes);
  std::optional<McapFooter> footer;
  if (tail.ends_with(kMcapMagic)) {
    const RecordHead head = parse_record_head(tail);
    if (head.kind == McapRecord::footer && head.bytes == kFooterBytes)
      footer = parse_footer(std::string_view(tail).substr(kRecordHeadBytes));
  }
  is_cut_off_ = !footer;
  if (footer) end_ -= kTailBytes;
  if (!footer || !read_summary(*footer)) scan();
  make_topics();
}

// Whether the summary tells all topics. Its writer may leave out what it likes.
bool McapFile::read_summary(const McapFooter& footer) {
  if (footer.summary_begin == 0) return false;
  if (footer.summary_begin < kMcapMagic.size() || footer.summary_begin > end_)
    throw ParseError("the footer names no place of the file");
  check_summary(footer);
  std::optional<McapStatistics> statistics;
  for_each_record(footer.summary_begin, [&](const RecordHead& head, std::uint64_t offset) {
    if (head.kind == McapRecord::statistics) {
      statistics = parse_statistics(content(offset, head));
    } else if (head.kind == McapRecord::schema || head.kind == McapRecord::channel) {
      learn(head.kind, content(offset, head));
    }
    return true;
  });
  const bool has_types = std::ranges::all_of(channels_, [&](const auto& entry) {
    const std::uint16_t schema = entry.second.channel.schema;
    return schema == 0 || schemas_.contains(schema);
  });
  if (!statistics || statistics->channels != channels_.size() || !has_types) return false;
  std::uint64_t counted = 0;
  for (const auto& [channel, messages] : statistics->channel_messages) {
    const auto found = channels_.find(channel);
    if (found == channels_.end()) return false;
    found->second.messages = messages;
    counted += messages;
  }
  return counted == statistics->messages;
}

void McapFile::check_summary(const McapFooter& footer) const {
  if (footer.crc == 0) return;
  const std::uint64_t end = file_.size() - kMcapMagic.size() - sizeof(footer.crc);
  std::uint32_t crc = 0;
  for (std::uint64_t at = footer.summary_begin; at < end;) {
    const std::string piece =
        file_.read(at, static_cast<std::size_t>(std::min<std::uint64_t>(end - at, 1U << 16)));
    if (piece.empty()) break;
    crc = add_to_crc(crc, piece.data(), piece.size());
    at += piece.size();
  }
  if (crc != footer.crc) throw ParseError("the summary's checksum is wrong: the file is damaged");
}

// Reads all records: what a file without a summary holds, nothing else tells.
void McapFile::scan() {
  channels_.clear();
  schemas_.clear();
  name_bytes_ = 0;
  std::map<std::uint16_t, std::uint64_t> counts;
  const auto count = [&](std::string_view message) { ++counts[parse_message_head(message).channel]; };
  for_each_record(kMcapMagic.size(), [&](const RecordHead& head, std::uint64_t offset) {
    switch (head.kind) {
      case McapRecord::schema:
      case McapRecord::channel:
        learn(head.kind, content(offset, head));
        break;
      case McapRecord::message:
        count(records_.read(
            offset, static_cast<std::size_t>(std::min<std::uint64_t>(head.bytes, kMessageHeadBytes))));
        break;
      case McapRecord::chunk: {
        const auto chunk = open_chunk(offset, head.bytes);
        chunk->for_each_record([&](const RecordHead& inner) {
          if (inner.kind == McapRecord::message) {
            count(chunk->read(
                static_cast<std::size_t>(std::min<std::uint64_t>(inner.bytes, kMessageHeadBytes))));
          } else if (inner.kind == McapRecord::schema || inner.kind == McapRecord::channel) {
            constexpr std::uint64_t kMax = std::uint64_t{1} << 16;
            learn(inner.kind, chunk->read(static_cast<std::size_t>(std::min(inner.bytes, kMax))));
          }
        });
        break;
      }
      default:
        break;
    }
    return head.kind != McapRecord::data_end;
  });
  for (auto& [id, channel] : channels_) channel.messages = counts[id];
}

// Calls `use(head, offset of the content)` for each record until it returns false.
void McapFile::for_each_record(std::uint64_t begin, const Use& use) {
  std::uint64_t at = begin;
  while (at < end_) {
    const bool has_head = end_ - at >= kRecordHeadBytes;
    const RecordHead head = has_head ? parse_record_head(records_.read(at, kRecordHeadBytes)) : RecordHead{};
    if (!has_head || head.bytes > end_ - at - kRecordHeadBytes) {
      if (is_cut_off_) return;
      throw ParseError(fmt::format("the record at byte {} reaches beyond the file", at));
    }
    if (!use(head, at + kRecordHeadBytes)) return;
    at += kRecordHeadBytes + head.bytes;
  }
}

// Of a record that names things: what is long in it comes last, and is not of use. It is there until the next
// record is read.
std::string_view McapFile::content(std::uint64_t offset, const RecordHead& head) {
  constexpr std::uint64_t kMax = std::uint64_t{1} << 20;  // statistics of 2^16 channels take 0.7 MB
  return records_.read(offset, static_cast<std::size_t>(std::min(head.bytes, kMax)));
}

// The same schema or channel may stand in a file many times.
void McapFile::learn(McapRecord kind, std::string_view content) {
  std::size_t named = 0;
  if (kind == McapRecord::schema) {
    McapSchema schema = parse_schema(content);
    const std::size_t bytes = schema.name.size();
    if (schemas_.emplace(schema.id, std::move(schema.name)).second) named = bytes;
  } else {
    McapChannel channel = parse_channel(content);
    const std::size_t bytes = channel.topic.size() + channel.encoding.size();
    const std::uint16_t id = channel.id;
    if (channels_.emplace(id, Channel{std::move(channel), 0}).second) named = bytes;
  }
  constexpr std::size_t kMax = std::size_t{1} << 26;
  name_bytes_ += named;
  if (name_bytes_ > kMax) throw ParseError("the names of its topics are longer than any are");
}

std::string_view McapFile::type_of(const McapChannel& channel) const {
  const auto schema = schemas_.find(channel.schema);
  return schema == schemas_.end() ? std::string_view() : schema->second;
}

void McapFile::make_topics() {
  std::map<std::pair<std::string, std::string>, BagTopic> topics;  // each publisher has its own channel
  for (const auto& [id, one] : channels_) {
    BagTopic& topic = topics[{one.channel.topic, std::string(type_of(one.channel))}];
    topic.name = one.channel.topic;
    topic.type = type_of(one.channel);
    topic.encoding = one.channel.encoding;
    topic.messages += one.messages;
  }
  for (auto& [key, topic] : topics) topics_.push_back(std::move(topic));
}

std::unique_ptr<McapFile::Chunk> McapFile::open_chunk(std::uint64_t offset, std::uint64_t bytes) const {
  constexpr std::uint64_t kMaxHead = 4096, kMaxUnpacked = std::uint64_t{4} << 30;
  const McapChunkHead head =
      parse_chunk_head(file_.read(offset, static_cast<std::size_t>(std::min(bytes, kMaxHead))));
  if (head.packed_bytes > bytes - head.head_bytes)
    throw ParseError("a chunk's records reach beyond the chunk");
  if (head.unpacked_bytes > kMaxUnpacked)
    throw ParseError(fmt::format("a chunk claims to unpack to {} bytes", head.unpacked_bytes));
  const std::uint64_t begin = offset + head.head_bytes;
  std::unique_ptr<ByteSource> records = file_part(file_, begin, begin + head.packed_bytes);
  if (head.compression == "zstd") {
    records = unpack_zstd(std::move(records));
  } else if (head.compression == "lz4") {
    records = unpack_lz4(std::move(records));
  } else if (!head.compression.empty()) {
    throw ParseError(
        fmt::format("a chunk is packed by '{}', which is neither zstd nor lz4", head.compression));
  }
  return std::make_unique<Chunk>(head, std::move(records));
}

std::vector<StoredMessage> McapFile::find(const std::vector<BagTopic>& topics) {
  std::map<std::uint16_t, std::size_t> wanted;  // channels
  for (const auto& [id, one] : channels_) {
    for (std::size_t topic = 0; topic < topics.size(); ++topic) {
      if (topics[topic].name == one.channel.topic && topics[topic].type == type_of(one.channel))
        wanted[id] = topic;
    }
  }
  std::vector<StoredMessage> messages;
  const auto add = [&](std::string_view start, std::uint64_t bytes, std::uint64_t place,
                       std::uint64_t offset) {
    const McapMessageHead head = parse_message_head(start);
    const auto topic = wanted.find(head.channel);
    if (topic == wanted.end()) return;
    if (messages.size() == kMaxMessages)
      throw ParseError(fmt::format("a topic has more than {} messages", kMaxMessages));
    messages.push_back({head.time, topic->second, place, offset, bytes - kMessageHeadBytes});
  };
  const auto head_of = [](std::uint64_t bytes) {
    return static_cast<std::size_t>(std::min<std::uint64_t>(bytes, kMessageHeadBytes));
  };
  const auto add_chunk = [&](std::uint64_t place, std::uint64_t bytes) {
    const auto chunk = open_chunk(place, bytes);
    chunk->for_each_record([&](const RecordHead& head) {
      if (head.kind != McapRecord::message) return;
      const std::string start = chunk->read(head_of(head.bytes));
      add(start, head.bytes, place, chunk->position());
    });
  };
  // Behind a chunk there may be indexes of it, one for each of its channels: they spare unpacking it.
  struct Pending {
    std::uint64_t place = 0;
    std::uint64_t bytes = 0;
    bool has_index = false;
    bool is_wanted = false;
  };
  std::optional<Pending> pending;
  const auto finish_pending = [&] {
    if (pending && (pending->is_wanted || !pending->has_index)) add_chunk(pending->place, pending->bytes);
    pending.reset();
  };
  blaming(file_.path(), [&] {
    for_each_record(kMcapMagic.size(), [&](const RecordHead& head, std::uint64_t offset) {
      if (head.kind == McapRecord::message_index) {
        const McapIndexHead index =
            parse_index_head(content(offset, {head.kind, std::min<std::uint64_t>(head.bytes, 6)}));
        if (pending) {
          pending->has_index = true;
          pending->is_wanted |= index.lists_messages && wanted.contains(index.channel);
        }
        return true;
      }
      finish_pending();
      if (head.kind == McapRecord::chunk) pending = Pending{offset, head.bytes, false, false};
      if (head.kind == McapRecord::message)
        add(records_.read(offset, head_of(head.bytes)), head.bytes, 0, offset + kMessageHeadBytes);
      return head.kind != McapRecord::data_end;
    });
    // Of the last chunk of a file that is cut off, indexes may be missing.
    if (pending && is_cut_off_) pending->has_index = false;
    finish_pending();
  });
  return messages;
}

void McapFile::expect(const std::vector<StoredMessage>& order) {
  scattered_.expect(order, max_message_bytes_);
}

std::string McapFile::read(const StoredMessage& message) {
  return blaming(file_.path(), [&] {
    if (message.bytes > max_message_bytes_)
      throw ParseError(
          fmt::format("a message of {} bytes exceeds the limit of {}", message.bytes, max_message_bytes_));
    if (message.place == 0) return file_.read(message.offset, static_cast<std::size_t>(message.bytes));
    const auto kept = scattered_.read(message, [&](const StoredMessage& one) { return unpack(one); });
    return kept ? *kept : unpack(message);
  });
}

// Of a message in a chunk.
std::string McapFile::unpack(const StoredMessage& message) {
  std::unique_ptr<Chunk> chunk = std::move(chunk_);  // gone when it cannot be read on
  if (!chunk || chunk_place_ != message.place || chunk->position() > message.offset) {
    const RecordHead head = parse_record_head(file_.read(message.place - kRecordHeadBytes, kRecordHeadBytes));
    chunk = open_chunk(message.place, head.bytes);
    chunk_place_ = message.place;
  }
  chunk->skip_to(message.offset);
  std::string found = chunk->read(static_cast<std::size_t>(message.bytes));
  chunk_ = std::move(chunk);
  return found;
}

std::vector<MapWarning> McapFile::warnings() const {
  if (!is_cut_off_) return {};
  return {{MapWarningKind::cut_off,
           "the file has no end: recording was cut off, and what came last may be missing"}};
}

}  // namespace gridmerge::internal
