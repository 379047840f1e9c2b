// SPDX-License-Identifier: Apache-2.0
#include "bag/bag_builder.hpp"

#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

namespace gridmerge::test {

CdrWriter::CdrWriter(CdrKind kind) : kind_(kind), header_{'\0', static_cast<char>(kind), '\0', '\0'} {}

void CdrWriter::put(std::uint64_t value, std::size_t bytes) {
  const bool is_second = kind_ == CdrKind::big2 || kind_ == CdrKind::little2;
  const std::size_t alignment = is_second && bytes == 8 ? 4 : bytes;
  while (body_.size() % alignment != 0) body_ += '\0';
  const bool is_little = kind_ == CdrKind::little || kind_ == CdrKind::little2;
  for (std::size_t i = 0; i < bytes; ++i)
    body_ += static_cast<char>(value >> 8 * (is_little ? i : bytes - 1 - i));
}

CdrWriter& CdrWriter::number(std::uint32_t value) {
  put(value, 4);
  return *this;
}

CdrWriter& CdrWriter::real(float value) {
  put(std::bit_cast<std::uint32_t>(value), 4);
  return *this;
}

CdrWriter& CdrWriter::real(double value) {
  put(std::bit_cast<std::uint64_t>(value), 8);
  return *this;
}

CdrWriter& CdrWriter::text(std::string_view text) {
  number(static_cast<std::uint32_t>(text.size() + 1));
  body_ += text;
  body_ += '\0';
  return *this;
}

CdrWriter& CdrWriter::values(const std::vector<std::int8_t>& values) {
  number(static_cast<std::uint32_t>(values.size()));
  for (const std::int8_t value : values) body_ += static_cast<char>(value);
  return *this;
}

std::string map_message(const MapFields& fields, CdrKind kind) {
  CdrWriter writer(kind);
  writer.number(12).number(34).text(fields.frame_id).number(56).number(78).real(fields.resolution);
  writer.number(fields.width).number(fields.height);
  for (const double value : {fields.x, fields.y, fields.z, fields.qx, fields.qy, fields.qz, fields.qw})
    writer.real(value);
  return writer.values(fields.values).message();
}

std::string update_message(const UpdateFields& fields, CdrKind kind) {
  CdrWriter writer(kind);
  writer.number(12).number(34).text("map");
  writer.number(static_cast<std::uint32_t>(fields.x)).number(static_cast<std::uint32_t>(fields.y));
  return writer.number(fields.width).number(fields.height).values(fields.values).message();
}

Recorded record(const std::string& topic, std::int64_t time, const OccupancyGrid& map) {
  MapFields fields;
  fields.frame_id = "robot";
  fields.resolution = static_cast<float>(map.resolution);
  fields.width = static_cast<std::uint32_t>(map.width);
  fields.height = static_cast<std::uint32_t>(map.height);
  fields.x = map.origin.x;
  fields.y = map.origin.y;
  fields.qz = std::sin(map.origin.theta / 2);
  fields.qw = std::cos(map.origin.theta / 2);
  fields.values.clear();
  for (const Cell cell : map.cells) {
    constexpr std::int8_t kValues[] = {-1, 0, 100};
    fields.values.push_back(kValues[static_cast<std::size_t>(cell)]);
  }
  return {topic, time, map_message(fields), kMapType, "cdr"};
}

std::string mcap_number(std::uint64_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) text += i < 8 ? static_cast<char>(value >> 8 * i) : '\0';
  return text;
}

std::string mcap_text(std::string_view text) {
  return mcap_number(text.size(), 4) + std::string(text);
}

std::string mcap_record(std::uint8_t kind, std::string_view content) {
  return static_cast<char>(kind) + mcap_number(content.size(), 8) + std::string(content);
}

std::string mcap_with_chunk(std::string_view content) {
  return std::string(kMcapMagic) + mcap_record(6, content);
}

std::string pack_zstd(std::string_view text) {
  std::string packed(ZSTD_compressBound(text.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), text.data(), text.size(), 3));
  return packed;
}

std::string pack_lz4(std::string_view text) {
  std::string packed(LZ4F_compressFrameBound(text.size(), nullptr), '\0');
  packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), text.data(), text.size(), nullptr));
  return packed;
}

namespace {

std::uint32_t crc_of(std::string_view text) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size())));
}

/// What a file is about: its schemas and channels.
struct Channels {
  using Key = std::tuple<std::string, std::string, std::string>;
  std::map<std::string, std::uint16_t> schemas;
  std::map<Key, std::uint16_t> ids;
  std::map<std::uint16_t, std::uint64_t> counts;

  static Key key(const Recorded& message) { return {message.topic, message.type, message.encoding}; }

  explicit Channels(const std::vector<Recorded>& messages) {
    for (const Recorded& message : messages) {
      schemas.emplace(message.type, static_cast<std::uint16_t>(schemas.size() + 1));
      const auto [place, is_new] = ids.emplace(key(message), static_cast<std::uint16_t>(ids.size() + 1));
      ++counts[place->second];
    }
  }

