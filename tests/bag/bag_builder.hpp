// SPDX-License-Identifier: Apache-2.0
// Bags as tests want them, good ones and bad ones, by writers of their own.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::test {

/// How a message is encoded: its kind in the encapsulation header.
enum class CdrKind : std::uint8_t { big = 0, little = 1, big2 = 6, little2 = 7 };

/// Writes values of a message in CDR.
class CdrWriter {
 public:
  explicit CdrWriter(CdrKind kind = CdrKind::little);

  CdrWriter& number(std::uint32_t value);
  CdrWriter& real(float value);
  CdrWriter& real(double value);
  CdrWriter& text(std::string_view text);
  CdrWriter& values(const std::vector<std::int8_t>& values);

  std::string message() const { return header_ + body_; }

 private:
  void put(std::uint64_t value, std::size_t bytes);

  CdrKind kind_;
  std::string header_;
  std::string body_;
};

/// The fields of nav_msgs/OccupancyGrid that count.
struct MapFields {
  std::string frame_id = "map";
  float resolution = 0.05F;
  std::uint32_t width = 3;
  std::uint32_t height = 2;
  double x = 0.0, y = 0.0, z = 0.0;
  double qx = 0.0, qy = 0.0, qz = 0.0, qw = 1.0;
  std::vector<std::int8_t> values = {-1, 0, 100, 0, 0, 100};
};

/// Those of map_msgs/OccupancyGridUpdate.
struct UpdateFields {
  std::int32_t x = 0, y = 0;
  std::uint32_t width = 1, height = 1;
  std::vector<std::int8_t> values = {100};
};

std::string map_message(const MapFields& fields = {}, CdrKind kind = CdrKind::little);
std::string update_message(const UpdateFields& fields, CdrKind kind = CdrKind::little);

inline constexpr const char* kMapType = "nav_msgs/msg/OccupancyGrid";
inline constexpr const char* kUpdateType = "map_msgs/msg/OccupancyGridUpdate";

/// A message to be recorded.
struct Recorded {
  std::string topic = "/map";
  std::int64_t time = 0;
  std::string bytes;
  std::string type = kMapType;
  std::string encoding = "cdr";
};

/// A map as it is recorded, in the frame "robot".
Recorded record(const std::string& topic, std::int64_t time, const OccupancyGrid& map);

/// How an MCAP file is written.
struct McapStyle {
  std::string compression = {};      ///< "", "lz4" or "zstd"
  std::size_t messages_a_chunk = 2;  ///< 0 = no chunks
  bool has_index = true;             ///< a record for each channel behind each chunk
  bool has_summary = true;
  bool has_crc = true;
  bool has_end = true;      ///< the footer, and what stands before it
  bool has_extras = false;  ///< records of kinds that nobody knows
};

/// What an MCAP file begins and ends with.
inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

/// A record: kind, length, content.
std::string mcap_record(std::uint8_t kind, std::string_view content);

/// A file without an end whose only chunk has this content.
std::string mcap_with_chunk(std::string_view content);

/// A number as MCAP has it: little-endian, of so many bytes.
std::string mcap_number(std::uint64_t value, std::size_t bytes);

/// A text, its length before it.
std::string mcap_text(std::string_view text);

/// A chunk's content. `claimed` in place of the true number of unpacked bytes.
std::string mcap_chunk(std::string_view records, const std::string& compression, bool has_crc = true,
                       std::optional<std::uint64_t> claimed = {});

/// A whole file; each (topic, type, encoding) is a channel.
std::string mcap_file(const std::vector<Recorded>& messages, const McapStyle& style = {});

/// The same as a rosbag2 file of SQLite, written to `path`.
void write_db3(const std::string& path, const std::vector<Recorded>& messages);

/// Runs SQL on a database, which is made if need be.
void run_sql(const std::string& path, const std::string& sql);

/// The text packed by Zstandard or as an LZ4 frame.
std::string pack_zstd(std::string_view text);
std::string pack_lz4(std::string_view text);

}  // namespace gridmerge::test