  std::string records() const {
    std::string text;
    for (const auto& [name, id] : schemas)
      text +=
          mcap_record(3, mcap_number(id, 2) + mcap_text(name) + mcap_text("ros2msg") + mcap_text("int8 x"));
    for (const auto& [name, id] : ids) {
      const auto& [topic, type, encoding] = name;
      text += mcap_record(4, mcap_number(id, 2) + mcap_number(schemas.at(type), 2) + mcap_text(topic) +
                                 mcap_text(encoding) + mcap_text(""));
    }
    return text;
  }
};

std::string statistics(const Channels& channels, std::size_t messages) {
  std::string counts;
  for (const auto& [id, count] : channels.counts) counts += mcap_number(id, 2) + mcap_number(count, 8);
  return mcap_record(11, mcap_number(messages, 8) + mcap_number(channels.schemas.size(), 2) +
                             mcap_number(channels.ids.size(), 4) + std::string(4 + 4 + 4 + 8 + 8, '\0') +
                             mcap_text(counts));
}

}  // namespace

std::string mcap_chunk(std::string_view records, const std::string& compression, bool has_crc,
                       std::optional<std::uint64_t> claimed) {
  const std::string packed = compression == "zstd"  ? pack_zstd(records)
                             : compression == "lz4" ? pack_lz4(records)
                                                    : std::string(records);
  return std::string(16, '\0') + mcap_number(claimed.value_or(records.size()), 8) +
         mcap_number(has_crc ? crc_of(records) : 0, 4) + mcap_text(compression) +
         mcap_number(packed.size(), 8) + packed;
}

std::string mcap_file(const std::vector<Recorded>& messages, const McapStyle& style) {
  const Channels channels(messages);
  const std::string extra = style.has_extras ? mcap_record(0x99, "nobody knows") : "";
  std::string file = std::string(kMcapMagic) + mcap_record(1, mcap_text("ros2") + mcap_text("test")) + extra;
  std::string records = channels.records() + extra;
  std::set<std::uint16_t> in_chunk;
  std::size_t count = 0;
  const auto end_chunk = [&] {
    if (style.messages_a_chunk == 0) {
      file += records;
    } else if (!records.empty()) {
      file += mcap_record(6, mcap_chunk(records, style.compression, style.has_crc));
      if (style.has_index) {
        for (const std::uint16_t id : in_chunk)
          file += mcap_record(7, mcap_number(id, 2) + mcap_text(std::string(16, '\0')));
      }
    }
    records.clear();
    in_chunk.clear();
    count = 0;
  };
  for (const Recorded& message : messages) {
    const std::uint16_t id = channels.ids.at(Channels::key(message));
    const auto time = static_cast<std::uint64_t>(message.time);
    records += mcap_record(5, mcap_number(id, 2) + mcap_number(0, 4) + mcap_number(time, 8) +
                                  mcap_number(time, 8) + message.bytes) +
               extra;
    in_chunk.insert(id);
    if (++count == style.messages_a_chunk) end_chunk();
  }
  end_chunk();
  if (!style.has_end) return file;
  file += mcap_record(15, mcap_number(0, 4));
  const std::size_t begin = file.size();
  if (style.has_summary) file += channels.records() + extra + statistics(channels, messages.size());
  const std::string footer = static_cast<char>(2) + mcap_number(20, 8) +
                             mcap_number(style.has_summary ? begin : 0, 8) + mcap_number(0, 8);
  const std::uint32_t crc = style.has_crc ? crc_of(file.substr(begin) + footer) : 0;
  return file + footer + mcap_number(crc, 4) + std::string(kMcapMagic);
}

void run_sql(const std::string& path, const std::string& sql) {
  sqlite3* database = nullptr;
  const std::string quick = "PRAGMA synchronous = OFF;" + sql;
  if (sqlite3_open(path.c_str(), &database) != SQLITE_OK ||
      sqlite3_exec(database, quick.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    throw std::runtime_error(sqlite3_errmsg(database));
  sqlite3_close(database);
}

void write_db3(const std::string& path, const std::vector<Recorded>& messages) {
  const Channels channels(messages);
  const auto hex = [](const std::string& bytes) {
    std::string text = "x'";
    for (const char byte : bytes) {
      constexpr std::string_view kDigits = "0123456789abcdef";
      text += kDigits[static_cast<std::uint8_t>(byte) / 16];
      text += kDigits[static_cast<std::uint8_t>(byte) % 16];
    }
    return text + "'";
  };
  std::string sql =
      "PRAGMA page_size = 512; BEGIN;"
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
      " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,"
      " data BLOB NOT NULL);";
  for (const auto& [key, id] : channels.ids) {
    const auto& [topic, type, encoding] = key;
    sql += "INSERT INTO topics VALUES(" + std::to_string(id) + ",'" + topic + "','" + type + "','" +
           encoding + "','');";
  }
  for (const Recorded& message : messages) {
    sql += "INSERT INTO messages(topic_id, timestamp, data) VALUES(" +
           std::to_string(channels.ids.at(Channels::key(message))) + "," + std::to_string(message.time) +
           "," + hex(message.bytes) + ");";
  }
  run_sql(path, sql + "COMMIT;");
}

}  // namespace gridmerge::test
